//! The fit of a rate sensor to the positions: a Kalman filter over constants, linear in them.
//!
//! State: δθ (3), the error of the position that the readings predict from the last measured one, and δp, the figures'
//! deviations from the model about which the equations are linear. In the body frame for an orientation (q = q̂ exp δθ,
//! Φ = exp(−ω̂ dt)), in the world for a vector (Φ = 1):
//!
//!   δθ⁺ = Φ δθ + G δp dt + noise,   columns of G: C's entry (i, j): eᵢ uⱼ;  b's: −C eᵢ;  τ: C u̇;   u = y − b
//!
//! with noise C σ² Cᵀ · dt_y dt from white readings dt_y apart. After each measured position δθ is folded into the
//! prediction, so that it stays small however long the run; δp only ever multiplies. The innovations' sum of squares
//! over their variances is χ² where the model is right. Relinearised until the figures stand still.

use super::pairs::Noise;
use super::track::{Measured, Track};
use spatial::nalgebra::{DMatrix, DVector};
use spatial::{Mat3, Rot, Vec3, exp_rotation, log_rotation};

/// A rate sensor: true rate = C (reading(t + τ) − b).
#[derive(Clone, Copy, Debug)]
pub(super) struct Model {
    pub(super) c: Mat3,
    pub(super) b: Vec3,
    pub(super) tau: f64,
}

impl Model {
    /// The sensor as it should be.
    pub(super) const IDEAL: Self =
        Self { c: Mat3::new(1., 0., 0., 0., 1., 0., 0., 0., 1.), b: Vec3::new(0., 0., 0.), tau: 0.0 };
}

/// A fitted figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Figure {
    C(usize, usize),
    B(usize),
    Tau,
}

/// Result of a fit.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub(super) model: Model,
    /// Sum of squared innovations over their variances, ideal sensor and fitted one.
    pub(super) before: f64,
    pub(super) after: f64,
    pub(super) samples: usize,
    figures: Vec<Figure>,
    prior: Vec<f64>,
    covariance: DMatrix<f64>,
}

/// Rounds of relinearisation; a near start needs two.
const ROUNDS: usize = 5;
/// A figure's standard error must be below this share of its prior width to count as shown by the data.
const SHOWN: f64 = 0.1;
/// How far above the smoothed reading's noise the motion must be to show a scale or a delay.
const EXCITED: f64 = 10.0;
/// Largest delay looked for, s, as a standard deviation.
const DELAY: f64 = 0.3;

/// Fits the sensor of a pair to all of its runs.
pub(super) fn fit(axes: usize, tracks: &[Track], noise: &Noise, start: Model) -> Fit {
    let figures = figures(axes, tracks, noise);
    let (before, samples, _, _) = run(axes, tracks, noise, &Model::IDEAL, &[], &[]);
    let is_better = || run(axes, tracks, noise, &start, &[], &[]).0 < 0.5 * before;
    let start = if start.c == Model::IDEAL.c || is_better() { start } else { Model::IDEAL };
    let mut model = start;
    let mut covariance = DMatrix::zeros(figures.len(), figures.len());
    let size = typical_rate(tracks);
    let prior: Vec<f64> = figures.iter().map(|figure| width(*figure, &start, size, noise)).collect();
    for _ in 0..ROUNDS {
        let (_, _, change, found) = run(axes, tracks, noise, &model, &figures, &prior);
        covariance = found;
        apply(&mut model, &figures, &change);
        let moved = change.iter().enumerate().any(|(i, x)| x.abs() > 0.01 * covariance[(i, i)].sqrt());
        if !moved {
            break;
        }
    }
    let (after, ..) = run(axes, tracks, noise, &model, &[], &[]);
    // Where the innovations stay larger than the noise explains, the figures are as much less sure.
    covariance *= (after / samples.max(1) as f64).max(1.0);
    Fit { model, before, after, samples, figures, prior, covariance }
}

