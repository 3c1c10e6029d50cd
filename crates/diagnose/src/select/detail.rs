//! Laws that are right but for a detail: looked at closer before they are refused.
//!
//! How long an unknown force stays what it is was chosen by what the nominal model misses. What a nearly right law leaves comes and goes elsewhere, in
//! short bursts, and intervals that are not followed cost more than all that it explains brings.

use super::dull::dull_beside;
use super::kin::are_kin;
use super::search::{FAR, LOOK, criterion, to_the_end};
use crate::effect_set::EffectSet;
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};
use crate::parsimony::plainer;
use crate::standing::told;
use crate::work::Until;
use scenario::effects::candidate::Coordinate;

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
pub(super) fn relaxed(problem: &Problem<'_>, now: Fitted, many: usize) -> Fitted {
    let begins = |(h, x): &Member| h.relaxed(x).into_iter().chain(h.relaxed_afar(x).into_iter().flatten()).collect();
    with_others(problem, now, many, begins, false)
}

/// A fit whose laws are the richer ones of their kind, where it is better so: each begins where the plainer one stands, with what that has had to free.
pub(super) fn enriched(problem: &Problem<'_>, now: Fitted, known: &[Hypothesis], many: usize) -> Fitted {
    with_others(problem, now, many, |member| richer(member, known), true)
}

/// A fit with each of its findings as the best of what others begin in its place, where that is better by the criterion; once it has come to its end,
/// where others come from afar.
fn with_others(
    problem: &Problem<'_>,
    mut now: Fitted,
    many: usize,
    begins: impl Fn(&Member) -> Vec<Member>,
    are_far: bool,
) -> Fitted {
    // A law at a joint where nothing is missing is right as it is.
    let dull = dull_beside(&now, problem).unwrap_or_default();
    let speaks = |h: &Hypothesis| !dull.contains(&h.place);
    let all: Vec<String> = now.set.findings().filter(|(h, _)| speaks(h)).map(|(h, _)| h.title()).collect();
    for title in all {
        if problem.stage.work.is_spent(Until::Prune) {
            break;
        }
        let Some(at) = now.set.members.iter().position(|(h, _)| h.title() == title) else { continue };
        let look = |(other, start): Member| {
            let set = now.set.without(at).with(&other, &start);
            // States and forces are those of another law: they come to what this one says before its numbers move.
            let begun = problem.fit(&now, set.frozen(), LOOK).ok()?;
            let tried = problem.fit(&begun, set, LOOK).ok()?;
            let gain = criterion(&tried, many) - criterion(&now, many);
            let with = tried.set.members.last().map_or_else(String::new, |(h, x)| told(h, x));
            problem.stage.work.watch.step(&format!("    {} with {with}: criterion {gain:.1}", other.title()));
            Some((gain, tried))
        };
        let best = begins(&now.set.members[at]).into_iter().filter_map(look).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((gain, other)) = best.filter(|(gain, _)| *gain < if are_far { FAR } else { 0.0 }) else { continue };
        let other = if are_far { to_the_end(problem, other) } else { other };
        if gain < 0.0 || criterion(&other, many) < criterion(&now, many) {
            now = other;
        }
    }
    now
}

/// A law and where its numbers stand.
type Member = (Hypothesis, Vec<f64>);

