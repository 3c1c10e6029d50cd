//! What a panel shows: lines, bands, marks, bars, boxes, dots and texts, drawn as SVG paths.

use super::panel::Axes;
use crate::plot::escape;
use std::fmt::Write;

/// Columns to which lines are thinned: one per pixel of the drawing.
const COLUMNS: usize = 400;

/// Something drawn; `class` names its colours.
#[derive(Clone, Debug)]
pub enum Layer {
    /// A line; NaN breaks it.
    Line(&'static str, Vec<(f64, f64)>),
    /// An area between two values: (x, low, high).
    Band(&'static str, Vec<(f64, f64, f64)>),
    /// Marks with error bars of a half length: (x, y, error).
    Marks(&'static str, Vec<(f64, f64, f64)>),
    /// Marks with error bars between two values: (x, y, low, high).
    Intervals(&'static str, Vec<(f64, f64, f64, f64)>),
    /// Many marks without error bars: (x, y).
    Dots(&'static str, Vec<(f64, f64)>),
    /// Bars from zero of a width in units across: (x, y).
    Bars(&'static str, f64, Vec<(f64, f64)>),
    /// Rectangles: (left, right, low, high).
    Boxes(&'static str, Vec<(f64, f64, f64, f64)>),
    /// Texts, their middle at a point: (x, y, px below the point, text).
    Texts(&'static str, Vec<(f64, f64, f64, String)>),
    /// A horizontal line.
    Level(&'static str, f64),
    /// A vertical line.
    Upright(&'static str, f64),
    /// A stretch across, over the full height.
    Span(&'static str, f64, f64),
}

impl Layer {
    pub(super) fn across(&self) -> Vec<f64> {
        match self {
            Self::Line(_, points) | Self::Bars(_, _, points) | Self::Dots(_, points) => {
                points.iter().map(|p| p.0).collect()
            }
            Self::Band(_, points) | Self::Marks(_, points) => points.iter().map(|p| p.0).collect(),
            Self::Intervals(_, points) => points.iter().map(|p| p.0).collect(),
            Self::Boxes(_, boxes) => boxes.iter().flat_map(|b| [b.0, b.1]).collect(),
            Self::Upright(_, x) => vec![*x],
            Self::Level(..) | Self::Span(..) | Self::Texts(..) => Vec::new(),
        }
    }

    pub(super) fn up(&self) -> Vec<f64> {
        match self {
            Self::Line(_, points) | Self::Dots(_, points) => points.iter().map(|p| p.1).collect(),
            Self::Bars(_, _, points) => points.iter().map(|p| p.1).chain([0.0]).collect(),
            Self::Band(_, points) => points.iter().flat_map(|p| [p.1, p.2]).collect(),
            Self::Marks(_, points) => points.iter().flat_map(|p| [p.1 - p.2, p.1 + p.2]).collect(),
            Self::Intervals(_, points) => points.iter().flat_map(|p| [p.2, p.3]).collect(),
            Self::Boxes(_, boxes) => boxes.iter().flat_map(|b| [b.2, b.3]).collect(),
            Self::Level(_, y) => vec![*y],
            Self::Upright(..) | Self::Span(..) | Self::Texts(..) => Vec::new(),
        }
    }

    /// Writes it as SVG elements; `top` and `bottom` are those of the drawing area.
    pub(super) fn draw(&self, svg: &mut String, axes: &Axes, (top, bottom): (f64, f64)) {
        let (left, right) = axes.across.pixels;
        let (kind, class, path) = match self {
            Self::Line(class, points) => ('l', class, line(points, axes)),
            Self::Band(class, points) => ('b', class, band(points, axes)),
            Self::Marks(class, points) => {
                let ends = points.iter().map(|(x, y, error)| (*x, *y, y - error, y + error));
                ('m', class, intervals(ends, axes))
            }
            Self::Intervals(class, points) => ('m', class, intervals(points.iter().copied(), axes)),
            Self::Dots(class, points) => ('d', class, dots(points, axes)),
            Self::Bars(class, width, points) => ('b', class, bars(points, *width, axes)),
            Self::Boxes(class, boxes) => ('b', class, rectangles(boxes, axes)),
            Self::Level(class, y) => ('l', class, format!("M{left:.1} {:.1}H{right:.1}", axes.y(*y))),
            Self::Upright(class, x) => ('l', class, format!("M{:.1} {bottom}V{top}", axes.x(*x))),
            Self::Span(class, from, to) => {
                let (from, to) = (axes.x(*from), axes.x(*to));
                ('b', class, format!("M{from:.1} {top}H{to:.1}V{bottom}H{from:.1}z"))
            }
            Self::Texts(class, texts) => return add_texts(svg, class, texts, axes),
        };
        if !path.is_empty() {
            let _ = write!(svg, "<path class=\"{kind} {class}\" d=\"{path}\"/>");
        }
    }
}

fn add_texts(svg: &mut String, class: &str, texts: &[(f64, f64, f64, String)], axes: &Axes) {
    for (x, y, below, text) in texts.iter().filter(|t| t.0.is_finite() && t.1.is_finite()) {
        let (x, y) = (axes.x(*x), axes.y(*y) + below);
        let _ = write!(svg, "<text class=\"mid {class}\" x=\"{x:.1}\" y=\"{y:.1}\">{}</text>", escape(text));
    }
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

/// Small circles with bars: (x, y, low, high).
fn intervals(points: impl Iterator<Item = (f64, f64, f64, f64)>, axes: &Axes) -> String {
    let mut path = String::new();
    for (x, y, low, high) in points.filter(|p| p.0.is_finite() && p.1.is_finite()) {
        let (at, middle) = (axes.x(x), axes.y(y));
        let _ = write!(path, "M{:.1} {middle:.1}a1.8 1.8 0 1 0 3.6 0a1.8 1.8 0 1 0 -3.6 0", at - 1.8);
        if high > low && low.is_finite() && high.is_finite() {
            let _ = write!(path, "M{at:.1} {:.1}V{:.1}", axes.y(low), axes.y(high));
        }
    }
    path
}

/// Strokes without length: their round ends are the dots, a fraction of the text that circles take.
fn dots(points: &[(f64, f64)], axes: &Axes) -> String {
    let mut path = String::new();
    for (x, y) in points.iter().filter(|p| p.0.is_finite() && p.1.is_finite()) {
        let _ = write!(path, "M{:.1} {:.1}h0", axes.x(*x), axes.y(*y));
    }
    path
}

fn rectangles(boxes: &[(f64, f64, f64, f64)], axes: &Axes) -> String {
    let mut path = String::new();
    for (left, right, low, high) in boxes.iter().filter(|b| b.2.is_finite() && b.3.is_finite()) {
        let (left, right, low, high) = (axes.x(*left), axes.x(*right), axes.y(*low), axes.y(*high));
        let _ = write!(path, "M{left:.1} {low:.1}V{high:.1}H{right:.1}V{low:.1}z");
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
