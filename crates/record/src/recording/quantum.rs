//! The rounding that values were written with, found from the values.
//!
//! Two lattices are looked for. **Decimal**: all values are multiples of 10⁻ᵏ (a fixed number of decimals), or all have
//! d significant digits (then the step differs with the value and the root mean square is taken). **Encoder**: the
//! differences of neighbouring samples are multiples of a step δ that is no power of ten, whatever the offset; δ is
//! where C(δ) = mean cos(2π d/δ) over small differences d is near 1 (rounding to g on top lowers it to sinc²(g/δ)). It is
//! seen where neighbours differ by some tens of steps at most: a coarse encoder, or a joint that turns around.

/// Samples that are looked at; more tell nothing new.
const LOOKED_AT: usize = 4000;
/// Decimals beyond which a double holds no rounding to be seen.
const DECIMALS: i32 = 12;
/// Share of values that must have the full number of decimals: of fixed decimals, one in ten ends in 0.
const FULL: f64 = 0.75;
/// Significant digits that still are a rounding and not the digits of a single-precision number.
const DIGITS: i32 = 7;
/// C(δ) from which a lattice is believed; sinc²(1/3) = 0.68 for an encoder step written to a third of it.
const LATTICE: f64 = 0.62;
/// Stretches that are looked at are begun at so many places, and at the end.
const PLACES: usize = 8;
/// Fewest small differences that can show a lattice.
const FEWEST: usize = 30;

/// The width q for which q²/12 is the variance of the rounding; 0 for continuous values.
pub(super) fn find_quantum(values: &[f64]) -> f64 {
    let stride = values.len().div_ceil(LOOKED_AT).max(1);
    let thinned: Vec<f64> = values.iter().copied().step_by(stride).collect();
    if distinct(&thinned) < 3 {
        return 0.0;
    }
    let written = decimal_step(&thinned);
    let stretch = liveliest(values);
    let is_fixed = (written.log10() - written.log10().round()).abs() < 1e-9;
    let encoder = match written > 0.0 && is_fixed {
        true => step_over(stretch, written).or_else(|| encoder_step(stretch).filter(|_| stands_often(stretch))),
        false => encoder_step(stretch),
    };
    match encoder {
        Some(encoder) if encoder > 1.5 * written => encoder.hypot(written),
        _ => written,
    }
}

/// The stretch in which the values change most often: what rests shows no steps.
fn liveliest(values: &[f64]) -> &[f64] {
    let last = values.len().saturating_sub(LOOKED_AT);
    let stretch = |k: usize| {
        let start = k * last / PLACES;
        &values[start..(start + LOOKED_AT).min(values.len())]
    };
    let changes = |s: &[f64]| s.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let middle = stretch(PLACES / 2);
    (0..=PLACES).map(stretch).fold(middle, |best, s| if changes(s) > 2 * changes(best) { s } else { best })
}

/// Whether neighbours are now and then equal, as those of a coarse encoder are where it turns round; of noise hardly any are.
fn stands_often(values: &[f64]) -> bool {
    let equal = values.windows(2).filter(|pair| pair[0] == pair[1]).count();
    equal * 20 > values.len() && values.len() - equal > FEWEST
}

/// Step of an encoder whose readings were then rounded to `written`: the highest C(δ) with δ above that rounding.
///
/// White differences of standard deviation s have C(δ) = exp(−2π² s²/δ²), so that only δ ≤ 2 s can tell a lattice.
fn step_over(values: &[f64], written: f64) -> Option<f64> {
    const FARTHEST: usize = 60;
    let mut counts = [0.0_f64; FARTHEST + 1];
    for pair in values.windows(2) {
        let steps = ((pair[1] - pair[0]) / written).abs().round();
        if (1.0..=FARTHEST as f64).contains(&steps) {
            counts[steps as usize] += 1.0;
        }
    }
    let all: f64 = counts.iter().sum();
    let square: f64 = counts.iter().enumerate().map(|(n, c)| c * (n * n) as f64).sum();
    if all < FEWEST as f64 {
        return None;
    }
    let widest = 2.0 * (square / all).sqrt();
    let likeness = |step: f64| -> f64 {
        counts.iter().enumerate().map(|(n, c)| c * (std::f64::consts::TAU * n as f64 / step).cos()).sum::<f64>() / all
    };
    // Equal steps of frequency: C falls by a hundredth over one of them at the farthest difference.
    let steps = (0..).map(|k| 1.0 / (0.5 - 0.0005 * f64::from(k))).take_while(|step| *step > 0.0 && *step <= widest);
    let best = steps.take(1000).map(|step| (likeness(step), step)).reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    (best.0 > LATTICE).then_some(best.1 * written)
}

