//! From the checked file to a world that runs: spec → model → state, and the plan of what to do with it.
//!
//! Every name is resolved here; what cannot be built is told all at once, each fault with its line in the file.

mod actuators;
mod approach;
mod beds;
mod docking;
mod drives;
mod effects;
mod faults;
mod kinematics;
mod laws;
mod mechanisms;
mod missing;
mod overlap;
mod shapes;
mod start;
mod stock;
mod vehicles;

pub(crate) use actuators::ActuatorTable;
pub use docking::docking_visuals;
pub use drives::DriveChannel;
pub use effects::OwnInertials;
pub(crate) use effects::{Entry, Parts, Tip, add_mount};
pub(crate) use faults::Faults;
pub(crate) use kinematics::{calc_error, halves, solve_pose};
pub use shapes::shape_of_geometry;
pub use stock::Stock;

use crate::error::ScenarioErrors;
use crate::measure::Gauge;
use crate::navigation::{self, Navigator};
use crate::sensors::Part;
use crate::spec::{self, Scenario};
use crate::strategy;
use multibody::{RobotDescription, UrdfWarnings};
use sim::{Controller, Environment, Integrator, Model, ModelSpec, World};
use spatial::Vec3;
use std::sync::Arc;

/// A scenario, ready to run.
pub struct Mission {
    /// The scenario it came from.
    pub scenario: Scenario,
    /// The robots as their files describe them, one per vehicle.
    pub robots: Vec<RobotDescription>,
    /// What is doubtful in those files, one list per vehicle.
    pub robot_warnings: Vec<UrdfWarnings>,
    /// Mass properties of their links, one list per vehicle, as files and corrections have them: without what effects add to a link, or let move in it by
    /// itself.
    pub own_inertials: Vec<OwnInertials>,
    /// The world at t = 0.
    pub world: World,
    /// The driven coordinates, in the order of [`Model::with_drive_paths`].
    pub drives: Vec<DriveChannel>,
    /// Guidance and control.
    pub controller: Box<dyn Controller + Send + Sync>,
    /// What stands between `world` and `controller`, where that is not the truth.
    pub(crate) navigator: Option<Arc<Navigator>>,
    /// Steps of the whole run.
    pub steps: u64,
    /// Steps between two logged samples.
    pub steps_per_sample: u64,
}

impl std::fmt::Debug for Mission {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mission").field("scenario", &self.scenario.name).field("steps", &self.steps).finish()
    }
}

impl Mission {
    /// What stands between world and controller: sensors, and what navigation makes of them; none where the strategy knows the truth, or asks for nothing.
    /// For worlds that take over from the mission's ([`World::perceive`]).
    pub fn perception(&self) -> Option<Arc<dyn sim::Perception>> {
        self.navigator.clone().map(|known| known as Arc<dyn sim::Perception>)
    }

    /// What the strategy knows, in words; none where it does not ask where things are.
    pub fn knowledge(&self) -> Option<&'static str> {
        let filter = self.scenario.navigation.filter;
        match (&self.navigator, navigation::steers_by_sight(&self.scenario)) {
            (_, false) => None,
            (None, true) => Some("the truth (navigation.perfect)"),
            (Some(_), true) if filter => Some("what its sensors say, the target through a filter"),
            (Some(_), true) => Some("what its sensors say, the target as the camera last saw it"),
        }
    }
}

/// Builds the world and the plan of a scenario; refused if its shapes stand inside each other at t = 0.
pub fn build(scenario: &Scenario) -> Result<Mission, ScenarioErrors> {
    let mission = build_from(scenario, &Stock::default())?;
    check_start(&mission)?;
    Ok(mission)
}

/// Refuses a mission in which shapes stand inside each other at t = 0, deeper than what presses them together would hold them.
pub fn check_start(mission: &Mission) -> Result<(), ScenarioErrors> {
    overlap::check(mission)
}