/// Richer laws of a member's kind, from each of their screen points: numbers that both have stand where the plainer law has them, a further level is a part
/// of the first.
fn richer((h, x): &Member, known: &[Hypothesis]) -> Vec<Member> {
    let is_richer = |r: &&Hypothesis| {
        are_kin(r, h)
            && r.plainer(&r.neutral()).iter().any(|p| p.name == h.name)
            && r.coordinates.len() > h.coordinates.len()
    };
    let begins = |r: &Hypothesis| {
        let free = if h.reserve.is_empty() {
            r.relaxed(&r.neutral()).map_or_else(|| r.clone(), |free| free.0)
        } else {
            r.clone()
        };
        let at = |key: &str| h.coordinates.iter().position(|own| own.key == key).map(|k| x[k]);
        let level = r.coordinates.first().and_then(|c| at(c.key));
        let begin = |base: &Vec<f64>| {
            let of = |(c, base): (&Coordinate, &f64)| {
                at(c.key).or_else(|| (*base == 0.0).then(|| level.map(|l| FURTHER * l)).flatten()).unwrap_or(*base)
            };
            (free.clone(), r.clamped(&r.coordinates.iter().zip(base).map(of).collect::<Vec<_>>()))
        };
        let points = r.screens.iter().filter_map(|s| s.columns.first()).filter(|c| !c.secant);
        points.filter(|_| level.is_some()).map(|c| begin(&c.base)).collect::<Vec<_>>()
    };
    let mut seen = Vec::new();
    let mut is_new = |r: &&Hypothesis| {
        !seen.contains(&r.name) && {
            seen.push(r.name);
            true
        }
    };
    known.iter().filter(is_richer).filter(&mut is_new).flat_map(begins).collect()
}

/// A further level of a richer law to begin with, as a part of the first.
const FURTHER: f64 = 0.3;

/// What a law may become by fewer numbers, and where that begins: its plainer kinds, and itself with what it held in reserve as usual. A plainer kind of a
/// law that has had to free its reserve begins where that stands, and from each end of what there is: the richer one did with its own numbers what it does.
pub(super) fn simpler(
    member: &(Hypothesis, Vec<f64>),
    set: &EffectSet,
    known: &[Hypothesis],
) -> Vec<(Hypothesis, Vec<f64>)> {
    let (h, x) = member;
    // The same law before its reserve was freed.
    let usual = |h: &Hypothesis| {
        let mut kinds = known.iter().filter(|_| h.reserve.is_empty());
        kinds.find(|k| k.title() == h.title() && !k.reserve.is_empty())
    };
    let begins = |(plain, x): (Hypothesis, Vec<f64>)| {
        let ends = usual(&plain).and_then(|usual| usual.relaxed_afar(&x)).into_iter().flatten().map(|(_, end)| end);
        std::iter::once(x.clone()).chain(ends).map(|x| (plain.clone(), x)).collect::<Vec<_>>()
    };
    let own = usual(h).map(|usual| {
        let mut x = x.clone();
        usual.reserve.iter().for_each(|(k, _)| x[*k] = usual.coordinates[*k].neutral);
        (usual.clone(), x)
    });
    let others = plainer(member, known).into_iter().filter(|(plain, _)| !set.has_finding(plain));
    others.flat_map(begins).chain(own).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::Facts;

    /// What was free to creep with numbers of its own creeps elsewhere without them; what was not begins where it stands.
    #[test]
    fn a_plainer_law_begins_at_either_end_of_what_was_freed() {
        let all = hypotheses(&Facts::of_joints(1));
        let rich = all.iter().find(|h| h.name == "joint-stribeck-friction").expect("it is in the library");
        let x = [vec![0.5, 0.1], rich.neutral()[2..].to_vec()].concat();
        let of = |h: &Hypothesis, x: &[f64]| {
            let member = (h.clone(), x.to_vec());
            simpler(&member, &EffectSet::default().with(h, x), &all)
        };
        let held = of(rich, &x);
        assert_eq!(held.len(), 1);
        assert!(!held[0].0.reserve.is_empty(), "its reach and its creep stay as usual");
        let (free, x) = rich.relaxed(&x).expect("it has both in reserve");
        let begins = of(&free, &x);
        let (own, begins) = begins.split_last().expect("there are plainer ones");
        assert!(own.0 == *rich && own.1[3..] == rich.neutral()[3..] && own.1[..3] == x[..3], "itself as usual");
        assert_eq!(begins.len(), 3);
        assert!(begins.iter().all(|(h, x)| h.name == "joint-coulomb-friction" && h.reserve.is_empty() && x[0] == 0.5));
        assert_eq!(begins[0].1[1..], x[3..], "the first is where the richer one stands");
        let creep: Vec<f64> = begins.iter().map(|(_, x)| x[2]).collect();
        assert!(creep[1] > creep[2] && begins[1].1[1] > begins[2].1[1], "smooth before stiff: {creep:?}");
    }
}
