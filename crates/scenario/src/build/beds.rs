//! The forms of `[[shape]]` entries: solids, and beds, whose contact is spread over a face.

use super::docking::docking_of_kind;
use super::faults::Faults;
use super::shapes::shape_of_geometry;
use crate::spec::ShapeKind;
use contact::{Bed, Shape};
use multibody::{Geometry, LinkDescription};
use record::docking_of_geometry;
use spatial::{Pose, Vec3};

/// The collision shape of an entry, and its pose before the entry's own; `link` is what it is fixed to, if not the world.
pub(super) fn shape_of_kind(
    kind: &ShapeKind,
    link: Option<&LinkDescription>,
    of_key: &str,
    faults: &mut Faults<'_>,
) -> Option<(Pose, Shape)> {
    let ShapeKind::SurfaceBed { of, spacing_m, reference_area_m2 } = kind else {
        return Some((Pose::identity(), plain_shape(kind)));
    };
    let collisions = link.map(|l| l.collisions.as_slice()).unwrap_or_default();
    let Some(collision) = collisions.iter().find(|c| c.name == *of) else {
        faults.unknown(of_key, "collision geometry", of, collisions.iter().map(|c| c.name.as_str()));
        return None;
    };
    if let Geometry::Missing(reason) = &collision.geometry {
        faults.add(of_key, format!("the collision geometry \"{of}\" is missing: {reason}"));
        return None;
    }
    let surface = Bed::of_surface(&shape_of_geometry(&collision.geometry), *spacing_m);
    Some((collision.pose_ls, bed(surface.unwrap_or_else(|| Bed::new(Vec::new())), *reference_area_m2)))
}

fn plain_shape(kind: &ShapeKind) -> Shape {
    if let Some(docking) = docking_of_kind(kind) {
        return Shape::Docking(docking_of_geometry(&docking));
    }
    match *kind {
        ShapeKind::Box { size_m } => Shape::Cuboid { half_extents: 0.5 * Vec3::from(size_m) },
        ShapeKind::Sphere { radius_m } => Shape::Ball { radius: radius_m },
        ShapeKind::Cylinder { radius_m, length_m } => Shape::Cylinder { radius: radius_m, half_length: 0.5 * length_m },
        ShapeKind::Capsule { radius_m, length_m } if length_m > 0.0 => {
            Shape::Capsule { radius: radius_m, half_length: 0.5 * length_m }
        }
        ShapeKind::Capsule { radius_m, .. } => Shape::Ball { radius: radius_m },
        ShapeKind::DiscBed { radius_m, samples, reference_area_m2 } => {
            bed(Bed::disc(radius_m, samples as usize), reference_area_m2)
        }
        ShapeKind::RingBed { inner_radius_m, outer_radius_m, samples, reference_area_m2 } => {
            bed(Bed::annulus(inner_radius_m, outer_radius_m, samples as usize), reference_area_m2)
        }
        ShapeKind::RectangleBed { size_m: [x, y], samples, reference_area_m2 } => {
            bed(Bed::rectangle(x, y, samples as usize), reference_area_m2)
        }
        ShapeKind::HalfSpace => Shape::HalfSpace,
        // A surface is answered by its caller, who knows the geometry; docking shapes above.
        _ => Shape::Bed(Bed::new(Vec::new())),
    }
}

fn bed(bed: Bed, reference_area: Option<f64>) -> Shape {
    Shape::Bed(match reference_area {
        Some(area) => bed.with_reference_area(area),
        None => bed,
    })
}
