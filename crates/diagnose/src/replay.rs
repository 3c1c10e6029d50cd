//! Replay: the scenario driven by recorded commands, read where the recording read.
//!
//! Commands hold from their tick to the next. The step ends at every tick and at every instant that a sensor reads, and is never
//! longer than the plant's step, so that nothing is interpolated; a sensor that is late reads at t − delay.

use crate::error::DiagnoseError;
use crate::feed::Feed;
use crate::mounts::Mounts;
use crate::plant::Built;
use crate::reading::Value;
use crate::start::Start;
use crate::tape::{Event, Tape};
use scenario::measure::{Gauge, Reading as Measured, SensorModel};
use sim::{Integrator, Push, World};
use spatial::Vec3;

/// A stretch of a run, replayed from a start of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// First instant, s.
    pub from: f64,
    /// End, s; samples at the end do not count, but for the run's last.
    pub to: f64,
}

/// How finely a replay advances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Longest step while anything touches, s.
    pub step: f64,
    /// Longest step in free flight, s.
    pub free: f64,
    /// Whether models without corners are advanced by the midpoint rule, at half the cost.
    pub midpoint: bool,
}

/// Largest phase (rad) of what effects and mounts bring with them in a step in contact, and in free flight: whatever was chosen for the nominal
/// model, a model that is faster by itself is followed.
const RESOLVED: [f64; 2] = [1.0, 0.1];

impl Pace {
    /// One step for all.
    pub fn even(step: f64) -> Self {
        Self { step, free: step, midpoint: false }
    }

    /// Steps that also resolve what a model swings by itself; mounts in flight see to themselves.
    fn resolving(self, built: &Built) -> Self {
        let mounts = built.mounts.iter().map(|m| m.rate(&built.model));
        let [own, driving] = built.model.effect_rates();
        let at_most = |share: f64, rate: f64| if rate > 0.0 { share / rate } else { f64::INFINITY };
        let step = self.step.min(at_most(RESOLVED[0], mounts.fold(own, f64::max)));
        Self { step, free: self.free.min(at_most(RESOLVED[1], own.max(driving))).max(step), ..self }
    }
}

/// Two instants closer than this are one, s.
pub(crate) const SAME: f64 = 1e-9;

/// What faultless sensors would read in a replay, by the number of the event within the span, and what that took.
#[derive(Clone, Debug)]
pub struct Readings {
    /// One for each event; late sensors are late.
    pub values: Vec<Measured>,
    /// What was computed for them.
    pub work: sim::Work,
}

/// Replays a span and hands every predicted reading to `look`, with its number among the span's events.
pub fn observe(
    built: &Built,
    tape: &Tape,
    start: &Start,
    span: Span,
    pace: Pace,
    mut look: impl FnMut(usize, &Event, &Value),
) -> Result<(), DiagnoseError> {
    let sensors = sensors_of(built, tape)?;
    let events = events_in(tape, span, &sensors);
    let replay = Replay::new(built, tape, start, span.from, pace);
    let shown = measure(replay, &sensors, &events, |i, event, truth| {
        look(i, event, &Value::from(sensors[event.reading as usize].1.apply(truth)));
    });
    shown.map(|_| ())
}

/// Replays a span for what its sensors would read; `heard`: commands as they are heard, the tape itself or means of its commands.
pub fn readings(
    built: &Built,
    tape: &Tape,
    heard: &Tape,
    start: &Start,
    span: Span,
    pace: Pace,
) -> Result<Readings, DiagnoseError> {
    let mut values = vec![Measured::Scalar(f64::NAN); tape.range(span).len()];
    let sensors = sensors_of(built, tape)?;
    let events = events_in(tape, span, &sensors);
    let replay = Replay::new(built, heard, start, span.from, pace);
    let replay = measure(replay, &sensors, &events, |i, _, truth| values[i] = *truth)?;
    Ok(Readings { values, work: replay.world.state().work })
}

