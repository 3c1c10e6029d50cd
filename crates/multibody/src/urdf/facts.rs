//! What the checks need to know of each link and joint, with its place in the file.
//!
//! A fact is `None` where the file does not tell it, or tells it wrongly (the walk has reported that already), so the
//! checks after the walk say only what is new.

use super::errors::UrdfProblem;
use super::findings::Findings;
use super::schema::{ROBOT, Tag};
use super::walk::{numbers_of, own_children, subject_of, text_of};
use roxmltree::Node;
use spatial::nalgebra::Quaternion;
use spatial::{Inertia, Mat3, Pose, Rot, Vec3};
use std::collections::HashMap;

/// A link.
pub(crate) struct LinkFact<'a, 'i> {
    pub(crate) node: Node<'a, 'i>,
    pub(crate) name: &'a str,
    /// `<inertial>`, if it is sound.
    pub(crate) inertial: Option<InertialFact>,
}

/// Mass, place of its centre in the link frame, and tensor about it.
pub(crate) struct InertialFact {
    pub(crate) offset: usize,
    pub(crate) mass: f64,
    pub(crate) com: Vec3,
    /// In the inertial frame's own axes, as written.
    pub(crate) tensor: Mat3,
    /// In the link's axes.
    pub(crate) tensor_l: Mat3,
}

impl InertialFact {
    /// About the link's origin, in its axes.
    pub(crate) fn inertia(&self) -> Inertia {
        Inertia::from_com(self.mass, &self.com, &self.tensor_l)
    }

    /// Whether it says nothing.
    pub(crate) fn is_nothing(&self) -> bool {
        self.mass == 0.0 && self.tensor.iter().all(|x| *x == 0.0)
    }
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
    let pose_li = origin_of(node, tag)?;
    let (com, tensor_l) = (pose_li.translation.vector, turned(&tensor, &pose_li.rotation));
    Some(InertialFact { offset: node.range().start, mass, com, tensor, tensor_l })
}

/// R I Rᵀ, symmetric to the last bit, and without rounding where nothing turns.
fn turned(tensor: &Mat3, rotation: &Rot) -> Mat3 {
    if *rotation == Rot::identity() {
        return *tensor;
    }
    let rot = rotation.to_rotation_matrix().into_inner();
    let turned = rot * tensor * rot.transpose();
    0.5 * (turned + turned.transpose())
}

/// The pose that a tag's `<origin>` gives: R = Rz(yaw) Ry(pitch) Rx(roll); `None` if it is unsound.
pub(crate) fn origin_of(node: Node<'_, '_>, tag: &'static Tag) -> Option<Pose> {
    let Some((origin, tag)) = part(node, tag, "origin") else { return Some(Pose::identity()) };
    let given = |name| text_of(origin, name).is_some();
    let vector = |name| if given(name) { numbers_of::<3>(origin, tag, name) } else { Some([0.0; 3]) };
    let [roll, pitch, yaw] = vector("rpy")?;
    let rotation = if given("quat_xyzw") {
        let [x, y, z, w] = numbers_of(origin, tag, "quat_xyzw")?;
        Rot::new_normalize(Quaternion::new(w, x, y, z))
    } else {
        Rot::from_euler_angles(roll, pitch, yaw)
    };
    Some(Pose::from_parts(Vec3::from(vector("xyz")?).into(), rotation))
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
