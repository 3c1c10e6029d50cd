//! Minimising a rough function of a few parameters: evolution with an adapted covariance (CMA-ES).
//!
//! The error of a toss jumps where a corner hits a moment earlier, so slopes say nothing; a cloud of candidates does.
//! Each generation draws `population` points around the mean, ranks them, moves the mean to the weighted best half and
//! adapts size and shape of the cloud (Hansen and Ostermeier 2001, with the constants of Hansen's tutorial, 2016,
//! without negative weights). Ranks only: the function's scale does not matter. Same seed, same bits.

use spatial::nalgebra::{DMatrix, DVector};

/// How long and how wide to search.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// Seed of the draws.
    pub seed: u64,
    /// Standard deviation of the first cloud, in the units of the parameters.
    pub spread: f64,
    /// Candidates in a generation, at least 4.
    pub population: usize,
    /// Generations.
    pub generations: usize,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The parameters.
    pub x: Vec<f64>,
    /// The function there.
    pub cost: f64,
    /// How often it was asked.
    pub evaluations: usize,
}

/// Constants of the adaptation, by dimension and weights.
struct Rates {
    weights: Vec<f64>,
    mass: f64,
    path_c: f64,
    path_s: f64,
    rank_one: f64,
    rank_many: f64,
    damping: f64,
    length: f64,
}

impl Rates {
    fn new(n: f64, population: usize) -> Self {
        let parents = (population / 2).max(2);
        let raw: Vec<f64> = (1..=parents).map(|i| (parents as f64 + 0.5).ln() - (i as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let mass = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let path_s = (mass + 2.0) / (n + mass + 5.0);
        let rank_one = 2.0 / ((n + 1.3).powi(2) + mass);
        let rank_many = (2.0 * (mass - 2.0 + 1.0 / mass) / ((n + 2.0).powi(2) + mass)).min(1.0 - rank_one);
        Self {
            mass,
            path_c: (4.0 + mass / n) / (n + 4.0 + 2.0 * mass / n),
            path_s,
            rank_one,
            rank_many,
            damping: 1.0 + path_s + 2.0 * (((mass - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0),
            length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            weights,
        }
    }
}

/// The cloud.
struct Cloud {
    mean: DVector<f64>,
    size: f64,
    shape: DMatrix<f64>,
    path_c: DVector<f64>,
    path_s: DVector<f64>,
}

impl Cloud {
    /// Principal axes and their lengths.
    fn axes(&self) -> (DMatrix<f64>, DVector<f64>) {
        let eigen = self.shape.clone().symmetric_eigen();
        (eigen.eigenvectors, eigen.eigenvalues.map(|v| v.max(1e-20).sqrt()))
    }

    /// Moves and reshapes the cloud after a generation; `best` are the better half's steps, best first.
    fn adapt(&mut self, rates: &Rates, generation: usize, axes: &(DMatrix<f64>, DVector<f64>), best: &[DVector<f64>]) {
        let n = self.mean.len();
        let step = best.iter().zip(&rates.weights).fold(DVector::zeros(n), |sum, (y, w)| sum + y * *w);
        self.mean += &step * self.size;
        let white = &axes.0 * (axes.0.tr_mul(&step)).component_div(&axes.1);
        let gain_s = (rates.path_s * (2.0 - rates.path_s) * rates.mass).sqrt();
        self.path_s = &self.path_s * (1.0 - rates.path_s) + white * gain_s;
        let expected = (1.0 - (1.0 - rates.path_s).powf(2.0 * (generation as f64 + 1.0))).sqrt();
        let is_calm = self.path_s.norm() / expected < (1.4 + 2.0 / (n as f64 + 1.0)) * rates.length;
        let (calm, gain_c) = (f64::from(is_calm), (rates.path_c * (2.0 - rates.path_c) * rates.mass).sqrt());
        self.path_c = &self.path_c * (1.0 - rates.path_c) + &step * (calm * gain_c);
        let kept = 1.0 - rates.rank_one - rates.rank_many
            + rates.rank_one * (1.0 - calm) * rates.path_c * (2.0 - rates.path_c);
        let mut shape = &self.shape * kept + &self.path_c * self.path_c.transpose() * rates.rank_one;
        for (y, w) in best.iter().zip(&rates.weights) {
            shape += y * y.transpose() * (rates.rank_many * w);
        }
        self.shape = (&shape + shape.transpose()) * 0.5;
        self.size *= (rates.path_s / rates.damping * (self.path_s.norm() / rates.length - 1.0)).exp();
    }
}

impl Search {
    /// Searches from `start`. The better of the luckiest candidate and the last cloud's centre is returned.
    pub fn minimise(&self, start: &[f64], mut cost: impl FnMut(&[f64]) -> f64) -> Found {
        let n = start.len();
        let rates = Rates::new(n as f64, self.population);
        let mut draw = Normal { state: self.seed, spare: None };
        let mut cloud = Cloud {
            mean: DVector::from_column_slice(start),
            size: self.spread,
            shape: DMatrix::identity(n, n),
            path_c: DVector::zeros(n),
            path_s: DVector::zeros(n),
        };
        let mut found = Found { x: start.to_vec(), cost: cost(start), evaluations: 1 };
        for generation in 0..self.generations {
            let axes = cloud.axes();
            let mut steps: Vec<(f64, DVector<f64>)> = (0..self.population)
                .map(|_| {
                    let white = DVector::from_fn(n, |_, _| draw.next());
                    let step = &axes.0 * white.component_mul(&axes.1);
                    let x = &cloud.mean + &step * cloud.size;
                    (found.ask(x.as_slice(), &mut cost), step)
                })
                .collect();
            steps.sort_by(|a, b| a.0.total_cmp(&b.0));
            let best: Vec<_> = steps.into_iter().take(rates.weights.len()).map(|(_, step)| step).collect();
            cloud.adapt(&rates, generation, &axes, &best);
        }
        found.ask(cloud.mean.as_slice(), &mut cost);
        found
    }
}

impl Found {
    /// Asks the function, and keeps what is better.
    fn ask(&mut self, x: &[f64], cost: &mut impl FnMut(&[f64]) -> f64) -> f64 {
        let value = cost(x);
        self.evaluations += 1;
        if value < self.cost {
            (self.cost, self.x) = (value, x.to_vec());
        }
        if value.is_nan() { f64::INFINITY } else { value }
    }
}

/// Normal deviates: SplitMix64 (Steele, Lea and Flood 2014) and Box and Muller's transform.
struct Normal {
    state: u64,
    spare: Option<f64>,
}

impl Normal {
    /// Uniform in (0, 1).
    fn uniform(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn next(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let (radius, angle) = ((-2.0 * self.uniform().ln()).sqrt(), std::f64::consts::TAU * self.uniform());
        self.spare = Some(radius * angle.sin());
        radius * angle.cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: Search = Search { seed: 3, spread: 0.5, population: 10, generations: 250 };

    /// Rosenbrock's valley: narrow, bent, 1 at the bottom's (1, 1, 1).
    fn valley(x: &[f64]) -> f64 {
        x.windows(2).map(|w| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2)).sum()
    }

    #[test]
    fn the_bottom_of_a_bent_valley_is_found() {
        let found = SEARCH.minimise(&[-1.2, 1.0, 0.5], valley);
        assert!(found.cost < 1e-9, "{found:?}");
        assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-3));
    }

    #[test]
    fn the_same_seed_gives_the_same_bits() {
        let short = Search { generations: 20, ..SEARCH };
        assert_eq!(short.minimise(&[0.0, 0.0], valley), short.minimise(&[0.0, 0.0], valley));
    }
}
