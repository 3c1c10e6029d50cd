//! One scene for every element that makes a force: small, and with most of its energy through that element.

use super::planted::Force;
use crate::support::effects::{on_joint, wheel_spec};
use crate::support::mechanisms::{at, ground, mechanism, on, struck_ring, two_blocks};
use crate::support::scenes::{box_hits_plate, driven_arm, flying_ball, gripper, sliding_block};
use crate::support::{
    Setup, arm7, block, bristle, hunt_crossley, joint, linear, link, robot, shape, spec, twist, world,
};
use contact::{Bed, Shape};
use friction::{Bristle, Pivot};
use multibody::JointKind;
use sim::{
    Actuator, ActuatorKind, Appendage, Axes, Base, BodyEffect, BodyLaw, Bushing, Capture, Command, Drive, DriveAxis,
    DrivePath, DryLevel, Effect, EffectKind, JointLaw, Latch, LineEffect, LineLaw, Load, MechanismKind, Model,
    ModelSpec, Overload, PairLaw, PullIn, Series, ShapeSpec, Slosh, Sphere, State, Strength, Strut, World,
};
use spatial::{Pose, Rot, Vec3};
use std::sync::Arc;

/// A scene.
pub(super) struct Element {
    pub name: &'static str,
    pub build: fn(&Setup) -> World,
    pub command: fn(f64, &mut [Command]),
    /// s.
    pub duration: f64,
    /// The coarse step, s.
    pub step: f64,
    /// Whether its laws have no corner on the way.
    pub is_smooth: bool,
    /// Where its force is read.
    pub force: Force,
}

fn idle(_: f64, _: &mut [Command]) {}

fn swing(t: f64, commands: &mut [Command]) {
    for (i, command) in commands.iter_mut().enumerate() {
        let rate = 5.0 + i as f64;
        (command.position, command.velocity) = (0.3 * (rate * t).sin(), 0.3 * rate * (rate * t).cos());
        command.effort = 2.0 * (rate * t).sin();
    }
}

fn one(_: f64, commands: &mut [Command]) {
    commands.fill(Command { effort: 1.0, ..Command::default() });
}

/// Every element, with steps that resolve its springs.
pub(super) fn all() -> Vec<Element> {
    let mut all = joints();
    all.extend(bodies());
    all.extend(contacts());
    all.extend(mechanisms());
    all
}

fn smooth(name: &'static str, force: Force, build: fn(&Setup) -> World, [duration, step]: [f64; 2]) -> Element {
    Element { name, build, command: idle, duration, step, is_smooth: true, force }
}

fn cornered(name: &'static str, force: Force, build: fn(&Setup) -> World, times: [f64; 2]) -> Element {
    Element { is_smooth: false, ..smooth(name, force, build, times) }
}

fn swung(element: Element) -> Element {
    Element { command: swing, ..element }
}

fn contacts() -> Vec<Element> {
    let of = |name, build| cornered(name, Force::Contact, build, [0.1, 2e-4]);
    let longer = |name, build| Element { duration: 0.3, ..of(name, build) };
    vec![
        of("normal spring and damper", |s| flying_ball(linear(1e4, 30.0), 3e-3, -0.5, s)),
        of("Hunt-Crossley", |s| flying_ball(hunt_crossley(2e5, 1.5, 0.6), 3e-3, -0.5, s)),
        of("undamped spring", |s| flying_ball(linear(1e4, 0.0), 3e-3, -0.5, s)),
        longer("bristle", |s| sliding(bristle(0.4, 2e4, 30.0), s)),
        longer("bristle with levels", |s| sliding(levels(), s)),
        longer("spin resistance", spinning_ball),
        of("bed", sliding_disc),
        longer("box on a plate", box_hits_plate),
        longer("grasp", gripper),
    ]
}

fn mechanisms() -> Vec<Element> {
    let of = Force::Mechanism;
    vec![
        smooth("bushing", of, swinging, [1.0, 1e-3]),
        smooth("struts", of, |s| struck_ring(strut(), s), [1.0, 1e-3]),
        cornered("struts with stops", of, |s| struck_ring(stopped(), s), [1.0, 2e-4]),
        cornered("latch with pull-in", of, |s| latched(f64::INFINITY, s), [1.2, 5e-4]),
        cornered("latch that lets go", of, |s| latched(30.0, s), [1.2, 5e-4]),
        smooth("driven base", of, shaken, [1.0, 1e-3]),
    ]
}

