//! `softdock view FILE`: a URDF, or a scenario at t = 0, as a recording for the viewer.

use crate::{Status, check};
use softdock::multibody::{SearchPaths, load_urdf};
use softdock::record::{Log, Meta, OutputFolder, Recorder, Sample, Scene, SceneVehicle};
use softdock::scenario::recording;
use softdock::sim::Observer;
use softdock::{multibody, scenario};
use std::path::{Path, PathBuf};

/// Arguments of `softdock view`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// A robot (.urdf) or a scenario (.toml)
    file: PathBuf,
    /// Folder for view.rrd [default: out/view-NAME]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Folder to look for package:// paths in (repeatable)
    #[arg(long = "package-path")]
    package_paths: Vec<PathBuf>,
    /// Override a key of the scenario, `path=value` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Open a Rerun viewer
    #[arg(long)]
    spawn: bool,
}

/// Writes the recording, and opens it where asked.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let is_robot = check::is_robot(&arguments.file);
    let (log, scene) = if is_robot { robot(arguments)? } else { start_of_scenario(arguments)? };
    let name = arguments.file.file_stem().map_or_else(|| "view".to_owned(), |s| s.to_string_lossy().into_owned());
    let target = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(format!("view-{name}")));
    let folder = OutputFolder::create(&target)?;
    write(&folder, &log, &scene, &name)?;
    let mut summary = serde_json::Map::new();
    summary.insert("view".to_owned(), name.into());
    let place = folder.finish(&summary)?;
    println!("{0}/view.rrd is written; see it with: rerun {0}/view.rrd", place.display());
    if arguments.spawn {
        std::process::Command::new("rerun").arg(place.join("view.rrd")).spawn().map_err(|e| {
            anyhow::anyhow!("the viewer `rerun` did not start ({e}); get it with: pip install rerun-sdk==0.36.3")
        })?;
    }
    Ok(Status::AsExpected)
}

#[cfg(feature = "rerun")]
fn write(folder: &OutputFolder, log: &Log, scene: &Scene, name: &str) -> anyhow::Result<()> {
    softdock::record::rerun_sink::write_rrd(&folder.file("view.rrd"), log, scene, &format!("# {name}"))?;
    Ok(())
}

#[cfg(not(feature = "rerun"))]
fn write(_: &OutputFolder, _: &Log, _: &Scene, _: &str) -> anyhow::Result<()> {
    anyhow::bail!("this build has no Rerun output; build with the feature `rerun` (it is on by default)")
}

fn start_of_scenario(arguments: &Arguments) -> anyhow::Result<(Log, Scene)> {
    let mission = scenario::build(&scenario::load(&arguments.file, &arguments.set)?)?;
    let scene = recording::scene(&mission);
    let plan = recording::recorder_plan(&mission, &scene)?;
    let mut recorder = Recorder::new(&mission.world, plan, None);
    recorder.observe(&mission.world);
    if let Some(error) = recorder.error.take() {
        return Err(error.into());
    }
    Ok((std::mem::take(&mut recorder.log), scene))
}

fn robot(arguments: &Arguments) -> anyhow::Result<(Log, Scene)> {
    let loaded = load_urdf(&arguments.file, &SearchPaths::new(arguments.package_paths.clone()))?;
    check::hint(&arguments.file, &loaded.warnings);
    let robot = loaded.robot;
    let tree = multibody::Tree::from_description(&robot);
    let mut kin = multibody::Kinematics::new(&tree);
    let mut q = tree.q_zero.clone();
    for joint in tree.joints.iter().filter(|j| !j.is_mimic) {
        if let Some([lower, upper]) = joint.position_limits {
            q[joint.q_index] = 0.0_f64.clamp(lower, upper);
        }
    }
    kin.update_positions(&tree, &softdock::spatial::Pose::identity(), &q);
    let poses: Vec<_> = (0..tree.links.len()).map(|l| kin.link_frame(&tree, l).to_pose()).collect();
    let scene = Scene { vehicles: vec![SceneVehicle::from_robot(&robot.name, &robot)], ..Scene::default() };
    let meta = Meta { scenario: robot.name.clone(), version: env!("CARGO_PKG_VERSION").to_owned(), ..Meta::default() };
    let mut log = Log::new(meta, Vec::new(), scene.link_count());
    log.push(&Sample { t: 0.0, step: 0, values: &[], poses_w: &poses, contacts: &[] })?;
    Ok((log, scene))
}
