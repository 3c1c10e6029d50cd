//! Recordings that are not part of softdock: measured ones of other teams in their own columns, and the practice sets.
//!
//! `SOFTDOCK_RECORDINGS` names the folder that holds `real` and `practice`, or `real` itself; `../shared/recordings` beside
//! the checkout by default. Without them the tests say loudly that they show nothing.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

mod support;

use record::{RecordingSet, Severity, inspect};
use std::path::{Path, PathBuf};
use support::exact;

fn real(test: &str) -> Option<PathBuf> {
    let given = std::env::var_os("SOFTDOCK_RECORDINGS").filter(|folder| !folder.is_empty()).map(PathBuf::from);
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/recordings");
    let folder = given.unwrap_or_else(beside);
    let folder = Some(folder.join("real")).filter(|real| real.is_dir()).unwrap_or(folder);
    if !folder.is_dir() {
        eprintln!("SKIPPED {test}: SOFTDOCK_RECORDINGS names no folder with recordings, so nothing was shown");
        return None;
    }
    Some(folder.canonicalize().unwrap())
}

/// Reads measured files where they are, through a recording.toml in a folder of its own.
fn read(toml: &str, real: &Path) -> RecordingSet {
    let toml = toml.replace("REAL", real.to_str().unwrap());
    RecordingSet::load(exact(&format!("format = 1\nrig = \"real\"\n{toml}"), &[]).path()).unwrap()
}

fn look(set: &RecordingSet) -> (inspect::Inspection, String) {
    let inspection = inspect::inspect(set);
    let text = inspect::to_text(&inspection);
    println!("{text}");
    (inspection, text)
}

#[test]
fn cube_tosses_become_150_runs_with_roles() {
    let Some(real) = real("cube_tosses_become_150_runs_with_roles") else { return };
    let mut toml = String::from("[time]\ncolumn = \"t_s\"\ngroup = \"toss\"\n[channels]\n");
    let columns = [
        ("orientation.w", "qw"),
        ("orientation.x", "qx"),
        ("orientation.y", "qy"),
        ("orientation.z", "qz"),
        ("position.x", "x_m"),
        ("position.y", "y_m"),
        ("position.z", "z_m"),
        ("angular_velocity.x", "wx_rad_s"),
        ("angular_velocity.y", "wy_rad_s"),
        ("angular_velocity.z", "wz_rad_s"),
        ("linear_velocity.x", "vx_m_s"),
        ("linear_velocity.y", "vy_m_s"),
        ("linear_velocity.z", "vz_m_s"),
    ];
    columns.iter().for_each(|(c, column)| toml.push_str(&format!("\"body.cube.{c}\" = {{ column = \"{column}\" }}\n")));
    for (role, groups) in [("fit", "0-99"), ("holdout", "100-149")] {
        let file = "REAL/contactnets_cube/cube_tosses_000_149.csv";
        toml.push_str(&format!("[[run]]\nfile = \"{file}\"\nrole = \"{role}\"\ngroups = [\"{groups}\"]\n"));
    }
    let set = read(&toml, &real);
    let fitted = set.runs_of(record::Role::Fit).count();
    assert_eq!((set.runs.len(), fitted), (150, 100));
    assert!(set.runs.iter().all(|run| (85..=138).contains(&run.series[0].len()) && run.series.len() == 13));
    let (found, _) = look(&set);
    // The README: velocities are backward differences, so that a reading belongs to half a step, 1/296 s = 3.4 ms, earlier.
    // Impacts between two samples blur that: the pairs stay at ten times the noise, and the figure is found to a third.
    for pair in &found.consistency {
        let delay = pair.delay.unwrap();
        assert!((delay.value - 0.5 / 148.0).abs() < 1.2e-3, "{}: {delay:?}", pair.rate);
    }
}

#[test]
fn a_positioning_system_is_read_in_volts_and_metres() {
    let Some(real) = real("a_positioning_system_is_read_in_volts_and_metres") else { return };
    let toml = "[time]\ncolumn = \"t_s\"\n[channels]\n\"joint.slide.position\" = { column = \"meas_pos_m\" }\n\
        \"joint.slide.effort_command\" = { column = \"control_V\", scale = 35.15065188 }\n\
        [[run]]\nfile = \"REAL/emps/emps_train.csv\"\nrole = \"fit\"\n\
        [[run]]\nfile = \"REAL/emps/emps_test_pulses.csv\"\nrole = \"holdout\"\n";
    let set = read(toml, &real);
    look(&set);
    let run = &set.runs[0];
    assert_eq!(run.series("joint.slide.position").unwrap().len(), 24_841);
    let force = run.series("joint.slide.effort_command").unwrap();
    assert!((force.values[0] - 35.15065188 * 2.538628).abs() < 1e-9);
}