fn bodies() -> Vec<Element> {
    let of = |name, build| smooth(name, Force::External, build, [1.0, 1e-3]);
    vec![
        Element { force: Force::Hidden, ..of("free arm", moving_arm) },
        Element { command: one, duration: 2.0, ..of("thrust and drag", thrust_and_drag) },
        of("gravity gradient", falling_arm),
        of("loads on a body", loaded),
        Element { duration: 2.0, step: 2e-3, ..of("parts in a body", with_parts) },
        Element { command: one, ..of("tilt", tilted) },
    ]
}

fn joints() -> Vec<Element> {
    let of = |name, build| swung(smooth(name, Force::Wheel, build, [1.0, 1e-3]));
    let corner = |name, build, step| swung(cornered(name, Force::Wheel, build, [0.5, step]));
    let stopped = |s: &Setup| wheel_of(&[], |j| j.position_limits = Some([-0.1, 0.12]), s);
    let dry = |s: &Setup| wheel_with(JointLaw::Dry(DryLevel::Constant(0.3).into()), s);
    vec![
        Element { force: Force::Hidden, duration: 0.5, step: 2e-4, ..of("joint drives", driven_arm) },
        of("joint damping", |s| wheel_of(&[], |j| j.damping = 0.4, s)),
        corner("joint friction", |s| wheel_of(&[], |j| j.friction = 0.3, s), 1e-3),
        corner("joint stops", stopped, 4e-5),
        of("viscous effect", |s| wheel_with(JointLaw::Viscous { damping: 0.4 }, s)),
        corner("dry effect", dry, 5e-4),
        of("viscous by side", |s| wheel_with(JointLaw::ViscousBySide { plus: 0.4, minus: 0.1 }, s)),
        of("quadratic", |s| wheel_with(JointLaw::Quadratic { drag: 0.4 }, s)),
        of("offset", |s| wheel_with(JointLaw::Offset { effort: 0.6 }, s)),
        of("ripple", |s| wheel_with(JointLaw::Ripple { amplitude: 0.5, order: 6.0, phase: 0.2 }, s)),
        of("cable", |s| wheel_with(JointLaw::Cable { stiffness: 5.0, rest: 0.3 }, s)),
        of("disturbance", |s| wheel_with(JointLaw::Periodic { amplitude: 0.8, frequency: 1.3, phase: 0.2 }, s)),
        Element { step: 2e-4, ..of("gear", |s| geared(0.0, s)) },
        corner("gear with play", |s| geared(5e-3, s), 2e-4),
        Element { step: 5e-4, ..of("lag", |s| wheel_of(&[lag()], |_| {}, s)) },
    ]
}

fn moving_arm(setup: &Setup) -> World {
    let mut world = world(spec(vec![(arm7(), Base::Free)], setup));
    world.state_mut().v.copy_from_slice(&[0.5, -0.4, 0.6, 0.5, -0.7, 0.6, 1.0]);
    world.set_base_twists(&[twist([0.1, -0.05, 0.2], [0.1, 0.0, 0.0])]);
    world
}

fn falling_arm(setup: &Setup) -> World {
    let environment = sim::Environment::Orbit { mean_motion: 0.4, gravity_gradient: true };
    let mut world = moving_arm(&Setup { environment, ..*setup });
    world.state_mut().bases[0].translation.vector = Vec3::new(3.0, -2.0, 1.0);
    world
}

/// A block that a jet along z lifts through its centre of mass, against drag.
pub(super) fn climbing(setup: &Setup) -> World {
    let effects = vec![body_effect(BodyLaw::Load(Load::LinearDrag { c: 0.6 }))];
    let mut spec = ModelSpec { effects, ..spec(vec![(block(4.0, Vec3::new(0.1, 0.2, 0.3)), Base::Free)], setup) };
    let kind = ActuatorKind::Thruster { body: 0, position: Vec3::zeros(), direction: Vec3::z(), max_force: 20.0 };
    spec.actuators = vec![Actuator { name: "jet".to_owned(), kind }];
    let mut world = world(spec);
    world.commands_mut()[0].effort = 20.0;
    world
}

