//! Faults of sensors.

use super::hypothesis;
use crate::facts::SensorFact;
use crate::hypothesis::{Coordinate, Hypothesis};
use scenario::measure::Quantity;

const BIAS: [&str; 3] = ["bias[0]", "bias[1]", "bias[2]"];
const ANGLE: [&str; 3] = ["angle[0]", "angle[1]", "angle[2]"];

pub(super) fn add(sensor: &SensorFact, all: &mut Vec<Hypothesis>) {
    let place = format!("sensor:{}", sensor.channel);
    let place = place.as_str();
    let scalar = sensor.quantity.is_joint();
    let orientation = matches!(sensor.quantity, Quantity::Orientation(..));
    if scalar {
        all.push(hypothesis("sensor-bias", place, vec![Coordinate::free("bias", 0.0)]).screened(&[(0, sensor.sigma)]));
    } else if !orientation {
        let bias = (0..3).map(|k| Coordinate::free(BIAS[k], 0.0)).collect();
        let columns: Vec<(usize, f64)> = sensor.axes.iter().map(|k| (*k, sensor.sigma)).collect();
        all.push(hypothesis("sensor-bias", place, bias).screened(&columns));
    }
    if !orientation {
        all.push(hypothesis("sensor-scale", place, vec![Coordinate::free("scale", 1.0)]).screened(&[(0, 1e-4)]));
    }
    if !scalar {
        let angle = (0..3).map(|k| Coordinate::free(ANGLE[k], 0.0)).collect();
        let free: Vec<usize> = if sensor.axes.len() == 3 { vec![0, 1, 2] } else { vec![2] };
        let columns: Vec<(usize, f64)> = free.iter().map(|k| (*k, 1e-5)).collect();
        all.push(hypothesis("sensor-misalignment", place, angle).screened(&columns));
    }
    let delay = vec![Coordinate { bounds: [-0.2, 0.5], ..Coordinate::free("delay", 0.0) }];
    all.push(hypothesis("sensor-delay", place, delay).screened(&[(0, 1e-4)]));
}
