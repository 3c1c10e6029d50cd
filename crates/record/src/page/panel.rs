//! One drawing with axes as inline SVG. Colours are classes of the page's style sheet, so a drawing follows the
//! reader's dark or light scheme; sizes are such that a panel is readable on a phone's width.

use super::Layer;
use super::number;
use crate::plot::{Axis, escape};
use std::fmt::Write;

/// Width of a panel, its left and right margin, px of the drawing.
const WIDTH: f64 = 480.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 8.0;
/// Room below for ticks, and for ticks with the axis' name.
const BELOW: f64 = 24.0;
const BELOW_NAMED: f64 = 42.0;
/// Width of a sign on a phone, px of the drawing.
const SIGN: f64 = 8.2;
/// Least distance of two ticks upwards, px.
const TICK_ROOM: f64 = 13.5;

/// A drawing.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Quantity and unit across; empty: ticks only.
    pub across: String,
    /// Quantity and unit up.
    pub up: String,
    /// Height of the drawing area, px.
    pub height: f64,
    /// Ends across; all points where absent.
    pub across_ends: Option<(f64, f64)>,
    /// Ends up; all points where absent.
    pub up_ends: Option<(f64, f64)>,
    /// Marks across instead of ticks: places and what stands there.
    pub across_marks: Option<Vec<(f64, String)>>,
    /// Marks up instead of ticks.
    pub up_marks: Option<Vec<(f64, String)>>,
    /// Whether the axis across is logarithmic.
    pub logarithmic: bool,
    /// Whether the upward axis is asinh: linear below 1, logarithmic above, both signs.
    pub squashed: bool,
    /// What is drawn, back to front.
    pub layers: Vec<Layer>,
}

/// The two axes of a panel while it is drawn.
pub(super) struct Axes {
    pub(super) across: Axis,
    pub(super) up: Axis,
    squashed: bool,
}

impl Axes {
    pub(super) fn x(&self, value: f64) -> f64 {
        self.across.at(value)
    }

    pub(super) fn y(&self, value: f64) -> f64 {
        // Far outside the panel a coordinate only makes the file longer.
        self.up.at(squash(value, self.squashed)).clamp(-2000.0, 4000.0)
    }
}

fn squash(value: f64, is_squashed: bool) -> f64 {
    if is_squashed { value.asinh() } else { value }
}

impl Panel {
    /// The drawing as an `<svg>` element; `name` is read to those who do not see it.
    pub fn svg(&self, name: &str) -> String {
        let axes = self.axes();
        let below = if self.across.is_empty() { BELOW } else { BELOW_NAMED };
        let total = TOP + self.height + below;
        let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {total}\" role=\"img\"><title>{}</title>", escape(name));
        self.add_grid(&mut svg, &axes);
        let (width, height) = (WIDTH - LEFT - RIGHT, self.height);
        let _ = write!(
            svg,
            "<svg x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\" viewBox=\"{LEFT} {TOP} {width} \
             {height}\">"
        );
        self.layers.iter().for_each(|layer| layer.draw(&mut svg, &axes, (TOP, TOP + self.height)));
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
            Some((low, high)) if self.logarithmic => Axis::between_logarithms(low, high, left_right),
            Some((low, high)) => Axis::between(low, high, left_right),
            None => Axis::new(self.layers.iter().flat_map(Layer::across), self.logarithmic, left_right),
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
        for (tick, label) in self.across_marks.clone().unwrap_or_else(|| axes.across.ticks()) {
            let x = axes.x(tick);
            let _ = write!(
                svg,
                "<path class=\"grid\" d=\"M{x:.1} {bottom}V{top}\"/><text x=\"{x:.1}\" y=\"{}\" \
                 class=\"mid\">{label}</text>",
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
            escape(&fitting(&self.across, WIDTH)),
            TOP + 0.5 * self.height,
            escape(&fitting(&self.up, self.height + 2.0 * TOP))
        );
    }

    /// Ticks upwards, few enough for the height.
    fn up_ticks(&self, axes: &Axes) -> Vec<(f64, String)> {
        let (bottom, top) = axes.up.pixels;
        if self.up_marks.is_some() || !self.squashed {
            let ticks = self.up_marks.clone().unwrap_or_else(|| axes.up.ticks());
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

/// A label that fits in a room of some px: what is too long loses the end of its name, not its unit.
fn fitting(label: &str, room: f64) -> String {
    let most = (room / SIGN) as usize;
    if label.chars().count() <= most {
        return label.to_owned();
    }
    let unit = label.rfind(", ").map_or("", |at| &label[at..]);
    let kept = most.saturating_sub(unit.chars().count() + 1);
    label.chars().take(kept).chain(['…']).chain(unit.chars()).collect()
}

/// `100`, `−10⁴`.
fn power_of_ten(value: f64) -> String {
    if value.abs() < 2e3 { number::digits(value, 1) } else { number::digits(value, 1).replace("1·", "") }
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
    fn long_labels_keep_their_unit() {
        assert_eq!(fitting("peak force, N", 480.0), "peak force, N");
        assert_eq!(fitting("a force with a very long name indeed, N·s", 164.0), "a force with a…, N·s");
    }

    #[test]
    fn logarithms_and_other_layers_stay_finite() {
        let layers = vec![
            Layer::Boxes("o0", vec![(0.0, 1.0, 0.0, 2.0), (1.0, 10.0, 0.0, f64::NAN)]),
            Layer::Dots("o1", vec![(1.0, 1.0), (f64::NAN, 1.0)]),
            Layer::Texts("cell", vec![(1.0, 1.0, 0.0, "<5".into())]),
            Layer::Intervals("o2", vec![(2.0, 1.0, 0.5, 1.5)]),
            Layer::Upright("bound", 3.0),
        ];
        let svg = Panel { logarithmic: true, across_ends: Some((0.1, 10.0)), ..panel(layers) }.svg("x");
        assert!(!svg.contains("NaN") && !svg.contains("inf") && svg.contains("&lt;5"), "{svg}");
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
