//! Fitting the corner's contact law to tosses, and judging it on others.
//!
//! The cost is what is judged: the mean over tosses of position and rotation error over the whole toss, each in units of
//! the figure to beat. It is rough, since what follows several impacts is chaotic; hence [`Search`], over logarithms of the
//! parameters, all of which are positive.

use super::toss::{Correction, Start, Summary, Toss};
use super::toss_world::{Rules, Surface, Thrower};
use super::{RealError, Search};
use contact::NormalLaw;
use friction::Bristle;
use sim::Integrator;

/// Tosses that are fitted; the rest is judged.
pub const FITTED: usize = 100;
/// Figures to beat on tosses 100–149 (MuJoCo with μ 0.18, elliptic cone, solref 4 ms): % of the width, deg.
pub const TO_BEAT: [f64; 2] = [11.5, 15.2];
/// Steps per sample, 0.845 ms each.
pub const SUBSTEPS: usize = 8;

/// Parameters of the corner on the table, all positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Friction level in sliding, 1.
    pub mu: f64,
    /// Static level over kinetic level, at least 1.
    pub static_ratio: f64,
    /// Stribeck speed, m/s.
    pub stribeck_speed: f64,
    /// Normal stiffness, N/mⁿ.
    pub stiffness: f64,
    /// Exponent n of the normal law.
    pub exponent: f64,
    /// Hunt and Crossley's dissipation, s/m.
    pub dissipation: f64,
    /// Bristle stiffness, N/m.
    pub bristle_stiffness: f64,
    /// Bristle damping, N·s/m.
    pub bristle_damping: f64,
    /// Radius of the corners, m.
    pub radius: f64,
}

impl Corner {
    /// Number of parameters.
    pub const COUNT: usize = 9;
    /// Their names, in the order of [`Corner::to_array`].
    pub const NAMES: [&str; Self::COUNT] = [
        "mu",
        "static_ratio",
        "stribeck_speed",
        "stiffness",
        "exponent",
        "dissipation",
        "bristle_stiffness",
        "bristle_damping",
        "radius",
    ];

    /// All parameters.
    pub fn to_array(&self) -> [f64; Self::COUNT] {
        [
            self.mu,
            self.static_ratio,
            self.stribeck_speed,
            self.stiffness,
            self.exponent,
            self.dissipation,
            self.bristle_stiffness,
            self.bristle_damping,
            self.radius,
        ]
    }

    /// The reverse.
    pub fn from_array(x: [f64; Self::COUNT]) -> Self {
        let [
            mu,
            static_ratio,
            stribeck_speed,
            stiffness,
            exponent,
            dissipation,
            bristle_stiffness,
            bristle_damping,
            radius,
        ] = x;
        Self {
            mu,
            static_ratio,
            stribeck_speed,
            stiffness,
            exponent,
            dissipation,
            bristle_stiffness,
            bristle_damping,
            radius,
        }
    }

    /// The laws.
    pub fn surface(&self) -> Surface {
        let friction = Bristle {
            mu_static: self.mu * self.static_ratio.max(1.0),
            mu_kinetic: self.mu,
            stribeck_speed: self.stribeck_speed,
            stiffness: self.bristle_stiffness,
            damping: self.bristle_damping,
            ..Bristle::default()
        };
        let (stiffness, exponent, dissipation) = (self.stiffness, self.exponent, self.dissipation);
        Surface { normal: NormalLaw::HuntCrossley { stiffness, exponent, dissipation }, friction, radius: self.radius }
    }
}

/// Tosses with their starts, and what of the recording is corrected.
#[derive(Clone, Debug)]
pub struct Tosses {
    /// All tosses.
    pub tosses: Vec<Toss>,
    /// Where each starts.
    pub starts: Vec<Start>,
    /// Gravity and table, stepping.
    pub rules: Rules,
}

impl Tosses {
    /// The recording as it stands: first sample, 9.81 m/s², table at zero.
    pub fn recorded(tosses: Vec<Toss>) -> Self {
        let starts = tosses.iter().map(|t| t.recorded).collect();
        let rules = Rules { correction: Correction::NONE, substeps: SUBSTEPS, integrator: Integrator::ImplicitEuler };
        Self { tosses, starts, rules }
    }

    /// With gravity and table as measured on the fitted tosses, and starts from whole free flights.
    pub fn corrected(tosses: Vec<Toss>) -> Self {
        let correction = Correction::measure(&tosses[..FITTED.min(tosses.len())]);
        let mut all = Self::recorded(tosses);
        all.rules.correction = correction;
        all.starts = all.tosses.iter().map(|t| t.fit_start(correction.gravity)).collect();
        all
    }

    /// Errors of a range of tosses, on two threads; the same bits as on one.
    pub fn judge(&self, corner: &Corner, range: std::ops::Range<usize>) -> Result<Vec<Summary>, RealError> {
        let middle = range.start + range.len() / 2;
        let surface = corner.surface();
        let part = |range: std::ops::Range<usize>| -> Result<Vec<Summary>, RealError> {
            let mut bench = Thrower::new(&surface, &self.rules)?;
            Ok(range.map(|i| bench.summarise(&self.starts[i], &self.tosses[i])).collect())
        };
        let (first, second) = std::thread::scope(|scope| {
            let second = scope.spawn(|| part(middle..range.end));
            (part(range.start..middle), second.join().unwrap_or(Ok(Vec::new())))
        });
        let mut all = first?;
        all.extend(second?);
        Ok(all)
    }

    /// Mean of position and rotation error over the fitted tosses, in units of the figures to beat.
    pub fn calc_cost(&self, corner: &Corner) -> f64 {
        let Ok(all) = self.judge(corner, 0..FITTED) else { return f64::INFINITY };
        let mean = Summary::mean(&all).whole;
        0.5 * (mean[0] / TO_BEAT[0] + mean[1] / TO_BEAT[1])
    }

    /// Fits the parameters at the places `free` in [`Corner::to_array`]; the others stay as in `start`.
    pub fn fit(&self, start: &Corner, free: &[usize], search: &Search) -> (Corner, f64) {
        let x0 = start.to_array();
        let corner = |z: &[f64]| {
            let mut x = x0;
            for (&at, z) in free.iter().zip(z) {
                x[at] = x0[at] * z.exp();
            }
            Corner::from_array(x)
        };
        let found = search.minimise(&vec![0.0; free.len()], |z| {
            let corner = corner(z);
            if corner.radius > 0.02 || !(1.0..=3.0).contains(&corner.exponent) {
                return f64::INFINITY;
            }
            self.calc_cost(&corner)
        });
        (corner(&found.x), found.cost)
    }
}
