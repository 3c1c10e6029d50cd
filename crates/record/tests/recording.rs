//! Recordings are read as rigs write them; what is odd is handled and said, what is wrong is a sentence with a way out.
#![allow(clippy::unwrap_used, missing_docs)]

mod support;

use proptest::prelude::*;
use record::{Channel, ChannelSpec, Meta, Plot, RecordingSet, Role, Series, Severity, Signals};
use std::fs;
use support::{Gyro, JOINT, Noise, TUMBLE, as_is, error, exact, folder, joint_csv, joint_rate, load, tumble_csv};

const HEAD: &str = "format = 1\nrig = \"arm\"\n";
const FIT: &str = "[[run]]\nfile = \"a.csv\"\nrole = \"fit\"\n";

fn one(csv: &str) -> tempfile::TempDir {
    folder(HEAD, &[("a.csv", csv)])
}

fn said(set: &RecordingSet) -> String {
    set.remarks.iter().map(|remark| format!("{remark}\n")).collect()
}

#[test]
fn channels_of_several_rates_come_apart() {
    let csv = "t,joint.b.position,joint.a.position\n0,1,10\n0.5,,11\n1,2,12\n1.5,,\n2,3,14\n";
    let set = load(one(csv).path());
    let run = &set.runs[0];
    assert_eq!((run.file.as_str(), run.role), ("a.csv", Role::Fit));
    let names: Vec<&str> = run.series.iter().map(|s| s.channel.as_str()).collect();
    assert_eq!(names, ["joint.a.position", "joint.b.position"], "sorted");
    let b = run.series("joint.b.position").unwrap();
    assert_eq!((&b.times[..], b.values.as_slice()), (&[0.0, 1.0, 2.0][..], &[1.0, 2.0, 3.0][..]));
    assert_eq!(run.series("joint.a.position").unwrap().times[..], [0.0, 0.5, 1.0, 2.0]);
    assert_eq!(run.duration(), 2.0);
    assert!(run.series("joint.c.position").is_none());
}

#[test]
fn parquet_and_csv_give_the_same_set() {
    let csv = joint_csv(1, 2.0, joint_rate);
    let from_csv = load(folder(JOINT, &[("a.csv", &csv)]).path());
    let series = &from_csv.runs[0].series;
    let channel =
        |s: &Series| Channel { spec: ChannelSpec::new(&s.channel, "", Plot::Joints), values: s.values.clone() };
    let signals = Signals { times: series[0].times.to_vec(), channels: series.iter().map(channel).collect() };
    let bytes = record::encode_parquet(&Meta::default(), &signals).unwrap();
    let from_parquet = load(
        exact(&format!("{JOINT}[[run]]\nfile = \"a.parquet\"\nrole = \"fit\"\n"), &[("a.parquet", &bytes)]).path(),
    );
    assert_eq!(&from_parquet.runs[0].series, series);
}

#[test]
fn foreign_columns_are_mapped_scaled_and_converted() {
    let toml = format!(
        "{HEAD}[time]\ncolumn = \"t_ms\"\nunit = \"ms\"\n[channels]\n\
         \"joint.slide.position\" = {{ column = \"x\", unit = \"mm\" }}\n\
         \"joint.slide.effort_command\" = {{ column = \"control_V\", scale = 35.15065188 }}\n\
         \"body.cube.angular_velocity.x\" = {{ column = \"wx\", unit = \"deg/s\", scale = -1 }}\n{FIT}"
    );
    let csv = "t_ms;x;control_V;wx;comment\n0;12.5;2.0;180.0;start\n10;12.7;;90.0;\"a; b\"\n20;12.9;1.0;45.0;end\n";
    let set = load(exact(&toml, &[("a.csv", csv.as_bytes())]).path());
    let run = &set.runs[0];
    let x = run.series("joint.slide.position").unwrap();
    assert_eq!(x.times[..], [0.0, 0.01, 0.02]);
    assert!((x.values[1] - 0.0127).abs() < 1e-15 && (x.quantum() - 1e-4).abs() < 1e-15, "{x:?}");
    assert_eq!(run.series("joint.slide.effort_command").unwrap().values, [2.0 * 35.15065188, 35.15065188]);
    assert_eq!(run.series("body.cube.angular_velocity.x").unwrap().values[0], -std::f64::consts::PI);
    assert!(said(&set).contains("comment"), "{}", said(&set));
}

