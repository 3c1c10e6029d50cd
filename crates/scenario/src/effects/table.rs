//! The table: places and parameters of every effect.

use super::{EffectName, Entry, Neutral, Parameter, PlaceKind, Shape};
use PlaceKind::{Actuator, Body, Contact, Joint, Link, Sensor, World};

const POSITIVE: [f64; 2] = [f64::MIN_POSITIVE, f64::INFINITY];
const AT_LEAST_ZERO: [f64; 2] = [0.0, f64::INFINITY];
const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// A level, force or coefficient: zero is neutral.
const fn zero(name: &'static str, range: [f64; 2]) -> Parameter {
    Parameter { name, shape: Shape::Number, neutral: Neutral::Value(0.0), is_required: true, range }
}

/// A number that is neutral at `value`.
const fn neutral(name: &'static str, value: f64, range: [f64; 2]) -> Parameter {
    Parameter { neutral: Neutral::Value(value), ..zero(name, range) }
}

/// A corrected number of the nominal model.
const fn nominal(name: &'static str, range: [f64; 2]) -> Parameter {
    Parameter { neutral: Neutral::Nominal, ..zero(name, range) }
}

/// A parameter of shape.
const fn shape(name: &'static str, range: [f64; 2]) -> Parameter {
    Parameter { neutral: Neutral::Shape, ..zero(name, range) }
}

const fn optional(parameter: Parameter) -> Parameter {
    Parameter { is_required: false, ..parameter }
}

const fn vector(parameter: Parameter) -> Parameter {
    Parameter { shape: Shape::Vector, ..parameter }
}

