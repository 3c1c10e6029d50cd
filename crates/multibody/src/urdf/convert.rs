//! From urdf-rs's types to a [`RobotDescription`]: parents before children, numbers as vectors and poses.
//!
//! Roll, pitch, yaw of URDF: R = Rz(yaw) Ry(pitch) Rx(roll).

use super::checks::{Checked, MeshKey};
use super::joints::Follows;
use crate::{
    Collision, Geometry, Inertial, JointDescription, JointKind, LinkDescription, Mimic, RobotDescription, Visual,
};
use spatial::{Mat3, Pose, Rot, Vec3};
use std::collections::HashMap;
use std::path::Path;

/// Builds the description of a robot whose checks found nothing; `None` if urdf-rs read another robot than the checks.
pub(crate) fn convert(robot: &urdf_rs::Robot, checked: &Checked, file: &Path) -> Option<RobotDescription> {
    let order = &checked.graph.order;
    if robot.links.len() != order.len() || robot.joints.len() + 1 != order.len() {
        return None;
    }
    let numbering = Numbering::of(checked);
    let colours = collect_colours(robot);
    let joints = order.iter().filter_map(|link| checked.graph.carried_by[*link]).map(|(joint, parent)| {
        let mimic = checked.follows[joint].map(|follows| numbering.mimic(follows));
        convert_joint(&robot.joints[joint], numbering.link[parent], mimic)
    });
    let links = order.iter().map(|link| convert_link((*link, &robot.links[*link]), &colours, checked));
    Some(RobotDescription {
        name: robot.name.clone(),
        file: file.into(),
        links: links.collect::<Option<_>>()?,
        joints: joints.collect(),
    })
}

/// From the file's numbering to the description's.
struct Numbering {
    link: Vec<usize>,
    joint: Vec<usize>,
}

