//! How large unknown forces and noise are, and the numbers beside them: by the marginal likelihood.
//!
//! With numbers θ, variances q² of the forces and factors κ of the noise of each channel the likelihood of all runs is that of [`super::chain`], its residuals
//! over κ. Its −2 log falls with every step of
//!
//!   q² ← ⟨f̂² + var f̂⟩,    κ² ← κ² ⟨ρ̂² + var ρ̂⟩           (expectation–maximisation: Shumway and Stoffer 1982),
//!
//! here over-relaxed in the logarithm, which keeps the fixed point and comes there several times sooner; a step that does not lower it is made
//! plain. κ is never below one: what sensors are known to have they have, and what no force of an interval's length follows comes on top.
//!
//! A few intervals may not be followed at all (a joint turns, a drive starts): the channel's n samples there then have a factor λ of their own, which is
//! likeliest at λ² = Σ ρ²/κ²n. It costs a price P, so that it is one everywhere else:
//!
//!   n ln λ² + n + P < Σ ρ²/κ²,     P = ln N + 2 ln(intervals × channels)
//!
//! the worst intervals first, for what they do to their neighbours. Forces are of a t distribution: what a law leaves is little, and much more where it is
//! not the law (where a joint turns). f ~ N(0, q²/w) with w of a gamma distribution of ν/2 and ν/2 as a density of ln w:
//!
//!   w = (1 + ν) / (ν + ⟨f²⟩/q²),     −2 log p(w) = ν (w − 1 − ln w)                (Lange, Little and Taylor 1989)

use super::chain::{Filtered, Marginal, Node, Prior, Smoothed, eliminate, filtered, smooth};
use super::track::{Link, Side};
use crate::fit::pseudo_inverse;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// A run made linear, sample by sample.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Its number among the runs that are fitted.
    pub run: usize,
    /// Price of a factor of a single interval and channel.
    pub price: f64,
    /// Derivatives by states and forces.
    pub links: Arc<Vec<Link>>,
    /// Columns of numbers and residuals.
    pub sides: Vec<Side>,
    /// Channel of every residual, interval by interval.
    pub channels: Vec<Vec<u16>>,
    /// Prior standard deviations of the first state.
    pub start: DVector<f64>,
}

/// The same by products of its columns.
#[derive(Clone, Debug)]
pub struct Chain {
    run: usize,
    price: f64,
    nodes: Vec<Node>,
    start: DVector<f64>,
    /// Residuals by channel, interval by interval.
    samples: Vec<Vec<(u16, f64)>>,
}

/// What varies from interval to interval, and from sample to sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// Standard deviations of the unknown forces.
    pub force: DVector<f64>,
    /// Factor of the noise, by channel.
    pub noise: DVector<f64>,
    /// What is different in single intervals, by run and interval; nothing where it is empty.
    pub local: Vec<Vec<Local>>,
}

/// What is different in an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Local {
    /// A further factor of the noise, λ, by channel.
    pub noise: DVector<f64>,
    /// A further factor of the unknown forces' standard deviation, 1/√w.
    pub force: DVector<f64>,
}

/// Numbers and spread at their best.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Numbers.
    pub theta: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Spread of forces and noise.
    pub spread: Spread,
    /// −2 log of the marginal likelihood, but for a constant.
    pub score: f64,
    /// Part of it that residuals make: their number where all is right.
    pub cost: f64,
}

/// Exponent of a step in log q².
const RELAXED: f64 = 1.8;
/// Fall of −2 log likelihood by a step below which the spread is at its best.
const ENOUGH: f64 = 0.1;
/// Most that one step changes a variance.
const LEAP: [f64; 2] = [1e-4, 1e8];

/// Price of a factor of a single interval and channel: one number, and that it may be any of so many.
pub fn price_of_factor(count: usize, factors: usize) -> f64 {
    (count.max(2) as f64).ln() + 2.0 * (factors.max(1) as f64).ln()
}

