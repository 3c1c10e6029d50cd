//! Forces beside all laws move what a law of the same force moves.

use crate::body_loads::effect;
use crate::support::{ALL, Setup, joint, link, robot, run, spec, twist, world};
use multibody::JointKind;
use sim::{Axes, Base, BodyLaw, Effect, EffectKind, JointEffect, JointLaw, Load, ModelSpec, Push, World};
use spatial::{Vec3, Wrench};

const EFFORT: f64 = 0.3;
const STEPS: usize = 300;

/// A body that flies and turns, with an arm of two joints.
fn flying(effects: Vec<Effect>, setup: &Setup) -> World {
    let turns = |name: &str, parent| joint(name, parent, Vec3::new(0.3, 0.1, 0.2), Vec3::z(), JointKind::Revolute);
    let arm = |name: &str| link(name, 2.0, Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.02, 0.05, 0.05));
    let hull = link("hull", 12.0, Vec3::new(0.05, -0.02, 0.1), Vec3::new(0.9, 1.1, 1.3));
    let tree = robot(vec![hull, arm("upper"), arm("lower")], vec![turns("shoulder", 0), turns("elbow", 1)]);
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, Base::Free)], setup) });
    world.set_base_twists(&[twist([0.1, -0.2, 0.3], [0.05, 0.0, 0.1])]);
    world
}

#[test]
fn a_push_moves_what_a_law_of_the_same_force_moves() {
    let (force, torque) = (Vec3::new(0.2, -0.1, 0.4), Vec3::new(0.05, 0.02, -0.03));
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let on_joint = JointEffect { coordinate: 1, law: JointLaw::Offset { effort: EFFORT } };
        let mut driven = flying(
            vec![
                Effect { name: "motor".to_owned(), kind: EffectKind::Joint(on_joint) },
                effect(BodyLaw::Load(Load::ConstantForce { vector: force, axes: Axes::Body })),
                effect(BodyLaw::Load(Load::ConstantTorque { vector: torque, axes: Axes::Body })),
            ],
            &setup,
        );
        let mut pushed = flying(Vec::new(), &setup);
        let com = pushed.model().vehicles[0].tree.links[0].inertia.com();
        let wrench = Wrench::new(torque + com.cross(&force), force);
        pushed.push(Some(Push { joints: vec![0.0, EFFORT], bases: vec![wrench] }));
        run(&mut driven, STEPS);
        run(&mut pushed, STEPS);
        let (a, b) = (pushed.state(), driven.state());
        let off = (a.bases[0].translation.vector - b.bases[0].translation.vector).norm();
        // At the midpoint a law of a body is evaluated a second time, at its mean twist: a constant one is the same.
        assert!(off < 1e-12, "{integrator:?}: {off:e} m");
        assert!((a.q[1] - b.q[1]).abs() < 1e-12, "{integrator:?}: {} and {} rad", a.q[1], b.q[1]);
        let mut free = flying(Vec::new(), &setup);
        run(&mut free, STEPS);
        assert!((a.q[1] - free.state().q[1]).abs() > 1e-2 && free.state().bases[0] != a.bases[0]);
        // Without a push nothing from outside acts: its momentum stays.
        pushed.push(None);
        let before = pushed.state().momentum[0];
        run(&mut pushed, STEPS);
        let gained = pushed.state().momentum[0] - before;
        assert!(gained.force.norm() < 1e-12 && gained.moment.norm() < 1e-12, "{integrator:?}: {gained:?}");
    }
}
