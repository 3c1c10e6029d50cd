//! How much a model leaves: what its unknown forces do.

use super::fit::{Fitted, Problem};
use super::marginal::Local;
use super::track::{Interval, Link};
use nalgebra::DVector;

impl Problem<'_> {
    /// What the unknown forces of a fit do to the readings, and what these are off by in intervals that are not followed: mean square over intervals,
    /// units of noise.
    pub fn power(&self, of: &Fitted) -> f64 {
        let own = |(interval, link): (&Interval, &Link)| -> f64 {
            let each = interval.force.iter().zip(link.f.column_iter());
            each.map(|(force, column)| force * force * column.norm_squared()).sum()
        };
        let pairs = || of.tracks.iter().zip(&of.links).flat_map(|(t, l)| t.intervals.iter().zip(l.iter()));
        let channels = self.channels_of(&of.tracks);
        let missed = |(run, channels): (usize, &Vec<Vec<u16>>)| -> f64 {
            let local = of.spread.local.get(run).map_or(&[][..], Vec::as_slice);
            let factor = |l: &DVector<f64>, c: usize| if l[c] > 1.0 { l[c] * of.spread.noise[c] } else { 1.0 };
            let excess = |(own, l): (&Vec<u16>, &Local)| -> f64 {
                own.iter().map(|c| factor(&l.noise, *c as usize).powi(2) - 1.0).sum()
            };
            channels.iter().zip(local).map(excess).sum()
        };
        let missed: f64 = channels.iter().enumerate().map(missed).sum();
        (pairs().map(own).sum::<f64>() + missed) / pairs().count().max(1) as f64
    }
}
