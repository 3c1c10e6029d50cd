//! Forces and torques on one body that have no memory.
//!
//! | effect | on the body, W axes | acts at | neutral |
//! | --- | --- | --- | --- |
//! | constant-force | F, fixed in the body or in W | centre of mass | F = 0 |
//! | constant-torque | T, likewise | – | T = 0 |
//! | linear-drag | −c v | centre of mass | c = 0 |
//! | quadratic-drag | −c ‖v‖ v | centre of mass | c = 0 |
//! | angular-damping | −c ω, ω against the inertial frame | – | c = 0 |
//! | gravity-gradient | 3 n² r̂ × (I r̂),  r̂ = (cos nt, sin nt, 0) | – | n = 0 |
//! | tether-stiffness | −k (x − a) − d ẋ, rest length zero | link's origin x | k = d = 0 |
//! | periodic-disturbance | A sin(2π f t + φ), A fixed in the body, a force or a torque | centre of mass | A = 0 |
//!
//! v is the velocity of the centre of mass in W, t the time since the run's start. Gravity gradient is that of a small
//! body on a circular orbit (Hughes 1986, section 8.1), x of W towards the zenith at t = 0, z along the orbit normal, the
//! orbit's motion from x towards y. It is the torque alone: the tide on the centre of mass belongs to the environment.

use super::motion::{Axes, BodyMotion, BodyPlace};
use spatial::{Vec3, Wrench};

/// A law of pose, twist and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// Leak, venting, offset.
    ConstantForce {
        /// N.
        vector: Vec3,
        /// Fixed in.
        axes: Axes,
    },
    /// The same, as a torque.
    ConstantTorque {
        /// N·m.
        vector: Vec3,
        /// Fixed in.
        axes: Axes,
    },
    /// Air, laminar.
    LinearDrag {
        /// N·s/m.
        c: f64,
    },
    /// Air, turbulent.
    QuadraticDrag {
        /// N·s²/m².
        c: f64,
    },
    /// Eddy currents, air.
    AngularDamping {
        /// N·m·s.
        c: f64,
    },
    /// Tidal torque on a circular orbit.
    GravityGradient {
        /// rad/s.
        mean_motion: f64,
    },
    /// Hose or cable.
    Tether {
        /// N/m.
        k: f64,
        /// N·s/m.
        d: f64,
        /// In W, m.
        anchor: Vec3,
    },
    /// Pump, wheel imbalance.
    Periodic {
        /// N or N·m, axes of the link.
        amplitude: Vec3,
        /// Whether it is a force.
        is_force: bool,
        /// 2π times the frequency, rad/s.
        rate: f64,
        /// rad.
        phase: f64,
    },
}