/// A jet against drag on a block that turns, commanded from the start.
fn thrust_and_drag(setup: &Setup) -> World {
    let effects = vec![body_effect(BodyLaw::Load(Load::LinearDrag { c: 0.6 }))];
    let mut spec = ModelSpec { effects, ..spec(vec![(block(4.0, Vec3::new(0.1, 0.2, 0.3)), Base::Free)], setup) };
    let (position, direction) = (Vec3::new(0.05, 0.0, -0.1), Vec3::new(0.0, 0.6, 0.8));
    let kind = ActuatorKind::Thruster { body: 0, position, direction, max_force: 5.0 };
    spec.actuators = vec![Actuator { name: "jet".to_owned(), kind }];
    let mut world = world(spec);
    world.set_base_twists(&[twist([0.0, 0.0, 0.2], [0.1, 0.3, 0.2])]);
    world.commands_mut()[0].effort = 2.0;
    world
}

fn body_effect(law: BodyLaw) -> Effect {
    Effect { name: format!("{law:?}"), kind: EffectKind::Body(BodyEffect::new(0, 0, law)) }
}

/// A wheel with a motor, whose joint is changed, and effects.
fn wheel_of(kinds: &[EffectKind], change: fn(&mut multibody::Joint), setup: &Setup) -> World {
    let mut spec = wheel_spec(kinds, setup);
    change(&mut spec.vehicles[0].tree.joints[0]);
    world(spec)
}

fn wheel_with(law: JointLaw, setup: &Setup) -> World {
    wheel_of(&[on_joint(law)], |_| {}, setup)
}

fn geared(gap: f64, setup: &Setup) -> World {
    let gear = Series { coordinate: 0, rotor: 0.2, stiffness: 400.0, damping: 0.5, gap };
    wheel_of(&[EffectKind::Series(gear)], |_| {}, setup)
}

fn lag() -> EffectKind {
    EffectKind::Line(LineEffect { actuator: 0, law: LineLaw::Lag(0.05) })
}

fn sliding(friction: friction::Friction, setup: &Setup) -> World {
    sliding_block(PairLaw::new(linear(1e5, 200.0), Some(friction)), 0.3, setup)
}

fn levels() -> friction::Friction {
    Bristle {
        mu_static: 0.5,
        mu_kinetic: 0.3,
        stribeck_speed: 0.05,
        stiffness: 2e4,
        damping: 30.0,
        viscous: 1.0,
        ..Bristle::default()
    }
    .into()
}

/// A ball in gravity that spins and rolls on its lowest point.
fn spinning_ball(setup: &Setup) -> World {
    let ball = robot(vec![link("ball", 1.0, Vec3::zeros(), Vec3::repeat(4e-3))], Vec::new());
    let mut spec = spec(vec![(ball, Base::Free)], &setup.gravity(-9.81 * Vec3::z()));
    let pivot = Pivot { spin_lever: 0.01, rolling_lever: 0.003, stiffness: 10.0, damping: 0.01 };
    let law = PairLaw::new(linear(1e5, 200.0), Some(bristle(0.4, 2e4, 30.0)));
    spec.shapes = vec![shape("floor", None, Shape::HalfSpace), shape("ball", Some(0), Shape::Ball { radius: 0.1 })];
    spec.pairs = vec![([0, 1], PairLaw { pivot: Some(pivot), ..law })];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, 0.1 - 9.81e-5);
    world.set_base_twists(&[twist([0.0, 3.0, 8.0], [0.3, 0.0, 0.0])]);
    world
}

