//! The matrix of inputs and outputs: first-order indices as colours, rank correlations below.

use crate::findings::{Effect, Findings};
use record::page::name;
use record::page::number::{digits, percent};
use std::fmt::Write;

/// Most inputs and outputs shown.
const MOST: (usize, usize) = (12, 16);
/// p-value of the correlation up to which a dependency is called rising or falling.
const MONOTONIC: f64 = 0.01;

/// The section.
pub(super) fn section(findings: &Findings) -> String {
    let sensitivity = &findings.sensitivity;
    if sensitivity.effects.is_empty() {
        return String::new();
    }
    let inputs = by_strength(&sensitivity.inputs, findings, |effect| &effect.input, MOST.0);
    let outputs = by_strength(&sensitivity.outputs, findings, |effect| &effect.output, MOST.1);
    let mut text = String::from(
        "<p>Each cell: the share of the output’s variance (row) that the input (column) explains alone, and below it \
         Spearman’s ρ. \
         Coloured where it is more than chance: blue where the output grows with the input, orange where it falls, \
         green where it does neither throughout; the rest is faint.</p>\n\
         <div class=\"scroll\"><table class=\"matrix effects\"><tr><th></th>",
    );
    inputs.iter().for_each(|input| text += &format!("<th>{}</th>", name(input)));
    text += "</tr>\n";
    for output in &outputs {
        let _ = write!(text, "<tr><th><span>{}</span></th>", name(output));
        inputs.iter().for_each(|input| text += &cell(sensitivity.effect(input, output)));
        text += "</tr>\n";
    }
    text += "</table></div>\n";
    let left_out = (sensitivity.inputs.len() - inputs.len(), sensitivity.outputs.len() - outputs.len());
    if left_out != (0, 0) {
        text += &format!(
            "<p>{} inputs and {} outputs of weaker effect are left out; the JSON report has all of them.</p>\n",
            left_out.0, left_out.1
        );
    }
    text + &classes(findings)
}

fn classes(findings: &Findings) -> String {
    let counts = || findings.sensitivity.effects.iter().map(|e| e.classes).filter(|c| *c > 0);
    match (counts().min(), counts().max()) {
        (Some(low), Some(high)) if low == high => {
            format!("<p>Indices from {low} classes of each input’s values.</p>\n")
        }
        (Some(low), Some(high)) => format!("<p>Indices from {low} to {high} classes of each input’s values.</p>\n"),
        _ => String::new(),
    }
}

/// Names in their own order where all find room, else those of the strongest effects.
fn by_strength(names: &[String], findings: &Findings, of: impl Fn(&Effect) -> &String, most: usize) -> Vec<String> {
    if names.len() <= most {
        return names.to_vec();
    }
    let strength = |name: &String| {
        let effects = findings.sensitivity.effects.iter().filter(|effect| of(effect) == name);
        effects.map(|e| e.strength().0 + if e.is_clear { 1.0 } else { 0.0 }).fold(f64::MIN, f64::max)
    };
    let is_success = |name: &String| findings.success.as_ref().is_some_and(|success| &success.flag == name);
    let mut ranked: Vec<(f64, &String)> =
        names.iter().map(|name| (if is_success(name) { f64::MAX } else { strength(name) }, name)).collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    ranked.into_iter().take(most).map(|(_, name)| name.clone()).collect()
}

fn cell(effect: Option<&Effect>) -> String {
    let Some(effect) = effect else { return "<td>–</td>".to_owned() };
    let share = effect.first_order.map_or_else(|| "–".to_owned(), |share| percent(share.clamp(0.0, 1.0)));
    let rho = effect.spearman.map_or_else(String::new, |rho| {
        let rounded = (100.0 * rho).round() / 100.0;
        format!("<small>{}</small>", digits(rounded + 0.0, 2))
    });
    if !effect.is_clear {
        return format!("<td class=\"dim\">{share}{rho}</td>");
    }
    let strength = effect.first_order.unwrap_or(0.0).clamp(0.0, 1.0).sqrt();
    let colour = match effect.spearman {
        // A dependency that is clear but not monotonic: both ends, or the middle.
        Some(_) if effect.p.is_none_or(|p| p > MONOTONIC) => "o2",
        Some(rho) if rho < 0.0 => "o1",
        _ => "o0",
    };
    let style = format!("background:color-mix(in srgb, var(--{colour}) {:.0}%, transparent)", 8.0 + 52.0 * strength);
    format!("<td style=\"{style}\">{share}{rho}</td>")
}
