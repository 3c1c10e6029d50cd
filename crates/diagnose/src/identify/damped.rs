//! Steps of a fit: whole ones, and shorter ones where a whole one leads to what is less likely.
//!
//! Numbers that the data hardly tell apart lie in a narrow valley that bends: a whole Gauss–Newton step goes far along it and ends on its slope, and the half
//! of it may be no nearer to its bottom: masses and centres within their tolerances lie so. Damped by λ diag(K), K the numbers' information with states and forces eliminated, a step keeps what is well known and
//! goes little along the valley (Levenberg 1944; Marquardt 1963); what is still not likelier is shortened as a whole, states and all.

use super::fit::{CONVERGED, Fitted, Problem};
use super::marginal::{Chain, Estimate, Spread, products, solve, sum};
use super::step::within_bounds;
use crate::error::DiagnoseError;
use nalgebra::DMatrix;

/// Most times that a step is made shorter.
pub(super) const SHORTER: usize = 4;
/// Damping λ of a set with numbers that have a tolerance, and share of the step, each time.
const OF_MANY: [(f64, f64); SHORTER] = [(0.0, 0.5), (1e-5, 1.0), (1e-3, 0.5), (1e-1, 0.125)];
/// Part of a damping that was needed with which the next step begins.
const EASED: f64 = 0.1;
/// Damping below which a step is a whole one.
const LEAST: f64 = 1e-6;
/// Share of the step of a set without such numbers.
const OF_FEW: [f64; SHORTER] = [0.5, 0.125, 1.0 / 64.0, 1.0 / 1024.0];

/// Where a fit was made linear: what its steps are taken by.
pub(super) struct Look<'a> {
    /// Member and coordinate of every number.
    pub slots: &'a [(usize, usize)],
    /// Products of all columns, run by run.
    pub chains: Vec<Chain>,
    /// Products of the numbers' priors.
    pub ridge: DMatrix<f64>,
    /// The spread that is likeliest.
    pub spread: Spread,
}

impl Look<'_> {
    /// The step damped.
    fn damped(&self, damping: f64) -> Estimate {
        let k = sum(&products(&self.chains, &self.spread));
        let mut ridge = self.ridge.clone();
        for i in 0..self.slots.len() {
            ridge[(i, i)] += damping * (k.gram[(i, i)] + self.ridge[(i, i)]);
        }
        solve(&k, Some(&ridge), &self.spread)
    }
}

/// A fit, what it was made linear by, and the whole step from there.
type Stand<'a> = (Fitted, Look<'a>, Estimate);

/// The way of a fit: where its last step was taken from, and how much shorter than a whole one that is.
#[derive(Default)]
pub(super) struct Way<'a> {
    /// Where the last step was taken from.
    pub last: Option<Stand<'a>>,
    /// How often that step was made shorter.
    pub shorter: usize,
    /// Damping that the last shorter step had.
    damping: f64,
}

impl<'a> Way<'a> {
    /// −2 log likelihood with which the next look is worth its columns.
    pub(super) fn most(&self) -> f64 {
        self.last.as_ref().map_or(f64::INFINITY, |(last, ..)| last.score + CONVERGED)
    }

    /// The step from where a look was worth it: a whole one, or damped by a tenth of what the one before it needed; on a valley's floor as on its slope a whole
    /// one would be taken back each time.
    pub(super) fn next(&mut self, look: &Look<'_>, whole: &Estimate) -> Estimate {
        let eased = EASED * self.damping;
        self.damping = if eased < LEAST { 0.0 } else { eased };
        self.shorter = 0;
        if self.damping > 0.0 { look.damped(self.damping) } else { whole.clone() }
    }

    /// The same set after a shorter step from where the last one was taken; none where there is none or it cannot be built.
    pub(super) fn shorter(&mut self, problem: &Problem<'_>) -> Option<Fitted> {
        let (from, look, whole) = self.last.as_ref()?;
        self.shorter += 1;
        // A law's own shape bends otherwise: there a shorter step in the same direction is the better one.
        let has_valley = from.set.members.iter().any(|(h, _)| h.is_tolerated());
        let (damping, share) = if has_valley { OF_MANY[self.shorter - 1] } else { (0.0, OF_FEW[self.shorter - 1]) };
        self.damping = damping.max(self.damping / EASED);
        let found = if self.damping > 0.0 { look.damped(self.damping) } else { whole.clone() };
        let to = problem.stepped(from, look, found).ok()?;
        if share == 1.0 { Some(to) } else { problem.between(from, &to, share).ok() }
    }

    /// The likelier of where the last step was taken from and where that has led.
    pub(super) fn likelier(self, now: Fitted) -> Fitted {
        match self.last {
            Some((last, ..)) if now.score.is_nan() || now.score > last.score + CONVERGED => last,
            _ => now,
        }
    }
}

impl Problem<'_> {
    /// The same set after a step from where it was made linear.
    pub(super) fn stepped(&self, from: &Fitted, look: &Look<'_>, found: Estimate) -> Result<Fitted, DiagnoseError> {
        let found = Estimate { theta: within_bounds(&from.set, look.slots, &found), ..found };
        let set = self.possible(from, from.set.moved(look.slots, found.theta.as_slice()))?;
        let tracks = self.moved(from, &look.chains, &found);
        Ok(Fitted { tracks, spread: found.spread, ..self.with(from, set)? })
    }
}
