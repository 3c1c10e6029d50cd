//! Dry friction of a joint, of Dahl's kind: one level, a level that falls with speed, or a level for each direction.
//!
//!   −(g/z₀)(z + t_d ż exp(−(q̇/v_d)²)),   ż = q̇ − |q̇| z/z₀,   z₀ = 3e-4 rad or m,  t_d = 2 ms,  v_d = 0.02 rad/s or m/s

use super::joint::{SMALL, each_screened};
use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, shape, zero};
use sim::{DryLevel, JointLaw};
use unit::{EFFORT, RATE};

const SOURCE: &str = "Dahl 1968; falling levels after Stribeck, as in Armstrong-Hélouvry, Dupont and Canudas de Wit 1994; \
                      law in `crates/sim/src/effect/joint.rs`.";

/// g = c.
pub static JOINT_COULOMB_FRICTION: EffectDef = EffectDef {
    name: "joint-coulomb-friction",
    meaning: "Dry friction of a joint.",
    words: "dry (Coulomb) friction",
    places: &[PlaceKind::Joint],
    parameters: &[zero("c", AT_LEAST_ZERO, EFFORT, "level")],
    equation: "−(c/z₀)(z + t_d ż exp(−(q̇/v_d)²)) with ż = q̇ − |q̇| z/z₀, z₀ = 3·10⁻⁴ rad or m, t_d = 2 ms and v_d = 0.02 rad/s or m/s: \
               in motion in one direction −c sign q̇, at rest a spring.",
    source: SOURCE,
    build: Build::Effort(|entry| JointLaw::Dry(DryLevel::Constant(entry.number("c")))),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| each_screened(joint, &["c"])),
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

/// g = c + (s − c) exp(−(q̇/v_s)²).
pub static JOINT_STRIBECK_FRICTION: EffectDef = EffectDef {
    name: "joint-stribeck-friction",
    meaning: "Dry friction of a joint, higher at rest than in motion.",
    words: "dry friction that is higher at breakaway than in sliding (Stribeck)",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("c", AT_LEAST_ZERO, EFFORT, "level in fast motion"),
        zero("s", AT_LEAST_ZERO, EFFORT, "level at rest"),
        shape("v_s", POSITIVE, RATE, "rate over which the level falls"),
    ],
    equation: "As joint-coulomb-friction, with the level c + (s − c) exp(−(q̇/v_s)²) in the place of c.",
    source: SOURCE,
    build: Build::Effort(|entry| {
        let number = |name: &str| entry.number(name);
        JointLaw::Dry(DryLevel::Falling { c: number("c"), s: number("s"), v_s: number("v_s") })
    }),
    identify: Identify {
        candidates: Candidates::Joint(stribeck),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| vec![Alternative::here(&JOINT_COULOMB_FRICTION, vec![x[0]])]),
        start: Start::Mean,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::FallingLevel { sliding: "c", rest: "s", speed: "v_s" },
    corrects: Corrects::Nothing,
};

/// g = c± by the sign of z.
pub static JOINT_FRICTION_ASYMMETRY: EffectDef = EffectDef {
    name: "joint-friction-asymmetry",
    meaning: "Dry friction of a joint that differs by direction.",
    words: "dry friction that differs between the two directions",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("c_plus", AT_LEAST_ZERO, EFFORT, "level where z ≥ 0: against motion in the positive direction"),
        zero("c_minus", AT_LEAST_ZERO, EFFORT, "level elsewhere"),
    ],
    equation: "As joint-coulomb-friction, with the level c_plus where the deflection z ≥ 0 and c_minus elsewhere.",
    source: SOURCE,
    build: Build::Effort(|entry| {
        let level = DryLevel::Directed { c_plus: entry.number("c_plus"), c_minus: entry.number("c_minus") };
        JointLaw::Dry(level)
    }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| each_screened(joint, &["c_plus", "c_minus"])),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| vec![Alternative::here(&JOINT_COULOMB_FRICTION, vec![0.5 * (x[0] + x[1])])]),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

fn stribeck(joint: &JointFact, _: &Survey<'_>) -> Vec<Candidate> {
    let coordinates =
        vec![Coordinate::level("c", 0.0), Coordinate::level("s", 0.0), Coordinate::log("v_s", 0.05, [1e-3, 3.0])];
    let falling = Candidate::new(joint.place(), coordinates).encoded(Encoding::Excess { of: 1, over: 0 });
    vec![falling.screened_on(2, &[0.02, 0.08, 0.3], &Along::each(0..2, SMALL))]
}
