//! Whether the masses belong to rigid bodies, and what is assumed where they do not.
//!
//! Links that fixed joints hold together are one *body*, and only its composite inertia is ever simulated; what it takes is
//! a mass matrix that is positive definite. So a tensor that is impossible by itself (zero, or with a negative moment) is
//! simulated as written where what is fixed to it, or moves with it, makes up for it, and refused where the robot,
//! floating free, could move with negative kinetic energy. A violated triangle inequality is always simulated as written:
//! the mass matrix is positive definite with it as well.
//!
//! A massless body between joints is fine, and so is one beyond a joint, until somebody lets it move freely
//! ([`crate::find_singular_freedoms`]).

use super::doubts::UrdfDoubt;
use super::errors::{UrdfProblem, cut};
use super::facts::{Facts, InertialFact, origin_of, tag_in};
use super::findings::Findings;
use super::graph::Graph;
use super::schema::ROBOT;
use crate::singular::has_negative_energy;
use crate::{Freedom, Tree, find_singular_freedoms};
use spatial::{Frame, Inertia, InertiaError};

/// Principal moments below this part of the largest are zero, whatever their sign: files carry the rounding of the CAD
/// program's eigenvectors, 1e-16 of the largest, times some hundred operations.
const NEGLIGIBLE: f64 = 1e-9;
/// A body with a smaller radius of gyration than this is a point, m: the smallest that is built is a thousand times larger.
const POINT_M: f64 = 1e-6;

/// Mass and tensor of each link alone.
pub(crate) fn check_inertias(facts: &Facts<'_, '_>, findings: &mut Findings<'_>) {
    for link in &facts.links {
        let Some(inertial) = &link.inertial else { continue };
        if inertial.mass < 0.0 {
            let fault = InertiaError::Mass(inertial.mass).to_string();
            findings.add(inertial.offset, link.subject(), UrdfProblem::Inertia(fault));
        } else if inertial.mass == 0.0 && !inertial.is_nothing() {
            findings.doubt(inertial.offset, link.subject(), UrdfDoubt::NoMass);
        }
        if let (Some(fault), false) = (triangle_fault(inertial), is_indefinite(inertial)) {
            findings.doubt(inertial.offset, link.subject(), UrdfDoubt::NotRigid(fault));
        }
    }
}

/// What violates the triangle inequality; a diagonal tensor is spoken of by the names of the file, others by their
/// principal moments.
fn triangle_fault(inertial: &InertialFact) -> Option<String> {
    let t = &inertial.tensor;
    // The mass plays no part in it.
    let error = Inertia::check_triangle(t).err()?;
    if t[(0, 1)] != 0.0 || t[(0, 2)] != 0.0 || t[(1, 2)] != 0.0 {
        return Some(error.to_string());
    }
    let largest = t.diagonal().imax();
    let (a, b) = ((largest + 1) % 3, (largest + 2) % 3);
    let (a, b) = (a.min(b), a.max(b));
    let name = |i: usize| ["Ixx", "Iyy", "Izz"][i];
    let (ta, tb, tc) = (t[(a, a)], t[(b, b)], t[(largest, largest)]);
    Some(format!("inertia violates {} + {} ≥ {} ({ta} + {tb} < {tc})", name(a), name(b), name(largest)))
}

fn is_indefinite(inertial: &InertialFact) -> bool {
    let [least, .., largest] = moments(&inertial.tensor);
    least < -NEGLIGIBLE * largest.abs() - POINT_M * POINT_M * inertial.mass.abs()
}

/// Principal moments, ascending.
fn moments(tensor: &spatial::Mat3) -> [f64; 3] {
    let mut moments: [f64; 3] = tensor.symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    moments
}

/// The composite of every body: whether it is more than a point.
pub(crate) fn check_bodies(facts: &Facts<'_, '_>, graph: &Graph, findings: &mut Findings<'_>) {
    for body in join_bodies(facts, graph) {
        let inertials = body.links.iter().filter_map(|l| Some((&facts.links[*l], facts.links[*l].inertial.as_ref()?)));
        let Some((link, heaviest)) = inertials.max_by(|(_, a), (_, b)| a.mass.total_cmp(&b.mass)) else { continue };
        let is_point = moments(&body.inertia.tensor_com())[2] <= POINT_M * POINT_M * body.inertia.mass;
        if heaviest.mass > 0.0 && is_point {
            findings.doubt(heaviest.offset, link.subject(), UrdfDoubt::PointMass { mass: heaviest.mass });
        }
    }
}

