//! A sensor that is wrong on purpose is found with its figures, by kinematics alone; one that is right is left alone.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::type_complexity, missing_docs)]

mod support;

use record::consistency::{Consistency, Estimate};
use record::{Severity, inspect::Inspection};
use spatial::Vec3;
use support::{Gyro, JOINT, TUMBLE, as_is, folder, inspected, joint_csv, joint_rate, remarks, tumble_csv};

/// Standard errors that an estimate may be off by: one in fifteen thousand is farther by chance.
const FAR: f64 = 4.0;

fn tumble(gyro: &Gyro) -> Inspection {
    let runs: Vec<String> = [1, 2].iter().map(|seed| tumble_csv(gyro, *seed, 100, as_is)).collect();
    inspected(&folder(TUMBLE, &[("a.csv", &runs[0]), ("b.csv", &runs[1])]))
}

fn joint(reading: impl Fn(f64) -> f64 + Copy) -> Inspection {
    inspected(&folder(JOINT, &[("a.csv", &joint_csv(3, 12.0, reading)), ("b.csv", &joint_csv(4, 12.0, reading))]))
}

fn only(inspection: &Inspection) -> &Consistency {
    assert_eq!(inspection.consistency.len(), 1);
    &inspection.consistency[0]
}

#[track_caller]
fn assert_near(estimate: Option<Estimate>, truth: f64, surest: f64) {
    let estimate = estimate.unwrap();
    println!("{:.6} ± {:.6} for {truth}", estimate.value, estimate.std_err);
    assert!(estimate.z(truth).abs() < FAR, "{estimate:?} for {truth}");
    assert!(estimate.std_err < surest, "{estimate:?} is not sure enough");
}

#[test]
fn a_right_gyro_and_a_right_tachometer_are_left_alone() {
    for inspection in [tumble(&Gyro::IDEAL), joint(joint_rate)] {
        let found = only(&inspection);
        println!("{}: misfit {:.4}, gain {:.1} of {}", found.rate, found.misfit, found.gain, found.parameters);
        // 6000 innovations: their mean square is sure to √(2/6000) = 1.8 %.
        assert!((found.misfit - 1.0).abs() < 0.08, "{}", found.misfit);
        assert!(found.findings.is_empty(), "{:?}", found.findings);
        assert!(inspection.worst() < Some(Severity::Warning), "{}", remarks(&inspection));
    }
}

#[test]
fn scale_bias_delay_and_angle_of_a_gyro_are_found_together() {
    let gyro = Gyro {
        scale: Vec3::new(1.01, 0.995, 1.0),
        angle: Vec3::new(0.01, -0.004, 0.02),
        bias: Vec3::new(2e-4, -1e-4, 0.0),
        delay: 0.08,
        factor: 1.0,
    };
    let inspection = tumble(&gyro);
    let found = only(&inspection);
    assert!(found.misfit > 1.5 && (found.misfit_fitted - 1.0).abs() < 0.08, "{} {}", found.misfit, found.misfit_fitted);
    // A turned and scaled sensor: off-diagonal terms of second order (1e-4) mix into the diagonal.
    let sensor = spatial::Mat3::from_diagonal(&gyro.scale)
        * *spatial::exp_rotation(&gyro.angle).inverse().to_rotation_matrix().matrix();
    for k in 0..3 {
        assert_near(found.scale[k], sensor[(k, k)], 5e-4);
        assert_near(found.bias[k], gyro.bias[k], 2e-5);
    }
    assert_near(found.delay, 0.08, 5e-3);
    for (angle, truth) in found.angle.unwrap().into_iter().zip(gyro.angle.iter()) {
        assert_near(Some(Estimate { std_err: angle.std_err.hypot(1e-4), ..angle }), *truth, 1e-3);
    }
    assert_eq!(inspection.worst(), Some(Severity::Warning));
}

#[test]
fn a_late_biased_tachometer_is_found() {
    let inspection = joint(|t| 1.02 * joint_rate(t - 0.006) + 0.004);
    let found = only(&inspection);
    assert_near(found.scale[0], 1.02, 5e-4);
    assert_near(found.bias[0], 0.004, 1e-4);
    assert_near(found.delay, 0.006, 2e-4);
    let said = found.findings.join("\n");
    assert!(said.contains("1.02") && said.contains("later") && said.contains("bias"), "{said}");
}

