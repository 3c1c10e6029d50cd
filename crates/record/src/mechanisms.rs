//! Channels of mechanisms: what a recording keeps of struts, bushings, latches and welds.
//!
//! | channel | unit |
//! | --- | --- |
//! | `mechanism.<strut>.length`, `.rate`, `.tension` | m, m/s, N |
//! | `mechanism.<other>.force`, `.moment`, `.status` | N, N·m, 0 open 1 engaged 2 released 3 broken |
//! | `energy.mechanism`, `energy.mechanism_work`, `energy.mechanism_loss`, where there are mechanisms | J |

use crate::{ChannelSpec, Plot};
use sim::{MechanismKind, MechanismStatus, Model, World};

/// The channels of a model's mechanisms.
pub(crate) fn channels(model: &Model) -> Vec<ChannelSpec> {
    let mut specs = Vec::new();
    let mut add = |name: String, unit: &str, plot: Plot, text: &str| {
        specs.push(ChannelSpec::new(name, unit, plot).described(text));
    };
    for mechanism in &model.mechanisms {
        let name = |quantity: &str| format!("mechanism.{}.{quantity}", mechanism.name);
        if let MechanismKind::Strut(_) = mechanism.kind {
            add(name("length"), "m", Plot::Contact, "distance of the anchors");
            add(name("rate"), "m/s", Plot::Other, "its rate");
            add(name("tension"), "N", Plot::Contact, "positive pulls");
        } else {
            add(name("force"), "N", Plot::Contact, "force that it bears");
            add(name("moment"), "N·m", Plot::Contact, "moment that it bears, about its point");
            add(name("status"), "1", Plot::Other, "0 open, 1 engaged, 2 released, 3 broken");
        }
    }
    if !model.mechanisms.is_empty() {
        add("energy.mechanism".into(), "J", Plot::Energy, "stored in mechanisms");
        add("energy.mechanism_work".into(), "J", Plot::Energy, "sum since the start");
        add("energy.mechanism_loss".into(), "J", Plot::Energy, "sum since the start");
    }
    specs
}

/// Their values, in the same order.
pub(crate) fn write(world: &World, values: &mut Vec<f64>) {
    let mut stored = 0.0;
    for report in world.mechanisms() {
        stored += report.stored;
        if let MechanismKind::Strut(_) = world.model().mechanisms[report.index].kind {
            values.extend([report.deformation[0], report.rates[0], report.tension]);
        } else {
            let status = match report.status {
                MechanismStatus::Open => 0.0,
                MechanismStatus::Engaged => 1.0,
                MechanismStatus::Released => 2.0,
                MechanismStatus::Broken => 3.0,
            };
            values.extend([report.wrench_w.force.norm(), report.wrench_w.moment.norm(), status]);
        }
    }
    if !world.model().mechanisms.is_empty() {
        let account = world.state().account;
        values.extend([stored, account.mechanism_work, account.mechanism_loss]);
    }
}
