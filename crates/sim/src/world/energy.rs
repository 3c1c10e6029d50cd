//! Energy: where it is, what came in, what the laws took for good, and what no law explains.
//!
//!   E(end) − E(start) = Σ works − Σ losses − numerical loss
//!
//! E is what is stored: in motion, in contacts and bristles, in stops, mechanisms and effects, all functions of the state. Works
//! are those of actuators, drives, effects and of the environment; losses are what contacts, joints and mechanisms dissipate by
//! their laws ([`crate::Account`]). The numerical loss is the rest: what the integrator took (or, negative, gave). It
//! falls with the step at the integrator's order, and where it does not, a force is not what its law says of itself.
//!
//! Gravity and tides are works, not stores: the tide's potential changes with time.

use super::account::for_each_link;
use super::{TouchReport, World};
use crate::books::calc_bristle_energy;
use crate::forces::effects;
use crate::state::Account;
use crate::workspace::particles;
use multibody::{calc_armature_energy, calc_kinetic_energy};
use std::sync::Arc;

/// Where the energy is, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion, the joints' reflected rotors included.
    pub kinetic: f64,
    /// In gravity or the tide (frozen in the field of this instant).
    pub potential: f64,
    /// Stored in contact, normal springs and bristles, at the points of the last step: a step behind the rest.
    pub elastic: f64,
    /// In the stops of joints and the bristles of their dry friction.
    pub joint: f64,
    /// Stored in mechanisms.
    pub mechanism: f64,
    /// Held by effects: in their springs, in rotors behind a gear that yields, and in the motion of parts inside bodies.
    pub effect: f64,
}

impl Energy {
    /// At the world's present state.
    pub fn of(world: &World) -> Self {
        let (model, state) = (world.model(), world.state());
        let of = |(i, v): (usize, &crate::parts::Vehicle)| {
            calc_kinetic_energy(world.kinematics(i)) + calc_armature_energy(&v.tree, &state.v[v.v_range()])
        };
        let kinetic = model.vehicles.iter().enumerate().map(of).sum();
        let mut potential = 0.0;
        if !model.environment.is_still() {
            let mut add = |m, x| potential += model.environment.calc_potential(state.time, &x, m);
            for_each_link(world, |m, x, _| add(m, x));
            particles(model, state).for_each(|(m, x)| add(m, x));
        }
        let elastic = world.touches().map(|t| calc_elastic(world, &t)).sum();
        let scalar = model.coordinates.iter().enumerate().filter(|(_, c)| c.is_scalar);
        let joint = scalar.map(|(i, c)| c.calc_energy(state.q[c.q_index], state.dry[i])).sum();
        let mechanism = world.mechanisms().map(|m| m.stored).sum();
        let effect = effects::calc_energy(model, state, world.all_kinematics());
        Self { kinetic, potential, elastic, joint, mechanism, effect }
    }
}

fn calc_elastic(world: &World, touch: &TouchReport) -> f64 {
    let law = world.model().laws[touch.pair].weighted(touch.weight);
    let bristle = law.friction.map_or(0.0, |f| 0.5 * f.spring().0 * touch.deflection * touch.deflection);
    law.normal.calc_stored_energy(touch.gap) + bristle
}

/// Works since the start of every actuator, drive and effect, J, in the model's order; positive: put in. An effect's is net of
/// what it stores.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Works<'a> {
    /// Of joint efforts and drives (on the motor's side) and of thrusters.
    pub actuators: &'a [f64],
    /// Of prescribed motions.
    pub drives: &'a [f64],
    /// Of effects: loads from outside positive or negative, friction and dampers negative.
    pub effects: &'a [f64],
    /// Of forces of one's own.
    pub forces: &'a [f64],
}

/// Follows a run's energy from its start.
#[derive(Debug)]
pub struct EnergyAudit {
    /// Where contacts are found at the states that are looked at, so that the world itself is left alone.
    probe: World,
    stored: f64,
    in_contacts: f64,
    account: Account,
    works: [f64; 3],
}

