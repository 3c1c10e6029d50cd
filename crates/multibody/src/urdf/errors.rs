//! What can be wrong with a URDF file, as sentences: what it is about, what is wrong, and a way out.
//!
//!   robots/gripper.urdf:12:5: link "palm": mass -1 kg is not positive; check its units (kg, m, kg·m²)
//!
//! Wrong is what cannot be simulated, and what would be lost in silence; the rest is doubtful ([`super::doubts`]).

use crate::mesh::MeshError;

/// What is wrong. Texts are sentences: fault; way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence beside each variant says what its fields are")]
pub enum UrdfProblem {
    #[error("cannot be read: {0}; check the path and its permissions")]
    Unreadable(String),
    #[error("has {bytes} bytes, more than the {limit} that a URDF may have; is it a mesh or an archive?")]
    TooLarge { bytes: u64, limit: u64 },
    #[error("is not well-formed XML: {0}; mend the XML here")]
    Xml(String),
    #[error("the outermost tag is <{0}>, not <robot>; is this a URDF file?")]
    NotRobot(String),
    #[error(
        "is a xacro source (it has {found}), not yet a URDF; expand it first: `xacro {file} > {expanded}` (`pip install xacro`, or a ROS installation)"
    )]
    Xacro { found: String, file: String, expanded: String },
    #[error("has no links; a robot is at least one <link>")]
    NoLinks,
    #[error("unknown tag <{tag}> in <{parent}>; did you mean <{nearest}>?")]
    MisspeltTag { tag: String, parent: &'static str, nearest: &'static str },
    #[error("tag <{tag}> does not belong in <{parent}>; move it into <{home}>")]
    MisplacedTag { tag: String, parent: &'static str, home: &'static str },
    #[error("<{parent}> has no <{tag}>; add one")]
    MissingTag { parent: &'static str, tag: &'static str },
    #[error("<{parent}> has more than one <{tag}>, and they differ; keep one")]
    RepeatedTag { parent: &'static str, tag: &'static str },
    #[error("<geometry> holds no shape; put one of <box>, <sphere>, <cylinder>, <capsule>, <mesh> in it")]
    NoShape,
    #[error("<softdock_shape> holds no shape; put one of <inner_cone>, <inner_cylinder>, <ring>, <petal> in it")]
    NoDockingShape,
    #[error("<softdock_shape> holds several shapes; give each a <collision> of its own")]
    SeveralDockingShapes,
    #[error("<geometry> holds several shapes; give each a <visual> or <collision> of its own")]
    SeveralShapes,
    #[error("<{tag}> has no attribute {attribute}; add {attribute}=\"{example}\"")]
    MissingAttribute { tag: &'static str, attribute: &'static str, example: &'static str },
    #[error("<{tag}> has no attribute {found}; did you mean {nearest}?")]
    MisspeltAttribute { tag: &'static str, found: String, nearest: &'static str },
    #[error("{tag} {attribute} \"{text}\": \"{word}\" is not a finite number; write plain SI numbers")]
    BadNumber { tag: &'static str, attribute: &'static str, text: String, word: String },
    #[error("{tag} {attribute} \"{text}\" has {found} numbers instead of {expected}; separate them by spaces")]
    WrongLength { tag: &'static str, attribute: &'static str, text: String, found: usize, expected: usize },
    #[error("{tag} {attribute} \"{text}\" {rule}")]
    OutOfRange { tag: &'static str, attribute: &'static str, text: String, rule: &'static str },
    #[error("both rpy and quat_xyzw are given; keep one")]
    TwoOrientations,
    #[error("quat_xyzw needs URDF 1.1; write <robot version=\"1.1\" …> or use rpy")]
    QuaternionNeedsVersion,
    #[error("the name stands in the file twice, first in line {first_line}; rename one")]
    DuplicateName { first_line: usize },
    #[error("unknown joint type \"{found}\"{}; types: revolute, continuous, prismatic, fixed, floating, planar", mean(.nearest))]
    UnknownJointType { found: String, nearest: Option<String> },
    #[error("axis 0 0 0 has no direction; give the unit vector it moves along or about, in the joint frame")]
    ZeroAxis,
    #[error("{role} link \"{name}\" does not exist{}; every joint connects two <link>s of this file", mean(.nearest))]
    UnknownLink { role: &'static str, name: String, nearest: Option<String> },
    #[error("connects link \"{0}\" to itself; a joint connects two links")]
    SelfJoint(String),
    #[error(
        "has two parents: joint \"{first}\" (line {first_line}) and joint \"{second}\"; a link has one parent, close loops in the simulation"
    )]
    TwoParents { first: String, first_line: usize, second: String },
    #[error(
        "no joint leads to it, as to link \"{root}\" (line {root_line}), so there are two trees; connect them by a joint"
    )]
    SecondRoot { root: String, root_line: usize },
    #[error("every link is some joint's child, so there is no root; the joints form a cycle, cut it at the base link")]
    NoRoot,
    #[error("is not reachable from the root link \"{root}\": its joints form a cycle ({cycle}); cut the cycle")]
    Cycle { root: String, cycle: String },
    #[error("mimics joint \"{name}\", a {kind} joint; the leader must be revolute, continuous or prismatic")]
    LeaderCannotLead { name: String, kind: String },
    #[error("a {kind} joint cannot mimic; remove <mimic> or make it revolute, continuous or prismatic")]
    CannotFollow { kind: String },
    #[error("mimic goes round in a circle ({0}); let one of them be driven")]
    MimicCycle(String),
    #[error("{0}; check its units (kg, m, kg·m²)")]
    Inertia(String),
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error("its tags and its tree do not fit together; please send the file to softdock's authors")]
    Inconsistent,
}

/// "did you mean …?", where there is something near.
pub(super) fn mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |n| format!(", did you mean \"{n}\"?"))
}

/// At most 60 characters of a text from a file, for a message.
pub(crate) fn cut(text: &str) -> String {
    if text.chars().nth(60).is_none() { text.into() } else { text.chars().take(60).chain(['…']).collect() }
}
