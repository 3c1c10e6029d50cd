//! First-order Sobol' indices from a campaign as it was run: the share of an output's variance that one input explains
//! alone,
//!
//!   S = Var(E[y | x]) / Var(y)
//!
//! No special sampling: the runs are parted into M classes by x, and the mean of each class stands for E[y | x]
//! (Plischke, E., Borgonovo, E. & Smith, C. L. (2013): Global sensitivity measures from given data. European Journal of
//! Operational Research 226(3), 536–550). The plain quotient η² of the sums of squares between classes and in total is
//! (M − 1)/(n − 1) on average for an input without any influence; that bias is taken off,
//!
//!   S = (η² (n − 1) − (M − 1)) / (n − M)
//!
//! (Kelley, T. L. (1935): An unbiased correlation ratio measure. Proceedings of the National Academy of Sciences 21(9),
//! 554–559), so that S of such an input scatters around zero and may be slightly negative.
//!
//! **Classes.** Equal counts of runs, M = 2 ∛n, at least five runs each; equal values of x stay together. An input with
//! at most M values has a class for each. A straight line loses 1/M² of its share within the classes: 0.4 % at 500
//! runs.
//!
//! **Noise.** What chance alone makes of these classes is found by shuffling y: η² of shuffled runs has the mean (M −
//! 1)/(n − 1) exactly; its variance is counted over [`SHUFFLES`] shuffles, and a beta distribution with this mean and
//! variance (it is one exactly where y is normal) gives the level that *the largest of p inputs* without influence
//! exceeds once in twenty campaigns.
//!
//! **Limits.** Effects that show only together with another input (no first-order effect) are not seen; correlated
//! inputs share what they explain.

use super::{Moments, beta_quantile};

/// Shuffles of the outputs for the noise level.
const SHUFFLES: usize = 200;
/// Above this number of runs the noise is that of normal outputs: means of so many runs are normal.
const MOST_SHUFFLED: usize = 20_000;
/// Fewest runs, and fewest runs of a class on average.
const FEWEST: (usize, usize) = (10, 5);

/// Runs parted by the values of an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Parting {
    /// The class of each run, in ascending order of the values.
    pub labels: Vec<usize>,
    /// Runs in each class.
    pub sizes: Vec<usize>,
}

/// Number of classes for a number of runs; none where there are too few runs.
pub fn class_count(runs: usize) -> Option<usize> {
    let wanted = (2.0 * (runs as f64).cbrt()).round() as usize;
    (runs >= FEWEST.0).then(|| wanted.min(runs / FEWEST.1).max(2))
}

impl Parting {
    /// Classes of equal counts, about `wanted` of them, or one for each value where there are no more values than that;
    /// equal values stay together. None where there are fewer than two classes, or as many classes as runs.
    ///
    /// Takes [`ranks`](super::ranks) of the values.
    pub fn of_ranks(ranks: &[f64], wanted: usize) -> Option<Self> {
        let mut levels = ranks.to_vec();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let coarse = |rank: f64| ((rank - 0.5) * wanted as f64 / ranks.len() as f64) as usize;
        let level = |rank: f64| levels.partition_point(|l| *l < rank);
        let class = |rank: &f64| if levels.len() <= wanted { level(*rank) } else { coarse(*rank) };
        let mut labels: Vec<usize> = ranks.iter().map(class).collect();
        // Numbers of classes that ties left empty are given to the next.
        let mut used = labels.clone();
        used.sort_unstable();
        used.dedup();
        labels.iter_mut().for_each(|label| *label = used.partition_point(|u| u < label));
        let mut sizes = vec![0; used.len()];
        labels.iter().for_each(|label| sizes[*label] += 1);
        (sizes.len() >= 2 && sizes.len() < ranks.len()).then_some(Self { labels, sizes })
    }

    /// First-order index of the input in an output of the same runs; none where the output does not vary.
    pub fn share(&self, y: &[f64]) -> Option<f64> {
        let pairs = self.labels.iter().copied().zip(y.iter().copied());
        let squared = correlation_ratio(pairs, &self.sizes, &Centre::of(y)?);
        Some(corrected(squared, y.len(), self.sizes.len()))
    }
}

