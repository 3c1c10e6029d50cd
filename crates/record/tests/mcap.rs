//! A recording in CSV, Parquet and MCAP is the same recording; and so is one that ROS 2 packages wrote.
#![allow(clippy::unwrap_used)]

use record::{Format, RecordedRun, RecordingSet, Role, Series};
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/recordings").join(name)
}

#[test]
fn a_run_is_the_same_to_the_bit_in_csv_parquet_and_mcap() {
    let times: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.01).collect();
    let slow: Vec<f64> = times.iter().step_by(7).map(|t| t + 0.0013).collect();
    let step = 0.5f64.to_radians();
    let encoder = times.iter().map(|t| ((3.0 * t).sin() / step).round() * step).collect();
    let rate = slow.iter().map(|t| 3.0 * (3.0 * t).cos() / 7.0).collect();
    let series = vec![
        Series::with_quantum("joint.elbow.position", times, encoder, 0.0),
        Series::with_quantum("joint.elbow.velocity", slow, rate, 0.0),
    ];
    let run = RecordedRun { file: String::new(), role: Role::Fit, note: String::new(), series };
    let set = RecordingSet { rig: "arm".into(), runs: vec![run], ..RecordingSet::default() };
    let home = tempfile::tempdir().unwrap();
    for format in [Format::Csv, Format::Parquet, Format::Mcap] {
        set.clone().append_to(home.path(), format).unwrap();
    }
    let read = RecordingSet::load(home.path()).unwrap();
    let endings: Vec<&str> = read.runs.iter().map(|r| r.file.rsplit_once('.').unwrap().1).collect();
    assert_eq!(endings, ["csv", "parquet", "mcap"]);
    for run in &read.runs {
        assert_eq!(run.series, read.runs[0].series, "{}", run.file);
        for (a, b) in run.series.iter().zip(&set.runs[0].series) {
            assert_eq!((&a.channel, &a.times, &a.values), (&b.channel, &b.times, &b.values), "{}", run.file);
        }
    }
    // A file that was cut is no recording.
    let file = home.path().join("run-03.mcap");
    let whole = std::fs::read(&file).unwrap();
    std::fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    let refused = RecordingSet::load(home.path()).unwrap_err().to_string();
    assert!(refused.contains("run-03.mcap") && refused.contains("no whole MCAP file"), "{refused}");
}

#[test]
fn a_set_that_maps_columns_is_not_written_again_and_stays_what_it_is() {
    let home = tempfile::tempdir().unwrap();
    for file in std::fs::read_dir(folder("tumble-ros2")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), home.path().join(file.file_name())).unwrap();
    }
    let manifest = || std::fs::read_to_string(home.path().join("recording.toml")).unwrap();
    let (before, set) = (manifest(), RecordingSet::load(home.path()).unwrap());
    let refused = set.append_to(home.path(), Format::Csv).unwrap_err().to_string();
    assert!(refused.contains("recording.toml") && refused.contains("`channels`"), "{refused}");
    assert_eq!(manifest(), before);
    assert_eq!(std::fs::read_dir(home.path()).unwrap().count(), 3, "no file is left behind");
}

/// `tests/mcap/bag.py` made it of `tests/recordings/tumble` with the packages `mcap` and `mcap-ros2-support` of PyPI.
#[test]
fn a_ros_2_bag_that_others_wrote_is_the_recording_that_it_was_made_of() {
    let (bag, table) = (folder("tumble-ros2"), folder("tumble"));
    let [bag, table] = [bag, table].map(|at| RecordingSet::load(&at).unwrap_or_else(|e| panic!("{e}")));
    assert_eq!(bag.runs.len(), table.runs.len());
    for (a, b) in bag.runs.iter().zip(&table.runs) {
        assert_eq!((a.role, a.series.len()), (b.role, b.series.len()));
        for (a, b) in a.series.iter().zip(&b.series) {
            assert_eq!((&a.channel, a.times.len()), (&b.channel, b.times.len()));
            let far = a.times.iter().zip(b.times.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(far < 1e-9, "stamps of nanoseconds: {far}");
            let far = a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(far < 1e-15, "{}: {far}", a.channel);
        }
    }
}
