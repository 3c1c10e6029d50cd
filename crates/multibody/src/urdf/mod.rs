//! URDF files to checked [`RobotDescription`]s.
//!
//! 1. The text is parsed as XML, with positions ([`source`]); xacro is told from URDF ([`xacro`]).
//! 2. Every tag and attribute is held against a table ([`schema`], [`walk`], [`numbers`]).
//! 3. What the tags say is checked as a robot: names and facts ([`facts`]), joints and mimics ([`joints`]), one tree
//!    ([`graph`]), rigid bodies ([`physics`]), meshes ([`meshes`]). Everything that is wrong ([`errors`]) or doubtful
//!    ([`doubts`]) is told at once, each thing once, in the order of the file ([`findings`]).
//! 4. The tags of the table become a description ([`convert`]).
//!
//! Why a reader of our own: the usual ones pass over what they do not know. A misspelt `<inertail>` would be a mass of
//! zero, `nan` a mass, two links of one name two links; and a missing `<limit>` would lock a joint at zero.

mod checks;
mod convert;
mod docking;
mod doubts;
mod errors;
mod facts;
mod findings;
mod graph;
mod joints;
mod meshes;
mod nearest;
mod numbers;
mod physics;
mod schema;
mod source;
mod walk;
mod xacro;

pub use doubts::{Loss, UrdfDoubt};
pub use errors::UrdfProblem;
pub use findings::{UrdfError, UrdfErrors, UrdfFinding, UrdfFindings, UrdfWarning, UrdfWarnings};

use crate::mesh::SearchPaths;
use crate::{RobotDescription, Tree};
use checks::check_robot;
use convert::convert;
use errors::cut;
use findings::Findings;
use meshes::Surroundings;
use physics::{check_energy, check_freedoms};
use roxmltree::Node;
use source::Source;
use std::path::Path;
use xacro::find_xacro;

/// Larger files are no hand's or xacro's work.
const LARGEST_FILE_BYTES: u64 = 16 << 20;

/// A robot and what is doubtful in its file.
#[derive(Clone, Debug)]
pub struct LoadedUrdf {
    /// The robot, as the file describes it.
    pub robot: RobotDescription,
    /// What was odd, and what was assumed.
    pub warnings: UrdfWarnings,
}

/// Loads a robot with its meshes, or tells everything that is wrong with its file.
///
/// Mesh paths without a scheme are relative to the file; `package://` is looked up as [`SearchPaths`] says. A robot loads
/// if it can be simulated somehow: on a fixed base its root needs no mass, and a joint that nothing resists can be given
/// an armature ([`crate::find_singular_freedoms`] tells what is left before a simulation).
pub fn load_urdf(path: &Path, search: &SearchPaths) -> Result<LoadedUrdf, UrdfErrors> {
    let failed = |problem| UrdfErrors::of_file(path, problem);
    let meta = std::fs::metadata(path).map_err(|e| failed(UrdfProblem::Unreadable(e.to_string())))?;
    if !meta.is_file() {
        return Err(failed(UrdfProblem::Unreadable("it is not a regular file".into())));
    }
    if meta.len() > LARGEST_FILE_BYTES {
        return Err(failed(UrdfProblem::TooLarge { bytes: meta.len(), limit: LARGEST_FILE_BYTES }));
    }
    let bytes = std::fs::read(path).map_err(|e| failed(UrdfProblem::Unreadable(e.to_string())))?;
    parse_urdf(&String::from_utf8_lossy(&bytes), path, path.parent().unwrap_or(Path::new("")), search)
}

/// As [`load_urdf`], from text; `file` is what messages call it, `base_dir` what mesh paths are relative to.
pub fn parse_urdf(text: &str, file: &Path, base_dir: &Path, search: &SearchPaths) -> Result<LoadedUrdf, UrdfErrors> {
    if text.len() as u64 > LARGEST_FILE_BYTES {
        let problem = UrdfProblem::TooLarge { bytes: text.len() as u64, limit: LARGEST_FILE_BYTES };
        return Err(UrdfErrors::of_file(file, problem));
    }
    let source = Source::mended(text);
    let mut findings = Findings::new(file, text, &source);
    let document = match source.parse() {
        Ok(document) => document,
        Err(error) => {
            findings.add(error.offset, "URDF", UrdfProblem::Xml(error.said));
            return Err(findings.into_errors());
        }
    };
    match read_robot(document.root_element(), file, &Surroundings { base_dir, search }, &mut findings) {
        Some(robot) if findings.is_sound() => Ok(LoadedUrdf { robot, warnings: findings.into_warnings() }),
        _ => Err(findings.into_errors()),
    }
}

/// The robot of a document; `None` if an error was found.
fn read_robot(
    root: Node<'_, '_>,
    file: &Path,
    surroundings: &Surroundings<'_>,
    findings: &mut Findings<'_>,
) -> Option<RobotDescription> {
    let start = root.range().start;
    if root.tag_name().name() != "robot" {
        findings.add(start, "URDF", UrdfProblem::NotRobot(cut(root.tag_name().name())));
        return None;
    }
    if let Some((offset, xacro)) = find_xacro(root, file) {
        findings.add(offset, "URDF", xacro);
        return None;
    }
    findings.doubt_text();
    let checked = check_robot(root, surroundings, findings).filter(|_| findings.is_sound())?;
    let robot = convert(root, &checked, file);
    match &robot {
        Some(robot) => {
            let tree = Tree::from_description(robot);
            check_energy(&tree, &checked.facts, findings);
            check_freedoms(&tree, &checked.facts, &checked.graph, findings);
        }
        None => findings.add(start, "URDF", UrdfProblem::Inconsistent),
    }
    robot
}
