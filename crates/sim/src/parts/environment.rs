//! Gravity and tides, as external forces on every body.
//!
//! | environment | force on a body of mass m at x (W axes) |
//! | --- | --- |
//! | deep space | none |
//! | uniform | m g |
//! | orbit | m n² (3 (r̂·x) r̂ − x): the tide of a circular orbit, linear in x |
//!
//! In orbit, W has *inertial* axes and travels with a point on a circular orbit of mean motion n (Clohessy and
//! Wiltshire 1960, seen without rotation, so that there is no Coriolis term and attitude is inertial). At t = 0 the
//! radial direction is +x, the flight direction +y, the orbit normal +z: r̂(t) = (cos nt, sin nt, 0). With gravity
//! gradient every body also feels the torque 3n² r̂ × (I r̂) about its centre of mass (Hughes 1986, section 8.1).
//! Valid while ‖x‖ is small against the orbit's radius.

use serde::{Deserialize, Serialize};
use spatial::{Inertia, Vec3, Wrench};

/// What pulls on everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Environment {
    /// Nothing.
    #[default]
    DeepSpace,
    /// A uniform field: a laboratory, or a table out of level.
    Uniform {
        /// m/s², W axes.
        gravity: Vec3,
    },
    /// Relative motion about a circular orbit.
    Orbit {
        /// rad/s.
        mean_motion: f64,
        /// Whether bodies feel the tidal torque.
        gravity_gradient: bool,
    },
}

impl Environment {
    /// Wrench on a body about the anchor, from its inertia about the anchor (W axes) and the anchor's place in W.
    pub fn calc_wrench(&self, time: f64, anchor: &Vec3, inertia: &Inertia) -> Wrench {
        match *self {
            Self::DeepSpace => Wrench::default(),
            Self::Uniform { gravity } => Wrench::new(inertia.mc.cross(&gravity), inertia.mass * gravity),
            Self::Orbit { mean_motion, gravity_gradient } => {
                let (sin, cos) = (mean_motion * time).sin_cos();
                let radial = Vec3::new(cos, sin, 0.0);
                let rate_sq = mean_motion * mean_motion;
                let first_moment = inertia.mc + inertia.mass * anchor;
                let force = rate_sq * (3.0 * radial.dot(&first_moment) * radial - first_moment);
                let mut moment = inertia.com().cross(&force);
                if gravity_gradient {
                    moment += 3.0 * rate_sq * radial.cross(&(inertia.tensor_com() * radial));
                }
                Wrench::new(moment, force)
            }
        }
    }

    /// Potential energy of a body, J; zero at W's origin (tide in the frozen field of this instant, torque left out).
    pub fn calc_potential(&self, time: f64, com: &Vec3, mass: f64) -> f64 {
        match *self {
            Self::DeepSpace => 0.0,
            Self::Uniform { gravity } => -mass * gravity.dot(com),
            Self::Orbit { mean_motion, .. } => {
                let (sin, cos) = (mean_motion * time).sin_cos();
                let radial = com.dot(&Vec3::new(cos, sin, 0.0));
                0.5 * mass * mean_motion * mean_motion * (com.norm_squared() - 3.0 * radial * radial)
            }
        }
    }

    /// Whether it exerts nothing.
    pub fn is_still(&self) -> bool {
        matches!(self, Self::DeepSpace)
    }
}
