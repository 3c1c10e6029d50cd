//! What sensors say in a run: readings at their own rate, late, with noise, and with the faults that effects give them.
//!
//! A `[[sensor]]` reads at t = k/rate, k = 0, 1, …, in the first step that has come so far:
//!
//!   y = round(clip(faults(x(t)) + b + w(t) + σ n)),     n: standard normal,     w: a walk, dw = s √dt n′,     it arrives at t + delay
//!
//! and of an orientation q exp(σ n). A recording holds the last reading that has arrived since its sample before; an empty cell where none has. A joint, body
//! or drive whose sensor an effect faults is read in every step, without noise. What reads a joint or a body is recorded under that name instead of what is
//! true. The noise of a quantity depends on the scenario's seed and on the quantity's name alone.
//!
//! A contact force is that of the last step.

mod parts;

pub(crate) use parts::{Part, parts_of};

use crate::effects::SENSOR_DELAY;
use crate::measure::{Gauge, Quantity, Reading, SensorModel};
use crate::spec::{Scenario, Sensor as SensorSpec};
use crate::{Mission, ScenarioError};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use record::{ChannelName, ChannelSpec, Plot, Probe};
use sim::{Model, World};
use spatial::{Vec3, exp_rotation};
use std::collections::VecDeque;

/// Part of a step by which a reading may come early: times of steps are rounded.
const ROUNDING: f64 = 1e-6;

/// The sensors of a mission, ready to be recorded.
pub(crate) fn of_mission(mission: &Mission) -> Result<Vec<Sensor>, Vec<ScenarioError>> {
    let (scenario, model) = (&mission.scenario, mission.world.model());
    let (mut sensors, mut errors) = (Vec::<Sensor>::new(), Vec::new());
    for (i, sensor) in scenario.sensors.iter().enumerate() {
        let most = 1.0 / scenario.integrator.step_s;
        if sensor.rate_hz > most * (1.0 + ROUNDING) {
            let reason = format!("is more than one reading a step; at most {most} Hz, or a shorter integrator.step_s");
            errors.push(scenario.complaint(&format!("sensor[{i}].rate_hz"), reason));
        }
        for part in parts_of(sensor, model).unwrap_or_default() {
            let (delay, dropout, message) = (sensor.delay_s, sensor.dropout, hash(&sensor.name));
            let timing = Timing { rate: Some(sensor.rate_hz), delay, dropout, message };
            match sensors.iter().any(|known| known.part.name == part.name) {
                true => {
                    let reason = format!("reads {} as another sensor does; a quantity has one", part.name);
                    errors.push(scenario.complaint(&format!("sensor[{i}]"), reason));
                }
                false => sensors.extend(Sensor::new(scenario, model, part, timing)),
            }
        }
    }
    for name in faulted(scenario, model) {
        if !sensors.iter().any(|known| known.part.name == name) {
            let timing = Timing { rate: None, delay: 0.0, dropout: 0.0, message: 0 };
            sensors.extend(Sensor::new(scenario, model, Part { name, ..Part::default() }, timing));
        }
    }
    errors.extend(sensors.iter().filter(|s| s.timing.delay < 0.0).map(|sensor| {
        let late = scenario.effects.iter().position(|e| e.name == SENSOR_DELAY.name).unwrap_or_default();
        let (name, s) = (&sensor.part.name, sensor.timing.delay);
        let reason = format!(
            "makes {name} {:.3e} s early, and a run cannot record what is yet to come; leave the effect out of runs",
            -s
        );
        scenario.complaint(&format!("effect[{late}].delay"), reason)
    }));
    if errors.is_empty() { Ok(sensors) } else { Err(errors) }
}

/// Age at which a scenario's own sensor of a quantity tells it, s; by any of the quantity's names.
pub(crate) fn delay_of(scenario: &Scenario, model: &Model, quantity: &str) -> f64 {
    // Asked for every channel of every model that a search builds.
    let late = scenario.sensors.iter().filter(|s| s.delay_s > 0.0);
    let meant = |name: &str| Gauge::resolve(scenario, model, name).ok();
    let reads = |s: &&SensorSpec| {
        let parts = parts_of(s, model).unwrap_or_default();
        parts.iter().any(|part| part.name == quantity || meant(&part.name) == meant(quantity))
    };
    let mut late = late.filter(reads);
    late.next().map_or(0.0, |s| s.delay_s)
}

