//! From a scene to a run: the model's specification with what is seen, and the loop that drives and records it.
//!
//! ```
//! use lab::bench::Bench;
//! let mut bench = Bench::new("falling-block", 1e-3).gravity([0.0, 0.0, -9.81]);
//! bench.add_floor();
//! let block = bench.add_vehicle("block", &lab::scene::box_robot(1.0, [0.1, 0.1, 0.05]), sim::Base::Free);
//! bench.add_shape(Some(block), 0, contact::Shape::Cuboid { half_extents: [0.1, 0.1, 0.05].into() });
//! bench.pair("floor", "block", lab::scene::stiff_contact(0.4));
//! let mut rig = bench.build()?;
//! rig.place(block, [0.0, 0.0, 0.05 - 1e-9], [0.0; 3]);
//! rig.run(1000, |_| {})?;
//! assert!(rig.world.touches().count() == 4);
//! # Ok::<(), lab::LabError>(())
//! ```

use crate::LabError;
use contact::Shape;
use multibody::{Geometry, RobotDescription, Tree, Visual};
use record::{Log, Meta, Recorder, RecorderPlan, Scene, SceneVehicle};
use sim::{Actuator, ActuatorKind, Base, Environment, Integrator, Model, ModelSpec, Observer, PairLaw, ShapeSpec};
use sim::{State, VehicleSpec, World};
use spatial::{Pose, Twist, Vec3};
use std::sync::Arc;

/// A world under construction, and how it looks.
#[derive(Debug)]
pub struct Bench {
    /// Name of the experiment, for errors and files.
    pub experiment: &'static str,
    /// What the world is made of; free to be changed until [`Bench::build`].
    pub spec: ModelSpec,
    /// What is seen.
    pub scene: Scene,
}

impl Bench {
    /// An empty world in deep space, implicit Euler at `step` (s).
    pub fn new(experiment: &'static str, step: f64) -> Self {
        let spec = ModelSpec {
            vehicles: Vec::new(),
            shapes: Vec::new(),
            pairs: Vec::new(),
            actuators: Vec::new(),
            effects: Vec::new(),
            mechanisms: Vec::new(),
            environment: Environment::DeepSpace,
            integrator: Integrator::ImplicitEuler,
            step,
        };
        Self { experiment, spec, scene: Scene::default() }
    }

    /// The same in a uniform field, m/s², W axes.
    pub fn gravity(mut self, gravity: [f64; 3]) -> Self {
        self.spec.environment = Environment::Uniform { gravity: gravity.into() };
        self
    }

    /// The same with another integrator.
    pub fn integrator(mut self, integrator: Integrator) -> Self {
        self.spec.integrator = integrator;
        self
    }

    /// Adds a vehicle with the visuals of its description; its index.
    pub fn add_vehicle(&mut self, name: &str, robot: &RobotDescription, base: Base) -> usize {
        let tree = Tree::from_description(robot);
        self.spec.vehicles.push(VehicleSpec { name: name.to_owned(), tree, base });
        self.scene.vehicles.push(SceneVehicle::from_robot(name, robot));
        self.spec.vehicles.len() - 1
    }

    /// Adds the half-space z ≤ 0 as the world's shape "floor", and a plate to be seen.
    pub fn add_floor(&mut self) {
        let name = "floor".to_owned();
        let pose_ls = Pose::identity();
        self.spec.shapes.push(ShapeSpec { name, vehicle: None, link: 0, pose_ls, shape: Shape::HalfSpace });
        self.scene.fixtures.push(Visual {
            name: "floor".to_owned(),
            pose_ls: Pose::translation(0.0, 0.0, -0.01),
            geometry: Geometry::Box { size: Vec3::new(2.0, 2.0, 0.02) },
            rgba: Some([0.75, 0.75, 0.78, 1.0]),
        });
    }

    /// Adds a shape in the frame of a vehicle's link, named as that vehicle (the world's: "world").
    pub fn add_shape(&mut self, vehicle: Option<usize>, link: usize, shape: Shape) {
        let name = vehicle.map_or("world", |v| self.spec.vehicles[v].name.as_str()).to_owned();
        self.spec.shapes.push(ShapeSpec { name, vehicle, link, pose_ls: Pose::identity(), shape });
    }

