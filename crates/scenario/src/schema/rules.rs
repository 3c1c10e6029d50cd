//! Rules between the keys of a table, between the numbers of a list, and between tables.

use super::TableView;
use super::check::{Checker, table_words};
use crate::document::{Node, Table};
use crate::error::Problem;
use crate::spelling::one_of;
use serde_json::Value;

/// A unit quaternion may be this far off, so that four decimals are enough; it is normalised afterwards.
const UNIT_TOLERANCE: f64 = 1e-2;

/// Lists of key names in an extension of the schema.
fn key_groups<'s>(part: &'s Value, extension: &str) -> Vec<Vec<&'s str>> {
    let groups = part.get(extension).and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    groups.iter().map(|group| group.as_array().into_iter().flatten().filter_map(Value::as_str).collect()).collect()
}

/// The rules between the keys of one table.
pub(super) fn table(checker: &mut Checker<'_>, view: &TableView<'_>, (node, table): (&Node, &Table), path: &str) {
    for part in &view.parts {
        for keys in key_groups(part, "x-exactly-one") {
            exclusive(checker, &keys, (node, table), path);
            let typo = table.keys().any(|key| view.key(key).is_none());
            if !typo && !keys.iter().any(|key| table.contains_key(*key)) {
                let rule = format!("needs {}", one_of(&keys));
                checker.complain(node.origin, Problem::Conflict { table: table_words(path), rule });
            }
        }
        for keys in key_groups(part, "x-at-most-one") {
            exclusive(checker, &keys, (node, table), path);
        }
        for keys in key_groups(part, "x-ordered") {
            ordered(checker, &keys, table, path);
        }
        dependent(checker, part, table, path);
    }
}

/// At most one of the keys is there; the complaint stands at the second.
fn exclusive(checker: &mut Checker<'_>, keys: &[&str], (_, table): (&Node, &Table), path: &str) {
    let present: Vec<_> = keys.iter().filter_map(|key| table.get_key_value(*key)).collect();
    if let [(first, _), (second, entry), ..] = present.as_slice() {
        let rule = format!("`{first}` and `{second}` exclude each other; keep one of them");
        checker.complain(entry.key_origin, Problem::Conflict { table: table_words(path), rule });
    }
}

/// The first number is no larger than the second.
fn ordered(checker: &mut Checker<'_>, keys: &[&str], table: &Table, path: &str) {
    let [low, high] = keys else { return };
    let (Some(a), Some(b)) = (table.get(*low), table.get(*high)) else { return };
    if let (Some(x), Some(y)) = (a.node.number(), b.node.number())
        && x > y
    {
        let rule = format!("`{low}` = {x} must not exceed `{high}` = {y}");
        checker.complain(b.node.origin, Problem::Conflict { table: table_words(path), rule });
    }
}

/// Keys that need another.
fn dependent(checker: &mut Checker<'_>, part: &Value, table: &Table, path: &str) {
    let Some(needs) = part.get("dependentRequired").and_then(Value::as_object) else { return };
    for (key, others) in needs {
        let Some(entry) = table.get(key) else { continue };
        let missing = others.as_array().into_iter().flatten().filter_map(Value::as_str);
        for other in missing.filter(|other| !table.contains_key(*other)) {
            let rule = format!("`{key}` does nothing without `{other}`; give both or neither");
            checker.complain(entry.key_origin, Problem::Conflict { table: table_words(path), rule });
        }
    }
}

/// The rules for lists of numbers.
pub(super) fn vector(checker: &mut Checker<'_>, schema: &Value, node: &Node, path: &str) {
    let rule = |key: &str| schema.get(key).is_some();
    let numbers: Vec<f64> = node.list().iter().filter_map(Node::number).collect();
    let complete = numbers.len() == node.list().len() && numbers.iter().all(|x| x.is_finite());
    let norm = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
    let demand = if rule("x-nonzero") && complete && norm == 0.0 {
        "must not be the zero vector".to_owned()
    } else if rule("x-unit-quaternion") && complete && numbers.len() == 4 && (norm - 1.0).abs() > UNIT_TOLERANCE {
        format!("must be a unit quaternion, scalar first; its norm is {norm:.4}")
    } else if rule("x-ascending") && !ascends(node.list()) {
        "must ascend (points: in time)".to_owned()
    } else {
        return;
    };
    checker.complain(node.origin, Problem::OutOfRange { key: path.to_owned(), found: node.quote(), demand });
}

/// Whether numbers, or the first numbers of points, never fall.
fn ascends(nodes: &[Node]) -> bool {
    let first = |node: &Node| node.number().or_else(|| node.list().first()?.number());
    let times: Vec<f64> = nodes.iter().filter_map(first).collect();
    times.windows(2).all(|pair| pair[0] <= pair[1])
}

/// Rules across tables.
pub(super) fn whole(root: &Node, checker: &mut Checker<'_>) {
    step_within_duration(root, checker);
    two_vehicles(root, checker);
}

/// A run has at least one step.
fn step_within_duration(root: &Node, checker: &mut Checker<'_>) {
    let step = root.child("integrator").and_then(|integrator| integrator.child("step_s"));
    let (Some(step), Some(duration)) = (step, root.child("duration_s").and_then(Node::number)) else { return };
    if let Some(step_s) = step.number().filter(|step_s| *step_s > duration && duration > 0.0) {
        let (key, found) = ("integrator.step_s".to_owned(), format!("{step_s}"));
        let demand = format!("must not exceed `duration_s` = {duration}");
        checker.complain(step.origin, Problem::OutOfRange { key, found, demand });
    }
}

/// Nobody captures itself.
fn two_vehicles(root: &Node, checker: &mut Checker<'_>) {
    let Some(strategy) = root.child("strategy") else { return };
    let (Some(servicer), Some(target)) = (strategy.child("servicer"), strategy.child("target")) else { return };
    if servicer.text().is_some() && servicer.text() == target.text() {
        let rule = "`servicer` and `target` are the same vehicle; name two".to_owned();
        checker.complain(target.origin, Problem::Conflict { table: "`strategy`".to_owned(), rule });
    }
}
