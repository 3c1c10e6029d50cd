//! Made-up diagnoses for each rule, right and wrong.
#![allow(clippy::unwrap_used)]

use super::*;
use serde_json::{Value, json};

fn key(value: Value) -> Key {
    let mut value = value;
    value["oracle"] = json!({ "true": 1.002, "nominal": 50.0 });
    serde_json::from_value(value).unwrap()
}

fn diagnosis(verdict: &str, effects: Value) -> Diagnosis {
    let error = json!({ "before": 50.0, "after": 1.003 });
    serde_json::from_value(json!({
        "verdict": verdict, "located": [], "effects": effects,
        "error": { "fit": error, "holdout": error, "window_s": 30.0, "windowed": error, "runs": [] }
    }))
    .unwrap()
}

fn found(name: &str, place: &str, params: Value, std_err: Value) -> Value {
    json!({ "name": name, "place": place, "params": params, "std_err": std_err, "rivals": [] })
}

fn effect(name: &str, place: &str, params: Value) -> Value {
    json!({ "name": name, "place": place, "params": params })
}

/// Whether the parameters of one effect are right.
fn judged(name: &str, truth: Value, params: Value, std_err: Value) -> bool {
    let key = key(json!({ "effects": [effect(name, "body:target", truth)] }));
    let score = score_set("x", &diagnosis("explained", json!([found(name, "body:target", params, std_err)])), &key);
    assert_eq!(score.name, Some(true));
    score.parameters.unwrap()
}

#[test]
fn the_right_effect_at_the_right_place_is_right_in_everything() {
    let key = key(json!({ "effects": [effect("angular-damping", "body:target", json!({ "c": 0.012 }))] }));
    let given = found("angular-damping", "body:orbiter/target", json!({ "c": 0.01201 }), json!({ "c": 3e-6 }));
    let score = score_set("tumbler", &diagnosis("explained", json!([given])), &key);
    assert!(score.all() && score.notes.is_empty(), "{score:?}");
    assert_eq!((score.name, score.both, score.parameters, score.holdout), (Some(true), None, Some(true), Some(true)));
}

#[test]
fn a_wrong_name_a_wrong_place_and_an_effect_too_many_are_wrong() {
    let key = key(json!({ "effects": [effect("angular-damping", "body:target", json!({ "c": 0.012 }))] }));
    let right = found("angular-damping", "body:target", json!({ "c": 0.012 }), json!({}));
    let elsewhere = found("angular-damping", "body:chaser", json!({ "c": 0.012 }), json!({}));
    let other = found("slosh", "body:target", json!({ "mass": 3.0 }), json!({}));
    for effects in [json!([elsewhere]), json!([other]), json!([right, other]), json!([other, right]), json!([])] {
        let score = score_set("x", &diagnosis("explained", effects.clone()), &key);
        assert_eq!(score.name, Some(false), "{effects}");
        assert!(!score.all() && !score.notes.is_empty());
    }
}

#[test]
fn an_accepted_alternative_counts_and_its_number_is_compared() {
    let key = key(json!({
        "effects": [effect("friction-viscous", "contact:slider/plate", json!({ "b": 14 }))],
        "accept": [{ "for": "friction-viscous", "name": "linear-drag", "place": "body:slider" }]
    }));
    let drag = |c: f64| json!([found("linear-drag", "body:slider", json!({ "c": c }), json!({ "c": 0.1 }))]);
    assert!(score_set("x", &diagnosis("explained", drag(14.5)), &key).all());
    let wrong = score_set("x", &diagnosis("explained", drag(17.0)), &key);
    assert_eq!((wrong.name, wrong.parameters), (Some(true), Some(false)));
}

#[test]
fn of_two_effects_one_is_a_right_name_and_not_both() {
    let both = [
        effect("tilt", "world", json!({ "vector": [4e-4, -2.5e-4, 0] })),
        effect("friction-coefficient", "contact:probe/drogue", json!({ "mu": 0.28 })),
    ];
    let key = key(json!({ "effects": both }));
    let tilt = found("tilt", "world", json!({ "vector": [4.1e-4, -2.5e-4, 0.0] }), json!({}));
    let mu = found("friction-coefficient", "contact:chaser.probe/target.drogue", json!({ "mu": 0.281 }), json!({}));
    assert!(score_set("x", &diagnosis("explained", json!([mu, tilt])), &key).all());
    let one = score_set("x", &diagnosis("partly-explained", json!([tilt])), &key);
    assert_eq!((one.verdict, one.name, one.both, one.parameters), (false, Some(true), Some(false), Some(true)));
    assert!(one.notes.iter().any(|n| n.contains("friction-coefficient at contact:probe/drogue not found")));
}

