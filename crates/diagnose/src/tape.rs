//! A recorded run, made ready for replay: commands, readings, and the order in which they come.

use crate::error::DiagnoseError;
use crate::identify::coarse::heard_in_cells;
use crate::limits;
use crate::noise;
use crate::plant::{Built, Plant};
use crate::reading::{Reading, Value};
use crate::replay::{SAME, Span};
use crate::unheard;
use record::{RecordedRun, RecordingSet, Role, Series, median_step};
use scenario::measure::{MeasureError, Quantity};
use sim::Model;
use spatial::{Rot, Vec3, nalgebra};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What of an actuator is commanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Commanded {
    /// Its effort, N or N·m; of a drive the feed-forward.
    Effort,
    /// The reference of a position loop, rad or m.
    Position,
    /// The reference of a rate loop, rad/s or m/s.
    Velocity,
}

/// One command of one actuator, each value held until the next.
#[derive(Clone, Debug)]
pub struct CommandTape {
    /// Index of the actuator.
    pub actuator: usize,
    /// What of it is commanded.
    pub what: Commanded,
    /// Ticks, s.
    pub times: Vec<f64>,
    /// Values, SI units.
    pub values: Vec<f64>,
}

impl CommandTape {
    /// The instants at which it changes, s.
    pub(crate) fn changes(&self) -> impl Iterator<Item = f64> + '_ {
        let changes = |i: &usize| i.checked_sub(1).is_none_or(|before| self.values[*i] != self.values[before]);
        (0..self.times.len()).filter(changes).map(|i| self.times[i])
    }
}

/// One sample of one reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// When the sensor read, s.
    pub time: f64,
    /// Which reading.
    pub reading: u32,
    /// Which of its samples.
    pub sample: u32,
}

/// One run.
#[derive(Clone, Debug)]
pub struct Tape {
    /// Number of the run in its set.
    pub index: usize,
    /// File of the run.
    pub file: String,
    /// Whether it may be used to find and fit a model.
    pub role: Role,
    /// Commands.
    pub commands: Vec<CommandTape>,
    /// Readings.
    pub readings: Vec<Reading>,
    /// All samples by time, readings in order where they are simultaneous.
    pub events: Vec<Event>,
    /// Where each event's residual begins among those of the whole run; one more than there are events.
    pub offsets: Vec<usize>,
    /// Instants at which commands change, ascending.
    pub ticks: Vec<f64>,
    /// First and last sample, s.
    pub span: (f64, f64),
    /// Samples per second of its fastest sensor, as it was recorded; infinite where nothing is sampled twice.
    pub rate: f64,
    /// The same commands at coarser clocks, the finest first.
    pub(crate) coarser: Vec<Hearing>,
}

/// A run's commands as their means over cells: derivatives need not hear every tick.
#[derive(Clone, Debug)]
pub(crate) struct Hearing {
    /// Longest cell, s.
    longest: f64,
    /// Commands without readings.
    tape: Arc<Tape>,
}

impl Tape {
    /// Matches a run's channels with the scenario's quantities.
    ///
    /// Channels that the scenario does not know are errors; those that only tell what was commanded or driven are inputs.
    /// Commands of thrusters are shares of their force, or that force itself (`in_newtons`).
    pub fn new(
        set: &RecordingSet,
        run: &RecordedRun,
        plant: &Plant,
        model: &Model,
        in_newtons: bool,
    ) -> Result<Self, DiagnoseError> {
        let refuse = |error: MeasureError| DiagnoseError::Channel {
            channel: error.channel,
            file: run.file.clone(),
            reason: error.fault,
        };
        let mut commands = Vec::new();
        let mut groups: BTreeMap<String, Vec<(usize, &Series)>> = BTreeMap::new();
        for series in run.series.iter().filter(|s| !s.times.is_empty() && !s.channel.starts_with("drive.")) {
            // A measured effort drives its joint where no command was recorded.
            let beside = limits::command_beside(&series.channel);
            if beside.as_deref().is_some_and(|command| run.series(command).is_some()) {
                continue;
            }
            if let Some(found) = plant.actuator(model, beside.as_deref().unwrap_or(&series.channel)) {
                let (actuator, what, unit) = found.map_err(refuse)?;
                let unit = if in_newtons { 1.0 } else { unit };
                let values = series.values.iter().map(|v| v * unit).collect();
                commands.push(CommandTape { actuator, what, times: series.times.to_vec(), values });
                continue;
            }
            let (prefix, component) = split_component(&series.channel);
            groups.entry(prefix.to_owned()).or_default().push((component, series));
        }
        let mut readings = Vec::new();
        for (prefix, group) in &groups {
            let quantity = plant.quantity(model, prefix).map_err(refuse)?;
            readings.extend(readings_of(set, prefix, quantity, group));
        }
        let index = set.runs.iter().position(|r| r.file == run.file && r.note == run.note).unwrap_or(0);
        Ok(Self { index, ..Self::assemble((&run.file, run.role), commands, readings) })
    }

