//! Sets that windows cannot tell apart: what both leave is far beyond noise, and by how much the one leaves less is no more than what neither of them has.
//!
//! A cell's compliance and a contact's are springs in series, and a loop that is measured between them shows their sum. Which of the two it is shows in how
//! whole runs go on, where what is missing is a force that may act at any time, not noise.

use crate::attempt::Attempt;
use crate::diagnosis::Diagnosis;
use crate::effect_set::EffectSet;
use crate::hypothesis::Hypothesis;
use crate::vocabulary::plain_name;
use crate::words::{UNDECIDED, place_words};

/// The set that came nearest to the one that was chosen in the last round, of those that are told as its rivals. `left`: what that leaves beyond noise.
pub(crate) fn tied(attempts: &[Attempt], left: f64) -> Option<EffectSet> {
    let own = attempts.iter().filter(|a| a.kept).max_by_key(|a| a.round)?;
    let gain = own.together.or(own.gain)?;
    let others = near(attempts, (own.round, gain), left).filter(|(a, _)| !a.kept && !a.set.members.is_empty());
    others.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(nearest, _)| nearest.set.clone())
}

/// What was tried in a round and came near what gained so much there, and by how much it gained less. `left`: what that leaves beyond noise.
pub(crate) fn near(
    attempts: &[Attempt],
    (round, gain): (usize, f64),
    left: f64,
) -> impl Iterator<Item = (&Attempt, f64)> {
    let same_round = attempts.iter().filter(move |a| a.round == round);
    let gaps = same_round.filter_map(move |a| a.gain.map(|g| (a, gain - g)));
    // One that is better by far was told in other windows than the chosen one in the end.
    gaps.filter(move |(_, gap)| gap.abs() < near_the_best(gain, left))
}

/// Which of some tied sets whole runs took, in words; none where they took neither or there is but one.
pub(crate) fn said_of(tied: &[EffectSet], found: &Diagnosis) -> Option<String> {
    fn own<'s>(a: &'s EffectSet, b: &EffectSet) -> Option<&'s Hypothesis> {
        a.findings().map(|(h, _)| h).find(|h| !b.has_finding(h))
    }
    let [one, other] = tied else { return None };
    let [one, other] = [own(one, other)?, own(other, one)?];
    let is_taken = |h: &Hypothesis| found.effects.iter().any(|e| e.name == h.name && e.place == h.place);
    let (taken, left) = match (is_taken(one), is_taken(other)) {
        (true, false) => (one, other),
        (false, true) => (other, one),
        _ => return None,
    };
    let words = |h: &Hypothesis| format!("{} at {}", plain_name(h.name), place_words(&h.place));
    Some(format!(
        "Windows cannot tell {} from {}: both leave far more than noise, and nearly as much. Along whole runs the former is likelier.",
        words(taken),
        words(left)
    ))
}

/// Difference of the information criterion up to which another explanation is told, of one that gains so much and leaves so much beyond noise: what is left
/// may stand for the wrong one of two as well as for the right one, where noise alone is left ten decide (Kass and Raftery 1995).
pub(crate) fn near_the_best(gain: f64, left: f64) -> f64 {
    (0.05 * gain.min(left)).max(UNDECIDED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue;
    use crate::facts::Facts;
    use crate::screen::Shown;

    fn attempt(set: &EffectSet, round: usize, gain: f64, kept: bool) -> Attempt {
        let h = &set.members[0].0;
        Attempt {
            round,
            name: h.name.to_owned(),
            place: h.place.clone(),
            score: gain,
            share: 1.0,
            fall: Some(gain),
            parameters: 1,
            gain: Some(gain),
            together: None,
            kept,
            found: Vec::new(),
            set: set.clone(),
            shown: Shown { errors: Vec::new(), condition: 1.0 },
        }
    }

    #[test]
    fn sets_are_tied_where_they_differ_by_little_of_what_the_better_one_leaves() {
        let all = catalogue::hypotheses(&Facts::of_joints(2));
        let of = |place: &str| {
            let h = all.iter().find(|h| h.place == place).expect("a joint has effects");
            EffectSet::default().with(h, &h.neutral())
        };
        let [one, other] = ["joint:j0", "joint:j1"].map(of);
        let tried = |gain: f64| [attempt(&one, 0, 1000.0, true), attempt(&other, 0, gain, false)];
        let titles = |left: f64, gain: f64| tied(&tried(gain), left).map(|set| set.titles());
        assert_eq!(titles(400.0, 985.0), Some(other.titles()), "fifteen are less than a twentieth of 400");
        assert_eq!(titles(400.0, 975.0), None);
        assert_eq!(titles(0.0, 995.0), Some(other.titles()), "where noise alone is left ten decide");
        assert_eq!(titles(0.0, 985.0), None);
        let mut earlier = tried(999.0).to_vec();
        earlier.push(attempt(&one, 1, 50.0, true));
        assert!(tied(&earlier, 400.0).is_none(), "the last round decides");
    }
}
