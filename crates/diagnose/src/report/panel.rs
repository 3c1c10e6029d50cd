//! One drawing with axes as inline SVG. Colours are classes of the page's style sheet, so a drawing follows the reader's dark or
//! light scheme; sizes are such that a panel is readable on a phone's width.

use record::plot::{Axis, escape};
use std::fmt::Write;

/// Width of a panel, its left and right margin, px of the drawing.
const WIDTH: f64 = 480.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 8.0;
/// Room below for ticks, and for ticks with the axis' name.
const BELOW: f64 = 24.0;
const BELOW_NAMED: f64 = 42.0;
/// Least distance of two ticks upwards, px.
const TICK_ROOM: f64 = 13.5;
/// Columns to which lines are thinned: one per pixel of the drawing.
const COLUMNS: usize = 400;

/// A drawing.
#[derive(Clone, Debug, Default)]
pub(super) struct Panel {
    /// Quantity and unit across; empty: ticks only.
    pub(super) across: String,
    /// Quantity and unit up.
    pub(super) up: String,
    /// Height of the drawing area, px.
    pub(super) height: f64,
    /// Ends across; all points where absent.
    pub(super) across_ends: Option<(f64, f64)>,
    /// Ends up; all points where absent.
    pub(super) up_ends: Option<(f64, f64)>,
    /// Whether the upward axis is asinh: linear below 1, logarithmic above, both signs.
    pub(super) squashed: bool,
    /// What is drawn, back to front.
    pub(super) layers: Vec<Layer>,
}

