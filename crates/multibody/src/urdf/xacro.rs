//! Xacro, the macro language that most URDFs are written in: recognised, and told how to expand it.
//!
//! Its tags have a namespace of its own; its substitutions, `${…}` and `$(…)`, stand in the attributes of URDF's own tags.
//! In comments, and inside what vendors add, they mean nothing here: expanded files are full of them.

use super::errors::{UrdfProblem, cut};
use super::schema::{ROBOT, Tag};
use super::walk::own_children;
use roxmltree::Node;
use std::path::Path;

/// The first trace of xacro: its offset and what to say; `None` for a URDF.
pub(crate) fn find_xacro(robot: Node<'_, '_>, file: &Path) -> Option<(usize, UrdfProblem)> {
    let tag = robot.descendants().find(|n| n.tag_name().namespace().is_some_and(|uri| uri.contains("xacro")));
    let tag = tag.map(|n| (n.range().start, format!("<xacro:{}>", cut(n.tag_name().name()))));
    let (offset, found) = tag.into_iter().chain(find_substitution(robot, &ROBOT)).min()?;
    Some((offset, UrdfProblem::Xacro { found, file: file.display().to_string(), expanded: expanded_name(file) }))
}

/// The first attribute of the table's tags that is to be substituted.
fn find_substitution(node: Node<'_, '_>, tag: &'static Tag) -> Option<(usize, String)> {
    let mut own = node.attributes().filter(|a| tag.attributes.iter().any(|known| known.name == a.name()));
    let found = own.find(|a| a.value().contains("${") || a.value().contains("$("));
    let found = found.map(|a| (a.range().start, format!("{}=\"{}\"", a.name(), cut(a.value()))));
    found.or_else(|| {
        own_children(node).find_map(|child| {
            let known = tag.children.iter().find(|c| c.tag.name == child.tag_name().name())?;
            find_substitution(child, known.tag)
        })
    })
}

/// `arm.urdf` for `arm.urdf.xacro` and `arm.xacro`, `arm.expanded.urdf` for `arm.urdf`.
fn expanded_name(file: &Path) -> String {
    let is_xacro = file.extension().is_some_and(|e| e.eq_ignore_ascii_case("xacro"));
    let stem = file.file_stem().map(Path::new).unwrap_or(file);
    let bare = if is_xacro { stem.with_extension("urdf") } else { stem.with_extension("expanded.urdf") };
    bare.display().to_string()
}
