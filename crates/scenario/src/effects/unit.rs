//! Units of parameters: one for what turns, another for what slides.

/// A unit, "" for a pure number or for the unit of the channel that a sensor's parameter is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// At a joint that turns; where a torque acts.
    pub turning: &'static str,
    /// At a joint that slides; where a force acts.
    pub sliding: &'static str,
}

impl Unit {
    /// The same for both.
    const fn one(text: &'static str) -> Self {
        Self { turning: text, sliding: text }
    }

    const fn either(turning: &'static str, sliding: &'static str) -> Self {
        Self { turning, sliding }
    }

    /// The one that is meant: `along` a joint that slides, or of a force.
    pub fn pick(self, along: bool) -> &'static str {
        if along { self.sliding } else { self.turning }
    }

    /// Both, for a reader; "" for a pure number.
    pub fn text(self) -> String {
        if self.turning == self.sliding {
            return self.turning.to_owned();
        }
        format!("{} or {}", self.turning, self.sliding)
    }
}

pub(super) const NONE: Unit = Unit::one("");
pub(super) const S: Unit = Unit::one("s");
pub(super) const HZ: Unit = Unit::one("Hz");
pub(super) const RAD: Unit = Unit::one("rad");
pub(super) const RAD_PER_S: Unit = Unit::one("rad/s");
pub(super) const M: Unit = Unit::one("m");
pub(super) const M_PER_S: Unit = Unit::one("m/s");
pub(super) const M_PER_S2: Unit = Unit::one("m/s²");
pub(super) const S_PER_M: Unit = Unit::one("s/m");
pub(super) const KG: Unit = Unit::one("kg");
pub(super) const KG_M2: Unit = Unit::one("kg m²");
pub(super) const ROOT_KG_M: Unit = Unit::one("√kg m");
pub(super) const N: Unit = Unit::one("N");
pub(super) const N_M: Unit = Unit::one("N m");
pub(super) const N_PER_M: Unit = Unit::one("N/m");
pub(super) const N_PER_M_EXP: Unit = Unit::one("N/mⁿ");
pub(super) const N_S_PER_M: Unit = Unit::one("N s/m");
pub(super) const N_S2_PER_M2: Unit = Unit::one("N s²/m²");
pub(super) const N_M_S_PER_RAD: Unit = Unit::one("N m s/rad");

/// Of a joint's effort, or of a torque or force.
pub(super) const EFFORT: Unit = Unit::either("N m", "N");
/// Of a joint's place.
pub(super) const PLACE: Unit = Unit::either("rad", "m");
/// Of a joint's rate.
pub(super) const RATE: Unit = Unit::either("rad/s", "m/s");
/// Of a joint's effort over its place.
pub(super) const STIFFNESS: Unit = Unit::either("N m/rad", "N/m");
/// Of a joint's effort over its rate.
pub(super) const DAMPING: Unit = Unit::either("N m s/rad", "N s/m");
/// Of a joint's effort over the square of its rate.
pub(super) const DRAG: Unit = Unit::either("N m s²/rad²", "N s²/m²");
/// Of inertia that is reflected to a joint.
pub(super) const REFLECTED: Unit = Unit::either("kg m²", "kg");