impl Numbering {
    fn of(checked: &Checked) -> Self {
        let order = &checked.graph.order;
        let mut numbering = Self { link: vec![0; order.len()], joint: vec![0; order.len()] };
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

fn convert_joint(joint: &urdf_rs::Joint, parent: usize, mimic: Option<Mimic>) -> JointDescription {
    let kind = kind_of(&joint.joint_type);
    let limits = [joint.limit.lower, joint.limit.upper];
    let is_limited = matches!(joint.joint_type, urdf_rs::JointType::Revolute | urdf_rs::JointType::Prismatic);
    let position_limits = Some(limits).filter(|l| is_limited && l.iter().any(|x| x.is_finite()));
    let dynamics = joint.dynamics.as_ref();
    JointDescription {
        name: joint.name.clone(),
        kind,
        parent,
        pose_pj: pose(&joint.origin),
        axis: Vec3::from(*joint.axis.xyz).try_normalize(0.0).unwrap_or_else(Vec3::x),
        position_limits,
        effort_limit: joint.limit.effort,
        velocity_limit: joint.limit.velocity,
        damping: dynamics.map_or(0.0, |d| d.damping),
        friction: dynamics.map_or(0.0, |d| d.friction),
        mimic,
    }
}

fn kind_of(written: &urdf_rs::JointType) -> JointKind {
    match written {
        urdf_rs::JointType::Revolute | urdf_rs::JointType::Continuous => JointKind::Revolute,
        urdf_rs::JointType::Prismatic => JointKind::Prismatic,
        urdf_rs::JointType::Floating => JointKind::Floating,
        urdf_rs::JointType::Planar => JointKind::Planar,
        // The checks let no spherical joint through.
        urdf_rs::JointType::Fixed | urdf_rs::JointType::Spherical => JointKind::Fixed,
    }
}

fn pose(origin: &urdf_rs::Pose) -> Pose {
    let [roll, pitch, yaw] = *origin.rpy;
    Pose::from_parts(Vec3::from(*origin.xyz).into(), Rot::from_euler_angles(roll, pitch, yaw))
}

fn convert_link(
    (number, link): (usize, &urdf_rs::Link),
    colours: &Colours<'_>,
    checked: &Checked,
) -> Option<LinkDescription> {
    let collisions = link.collision.iter().enumerate();
    Some(LinkDescription {
        name: link.name.clone(),
        inertial: convert_inertial(&link.inertial),
        visuals: link
            .visual
            .iter()
            .enumerate()
            .map(|(i, visual)| {
                let name = given(&visual.name).unwrap_or_else(|| format!("{}_visual_{i}", link.name));
                convert_visual(name, visual, colours, checked)
            })
            .collect::<Option<_>>()?,
        collisions: collisions
            .map(|(i, collision)| {
                let is_only = link.collision.len() == 1;
                let made_up = || if is_only { link.name.clone() } else { format!("{}_{}", link.name, i + 1) };
                let name = given(&collision.name).unwrap_or_else(made_up);
                let geometry = match checked.docking.get(&(number, i)) {
                    Some(docking) => Geometry::Docking(*docking),
                    None => convert_geometry(&collision.geometry, checked)?,
                };
                Some(Collision { name, pose_ls: pose(&collision.origin), geometry })
            })
            .collect::<Option<_>>()?,
    })
}

fn convert_visual(name: String, visual: &urdf_rs::Visual, colours: &Colours<'_>, checked: &Checked) -> Option<Visual> {
    let material = visual.material.as_ref();
    let rgba = material.and_then(|m| colour_of(m).or_else(|| colours.get(m.name.as_str()).copied()));
    let geometry = convert_geometry(&visual.geometry, checked)?;
    Some(Visual { name, pose_ls: pose(&visual.origin), geometry, rgba })
}

fn given(name: &Option<String>) -> Option<String> {
    name.clone().filter(|n| !n.trim().is_empty())
}

/// The tensor turned into link axes: R I Rᵀ, with R of the inertial frame in the link frame.
fn convert_inertial(inertial: &urdf_rs::Inertial) -> Option<Inertial> {
    let mass = inertial.mass.value;
    let i = &inertial.inertia;
    let tensor = Mat3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz);
    let pose_li = pose(&inertial.origin);
    // No rounding where nothing turns.
    let is_turned = *inertial.origin.rpy != [0.0; 3];
    let rot = pose_li.rotation.to_rotation_matrix().into_inner();
    let tensor_com = if is_turned { rot * tensor * rot.transpose() } else { tensor };
    // Symmetric to the last bit.
    let tensor_com = 0.5 * (tensor_com + tensor_com.transpose());
    (mass != 0.0).then_some(Inertial { mass, com: pose_li.translation.vector, tensor_com })
}

fn convert_geometry(geometry: &urdf_rs::Geometry, checked: &Checked) -> Option<Geometry> {
    Some(match geometry {
        urdf_rs::Geometry::Box { size } => Geometry::Box { size: Vec3::from(**size) },
        urdf_rs::Geometry::Cylinder { radius, length } => Geometry::Cylinder { radius: *radius, length: *length },
        urdf_rs::Geometry::Capsule { radius, length } => Geometry::Capsule { radius: *radius, length: *length },
        urdf_rs::Geometry::Sphere { radius } => Geometry::Sphere { radius: *radius },
        urdf_rs::Geometry::Mesh { filename, scale } => {
            let key = MeshKey::new(filename, scale.map_or([1.0; 3], |s| *s));
            Geometry::Mesh(checked.meshes.get(&key)?.clone())
        }
    })
}

fn colour_of(material: &urdf_rs::Material) -> Option<[f64; 4]> {
    material.color.as_ref().map(|c| *c.rgba)
}

/// Colours by the name of their material.
type Colours<'a> = HashMap<&'a str, [f64; 4]>;

/// Colours by name: the robot's, then those that a visual defines and others mention.
fn collect_colours(robot: &urdf_rs::Robot) -> Colours<'_> {
    let visual = robot.links.iter().flat_map(|l| &l.visual).filter_map(|v| v.material.as_ref());
    let mut colours = Colours::new();
    for material in robot.materials.iter().chain(visual) {
        if let Some(rgba) = colour_of(material) {
            colours.entry(material.name.as_str()).or_insert(rgba);
        }
    }
    colours
}