#[test]
fn corrections_are_excused_only_where_the_card_is_wrong() {
    let correction = found("body-mass", "body:target", json!({ "mass": 452.0 }), json!({ "mass": 0.1 }));
    let gain = |gain: f64| found("actuator-gain", "actuator:wheel", json!({ "gain": gain }), json!({}));
    let excused = key(json!({ "effects": [], "nominal_errors": { "mass of target": 1.004 } }));
    let strict = key(json!({ "effects": [] }));
    let explained = diagnosis("explained", json!([correction, gain(1.01)]));
    assert!(score_set("x", &explained, &excused).all());
    assert!(!score_set("x", &explained, &strict).verdict);
    assert!(!score_set("x", &diagnosis("explained", json!([gain(1.2)])), &excused).verdict, "no small gain");
    let exotic = found("slosh", "body:target", json!({ "mass": 3.0 }), json!({}));
    assert!(!score_set("x", &diagnosis("explained", json!([correction, exotic])), &excused).verdict);
    assert!(score_set("x", &diagnosis("no-mismatch", json!([])), &excused).all());
    let mu = found("friction-coefficient", "contact:a/b", json!({ "mu": 0.1 }), json!({}));
    assert!(!score_set("x", &diagnosis("explained", json!([mu])), &excused).verdict, "masses excuse no friction");
    let contact = key(json!({ "effects": [], "nominal_errors": { "contact stiffness": 1.01 } }));
    assert!(score_set("x", &diagnosis("explained", json!([mu])), &contact).verdict);
}

#[test]
fn a_correction_that_stands_first_does_not_take_the_first_rank() {
    let payload = effect("joint-viscous-friction", "joint:joint_3", json!({ "b": 0.9 }));
    let key = key(json!({ "effects": [payload], "nominal_errors": { "link mass scale": [1.002] } }));
    let correction = found("body-mass", "body:link_2", json!({ "mass": 3.01 }), json!({}));
    let friction = found("joint-viscous-friction", "joint:arm/joint_3", json!({ "b": 0.91 }), json!({}));
    assert!(score_set("x", &diagnosis("explained", json!([correction, friction])), &key).all());
}

#[test]
fn an_unknown_is_judged_by_verdict_and_first_place() {
    let key = key(json!({ "effects": [{ "name": "unknown", "place": "contact:slider/plate", "kind": "wear" }] }));
    let mut given = diagnosis("unknown", json!([]));
    let at = |place: &str| diagnose::diagnosis::Located {
        place: place.to_owned(),
        share: 0.9,
        from_s: 0.0,
        to_s: 20.0,
        condition: "grows with the distance slid".to_owned(),
    };
    given.located = vec![at("contact:slider/plate"), at("body:slider")];
    let score = score_set("x", &given, &key);
    assert!(score.all() && score.holdout.is_none() && score.name.is_none(), "{score:?}");
    assert!(score.notes[0].contains("distance slid") && score.notes[0].contains("wear"));
    given.located.reverse();
    assert_eq!(score_set("x", &given, &key).located, Some(false));
    given.located.clear();
    assert_eq!(score_set("x", &given, &key).located, Some(false));
    given.verdict = Verdict::PartlyExplained;
    assert!(!score_set("x", &given, &key).verdict);
}

#[test]
fn holdout_is_free_run_and_in_windows_where_only_these_are_predictable_and_tell() {
    let damping = json!({ "effects": [effect("angular-damping", "body:target", json!({ "c": 0.012 }))] });
    let given = found("angular-damping", "body:target", json!({ "c": 0.012 }), json!({}));
    let mut diagnosis = diagnosis("explained", json!([given]));
    diagnosis.error.holdout.as_mut().unwrap().after = 1.6;
    assert_eq!(score_set("x", &diagnosis, &key(damping.clone())).holdout, Some(false));
    let mut told = key(damping);
    told.oracle.nominal_windowed = 500.0;
    assert_eq!(score_set("x", &diagnosis, &told).holdout, Some(false), "free runs are predictable");
    diagnosis.error.holdout.as_mut().unwrap().after = 60.0;
    assert_eq!(score_set("x", &diagnosis, &told).holdout, Some(true));
    diagnosis.error.windowed.after = f64::NAN;
    assert_eq!(score_set("x", &diagnosis, &told).holdout, Some(false), "diverged is not good");
    // Windows in which the nominal model is nearly right excuse nothing.
    diagnosis.error.windowed.after = 1.0;
    told.oracle.nominal_windowed = 1.2;
    assert_eq!(score_set("x", &diagnosis, &told).holdout, Some(false));
}

