//! The own vehicle by its encoders, its gyro and what it had of momentum at the start.
//!
//!   Ṙ = R [ω_gyro]×,     m v = p_0 − Σ m_i v_i(ω, q̇),     ẋ = v
//!
//! Without a gyro the base turns as angular momentum has it that is kept likewise. Both hold until something touches; then the target seems to move
//! instead, and is followed all the same.

use super::Roles;
use crate::build::Faults;
use crate::measure::{Quantity, Seat, joints};
use crate::sensors::Sensor;
use crate::spec::Scenario;
use sim::{Base, World};
use spatial::{Pose, Rot, Twist, Vec3, Wrench, exp_rotation, nalgebra};

/// Time over which differences of what an encoder says are smoothed, s.
const SMOOTHING: f64 = 0.05;
/// Least time between two remembered poses of the camera, s.
const GRAIN: f64 = 5e-3;
/// Numbers of a remembered pose: time, position, quaternion.
const PLACE: usize = 8;

/// How the own vehicle is known.
#[derive(Debug)]
pub(super) struct OwnShip {
    pub vehicle: usize,
    base: Base,
    joints: Vec<OwnJoint>,
    /// Index of the sensor, and its axes in the base.
    gyro: Option<(usize, Rot)>,
    mass: f64,
    momentum: Wrench,
    /// Where its memory begins, and how many poses of the camera it remembers.
    at: usize,
    room: usize,
}

/// A joint that is measured.
#[derive(Debug)]
struct OwnJoint {
    q_index: usize,
    v_index: usize,
    encoder: usize,
    tachometer: Option<usize>,
}

/// Places in its memory, from its beginning.
mod slot {
    /// When it was written last, s.
    pub(super) const TIME: usize = 0;
    /// Base: position (3), quaternion (4), velocity (3), angular velocity (3), W axes.
    pub(super) const POSE: usize = 1;
    pub(super) const VELOCITY: usize = 8;
    pub(super) const SPIN: usize = 11;
    /// Poses of the camera: which is the oldest, how many there are, then they.
    pub(super) const OLDEST: usize = 14;
    pub(super) const COUNT: usize = 15;
    pub(super) const PLACES: usize = 16;
}

/// What a sensor said last: its stamp, and the reading.
type Said<'a> = Option<(f64, &'a [f64])>;

pub(super) fn build(
    scenario: &Scenario,
    world: &World,
    sensors: &[Sensor],
    roles: &Roles<'_>,
    at: usize,
    faults: &mut Faults<'_>,
) -> Option<OwnShip> {
    let model = world.model();
    let vehicle = roles.sight.from.vehicle;
    let owner = &model.vehicles[vehicle];
    let mut own_joints = Vec::new();
    for (name, joint, coordinate) in joints(model).filter(|(name, ..)| *name == owner.name) {
        let reads = |quantity: Quantity| sensors.iter().position(|s| s.quantity() == quantity);
        match reads(Quantity::JointPosition(coordinate)) {
            Some(encoder) => own_joints.push(OwnJoint {
                q_index: model.coordinates[coordinate].q_index,
                v_index: coordinate,
                encoder,
                tachometer: reads(Quantity::JointVelocity(coordinate)),
            }),
            None => {
                let reason = format!(
                    "needs a [[sensor]] of kind joint-encoder at \"{name}/{joint}\", a joint of the vehicle that navigates"
                );
                faults.add("navigation.camera", reason);
            }
        }
    }
    let gyro = gyro_of(scenario, sensors, vehicle, faults)?;
    let delay = roles.camera.delay_s;
    Some(OwnShip {
        vehicle,
        base: owner.base,
        joints: own_joints,
        gyro,
        mass: owner.tree.bodies.iter().map(|b| b.inertia.mass).sum(),
        momentum: world.state().momentum[vehicle],
        at,
        room: (delay / GRAIN).ceil() as usize + 3,
    })
}

