//! Orders of convergence, on smooth motion and in contact: a generated table.
//!
//! Every problem has an exact solution where there is one, or Runge–Kutta at a far smaller step.

use crate::support::scenes::{bouncing_ball, driven_arm, pressed_ball, sliding_block};
use crate::support::{ALL, Setup, arm7, bristle, free_world, hunt_crossley, linear, run, table, twist};
use crate::torque_free;
use sim::{Integrator, PairLaw, World};
use std::fmt::Write;

const GRAVITY: f64 = 9.81;
/// Errors below are round-off, not the integrator's.
const ROUND_OFF: f64 = 1e-11;

/// Error of a run with a setup, over so many seconds.
type ErrorOf = Box<dyn Fn(&Setup, f64) -> f64>;

/// What is solved, how long, with which steps, and how far from the truth it ends.
struct Problem {
    name: &'static str,
    seconds: f64,
    /// The largest of four steps, each half of the one before, s.
    coarsest: f64,
    /// Orders that the table must show, by integrator; zero where the kinks of the law decide.
    orders: [f64; 4],
    error: ErrorOf,
}

const SMOOTH: [f64; 4] = [1.0, 2.0, 1.0, 4.0];
/// Kinks of the law limit the order; three halvings have to gain at least a factor of three.
const KINKED: [f64; 4] = [0.0; 4];

fn finish(mut world: World, seconds: f64) -> World {
    let steps = (seconds / world.model().step).round() as usize;
    run(&mut world, steps);
    world
}

/// Error against Runge–Kutta at the step `fine`, by an observable of several numbers.
fn against_reference(build: fn(&Setup) -> World, observe: fn(&World) -> Vec<f64>, seconds: f64, fine: f64) -> ErrorOf {
    let reference = observe(&finish(build(&Setup::new(Integrator::RungeKutta4).step(fine)), seconds));
    Box::new(move |setup, seconds| {
        let got = observe(&finish(build(setup), seconds));
        got.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    })
}

/// Error against a closed form at the end.
fn against_exact(build: fn(&Setup) -> World, observe: fn(&World) -> f64, exact: f64) -> ErrorOf {
    Box::new(move |setup, seconds| (observe(&finish(build(setup), seconds)) - exact).abs())
}

fn free_arm(setup: &Setup) -> World {
    let mut world = free_world(arm7(), setup);
    world.state_mut().q.copy_from_slice(&[0.3, 0.7, 0.2, -1.3, 0.1, 0.8, 0.0]);
    world.state_mut().v.copy_from_slice(&[0.4, -0.5, 0.6, 0.8, -1.0, 0.9, 0.7]);
    world.set_base_twists(&[twist([0.1, -0.05, 0.08], [0.02, 0.01, -0.03])]);
    world
}

fn arm_to_targets(setup: &Setup) -> World {
    let mut world = driven_arm(setup);
    for (i, command) in world.commands_mut().iter_mut().enumerate() {
        command.position = 0.3 - 0.1 * i as f64;
    }
    world
}

fn joints(world: &World) -> Vec<f64> {
    world.state().q.clone()
}

fn x(world: &World) -> f64 {
    world.state().bases[0].translation.vector.x
}

fn z(world: &World) -> f64 {
    world.state().bases[0].translation.vector.z
}

/// m, k, c of the pressed ball, and the sticking block.
const SPRING: (f64, f64, f64) = (1.0, 1e4, 20.0);

fn linear_ball(setup: &Setup) -> World {
    pressed_ball(linear(SPRING.1, SPRING.2), 0.5 * GRAVITY / SPRING.1, setup)
}

fn hertz_ball(setup: &Setup) -> World {
    pressed_ball(hunt_crossley(3e5, 1.5, 0.3), 8e-4, setup)
}

/// x₀ cos + … of m ẍ + c ẋ + k x = 0.
fn damped(x0: f64, v0: f64, t: f64) -> f64 {
    let (m, k, c) = SPRING;
    let decay = 0.5 * c / m;
    let rate = (k / m - decay * decay).sqrt();
    (-decay * t).exp() * (x0 * (rate * t).cos() + (v0 + decay * x0) / rate * (rate * t).sin())
}

const STICK_SPEED: f64 = 0.02;

fn sticking_block(setup: &Setup) -> World {
    let law = PairLaw::new(linear(1e4, 20.0), Some(bristle(0.5, SPRING.1, SPRING.2)));
    sliding_block(law, STICK_SPEED, setup)
}

/// Speeds (m/s), level and stiffness of the blocks that stop; several, since the phase of the stop within a step is luck.
const SLIDES: [f64; 8] = [0.23, 0.25, 0.28, 0.30, 0.31, 0.33, 0.36, 0.37];
const SLIDE_LAW: (f64, f64) = (0.4, 1e5);

/// Root mean square over the speeds.
fn stopping_error(setup: &Setup, seconds: f64) -> f64 {
    let (mu, k) = SLIDE_LAW;
    let law = PairLaw::new(linear(1e5, 100.0), Some(bristle(mu, k, 0.0)));
    let error = |speed: &f64| x(&finish(sliding_block(law, *speed, setup), seconds)) - stopped_at(*speed, seconds);
    rms(SLIDES.iter().map(error))
}

/// Bristle stretching, Coulomb sliding, bristle swinging: a 1 kg block in closed form.
fn stopped_at(speed: f64, t: f64) -> f64 {
    let (mu, k) = SLIDE_LAW;
    let (rate, reach) = (k.sqrt(), mu * GRAVITY / k);
    let stretch = (reach * rate / speed).asin() / rate;
    let left = (speed * speed - (reach * rate).powi(2)).sqrt();
    let slide = left / (mu * GRAVITY);
    let stop = reach + 0.5 * left * slide;
    stop - reach + reach * (rate * (t - stretch - slide)).cos()
}

