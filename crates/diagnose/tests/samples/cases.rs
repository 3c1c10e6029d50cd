//! The four cases.

use super::{Noise, Sample, common, curve, found, heat, located, ranking, whiteness};
use diagnose::diagnosis::{Diagnosis, Found, Role, Verdict};
use diagnose::evidence::{
    Curve, Detection, Discretisation, Evidence, Hypothesis, MissingForce, Parameter, Scatter, ScatterPoint, Status,
};

const RUNS: [(&str, Role); 3] = [("run-01.csv", Role::Fit), ("run-02.csv", Role::Fit), ("run-04.csv", Role::Holdout)];

fn parameter(found: (&str, &str), (name, unit): (&str, &str), (value, std_err, nominal): (f64, f64, f64)) -> Parameter {
    Parameter {
        effect: found.0.to_owned(),
        place: found.1.to_owned(),
        name: name.to_owned(),
        unit: unit.to_owned(),
        value,
        nominal,
        std_err,
        interval: (value - 1.96 * std_err, value + 1.96 * std_err),
        from_profile: name == "k",
    }
}

fn detection(value: f64) -> Option<Detection> {
    let statistic = "largest window score of 420 windows and 14 channels".to_owned();
    Some(Detection { statistic, value, bound: 31.4, false_alarm: 0.01 })
}

fn scatter(across: &str, up: &str, law: impl Fn(f64) -> f64, (low, high, spread): (f64, f64, f64)) -> Scatter {
    let mut noise = Noise::new(5);
    let at = |k: i32, n: i32| low + (high - low) * f64::from(k) / f64::from(n);
    let points =
        (0..160).map(|k| at(k, 159)).map(|x| ScatterPoint { x, y: law(x) + spread * noise.normal(), std_err: spread });
    Scatter {
        place: String::new(),
        across: across.to_owned(),
        up: up.to_owned(),
        points: points.collect(),
        law: Some((String::new(), (0..=80).map(|k| at(k, 80)).map(|x| (x, law(x))).collect())),
        r_squared: 0.97,
    }
}

fn force(
    place: &str,
    (freedom, unit): (&str, &str),
    duration: f64,
    law: impl Fn(f64) -> f64,
    spread: f64,
) -> MissingForce {
    let mut noise = Noise::new(11);
    let t: Vec<f64> = (0..400).map(|k| duration * f64::from(k) / 400.0).collect();
    MissingForce {
        place: place.to_owned(),
        freedom: freedom.to_owned(),
        unit: unit.to_owned(),
        run: "run-01.csv".to_owned(),
        estimate: t.iter().map(|t| law(*t) + spread * noise.normal()).collect(),
        std_err: t.iter().map(|_| spread).collect(),
        law: Some((String::new(), t.iter().map(|t| law(*t)).collect())),
        t,
    }
}

/// What the joint and one that it moves were measured to do.
fn joint_curves() -> Vec<Curve> {
    let mut curves = Vec::new();
    for (k, run) in [(3, RUNS[0]), (3, RUNS[2]), (5, RUNS[0])] {
        let drift = move |t: f64| 0.004 * t.powi(3) * (1.0 + 0.2 * (2.0 * t).sin()) / f64::from(k * k - 8);
        let position = format!("joint.joint_{k}.position");
        let velocity = format!("joint.joint_{k}.velocity");
        curves.push(curve((&position, "rad", 2e-5), run, (12.0, 500.0), |t| 0.6 * (1.1 * t).sin(), drift));
        curves.push(curve(
            (&velocity, "rad/s", 1e-3),
            run,
            (12.0, 500.0),
            |t| 0.66 * (1.1 * t).cos(),
            move |t| 0.3 * drift(t),
        ));
    }
    curves
}

/// What else was thought of at the joint.
fn joint_ranking(place: &str) -> Vec<Hypothesis> {
    ranking(&[
        (
            "joint-viscous-friction",
            place,
            8.31e5,
            0.94,
            8.27e5,
            Status::Chosen,
            "best by the criterion and on held-back segments",
        ),
        (
            "joint-coulomb-friction",
            place,
            7.02e5,
            0.79,
            7.4e5,
            Status::Rejected,
            "leaves a mismatch that grows with speed",
        ),
        ("joint-stribeck-friction", place, 7.9e5, 0.89, 8.27e5, Status::Rival, "its extra parameters gain nothing"),
        ("actuator-gain", place, 3.2e5, 0.36, f64::NAN, Status::Screened, ""),
        ("joint-armature", "joint:joint_5", 4.1e3, 0.004, f64::NAN, Status::Screened, ""),
    ])
}

