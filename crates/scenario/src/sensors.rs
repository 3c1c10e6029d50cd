//! What sensors say in a run: readings at their own rate, late, with noise, and with the faults that effects give them.
//!
//! A `[[sensor]]` reads at t = k/rate, k = 0, 1, …, in the first step that has come so far:
//!
//!   y = round(clip(faults(x(t)) + b + w(t) + σ n)),     n: standard normal,     w: a walk, dw = s √dt n′,     it arrives at t + delay
//!
//! and of an orientation q exp(σ n). A recording holds the last reading that has arrived since its sample before; an empty cell where none has. A joint, body
//! or drive whose sensor an effect faults is read in every step, without noise. What reads a joint or a body is recorded under that name instead of what is
//! true. The noise of a reading depends on the scenario's seed, the quantity's name and the number of the reading alone: who reads the same sensor, a
//! recorder or a controller, reads the same. A sensor holds no memory; that is its reader's, plain numbers that a snapshot of the state can hold.
//!
//! A contact force is that of the last step.

mod parts;

pub(crate) use parts::{Part, parts_of};

use crate::ScenarioError;
use crate::effects::SENSOR_DELAY;
use crate::measure::{Gauge, Quantity, Reading, SensorModel};
use crate::spec::{Scenario, Sensor as SensorSpec};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use record::{ChannelName, ChannelSpec, Plot, Probe};
use sim::{Model, World};
use spatial::{Vec3, exp_rotation};

/// Part of a step by which a reading may come early: times of steps are rounded.
const ROUNDING: f64 = 1e-6;

/// The sensors of a scenario, and the quantities whose reading an effect faults.
pub(crate) fn of(scenario: &Scenario, model: &Model) -> Result<Vec<Sensor>, Vec<ScenarioError>> {
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

/// A reading: when it was taken by the sensor's own word (which knows nothing of what effects make late) and arrives, s, and what it says; of an
/// orientation w, x, y, z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arrival {
    pub taken: f64,
    pub arrives: f64,
    pub value: [f64; 4],
}

/// Numbers of a reading on its way.
const PARCEL: usize = 6;
/// Words of a random stream that a reading may use: three times three normal numbers, and what their sampling rejects.
const WORDS: u128 = 128;

/// Places in a sensor's memory.
mod slot {
    /// Number of the reading that is due next.
    pub(super) const NEXT: usize = 0;
    /// What the bias has walked by.
    pub(super) const WALKED: usize = 1;
    /// When that was seen last, s.
    pub(super) const SINCE: usize = 4;
    /// Readings so far.
    pub(super) const TAKEN: usize = 5;
    /// Which of the places for readings on their way holds the oldest, and how many are on their way.
    pub(super) const OLDEST: usize = 6;
    pub(super) const COUNT: usize = 7;
    pub(super) const SENT: usize = 8;
}

/// One quantity, as its sensor reads it.
#[derive(Clone, Debug)]
pub(crate) struct Sensor {
    part: Part,
    gauge: Gauge,
    faults: SensorModel,
    timing: Timing,
    channels: Vec<ChannelSpec>,
    seed: u64,
    /// How many readings can be on their way.
    room: usize,
}

impl Sensor {
    fn new(scenario: &Scenario, model: &Model, part: Part, timing: Timing) -> Option<Self> {
        let gauge = Gauge::resolve(scenario, model, &part.name).ok()?;
        let faults = SensorModel::of(&scenario.effects, model, &part.name);
        let timing = Timing { delay: timing.delay + faults.delay, ..timing };
        let rate = timing.rate.unwrap_or(1.0 / scenario.integrator.step_s);
        Some(Self {
            gauge,
            faults,
            timing,
            channels: channels(model, &part.name, gauge.quantity()),
            part,
            seed: scenario.seed,
            room: (timing.delay.max(0.0) * rate).ceil() as usize + 2,
        })
    }

    /// How many numbers it wants remembered, all zero at the start.
    pub(crate) fn memory_len(&self) -> usize {
        slot::SENT + PARCEL * self.room
    }

    /// The quantity that it reads.
    pub(crate) fn quantity(&self) -> Quantity {
        self.gauge.quantity()
    }

    /// Its name in recordings.
    pub(crate) fn name(&self) -> &str {
        &self.part.name
    }

