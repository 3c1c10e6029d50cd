//! Plots of a run as one SVG: the signals that matter in a grid, for readers without a viewer.
//!
//! One panel per set of axes ([`crate::Axes`]): time across, one line per channel, a legend with each channel's last value,
//! and a dashed line at every event; the events in words at the end. Lines are thinned to what the panel's width can show: least and largest value per pixel.

mod axis;
mod scale;

pub use axis::{Axis, equalise, escape};
mod recorded;
pub use recorded::recording_svg;

use crate::{Axes, Log, Plot};
use scale::{Scale, shown};
use std::fmt::Write;

/// Panels that a reader wants first; the rest is in the Parquet file.
const PANELS: [Plot; 5] = [Plot::Relative, Plot::Contact, Plot::Momentum, Plot::Energy, Plot::Joints];
/// Most lines in a panel that can be told apart.
const LINES: usize = 10;
/// Size of a panel, its margins (left, right, top, bottom), and the columns of the grid, px.
const PANEL: (f64, f64) = (640.0, 250.0);
const MARGIN: (f64, f64, f64, f64) = (70.0, 190.0, 34.0, 30.0);
const COLUMNS: usize = 2;
/// Height of a line of the list of events, px.
const EVENT_HEIGHT: f64 = 18.0;
/// Colours that stay apart for most eyes (Okabe and Ito 2008), then lighter ones.
const COLOURS: [&str; LINES] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#5f5f5f", "#8c564b", "#bcbd22", "#9467bd"];

/// The plots of a run.
pub fn plot_svg(log: &Log) -> String {
    let chosen: Vec<Axes> =
        log.signals.axes().into_iter().filter(|axes| PANELS.contains(&axes.plot) && is_telling(log, axes)).collect();
    let rows = chosen.len().div_ceil(COLUMNS);
    let below = 40.0 + PANEL.1 * rows as f64;
    let (width, height) = (PANEL.0 * COLUMNS as f64, below + EVENT_HEIGHT * (log.events.len() as f64 + 2.0));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"16\" y=\"26\" font-size=\"17\" font-weight=\"bold\">{}, seed {}</text>\n",
        escape(&log.meta.scenario),
        log.meta.seed
    );
    for (i, axes) in chosen.iter().enumerate() {
        let (x, y) = (PANEL.0 * (i % COLUMNS) as f64, 40.0 + PANEL.1 * (i / COLUMNS) as f64);
        let _ = writeln!(svg, "<g transform=\"translate({x},{y})\">");
        add_panel(&mut svg, log, axes);
        svg.push_str("</g>\n");
    }
    add_event_list(&mut svg, log, below);
    svg.push_str("</svg>\n");
    svg
}

/// A panel where nothing ever is different from zero tells nothing.
fn is_telling(log: &Log, axes: &Axes) -> bool {
    axes.channels.iter().any(|&i| log.signals.channels[i].values.iter().any(|v| v.is_finite() && *v != 0.0))
}

fn add_panel(svg: &mut String, log: &Log, axes: &Axes) {
    let specs: Vec<_> = log.signals.channels.iter().map(|c| &c.spec).collect();
    let drawn: Vec<usize> = axes.channels.iter().copied().take(LINES).collect();
    let times = &log.signals.times;
    let all = drawn.iter().flat_map(|&i| log.signals.channels[i].values.iter().copied());
    let left_right = (MARGIN.0, PANEL.0 - MARGIN.1);
    let bottom_top = (PANEL.1 - MARGIN.3, MARGIN.2);
    let across = Scale::new(times.iter().copied(), left_right);
    let up = Scale::new(all, bottom_top);
    let _ =
        writeln!(svg, "<text x=\"{}\" y=\"20\" font-weight=\"bold\">{}</text>", MARGIN.0, escape(&axes.title(&specs)));
    add_grid(svg, &across, &up);
    for event in &log.events {
        let x = across.at(event.t);
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{:.1}\" y2=\"{:.1}\" stroke=\"#999\" stroke-dasharray=\"2 3\">\
             <title>{}</title></line>",
            bottom_top.0,
            bottom_top.1,
            escape(&event.text)
        );
    }
    for (k, &i) in drawn.iter().enumerate() {
        add_line(svg, times, &log.signals.channels[i].values, (&across, &up), COLOURS[k]);
        add_legend(svg, k, &axes.labels[k], log.signals.channels[i].values.last().copied());
    }
    if axes.channels.len() > LINES {
        let more = format!("and {} more", axes.channels.len() - LINES);
        let y = MARGIN.2 + 12.0 + 17.0 * LINES as f64;
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{y}\" fill=\"#666\">{more}</text>", PANEL.0 - MARGIN.1 + 12.0);
    }
}

