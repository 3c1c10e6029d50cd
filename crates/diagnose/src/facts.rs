//! What the nominal model and the recording offer to hypotheses: places and nominal numbers.

use crate::plant::Built;
use crate::reading::{Reading, Value};
use crate::tape::{CommandTape, Commanded, Tape};
use contact::{Normal, NormalLaw};
use friction::Friction;
use multibody::{Inertial, JointKind};
use scenario::effects::facts::Survey;
use scenario::measure::Quantity;
use sim::{ActuatorKind, MechanismKind};

pub use scenario::effects::facts::{ActuatorFact, BodyFact, ContactFact, JointFact, MechanismFact, SensorFact};

/// Places at which effects could act.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// Joints with one coordinate.
    pub joints: Vec<JointFact>,
    /// Bases that move, and links of arms.
    pub bodies: Vec<BodyFact>,
    /// Contact pairs.
    pub contacts: Vec<ContactFact>,
    /// Mechanisms.
    pub mechanisms: Vec<MechanismFact>,
    /// Thrusters.
    pub thrusters: Vec<ActuatorFact>,
    /// What was measured.
    pub sensors: Vec<SensorFact>,
    /// Acceleration of gravity, m/s², W axes.
    pub gravity: [f64; 3],
    /// Longest run, s.
    pub duration: f64,
    /// Highest frequency that samples tell from lower ones, Hz.
    pub highest: f64,
    /// Frequencies at which what a model leaves swings, Hz; none before that was looked at.
    pub lines: Vec<f64>,
}

impl Facts {
    /// Collects them.
    pub fn new(built: &Built, tapes: &[Tape]) -> Self {
        let sensors = tapes.first().map_or(Vec::new(), |t| {
            let fact = |r: &Reading| SensorFact {
                channel: r.channel.clone(),
                quantity: r.quantity,
                axes: r.axes.clone(),
                sigma: r.sigma,
            };
            t.readings.iter().map(fact).collect()
        });
        Self {
            joints: joints(built, tapes),
            bodies: bodies(built, &sensors),
            contacts: contacts(built),
            mechanisms: built.model.mechanisms.iter().map(mechanism).collect(),
            thrusters: thrusters(built, tapes),
            sensors,
            gravity: built.model.calc_field(0.0, &spatial::Vec3::zeros()).into(),
            duration: tapes.iter().map(|t| t.span.1 - t.span.0).fold(0.0, f64::max),
            highest: 0.5 * tapes.iter().map(|t| t.rate).fold(0.0, f64::max),
            lines: Vec::new(),
        }
    }

    /// So many joints `j0`, `j1` … of which nothing is known, over a second.
    #[cfg(test)]
    pub(crate) fn of_joints(count: usize) -> Self {
        let joint = |k: usize| JointFact { name: format!("j{k}"), coordinate: k, ..JointFact::default() };
        Self { joints: (0..count).map(joint).collect(), duration: 1.0, highest: f64::INFINITY, ..Self::default() }
    }
}

impl Facts {
    /// What a definition may look at around a place.
    pub fn survey(&self) -> Survey<'_> {
        let Self { joints, bodies, contacts, gravity, duration, highest, lines, .. } = self;
        Survey { joints, bodies, contacts, gravity: *gravity, duration: *duration, highest: *highest, lines }
    }

    /// Without the joints and bodies that effects have brought: a mount's tip has no friction of its own. What is touched at other times is not free of torques.
    pub fn of_parts(mut self, nominal: &Self) -> Self {
        self.joints.retain(|j| nominal.joints.iter().any(|own| own.name == j.name));
        self.bodies.retain_mut(|b| {
            let own = nominal.bodies.iter().find(|own| own.name == b.name);
            b.is_torque_free &= own.is_some_and(|own| own.is_torque_free);
            own.is_some()
        });
        self
    }
}