/// A part of a run that is replayed by itself.
#[derive(Clone, Debug)]
pub struct Leg<'a> {
    /// When.
    pub span: Span,
    /// The events of the tape that tell of it.
    pub members: &'a [u32],
    /// Forces beside all laws that act throughout.
    pub push: Option<Push>,
    /// Commands as they are heard: the tape itself, or means of its commands.
    pub heard: &'a Tape,
}

/// A replay of one interval: what sensors with the faults of the model read of some events, and the state at its end.
#[derive(Clone, Debug)]
pub struct Shot {
    /// Residuals of the events in their order, units of noise.
    pub residuals: Vec<f64>,
    /// The state at the end of the interval.
    pub end: Start,
    /// What was computed for it.
    pub work: sim::Work,
}

/// Replays an interval for the residuals of some of the tape's events and for its end; events that a late sensor took before it are read at
/// its begin.
pub fn shoot(built: &Built, tape: &Tape, start: &Start, leg: Leg<'_>, pace: Pace) -> Result<Shot, DiagnoseError> {
    let Leg { span, members, push, heard } = leg;
    let sensors = sensors_of(built, tape)?;
    let late = |(i, m): (usize, &u32)| {
        let event = tape.events[*m as usize];
        (i, Event { time: told(&event, &sensors).clamp(span.from, span.to), ..event })
    };
    let mut events: Vec<(usize, Event)> = members.iter().enumerate().map(late).collect();
    events.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
    let mut offsets = vec![0];
    members.iter().for_each(|m| {
        let width = tape.readings[tape.events[*m as usize].reading as usize].width();
        offsets.push(offsets[offsets.len() - 1] + width);
    });
    let mut residuals = vec![f64::NAN; offsets[members.len()]];
    let mut replay = Replay::new(built, heard, start, span.from, pace);
    replay.world.push(push);
    let mut replay = measure(replay, &sensors, &events, |i, event, truth| {
        let value = Value::from(sensors[event.reading as usize].1.apply(truth));
        tape.readings[event.reading as usize].write_residual(
            event.sample as usize,
            &value,
            &mut residuals[offsets[i]..],
        );
    })?;
    let end = replay.start_at(built, span.to)?;
    Ok(Shot { residuals, end, work: replay.world.state().work })
}

/// When what an event tells was so: late sensors read what was.
fn told(event: &Event, sensors: &[(Gauge, SensorModel)]) -> f64 {
    event.time - sensors[event.reading as usize].1.delay
}

/// The events of a tape by the intervals between some ascending instants in which they tell; those of before the first belong to the first,
/// those of after the last to the last.
pub fn members_between(built: &Built, tape: &Tape, instants: &[f64]) -> Result<Vec<Vec<u32>>, DiagnoseError> {
    let sensors = sensors_of(built, tape)?;
    let mut members = vec![Vec::new(); instants.len() - 1];
    for (i, event) in tape.events.iter().enumerate() {
        let after = instants.partition_point(|t| *t <= told(event, &sensors) + SAME);
        members[after.clamp(1, instants.len() - 1) - 1].push(i as u32);
    }
    Ok(members)
}

/// Residuals of faultless readings when the sensors have the faults of a model, but for delays.
pub fn residuals_of(readings: &[Measured], built: &Built, tape: &Tape, span: Span) -> Result<Vec<f64>, DiagnoseError> {
    let sensors = sensors_of(built, tape)?;
    let range = tape.range(span);
    let offset = |i: usize| tape.offsets[range.start + i] - tape.offsets[range.start];
    let mut out = vec![f64::NAN; offset(range.len())];
    for (i, (truth, event)) in readings.iter().zip(&tape.events[range.clone()]).enumerate() {
        let reading = &tape.readings[event.reading as usize];
        if event.time - span.from < reading.late_s {
            out[offset(i)..][..reading.width()].fill(0.0);
            continue;
        }
        let value = Value::from(sensors[event.reading as usize].1.apply(truth));
        reading.write_residual(event.sample as usize, &value, &mut out[offset(i)..]);
    }
    Ok(out)
}

