//! Difference quotients at a coarser clock.
//!
//! Sensors and commands of a rig tick far more often than its motion bends: a derivative of what an interval reads is as smooth as that motion. It is taken
//! at every k-th instant at which anything is read, k a power of two, commands replaced by their means between these, and told for the others
//! by cubics through the nearest four (Lagrange). What is linear in commands feels their mean; what switches keeps its instants.
//! How large k may be is tried on the rig itself. Dry friction has corners, of which both ends of a difference quotient make the same.

use super::forces::Force;
use super::track::{Frame, Track, coordinates};
use crate::held::holds;
use crate::linear::{Stage, Variation};
use crate::plant::Built;
use crate::replay::SAME;
use crate::tape::{CommandTape, Tape};
use nalgebra::DVector;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Instants that an interval has at least.
const FEWEST: usize = 8;
/// Changes of a command by cell from which on it is a course and not a switch.
const DENSE: f64 = 0.5;

/// Steps of derivatives that are tried, in those of predictions; in an interval of so many runs; and share of a derivative that they may move, by states and forces and by
/// numbers: a fit that goes by halves still comes to its end.
const COARSER: [f64; 3] = [8.0, 4.0, 2.0];
const TRIED: usize = 3;
const ALIKE: [f64; 2] = [0.02, 0.5];

/// A run heard and read at a coarser clock.
#[derive(Clone, Debug)]
pub struct Coarse {
    /// Its commands, each cell's mean.
    pub heard: Arc<Tape>,
    /// Longest step, s.
    pub longest: f64,
    /// Whether it is as it is judged.
    pub is_exact: bool,
    /// Instants at which anything is read, s.
    instants: Vec<f64>,
    /// Largest k, as a power of two.
    most: u32,
}

/// The events of an interval at which derivatives are taken.
#[derive(Clone, Debug, Default)]
pub struct Few {
    /// Those events.
    pub members: Vec<u32>,
    /// Where the scalars of each of these begin, and last their number.
    begins: Vec<u32>,
    /// Scalars of every event of the interval, and which of the few tell of it by which weights; nothing where all are kept.
    told: Vec<(u16, [u16; 4], [f32; 4])>,
}

/// All runs at the coarsest clock at which a model's derivatives are what they are; as they were recorded where parts touch. With some numbers their derivatives
/// count too, and all are held against exact ones, which they are where no clock will do.
pub fn of_model(
    stage: &Stage<'_>,
    (built, forces): (&Built, &[Force]),
    (runs, knots): (&[usize], usize),
    variations: &[Variation],
) -> Arc<Vec<Coarse>> {
    let fine = all_at(stage, None);
    let exact: Vec<Coarse> = fine.iter().map(|c| Coarse { is_exact: true, ..c.clone() }).collect();
    let (held_against, last) = if variations.is_empty() { (&fine, None) } else { (&exact, Some(fine.clone())) };
    let tried = || {
        let cut = |(k, run): (usize, &usize)| {
            let track = Track::cut((stage, &fine), (built, forces.len()), *run, knots).ok()?;
            Some((*run, track.intervals[(k + 1) * knots / (TRIED + 1)].clone()))
        };
        let some: Vec<_> = runs.iter().take(TRIED).enumerate().filter_map(cut).collect();
        let freedoms = coordinates(built, &some.first()?.1.start);
        let ours = Frame { stage, coarse: held_against, built, freedoms: &freedoms, forces };
        let alike = |coarse: &Vec<Coarse>| {
            let [states, numbers] = ours.differs(&Frame { coarse, ..ours }, &some, variations);
            states < ALIKE[0] && numbers < ALIKE[1]
        };
        COARSER.iter().map(|k| all_at(stage, Some(k * stage.pace.step))).chain(last).find(alike)
    };
    let found = if holds(built) { None } else { tried() };
    Arc::new(found.unwrap_or_else(|| held_against.clone()))
}

/// All runs as they are judged.
pub fn as_judged(stage: &Stage<'_>) -> Arc<Vec<Coarse>> {
    Arc::new(all_at(stage, None))
}

fn all_at(stage: &Stage<'_>, longest: Option<f64>) -> Vec<Coarse> {
    stage.tapes.iter().map(|t| Coarse::new(t, stage.pace.step, longest)).collect()
}

