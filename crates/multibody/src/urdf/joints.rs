//! Checks of single joints: type, axis, limits, and whom they follow.

use super::doubts::UrdfDoubt;
use super::errors::{UrdfProblem, cut};
use super::facts::{Facts, JointFact, part, tag_in};
use super::findings::Findings;
use super::nearest::find_nearest;
use super::schema::{ROBOT, Tag};
use super::walk::{numbers_of, own_attribute, text_of, version_of};
use roxmltree::Node;

const KINDS: [&str; 6] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar"];
const TURNS_FREELY: &str = ", or type=\"continuous\" if it turns without end";

/// Whom a joint follows, in the order of the file's joints: leader, multiplier, offset.
pub(crate) type Follows = (usize, f64, f64);

/// Type, axis and limits of every joint.
pub(crate) fn check_joints(facts: &Facts<'_, '_>, findings: &mut Findings<'_>) {
    let Some(tag) = tag_in(&ROBOT, "joint") else { return };
    for joint in &facts.joints {
        if text_of(joint.node, "type").is_some() {
            check_kind(joint, findings);
        }
        if !matches!(joint.kind, "fixed" | "floating") {
            check_axis(joint, tag, findings);
        }
        if matches!(joint.kind, "revolute" | "prismatic") {
            check_limit(joint, tag, findings);
        }
    }
}

fn check_kind(joint: &JointFact<'_, '_>, findings: &mut Findings<'_>) {
    if joint.kind.trim().is_empty() || KINDS.contains(&joint.kind) {
        return;
    }
    let offset = own_attribute(joint.node, "type").map_or(joint.offset(), |a| a.range().start);
    let nearest = find_nearest(joint.kind, KINDS).map(str::to_owned);
    findings.add(offset, joint.subject(), UrdfProblem::UnknownJointType { found: cut(joint.kind), nearest });
}

fn check_axis(joint: &JointFact<'_, '_>, tag: &'static Tag, findings: &mut Findings<'_>) {
    let Some((axis, axis_tag)) = part(joint.node, tag, "axis") else { return };
    // Squares of a shorter axis are lost to rounding; nobody means such a one.
    let is_zero = |v: [f64; 3]| v.iter().all(|x| x.abs() < 1e-9);
    if numbers_of::<3>(axis, axis_tag, "xyz").is_some_and(is_zero) {
        findings.add(axis.range().start, joint.subject(), UrdfProblem::ZeroAxis);
    }
}

fn check_limit(joint: &JointFact<'_, '_>, tag: &'static Tag, findings: &mut Findings<'_>) {
    let (kind, advice) = if joint.kind == "revolute" { ("revolute", TURNS_FREELY) } else { ("prismatic", "") };
    let Some((limit, limit_tag)) = part(joint.node, tag, "limit") else {
        findings.doubt(joint.offset(), joint.subject(), UrdfDoubt::MissingLimit { kind, advice });
        return;
    };
    let start = limit.range().start;
    if text_of(limit, "lower").or(text_of(limit, "upper")).is_none() {
        if version_of(limit) < BOUNDS_ARE_OPEN {
            findings.doubt(start, joint.subject(), UrdfDoubt::EmptyLimit { advice });
        }
    } else if let Some([lower, upper]) = bounds_of(limit, limit_tag).filter(|[lower, upper]| lower >= upper) {
        findings.doubt(start, joint.subject(), UrdfDoubt::NoRange { lower, upper });
    }
    if numbers_of(limit, limit_tag, "effort") == Some([0.0]) {
        findings.doubt(start, joint.subject(), UrdfDoubt::NoEffort);
    }
}

/// From this version of URDF on a missing bound is none; before, it is 0.
const BOUNDS_ARE_OPEN: (u32, u32) = (1, 2);

/// Lower and upper bound as the format has them; `None` if they are unsound.
fn bounds_of(limit: Node<'_, '_>, tag: &'static Tag) -> Option<[f64; 2]> {
    let missing = |open| if version_of(limit) < BOUNDS_ARE_OPEN { 0.0 } else { open };
    let bound = |name, open| match text_of(limit, name) {
        None => Some(missing(open)),
        Some(_) => numbers_of::<1>(limit, tag, name).map(|[x]| x),
    };
    Some([bound("lower", f64::NEG_INFINITY)?, bound("upper", f64::INFINITY)?])
}

/// What a joint may do.
pub(crate) struct Limits {
    /// Stops; one of them may be infinite, never both.
    pub(crate) position: Option<[f64; 2]>,
    /// Infinite if not given.
    pub(crate) effort: f64,
    /// Infinite if not given.
    pub(crate) velocity: f64,
}

