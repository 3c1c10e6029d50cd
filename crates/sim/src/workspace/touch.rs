//! Touching points in a step: what is known of them, where their laws are evaluated, what those answered.

use contact::NormalForce;
use friction::{Brush, PivotMoment};
use spatial::{Mat3, Vec3};

/// One touching point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub pair: u32,
    pub feature: u64,
    pub body_a: usize,
    pub body_b: usize,
    /// The contact point in W, and in the two bodies' frames.
    pub point: Vec3,
    pub local_a: Vec3,
    pub local_b: Vec3,
    /// A's and B's axes in W at the place of detection, and whether they are those of the step's start.
    pub rot_a: Mat3,
    pub rot_b: Mat3,
    pub is_at_start: bool,
    /// From A to B.
    pub normal: Vec3,
    pub gap: f64,
    /// Share of the pair's law that acts here.
    pub weight: f64,
    /// Deflection at the start, carried into the present plane.
    pub s: Vec3,
    /// How rested the point was at the start.
    pub rest: f64,
    /// Direction along which the friction levels are meant; zero where there is none.
    pub grain: Vec3,
    /// Angular deflection of a pair with a pivot, rad.
    pub turn: Vec3,
    /// Velocity of B's point relative to A's at the start.
    pub u: Vec3,
    /// What the bodies' turning adds to it over the step, without any gain: h (ω_B − ω_A) × ẋ_C. Gains are spatial, those
    /// of the velocity field at a place fixed in W, but the contact moves on with ẋ_C, taken as the mean of both points'.
    pub carried: Vec3,
    pub place: Place,
    pub out: Outcome,
}

/// Where the law is evaluated.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Place {
    pub gap_base: f64,
    pub s_base: Vec3,
    pub beta: f64,
    pub theta: f64,
    pub elapsed: f64,
}

/// What the law answered, and the line through it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outcome {
    /// Force on B by the law at the last u', N.
    pub law: Vec3,
    /// Normal part of it, N.
    pub normal_force: f64,
    /// Whether the surfaces press on each other, adhesion or not.
    pub bears: bool,
    /// Normal force that bounds the friction, now and one pass earlier, N (see [`Touch::calc_pressing`]).
    pub pressing: [f64; 2],
    /// Passes of this step so far.
    pub passes: u8,
    /// Deflection, rest and regime by the law.
    pub s: Vec3,
    pub rest: f64,
    pub sticks: bool,
    /// Passes of this step in which the slip force turned by more than 90°.
    pub turns: u8,
    /// −h ∂f/∂u', kg.
    pub g: Mat3,
    /// The line's force at u' = u, N.
    pub line: Vec3,
    /// Force that the solve gave both bodies, N.
    pub force: Vec3,
}

/// Where the laws were asked and what they said of slopes: what the next line is drawn from.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Answer {
    pub u_new: Vec3,
    pub normal: NormalForce,
    /// Trial deflection, slip and what the brush answered.
    pub friction: Option<(Vec3, Vec3, Brush)>,
    /// Whether this was the first pass of the step in which the slip force had turned.
    pub is_first_turn: bool,
}

/// A touching point that resists turning.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PivotTouch {
    /// Its place among the touches.
    pub touch: usize,
    pub pair: u32,
    pub weight: f64,
    pub bodies: [usize; 2],
    /// Angular deflection at the start, carried into the present plane, and B's angular velocity against A.
    pub start: Vec3,
    pub rate: Vec3,
    pub base: Vec3,
    pub beta: f64,
    pub elapsed: f64,
    pub normal: Vec3,
    /// Angular deflection if nothing slipped, and what the law made of it.
    pub trial: Vec3,
    pub out: PivotMoment,
    /// Moment at zero gain, its fall with the gain, and what the solve gave.
    pub line: Vec3,
    pub slope: Mat3,
    /// On B, W axes, N·m.
    pub moment: Vec3,
}
