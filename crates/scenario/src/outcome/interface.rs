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

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of 1 kg in a row: `a` held to `b` by an engaged latch, `c` welded to `b`; a jet of 10 N on `b`.
    fn interface() -> (World, Interface) {
        let block = |name: &str, x: f64| {
            format!(
                "[[vehicle]]\nname = \"{name}\"\nurdf = \"robots/bench/peer-block.urdf\"\npose = {{ position_m = [{x}, 0, 0] }}\n"
            )
        };
        let joined = |name: &str, kind: &str, a: &str, b: &str, rest: &str| {
            format!(
                "[[mechanism]]\nname = \"{name}\"\nkind = \"{kind}\"\na = {{ on = \"{a}/block\" }}\nb = {{ on = \"{b}/block\" }}\n{rest}\n"
            )
        };
        let latch = "engaged = true\ncapture = { axial_m = [0, 1], lateral_m = 1, tilt_deg = 9 }\n\
                     hold = { stiffness_n_per_m = 1e4, damping_n_s_per_m = 200, torsional_stiffness_n_m_per_rad = 100, \
                     torsional_damping_n_m_s_per_rad = 2 }";
        let text = format!(
            "name = \"t\"\nseed = 1\nduration_s = 2.0\n[contact_default]\nenabled = false\n{}{}{}{}{}\
             [[actuator]]\nname = \"jet\"\nkind = \"thruster\"\nlink = \"b/block\"\nposition_m = [0, 0, 0]\n\
             direction = [1, 0, 0]\nmax_force_n = 10\n",
            block("a", 0.0),
            block("b", 0.3),
            block("c", 0.6),
            joined("grip", "latch", "a", "b", latch),
            joined("joint", "weld", "c", "b", "frequency_hz = 20")
        );
        let file = format!("{}/../../s.toml", env!("CARGO_MANIFEST_DIR"));
        let scenario = crate::parse(&text, &file, &[]).unwrap_or_else(|e| panic!("{e}"));
        let mut world = crate::build(&scenario).unwrap_or_else(|e| panic!("{e}")).world;
        world.commands_mut()[0].effort = 10.0;
        for _ in 0..4_000 {
            world.advance().expect("they fly");
        }
        let interface = Interface::new(world.model(), 1, 0, &[0]);
        (world, interface)
    }

    #[test]
    fn the_latch_passes_on_what_moves_the_port_and_the_rider_counts_with_its_carrier() {
        let (world, interface) = interface();
        assert_eq!(interface.sides, [-1.0, 1.0, 1.0]);
        // Three blocks of 1 kg under 10 N: the port's one is drawn with a third, and draws back on the visitor.
        let force = interface.calc_force(&world);
        assert!((force - Vec3::new(-10.0 / 3.0, 0.0, 0.0)).norm() < 1e-3, "{force}");
    }

    #[test]
    fn two_that_are_tied_together_from_the_beginning_stand_for_themselves() {
        let (world, _) = interface();
        assert_eq!(Interface::new(world.model(), 1, 0, &[]).sides, [-1.0, 1.0, 0.0]);
    }
}