/// As [`build`], to the bit, with what an earlier build of the same scenario has loaded and prepared, and without
/// [`check_start`]: a caller may have another start in mind than the file's.
pub fn build_from(scenario: &Scenario, stock: &Stock) -> Result<Mission, ScenarioErrors> {
    let mut faults = Faults::new(scenario);
    let plan = effects::check(scenario, &mut faults);
    let Some(vehicles) = vehicles::load(scenario, &plan, stock, &mut faults) else { return Err(faults.into_errors()) };
    let vehicles::Loaded { files, nominal_coms, mut specs } = vehicles;
    let table = actuators::resolve(scenario, &mut specs, &mut faults);
    let (shapes, pairs) = shapes::resolve(scenario, &files.robots, &specs, &mut faults);
    let mechanisms = mechanisms::resolve(scenario, &specs, &mut faults);
    let environment = environment(&scenario.environment);
    let mut parts = effects::Parts {
        vehicles: specs,
        nominal_coms,
        table,
        shapes,
        pairs,
        mechanisms,
        environment,
        effects: Vec::new(),
    };
    effects::apply(&plan, &mut parts, &mut faults);
    if !faults.is_empty() {
        return Err(faults.into_errors());
    }
    let spec = ModelSpec {
        vehicles: parts.vehicles,
        shapes: parts.shapes,
        pairs: parts.pairs,
        mechanisms: parts.mechanisms,
        actuators: parts.table.actuators.clone(),
        effects: parts.effects,
        environment: parts.environment,
        integrator: integrator(scenario.integrator.kind),
        step: scenario.integrator.step_s,
    };
    let model = match Model::build_like(stock.scene(), spec) {
        Ok(model) => drives::attach(scenario, model, &mut faults),
        Err(error) => {
            faults.add("", error.to_string());
            return Err(faults.into_errors());
        }
    };
    let Some((model, drives)) = model else { return Err(faults.into_errors()) };
    finish(scenario, files, (&Arc::new(model), drives), &parts.table, faults)
}

fn finish(
    scenario: &Scenario,
    files: vehicles::RobotFiles,
    (model, drives): (&Arc<Model>, Vec<DriveChannel>),
    table: &ActuatorTable,
    mut faults: Faults<'_>,
) -> Result<Mission, ScenarioErrors> {
    check_sensors(scenario, model, &mut faults);
    approach::check_docking(scenario, model, &mut faults);
    let world = mechanisms::settle(scenario, start::world(scenario, model, table, &mut faults));
    missing::check_freedoms(&world, &files.warnings, &mut faults);
    let controller = strategy::build(scenario, model, table, &mut faults);
    let navigator = navigation::build(scenario, &world, &mut faults).map(Arc::new);
    let Some(controller) = controller.filter(|_| faults.is_empty()) else { return Err(faults.into_errors()) };
    let mut mission = Mission {
        scenario: scenario.clone(),
        robots: files.robots,
        robot_warnings: files.warnings,
        own_inertials: files.own_inertials,
        world,
        drives,
        controller,
        navigator,
        steps: (scenario.duration_s / scenario.integrator.step_s).round().max(1.0) as u64,
        steps_per_sample: samples(scenario),
    };
    let perception = mission.perception();
    mission.world.perceive(perception);
    Ok(mission)
}

fn samples(scenario: &Scenario) -> u64 {
    (1.0 / (scenario.output.log_rate_hz * scenario.integrator.step_s)).round().max(1.0) as u64
}

/// Every sensor measures something, and every fault of a sensor is one that it can have.
fn check_sensors(scenario: &Scenario, model: &Model, faults: &mut Faults<'_>) {
    for (i, effect) in scenario.effects.iter().enumerate() {
        if let Some(fault) = crate::measure::find_fault(scenario, model, effect) {
            faults.add(&format!("effect[{i}].place"), fault);
        }
    }
    for (i, sensor) in scenario.sensors.iter().enumerate() {
        let place = format!("sensor[{i}]");
        match crate::sensors::parts_of(sensor, model) {
            Err(fault) => faults.add(&place, fault),
            Ok(parts) => {
                let resolved = |part: &Part| Gauge::resolve(scenario, model, &part.name).err().map(|e| e.fault);
                parts.iter().filter_map(resolved).take(1).for_each(|fault| faults.add(&place, fault));
            }
        }
    }
}

fn environment(spec: &spec::Environment) -> Environment {
    match *spec {
        spec::Environment::DeepSpace | spec::Environment::AirBearing => Environment::DeepSpace,
        spec::Environment::Orbit { mean_motion_rad_per_s, gravity_gradient } => {
            Environment::Orbit { mean_motion: mean_motion_rad_per_s, gravity_gradient }
        }
        spec::Environment::Lab { gravity_m_per_s2 } => Environment::Uniform { gravity: Vec3::from(gravity_m_per_s2) },
    }
}

fn integrator(kind: spec::IntegratorKind) -> Integrator {
    match kind {
        spec::IntegratorKind::ImplicitEuler => Integrator::ImplicitEuler,
        spec::IntegratorKind::ImplicitMidpoint => Integrator::ImplicitMidpoint,
        spec::IntegratorKind::SemiImplicitEuler => Integrator::SemiImplicitEuler,
        spec::IntegratorKind::Rk4 => Integrator::RungeKutta4,
    }
}
