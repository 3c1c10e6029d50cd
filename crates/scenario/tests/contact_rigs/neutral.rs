//! An effect at the nominal numbers changes no bit of a run; a millionth beside them it does.

use scenario::spec::{Effect, ParamValue};
use sim::State;
use spatial::{Twist, Vec3};

/// Name, neutral parameters, and the one that is then changed.
type Beside = (&'static str, &'static [(&'static str, f64)], &'static str);

/// Effects on the contact of dock-impact with their neutral parameters, and the one that is then changed.
const EFFECTS: [Beside; 10] = [
    ("contact-stiffness", &[("k", 3e6), ("n", 1.5)], "k"),
    ("contact-stiffness", &[("k", 3e6), ("n", 1.5)], "n"),
    ("contact-damping", &[("c", 6.0)], "c"),
    ("friction-coefficient", &[("mu", 0.12)], "mu"),
    ("friction-stribeck", &[("mu_s", 0.12), ("mu_d", 0.12), ("v_s", 0.1)], "mu_s"),
    ("friction-bristle-stiffness", &[("k_b", 4e5), ("c_b", 400.0)], "k_b"),
    ("friction-viscous", &[("b", 0.0)], "b"),
    ("friction-anisotropy", &[("mu_1", 0.12), ("mu_2", 0.12), ("angle", 0.3)], "mu_2"),
    ("friction-dwell-time", &[("mu_s_inf", 0.12), ("time_constant", 0.5)], "mu_s_inf"),
    ("adhesion", &[("force", 0.0)], "force"),
];

/// 0.7 s at 85 mm/s with the touch in the middle.
fn run(effects: Vec<Effect>, integrator: &str) -> State {
    run_from(effects, integrator, (-2.115, 0.085))
}

/// 0.7 s from a place on x (m) at a speed (m/s).
fn run_from(effects: Vec<Effect>, integrator: &str, (x, speed): (f64, f64)) -> State {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/rigs/dock-impact.toml");
    let kind = format!("integrator.kind={integrator}");
    let mut spec = scenario::load(file.as_ref(), &["integrator.step_s=5e-4".to_owned(), kind]).unwrap();
    spec.effects = effects;
    let mut mission = scenario::build(&spec).unwrap_or_else(|e| panic!("{e}"));
    mission.world.state_mut().bases[0].translation.vector.x = x;
    let twist = Twist::new(Vec3::zeros(), Vec3::new(speed, 0.02 * speed, 0.01 * speed));
    mission.world.set_base_twists(&[twist, Twist::default()]);
    (0..1400).for_each(|_| mission.world.advance().unwrap());
    assert!(mission.world.state().work.contact_queries > 0);
    mission.world.state().clone()
}

fn effect(name: &str, params: impl IntoIterator<Item = (&'static str, ParamValue)>) -> Effect {
    let params = params.into_iter().map(|(k, v)| (k.to_owned(), v)).collect();
    Effect { name: name.to_owned(), place: "contact:probe/drogue".to_owned(), params }
}

fn same_bits(a: &State, b: &State) -> bool {
    a.bases == b.bases && a.momentum == b.momentum && a.bristles == b.bristles
}

#[test]
fn neutral_effects_on_a_contact_change_no_bit_and_a_millionth_beside_they_do() {
    for integrator in ["rk4", "implicit-euler"] {
        for (name, params, changed) in EFFECTS {
            // Time at rest counts below 1 mm/s only.
            let start = if name == "friction-dwell-time" { (-2.0659, 1e-3) } else { (-2.115, 0.085) };
            let nominal = run_from(vec![], integrator, start);
            assert!(nominal.account.contact_work < 0.0, "the probe touched");
            let with = |beside: f64| {
                let value = |(k, v): &(&'static str, f64)| {
                    let by = if *k == changed { beside * if *v == 0.0 { 1.0 } else { *v } } else { 0.0 };
                    (*k, ParamValue::Number(v + by))
                };
                run_from(vec![effect(name, params.iter().map(value))], integrator, start)
            };
            assert!(same_bits(&nominal, &with(0.0)), "{integrator}: {name} at its neutral parameters");
            assert!(!same_bits(&nominal, &with(1e-6)), "{integrator}: {name}, {changed} a millionth beside neutral");
        }
    }
}

#[test]
fn a_part_in_its_place_changes_no_bit_and_a_micrometre_aside_it_does() {
    let nominal = run(vec![], "rk4");
    for key in ["offset", "angle"] {
        let with = |y: f64| {
            run(vec![effect("contact-geometry-offset", [(key, ParamValue::Numbers(vec![0.0, y, 0.0]))])], "rk4")
        };
        assert!(same_bits(&nominal, &with(0.0)) && !same_bits(&nominal, &with(1e-6)), "{key}");
    }
}

/// Stiff enough, a mount is none; what is left is the tip's own ringing.
#[test]
fn a_mount_changes_nothing_at_infinite_stiffness_and_keeps_momentum() {
    let nominal = run(vec![], "rk4");
    let mount =
        |k: f64| vec![effect("mount-compliance", [("k", ParamValue::Number(k)), ("d", ParamValue::Number(260.0))])];
    assert!(same_bits(&nominal, &run(mount(f64::INFINITY), "rk4")));
    let soft = run(mount(1.6e5), "rk4");
    let total = |s: &State| s.momentum[0] + s.momentum[1];
    let change = total(&soft) - total(&nominal);
    // 450 kg at 85 mm/s is 38 N·s: round-off.
    assert!(change.force.norm() < 1e-11 && change.moment.norm() < 1e-11, "{change:?}");
    assert!((soft.bases[0].translation.vector - nominal.bases[0].translation.vector).norm() > 1e-4);
}

/// A sensor behind a mount reads what reaches it: spring and damper, about its own origin, with or without a touch.
#[test]
fn a_force_sensor_behind_a_mount_reads_spring_and_damper() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/rigs/dock-impact.toml");
    let mut spec = scenario::load(file.as_ref(), &[]).unwrap();
    let params = [("k", ParamValue::Number(1.6e5)), ("d", ParamValue::Number(260.0))];
    spec.effects = vec![effect("mount-compliance", params)];
    let mut mission = scenario::build(&spec).unwrap();
    let model = std::sync::Arc::clone(mission.world.model());
    let gauge = |channel: &str| scenario::measure::Gauge::resolve(&spec, &model, channel).unwrap();
    let (force, torque) = (gauge("sensor.probe.force"), gauge("sensor.probe.torque"));
    assert!(force.reads_contact() && !force.rests_untouched(), "it rings after the touch");
    let state = mission.world.state_mut();
    state.q[..3].copy_from_slice(&[1e-3, -2e-3, 0.0]);
    state.v[..3].copy_from_slice(&[0.1, 0.0, 0.2]);
    mission.world.refresh_touches();
    let vector = |reading| match reading {
        scenario::measure::Reading::Vector(v) => v,
        other => panic!("{other:?}"),
    };
    let expected = Vec3::new(160.0 + 26.0, -320.0, 52.0);
    assert!((vector(force.read(&mission.world)) - expected).norm() < 1e-9);
    // The tip stands 0.3 m ahead of the sensor.
    let arm = Vec3::new(0.3 + 1e-3, -2e-3, 0.0);
    assert!((vector(torque.read(&mission.world)) - arm.cross(&expected)).norm() < 1e-9);
}
