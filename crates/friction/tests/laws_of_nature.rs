//! What a friction law owes to physics, whatever happens to it: it gives no energy, it knows no preferred direction, its
//! memory is bounded, and it acts on both bodies alike.

use friction::{Bristle, Brush, Trial, carry};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

/// A few round-offs, relative to the largest force or energy at hand.
const ROUND_OFF: f64 = 1e-12;

/// Largest deflection that a step starts with, in what its normal force and speed hold: both may just have fallen.
const BOUND: f64 = 5.0;

type Vec3 = Vector3<f64>;

/// Slip during a step (m), normal force (N), turn of both bodies (rad), tilt of the plane against them (rad).
#[derive(Clone, Copy, Debug)]
struct Step {
    slip: Vec3,
    normal_force: f64,
    turn: Vec3,
    tilt: Vec3,
}

/// What a point remembers.
#[derive(Clone, Copy, Debug)]
struct Memory {
    s: Vec3,
    rest: f64,
    grain: Vec3,
}

fn vector(size: f64) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-size..size).prop_map(Vec3::from)
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    // Steps from far below the largest deflection to far above it; one in five lifts off.
    let normal = prop_oneof![4 => 0.0..100.0f64, 1 => -10.0..0.0f64];
    let step = (vector(1.0), -7.0..-2.0f64, normal, vector(0.3), vector(0.3)).prop_map(
        |(direction, decade, normal_force, turn, tilt)| Step {
            slip: direction * 10f64.powf(decade),
            normal_force,
            turn,
            tilt,
        },
    );
    prop::collection::vec(step, 1..60)
}

fn laws() -> impl Strategy<Value = Bristle> {
    let levels = (0.0..1.0f64, 0.0..1.0f64, prop_oneof![1e-4..0.1f64, Just(0.0)], prop_oneof![Just(0.0), 1e-4..1.0f64]);
    let brush = (prop_oneof![Just(1.0), 0.1..3.0f64], 1e2..1e7f64, 0.0..1e3f64, 0.0..10.0f64);
    let fall = prop_oneof![Just(0.0), 1e-4..0.1f64];
    (levels, brush, fall).prop_map(
        |((mu_kinetic, drop, stribeck_speed, dwell_time), (across, stiffness, damping, viscous), fall_time)| Bristle {
            mu_static: mu_kinetic + drop,
            mu_kinetic,
            stribeck_speed,
            dwell_time,
            fall_time,
            across,
            stiffness,
            damping,
            viscous,
        },
    )
}

const STEP_S: f64 = 1e-3;

/// One step in the present plane.
fn take(law: &Bristle, memory: &Memory, slip: &Vec3, normal_force: f64) -> Brush {
    let Memory { s, rest, grain } = *memory;
    law.eval(&Trial { s, s_trial: s + slip, slip: slip / STEP_S, elapsed: STEP_S, normal_force, rest, grain })
}

fn rested(s: Vec3) -> Memory {
    Memory { s, rest: 1.0, grain: Vec3::x() }
}

