//! Rigid-body inertia about a point, as ten numbers, and the symmetric 6×6 that composites need.
//!
//! About a point O: mass m, first moment m c (c = centre of mass from O), rotational inertia I_O. Momentum of a twist:
//!   p = m v + ω × mc,     L_O = I_O ω + mc × v.

use crate::{Mat3, Twist, Vec3, Wrench, skew};
use serde::{Deserialize, Serialize};
use std::ops::{Add, AddAssign};

/// Inertia of a rigid body about a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Inertia {
    /// Mass, kg.
    pub mass: f64,
    /// First moment: mass times the centre of mass from the point, kg·m.
    pub mc: Vec3,
    /// Rotational inertia about the point, kg·m².
    pub rot: Mat3,
}

/// Why a mass and a tensor belong to no rigid body.
#[derive(Clone, Debug, PartialEq)]
pub enum InertiaError {
    /// A number is NaN or infinite.
    NotFinite,
    /// The mass is zero or negative.
    Mass(f64),
    /// A principal moment is zero or negative; the moments, ascending.
    NotPositive([f64; 3]),
    /// The two smaller principal moments sum to less than the largest; the moments, ascending.
    Triangle([f64; 3]),
}

impl std::fmt::Display for InertiaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NotFinite => write!(f, "mass or inertia is not a finite number"),
            Self::Mass(m) => write!(f, "mass {m} kg is not positive"),
            Self::NotPositive([a, b, c]) => {
                write!(f, "inertia is not positive definite (principal moments {a:.4e}, {b:.4e}, {c:.4e} kg·m²)")
            }
            Self::Triangle([a, b, c]) => {
                write!(f, "inertia violates the triangle inequality I1 + I2 ≥ I3 ({a:.4e} + {b:.4e} < {c:.4e})")
            }
        }
    }
}

impl Inertia {
    /// From the mass (kg), the centre of mass from the point (m), and the tensor about the centre of mass (kg·m²).
    pub fn from_com(mass: f64, com: &Vec3, tensor_com: &Mat3) -> Self {
        let c = skew(com);
        Self { mass, mc: mass * com, rot: tensor_com - mass * c * c }
    }

    /// Centre of mass from the point, m; zero for a massless body.
    pub fn com(&self) -> Vec3 {
        if self.mass == 0.0 { Vec3::zeros() } else { self.mc / self.mass }
    }

    /// Tensor about the centre of mass, kg·m².
    pub fn tensor_com(&self) -> Mat3 {
        if self.mass == 0.0 {
            return self.rot;
        }
        let c = skew(&self.mc);
        self.rot + c * c / self.mass
    }

    /// In the axes and about the origin of the parent frame that `rot`, `pos` (child in parent) describe.
    #[inline]
    pub fn transformed(&self, rot: &Mat3, pos: &Vec3) -> Self {
        let mc = rot * self.mc;
        // I_O' = R I Rᵀ + (2 r·c − …) with r = pos: I + m(r²1 − rrᵀ) + 2(r·mc)1 − r mcᵀ − mc rᵀ.
        let turned = rot * self.rot * rot.transpose();
        let diagonal = self.mass * pos.norm_squared() + 2.0 * pos.dot(&mc);
        let outer = pos * (self.mass * pos + mc).transpose() + mc * pos.transpose();
        Self { mass: self.mass, mc: mc + self.mass * pos, rot: turned - outer + Mat3::from_diagonal_element(diagonal) }
    }

    /// Momentum of the twist about the same point: angular (moment slot) and linear (force slot).
    #[inline]
    pub fn momentum(&self, v: &Twist) -> Wrench {
        Wrench { moment: self.rot * v.ang + self.mc.cross(&v.lin), force: self.mass * v.lin + v.ang.cross(&self.mc) }
    }

    /// Kinetic energy of the twist, J.
    pub fn kinetic_energy(&self, v: &Twist) -> f64 {
        0.5 * v.dot(&self.momentum(v))
    }

    /// The twist that has the given momentum, solved about the centre of mass by one 3×3; `None` if there is none.
    #[inline]
    pub fn twist_of(&self, h: &Wrench) -> Option<Twist> {
        let com = self.mc / self.mass;
        let tensor_com = self.tensor_com();
        let spin = h.moment - com.cross(&h.force);
        let ang = solve_spd(&tensor_com, &spin)?;
        Some(Twist { ang, lin: h.force / self.mass - ang.cross(&com) })
    }

