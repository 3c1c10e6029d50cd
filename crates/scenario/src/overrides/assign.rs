//! Puts a value where a path leads, guided by the schema where the file says nothing.

use super::path::{Step, path_text};
use crate::document::{Entry, Node, Origin, Table, Value as Tree};
use crate::error::Problem;
use crate::schema::{self, TableView};
use crate::spelling::{hint_for_key, hint_for_name, listed};
use serde_json::Value;
use std::collections::BTreeMap;

/// Sets every value that `steps` leads to; at least one.
pub(super) fn assign(root: &mut Node, schema: &Value, steps: &[Step], value: &Node) -> Result<(), Problem> {
    Walk { path: steps, value }.node(root, schema, 0, false).map(|_| ())
}

/// One assignment on its way.
struct Walk<'a> {
    path: &'a [Step],
    value: &'a Node,
}

impl Walk<'_> {
    /// Goes on from `node` with step `at`; gives the number of values set. `wild`: a `*` lies behind, so that a branch
    /// in which the rest of the path has no place is passed over.
    fn node(&self, node: &mut Node, schema: &Value, at: usize, wild: bool) -> Result<usize, Problem> {
        let Some(step) = self.path.get(at) else {
            *node = self.value.clone();
            return Ok(1);
        };
        match &mut node.value {
            Tree::Table(table) => self.table(table, schema, (at, step), wild),
            Tree::List(nodes) => self.list(nodes, schema, (at, step), wild),
            _ => Err(self.no_match(at, format!("it holds {}, which has no parts", node.describe()))),
        }
    }

    /// A step from a table.
    fn table(
        &self,
        table: &mut Table,
        schema: &Value,
        (at, step): (usize, &Step),
        wild: bool,
    ) -> Result<usize, Problem> {
        match step {
            Step::Key(key) => self.key(table, schema, (at, key), wild),
            Step::Any => {
                let keys: Vec<String> = table.keys().cloned().collect();
                let results: Vec<_> = keys.iter().map(|key| self.key(table, schema, (at, key), true)).collect();
                self.any(results, at)
            }
            Step::Index(i) => {
                Err(self.no_match(at, format!("it is a table, which has keys and no [{i}]: {}", keys_of(table))))
            }
        }
    }

    /// A key of a table; where it is absent and the schema knows it, it is put in.
    fn key(&self, table: &mut Table, schema: &Value, (at, key): (usize, &str), wild: bool) -> Result<usize, Problem> {
        let schema = schema::table_schema(schema).unwrap_or(schema);
        let view = TableView::of(schema, table);
        let Some(child) = view.key(key) else {
            return Err(self.unknown_key(&view, at, key));
        };
        let last = at + 1 == self.path.len();
        if let Some(entry) = table.get_mut(key) {
            if last {
                entry.key_origin = self.value.origin;
            }
            let count = self.node(&mut entry.node, child, at + 1, wild)?;
            if last && schema::is_tag(schema, key) {
                drop_foreign_keys(table, schema);
            }
            return Ok(count);
        }
        let mut node = match self.absent(child, at, wild) {
            Some(node) => node,
            None if wild => return Err(self.no_match(at, format!("`{key}` is absent there"))),
            None => {
                let whole = path_text(&self.path[..=at]);
                return Err(self.no_match(at + 1, format!("the file says nothing; set all of it, `{whole}=…`")));
            }
        };
        let count = self.node(&mut node, child, at + 1, wild)?;
        table.insert(key.to_owned(), Entry { key_origin: self.value.origin, node });
        Ok(count)
    }

    /// What an absent key holds before the rest of the path changes it: anything for the last one, the default where
    /// there is one, or else a table to be filled; not under a `*`, where a branch without it is not meant.
    fn absent(&self, schema: &Value, at: usize, wild: bool) -> Option<Node> {
        let origin = self.value.origin;
        let empty = Node { value: Tree::Table(BTreeMap::new()), origin };
        match schema.get("default") {
            _ if at + 1 == self.path.len() => Some(empty),
            Some(default) => Some(Node::from_json(default, origin)),
            None => (!wild && schema::table_schema(schema).is_some()).then_some(empty),
        }
    }

    /// A step from a list.
    fn list(
        &self,
        nodes: &mut [Node],
        schema: &Value,
        (at, step): (usize, &Step),
        wild: bool,
    ) -> Result<usize, Problem> {
        let item = schema::item_schema(schema).unwrap_or(&Value::Null);
        match step {
            Step::Index(i) => match nodes.get_mut(*i) {
                Some(node) => self.node(node, item, at + 1, wild),
                None => Err(self.no_match(at, format!("it has {}, counted from 0", count_of(nodes)))),
            },
            Step::Any => {
                let results = nodes.iter_mut().map(|node| self.node(node, item, at + 1, true)).collect();
                self.any(results, at)
            }
            Step::Key(name) => {
                let index = named_element(nodes, name).map_err(|reason| self.no_match(at, reason))?;
                self.node(&mut nodes[index], item, at + 1, wild)
            }
        }
    }

    /// The branches behind a `*`: those without a place for the rest are passed over, unless none is left.
    fn any(&self, results: Vec<Result<usize, Problem>>, at: usize) -> Result<usize, Problem> {
        let count: usize = results.iter().flatten().sum();
        if count > 0 {
            return Ok(count);
        }
        let first = results.into_iter().find_map(Result::err);
        Err(first.unwrap_or_else(|| self.no_match(at, "there is nothing that `*` could stand for".to_owned())))
    }

    /// The path ends nowhere.
    fn no_match(&self, at: usize, reason: String) -> Problem {
        no_match(self.path, at, &reason)
    }

    /// A key that the schema does not know there.
    fn unknown_key(&self, view: &TableView<'_>, at: usize, key: &str) -> Problem {
        let mut hint = hint_for_key(key, view.keys.keys().copied());
        if hint.meant.is_none() && view.keys.is_empty() {
            hint.text = "; no keys are possible there".to_owned();
        }
        Problem::UnknownKey { key: path_text(&self.path[..=at]), hint: hint.text }
    }
}

