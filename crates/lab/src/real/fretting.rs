//! A measured hysteresis loop, and friction laws driven by its displacement and normal force.
//!
//! A contact under 5 N is dragged to and fro over 0.24 mm at 0.25 mm/s with 2 s of dwell at each end, 50 times (J.
//! Christopherson, FrictionModels.jl, test_data_2; the material is not stated). Nothing moves freely: a law is told the
//! displacement x and the normal force of each sample and answers with the friction force; no dynamics, no integrator.
//!
//! Sign: x is B's displacement, the force acts on B; in sliding it is opposite to the motion.
//!
//! What is fitted is a *bundle*: one law, or n bristles side by side that share the load equally and differ in stiffness,
//! so that they break away one after the other (Iwan 1966; a generalised Maxwell-slip model):
//!
//!   f = Σ fᵢ,   μᵢ fₙᵢ = μ fₙ/n,   kᵢ = μ fₙ/(n dᵢ),   dᵢ = d_first + (d_last − d_first) (i − ½)/n

use super::{RealError, Table};
use friction::{Friction, Trial};
use spatial::Vec3;
use std::ops::Range;
use std::path::Path;

/// Normal force above which the contact counts as loaded, N.
const LOADED: f64 = 4.9;

/// The recording, from touch-down to lift-off.
#[derive(Clone, Debug)]
pub struct Loop {
    /// Time, s.
    pub t: Vec<f64>,
    /// Normal force, N.
    pub normal: Vec<f64>,
    /// Displacement, m.
    pub x: Vec<f64>,
    /// Friction force, N.
    pub force: Vec<f64>,
    /// Samples at which a cycle begins: the middle of the stroke, on the way up.
    pub cycles: Vec<usize>,
}

impl Loop {
    /// Reads the recording.
    pub fn load(folder: &Path) -> Result<Self, RealError> {
        let path = folder.join("fretting_friction").join("fretting_200hz.csv");
        let table = Table::load(&path)?;
        let normal = table.column("normal_N")?;
        let content = |problem: &str| RealError::Content { path: path.clone(), problem: problem.to_owned() };
        let first = normal.iter().position(|n| *n > LOADED).ok_or_else(|| content("is never loaded above 4.9 N"))?;
        let last = normal.iter().rposition(|n| *n > LOADED).unwrap_or(first);
        let part = |name| Ok::<_, RealError>(table.column(name)?[first..=last].to_vec());
        let (t, x, force) = (part("t_s")?, part("pos_m")?, part("friction_N")?);
        let middle = 0.5 * x.iter().fold([f64::MAX, f64::MIN], |m, x| [m[0].min(*x), m[1].max(*x)]).iter().sum::<f64>();
        let cycles: Vec<usize> = (1..x.len()).filter(|&i| x[i - 1] <= middle && x[i] > middle).collect();
        if cycles.len() < 10 {
            return Err(content("has fewer than ten cycles"));
        }
        Ok(Self { t, normal: normal[first..=last].to_vec(), x, force, cycles })
    }

    /// The cycles that are fitted: the first half.
    pub fn fitted(&self) -> Range<usize> {
        self.cycles[0]..self.cycles[self.cycles.len() / 2]
    }

    /// The cycles that are judged: the second half.
    pub fn judged(&self) -> Range<usize> {
        self.cycles[self.cycles.len() / 2]..self.cycles[self.cycles.len() - 1]
    }

    /// Force of a bundle of laws that share the load equally, N, from touch-down to sample `end`.
    pub fn drive(&self, laws: &[Friction], end: usize) -> Vec<f64> {
        let mut total = vec![0.0; end];
        for law in laws {
            let (mut s, mut rest) = (Vec3::zeros(), law.initial_rest());
            for (i, total) in total.iter_mut().enumerate().skip(1) {
                let (moved, elapsed) = (Vec3::x() * (self.x[i] - self.x[i - 1]), self.t[i] - self.t[i - 1]);
                let normal_force = self.normal[i] / laws.len() as f64;
                let slip = moved / elapsed;
                let brush =
                    law.eval(&Trial { s, s_trial: s + moved, slip, elapsed, normal_force, rest, ..Trial::default() });
                (s, rest) = (brush.s, brush.rest);
                *total += brush.force.x;
            }
        }
        total
    }

    /// Root mean square of the error over that of the measured force, over a range of samples.
    pub fn calc_error(&self, force: &[f64], range: Range<usize>) -> f64 {
        self.calc_error_where(force, range, |_| true)
    }

    /// The same over those samples of the range that are kept.
    pub fn calc_error_where(&self, force: &[f64], range: Range<usize>, keep: impl Fn(usize) -> bool) -> f64 {
        let sum = |f: &dyn Fn(usize) -> f64| range.clone().filter(|i| keep(*i)).map(f).sum::<f64>();
        (sum(&|i| (force[i] - self.force[i]).powi(2)) / sum(&|i| self.force[i].powi(2))).sqrt()
    }

    /// Whether the contact is dragged at a sample: faster than 0.1 mm/s over the five samples around it.
    pub fn is_moving(&self, i: usize) -> bool {
        let (a, b) = (i.saturating_sub(2), (i + 2).min(self.x.len() - 1));
        (self.x[b] - self.x[a]).abs() > 1e-4 * (self.t[b] - self.t[a])
    }

    /// Measured slope |Δf/Δx| while the contact is dragged from one side to the other and the force passes `range` (N), N/m:
    /// the median over all passages, up and down alike.
    pub fn calc_stiffness(&self, range: Range<f64>) -> f64 {
        let mut slopes = Vec::new();
        let mut from: Option<usize> = None;
        for i in 0..self.force.len() {
            let inside = range.contains(&self.force[i]) && self.is_moving(i);
            match (inside, from) {
                (true, None) => from = Some(i),
                (false, Some(first)) => {
                    let moved = self.x[i - 1] - self.x[first];
                    if moved != 0.0 {
                        slopes.push(((self.force[i - 1] - self.force[first]) / moved).abs());
                    }
                    from = None;
                }
                _ => {}
            }
        }
        slopes.sort_by(f64::total_cmp);
        slopes.get(slopes.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// What is left where the mean cycle of the fitted half is all that is said: the loop's own scatter and drift, below
    /// which no law that repeats itself can come.
    pub fn calc_scatter(&self) -> f64 {
        let half = self.cycles.len() / 2;
        let (mut sum, mut square) = (0.0, 0.0);
        for later in half..self.cycles.len() - 1 {
            let length = self.cycles[later + 1] - self.cycles[later];
            for k in 0..length {
                let at = |cycle: usize| {
                    let (from, to) = (self.cycles[cycle], self.cycles[cycle + 1]);
                    self.force[from + (k * (to - from)) / length]
                };
                let mean = (0..half).map(at).sum::<f64>() / half as f64;
                let force = self.force[self.cycles[later] + k];
                (sum, square) = (sum + (force - mean).powi(2), square + force * force);
            }
        }
        (sum / square).sqrt()
    }
}