impl Linear {
    /// Products of the columns of some numbers and of the residual.
    pub fn chain(&self, columns: &[usize]) -> Chain {
        let node = |((link, side), channels): ((&Link, &Side), &Vec<u16>)| {
            let kept: Vec<usize> = columns.iter().copied().chain([side.y.ncols() - 1]).collect();
            let of_channel = |channel: u16| {
                let rows: Vec<usize> = (0..channels.len()).filter(|i| channels[*i] == channel).collect();
                let (n_x, n_f) = (link.s.ncols(), link.f.ncols());
                let mut all = DMatrix::zeros(rows.len(), n_x + n_f + kept.len());
                for (i, row) in rows.iter().enumerate() {
                    (0..n_x).for_each(|k| all[(i, k)] = link.s[(*row, k)]);
                    (0..n_f).for_each(|k| all[(i, n_x + k)] = link.f[(*row, k)]);
                    kept.iter().enumerate().for_each(|(k, c)| all[(i, n_x + n_f + k)] = side.y[(*row, *c)]);
                }
                (channel, all)
            };
            let rows = counts(channels).into_iter().map(|(channel, _)| of_channel(channel)).collect();
            Node::new(rows, [link.a.clone(), link.b.clone(), side.d.select_columns(&kept)])
        };
        let nodes: Vec<Node> = self.links.par_iter().zip(&self.sides).zip(&self.channels).map(node).collect();
        Chain { run: self.run, price: self.price, nodes, start: self.start.clone(), samples: self.samples() }
    }

    /// Residuals by channel, interval by interval.
    fn samples(&self) -> Vec<Vec<(u16, f64)>> {
        self.channels.iter().map(|own| counts(own)).collect()
    }

    /// Products of very many columns, over factors of the noise: a few intervals at a time, for each takes megabytes.
    fn summed<'s>(&'s self, columns: &'s [usize], factors: &'s [DVector<f64>]) -> impl Iterator<Item = Node> + 's {
        let node = move |i: usize| {
            let (link, side, channels, factor) = (&self.links[i], &self.sides[i], &self.channels[i], &factors[i]);
            let kept: Vec<usize> = columns.iter().copied().chain([side.y.ncols() - 1]).collect();
            let (n_x, n_f) = (link.s.ncols(), link.f.ncols());
            let mut all = DMatrix::zeros(channels.len(), n_x + n_f + kept.len());
            all.columns_mut(0, n_x).copy_from(&link.s);
            all.columns_mut(n_x, n_f).copy_from(&link.f);
            kept.iter().enumerate().for_each(|(k, c)| all.column_mut(n_x + n_f + k).copy_from(&side.y.column(*c)));
            for (i, channel) in channels.iter().enumerate() {
                let factor = factor[*channel as usize];
                if factor != 1.0 {
                    all.row_mut(i).unscale_mut(factor);
                }
            }
            let gram = all.transpose() * all;
            Node::summed(gram, [link.a.clone(), link.b.clone(), side.d.select_columns(&kept)])
        };
        let count = self.links.len();
        let few = move |from: usize| (from..count.min(from + AT_A_TIME)).into_par_iter().map(node).collect::<Vec<_>>();
        (0..count).step_by(AT_A_TIME).flat_map(few)
    }
}

/// Channels of some residuals in order, and how many each has.
fn counts(channels: &[u16]) -> Vec<(u16, f64)> {
    let mut own = channels.to_vec();
    own.sort_unstable();
    own.chunk_by(|a, b| a == b).map(|alike| (alike[0], alike.len() as f64)).collect()
}

/// What factors of the noise add to −2 log likelihood.
fn log_noise(samples: &[Vec<(u16, f64)>], factors: &[DVector<f64>]) -> f64 {
    let of = |(own, noise): (&Vec<(u16, f64)>, &DVector<f64>)| -> f64 {
        own.iter().map(|(c, n)| 2.0 * n * noise[*c as usize].ln()).sum()
    };
    samples.iter().zip(factors).map(of).sum()
}

