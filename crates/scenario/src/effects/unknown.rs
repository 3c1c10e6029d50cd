//! What a diagnosis says of physics that no effect explains; it is no model.

use super::*;

/// A diagnosis.
pub static UNKNOWN: EffectDef = EffectDef {
    name: "unknown",
    meaning: "Significant, and none of the others; a diagnosis, not a model.",
    words: "something that the library does not have",
    places: &[
        PlaceKind::Joint,
        PlaceKind::Link,
        PlaceKind::Body,
        PlaceKind::Contact,
        PlaceKind::Actuator,
        PlaceKind::Sensor,
        PlaceKind::World,
    ],
    parameters: &[],
    equation: "None: the residual's own law is reported instead.",
    source: "None.",
    build: Build::NoModel,
    identify: Identify {
        candidates: Candidates::Nowhere,
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};
