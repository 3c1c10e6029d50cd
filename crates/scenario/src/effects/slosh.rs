//! A mass on a spring in a tank.

use super::*;
use parameter::{ANY, AT_LEAST_ZERO, POSITIVE, shape, zero};
use sim::{BodyLaw, Slosh};
use spatial::Vec3;
use std::f64::consts::TAU;
use unit::{HZ, KG, M, NONE};

/// A point mass on an isotropic spring.
pub static SLOSH: EffectDef = EffectDef {
    name: "slosh",
    meaning: "A mass on a spring in a tank.",
    words: "sloshing of a liquid",
    places: &[PlaceKind::Body],
    parameters: &[
        zero("mass", AT_LEAST_ZERO, KG, "mass that moves, part of the body's nominal mass").with_inertia(1.0),
        shape("frequency", POSITIVE, HZ, "with the body held"),
        shape("damping", AT_LEAST_ZERO, NONE, "ζ: damping ratio").optional(),
        shape("position", ANY, M, "where it rests, from the nominal centre of mass, link axes").vector().optional(),
    ],
    equation: "m ẍ = −m (Ω² u + 2 ζ Ω w) + m g, the opposite on the body at x; Ω = 2π frequency, u: deflection, w: its rate as the turning body sees it.",
    source: "The equivalent spring-mass of a liquid, Abramson 1966; law in `crates/sim/src/parts/effect/body/slosh.rs`.",
    build: Build::Part(PartBuild {
        size: "mass",
        take_out: |entry, own, com| own.without_point(entry.number("mass"), &(com + entry.vector("position"))),
        law,
    }),
    identify: Identify {
        candidates: Candidates::Body(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Dyad,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::SecondMoment { mass: "mass", place: "position" },
    corrects: Corrects::Nothing,
};

fn law(entry: &Entry<'_>, nominal_com: &Vec3) -> BodyLaw {
    let (mass, damping) = (entry.number("mass"), entry.number("damping"));
    let (rate, rest) = (TAU * entry.number("frequency"), nominal_com + entry.vector("position"));
    BodyLaw::Slosh(Slosh { mass, rate, damping, rest })
}

/// Share of the body's mass, and distance (m) from its centre, with which it is screened.
const SHARE: f64 = 0.01;
const DISTANCE: f64 = 0.3;

fn candidates(body: &BodyFact, survey: &Survey<'_>) -> Vec<Candidate> {
    if !body.can_turn() {
        return Vec::new();
    }
    let mass = SHARE * body.mass;
    let mut coordinates = vec![
        Coordinate::level("mass", mass).within([0.0, 0.5 * body.mass]),
        Coordinate::log("frequency", 0.1, [5e-3, 20.0]),
        Coordinate::log("damping", 0.02, [1e-4, 1.0]),
    ];
    let position = Coordinate::vector(["position[0]", "position[1]", "position[2]"], [0.0; 3]);
    coordinates.extend(position.into_iter().map(|c| c.within([-10.0, 10.0])));
    // In a plane nothing tells how high it is.
    let turns_alone_about = |k: usize| (0..3).all(|j| body.turns()[j] == (j == k));
    let flat = (0..3).filter(|k| !body.slides()[*k] && turns_alone_about(*k));
    let held: Vec<usize> = flat.map(|k| 3 + k).collect();
    // A tumble shows m p pᵀ, so that the mass alone stays as it is; what is pushed shows m and m p too.
    let (places, held) = match body.is_pushed() {
        true => (around((0..3).filter(|k| !held.contains(&(3 + k))), DISTANCE), held),
        false => (dyad_axes().map(|axis| DISTANCE * axis).to_vec(), [vec![0], held].concat()),
    };
    let mut slosh = Candidate::new(body.place(), coordinates).holding(held).expensive();
    let neutral = slosh.neutral();
    for f in modes(survey) {
        let point = |place: &Vec3| {
            let mut x = neutral.clone();
            (x[0], x[1]) = (mass, f.ln());
            (0..3).for_each(|k| x[3 + k] = place[k]);
            x
        };
        slosh = slosh.screened_at(&format!("f = {f:.3} Hz"), &places.iter().map(point).collect::<Vec<_>>());
    }
    vec![slosh]
}

/// Frequencies (Hz) at which a part that swings inside a body is screened: those that the data show, six periods in the longest run, and more.
pub(super) fn modes(survey: &Survey<'_>) -> Vec<f64> {
    let seen = survey.lines.iter().flat_map(|f| [*f, HELD * f]);
    seen.chain(log_grid((6.0 / survey.duration).max(0.02), 2.0, 2.0)).collect()
}

/// With the body held a part swings slower than it is seen to: free, the body swings against it.
const HELD: f64 = 0.92;
