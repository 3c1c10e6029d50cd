//! The strongest metrics pair by pair: A against B, and the differences.

use super::metrics::values;
use super::{Comparison, Pair, PairedMetric, who_succeeds};
use crate::report::distributions::{bin_counts, bin_edges};
use crate::table::Table;
use record::page::number::percent;
use record::page::unit::label;
use record::page::{Layer, Panel, figure, legend, name};

/// Most metrics drawn, and most points of a drawing; more points are left out evenly.
const MOST: (usize, usize) = (6, 2000);
/// Heights of scatter and histogram, px.
const HEIGHTS: (f64, f64) = (240.0, 110.0);
/// Pairs by who succeeds: both, only A, only B, neither.
const CLASSES: [&str; 4] = ["o0", "o1", "o2", "o5"];

/// Scatters of A and B with histograms of their differences.
pub(super) fn section(comparison: &Comparison, a: &Table, b: &Table, pairs: &[Pair]) -> String {
    let mut metrics: Vec<&PairedMetric> =
        comparison.metrics.iter().filter(|m| m.std_difference.is_some_and(|std| std > 0.0)).collect();
    let size = |metric: &PairedMetric| (metric.is_clear, metric.standardised.map_or(0.0, f64::abs));
    metrics.sort_by(|x, y| {
        let (x, y) = (size(x), size(y));
        y.0.cmp(&x.0).then(y.1.total_cmp(&x.1))
    });
    if metrics.is_empty() {
        return String::new();
    }
    let who = who_succeeds(a, b, pairs);
    let mut text = String::from(
        "<p>Above: every dot is a run, with A across and B up; on the dashed line both are equal. Below: the \
         differences B − A, the dashed line at \
         nought.</p>\n",
    );
    if who.is_some() {
        text +=
            &legend(&[("o0", "both succeed"), ("o1", "only A succeeds"), ("o2", "only B succeeds"), ("o5", "neither")]);
    }
    text += "<div class=\"panels\">\n";
    for metric in metrics.iter().take(MOST.0) {
        text += &drawing(metric, &values(a, b, &metric.name, pairs), who.as_deref());
    }
    text += "</div>\n";
    if metrics.len() > MOST.0 {
        text += &format!("<p>{} more metrics are in the table above.</p>\n", metrics.len() - MOST.0);
    }
    text
}

fn class(who: Option<&[(bool, bool)]>, pair: usize) -> &'static str {
    match who.and_then(|who| who.get(pair)) {
        None | Some((true, true)) => CLASSES[0],
        Some((true, false)) => CLASSES[1],
        Some((false, true)) => CLASSES[2],
        Some((false, false)) => CLASSES[3],
    }
}

fn drawing(metric: &PairedMetric, values: &[(usize, f64, f64)], who: Option<&[(bool, bool)]>) -> String {
    let finite = values.iter().flat_map(|v| [v.1, v.2]);
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let room = 0.03 * (high - low);
    let ends = (low - room, high + room);
    let every = values.len().div_ceil(MOST.1).max(1);
    let mut layers = vec![Layer::Line("bound", vec![(ends.0, ends.0), (ends.1, ends.1)])];
    for wanted in [CLASSES[3], CLASSES[0], CLASSES[1], CLASSES[2]] {
        let dots = values.iter().step_by(every).filter(|v| class(who, v.0) == wanted).map(|v| (v.1, v.2)).collect();
        layers.push(Layer::Dots(wanted, dots));
    }
    let scatter = Panel {
        across: format!("A: {}", label(&metric.name)),
        up: format!("B: {}", label(&metric.name)),
        height: HEIGHTS.0,
        across_ends: Some(ends),
        up_ends: Some(ends),
        layers,
        ..Panel::default()
    };
    let caption = format!(
        "<b>{}</b> <span>B larger in {}, smaller in {} of {} runs</span>",
        name(&metric.name),
        percent(metric.share_b_larger),
        percent(metric.share_b_smaller),
        metric.pairs
    );
    let differences: Vec<f64> = values.iter().map(|v| v.2 - v.1).collect();
    figure(&caption, &(scatter.svg(&format!("{} of A and B", metric.name)) + &histogram(metric, &differences)))
}

fn histogram(metric: &PairedMetric, differences: &[f64]) -> String {
    let edges = bin_edges(differences, false);
    let counts = bin_counts(differences.iter().copied(), &edges);
    let bins = counts.iter().zip(edges.windows(2)).filter(|(count, _)| **count > 0.0);
    let boxes = bins.map(|(count, ends)| (ends[0], ends[1], 0.0, *count));
    let panel = Panel {
        across: format!("B − A: {}", label(&metric.name)),
        up: "runs".to_owned(),
        height: HEIGHTS.1,
        layers: vec![
            Layer::Boxes("o5", boxes.collect()),
            Layer::Upright("bound", 0.0),
            Layer::Upright("ink thin", metric.mean_difference),
        ],
        ..Panel::default()
    };
    panel.svg(&format!("{}: differences", metric.name))
}
