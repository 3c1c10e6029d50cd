//! Links and joints as one tree: every link but the root is the child of one joint.

use super::errors::{UrdfProblem, cut};
use super::facts::{Facts, JointFact, LinkFact, Mention};
use super::findings::Findings;
use super::joints::nearest_name;

/// The tree, by the file's numbering of links and joints.
pub(crate) struct Graph {
    /// Links, parents before children, the root first.
    pub(crate) order: Vec<usize>,
    /// For each link the joint that carries it, and its parent link.
    pub(crate) carried_by: Vec<Option<(usize, usize)>>,
}

/// Finds the tree; `None` if there is none, which has been reported.
pub(crate) fn build_graph(facts: &Facts<'_, '_>, findings: &mut Findings<'_>) -> Option<Graph> {
    let mut is_sound = facts.links.len() == facts.link_index.len();
    let mut carried_by = vec![None; facts.links.len()];
    for (i, joint) in facts.joints.iter().enumerate() {
        match connect(facts, i, joint, &carried_by, findings) {
            Some((parent, child)) => carried_by[child] = Some((i, parent)),
            None => is_sound = false,
        }
    }
    // Trees are not counted where a joint is lost: each half would be an error that is none.
    let root = if is_sound { find_root(facts, &carried_by, findings)? } else { return None };
    let order = order_from(root, &carried_by, &facts.joints);
    if order.len() < facts.links.len() {
        report_cycle(facts, &order, &carried_by, findings);
        return None;
    }
    Some(Graph { order, carried_by })
}

type Carried = Option<(usize, usize)>;

fn connect(
    facts: &Facts<'_, '_>,
    index: usize,
    joint: &JointFact<'_, '_>,
    carried_by: &[Carried],
    findings: &mut Findings<'_>,
) -> Option<(usize, usize)> {
    let parent = find_link(facts, joint, ("parent", joint.parent), findings);
    let child = find_link(facts, joint, ("child", joint.child), findings);
    let (parent, child) = parent.zip(child)?;
    let offset = joint.child.map_or(joint.offset(), |c| c.offset);
    if parent == child {
        findings.add(offset, joint.subject(), UrdfProblem::SelfJoint(cut(facts.links[child].name)));
        return None;
    }
    if let Some((other, _)) = carried_by[child] {
        let first = &facts.joints[other];
        let first_line = findings.line_of(first.offset());
        let (first, second) = (cut(first.name), cut(facts.joints[index].name));
        let subject = facts.links[child].subject();
        findings.add(offset, subject, UrdfProblem::TwoParents { first, first_line, second });
        return None;
    }
    Some((parent, child))
}

fn find_link(
    facts: &Facts<'_, '_>,
    joint: &JointFact<'_, '_>,
    (role, mention): (&'static str, Option<Mention<'_>>),
    findings: &mut Findings<'_>,
) -> Option<usize> {
    let mention = mention?;
    let found = facts.link_index.get(mention.name).copied();
    if found.is_none() && !mention.name.trim().is_empty() {
        let nearest = nearest_name(mention.name, facts.links.iter().map(|l| l.name), findings);
        let problem = UrdfProblem::UnknownLink { role, name: cut(mention.name), nearest };
        findings.add(mention.offset, joint.subject(), problem);
    }
    found
}

fn find_root(facts: &Facts<'_, '_>, carried_by: &[Carried], findings: &mut Findings<'_>) -> Option<usize> {
    let mut roots = (0..carried_by.len()).filter(|l| carried_by[*l].is_none());
    let Some(root) = roots.next() else {
        let offset = facts.links.first().map_or(0, LinkFact::offset);
        findings.add(offset, "robot", UrdfProblem::NoRoot);
        return None;
    };
    let mut is_only = true;
    for other in roots {
        is_only = false;
        let (root, other) = (&facts.links[root], &facts.links[other]);
        let root_line = findings.line_of(root.offset());
        let problem = UrdfProblem::SecondRoot { root: cut(root.name), root_line };
        findings.add(other.offset(), other.subject(), problem);
    }
    is_only.then_some(root)
}

/// Depth first, children in the order of their joints in the file.
fn order_from(root: usize, carried_by: &[Carried], joints: &[JointFact<'_, '_>]) -> Vec<usize> {
    let mut children: Vec<Vec<(usize, usize)>> = vec![Vec::new(); carried_by.len()];
    for (link, carried) in carried_by.iter().enumerate() {
        if let Some((joint, parent)) = carried {
            children[*parent].push((*joint, link));
        }
    }
    let mut order = Vec::with_capacity(joints.len() + 1);
    let mut open = vec![root];
    while let Some(link) = open.pop() {
        order.push(link);
        let mut next = std::mem::take(&mut children[link]);
        next.sort_unstable();
        open.extend(next.iter().rev().map(|(_, child)| child));
    }
    order
}

fn report_cycle(facts: &Facts<'_, '_>, order: &[usize], carried_by: &[Carried], findings: &mut Findings<'_>) {
    let mut is_reached = vec![false; facts.links.len()];
    order.iter().for_each(|l| is_reached[*l] = true);
    let root = order.first().map(|l| cut(facts.links[*l].name)).unwrap_or_default();
    let mut is_seen = is_reached.clone();
    for start in 0..facts.links.len() {
        // Upwards from a link that is not reached, one always comes into a cycle.
        let mut path = Vec::new();
        let mut at = start;
        while !is_seen[at] {
            is_seen[at] = true;
            path.push(at);
            at = carried_by[at].map_or(at, |(_, parent)| parent);
        }
        let Some(first) = path.iter().position(|l| *l == at) else { continue };
        let links = path[first..].iter().chain([&at]).rev().take(10).map(|l| facts.links[*l].name);
        let cycle = cut(&links.collect::<Vec<_>>().join(" → "));
        let link = &facts.links[at];
        findings.add(link.offset(), link.subject(), UrdfProblem::Cycle { root: root.clone(), cycle });
    }
}
