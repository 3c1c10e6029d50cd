//! Capture of a tumbling satellite: predict, reach, approach, close, damp, hold.
//!
//! | phase | what the tool does | ends when |
//! | --- | --- | --- |
//! | acquire | stands | navigation has made out the target; with perfect knowledge there is no such phase |
//! | reach | quintic to the standoff pose where the target will be, arriving with its velocity | its planned time |
//! | approach | along the grapple frame's z, in the moving frame | the tool is at the grapple frame |
//! | close | follows the grapple frame, fingers close at a rate, force limited | every finger presses |
//! | damp | joint rates fall smoothly to zero: the relative motion stops | its time is over |
//! | hold | drives hold | the end, or contact is lost |
//!
//! The moment of the grasp is chosen by prediction: of the times at which the arm reaches both the standoff and the
//! grasp (inverse kinematics), the one that asks least of the joints. Rates by the generalised Jacobian
//! ([`super::free_floating`]), references to the joint drives. No pose is scripted.
//!
//! Two switches show what each part is worth: without `prediction` the reach ends where the point is when it is planned,
//! and starts the approach from there; without `rate_matching` the tool follows positions only.

use super::free_floating::{Arm, RateRequest, calc_bounded_error};
use super::gripper::{self, Gripper};
use super::trajectory::{Quintic, calc_rate};
use crate::build::{ActuatorTable, Faults, solve_pose};
use crate::navigation::{FreeBody, Mass, read_pose, write_pose};
use crate::spec::{Scenario, TrackAndGrasp};
use multibody::{JointKind, calc_locked_inertia};
use sim::{ActuatorKind, Command, Controller, Known, Model, World};
use spatial::{Frame, Pose, Twist, Vec3};

/// Where a capture stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Waiting for navigation to make out the target.
    Acquire,
    /// On the way to the standoff pose.
    Reach,
    /// On the last straight.
    Approach,
    /// Fingers closing.
    Close,
    /// Held; relative motion being stopped.
    Damp,
    /// Held and at rest.
    Hold,
    /// Given up, or lost.
    Abort,
}

const PHASES: [Phase; 7] =
    [Phase::Acquire, Phase::Reach, Phase::Approach, Phase::Close, Phase::Damp, Phase::Hold, Phase::Abort];

/// Phase of a capture from the controller's memory; `None` before its first call, or of another strategy.
pub fn phase_of(world: &World) -> Option<Phase> {
    let code = *world.state().controller.first()?;
    PHASES.get(code as usize).copied()
}

/// Places in the controller's memory.
mod slot {
    pub(super) const PHASE: usize = 0;
    /// Time at which the phase began, s.
    pub(super) const SINCE: usize = 1;
    /// Time of the arrival at the standoff, s.
    pub(super) const ARRIVAL: usize = 2;
    /// Time since which the condition to go on has held, s; negative: it does not.
    pub(super) const STEADY: usize = 3;
    /// Start pose (7), end pose (7) and end twist (6) of the reach.
    pub(super) const START: usize = 4;
    pub(super) const END: usize = 11;
    pub(super) const END_TWIST: usize = 18;
    /// Time since which the target has been touched from both sides, s; negative: it has not.
    pub(super) const TOUCHED: usize = 24;
    /// Time of the first touch from any side, s; negative: there was none.
    pub(super) const FELT: usize = 25;
    /// References of the arm's joints, then their last commanded rates, then the comfortable pose.
    pub(super) const JOINTS: usize = 26;
}

