//! Readings that are old.

use super::*;
use parameter::{ANY, zero};
use unit::S;

/// A dead time of the measurement.
pub static SENSOR_DELAY: EffectDef = EffectDef {
    name: "sensor-delay",
    meaning: "Readings that are old.",
    words: "a sensor delay",
    places: &[PlaceKind::Sensor],
    parameters: &[zero("delay", ANY, S, "age of a reading; below zero only in a replay of a recording")],
    equation: "y(t) = x(t − delay).",
    source: "None needed; in `crates/scenario/src/measure/sensor.rs`.",
    build: Build::Sensor(SensorBuild {
        add: |sensor, entry| sensor.delay += entry.value("delay", 0).unwrap_or(0.0),
        find_fault: |_| None,
    }),
    identify: Identify {
        candidates: Candidates::Sensor(|sensor| {
            let coordinates = vec![Coordinate::free("delay", 0.0).within([-0.2, 0.5])];
            vec![
                Candidate::new(sensor.place(), coordinates)
                    .screened(&[Along::new(0, 1e-4)])
                    .screened_at("late", &[vec![LATE]]),
            ]
        }),
        tier: Tier::Exotic,
        tolerance: Some(|tolerance, _| vec![tolerance.clock_s]),
        penalty: None,
        nested: None,
        start: Start::Proportional,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// Delay by which it is screened beside its derivative, s: what moves fast is elsewhere by then.
const LATE: f64 = 8e-3;
