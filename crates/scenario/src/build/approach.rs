//! A vehicle in front of a port: its interface frame F stands and moves relative to the port's frame P as the file says.
//!
//!   R_PF = exp(tilt) R_z(roll) R_x(π),     p_PF = (lateral, distance)            nominal: z against z, x along x
//!   ṗ_PF = (lateral rate, −closing) as seen in P,     ω_PF = (tilt rate, roll rate) in P's axes
//!
//! A vehicle that rides on a link of another (a ring on its struts) stands at rest in that link's frame, and goes with it.
//!
//! `at_contact` moves F along P's z to where the first shapes of the two vehicles (riders included) are about to touch: a march inwards, then a
//! bisection. What stands in the file is then the standard's contact condition, whatever the form of the parts.

use super::faults::Faults;
use crate::spec::{Approach, Scenario};
use sim::{MechanismKind, Model, World};
use spatial::{Pose, Rot, Twist, Vec3, exp_rotation};

/// Step of the march inwards, m: below the thickness of any wall that a probe could pass unseen.
const MARCH: f64 = 4e-3;
/// Width at which the bisection ends, m; the start is on the open side of it.
const NEAR: f64 = 1e-7;

/// The frames between which an approach is told.
#[derive(Clone, Debug)]
struct Ends {
    vehicle: usize,
    frame: usize,
    /// Vehicles that ride on it.
    riders: Vec<usize>,
    /// The interface frame in the base, with the joints as they stand.
    pose_bf: Pose,
    port_vehicle: usize,
    port: usize,
}

/// Puts every vehicle with an approach in its place; twists come later, by [`twist_of`].
pub(super) fn place(scenario: &Scenario, world: &mut World, faults: &mut Faults<'_>) {
    for v in 0..scenario.vehicles.len() {
        carry(scenario, world, v, faults);
        let Some((approach, ends)) = resolve(scenario, world, v, faults) else { continue };
        let mut move_to = |distance| put(scenario, world, (&approach, &ends), distance);
        move_to(approach.distance_m);
        if approach.at_contact {
            move_to_contact(scenario, world, (&approach, &ends));
        }
    }
}

/// Link of another vehicle on which vehicle `v` rides, and the base in it.
fn carrier(scenario: &Scenario, world: &World, v: usize) -> Option<((usize, usize), Pose)> {
    let side = scenario.vehicles[v].rides_on.as_ref()?;
    Some((world.model().link(&side.on).filter(|(host, _)| *host < v)?, side.pose()))
}

/// Puts a vehicle that rides on another's link in its place.
fn carry(scenario: &Scenario, world: &mut World, v: usize, faults: &mut Faults<'_>) {
    let vehicle = &scenario.vehicles[v];
    let Some(side) = &vehicle.rides_on else { return };
    let key = format!("vehicle[{v}].rides_on");
    let Some(((host, link), pose)) = carrier(scenario, world, v) else {
        let valid = world.model().vehicles[..v]
            .iter()
            .flat_map(|v| v.tree.links.iter().map(|l| format!("{}/{}", v.name, l.name)));
        let valid: Vec<String> = valid.collect();
        faults.unknown(
            &format!("{key}.on"),
            "link of a vehicle above this one",
            &side.on,
            valid.iter().map(String::as_str),
        );
        return;
    };
    if vehicle.pose != Default::default() || vehicle.twist != Default::default() || vehicle.approach.is_some() {
        faults.add(&key, "a vehicle that rides on another is placed by that; leave out its pose, twist and approach");
    }
    let pose_wl = world.link_frame(host, link).to_pose();
    world.state_mut().bases[v] = pose_wl * pose;
    world.refresh();
}

/// Twist of the base of vehicle `v`, W axes, about its origin, with the twists of the vehicles before it known; `None` where the
/// file gives them.
pub(super) fn twist_of(scenario: &Scenario, world: &World, v: usize, before: &[Twist]) -> Option<Twist> {
    if let Some(((host, _), _)) = carrier(scenario, world, v) {
        let [own, base] = [v, host].map(|v| world.state().bases[v].translation.vector);
        return Some(before.get(host)?.about(&(own - base)));
    }
    let (approach, ends) = resolve(scenario, world, v, &mut Faults::new(scenario))?;
    let port = world.link_frame(ends.port_vehicle, ends.port);
    let (frame, base) = (world.link_frame(v, ends.frame), world.state().bases[v].translation.vector);
    let carrier = before.get(ends.port_vehicle)?;
    let at_frame = carrier.about(&(frame.pos - world.state().bases[ends.port_vehicle].translation.vector));
    let [x, y] = approach.lateral_m_per_s;
    let [tilt_x, tilt_y] = approach.tilt_deg_per_s.map(f64::to_radians);
    let linear = at_frame.lin + port.rot * Vec3::new(x, y, -approach.closing_m_per_s);
    let angular = carrier.ang + port.rot * Vec3::new(tilt_x, tilt_y, approach.roll_deg_per_s.to_radians());
    Some(Twist::new(angular, linear + angular.cross(&(base - frame.pos))))
}

