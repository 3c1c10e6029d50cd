//! Forces of one's own: the same as a law of ours where they say the same, and in the same books.

use crate::body_loads::effect;
use crate::support::{ALL, Setup, link, robot, run, spec, twist, world};
use sim::{Axes, Base, BodyLaw, BodyMotion, EnergyAudit, Force, Integrator, Load, ModelSpec, World};
use spatial::{Vec3, Wrench};
use std::sync::Arc;

/// A force fixed in its link, at a point of it.
#[derive(Debug)]
struct Jet {
    links: [(usize, usize); 1],
    at: Vec3,
    force: Vec3,
}

impl Force for Jet {
    fn name(&self) -> &str {
        "jet"
    }

    fn links(&self) -> &[(usize, usize)] {
        &self.links
    }

    fn act(&self, motions: &[BodyMotion], wrenches: &mut [Wrench]) {
        wrenches[0] += motions[0].push_at(motions[0].frame_wl.rot * self.force, &self.at);
    }
}

/// A spring between points of two links, at rest where they meet.
#[derive(Debug)]
struct Spring {
    links: [(usize, usize); 2],
    at: [Vec3; 2],
    stiffness: f64,
}

impl Spring {
    fn stretch(&self, motions: &[BodyMotion]) -> Vec3 {
        motions[1].frame_wl.point(&self.at[1]) - motions[0].frame_wl.point(&self.at[0])
    }
}

impl Force for Spring {
    fn name(&self) -> &str {
        "spring"
    }

    fn links(&self) -> &[(usize, usize)] {
        &self.links
    }

    fn act(&self, motions: &[BodyMotion], wrenches: &mut [Wrench]) {
        let pull = self.stiffness * self.stretch(motions);
        wrenches[0] += motions[0].push_at(pull, &self.at[0]);
        wrenches[1] += motions[1].push_at(-pull, &self.at[1]);
    }
}

fn with_force(world: &World, force: impl Force + 'static) -> World {
    let model = (**world.model()).clone().with_forces(vec![Arc::new(force)]).unwrap();
    World::new(Arc::new(model), world.state().clone())
}

fn hull(name: &str, mass: f64) -> multibody::Tree {
    robot(vec![link(name, mass, Vec3::new(0.05, -0.02, 0.1), Vec3::new(0.9, 1.1, 1.3))], Vec::new())
}

#[test]
fn a_force_moves_what_a_law_of_the_same_force_moves() {
    let vector = Vec3::new(0.2, -0.1, 0.4);
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let start = |effects| {
            let mut world = world(ModelSpec { effects, ..spec(vec![(hull("hull", 12.0), Base::Free)], &setup) });
            world.set_base_twists(&[twist([0.1, -0.2, 0.3], [0.05, 0.0, 0.1])]);
            world
        };
        let mut law = start(vec![effect(BodyLaw::Load(Load::ConstantForce { vector, axes: Axes::Body }))]);
        let at = law.model().vehicles[0].tree.links[0].inertia.com();
        let mut own = with_force(&start(Vec::new()), Jet { links: [(0, 0)], at, force: vector });
        run(&mut law, 300);
        run(&mut own, 300);
        let off = (own.state().bases[0].translation.vector - law.state().bases[0].translation.vector).norm();
        assert!(off < 1e-12, "{integrator:?}: {off:e} m");
        let (works, same) = (own.works().forces[0], law.works().effects[0]);
        assert!(works != 0.0 && (works - same).abs() < 1e-12, "{integrator:?}: {works} J and {same} J");
    }
}

/// Two bodies on a spring through their centres of mass, 0.3 m apart, after half a period: relative place, m, what energy no book explains, J, and the
/// momentum, N·s and N·m·s, that came from nowhere.
fn swing(integrator: Integrator, steps: usize) -> (f64, f64, f64) {
    let (stiffness, masses): (f64, [f64; 2]) = (40.0, [12.0, 5.0]);
    let period = 2.0 * std::f64::consts::PI * (masses[0] * masses[1] / (masses[0] + masses[1]) / stiffness).sqrt();
    let setup = Setup { step: 0.5 * period / steps as f64, ..Setup::new(integrator) };
    let mut start = world(spec(vec![(hull("a", masses[0]), Base::Free), (hull("b", masses[1]), Base::Free)], &setup));
    start.state_mut().bases[1].translation.vector = Vec3::new(0.3, 0.0, 0.0);
    start.set_base_twists(&[twist([0.0; 3], [0.0; 3]), twist([0.0; 3], [0.0; 3])]);
    let com = start.model().vehicles[0].tree.links[0].inertia.com();
    let mut world = with_force(&start, Spring { links: [(0, 0), (1, 0)], at: [com, com], stiffness });
    let mut audit = EnergyAudit::new(&world);
    run(&mut world, steps);
    let state = world.state();
    let apart = (state.bases[1].translation.vector - state.bases[0].translation.vector).x;
    let momentum = state.momentum[0] + state.momentum[1];
    (apart, audit.close(&world).numerical_loss.abs(), momentum.force.norm() + momentum.moment.norm())
}

#[test]
fn two_bodies_on_a_spring_swing_as_they_should_and_the_books_close() {
    for (integrator, order) in [
        (Integrator::SemiImplicitEuler, 1.0),
        (Integrator::ImplicitEuler, 1.0),
        (Integrator::ImplicitMidpoint, 2.0),
        (Integrator::RungeKutta4, 4.0),
    ] {
        let (coarse, fine) = (swing(integrator, 200), swing(integrator, 400));
        for (_, _, momentum) in [coarse, fine] {
            assert!(momentum < 1e-12, "{integrator:?}: {momentum:e}");
        }
        // Half a period later they stand on the other side.
        let errors = [coarse.0 + 0.3, fine.0 + 0.3].map(f64::abs);
        let seen = (errors[0] / errors[1]).log2();
        assert!(errors[1] < 1e-2 && seen > order - 0.3, "{integrator:?}: {errors:?} m, order {seen}");
        let lost = (coarse.1 / fine.1).log2();
        assert!(fine.1 < 5e-2 && (lost > order - 0.3 || fine.1 < 1e-9), "{integrator:?}: {:e} J, order {lost}", fine.1);
    }
}

#[test]
fn a_force_on_a_link_that_is_not_there_is_refused() {
    let world = world(spec(vec![(hull("hull", 1.0), Base::Free)], &Setup::new(Integrator::RungeKutta4)));
    let jet = Jet { links: [(0, 3)], at: Vec3::zeros(), force: Vec3::x() };
    let error = (**world.model()).clone().with_forces(vec![Arc::new(jet)]).unwrap_err().to_string();
    assert!(error.contains("\"jet\" acts on link 3 of vehicle 0"), "{error}");
}