/// Recorded quantities other than sensors' own whose reading an effect faults.
fn faulted(scenario: &Scenario, model: &Model) -> Vec<String> {
    let is_faulted = |name: &String| SensorModel::of(&scenario.effects, model, name) != SensorModel::default();
    let mut names: Vec<String> = record::standard_channels(model).into_iter().filter_map(|c| whole(&c.name)).collect();
    names.dedup();
    names.retain(is_faulted);
    names
}

/// The quantity of a channel, without its component; none for a channel that no sensor reads.
fn whole(channel: &str) -> Option<String> {
    let name = ChannelName::parse(channel)?;
    (!name.quantity.is_command()).then(|| name.prefix.to_owned())
}

/// When a sensor reads.
#[derive(Clone, Copy, Debug)]
struct Timing {
    /// Readings per second; none: one in every step.
    rate: Option<f64>,
    /// Age of a reading when it arrives, s.
    delay: f64,
    /// Share of readings that never do.
    dropout: f64,
    /// What a sensor reads at an instant comes as one message, or not at all: its stream of random numbers.
    message: u64,
}

/// A reading: when it arrives, s, and what it says; of an orientation w, x, y, z.
pub(crate) type Arrival = (f64, [f64; 4]);

/// One quantity, as its sensor reads it.
#[derive(Debug)]
pub(crate) struct Sensor {
    part: Part,
    gauge: Gauge,
    faults: SensorModel,
    timing: Timing,
    channels: Vec<ChannelSpec>,
    random: ChaCha8Rng,
    losses: ChaCha8Rng,
    /// Number of the reading that is due next.
    next: f64,
    /// What the bias has walked by, and when it was seen last, s.
    walked: (Vec3, f64),
    /// Readings on their way.
    sent: VecDeque<Arrival>,
}

impl Sensor {
    fn new(scenario: &Scenario, model: &Model, part: Part, timing: Timing) -> Option<Self> {
        let gauge = Gauge::resolve(scenario, model, &part.name).ok()?;
        let faults = SensorModel::of(&scenario.effects, model, &part.name);
        let mut random = ChaCha8Rng::seed_from_u64(scenario.seed);
        random.set_stream(hash(&part.name));
        let mut losses = ChaCha8Rng::seed_from_u64(scenario.seed);
        losses.set_stream(timing.message);
        Some(Self {
            gauge,
            faults,
            timing: Timing { delay: timing.delay + faults.delay, ..timing },
            channels: channels(model, &part.name, gauge.quantity()),
            part,
            random,
            losses,
            next: 0.0,
            walked: (Vec3::zeros(), 0.0),
            sent: VecDeque::new(),
        })
    }