/// Time between two commands, s.
const PERIOD: f64 = 0.01;
/// Time that a condition must hold before the next phase, s.
const SETTLE: f64 = 0.15;
/// Time after which a phase that does not come to its end is given up, s.
const PATIENCE: f64 = 12.0;
/// Share of the closing force that every finger must press with to count as closed.
const CLOSED: f64 = 0.5;
/// Force from both sides that counts as touch, N, and time in which the squeeze then rises, s.
const TOUCH: f64 = 2.0;
const RISE: f64 = 0.5;
/// Step of the search for the moment of the grasp, s, and how far it looks ahead.
const SEARCH: (f64, f64) = (0.5, 25.0);
/// Largest corrections of attitude, rad, and position, m, that one command answers.
const LONGEST: [f64; 2] = [0.2, 0.1];
/// How far a joint's reference may lead the joint, rad.
const LEASH: f64 = 0.03;
/// The same while the arm gives way to the closing fingers, rad.
const YIELDING_LEASH: f64 = 5e-4;
/// Rate of the null space's return to the comfortable pose, 1/s.
const COMFORT: f64 = 0.05;

/// The controller.
#[derive(Clone, Debug)]
pub(super) struct Grasper {
    spec: TrackAndGrasp,
    arm: Arm,
    target: usize,
    grapple: usize,
    drives: Vec<ArmDrive>,
    gripper: Gripper,
    period_steps: u64,
}

#[derive(Clone, Copy, Debug)]
struct ArmDrive {
    actuator: usize,
    q_index: usize,
    v_index: usize,
    limits: Option<[f64; 2]>,
    max_rate: f64,
}

pub(super) fn build(
    scenario: &Scenario,
    spec: &TrackAndGrasp,
    model: &Model,
    table: &ActuatorTable,
    faults: &mut Faults<'_>,
) -> Option<Grasper> {
    let (vehicle, link) = frame_of(model, &spec.tool_frame, "strategy.tool_frame", faults)?;
    let (target, grapple) = frame_of(model, &spec.grapple_frame, "strategy.grapple_frame", faults)?;
    for (key, frame, owner, role, name) in [
        ("strategy.tool_frame", &spec.tool_frame, vehicle, "servicer", &spec.servicer),
        ("strategy.grapple_frame", &spec.grapple_frame, target, "target", &spec.target),
    ] {
        if model.vehicles[owner].name != *name {
            faults.add(key, format!("\"{frame}\" is not of the {role} \"{name}\"; name a link of that vehicle"));
        }
    }
    let drives = arm_drives(spec, model, vehicle, link);
    if drives.len() < 6 {
        faults
            .add("strategy.tool_frame", "the tool needs six or more joints with a joint-drive between it and the base");
        return None;
    }
    let gripper = gripper::build((scenario, spec), model, table, (vehicle, target), faults)?;
    let v0 = model.vehicles[vehicle].v0;
    let arm = Arm { vehicle, link, coordinates: drives.iter().map(|d| d.v_index - v0).collect() };
    let period_steps = (PERIOD / model.step).round().max(1.0) as u64;
    Some(Grasper { spec: spec.clone(), arm, target, grapple, drives, gripper, period_steps })
}

fn frame_of(model: &Model, name: &str, key: &str, faults: &mut Faults<'_>) -> Option<(usize, usize)> {
    let (vehicle, link) = name.split_once('/').unwrap_or((name, ""));
    let Some(v) = model.vehicle(vehicle) else {
        faults.unknown(key, "vehicle", vehicle, model.vehicles.iter().map(|v| v.name.as_str()));
        return None;
    };
    let found = model.vehicles[v].tree.link(link);
    if found.is_none() {
        faults.unknown(key, "link", link, model.vehicles[v].tree.links.iter().map(|l| l.name.as_str()));
    }
    found.map(|l| (v, l))
}

/// Drives of the joints between the base and the tool, from the base outwards.
fn arm_drives(spec: &TrackAndGrasp, model: &Model, vehicle: usize, link: usize) -> Vec<ArmDrive> {
    let owner = &model.vehicles[vehicle];
    let mut drives = Vec::new();
    let mut body = owner.tree.links[link].body;
    while body != 0 {
        let joint = &owner.tree.joints[body - 1];
        let coordinate = owner.v0 + joint.v_index;
        let drive = model.actuators.iter().position(
            |a| matches!(a.kind, ActuatorKind::JointDrive { coordinate: c, stiffness, .. } if c == coordinate && stiffness > 0.0),
        );
        if let (Some(actuator), JointKind::Revolute) = (drive, joint.kind) {
            drives.push(ArmDrive {
                actuator,
                q_index: owner.q0 + joint.q_index,
                v_index: coordinate,
                limits: joint.position_limits,
                max_rate: joint.velocity_limit.min(spec.max_joint_rate_deg_per_s.to_radians()),
            });
        }
        body = owner.tree.bodies[body].parent;
    }
    drives.reverse();
    drives
}

