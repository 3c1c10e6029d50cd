//! From the checked tags to a [`RobotDescription`]: parents before children, numbers as vectors and poses.
//!
//! What the walk found unsound and yet no reason to refuse the robot is left out here: a visual altogether, a collision as
//! [`Geometry::Missing`].

use super::checks::Checked;
use super::docking::DockingShapes;
use super::facts::{InertialFact, JointFact, LinkFact, origin_of, part, tag_in};
use super::joints::{Follows, limits_of};
use super::meshes::{MeshKey, Meshes};
use super::schema::{ROBOT, Tag};
use super::walk::{numbers_of, own_children, text_of};
use crate::{
    Collision, Geometry, Inertial, JointDescription, JointKind, LinkDescription, Mimic, RobotDescription, Visual,
};
use roxmltree::Node;
use spatial::Vec3;
use std::collections::HashMap;
use std::path::Path;

/// Builds the description of a robot whose checks found no error; `None` if something that they let pass is not there.
pub(crate) fn convert(robot: Node<'_, '_>, checked: &Checked<'_, '_>, file: &Path) -> Option<RobotDescription> {
    let (facts, order) = (&checked.facts, &checked.graph.order);
    let (link_tag, joint_tag) = (tag_in(&ROBOT, "link")?, tag_in(&ROBOT, "joint")?);
    let numbering = Numbering::of(checked);
    let colours = collect_colours(robot);
    let joints = order.iter().filter_map(|link| checked.graph.carried_by[*link]).map(|(joint, parent)| {
        let mimic = checked.follows[joint].map(|follows| numbering.mimic(follows));
        convert_joint(&facts.joints[joint], joint_tag, numbering.link[parent], mimic)
    });
    let shapes = Shapes { link_tag, colours: &colours, meshes: &checked.meshes, docking: &checked.docking };
    let links = order.iter().map(|link| shapes.convert_link(*link, &facts.links[*link]));
    Some(RobotDescription {
        name: text_of(robot, "name")?.to_owned(),
        file: file.into(),
        links: links.collect::<Option<_>>()?,
        joints: joints.collect::<Option<_>>()?,
    })
}

/// From the file's numbering to the description's.
struct Numbering {
    link: Vec<usize>,
    joint: Vec<usize>,
}

impl Numbering {
    fn of(checked: &Checked<'_, '_>) -> Self {
        let order = &checked.graph.order;
        let mut numbering = Self { link: vec![0; order.len()], joint: vec![0; checked.facts.joints.len()] };
        for (new, &old) in order.iter().enumerate() {
            numbering.link[old] = new;
            if let Some((joint, _)) = checked.graph.carried_by[old] {
                numbering.joint[joint] = new - 1;
            }
        }
        numbering
    }

    fn mimic(&self, (leader, multiplier, offset): Follows) -> Mimic {
        Mimic { joint: self.joint[leader], multiplier, offset }
    }
}

fn convert_joint(
    joint: &JointFact<'_, '_>,
    tag: &'static Tag,
    parent: usize,
    mimic: Option<Mimic>,
) -> Option<JointDescription> {
    let number = |node: Option<(Node<'_, '_>, &'static Tag)>, name: &str| {
        node.and_then(|(node, tag)| numbers_of::<1>(node, tag, name)).map_or(0.0, |[x]| x)
    };
    let axis = part(joint.node, tag, "axis").and_then(|(axis, tag)| numbers_of::<3>(axis, tag, "xyz"));
    let dynamics = part(joint.node, tag, "dynamics");
    let limits = limits_of(joint, tag);
    Some(JointDescription {
        name: joint.name.to_owned(),
        kind: kind_of(joint.kind)?,
        parent,
        pose_pj: origin_of(joint.node, tag)?,
        axis: axis.map_or_else(Vec3::x, Vec3::from).try_normalize(0.0).unwrap_or_else(Vec3::x),
        position_limits: limits.position,
        effort_limit: limits.effort,
        velocity_limit: limits.velocity,
        damping: number(dynamics, "damping"),
        friction: number(dynamics, "friction"),
        mimic,
    })
}

fn kind_of(written: &str) -> Option<JointKind> {
    Some(match written {
        "revolute" | "continuous" => JointKind::Revolute,
        "prismatic" => JointKind::Prismatic,
        "floating" => JointKind::Floating,
        "planar" => JointKind::Planar,
        "fixed" => JointKind::Fixed,
        _ => return None,
    })
}

/// What links are converted with.
struct Shapes<'a> {
    link_tag: &'static Tag,
    colours: &'a Colours<'a>,
    meshes: &'a Meshes,
    docking: &'a DockingShapes,
}

