//! Elastic mounts in flight.
//!
//! A tip of mass m on a spring k swings at √(k/m), 70 Hz and more, and a force sensor behind it reads at kilohertz: followed from sample to sample, a
//! flight of seconds costs more than all touches. But a mount with a damper d comes to rest, as e^(−d t/2m), and what flies
//! on with it moves as one body. So it is held where it is once what it still says is far below the noise of the force sensors, and the flight
//! goes on in long steps; [`sim::World::advance_resting`] sees to it that nothing would move it meanwhile.

use crate::replay::Pace;
use crate::tape::Tape;
use scenario::measure::{Mount, Quantity};
use sim::{Model, Rest};

/// What a held mount may leave unsaid, in standard deviations of a force sensor (of a torque sensor: at an arm of 1 m).
const UNSAID: f64 = 1e-4;
/// The same where no force is measured, N.
const UNFELT: f64 = 1e-5;
/// Time constants after a start in which nothing is held: a difference quotient of the start must see the mount swing.
const SETTLED: f64 = 12.0;
/// Largest phase, rad, through which a mount may swing in a long step for this to be made without holding it.
const RESOLVED: f64 = 0.3;

/// What flights of a replay may hold, and how long after its start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mounts {
    /// Coordinates of the tips; empty where nothing has to be held.
    pub rests: Vec<Rest>,
    /// Time after the start of a replay from which on they may be held, s.
    pub after: f64,
}

impl Mounts {
    /// Mounts of a model that forbid long steps unless they are held; none where one of them has no damper.
    pub fn new(model: &Model, mounts: &[Mount], tape: &Tape, pace: Pace) -> Self {
        let swings = |m: &Mount| pace.free * m.rate(model) > RESOLVED;
        if pace.free <= pace.step || !mounts.iter().any(swings) || !mounts.iter().all(|m| m.damping > 0.0) {
            return Self::default();
        }
        let forces = tape.readings.iter().filter(|r| matches!(r.quantity, Quantity::Force(_) | Quantity::Torque(_)));
        let force = forces.map(|r| UNSAID * r.sigma).reduce(f64::min).unwrap_or(UNFELT);
        let rests = |mount: &Mount| {
            let mass = mount.mass(model);
            // What a tip that still moves will have pulled, and what its damper pulls now.
            let speed = force / mount.damping.max((mount.stiffness * mass).sqrt());
            let coordinate = mount.coordinate;
            (0..3).map(move |k| Rest { coordinate: coordinate + k, speed, acceleration: force / mass })
        };
        let settling = |m: &Mount| SETTLED * (2.0 * m.mass(model) / m.damping).max(m.damping / m.stiffness);
        Self { rests: mounts.iter().flat_map(rests).collect(), after: mounts.iter().map(settling).fold(0.0, f64::max) }
    }
}