/// The figures that the motion can show at all.
fn figures(axes: usize, tracks: &[Track], noise: &Noise) -> Vec<Figure> {
    let mut figures = Vec::new();
    let worst = |noise: &dyn Fn(&Track) -> f64| tracks.iter().map(noise).fold(0.0, f64::max);
    let quiet = worst(&|track| track.value_noise(noise.rate));
    for j in 0..axes {
        if rms(tracks, |track| &track.smooth, j) > EXCITED * quiet {
            figures.extend((0..axes).map(|i| Figure::C(i, j)));
        }
    }
    figures.extend((0..axes).map(Figure::B));
    let quiet = worst(&|track| track.slope_noise(noise.rate));
    if (0..axes).any(|j| rms(tracks, |track| &track.slopes, j) > EXCITED * quiet) {
        figures.push(Figure::Tau);
    }
    figures
}

fn rms(tracks: &[Track], values: fn(&Track) -> &Vec<Vec3>, axis: usize) -> f64 {
    let count: usize = tracks.iter().map(|track| values(track).len()).sum();
    let square: f64 = tracks.iter().flat_map(values).map(|v| v[axis] * v[axis]).sum();
    (square / count.max(1) as f64).sqrt()
}

fn typical_rate(tracks: &[Track]) -> f64 {
    (0..3).map(|axis| rms(tracks, |track| &track.smooth, axis)).fold(0.0, f64::max)
}

/// Prior standard deviation of a figure: wide, so that only what the motion cannot show is held by it.
fn width(figure: Figure, start: &Model, size: f64, noise: &Noise) -> f64 {
    match figure {
        Figure::C(..) => start.c.norm().max(1e-6),
        Figure::B(_) => 3.0 * size + 100.0 * noise.rate,
        Figure::Tau => DELAY,
    }
}

fn apply(model: &mut Model, figures: &[Figure], change: &DVector<f64>) {
    for (figure, x) in figures.iter().zip(change.iter()) {
        match *figure {
            Figure::C(i, j) => model.c[(i, j)] += x,
            Figure::B(i) => model.b[i] += x,
            Figure::Tau => model.tau = (model.tau + x).clamp(-3.0 * DELAY, 3.0 * DELAY),
        }
    }
}

/// One pass over all runs: sum of squares, number of scalars, the figures' changes and their covariance.
fn run(
    axes: usize,
    tracks: &[Track],
    noise: &Noise,
    model: &Model,
    figures: &[Figure],
    prior: &[f64],
) -> (f64, usize, DVector<f64>, DMatrix<f64>) {
    let n = figures.len();
    let mut filter = Filter {
        axes,
        noise: *noise,
        model: *model,
        figures,
        x: DVector::zeros(3 + n),
        p: DMatrix::zeros(3 + n, 3 + n),
        squares: 0.0,
        samples: 0,
    };
    for (i, width) in prior.iter().enumerate() {
        filter.p[(3 + i, 3 + i)] = width * width;
    }
    tracks.iter().for_each(|track| filter.follow(track));
    let (x, p) = (filter.x.rows(3, n).into_owned(), filter.p.view((3, 3), (n, n)).into_owned());
    (filter.squares, filter.samples, x, p)
}

struct Filter<'a> {
    axes: usize,
    noise: Noise,
    model: Model,
    figures: &'a [Figure],
    x: DVector<f64>,
    p: DMatrix<f64>,
    squares: f64,
    samples: usize,
}

/// What happens to the position error from one measured position to the next.
struct Transition {
    /// Predicted change of position: a displacement, or a rotation in the body frame.
    vector: Vec3,
    rotation: Rot,
    phi: Mat3,
    g: DMatrix<f64>,
    q: Mat3,
}