#[test]
fn a_tumbling_satellite_in_degrees_is_cut_into_passes() {
    let Some(real) = real("a_tumbling_satellite_in_degrees_is_cut_into_passes") else { return };
    let mut toml = String::from("[time]\ncolumn = \"unix_s\"\ngroup = \"pass_id\"\n[channels]\n");
    for c in ["x", "y", "z"] {
        let column = format!("{{ column = \"gyro_{c}_deg_s\", unit = \"deg/s\" }}");
        toml.push_str(&format!("\"body.suchai.angular_velocity.{c}\" = {column}\n"));
    }
    toml.push_str("[[run]]\nfile = \"REAL/suchai3_attitude/suchai3_gyro_mag_sun_1hz.csv\"\nrole = \"fit\"\n");
    let set = read(&toml, &real);
    assert!(set.runs.len() > 30 && set.runs.iter().all(|run| run.span().unwrap().0 == 0.0));
    let (found, text) = look(&set);
    // The README: 0.09 to 0.10 deg/s per axis.
    for channel in &found.channels {
        let noise = channel.noise.unwrap().to_degrees();
        assert!((0.05..0.15).contains(&noise), "{}: {noise} deg/s", channel.channel);
    }
    assert!(text.contains("clipped") || text.contains("stuck"), "gyro z stands at 225.05 deg/s in pass 0");
}

#[test]
fn joints_of_a_pendulum_and_their_rates_fit_together() {
    let Some(real) = real("joints_of_a_pendulum_and_their_rates_fit_together") else { return };
    let mut toml = String::from("[time]\ncolumn = \"t_s\"\n[channels]\n");
    for (k, joint) in [(1, "shoulder"), (2, "elbow")] {
        toml.push_str(&format!("\"joint.{joint}.position\" = {{ column = \"q{k}_rad\" }}\n"));
        toml.push_str(&format!("\"joint.{joint}.velocity\" = {{ column = \"dq{k}_rad_s\" }}\n"));
        toml.push_str(&format!("\"joint.{joint}.effort\" = {{ column = \"tau{k}_meas_Nm\" }}\n"));
        toml.push_str(&format!("\"joint.{joint}.effort_command\" = {{ column = \"tau{k}_cmd_Nm\" }}\n"));
    }
    for (file, role) in [("A0_exc_00", "fit"), ("A0_exc_05", "fit"), ("A0_fullrange_061157", "holdout")] {
        toml.push_str(&format!("[[run]]\nfile = \"REAL/dfki_double_pendulum/{file}.csv\"\nrole = \"{role}\"\n"));
    }
    let set = read(&toml, &real);
    let (found, text) = look(&set);
    // The README: position quantum 1.9e-4 rad (readings are odd multiples of it, so 3.8e-4 apart), velocity 0.033 rad/s.
    // About zero the velocity's steps are 0.011 and 0.022, hence the 5 %.
    let rate = found.channels.iter().find(|c| c.channel == "joint.shoulder.velocity").unwrap();
    assert!((rate.rounding / 0.033 - 1.0).abs() < 0.05, "{}", rate.rounding);
    assert!(text.contains("the clock jitters"), "the README says that it does");
    for pair in &found.consistency {
        let scale = pair.scale[0].unwrap();
        assert!((scale.value - 1.0).abs() < 0.03 && !pair.is_fault, "{}: {scale:?}", pair.rate);
    }
}

#[test]
fn segments_whose_time_starts_again_are_runs() {
    let Some(real) = real("segments_whose_time_starts_again_are_runs") else { return };
    let toml = "[time]\ncolumn = \"t_s\"\ngroup = \"segment\"\n[channels]\n\
        \"joint.pivot.position\" = { column = \"theta1_rad\" }\n\"joint.pivot.velocity\" = { column = \"omega1_rad_s\" }\n\
        [[run]]\nfile = \"REAL/multiarm_pendulum/single_freeswing_500hz.csv\"\nrole = \"fit\"\n";
    let set = read(toml, &real);
    look(&set);
    assert_eq!(set.runs.len(), 6, "six contiguous segments");
}

#[test]
fn nothing_odd_is_said_of_the_practice_sets() {
    let Some(real) = real("nothing_odd_is_said_of_the_practice_sets") else { return };
    let Ok(entries) = std::fs::read_dir(real.join("../practice")) else {
        eprintln!("SKIPPED nothing_odd_is_said_of_the_practice_sets: no practice sets beside the recordings");
        return;
    };
    let mut folders: Vec<PathBuf> =
        entries.map(|e| e.unwrap().path()).filter(|p| p.join("recording.toml").is_file()).collect();
    folders.sort();
    for folder in &folders {
        let found = inspect::inspect(&RecordingSet::load(folder).unwrap());
        assert!(found.worst() < Some(Severity::Warning), "{}:\n{}", folder.display(), inspect::to_text(&found));
        for channel in &found.channels {
            let ratio = channel.noise.zip(channel.stated).map_or(1.0, |(found, stated)| found / stated);
            assert!((ratio - 1.0).abs() < 0.1, "{}, {}: {ratio}", folder.display(), channel.channel);
        }
    }
    println!("{} sets", folders.len());
}
