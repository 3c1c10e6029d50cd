//! From command to output: delays to the instant, exact lags, gains, bounds; and steps of any length.

use crate::support::effects::{INERTIA, wheel_world};
use crate::support::{ALL, Setup, block, run, spec, world};
use sim::{Actuator, ActuatorKind, Base, Command, Effect, EffectKind, Integrator, LineEffect, LineLaw, World};
use spatial::Vec3;

fn line(law: LineLaw) -> EffectKind {
    EffectKind::Line(LineEffect { actuator: 0, law })
}

fn effort(effort: f64) -> Command {
    Command { effort, ..Command::default() }
}

/// Commands of 1, 3, 0 N·m from 0, 10, 20 ms on.
fn run_steps(world: &mut World, step: f64) {
    for command in [1.0, 3.0, 0.0] {
        world.commands_mut()[0] = effort(command);
        (0..(0.01 / step).round() as usize).for_each(|_| world.advance_by(step).unwrap());
    }
}

#[test]
fn delayed_command_acts_at_its_instant_and_not_at_a_step() {
    for integrator in ALL {
        for delay in [0.0, 0.0037, 0.004, 0.0123] {
            let mut world = wheel_world(&[line(LineLaw::Delay(delay))], &Setup::new(integrator).step(2e-3));
            run_steps(&mut world, 2e-3);
            // The first command acts until the second's instant: 1 N·m for 10 ms + delay, then 3 N·m to 30 ms at most.
            let third: f64 = (0.03_f64).min(0.02 + delay);
            let impulse = (0.01 + delay) + 3.0 * (third - 0.01 - delay);
            let miss = world.state().v[0] * INERTIA - impulse;
            assert!(miss.abs() < 1e-14, "{integrator:?}, {delay} s: {miss:.1e}");
            assert!((world.state().time - 0.03).abs() < 1e-15 && world.state().steps == 15);
        }
    }
}

#[test]
fn next_switch_is_when_the_next_command_acts() {
    let mut world = wheel_world(&[line(LineLaw::Delay(0.005))], &Setup::new(Integrator::RungeKutta4));
    world.commands_mut()[0] = effort(1.0);
    run(&mut world, 1);
    assert_eq!(world.next_switch(), None, "the first acts at once");
    world.commands_mut()[0] = effort(2.0);
    run(&mut world, 1);
    assert!((world.next_switch().unwrap() - 0.006).abs() < 1e-15);
    run(&mut world, 5);
    assert_eq!(world.next_switch(), None);
}

#[test]
fn commands_of_the_past_are_recalled() {
    let spec = || wheel_world(&[line(LineLaw::Delay(0.0075))], &Setup::new(Integrator::RungeKutta4));
    let mut through = spec();
    let past: Vec<(f64, [Command; 1])> = (0..10).map(|k| (0.002 * f64::from(k), [effort(f64::from(k * k))])).collect();
    for (_, commands) in &past {
        through.commands_mut().copy_from_slice(commands);
        run(&mut through, 2);
    }
    let mut late = spec();
    *late.state_mut() = sim::State { acting: Vec::new(), pending: Vec::new(), ..through.state().clone() };
    late.recall_commands(past.iter().map(|(t, c)| (*t, c.as_slice())));
    for world in [&mut through, &mut late] {
        world.commands_mut()[0] = effort(7.0);
        run(world, 20);
    }
    assert_eq!(through.state(), late.state());
}

#[test]
fn lag_gives_the_impulse_of_its_exponential_at_any_time_constant() {
    for integrator in ALL {
        for time in [0.0, 1e-5, 5e-4, 2e-3, 0.05] {
            let mut world = wheel_world(&[line(LineLaw::Lag(time))], &Setup::new(integrator));
            run(&mut world, 1);
            world.commands_mut()[0] = effort(2.0);
            run(&mut world, 40);
            let rest = if time > 0.0 { time * (1.0 - (-0.04 / time).exp()) } else { 0.0 };
            let miss = world.state().v[0] * INERTIA - 2.0 * (0.04 - rest);
            // Simpson's rule where a step resolves the lag: (h/T)⁴/2880 of an impulse of h.
            assert!(miss.abs() < 1e-9, "{integrator:?}, T = {time} s: {miss:.1e}");
            let output = world.state().effects[0];
            assert!((output - 2.0 * (1.0 - if time > 0.0 { (-0.04 / time).exp() } else { 0.0 })).abs() < 1e-12);
        }
    }
}

