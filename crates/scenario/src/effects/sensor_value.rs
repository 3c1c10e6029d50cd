//! A constant and a factor on what a sensor reads.

use super::contact_geometry_offset::{CONTACT_GEOMETRY_OFFSET, TURN};
use super::*;
use crate::measure::Gauge;
use parameter::{ANY, zero};
use unit::NONE;

const SOURCE: &str = "None needed; in `crates/scenario/src/measure/sensor.rs`.";

/// An offset.
pub static SENSOR_BIAS: EffectDef = EffectDef {
    name: "sensor-bias",
    meaning: "A constant added to a reading.",
    words: "a sensor bias",
    places: &[PlaceKind::Sensor],
    parameters: &[zero(
        "bias",
        ANY,
        NONE,
        "added to the reading, in the channel's unit; a number stands for each component",
    )
    .number_or_vector()],
    equation: "y = x + bias, after scale and misalignment.",
    source: SOURCE,
    build: Build::Sensor(SensorBuild {
        add: |sensor, entry| entry.components().for_each(|k| sensor.bias[k] += entry.value("bias", k).unwrap_or(0.0)),
        find_fault: orientations_have_none,
    }),
    identify: Identify {
        candidates: Candidates::Sensor(bias),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: Some(|place| if is_of_a_place(place) { SURVEYED } else { 0.0 }),
        nested: Some(|place, x| if is_of_a_place(place) { vec![moved(x, 1.0), moved(x, -1.0)] } else { Vec::new() }),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Reading,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// A factor.
pub static SENSOR_SCALE: EffectDef = EffectDef {
    name: "sensor-scale",
    meaning: "A factor on a reading.",
    words: "a wrong sensor scale factor",
    places: &[PlaceKind::Sensor],
    parameters: &[zero("scale", ANY, NONE, "reading over truth; a number stands for each component")
        .number_or_vector()
        .neutral_at(1.0)],
    equation: "y = scale · x, component by component, before the bias is added.",
    source: SOURCE,
    build: Build::Sensor(SensorBuild {
        add: |sensor, entry| entry.components().for_each(|k| sensor.scale[k] *= entry.value("scale", k).unwrap_or(1.0)),
        find_fault: orientations_have_none,
    }),
    identify: Identify {
        candidates: Candidates::Sensor(scale),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(
            |_, x| if x.len() == 3 { vec![Alternative::here(&SENSOR_SCALE, vec![mean(x)])] } else { Vec::new() },
        ),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Reading,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Factors by which a sensor may be wrong: beyond these its unit is, which an inspection of the recording tells.
const CREDIBLE: [f64; 2] = [0.5, 2.0];

fn orientations_have_none(gauges: &[Gauge]) -> Option<&'static str> {
    let turns = |g: &Gauge| g.quantity().is_orientation();
    let fault = "an orientation has neither bias nor scale; use sensor-misalignment";
    gauges.iter().all(turns).then_some(fault)
}

fn bias(sensor: &SensorFact) -> Vec<Candidate> {
    let sigma = sensor.sigma;
    if sensor.quantity.is_joint() {
        let coordinates = vec![Coordinate::free("bias", 0.0)];
        return vec![Candidate::new(sensor.place(), coordinates).screened(&[Along::new(0, sigma)])];
    }
    if sensor.is_orientation() {
        return Vec::new();
    }
    let vector = Coordinate::vector(["bias[0]", "bias[1]", "bias[2]"], [0.0; 3]);
    vec![Candidate::new(sensor.place(), vector).screened(&Along::each(sensor.axes.iter().copied(), sigma))]
}

/// One factor for all components, and one for each: three gyros are three sensors.
fn scale(sensor: &SensorFact) -> Vec<Candidate> {
    if sensor.is_orientation() {
        return Vec::new();
    }
    let one = vec![Coordinate::free("scale", 1.0).within(CREDIBLE)];
    let one = Candidate::new(sensor.place(), one).screened(&[Along::new(0, A_LITTLE)]);
    if sensor.axes.len() < 2 {
        return vec![one];
    }
    let each = Coordinate::vector(["scale[0]", "scale[1]", "scale[2]"], [1.0; 3]).into_iter();
    let each = each.map(|c| c.within(CREDIBLE)).collect();
    vec![one, Candidate::new(sensor.place(), each).screened(&Along::each(sensor.axes.iter().copied(), A_LITTLE))]
}

/// Step of a factor by which its column is taken.
const A_LITTLE: f64 = 1e-4;

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// What is held against the bias of a place beside the numbers that it takes: as much as two or three of these cost. Cameras are surveyed, parts are
/// bolted on.
const SURVEYED: f64 = 25.0;

fn is_of_a_place(place: &str) -> bool {
    place.starts_with("sensor:body.") && place.ends_with(".position")
}

/// Where only contacts tell places a place that is measured wrong by a constant cannot be told from a part that sits elsewhere.
fn moved(x: &[f64], sign: f64) -> Alternative {
    let coordinates = x.iter().map(|x| sign * x).chain([0.0; 3]).collect();
    Alternative { held: TURN.to_vec(), ..Alternative::at_contact(&CONTACT_GEOMETRY_OFFSET, coordinates) }
}
