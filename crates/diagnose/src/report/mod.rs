//! `report.html`: one self-contained page, drawn from a [`Diagnosis`] and its [`Evidence`].
//!
//! No network, no fonts, no library: inline SVG coloured by the page's style sheet (dark or light by the reader's choice) and
//! thirty lines of script that sort tables. What there is no data for is left out.

mod curves;
mod fit;
mod forces;
mod heat;
mod ranking;
mod trust;

use crate::diagnosis::{BeforeAfter, Diagnosis, Verdict};
use crate::evidence::Evidence;
use crate::number::{noise, percent};
use crate::words::{headline, paragraph, parameter_words, place_words, share_percent, when_words};
use record::page::{SCRIPT, STYLE};
use record::plot::escape;
use std::fmt::Write;

/// Name of the file.
pub const FILE: &str = "report.html";

/// The page.
pub fn report_html(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    let title = format!("{}: {}", diagnosis.recording, headline(diagnosis.verdict));
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><meta name=\"color-scheme\" \
         content=\"light dark\">\n<title>{}</title>\n<style>\n{STYLE}</style></head>\n<body>\n",
        escape(&title)
    );
    add_head(&mut page, diagnosis, evidence);
    let sections: [(&str, &str, String); 7] = [
        ("where", "Where and when", heat::section(diagnosis, evidence)),
        ("curves", "Measured and predicted", curves::section(diagnosis, evidence)),
        ("force", "The missing force", forces::section(evidence)),
        ("hypotheses", "What else could explain it", ranking::section(diagnosis, evidence)),
        ("parameters", "Parameters and how sure they are", fit::parameters(evidence)),
        ("errors", "How well it predicts", fit::errors(diagnosis, evidence)),
        ("trust", "Can the data show this at all", trust::section(evidence)),
    ];
    add_contents(&mut page, &sections);
    for (id, title, body) in sections.iter().filter(|s| !s.2.is_empty()) {
        let _ = write!(page, "<section id=\"{id}\"><h2>{title}</h2>\n{body}</section>\n");
    }
    let version = env!("CARGO_PKG_VERSION");
    let _ = write!(
        page,
        "<footer>softdock {version}, <code>diagnose</code>. All errors are in units of the sensors' noise (one standard \
         deviation, rounding included): 1.0 is a model that leaves nothing but noise.</footer>\n<script>\n{SCRIPT}</script>\n\
         </body></html>\n"
    );
    page
}

/// The colour class of a verdict.
fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NoMismatch | Verdict::Explained => "good",
        Verdict::PartlyExplained => "fair",
        Verdict::Unknown => "bad",
    }
}

fn add_head(page: &mut String, diagnosis: &Diagnosis, evidence: &Evidence) {
    let title = if evidence.title.is_empty() { &diagnosis.recording } else { &evidence.title };
    let _ = write!(
        page,
        "<header><p class=\"over\">Diagnosis of <b>{}</b> against scenario <b>{}</b></p><h1>{}</h1>\n\
         <p class=\"verdict\"><span class=\"pill {}\">{}</span> {}</p>\n",
        escape(&diagnosis.recording),
        escape(&diagnosis.scenario),
        escape(title),
        class(diagnosis.verdict),
        headline(diagnosis.verdict),
        escape(&paragraph(diagnosis, evidence))
    );
    page.push_str("<div class=\"tiles\">\n");
    for (label, value, below) in tiles(diagnosis, evidence) {
        let value = escape(&value).replace('/', "/<wbr>").replace(':', ":<wbr>");
        let _ = writeln!(
            page,
            "<div class=\"tile\"><span>{label}</span><b>{value}</b><small>{}</small></div>",
            escape(&below)
        );
    }
    page.push_str("</div>\n");
    for remark in &diagnosis.remarks {
        let _ = writeln!(page, "<p class=\"remark\">{}</p>", escape(remark));
    }
    page.push_str("</header>\n");
}

