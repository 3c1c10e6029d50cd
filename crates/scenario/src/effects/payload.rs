//! A point mass that is fixed to a link.

use super::*;
use multibody::Inertial;
use parameter::{ANY, shape, zero};
use spatial::{Mat3, Vec3};
use unit::{KG, M};

/// Added to what the link has.
pub static PAYLOAD: EffectDef = EffectDef {
    name: "payload",
    meaning: "A point mass fixed to a link.",
    words: "an additional mass",
    places: &[PlaceKind::Link, PlaceKind::Body],
    parameters: &[
        zero("mass", ANY, KG, "added mass; negative takes away, as long as the link keeps some"),
        shape("com", ANY, M, "where it is, link frame; the origin where it is left out").vector().optional(),
    ],
    equation: "m = m₀ + mass, the centre of mass and the tensor about it by Steiner's theorem for a point at com.",
    source: "Steiner; a change of the robot's description before its tree is built.",
    build: Build::AddMass(add),
    identify: Identify {
        candidates: Candidates::Body(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Sum,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};

/// Adds a point mass; written as a correction, so that no mass changes no bit.
fn add(entry: &Entry<'_>, inertial: &mut Option<Inertial>, faults: &mut Faults<'_>) {
    let (mass, at) = (entry.number("mass"), entry.vector("com"));
    let Some(own) = inertial else {
        if mass > 0.0 {
            *inertial = Some(Inertial { mass, com: at, tensor_com: Mat3::zeros() });
        }
        return;
    };
    let total = own.mass + mass;
    if total <= 0.0 {
        faults.add(&entry.key("mass"), format!("takes more than the link has ({} kg)", own.mass));
        return;
    }
    let arm: Vec3 = at - own.com;
    own.tensor_com += own.mass * mass / total * (arm.norm_squared() * Mat3::identity() - arm * arm.transpose());
    own.com += mass / total * arm;
    own.mass = total;
}

/// Mass with which a payload is screened, kg, and how far from the link's origin at least and at most, m.
const SMALL: f64 = 1e-2;
const NEAREST: f64 = 0.05;
const FARTHEST: f64 = 0.5;

/// A base that carries more has another mass, centre and inertia: only links of arms have candidates.
fn candidates(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    if body.is_base {
        return Vec::new();
    }
    let mut coordinates = vec![Coordinate::level("mass", 0.0)];
    // Of the moment m p: as if the link's own mass hung at its end.
    let moment = Coordinate::vector(["com[0]", "com[1]", "com[2]"], [0.0; 3]).into_iter();
    coordinates.extend(moment.map(|c| c.about(body.mass * body.reach())));
    // On both sides of the origin along each axis, so that mass, moments and moments of inertia have columns each and none has to
    // stand for another: the signs of the moments do not hang on what the inertia asks for.
    let at = |c: Vec3| vec![SMALL, SMALL * c.x, SMALL * c.y, SMALL * c.z];
    let arm = (0.5 * body.reach()).clamp(NEAREST, FARTHEST);
    let points: Vec<Vec<f64>> = around(0..3, arm).into_iter().map(at).collect();
    let place = format!("link:{}", body.name);
    vec![Candidate::new(place, coordinates).encoded(Encoding::Moment).screened_at("", &points)]
}
