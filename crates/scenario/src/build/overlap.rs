//! Shapes that stand inside each other at t = 0: what contact stores there before anything has moved.
//!
//! A contact law answers to depth, so an overlap that nobody meant throws its bodies apart with energy from nowhere. What
//! lies or is held at rest overlaps too, by what its load presses it in. So, per pair of shapes and summed over its points,
//!
//!   E = Σ ∫ fₙ dδ       stored at t = 0, J             δ = Σ fₙ δ_i / Σ fₙ      mean depth, m
//!   N                   what the contacts bear at rest, N: none gives way and none pulls, under gravity, drives and mechanisms
//!   E − N δ > 0         it parts its bodies although they are pressed together
//!
//! The second says that it is deeper than its load would ever press it if it were let go at the first touch: of a linear spring,
//! deeper than twice its deflection at rest. N is that of the model as it stands, at rest, with the controller's first
//! command and contacts that bear any load and store nothing. What parts more slowly than [`QUIET`] is left alone: it is
//! rounding of the file's numbers, or held from several sides.

use super::Mission;
use super::faults::Faults;
use super::shapes::are_neighbours;
use crate::error::ScenarioErrors;
use crate::spec::Scenario;
use contact::{Normal, NormalLaw};
use sim::{Controller, Integrator, Model, PairLaw, World};
use spatial::Twist;
use std::sync::Arc;

/// Depth below which nothing is looked at, m: rounding of lengths.
const ROUNDING: f64 = 1e-9;
/// Speed at which an overlap may part its bodies, m/s: a twentieth of the slowest approach of a docking.
const QUIET: f64 = 1e-3;
/// Step of the two looks at the start's accelerations, s: contact moves by nothing in it, velocities by 10 digits above rounding.
const PROBE: f64 = 1e-6;
/// How much more than the bodies' inertia a contact that bears any load resists in that step.
const UNYIELDING: f64 = 1e4;
/// So many pairs are told one by one.
const MOST_TOLD: usize = 8;

/// A pair that overlaps.
#[derive(Clone, Debug)]
struct Overlap {
    pair: usize,
    /// Deepest point, m, and mean by force, m.
    deepest: f64,
    depth: f64,
    /// Stored, J.
    energy: f64,
    /// Force of the contact, N, and what it bears at rest, N.
    force: f64,
    load: f64,
    /// Acceleration with which the points part, mean by force, m/s².
    parting: f64,
}

/// Refuses a mission whose shapes stand inside each other.
pub(super) fn check(mission: &Mission) -> Result<(), ScenarioErrors> {
    let found = find(&mission.world, &*mission.controller);
    let mut parting: Vec<&Overlap> = found.iter().filter(|o| o.released() > 0.0 && o.speed() > QUIET).collect();
    if parting.is_empty() {
        return Ok(());
    }
    parting.sort_by(|a, b| b.energy.total_cmp(&a.energy));
    let mut faults = Faults::new(&mission.scenario);
    for overlap in parting.iter().take(MOST_TOLD) {
        tell(&mission.scenario, mission.world.model(), overlap, &mut faults);
    }
    if parting.len() > MOST_TOLD {
        let rest = &parting[MOST_TOLD..];
        let energy: f64 = rest.iter().map(|o| o.energy).sum();
        faults.add("", format!("{} more pairs of shapes overlap at t = 0, with {energy:.3} J", rest.len()));
    }
    Err(faults.into_errors())
}

impl Overlap {
    /// What is left of its energy when its bodies part against the load, J.
    fn released(&self) -> f64 {
        self.energy - self.load * self.depth
    }

    /// Speed at which they part, m/s: that of the mass which the force accelerates.
    fn speed(&self) -> f64 {
        (2.0 * self.released().max(0.0) * self.parting.max(0.0) / self.force).sqrt()
    }
}

