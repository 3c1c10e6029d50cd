//! Prescribed motions of the file → driven bases of the world.

use super::faults::Faults;
use crate::spec::{self, DriveAxis, DriveMotion, Scenario, Strategy};
use record::Signals;
use sim::{Drive, DrivePath, Model};
use std::path::PathBuf;
use std::sync::Arc;

/// A driven coordinate with its name among the channels.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveChannel {
    /// The channel of a recording that holds it, `drive.stage.position.x`.
    pub channel: String,
    /// Whether its path is to come from a recording that the scenario does not name.
    pub awaits_recording: bool,
    /// Standard deviation of a sample of it, m or rad, where the scenario tells.
    pub noise: Option<f64>,
}

/// The model on its drives, and their channels in the order that [`Model::with_drive_paths`] takes.
pub(super) fn attach(scenario: &Scenario, model: Model, faults: &mut Faults<'_>) -> Option<(Model, Vec<DriveChannel>)> {
    let (mut drives, mut channels) = (Vec::new(), Vec::new());
    for (i, drive) in scenario.drives.iter().enumerate() {
        let site = Site { scenario, drive, key: format!("drive[{i}]") };
        if let Some((built, names)) = site.build(&model, faults) {
            drives.push(built);
            channels.extend(names);
        }
    }
    match model.with_drives(drives) {
        Ok(model) => Some((model, channels)),
        Err(error) => {
            faults.add("drive[0]", error.to_string());
            None
        }
    }
}

/// The entry that is being built.
struct Site<'a> {
    scenario: &'a Scenario,
    drive: &'a spec::Drive,
    key: String,
}

/// A coordinate, its path, and its channel.
type Coordinate = (DriveAxis, DrivePath, DriveChannel);