fn sensors_of(built: &Built, tape: &Tape) -> Result<Vec<(Gauge, SensorModel)>, DiagnoseError> {
    let sensors: Vec<(Gauge, SensorModel)> = tape.readings.iter().filter_map(|r| built.sensor(&r.channel)).collect();
    if sensors.len() < tape.readings.len() {
        let what = "a channel is not measured in this model".to_owned();
        return Err(DiagnoseError::Replay { file: tape.file.clone(), what });
    }
    Ok(sensors)
}

/// What a channel reads, and the faults of its sensor.
type Sensor = (Gauge, SensorModel);

/// Runs through some events and hands what every sensor is given to read to `look`; the replay where it is then.
fn measure<'a>(
    mut replay: Replay<'a>,
    sensors: &[Sensor],
    events: &[(usize, Event)],
    mut look: impl FnMut(usize, &Event, &Measured),
) -> Result<Replay<'a>, DiagnoseError> {
    let may_hold = !replay.mounts.rests.is_empty();
    let gauge_of = |event: &Event| &sensors[event.reading as usize].0;
    let rests = |event: &Event| {
        let gauge = gauge_of(event);
        gauge.rests_untouched() || may_hold && gauge.is_behind_mount()
    };
    // What nothing touches reads nothing, and behind a mount that is held always the same: no step has to end there.
    let still = |gauge: &Gauge, world: &World| match gauge.is_behind_mount() {
        true => gauge.read(world),
        false => Measured::Vector(Vec3::zeros()),
    };
    let is_smooth = |event: &Event| rests(event) || !gauge_of(event).reads_contact();
    // Until when nothing is known to touch; and the next instant at which something else than a contact is read.
    let (mut flown, mut next) = (f64::NEG_INFINITY, 0);
    let mut at = 0;
    while let Some((i, event)) = events.get(at) {
        let gauge = gauge_of(event);
        let passed = replay.glide(&events[at..], is_smooth, |k, world| {
            let (i, event) = &events[at + k];
            let gauge = gauge_of(event);
            look(*i, event, &if rests(event) { still(gauge, world) } else { gauge.read(world) });
        })?;
        if passed > 0 {
            at += passed;
            continue;
        }
        if rests(event) && event.time > flown {
            next = next.max(at);
            while events.get(next).is_some_and(|(_, e)| rests(e)) {
                next += 1;
            }
            let end = events.get(next).or(events.last()).map_or(event.time, |(_, e)| e.time);
            flown = replay.fly_to(end)?;
        }
        at += 1;
        if rests(event) && event.time <= flown {
            look(*i, event, &still(gauge, &replay.world));
            continue;
        }
        replay.advance_to(event.time)?;
        if gauge.reads_contact() {
            replay.world.refresh_touches();
        }
        look(*i, event, &gauge.read(&replay.world));
    }
    Ok(replay)
}

/// Starts at some ascending instants of a replay, for windows that begin there.
pub fn starts_along(
    built: &Built,
    tape: &Tape,
    start: &Start,
    pace: Pace,
    instants: &[f64],
) -> Result<Vec<Start>, DiagnoseError> {
    let mut replay = Replay::new(built, tape, start, start.time, pace);
    let at = |instant: &f64| {
        if *instant <= start.time { Ok(start.clone()) } else { replay.start_at(built, *instant) }
    };
    instants.iter().map(at).collect()
}

/// When anything touches in a replay: stretches that begin and end at instants of the tape's events; as far as the replay goes.
pub fn touches_in(built: &Built, tape: &Tape, start: &Start, span: Span, pace: Pace) -> Vec<Span> {
    let mut replay = Replay::new(built, tape, start, span.from, pace);
    let (mut all, mut from): (Vec<Span>, f64) = (Vec::new(), span.from);
    for event in &tape.events[tape.range(span)] {
        let Ok(has_touched) = replay.advance_to(event.time) else { break };
        match all.last_mut().filter(|last| last.to >= from) {
            Some(last) if has_touched => last.to = event.time,
            None if has_touched => all.push(Span { from, to: event.time }),
            _ => {}
        }
        from = event.time;
    }
    all
}

