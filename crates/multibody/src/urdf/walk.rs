//! The first walk over the XML: tags and attributes against the table of [`super::schema`].
//!
//! The walk goes only where the table goes, four tags deep, so a document nested a million deep costs no stack.

use super::doubts::{Loss, UrdfDoubt};
use super::errors::{UrdfProblem, cut};
use super::findings::Findings;
use super::nearest::find_nearest;
use super::numbers::parse_numbers;
use super::schema::{Count, HOMES, Kind, ROBOT, Tag, example_of};
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
        let found: Vec<_> = own_children(node).filter(|n| n.tag_name().name() == child.tag.name).collect();
        shapes += found.len();
        if child.count == Count::One && found.is_empty() {
            let problem = UrdfProblem::MissingTag { parent: tag.name, tag: child.tag.name };
            findings.add(node.range().start, subject, problem);
        }
        if let ([first, rest @ ..], false, true) = (&found[..], tag.is_choice, child.count != Count::Many) {
            Repeats { first: *first, rest, parent: tag.name, tag: child.tag }.check(subject, findings);
        }
    }
    match (tag.is_choice, shapes) {
        (true, 0) if tag.name != "geometry" => {
            findings.add(node.range().start, subject, UrdfProblem::NoDockingShape);
        }
        (true, 2..) if tag.name != "geometry" => {
            findings.add(node.range().start, subject, UrdfProblem::SeveralDockingShapes);
        }
        (true, 0) => check_unknown_shape(node, subject, findings),
        (true, 2..) => findings.add(node.range().start, subject, UrdfProblem::SeveralShapes),
        _ => {}
    }
}

/// A tag that stands oftener than this is a slip, whatever it says.
const MOST_REPEATS: usize = 4;

/// A tag that may stand once, and those after it.
struct Repeats<'a, 'i, 'r> {
    first: Node<'a, 'i>,
    rest: &'r [Node<'a, 'i>],
    parent: &'static str,
    tag: &'static Tag,
}

impl Repeats<'_, '_, '_> {
    /// A tag that stands twice and says the same twice is only odd.
    fn check(&self, subject: &str, findings: &mut Findings<'_>) {
        let Self { first, rest, parent, tag } = self;
        let differs = |n: &&Node<'_, '_>| rest.len() > MOST_REPEATS || !do_agree(*first, **n, tag);
        if let Some(other) = rest.iter().find(differs) {
            findings.add(other.range().start, subject, UrdfProblem::RepeatedTag { parent, tag: tag.name });
        } else if let Some(second) = rest.first() {
            findings.doubt(second.range().start, subject, UrdfDoubt::RepeatedTag { parent, tag: tag.name });
        }
    }
}

/// Whether two tags say the same in all that the table knows.
fn do_agree(a: Node<'_, '_>, b: Node<'_, '_>, tag: &'static Tag) -> bool {
    tag.attributes.iter().all(|known| text_of(a, known.name) == text_of(b, known.name))
        && tag.children.iter().all(|child| {
            let of = |node| own_children(node).filter(|n| n.tag_name().name() == child.tag.name).collect::<Vec<_>>();
            let (a, b): (Vec<_>, Vec<_>) = (of(a), of(b));
            a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| do_agree(*a, *b, child.tag))
        })
}

/// A geometry without a shape of ours: another program's leaves the rest of the link as it is, none at all is a slip.
fn check_unknown_shape(geometry: Node<'_, '_>, subject: &str, findings: &mut Findings<'_>) {
    let at = geometry.range().start;
    match geometry.children().find(Node::is_element) {
        Some(other) => {
            let seen = is_in_visual(geometry);
            let loss = Loss { seen, touching: !seen };
            findings.doubt(at, subject, UrdfDoubt::UnknownShape { tag: cut(other.tag_name().name()), loss });
        }
        None => findings.add(at, subject, UrdfProblem::NoShape),
    }
}

/// Whether a tag is part of what is seen and nothing else.
fn is_in_visual(node: Node<'_, '_>) -> bool {
    node.ancestors().any(|n| n.tag_name().name() == "visual")
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
            Some(known) => {
                let at = attribute.range().start;
                if let Err(problem) = parse_numbers(tag, known, attribute.value()) {
                    tell_value(node, at, problem, subject, findings);
                } else if known.kind == Kind::Scale && attribute.value().split_whitespace().nth(3).is_some() {
                    findings.doubt(at, subject, UrdfDoubt::LongScale { text: cut(attribute.value()) });
                }
            }
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

/// A value that only spoils the looks is no reason to refuse a robot.
fn tell_value(node: Node<'_, '_>, at: usize, problem: UrdfProblem, subject: &str, findings: &mut Findings<'_>) {
    match problem {
        UrdfProblem::OutOfRange { tag: "color", attribute, text, rule } => {
            findings.doubt(at, subject, UrdfDoubt::NoColour { tag: "color", attribute, text, rule });
        }
        UrdfProblem::OutOfRange { tag, attribute, text, rule } if is_in_visual(node) => {
            findings.doubt(at, subject, UrdfDoubt::Unseen { tag, attribute, text, rule });
        }
        problem => findings.add(at, subject, problem),
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
