//! Broad phase, then one closed form or manifold per pair of parts.
//!
//! Broad phase: boxes about the parts in W axes, grown by each body's reach, swept along x (Cohen et al. 1995); it is
//! stateless, so the points do not depend on what was asked before. Colliders of no pair are passed over.

use crate::analytic::{Raw, ball_ball, plane_ball, plane_cuboid, swapped};
use crate::bed_points::{BedBuffer, is_bed};
use crate::convex::{Convex, Core};
use crate::docking::{Body, DockingBuffer};
use crate::faceted::FacetBuffer;
use crate::manifold::{add_nearest, mix};
use crate::primitive::{PrimitiveBuffer, convex_ball};
use crate::reduce::Reduction;
use crate::scene::{ContactPoint, NONE, Part, Scene, Solid, Twin};
use spatial::{Frame, Vec3};

/// Distance, m, at which points are reported although nothing moves.
const SKIN: f64 = 1e-4;

/// Scratch of the detection; holds nothing that a result depends on.
pub struct Detector {
    boxes: Vec<Bounds>,
    /// Places of all parts in W, collider by collider, and where each collider's begin.
    frames: Vec<Frame>,
    first_frame: Vec<usize>,
    order: Vec<u32>,
    candidates: Vec<u32>,
    raw: Vec<Raw>,
    reduction: Reduction,
    primitives: PrimitiveBuffer,
    docking: DockingBuffer,
    facets: FacetBuffer,
    beds: BedBuffer,
    narrow: u64,
}

/// A box in W axes.
#[derive(Clone, Copy, Debug, Default)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl std::fmt::Debug for Detector {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Detector").field("narrow", &self.narrow).finish_non_exhaustive()
    }
}

impl Detector {
    /// Room for a scene.
    pub fn new(scene: &Scene) -> Self {
        let n = scene.colliders().len();
        let mut first_frame = vec![0; n + 1];
        for (i, parts) in scene.parts.iter().enumerate() {
            first_frame[i + 1] = first_frame[i] + parts.len();
        }
        Self {
            boxes: vec![Bounds::default(); n],
            frames: vec![Frame::identity(); first_frame[n]],
            first_frame,
            order: scene.asked.clone(),
            candidates: Vec::with_capacity(scene.pairs().len()),
            raw: Vec::with_capacity(64),
            reduction: Reduction::default(),
            primitives: PrimitiveBuffer::default(),
            docking: DockingBuffer::default(),
            facets: FacetBuffer::default(),
            beds: BedBuffer::default(),
            narrow: 0,
        }
    }

    /// Pairs tested closely so far.
    pub fn narrow_count(&self) -> u64 {
        self.narrow
    }

    /// Points of all pairs nearer than the reaches of their two bodies together.
    ///
    /// `poses`: W←body, by body index; `reach`: how far any point of a body may move within the step, m. `out` is
    /// overwritten, sorted by pair and feature.
    pub fn detect(&mut self, scene: &Scene, poses: &[Frame], reach: &[f64], out: &mut Vec<ContactPoint>) {
        out.clear();
        self.update_boxes(scene, poses, reach);
        self.sweep(scene);
        for i in 0..self.candidates.len() {
            let pair = self.candidates[i];
            let [a, b] = scene.pairs()[pair as usize];
            let (body_a, body_b) = (scene.colliders()[a].body, scene.colliders()[b].body);
            let margin = reach[body_a] + reach[body_b] + SKIN;
            self.narrow += 1;
            self.find(scene, [a, b], margin);
            self.raw.sort_unstable_by_key(|p| p.feature);
            self.reduction.reduce(&mut self.raw);
            let reduction = &self.reduction;
            out.extend(self.raw.iter().enumerate().map(|(i, p)| p.in_pair(pair, reduction.weight_of(i))));
            let own = (&scene.parts[a][..], &poses[body_a]);
            self.add_beds(own, (&scene.parts[b], &poses[body_b]), (pair, margin), out);
        }
    }

    /// Adds the points of beds to those of a pair, in the order of features.
    fn add_beds(
        &mut self,
        a: (&[Part], &Frame),
        b: (&[Part], &Frame),
        (pair, margin): (u32, f64),
        out: &mut Vec<ContactPoint>,
    ) {
        self.beds.find(a, b, margin);
        if self.beds.found.is_empty() {
            return;
        }
        let start = out.len() - self.raw.len();
        out.extend(self.beds.found.iter().map(|(p, weight)| p.in_pair(pair, *weight)));
        out[start..].sort_unstable_by_key(|p| p.feature);
    }