    /// Checks that a rigid body can have this mass and this tensor about its centre of mass.
    pub fn check(mass: f64, tensor_com: &Mat3) -> Result<(), InertiaError> {
        if !mass.is_finite() || tensor_com.iter().any(|x| !x.is_finite()) {
            return Err(InertiaError::NotFinite);
        }
        if mass <= 0.0 {
            return Err(InertiaError::Mass(mass));
        }
        let moments = sorted_moments(tensor_com);
        if moments[0] <= 0.0 { Err(InertiaError::NotPositive(moments)) } else { Self::check_triangle(tensor_com) }
    }

    /// Checks that the two smaller principal moments sum to no less than the largest.
    pub fn check_triangle(tensor_com: &Mat3) -> Result<(), InertiaError> {
        let moments = sorted_moments(tensor_com);
        // Files carry six digits: a thin plate, where equality holds, must pass.
        let slack = 1e-5 * moments[2].abs();
        if moments[0] + moments[1] < moments[2] - slack { Err(InertiaError::Triangle(moments)) } else { Ok(()) }
    }
}

/// Principal moments, ascending.
fn sorted_moments(tensor: &Mat3) -> [f64; 3] {
    let mut moments: [f64; 3] = tensor.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    moments
}

/// x with A x = b for a symmetric positive definite A, by Cramer's rule on the adjugate.
#[inline]
fn solve_spd(a: &Mat3, b: &Vec3) -> Option<Vec3> {
    let (r0, r1, r2) = (a.column(0).into_owned(), a.column(1).into_owned(), a.column(2).into_owned());
    let (c0, c1, c2) = (r1.cross(&r2), r2.cross(&r0), r0.cross(&r1));
    let det = r0.dot(&c0);
    (det > 0.0).then(|| Vec3::new(c0.dot(b), c1.dot(b), c2.dot(b)) / det)
}

impl Add for Inertia {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self { mass: self.mass + o.mass, mc: self.mc + o.mc, rot: self.rot + o.rot }
    }
}

impl AddAssign for Inertia {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

/// A 6×6 map from twists to wrenches, in four 3×3 blocks: composites of inertias and contact stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialMatrix {
    /// Moment per angular part.
    pub ma: Mat3,
    /// Moment per linear part.
    pub ml: Mat3,
    /// Force per angular part.
    pub fa: Mat3,
    /// Force per linear part.
    pub fl: Mat3,
}

impl SpatialMatrix {
    /// Xᵀ G X: what the symmetric 3×3 map `g` from the velocity of a point at `r` to a force there is about the origin.
    ///
    ///   v = v_o − r× ω,  m = r× f:   (m, f) = ( −r× G r×   r× G )  (ω, v_o)
    ///                                          (    −G r×       G  )
    #[inline]
    pub fn from_point(g: &Mat3, r: &Vec3) -> Self {
        let ml = cross_columns(r, g);
        let fa = ml.transpose();
        Self { ma: cross_columns(r, &fa), ml, fa, fl: *g }
    }

    /// A stiffness between two bodies that is given about B's origin, which is at `d` from A's: with the forces about A's origin
    /// and the velocities about B's, and with both about A's.
    #[inline]
    pub fn about_first(&self, d: &Vec3) -> [Self; 2] {
        // m_A = m_B + d × f, and v_B = v_A − d × ω.
        let between =
            Self { ma: self.ma + cross_columns(d, &self.fa), ml: self.ml + cross_columns(d, &self.fl), ..*self };
        let turned = |m: &Mat3| cross_columns(d, &m.transpose()).transpose();
        let own = Self { ma: between.ma + turned(&between.ml), fa: between.fa + turned(&between.fl), ..between };
        [between, own]
    }

    /// Image of a twist.
    #[inline]
    pub fn mul(&self, v: &Twist) -> Wrench {
        Wrench { moment: self.ma * v.ang + self.ml * v.lin, force: self.fa * v.ang + self.fl * v.lin }
    }

    /// The transposed map.
    pub fn transpose(&self) -> Self {
        let Self { ma, ml, fa, fl } = self;
        Self { ma: ma.transpose(), ml: fa.transpose(), fa: ml.transpose(), fl: fl.transpose() }
    }

    /// Image of a twist under the transposed map.
    #[inline]
    pub fn tr_mul(&self, v: &Twist) -> Wrench {
        Wrench {
            moment: self.ma.tr_mul(&v.ang) + self.fa.tr_mul(&v.lin),
            force: self.ml.tr_mul(&v.ang) + self.fl.tr_mul(&v.lin),
        }
    }
}

/// [r] M, a cross product per column.
#[inline]
fn cross_columns(r: &Vec3, m: &Mat3) -> Mat3 {
    let column = |k: usize| r.cross(&Vec3::new(m[(0, k)], m[(1, k)], m[(2, k)]));
    Mat3::from_columns(&[column(0), column(1), column(2)])
}

