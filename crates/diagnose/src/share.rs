//! How much of the mismatch a corrected model explains, judged in windows of runs that its fit has not seen.
//!
//!   S = (E₀ − E₁)/(E₀ − 1)
//!
//! E₀ and E₁ are mean squares in units of noise of the nominal model, its numbers corrected within their tolerances, and of the corrected one, each window with an
//! initial state of its own under either model; noise alone leaves 1. Where no run was left out, those of the fit stand for them, and that is said. The interval is
//! the middle 95 % of S over resampled windows (bootstrap: Efron and Tibshirani 1993, ch. 13); windows in which either model leaves more
//! than noise are resampled, of the others there is nothing to tell: where parts meet once in a run, one window of many holds all. A model *helps*
//! where that interval, or that of the windows' mean logarithm of E₀/E₁, lies above zero and no run is predicted worse than before: a law
//! that mends one run and breaks another is none. Few windows may hold nearly all of the mismatch, where a model goes astray within them and
//! mean squares say by chance how far; the logarithm counts every window alike. What shows in no window but over whole runs, which both models begin
//! alike, is judged over these.

use crate::diagnosis::Explained;
use crate::fit::Fit;
use crate::judge::{Judgement, Prediction};
use crate::lost::NEAR;
use crate::tape::{Tape, judging};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use record::Role;
use std::collections::BTreeMap;

/// Resampled sets of windows: the ends of the interval are sure to some hundredths of its width.
const DRAWS: usize = 1000;
/// Chance that the share lies below, and above, the interval.
const TAIL: f64 = 0.025;
/// Growth of a run's mean square above noise that is harm. At 1 a hair's breadth would be harm, at 2 a run may become twice as wrong.
const HARM: f64 = 1.2;
/// Error in windows (units of noise) and share of the mismatch up to which what is left on runs that were left out is no second explanation's.
pub(crate) const LEFT: f64 = 1.5;
pub(crate) const NEXT_TO_NOTHING: f64 = 0.01;
/// Error over whole runs (units of noise) up to which they are followed: what does not settle leads apart by far more.
const FOLLOWED: f64 = 10.0;
/// Error of what is predicted as well as noise allows, in units of that: figures of noise are known to a per cent or two.
const QUIET: f64 = 1.02;
/// What is left beyond doubt, in standard deviations of what noise alone leaves.
const SIGMAS: f64 = 4.0;

/// A window's squared residuals before and after, and how many there are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Window {
    before: f64,
    after: f64,
    count: f64,
}

impl Window {
    fn plus(self, other: &Self) -> Self {
        Self { before: self.before + other.before, after: self.after + other.after, count: self.count + other.count }
    }

    fn share(&self) -> f64 {
        let mismatch = self.before - self.count;
        if mismatch > 0.0 { (self.before - self.after) / mismatch } else { 0.0 }
    }

    /// ln E₀/E₁, which is nothing where both are noise.
    fn log_gain(&self) -> f64 {
        (self.before.max(self.count) / self.after.max(self.count)).ln()
    }

    /// Whether either model leaves more than noise may.
    fn tells(&self, doubt: f64) -> bool {
        self.before.max(self.after) - self.count > self.untold(doubt)
    }

    /// Cost above the expected that is not told from noise; `doubt`: cost per scalar that is not told from a wrong noise level.
    fn untold(&self, doubt: f64) -> f64 {
        SIGMAS * (2.0 * self.count).sqrt() + doubt * self.count
    }

    /// Whether the corrected model is clearly worse.
    fn is_harmed(&self, doubt: f64) -> bool {
        let [before, after] = [self.before, self.after].map(|cost| cost - self.count);
        after > HARM * before.max(0.0) + self.untold(doubt)
    }
}

/// What a corrected model does for the runs that judge it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Use {
    /// Whether it helps there.
    pub helps: bool,
    /// Whether next to nothing is left there.
    pub leaves_little: bool,
    /// Whether nothing but noise is left, there over whole runs as well, and in the windows of the runs that were fitted.
    pub is_quiet: bool,
    /// Whether it may be the whole explanation: it leaves next to nothing there, and makes none of them worse.
    pub is_whole: bool,
}

