//! Writes every product of a made-up capture: `cargo run -p softdock-record --example made_up_run -- OUT`;
//! `-- --live` plays it to a viewer that is open.

#[path = "../tests/synthetic/mod.rs"]
mod synthetic;

use record::OutputFolder;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let out = std::env::args().nth(1).ok_or("give an output folder")?;
    let (log, scene) = (synthetic::run(12.0), synthetic::scene());
    if out == "--live" {
        return Ok(live(&log, scene)?);
    }
    let folder = OutputFolder::create(out.as_ref())?;
    record::write_parquet(&folder.file("signals.parquet"), &log.meta, &log.signals)?;
    record::write_csv(&folder.file("signals.csv"), &log.signals)?;
    record::write_file(&folder.file("signals.svg"), record::plot::plot_svg(&log).as_bytes())?;
    #[cfg(feature = "rerun")]
    record::rerun_sink::write_rrd(&folder.file("run.rrd"), &log, &scene, synthetic::SUMMARY)?;
    let summary = serde_json::Map::from_iter([("outcome".to_string(), "captured".into())]);
    folder.finish(&summary)?;
    Ok(())
}

/// Plays the run in real time to a viewer that is open.
#[cfg(feature = "rerun")]
fn live(log: &record::Log, scene: record::Scene) -> Result<(), record::RecordError> {
    use record::rerun_sink::{DEFAULT_VIEWER, LiveRerun};
    let specs = log.signals.channels.iter().map(|channel| channel.spec.clone()).collect();
    let mut viewer = LiveRerun::connect(DEFAULT_VIEWER, log.meta.clone(), specs, scene)?.with_peak_force(15.0);
    let mut events = log.events.iter().peekable();
    let mut values = Vec::new();
    for i in 0..log.len() {
        let sample = log.sample(i, &mut values);
        while let Some(event) = events.next_if(|event| event.t <= sample.t) {
            viewer.push_event(event.clone());
        }
        viewer.push(&sample)?;
        std::thread::sleep(std::time::Duration::from_millis(4));
    }
    viewer.finish(synthetic::SUMMARY)
}

#[cfg(not(feature = "rerun"))]
fn live(_log: &record::Log, _scene: record::Scene) -> Result<(), record::RecordError> {
    Ok(())
}
