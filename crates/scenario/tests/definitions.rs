//! Definitions of effects are whole: what one says in one place it keeps in the others.
#![allow(clippy::unwrap_used)]

use scenario::effects::candidate::Candidate;
use scenario::effects::facts::{ActuatorFact, BodyFact, ContactFact, JointFact, MechanismFact, SensorFact, Survey};
use scenario::effects::identify::Tier;
use scenario::effects::{EffectDef, Shape, Shown, find, models};
use scenario::measure::Quantity;
use scenario::spec::Tolerance;
use spatial::{Mat3, Vec3};

fn joint() -> JointFact {
    JointFact { name: "hinge".into(), coordinate: 0, armature: 0.2, largest_command: 2.0, ..JointFact::default() }
}

fn actuators() -> [ActuatorFact; 2] {
    let fact = |place: &str, largest_command: f64, is_thruster: bool| ActuatorFact {
        place: place.into(),
        largest_command,
        is_thruster,
    };
    [fact("joint:hinge", 2.0, false), fact("actuator:jet", 0.0, true)]
}

/// A base that is pushed, and a link.
fn bodies() -> [BodyFact; 2] {
    let base = BodyFact {
        name: "base".into(),
        vehicle: 0,
        mass: 4.0,
        com: Vec3::new(0.2, 0.0, 0.0),
        inertia: Mat3::from_diagonal(&Vec3::new(1.0, 2.0, 2.5)),
        mask: [true; 6],
        is_base: true,
        is_on_joints: false,
        is_torque_free: false,
        is_placed: true,
    };
    let link = BodyFact { name: "link".into(), mask: [false; 6], is_base: false, is_on_joints: true, ..base.clone() };
    [base, link]
}

fn contact() -> ContactFact {
    ContactFact {
        name: "pad/plate".into(),
        is_linear: false,
        normal: Some([1e5, 1.5, 0.3]),
        bristle: Some([0.25, 1e5, 50.0]),
        mass: 40.0,
        has_normal_motion: true,
        unmoved_by: [false; 6],
    }
}

fn sensors() -> [SensorFact; 2] {
    let fact = |channel: &str, quantity: Quantity, axes: &[usize]| SensorFact {
        channel: channel.into(),
        quantity,
        axes: axes.to_vec(),
        sigma: 1e-3,
    };
    [
        fact("body.base.position", Quantity::Position(0, 0), &[0, 1, 2]),
        fact("joint.hinge.velocity", Quantity::JointVelocity(0), &[0]),
    ]
}

/// Candidates on a rig that has a place of every kind.
fn candidates(effect: &EffectDef) -> Vec<Candidate> {
    let (joint, bodies, contact) = (joint(), bodies(), contact());
    let survey = Survey {
        joints: std::slice::from_ref(&joint),
        bodies: &bodies,
        contacts: std::slice::from_ref(&contact),
        gravity: [0.0; 3],
        duration: 40.0,
        highest: 500.0,
        lines: &[0.37],
    };
    let of = &effect.identify.candidates;
    let mut all = of.at_joint(&joint, &survey);
    all.extend(actuators().iter().flat_map(|actuator| of.at_actuator(actuator)));
    all.extend(bodies.iter().flat_map(|body| of.at_body(body, &survey)));
    all.extend(of.at_world(&survey));
    all.extend(of.at_contact(&contact));
    let strut = MechanismFact { name: "strut".into(), has_springs: true, has_dampers: true };
    all.extend(of.at_mechanism(&strut));
    all.extend(sensors().iter().flat_map(|sensor| of.at_sensor(sensor)));
    all
}

/// The parameter of a coordinate, `com[1]`.
fn parameter(effect: &EffectDef, key: &str) -> bool {
    effect.parameter(key.split('[').next().unwrap()).is_some()
}