impl Controller for Grasper {
    fn period_steps(&self) -> u64 {
        self.period_steps
    }

    fn command(&self, known: &Known<'_>, memory: &mut Vec<f64>, commands: &mut [Command]) {
        if memory.is_empty() {
            // The drives hold where they stand.
            memory.resize(slot::JOINTS + 3 * self.drives.len(), 0.0);
        }
        if phase_in(memory) == Phase::Acquire {
            if !known.is_ready {
                return;
            }
            self.begin(known.world, memory);
        }
        self.switch_phase(known, memory);
        match phase_in(memory) {
            Phase::Reach | Phase::Approach | Phase::Close => self.track(known, memory, commands),
            Phase::Damp | Phase::Hold | Phase::Abort | Phase::Acquire => self.damp(known.world, memory, commands),
        }
        self.command_fingers(known, memory, commands);
    }
}

impl Grasper {
    fn begin(&self, world: &World, memory: &mut [f64]) {
        let n = self.drives.len();
        self.enter(world, memory, Phase::Reach);
        memory[slot::TOUCHED] = -1.0;
        memory[slot::FELT] = -1.0;
        for (i, drive) in self.drives.iter().enumerate() {
            memory[slot::JOINTS + i] = world.state().q[drive.q_index];
            memory[slot::JOINTS + 2 * n + i] = world.state().q[drive.q_index];
        }
        let arrival = self.choose_arrival(world);
        memory[slot::ARRIVAL] = world.state().time + arrival;
        let (end, twist) = self.predict_standoff(world, arrival);
        write_pose(&self.tool(world).to_pose(), &mut memory[slot::START..]);
        write_pose(&end, &mut memory[slot::END..]);
        memory[slot::END_TWIST..slot::END_TWIST + 3].copy_from_slice(twist.ang.as_slice());
        memory[slot::END_TWIST + 3..slot::END_TWIST + 6].copy_from_slice(twist.lin.as_slice());
    }

    fn tool(&self, world: &World) -> Frame {
        world.link_frame(self.arm.vehicle, self.arm.link)
    }

    /// Along which the fingers close, W.
    fn closing_axis(&self, known: &Known<'_>) -> Vec3 {
        self.tool(known.world).rot.column(1).into_owned()
    }

    /// The grapple frame as the strategy believes it to be.
    fn grapple(&self, world: &World) -> Pose {
        let offset = Vec3::from(self.spec.grapple_offset_m);
        world.link_frame(self.target, self.grapple).to_pose() * Pose::translation(offset.x, offset.y, offset.z)
    }

    fn target_body(&self, world: &World) -> Option<FreeBody> {
        let (kin, pose) = (world.kinematics(self.target), world.state().bases[self.target]);
        let inertia_w = calc_locked_inertia(kin);
        let back = kin.rot[0].transpose();
        Some(FreeBody::new(&pose, &kin.vel[0], Mass::new(&inertia_w.transformed(&back, &Vec3::zeros()))?))
    }

    /// Pose and twist of the standoff after `ahead` seconds; without prediction the present pose, at rest.
    fn predict_standoff(&self, world: &World, ahead: f64) -> (Pose, Twist) {
        let (grapple, twist) = self.predict_grapple(world, ahead);
        let standoff = grapple * Pose::translation(0.0, 0.0, -self.spec.standoff_m);
        (standoff, twist.about(&(standoff.translation.vector - grapple.translation.vector)))
    }

