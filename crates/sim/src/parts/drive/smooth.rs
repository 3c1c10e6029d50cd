//! The motion behind noisy samples: a smoothing spline, with a stiffness chosen from the noise.
//!
//! The jerk of the path is taken for white noise, the sample for the position plus white noise of variance r:
//!
//!   (x, v, a)⁺ = F (x, v, a) + w,   cov w = λ r Q(h),   y = x + n,   var n = r
//!
//!   F = [1 h h²/2; 0 1 h; 0 0 1],   Q = [h⁵/20 h⁴/8 h³/6; · h³/3 h²/2; · · h],   h in mean sample distances
//!
//! The mean of this path given all samples is the quintic smoothing spline, the minimum of Σ (y − x)² + λ⁻¹ ∫ x‴² dt
//! (Wahba 1978), between samples the quintic that position, velocity and acceleration at both ends fix. It takes one pass
//! of a Kalman filter and one backwards (Durbin and Koopman's form, which inverts no matrix); samples may be
//! unevenly spaced. λ is the most likely one: the innovations are white then, and nothing is left in the residual that the
//! noise does not explain. The first three samples start the filter exactly (a flat prior).
//!
//! Valid for a path without jumps of velocity. Rounding counts as noise: σ² + q²/12.

/// State of the path at a sample: position, velocity, acceleration.
type Point = [f64; 3];
/// Symmetric 3 × 3, full.
type Cov = [[f64; 3]; 3];

/// Bounds of log₁₀ λ, and the points of the coarse search.
const SEARCH: (f64, f64, usize) = (-18.0, 3.0, 15);
/// Steps of the golden section after it.
const REFINEMENTS: usize = 14;
/// Noise below this share of the whole travel is rounding of the numbers themselves.
const ROUNDING: f64 = 1e-13;

/// The path at every one of at least four samples of increasing time.
pub(crate) fn smooth(times: &[f64], values: &[f64], noise: Option<f64>) -> Vec<Point> {
    let unit = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let spans: Vec<f64> = times.windows(2).map(|t| (t[1] - t[0]) / unit).collect();
    let samples: Vec<f64> = values.iter().map(|x| x - values[0]).collect();
    let travel = samples.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let known = noise.map(|s| (s * s).max((ROUNDING * travel).powi(2))).filter(|r| *r > 0.0);
    let filter = Filter { spans: &spans, samples: &samples };
    let stiffness = filter.most_likely(known, ROUNDING * travel);
    let mut passed = Vec::with_capacity(samples.len());
    let fit = filter.run(stiffness, |step| passed.push(step));
    let mut states = filter.run_back(&passed, fit.start);
    for state in &mut states {
        *state = [state[0] + values[0], state[1] / unit, state[2] / (unit * unit)];
    }
    states
}

/// Samples, and the distance of each from the one before.
struct Filter<'a> {
    spans: &'a [f64],
    samples: &'a [f64],
}

/// One sample as the filter met it: prediction, its covariance (in units of r), innovation and its variance.
#[derive(Clone, Copy)]
struct Passed {
    at: Point,
    cov: Cov,
    miss: f64,
    variance: f64,
}

/// Sums of the likelihood, and the start.
struct Fit {
    sum_sq: f64,
    sum_log: f64,
    count: f64,
    start: (Point, Cov),
}