impl Shapes<'_> {
    fn convert_link(&self, number: usize, link: &LinkFact<'_, '_>) -> Option<LinkDescription> {
        let named = |name: &'static str| own_children(link.node).filter(move |n| n.tag_name().name() == name);
        let (visual_tag, collision_tag) = (tag_in(self.link_tag, "visual")?, tag_in(self.link_tag, "collision")?);
        let visuals = named("visual").enumerate().filter_map(|(i, visual)| {
            let name = given_name(visual).unwrap_or_else(|| format!("{}_visual_{i}", link.name));
            self.convert_visual(name, visual, visual_tag)
        });
        let is_only = named("collision").count() == 1;
        let collisions = named("collision").enumerate().map(|(i, collision)| {
            let made_up = || if is_only { link.name.to_owned() } else { format!("{}_{}", link.name, i + 1) };
            let docking = self.docking.get(&(number, i)).map(|docking| Geometry::Docking(*docking));
            Some(Collision {
                name: given_name(collision).unwrap_or_else(made_up),
                pose_ls: origin_of(collision, collision_tag)?,
                geometry: docking.unwrap_or_else(|| self.geometry_of(collision, collision_tag)),
            })
        });
        Some(LinkDescription {
            name: link.name.to_owned(),
            inertial: link.inertial.as_ref().and_then(convert_inertial),
            visuals: visuals.collect(),
            collisions: collisions.collect::<Option<_>>()?,
        })
    }

    fn convert_visual(&self, name: String, visual: Node<'_, '_>, tag: &'static Tag) -> Option<Visual> {
        let geometry = Some(self.geometry_of(visual, tag)).filter(|g| !matches!(g, Geometry::Missing(_)))?;
        let material = part(visual, tag, "material").map(|(material, _)| material);
        let named = |m: Node<'_, '_>| self.colours.get(text_of(m, "name").unwrap_or_default()).copied();
        let rgba = material.and_then(|m| colour_of(m).or_else(|| named(m)));
        Some(Visual { name, pose_ls: origin_of(visual, tag)?, geometry, rgba })
    }

    /// The shape of a `<visual>` or `<collision>`.
    fn geometry_of(&self, shape: Node<'_, '_>, tag: &'static Tag) -> Geometry {
        let geometry = part(shape, tag, "geometry");
        let known = geometry
            .and_then(|(node, tag)| own_children(node).find_map(|n| Some((n, tag_in(tag, n.tag_name().name())?))));
        let Some((form, tag)) = known else { return Geometry::Missing("its <geometry> is no shape of URDF".into()) };
        if tag.name == "mesh" {
            return self.mesh_of(form);
        }
        primitive_of(form, tag).unwrap_or_else(|| Geometry::Missing(format!("its <{}> is unsound", tag.name).into()))
    }

    fn mesh_of(&self, mesh: Node<'_, '_>) -> Geometry {
        match MeshKey::of(mesh).and_then(|(key, _)| self.meshes.get(&key)) {
            Some(Ok(mesh)) => Geometry::Mesh(mesh.clone()),
            Some(Err(error)) => Geometry::Missing(error.to_string().into()),
            None => Geometry::Missing("its <mesh> is unsound".into()),
        }
    }
}

fn primitive_of(node: Node<'_, '_>, tag: &'static Tag) -> Option<Geometry> {
    let number = |name| numbers_of::<1>(node, tag, name).map(|[x]| x);
    Some(match tag.name {
        "box" => Geometry::Box { size: Vec3::from(numbers_of::<3>(node, tag, "size")?) },
        "sphere" => Geometry::Sphere { radius: number("radius")? },
        "cylinder" => Geometry::Cylinder { radius: number("radius")?, length: number("length")? },
        "capsule" => Geometry::Capsule { radius: number("radius")?, length: number("length")? },
        _ => return None,
    })
}

fn given_name(shape: Node<'_, '_>) -> Option<String> {
    text_of(shape, "name").filter(|n| !n.trim().is_empty()).map(str::to_owned)
}

fn convert_inertial(fact: &InertialFact) -> Option<Inertial> {
    (!fact.is_nothing()).then_some(Inertial { mass: fact.mass, com: fact.com, tensor_com: fact.tensor_l })
}

fn colour_of(material: Node<'_, '_>) -> Option<[f64; 4]> {
    let tag = tag_in(&ROBOT, "material")?;
    part(material, tag, "color").and_then(|(colour, tag)| numbers_of::<4>(colour, tag, "rgba"))
}

/// Colours by the name of their material.
type Colours<'a> = HashMap<&'a str, [f64; 4]>;

/// Colours by name: the robot's, then those that a visual defines and others mention.
fn collect_colours<'a>(robot: Node<'a, '_>) -> Colours<'a> {
    let named = |node: Node<'a, '_>, name: &'static str| {
        own_children(node).filter(|n| n.tag_name().name() == name).collect::<Vec<_>>()
    };
    let visuals = named(robot, "link").into_iter().flat_map(|link| named(link, "visual"));
    let inside = visuals.flat_map(|visual| named(visual, "material"));
    let mut colours = Colours::new();
    for material in named(robot, "material").into_iter().chain(inside) {
        if let (Some(rgba), Some(name)) = (colour_of(material), text_of(material, "name")) {
            colours.entry(name).or_insert(rgba);
        }
    }
    colours
}