/// What happened when, below the panels.
fn add_event_list(svg: &mut String, log: &Log, top: f64) {
    for (row, event) in log.events.iter().enumerate() {
        let y = top + EVENT_HEIGHT * (row as f64 + 1.0);
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{y}\" text-anchor=\"end\" fill=\"#444\">{:.3} s</text><text x=\"{}\" y=\"{y}\">{}</text>",
            MARGIN.0 + 10.0,
            event.t,
            MARGIN.0 + 22.0,
            escape(&event.text)
        );
    }
}

fn add_grid(svg: &mut String, across: &Scale, up: &Scale) {
    for tick in across.ticks() {
        let x = across.at(tick);
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{:.1}\" y2=\"{:.1}\" stroke=\"#eee\"/><text x=\"{x:.1}\" y=\"{:.1}\" \
             text-anchor=\"middle\" fill=\"#444\">{} s</text>",
            up.pixels.0,
            up.pixels.1,
            up.pixels.0 + 16.0,
            shown(tick)
        );
    }
    for tick in up.ticks() {
        let y = up.at(tick);
        let _ = writeln!(
            svg,
            "<line x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#eee\"/><text x=\"{:.1}\" y=\"{:.1}\" \
             text-anchor=\"end\" fill=\"#444\">{}</text>",
            across.pixels.0,
            across.pixels.1,
            across.pixels.0 - 6.0,
            y + 4.0,
            shown(tick)
        );
    }
}

/// A line with at most two points per pixel; a sample that was not taken breaks it.
fn add_line(svg: &mut String, times: &[f64], values: &[f64], (across, up): (&Scale, &Scale), colour: &str) {
    let per_pixel = (times.len() as f64 / (across.pixels.1 - across.pixels.0)).ceil().max(1.0) as usize;
    let mut path = String::new();
    let mut pen_is_down = false;
    for (t, v) in times.chunks(per_pixel).zip(values.chunks(per_pixel)) {
        let finite = || v.iter().copied().enumerate().filter(|(_, v)| v.is_finite());
        let low = finite().min_by(|a, b| a.1.total_cmp(&b.1));
        let high = finite().max_by(|a, b| a.1.total_cmp(&b.1));
        let (Some(low), Some(high)) = (low, high) else {
            pen_is_down = false;
            continue;
        };
        let (first, second) = if low.0 <= high.0 { (low, high) } else { (high, low) };
        let points = if first == second { &[first][..] } else { &[first, second][..] };
        for (i, value) in points {
            let command = if pen_is_down { 'L' } else { 'M' };
            let _ = write!(path, "{command}{:.1} {:.1}", across.at(t[*i]), up.at(*value));
            pen_is_down = true;
        }
    }
    let _ = writeln!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.4\"/>");
}

fn add_legend(svg: &mut String, k: usize, label: &str, last: Option<f64>) {
    let (x, y) = (PANEL.0 - MARGIN.1 + 12.0, MARGIN.2 + 12.0 + 17.0 * k as f64);
    let value = last.filter(|v| v.is_finite()).map(|v| format!("  {}", shown(v))).unwrap_or_default();
    let _ = writeln!(
        svg,
        "<rect x=\"{x}\" y=\"{}\" width=\"12\" height=\"3\" fill=\"{}\"/><text x=\"{}\" y=\"{y}\">{}<tspan fill=\"#888\">{value}\
         </tspan></text>",
        y - 5.0,
        COLOURS[k],
        x + 17.0,
        escape(label)
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ChannelSpec, Meta, Sample};

    #[test]
    fn every_telling_channel_has_a_line_and_a_legend() {
        let specs = vec![
            ChannelSpec::new("relative.distance", "m", Plot::Relative),
            ChannelSpec::new("contact.a.b.normal_force", "N", Plot::Contact),
            ChannelSpec::new("energy.zero", "J", Plot::Energy),
        ];
        let mut log = Log::new(Meta { scenario: "a<b".into(), ..Meta::default() }, specs, 0);
        for k in 0..5000_u32 {
            let t = f64::from(k) * 0.01;
            let force = if k == 2500 { f64::NAN } else { t.sin() };
            let values = [1.0 / (1.0 + t), force, 0.0];
            log.push(&Sample { t, step: u64::from(k), values: &values, poses_w: &[], contacts: &[] })
                .expect("well formed");
        }
        let svg = plot_svg(&log);
        assert_eq!(svg.matches("<path").count(), 2, "an all-zero panel is left out");
        assert!(svg.contains("a&lt;b") && svg.contains("distance") && !svg.contains("NaN"));
        assert!(svg.len() < 200_000, "lines are thinned");
    }
}