    /// The same run with at most so many samples of each reading, evenly picked: enough to search by.
    pub fn thinned(&self, most: usize) -> Self {
        let thin = |r: &Reading| {
            let every = r.times.len().div_ceil(most).max(1);
            let kept: Vec<usize> =
                ticks_of(&r.times).into_iter().enumerate().filter(|(_, k)| k % every == 0).map(|k| k.0).collect();
            r.of_samples(&kept)
        };
        let readings = self.readings.iter().map(thin).collect();
        // A run ends where it ends, however thinly it is sampled.
        Self { span: self.span, rate: self.rate, ..self.with_readings(readings) }
    }

    /// A part of the run, with the channels that are wanted.
    pub(crate) fn within(&self, Span { from, to }: Span, is_wanted: impl Fn(&str) -> bool) -> Self {
        let part = |r: &Reading| {
            let range = r.times.partition_point(|t| *t < from)..r.times.partition_point(|t| *t <= to);
            r.of_samples(&range.collect::<Vec<usize>>())
        };
        let readings = self.readings.iter().filter(|r| is_wanted(&r.channel)).map(part);
        self.with_readings(readings.filter(|r| !r.times.is_empty()).collect())
    }

    /// The same run with its sensors as late as they are in a model.
    pub(crate) fn as_late_as(&self, built: &Built) -> Self {
        let readings = self.readings.iter().map(|r| Reading { late_s: lateness(built, r), ..r.clone() }).collect();
        Self { readings, ..self.clone() }
    }

    /// Whether one of its sensors is late in a model.
    pub(crate) fn is_late_in(&self, built: &Built) -> bool {
        self.readings.iter().any(|r| lateness(built, r) > 0.0)
    }

    /// The same run with other samples.
    pub(crate) fn with_readings(&self, readings: Vec<Reading>) -> Self {
        let read = Self::assemble((&self.file, self.role), self.commands.clone(), readings);
        Self { index: self.index, coarser: self.coarser.clone(), ..read }
    }

    /// The same run with its commands also in cells of some lengths.
    pub(crate) fn with_hearings(mut self, lengths: &[f64]) -> Self {
        let hearing = |longest: &f64| Hearing { longest: *longest, tape: heard_in_cells(&self, *longest) };
        self.coarser = lengths.iter().map(hearing).collect();
        self
    }

    /// The run's commands in the longest cells up to a length; as they were recorded where there are none.
    pub(crate) fn heard_at(&self, longest: f64) -> &Self {
        let fits = self.coarser.iter().rev().find(|h| h.longest <= longest + SAME);
        fits.map_or(self, |h| &h.tape)
    }

    pub(crate) fn assemble((file, role): (&str, Role), commands: Vec<CommandTape>, readings: Vec<Reading>) -> Self {
        let mut events: Vec<Event> = Vec::new();
        for (r, reading) in readings.iter().enumerate() {
            let samples = reading.times.iter().enumerate();
            events.extend(samples.map(|(i, t)| Event { time: *t, reading: r as u32, sample: i as u32 }));
        }
        events.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.reading.cmp(&b.reading)));
        let mut ticks: Vec<f64> = commands.iter().flat_map(CommandTape::changes).collect();
        ticks.sort_by(f64::total_cmp);
        ticks.dedup();
        let span = (events.first().map_or(0.0, |e| e.time), events.last().map_or(0.0, |e| e.time));
        let mut offsets = vec![0];
        for event in &events {
            offsets.push(offsets[offsets.len() - 1] + readings[event.reading as usize].width());
        }
        let file = file.to_owned();
        let rate = readings
            .iter()
            .map(|r| median_step(&r.times).unwrap_or(f64::INFINITY))
            .fold(f64::INFINITY, f64::min)
            .recip();
        let rate = if rate > 0.0 { rate } else { f64::INFINITY };
        Self { index: 0, file, role, commands, readings, events, offsets, ticks, span, rate, coarser: Vec::new() }
    }

    /// The events of a span: those at its end belong to the next, but for the run's last.
    pub fn range(&self, span: Span) -> std::ops::Range<usize> {
        let before = |t: f64| self.events.partition_point(|e| e.time < t - 1e-9);
        let end = if span.to >= self.span.1 { self.events.len() } else { before(span.to) };
        before(span.from)..end.max(before(span.from))
    }
}

