//! Dry friction of a joint, of Dahl's kind: one level, a level that falls with speed, or a level for each direction.
//!
//!   −(g/z₀)(z + t_d ż exp(−(q̇/v_d)²)),   ż = q̇ − max(|q̇|, v_c) z/z₀,   t_d = 2 ms,  v_d = 0.02 rad/s or m/s
//!
//! A joint that does not quite hold creeps below v_c. A diagnosis frees z₀ and v_c only where friction with the usual ones does not follow all of the motion.

use super::candidate::Begin;
use super::joint::SMALL;
use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, shape, zero};
use sim::{DryFriction, DryLevel, JointLaw, REACH};
use unit::{EFFORT, PLACE, RATE};

const SOURCE: &str = "Dahl 1968; falling levels after Stribeck, as in Armstrong-Hélouvry, Dupont and Canudas de Wit 1994; \
                      law in `crates/sim/src/parts/effect/joint.rs`.";

/// z₀.
const Z_0: Parameter =
    zero("z_0", POSITIVE, PLACE, "deflection before it slides; the level over it is the stiffness at rest")
        .neutral_at(REACH)
        .optional();
/// v_c.
const V_C: Parameter =
    zero("v_c", AT_LEAST_ZERO, RATE, "rate below which the joint creeps under less than the level, in its share of it")
        .optional();
/// Rate from which creep is looked for, and the largest. What other simulators have for friction that holds is stiff: it yields by a damper, not by a spring.
const CREEP: Begin = Begin { near: 1e-3, afar: [0.1, 3e-3] };
const FASTEST: f64 = 0.3;
/// Reach of friction that is next to rigid, and between which a reach is looked for.
const STIFF: f64 = 1e-5;
const REACHES: [f64; 2] = [1e-6, 0.1];

/// Dry friction of an entry.
fn dry(entry: &Entry<'_>, level: DryLevel) -> JointLaw {
    JointLaw::Dry(DryFriction { level, reach: entry.number(Z_0.name), creep: entry.number(V_C.name) })
}

/// g = c.
pub static JOINT_COULOMB_FRICTION: EffectDef = EffectDef {
    name: "joint-coulomb-friction",
    meaning: "Dry friction of a joint.",
    words: "dry (Coulomb) friction",
    places: &[PlaceKind::Joint],
    parameters: &[zero("c", AT_LEAST_ZERO, EFFORT, "level"), Z_0, V_C],
    equation: "−(c/z₀)(z + t_d ż exp(−(q̇/v_d)²)) with ż = q̇ − max(|q̇|, v_c) z/z₀, t_d = 2 ms and v_d = 0.02 rad/s or m/s: \
               in motion in one direction −c sign q̇, at rest a spring; below v_c a load moves the joint at v_c times its share of c.",
    source: SOURCE,
    build: Build::Effort(|entry| dry(entry, DryLevel::Constant(entry.number("c")))),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| held_levels(joint, &["c"])),
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
        Z_0,
        V_C,
    ],
    equation: "As joint-coulomb-friction, with the level c + (s − c) exp(−(q̇/v_s)²) in the place of c.",
    source: SOURCE,
    build: Build::Effort(|entry| {
        let number = |name: &str| entry.number(name);
        dry(entry, DryLevel::Falling { c: number("c"), s: number("s"), v_s: number("v_s") })
    }),
    identify: Identify {
        candidates: Candidates::Joint(stribeck),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| vec![Alternative::here(&JOINT_COULOMB_FRICTION, vec![x[0], x[3], x[4]])]),
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
        Z_0,
        V_C,
    ],
    equation: "As joint-coulomb-friction, with the level c_plus where the deflection z ≥ 0 and c_minus elsewhere.",
    source: SOURCE,
    build: Build::Effort(|entry| {
        let level = DryLevel::Directed { c_plus: entry.number("c_plus"), c_minus: entry.number("c_minus") };
        dry(entry, level)
    }),
    identify: Identify {
        candidates: Candidates::Joint(|joint, _| held_levels(joint, &["c_plus", "c_minus"])),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| vec![Alternative::here(&JOINT_COULOMB_FRICTION, vec![0.5 * (x[0] + x[1]), x[2], x[3]])]),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// What dry friction does before it slides, as the last of some coordinates: it has the usual reach and does not creep.
fn held(mut coordinates: Vec<Coordinate>, joint: &JointFact) -> Candidate {
    let own = coordinates.len();
    coordinates.push(Coordinate::log(Z_0.name, REACH, REACHES));
    coordinates.push(Coordinate::free(V_C.name, 0.0).within([0.0, FASTEST]));
    let reach = Begin { near: REACH.ln(), afar: [REACH.ln(), STIFF.ln()] };
    Candidate::new(joint.place(), coordinates).in_reserve(own, reach).in_reserve(own + 1, CREEP)
}

/// Levels of dry friction, each with a column at zero.
fn held_levels(joint: &JointFact, levels: &[&'static str]) -> Vec<Candidate> {
    let coordinates = levels.iter().map(|key| Coordinate::level(key, 0.0)).collect();
    vec![held(coordinates, joint).screened(&Along::each(0..levels.len(), SMALL))]
}

fn stribeck(joint: &JointFact, _: &Survey<'_>) -> Vec<Candidate> {
    let coordinates =
        vec![Coordinate::level("c", 0.0), Coordinate::level("s", 0.0), Coordinate::log("v_s", 0.05, [1e-3, 3.0])];
    let falling = held(coordinates, joint).encoded(Encoding::Excess { of: 1, over: 0 });
    vec![falling.screened_on(2, &[0.02, 0.08, 0.3], &Along::each(0..2, SMALL))]
}