/// A run's products with what factors of the noise and all that is different in single intervals add.
fn priced(found: Marginal, samples: &[Vec<(u16, f64)>], factors: &[DVector<f64>], price: f64) -> Marginal {
    Marginal { log_det: found.log_det + log_noise(samples, factors) + price, ..found }
}

impl Chain {
    /// States and forces at some numbers.
    pub fn smoothed(&self, spread: &Spread, theta: &DVector<f64>) -> Smoothed {
        smooth(&self.nodes, &self.filtered(spread), theta)
    }

    /// Products of the numbers' columns, states and forces eliminated, and what it takes to find these.
    fn filtered(&self, spread: &Spread) -> Filtered {
        let [noise, force] = spread.by_interval(self.run, self.nodes.len());
        let mut found = filtered(&self.nodes, Prior { start: &self.start, force: &force, noise: &noise });
        found.marginal = priced(found.marginal, &self.samples, &noise, spread.price_of(self.run, self.price));
        found
    }

    /// Largest mean square of a channel in an interval without a factor of its own, units of the channel's noise.
    fn worst(&self, smoothed: &Smoothed, spread: &Spread) -> f64 {
        let mut worst = 0.0;
        for (i, (squares, samples)) in smoothed.squares.iter().zip(&self.samples).enumerate() {
            let local = spread.local_of(self.run, i);
            for ((channel, square), (_, n)) in squares.iter().zip(samples) {
                let channel = *channel as usize;
                if local.is_none_or(|l| l.noise[channel] <= 1.0) {
                    worst = f64::max(worst, square / spread.noise[channel].powi(2) / n);
                }
            }
        }
        worst
    }

    /// Products of the numbers' columns, states and forces eliminated.
    fn products(&self, spread: &Spread) -> Marginal {
        let [noise, force] = spread.by_interval(self.run, self.nodes.len());
        let found = eliminate(&self.nodes, Prior { start: &self.start, force: &force, noise: &noise });
        priced(found, &self.samples, &noise, spread.price_of(self.run, self.price))
    }
}

/// Products of the numbers' columns over all runs, states and forces eliminated; each run alone.
pub fn products(runs: &[Chain], spread: &Spread) -> Vec<Marginal> {
    runs.par_iter().map(|run| run.products(spread)).collect()
}

/// Intervals whose products are at hand at a time.
const AT_A_TIME: usize = 4;

/// Products of very many columns over all runs, at one spread.
pub fn wide_products(runs: &[Linear], columns: &[usize], spread: &Spread) -> Marginal {
    let of = |run: &Linear| {
        let [factors, force] = spread.by_interval(run.run, run.channels.len());
        let ones = vec![DVector::from_element(spread.noise.len(), 1.0); factors.len()];
        let found = eliminate(run.summed(columns, &factors), Prior { start: &run.start, force: &force, noise: &ones });
        priced(found, &run.samples(), &factors, spread.price_of(run.run, run.price))
    };
    sum(&runs.par_iter().map(of).collect::<Vec<_>>())
}

/// The sum over runs.
pub fn sum<'m>(parts: impl IntoIterator<Item = &'m Marginal>) -> Marginal {
    let mut parts = parts.into_iter().peekable();
    let width = parts.peek().map_or(1, |p| p.gram.ncols());
    let zero = Marginal { gram: DMatrix::zeros(width, width), log_det: 0.0 };
    parts.fold(zero, |sum, p| Marginal { gram: sum.gram + &p.gram, log_det: sum.log_det + p.log_det })
}

/// −2 log likelihood of a model without numbers at a given spread.
pub fn score(runs: &[Chain], spread: &Spread) -> f64 {
    let k = sum(&products(runs, spread));
    k.gram[(0, 0)] + k.log_det
}