/// How late a reading's sensor is in a model, s.
fn lateness(built: &Built, reading: &Reading) -> f64 {
    built.sensor(&reading.channel).map_or(0.0, |(_, sensor)| sensor.delay.max(0.0))
}

/// The runs and the nominal model, the plant told what is read and driven.
pub(crate) fn load(plant: &mut Plant, set: &RecordingSet) -> Result<(Vec<Tape>, Built), DiagnoseError> {
    let built = plant.build(&[])?;
    let in_newtons = unheard::has_thrusts(set, plant, &built.model);
    let of = |run| Tape::new(set, run, plant, &built.model, in_newtons);
    let tapes: Vec<Tape> = set.runs.iter().map(of).collect::<Result<_, _>>()?;
    let mut channels: Vec<String> = tapes.iter().flat_map(|t| t.readings.iter().map(|r| r.channel.clone())).collect();
    channels.sort();
    channels.dedup();
    plant.attach(set, &built, channels)?;
    noise::refuse_silent(&tapes)?;
    Ok((tapes, plant.build(&[])?))
}

/// The role of the runs that judge: those left out of the fit, or the others where there are none.
pub(crate) fn judging(tapes: &[Tape]) -> Role {
    if tapes.iter().any(|t| t.role == Role::Holdout) { Role::Holdout } else { Role::Fit }
}

/// Ticks of an even clock at which samples were taken, those that were left out counted too, so that sensors which read together stay
/// together when they are thinned; the numbers of the samples where the clock is not even.
fn ticks_of(times: &[f64]) -> Vec<usize> {
    let step = median_step(times).unwrap_or(1.0);
    let since = |t: &f64| (t - times[0]) / step;
    let is_even = times.iter().all(|t| (since(t) - since(t).round()).abs() < EVEN);
    if is_even { times.iter().map(|t| since(t).round() as usize).collect() } else { (0..times.len()).collect() }
}

/// Share of a step by which an even clock's samples may be off their ticks.
const EVEN: f64 = 0.25;

/// `body.target.position.x` → (`body.target.position`, 0); scalars stand in component 0, w of a quaternion in 3.
fn split_component(channel: &str) -> (&str, usize) {
    match channel.rsplit_once('.') {
        Some((prefix, "x")) => (prefix, 0),
        Some((prefix, "y")) => (prefix, 1),
        Some((prefix, "z")) => (prefix, 2),
        Some((prefix, "w")) => (prefix, 3),
        _ => (channel, 0),
    }
}

fn is_orientation(quantity: &Quantity) -> bool {
    quantity.is_orientation()
}

/// Axes about which an orientation is read to turn: all, or the one of a body in the plane, whose quaternion has nothing but zeros along the others.
fn turning(parts: &[(usize, &Series)]) -> Vec<usize> {
    let is_still = |axis: &usize| parts.iter().any(|(k, s)| k == axis && s.values.iter().all(|v| *v == 0.0));
    let turning: Vec<usize> = (0..3).filter(|axis| !is_still(axis)).collect();
    if turning.len() == 1 { turning } else { vec![0, 1, 2] }
}

