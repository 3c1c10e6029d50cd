//! The points of a pair of which at least one is a docking shape.
//!
//! Candidates, in this order: points of each body (a ball's centre, a capsule's ends, corners) against the other as a
//! whole; then the local minima along each body's curves (rims, edges, axes) against the other as a whole; last those of
//! two curved sides. Each is exact, and there are more than needed: as a capsule slides out of a bore, its end, its side
//! and the rim come to mean one place.
//!
//! So that nothing jumps there, what an earlier candidate already holds is taken off a later one nearby:
//!
//!   δᵢ ← δᵢ − Σ κ(|xᵢ − xⱼ| / D) max(0, nᵢ·nⱼ) δⱼ,   κ(t) = (1 − t⁴)² for t < 1
//!
//! D: the sum of the rounding radii. Two that coincide count once, and a point that comes off an end comes off with
//! nothing. Against the points and curves of its own body, a minimum along a curve with ends or on a side counts by how
//! much it is deeper than those instead, so that what lies flush is held at its corners and not at a place of chance.
//! Everywhere else, and wherever nothing touches, gaps are those of the surfaces, to round-off.

use super::arc::{Curve, Minimum, Path, Scan};
use super::body::{Body, Kind};
use super::face::Face;
use super::seat::{ROUND, Seat};
use super::sheet::{Near, unit};
use crate::analytic::{Raw, swapped};
use spatial::{Frame, Vec3};
use std::f64::consts::{PI, TAU};

/// Share of a candidate beyond which it is another one seen again.
const SAME: f64 = 1.0 - 1e-9;
/// Numbers of secondary minima start here; sixteen to a curve.
const SECONDARY: u32 = 16;
const BINS: f64 = 16.0;

/// What a candidate comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Point,
    Curve,
    Face,
}

/// A candidate, in the leading body's frame.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    source: u32,
    label: u32,
    rank: Rank,
    owner_leads: bool,
    /// Midway between the two surfaces.
    middle: Vec3,
    /// From the leading body to the other.
    normal: Vec3,
    gap: f64,
}

/// Scratch of a pair.
#[derive(Debug, Default)]
pub(crate) struct DockingBuffer {
    found: Vec<Candidate>,
}

impl Candidate {
    /// Whether it may see the same as an earlier one. Places of one seat differ; what stands out from its own body's
    /// points and curves has been measured against them.
    fn shares_with(&self, earlier: &Self) -> bool {
        if self.source == earlier.source {
            return self.label >= SECONDARY && earlier.label >= SECONDARY;
        }
        self.owner_leads != earlier.owner_leads || self.rank == earlier.rank
    }
}

/// Who owns a curve or point, and what it is held against.
struct Question<'a> {
    owner_leads: bool,
    owner_radius: f64,
    target: &'a Body<'a>,
    source: u32,
    rank: Rank,
    margin: f64,
}

impl Question<'_> {
    fn radii(&self) -> f64 {
        self.owner_radius + self.target.radius
    }

    fn candidate(&self, at: &Vec3, near: &Near, label: u32) -> Candidate {
        let gap = near.distance - self.radii();
        let toward = if self.owner_leads { -near.normal } else { near.normal };
        let middle = at - (self.owner_radius + 0.5 * gap) * near.normal;
        Candidate {
            source: self.source,
            label,
            rank: self.rank,
            owner_leads: self.owner_leads,
            middle,
            normal: toward,
            gap,
        }
    }
}

impl DockingBuffer {
    /// Adds the points of A and B, both in W, nearer than `margin`; at least one of them is a sheet.
    pub(crate) fn add_points(&mut self, a: &Body<'_>, b: &Body<'_>, margin: f64, out: &mut Vec<Raw>) {
        let a_leads = match (&a.kind, &b.kind) {
            (Kind::Sheet(a), Kind::Sheet(b)) => a.leads(b),
            (kind, _) => matches!(kind, Kind::Sheet(_)),
        };
        let (lead, other) = if a_leads { (a, b) } else { (b, a) };
        let (frame, relative) = (lead.frame, lead.frame_of(other));
        self.found.clear();
        self.collect(&Body { frame: Frame::identity(), ..*lead }, &Body { frame: relative, ..*other }, margin);
        self.share(lead.scale() + other.scale());
        out.extend(self.found.iter().map(|c| {
            let raw = Raw {
                feature: u64::from(c.source) << 32 | u64::from(c.label),
                point_a: frame.point(&(c.middle - 0.5 * c.gap * c.normal)),
                normal: frame.rot * c.normal,
                gap: c.gap,
            };
            if a_leads { raw } else { swapped(&raw) }
        }));
    }

