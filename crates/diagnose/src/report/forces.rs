//! The missing force over time and against what it depends on.

use super::{figure, legend};
use crate::evidence::{Evidence, MissingForce, Scatter};
use crate::number::percent;
use record::page::{Layer, Panel};
use record::plot::escape;

/// Most drawings of each kind.
const MOST: usize = 12;
/// Most points of a scatter; more are left out evenly.
const POINTS: usize = 500;
const HEIGHT: f64 = 190.0;

/// The section.
pub(super) fn section(evidence: &Evidence) -> String {
    if evidence.forces.is_empty() && evidence.scatters.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "<p>The force that the scenario lacks, estimated from the data over the nominal model without assuming any law \
         (band and bars: ± 2 standard errors), and the law that was found, along the same motion. Where they agree, the law is \
         the missing physics; what the band holds around zero is nothing.</p>\n",
    );
    text += &legend(&[
        ("corrected", "estimated from the data"),
        ("noise", "± 2 standard errors"),
        ("law", "law that was found"),
    ]);
    text += "<div class=\"panels\">\n";
    evidence.forces.iter().take(MOST).for_each(|force| text += &over_time(force));
    evidence.scatters.iter().take(MOST).for_each(|scatter| text += &against(scatter));
    text + "</div>\n"
}

fn over_time(force: &MissingForce) -> String {
    let triples = force.t.iter().zip(&force.estimate).zip(&force.std_err);
    let band = triples.map(|((t, f), e)| (*t, f - 2.0 * e, f + 2.0 * e)).collect();
    let pairs = |values: &[f64]| force.t.iter().copied().zip(values.iter().copied()).collect();
    let mut layers =
        vec![Layer::Level("zero", 0.0), Layer::Band("noise", band), Layer::Line("corrected", pairs(&force.estimate))];
    let mut law_name = String::new();
    if let Some((name, values)) = &force.law {
        layers.push(Layer::Line("law", pairs(values)));
        law_name = if name.is_empty() { String::new() } else { format!("; law: {}", escape(name)) };
    }
    let panel = Panel {
        across: "time, s".to_owned(),
        up: force.unit.clone(),
        height: HEIGHT,
        across_ends: force.t.first().copied().zip(force.t.last().copied()),
        layers,
        ..Panel::default()
    };
    let (place, freedom, run) = (escape(&force.place), escape(&force.freedom), escape(&force.run));
    figure(&format!("<b>{place}</b>, {freedom} <span>{run}{law_name}</span>"), &panel.svg("missing force over time"))
}

fn against(scatter: &Scatter) -> String {
    let every = scatter.points.len().div_ceil(POINTS).max(1);
    let points = scatter.points.iter().step_by(every).map(|p| (p.x, p.y, 2.0 * p.std_err)).collect();
    let mut layers = vec![Layer::Level("zero", 0.0), Layer::Marks("corrected", points)];
    let mut words = String::new();
    if let Some((name, law)) = &scatter.law {
        layers.push(Layer::Line("law", law.clone()));
        words = if name.is_empty() { String::new() } else { format!("law: {}", escape(name)) };
    }
    if scatter.r_squared.is_finite() {
        let explains = format!("explains {} of its variance where it was not fitted", percent(scatter.r_squared));
        words = if words.is_empty() { explains } else { format!("{words}; {explains}") };
    }
    let panel =
        Panel { across: scatter.across.clone(), up: scatter.up.clone(), height: HEIGHT, layers, ..Panel::default() };
    let caption =
        format!("<b>{}</b>, against {} <span>{words}</span>", escape(&scatter.place), escape(&scatter.across));
    figure(&caption, &panel.svg("missing force against a quantity"))
}