#[test]
fn gain_comes_after_the_nominal_limit_and_before_the_bound() {
    let torque = |laws: &[LineLaw], command: f64| {
        let kinds: Vec<_> = laws.iter().map(|law| line(*law)).collect();
        let mut world = wheel_world(&kinds, &Setup::new(Integrator::RungeKutta4));
        world.commands_mut()[0] = effort(command);
        run(&mut world, 10);
        world.state().v[0] / 0.01 * INERTIA
    };
    let close = |a: f64, b: f64| (a - b).abs() < 1e-10;
    assert!(close(torque(&[LineLaw::Gain(0.9)], 10.0), 9.0));
    assert!(close(torque(&[LineLaw::Gain(1.1)], 1_000.0), 110.0), "nominally 100 N·m at most");
    assert!(close(torque(&[LineLaw::Gain(2.0), LineLaw::Saturation(15.0)], 10.0), 15.0));
    assert!(close(torque(&[LineLaw::Saturation(15.0)], -20.0), -15.0));
}

#[test]
fn thruster_with_gain_lag_and_delay_gives_their_impulse() {
    for integrator in ALL {
        let setup = Setup::new(integrator);
        let mut spec = spec(vec![(block(2.0, Vec3::repeat(0.1)), Base::Free)], &setup);
        let kind = ActuatorKind::Thruster { body: 0, position: Vec3::zeros(), direction: Vec3::x(), max_force: 0.5 };
        spec.actuators = vec![Actuator { name: "jet".to_owned(), kind }];
        let laws = [LineLaw::Gain(0.93), LineLaw::Lag(0.01), LineLaw::Delay(0.0042)];
        spec.effects = laws.iter().map(|law| Effect { name: format!("{law:?}"), kind: line(*law) }).collect();
        let mut world = world(spec);
        run(&mut world, 10);
        world.commands_mut()[0] = effort(1.0);
        run(&mut world, 90);
        world.commands_mut()[0] = effort(0.0);
        run(&mut world, 400);
        let expected = 0.93 * 0.5 * 0.09;
        let got = world.state().momentum[0].force.x;
        assert!((got - expected).abs() < 1e-9, "{integrator:?}: {got} N·s against {expected}");
    }
}

#[test]
fn a_step_of_the_models_length_is_a_step() {
    for integrator in ALL {
        let [mut plain, mut by] = [(), ()].map(|()| wheel_world(&[], &Setup::new(integrator)));
        for world in [&mut plain, &mut by] {
            world.commands_mut()[0] = effort(1.0);
        }
        for _ in 0..100 {
            plain.advance().unwrap();
            by.advance_by(1e-3).unwrap();
        }
        assert_eq!(plain.state(), by.state());
        by.advance_by(0.0).unwrap();
        by.advance_by(f64::NAN).unwrap();
        assert_eq!(plain.state(), by.state(), "no length, no step");
        by.advance_by(2.5e-4).unwrap();
        by.advance_by(7.5e-4).unwrap();
        plain.advance().unwrap();
        assert!((plain.state().v[0] - by.state().v[0]).abs() < 1e-15);
        assert!((plain.state().time - by.state().time).abs() < 1e-15);
    }
}

/// A start may ask for the rest of the memory before any command was accepted.
#[test]
fn a_late_thruster_settles_before_its_first_command() {
    for integrator in ALL {
        let mut spec = spec(vec![(block(2.0, Vec3::repeat(0.1)), Base::Free)], &Setup::new(integrator));
        let kind = ActuatorKind::Thruster { body: 0, position: Vec3::zeros(), direction: Vec3::x(), max_force: 0.5 };
        spec.actuators = vec![Actuator { name: "jet".to_owned(), kind }];
        let laws = [LineLaw::Lag(0.01), LineLaw::Delay(0.0042)];
        spec.effects = laws.iter().map(|law| Effect { name: format!("{law:?}"), kind: line(*law) }).collect();
        let mut world = world(spec);
        world.commands_mut()[0] = effort(1.0);
        world.settle_effects();
        assert_eq!(world.state().effects, [0.5], "{integrator:?}: the first command acts as if it always had");
    }
}
