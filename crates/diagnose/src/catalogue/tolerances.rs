//! Nominal numbers that may be corrected within their tolerances.
//!
//! A member of a set like any effect, but no finding: its coordinates have a normal prior about the nominal value, end three standard deviations from
//! it, cost no slot and no term of the criterion. Beyond that a corrected number has to earn its place as a finding.

use super::hypotheses;
use crate::effect_set::EffectSet;
use crate::facts::Facts;
use crate::hypothesis::Hypothesis;
use scenario::spec::Tolerance;

/// Standard deviations at which a number leaves its tolerance.
const LEAVES: f64 = 3.0;

/// The members that a scenario's tolerances make, at their nominal values.
pub fn within(facts: &Facts, tolerance: &Tolerance) -> EffectSet {
    let mut set = EffectSet::default();
    for h in hypotheses(facts) {
        if let Some(h) = tolerated(h, tolerance) {
            set = set.with(&h, &h.neutral());
        }
    }
    set
}

/// The hypothesis with the standard deviations of its coordinates; none where it is exact.
fn tolerated(mut h: Hypothesis, tolerance: &Tolerance) -> Option<Hypothesis> {
    let sigma = (h.def.identify.tolerance?)(tolerance, &h.coordinates);
    // All thrusters together have no number of their own.
    if sigma.iter().all(|s| *s <= 0.0) || h.place.ends_with('*') {
        return None;
    }
    for (k, (c, s)) in h.coordinates.iter_mut().zip(&sigma).enumerate() {
        if *s > 0.0 {
            c.bounds = [(c.neutral - LEAVES * s).max(c.bounds[0]), (c.neutral + LEAVES * s).min(c.bounds[1])];
        } else if !h.held.contains(&k) {
            h.held.push(k);
        }
    }
    h.tolerance = sigma;
    Some(h)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::{BodyFact, ContactFact, JointFact, SensorFact};
    use scenario::measure::Quantity;
    use spatial::{Mat3, Vec3};

    /// A link on a driven joint, a contact and a gyro.
    fn facts() -> Facts {
        Facts {
            joints: vec![JointFact { name: "hinge".into(), largest_command: 2.0, ..JointFact::default() }],
            bodies: vec![BodyFact {
                name: "bar".into(),
                vehicle: 0,
                mass: 4.0,
                com: Vec3::new(0.2, 0.0, 0.0),
                inertia: Mat3::from_diagonal(&Vec3::new(1.0, 2.0, 3.0)),
                mask: [false; 6],
                is_base: false,
                is_on_joints: true,
                is_torque_free: false,
                is_placed: true,
            }],
            contacts: vec![ContactFact {
                name: "pad/plate".into(),
                is_linear: false,
                normal: Some([1e5, 1.5, 0.3]),
                bristle: Some([0.25, 1e5, 50.0]),
                mass: 4.0,
                has_normal_motion: true,
                unmoved_by: [false; 6],
            }],
            sensors: vec![SensorFact {
                channel: "body.bar.angular_velocity".into(),
                quantity: Quantity::AngularVelocity(0, 0),
                axes: vec![0, 1, 2],
                sigma: 1e-3,
            }],
            ..Facts::default()
        }
    }

    /// Every key frees the numbers that it names, with its standard deviation, and nothing else.
    #[test]
    fn every_key_frees_its_numbers() {
        let none = Tolerance::default();
        let cases = [
            (Tolerance { mass: 0.03, ..none }, "body-mass at body:bar", vec![0.12]),
            (Tolerance { com_m: 5e-3, ..none }, "body-com at body:bar", vec![5e-3; 3]),
            (Tolerance { inertia: 0.03, ..none }, "body-inertia at body:bar", vec![0.06; 6]),
            (Tolerance { gain: 0.02, ..none }, "actuator-gain at joint:hinge", vec![0.02]),
            (Tolerance { contact_stiffness: 0.2, ..none }, "contact-stiffness at contact:pad/plate", vec![0.2, 0.0]),
            (Tolerance { contact_damping: 0.5, ..none }, "contact-damping at contact:pad/plate", vec![0.15]),
            (Tolerance { friction: 0.2, ..none }, "friction-coefficient at contact:pad/plate", vec![0.05]),
            (
                Tolerance { mount_deg: 0.3, ..none },
                "sensor-misalignment at sensor:body.bar.angular_velocity",
                vec![0.3f64.to_radians(); 3],
            ),
            (Tolerance { clock_s: 2e-3, ..none }, "sensor-delay at sensor:body.bar.angular_velocity", vec![2e-3]),
        ];
        for (tolerance, title, sigma) in cases {
            let set = within(&facts(), &tolerance);
            let found: Vec<(String, &Vec<f64>)> = set.members.iter().map(|(h, _)| (h.title(), &h.tolerance)).collect();
            assert_eq!(found.len(), 1, "{tolerance:?}: {found:?}");
            assert_eq!(found[0].0, title);
            assert!(found[0].1.iter().zip(&sigma).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
            assert!(!set.has_findings() && set.prior_cost() == 0.0);
        }
        assert!(within(&facts(), &none).members.is_empty());
    }

    /// ((x − x₀)/σ)², its curvature and its slope.
    #[test]
    fn a_prior_is_a_parabola() {
        let mut set = within(&facts(), &Tolerance { mass: 0.03, ..Tolerance::default() });
        set.members[0].1[0] += 0.24;
        assert!((set.prior_cost() - 4.0).abs() < 1e-12);
        let mut k = nalgebra::DMatrix::zeros(2, 2);
        set.add_prior(&mut k);
        assert!((k[(0, 0)] - 1.0 / 0.0144).abs() < 1e-9 && (k[(0, 1)] - 0.24 / 0.0144).abs() < 1e-9);
        // Three standard deviations are the end of it.
        let (h, x) = &set.moved(&[(0, 0)], &[1.0]).members[0];
        assert!((x[0] - 4.36).abs() < 1e-12 && h.is_at_bound(x));
        // There, and only there, it may become a finding.
        let own = || h.clone();
        assert!(set.still_open(own()).is_none() && set.moved(&[(0, 0)], &[1.0]).still_open(own()).is_some());
        assert!((set.within_tolerances()[0] - 2.0).abs() < 1e-12);
        // The same number as a finding takes its place.
        let finding = hypotheses(&facts()).into_iter().find(|h| h.name == "body-mass").unwrap_or_else(|| h.clone());
        let with = set.with(&finding, &[5.0]);
        assert!(with.members.len() == 1 && with.has_findings() && with.prior_cost() == 0.0);
    }
}
