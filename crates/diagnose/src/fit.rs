//! Fits a set of effects: Levenberg–Marquardt over segments, each with its own start.
//!
//! One step: K from [`crate::linear`] with the starts eliminated,
//!
//!   (A + λ diag A) δθ = −b,    A = K_θθ, b = K_θr,    δx₀ = −(taken_r + taken_θ δθ) of each segment,
//!
//! accepted by the full cost. A fit has converged when the linear model promises less than a small part of one noise variance; a
//! damping that has run away is not convergence, and is said.

use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::linear::{Segment, SegmentLinear, Stage, Variation, sum_reduced};
use crate::plant::{Built, Plant};
use crate::work::Until;
use nalgebra::{DMatrix, DVector};

/// What came of a fit.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The set at its best.
    pub set: EffectSet,
    /// The model of it.
    pub built: Built,
    /// Segments with their starts at their best.
    pub segments: Vec<Segment>,
    /// Squared norm of the residual, units of noise.
    pub cost: f64,
    /// Scalars in it.
    pub count: usize,
    /// What noise alone would make of the cost, starts and set given: the scalars by the weights of their segments.
    pub noise: f64,
    /// Free numbers: of the starts and of the set.
    pub freedom: usize,
    /// Inverse of A over the fitted slots.
    pub covariance: DMatrix<f64>,
    /// Whether the last step promised next to nothing.
    pub converged: bool,
    /// Linearisations made.
    pub iterations: usize,
    /// Cost per scalar that is not told from a wrong noise level.
    pub doubt: f64,
}

impl Fit {
    /// Cost above what noise alone would leave.
    pub fn excess(&self) -> f64 {
        self.cost - self.noise * (1.0 - self.freedom as f64 / self.count.max(1) as f64)
    }

    /// Standard deviation of the cost under noise alone.
    pub fn spread(&self) -> f64 {
        (2.0 * self.noise).sqrt()
    }

    /// Whether the cost is more than noise leaves.
    pub fn is_significant(&self) -> bool {
        self.excess() > (SIGMAS * self.spread()).max(self.least())
    }

    /// Cost that is not told from a wrong noise level.
    pub fn least(&self) -> f64 {
        self.doubt * self.noise
    }

    /// Whether any of a run is in it.
    pub fn has_run(&self, run: usize) -> bool {
        self.segments.iter().any(|s| s.run == run)
    }

    /// Root mean square of the residual, 1 for a perfect model.
    pub fn rms(&self) -> f64 {
        (self.cost / self.noise.max(f64::MIN_POSITIVE)).sqrt()
    }
}

/// Excess in standard deviations below which nothing is left to explain.
const SIGMAS: f64 = 4.0;

/// How far a fit goes.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Most linearisations.
    pub iterations: usize,
    /// Promised fall of the cost, as a share of the excess, below which it has converged.
    pub share: f64,
    /// The same in standard deviations of the cost under noise alone.
    pub floor: f64,
    /// Whether derivatives by the starts may be those of an earlier fit, as long as they lead downhill.
    pub reuse: bool,
    /// Damping of its first step.
    pub damping: f64,
}

/// Damping where the way may be far and bent: a full step may jump into another valley.
const CAUTIOUS: f64 = 1e-3;
/// Next to none, where little is left to go: a narrow valley is gone along at once (Gauss–Newton).
pub const UNDAMPED: f64 = 1e-9;

impl Effort {
    /// For starts alone.
    pub const STARTS: Self = Self { iterations: 6, share: 1e-3, floor: 0.0, reuse: false, damping: CAUTIOUS };
    /// For starts that are only judged by.
    pub const JUDGED: Self = Self { iterations: 5, share: 1e-2, floor: 0.1, ..Self::STARTS };
    /// For starts and numbers: derivatives by the starts change little from one fit to the next.
    pub const NUMBERS: Self = Self { reuse: true, ..Self::STARTS };

    /// Fall of a fit's cost that is not worth another linearisation.
    fn enough(&self, fit: &Fit) -> f64 {
        NEXT_TO_NOTHING.max(self.share * fit.excess()).max(self.floor * fit.spread())
    }
}

/// Promised fall of the cost below which a fit has converged whatever its size.
const NEXT_TO_NOTHING: f64 = 0.3;
/// Share of what is promised below which a step only creeps.
const CREEPING: f64 = 0.05;
/// Share of what old derivatives promise that a step along them must bring for a further one.
const SERVES: f64 = 0.3;
/// Share of the most that the same derivatives have brought below which new ones are taken.
const FADING: f64 = 0.1;
/// Most dampings tried for one linearisation.
const DAMPINGS: usize = 7;

