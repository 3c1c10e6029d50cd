//! What is written is read back bit for bit.
#![allow(clippy::unwrap_used)]

use record::{Channel, ChannelSpec, Meta, Plot, Signals};
use std::path::Path;

/// Numbers that text or single precision would spoil, and a gap.
fn awkward() -> Signals {
    let spec = |name: &str, unit: &str| ChannelSpec::new(name, unit, Plot::Joints).described("about z, ahead positive");
    let values = |v: [f64; 5]| v.to_vec();
    Signals {
        times: values([-0.1, 0.0, 0.1, 0.1 + f64::EPSILON, 1e9]),
        channels: vec![
            Channel {
                spec: spec("joint.elbow.position", "rad"),
                values: values([0.1 + 0.2, -0.0, 5e-324, f64::MAX, f64::MIN_POSITIVE]),
            },
            Channel {
                spec: spec("sensor.wrist.torque.z", "N·m"),
                values: values([f64::NAN, 1.0 / 3.0, f64::NAN, 1e-7, 2.0]),
            },
            Channel { spec: spec("a \"quoted\", comma", ""), values: values([f64::NAN; 5]) },
        ],
    }
}

fn meta() -> Meta {
    let notes = vec![("rig".to_string(), "tumbler".to_string()), ("empty".to_string(), String::new())];
    Meta {
        scenario: "tumbling-capture".into(),
        seed: u64::MAX,
        version: "0.1.0".into(),
        inputs: "μ = 0.3\n".into(),
        notes,
    }
}

#[test]
fn parquet_returns_every_bit_with_units_and_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("signals.parquet");
    record::write_parquet(&path, &meta(), &awkward()).unwrap();
    let (read_meta, read) = record::read_parquet(&path).unwrap();
    assert_eq!(read_meta, meta());
    assert!(read.same_numbers(&awkward()), "{read:?}");
    assert!(read.channels.iter().zip(&awkward().channels).all(|(a, b)| a.spec == b.spec));
}

#[test]
fn equal_signals_give_equal_bytes() {
    let encode = || record::encode_parquet(&meta(), &awkward()).unwrap();
    assert!((0..20).all(|_| encode() == encode()));
}

#[test]
fn csv_returns_every_bit() {
    let text = record::encode_csv(&awkward());
    assert!(text.starts_with("t,joint.elbow.position,sensor.wrist.torque.z,"));
    let read = record::parse_csv(Path::new("run-01.csv"), &text).unwrap();
    assert!(read.same_numbers(&awkward()), "{text}\n{read:?}");
}

#[test]
fn empty_run_round_trips() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("signals.parquet");
    let empty = Signals::new(vec![ChannelSpec::new("a", "m", Plot::Other)]);
    record::write_parquet(&path, &meta(), &empty).unwrap();
    assert!(record::read_parquet(&path).unwrap().1.same_numbers(&empty));
}

#[test]
fn wrong_csv_is_refused_with_its_line() {
    let refusal = |text: &str| record::parse_csv(Path::new("run-01.csv"), text).unwrap_err().to_string();
    for (text, wanted) in [
        ("time,a\n0,1\n", "run-01.csv:1: first column is \"time\", must be \"t\""),
        ("", "run-01.csv:1: first column is \"\""),
        ("t,a\n0,1\n1\n", "run-01.csv:3: 1 cells, the header has 2"),
        ("t,a\n0,1\n0,2\n", "run-01.csv:3: time 0 s does not come after 0 s"),
        ("t,a\n0,1\n\n1,abc\n", "run-01.csv:4: \"abc\" in column \"a\" is not a finite number"),
        ("t,a\n0,nan\n", "run-01.csv:2: \"nan\" in column \"a\""),
        ("t,a\n,1\n", "run-01.csv:2: has no time t"),
        ("t,a,a\n0,1,2\n", "two columns are named \"a\""),
    ] {
        let message = refusal(text);
        assert!(message.contains(wanted), "{text:?}: {message}");
    }
}

#[test]
fn wrong_parquet_is_refused_with_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("signals.parquet");
    let refusal = || record::read_parquet(&path).unwrap_err().to_string();
    assert!(refusal().contains("cannot read"), "{}", refusal());
    std::fs::write(&path, b"PAR1 not really").unwrap();
    assert!(refusal().contains("signals.parquet: not a readable Parquet file"), "{}", refusal());
}
