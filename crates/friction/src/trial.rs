//! What every law is asked and what it answers.

use nalgebra::{Matrix3, Vector3};

/// A parameter out of its range.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionError {
    /// The parameter's name.
    pub parameter: &'static str,
    /// Its value.
    pub value: f64,
    /// What it must be.
    pub must_be: &'static str,
}

impl std::fmt::Display for FrictionError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "friction parameter {} = {} must be {}", self.parameter, self.value, self.must_be)
    }
}

impl std::error::Error for FrictionError {}

/// Refuses values that are not finite or negative.
pub(crate) fn check_not_negative(all: &[(&'static str, f64)]) -> Result<(), FrictionError> {
    refuse(all, "finite and not negative", |x| x.is_finite() && x >= 0.0)
}

/// Refuses values that are not finite or not positive.
pub(crate) fn check_positive(all: &[(&'static str, f64)]) -> Result<(), FrictionError> {
    refuse(all, "finite and positive", |x| x.is_finite() && x > 0.0)
}

fn refuse(all: &[(&'static str, f64)], must_be: &'static str, fits: impl Fn(f64) -> bool) -> Result<(), FrictionError> {
    match all.iter().find(|(_, value)| !fits(*value)) {
        Some(&(parameter, value)) => Err(FrictionError { parameter, value, must_be }),
        None => Ok(()),
    }
}

/// What one evaluation needs. All vectors lie in the tangent plane, in any axes.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Deflection at the start, carried into the present tangent plane, m.
    pub s: Vector3<f64>,
    /// Deflection if nothing slipped: `s` plus the tangential displacement of B's point relative to A's, m.
    pub s_trial: Vector3<f64>,
    /// Slip velocity of B relative to A, for the level and the viscous term, m/s.
    pub slip: Vector3<f64>,
    /// Time between the two deflections, s; positive.
    pub elapsed: f64,
    /// Normal force, N; nothing is transmitted where it is not positive.
    pub normal_force: f64,
    /// How rested the contact was at the start, from 0 (sliding) to 1 (at rest for long); see [`crate::Levels`].
    pub rest: f64,
    /// Unit vector along which the levels are meant, for laws that differ across it; zero where there is none.
    pub grain: Vector3<f64>,
}

impl Default for Trial {
    fn default() -> Self {
        let zero = Vector3::zeros();
        Self { s: zero, s_trial: zero, slip: zero, elapsed: 1.0, normal_force: 0.0, rest: 1.0, grain: zero }
    }
}

/// A symmetric derivative within the plane: `across` at right angles to `direction`, `along` in it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slope {
    /// Value across the direction; the whole plane's where the direction is zero.
    pub across: f64,
    /// Value along the direction.
    pub along: f64,
    /// Unit vector, or zero.
    pub direction: Vector3<f64>,
}

impl Slope {
    /// The same in every direction.
    pub fn even(value: f64) -> Self {
        Self { across: value, along: value, direction: Vector3::zeros() }
    }

    /// Whether it is the same in every direction.
    #[inline]
    pub fn is_even(&self) -> bool {
        is_zero(&self.direction)
    }

    /// As a matrix in the plane normal to `n`.
    #[inline]
    pub fn calc_matrix(&self, n: &Vector3<f64>) -> Matrix3<f64> {
        let (d, even) = (&self.direction, self.across * (Matrix3::identity() - n * n.transpose()));
        if self.is_even() {
            return even;
        }
        even + (self.along - self.across) * (d * d.transpose())
    }
}

/// Whether a vector is zero: a comparison of matrices takes ten times as long.
#[inline]
pub(crate) fn is_zero(v: &Vector3<f64>) -> bool {
    v.x == 0.0 && v.y == 0.0 && v.z == 0.0
}

/// What the brush answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Brush {
    /// Force on B, N.
    pub force: Vector3<f64>,
    /// What becomes of the deflection, m; zero without normal force.
    pub s: Vector3<f64>,
    /// What becomes of the rest.
    pub rest: f64,
    /// Whether the deflection follows the displacement in full.
    pub sticks: bool,
    /// −∂f/∂s⁺ at fixed slip, normal force and rest, N/m.
    pub by_deflection: Slope,
    /// −∂f/∂u at fixed deflection, N·s/m; negative along the slip where the level falls with speed.
    pub by_slip: Slope,
}

/// What the law says in continuous time, for integrators that take rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrushRate {
    /// Force on B, N.
    pub force: Vector3<f64>,
    /// The deflection within what the normal force holds, m.
    pub s: Vector3<f64>,
    /// Its rate, m/s: the slip velocity, less what the law takes away.
    pub s_rate: Vector3<f64>,
    /// Whether it sticks.
    pub sticks: bool,
}

impl BrushRate {
    pub(crate) fn none() -> Self {
        let zero = Vector3::zeros();
        Self { force: zero, s: zero, s_rate: zero, sticks: false }
    }
}
