//! The energy account over every element of the world: what nothing explains falls with the step at the integrator's order.
//!
//! A force that is not what its law says of itself leaves a balance that no step closes: one thousandth of it is found here, since
//! the finest Runge–Kutta step leaves less than a few ten-thousandths of what each element handles.

mod elements;
mod planted;

use crate::support::scenes::bouncing_ball;
use crate::support::{ALL, Setup, linear, run, shape, spec, twist, world};
use contact::Shape;
use elements::{Element, all};
use sim::{Base, Energy, EnergyAudit, EnergyBalance, Environment, Integrator, PairLaw, World};
use spatial::Pose;

/// The balance of an element's scene after its time, with steps of `h`.
fn balance(element: &Element, integrator: Integrator, h: f64) -> (EnergyBalance, f64) {
    let mut world = (element.build)(&Setup::new(integrator).step(h));
    world.settle_effects();
    let mut audit = EnergyAudit::new(&world);
    for _ in 0..(element.duration / h).round() as u32 {
        let t = world.state().time + 0.5 * h;
        (element.command)(t, world.commands_mut());
        run(&mut world, 1);
    }
    let balance = audit.close(&world);
    (balance, size(&balance) + Energy::of(&world).kinetic)
}

/// What the scene handles, J: all works, losses and changes.
fn size(balance: &EnergyBalance) -> f64 {
    let EnergyBalance { stored_change, actuator_work, drive_work, environment_work, effect_work, .. } = *balance;
    let terms = [stored_change, actuator_work, drive_work, environment_work, effect_work, balance.contact_intake];
    terms.iter().map(|x| x.abs()).sum::<f64>() + balance.calc_loss()
}

/// By how much a loss falls at a quarter of the step, what is left of it there, and what counts as none, as shares of what a scene
/// handles.
struct Bounds {
    fall: f64,
    left: f64,
    closed: f64,
}

fn bounds(element: &Element, integrator: Integrator) -> Bounds {
    match (integrator, element.is_smooth) {
        // First order gives 4, second 16, fourth 256; a corner in a law costs a higher order its own.
        (Integrator::ImplicitEuler | Integrator::SemiImplicitEuler, _) => {
            Bounds { fall: 2.5, left: 1e-1, closed: ROUND_OFF }
        }
        (Integrator::ImplicitMidpoint, true) => Bounds { fall: 12.0, left: 1e-4, closed: ROUND_OFF },
        (Integrator::RungeKutta4, true) => Bounds { fall: 150.0, left: 1e-8, closed: ROUND_OFF },
        // Where in its step a corner falls decides what is left of it.
        (Integrator::ImplicitMidpoint | Integrator::RungeKutta4, false) => {
            Bounds { fall: 2.5, left: 3e-4, closed: 1e-5 }
        }
    }
}

/// Of the sums, as a share of what a scene handles.
const ROUND_OFF: f64 = 1e-11;