    fn update_boxes(&mut self, scene: &Scene, poses: &[Frame], reach: &[f64]) {
        for &i in &scene.asked {
            let (i, collider) = (i as usize, &scene.colliders()[i as usize]);
            let grow = Vec3::repeat(reach[collider.body] + SKIN);
            let mut bounds = Bounds { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) };
            for (part, place) in scene.parts[i].iter().zip(&mut self.frames[self.first_frame[i]..]) {
                let frame = &poses[collider.body] * &part.frame_bp;
                let centre = frame.point(&part.centre);
                let half = if part.half.x.is_finite() { frame.rot.abs() * part.half } else { part.half };
                bounds.low = bounds.low.inf(&(centre - half - grow));
                bounds.high = bounds.high.sup(&(centre + half + grow));
                *place = frame;
            }
            self.boxes[i] = bounds;
        }
    }

    /// Pairs whose boxes overlap, in the order of the scene's pairs.
    fn sweep(&mut self, scene: &Scene) {
        self.candidates.clear();
        let (boxes, n) = (&self.boxes, self.boxes.len());
        self.order
            .sort_unstable_by(|i, j| boxes[*i as usize].low.x.total_cmp(&boxes[*j as usize].low.x).then(i.cmp(j)));
        for (at, &i) in self.order.iter().enumerate() {
            let own = &boxes[i as usize];
            for &j in &self.order[at + 1..] {
                let other = &boxes[j as usize];
                if other.low.x > own.high.x {
                    break;
                }
                // Said this way round, a pose that is not a number touches nothing.
                let near = own.low.x <= other.high.x
                    && own.low.y <= other.high.y
                    && other.low.y <= own.high.y
                    && own.low.z <= other.high.z
                    && other.low.z <= own.high.z;
                let pair = scene.pair_of[(i.min(j) as usize) * n + i.max(j) as usize];
                if near && pair != NONE {
                    self.candidates.push(pair);
                }
            }
        }
        self.candidates.sort_unstable();
    }

    fn find(&mut self, scene: &Scene, [a, b]: [usize; 2], margin: f64) {
        self.raw.clear();
        let (parts_a, parts_b) = (&scene.parts[a], &scene.parts[b]);
        let (first_a, first_b) = (self.first_frame[a], self.first_frame[b]);
        for (i, a) in parts_a.iter().enumerate() {
            let frame_a = self.frames[first_a + i];
            for (j, b) in parts_b.iter().enumerate() {
                if is_bed(a) || is_bed(b) {
                    continue;
                }
                let frame_b = self.frames[first_b + j];
                let start = self.raw.len();
                self.find_parts((a, &frame_a), (b, &frame_b), margin);
                self.raw[start..].iter_mut().for_each(|p| p.feature = mix(p.feature, i as u32, j as u32));
            }
        }
    }

    fn find_parts(&mut self, (a, frame_a): (&Part, &Frame), (b, frame_b): (&Part, &Frame), margin: f64) {
        let one = match (&a.solid, &b.solid) {
            (Solid::Ball(ra), Solid::Ball(rb)) => ball_ball(&frame_a.pos, *ra, &frame_b.pos, *rb),
            (Solid::HalfSpace(_), Solid::Ball(r)) => plane_ball(frame_a, &frame_b.pos, *r),
            (Solid::Ball(r), Solid::HalfSpace(_)) => swapped(&plane_ball(frame_b, &frame_a.pos, *r)),
            (Solid::Primitive(a, _), Solid::Ball(r)) => convex_ball(a, frame_a, &frame_b.pos, *r),
            (Solid::Ball(r), Solid::Primitive(b, _)) => swapped(&convex_ball(b, frame_b, &frame_a.pos, *r)),
            (Solid::HalfSpace(_), Solid::Primitive(b, _)) => {
                return self.find_on_plane(frame_a, (b, frame_b), margin);
            }
            (Solid::Primitive(a, _), Solid::HalfSpace(_)) => {
                let start = self.raw.len();
                self.find_on_plane(frame_b, (a, frame_a), margin);
                return self.raw[start..].iter_mut().for_each(|p| *p = swapped(p));
            }
            (Solid::Primitive(pa, _), Solid::Primitive(pb, _)) => {
                if !self.primitives.add_points((pa, frame_a), (pb, frame_b), margin, &mut self.raw) {
                    self.ask_parry((a, frame_a), (b, frame_b), margin);
                }
                return;
            }
            // Two half-spaces never touch; beds have a way of their own.
            (Solid::HalfSpace(_), Solid::HalfSpace(_)) | (Solid::Bed(_), _) | (_, Solid::Bed(_)) => return,
            (Solid::Other(..), _) | (_, Solid::Other(..)) => {
                return self.facets.add_points((a, frame_a), (b, frame_b), margin, &mut self.raw);
            }
            (Solid::Docking(..), _) | (_, Solid::Docking(..)) => {
                if let (Some(a), Some(b)) = (Body::of(&a.solid, frame_a), Body::of(&b.solid, frame_b)) {
                    self.docking.add_points(&a, &b, margin, &mut self.raw);
                }
                return;
            }
        };
        if one.gap < margin {
            self.raw.push(one);
        }
    }

    fn find_on_plane(&mut self, plane: &Frame, (convex, frame): (&Convex, &Frame), margin: f64) {
        match &convex.core {
            Core::Cuboid { half } => plane_cuboid(plane, frame, half, margin, &mut self.raw),
            _ => self.primitives.add_plane_points(plane, (convex, frame), margin, &mut self.raw),
        }
    }

    /// The nearest or deepest point of two primitives, where axes do not say.
    fn ask_parry(&mut self, (a, frame_a): (&Part, &Frame), (b, frame_b): (&Part, &Frame), margin: f64) {
        let (Some(twin_a), Some(twin_b)) = (twin_of(&a.solid), twin_of(&b.solid)) else { return };
        let turned = |frame: &Frame, twin: &Twin| Frame { rot: frame.rot * twin.turn, pos: frame.pos };
        let (frame_a, frame_b) = (turned(frame_a, twin_a), turned(frame_b, twin_b));
        add_nearest((&*twin_a.shape, &frame_a), (&*twin_b.shape, &frame_b), margin, &mut self.raw);
    }
}

fn twin_of(solid: &Solid) -> Option<&Twin> {
    match solid {
        Solid::Ball(_) | Solid::Bed(_) => None,
        Solid::Primitive(_, twin) | Solid::HalfSpace(twin) | Solid::Other(twin, _) | Solid::Docking(_, twin, _) => {
            Some(twin)
        }
    }
}
