//! `patched.toml`: the scenario with the effects that were found, to run like any scenario.
//!
//! The text of the scenario's file is kept as it is, comments included, and the entries are appended. Where that is not
//! possible (overrides were given; an effect of the same name and place is there already, which the new values replace; effects
//! are written in line), the scenario is written anew with every value in it.
//!
//! Paths are rewritten relative to the new file, so that a folder that holds both can be moved or shared; where the two files
//! have only the root of the file system in common they are made absolute.

use crate::diagnosis::{Diagnosis, Found, ParamValue, StdErr};
use crate::number::noise;
use scenario::{Scenario, ScenarioErrors, parse, to_toml};
use std::fmt::Write;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Name of the file.
pub const FILE: &str = "patched.toml";
/// Keys whose texts are paths of files or folders.
const PATH_KEYS: [&str; 4] = ["urdf", "file", "mesh", "package_paths"];

/// The text of `patched.toml` in folder `dir`; it has been read back and is a sound scenario.
pub fn patched_toml(scenario: &Scenario, diagnosis: &Diagnosis, dir: &Path) -> Result<String, ScenarioErrors> {
    let file = dir.join(FILE).display().to_string();
    let from = scenario.source.file_dir();
    let header = header(scenario, diagnosis);
    let entries = entries(diagnosis);
    let whole = |text: &str| format!("{header}\n{}\n{entries}", moved(text, &from, dir).trim_end());
    let text = scenario.source.text();
    if scenario.source.overrides().is_empty()
        && !text.is_empty()
        && !has_any(scenario, &diagnosis.effects)
        && !has_any(scenario, &diagnosis.within_tolerance)
    {
        let text = whole(text);
        if parse(&text, &file, &[]).is_ok() {
            return Ok(text);
        }
    }
    let mut bare = scenario.clone();
    bare.effects.retain(|e| !diagnosis.effects.iter().chain(&diagnosis.within_tolerance).any(|f| is_same(e, f)));
    // Lists that are empty or in line stand before the tables, so entries can be appended once the list is gone.
    let kept: Vec<_> = std::mem::take(&mut bare.effects);
    let kept: String =
        kept.iter().map(|e| entry(&e.name, &e.place, e.params.iter().map(|(n, v)| (n, v, None)))).collect();
    let text = whole(&(without_effects(&to_toml(&bare)) + "\n" + &kept));
    parse(&text, &file, &[]).map(|_| text)
}

fn without_effects(text: &str) -> String {
    text.lines().filter(|line| line.trim() != "effect = []").map(|line| format!("{line}\n")).collect()
}

fn is_same(effect: &scenario::spec::Effect, found: &Found) -> bool {
    effect.name == found.name && crate::place::same_place(&effect.place, &found.place)
}

fn has_any(scenario: &Scenario, found: &[Found]) -> bool {
    scenario.effects.iter().any(|e| found.iter().any(|f| is_same(e, f)))
}

fn header(scenario: &Scenario, diagnosis: &Diagnosis) -> String {
    let judged = diagnosis.judged();
    let whose = if judged.left_out { "runs that were not used" } else { "the runs that were used" };
    let horizon =
        judged.window_s.map_or_else(String::new, |w| format!(", in windows of {} s", crate::number::short(w)));
    let (before, after) = (noise(judged.error.before), noise(judged.error.after));
    let line = |text: &str| text.replace(['\n', '\r'], " ");
    format!(
        "# Scenario \"{}\" with what softdock diagnose found in the recording \"{}\".\n\
         # Verdict: {}. Error on {whose}{horizon}: {before} before, {after} after, in units of the sensors' noise (1.0 is perfect).\n\
         # From {}; the entries that were added stand at the end, each value with its standard error. Paths start from here.\n",
        line(&scenario.name),
        line(&diagnosis.recording),
        diagnosis.verdict.word(),
        line(scenario.source.file()),
    )
}

fn entries(diagnosis: &Diagnosis) -> String {
    let one = |found: &Found| {
        let params = found.params.iter().map(|(name, value)| (name, value, found.std_err.get(name)));
        entry(&found.name, &found.place, params)
    };
    let found: String = diagnosis.effects.iter().map(one).collect();
    let within: String = diagnosis.within_tolerance.iter().map(one).collect();
    let title = if within.is_empty() { "" } else { "\n# Nominal numbers, corrected within their tolerances.\n" };
    format!("{found}{title}{within}")
}

