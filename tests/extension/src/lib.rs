//! What a user of softdock adds from outside: a tether between two spacecraft, a laser that measures how far the other one is, and a controller that keeps
//! the tether taut by what the laser says.

use record::{ChannelSpec, Plot, Probe};
use sim::{BodyMotion, Command, Controller, Force, Known, Measured, Perception, World};
use spatial::{Vec3, Wrench};
use std::sync::Arc;

/// A line between the origins of two links that pulls when it is taut: T = k (l − l₀) + c l̇, never less than nothing.
#[derive(Debug)]
pub struct Tether {
    /// Vehicle and link of both ends.
    pub ends: [(usize, usize); 2],
    /// Length at which it is taut, m.
    pub length: f64,
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
}

impl Tether {
    /// Its direction, from the first end to the second, and its tension, N.
    fn calc_tension(&self, ends: &[BodyMotion]) -> (Vec3, f64) {
        let line = ends[1].frame_wl.pos - ends[0].frame_wl.pos;
        let (long, along) = (line.norm(), line.normalize());
        let rate = along.dot(&(ends[1].twist.lin - ends[0].twist.lin));
        let taut = long > self.length;
        let tension = self.stiffness * (long - self.length) + self.damping * rate;
        (along, if taut { tension.max(0.0) } else { 0.0 })
    }
}

impl Force for Tether {
    fn name(&self) -> &str {
        "tether"
    }

    fn links(&self) -> &[(usize, usize)] {
        &self.ends
    }

    fn act(&self, ends: &[BodyMotion], wrenches: &mut [Wrench]) {
        let (along, tension) = self.calc_tension(ends);
        wrenches[0].force += tension * along;
        wrenches[1].force -= tension * along;
    }
}

/// Name of the laser's channel, and of its quantity to a controller.
pub const RANGE: &str = "laser.range";

/// A laser on the base of one vehicle that reads the distance to that of another, in whole steps.
#[derive(Clone, Copy, Debug)]
pub struct Laser {
    /// Vehicles: its own, and the other.
    pub between: [usize; 2],
    /// What it rounds to, m.
    pub step: f64,
    /// Steps of the simulation between two readings.
    pub every: u64,
}

impl Laser {
    /// What it reads.
    pub fn read(&self, world: &World) -> f64 {
        let place = |vehicle: usize| world.state().bases[vehicle].translation.vector;
        let range = (place(self.between[1]) - place(self.between[0])).norm();
        (range / self.step).round() * self.step
    }
}

/// As a channel of a recording.
impl Probe for Laser {
    fn channels(&self) -> Vec<ChannelSpec> {
        vec![ChannelSpec::new(RANGE, "m", Plot::Sensors).described("from base to base")]
    }

    fn read(&mut self, world: &World, values: &mut Vec<f64>) {
        values.push(Laser::read(self, world));
    }
}

/// As what a controller knows, beside nothing else: of the world it is told the time.
#[derive(Debug)]
pub struct LaserAlone {
    /// The laser.
    pub laser: Laser,
    /// A world that stands still, of the same model: no truth leaks through it.
    pub blank: std::sync::Mutex<World>,
}

/// Places in its memory: when the last reading was taken, s, and what it was, m.
const TAKEN: usize = 0;
const READ: usize = 1;

impl Perception for LaserAlone {
    fn sense(&self, world: &World, memory: &mut Vec<f64>) {
        memory.resize(2, 0.0);
        if world.state().steps.is_multiple_of(self.laser.every) {
            memory[TAKEN] = world.state().time;
            memory[READ] = self.laser.read(world);
        }
    }

    fn know(&self, truth: &World, memory: &mut Vec<f64>, tell: &mut dyn FnMut(&Known<'_>)) {
        let Ok(mut blank) = self.blank.lock() else { return };
        blank.state_mut().time = truth.state().time;
        let (taken, range) = (memory[TAKEN], memory[READ]);
        let measured = [Measured { quantity: RANGE, taken, arrived: taken, value: [range, 0.0, 0.0, 0.0] }];
        tell(&Known { world: &blank, is_perfect: false, is_ready: true, measured: &measured });
    }
}

/// Keeps a tether taut by a thruster that pushes away from the other: on while they close faster than they should.
#[derive(Clone, Copy, Debug)]
pub struct Keeper {
    /// The thruster.
    pub actuator: usize,
    /// Distance at which it is taut, m.
    pub range: f64,
    /// Its push, N.
    pub force: f64,
}

impl Controller for Keeper {
    fn period_steps(&self) -> u64 {
        10
    }

    fn command(&self, known: &Known<'_>, memory: &mut Vec<f64>, commands: &mut [Command]) {
        let Some(said) = known.find(RANGE) else { return };
        let (range, taken) = (said.value[0], said.taken);
        // What it remembers: a smoothed rate, and the last reading with its stamp.
        if memory.is_empty() {
            memory.extend([0.0, range, taken]);
        } else if taken > memory[2] {
            let raw = (range - memory[1]) / (taken - memory[2]);
            memory[0] += 0.2 * (raw - memory[0]);
            (memory[1], memory[2]) = (range, taken);
        }
        let wish = (0.5 * (self.range - range)).clamp(-0.05, 0.05);
        commands[self.actuator].effort = if memory[0] < wish { self.force } else { 0.0 };
    }
}

/// Puts forces into a mission.
///
/// # Errors
/// A force on a link that is not there.
pub fn with_forces(mission: &mut scenario::Mission, forces: Vec<Arc<dyn Force>>) -> Result<(), sim::ModelError> {
    let model = (**mission.world.model()).clone().with_forces(forces)?;
    mission.world = World::new(Arc::new(model), mission.world.state().clone());
    mission.world.perceive(mission.perception());
    Ok(())
}
