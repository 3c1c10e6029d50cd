//! Creep of what is held: motion of stuck points over the last seconds of a run, less what their bristles explain.
//!
//! At the window's start every touching point is nailed to both bodies. At its end
//!   slip = P (x_b − x_a) − Δs
//! is what moved beyond the elastic deflection: zero, to rounding, for a point that only sticks. The rotation is the
//! largest difference of two points' slips over their distance. The total motion, elastic part included, stands beside it.

use sim::World;
use spatial::{Frame, Vec3, log_rotation};

/// Length of the window, s, and its largest share of the run.
const WINDOW: (f64, f64) = (4.0, 0.4);

/// Follows the points.
#[derive(Clone, Debug, Default)]
pub(super) struct CreepGauge {
    from_step: u64,
    nails: Vec<Nail>,
    bodies: Option<(usize, usize, Frame)>,
}

#[derive(Clone, Copy, Debug)]
struct Nail {
    key: (u32, u64),
    local_a: Vec3,
    local_b: Vec3,
    normal_b: Vec3,
    s_b: Vec3,
}

/// What was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Creep {
    pub(super) points: usize,
    pub(super) slip: f64,
    pub(super) rotation: f64,
    pub(super) total_slip: f64,
    pub(super) total_rotation: f64,
}

impl CreepGauge {
    pub(super) fn new(steps: u64, step: f64) -> Self {
        let window = (WINDOW.0 / step).min(WINDOW.1 * steps as f64) as u64;
        Self { from_step: steps - window, ..Self::default() }
    }

    /// Nails the points when the window opens.
    pub(super) fn observe(&mut self, world: &World) {
        if world.state().steps != self.from_step {
            return;
        }
        let normal_of = |key| world.touches().find(|t| (t.pair as u32, t.feature) == key).map(|t| t.normal_w);
        for memory in &world.state().bristles {
            let (a, b) = world.model().pair_bodies(memory.pair as usize);
            let (frame_a, frame_b) = (world.frame(a), world.frame(b));
            let key = (memory.pair, memory.feature);
            let Some(normal) = normal_of(key) else { continue };
            self.nails.push(Nail {
                key,
                local_a: frame_a.inverse_point(&frame_b.point(&memory.point_b)),
                local_b: memory.point_b,
                normal_b: frame_b.rot.tr_mul(&normal),
                s_b: frame_b.rot.tr_mul(&memory.s_w),
            });
            self.bodies.get_or_insert((a, b, relative(&frame_a, &frame_b)));
        }
    }

    /// What moved since; `None` if nothing was held through the window.
    pub(super) fn read(&self, world: &World) -> Option<Creep> {
        let (a, b, start) = self.bodies?;
        let mut slips = Vec::new();
        let mut total = 0.0_f64;
        for nail in &self.nails {
            let memory = world.state().bristles.iter().find(|m| (m.pair, m.feature) == nail.key)?;
            let (a, b) = world.model().pair_bodies(nail.key.0 as usize);
            let (frame_a, frame_b) = (world.frame(a), world.frame(b));
            let moved = frame_b.rot.tr_mul(&(frame_b.point(&nail.local_b) - frame_a.point(&nail.local_a)));
            let tangential = moved - nail.normal_b * nail.normal_b.dot(&moved);
            total = total.max(tangential.norm());
            slips.push((nail.local_b, tangential - (frame_b.rot.tr_mul(&memory.s_w) - nail.s_b)));
        }
        let now = relative(&world.frame(a), &world.frame(b));
        let turned = log_rotation(&(now.to_pose().rotation * start.to_pose().rotation.inverse())).norm();
        Some(Creep {
            points: slips.len(),
            slip: slips.iter().map(|(_, s)| s.norm()).fold(0.0, f64::max),
            rotation: calc_rotation(&slips),
            total_slip: total,
            total_rotation: turned,
        })
    }
}

fn relative(frame_a: &Frame, frame_b: &Frame) -> Frame {
    Frame { rot: frame_a.rot.tr_mul(&frame_b.rot), pos: frame_a.inverse_point(&frame_b.pos) }
}

/// Largest difference of two points' slips over their distance, rad.
fn calc_rotation(slips: &[(Vec3, Vec3)]) -> f64 {
    let mut largest = 0.0_f64;
    for (i, (x, s)) in slips.iter().enumerate() {
        for (y, r) in &slips[..i] {
            let distance = (x - y).norm();
            // Points nearer than a millimetre tell of slip, not of rotation.
            if distance > 1e-3 {
                largest = largest.max((s - r).norm() / distance);
            }
        }
    }
    largest
}