    fn predict_grapple(&self, world: &World, ahead: f64) -> (Pose, Twist) {
        let now = self.grapple(world);
        let held = Twist::default();
        let Some(mut body) = self.target_body(world).filter(|_| self.spec.prediction) else { return (now, held) };
        let fixed = body.pose().inverse() * now;
        body.advance(ahead.max(1e-9));
        let pose = body.pose() * fixed;
        let twist = if self.spec.rate_matching { body.twist_at(&pose.translation.vector) } else { held };
        (pose, twist)
    }

    /// The time of arrival that asks least of the joints; the shortest one without prediction.
    fn choose_arrival(&self, world: &World) -> f64 {
        let shortest = self.spec.reach_time_s;
        if !self.spec.prediction {
            return shortest;
        }
        let straight = self.spec.standoff_m / self.spec.approach_speed_m_per_s + 2.0;
        let steps = (SEARCH.1 / SEARCH.0) as usize;
        let cost = |i: usize| {
            let arrival = shortest + i as f64 * SEARCH.0;
            let (standoff, _) = self.predict_standoff(world, arrival);
            let (grasp, _) = self.predict_grapple(world, arrival + straight);
            let effort = self.calc_joint_travel(world, &standoff)?.max(self.calc_joint_travel(world, &grasp)?);
            Some((effort + 0.02 * arrival, arrival))
        };
        let best = (0..=steps).filter_map(cost).min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or(shortest, |(_, arrival)| arrival)
    }

    /// Largest travel of a joint to a pose, rad; `None` where the arm does not reach. The base is taken as held: it gives
    /// way by a few centimetres, which the margin of the search covers.
    fn calc_joint_travel(&self, world: &World, goal: &Pose) -> Option<f64> {
        let vehicle = &world.model().vehicles[self.arm.vehicle];
        let names: Vec<String> = self.joint_names(world);
        let start = &world.state().q[vehicle.q_range()];
        let mut q = start.to_vec();
        solve_pose(&vehicle.tree, &world.state().bases[self.arm.vehicle], self.arm.link, goal, &names, &mut q).ok()?;
        let travel = self.drives.iter().map(|d| (q[d.q_index - vehicle.q0] - start[d.q_index - vehicle.q0]).abs());
        Some(travel.fold(0.0, f64::max))
    }

    fn joint_names(&self, world: &World) -> Vec<String> {
        let vehicle = &world.model().vehicles[self.arm.vehicle];
        let driven = |v: usize| self.drives.iter().any(|d| d.v_index == vehicle.v0 + v);
        vehicle.tree.joints.iter().filter(|j| driven(j.v_index)).map(|j| j.name.clone()).collect()
    }

    /// Where the tool shall be `after` seconds from now, and the frame that it follows.
    fn goal(&self, world: &World, memory: &[f64], after: f64) -> Pose {
        let time = world.state().time + after;
        if phase_in(memory) == Phase::Reach {
            let end_twist = Twist::new(
                Vec3::from_column_slice(&memory[slot::END_TWIST..slot::END_TWIST + 3]),
                Vec3::from_column_slice(&memory[slot::END_TWIST + 3..slot::END_TWIST + 6]),
            );
            let duration = memory[slot::ARRIVAL] - memory[slot::SINCE];
            let (start, end) = (read_pose(&memory[slot::START..]), read_pose(&memory[slot::END..]));
            return Quintic { start, end, end_twist, duration }.pose(time - memory[slot::SINCE]);
        }
        let run = time - memory[slot::ARRIVAL];
        let left = (self.spec.standoff_m - self.spec.approach_speed_m_per_s * run).max(0.0);
        let grapple = self.grapple(world);
        let moved = if self.spec.rate_matching { self.moved_grapple(world, &grapple, after) } else { grapple };
        moved * Pose::translation(0.0, 0.0, -left)
    }

