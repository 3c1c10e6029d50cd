//! A made-up capture: a gripper approaches a tumbling satellite, closes on its bar, slides, holds.
#![allow(dead_code, clippy::unwrap_used)]

use multibody::{Geometry, Visual};
use record::{
    ChannelSpec, ContactSample, Event, EventKind, Log, Meta, Plot, Sample, Scene, SceneLink, SceneVehicle, Trail,
};
use spatial::{Pose, Rot, Vec3};

/// Touch-down, s.
const TOUCH: f64 = 6.0;
/// From here on it holds, s.
const HOLD: f64 = 9.0;

fn visual(name: &str, geometry: Geometry, at: [f64; 3], rgb: [f64; 3]) -> Visual {
    let rgba = Some([rgb[0], rgb[1], rgb[2], 1.0]);
    Visual { name: name.into(), pose_ls: Pose::translation(at[0], at[1], at[2]), geometry, rgba }
}

fn link(name: &str, visuals: Vec<Visual>) -> SceneLink {
    SceneLink { name: name.into(), visuals }
}

fn cuboid(x: f64, y: f64, z: f64) -> Geometry {
    Geometry::Box { size: Vec3::new(x, y, z) }
}

/// A servicer of three links and a target of one.
pub fn scene() -> Scene {
    const GOLD: [f64; 3] = [0.85, 0.65, 0.25];
    const BLUE: [f64; 3] = [0.12, 0.2, 0.5];
    let bus = vec![
        visual("bus", cuboid(0.8, 0.8, 1.0), [0.0, 0.0, 0.0], [0.8, 0.8, 0.83]),
        visual("wing", cuboid(0.5, 1.6, 0.02), [0.0, 1.3, 0.0], BLUE),
        visual("wing", cuboid(0.5, 1.6, 0.02), [0.0, -1.3, 0.0], BLUE),
        visual("boom", Geometry::Capsule { radius: 0.05, length: 0.5 }, [0.0, 0.0, 0.7], [0.6, 0.6, 0.6]),
    ];
    let finger = |name| link(name, vec![visual("pad", cuboid(0.18, 0.02, 0.04), [0.09, 0.0, 0.0], [0.3, 0.3, 0.33])]);
    let client = vec![
        visual("bus", cuboid(0.7, 0.7, 0.9), [0.55, 0.0, 0.0], GOLD),
        visual("array", cuboid(0.02, 0.5, 1.8), [0.55, 0.0, 1.5], BLUE),
        visual("bar", Geometry::Cylinder { radius: 0.015, length: 0.3 }, [0.0, 0.0, 0.0], [0.9, 0.9, 0.9]),
        visual("dish", Geometry::Sphere { radius: 0.15 }, [0.75, 0.0, -0.55], [0.95, 0.95, 0.95]),
    ];
    let servicer = vec![link("base", bus), finger("finger_left"), finger("finger_right")];
    let mut scene = Scene {
        vehicles: vec![
            SceneVehicle { name: "servicer".into(), links: servicer },
            SceneVehicle { name: "target".into(), links: vec![link("client", client)] },
        ],
        ..Scene::default()
    };
    scene.close_up = scene.link_index("target", "client");
    scene.trails = vec![Trail { name: "finger".into(), link: 1, point_l: Vec3::new(0.18, 0.0, 0.0) }];
    scene
}

fn target_pose(t: f64) -> Pose {
    let angle = 0.04 * t.min(HOLD);
    Pose::from_parts(Vec3::new(1.2, 0.02 * t, 0.0).into(), Rot::new(Vec3::new(0.3, 0.2, 1.0) * angle))
}

/// Pose of the servicer's three links and of the target.
fn poses(t: f64) -> Vec<Pose> {
    let target = target_pose(t);
    let away = 1.0 - (t / TOUCH).min(1.0);
    let gap = 0.025 + 0.04 * away;
    let hand = target * Pose::translation(-0.1 - 0.8 * away, 0.0, 0.0);
    let finger = |y: f64| hand * Pose::translation(0.0, y, 0.0);
    vec![hand * Pose::translation(-0.75, 0.0, 0.0), finger(gap), finger(-gap), target]
}

