//! What a dispersed number is in the model that was built, whatever the file says.
//!
//! A number that stands in the world at t = 0 (poses, twists, approaches, joints, friction, step and duration) is read from the world. All
//! others are read from the typed scenario that the world was built of; that the built model does hear them is
//! shown once, at the campaign's start, by building it with two values (`plan`).

use scenario::{Mission, Scenario, glob_matches};
use sim::{Model, World};
use spatial::Vec3;

/// Where a number is read back.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Gauge {
    /// Linear velocity of a base's origin, W axes, m/s.
    Linear(usize, usize),
    /// Angular velocity of a base, its own axes, deg/s.
    Angular(usize, usize),
    /// Position of a base, m.
    Position(usize, usize),
    /// A joint's coordinate or rate, by index, times a factor into the file's unit.
    Joint { index: usize, is_rate: bool, factor: f64 },
    /// Highest friction level of the first pair that a contact rule names.
    Friction(usize),
    /// A quantity of an approach.
    Approach { vehicle: usize, what: String, component: usize },
    /// Step, s.
    Step,
    /// The typed scenario.
    Scenario(String),
}

impl Gauge {
    /// The gauge of a path. `mission` is the nominal one.
    pub(crate) fn of(mission: &Mission, path: &str) -> Self {
        let full = mission.scenario.value_at(path).ok().and_then(|v| v.first().map(|(p, _)| p.clone()));
        let full = full.unwrap_or_else(|| path.to_owned());
        Self::in_world(mission, &full).unwrap_or(Self::Scenario(full))
    }

    /// Whether the world itself is read.
    pub(crate) fn reads_model(&self) -> bool {
        !matches!(self, Self::Scenario(_))
    }

    fn in_world(mission: &Mission, full: &str) -> Option<Self> {
        let (model, scenario) = (mission.world.model(), &mission.scenario);
        if full == "integrator.step_s" {
            return Some(Self::Step);
        }
        if let Some(rule) = full.strip_prefix("contact").and_then(|rest| rest.strip_suffix(".friction.mu")) {
            let index: usize = rule.strip_prefix('[')?.strip_suffix(']')?.parse().ok()?;
            return Some(Self::Friction(pair_of(scenario, model, index)?));
        }
        let rest = full.strip_prefix("vehicle")?;
        let (name, key) = match rest.strip_prefix('.') {
            Some(named) => named.split_once('.').map(|(n, k)| (model.vehicle(n.trim_matches('"')), k))?,
            None => rest.strip_prefix('[')?.split_once("].").map(|(i, k)| (i.parse().ok(), k))?,
        };
        let v = name?;
        let approaching = scenario.vehicles.get(v)?.approach.is_some();
        let reached = scenario.vehicles.get(v)?.end_effector_pose.is_some();
        let (what, component) = match key.split_once('[') {
            Some((what, k)) => (what, k.strip_suffix(']')?.parse().ok()?),
            None => (key, 0),
        };
        match what {
            "twist.linear_m_per_s" => Some(Self::Linear(v, component)),
            "twist.angular_deg_per_s" => Some(Self::Angular(v, component)),
            "pose.position_m" => Some(Self::Position(v, component)),
            _ if approaching && what.starts_with("approach.") => {
                Some(Self::Approach { vehicle: v, what: what.strip_prefix("approach.")?.to_owned(), component })
            }
            _ if !reached && what.starts_with("joints.") => joint(model, v, what),
            _ => None,
        }
    }

    /// The number, in the unit of its key.
    pub(crate) fn read(&self, mission: &Mission) -> Option<f64> {
        let world = &mission.world;
        match self {
            Self::Linear(v, k) => Some(world.kinematics(*v).vel[0].lin[*k]),
            Self::Angular(v, k) => {
                let rate = world.state().bases[*v].rotation.inverse() * world.kinematics(*v).vel[0].ang;
                Some(rate[*k].to_degrees())
            }
            Self::Position(v, k) => Some(world.state().bases[*v].translation.vector[*k]),
            Self::Joint { index, is_rate, factor } => {
                let state = world.state();
                Some(factor * if *is_rate { state.v[*index] } else { state.q[*index] })
            }
            Self::Friction(pair) => world.model().laws[*pair].friction.map(|f| f.highest_level()),
            Self::Approach { vehicle, what, component } => approach(mission, *vehicle, what, *component),
            Self::Step => Some(world.model().step),
            Self::Scenario(path) => typed(&mission.scenario, path),
        }
    }
}

