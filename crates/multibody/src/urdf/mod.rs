//! URDF files to checked [`RobotDescription`]s.
//!
//! 1. The text is parsed as XML, with positions ([`source`]).
//! 2. Every tag and attribute is held against a table ([`schema`], [`walk`], [`numbers`]).
//! 3. What the tags say is checked as a robot: names and facts ([`facts`]), joints and mimics ([`joints`]), one tree
//!    ([`graph`]), rigid bodies ([`physics`]), meshes ([`checks`]). Everything that is wrong is told at once.
//! 4. What is left is written out without vendors' tags ([`clean`]), read by urdf-rs, and converted ([`convert`]).
//!
//! The walk stands before urdf-rs because urdf-rs passes over what it does not know: a misspelt `<inertail>` would be
//! a mass of zero, `nan` a mass, two links of one name two links.

mod checks;
mod clean;
mod convert;
mod docking;
mod errors;
mod facts;
mod graph;
mod joints;
mod nearest;
mod numbers;
mod physics;
mod schema;
mod source;
mod walk;

pub use errors::{UrdfError, UrdfErrors, UrdfProblem};

use crate::RobotDescription;
use crate::mesh::SearchPaths;
use checks::{Surroundings, check_robot};
use errors::{Findings, cut};
use source::Source;
use std::path::Path;

/// Larger files are no hand's or xacro's work.
const LARGEST_FILE_BYTES: u64 = 16 << 20;

/// Loads a robot with its meshes, or tells everything that is wrong with its file.
///
/// Mesh paths without a scheme are relative to the file; `package://` is looked up as [`SearchPaths`] says.
/// A robot whose root has no mass loads: it can stand on a fixed base ([`RobotDescription::root_has_mass`]).
pub fn load_urdf(path: &Path, search: &SearchPaths) -> Result<RobotDescription, UrdfErrors> {
    let failed = |problem| UrdfErrors::of_file(path, problem);
    let meta = std::fs::metadata(path).map_err(|e| failed(UrdfProblem::Unreadable(e.to_string())))?;
    if !meta.is_file() {
        return Err(failed(UrdfProblem::Unreadable("it is not a regular file".into())));
    }
    if meta.len() > LARGEST_FILE_BYTES {
        return Err(failed(UrdfProblem::TooLarge { bytes: meta.len(), limit: LARGEST_FILE_BYTES }));
    }
    let bytes = std::fs::read(path).map_err(|e| failed(UrdfProblem::Unreadable(e.to_string())))?;
    let text = String::from_utf8(bytes).map_err(|_| failed(UrdfProblem::NotUtf8))?;
    parse_urdf(&text, path, path.parent().unwrap_or(Path::new("")), search)
}

/// As [`load_urdf`], from text; `file` is what messages call it, `base_dir` what mesh paths are relative to.
pub fn parse_urdf(
    text: &str,
    file: &Path,
    base_dir: &Path,
    search: &SearchPaths,
) -> Result<RobotDescription, UrdfErrors> {
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
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        findings.add(robot.range().start, "URDF", UrdfProblem::NotRobot(cut(robot.tag_name().name())));
        return Err(findings.into_errors());
    }
    let checked = check_robot(robot, &Surroundings { base_dir, search }, &mut findings);
    let Some(checked) = checked.filter(|_| findings.is_empty()) else { return Err(findings.into_errors()) };
    let parsed = urdf_rs::read_from_string(&clean::write_clean(robot)).map_err(|e| e.to_string());
    let differs = || "it reads other links, joints or mesh names than the checks".to_owned();
    parsed.and_then(|parsed| convert::convert(&parsed, &checked, file).ok_or_else(differs)).map_err(|said| {
        findings.add(robot.range().start, "URDF", UrdfProblem::Parser(said));
        findings.into_errors()
    })
}
