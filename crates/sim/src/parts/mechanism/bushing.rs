//! Six-axis bushing: three linear and three torsional springs and dampers between two frames.
//!
//! With x the origins and R the axes of F_a and F_b, d = x_b − x_a, φ = log(R_aᵀ R_b) (rotation vector, θ = ‖φ‖):
//!
//!   R_m = R_a exp(φ/2) = ½ (R_a + R_b)(φ̂φ̂ᵀ + (1 − φ̂φ̂ᵀ)/cos(θ/2))       mean axes, the same seen from either side
//!   e = (φ, p),  p = R_mᵀ d                                               the same components in mean axes
//!   φ̇ = S⁻¹ R_mᵀ ω,  S⁻¹ = φ̂φ̂ᵀ + (θ/2)/sin(θ/2) (1 − φ̂φ̂ᵀ)                ω = ω_b − ω_a
//!   ṗ = R_mᵀ (u + (t × ω) × d),  t = ½ tan(θ/4) R_m φ̂                      u: velocity of B against A at the middle
//!
//! S⁻¹ is symmetric because half of the rotation stands on either side; the second term of ṗ is the turning of the mean
//! axes beyond the mean of the two spins. Forces are −k e − c ė on these coordinates and act at the middle of the two
//! origins. Both sides are treated alike: swapping them flips the wrench. (Mean axes as in Drake's LinearBushing, there
//! with roll, pitch and yaw; here no axis is preferred and no angle is singular below half a turn.)
//!
//! Valid for rotations below half a turn, where the rotation vector jumps and with it the torque.

use super::{Deformation, RestPose, Side, find_negative};
use spatial::{Mat3, Twist, Vec3, Wrench, log_rotation};

/// A six-axis spring and damper.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bushing {
    /// Along x, y, z of the mean axes, N/m.
    pub stiffness: Vec3,
    /// N·s/m.
    pub damping: Vec3,
    /// About x, y, z of the mean axes, N·m/rad.
    pub torsional_stiffness: Vec3,
    /// N·m·s/rad.
    pub torsional_damping: Vec3,
}

/// A mass (kg) or an inertia (kg·m²) that swings on a bushing: 1/μ = 1/m_a + 1/m_b, infinity for what stands still.
fn reduced([a, b]: [f64; 2]) -> f64 {
    let inverse = 1.0 / a + 1.0 / b;
    if inverse > 0.0 { 1.0 / inverse } else { 0.0 }
}

impl Bushing {
    /// The same in every direction.
    pub fn isotropic(linear: [f64; 2], torsional: [f64; 2]) -> Self {
        Self {
            stiffness: Vec3::repeat(linear[0]),
            damping: Vec3::repeat(linear[1]),
            torsional_stiffness: Vec3::repeat(torsional[0]),
            torsional_damping: Vec3::repeat(torsional[1]),
        }
    }

    /// The isotropic bushing on which two bodies of the given masses (kg) and inertias (kg·m²) would swing at `frequency`
    /// (Hz) with the damping ratio `ratio`, if they were spheres about its point: k = μ (2πf)², c = 2 ζ √(kμ).
    pub fn from_frequency(frequency: f64, ratio: f64, masses: [f64; 2], inertias: [f64; 2]) -> Self {
        let rate = std::f64::consts::TAU * frequency;
        let spring = |inertia: f64| [inertia * rate * rate, 2.0 * ratio * inertia * rate];
        Self::isotropic(spring(reduced(masses)), spring(reduced(inertias)))
    }

    /// Stiffness and damping of coordinate `i`: rotations first.
    pub(crate) fn coefficients(&self, i: usize) -> (f64, f64) {
        if i < 3 {
            (self.torsional_stiffness[i], self.torsional_damping[i])
        } else {
            (self.stiffness[i - 3], self.damping[i - 3])
        }
    }

