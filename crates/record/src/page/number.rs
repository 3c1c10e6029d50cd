//! Numbers for a reader: as many digits as they are worth.

/// Four significant digits, powers of ten where they help; "–" for what is not finite.
pub fn short(x: f64) -> String {
    digits(x, 4)
}

/// `count` significant digits, trailing zeros left out.
pub fn digits(x: f64, count: i32) -> String {
    if !x.is_finite() {
        return "–".to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..99_999.5).contains(&x.abs()) {
        let text = format!("{x:.*e}", (count - 1).max(0) as usize);
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa =
            if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
        return minus(&format!("{mantissa}·10{}", superscript(power)));
    }
    let places = count - 1 - x.abs().log10().floor() as i32;
    let coarse = 10_f64.powi((-places).max(0));
    let text =
        format!("{:.*}", places.clamp(0, 9) as usize, if coarse > 1.0 { (x / coarse).round() * coarse } else { x });
    minus(if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text })
}

/// A value with its standard error, both to the error's second digit: `0.9012 ± 0.0011`, `(1.98 ± 0.02)·10⁻⁴`.
///
/// Without a finite error the value stands alone.
pub fn with_error(value: f64, std_err: f64) -> String {
    if !(std_err.is_finite() && std_err > 0.0 && value.is_finite()) {
        return short(value);
    }
    let largest = value.abs().max(std_err);
    let power = if (1e-2..1e5).contains(&largest) { 0 } else { largest.log10().floor() as i32 };
    let unit = 10_f64.powi(power);
    let (value, std_err) = (value / unit, std_err / unit);
    let places = (1 - std_err.log10().floor() as i32).clamp(0, 9) as usize;
    // What rounds to nothing has no sign.
    let value = if value.abs() < 0.5 * 10_f64.powi(-(places as i32)) { 0.0 } else { value };
    let text = minus(&format!("{value:.places$} ± {std_err:.places$}"));
    if power == 0 { text } else { format!("({text})·10{}", superscript(&power.to_string())) }
}

/// A share in per cent: `87 %`, `0.4 %`.
pub fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "–".to_owned();
    }
    let x = 100.0 * share;
    let text = if x.abs() < 1.0 && x != 0.0 { format!("{x:.1} %") } else { format!("{x:.0} %") };
    minus(&text.replace("0.0 %", "0 %"))
}

/// A share in per cent with one decimal: `92.6 %`, and as much as is true near the ends: `99.96 %`.
pub fn rate(share: f64) -> String {
    if !share.is_finite() {
        return "–".to_owned();
    }
    let x = 100.0 * share;
    let is_near_end = (x < 0.05 && x > 0.0) || (x > 99.95 && x < 100.0);
    let text = if is_near_end { format!("{x:.2} %") } else { format!("{x:.1} %") };
    minus(&text.replace(".0 %", " %"))
}

/// A p-value: `0.023`, `< 0.0001`.
pub fn p_value(p: f64) -> String {
    match p {
        p if !p.is_finite() => "–".to_owned(),
        p if p < 1e-4 => "< 0.0001".to_owned(),
        p if p > 0.99 => "1".to_owned(),
        // Never a power of ten: a reader compares it with 0.05.
        p if p < 1e-3 => format!("{p:.5}"),
        p => digits(p, 2),
    }
}

/// A p-value with its name: `p = 0.023`, `p < 0.0001`.
pub fn p_words(p: f64) -> String {
    let text = p_value(p);
    if text.starts_with('<') { format!("p {text}") } else { format!("p = {text}") }
}

/// An integer with thin spaces between thousands: `12 000`.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && digits.len() > 4 {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

fn minus(text: &str) -> String {
    text.replace('-', "−")
}

fn superscript(power: &str) -> String {
    let raised = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| c.to_digit(10).map_or(if c == '-' { '⁻' } else { c }, |d| raised[d as usize]);
    power.chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_the_digits_that_its_error_is_worth() {
        assert_eq!(with_error(0.901_234, 0.001_12), "0.9012 ± 0.0011");
        assert_eq!(with_error(-1.98e-4, 2.3e-6), "(−1.980 ± 0.023)·10⁻⁴");
        assert_eq!(with_error(3_600_000.0, 21_000.0), "(3.600 ± 0.021)·10⁶");
        assert_eq!(with_error(158.8, f64::INFINITY), "158.8");
        assert_eq!(with_error(0.0, 0.02), "0.000 ± 0.020");
    }

    #[test]
    fn short_numbers_are_short() {
        let cases = [(0.0, "0"), (12.0, "12"), (0.012_345, "0.01235"), (-3e-7, "−3·10⁻⁷"), (16_508.0, "16510")];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
        assert_eq!((percent(0.874), percent(0.004)), ("87 %".into(), "0.4 %".into()));
    }

    #[test]
    fn rates_and_p_values_say_what_is_true() {
        assert_eq!([rate(0.926), rate(1.0), rate(0.0), rate(0.9996)], ["92.6 %", "100 %", "0 %", "99.96 %"]);
        assert_eq!([p_words(0.0234), p_words(1e-9), p_words(1.0)], ["p = 0.023", "p < 0.0001", "p = 1"]);
        assert_eq!(p_value(1.23e-4), "0.00012");
        assert_eq!([grouped(500), grouped(1234), grouped(1_234_567)], ["500", "1234", "1\u{202f}234\u{202f}567"]);
    }
}