/// The limits of a joint, after [`check_joints`] has told what is odd about them: a range that is none limits nothing.
pub(crate) fn limits_of(joint: &JointFact<'_, '_>, tag: &'static Tag) -> Limits {
    let Some((limit, limit_tag)) = part(joint.node, tag, "limit") else {
        return Limits { position: None, effort: f64::INFINITY, velocity: f64::INFINITY };
    };
    let largest = |name| numbers_of(limit, limit_tag, name).map_or(f64::INFINITY, |[x]| x);
    let has_stops = matches!(joint.kind, "revolute" | "prismatic");
    let range = bounds_of(limit, limit_tag).filter(|b| has_stops && b[0] < b[1] && b.iter().any(|x| x.is_finite()));
    Limits { position: range, effort: largest("effort"), velocity: largest("velocity") }
}

/// Resolves chains of mimics to leaders that follow nobody.
pub(crate) fn resolve_mimics(facts: &Facts<'_, '_>, findings: &mut Findings<'_>) -> Vec<Option<Follows>> {
    let direct: Vec<Option<Follows>> = facts.joints.iter().map(|j| direct_leader(facts, j, findings)).collect();
    let mut resolved: Vec<Option<Option<Follows>>> = direct.iter().map(|d| d.is_none().then_some(None)).collect();
    for start in 0..direct.len() {
        let mut chain = Vec::new();
        let mut at = start;
        // Links of a chain are marked as leading themselves while it is walked: meeting a mark is meeting a circle.
        while resolved[at].is_none() {
            resolved[at] = Some(None);
            chain.push(at);
            at = direct[at].map_or(at, |(leader, ..)| leader);
        }
        if let Some(first) = chain.iter().position(|j| *j == at) {
            report_circle(facts, &chain[first..], findings);
            continue;
        }
        for &follower in chain.iter().rev() {
            resolved[follower] = Some(direct[follower].map(|d| follow(d, &resolved)));
        }
    }
    for (joint, follows) in facts.joints.iter().zip(&resolved) {
        check_ratio(joint, follows.flatten(), findings);
    }
    resolved.into_iter().map(Option::flatten).collect()
}

/// q = m (M q_leader + O) + o.
fn follow((leader, m, o): Follows, resolved: &[Option<Option<Follows>>]) -> Follows {
    resolved[leader].flatten().map_or((leader, m, o), |(top, mm, oo)| (top, m * mm, m * oo + o))
}

fn direct_leader(facts: &Facts<'_, '_>, joint: &JointFact<'_, '_>, findings: &mut Findings<'_>) -> Option<Follows> {
    let mimic = joint.mimic?;
    let name = cut(mimic.leader.name);
    if joint.kind == "fixed" {
        findings.doubt(mimic.leader.offset, joint.subject(), UrdfDoubt::FixedFollower { leader: name });
        return None;
    }
    let problem = match facts.joint_index.get(mimic.leader.name) {
        None => {
            let nearest = nearest_name(mimic.leader.name, facts.joints.iter().map(|j| j.name), findings);
            findings.doubt(mimic.leader.offset, joint.subject(), UrdfDoubt::UnknownLeader { name, nearest });
            return None;
        }
        Some(&leader) if !facts.joints[leader].has_one_coordinate() => {
            UrdfProblem::LeaderCannotLead { name, kind: cut(facts.joints[leader].kind) }
        }
        Some(_) if !joint.has_one_coordinate() => UrdfProblem::CannotFollow { kind: cut(joint.kind) },
        Some(&leader) => return Some((leader, mimic.multiplier, mimic.offset)),
    };
    findings.add(mimic.leader.offset, joint.subject(), problem);
    None
}

fn report_circle(facts: &Facts<'_, '_>, circle: &[usize], findings: &mut Findings<'_>) {
    let Some(first) = circle.first().map(|j| &facts.joints[*j]) else { return };
    let names = circle.iter().chain(circle.first()).map(|j| facts.joints[*j].name).take(10);
    let names = cut(&names.collect::<Vec<_>>().join(" → "));
    findings.add(first.offset(), first.subject(), UrdfProblem::MimicCycle(names));
}

fn check_ratio(joint: &JointFact<'_, '_>, follows: Option<Follows>, findings: &mut Findings<'_>) {
    let is_off = |(_, m, o): Follows| !m.is_finite() || !o.is_finite() || m.abs() > 1e15 || o.abs() > 1e15;
    if let (Some(mimic), true) = (joint.mimic, follows.is_some_and(is_off)) {
        let rule = "is beyond 1e15 along the chain of leaders; check units";
        let text = mimic.multiplier.to_string();
        let problem = UrdfProblem::OutOfRange { tag: "mimic", attribute: "multiplier", text, rule };
        findings.add(mimic.leader.offset, joint.subject(), problem);
    }
}

/// The nearest of many names, for a message that will be kept.
pub(crate) fn nearest_name<'a>(
    name: &str,
    names: impl Iterator<Item = &'a str>,
    findings: &Findings<'_>,
) -> Option<String> {
    const MOST_COMPARED: usize = 2000;
    if findings.is_full() { None } else { find_nearest(name, names.take(MOST_COMPARED)).map(str::to_owned) }
}
