//! The force that passes from one side of a docking to the other: the resultant of contact and latches.
//!
//!   F = Σ contact forces on the visitor's side from the port's + Σ forces of the mechanisms between them        N
//!
//! A side is the vehicle of an interface frame and all that mechanisms other than the docking's latches hold to it, such as a ring
//! on its struts; what presses on both within one side (a petal against its own ring) is none of the interface's load.

use sim::{Model, World};
use spatial::Vec3;

/// Which vehicles stand on which side.
#[derive(Clone, Debug)]
pub(super) struct Interface {
    /// Per vehicle: +1 the visitor's side, −1 the port's, 0 neither.
    sides: Vec<f64>,
}

impl Interface {
    /// Between the vehicles `visitor` and `port`, which the mechanisms `latches` join.
    pub(super) fn new(model: &Model, visitor: usize, port: usize, latches: &[usize]) -> Self {
        let mut group: Vec<usize> = (0..model.vehicles.len()).collect();
        let others = model.mechanisms.iter().enumerate().filter(|(i, _)| !latches.contains(i));
        for (_, mechanism) in others {
            if let (Some(a), Some(b)) = (mechanism.side_a.vehicle, mechanism.side_b.vehicle) {
                let (from, to) = (group[a], group[b]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
        // Tied to each other from the beginning, the two stand for themselves alone.
        let is_one = group[visitor] == group[port];
        let belongs = |v: usize, to: usize| v == to || (!is_one && group[v] == group[to]);
        let side = |v: usize| f64::from(u8::from(belongs(v, visitor))) - f64::from(u8::from(belongs(v, port)));
        Self { sides: (0..model.vehicles.len()).map(side).collect() }
    }

    /// Resultant force on the visitor's side from the port's, W axes, N.
    pub(super) fn calc_force(&self, world: &World) -> Vec3 {
        let model = world.model();
        let of_body = |body: usize| model.owners.get(body).map(|owner| owner.0);
        // +1 where B is the visitor's and A the port's, −1 the other way round, 0 where they are of one side.
        let sign = |a: Option<usize>, b: Option<usize>| {
            let [a, b] = [a, b].map(|v| v.map_or(0.0, |v| self.sides[v]));
            if a * b < 0.0 { b } else { 0.0 }
        };
        let contact = world.touches().map(|touch| {
            let (a, b) = model.pair_bodies(touch.pair);
            sign(of_body(a), of_body(b)) * touch.force_w
        });
        let latches = world.mechanisms().map(|report| {
            let mechanism = &model.mechanisms[report.index];
            sign(mechanism.side_a.vehicle, mechanism.side_b.vehicle) * report.wrench_w.force
        });
        contact.chain(latches).fold(Vec3::zeros(), |sum, force| sum + force)
    }
}
