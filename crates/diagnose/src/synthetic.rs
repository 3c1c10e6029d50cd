//! Recordings that a rig would have made if it were the scenario: the same commands, sensors, rates and roundings, other physics.
//!
//! For planning (would this rig show a payload of 50 g at all?) and for tests: what was planted must be found again.

use crate::error::DiagnoseError;
use crate::guess::guess;
use crate::linear::Stage;
use crate::noise;
use crate::pace;
use crate::plant::{Built, Plant};
use crate::reading::Value;
use crate::replay::{Pace, Span, observe};
use crate::start::Start;
use crate::stretches::cut;
use crate::tape::{Tape, load};
use crate::work::Work;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use record::{RecordedRun, RecordingSet, Series};
use scenario::Scenario;
use spatial::{Vec3, exp_rotation};

/// Where a run starts.
pub type Starts<'a> = dyn Fn(&Built, &Tape) -> Start + 'a;

/// Starts at what the samples of the recording say of its first instant.
pub fn as_recorded(built: &Built, tape: &Tape) -> Start {
    guess(built, tape, tape.span.0)
}

/// Steps are as many times finer than a diagnosis takes them.
const FINER: f64 = 4.0;

/// Replays the scenario, its effects included, along the commands of a recording, and reads it by the sensors of that recording: at the same
/// instants, with white noise by its noise figures, and rounded alike. The same seed gives the same recording.
pub fn synthesise(
    scenario: Scenario,
    like: &RecordingSet,
    starts: &Starts<'_>,
    seed: u64,
) -> Result<RecordingSet, DiagnoseError> {
    let mut plant = Plant::new(scenario);
    let (tapes, built) = load(&mut plant, like)?;
    let own = plant.scenario.integrator.step_s;
    let work = Work::new(&(), 1.0);
    let stage = Stage { tapes: &tapes, pace: Pace::even(own), work: &work, doubt: noise::STATED, hears: None };
    let found = pace::choose(&stage, (&built, &[]), &cut(&built, &tapes, None, |_| true), own).pace;
    let pace = Pace { step: found.step / FINER, free: found.free / FINER, ..found };
    let of_run = |(recorded, tape): (&RecordedRun, &Tape)| -> Result<RecordedRun, DiagnoseError> {
        let mut values: Vec<Vec<Value>> = tape.readings.iter().map(|r| r.values.clone()).collect();
        let span = Span { from: tape.span.0, to: tape.span.1 };
        observe(&built, tape, &starts(&built, tape), span, pace, |_, event, value| {
            values[event.reading as usize][event.sample as usize] = *value;
        })?;
        for (i, (reading, values)) in tape.readings.iter().zip(&mut values).enumerate() {
            let sigma = like.sigma(&reading.component(0)).unwrap_or(0.0);
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            random.set_stream(((tape.index as u64) << 32) | i as u64);
            values.iter_mut().for_each(|v| *v = v.disturbed(&white(&mut random, sigma)));
        }
        let series = recorded.series.iter().map(|s| read_as(s, tape, &values)).collect();
        Ok(RecordedRun { file: format!("run-{:02}.csv", tape.index + 1), series, ..recorded.clone() })
    };
    let runs = like.runs.iter().zip(&tapes).map(of_run).collect::<Result<_, _>>()?;
    Ok(RecordingSet { runs, remarks: Vec::new(), title: plant.scenario.name.clone(), ..like.clone() })
}

fn white(random: &mut ChaCha8Rng, sigma: f64) -> Vec3 {
    Vec3::from_fn(|_, _| {
        let x: f64 = StandardNormal.sample(random);
        sigma * x
    })
}

/// A series as the readings of its channel make it; commands and drives as they are.
fn read_as(series: &Series, tape: &Tape, values: &[Vec<Value>]) -> Series {
    let reads = |(reading, values): (&crate::reading::Reading, &Vec<Value>)| {
        let part =
            series.channel.strip_prefix(reading.channel.as_str()).filter(|_| reading.times[..] == series.times[..])?;
        let read = |value: &Value| value.component(part.strip_prefix('.').unwrap_or(""));
        values.iter().map(read).collect::<Option<Vec<f64>>>()
    };
    let Some(values) = tape.readings.iter().zip(values).find_map(reads) else { return series.clone() };
    let quantum = series.quantum();
    let rounded = |x: f64| if quantum > 0.0 { (x / quantum).round() * quantum } else { x };
    Series::with_quantum(&series.channel, series.times.clone(), values.into_iter().map(rounded).collect(), quantum)
}

impl Value {
    /// The value with some noise on it: of an orientation a turn about body axes.
    fn disturbed(&self, noise: &Vec3) -> Self {
        match self {
            Self::Vector(v) => Self::Vector(v + noise),
            Self::Rotation(q) => Self::Rotation(q * exp_rotation(noise)),
        }
    }

    /// A component by its letter; of a scalar, which has none, the value.
    fn component(&self, letter: &str) -> Option<f64> {
        match (self, letter) {
            (Self::Vector(v), "" | "x") => Some(v.x),
            (Self::Vector(v), "y") => Some(v.y),
            (Self::Vector(v), "z") => Some(v.z),
            (Self::Rotation(q), "w") => Some(q.w),
            (Self::Rotation(q), "x") => Some(q.i),
            (Self::Rotation(q), "y") => Some(q.j),
            (Self::Rotation(q), "z") => Some(q.k),
            _ => None,
        }
    }
}
