//! The state at t = 0: poses, joint positions, inverse kinematics, twists.

use super::actuators::ActuatorTable;
use super::approach;
use super::faults::Faults;
use super::kinematics::solve_pose;
use crate::spec::{EndEffectorPose, Scenario};
use multibody::{Joint, JointKind};
use sim::{ActuatorKind, Model, State, World};
use spatial::{Pose, Twist};
use std::sync::Arc;

/// The world at its start.
pub(super) fn world(scenario: &Scenario, model: &Arc<Model>, table: &ActuatorTable, faults: &mut Faults<'_>) -> World {
    let mut state = State::new(model);
    for (v, vehicle) in scenario.vehicles.iter().enumerate() {
        state.bases[v] = vehicle.pose.pose();
        set_joints(scenario, model, v, &mut state, faults);
    }
    for (coordinate, speed) in &table.rotor_speeds {
        state.v[*coordinate] = *speed;
    }
    let mut world = World::new(Arc::clone(model), state);
    approach::place(scenario, &mut world, faults);
    for (v, vehicle) in scenario.vehicles.iter().enumerate() {
        if let Some(wish) = &vehicle.end_effector_pose {
            reach(&mut world, v, wish, faults);
        }
    }
    let mut twists: Vec<Twist> = Vec::with_capacity(scenario.vehicles.len());
    for (v, vehicle) in scenario.vehicles.iter().enumerate() {
        let approaching = approach::twist_of(scenario, &world, v, &twists);
        twists.push(approaching.unwrap_or_else(|| vehicle.twist.twist_wb_w(&world.state().bases[v])));
    }
    world.set_base_twists(&twists);
    hold_positions(&mut world);
    world
}

fn set_joints(scenario: &Scenario, model: &Model, v: usize, state: &mut State, faults: &mut Faults<'_>) {
    let (tree, q0, v0) = (&model.vehicles[v].tree, model.vehicles[v].q0, model.vehicles[v].v0);
    for joint in tree.joints.iter().filter(|j| is_single(j)) {
        if let Some([lower, upper]) = joint.position_limits {
            state.q[q0 + joint.q_index] = 0.0_f64.clamp(lower, upper);
        }
    }
    for (name, start) in &scenario.vehicles[v].joints {
        let key = format!("vehicle[{v}].joints.{name}");
        let single = || tree.joints.iter().filter(|j| is_single(j));
        let Some(joint) = single().find(|j| j.name == *name) else {
            faults.unknown(&key, "joint with a position of its own", name, single().map(|j| j.name.as_str()));
            continue;
        };
        if start.is_linear().is_some_and(|linear| linear != (joint.kind == JointKind::Prismatic)) {
            faults.add(&key, "revolute joints start at position_deg or position_rad, prismatic ones at position_m");
        }
        if let Some([lower, upper]) = joint.position_limits
            && !(lower..=upper).contains(&start.position())
        {
            let position = start.position();
            faults.add(&key, format!("starts at {position:.4}, outside the joint's range {lower:.4} … {upper:.4}"));
        }
        state.q[q0 + joint.q_index] = start.position();
        state.v[v0 + joint.v_index] = start.velocity();
    }
}

fn is_single(joint: &Joint) -> bool {
    !joint.is_mimic && matches!(joint.kind, JointKind::Revolute | JointKind::Prismatic)
}

/// Brings a frame of vehicle `v` to its wished pose by its joints.
fn reach(world: &mut World, v: usize, wish: &EndEffectorPose, faults: &mut Faults<'_>) {
    let key = format!("vehicle[{v}].end_effector_pose");
    let model = Arc::clone(world.model());
    let tree = &model.vehicles[v].tree;
    let Some(link) = tree.link(&wish.frame) else {
        faults.unknown(&format!("{key}.frame"), "link", &wish.frame, tree.links.iter().map(|l| l.name.as_str()));
        return;
    };
    let Some(reference) = reference_pose(world, &wish.relative_to, &key, faults) else { return };
    let goal = reference * wish.pose();
    let mut q = world.state().q[model.vehicles[v].q_range()].to_vec();
    match solve_pose(tree, &world.state().bases[v], link, &goal, &wish.joints, &mut q) {
        Ok(()) => world.state_mut().q[model.vehicles[v].q_range()].copy_from_slice(&q),
        Err(reason) => faults.add(&key, reason),
    }
    world.refresh();
}

fn reference_pose(world: &World, name: &str, key: &str, faults: &mut Faults<'_>) -> Option<Pose> {
    if name == "world" {
        return Some(Pose::identity());
    }
    let (vehicle, link) = name.split_once('/').unwrap_or((name, ""));
    let model = world.model();
    let Some(v) = model.vehicle(vehicle) else {
        faults.unknown(
            &format!("{key}.relative_to"),
            "vehicle",
            vehicle,
            model.vehicles.iter().map(|v| v.name.as_str()),
        );
        return None;
    };
    let links = &model.vehicles[v].tree.links;
    let Some(l) = links.iter().position(|l| l.name == link) else {
        faults.unknown(&format!("{key}.relative_to"), "link", link, links.iter().map(|l| l.name.as_str()));
        return None;
    };
    Some(world.link_frame(v, l).to_pose())
}

/// Drives start with what they have as reference.
fn hold_positions(world: &mut World) {
    let model = Arc::clone(world.model());
    for (i, actuator) in model.actuators.iter().enumerate() {
        if let ActuatorKind::JointDrive { coordinate, .. } = actuator.kind {
            let q_index = model.coordinates[coordinate].q_index;
            let position = world.state().q[q_index];
            world.state_mut().commands[i].position = position;
        }
    }
    world.refresh();
}
