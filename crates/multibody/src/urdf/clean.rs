//! The URDF again, with only what softdock's table knows and with every default written out, for urdf-rs.
//!
//! urdf-rs refuses unknown tags inside `<geometry>`, takes a missing `<limit>` for limits of 0, and recurses into
//! whatever it finds; none of this meets it here.

use super::joints::are_missing_bounds_infinite;
use super::schema::{ROBOT, SOFTDOCK_SHAPE, Tag};
use super::walk::{own_children, text_of};
use roxmltree::Node;

const NO_LIMIT: &str = "<limit lower=\"-inf\" upper=\"inf\" effort=\"inf\" velocity=\"inf\"/>";

/// XML of the checked document.
pub(crate) fn write_clean(robot: Node<'_, '_>) -> String {
    let mut out = String::new();
    write_tag(robot, &ROBOT, &mut out);
    out
}

fn write_tag(node: Node<'_, '_>, tag: &'static Tag, out: &mut String) {
    out.extend(["<", tag.name]);
    for attribute in tag.attributes {
        let given = text_of(node, attribute.name);
        if let Some(value) = given.or_else(|| default_of(node, tag.name, attribute.name)) {
            out.extend([" ", attribute.name, "=\"", &escaped(value), "\""]);
        }
    }
    out.push('>');
    for child in tag.children.iter().filter(|c| c.tag.name != SOFTDOCK_SHAPE.name) {
        for part in own_children(node).filter(|n| n.tag_name().name() == child.tag.name) {
            write_tag(part, child.tag, out);
        }
    }
    if tag.name == "joint" && !own_children(node).any(|n| n.tag_name().name() == "limit") {
        out.push_str(NO_LIMIT);
    }
    out.extend(["</", tag.name, ">"]);
}

fn default_of(node: Node<'_, '_>, tag: &str, attribute: &str) -> Option<&'static str> {
    let are_open = are_missing_bounds_infinite(node);
    match (tag, attribute) {
        ("inertia", "ixy" | "ixz" | "iyz") => Some("0"),
        ("limit", "effort" | "velocity") => Some("inf"),
        ("limit", "lower") => Some(if are_open { "-inf" } else { "0" }),
        ("limit", "upper") => Some(if are_open { "inf" } else { "0" }),
        ("material", "name") => Some(""),
        _ => None,
    }
}

fn escaped(value: &str) -> String {
    value.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