#[test]
fn groups_become_runs_with_roles_of_their_own() {
    let toml = format!(
        "{HEAD}[time]\ngroup = \"toss\"\n{FIT}groups = [\"0-1\"]\nnote = \"first\"\n\
         [[run]]\nfile = \"a.csv\"\nrole = \"holdout\"\ngroups = [7]\n"
    );
    let csv = "toss,t,joint.a.position\n0,0,1\n0,1,2\n1,5,3\n1,6,4\n7,0,5\n7,1,6\n8,0,7\n8,1,8\n";
    let set = load(exact(&toml, &[("a.csv", csv.as_bytes())]).path());
    let runs: Vec<_> = set.runs.iter().map(|r| (r.file.as_str(), r.role, &r.series[0].times[..])).collect();
    assert_eq!(
        runs,
        [
            ("a.csv#toss=0", Role::Fit, &[0.0, 1.0][..]),
            ("a.csv#toss=1", Role::Fit, &[0.0, 1.0][..]), // from 5 s of the file on
            ("a.csv#toss=7", Role::Holdout, &[0.0, 1.0][..]),
        ]
    );
    assert!(said(&set).contains("1 groups that no [[run]] chooses are not read: 8"), "{}", said(&set));
    let both = format!("{HEAD}[time]\ngroup = \"toss\"\n{FIT}{}", FIT.replace("fit", "holdout"));
    assert!(error(exact(&both, &[("a.csv", csv.as_bytes())]).path()).contains("two [[run]] claim a.csv#toss=0"));
}

#[test]
fn a_long_file_is_cut_into_runs_by_its_clock() {
    let second = "[[run]]\nfile = \"a.csv\"\nrole = \"holdout\"\nfrom_s = 4\n";
    let csv = "t,joint.a.position\n0,1\n1,2\n2,3\n3,4\n4,5\n5,6\n";
    let at = |toml: &str| exact(toml, &[("a.csv", csv.as_bytes())]);
    let set = load(at(&format!("{HEAD}{FIT}from_s = 1.0\nto_s = 3.5\n{second}")).path());
    let runs: Vec<_> = set.runs.iter().map(|r| (&*r.file, r.role, &*r.series[0].times, &*r.series[0].values)).collect();
    assert_eq!(
        runs,
        [
            ("a.csv#1-3s", Role::Fit, &[0.0, 1.0, 2.0][..], &[2.0, 3.0, 4.0][..]),
            ("a.csv#4-5s", Role::Holdout, &[0.0, 1.0][..], &[5.0, 6.0][..]),
        ]
    );
    for (toml, what) in [
        (format!("{HEAD}{FIT}to_s = 4.5\n{second}"), "a second time"),
        (format!("{HEAD}{FIT}from_s = 9\n"), "no row from 9 to inf s; it goes from 0 to 5 s"),
        (format!("{HEAD}{FIT}from_s = 2\nto_s = 2\n"), "it ends, to_s = 2, before it begins, from_s = 2"),
        (format!("{HEAD}{FIT}from_s = \"late\"\n"), "from_s = \"late\" is not a time"),
    ] {
        let said = error(at(&toml).path());
        assert!(said.contains(what), "{said}");
    }
}

