//! A self-contained HTML page: no network, no fonts, no library. Inline SVG coloured by the page's style sheet (dark or
//! light by the reader's choice), and thirty lines of script that sort tables.
//!
//! Functions that take cells or captions take HTML; what comes from a file goes through [`escape`] or [`name`] first.

mod layer;
pub mod number;
mod panel;
pub mod unit;

pub use crate::plot::{Axis, equalise, escape};
pub use layer::Layer;
pub use panel::Panel;

use std::fmt::Write;

/// The style sheet.
pub const STYLE: &str = include_str!("style.css");
/// The script that sorts tables.
pub const SCRIPT: &str = include_str!("sort.js");

/// A part of a page.
#[derive(Clone, Debug)]
pub struct Section {
    /// Anchor.
    pub id: &'static str,
    /// Title, HTML.
    pub title: &'static str,
    /// Body, HTML; a section without is left out.
    pub body: String,
}

/// The page: its title as text, its head, and its sections with a table of contents.
pub fn page_html(title: &str, head: &str, sections: &[Section], footer: &str) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><meta name=\"color-scheme\" \
         content=\"light \
         dark\">\n<title>{}</title>\n<style>\n{STYLE}</style></head>\n<body>\n<header>{head}</header>\n<nav>",
        escape(title)
    );
    let shown = || sections.iter().filter(|section| !section.body.is_empty());
    shown().for_each(|section| page += &format!("<a href=\"#{}\">{}</a>", section.id, section.title));
    page.push_str("</nav>\n");
    for Section { id, title, body } in shown() {
        let _ = write!(page, "<section id=\"{id}\"><h2>{title}</h2>\n{body}</section>\n");
    }
    let _ = write!(page, "<footer>{footer}</footer>\n<script>\n{SCRIPT}</script>\n</body></html>\n");
    page
}

/// A name from a file as HTML that a phone may break after each of its parts; numbers stay whole.
pub fn name(name: &str) -> String {
    broken(name, |sign, next| matches!(sign, '_' | '/' | ':') || (sign == '.' && next.is_some_and(char::is_alphabetic)))
}

/// A sentence with names in it as HTML: names may break, a number stays with its per cent sign.
pub fn sentence(text: &str) -> String {
    broken(text, |sign, _| sign == '_').replace(" %", "\u{a0}%")
}

fn broken(text: &str, is_end: impl Fn(char, Option<char>) -> bool) -> String {
    let mut signs = text.chars().peekable();
    let mut html = String::new();
    while let Some(sign) = signs.next() {
        html += &escape(sign.encode_utf8(&mut [0; 4]));
        if is_end(sign, signs.peek().copied()) {
            html += "<wbr>";
        }
    }
    html
}

/// A file name or address as the value of an attribute.
pub fn attribute(text: &str) -> String {
    escape(text).replace('"', "&quot;")
}

/// What a reader wants in one glance: (label, value, what goes with it), all text.
pub fn tiles(tiles: &[(String, String, String)]) -> String {
    let mut text = String::from("<div class=\"tiles\">\n");
    for (label, value, below) in tiles {
        let (label, value, below) = (name(label), name(value), sentence(below));
        let _ = writeln!(text, "<div class=\"tile\"><span>{label}</span><b>{value}</b><small>{below}</small></div>");
    }
    text + "</div>\n"
}

