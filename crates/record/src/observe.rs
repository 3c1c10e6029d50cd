//! From a running world to a [`Log`]: the observer that samples at the logging rate.
//!
//! | channel | unit |
//! | --- | --- |
//! | `body.<vehicle>.position.{x,y,z}`, `.orientation.{w,x,y,z}`, `.linear_velocity`, `.angular_velocity` (body axes) | m, 1, m/s, rad/s |
//! | `joint.<vehicle>/<joint>.position`, `.velocity`, `.effort` | rad or m, …: encoder and tachometer, on the motor's side of a gear |
//! | `joint.<vehicle>/<joint>.link_position`, `.link_velocity` of joints whose gear yields or has play | the link's side |
//! | `actuator.<name>.command` | position, or effort |
//! | `drive.<name>.position.{x,y,z}`, `.angle`, those that are driven | m, rad |
//! | `contact.<a>.<b>.normal_force`, `.friction_force`, `.points`, `.sliding` by pair of vehicles | N, 1 |
//! | `momentum.*`, `energy.*` of all vehicles together | |
//! | `mechanism.*` | see `mechanisms` |

use crate::{ChannelSpec, ContactSample, Log, Meta, Plot, RecordError, Sample};
use multibody::JointKind;
use sim::{ActuatorKind, DriveAxis, Energy, EnergyAudit, EnergyBalance, Flow, Model, MomentumAudit, Observer, World};
use spatial::{Pose, Vec3};

/// Further channels. Those that have the name of a standard channel take its place: what a sensor makes of it.
pub trait Probe {
    /// What they are.
    fn channels(&self) -> Vec<ChannelSpec>;

    /// Looks at the world before the first step and after each; for sensors, which sample and wait.
    fn observe(&mut self, _: &World) {}

    /// Appends their present values; NaN where nothing was sampled since the last call.
    fn read(&mut self, world: &World, values: &mut Vec<f64>);
}

/// A channel that is a function of the world.
pub struct Function<F> {
    /// What it is.
    pub spec: ChannelSpec,
    /// Its value.
    pub read: F,
}

impl<F: Fn(&World) -> f64> Probe for Function<F> {
    fn channels(&self) -> Vec<ChannelSpec> {
        vec![self.spec.clone()]
    }

    fn read(&mut self, world: &World, values: &mut Vec<f64>) {
        values.push((self.read)(world));
    }
}

/// Who else wants every sample as it comes: a live viewer.
pub trait SampleSink {
    /// Takes one sample.
    fn push(&mut self, sample: &Sample<'_>) -> Result<(), RecordError>;
}

/// Samples a world into a [`Log`].
pub struct Recorder<'a> {
    /// The log so far.
    pub log: Log,
    /// The first error that a sample met; it ends the run.
    pub error: Option<RecordError>,
    probes: Vec<Box<dyn Probe + Send>>,
    /// Where the probes' values stand among the channels.
    places: Vec<usize>,
    keep: Vec<bool>,
    links: Vec<usize>,
    every: u64,
    audit: Option<MomentumAudit>,
    energy: EnergyAudit,
    vehicle_pairs: Vec<(Option<usize>, Option<usize>)>,
    live: Option<&'a mut dyn SampleSink>,
    scratch: Scratch,
}

#[derive(Debug, Default)]
struct Scratch {
    all: Vec<f64>,
    probed: Vec<f64>,
    kept: Vec<f64>,
    poses: Vec<Pose>,
    contacts: Vec<ContactSample>,
}

impl std::fmt::Debug for Recorder<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Recorder").field("samples", &self.log.len()).finish_non_exhaustive()
    }
}

/// What to record.
pub struct RecorderPlan {
    /// What run it is.
    pub meta: Meta,
    /// Steps between two samples.
    pub every: u64,
    /// Further channels, after the standard ones.
    pub probes: Vec<Box<dyn Probe + Send>>,
    /// Which channels are kept.
    pub keep: Box<dyn Fn(&str) -> bool>,
    /// Number of links of each vehicle that the scene shows (rotors are not shown).
    pub links: Vec<usize>,
}

impl std::fmt::Debug for RecorderPlan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RecorderPlan").field("every", &self.every).finish_non_exhaustive()
    }
}

impl RecorderPlan {
    /// The channels that are kept.
    pub fn calc_channels(&self, model: &Model) -> Vec<ChannelSpec> {
        let (mut specs, _) = self.calc_all_channels(model);
        specs.retain(|s| (self.keep)(&s.name));
        specs
    }

