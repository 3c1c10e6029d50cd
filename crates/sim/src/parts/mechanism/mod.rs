//! Mechanisms: what joins two bodies beside joints and contact. Struts, bushings, latches, welds.
//!
//! A mechanism acts between a frame F_a fixed in body A and a frame F_b fixed in body B (either may be the world). Its
//! state of deformation is a handful of coordinates e, functions of the relative pose, with
//!
//!   ė = B u + ė_rest       u: twist of B against A about the point of action, W axes; ė_rest: a rest pose on the move
//!   f_i = −∂U/∂e_i − (damping) ė_i,      wrench on B = Bᵀ f,  on A its negative about the *same* point
//!
//! so that the work of the wrench is the work of the coordinates, whatever the pose: elastic energy comes back to
//! rounding, the damping part is never negative, and momentum is exact because both sides take the same numbers. Laws
//! are pure; a latch remembers in [`MechanismMemory`], which only an accepted step changes.
//!
//! | kind | coordinates | acts at | states |
//! | --- | --- | --- | --- |
//! | [`Strut`] | distance of the two origins | the middle between them | always engaged |
//! | [`Bushing`] | rotation vector and offset of F_b in the mean of both frames | the middle | always engaged |
//! | [`Latch`] | those of its bushing, from the pose of engagement | the middle | open, engaged, released, broken |
//! | [`Weld`] | those of its bushing | the middle | engaged, broken |
//!
//! The implicit integrators take e at the predicted end, e' = e + h ė', and add h (h k + c) bᵀb per coordinate to the
//! mass matrix (b a row of B), symmetric and positive semidefinite; B itself is that of the start (geometric stiffness
//! is explicit: f h² / (m ℓ) should stay below 0.5).

mod bushing;
mod latch;
mod strut;
mod weld;

pub use bushing::Bushing;
pub use latch::{Capture, Latch, Overload, PullIn, Strength};
pub use strut::{Strut, StrutSides};
pub use weld::Weld;

pub(crate) use latch::calc_offset;

use crate::parts::Vehicle;
use serde::{Deserialize, Serialize};
use spatial::{Frame, Pose, Twist, Vec3, Wrench, exp_rotation, log_rotation};

/// A frame that a mechanism holds on to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Vehicle, or `None` for the world.
    pub vehicle: Option<usize>,
    /// Link of that vehicle (ignored for the world).
    pub link: usize,
    /// The frame in the link frame (in W for the world).
    pub pose_la: Pose,
}

impl Anchor {
    /// Global body (`world` for the world) and the frame in that body.
    pub(crate) fn resolve(&self, vehicles: &[Vehicle], world: usize) -> Option<(usize, Frame)> {
        let frame_la = Frame::from(&self.pose_la);
        let Some(v) = self.vehicle else { return Some((world, frame_la)) };
        let vehicle = vehicles.get(v)?;
        let link = vehicle.tree.links.get(self.link)?;
        Some((vehicle.body0 + link.body, &link.frame_bl * &frame_la))
    }
}

/// Something that joins two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// Unique name.
    pub name: String,
    /// F_a.
    pub side_a: Anchor,
    /// F_b; forces are those on its body.
    pub side_b: Anchor,
    /// What it is.
    pub kind: MechanismKind,
}

/// The kinds of mechanisms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MechanismKind {
    /// Spring and damper along the line of the two origins.
    Strut(Strut),
    /// Spring and damper in all six directions.
    Bushing(Bushing),
    /// A bushing that engages, lets go or breaks.
    Latch(Latch),
    /// A bushing from the start, with a strength.
    Weld(Weld),
}

/// Whether a mechanism holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum MechanismStatus {
    /// A latch that waits.
    Open,
    /// It acts.
    #[default]
    Engaged,
    /// A latch that let go, by command or by load; it waits for the next cycle of its command.
    Released,
    /// Gone for good.
    Broken,
}

impl MechanismStatus {
    /// For logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Engaged => "engaged",
            Self::Released => "released",
            Self::Broken => "broken",
        }
    }
}

/// What a mechanism remembers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MechanismMemory {
    /// Whether it holds.
    pub status: MechanismStatus,
    /// Time of the last change of status, s.
    pub since: f64,
    /// Time that the conditions of capture have been met, s.
    pub dwell: f64,
    /// Whether the last step's command was to release.
    pub commanded: bool,
    /// The frame that coincides with F_a at rest, in F_b, at the time `since`; a pull-in shrinks it to nothing.
    pub offset: Pose,
}

impl Default for MechanismMemory {
    fn default() -> Self {
        let status = MechanismStatus::Engaged;
        Self { status, since: 0.0, dwell: 0.0, commanded: false, offset: Pose::identity() }
    }
}

/// One side of a mechanism at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// F_a or F_b in W.
    pub frame: Frame,
    /// Its twist about its own origin, W axes.
    pub twist: Twist,
}

/// Most coordinates that a mechanism has.
pub(crate) const MAX_ROWS: usize = 6;
/// One number per coordinate; those beyond the mechanism's own are zero.
pub(crate) type Rows = [f64; MAX_ROWS];

/// The deformation of a mechanism and how velocities change it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Deformation {
    /// Where the wrenches act, W, m.
    pub point: Vec3,
    /// Number of coordinates.
    pub n: usize,
    /// e, rad and m.
    pub e: Rows,
    /// ė of a rest pose on the move, fixed sides.
    pub rest_rate: Rows,
    /// Rows of B: ė_i = row · u, about `point`, W axes.
    pub rows: [Wrench; MAX_ROWS],
}