    /// The grapple frame a moment later, by its present twist.
    fn moved_grapple(&self, world: &World, grapple: &Pose, after: f64) -> Pose {
        let kin = world.kinematics(self.target);
        let twist = kin.vel[0].about(&(grapple.translation.vector - kin.anchor));
        Pose::from_parts(
            (grapple.translation.vector + after * twist.lin).into(),
            spatial::exp_rotation(&(after * twist.ang)) * grapple.rotation,
        )
    }

    fn track(&self, known: &Known<'_>, memory: &mut [f64], commands: &mut [Command]) {
        let world = known.world;
        let tool = self.tool(world);
        let goal = self.goal(world, memory, 0.0);
        let lead = calc_rate(&goal, &self.goal(world, memory, 1e-3), 1e-3);
        self.feel(known, memory);
        let felt = memory[slot::FELT] >= 0.0;
        // Two hands on one bar: what the fingers settle between them, position control may not fight.
        let error = if felt { Twist::default() } else { calc_bounded_error(&tool, &goal, LONGEST) };
        let n = self.drives.len();
        let comfort =
            |(i, d): (usize, &ArmDrive)| COMFORT * (memory[slot::JOINTS + 2 * n + i] - world.state().q[d.q_index]);
        let wish: Vec<f64> = self.drives.iter().enumerate().map(|d| if felt { 0.0 } else { comfort(d) }).collect();
        let request = RateRequest {
            twist: lead + error * self.spec.tracking_bandwidth_per_s,
            damping: self.spec.jacobian_damping,
            wish: &wish,
        };
        let mut rates = self.arm.calc_rates(world, &request);
        let overspeed = rates.iter().zip(&self.drives).map(|(r, d)| r.abs() / d.max_rate).fold(1.0, f64::max);
        rates.iter_mut().for_each(|r| *r /= overspeed);
        memory[slot::JOINTS + n..slot::JOINTS + 2 * n].copy_from_slice(&rates);
        self.write_references(world, memory, commands, &rates);
    }

    /// Notes the first touch of the closing fingers.
    fn feel(&self, known: &Known<'_>, memory: &mut [f64]) {
        let closing = phase_in(memory) == Phase::Close;
        if closing && memory[slot::FELT] < 0.0 {
            let [plus, minus] = self.gripper.calc_presses(known, &self.closing_axis(known));
            if plus + minus > TOUCH {
                memory[slot::FELT] = known.world.state().time;
            }
        }
    }

    fn write_references(&self, world: &World, memory: &mut [f64], commands: &mut [Command], rates: &[f64]) {
        let period = self.period_steps as f64 * world.model().step;
        // Once the fingers feel the bar and until they hold it, the arm gives way: its references go with it.
        let yields = phase_in(memory) == Phase::Close && memory[slot::FELT] >= 0.0;
        let leash = if yields { YIELDING_LEASH } else { LEASH };
        for (i, (drive, rate)) in self.drives.iter().zip(rates).enumerate() {
            let position = world.state().q[drive.q_index];
            let reference = &mut memory[slot::JOINTS + i];
            // The reference is that of the period's middle; it may not run away from a joint that cannot follow.
            *reference = (*reference + rate * period).clamp(position - leash, position + leash);
            if let Some([lower, upper]) = drive.limits {
                *reference = reference.clamp(lower, upper);
            }
            commands[drive.actuator] = Command { position: *reference, velocity: *rate, effort: 0.0 };
        }
    }

    /// The last commanded joint rates, faded out by a half cosine.
    fn damp(&self, world: &World, memory: &mut [f64], commands: &mut [Command]) {
        let (n, length) = (self.drives.len(), 3.0 * self.spec.damping_time_s);
        let s = ((world.state().time - memory[slot::SINCE]) / length).clamp(0.0, 1.0);
        let left = match phase_in(memory) {
            Phase::Damp => 0.5 * (1.0 + (std::f64::consts::PI * s).cos()),
            _ => 0.0,
        };
        let rates: Vec<f64> = (0..n).map(|i| left * memory[slot::JOINTS + n + i]).collect();
        self.write_references(world, memory, commands, &rates);
    }