    /// The channels that it writes, in the order of an [`Arrival`]'s numbers.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.channels.iter().map(|spec| spec.name.as_str())
    }

    /// The quantity that it reads, and the standard deviation of its noise.
    pub(crate) fn noise(&self) -> (&str, f64) {
        (&self.part.name, self.part.sigma)
    }

    /// The numbers of a reading that its channels show.
    pub(crate) fn shown(&self, reading: [f64; 4]) -> impl Iterator<Item = f64> {
        // A driven quantity has the components that are driven.
        let component = |spec: &ChannelSpec| match ChannelName::parse(&spec.name).map_or("", |name| name.component) {
            "x" if self.channels.len() == 4 => 1,
            "y" if self.channels.len() == 4 => 2,
            "z" if self.channels.len() == 4 => 3,
            "y" => 1,
            "z" => 2,
            _ => 0,
        };
        self.channels.iter().map(move |spec| reading[component(spec)])
    }

    /// The next reading that has arrived by now.
    pub(crate) fn arrived(&mut self, world: &World) -> Option<Arrival> {
        let now = world.state().time + ROUNDING * world.model().step;
        self.sent.pop_front_if(|(arrives, _)| *arrives <= now)
    }

    /// Whether a reading is due, and which comes then.
    fn is_due(&mut self, world: &World) -> bool {
        let Some(rate) = self.timing.rate else { return true };
        let ticks = (world.state().time + ROUNDING * world.model().step) * rate;
        if ticks < self.next {
            return false;
        }
        self.next = ticks.floor() + 1.0;
        true
    }

    /// Three standard normal numbers.
    fn normal(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| StandardNormal.sample(&mut self.random))
    }

    /// The value that the sensor gives for the world as it is; none where it is lost.
    fn reading(&mut self, world: &World) -> Option<[f64; 4]> {
        // Drawn whether or not there is noise, so that another level scales it and draws no other.
        let noise = self.part.sigma * self.normal();
        if self.part.walk > 0.0 {
            let since = world.state().time - self.walked.1;
            self.walked = (self.walked.0 + self.part.walk * since.sqrt() * self.normal(), world.state().time);
        }
        let is_lost = self.timing.dropout > 0.0 && uniform(&mut self.losses) < self.timing.dropout;
        if is_lost || !self.sees(world) {
            return None;
        }
        let off = self.part.bias + self.walked.0 + noise;
        let shown = |x: f64| {
            let clipped = self.part.limit.map_or(x, |limit| x.clamp(-limit, limit));
            if self.part.step > 0.0 { (clipped / self.part.step).round() * self.part.step } else { clipped }
        };
        Some(match self.faults.apply(&self.gauge.read(world)) {
            Reading::Scalar(x) => [shown(x + off.x), 0.0, 0.0, 0.0],
            Reading::Vector(v) => [shown(v.x + off.x), shown(v.y + off.y), shown(v.z + off.z), 0.0],
            Reading::Rotation(q) => {
                let q = q * exp_rotation(&off);
                [q.w, q.i, q.j, q.k]
            }
        })
    }

    /// Whether what a camera looks at is where it sees.
    fn sees(&self, world: &World) -> bool {
        let (Quantity::SeenPosition(sight) | Quantity::SeenOrientation(sight)) = self.gauge.quantity() else {
            return true;
        };
        let [range, half] = self.part.sight;
        let at = sight.calc_position(world);
        range.is_none_or(|range| at.norm() <= range) && half.is_none_or(|half| at.xy().norm().atan2(at.z) <= half)
    }
}

/// A number from 0 to 1.
fn uniform(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (0.5f64).powi(53)
}

/// Its channels: those that the recorder has for it, or its components.
fn channels(model: &Model, name: &str, quantity: Quantity) -> Vec<ChannelSpec> {
    let is_own = |spec: &ChannelSpec| whole(&spec.name).as_deref() == Some(name);
    let standard: Vec<ChannelSpec> = record::standard_channels(model).into_iter().filter(is_own).collect();
    if !standard.is_empty() {
        return standard.into_iter().map(|spec| spec.described("as its sensor reads it")).collect();
    }
    let components: &[&str] = if quantity.is_orientation() { &["w", "x", "y", "z"] } else { &["x", "y", "z"] };
    let channel = |k: &&str| {
        let name = format!("{name}.{k}");
        let unit = ChannelName::parse(&name).map_or("", |known| known.quantity.unit());
        ChannelSpec::new(name, unit, Plot::Sensors).described("as the sensor reads it")
    };
    components.iter().map(channel).collect()
}

/// FNV-1a: a stream of random numbers for every name.
fn hash(name: &str) -> u64 {
    let add = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    name.bytes().fold(0xcbf2_9ce4_8422_2325, add)
}

impl Probe for Sensor {
    fn channels(&self) -> Vec<ChannelSpec> {
        self.channels.clone()
    }

    fn observe(&mut self, world: &World) {
        if self.is_due(world)
            && let Some(reading) = self.reading(world)
        {
            self.sent.push_back((world.state().time + self.timing.delay, reading));
        }
    }

    fn read(&mut self, world: &World, values: &mut Vec<f64>) {
        let mut last = [f64::NAN; 4];
        while let Some((_, reading)) = self.arrived(world) {
            last = reading;
        }
        values.extend(self.shown(last));
    }
}
