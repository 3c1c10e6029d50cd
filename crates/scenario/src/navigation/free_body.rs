//! Where a tumbling body will be: torque-free motion of a locked vehicle.
//!
//!   Ṙ = [ω] R,   ω = R I⁻¹ Rᵀ L,   L constant about the centre of mass, which moves uniformly.

use spatial::{Mat3, Pose, Rot, Twist, Vec3, exp_rotation};

/// What a body resists turning with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mass {
    /// Inertia about the centre of mass, body axes, kg·m².
    pub tensor_b: Mat3,
    /// Its inverse.
    pub inverse_b: Mat3,
    /// Centre of mass, body axes, m.
    pub com_b: Vec3,
}

impl Mass {
    /// From an inertia about the body's origin, body axes; none where it is singular.
    pub(crate) fn new(inertia_b: &spatial::Inertia) -> Option<Self> {
        let tensor_b = inertia_b.tensor_com();
        Some(Self { tensor_b, inverse_b: tensor_b.try_inverse()?, com_b: inertia_b.com() })
    }
}

/// A free rigid body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FreeBody {
    pub mass: Mass,
    /// Its axes in W.
    pub rot_wb: Rot,
    /// Centre of mass, m, and its velocity, m/s.
    pub com_w: Vec3,
    pub vel_w: Vec3,
    /// Angular momentum about it, N·m·s.
    pub momentum_w: Vec3,
}

/// Largest step of the prediction, s: at 5 deg/s its error over 30 s is far below a millimetre.
const STEP: f64 = 0.05;

impl FreeBody {
    /// From the body's pose, its twist about its origin (W axes), and its mass.
    pub(crate) fn new(pose_wb: &Pose, twist_w: &Twist, mass: Mass) -> Self {
        let arm = pose_wb.rotation * mass.com_b;
        let omega_b = pose_wb.rotation.inverse() * twist_w.ang;
        Self {
            mass,
            rot_wb: pose_wb.rotation,
            com_w: pose_wb.translation.vector + arm,
            vel_w: twist_w.at(&arm),
            momentum_w: pose_wb.rotation * (mass.tensor_b * omega_b),
        }
    }

    /// Angular velocity, W axes, rad/s.
    pub(crate) fn spin(&self) -> Vec3 {
        self.omega(&self.rot_wb)
    }

    fn omega(&self, rot: &Rot) -> Vec3 {
        rot * (self.mass.inverse_b * (rot.inverse() * self.momentum_w))
    }

    /// Moves on by `time`, s.
    pub(crate) fn advance(&mut self, time: f64) {
        let steps = (time / STEP).ceil().max(1.0);
        let h = time / steps;
        for _ in 0..steps as usize {
            let half = exp_rotation(&(0.5 * h * self.omega(&self.rot_wb))) * self.rot_wb;
            self.rot_wb = exp_rotation(&(h * self.omega(&half))) * self.rot_wb;
        }
        self.com_w += time * self.vel_w;
    }

    /// Present pose of the body.
    pub(crate) fn pose(&self) -> Pose {
        Pose::from_parts((self.com_w - self.rot_wb * self.mass.com_b).into(), self.rot_wb)
    }

    /// Present twist about a point fixed in the body (W), W axes.
    pub(crate) fn twist_at(&self, point_w: &Vec3) -> Twist {
        let ang = self.omega(&self.rot_wb);
        Twist::new(ang, self.vel_w + ang.cross(&(point_w - self.com_w)))
    }
}
