//! Numbers: finite, and within the range of their key.

use super::check::Checker;
use crate::document::Node;
use crate::error::Problem;
use serde_json::Value;

/// Complains of a number that is not finite or outside its range.
pub(super) fn check(checker: &mut Checker<'_>, schema: &Value, node: &Node, path: &str) {
    let Some(value) = node.number() else { return };
    let infinite_is_fine = schema.get("x-may-be-infinite").is_some();
    let demand = match value {
        value if value.is_nan() => Some("is not a number that physics knows".to_owned()),
        value if value.is_infinite() && !infinite_is_fine => Some("must be finite".to_owned()),
        value => range_demand(schema, value),
    };
    if let Some(demand) = demand {
        let found = node.quote();
        checker.complain(node.origin, Problem::OutOfRange { key: path.to_owned(), found, demand });
    }
}

/// The bound that a number breaks, in words.
fn range_demand(schema: &Value, value: f64) -> Option<String> {
    let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
    if let Some(low) = bound("exclusiveMinimum").filter(|low| value <= *low) {
        return Some(format!("must be greater than {low}"));
    }
    if let Some(low) = bound("minimum").filter(|low| value < *low) {
        return Some(format!("must be at least {low}"));
    }
    if let Some(high) = bound("exclusiveMaximum").filter(|high| value >= *high) {
        return Some(format!("must be less than {high}"));
    }
    bound("maximum").filter(|high| value > *high).map(|high| format!("must be at most {high}"))
}