/// The gyro that is named; an outer none where the name is wrong.
fn gyro_of(
    scenario: &Scenario,
    sensors: &[Sensor],
    vehicle: usize,
    faults: &mut Faults<'_>,
) -> Option<Option<(usize, Rot)>> {
    let Some(name) = &scenario.navigation.gyro else { return Some(None) };
    let rates = format!("sensor.{name}.angular_velocity");
    let found = sensors.iter().position(|s| s.name() == rates);
    match found.map(|index| (index, sensors[index].quantity())) {
        Some((index, Quantity::SensorRate(Seat { vehicle: v, link: 0, pose_ls }))) if v == vehicle => {
            Some(Some((index, pose_ls.rotation)))
        }
        _ => {
            let base = scenario.vehicles.get(vehicle).map_or("", |v| v.name.as_str());
            let reason = format!("\"{name}\" is no sensor of kind imu on the base of \"{base}\", which navigates");
            faults.add("navigation.gyro", reason);
            None
        }
    }
}

impl OwnShip {
    /// How many numbers it remembers.
    pub(super) fn memory_len(&self) -> usize {
        slot::PLACES + PLACE * self.room + 3 * self.joints.len()
    }

    fn joint_slot(&self, k: usize) -> usize {
        self.at + slot::PLACES + PLACE * self.room + 3 * k
    }

    /// Brings the own vehicle up to an instant: memory, and the world that is made out.
    pub(super) fn write(
        &self,
        now: f64,
        memory: &mut [f64],
        said: impl for<'a> Fn(&'a [f64], usize) -> Said<'a>,
        world: &mut World,
        camera: &Seat,
    ) {
        let is_first = memory[self.at + slot::POSE + 6] == 0.0;
        if is_first {
            let (pose, twist) = (world.state().bases[self.vehicle], world.kinematics(self.vehicle).vel[0]);
            write_pose(&pose, &mut memory[self.at + slot::POSE..]);
            memory[self.at + slot::TIME] = now;
            self.remember_twist(memory, &twist);
        }
        self.move_base(now, memory);
        for (k, joint) in self.joints.iter().enumerate() {
            let fresh = said(memory, joint.encoder).map(|(stamp, reading)| (stamp, reading[0]));
            let rate = joint.tachometer.map(|t| said(memory, t).map_or(0.0, |(_, reading)| reading[0]));
            let slot = self.joint_slot(k);
            if let Some((stamp, position)) = fresh {
                follow(&mut memory[slot..slot + 3], stamp, position);
                world.state_mut().q[joint.q_index] = position;
            }
            world.state_mut().v[joint.v_index] = rate.unwrap_or(memory[slot + 2]);
        }
        world.state_mut().bases[self.vehicle] = read_pose(&memory[self.at + slot::POSE..]);
        if self.base == Base::Free {
            let spin = self.gyro.and_then(|(sensor, axes)| {
                let (_, reading) = said(memory, sensor)?;
                Some(axes * Vec3::new(reading[0], reading[1], reading[2]))
            });
            let twist = self.calc_twist(world, spin);
            self.remember_twist(memory, &twist);
        }
        world.refresh();
        self.remember_camera(now, memory, &camera.calc_pose(world));
    }

    /// Base twist about its origin, W axes: turned as the gyro says, body axes, and with the momentum of the start.
    fn calc_twist(&self, world: &mut World, spin_b: Option<Vec3>) -> Twist {
        world.state_mut().momentum[self.vehicle] = self.momentum;
        world.refresh();
        let kept = world.kinematics(self.vehicle).vel[0];
        let Some(spin_b) = spin_b else { return kept };
        let spin = world.state().bases[self.vehicle].rotation * spin_b;
        let mut twists = twists_of(world);
        twists[self.vehicle] = Twist::new(spin, Vec3::zeros());
        world.set_base_twists(&twists);
        let lacks = self.momentum.force - world.state().momentum[self.vehicle].force;
        twists[self.vehicle].lin = lacks / self.mass;
        world.set_base_twists(&twists);
        twists[self.vehicle]
    }

    /// Sets the twist of another vehicle, and the own one's again.
    pub(super) fn set_twists(&self, world: &mut World, memory: &[f64], other: (usize, Twist)) {
        world.refresh();
        let mut twists = twists_of(world);
        twists[self.vehicle] = self.read_twist(memory);
        twists[other.0] = other.1;
        world.set_base_twists(&twists);
    }

    fn move_base(&self, now: f64, memory: &mut [f64]) {
        let dt = now - memory[self.at + slot::TIME];
        memory[self.at + slot::TIME] = now;
        if self.base != Base::Free || dt <= 0.0 {
            return;
        }
        let twist = self.read_twist(memory);
        let pose = read_pose(&memory[self.at + slot::POSE..]);
        let moved = Pose::from_parts(
            (pose.translation.vector + dt * twist.lin).into(),
            exp_rotation(&(dt * twist.ang)) * pose.rotation,
        );
        write_pose(&moved, &mut memory[self.at + slot::POSE..]);
    }

    fn remember_twist(&self, memory: &mut [f64], twist: &Twist) {
        memory[self.at + slot::VELOCITY..][..3].copy_from_slice(twist.lin.as_slice());
        memory[self.at + slot::SPIN..][..3].copy_from_slice(twist.ang.as_slice());
    }

    fn read_twist(&self, memory: &[f64]) -> Twist {
        let vector = |at: usize| Vec3::from_column_slice(&memory[self.at + at..][..3]);
        Twist::new(vector(slot::SPIN), vector(slot::VELOCITY))
    }

    fn remember_camera(&self, now: f64, memory: &mut [f64], pose: &Pose) {
        let (oldest, count) = (memory[self.at + slot::OLDEST] as usize, memory[self.at + slot::COUNT] as usize);
        if count > 0 && now - memory[self.place(oldest + count - 1)] < GRAIN * (1.0 - 1e-6) {
            return;
        }
        let at = self.place(oldest + count);
        memory[at] = now;
        write_pose(pose, &mut memory[at + 1..]);
        if count == self.room {
            memory[self.at + slot::OLDEST] = ((oldest + 1) % self.room) as f64;
        } else {
            memory[self.at + slot::COUNT] += 1.0;
        }
    }

    fn place(&self, index: usize) -> usize {
        self.at + slot::PLACES + PLACE * (index % self.room)
    }

    /// Pose of the base as it is made out; none before the first time.
    pub(super) fn base_pose(&self, memory: &[f64]) -> Option<Pose> {
        (memory[self.at + slot::COUNT] > 0.0).then(|| read_pose(&memory[self.at + slot::POSE..]))
    }

    /// The camera's last pose, W.
    pub(super) fn camera_now(&self, memory: &[f64]) -> Option<Pose> {
        self.camera_at(memory, f64::INFINITY)
    }

    /// The camera's pose at an instant, W: between those that are remembered, or the nearest of them.
    pub(super) fn camera_at(&self, memory: &[f64], time: f64) -> Option<Pose> {
        let (oldest, count) = (memory[self.at + slot::OLDEST] as usize, memory[self.at + slot::COUNT] as usize);
        let entry = |k: usize| {
            let at = self.place(oldest + k);
            (memory[at], read_pose(&memory[at + 1..]))
        };
        let after = (0..count).find(|k| entry(*k).0 >= time - 1e-9);
        match after {
            None => count.checked_sub(1).map(|last| entry(last).1),
            Some(0) => Some(entry(0).1),
            Some(k) => {
                let ((before, a), (later, b)) = (entry(k - 1), entry(k));
                Some(a.lerp_slerp(&b, ((time - before) / (later - before)).clamp(0.0, 1.0)))
            }
        }
    }
}