    /// All channels, and where those of the probes stand among them.
    fn calc_all_channels(&self, model: &Model) -> (Vec<ChannelSpec>, Vec<usize>) {
        let mut specs = standard_channels(model);
        let mut places = Vec::new();
        for spec in self.probes.iter().flat_map(|p| p.channels()) {
            let at = specs.iter().position(|s| s.name == spec.name).unwrap_or(specs.len());
            if at < specs.len() {
                specs[at] = spec
            } else {
                specs.push(spec)
            }
            places.push(at);
        }
        (specs, places)
    }
}

impl<'a> Recorder<'a> {
    /// A recorder for a world at its start, which also feeds `live`.
    pub fn new(world: &World, plan: RecorderPlan, live: Option<&'a mut dyn SampleSink>) -> Self {
        let vehicle_pairs = vehicle_pairs(world.model());
        let (all, places) = plan.calc_all_channels(world.model());
        let keep: Vec<bool> = all.iter().map(|s| (plan.keep)(&s.name)).collect();
        let kept = plan.calc_channels(world.model());
        let mut log = Log::new(plan.meta, kept, plan.links.iter().sum());
        log.pairs = (0..world.model().scene.pairs().len()).map(|p| world.model().pair_name(p)).collect();
        Self {
            log,
            error: None,
            probes: plan.probes,
            places,
            keep,
            links: plan.links.clone(),
            every: plan.every.max(1),
            audit: MomentumAudit::applies(world).then(|| MomentumAudit::new(world)),
            energy: EnergyAudit::new(world),
            vehicle_pairs,
            live,
            scratch: Scratch { poses: Vec::with_capacity(plan.links.iter().sum()), ..Scratch::default() },
        }
    }

    fn sample(&mut self, world: &World) -> Result<(), RecordError> {
        if let Some(audit) = &mut self.audit {
            audit.update(world);
        }
        let mut values = std::mem::take(&mut self.scratch.all);
        values.clear();
        write_bodies(world, &mut values);
        write_joints(world, &mut values);
        write_drives(world, &mut values);
        write_contacts(world, &self.vehicle_pairs, &mut values);
        write_accounts(world, self.audit.as_ref(), &self.energy.close(world), &mut values);
        crate::mechanisms::write(world, &mut values);
        let Scratch { probed, kept, poses, contacts, .. } = &mut self.scratch;
        probed.clear();
        self.probes.iter_mut().for_each(|p| p.read(world, probed));
        values.resize(self.keep.len(), f64::NAN);
        self.places.iter().zip(&*probed).for_each(|(at, value)| values[*at] = *value);
        kept.clear();
        kept.extend(values.iter().zip(&self.keep).filter(|(_, k)| **k).map(|(v, _)| *v));
        write_poses(world, &self.links, poses);
        write_contact_samples(world, contacts);
        let sample =
            Sample { t: world.state().time, step: world.state().steps, values: kept, poses_w: poses, contacts };
        if let Some(live) = &mut self.live {
            live.push(&sample)?;
        }
        let pushed = self.log.push(&sample);
        self.scratch.all = values;
        pushed
    }
}

impl Observer for Recorder<'_> {
    fn observe(&mut self, world: &World) -> Flow {
        self.probes.iter_mut().for_each(|p| p.observe(world));
        if world.state().steps.is_multiple_of(self.every)
            && let Err(error) = self.sample(world)
        {
            self.error.get_or_insert(error);
            return Flow::Stop;
        }
        Flow::Continue
    }
}

/// Pairs of vehicles (`None`: the world) between which shapes may touch, in order of first appearance.
fn vehicle_pairs(model: &Model) -> Vec<(Option<usize>, Option<usize>)> {
    let mut pairs = Vec::new();
    for pair in 0..model.scene.pairs().len() {
        let key = owners(model, pair);
        if !pairs.contains(&key) {
            pairs.push(key);
        }
    }
    pairs
}

fn owners(model: &Model, pair: usize) -> (Option<usize>, Option<usize>) {
    let (a, b) = model.pair_bodies(pair);
    let owner = |body: usize| model.owners.get(body).map(|o| o.0);
    (owner(a), owner(b))
}

