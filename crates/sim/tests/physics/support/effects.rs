//! A wheel on a fixed post with effects, and what the tests of effects share.

use super::{Setup, joint, link, robot, spec, world};
use multibody::{JointKind, Tree};
use sim::{Actuator, ActuatorKind, Base, Effect, EffectKind, JointEffect, JointLaw, ModelSpec, World};
use spatial::Vec3;

/// Of the wheel about its axle, kg·m².
pub(crate) const INERTIA: f64 = 0.5;

pub(crate) fn wheel() -> Tree {
    let hinge = joint("hinge", 0, Vec3::zeros(), Vec3::z(), JointKind::Revolute);
    let post = link("post", 1.0, Vec3::zeros(), Vec3::repeat(0.1));
    robot(vec![post, link("wheel", 1.0, Vec3::zeros(), Vec3::repeat(INERTIA))], vec![hinge])
}

/// The wheel with a motor and effects.
pub(crate) fn wheel_spec(kinds: &[EffectKind], setup: &Setup) -> ModelSpec {
    let motor = ActuatorKind::JointEffort { coordinate: 0, limit: 100.0 };
    ModelSpec {
        actuators: vec![Actuator { name: "motor".to_owned(), kind: motor }],
        effects: kinds.iter().map(|kind| Effect { name: format!("{kind:?}"), kind: *kind }).collect(),
        ..spec(vec![(wheel(), Base::Fixed)], setup)
    }
}

pub(crate) fn wheel_world(kinds: &[EffectKind], setup: &Setup) -> World {
    world(wheel_spec(kinds, setup))
}

pub(crate) fn on_joint(law: JointLaw) -> EffectKind {
    EffectKind::Joint(JointEffect { coordinate: 0, law })
}