fn contacts(t: f64) -> Vec<ContactSample> {
    if t < TOUCH {
        return Vec::new();
    }
    let pose = target_pose(t);
    let force = 12.0 * (1.0 - (-(t - TOUCH)).exp());
    let at = |side: f64, z: f64| ContactSample {
        pair: usize::from(side < 0.0),
        point_w: (pose * spatial::nalgebra::Point3::new(0.0, 0.015 * side, z)).coords,
        normal_force_w: pose.rotation * Vec3::new(0.0, -force * side, 0.0),
        friction_force_w: pose.rotation * Vec3::new(0.1 * force, 0.0, 0.25 * force * (1.0 + 40.0 * z)),
        sticking: t > HOLD || z < 0.0,
        friction_use: if t > HOLD { 0.4 } else { 1.0 },
    };
    vec![at(1.0, 0.018), at(1.0, -0.018), at(-1.0, 0.018), at(-1.0, -0.018)]
}

fn channels() -> Vec<ChannelSpec> {
    let mut specs = vec![
        ChannelSpec::new("relative.distance", "m", Plot::Relative).described("tool to grapple point"),
        ChannelSpec::new("relative.angle", "rad", Plot::Relative).described("tool to grapple frame"),
        ChannelSpec::new("contact.normal_force", "N", Plot::Contact).described("sum of magnitudes"),
        ChannelSpec::new("contact.friction_force", "N", Plot::Contact).described("sum of magnitudes"),
        ChannelSpec::new("momentum.linear_drift", "1", Plot::Momentum).described("relative"),
        ChannelSpec::new("momentum.angular_drift", "1", Plot::Momentum).described("relative"),
        ChannelSpec::new("energy.kinetic", "J", Plot::Energy),
        ChannelSpec::new("energy.dissipated", "J", Plot::Energy),
    ];
    for joint in ["shoulder_yaw", "shoulder_pitch", "elbow", "wrist"] {
        specs.push(ChannelSpec::new(format!("joint.servicer/{joint}.position"), "rad", Plot::Joints));
        specs.push(ChannelSpec::new(format!("joint.servicer/{joint}.effort"), "N·m", Plot::Joints));
    }
    specs
}

fn values(t: f64, contacts: &[ContactSample]) -> Vec<f64> {
    let away = 1.0 - (t / TOUCH).min(1.0);
    let sum = |f: fn(&ContactSample) -> f64| contacts.iter().map(f).sum::<f64>();
    let grip = if contacts.is_empty() { f64::NAN } else { 0.2 };
    let mut values = vec![
        0.8 * away,
        0.3 * away * away,
        sum(|c| c.normal_force_w.norm()),
        sum(|c| c.friction_force_w.norm()),
        1e-14 * (3.0 * t).sin(),
        2e-14 * (2.0 * t).cos(),
        1.0 + 0.2 * (-t / 4.0).exp(),
        0.2 * (1.0 - (-t / 4.0).exp()),
    ];
    for k in 0..4 {
        values.push((0.3 * t + f64::from(k)).sin());
        values.push(if k == 3 { grip } else { 4.0 * (0.5 * t + f64::from(k)).cos() });
    }
    values
}

fn events() -> Vec<Event> {
    let event = |t: f64, kind, text: &str| Event { t, step: (t * 1000.0) as u64, kind, text: text.into() };
    vec![
        event(0.0, EventKind::Phase, "approach"),
        event(5.0, EventKind::Phase, "close"),
        event(TOUCH, EventKind::Contact, "first contact: servicer/finger_left – target/bar"),
        event(TOUCH + 1.0, EventKind::Limit, "elbow effort at its limit, 4 N·m"),
        event(HOLD, EventKind::Phase, "hold"),
        event(HOLD, EventKind::Capture, "captured: relative rate below 0.1 mm/s for 1 s"),
    ]
}

/// A run of `duration` s at 50 Hz.
pub fn run(duration: f64) -> Log {
    let meta = Meta { scenario: "made-up-capture".into(), seed: 7, version: "0.1.0".into(), ..Meta::default() };
    let mut log = Log::new(meta, channels(), scene().link_count());
    log.pairs = vec!["servicer/finger_left – target/bar".into(), "servicer/finger_right – target/bar".into()];
    for i in 0..=(duration * 50.0) as u64 {
        let t = i as f64 * 0.02;
        let contacts = contacts(t);
        let sample = Sample { t, step: i * 20, values: &values(t, &contacts), poses_w: &poses(t), contacts: &contacts };
        log.push(&sample).unwrap();
    }
    log.events = events().into_iter().filter(|event| event.t <= duration).collect();
    log
}

/// What a summary looks like.
pub const SUMMARY: &str = "# made-up-capture: captured\n\nrelative rate below 0.1 mm/s for 1 s\n\n\
| metric | value |\n| --- | --- |\n| time to capture | 9.00 s |\n| peak contact force | 12.9 N |\n\
| momentum drift | 2.0e-14 |\n";