/// A world that runs through a tape.
struct Replay<'a> {
    tape: &'a Tape,
    world: World,
    feed: Feed<'a>,
    pace: Pace,
    mounts: Mounts,
    /// Length of the next step past several readings, s; and when these are read.
    reach: f64,
    instants: Vec<f64>,
}

impl<'a> Replay<'a> {
    fn new(built: &Built, tape: &'a Tape, start: &Start, from: f64, pace: Pace) -> Self {
        let pace = pace.resolving(built);
        let mut world = start.world(built, tape.index);
        if pace.midpoint && built.model.is_smooth() {
            world = world.with_integrator(Integrator::ImplicitMidpoint);
        }
        let feed = Feed::new(tape, from);
        hear_the_past(built, tape, from, &mut world);
        feed.apply(&mut world);
        start.set_memory(&mut world);
        let mut mounts = Mounts::new(&built.model, &built.mounts, tape, pace);
        mounts.after += from;
        Self { tape, world, feed, pace, mounts, reach: pace.free, instants: Vec::new() }
    }

    /// Flies in one long step past as many of the next events as it reaches, and shows the world at each of them; how many these were: none
    /// where a step has to end at the first, or something touches.
    fn glide(
        &mut self,
        events: &[(usize, Event)],
        is_smooth: impl Fn(&Event) -> bool,
        mut look: impl FnMut(usize, &World),
    ) -> Result<usize, DiagnoseError> {
        let Self { tape, world, feed, pace, mounts, reach, instants } = self;
        let Some((_, first)) = events.first() else { return Ok(0) };
        let now = world.state().time;
        let swings = !mounts.rests.is_empty() && now < mounts.after;
        if pace.free <= pace.step || swings || first.time <= now + SAME || world.touches().next().is_some() {
            return Ok(0);
        }
        if feed.next_tick(tape) <= now + SAME {
            feed.turn(tape, now);
            feed.apply(world);
        }
        // At an instant at which a command changes sensors read what was before; steps end where sensors read or commands change, so that what
        // comes after a flight is cut alike whichever way it was flown.
        let tick = feed.next_tick(tape);
        let far = (now + *reach).min(tick);
        let count = events.iter().take_while(|(_, e)| e.time <= far && is_smooth(e)).count();
        let end = match events.get(count) {
            Some((_, next)) if far == tick && next.time > tick => tick,
            _ => events[..count].last().map_or(now, |(_, e)| e.time),
        };
        instants.clear();
        instants.extend(events[..count].iter().map(|(_, e)| e.time).filter(|t| *t < end - SAME));
        instants.dedup_by(|b, a| *b - *a <= SAME);
        *reach = (2.0 * *reach).min(pace.free);
        if instants.is_empty() {
            return Ok(0);
        }
        let mut shown = 0;
        let flown = world.advance_past(end - now, (&mounts.rests, instants), |k, world| {
            while shown < count && events[shown].1.time <= instants[k] + SAME {
                look(shown, world);
                shown += 1;
            }
        });
        if !flown.map_err(|what| gone(tape, what))? {
            *reach = (0.25 * *reach).max(pace.step);
            return Ok(0);
        }
        (shown..count).for_each(|k| look(k, world));
        Ok(count)
    }

    /// Advances towards an instant as far as nothing touches, commands changed at their ticks; until when nothing did.
    fn fly_to(&mut self, time: f64) -> Result<f64, DiagnoseError> {
        let Self { tape, world, feed, pace, mounts, .. } = self;
        if pace.free <= pace.step || time - world.state().time <= SAME {
            return Ok(f64::NEG_INFINITY);
        }
        loop {
            let tick = feed.next_tick(tape);
            let to = if tick < time - SAME { tick } else { time };
            if !fly(world, to, pace.free, mounts).map_err(|what| gone(tape, what))? {
                // At the instant itself something may touch already.
                let is_free = world.touches().next().is_none();
                return Ok(if is_free { world.state().time - 2.0 * SAME } else { f64::NEG_INFINITY });
            }
            if to == time {
                return Ok(time);
            }
            feed.turn(tape, world.state().time);
            feed.apply(world);
        }
    }

