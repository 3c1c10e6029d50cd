//! The run loop: sense, control, step, observe.
//!
//! A controller is told what is known and writes commands; what it remembers lives in [`crate::State::controller`], what its sensors and its
//! navigation remember in [`crate::State::perception`], so that a snapshot is complete. An observer only looks. All are called at fixed
//! numbers of steps, never at a clock.

use super::World;
use crate::error::StepError;
use crate::parts::Command;
use std::sync::Arc;

/// Guidance and control: a function of what is known and of its own memory.
pub trait Controller {
    /// Steps between two calls; at least 1.
    fn period_steps(&self) -> u64 {
        1
    }

    /// Writes the commands that act until the next call. `memory` starts empty and is part of the state.
    fn command(&self, known: &Known<'_>, memory: &mut Vec<f64>, commands: &mut [Command]);
}

/// What a controller knows.
#[derive(Clone, Copy, Debug)]
pub struct Known<'a> {
    /// The world: as it is where knowledge is perfect, else as navigation makes it out. Of a world that is made out, only poses, joints,
    /// rates and what mechanisms tell of themselves mean anything: nothing touches in it.
    pub world: &'a World,
    /// Whether `world` is the truth.
    pub is_perfect: bool,
    /// Whether navigation has made out what it is asked for; true where knowledge is perfect.
    pub is_ready: bool,
    /// The last that each sensor has said, in the order of the scenario; empty where knowledge is perfect.
    pub measured: &'a [Measured<'a>],
}

/// What a sensor has said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<'a> {
    /// The quantity, by its name in recordings: `joint.servicer/elbow.position`.
    pub quantity: &'a str,
    /// When it was taken, s.
    pub taken: f64,
    /// When it arrived, s.
    pub arrived: f64,
    /// A number, a vector's three components, or an orientation's w, x, y, z; SI units.
    pub value: [f64; 4],
}

impl<'a> Known<'a> {
    /// Perfect knowledge.
    pub fn truth(world: &'a World) -> Self {
        Self { world, is_perfect: true, is_ready: true, measured: &[] }
    }

    /// The last that was said of a quantity.
    pub fn find(&self, quantity: &str) -> Option<&Measured<'a>> {
        self.measured.iter().find(|m| m.quantity == quantity)
    }
}

/// What stands between a world and its controller: sensors, and what navigation makes of them.
pub trait Perception: std::fmt::Debug + Send + Sync {
    /// Lets sensors look; called before every step. `memory` starts empty and is part of the state.
    fn sense(&self, world: &World, memory: &mut Vec<f64>);

    /// Tells what is known, once; called when the controller's time has come, after [`Self::sense`].
    fn know(&self, world: &World, memory: &mut Vec<f64>, tell: &mut dyn FnMut(&Known<'_>));
}

/// What an observer wants next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// End the run here.
    Stop,
}

/// Somebody who looks at every step.
pub trait Observer {
    /// Called before the first step and after each.
    fn observe(&mut self, world: &World) -> Flow;
}

impl<F: FnMut(&World) -> Flow> Observer for F {
    fn observe(&mut self, world: &World) -> Flow {
        self(world)
    }
}

impl World {
    /// Lets controllers see through sensors from now on, or the truth.
    pub fn perceive(&mut self, perception: Option<Arc<dyn Perception>>) {
        self.perception = perception;
    }

    /// Lets sensors look, and the controller act if its time has come.
    pub fn control(&mut self, controller: &dyn Controller) {
        let is_due = self.state().steps.is_multiple_of(controller.period_steps().max(1));
        let perception = self.perception.clone();
        if !is_due && perception.is_none() {
            return;
        }
        self.refresh();
        let mut sensed = std::mem::take(&mut self.state.perception);
        if let Some(perception) = &perception {
            perception.sense(self, &mut sensed);
        }
        if is_due {
            let mut commands = std::mem::take(&mut self.state.commands);
            let mut memory = std::mem::take(&mut self.state.controller);
            let mut act = |known: &Known<'_>| controller.command(known, &mut memory, &mut commands);
            match &perception {
                None => act(&Known::truth(self)),
                Some(perception) => perception.know(self, &mut sensed, &mut act),
            }
            self.state.commands = commands;
            self.state.controller = memory;
        }
        self.state.perception = sensed;
    }

    /// Runs until `steps` steps have been made since the start, an observer stops it, or it diverges.
    pub fn run(
        &mut self,
        steps: u64,
        controller: &dyn Controller,
        observers: &mut [&mut dyn Observer],
    ) -> Result<(), StepError> {
        self.refresh();
        if self.notify(observers) == Flow::Stop {
            return Ok(());
        }
        while self.state().steps < steps {
            self.control(controller);
            self.advance()?;
            if self.notify(observers) == Flow::Stop {
                break;
            }
        }
        Ok(())
    }

    fn notify(&self, observers: &mut [&mut dyn Observer]) -> Flow {
        let mut flow = Flow::Continue;
        for observer in observers {
            if observer.observe(self) == Flow::Stop {
                flow = Flow::Stop;
            }
        }
        flow
    }
}

/// The controller of a world that nobody controls.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoControl;

impl Controller for NoControl {
    fn command(&self, _: &Known<'_>, _: &mut Vec<f64>, _: &mut [Command]) {}
}