    fn collect(&mut self, lead: &Body<'_>, other: &Body<'_>, margin: f64) {
        if matches!(other.kind, Kind::Point) {
            return self.add_body_points((other, lead, false), 0, margin);
        }
        // A ring is its circle: nothing of the other adds to what that finds.
        if lead.is_ring() {
            return self.add_body_curves((lead, other, true), 16, margin);
        }
        if other.is_ring() {
            return self.add_body_curves((other, lead, false), 32, margin);
        }
        self.add_body_points((other, lead, false), 0, margin);
        self.add_body_points((lead, other, true), 8, margin);
        self.add_body_curves((lead, other, true), 16, margin);
        self.add_body_curves((other, lead, false), 32, margin);
        self.add_faces(lead, other, margin);
    }

    /// Where the curved sides of two sheets bulge towards each other.
    fn add_faces(&mut self, lead: &Body<'_>, other: &Body<'_>, margin: f64) {
        let (Some(face), Some(_)) = (Face::of(lead), Face::of(other)) else { return };
        let question = Question {
            owner_leads: true,
            owner_radius: lead.radius,
            target: other,
            source: 48,
            rank: Rank::Face,
            margin,
        };
        let scan = face.scan(other, margin + question.radii());
        for minimum in scan.minima() {
            let spot = face.spot(other, minimum.u);
            let label = (BINS * (minimum.u / TAU).rem_euclid(1.0)) as u32;
            let mut candidate = question.candidate(&spot.point, &spot.near, label);
            if candidate.gap < 0.0 {
                let beyond_edges = if face.extent().3 { f64::INFINITY } else { scan.ends - spot.near.distance };
                candidate.gap = candidate.gap.max(-spot.prominence.min(beyond_edges));
            }
            if face.is_flat_at(&spot) && candidate.gap != 0.0 {
                self.push(candidate, margin);
            }
        }
    }

    fn add_body_points(&mut self, (owner, target, owner_leads): (&Body<'_>, &Body<'_>, bool), first: u32, margin: f64) {
        let (points, count) = owner.points();
        for (source, p) in (first..).zip(&points[..count]) {
            let question =
                Question { owner_leads, owner_radius: owner.radius, target, source, rank: Rank::Point, margin };
            self.add_point(p, &question);
        }
    }

    fn add_body_curves(&mut self, (owner, target, owner_leads): (&Body<'_>, &Body<'_>, bool), first: u32, margin: f64) {
        for i in 0.. {
            let Some((curve, owner_radius)) = owner.curve(i) else { return };
            let question =
                Question { owner_leads, owner_radius, target, source: first + i as u32, rank: Rank::Curve, margin };
            match curve {
                Some(curve) if curve.is_closed() => self.add_circle(&curve, &question),
                Some(curve) => self.add_open(&curve, &question),
                None => {}
            }
        }
    }

    /// A ball's centre, or the like: the nearest place, and those round the axis where it may be seated.
    fn add_point(&mut self, p: &Vec3, question: &Question<'_>) {
        let near = question.target.nearest(p);
        let Some(sheet) = question.target.seat() else {
            return self.push(question.candidate(p, &near, 0), question.margin);
        };
        let frame = &question.target.frame;
        let local = frame.inverse_point(p);
        let (cos, sin) = unit(local.x, local.y);
        let gap = |near: &Near| near.distance - question.radii();
        let far = gap(&sheet.nearest_on_meridian(&local, -cos, -sin));
        let seat = Seat::new(sin.atan2(cos), gap(&near), far);
        for k in 0..ROUND {
            let at = if k == 0 && seat.follows() {
                near
            } else {
                let (s, c) = seat.angle(k).sin_cos();
                let at = sheet.nearest_on_meridian(&local, c, s);
                Near { normal: frame.rot * at.normal, ..at }
            };
            self.push(question.candidate(p, &at, seat.label(k)), question.margin);
        }
    }