#[test]
fn a_rig_with_every_kind_of_place_has_a_candidate_for_every_effect() {
    for effect in models() {
        let all = candidates(effect);
        assert!(!all.is_empty(), "{effect} is looked for nowhere");
        for candidate in all {
            let kind = candidate.place.split(':').next().unwrap();
            assert!(effect.places.iter().any(|p| p.text() == kind), "{effect} cannot be at {}", candidate.place);
            assert!(!candidate.screens.is_empty(), "{effect} at {} is never screened", candidate.place);
        }
    }
}

#[test]
fn candidates_are_told_in_parameters_of_their_effect() {
    for effect in models() {
        for candidate in candidates(effect) {
            let n = candidate.coordinates.len();
            let x = candidate.neutral();
            let decoded = candidate.encoding.decode(&candidate.coordinates, &x);
            let fitted = candidate.coordinates.iter().map(|c| c.key).chain(decoded.iter().map(|d| d.0));
            let words = candidate.constants.iter().map(|c| c.0);
            for key in fitted.chain(words) {
                assert!(parameter(effect, key), "{effect} has no parameter {key}");
            }
            let inside =
                |(x, c): (&f64, &scenario::effects::candidate::Coordinate)| (c.bounds[0]..=c.bounds[1]).contains(x);
            assert!(x.iter().zip(&candidate.coordinates).all(inside), "{effect} begins beyond its bounds");
            assert!(candidate.held.iter().all(|k| *k < n), "{effect} holds what it does not have");
            for column in candidate.screens.iter().flat_map(|s| &s.columns) {
                assert!(column.base.len() == n && column.direction.len() == n && column.step > 0.0, "{effect}");
            }
        }
    }
}

/// What a spring and a damper have is looked for from where they stand, and no exponent, which the law would refuse.
#[test]
fn a_linear_contact_is_looked_at_without_an_exponent() {
    let linear = ContactFact { is_linear: true, normal: Some([2e4, 1.0, 60.0]), ..contact() };
    let of = |name: &str, contact: &ContactFact| find(name).unwrap().identify.candidates.at_contact(contact).remove(0);
    let [law, other] = [&linear, &contact()].map(|c| of("contact-stiffness", c));
    assert!(law.held == [1] && law.screens.iter().flat_map(|s| &s.columns).all(|c| c.direction[1] == 0.0));
    assert!(other.held.is_empty() && other.screens[0].columns.len() == 2);
    assert_eq!(of("contact-damping", &linear).neutral(), [60.0]);
}

/// Loads on a link are asked for last, those on a base with all others; a part inside a body that is pushed has a mass that shows.
#[test]
fn what_is_asked_last_and_what_shows() {
    let [base, link] = bodies();
    let survey = Survey {
        joints: &[],
        bodies: &[],
        contacts: &[],
        gravity: [0.0; 3],
        duration: 40.0,
        highest: 500.0,
        lines: &[],
    };
    for name in
        ["linear-drag", "quadratic-drag", "angular-damping", "constant-force", "constant-torque", "tether-stiffness"]
    {
        let at = |body: &BodyFact| find(name).unwrap().identify.candidates.at_body(body, &survey);
        assert!(!at(&link).is_empty() && at(&link).iter().all(|c| c.is_last), "{name}");
        assert!(!at(&base).is_empty() && at(&base).iter().all(|c| !c.is_last), "{name}");
    }
    let slosh = |body: &BodyFact| find("slosh").unwrap().identify.candidates.at_body(body, &survey).remove(0);
    assert!(slosh(&base).held.is_empty(), "pushed");
    assert_eq!(slosh(&BodyFact { is_torque_free: true, ..base.clone() }).held, [0], "it tumbles");
    let flat = BodyFact { mask: [false, false, true, true, true, false], ..base };
    assert_eq!(slosh(&flat).held, [5], "nothing tells how high it is");
}