/// A history in a plane that turns with the bodies and against them: what went in, what is left, what went to and fro, J.
fn run(law: &Bristle, history: &[Step], mut each: impl FnMut(&Step, &Brush)) -> (f64, f64, f64) {
    let (mut n, mut grain, mut work, mut gross) = (Vec3::z(), Vec3::x(), 0.0, 0.0);
    let (mut s, mut rest) = (Vec3::zeros(), law.levels().initial_rest());
    for step in history {
        let turn = Rotation3::new(step.turn);
        let (turned, to) = (turn * n, Rotation3::new(step.tilt) * turn * n);
        s = carry(&(turn * s), &turned, &to);
        grain = carry(&(turn * grain), &turned, &to);
        n = to;
        let slip = step.slip - n * n.dot(&step.slip);
        let brush = take(law, &Memory { s, rest, grain }, &slip, step.normal_force);
        // Work done on the brush by the motion of B, against the force on B.
        work -= brush.force.dot(&slip);
        gross += (brush.force.dot(&slip)).abs();
        (s, rest) = (brush.s, brush.rest);
        each(step, &brush);
    }
    (work, law.calc_stored_energy(&s), gross)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Implicit in the deflection, the law loses energy step by step: what is stored was put in, whatever the slip, the
    /// normal force and the plane do.
    #[test]
    fn work_put_in_is_never_less_than_what_is_stored(law in laws(), history in steps()) {
        let (work, stored, gross) = run(&law, &history, |_, _| ());
        prop_assert!(work >= stored - ROUND_OFF * (gross + stored), "work {work} J, stored {stored} J");
    }

    /// At every moment, not only at the end: a single step returns no more than was stored before it.
    #[test]
    fn a_step_returns_no_more_than_was_stored(
        law in laws(), s in vector(1.0), slip in vector(1e-3), normal in -5.0..50.0f64, stretch in 0.0..BOUND,
    ) {
        let plane = |v: Vec3| Vec3::new(v.x, v.y, 0.0);
        let slip = plane(slip);
        let reach = law.calc_reach(normal, 1.0);
        let s = plane(s).try_normalize(0.0).unwrap_or_else(Vec3::x) * (stretch * reach);
        let brush = take(&law, &rested(s), &slip, normal);
        let returned = brush.force.dot(&slip);
        let lost = law.calc_stored_energy(&s) - law.calc_stored_energy(&brush.s);
        let scale = law.calc_stored_energy(&s) + returned.abs();
        prop_assert!(returned <= lost + ROUND_OFF * scale, "returned {returned} J of {lost} J");
    }

    #[test]
    fn memory_and_force_are_bounded_by_the_normal_force(law in laws(), history in steps()) {
        run(&Bristle { viscous: 0.0, ..law }, &history, |step, brush| {
            let reach = law.calc_reach(step.normal_force, 1.0) * law.across.max(1.0) * (1.0 + ROUND_OFF);
            assert!(brush.s.norm() <= reach, "|s| = {} m, μ fₙ / k = {reach} m", brush.s.norm());
            assert!(brush.force.norm() <= law.stiffness * reach * (1.0 + ROUND_OFF));
        });
    }

    #[test]
    fn turning_everything_turns_the_force(law in laws(), s in vector(1e-4), slip in vector(1e-3), turn in vector(3.0), normal in 0.0..50.0f64) {
        let rot = Rotation3::new(turn);
        let there = Memory { s: rot * s, rest: 1.0, grain: rot * Vec3::x() };
        let (here, there) = (take(&law, &rested(s), &slip, normal), take(&law, &there, &(rot * slip), normal));
        prop_assert!((rot * here.force - there.force).norm() <= ROUND_OFF * (1.0 + here.force.norm()));
        prop_assert!((rot * here.s - there.s).norm() <= ROUND_OFF * here.s.norm().max(1e-12));
    }

    #[test]
    fn turning_everything_turns_the_rate(law in laws(), s in vector(1e-4), slip in vector(1e-3), turn in vector(3.0), normal in 0.0..50.0f64) {
        let rot = Rotation3::new(turn);
        let rate = |rot: &Rotation3<f64>| law.eval_rate(&Trial {
            s: rot * s, slip: rot * slip, normal_force: normal, grain: rot * Vec3::x(), ..Trial::default()
        });
        let (here, there) = (rate(&Rotation3::identity()), rate(&rot));
        prop_assert!((rot * here.force - there.force).norm() <= 1e-9 * (1.0 + here.force.norm()) || here.sticks != there.sticks);
    }

    /// Seen from the other body, slip and deflection change sign and so does the force: to the bit.
    #[test]
    fn seen_from_the_other_body_the_force_flips(law in laws(), history in steps()) {
        let (mut here, mut there) = (rested(Vec3::zeros()), rested(Vec3::zeros()));
        for step in &history {
            let (a, b) = (take(&law, &here, &step.slip, step.normal_force), take(&law, &there, &-step.slip, step.normal_force));
            prop_assert_eq!(a.force, -b.force);
            prop_assert_eq!(a.s, -b.s);
            (here.s, here.rest, there.s, there.rest) = (a.s, a.rest, b.s, b.rest);
        }
    }

    /// Asked twice it answers the same: the law has no memory of its own.
    #[test]
    fn the_law_is_pure(law in laws(), s in vector(1e-3), slip in vector(1e-3), normal in -5.0..50.0f64) {
        prop_assert_eq!(take(&law, &rested(s), &slip, normal), take(&law, &rested(s), &slip, normal));
    }

    #[test]
    fn the_rate_form_stores_no_more_than_it_is_given(law in laws(), s in vector(1e-3), slip in vector(1e-1), normal in -5.0..50.0f64) {
        let law = Bristle { stiffness: law.stiffness.max(1.0), ..law };
        let grain = Vec3::x();
        let rate = law.eval_rate(&Trial { s, slip, normal_force: normal, grain, ..Trial::default() });
        let (given, stored) = (-rate.force.dot(&slip), law.stiffness * rate.s.dot(&rate.s_rate));
        let scale = law.stiffness * rate.s.norm() * slip.norm() + given.abs();
        prop_assert!(given >= stored - 1e-9 * scale, "given {given} W, stored {stored} W");
    }
}
