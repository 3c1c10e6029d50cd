//! Docking shapes, from a URDF's tag and from a scenario's `[[shape]]` to those of the contact crate.

use crate::spec::ShapeKind;
use contact::Docking;
use multibody::DockingGeometry;

/// The shape of a `<softdock_shape>` of a URDF.
pub(super) fn docking_of_geometry(geometry: &DockingGeometry) -> Docking {
    match *geometry {
        DockingGeometry::InnerCone { half_angle, depth, throat_radius, wall } => {
            Docking::InnerCone { half_angle, depth, throat_radius, wall }
        }
        DockingGeometry::InnerCylinder { radius, depth, wall, floor } => {
            Docking::InnerCylinder { radius, depth, wall, floor }
        }
        DockingGeometry::Ring { major_radius, minor_radius } => Docking::Ring { major_radius, minor_radius },
        DockingGeometry::Petal { base_radius, tip_radius, height, half_sector, thickness } => {
            Docking::Petal { base_radius, tip_radius, height, half_sector, thickness }
        }
    }
}

/// The shape of a `[[shape]]`; `None` for the kinds that are no docking shape.
pub(super) fn docking_of_kind(kind: &ShapeKind) -> Option<Docking> {
    Some(match *kind {
        ShapeKind::InnerCone { half_angle_deg, depth_m, throat_radius_m, wall_m } => Docking::InnerCone {
            half_angle: half_angle_deg.to_radians(),
            depth: depth_m,
            throat_radius: throat_radius_m,
            wall: wall_m,
        },
        ShapeKind::InnerCylinder { radius_m, depth_m, wall_m, floor } => {
            Docking::InnerCylinder { radius: radius_m, depth: depth_m, wall: wall_m, floor }
        }
        ShapeKind::Ring { major_radius_m, minor_radius_m } => {
            Docking::Ring { major_radius: major_radius_m, minor_radius: minor_radius_m }
        }
        ShapeKind::Petal { base_radius_m, tip_radius_m, height_m, half_sector_deg, thickness_m } => Docking::Petal {
            base_radius: base_radius_m,
            tip_radius: tip_radius_m,
            height: height_m,
            half_sector: half_sector_deg.to_radians(),
            thickness: thickness_m,
        },
        ShapeKind::Box { .. }
        | ShapeKind::Sphere { .. }
        | ShapeKind::Cylinder { .. }
        | ShapeKind::Capsule { .. }
        | ShapeKind::HalfSpace => return None,
    })
}
