//! An inner sphere that turns in a viscous fluid: energy falls, angular momentum stays.

use super::*;
use parameter::{AT_LEAST_ZERO, zero};
use sim::{BodyLaw, Sphere};
use unit::{KG_M2, N_M_S_PER_RAD};

/// A sphere in its fluid.
pub static INTERNAL_DISSIPATION: EffectDef = EffectDef {
    name: "internal-dissipation",
    meaning: "An inner sphere that turns in a viscous fluid.",
    words: "dissipation inside the body",
    places: &[PlaceKind::Body],
    parameters: &[
        zero("i_damper", AT_LEAST_ZERO, KG_M2, "inertia of the sphere, part of the body's nominal inertia")
            .with_inertia(1.0),
        zero("c", AT_LEAST_ZERO, N_M_S_PER_RAD, "torque over the difference of angular velocities").with_inertia(1.0),
    ],
    equation: "i_damper ω̇_s = c (ω − ω_s), the opposite torque on the body, whose own inertia is smaller by i_damper.",
    source: "The viscous damper of Hughes 1986, in its isotropic form; law in `crates/sim/src/parts/effect/body/sphere.rs`.",
    build: Build::Part(PartBuild {
        size: "i_damper",
        take_out: |entry, own, _| own.without_sphere(entry.number("i_damper")),
        law: |entry, _| BodyLaw::Sphere(Sphere { inertia: entry.number("i_damper"), c: entry.number("c") }),
    }),
    identify: Identify {
        candidates: Candidates::Body(candidates),
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

fn candidates(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    if !body.can_turn() {
        return Vec::new();
    }
    let coordinates = vec![Coordinate::level("i_damper", 0.0), Coordinate::log("c", 0.01, [1e-5, 10.0])];
    let column = Along::new(0, 1e-3 * body.mean_moment());
    let mut damper = Candidate::new(body.place(), coordinates).encoded(Encoding::RateOfInertia).screened_on(
        1,
        &log_grid(1e-3, 1.0, 1.0),
        &[column],
    );
    damper.is_expensive = !body.is_torque_free;
    vec![damper]
}