/// The channels that every recording of a model has.
pub fn standard_channels(model: &Model) -> Vec<ChannelSpec> {
    let pairs = vehicle_pairs(model);
    let mut specs = Vec::new();
    let mut add = |name: String, unit: &str, plot: Plot, text: &str| {
        specs.push(ChannelSpec::new(name, unit, plot).described(text));
    };
    for vehicle in &model.vehicles {
        let name = |quantity: &str, axis: &str| format!("body.{}.{quantity}.{axis}", vehicle.name);
        let xyz = ["x", "y", "z"];
        xyz.iter().for_each(|k| add(name("position", k), "m", Plot::Bodies, "base origin in W"));
        let wxyz = ["w", "x", "y", "z"];
        wxyz.iter().for_each(|k| add(name("orientation", k), "1", Plot::Other, "body axes in W"));
        xyz.iter().for_each(|k| add(name("linear_velocity", k), "m/s", Plot::Bodies, "base origin, W axes"));
        xyz.iter().for_each(|k| add(name("angular_velocity", k), "rad/s", Plot::Bodies, "body axes"));
    }
    for vehicle in &model.vehicles {
        for joint in vehicle.tree.joints.iter().filter(|j| !j.is_mimic && j.width == 1) {
            let linear = joint.kind == JointKind::Prismatic;
            let units = if linear { ["m", "m/s", "N"] } else { ["rad", "rad/s", "N·m"] };
            let mut channel = |quantity: &str, unit: &str, text: &str| {
                add(format!("joint.{}/{}.{quantity}", vehicle.name, joint.name), unit, Plot::Joints, text);
            };
            let quantities = [("position", "encoder"), ("velocity", "tachometer"), ("effort", "")];
            quantities.into_iter().zip(units).for_each(|((quantity, text), unit)| channel(quantity, unit, text));
            if model.has_gear(vehicle.v0 + joint.v_index) {
                channel("link_position", units[0], "behind the gear");
                channel("link_velocity", units[1], "behind the gear");
            }
        }
    }
    for actuator in &model.actuators {
        add(format!("actuator.{}.command", actuator.name), unit_of_command(model, &actuator.kind), Plot::Actuators, "");
    }
    for (name, axis) in model.driven_coordinates() {
        let (quantity, unit) = quantity_along(axis);
        add(format!("drive.{name}.{quantity}"), unit, Plot::Actuators, "in the axes of the drive's frame");
    }
    for (a, b) in &pairs {
        let name = |v: &Option<usize>| v.map_or("world", |v| model.vehicles[v].name.as_str()).to_owned();
        let prefix = format!("contact.{}.{}", name(a), name(b));
        add(format!("{prefix}.normal_force"), "N", Plot::Contact, "sum of the points' normal forces");
        add(format!("{prefix}.friction_force"), "N", Plot::Contact, "sum of the points' friction forces");
        add(format!("{prefix}.points"), "1", Plot::Other, "points that press");
        add(format!("{prefix}.sliding"), "1", Plot::Other, "points that slide");
    }
    add("momentum.linear_drift".into(), "1", Plot::Momentum, "relative, from the links");
    add("momentum.angular_drift".into(), "1", Plot::Momentum, "relative, from the links");
    for (quantity, text) in [("kinetic", ""), ("potential", ""), ("elastic", "stored in contacts")] {
        add(format!("energy.{quantity}"), "J", Plot::Energy, text);
    }
    for quantity in ["actuator_work", "contact_work", "contact_loss", "joint_loss", "numerical_loss"] {
        add(format!("energy.{quantity}"), "J", Plot::Energy, "sum since the start");
    }
    specs.extend(crate::mechanisms::channels(model));
    specs
}

/// Quantity and unit of a driven coordinate.
fn quantity_along(axis: DriveAxis) -> (&'static str, &'static str) {
    match axis {
        DriveAxis::X => ("position.x", "m"),
        DriveAxis::Y => ("position.y", "m"),
        DriveAxis::Z => ("position.z", "m"),
        DriveAxis::AboutZ => ("angle", "rad"),
    }
}

/// Unit of what an actuator is commanded: by its kind, and by whether its joint turns or slides.
fn unit_of_command(model: &Model, kind: &ActuatorKind) -> &'static str {
    let of =
        |coordinate, [turning, sliding]: [&'static str; 2]| if model.slides(coordinate) { sliding } else { turning };
    match *kind {
        ActuatorKind::JointEffort { coordinate, .. } => of(coordinate, ["N·m", "N"]),
        ActuatorKind::JointDrive { coordinate, stiffness, .. } if stiffness > 0.0 => of(coordinate, ["rad", "m"]),
        ActuatorKind::JointDrive { coordinate, .. } => of(coordinate, ["rad/s", "m/s"]),
        ActuatorKind::Thruster { .. } => "N",
        ActuatorKind::LatchRelease { .. } => "1",
    }
}

