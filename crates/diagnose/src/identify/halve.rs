//! Intervals halved where the missing force does not stay what it is.

use super::fit::{Fitted, Problem, SETTLING};
use super::track::{Base, Link, Track};
use crate::error::DiagnoseError;
use crate::held::holds;
use rayon::prelude::*;
use std::sync::Arc;

/// Times that an interval is halved, samples of a channel that it takes, and how many times the usual mean square of a channel's residuals is
/// missed where a force does not stay what it is.
const HALVED: usize = 5;
const FEWEST: f64 = 6.0;
const UNSTEADY: f64 = 4.0;
/// Largest factor of a mean square that a wrong figure of the noise may stand for.
const WRONG: f64 = 4.0;

impl Problem<'_> {
    /// A fit with intervals halved in which the missing force does not stay what it is, as far as there are samples for it.
    /// `reuse`: derivatives of the others stay what they are until all are.
    pub fn refined(&self, mut now: Fitted, reuse: bool) -> Result<Fitted, DiagnoseError> {
        let begun = now.intervals();
        for _ in 0..HALVED {
            let frame = self.frame(&now);
            let bases: Option<Vec<Vec<Base>>> = now.tracks.par_iter().map(|t| frame.exact(t)).collect();
            let which = self.unsteady(&now, &bases.ok_or_else(|| self.lost())?);
            if !which.iter().flatten().any(|w| *w) {
                break;
            }
            let tracks: Vec<Track> =
                now.tracks.par_iter().zip(&which).map(|(t, w)| frame.halved(t, w)).collect::<Result<_, _>>()?;
            let again = || {
                let pairs = now.tracks.par_iter().zip(&now.links).zip(&tracks);
                pairs.map(|((before, links), after)| frame.links_again((before, links), after).map(Arc::new)).collect()
            };
            let links: Option<Vec<Arc<Vec<Link>>>> = reuse.then(again).flatten();
            let before = holds(&now.built).then(|| now.clone());
            now.spread.local.clear();
            now = self.settle(Fitted { tracks, links: links.unwrap_or_default(), ..now }, SETTLING, reuse)?;
            now = self.followed_again(now)?;
            // What a touch lacks is no force that shorter intervals follow.
            if let Some(before) = before.filter(|before| now.score.is_nan() || now.score >= before.score) {
                now = before;
                break;
            }
        }
        if reuse && now.intervals() > begun {
            now.links.clear();
            now = self.settle(now, SETTLING, false)?;
        }
        Ok(now)
    }

    /// Intervals in which a channel is missed by far more than its noise, as most of them show that.
    fn unsteady(&self, now: &Fitted, bases: &[Vec<Base>]) -> Vec<Vec<bool>> {
        let squares = |(channels, bases): (&Vec<Vec<u16>>, &Vec<Base>)| -> Vec<Vec<(f64, f64)>> {
            let of = |(own, base): (&Vec<u16>, &Base)| {
                let mut sums = vec![(0.0, 0.0); self.channels.len()];
                for (c, r) in own.iter().zip(base.0.iter()) {
                    let sum = &mut sums[*c as usize];
                    *sum = (sum.0 + r * r, sum.1 + 1.0);
                }
                sums.iter().map(|(square, n)| (square / f64::max(*n, 1.0), *n)).collect()
            };
            channels.iter().zip(bases).map(of).collect()
        };
        let all: Vec<Vec<Vec<(f64, f64)>>> = self.channels_of(&now.tracks).iter().zip(bases).map(squares).collect();
        let usual = |c: usize| {
            let mut own: Vec<f64> = all.iter().flatten().filter(|s| s[c].1 > 0.0).map(|s| s[c].0).collect();
            own.sort_by(f64::total_cmp);
            own.get(own.len() / 2).copied().unwrap_or(1.0).clamp(1.0, WRONG)
        };
        let usual: Vec<f64> = (0..self.channels.len()).map(usual).collect();
        let is_missed = |s: &Vec<(f64, f64)>| {
            s.iter().zip(&usual).any(|((mean, n), usual)| *n >= FEWEST && *mean > UNSTEADY * usual)
        };
        all.iter().map(|run| run.iter().map(is_missed).collect()).collect()
    }
}
