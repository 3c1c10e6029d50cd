//! What can be wrong with a URDF file, as sentences: where, what it is about, what is wrong, and a way out.
//!
//!   robots/gripper.urdf:12:5: link "palm": mass -1 kg is not positive; check units in robots/gripper.urdf

use super::source::Source;
use crate::mesh::MeshError;
use crate::mesh::markup::{TextPlace, place_of};
use std::path::{Path, PathBuf};

/// No file needs more of them to be mended; the rest is counted.
const MOST_ERRORS_KEPT: usize = 100;

/// One thing that is wrong with a URDF.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {subject}: {problem}", .file.display(), written(.place))]
pub struct UrdfError {
    /// The file, as the caller named it.
    pub file: PathBuf,
    /// Where in the file; `None` if it is about the whole file.
    pub place: Option<TextPlace>,
    /// What it is about: `link "palm"`, `joint "elbow"`.
    pub subject: String,
    /// What is wrong with it, and a way out.
    pub problem: UrdfProblem,
}

fn written(place: &Option<TextPlace>) -> String {
    place.map_or_else(String::new, |p| format!(":{}:{}", p.line, p.column))
}

/// What is wrong. Texts are sentences: fault; way out.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence beside each variant says what its fields are")]
pub enum UrdfProblem {
    #[error("cannot be read: {0}; check the path and its permissions")]
    Unreadable(String),
    #[error("has {bytes} bytes, more than the {limit} that a URDF may have; is it a mesh or an archive?")]
    TooLarge { bytes: u64, limit: u64 },
    #[error("is not UTF-8 text; save it as UTF-8")]
    NotUtf8,
    #[error("is not well-formed XML: {0}; mend the XML here")]
    Xml(String),
    #[error("the outermost tag is <{0}>, not <robot>; is this a URDF file?")]
    NotRobot(String),
    #[error("contains the xacro tag <{0}>; expand it first: `xacro FILE.urdf.xacro > FILE.urdf`")]
    Xacro(String),
    #[error("has no links; a robot is at least one <link>")]
    NoLinks,
    #[error("unknown tag <{tag}> in <{parent}>; did you mean <{nearest}>?")]
    MisspeltTag { tag: String, parent: &'static str, nearest: &'static str },
    #[error("tag <{tag}> does not belong in <{parent}>; move it into <{home}>")]
    MisplacedTag { tag: String, parent: &'static str, home: &'static str },
    #[error("<{parent}> has no <{tag}>; add one")]
    MissingTag { parent: &'static str, tag: &'static str },
    #[error("<{parent}> has more than one <{tag}>; keep one")]
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
    #[error("a {kind} joint needs a <limit>; add <limit lower=… upper=… effort=… velocity=…/>{advice}")]
    MissingLimit { kind: &'static str, advice: &'static str },
    #[error("limit gives neither lower nor upper, which locks the joint at 0; add both{advice}")]
    EmptyLimit { advice: &'static str },
    #[error("limit lower {lower} is above upper {upper}; swap them")]
    CrossedLimits { lower: f64, upper: f64 },
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
    #[error("mimics joint \"{name}\", which does not exist{}", mean(.nearest))]
    UnknownLeader { name: String, nearest: Option<String> },
    #[error("mimics joint \"{name}\", a {kind} joint; the leader must be revolute, continuous or prismatic")]
    LeaderCannotLead { name: String, kind: String },
    #[error("a {kind} joint cannot mimic; remove <mimic> or make it revolute, continuous or prismatic")]
    CannotFollow { kind: String },
    #[error("mimic goes round in a circle ({0}); let one of them be driven")]
    MimicCycle(String),
    #[error("{fault}; check units in {file}")]
    Inertia { fault: String, file: String },
    #[error("has an inertia but mass 0; give it a mass, or no <inertial> at all if it is only a frame")]
    NoMass,
    #[error(
        "moves link \"{link}\", which has no mass, nor has anything fixed to it; give it an <inertial> or make the joint fixed"
    )]
    MovesNoMass { link: String },
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error("the URDF parser refuses the file: {0}")]
    Parser(String),
}

fn mean(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |n| format!(", did you mean \"{n}\"?"))
}

/// All that is wrong with a URDF: at least one error, in the order of the file.
#[derive(Debug)]
pub struct UrdfErrors {
    errors: Vec<UrdfError>,
    more: usize,
}

impl UrdfErrors {
    /// The errors, in the order of the file.
    pub fn iter(&self) -> std::slice::Iter<'_, UrdfError> {
        self.errors.iter()
    }

    /// How many more there are than [`Self::iter`] gives (long lists are cut).
    pub fn more(&self) -> usize {
        self.more
    }

    pub(crate) fn of_file(file: &Path, problem: UrdfProblem) -> Self {
        let error = UrdfError { file: file.into(), place: None, subject: "URDF".into(), problem };
        Self { errors: vec![error], more: 0 }
    }
}

impl std::fmt::Display for UrdfErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, error) in self.errors.iter().enumerate() {
            let newline = if i == 0 { "" } else { "\n" };
            write!(f, "{newline}{error}")?;
        }
        if self.more > 0 {
            write!(f, "\n… and {} more", self.more)?;
        }
        Ok(())
    }
}

impl std::error::Error for UrdfErrors {}

/// Collects errors about one file while it is checked.
pub(crate) struct Findings<'a> {
    file: &'a Path,
    text: &'a str,
    source: &'a Source<'a>,
    found: Vec<(usize, UrdfError)>,
    more: usize,
}

impl<'a> Findings<'a> {
    pub(crate) fn new(file: &'a Path, text: &'a str, source: &'a Source<'a>) -> Self {
        Self { file, text, source, found: Vec::new(), more: 0 }
    }

    /// Notes a problem at a byte offset of the XML tree.
    pub(crate) fn add(&mut self, offset: usize, subject: impl Into<String>, problem: UrdfProblem) {
        if self.is_full() {
            self.more += 1;
            return;
        }
        let place = Some(place_of(self.text, self.source.original_offset(offset)));
        let error = UrdfError { file: self.file.into(), place, subject: subject.into(), problem };
        self.found.push((offset, error));
    }

    /// Whether further problems are only counted: no need to word them well.
    pub(crate) fn is_full(&self) -> bool {
        self.found.len() >= MOST_ERRORS_KEPT
    }

    /// Line of a byte offset, for texts that name a second place.
    pub(crate) fn line_of(&self, offset: usize) -> usize {
        if self.is_full() { 0 } else { place_of(self.text, self.source.original_offset(offset)).line }
    }

    pub(crate) fn file_name(&self) -> String {
        self.file.display().to_string()
    }

    /// Whether nothing is wrong so far.
    pub(crate) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// All that was found, in the order of the file.
    pub(crate) fn into_errors(mut self) -> UrdfErrors {
        self.found.sort_by_key(|(offset, _)| *offset);
        UrdfErrors { errors: self.found.into_iter().map(|(_, e)| e).collect(), more: self.more }
    }
}

/// At most 60 characters of a text from a file, for a message.
pub(crate) fn cut(text: &str) -> String {
    if text.chars().nth(60).is_none() { text.into() } else { text.chars().take(60).chain(['…']).collect() }
}
