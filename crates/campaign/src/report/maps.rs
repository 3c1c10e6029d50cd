//! The envelope map with the runs beside it, and the strongest pairs of input and metric, all coloured by outcome.

use super::colours::Colours;
use super::distributions::{MOST as DRAWN, chosen};
use crate::findings::{Effect, Envelope, Findings};
use crate::table::{INPUT, Table};
use record::page::number::{digits, percent};
use record::page::unit::label;
use record::page::{Layer, Panel, figure, legend, name};

/// Most pairs drawn, and most points of a drawing; more points are left out evenly.
const MOST: (usize, usize) = (6, 2000);
const HEIGHT: f64 = 210.0;
/// Heights of the map, px: of a row of cells, and the least and the most.
const ROW: f64 = 38.0;
const MAP: (f64, f64) = (160.0, 380.0);
/// Most marks of a grid's values on an axis.
const MARKS: usize = 10;
/// Upper ends of the colour classes of a rate.
const RATES: [f64; 5] = [0.25, 0.5, 0.75, 0.9, 0.99];
const RATE_CLASSES: [&str; 6] = ["r0", "r1", "r2", "r3", "r4", "r5"];
/// The same for cells of fewer runs than these, which say little.
const FAINT_CLASSES: [&str; 6] = ["r0 faint", "r1 faint", "r2 faint", "r3 faint", "r4 faint", "r5 faint"];
const FEW: usize = 4;

/// The map.
pub(super) fn envelope(table: &Table, findings: &Findings) -> String {
    let Some(map) = &findings.envelope else { return String::new() };
    let mut text = String::from(
        "<p>First the rate of success in cells of the two inputs; the upper number is the rate in per cent, the lower \
         one the number of runs. \
         Cells of fewer than four runs are faint, cells without one blank. Then the same runs one by one.</p>\n",
    );
    text += &legend(&[
        ("r0", "&lt; 25 %"),
        ("r1", "25–50 %"),
        ("r2", "50–75 %"),
        ("r3", "75–90 %"),
        ("r4", "90–99 %"),
        ("r5", "≥ 99 %"),
    ]);
    let colours = Colours::of(findings);
    text += &colours.legend();
    let height = (ROW * map.cells.len() as f64).clamp(MAP.0, MAP.1);
    let [across, up] = Side::of(map);
    let values = |name: &str, side: &Side<'_>| -> Vec<Option<f64>> {
        let all = table.numbers(&format!("{INPUT}{name}")).unwrap_or_default();
        all.into_iter().map(|v| v.map(|v| side.place(v))).collect()
    };
    let (x, y) = (values(&map.across, &across), values(&map.up, &up));
    let caption = format!("<b>{}</b> and <b>{}</b>", name(&map.across), name(&map.up));
    let blank = Panel {
        across: label(&map.across),
        up: label(&map.up),
        height,
        across_ends: across.ends(),
        up_ends: up.ends(),
        across_marks: across.marks(),
        up_marks: up.marks(),
        ..Panel::default()
    };
    text += "<div class=\"panels\">\n";
    let cells = Panel { layers: heat(map, [&across, &up]), ..blank.clone() };
    text += &figure(&format!("{caption} <span>rate of success</span>"), &cells.svg("rate of success over two inputs"));
    let runs = Panel { layers: dots(table, &x, &y, &colours), ..blank };
    text += &figure(&format!("{caption} <span>runs by outcome</span>"), &runs.svg("runs over two inputs by outcome"));
    text + "</div>\n"
}

/// An axis of the map: by value, or a step for each value of a grid, however these are spaced.
struct Side<'a> {
    edges: &'a [f64],
    values: Option<&'a [f64]>,
}

impl<'a> Side<'a> {
    /// Across and up.
    fn of(map: &'a Envelope) -> [Self; 2] {
        [
            Self { edges: &map.across_edges, values: map.across_values.as_deref() },
            Self { edges: &map.up_edges, values: map.up_values.as_deref() },
        ]
    }

    /// Where a value is drawn.
    fn place(&self, value: f64) -> f64 {
        match self.values {
            Some(values) => values.partition_point(|v| *v < value) as f64 + 0.5,
            None => value,
        }
    }

    /// Ends of the bins as they are drawn.
    fn bins(&self) -> Vec<[f64; 2]> {
        match self.values {
            Some(values) => (0..values.len()).map(|i| [i as f64, (i + 1) as f64]).collect(),
            None => self.edges.windows(2).map(|e| [e[0], e[1]]).collect(),
        }
    }

    fn ends(&self) -> Option<(f64, f64)> {
        let bins = self.bins();
        bins.first().map(|b| b[0]).zip(bins.last().map(|b| b[1]))
    }

    /// The values of a grid, as many as have room.
    fn marks(&self) -> Option<Vec<(f64, String)>> {
        let values = self.values?;
        let every = values.len().div_ceil(MARKS);
        let of = |(i, value): (usize, &f64)| (i as f64 + 0.5, digits(*value, 3));
        Some(values.iter().enumerate().step_by(every).map(of).collect())
    }
}

