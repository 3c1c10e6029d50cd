//! Driven bases of a model.

use super::Model;
use crate::error::ModelError;
use crate::parts::{Base, Drive, DriveAxis, DrivePath};
use std::sync::Arc;

impl Model {
    /// The model with driven bases: their vehicles were declared [`Base::Fixed`].
    pub fn with_drives(mut self, drives: Vec<Drive>) -> Result<Self, ModelError> {
        for (k, drive) in drives.iter().enumerate() {
            let refuse = |fault: &str| Err(ModelError::Drive { name: drive.name.clone(), fault: fault.to_owned() });
            let Some(vehicle) = self.vehicles.get_mut(drive.vehicle) else { return refuse("drives no vehicle") };
            if vehicle.base != Base::Fixed {
                return refuse("drives a base that is not held; give its vehicle base = \"fixed\", or another vehicle");
            }
            let twice = |(i, (axis, _)): (usize, &(DriveAxis, Arc<DrivePath>))| {
                drive.paths[..i].iter().any(|(other, _)| other == axis)
            };
            if drive.paths.iter().enumerate().any(twice) {
                return refuse("has two paths for one axis; keep one of them");
            }
            vehicle.base = Base::Driven(k);
        }
        self.drives = drives;
        Ok(self)
    }

    /// The same model on other paths: one per driven coordinate, drive by drive in the order of [`Drive::paths`]. Paths
    /// beyond `paths` stay what they were. Cheap beside a run, not beside a step: the rest of the model is copied.
    pub fn with_drive_paths(&self, paths: impl IntoIterator<Item = Arc<DrivePath>>) -> Self {
        let mut model = self.clone();
        let slots = model.drives.iter_mut().flat_map(|d| &mut d.paths);
        slots.zip(paths).for_each(|((_, slot), path)| *slot = path);
        model
    }

    /// The driven coordinates in the order that [`Self::with_drive_paths`] takes: name of the drive, and axis.
    pub fn driven_coordinates(&self) -> impl Iterator<Item = (&str, DriveAxis)> + '_ {
        self.drives.iter().flat_map(|d| d.paths.iter().map(|(axis, _)| (d.name.as_str(), *axis)))
    }
}
