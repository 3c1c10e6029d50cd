//! A recording at one look: a row of panels per quantity, a column per run.

use super::{COLOURS, LINES, MARGIN, PANEL, Scale, add_grid, add_legend, add_line, escape};
use crate::{ChannelName, RecordedRun, RecordingSet, Series};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Most runs that stand side by side.
const RUNS: usize = 6;
/// Room above the panels, px.
const HEAD: f64 = 62.0;

/// Plots of a recording: the first runs of each role side by side, on common scales row by row.
pub fn recording_svg(set: &RecordingSet) -> String {
    let runs = chosen(set);
    let rows = rows(&runs);
    let (width, height) = (PANEL.0 * runs.len().max(1) as f64, HEAD + PANEL.1 * rows.len() as f64 + 10.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"16\" y=\"26\" font-size=\"17\" font-weight=\"bold\">{}</text>\n",
        escape(&heading(set, runs.len()))
    );
    for (column, run) in runs.iter().enumerate() {
        let x = PANEL.0 * column as f64;
        let note = if run.note.is_empty() { String::new() } else { format!(": {}", run.note) };
        let title = format!("{} ({}){note}", run.file, run.role.key());
        let _ = writeln!(svg, "<text x=\"{}\" y=\"52\" font-weight=\"bold\" fill=\"#444\">{}</text>", x + MARGIN.0, escape(&title));
        for (row, (title, channels)) in rows.iter().enumerate() {
            let _ = writeln!(svg, "<g transform=\"translate({x},{})\">", HEAD + PANEL.1 * row as f64);
            add_panel(&mut svg, (&runs, run), title, channels);
            svg.push_str("</g>\n");
        }
    }
    svg.push_str("</svg>\n");
    svg
}

fn heading(set: &RecordingSet, shown: usize) -> String {
    let rig = if set.rig.is_empty() { String::new() } else { format!("rig {}: ", set.rig) };
    let some = if set.runs.len() > shown { format!(" ({shown} of {} runs)", set.runs.len()) } else { String::new() };
    format!("{rig}{}{some}", set.title)
}

/// All runs, or of many the first of each role.
fn chosen(set: &RecordingSet) -> Vec<&RecordedRun> {
    if set.runs.len() <= RUNS {
        return set.runs.iter().collect();
    }
    [crate::Role::Fit, crate::Role::Holdout].into_iter().flat_map(|role| set.runs_of(role).take(RUNS / 2)).collect()
}

/// Panels: joints share one per quantity, other subjects have one per quantity, commands of actuators one for all.
fn rows(runs: &[&RecordedRun]) -> Vec<(String, Vec<String>)> {
    let mut rows: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for series in runs.iter().flat_map(|run| &run.series) {
        let channels = rows.entry(title_of(&series.channel)).or_default();
        if !channels.contains(&series.channel) {
            channels.push(series.channel.clone());
        }
    }
    rows.into_iter().collect()
}

fn title_of(channel: &str) -> String {
    let Some(name) = ChannelName::parse(channel) else { return channel.to_owned() };
    let unit = match name.quantity.unit() {
        "" => String::new(),
        unit => format!(", {unit}"),
    };
    let last = name.prefix.rsplit('.').next().unwrap_or_default();
    match name.component {
        "" => format!("{}.*.{last}{unit}", name.family()),
        _ => format!("{}{unit}", name.prefix),
    }
}

fn label_of(channel: &str) -> &str {
    ChannelName::parse(channel).map_or(channel, |n| if n.component.is_empty() { n.subject } else { n.component })
}

fn add_panel(svg: &mut String, (runs, run): (&[&RecordedRun], &RecordedRun), title: &str, channels: &[String]) {
    let drawn: Vec<&String> = channels.iter().take(LINES).collect();
    let all = || runs.iter().flat_map(|run| drawn.iter().filter_map(|c| run.series(c)));
    let up = Scale::new(all().flat_map(|s| s.values.iter().copied()), (PANEL.1 - MARGIN.3, MARGIN.2));
    let (first, last) = run.span().unwrap_or((0.0, 1.0));
    let across = Scale::new([first, last].into_iter(), (MARGIN.0, PANEL.0 - MARGIN.1));
    let _ = writeln!(svg, "<text x=\"{}\" y=\"20\" font-weight=\"bold\">{}</text>", MARGIN.0, escape(title));
    add_grid(svg, &across, &up);
    for (k, channel) in drawn.iter().enumerate() {
        if let Some(series) = run.series(channel) {
            add_series(svg, series, (&across, &up), COLOURS[k]);
            add_legend(svg, k, label_of(channel), None);
        }
    }
    if channels.len() > LINES {
        let y = MARGIN.2 + 12.0 + 17.0 * LINES as f64;
        let more = format!("and {} more", channels.len() - LINES);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{y}\" fill=\"#666\">{more}</text>", PANEL.0 - MARGIN.1 + 12.0);
    }
}

/// A gap breaks the line: a missing sample stands in its middle.
fn add_series(svg: &mut String, series: &Series, axes: (&Scale, &Scale), colour: &str) {
    const GAP: f64 = 5.0;
    let step = series.median_step();
    let (mut times, mut values) = (Vec::with_capacity(series.len()), Vec::with_capacity(series.len()));
    for (i, (t, v)) in series.times.iter().zip(&series.values).enumerate() {
        if i > 0 && t - series.times[i - 1] > GAP * step {
            times.push(0.5 * (t + series.times[i - 1]));
            values.push(f64::NAN);
        }
        times.push(*t);
        values.push(*v);
    }
    add_line(svg, &times, &values, axes, colour);
}
