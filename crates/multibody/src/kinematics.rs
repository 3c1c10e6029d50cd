//! Positions, screws, velocities and Jacobians.
//!
//! Everything is in W axes about the vehicle's *anchor*, the base origin at this instant taken as a point fixed in W:
//! no transforms between links, and no cancellation far from the world's origin.
//!
//!   V_i = V_B + Σ_path S_k v_k          twist of body i about the anchor
//!   x_i − x_anchor = `pos[i]`           of body i's origin

use crate::Tree;
use spatial::{Frame, Inertia, Mat3, Pose, Twist, Vec3};

/// Where the bodies of one vehicle are and how they move; sized once from its tree.
#[derive(Clone, Debug)]
pub struct Kinematics {
    /// The anchor in W, m.
    pub anchor: Vec3,
    /// Body axes in W.
    pub rot: Vec<Mat3>,
    /// Body origins from the anchor, W axes, m.
    pub pos: Vec<Vec3>,
    /// Joint screws, W axes, about the anchor.
    pub screws: Vec<Twist>,
    /// Body inertias, W axes, about the anchor.
    pub inertia: Vec<Inertia>,
    /// Body twists, W axes, about the anchor.
    pub vel: Vec<Twist>,
    /// Whether a joint frame has its parent's axes, as most in files do.
    is_straight: Vec<bool>,
}

impl Kinematics {
    /// Room for one vehicle.
    pub fn new(tree: &Tree) -> Self {
        let n = tree.bodies.len();
        Self {
            anchor: Vec3::zeros(),
            rot: vec![Mat3::identity(); n],
            pos: vec![Vec3::zeros(); n],
            screws: vec![Twist::default(); tree.n_columns()],
            inertia: vec![Inertia::default(); n],
            vel: vec![Twist::default(); n],
            is_straight: tree.joints.iter().map(|j| j.frame_pj.rot == Mat3::identity()).collect(),
        }
    }

    /// Frames, screws and inertias at the base pose and the joint coordinates.
    pub fn update_positions(&mut self, tree: &Tree, pose_wb: &Pose, q: &[f64]) {
        self.anchor = pose_wb.translation.vector;
        self.rot[0] = *pose_wb.rotation.to_rotation_matrix().matrix();
        self.inertia[0] = tree.bodies[0].inertia.transformed(&self.rot[0], &Vec3::zeros());
        for (j, joint) in tree.joints.iter().enumerate() {
            let (body, parent) = (j + 1, tree.bodies[j + 1].parent);
            let mut frame_wj = Frame { rot: self.rot[parent], pos: self.pos[parent] };
            frame_wj.pos = frame_wj.point(&joint.frame_pj.pos);
            if !self.is_straight[j] {
                frame_wj.rot *= joint.frame_pj.rot;
            }
            let frame_wc = joint.place_child(&frame_wj, q);
            (self.rot[body], self.pos[body]) = (frame_wc.rot, frame_wc.pos);
            joint.write_screws(&frame_wc.rot, &frame_wc.pos, &mut self.screws[joint.column..]);
            self.inertia[body] = tree.bodies[body].inertia.transformed(&frame_wc.rot, &frame_wc.pos);
        }
    }

    /// Twists of all bodies from the base twist (about the anchor) and the joint rates.
    pub fn update_velocities(&mut self, tree: &Tree, base: &Twist, v: &[f64]) {
        self.vel[0] = *base;
        for (j, joint) in tree.joints.iter().enumerate() {
            let mut twist = self.vel[tree.bodies[j + 1].parent];
            for k in 0..joint.width {
                twist += self.screws[joint.column + k] * v[joint.v_index + k];
            }
            self.vel[j + 1] = twist;
        }
    }

    /// Frame of a body in W.
    pub fn frame(&self, body: usize) -> Frame {
        Frame { rot: self.rot[body], pos: self.anchor + self.pos[body] }
    }

    /// Frame of a link in W.
    pub fn link_frame(&self, tree: &Tree, link: usize) -> Frame {
        &self.frame(tree.links[link].body) * &tree.links[link].frame_bl
    }

    /// Twist of a link about its own origin, W axes.
    pub fn link_twist(&self, tree: &Tree, link: usize) -> Twist {
        let link = &tree.links[link];
        let r = self.pos[link.body] + self.rot[link.body] * link.frame_bl.pos;
        self.vel[link.body].about(&r)
    }

    /// Jacobian of the point of `body` at `p_w` (W, m): its twist about that point is J (V_B, v).
    ///
    /// Columns: the base's angular and linear parts (W axes, at the base origin), then the joint coordinates.
    /// `columns` has 6 + nv entries and is overwritten.
    pub fn calc_jacobian(&self, tree: &Tree, body: usize, p_w: &Vec3, columns: &mut [Twist]) {
        let r = p_w - self.anchor;
        columns.fill(Twist::default());
        for k in 0..3 {
            columns[k] = Twist::new(unit(k), unit(k).cross(&r));
            columns[3 + k] = Twist::new(Vec3::zeros(), unit(k));
        }
        self.for_each_column(tree, body, |_, screw, v_index| columns[6 + v_index] += screw.about(&r));
    }

    /// Time derivative of [`Kinematics::calc_jacobian`] for a point fixed in `body`:
    /// (α, classical acceleration) = J (α_B, a_B, v̇) + J̇ (V_B, v), a_B the classical acceleration of the base origin.
    pub fn calc_jacobian_rate(&self, tree: &Tree, body: usize, p_w: &Vec3, columns: &mut [Twist]) {
        let r = p_w - self.anchor;
        let (vel_p, vel_b) = (self.vel[body].at(&r), self.vel[0].lin);
        columns.fill(Twist::default());
        for (k, column) in columns.iter_mut().take(3).enumerate() {
            column.lin = unit(k).cross(&(vel_p - vel_b));
        }
        self.for_each_column(tree, body, |child, screw, v_index| {
            // A screw is fixed in its child; with the parent's twist J̇ v would be the same, but not J̇ of a floating joint.
            let rate = self.vel[child].cross_motion(screw);
            columns[6 + v_index] += Twist::new(rate.ang, rate.at(&r) + screw.ang.cross(&vel_p));
        });
    }

    /// Visits the screws that move `body`, from the tip to the base: (child body, screw, index into v).
    fn for_each_column(&self, tree: &Tree, body: usize, mut visit: impl FnMut(usize, &Twist, usize)) {
        let mut at = body;
        while at != 0 {
            let joint = &tree.joints[at - 1];
            for k in 0..joint.width {
                visit(at, &self.screws[joint.column + k], joint.v_index + k);
            }
            at = tree.bodies[at].parent;
        }
    }
}

fn unit(k: usize) -> Vec3 {
    Vec3::ith(k, 1.0)
}