type Param<'a> = (&'a String, &'a ParamValue, Option<&'a StdErr>);

fn entry<'a>(name: &str, place: &str, params: impl Iterator<Item = Param<'a>>) -> String {
    let mut text = format!("\n[[effect]]\nname = {}\nplace = {}\n", quoted(name), quoted(place));
    for (key, value, std_err) in params {
        let comment = std_err.map(comment).unwrap_or_default();
        let _ = writeln!(text, "{} = {}{comment}", bare_or_quoted(key), written(value, std_err));
    }
    text
}

/// `  # ± 0.0012`; of a vector, entry by entry.
fn comment(std_err: &StdErr) -> String {
    let one = |e: &Option<f64>| e.map_or_else(|| "–".to_owned(), |e| crate::number::digits(e, 2));
    match std_err {
        StdErr::One(None) => "  # not shown by the data".to_owned(),
        StdErr::One(e) => format!("  # ± {}", one(e)),
        StdErr::Each(list) => format!("  # ± [{}]", list.iter().map(one).collect::<Vec<_>>().join(", ")),
    }
}

fn written(value: &ParamValue, std_err: Option<&StdErr>) -> String {
    let errors = std_err.map(StdErr::entries).unwrap_or_default();
    let number = |i: usize, x: f64| float(x, errors.get(i).copied().flatten());
    match value {
        ParamValue::Number(x) => number(0, *x),
        ParamValue::Numbers(list) => {
            format!("[{}]", list.iter().enumerate().map(|(i, x)| number(i, *x)).collect::<Vec<_>>().join(", "))
        }
        ParamValue::Text(text) => quoted(text),
        ParamValue::Flag(flag) => flag.to_string(),
    }
}

/// Digits to a thousandth of the standard error; all of them where there is none.
fn float(x: f64, std_err: Option<f64>) -> String {
    let x = match std_err {
        Some(e) if e > 0.0 && x.is_finite() => {
            let places = (3.0 - e.log10().floor()) as i32;
            let scale = 10_f64.powi(places.clamp(-300, 300));
            let rounded = (x * scale).round() / scale;
            if rounded.is_finite() { rounded } else { x }
        }
        _ => x,
    };
    toml::Value::Float(x).to_string()
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn bare_or_quoted(key: &str) -> String {
    let is_bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_bare { key.to_owned() } else { quoted(key) }
}

/// The text with relative paths that start from `from` made to start from `to`.
fn moved(text: &str, from: &Path, to: &Path) -> String {
    let (table, _) = DeTable::parse_recoverable(text);
    let mut found = Vec::new();
    collect_table(table.get_ref(), &mut found);
    found.sort_by_key(|(span, _)| std::cmp::Reverse(span.start));
    let mut text = text.to_owned();
    for (span, path) in found {
        let is_there = Path::new(&path).is_relative() && from.join(&path).exists();
        if is_there && text.is_char_boundary(span.start) && text.is_char_boundary(span.end) {
            text.replace_range(span, &quoted(&path_between(to, &from.join(&path))));
        }
    }
    text
}

fn collect_table(table: &DeTable<'_>, found: &mut Vec<(Range<usize>, String)>) {
    for (key, value) in table.iter() {
        collect(value, PATH_KEYS.contains(&key.get_ref().as_ref()), found);
    }
}

fn collect(value: &Spanned<DeValue<'_>>, is_path: bool, found: &mut Vec<(Range<usize>, String)>) {
    match value.get_ref() {
        DeValue::String(text) if is_path => found.push((value.span(), text.to_string())),
        DeValue::Array(values) => values.iter().for_each(|v| collect(v, is_path, found)),
        DeValue::Table(table) => collect_table(table, found),
        _ => {}
    }
}

/// A path through links, also where its last parts do not exist yet.
fn real(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    for there in path.ancestors() {
        if let (Ok(real), Ok(rest)) = (there.canonicalize(), path.strip_prefix(there)) {
            return if rest.as_os_str().is_empty() { real } else { real.join(rest) };
        }
    }
    path
}

/// A file as seen from a folder.
fn path_between(folder: &Path, file: &Path) -> String {
    let (folder, file) = (real(folder), real(file));
    let common = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    let named = folder.components().take(common).filter(|c| matches!(c, Component::Normal(_))).count();
    if named == 0 {
        return file.display().to_string();
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    let path: PathBuf = up.chain(file.components().skip(common)).collect();
    path.display().to_string()
}

#[cfg(test)]
mod tests;
