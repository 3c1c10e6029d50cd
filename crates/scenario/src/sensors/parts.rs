//! What a `[[sensor]]` reads: its quantities by their names in recordings, and the errors of each.

use crate::glob::glob_matches;
use crate::measure::{joints, links};
use crate::spec::{PoseSpec, Sensor as SensorSpec, SensorKind};
use sim::Model;
use spatial::Vec3;

/// A quantity that a sensor reads, and with which errors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    /// Name of the quantity, `joint.arm/elbow.position`.
    pub name: String,
    /// Standard deviation of the noise of each component; of an orientation about each axis, rad.
    pub sigma: f64,
    /// Added to each component.
    pub bias: Vec3,
    /// Standard deviation of the bias' walk after a second.
    pub walk: f64,
    /// Step of the scale; zero for none.
    pub step: f64,
    /// Largest size of a component that it shows.
    pub limit: Option<f64>,
    /// How far and in which half angle (rad) about its z a camera sees.
    pub sight: [Option<f64>; 2],
}

/// The quantities that a sensor reads; why it reads none.
pub(crate) fn parts_of(sensor: &SensorSpec, model: &Model) -> Result<Vec<Part>, String> {
    let own = |quantity: &str| format!("sensor.{}.{quantity}", sensor.name);
    let plain = |quantity: &str, sigma: f64| Part { name: own(quantity), sigma, ..Part::default() };
    match &sensor.kind {
        SensorKind::ContactForce { force_noise_n, torque_noise_n_m, .. }
        | SensorKind::MechanismForce { force_noise_n, torque_noise_n_m, .. } => {
            Ok(vec![plain("force", *force_noise_n), plain("torque", *torque_noise_n_m)])
        }
        SensorKind::JointEncoder { joint, noise_deg, noise_m, resolution_deg, resolution_m, bias_deg, bias_m } => {
            of_joints(model, joint, "position", |slides| match slides {
                true => (*noise_m, *resolution_m, *bias_m),
                false => (noise_deg.to_radians(), resolution_deg.to_radians(), bias_deg.to_radians()),
            })
        }
        SensorKind::Tachometer { joint, noise_rad_per_s, noise_m_per_s } => {
            of_joints(model, joint, "velocity", |slides| {
                (if slides { *noise_m_per_s } else { *noise_rad_per_s }, 0.0, 0.0)
            })
        }
        SensorKind::Imu { .. } => Ok(of_imu(sensor)),
        SensorKind::Pose { .. } => of_pose(sensor, model),
        SensorKind::ForceTorque { force_noise_n, force_bias_n, torque_noise_n_m, torque_bias_n_m, .. } => {
            let force = Part { bias: Vec3::from(*force_bias_n), ..plain("force", *force_noise_n) };
            let torque = Part { bias: Vec3::from(*torque_bias_n_m), ..plain("torque", *torque_noise_n_m) };
            Ok(vec![force, torque])
        }
    }
}

/// Gyro and accelerometer.
fn of_imu(sensor: &SensorSpec) -> Vec<Part> {
    let SensorKind::Imu {
        gyro_noise_rad_per_s,
        gyro_bias_rad_per_s,
        gyro_walk_rad_per_s_sqrt_s,
        gyro_limit_rad_per_s,
        accelerometer_noise_m_per_s2,
        accelerometer_bias_m_per_s2,
        accelerometer_walk_m_per_s2_sqrt_s,
        accelerometer_limit_m_per_s2,
        ..
    } = &sensor.kind
    else {
        return Vec::new();
    };
    let part = |quantity: &str, [sigma, walk]: [f64; 2], bias: &[f64; 3], limit: Option<f64>| Part {
        name: format!("sensor.{}.{quantity}", sensor.name),
        sigma,
        bias: Vec3::from(*bias),
        walk,
        limit,
        ..Part::default()
    };
    let gyro = [*gyro_noise_rad_per_s, *gyro_walk_rad_per_s_sqrt_s];
    let felt = [*accelerometer_noise_m_per_s2, *accelerometer_walk_m_per_s2_sqrt_s];
    vec![
        part("angular_velocity", gyro, gyro_bias_rad_per_s, *gyro_limit_rad_per_s),
        part("specific_force", felt, accelerometer_bias_m_per_s2, *accelerometer_limit_m_per_s2),
    ]
}

/// Place and attitude of what is seen.
fn of_pose(sensor: &SensorSpec, model: &Model) -> Result<Vec<Part>, String> {
    let SensorKind::Pose { link, relative_to, position_noise_m, position_bias_m, attitude_noise_deg, pose, .. } =
        &sensor.kind
    else {
        return Ok(Vec::new());
    };
    let sight = sight_of(&sensor.kind);
    let subject = match relative_to.as_str() {
        "world" if *pose != PoseSpec::default() || sight.iter().any(Option::is_some) => {
            return Err(
                "sees from the world, where no camera stands: pose, range_m and field_of_view_deg are of one on a link"
                    .to_owned(),
            );
        }
        "world" => format!("body.{}", body_of(model, link)?),
        _ => format!("sensor.{}", sensor.name),
    };
    let position = Part { name: format!("{subject}.position"), sigma: *position_noise_m, ..Part::default() };
    let attitude = attitude_noise_deg.to_radians();
    let orientation = Part { name: format!("{subject}.orientation"), sigma: attitude, sight, ..Part::default() };
    Ok(vec![Part { bias: Vec3::from(*position_bias_m), sight, ..position }, orientation])
}

fn sight_of(kind: &SensorKind) -> [Option<f64>; 2] {
    match kind {
        SensorKind::Pose { range_m, field_of_view_deg, .. } => {
            [*range_m, field_of_view_deg.map(|full| 0.5 * full.to_radians())]
        }
        _ => [None; 2],
    }
}

/// A quantity of every joint that a pattern means; its noise, scale and bias by whether the joint slides.
fn of_joints(
    model: &Model,
    pattern: &str,
    quantity: &str,
    errors: impl Fn(bool) -> (f64, f64, f64),
) -> Result<Vec<Part>, String> {
    let full = |vehicle: &str, joint: &str| format!("{vehicle}/{joint}");
    let part = |(vehicle, joint, at): (&str, &str, usize)| {
        let (sigma, step, bias) = errors(model.slides(at));
        let name = format!("joint.{}.{quantity}", full(vehicle, joint));
        Part { name, sigma, step, bias: Vec3::new(bias, 0.0, 0.0), ..Part::default() }
    };
    let found: Vec<Part> = joints(model).filter(|(v, j, _)| glob_matches(pattern, &full(v, j))).map(part).collect();
    match found.is_empty() {
        true => Err(format!("\"{pattern}\" is no joint that turns or slides by itself")),
        false => Ok(found),
    }
}

/// A link as recordings call it: the base by its vehicle.
fn body_of(model: &Model, link: &str) -> Result<String, String> {
    let found = links(model).find(|(vehicle, name, _)| link == format!("{vehicle}/{name}"));
    match found {
        Some((vehicle, _, (_, 0))) => Ok(vehicle.to_owned()),
        Some(_) => Ok(link.to_owned()),
        None => Err(format!("no link \"{link}\"")),
    }
}
