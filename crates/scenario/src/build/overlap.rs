//! Shapes that stand inside each other at t = 0: what contact stores there before anything has moved.
//!
//! A contact law answers to depth, so an overlap that nobody meant throws its bodies apart with energy from nowhere, or
//! presses for ever on the joints that hold them. What lies or is held at rest overlaps too, by what its load presses it in. So,
//! per pair of shapes and summed over its points,
//!
//!   E = Σ ∫ fₙ dδ       stored at t = 0, J             δ = Σ fₙ δ_i / Σ fₙ      mean depth, m
//!   N                   what the contacts bear at rest, N: none gives way and none pulls, under gravity, drives and mechanisms
//!   E − N δ > 0         more is stored than the load takes on the way out
//!
//! The last says that it is deeper than its load would ever press it if it were let go at the first touch: of a linear spring,
//! deeper than twice its deflection at rest. N is that of the model as it stands, at rest, with the controller's first
//! command and contacts that bear any load and store nothing. Where the excess could throw the lighter body no faster than
//! [`QUIET`] it is left alone: it is rounding of the file's numbers.

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
/// Speed at which an excess may throw the lighter body, m/s: a third of the slowest approach in the catalogue.
const QUIET: f64 = 1e-3;
/// Step of the look at the start's loads, s: nothing moves in it.
const PROBE: f64 = 1e-6;
/// How much more than the bodies' inertia a contact that bears any load resists in that step: the load's relative error.
const UNYIELDING: f64 = 1e6;
/// Load that is told, N: less is none.
const TOLD: f64 = 1e-3;
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
    /// Of the lighter body, kg.
    mass: f64,
}

/// Refuses a mission whose shapes stand inside each other.
pub(super) fn check(mission: &Mission) -> Result<(), ScenarioErrors> {
    let found = find(&mission.world, &*mission.controller);
    let mut parting: Vec<&Overlap> = found.iter().filter(|o| o.speed() > QUIET).collect();
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
    fn excess(&self) -> f64 {
        (self.energy - self.load * self.depth).max(0.0)
    }

    /// Speed that this would give the lighter body, m/s.
    fn speed(&self) -> f64 {
        (2.0 * self.excess() / self.mass).sqrt()
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
    let bearing = bear(&start);
    for overlap in &mut found {
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
            let (pair, mass) = (touch.pair, lighter(world.model(), touch.pair));
            found.push(Overlap { pair, deepest: 0.0, depth: 0.0, energy: 0.0, force: 0.0, load: 0.0, mass });
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

/// Mass of the lighter of a pair's bodies; of its whole vehicle where the body has none of its own, kg.
fn lighter(model: &Model, pair: usize) -> f64 {
    let mass = |body: usize| {
        let Some(&(vehicle, local)) = model.owners.get(body) else { return f64::INFINITY };
        let tree = &model.vehicles[vehicle].tree;
        let own = tree.bodies[local].inertia.mass;
        if own > 0.0 { own } else { tree.mass() }
    };
    let (a, b) = model.pair_bodies(pair);
    mass(a).min(mass(b))
}

/// The world a moment after its start from rest, with contacts that neither give way nor push by themselves; those that
/// press by a constant force stay.
fn bear(start: &World) -> World {
    let mut model: Model = (**start.model()).clone();
    for pair in 0..model.laws.len() {
        if matches!(model.laws[pair].normal.law, NormalLaw::Constant { .. }) {
            continue;
        }
        let (a, b) = model.pair_bodies(pair);
        let mass = |body: usize| model.owners.get(body).map_or(f64::INFINITY, |o| model.vehicles[o.0].tree.mass());
        let damping = UNYIELDING * mass(a).min(mass(b)) / PROBE;
        let normal = Normal::new(NormalLaw::SpringDamper { stiffness: 0.0, damping });
        model.laws[pair] = PairLaw { friction: None, pivot: None, normal, ..model.laws[pair] };
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

fn tell(scenario: &Scenario, model: &Model, overlap: &Overlap, faults: &mut Faults<'_>) {
    let [a, b] = model.scene.pairs()[overlap.pair];
    let [name_a, name_b] = [a, b].map(|c| model.collider_names[c].as_str());
    let bodies = [a, b].map(|c| model.scene.colliders()[c].body);
    let held = if overlap.load >= TOLD { format!(", of which {:.3} N hold", overlap.load) } else { String::new() };
    let facts = format!(
        "\"{name_a}\" and \"{name_b}\" overlap by {:.3} mm at t = 0: contact presses with {:.3} N{held}, and stores {:.3} J, \
         enough to throw the lighter at {:.3} m/s",
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
