//! Histograms by outcome and distribution functions of the metrics that a reader asks for first.

use super::colours::Colours;
use crate::findings::{Findings, MetricSummary};
use crate::table::Table;
use record::page::number::short;
use record::page::unit::{label, unit};
use record::page::{Layer, Panel, figure, name};

/// Most metrics drawn.
pub(super) const MOST: usize = 8;
/// Heights of histogram and distribution function, px.
const HEIGHTS: (f64, f64) = (150.0, 90.0);
/// What a reader asks for first: parts of names.
const FIRST: [&str; 11] = [
    "peak_contact",
    "impulse",
    "peak",
    "capture",
    "grasp_time",
    "time",
    "slip",
    "travel",
    "residual",
    "rotation",
    "_s",
];
/// Values of integers drawn one by one.
const FEW: usize = 12;
/// A metric is drawn over logarithms where its largest value is this many times its median, and its smallest is above
/// zero.
const SKEWED: f64 = 12.0;

/// Metrics that vary, those that a reader asks for first before others.
pub(super) fn chosen(findings: &Findings) -> Vec<&MetricSummary> {
    let mut metrics: Vec<&MetricSummary> = findings.metrics.iter().filter(|metric| metric.varies()).collect();
    let place =
        |metric: &MetricSummary| FIRST.iter().position(|part| metric.name.contains(part)).unwrap_or(FIRST.len());
    metrics.sort_by_key(|metric| place(metric));
    metrics
}

/// The section.
pub(super) fn section(table: &Table, findings: &Findings) -> String {
    let metrics = chosen(findings);
    if metrics.is_empty() {
        return String::new();
    }
    let colours = Colours::of(findings);
    let mut text = String::from(
        "<p>Above: number of runs, coloured by outcome. Below: share of runs at or under a value; the dashed lines \
         are 50 % and 95 %.</p>\n",
    );
    text += &colours.legend();
    text += "<div class=\"panels\">\n";
    metrics.iter().take(MOST).for_each(|metric| text += &one(table, metric, &colours));
    text += "</div>\n";
    if metrics.len() > MOST {
        text += &format!("<p>{} more metrics are in the table below.</p>\n", metrics.len() - MOST);
    }
    text
}

fn one(table: &Table, metric: &MetricSummary, colours: &Colours) -> String {
    let cells = table.numbers(&metric.name).unwrap_or_default();
    let values: Vec<(f64, &'static str)> = cells
        .iter()
        .enumerate()
        .filter_map(|(row, cell)| Some(((*cell)?, colours.class(table.text("outcome", row)))))
        .collect();
    let logarithmic = metric.min > 0.0 && metric.max / metric.p50 > SKEWED;
    let edges = bin_edges(&values.iter().map(|v| v.0).collect::<Vec<_>>(), logarithmic);
    let ends = edges.first().copied().zip(edges.last().copied());
    let histogram = Panel {
        up: "runs".to_owned(),
        height: HEIGHTS.0,
        across_ends: ends,
        logarithmic,
        layers: stacks(&values, &edges, &colours.classes()),
        ..Panel::default()
    };
    let distribution = Panel {
        across: label(&metric.name),
        up: "share, %".to_owned(),
        height: HEIGHTS.1,
        across_ends: ends,
        up_ends: Some((0.0, 103.0)),
        logarithmic,
        layers: vec![
            Layer::Level("bound", 50.0),
            Layer::Level("bound", 95.0),
            Layer::Line("ink", steps(&values, ends)),
        ],
        ..Panel::default()
    };
    figure(
        &caption(table, metric),
        &(histogram.svg(&metric.name) + &distribution.svg(&format!("{}: distribution", metric.name))),
    )
}

fn caption(table: &Table, metric: &MetricSummary) -> String {
    let unit = unit(&metric.name).map_or_else(String::new, |unit| format!(" {unit}"));
    let some =
        if metric.count < table.len() { format!(" Of {} runs that have it.", metric.count) } else { String::new() };
    format!(
        "<b>{}</b> <span>median {}{unit}, 95 % below {}{unit}, largest {}{unit} (run {}).{some}</span>",
        name(&metric.name),
        short(metric.p50),
        short(metric.p95),
        short(metric.max),
        metric.max_run
    )
}

/// Ends of the bins: one to each of a few integers, else twice the cube root of the number of values (Rice's rule),
/// equally wide or equally wide as logarithms. Empty where there are no values.
pub(crate) fn bin_edges(values: &[f64], logarithmic: bool) -> Vec<f64> {
    let ends = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)));
    let (low, high) = ends;
    if low > high {
        return Vec::new();
    }
    if values.iter().all(|v| v.fract() == 0.0) && high - low < FEW as f64 {
        let count = (high - low) as usize + 1;
        return (0..=count).map(|k| low - 0.5 + k as f64).collect();
    }
    let bins = (2.0 * (values.len() as f64).cbrt()).ceil().clamp(4.0, 40.0);
    let place = |k: f64| match logarithmic {
        true => low * (high / low).powf(k / bins),
        false => low + (high - low) * k / bins,
    };
    (0..=bins as usize).map(|k| place(k as f64)).collect()
}