/// The numbers that are best at a given spread. `ridge`: products of the numbers' priors, of the same shape as K.
pub fn solve(k: &Marginal, ridge: Option<&DMatrix<f64>>, spread: &Spread) -> Estimate {
    let gram = ridge.map_or_else(|| k.gram.clone(), |r| &k.gram + r);
    let n = gram.ncols() - 1;
    let covariance = pseudo_inverse(&gram.view((0, 0), (n, n)).into_owned());
    let b = gram.view((0, n), (n, 1)).column(0).into_owned();
    let theta = -(&covariance * &b);
    let cost = gram[(n, n)] + b.dot(&theta);
    Estimate { theta, covariance, spread: spread.clone(), score: cost + k.log_det, cost }
}

/// Numbers and spread together, from a given spread, in so many steps at most.
pub fn estimate(runs: &[Chain], ridge: Option<&DMatrix<f64>>, spread: &Spread, steps: usize) -> Estimate {
    let at = |spread: &Spread| {
        let filtered: Vec<Filtered> = runs.par_iter().map(|run| run.filtered(spread)).collect();
        let all = sum(filtered.iter().map(|f| &f.marginal));
        Stand { estimate: solve(&all, ridge, spread), filtered }
    };
    let mut now = at(spread);
    let mut may_be_idle = true;
    for _ in 0..steps {
        let growth = now.growth(runs);
        // What the filter has seen is the largest thing at hand, and is not asked again.
        now.filtered = Vec::new();
        if may_be_idle {
            // Towards zero each step is shorter than the last: what there is none of is left out at once.
            now = without_idle(now, &growth, &at);
        }
        let mut next = at(&now.estimate.spread.grown(&growth, RELAXED));
        if next.estimate.score.is_nan() || next.estimate.score > now.estimate.score {
            next = at(&now.estimate.spread.grown(&growth, 1.0));
        }
        let fall = now.estimate.score - next.estimate.score;
        if fall.is_nan() || fall <= 0.0 {
            break;
        }
        now = next;
        if fall < ENOUGH {
            break;
        }
        may_be_idle = growth.force.iter().any(|g| *g < SHRINKING);
    }
    now.estimate
}

/// Numbers at a spread, and the runs as the filter has seen them there.
struct Stand {
    estimate: Estimate,
    filtered: Vec<Filtered>,
}

/// The same without forces that shrink and are not needed, all at once or one by one.
fn without_idle(now: Stand, growth: &Spread, at: &dyn Fn(&Spread) -> Stand) -> Stand {
    let force = &now.estimate.spread.force;
    let shrinks = |j: &usize| growth.force[*j] < SHRINKING && force[*j] > f64::MIN_POSITIVE.sqrt();
    let idle: Vec<usize> = (0..growth.force.len()).filter(shrinks).collect();
    let without = |now: &Stand, forces: &[usize]| {
        let mut spread = now.estimate.spread.clone();
        forces.iter().for_each(|j| spread.force[*j] *= NONE);
        Some(at(&spread)).filter(|next| next.estimate.score < now.estimate.score)
    };
    if let Some(next) = (!idle.is_empty()).then(|| without(&now, &idle)).flatten() {
        return next;
    }
    idle.iter().filter(|_| idle.len() > 1).fold(now, |now, j| without(&now, &[*j]).unwrap_or(now))
}

/// Growth below which a force may be none, and the factor of one that is tried for none.
const SHRINKING: f64 = 0.7;
const NONE: f64 = 1e-3;