    /// Fingers close at their rate; once they touch from both sides the force rises to the squeeze.
    fn command_fingers(&self, known: &Known<'_>, memory: &mut [f64], commands: &mut [Command]) {
        let world = known.world;
        let closes = matches!(phase_in(memory), Phase::Close | Phase::Damp | Phase::Hold);
        let time = world.state().time;
        if closes && memory[slot::TOUCHED] < 0.0 && self.gripper.calc_press(known, &self.closing_axis(known)) > TOUCH {
            memory[slot::TOUCHED] = time;
        }
        let rise = if memory[slot::TOUCHED] < 0.0 { 0.0 } else { ((time - memory[slot::TOUCHED]) / RISE).min(1.0) };
        for finger in &self.gripper.fingers {
            let ActuatorKind::JointDrive { damping, .. } = world.model().actuators[finger.actuator].kind else {
                continue;
            };
            let velocity = if closes { self.spec.closing_speed_m_per_s } else { 0.0 };
            // At standstill the rate loop alone presses with damping × velocity.
            let missing = finger.count * self.spec.closing_force_n - damping * velocity;
            let effort = if closes { rise * missing } else { 0.0 };
            commands[finger.actuator] = Command { position: 0.0, velocity, effort };
        }
    }

    fn switch_phase(&self, known: &Known<'_>, memory: &mut [f64]) {
        let world = known.world;
        let time = world.state().time;
        let phase = phase_in(memory);
        let ready = self.is_phase_over(known, memory, phase);
        if !ready {
            memory[slot::STEADY] = -1.0;
        } else if memory[slot::STEADY] < 0.0 {
            memory[slot::STEADY] = time;
        }
        let settle = if matches!(phase, Phase::Reach | Phase::Damp) { 0.0 } else { SETTLE };
        let late = matches!(phase, Phase::Approach | Phase::Close)
            && time - memory[slot::SINCE] > PATIENCE + self.approach_time();
        if late {
            self.enter(world, memory, Phase::Abort);
        } else if ready && time - memory[slot::STEADY] >= settle {
            let next = match phase {
                Phase::Acquire => Phase::Reach,
                Phase::Reach => Phase::Approach,
                Phase::Approach => Phase::Close,
                Phase::Close => Phase::Damp,
                Phase::Damp => Phase::Hold,
                Phase::Hold | Phase::Abort => phase,
            };
            if next != phase {
                self.enter(world, memory, next);
            }
        }
    }

    fn approach_time(&self) -> f64 {
        self.spec.standoff_m / self.spec.approach_speed_m_per_s
    }

    fn enter(&self, world: &World, memory: &mut [f64], phase: Phase) {
        memory[slot::PHASE] = PHASES.iter().position(|p| *p == phase).unwrap_or(0) as f64;
        memory[slot::SINCE] = world.state().time;
        memory[slot::STEADY] = -1.0;
    }

    fn is_phase_over(&self, known: &Known<'_>, memory: &[f64], phase: Phase) -> bool {
        let world = known.world;
        match phase {
            Phase::Acquire => known.is_ready,
            Phase::Reach => world.state().time >= memory[slot::ARRIVAL],
            Phase::Approach => {
                let there = world.state().time >= memory[slot::ARRIVAL] + self.approach_time();
                let error = crate::build::calc_error(&self.tool(world), &self.grapple(world));
                let (turn, shift) = crate::build::halves(&error);
                there
                    && shift.norm() < self.spec.close_distance_m
                    && turn.norm() < self.spec.close_angle_deg.to_radians()
            }
            Phase::Close => {
                self.gripper.calc_press(known, &self.closing_axis(known)) > CLOSED * self.spec.closing_force_n
            }
            Phase::Damp => world.state().time - memory[slot::SINCE] > 3.0 * self.spec.damping_time_s,
            Phase::Hold | Phase::Abort => false,
        }
    }
}

/// The phase that a memory stands in.
fn phase_in(memory: &[f64]) -> Phase {
    PHASES[memory[slot::PHASE] as usize]
}
