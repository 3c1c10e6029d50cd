//! Spring-damper strut between two anchor points, with preload, stroke and end stops.
//!
//! Tension (positive pulls the anchors together) at the length l:
//!
//!   T = k (l − l₀) + T₀ + c l̇                                         two-sided
//!   T = E + clamp(c l̇, ±E) where E = k (l − l₀) + T₀ > 0, else 0       one that only pulls (a cable)
//!
//! and mirrored for one that only pushes (a bumper). The bound on the damper keeps the force of a one-sided strut
//! continuous where it goes slack; it never acts against its own side. Beyond the stroke a stop pushes back:
//!
//!   f = k_s δ (1 + d δ̇), never negative       δ: depth beyond l_min or l_max (Hunt and Crossley 1975, exponent one)
//!
//! A stop therefore never holds back what leaves it, and a rebound without other forces has the coefficient e of
//!   d v (1 + e) = ln((1 + d v) / (1 − d e v)),     whatever the stiffness.
//!
//! Energy: E²/(2k) (T₀ (l − l₀) where k = 0) and ½ k_s δ². Where both anchors meet (l < 1e-12 m) the line has no
//! direction and the strut no force. Massless: the strut's own inertia is left out.

use super::{Deformation, RowForce, Side, find_negative};
use serde::{Deserialize, Serialize};
use spatial::{Vec3, Wrench};

/// Distance of the anchors (m) below which their line has no direction.
const MEETING: f64 = 1e-12;

/// In which directions the spring and damper of a strut act; stops always do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum StrutSides {
    /// Pulls and pushes.
    #[default]
    Both,
    /// A cable.
    PullOnly,
    /// A bumper.
    PushOnly,
}

/// A spring-damper strut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strut {
    /// l₀, m.
    pub rest_length: f64,
    /// k, N/m.
    pub stiffness: f64,
    /// c, N·s/m.
    pub damping: f64,
    /// T₀: tension at rest length, N; negative pushes.
    pub preload: f64,
    /// Directions in which it acts.
    pub sides: StrutSides,
    /// Lengths at which the stops begin, m; a stop may be at 0 or infinity.
    pub stroke: [f64; 2],
    /// k_s, N/m.
    pub stop_stiffness: f64,
    /// d, s/m.
    pub stop_dissipation: f64,
}

impl Default for Strut {
    fn default() -> Self {
        Self {
            rest_length: 0.0,
            stiffness: 0.0,
            damping: 0.0,
            preload: 0.0,
            sides: StrutSides::Both,
            stroke: [0.0, f64::INFINITY],
            stop_stiffness: 0.0,
            stop_dissipation: 0.0,
        }
    }
}

impl Strut {
    /// Force along the line (negative tension) at a length (m) and its rate (m/s), stops included.
    pub(crate) fn eval(&self, length: f64, rate: f64) -> RowForce {
        let mut out = self.eval_spring(length, rate);
        for (depth, inward) in [(self.stroke[0] - length, 1.0), (length - self.stroke[1], -1.0)] {
            let brake = 1.0 - self.stop_dissipation * inward * rate;
            if depth > 0.0 && brake > 0.0 {
                let push = self.stop_stiffness * depth;
                out.force += inward * push * brake;
                out.stiffness += self.stop_stiffness * brake;
                out.damping += push * self.stop_dissipation;
                out.loss += push * self.stop_dissipation * rate * rate;
            } else if depth > 0.0 {
                // Leaving faster than the stop can follow: what it stored stays with it.
                out.loss += self.stop_stiffness * depth * inward * rate;
            }
            out.stored += 0.5 * self.stop_stiffness * depth.max(0.0).powi(2);
        }
        out
    }

    fn eval_spring(&self, length: f64, rate: f64) -> RowForce {
        let (k, c, stretch) = (self.stiffness, self.damping, length - self.rest_length);
        let elastic = k * stretch + self.preload;
        let sign = match self.sides {
            StrutSides::Both => {
                let stored = self.calc_spring_energy(elastic, stretch);
                return RowForce {
                    force: -elastic - c * rate,
                    stiffness: k,
                    damping: c,
                    stored,
                    loss: c * rate * rate,
                };
            }
            StrutSides::PullOnly => 1.0,
            StrutSides::PushOnly => -1.0,
        };
        let (own, brake) = (sign * elastic, sign * c * rate);
        if own <= 0.0 {
            return RowForce::default();
        }
        let bounded = brake.clamp(-own, own);
        let (stiffness, damping) = if brake > own {
            (2.0 * k, 0.0)
        } else if brake < -own {
            (0.0, 0.0)
        } else {
            (k, c)
        };
        let stored = self.calc_spring_energy(elastic, stretch);
        RowForce { force: -sign * (own + bounded), stiffness, damping, stored, loss: sign * bounded * rate }
    }

    fn calc_spring_energy(&self, elastic: f64, stretch: f64) -> f64 {
        if self.stiffness > 0.0 { 0.5 * elastic * elastic / self.stiffness } else { self.preload * stretch }
    }

