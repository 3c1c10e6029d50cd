//! What the checks need to know of each link and joint, with its place in the file.
//!
//! A fact is `None` where the file does not tell it, or tells it wrongly (the walk has reported that already), so the
//! checks after the walk say only what is new.

use super::errors::{Findings, UrdfProblem};
use super::schema::{ROBOT, Tag};
use super::walk::{numbers_of, own_children, subject_of, text_of};
use roxmltree::Node;
use spatial::Mat3;
use std::collections::HashMap;

/// A link.
pub(crate) struct LinkFact<'a, 'i> {
    pub(crate) node: Node<'a, 'i>,
    pub(crate) name: &'a str,
    /// `<inertial>`, if it is sound.
    pub(crate) inertial: Option<InertialFact>,
}

/// Mass and tensor, in the inertial frame's own axes.
pub(crate) struct InertialFact {
    pub(crate) offset: usize,
    pub(crate) mass: f64,
    pub(crate) tensor: Mat3,
}

/// A joint.
pub(crate) struct JointFact<'a, 'i> {
    pub(crate) node: Node<'a, 'i>,
    pub(crate) name: &'a str,
    /// The type as written.
    pub(crate) kind: &'a str,
    pub(crate) parent: Option<Mention<'a>>,
    pub(crate) child: Option<Mention<'a>>,
    pub(crate) mimic: Option<MimicFact<'a>>,
}

/// A name that refers to a link or joint, and where it stands.
#[derive(Clone, Copy)]
pub(crate) struct Mention<'a> {
    pub(crate) name: &'a str,
    pub(crate) offset: usize,
}

/// A `<mimic>`.
#[derive(Clone, Copy)]
pub(crate) struct MimicFact<'a> {
    pub(crate) leader: Mention<'a>,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

/// All of a robot.
pub(crate) struct Facts<'a, 'i> {
    pub(crate) links: Vec<LinkFact<'a, 'i>>,
    pub(crate) joints: Vec<JointFact<'a, 'i>>,
    pub(crate) link_index: HashMap<&'a str, usize>,
    pub(crate) joint_index: HashMap<&'a str, usize>,
}

impl LinkFact<'_, '_> {
    pub(crate) fn subject(&self) -> String {
        subject_of(self.node)
    }

    pub(crate) fn offset(&self) -> usize {
        self.node.range().start
    }

    /// Whether it says something of its mass, sound or not.
    pub(crate) fn has_inertial_tag(&self) -> bool {
        own_children(self.node).any(|n| n.tag_name().name() == "inertial")
    }

    /// Whether it has a mass.
    pub(crate) fn has_mass(&self) -> bool {
        self.inertial.as_ref().is_some_and(|i| i.mass != 0.0)
    }
}

impl JointFact<'_, '_> {
    pub(crate) fn subject(&self) -> String {
        subject_of(self.node)
    }

    pub(crate) fn offset(&self) -> usize {
        self.node.range().start
    }

    /// Whether it moves by one coordinate.
    pub(crate) fn has_one_coordinate(&self) -> bool {
        matches!(self.kind, "revolute" | "continuous" | "prismatic")
    }
}

/// The table's entry of a tag inside another.
pub(crate) fn tag_in(parent: &'static Tag, name: &str) -> Option<&'static Tag> {
    parent.children.iter().find(|c| c.tag.name == name).map(|c| c.tag)
}

/// The first child with this name, and its entry in the table.
pub(crate) fn part<'a, 'i>(
    node: Node<'a, 'i>,
    parent: &'static Tag,
    name: &str,
) -> Option<(Node<'a, 'i>, &'static Tag)> {
    let tag = tag_in(parent, name)?;
    own_children(node).find(|c| c.tag_name().name() == name).map(|c| (c, tag))
}

/// Reads the facts; names that stand twice are reported.
pub(crate) fn collect_facts<'a, 'i>(robot: Node<'a, 'i>, findings: &mut Findings<'_>) -> Facts<'a, 'i> {
    let named = |tag: &'static str| own_children(robot).filter(move |n| n.tag_name().name() == tag);
    let links: Vec<_> = named("link").filter_map(link_fact).collect();
    let joints: Vec<_> = named("joint").filter_map(joint_fact).collect();
    let link_index = index_names(links.iter().map(|l| (l.name, l.node)), findings);
    let joint_index = index_names(joints.iter().map(|j| (j.name, j.node)), findings);
    Facts { links, joints, link_index, joint_index }
}

fn index_names<'a, 'i: 'a>(
    named: impl Iterator<Item = (&'a str, Node<'a, 'i>)>,
    findings: &mut Findings<'_>,
) -> HashMap<&'a str, usize> {
    let mut first: HashMap<&str, (usize, usize)> = HashMap::new();
    for (i, (name, node)) in named.enumerate() {
        let start = node.range().start;
        let (_, first_start) = *first.entry(name).or_insert((i, start));
        if first_start != start {
            let first_line = findings.line_of(first_start);
            findings.add(start, subject_of(node), UrdfProblem::DuplicateName { first_line });
        }
    }
    first.into_iter().map(|(name, (i, _))| (name, i)).collect()
}

fn link_fact<'a, 'i>(node: Node<'a, 'i>) -> Option<LinkFact<'a, 'i>> {
    let name = text_of(node, "name")?;
    let tag = tag_in(&ROBOT, "link")?;
    let inertial = part(node, tag, "inertial").and_then(|(node, tag)| inertial_fact(node, tag));
    Some(LinkFact { node, name, inertial })
}

fn inertial_fact(node: Node<'_, '_>, tag: &'static Tag) -> Option<InertialFact> {
    let (mass_node, mass_tag) = part(node, tag, "mass")?;
    let [mass] = numbers_of(mass_node, mass_tag, "value")?;
    let (inertia, inertia_tag) = part(node, tag, "inertia")?;
    let moment = |name| match text_of(inertia, name) {
        None => Some(0.0),
        Some(_) => numbers_of::<1>(inertia, inertia_tag, name).map(|[x]| x),
    };
    let (ixx, iyy, izz) = (moment("ixx")?, moment("iyy")?, moment("izz")?);
    let (ixy, ixz, iyz) = (moment("ixy")?, moment("ixz")?, moment("iyz")?);
    let tensor = Mat3::new(ixx, ixy, ixz, ixy, iyy, iyz, ixz, iyz, izz);
    Some(InertialFact { offset: node.range().start, mass, tensor })
}

fn joint_fact<'a, 'i>(node: Node<'a, 'i>) -> Option<JointFact<'a, 'i>> {
    let tag = tag_in(&ROBOT, "joint")?;
    let mention = |part_name: &str| {
        let (node, _) = part(node, tag, part_name)?;
        Some(Mention { name: text_of(node, "link")?, offset: node.range().start })
    };
    Some(JointFact {
        node,
        name: text_of(node, "name")?,
        kind: text_of(node, "type").unwrap_or_default(),
        parent: mention("parent"),
        child: mention("child"),
        mimic: part(node, tag, "mimic").and_then(|(node, tag)| mimic_fact(node, tag)),
    })
}

fn mimic_fact<'a>(node: Node<'a, '_>, tag: &'static Tag) -> Option<MimicFact<'a>> {
    let number = |name, otherwise| numbers_of::<1>(node, tag, name).map_or(otherwise, |[x]| x);
    let leader = Mention { name: text_of(node, "joint")?, offset: node.range().start };
    Some(MimicFact { leader, multiplier: number("multiplier", 1.0), offset: number("offset", 0.0) })
}
