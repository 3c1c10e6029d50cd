//! What does not change: meshes under their links, fixtures, trails.

use super::look::{Look, single};
use super::paths::{link_path, path};
use crate::{Log, Scene, triangulate};
use multibody::Visual;
use rerun::{EntityPath, RecordingStream, RecordingStreamError};
use spatial::{Pose, Vec3};

/// Where a file gives no colour: the grey of blank aluminium.
const PLAIN: [f64; 4] = [0.72, 0.73, 0.75, 1.0];

/// All meshes, each under its link.
pub(super) fn send_scene(rec: &RecordingStream, scene: &Scene, look: &Look) -> Result<(), RecordingStreamError> {
    rec.log_static("world", &rerun::ViewCoordinates::RIGHT_HAND_Z_UP())?;
    for (index, (_, link)) in scene.links().enumerate() {
        let parent = link_path(scene, index);
        for (name, visual) in unique_names(&link.visuals) {
            send_visual(rec, parent.join(&path(&[&name])), visual, &visual.pose_ls)?;
        }
    }
    for (name, visual) in unique_names(&scene.fixtures) {
        send_visual(rec, path(&["world", "fixtures", &name]), visual, &look.near(&visual.pose_ls))?;
    }
    Ok(())
}

/// Paths of points as thin lines.
pub(super) fn send_trails(
    rec: &RecordingStream,
    log: &Log,
    scene: &Scene,
    look: &Look,
) -> Result<(), RecordingStreamError> {
    for trail in scene.trails.iter().filter(|trail| trail.link < log.link_count()) {
        let point = |i: usize| {
            let pose_wl = &log.poses_w(i)[trail.link];
            look.near_point(&(pose_wl.translation.vector + pose_wl.rotation * trail.point_l))
        };
        let strip: Vec<[f32; 3]> = (0..log.len()).map(point).collect();
        let line = rerun::LineStrips3D::new([strip])
            .with_colors([rerun::Color::from_unmultiplied_rgba(150, 190, 255, 160)])
            .with_radii([rerun::Radius::new_ui_points(1.0)]);
        rec.log_static(path(&["world", "trails", &trail.name]), &line)?;
    }
    Ok(())
}

/// Names within one parent; equal ones get a number.
fn unique_names(visuals: &[Visual]) -> Vec<(String, &Visual)> {
    let mut named: Vec<(String, &Visual)> = Vec::new();
    for visual in visuals {
        let mut name = visual.name.clone();
        let mut number = 2;
        while named.iter().any(|(taken, _)| *taken == name) {
            name = format!("{}_{number}", visual.name);
            number += 1;
        }
        named.push((name, visual));
    }
    named
}

fn send_visual(
    rec: &RecordingStream,
    at: EntityPath,
    visual: &Visual,
    pose: &Pose,
) -> Result<(), RecordingStreamError> {
    let mesh = triangulate(&visual.geometry, pose);
    let mut shape = rerun::Mesh3D::new(mesh.positions)
        .with_vertex_normals(mesh.normals)
        .with_triangle_indices(mesh.triangles.into_iter().map(rerun::TriangleIndices::from));
    if mesh.colours.is_empty() {
        shape = shape.with_albedo_factor(colour(visual.rgba.unwrap_or(PLAIN)));
    } else {
        shape = shape.with_vertex_colors(mesh.colours.iter().map(|rgba| colour(rgba.map(f64::from))));
    }
    rec.log_static(at, &shape)
}

/// Materials are shown as their numbers stand, as other URDF viewers do.
fn colour(rgba: [f64; 4]) -> rerun::datatypes::Rgba32 {
    let [r, g, b, a] = rgba.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    rerun::datatypes::Rgba32::from_unmultiplied_rgba(r, g, b, a)
}

/// A transform as it is logged.
pub(super) fn translation_and_quaternion(pose: &Pose) -> ([f32; 3], rerun::Quaternion) {
    let q = pose.rotation.coords.map(|x| x as f32);
    let translation: Vec3 = pose.translation.vector;
    (single(translation), rerun::Quaternion::from_xyzw([q.x, q.y, q.z, q.w]))
}