    pub(crate) fn find_fault(&self) -> Option<String> {
        let groups = [
            ("stiffness", self.stiffness),
            ("damping", self.damping),
            ("torsional stiffness", self.torsional_stiffness),
            ("torsional damping", self.torsional_damping),
        ];
        groups.iter().find_map(|(name, v)| find_negative(&[(name, v.x), (name, v.y), (name, v.z)]))
    }
}

/// Even functions of the angle θ that the rows need; series below a milliradian, where they are exact to rounding.
struct HalfAngle {
    /// 1/cos(θ/2), and (1 − that)/θ².
    secant: [f64; 2],
    /// (θ/2)/sin(θ/2), and (1 − that)/θ².
    cosecant: [f64; 2],
    /// ½ tan(θ/4)/θ.
    tangent: f64,
}

impl HalfAngle {
    fn of(theta: f64) -> Self {
        let sq = theta * theta;
        if theta < 1e-3 {
            let (secant, cosecant) = (-0.125 - sq * 5.0 / 384.0, -1.0 / 24.0 - sq * 7.0 / 5760.0);
            return Self {
                secant: [1.0 - sq * secant, secant],
                cosecant: [1.0 - sq * cosecant, cosecant],
                tangent: 0.125 + sq / 384.0,
            };
        }
        // At half a turn the mean axes do not exist; just below, they are lost to rounding.
        let secant = 1.0 / (0.5 * theta).cos().max(1e-6);
        let cosecant = 0.5 * theta / (0.5 * theta).sin();
        Self {
            secant: [secant, (1.0 - secant) / sq],
            cosecant: [cosecant, (1.0 - cosecant) / sq],
            tangent: 0.5 * (0.25 * theta).tan() / theta,
        }
    }
}

/// Deformation against a rest frame that stands (or moves) in F_b.
pub(crate) fn calc_deformation(sides: &[Side; 2], rest: &RestPose) -> Deformation {
    let (a, b) = (&sides[0].frame, &sides[1].frame * &rest.frame);
    let relative = spatial::Frame { rot: a.rot.tr_mul(&b.rot), pos: Vec3::zeros() };
    let phi = log_rotation(&relative.to_pose().rotation);
    let (half, outer) = (HalfAngle::of(phi.norm()), phi * phi.transpose());
    let blend = |[across, along]: [f64; 2]| Mat3::from_diagonal_element(across) + along * outer;
    let mean = 0.5 * (a.rot + b.rot) * blend(half.secant);
    let (offset, point) = (b.pos - a.pos, 0.5 * (a.pos + b.pos));
    let (turn_rows, t) = (mean * blend(half.cosecant), mean * (half.tangent * phi));
    let p = mean.tr_mul(&offset);
    let mut out = Deformation { point, n: 6, e: [phi.x, phi.y, phi.z, p.x, p.y, p.z], ..Deformation::default() };
    for i in 0..3 {
        let axis = mean.column(i).into_owned();
        out.rows[i] = Wrench::new(turn_rows.column(i).into_owned(), Vec3::zeros());
        out.rows[3 + i] = Wrench::new(t.cross(&axis.cross(&offset)), axis);
    }
    add_rest_rate(&mut out, &sides[1], rest, &b.pos);
    out
}

