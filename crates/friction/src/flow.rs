//! The bristle's motion through a time in which slip velocity and normal force change: for integrators that take rates.
//!
//! A bristle on its bound turns towards the slip velocity u. With φ the angle between them and ρ = |s|,
//!
//!   φ̇ = −(|u|/ρ) sin φ      so that      tan(φ/2) falls as exp(−|u| t/ρ),
//!
//! at a rate that has no bound where the normal force goes to zero. An explicit method would want steps below 2 ρ/|u| there;
//! this one is exact for constant u and ρ, and takes the changes of both in short pieces.
//!
//! Within a piece: the deflection is cut to what the normal force at the piece's end holds; it sticks, s + u t, until it
//! meets the bound; from there it turns. A level that changes with speed or rest is that at the piece's middle.

use crate::bristle::Bristle;
use crate::ellipse::Ellipse;
use nalgebra::Vector3;

/// Slip velocity (m/s, in the tangent plane) and normal force (N) at the start, the middle and the end of a time; quadratic
/// in between.
#[derive(Clone, Copy, Debug)]
pub struct SlipPath {
    /// B relative to A.
    pub slip: [Vector3<f64>; 3],
    /// Compression.
    pub normal_force: [f64; 3],
    /// s.
    pub elapsed: f64,
}

impl SlipPath {
    /// Straight between two ends.
    pub fn between(start: (Vector3<f64>, f64), end: (Vector3<f64>, f64), elapsed: f64) -> Self {
        let middle = (0.5 * (start.0 + end.0), 0.5 * (start.1 + end.1));
        Self { slip: [start.0, middle.0, end.0], normal_force: [start.1, middle.1, end.1], elapsed }
    }

    fn slip_at(&self, x: f64) -> Vector3<f64> {
        let [a, b, c] = weights(x);
        self.slip[0] * a + self.slip[1] * b + self.slip[2] * c
    }

    fn normal_force_at(&self, x: f64) -> f64 {
        let [a, b, c] = weights(x);
        (self.normal_force[0] * a + self.normal_force[1] * b + self.normal_force[2] * c).max(0.0)
    }

    /// What slips until half and until all of the time is over, m: Simpson's rule and its half.
    fn calc_slipped(&self) -> [Vector3<f64>; 2] {
        let [a, b, c] = self.slip;
        [(5.0 * a + 8.0 * b - c) * (self.elapsed / 24.0), (a + 4.0 * b + c) * (self.elapsed / 6.0)]
    }
}

/// Weights of start, middle and end at the share `x` of the time.
fn weights(x: f64) -> [f64; 3] {
    [(1.0 - x) * (1.0 - 2.0 * x), 4.0 * x * (1.0 - x), x * (2.0 * x - 1.0)]
}

/// Pieces of a time at least and at most, and the turn towards the slip, |u| t/ρ, that one of them may cover.
const PIECES: (f64, f64) = (4.0, 12.0);
const TURN: f64 = 0.25;

impl Bristle {
    /// Where the deflection is if it sticks through all of the path; `None` where it slides, or a changing level may let it.
    pub fn stick(&self, s: &Vector3<f64>, grain: &Vector3<f64>, path: &SlipPath) -> Option<Vector3<f64>> {
        if !self.levels().is_constant() {
            return None;
        }
        let holds =
            |s: &Vector3<f64>, normal_force: f64| self.ellipse(self.mu_static, normal_force, grain).hold(s).inside;
        let [half, all] = path.calc_slipped();
        let [start, middle, end] = path.normal_force;
        let sticks = start > 0.0 && holds(s, start) && holds(&(s + half), middle) && holds(&(s + all), end);
        sticks.then(|| s + all)
    }

