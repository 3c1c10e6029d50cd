#![allow(clippy::unwrap_used)]
use record::RecordingSet;
#[test]
fn look() {
    let folder = std::path::Path::new("/work/shared/recordings/practice");
    for name in ["tumbler-01", "air-table-01"] {
        let set = RecordingSet::load(&folder.join(name)).unwrap();
        if name.starts_with("arm") { for s in &set.runs[0].series { if s.channel.contains("position") { println!("{} {:e}", s.channel, s.quantum()); } } }
        let start = std::time::Instant::now();
        let found = record::consistency::check(&set, &|c| { let q = set.runs[0].series(c)?; Some(q.sigma_with_rounding(set.sigma(c)?)) });
        println!("{name} {:?}", start.elapsed());
        for f in found { println!("{:?}", f.matrix); println!("{} n {} misfit {:.3} -> {:.3} gain {:.1}/{} scale {:?} bias {:?} delay {:?} angle {:?} {:?}", f.rate, f.samples, f.misfit, f.misfit_fitted, f.gain, f.parameters, f.scale.iter().map(|s| s.map(|s| (s.value, s.z(1.0)))).collect::<Vec<_>>(), f.bias.iter().map(|s| s.map(|s| (s.value, s.z(0.0)))).collect::<Vec<_>>(), f.delay.map(|s| (s.value, s.z(0.0))), f.angle.map(|a| a.map(|s| (s.value, s.z(0.0)))), f.findings); }
    }
}
