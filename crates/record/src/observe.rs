//! From a running world to a [`Log`]: the observer that samples at the logging rate.
//!
//! | channel | unit |
//! | --- | --- |
//! | `body.<vehicle>.position.{x,y,z}`, `.orientation.{w,x,y,z}`, `.linear_velocity`, `.angular_velocity` (body axes) | m, 1, m/s, rad/s |
//! | `joint.<vehicle>/<joint>.position`, `.velocity`, `.effort` | rad or m, … |
//! | `actuator.<name>.command` | position, or effort |
//! | `contact.<a>.<b>.normal_force`, `.friction_force`, `.points`, `.sliding` by pair of vehicles | N, 1 |
//! | `momentum.*`, `energy.*` of all vehicles together | |
//! | `mechanism.*` | see `mechanisms` |

use crate::{ChannelSpec, ContactSample, Log, Meta, Plot, RecordError, Sample};
use multibody::JointKind;
use sim::{ActuatorKind, Energy, EnergyAudit, EnergyBalance, Flow, Model, MomentumAudit, Observer, World};
use spatial::{Pose, Vec3};

/// A further channel: a function of the world.
pub struct Probe {
    /// What it is.
    pub spec: ChannelSpec,
    /// Its value.
    pub read: Box<dyn Fn(&World) -> f64 + Send + Sync>,
}

impl std::fmt::Debug for Probe {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.spec.fmt(f)
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
    probes: Vec<Probe>,
    keep: Vec<bool>,
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
    pub probes: Vec<Probe>,
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
        let mut specs = self.calc_all_channels(model);
        specs.retain(|s| (self.keep)(&s.name));
        specs
    }

    fn calc_all_channels(&self, model: &Model) -> Vec<ChannelSpec> {
        let mut specs = standard_channels(model, &vehicle_pairs(model));
        specs.extend(self.probes.iter().map(|p| p.spec.clone()));
        specs
    }
}

impl<'a> Recorder<'a> {
    /// A recorder for a world at its start, which also feeds `live`.
    pub fn new(world: &World, plan: RecorderPlan, live: Option<&'a mut dyn SampleSink>) -> Self {
        let vehicle_pairs = vehicle_pairs(world.model());
        let keep: Vec<bool> = plan.calc_all_channels(world.model()).iter().map(|s| (plan.keep)(&s.name)).collect();
        let kept = plan.calc_channels(world.model());
        let mut log = Log::new(plan.meta, kept, plan.links.iter().sum());
        log.pairs = (0..world.model().scene.pairs().len()).map(|p| world.model().pair_name(p)).collect();
        Self {
            log,
            error: None,
            probes: plan.probes,
            keep,
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
        write_contacts(world, &self.vehicle_pairs, &mut values);
        write_accounts(world, self.audit.as_ref(), &self.energy.close(world), &mut values);
        crate::mechanisms::write(world, &mut values);
        values.extend(self.probes.iter().map(|p| (p.read)(world)));
        let Scratch { kept, poses, contacts, .. } = &mut self.scratch;
        kept.clear();
        kept.extend(values.iter().zip(&self.keep).filter(|(_, k)| **k).map(|(v, _)| *v));
        write_poses(world, self.log.link_count(), poses);
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

fn standard_channels(model: &Model, pairs: &[(Option<usize>, Option<usize>)]) -> Vec<ChannelSpec> {
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
            for (quantity, unit) in ["position", "velocity", "effort"].into_iter().zip(units) {
                add(format!("joint.{}/{}.{quantity}", vehicle.name, joint.name), unit, Plot::Joints, "");
            }
        }
    }
    for actuator in &model.actuators {
        let unit = match actuator.kind {
            ActuatorKind::JointDrive { .. } => "rad or m",
            _ => "N or N·m",
        };
        add(format!("actuator.{}.command", actuator.name), unit, Plot::Actuators, "");
    }
    for (a, b) in pairs {
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
            values.extend([state.q[vehicle.q0 + joint.q_index], state.v[v], world.effort(v)]);
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

fn write_poses(world: &World, links: usize, poses: &mut Vec<Pose>) {
    poses.clear();
    for (v, vehicle) in world.model().vehicles.iter().enumerate() {
        // Rotors come after the links of the file; the scene does not show them.
        let rotors = vehicle.tree.links.iter().rev().take_while(|l| is_rotor(l)).count();
        let shown = vehicle.tree.links.len() - rotors;
        poses.extend((0..shown).map(|l| world.link_frame(v, l).to_pose()));
    }
    poses.truncate(links);
}

fn is_rotor(link: &multibody::Link) -> bool {
    link.inertia.mass == 0.0 && link.inertia.rot != spatial::Mat3::zeros()
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
