//! Momentum recomputed from the links.
//!
//! The audit never reads a conserved state: it sums over the *links*, with their masses, poses and twists, and over the parts
//! that effects put inside them.
//!
//!   p = Σ m_l v_l,    L = Σ (x_l × m_l v_l + R I R^T ω_l)      about W's origin
//!   drift = |Δ − external impulse|, the angular one about the centre of mass
//!   scale: largest of Σ m‖v‖ (linear), Σ (‖x_l‖ m‖v‖ + ‖I ω‖) (angular), with x and v seen from the centre of mass
//!
//! So wherever W's origin is, and however an impact passes the centre of mass, the scale is the momentum that is exchanged and the
//! lever at which it could be. A single link does not move in that frame: its own momentum about W's origin is the scale then.

use super::World;
use crate::parts::Base;
use spatial::{Vec3, Wrench};

/// Follows a run's momentum from its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentumAudit {
    start: Wrench,
    start_impulse: Wrench,
    scale_linear: f64,
    scale_angular: f64,
    /// Largest relative drift of the linear momentum so far.
    pub linear_drift: f64,
    /// Largest relative drift of the angular momentum so far.
    pub angular_drift: f64,
    /// Largest drift so far, N·s and N·m·s.
    pub absolute: [f64; 2],
}

/// Sums over all links at one instant.
struct LinkSums {
    total: Wrench,
    centre: Vec3,
    speed: f64,
    spin: f64,
}

impl MomentumAudit {
    /// Opens the books at the world's present state.
    pub fn new(world: &World) -> Self {
        let sums = calc_link_sums(world);
        Self {
            start: sums.total,
            start_impulse: world.state().account.impulse,
            scale_linear: sums.speed,
            scale_angular: sums.spin,
            linear_drift: 0.0,
            angular_drift: 0.0,
            absolute: [0.0; 2],
        }
    }

    /// Whether the account is meaningful: every vehicle floats free, and nothing holds on to the world or leans on it.
    pub fn applies(world: &World) -> bool {
        let model = world.model();
        let ground = model.world_body();
        let touches_ground =
            (0..model.scene.pairs().len()).map(|p| model.pair_bodies(p)).any(|(a, b)| a == ground || b == ground);
        let held = model.mechanisms.iter().any(|m| m.side_a.vehicle.is_none() || m.side_b.vehicle.is_none());
        model.vehicles.iter().all(|v| v.base == Base::Free) && !touches_ground && !held
    }

    /// Takes the present state into account.
    pub fn update(&mut self, world: &World) {
        let sums = calc_link_sums(world);
        let impulse = world.state().account.impulse - self.start_impulse;
        let drift = (sums.total - self.start - impulse).about(&sums.centre);
        self.scale_linear = self.scale_linear.max(sums.speed);
        self.scale_angular = self.scale_angular.max(sums.spin);
        self.absolute[0] = self.absolute[0].max(drift.force.norm());
        self.absolute[1] = self.absolute[1].max(drift.moment.norm());
        let relative = |drift: f64, scale: f64| if drift == 0.0 { 0.0 } else { drift / scale };
        self.linear_drift = relative(self.absolute[0], self.scale_linear);
        self.angular_drift = relative(self.absolute[1], self.scale_angular);
    }
}

fn calc_link_sums(world: &World) -> LinkSums {
    let (mut links, mut mass, mut first, mut total) = (0, 0.0, Vec3::zeros(), Wrench::default());
    let mut all = Vec::with_capacity(world.model().vehicles.iter().map(|v| v.tree.links.len()).sum());
    for_each_link(world, |m, x, momentum| {
        all.push((m, x, momentum));
        links += u32::from(m > 0.0);
        mass += m;
        first += m * x;
        total += Wrench::new(momentum.moment + x.cross(&momentum.force), momentum.force);
    });
    total = (0..world.model().vehicles.len()).fold(total, |sum, i| sum + world.carried_momentum(i));
    if links <= 1 {
        let lever = first.norm() / mass;
        let spin = total.moment.norm().max(lever * total.force.norm());
        return LinkSums { total, centre: first / mass, speed: total.force.norm(), spin };
    }
    let (centre, drift) = (first / mass, total.force / mass);
    let (mut speed, mut spin) = (0.0, 0.0);
    for (m, x, momentum) in all {
        let own = momentum.force - m * drift;
        speed += own.norm();
        spin += momentum.moment.norm() + (x - centre).norm() * own.norm();
    }
    LinkSums { total, centre, speed, spin }
}

/// Visits every link with mass properties: mass, centre of mass in W, momentum about that centre.
pub(crate) fn for_each_link(world: &World, mut visit: impl FnMut(f64, Vec3, Wrench)) {
    for (i, vehicle) in world.model().vehicles.iter().enumerate() {
        for (index, link) in vehicle.tree.links.iter().enumerate() {
            let frame = world.link_frame(i, index);
            let twist = world.link_twist(i, index);
            let com = link.inertia.com();
            let arm = frame.rot * com;
            let spin = frame.rot * (link.inertia.tensor_com() * frame.rot.tr_mul(&twist.ang));
            visit(link.inertia.mass, frame.pos + arm, Wrench::new(spin, link.inertia.mass * twist.at(&arm)));
        }
    }
}