#[test]
fn a_number_is_right_within_a_tenth_or_two_standard_errors() {
    let right =
        |value: f64, error: Value| judged("angular-damping", json!({ "c": 0.012 }), json!({ "c": value }), error);
    assert!(right(0.0131, json!({ "c": 1e-6 })) && !right(0.0135, json!({ "c": 1e-6 })));
    assert!(right(0.0135, json!({ "c": 8e-4 })) && !right(0.0135, json!({ "c": null })));
    assert!(!judged("angular-damping", json!({ "c": 0.012 }), json!({}), json!({})), "not given is not right");
}

#[test]
fn a_zero_entry_is_compared_with_the_norm_or_its_error() {
    let right = |x: f64, z: f64, error: f64| {
        let params = json!({ "vector": [x, -2.5e-4, z] });
        judged("tilt", json!({ "vector": [4e-4, -2.5e-4, 0] }), params, json!({ "vector": [1e-6, 1e-6, error] }))
    };
    assert!(right(4.1e-4, 4.6e-5, 0.0) && !right(4.1e-4, 5e-5, 0.0) && right(4.1e-4, 5e-5, 2.6e-5));
    assert!(!right(4.5e-4, 0.0, 0.0));
}

#[test]
fn a_free_body_is_compared_at_the_ixx_that_was_held() {
    let truth = [
        effect("body-inertia", "body:target", json!({ "inertia": [95.9, 158.8, 215.5, 0, 2.4, 0] })),
        effect("constant-torque", "body:target", json!({ "vector": [2e-4, -4e-4, 1e-4], "frame": "body" })),
    ];
    let key = key(json!({ "effects": truth }));
    let g = 80.0 / 95.9; // a card that is far off shows what the scale does
    let inertia = json!([80.0, 158.8 * g, 215.5 * g, 0.0, 2.4 * g, 0.0]);
    let torque = json!({ "vector": [2e-4 * g, -4e-4 * g, 1e-4 * g], "frame": "body" });
    let given = |error: Value, torque: &Value| {
        let inertia = found("body-inertia", "body:target", json!({ "inertia": inertia }), error);
        let effects = json!([inertia, found("constant-torque", "body:target", torque.clone(), json!({}))]);
        score_set("x", &diagnosis("explained", effects), &key).parameters
    };
    let held = json!({ "inertia": [null, 0.1, 0.1, 0.01, 0.01, 0.01] });
    assert_eq!(given(held.clone(), &torque), Some(true));
    let fitted = json!({ "inertia": [0.1, 0.1, 0.1, 0.01, 0.01, 0.01] });
    assert_eq!(given(fitted, &torque), Some(false), "where Ixx was fitted there is no such freedom");
    let unscaled = json!({ "vector": [2e-4, -4e-4, 1e-4], "frame": "body" });
    assert_eq!(given(held.clone(), &unscaled), Some(false));
    let mut other_frame = torque;
    other_frame["frame"] = json!("world");
    assert_eq!(given(held, &other_frame), Some(false));
}

#[test]
fn slosh_is_compared_by_its_moment() {
    let truth = json!({ "mass": 14, "frequency": 0.11, "damping": 0.02, "position": [0.25, 0.15, 0.45] });
    let right = |mass: f64, f: f64, position: [f64; 3]| {
        let params = json!({ "mass": mass, "frequency": f, "damping": 0.0205, "position": position });
        judged("slosh", truth.clone(), params, json!({}))
    };
    assert!(right(56.0, 0.11, [-0.125, -0.075, -0.225]), "four times the mass at half the distance");
    assert!(!right(14.0, 0.11, [0.25, 0.15, 0.55]) && !right(14.0, 0.13, [0.25, 0.15, 0.45]));
}

