//! The `[[expect]]` entries against the metrics of a run.

use super::Outcome;
use crate::spec::{Expect, Scalar};
use crate::spelling::hint_for_name;
use serde_json::Value;

/// One expectation and whether it was met.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Whether it was met.
    pub met: bool,
    /// The expectation and what came, in a sentence.
    pub text: String,
}

/// Checks every expectation; a metric that does not exist is not met.
pub fn check_expectations(expects: &[Expect], outcome: &Outcome) -> Vec<Verdict> {
    expects.iter().map(|e| check(e, outcome)).collect()
}

fn check(expect: &Expect, outcome: &Outcome) -> Verdict {
    let value = match expect.metric.as_str() {
        "outcome" => Some(Value::from(outcome.outcome)),
        name => outcome.metric(name).cloned(),
    };
    let Some(value) = value else {
        let names: Vec<&str> = outcome.metrics.iter().map(|m| m.name.as_ref()).collect();
        let text = format!("no metric \"{}\"{}", expect.metric, hint_for_name(&expect.metric, names));
        return Verdict { met: false, text };
    };
    let (met, demand) = judge(expect, &value);
    let verb = if met { "is" } else { "should be" };
    let came = if met { String::new() } else { format!(", but is {}", shown(&value)) };
    Verdict { met, text: format!("{} {verb} {demand}{came}", expect.metric) }
}

fn judge(expect: &Expect, value: &Value) -> (bool, String) {
    let number = value.as_f64();
    if let Some(equal) = &expect.equals {
        return match equal {
            Scalar::Flag(flag) => (value.as_bool() == Some(*flag), flag.to_string()),
            Scalar::Number(x) => (number == Some(*x), x.to_string()),
            Scalar::Text(text) => (value.as_str() == Some(text), format!("\"{text}\"")),
        };
    }
    if let Some(most) = expect.at_most {
        return (number.is_some_and(|x| x <= most), format!("at most {most:e}"));
    }
    if let Some(least) = expect.at_least {
        return (number.is_some_and(|x| x >= least), format!("at least {least:e}"));
    }
    if let Some([low, high]) = expect.between {
        return (number.is_some_and(|x| (low..=high).contains(&x)), format!("between {low:e} and {high:e}"));
    }
    (false, "something, but the entry says nothing".to_owned())
}

fn shown(value: &Value) -> String {
    value.as_f64().map_or_else(|| value.to_string(), |x| format!("{x:.4e}"))
}
