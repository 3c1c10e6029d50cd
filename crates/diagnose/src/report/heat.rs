//! Where and when: the places that were located, and strips of mismatch by channel and time.

use super::{legend, share_bar, table};
use crate::diagnosis::{Diagnosis, Role};
use crate::evidence::{Evidence, Heat, HeatRow};
use crate::number::short;
use crate::words::when_words;
use record::plot::{Axis, escape};
use std::fmt::Write;

/// Most bins of a strip; more are joined.
const BINS: usize = 150;
/// Runs that are shown without a click: of each role.
const OPEN: usize = 1;
/// Upper ends of the colour classes: mean square in units of noise.
const LEVELS: [f64; 7] = [1.5, 3.0, 10.0, 30.0, 100.0, 1e3, 1e4];

/// The section.
pub(super) fn section(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    let mut text = located(diagnosis, evidence);
    if evidence.heat.is_empty() {
        return text;
    }
    text += "<p>Each strip is one channel over time. Its colour is the mean square of prediction minus measurement in units of the \
             sensor's noise: faint is noise alone, each stronger step is a larger mismatch; hatched is not measured.";
    if evidence.heat.iter().flat_map(|h| &h.rows).any(|row| !row.corrected.is_empty()) {
        text += " The upper strip is the scenario as it was, the lower one the corrected model; where the correction is right, the \
                 lower strip is faint throughout.";
    }
    text += "</p>\n";
    text += &key();
    let mut seen = [0_usize; 2];
    for heat in &evidence.heat {
        let role = usize::from(heat.role == Role::Holdout);
        seen[role] += 1;
        add_run(&mut text, heat, seen[role] <= OPEN);
    }
    text
}

fn located(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    if diagnosis.located.is_empty() {
        return String::new();
    }
    let row = |l: &crate::diagnosis::Located| {
        vec![format!("<b>{}</b>", escape(&l.place)), share_bar(l.share), when_words(l, evidence), escape(&l.condition)]
    };
    let rows: Vec<Vec<String>> = diagnosis.located.iter().map(row).collect();
    "<p>The share is the part of the mismatch beyond the noise that a missing force (or a wrong reading) at this place alone \
     explains; places can explain the same part, so shares may add up to more than 100 %.</p>\n"
        .to_owned()
        + &table("", &["place", "share of the mismatch", "when", "condition"], &rows)
}

fn key() -> String {
    let words = ["noise", "1.5–3", "3–10", "10–30", "30–100", "100–10³", "10³–10⁴", "> 10⁴ × noise²"];
    let classes = ["h0", "h1", "h2", "h3", "h4", "h5", "h6", "h7"];
    let entries: Vec<(&str, &str)> = classes.into_iter().zip(words).collect();
    legend(&entries)
}

fn add_run(text: &mut String, heat: &Heat, is_open: bool) {
    let (Some(start), Some(end)) = (heat.edges_s.first(), heat.edges_s.last()) else { return };
    let how = match heat.window_s {
        Some(window) => format!("state estimated anew every {} s", short(window)),
        None => "one free run".to_owned(),
    };
    let _ = writeln!(
        text,
        "<details class=\"heat\"{}><summary>{} <em>{}</em> <span>{how}</span></summary>",
        if is_open { " open" } else { "" },
        escape(&heat.run),
        heat.role.word()
    );
    for row in &heat.rows {
        add_row(text, row, &heat.edges_s);
    }
    text.push_str("<div class=\"row\"><span></span><div class=\"ticks\">");
    for (tick, label) in Axis::between(*start, *end, (0.0, 100.0)).ticks() {
        let at = 100.0 * (tick - start) / (end - start);
        let _ = write!(text, "<span style=\"left:{at:.1}%\">{label}</span>");
    }
    text.push_str("<b>s</b></div></div></details>\n");
}

fn add_row(text: &mut String, row: &HeatRow, edges: &[f64]) {
    let channel = escape(&row.channel);
    let _ = write!(text, "<div class=\"row\"><span>{channel}</span><div>{}", strip(&row.nominal, edges));
    if !row.corrected.is_empty() {
        text.push_str(&strip(&row.corrected, edges));
    }
    text.push_str("</div></div>\n");
}

/// One strip: a path per colour class, equal neighbours joined.
fn strip(values: &[f64], edges: &[f64]) -> String {
    let cells = joined(values, edges);
    let (Some(start), Some(end)) = (edges.first(), edges.last()) else { return String::new() };
    let at = |t: f64| 1000.0 * (t - start) / (end - start);
    let mut paths = vec![String::new(); LEVELS.len() + 1];
    let mut i = 0;
    while i < cells.len() {
        let level = class(cells[i].2);
        let mut last = i;
        while last + 1 < cells.len() && class(cells[last + 1].2) == level {
            last += 1;
        }
        if let Some(level) = level {
            let (from, to) = (at(cells[i].0), at(cells[last].1));
            let _ = write!(paths[level], "M{from:.0} 0H{to:.0}V1H{from:.0}z");
        }
        i = last + 1;
    }
    let mut svg = String::from("<svg class=\"strip\" viewBox=\"0 0 1000 1\" preserveAspectRatio=\"none\">");
    for (level, path) in paths.iter().enumerate().filter(|(_, p)| !p.is_empty()) {
        let _ = write!(svg, "<path class=\"h{level}\" d=\"{path}\"/>");
    }
    svg + "</svg>"
}

/// Bins (from, to, mean square), at most [`BINS`] of them; a joined bin has the largest of its parts, so that a short event stays.
fn joined(values: &[f64], edges: &[f64]) -> Vec<(f64, f64, f64)> {
    let count = values.len().min(edges.len().saturating_sub(1));
    let every = count.div_ceil(BINS).max(1);
    let bin = |first: usize| {
        let last = (first + every).min(count);
        let largest = values[first..last].iter().copied().filter(|v| v.is_finite()).fold(f64::NAN, f64::max);
        (edges[first], edges[last], largest)
    };
    (0..count).step_by(every).map(bin).collect()
}

/// The colour class; `None` where there is no sample.
fn class(mean_square: f64) -> Option<usize> {
    (!mean_square.is_nan()).then(|| LEVELS.iter().take_while(|level| mean_square >= **level).count())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_event_stays_visible_in_a_long_strip() {
        let edges: Vec<f64> = (0..=3000).map(f64::from).collect();
        let mut values = vec![1.0; 3000];
        values[1234] = 5e5;
        values[2000..2100].fill(f64::NAN);
        let svg = strip(&values, &edges);
        assert!(svg.contains("class=\"h7\"") && svg.len() < 500, "{svg}");
        assert_eq!(joined(&values, &edges).len(), 150);
        assert_eq!((class(f64::NAN), class(1.0), class(2.0), class(1e9)), (None, Some(0), Some(1), Some(7)));
    }
}
