//! Closed forms that need more than a line, and event-exact references: independent of the simulator and of its laws.

pub mod contensou;
pub mod impact;
pub mod oscillator;
pub mod peg;
pub mod pursuit;
pub mod slider;
pub mod stick_slip;

/// The first instant after `from` at which `g` is not positive, found by steps of `dt` and bisection to round-off; `None`
/// if there is none until `until`.
pub fn first_root(g: impl Fn(f64) -> f64, from: f64, until: f64, dt: f64) -> Option<f64> {
    let steps = ((until - from) / dt).ceil() as u64;
    let instant = |i: u64| (from + i as f64 * dt).min(until);
    let end = (1..=steps).find(|i| g(instant(*i)) <= 0.0)?;
    let (mut low, mut high) = (instant(end - 1), instant(end));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if g(middle) <= 0.0 { high = middle } else { low = middle }
    }
    Some(high)
}
