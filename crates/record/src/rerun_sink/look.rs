//! Where the camera stands, what the coordinates are relative to, and how long an arrow is.

use crate::{Log, Scene, triangulate};
use spatial::{Pose, Vec3};

/// Positions further from W's origin than this would lose tenths of millimetres in single precision.
const FAR_M: f64 = 1.0e3;
/// Arrow of the largest force, as a share of the scene's radius.
const ARROW_SHARE: f64 = 0.06;
/// Bounds of the arrow of the largest force, m.
const ARROW_RANGE_M: [f64; 2] = [0.03, 0.3];

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
    /// From the close-up link to the other vehicles, in its frame at the first contact or at the start, unit length.
    pub approach_l: Vec3,
}

impl Look {
    /// For a finished run: the longest arrow belongs to the largest force of the run.
    pub fn of_run(log: &Log, scene: &Scene) -> Self {
        let start = if log.is_empty() { &[] } else { log.poses_w(0) };
        let look = Self::at(start, scene, log.peak_contact_force());
        match (0..log.len()).find(|&i| !log.contacts[i].is_empty()).zip(scene.close_up) {
            Some((touch, link)) => Self {
                touch_l: Some(mean_contact(log, touch, link)),
                approach_l: approach(log.poses_w(touch), scene),
                ..look
            },
            None => look,
        }
    }

    /// From the poses at the start and the largest force that is expected, N.
    pub fn at(poses_w: &[Pose], scene: &Scene, peak_force: f64) -> Self {
        let far = poses_w.first().map(|pose| pose.translation.vector).filter(|p| p.norm() > FAR_M);
        let origin_w = far.map_or(Vec3::zeros(), |p| p.map(f64::round));
        let (low, high) = bounds(poses_w, scene);
        let radius = (0.5 * (high - low).norm()).max(0.1);
        let longest = (ARROW_SHARE * radius).clamp(ARROW_RANGE_M[0], ARROW_RANGE_M[1]);
        let arrow_m_per_n = longest / peak_force.max(1e-3);
        let approach_l = approach(poses_w, scene);
        Self { origin_w, arrow_m_per_n, centre: 0.5 * (low + high) - origin_w, radius, touch_l: None, approach_l }
    }

    /// What the colours and lengths mean, as a line of markdown.
    pub(super) fn legend(&self) -> String {
        let scale = 0.1 / self.arrow_m_per_n;
        format!("*Contact points: teal sticks, orange slides. Force arrows: 0.1 m is {scale:.2} N; normal blue.*")
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

/// Centre of the contacts at an instant, in a link's frame.
fn mean_contact(log: &Log, instant: usize, link: usize) -> Vec3 {
    let points = &log.contacts[instant];
    let mean_w = points.iter().map(|c| c.point_w).sum::<Vec3>() / points.len() as f64;
    log.poses_w(instant)[link].inverse_transform_point(&mean_w.into()).coords
}

/// Direction from the close-up link to the links of the other vehicles, in its frame.
fn approach(poses_w: &[Pose], scene: &Scene) -> Vec3 {
    let owner = scene.close_up.and_then(|link| scene.links().nth(link)).map(|(vehicle, _)| vehicle);
    let Some(pose_wl) = scene.close_up.and_then(|link| poses_w.get(link)) else { return Vec3::x() };
    let others = scene.links().zip(poses_w).filter(|((vehicle, _), _)| Some(*vehicle) != owner);
    let sum: Vec3 = others.map(|(_, pose)| pose.translation.vector - pose_wl.translation.vector).sum();
    (pose_wl.rotation.inverse() * sum).try_normalize(1e-6).unwrap_or(Vec3::x())
}