/// The share of y's variance that x explains alone; none where there are too few runs or one of them does not vary.
pub fn share_of_variance(x: &[f64], y: &[f64]) -> Option<f64> {
    Parting::of_ranks(&super::ranks(x), class_count(x.len())?)?.share(y)
}

/// Mean and sum of squares of an output.
struct Centre {
    mean: f64,
    squares: f64,
}

impl Centre {
    fn of(y: &[f64]) -> Option<Self> {
        let moments = Moments::of(y)?;
        let squares = moments.std?.powi(2) * (moments.count - 1) as f64;
        (squares > 0.0).then_some(Self { mean: moments.mean, squares })
    }
}

/// η²: sum of squares between classes over the total.
fn correlation_ratio(pairs: impl Iterator<Item = (usize, f64)>, sizes: &[usize], centre: &Centre) -> f64 {
    let mut sums = vec![0.0; sizes.len()];
    pairs.for_each(|(label, y)| sums[label] += y - centre.mean);
    let between: f64 = sums.iter().zip(sizes).map(|(sum, size)| sum * sum / *size as f64).sum();
    (between / centre.squares).clamp(0.0, 1.0)
}

fn corrected(squared: f64, runs: usize, classes: usize) -> f64 {
    (squared * (runs - 1) as f64 - (classes - 1) as f64) / (runs - classes) as f64
}

/// What chance alone makes of an output.
#[derive(Clone, Debug)]
pub struct Noise {
    probability: f64,
    known: Vec<(Vec<usize>, f64)>,
}

impl Noise {
    /// For the largest of a number of inputs.
    pub fn among(inputs: usize) -> Self {
        Self { probability: super::LEVEL.powf(1.0 / inputs.max(1) as f64), known: Vec::new() }
    }

    /// The share that an input without influence exceeds once in twenty campaigns; remembered for equal classes, so ask
    /// one [`Noise`] about one output.
    pub fn level(&mut self, sizes: &[usize], y: &[f64]) -> Option<f64> {
        if let Some((_, level)) = self.known.iter().find(|(known, _)| known == sizes) {
            return Some(*level);
        }
        let (runs, classes) = (y.len(), sizes.len());
        let mean = (classes - 1) as f64 / (runs - 1) as f64;
        let normal = 0.5 * (runs - 1) as f64;
        let sum = if runs > MOST_SHUFFLED { normal } else { shape_sum(mean, sizes, y)?.unwrap_or(normal) };
        let level = corrected(beta_quantile(self.probability, mean * sum, (1.0 - mean) * sum)?, runs, classes);
        self.known.push((sizes.to_vec(), level));
        Some(level)
    }
}

/// a + b of the beta distribution of shuffled η²; an inner none where the shuffles do not differ.
fn shape_sum(mean: f64, sizes: &[usize], y: &[f64]) -> Option<Option<f64>> {
    let centre = Centre::of(y)?;
    let labels: Vec<usize> = sizes.iter().enumerate().flat_map(|(k, size)| std::iter::repeat_n(k, *size)).collect();
    let (mut y, mut state) = (y.to_vec(), 0);
    let mut squares = 0.0;
    for _ in 0..SHUFFLES {
        shuffle(&mut y, &mut state);
        let ratio = correlation_ratio(labels.iter().copied().zip(y.iter().copied()), sizes, &centre);
        squares += (ratio - mean).powi(2);
    }
    let variance = squares / SHUFFLES as f64;
    let sum = mean * (1.0 - mean) / variance - 1.0;
    Some((sum.is_finite() && sum > 0.0).then_some(sum))
}

/// Fisher and Yates' shuffle, drawing from Steele, Lea & Flood's SplitMix64.
fn shuffle(values: &mut [f64], state: &mut u64) {
    for last in (1..values.len()).rev() {
        let pick = (u128::from(splitmix(state)) * (last as u128 + 1)) >> 64;
        values.swap(last, pick as usize);
    }
}