/// What the corrected model explains, and of what use it is.
pub(crate) fn explained(judgement: &Judgement, tapes: &[Tape], found: &Fit, window_s: f64) -> (Explained, Use) {
    let judging = judging(tapes);
    let left_out = judging == Role::Holdout;
    let is_judged = |run: usize| tapes[run].role == judging;
    let [runs_before, runs_after] = judgement.beside_effects(false).map(|p| p.rms(is_judged));
    let [runs, along] = [true, false].map(|windowed| windows_of(judgement.beside_effects(windowed), is_judged));
    let shows = |runs: &BTreeMap<usize, Vec<Window>>| runs.values().flatten().any(|w| w.tells(found.doubt));
    let is_slow = !shows(&runs) && runs_before < NEAR && shows(&along);
    let lengths = along.keys().map(|run| tapes[*run].span.1 - tapes[*run].span.0);
    let (window_s, runs) = if is_slow { (lengths.fold(0.0, f64::max), along) } else { (window_s, runs) };
    let all = sum(runs.values().flatten());
    let harmed = runs.iter().filter(|(_, w)| sum(w.iter()).is_harmed(found.doubt));
    let harmed: Vec<String> = harmed.map(|(run, _)| tapes[*run].file.clone()).collect();
    let count = runs.len();
    let runs = &telling(&runs, found.doubt);
    let interval = interval(runs, share_of);
    let is_gain = || all.share() > 0.0 && self::interval(runs, mean_log_gain)[0] > 0.0;
    let leaves_little = all.after <= LEFT * LEFT * all.count || all.share() > 1.0 - NEXT_TO_NOTHING;
    // Where whole runs were followed before, they have to be followed as well.
    let leads_astray = runs_before < NEAR && runs_after > LEFT && runs_after > HARM * runs_before;
    let helps = (interval[0] > 0.0 || is_gain()) && harmed.is_empty() && !leads_astray;
    let is_still = |after: f64| after <= QUIET;
    let in_windows = [Role::Fit, judging].map(|role| judgement.rms_of(tapes, true, role));
    let is_quiet =
        left_out && is_still(runs_after) && in_windows.into_iter().flatten().all(|[_, after]| is_still(after));
    let is_whole = leaves_little && harmed.is_empty() && !leads_astray && !drifts(judgement, tapes);
    (
        Explained { share: all.share(), interval, window_s, runs: count, left_out, harmed },
        Use { helps, leaves_little, is_quiet, is_whole },
    )
}

/// Whether the corrected model follows whole runs and is off along most of them by more than noise: windows are too short for what is left.
fn drifts(judgement: &Judgement, tapes: &[Tape]) -> bool {
    let mut after: Vec<f64> = (0..tapes.len()).map(|run| judgement.rms(false, |r| r == run)[1]).collect();
    after.sort_by(f64::total_cmp);
    after.get(after.len().saturating_sub(1) / 2).is_some_and(|typical| (LEFT..FOLLOWED).contains(typical))
}

/// Windows by run.
fn windows_of([before, after]: [&Prediction; 2], wanted: impl Fn(usize) -> bool) -> BTreeMap<usize, Vec<Window>> {
    let mut runs: BTreeMap<usize, Vec<Window>> = BTreeMap::new();
    let pairs = before.fit.segments.iter().zip(&before.residuals).filter(|(s, _)| wanted(s.run));
    for (segment, r) in pairs {
        let is_same = |s: &crate::linear::Segment| s.run == segment.run && s.span == segment.span;
        let Some(at) = after.fit.segments.iter().position(is_same) else { continue };
        let window =
            Window { before: r.norm_squared(), after: after.residuals[at].norm_squared(), count: r.len() as f64 };
        // A window that neither model can be followed through says nothing of either.
        if window.before.is_finite() || window.after.is_finite() {
            let finite = |cost: f64| if cost.is_finite() { cost } else { window.count * DIVERGED };
            let window = Window { before: finite(window.before), after: finite(window.after), ..window };
            runs.entry(segment.run).or_default().push(window);
        }
    }
    runs
}

/// Those windows that tell something of either model; all where none does.
fn telling(runs: &BTreeMap<usize, Vec<Window>>, doubt: f64) -> BTreeMap<usize, Vec<Window>> {
    let of = |(run, windows): (&usize, &Vec<Window>)| {
        let own: Vec<Window> = windows.iter().filter(|w| w.tells(doubt)).copied().collect();
        (!own.is_empty()).then_some((*run, own))
    };
    let told: BTreeMap<usize, Vec<Window>> = runs.iter().filter_map(of).collect();
    if told.is_empty() { runs.clone() } else { told }
}

