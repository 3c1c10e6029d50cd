use super::*;
use crate::plant::Plant;
use crate::reading::Reading;
use crate::tape::{CommandTape, Commanded};
use record::Role;
use scenario::spec::{Effect, ParamValue};
use spatial::Twist;

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/rigs/dock-impact.toml");

/// Two channels of a chaser that meets its target after 0.3 s.
pub(crate) fn docking() -> (Built, Tape, Start) {
    let mut plant = Plant::new(scenario::load(FILE.as_ref(), &[]).expect("the scenario is in the repository"));
    plant.channels = vec!["body.chaser.position".to_owned(), "sensor.probe.force".to_owned()];
    let built = plant.build(&[]).expect("it builds");
    let reading = |channel: &str, rate: f64| {
        let (gauge, _) = built.sensor(channel).expect("it is measured");
        let times: Vec<f64> = (0..=(0.7 * rate) as usize).map(|i| i as f64 / rate).collect();
        let values = vec![Value::Vector(Vec3::zeros()); times.len()];
        let channel = channel.to_owned();
        Reading {
            channel,
            quantity: gauge.quantity(),
            axes: vec![0, 1, 2],
            sigma: 1.0,
            rounding: 0.0,
            times,
            values,
            blur: Vec::new(),
            late_s: 0.0,
        }
    };
    let readings = vec![reading("body.chaser.position", 250.0), reading("sensor.probe.force", 2000.0)];
    let tape = Tape::assemble(("docking", Role::Fit), Vec::new(), readings);
    let mut start = Start::nominal(&built);
    start.bases[0].translation.vector.x = -2.115;
    start.twists = vec![Twist::new(Vec3::zeros(), Vec3::new(0.085, 1.7e-3, 8.5e-4)), Twist::default()];
    (built, tape, start)
}

#[test]
fn a_flight_that_no_force_sensor_cuts_reads_the_same() {
    let (built, tape, start) = docking();
    let span = Span { from: 0.0, to: 0.7 };
    let read = |free: f64| {
        readings(&built, &tape, &tape, &start, span, Pace { step: 2.5e-4, ..Pace::even(free) }).expect("it runs").values
    };
    let (short, long) = (read(2.5e-4), read(16e-3));
    let norm = |m: &Measured| if let Measured::Vector(v) = m { v.norm() } else { f64::NAN };
    let forces = |all: &[Measured]| {
        let of_force = all.iter().zip(&tape.events).filter(|(_, e)| e.reading == 1);
        of_force.map(|(m, _)| norm(m)).collect::<Vec<f64>>()
    };
    let (a, b) = (forces(&short), forces(&long));
    let peak = a.iter().copied().fold(0.0, f64::max);
    assert!(peak > 100.0, "the probe touched: {peak} N");
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-5 * peak && (*a == 0.0) == (*b == 0.0)));
    assert!(a[..100].iter().all(|f| *f == 0.0), "it flew before");
}

/// A sensor that is late tells of what was before a window at its begin: that is no residual, and nothing else is changed.
#[test]
fn what_is_told_of_before_a_window_is_no_residual_of_it() {
    let (built, tape, start) = docking();
    let late = 0.01;
    let readings: Vec<Reading> = tape.readings.iter().map(|r| Reading { late_s: late, ..r.clone() }).collect();
    let masked = Tape { readings, ..tape.clone() };
    let span = Span { from: 0.0, to: 0.2 };
    let read = super::readings(&built, &tape, &tape, &start, span, Pace::even(2.5e-4)).expect("it runs").values;
    let residuals = |tape: &Tape| residuals_of(&read, &built, tape, span).expect("all are measured");
    let (all, judged) = (residuals(&tape), residuals(&masked));
    let of_events = tape.events[tape.range(span)].iter().flat_map(|e| [e.time; 3]);
    let mut unheard = 0;
    for ((time, a), b) in of_events.zip(&all).zip(&judged) {
        assert_eq!(*b, if time < late { 0.0 } else { *a });
        unheard += usize::from(time < late && *a != 0.0);
    }
    assert!(unheard > 0, "the chaser is somewhere");
}