    /// The start that continues from an instant: memory is told against its rest, which is that under the commands that act from there on.
    fn start_at(&mut self, built: &Built, time: f64) -> Result<Start, DiagnoseError> {
        self.advance_to(time)?;
        self.feed.turn(self.tape, time);
        self.feed.apply(&mut self.world);
        Ok(Start::of(built, self.tape.index, &self.world))
    }

    /// Advances to an instant, commands changed at their ticks; whether anything touched on the way.
    fn advance_to(&mut self, time: f64) -> Result<bool, DiagnoseError> {
        let Self { tape, world, feed, pace, mounts, .. } = self;
        let mut has_touched = false;
        while feed.next_tick(tape) < time - SAME {
            has_touched |= advance_to(world, feed.next_tick(tape), *pace, mounts).map_err(|what| gone(tape, what))?;
            feed.turn(tape, world.state().time);
            feed.apply(world);
        }
        Ok(has_touched | advance_to(world, time, *pace, mounts).map_err(|what| gone(tape, what))?)
    }
}

/// Late actuators still follow commands from before the span.
fn hear_the_past(built: &Built, tape: &Tape, from: f64, world: &mut World) {
    let delay = built.longest_delay();
    if delay == 0.0 {
        return;
    }
    let begin = from - 2.0 * delay;
    let first = tape.ticks.partition_point(|t| *t < begin).saturating_sub(1);
    let heard = |tick: &f64| {
        Feed::new(tape, *tick).apply(world);
        (*tick, world.state().commands.clone())
    };
    let past: Vec<_> = tape.ticks[first..].iter().take_while(|t| **t < from - SAME).map(heard).collect();
    world.recall_commands(past.iter().map(|(time, commands)| (*time, commands.as_slice())));
}

fn gone(tape: &Tape, error: sim::StepError) -> DiagnoseError {
    DiagnoseError::Replay { file: tape.file.clone(), what: error.to_string() }
}

/// Advances to an instant in equal steps not longer than the pace, long ones as long as nothing touches; whether anything touched.
fn advance_to(world: &mut World, time: f64, pace: Pace, mounts: &Mounts) -> Result<bool, sim::StepError> {
    if pace.free > pace.step && fly(world, time, pace.free, mounts)? {
        return Ok(false);
    }
    let left = time - world.state().time;
    if left <= SAME {
        return Ok(false);
    }
    let steps = parts(left, pace.step);
    let h = left / f64::from(steps);
    let mut has_touched = false;
    for _ in 0..steps {
        world.advance_meeting(h)?;
        has_touched |= world.touches().next().is_some();
    }
    Ok(has_touched)
}

/// Long steps to an instant as long as nothing touches, and no mount swings; whether that was all the way.
fn fly(world: &mut World, time: f64, longest: f64, mounts: &Mounts) -> Result<bool, sim::StepError> {
    loop {
        let left = time - world.state().time;
        if left <= SAME {
            return Ok(true);
        }
        let h = left / f64::from(parts(left, longest));
        let has_flown = if mounts.rests.is_empty() {
            world.advance_free(h)?
        } else {
            world.state().time >= mounts.after && world.advance_resting(h, &mounts.rests)?
        };
        if !has_flown {
            return Ok(false);
        }
    }
}

/// Equal steps, none longer than the longest, that make up a stretch.
fn parts(left: f64, longest: f64) -> u32 {
    (left / longest - 1e-6).ceil().max(1.0) as u32
}

/// The events of a span with their numbers, in the order of the instants they tell of: late sensors read what was.
fn events_in(tape: &Tape, span: Span, sensors: &[(Gauge, SensorModel)]) -> Vec<(usize, Event)> {
    let late = |(i, e): (usize, &Event)| {
        (i, Event { time: (e.time - sensors[e.reading as usize].1.delay).max(span.from), ..*e })
    };
    let mut events: Vec<_> = tape.events[tape.range(span)].iter().enumerate().map(late).collect();
    if sensors.iter().any(|(_, s)| s.delay != 0.0) {
        events.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
    }
    events
}

#[cfg(test)]
pub(crate) mod tests;
