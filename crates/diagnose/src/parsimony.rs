//! No more than the data ask for: members that can be taken out again, laws that have grown into plainer ones.
//!
//! A law that came first as the synonym of the right one has company that mends what it is not; one that is richer than the truth spends its
//! further numbers on what no law of the library takes away. Both go here, by the criterion of the search.

use crate::error::DiagnoseError;
use crate::fit::{EffectSet, Effort, Fit, fit};
use crate::hypothesis::{Alternative, Hypothesis};
use crate::linear::Stage;
use crate::plant::Plant;
use crate::search::{LOOK, TIE, WHOLE, errors};
use crate::select::search::takes_little;
use crate::standing::{Standing, criterion};
use crate::work::Until;

/// Fits of a set that may be far off.
const GLANCE: Effort = Effort { iterations: 2, share: 2e-2, floor: 0.1, ..Effort::NUMBERS };
/// Growth of the error by which a member that is taken out shows that it is needed.
const NECESSARY: f64 = 1.3;
/// The same by which a plainer law shows that it cannot do what another does.
const PLAINER: f64 = 2.0;
/// Cost, as a share of what noise leaves, by which it may predict worse and still be as good: a four-hundredth of the noise.
const AS_GOOD: f64 = 0.005;

/// Puts one member in the place of all where it does alone what they do together: a law that came first as the synonym of a later one has
/// others beside it that mend what it is not.
fn one_for_all(stage: &Stage<'_>, plant: &Plant, now: Standing) -> Result<Standing, DiagnoseError> {
    let set = &now.judge().set;
    let members: Vec<_> = set.findings().collect();
    for (h, x) in members.iter().rev().filter(|_| members.len() > 1) {
        if stage.work.is_spent(Until::Prune) {
            break;
        }
        let alone = set.tolerated().with(h, x);
        let near = fit(stage, plant, alone, now.judge().segments.clone(), LOOK)?;
        if near.rms() > NECESSARY * now.judge().rms() {
            continue;
        }
        let tried = now.refit(stage, plant, near.set, WHOLE)?;
        if !now.is_better(&tried) {
            stage.work.watch.step(&format!("{} alone does as much: {}", h.title(), errors(&tried)));
            return Ok(tried);
        }
    }
    Ok(now)
}

/// Takes out members whose loss the criterion welcomes.
pub(crate) fn prune(stage: &Stage<'_>, plant: &Plant, now: Standing) -> Result<Standing, DiagnoseError> {
    let mut now = one_for_all(stage, plant, now)?;
    let mut member = 0;
    let is_open = |now: &Standing, member| {
        now.judge().set.findings().count() > 1
            && member < now.judge().set.members.len()
            && !stage.work.is_spent(Until::Prune)
    };
    while is_open(&now, member) {
        if now.judge().set.members[member].0.is_tolerated() {
            member += 1;
            continue;
        }
        let less = now.judge().set.without(member);
        // What nothing near can do without stays.
        let near = fit(stage, plant, less.clone(), now.judge().segments.clone(), GLANCE)?;
        if near.rms() > NECESSARY * now.judge().rms() {
            member += 1;
            continue;
        }
        let tried = now.refit(stage, plant, less, LOOK)?;
        if !now.is_better(&tried) {
            let set = tried.judge().set.clone();
            now = tried.refit(stage, plant, set, WHOLE)?;
            member = 0;
        } else {
            member += 1;
        }
    }
    Ok(now)
}