#[test]
fn a_long_step_in_flight_passes_what_is_read() {
    let (built, tape, start) = docking();
    let span = Span { from: 0.0, to: 0.7 };
    let pace = Pace { step: 2.5e-4, ..Pace::even(16e-3) };
    let events = events_in(&tape, span, &sensors_of(&built, &tape).expect("all are measured"));
    let mut replay = Replay::new(&built, &tape, &start, span.from, pace);
    replay.advance_to(1e-3).expect("it runs");
    let ahead: Vec<(usize, Event)> = events.into_iter().filter(|(_, e)| e.time > 1e-3).collect();
    let mut places = Vec::new();
    let passed = replay.glide(&ahead, |_| true, |k, world| places.push((ahead[k].1.time, world.frame(0).pos)));
    // 16 ms of a sensor at 2 kHz, and of one at 250 Hz.
    assert_eq!((passed.expect("it runs"), places.len()), (36, 36));
    let steps = replay.world.state().work.steps;
    for (time, seen) in places {
        let mut short = Replay::new(&built, &tape, &start, span.from, Pace::even(2.5e-4));
        short.advance_to(time).expect("it runs");
        let off = (short.world.frame(0).pos - seen).norm();
        assert!(off < 1e-12 && (short.world.state().time - time).abs() < 1e-12, "{off:e} m at {time}");
    }
    // What stands before it leaves room for no long step.
    let near = touches_in(&built, &tape, &start, span, Pace::even(2.5e-4))[0].from - 2e-3;
    replay.advance_to(near).expect("it runs");
    let ahead: Vec<(usize, Event)> = ahead.into_iter().filter(|(_, e)| e.time > near).collect();
    replay.reach = pace.free;
    assert_eq!(replay.glide(&ahead, |_| true, |_, _| ()).expect("it runs"), 0);
    assert!(steps <= 3, "{steps} steps");
}

#[test]
fn what_swings_by_itself_is_resolved_whatever_the_steps() {
    let (nominal, ..) = docking();
    let mut plant = Plant::new(scenario::load(FILE.as_ref(), &[]).expect("the scenario is in the repository"));
    plant.channels = nominal.sensors.iter().map(|(channel, ..)| channel.clone()).collect();
    let effect = |name: &str, place: &str, numbers: &[(&str, f64)]| {
        let params = numbers.iter().map(|(k, x)| ((*k).to_owned(), ParamValue::Number(*x))).collect();
        plant.build(&[Effect { name: name.to_owned(), place: place.to_owned(), params }]).expect("it builds")
    };
    let mount = effect("mount-compliance", "contact:probe/drogue", &[("k", 8e5), ("d", 260.0), ("m", 0.8)]);
    let pace = Pace { step: 4e-3, ..Pace::even(0.1) };
    assert_eq!(pace.resolving(&nominal), pace);
    // ω = 1000 rad/s: in contact a phase of one at most; in flight it is held.
    let found = pace.resolving(&mount);
    assert!((found.step - 1e-3).abs() < 1e-9 && found.free == pace.free, "{found:?}");
}

#[test]
fn a_flight_with_a_mount_at_rest_reads_the_same() {
    let (nominal, tape, start) = docking();
    let mut plant = Plant::new(scenario::load(FILE.as_ref(), &[]).expect("the scenario is in the repository"));
    plant.channels = nominal.sensors.iter().map(|(channel, ..)| channel.clone()).collect();
    let numbers = [("k", 1.6e5), ("d", 260.0), ("m", 0.8)];
    let params = numbers.map(|(name, x)| (name.to_owned(), ParamValue::Number(x))).into();
    let place = "contact:probe/drogue".to_owned();
    let built = plant.build(&[Effect { name: "mount-compliance".to_owned(), place, params }]).expect("it builds");
    let span = Span { from: 0.0, to: 0.7 };
    let fill = |start: &Start| Start { q: vec![0.0; 3], v: vec![0.0; 3], ..start.clone() };
    let read = |free: f64| {
        readings(&built, &tape, &tape, &fill(&start), span, Pace { step: 2.5e-4, ..Pace::even(free) })
            .expect("it runs")
            .values
    };
    let (short, long) = (read(2.5e-4), read(16e-3));
    let (mut off, mut peak) = (0.0_f64, 0.0_f64);
    for ((a, b), event) in short.iter().zip(&long).zip(&tape.events) {
        let (Measured::Vector(a), Measured::Vector(b)) = (a, b) else { panic!("forces and places are vectors") };
        if event.reading == 1 {
            (off, peak) = (off.max((a - b).norm()), peak.max(a.norm()));
        } else {
            assert!((a - b).norm() < 1e-9, "{:e} m at {}", (a - b).norm(), event.time);
        }
    }
    assert!(peak > 100.0, "the probe touched: {peak} N");
    // A hundredth of the sensor's noise, here 1 N, is what a mount at rest may leave unsaid.
    assert!(off > 0.0 && off < 1e-2, "{off:e} N");
}

