//! A mission with all three: momentum and energy are kept as with laws of softdock's own, and the tether is kept taut by what the laser says.

use record::{Recorder, RecorderPlan};
use scenario::recording::{recorder_plan, scene};
use sim::{EnergyAudit, Flow, World};
use softdock_extension::{Keeper, Laser, LaserAlone, RANGE, Tether, with_forces};
use std::sync::{Arc, Mutex};

type Failure = Box<dyn std::error::Error>;

fn mission() -> Result<scenario::Mission, Failure> {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("two.toml");
    Ok(scenario::build(&scenario::load(&file, &[])?)?)
}

fn tether(damping: f64) -> Tether {
    Tether { ends: [(0, 0), (1, 0)], length: 3.2, stiffness: 20.0, damping }
}

#[test]
fn a_tether_keeps_momentum_and_its_work_is_what_motion_lost() -> Result<(), Failure> {
    for (damping, least) in [(0.0, 0.0), (8.0, 0.01)] {
        let mut mission = mission()?;
        with_forces(&mut mission, vec![Arc::new(tether(damping))])?;
        let before = mission.world.state().momentum.clone();
        let mut audit = EnergyAudit::new(&mission.world);
        let mut deepest = 0.0_f64;
        let mut look = |world: &World| {
            deepest = deepest.min(world.works().forces[0]);
            Flow::Continue
        };
        mission.world.run(mission.steps, &sim::NoControl, &mut [&mut look])?;
        let after = &mission.world.state().momentum;
        let gained = after[0] + after[1] - before[0] - before[1];
        assert!(gained.force.norm() + gained.moment.norm() < 1e-11, "{gained:?}");
        let balance = audit.close(&mission.world);
        assert!(balance.numerical_loss.abs() < 1e-4, "{} J", balance.numerical_loss);
        // Taut it took what motion had; a damped one keeps some of it.
        let kept = -mission.world.works().forces[0];
        assert!(deepest < -0.02 && kept > least - 1e-6, "{deepest} J at the most, {kept} J kept");
    }
    Ok(())
}

#[test]
fn a_controller_keeps_a_tether_taut_by_a_sensor_of_its_own_and_a_recording_has_it() -> Result<(), Failure> {
    let mut mission = mission()?;
    with_forces(&mut mission, vec![Arc::new(tether(8.0))])?;
    let laser = Laser { between: [0, 1], step: 0.01, every: 20 };
    let blank = World::new(mission.world.model().clone(), sim::State::new(mission.world.model()));
    mission.world.perceive(Some(Arc::new(LaserAlone { laser, blank: Mutex::new(blank) })));
    mission.controller = Box::new(Keeper { actuator: 0, range: 3.2, force: 1.0 });
    let plan = recorder_plan(&mission, &scene(&mission))?;
    let probes = plan.probes.into_iter().chain([Box::new(laser) as Box<_>]).collect();
    let recorder = Recorder::new(&mission.world, RecorderPlan { probes, ..plan }, None);
    let done = scenario::run(mission, Some(recorder), &mut [])?;
    done.ended?;
    let log = done.log.ok_or("nothing was recorded")?;
    let range = log.signals.values(RANGE).ok_or("no range was recorded")?;
    let late = &range[range.len() / 2..];
    let (least, most) = late.iter().fold((f64::MAX, f64::MIN), |(least, most), r| (least.min(*r), most.max(*r)));
    assert!(least > 3.1 && most < 3.3, "{least} … {most} m");
    assert!(range.iter().all(|r| (r / 0.01 - (r / 0.01).round()).abs() < 1e-6));
    Ok(())
}
