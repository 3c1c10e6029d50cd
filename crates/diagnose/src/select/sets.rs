//! Sets of effects in the linear model: grown one by one, several at a time, each with the spread that is likeliest beside it.

use super::pool::{Entry, Pool};
use super::scale::Scale;
use crate::fit::pseudo_inverse;
use crate::identify::chain::Marginal;
use crate::identify::marginal::{Chain, Estimate, Linear, Spread, estimate, products, solve, sum, wide_products};
use crate::screen::{Score, find_shown};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// A set that the linear model holds for possible.
#[derive(Clone, Debug)]
pub struct LinearSet {
    /// Entries of the pool, and coordinates to begin a fit with.
    pub members: Vec<(usize, Vec<f64>)>,
    /// How far the numbers that are fitted already go with them.
    pub beside: Vec<f64>,
    /// Criterion: −2 log likelihood and the price of its members.
    pub criterion: f64,
    /// −2 log likelihood.
    pub score: f64,
    /// What it leaves beyond noise.
    pub left: f64,
    /// Spread beside it.
    pub spread: Spread,
}

/// What came of growing sets.
#[derive(Clone, Debug)]
pub struct Grown {
    /// The sets, the best by the criterion first.
    pub sets: Vec<LinearSet>,
    /// What each entry promised alone, the best first.
    pub scores: Vec<Score>,
    /// What the model without any leaves beyond noise, −2 log likelihood.
    pub left: f64,
}

/// What an entry promises beside a set.
struct Promise {
    entry: usize,
    criterion: f64,
    score: Score,
}

/// What sets are grown in.
pub struct Ground<'a> {
    /// The runs, the columns of numbers that are fitted already first, then those of the pool.
    pub runs: &'a [Linear],
    /// Products of the priors of the former.
    pub ridge: &'a DMatrix<f64>,
    /// Hypotheses.
    pub pool: &'a Pool,
    /// What changes of inertia cost.
    pub scale: &'a Scale,
    /// Numbers that are fitted already.
    pub active: usize,
    /// Residuals.
    pub count: usize,
}

/// Sets of one size that are estimated with a spread of their own, and that grow further.
const ESTIMATED: usize = 8;
const GROWN: usize = 3;
/// Share of what the best smaller set leaves beyond noise that one more effect has to take away.
const FURTHER: f64 = 0.3;
/// Entries that take part in sets of two and more: the best by themselves.
const TAKING_PART: usize = 30;
/// Steps of a spread.
const STEPS: usize = 6;