impl Filter<'_> {
    /// log₁₀-search for the most likely λ.
    fn most_likely(&self, known: Option<f64>, floor: f64) -> f64 {
        let cost = |log: f64| {
            let fit = self.run(10.0_f64.powf(log), |_| {});
            match known {
                Some(r) => fit.sum_sq / r + fit.sum_log,
                None => {
                    fit.count * (fit.sum_sq / fit.count).max(floor * floor).max(f64::MIN_POSITIVE).ln() + fit.sum_log
                }
            }
        };
        let (low, high, points) = SEARCH;
        let pace = (high - low) / (points - 1) as f64;
        let coarse = (0..points).map(|i| low + i as f64 * pace);
        let best = coarse.map(|log| (cost(log), log)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(low, |b| b.1);
        10.0_f64.powf(golden_section((best - pace).max(low), (best + pace).min(high), cost))
    }

    /// The filter from the third sample on; every later one goes to `visit`.
    fn run(&self, stiffness: f64, mut visit: impl FnMut(Passed)) -> Fit {
        let (mut at, mut cov) = self.start();
        let mut fit = Fit { sum_sq: 0.0, sum_log: 0.0, count: 0.0, start: (at, cov) };
        for (sample, h) in self.samples.iter().zip(std::iter::once(&0.0).chain(self.spans)).skip(3) {
            (at, cov) = (carried(&at, *h), predicted(&cov, *h, stiffness));
            let (miss, variance) = (sample - at[0], cov[0][0] + 1.0);
            visit(Passed { at, cov, miss, variance });
            fit.sum_sq += miss * miss / variance;
            fit.sum_log += variance.ln();
            fit.count += 1.0;
            let gain = cov.map(|row| row[0] / variance);
            for i in 0..3 {
                at[i] += gain[i] * miss;
                for j in 0..3 {
                    cov[i][j] -= gain[i] * gain[j] * variance;
                }
            }
        }
        fit
    }

    /// The parabola through the first three samples, at the third, and what their noise makes of it.
    fn start(&self) -> (Point, Cov) {
        let (h1, h2) = (self.spans[0], self.spans[1]);
        let h = h1 + h2;
        // Lagrange's basis and its derivatives at the third sample.
        let rows = [
            [0.0, 0.0, 1.0],
            [h2 / (h1 * h), -h / (h1 * h2), (h + h2) / (h * h2)],
            [2.0 / (h1 * h), -2.0 / (h1 * h2), 2.0 / (h * h2)],
        ];
        let at = rows.map(|row| (0..3).map(|k| row[k] * self.samples[k]).sum());
        let cov = rows.map(|a| rows.map(|b| (0..3).map(|k| a[k] * b[k]).sum()));
        (at, cov)
    }

    /// What all samples say of every one.
    fn run_back(&self, passed: &[Passed], start: (Point, Cov)) -> Vec<Point> {
        let mut states = vec![[0.0; 3]; self.samples.len()];
        let mut adjoint = [0.0; 3];
        for (k, step) in passed.iter().enumerate().rev() {
            // r ← Hᵀ e/S + (I − K H)ᵀ r, at the prediction; then back through F.
            let gain: f64 = (0..3).map(|i| step.cov[i][0] * adjoint[i]).sum();
            adjoint[0] += (step.miss - gain) / step.variance;
            states[k + 3] = added(&step.at, &step.cov, &adjoint);
            let h = self.spans[k + 2];
            adjoint = [adjoint[0], adjoint[1] + h * adjoint[0], adjoint[2] + h * (adjoint[1] + 0.5 * h * adjoint[0])];
        }
        states[2] = added(&start.0, &start.1, &adjoint);
        states[1] = carried(&states[2], -self.spans[1]);
        states[0] = carried(&states[1], -self.spans[0]);
        states
    }
}

fn added(at: &Point, cov: &Cov, adjoint: &Point) -> Point {
    [0, 1, 2].map(|i| at[i] + (0..3).map(|j| cov[i][j] * adjoint[j]).sum::<f64>())
}

/// F (x, v, a).
fn carried(at: &Point, h: f64) -> Point {
    [at[0] + h * (at[1] + 0.5 * h * at[2]), at[1] + h * at[2], at[2]]
}

/// F P Fᵀ + λ Q.
fn predicted(p: &Cov, h: f64, stiffness: f64) -> Cov {
    let rows = [0, 1, 2].map(|j| carried(&[p[0][j], p[1][j], p[2][j]], h)); // F P, by columns
    let turned = [0, 1, 2].map(|i| carried(&[rows[0][i], rows[1][i], rows[2][i]], h)); // rows of F P Fᵀ
    let (h2, q) = (h * h, stiffness * h);
    let (q13, q12, q23) = (q * h2 / 6.0, q * h2 * h / 8.0, q * h / 2.0);
    let noise = [[q * h2 * h2 / 20.0, q12, q13], [q12, q * h2 / 3.0, q23], [q13, q23, q]];
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (turned[i][j] + turned[j][i]) + noise[i][j]))
}

/// The lowest point of a function of one valley.
fn golden_section(mut low: f64, mut high: f64, cost: impl Fn(f64) -> f64) -> f64 {
    const RATIO: f64 = 0.618_033_988_749_894_9;
    let (mut a, mut b) = (high - RATIO * (high - low), low + RATIO * (high - low));
    let (mut cost_a, mut cost_b) = (cost(a), cost(b));
    for _ in 0..REFINEMENTS {
        if cost_a < cost_b {
            (high, b, cost_b) = (b, a, cost_a);
            a = high - RATIO * (high - low);
            cost_a = cost(a);
        } else {
            (low, a, cost_a) = (a, b, cost_b);
            b = low + RATIO * (high - low);
            cost_b = cost(b);
        }
    }
    0.5 * (low + high)
}
