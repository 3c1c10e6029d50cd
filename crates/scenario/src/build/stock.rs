//! What builds of one scenario share: robots that were loaded, collision shapes that were prepared.
//!
//! Nothing of a result depends on it: with or without a stock, a build is the same to the bit. Files are read once, so that a
//! robot that is edited while a campaign runs does not change half of its runs.

use super::Mission;
use contact::Scene;
use multibody::{LoadedUrdf, SearchPaths, UrdfErrors, load_urdf};
use sim::Model;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Robots and shapes, ready to be used again.
#[derive(Clone, Debug, Default)]
pub struct Stock {
    robots: Vec<(PathBuf, Vec<PathBuf>, LoadedUrdf)>,
    model: Option<Arc<Model>>,
}

impl Stock {
    /// Keeps the shapes of a mission, and loads its robots once more, as their files have them.
    pub fn of(mission: &Mission) -> Self {
        let scenario = &mission.scenario;
        let dir = scenario.source.file_dir();
        let mut stock = Self { robots: Vec::new(), model: Some(Arc::clone(mission.world.model())) };
        for vehicle in &scenario.vehicles {
            let folders: Vec<PathBuf> = vehicle.package_paths.iter().map(|p| dir.join(p)).collect();
            let file = dir.join(&vehicle.urdf);
            // The mission has loaded it; should it have gone meanwhile, the next build will say so.
            if let Ok(robot) = load_urdf(&file, &SearchPaths::new(folders.iter().cloned())) {
                stock.robots.push((file, folders, robot));
            }
        }
        stock
    }

    /// The robot of a file, from the stock or from the disk.
    pub(super) fn robot(&self, file: &Path, folders: &[PathBuf]) -> Result<LoadedUrdf, UrdfErrors> {
        match self.robots.iter().find(|(f, p, _)| f == file && p == folders) {
            Some((_, _, robot)) => Ok(robot.clone()),
            None => load_urdf(file, &SearchPaths::new(folders.iter().cloned())),
        }
    }

    /// Shapes that are prepared.
    pub(super) fn scene(&self) -> Option<&Scene> {
        self.model.as_ref().map(|model| &model.scene)
    }
}
