//! A contact part that sits elsewhere than the drawing says.

use super::*;
use ::contact::{Docking, Shape};
use parameter::{ANY, zero};
use sim::ShapeSpec;
use spatial::{Pose, Vec3, nalgebra};
use unit::{M, RAD};

/// A shift and a turn.
pub static CONTACT_GEOMETRY_OFFSET: EffectDef = EffectDef {
    name: "contact-geometry-offset",
    meaning: "A misaligned contact part.",
    words: "a misplaced part",
    places: &[PlaceKind::Contact],
    parameters: &[
        zero("offset", ANY, M, "shift, axes of the part's link").vector().optional(),
        zero("angle", ANY, RAD, "rotation vector, axes of the part's link").vector().optional(),
    ],
    equation: "The second-named part turned by angle about its origin (a cone: its apex; several shapes on one link: the link's origin) and moved by offset.",
    source: "Geometry; in the build.",
    build: Build::Pose(displace),
    identify: Identify {
        candidates: Candidates::Contact(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Moves a part in its link's axes, by the turn `angle` (a rotation vector) about its origin and by `offset`. What consists
/// of several shapes turns about the link's origin, so that they keep together.
fn displace(entry: &Entry<'_>, part: &mut ShapeSpec, is_alone: bool) {
    let (offset, angle) = (entry.vector("offset"), entry.vector("angle"));
    if offset == Vec3::zeros() && angle == Vec3::zeros() {
        return;
    }
    let origin =
        if is_alone { part.pose_ls * nalgebra::Point3::from(origin_of(&part.shape)) } else { Default::default() };
    let turn = nalgebra::UnitQuaternion::from_scaled_axis(angle);
    let about = |p: Vec3| Pose::from_parts(p.into(), nalgebra::UnitQuaternion::identity());
    let turned = Pose::from_parts((origin.coords + offset).into(), turn);
    part.pose_ls = turned * about(-origin.coords) * part.pose_ls;
}

/// Where a part's origin is, in the shape's frame: of a cone its apex.
fn origin_of(shape: &Shape) -> Vec3 {
    match *shape {
        Shape::Docking(Docking::InnerCone { half_angle, depth, throat_radius, .. }) => {
            Vec3::new(0.0, 0.0, -depth - throat_radius / half_angle.tan())
        }
        _ => Vec3::zeros(),
    }
}

/// Coordinates of the turn: what another effect holds that takes this one's place with a shift alone.
pub(super) const TURN: [usize; 3] = [3, 4, 5];

fn candidates(contact: &ContactFact) -> Vec<Candidate> {
    if contact.moving_normal().is_none() {
        return Vec::new();
    }
    let mut coordinates = Coordinate::vector(["offset[0]", "offset[1]", "offset[2]"], [0.0; 3]);
    coordinates.extend(Coordinate::vector(["angle[0]", "angle[1]", "angle[2]"], [0.0; 3]));
    let (held, shown): (Vec<usize>, Vec<usize>) = (0..6).partition(|k| contact.unmoved_by[*k]);
    vec![Candidate::new(contact.place(), coordinates).screened(&Along::each(shown, 1e-7)).holding(held)]
}