/// Tensors with a negative moment: wrong where the robot could move with negative energy, doubtful where all that moves
/// with them makes up for it.
pub(crate) fn check_energy(tree: &Tree, facts: &Facts<'_, '_>, findings: &mut Findings<'_>) {
    let suspects = facts.links.iter().filter_map(|link| Some((link, link.inertial.as_ref()?)));
    let suspects: Vec<_> = suspects.filter(|(_, inertial)| is_indefinite(inertial)).collect();
    let is_wrong = !suspects.is_empty() && has_negative_energy(tree);
    for (link, inertial) in suspects {
        let fault = InertiaError::NotPositive(moments(&inertial.tensor)).to_string();
        if is_wrong {
            findings.add(inertial.offset, link.subject(), UrdfProblem::Inertia(fault));
        } else {
            findings.doubt(inertial.offset, link.subject(), UrdfDoubt::NotAlone(fault));
        }
    }
}

/// Links that are fixed to each other.
#[derive(Default)]
struct Body {
    links: Vec<usize>,
    /// About the origin of the first link, in its axes.
    inertia: Inertia,
}

/// Bodies in the order of the tree, the root's first; their links likewise.
fn join_bodies(facts: &Facts<'_, '_>, graph: &Graph) -> Vec<Body> {
    let mut bodies: Vec<Body> = Vec::new();
    let mut place = vec![(0, Frame::identity()); facts.links.len()];
    let joint_tag = tag_in(&ROBOT, "joint");
    for &link in &graph.order {
        let fixed_to = graph.carried_by[link].filter(|(joint, _)| facts.joints[*joint].kind == "fixed");
        place[link] = match fixed_to {
            Some((joint, parent)) => {
                let pose = joint_tag.and_then(|tag| origin_of(facts.joints[joint].node, tag)).unwrap_or_default();
                (place[parent].0, &place[parent].1 * &Frame::from(&pose))
            }
            None => {
                bodies.push(Body::default());
                (bodies.len() - 1, Frame::identity())
            }
        };
        let (body, frame) = &place[link];
        bodies[*body].links.push(link);
        if let Some(inertial) = &facts.links[link].inertial {
            bodies[*body].inertia += inertial.inertia().transformed(&frame.rot, &frame.pos);
        }
    }
    bodies
}

/// Joints that nothing resists: they load, but cannot be simulated as they are.
pub(crate) fn check_freedoms(tree: &Tree, facts: &Facts<'_, '_>, graph: &Graph, findings: &mut Findings<'_>) {
    for freedom in find_singular_freedoms(tree, [false; 6]) {
        let Freedom::Joint(j) = freedom else { continue };
        let Some(index) = facts.joint_index.get(tree.joints[j].name.as_str()).copied() else { continue };
        let child = graph.order.iter().find(|l| graph.carried_by[**l].is_some_and(|(joint, _)| joint == index));
        let link = child.map(|l| cut(facts.links[*l].name)).unwrap_or_default();
        let is_light = carries_nothing(tree, j);
        let doubt = if is_light { UrdfDoubt::MovesNoMass { link } } else { UrdfDoubt::MovesNoInertia { link } };
        findings.doubt(facts.joints[index].offset(), facts.joints[index].subject(), doubt);
    }
}

/// Whether neither the joint's body nor any beyond it has mass or inertia.
fn carries_nothing(tree: &Tree, joint: usize) -> bool {
    let mut is_beyond = vec![false; tree.bodies.len()];
    is_beyond[joint + 1] = true;
    (joint + 1..tree.bodies.len()).all(|b| {
        is_beyond[b] |= is_beyond[tree.bodies[b].parent];
        !is_beyond[b] || tree.bodies[b].inertia == Inertia::default()
    })
}
