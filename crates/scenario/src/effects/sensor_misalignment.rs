//! A sensor that is turned against its drawing.

use super::*;
use crate::measure::Gauge;
use parameter::{ANY, zero};
use spatial::Vec3;
use unit::RAD;

/// A rotation vector.
pub static SENSOR_MISALIGNMENT: EffectDef = EffectDef {
    name: "sensor-misalignment",
    meaning: "A sensor that is turned.",
    words: "a misaligned sensor",
    places: &[PlaceKind::Sensor],
    parameters: &[zero("angle", ANY, RAD, "rotation vector of the true sensor in its nominal frame").vector()],
    equation: "y = exp(angle)ᵀ x of a vector, q exp(angle) of an orientation; before scale and bias.",
    source: "Geometry; in `crates/scenario/src/measure/sensor.rs`.",
    build: Build::Sensor(SensorBuild {
        add: |sensor, entry| sensor.angle += Vec3::from_fn(|k, _| entry.entry("angle", k).unwrap_or(0.0)),
        find_fault: |gauges| {
            let fault = "a single number has no direction; use sensor-bias or sensor-scale";
            gauges.iter().all(Gauge::is_scalar).then_some(fault)
        },
    }),
    identify: Identify {
        candidates: Candidates::Sensor(candidates),
        tier: Tier::Exotic,
        tolerance: Some(|tolerance, _| vec![tolerance.mount_deg.to_radians(); 3]),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Reading,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

fn candidates(sensor: &SensorFact) -> Vec<Candidate> {
    if sensor.quantity.is_joint() {
        return Vec::new();
    }
    // In the plane only the turn in it shows.
    let shown = if sensor.axes.len() == 3 { 0..3 } else { 2..3 };
    let vector = Coordinate::vector(["angle[0]", "angle[1]", "angle[2]"], [0.0; 3]);
    vec![Candidate::new(sensor.place(), vector).screened(&Along::each(shown, 1e-5))]
}