/// The frames and latches that `[docking]` names exist.
pub(super) fn check_docking(scenario: &Scenario, model: &Model, faults: &mut Faults<'_>) {
    let Some(docking) = &scenario.docking else { return };
    for (key, name) in [("visitor", &docking.visitor), ("port", &docking.port)] {
        if model.link(name).is_none() {
            let links = |v: &sim::Vehicle| v.tree.links.iter().map(|l| format!("{}/{}", v.name, l.name)).collect();
            let valid: Vec<String> = model.vehicles.iter().flat_map(|v| -> Vec<String> { links(v) }).collect();
            faults.unknown(&format!("docking.{key}"), "link", name, valid.iter().map(String::as_str));
        }
    }
    let is_latch = |m: &&sim::Mechanism| matches!(m.kind, MechanismKind::Latch(_));
    let latches: Vec<&str> = model.mechanisms.iter().filter(is_latch).map(|m| m.name.as_str()).collect();
    for (key, names) in [("capture", &docking.capture), ("hard_dock", &docking.hard_dock)] {
        for (i, name) in names.iter().enumerate().filter(|(_, n)| !latches.contains(&n.as_str())) {
            faults.unknown(&format!("docking.{key}[{i}]"), "latch", name, latches.iter().copied());
        }
    }
}

/// The approach of vehicle `v` with its names resolved; what cannot be is a fault.
fn resolve(scenario: &Scenario, world: &World, v: usize, faults: &mut Faults<'_>) -> Option<(Approach, Ends)> {
    let vehicle = &scenario.vehicles[v];
    let approach = vehicle.approach.clone()?;
    let (model, key) = (world.model(), format!("vehicle[{v}].approach"));
    if vehicle.pose != Default::default() || vehicle.twist != Default::default() {
        faults.add(&key, "an approach says where the vehicle is and how it moves; leave out its pose and twist");
    }
    if !vehicle.base.is_free() {
        faults.add(&key, "only a vehicle with a free base can approach");
    }
    let links = |v: usize| model.vehicles[v].tree.links.iter().map(|l| l.name.as_str());
    let Some(frame) = model.vehicles[v].tree.link(&approach.frame) else {
        faults.unknown(&format!("{key}.frame"), "link", &approach.frame, links(v));
        return None;
    };
    let (name, link) = approach.port.split_once('/').unwrap_or((&approach.port, ""));
    let Some(port_vehicle) = model.vehicle(name).filter(|p| *p < v) else {
        let valid = model.vehicles[..v].iter().map(|v| v.name.as_str());
        faults.unknown(&format!("{key}.port"), "vehicle that stands above this one", name, valid);
        return None;
    };
    let Some(port) = model.vehicles[port_vehicle].tree.link(link) else {
        faults.unknown(&format!("{key}.port"), "link", link, links(port_vehicle));
        return None;
    };
    let pose_bf = world.state().bases[v].inverse() * world.link_frame(v, frame).to_pose();
    let on_it = |rider: &usize| carrier(scenario, world, *rider).is_some_and(|((host, _), _)| host == v);
    let riders = (v + 1..scenario.vehicles.len()).filter(on_it).collect();
    Some((approach, Ends { vehicle: v, frame, riders, pose_bf, port_vehicle, port }))
}

/// Puts the base so that the interface frame stands at `distance` from the port.
fn put(scenario: &Scenario, world: &mut World, (approach, ends): (&Approach, &Ends), distance: f64) {
    let [x, y] = approach.lateral_m;
    let [tilt_x, tilt_y] = approach.tilt_deg.map(f64::to_radians);
    let facing = Rot::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
    let roll = Rot::from_axis_angle(&Vec3::z_axis(), approach.roll_deg.to_radians());
    let attitude = exp_rotation(&Vec3::new(tilt_x, tilt_y, 0.0)) * roll * facing;
    let pose_pf = Pose::from_parts(Vec3::new(x, y, distance).into(), attitude);
    let pose_wp = world.link_frame(ends.port_vehicle, ends.port).to_pose();
    world.state_mut().bases[ends.vehicle] = pose_wp * pose_pf * ends.pose_bf.inverse();
    world.refresh();
    for rider in &ends.riders {
        carry(scenario, world, *rider, &mut Faults::new(scenario));
    }
}

/// Marches inwards until something touches, and comes back to just before.
fn move_to_contact(scenario: &Scenario, world: &mut World, (approach, ends): (&Approach, &Ends)) {
    let far = approach.distance_m;
    // A vehicle that has passed the port's plane by as much as it stood before it will touch nothing.
    let marches = (2.0 * far.abs() / MARCH).ceil() as usize;
    let first = (0..=marches).find(|k| touches_at(scenario, world, (approach, ends), far - MARCH * *k as f64));
    let Some(k) = first.filter(|k| *k > 0) else {
        put(scenario, world, (approach, ends), far);
        return;
    };
    let (mut inside, mut outside) = (far - MARCH * k as f64, far - MARCH * (k - 1) as f64);
    while outside - inside > NEAR {
        let middle = 0.5 * (outside + inside);
        if touches_at(scenario, world, (approach, ends), middle) { inside = middle } else { outside = middle }
    }
    put(scenario, world, (approach, ends), outside);
}

/// Whether a shape of the vehicle overlaps one of the port's at a distance.
fn touches_at(scenario: &Scenario, world: &mut World, (approach, ends): (&Approach, &Ends), distance: f64) -> bool {
    put(scenario, world, (approach, ends), distance);
    world.refresh_touches();
    let model = world.model();
    let owner = |body: usize| model.owners.get(body).map(|o| o.0);
    let comes = |v: Option<usize>| v.is_some_and(|v| v == ends.vehicle || ends.riders.contains(&v));
    let stands = |v: Option<usize>| v == Some(ends.port_vehicle);
    world.touches().any(|touch| {
        let (a, b) = model.pair_bodies(touch.pair);
        let (a, b) = (owner(a), owner(b));
        touch.gap < 0.0 && ((comes(a) && stands(b)) || (stands(a) && comes(b)))
    })
}