/// Viscous friction in joint 3 of an arm; two channels of fourteen show most of it.
pub fn joint() -> (Diagnosis, Evidence) {
    let sample = Sample {
        scenario: "arm-bench",
        recording: "arm-bench-0007",
        verdict: Verdict::Explained,
        window_s: 0.5,
        before: (16_508.4, 246.7),
        after: (1.62, 1.006),
    };
    let place = "joint:joint_3";
    let effect = found(
        "joint-viscous-friction",
        place,
        &[("b", 0.901_23, 0.001_12)],
        &[("angular-damping", "body:link_3", 212.0)],
    );
    let mut diagnosis = sample.diagnosis(
        vec![
            located(place, 0.94, (0.0, 12.0), "moving, in proportion to the joint's rate"),
            located("joint:joint_5", 0.11, (0.0, 12.0), "moving"),
        ],
        vec![effect],
    );
    diagnosis.remarks =
        vec!["Nothing restores the vertical joints: free runs diverge under any model, so windows judge.".to_owned()];
    let channels: Vec<String> =
        ["position", "velocity"].iter().flat_map(|q| (1..=7).map(move |k| format!("joint.joint_{k}.{q}"))).collect();
    let names: Vec<&str> = channels.iter().map(String::as_str).collect();
    let size = |k: usize, t: f64| [0.02, 0.5, 900.0, 8.0, 60.0, 0.1, 0.0][k % 7] * (1.0 - (1.3 * t).cos()) * t;
    let mut evidence = Evidence {
        title: "Seven-joint arm, excitation on all joints, 12 s".to_owned(),
        discretisation: Some(Discretisation { step_s: 2e-4, window_s: 0.5, error: 0.013, bound: 0.1 }),
        detection: detection(8.3e5),
        heat: RUNS.map(|run| heat(run, &names, (12.0, 240), size)).to_vec(),
        whiteness: vec![
            whiteness("joint.joint_3.position", 0.01, 0.2),
            whiteness("joint.joint_3.velocity", 0.01, 0.06),
        ],
        ..Evidence::default()
    };
    evidence.curves = joint_curves();
    let mut torque =
        force(place, ("torque about the joint's axis", "N m"), 12.0, |t| -0.9 * 0.66 * (1.1 * t).cos(), 0.03);
    torque.law = torque.law.map(|(_, values)| ("−b q̇, b = 0.901".to_owned(), values));
    evidence.forces = vec![torque];
    let mut against = scatter("joint velocity, rad/s", "missing torque, N m", |v| -0.9 * v, (-0.7, 0.7, 0.03));
    against.place = place.to_owned();
    evidence.scatters = vec![against];
    evidence.ranking = joint_ranking(place);
    evidence.parameters =
        vec![parameter(("joint-viscous-friction", place), ("b", "N m s/rad"), (0.901_23, 0.001_12, 0.0))];
    (diagnosis, common(evidence, ("joint-viscous-friction", place, "b", "N m s/rad", 9e-4)))
}

/// Whether an impact is on, and how far it is through, for forces of a made-up docking.
fn impact(t: f64) -> f64 {
    let through = |from: f64, length: f64| {
        if (from..from + length).contains(&t) { ((t - from) / length * std::f64::consts::PI).sin() } else { 0.0 }
    };
    through(0.45, 0.06) + 0.6 * through(0.9, 0.05) + 0.3 * through(1.6, 0.05)
}

/// Mismatch of channel `k` (the chaser's three, the target's three, force and torque) at an instant.
fn contact_mismatch(k: usize, t: f64) -> f64 {
    match k {
        6 | 7 => 900.0 * impact(t).powi(2),
        _ if t <= 0.46 => 0.0,
        2 => 60.0,
        0 | 1 => 3.0 * (t - 0.4),
        _ => 0.4 * (t - 0.4),
    }
}

/// The effects that were found there.
fn contact_effects(place: &str) -> Vec<Found> {
    let stiffness = found(
        "contact-stiffness",
        place,
        &[("k", 3.604e6, 2.1e4), ("n", 1.5004, 6e-4)],
        &[("mount-compliance", place, 7.4)],
    );
    let mut com = found("body-com", "body:chaser", &[("com", 0.0, 0.0)], &[]);
    let vector = diagnose::diagnosis::ParamValue::Numbers(vec![0.004_02, -0.006_01, 0.002_97]);
    com.params.insert("com".into(), vector);
    com.std_err.insert("com".into(), diagnose::diagnosis::StdErr::each(&[4e-5, 3e-5, 3e-5]));
    vec![stiffness, com]
}

