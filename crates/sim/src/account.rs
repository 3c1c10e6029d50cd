//! The books: momentum recomputed from the links, and energy by where it is.
//!
//! The audit never reads a conserved state: it sums over the *links*, with their masses, poses and twists, and over the parts
//! that effects put inside them.
//!
//!   p = Σ m_l v_l,    L = Σ (x_l × m_l v_l + R I R^T ω_l)      about W's origin
//!   drift = |Δ − external impulse| / largest of Σ m‖v‖ (linear), Σ ‖L_link‖ (angular), in the frame of the centre of mass
//!
//! A single link does not move in that frame: its own momentum about W's origin is the scale then.

use crate::effect;
use crate::model::Base;
use crate::world::{TouchReport, World};
use multibody::{calc_armature_energy, calc_kinetic_energy};
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
        let drift = sums.total - self.start - impulse;
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
    for_each_link(world, |m, x, momentum| {
        links += u32::from(m > 0.0);
        mass += m;
        first += m * x;
        total += Wrench::new(momentum.moment + x.cross(&momentum.force), momentum.force);
    });
    total = (0..world.model().vehicles.len()).fold(total, |sum, i| sum + world.carried_momentum(i));
    if links <= 1 {
        return LinkSums { total, speed: total.force.norm(), spin: total.moment.norm() };
    }
    let (centre, drift) = (first / mass, total.force / mass);
    let (mut speed, mut spin) = (0.0, 0.0);
    for_each_link(world, |m, x, momentum| {
        let own = momentum.force - m * drift;
        speed += own.norm();
        spin += (momentum.moment + (x - centre).cross(&own)).norm();
    });
    LinkSums { total, speed, spin }
}

/// Visits every link with mass properties: mass, centre of mass in W, momentum about that centre.
fn for_each_link(world: &World, mut visit: impl FnMut(f64, Vec3, Wrench)) {
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

/// Where the energy is, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion, the joints' reflected rotors included.
    pub kinetic: f64,
    /// In gravity or the tide.
    pub potential: f64,
    /// Stored in contact: normal springs and bristles.
    pub elastic: f64,
    /// Stored in mechanisms.
    pub mechanism: f64,
    /// Held by effects: in their springs, in rotors behind a gear that yields, and in the motion of parts inside bodies.
    pub effect: f64,
}

impl Energy {
    /// At the world's present state.
    pub fn of(world: &World) -> Self {
        let model = world.model();
        let of = |(i, v): (usize, &crate::Vehicle)| {
            calc_kinetic_energy(world.kinematics(i)) + calc_armature_energy(&v.tree, &world.state().v[v.v_range()])
        };
        let kinetic = model.vehicles.iter().enumerate().map(of).sum();
        let mut potential = 0.0;
        if !model.environment.is_still() {
            for_each_link(world, |m, x, _| potential += model.environment.calc_potential(world.state().time, &x, m));
        }
        let elastic = world.touches().map(|t| calc_elastic(world, &t)).sum();
        let mechanism = world.mechanisms().map(|m| m.stored).sum();
        let effect = effect::calc_energy(model, world.state(), world.all_kinematics());
        Self { kinetic, potential, elastic, mechanism, effect }
    }
}

fn calc_elastic(world: &World, touch: &TouchReport) -> f64 {
    let law = world.model().laws[touch.pair].weighted(touch.weight);
    let bristle = law.friction.map_or(0.0, |f| 0.5 * f.spring().0 * touch.deflection * touch.deflection);
    law.normal.calc_stored_energy(touch.gap) + bristle
}
