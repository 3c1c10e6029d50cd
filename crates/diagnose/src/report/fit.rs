//! Parameters with intervals and correlations; errors run by run; whiteness of what is left.

use super::{figure, legend, table};
use crate::diagnosis::{BeforeAfter, Diagnosis};
use crate::evidence::{Evidence, Parameter, Whiteness};
use crate::number::{noise, short, with_error};
use record::page::{Layer, Panel};
use record::plot::{Axis, escape};
use std::fmt::Write;

/// Most channels whose whiteness is drawn.
const MOST: usize = 12;

/// Parameters, their intervals and correlations.
pub(super) fn parameters(evidence: &Evidence) -> String {
    if evidence.parameters.is_empty() {
        return String::new();
    }
    let header = [
        "effect",
        "place",
        "parameter",
        "#value ± standard error",
        "unit",
        "#95 % interval",
        "#nominal",
        "interval from",
    ];
    let rows: Vec<Vec<String>> = evidence.parameters.iter().map(row).collect();
    let mut text = table("", &header, &rows);
    text += "<p>A profile fits all else anew at each value of the parameter; it is used where slip or impact make the curvature of the \
             likelihood too sure. A value without an error was held, or the data do not show it.</p>\n";
    text + &correlation(evidence)
}

fn row(p: &Parameter) -> Vec<String> {
    let (low, high) = p.interval;
    let interval = if low.is_finite() && high.is_finite() {
        format!("{} … {}", digits_like(low, high - low), digits_like(high, high - low))
    } else {
        "–".to_owned()
    };
    vec![
        escape(&p.effect),
        escape(&p.place),
        format!("<b>{}</b>", escape(&p.name)),
        with_error(p.value, p.std_err),
        escape(&p.unit),
        interval,
        short(p.nominal),
        if p.from_profile { "profile" } else { "curvature" }.to_owned(),
    ]
}

/// A number to a hundredth of a width.
fn digits_like(x: f64, width: f64) -> String {
    let needed = if width > 0.0 && x != 0.0 { (x.abs() / width).log10().ceil() as i32 + 2 } else { 4 };
    crate::number::digits(x, needed.clamp(2, 12))
}

/// The matrix as a table of coloured cells.
fn correlation(evidence: &Evidence) -> String {
    let count = evidence.parameters.len();
    if evidence.correlation.len() != count || count < 2 {
        return String::new();
    }
    let mut text = String::from(
        "<h3>Correlation</h3><p>Near ± 1 the data show only a combination of the two parameters.</p>\n\
         <div class=\"scroll\"><table class=\"matrix\"><tr><th></th>",
    );
    for k in 1..=count {
        let _ = write!(text, "<th>{k}</th>");
    }
    text.push_str("</tr>\n");
    for (i, (parameter, row)) in evidence.parameters.iter().zip(&evidence.correlation).enumerate() {
        let _ = write!(
            text,
            "<tr><th>{} <span>{} {}</span></th>",
            i + 1,
            escape(&parameter.effect),
            escape(&parameter.name)
        );
        for value in row.iter().take(count) {
            let strength = if value.is_finite() { (85.0 * value.abs()).min(85.0) } else { 0.0 };
            let colour = if *value >= 0.0 { "corrected" } else { "nominal" };
            let style = format!("background:color-mix(in srgb, var(--{colour}) {strength:.0}%, transparent)");
            let _ = write!(
                text,
                "<td style=\"{style}\">{}</td>",
                crate::number::digits((value * 100.0).round() / 100.0, 3)
            );
        }
        text.push_str("</tr>\n");
    }
    text + "</table></div>\n"
}

/// Errors run by run, and what is left.
pub(super) fn errors(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    let corrected = diagnosis.is_corrected();
    let window = short(diagnosis.error.window_s);
    let mut text = format!(
        "<p>RMS of prediction minus measurement in units of noise, over all noisy channels that the model predicts. Free run: one \
         initial state, estimated on the run, nothing else; windows: the state estimated anew every {window} s. Runs marked <em>holdout</em> \
         were not used to find or fit anything.</p>\n"
    );
    text += &dumbbells(diagnosis, corrected);
    let header = ["run", "role", "#free run before", "#after", "#windows before", "#after"];
    text += &table("", &header, &error_rows(diagnosis));
    text + &whiteness(evidence)
}

