//! Numbers for a reader, beside those of every page: what only a diagnosis tells.

pub(crate) use record::page::number::{digits, short, with_error};

/// An error in units of noise: three decimals near 1, fewer above.
pub(crate) fn noise(x: f64) -> String {
    match x {
        x if !x.is_finite() => "–".to_owned(),
        x if x < 10.0 => format!("{x:.3}"),
        x if x < 1e5 => digits(x, 3),
        x => digits(x, 2),
    }
}

/// A share in per cent: `87 %`, `0.4 %`; what is not zero is not told as zero.
pub(crate) fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "–".to_owned();
    }
    let x = 100.0 * share;
    if x.abs() < 1.0 && x != 0.0 { format!("{x:.1} %") } else { format!("{x:.0} %") }
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
        assert_eq!(with_error(-1e-9, 8.47), "0.0 ± 8.5");
    }

    #[test]
    fn short_numbers_are_short() {
        let cases = [(0.0, "0"), (12.0, "12"), (0.012_345, "0.01235"), (-3e-7, "−3·10⁻⁷"), (16_508.0, "16510")];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
        assert_eq!((noise(1.0031), noise(246.67), noise(f64::NAN)), ("1.003".into(), "247".into(), "–".into()));
        assert_eq!((percent(0.874), percent(0.004)), ("87 %".into(), "0.4 %".into()));
    }
}
