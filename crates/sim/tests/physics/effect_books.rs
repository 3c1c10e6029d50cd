//! What holds for every effect: neutral parameters change no bit, a millionth beside neutral does; energy is accounted
//! for; a snapshot resumes; a step allocates nothing.

use crate::support::effects::{on_joint, wheel_world};
use crate::support::{ALL, Setup, run};
use sim::{Command, DryLevel, EffectKind, Integrator, JointLaw, LineEffect, LineLaw, Series, State, World};
use std::sync::Arc;

/// Every effect on the wheel with one parameter at `x` beside its neutral value.
fn beside(x: f64) -> Vec<EffectKind> {
    let line = |law| EffectKind::Line(LineEffect { actuator: 0, law });
    vec![
        on_joint(JointLaw::Viscous { damping: x }),
        on_joint(JointLaw::Dry(DryLevel::Constant(x).into())),
        on_joint(JointLaw::Dry(DryLevel::Falling { c: 0.0, s: x, v_s: 0.05 }.into())),
        on_joint(JointLaw::Dry(DryLevel::Directed { c_plus: x, c_minus: 0.0 }.into())),
        on_joint(JointLaw::ViscousBySide { plus: x, minus: 0.0 }),
        on_joint(JointLaw::Quadratic { drag: x }),
        on_joint(JointLaw::Offset { effort: x }),
        on_joint(JointLaw::Ripple { amplitude: x, order: 3.0, phase: 0.2 }),
        on_joint(JointLaw::Cable { stiffness: x, rest: 0.3 }),
        on_joint(JointLaw::Periodic { amplitude: x, frequency: 2.0, phase: 0.2 }),
        line(LineLaw::Gain(1.0 + x)),
        line(LineLaw::Delay(x)),
        line(LineLaw::Lag(x)),
    ]
}

/// The wheel pushed to and fro for 0.3 s.
fn swing(kinds: &[EffectKind], integrator: Integrator) -> State {
    let mut world = wheel_world(kinds, &Setup::new(integrator));
    swing_on(&mut world, 0..300);
    world.state().clone()
}

fn swing_on(world: &mut World, steps: std::ops::Range<u32>) {
    for k in steps {
        world.commands_mut()[0] = Command { effort: (0.05 * f64::from(k)).sin(), ..Command::default() };
        run(world, 1);
    }
}

#[test]
fn neutral_effect_changes_no_bit() {
    for integrator in ALL {
        let bare = swing(&[], integrator);
        let moved = |kind: &EffectKind| {
            let state = swing(std::slice::from_ref(kind), integrator);
            (state.q[0].to_bits(), state.v[0].to_bits()) != (bare.q[0].to_bits(), bare.v[0].to_bits())
        };
        for (neutral, near) in beside(0.0).iter().zip(&beside(1e-6)) {
            assert!(!moved(neutral), "{integrator:?}: {neutral:?} changes the run");
            assert!(moved(near), "{integrator:?}: {near:?} does not");
        }
        assert!(!moved(&EffectKind::Line(LineEffect { actuator: 0, law: LineLaw::Saturation(f64::INFINITY) })));
    }
}

/// One of each, with memory of every kind.
fn rich() -> Vec<EffectKind> {
    let line = |law| EffectKind::Line(LineEffect { actuator: 0, law });
    vec![
        on_joint(JointLaw::Viscous { damping: 0.1 }),
        on_joint(JointLaw::Dry(DryLevel::Falling { c: 0.2, s: 0.3, v_s: 0.05 }.into())),
        on_joint(JointLaw::Ripple { amplitude: 0.1, order: 3.0, phase: 0.2 }),
        on_joint(JointLaw::Cable { stiffness: 0.5, rest: 0.3 }),
        EffectKind::Series(Series { coordinate: 0, rotor: 0.2, stiffness: 4_000.0, damping: 3.0, gap: 1e-3 }),
        line(LineLaw::Gain(1.1)),
        line(LineLaw::Delay(0.0123)),
        line(LineLaw::Lag(0.004)),
    ]
}

#[test]
fn snapshot_resumes_with_every_memory() {
    for integrator in ALL {
        let mut through = wheel_world(&rich(), &Setup::new(integrator));
        swing_on(&mut through, 0..200);
        let text = serde_json::to_string(through.state()).unwrap();
        let mut resumed = World::new(Arc::clone(through.model()), serde_json::from_str(&text).unwrap());
        swing_on(&mut through, 200..400);
        swing_on(&mut resumed, 200..400);
        let bits = |world: &World| serde_json::to_string(world.state()).unwrap();
        assert!(bits(&through) == bits(&resumed), "{integrator:?}");
        assert!(!through.state().pending.is_empty(), "commands are on their way");
    }
}

#[test]
fn steps_with_effects_allocate_nothing() {
    for integrator in ALL {
        let mut world = wheel_world(&rich(), &Setup::new(integrator));
        swing_on(&mut world, 0..200);
        let counted = allocation_counter::measure(|| swing_on(&mut world, 200..400));
        assert_eq!(counted.count_total, 0, "{integrator:?}: {} bytes", counted.bytes_total);
    }
}
