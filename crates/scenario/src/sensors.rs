//! What sensors say in a run: readings at their own rate, late, with noise, and with the faults that effects give them.
//!
//! A `[[sensor]]` reads at t = k/rate, k = 0, 1, …, in the first step that has come so far:
//!
//!   y = faults(x(t)) + σ n,     n: standard normal, drawn at each reading,     it arrives at t + delay
//!
//! and a recording holds the last reading that has arrived since its sample before; an empty cell where none has. A joint, body
//! or drive whose sensor an effect faults is read in every step, without noise, and recorded under its own name instead of what
//! is true. The noise of a quantity depends on the scenario's seed and on the quantity's name alone.
//!
//! A contact force is that of the last step.

use crate::effects::SENSOR_DELAY;
use crate::measure::{Gauge, Reading, SensorModel};
use crate::spec::{Scenario, SensorKind};
use crate::{Mission, ScenarioError};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use record::{ChannelName, ChannelSpec, Plot, Probe};
use sim::{Model, World};
use spatial::Vec3;
use std::collections::VecDeque;

/// Part of a step by which a reading may come early: times of steps are rounded.
const ROUNDING: f64 = 1e-6;

/// The sensors of a mission, ready to be recorded.
pub(crate) fn of_mission(mission: &Mission) -> Result<Vec<Sensor>, Vec<ScenarioError>> {
    let (scenario, model) = (&mission.scenario, mission.world.model());
    let (mut sensors, mut errors) = (Vec::new(), Vec::new());
    for (i, sensor) in scenario.sensors.iter().enumerate() {
        let most = 1.0 / scenario.integrator.step_s;
        if sensor.rate_hz > most * (1.0 + ROUNDING) {
            let reason = format!("is more than one reading a step; at most {most} Hz, or a shorter integrator.step_s");
            errors.push(scenario.complaint(&format!("sensor[{i}].rate_hz"), reason));
        }
        for (quantity, sigma) in noise_of(&sensor.kind) {
            let name = format!("sensor.{}.{quantity}", sensor.name);
            let timing = Timing { rate: Some(sensor.rate_hz), delay: sensor.delay_s };
            sensors.extend(Sensor::new(scenario, model, &name, (sigma, timing)));
        }
    }
    for name in faulted(scenario, model) {
        sensors.extend(Sensor::new(scenario, model, &name, (0.0, Timing { rate: None, delay: 0.0 })));
    }
    errors.extend(sensors.iter().filter(|s| s.delay < 0.0).map(|sensor| {
        let late = scenario.effects.iter().position(|e| e.name == SENSOR_DELAY.name).unwrap_or_default();
        let (name, s) = (&sensor.name, sensor.delay);
        let reason = format!(
            "makes {name} {:.3e} s early, and a run cannot record what is yet to come; leave the effect out of runs",
            -s
        );
        scenario.complaint(&format!("effect[{late}].delay"), reason)
    }));
    if errors.is_empty() { Ok(sensors) } else { Err(errors) }
}

/// What a sensor measures as a whole, and the standard deviation of its noise.
fn noise_of(kind: &SensorKind) -> Vec<(&'static str, f64)> {
    match *kind {
        SensorKind::ContactForce { force_noise_n, torque_noise_n_m, .. }
        | SensorKind::MechanismForce { force_noise_n, torque_noise_n_m, .. } => {
            vec![("force", force_noise_n), ("torque", torque_noise_n_m)]
        }
        // The build refuses what is not simulated.
        SensorKind::JointEncoder { .. }
        | SensorKind::Imu { .. }
        | SensorKind::Pose { .. }
        | SensorKind::ForceTorque { .. } => Vec::new(),
    }
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
}

/// One quantity, as its sensor reads it.
#[derive(Debug)]
pub(crate) struct Sensor {
    name: String,
    gauge: Gauge,
    faults: SensorModel,
    sigma: f64,
    rate: Option<f64>,
    delay: f64,
    channels: Vec<ChannelSpec>,
    random: ChaCha8Rng,
    /// Number of the reading that is due next.
    next: f64,
    /// Readings on their way: when they arrive, s, and what they say.
    sent: VecDeque<(f64, [f64; 4])>,
}

impl Sensor {
    fn new(scenario: &Scenario, model: &Model, name: &str, (sigma, timing): (f64, Timing)) -> Option<Self> {
        let gauge = Gauge::resolve(scenario, model, name).ok()?;
        let faults = SensorModel::of(&scenario.effects, model, name);
        let mut random = ChaCha8Rng::seed_from_u64(scenario.seed);
        random.set_stream(hash(name));
        Some(Self {
            name: name.to_owned(),
            gauge,
            faults,
            sigma,
            rate: timing.rate,
            delay: timing.delay + faults.delay,
            channels: channels(model, name),
            random,
            next: 0.0,
            sent: VecDeque::new(),
        })
    }

    /// Whether a reading is due, and which comes then.
    fn is_due(&mut self, world: &World) -> bool {
        let Some(rate) = self.rate else { return true };
        let ticks = (world.state().time + ROUNDING * world.model().step) * rate;
        if ticks < self.next {
            return false;
        }
        self.next = ticks.floor() + 1.0;
        true
    }

    /// The value that the sensor gives for the world as it is.
    fn reading(&mut self, world: &World) -> [f64; 4] {
        // Drawn whether or not there is noise, so that another level scales it and draws no other.
        let mut normal = |_, _| -> f64 { StandardNormal.sample(&mut self.random) };
        let noise = self.sigma * Vec3::from_fn(&mut normal);
        match self.faults.apply(&self.gauge.read(world)) {
            Reading::Scalar(x) => [x + noise.x, 0.0, 0.0, 0.0],
            Reading::Vector(v) => [v.x + noise.x, v.y + noise.y, v.z + noise.z, 0.0],
            Reading::Rotation(q) => [q.w, q.i, q.j, q.k],
        }
    }
}

/// Its channels: those that the recorder has for it, or, of a force sensor, three components.
fn channels(model: &Model, name: &str) -> Vec<ChannelSpec> {
    let is_own = |spec: &ChannelSpec| whole(&spec.name).as_deref() == Some(name);
    let standard: Vec<ChannelSpec> = record::standard_channels(model).into_iter().filter(is_own).collect();
    if !standard.is_empty() {
        return standard.into_iter().map(|spec| spec.described("as its sensor reads it")).collect();
    }
    let unit = if name.ends_with("torque") { "N·m" } else { "N" };
    let channel = |k| ChannelSpec::new(format!("{name}.{k}"), unit, Plot::Sensors).described("as the sensor reads it");
    ["x", "y", "z"].map(channel).into()
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
        if self.is_due(world) {
            let reading = self.reading(world);
            self.sent.push_back((world.state().time + self.delay, reading));
        }
    }

    fn read(&mut self, world: &World, values: &mut Vec<f64>) {
        let now = world.state().time + ROUNDING * world.model().step;
        let mut last = [f64::NAN; 4];
        while let Some((_, reading)) = self.sent.pop_front_if(|(arrives, _)| *arrives <= now) {
            last = reading;
        }
        // A driven quantity has the components that are driven.
        let component = |spec: &ChannelSpec| match ChannelName::parse(&spec.name).map_or("", |name| name.component) {
            "x" if self.channels.len() == 4 => 1,
            "y" if self.channels.len() == 4 => 2,
            "z" if self.channels.len() == 4 => 3,
            "y" => 1,
            "z" => 2,
            _ => 0,
        };
        values.extend(self.channels.iter().map(|spec| last[component(spec)]));
    }
}
