//! Small numbers in a unit of their own: the viewer's axes write 0.000 000 000 000 01, and `1e-15` in the unit reads
//! better. The unit is part of the entity's path and of the plot's title, so no number loses its meaning.

use crate::Log;
use std::borrow::Cow;

/// Axes whose largest value is below this get a smaller unit.
const SMALL: f64 = 1e-4;

/// The log with signals in units in which they are neither all zero to the eye nor all zeros to read.
pub(super) fn readable(log: &Log) -> Cow<'_, Log> {
    let mut readable = Cow::Borrowed(log);
    for axes in log.signals.axes() {
        let values = axes.channels.iter().flat_map(|&i| &log.signals.channels[i].values);
        let peak = values.filter(|v| v.is_finite()).fold(0.0, |peak: f64, v| peak.max(v.abs()));
        if peak <= f64::MIN_POSITIVE || peak >= SMALL {
            continue;
        }
        let exponent = 3 * (peak.log10() / 3.0).floor() as i32;
        for &i in &axes.channels {
            let channel = &mut readable.to_mut().signals.channels[i];
            channel.spec.unit = small_unit(exponent, &axes.unit);
            channel.values.iter_mut().for_each(|v| *v /= 10_f64.powi(exponent));
        }
    }
    readable
}

fn small_unit(exponent: i32, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { format!("1e{exponent}") } else { format!("1e{exponent} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ChannelSpec, Meta, Plot, RecordError, Sample};

    #[test]
    fn drift_of_1e_14_is_shown_in_1e_15_and_large_numbers_stay() -> Result<(), RecordError> {
        let specs = vec![
            ChannelSpec::new("momentum.linear_drift", "1", Plot::Momentum),
            ChannelSpec::new("contact.force", "N", Plot::Contact),
            ChannelSpec::new("contact.slip", "m", Plot::Contact),
        ];
        let mut log = Log::new(Meta::default(), specs, 0);
        log.push(&Sample { t: 0.0, step: 0, values: &[1.2e-14, 400.0, 7.9e-7], poses_w: &[], contacts: &[] })?;
        let shown = readable(&log);
        let units: Vec<&str> = shown.signals.channels.iter().map(|c| c.spec.unit.as_str()).collect();
        assert_eq!(units, ["1e-15", "N", "1e-9 m"]);
        assert!((shown.signals.channels[0].values[0] - 12.0).abs() < 1e-9);
        assert_eq!(shown.signals.channels[1].values[0], 400.0);
        Ok(())
    }
}
