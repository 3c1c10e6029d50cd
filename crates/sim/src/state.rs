//! All the memory that the physics has: plain data; cloning it is a snapshot.
//!
//! The base twist is not a state. It follows from the momentum and the joint rates:
//!   V_B = I_lock⁻¹ (h − Σ I_i V_i^rel),    h = (L − x_B × p, p),
//! so that poses and twists carry exactly (p, L), and only forces from outside can change them.

use crate::model::Model;
use crate::parts::{Command, MechanismMemory};
use serde::{Deserialize, Serialize};
use spatial::{Pose, Vec3, Wrench};

/// The world at one instant.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time, s: `steps` times the step, unless steps of other lengths were made.
    pub time: f64,
    /// Steps made since the start.
    pub steps: u64,
    /// Base pose of every vehicle.
    pub bases: Vec<Pose>,
    /// Joint coordinates of all vehicles.
    pub q: Vec<f64>,
    /// Joint rates of all vehicles.
    pub v: Vec<f64>,
    /// Per vehicle: angular momentum about W's origin (moment slot, N·m·s), linear momentum (force slot, N·s), of its bodies
    /// and of the parts that effects put inside them. Components that the base's guide holds are not kept. Of a driven
    /// vehicle: what all others have given it since the start.
    pub momentum: Vec<Wrench>,
    /// Touching points' bristles, sorted by pair and feature.
    pub bristles: Vec<ContactMemory>,
    /// Memory of the mechanisms, in the model's order.
    #[serde(default)]
    pub mechanisms: Vec<MechanismMemory>,
    /// Deflection of dry joint friction, by coordinate, rad or m.
    pub dry: Vec<f64>,
    /// Memory of the effects, in the model's order; zero where all is at rest and unloaded.
    #[serde(default)]
    pub effects: Vec<f64>,
    /// Whether the effects' memory has been set for the start: see [`crate::World::settle_effects`].
    #[serde(default)]
    pub is_settled: bool,
    /// Commands that act on actuators with a delay; empty before the first step, and where no effect delays one.
    #[serde(default)]
    pub acting: Vec<Command>,
    /// Commands that were given and do not act yet.
    #[serde(default)]
    pub pending: Vec<Pending>,
    /// The controller's memory; its meaning is the controller's.
    pub controller: Vec<f64>,
    /// Memory of the sensors and the navigation between world and controller; its meaning is theirs.
    #[serde(default)]
    pub perception: Vec<f64>,
    /// The commands that act at present.
    pub commands: Vec<Command>,
    /// What came from outside since the start, and what became of it.
    pub account: Account,
    /// Work since the start of every actuator, drive and effect, J, in the model's order: see [`crate::World::works`].
    #[serde(default)]
    pub works: Vec<f64>,
    /// Work counters since the start.
    pub work: Work,
}

/// A command on its way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pending {
    /// The actuator.
    pub actuator: usize,
    /// When it acts, s.
    pub time: f64,
    /// The command.
    pub command: Command,
}

/// The bristle of one touching point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactMemory {
    /// The scene's pair.
    pub pair: u32,
    /// Identity within the pair.
    pub feature: u64,
    /// Deflection, W axes, m; across `normal_w`.
    pub s_w: Vec3,
    /// Contact normal, from A to B, W axes.
    pub normal_w: Vec3,
    /// Angular deflection of a pair that resists turning: spin along the normal, rolling across it, W axes, rad.
    pub turn_w: Vec3,
    /// How rested the point is, from 0 (sliding) to 1.
    pub rest: f64,
    /// The point in B's body frame, m: identity of last resort.
    pub point_b: Vec3,
    /// Share of the pair's law that acts at the point.
    #[serde(default = "whole")]
    pub weight: f64,
}

/// The share of a point that is not one of a bed's samples.
fn whole() -> f64 {
    1.0
}

