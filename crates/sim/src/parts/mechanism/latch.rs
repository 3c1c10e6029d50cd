//! Latch: a bushing that engages where geometry and speed allow, holds up to a load, and lets go.
//!
//!   open ──conditions met for the dwell time──▶ engaged ──command, or load above the strength──▶ released
//!                                                  └──load above the strength (one that breaks)──▶ broken
//!
//! Capture region: z of F_a points out of A, towards where B comes from; F_b, when nominal, coincides with F_a. With p the
//! origin of F_b in F_a: axial p_z, lateral √(p_x² + p_y²), tilt between both z axes, roll about them, closing speed −ṗ_z.
//!
//! On engagement the rest pose is the pose of that instant: all deformations are zero, nothing is stored, and the force
//! begins with its damping part only: no energy is created. A pull-in then leads the rest pose to nominal (F_b on F_a) in
//! a straight line and about a fixed axis; its work goes to the actuators' account, since a motor does it. What is
//! stored when the latch lets go is lost in it.
//!
//! Commands: an actuator of kind `LatchRelease`, effort above ½ means open. While it is so, a latch does not engage; once it
//! is withdrawn, a released latch waits anew. One that let go by load waits for the next such cycle.

use super::{Bushing, MechanismMemory, MechanismStatus, Moment, RestPose, Side, find_negative};
use spatial::{Pose, Vec3, log_rotation};

/// A latch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Latch {
    /// When it engages.
    pub capture: Capture,
    /// How it holds.
    pub hold: Bushing,
    /// How much it holds.
    pub strength: Strength,
    /// What becomes of it beyond that.
    pub overload: Overload,
    /// Motion of the rest pose to nominal after engagement.
    pub pull_in: Option<PullIn>,
}

/// Conditions of capture; all must hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capture {
    /// Bounds of p_z, m.
    pub axial: [f64; 2],
    /// Largest √(p_x² + p_y²), m.
    pub lateral: f64,
    /// Largest angle between the z axes, rad.
    pub tilt: f64,
    /// Largest rotation about them, rad; π for any.
    pub roll: f64,
    /// Bounds of the closing speed −ṗ_z, m/s.
    pub closing_speed: [f64; 2],
    /// Time that all this must last, s.
    pub dwell: f64,
}

/// Largest load that a hold bears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    /// N.
    pub force: f64,
    /// About the point of action, N·m.
    pub moment: f64,
}

/// What an overloaded latch does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overload {
    /// It opens and can be used again.
    #[default]
    LetsGo,
    /// It is gone.
    Breaks,
}

/// Speeds at which a rest pose is led to nominal; the slower of the two motions sets the time of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PullIn {
    /// m/s.
    pub speed: f64,
    /// rad/s.
    pub turn_rate: f64,
}

impl Default for Strength {
    fn default() -> Self {
        Self { force: f64::INFINITY, moment: f64::INFINITY }
    }
}

impl Strength {
    /// Whether a load of [N, N·m] is more than it bears.
    pub(crate) fn is_exceeded(&self, load: [f64; 2]) -> bool {
        load[0] > self.force || load[1] > self.moment
    }
}

impl Capture {
    /// Whether all conditions but the dwell are met.
    pub fn is_met(&self, sides: &[Side; 2]) -> bool {
        let [a, b] = sides;
        let r = b.frame.pos - a.frame.pos;
        let (p, rate) = (a.frame.rot.tr_mul(&r), a.frame.rot.tr_mul(&(b.twist.lin - a.twist.at(&r))));
        let relative = spatial::Frame { rot: a.frame.rot.tr_mul(&b.frame.rot), pos: p };
        let tilt = calc_angle(&relative.rot.column(2).into_owned());
        let q = relative.to_pose().rotation;
        let roll = 2.0 * q.k.atan2(q.w);
        let roll = (roll - std::f64::consts::TAU * (roll / std::f64::consts::TAU).round()).abs();
        let within = |x: f64, [low, high]: [f64; 2]| (low..=high).contains(&x);
        within(p.z, self.axial)
            && p.x.hypot(p.y) <= self.lateral
            && tilt <= self.tilt
            && roll <= self.roll
            && within(-rate.z, self.closing_speed)
    }
}