impl Coarse {
    /// Of a run, with steps up to a longest; none: as it is, in steps of `own`.
    pub fn new(tape: &Tape, own: f64, longest: Option<f64>) -> Self {
        let mut instants: Vec<f64> = tape.events.iter().map(|e| e.time).collect();
        instants.dedup_by(|b, a| *b - *a <= SAME);
        let Some(longest) = longest else {
            let heard = Arc::new(silent(tape, tape.commands.clone()));
            return Self { heard, longest: own, is_exact: false, instants, most: 0 };
        };
        let mut gaps: Vec<f64> = instants.windows(2).map(|w| w[1] - w[0]).collect();
        gaps.sort_by(f64::total_cmp);
        let usual = gaps.get(gaps.len() / 2).copied().unwrap_or(longest);
        let most = (longest / usual + SAME).max(1.0).log2().floor() as u32;
        let heard = Arc::new(heard(tape, &cells(&instants, 1 << most, longest)));
        Self { heard, longest, is_exact: false, instants, most }
    }

    /// Which events of an interval are kept, as few as it bears.
    pub fn few(&self, tape: &Tape, members: &[u32]) -> Few {
        let at = |m: &u32| self.instants.partition_point(|t| *t < tape.events[*m as usize].time - SAME);
        let of: Vec<usize> = members.iter().map(at).collect();
        let [first, last] = [of.iter().min(), of.iter().max()].map(|x| x.copied().unwrap_or(0));
        let clock = (1..=self.most).rev().find(|c| (last - first) >> c >= FEWEST).unwrap_or(0);
        if clock == 0 {
            return Few { members: members.to_vec(), ..Few::default() };
        }
        let mut by_reading: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, m) in members.iter().enumerate() {
            by_reading.entry(tape.events[*m as usize].reading).or_default().push(i);
        }
        let mut is_kept = vec![false; members.len()];
        for own in by_reading.values() {
            let is_sparse = own.len() >> clock < FEWEST;
            own.iter().filter(|i| is_sparse || of[**i].is_multiple_of(1 << clock)).for_each(|i| is_kept[*i] = true);
            [own.first(), own.last()].into_iter().flatten().for_each(|i| is_kept[*i] = true);
        }
        Few::new(tape, (members, &is_kept), by_reading.values())
    }
}

impl Few {
    /// Of the events of an interval those that are kept; `readings`: which of them are of one reading, in order.
    fn new<'a>(
        tape: &Tape,
        (members, is_kept): (&[u32], &[bool]),
        readings: impl Iterator<Item = &'a Vec<usize>>,
    ) -> Self {
        let width = |m: u32| tape.readings[tape.events[m as usize].reading as usize].width();
        let time = |i: usize| tape.events[members[i] as usize].time;
        let (mut few, mut begins, mut place) = (Vec::new(), vec![0], vec![0; members.len()]);
        for (i, m) in members.iter().enumerate().filter(|(i, _)| is_kept[*i]) {
            place[i] = few.len();
            few.push(*m);
            begins.push(begins[begins.len() - 1] + width(*m) as u32);
        }
        let mut told = vec![(0, [0; 4], [0.0; 4]); members.len()];
        for own in readings {
            let kept: Vec<usize> = own.iter().copied().filter(|i| is_kept[*i]).collect();
            for i in own {
                let after = kept.partition_point(|k| time(*k) < time(*i));
                let from = after.saturating_sub(2).min(kept.len().saturating_sub(4));
                let near = &kept[from..kept.len().min(from + 4)];
                let (mut places, mut weights) = ([0; 4], [0.0; 4]);
                for (k, (a, weight)) in near.iter().zip(&mut weights).enumerate() {
                    places[k] = place[*a] as u16;
                    let others = near.iter().filter(|b| *b != a);
                    *weight = others.map(|b| (time(*i) - time(*b)) / (time(*a) - time(*b))).product::<f64>() as f32;
                }
                told[*i] = (width(members[*i]) as u16, places, weights);
            }
        }
        Self { members: few, begins, told }
    }

    /// Values of all scalars of an interval from those of the few events.
    pub fn expanded(&self, few: &DVector<f64>) -> DVector<f64> {
        if self.told.is_empty() {
            return few.clone();
        }
        let count = self.told.iter().map(|t| t.0 as usize).sum();
        let mut out = DVector::zeros(count);
        let mut row = 0;
        for (width, places, weights) in &self.told {
            for axis in 0..*width as usize {
                let of = |(place, weight): (&u16, &f32)| {
                    f64::from(*weight) * few[self.begins[*place as usize] as usize + axis]
                };
                out[row] = places.iter().zip(weights).filter(|(_, w)| **w != 0.0).map(of).sum();
                row += 1;
            }
        }
        out
    }
}

