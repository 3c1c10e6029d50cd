//! A patched file is a scenario like any other, wherever it lies.
#![allow(clippy::unwrap_used)]

use super::*;
use serde_json::json;

fn scenario(overrides: &[&str]) -> Scenario {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/tumbling-capture.toml");
    scenario::load(&file, &overrides.iter().map(|o| (*o).to_owned()).collect::<Vec<_>>()).unwrap()
}

fn diagnosis() -> Diagnosis {
    let error = json!({ "before": 246.3, "after": 1.006 });
    serde_json::from_value(json!({
        "verdict": "explained", "recording": "bench-0007", "located": [],
        "effects": [
            { "name": "joint-coulomb-friction", "place": "joint:shoulder_pitch", "params": { "c": 0.803_123_456_789 },
              "std_err": { "c": 0.0012 } },
            { "name": "constant-torque", "place": "body:target", "params": { "vector": [2e-4, -4e-4, 0.0], "frame": "body" },
              "std_err": { "vector": [2e-6, 3e-6, null] } }
        ],
        "error": { "fit": error, "holdout": error, "window_s": 0.5, "windowed": error, "runs": [] }
    }))
    .unwrap()
}

#[test]
fn a_patched_scenario_keeps_its_text_says_its_errors_and_loads() {
    let dir = tempfile::tempdir().unwrap();
    let nominal = scenario(&[]);
    let text = patched_toml(&nominal, &diagnosis(), dir.path()).unwrap();
    assert!(text.contains("c = 0.803123  # ± 0.0012"), "{text}");
    assert!(text.contains("vector = [0.0002, -0.0004, 0.0]  # ± [2·10⁻⁶, 3·10⁻⁶, –]"), "{text}");
    assert!(
        text.starts_with("# Scenario \"tumbling-capture\"")
            && text.contains("bench-0007")
            && text.contains("1.006 after")
    );
    let first_comment = nominal.source.text().lines().next().unwrap();
    assert!(text.contains(first_comment), "comments of the original stay");
    let file = dir.path().join(FILE);
    std::fs::write(&file, &text).unwrap();
    let patched = scenario::load(&file, &[]).unwrap();
    assert_eq!(patched.effects.len(), nominal.effects.len() + 2);
    assert_eq!((patched.effects[0].place.as_str(), patched.duration_s), ("joint:shoulder_pitch", nominal.duration_s));
    let urdf = patched.resolve(&patched.vehicles[0].urdf);
    assert!(urdf.is_file(), "{}", urdf.display());
}

#[test]
fn a_patched_scenario_builds_and_runs_from_another_folder_with_the_effect_in_it() {
    let dir = tempfile::tempdir().unwrap();
    let mut one = diagnosis();
    one.effects.truncate(1);
    let end = |diagnosis: &Diagnosis| {
        let file = dir.path().join(FILE);
        std::fs::write(&file, patched_toml(&scenario(&[]), diagnosis, dir.path()).unwrap()).unwrap();
        let mut mission = scenario::build(&scenario::load(&file, &[]).unwrap()).unwrap();
        mission.world.run(50, &*mission.controller, &mut []).unwrap();
        mission.world.state().clone()
    };
    let (nominal, patched) = (end(&Diagnosis { effects: Vec::new(), ..diagnosis() }), end(&one));
    assert!(nominal.time > 0.0 && nominal.time == patched.time);
    assert_ne!(format!("{nominal:?}"), format!("{patched:?}"), "the friction that was found acts");
}

#[test]
fn overrides_are_written_out_and_an_effect_that_was_there_is_replaced() {
    let dir = tempfile::tempdir().unwrap();
    let text = patched_toml(&scenario(&["duration_s=3.5"]), &diagnosis(), dir.path()).unwrap();
    let once = parse(&text, &dir.path().join(FILE).display().to_string(), &[]).unwrap();
    assert_eq!((once.duration_s, once.effects.len()), (3.5, 2));
    let mut other = diagnosis();
    other.effects.truncate(1);
    other.effects[0].params.insert("c".into(), ParamValue::Number(0.5));
    let twice = parse(&patched_toml(&once, &other, dir.path()).unwrap(), "x.toml", &[]).unwrap();
    assert_eq!(twice.effects.len(), 2);
    let friction = twice.effects.iter().find(|e| e.name == "joint-coulomb-friction").unwrap();
    assert_eq!(friction.params["c"], ParamValue::Number(0.5));
}

#[cfg(unix)]
#[test]
fn a_folder_behind_a_link_that_is_not_there_yet_sees_the_file() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(dir.path().join("deep/er")).unwrap();
    std::os::unix::fs::symlink(dir.path().join("deep/er"), dir.path().join("link")).unwrap();
    std::fs::write(dir.path().join("x.urdf"), "").unwrap();
    assert_eq!(path_between(&dir.path().join("link/new"), &dir.path().join("x.urdf")), "../../../x.urdf");
}

#[test]
fn the_files_of_a_diagnosis_are_written_for_the_place_where_they_will_stand() {
    let dir = tempfile::tempdir().unwrap();
    let target = dir.path().join("out/deep");
    let folder = record::OutputFolder::create(&target).unwrap();
    crate::write_diagnosis(&folder, &scenario(&[]), &diagnosis(), &crate::Evidence::default()).unwrap();
    let stands = folder.finish(&serde_json::Map::new()).unwrap();
    for file in [crate::DIAGNOSIS_FILE, crate::report::FILE] {
        assert!(stands.join(file).is_file(), "{file}");
    }
    let patched = scenario::load(&stands.join(FILE), &[]).unwrap();
    assert!(patched.resolve(&patched.vehicles[0].urdf).is_file());
}

#[test]
fn paths_go_up_and_down_and_are_absolute_where_nothing_is_shared() {
    let dir = tempfile::tempdir().unwrap();
    let (a, b) = (dir.path().join("a/b"), dir.path().join("c"));
    std::fs::create_dir_all(&a).unwrap();
    std::fs::create_dir_all(&b).unwrap();
    std::fs::write(b.join("x.urdf"), "").unwrap();
    assert_eq!(path_between(&a, &b.join("x.urdf")), "../../c/x.urdf");
    assert_eq!(
        moved("urdf = 'x.urdf' # x\nname = \"x.urdf\"", &b, &a),
        "urdf = \"../../c/x.urdf\" # x\nname = \"x.urdf\""
    );
    assert!(Path::new(&path_between(Path::new("/"), &b.join("x.urdf"))).is_absolute());
    assert_eq!(moved("urdf = 'none.urdf'", &b, &a), "urdf = 'none.urdf'", "what is not there is left as it is");
}