/// Hypotheses and coordinates of what a member of a set becomes where some of its numbers do nothing, as far as they are known and not in the set: plainer
/// laws, and itself with what it held in reserve as usual.
pub(crate) fn plainer(
    (h, x): &(Hypothesis, Vec<f64>),
    set: &EffectSet,
    known: &[Hypothesis],
) -> Vec<(Hypothesis, Vec<f64>)> {
    let others = if h.is_tolerated() { Vec::new() } else { h.plainer(x) };
    let of = |other: Alternative| {
        let is_here = |p: &&Hypothesis| p.name == other.name && (p.place == h.place || other.is_at_contact);
        let plain = known.iter().find(is_here)?;
        // What a law has had to free its plainer form has free too, and needs it elsewhere where it was free to do with its own numbers what that does.
        let free = plain.relaxed_afar(&other.coordinates).filter(|_| h.reserve.is_empty());
        let (plain, afar) = match free {
            Some([smooth, stiff]) => (smooth.0, vec![smooth.1, stiff.1]),
            None => (plain.clone(), Vec::new()),
        };
        let held = [&plain.held[..], &other.held[..]].concat();
        let plain = Hypothesis { held, ..plain };
        Some(std::iter::once(other.coordinates).chain(afar).map(move |x| (plain.clone(), x)))
    };
    let usual = known.iter().find(|k| k.title() == h.title() && !k.reserve.is_empty() && h.reserve.is_empty());
    let usual = usual.map(|usual| {
        let mut x = x.clone();
        usual.reserve.iter().for_each(|(k, _)| x[*k] = usual.coordinates[*k].neutral);
        (usual.clone(), x)
    });
    others.into_iter().filter_map(of).flatten().filter(|(plain, _)| !set.has_finding(plain)).chain(usual).collect()
}

/// Puts a plainer law in the place of one that has grown into it, and a likelier one in that of its equal.
pub(crate) fn simplify(
    stage: &Stage<'_>,
    plant: &Plant,
    mut now: Standing,
    (all, brought): (&[Hypothesis], f64),
) -> Result<Standing, DiagnoseError> {
    for member in 0..now.judge().set.members.len() {
        // From one begin each: in windows a law is not held where samples have it, and its valleys are wider.
        let mut forms = plainer(&now.judge().set.members[member], &now.judge().set, all);
        forms.retain(|(h, _)| h.title() != now.judge().set.members[member].0.title());
        forms.dedup_by(|b, a| a.0.title() == b.0.title());
        for (plain, x) in forms {
            let set = now.judge().set.without(member).with(&plain, &x);
            let is_far = |near: &Fit| near.rms() > PLAINER * now.judge().rms();
            let of = |set: &EffectSet, effort| fit(stage, plant, set.clone(), now.judge().segments.clone(), effort);
            let near = of(&set, GLANCE)?;
            let released = if is_far(&near) { set.released() } else { Vec::new() };
            // What a plainer law cannot do without it may do with what it holds in reserve.
            let near = released.first().map_or(Ok(near), |free| of(free, LOOK))?;
            if is_far(&near) {
                continue;
            }
            let tried = now.refit(stage, plant, near.set, LOOK)?;
            let costs = criterion(tried.judge()) - criterion(now.judge());
            stage.work.watch.step(&format!("{} instead costs {costs:.1}", plain.title()));
            let is_as_good = costs < (AS_GOOD * now.judge().noise).min(TIE * brought) || is_idle(&now, &tried, brought);
            if is_as_good && tried.is_comparable(&now) || !now.is_better(&tried) {
                stage.work.watch.step(&format!("{} is enough: {}", plain.title(), errors(&tried)));
                now = tried;
                break;
            }
        }
    }
    Ok(now)
}

/// Whether a law does little more than its plainer kind, where both leave what is no noise: what a model leaves that is not in the library is none, and a
/// criterion that takes it for such is sure of anything (ĉ of Burnham and Anderson 2002, ch. 2.5).
fn is_idle(rich: &Standing, plain: &Standing, brought: f64) -> bool {
    let [rich, plain] = [rich, plain].map(Standing::judge);
    rich.is_significant() && takes_little(rich.excess(), plain.excess(), brought + rich.excess())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::{Facts, JointFact};

    /// What was free to creep with numbers of its own creeps elsewhere without them; what was not begins where it stands.
    #[test]
    fn a_plainer_law_begins_at_either_end_of_what_was_freed() {
        let joint = JointFact { name: "j".to_owned(), coordinate: 0, armature: 0.0, largest_command: 0.0, travel: 0.0 };
        let all = hypotheses(&Facts { joints: vec![joint], duration: 1.0, ..Facts::default() });
        let rich = all.iter().find(|h| h.name == "joint-stribeck-friction").expect("it is in the library");
        let x = [vec![0.5, 0.1], rich.neutral()[2..].to_vec()].concat();
        let of = |h: &Hypothesis, x: &[f64]| {
            let member = (h.clone(), x.to_vec());
            plainer(&member, &EffectSet::default().with(h, x), &all)
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
