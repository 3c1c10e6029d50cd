//! Texts that name something else in the scenario: a vehicle, a link of one, an actuator, a path.
//!
//! Links and joints themselves are in the URDFs, which nothing here opens: of `vehicle/link` the vehicle is checked.

use super::check::Checker;
use crate::document::{Node, shortened};
use crate::error::Problem;
use crate::glob::is_glob;
use crate::overrides;
use crate::spelling::hint_for_name;

/// The kinds of places that an effect may have.
const PLACES: &[&str] = &["joint", "link", "body", "contact", "actuator", "mechanism", "sensor", "world"];

/// The names that others refer to.
pub(super) struct Names<'a> {
    root: &'a Node,
    vehicles: Vec<&'a str>,
    actuators: Vec<&'a str>,
    mechanisms: Vec<&'a str>,
    sensors: Vec<&'a str>,
}

impl<'a> Names<'a> {
    /// Collects them.
    pub(super) fn of(root: &'a Node) -> Self {
        let names = |key: &str| {
            let nodes = root.child(key).map(Node::list).unwrap_or_default();
            nodes.iter().filter_map(Node::name).collect()
        };
        Self {
            root,
            vehicles: names("vehicle"),
            actuators: names("actuator"),
            mechanisms: names("mechanism"),
            sensors: names("sensor"),
        }
    }
}

/// Complains of a text that names nothing.
pub(super) fn check(checker: &mut Checker<'_>, kind: &str, (node, text): (&Node, &str), path: &str) {
    let problem = match kind {
        "vehicle" => known(&checker.names.vehicles, "vehicle", text, path),
        "actuator" => actuator(&checker.names, text, path),
        "mechanism" => known(&checker.names.mechanisms, "mechanism", text, path),
        "sensor" => known(&checker.names.sensors, "sensor", text, path),
        "vehicle/part" if text == "world" => None,
        "vehicle/part" => part(&checker.names, text, path),
        "pattern" => pattern(&checker.names, text, path),
        "place" => place(&checker.names, text, path),
        "path" => overrides::check_number_path(checker.names.root, text).err(),
        _ => None,
    };
    if let Some(problem) = problem {
        checker.complain(node.origin, problem);
    }
}

/// A name that must be one of `valid`.
fn known(valid: &[&str], what: &str, name: &str, path: &str) -> Option<Problem> {
    if valid.contains(&name) {
        return None;
    }
    let hint = hint_for_name(name, valid.iter().copied());
    Some(Problem::UnknownName { key: path.to_owned(), what: what.to_owned(), name: shortened(name), hint })
}

/// An actuator; one of a drive of several joints is `drive/joint`.
fn actuator(names: &Names<'_>, text: &str, path: &str) -> Option<Problem> {
    known(&names.actuators, "actuator", text.split('/').next().unwrap_or(text), path)
}

/// `vehicle/link` or `vehicle/joint`.
fn part(names: &Names<'_>, text: &str, path: &str) -> Option<Problem> {
    match text.split_once('/') {
        Some((vehicle, part)) if !part.is_empty() => known(&names.vehicles, "vehicle", vehicle, path),
        _ => {
            let found = format!("\"{}\"", shortened(text));
            let example = names.vehicles.first().copied().unwrap_or("vehicle");
            let demand = format!(
                "must be written as vehicle/name, e.g. \"{example}/…\", or \"world/…\" for what stands in the world"
            );
            Some(Problem::OutOfRange { key: path.to_owned(), found, demand })
        }
    }
}

/// A glob, or as [`part`]; the vehicle's part of it may be a glob too.
fn pattern(names: &Names<'_>, text: &str, path: &str) -> Option<Problem> {
    let vehicle = text.split('/').next().unwrap_or(text);
    match (is_glob(vehicle), vehicle) {
        (true, _) | (_, "world") => None,
        _ => part(names, text, path),
    }
}

/// The place of an effect; what is behind the colon is a matter of the model, save the names that stand in the file.
fn place(names: &Names<'_>, text: &str, path: &str) -> Option<Problem> {
    let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
    if (kind == "world") != rest.is_empty() || !PLACES.contains(&kind) {
        let key = path.to_owned();
        if !PLACES.contains(&kind) {
            let hint = hint_for_name(kind, PLACES.iter().copied());
            return Some(Problem::UnknownName { key, what: "kind of place".into(), name: shortened(kind), hint });
        }
        let found = format!("\"{}\"", shortened(text));
        let demand = "must be kind:name, e.g. \"joint:servicer/elbow\", or \"world\"".to_owned();
        return Some(Problem::OutOfRange { key, found, demand });
    }
    match (kind, rest.split_once('/')) {
        ("actuator", _) if is_glob(rest) => None,
        ("actuator", _) => actuator(names, rest, path),
        ("mechanism", _) if is_glob(rest) => None,
        ("mechanism", _) => known(&names.mechanisms, "mechanism", rest, path),
        ("joint" | "link" | "body", Some((vehicle, _))) if !is_glob(vehicle) => {
            known(&names.vehicles, "vehicle", vehicle, path)
        }
        _ => None,
    }
}
