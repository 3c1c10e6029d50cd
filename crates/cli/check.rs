//! `softdock check FILE`: everything that is wrong with a scenario or a URDF, at once.

use crate::Status;
use anyhow::anyhow;
use softdock::multibody::{SearchPaths, Tree, load_urdf};
use softdock::scenario::recording::{recorder_plan, scene};
use std::path::{Path, PathBuf};

/// Arguments of `softdock check`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Scenarios (.toml) or robots (.urdf)
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Folder to look for package:// paths in (repeatable)
    #[arg(long = "package-path")]
    package_paths: Vec<PathBuf>,
    /// Override a key of the scenario, `path=value` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// Checks every file; the first bad one does not hide the others.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let mut bad = 0;
    for file in &arguments.files {
        let is_robot = file.extension().is_some_and(|e| e == "urdf" || e == "xml");
        let result = if is_robot { check_robot(file, arguments) } else { check_scenario(file, arguments) };
        match result {
            Ok(line) => println!("{}: sound. {line}", file.display()),
            Err(error) => {
                eprintln!("{error:#}");
                bad += 1;
            }
        }
    }
    if bad > 0 {
        return Err(anyhow!("{bad} of {} files cannot be used", arguments.files.len()));
    }
    Ok(Status::AsExpected)
}

fn check_robot(file: &Path, arguments: &Arguments) -> anyhow::Result<String> {
    let robot = load_urdf(file, &SearchPaths::new(arguments.package_paths.clone()))?;
    let tree = Tree::from_description(&robot);
    Ok(format!(
        "Robot \"{}\": {} links in {} moving bodies, {} joint freedoms, {:.3} kg",
        robot.name,
        robot.links.len(),
        tree.bodies.len(),
        tree.nv,
        tree.mass()
    ))
}

fn check_scenario(file: &Path, arguments: &Arguments) -> anyhow::Result<String> {
    let scenario = softdock::scenario::load(file, &arguments.set)?;
    let mission = softdock::scenario::build(&scenario)?;
    recorder_plan(&mission, &scene(&mission))?;
    let model = mission.world.model();
    Ok(format!(
        "Scenario \"{}\": {} vehicles, {} contact pairs, {} actuators, {} steps of {} s",
        scenario.name,
        model.vehicles.len(),
        model.scene.pairs().len(),
        model.actuators.len(),
        mission.steps,
        model.step
    ))
}
