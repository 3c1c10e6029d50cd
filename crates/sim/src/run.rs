//! The run loop: control, step, observe.
//!
//! A controller sees the world and writes commands; what it remembers lives in [`crate::State::controller`], so that a
//! snapshot is complete. An observer only looks. Both are called at fixed numbers of steps, never at a clock.

use crate::actuator::Command;
use crate::error::StepError;
use crate::world::World;

/// Guidance and control: a function of the world and of its own memory.
pub trait Controller {
    /// Steps between two calls; at least 1.
    fn period_steps(&self) -> u64 {
        1
    }

    /// Writes the commands that act until the next call. `memory` starts empty and is part of the state.
    fn command(&self, world: &World, memory: &mut Vec<f64>, commands: &mut [Command]);
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
    /// Lets the controller act if its time has come.
    pub fn control(&mut self, controller: &dyn Controller) {
        if !self.state().steps.is_multiple_of(controller.period_steps().max(1)) {
            return;
        }
        self.refresh();
        let mut commands = std::mem::take(self.state_parts().0);
        let mut memory = std::mem::take(self.state_parts().1);
        controller.command(self, &mut memory, &mut commands);
        *self.state_parts().0 = commands;
        *self.state_parts().1 = memory;
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
    fn command(&self, _: &World, _: &mut Vec<f64>, _: &mut [Command]) {}
}