/// The law of one coordinate.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RowForce {
    /// Generalised force, N or N·m; positive lengthens.
    pub force: f64,
    /// −∂f/∂e.
    pub stiffness: f64,
    /// −∂f/∂ė.
    pub damping: f64,
    /// Elastic energy, J.
    pub stored: f64,
    /// Power that the damping part takes, W.
    pub loss: f64,
}

impl RowForce {
    /// A linear spring and damper.
    pub fn linear(stiffness: f64, damping: f64, e: f64, rate: f64) -> Self {
        Self {
            force: -stiffness * e - damping * rate,
            stiffness,
            damping,
            stored: 0.5 * stiffness * e * e,
            loss: damping * rate * rate,
        }
    }
}

impl MechanismKind {
    /// What [`Self::hold`] gives, to be changed.
    pub fn hold_mut(&mut self) -> Option<&mut Bushing> {
        match self {
            Self::Strut(_) => None,
            Self::Bushing(hold) => Some(hold),
            Self::Latch(latch) => Some(&mut latch.hold),
            Self::Weld(weld) => Some(&mut weld.hold),
        }
    }

    /// What it remembers at the start.
    pub(crate) fn start(&self) -> MechanismMemory {
        let status = if matches!(self, Self::Latch(_)) { MechanismStatus::Open } else { MechanismStatus::Engaged };
        MechanismMemory { status, ..MechanismMemory::default() }
    }

    /// The bushing that holds, if it is one.
    pub fn hold(&self) -> Option<&Bushing> {
        match self {
            Self::Strut(_) => None,
            Self::Bushing(bushing) => Some(bushing),
            Self::Latch(latch) => Some(&latch.hold),
            Self::Weld(weld) => Some(&weld.hold),
        }
    }

    /// Deformation at an instant; `None` where it does not act.
    pub(crate) fn calc_deformation(
        &self,
        sides: &[Side; 2],
        memory: &MechanismMemory,
        time: f64,
    ) -> Option<Deformation> {
        if memory.status != MechanismStatus::Engaged {
            return None;
        }
        match self {
            Self::Strut(_) => Some(strut::calc_deformation(sides)),
            Self::Latch(Latch { pull_in: Some(pull_in), .. }) => {
                let rest = pull_in.calc_rest(&memory.offset, time - memory.since);
                Some(bushing::calc_deformation(sides, &rest))
            }
            _ => Some(bushing::calc_deformation(sides, &RestPose::fixed(&memory.offset))),
        }
    }

    /// The law of coordinate `i`.
    pub(crate) fn eval(&self, i: usize, e: f64, rate: f64) -> RowForce {
        match (self, self.hold()) {
            (Self::Strut(strut), _) => strut.eval(e, rate),
            (_, Some(hold)) => {
                let (stiffness, damping) = hold.coefficients(i);
                RowForce::linear(stiffness, damping, e, rate)
            }
            _ => RowForce::default(),
        }
    }

    /// Stiffness that coordinate `i` may meet within a step, N/m or N·m/rad.
    pub(crate) fn calc_stiffness_within(&self, i: usize, e: f64, reach: f64) -> f64 {
        match self {
            Self::Strut(strut) => strut.calc_stiffness_within(e, reach),
            _ => self.hold().map_or(0.0, |hold| hold.coefficients(i).0),
        }
    }

    /// Whether a step can change what it remembers.
    pub(crate) fn remembers(&self) -> bool {
        matches!(self, Self::Latch(_) | Self::Weld(_))
    }

    /// What it will remember after a step that led to `now`.
    pub(crate) fn advance(&self, now: &Moment<'_>, memory: MechanismMemory) -> MechanismMemory {
        match self {
            Self::Latch(latch) => latch.advance(now, memory),
            Self::Weld(weld) => weld.advance(now, memory),
            Self::Strut(_) | Self::Bushing(_) => memory,
        }
    }

    /// Why it cannot be, if it cannot.
    pub(crate) fn find_fault(&self) -> Option<String> {
        match self {
            Self::Strut(strut) => strut.find_fault(),
            Self::Bushing(bushing) => bushing.find_fault(),
            Self::Latch(latch) => latch.find_fault(),
            Self::Weld(weld) => weld.find_fault(),
        }
    }
}

/// An instant at which memory is revised.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment<'a> {
    pub sides: &'a [Side; 2],
    pub time: f64,
    pub step: f64,
    /// Whether the command is to release.
    pub commanded: bool,
    /// Force (N) and moment (N·m) that it bears at this instant.
    pub load: [f64; 2],
}

/// Where the rest frame stands in F_b, and how it moves there (twist about its own origin, axes of F_b).
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestPose {
    pub frame: Frame,
    pub twist: Twist,
}

impl RestPose {
    fn fixed(offset: &Pose) -> Self {
        Self { frame: Frame::from(offset), twist: Twist::default() }
    }

    /// An offset that shrinks: the share `s` of it is left, and that share changes at `rate`, 1/s.
    fn shrinking(offset: &Pose, s: f64, rate: f64) -> Self {
        let (turn, shift) = (log_rotation(&offset.rotation), offset.translation.vector);
        let pose = Pose::from_parts((s * shift).into(), exp_rotation(&(s * turn)));
        Self { frame: Frame::from(&pose), twist: Twist::new(rate * turn, rate * shift) }
    }
}

/// Every stiffness, damping or strength is a number of at least zero.
fn find_negative(values: &[(&str, f64)]) -> Option<String> {
    let bad = values.iter().find(|(_, x)| x.is_nan() || *x < 0.0)?;
    Some(format!("{} = {} must be a number of at least zero", bad.0, bad.1))
}
