//! Faults of a sensor: what it makes of the value that it should read.
//!
//!   y(t) = scale · exp(angle)ᵀ x(t − delay) + bias,      an orientation  q(t − delay) exp(angle)
//!
//! `angle` is the rotation vector of the true sensor in its nominal frame. The effects sensor-bias, sensor-scale, sensor-delay
//! and sensor-misalignment at `sensor:<channel prefix>` give it; several at one sensor come together. A prefix that names one
//! component faults that component.

use super::resolve::{all_names, synonyms};
use super::{Gauge, Reading};
use crate::effects::{self, Build, SensorBuild};
use crate::spec::{Effect, ParamValue, Scenario};
use crate::spelling::hint_for_name;
use sim::Model;
use spatial::{Vec3, exp_rotation};

/// A sensor with faults; the default has none and changes no bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorModel {
    /// Added to the reading; of a number, x.
    pub bias: Vec3,
    /// Factors; of a number, x.
    pub scale: Vec3,
    /// Age of what is read, s.
    pub delay: f64,
    /// Rotation vector of the true sensor in its nominal frame, rad.
    pub angle: Vec3,
}

impl Default for SensorModel {
    fn default() -> Self {
        Self { bias: Vec3::zeros(), scale: Vec3::repeat(1.0), delay: 0.0, angle: Vec3::zeros() }
    }
}

impl SensorModel {
    /// What the effects of a scenario make of the sensor of a quantity (`body.target.angular_velocity`), by whichever of its
    /// names they call it.
    pub fn of(effects: &[Effect], model: &Model, quantity: &str) -> Self {
        if !effects.iter().any(|effect| build_of(effect).is_some()) {
            return Self::default();
        }
        Self::of_names(effects, &synonyms(model, quantity))
    }

    /// The same with the delay that the scenario's own sensor of it has.
    pub fn late(scenario: &Scenario, model: &Model, quantity: &str) -> Self {
        let mut sensor = Self::of(&scenario.effects, model, quantity);
        sensor.delay += crate::sensors::delay_of(scenario, model, quantity);
        sensor
    }

    fn of_names(effects: &[Effect], names: &[String]) -> Self {
        let mut sensor = Self::default();
        for effect in effects {
            let Some(build) = build_of(effect) else { continue };
            if let Some(part) = part_of_any(&effect.place, names) {
                (build.add)(&mut sensor, &SensorEntry { effect, part });
            }
        }
        sensor
    }

    /// What the sensor makes of a value; its delay is the caller's business.
    #[inline]
    pub fn apply(&self, value: &Reading) -> Reading {
        if self.is_faultless() {
            return *value;
        }
        match *value {
            Reading::Scalar(x) => Reading::Scalar(self.scale.x * x + self.bias.x),
            Reading::Vector(v) => {
                let seen = if self.angle == Vec3::zeros() { v } else { exp_rotation(&-self.angle) * v };
                Reading::Vector(self.scale.component_mul(&seen) + self.bias)
            }
            Reading::Rotation(q) => Reading::Rotation(q * exp_rotation(&self.angle)),
        }
    }

    /// Whether it shows what is there. Asked at every reading of every replay: by plain numbers.
    #[inline]
    fn is_faultless(&self) -> bool {
        let [bias, scale, angle] = [&self.bias, &self.scale, &self.angle].map(|v| v.data.0[0]);
        bias == [0.0; 3] && scale == [1.0; 3] && angle == [0.0; 3]
    }
}

/// What stands before the prefix of channels in the place of a sensor.
const PREFIX: &str = "sensor:";

/// The part of a quantity that a prefix of channels means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    All,
    Component(usize),
}

/// The effect of a sensor on the part of a quantity that its place means.
pub(crate) struct SensorEntry<'a> {
    effect: &'a Effect,
    part: Part,
}

impl SensorEntry<'_> {
    /// The components that it means.
    pub(crate) fn components(&self) -> impl Iterator<Item = usize> + use<> {
        let part = self.part;
        (0..3).filter(move |k| part == Part::All || part == Part::Component(*k))
    }

    /// The `k`-th number of a parameter that is given; a single number stands for each.
    pub(crate) fn value(&self, parameter: &str, k: usize) -> Option<f64> {
        match self.numbers(parameter) {
            [only] => Some(*only),
            numbers => numbers.get(k).copied(),
        }
    }

    /// The `k`-th number of a vector that is given.
    pub(crate) fn entry(&self, parameter: &str, k: usize) -> Option<f64> {
        self.numbers(parameter).get(k).copied()
    }

    fn numbers(&self, parameter: &str) -> &[f64] {
        self.effect.params.get(parameter).and_then(ParamValue::numbers).unwrap_or_default()
    }
}

/// What an effect makes of a sensor, where it is one of a sensor. Asked for every channel of every model that a search builds: by the place first.
fn build_of(effect: &Effect) -> Option<SensorBuild> {
    effect.place.strip_prefix(PREFIX)?;
    match effects::find(&effect.name)?.build {
        Build::Sensor(build) => Some(build),
        Build::SetMass(_)
        | Build::AddMass(_)
        | Build::Rotor(_)
        | Build::Gear(_)
        | Build::Effort(_)
        | Build::EffortOrLoad { .. }
        | Build::Command(_)
        | Build::ThrustAxis(_)
        | Build::Load(_)
        | Build::Part(_)
        | Build::Acceleration(_)
        | Build::Pair(_)
        | Build::Pose(_)
        | Build::Mount(_)
        | Build::Mechanism(_)
        | Build::NoModel => None,
    }
}

