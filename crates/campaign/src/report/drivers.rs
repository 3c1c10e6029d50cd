//! Which inputs drive success: first-order indices with their noise level, and success along the strongest inputs.

use crate::findings::{Driver, Findings};
use record::page::number::{digits, p_value, percent, rate};
use record::page::unit::label;
use record::page::{Axis, Layer, Panel, bar_row, figure, legend, name, ticks_row};

/// Most inputs as bars, and along which success is drawn.
const MOST: (usize, usize) = (12, 4);
const HEIGHT: f64 = 150.0;

/// The section's title: it ranks by success where that varies.
pub(super) fn title(findings: &Findings) -> &'static str {
    if is_of_success(findings) { "What drives success" } else { "What drives the load" }
}

fn is_of_success(findings: &Findings) -> bool {
    let ranked_by = findings.sensitivity.ranked_by.as_deref();
    findings.success.as_ref().is_some_and(|success| ranked_by == Some(success.flag.as_str()))
}

/// The section.
pub(super) fn section(findings: &Findings) -> String {
    let (ranking, Some(output)) = (&findings.sensitivity.ranking, &findings.sensitivity.ranked_by) else {
        return String::new();
    };
    if ranking.is_empty() {
        return String::new();
    }
    let mut text = format!(
        "<p>Share of the variance of <b>{}</b> that each input explains alone (first-order Sobol’ index). The dashed \
         mark is what \
         chance stays below in 95 % of campaigns of this size with as many inputs: a bar that ends before it means \
         nothing. ρ is Spearman’s rank \
         correlation.</p>\n",
        name(output)
    );
    text += &bars(ranking);
    if is_of_success(findings) {
        text += &curves(ranking);
    }
    text
}

fn bars(ranking: &[Driver]) -> String {
    let shown = &ranking[..ranking.len().min(MOST.0)];
    if shown.iter().all(|driver| driver.first_order.is_none()) {
        return "<p>Too few runs for indices: at least ten are needed.</p>\n".to_owned();
    }
    let largest = shown.iter().flat_map(|d| [d.first_order, d.noise]).flatten().fold(0.01, f64::max);
    let axis = Axis::between(0.0, (1.08 * largest).min(1.0) * 100.0, (0.0, 100.0));
    let mut text = String::new();
    for driver in shown {
        let class = if driver.is_clear { "o0" } else { "o5" };
        let place = |share: f64| axis.at(100.0 * share.max(0.0)) / 100.0;
        let share = driver.first_order.map_or(0.0, place);
        text += &bar_row(&name(&driver.input), class, share, driver.noise.map(place), &words(driver));
    }
    text += &ticks_row(&axis.ticks().into_iter().map(|(v, l)| (axis.at(v), l)).collect::<Vec<_>>(), "% of variance");
    if ranking.len() > MOST.0 {
        text += &format!("<p>{} weaker inputs are not drawn.</p>\n", ranking.len() - MOST.0);
    }
    legend(&[("o0", "clear influence"), ("o5", "not told from chance"), ("bound", "noise level")]) + &text
}

fn words(driver: &Driver) -> String {
    let share = driver.first_order.map_or_else(|| "–".to_owned(), |share| percent(share.clamp(0.0, 1.0)));
    let rho = driver.spearman.map_or_else(|| "–".to_owned(), |rho| digits((100.0 * rho).round() / 100.0, 2));
    let p = driver.p.map_or_else(String::new, p_value);
    let p = if p.starts_with('<') { format!("p {}", p.replace('<', "&lt;")) } else { format!("p = {p}") };
    format!("{share}<br>ρ {rho}, {p}")
}

/// Success along the strongest inputs.
fn curves(ranking: &[Driver]) -> String {
    let clear = ranking.iter().filter(|driver| driver.is_clear).count().clamp(2, MOST.1);
    let shown: Vec<&Driver> = ranking.iter().filter(|driver| driver.by_fifth.len() > 1).take(clear).collect();
    if shown.is_empty() {
        return String::new();
    }
    let all = || shown.iter().flat_map(|driver| &driver.by_fifth);
    let lowest = all().map(|fifth| 100.0 * fifth.rate.interval.low).fold(100.0, f64::min);
    let ends = ((lowest - 4.0).max(-2.0), 102.0);
    let mut text = String::from(
        "<h3>Success along the strongest inputs</h3><p>Runs in five equal parts by the input’s value; each part’s \
         rate of success with its 95 % \
         interval, over its range of values.</p>\n<div class=\"panels\">\n",
    );
    shown.iter().for_each(|driver| text += &curve(driver, ends));
    text + "</div>\n"
}

fn curve(driver: &Driver, up_ends: (f64, f64)) -> String {
    let fifths = &driver.by_fifth;
    let middle = |k: usize| 0.5 * (fifths[k].low + fifths[k].high);
    let points = (0..fifths.len()).map(|k| (middle(k), fifths[k].rate));
    let class = if driver.is_clear { "o0" } else { "o5" };
    let layers = vec![
        Layer::Boxes(
            "noise",
            fifths.iter().map(|f| (f.low, f.high, 100.0 * f.rate.interval.low, 100.0 * f.rate.interval.high)).collect(),
        ),
        Layer::Line(class, points.clone().map(|(x, rate)| (x, 100.0 * rate.value)).collect()),
        Layer::Intervals(
            class,
            points.map(|(x, r)| (x, 100.0 * r.value, 100.0 * r.interval.low, 100.0 * r.interval.high)).collect(),
        ),
    ];
    let panel = Panel {
        across: label(&driver.input),
        up: "success, %".to_owned(),
        height: HEIGHT,
        up_ends: Some(up_ends),
        layers,
        ..Panel::default()
    };
    let (first, last) = (&fifths[0], &fifths[fifths.len() - 1]);
    let caption = format!(
        "<b>{}</b> <span>{} in the lowest part, {} in the highest</span>",
        name(&driver.input),
        rate(first.rate.value),
        rate(last.rate.value)
    );
    figure(&caption, &panel.svg(&format!("success along {}", driver.input)))
}
