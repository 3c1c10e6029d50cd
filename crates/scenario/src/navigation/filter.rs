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
        turned(&self.body.rot_wb, &self.body.mass.inverse_b)
    }
}

/// A tensor of the body in W axes.
fn turned(rot_wb: &Rot, tensor_b: &Mat3) -> Mat3 {
    let rot = rot_wb.to_rotation_matrix();
    rot.matrix() * tensor_b * rot.matrix().transpose()
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
        turned(rot_wb, &self.mass.tensor_b)
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

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use spatial::Twist;

    const SIGMA: [f64; 2] = [0.01, 0.0087];
    const PERIOD: f64 = 0.1;

    fn filter() -> TargetFilter {
        let tensor_b = Mat3::new(60.0, 4.0, -3.0, 4.0, 90.0, 5.0, -3.0, 5.0, 110.0);
        let inverse_b = tensor_b.try_inverse().unwrap_or_default();
        let mass = Mass { tensor_b, inverse_b, com_b: Vec3::new(0.05, -0.02, 0.1) };
        let pose_bs = Pose::from_parts(Vec3::new(0.3, 0.2, -0.4).into(), exp_rotation(&Vec3::new(0.3, -1.0, 0.4)));
        TargetFilter { mass, pose_bs, sigma: SIGMA, walk: [0.0, 0.0] }
    }

    fn normal(random: &mut ChaCha8Rng) -> Vec3 {
        Vec3::from_fn(|_, _| StandardNormal.sample(random))
    }

    /// A tumbling body, its rates drawn from what the filter takes for granted before the first pose, times `share`.
    fn tumbling(mass: Mass, random: &mut ChaCha8Rng, share: f64) -> FreeBody {
        let pose = Pose::from_parts(normal(random).into(), exp_rotation(&normal(random)));
        let twist = Twist::new(share * PRIOR[1] * normal(random), share * PRIOR[0] * normal(random));
        let body = FreeBody::new(&pose, &twist, mass);
        FreeBody { vel_w: share * PRIOR[0] * normal(random), ..body }
    }

    fn seen(filter: &TargetFilter, body: &FreeBody, noise: f64, random: &mut ChaCha8Rng) -> Pose {
        let pose = body.pose() * filter.pose_bs;
        let shift = pose.translation.vector + noise * SIGMA[0] * normal(random);
        Pose::from_parts(shift.into(), pose.rotation * exp_rotation(&(noise * SIGMA[1] * normal(random))))
    }

    /// The error of an estimate, in the coordinates of its covariance.
    fn error(estimate: &Estimate, truth: &FreeBody) -> nalgebra::SVector<f64, 12> {
        let body = &estimate.body;
        let turn = log_rotation(&(truth.rot_wb * body.rot_wb.inverse()));
        let parts = [truth.com_w - body.com_w, truth.vel_w - body.vel_w, turn, truth.momentum_w - body.momentum_w];
        nalgebra::SVector::from_fn(|i, _| parts[i / 3][i % 3])
    }

    #[test]
    fn errors_are_as_large_as_the_covariance_says() {
        // The normalised square of twelve numbers has mean 12 and variance 24 (Bar-Shalom, Li and Kirubarajan 2001, section 5.4): over 200 runs the mean of
        // the mean is within 12 ± 3.3 √(24/200) but once in a thousand.
        let filter = filter();
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let runs = 200;
        let (mut squares, mut refused) = ([0.0; 2], 0);
        for _ in 0..runs {
            let mut truth = tumbling(filter.mass, &mut random, 0.3);
            let mut estimate = filter.begin(0.0, &seen(&filter, &truth, 1.0, &mut random));
            for k in 1..=60 {
                truth.advance(PERIOD);
                filter.take(&mut estimate, f64::from(k) * PERIOD, &seen(&filter, &truth, 1.0, &mut random));
                refused += i32::from(estimate.refused > 0.0);
                let at = [20, 60].iter().position(|instant| *instant == k);
                if let (Some(at), Some(inverse)) = (at, estimate.cov.try_inverse()) {
                    let off = error(&estimate, &truth);
                    squares[at] += (off.transpose() * inverse * off)[0] / f64::from(runs);
                }
            }
        }
        // One in ten thousand of 12,000: the chance of more than six is 0.1 %.
        assert!(refused <= 6, "{refused} poses were refused");
        for square in squares {
            assert!((square - 12.0).abs() < 3.3 * (24.0 / f64::from(runs)).sqrt(), "{square} for 12");
        }
    }

    #[test]
    fn of_a_walking_rate_too() {
        let filter = TargetFilter { walk: [2e-3, 2e-3], ..filter() };
        let mut random = ChaCha8Rng::seed_from_u64(12);
        let (runs, grain) = (200, 10);
        let mut square = 0.0;
        for _ in 0..runs {
            let mut truth = tumbling(filter.mass, &mut random, 0.2);
            let mut estimate = filter.begin(0.0, &seen(&filter, &truth, 1.0, &mut random));
            for k in 1..=60 {
                for _ in 0..grain {
                    let h = PERIOD / f64::from(grain);
                    truth.advance(h);
                    truth.vel_w += filter.walk[0] * h.sqrt() * normal(&mut random);
                    let inertia = filter.calc_inertia(&truth.rot_wb);
                    truth.momentum_w += inertia * (filter.walk[1] * h.sqrt() * normal(&mut random));
                }
                filter.take(&mut estimate, f64::from(k) * PERIOD, &seen(&filter, &truth, 1.0, &mut random));
            }
            let off = error(&estimate, &truth);
            square += estimate.cov.try_inverse().map_or(f64::NAN, |inverse| (off.transpose() * inverse * off)[0]);
        }
        let mean = square / f64::from(runs);
        assert!((mean - 12.0).abs() < 3.3 * (24.0 / f64::from(runs)).sqrt(), "{mean} for 12");
    }

    #[test]
    fn a_late_pose_is_no_error_of_the_present() {
        // Poses without noise: the body is known to what the steps of its turn are worth, 0.1 s after the last pose as at it.
        let filter = filter();
        let mut random = ChaCha8Rng::seed_from_u64(13);
        let mut truth = tumbling(filter.mass, &mut random, 0.3);
        let mut estimate = filter.begin(0.0, &seen(&filter, &truth, 0.0, &mut random));
        for k in 1..=100 {
            truth.advance(PERIOD);
            filter.take(&mut estimate, f64::from(k) * PERIOD, &seen(&filter, &truth, 0.0, &mut random));
        }
        truth.advance(0.1);
        let (told, is) = (estimate.at(estimate.time + 0.1).pose(), truth.pose());
        assert!((told.translation.vector - is.translation.vector).norm() < 1e-4);
        assert!(told.rotation.angle_to(&is.rotation) < 1e-4);
    }

    #[test]
    fn a_pose_that_cannot_be_is_refused_and_a_target_that_was_pushed_found_again() {
        let filter = filter();
        let mut random = ChaCha8Rng::seed_from_u64(24);
        let mut truth = tumbling(filter.mass, &mut random, 0.1);
        let mut estimate = filter.begin(0.0, &seen(&filter, &truth, 1.0, &mut random));
        for k in 1..=100 {
            truth.advance(PERIOD);
            let mut pose = seen(&filter, &truth, 1.0, &mut random);
            if k == 70 {
                pose.translation.vector.x += 0.3;
            }
            let before = estimate.refused;
            filter.take(&mut estimate, f64::from(k) * PERIOD, &pose);
            assert_eq!(estimate.refused > before, k == 70, "pose {k}");
        }
        truth.vel_w += Vec3::new(0.2, 0.0, 0.0);
        for k in 101..=200 {
            truth.advance(PERIOD);
            filter.take(&mut estimate, f64::from(k) * PERIOD, &seen(&filter, &truth, 1.0, &mut random));
        }
        assert!((estimate.body.vel_w - truth.vel_w).norm() < 0.01);
    }

    #[test]
    fn a_memory_holds_it_to_the_bit() {
        let filter = filter();
        let mut random = ChaCha8Rng::seed_from_u64(15);
        let truth = tumbling(filter.mass, &mut random, 0.3);
        let estimate = filter.begin(0.5, &seen(&filter, &truth, 1.0, &mut random));
        let mut memory = vec![0.0; ESTIMATE];
        estimate.write(&mut memory);
        let mut again = vec![0.0; ESTIMATE];
        Estimate::read(filter.mass, &memory).write(&mut again);
        assert_eq!(memory, again);
    }
}