/// The part that a place, `sensor:` and a prefix, means of a quantity of these names.
fn part_of_any(place: &str, names: &[String]) -> Option<Part> {
    let prefix = place.strip_prefix(PREFIX)?;
    names.iter().find_map(|name| part_of(prefix, name))
}

/// What is wrong with the effect of a sensor: its place means no channel, or none on which it can act. Nothing is with other effects.
pub(crate) fn find_fault(scenario: &Scenario, model: &Model, effect: &Effect) -> Option<String> {
    let build = build_of(effect)?;
    let all = all_names(scenario, model);
    let meant: Vec<&Vec<String>> = all.iter().filter(|names| part_of_any(&effect.place, names).is_some()).collect();
    let prefix = effect.place.strip_prefix(PREFIX).unwrap_or(&effect.place);
    if meant.is_empty() {
        return Some(format!(
            "no channel begins with \"{prefix}\"{}",
            hint_for_name(prefix, all.iter().flatten().map(String::as_str))
        ));
    }
    let quantity = |names: &&Vec<String>| Gauge::resolve(scenario, model, &names[0]).ok();
    let gauges: Vec<Gauge> = meant.iter().filter_map(quantity).collect();
    (build.find_fault)(&gauges).map(str::to_owned)
}

/// A prefix ends where a word of the channel ends: `body.a` is not of `body.ab`.
fn part_of(prefix: &str, quantity: &str) -> Option<Part> {
    let begins =
        |long: &str, short: &str| long == short || long.strip_prefix(short).is_some_and(|r| r.starts_with('.'));
    if begins(quantity, prefix) {
        return Some(Part::All);
    }
    let component = prefix.strip_prefix(quantity)?.strip_prefix('.')?;
    ["x", "y", "z"].iter().position(|k| *k == component).map(Part::Component)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::Rot;

    fn effect(name: &str, place: &str, key: &str, value: ParamValue) -> Effect {
        Effect { name: name.to_owned(), place: place.to_owned(), params: [(key.to_owned(), value)].into() }
    }

    fn of(effects: &[Effect], quantity: &str) -> SensorModel {
        SensorModel::of_names(effects, &[quantity.to_owned()])
    }

    const GYRO: &str = "body.target.angular_velocity";

    #[test]
    fn a_sensor_without_faults_changes_no_bit() {
        let value = Reading::Vector(Vec3::new(0.1, -0.0, 1e-300));
        assert_eq!(SensorModel::default().apply(&value), value);
        let neutral = [
            effect("sensor-bias", "sensor:body.target", "bias", ParamValue::Number(0.0)),
            effect("sensor-scale", "sensor:body.target", "scale", ParamValue::Number(1.0)),
        ];
        assert_eq!(of(&neutral, GYRO), SensorModel::default());
        let beside = [effect("sensor-scale", "sensor:body.target", "scale", ParamValue::Number(1.0 + 1e-6))];
        assert_ne!(of(&beside, GYRO).apply(&value), value);
    }

    #[test]
    fn a_sensor_turned_by_a_quarter_about_z_reads_x_as_minus_y() {
        let angle = vec![0.0, 0.0, std::f64::consts::FRAC_PI_2];
        let turned = [effect("sensor-misalignment", &format!("sensor:{GYRO}"), "angle", ParamValue::Numbers(angle))];
        let sensor = of(&turned, GYRO);
        let Reading::Vector(seen) = sensor.apply(&Reading::Vector(Vec3::x())) else { panic!("a vector") };
        assert!((seen + Vec3::y()).norm() < 1e-15, "{seen}");
        let body = Rot::from_euler_angles(0.3, -0.2, 0.9);
        let Reading::Rotation(attitude) = sensor.apply(&Reading::Rotation(body)) else { panic!("a rotation") };
        // The attitude of the true sensor: its x axis is the body's y.
        assert!((attitude * Vec3::x() - body * Vec3::y()).norm() < 1e-15);
    }

    #[test]
    fn factors_and_constants_of_one_sensor_come_together_and_of_another_not() {
        let all = [
            effect(
                "sensor-bias",
                "sensor:body.target.angular_velocity",
                "bias",
                ParamValue::Numbers(vec![1.0, 2.0, 3.0]),
            ),
            effect("sensor-scale", "sensor:body.target", "scale", ParamValue::Number(2.0)),
            effect("sensor-bias", "sensor:body.target.angular_velocity.y", "bias", ParamValue::Number(0.5)),
            effect("sensor-bias", "sensor:body.tar", "bias", ParamValue::Number(100.0)),
            effect("sensor-delay", "sensor:body.target", "delay", ParamValue::Number(0.02)),
        ];
        let sensor = of(&all, GYRO);
        assert_eq!(sensor.apply(&Reading::Vector(Vec3::repeat(1.0))), Reading::Vector(Vec3::new(3.0, 4.5, 5.0)));
        assert_eq!(sensor.delay, 0.02);
    }
}
