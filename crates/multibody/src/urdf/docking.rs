//! softdock's own tag: a docking shape in the place of a collision's geometry.
//!
//! ```xml
//! <collision name="drogue">
//!   <origin xyz="0 0 0.2"/>
//!   <geometry><mesh filename="drogue.stl"/></geometry>
//!   <softdock_shape><inner_cone half_angle="0.785" depth="0.14" throat_radius="0.02" wall="0.01"/></softdock_shape>
//! </collision>
//! ```
//!
//! Other readers pass over the tag and take the geometry, which is theirs alone: an approximation, or a small sphere out
//! of the way. One of
//!
//! | tag | attributes (m, rad) |
//! | --- | --- |
//! | `<inner_cone>` | half_angle, depth; throat_radius (0), wall (0.01) |
//! | `<inner_cylinder>` | radius, depth; wall (0.01), floor (false) |
//! | `<ring>` | major_radius, minor_radius |
//! | `<petal>` | base_radius, tip_radius, height, half_sector, thickness |

use super::facts::{Facts, tag_in};
use super::schema::{Attribute, Kind, SOFTDOCK_SHAPE, Tag, leaf, may, must};
use super::walk::{numbers_of, own_children, text_of};
use crate::DockingGeometry;
use roxmltree::Node;
use std::collections::BTreeMap;

/// Thickness of a wall that is not told, m.
const WALL: f64 = 0.01;

static CONE: &[Attribute] = &[
    must("half_angle", Kind::AcuteAngle),
    must("depth", Kind::Positive),
    may("throat_radius", Kind::NonNegative),
    may("wall", Kind::Positive),
];
static TUBE: &[Attribute] = &[
    must("radius", Kind::Positive),
    must("depth", Kind::Positive),
    may("wall", Kind::Positive),
    may("floor", Kind::Flag),
];
static TORUS: &[Attribute] = &[must("major_radius", Kind::Positive), must("minor_radius", Kind::Positive)];
static PLATE: &[Attribute] = &[
    must("base_radius", Kind::Positive),
    must("tip_radius", Kind::NonNegative),
    must("height", Kind::Positive),
    must("half_sector", Kind::HalfTurn),
    must("thickness", Kind::Positive),
];

/// The tags of the shapes.
pub(crate) static INNER_CONE: Tag = leaf("inner_cone", CONE);
pub(crate) static INNER_CYLINDER: Tag = leaf("inner_cylinder", TUBE);
pub(crate) static RING: Tag = leaf("ring", TORUS);
pub(crate) static PETAL: Tag = leaf("petal", PLATE);

/// Docking shapes by link and collision, each counted as it stands in the file.
pub(crate) type DockingShapes = BTreeMap<(usize, usize), DockingGeometry>;

/// Reads all of them; what is wrong with one has been told by the walk.
pub(crate) fn collect_docking(facts: &Facts<'_, '_>) -> DockingShapes {
    let mut shapes = DockingShapes::new();
    for (l, link) in facts.links.iter().enumerate() {
        let collisions = own_children(link.node).filter(|n| n.tag_name().name() == "collision");
        for (c, collision) in collisions.enumerate() {
            let tag = own_children(collision).find(|n| n.tag_name().name() == SOFTDOCK_SHAPE.name);
            let shape = tag.and_then(|tag| own_children(tag).find_map(read));
            shapes.extend(shape.map(|shape| ((l, c), shape)));
        }
    }
    shapes
}

fn read(node: Node<'_, '_>) -> Option<DockingGeometry> {
    let tag = tag_in(&SOFTDOCK_SHAPE, node.tag_name().name())?;
    let number = |name| numbers_of::<1>(node, tag, name).map(|[x]| x);
    Some(match tag.name {
        "inner_cone" => DockingGeometry::InnerCone {
            half_angle: number("half_angle")?,
            depth: number("depth")?,
            throat_radius: number("throat_radius").unwrap_or(0.0),
            wall: number("wall").unwrap_or(WALL),
        },
        "inner_cylinder" => DockingGeometry::InnerCylinder {
            radius: number("radius")?,
            depth: number("depth")?,
            wall: number("wall").unwrap_or(WALL),
            floor: text_of(node, "floor").is_some_and(|t| t.trim() == "true"),
        },
        "ring" => {
            DockingGeometry::Ring { major_radius: number("major_radius")?, minor_radius: number("minor_radius")? }
        }
        _ => DockingGeometry::Petal {
            base_radius: number("base_radius")?,
            tip_radius: number("tip_radius")?,
            height: number("height")?,
            half_sector: number("half_sector")?,
            thickness: number("thickness")?,
        },
    })
}
