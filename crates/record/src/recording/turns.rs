//! Angles that begin anew after a full turn, made continuous.
//!
//! Encoders and arc tangents tell an angle up to whole turns. Where all values lie within one turn and some neighbours are nearly a turn apart, the
//! joint went on: at each jump of more than half a turn the nearer of the two angles is taken.

use std::f64::consts::{PI, TAU};

/// Share of a turn by which values of one turn may exceed it: noise at its ends.
const SLACK: f64 = 0.01;
/// Jump that no motion makes from one sample to the next, turns.
const JUMP: f64 = 0.75;

/// Unwinds the samples of an angle; how many times it had begun anew.
pub(super) fn unwind(values: &mut [f64]) -> usize {
    let ends = values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    let begins_anew = values.windows(2).any(|w| (w[1] - w[0]).abs() > JUMP * TAU);
    if !begins_anew || ends[1] - ends[0] > (1.0 + SLACK) * TAU {
        return 0;
    }
    let (mut turns, mut times) = (0.0, 0);
    let mut before = values[0];
    for value in values {
        let step = *value - before;
        before = *value;
        if step.abs() > PI {
            turns -= step.signum();
            times += 1;
        }
        *value += TAU * turns;
    }
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrapped(angle: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let true_angles: Vec<f64> = (0..400).map(|i| angle(0.01 * f64::from(i))).collect();
        let read = true_angles.iter().map(|q| (q + PI).rem_euclid(TAU) - PI).collect();
        (true_angles, read)
    }

    #[test]
    fn a_joint_that_turns_on_and_back_is_where_it_went() {
        let (angles, mut read) = wrapped(|t| 9.0 * (1.3 * t).sin());
        assert_eq!(unwind(&mut read), 3);
        assert!(angles.iter().zip(&read).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn what_stays_within_a_turn_or_goes_on_by_itself_is_left_as_it_is() {
        for amplitude in [2.9, 12.0] {
            let mut angles: Vec<f64> = (0..400).map(|i| amplitude * (0.05 * f64::from(i)).sin()).collect();
            let known = angles.clone();
            assert_eq!((unwind(&mut angles), angles), (0, known));
        }
        assert_eq!(unwind(&mut []), 0);
    }

    #[test]
    fn noise_at_the_seam_leaves_no_turns_behind() {
        let mut read: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { PI - 1e-3 } else { 1e-3 - PI }).collect();
        assert_eq!(unwind(&mut read), 99);
        assert!(read.iter().all(|q| (q - PI).abs() < 2e-3));
    }
}
