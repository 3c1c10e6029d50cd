//! An inspection as text for people.

use super::{ChannelReport, Inspection};
use crate::consistency::{Consistency, Estimate};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Rows of a table that are shown before the rest is counted.
const SHOWN: usize = 12;

/// The whole report.
pub fn to_text(inspection: &Inspection) -> String {
    let mut text = String::new();
    let title = if inspection.title.is_empty() { "(no title)" } else { &inspection.title };
    let _ = writeln!(text, "{title}\nrig {}, {} runs\n", or_dash(&inspection.rig), inspection.runs.len());
    add_runs(&mut text, inspection);
    add_channels(&mut text, inspection);
    add_consistency(&mut text, inspection);
    add_remarks(&mut text, inspection);
    text
}

fn or_dash(text: &str) -> &str {
    if text.is_empty() { "–" } else { text }
}

fn add_runs(text: &mut String, inspection: &Inspection) {
    let mut rows = vec![["run", "role", "from s", "to s", "samples", "note"].map(str::to_owned)];
    rows.extend(inspection.runs.iter().take(SHOWN).map(|run| {
        let times = [run.from_s, run.to_s].map(|t| format!("{t:.3}"));
        let [from, to] = times;
        [run.file.clone(), run.role.to_owned(), from, to, run.samples.to_string(), run.note.clone()]
    }));
    add_table(text, &rows);
    if inspection.runs.len() > SHOWN {
        let _ = writeln!(text, "  and {} more", inspection.runs.len() - SHOWN);
    }
    text.push('\n');
}

/// Channels by family and quantity; noise measured and stated side by side.
fn add_channels(text: &mut String, inspection: &Inspection) {
    let head = ["channel", "unit", "Hz", "samples", "gaps", "from", "to", "rounding", "noise", "stated", "ratio"];
    let mut families: BTreeMap<&str, Vec<&ChannelReport>> = BTreeMap::new();
    for channel in &inspection.channels {
        families.entry(channel.channel.split('.').next().unwrap_or_default()).or_default().push(channel);
    }
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(families.values().flatten().map(|channel| channel_row(channel)));
    add_table(text, &rows);
    text.push_str(
        "  noise: 1 sigma, white, from the samples, rounding taken off; of an orientation rad about each axis\n\n",
    );
}

fn channel_row(channel: &ChannelReport) -> [String; 11] {
    let small =
        |x: Option<f64>| x.map_or("–".to_owned(), |x| if x == 0.0 { "0".to_owned() } else { format!("{x:.2e}") });
    let ratio = channel.noise.zip(channel.stated).filter(|(_, stated)| *stated > 0.0);
    [
        channel.channel.clone(),
        channel.unit.clone(),
        format!("{:.4}", channel.rate).trim_end_matches('0').trim_end_matches('.').to_owned(),
        channel.samples.to_string(),
        channel.gaps.to_string(),
        format!("{:.4}", channel.low),
        format!("{:.4}", channel.high),
        small(Some(channel.rounding)),
        small(channel.noise),
        small(channel.stated),
        ratio.map_or("–".to_owned(), |(found, stated)| format!("{:.2}", found / stated)),
    ]
}

fn add_consistency(text: &mut String, inspection: &Inspection) {
    if inspection.consistency.is_empty() {
        text.push_str("No channel is the rate of another: kinematics says nothing about the sensors.\n\n");
        return;
    }
    let head = ["rate against position", "misfit", "scale", "bias", "delay s", "angle rad"];
    let mut rows = vec![head.map(str::to_owned)];
    rows.extend(inspection.consistency.iter().map(consistency_row));
    add_table(text, &rows);
    text.push_str(
        "  misfit: mean square error of the integrated rate, 1 where only noise is left; ± 1 standard error\n\n",
    );
}

fn consistency_row(found: &Consistency) -> [String; 6] {
    let list = |all: Vec<Option<Estimate>>| {
        let parts: Vec<String> = all.into_iter().map(|e| e.map_or("–".to_owned(), shown)).collect();
        parts.join(", ")
    };
    [
        found.rate.clone(),
        format!("{:.3}", found.misfit),
        list(found.scale.clone()),
        list(found.bias.clone()),
        list(vec![found.delay]),
        found.angle.map_or("–".to_owned(), |angle| list(angle.map(Some).to_vec())),
    ]
}

/// A figure and its standard error, in brackets on its last two digits' place.
fn shown(e: Estimate) -> String {
    let digits = (1 - e.std_err.max(1e-12).log10().floor() as i32).clamp(0, 8) as usize;
    format!("{:.digits$}±{:.digits$}", e.value, e.std_err)
}

/// Remarks, most severe first; the same one of many runs or channels is said once.
fn add_remarks(text: &mut String, inspection: &Inspection) {
    if inspection.remarks.is_empty() {
        text.push_str("Nothing odd was found.\n");
        return;
    }
    for (remark, more) in said_once(&inspection.remarks) {
        let _ = writeln!(text, "{remark}{more}");
    }
}

/// Remarks, those that differ by figures, run or channel alone once, and what is like them in words.
pub fn said_once(remarks: &[crate::Remark]) -> Vec<(&crate::Remark, String)> {
    struct Kind<'r> {
        first: &'r crate::Remark,
        more: usize,
        others: Vec<&'r str>,
    }
    let mut said: Vec<Kind<'_>> = Vec::new();
    for remark in remarks {
        let is_like = |other: &crate::Remark| {
            (other.severity, other.channel.is_some()) == (remark.severity, remark.channel.is_some())
                && pattern(&other.what) == pattern(&remark.what)
        };
        match said.iter_mut().find(|kind| is_like(kind.first)) {
            Some(kind) => {
                kind.more += 1;
                let other = remark.channel.as_deref().filter(|_| remark.channel != kind.first.channel);
                kind.others.extend(other.filter(|c| !kind.others.contains(c)));
            }
            None => said.push(Kind { first: remark, more: 0, others: Vec::new() }),
        }
    }
    said.into_iter().map(|kind| (kind.first, like_it(kind.more, &kind.others))).collect()
}

/// How many remarks are like one, and of which other channels.
fn like_it(more: usize, others: &[&str]) -> String {
    let (named, rest) = others.split_at(others.len().min(NAMED));
    match (more, named, rest.len()) {
        (0, ..) => String::new(),
        (_, [], _) => format!(" (and {more} like it in other runs)"),
        (_, [one], 0) => format!(" (and {more} like it, {one} too)"),
        (_, [names @ .., last], 0) => format!(" (and {more} like it, {} and {last} too)", names.join(", ")),
        (.., rest) => format!(" (and {more} like it, {} and {rest} more channels too)", named.join(", ")),
    }
}

/// Other channels of a remark that are named.
const NAMED: usize = 4;

/// A sentence without its figures.
fn pattern(what: &str) -> String {
    what.chars().filter(|c| !c.is_ascii_digit() && !"+-.e".contains(*c)).collect()
}

/// Columns as wide as they need; the first and the last to the left.
fn add_table<const N: usize>(text: &mut String, rows: &[[String; N]]) {
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    for row in rows {
        let cell = |(k, cell): (usize, &String)| match k == 0 || k + 1 == N {
            true => format!("{cell:w$}", w = if k + 1 == N { 0 } else { widths[k] }),
            false => format!("{cell:>w$}", w = widths[k]),
        };
        let line: Vec<String> = row.iter().enumerate().map(cell).collect();
        let _ = writeln!(text, "  {}", line.join("  ").trim_end());
    }
}
