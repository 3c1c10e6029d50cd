//! The gripper of a capture: its fingers, and what it feels.

use crate::build::{ActuatorTable, Faults};
use crate::spec::{Scenario, Sensor, SensorKind, TrackAndGrasp};
use sim::{ActuatorKind, Known, Model, World};
use spatial::{Rot, Vec3};

/// Fingers that close on a target.
#[derive(Clone, Debug)]
pub(super) struct Gripper {
    servicer: usize,
    target: usize,
    pub(super) fingers: Vec<Finger>,
    pads: Vec<Pad>,
}

#[derive(Clone, Debug)]
pub(super) struct Finger {
    pub(super) actuator: usize,
    /// Fingers that move with this coordinate: followers count.
    pub(super) count: f64,
}

/// A sensor of what touches a part of the servicer.
#[derive(Clone, Debug)]
struct Pad {
    quantity: String,
    link: usize,
    rot_ls: Rot,
}

/// The gripper of a servicer, by vehicle, and of its target.
pub(super) fn build(
    (scenario, spec): (&Scenario, &TrackAndGrasp),
    model: &Model,
    table: &ActuatorTable,
    (servicer, target): (usize, usize),
    faults: &mut Faults<'_>,
) -> Option<Gripper> {
    let fingers = fingers_of(spec, model, table, servicer, faults)?;
    let pads = pads_of(scenario, model, servicer);
    if pads.is_empty() && !scenario.navigation.perfect {
        let reason = format!(
            "says nothing of what \"{}\" touches, and the gripper must feel what it closes on; add a [[sensor]] of kind \
             contact-force on its pads",
            spec.servicer
        );
        faults.add("sensor", reason);
    }
    Some(Gripper { servicer, target, fingers, pads })
}

/// The sensors of contact that a vehicle carries.
fn pads_of(scenario: &Scenario, model: &Model, vehicle: usize) -> Vec<Pad> {
    let pad = |sensor: &Sensor| {
        let SensorKind::ContactForce { link, pose, .. } = &sensor.kind else { return None };
        let (owner, link) = model.link(link)?;
        let quantity = format!("sensor.{}.force", sensor.name);
        (owner == vehicle).then(|| Pad { quantity, link, rot_ls: pose.pose().rotation })
    };
    scenario.sensors.iter().filter_map(pad).collect()
}

fn fingers_of(
    spec: &TrackAndGrasp,
    model: &Model,
    table: &ActuatorTable,
    vehicle: usize,
    faults: &mut Faults<'_>,
) -> Option<Vec<Finger>> {
    let owner = &model.vehicles[vehicle];
    let mut fingers = Vec::new();
    for name in spec.gripper.names() {
        let Some(joint) = owner.tree.joints.iter().find(|j| j.name == *name && !j.is_mimic) else {
            let valid = owner.tree.joints.iter().filter(|j| !j.is_mimic).map(|j| j.name.as_str());
            faults.unknown("strategy.gripper", "joint with a position of its own", name, valid);
            return None;
        };
        let coordinate = owner.v0 + joint.v_index;
        let acts = |a: &usize| matches!(table.actuators[*a].kind, ActuatorKind::JointDrive { coordinate: c, stiffness, .. } if c == coordinate && stiffness == 0.0);
        let Some(actuator) = (0..table.actuators.len()).find(acts) else {
            let reason =
                format!("joint \"{name}\" needs a joint-drive of zero stiffness: a rate loop with a force limit");
            faults.add("strategy.gripper", reason);
            return None;
        };
        let count = owner.tree.joints.iter().filter(|j| j.v_index == joint.v_index).count() as f64;
        fingers.push(Finger { actuator, count });
    }
    Some(fingers)
}

impl Gripper {
    /// The smaller of the forces that press the target from the two sides, N.
    pub(super) fn calc_press(&self, known: &Known<'_>, axis: &Vec3) -> f64 {
        let [plus, minus] = self.calc_presses(known, axis);
        plus.min(minus)
    }

    /// Forces on the target along the closing axis (W), by sign, N: what touches it, or what the pads' sensors say.
    pub(super) fn calc_presses(&self, known: &Known<'_>, axis: &Vec3) -> [f64; 2] {
        let forces = if known.is_perfect { self.find_touches(known.world) } else { self.read_pads(known) };
        let (mut plus, mut minus) = (0.0, 0.0);
        for force in forces {
            let along = force.dot(axis);
            if along > 0.0 { plus += along } else { minus -= along }
        }
        [plus, minus]
    }

    /// Forces between servicer and target, on the target, W axes, N.
    fn find_touches(&self, world: &World) -> Vec<Vec3> {
        let vehicle = |body: usize| world.model().owners.get(body).map(|o| o.0);
        let on_target = |touch: sim::TouchReport| {
            let (a, b) = world.model().pair_bodies(touch.pair);
            match (vehicle(a), vehicle(b)) {
                (Some(s), Some(t)) if s == self.servicer && t == self.target => Some(touch.force_w),
                (Some(t), Some(s)) if s == self.servicer && t == self.target => Some(-touch.force_w),
                _ => None,
            }
        };
        world.touches().filter_map(on_target).collect()
    }

    /// What the servicer's sensors of contact say presses the target, W axes, N.
    fn read_pads(&self, known: &Known<'_>) -> Vec<Vec3> {
        let on_target = |pad: &Pad| {
            let said = known.find(&pad.quantity)?;
            let force = pad.rot_ls * Vec3::from_column_slice(&said.value[..3]);
            Some(-(known.world.link_frame(self.servicer, pad.link).rot * force))
        };
        self.pads.iter().filter_map(on_target).collect()
    }
}