/// Gaps (m) from which balls are dropped, and the stiffness that they fall on.
const DROPS: [f64; 8] = [0.0190, 0.0193, 0.0197, 0.0200, 0.0204, 0.0207, 0.0209, 0.0211];
const FLOOR: f64 = 1e4;

fn bouncing_error(setup: &Setup, seconds: f64) -> f64 {
    let error =
        |gap: &f64| z(&finish(bouncing_ball(linear(FLOOR, 0.0), *gap, setup), seconds)) - rebound(*gap, seconds);
    rms(DROPS.iter().map(error))
}

/// Gap at `t` in the flight after the second contact of a 1 kg ball.
fn rebound(gap: f64, t: f64) -> f64 {
    let (fall, rate) = ((2.0 * gap / GRAVITY).sqrt(), FLOOR.sqrt());
    let contact = 2.0 / rate * (std::f64::consts::PI - (fall * rate).atan());
    let since_top = t - (4.0 * fall + 2.0 * contact);
    gap - 0.5 * GRAVITY * since_top * since_top
}

fn rms(errors: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = errors.len() as f64;
    (errors.map(|e| e * e).sum::<f64>() / n).sqrt()
}

fn problems() -> Vec<Problem> {
    let static_depth = GRAVITY / SPRING.1;
    vec![
        Problem {
            name: "free arm, 7 joints, 1 s",
            seconds: 1.0,
            coarsest: 8e-3,
            orders: SMOOTH,
            error: against_reference(free_arm, joints, 1.0, 2.5e-4),
        },
        Problem {
            name: "free arm, spring drives, 1 s",
            seconds: 1.0,
            coarsest: 1e-3,
            orders: SMOOTH,
            error: against_reference(arm_to_targets, joints, 1.0, 3.125e-5),
        },
        Problem {
            name: "torque-free body, 4 s (Jacobi)",
            seconds: 4.0,
            coarsest: 8e-3,
            orders: SMOOTH,
            error: Box::new(torque_free::error_of_first_start),
        },
        Problem {
            name: "pressed ball, linear law (closed form)",
            seconds: 0.1,
            coarsest: 1e-3,
            orders: SMOOTH,
            error: against_exact(linear_ball, z, -static_depth + damped(0.5 * static_depth, 0.0, 0.1)),
        },
        Problem {
            name: "pressed ball, Hunt–Crossley n = 1.5",
            seconds: 0.1,
            coarsest: 1e-3,
            orders: SMOOTH,
            error: against_reference(hertz_ball, |w| vec![z(w)], 0.1, 1e-5),
        },
        Problem {
            name: "sticking block on its bristle (closed form)",
            seconds: 0.1,
            coarsest: 1e-3,
            orders: SMOOTH,
            error: against_exact(sticking_block, x, damped(0.0, STICK_SPEED, 0.1)),
        },
        Problem {
            name: "block slides, stops, sticks (closed form)",
            seconds: 0.3,
            coarsest: 1e-3,
            orders: KINKED,
            error: Box::new(stopping_error),
        },
        Problem {
            name: "ball bounces twice (closed form)",
            seconds: 0.35,
            coarsest: 1e-3,
            orders: KINKED,
            error: Box::new(bouncing_error),
        },
    ]
}

const HEADER: &str = "\
# Orders of convergence

Error at the end of the run (m or rad) with four steps, each half of the one before. The order is that of the last
halving above round-off (1e-11); for the last two problems, whose kinks fall at any phase of a step, the error is the
root mean square over eight starts and the order the mean of the three halvings. Written by
`SOFTDOCK_BLESS=1 cargo test -p softdock-sim -- table`, compared by every `cargo test`.

| problem | integrator | h (ms) | error at h | h/2 | h/4 | h/8 | order |
| --- | --- | --- | --- | --- | --- | --- | --- |
";

/// Order of the last halving above round-off; the mean of all where the problem is kinked.
fn order(errors: &[f64; 4], kinked: bool) -> f64 {
    if kinked {
        return (errors[0] / errors[3]).log2() / 3.0;
    }
    let last = errors.windows(2).rev().find(|pair| pair[1] > ROUND_OFF).unwrap_or(&errors[..2]);
    (last[0] / last[1]).log2()
}

#[test]
fn table_of_orders_of_convergence() {
    let mut text = HEADER.to_owned();
    let mut failures = String::new();
    for problem in problems() {
        for (integrator, expected) in ALL.into_iter().zip(problem.orders) {
            let steps = [1.0, 0.5, 0.25, 0.125].map(|k| k * problem.coarsest);
            let errors = steps.map(|h| (problem.error)(&Setup::new(integrator).step(h), problem.seconds));
            let order = order(&errors, expected == 0.0);
            let shown =
                errors.map(|e| if e < ROUND_OFF { "<1e-11".to_owned() } else { format!("{e:.2e}") }).join(" | ");
            let h = problem.coarsest * 1e3;
            writeln!(text, "| {} | {integrator:?} | {h} | {shown} | {order:.1} |", problem.name).unwrap();
            // Orders above the nominal one are welcome.
            if order < expected - 0.25 || (expected == 0.0 && errors[3] > errors[0] / 3.0) {
                writeln!(failures, "{}, {integrator:?}: order {order:.2}, expected {expected}", problem.name).unwrap();
            }
        }
    }
    println!("{text}");
    assert!(failures.is_empty(), "{failures}");
    table::check("convergence.md", &text);
}