/// Values in each bin; the ends of the first and of the last bin belong to them.
pub(crate) fn bin_counts(values: impl Iterator<Item = f64>, edges: &[f64]) -> Vec<f64> {
    let mut counts = vec![0.0; edges.len().saturating_sub(1)];
    for value in values {
        let bin = edges.partition_point(|edge| *edge <= value).saturating_sub(1).min(counts.len().saturating_sub(1));
        counts.get_mut(bin).into_iter().for_each(|count| *count += 1.0);
    }
    counts
}

/// Boxes of every class, each on those before.
fn stacks(values: &[(f64, &'static str)], edges: &[f64], classes: &[&'static str]) -> Vec<Layer> {
    let mut below = vec![0.0; edges.len().saturating_sub(1)];
    let mut layers = Vec::new();
    for class in classes {
        let counts = bin_counts(values.iter().filter(|v| v.1 == *class).map(|v| v.0), edges);
        let boxes = counts.iter().enumerate().filter(|(_, count)| **count > 0.0);
        let boxes = boxes.map(|(bin, count)| (edges[bin], edges[bin + 1], below[bin], below[bin] + count)).collect();
        layers.push(Layer::Boxes(class, boxes));
        below.iter_mut().zip(counts).for_each(|(below, count)| *below += count);
    }
    // The axis starts at no run at all.
    layers.push(Layer::Level("zero", 0.0));
    layers
}

/// The distribution function in per cent, from end to end.
fn steps(values: &[(f64, &str)], ends: Option<(f64, f64)>) -> Vec<(f64, f64)> {
    let sorted = crate::stats::sorted(values.iter().map(|v| v.0).collect());
    let share = |k: usize| 100.0 * k as f64 / sorted.len().max(1) as f64;
    let (low, high) = ends.unwrap_or((0.0, 1.0));
    let corners = sorted.iter().enumerate().flat_map(|(k, x)| [(*x, share(k)), (*x, share(k + 1))]);
    [(low, 0.0)].into_iter().chain(corners).chain([(high, 100.0)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stacks_hold_every_value_once() {
        let values = [(0.0, "o0"), (0.1, "o1"), (0.9, "o1"), (1.0, "o0")];
        let layers = stacks(&values, &[0.0, 0.5, 1.0], &["o0", "o1"]);
        let heights: Vec<f64> = layers
            .iter()
            .flat_map(|layer| match layer {
                Layer::Boxes(_, boxes) => boxes.iter().map(|b| b.3 - b.2).collect(),
                _ => Vec::new(),
            })
            .collect();
        assert_eq!(heights, [1.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn few_integers_have_a_bin_each() {
        assert_eq!(bin_edges(&[0.0, 2.0, 1.0], false), [-0.5, 0.5, 1.5, 2.5]);
        assert_eq!(bin_counts([0.0, 2.0, 2.0].into_iter(), &[-0.5, 0.5, 1.5, 2.5]), [1.0, 0.0, 2.0]);
        let ends = bin_edges(&[0.01, 0.1, 1.0], true);
        assert!((ends[0] - 0.01).abs() < 1e-15 && (ends[4] - 1.0).abs() < 1e-12 && (ends[2] - 0.1).abs() < 1e-12);
        assert!(bin_edges(&[], false).is_empty() && bin_counts([1.0].into_iter(), &[]).is_empty());
    }

    #[test]
    fn a_distribution_function_climbs_from_none_to_all() {
        let line = steps(&[(2.0, ""), (1.0, "")], Some((0.0, 3.0)));
        assert_eq!(line, [(0.0, 0.0), (1.0, 0.0), (1.0, 50.0), (2.0, 50.0), (2.0, 100.0), (3.0, 100.0)]);
    }
}
