//! The first walk over the XML: tags and attributes against the table of [`super::schema`].
//!
//! The walk goes only where the table goes, four tags deep, so a document nested a million deep costs no stack.

use super::errors::{Findings, UrdfProblem, cut};
use super::nearest::find_nearest;
use super::numbers::parse_numbers;
use super::schema::{Attribute, Count, HOMES, ROBOT, Tag, example_of};
use roxmltree::Node;

/// Tags of this document's own vocabulary, as opposed to a vendor's with a namespace of its own.
pub(crate) fn own_children<'a, 'i: 'a>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    let namespace = node.tag_name().namespace();
    node.children().filter(move |c| c.is_element() && c.tag_name().namespace() == namespace)
}

/// Whether the attribute has no namespace; others are a vendor's.
pub(crate) fn own_attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<roxmltree::Attribute<'a, 'a>> {
    node.attributes().find(|a| a.namespace().is_none() && a.name() == name)
}

/// The text of an attribute.
pub(crate) fn text_of<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    own_attribute(node, name).map(|a| a.value())
}

/// The numbers of an attribute, if it is there and sound (the walk has told if it is not).
pub(crate) fn numbers_of<const N: usize>(node: Node<'_, '_>, tag: &Tag, name: &str) -> Option<[f64; N]> {
    let attribute = tag.attributes.iter().find(|a| a.name == name)?;
    parse_numbers(tag, attribute, text_of(node, name)?).ok()?.try_into().ok()
}

/// Checks every tag and attribute below `<robot>`.
pub(crate) fn check_tags(robot: Node<'_, '_>, findings: &mut Findings<'_>) {
    check_attributes(robot, &ROBOT, "robot", findings);
    for node in own_children(robot) {
        let Some(child) = ROBOT.children.iter().find(|c| c.tag.name == node.tag_name().name()) else {
            check_unknown_tag(node, &ROBOT, "robot", findings);
            continue;
        };
        check_tag(node, child.tag, &subject_of(node), findings);
    }
    check_vendor_tags(robot, findings);
}

/// `link "palm"`, or the tag alone if it has no name.
pub(crate) fn subject_of(node: Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    text_of(node, "name").map_or_else(|| format!("nameless {}", cut(tag)), |n| format!("{} \"{}\"", cut(tag), cut(n)))
}

fn check_tag(node: Node<'_, '_>, tag: &'static Tag, subject: &str, findings: &mut Findings<'_>) {
    check_attributes(node, tag, subject, findings);
    for node in own_children(node) {
        match tag.children.iter().find(|c| c.tag.name == node.tag_name().name()) {
            Some(child) => check_tag(node, child.tag, subject, findings),
            None => check_unknown_tag(node, tag, subject, findings),
        }
    }
    check_counts(node, tag, subject, findings);
}

fn check_counts(node: Node<'_, '_>, tag: &'static Tag, subject: &str, findings: &mut Findings<'_>) {
    let mut shapes = 0;
    for child in tag.children {
        let mut found = own_children(node).filter(|n| n.tag_name().name() == child.tag.name);
        let (first, second) = (found.next(), found.next());
        shapes += usize::from(first.is_some()) + usize::from(second.is_some());
        if child.count == Count::One && first.is_none() {
            let problem = UrdfProblem::MissingTag { parent: tag.name, tag: child.tag.name };
            findings.add(node.range().start, subject, problem);
        }
        if let (Some(second), false, true) = (second, tag.is_choice, child.count != Count::Many) {
            let problem = UrdfProblem::RepeatedTag { parent: tag.name, tag: child.tag.name };
            findings.add(second.range().start, subject, problem);
        }
    }
    match (tag.is_choice, shapes) {
        (true, 0) if tag.name != "geometry" => {
            findings.add(node.range().start, subject, UrdfProblem::NoDockingShape);
        }
        (true, 2..) if tag.name != "geometry" => {
            findings.add(node.range().start, subject, UrdfProblem::SeveralDockingShapes);
        }
        (true, 0) => findings.add(node.range().start, subject, UrdfProblem::NoShape),
        (true, 2..) => findings.add(node.range().start, subject, UrdfProblem::SeveralShapes),
        _ => {}
    }
}

