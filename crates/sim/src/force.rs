//! Forces of one's own: what a user of the library adds to a model without a line here.
//!
//! A [`Force`] acts on links. It is evaluated where forces from outside are: at the start of a step by the Euler schemes, at its middle by the midpoint rule,
//! at every stage by Runge–Kutta; explicitly, so that a stiff one wants a short step. Its impulse stands in the account of impulses and its work in that of
//! works ([`crate::Works::forces`], the balance's `effect_work`), with the twists that displace its links, so that the audits of momentum and energy close
//! over it as over everything else.

use crate::effect::BodyMotion;
use crate::error::ModelError;
use crate::model::Model;
use crate::state::State;
use crate::workspace::Workspace;
use spatial::{Twist, Wrench};
use std::sync::Arc;

/// A force: a function of time and of how its links move.
pub trait Force: std::fmt::Debug + Send + Sync {
    /// For messages.
    fn name(&self) -> &str;

    /// The links that it acts on, as vehicle and link ([`Model::link`]); the same at every call.
    fn links(&self) -> &[(usize, usize)];

    /// Adds what acts on each link to `wrenches`: about the link's origin, W axes, N·m and N. All three are in the order of [`Self::links`].
    ///
    /// Two links that pull at each other get opposite forces on one line: only then is momentum kept.
    fn act(&self, motions: &[BodyMotion], wrenches: &mut [Wrench]);
}

/// What a force does to one body, about the anchor of the body's vehicle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    force: usize,
    pub at: (usize, usize),
    body: usize,
    pub wrench: Wrench,
}

/// Scratch of all forces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pulls {
    pub pulls: Vec<Pull>,
    motions: Vec<BodyMotion>,
    wrenches: Vec<Wrench>,
}

impl Model {
    /// The same model with forces of one's own. Errors: one that acts on a link that is not there.
    pub fn with_forces(mut self, forces: Vec<Arc<dyn Force>>) -> Result<Self, ModelError> {
        let is_there = |(v, l): &(usize, usize)| self.vehicles.get(*v).is_some_and(|v| *l < v.tree.links.len());
        for force in &forces {
            if let Some((vehicle, link)) = force.links().iter().find(|at| !is_there(at)) {
                let fault = format!("acts on link {link} of vehicle {vehicle}, which is not there; see Model::link");
                return Err(ModelError::Force { name: force.name().to_owned(), fault });
            }
        }
        self.forces = forces;
        Ok(self)
    }
}

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
