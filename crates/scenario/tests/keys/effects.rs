//! The effects of an answer key, as a scenario file has them.

use serde_json::Value;

/// Its `[[effect]]` entries.
pub fn effects_toml(key: &Value) -> String {
    let mut text = String::new();
    for effect in key["effects"].as_array().unwrap() {
        text += &format!("\n[[effect]]\nname = {}\nplace = {}\n", effect["name"], effect["place"]);
        for (name, value) in effect["params"].as_object().unwrap() {
            text += &format!("{name} = {value}\n");
        }
    }
    text
}