/// A disc on its elastic face, sliding and spinning.
fn sliding_disc(setup: &Setup) -> World {
    let tree = robot(vec![link("disc", 2.0, Vec3::zeros(), 0.02 * Vec3::new(0.25, 0.25, 0.5))], Vec::new());
    let mut spec = spec(vec![(tree, Base::Free)], &setup.gravity(-9.81 * Vec3::z()));
    let face = Shape::Bed(Bed::disc(0.1, 32));
    let pose_ls = Pose::rotation(std::f64::consts::PI * Vec3::x());
    spec.shapes = vec![shape("floor", None, Shape::HalfSpace), ShapeSpec { pose_ls, ..shape("face", Some(0), face) }];
    spec.pairs = vec![([0, 1], PairLaw::new(linear(1e5, 300.0), Some(bristle(0.3, 5e4, 50.0))))];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, -2.0 * 9.81 / 1e5);
    world.set_base_twists(&[twist([0.0, 0.0, 3.0], [0.2, 0.0, 0.0])]);
    world
}

fn swinging(setup: &Setup) -> World {
    let hold = Bushing {
        stiffness: Vec3::new(150.0, 400.0, 900.0),
        damping: Vec3::new(2.0, 1.0, 3.0),
        torsional_stiffness: Vec3::new(8.0, 3.0, 15.0),
        torsional_damping: Vec3::new(0.05, 0.1, 0.02),
    };
    let tie = mechanism("tie", at(0, 0.1, 0.0, 0.05), at(1, -0.1, 0.02, 0.0), MechanismKind::Bushing(hold));
    let mut world = two_blocks([2.0, 3.0], vec![tie], setup);
    let turn = Rot::from_scaled_axis(Vec3::new(0.3, -0.35, 0.2));
    world.state_mut().bases[1] = Pose::from_parts(Vec3::new(0.23, -0.04, 0.06).into(), turn);
    world.set_base_twists(&[twist([0.5, -0.3, 0.2], [0.1, 0.2, -0.1]), twist([-0.4, 0.6, 1.0], [-0.2, 0.0, 0.3])]);
    world
}

fn strut() -> Strut {
    Strut { rest_length: 0.35, stiffness: 600.0, damping: 60.0, preload: -15.0, ..Strut::default() }
}

fn stopped() -> Strut {
    Strut { stroke: [0.33, 0.37], stop_stiffness: 1e4, stop_dissipation: 0.5, ..strut() }
}

/// A block that flies into a latch, is pulled in, and torn off by a jet where the latch is weaker than that.
fn latched(strength: f64, setup: &Setup) -> World {
    let hold = Bushing::isotropic([2e3, 30.0], [60.0, 1.0]);
    let capture =
        Capture { axial: [-0.005, 0.02], lateral: 0.03, tilt: 0.1, roll: 0.2, closing_speed: [0.01, 0.3], dwell: 0.0 };
    let pull_in = Some(PullIn { speed: 0.02, turn_rate: 0.1 });
    let strength = Strength { force: strength, moment: f64::INFINITY };
    let latch = Latch { capture, hold, strength, overload: Overload::LetsGo, pull_in };
    let face = Pose::translation(0.0, 0.0, -0.2);
    let mut spec = spec(vec![(block(2.0, Vec3::new(0.1, 0.15, 0.2)), Base::Free)], setup);
    spec.mechanisms = vec![mechanism("hook", ground(Pose::identity()), on(0, face), MechanismKind::Latch(latch))];
    let kind = ActuatorKind::Thruster { body: 0, position: Vec3::zeros(), direction: Vec3::z(), max_force: 1e3 };
    spec.actuators = vec![Actuator { name: "jet".to_owned(), kind }];
    let mut world = world(spec);
    world.commands_mut()[0].effort = if strength.force.is_finite() { 20.0 } else { 0.5 };
    let turn = Rot::from_scaled_axis(Vec3::new(0.05, 0.02, 0.1));
    let place = Vec3::new(0.02, 0.0, 0.021) - turn * face.translation.vector;
    world.state_mut().bases[0] = Pose::from_parts(place.into(), turn);
    world.set_base_twists(&[twist([0.0; 3], [0.0, 0.0, -0.2])]);
    world
}