/// Fits the starts alone (a set without members) or starts and set together.
pub fn fit(
    stage: &Stage<'_>,
    plant: &Plant,
    set: EffectSet,
    segments: Vec<Segment>,
    effort: Effort,
) -> Result<Fit, DiagnoseError> {
    let built = plant.build(&set.effects())?;
    if set.slots().is_empty() {
        return Ok(fit_starts(stage, set, built, &segments, effort));
    }
    let (segments, cost) = stage.settle(&built, &segments);
    let (count, noise) = stage.noise(&segments);
    let mut now = Fit {
        freedom: set.slots().len(),
        set,
        built,
        segments,
        cost,
        count,
        noise,
        covariance: DMatrix::zeros(0, 0),
        converged: false,
        iterations: 0,
        doubt: stage.doubt,
    };
    let mut sizes = first_sizes(&now.set);
    let mut last = Went { damping: effort.damping, ..Went::default() };
    let mut most = 0.0f64;
    while now.iterations < effort.iterations && !now.converged {
        if now.iterations > 0 && stage.work.is_spent(Until::Fit) {
            break;
        }
        let before = now.cost;
        let effort = Effort { reuse: effort.reuse && !last.wants_fresh, ..effort };
        let went = iterate(stage, plant, &mut now, &mut sizes, (last.damping, effort))?;
        // Old derivatives that bring less and less only creep towards where new ones lead at once.
        let gained = before - now.cost;
        most = if went.is_fresh { gained } else { gained.max(most) };
        let went = Went { wants_fresh: went.wants_fresh || gained < FADING * most, ..went };
        // Where the cost is rough the linear model promises what no step brings, however often it is asked.
        let is_idle = before - now.cost < effort.enough(&now).max(CREEPING * went.promised) && !went.was_blind;
        if is_idle && last.is_idle && (went.is_fresh || last.is_fresh) {
            break;
        }
        last = Went { is_idle, ..went };
    }
    if last.wants_fresh {
        now.segments.iter_mut().for_each(|s| s.columns = None);
    }
    Ok(now)
}

/// The starts alone.
fn fit_starts(stage: &Stage<'_>, set: EffectSet, built: Built, segments: &[Segment], effort: Effort) -> Fit {
    let settled = stage.fit_starts(&built, segments, effort);
    let (count, noise) = stage.noise(segments);
    Fit {
        set,
        built,
        cost: settled.iter().map(|s| s.cost).sum(),
        count,
        noise,
        freedom: settled.iter().map(|s| s.shown).sum(),
        covariance: DMatrix::zeros(0, 0),
        converged: settled.iter().all(|s| s.converged),
        iterations: settled.iter().map(|s| s.iterations).max().unwrap_or(0),
        segments: settled.into_iter().map(|s| s.segment).collect(),
        doubt: stage.doubt,
    }
}

/// First steps of the difference quotients.
pub(crate) fn first_sizes(set: &EffectSet) -> Vec<f64> {
    let size = |(m, k): &(usize, usize)| {
        let (h, x) = &set.members[*m];
        let screened = h.screens.iter().flat_map(|s| &s.columns).filter(|c| !c.secant && c.direction[*k] != 0.0);
        screened.map(|c| c.step).next().unwrap_or_else(|| (1e-4 * x[*k].abs()).max(1e-6))
    };
    set.slots().iter().map(size).collect()
}

/// How an iteration went.
#[derive(Clone, Copy, Debug, Default)]
struct Went {
    /// Damping to begin with next time.
    damping: f64,
    /// Fall of the cost that the linear model promised.
    promised: f64,
    /// Whether the derivatives by the starts were new.
    is_fresh: bool,
    /// Whether a step of a difference quotient showed nothing.
    was_blind: bool,
    /// Whether it brought next to nothing.
    is_idle: bool,
    /// Whether its derivatives by the starts lead no further.
    wants_fresh: bool,
}

