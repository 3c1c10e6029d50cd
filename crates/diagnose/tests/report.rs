//! The report of four made-up cases: whole, self-contained, small, and saying what it must.
#![allow(clippy::unwrap_used)]

mod samples;

use diagnose::diagnosis::{BeforeAfter, ChannelError, Diagnosis, Verdict};
use diagnose::evidence::Evidence;
use diagnose::words::paragraph;
use diagnose::{report_html, summary_text};

/// Largest page, bytes.
const LARGEST: usize = 3_000_000;

fn cases() -> [(&'static str, (Diagnosis, Evidence)); 4] {
    let [joint, contact, null, unknown] = [samples::joint(), samples::contact(), samples::null(), samples::unknown()];
    [("joint", joint), ("contact", contact), ("null", null), ("unknown", unknown)]
}

/// Elements that HTML does not close.
const VOID: [&str; 3] = ["meta", "br", "wbr"];

/// Complains of a tag that is not closed in order.
fn assert_nested(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let body = page.replace("<!doctype html>", "");
    let script = body.find("<script>").unwrap();
    for tag in body[..script].split('<').skip(1) {
        let tag = tag.split('>').next().unwrap();
        let name = tag.trim_start_matches('/').split([' ', '\n']).next().unwrap().trim_end_matches('/');
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed), "after {open:?}");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert_eq!(open, ["html", "body"]);
}

#[test]
fn a_report_is_one_small_page_that_needs_nothing_else() {
    for (name, (diagnosis, evidence)) in cases() {
        let page = report_html(&diagnosis, &evidence);
        let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}.html"));
        std::fs::write(&file, &page).unwrap();
        std::fs::write(file.with_extension("txt"), summary_text(&diagnosis, &evidence)).unwrap();
        assert!(page.len() < LARGEST, "{name}: {} bytes", page.len());
        assert_nested(&page);
        for word in ["NaN", "inf\"", "http:", "https:", "src=", "@import", "url("] {
            let drawn = page.split("<script>").next().unwrap();
            assert!(!drawn.contains(word), "{name}: {word} in {}", file.display());
        }
        assert!(page.contains("prefers-color-scheme: dark") && page.contains("name=\"viewport\""));
    }
}

#[test]
fn a_report_without_any_evidence_is_still_a_page() {
    for (_, (diagnosis, _)) in cases() {
        let page = report_html(&diagnosis, &Evidence::default());
        assert_nested(&page);
        assert!(page.contains("How well it predicts") && !page.contains("The missing force"));
    }
}

/// The joint's diagnosis with the error of a channel in its own unit.
fn in_radians() -> (Diagnosis, Evidence) {
    let (mut diagnosis, evidence) = samples::joint();
    let error = |before: f64, after: f64| BeforeAfter { before, after };
    diagnosis.error.channels = vec![ChannelError {
        channel: "joint.joint_3.position".to_owned(),
        unit: "rad".to_owned(),
        sigma: 5e-5,
        free: error(0.8, 8e-5),
        windowed: error(0.012_3, 5.03e-5),
    }];
    (diagnosis, evidence)
}

