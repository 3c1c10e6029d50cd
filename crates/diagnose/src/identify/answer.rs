//! Whether derivatives that are known are still those of an interval.

use super::track::{Frame, Interval, Link, Track, told};
use crate::held::holds;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// Share of an answer that may be another than derivatives say, and how many times its first step a coordinate is moved at most.
const ANSWERS: f64 = 0.05;
const STRONGER: f64 = 1e3;

impl Frame<'_> {
    /// Derivatives of all intervals of a run, taken anew where known ones are no more what they were: a joint that holds by now, or no more, answers otherwise.
    pub(super) fn links_where_changed(&self, track: &Track, known: &Arc<Vec<Link>>) -> Option<Arc<Vec<Link>>> {
        let is_known =
            |(interval, link): (&Interval, &Link)| self.answers_as(track.run, interval, link).unwrap_or(false);
        let is_known: Vec<bool> = track.intervals.par_iter().zip(known.as_slice()).map(is_known).collect();
        if !is_known.contains(&false) {
            return Some(Arc::clone(known));
        }
        let of =
            |i: usize| if is_known[i] { Some(known[i].clone()) } else { self.link(track.run, &track.intervals[i]) };
        (0..is_known.len()).into_par_iter().map(of).collect::<Option<_>>().map(Arc::new)
    }

    /// Whether an interval answers to all its coordinates and forces at once, each moved by as much as shows alike, as derivatives say.
    fn answers_as(&self, run: usize, interval: &Interval, link: &Link) -> Option<bool> {
        let sizes = |columns: &DMatrix<f64>, own: &dyn Fn(usize) -> f64| -> DVector<f64> {
            let shown: Vec<f64> = columns.column_iter().enumerate().map(|(k, c)| c.norm() * own(k)).collect();
            let most = shown.iter().copied().fold(0.0, f64::max);
            let by = |k: usize| own(k) * (most / shown[k].max(f64::MIN_POSITIVE)).clamp(1.0, STRONGER);
            DVector::from_iterator(shown.len(), (0..shown.len()).map(by))
        };
        let state = sizes(&link.s, &|k| self.freedoms[k].first_step());
        let force = sizes(&link.f, &|j| self.forces[j].size);
        let moved = Interval { force: &interval.force + &force, ..interval.clone() };
        let (r, end) = self.glance(self.built, run, interval, &interval.start)?;
        let start = interval.start.retract(self.freedoms, state.as_slice());
        let (q, e) = self.glance(self.built, run, &moved, &start)?;
        let read = told(!holds(self.built), interval, q - r);
        let ends = &link.s * DVector::from_vec(e.difference(&end, self.freedoms));
        let (read_by, ends_by) = (&link.s * &state + &link.f * &force, &link.s * (&link.a * &state + &link.b * &force));
        let far = (&read - &read_by).norm_squared() + (&ends - &ends_by).norm_squared();
        Some(far < ANSWERS.powi(2) * (read_by.norm_squared() + ends_by.norm_squared()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::Facts;
    use crate::identify::coarse::of_model;
    use crate::identify::forces::forces;
    use crate::identify::track::coordinates;
    use crate::linear::Stage;
    use crate::noise;
    use crate::plant::{Built, Plant};
    use crate::reading::{Reading, Value};
    use crate::replay::Pace;
    use crate::tape::Tape;
    use crate::work::Work;
    use record::Role;
    use scenario::spec::{Effect, ParamValue};
    use spatial::Vec3;

    const RIG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/rigs/swing.toml");
    /// N m: what slides loses a tenth of its rate in an interval.
    const LEVEL: f64 = 0.5;

    /// The angle and the rate of the hinge, read a hundred times a second: it rests for a second and turns on from there.
    fn tape(built: &Built) -> Tape {
        let of = |channel: &str, at: fn(f64) -> f64| {
            let times: Vec<f64> = (0..=200).map(|i| 0.01 * f64::from(i)).collect();
            let values = times.iter().map(|t| Value::Vector(Vec3::ith(0, at(*t)))).collect();
            let quantity = built.sensor(channel).expect("it is measured").0.quantity();
            let channel = channel.to_owned();
            Reading {
                channel,
                quantity,
                axes: vec![0],
                sigma: 1e-3,
                rounding: 0.0,
                times,
                values,
                blur: Vec::new(),
                late_s: 0.0,
            }
        };
        let turned = |t: f64| 4.0 * (t - 1.0).max(0.0);
        let readings =
            vec![of("joint.hinge.position", turned), of("joint.hinge.velocity", |t| 4.0 * f64::from(t > 1.0))];
        Tape::assemble(("swing", Role::Fit), Vec::new(), readings)
    }

    /// Where dry friction holds a rate is lost at once, and where it slides it goes on as without.
    #[test]
    fn derivatives_are_taken_anew_where_a_joint_holds_by_now() {
        let mut plant = Plant::new(scenario::load(RIG.as_ref(), &[]).expect("the rig is in the repository"));
        plant.channels = ["position", "velocity"].map(|what| format!("joint.hinge.{what}")).to_vec();
        let free = plant.build(&[]).expect("it builds");
        let level = [("c".to_owned(), ParamValue::Number(LEVEL))];
        let friction = Effect {
            name: "joint-coulomb-friction".to_owned(),
            place: "joint:hinge".to_owned(),
            params: level.into_iter().collect(),
        };
        let held = plant.build(&[friction]).expect("it builds");
        let (tapes, work) = (vec![tape(&free)], Work::new(&(), 1.0));
        let stage = Stage { tapes: &tapes, pace: Pace::even(1e-3), work: &work, doubt: noise::STATED, hears: None };
        let forces = forces(&Facts::new(&free, &tapes));
        let coarse = of_model(&stage, (&free, &forces), (&[0], 8), &[]);
        let track = Track::cut((&stage, &coarse), (&free, forces.len()), 0, 8).expect("it is sampled");
        let freedoms = coordinates(&free, &track.intervals[0].start);
        let of = |built| Frame { stage: &stage, coarse: &coarse, built, freedoms: &freedoms, forces: &forces };
        let known = Arc::new(of(&free).links(&track).expect("it swings"));
        let same = of(&free).links_where_changed(&track, &known).expect("it swings");
        assert!(known.iter().zip(same.iter()).all(|(a, b)| a.a == b.a && a.s == b.s), "nothing has changed");
        let (with, without) = (of(&held), of(&free));
        let track = with.carried(&track, without.built);
        let before = work.total().replays;
        let anew = with.links_where_changed(&track, &known).expect("it holds and slides");
        let changed: Vec<bool> = known.iter().zip(anew.iter()).map(|(a, b)| a.a != b.a).collect();
        assert_eq!(changed, [true, true, true, true, false, false, false, false]);
        let rate = freedoms.iter().position(crate::start::Freedom::is_rate).expect("the hinge turns");
        assert!(known[1].a[(rate, rate)] > 0.9 && anew[1].a[(rate, rate)].abs() < 0.3);
        let derivatives = (freedoms.len() + forces.len() + 1) as u64;
        assert_eq!(work.total().replays - before, 8 * 2 + 4 * derivatives, "two replays to test one, and what fails");
    }
}
