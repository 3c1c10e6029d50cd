//! What the schema says of `[[effect]]`: for each effect its sentence, its places and its parameters, from the definitions.
//!
//! Conditions on the name (`if`, `then`) that editors complete and explain by. The parser looks past them: an entry is held against its
//! definition when it is built, with the nearest spelling and the way out.

use crate::effects::{EffectDef, Parameter, Shape, models};
use serde_json::{Map, Value, json};

/// Adds to the schema of a scenario what is known of effects.
pub(super) fn describe(schema: &mut Value) {
    let Some(item) = schema.pointer_mut("/properties/effect/items").and_then(Value::as_object_mut) else { return };
    let names: Vec<&str> = models().map(|effect| effect.name).collect();
    if let Some(name) = item.get_mut("properties").and_then(|p| p.get_mut("name")).and_then(Value::as_object_mut) {
        name.insert("examples".to_owned(), json!(names));
    }
    item.insert("allOf".to_owned(), models().map(condition).collect());
}

/// If an entry has this name, then these are its parameters.
fn condition(effect: &EffectDef) -> Value {
    let places: Vec<&str> = effect.places.iter().map(|place| place.text()).collect();
    let mut properties: Map<String, Value> =
        effect.parameters.iter().map(|p| (p.name.to_owned(), described(p))).collect();
    properties.insert("name".to_owned(), json!({ "description": effect.meaning }));
    properties.insert("place".to_owned(), json!({ "description": format!("Where: {}.", places.join(", ")) }));
    let required: Vec<&str> = effect.parameters.iter().filter(|p| p.is_required).map(|p| p.name).collect();
    json!({
        "if": { "properties": { "name": { "const": effect.name } }, "required": ["name"] },
        "then": { "properties": properties, "required": required },
    })
}

fn described(parameter: &Parameter) -> Value {
    match parameter.shape {
        Shape::Choice(words) => json!({ "description": parameter.sentence(), "enum": words }),
        Shape::Number | Shape::Vector | Shape::Tensor | Shape::NumberOrVector => {
            json!({ "description": parameter.sentence() })
        }
    }
}