/// One linearisation and the steps tried from it.
fn iterate(
    stage: &Stage<'_>,
    plant: &Plant,
    now: &mut Fit,
    sizes: &mut [f64],
    (damping, effort): (f64, Effort),
) -> Result<Went, DiagnoseError> {
    let slots = now.set.slots();
    let variations = vary(plant, &now.set, &slots, sizes)?;
    let linear = stage.linearise(&now.built, &now.segments, &variations, effort.reuse);
    now.iterations += 1;
    let mut k = sum_reduced(&linear);
    let n = slots.len();
    let shown: Vec<f64> = (0..n).map(|i| k[(i, i)]).collect();
    now.set.add_prior(&mut k);
    let (a, b, left) = (k.view((0, 0), (n, n)).into_owned(), k.view((0, n), (n, 1)).into_owned(), k[(n, n)]);
    let at: Vec<f64> = slots.iter().map(|(m, c)| now.set.members[*m].1[*c]).collect();
    let has_prior: Vec<bool> = slots.iter().map(|s| now.set.prior(*s).is_some()).collect();
    let was_blind = rescale(sizes, (&shown, &has_prior), (now.count, &at));
    now.freedom = n + linear.iter().map(|s| s.shown).sum::<usize>();
    now.covariance = pseudo_inverse(&a);
    let promised = now.cost - left + (b.transpose() * &now.covariance * &b)[(0, 0)];
    let was_known = effort.reuse && now.segments.iter().any(|s| s.columns.is_some());
    let here = Went { damping, promised, is_fresh: !was_known, was_blind, ..Went::default() };
    for (segment, linear) in now.segments.iter_mut().zip(&linear) {
        segment.columns.clone_from(&linear.columns);
        segment.steps.clone_from(&linear.steps);
    }
    if promised < effort.enough(now) {
        now.converged = !was_blind;
        return Ok(here);
    }
    let at_hand = Derivatives { slots: &slots, linear: &linear };
    let gone = descend((stage, plant), now, &at_hand, (here, effort));
    if gone.is_none() {
        // No step helps any more: the linear model has no say below the roughness of the cost.
        now.iterations = effort.iterations;
    }
    Ok(gone.unwrap_or(here))
}

/// What an iteration knows of the way down.
struct Derivatives<'a> {
    /// The fitted coordinates.
    slots: &'a [(usize, usize)],
    /// The segments about their starts.
    linear: &'a [SegmentLinear],
}