impl Stand {
    /// Growth of all variances in one step, and what is different in single intervals then.
    fn growth(&self, runs: &[Chain]) -> Spread {
        let Self { estimate: now, filtered } = self;
        let (n_f, n_c) = (now.spread.force.len(), now.spread.noise.len());
        let smooth = |(run, seen): (&Chain, &Filtered)| smooth(&run.nodes, seen, &now.theta);
        let smoothed: Vec<Smoothed> = runs.par_iter().zip(filtered).map(smooth).collect();
        let worst = FIRST * runs.iter().zip(&smoothed).map(|(run, s)| run.worst(s, &now.spread)).fold(0.0, f64::max);
        let of = |(run, s): (&Chain, &Smoothed)| {
            let mut sums = Squares::new(n_f, n_c);
            sums.intervals = s.forces.len() as f64;
            let mut local = Vec::with_capacity(s.squares.len());
            for (i, (squares, samples)) in s.squares.iter().zip(&run.samples).enumerate() {
                let before = now.spread.local_of(run.run, i);
                let ones = DVector::from_element;
                let mut own = Local { noise: ones(n_c, 1.0), force: ones(n_f, 1.0) };
                for ((channel, square), (_, n)) in squares.iter().zip(samples) {
                    let channel = *channel as usize;
                    let square = square / now.spread.noise[channel].powi(2);
                    if before.is_some_and(|l| l.noise[channel] > 1.0) || square >= worst * n {
                        own.noise[channel] = factor_of_its_own(square, *n, run.price);
                    }
                    sums.noise[channel] += square / own.noise[channel].powi(2);
                    sums.samples[channel] += n;
                }
                for j in (0..n_f).filter(|j| now.spread.force[*j] > 0.0) {
                    let square = s.forces[i][j].powi(2) + s.variances[i][j];
                    let w = (1.0 + TAILS) / (TAILS + square / now.spread.force[j].powi(2));
                    own.force[j] = w.powf(-0.5);
                    sums.force[j] += w * square;
                }
                local.push(own);
            }
            (sums, local)
        };
        let (parts, local): (Vec<Squares>, Vec<_>) = runs.par_iter().zip(&smoothed).map(of).unzip();
        let all = parts.iter().fold(Squares::new(n_f, n_c), Squares::plus);
        let ratio = |x: f64| if x.is_finite() { x.clamp(LEAP[0], LEAP[1]) } else { 1.0 };
        let of_force = |s: f64, q: f64| if q > 0.0 { ratio(s / (all.intervals * q * q)) } else { 1.0 };
        let of_noise = |s: f64, n: f64| if n > 0.0 { ratio(s / n) } else { 1.0 };
        let (force, noise) =
            (all.force.zip_map(&now.spread.force, of_force), all.noise.zip_map(&all.samples, of_noise));
        Spread { force, noise, local }
    }
}

impl Spread {
    /// No unknown forces, and noise as it is known.
    pub fn steady(forces: usize, channels: usize) -> Self {
        Self { force: DVector::zeros(forces), noise: DVector::from_element(channels, 1.0), local: Vec::new() }
    }

    /// What is different in an interval of a run, where that is known.
    pub fn local_of(&self, run: usize, interval: usize) -> Option<&Local> {
        self.local.get(run)?.get(interval)
    }

    /// Factors of the noise of every interval of a run, by channel, and standard deviations of its forces.
    pub fn by_interval(&self, run: usize, intervals: usize) -> [Vec<DVector<f64>>; 2] {
        let local = self.local.get(run).filter(|own| own.len() == intervals);
        let noise = |i: usize| local.map_or_else(|| self.noise.clone(), |own| self.noise.component_mul(&own[i].noise));
        let force = |i: usize| local.map_or_else(|| self.force.clone(), |own| self.force.component_mul(&own[i].force));
        [(0..intervals).map(noise).collect(), (0..intervals).map(force).collect()]
    }

    /// Whether there are intervals that are not followed.
    pub fn is_led_astray(&self) -> bool {
        self.local.iter().flatten().any(|l| l.noise.amax() > 1.0)
    }

    /// The same without factors of the noise of single intervals.
    pub fn without_local_noise(&self) -> Self {
        self.with_local_noise(0.0)
    }

    /// The same with their square roots: what is not followed counts for less, and still counts.
    pub fn softened(&self) -> Self {
        self.with_local_noise(0.5)
    }

    fn with_local_noise(&self, power: f64) -> Self {
        let of = |l: &Local| Local { noise: l.noise.map(|x| x.powf(power)), force: l.force.clone() };
        Self { local: self.local.iter().map(|own| own.iter().map(of).collect()).collect(), ..self.clone() }
    }

