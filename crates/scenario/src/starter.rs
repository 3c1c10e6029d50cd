//! The scenario that `softdock new NAME` writes: it runs as it is, and its comments teach every section.

/// The starter, whose name stands for `NAME`.
const STARTER: &str = include_str!("starter.toml");

/// A commented starter scenario of this name; characters that a file or channel name cannot carry become `-`.
pub fn starter(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || c == '_' || c == '-' { c } else { '-' };
    let name: String = name.chars().map(plain).collect();
    STARTER.replace("NAME", if name.is_empty() { "my-scenario" } else { &name })
}