#[test]
fn the_paragraph_says_where_when_what_how_sure_and_what_it_improves() {
    let (diagnosis, evidence) = samples::joint();
    let said = paragraph(&diagnosis, &evidence);
    for part in [
        "94 % of the mismatch sits at joint_3 (throughout; moving",
        "viscous friction at joint_3 (b = 0.9012 ± 0.0011 N m s/rad)",
        "from 247 to 1.006",
        "worse by 212",
    ] {
        assert!(said.contains(part), "{part} in: {said}");
    }
    let (mut diagnosis, evidence) = in_radians();
    let said = paragraph(&diagnosis, &evidence);
    for part in ["(1 is perfect), in joint.joint_3.position by 0.8 rad.", "position from 0.8 rad to 8·10⁻⁵ rad"] {
        assert!(said.contains(part), "{part} in: {said}");
    }
    // Where whole runs are not predictable both tell of windows.
    diagnosis.error.holdout.as_mut().unwrap().after = 100.0;
    let said = paragraph(&diagnosis, &evidence);
    assert!(said.contains("in joint.joint_3.position by 0.012 rad."), "{said}");
    // Multiples of a noise that no rig has say nothing.
    diagnosis.error.windowed.before = 6e8;
    let said = paragraph(&diagnosis, &evidence);
    for part in
        ["wrong by 0.012 rad in joint.joint_3.position, far beyond the noise", "falls in joint.joint_3.position from"]
    {
        assert!(said.contains(part), "{part} in: {said}");
    }
    let (diagnosis, evidence) = samples::contact();
    let said = paragraph(&diagnosis, &evidence);
    for part in [
        "from 0.45 s to 1.65 s; in contact",
        "do not decide between a wrong contact stiffness and an elastic mount behind the contact.",
        "[(4.020 ± 0.040)·10⁻³",
    ] {
        assert!(said.contains(part), "{part} in: {said}");
    }
    let (diagnosis, evidence) = samples::null();
    let said = paragraph(&diagnosis, &evidence);
    assert!(said.contains("as well as the noise of its sensors allows") && !said.contains("explained"), "{said}");
    let (diagnosis, evidence) = samples::unknown();
    let said = paragraph(&diagnosis, &evidence);
    assert!(
        said.contains("from 2.1 s on; sliding, growing with the distance slid")
            && said.contains("No effect of the library"),
        "{said}"
    );
}

#[test]
fn text_from_a_recording_cannot_become_markup() {
    let (mut diagnosis, mut evidence) = samples::joint();
    let evil = "<script>alert(1)</script>";
    diagnosis.recording = evil.to_owned();
    diagnosis.located[0].condition = evil.to_owned();
    diagnosis.remarks = vec![evil.to_owned()];
    evidence.title = evil.to_owned();
    evidence.curves[0].channel = evil.to_owned();
    evidence.heat[0].rows[0].channel = evil.to_owned();
    evidence.ranking[0].why = evil.to_owned();
    assert!(!report_html(&diagnosis, &evidence).contains(evil));
}

#[test]
fn the_summary_for_a_terminal_is_stable() {
    let (diagnosis, evidence) = samples::joint();
    let text = summary_text(&diagnosis, &evidence);
    assert!(text.starts_with("EXPLAINED\n\n"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    assert!(lines.contains(&"joint-viscous-friction  joint:joint_3  b          0.9012 ± 0.0011 N m s/rad"), "{text}");
    assert!(lines.iter().any(|l| l.starts_with("all") && l.contains("holdout") && l.ends_with("1.006")), "{text}");
}

#[test]
fn the_json_form_is_the_documented_one_and_reads_back() {
    let (mut diagnosis, _) = samples::contact();
    diagnosis.error.runs[0].before = f64::INFINITY;
    let text = diagnosis.to_json().unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value["verdict"], "explained");
    assert_eq!(value["located"][0]["condition"], "in contact");
    assert_eq!(value["effects"][1]["std_err"]["com"][0], 4e-5);
    assert_eq!(value["effects"][0]["rivals"][0]["score_gap"], 7.4);
    assert_eq!(value["error"]["holdout"]["after"], 1.004);
    assert_eq!(value["error"]["runs"][3]["role"], "holdout");
    assert!(value["error"]["runs"][0]["before"].is_null(), "what is not finite is null");
    for key in ["fit", "holdout", "window_s", "windowed", "runs"] {
        assert!(!value["error"][key].is_null(), "{key}");
    }
    let back = Diagnosis::from_json(&text).unwrap();
    assert!(back.error.runs[0].before.is_nan());
    assert_eq!(back.effects, diagnosis.effects);
    let least = r#"{"verdict":"no-mismatch","located":[],"effects":[],"error":{"fit":{"before":1,"after":1},"holdout":null,
        "window_s":30,"windowed":{"before":1,"after":1},"runs":[]},"from_the_future":1}"#;
    assert_eq!(Diagnosis::from_json(least).unwrap().verdict, Verdict::NoMismatch);
}
