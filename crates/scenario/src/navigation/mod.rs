//! What a strategy knows through sensors: a world that navigation makes out.
//!
//! | part | from |
//! | --- | --- |
//! | own joints | encoders; rates by tachometers, else by differences of what encoders say, smoothed |
//! | own base | pose and momentum at the start, then: turned by the gyro, moved so that linear momentum is kept |
//! | target | the camera, through a filter ([`filter`]) or as it is |
//! | mechanisms | what they tell of themselves: whether they hold |
//!
//! The frame that all is made out in is W at the start. It drifts with the own base's errors, and what pushes the servicer is not felt: both target and
//! tool are in it, and only where they are to each other counts.
//!
//! All memory is in [`sim::State::perception`]: of each sensor, of what each said last, of the own base and of the target.

mod filter;
mod free_body;
mod own;

pub(crate) use free_body::{FreeBody, Mass};
pub(crate) use own::{read_pose, write_pose};

use crate::build::Faults;
use crate::measure::{Quantity, Sight};
use crate::sensors::{self, Sensor};
use crate::spec::{Scenario, Sensor as SensorSpec};
use filter::{ESTIMATE, Estimate, TargetFilter};
use own::OwnShip;
use record::{ChannelSpec, Plot, Probe};
use sim::{Known, Measured, Perception, World};
use spatial::{Pose, Rot, Twist, Vec3, log_rotation, nalgebra};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers of what a sensor said last: the stamp, the arrival, four of the reading; before the first the stamp is negative.
const SAID: usize = 6;
/// Least errors of a pose that a filter allows for: m, rad. A finer camera is on a vehicle that does not know so well where it is itself.
const FINEST: [f64; 2] = [1e-3, 1e-3];

/// Sensors, and what is made of them.
#[derive(Debug)]
pub(crate) struct Navigator {
    sensors: Vec<Sensor>,
    /// Where the memory of each begins.
    places: Vec<usize>,
    said: usize,
    own: OwnShip,
    target: Target,
    /// The world that is made out: written anew whenever it is told, so that nothing is remembered in it.
    scratch: Mutex<World>,
    start: sim::State,
    len: usize,
}

/// The camera and its subject.
#[derive(Debug)]
struct Target {
    vehicle: usize,
    /// Position and attitude, indices of sensors.
    camera: [usize; 2],
    sight: Sight,
    filter: TargetFilter,
    is_filtered: bool,
    /// Angular velocity's standard deviation from which on it is made out, rad/s.
    ready: f64,
    /// Where in memory: how many poses were taken, then the estimate.
    at: usize,
}

/// The camera, and what it sees from where.
struct Roles<'a> {
    camera: &'a SensorSpec,
    sight: Sight,
}

/// What stands between a world at its start and its strategy; none where strategies know the truth, or need to know nothing.
pub(crate) fn build(scenario: &Scenario, world: &World, faults: &mut Faults<'_>) -> Option<Navigator> {
    let spec = &scenario.navigation;
    if spec.perfect {
        return None;
    }
    let Some(name) = &spec.camera else {
        if steers_by_sight(scenario) {
            let reason = "says neither camera nor perfect, and the strategy steers by where things are: add a camera (a [[sensor]] of kind pose, with \
                          relative_to = a link of the own vehicle), or set perfect = true: it then knows the truth";
            faults.add("navigation", reason);
        }
        return None;
    };
    let sensors = match sensors::of(scenario, world.model()) {
        Ok(sensors) => sensors,
        Err(errors) => {
            errors.into_iter().for_each(|error| faults.push(error));
            return None;
        }
    };
    let (seen, sight) = camera_of(name, &sensors, faults)?;
    let camera = scenario.sensors.iter().find(|s| s.name == *name)?;
    let places: Vec<usize> = sensors
        .iter()
        .scan(0, |at, sensor| {
            let place = *at;
            *at += sensor.memory_len();
            Some(place)
        })
        .collect();
    let said = sensors.iter().map(Sensor::memory_len).sum();
    let own_at = said + SAID * sensors.len();
    let own = own::build(scenario, world, &sensors, &Roles { camera, sight }, own_at, faults)?;
    let target_at = own_at + own.memory_len();
    let target = target(scenario, world, &sensors, (seen, sight), target_at, faults)?;
    Some(Navigator {
        places,
        said,
        own,
        target,
        scratch: Mutex::new(World::new(world.model().clone(), world.state().clone())),
        start: world.state().clone(),
        len: target_at + 1 + ESTIMATE,
        sensors,
    })
}