    /// Standard deviation of its noise, the step of its scale counted in.
    pub(crate) fn sigma(&self) -> f64 {
        self.part.sigma.hypot(self.part.step / 12f64.sqrt())
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

    /// Reads the world if that is due, and tells what has arrived; called in every step, so that no reading waits without a place.
    pub(crate) fn look(&self, world: &World, memory: &mut [f64], mut take: impl FnMut(&Arrival)) {
        self.observe(world, memory);
        while let Some(arrival) = self.arrived(world, memory) {
            take(&arrival);
        }
    }

    /// The next reading that has arrived by now.
    fn arrived(&self, world: &World, memory: &mut [f64]) -> Option<Arrival> {
        if memory[slot::COUNT] == 0.0 {
            return None;
        }
        let oldest = memory[slot::OLDEST] as usize;
        let parcel = &memory[slot::SENT + PARCEL * oldest..][..PARCEL];
        let arrival =
            Arrival { taken: parcel[0], arrives: parcel[1], value: [parcel[2], parcel[3], parcel[4], parcel[5]] };
        if arrival.arrives > world.state().time + ROUNDING * world.model().step {
            return None;
        }
        memory[slot::OLDEST] = ((oldest + 1) % self.room) as f64;
        memory[slot::COUNT] -= 1.0;
        Some(arrival)
    }

    /// Reads the world if that is due, and sends the reading on its way.
    fn observe(&self, world: &World, memory: &mut [f64]) {
        if !self.is_due(world, memory) {
            return;
        }
        let Some(value) = self.reading(world, memory) else { return };
        let taken = world.state().time;
        let (oldest, count) = (memory[slot::OLDEST] as usize, memory[slot::COUNT] as usize);
        let parcel = &mut memory[slot::SENT + PARCEL * ((oldest + count) % self.room)..][..PARCEL];
        let stamp = taken + self.faults.delay;
        parcel.copy_from_slice(&[stamp, taken + self.timing.delay, value[0], value[1], value[2], value[3]]);
        memory[slot::COUNT] = (count + 1).min(self.room) as f64;
    }

    /// Whether a reading is due, and which comes then.
    fn is_due(&self, world: &World, memory: &mut [f64]) -> bool {
        let Some(rate) = self.timing.rate else { return true };
        let ticks = (world.state().time + ROUNDING * world.model().step) * rate;
        if ticks < memory[slot::NEXT] {
            return false;
        }
        memory[slot::NEXT] = ticks.floor() + 1.0;
        true
    }

    /// The random numbers of a reading, in a stream.
    fn random(&self, stream: u64, reading: u64) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(stream);
        random.set_word_pos(u128::from(reading) * WORDS);
        random
    }

    /// The value that the sensor gives for the world as it is; none where it is lost.
    fn reading(&self, world: &World, memory: &mut [f64]) -> Option<[f64; 4]> {
        let number = memory[slot::TAKEN] as u64;
        memory[slot::TAKEN] += 1.0;
        let mut off = self.part.bias;
        if self.part.sigma > 0.0 || self.part.walk > 0.0 {
            let mut random = self.random(hash(&self.part.name), number);
            let mut normal = || Vec3::from_fn(|_, _| StandardNormal.sample(&mut random));
            off += self.part.sigma * normal();
            if self.part.walk > 0.0 {
                let step = self.part.walk * (world.state().time - memory[slot::SINCE]).sqrt() * normal();
                let walked = Vec3::from_column_slice(&memory[slot::WALKED..][..3]) + step;
                memory[slot::WALKED..][..3].copy_from_slice(walked.as_slice());
                memory[slot::SINCE] = world.state().time;
                off += walked;
            }
        }
        let is_lost =
            self.timing.dropout > 0.0 && uniform(&mut self.random(self.timing.message, number)) < self.timing.dropout;
        if is_lost || !self.sees(world) {
            return None;
        }
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

/// Sensors with the memory of who reads them.
#[derive(Debug)]
pub(crate) struct Readers(Vec<(Sensor, Vec<f64>)>);

impl Readers {
    pub(crate) fn new(sensors: Vec<Sensor>) -> Self {
        let blank = |sensor: Sensor| {
            let memory = vec![0.0; sensor.memory_len()];
            (sensor, memory)
        };
        Self(sensors.into_iter().map(blank).collect())
    }

    /// The sensors.
    pub(crate) fn sensors(&self) -> impl Iterator<Item = &Sensor> {
        self.0.iter().map(|(sensor, _)| sensor)
    }

    /// Lets all look, and tells what has arrived.
    pub(crate) fn look(&mut self, world: &World, mut take: impl FnMut(usize, &Sensor, &Arrival)) {
        for (index, (sensor, memory)) in self.0.iter_mut().enumerate() {
            sensor.look(world, memory, |arrival| take(index, sensor, arrival));
        }
    }
}

/// Sensors as channels of a recorder.
#[derive(Debug)]
pub(crate) struct Recorded {
    readers: Readers,
    /// What each has said since the last sample.
    last: Vec<[f64; 4]>,
}

impl Recorded {
    pub(crate) fn new(sensors: Vec<Sensor>) -> Self {
        Self { last: vec![[f64::NAN; 4]; sensors.len()], readers: Readers::new(sensors) }
    }
}

impl Probe for Recorded {
    fn channels(&self) -> Vec<ChannelSpec> {
        self.readers.sensors().flat_map(|sensor| sensor.channels.clone()).collect()
    }

    fn observe(&mut self, world: &World) {
        self.readers.look(world, |index, _, arrival| self.last[index] = arrival.value);
    }

    fn read(&mut self, _: &World, values: &mut Vec<f64>) {
        for (sensor, last) in self.readers.sensors().zip(&mut self.last) {
            values.extend(sensor.shown(std::mem::replace(last, [f64::NAN; 4])));
        }
    }
}