/// What became of the energy since the start of an audit, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBalance {
    /// Change of all that is stored.
    pub stored_change: f64,
    /// Work of all actuators, thrusters and pull-in motors.
    pub actuator_work: f64,
    /// Work of prescribed motions.
    pub drive_work: f64,
    /// Work of gravity and tides.
    pub environment_work: f64,
    /// Work of effects, net of what they store, and of forces of one's own; negative where they dissipate.
    pub effect_work: f64,
    /// What contacts dissipated.
    pub contact_loss: f64,
    /// What joints dissipated.
    pub joint_loss: f64,
    /// What mechanisms dissipated.
    pub mechanism_loss: f64,
    /// What went into contacts.
    pub contact_intake: f64,
    /// Of the numerical loss, what was taken in contacts: by their springs, and by the impulses that bodies got from them.
    pub numerical_loss_in_contacts: f64,
    /// What nothing else explains: taken by the integrator, or given, where it is negative.
    pub numerical_loss: f64,
}

impl EnergyAudit {
    /// Opens the books at the world's present state.
    pub fn new(world: &World) -> Self {
        let mut probe = World::new(Arc::clone(world.model()), world.state().clone());
        let in_contacts = calc_contact_energy(world, &mut probe);
        let stored = calc_stored(world) + in_contacts;
        Self { probe, stored, in_contacts, account: world.state().account, works: sum_works(world) }
    }

    /// The balance up to the world's present state.
    pub fn close(&mut self, world: &World) -> EnergyBalance {
        let in_contacts = calc_contact_energy(world, &mut self.probe);
        let stored = calc_stored(world) + in_contacts;
        let to_motion = world.state().account.contact_to_motion - self.account.contact_to_motion;
        let contact_loss = world.state().account.contact_loss - self.account.contact_loss;
        let (account, start) = (&world.state().account, &self.account);
        let now = sum_works(world);
        let [actuators, drive_work, effect_work] = [0, 1, 2].map(|k| now[k] - self.works[k]);
        let mut balance = EnergyBalance {
            stored_change: stored - self.stored,
            actuator_work: actuators + account.pull_in_work - start.pull_in_work,
            drive_work,
            environment_work: account.environment_work - start.environment_work,
            effect_work,
            contact_loss,
            joint_loss: account.joint_loss - start.joint_loss,
            mechanism_loss: account.mechanism_loss - start.mechanism_loss,
            contact_intake: account.contact_intake - start.contact_intake,
            numerical_loss_in_contacts: self.in_contacts - in_contacts - to_motion - contact_loss,
            numerical_loss: 0.0,
        };
        balance.numerical_loss = balance.calc_work() - balance.calc_loss() - balance.stored_change;
        balance
    }
}

impl EnergyBalance {
    /// Sum of all works, J.
    pub fn calc_work(&self) -> f64 {
        self.actuator_work + self.drive_work + self.environment_work + self.effect_work
    }

    /// Sum of all losses by law, J; those of effects are negative works.
    pub fn calc_loss(&self) -> f64 {
        self.contact_loss + self.joint_loss + self.mechanism_loss
    }
}

fn sum_works(world: &World) -> [f64; 3] {
    let works = world.works();
    let sum = |of: &[f64]| of.iter().sum::<f64>();
    [sum(works.actuators), sum(works.drives), sum(works.effects) + sum(works.forces)]
}

/// All that is stored at the world's present state but in contacts, J.
fn calc_stored(world: &World) -> f64 {
    let energy = Energy::of(world);
    energy.kinetic + energy.joint + energy.mechanism + energy.effect
}

/// In normal springs and bristles, J; contacts are found anew at the world's present state.
fn calc_contact_energy(world: &World, probe: &mut World) -> f64 {
    let model = world.model();
    if model.scene.pairs().is_empty() {
        return 0.0;
    }
    probe.state_mut().copy_from(world.state());
    probe.refresh_touches();
    let normal = |t: TouchReport| t.weight * model.laws[t.pair].normal.calc_stored_energy(t.gap);
    probe.touches().map(normal).sum::<f64>() + calc_bristle_energy(model, &world.state().bristles)
}