/// What a reader wants in one glance: (label, value, what goes with it).
fn tiles(diagnosis: &Diagnosis, evidence: &Evidence) -> Vec<(&'static str, String, String)> {
    let mut tiles = Vec::new();
    for found in &diagnosis.effects {
        let at = format!("at {}: {}", place_words(&found.place), parameter_words(found));
        tiles.push(("effect", found.name.clone(), at));
    }
    if let Some(first) = diagnosis.located.first() {
        tiles.push(("where", first.place.clone(), format!("{} of the mismatch", percent(first.share))));
        tiles.push(("when", when_words(first, evidence), first.condition.clone()));
    }
    // It is of the nominal model.
    let is_shown = diagnosis.verdict == Verdict::NoMismatch && !diagnosis.is_corrected();
    if let Some(test) = evidence.detection.as_ref().filter(|_| is_shown) {
        let bound =
            format!("noise alone passes {} with {}", crate::number::short(test.bound), percent(test.false_alarm));
        tiles.push(("test for a mismatch", crate::number::short(test.value), bound));
    }
    if let Some(explained) = &diagnosis.explained_share {
        let [low, high] = explained.interval.map(share_percent);
        let whose = if explained.left_out { "not used" } else { "used" };
        let of =
            if diagnosis.error.within_tolerance.is_some() { "what corrected numbers leave" } else { "the mismatch" };
        let below = format!("of {of} on runs {whose}, 95 % interval {low} to {high} %");
        tiles.push(("explained", format!("{} %", share_percent(explained.share)), below));
    }
    let (error, judged) = (&diagnosis.error, diagnosis.judged());
    let label = if judged.left_out { "error on runs not used" } else { "error on the runs used" };
    let arrow_of = |e: BeforeAfter, text: fn(f64) -> String| match diagnosis.is_corrected() {
        true => format!("{} → {}", text(e.before), text(e.after)),
        false => text(e.before),
    };
    let arrow = |e: BeforeAfter| arrow_of(e, noise);
    let window = crate::number::short(error.window_s);
    let below = match judged.window_s {
        Some(_) => format!("× noise, in windows of {window} s: whole runs are not predictable"),
        None => format!("× noise, free run; {} in windows of {window} s", arrow(error.windowed)),
    };
    tiles.push((label, arrow(judged.error), below));
    if let Some((most, error)) = diagnosis.most_wrong().filter(|_| diagnosis.verdict != Verdict::NoMismatch) {
        let value = arrow_of(error, |x| crate::number::digits(x, 2));
        tiles.push(("most wrong channel", format!("{value} {}", most.unit), format!("rms, {}", most.channel)));
    }
    tiles
}

fn add_contents(page: &mut String, sections: &[(&str, &str, String)]) {
    page.push_str("<nav>");
    for (id, title, _) in sections.iter().filter(|s| !s.2.is_empty()) {
        let _ = write!(page, "<a href=\"#{id}\">{title}</a>");
    }
    page.push_str("</nav>\n");
}

/// A table: header cells (a leading `#` makes a column of numbers), then rows of cells that are HTML.
fn table(class: &str, header: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("<div class=\"scroll\"><table class=\"{class}\"><thead><tr>");
    let is_number: Vec<bool> = header.iter().map(|h| h.starts_with('#')).collect();
    for name in header {
        let number = if name.starts_with('#') { " class=\"n\"" } else { "" };
        let _ = write!(text, "<th{number}>{}</th>", escape(name.trim_start_matches('#')));
    }
    text.push_str("</tr></thead><tbody>\n");
    for row in rows {
        text.push_str("<tr>");
        for (i, cell) in row.iter().enumerate() {
            let number = if is_number.get(i).copied().unwrap_or(false) { " class=\"n\"" } else { "" };
            let _ = write!(text, "<td{number}>{cell}</td>");
        }
        text.push_str("</tr>\n");
    }
    text + "</tbody></table></div>\n"
}

/// A bar of a share with its figure.
fn share_bar(share: f64) -> String {
    let width = if share.is_finite() { 100.0 * share.clamp(0.0, 1.0) } else { 0.0 };
    format!(
        "<span class=\"nowrap\"><span class=\"share\"><i style=\"width:{width:.0}%\"></i></span> {}</span>",
        percent(share)
    )
}

/// A drawing with its caption above it.
fn figure(caption: &str, drawing: &str) -> String {
    format!("<figure><figcaption>{caption}</figcaption>{drawing}</figure>\n")
}

/// A legend: (class, words).
fn legend(entries: &[(&str, &str)]) -> String {
    let mut text = String::from("<p class=\"legend\">");
    for (class, words) in entries {
        let _ = write!(text, "<span><i class=\"key {class}\"></i>{words}</span>");
    }
    text + "</p>\n"
}