impl Load {
    /// On the link, about its origin, W axes.
    pub fn calc_wrench(&self, place: &BodyPlace, motion: &BodyMotion) -> Wrench {
        let rot = &motion.frame_wl.rot;
        let torque = |moment: Vec3| Wrench::new(moment, Vec3::zeros());
        match *self {
            Self::ConstantForce { vector, axes } => motion.push_at(axes.to_world(&vector, rot), &place.com),
            Self::ConstantTorque { vector, axes } => torque(axes.to_world(&vector, rot)),
            Self::LinearDrag { c } => motion.push_at(-c * motion.velocity_at(&place.com), &place.com),
            Self::QuadraticDrag { c } => {
                let v = motion.velocity_at(&place.com);
                motion.push_at(-c * v.norm() * v, &place.com)
            }
            Self::AngularDamping { c } => torque(-c * motion.twist.ang),
            Self::GravityGradient { mean_motion } => {
                let (sin, cos) = (mean_motion * motion.time).sin_cos();
                let radial = rot.tr_mul(&Vec3::new(cos, sin, 0.0));
                torque(3.0 * mean_motion * mean_motion * (rot * radial.cross(&(place.tensor_com * radial))))
            }
            Self::Tether { k, d, anchor } => {
                Wrench::new(Vec3::zeros(), -k * (motion.frame_wl.pos - anchor) - d * motion.twist.lin)
            }
            Self::Periodic { amplitude, is_force, rate, phase } => {
                let vector = rot * amplitude * (rate * motion.time + phase).sin();
                if is_force { motion.push_at(vector, &place.com) } else { torque(vector) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::{Frame, Mat3, Twist, rotation_about};

    // Round-off of a few products of numbers near one.
    const ROUND_OFF: f64 = 1e-14;

    fn place() -> BodyPlace {
        let tensor_com = Mat3::new(95.0, 1.1, -1.8, 1.1, 160.0, 0.7, -1.8, 0.7, 215.0);
        BodyPlace { vehicle: 0, link: 0, com: Vec3::new(0.1, -0.2, 0.3), tensor_com }
    }

    fn motion() -> BodyMotion {
        let rot = rotation_about(&Vec3::new(0.6, 0.0, 0.8), 0.9);
        let twist = Twist::new(Vec3::new(0.3, 0.1, -0.4), Vec3::new(1.0, 0.2, 0.7));
        BodyMotion { frame_wl: Frame { rot, pos: Vec3::new(1.0, -2.0, 0.5) }, twist, time: 2.5 }
    }

    fn wrench(load: Load) -> Wrench {
        load.calc_wrench(&place(), &motion())
    }

    #[test]
    fn forces_at_the_centre_of_mass_do_not_turn_the_body() {
        let forces = [
            Load::ConstantForce { vector: Vec3::new(1.0, 2.0, 3.0), axes: Axes::Body },
            Load::LinearDrag { c: 0.4 },
            Load::QuadraticDrag { c: 0.4 },
            Load::Periodic { amplitude: Vec3::x(), is_force: true, rate: 3.0, phase: 0.4 },
        ];
        for load in forces {
            let about_com = wrench(load).about(&(motion().frame_wl.rot * place().com));
            assert!(about_com.moment.norm() < ROUND_OFF && about_com.force.norm() > 0.1, "{load:?}");
        }
    }

    #[test]
    fn drag_and_damping_take_energy() {
        for load in [Load::LinearDrag { c: 0.4 }, Load::QuadraticDrag { c: 0.4 }, Load::AngularDamping { c: 0.4 }] {
            assert!(motion().twist.dot(&wrench(load)) < 0.0, "{load:?}");
        }
        let speed = motion().velocity_at(&place().com).norm();
        let (linear, quadratic) = (wrench(Load::LinearDrag { c: 1.0 }), wrench(Load::QuadraticDrag { c: 1.0 }));
        assert!((quadratic.force - linear.force * speed).norm() < ROUND_OFF);
    }

    #[test]
    fn a_body_vector_turns_with_the_body_and_a_world_vector_does_not() {
        let vector = Vec3::new(0.2, -0.4, 0.1);
        assert_eq!(wrench(Load::ConstantTorque { vector, axes: Axes::World }).moment, vector);
        let turned = motion().frame_wl.rot * vector;
        assert_eq!(wrench(Load::ConstantTorque { vector, axes: Axes::Body }).moment, turned);
    }

    #[test]
    fn gravity_gradient_spares_a_body_that_points_a_principal_axis_at_the_zenith() {
        let at = |angle: f64| {
            let tensor_com = Mat3::from_diagonal(&Vec3::new(95.0, 160.0, 215.0));
            let frame_wl = Frame { rot: rotation_about(&Vec3::z(), angle), pos: Vec3::zeros() };
            let motion = BodyMotion { frame_wl, twist: Twist::default(), time: 0.0 };
            Load::GravityGradient { mean_motion: 1.1e-3 }
                .calc_wrench(&BodyPlace { tensor_com, ..place() }, &motion)
                .moment
        };
        assert!(at(0.0).norm() == 0.0);
        // About z: −(3/2) n² (Iyy − Ixx) sin 2θ, which restores the smallest axis to the vertical.
        let expected = -1.5 * 1.1e-3 * 1.1e-3 * 65.0 * (0.2_f64).sin();
        assert!((at(0.1) - Vec3::new(0.0, 0.0, expected)).norm() < 1e-16);
    }

    #[test]
    fn a_tether_pulls_the_origin_to_its_anchor() {
        let pull = wrench(Load::Tether { k: 3.0, d: 0.0, anchor: Vec3::zeros() });
        assert_eq!(pull, Wrench::new(Vec3::zeros(), -3.0 * motion().frame_wl.pos));
    }
}
