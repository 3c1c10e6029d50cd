//! Holds a tree against the schema and collects everything that is wrong with it.

use super::{
    TableView, alternatives, choices, element_path, expected, is_named, is_plain, item_schema, meaning, number,
    refers::{self, Names},
    rules, scenario_schema, table_schema, takes,
};
use crate::document::{Entry, Node, Origin, Source, Table, Value as Tree, shortened};
use crate::error::{MOST_ERRORS, Problem, ScenarioError};
use crate::spelling::{hint_for_key, hint_for_name, listed};
use serde_json::Value;
use std::collections::HashMap;

/// All complaints about a whole scenario, in no particular order.
pub(crate) fn check(root: &Node, source: &Source) -> Vec<ScenarioError> {
    let mut checker = Checker { source, names: Names::of(root), errors: Vec::new() };
    checker.value(scenario_schema(), root, "");
    rules::whole(root, &mut checker);
    checker.errors
}

/// The walk: what it knows and what it has found.
pub(super) struct Checker<'a> {
    source: &'a Source,
    pub(super) names: Names<'a>,
    errors: Vec<ScenarioError>,
}

impl Checker<'_> {
    /// Records a complaint.
    pub(super) fn complain(&mut self, origin: Origin, problem: Problem) {
        if self.errors.len() > MOST_ERRORS {
            return; // parse() says that there are more
        }
        self.errors.push(ScenarioError { place: self.source.place(origin), problem });
    }

    /// Checks a value at `path`.
    fn value(&mut self, schema: &Value, node: &Node, path: &str) {
        let parts: Vec<&Value> = alternatives(schema).into_iter().filter(|part| takes(part, &node.value)).collect();
        let Some(part) = parts.first() else {
            let (key, expected, found) = (path.to_owned(), expected(schema), node.describe());
            return self.complain(node.origin, Problem::WrongType { key, expected, found });
        };
        match &node.value {
            Tree::Text(text) => self.text(schema, part, (node, text), path),
            Tree::Integer(_) | Tree::Float(_) => number::check(self, part, node, path),
            Tree::List(nodes) => self.list(part, (node, nodes), path),
            Tree::Table(table) => self.table(table_schema(schema).unwrap_or(schema), (node, table), path),
            Tree::Flag(_) | Tree::Date(_) => {}
        }
        rules::vector(self, schema, node, path);
    }

    /// A text: one of a few, not too short, a name, or the name of something.
    fn text(&mut self, schema: &Value, part: &Value, (node, text): (&Node, &str), path: &str) {
        let valid = choices(schema);
        if !valid.is_empty() && !valid.contains(&text) {
            let hint = hint_for_name(text, valid.iter().copied());
            let (key, what, name) = (path.to_owned(), last_word(path).to_owned(), shortened(text));
            return self.complain(node.origin, Problem::UnknownName { key, what, name, hint });
        }
        let name = part.get("x-name").is_some();
        if text.trim().is_empty() && (name || part.get("minLength").is_some()) {
            let (key, found, demand) = (path.to_owned(), node.quote(), "must not be empty".to_owned());
            self.complain(node.origin, Problem::OutOfRange { key, found, demand });
        } else if name && (!is_plain(text) || text == "world") {
            let found = node.quote();
            let demand = match text {
                "world" => "is the name of the surroundings; choose another",
                _ => "must be letters, digits, `_` and `-` only, so that paths and places can carry it",
            };
            let (key, demand) = (path.to_owned(), demand.to_owned());
            self.complain(node.origin, Problem::OutOfRange { key, found, demand });
        }
        if let Some(kind) = part.get("x-refers").and_then(Value::as_str) {
            refers::check(self, kind, (node, text), path);
        }
    }

    /// A list: its length, its elements, and that names in it differ.
    fn list(&mut self, part: &Value, (node, nodes): (&Node, &[Node]), path: &str) {
        let bound = |key: &str| part.get(key).and_then(Value::as_u64).map(|n| n as usize);
        let (min, max) = (bound("minItems").unwrap_or(0), bound("maxItems").unwrap_or(usize::MAX));
        if nodes.len() < min || nodes.len() > max {
            let demand = match (min, max) {
                (min, max) if min == max => format!("must have {min} elements"),
                (min, usize::MAX) => format!("must have at least {min}"),
                (min, max) => format!("must have {min} to {max} elements"),
            };
            let (key, found) = (path.to_owned(), node.quote());
            self.complain(node.origin, Problem::OutOfRange { key, found, demand });
        }
        let Some(item) = item_schema(part) else { return };
        let named = is_named(item);
        for (i, element) in nodes.iter().enumerate() {
            self.value(item, element, &element_path(path, i, element, named));
            if let (Some(kind), Some(text)) = (part.get("x-refers").and_then(Value::as_str), element.text()) {
                refers::check(self, kind, (element, text), &format!("{path}[{i}]"));
            }
        }
        if named {
            self.unique_names(nodes, path);
        }
    }

    /// No two tables of a list have the same name.
    fn unique_names(&mut self, nodes: &[Node], path: &str) {
        let mut first: HashMap<&str, Origin> = HashMap::new();
        for node in nodes {
            let (Some(name), Some(origin)) = (node.name(), node.child("name").map(|name| name.origin)) else {
                continue;
            };
            if let Some(taken) = first.get(name) {
                let first = self.source.place(*taken).to_string();
                let (key, name) = (format!("{path}.name"), name.to_owned());
                self.complain(origin, Problem::DuplicateName { key, name, first });
            } else {
                first.insert(name, origin);
            }
        }
    }

    /// A table: its kind, its keys, those it lacks, and the rules between them.
    fn table(&mut self, schema: &Value, (node, table): (&Node, &Table), path: &str) {
        let view = TableView::of(schema, table);
        let mut meant = Vec::new();
        for (key, entry) in table {
            match view.key(key) {
                Some(_) if view.tag.as_ref().is_some_and(|tag| tag.key == key) => self.tag(&view, entry, path),
                Some(schema) => self.value(schema, &entry.node, &join(path, key)),
                None => meant.extend(self.unknown_key(&view, table, (key, entry), path)),
            }
        }
        let missing_tag = view.tag.iter().map(|tag| tag.key);
        let missing = view.required.iter().copied().chain(missing_tag).filter(|key| !table.contains_key(*key));
        for key in missing.filter(|key| !meant.iter().any(|m| m == key)) {
            let meaning = match &view.tag {
                Some(tag) if tag.key == key => format!("one of {}", listed(tag.valid.iter().copied())),
                _ => view.key(key).map(meaning).unwrap_or_default(),
            };
            let (table, key) = (table_words(path), key.to_owned());
            self.complain(node.origin, Problem::MissingKey { table, key, meaning });
        }
        rules::table(self, &view, (node, table), path);
    }

    /// A kind that no alternative has.
    fn tag(&mut self, view: &TableView<'_>, entry: &Entry, path: &str) {
        let Some(tag) = &view.tag else { return };
        let key = join(path, tag.key);
        let problem = match entry.node.text() {
            Some(text) => {
                let hint = hint_for_name(text, tag.valid.iter().copied());
                Problem::UnknownName { key, what: tag.key.to_owned(), name: shortened(text), hint }
            }
            None => Problem::WrongType { key, expected: "a text in quotes".into(), found: entry.node.describe() },
        };
        self.complain(entry.node.origin, problem);
    }

    /// Complains of a key and gives back the one that was meant, if it is not there already.
    fn unknown_key(
        &mut self,
        view: &TableView<'_>,
        table: &Table,
        (key, entry): (&String, &Entry),
        path: &str,
    ) -> Option<String> {
        let absent = view.keys.keys().copied().filter(|valid| !table.contains_key(*valid));
        let mut hint = hint_for_key(key, absent);
        if hint.meant.is_none() {
            hint.text = match home_of(scenario_schema(), key, "").filter(|home| home != path) {
                Some(home) if home.is_empty() => "; it belongs to the top of the file, before any [table]".to_owned(),
                Some(home) => format!("; it belongs into [{home}]"),
                None => format!("; valid here: {}", listed(view.keys.keys().copied())),
            };
        }
        self.complain(entry.key_origin, Problem::UnknownKey { key: join(path, key), hint: hint.text });
        hint.meant
    }
}