    /// Intervals and channels whose noise has a factor of its own.
    pub fn factors(&self) -> usize {
        self.local.iter().flatten().map(|l| l.noise.iter().filter(|x| **x > 1.0).count()).sum()
    }

    /// Root mean square of the unknown forces that are expected.
    pub fn usual_force(&self) -> DVector<f64> {
        let all = || self.local.iter().flatten();
        let count = all().count();
        if count == 0 {
            return self.force.clone();
        }
        let sum = all().fold(DVector::zeros(self.force.len()), |sum, l| sum + l.force.component_mul(&l.force));
        self.force.zip_map(&sum, |q, s: f64| q * (s / count as f64).sqrt())
    }

    /// Price of what is different in single intervals of a run.
    fn price_of(&self, run: usize, price: f64) -> f64 {
        let of = |l: &Local| {
            let factors = l.noise.iter().filter(|l| **l > 1.0).count() as f64;
            let tails: f64 = l.force.iter().map(|m| m.powi(-2)).map(|w| TAILS * (w - 1.0 - w.ln())).sum();
            price * factors + tails
        };
        self.local.get(run).map_or(0.0, |own| own.iter().map(of).sum())
    }

    fn grown(&self, by: &Self, power: f64) -> Self {
        let grow = |x: f64, g: f64| x * g.powf(0.5 * power);
        Self {
            force: self.force.zip_map(&by.force, grow),
            noise: self.noise.zip_map(&by.noise, |x, g| grow(x, g).max(1.0)),
            local: by.local.clone(),
        }
    }
}

/// Share of the worst interval's mean square from which on another one may get a factor of its own in the same step.
const FIRST: f64 = 0.03;
/// Degrees of freedom of the forces' t distribution.
const TAILS: f64 = 4.0;

/// λ of n samples with so large a sum of squares: one where a factor is not worth its price.
fn factor_of_its_own(square: f64, n: f64, price: f64) -> f64 {
    let mean = square / n.max(1.0);
    let is_worth_it = mean > 1.0 && n * (mean - 1.0 - mean.ln()) > price;
    if is_worth_it { mean.sqrt() } else { 1.0 }
}

/// Sums of squares, by force and by channel.
struct Squares {
    force: DVector<f64>,
    intervals: f64,
    noise: DVector<f64>,
    samples: DVector<f64>,
}

impl Squares {
    fn new(forces: usize, channels: usize) -> Self {
        let zeros = DVector::zeros;
        Self { force: zeros(forces), intervals: 0.0, noise: zeros(channels), samples: zeros(channels) }
    }