/// All pairs that overlap, with what they store and bear.
fn find(world: &World, controller: &dyn Controller) -> Vec<Overlap> {
    let mut start = World::new(Arc::clone(world.model()), world.state().clone());
    start.refresh_touches();
    let mut found = stored(&start);
    if found.is_empty() {
        return found;
    }
    start.control(controller);
    let elastic = probe(&start, &|law, _| PairLaw { friction: None, pivot: None, normal: undamped(&law.normal), ..*law });
    let bearing = probe(&start, &|law, mass| {
        let damping = UNYIELDING * mass / PROBE;
        let normal = Normal::new(NormalLaw::SpringDamper { stiffness: 0.0, damping });
        PairLaw { friction: None, pivot: None, normal, ..*law }
    });
    for overlap in &mut found {
        overlap.parting = calc_parting(&elastic, overlap);
        overlap.load = bearing.touches().filter(|t| t.pair == overlap.pair).map(|t| t.normal_force).sum();
    }
    found
}

/// Depth, energy and force of every pair that overlaps.
fn stored(world: &World) -> Vec<Overlap> {
    let mut found: Vec<Overlap> = Vec::new();
    for touch in world.touches().filter(|t| t.gap < -ROUNDING) {
        let normal = &world.model().laws[touch.pair].normal;
        let (depth, force) = (-touch.gap, touch.weight * normal.eval(touch.gap, 0.0).force);
        let energy = touch.weight * normal.calc_stored_energy(touch.gap);
        if matches!(normal.law, NormalLaw::Constant { .. }) || force <= 0.0 {
            continue;
        }
        if found.last().is_none_or(|last| last.pair != touch.pair) {
            let (deepest, energy, force) = (0.0, 0.0, 0.0);
            found.push(Overlap { pair: touch.pair, deepest, depth: 0.0, energy, force, load: 0.0, parting: 0.0 });
        }
        if let Some(own) = found.last_mut() {
            own.depth = (own.depth * own.force + depth * force) / (own.force + force);
            own.force += force;
            own.energy += energy;
            own.deepest = own.deepest.max(depth);
        }
    }
    found
}

fn undamped(normal: &Normal) -> Normal {
    let law = match normal.law {
        NormalLaw::HuntCrossley { stiffness, exponent, .. } => {
            NormalLaw::HuntCrossley { stiffness, exponent, dissipation: 0.0 }
        }
        NormalLaw::SpringDamper { stiffness, .. } => NormalLaw::SpringDamper { stiffness, damping: 0.0 },
        NormalLaw::Constant { force } => NormalLaw::Constant { force },
    };
    Normal { law, ..*normal }
}

/// The world a moment after its start from rest, its contacts as `change` makes them of their laws and the mass (kg) of the lighter
/// vehicle; those that press by a constant force stay.
fn probe(start: &World, change: &dyn Fn(&PairLaw, f64) -> PairLaw) -> World {
    let mut model: Model = (**start.model()).clone();
    for pair in 0..model.laws.len() {
        if !matches!(model.laws[pair].normal.law, NormalLaw::Constant { .. }) {
            let (a, b) = model.pair_bodies(pair);
            let mass = |body: usize| model.owners.get(body).map_or(f64::INFINITY, |o| model.vehicles[o.0].tree.mass());
            let mass = mass(a).min(mass(b));
            model.laws[pair] = change(&model.laws[pair], mass);
        }
    }
    (model.step, model.integrator) = (PROBE, Integrator::ImplicitEuler);
    let mut state = start.state().clone();
    state.v.fill(0.0);
    let vehicles = model.vehicles.len();
    let mut world = World::new(Arc::new(model), state);
    world.set_base_twists(&vec![Twist::default(); vehicles]);
    // A start that diverges is told by the run itself.
    let _ = world.advance();
    world
}