/// What the impact was measured to do.
fn contact_curves() -> Vec<Curve> {
    let mut curves = Vec::new();
    for run in [RUNS[0], RUNS[2]] {
        curves.push(curve(
            ("sensor.probe.force.x", "N", 0.5),
            run,
            (4.0, 2000.0),
            |t| -180.0 * impact(t),
            |t| 22.0 * impact(t + 0.004),
        ));
        curves.push(curve(
            ("body.chaser.angular_velocity.y", "rad/s", 1e-4),
            run,
            (4.0, 250.0),
            |t| if t > 0.48 { 0.011 } else { 0.0004 },
            |t| if t > 0.48 { 8e-4 } else { 0.0 },
        ));
    }
    curves
}

/// What else was thought of.
fn contact_ranking(place: &str) -> Vec<Hypothesis> {
    ranking(&[
        ("contact-stiffness", place, 3.1e6, 0.83, 3.4e6, Status::Chosen, ""),
        (
            "mount-compliance",
            place,
            3.0e6,
            0.81,
            3.39e6,
            Status::Rival,
            "the touches are too short to tell a softer mount from a softer surface",
        ),
        ("body-com", "body:chaser", 2.6e5, 0.21, 2.5e5, Status::Chosen, ""),
        ("friction-coefficient", place, 9.0e4, 0.02, 1.2e2, Status::Rejected, "no gain on held-back runs"),
        ("sensor-scale", "sensor:sensor.probe.force", 7.7e4, 0.02, f64::NAN, Status::Screened, ""),
    ])
}

/// A stiffer contact and a centre of mass that is off.
pub fn contact() -> (Diagnosis, Evidence) {
    let sample = Sample {
        scenario: "dock-impact",
        recording: "dock-impact-0012",
        verdict: Verdict::Explained,
        window_s: 0.5,
        before: (20.98, 16.4),
        after: (1.004, 1.003),
    };
    let place = "contact:probe/drogue";
    let diagnosis = sample.diagnosis(
        vec![
            located(place, 0.83, (0.45, 1.65), "in contact"),
            located("body:chaser", 0.21, (0.45, 4.0), "after the first touch"),
        ],
        contact_effects(place),
    );
    let names = [
        "body.chaser.position",
        "body.chaser.orientation",
        "body.chaser.angular_velocity",
        "body.target.position",
        "body.target.orientation",
        "body.target.angular_velocity",
        "sensor.probe.force",
        "sensor.probe.torque",
    ];
    let mut evidence = Evidence {
        title: "Docking impact, six approaches".to_owned(),
        discretisation: Some(Discretisation { step_s: 5e-5, window_s: 0.5, error: 0.04, bound: 0.1 }),
        detection: detection(2210.0),
        heat: RUNS.map(|run| heat(run, &names, (4.0, 400), contact_mismatch)).to_vec(),
        whiteness: vec![
            whiteness("sensor.probe.force.x", 0.0005, 0.004),
            whiteness("body.chaser.angular_velocity.y", 0.004, 0.08),
        ],
        ..Evidence::default()
    };
    evidence.curves = contact_curves();
    let mut missing = force(place, ("normal force", "N"), 4.0, |t| 22.0 * impact(t), 0.8);
    missing.law = missing.law.map(|(_, values)| ("Δk dⁿ".to_owned(), values));
    evidence.forces = vec![missing];
    let mut against = scatter("depth, m", "missing normal force, N", |d| 6.0e5 * d.powf(1.5), (0.0, 1.1e-3, 0.7));
    against.place = place.to_owned();
    evidence.scatters = vec![against];
    evidence.ranking = contact_ranking(place);
    evidence.parameters = vec![
        parameter(("contact-stiffness", place), ("k", "N/mⁿ"), (3.604e6, 2.1e4, 3.0e6)),
        parameter(("contact-stiffness", place), ("n", ""), (1.5004, 6e-4, 1.5)),
        parameter(("body-com", "body:chaser"), ("com x", "m"), (0.004_02, 4e-5, 0.0)),
        parameter(("body-com", "body:chaser"), ("com y", "m"), (-0.006_01, 3e-5, 0.0)),
    ];
    evidence.correlation = vec![
        vec![1.0, 0.97, 0.1, -0.2],
        vec![0.97, 1.0, 0.12, -0.1],
        vec![0.1, 0.12, 1.0, 0.4],
        vec![-0.2, -0.1, 0.4, 1.0],
    ];
    (diagnosis, common(evidence, ("contact-stiffness", place, "k", "N/mⁿ", 2e4)))
}

