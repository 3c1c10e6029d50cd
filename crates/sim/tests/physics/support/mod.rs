//! Small worlds for the tests.

pub(crate) mod effects;
pub(crate) mod elliptic;
pub(crate) mod mechanisms;
pub(crate) mod scenes;
pub(crate) mod table;

use contact::{Normal, NormalLaw, Shape};
use friction::{Bristle, Friction};
use multibody::{Inertial, JointDescription, JointKind, LinkDescription, RobotDescription, Tree};
use sim::{Base, Environment, Integrator, Model, ModelSpec, ShapeSpec, State, VehicleSpec, World};
use spatial::{Mat3, Pose, Twist, Vec3};
use std::sync::Arc;

pub(crate) const ALL: [Integrator; 4] =
    [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint, Integrator::SemiImplicitEuler, Integrator::RungeKutta4];

pub(crate) fn link(name: &str, mass: f64, com: Vec3, moments: Vec3) -> LinkDescription {
    LinkDescription {
        name: name.to_owned(),
        inertial: Some(Inertial { mass, com, tensor_com: Mat3::from_diagonal(&moments) }),
        visuals: Vec::new(),
        collisions: Vec::new(),
    }
}

pub(crate) fn joint(name: &str, parent: usize, origin: Vec3, axis: Vec3, kind: JointKind) -> JointDescription {
    JointDescription {
        name: name.to_owned(),
        kind,
        parent,
        pose_pj: Pose::translation(origin.x, origin.y, origin.z),
        axis,
        position_limits: None,
        effort_limit: f64::INFINITY,
        velocity_limit: f64::INFINITY,
        damping: 0.0,
        friction: 0.0,
        mimic: None,
    }
}

pub(crate) fn robot(links: Vec<LinkDescription>, joints: Vec<JointDescription>) -> Tree {
    let file = "test.urdf".into();
    Tree::from_description(&RobotDescription { name: "test".to_owned(), file, links, joints })
}

/// A box of uniform density.
pub(crate) fn block(mass: f64, half: Vec3) -> Tree {
    let moments = mass / 3.0
        * Vec3::new(
            half.y * half.y + half.z * half.z,
            half.x * half.x + half.z * half.z,
            half.x * half.x + half.y * half.y,
        );
    robot(vec![link("block", mass, Vec3::zeros(), moments)], Vec::new())
}

/// A 60 kg base with a seven-joint arm of 18 kg.
pub(crate) fn arm7() -> Tree {
    let mut links = vec![link("base", 60.0, Vec3::new(0.0, 0.0, 0.05), Vec3::new(4.0, 3.5, 5.0))];
    let mut joints = Vec::new();
    let rows = [
        (4.0, 0.15, Vec3::z(), 0.3),
        (4.0, 0.19, Vec3::y(), 0.03),
        (3.0, 0.21, Vec3::z(), 0.025),
        (2.7, 0.19, Vec3::y(), 0.024),
        (1.7, 0.21, Vec3::z(), 0.02),
        (1.8, 0.19, Vec3::y(), 0.012),
        (1.0, 0.08, Vec3::z(), 0.01),
    ];
    for (i, (mass, z, axis, moment)) in rows.into_iter().enumerate() {
        let com = Vec3::new(0.01, 0.02, 0.09);
        links.push(link(&format!("l{}", i + 1), mass, com, Vec3::new(moment, 0.9 * moment, 0.5 * moment)));
        joints.push(joint(&format!("j{}", i + 1), i, Vec3::new(0.0, 0.0, z), axis, JointKind::Revolute));
    }
    robot(links, joints)
}

/// What varies between the small worlds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup {
    pub(crate) integrator: Integrator,
    pub(crate) step: f64,
    pub(crate) environment: Environment,
}

impl Setup {
    /// 1 ms in deep space.
    pub(crate) fn new(integrator: Integrator) -> Self {
        Self { integrator, step: 1e-3, environment: Environment::DeepSpace }
    }

    pub(crate) fn step(self, step: f64) -> Self {
        Self { step, ..self }
    }

    pub(crate) fn gravity(self, gravity: Vec3) -> Self {
        Self { environment: Environment::Uniform { gravity }, ..self }
    }
}

pub(crate) fn spec(vehicles: Vec<(Tree, Base)>, setup: &Setup) -> ModelSpec {
    let vehicles = vehicles
        .into_iter()
        .enumerate()
        .map(|(i, (tree, base))| VehicleSpec { name: format!("vehicle{i}"), tree, base })
        .collect();
    ModelSpec {
        vehicles,
        shapes: Vec::new(),
        pairs: Vec::new(),
        mechanisms: Vec::new(),
        actuators: Vec::new(),
        effects: Vec::new(),
        environment: setup.environment,
        integrator: setup.integrator,
        step: setup.step,
    }
}

/// A world at the state where everything stands at the origin.
pub(crate) fn world(spec: ModelSpec) -> World {
    let model = Arc::new(Model::build(spec).expect("the model is sound"));
    let state = State::new(&model);
    World::new(model, state)
}

pub(crate) fn free_world(tree: Tree, setup: &Setup) -> World {
    world(spec(vec![(tree, Base::Free)], setup))
}

pub(crate) fn linear(stiffness: f64, damping: f64) -> Normal {
    Normal::new(NormalLaw::SpringDamper { stiffness, damping })
}

pub(crate) fn hunt_crossley(stiffness: f64, exponent: f64, dissipation: f64) -> Normal {
    Normal::new(NormalLaw::HuntCrossley { stiffness, exponent, dissipation })
}

pub(crate) fn bristle(mu: f64, stiffness: f64, damping: f64) -> Friction {
    Bristle { mu_static: mu, mu_kinetic: mu, stiffness, damping, ..Bristle::default() }.into()
}

pub(crate) fn shape(name: &str, vehicle: Option<usize>, shape: Shape) -> ShapeSpec {
    ShapeSpec { name: name.to_owned(), vehicle, link: 0, pose_ls: Pose::identity(), shape }
}

pub(crate) fn twist(ang: [f64; 3], lin: [f64; 3]) -> Twist {
    Twist::new(ang.into(), lin.into())
}

pub(crate) fn run(world: &mut World, steps: usize) {
    for _ in 0..steps {
        world.advance().expect("the run stays finite");
    }
}