fn write_bodies(world: &World, values: &mut Vec<f64>) {
    for (i, pose) in world.state().bases.iter().enumerate() {
        let (p, q, twist) = (pose.translation.vector, pose.rotation, world.kinematics(i).vel[0]);
        values.extend_from_slice(p.as_slice());
        values.extend([q.w, q.i, q.j, q.k]);
        values.extend_from_slice(twist.lin.as_slice());
        values.extend_from_slice((q.inverse() * twist.ang).as_slice());
    }
}

fn write_joints(world: &World, values: &mut Vec<f64>) {
    let state = world.state();
    for vehicle in &world.model().vehicles {
        for joint in vehicle.tree.joints.iter().filter(|j| !j.is_mimic && j.width == 1) {
            let v = vehicle.v0 + joint.v_index;
            let (position, velocity) = world.motor_side(v);
            values.extend([position, velocity, world.effort(v)]);
            if world.model().has_gear(v) {
                values.extend([state.q[vehicle.q0 + joint.q_index], state.v[v]]);
            }
        }
    }
    for (actuator, command) in world.model().actuators.iter().zip(&state.commands) {
        values.push(match actuator.kind {
            ActuatorKind::JointDrive { stiffness, .. } if stiffness > 0.0 => command.position,
            ActuatorKind::JointDrive { .. } => command.velocity,
            _ => command.effort,
        });
    }
}

fn write_drives(world: &World, values: &mut Vec<f64>) {
    let now = world.state().time;
    for drive in &world.model().drives {
        values.extend(drive.paths.iter().map(|(_, path)| path.eval(now).position));
    }
}

fn write_contacts(world: &World, pairs: &[(Option<usize>, Option<usize>)], values: &mut Vec<f64>) {
    let start = values.len();
    values.resize(start + 4 * pairs.len(), 0.0);
    for touch in world.touches().filter(|t| t.normal_force > 0.0) {
        let Some(k) = pairs.iter().position(|p| *p == owners(world.model(), touch.pair)) else { continue };
        let sums = &mut values[start + 4 * k..start + 4 * k + 4];
        let along = touch.force_w.dot(&touch.normal_w);
        sums[0] += along;
        sums[1] += (touch.force_w - along * touch.normal_w).norm();
        sums[2] += 1.0;
        sums[3] += f64::from(u8::from(!touch.sticks));
    }
}

fn write_accounts(world: &World, audit: Option<&MomentumAudit>, balance: &EnergyBalance, values: &mut Vec<f64>) {
    let (energy, contact_work) = (Energy::of(world), world.state().account.contact_work);
    values.extend(audit.map_or([f64::NAN; 2], |a| [a.linear_drift, a.angular_drift]));
    values.extend([energy.kinetic, energy.potential, energy.elastic]);
    let EnergyBalance { actuator_work, contact_loss, joint_loss, numerical_loss, .. } = *balance;
    values.extend([actuator_work, contact_work, contact_loss, joint_loss, numerical_loss]);
}

/// Rotors and tips of mounts come after the links of the file; the scene does not show them.
fn write_poses(world: &World, links: &[usize], poses: &mut Vec<Pose>) {
    poses.clear();
    for (v, shown) in links.iter().enumerate() {
        poses.extend((0..*shown).map(|l| world.link_frame(v, l).to_pose()));
    }
}

fn write_contact_samples(world: &World, contacts: &mut Vec<ContactSample>) {
    contacts.clear();
    for touch in world.touches().filter(|t| t.normal_force > 0.0) {
        let normal_force_w: Vec3 = touch.force_w.dot(&touch.normal_w) * touch.normal_w;
        let friction_force_w = touch.force_w - normal_force_w;
        let law = world.model().laws[touch.pair].friction;
        let bound = law.map_or(0.0, |f| f.highest_level() * touch.normal_force);
        contacts.push(ContactSample {
            pair: touch.pair,
            point_w: touch.point_w,
            normal_force_w,
            friction_force_w,
            sticking: touch.sticks,
            friction_use: if bound > 0.0 { (friction_force_w.norm() / bound).min(1.0) } else { 0.0 },
        });
    }
}
