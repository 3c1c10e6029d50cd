//! All hypotheses as columns beside one linear model of the runs.

use super::kin::are_kin;
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::hypothesis::{Hypothesis, Tier};
use crate::linear::Variation;
use crate::plant::Plant;
use rayon::prelude::*;
use std::ops::Range;

/// A screen point of a hypothesis.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Which hypothesis.
    pub hypothesis: usize,
    /// Which of its points.
    pub point: usize,
    /// Its columns among those of all entries.
    pub columns: Range<usize>,
}

/// Hypotheses with the models that their columns are taken from.
#[derive(Clone, Debug)]
pub struct Pool {
    /// The hypotheses.
    pub hypotheses: Vec<Hypothesis>,
    /// Their screen points.
    pub entries: Vec<Entry>,
    /// A model for each column.
    pub variations: Vec<Variation>,
}

impl Pool {
    /// The columns of some hypotheses beside a set; points that cannot be built are left out.
    pub fn new(plant: &Plant, set: &EffectSet, hypotheses: Vec<Hypothesis>) -> Result<Self, DiagnoseError> {
        let points: Vec<(usize, usize)> =
            hypotheses.iter().enumerate().flat_map(|(h, hyp)| (0..hyp.screens.len()).map(move |p| (h, p))).collect();
        let built = |(h, p): &(usize, usize)| {
            let hypothesis = &hypotheses[*h];
            let column = |c: &crate::hypothesis::Column| {
                let x: Vec<f64> = c.base.iter().zip(&c.direction).map(|(b, d)| b + c.step * d).collect();
                let set = set.with(hypothesis, &hypothesis.clamped(&x));
                let built = plant.build(&set.effects()).ok()?;
                Some(Variation { built, step: c.step, is_tolerated: false })
            };
            hypothesis.screens[*p].columns.iter().map(column).collect::<Option<Vec<_>>>()
        };
        let built: Vec<Option<Vec<Variation>>> = points.par_iter().map(built).collect();
        let (mut entries, mut variations) = (Vec::new(), Vec::new());
        for ((hypothesis, point), of_point) in points.into_iter().zip(built) {
            let Some(of_point) = of_point.filter(|v| !v.is_empty()) else { continue };
            let columns = variations.len()..variations.len() + of_point.len();
            entries.push(Entry { hypothesis, point, columns });
            variations.extend(of_point);
        }
        Ok(Self { hypotheses, entries, variations })
    }

    /// Columns of all entries.
    pub fn columns(&self) -> usize {
        self.entries.last().map_or(0, |e| e.columns.end)
    }

    /// Columns of some entries, one entry's after the other.
    pub fn columns_of(&self, entries: &[usize]) -> Vec<usize> {
        entries.iter().flat_map(|e| self.entries[*e].columns.clone()).collect()
    }

    /// The hypothesis of an entry.
    pub fn of(&self, entry: usize) -> &Hypothesis {
        &self.hypotheses[self.entries[entry].hypothesis]
    }

    /// Whether an entry may join others: of one hypothesis there is one point, of one law one form.
    pub fn is_open(&self, known: &[usize], entry: usize) -> bool {
        let of = |e: usize| self.entries[e].hypothesis;
        known.iter().all(|k| of(*k) != of(entry) && !are_kin(self.of(*k), self.of(entry)))
    }

    /// What some entries are and where, in alphabetical order: sets of other points of the same hypotheses are alike.
    pub fn titles(&self, entries: impl Iterator<Item = usize>) -> Vec<String> {
        let mut titles: Vec<String> = entries.map(|e| self.of(e).title()).collect();
        titles.sort();
        titles
    }

    /// Keeps the first of those whose entries are alike.
    pub fn keep_unlike<T>(&self, all: &mut Vec<T>, entries: impl Fn(&T) -> Vec<usize>) {
        let mut seen: Vec<Vec<String>> = Vec::new();
        all.retain(|one| {
            let titles = self.titles(entries(one).into_iter());
            let is_new = !seen.contains(&titles);
            seen.push(titles);
            is_new
        });
    }

    /// Price of some entries together, for so many residuals.
    pub fn price(&self, entries: &[usize], count: usize) -> f64 {
        entries.iter().map(|e| price(self.of(*e), count, self.hypotheses.len())).sum()
    }

    /// The numbers of some entries at amplitudes of their columns, one entry's after the other; none where one of the effects is impossible.
    pub fn starts(&self, entries: &[usize], amplitudes: &[f64]) -> Option<Vec<(usize, Vec<f64>)>> {
        let mut at = 0;
        let start = |e: &usize| {
            let from = at;
            at += self.entries[*e].columns.len();
            self.start(*e, &amplitudes[from..at]).map(|x| (*e, x))
        };
        entries.iter().map(start).collect()
    }

    /// What an entry's numbers are at some amplitudes of its columns; none where no such effect is possible.
    fn start(&self, entry: usize, amplitudes: &[f64]) -> Option<Vec<f64>> {
        let Entry { hypothesis, point, .. } = &self.entries[entry];
        let hypothesis = &self.hypotheses[*hypothesis];
        hypothesis.start_from(&hypothesis.screens[*point], amplitudes)
    }
}

/// Price of an effect in −2 log likelihood: its numbers by the size of the sample, and how unlikely it was beforehand among `many`.
pub fn price(hypothesis: &Hypothesis, count: usize, many: usize) -> f64 {
    if hypothesis.is_tolerated() {
        return 0.0;
    }
    let numbers = hypothesis.coordinates.len() - hypothesis.held.len();
    let unlikely = match hypothesis.tier {
        Tier::Nominal => 0.0,
        Tier::Exotic => EXOTIC,
    };
    numbers as f64 * (count.max(2) as f64).ln() + 2.0 * (many.max(1) as f64).ln() + unlikely
}

/// That physics is missing is held less likely beforehand than that a nominal number is off: odds of ten to one.
const EXOTIC: f64 = 4.6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;

    #[test]
    fn more_numbers_cost_more_and_a_tolerated_number_costs_nothing() {
        let all = hypotheses(&Facts::of_joints(1));
        let of = |name: &str| all.iter().find(|h| h.name == name).expect("it is in the library");
        let plain = price(of("joint-viscous-friction"), 1000, 50);
        assert!((price(of("joint-viscous-asymmetry"), 1000, 50) - plain - 1000f64.ln()).abs() < 1e-12, "by ln N");
        assert!(price(of("joint-viscous-friction"), 1000, 100) > plain, "by how many were looked at");
        let within = Hypothesis { tolerance: vec![0.1], ..of("joint-viscous-friction").clone() };
        assert_eq!(price(&within, 1000, 50), 0.0);
    }
}
