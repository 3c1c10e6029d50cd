//! All hypotheses: every effect at every place where it could act, with the points at which it is screened.
//!
//! What could act where is the business of the effects' definitions; here are the places, in their order.

mod tolerances;

pub use tolerances::within;

use crate::facts::Facts;
use crate::hypothesis::Hypothesis;
use scenario::effects;
use scenario::effects::candidate::Candidate;
use scenario::effects::facts::ActuatorFact;
use scenario::effects::identify::Candidates;

/// Enumerates what could be left out of the model.
pub fn hypotheses(facts: &Facts) -> Vec<Hypothesis> {
    let survey = facts.survey();
    let mut all = Vec::new();
    for joint in &facts.joints {
        add(&mut all, |c| c.at_joint(joint, &survey));
    }
    for actuator in &actuators(facts) {
        add(&mut all, |c| c.at_actuator(actuator));
    }
    for body in &facts.bodies {
        add(&mut all, |c| c.at_body(body, &survey));
    }
    add(&mut all, |c| c.at_world(&survey));
    for contact in &facts.contacts {
        add(&mut all, |c| c.at_contact(contact));
    }
    for mechanism in &facts.mechanisms {
        add(&mut all, |c| c.at_mechanism(mechanism));
    }
    for sensor in &facts.sensors {
        add(&mut all, |c| c.at_sensor(sensor));
    }
    all
}

/// Adds the candidates of every effect at one place.
fn add(all: &mut Vec<Hypothesis>, at: impl Fn(&Candidates) -> Vec<Candidate>) {
    for def in effects::catalogue() {
        all.extend(at(&def.identify.candidates).into_iter().map(|candidate| Hypothesis::new(def, candidate)));
    }
}

/// Drives of joints whose command was recorded, thrusters, and all thrusters together.
fn actuators(facts: &Facts) -> Vec<ActuatorFact> {
    let driven = facts.joints.iter().filter(|j| j.largest_command > 0.0);
    let drive = driven.map(|joint| ActuatorFact {
        place: joint.place(),
        largest_command: joint.largest_command,
        is_thruster: false,
    });
    let all = || ActuatorFact { place: "actuator:*".to_owned(), largest_command: 0.0, is_thruster: true };
    let together = (facts.thrusters.len() > 1).then(all);
    drive.chain(facts.thrusters.iter().cloned()).chain(together).collect()
}