/// Number of distinct values, counted up to three.
fn distinct(values: &[f64]) -> usize {
    let mut seen: Vec<f64> = Vec::new();
    for value in values {
        if !seen.contains(value) {
            seen.push(*value);
        }
        if seen.len() >= 3 {
            break;
        }
    }
    seen.len()
}

/// Step of the decimal rounding, 0 where there is none.
fn decimal_step(values: &[f64]) -> f64 {
    let decimals: Option<Vec<(f64, i32)>> =
        values.iter().filter(|v| **v != 0.0).map(|v| Some((*v, decimals_of(*v)?))).collect();
    let Some(decimals) = decimals.filter(|d| !d.is_empty()) else {
        return 0.0;
    };
    let most = decimals.iter().map(|(_, k)| *k).max().unwrap_or(0);
    let full = decimals.iter().filter(|(_, k)| *k == most).count();
    if full as f64 >= FULL * decimals.len() as f64 {
        return 10_f64.powi(-most);
    }
    step_of_digits(&decimals).unwrap_or_else(|| 10_f64.powi(-most))
}

/// Root mean square step of values with a fixed number of significant digits.
fn step_of_digits(decimals: &[(f64, i32)]) -> Option<f64> {
    let exponent = |v: f64| v.abs().log10().floor() as i32;
    let mut digits: Vec<i32> = decimals.iter().map(|(v, k)| k + exponent(*v) + 1).collect();
    digits.sort_unstable();
    let most = *digits.last()?;
    let full = digits.iter().filter(|d| **d == most).count();
    if most > DIGITS || (full as f64) < FULL * digits.len() as f64 {
        return None;
    }
    let squares: f64 = decimals.iter().map(|(v, _)| 10_f64.powi(2 * (exponent(*v) + 1 - most))).sum();
    Some((squares / decimals.len() as f64).sqrt())
}

/// Smallest k for which the value is a multiple of 10⁻ᵏ; none if there is no such k that a double can show.
fn decimals_of(value: f64) -> Option<i32> {
    // Six digits of room between the lattice and the last bit: a double has 15.9.
    const ROOM: f64 = 1e-6;
    (-6..=DECIMALS).find(|k| {
        let scaled = if *k < 0 { value / 10_f64.powi(-k) } else { value * 10_f64.powi(*k) };
        scaled.abs() >= 0.5 && (scaled - scaled.round()).abs() <= (4.0 * f64::EPSILON * scaled.abs()).min(ROOM)
    })
}

/// Step of an encoder, from the smallest cluster of differences, sharpened on ever larger ones.
fn encoder_step(values: &[f64]) -> Option<f64> {
    let mut sizes: Vec<f64> = values.windows(2).map(|v| (v[1] - v[0]).abs()).filter(|d| *d > 0.0).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let smallest = *sizes.get(sizes.len() / 200)?;
    let mut step = mean(sizes.iter().copied().filter(|d| *d >= 0.9 * smallest && *d < 1.6 * smallest))?;
    for reach in [2.5, 4.5, 9.5, 20.5] {
        let near: Vec<f64> = sizes.iter().copied().filter(|d| *d > 0.5 * step && *d < reach * step).collect();
        let counts = near.iter().map(|d| (d / step).round());
        let (along, across) = near.iter().zip(counts).fold((0.0, 0.0), |(a, b), (d, n)| (a + d * n, b + n * n));
        if near.len() < FEWEST || across <= 0.0 {
            return None;
        }
        step = along / across;
    }
    let near: Vec<f64> = sizes.into_iter().filter(|d| *d < 20.5 * step).collect();
    let counts = near.iter().filter(|d| **d > 1.5 * step).count();
    let on_lattice = mean(near.iter().map(|d| (std::f64::consts::TAU * d / step).cos()))?;
    (on_lattice > LATTICE && counts >= FEWEST / 3).then_some(step)
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), v| (sum + v, count + 1));
    (count > 0).then(|| sum / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pendulum before a coarse encoder, written with six decimals, that comes to rest early.
    #[test]
    fn the_step_of_a_coarse_encoder_shows_where_it_moves() {
        const STEP: f64 = 1.5708e-4;
        let angle = |i: i32| {
            3.1 + if i < 5_000 { 0.05 * (-f64::from(i) / 2e3).exp() * (f64::from(i) * 8e-3).cos() } else { 0.0 }
        };
        let read = |i: i32| ((angle(i) / STEP).round() * STEP * 1e6).round() * 1e-6;
        let values: Vec<f64> = (0..23_000).map(read).collect();
        let found = find_quantum(&values);
        assert!((found / STEP - 1.0).abs() < 0.01, "{found}");
    }
}
