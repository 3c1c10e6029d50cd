//! Samples that were not taken when their stamps say: noise along the motion, in proportion to the speed.

use crate::reading::{Reading, Value};
use crate::tape::Tape;
use record::Role;
use record::inspect::{duration, speeds, stamp_jitter};
use spatial::Vec3;
use std::collections::BTreeSet;

/// The runs with what jittering stamps do to each sample, where a channel shows that in the runs to be fitted; and by how much they do, in words.
pub(crate) fn with_jitter(mut tapes: Vec<Tape>) -> (Vec<Tape>, Vec<String>) {
    let channels: BTreeSet<String> = tapes.iter().flat_map(|t| &t.readings).map(|r| r.channel.clone()).collect();
    let mut said = Vec::new();
    for channel in channels {
        let fitted = tapes.iter().filter(|t| t.role == Role::Fit).flat_map(|t| &t.readings);
        let own: Vec<&Reading> = fitted.filter(|r| r.channel == channel).collect();
        let parts: Vec<(&[f64], Vec<f64>)> =
            own.iter().flat_map(|r| components(r).into_iter().map(|part| (&r.times[..], part))).collect();
        let parts: Vec<(&[f64], &[f64])> = parts.iter().map(|(times, part)| (*times, &part[..])).collect();
        let Some(jitter) = stamp_jitter(&parts) else { continue };
        for reading in tapes.iter_mut().flat_map(|t| &mut t.readings).filter(|r| r.channel == channel) {
            reading.blur = velocities(reading).into_iter().map(|v| v * (jitter / reading.sigma)).collect();
        }
        let how = "the faster it moves, the less sure it is";
        said.push(format!("{channel}: its stamps jitter by {} (1 sigma): {how}.", duration(jitter)));
    }
    (tapes, said)
}

/// Each component that was sampled. None of an orientation: how unsure a component of its quaternion is hangs on where it points.
fn components(reading: &Reading) -> Vec<Vec<f64>> {
    let of_vector = |axis: &usize| reading.values.iter().map(|v| vector(v)[*axis]).collect();
    if reading.is_orientation() { Vec::new() } else { reading.axes.iter().map(of_vector).collect() }
}

/// Rate of change at each sample.
fn velocities(reading: &Reading) -> Vec<Vec3> {
    let of: Vec<Vec<f64>> = components(reading).iter().map(|part| speeds(&reading.times, part)).collect();
    let at = |i: usize| {
        let mut v = Vec3::zeros();
        reading.axes.iter().zip(&of).for_each(|(axis, part)| v[*axis] = part[i]);
        v
    };
    (0..reading.times.len()).map(at).collect()
}

fn vector(value: &Value) -> Vec3 {
    if let Value::Vector(v) = value { *v } else { Vec3::repeat(f64::NAN) }
}
