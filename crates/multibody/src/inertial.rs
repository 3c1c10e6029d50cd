//! What a link weighs, without the part of it that moves by itself.
//!
//! A file's mass and inertia hold everything aboard, locked. Where a scenario lets a part move (sloshing propellant, a
//! flexible boom, a nutation damper), the part is taken out of the link here and lives on its own; locked, the two
//! together are the file's link again. Each of these leaves a part of nothing without changing a bit.

use crate::Inertial;
use spatial::{InertiaError, Mat3, Vec3};

impl Inertial {
    /// Without a point mass (kg) at `point` (link frame, m).
    ///
    ///   c' = c − (m/M') d,   I' = I − (m M/M') (d² 1 − d dᵀ),   M' = M − m,   d = point − c
    pub fn without_point(&self, mass: f64, point: &Vec3) -> Result<Self, InertiaError> {
        let left = self.mass - mass;
        if !mass.is_finite() || point.iter().any(|x| !x.is_finite()) {
            return Err(InertiaError::NotFinite);
        }
        if left <= 0.0 {
            return Err(InertiaError::Mass(left));
        }
        let d = point - self.com;
        let spread = Mat3::from_diagonal_element(d.norm_squared()) - d * d.transpose();
        let tensor_com = self.tensor_com - spread * (mass * self.mass / left);
        Self { mass: left, com: self.com - d * (mass / left), tensor_com }.definite()
    }

    /// Without the part δ δᵀ of its inertia that a flexible mode of coupling δ (link axes, √kg·m) takes with it.
    pub fn without_mode(&self, coupling: &Vec3) -> Result<Self, InertiaError> {
        Self { tensor_com: self.tensor_com - coupling * coupling.transpose(), ..*self }.definite()
    }

    /// Without an inner sphere of the inertia `inertia`, kg·m².
    pub fn without_sphere(&self, inertia: f64) -> Result<Self, InertiaError> {
        Self { tensor_com: self.tensor_com - Mat3::from_diagonal_element(inertia), ..*self }.definite()
    }

    /// Itself, where its tensor is positive definite. The triangle inequality is not asked for: what a mode leaves
    /// behind is no rigid body's tensor, and still moves as one.
    fn definite(self) -> Result<Self, InertiaError> {
        if self.tensor_com.iter().any(|x| !x.is_finite()) {
            return Err(InertiaError::NotFinite);
        }
        let mut moments: [f64; 3] = self.tensor_com.symmetric_eigenvalues().into();
        moments.sort_by(f64::total_cmp);
        if moments[0] <= 0.0 { Err(InertiaError::NotPositive(moments)) } else { Ok(self) }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use spatial::Inertia;

    fn link() -> Inertial {
        let tensor_com = Mat3::new(95.0, 1.1, -1.8, 1.1, 160.0, 0.7, -1.8, 0.7, 215.0);
        Inertial { mass: 450.0, com: Vec3::new(0.1, -0.2, 0.3), tensor_com }
    }

    fn inertia(i: &Inertial) -> Inertia {
        Inertia::from_com(i.mass, &i.com, &i.tensor_com)
    }

    #[test]
    fn what_is_left_and_the_point_are_the_link_again() {
        let (mass, point) = (14.0, Vec3::new(0.35, -0.05, 0.75));
        let left = link().without_point(mass, &point).unwrap();
        let sum = inertia(&left) + Inertia::from_com(mass, &point, &Mat3::zeros());
        let whole = inertia(&link());
        // Round-off of entries near 300.
        assert!((sum.rot - whole.rot).norm() < 1e-12 && (sum.mc - whole.mc).norm() < 1e-13 && sum.mass == whole.mass);
    }

    #[test]
    fn a_part_of_nothing_changes_no_bit() {
        assert_eq!(link().without_point(0.0, &Vec3::new(0.35, -0.05, 0.75)), Ok(link()));
        assert_eq!(link().without_mode(&Vec3::zeros()), Ok(link()));
        assert_eq!(link().without_sphere(0.0), Ok(link()));
    }

    #[test]
    fn more_than_the_link_has_is_refused() {
        assert_eq!(link().without_point(450.0, &Vec3::x()), Err(InertiaError::Mass(0.0)));
        assert!(matches!(link().without_point(200.0, &Vec3::new(2.0, 0.0, 0.0)), Err(InertiaError::NotPositive(_))));
        assert!(matches!(link().without_mode(&Vec3::new(10.0, 0.0, 0.0)), Err(InertiaError::NotPositive(_))));
        assert!(matches!(link().without_sphere(95.0), Err(InertiaError::NotPositive(_))));
        assert_eq!(link().without_point(f64::NAN, &Vec3::x()), Err(InertiaError::NotFinite));
    }
}
