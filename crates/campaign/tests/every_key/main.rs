//! Nothing is accepted and ignored: every key of the schema changes something that a scenario shows, or is refused.
//!
//! The keys are those of the JSON Schema itself, so that a new one is missing here until a bench shows what it does. A bench is
//! a scenario with its variations in comments, see [`bench`]; [`look`] is what may differ.
#![allow(clippy::print_stdout)]

mod bench;
mod look;
mod schema_keys;

use bench::{Bench, Variation};
use look::{Look, look};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Keys that only a diagnosis reads: its own tests show what each does (`catalogue::tolerances` of `softdock-diagnose`).
const OF_A_DIAGNOSIS: &str = "tolerance.";

/// What the variations of a bench have shown.
#[derive(Default)]
struct Shown {
    keys: BTreeSet<String>,
    faults: Vec<String>,
}

#[test]
fn every_key_changes_something_or_is_refused() {
    let schema = scenario::json_schema();
    let benches = bench::all();
    let shown: Vec<Shown> = std::thread::scope(|scope| {
        let threads: Vec<_> = benches.iter().map(|b| scope.spawn(|| try_bench(&schema, b))).collect();
        threads.into_iter().map(|t| t.join().unwrap_or_else(|_| panic!("a bench panicked"))).collect()
    });
    let mut faults: Vec<String> = shown.iter().flat_map(|s| s.faults.iter().cloned()).collect();
    let keys: BTreeSet<&str> = shown.iter().flat_map(|s| s.keys.iter().map(String::as_str)).collect();
    let mut all = schema_keys::of_schema(&schema);
    all.remove("effect.*");
    all.retain(|key| !key.starts_with(OF_A_DIAGNOSIS) && key != OF_A_DIAGNOSIS.trim_end_matches('.'));
    all.extend(parameters_of_effects());
    println!(
        "{} keys of the schema, {} variations",
        all.len(),
        benches.iter().map(|b| b.variations.len()).sum::<usize>()
    );
    let missing = all.iter().filter(|key| !keys.contains(key.as_str()));
    faults.extend(
        missing.map(|key| format!("{key}: no bench shows that it does anything; add a `#~ path=value` to one")),
    );
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

fn try_bench(schema: &Value, bench: &Bench) -> Shown {
    let (mut shown, mut looks) = (Shown::default(), BTreeMap::new());
    for variation in &bench.variations {
        let result = match &variation.refusal {
            Some(words) => refuse(schema, bench, variation, words),
            None => vary(schema, bench, variation, &mut looks),
        };
        match result {
            Ok(keys) => shown.keys.extend(keys),
            Err(fault) => shown.faults.push(format!("{}: {}: {fault}", bench.name, variation.change.join(" & "))),
        }
    }
    shown
}

/// The keys that a variation shows to matter.
fn vary(
    schema: &Value,
    bench: &Bench,
    variation: &Variation,
    looks: &mut BTreeMap<Vec<String>, Look>,
) -> Result<BTreeSet<String>, String> {
    let base = bench.with(&variation.given)?;
    let before = match looks.get(&variation.given) {
        Some(look) => look.clone(),
        None => looks.entry(variation.given.clone()).or_insert(look(&base)?).clone(),
    };
    let changed = bench.with(&[&variation.given[..], &variation.change].concat())?;
    let keys = changed_keys(schema, &base, &changed)?;
    let after = look(&changed)?;
    if after == before {
        return Err("does nothing: state, recording, outcome, verdicts and campaign are the same to the bit".to_owned());
    }
    Ok(keys)
}

/// The keys of a change that is refused as it should be.
fn refuse(schema: &Value, bench: &Bench, variation: &Variation, words: &str) -> Result<BTreeSet<String>, String> {
    let base = bench.with(&variation.given)?;
    let refused = |said: String| match said.contains(words) {
        true => Ok(()),
        false => Err(format!("is refused otherwise: {said}")),
    };
    let changed = match bench.with(&[&variation.given[..], &variation.change].concat()) {
        Ok(changed) => changed,
        Err(said) => return refused(said).map(|()| BTreeSet::new()),
    };
    match look(&changed) {
        Ok(_) => Err(format!("is accepted; it should be refused with \"{words}\"")),
        // Of a whole entry that is refused the entry is meant, not each of its keys.
        Err(said) => refused(said).map(|()| changed_keys(schema, &base, &changed).unwrap_or_default()),
    }
}

/// The keys in which two scenarios differ: one, or two that take each other's place; of a table whose kind changes, the kinds.
fn changed_keys(
    schema: &Value,
    base: &scenario::Scenario,
    changed: &scenario::Scenario,
) -> Result<BTreeSet<String>, String> {
    let document = |s| scenario::to_toml(s).parse::<toml::Table>().map_err(|e| e.to_string());
    let [a, b] = [document(base)?, document(changed)?].map(|d| schema_keys::of_document(schema, &d));
    let gone: BTreeSet<&String> = a.iter().filter(|(k, v)| b.get(k) != Some(v)).map(|((key, _), _)| key).collect();
    let come: BTreeSet<&String> = b.iter().filter(|(k, v)| a.get(k) != Some(v)).map(|((key, _), _)| key).collect();
    let kinds = |keys: &BTreeSet<&String>| keys.iter().find(|key| key.ends_with('>')).map(|key| (*key).clone());
    if let (Some(old), Some(new)) = (kinds(&gone), kinds(&come)) {
        return Ok([old, new].into());
    }
    if let Some(added) = kinds(&come) {
        return Ok([added].into());
    }
    let parameters = a.iter().chain(&b).filter(|(k, _)| k.0 == "effect.*" && a.get(*k) != b.get(*k));
    let parameters: BTreeSet<String> = parameters.filter_map(|((_, at), _)| parameter_at(changed, at)).collect();
    let mut keys: BTreeSet<String> = gone.union(&come).map(|key| (*key).clone()).collect();
    if keys.remove("effect.*") {
        keys.extend(parameters);
    }
    if keys.is_empty() {
        return Err("is the same scenario; give it another value".to_owned());
    }
    let swaps = gone.len() == 1 && come.len() == 1;
    if keys.len() == 1 || swaps {
        Ok(keys)
    } else {
        Err(format!("changes several keys at once: {keys:?}; one at a time"))
    }
}

/// A parameter of an effect at a kind of place.
fn parameter(effect: &str, place: &str, name: &str) -> String {
    format!("effect {effect} at {place}: {name}")
}

/// The parameter at a place of a document, `effect[0].b`.
fn parameter_at(scenario: &scenario::Scenario, at: &str) -> Option<String> {
    let (index, name) = at.strip_prefix("effect[")?.split_once("].")?;
    let effect = scenario.effects.get(index.parse::<usize>().ok()?)?;
    Some(parameter(&effect.name, effect.place.split(':').next()?, name))
}

/// Every parameter of every effect, at every kind of place.
fn parameters_of_effects() -> impl Iterator<Item = String> {
    scenario::effects::catalogue().flat_map(|effect| {
        let places = effect.places.iter().flat_map(move |place| effect.parameters.iter().map(move |p| (place, p)));
        places.map(move |(place, p)| parameter(effect.name, place.text(), p.name))
    })
}