#[test]
fn a_group_is_cut_by_the_clock_too() {
    let csv = "toss,t,joint.a.position\n0,0,1\n0,1,2\n0,2,3\n1,0,4\n1,1,5\n1,2,6\n1,3,7\n";
    let head = format!("{HEAD}[time]\ngroup = \"toss\"\n");
    let run = |role: &str, rest: &str| format!("{}{rest}\n", FIT.replace("fit", role));
    let at = |toml: String| exact(&toml, &[("a.csv", csv.as_bytes())]);
    let set = load(at(format!("{head}{}", run("fit", "groups = [\"0-1\"]\nfrom_s = 1"))).path());
    let runs: Vec<_> = set.runs.iter().map(|r| (&*r.file, &*r.series[0].times, &*r.series[0].values)).collect();
    assert_eq!(
        runs,
        [
            ("a.csv#toss=0", &[0.0, 1.0][..], &[2.0, 3.0][..]),
            ("a.csv#toss=1", &[0.0, 1.0, 2.0][..], &[5.0, 6.0, 7.0][..])
        ]
    );
    // One group may be two runs.
    let two = [run("fit", "groups = [1]\nto_s = 2"), run("holdout", "groups = [1]\nfrom_s = 2")].concat();
    let set = load(at(format!("{head}{two}")).path());
    let names: Vec<&str> = set.runs.iter().map(|r| &*r.file).collect();
    assert_eq!(names, ["a.csv#toss=1#0-1s", "a.csv#toss=1#2-3s"]);
    let said = error(at(format!("{head}{}", run("fit", "from_s = 3"))).path());
    assert!(said.contains("a.csv#toss=0: no row from 3 to inf s; it goes from 0 to 2 s"), "{said}");
}

#[test]
fn repeated_times_are_averaged_and_commands_hold_the_last() {
    let csv = "t,joint.a.position,joint.a.effort_command\n0,1,5\n1,2,6\n1,4,7\n1,9,\n2,3,8\n";
    let set = load(one(csv).path());
    assert_eq!(set.runs[0].series("joint.a.position").unwrap().values, [1.0, 5.0, 3.0]);
    assert_eq!(set.runs[0].series("joint.a.effort_command").unwrap().values, [5.0, 7.0, 8.0]);
    assert!(said(&set).contains("2 rows repeat the time of the row before; 3 samples were merged"), "{}", said(&set));
}

#[test]
fn a_row_out_of_order_is_sorted_and_time_that_starts_again_is_an_error() {
    let row = |t: usize| format!("{},{t}\n", t as f64 * 0.01);
    let mut order: Vec<usize> = (0..200).collect();
    order.swap(50, 51);
    let text = |order: &[usize]| order.iter().fold("t,joint.a.position\n".to_owned(), |text, t| text + &row(*t));
    let set = load(one(&text(&order)).path());
    assert!(set.runs[0].series[0].times.windows(2).all(|t| t[0] < t[1]));
    assert_eq!(set.runs[0].series[0].values[50], 50.0);
    assert!(said(&set).contains("1 rows stood out of order"), "{}", said(&set));
    let twice: Vec<usize> = (0..200).chain(0..200).collect();
    let message = error(one(&text(&twice)).path());
    assert!(
        message.contains("a.csv:202: time goes back from 1.99 s to 0 s") && message.contains("[time] group"),
        "{message}"
    );
}

#[test]
fn quaternions_come_out_unit_and_without_flips() {
    let run = tumble_csv(&Gyro::IDEAL, 1, 20, as_is);
    let set = load(folder(TUMBLE, &[("a.csv", &run)]).path());
    let q = ["w", "x", "y", "z"].map(|c| set.runs[0].series(&format!("body.target.orientation.{c}")).unwrap());
    for k in 0..q[0].len() {
        let norm: f64 = q.iter().map(|s| s.values[k].powi(2)).sum();
        assert!((norm - 1.0).abs() < 1e-14);
        let along: f64 = q.iter().map(|s| s.values[k] * s.values[k.saturating_sub(1)]).sum();
        assert!(along > 0.9, "a flip is left at {k}");
    }
    assert_eq!(q[0].quantum(), 1e-5, "the written rounding survives the normalisation");
    assert!(said(&set).contains("sign flips"));
    let doubled = tumble_csv(&Gyro::IDEAL, 1, 20, |q| as_is(q).map(|x| 2.0 * x));
    let set = load(folder(TUMBLE, &[("a.csv", &doubled)]).path());
    assert!(set.remarks.iter().any(|r| r.severity == Severity::Fault && r.what.contains("not unit")), "{}", said(&set));
}

#[test]
fn cells_that_are_not_finite_are_missing_and_a_last_row_without_an_end_is_left_out() {
    let set = load(one("t,joint.a.position\n0,1\n1,nan\n2,inf\n3,NA\n4,5\n5,6.7").path());
    assert_eq!(set.runs[0].series[0].values, [1.0, 5.0]);
    let said = said(&set);
    assert!(
        said.contains("3 cells are not finite and count as missing") && said.contains("line 7, the last"),
        "{said}"
    );
}

