//! `softdock check FILE`: everything that is wrong with a scenario or a URDF, and everything that is doubtful, each once.

use crate::Status;
use anyhow::anyhow;
use softdock::multibody::{SearchPaths, Tree, UrdfErrors, UrdfFinding, UrdfWarnings, load_urdf};
use softdock::scenario::recording::{recorder_plan, scene};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Arguments of `softdock check`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Scenarios (.toml) or robots (.urdf)
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Refuse what is only doubtful, too
    #[arg(long)]
    strict: bool,
    /// Folder to look for package:// paths in (repeatable)
    #[arg(long = "package-path")]
    package_paths: Vec<PathBuf>,
    /// Override a key of the scenario, `path=value` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// A file that can be used.
struct Sound {
    line: String,
    /// Each is told once.
    warnings: Vec<String>,
    /// How many more there are.
    more: usize,
}

/// Checks every file; the first bad one does not hide the others.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let (mut bad, mut doubtful) = (0, 0);
    for file in &arguments.files {
        let result = if is_robot(file) { check_robot(file, arguments) } else { check_scenario(file, arguments) };
        match result {
            Ok(sound) => {
                sound.tell(file);
                doubtful += usize::from(!sound.warnings.is_empty());
            }
            Err(error) => {
                eprintln!("{error:#}");
                bad += 1;
            }
        }
    }
    let all = arguments.files.len();
    match (bad, doubtful) {
        (0, 1..) if arguments.strict => {
            Err(anyhow!("{doubtful} of {all} files have warnings, and --strict refuses them"))
        }
        (0, _) => Ok(Status::AsExpected),
        _ => Err(anyhow!("{bad} of {all} files cannot be used")),
    }
}

/// Whether a file is a robot by its name; else it is a scenario.
pub(crate) fn is_robot(file: &Path) -> bool {
    let extension = file.extension().unwrap_or_default();
    ["urdf", "xml", "xacro"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

impl Sound {
    fn tell(&self, file: &Path) {
        self.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        if self.more > 0 {
            eprintln!("… and {} more warnings", self.more);
        }
        let verdict = match self.warnings.len() + self.more {
            0 => "sound".to_owned(),
            1 => "loads, with 1 warning".to_owned(),
            n => format!("loads, with {n} warnings"),
        };
        println!("{}: {verdict}. {}", file.display(), self.line);
    }
}

fn check_robot(file: &Path, arguments: &Arguments) -> anyhow::Result<Sound> {
    let loaded =
        load_urdf(file, &SearchPaths::new(arguments.package_paths.clone())).map_err(|e| anyhow!(in_order(&e)))?;
    let (robot, tree) = (&loaded.robot, Tree::from_description(&loaded.robot));
    let line = format!(
        "Robot \"{}\": {} links in {} moving bodies, {} joint freedoms, {:.3} kg",
        robot.name,
        robot.links.len(),
        tree.bodies.len(),
        tree.nv,
        tree.mass()
    );
    let warnings = loaded.warnings.iter().map(ToString::to_string).collect();
    Ok(Sound { line, warnings, more: loaded.warnings.more() })
}

/// Errors and warnings of a file that does not load, in its order.
fn in_order(errors: &UrdfErrors) -> String {
    fn placed<W: Display>(mark: &str, finding: &UrdfFinding<W>) -> (Option<(usize, usize)>, String) {
        (finding.place.map(|p| (p.line, p.column)), format!("{mark}{finding}"))
    }
    let doubtful = errors.warnings().iter().map(|w| placed("warning: ", w));
    let mut told: Vec<_> = errors.iter().map(|e| placed("", e)).chain(doubtful).collect();
    told.sort_by_key(|(place, _)| *place);
    let more = [(errors.more(), "errors"), (errors.warnings().more(), "warnings")];
    let more = more.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("… and {n} more {what}"));
    told.into_iter().map(|(_, text)| text).chain(more).collect::<Vec<_>>().join("\n")
}

fn check_scenario(file: &Path, arguments: &Arguments) -> anyhow::Result<Sound> {
    let scenario = softdock::scenario::load(file, &arguments.set)?;
    let mission = softdock::scenario::build(&scenario)?;
    recorder_plan(&mission, &scene(&mission))?;
    let model = mission.world.model();
    let line = format!(
        "Scenario \"{}\": {} vehicles, {} contact pairs, {} actuators, {} steps of {} s",
        scenario.name,
        model.vehicles.len(),
        model.scene.pairs().len(),
        model.actuators.len(),
        mission.steps,
        model.step
    );
    let (mut warnings, mut more) = (Vec::new(), 0);
    for (_, found) in distinct(&mission) {
        warnings.extend(found.iter().map(ToString::to_string));
        more += found.more();
    }
    Ok(Sound { line, warnings, more })
}

/// What is doubtful in a scenario's robots, once for each file: two vehicles may be of one.
fn distinct(mission: &softdock::scenario::Mission) -> Vec<(&Path, &UrdfWarnings)> {
    let mut files: Vec<(&Path, &UrdfWarnings)> = Vec::new();
    for (robot, warnings) in mission.robots.iter().zip(&mission.robot_warnings) {
        if !files.iter().any(|(file, _)| *file == robot.file) {
            files.push((&robot.file, warnings));
        }
    }
    files
}

/// As [`hint`], once for each file of a scenario's robots.
pub(crate) fn hints(mission: &softdock::scenario::Mission) {
    distinct(mission).into_iter().for_each(|(file, warnings)| hint(file, warnings));
}

/// One line for a command that goes on: how much is doubtful in a robot's file, and who tells it.
pub(crate) fn hint(file: &Path, warnings: &UrdfWarnings) {
    let n = warnings.count();
    if n > 0 {
        let (file, s) = (file.display(), if n == 1 { "" } else { "s" });
        eprintln!("warning: {file} has {n} doubtful place{s}; `softdock check {file}` tells what was assumed");
    }
}