#[test]
fn axes_of_anisotropy_may_be_exchanged() {
    let truth = json!({ "mu_1": 0.30, "mu_2": 0.20, "angle": 0.5 });
    let right = |mu_1: f64, mu_2: f64, angle: f64| {
        let params = json!({ "mu_1": mu_1, "mu_2": mu_2, "angle": angle });
        judged("friction-anisotropy", truth.clone(), params, json!({}))
    };
    let half = std::f64::consts::FRAC_PI_2;
    assert!(right(0.30, 0.20, 0.5 - 2.0 * half) && right(0.20, 0.30, 0.5 + half) && right(0.20, 0.30, 0.5 - half));
    assert!(!right(0.20, 0.30, 0.5) && !right(0.30, 0.20, 0.7));
}

#[test]
fn levels_with_speed_are_right_where_their_curve_is() {
    let right = |c: f64, s: f64, v_s: f64| {
        let params = json!({ "c": c, "s": s, "v_s": v_s });
        judged("joint-stribeck-friction", json!({ "c": 0.7, "s": 1.0, "v_s": 0.08 }), params, json!({}))
    };
    assert!(right(0.71, 1.02, 0.082));
    assert!(right(0.7, 1.0, 0.09), "the curve is within a tenth of the rise although v_s is not within a tenth");
    assert!(!right(0.7, 1.0, 0.16) && !right(0.7, 0.75, 0.08), "sliding friction alone");
}

#[test]
fn phases_turn_and_couplings_have_no_sign() {
    let truth = json!({ "amplitude": 0.5, "frequency": 2.0, "phase": 0.2 });
    let right = |a: f64, phase: f64| {
        judged(
            "periodic-disturbance",
            truth.clone(),
            json!({ "amplitude": a, "frequency": 2.0, "phase": phase }),
            json!({}),
        )
    };
    let tau = std::f64::consts::TAU;
    assert!(right(0.5, 0.25 - tau) && right(-0.5, 0.2 + 0.5 * tau) && !right(-0.5, 0.2) && !right(0.5, 0.4));
    let coupling = |v: [f64; 3]| {
        judged("flexible-appendage", json!({ "coupling": [1.0, 2.0, 0.0] }), json!({ "coupling": v }), json!({}))
    };
    assert!(coupling([-1.0, -2.0, 0.1]) && !coupling([1.0, -2.0, 0.0]));
}

#[test]
fn a_folder_is_judged_set_by_set_and_what_is_missing_is_wrong() {
    let dir = tempfile::tempdir().unwrap();
    let (keys, diagnoses) = (dir.path().join("keys"), dir.path().join("out"));
    std::fs::create_dir_all(&keys).unwrap();
    std::fs::create_dir_all(diagnoses.join("a")).unwrap();
    let null = json!({ "effects": [], "oracle": { "true": 1.0 } });
    for set in ["a", "b", "c", "d"] {
        std::fs::write(keys.join(format!("{set}.json")), null.to_string()).unwrap();
    }
    let good = diagnosis("no-mismatch", json!([])).to_json().unwrap();
    std::fs::write(diagnoses.join("a/diagnosis.json"), &good).unwrap();
    std::fs::write(diagnoses.join("b.json"), &good).unwrap();
    std::fs::write(diagnoses.join("c.json"), "{}").unwrap();
    let table = score_folders(&diagnoses, &keys, false).unwrap();
    assert_eq!(table.sets.iter().map(SetScore::all).collect::<Vec<_>>(), [true, true, false, false]);
    let criterion = &table.criteria()[0];
    assert_eq!((criterion.right, criterion.of, criterion.holds(), table.holds()), (2, 4, false, false));
    assert_eq!(score_folders(&diagnoses, &keys, true).unwrap().sets.len(), 3);
    let (text, markdown) = (table.text(), table.markdown());
    assert!(text.contains("NOT MET  2 of 4 verdict on the nulls") && text.contains("d: no diagnosis"), "{text}");
    assert!(markdown.contains("| a | no-mismatch |  |  |  | 1.003 |  | yes |"), "{markdown}");
    assert_eq!(table.json()["criteria"][0]["right"], 2);
    assert!(score_folders(&diagnoses, &diagnoses.join("nowhere"), false).is_err());
    assert!(score_folders(&diagnoses, &diagnoses.join("a").join(".."), false).is_err(), "a diagnosis is no key");
}

#[test]
fn shares_are_counted_as_asked() {
    let share = |right, of, needed| Criterion { text: "", right, of, needed }.holds();
    assert!(share(9, 10, 0.9) && !share(8, 10, 0.9) && share(0, 0, 1.0) && share(7, 10, 0.7) && !share(2, 3, 0.7));
}
