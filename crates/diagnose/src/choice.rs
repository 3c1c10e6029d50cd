//! Which of some refits is taken: the order in which they go on to whole runs, and what is preferred there.

use crate::attempt::Attempt;
use crate::error::DiagnoseError;
use crate::fit::Fit;
use crate::linear::Stage;
use crate::plant::Plant;
use crate::refits::Refit;
use crate::search::{LOOK, UNEXPLAINED, errors, no_coarser};
use crate::standing::{Standing, criterion};
use crate::work::Until;

/// Difference, as a share of what the best of them has brought, below which a nominal number goes before other physics, once there is an effect.
const CORRECTION: f64 = 0.05;
/// Share of the best fall in the windows from which on a refit goes on to whole runs.
const NEARLY: f64 = 0.6;

/// Takes refits to whole runs, in their order, as far as they come near the best of them and until one leaves nothing; the best of what comes of
/// them and of what was best before. Each comes with the number of its attempt; `is_window`: they were made in windows.
pub(crate) fn take_further(
    stage: &Stage<'_>,
    plant: &Plant,
    now: &Standing,
    (is_window, ready): (bool, Vec<Refit>),
    (mut best, attempts): (Option<Standing>, &mut [Attempt]),
) -> Result<Option<Standing>, DiagnoseError> {
    let here = if is_window { &now.windows } else { &now.whole };
    let most = brought_by(here, &ready);
    for Refit { attempt: at, fit: tried } in ready {
        // What was fitted to whole runs has been paid for.
        let is_enough = |b: &Standing| is_done(now, b) || is_window && stage.work.is_spent(Until::Search);
        if best.as_ref().is_some_and(is_enough) || here.cost - tried.cost < NEARLY * most {
            continue;
        }
        let standing = if is_window {
            // What it adds may be faster than what the nominal model has.
            let stage = &Stage { pace: no_coarser(stage, &tried.built, &tried.segments), ..*stage };
            now.climbed(stage, plant, tried, LOOK)?
        } else {
            Standing { whole: tried, ..now.clone() }
        };
        stage.work.watch.step(&format!("{}: {}", attempts[at].title(), errors(&standing)));
        if standing.follows() && now.follows() {
            attempts[at].tell(&now.whole, &standing.whole);
        }
        let is_preferable =
            |b: &Standing| is_luxury(now, &standing, b) || standing.is_better(b) && !is_luxury(now, b, &standing);
        if best.as_ref().is_none_or(is_preferable) {
            best = Some(standing);
        }
    }
    Ok(best)
}

/// The order of refits, best first.
pub(crate) fn by_criterion(a: &Refit, b: &Refit) -> std::cmp::Ordering {
    criterion(&a.fit).total_cmp(&criterion(&b.fit))
}

/// Beside what was found already a number that is slightly off is likelier than more physics.
pub(crate) fn put_corrections_first(here: &Fit, ready: &mut [Refit]) {
    let enough = ready.first().map_or(0.0, |r| criterion(&r.fit)) + CORRECTION * brought_by(here, ready);
    let is_correction = |r: &Refit| r.fit.set.ends_with_correction() && criterion(&r.fit) < enough;
    if let Some(at) = ready.iter().position(is_correction).filter(|_| here.set.has_findings()) {
        ready[..=at].rotate_right(1);
    }
}

/// The largest fall of the cost by a refit.
pub(crate) fn brought_by(here: &Fit, ready: &[Refit]) -> f64 {
    ready.iter().map(|r| here.cost - r.fit.cost).fold(0.0, f64::max)
}

/// Whether what one standing does more than another that corrects a nominal number is too little for more physics beside what was found.
fn is_luxury(now: &Standing, plain: &Standing, other: &Standing) -> bool {
    let [plain_costs, other_costs] = [plain, other].map(|s| criterion(s.judge()));
    let brought = criterion(now.judge()) - other_costs;
    now.judge().set.has_findings()
        && plain.judge().set.ends_with_correction()
        && !other.judge().set.ends_with_correction()
        && plain.is_comparable(other)
        && now.is_comparable(other)
        && plain_costs - other_costs < CORRECTION * brought
}

/// Whether a standing leaves nothing; where windows had to be shortened, whether it has come from there to whole runs or explains the longest.
fn is_done(now: &Standing, best: &Standing) -> bool {
    let has_climbed = best.rungs.is_empty() && !now.rungs.is_empty();
    !best.judge().is_significant() || has_climbed && (best.follows() || !best.windows.is_significant())
}

/// Whether a standing leaves so little of what there was that other hypotheses need not be looked for in this round.
pub(crate) fn is_enough(now: &Standing, best: &Standing) -> bool {
    is_done(now, best)
        || best.rungs.len() < now.rungs.len()
        || best.is_comparable(now) && best.judge().excess() < UNEXPLAINED * now.judge().excess()
}