/// A free tumble that the scenario predicts.
pub fn null() -> (Diagnosis, Evidence) {
    let sample = Sample {
        scenario: "tumbler",
        recording: "tumbler-0005",
        verdict: Verdict::NoMismatch,
        window_s: 30.0,
        before: (0.998, 0.998),
        after: (0.998, 0.998),
    };
    let names = ["body.target.orientation", "body.target.angular_velocity"];
    let mut evidence = Evidence {
        title: "Target tumble, 300 s, five releases".to_owned(),
        discretisation: Some(Discretisation { step_s: 0.02, window_s: 30.0, error: 4e-6, bound: 0.1 }),
        detection: detection(17.2),
        heat: RUNS.map(|run| heat(run, &names, (300.0, 150), |_, _| 0.0)).to_vec(),
        ..Evidence::default()
    };
    evidence.heat.iter_mut().flat_map(|h| &mut h.rows).for_each(|row| row.corrected.clear());
    let mut gyro = curve(
        ("body.target.angular_velocity.x", "rad/s", 2e-4),
        RUNS[0],
        (300.0, 50.0),
        |t| 0.07 * (0.05 * t).sin(),
        |_| 0.0,
    );
    gyro.corrected.clear();
    evidence.curves = vec![gyro];
    evidence.ranking =
        ranking(&[("body-inertia", "body:target", 7.1, 0.0, f64::NAN, Status::Screened, "below the bound of noise")]);
    (
        sample.diagnosis(Vec::new(), Vec::new()),
        common(evidence, ("body-inertia", "body:target", "inertia zz", "kg m²", 0.02)),
    )
}

/// Wear: friction that grows with the distance slid, which no effect has.
pub fn unknown() -> (Diagnosis, Evidence) {
    let sample = Sample {
        scenario: "stick-slip",
        recording: "stick-slip-0005",
        verdict: Verdict::Unknown,
        window_s: 1.0,
        before: (13.45, 10.2),
        after: (13.45, 10.2),
    };
    let place = "contact:slider/plate";
    let diagnosis = sample
        .diagnosis(vec![located(place, 0.98, (2.1, 20.0), "sliding, growing with the distance slid")], Vec::new());
    let names = ["body.slider.position.x", "body.slider.position.y", "sensor.spring.force.x", "sensor.spring.force.y"];
    let size = |k: usize, t: f64| {
        if t > 2.0 { [60.0, 4.0, 11.0, 1.0][k] * (t - 2.0) * (0.6 + 0.4 * (4.0 * t).sin()) } else { 0.0 }
    };
    let mut evidence = Evidence {
        title: "Slider on a plate, six drives".to_owned(),
        detection: detection(1.8e5),
        heat: RUNS.map(|run| heat(run, &names, (20.0, 200), size)).to_vec(),
        ..Evidence::default()
    };
    evidence.heat.iter_mut().flat_map(|h| &mut h.rows).for_each(|row| row.corrected.clear());
    let mut position = curve(
        ("body.slider.position.x", "m", 5e-6),
        RUNS[0],
        (20.0, 1000.0),
        |t| 0.002 * t + 2e-4 * (5.0 * t).sin(),
        |t| 4e-6 * t * t,
    );
    position.corrected.clear();
    evidence.curves = vec![position];
    let mut missing = force(place, ("friction along the slip", "N"), 20.0, |t| -0.11 * t, 0.09);
    missing.law = None;
    evidence.forces = vec![missing];
    let mut against =
        scatter("distance slid, m", "missing friction over normal force", |s| 1.62 * 0.24 * s, (0.0, 0.09, 2e-3));
    against.place = place.to_owned();
    against.law = against.law.map(|(_, points)| ("growth 1.62 /m × μ".to_owned(), points));
    against.r_squared = 0.86;
    evidence.scatters = vec![against];
    evidence.ranking = ranking(&[
        (
            "friction-dwell-time",
            place,
            1.2e5,
            0.65,
            1.1e5,
            Status::Rejected,
            "held-back runs stay at 9.4 times the noise",
        ),
        (
            "friction-coefficient",
            place,
            1.0e5,
            0.58,
            9.6e4,
            Status::Rejected,
            "held-back runs stay at 9.9 times the noise",
        ),
    ]);
    (diagnosis, common(evidence, ("friction-coefficient", place, "mu", "", 1e-4)))
}