impl From<&Inertia> for SpatialMatrix {
    #[inline]
    fn from(i: &Inertia) -> Self {
        let c = skew(&i.mc);
        Self { ma: i.rot, ml: c, fa: -c, fl: Mat3::from_diagonal_element(i.mass) }
    }
}

impl AddAssign for SpatialMatrix {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        self.ma += o.ma;
        self.ml += o.ml;
        self.fa += o.fa;
        self.fl += o.fl;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation_about;

    // Round-off of a few products of numbers near one.
    const ROUND_OFF: f64 = 1e-13;

    fn sample() -> Inertia {
        let tensor = Mat3::new(0.5, 0.02, -0.03, 0.02, 0.6, 0.04, -0.03, 0.04, 0.7);
        Inertia::from_com(2.0, &Vec3::new(0.1, -0.2, 0.3), &tensor)
    }

    #[test]
    fn moving_the_frame_keeps_kinetic_energy() {
        let (rot, pos) = (rotation_about(&Vec3::new(0.6, 0.0, 0.8), 0.9), Vec3::new(1.0, -2.0, 0.5));
        let v = Twist::new(Vec3::new(0.3, 0.1, -0.4), Vec3::new(1.0, 0.2, 0.7));
        let v_parent = Twist::new(rot * v.ang, rot * v.lin).about(&-pos);
        let moved = sample().transformed(&rot, &pos);
        assert!((moved.kinetic_energy(&v_parent) - sample().kinetic_energy(&v)).abs() < ROUND_OFF);
    }

    #[test]
    fn twist_of_momentum_is_the_inverse() {
        let v = Twist::new(Vec3::new(0.3, 0.1, -0.4), Vec3::new(1.0, 0.2, 0.7));
        let back = sample().twist_of(&sample().momentum(&v)).expect("a rigid body has a twist for every momentum");
        assert!((back.ang - v.ang).norm() + (back.lin - v.lin).norm() < ROUND_OFF);
    }

    #[test]
    fn blocks_agree_with_ten_numbers() {
        let v = Twist::new(Vec3::new(0.3, 0.1, -0.4), Vec3::new(1.0, 0.2, 0.7));
        let (a, b) = (SpatialMatrix::from(&sample()).mul(&v), sample().momentum(&v));
        assert!((a.moment - b.moment).norm() + (a.force - b.force).norm() < ROUND_OFF);
    }

    /// G acts on the difference of two bodies' velocities at a point: its four blocks give the forces of both about their origins.
    #[test]
    fn stiffness_at_a_point_is_moved_to_two_origins() {
        let g = Mat3::new(3.0, 0.2, -0.1, 0.2, 2.0, 0.4, -0.1, 0.4, 5.0);
        let (r_a, r_b) = (Vec3::new(0.3, -0.7, 1.1), Vec3::new(-0.5, 0.2, 0.9));
        let v = Twist::new(Vec3::new(0.3, 0.1, -0.4), Vec3::new(1.0, 0.2, 0.7));
        let about = |left: &Vec3, right: &Vec3| Wrench::from_force_at(g * v.at(right), left);
        let bb = SpatialMatrix::from_point(&g, &r_b);
        let [ab, aa] = bb.about_first(&(r_a - r_b));
        for (matrix, wrench) in [(aa, about(&r_a, &r_a)), (ab, about(&r_a, &r_b)), (bb, about(&r_b, &r_b))] {
            let off = matrix.mul(&v) - wrench;
            assert!(off.moment.norm() + off.force.norm() < ROUND_OFF);
            let w = Twist::new(Vec3::new(-0.2, 0.6, 0.1), Vec3::new(0.5, -0.9, 0.3));
            assert!((w.dot(&matrix.mul(&v)) - v.dot(&matrix.tr_mul(&w))).abs() < ROUND_OFF);
        }
    }

    #[test]
    fn impossible_inertias_are_refused_and_a_thin_plate_is_not() {
        assert!(matches!(Inertia::check(-1.0, &Mat3::identity()), Err(InertiaError::Mass(_))));
        let flat = |z| Mat3::from_diagonal(&Vec3::new(0.1, 0.1, z));
        assert!(matches!(Inertia::check(1.0, &flat(0.31)), Err(InertiaError::Triangle(_))));
        assert!(matches!(Inertia::check(1.0, &flat(-0.1)), Err(InertiaError::NotPositive(_))));
        assert_eq!(Inertia::check(1.0, &flat(0.2)), Ok(()));
    }
}