/// One reading of the components that were sampled together; where they were not, one each.
fn readings_of(set: &RecordingSet, prefix: &str, quantity: Quantity, group: &[(usize, &Series)]) -> Vec<Reading> {
    let together = group.iter().all(|(_, s)| s.times == group[0].1.times);
    let parts: Vec<Vec<(usize, &Series)>> =
        if together { vec![group.to_vec()] } else { group.iter().map(|g| vec![*g]).collect() };
    let of_part = |part: &Vec<(usize, &Series)>| {
        let quantum = part.iter().map(|(_, s)| s.quantum()).fold(0.0, f64::max);
        let stated = set.sigma(&part[0].1.channel).or_else(|| set.sigma(prefix));
        let orientation = is_orientation(&quantity);
        // Rounded components of a unit quaternion turn into an angle twice as large.
        let rounding = if orientation { 2.0 * quantum } else { quantum };
        let told = || noise::raw_sigma(&part.iter().map(|(_, s)| *s).collect::<Vec<_>>(), orientation);
        let rounding = rounding / 12f64.sqrt();
        let sigma = stated.or_else(told).unwrap_or(0.0).hypot(rounding);
        let times = part[0].1.times.clone();
        let values = (0..times.len()).map(|i| value_at(part, i, orientation)).collect();
        let axes = if orientation { turning(part) } else { part.iter().map(|(k, _)| *k).collect() };
        let (channel, times) = (prefix.to_owned(), times.to_vec());
        Reading { channel, quantity, axes, sigma, rounding, times, values, blur: Vec::new(), late_s: 0.0 }
    };
    parts.iter().filter(|p| !is_orientation(&quantity) || p.len() == 4).map(of_part).collect()
}

fn value_at(part: &[(usize, &Series)], i: usize, orientation: bool) -> Value {
    let mut x = [0.0; 4];
    part.iter().for_each(|(k, s)| x[*k] = s.values[i]);
    if orientation {
        Value::Rotation(Rot::new_normalize(nalgebra::Quaternion::new(x[3], x[0], x[1], x[2])))
    } else {
        Value::Vector(Vec3::new(x[0], x[1], x[2]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_in_the_plane_is_read_about_one_axis_and_one_that_rests_about_all() {
        let series = |part: &str, values: [f64; 2]| {
            Series::with_quantum(format!("body.disc.orientation.{part}"), vec![0.0, 0.1], values.to_vec(), 1e-6)
        };
        let axes = |vector: [[f64; 2]; 3]| {
            let all: Vec<Series> = ["x", "y", "z"]
                .into_iter()
                .zip(vector)
                .map(|(p, v)| series(p, v))
                .chain([series("w", [1.0, 0.9])])
                .collect();
            turning(&all.iter().enumerate().collect::<Vec<_>>())
        };
        assert_eq!(axes([[0.0; 2], [0.0; 2], [0.1, 0.2]]), [2]);
        assert_eq!(axes([[0.0; 2], [0.0, -1e-6], [0.1, 0.2]]), [0, 1, 2], "noise about another axis");
        assert_eq!(axes([[0.0; 2]; 3]), [0, 1, 2], "at rest");
    }

    #[test]
    fn a_part_of_a_run_keeps_its_commands_and_its_number() {
        let reading = |channel: &str, every: usize| {
            let times: Vec<f64> = (0..=10).step_by(every).map(|i| 0.1 * i as f64).collect();
            let values = vec![Value::Vector(Vec3::zeros()); times.len()];
            let quantity = Quantity::JointPosition(0);
            Reading {
                channel: channel.to_owned(),
                quantity,
                axes: vec![0],
                sigma: 1.0,
                rounding: 0.0,
                times,
                values,
                blur: Vec::new(),
                late_s: 0.0,
            }
        };
        let commands =
            vec![CommandTape { actuator: 0, what: Commanded::Effort, times: vec![0.0, 0.8], values: vec![1.0, 2.0] }];
        let readings = vec![reading("a", 1), reading("b", 2), reading("felt", 1)];
        let whole = Tape { index: 4, ..Tape::assemble(("run", Role::Fit), commands, readings) };
        let part = whole.within(Span { from: 0.25, to: 0.65 }, |channel| channel != "felt");
        assert_eq!((part.index, part.commands.len(), part.ticks.len()), (4, 1, 2));
        let kept: Vec<(&str, usize)> = part.readings.iter().map(|r| (r.channel.as_str(), r.times.len())).collect();
        assert_eq!(kept, [("a", 4), ("b", 2)]);
        assert!((part.span.0 - 0.3).abs() < 1e-12 && (part.span.1 - 0.6).abs() < 1e-12);
    }
}
