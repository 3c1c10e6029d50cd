//! What goes to the viewer: whole files, bounded size, no wall clock; a viewer that is not there is told of.
#![cfg(feature = "rerun")]
#![allow(clippy::unwrap_used)]

mod synthetic;

use record::rerun_sink::{LiveRerun, encode_rrd, write_rrd};
use record::{Meta, Scene};
use std::path::Path;

/// Bytes of a file that opens and closes as the format asks.
fn is_whole(bytes: &[u8]) -> bool {
    bytes.starts_with(b"RRF2") && bytes[bytes.len() - 64..].windows(8).any(|w| w == b"RRF2FOOT")
}

fn contains(bytes: &[u8], text: &str) -> bool {
    bytes.windows(text.len()).any(|window| window == text.as_bytes())
}

#[test]
fn file_is_whole_and_has_its_blueprint() {
    let bytes = encode_rrd(&synthetic::run(12.0), &synthetic::scene(), synthetic::SUMMARY).unwrap();
    assert!(is_whole(&bytes));
    assert!(contains(&bytes, "blueprint"));
}

/// Ten times the samples, less than ten times the bytes: meshes and names are there once.
#[test]
fn size_grows_with_the_samples_and_no_faster() {
    let size = |duration| encode_rrd(&synthetic::run(duration), &synthetic::scene(), "").unwrap().len();
    let (short, long) = (size(2.0), size(20.0));
    assert!(long < 10 * short, "{short} and {long} bytes");
}

/// A run that diverged in its first step, a scene without anything, names with any characters.
#[test]
fn empty_log_and_strange_names_are_written() {
    assert!(is_whole(&encode_rrd(&record::Log::default(), &Scene::default(), "").unwrap()));
    let (mut log, mut scene) = (synthetic::run(0.1), synthetic::scene());
    scene.vehicles[0].name = "träger/№ 1 \"x\"".into();
    scene.vehicles[0].links[0].name = String::new();
    log.signals.channels[0].spec.name = "a/b c.δ\\".into();
    log.signals.channels[0].spec.unit = "kg·m²/s".into();
    assert!(is_whole(&encode_rrd(&log, &scene, "").unwrap()));
}

#[test]
#[cfg(target_os = "linux")]
fn full_disk_is_told_with_the_file() {
    let (log, scene) = (synthetic::run(0.1), synthetic::scene());
    let message = write_rrd(Path::new("/dev/full"), &log, &scene, "").unwrap_err().to_string();
    assert!(message.contains("cannot write /dev/full") && message.contains("free some space"), "{message}");
}

#[test]
fn missing_viewer_is_told_with_the_way_to_get_one() {
    let nobody = "rerun+http://127.0.0.1:9/proxy";
    let error = LiveRerun::connect(nobody, Meta::default(), Vec::new(), Scene::default()).err().unwrap().to_string();
    assert!(error.contains(nobody) && error.contains("pip install rerun-sdk"), "{error}");
    let wrong = LiveRerun::connect("not a url", Meta::default(), Vec::new(), Scene::default()).err().unwrap();
    assert!(wrong.to_string().contains("not a url"), "{wrong}");
}