/// Position and attitude of what a camera sees, as indices of sensors, and the line of sight.
fn camera_of(name: &str, sensors: &[Sensor], faults: &mut Faults<'_>) -> Option<([usize; 2], Sight)> {
    let find = |quantity: &str| sensors.iter().position(|s| s.name() == format!("sensor.{name}.{quantity}"));
    let (Some(position), Some(attitude)) = (find("position"), find("orientation")) else {
        let reason = format!(
            "\"{name}\" is no sensor of kind pose that sees from a link of the own vehicle (relative_to = \"vehicle/link\")"
        );
        faults.add("navigation.camera", reason);
        return None;
    };
    let Quantity::SeenPosition(sight) = sensors[position].quantity() else { return None };
    if sight.of.0 == sight.from.vehicle {
        faults.add(
            "navigation.camera",
            format!("\"{name}\" sees the vehicle that carries it; let it see another one's link"),
        );
        return None;
    }
    Some(([position, attitude], sight))
}

/// Whether a strategy asks where things are.
pub(crate) fn steers_by_sight(scenario: &Scenario) -> bool {
    use crate::spec::Strategy;
    match scenario.strategy {
        Strategy::TrackAndGrasp(_) | Strategy::SoftDock(_) => true,
        Strategy::None | Strategy::Schedule(_) | Strategy::Replay(_) => false,
    }
}

fn target(
    scenario: &Scenario,
    world: &World,
    sensors: &[Sensor],
    (camera, sight): ([usize; 2], Sight),
    at: usize,
    faults: &mut Faults<'_>,
) -> Option<Target> {
    let (vehicle, link) = sight.of;
    let spec = &scenario.navigation;
    let (kin, base) = (world.kinematics(vehicle), world.state().bases[vehicle]);
    let inertia_w = multibody::calc_locked_inertia(kin);
    let Some(mass) = Mass::new(&inertia_w.transformed(&kin.rot[0].transpose(), &Vec3::zeros())) else {
        faults.add("navigation.camera", "sees a vehicle whose inertia is singular: no filter follows how it turns");
        return None;
    };
    let [position, attitude] = camera;
    let filter = TargetFilter {
        mass,
        pose_bs: base.inverse() * world.link_frame(vehicle, link).to_pose(),
        sigma: [sensors[position].sigma().max(FINEST[0]), sensors[attitude].sigma().max(FINEST[1])],
        walk: [spec.velocity_walk_m_per_s_sqrt_s, spec.rate_walk_deg_per_s_sqrt_s.to_radians()],
    };
    let ready = spec.ready_deg_per_s.to_radians();
    Some(Target { vehicle, camera, sight, filter, is_filtered: spec.filter, ready, at })
}

impl Navigator {
    fn memory_of(&self, sensor: usize) -> Range<usize> {
        self.places[sensor]..self.places[sensor] + self.sensors[sensor].memory_len()
    }

    /// What a sensor said last: stamp, and reading.
    fn said<'a>(&self, memory: &'a [f64], sensor: usize) -> Option<(f64, &'a [f64])> {
        let said = &memory[self.said + SAID * sensor..][..SAID];
        (said[0] >= 0.0).then(|| (said[0], &said[2..]))
    }

    fn measured<'a>(&'a self, memory: &[f64]) -> Vec<Measured<'a>> {
        let told = |k: usize| {
            let said = &memory[self.said + SAID * k..][..SAID];
            let value = [said[2], said[3], said[4], said[5]];
            let quantity = self.sensors[k].name();
            (said[0] >= 0.0).then_some(Measured { quantity, taken: said[0], arrived: said[1], value })
        };
        (0..self.sensors.len()).filter_map(told).collect()
    }

    /// Takes in what the camera said, if that is new.
    fn see(&self, memory: &mut [f64]) {
        let Target { camera: [position, attitude], at, .. } = self.target;
        let (Some((stamp, p)), Some((same, q))) = (self.said(memory, position), self.said(memory, attitude)) else {
            return;
        };
        let is_new = memory[at] == 0.0 || stamp > memory[at + 1];
        if stamp != same || !is_new {
            return;
        }
        let quaternion = nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
        let seen_c = Pose::from_parts(Vec3::new(p[0], p[1], p[2]).into(), Rot::new_normalize(quaternion));
        // Where the camera was at the stamp; one that takes poses for present ones does not ask.
        let camera =
            if self.target.is_filtered { self.own.camera_at(memory, stamp) } else { self.own.camera_now(memory) };
        let Some(camera) = camera else { return };
        let seen = camera * seen_c;
        let mass = self.target.filter.mass;
        let estimate = if memory[at] == 0.0 {
            self.target.filter.begin(stamp, &seen)
        } else {
            let mut estimate = Estimate::read(mass, &memory[at + 1..]);
            if self.target.is_filtered {
                self.target.filter.take(&mut estimate, stamp, &seen);
            } else {
                estimate = self.target.differ(&estimate, stamp, &seen);
            }
            estimate
        };
        memory[at] += 1.0;
        estimate.write(&mut memory[at + 1..]);
    }

    /// The target as it is made out at an instant, and whether that will do; none before it was seen.
    fn target_at(&self, memory: &[f64], time: f64) -> Option<(FreeBody, bool)> {
        let Target { at, is_filtered, ready, .. } = self.target;
        if memory.len() < self.len || memory[at] == 0.0 {
            return None;
        }
        let estimate = Estimate::read(self.target.filter.mass, &memory[at + 1..]);
        if !is_filtered {
            return Some((estimate.body, memory[at] > 1.0));
        }
        let is_ready = estimate.calc_rate_sigma() <= ready;
        Some((estimate.at(time), is_ready))
    }

    /// How far the target is from where navigation has it, seen from the own base: distance, m, angle, rad, and angular velocity, rad/s.
    fn calc_errors(&self, truth: &World) -> Option<[f64; 3]> {
        let memory = &truth.state().perception;
        let (body, _) = self.target_at(memory, truth.state().time)?;
        let own = self.own.base_pose(memory)?;
        let (true_own, vehicle) = (truth.state().bases[self.own.vehicle], self.target.vehicle);
        let told = own.inverse() * body.pose();
        let is = true_own.inverse() * truth.state().bases[vehicle];
        let spins =
            own.rotation.inverse() * body.spin() - true_own.rotation.inverse() * truth.kinematics(vehicle).vel[0].ang;
        let apart = told.translation.vector - is.translation.vector;
        Some([apart.norm(), log_rotation(&(told.rotation.inverse() * is.rotation)).norm(), spins.norm()])
    }
}

