//! Reads the values that a path leads to.

use super::assign::{assign, named_element, no_match};
use super::path::{Step, parse_path};
use crate::document::{Node, Origin, Value};
use crate::error::Problem;
use crate::schema::{element_path, join, scenario_schema};

/// Every node that `path` leads to, with its own path; at least one.
pub(crate) fn select<'n>(root: &'n Node, path: &str) -> Result<Vec<(String, &'n Node)>, Problem> {
    let steps = parse_path(path)?;
    let mut found = vec![(String::new(), root)];
    for (at, step) in steps.iter().enumerate() {
        let mut reason = "the scenario has none".to_owned();
        let next = found.iter().flat_map(|(path, node)| children(path, node, step, &mut reason)).collect::<Vec<_>>();
        if next.is_empty() {
            return Err(no_match(&steps, at, &reason));
        }
        found = next;
    }
    Ok(found)
}

/// The children of a node that a step means.
fn children<'n>(path: &str, node: &'n Node, step: &Step, reason: &mut String) -> Vec<(String, &'n Node)> {
    match (&node.value, step) {
        (Value::Table(table), Step::Key(key)) => {
            table.get(key).map(|entry| (join(path, key), &entry.node)).into_iter().collect()
        }
        (Value::Table(table), Step::Any) => table.iter().map(|(key, entry)| (join(path, key), &entry.node)).collect(),
        (Value::List(nodes), Step::Index(i)) => {
            nodes.get(*i).map(|n| (format!("{path}[{i}]"), n)).into_iter().collect()
        }
        (Value::List(nodes), Step::Any) => {
            nodes.iter().enumerate().map(|(i, n)| (element_path(path, i, n, unique(nodes)), n)).collect()
        }
        (Value::List(nodes), Step::Key(name)) => match named_element(nodes, name) {
            Ok(i) => vec![(join(path, name), &nodes[i])],
            Err(why) => {
                *reason = why;
                vec![]
            }
        },
        _ => vec![],
    }
}

/// Whether names tell the elements of a list apart.
fn unique(nodes: &[Node]) -> bool {
    let mut names: Vec<&str> = nodes.iter().filter_map(Node::name).collect();
    names.sort_unstable();
    names.windows(2).all(|pair| pair[0] != pair[1])
}

/// Whether a dispersion may set `path`: it leads somewhere, and a number may stand there.
pub(crate) fn check_number_path(root: &Node, path: &str) -> Result<(), Problem> {
    let steps = parse_path(path)?;
    let mut trial = root.clone();
    let number = Node { value: Value::Float(0.5), origin: Origin::File(0) };
    assign(&mut trial, scenario_schema(), &steps, &number)?;
    let text = select(root, path).ok().and_then(|found| found.iter().find_map(|(_, node)| not_a_number(node)));
    match text {
        Some(what) => Err(no_match(&steps, steps.len(), &format!("it holds {what}; only numbers can be dispersed"))),
        None => Ok(()),
    }
}

/// What a node is, where it is no number.
fn not_a_number(node: &Node) -> Option<String> {
    node.number().is_none().then(|| node.describe())
}