    /// Lets all shapes of one name touch all of another under a law; the force is counted on the second.
    pub fn pair(&mut self, a: &str, b: &str, law: PairLaw) {
        let named = |name: &str| -> Vec<usize> {
            self.spec.shapes.iter().enumerate().filter(|(_, s)| s.name == name).map(|(i, _)| i).collect()
        };
        let (of_a, of_b) = (named(a), named(b));
        self.spec.pairs.extend(of_a.iter().flat_map(|i| of_b.iter().map(move |j| ([*i, *j], law))));
    }

    /// Adds an actuator; its index among the commands.
    pub fn add_actuator(&mut self, name: &str, kind: ActuatorKind) -> usize {
        self.spec.actuators.push(Actuator { name: name.to_owned(), kind });
        self.spec.actuators.len() - 1
    }

    /// Adds a spring (N/m) between a joint coordinate and the position that is commanded; its index among the commands.
    pub fn add_spring(&mut self, name: &str, coordinate: usize, stiffness: f64, damping: f64) -> usize {
        self.add_actuator(name, ActuatorKind::JointDrive { coordinate, stiffness, damping, limit: f64::INFINITY })
    }

    /// Checks the model; everything stands at the origin.
    pub fn build(self) -> Result<Rig, LabError> {
        let experiment = self.experiment;
        let model = Arc::new(Model::build(self.spec).map_err(|source| LabError::Model { experiment, source })?);
        let state = State::new(&model);
        Ok(Rig { experiment, world: World::new(model, state), scene: self.scene })
    }
}

/// A world that runs, and how it looks.
#[derive(Debug)]
pub struct Rig {
    /// Name of the experiment.
    pub experiment: &'static str,
    /// The world.
    pub world: World,
    /// What is seen.
    pub scene: Scene,
}

impl Rig {
    /// Puts a vehicle's base at a place (m) with a rotation vector (rad), W axes.
    pub fn place(&mut self, vehicle: usize, position: [f64; 3], turned: [f64; 3]) {
        let rotation = spatial::Rot::from_scaled_axis(turned.into());
        self.world.state_mut().bases[vehicle] = Pose::from_parts(Vec3::from(position).into(), rotation);
        self.world.refresh();
    }

    /// Sets the twists of all bases (about their origins, W axes).
    pub fn throw(&mut self, twists: &[Twist]) {
        self.world.set_base_twists(twists);
    }

    /// Base origin of a vehicle, m.
    pub fn position(&self, vehicle: usize) -> Vec3 {
        self.world.state().bases[vehicle].translation.vector
    }

    /// Velocity of a vehicle's base origin, m/s.
    pub fn velocity(&self, vehicle: usize) -> Vec3 {
        self.world.kinematics(vehicle).vel[0].lin
    }

    /// Sum of the friction forces on B of all touching points, N.
    pub fn friction_force(&self) -> Vec3 {
        self.world.touches().map(|t| t.force_w - t.normal_w * t.normal_w.dot(&t.force_w)).sum()
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.world.state().time
    }

    /// One step.
    pub fn advance(&mut self) -> Result<(), LabError> {
        let experiment = self.experiment;
        self.world.advance().map_err(|source| LabError::Step { experiment, source })
    }

    /// `steps` steps; `drive` may write the commands before each.
    pub fn run(&mut self, steps: u64, mut drive: impl FnMut(&mut World)) -> Result<(), LabError> {
        for _ in 0..steps {
            drive(&mut self.world);
            self.advance()?;
        }
        Ok(())
    }

    /// A recorder of all channels with a sample every `every` steps; feed it with [`Film::shoot`] after each step.
    pub fn film(&self, every: u64) -> Film {
        let meta = Meta {
            scenario: self.experiment.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            ..Meta::default()
        };
        let links = self.scene.vehicles.iter().map(|v| v.links.len()).collect();
        let plan = RecorderPlan { meta, every, probes: Vec::new(), keep: Box::new(|_| true), links };
        Film { recorder: Recorder::new(&self.world, plan, None) }
    }
}

/// The recording of a run.
#[derive(Debug)]
pub struct Film {
    recorder: Recorder<'static>,
}

impl Film {
    /// Looks at the world; keeps every so many-th sample.
    pub fn shoot(&mut self, world: &World) {
        self.recorder.observe(world);
    }

    /// The log with what its scene looks like, or the first error that a sample met.
    pub fn develop(self, rig: &Rig) -> Result<Option<(Log, Scene)>, LabError> {
        match self.recorder.error {
            Some(error) => Err(error.into()),
            None => Ok(Some((self.recorder.log, rig.scene.clone()))),
        }
    }
}