impl Site<'_> {
    fn build(&self, model: &Model, faults: &mut Faults<'_>) -> Option<(Drive, Vec<DriveChannel>)> {
        let Some(name) = &self.drive.vehicle else {
            let reason = "only bases of vehicles are driven in this version; drive a joint with an actuator of kind \
                          joint-drive and a high stiffness";
            faults.add(&format!("{}.joint", self.key), reason);
            return None;
        };
        let vehicle = model.vehicle(name)?;
        let coordinates = self.coordinates(faults)?;
        let frame = self.drive.pose.unwrap_or_default().pose();
        let start = self.scenario.vehicles[vehicle].pose.pose();
        let paths = coordinates.iter().map(|(axis, path, _)| (axis_of(*axis), Arc::new(path.clone()))).collect();
        let channels = coordinates.into_iter().map(|(_, _, channel)| channel).collect();
        Some((Drive { name: self.drive.name.clone(), vehicle, frame, start, paths }, channels))
    }

    fn coordinates(&self, faults: &mut Faults<'_>) -> Option<Vec<Coordinate>> {
        let known = |axis, path| (axis, path, self.channel(axis));
        Some(match &self.drive.motion {
            DriveMotion::Sine { amplitude_deg, amplitude_m, frequency_hz, phase_deg } => {
                let (axis, amplitude) = either(*amplitude_deg, *amplitude_m);
                vec![known(axis, DrivePath::sine(amplitude, *frequency_hz, phase_deg.to_radians()))]
            }
            DriveMotion::Ramp { velocity_deg_per_s, velocity_m_per_s } => {
                let (axis, rate) = either(*velocity_deg_per_s, *velocity_m_per_s);
                vec![known(axis, DrivePath::ramp(rate))]
            }
            DriveMotion::Points { points_s_deg, points_s_m, points_s_xyz_m } => {
                let radians: Vec<_> = points_s_deg.iter().map(|p| [p[0], p[1].to_radians()]).collect();
                let axes = [DriveAxis::X, DriveAxis::Y, DriveAxis::Z].into_iter().enumerate();
                let of_axis = |k: usize| points_s_xyz_m.iter().map(|p| [p[0], p[1 + k]]).collect::<Vec<_>>();
                if !points_s_xyz_m.is_empty() {
                    axes.map(|(k, axis)| known(axis, DrivePath::through(&of_axis(k)))).collect()
                } else if radians.is_empty() {
                    vec![known(DriveAxis::Z, DrivePath::through(points_s_m))]
                } else {
                    vec![known(DriveAxis::Yaw, DrivePath::through(&radians))]
                }
            }
            DriveMotion::Recording { channel, channels, noise, .. } => {
                let named = channel.iter().map(|c| (DriveAxis::Z, c));
                let all: Vec<_> = named.chain(channels.iter().map(|(a, c)| (*a, c))).collect();
                return self.recorded(&all, *noise, faults);
            }
        })
    }

    /// The channel that a coordinate has in recordings.
    fn channel(&self, axis: DriveAxis) -> DriveChannel {
        let component = match axis {
            DriveAxis::X => "position.x",
            DriveAxis::Y => "position.y",
            DriveAxis::Z => "position.z",
            DriveAxis::Yaw => "angle",
        };
        DriveChannel { channel: format!("drive.{}.{component}", self.drive.name), awaits_recording: false, noise: None }
    }

    fn recorded(
        &self,
        channels: &[(DriveAxis, &String)],
        noise: Option<f64>,
        faults: &mut Faults<'_>,
    ) -> Option<Vec<Coordinate>> {
        let Some(file) = self.file() else {
            let waiting = |name: &String| DriveChannel { channel: name.clone(), awaits_recording: true, noise };
            return Some(channels.iter().map(|(a, name)| (*a, DrivePath::ramp(0.0), waiting(name))).collect());
        };
        let recording = match read(&file) {
            Ok(recording) => recording,
            Err(error) => {
                faults.add(&format!("{}.file", self.key), format!("the recording cannot be read: {error}"));
                return None;
            }
        };
        let path_of = |(axis, name): &(DriveAxis, &String)| {
            let Some(values) = recording.values(name) else {
                let valid: Vec<&str> = recording.channels.iter().map(|c| c.spec.name.as_str()).collect();
                faults.unknown(&format!("{}.channels", self.key), "channel", name, valid);
                return None;
            };
            let path = DrivePath::smoothed(&recording.times, values, noise);
            Some((*axis, path, DriveChannel { channel: (*name).clone(), awaits_recording: false, noise }))
        };
        channels.iter().map(path_of).collect()
    }

    /// The recording that it follows: its own, or that of the strategy.
    fn file(&self) -> Option<PathBuf> {
        let DriveMotion::Recording { file, .. } = &self.drive.motion else { return None };
        let of_strategy = match &self.scenario.strategy {
            Strategy::Replay(replay) => Some(&replay.file),
            _ => None,
        };
        file.as_ref().or(of_strategy).map(|file| self.scenario.source.file_dir().join(file))
    }
}

fn read(file: &std::path::Path) -> Result<Signals, record::RecordError> {
    match file.extension().and_then(|e| e.to_str()) {
        Some("parquet") => record::read_parquet(file).map(|(_, signals)| signals),
        _ => record::read_csv(file),
    }
}

/// An angle in degrees about z, or a displacement along it.
fn either(deg: Option<f64>, m: Option<f64>) -> (DriveAxis, f64) {
    match (deg, m) {
        (Some(deg), _) => (DriveAxis::Yaw, deg.to_radians()),
        (None, m) => (DriveAxis::Z, m.unwrap_or(0.0)),
    }
}

fn axis_of(axis: DriveAxis) -> sim::DriveAxis {
    match axis {
        DriveAxis::X => sim::DriveAxis::X,
        DriveAxis::Y => sim::DriveAxis::Y,
        DriveAxis::Z => sim::DriveAxis::Z,
        DriveAxis::Yaw => sim::DriveAxis::AboutZ,
    }
}