impl Filter<'_> {
    fn follow(&mut self, track: &Track) {
        let mut before: Option<(usize, Position)> = None;
        for k in 0..track.times.len() {
            let step = before.and_then(|(from, estimate)| Some((estimate, self.transition(track, from, k)?)));
            let estimate = match step {
                Some((estimate, step)) => {
                    self.propagate(&step);
                    let predicted = estimate.moved(&step);
                    let folded = self.update(predicted.error_to(&Position::measured(track, k)));
                    predicted.corrected(folded)
                }
                None => {
                    self.anchor();
                    Position::measured(track, k)
                }
            };
            before = Some((k, estimate));
        }
    }

    /// Starts at a measured position: its error is the measurement's.
    fn anchor(&mut self) {
        let n = self.x.len();
        self.p.view_mut((0, 0), (3, n)).fill(0.0);
        self.p.view_mut((0, 0), (n, 3)).fill(0.0);
        for i in 0..self.axes {
            self.x[i] = 0.0;
            self.p[(i, i)] = self.noise.position * self.noise.position;
        }
    }

    /// Integrates the readings between two positions; none across a pause or beyond the readings.
    fn transition(&self, track: &Track, from: usize, to: usize) -> Option<Transition> {
        // The reading at t + τ belongs to t.
        let (mut t, end) = (track.times[from] + self.model.tau, track.times[to] + self.model.tau);
        let mut step = Transition {
            vector: Vec3::zeros(),
            rotation: Rot::identity(),
            phi: Mat3::identity(),
            g: DMatrix::zeros(3, self.figures.len()),
            q: Mat3::zeros(),
        };
        while t < end {
            let i = track.interval(t)?;
            let next = track.rate_times.get(i + 1)?.min(end);
            self.add_piece(track, i, (t, next), &mut step);
            t = next;
        }
        Some(step)
    }

    fn add_piece(&self, track: &Track, i: usize, (t, next): (f64, f64), step: &mut Transition) {
        let (dt, middle) = (next - t, 0.5 * (t + next));
        let (c, b) = (&self.model.c, &self.model.b);
        let omega = c * (track.at(&track.rates, i, middle) - b);
        let (u, slope) = (track.at(&track.smooth, i, middle) - b, track.at(&track.slopes, i, middle));
        let is_rotation = matches!(track.measured, Measured::Rotation(_));
        if is_rotation {
            let turn = exp_rotation(&(omega * dt));
            step.rotation *= turn;
            step.phi = turn.inverse().to_rotation_matrix().matrix() * step.phi;
            let turned = turn.inverse().to_rotation_matrix().matrix() * &step.g;
            step.g.copy_from(&turned);
        }
        step.vector += omega * dt;
        for (k, figure) in self.figures.iter().enumerate() {
            let column = match *figure {
                Figure::C(row, column) => Vec3::ith(row, u[column]),
                Figure::B(row) => -c.column(row),
                Figure::Tau => c * slope,
            };
            let sum = step.g.column(k) + column * dt;
            step.g.set_column(k, &sum);
        }
        let white = self.noise.rate * self.noise.rate * track.step * dt;
        let bend = track.bends[i].zip_map(&track.bends[(i + 1).min(track.bends.len() - 1)], f64::max);
        let bent = Mat3::from_diagonal(&bend.map(|x| x * x * dt * dt / 12.0));
        step.q += c * (Mat3::identity() * white + bent) * c.transpose();
    }

    fn propagate(&mut self, step: &Transition) {
        let n = self.x.len();
        let mut f = DMatrix::identity(n, n);
        f.view_mut((0, 0), (3, 3)).copy_from(&step.phi);
        f.view_mut((0, 3), (3, n - 3)).copy_from(&step.g);
        self.x = &f * &self.x;
        self.p = &f * &self.p * f.transpose();
        let mut corner = self.p.view_mut((0, 0), (3, 3));
        corner += step.q;
    }

    /// Takes a measured position in; returns the error of the prediction, which is folded into it.
    fn update(&mut self, innovation: Vec3) -> Vec3 {
        let r = self.noise.position * self.noise.position;
        for axis in 0..self.axes {
            let error = innovation[axis] - self.x[axis];
            let variance = self.p[(axis, axis)] + r;
            let gain = self.p.column(axis) / variance;
            let row = self.p.row(axis).into_owned();
            self.x += &gain * error;
            self.p -= &gain * row;
            self.squares += error * error / variance;
            self.samples += 1;
        }
        let folded = Vec3::new(self.x[0], self.x[1], self.x[2]);
        self.x.rows_mut(0, 3).fill(0.0);
        folded
    }
}

