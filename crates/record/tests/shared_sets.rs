#![allow(clippy::unwrap_used)]
use record::RecordingSet;
#[test]
fn look() {
    let folder = std::path::Path::new("/work/shared/recordings/practice");
    for name in std::env::var("SETS").unwrap_or("tumbler-01 air-table-01 dock-impact-01 stick-slip-01 arm-bench-01".into()).split(' ') {
        let set = RecordingSet::load(&folder.join(name)).unwrap();
        let start = std::time::Instant::now();
        let found = record::inspect::inspect(&set);
        println!("== {name} {:?}\n{}", start.elapsed(), record::inspect::to_text(&found));
    }
}
