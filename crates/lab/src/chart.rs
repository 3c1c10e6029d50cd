//! A [`Chart`] as SVG: axes linear or logarithmic, theory dashed, single measurements as marks, legend at the right.

use crate::{Chart, Curve};
pub(crate) use record::plot::escape;
use record::plot::{Axis, equalise};
use std::fmt::Write;

/// Size of a chart, and its margins left, right, top, bottom, px.
const SIZE: (f64, f64) = (820.0, 400.0);
const MARGIN: (f64, f64, f64, f64) = (84.0, 210.0, 44.0, 52.0);
/// Colours that stay apart for most eyes (Okabe and Ito 2008), then lighter ones; theory is drawn in the first of its own.
const COLOURS: [&str; 9] =
    ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c564b", "#bcbd22", "#9467bd"];
const THEORY: [&str; 3] = ["#222", "#888", "#bbb"];
/// Most points of a line: two per pixel of the chart's width.
const POINTS: usize = 1000;

/// Draws a chart.
pub fn chart_svg(chart: &Chart) -> String {
    let (width, height) = SIZE;
    let points = || chart.curves.iter().flat_map(|c| c.points.iter().copied());
    let mut across = Axis::new(points().map(|p| p.0), chart.logarithmic.0, (MARGIN.0, width - MARGIN.1));
    let mut up = Axis::new(points().map(|p| p.1), chart.logarithmic.1, (height - MARGIN.3, MARGIN.2));
    if chart.equal_scales {
        equalise(&mut across, &mut up);
    }
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{}\" y=\"24\" font-size=\"15\" font-weight=\"bold\">{}</text>\n",
        MARGIN.0,
        escape(&chart.title)
    );
    add_frame(&mut svg, chart, &across, &up);
    add_curves(&mut svg, chart, &across, &up);
    svg.push_str("</svg>\n");
    svg
}

fn add_frame(svg: &mut String, chart: &Chart, across: &Axis, up: &Axis) {
    let (left, right) = across.pixels;
    let (bottom, top) = up.pixels;
    for (tick, label) in across.ticks() {
        let x = across.at(tick);
        let _ = writeln!(
            svg,
            "<line x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{bottom:.1}\" y2=\"{top:.1}\" stroke=\"#e8e8e8\"/><text x=\"{x:.1}\" \
             y=\"{:.1}\" text-anchor=\"middle\" fill=\"#444\">{label}</text>",
            bottom + 17.0
        );
    }
    for (tick, label) in up.ticks() {
        let y = up.at(tick);
        let _ = writeln!(
            svg,
            "<line x1=\"{left:.1}\" x2=\"{right:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\" stroke=\"#e8e8e8\"/><text x=\"{:.1}\" \
             y=\"{:.1}\" text-anchor=\"end\" fill=\"#444\">{label}</text>",
            left - 7.0,
            y + 4.0
        );
    }
    let (middle_x, middle_y) = (0.5 * (left + right), 0.5 * (top + bottom));
    let _ = writeln!(
        svg,
        "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#999\"/>\
         <text x=\"{middle_x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
         <text transform=\"translate(18,{middle_y:.1}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        right - left,
        bottom - top,
        bottom + 40.0,
        escape(&chart.across),
        escape(&chart.up)
    );
}

fn add_curves(svg: &mut String, chart: &Chart, across: &Axis, up: &Axis) {
    let (mut theories, mut measured) = (0, 0);
    for (row, curve) in chart.curves.iter().enumerate() {
        let colour = if curve.is_theory {
            theories += 1;
            THEORY[(theories - 1) % THEORY.len()]
        } else {
            measured += 1;
            COLOURS[(measured - 1) % COLOURS.len()]
        };
        if curve.is_marks {
            add_marks(svg, curve, (across, up), colour);
        } else {
            add_line(svg, curve, (across, up), colour);
        }
        add_legend(svg, row, curve, colour);
    }
}

fn dashes(curve: &Curve) -> &'static str {
    if curve.is_theory { " stroke-dasharray=\"6 4\"" } else { "" }
}

fn add_line(svg: &mut String, curve: &Curve, (across, up): (&Axis, &Axis), colour: &str) {
    let mut path = String::new();
    let mut pen_is_down = false;
    for (x, y) in thin(&curve.points) {
        if !(across.shows(x) && up.shows(y)) {
            pen_is_down = false;
            continue;
        }
        let _ = write!(path, "{}{:.1} {:.1}", if pen_is_down { 'L' } else { 'M' }, across.at(x), up.at(y));
        pen_is_down = true;
    }
    let dashes = dashes(curve);
    let _ = writeln!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\"{dashes}/>");
}