    /// Deflection (m) and rest at the end of a path, from those at its start.
    pub fn flow(&self, s: &Vector3<f64>, rest: f64, grain: &Vector3<f64>, path: &SlipPath) -> (Vector3<f64>, f64) {
        let levels = self.levels();
        if path.normal_force[2] <= 0.0 {
            return (Vector3::zeros(), levels.initial_rest());
        }
        let reach = self.calc_reach(path.normal_force[2], rest).max(f64::MIN_POSITIVE);
        let turn = path.elapsed * path.slip[2].norm() / reach;
        let pieces = (turn / TURN).ceil().clamp(PIECES.0, PIECES.1);
        let (mut s, mut rest, dt) = (*s, rest, path.elapsed / pieces);
        for i in 0..pieces as usize {
            let slip = path.slip_at((i as f64 + 0.5) / pieces);
            let normal_force = path.normal_force_at((i as f64 + 1.0) / pieces);
            let speed = if levels.is_constant() { 0.0 } else { slip.norm() };
            rest = levels.calc_rest(rest, speed, dt);
            let mut bound = self.ellipse(levels.at(rest), normal_force, grain);
            let sticks = bound.hold(&(s + slip * dt)).inside;
            rest = levels.settle(rest, sticks, dt);
            if !sticks && levels.stribeck_speed == 0.0 {
                bound = self.ellipse(levels.kinetic, normal_force, grain);
            }
            // It turns at the pace of the bound at the piece's middle, on that of its end.
            let pace = path.normal_force_at((i as f64 + 0.5) / pieces) / normal_force;
            s = bound.advance(&s, &slip, dt, pace);
        }
        (s, rest)
    }
}

impl Ellipse {
    /// A deflection after `dt` of constant slip: it sticks until it meets the bound, and turns from there as if the bound
    /// were `pace` times as wide.
    fn advance(&self, s: &Vector3<f64>, slip: &Vector3<f64>, dt: f64, pace: f64) -> Vector3<f64> {
        let held = self.hold(&(s + slip * dt));
        if held.inside {
            return held.s;
        }
        let s = self.hold(s).s;
        let free = s + slip * dt;
        // It comes back more slowly than the bound that closes behind it.
        if self.hold(&free).inside {
            return held.s;
        }
        let stuck = self.calc_share_inside(&s, &(free - s));
        let met = s + (free - s) * stuck;
        let turned = turned(&met, slip, (1.0 - stuck) * dt / pace);
        // Where an ellipse is wider in the new direction the slip, which is far faster, has filled it.
        if self.is_round() { self.hold(&turned).s } else { self.on_bound(&turned) }
    }

    /// The share of the way from a deflection inside to one outside at which it meets the bound.
    fn calc_share_inside(&self, s: &Vector3<f64>, way: &Vector3<f64>) -> f64 {
        let scaled = |v: &Vector3<f64>| {
            if self.is_round() {
                return v / self.along;
            }
            let along = v.dot(&self.grain);
            self.grain * (along / self.along) + (v - self.grain * along) / self.across
        };
        let (p, d) = (scaled(s), scaled(way));
        let (a, b, c) = (d.norm_squared(), p.dot(&d), p.norm_squared() - 1.0);
        let root = (b * b - a * c).max(0.0).sqrt();
        // The larger root of a x² + 2 b x + c = 0, without cancellation.
        let share = if b > 0.0 { -c / (b + root) } else { (root - b) / a };
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
    }
}