fn joints(built: &Built, tapes: &[Tape]) -> Vec<JointFact> {
    let mut all = Vec::new();
    for vehicle in &built.model.vehicles {
        let single =
            |j: &&multibody::Joint| !j.is_mimic && matches!(j.kind, JointKind::Revolute | JointKind::Prismatic);
        for joint in vehicle.tree.joints.iter().filter(single) {
            let coordinate = vehicle.v0 + joint.v_index;
            let limit = |i: usize| match built.model.actuators[i].kind {
                ActuatorKind::JointEffort { coordinate: c, limit } if c == coordinate => Some(limit),
                _ => None,
            };
            let efforts = tapes.iter().flat_map(|t| &t.commands).filter(|c| c.what == Commanded::Effort);
            let given =
                |c: &CommandTape| Some((c.values.iter().fold(0.0_f64, |m, e| m.max(e.abs())), limit(c.actuator)?));
            let largest = efforts.filter_map(given).fold(0.0_f64, |m, (asked, limit)| m.max(asked.min(limit)));
            let largest = largest.max(asked_of_drive(built, tapes, coordinate));
            all.push(JointFact {
                name: joint_name(built, &vehicle.name, &joint.name),
                coordinate,
                armature: joint.armature,
                largest_command: largest,
                travel: travel(tapes, vehicle.v0 + joint.v_index),
                orders: Vec::new(),
            });
        }
    }
    all
}

/// What a drive that follows a recorded reference is asked for, N·m or N, by how far the joint was read beside that; but for the hundredth of the samples at
/// which it is asked for most. Zero where nothing reads the joint.
fn asked_of_drive(built: &Built, tapes: &[Tape], coordinate: usize) -> f64 {
    let mut asked = Vec::new();
    for (tape, command) in tapes.iter().flat_map(|t| t.commands.iter().map(move |c| (t, c))) {
        let ActuatorKind::JointDrive { coordinate: own, stiffness, damping, limit } =
            built.model.actuators[command.actuator].kind
        else {
            continue;
        };
        for reading in tape.readings.iter().filter(|_| own == coordinate) {
            let gain = match (command.what, reading.quantity) {
                (Commanded::Position, Quantity::JointPosition(read)) if read == coordinate => stiffness,
                (Commanded::Velocity, Quantity::JointVelocity(read)) if read == coordinate => damping,
                _ => continue,
            };
            let pairs = reading.times.iter().zip(&reading.values);
            asked.extend(pairs.map(|(t, x)| (gain * (command.at(*t) - x.scalar()).abs()).min(limit)));
        }
    }
    asked.sort_by(f64::total_cmp);
    asked.get(asked.len() * 99 / 100).copied().unwrap_or(0.0)
}

/// A joint as places call it: with its vehicle where several have one of that name.
fn joint_name(built: &Built, vehicle: &str, name: &str) -> String {
    let of = |v: &sim::Vehicle| v.tree.joints.iter().filter(|j| j.name == name && !j.is_mimic).count();
    qualified(vehicle, name, built.model.vehicles.iter().map(of).sum())
}

/// A link likewise.
fn link_name(built: &Built, vehicle: &str, name: &str) -> String {
    let of = |v: &sim::Vehicle| v.tree.links.iter().filter(|l| l.name == name).count();
    qualified(vehicle, name, built.model.vehicles.iter().map(of).sum())
}

fn qualified(vehicle: &str, name: &str, namesakes: usize) -> String {
    if namesakes > 1 { format!("{vehicle}/{name}") } else { name.to_owned() }
}

/// How far a joint's readings go.
fn travel(tapes: &[Tape], coordinate: usize) -> f64 {
    let is_own = |q: Quantity| q == Quantity::JointPosition(coordinate) || q == Quantity::JointLinkPosition(coordinate);
    let readings = tapes.iter().flat_map(|t| &t.readings).filter(|r| is_own(r.quantity));
    let places = readings.flat_map(|r| &r.values).map(Value::scalar).filter(|x| x.is_finite());
    let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
    (high - low).max(0.0)
}

