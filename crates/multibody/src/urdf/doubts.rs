//! What is doubtful in a URDF file, as sentences: what it is about, what is odd, what was assumed, and how to settle it.
//!
//! ```text
//! robots/arm.urdf:40:3: joint "elbow": a revolute joint without <limit>: it has none; add …
//! ```
//!
//! A robot with doubts loads. What is assumed is what Pinocchio (4.1) assumes wherever that can be simulated.

use super::errors::mean;
use crate::MeshError;

/// What is doubtful. Texts are sentences: oddity: assumption; way to settle it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence beside each variant says what its fields are")]
pub enum UrdfDoubt {
    #[error("is not UTF-8 text: bytes that are none are read as \u{fffd}; save it as UTF-8")]
    NotUtf8,
    #[error("blanks stand before the XML declaration: they are passed over; delete them")]
    BlanksFirst,
    #[error("<{parent}> has more than one <{tag}>: they agree, and the first counts; keep one")]
    RepeatedTag { parent: &'static str, tag: &'static str },
    #[error(
        "<geometry> holds <{tag}>, which is no shape of URDF: it is {loss}; use box, sphere, cylinder, capsule or mesh"
    )]
    UnknownShape { tag: String, loss: Loss },
    #[error("mesh scale \"{text}\" has more than 3 numbers: the first three count; delete the others")]
    LongScale { text: String },
    #[error("{tag} {attribute} \"{text}\" {rule}: the visual is left out")]
    Unseen { tag: &'static str, attribute: &'static str, text: String, rule: &'static str },
    #[error("{tag} {attribute} \"{text}\" {rule}: the colour is passed over")]
    NoColour { tag: &'static str, attribute: &'static str, text: String, rule: &'static str },
    #[error("{mesh}: it is {loss}")]
    Mesh { mesh: MeshError, loss: Loss },
    #[error("{place}: {} {loss}", meshes(.count))]
    Meshes { place: MeshError, count: usize, loss: Loss },
    #[error("a {kind} joint without <limit>: it has none; add <limit lower=… upper=… effort=… velocity=…/>{advice}")]
    MissingLimit { kind: &'static str, advice: &'static str },
    #[error("limit gives neither lower nor upper: the joint has no stops; add both{advice}")]
    EmptyLimit { advice: &'static str },
    #[error(
        "limit lower {lower} is not below upper {upper}: the joint has no stops; swap them, or make the joint fixed to hold it"
    )]
    NoRange { lower: f64, upper: f64 },
    #[error("limit effort 0: a drive without a limit of its own can give nothing; write what the joint bears")]
    NoEffort,
    #[error("a fixed joint cannot follow joint \"{leader}\": its <mimic> is passed over; remove it")]
    FixedFollower { leader: String },
    #[error("mimics joint \"{name}\", which does not exist{}: it moves on its own; correct the name", mean(.nearest))]
    UnknownLeader { name: String, nearest: Option<String> },
    #[error("{0}, which no rigid body does: it is simulated as written; check units, axes and origin of the inertia")]
    NotRigid(String),
    #[error(
        "{0}: it is simulated as written, since what moves with it makes up for it; check units and signs of the inertia"
    )]
    NotAlone(String),
    #[error("has an inertia but mass 0: it is simulated as written; give it a mass, or no <inertial> if it is a frame")]
    NoMass,
    #[error("has a mass of {mass} kg but no inertia, nor has anything fixed to it: it is a point mass; add an inertia")]
    PointMass { mass: f64 },
    #[error(
        "neither link \"{link}\" nor anything beyond has mass: the joint cannot be simulated while it moves freely; give the link an <inertial>, make the joint fixed, or give it an armature in the scenario"
    )]
    MovesNoMass { link: String },
    #[error(
        "what it moves resists it with no inertia (point masses, or axes that coincide): the joint cannot be simulated while it moves freely; give link \"{link}\" or a link beyond it an inertia, or give the joint an armature in the scenario"
    )]
    MovesNoInertia { link: String },
}

fn meshes(count: &usize) -> String {
    if *count == 1 { "the mesh in it is".to_owned() } else { format!("the {count} meshes in it are") }
}

/// What a shape that cannot be had leaves missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loss {
    /// Something is not drawn.
    pub seen: bool,
    /// Something cannot touch; a contact that needs it is refused.
    pub touching: bool,
}

impl std::fmt::Display for Loss {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match (self.seen, self.touching) {
            (true, true) => "neither drawn nor felt, and a contact that needs what is missing is refused",
            (_, true) => "not felt, and a contact that needs what is missing is refused",
            _ => "not drawn",
        })
    }
}