#[test]
fn noise_is_that_of_the_longest_prefix() {
    let noise =
        "[noise]\n\"body.a\" = 1.0\n\"body.a.position\" = 2.0\n\"body.a.position.x\" = 3\n\"body.a.pos\" = 9.0\n";
    let csv = "t,body.a.position.x,body.a.position.y\n0,1,2\n1,1,2\n";
    let set = load(folder(&format!("{HEAD}{noise}"), &[("a.csv", csv)]).path());
    assert_eq!(set.sigma("body.a.position.x"), Some(3.0));
    assert_eq!(set.sigma("body.a.position.y"), Some(2.0));
    assert_eq!(set.sigma("body.a.angular_velocity.y"), Some(1.0));
    assert_eq!(set.sigma("body.ab.position.y"), None);
    assert!(said(&set).contains("body.a.pos: [noise] names a channel that no run has"), "{}", said(&set));
}

#[test]
fn rounding_is_found_in_decimals_and_encoder_steps() {
    let mut noise = Noise::new(1);
    let truth: Vec<f64> = (0..2000).map(|i| 0.02 * (f64::from(i) * 0.003).sin() + 2e-5 * noise.normal()).collect();
    let of = |round: &dyn Fn(f64) -> f64| {
        Series::new(
            "joint.a.position",
            (0..2000).map(f64::from).collect::<Vec<_>>(),
            truth.iter().map(|v| round(*v)).collect(),
        )
        .quantum()
    };
    let decimals = |v: f64, k: i32| format!("{v:.*}", k as usize).parse::<f64>().unwrap();
    assert_eq!(of(&|v| v), 0.0, "continuous");
    for k in [2, 4, 6] {
        assert_eq!(of(&|v| decimals(v, k)), 10_f64.powi(-k));
    }
    let step = std::f64::consts::TAU / f64::from(1 << 21);
    let bare = of(&|v| (v / step).round() * step);
    assert!((bare / step - 1.0).abs() < 1e-3, "{bare} for {step}");
    let written = of(&|v| decimals((v / step).round() * step, 6));
    assert!((written / step.hypot(1e-6) - 1.0).abs() < 0.02, "{written} for {step} and 1e-6");
}