/// The table of the schema that has a key, as a path; only tables of the top two levels are worth a hint.
fn home_of(schema: &Value, key: &str, path: &str) -> Option<String> {
    let properties = schema.get("properties")?.as_object()?;
    if properties.contains_key(key) {
        return Some(path.to_owned());
    }
    let children = properties.iter().filter(|_| path.is_empty());
    children.into_iter().find_map(|(name, child)| {
        let child = item_schema(child).unwrap_or(child);
        let candidates = child.get("oneOf").and_then(Value::as_array).into_iter().flatten().chain([child]);
        candidates.into_iter().find_map(|part| home_of(part, key, name))
    })
}

/// A path one key longer.
pub(crate) fn join(path: &str, key: &str) -> String {
    let key = if is_plain(key) { key.to_owned() } else { format!("\"{}\"", shortened(key)) };
    join_raw(path, &key)
}

/// A path longer by a text that needs no quotes.
pub(crate) fn join_raw(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// A table in words.
pub(super) fn table_words(path: &str) -> String {
    if path.is_empty() { "the scenario".to_owned() } else { format!("`{path}`") }
}

/// What a text at this path should be one of: the last key, or a value of a list.
fn last_word(path: &str) -> &str {
    if path.ends_with(']') { "value" } else { path.rsplit('.').next().unwrap_or(path) }
}
