//! A run as it is logged: signals, link poses, contacts and events, at the logging rate.
//!
//! Filled sample by sample with [`Log::push`]; the sinks read it when the run is over. The memory it takes is
//! bounded by the logging rate, not by the step.

use crate::{ChannelSpec, RecordError, Signals};
use spatial::{Pose, Vec3};

/// What a run is, for headers and identifiers.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Meta {
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the run.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// The exact inputs (scenario text after overrides): two runs with equal inputs share an identifier.
    pub inputs: String,
    /// Further pairs for file headers, in this order.
    pub notes: Vec<(String, String)>,
}

impl Meta {
    /// Identifier of the run: equal for equal scenario, seed, version and inputs, on every machine.
    pub fn run_id(&self) -> String {
        let mut hash = Fnv::new();
        for part in [&self.scenario, &self.version, &self.inputs] {
            hash.add(part.as_bytes());
        }
        hash.add(&self.seed.to_le_bytes());
        format!("{}-{}-{:016x}", self.scenario, self.seed, hash.0)
    }
}

/// FNV-1a, 64 bits: small, stable for ever; not for security.
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    /// The bytes and their number, so that ("ab", "c") and ("a", "bc") differ.
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().chain(&(bytes.len() as u64).to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// One contact point at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSample {
    /// Index into [`Log::pairs`].
    pub pair: usize,
    /// Where, W axes, m.
    pub point_w: Vec3,
    /// Normal force on body B, W axes, N.
    pub normal_force_w: Vec3,
    /// Friction force on body B, W axes, N.
    pub friction_force_w: Vec3,
    /// Whether the bristle sticks (`false`: it slides).
    pub sticking: bool,
    /// Share of the friction limit in use, |fₜ| / (μ fₙ), 0 to 1.
    pub friction_use: f64,
}

/// What kind of thing happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EventKind {
    /// The strategy enters a phase; the text is the phase's name.
    Phase,
    /// First touch of a pair.
    Contact,
    /// The target is held.
    Capture,
    /// The target is lost.
    Loss,
    /// A limit was reached: joint, actuator, time.
    Limit,
    /// Anything else worth telling.
    Note,
}

impl EventKind {
    /// Lower-case key.
    pub fn key(self) -> &'static str {
        match self {
            Self::Phase => "phase",
            Self::Contact => "contact",
            Self::Capture => "capture",
            Self::Loss => "loss",
            Self::Limit => "limit",
            Self::Note => "note",
        }
    }
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When, s.
    pub t: f64,
    /// At which step.
    pub step: u64,
    /// What kind.
    pub kind: EventKind,
    /// What, for people.
    pub text: String,
}

/// All that is logged at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Simulated time, s.
    pub t: f64,
    /// Steps done.
    pub step: u64,
    /// One value per channel, in the order of the specs; NaN: not sampled.
    pub values: &'a [f64],
    /// Pose of every link of the scene in W, vehicles in order.
    pub poses_w: &'a [Pose],
    /// The contact points.
    pub contacts: &'a [ContactSample],
}

/// A logged run.
#[derive(Clone, Debug, Default)]
pub struct Log {
    /// What run it is.
    pub meta: Meta,
    /// Names of the contact pairs, `servicer/finger_left – target/grapple_bar`.
    pub pairs: Vec<String>,
    /// The signals.
    pub signals: Signals,
    /// Steps done at each instant.
    pub steps: Vec<u64>,
    /// Contact points at each instant.
    pub contacts: Vec<Vec<ContactSample>>,
    /// Events in order of time.
    pub events: Vec<Event>,
    poses_w: Vec<Pose>,
    link_count: usize,
}

impl Log {
    /// An empty log for these channels and as many links as the scene has.
    pub fn new(meta: Meta, channels: Vec<ChannelSpec>, link_count: usize) -> Self {
        Self { meta, signals: Signals::new(channels), link_count, ..Self::default() }
    }

    /// Appends what was at one instant. Instants come in order of time.
    pub fn push(&mut self, sample: &Sample<'_>) -> Result<(), RecordError> {
        self.check(sample)?;
        self.signals.times.push(sample.t);
        for (channel, value) in self.signals.channels.iter_mut().zip(sample.values) {
            channel.values.push(*value);
        }
        self.steps.push(sample.step);
        self.poses_w.extend_from_slice(sample.poses_w);
        self.contacts.push(sample.contacts.to_vec());
        Ok(())
    }

    /// Number of instants.
    pub fn len(&self) -> usize {
        self.signals.times.len()
    }

    /// Whether nothing has been logged.
    pub fn is_empty(&self) -> bool {
        self.signals.times.is_empty()
    }

    /// Number of links.
    pub fn link_count(&self) -> usize {
        self.link_count
    }

    /// Pose of every link in W at instant `i`.
    pub fn poses_w(&self, i: usize) -> &[Pose] {
        &self.poses_w[i * self.link_count..(i + 1) * self.link_count]
    }

    /// Instant `i` as it was pushed.
    pub fn sample<'a>(&'a self, i: usize, values: &'a mut Vec<f64>) -> Sample<'a> {
        values.clear();
        values.extend(self.signals.channels.iter().map(|channel| channel.values[i]));
        Sample {
            t: self.signals.times[i],
            step: self.steps[i],
            values,
            poses_w: self.poses_w(i),
            contacts: &self.contacts[i],
        }
    }

    /// Largest normal or friction force on one point in the whole run, N.
    pub fn peak_contact_force(&self) -> f64 {
        let size = |c: &ContactSample| c.normal_force_w.norm().max(c.friction_force_w.norm());
        self.contacts.iter().flatten().map(size).fold(0.0, f64::max)
    }

    fn check(&self, sample: &Sample<'_>) -> Result<(), RecordError> {
        let wrong = |what, got, expected| RecordError::Sample { t: sample.t, what, got, expected };
        if sample.values.len() != self.signals.channels.len() {
            return Err(wrong("values", sample.values.len(), self.signals.channels.len()));
        }
        if sample.poses_w.len() != self.link_count {
            return Err(wrong("poses", sample.poses_w.len(), self.link_count));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Plot;

    #[test]
    fn run_id_tells_inputs_apart_and_repeats() {
        let a = Meta { scenario: "tumble".into(), seed: 7, inputs: "mu = 0.3".into(), ..Meta::default() };
        let b = Meta { inputs: "mu = 0.2".into(), ..a.clone() };
        assert_eq!(a.run_id(), a.clone().run_id());
        assert_ne!(a.run_id(), b.run_id());
        assert!(a.run_id().starts_with("tumble-7-"));
    }

    #[test]
    fn sample_of_the_wrong_size_is_refused() {
        let mut log = Log::new(Meta::default(), vec![ChannelSpec::new("a", "m", Plot::Other)], 0);
        let sample = Sample { t: 0.5, step: 0, values: &[], poses_w: &[], contacts: &[] };
        let message = log.push(&sample).map_err(|e| e.to_string());
        assert_eq!(message, Err("sample at t = 0.5 s has 0 values, the log was made for 1".into()));
        assert!(log.is_empty());
    }
}
