#![allow(missing_docs, clippy::all, clippy::print_stdout, clippy::unwrap_used)]
use std::path::Path;
use sim::Observer;
#[path = "../../../benches/instructions/callgrind.rs"]
mod callgrind;
fn mission(name: &str, integrator: &str) -> scenario::Mission {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenarios/{name}.toml"));
    let spec = scenario::load(&file, &[format!("integrator.kind={integrator}")]).unwrap();
    scenario::build(&spec).unwrap()
}
fn case(name: &str, calls: usize, mut work: impl FnMut()) {
    callgrind::measured_block(&mut work);
    println!("{calls}\t{name}");
}
fn main() {
    if let Ok(what) = std::env::var("QUICK") {
        let mut m = mission(&what, "implicit-euler");
        m.world.run(2000, &*m.controller, &mut []).unwrap();
        let snap = m.world.state().clone();
        let t = std::time::Instant::now();
        for _ in 0..20 {
            let mut w = sim::World::new(m.world.model().clone(), snap.clone());
            for _ in 0..2000 { w.control(&*m.controller); w.advance().unwrap(); }
        }
        println!("{:.3} us", t.elapsed().as_secs_f64() / 0.04);
        return;
    }
    let hash = |w: &sim::World| { let mut h = 0xcbf29ce484222325u64; for x in w.state().q.iter().chain(&w.state().v).copied().chain(w.state().bases.iter().flat_map(|b| [b.translation.x,b.translation.y,b.rotation.i,b.rotation.w])) { h = (h ^ (x+0.0).to_bits()).wrapping_mul(0x100000001b3); } h };
    let mut ends = Vec::new();
    for (name, t) in [("peer-grasp", 2000), ("peer-free-arm", 0)] {
        for i in ["implicit-euler", "implicit-midpoint", "rk4"] {
            if i == "rk4" && t > 0 { continue; }
            let mut m = mission(name, i);
            m.world.run(t, &*m.controller, &mut []).unwrap();
            case(&format!("{name} {i}"), 200, || for _ in 0..200 { m.world.control(&*m.controller); m.world.advance().unwrap(); });
            ends.push((name, i, hash(&m.world), m.world.state().v[3]));
        }
    }
    let mut m = mission("peer-grasp", "implicit-euler");
    m.world.run(2000, &*m.controller, &mut []).unwrap();
    let mut judge = scenario::outcome::Judge::new(&m);
    let plan = record::RecorderPlan { meta: Default::default(), every: m.steps_per_sample, probes: vec![], keep: Box::new(|_| true), links: m.robots.iter().map(|r| r.links.len()).collect() };
    let mut recorder = record::Recorder::new(&m.world, plan, None);
    case("grasp observed", 200, || { let o: &mut [&mut dyn Observer] = &mut [&mut judge, &mut recorder]; m.world.run(2200, &*m.controller, o).unwrap(); });
    for e in ends { eprintln!("{e:?}"); }
}