    /// The minima along a curve with ends, by how much they are deeper than those.
    fn add_open(&mut self, curve: &Curve, question: &Question<'_>) {
        let scan = curve.scan(question.target, question.margin + question.radii());
        for minimum in scan.minima() {
            let label =
                if scan.minima().len() == 1 { 0 } else { SECONDARY + (BINS * minimum.u.rem_euclid(1.0)) as u32 };
            let mut candidate = question.candidate(&curve.point(minimum.u), &minimum.near, label);
            if candidate.gap < 0.0 {
                candidate.gap = candidate.gap.max(minimum.near.distance - scan.ends);
            }
            if candidate.gap != 0.0 {
                self.push(candidate, question.margin);
            }
        }
    }

    /// All minima round a closed curve, and the places of a seat that hold none.
    fn add_circle(&mut self, curve: &Curve, question: &Question<'_>) {
        let scan = curve.scan(question.target, question.margin + question.radii());
        let leader = leader_of(&scan);
        let gap = |distance: f64| distance - question.radii();
        if gap(leader.near.distance) >= question.margin {
            return;
        }
        let seat = Seat::new(leader.u, gap(leader.near.distance), gap(scan.far));
        let mut taken = [false; ROUND];
        if seat.follows() {
            let touching = scan.minima().iter().filter(|m| gap(m.near.distance) < 0.0).count();
            let lone = [leader];
            let minima = if scan.minima().is_empty() { &lone[..] } else { scan.minima() };
            for minimum in minima {
                taken[seat.bin(minimum.u)] = true;
                let alone = touching < 2 && minimum.u == leader.u;
                let bin = (BINS * (minimum.u / TAU).rem_euclid(1.0)) as u32;
                let label = if alone { 0 } else { SECONDARY + bin };
                self.push(question.candidate(&curve.point(minimum.u), &minimum.near, label), question.margin);
            }
        }
        for k in (0..ROUND).filter(|k| !taken[*k]) {
            let p = curve.point(seat.angle(k));
            self.push(question.candidate(&p, &question.target.nearest(&p), seat.label(k)), question.margin);
        }
    }

    /// Keeps a candidate within the margin, under a number of its own.
    fn push(&mut self, mut candidate: Candidate, margin: f64) {
        if candidate.gap < margin {
            let name = |c: &Candidate| (c.source, c.label);
            while self.found.iter().any(|other| name(other) == name(&candidate)) {
                candidate.label += BINS as u32;
            }
            self.found.push(candidate);
        }
    }

    /// Takes off each candidate what earlier ones nearby already hold.
    fn share(&mut self, reach: f64) {
        let mut kept = 0;
        for i in 0..self.found.len() {
            let mut own = self.found[i];
            let mut same = 0.0_f64;
            let mut held = 0.0;
            for other in self.found[..kept].iter().filter(|other| own.shares_with(other)) {
                let share = coincidence(&own, other, reach);
                same = same.max(share);
                held += share * (-other.gap).max(0.0);
            }
            if own.gap < 0.0 && held > 0.0 {
                own.gap = (own.gap + held).min(0.0);
            }
            if same < SAME && (own.gap != 0.0 || held == 0.0) {
                self.found[kept] = own;
                kept += 1;
            }
        }
        self.found.truncate(kept);
    }
}

/// How much two candidates are one: 1 in the same place with the same normal, 0 further apart than `reach`.
fn coincidence(a: &Candidate, b: &Candidate, reach: f64) -> f64 {
    let t2 = (a.middle - b.middle).norm_squared() / (reach * reach);
    if t2 >= 1.0 { 0.0 } else { (1.0 - t2 * t2).powi(2) * a.normal.dot(&b.normal).max(0.0) }
}

/// The deepest place round a curve: the deepest minimum, or of a curve without any the deepest sample.
fn leader_of(scan: &Scan) -> Minimum {
    let deepest = scan.minima().iter().min_by(|a, b| a.near.distance.total_cmp(&b.near.distance));
    match deepest {
        Some(minimum) => *minimum,
        None => Minimum { u: scan.nearest.u.rem_euclid(2.0 * PI), ..scan.nearest },
    }
}
