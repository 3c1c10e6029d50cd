//! Uniform numbers in (0, 1) for input k of run i, each a pure function of (seed, i, k): nothing is drawn in sequence, so no
//! order, no thread and no number of runs can change a sample.
//!
//! | sampling | u |
//! | --- | --- |
//! | random | first 53 bits of SHA-256(seed, i, name, component), at the middle of their cell |
//! | Latin hypercube | (π(i mod n) + jitter)/n; π: a permutation of the n strata, one for each input and each block of n runs |
//! | Sobol | Owen-scrambled Sobol' point i in dimension k (Burley 2020, J. Comput. Graph. Tech. 9(4)), 2¹⁶ points a scramble |
//!
//! π is a Feistel network over SHA-256 with cycle walking (Black and Rogaway 2002), so that one value of it costs no table.

use sha2::{Digest, Sha256};

/// Cells of the unit interval: 2⁵³, so that a uniform number is exact.
const CELLS: f64 = 9_007_199_254_740_992.0;
/// Points of one scrambled Sobol' sequence.
const SOBOL_POINTS: u64 = 1 << 16;
/// Spacing of the generator's single-precision numbers, filled by a jitter.
const SOBOL_CELL: f64 = 1.0 / 16_777_216.0;
/// Dimensions that the Sobol' generator has.
pub(crate) const SOBOL_DIMENSIONS: usize = 256;
/// Rounds of the Feistel network; four make a permutation that no test tells from a random one (Luby and Rackoff 1988).
const ROUNDS: u32 = 4;

/// Which uniform number is wanted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ask<'a> {
    /// Seed of the campaign.
    pub(crate) seed: u64,
    /// Index of the run.
    pub(crate) run: u64,
    /// Name of the input: its paths.
    pub(crate) name: &'a str,
    /// Component of a vector.
    pub(crate) component: usize,
}

impl Ask<'_> {
    fn digest(&self, purpose: &str, counter: u64) -> u64 {
        let mut hash = Sha256::new();
        for number in [self.seed, counter, self.component as u64] {
            hash.update(number.to_le_bytes());
        }
        hash.update(purpose.as_bytes());
        hash.update([0]);
        hash.update(self.name.as_bytes());
        let digest = hash.finalize();
        digest.iter().take(8).fold(0, |word, byte| (word << 8) | u64::from(*byte))
    }

    /// An independent uniform number.
    pub(crate) fn random(&self) -> f64 {
        middle(self.digest("u", self.run))
    }

    /// A number of a Latin hypercube of `strata` runs.
    pub(crate) fn latin(&self, strata: u64) -> f64 {
        let (block, place) = (self.run / strata, self.run % strata);
        let stratum = self.permute(block, place, strata);
        (stratum as f64 + self.random()) / strata as f64
    }

    /// A number of a scrambled Sobol' sequence; `dimension` counts the campaign's uniform numbers.
    pub(crate) fn sobol(&self, dimension: usize) -> f64 {
        let block = self.run / SOBOL_POINTS;
        let scramble = Ask { name: "", component: 0, ..*self }.digest("sobol", block) as u32;
        let cell = sobol_burley::sample((self.run % SOBOL_POINTS) as u32, dimension as u32, scramble);
        (f64::from(cell) + SOBOL_CELL * self.random()).clamp(f64::MIN_POSITIVE, 1.0 - 1.0 / CELLS)
    }

    /// Image of `place` among `n` under a random permutation of a block.
    fn permute(&self, block: u64, place: u64, n: u64) -> u64 {
        let half = (u64::BITS - n.saturating_sub(1).leading_zeros()).div_ceil(2).max(1);
        let mask = (1_u64 << half) - 1;
        let mut image = place;
        loop {
            let (mut left, mut right) = (image >> half, image & mask);
            for round in 0..ROUNDS {
                let key = Ask { run: block, ..*self };
                let word = key.digest("permutation", (block << 8) | u64::from(round));
                let mixed = splitmix(word ^ right) & mask;
                (left, right) = (right, left ^ mixed);
            }
            image = (left << half) | right;
            if image < n {
                return image;
            }
        }
    }
}

/// The middle of the cell that the first 53 bits name.
fn middle(word: u64) -> f64 {
    ((word >> 11) as f64 + 0.5) / CELLS
}

/// Finaliser of SplitMix64 (Steele, Lea and Flood 2014): every bit of the input moves every bit of the output.
fn splitmix(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// Seed of run `run`: below 2⁶³, as a scenario's seed must be.
pub(crate) fn run_seed(seed: u64, run: u64) -> u64 {
    Ask { seed, run, name: "", component: 0 }.digest("seed", run) >> 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ask(run: u64, name: &str) -> Ask<'_> {
        Ask { seed: 7, run, name, component: 0 }
    }

    #[test]
    fn latin_hypercube_takes_every_stratum_once_in_every_block() {
        for n in [2_u64, 3, 10, 64, 1000] {
            for block in 0..3 {
                let mut strata: Vec<u64> =
                    (0..n).map(|k| (ask(block * n + k, "a").latin(n) * n as f64) as u64).collect();
                strata.sort_unstable();
                assert_eq!(strata, (0..n).collect::<Vec<_>>(), "n = {n}, block {block}");
            }
        }
    }

    #[test]
    fn random_numbers_are_uniform_and_independent_between_inputs() {
        let n = 4000;
        let [a, b]: [Vec<f64>; 2] = ["a", "b"].map(|name| (0..n).map(|run| ask(run, name).random()).collect());
        let mean = |x: &[f64]| x.iter().sum::<f64>() / n as f64;
        // Standard error of the mean of a uniform number: 1/√(12 n).
        let error = 1.0 / (12.0 * n as f64).sqrt();
        assert!((mean(&a) - 0.5).abs() < 4.0 * error && (mean(&b) - 0.5).abs() < 4.0 * error);
        let product: f64 = a.iter().zip(&b).map(|(x, y)| 12.0 * (x - 0.5) * (y - 0.5)).sum::<f64>() / n as f64;
        assert!(product.abs() < 4.0 / (n as f64).sqrt(), "correlation {product}");
    }

    #[test]
    fn sobol_points_fill_the_square_more_evenly_than_chance() {
        let n = 1024;
        // Of 1024 points of a (0, 2)-sequence every cell of 32 × 32 holds one.
        let mut cells = vec![0; n as usize];
        for run in 0..n {
            let [x, y] = [0, 1].map(|d| ask(run, "a").sobol(d));
            cells[(x * 32.0) as usize * 32 + (y * 32.0) as usize] += 1;
        }
        assert!(cells.iter().all(|c| *c == 1));
    }

    #[test]
    fn seeds_of_runs_differ_and_fit_a_scenario() {
        let mut seeds: Vec<u64> = (0..1000).map(|run| run_seed(3, run)).collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 1000);
        assert!(seeds.iter().all(|s| *s < 1 << 63));
    }
}
