//! What a recording does not have and a diagnosis cannot do without: runs to fit, readings, and commands.
//!
//! A model does not do what it is not told to: a column of commands that is missing is blamed on the physics.

use crate::error::DiagnoseError;
use crate::number::short;
use crate::plant::{Built, Plant};
use crate::tape::Tape;
use record::{RecordingSet, Role, Series};
use sim::{ActuatorKind, Model};

/// Instants at which something is read that a run has at least: with fewer nothing but its start is told.
const FEWEST: usize = 4;
/// Share of a run after which its first command comes late.
const LATE: f64 = 0.02;

/// Refuses a recording that cannot be diagnosed.
pub(crate) fn refuse_too_little(tapes: &[Tape]) -> Result<(), DiagnoseError> {
    for tape in tapes {
        let mut instants: Vec<f64> = tape.events.iter().map(|e| e.time).collect();
        instants.dedup();
        if instants.len() < FEWEST {
            let (file, count) = (&tape.file, instants.len());
            return Err(DiagnoseError::TooLittle(format!(
                "{file} was read at {count} instants, and a run needs {FEWEST}; take it out of recording.toml"
            )));
        }
    }
    match tapes.iter().any(|t| t.role == Role::Fit) {
        true => Ok(()),
        false => Err(DiagnoseError::TooLittle(
            "none of its runs may be fitted; write role = \"fit\" in recording.toml for one at least".to_owned(),
        )),
    }
}

/// Whether the commands of thrusters are forces, N, and no shares of what these can do: a share is at most one.
pub(crate) fn has_thrusts(set: &RecordingSet, plant: &Plant, model: &Model) -> bool {
    let is_thruster = |channel: &str| {
        let found = plant.actuator(model, channel).and_then(Result::ok);
        found.is_some_and(|(i, ..)| matches!(model.actuators[i].kind, ActuatorKind::Thruster { .. }))
    };
    let is_beyond = |series: &&Series| series.values.iter().any(|v| v.abs() > 1.0 + ROUNDED);
    let series = set.runs.iter().flat_map(|run| &run.series).filter(|s| s.channel.starts_with("actuator."));
    series.filter(is_beyond).any(|s| is_thruster(&s.channel))
}

/// What a share may exceed one by for being rounded.
const ROUNDED: f64 = 1e-3;

/// Commands that some or all runs do not have, in words.
pub(crate) fn said_of_commands(built: &Built, tapes: &[Tape]) -> Vec<String> {
    let first = |tape: &Tape, actuator: usize| {
        let own = tape.commands.iter().filter(|c| c.actuator == actuator);
        own.filter_map(|c| c.times.first().copied()).reduce(f64::min)
    };
    let (mut never, mut said) = (Vec::new(), Vec::new());
    for (a, actuator) in built.model.actuators.iter().enumerate() {
        let name = &actuator.name;
        let begins: Vec<(&Tape, Option<f64>)> = tapes.iter().map(|t| (t, first(t, a))).collect();
        if begins.iter().all(|(_, begin)| begin.is_none()) {
            never.push(name.as_str());
            continue;
        }
        let missing: Vec<&str> = begins.iter().filter(|b| b.1.is_none()).map(|(t, _)| t.file.as_str()).collect();
        if !missing.is_empty() {
            let files = missing.join(", ");
            said.push(format!(
                "{files}: no command of {name}, which other runs have; the model takes it for idle there."
            ));
        }
        for (tape, begin) in begins {
            let late = begin.map_or(0.0, |begin| begin - tape.span.0);
            if late > LATE * (tape.span.1 - tape.span.0) {
                let (file, late) = (&tape.file, short(late));
                said.push(format!(
                    "{file}: the command of {name} begins {late} s late; before, the model takes it for idle."
                ));
            }
        }
    }
    if !never.is_empty() {
        let names = never.join(", ");
        said.push(format!("No run has a command of {names}: the model takes what is not commanded for idle."));
    }
    said
}
