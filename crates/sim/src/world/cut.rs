//! What passes through a joint, by Newton and Euler about the part beyond it:
//!
//!   w = dH_S/dt − Σ what acts on S from elsewhere,      H_S: momentum of the links S beyond the joint
//!
//! Of the body that a fixed joint runs through, the links beyond it count with their own inertia, weight, contacts, mechanisms, and the loads of effects and of
//! forces of one's own; thrusters on that body, and parts that effects put inside it, count as before the joint.

use super::{GLANCE, World};
use crate::forces::calc_external;
use crate::model::Model;
use crate::parts::EffectKind;
use multibody::Tree;
use spatial::{Frame, Inertia, Vec3, Wrench};
use std::sync::Arc;

/// The links that hang on a link, and it.
struct Beyond {
    vehicle: usize,
    links: Vec<bool>,
    /// Bodies of which all links are beyond.
    whole: Vec<bool>,
    /// The body that the cut runs through, if it runs through one.
    split: Option<usize>,
}

impl Beyond {
    fn new(tree: &Tree, vehicle: usize, link: usize) -> Self {
        let mut links = vec![false; tree.links.len()];
        links[link] = true;
        // Parents stand before their children.
        for l in link + 1..tree.links.len() {
            links[l] = tree.links[l].parent.is_some_and(|parent| links[parent]);
        }
        let of = |body: usize| (0..tree.links.len()).filter(move |l| tree.links[*l].body == body);
        let whole: Vec<bool> = (0..tree.bodies.len()).map(|b| of(b).count() > 0 && of(b).all(|l| links[l])).collect();
        let body = tree.links[link].body;
        Self { vehicle, split: (!whole[body]).then_some(body), links, whole }
    }

    /// 1 for a pair whose second shape is on a link beyond and whose first is not, −1 the other way round, else nothing.
    fn calc_sign(&self, model: &Model, pair: usize) -> f64 {
        let is_on = |collider: usize| model.link(&model.collider_links[collider]).is_some_and(|at| self.has(at));
        let [a, b] = model.scene.pairs()[pair];
        f64::from(i8::from(is_on(b))) - f64::from(i8::from(is_on(a)))
    }

    fn has(&self, (vehicle, link): (usize, usize)) -> bool {
        vehicle == self.vehicle && self.links[link]
    }
}

impl World {
    /// Force and moment that a link's parent exerts on it through the joint between them (a fixed one too), about the link's origin, W axes, N and N·m, at this
    /// instant; of a base link nothing. By differences of momentum over 20 µs under Runge–Kutta, second order. None where the world would diverge.
    pub fn calc_joint_wrench(&self, vehicle: usize, link: usize) -> Option<Wrench> {
        let tree = &self.model().vehicles[vehicle].tree;
        if tree.links[link].parent.is_none() {
            return Some(Wrench::default());
        }
        let beyond = Beyond::new(tree, vehicle, link);
        let mut ahead = self.fork();
        ahead.refresh_touches();
        let acting = ahead.calc_acting_on(&beyond);
        let before = ahead.calc_momentum_of(&beyond);
        ahead.advance_by(GLANCE).ok()?;
        // Moments of contacts are held through a step.
        let acting = acting + ahead.calc_pivots_on(&beyond);
        let near = ahead.calc_momentum_of(&beyond) - before;
        ahead.advance_by(GLANCE).ok()?;
        let far = ahead.calc_momentum_of(&beyond) - before;
        let change = (near * 4.0 - far) * (0.5 / GLANCE);
        Some((change - acting).about(&self.link_frame(vehicle, link).pos))
    }

    /// Momentum of the links, about W's origin.
    fn calc_momentum_of(&self, beyond: &Beyond) -> Wrench {
        let kin = self.kinematics(beyond.vehicle);
        let bodies = beyond.whole.iter().enumerate().filter(|(_, is_whole)| **is_whole);
        let mut sum = bodies.fold(Wrench::default(), |sum, (b, _)| sum + kin.inertia[b].momentum(&kin.vel[b]));
        if let Some(body) = beyond.split {
            sum += self.calc_split_inertia(beyond, body).momentum(&kin.vel[body]);
        }
        sum.about(&-kin.anchor)
    }