/// A deflection on its bound, turned towards the slip for a time.
fn turned(s: &Vector3<f64>, slip: &Vector3<f64>, time: f64) -> Vector3<f64> {
    let (length, speed) = (s.norm(), slip.norm());
    if length == 0.0 || speed == 0.0 {
        return *s;
    }
    let way = slip / speed;
    let along = s.dot(&way);
    let aside = s - way * along;
    let width = aside.norm();
    let tan_half = width / (length + along) * (-speed * time / length).exp();
    if width == 0.0 || !tan_half.is_finite() {
        return *s;
    }
    let scale = length / (1.0 + tan_half * tan_half);
    way * ((1.0 - tan_half * tan_half) * scale) + aside * (2.0 * tan_half * scale / width)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Bristle = Bristle {
        mu_static: 0.2,
        mu_kinetic: 0.2,
        stribeck_speed: 1e-3,
        dwell_time: 0.0,
        fall_time: 0.0,
        across: 1.0,
        stiffness: 1e5,
        damping: 0.0,
        viscous: 0.0,
    };

    /// By a thousand times as many Euler steps, held to the bound after each.
    fn by_small_steps(law: &Bristle, s: Vector3<f64>, path: &SlipPath) -> Vector3<f64> {
        let n = 400_000;
        (0..n).fold(s, |s, i| {
            let x = (f64::from(i) + 0.5) / f64::from(n);
            let bound = law.ellipse(law.mu_static, path.normal_force_at(x), &Vector3::x());
            bound.hold(&(s + path.slip_at(x) * (path.elapsed / f64::from(n)))).s
        })
    }

    #[test]
    fn it_is_the_limit_of_small_steps_on_a_circle_and_on_an_ellipse() {
        // 20 N: 40 µm; 10 mm/s for 4 ms is one of them. Slip and normal force change by half.
        let slip = [Vector3::new(0.01, 0.0, 0.0), Vector3::new(0.008, 0.004, 0.0), Vector3::new(0.005, 0.009, 0.0)];
        for across in [1.0, 0.8] {
            let law = Bristle { across, ..LAW };
            for normal_force in [[20.0, 25.0, 30.0], [20.0, 12.0, 8.0]] {
                for s in [Vector3::zeros(), Vector3::new(-3e-5, 1e-5, 0.0), Vector3::new(0.0, -3e-5, 0.0)] {
                    let path = SlipPath { slip, normal_force, elapsed: 4e-3 };
                    let error = (law.flow(&s, 0.0, &Vector3::x(), &path).0 - by_small_steps(&law, s, &path)).norm();
                    // Pieces of a quarter turn, middle rule: a hundredth of the bound at 8 N.
                    assert!(error < 2.5e-7, "{across} {normal_force:?} {s} {error}");
                }
            }
        }
    }

    /// Where the bound widens with the direction a bristle that slides fills it: left inside, it would count as stuck, and its damper
    /// would see all of the slip.
    #[test]
    fn on_an_ellipse_it_stays_on_the_bound_as_this_widens() {
        let law = Bristle { across: 0.8, damping: 40.0, ..LAW };
        let across = Vector3::y() * (0.8 * law.calc_reach(20.0, 0.0));
        let slip = [0.02, 0.1, 0.18].map(|angle: f64| 0.02 * Vector3::new(angle.sin(), angle.cos(), 0.0));
        let path = SlipPath { slip, normal_force: [20.0; 3], elapsed: 4e-3 };
        let (s, _) = law.flow(&across, 0.0, &Vector3::x(), &path);
        assert!(s.norm() > 1.001 * across.norm(), "it has turned towards the wider axis: {s}");
        let trial =
            crate::Trial { s, slip: slip[2], normal_force: 20.0, grain: Vector3::x(), ..crate::Trial::default() };
        let rate = law.eval_rate(&trial);
        assert!(!rate.sticks);
        // The damper sees the turn alone, c ω ρ = 40 · 40 · 32e-6 N: far below what the slip would give, c u = 0.8 N.
        let turn = rate.force + s * law.stiffness;
        assert!((turn.norm() - 0.051).abs() < 0.005, "{turn}");
    }

    /// A bound that closes takes along what comes back more slowly; what comes back faster leaves it at once. Cut first and moved then, a
    /// bristle would end inside by what it slips in a piece: an error of first order, which a chain of bounces makes ten thousand times as large.
    #[test]
    fn behind_a_closing_bound_it_lies_on_it_or_leaves_it() {
        let start = Vector3::x() * LAW.calc_reach(20.0, 0.0);
        for (speed, expected) in [(1e-3, LAW.calc_reach(16.0, 0.0)), (20e-3, start.x - 20e-6)] {
            let slip = Vector3::x() * -speed;
            let path = SlipPath::between((slip, 20.0), (slip, 16.0), 1e-3);
            let (s, _) = LAW.flow(&start, 0.0, &Vector3::x(), &path);
            assert!((s.x - expected).abs() < 1e-18, "{} {expected}", s.x);
        }
    }

    /// Explicit methods lose their hold where the normal force goes: there the bristle lies along the slip at its bound.
    #[test]
    fn however_small_the_bound_it_lies_along_the_slip() {
        let path = SlipPath::between((Vector3::new(0.1, 0.0, 0.0), 5.0), (Vector3::new(0.1, 0.001, 0.0), 1e-3), 1e-3);
        let (s, _) = LAW.flow(&Vector3::new(0.0, 1e-5, 0.0), 0.0, &Vector3::zeros(), &path);
        assert!((s.norm() - 0.2 * 1e-3 / 1e5).abs() < 1e-20);
        assert!(s.normalize().cross(&Vector3::x()).norm() < 0.01);
    }

    #[test]
    fn sticking_it_is_the_slip_exactly() {
        let slip = [Vector3::x() * 1e-3, Vector3::x() * 2e-3, Vector3::x() * -1e-3];
        let path = SlipPath { slip, normal_force: [100.0; 3], elapsed: 6e-3 };
        let stuck = LAW.stick(&Vector3::zeros(), &Vector3::zeros(), &path).expect("far inside");
        assert!((stuck.x - 8e-6).abs() < 1e-20);
        assert!(
            LAW.stick(&Vector3::zeros(), &Vector3::zeros(), &SlipPath { normal_force: [1.0; 3], ..path }).is_none()
        );
    }
}