/// Angle between a unit vector and z, rad; exact for small ones too.
fn calc_angle(axis: &Vec3) -> f64 {
    axis.x.hypot(axis.y).atan2(axis.z)
}

impl PullIn {
    /// The rest pose `elapsed` seconds after engagement at `offset`.
    pub(crate) fn calc_rest(&self, offset: &Pose, elapsed: f64) -> RestPose {
        let (turn, shift) = (log_rotation(&offset.rotation).norm(), offset.translation.vector.norm());
        let duration = (shift / self.speed).max(turn / self.turn_rate);
        if duration <= 0.0 || elapsed >= duration {
            return RestPose::fixed(&Pose::identity());
        }
        RestPose::shrinking(offset, 1.0 - elapsed / duration, -1.0 / duration)
    }
}

impl Latch {
    pub(crate) fn advance(&self, now: &Moment<'_>, memory: MechanismMemory) -> MechanismMemory {
        let was_commanded = memory.commanded;
        let memory = MechanismMemory { commanded: now.commanded, ..memory };
        let become_ = |status| MechanismMemory { status, since: now.time, dwell: 0.0, ..memory };
        match memory.status {
            MechanismStatus::Open => self.wait(now, memory),
            MechanismStatus::Engaged if now.commanded => become_(MechanismStatus::Released),
            MechanismStatus::Engaged if self.strength.is_exceeded(now.load) => match self.overload {
                Overload::LetsGo => become_(MechanismStatus::Released),
                Overload::Breaks => become_(MechanismStatus::Broken),
            },
            MechanismStatus::Released if was_commanded && !now.commanded => become_(MechanismStatus::Open),
            MechanismStatus::Engaged | MechanismStatus::Released | MechanismStatus::Broken => memory,
        }
    }

    fn wait(&self, now: &Moment<'_>, memory: MechanismMemory) -> MechanismMemory {
        if now.commanded || !self.capture.is_met(now.sides) {
            return MechanismMemory { dwell: 0.0, ..memory };
        }
        let dwell = memory.dwell + now.step;
        // Half a step of slack: a dwell of n steps is n steps, whatever their sum rounds to.
        if dwell < self.capture.dwell - 0.5 * now.step {
            return MechanismMemory { dwell, ..memory };
        }
        MechanismMemory {
            status: MechanismStatus::Engaged,
            since: now.time,
            dwell: 0.0,
            offset: calc_offset(now.sides),
            ..memory
        }
    }

    pub(crate) fn find_fault(&self) -> Option<String> {
        let Capture { axial, lateral, tilt, roll, closing_speed, dwell } = self.capture;
        if let Some([low, high]) =
            [axial, closing_speed].into_iter().find(|[low, high]| low.is_nan() || high.is_nan() || low > high)
        {
            return Some(format!("bounds {low} … {high} of its capture must ascend"));
        }
        if self
            .pull_in
            .is_some_and(|p| p.speed.is_nan() || p.speed <= 0.0 || p.turn_rate.is_nan() || p.turn_rate <= 0.0)
        {
            return Some("the speeds of its pull-in must be positive".to_owned());
        }
        let limits = [("lateral limit", lateral), ("tilt", tilt), ("roll", roll), ("dwell", dwell)];
        let strength = [("hold force", self.strength.force), ("hold moment", self.strength.moment)];
        self.hold.find_fault().or(find_negative(&limits)).or(find_negative(&strength))
    }
}

/// The frame that coincides with F_a at this instant, in F_b.
pub(crate) fn calc_offset(sides: &[Side; 2]) -> Pose {
    sides[1].frame.to_pose().inverse() * sides[0].frame.to_pose()
}