fn bodies(built: &Built, sensors: &[SensorFact]) -> Vec<BodyFact> {
    let touched = |body: usize| {
        let pairs = 0..built.model.scene.pairs().len();
        pairs.into_iter().any(|p| built.model.pair_bodies(p).0 == body || built.model.pair_bodies(p).1 == body)
    };
    let placed = |vehicle: usize| {
        let reads = |quantity: &Quantity| match quantity {
            Quantity::Position(of, _) | Quantity::LinearVelocity(of, _) => *of == vehicle,
            Quantity::SeenPosition(_) => true,
            _ => false,
        };
        sensors.iter().any(|s| reads(&s.quantity))
    };
    let held = |vehicle: usize| {
        let sides = built.model.mechanisms.iter().flat_map(|m| [m.side_a.vehicle, m.side_b.vehicle]);
        sides.flatten().any(|v| v == vehicle)
    };
    let mut all = Vec::new();
    for (number, vehicle) in built.model.vehicles.iter().enumerate() {
        for (l, link) in vehicle.tree.links.iter().enumerate().filter(|(_, l)| l.inertia.mass > 0.0) {
            let is_base = link.body == 0 && l == 0;
            if link.body == 0 && vehicle.base.is_held() {
                continue;
            }
            let mask = if is_base { vehicle.base.mask() } else { [false; 6] };
            let thrust = |k: &ActuatorKind| matches!(k, ActuatorKind::Thruster { body, .. } if *body == vehicle.body0);
            let pushed = built.model.actuators.iter().any(|a| thrust(&a.kind));
            // A correction says what a link has of its own; what effects add to it or let move in it comes on top.
            let own = built.own_inertials[number].iter().find(|(name, _)| *name == link.name).and_then(|(_, own)| *own);
            let Some(Inertial { mass, com, tensor_com: inertia }) = own else { continue };
            all.push(BodyFact {
                name: link_name(built, &vehicle.name, &link.name),
                vehicle: number,
                mass,
                com,
                inertia,
                mask,
                is_base,
                is_on_joints: link.body != 0,
                is_torque_free: !pushed && !touched(vehicle.body0) && !held(number) && vehicle.tree.nv == 0,
                is_placed: placed(number),
            });
        }
    }
    all
}

fn mechanism(mechanism: &sim::Mechanism) -> MechanismFact {
    let any = |along: &spatial::Vec3, about: &spatial::Vec3| along.amax().max(about.amax()) > 0.0;
    let (has_springs, has_dampers) = match (&mechanism.kind, mechanism.kind.hold()) {
        (MechanismKind::Strut(strut), _) => (strut.stiffness > 0.0, strut.damping > 0.0),
        (_, Some(hold)) => {
            (any(&hold.stiffness, &hold.torsional_stiffness), any(&hold.damping, &hold.torsional_damping))
        }
        (_, None) => (false, false),
    };
    MechanismFact { name: mechanism.name.clone(), has_springs, has_dampers }
}

fn contacts(built: &Built) -> Vec<ContactFact> {
    let mut all: Vec<ContactFact> = Vec::new();
    for (pair, law) in built.model.laws.iter().enumerate() {
        let name = contact_name(built, pair);
        if all.iter().any(|c| c.name == name) {
            continue;
        }
        let normal = normal_numbers(&law.normal);
        let is_linear = matches!(law.normal.law, NormalLaw::SpringDamper { .. });
        let bristle = match law.friction {
            Some(Friction::Bristle(f)) => Some([f.mu_kinetic, f.stiffness, f.damping]),
            _ => None,
        };
        let (body_a, body_b) = built.model.pair_bodies(pair);
        let mass = [body_a, body_b].map(|b| free_mass(built, b)).into_iter().fold(f64::INFINITY, f64::min);
        let unmoved_by = unmoved(built, pair);
        all.push(ContactFact {
            name,
            normal,
            is_linear,
            bristle,
            mass,
            has_normal_motion: normal.is_some(),
            unmoved_by,
        });
    }
    all
}