/// Mean square that stands for a replay that left the range of numbers.
const DIVERGED: f64 = 1e12;

fn sum<'a>(windows: impl Iterator<Item = &'a Window>) -> Window {
    windows.fold(Window::default(), |sum, w| sum.plus(w))
}

/// What the windows of all runs explain together.
fn share_of(windows: &[&Window]) -> f64 {
    sum(windows.iter().copied()).share()
}

fn mean_log_gain(windows: &[&Window]) -> f64 {
    windows.iter().map(|w| w.log_gain()).sum::<f64>() / windows.len().max(1) as f64
}

/// The middle 95 % of what resampled windows say.
fn interval(runs: &BTreeMap<usize, Vec<Window>>, of: fn(&[&Window]) -> f64) -> [f64; 2] {
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let all: Vec<&Window> = runs.values().flatten().collect();
    let mut draw = || {
        let drawn: Vec<&Window> = all.iter().map(|_| all[(random.next_u64() % all.len() as u64) as usize]).collect();
        of(&drawn)
    };
    let mut said: Vec<f64> = (0..DRAWS).map(|_| draw()).collect();
    said.sort_by(f64::total_cmp);
    let at = |p: f64| said[((DRAWS - 1) as f64 * p).round() as usize];
    [at(TAIL), at(1.0 - TAIL)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(before: f64, after: f64) -> Window {
        Window { before, after, count: 100.0 }
    }

    #[test]
    fn what_takes_all_but_noise_away_explains_all() {
        assert_eq!(window(1100.0, 100.0).share(), 1.0);
        assert_eq!(window(1100.0, 600.0).share(), 0.5);
        assert_eq!(window(90.0, 80.0).share(), 0.0);
        let runs = BTreeMap::from([(0, vec![window(1100.0, 100.0); 5]), (1, vec![window(300.0, 100.0); 5])]);
        assert_eq!(interval(&runs, share_of), [1.0, 1.0]);
    }

    #[test]
    fn one_window_in_each_run_where_parts_meet_tells_what_all_others_cannot() {
        let run = |before, after| [vec![window(100.0, 100.0); 11], vec![window(before, after)]].concat();
        let runs = BTreeMap::from([(3, run(5e3, 8e2)), (4, run(9e3, 4e3))]);
        assert_eq!(interval(&runs, share_of)[0], 0.0, "some draws have neither");
        let [low, high] = interval(&telling(&runs, 0.03), share_of);
        assert!((low - 5e3 / 8.9e3).abs() < 1e-12 && (high - 4.2e3 / 4.9e3).abs() < 1e-12, "{low} {high}");
        let noise = BTreeMap::from([(0, vec![window(90.0, 99.0)])]);
        assert_eq!(telling(&noise, 0.03), noise);
    }

    #[test]
    fn an_interval_tells_windows_that_contradict_each_other() {
        let runs = BTreeMap::from([(0, vec![window(1100.0, 100.0), window(1100.0, 2100.0)])]);
        let [low, high] = interval(&runs, share_of);
        assert!(low < -0.9 && high > 0.9, "{low} {high}");
    }

    #[test]
    fn one_window_that_goes_astray_does_not_hide_what_all_others_say() {
        let mut windows = vec![window(5e4, 2e3); 20];
        windows.extend([window(9e9, 2e9), window(1e8, 4e9)]);
        let runs = BTreeMap::from([(0, windows)]);
        assert!(interval(&runs, share_of)[0] < 0.0);
        assert!(interval(&runs, mean_log_gain)[0] > 0.0);
        let noise = BTreeMap::from([(0, vec![window(90.0, 99.0), window(98.0, 40.0)])]);
        assert_eq!(interval(&noise, mean_log_gain), [0.0, 0.0]);
    }

    #[test]
    fn a_run_that_is_predicted_worse_is_harmed() {
        assert!(window(200.0, 500.0).is_harmed(0.03));
        assert!(!window(500.0, 520.0).is_harmed(0.03));
        assert!(!window(100.0, 120.0).is_harmed(0.03));
    }
}
