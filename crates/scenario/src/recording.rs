//! A mission as something to record and to see: channels, scene, close-up, trails.

use crate::spec::Strategy;
use crate::{Mission, ScenarioErrors, docking_visuals, glob_matches, sensors, to_toml};
use record::{ChannelSpec, Function, Meta, Plot, Probe, RecorderPlan, Scene, SceneVehicle, Trail};
use sim::World;
use spatial::Vec3;

/// What is seen: the vehicles, the close-up of the target or the port, and the trail of what comes.
pub fn scene(mission: &Mission) -> Scene {
    let vehicles = mission.scenario.vehicles.iter().zip(&mission.robots);
    let mut scene = Scene {
        vehicles: vehicles.map(|(v, robot)| SceneVehicle::from_robot(&v.name, robot)).collect(),
        ..Scene::default()
    };
    for (on, visual) in docking_visuals(&mission.scenario) {
        match on.split_once('/') {
            None => scene.fixtures.push(visual),
            Some((vehicle, link)) => {
                let vehicles = scene.vehicles.iter_mut().filter(|v| v.name == vehicle);
                let link = vehicles.flat_map(|v| &mut v.links).find(|l| l.name == link);
                link.into_iter().for_each(|l| l.visuals.push(visual.clone()));
            }
        }
    }
    if let Strategy::TrackAndGrasp(spec) = &mission.scenario.strategy {
        let index = |name: &str| name.split_once('/').and_then(|(v, l)| scene.link_index(v, l));
        let (tool, grapple) = (index(&spec.tool_frame), index(&spec.grapple_frame));
        // Seen from the body that is captured, so that the camera stands outside it.
        scene.close_up = mission
            .robots
            .iter()
            .zip(&mission.scenario.vehicles)
            .find(|(_, v)| v.name == spec.target)
            .and_then(|(robot, v)| scene.link_index(&v.name, &robot.links[0].name));
        let trail = |name: &str, link: usize| Trail { name: name.to_owned(), link, point_l: Vec3::zeros() };
        scene.trails.extend(tool.map(|l| trail("tool", l)));
        scene.trails.extend(grapple.map(|l| trail("grapple point", l)));
    }
    if let Some(docking) = &mission.scenario.docking {
        let index = |name: &str| name.split_once('/').and_then(|(v, l)| scene.link_index(v, l));
        let (visitor, port) = (index(&docking.visitor), index(&docking.port));
        scene.close_up = scene.close_up.or(port);
        let trail = |name: &str, link: usize| Trail { name: name.to_owned(), link, point_l: Vec3::zeros() };
        scene.trails.extend(visitor.map(|l| trail("visitor", l)));
    }
    scene
}

/// What is recorded, as the sensors read it. What no run can record is told.
pub fn recorder_plan(mission: &Mission, scene: &Scene) -> Result<RecorderPlan, ScenarioErrors> {
    let scenario = &mission.scenario;
    let patterns = scenario.output.channels.clone();
    let mut probes = relative_motion(mission);
    probes.extend(mission.navigator.as_ref().map(|n| Box::new(n.clone().as_probe()) as Box<dyn Probe + Send>));
    let sensors = sensors::of(scenario, mission.world.model()).map_err(ScenarioErrors::new)?;
    probes.push(Box::new(sensors::Recorded::new(sensors)));
    Ok(RecorderPlan {
        meta: Meta {
            scenario: scenario.name.clone(),
            seed: scenario.seed,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            inputs: to_toml(scenario),
            notes: Vec::new(),
        },
        every: mission.steps_per_sample,
        probes,
        keep: Box::new(move |name| patterns.iter().any(|p| glob_matches(p, name))),
        links: scene.vehicles.iter().map(|v| v.links.len()).collect(),
    })
}

/// Relative motion of tool and grapple frame.
fn relative_motion(mission: &Mission) -> Vec<Box<dyn Probe + Send>> {
    let Strategy::TrackAndGrasp(spec) = &mission.scenario.strategy else { return Vec::new() };
    let model = mission.world.model();
    let (Some(tool), Some(grapple)) = (model.link(&spec.tool_frame), model.link(&spec.grapple_frame)) else {
        return Vec::new();
    };
    let probe = |name: &str, unit: &str, text: &str, read: fn(&World, Ends) -> f64| -> Box<dyn Probe + Send> {
        let spec = ChannelSpec::new(name, unit, Plot::Relative).described(text);
        Box::new(Function { spec, read: move |world: &World| read(world, (tool, grapple)) })
    };
    vec![
        probe("relative.distance", "m", "tool frame to grapple frame", |w, (a, b)| {
            (w.link_frame(a.0, a.1).pos - w.link_frame(b.0, b.1).pos).norm()
        }),
        probe("relative.angle", "rad", "between the two frames", |w, (a, b)| {
            let (a, b) = (w.link_frame(a.0, a.1).to_pose(), w.link_frame(b.0, b.1).to_pose());
            a.rotation.angle_to(&b.rotation)
        }),
        probe("relative.speed", "m/s", "of the two frames' origins", |w, (a, b)| {
            (w.link_twist(a.0, a.1).lin - w.link_twist(b.0, b.1).lin).norm()
        }),
        probe("relative.rate", "rad/s", "angular rate between the two buses", |w, (a, b)| {
            (w.kinematics(a.0).vel[0].ang - w.kinematics(b.0).vel[0].ang).norm()
        }),
    ]
}

/// Vehicle and link of the tool and of the grapple frame.
type Ends = ((usize, usize), (usize, usize));
