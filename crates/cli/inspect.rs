//! `softdock inspect RECORDING`: what is in a recording, and whether it can be trusted.

use crate::Status;
use serde_json::{Map, Value};
use softdock::record::inspect::{self, Inspection};
use softdock::record::{self, OutputFolder, RecordingSet, Severity, plot};
use std::path::PathBuf;

/// Arguments of `softdock inspect`.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
RECORDING is a folder with recording.toml:
  format = 1
  rig    = \"tumbler\"
  [noise]                                     # 1 sigma, SI, by channel or prefix (orientation: rad)
  \"body.target.angular_velocity\" = 2.0e-4
  [[run]]
  file = \"run-01.csv\"                         # or .parquet; first column t in s, empty cell: not sampled
  role = \"fit\"                                # or holdout
Foreign columns are mapped:
  [time]
  column = \"t_ms\"                             # default t
  unit   = \"ms\"                               # default s
  group  = \"toss\"                             # optional: every new value starts a run; [[run]] may choose
                                              # groups = [\"0-99\", 120]
  [channels]
  \"body.cube.angular_velocity.x\" = { column = \"wx\", unit = \"deg/s\", scale = -1.0 }

Exit status: 0; 1 where the data contradict themselves (wrong units, mirrored axes); 3 unreadable.")]
pub(crate) struct Arguments {
    /// Folder with recording.toml, or one run file (.csv, .parquet)
    recording: PathBuf,
    /// Folder for inspection.json and channels.svg
    #[arg(long)]
    out: Option<PathBuf>,
    /// Print inspection.json in place of the tables
    #[arg(long)]
    json: bool,
}

/// Reads, looks, prints.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let folder = arguments.out.as_deref().map(OutputFolder::create).transpose()?;
    let set = RecordingSet::load(&arguments.recording)?;
    let inspection = inspect::inspect(&set);
    let document = inspection.to_json();
    match arguments.json {
        true => println!("{document:#}"),
        false => print!("{}", inspect::to_text(&inspection)),
    }
    if let Some(folder) = folder {
        record::write_file(&folder.file("inspection.json"), format!("{document:#}\n").as_bytes())?;
        record::write_file(&folder.file("channels.svg"), plot::recording_svg(&set).as_bytes())?;
        let place = folder.finish(&summary(arguments, &inspection))?;
        eprintln!("The figures and the plot are in {}", place.display());
    }
    let is_fault = inspection.worst() == Some(Severity::Fault);
    Ok(if is_fault { Status::NotAsExpected } else { Status::AsExpected })
}

fn summary(arguments: &Arguments, inspection: &Inspection) -> Map<String, Value> {
    let count = |severity| inspection.remarks.iter().filter(|r| r.severity == severity).count();
    let mut map = Map::new();
    let mut add = |key: &str, value: Value| map.insert(key.to_owned(), value);
    add("recording", arguments.recording.display().to_string().into());
    add("version", env!("CARGO_PKG_VERSION").into());
    add("runs", inspection.runs.len().into());
    for severity in [Severity::Fault, Severity::Warning, Severity::Note] {
        add(severity.key(), count(severity).into());
    }
    map
}