    /// Stiffness between here and `reach` (m) further.
    pub(crate) fn calc_stiffness_within(&self, length: f64, reach: f64) -> f64 {
        let at_stop = length - reach < self.stroke[0] || length + reach > self.stroke[1];
        self.stiffness + if at_stop { self.stop_stiffness } else { 0.0 }
    }

    pub(crate) fn find_fault(&self) -> Option<String> {
        let [shortest, longest] = self.stroke;
        if shortest.is_nan() || longest.is_nan() || shortest > longest {
            return Some(format!("stroke {shortest} … {longest} m must ascend"));
        }
        if !self.preload.is_finite() {
            return Some(format!("preload {} N must be finite", self.preload));
        }
        find_negative(&[
            ("rest length", self.rest_length),
            ("stiffness", self.stiffness),
            ("damping", self.damping),
            ("shortest length", shortest),
            ("stop stiffness", self.stop_stiffness),
            ("stop dissipation", self.stop_dissipation),
        ])
    }
}

/// One coordinate: the distance of the origins. A force along their line may be taken to act at the middle, which is the
/// same for both sides: swapping them changes no bit.
pub(crate) fn calc_deformation(sides: &[Side; 2]) -> Deformation {
    let (x_a, x_b) = (sides[0].frame.pos, sides[1].frame.pos);
    let (line, point) = (x_b - x_a, 0.5 * (x_a + x_b));
    let length = line.norm();
    let along = if length > MEETING { line / length } else { Vec3::zeros() };
    let mut out = Deformation { point, n: 1, ..Deformation::default() };
    out.e[0] = length;
    out.rows[0] = Wrench::new(Vec3::zeros(), along);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bumper() -> Strut {
        Strut {
            rest_length: 0.5,
            stiffness: 1e3,
            damping: 80.0,
            preload: -20.0,
            sides: StrutSides::PushOnly,
            stroke: [0.2, 0.6],
            stop_stiffness: 1e5,
            stop_dissipation: 0.7,
        }
    }

    #[test]
    fn slopes_are_those_of_the_force() {
        let h = 1e-7;
        for sides in [StrutSides::Both, StrutSides::PullOnly, StrutSides::PushOnly] {
            let strut = Strut { sides, ..bumper() };
            for (length, rate) in [(0.3, 0.05), (0.19, -0.4), (0.61, 0.3), (0.48, -0.9), (0.55, 0.2), (0.51, 5.0)] {
                let force = |l: f64, r: f64| strut.eval(l, r).force;
                let here = strut.eval(length, rate);
                let by_length = (force(length + h, rate) - force(length - h, rate)) / (2.0 * h);
                let by_rate = (force(length, rate + h) - force(length, rate - h)) / (2.0 * h);
                // Central difference of a force of 1e3 N: rounding 1e-13/h.
                assert!((here.stiffness + by_length).abs() < 1e-2, "{sides:?} at {length} m");
                assert!((here.damping + by_rate).abs() < 1e-2, "{sides:?} at {length} m");
            }
        }
    }

    #[test]
    fn power_is_loss_and_stored_energy_for_every_length_and_rate() {
        let h = 1e-6;
        for sides in [StrutSides::Both, StrutSides::PullOnly, StrutSides::PushOnly] {
            let strut = Strut { sides, ..bumper() };
            for i in 0..200 {
                let (length, rate) = (0.15 + 0.0025 * f64::from(i) + 1e-4, 0.37 * f64::from(i % 13 - 6));
                let stored = |l: f64| strut.eval(l, 0.0).stored;
                let slope = (stored(length + h) - stored(length - h)) / (2.0 * h);
                let here = strut.eval(length, rate);
                // Central difference of some 100 J: rounding 1e-14/h.
                let off = here.force * rate + slope * rate + here.loss;
                assert!(off.abs() < 1e-5 * (1.0 + rate.abs()), "{sides:?} at {length} m, {rate} m/s: {off:e}");
                assert!(here.loss >= 0.0, "{sides:?} at {length} m, {rate} m/s");
            }
        }
    }

    #[test]
    fn a_stop_never_pulls_and_a_bumper_neither() {
        let strut = Strut { stiffness: 0.0, preload: 0.0, sides: StrutSides::Both, damping: 0.0, ..bumper() };
        for rate in [-10.0, -1.0, 0.0, 1.0, 1.5, 10.0] {
            assert!(strut.eval(0.19, rate).force >= 0.0 && strut.eval(0.61, rate).force <= 0.0);
            assert!(bumper().eval(0.4, rate).force >= 0.0);
            assert_eq!(bumper().eval(0.55, rate).force, 0.0, "slack");
        }
    }

    #[test]
    fn anchors_that_meet_give_numbers() {
        let side = Side { frame: spatial::Frame::identity(), twist: spatial::Twist::default() };
        let met = calc_deformation(&[side, side]);
        assert_eq!((met.e[0], met.rows[0]), (0.0, Wrench::default()));
    }
}
