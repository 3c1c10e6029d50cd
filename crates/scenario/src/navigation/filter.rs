//! Pose and rates of a tumbling target from poses that a camera gives: an extended Kalman filter with a multiplicative error of attitude (Markley and
//! Crassidis 2014, section 6.2), about a free rigid body.
//!
//!   x = (r, v, R, L)     centre of mass, its velocity, attitude, angular momentum about it; all in W
//!   ṙ = v,   v̇ = s_v w,   Ṙ = [ω] R,   L̇ = s_ω J w′,     J = R J_b Rᵀ,   ω = J⁻¹ L,     w, w′: white, of unit density
//!
//! L rather than ω: between two poses the mean is exact but for the turn's steps, and momentum is kept. With δR = exp(δθ) R
//!
//!   δθ̇ = J⁻¹ ([L]× δθ + δL)
//!
//! A pose (p, Q) of a frame that stands at c in the body, seen at its stamp, is
//!
//!   p = r + R c + σ_p n,   Q = exp(σ_θ n′) R R_c     ⇒     H = [1 0 −[R c]× 0; 0 0 1 0]
//!
//! The estimate stands at the stamp of the last pose; [`Estimate::at`] takes it to the present. So delay costs accuracy, and is no error.

use super::free_body::{FreeBody, Mass};
use spatial::{Mat3, Pose, Rot, Vec3, exp_rotation, log_rotation, nalgebra, skew};

type Cov = nalgebra::SMatrix<f64, 12, 12>;
type Seen = nalgebra::SMatrix<f64, 6, 12>;
type Vec6 = nalgebra::Vector6<f64>;

/// What is known before the first pose: standard deviations of the velocity, m/s, and of the angular velocity, rad/s.
const PRIOR: [f64; 2] = [0.3, 0.3];
/// χ² of six numbers that one pose in ten thousand exceeds: beyond it a pose is refused.
const GATE: f64 = 27.856;
/// So many refusals in a row mean that not the poses are wrong: it begins again.
const PATIENCE: f64 = 10.0;
/// Longest step of the covariance, s.
const STEP: f64 = 0.1;

/// What the filter knows from the start.
#[derive(Clone, Debug)]
pub(super) struct TargetFilter {
    pub mass: Mass,
    /// The frame that is seen, in the body.
    pub pose_bs: Pose,
    /// Standard deviations of a pose: position on each axis, m; attitude about each, rad.
    pub sigma: [f64; 2],
    /// How far velocity, m/s per √s, and angular velocity, rad/s per √s, may wander.
    pub walk: [f64; 2],
}

/// What the filter knows now.
#[derive(Clone, Debug)]
pub(super) struct Estimate {
    /// The instant it is of, s.
    pub time: f64,
    /// Poses refused since the last that was not.
    refused: f64,
    pub body: FreeBody,
    /// Covariance of (δr, δv, δθ, δL).
    pub cov: Cov,
}

/// Numbers that an estimate is remembered by.
pub(super) const ESTIMATE: usize = 2 + 13 + 144;

impl Estimate {
    /// From a memory that [`Self::write`] wrote.
    pub(super) fn read(mass: Mass, memory: &[f64]) -> Self {
        let vector = |at: usize| Vec3::from_column_slice(&memory[at..at + 3]);
        let quaternion = nalgebra::Quaternion::new(memory[11], memory[8], memory[9], memory[10]);
        Self {
            time: memory[0],
            refused: memory[1],
            body: FreeBody {
                mass,
                com_w: vector(2),
                vel_w: vector(5),
                rot_wb: Rot::new_unchecked(quaternion),
                momentum_w: vector(12),
            },
            cov: Cov::from_column_slice(&memory[15..ESTIMATE]),
        }
    }

    /// Into a memory of [`ESTIMATE`] numbers.
    pub(super) fn write(&self, memory: &mut [f64]) {
        (memory[0], memory[1]) = (self.time, self.refused);
        memory[2..5].copy_from_slice(self.body.com_w.as_slice());
        memory[5..8].copy_from_slice(self.body.vel_w.as_slice());
        memory[8..12].copy_from_slice(self.body.rot_wb.coords.as_slice());
        memory[12..15].copy_from_slice(self.body.momentum_w.as_slice());
        memory[15..ESTIMATE].copy_from_slice(self.cov.as_slice());
    }

    /// The body at another instant.
    pub(super) fn at(&self, time: f64) -> FreeBody {
        let mut body = self.body;
        if time > self.time {
            body.advance(time - self.time);
        }
        body
    }

    /// Standard deviation of the angular velocity about an axis, root mean square over the three, rad/s.
    pub(super) fn calc_rate_sigma(&self) -> f64 {
        let inverse = self.calc_inverse_inertia();
        let spin = inverse * self.body.momentum_w;
        let by_turn = inverse * skew(&self.body.momentum_w) - skew(&spin);
        let mut map = nalgebra::SMatrix::<f64, 3, 12>::zeros();
        map.fixed_view_mut::<3, 3>(0, 6).copy_from(&by_turn);
        map.fixed_view_mut::<3, 3>(0, 9).copy_from(&inverse);
        ((map * self.cov * map.transpose()).trace() / 3.0).sqrt()
    }

    /// J⁻¹, W axes.
    fn calc_inverse_inertia(&self) -> Mat3 {
        let rot = self.body.rot_wb.to_rotation_matrix();
        rot.matrix() * self.body.mass.inverse_b * rot.matrix().transpose()
    }
}