    /// Inertia of the links beyond on the body that the cut runs through, about the anchor, W axes.
    fn calc_split_inertia(&self, beyond: &Beyond, body: usize) -> Inertia {
        let (kin, tree) = (self.kinematics(beyond.vehicle), &self.model().vehicles[beyond.vehicle].tree);
        let links = tree.links.iter().enumerate().filter(|(l, link)| link.body == body && beyond.links[*l]);
        links.fold(Inertia::default(), |sum, (l, link)| {
            let Frame { rot, pos } = kin.link_frame(tree, l);
            sum + link.inertia.transformed(&rot, &(pos - kin.anchor))
        })
    }

    /// What acts on the links from elsewhere, about W's origin: contacts as [`World::refresh_touches`] left them.
    fn calc_acting_on(&mut self, beyond: &Beyond) -> Wrench {
        let model = Arc::clone(self.model());
        calc_external(&model, &self.state, &mut self.ws);
        let own = &model.vehicles[beyond.vehicle];
        let anchor = self.kinematics(beyond.vehicle).anchor;
        let whole = |local: &usize| beyond.whole[*local];
        let mut sum = Wrench::default();
        for local in (0..own.tree.bodies.len()).filter(whole) {
            sum += self.ws.external[own.body0 + local] + self.ws.parts.internal[own.body0 + local];
        }
        if let Some(body) = beyond.split {
            let inertia = self.calc_split_inertia(beyond, body);
            sum += model.environment.calc_wrench(self.state().time, &anchor, &inertia);
            sum += self.calc_loads_on(beyond, body);
        }
        let mut sum = sum.about(&-anchor);
        sum += self.calc_contacts_on(&model, beyond);
        for (mechanism, report) in model.mechanisms.iter().zip(self.mechanisms()) {
            let [a, b] =
                [&mechanism.side_a, &mechanism.side_b].map(|s| s.vehicle.is_some_and(|v| beyond.has((v, s.link))));
            let sign = f64::from(i8::from(b)) - f64::from(i8::from(a));
            sum += report.wrench_w.about(&-report.point_w) * sign;
        }
        sum
    }

    /// Loads of effects and forces of one's own on links beyond, of the body that the cut runs through; about the anchor.
    fn calc_loads_on(&self, beyond: &Beyond, body: usize) -> Wrench {
        let is_here =
            |link: usize| beyond.links[link] && self.model().vehicles[beyond.vehicle].tree.links[link].body == body;
        let effects = self.model().effects().iter().enumerate().filter_map(|(index, effect)| match &effect.kind {
            EffectKind::Body(on) if on.place.vehicle == beyond.vehicle && is_here(on.place.link) => Some(index),
            _ => None,
        });
        let loads = effects.map(|index| self.ws.parts.load_of(index)).fold(Wrench::default(), |sum, w| sum + w);
        let pulls = self.ws.pulls.pulls.iter().filter(|pull| pull.at.0 == beyond.vehicle && is_here(pull.at.1));
        pulls.fold(loads, |sum, pull| sum + pull.wrench)
    }

    /// Forces of what touches the links, about W's origin.
    fn calc_contacts_on(&self, model: &Model, beyond: &Beyond) -> Wrench {
        let mut sum = Wrench::default();
        for touch in self.touches() {
            let sign = beyond.calc_sign(model, touch.pair);
            if sign != 0.0 {
                sum += Wrench::from_force_at(sign * touch.force_w, &touch.point_w);
            }
        }
        sum
    }

    /// Moments of touching points that resist turning.
    fn calc_pivots_on(&self, beyond: &Beyond) -> Wrench {
        let pivots = self.ws.pivots.iter();
        let moment = pivots.map(|p| beyond.calc_sign(self.model(), p.pair as usize) * p.moment).sum();
        Wrench::new(moment, Vec3::zeros())
    }
}
