//! A fault of one thousandth in any force shows in the account: after every step the bodies are given a thousandth of what the
//! element did to them once more, as if the force that acts were 1.001 times the one that its law says and the books know.

use super::elements::{Element, all};
use crate::support::effects::INERTIA;
use crate::support::{Setup, run};
use sim::{Base, EnergyAudit, Integrator, World};
use spatial::Wrench;

/// Where an element's force is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Force {
    /// On both bodies of the touching points.
    Contact,
    /// On both bodies of the mechanisms.
    Mechanism,
    /// On the bodies, from outside.
    External,
    /// On the wheel's coordinate.
    Wheel,
    /// Nowhere that a test could read it: only what the element shares with others is planted, elsewhere.
    Hidden,
}

/// The thousandth.
const FAULT: f64 = 1e-3;

fn plant(force: Force, world: &mut World, h: f64) {
    let mut kicks: Vec<(usize, Wrench)> = Vec::new();
    let mut on = |vehicle: Option<usize>, impulse: Wrench| kicks.extend(vehicle.map(|v| (v, impulse)));
    let model = world.model().clone();
    let owner = |body: usize| model.owners.get(body).map(|o| o.0);
    match force {
        Force::Contact => {
            for touch in world.touches() {
                let (a, b) = model.pair_bodies(touch.pair);
                let impulse = touch.force_w * (FAULT * h);
                let impulse = Wrench::new(touch.point_w.cross(&impulse), impulse);
                on(owner(a), -impulse);
                on(owner(b), impulse);
            }
        }
        Force::Mechanism => {
            for report in world.mechanisms() {
                let mechanism = &model.mechanisms[report.index];
                let impulse = report.wrench_w.about(&-report.point_w) * (FAULT * h);
                on(mechanism.side_a.vehicle, -impulse);
                on(mechanism.side_b.vehicle, impulse);
            }
        }
        Force::External => {
            for (body, &(vehicle, _)) in model.owners.iter().enumerate() {
                let anchor = world.kinematics(vehicle).anchor;
                on(Some(vehicle), world.external_wrench(body).about(&-anchor) * (FAULT * h));
            }
        }
        Force::Wheel => world.state_mut().v[0] += FAULT * h * world.effort(0) / INERTIA,
        Force::Hidden => {}
    }
    for (vehicle, impulse) in kicks {
        // Of a guided base only the free components are kept.
        let kept = match model.vehicles[vehicle].base {
            Base::Free => impulse,
            Base::Only(free) => {
                let slot =
                    |v: &spatial::Vec3, at: usize| spatial::Vec3::from_fn(|k, _| if free[at + k] { v[k] } else { 0.0 });
                Wrench::new(slot(&impulse.moment, 0), slot(&impulse.force, 3))
            }
            Base::Fixed | Base::Driven(_) => continue,
        };
        world.state_mut().momentum[vehicle] += kept;
    }
    world.refresh();
}

/// The largest loss that nothing explains, on the way, J; and what it is measured by.
fn largest_loss(element: &Element, force: Force) -> f64 {
    let h = 0.25 * element.step;
    let mut world = (element.build)(&Setup::new(Integrator::RungeKutta4).step(h));
    world.settle_effects();
    let mut audit = EnergyAudit::new(&world);
    let mut largest = 0.0_f64;
    for k in 0..(element.duration / h).round() as u32 {
        let t = world.state().time + 0.5 * h;
        (element.command)(t, world.commands_mut());
        run(&mut world, 1);
        plant(force, &mut world, h);
        if k % 10 == 0 {
            largest = largest.max(audit.close(&world).numerical_loss.abs());
        }
    }
    largest
}

#[test]
fn a_thousandth_of_any_force_that_no_book_knows_shows() {
    let mut unseen = Vec::new();
    for element in all().iter().filter(|e| e.force != Force::Hidden) {
        let [clean, planted] = [Force::Hidden, element.force].map(|force| largest_loss(element, force));
        println!("{:<28} {:?}: {clean:.1e} J, with the fault {planted:.1e} J", element.name, element.force);
        // What passes for the integrator's own at this step is far less than the fault makes.
        if planted < 5.0 * clean {
            unseen.push(element.name);
        }
    }
    assert!(unseen.is_empty(), "{unseen:?}");
}