#[test]
fn errors_name_the_file_the_place_and_the_way_out() {
    let good = "t,joint.a.position\n0,1\n1,2\n";
    let with = |toml: &str| exact(toml, &[("a.csv", good.as_bytes()), ("run-01.csv", good.as_bytes())]);
    let channels = |line: &str| format!("{HEAD}[channels]\n{line}\n{FIT}");
    let manifests: [(String, &[&str]); 15] = [
        (
            format!("{HEAD}{}", FIT.replace("a.csv", "run-1.csv")),
            &["recording.toml", "run-1.csv", "did you mean \"run-01.csv\"?"],
        ),
        (
            format!("{HEAD}{}", FIT.replace("fit", "fitt")),
            &["recording.toml:5", "role = \"fitt\"", "did you mean \"fit\"?"],
        ),
        (
            format!("{HEAD}{}", FIT.replace("role", "rolle")),
            &["recording.toml:5", "unknown key", "did you mean \"role\"?"],
        ),
        (format!("{HEAD}[[run]]\nfile = \"a.csv\"\n"), &["has no role", "\"fit\" or \"holdout\""]),
        (
            format!("{HEAD}titel = \"x\"\n{FIT}"),
            &["recording.toml:3", "unknown key `titel`", "did you mean \"title\"?"],
        ),
        (format!("format = 2\nrig = \"arm\"\n{FIT}"), &["format = 2 is not known"]),
        (format!("rig = \"arm\"\n{FIT}"), &["has no format", "`format = 1`"]),
        (format!("format = 1\n{FIT}"), &["has no rig"]),
        (HEAD.to_owned(), &["names no run", "[[run]]"]),
        (format!("{HEAD}{FIT}{FIT}"), &["[[run]] 2 names \"a.csv\" a second time"]),
        (format!("{HEAD}[noise]\n\"joint.a.position\" = -1\n{FIT}"), &["recording.toml:4", "not a standard deviation"]),
        (
            channels("\"joint.a.velocity\" = { column = \"x\", unit = \"deg/min\" }"),
            &["\"deg/min\" is not known", "rpm", "give scale"],
        ),
        (channels("\"joint.a.velocity\" = { column = \"x\", unit = \"mm\" }"), &["does not fit here", "deg/s", "mm/s"]),
        (
            channels("\"joint.a.speed\" = { column = \"x\" }"),
            &["no channel of the recording format", "joint.<joint>.velocity"],
        ),
        (
            channels("\"joint.a.velocity\" = { column = \"joint.a.positon\" }"),
            &["no run file has a column", "did you mean \"joint.a.position\"?"],
        ),
    ];
    for (toml, wanted) in &manifests {
        let message = error(with(toml).path());
        wanted.iter().for_each(|part| assert!(message.contains(part), "{message}\nshould contain {part}"));
    }
    let tables: [(&str, &[&str]); 9] = [
        ("", &["a.csv", "no header"]),
        ("t,joint.a.position\n", &["a.csv", "no row"]),
        ("time,joint.a.position\n0,1\n", &["a.csv", "no column \"t\""]),
        ("t,joint.a.position\n0,1\n1\n2,3\n", &["a.csv:3", "1 cells, the header has 2"]),
        ("t,joint.a.position,joint.b.position\n0,1,2\n1,2\n", &["a.csv:3", "ends in the middle of a row"]),
        ("t,joint.a.position\n0,1\nx,2\n", &["a.csv:3", "\"x\" in column \"t\" is not a number"]),
        ("t,joint.a.position\n0,1\n,2\n", &["a.csv:3", "no time"]),
        ("t;joint.a.position\n0;1,5\n", &["a.csv:2", "decimals with a point"]),
        ("t,foo\n0,1\n", &["a.csv", "no column that is a channel", "[channels]"]),
    ];
    for (csv, wanted) in tables {
        let message = error(one(csv).path());
        wanted.iter().for_each(|part| assert!(message.contains(part), "{message}\nshould contain {part}"));
    }
    let nowhere = error(std::path::Path::new("no/such/folder"));
    assert!(nowhere.contains("no such folder"), "{nowhere}");
}

#[test]
fn a_parquet_file_cut_at_any_byte_is_an_error() {
    let signals = Signals {
        times: (0..50).map(f64::from).collect(),
        channels: vec![Channel {
            spec: ChannelSpec::new("joint.a.position", "rad", Plot::Joints),
            values: vec![0.5; 50],
        }],
    };
    let bytes = record::encode_parquet(&Meta::default(), &signals).unwrap();
    let dir = exact(&format!("{HEAD}{}", FIT.replace("a.csv", "a.parquet")), &[("a.parquet", &bytes)]);
    assert_eq!(load(dir.path()).runs[0].series[0].len(), 50);
    for length in 0..bytes.len() {
        fs::write(dir.path().join("a.parquet"), &bytes[..length]).unwrap();
        let message = error(dir.path());
        assert!(message.contains("a.parquet: not a whole Parquet file"), "{message}");
    }
}

#[test]
fn a_csv_file_cut_at_any_byte_holds_only_whole_rows() {
    let csv = "t,joint.a.position,joint.a.velocity\n0,1.25,3\n0.5,2.5,\n1,3.75,4.125\n";
    let whole = load(one(csv).path());
    let dir = one(csv);
    for length in 0..csv.len() {
        fs::write(dir.path().join("a.csv"), &csv[..length]).unwrap();
        let Ok(set) = RecordingSet::load(dir.path()) else { continue };
        for series in &set.runs[0].series {
            let full = whole.runs[0].series(&series.channel).unwrap();
            assert_eq!(series.values[..], full.values[..series.len()], "cut at {length}: a half-read number");
            assert_eq!(series.times[..], full.times[..series.len()]);
        }
    }
}

