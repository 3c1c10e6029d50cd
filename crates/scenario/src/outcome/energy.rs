//! The energy of a run as figures: what was put in and by whom, what the laws dissipated, and what the integrator took.
//!
//!   stored_energy_change = Σ works − Σ losses − numerical_loss
//!
//! A warning says where the numerical loss is no small part of what went through contacts: there restitution, and with it
//! what holds and what bounces, is the step's and not the law's.

use super::Metric;
use sim::{EnergyAudit, EnergyBalance, World};
use std::borrow::Cow;

/// Share of what went into contacts above which the numerical loss is worth a warning. A contact that loses a twentieth of its energy to
/// the integrator has a restitution that is 2.5 % low.
const WORTH_A_WARNING: f64 = 0.05;
/// Energy that is nobody's business, as a share of the largest kinetic energy since the start.
const ROUND_OFF: f64 = 1e-9;

/// The energy of a run from its start.
#[derive(Debug)]
pub(super) struct EnergyWatch(EnergyAudit);

impl EnergyWatch {
    pub(super) fn new(world: &World) -> Self {
        Self(EnergyAudit::new(world))
    }

    /// Adds the figures; a warning, if there is one.
    pub(super) fn add_metrics(&mut self, world: &World, metrics: &mut Vec<Metric>) -> Option<String> {
        let balance = self.0.close(world);
        let kinetic = sim::Energy::of(world).kinetic;
        let mut add = |name: Cow<'static, str>, value: f64, meaning| {
            metrics.push(Metric { name, value: value.into(), meaning });
        };
        add("kinetic_energy_j".into(), kinetic, "at the end");
        add("stored_energy_change_j".into(), balance.stored_change, "of motion, contacts, stops, mechanisms, effects");
        add("actuator_work_j".into(), balance.actuator_work, "put in by all actuators, thrusters and pull-in motors");
        add("drive_work_j".into(), balance.drive_work, "put in by prescribed motions");
        add("environment_work_j".into(), balance.environment_work, "put in by gravity or the tide");
        add(
            "effect_work_j".into(),
            balance.effect_work,
            "put in by effects, net of what they store; negative: taken out",
        );
        let contact = world.state().account.contact_work;
        add("contact_work_j".into(), contact, "work of contact forces: negative, stored or dissipated");
        add("contact_intake_j".into(), balance.contact_intake, "what went into contacts");
        add("contact_loss_j".into(), balance.contact_loss, "dissipated by dampers and friction of contacts");
        add("joint_loss_j".into(), balance.joint_loss, "dissipated by damping, friction and stops of joints");
        add("numerical_loss_j".into(), balance.numerical_loss, "what nothing else explains: the integrator's own");
        add("numerical_loss_in_contacts_j".into(), balance.numerical_loss_in_contacts, "of it, taken in contacts");
        add_works(world, metrics);
        warn(&balance, kinetic)
    }
}

/// One figure for each actuator, drive and effect that did work.
fn add_works(world: &World, metrics: &mut Vec<Metric>) {
    let (model, works) = (world.model(), world.works());
    let mut add = |kind: &str, name: &str, work: f64| {
        if work != 0.0 {
            let name = format!("{kind}.{name}.work_j").into();
            metrics.push(Metric { name, value: work.into(), meaning: "work since the start" });
        }
    };
    model.actuators.iter().zip(works.actuators).for_each(|(a, work)| add("actuator", &a.name, *work));
    model.drives.iter().zip(works.drives).for_each(|(d, work)| add("drive", &d.name, *work));
    model.effects().iter().zip(works.effects).for_each(|(e, work)| add("effect", &e.name, *work));
}

fn warn(balance: &EnergyBalance, kinetic: f64) -> Option<String> {
    let (loss, intake) = (balance.numerical_loss_in_contacts.abs(), balance.contact_intake);
    let is_noticed = loss > WORTH_A_WARNING * intake && loss > ROUND_OFF * (kinetic + balance.stored_change.abs());
    (intake > 0.0 && is_noticed).then(|| {
        format!(
            "in contacts the integrator itself took {:.3e} J, {:.0} % of the {:.3e} J that went through them: how things bounce there is \
             decided by the step; set integrator.step_s smaller, or integrator.kind = \"implicit-midpoint\" or \"rk4\"",
            balance.numerical_loss_in_contacts,
            100.0 * loss / intake,
            intake
        )
    })
}