fn heat(map: &Envelope, [across, up]: [&Side<'_>; 2]) -> Vec<Layer> {
    let mut boxes: Vec<Vec<(f64, f64, f64, f64)>> = vec![Vec::new(); 2 * RATE_CLASSES.len()];
    let (mut rates, mut counts) = (Vec::new(), Vec::new());
    // Of a grid that was run through once the colours say it all.
    let is_once = map.cells.iter().flatten().all(|cell| cell.runs <= 1);
    for (row, up) in map.cells.iter().zip(up.bins()) {
        for (cell, across) in row.iter().zip(across.bins()) {
            let Some(rate) = cell.rate() else { continue };
            let class = RATES.partition_point(|end| *end <= rate);
            let class = if cell.runs < FEW && !is_once { RATE_CLASSES.len() + class } else { class };
            boxes[class].push((across[0], across[1], up[0], up[1]));
            let (x, y) = (0.5 * (across[0] + across[1]), 0.5 * (up[0] + up[1]));
            if !is_once {
                rates.push((x, y, 0.0, format!("{:.0}", whole_percent(rate))));
                counts.push((x, y, 13.0, cell.runs.to_string()));
            }
        }
    }
    let cells = RATE_CLASSES.iter().chain(&FAINT_CLASSES).zip(boxes).map(|(class, boxes)| Layer::Boxes(class, boxes));
    cells.chain([Layer::Texts("cell", rates), Layer::Texts("cellcount", counts)]).collect()
}

/// Whole per cent, 0 and 100 for none and all only.
fn whole_percent(rate: f64) -> f64 {
    if rate <= 0.0 || rate >= 1.0 { 100.0 * rate } else { (100.0 * rate).round().clamp(1.0, 99.0) }
}

/// Runs as dots, failures in front.
fn dots(table: &Table, x: &[Option<f64>], y: &[Option<f64>], colours: &Colours) -> Vec<Layer> {
    let points: Vec<(f64, f64, &str)> = x
        .iter()
        .zip(y)
        .enumerate()
        .filter_map(|(row, (x, y))| Some(((*x)?, (*y)?, colours.class(table.text("outcome", row)))))
        .collect();
    let every = points.len().div_ceil(MOST.1).max(1);
    let of = |class: &str| points.iter().step_by(every).filter(|p| p.2 == class).map(|p| (p.0, p.1)).collect();
    colours.classes().into_iter().map(|class| Layer::Dots(class, of(class))).collect()
}

/// The strongest dependency of each metric, the strongest of all first.
fn strongest(findings: &Findings) -> Vec<&Effect> {
    // Accounts of energy follow from the speed by definition: they would fill the section with what everyone knows.
    let drawn: Vec<&str> = chosen(findings).iter().take(DRAWN).map(|metric| metric.name.as_str()).collect();
    let mut best: Vec<&Effect> = Vec::new();
    for output in findings.sensitivity.outputs.iter().filter(|name| drawn.contains(&name.as_str())) {
        let of_output = findings.sensitivity.effects.iter().filter(|e| &e.output == output && e.is_clear);
        best.extend(of_output.reduce(|a, b| if b.strength() > a.strength() { b } else { a }));
    }
    best.sort_by(|a, b| b.strength().0.total_cmp(&a.strength().0));
    best
}

/// The strongest pairs.
pub(super) fn pairs(table: &Table, findings: &Findings) -> String {
    let best = strongest(findings);
    if best.is_empty() {
        return String::new();
    }
    let colours = Colours::of(findings);
    let mut text = String::from(
        "<p>For each metric drawn above the input that explains most of it, the strongest pairs first, a dot a \
         run.</p>\n",
    );
    text += &colours.legend();
    text += "<div class=\"panels\">\n";
    best.iter().take(MOST.0).for_each(|effect| text += &pair(table, effect, &colours));
    text += "</div>\n";
    if table.len() > MOST.1 {
        let every = table.len().div_ceil(MOST.1);
        text += &format!("<p>One run in {every} is drawn.</p>\n");
    }
    text
}

fn pair(table: &Table, effect: &Effect, colours: &Colours) -> String {
    let x = table.numbers(&format!("{INPUT}{}", effect.input)).unwrap_or_default();
    let y = table.numbers(&effect.output).unwrap_or_default();
    let panel = Panel {
        across: label(&effect.input),
        up: label(&effect.output),
        height: HEIGHT,
        layers: dots(table, &x, &y, colours),
        ..Panel::default()
    };
    let share =
        effect.first_order.map_or_else(String::new, |s| format!("explains {} alone", percent(s.clamp(0.0, 1.0))));
    let rho =
        effect.spearman.map_or_else(String::new, |rho| format!(", ρ {}", digits((100.0 * rho).round() / 100.0, 2)));
    let caption = format!("<b>{}</b> over {} <span>{share}{rho}</span>", name(&effect.output), name(&effect.input));
    figure(&caption, &panel.svg(&format!("{} over {}", effect.output, effect.input)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_all_is_a_hundred_per_cent() {
        assert_eq!([0.0, 0.001, 0.5, 0.999, 1.0].map(whole_percent), [0.0, 1.0, 50.0, 99.0, 100.0]);
        assert_eq!([0.0, 0.9, 0.99, 1.0].map(|rate| RATES.partition_point(|end| *end <= rate)), [0, 4, 5, 5]);
    }
}
