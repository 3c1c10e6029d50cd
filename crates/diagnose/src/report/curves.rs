//! Measured, nominal and corrected curves, and what is left of them in units of noise.

use super::{figure, legend};
use crate::diagnosis::Diagnosis;
use crate::evidence::{Curve, Evidence};
use crate::number::short;
use record::page::{Layer, Panel};
use record::plot::escape;

/// Most channels drawn: the page stays below a few megabytes.
const MOST: usize = 36;
/// Height of the curves and of the residual, px.
const HEIGHTS: (f64, f64) = (170.0, 90.0);
/// The noise band, in standard deviations: 95 % of the samples.
const BAND: f64 = 2.0;
/// How far beyond the measured span a diverging prediction is followed, as a part of the span.
const BEYOND: f64 = 0.6;

/// The section.
pub(super) fn section(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    if evidence.curves.is_empty() {
        return String::new();
    }
    let corrected = diagnosis.is_corrected();
    let mut text = String::from(
        "<p>Above: the channel as it was measured and as the models predict it from an initial state estimated on the run. \
         A prediction that leaves the picture has diverged. Below: prediction minus measurement in units of the sensor's noise, \
         on an axis that is linear near zero and logarithmic beyond; within the band lie 95 % of the samples of a model that is right.</p>\n",
    );
    let mut entries = vec![("measured", "measured"), ("nominal", "nominal model")];
    if corrected {
        entries.push(("corrected", "corrected model"));
    }
    entries.push(("noise", "± 2 σ of the sensor"));
    if evidence.curves.iter().any(|curve| span(diagnosis, curve).is_some()) {
        entries.push(("located", "when the mismatch was located"));
    }
    text += &legend(&entries);
    text += "<div class=\"panels\">\n";
    for curve in evidence.curves.iter().take(MOST) {
        text += &one(curve, span(diagnosis, curve));
    }
    text += "</div>\n";
    if evidence.curves.len() > MOST {
        text += &format!("<p>{} more channels are not drawn.</p>\n", evidence.curves.len() - MOST);
    }
    text
}

/// The first located stretch, where it is not the whole of the run.
fn span(diagnosis: &Diagnosis, curve: &Curve) -> Option<(f64, f64)> {
    let (start, end) = (*curve.t.first()?, *curve.t.last()?);
    let located = diagnosis.located.first()?;
    let (from, to) = (located.from_s.max(start), located.to_s.min(end));
    (to > from && (to - from) < 0.9 * (end - start)).then_some((from, to))
}

fn one(curve: &Curve, span: Option<(f64, f64)>) -> String {
    let how = match curve.window_s {
        Some(window) => format!("restarted every {} s", short(window)),
        None => "free run".to_owned(),
    };
    let caption =
        format!("<b>{}</b> <span>{}, {}, {how}</span>", escape(&curve.channel), escape(&curve.run), curve.role.word());
    let name = format!("{}: measured and predicted", curve.channel);
    figure(&caption, &(values(curve, span).svg(&name) + &residuals(curve, span).svg("residual in units of noise")))
}

fn ends(curve: &Curve) -> Option<(f64, f64)> {
    Some((*curve.t.first()?, *curve.t.last()?))
}

fn pairs(t: &[f64], values: &[f64]) -> Vec<(f64, f64)> {
    t.iter().copied().zip(values.iter().copied()).collect()
}

fn values(curve: &Curve, span: Option<(f64, f64)>) -> Panel {
    let best = if curve.corrected.is_empty() { &curve.nominal } else { &curve.corrected };
    let half = BAND * curve.sigma;
    let band = curve.t.iter().zip(best).map(|(t, v)| (*t, v - half, v + half)).collect();
    let mut layers: Vec<Layer> = span.map(|(from, to)| Layer::Span("located", from, to)).into_iter().collect();
    layers.push(Layer::Band("noise", band));
    layers.push(Layer::Line("measured", pairs(&curve.t, &curve.measured)));
    layers.push(Layer::Line("nominal", pairs(&curve.t, &curve.nominal)));
    layers.push(Layer::Line("corrected", pairs(&curve.t, &curve.corrected)));
    let up = if curve.unit.is_empty() { String::new() } else { curve.unit.clone() };
    Panel { up, height: HEIGHTS.0, across_ends: ends(curve), up_ends: shown_span(curve), layers, ..Panel::default() }
}

/// Measured and corrected values whole, the nominal ones as far as they do not dwarf them.
fn shown_span(curve: &Curve) -> Option<(f64, f64)> {
    let span = |values: &[f64]| {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let ends = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        (ends.0 <= ends.1).then_some(ends)
    };
    let measured = span(&curve.measured)?;
    let corrected = span(&curve.corrected).unwrap_or(measured);
    let (low, high) = (measured.0.min(corrected.0), measured.1.max(corrected.1));
    let room = (high - low).max(6.0 * curve.sigma);
    let nominal = span(&curve.nominal).unwrap_or(measured);
    let low = nominal.0.max(low - BEYOND * room).min(low);
    let high = nominal.1.min(high + BEYOND * room).max(high);
    let margin = 0.05 * (high - low) + 2.0 * curve.sigma;
    Some((low - margin, high + margin))
}

fn residuals(curve: &Curve, span: Option<(f64, f64)>) -> Panel {
    let of = |model: &[f64]| -> Vec<(f64, f64)> {
        let residual = |((t, m), p): ((&f64, &f64), &f64)| (*t, (p - m) / curve.sigma);
        curve.t.iter().zip(&curve.measured).zip(model).map(residual).filter(|p| p.1.is_finite()).collect()
    };
    let (nominal, corrected) = (of(&curve.nominal), of(&curve.corrected));
    let largest = nominal.iter().chain(&corrected).map(|p| p.1.abs()).fold(6.0, f64::max);
    let mut layers: Vec<Layer> = span.map(|(from, to)| Layer::Span("located", from, to)).into_iter().collect();
    layers.push(Layer::Line("nominal", nominal));
    layers.push(Layer::Line("corrected", corrected));
    layers.extend([Layer::Level("bound", BAND), Layer::Level("bound", -BAND)]);
    if let Some((start, end)) = ends(curve) {
        layers.insert(0, Layer::Band("noise", vec![(start, -BAND, BAND), (end, -BAND, BAND)]));
    }
    Panel {
        across: "time, s".to_owned(),
        up: "residual, σ".to_owned(),
        height: HEIGHTS.1,
        across_ends: ends(curve),
        up_ends: Some((-1.4 * largest, 1.4 * largest)),
        squashed: true,
        layers,
        ..Panel::default()
    }
}