/// A run's commands in cells of a length at most, each its mean.
pub(crate) fn heard_in_cells(tape: &Tape, longest: f64) -> Arc<Tape> {
    Coarse::new(tape, longest, Some(longest)).heard
}

/// Begins of cells between every k-th instant, none longer than that.
fn cells(instants: &[f64], k: usize, longest: f64) -> Vec<f64> {
    let kept: Vec<f64> = instants.iter().copied().step_by(k).collect();
    let within = |w: &[f64]| {
        let parts = ((w[1] - w[0]) / longest - 1e-6).ceil().max(1.0);
        let [from, length] = [w[0], (w[1] - w[0]) / parts];
        (0..parts as usize).map(move |i| from + i as f64 * length).collect::<Vec<_>>()
    };
    kept.windows(2).flat_map(within).chain(kept.last().copied()).collect()
}

/// What is heard of a run's commands in such cells.
fn heard(tape: &Tape, cells: &[f64]) -> Tape {
    let of = |command: &CommandTape| {
        let changes = command.changes().count();
        if (changes as f64) < DENSE * cells.len() as f64 {
            return command.clone();
        }
        let values = cells.windows(2).map(|w| command.mean(w[0], w[1]));
        let values = values.chain(cells.last().map(|t| command.mean(*t, *t))).collect();
        CommandTape { times: cells.to_vec(), values, ..*command }
    };
    silent(tape, tape.commands.iter().map(of).collect())
}

/// A run of which nothing is read.
fn silent(tape: &Tape, commands: Vec<CommandTape>) -> Tape {
    let heard = Tape::assemble((&tape.file, tape.role), commands, Vec::new());
    Tape { index: tape.index, span: tape.span, ..heard }
}

