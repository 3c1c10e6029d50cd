//! A table of malformed inputs and what must be said of them.

use multibody::{SearchPaths, parse_urdf};
use std::path::Path;
use std::sync::mpsc;
use std::time::Duration;

/// Longer is a hang; the slowest case takes a second.
const PATIENCE: Duration = Duration::from_secs(60);

/// One malformed input.
pub struct Case {
    /// What is wrong with it.
    pub name: &'static str,
    /// The URDF.
    pub text: String,
    /// Fragments that the message must have: place, subject, fault.
    pub expected: Vec<String>,
}

impl Case {
    /// A case of texts alone.
    pub fn new(name: &'static str, text: impl Into<String>, expected: &[&str]) -> Self {
        Self { name, text: text.into(), expected: expected.iter().map(|e| (*e).to_owned()).collect() }
    }
}

/// Loads every case, and checks that each is refused with its message, in time and without a panic.
pub fn check(cases: Vec<Case>, base_dir: &Path) {
    assert!(!cases.is_empty());
    let mut failures = Vec::new();
    for case in cases {
        let said = message_of(case.text, base_dir.into());
        let missing: Vec<&String> = case.expected.iter().filter(|e| !said.contains(*e)).collect();
        if !missing.is_empty() {
            failures.push(format!("{}: {missing:?} not in:\n{said}", case.name));
        }
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n\n"));
}

/// Loads every case, and checks that each loads with its warning and no other.
pub fn check_doubts(cases: Vec<Case>, base_dir: &Path) {
    assert!(!cases.is_empty());
    let mut failures = Vec::new();
    for case in cases {
        let loaded = parse_urdf(&case.text, Path::new("bad.urdf"), base_dir, &SearchPaths::default());
        let said = loaded.map_or_else(|e| format!("it does not load:\n{e}"), |l| l.warnings.to_string());
        let missing: Vec<&String> = case.expected.iter().filter(|e| !said.contains(*e)).collect();
        if !missing.is_empty() || said.lines().count() != 1 {
            failures.push(format!("{}: one line with {missing:?} is not:\n{said}", case.name));
        }
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n\n"));
}

fn message_of(text: String, base_dir: std::path::PathBuf) -> String {
    let (tell, hear) = mpsc::channel();
    std::thread::spawn(move || {
        let result = parse_urdf(&text, Path::new("bad.urdf"), &base_dir, &SearchPaths::default());
        let _ = tell.send(result.map_or_else(|e| e.to_string(), |_| "it loads".to_owned()));
    });
    hear.recv_timeout(PATIENCE).unwrap_or_else(|e| format!("no answer: {e}"))
}

/// A robot of the links `base` and `tip` and the revolute joint `elbow`; its first line is line 1, `tags` are line 2.
pub fn robot(tags: &str) -> String {
    format!("<robot name=\"bad\">\n{tags}\n</robot>")
}

/// A sound link.
pub fn link(name: &str) -> String {
    format!("<link name=\"{name}\">{SOUND_INERTIAL}</link>")
}

/// Mass properties of a rigid body.
pub const SOUND_INERTIAL: &str =
    r#"<inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>"#;

/// A sound joint.
pub fn joint(name: &str, parent: &str, child: &str) -> String {
    format!(
        r#"<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="1"/></joint>"#
    )
}

/// A robot whose one link has this `<inertial>`, in line 3.
pub fn robot_with_inertial(inertial: &str) -> String {
    robot(&format!("<link name=\"palm\">\n{inertial}\n</link>"))
}

/// `base`, `tip` and between them a joint with this inside, in line 4.
pub fn robot_with_joint(kind: &str, inside: &str) -> String {
    let (base, tip) = (link("base"), link("tip"));
    robot(&format!(
        "{base}{tip}<joint name=\"elbow\" type=\"{kind}\">\n<parent link=\"base\"/><child link=\"tip\"/>\n{inside}\n</joint>"
    ))
}
