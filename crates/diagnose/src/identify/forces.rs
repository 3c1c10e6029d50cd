//! Unknown forces: one on every coordinate that moves, constant over an interval.

use crate::facts::Facts;
use crate::plant::Built;
use crate::start::Freedom;
use nalgebra::{DMatrix, DVector};
use sim::Push;
use spatial::{Vec3, Wrench};

/// An unknown force.
#[derive(Clone, Debug)]
pub struct Force {
    /// Place, as in the table of effects.
    pub place: String,
    /// Which of the forces there: "torque x".
    pub label: String,
    /// Where it acts.
    along: Along,
    /// A small one, N or N·m: the step of difference quotients.
    pub size: f64,
}

impl Force {
    /// The joint's coordinate on which it acts.
    pub(crate) fn joint(&self) -> Option<usize> {
        match self.along {
            Along::Joint(own) => Some(own),
            Along::Base(..) => None,
        }
    }

    /// Whether it is that on a joint's coordinate.
    pub(crate) fn acts_on(&self, coordinate: usize) -> bool {
        self.joint() == Some(coordinate)
    }
}

/// Where a force acts, and what one of unit size is.
#[derive(Clone, Copy, Debug)]
enum Along {
    /// A joint's coordinate, index into `v`.
    Joint(usize),
    /// The base link of a vehicle, about its origin, link axes.
    Base(usize, Wrench),
}

/// Steps of difference quotients: N·m or N on a joint, and on a base in shares of its inertia or mass.
const ON_JOINT: f64 = 1e-2;
const ON_BASE: f64 = 1e-4;

/// The forces on all coordinates of a model.
pub fn forces(facts: &Facts) -> Vec<Force> {
    let of_joint = |joint: &crate::facts::JointFact| Force {
        place: format!("joint:{}", joint.name),
        label: String::new(),
        along: Along::Joint(joint.coordinate),
        size: ON_JOINT,
    };
    let mut all: Vec<Force> = facts.joints.iter().map(of_joint).collect();
    for body in facts.bodies.iter().filter(|b| b.is_base) {
        for (k, name) in ["torque x", "torque y", "torque z", "force x", "force y", "force z"].into_iter().enumerate() {
            let unit = Vec3::ith(k % 3, 1.0);
            let (wrench, size) = match k < 3 {
                true => (Wrench::new(unit, Vec3::zeros()), ON_BASE * body.inertia.trace()),
                false => (Wrench::from_force_at(unit, &body.com), ON_BASE * body.mass),
            };
            if body.mask[k] {
                let along = Along::Base(body.vehicle, wrench);
                all.push(Force { place: format!("body:{}", body.name), label: name.to_owned(), along, size });
            }
        }
    }
    all
}

/// Forces of some sizes together; none where all of them are nothing.
pub fn pushing(forces: &[Force], sizes: &DVector<f64>) -> Option<Push> {
    if sizes.iter().all(|s| *s == 0.0) {
        return None;
    }
    let mut push = Push::default();
    for (force, size) in forces.iter().zip(sizes.iter()) {
        match force.along {
            Along::Joint(coordinate) => *at(&mut push.joints, coordinate) += size,
            Along::Base(vehicle, unit) => *at(&mut push.bases, vehicle) += unit * *size,
        }
    }
    Some(push)
}

fn at<T: Clone + Default>(all: &mut Vec<T>, index: usize) -> &mut T {
    if all.len() <= index {
        all.resize(index + 1, T::default());
    }
    &mut all[index]
}

/// Rate that a small force leaves, rad/s or m/s, below which it moves nothing that shows: what is left of a base's translation where only its rotation is read
/// is the tolerance of implicit steps (4e-11 in a satellite seen by its gyro alone, which made forces of 1e6 N likely).
const UNMOVED: f64 = 1e-9;

/// Forces that would by themselves move the rates as these move from interval to interval: beyond them nothing is unknown; none where it moves nothing. `steps`: changes
/// of the state over an interval; `b`: ∂end/∂f of a typical one.
pub fn first_spread(freedoms: &[Freedom], forces: &[Force], steps: &[DVector<f64>], b: &DMatrix<f64>) -> DVector<f64> {
    let rates: Vec<usize> = (0..freedoms.len()).filter(|k| freedoms[*k].is_rate()).collect();
    let of = |j: usize| {
        let column = DVector::from_iterator(rates.len(), rates.iter().map(|k| b[(*k, j)]));
        if column.norm() * forces[j].size < UNMOVED {
            return 0.0;
        }
        let along = |step: &DVector<f64>| rates.iter().zip(column.iter()).map(|(k, b)| step[*k] * b).sum::<f64>();
        let square: f64 = steps.iter().map(|s| along(s).powi(2)).sum::<f64>() / steps.len().max(1) as f64;
        square.sqrt() / column.norm_squared().max(f64::MIN_POSITIVE)
    };
    DVector::from_iterator(b.ncols(), (0..b.ncols()).map(of))
}

/// Whether a model remembers more than another: memory of effects, or joints of parts inside.
pub(crate) fn has_memory(built: &Built, beside: &Built) -> bool {
    built.start.effects.len() > beside.start.effects.len() || built.start.q.len() > beside.start.q.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::facts::{BodyFact, JointFact};
    use spatial::Mat3;

    #[test]
    fn forces_stand_where_they_act() {
        let joint = JointFact { name: "j".to_owned(), coordinate: 2, ..JointFact::default() };
        let com = Vec3::new(0.0, 0.5, 0.0);
        let body = BodyFact {
            name: "hull".to_owned(),
            vehicle: 1,
            mass: 3.0,
            com,
            inertia: Mat3::identity(),
            mask: [false, false, true, true, true, false],
            is_base: true,
            is_on_joints: false,
            is_torque_free: false,
            is_placed: true,
        };
        let all = forces(&Facts { joints: vec![joint], bodies: vec![body], ..Facts::default() });
        assert_eq!(all.iter().map(|f| f.label.as_str()).collect::<Vec<_>>(), ["", "torque z", "force x", "force y"]);
        assert!(pushing(&all, &DVector::zeros(4)).is_none());
        let push = pushing(&all, &DVector::from_vec(vec![0.3, 1.0, 2.0, 0.0])).expect("something pushes");
        assert_eq!(push.joints, [0.0, 0.0, 0.3]);
        // A force along x half a metre above the origin turns by −½ about z for each newton.
        assert_eq!((push.bases[0], push.bases[1].force), (Wrench::default(), Vec3::new(2.0, 0.0, 0.0)));
        assert_eq!(push.bases[1].moment, Vec3::new(0.0, 0.0, 1.0 - 2.0 * 0.5));
    }

    #[test]
    fn a_force_that_moves_what_shows_by_rounding_is_none() {
        let force = |size: f64| Force { place: String::new(), label: String::new(), along: Along::Joint(0), size };
        let spin = [Freedom::Spin(0, 0), Freedom::Turn(0, 0)];
        // ∂end/∂f of a torque of 0.1 kg m² over 6 s, and of a force whose 3.6e-4 N leave 4e-11 rad/s.
        let b = DMatrix::from_row_slice(2, 2, &[60.0, 1e-7, 180.0, 0.0]);
        let steps = [DVector::from_vec(vec![0.03, 0.1]), DVector::from_vec(vec![-0.03, 0.1])];
        let found = first_spread(&spin, &[force(1e-5), force(3.6e-4)], &steps, &b);
        assert!((found[0] - 0.03 / 60.0).abs() < 1e-15 && found[1] == 0.0, "{found}");
    }
}
