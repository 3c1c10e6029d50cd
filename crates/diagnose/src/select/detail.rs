//! Laws that are right but for a detail: looked at closer before they are refused.
//!
//! How long an unknown force stays what it is was chosen by what the nominal model misses. What a nearly right law leaves comes and goes elsewhere, in
//! short bursts, and intervals that are not followed cost more than all that it explains brings.

use super::search::{LOOK, criterion};
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};
use crate::standing::told;

/// Share of the missing force that a law leaves which is so but for a detail.
const NEARLY: f64 = 0.25;

/// A fit whose law takes nearly all of the missing force away and is no likelier for it, which is so but for a detail: on intervals that suit it, and with
/// what it holds in reserve. First the fit that it was begun with on the same intervals, where these are others.
pub(super) fn but_for_a_detail(
    problem: &Problem<'_>,
    before: &Fitted,
    now: Fitted,
    (many, here): (usize, f64),
) -> (Option<Fitted>, Fitted) {
    let is_so = |fit: &Fitted, before: &Fitted| {
        criterion(fit, many) >= criterion(before, many) && problem.power(fit) < NEARLY * here
    };
    let (same, now) = match is_so(&now, before).then(|| closer(problem, before, &now)).flatten() {
        Some((same, closer)) => (Some(same), closer),
        None => (None, now),
    };
    let is_so = is_so(&now, same.as_ref().unwrap_or(before));
    (same, if is_so { relaxed(problem, now, many) } else { now })
}

/// A fit that does not follow intervals which the one that it was begun with follows, on intervals that are halved there, and that one on the same: how long
/// an unknown force stays what it is was chosen by what the first had missed. None where all are followed, or too short already.
fn closer(problem: &Problem<'_>, before: &Fitted, now: &Fitted) -> Option<(Fitted, Fitted)> {
    if now.spread.factors() <= before.spread.factors() {
        return None;
    }
    let halved = problem.refined(now.clone(), false).ok().filter(|halved| halved.intervals() > now.intervals())?;
    let same = problem.onto_intervals(before, &halved).ok()?;
    let begun = Fitted { datum: same.datum, ..halved };
    let closer = problem.fit(&begun, begun.set.clone(), LOOK).ok()?;
    let (many, few) = (closer.intervals(), now.intervals());
    problem
        .stage
        .work
        .watch
        .step(&format!("    {few} intervals halved to {many}: −2 log L {:.1}, was {:.1}", closer.score, now.score));
    (closer.score < now.score).then_some((same, closer))
}

/// A fit whose laws have what they hold in reserve, where it is better so: from next to what they are without, and from each end of what there is.
pub(super) fn relaxed(problem: &Problem<'_>, mut now: Fitted, many: usize) -> Fitted {
    let all: Vec<String> = now.set.findings().map(|(h, _)| h.title()).collect();
    for title in all {
        let Some(at) = now.set.members.iter().position(|(h, _)| h.title() == title) else { continue };
        let (h, x) = &now.set.members[at];
        let begins = h.relaxed(x).into_iter().chain(h.relaxed_afar(x).into_iter().flatten());
        let look = |(free, start): (Hypothesis, Vec<f64>)| {
            let set = now.set.without(at).with(&free, &start);
            // States and forces are those of another law: they come to what this one says before its numbers move.
            let begun = problem.fit(&now, set.frozen(), LOOK).ok()?;
            let tried = problem.fit(&begun, set, LOOK).ok()?;
            let gain = criterion(&tried, many) - criterion(&now, many);
            let with = tried.set.members.last().map_or_else(String::new, |(h, x)| told(h, x));
            problem.stage.work.watch.step(&format!("    {title} with {with}: criterion {gain:.1}"));
            Some((gain, tried))
        };
        let best = begins.filter_map(look).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, free)) = best.filter(|(gain, _)| *gain < 0.0) {
            now = free;
        }
    }
    now
}