/// The first pair whose sides a contact rule names.
fn pair_of(scenario: &Scenario, model: &Model, rule: usize) -> Option<usize> {
    let [left, right] = &scenario.contacts.get(rule)?.between;
    let names = |c: usize| {
        let body = model.body_name(model.scene.colliders()[c].body);
        [model.collider_names[c].clone(), body]
    };
    let on = |pattern: &str, c: usize| names(c).iter().any(|name| glob_matches(pattern, name));
    let pairs = model.scene.pairs();
    pairs.iter().position(|&[a, b]| (on(left, a) && on(right, b)) || (on(left, b) && on(right, a)))
}

fn joint(model: &Model, v: usize, what: &str) -> Option<Gauge> {
    let (name, key) = what.strip_prefix("joints.")?.rsplit_once('.')?;
    let vehicle = &model.vehicles[v];
    let joint = vehicle.tree.joints.iter().find(|j| j.name == name.trim_matches('"'))?;
    let is_rate = key.starts_with("velocity");
    let index = if is_rate { vehicle.v0 + joint.v_index } else { vehicle.q0 + joint.q_index };
    let factor = if key.contains("_deg") { 1.0_f64.to_degrees() } else { 1.0 };
    Some(Gauge::Joint { index, is_rate, factor })
}

/// A quantity of an approach, from where the two interface frames stand and how they move.
fn approach(mission: &Mission, v: usize, what: &str, component: usize) -> Option<f64> {
    let (world, spec) = (&mission.world, mission.scenario.vehicles.get(v)?.approach.as_ref()?);
    let model = world.model();
    let (frame, port) = (model.vehicles[v].tree.link(&spec.frame)?, model.link(&spec.port)?);
    let (placed, moved) = relative(world, (v, frame), port);
    let motion = |vector: Vec3| Some(vector[component]);
    match what {
        "distance_m" => Some(placed.offset.z),
        "lateral_m" => motion(placed.offset),
        "tilt_deg" => motion(placed.tilt.map(f64::to_degrees)),
        "roll_deg" => Some(placed.roll.to_degrees()),
        "closing_m_per_s" => Some(-moved.velocity.z),
        "lateral_m_per_s" => motion(moved.velocity),
        "tilt_deg_per_s" => motion(moved.rate.map(f64::to_degrees)),
        "roll_deg_per_s" => Some(moved.rate.z.to_degrees()),
        _ => None,
    }
}

/// Where F stands against P, in P's axes.
struct Placed {
    offset: Vec3,
    tilt: Vec3,
    roll: f64,
}

/// How F moves as P sees it, in P's axes.
struct Moved {
    velocity: Vec3,
    rate: Vec3,
}

fn relative(world: &World, f: (usize, usize), p: (usize, usize)) -> (Placed, Moved) {
    let (frame, port) = (world.link_frame(f.0, f.1), world.link_frame(p.0, p.1));
    let (twist, carrier) = (world.link_twist(f.0, f.1), world.link_twist(p.0, p.1));
    let r = frame.pos - port.pos;
    // R_PF = exp(tilt) R_z(roll) R_x(π): the image of −z gives the tilt, what is left the roll.
    let turned = port.rot.transpose() * frame.rot;
    let axis: Vec3 = -turned.column(2).into_owned();
    let across = Vec3::new(-axis.y, axis.x, 0.0);
    let sine = across.norm();
    let tilt = if sine > 0.0 { across * (sine.atan2(axis.z) / sine) } else { Vec3::zeros() };
    let rolled = spatial::exp_rotation(&-tilt) * turned.column(0).into_owned();
    let placed = Placed { offset: port.rot.tr_mul(&r), tilt, roll: rolled.y.atan2(rolled.x) };
    let moved = Moved {
        velocity: port.rot.tr_mul(&(twist.lin - carrier.at(&r))),
        rate: port.rot.tr_mul(&(twist.ang - carrier.ang)),
    };
    (placed, moved)
}

/// A number of the typed scenario.
fn typed(scenario: &Scenario, path: &str) -> Option<f64> {
    let values = scenario.value_at(path).ok()?;
    let (_, value) = values.first()?;
    value.as_float().or(value.as_integer().map(|i| i as f64))
}