const fn choice(name: &'static str, words: &'static [&'static str]) -> Parameter {
    Parameter { shape: Shape::Choice(words), ..optional(shape(name, ANY)) }
}

/// Where an effect may act and what its parameters are.
pub(super) fn entry(name: EffectName) -> Entry {
    let (places, parameters) = of_joint(name).or_else(|| of_body(name)).or_else(|| of_contact(name)).unwrap_or(OTHER);
    Entry { name, places, parameters }
}

type Row = (&'static [PlaceKind], &'static [Parameter]);

/// What a diagnosis could not name has no model.
const OTHER: Row = (&[Joint, Link, Body, Contact, Actuator, Sensor, World], &[]);

fn of_joint(name: EffectName) -> Option<Row> {
    use EffectName as N;
    Some(match name {
        N::JointViscousFriction => (&[Joint], &const { [zero("b", AT_LEAST_ZERO)] }),
        N::JointCoulombFriction => (&[Joint], &const { [zero("c", AT_LEAST_ZERO)] }),
        N::JointStribeckFriction => {
            (&[Joint], &const { [zero("c", AT_LEAST_ZERO), zero("s", AT_LEAST_ZERO), shape("v_s", POSITIVE)] })
        }
        N::JointFrictionAsymmetry => {
            (&[Joint], &const { [zero("c_plus", AT_LEAST_ZERO), zero("c_minus", AT_LEAST_ZERO)] })
        }
        N::JointViscousAsymmetry => {
            (&[Joint], &const { [zero("b_plus", AT_LEAST_ZERO), zero("b_minus", AT_LEAST_ZERO)] })
        }
        N::JointQuadraticFriction => (&[Joint], &const { [zero("b_2", AT_LEAST_ZERO)] }),
        N::JointOffset => (&[Joint], &const { [zero("effort", ANY)] }),
        N::JointBacklash => (
            &[Joint],
            &const {
                [zero("gap", AT_LEAST_ZERO), neutral("k", f64::INFINITY, POSITIVE), optional(zero("d", AT_LEAST_ZERO))]
            },
        ),
        N::JointElasticity => {
            (&[Joint], &const { [neutral("k", f64::INFINITY, POSITIVE), optional(zero("d", AT_LEAST_ZERO))] })
        }
        N::JointTorqueRipple => {
            (&[Joint], &const { [zero("amplitude", ANY), shape("order", ANY), optional(shape("phase", ANY))] })
        }
        N::JointCableStiffness => (&[Joint], &const { [zero("k", AT_LEAST_ZERO), optional(shape("q_rest", ANY))] }),
        N::JointArmature => (&[Joint], &const { [zero("i_rotor", ANY)] }),
        N::ActuatorGain => (&[Joint, Actuator], &const { [neutral("gain", 1.0, ANY)] }),
        N::ActuatorDelay => (&[Joint, Actuator], &const { [zero("delay", AT_LEAST_ZERO)] }),
        N::ActuatorLag => (&[Joint, Actuator], &const { [zero("time_constant", AT_LEAST_ZERO)] }),
        N::ActuatorSaturation => (&[Joint, Actuator], &const { [neutral("limit", f64::INFINITY, AT_LEAST_ZERO)] }),
        N::ActuatorMisalignment => {
            (&[Actuator], &const { [optional(zero("angle_y", ANY)), optional(zero("angle_z", ANY))] })
        }
        N::PeriodicDisturbance => (
            &[Body, Joint],
            &const {
                [
                    Parameter { shape: Shape::NumberOrVector, ..zero("amplitude", ANY) },
                    shape("frequency", AT_LEAST_ZERO),
                    optional(shape("phase", ANY)),
                    choice("kind", &["torque", "force"]),
                ]
            },
        ),
        _ => return None,
    })
}

fn of_body(name: EffectName) -> Option<Row> {
    use EffectName as N;
    Some(match name {
        N::Payload => (&[Link, Body], &const { [zero("mass", ANY), vector(optional(shape("com", ANY)))] }),
        N::BodyMass => (&[Body, Link], &const { [nominal("mass", POSITIVE)] }),
        N::BodyCom => (&[Body, Link], &const { [vector(nominal("com", ANY))] }),
        N::BodyInertia => (&[Body, Link], &const { [Parameter { shape: Shape::Tensor, ..nominal("inertia", ANY) }] }),
        N::ConstantForce | N::ConstantTorque => {
            (&[Body], &const { [vector(zero("vector", ANY)), choice("frame", &["body", "world"])] })
        }
        N::Tilt => (&[World], &const { [vector(zero("vector", ANY))] }),
        N::LinearDrag | N::QuadraticDrag | N::AngularDamping => (&[Body], &const { [zero("c", AT_LEAST_ZERO)] }),
        N::InternalDissipation => (&[Body], &const { [zero("i_damper", AT_LEAST_ZERO), zero("c", AT_LEAST_ZERO)] }),
        N::GravityGradient => (&[Body], &const { [zero("mean_motion", AT_LEAST_ZERO)] }),
        N::TetherStiffness => (
            &[Body],
            &const { [zero("k", AT_LEAST_ZERO), optional(zero("d", AT_LEAST_ZERO)), vector(shape("anchor", ANY))] },
        ),
        N::Slosh => (
            &[Body],
            &const {
                [
                    zero("mass", AT_LEAST_ZERO),
                    shape("frequency", POSITIVE),
                    optional(shape("damping", AT_LEAST_ZERO)),
                    vector(optional(shape("position", ANY))),
                ]
            },
        ),
        N::FlexibleAppendage => (
            &[Body],
            &const {
                [shape("frequency", POSITIVE), optional(shape("damping", AT_LEAST_ZERO)), vector(zero("coupling", ANY))]
            },
        ),
        _ => return None,
    })
}

fn of_contact(name: EffectName) -> Option<Row> {
    use EffectName as N;
    let sensor: &'static [PlaceKind] = &[Sensor];
    Some(match name {
        N::ContactStiffness => (&[Contact], &const { [nominal("k", POSITIVE), optional(nominal("n", POSITIVE))] }),
        N::ContactDamping => (&[Contact], &const { [nominal("c", AT_LEAST_ZERO)] }),
        N::FrictionCoefficient => (&[Contact], &const { [nominal("mu", AT_LEAST_ZERO)] }),
        N::FrictionStribeck => (
            &[Contact],
            &const { [nominal("mu_s", AT_LEAST_ZERO), nominal("mu_d", AT_LEAST_ZERO), shape("v_s", POSITIVE)] },
        ),
        N::FrictionBristleStiffness => {
            (&[Contact], &const { [nominal("k_b", POSITIVE), optional(nominal("c_b", AT_LEAST_ZERO))] })
        }
        N::FrictionViscous => (&[Contact], &const { [zero("b", AT_LEAST_ZERO)] }),
        N::FrictionAnisotropy => (
            &[Contact],
            &const { [nominal("mu_1", AT_LEAST_ZERO), nominal("mu_2", AT_LEAST_ZERO), shape("angle", ANY)] },
        ),
        N::FrictionDwellTime => {
            (&[Contact], &const { [nominal("mu_s_inf", AT_LEAST_ZERO), shape("time_constant", POSITIVE)] })
        }
        N::Adhesion => (&[Contact], &const { [zero("force", AT_LEAST_ZERO)] }),
        N::ContactGeometryOffset => {
            (&[Contact], &const { [vector(optional(zero("offset", ANY))), vector(optional(zero("angle", ANY)))] })
        }
        N::MountCompliance => (
            &[Body, Contact],
            &const {
                [
                    neutral("k", f64::INFINITY, POSITIVE),
                    optional(zero("d", AT_LEAST_ZERO)),
                    optional(shape("m", POSITIVE)),
                ]
            },
        ),
        N::SensorBias => (sensor, &const { [Parameter { shape: Shape::NumberOrVector, ..zero("bias", ANY) }] }),
        N::SensorScale => {
            (sensor, &const { [Parameter { shape: Shape::NumberOrVector, ..neutral("scale", 1.0, ANY) }] })
        }
        N::SensorDelay => (sensor, &const { [zero("delay", ANY)] }),
        N::SensorMisalignment => (sensor, &const { [vector(zero("angle", ANY))] }),
        _ => return None,
    })
}
