//! The cube and the table as a world, and one toss simulated in it.
//!
//! The cube touches the table with its corners, each a ball of a small radius whose outermost point lies on the two
//! faces' planes: that is the rounded cube exactly, since only corners can be lowest over a plane. Radius zero is the
//! sharp cube.

use super::RealError;
use super::toss::{Correction, MASS, MOMENT, Miss, RATE, Start, Summary, Toss, WIDTH};
use crate::bench::Bench;
use crate::scene::one_link;
use contact::{Normal, NormalLaw, Shape};
use friction::Bristle;
use multibody::Geometry;
use sim::{Base, Integrator, Model, ModelSpec, PairLaw, State, World};
use spatial::{Pose, Vec3};
use std::sync::Arc;

/// What the cube's corner and the table are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Along the normal, per corner.
    pub normal: NormalLaw,
    /// In the plane, per corner.
    pub friction: Bristle,
    /// Radius of the corners, m.
    pub radius: f64,
}

/// How the simulation runs and what of the recording it corrects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Gravity and table.
    pub correction: Correction,
    /// Steps per sample (1/148 s).
    pub substeps: usize,
    /// How time advances.
    pub integrator: Integrator,
}

/// A world for one set of parameters, used for one toss after the other.
#[derive(Debug)]
pub struct Thrower {
    world: World,
    at_rest: State,
    substeps: usize,
}

impl Thrower {
    /// Builds the world.
    pub fn new(surface: &Surface, rules: &Rules) -> Result<Self, RealError> {
        let model = Arc::new(Model::build(build_spec(surface, rules))?);
        let at_rest = State::new(&model);
        Ok(Self { world: World::new(model, at_rest.clone()), at_rest, substeps: rules.substeps })
    }

    /// Poses at the sample times of a toss; short of its end where the run diverged.
    pub fn simulate(&mut self, start: &Start, samples: usize) -> Vec<Pose> {
        self.reset(start);
        let mut poses = Vec::with_capacity(samples);
        poses.push(start.pose);
        while poses.len() < samples {
            for _ in 0..self.substeps {
                if self.world.advance().is_err() {
                    return poses;
                }
            }
            poses.push(self.world.state().bases[0]);
        }
        poses
    }

    /// Errors over a toss, sample by sample.
    pub fn measure(&mut self, start: &Start, toss: &Toss) -> Miss {
        Miss::measure(&self.simulate(start, toss.poses.len()), toss)
    }

    /// Errors over a toss; infinite where the run diverged.
    pub fn summarise(&mut self, start: &Start, toss: &Toss) -> Summary {
        let miss = self.measure(start, toss);
        if miss.position.len() < toss.poses.len() {
            let lost = [f64::INFINITY; 2];
            return Summary { whole: lost, early: lost, end: lost };
        }
        miss.summarise(toss)
    }

    /// The world at the start of a toss.
    pub fn throw(mut self, start: &Start) -> World {
        self.reset(start);
        self.world
    }

    fn reset(&mut self, start: &Start) {
        self.world.state_mut().clone_from(&self.at_rest);
        self.world.state_mut().bases[0] = start.pose;
        self.world.set_base_twists(&[start.twist]);
    }
}

fn build_spec(surface: &Surface, rules: &Rules) -> ModelSpec {
    let step = 1.0 / RATE / rules.substeps as f64;
    let mut bench =
        Bench::new("cube-tosses", step).gravity([0.0, 0.0, -rules.correction.gravity]).integrator(rules.integrator);
    bench.add_floor();
    bench.spec.shapes[0].pose_ls = Pose::translation(0.0, 0.0, rules.correction.table);
    let robot = one_link("cube", MASS, Vec3::repeat(MOMENT), Geometry::Box { size: Vec3::repeat(WIDTH) });
    let cube = bench.add_vehicle("cube", &robot, Base::Free);
    bench.add_shape(Some(cube), 0, cube_shape(surface.radius));
    bench.pair("floor", "cube", PairLaw::new(Normal::new(surface.normal), Some(surface.friction.into())));
    bench.spec
}

fn cube_shape(radius: f64) -> Shape {
    if radius <= 0.0 {
        return Shape::Cuboid { half_extents: Vec3::repeat(0.5 * WIDTH) };
    }
    let at = 0.5 * WIDTH - radius;
    let sign = |k: u32, axis: u32| if k >> axis & 1 == 0 { -at } else { at };
    let corner = |k: u32| (Pose::translation(sign(k, 0), sign(k, 1), sign(k, 2)), Shape::Ball { radius });
    Shape::Compound((0..8).map(corner).collect())
}