impl Ground<'_> {
    /// Sets of up to `most` effects; `none`: the model without any.
    pub fn grow(&self, none: &Estimate, most: usize) -> Grown {
        let (score, left) = (none.score, none.score - self.silent(&[], &none.spread));
        let empty = LinearSet {
            members: Vec::new(),
            beside: Vec::new(),
            criterion: score,
            score,
            left,
            spread: none.spread.clone(),
        };
        let (mut beam, mut all) = (vec![empty], Vec::<LinearSet>::new());
        let mut best = none.score;
        let mut scores = Vec::new();
        let mut entries: Vec<usize> = (0..self.pool.entries.len()).collect();
        for size in 1..=most {
            let mut grown: Vec<LinearSet> = if size == 2 { self.pairs(none, &entries) } else { Vec::new() };
            for set in &beam {
                let (sets, promised) = self.grown(set, &entries);
                grown.extend(sets);
                if set.members.is_empty() {
                    entries = promised.iter().map(|p| p.entry).take(TAKING_PART).collect();
                    scores = promised.into_iter().map(|p| p.score).collect();
                }
            }
            if !beam.iter().any(|set| self.may_grow(set)) {
                break;
            }
            grown.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
            let titles = |s: &LinearSet| self.pool.titles(s.members.iter().map(|m| m.0));
            grown.dedup_by(|a, b| titles(a) == titles(b));
            // What the linear model leaves of an effect may look like another one: that has to take a good part of it away.
            let least = beam.iter().map(|set| set.left).fold(f64::INFINITY, f64::min);
            let is_further = |g: &LinearSet| g.members.len() == 1 || g.left < (1.0 - FURTHER) * least;
            grown.retain(|g| g.criterion < best && is_further(g));
            all.extend(grown.iter().cloned());
            grown.truncate(GROWN);
            let Some(first) = grown.first() else { break };
            best = first.criterion;
            beam = grown;
        }
        all.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
        Grown { sets: all, scores, left }
    }

    /// Whether what a set leaves is more than noise, by as much as the cheapest effect costs.
    fn may_grow(&self, set: &LinearSet) -> bool {
        let cheapest = (0..self.pool.entries.len()).map(|e| self.price(&[e])).fold(f64::INFINITY, f64::min);
        set.left > cheapest
    }

    /// −2 log likelihood of a model that leaves noise alone.
    fn silent(&self, members: &[usize], spread: &Spread) -> f64 {
        let none = Spread::steady(spread.force.len(), spread.noise.len());
        sum(&products(&self.chains(&self.columns(members)), &none)).log_det + self.count as f64
    }

    /// A set with one more effect of some entries, the most promising ones; and these entries by what they promise.
    fn grown(&self, set: &LinearSet, among: &[usize]) -> (Vec<LinearSet>, Vec<Promise>) {
        let known: Vec<usize> = set.members.iter().map(|m| m.0).collect();
        // What one more effect is for may be the very intervals that are not followed without it.
        let spread = set.spread.softened();
        let k = self.products_of(&[&known[..], among].concat(), &spread);
        let score = self.solved(&k, &known, &spread).score;
        let entries: Vec<usize> = among.iter().copied().filter(|e| self.pool.is_open(&known, *e)).collect();
        let promise = |entry: &usize| self.promise(&k, (&known, *entry), (&spread, score));
        let mut promised: Vec<Promise> = entries.par_iter().filter_map(promise).collect();
        promised.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
        // Of the points of one hypothesis the two best.
        let mut chosen: Vec<usize> = Vec::new();
        for entry in promised.iter().map(|p| p.entry) {
            let own = self.pool.entries[entry].hypothesis;
            let alike = chosen.iter().filter(|c| self.pool.entries[**c].hypothesis == own).count();
            if alike < 2 && chosen.len() < ESTIMATED {
                chosen.push(entry);
            }
        }
        let of = |entry: &usize| self.estimated(&[&known[..], &[*entry]].concat(), &set.spread);
        (chosen.par_iter().filter_map(of).collect(), promised)
    }

    /// The pairs that promise most: each of two effects alone may promise little of what they do together.
    fn pairs(&self, none: &Estimate, among: &[usize]) -> Vec<LinearSet> {
        let spread = none.spread.softened();
        let k = self.products_of(among, &spread);
        let score = self.solved(&k, &[], &spread).score;
        let all = among.iter().enumerate().flat_map(|(n, a)| among[n + 1..].iter().map(move |b| (*a, *b)));
        let open: Vec<(usize, usize)> = all.filter(|(a, b)| self.pool.is_open(&[*a], *b)).collect();
        let of = |(a, b): &(usize, usize)| Some((self.promise(&k, (&[*a], *b), (&spread, score))?.criterion, [*a, *b]));
        let mut promised: Vec<(f64, [usize; 2])> = open.par_iter().filter_map(of).collect();
        promised.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.pool.keep_unlike(&mut promised, |(_, pair)| pair.to_vec());
        promised.truncate(ESTIMATED);
        promised.par_iter().filter_map(|(_, pair)| self.estimated(pair, &none.spread)).collect()
    }

    /// What one more entry promises at a spread, from the score of the set there; none where no such effect is possible.
    fn promise(
        &self,
        k: &Marginal,
        (known, entry): (&[usize], usize),
        (spread, before): (&Spread, f64),
    ) -> Option<Promise> {
        let members = [known, &[entry]].concat();
        let found = self.solved(k, &members, spread);
        let start = self.possible(&members, &found)?.pop()?.1;
        let Entry { hypothesis, point, columns } = &self.pool.entries[entry];
        let own = found.theta.len() - columns.len();
        let of_scale = self.scale_of(&members, &found);
        let inverse = found.covariance.view((own, own), (columns.len(), columns.len())).into_owned();
        let information = pseudo_inverse(&inverse);
        let of = &self.pool.hypotheses[*hypothesis];
        let score = Score {
            hypothesis: *hypothesis,
            point: *point,
            score: before - found.score - of_scale,
            rank: columns.len(),
            start,
            beside: found.theta.as_slice()[..self.active].to_vec(),
            shown: find_shown(of, &of.screens[*point], (&information, &inverse)),
        };
        Some(Promise { entry, criterion: self.price(&members) + found.score + of_scale, score })
    }

    /// Products of the columns of some entries, in their places among all.
    fn products_of(&self, entries: &[usize], spread: &Spread) -> Marginal {
        let columns = self.columns(entries);
        let few = wide_products(self.runs, &columns, spread);
        let all = self.active + self.pool.columns();
        let places: Vec<usize> = columns.iter().copied().chain([all]).collect();
        let mut gram = DMatrix::zeros(all + 1, all + 1);
        for (i, a) in places.iter().enumerate() {
            places.iter().enumerate().for_each(|(j, b)| gram[(*a, *b)] = few.gram[(i, j)]);
        }
        Marginal { gram, log_det: few.log_det }
    }

    fn chains(&self, columns: &[usize]) -> Vec<Chain> {
        self.runs.iter().map(|r| r.chain(columns)).collect()
    }

    fn columns(&self, members: &[usize]) -> Vec<usize> {
        let own = self.pool.columns_of(members).into_iter().map(|c| self.active + c);
        (0..self.active).chain(own).collect()
    }

    fn ridge_for(&self, columns: usize) -> DMatrix<f64> {
        let mut ridge = DMatrix::zeros(columns + 1, columns + 1);
        let n = self.active;
        ridge.view_mut((0, 0), (n, n)).copy_from(&self.ridge.view((0, 0), (n, n)));
        ridge.view_mut((0, columns), (n, 1)).copy_from(&self.ridge.view((0, n), (n, 1)));
        ridge.view_mut((columns, 0), (1, n)).copy_from(&self.ridge.view((n, 0), (1, n)));
        ridge
    }

    fn solved(&self, k: &Marginal, members: &[usize], spread: &Spread) -> Estimate {
        let mut columns = self.columns(members);
        let ridge = self.ridge_for(columns.len());
        columns.push(k.gram.ncols() - 1);
        let gram = DMatrix::from_fn(columns.len(), columns.len(), |i, j| k.gram[(columns[i], columns[j])]);
        solve(&Marginal { gram, log_det: k.log_det }, Some(&ridge), spread)
    }

    /// Coordinates of all members; none where one of them is impossible.
    fn possible(&self, members: &[usize], found: &Estimate) -> Option<Vec<(usize, Vec<f64>)>> {
        self.pool.starts(members, &found.theta.as_slice()[self.active..])
    }

    fn estimated(&self, members: &[usize], spread: &Spread) -> Option<LinearSet> {
        let columns = self.columns(members);
        let spread = &spread.without_local_noise();
        let found = estimate(&self.chains(&columns), Some(&self.ridge_for(columns.len())), spread, STEPS);
        let left = found.score - self.silent(members, &found.spread);
        let score = found.score + self.scale_of(members, &found);
        let members = self.possible(members, &found)?;
        let criterion = score + self.price(&members.iter().map(|m| m.0).collect::<Vec<_>>());
        let beside = found.theta.as_slice()[..self.active].to_vec();
        criterion.is_finite().then_some(LinearSet { members, beside, criterion, left, score, spread: found.spread })
    }

    /// What the change of inertia costs that some members make at their amplitudes.
    fn scale_of(&self, members: &[usize], found: &Estimate) -> f64 {
        self.scale.price(&self.pool.columns_of(members), &found.theta.as_slice()[self.active..])
    }

    fn price(&self, members: &[usize]) -> f64 {
        self.pool.price(members, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;
    use crate::identify::track::{Link, Side};
    use nalgebra::DVector;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use std::sync::Arc;

    const INTERVALS: usize = 60;
    const SAMPLES: usize = 20;

    /// Viscous friction of three joints, a column each.
    fn pool() -> Pool {
        let hypotheses: Vec<_> =
            hypotheses(&Facts::of_joints(3)).into_iter().filter(|h| h.name == "joint-viscous-friction").collect();
        let entries = (0..3).map(|hypothesis| Entry { hypothesis, point: 0, columns: hypothesis..hypothesis + 1 });
        Pool { entries: entries.collect(), hypotheses, variations: Vec::new() }
    }

    /// Readings of what the first two columns do by so much; the third is their sum and some of its own.
    fn runs(truth: [f64; 2]) -> Vec<Linear> {
        let mut dice = ChaCha8Rng::seed_from_u64(5);
        let mut draw = || -> f64 { StandardNormal.sample(&mut dice) };
        let (mut links, mut sides) = (Vec::new(), Vec::new());
        for _ in 0..INTERVALS {
            let mut y = DMatrix::zeros(SAMPLES, 4);
            for k in 0..SAMPLES {
                let (a, b) = (10.0 * draw(), 10.0 * draw());
                let row = [a, b, a + b + 3.0 * draw(), draw() - truth[0] * a - truth[1] * b];
                (0..4).for_each(|c| y[(k, c)] = row[c]);
            }
            let s = DMatrix::from_fn(SAMPLES, 1, |_, _| draw());
            let f = DMatrix::from_fn(SAMPLES, 1, |_, _| draw());
            links.push(Link { s, f, a: DMatrix::identity(1, 1), b: DMatrix::zeros(1, 1) });
            sides.push(Side { y, d: DMatrix::zeros(1, 4) });
        }
        let channels = vec![vec![0; SAMPLES]; INTERVALS];
        vec![Linear {
            run: 0,
            price: 30.0,
            links: Arc::new(links),
            sides,
            channels,
            start: DVector::from_element(1, 1.0),
        }]
    }

    fn best(truth: [f64; 2]) -> Vec<usize> {
        let (runs, pool, ridge) = (runs(truth), pool(), DMatrix::zeros(1, 1));
        let (scale, count) = (Scale::default(), INTERVALS * SAMPLES);
        let ground = Ground { runs: &runs, ridge: &ridge, pool: &pool, scale: &scale, active: 0, count };
        let spread = Spread { force: DVector::from_element(1, 1e-2), ..Spread::steady(1, 1) };
        let none = estimate(&ground.chains(&[]), None, &spread, 10);
        let grown = ground.grow(&none, 3);
        grown
            .sets
            .first()
            .filter(|s| s.criterion < none.score)
            .map_or(Vec::new(), |s| s.members.iter().map(|m| m.0).collect())
    }

    #[test]
    fn two_effects_are_not_taken_for_what_they_have_in_common() {
        let mut members = best([1.0, 1.0]);
        members.sort_unstable();
        assert_eq!(members, [0, 1]);
    }

    #[test]
    fn one_effect_has_no_company_and_noise_has_no_effect() {
        assert_eq!(best([1.0, 0.0]), [0]);
        assert!(best([0.0, 0.0]).is_empty());
    }

    #[test]
    fn friction_that_drives_is_none() {
        assert!(best([1.0, -1.0]).iter().all(|m| *m != 1));
    }
}