/// The first of more and more damped steps that lowers the cost: with which damping to go on, and whether new derivatives are wanted for that. None
/// where no step does.
fn descend(
    (stage, plant): (&Stage<'_>, &Plant),
    now: &mut Fit,
    at_hand: &Derivatives<'_>,
    (here, effort): (Went, Effort),
) -> Option<Went> {
    let Derivatives { slots, linear } = *at_hand;
    let (mut damping, was_known) = (here.damping, !here.is_fresh);
    let n = slots.len();
    for trial in 0..DAMPINGS {
        if trial == 2 && was_known {
            return Some(Went { damping, wants_fresh: true, ..here });
        }
        let linear: Vec<SegmentLinear> = linear.iter().map(|l| l.damped(damping)).collect();
        let mut k = sum_reduced(&linear);
        now.set.add_prior(&mut k);
        let (a, b) = (k.view((0, 0), (n, n)).into_owned(), k.view((0, n), (n, 1)).into_owned());
        let theta = step(&a, &b, damping);
        let set = now.set.moved(slots, theta.as_slice());
        let actual: Vec<f64> = slots.iter().map(|(m, c)| set.members[*m].1[*c] - now.set.members[*m].1[*c]).collect();
        if let Ok(built) = plant.build(&set.effects()) {
            let (segments, cost) = stage.follow(&built, &now.segments, &linear, &actual);
            let gained = now.cost - cost - (set.prior_cost() - now.set.prior_cost());
            if gained > 0.0 {
                (now.set, now.built, now.segments, now.cost) = (set, built, segments, cost);
                // A step that had to be shortened says nothing about the end of the way, nor does one along old derivatives.
                let is_plain = trial == 0 && !was_known;
                now.converged = !here.was_blind && is_plain && gained < effort.enough(now);
                let wants_fresh = was_known && (trial > 0 || gained < SERVES * here.promised);
                return Some(Went { damping: (damping * 0.1).max(UNDAMPED), wants_fresh, ..here });
            }
        }
        damping = (damping * 10.0).max(CAUTIOUS);
    }
    None
}

/// Longest step of a difference quotient, in widths of the coordinate's range, and what is left of one that leads nowhere.
const LONGEST: f64 = 0.05;
const SHORTER: f64 = 1e-3;

/// A model for each fitted coordinate, moved by its step; as it is where that leads nowhere out of what a body can be: such a number shows nothing.
pub fn vary(
    plant: &Plant,
    set: &EffectSet,
    slots: &[(usize, usize)],
    sizes: &[f64],
) -> Result<Vec<Variation>, DiagnoseError> {
    let vary_one = |((m, k), size): (&(usize, usize), &f64)| {
        let coordinate = &set.members[*m].0.coordinates[*k];
        let at = set.members[*m].1[*k];
        let size = size.min(LONGEST * (coordinate.bounds[1] - coordinate.bounds[0]));
        let step = if at + size > coordinate.bounds[1] { -size } else { size };
        let vary_by = |step: f64| {
            let mut moved = set.clone();
            moved.members[*m].1[*k] += step;
            let is_tolerated = moved.members[*m].0.is_tolerated();
            Ok(Variation { built: plant.build(&moved.effects())?, step, is_tolerated })
        };
        // At the edge of what can be built the other way is open, or a shorter one.
        let ways = [step, -step, SHORTER * step, -SHORTER * step, 0.0];
        let moved = |by: &f64| vary_by(*by).map(|v| Variation { step: if *by == 0.0 { step } else { *by }, ..v });
        ways[1..].iter().fold(moved(&ways[0]), |found, by| found.or_else(|_: DiagnoseError| moved(by)))
    };
    slots.iter().zip(sizes).map(vary_one).collect()
}

/// Steps for the next linearisation: a fifth of the noise, as far as the eliminated columns tell; much longer ones where these were too
/// short to show anything. Whether there were such.
/// A number with a prior that nothing shows stays where that has it.
fn rescale(sizes: &mut [f64], (shown, has_prior): (&[f64], &[bool]), (count, at): (usize, &[f64])) -> bool {
    let mut was_blind = false;
    for (k, size) in sizes.iter_mut().enumerate() {
        let longest = (FARTHEST * at[k].abs()).max(FARTHEST_FROM_ZERO);
        if shown[k] <= 0.0 && *size < longest && !has_prior[k] {
            *size = (BLIND * *size).min(longest);
            was_blind = true;
        }
        let rms = *size * (shown[k].max(0.0) / count.max(1) as f64).sqrt();
        if rms > 0.0 && !(0.01..1.0).contains(&rms) && (rms > 1.0 || *size < longest) {
            *size *= (0.1 / rms).clamp(1e-3, 1e3);
        }
    }
    was_blind
}

/// Growth of a step that showed nothing.
const BLIND: f64 = 100.0;
/// How far such a step may go, relative to where the coordinate stands, and from zero in its own unit.
const FARTHEST: f64 = 0.2;
const FARTHEST_FROM_ZERO: f64 = 1e-2;

/// −(A + λ diag A)⁻¹ b in scaled coordinates.
fn step(a: &DMatrix<f64>, b: &DMatrix<f64>, damping: f64) -> DVector<f64> {
    let n = a.nrows();
    let scale = DVector::from_fn(n, |i, _| if a[(i, i)] > 0.0 { 1.0 / a[(i, i)].sqrt() } else { 0.0 });
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        let own = if i == j { damping + 1e-12 + if scale[i] == 0.0 { 1.0 } else { 0.0 } } else { 0.0 };
        a[(i, j)] * scale[i] * scale[j] + own
    });
    let right = DVector::from_fn(n, |i, _| scale[i] * b[(i, 0)]);
    let x = scaled.cholesky().map_or_else(|| DVector::zeros(n), |c| c.solve(&right));
    DVector::from_fn(n, |i, _| -scale[i] * x[i])
}

/// A in coordinates that give it a diagonal of ones, zeros where nothing shows one; and their scales.
pub(crate) fn scaled(a: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let n = a.nrows();
    let scale = DVector::from_fn(n, |i, _| if a[(i, i)] > 0.0 { 1.0 / a[(i, i)].sqrt() } else { 0.0 });
    let scaled = DMatrix::from_fn(n, n, |i, j| 0.5 * (a[(i, j)] + a[(j, i)]) * scale[i] * scale[j]);
    (scale, scaled)
}

/// Inverse of A in scaled coordinates; directions that the data do not show are left out.
pub fn pseudo_inverse(a: &DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    if n == 0 {
        return DMatrix::zeros(0, 0);
    }
    let (scale, scaled) = scaled(a);
    let eigen = scaled.symmetric_eigen();
    let inverse = eigen.eigenvalues.map(|l| if l > 1e-9 { 1.0 / l } else { 0.0 });
    let v = &eigen.eigenvectors;
    let m = v * DMatrix::from_diagonal(&inverse) * v.transpose();
    DMatrix::from_fn(n, n, |i, j| m[(i, j)] * scale[i] * scale[j])
}
