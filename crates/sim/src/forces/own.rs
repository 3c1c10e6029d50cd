//! Forces of one's own in a step: [`crate::Force`].

use crate::model::Model;
use crate::parts::BodyMotion;
use crate::state::State;
use crate::workspace::{Pull, Pulls, Workspace};
use spatial::{Twist, Wrench};

/// Adds what forces do to the bodies to what acts from outside.
pub(crate) fn add_wrenches(model: &Model, state: &State, ws: &mut Workspace) {
    if model.forces.is_empty() {
        return;
    }
    let Pulls { mut pulls, mut motions, mut wrenches } = std::mem::take(&mut ws.pulls);
    pulls.clear();
    for (index, force) in model.forces.iter().enumerate() {
        motions.clear();
        motions.extend(force.links().iter().map(|(v, l)| {
            let (kin, tree) = (&ws.kin[*v], &model.vehicles[*v].tree);
            BodyMotion { frame_wl: kin.link_frame(tree, *l), twist: kin.link_twist(tree, *l), time: state.time }
        }));
        wrenches.clear();
        wrenches.resize(motions.len(), Wrench::default());
        force.act(&motions, &mut wrenches);
        for ((&(v, l), motion), wrench) in force.links().iter().zip(&motions).zip(&wrenches) {
            let body = model.vehicles[v].body0 + model.vehicles[v].tree.links[l].body;
            let wrench = wrench.about(&(ws.kin[v].anchor - motion.frame_wl.pos));
            ws.external[body] += wrench;
            pulls.push(Pull { force: index, at: (v, l), body, wrench });
        }
    }
    ws.pulls = Pulls { pulls, motions, wrenches };
}

/// Their works, with the twists that displace the bodies.
pub(crate) fn add_works(model: &Model, state: &mut State, ws: &Workspace, twist_of: impl Fn(usize) -> Twist, h: f64) {
    for pull in &ws.pulls.pulls {
        state.works[model.work_of_force(pull.force)] += h * twist_of(pull.body).dot(&pull.wrench);
    }
}
