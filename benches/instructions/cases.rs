//! What is counted: prepared first, then run in the measured block; one line of output each, in order.

use crate::callgrind::measured_block;
use crate::fixtures::arm::{Arm, BASES, Base};
use crate::fixtures::missions::{SETTLED, advance, mission, observers, place, run_to};
use crate::fixtures::pairs::{self, PAIRS};
use softdock::diagnose;
use softdock::record::RecordingSet;
use softdock::scenario;
use softdock::sim::Observer;
use std::hint::black_box;

/// Steps of a block: enough that samples of the recorder (every tenth step) and audits of the judge (every hundredth) have their share.
const STEPS: usize = 200;

/// Calls of a kernel or a pair; a multiple of the eight places of a drifting pair.
const CALLS: usize = 64;

/// Runs every case once, and prints `calls`, a tab and the name of each.
pub fn run() {
    steps();
    kernels();
    detection();
    diagnosis();
}

fn case(name: &str, calls: usize, mut work: impl FnMut()) {
    measured_block(&mut work);
    println!("{calls}\t{name}");
}

fn steps() {
    let all = ["implicit-euler", "implicit-midpoint", "semi-implicit-euler", "rk4"];
    // The explicit ones do not hold the pads' stiffness at 1 ms.
    for (name, file, from, integrators) in
        [("grasp", "peer-grasp", SETTLED, &all[..2]), ("free arm", "peer-free-arm", 0.0, &all[..])]
    {
        for integrator in integrators {
            let mut job = mission(file, &[("integrator.kind", integrator)]);
            run_to(&mut job, from);
            case(&format!("{name}, a step, {integrator}"), STEPS, || advance(&mut job.world, &*job.controller, STEPS));
        }
    }
    let mut job = mission("peer-grasp", &[]);
    run_to(&mut job, SETTLED);
    let (mut judge, mut recorder) = observers(&job);
    let end = job.world.state().steps + STEPS as u64;
    case("grasp, a step with judge and recorder", STEPS, || {
        let both: &mut [&mut dyn Observer] = &mut [&mut judge, &mut recorder];
        job.world.run(end, &*job.controller, both).expect("the grasp holds");
    });
}

fn kernels() {
    type Kernel = fn(&mut Arm);
    let kernels: [(&str, Kernel); 5] = [
        ("kinematics", Arm::update),
        ("RNEA", Arm::rnea),
        ("CRBA", Arm::crba),
        ("CRBA and Cholesky", Arm::crba_and_cholesky),
        ("ABA", Arm::aba),
    ];
    for (name, kernel) in kernels {
        for base in BASES {
            let mut arm = Arm::new(base);
            let freedoms = match base {
                Base::Fixed7 => "7, base fixed",
                Base::Free13 => "13, base free",
            };
            case(&format!("{name}, {freedoms}"), CALLS, || (0..CALLS).for_each(|_| kernel(&mut arm)));
        }
    }
}

fn detection() {
    for name in PAIRS {
        let mut query = pairs::pair(name);
        case(&format!("detection, {name}"), CALLS, || {
            for call in 0..CALLS as u32 {
                black_box(query.detect_drifting(call));
            }
        });
    }
    let mut job = mission("peer-grasp", &[]);
    run_to(&mut job, SETTLED);
    let mut query = pairs::grasp(&job.world);
    case("detection, grasp", CALLS, || {
        for _ in 0..CALLS {
            black_box(query.detect());
        }
    });
}

fn diagnosis() {
    let spec = scenario::load(&place("scenarios/rigs/tumbler.toml"), &[]).unwrap_or_else(|e| panic!("{e}"));
    let set = RecordingSet::load(&place("tests/recordings/tumble-inertia")).unwrap_or_else(|e| panic!("{e}"));
    case("diagnosis of tests/recordings/tumble-inertia", 1, || {
        black_box(diagnose::diagnose(spec.clone(), &set, &()).unwrap_or_else(|e| panic!("{e}")));
    });
}
