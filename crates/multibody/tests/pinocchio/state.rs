//! The random states, drawn by name as tests/pinocchio/reference.py draws them.

use crate::fixture::{BASE, Model};
use crate::stream::Stream;
use multibody::{Joint, JointKind, Tree};
use spatial::nalgebra::{Quaternion, UnitQuaternion};
use spatial::{Pose, Rot, Vec3};
use std::f64::consts::PI;

/// One state's streams, and the order in which this library holds the freedoms.
pub struct Draw<'a> {
    key: String,
    model: &'a Model,
    tree: &'a Tree,
}

impl<'a> Draw<'a> {
    pub fn new(model: &'a Model, tree: &'a Tree, state: usize) -> Self {
        let base = if model.base_free { "free" } else { "fixed" };
        Self { key: format!("{}/{base}/{state}", model.name), model, tree }
    }

    pub fn stream(&self, what: &str, name: &str) -> Stream {
        Stream::new(&format!("{}/{what}/{name}", self.key))
    }

    /// Weights of one quantity of a link, or of the whole.
    pub fn weights(&self, what: &str, name: &str, n: usize) -> Vec<f64> {
        let mut stream = self.stream(what, name);
        (0..n).map(|_| stream.weight()).collect()
    }

    pub fn pose(&self) -> Pose {
        let (pos, rot) = self.floating(BASE);
        Pose::from_parts(pos.into(), rot)
    }

    fn floating(&self, name: &str) -> (Vec3, Rot) {
        let mut s = self.stream("q", name);
        let [x, y, z, i, j, k, w] = std::array::from_fn(|_| s.signed());
        (Vec3::new(x, y, z), UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k)))
    }

    pub fn q(&self) -> Vec<f64> {
        let mut q = self.tree.q_zero.clone();
        for joint in self.tree.joints.iter().filter(|j| !j.is_mimic) {
            self.write_q(joint, &mut q[joint.q_index..]);
        }
        q
    }

    fn write_q(&self, joint: &Joint, q: &mut [f64]) {
        let mut s = self.stream("q", &joint.name);
        match joint.kind {
            JointKind::Revolute => q[0] = PI * s.signed(),
            JointKind::Prismatic => q[0] = 0.5 * s.signed(),
            JointKind::Planar => (q[0], q[1], q[2]) = (s.signed(), s.signed(), PI * s.signed()),
            JointKind::Floating => {
                let (pos, rot) = self.floating(&joint.name);
                q[..3].copy_from_slice(pos.as_slice());
                q[3..7].copy_from_slice(rot.coords.as_slice());
            }
            JointKind::Fixed => unreachable!("a tree holds moving joints only"),
        }
    }

    /// A vector over (base, joints) of `draw`n numbers; a held base stays zero if `hold`.
    fn vector(&self, what: &str, hold: bool, draw: impl Fn(&mut Stream) -> f64) -> Vec<f64> {
        let mut out = vec![0.0; 6 + self.tree.nv];
        if self.model.base_free || !hold {
            let mut s = self.stream(what, BASE);
            out[..6].fill_with(|| draw(&mut s));
        }
        for joint in self.tree.joints.iter().filter(|j| !j.is_mimic) {
            let (mut s, at) = (self.stream(what, &joint.name), 6 + joint.v_index);
            out[at..at + joint.width].fill_with(|| draw(&mut s));
        }
        out
    }

    /// Uniform in [−1, 1).
    pub fn signed(&self, what: &str) -> Vec<f64> {
        self.vector(what, true, Stream::signed)
    }

    /// Weights over all freedoms.
    pub fn freedom_weights(&self, what: &str) -> Vec<f64> {
        self.vector(what, false, Stream::weight)
    }

    /// Typical sizes 2^e of a quantity over (base, joints); one where there is no such freedom.
    pub fn sizes(&self, quantity: &str) -> Vec<f64> {
        let mut out = vec![1.0; 6 + self.tree.nv];
        let mut write = |name: &str, at: usize| {
            for (k, e) in self.model.scales[name][quantity].iter().enumerate() {
                out[at + k] = 2f64.powi(*e);
            }
        };
        if self.model.base_free {
            write(BASE, 0);
        }
        for joint in self.tree.joints.iter().filter(|j| !j.is_mimic) {
            write(&joint.name, 6 + joint.v_index);
        }
        out
    }
}
