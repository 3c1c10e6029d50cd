//! Mechanisms by name → anchors and laws; what depends on how the bodies stand at t = 0 is settled on the built world.

use super::faults::Faults;
use super::shapes::place_of;
use crate::spec::{self, Scenario};
use multibody::calc_locked_inertia;
use sim::{
    Anchor, Base, Bushing, Capture, Latch, Mechanism, MechanismKind, Model, Overload, PullIn, Strength, Strut,
    StrutSides, VehicleSpec, Weld, World,
};
use spatial::{Mat3, Vec3};
use std::sync::Arc;

/// Damping ratio of a weld given by its frequency alone.
const WELD_RATIO: f64 = 0.05;

/// All mechanisms in the order of the file. Lengths and frequencies that the file leaves to t = 0 come with [`settle`].
pub(super) fn resolve(scenario: &Scenario, vehicles: &[VehicleSpec], faults: &mut Faults<'_>) -> Vec<Mechanism> {
    let mut mechanisms = Vec::with_capacity(scenario.mechanisms.len());
    for (i, mechanism) in scenario.mechanisms.iter().enumerate() {
        let mut side = |name: &str, side: &spec::MechanismSide| {
            let (vehicle, link) = place_of(vehicles, &side.on, &format!("mechanism[{i}].{name}.on"), faults)?;
            Some(Anchor { vehicle, link, pose_la: side.pose() })
        };
        let (Some(side_a), Some(side_b)) = (side("a", &mechanism.a), side("b", &mechanism.b)) else { continue };
        if is_one_body(vehicles, &side_a, &side_b) {
            let (a, b) = (&mechanism.a.on, &mechanism.b.on);
            let reason = format!("\"{a}\" and \"{b}\" are parts of one rigid body; name a link beyond a moving joint");
            faults.add(&format!("mechanism[{i}].b.on"), reason);
        }
        mechanisms.push(Mechanism { name: mechanism.name.clone(), side_a, side_b, kind: kind_of(&mechanism.kind) });
    }
    mechanisms
}

fn is_one_body(vehicles: &[VehicleSpec], a: &Anchor, b: &Anchor) -> bool {
    let body = |side: &Anchor| side.vehicle.map(|v| (v, vehicles[v].tree.links[side.link].body));
    let stands = |side: &Anchor| body(side).is_none_or(|(v, body)| body == 0 && vehicles[v].base == Base::Fixed);
    body(a) == body(b) || (stands(a) && stands(b))
}

fn kind_of(kind: &spec::MechanismKind) -> MechanismKind {
    match kind {
        spec::MechanismKind::Strut(strut) => MechanismKind::Strut(strut_of(strut)),
        spec::MechanismKind::Bushing(hold) => MechanismKind::Bushing(bushing_of(hold)),
        spec::MechanismKind::Latch(latch) => MechanismKind::Latch(latch_of(latch)),
        spec::MechanismKind::Weld(weld) => MechanismKind::Weld(Weld {
            hold: weld.hold.as_ref().map_or(Bushing::default(), bushing_of),
            strength: strength_of(weld.break_force_n, weld.break_moment_n_m),
        }),
    }
}

fn strut_of(strut: &spec::Strut) -> Strut {
    Strut {
        rest_length: strut.rest_length_m.unwrap_or(0.0),
        stiffness: strut.stiffness_n_per_m,
        damping: strut.damping_n_s_per_m,
        preload: strut.preload_n,
        sides: match strut.acts {
            spec::StrutSides::Both => StrutSides::Both,
            spec::StrutSides::PullOnly => StrutSides::PullOnly,
            spec::StrutSides::PushOnly => StrutSides::PushOnly,
        },
        stroke: strut.stroke_m.unwrap_or([0.0, f64::INFINITY]),
        stop_stiffness: strut.stop_stiffness_n_per_m.unwrap_or(0.0),
        stop_dissipation: strut.stop_dissipation_s_per_m.unwrap_or(0.0),
    }
}

fn bushing_of(hold: &spec::Hold) -> Bushing {
    Bushing {
        stiffness: hold.stiffness_n_per_m.vector(),
        damping: hold.damping_n_s_per_m.vector(),
        torsional_stiffness: hold.torsional_stiffness_n_m_per_rad.vector(),
        torsional_damping: hold.torsional_damping_n_m_s_per_rad.vector(),
    }
}