/// Displacements of a pair's second part, along and about the axes of its link, that leave it where it is.
fn unmoved(built: &Built, pair: usize) -> [bool; 6] {
    let second = built.model.scene.pairs()[pair][1];
    let (collider, name) = (&built.model.scene.colliders()[second], &built.model.collider_links[second]);
    let own = collider.shape.unmoved_by();
    let vehicle = built.model.owners.get(collider.body).map(|(v, _)| &built.model.vehicles[*v]);
    let is_own = |l: &&multibody::Link| name.rsplit_once('/').is_some_and(|(_, link)| link == l.name);
    let link = vehicle.and_then(|v| v.tree.links.iter().find(is_own));
    let turned = link.map_or_else(spatial::Rot::identity, |l| l.frame_bl.to_pose().rotation.inverse());
    let of_shape = (turned * collider.pose_bs.rotation).inverse().to_rotation_matrix();
    // Several shapes on a link turn together about its origin.
    let is_alone = built.model.collider_links.iter().filter(|other| *other == name).count() == 1 || link.is_none();
    std::array::from_fn(|k| {
        let (first, axis) = (k / 3 * 3, k % 3);
        let leaves = |j: usize| own[first + j] || of_shape[(j, axis)].abs() < ALIGNED;
        (first == 0 || is_alone) && (0..3).all(leaves)
    })
}

/// Share of an axis below which it is none of another one's.
const ALIGNED: f64 = 1e-9;

/// The parts of a pair: shapes, or links that carry several shapes under one law, as the two plates of a drogue.
fn contact_name(built: &Built, pair: usize) -> String {
    let (pairs, laws) = (built.model.scene.pairs(), &built.model.laws);
    let of = |name: &str| name.rsplit_once('/').map_or(name, |(_, s)| s).to_owned();
    let link = |i: usize| &built.model.collider_links[i];
    let links = |p: usize| pairs[p].map(link);
    let alike: Vec<usize> = (0..pairs.len()).filter(|p| links(*p) == links(pair)).collect();
    let is_one = alike.iter().all(|p| laws[*p] == laws[pair]);
    let side = |k: usize| {
        let shape = pairs[pair][k];
        let is_alone = alike.iter().all(|p| pairs[*p][k] == shape);
        of(if is_alone || !is_one || link(shape) == "world" { &built.model.collider_names[shape] } else { link(shape) })
    };
    format!("{}/{}", side(0), side(1))
}

/// Mass that moves with a body: its vehicle's, what a held base holds apart; infinite for one that does not move.
fn free_mass(built: &Built, body: usize) -> f64 {
    let Some(&(vehicle, local)) = built.model.owners.get(body) else { return f64::INFINITY };
    let vehicle = &built.model.vehicles[vehicle];
    let held = vehicle.base.is_held();
    let moving = if held { vehicle.tree.mass() - vehicle.tree.bodies[0].inertia.mass } else { vehicle.tree.mass() };
    if held && local == 0 || moving <= 0.0 { f64::INFINITY } else { moving }
}

fn normal_numbers(normal: &Normal) -> Option<[f64; 3]> {
    match normal.law {
        NormalLaw::HuntCrossley { stiffness, exponent, dissipation } => Some([stiffness, exponent, dissipation]),
        NormalLaw::SpringDamper { stiffness, damping } => Some([stiffness, 1.0, damping]),
        NormalLaw::Constant { .. } => None,
    }
}

fn thrusters(built: &Built, tapes: &[Tape]) -> Vec<ActuatorFact> {
    let largest = |actuator: usize, force: f64| {
        let own = tapes.iter().flat_map(|t| &t.commands).filter(move |c| c.actuator == actuator);
        let values = || own.clone().flat_map(|c| &c.values);
        let is_graded = values().any(|v| *v > SHUT * force && *v < (1.0 - SHUT) * force);
        if is_graded { values().fold(0.0_f64, |m, v| m.max(v.abs())) } else { 0.0 }
    };
    let all = built.model.actuators.iter().enumerate();
    all.filter_map(|(i, a)| match a.kind {
        ActuatorKind::Thruster { max_force, .. } => Some(ActuatorFact {
            place: format!("actuator:{}", a.name),
            largest_command: largest(i, max_force),
            is_thruster: true,
        }),
        ActuatorKind::JointEffort { .. } | ActuatorKind::JointDrive { .. } | ActuatorKind::LatchRelease { .. } => None,
    })
    .collect()
}

/// Share of its force up to which a thruster is shut, and short of which it is open.
const SHUT: f64 = 1e-3;
