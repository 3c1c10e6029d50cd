//! Where the camera stands, what the coordinates are relative to, and how long an arrow is.

use crate::{Log, Scene, triangulate};
use spatial::{Pose, Vec3};

/// Positions further from W's origin than this would lose tenths of millimetres in single precision.
const FAR_M: f64 = 1.0e3;
/// Arrow of the largest force, as a share of the scene's radius.
const ARROW_SHARE: f64 = 0.12;
/// Bounds of the arrow of the largest force, m.
const ARROW_RANGE_M: [f64; 2] = [0.05, 0.5];

/// Choices that make a scene readable, taken from the scene and the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Logged positions are relative to this point of W, m. Zero unless the scene is far away.
    pub origin_w: Vec3,
    /// Length of a force arrow, m/N.
    pub arrow_m_per_n: f64,
    /// Centre of what is seen at the start, relative to `origin_w`, m.
    pub centre: Vec3,
    /// Radius of what is seen at the start, m.
    pub radius: f64,
    /// Centre of the first contacts in the close-up link's frame, m.
    pub touch_l: Option<Vec3>,
}

impl Look {
    /// For a finished run: the longest arrow belongs to the largest force of the run.
    pub fn of_run(log: &Log, scene: &Scene) -> Self {
        let start = if log.is_empty() { &[] } else { log.poses_w(0) };
        let peak = log.peak_contact_force();
        Self { touch_l: first_touch(log, scene), ..Self::at(start, scene, peak) }
    }

    /// From the poses at the start and the largest force that is expected, N.
    pub fn at(poses_w: &[Pose], scene: &Scene, peak_force: f64) -> Self {
        let far = poses_w.first().map(|pose| pose.translation.vector).filter(|p| p.norm() > FAR_M);
        let origin_w = far.map_or(Vec3::zeros(), |p| p.map(f64::round));
        let (low, high) = bounds(poses_w, scene);
        let radius = (0.5 * (high - low).norm()).max(0.1);
        let longest = (ARROW_SHARE * radius).clamp(ARROW_RANGE_M[0], ARROW_RANGE_M[1]);
        let arrow_m_per_n = longest / peak_force.max(1e-3);
        Self { origin_w, arrow_m_per_n, centre: 0.5 * (low + high) - origin_w, radius, touch_l: None }
    }

    /// A pose as it is logged.
    pub(super) fn near(&self, pose_w: &Pose) -> Pose {
        Pose::from_parts((pose_w.translation.vector - self.origin_w).into(), pose_w.rotation)
    }

    /// A point as it is logged.
    pub(super) fn near_point(&self, point_w: &Vec3) -> [f32; 3] {
        single(point_w - self.origin_w)
    }
}

pub(super) fn single(v: Vec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// Corners of the box around all shapes; around zero where there are none.
fn bounds(poses_w: &[Pose], scene: &Scene) -> (Vec3, Vec3) {
    let mut points = Vec::new();
    for ((_, link), pose_wl) in scene.links().zip(poses_w) {
        for visual in &link.visuals {
            let mesh = triangulate(&visual.geometry, &visual.pose_ls);
            let place = |p: &[f32; 3]| pose_wl.translation.vector + pose_wl.rotation * Vec3::from(p.map(f64::from));
            points.extend(mesh.positions.iter().map(place));
        }
    }
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}

fn first_touch(log: &Log, scene: &Scene) -> Option<Vec3> {
    let link = scene.close_up?;
    let touch = (0..log.len()).find(|&i| !log.contacts[i].is_empty())?;
    let points = &log.contacts[touch];
    let mean_w = points.iter().map(|c| c.point_w).sum::<Vec3>() / points.len() as f64;
    Some(log.poses_w(touch)[link].inverse_transform_point(&mean_w.into()).coords)
}