/// A table: header cells as text (a leading `#` makes a column of numbers), then rows of cells that are HTML.
pub fn table(class: &str, header: &[String], rows: &[Vec<String>]) -> String {
    let mut text = format!("<div class=\"scroll\"><table class=\"{class}\"><thead><tr>");
    let is_number: Vec<bool> = header.iter().map(|h| h.starts_with('#')).collect();
    for head in header {
        let number = if head.starts_with('#') { " class=\"n\"" } else { "" };
        let _ = write!(text, "<th{number}>{}</th>", name(head.trim_start_matches('#')));
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

/// Header cells of a [`table`].
pub fn header<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

/// A drawing with its caption above it.
pub fn figure(caption: &str, drawing: &str) -> String {
    format!("<figure><figcaption>{caption}</figcaption>{drawing}</figure>\n")
}

/// A legend: (class, words as HTML).
pub fn legend(entries: &[(&str, &str)]) -> String {
    let mut text = String::from("<p class=\"legend\">");
    for (class, words) in entries {
        let _ = write!(text, "<span><i class=\"key {class}\"></i>{words}</span>");
    }
    text + "</p>\n"
}

/// A row of a bar chart: its name (HTML), a bar of a share with its colour, a mark at another share, and words after
/// it.
pub fn bar_row(head: &str, class: &str, share: f64, mark: Option<f64>, after: &str) -> String {
    let width = |share: f64| if share.is_finite() { 100.0 * share.clamp(0.0, 1.0) } else { 0.0 };
    let mark = mark.map_or_else(String::new, |mark| format!("<u style=\"left:{:.2}%\"></u>", width(mark)));
    format!(
        "<div class=\"row chart\"><span>{head}</span><div class=\"bar\"><div class=\"fill\"><i class=\"{class}\" \
         style=\"width:{:.2}%\"></i>{mark}\
         </div><b>{after}</b></div></div>\n",
        width(share)
    )
}

/// A row of an interval chart on an axis from 0 to 100: its name (HTML), marks with intervals (class, low, value,
/// high), words.
pub fn interval_row(head: &str, marks: &[(&str, f64, f64, f64)], zero: Option<f64>, after: &str) -> String {
    let place = |x: f64| if x.is_finite() { x.clamp(0.0, 100.0) } else { 50.0 };
    let mut text = format!("<div class=\"row chart\"><span>{head}</span><div class=\"bar\"><div class=\"bell\">");
    if let Some(zero) = zero {
        let _ = write!(text, "<u style=\"left:{:.2}%\"></u>", place(zero));
    }
    for (class, low, value, high) in marks {
        let (low, value, high) = (place(*low), place(*value), place(*high));
        let _ = write!(
            text,
            "<s style=\"left:{low:.2}%;width:{:.2}%\"></s><i class=\"{class}\" style=\"left:{value:.2}%\"></i>",
            high - low
        );
    }
    text + &format!("</div><b>{after}</b></div></div>\n")
}

/// Ticks below rows of bars or intervals: labels at places from 0 to 100, then the unit.
pub fn ticks_row(ticks: &[(f64, String)], unit: &str) -> String {
    let mut text = String::from("<div class=\"row chart axis\"><span></span><div class=\"bar\"><div class=\"ticks\">");
    for (at, label) in ticks {
        let _ = write!(text, "<span style=\"left:{at:.2}%\">{label}</span>");
    }
    text + &format!("</div><b>{}</b></div></div>\n", escape(unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_needs_nothing_from_elsewhere_and_leaves_empty_sections_out() {
        let sections = [
            Section { id: "a", title: "Shown", body: "<p>x</p>".into() },
            Section { id: "b", title: "Hidden", body: String::new() },
        ];
        let page = page_html("a < b", "", &sections, "foot");
        assert!(page.contains("<title>a &lt; b</title>") && page.contains("Shown") && !page.contains("Hidden"));
        assert!(!page.contains("http") && !page.contains("url(") && !page.contains("@import"));
    }

    #[test]
    fn names_are_escaped_and_may_break() {
        assert_eq!(name("a_<b>&c"), "a_<wbr>&lt;b&gt;&amp;c");
        assert_eq!(name("a.b[0]/7.32"), "a.<wbr>b[0]/<wbr>7.32");
        assert_eq!(sentence("a_b is 7.5 % up"), "a_<wbr>b is 7.5\u{a0}% up");
        assert_eq!(attribute("a\"b&c"), "a&quot;b&amp;c");
    }

    #[test]
    fn shares_that_are_no_numbers_draw_nothing() {
        assert!(bar_row("a", "x", f64::NAN, None, "").contains("width:0.00%"));
        assert!(!interval_row("a", &[("x", f64::NAN, 1.0, 2.0)], Some(f64::NAN), "").contains("NaN"));
    }
}