fn strength_of(force: Option<f64>, moment: Option<f64>) -> Strength {
    let any = Strength::default();
    Strength { force: force.unwrap_or(any.force), moment: moment.unwrap_or(any.moment) }
}

fn latch_of(latch: &spec::Latch) -> Latch {
    let capture = &latch.capture;
    let pull_in = latch.pull_in_m_per_s.zip(latch.pull_in_deg_per_s);
    Latch {
        capture: Capture {
            axial: capture.axial_m,
            lateral: capture.lateral_m,
            tilt: capture.tilt_deg.to_radians(),
            roll: capture.roll_deg.to_radians(),
            closing_speed: capture.closing_speed_m_per_s.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]),
            dwell: capture.dwell_s,
        },
        hold: bushing_of(&latch.hold),
        strength: strength_of(latch.hold_force_n, latch.hold_moment_n_m),
        overload: match latch.overload {
            spec::Overload::LetsGo => Overload::LetsGo,
            spec::Overload::Breaks => Overload::Breaks,
        },
        pull_in: pull_in.map(|(speed, turn)| PullIn { speed, turn_rate: turn.to_radians() }),
    }
}

/// The world with what depends on t = 0: rest lengths that the file leaves open, welds by frequency, what starts engaged.
pub(super) fn settle(scenario: &Scenario, mut world: World) -> World {
    for (i, mechanism) in scenario.mechanisms.iter().enumerate() {
        let rests = match &mechanism.kind {
            spec::MechanismKind::Weld(_) => true,
            spec::MechanismKind::Latch(latch) => latch.engaged,
            spec::MechanismKind::Strut(_) | spec::MechanismKind::Bushing(_) => false,
        };
        if rests {
            world.rest_mechanism(i);
        }
    }
    let settled: Vec<_> = (0..scenario.mechanisms.len())
        .filter_map(|i| Some((i, settled_kind(&scenario.mechanisms[i].kind, &world, i)?)))
        .collect();
    if settled.is_empty() {
        return world;
    }
    let mut model: Model = (**world.model()).clone();
    for (i, kind) in settled {
        model.mechanisms[i].kind = kind;
    }
    World::new(Arc::new(model), world.state().clone())
}

/// The kind with its open figures filled in; `None` where the file left none.
fn settled_kind(spec: &spec::MechanismKind, world: &World, i: usize) -> Option<MechanismKind> {
    match (spec, world.model().mechanisms[i].kind) {
        (spec::MechanismKind::Strut(spec::Strut { rest_length_m: None, .. }), MechanismKind::Strut(strut)) => {
            let rest_length = world.mechanisms().nth(i)?.deformation[0];
            Some(MechanismKind::Strut(Strut { rest_length, ..strut }))
        }
        (spec::MechanismKind::Weld(by), MechanismKind::Weld(weld)) => {
            let point = world.mechanisms().nth(i)?.point_w;
            let mechanism = &world.model().mechanisms[i];
            let [a, b] = [mechanism.side_a, mechanism.side_b].map(|side| calc_burden(world, &side, &point));
            let ratio = by.damping_ratio.unwrap_or(WELD_RATIO);
            let hold = Bushing::from_frequency(by.frequency_hz?, ratio, [a[0], b[0]], [a[1], b[1]]);
            Some(MechanismKind::Weld(Weld { hold, ..weld }))
        }
        _ => None,
    }
}

/// Mass (kg) and mean moment of inertia about a point (kg·m²) of the whole vehicle on one side.
fn calc_burden(world: &World, side: &Anchor, point_w: &Vec3) -> [f64; 2] {
    let moving = side.vehicle.filter(|v| !world.model().vehicles[*v].base.is_held());
    let Some(v) = moving else { return [f64::INFINITY; 2] };
    let kin = world.kinematics(v);
    let about_point = calc_locked_inertia(kin).transformed(&Mat3::identity(), &(kin.anchor - point_w));
    [about_point.mass, about_point.rot.trace() / 3.0]
}