#[test]
fn touches_are_told_by_the_stretches_between_samples() {
    let (built, tape, start) = docking();
    let span = Span { from: 0.0, to: 0.7 };
    let touches = touches_in(&built, &tape, &start, span, Pace { step: 2.5e-4, ..Pace::even(16e-3) });
    assert!(touches.len() == 1 && touches[0].from > 0.1 && touches[0].to < 0.7, "{touches:?}");
    let before = Span { from: 0.0, to: touches[0].from };
    assert!(touches_in(&built, &tape, &start, before, Pace::even(2.5e-4)).is_empty());
}

#[test]
fn what_is_handed_on_at_a_tick_remembers_what_the_drive_gave() {
    const SWING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/rigs/swing.toml");
    let mut plant = Plant::new(scenario::load(SWING.as_ref(), &[]).expect("the scenario is in the repository"));
    plant.channels = vec!["joint.hinge.velocity".to_owned()];
    let lag = Effect {
        name: "actuator-lag".to_owned(),
        place: "joint:hinge".to_owned(),
        params: [("time_constant".to_owned(), ParamValue::Number(0.02))].into(),
    };
    let built = plant.build(&[lag]).expect("it builds");
    let (gauge, _) = built.sensor("joint.hinge.velocity").expect("it is measured");
    let times: Vec<f64> = (0..=200).map(|i| f64::from(i) * 5e-3).collect();
    let values = vec![Value::Vector(Vec3::zeros()); times.len()];
    let channel = "joint.hinge.velocity".to_owned();
    let reading = Reading {
        channel,
        quantity: gauge.quantity(),
        axes: vec![0],
        sigma: 1.0,
        rounding: 0.0,
        times,
        values,
        blur: Vec::new(),
        late_s: 0.0,
    };
    // A torque that changes its sign with every tick of 10 ms.
    let ticks: Vec<f64> = (0..100).map(|i| f64::from(i) * 1e-2).collect();
    let values = (0..100).map(|i| if i % 2 == 0 { 2.0 } else { -1.0 }).collect();
    let commands = vec![CommandTape { actuator: 0, what: Commanded::Effort, times: ticks, values }];
    let tape = Tape::assemble(("swing", Role::Fit), commands, vec![reading]);
    let (start, pace) = (Start::nominal(&built), Pace::even(1e-3));
    let read = |start: &Start, from: f64| {
        readings(&built, &tape, &tape, start, Span { from, to: 1.0 }, pace).expect("it runs").values
    };
    let whole = read(&start, 0.0);
    let handed = starts_along(&built, &tape, &start, pace, &[0.0, 0.5]).expect("it runs");
    let rest = read(&handed[1], 0.5);
    let scalar = |m: &Measured| if let Measured::Scalar(v) = m { *v } else { f64::NAN };
    for (a, b) in whole[100..].iter().zip(&rest) {
        assert!((scalar(a) - scalar(b)).abs() < 1e-12, "{a:?} and {b:?}");
    }
    let shown = whole[100..].iter().map(|m| scalar(m).abs()).fold(0.0, f64::max);
    assert!(rest.len() == 101 && shown > 0.01, "it moves: {shown} rad/s");
}