fn add_marks(svg: &mut String, curve: &Curve, (across, up): (&Axis, &Axis), colour: &str) {
    for (x, y) in curve.points.iter().filter(|p| across.shows(p.0) && up.shows(p.1)) {
        let (x, y) = (across.at(*x), up.at(*y));
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.6\" fill=\"{colour}\" fill-opacity=\"0.75\" stroke=\"white\" \
             stroke-width=\"0.7\"/>"
        );
    }
}

/// Legend names longer than this go on in a second line.
const LEGEND_WIDTH: usize = 27;

fn add_legend(svg: &mut String, row: usize, curve: &Curve, colour: &str) {
    let (x, y) = (SIZE.0 - MARGIN.1 + 14.0, MARGIN.2 + 12.0 + 34.0 * row as f64);
    if curve.is_marks {
        let _ = write!(svg, "<circle cx=\"{}\" cy=\"{}\" r=\"3.6\" fill=\"{colour}\"/>", x + 9.0, y - 4.0);
    } else {
        let _ = write!(
            svg,
            "<line x1=\"{x}\" x2=\"{}\" y1=\"{}\" y2=\"{}\" stroke=\"{colour}\" stroke-width=\"2\"{}/>",
            x + 18.0,
            y - 4.0,
            y - 4.0,
            dashes(curve)
        );
    }
    let (first, second) = split_name(&curve.name);
    let at = x + 24.0;
    let _ = writeln!(svg, "<text x=\"{at}\" y=\"{y}\">{}</text>", escape(first));
    if !second.is_empty() {
        let _ = writeln!(svg, "<text x=\"{at}\" y=\"{}\">{}</text>", y + 14.0, escape(second));
    }
}

/// The name in at most two lines, broken at a space.
fn split_name(name: &str) -> (&str, &str) {
    if name.chars().count() <= LEGEND_WIDTH {
        return (name, "");
    }
    let end = name.char_indices().nth(LEGEND_WIDTH).map_or(name.len(), |c| c.0);
    name[..end].rfind(' ').map_or((name, ""), |at| (&name[..at], &name[at + 1..]))
}

/// At most [`POINTS`] points, evenly chosen along the list, with the least and the largest value of every stretch, so that
/// peaks stay.
fn thin(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= POINTS {
        return points.to_vec();
    }
    let stretch = points.len().div_ceil(POINTS / 2);
    let mut kept = Vec::with_capacity(POINTS + 2);
    for part in points.chunks(stretch) {
        let by_value = |a: &(usize, &(f64, f64)), b: &(usize, &(f64, f64))| a.1.1.total_cmp(&b.1.1);
        let low = part.iter().enumerate().min_by(by_value);
        let high = part.iter().enumerate().max_by(by_value);
        if let (Some(low), Some(high)) = (low, high) {
            kept.push(if low.0 <= high.0 { *low.1 } else { *high.1 });
            kept.push(if low.0 <= high.0 { *high.1 } else { *low.1 });
        }
    }
    kept.extend(points.last());
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_is_drawn_and_named_and_nothing_is_nan() {
        let line: Vec<(f64, f64)> = (0..5000).map(|k| f64::from(k) * 1e-3).map(|t| (t, t.sin())).collect();
        let broken = vec![(0.0, 1.0), (1.0, f64::NAN), (2.0, 0.5)];
        let chart = Chart::new("a < b", "time, s", "force, N")
            .line("sine", line.clone())
            .theory("broken", broken)
            .marks("marks", vec![(1.0, 0.2)]);
        let svg = chart_svg(&chart);
        assert_eq!((svg.matches("<path").count(), svg.matches("stroke-dasharray").count()), (2, 2));
        assert!(svg.contains("a &lt; b") && svg.contains("broken") && !svg.contains("NaN"));
        assert!(svg.len() < 40_000, "lines are thinned");
        assert!(thin(&line).iter().any(|p| p.1 > 0.999_999), "the peak stays");
    }

    #[test]
    fn logarithmic_axes_have_decades_and_leave_out_what_has_no_logarithm() {
        let chart = Chart::new("", "", "").logarithmic(true, true).line("x", vec![(1e-8, 1.0), (0.0, 1.0), (1e2, 1e3)]);
        let svg = chart_svg(&chart);
        assert!(svg.contains("10⁻⁶") && !svg.contains("inf"));
    }
}
