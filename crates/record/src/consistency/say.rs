//! Findings of a pair as sentences.

use super::{Consistency, Estimate};

/// Standard errors from which a figure counts; with some thousand figures looked at, 5 is never reached by chance.
const SIGNIFICANT: f64 = 5.0;
/// Mean square innovation from which a pair is said not to fit at all.
const MISFIT: f64 = 2.0;
/// Factors that a wrong unit leaves, within 5 %: reading = factor · true.
const FACTORS: [(f64, &str); 6] = [
    (57.295_779_5, "deg/s read as rad/s, or the position in rad where it should be in deg"),
    (0.017_453_292_5, "the position in deg"),
    (1000.0, "the rate in thousandths (mm/s, mrad/s), or the time in ms: [time] unit = \"ms\""),
    (0.001, "the position in thousandths (mm, mrad), or the time in kiloseconds"),
    (0.104_719_755, "rad/s read as rpm"),
    (9.549_296_6, "rpm read as rad/s"),
];

/// The sentences, and whether they make the data unfit as they are.
pub(super) fn findings(found: &Consistency, other: Option<&str>) -> (Vec<String>, bool) {
    if let Some(other) = other {
        return (vec![other.to_owned()], true);
    }
    let mut said = Vec::new();
    let mut is_fault = false;
    if found.is_mirrored {
        said.push(format!("is a mirror image of the derivative of {}: {}", found.position, mirrored(found)));
        is_fault = true;
    } else if let Some(unit) = wrong_unit(found) {
        said.push(unit);
        is_fault = true;
    } else {
        is_fault |= add_scales(found, &mut said);
        add_angle(found, &mut said);
    }
    if !is_fault {
        add_delay(found, &mut said);
        add_bias(found, &mut said);
    }
    if found.misfit_fitted > MISFIT {
        said.push(format!(
            "is not the derivative of {} even with a fitted scale, bias, delay and rotation: mean square error {:.3} where 1 is noise",
            found.position, found.misfit_fitted
        ));
    }
    (said, is_fault)
}

/// Which axes have the wrong sign.
fn mirrored(found: &Consistency) -> String {
    let names = if found.matrix.len() == 1 { vec![""] } else { vec!["x", "y", "z"] };
    let wrong: Vec<&str> = names
        .iter()
        .zip(&found.matrix)
        .enumerate()
        .filter(|(i, (_, row))| row[*i] < 0.0)
        .map(|(_, (n, _))| *n)
        .collect();
    match wrong.as_slice() {
        [""] => "its sign is reversed".to_owned(),
        [] => "two axes are exchanged".to_owned(),
        wrong => format!("the sign of {} is reversed", wrong.join(", ")),
    }
}

/// One factor on all axes that a wrong unit would leave.
fn wrong_unit(found: &Consistency) -> Option<String> {
    let scales: Vec<f64> = found.scale.iter().flatten().map(|s| s.value).collect();
    let (factor, what) = FACTORS
        .into_iter()
        .find(|(factor, _)| !scales.is_empty() && scales.iter().all(|s| (s / factor - 1.0).abs() < 0.05))?;
    let mean = scales.iter().sum::<f64>() / scales.len() as f64;
    Some(format!(
        "reads {mean:.4} times the derivative of {} (a unit's factor would be {factor:.4}): {what}",
        found.position
    ))
}

/// Scales that are wrong; one far from 1 is a fault.
fn add_scales(found: &Consistency, said: &mut Vec<String>) -> bool {
    let mut is_fault = false;
    for (axis, scale) in found.scale.iter().enumerate() {
        let Some(scale) = scale.filter(|s| s.z(1.0).abs() > SIGNIFICANT) else { continue };
        is_fault |= !(0.5..2.0).contains(&scale.value);
        said.push(format!(
            "{}reads {} times the derivative of {}",
            axis_name(found, axis),
            shown(scale),
            found.position
        ));
    }
    is_fault
}

fn add_angle(found: &Consistency, said: &mut Vec<String>) {
    let Some(angle) = found.angle else { return };
    if angle.iter().any(|a| a.z(0.0).abs() > SIGNIFICANT) {
        let parts = angle.map(shown);
        said.push(format!(
            "is turned against {} by the rotation vector [{}] rad (sensor or attitude: kinematics cannot tell which)",
            found.position,
            parts.join(", ")
        ));
    }
}

fn add_delay(found: &Consistency, said: &mut Vec<String>) {
    if let Some(delay) = found.delay.filter(|d| d.z(0.0).abs() > SIGNIFICANT) {
        let order = if delay.value > 0.0 { "later" } else { "earlier" };
        let size = Estimate { value: delay.value.abs(), ..delay };
        said.push(format!("comes {} s {order} than {}", shown(size), found.position));
    }
}

fn add_bias(found: &Consistency, said: &mut Vec<String>) {
    for (axis, bias) in found.bias.iter().enumerate() {
        if let Some(bias) = bias.filter(|b| b.z(0.0).abs() > SIGNIFICANT) {
            said.push(format!(
                "{}has a bias of {} against the derivative of {}",
                axis_name(found, axis),
                shown(bias),
                found.position
            ));
        }
    }
}

fn axis_name(found: &Consistency, axis: usize) -> &'static str {
    if found.matrix.len() == 1 { "" } else { ["x ", "y ", "z "][axis.min(2)] }
}

/// Value ± standard error with two digits of the latter.
fn shown(estimate: Estimate) -> String {
    let digits = (1 - estimate.std_err.max(1e-12).log10().floor() as i32).clamp(0, 9) as usize;
    format!("{:.digits$} ± {:.digits$}", estimate.value, estimate.std_err)
}