/// A position: of a joint or a point, or an orientation.
#[derive(Clone, Copy, Debug)]
enum Position {
    Vector(Vec3),
    Rotation(Rot),
}

impl Position {
    fn measured(track: &Track, k: usize) -> Self {
        match &track.measured {
            Measured::Vector(p) => Self::Vector(p[k]),
            Measured::Rotation(q) => Self::Rotation(q[k]),
        }
    }

    fn moved(self, step: &Transition) -> Self {
        match self {
            Self::Vector(p) => Self::Vector(p + step.vector),
            Self::Rotation(q) => Self::Rotation(q * step.rotation),
        }
    }

    fn corrected(self, error: Vec3) -> Self {
        match self {
            Self::Vector(p) => Self::Vector(p + error),
            Self::Rotation(q) => Self::Rotation(q * exp_rotation(&error)),
        }
    }

    /// The measured position less this one; of orientations in this one's body frame.
    fn error_to(self, measured: &Self) -> Vec3 {
        match (self, measured) {
            (Self::Vector(p), Self::Vector(m)) => m - p,
            (Self::Rotation(q), Self::Rotation(m)) => log_rotation(&(q.inverse() * m)),
            _ => Vec3::zeros(),
        }
    }
}

impl Fit {
    fn std_err(&self, figure: Figure) -> Option<f64> {
        let i = self.figures.iter().position(|f| *f == figure)?;
        let std_err = self.covariance[(i, i)].sqrt();
        (std_err < SHOWN * self.prior[i]).then_some(std_err)
    }

    /// Number of fitted figures.
    pub(super) fn parameters(&self) -> usize {
        self.figures.len()
    }

    /// Standard error of an entry of C.
    pub(super) fn std_err_c(&self, i: usize, j: usize) -> Option<f64> {
        self.std_err(Figure::C(i, j))
    }

    /// Standard error of a bias.
    pub(super) fn std_err_b(&self, i: usize) -> Option<f64> {
        self.std_err(Figure::B(i))
    }

    /// Standard error of the delay.
    pub(super) fn std_err_tau(&self) -> Option<f64> {
        self.std_err(Figure::Tau)
    }

    /// Rotation vector of C's rotation (C = R times a symmetric matrix), where its three planes are shown.
    pub(super) fn angle(&self) -> Option<[super::Estimate; 3]> {
        let svd = self.model.c.svd(true, true);
        let rotation = svd.u? * svd.v_t?;
        if rotation.determinant() < 0.0 {
            return None;
        }
        let matrix = spatial::nalgebra::Rotation3::from_matrix_unchecked(rotation);
        let vector = log_rotation(&Rot::from_rotation_matrix(&matrix));
        let size = self.model.c.determinant().abs().cbrt();
        let mut angles = [super::Estimate { value: 0.0, std_err: 0.0 }; 3];
        for (k, angle) in angles.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let variance = self.variance_of_difference(Figure::C(j, i), Figure::C(i, j))?;
            *angle = super::Estimate { value: vector[k], std_err: 0.5 * variance.sqrt() / size };
        }
        Some(angles)
    }

    fn variance_of_difference(&self, a: Figure, b: Figure) -> Option<f64> {
        self.std_err(a)?;
        self.std_err(b)?;
        let at = |figure| self.figures.iter().position(|f| *f == figure);
        let (i, j) = (at(a)?, at(b)?);
        Some(self.covariance[(i, i)] + self.covariance[(j, j)] - 2.0 * self.covariance[(i, j)])
    }
}