/// Something drawn; `class` names its colours.
#[derive(Clone, Debug)]
pub(super) enum Layer {
    /// A line; NaN breaks it.
    Line(&'static str, Vec<(f64, f64)>),
    /// An area between two values: (x, low, high).
    Band(&'static str, Vec<(f64, f64, f64)>),
    /// Marks with error bars of a half length: (x, y, error).
    Marks(&'static str, Vec<(f64, f64, f64)>),
    /// Bars from zero of a width in units across: (x, y).
    Bars(&'static str, f64, Vec<(f64, f64)>),
    /// A horizontal line.
    Level(&'static str, f64),
    /// A stretch across, over the full height.
    Span(&'static str, f64, f64),
}

impl Layer {
    fn across(&self) -> Vec<f64> {
        match self {
            Self::Line(_, points) | Self::Bars(_, _, points) => points.iter().map(|p| p.0).collect(),
            Self::Band(_, points) | Self::Marks(_, points) => points.iter().map(|p| p.0).collect(),
            Self::Level(..) | Self::Span(..) => Vec::new(),
        }
    }

    fn up(&self) -> Vec<f64> {
        match self {
            Self::Line(_, points) => points.iter().map(|p| p.1).collect(),
            Self::Bars(_, _, points) => points.iter().map(|p| p.1).chain([0.0]).collect(),
            Self::Band(_, points) => points.iter().flat_map(|p| [p.1, p.2]).collect(),
            Self::Marks(_, points) => points.iter().flat_map(|p| [p.1 - p.2, p.1 + p.2]).collect(),
            Self::Level(_, y) => vec![*y],
            Self::Span(..) => Vec::new(),
        }
    }
}

/// The two axes of a panel while it is drawn.
struct Axes {
    across: Axis,
    up: Axis,
    squashed: bool,
}

impl Axes {
    fn x(&self, value: f64) -> f64 {
        self.across.at(value)
    }

    fn y(&self, value: f64) -> f64 {
        // Far outside the panel a coordinate only makes the file longer.
        self.up.at(squash(value, self.squashed)).clamp(-2000.0, 4000.0)
    }
}

fn squash(value: f64, is_squashed: bool) -> f64 {
    if is_squashed { value.asinh() } else { value }
}

impl Panel {
    /// The drawing as an `<svg>` element; `name` is read to those who do not see it.
    pub(super) fn svg(&self, name: &str) -> String {
        let axes = self.axes();
        let below = if self.across.is_empty() { BELOW } else { BELOW_NAMED };
        let total = TOP + self.height + below;
        let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {total}\" role=\"img\"><title>{}</title>", escape(name));
        self.add_grid(&mut svg, &axes);
        let (width, height) = (WIDTH - LEFT - RIGHT, self.height);
        let _ = write!(
            svg,
            "<svg x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\" viewBox=\"{LEFT} {TOP} {width} {height}\">"
        );
        self.layers.iter().for_each(|layer| add_layer(&mut svg, layer, &axes, (TOP, TOP + self.height)));
        let _ = write!(
            svg,
            "</svg><rect class=\"frame\" x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\"/></svg>"
        );
        svg
    }

    fn axes(&self) -> Axes {
        let left_right = (LEFT, WIDTH - RIGHT);
        let bottom_top = (TOP + self.height, TOP);
        let across = match self.across_ends {
            Some((low, high)) => Axis::between(low, high, left_right),
            None => Axis::new(self.layers.iter().flat_map(Layer::across), false, left_right),
        };
        let up = match self.up_ends {
            Some((low, high)) => Axis::between(squash(low, self.squashed), squash(high, self.squashed), bottom_top),
            None => {
                let values = self.layers.iter().flat_map(Layer::up);
                Axis::new(values.map(|v| squash(v, self.squashed)), false, bottom_top)
            }
        };
        Axes { across, up, squashed: self.squashed }
    }

    fn add_grid(&self, svg: &mut String, axes: &Axes) {
        let (bottom, top) = (TOP + self.height, TOP);
        for (tick, label) in axes.across.ticks() {
            let x = axes.x(tick);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{x:.1} {bottom}V{top}\"/><text x=\"{x:.1}\" y=\"{}\" class=\"mid\">{label}</text>",
                bottom + 16.0
            );
        }
        for (tick, label) in self.up_ticks(axes) {
            let y = axes.y(tick);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{LEFT} {y:.1}H{}\"/><text x=\"{}\" y=\"{:.1}\" class=\"end\">{label}</text>",
                WIDTH - RIGHT,
                LEFT - 6.0,
                y + 4.0
            );
        }
        let middle = 0.5 * (LEFT + WIDTH - RIGHT);
        let _ = write!(
            svg,
            "<text x=\"{middle}\" y=\"{}\" class=\"mid name\">{}</text>\
             <text transform=\"translate(12,{}) rotate(-90)\" class=\"mid name\">{}</text>",
            bottom + 35.0,
            escape(&self.across),
            TOP + 0.5 * self.height,
            escape(&self.up)
        );
    }

    /// Ticks upwards, few enough for the height.
    fn up_ticks(&self, axes: &Axes) -> Vec<(f64, String)> {
        let (bottom, top) = axes.up.pixels;
        if !self.squashed {
            let ticks = axes.up.ticks();
            let every = ((ticks.len() as f64 * TICK_ROOM) / (bottom - top)).ceil().max(1.0) as usize;
            return ticks.into_iter().step_by(every).collect();
        }
        // Zero first, then the largest decades, then what still has room.
        let powers = (0..9).rev().map(|p| 10_f64.powi(p));
        let mut kept: Vec<(f64, f64)> = Vec::new();
        for value in [0.0].into_iter().chain(powers.flat_map(|v| [v, -v])) {
            let y = axes.up.at(value.asinh());
            if (top..=bottom).contains(&y) && kept.iter().all(|(_, other)| (y - other).abs() >= TICK_ROOM) {
                kept.push((value, y));
            }
        }
        kept.into_iter().map(|(v, _)| (v, power_of_ten(v))).collect()
    }
}

/// `100`, `−10⁴`.
fn power_of_ten(value: f64) -> String {
    if value.abs() < 2e3 { crate::number::digits(value, 1) } else { crate::number::digits(value, 1).replace("1·", "") }
}

fn add_layer(svg: &mut String, layer: &Layer, axes: &Axes, (top, bottom): (f64, f64)) {
    let _ = match layer {
        Layer::Line(class, points) => write!(svg, "<path class=\"l {class}\" d=\"{}\"/>", line(points, axes)),
        Layer::Band(class, points) => write!(svg, "<path class=\"b {class}\" d=\"{}\"/>", band(points, axes)),
        Layer::Marks(class, points) => write!(svg, "<path class=\"m {class}\" d=\"{}\"/>", marks(points, axes)),
        Layer::Bars(class, width, points) => {
            write!(svg, "<path class=\"b {class}\" d=\"{}\"/>", bars(points, *width, axes))
        }
        Layer::Level(class, y) => {
            let y = axes.y(*y);
            write!(
                svg,
                "<path class=\"l {class}\" d=\"M{:.1} {y:.1}H{:.1}\"/>",
                axes.across.pixels.0, axes.across.pixels.1
            )
        }
        Layer::Span(class, from, to) => {
            let (from, to) = (axes.x(*from), axes.x(*to));
            write!(svg, "<path class=\"b {class}\" d=\"M{from:.1} {top}H{to:.1}V{bottom}H{from:.1}z\"/>")
        }
    };
}

/// A line with the least and the largest value of every column.
fn line(points: &[(f64, f64)], axes: &Axes) -> String {
    let mut path = String::new();
    let mut pen_is_down = false;
    for column in points.chunks(points.len().div_ceil(COLUMNS).max(1)) {
        let finite = || column.iter().enumerate().filter(|(_, p)| p.0.is_finite() && p.1.is_finite());
        let low = finite().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let high = finite().max_by(|a, b| a.1.1.total_cmp(&b.1.1));
        let (Some(low), Some(high)) = (low, high) else {
            pen_is_down = false;
            continue;
        };
        let ends = if low.0 <= high.0 { [low, high] } else { [high, low] };
        for (_, (x, y)) in &ends[..if low.0 == high.0 { 1 } else { 2 }] {
            let command = if pen_is_down { 'L' } else { 'M' };
            let _ = write!(path, "{command}{:.1} {:.1}", axes.x(*x), axes.y(*y));
            pen_is_down = true;
        }
    }
    path
}

/// A closed area per unbroken stretch.
fn band(points: &[(f64, f64, f64)], axes: &Axes) -> String {
    let mut path = String::new();
    for stretch in points.split(|p| !(p.1.is_finite() && p.2.is_finite())).filter(|s| !s.is_empty()) {
        let columns = stretch.chunks(points.len().div_ceil(COLUMNS).max(1));
        let ends: Vec<_> = columns
            .map(|c| {
                let low = c.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
                let high = c.iter().map(|p| p.2).fold(f64::NEG_INFINITY, f64::max);
                (axes.x(c[c.len() / 2].0), axes.y(low), axes.y(high))
            })
            .collect();
        for (i, (x, _, high)) in ends.iter().enumerate() {
            let _ = write!(path, "{}{x:.1} {high:.1}", if i == 0 { 'M' } else { 'L' });
        }
        ends.iter().rev().for_each(|(x, low, _)| path += &format!("L{x:.1} {low:.1}"));
        path.push('z');
    }
    path
}

/// Small circles with bars.
fn marks(points: &[(f64, f64, f64)], axes: &Axes) -> String {
    let mut path = String::new();
    for (x, y, error) in points.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) {
        let (at, middle) = (axes.x(*x), axes.y(*y));
        let _ = write!(path, "M{:.1} {middle:.1}a1.8 1.8 0 1 0 3.6 0a1.8 1.8 0 1 0 -3.6 0", at - 1.8);
        if *error > 0.0 && error.is_finite() {
            let _ = write!(path, "M{at:.1} {:.1}V{:.1}", axes.y(y - error), axes.y(y + error));
        }
    }
    path
}

fn bars(points: &[(f64, f64)], width: f64, axes: &Axes) -> String {
    let mut path = String::new();
    for (x, y) in points.iter().filter(|p| p.1.is_finite()) {
        let (left, right) = (axes.x(x - 0.5 * width), axes.x(x + 0.5 * width));
        let _ = write!(path, "M{left:.1} {:.1}V{:.1}H{right:.1}V{:.1}z", axes.y(0.0), axes.y(*y), axes.y(0.0));
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(layers: Vec<Layer>) -> Panel {
        Panel { across: "time, s".into(), up: "a < b".into(), height: 100.0, layers, ..Panel::default() }
    }

    #[test]
    fn lines_are_thinned_and_keep_their_peaks() {
        let mut points: Vec<(f64, f64)> = (0..100_000).map(|k| (f64::from(k), 0.0)).collect();
        points[77_777].1 = 5.0;
        points[10].1 = f64::NAN;
        let panel = panel(vec![Layer::Line("nominal", points)]);
        let svg = panel.svg("x");
        assert!(svg.len() < 12_000, "{}", svg.len());
        assert!(!svg.contains("NaN") && svg.contains("a &lt; b"));
        let peak = panel.axes().y(5.0);
        assert!(svg.contains(&format!(" {peak:.1}L")), "the peak stays");
    }

    #[test]
    fn a_squashed_axis_shows_small_and_large_of_both_signs() {
        let layers = vec![Layer::Line("nominal", vec![(0.0, -3e4), (1.0, 0.5), (2.0, 3e4)])];
        let svg = Panel { squashed: true, ..panel(layers) }.svg("x");
        assert!(svg.contains(">0<") && svg.contains(">−"), "{svg}");
    }

    #[test]
    fn gaps_break_bands_and_nothing_drawn_is_not_finite() {
        let points = vec![(0.0, 1.0, 2.0), (1.0, f64::NAN, 2.0), (2.0, 1.0, 2.0)];
        let layers = vec![
            Layer::Band("noise", points),
            Layer::Marks("measured", vec![(0.0, 1.0, f64::INFINITY), (1.0, f64::NAN, 0.1), (2.0, 1.0, 0.5)]),
            Layer::Bars("after", 0.8, vec![(0.0, -1.0), (1.0, f64::NAN)]),
            Layer::Level("bound", 0.3),
            Layer::Span("located", 0.5, 1.0),
        ];
        let svg = panel(layers).svg("x");
        assert!(!svg.contains("NaN") && !svg.contains("inf") && svg.matches('z').count() >= 3, "{svg}");
    }
}