#[test]
fn wrong_units_mirrored_axes_and_clocks_in_ms_are_faults() {
    let cases: [(&str, Inspection, &str); 5] = [
        ("deg/s", tumble(&Gyro { factor: 57.295_779_5, ..Gyro::IDEAL }), "deg/s"),
        ("mirrored z", tumble(&Gyro { scale: Vec3::new(1.0, 1.0, -1.0), ..Gyro::IDEAL }), "the sign of z is reversed"),
        ("reversed joint", joint(|t| -joint_rate(t)), "its sign is reversed"),
        ("mm/s", joint(|t| 1000.0 * joint_rate(t)), "thousandths"),
        ("deg/s joint", joint(|t| joint_rate(t).to_degrees()), "deg/s"),
    ];
    for (name, inspection, wanted) in cases {
        let text = remarks(&inspection);
        assert_eq!(inspection.worst(), Some(Severity::Fault), "{name}: {text}");
        assert!(text.contains(wanted), "{name}: {text}");
    }
    let ms = tumble_csv(&Gyro::IDEAL, 5, 100, as_is);
    let (head, rows) = ms.split_once('\n').unwrap();
    let in_ms = rows.lines().fold(format!("{head}\n"), |text, row| {
        let (t, rest) = row.split_once(',').unwrap();
        text + &format!("{},{rest}\n", t.parse::<f64>().unwrap() * 1000.0)
    });
    let text = remarks(&inspected(&folder(TUMBLE, &[("a.csv", &in_ms)])));
    assert!(text.contains("the time is in ms"), "{text}");
    let mended = inspected(&folder(&format!("{TUMBLE}[time]\nunit = \"ms\"\n"), &[("a.csv", &in_ms)]));
    assert!(only(&mended).findings.is_empty(), "{:?}", only(&mended).findings);
}

#[test]
fn an_inverted_or_reordered_quaternion_is_named() {
    let cases: [(fn(spatial::Rot) -> [f64; 4], &str); 2] =
        [(|q| [q.w, -q.i, -q.j, -q.k], "invert it"), (|q| [q.i, q.j, q.k, q.w], "x, y, z, w")];
    for (write_q, wanted) in cases {
        let run = tumble_csv(&Gyro::IDEAL, 6, 100, write_q);
        let inspection = inspected(&folder(TUMBLE, &[("a.csv", &run)]));
        let text = remarks(&inspection);
        assert!(text.contains(wanted) && inspection.worst() == Some(Severity::Fault), "{text}");
    }
}

#[test]
fn a_joint_at_rest_has_no_scale_and_no_delay() {
    let run = |seed| {
        let moving = joint_csv(seed, 12.0, |_| 0.0);
        moving.lines().enumerate().fold(String::new(), |text, (i, line)| {
            if i == 0 {
                return text + line + "\n";
            }
            let cells: Vec<&str> = line.split(',').collect();
            let t: f64 = cells[0].parse().unwrap();
            let noise = cells[1].parse::<f64>().unwrap() - (0.5 * (1.3 * t).sin() + 0.2 * (3.1 * t).cos());
            text + &format!("{t},{:.6},{}\n", 0.3 + noise, cells[2])
        })
    };
    let inspection = inspected(&folder(JOINT, &[("a.csv", &run(7)), ("b.csv", &run(8))]));
    let found = only(&inspection);
    assert_eq!((found.scale[0], found.delay), (None, None));
    assert!(found.findings.is_empty() && found.bias[0].unwrap().z(0.0).abs() < FAR, "{found:?}");
}

/// The small sets under tests/recordings are what these sensors give; `SOFTDOCK_WRITE=1` writes them anew.
#[test]
fn the_small_sets_are_what_their_generator_makes() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/recordings");
    for (name, factor) in [("tumble", 1.0), ("tumble-in-degrees", 57.295_779_5)] {
        let folder = root.join(name);
        for (file, seed) in [("run-01.csv", 11), ("run-02.csv", 12)] {
            let made = tumble_csv(&Gyro { factor, ..Gyro::IDEAL }, seed, 30, as_is);
            if std::env::var_os("SOFTDOCK_WRITE").is_some() {
                std::fs::create_dir_all(&folder).unwrap();
                let runs = "[[run]]\nfile = \"run-01.csv\"\nrole = \"fit\"\n\n[[run]]\nfile = \"run-02.csv\"\nrole = \"holdout\"\n";
                std::fs::write(folder.join("recording.toml"), format!("{TUMBLE}\n{runs}")).unwrap();
                std::fs::write(folder.join(file), &made).unwrap();
            }
            let kept = std::fs::read_to_string(folder.join(file)).unwrap();
            assert_eq!(kept.lines().count(), made.lines().count());
            for (a, b) in kept.lines().zip(made.lines()).skip(1) {
                // A sine that differs in its last bit may round to the neighbour.
                let near = |(x, y): (&str, &str)| {
                    x == y || (x.parse::<f64>().unwrap() - y.parse::<f64>().unwrap()).abs() < 1.5e-5
                };
                assert!(a.split(',').zip(b.split(',')).all(near), "{a}\n{b}");
            }
        }
    }
}
