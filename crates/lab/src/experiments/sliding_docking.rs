//! Ways of a ball over the docking shapes, at a constant penetration.
//!
//! Every docking shape is a straight meridian turned about z and rounded by a radius w, so that a ball that sinks in by δ has
//! its centre at the distance w + r − δ from the meridian: along it on a parallel, round its ends on an arc.

use super::sliding_paths::{Path, Piece};
use super::smooth_sliding::{Case, DEPTH, SLIDER, arc, ball, line};
use contact::{Docking, Shape};
use spatial::Vec3;
use std::f64::consts::{FRAC_PI_2, PI};

const HALF_ANGLE: f64 = 0.7;
const DROGUE: Docking = Docking::InnerCone { half_angle: HALF_ANGLE, depth: 0.14, throat_radius: 0.02, wall: 0.01 };
const BORE: Docking = Docking::InnerCylinder { radius: 0.05, depth: 0.1, wall: 0.012, floor: false };
const RING: Docking = Docking::Ring { major_radius: 0.2, minor_radius: 0.015 };
const PETAL: Docking =
    Docking::Petal { base_radius: 0.2, tip_radius: 0.16, height: 0.12, half_sector: 0.55, thickness: 0.02 };

/// A ball round and along each of them, and over their rims.
pub(super) fn cases() -> Vec<Case> {
    let case = |name, shape, pieces| Case {
        name,
        surface: Shape::Docking(shape),
        slider: ball(),
        turned: [0.0; 3],
        path: Path::new(pieces),
        points: 1,
    };
    let round = |radius: f64, height: f64| Piece::Arc {
        centre: Vec3::new(0.0, 0.0, height),
        arm: Vec3::new(radius, 0.0, 0.0),
        axis: Vec3::z(),
        angle: FRAC_PI_2,
    };
    let reach = SLIDER - DEPTH;
    let (bore, tube) = (0.05 - reach, 0.015 + reach);
    let [low, high] = drogue_line();
    vec![
        case("ball round a drogue", DROGUE, vec![round(0.5 * (low.x + high.x), 0.5 * (low.z + high.z))]),
        case("ball up a drogue and over its rim", DROGUE, drogue_rim(low, high)),
        case("ball round a bore", BORE, vec![round(bore, -0.05)]),
        case(
            "ball along a bore and over its rim",
            BORE,
            vec![line([bore, 0.0, -0.06], [bore, 0.0, 0.0]), arc([0.056, 0.0, 0.0], [bore, 0.0, 0.0], FRAC_PI_2)],
        ),
        case("ball round a ring", RING, vec![round(0.2, tube)]),
        case("ball over the tube of a ring", RING, vec![arc([0.2, 0.0, 0.0], [0.2 - tube, 0.0, 0.0], PI)]),
        case("ball up a petal and over its tip", PETAL, petal_tip()),
    ]
}

/// The way along the drogue's wall: from z = −0.06 m to the rim.
fn drogue_line() -> [Vec3; 2] {
    let (sin, cos) = HALF_ANGLE.sin_cos();
    let reach = SLIDER - DEPTH;
    [-0.06, 0.0].map(|z: f64| {
        let inner = 0.02 + (z + 0.14) * HALF_ANGLE.tan();
        Vec3::new(inner - reach * cos, 0.0, z + reach * sin)
    })
}

fn drogue_rim(low: Vec3, high: Vec3) -> Vec<Piece> {
    let (sin, cos) = HALF_ANGLE.sin_cos();
    let arm = 5e-3 + SLIDER - DEPTH;
    let centre = high + arm * Vec3::new(cos, 0.0, -sin);
    vec![Piece::Line { from: low, to: high }, arc(centre.into(), high.into(), 1.5)]
}

fn petal_tip() -> Vec<Piece> {
    let (base, tip) = (Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.16, 0.0, 0.12));
    let along = (tip - base).normalize();
    let out = Vec3::new(along.z, 0.0, -along.x) * (0.01 + SLIDER - DEPTH);
    let low = base + 0.5 * (tip - base);
    vec![Piece::Line { from: low + out, to: tip + out }, arc(tip.into(), (tip + out).into(), -FRAC_PI_2)]
}
