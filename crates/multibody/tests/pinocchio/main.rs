//! The algorithms of this crate against Pinocchio 4.1, on 100 random states of every robot, with fixed and free base.
//!
//! Robots: the Panda, the UR5 and the iiwa (of other packages: name their site-packages folder in
//! SOFTDOCK_THIRD_PARTY_ROBOTS, or they are skipped), this repository's servicer, and 50 random trees with every kind
//! of joint. Reference values, what they are projections of, and how to make them anew: tests/pinocchio/generate.py. Where
//! Pinocchio itself is installed beside the robots, every URDF of theirs is compared as well ([`every`]).
//!
//! `cargo test -p softdock-multibody --test pinocchio -- --nocapture` prints the largest difference per quantity.

#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs, unreachable_pub)]

mod every;
mod fixture;
mod load;
mod ours;
mod state;
mod stream;

use fixture::{BASE, Model, Set};
use multibody::Tree;
use ours::{Ours, Projection};
use state::Draw;
use std::collections::{BTreeMap, BTreeSet};

/// Largest |ours − Pinocchio's| over the sum of the magnitudes of the projected terms.
const LARGEST_DIFFERENCE: f64 = 1e-10;

/// Quantity → largest relative difference and where it is.
type Worst = BTreeMap<String, (f64, String)>;

#[test]
fn panda_is_as_in_pinocchio() {
    compare("panda");
}

#[test]
fn ur5_is_as_in_pinocchio() {
    compare("ur5");
}

#[test]
fn iiwa_is_as_in_pinocchio() {
    compare("iiwa");
}

#[test]
fn servicer_is_as_in_pinocchio() {
    compare("servicer");
}

#[test]
fn fifty_random_trees_are_as_in_pinocchio() {
    compare("trees");
}

/// The projections hide nothing: a ten-millionth in any body's inertia or joint's place is seen.
#[test]
fn a_relative_change_of_1e_minus_7_anywhere_shows() {
    const CHANGE: f64 = 1e-7;
    let set = fixture::load("servicer").unwrap();
    let (model, tree) = (&set.models[1], load::load(&set.models[1]).unwrap());
    assert_seen(&set, model, "inertia", &tree, |t, j| t.bodies[j + 1].inertia.rot *= 1.0 + CHANGE);
    assert_seen(&set, model, "mass", &tree, |t, j| t.bodies[j + 1].inertia.mass *= 1.0 + CHANGE);
    assert_seen(&set, model, "place", &tree, |t, j| t.joints[j].frame_pj.pos.x += CHANGE);
    assert_seen(&set, model, "rate", &tree, |t, j| t.joints[j].multiplier *= 1.0 + CHANGE);
}

fn assert_seen(set: &Set, model: &Model, what: &str, tree: &Tree, change: impl Fn(&mut Tree, usize)) {
    for j in 0..tree.joints.len() {
        let (mut changed, mut worst) = (tree.clone(), Worst::new());
        change(&mut changed, j);
        compare_model(set, model, &changed, &mut worst);
        let largest = worst.values().map(|(d, _)| *d).fold(0.0, f64::max);
        assert!(largest > LARGEST_DIFFERENCE, "{what} of joint {} is not seen: {largest:.1e}", tree.joints[j].name);
    }
}

fn compare(name: &str) {
    let Some(set) = fixture::load(name) else { return };
    let mut worst = [Worst::new(), Worst::new()];
    for model in &set.models {
        let tree = load::load(model).unwrap_or_else(|errors| panic!("{errors}"));
        assert_same_freedoms(model, &tree);
        compare_model(&set, model, &tree, &mut worst[usize::from(model.base_free)]);
    }
    print_table(name, &worst);
    for (quantity, (difference, place)) in worst.iter().flatten() {
        assert!(
            *difference <= LARGEST_DIFFERENCE,
            "{name}: {quantity} differs from Pinocchio's by {difference:.1e} at {place}; if the robot's file was \
             changed on purpose, run tests/pinocchio/generate.py {name}"
        );
    }
}

fn compare_model(set: &Set, model: &Model, tree: &Tree, worst: &mut Worst) {
    for (state, row) in model.rows.iter().enumerate() {
        let mut ours = Ours::new(tree, Draw::new(model, tree, state), set.gravity, model.base_free);
        let n = model.links.len();
        let mut note = |quantity: &str, what: &str, p: Projection, theirs: f64| {
            note_difference(worst, quantity, p, theirs, || format!("{} state {state} {what}", model.name));
        };
        for (k, link) in model.links.iter().enumerate() {
            note("placement", link, ours.placement(link), row[k]);
            note("velocity", link, ours.velocity(link), row[n + k]);
        }
        for (k, column) in model.columns.iter().enumerate() {
            note(column, "", ours.column(column, &model.links), row[2 * n + k]);
        }
    }
}

fn note_difference(worst: &mut Worst, quantity: &str, ours: Projection, theirs: f64, place: impl Fn() -> String) {
    let absolute = (ours.value - theirs).abs();
    let relative = if absolute == 0.0 { 0.0 } else { absolute / ours.size };
    // A NaN is the largest difference of all.
    let relative = if relative.is_nan() { f64::INFINITY } else { relative };
    let entry = worst.entry(quantity.to_owned()).or_insert((0.0, String::new()));
    if relative > entry.0 {
        *entry = (relative, place());
    }
}

/// The two sides speak of the same links, joints and freedoms.
fn assert_same_freedoms(model: &Model, tree: &Tree) {
    let ours: BTreeSet<_> = tree.links.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(ours, model.links.iter().map(String::as_str).collect(), "links of {}", model.name);
    let widths = |name: &str| model.scales[name]["effort"].len();
    let theirs: BTreeMap<_, _> = model.scales.keys().filter(|n| *n != BASE).map(|n| (n.as_str(), widths(n))).collect();
    let leading = tree.joints.iter().filter(|j| !j.is_mimic);
    assert_eq!(
        leading.map(|j| (j.name.as_str(), j.width)).collect::<BTreeMap<_, _>>(),
        theirs,
        "joints of {}",
        model.name
    );
}

fn print_table(name: &str, worst: &[Worst; 2]) {
    let mut table = format!("\n{name:<16}{:>10}{:>10}  largest of free at\n", "fixed", "free");
    for quantity in worst[1].keys() {
        let cell = |w: &Worst| w.get(quantity).map_or("-".to_owned(), |(d, _)| format!("{d:.1e}"));
        let place = &worst[1][quantity].1;
        table += &format!("{quantity:<16}{:>10}{:>10}  {place}\n", cell(&worst[0]), cell(&worst[1]));
    }
    println!("{table}");
}
