//! One law of a kind at a place.
//!
//! Dry friction that falls with speed becomes Coulomb's where its further numbers do nothing; both at one joint are one law with more numbers than it has
//! meaning, of which only the sum is known. The better of them stays.

use super::search::{LOOK, criterion, to_the_end};
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem};

/// What a law may become without leaving its place, and itself.
fn forms(h: &Hypothesis) -> Vec<&'static str> {
    let plainer = h.plainer(&h.neutral());
    plainer.iter().filter(|other| !other.is_at_contact).map(|other| other.name).chain([h.name]).collect()
}

/// Whether two are forms of one law at one place.
pub(super) fn are_kin(a: &Hypothesis, b: &Hypothesis) -> bool {
    a.place == b.place && a.name != b.name && forms(a).iter().any(|form| forms(b).contains(form))
}

/// A fit in which no two laws are forms of one, and the titles of those that had to go.
pub(super) fn alone_of_their_kind(problem: &Problem<'_>, mut now: Fitted, many: usize) -> (Fitted, Vec<String>) {
    let mut gone = Vec::new();
    loop {
        let found: Vec<Hypothesis> = now.set.findings().map(|(h, _)| h.clone()).collect();
        let pairs = || found.iter().enumerate().flat_map(|(i, a)| found[i + 1..].iter().map(move |b| [a, b]));
        let Some(pair) = pairs().find(|[a, b]| are_kin(a, b)) else { return (now, gone) };
        let without = |h: &Hypothesis| {
            let at = now.set.members.iter().position(|m| m.0.title() == h.title())?;
            Some((h.title(), problem.fit(&now, now.set.without(at), LOOK).ok()?))
        };
        let fits = pair.into_iter().filter_map(without);
        let Some((title, fit)) = fits.min_by(|a, b| criterion(&a.1, many).total_cmp(&criterion(&b.1, many))) else {
            return (now, gone);
        };
        problem.stage.work.watch.step(&format!("  without {title}, which is another form of its neighbour"));
        gone.push(title);
        now = to_the_end(problem, fit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::hypotheses;
    use crate::facts::{Facts, JointFact};

    #[test]
    fn forms_of_dry_friction_are_kin_and_other_laws_of_a_joint_are_not() {
        let joint =
            |name: &str| JointFact { name: name.to_owned(), coordinate: 0, armature: 0.1, ..JointFact::default() };
        let facts = Facts { joints: vec![joint("a"), joint("b")], duration: 1.0, ..Facts::default() };
        let all = hypotheses(&facts);
        let of = |name: &str, place: &str| {
            all.iter().find(|h| h.name == name && h.place == place).expect("it is in the library")
        };
        let dry = |place| {
            ["joint-coulomb-friction", "joint-stribeck-friction", "joint-friction-asymmetry"]
                .map(|name| of(name, place))
        };
        let [coulomb, stribeck, directed] = dry("joint:a");
        assert!(are_kin(coulomb, stribeck) && are_kin(stribeck, directed) && are_kin(directed, coulomb));
        assert!(!are_kin(coulomb, dry("joint:b")[1]), "another joint");
        for other in ["joint-viscous-friction", "joint-cable-stiffness", "joint-torque-ripple", "joint-offset"] {
            let other = all.iter().find(|h| h.name == other && h.place == "joint:a");
            assert!(other.is_none_or(|other| !are_kin(coulomb, other)));
        }
        assert!(
            !are_kin(of("joint-torque-ripple", "joint:a"), of("joint-cable-stiffness", "joint:a")),
            "only where it is less than a wave"
        );
    }
}