/// A path that ends after `at` of its steps.
pub(super) fn no_match(path: &[Step], at: usize, reason: &str) -> Problem {
    let reached = match at {
        0 => String::new(),
        _ => format!("at `{}`, ", path_text(&path[..at])),
    };
    Problem::NoMatch { path: path_text(path), reason: format!("{reached}{reason}") }
}

/// The one element of a list that has this name.
pub(super) fn named_element(nodes: &[Node], name: &str) -> Result<usize, String> {
    let found: Vec<usize> =
        nodes.iter().enumerate().filter(|(_, node)| node.name() == Some(name)).map(|(i, _)| i).collect();
    match found.as_slice() {
        [one] => Ok(*one),
        [] => {
            let names: Vec<&str> = nodes.iter().filter_map(Node::name).collect();
            match names.is_empty() {
                true => Err(format!("its {} have no names; write [0] … or [*]", count_of(nodes))),
                false => Err(format!("none is named \"{name}\"{}", hint_for_name(name, names.iter().copied()))),
            }
        }
        [first, second, ..] => Err(format!("several are named \"{name}\"; write [{first}], [{second}] … or [*]")),
    }
}

/// How many elements, in words.
fn count_of(nodes: &[Node]) -> String {
    match nodes.len() {
        1 => "1 entry".to_owned(),
        n => format!("{n} entries"),
    }
}

/// The keys of a table, in words.
fn keys_of(table: &Table) -> String {
    listed(table.keys().map(String::as_str))
}

/// After a change of kind: the keys that only the old kind had go.
fn drop_foreign_keys(table: &mut Table, schema: &Value) {
    let view = TableView::of(schema, table);
    if view.tag.is_none() {
        let known: Vec<String> = table.keys().filter(|key| view.key(key).is_some()).cloned().collect();
        table.retain(|key, entry| known.contains(key) || matches!(entry.key_origin, Origin::Override(_)));
    }
}
