//! Recorded commands, as a replay hears them.

use crate::replay::SAME;
use crate::tape::{Commanded, Tape};
use sim::World;

/// The commands that act now, and when they change.
pub(crate) struct Feed<'a> {
    tape: &'a Tape,
    tick: usize,
    at: Vec<usize>,
}

impl<'a> Feed<'a> {
    pub(crate) fn new(tape: &'a Tape, time: f64) -> Self {
        let passed = |times: &[f64]| times.partition_point(|t| *t <= time + SAME);
        Self { tape, tick: passed(&tape.ticks), at: tape.commands.iter().map(|c| passed(&c.times)).collect() }
    }

    pub(crate) fn next_tick(&self, tape: &Tape) -> f64 {
        tape.ticks.get(self.tick).copied().unwrap_or(f64::INFINITY)
    }

    pub(crate) fn turn(&mut self, tape: &Tape, time: f64) {
        self.tick = tape.ticks.partition_point(|t| *t <= time + SAME);
        for (at, command) in self.at.iter_mut().zip(&tape.commands) {
            while *at < command.times.len() && command.times[*at] <= time + SAME {
                *at += 1;
            }
        }
    }

    pub(crate) fn apply(&self, world: &mut World) {
        for (at, command) in self.at.iter().zip(&self.tape.commands) {
            let value = at.checked_sub(1).map_or(0.0, |i| command.values[i]);
            let commanded = &mut world.commands_mut()[command.actuator];
            match command.what {
                Commanded::Effort => commanded.effort = value,
                Commanded::Position => commanded.position = value,
                Commanded::Velocity => commanded.velocity = value,
            }
        }
    }
}