impl TargetFilter {
    /// From a first pose, W.
    pub(super) fn begin(&self, time: f64, seen: &Pose) -> Estimate {
        let rot_wb = seen.rotation * self.pose_bs.rotation.inverse();
        let arm = rot_wb * (self.pose_bs.translation.vector - self.mass.com_b);
        let body = FreeBody {
            mass: self.mass,
            rot_wb,
            com_w: seen.translation.vector - arm,
            vel_w: Vec3::zeros(),
            momentum_w: Vec3::zeros(),
        };
        let [position, turn] = self.sigma.map(|s| s * s);
        let (lever, mut cov) = (skew(&arm), Cov::zeros());
        let inertia = self.calc_inertia(&rot_wb);
        let mut set = |i: usize, j: usize, block: Mat3| cov.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&block);
        set(0, 0, Mat3::identity() * position + lever * lever.transpose() * turn);
        set(0, 2, lever * turn);
        set(2, 0, lever.transpose() * turn);
        set(1, 1, Mat3::identity() * PRIOR[0].powi(2));
        set(2, 2, Mat3::identity() * turn);
        set(3, 3, inertia * inertia * PRIOR[1].powi(2));
        Estimate { time, refused: 0.0, body, cov }
    }

    /// J, W axes.
    fn calc_inertia(&self, rot_wb: &Rot) -> Mat3 {
        let rot = rot_wb.to_rotation_matrix();
        rot.matrix() * self.mass.tensor_b * rot.matrix().transpose()
    }

    /// Takes the estimate to the stamp of a pose, W, and takes the pose in. One that cannot be is refused.
    pub(super) fn take(&self, estimate: &mut Estimate, time: f64, seen: &Pose) {
        let steps = ((time - estimate.time) / STEP).ceil().max(1.0);
        let h = (time - estimate.time) / steps;
        for _ in 0..steps as usize {
            self.advance(estimate, h);
        }
        estimate.time = time;
        self.correct(estimate, seen);
        if estimate.refused >= PATIENCE {
            *estimate = self.begin(time, seen);
        }
    }

    fn advance(&self, estimate: &mut Estimate, h: f64) {
        let before = estimate.body;
        estimate.body.advance(0.5 * h);
        let inverse = estimate.calc_inverse_inertia();
        let inertia = self.calc_inertia(&estimate.body.rot_wb);
        estimate.body = before;
        estimate.body.advance(h);
        let mut rate = Cov::zeros();
        let mut set = |i: usize, j: usize, block: Mat3| rate.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&block);
        set(0, 1, Mat3::identity());
        set(2, 2, inverse * skew(&before.momentum_w));
        set(2, 3, inverse);
        let step = Cov::identity() + rate * h + rate * rate * (0.5 * h * h);
        estimate.cov = step * estimate.cov * step.transpose() + self.calc_wander(&inertia, h);
    }

    /// What a step adds to the covariance: an integral of white noise, and the integral of that.
    fn calc_wander(&self, inertia: &Mat3, h: f64) -> Cov {
        let [speed, rate] = self.walk.map(|s| s * s);
        let unit = Mat3::identity();
        let mut noise = Cov::zeros();
        let mut set = |i: usize, j: usize, block: Mat3| noise.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&block);
        set(0, 0, unit * (speed * h.powi(3) / 3.0));
        set(0, 1, unit * (speed * h * h / 2.0));
        set(1, 0, unit * (speed * h * h / 2.0));
        set(1, 1, unit * (speed * h));
        set(2, 2, unit * (rate * h.powi(3) / 3.0));
        set(2, 3, inertia * (rate * h * h / 2.0));
        set(3, 2, inertia * (rate * h * h / 2.0));
        set(3, 3, inertia * inertia * (rate * h));
        noise
    }

    fn correct(&self, estimate: &mut Estimate, seen: &Pose) {
        let body = &estimate.body;
        let arm = body.rot_wb * (self.pose_bs.translation.vector - self.mass.com_b);
        let off = seen.translation.vector - (body.com_w + arm);
        let turned = log_rotation(&(seen.rotation * (body.rot_wb * self.pose_bs.rotation).inverse()));
        let surprise = Vec6::new(off.x, off.y, off.z, turned.x, turned.y, turned.z);
        let mut sight = Seen::zeros();
        sight.fixed_view_mut::<3, 3>(0, 0).copy_from(&Mat3::identity());
        sight.fixed_view_mut::<3, 3>(0, 6).copy_from(&-skew(&arm));
        sight.fixed_view_mut::<3, 3>(3, 6).copy_from(&Mat3::identity());
        let [p, t] = self.sigma.map(|s| s * s);
        let noise = nalgebra::Matrix6::from_diagonal(&Vec6::new(p, p, p, t, t, t));
        let Some(inverse) = (sight * estimate.cov * sight.transpose() + noise).try_inverse() else { return };
        if (surprise.transpose() * inverse * surprise)[0] > GATE {
            estimate.refused += 1.0;
            return;
        }
        estimate.refused = 0.0;
        let gain = estimate.cov * sight.transpose() * inverse;
        let change = gain * surprise;
        let part = |at: usize| Vec3::new(change[at], change[at + 1], change[at + 2]);
        let body = &mut estimate.body;
        body.com_w += part(0);
        body.vel_w += part(3);
        body.rot_wb = exp_rotation(&part(6)) * body.rot_wb;
        body.rot_wb.renormalize();
        body.momentum_w += part(9);
        // Joseph's form: symmetric and positive whatever is rounded.
        let left = Cov::identity() - gain * sight;
        estimate.cov = left * estimate.cov * left.transpose() + gain * noise * gain.transpose();
    }
}