/// How far navigation is off, as channels.
#[derive(Debug)]
pub(crate) struct Errors(Arc<Navigator>);

impl Navigator {
    /// How far it is off, for a recorder.
    pub(crate) fn as_probe(self: Arc<Self>) -> Errors {
        Errors(self)
    }
}

impl Probe for Errors {
    fn channels(&self) -> Vec<ChannelSpec> {
        let channel = |name: &str, unit: &str, text: &str| {
            ChannelSpec::new(format!("navigation.{name}"), unit, Plot::Relative).described(text)
        };
        vec![
            channel("position_error", "m", "target to where it is made out to be, seen from the own base"),
            channel("attitude_error", "rad", "likewise"),
            channel("rate_error", "rad/s", "of the target's angular velocity"),
        ]
    }

    fn read(&mut self, world: &World, values: &mut Vec<f64>) {
        values.extend(self.0.calc_errors(world).unwrap_or([f64::NAN; 3]));
    }
}

impl Target {
    /// The last pose as the present one; rates as differences of the last two.
    fn differ(&self, before: &Estimate, stamp: f64, seen: &Pose) -> Estimate {
        let mut now = self.filter.begin(stamp, seen);
        let dt = stamp - before.time;
        let old = before.body.pose();
        let new = now.body.pose();
        let ang = log_rotation(&(new.rotation * old.rotation.inverse())) / dt;
        let lin = (new.translation.vector - old.translation.vector) / dt;
        now.body = FreeBody::new(&new, &Twist::new(ang, lin), self.filter.mass);
        now
    }
}

impl Perception for Navigator {
    fn sense(&self, world: &World, memory: &mut Vec<f64>) {
        if memory.is_empty() {
            memory.resize(self.len, 0.0);
            (0..self.sensors.len()).for_each(|k| memory[self.said + SAID * k] = -1.0);
        }
        for (k, sensor) in self.sensors.iter().enumerate() {
            let (own, said) = memory.split_at_mut(self.said);
            let said = &mut said[SAID * k..][..SAID];
            sensor.look(world, &mut own[self.memory_of(k)], |arrival| {
                (said[0], said[1]) = (arrival.taken, arrival.arrives);
                said[2..].copy_from_slice(&arrival.value);
            });
        }
    }

    fn know(&self, truth: &World, memory: &mut Vec<f64>, tell: &mut dyn FnMut(&Known<'_>)) {
        let now = truth.state().time;
        let mut world = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        *world.state_mut() = self.start.clone();
        let state = world.state_mut();
        (state.time, state.steps) = (now, truth.state().steps);
        state.mechanisms.clone_from(&truth.state().mechanisms);
        state.commands.clone_from(&truth.state().commands);
        self.own.write(now, memory, |memory, sensor| self.said(memory, sensor), &mut world, &self.target.sight.from);
        self.see(memory);
        let seen = self.target_at(memory, now);
        if let Some((body, _)) = seen {
            let pose = body.pose();
            world.state_mut().bases[self.target.vehicle] = pose;
            let twist = body.twist_at(&pose.translation.vector);
            self.own.set_twists(&mut world, memory, (self.target.vehicle, twist));
        }
        let measured = self.measured(memory);
        let is_ready = seen.is_some_and(|(_, ready)| ready);
        tell(&Known { world: &world, is_perfect: false, is_ready, measured: &measured });
    }
}
