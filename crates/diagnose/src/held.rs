//! What holds remembers: bristles of contacts, what has engaged, dry joints that stick.
//!
//! None of it is a coordinate of a start, for nothing reads it and points come and go; it is handed on from one replay to the next.

use crate::plant::Built;
use sim::{ContactMemory, MechanismKind, MechanismMemory, State};
use std::sync::Arc;

/// What a world remembers beside the coordinates of a start.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    bristles: Vec<ContactMemory>,
    mechanisms: Vec<MechanismMemory>,
    dry: Vec<f64>,
}

impl Held {
    /// What a world holds; none where its model has nothing that does.
    pub fn of(built: &Built, state: &State) -> Option<Arc<Self>> {
        let State { bristles, mechanisms, dry, .. } = state;
        let held = || Self { bristles: bristles.clone(), mechanisms: mechanisms.clone(), dry: dry.clone() };
        holds(built).then(|| Arc::new(held()))
    }

    /// Sets it in a state; a model that has other joints than that which it is of begins with them as they are.
    pub fn set(&self, state: &mut State) {
        state.bristles.clone_from(&self.bristles);
        state.mechanisms.clone_from(&self.mechanisms);
        if self.dry.len() == state.dry.len() {
            state.dry.clone_from(&self.dry);
        }
    }
}

/// Whether parts of a model touch or are held: contacts and mechanisms remember more than a start's coordinates.
pub fn holds(built: &Built) -> bool {
    let model = &built.model;
    !model.scene.pairs().is_empty() || !model.mechanisms.is_empty()
}

/// Whether a mechanism of a model holds or does not, by what went before.
pub fn engages(built: &Built) -> bool {
    built.model.mechanisms.iter().any(|m| matches!(m.kind, MechanismKind::Latch(_)))
}

#[cfg(test)]
mod tests {
    use crate::replay::tests::docking;
    use crate::replay::{Leg, Pace, Span, shoot};
    use crate::start::Start;

    /// A touch that is replayed in parts, each from where the last one ended, is the touch as a whole; with bristles that begin unloaded it is another.
    #[test]
    fn what_holds_is_handed_on() {
        let (built, tape, start) = docking();
        let leg = |from: f64, to: f64| Leg { span: Span { from, to }, members: &[], push: None, heard: &tape };
        let end = |start: &Start, from: f64, to: f64| {
            shoot(&built, &tape, start, leg(from, to), Pace::even(2.5e-4)).expect("it runs").end
        };
        let whole = end(&start, 0.0, 0.7);
        let in_parts = |hand_on: bool| {
            (0..140).fold(start.clone(), |start, k| {
                let next = end(&start, 5e-3 * f64::from(k), 5e-3 * f64::from(k + 1));
                let held = next.held.clone().filter(|_| hand_on);
                Start { held, bristles: Vec::new(), ..next }
            })
        };
        let off = |other: &Start| {
            let twists = whole.twists.iter().zip(&other.twists);
            twists.map(|(a, b)| (a.lin - b.lin).norm() + (a.ang - b.ang).norm()).fold(0.0, f64::max)
        };
        let (with, without) = (off(&in_parts(true)), off(&in_parts(false)));
        // Parts end where the whole has no step that ends.
        assert!(with < 1e-6, "{with:e}");
        assert!(without > 100.0 * with, "{without:e} beside {with:e}");
    }
}