#[test]
fn numerical_loss_of_every_element_falls_at_the_integrators_order() {
    let mut faults = Vec::new();
    for element in all() {
        for integrator in ALL {
            let [coarse, fine] = [element.step, 0.25 * element.step].map(|h| balance(&element, integrator, h));
            let Bounds { fall, left, closed } = bounds(&element, integrator);
            let share = |(balance, size): &(EnergyBalance, f64)| balance.numerical_loss / size;
            let [before, after, size] = [share(&coarse), share(&fine), fine.1];
            let line = format!("{:<28} {integrator:?}: {before:.1e} {after:.1e} of {size:.2e} J", element.name);
            println!("{line}");
            let holds = |before: f64, after: f64| {
                after.abs() < closed || (after.abs() < before.abs() / fall && after.abs() < left)
            };
            // Parts of either sign may cancel at one of the steps: another quarter then decides.
            if !(holds(before, after) || holds(after, share(&balance(&element, integrator, element.step / 16.0)))) {
                faults.push(format!("{line}\n  {fine:?}"));
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn losses_by_law_are_never_negative() {
    for element in all() {
        for integrator in ALL {
            let (b, size) = balance(&element, integrator, element.step);
            let floor = -1e-6 * size;
            let losses = [b.contact_loss, b.joint_loss, b.mechanism_loss, b.contact_intake];
            assert!(losses.iter().all(|x| *x >= floor), "{}, {integrator:?}: {b:?}", element.name);
        }
    }
}

/// Two balls of 1 kg that meet at 0.5 m/s on a spring of 5e5 N/m without damper: e = 1.
fn meeting_balls(setup: &Setup) -> World {
    let ball =
        || crate::support::robot(vec![crate::support::link("ball", 1.0, [0.0; 3].into(), [4e-3; 3].into())], vec![]);
    let mut spec = spec(vec![(ball(), Base::Free), (ball(), Base::Free)], setup);
    let sphere = Shape::Ball { radius: 0.1 };
    spec.shapes = vec![shape("a", Some(0), sphere.clone()), shape("b", Some(1), sphere)];
    spec.pairs = vec![([0, 1], PairLaw::new(linear(5e5, 0.0), None))];
    let mut world = world(spec);
    world.state_mut().bases[1] = Pose::translation(0.2004, 0.0, 0.0);
    world.set_base_twists(&[twist([0.0; 3], [0.0; 3]), twist([0.0; 3], [-0.5, 0.0, 0.0])]);
    world
}

#[test]
fn undamped_bounce_names_what_the_step_took() {
    for integrator in ALL {
        for h in [1e-3, 1e-4] {
            let mut world = meeting_balls(&Setup::new(integrator).step(h));
            let (mut audit, before) = (EnergyAudit::new(&world), Energy::of(&world).kinetic);
            run(&mut world, (0.02 / h).round() as usize);
            let (balance, lost) = (audit.close(&world), before - Energy::of(&world).kinetic);
            println!("{integrator:?} at {h} s: lost {lost:.4} J of 0.0625 J, named {:.4} J", balance.numerical_loss);
            assert!((balance.numerical_loss - lost).abs() < 1e-2 * lost.abs() + 1e-12, "{balance:?}");
            // All of it in the contact; Runge–Kutta's stages know their part of that only to its own order.
            let off = (balance.numerical_loss_in_contacts - lost).abs();
            let allowed = if integrator == Integrator::RungeKutta4 { 0.3 } else { 1e-2 };
            assert!(off < allowed * lost.abs() + 1e-12, "{balance:?}");
            // No law of this world dissipates.
            assert!(balance.contact_loss.abs() < 1e-15);
            if (integrator, h) == (Integrator::ImplicitEuler, 1e-3) {
                // h ω = 1: nine tenths are gone, as exp(−π h ω) would have it in the small.
                assert!(lost > 0.05, "{lost}");
            }
        }
    }
}

/// Gravity is a work: that of falling from the start to the end, exactly, whatever the step and however often it bounced.
#[test]
fn work_of_a_uniform_field_is_its_potential() {
    for integrator in ALL {
        let mut world = bouncing_ball(linear(1e4, 5.0), 0.05, &Setup::new(integrator));
        let (mut audit, high) = (EnergyAudit::new(&world), world.state().bases[0].translation.vector.z);
        run(&mut world, 700);
        let fallen = 9.81 * (high - world.state().bases[0].translation.vector.z);
        let work = audit.close(&world).environment_work;
        // A ball that does not turn: the scheme's own displacement; stages sum theirs by their order.
        let allowed = if integrator == Integrator::RungeKutta4 { 1e-6 } else { 1e-12 };
        assert!((work - fallen).abs() < allowed, "{integrator:?}: {work} J, {fallen} J");
    }
}

#[test]
fn thrust_and_drag_in_gravity_and_orbit_lose_less_than_a_hundredth_of_the_thrusts_work() {
    let fields = [
        Environment::Uniform { gravity: [0.3, -0.2, -1.6].into() },
        Environment::Orbit { mean_motion: 1.13e-3, gravity_gradient: false },
        Environment::Orbit { mean_motion: 1.13e-3, gravity_gradient: true },
    ];
    for integrator in ALL {
        for environment in fields {
            let mut world = elements::climbing(&Setup { environment, ..Setup::new(integrator) });
            let mut audit = EnergyAudit::new(&world);
            for _ in 0..10 {
                run(&mut world, 1_000);
                let balance = audit.close(&world);
                assert!(balance.actuator_work > 0.01 && balance.effect_work < 0.0);
                let share = balance.numerical_loss.abs() / balance.actuator_work;
                assert!(share < 1e-2, "{integrator:?}, {environment:?}: {share:.1e}, {balance:?}");
            }
        }
    }
}

#[test]
fn a_world_at_rest_has_an_empty_account() {
    for integrator in ALL {
        let mut world = bouncing_ball(linear(1e4, 5.0), -9.81e-4, &Setup::new(integrator));
        let mut audit = EnergyAudit::new(&world);
        run(&mut world, 500);
        let b = audit.close(&world);
        assert!(size(&b) < 1e-15 && b.numerical_loss.abs() < 1e-15, "{integrator:?}: {b:?}");
    }
}
