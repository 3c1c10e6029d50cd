//! What a person reads after a run, and `summary.json`.

use serde_json::{Map, Value, json};
use softdock::scenario::Finished;
use softdock::sim::Integrator;

/// Wall-clock figures of a run; no part of its result.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    /// Time of the run, s.
    pub(crate) wall_s: f64,
}

/// The content of `summary.json`.
pub(crate) fn document(done: &Finished) -> Map<String, Value> {
    let Finished { mission, outcome, verdicts, .. } = done;
    let scenario = &mission.scenario;
    let work = mission.world.state().work;
    let mut map = Map::new();
    let mut add = |key: &str, value: Value| map.insert(key.to_owned(), value);
    add("scenario", json!(scenario.name));
    add("version", json!(env!("CARGO_PKG_VERSION")));
    add("seed", json!(scenario.seed));
    add("strategy_knows", json!(mission.knowledge()));
    add("outcome", json!(outcome.outcome));
    add("reason", json!(outcome.reason));
    add("metrics", Value::Object(outcome.metrics_json()));
    add("expectations", verdicts.iter().map(|v| json!({"met": v.met, "text": v.text})).collect());
    let events = outcome.events.iter();
    add("events", events.map(|e| json!({"t_s": e.t, "kind": e.kind.key(), "text": e.text})).collect());
    add("warnings", json!(outcome.warnings));
    add(
        "work",
        json!({
            "steps": work.steps,
            "rate_evaluations": work.rate_evaluations,
            "contact_queries": work.contact_queries,
            "solves": work.solves,
            "unconverged_steps": work.unconverged_steps,
        }),
    );
    add("simulated_s", json!(mission.world.state().time));
    add("overrides", json!(scenario.source.overrides()));
    add("inputs", json!(softdock::scenario::to_toml(scenario)));
    map
}

/// The summary as Markdown, for the viewer.
pub(crate) fn markdown(done: &Finished) -> String {
    let Finished { mission, outcome, verdicts, .. } = done;
    let mut text = format!("# {}\n\n**{}**: {}\n\n", mission.scenario.name, outcome.outcome, outcome.reason);
    if let Some(knowledge) = mission.knowledge() {
        text += &format!("The strategy knew {knowledge}.\n\n");
    }
    for verdict in verdicts {
        text += &format!("- {}{}\n", if verdict.met { "" } else { "**not as expected:** " }, verdict.text);
    }
    for warning in &outcome.warnings {
        text += &format!("- **warning:** {warning}\n");
    }
    text += "\n| figure | value |\n| --- | --- |\n";
    for metric in &outcome.metrics {
        text += &format!("| {} | {} |\n", metric.name, shown(&metric.value));
    }
    text
}

/// Prints the table.
pub(crate) fn print(done: &Finished, clock: Clock) {
    let Finished { mission, outcome, verdicts, .. } = done;
    println!("\n{}: {}", outcome.outcome.to_uppercase(), outcome.reason);
    println!();
    for event in &outcome.events {
        println!("  {:>9.3} s  {}", event.t, event.text);
    }
    println!();
    let width = outcome.metrics.iter().map(|m| m.name.len()).max().unwrap_or(0);
    for metric in &outcome.metrics {
        println!("  {:<width$}  {:>12}  {}", metric.name, shown(&metric.value), metric.meaning);
    }
    let work = mission.world.state().work;
    let simulated = mission.world.state().time;
    println!(
        "\n  {} steps, {} solves, {} contact queries; {:.2} s for {:.0} s: {:.0} times real time",
        work.steps,
        work.solves,
        work.contact_queries,
        clock.wall_s,
        simulated,
        simulated / clock.wall_s
    );
    if let Some(knowledge) = mission.knowledge() {
        println!("  The strategy knew {knowledge}.");
    }
    for warning in &outcome.warnings {
        println!("  warning: {warning}");
    }
    if work.unconverged_steps > 0 {
        println!("  {} steps ended before the contact laws were met to tolerance", work.unconverged_steps);
    }
    let model = mission.world.model();
    if model.integrator == Integrator::RungeKutta4 && model.laws.iter().any(|law| law.friction.is_some()) {
        println!(
            "  rk4 resolves a sliding bristle only where the step is below 2 μ f_n / (k |u|); see that a finer one agrees"
        );
    }
    for verdict in verdicts {
        println!("  {} {}", if verdict.met { "as expected:" } else { "NOT AS EXPECTED:" }, verdict.text);
    }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::Bool(flag) => if *flag { "yes" } else { "no" }.to_owned(),
        Value::Number(n) => n.as_f64().map_or_else(|| n.to_string(), number),
        other => other.to_string(),
    }
}

fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) { format!("{x:.4}") } else { format!("{x:.3e}") }
}