#[test]
fn nested_laws_are_effects_with_as_many_coordinates() {
    for effect in models() {
        let Some(nested) = effect.identify.nested else { continue };
        for candidate in candidates(effect) {
            let x = vec![0.5; candidate.coordinates.len()];
            for alternative in nested(&candidate.place, &x) {
                let other = find(alternative.name).unwrap();
                let fits = |c: &Candidate| c.coordinates.len() == alternative.coordinates.len();
                let is_plainer = other != effect || alternative.coordinates.len() < x.len();
                assert!(is_plainer && candidates(other).iter().any(fits), "{effect} → {other}");
                assert!(alternative.held.iter().all(|k| *k < alternative.coordinates.len()), "{effect} → {other}");
            }
        }
    }
}

#[test]
fn tolerances_have_a_number_for_each_coordinate_and_none_where_all_is_exact() {
    for effect in models() {
        let Some(tolerance) = effect.identify.tolerance else { continue };
        for candidate in candidates(effect) {
            let exact = tolerance(&Tolerance::default(), &candidate.coordinates);
            assert_eq!(exact, vec![0.0; candidate.coordinates.len()], "{effect}");
        }
    }
    let nominal = models().filter(|e| e.identify.tier == Tier::Nominal);
    assert!(nominal.count() >= 7);
}

#[test]
fn what_data_show_is_told_in_parameters_of_the_effect() {
    for effect in models() {
        let named: Vec<&str> = match effect.shown {
            Shown::Each => vec![],
            Shown::UpToSign { vector } => vec![vector],
            Shown::SecondMoment { mass, place } => vec![mass, place],
            Shown::Ellipse { along, across, angle } => vec![along, across, angle],
            Shown::FallingLevel { sliding, rest, speed } => vec![sliding, rest, speed],
            Shown::Wave { amplitude, phase } => vec![amplitude, phase],
        };
        assert!(named.iter().all(|name| effect.parameter(name).is_some()), "{effect}: {named:?}");
        let choices = effect.parameters.iter().filter(|p| matches!(p.shape, Shape::Choice(_)));
        assert!(
            choices.into_iter().all(|p| !p.is_required),
            "{effect}: the first word of a choice is meant where none is given"
        );
    }
}

/// A correction says what a link has of its own: what effects add to it or let move in it comes on top.
#[test]
fn a_correction_to_what_a_link_has_changes_nothing() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/rigs/tumbler.toml");
    let effects = "[[effect]]\nname = \"slosh\"\nplace = \"body:target\"\nmass = 7.0\nfrequency = 0.2\ndamping = 0.02\nposition = [0.1, 0.2, 0.3]\n\
                   [[effect]]\nname = \"payload\"\nplace = \"link:target\"\nmass = 3.0\ncom = [0.4, 0.0, 0.1]\n";
    let nominal = std::fs::read_to_string(&file).unwrap();
    let build = |text: &str| scenario::build(&scenario::parse(text, file.to_str().unwrap(), &[]).unwrap()).unwrap();
    let (plain, with) = (build(&nominal), build(&format!("{nominal}\n{effects}")));
    let own = |mission: &scenario::Mission| mission.own_inertials[0][0].1.unwrap();
    let tree = |mission: &scenario::Mission| mission.world.model().vehicles[0].tree.links[0].inertia;
    assert_eq!(own(&plain), own(&with), "neither what is added nor what moves is its own");
    assert!((tree(&with).mass - tree(&plain).mass + 4.0).abs() < 1e-9, "7 kg move by themselves and 3 kg are added");
    let (mass, com) = (own(&with).mass, own(&with).com);
    let place = "place = \"body:target\"";
    let same = format!(
        "[[effect]]\nname = \"body-mass\"\n{place}\nmass = {mass:?}\n[[effect]]\nname = \"body-com\"\n{place}\ncom = [{:?}, {:?}, {:?}]\n",
        com.x, com.y, com.z
    );
    let corrected = build(&format!("{nominal}\n{effects}\n{same}"));
    assert_eq!(tree(&corrected), tree(&with), "a correction to the same changes no bit");
}