/// A cell as rigs write them, and worse.
fn cell() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => (-1e3..1e3_f64).prop_map(|x| format!("{x:.4}")),
        2 => Just(String::new()),
        1 => any::<f64>().prop_map(|x| x.to_string()),
        1 => prop_oneof![Just("nan"), Just("-inf"), Just("1e999"), Just("abc"), Just("\"1,5\""), Just("\""), Just("NA")]
            .prop_map(str::to_owned),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Whatever stands in the cells: an error, or series as promised; and an inspection that does not panic.
    #[test]
    fn any_cells_give_sound_series_or_an_error(
        rows in prop::collection::vec((0.0..30.0_f64, prop::collection::vec(cell(), 6)), 0..60), sorted: bool,
    ) {
        let mut rows = rows;
        if sorted {
            rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let mut csv = String::from(
            "t,joint.a.position,joint.a.velocity,body.b.orientation.w,body.b.orientation.x,body.b.orientation.y,body.b.orientation.z\n",
        );
        for (t, cells) in &rows {
            csv.push_str(&format!("{t:.1},{}\n", cells.join(",")));
        }
        let dir = one(&csv);
        if let Ok(set) = RecordingSet::load(dir.path()) {
            for series in &set.runs[0].series {
                prop_assert!(series.times.windows(2).all(|t| t[0] < t[1]), "{:?}", series.times);
                prop_assert!(series.values.iter().chain(series.times.iter()).all(|v| v.is_finite()));
                prop_assert_eq!(series.times.len(), series.values.len());
                prop_assert!(series.quantum() >= 0.0 && series.quantum().is_finite());
            }
            let inspection = record::inspect::inspect(&set);
            record::inspect::to_text(&inspection);
            prop_assert!(record::plot::recording_svg(&set).ends_with("</svg>\n"));
        }
    }

    /// Any bytes as any of the files.
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300), which in 0..3_usize) {
        let toml = format!("{HEAD}{}", if which == 2 { FIT.replace("csv", "parquet") } else { FIT.to_owned() });
        let dir = exact(&toml, &[("a.csv", &bytes), ("a.parquet", &bytes)]);
        if which == 0 {
            fs::write(dir.path().join("recording.toml"), &bytes).unwrap();
        }
        let _ = RecordingSet::load(dir.path());
    }

    /// recording.toml, changed at one place.
    #[test]
    fn a_changed_manifest_is_read_or_refused(at in 0..200_usize, with: char) {
        let toml = format!(
            "{HEAD}[noise]\n\"joint.a\" = 1e-3\n[time]\ncolumn = \"t\"\n[channels]\n\"joint.a.position\" = {{ column = \"x\", unit = \"deg\" }}\n{FIT}"
        );
        let mut chars: Vec<char> = toml.chars().collect();
        let at = at % chars.len();
        chars[at] = with;
        let text: String = chars.into_iter().collect();
        let _ = RecordingSet::load(exact(&text, &[("a.csv", b"t,x\n0,1\n1,2\n")]).path());
    }
}

#[test]
fn a_joint_that_begins_anew_after_a_full_turn_goes_on_and_a_sliding_one_is_left_alone() {
    let row = |t: usize| {
        let angle = 0.05 * t as f64;
        let read = angle.sin().atan2(angle.cos());
        format!("{},{read},{}\n", t as f64 * 0.01, read.to_degrees())
    };
    let text = (0..400).fold("t,joint.a.position,b\n".to_owned(), |text, t| text + &row(t));
    let head = format!("{HEAD}[channels]\n\"joint.b.position\" = {{ column = \"b\", unit = \"deg\" }}\n");
    let set = load(folder(&head, &[("a.csv", &text)]).path());
    for channel in ["joint.a.position", "joint.b.position"] {
        let values = &set.runs[0].series(channel).unwrap().values;
        assert!(values.iter().enumerate().all(|(t, q)| (q - 0.05 * t as f64).abs() < 1e-9), "{channel}");
    }
    assert!(said(&set).contains("begins anew 3 times after a full turn"), "{}", said(&set));
    let slides = "t,joint.a.position\n0,0\n0.1,6\n0.2,0.1\n0.3,12\n";
    assert_eq!(load(one(slides).path()).runs[0].series[0].values, [0.0, 6.0, 0.1, 12.0]);
}