impl CommandTape {
    /// Its mean between two instants; nothing before its first tick.
    pub(crate) fn mean(&self, from: f64, to: f64) -> f64 {
        let at = |t: f64| self.times.partition_point(|x| *x <= t + SAME);
        let held = |i: usize| i.checked_sub(1).map_or(0.0, |i| self.values[i]);
        if to - from <= SAME {
            return held(at(from));
        }
        let (mut sum, mut now) = (0.0, from);
        for i in at(from)..at(to) {
            sum += held(i) * (self.times[i].min(to) - now);
            now = self.times[i].min(to);
        }
        (sum + held(at(now)) * (to - now)) / (to - from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::Facts;
    use crate::identify::forces::forces;
    use crate::noise;
    use crate::plant::Plant;
    use crate::reading::{Reading, Value};
    use crate::replay::Pace;
    use crate::tape::Commanded;
    use crate::work::Work;
    use record::Role;
    use scenario::measure::Quantity;
    use scenario::spec::{Effect, ParamValue};
    use spatial::Vec3;

    /// A joint and a body's place read every 10 ms for a second, the body's only at every second tick; a command that is a course, and one that switches.
    fn tape() -> Tape {
        let reading = |channel: &str, every: usize, axes: usize| {
            let times: Vec<f64> = (0..=100).step_by(every).map(|i| 0.01 * i as f64).collect();
            let values = times.iter().map(|_| Value::Vector(Vec3::zeros())).collect();
            let quantity = Quantity::JointPosition(0);
            Reading {
                channel: channel.to_owned(),
                quantity,
                axes: (0..axes).collect(),
                sigma: 1.0,
                times,
                values,
                rounding: 0.0,
                blur: Vec::new(),
                late_s: 0.0,
            }
        };
        let command = |actuator, changes: usize, value: fn(f64) -> f64| {
            let times: Vec<f64> = (0..changes).map(|i| i as f64 / changes as f64).collect();
            CommandTape { actuator, what: Commanded::Effort, values: times.iter().map(|t| value(*t)).collect(), times }
        };
        let commands = vec![command(0, 500, |t| t), command(1, 2, |t| if t > 0.4 { 1.0 } else { -1.0 })];
        Tape::assemble(("run-01.csv", Role::Fit), commands, vec![reading("a", 1, 1), reading("b", 2, 3)])
    }

    #[test]
    fn what_few_events_tell_of_a_cubic_is_that_cubic() {
        let tape = tape();
        let coarse = Coarse::new(&tape, 0.002, Some(0.04));
        let members: Vec<u32> = (0..tape.events.len() as u32).collect();
        let few = coarse.few(&tape, &members);
        assert!(few.members.len() < members.len() / 2, "{} of {}", few.members.len(), members.len());
        let cubic = |event: &crate::tape::Event| {
            let t = event.time;
            let width = tape.readings[event.reading as usize].width();
            (0..width)
                .map(move |axis| 1.0 + (2.0 + axis as f64) * t - 3.0 * t * t + 0.5 * t * t * t)
                .collect::<Vec<_>>()
        };
        let of =
            |members: &[u32]| -> Vec<f64> { members.iter().flat_map(|m| cubic(&tape.events[*m as usize])).collect() };
        let told = few.expanded(&DVector::from_vec(of(&few.members)));
        assert!((told - DVector::from_vec(of(&members))).amax() < 1e-6, "weights have single precision");
    }

    #[test]
    fn a_short_interval_keeps_all_its_events() {
        let tape = tape();
        let members: Vec<u32> = (20..34).collect();
        let few = Coarse::new(&tape, 0.002, Some(0.04)).few(&tape, &members);
        assert_eq!(few.members, members);
        let read = DVector::from_fn(5, |i, _| i as f64);
        assert_eq!(few.expanded(&read), read);
    }

    #[test]
    fn a_course_is_heard_as_its_means_and_a_switch_as_it_is() {
        let tape = tape();
        let coarse = Coarse::new(&tape, 0.002, Some(0.04));
        let [course, switch] = &coarse.heard.commands[..] else { panic!("two commands") };
        assert_eq!((switch.times.len(), course.times.len()), (2, 26), "{:?}", course.times);
        // The means of a ramp that climbs in steps of 2 ms, each told from its begin.
        for (t, mean) in course.times.iter().zip(&course.values).take(25) {
            assert!((mean - (t + 0.02 - 0.001)).abs() < 1e-9, "{t}: {mean}");
        }
        assert_eq!(coarse.heard.span, tape.span);
    }

    /// A bench's arm that reads all joints every 4 ms; a spring at a wrist rings at some hundred rad/s where its damper is weak.
    #[test]
    fn a_spring_that_rings_asks_for_a_finer_clock_than_its_rig() {
        const STEP: f64 = 2e-3;
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/rigs/arm-bench.toml");
        let mut plant = Plant::new(scenario::load(file.as_ref(), &[]).expect("the scenario is in the repository"));
        plant.channels = (1..=7).map(|j| format!("joint.joint_{j}.position")).collect();
        let elastic = |damping: f64| {
            let number = |key: &str, x: f64| (key.to_owned(), ParamValue::Number(x));
            let params = BTreeMap::from([number("k", 900.0), number("d", damping)]);
            Effect { name: "joint-elasticity".to_owned(), place: "joint:joint_6".to_owned(), params }
        };
        let rig = plant.build(&[]).expect("it builds");
        let reading = |channel: &String| Reading {
            channel: channel.clone(),
            quantity: rig.sensor(channel).expect("it is measured").0.quantity(),
            axes: vec![0],
            sigma: 2e-5,
            times: (0..=500).map(|i| 4e-3 * i as f64).collect(),
            values: vec![Value::Vector(Vec3::zeros()); 501],
            rounding: 0.0,
            blur: Vec::new(),
            late_s: 0.0,
        };
        let tapes = vec![Tape::assemble(("run", Role::Fit), Vec::new(), plant.channels.iter().map(reading).collect())];
        let work = Work::new(&(), 1.0);
        let stage = Stage { tapes: &tapes, pace: Pace::even(STEP), work: &work, doubt: noise::STATED, hears: None };
        let forces = forces(&Facts::new(&rig, &tapes));
        let clock = |built: &Built, numbers: &[Variation]| {
            let all = of_model(&stage, (built, &forces), (&[0], 16), numbers);
            if all[0].is_exact { 0.0 } else { all[0].longest }
        };
        let alone = clock(&rig, &[]);
        assert!(alone >= 2.0 * STEP, "{alone} s");
        let built = plant.build(&[elastic(0.8)]).expect("it builds");
        let by_damping = plant.build(&[elastic(0.81)]).expect("it builds");
        let number = Variation { built: by_damping, step: 0.01, is_tolerated: false };
        let ringing = clock(&built, &[number]);
        assert!(ringing < alone, "{ringing} s beside {alone} s");
    }
}