    fn plus(self, other: &Self) -> Self {
        Self {
            force: self.force + &other.force,
            intervals: self.intervals + other.intervals,
            noise: self.noise + &other.noise,
            samples: self.samples + &other.samples,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::chain::Part;
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    const STEP: f64 = 0.1;
    const INTERVALS: usize = 200;
    const SAMPLES: usize = 8;

    /// A mass that an unknown force of an interval pushes; its place is read, in units of the noise. The number is a constant force.
    fn pushed(force: f64, noise: f64, number: f64) -> Chain {
        let mut dice = ChaCha8Rng::seed_from_u64(11);
        let mut draw = || -> f64 { StandardNormal.sample(&mut dice) };
        let (mut links, mut sides) = (Vec::new(), Vec::new());
        let (mut x, mut v) = (0.0, 0.0);
        for _ in 0..INTERVALS {
            let f = force * draw() + number;
            let at = |k: usize| (k + 1) as f64 / SAMPLES as f64 * STEP;
            let s = DMatrix::from_fn(SAMPLES, 2, |k, c| SCALE * if c == 0 { 1.0 } else { at(k) });
            let by_force = DMatrix::from_fn(SAMPLES, 1, |k, _| SCALE * 0.5 * at(k).powi(2));
            let a = DMatrix::from_row_slice(2, 2, &[1.0, STEP, 0.0, 1.0]);
            let b = DMatrix::from_column_slice(2, 1, &[0.5 * STEP * STEP, STEP]);
            // Predicted less measured, about a state at rest.
            let r: Vec<f64> =
                (0..SAMPLES).map(|k| -SCALE * (x + v * at(k) + 0.5 * f * at(k).powi(2)) + noise * draw()).collect();
            let y = DMatrix::from_columns(&[by_force.column(0).into_owned(), DVector::from_vec(r)]);
            let d = DMatrix::from_columns(&[b.column(0).into_owned(), DVector::zeros(2)]);
            links.push(Link { s, f: by_force, a, b });
            sides.push(Side { y, d });
            (x, v) = (x + v * STEP + 0.5 * f * STEP * STEP, v + f * STEP);
        }
        let channels = vec![vec![0; SAMPLES]; INTERVALS];
        let start = DVector::from_element(2, 10.0);
        Linear {
            run: 0,
            price: price_of_factor(INTERVALS * SAMPLES, INTERVALS),
            links: Arc::new(links),
            sides,
            channels,
            start,
        }
        .chain(&[0])
    }

    /// Readings per unit of noise.
    const SCALE: f64 = 1e4;

    fn at_first() -> Spread {
        Spread { force: DVector::from_element(1, 10.0), ..Spread::steady(1, 1) }
    }

    #[test]
    fn forces_and_noise_come_out_as_large_as_they_are() {
        let found = estimate(&[pushed(0.3, 2.0, 0.5)], None, &at_first(), 40);
        // 200 forces: 5 % is one standard deviation; 1,600 readings: 2 %.
        let (force, noise) = (found.spread.usual_force()[0], found.spread.noise[0]);
        assert!((force / 0.3 - 1.0).abs() < 0.15 && (noise / 2.0 - 1.0).abs() < 0.06, "{force} {noise}");
        let error = found.covariance[(0, 0)].sqrt();
        assert!((error / (0.3 / 200.0f64.sqrt()) - 1.0).abs() < 0.2, "as of the mean of so many forces: {error}");
        assert!((found.theta[0] - 0.5).abs() < 3.0 * error, "{}", found.theta[0]);
    }

    /// The same with one interval that nothing follows.
    fn with_a_bump(mut chain: Chain) -> Chain {
        let node = &mut chain.nodes[INTERVALS / 2];
        let last = node.all.ncols() - 1;
        // Residuals that no state and no force makes.
        node.all[(last, last)] += 1e8;
        let Part::Products(products) = &mut node.parts[0].1 else { panic!("it has more rows than columns") };
        products[(last, last)] += 1e8;
        chain
    }

    #[test]
    fn an_interval_that_is_not_followed_has_a_factor_of_its_own_and_no_other_has() {
        let found = estimate(&[with_a_bump(pushed(0.3, 1.0, 0.5))], None, &at_first(), 40);
        let local: Vec<f64> = found.spread.local[0].iter().map(|l| l.noise[0]).collect();
        let mean = 1e8 / SAMPLES as f64;
        let own = local[INTERVALS / 2] * found.spread.noise[0];
        assert!((own / mean.sqrt() - 1.0).abs() < 0.01, "{own}");
        assert_eq!(local.iter().filter(|l| **l > 1.0).count(), 1);
        assert!((found.spread.noise[0] - 1.0).abs() < 0.06);
        assert!((found.spread.usual_force()[0] / 0.3 - 1.0).abs() < 0.15);
    }

    #[test]
    fn a_run_that_nothing_pushes_has_no_unknown_force() {
        let found = estimate(&[pushed(0.0, 1.0, 0.5)], None, &at_first(), 40);
        assert!(found.spread.force[0] < 1e-4, "{}", found.spread.force[0]);
        assert!((found.theta[0] - 0.5).abs() < 4.0 * found.covariance[(0, 0)].sqrt());
    }
}
