//! Rotations: the exponential map, its inverse, and the rate of a rotation vector.
//!
//!   exp(φ) = cos(‖φ‖/2) + sin(‖φ‖/2) φ/‖φ‖        φ: rotation vector, rad
//!
//! The rate of a rotation vector that composes on the left (W axes) is, to fourth order in φ,
//!   φ̇ = ω − ½ φ×ω + 1/12 φ×(φ×ω)                  (Bortz 1971, truncated)
//! which is enough inside one Runge–Kutta step, where ‖φ‖ is a step's turn.

use crate::{Mat3, Rot, Vec3};
use nalgebra::{Quaternion, Unit};

/// The matrix of the cross product: `skew(a) b = a × b`.
#[inline]
pub fn skew(a: &Vec3) -> Mat3 {
    Mat3::new(0.0, -a.z, a.y, a.z, 0.0, -a.x, -a.y, a.x, 0.0)
}

/// Rotation by the vector `phi` (axis times angle, rad); exact for small angles too, where sin(x)/x is a series.
pub fn exp_rotation(phi: &Vec3) -> Rot {
    let half_sq = 0.25 * phi.norm_squared();
    let (real, sinc) = if half_sq < 1e-8 {
        (1.0 - half_sq * (0.5 - half_sq / 24.0), 1.0 - half_sq * (1.0 / 6.0 - half_sq / 120.0))
    } else {
        let half = half_sq.sqrt();
        (half.cos(), half.sin() / half)
    };
    Unit::new_unchecked(Quaternion::from_parts(real, 0.5 * sinc * phi))
}

/// Rotation vector of `rot`, of length at most π; the inverse of [`exp_rotation`].
pub fn log_rotation(rot: &Rot) -> Vec3 {
    let q = if rot.w < 0.0 { -rot.into_inner() } else { rot.into_inner() };
    let sin_half = q.imag().norm();
    if sin_half < 1e-8 {
        return 2.0 * q.imag();
    }
    2.0 * sin_half.atan2(q.w) / sin_half * q.imag()
}

/// Rotation matrix about the unit vector `axis` by `angle`, rad (Rodrigues).
#[inline]
pub fn rotation_about(axis: &Vec3, angle: f64) -> Mat3 {
    let (s, c) = angle.sin_cos();
    let k = axis * (1.0 - c);
    Mat3::new(
        k.x * axis.x + c,
        k.x * axis.y - s * axis.z,
        k.x * axis.z + s * axis.y,
        k.y * axis.x + s * axis.z,
        k.y * axis.y + c,
        k.y * axis.z - s * axis.x,
        k.z * axis.x - s * axis.y,
        k.z * axis.y + s * axis.x,
        k.z * axis.z + c,
    )
}

/// Rate of the rotation vector `phi` (left composition, W axes) at the angular velocity `omega`, both in W axes.
#[inline]
pub fn rotation_rate_of_vector(phi: &Vec3, omega: &Vec3) -> Vec3 {
    let cross = phi.cross(omega);
    omega - 0.5 * cross + phi.cross(&cross) / 12.0
}

#[cfg(test)]
mod tests {
    use super::*;

    // Round-off of a handful of trigonometric calls.
    const ROUND_OFF: f64 = 1e-14;

    #[test]
    fn exponential_and_logarithm_are_inverse_from_tiny_to_half_a_turn() {
        for angle in [1e-12, 1e-5, 1e-3, 0.1, 1.0, 3.1] {
            let phi = angle * Vec3::new(0.48, -0.6, 0.64);
            assert!((log_rotation(&exp_rotation(&phi)) - phi).norm() < ROUND_OFF * (1.0 + angle));
        }
    }

    #[test]
    fn matrix_about_an_axis_is_the_exponential() {
        let axis = Vec3::new(0.48, -0.6, 0.64);
        let by_quaternion = exp_rotation(&(0.7 * axis)).to_rotation_matrix();
        assert!((rotation_about(&axis, 0.7) - by_quaternion.matrix()).norm() < ROUND_OFF);
    }

    #[test]
    fn rate_of_the_rotation_vector_is_that_of_the_exponential() {
        let (phi, omega, h) = (Vec3::new(0.01, -0.02, 0.015), Vec3::new(0.3, 0.5, -0.2), 1e-5);
        let stepped = log_rotation(&(exp_rotation(&(h * omega)) * exp_rotation(&phi)));
        // One-sided difference: error ∝ h.
        assert!(((stepped - phi) / h - rotation_rate_of_vector(&phi, &omega)).norm() < 1e-5);
    }
}