fn error_rows(diagnosis: &Diagnosis) -> Vec<Vec<String>> {
    let error = &diagnosis.error;
    let after = |x: f64| format!("<b>{}</b>", noise(x));
    let mut rows: Vec<Vec<String>> = Vec::new();
    for r in &error.runs {
        let role = format!("<em>{}</em>", r.role.word());
        rows.push(vec![
            escape(&r.file),
            role,
            noise(r.before),
            after(r.after),
            noise(r.windowed_before),
            after(r.windowed_after),
        ]);
    }
    let pooled = |role: &str, free: BeforeAfter, windows: Option<BeforeAfter>| {
        let windows = windows.map_or([String::new(), String::new()], |w| [noise(w.before), after(w.after)]);
        let [before, after_windows] = windows;
        vec!["all".to_owned(), format!("<em>{role}</em>"), noise(free.before), after(free.after), before, after_windows]
    };
    let on_fit = error.holdout.is_none().then_some(error.windowed);
    rows.push(pooled("fit", error.fit, on_fit));
    rows.extend(error.holdout.map(|holdout| pooled("holdout", holdout, Some(error.windowed))));
    rows
}

/// Before and after of every run on one logarithmic axis.
fn dumbbells(diagnosis: &Diagnosis, corrected: bool) -> String {
    let runs = &diagnosis.error.runs;
    if runs.is_empty() {
        return String::new();
    }
    let all = runs.iter().flat_map(|r| [r.before, r.after]).filter(|v| *v > 0.0);
    let axis = Axis::new(all.chain([0.8, 2.0]), true, (0.0, 100.0));
    let mut text = String::from("<div class=\"bells\">\n");
    for r in runs {
        let place = |v: f64| if axis.shows(v) { axis.at(v) } else { 100.0 };
        let (before, after) = (place(r.before), place(r.after));
        let (low, high) = (before.min(after), before.max(after));
        let _ = write!(
            text,
            "<div class=\"row\"><span>{} <em>{}</em></span><div class=\"bell\"><u style=\"left:{:.1}%\"></u>",
            escape(&r.file),
            r.role.word(),
            axis.at(1.0)
        );
        if corrected {
            let _ = write!(text, "<s style=\"left:{low:.1}%;width:{:.1}%\"></s>", high - low);
        }
        let _ = write!(text, "<i class=\"nominal\" style=\"left:{before:.1}%\"></i>");
        if corrected {
            let _ = write!(text, "<i class=\"corrected\" style=\"left:{after:.1}%\"></i>");
        }
        text.push_str("</div></div>\n");
    }
    text.push_str("<div class=\"row\"><span></span><div class=\"ticks\">");
    for (tick, label) in axis.ticks() {
        let _ = write!(text, "<span style=\"left:{:.1}%\">{label}</span>", axis.at(tick));
    }
    text.push_str("<b>× noise</b></div></div></div>\n");
    let mut entries = vec![("nominal", "nominal model, free run")];
    if corrected {
        entries.push(("corrected", "corrected model"));
    }
    entries.push(("one", "1.0: noise alone"));
    legend(&entries) + &text
}

fn whiteness(evidence: &Evidence) -> String {
    if evidence.whiteness.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "<h3>Is what is left white?</h3><p>Autocorrelation of the residual by lag. Where nothing is left to explain, 95 % of the bars stay \
         within the band.</p>\n",
    );
    text +=
        &legend(&[("nominal", "nominal model"), ("corrected", "corrected model"), ("noise", "95 % of white noise")]);
    text += "<div class=\"panels\">\n";
    evidence.whiteness.iter().take(MOST).for_each(|w| text += &bars(w));
    text + "</div>\n"
}

fn bars(w: &Whiteness) -> String {
    let step = match (w.lags_s.first(), w.lags_s.last()) {
        (Some(first), Some(last)) if w.lags_s.len() > 1 => (last - first) / (w.lags_s.len() - 1) as f64,
        _ => 1.0,
    };
    let shifted = |by: f64, values: &[f64]| w.lags_s.iter().zip(values).map(|(t, v)| (t + by * step, *v)).collect();
    let ends = (w.lags_s.first().map_or(0.0, |t| t - step), w.lags_s.last().map_or(1.0, |t| t + step));
    let layers = vec![
        Layer::Band("noise", vec![(ends.0, -w.bound, w.bound), (ends.1, -w.bound, w.bound)]),
        Layer::Bars("nominal", 0.36 * step, shifted(-0.2, &w.before)),
        Layer::Bars("corrected", 0.36 * step, shifted(0.2, &w.after)),
        Layer::Level("zero", 0.0),
    ];
    let low = w.before.iter().chain(&w.after).copied().fold(-0.2, f64::min);
    let panel = Panel {
        across: "lag, s".to_owned(),
        up: "autocorrelation".to_owned(),
        height: 110.0,
        across_ends: Some(ends),
        up_ends: Some((low * 1.1, 1.0)),
        layers,
        ..Panel::default()
    };
    figure(&format!("<b>{}</b>", escape(&w.channel)), &panel.svg("autocorrelation of the residual"))
}
