//! Which of two diagnoses of one recording is told.

use crate::diagnosis::{Diagnosis, Verdict};

/// Whether a likelihood of samples is to be believed: all is explained or next to all, or what is left is of the size of noise. Far beyond it the laws that were found are off by
/// more than noise at every sample, and what is likeliest sample by sample is decided by where they are off most.
pub(crate) fn is_near_noise(diagnosis: &Diagnosis) -> bool {
    let has_effects = !diagnosis.effects.is_empty();
    let is_next_to_all = diagnosis.explained_share.as_ref().is_some_and(|e| e.share >= NEXT_TO_ALL);
    merit(diagnosis) >= 1.0 || has_effects && (diagnosis.error.windowed.after < NEAR_NOISE || is_next_to_all)
}

/// Whether a diagnosis explains more than another one by more than the runs tell: the other's share lies below its interval and, where a search would be
/// content with the other, so does all of the other's.
pub(crate) fn is_clearly_better(one: &Diagnosis, other: &Diagnosis) -> bool {
    let interval = |d: &Diagnosis| d.explained_share.as_ref().map_or([0.0; 2], |e| e.interval);
    let overlaps = interval(one)[0] <= interval(other)[1];
    let is_within = interval(one)[0] <= merit(other);
    merit(one) > merit(other) && !(is_within || overlaps && merit(other) >= SETTLED)
}

/// Whether any run's windows show a mismatch: where none does, what there is takes whole runs to show, and windows of any length decide nothing.
pub(crate) fn shows_in_windows(diagnosis: &Diagnosis) -> bool {
    diagnosis.error.runs.iter().any(|run| run.windowed_before.is_nan() || run.windowed_before > NOISE)
}

/// Error over the windows of a run, units of noise, up to which they show nothing.
const NOISE: f64 = 1.05;
/// Error over windows, units of noise, up to which what is left is of the size of noise.
const NEAR_NOISE: f64 = 10.0;
/// Share of a mismatch of which next to nothing is left: a thirtieth of the error.
const NEXT_TO_ALL: f64 = 0.999;

/// How much of the mismatch is explained: all, a share (of windows, which may be told to the last while whole runs are not), or nothing.
pub(crate) fn merit(diagnosis: &Diagnosis) -> f64 {
    match diagnosis.verdict {
        Verdict::NoMismatch | Verdict::Explained => 1.0,
        Verdict::PartlyExplained => diagnosis.explained_share.as_ref().map_or(0.0, |e| e.share.clamp(0.0, NOT_ALL)),
        Verdict::Unknown => -1.0,
    }
}

/// Most that a share counts for where something is left.
const NOT_ALL: f64 = 0.999_999;

/// Share of a mismatch with which a search is content.
pub(crate) const SETTLED: f64 = 0.9;
