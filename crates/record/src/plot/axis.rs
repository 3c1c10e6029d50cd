//! An axis for drawings: values to pixels, linear or logarithmic, and round values with labels for its ticks.

/// One axis: values to pixels.
#[derive(Clone, Copy, Debug)]
pub struct Axis {
    /// Ends, as values, or as their logarithms to base ten.
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Pixels of the low and of the high end.
    pub pixels: (f64, f64),
}

impl Axis {
    /// An axis that shows all finite values, with a little room at both ends.
    pub fn new(values: impl Iterator<Item = f64>, logarithmic: bool, pixels: (f64, f64)) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let place = |v: f64| if logarithmic { v.log10() } else { v };
        values.map(place).filter(|v| v.is_finite()).for_each(|v| (low, high) = (low.min(v), high.max(v)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        let least = if logarithmic { 0.3 } else { 1e-12 * high.abs().max(low.abs()) };
        let room = if high - low <= least { 0.1 * low.abs().max(if low == 0.0 { 10.0 } else { 0.0 }) } else { 0.0 };
        let margin = 0.03 * (high - low) + room;
        Self { low: low - margin, high: high + margin, logarithmic, pixels }
    }

    /// A linear axis from `low` to `high` exactly.
    pub fn between(low: f64, high: f64, pixels: (f64, f64)) -> Self {
        let (low, high) = if high > low { (low, high) } else { (low - 0.5, low + 0.5) };
        Self { low, high, logarithmic: false, pixels }
    }

    /// A logarithmic axis from `low` to `high` exactly; linear where they have no logarithms.
    pub fn between_logarithms(low: f64, high: f64, pixels: (f64, f64)) -> Self {
        if !(low > 0.0 && high > low) {
            return Self::between(low, high, pixels);
        }
        Self { low: low.log10(), high: high.log10(), logarithmic: true, pixels }
    }

    /// Whether a value has a place on it.
    pub fn shows(&self, value: f64) -> bool {
        value.is_finite() && (!self.logarithmic || value > 0.0)
    }

    /// Pixel of a value.
    pub fn at(&self, value: f64) -> f64 {
        // What has no logarithm lies at the lower end.
        let place = match self.logarithmic {
            true if value > 0.0 => value.log10(),
            true => self.low,
            false => value,
        };
        self.pixels.0 + (place - self.low) / (self.high - self.low) * (self.pixels.1 - self.pixels.0)
    }

    fn per_pixel(&self) -> f64 {
        (self.high - self.low) / (self.pixels.1 - self.pixels.0).abs()
    }

    fn widen(&mut self, per_pixel: f64) {
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * per_pixel * (self.pixels.1 - self.pixels.0).abs());
        (self.low, self.high) = (middle - half, middle + half);
    }

    /// Round values with their labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        if self.logarithmic {
            return self.decades();
        }
        let step = round_step((self.high - self.low) / 5.0);
        let (first, last) = ((self.low / step).ceil() as i64, (self.high / step).floor() as i64);
        let largest = self.low.abs().max(self.high.abs());
        (first..=last).map(|k| k as f64 * step).map(|v| (v, label(v, step, largest))).collect()
    }

    /// Powers of ten; with 2 and 5 between where there are few.
    fn decades(&self) -> Vec<(f64, String)> {
        let span = self.high - self.low;
        let every = (span / 8.0).ceil().max(1.0) as i32;
        let factors: &[f64] = if span < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let powers = (first..=last).filter(|p| p.rem_euclid(every) == 0);
        let values = powers.flat_map(|p| factors.iter().map(move |f| f * 10_f64.powi(p)));
        values.filter(|v| (self.low..=self.high).contains(&v.log10())).map(|v| (v, power_label(v))).collect()
    }
}

/// One unit as long across as up.
pub fn equalise(across: &mut Axis, up: &mut Axis) {
    let per_pixel = across.per_pixel().max(up.per_pixel());
    across.widen(per_pixel);
    up.widen(per_pixel);
}

fn round_step(rough: f64) -> f64 {
    let power = 10_f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * power)
}

/// A tick's label with the digits that its step needs.
fn label(value: f64, step: f64, largest: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e5).contains(&largest) {
        let digits = (largest.log10().floor() - step.log10().floor()).max(0.0) as usize;
        return scientific(value, digits.min(4));
    }
    let digits = (-step.log10().floor()).max(0.0) as usize;
    minus(format!("{value:.digits$}"))
}

/// `1.5·10⁻⁶`.
fn scientific(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}·10{}", minus(mantissa.to_owned()), superscript(power))
}

fn power_label(value: f64) -> String {
    if (0.0099..10001.0).contains(&value) {
        return format!("{value}");
    }
    let text = format!("{value:e}");
    let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
    let factor = if mantissa == "1" { String::new() } else { format!("{mantissa}·") };
    format!("{factor}10{}", superscript(power))
}

fn minus(text: String) -> String {
    text.replace('-', "−")
}

fn superscript(text: &str) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        other => other,
    };
    text.chars().map(raised).collect()
}

/// Text as XML takes it.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_the_digits_that_their_step_needs() {
        assert_eq!((label(0.30, 0.05, 1.0).as_str(), label(-2.0, 1.0, 4.0).as_str()), ("0.30", "−2"));
        assert_eq!(label(2e-6, 5e-7, 3e-6), "2.0·10⁻⁶");
    }

    #[test]
    fn equal_scales_are_equal() {
        let (mut across, mut up) = (
            Axis::new([0.0, 1.0].into_iter(), false, (0.0, 500.0)),
            Axis::new([0.0, 4.0].into_iter(), false, (300.0, 0.0)),
        );
        equalise(&mut across, &mut up);
        assert!((across.per_pixel() - up.per_pixel()).abs() < 1e-12);
    }

    #[test]
    fn an_axis_between_two_ends_has_no_room() {
        let axis = Axis::between(2.0, 4.0, (0.0, 100.0));
        assert_eq!((axis.at(2.0), axis.at(4.0)), (0.0, 100.0));
        assert!(Axis::between(1.0, 1.0, (0.0, 100.0)).at(1.0).is_finite());
    }
}
