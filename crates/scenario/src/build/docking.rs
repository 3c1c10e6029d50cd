//! Docking shapes of a scenario's `[[shape]]`s: as a URDF's tag would name them, and as something to see.

use crate::spec::{Scenario, ShapeKind};
use multibody::{DockingGeometry, Geometry, Visual};

/// What to draw of the docking shapes that a scenario adds, each with what it is on (`vehicle/link` or "world").
pub fn docking_visuals(scenario: &Scenario) -> Vec<(&str, Visual)> {
    let visual = |shape: &crate::spec::Shape, geometry| Visual {
        name: shape.name.clone(),
        pose_ls: shape.pose.pose(),
        geometry: Geometry::Docking(geometry),
        rgba: None,
    };
    let docking = scenario.shapes.iter().filter_map(|s| Some((s, docking_of_kind(&s.kind)?)));
    docking.map(|(shape, geometry)| (shape.on.as_str(), visual(shape, geometry))).collect()
}

/// The docking shape of a `[[shape]]`; `None` for the other kinds.
pub(super) fn docking_of_kind(kind: &ShapeKind) -> Option<DockingGeometry> {
    Some(match *kind {
        ShapeKind::InnerCone { half_angle_deg, depth_m, throat_radius_m, wall_m } => DockingGeometry::InnerCone {
            half_angle: half_angle_deg.to_radians(),
            depth: depth_m,
            throat_radius: throat_radius_m,
            wall: wall_m,
        },
        ShapeKind::InnerCylinder { radius_m, depth_m, wall_m, floor } => {
            DockingGeometry::InnerCylinder { radius: radius_m, depth: depth_m, wall: wall_m, floor }
        }
        ShapeKind::Ring { major_radius_m, minor_radius_m } => {
            DockingGeometry::Ring { major_radius: major_radius_m, minor_radius: minor_radius_m }
        }
        ShapeKind::Petal { base_radius_m, tip_radius_m, height_m, half_sector_deg, thickness_m } => {
            DockingGeometry::Petal {
                base_radius: base_radius_m,
                tip_radius: tip_radius_m,
                height: height_m,
                half_sector: half_sector_deg.to_radians(),
                thickness: thickness_m,
            }
        }
        ShapeKind::Box { .. }
        | ShapeKind::Sphere { .. }
        | ShapeKind::Cylinder { .. }
        | ShapeKind::Capsule { .. }
        | ShapeKind::DiscBed { .. }
        | ShapeKind::RingBed { .. }
        | ShapeKind::RectangleBed { .. }
        | ShapeKind::SurfaceBed { .. }
        | ShapeKind::HalfSpace => return None,
    })
}