/// The base twists of all vehicles.
fn twists_of(world: &World) -> Vec<Twist> {
    (0..world.model().vehicles.len()).map(|v| world.kinematics(v).vel[0]).collect()
}

/// A joint's rate from what its encoder says: stamp, position and rate in `memory`, smoothed over [`SMOOTHING`].
fn follow(memory: &mut [f64], stamp: f64, position: f64) {
    let dt = stamp - memory[0];
    if memory[0] == 0.0 && memory[1] == 0.0 {
        (memory[0], memory[1]) = (stamp, position);
    } else if dt > 0.0 {
        let share = -(-dt / SMOOTHING).exp_m1();
        memory[2] += share * ((position - memory[1]) / dt - memory[2]);
        (memory[0], memory[1]) = (stamp, position);
    }
}

/// A pose into seven numbers of a memory: position, then x, y, z, w of the quaternion.
pub(crate) fn write_pose(pose: &Pose, memory: &mut [f64]) {
    memory[..3].copy_from_slice(pose.translation.vector.as_slice());
    memory[3..7].copy_from_slice(pose.rotation.coords.as_slice());
}

/// The pose that [`write_pose`] wrote.
pub(crate) fn read_pose(memory: &[f64]) -> Pose {
    let q = nalgebra::Quaternion::new(memory[6], memory[3], memory[4], memory[5]);
    Pose::from_parts(Vec3::from_column_slice(&memory[..3]).into(), Rot::new_normalize(q))
}
