//! One run from its start to its verdicts: for the command, campaigns, regressions, replays and whoever uses the library.

use crate::Mission;
use crate::outcome::{Judge, Outcome, Verdict, check_expectations};
use record::{Event, EventKind, Log, RecordError, Recorder};
use sim::{Observer, StepError, Work};

/// A run that is over.
#[derive(Debug)]
pub struct Finished {
    /// The mission, its world as the run left it.
    pub mission: Mission,
    /// Whether it came to its end, or why not.
    pub ended: Result<(), StepError>,
    /// What became of it.
    pub outcome: Outcome,
    /// What the scenario expected of it, and whether it was so.
    pub verdicts: Vec<Verdict>,
    /// What was recorded, with the run's events.
    pub log: Option<Log>,
}

/// Runs a mission to its end, before whoever wants to watch. Errors: a sample that could not be recorded, which ends the run.
pub fn run(
    mut mission: Mission,
    mut recorder: Option<Recorder<'_>>,
    observers: &mut [&mut dyn Observer],
) -> Result<Finished, RecordError> {
    let mut judge = Judge::new(&mission);
    let ended = {
        let mut all: Vec<&mut dyn Observer> = vec![&mut judge];
        all.extend(recorder.as_mut().map(|r| r as &mut dyn Observer));
        for observer in observers {
            all.push(&mut **observer);
        }
        mission.world.run(mission.steps, &*mission.controller, &mut all)
    };
    if let Some(error) = recorder.as_mut().and_then(|r| r.error.take()) {
        return Err(error);
    }
    let outcome = judge.conclude(&mission.world, &ended);
    let verdicts = check_expectations(&mission.scenario.expects, &outcome);
    let log = recorder.map(|r| with_events(r.log, &outcome, &ended));
    Ok(Finished { mission, ended, outcome, verdicts, log })
}

fn with_events(mut log: Log, outcome: &Outcome, ended: &Result<(), StepError>) -> Log {
    log.events.clone_from(&outcome.events);
    if let Err(error) = ended {
        let (t, text) = (log.signals.times.last().copied().unwrap_or(0.0), error.to_string());
        log.events.push(Event { t, step: 0, kind: EventKind::Loss, text });
    }
    log
}

impl Finished {
    /// What it cost.
    pub fn work(&self) -> Work {
        self.mission.world.state().work
    }

    /// Whether all was as the scenario expected.
    pub fn is_as_expected(&self) -> bool {
        self.verdicts.iter().all(|verdict| verdict.met)
    }
}