fn splitmix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use std::f64::consts::PI;

    /// Uniform numbers in [0, 1).
    fn uniform(count: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        (0..count).map(|_| (splitmix(&mut state) >> 11) as f64 / (1_u64 << 53) as f64).collect()
    }

    fn parting(x: &[f64]) -> Parting {
        Parting::of_ranks(&crate::stats::ranks(x), class_count(x.len()).unwrap()).unwrap()
    }

    #[test]
    fn ishigamis_function_has_its_known_indices() {
        // y = sin a + 7 sin² b + 0.1 c⁴ sin a on [−π, π]³: 0.3139, 0.4424, 0.
        let inputs: Vec<Vec<f64>> =
            (1..4).map(|k| uniform(20_000, k).iter().map(|u| PI * (2.0 * u - 1.0)).collect()).collect();
        let y: Vec<f64> = (0..20_000)
            .map(|i| (inputs[0][i], inputs[1][i], inputs[2][i]))
            .map(|(a, b, c)| a.sin() + 7.0 * b.sin().powi(2) + 0.1 * c.powi(4) * a.sin())
            .collect();
        let mut noise = Noise::among(3);
        for (x, expected) in inputs.iter().zip([0.3139, 0.4424, 0.0]) {
            let (share, parting) = (share_of_variance(x, &y).unwrap(), parting(x));
            // Standard error at 20 000 runs: about 0.006.
            assert!((share - expected).abs() < 0.02, "{share} instead of {expected}");
            let level = noise.level(&parting.sizes, &y).unwrap();
            assert!((share > level) == (expected > 0.0) && level > 0.0 && level < 0.01, "{level}");
        }
    }

    #[test]
    fn a_linear_model_shares_by_squares_of_its_slopes() {
        let inputs: Vec<Vec<f64>> = (1..4).map(|k| uniform(3000, 10 + k)).collect();
        let y: Vec<f64> = (0..3000).map(|i| 3.0 * inputs[0][i] + 2.0 * inputs[1][i] + inputs[2][i]).collect();
        for (x, slope) in inputs.iter().zip([3.0, 2.0, 1.0_f64]) {
            let share = share_of_variance(x, &y).unwrap();
            assert!((share - slope * slope / 14.0).abs() < 0.03, "{share} for slope {slope}");
        }
    }

    #[test]
    fn an_input_of_few_values_has_a_class_for_each() {
        let x: Vec<f64> = (0..300).map(|i| f64::from(i % 3)).collect();
        assert!(parting(&x).sizes == [100, 100, 100] && (share_of_variance(&x, &x).unwrap() - 1.0).abs() < 1e-12);
        let skewed: Vec<f64> = (0..300).map(|i| if i < 250 { 0.0 } else { f64::from(i) }).collect();
        let Parting { labels, sizes } = parting(&skewed);
        assert!(labels[..250].iter().all(|l| *l == labels[0]) && sizes.iter().sum::<usize>() == 300);
    }

    #[test]
    fn one_campaign_in_twenty_shows_chance_as_an_effect() {
        // A rare failure and five inputs without influence: the largest passes the level in about 5 % of campaigns.
        let mut alarms = 0;
        for campaign in 0..400_u64 {
            let y: Vec<f64> = uniform(200, 7000 + campaign).iter().map(|u| f64::from(*u < 0.06)).collect();
            let mut noise = Noise::among(5);
            let is_alarm = (0..5).any(|k| {
                let x = uniform(200, 100_000 + 100 * campaign + k);
                share_of_variance(&x, &y).unwrap() > noise.level(&parting(&x).sizes, &y).unwrap()
            });
            alarms += usize::from(is_alarm);
        }
        // 20 expected, standard deviation 4.4.
        assert!((6..=36).contains(&alarms), "{alarms}");
    }

    #[test]
    fn too_few_runs_or_a_constant_have_no_share() {
        assert_eq!(share_of_variance(&[1.0, 2.0, 3.0], &[1.0, 2.0, 3.0]), None);
        let x = uniform(50, 3);
        assert_eq!(share_of_variance(&x, &[2.0; 50]), None);
        assert_eq!(share_of_variance(&[2.0; 50], &x), None);
        assert_eq!((class_count(9), class_count(10), class_count(500)), (None, Some(2), Some(16)));
    }
}
