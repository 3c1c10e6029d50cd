//! The visual scene: which geometry stands where.

use super::{Fault, Ids, LocalName, child, floats, line_of, target};
use roxmltree::Node;
use spatial::nalgebra::{Matrix4, Rotation3, Unit, Vector3};

/// Nodes inside nodes; deeper files refer to themselves in a circle.
const DEEPEST: usize = 128;
/// Instances; more of them multiply without bound.
const MOST_INSTANCES: usize = 100_000;

/// A geometry at a place.
pub(super) struct Instance<'a, 'i> {
    /// The `<geometry>`.
    pub(super) geometry: Node<'a, 'i>,
    /// The `<instance_geometry>` with its materials, if there is a scene.
    pub(super) instance: Option<Node<'a, 'i>>,
    /// From its coordinates to metres, z up.
    pub(super) pose: Matrix4<f64>,
}

/// All geometries of the scene, or, without one, every geometry of the file where it is.
pub(super) fn place_geometries<'a, 'i>(
    root: Node<'a, 'i>,
    ids: &Ids<'a, 'i>,
    world: Matrix4<f64>,
) -> Result<Vec<Instance<'a, 'i>>, Fault> {
    let Some(scene) = find_scene(root, ids) else {
        let geometries = root.descendants().filter(|n| n.has_tag_name_local("geometry"));
        return Ok(geometries.map(|geometry| Instance { geometry, instance: None, pose: world }).collect());
    };
    let mut placed = Vec::new();
    let mut visited = 0;
    // (node, pose of its parent, depth); a stack of our own, as files may nest deeper than the call stack.
    let mut open: Vec<_> = child_nodes(scene).map(|n| (n, world, 0)).collect();
    open.reverse();
    while let Some((node, parent, depth)) = open.pop() {
        visited += 1;
        if depth > DEEPEST || visited > MOST_INSTANCES {
            return Err(Fault::in_line(line_of(node), "its nodes contain each other in a circle or without end"));
        }
        let pose = parent * calc_transform(node)?;
        add_geometries(node, ids, pose, &mut placed)?;
        let instanced = node.children().filter(|c| c.has_tag_name_local("instance_node"));
        let instanced = instanced.filter_map(|c| target(ids, c.attribute("url")?));
        let below: Vec<_> = child_nodes(node).chain(instanced).map(|n| (n, pose, depth + 1)).collect();
        open.extend(below.into_iter().rev());
    }
    Ok(placed)
}

fn find_scene<'a, 'i>(root: Node<'a, 'i>, ids: &Ids<'a, 'i>) -> Option<Node<'a, 'i>> {
    let named = child(root, "scene").and_then(|s| child(s, "instance_visual_scene"));
    let named = named.and_then(|i| target(ids, i.attribute("url")?));
    named.or_else(|| child(root, "library_visual_scenes").and_then(|l| child(l, "visual_scene")))
}

fn child_nodes<'a, 'i: 'a>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(|c| c.has_tag_name_local("node"))
}

fn add_geometries<'a, 'i>(
    node: Node<'a, 'i>,
    ids: &Ids<'a, 'i>,
    pose: Matrix4<f64>,
    placed: &mut Vec<Instance<'a, 'i>>,
) -> Result<(), Fault> {
    for instance in node.children().filter(|c| c.has_tag_name_local("instance_geometry")) {
        let url = instance.attribute("url").unwrap_or_default();
        let geometry = target(ids, url).filter(|g| g.has_tag_name_local("geometry")).ok_or_else(|| {
            Fault::in_line(line_of(instance), format!("it places geometry \"{url}\", which does not exist"))
        })?;
        placed.push(Instance { geometry, instance: Some(instance), pose });
    }
    Ok(())
}

/// Product of a node's transforms in their order in the file.
fn calc_transform(node: Node<'_, '_>) -> Result<Matrix4<f64>, Fault> {
    let mut pose = Matrix4::identity();
    for element in node.children().filter(Node::is_element) {
        let tag = element.tag_name().name();
        if !matches!(tag, "matrix" | "translate" | "rotate" | "scale" | "lookat" | "skew") {
            continue;
        }
        let numbers = floats(element)?;
        let factor = factor_of(tag, &numbers).ok_or_else(|| {
            let count = numbers.len();
            Fault::in_line(line_of(element), format!("a <{tag}> of {count} numbers is not understood"))
        })?;
        pose *= factor;
    }
    Ok(pose)
}

fn factor_of(tag: &str, numbers: &[f64]) -> Option<Matrix4<f64>> {
    match (tag, numbers) {
        ("matrix", m) if m.len() == 16 => Some(Matrix4::from_row_slice(m)),
        ("translate", &[x, y, z]) => Some(Matrix4::new_translation(&Vector3::new(x, y, z))),
        ("scale", &[x, y, z]) => Some(Matrix4::new_nonuniform_scaling(&Vector3::new(x, y, z))),
        ("rotate", &[x, y, z, angle_deg]) => {
            let axis = Unit::try_new(Vector3::new(x, y, z), 0.0);
            let turn = axis.map(|a| Rotation3::from_axis_angle(&a, angle_deg.to_radians()).to_homogeneous());
            Some(turn.unwrap_or_else(Matrix4::identity))
        }
        _ => None,
    }
}