/// A block on a spring from a stage that shakes and turns.
fn shaken(setup: &Setup) -> World {
    let hold = Bushing::isotropic([200.0, 4.0], [8.0, 0.2]);
    let spring = mechanism("spring", at(0, 0.0, 0.0, 0.0), at(1, 0.0, 0.0, 0.0), MechanismKind::Bushing(hold));
    let vehicles = vec![(block(5.0, Vec3::repeat(0.1)), Base::Fixed), (block(2.0, Vec3::repeat(0.1)), Base::Free)];
    let model = Model::build(ModelSpec { mechanisms: vec![spring], ..spec(vehicles, setup) }).unwrap();
    let paths = vec![
        (DriveAxis::X, Arc::new(DrivePath::sine(0.02, 1.2, 0.0))),
        (DriveAxis::AboutZ, Arc::new(DrivePath::sine(0.1, 0.7, 0.4))),
    ];
    let drive = Drive { name: "stage".to_owned(), vehicle: 0, frame: Pose::identity(), start: Pose::identity(), paths };
    let model = Arc::new(model.with_drives(vec![drive]).unwrap());
    let state = State::new(&model);
    World::new(model, state)
}

fn loaded(setup: &Setup) -> World {
    let loads = [
        Load::ConstantForce { vector: Vec3::new(1.0, 2.0, 3.0), axes: Axes::Body },
        Load::ConstantTorque { vector: Vec3::new(0.1, -0.2, 0.1), axes: Axes::World },
        Load::QuadraticDrag { c: 3.0 },
        Load::AngularDamping { c: 0.4 },
        Load::Tether { k: 8.0, d: 0.5, anchor: Vec3::new(0.2, 0.0, 0.1) },
        Load::Periodic { amplitude: Vec3::new(2.0, 0.0, 1.0), is_force: true, rate: 3.0, phase: 0.4 },
        Load::GravityGradient { mean_motion: 0.3 },
    ];
    let effects = loads.map(|load| body_effect(BodyLaw::Load(load))).to_vec();
    let tree = block(12.0, Vec3::new(0.3, 0.2, 0.1));
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, Base::Free)], setup) });
    world.set_base_twists(&[twist([0.3, 0.0, 0.5], [0.4, 0.1, 0.0])]);
    world
}

/// A body with a sloshing mass, a flexible mode and a sphere inside, in gravity.
fn with_parts(setup: &Setup) -> World {
    let laws = [
        BodyLaw::Slosh(Slosh { mass: 4.0, rate: 5.0, damping: 0.05, rest: Vec3::new(0.35, 0.1, 0.45) }),
        BodyLaw::Appendage(Appendage { rate: 6.0, damping: 0.03, coupling: 2.0 * Vec3::new(0.8, -0.4, 0.6) }),
        BodyLaw::Sphere(Sphere { inertia: 1.5, c: 0.4 }),
    ];
    let effects = laws.map(body_effect).to_vec();
    let tree = robot(vec![link("body", 45.0, Vec3::new(0.1, -0.05, 0.2), Vec3::new(9.5, 16.0, 21.5))], Vec::new());
    let gravity = Vec3::new(0.5, 0.2, -1.5);
    let mut world = world(ModelSpec { effects, ..spec(vec![(tree, Base::Free)], &setup.gravity(gravity)) });
    world.set_base_twists(&[twist([0.3, 0.5, -0.2], [0.1, 0.0, 0.2])]);
    let n = world.effect_memory().len();
    let relative: Vec<f64> = (0..n).map(|k| 0.05 - 0.01 * k as f64).collect();
    world.set_effect_memory(&relative);
    world
}

/// A table out of level under a block with an arm's joint.
fn tilted(setup: &Setup) -> World {
    let hinge = joint("hinge", 0, Vec3::new(0.1, 0.0, 0.0), Vec3::z(), JointKind::Revolute);
    let links = vec![
        link("base", 3.0, Vec3::zeros(), Vec3::repeat(0.05)),
        link("boom", 1.0, Vec3::new(0.2, 0.0, 0.0), Vec3::repeat(0.02)),
    ];
    let tilt = Effect { name: "tilt".to_owned(), kind: EffectKind::Tilt(Vec3::new(0.3, -0.1, 0.0)) };
    let motor = ActuatorKind::JointEffort { coordinate: 0, limit: 5.0 };
    let spec = ModelSpec {
        effects: vec![tilt],
        actuators: vec![Actuator { name: "motor".to_owned(), kind: motor }],
        ..spec(vec![(robot(links, vec![hinge]), Base::Only([false, false, true, true, true, false]))], setup)
    };
    world(spec)
}