fn check_unknown_tag(node: Node<'_, '_>, parent: &'static Tag, subject: &str, findings: &mut Findings<'_>) {
    let found = node.tag_name().name();
    if parent.passed_over.contains(&found) {
        return;
    }
    let tag = cut(found);
    if let Some(home) = find_home(found, parent) {
        findings.add(node.range().start, subject, UrdfProblem::MisplacedTag { tag, parent: parent.name, home });
    } else if let Some(nearest) = find_nearest(found, parent.children.iter().map(|c| c.tag.name)) {
        findings.add(node.range().start, subject, UrdfProblem::MisspeltTag { tag, parent: parent.name, nearest });
    }
}

/// Where a misplaced tag belongs. Directly in `<robot>` vendors put what they like; only parts of links are claimed there.
fn find_home(found: &str, parent: &Tag) -> Option<&'static str> {
    let home = HOMES.iter().find(|(tag, _)| *tag == found).map(|(_, home)| *home)?;
    (parent.name != "robot" || home == "link").then_some(home)
}

fn check_attributes(node: Node<'_, '_>, tag: &'static Tag, subject: &str, findings: &mut Findings<'_>) {
    let start = node.range().start;
    for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
        match tag.attributes.iter().find(|known| known.name == attribute.name()) {
            Some(known) => check_value(tag, known, &attribute, (subject, &mut *findings)),
            None => check_unknown_attribute(node, tag, &attribute, (subject, &mut *findings)),
        }
    }
    for missing in tag.attributes.iter().filter(|a| a.is_required && text_of(node, a.name).is_none()) {
        let (attribute, example) = (missing.name, example_of(missing.kind));
        findings.add(start, subject, UrdfProblem::MissingAttribute { tag: tag.name, attribute, example });
    }
    if text_of(node, "rpy").is_some() && text_of(node, "quat_xyzw").is_some() {
        findings.add(start, subject, UrdfProblem::TwoOrientations);
    } else if tag.name == "origin" && text_of(node, "quat_xyzw").is_some() && version_of(node) < (1, 1) {
        findings.add(start, subject, UrdfProblem::QuaternionNeedsVersion);
    }
}

/// The document's version of URDF: (major, minor).
pub(crate) fn version_of(node: Node<'_, '_>) -> (u32, u32) {
    let version = text_of(node.document().root_element(), "version").unwrap_or("1.0");
    let parts = version.trim().split_once('.').unwrap_or((version.trim(), "0"));
    parts.0.parse().ok().zip(parts.1.parse().ok()).unwrap_or((1, 0))
}

fn check_value(
    tag: &Tag,
    known: &Attribute,
    attribute: &roxmltree::Attribute<'_, '_>,
    (subject, findings): (&str, &mut Findings<'_>),
) {
    if let Err(problem) = parse_numbers(tag, known, attribute.value()) {
        findings.add(attribute.range().start, subject, problem);
    }
}

/// Vendors add attributes too (`<dynamics K="7000">`); only what resembles a missing one of ours is an error.
fn check_unknown_attribute(
    node: Node<'_, '_>,
    tag: &'static Tag,
    attribute: &roxmltree::Attribute<'_, '_>,
    (subject, findings): (&str, &mut Findings<'_>),
) {
    let absent = tag.attributes.iter().map(|a| a.name).filter(|name| text_of(node, name).is_none());
    if let Some(nearest) = find_nearest(attribute.name(), absent) {
        let found = cut(attribute.name());
        let problem = UrdfProblem::MisspeltAttribute { tag: tag.name, found, nearest };
        findings.add(attribute.range().start, subject, problem);
    }
}

/// Vendors' tags pass, except xacro's: they are the source of a URDF, not one.
fn check_vendor_tags(robot: Node<'_, '_>, findings: &mut Findings<'_>) {
    let is_xacro = |n: &Node<'_, '_>| n.tag_name().namespace().is_some_and(|uri| uri.contains("xacro"));
    if let Some(node) = robot.descendants().find(is_xacro) {
        findings.add(node.range().start, "robot", UrdfProblem::Xacro(cut(node.tag_name().name())));
    }
}