/// Acceleration with which a pair's points part, mean by force, m/s².
fn calc_parting(world: &World, overlap: &Overlap) -> f64 {
    let model = world.model();
    let (a, b) = model.pair_bodies(overlap.pair);
    let mut sum = (0.0, 0.0);
    for touch in world.touches().filter(|t| t.pair == overlap.pair && t.normal_force > 0.0) {
        let at = |body: usize| {
            let Some(&(vehicle, local)) = model.owners.get(body) else { return spatial::Vec3::zeros() };
            let kin = world.kinematics(vehicle);
            kin.vel[local].at(&(touch.point_w - kin.anchor))
        };
        let gained = touch.normal_w.dot(&(at(b) - at(a)));
        sum = (sum.0 + touch.normal_force * gained / PROBE, sum.1 + touch.normal_force);
    }
    if sum.1 > 0.0 { sum.0 / sum.1 } else { 0.0 }
}

fn tell(scenario: &Scenario, model: &Model, overlap: &Overlap, faults: &mut Faults<'_>) {
    let [a, b] = model.scene.pairs()[overlap.pair];
    let [name_a, name_b] = [a, b].map(|c| model.collider_names[c].as_str());
    let bodies = [a, b].map(|c| model.scene.colliders()[c].body);
    let held = if overlap.load > 0.0 { format!(", of which {:.3} N hold", overlap.load) } else { String::new() };
    let facts = format!(
        "\"{name_a}\" and \"{name_b}\" overlap by {:.3} mm at t = 0: contact presses with {:.3} N{held}, stores {:.3} J and would \
         part them at {:.3} m/s",
        1e3 * overlap.deepest,
        overlap.force,
        overlap.energy,
        overlap.speed()
    );
    let off = format!("[[contact]] between = [\"{name_a}\", \"{name_b}\"], enabled = false");
    match placed_by(scenario, model, bodies) {
        Placed::Joints(vehicle) => {
            let joined = joint_between(model, bodies);
            let why = joined.map_or(String::new(), |joint| format!("; joint \"{joint}\" holds them together"));
            let key = format!("vehicle[{vehicle}].joints");
            faults.add(&key, format!("{facts}{why}. Start with other joint positions, or leave them out: {off}"));
        }
        Placed::Base(vehicle, key) => {
            let (name, path) = (&scenario.vehicles[vehicle].name, format!("vehicle[{vehicle}].{key}"));
            let way_out = format!("Move \"{name}\" by its {key}, or, where they are meant to, leave them out: {off}");
            faults.add(&path, format!("{facts}. {way_out}"));
        }
    }
}

/// What says where the second of two bodies stands against the first.
enum Placed {
    /// Joint positions of a vehicle.
    Joints(usize),
    /// A key of a vehicle.
    Base(usize, &'static str),
}

/// Of two vehicles the later one that is placed by itself is the one to move.
fn placed_by(scenario: &Scenario, model: &Model, bodies: [usize; 2]) -> Placed {
    let owners = bodies.map(|body| model.owners.get(body).map(|o| o.0));
    let vehicle = match owners {
        [Some(a), Some(b)] if a == b => return Placed::Joints(a),
        [Some(a), Some(b)] => a.max(b),
        [a, b] => a.or(b).unwrap_or(0),
    };
    let spec = &scenario.vehicles[vehicle];
    Placed::Base(
        vehicle,
        match (&spec.approach, &spec.rides_on) {
            (Some(_), _) => "approach",
            (None, Some(_)) => "rides_on",
            (None, None) => "pose",
        },
    )
}

/// The joint that holds two bodies of one vehicle together.
fn joint_between(model: &Model, bodies: [usize; 2]) -> Option<&str> {
    let [a, b] = bodies.map(|body| model.owners.get(body));
    let (&(vehicle, a), &(other, b)) = (a?, b?);
    let tree = &model.vehicles[vehicle].tree;
    (vehicle == other && are_neighbours(tree, a, b)).then(|| tree.joints[a.max(b) - 1].name.as_str())
}