/// Sums over the run of what crosses the system's border, and of what the laws dissipate. Works are efforts times the
/// displacements that were made; losses are what each law says of itself, never less than nothing but for its rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Account {
    /// Impulse of external forces on all vehicles, about W's origin, N·s and N·m·s.
    pub impulse: Wrench,
    /// Work of gravity and tides, J.
    pub environment_work: f64,
    /// Work of contact forces, J (negative: stored or dissipated).
    pub contact_work: f64,
    /// What contact forces gave to motion, J: at the mean of the velocities before and after each step. It differs from their work by
    /// what the integrator took there.
    pub contact_to_motion: f64,
    /// What went into contacts, J: the parts of that work, step by step and point by point, that contacts took.
    pub contact_intake: f64,
    /// What contacts have dissipated, J: dampers, friction, and bristles that were cut off when their points parted.
    pub contact_loss: f64,
    /// What joints have dissipated, J: damping, dry friction, stops.
    pub joint_loss: f64,
    /// Work of mechanisms, J (negative: stored or dissipated); with that of a pull-in's motor.
    pub mechanism_work: f64,
    /// What mechanisms have dissipated by their laws, J; with what a latch had stored when it let go.
    pub mechanism_loss: f64,
    /// Work of the motors that pull latches in, J.
    pub pull_in_work: f64,
    /// What the dampers of parts inside bodies have dissipated, J; it stands in those effects' works too.
    pub effect_loss: f64,
}

/// Work counters: they show numeric drift without a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Steps.
    pub steps: u64,
    /// Evaluations of the equations of motion.
    pub rate_evaluations: u64,
    /// Pairs of shapes that were tested closely.
    pub contact_queries: u64,
    /// Linear solves.
    pub solves: u64,
    /// Steps that ended before the contact laws were met to tolerance.
    pub unconverged_steps: u64,
}

impl State {
    /// Every vehicle at the origin, every joint at zero, nothing moving.
    pub fn new(model: &Model) -> Self {
        Self {
            time: 0.0,
            steps: 0,
            bases: vec![Pose::identity(); model.vehicles.len()],
            q: model.vehicles.iter().flat_map(|v| v.tree.q_zero.iter().copied()).collect(),
            v: vec![0.0; model.nv()],
            momentum: vec![Wrench::default(); model.vehicles.len()],
            bristles: Vec::new(),
            mechanisms: model.mechanisms.iter().map(|m| m.kind.start()).collect(),
            dry: vec![0.0; model.nv()],
            effects: vec![0.0; model.effects.n_memory()],
            is_settled: false,
            acting: Vec::new(),
            pending: Vec::new(),
            controller: Vec::new(),
            perception: Vec::new(),
            commands: vec![Command::default(); model.actuators.len()],
            account: Account::default(),
            works: vec![0.0; model.n_works()],
            work: Work::default(),
        }
    }

    /// Copies what a stage of an integrator changes.
    pub(crate) fn copy_from_physics(&mut self, other: &Self) {
        self.bases.clone_from(&other.bases);
        self.q.clone_from(&other.q);
        self.v.clone_from(&other.v);
        self.momentum.clone_from(&other.momentum);
        self.effects.clone_from(&other.effects);
    }

    /// Copies `other` into this one without allocating where sizes match.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        (self.time, self.steps) = (other.time, other.steps);
        self.bases.clone_from(&other.bases);
        self.q.clone_from(&other.q);
        self.v.clone_from(&other.v);
        self.momentum.clone_from(&other.momentum);
        self.bristles.clone_from(&other.bristles);
        self.mechanisms.clone_from(&other.mechanisms);
        self.dry.clone_from(&other.dry);
        self.effects.clone_from(&other.effects);
        self.is_settled = other.is_settled;
        self.acting.clone_from(&other.acting);
        self.pending.clone_from(&other.pending);
        self.controller.clone_from(&other.controller);
        self.perception.clone_from(&other.perception);
        self.commands.clone_from(&other.commands);
        self.works.clone_from(&other.works);
        (self.account, self.work) = (other.account, other.work);
    }
}

impl Account {
    /// Adds `k` times another account.
    pub(crate) fn add_scaled(&mut self, other: &Self, k: f64) {
        self.impulse += other.impulse * k;
        self.environment_work += other.environment_work * k;
        self.contact_work += other.contact_work * k;
        self.contact_to_motion += other.contact_to_motion * k;
        self.contact_intake += other.contact_intake * k;
        self.contact_loss += other.contact_loss * k;
        self.joint_loss += other.joint_loss * k;
        self.mechanism_work += other.mechanism_work * k;
        self.mechanism_loss += other.mechanism_loss * k;
        self.pull_in_work += other.pull_in_work * k;
        self.effect_loss += other.effect_loss * k;
    }
}
