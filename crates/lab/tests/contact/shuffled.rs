//! The order in which the detector finds things changes no bit.

use contact::Shape;
use friction::Bristle;
use lab::bench::{Bench, Rig};
use lab::scene::{ball_robot, box_robot, contact_law, cylinder_robot};
use sim::{Base, Integrator};
use spatial::Twist;

/// Eight bodies that fall on a floor and on one another. `order` says in which order their shapes are known to the detector;
/// the pairs keep theirs.
fn heap(integrator: Integrator, order: &[usize]) -> Rig {
    let mut bench = Bench::new("heap", 1e-3).gravity([0.0, 0.0, -9.81]).integrator(integrator);
    bench.add_floor();
    let half = [0.05, 0.04, 0.03];
    for k in 0..8 {
        let name = format!("body{k}");
        let (robot, shape) = match k % 4 {
            0 => (box_robot(1.0, half), Shape::Cuboid { half_extents: half.into() }),
            1 => (ball_robot(0.5, 0.04), Shape::Ball { radius: 0.04 }),
            2 => (cylinder_robot(0.8, 0.04, 0.08), Shape::Cylinder { radius: 0.04, half_length: 0.04 }),
            _ => (cylinder_robot(0.6, 0.03, 0.1), Shape::Capsule { radius: 0.03, half_length: 0.04 }),
        };
        let vehicle = bench.add_vehicle(&name, &robot, Base::Free);
        bench.add_shape(Some(vehicle), 0, shape);
    }
    let bristle = Bristle { mu_static: 0.4, mu_kinetic: 0.3, stiffness: 1e4, damping: 10.0, ..Bristle::default() };
    let law = contact_law(1e4, 30.0, bristle);
    for a in 0..9 {
        for b in a + 1..9 {
            bench.spec.pairs.push(([a, b], law));
        }
    }
    let shapes = bench.spec.shapes.clone();
    bench.spec.shapes = order.iter().map(|i| shapes[*i].clone()).collect();
    let place = |i: usize| order.iter().position(|o| *o == i).unwrap();
    bench.spec.pairs.iter_mut().for_each(|(pair, _)| *pair = pair.map(place));
    let mut rig = bench.build().unwrap();
    for k in 0..8 {
        let (row, column) = ((k / 2) as f64, (k % 2) as f64);
        rig.place(k, [0.07 * column - 0.03 * row, 0.02 * row, 0.06 + 0.09 * row], [0.3 * row, 0.2 * column, 0.1]);
    }
    rig.throw(&[Twist::new([0.1, -0.2, 0.3].into(), [0.1, 0.05, -0.3].into()); 8]);
    rig
}

#[test]
fn shuffling_the_detector_changes_no_bit() {
    let straight: Vec<usize> = (0..9).collect();
    let mut touched = 0;
    for integrator in [Integrator::ImplicitEuler, Integrator::RungeKutta4] {
        let mut reference = heap(integrator, &straight);
        reference.run(1_000, |_| {}).unwrap();
        touched += reference.world.touches().count();
        for order in [[8, 7, 6, 5, 4, 3, 2, 1, 0], [3, 1, 4, 0, 5, 8, 2, 6, 7]] {
            let mut shuffled = heap(integrator, &order);
            shuffled.run(1_000, |_| {}).unwrap();
            assert_eq!(shuffled.world.state(), reference.world.state());
        }
    }
    assert!(touched > 20, "the heap lies in many contacts: {touched}");
}