/// The rest frame's own motion counts as motion of B.
fn add_rest_rate(out: &mut Deformation, side_b: &Side, rest: &RestPose, origin: &Vec3) {
    if rest.twist == Twist::default() {
        return;
    }
    let rot = &side_b.frame.rot;
    let twist = Twist::new(rot * rest.twist.ang, rot * rest.twist.lin).about(&(out.point - origin));
    for (rate, row) in out.rest_rate.iter_mut().zip(&out.rows) {
        *rate = twist.dot(row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::{Frame, Pose, exp_rotation, nalgebra::Matrix3};

    fn side(turn: Vec3, at: Vec3, twist: Twist) -> Side {
        Side { frame: Frame::from(&Pose::from_parts(at.into(), exp_rotation(&turn))), twist }
    }

    fn pair(angle: f64) -> [Side; 2] {
        let twist = |k: f64| Twist::new(Vec3::new(0.3, -0.5 * k, 0.7), Vec3::new(-0.2 * k, 0.4, 0.1));
        let axis = Vec3::new(0.48, -0.6, 0.64);
        [
            side(Vec3::new(0.3, 0.2, -0.4), Vec3::new(0.1, 0.0, 0.3), twist(1.0)),
            side(Vec3::new(0.3, 0.2, -0.4) + angle * axis, Vec3::new(0.25, -0.2, 0.4), twist(-2.0)),
        ]
    }

    fn moved(side: &Side, h: f64) -> Side {
        let turned = *exp_rotation(&(h * side.twist.ang)).to_rotation_matrix().matrix();
        let frame = Frame { rot: turned * side.frame.rot, pos: side.frame.pos + h * side.twist.lin };
        Side { frame, twist: side.twist }
    }

    #[test]
    fn rows_are_the_rates_of_the_coordinates_at_every_angle() {
        let (still, h) = (RestPose::fixed(&Pose::identity()), 1e-6);
        for angle in [0.0, 1e-8, 9e-4, 1.1e-3, 0.3, 1.5, 2.6] {
            let sides = pair(angle);
            let [before, after] =
                [-h, h].map(|h| calc_deformation(&[moved(&sides[0], h), moved(&sides[1], h)], &still));
            let now = calc_deformation(&sides, &still);
            let twist = |s: &Side| s.twist.about(&(now.point - s.frame.pos));
            let u = twist(&sides[1]) - twist(&sides[0]);
            for i in 0..6 {
                let difference = (after.e[i] - before.e[i]) / (2.0 * h);
                // Central difference: truncation ∝ h², rounding 1e-16/h, both with the angle's 1/cos.
                assert!((difference - u.dot(&now.rows[i])).abs() < 1e-8, "coordinate {i} at {angle} rad");
            }
        }
    }

    #[test]
    fn a_moving_rest_pose_counts_as_motion_of_the_deformation() {
        let offset = Pose::from_parts(Vec3::new(0.02, -0.01, 0.03).into(), exp_rotation(&Vec3::new(0.1, 0.2, -0.05)));
        let (sides, h, rate) = (pair(0.2), 1e-6, -0.4);
        let at = |s: f64| calc_deformation(&sides, &RestPose::shrinking(&offset, s, rate));
        let (before, now, after) = (at(0.7 - h * rate), at(0.7), at(0.7 + h * rate));
        for i in 0..6 {
            assert!(((after.e[i] - before.e[i]) / (2.0 * h) - now.rest_rate[i]).abs() < 1e-9, "coordinate {i}");
        }
    }

    #[test]
    fn swapping_the_sides_flips_deformation_and_rows_to_the_last_bit() {
        let still = RestPose::fixed(&Pose::identity());
        for angle in [0.0, 1e-5, 0.3, 2.0] {
            let [a, b] = pair(angle);
            let (one, other) = (calc_deformation(&[a, b], &still), calc_deformation(&[b, a], &still));
            assert_eq!(one.point, other.point);
            assert_eq!(one.rows, other.rows);
            assert_eq!(one.e.map(|x| -x), other.e);
        }
    }

    #[test]
    fn mean_axes_stand_half_way() {
        let still = RestPose::fixed(&Pose::identity());
        let sides = pair(0.9);
        let out = calc_deformation(&sides, &still);
        let mean = Matrix3::from_columns(&[out.rows[3].force, out.rows[4].force, out.rows[5].force]);
        let half = exp_rotation(&Vec3::new(out.e[0], out.e[1], out.e[2]).scale(0.5));
        let by_exponential = sides[0].frame.rot * half.to_rotation_matrix().matrix();
        assert!((mean - by_exponential).norm() < 1e-14);
    }
}
