//! What a leader bears of its followers' limits, damping and friction.
//!
//! A follower moves as q_f = r q + o, so a torque τ_f on it is r τ_f on the coordinate that both share (power is the
//! same on either side). With its own damping b_f, dry friction c_f, range and largest speed:
//!
//!   −b_f q̇_f        ↦  −r² b_f q̇            damping adds with the square of the ratio
//!   −c_f sign q̇_f   ↦  −|r| c_f sign q̇      friction levels add with its size
//!   l ≤ q_f ≤ u      ↦  (l − o)/r ≤ q ≤ (u − o)/r, turned round where r < 0
//!   |q̇_f| ≤ v_f     ↦  |q̇| ≤ v_f/|r|
//!
//! and the coordinate's range and speed are the narrowest. A follower's effort limit is that of a motor which it has
//! not: the leader's motor drives both. A follower of ratio zero does not move; its range must hold its offset.

use crate::{Joint, Tree};

/// A joint whose range leaves its leader no position.
#[derive(Clone, Debug, PartialEq)]
pub struct EmptyRange {
    /// The leader's name.
    pub leader: String,
    /// The leader's own range, rad or m.
    pub own: [f64; 2],
    /// The follower's name.
    pub follower: String,
    /// Where the follower allows the leader to be, rad or m.
    pub allowed: [f64; 2],
}

/// The range of the leader in which its follower stays within its own; none where it has no limits.
fn calc_leader_range(follower: &Joint) -> Option<[f64; 2]> {
    let [lower, upper] = follower.position_limits?;
    let (ratio, offset) = (follower.multiplier, follower.offset);
    if ratio == 0.0 {
        let is_within = (lower..=upper).contains(&offset);
        return Some(if is_within { [f64::NEG_INFINITY, f64::INFINITY] } else { [f64::INFINITY, f64::NEG_INFINITY] });
    }
    let ends = [(lower - offset) / ratio, (upper - offset) / ratio];
    Some(if ratio > 0.0 { ends } else { [ends[1], ends[0]] })
}

fn narrowed([lower, upper]: [f64; 2], [low, high]: [f64; 2]) -> [f64; 2] {
    [lower.max(low), upper.min(high)]
}

/// Narrowest of a leader's range and another that is no wider than nothing; none where neither ends.
fn joined(own: Option<[f64; 2]>, other: [f64; 2]) -> Option<[f64; 2]> {
    let range = narrowed(own.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]), other);
    range.iter().any(|end| end.is_finite()).then_some(range)
}

impl Tree {
    /// Lays what followers bring on the joints that they follow; where no position serves both, the leader's range stays.
    pub(crate) fn load_leaders(&mut self) {
        for f in 0..self.joints.len() {
            let follower = self.joints[f].clone();
            let Some(leader) = self.leader_of(&follower) else { continue };
            let (ratio, leader) = (follower.multiplier, &mut self.joints[leader]);
            leader.damping += ratio * ratio * follower.damping;
            leader.friction += ratio.abs() * follower.friction;
            if ratio != 0.0 && follower.velocity_limit > 0.0 {
                let bound = follower.velocity_limit / ratio.abs();
                leader.velocity_limit =
                    if leader.velocity_limit > 0.0 { leader.velocity_limit.min(bound) } else { bound };
            }
            if let Some(allowed) = calc_leader_range(&follower)
                && find_clash(leader, allowed).is_none()
            {
                leader.position_limits = joined(leader.position_limits, allowed);
            }
        }
    }

    /// A follower whose range leaves its leader no position.
    pub fn find_empty_range(&self) -> Option<EmptyRange> {
        self.joints.iter().find_map(|follower| {
            let leader = &self.joints[self.leader_of(follower)?];
            let allowed = calc_leader_range(follower)?;
            let own = find_clash(leader, allowed)?;
            Some(EmptyRange { leader: leader.name.clone(), own, follower: follower.name.clone(), allowed })
        })
    }

    /// Index of the joint that another follows.
    fn leader_of(&self, follower: &Joint) -> Option<usize> {
        let is_leader = |j: &Joint| !j.is_mimic && j.width == 1 && j.v_index == follower.v_index;
        if follower.is_mimic { self.joints.iter().position(is_leader) } else { None }
    }
}

/// The leader's range, if another leaves nothing of it.
fn find_clash(leader: &Joint, allowed: [f64; 2]) -> Option<[f64; 2]> {
    let own = leader.position_limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let [lower, upper] = narrowed(own, allowed);
    (lower > upper).then_some(own)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Inertial, JointDescription, JointKind, LinkDescription, Mimic, RobotDescription};
    use spatial::{Mat3, Pose, Vec3};

    /// A leader within ±1, and a follower with a ratio, an offset and a range; damping 0.3 and 0.2, friction 0.5 and 0.4.
    fn pair(ratio: f64, offset: f64, range: [f64; 2]) -> Tree {
        let link = |name: &str| LinkDescription {
            name: name.to_owned(),
            inertial: Some(Inertial { mass: 1.0, com: Vec3::zeros(), tensor_com: Mat3::identity() }),
            visuals: Vec::new(),
            collisions: Vec::new(),
        };
        let joint = |name: &str, limits, damping, friction, mimic| JointDescription {
            name: name.to_owned(),
            kind: JointKind::Revolute,
            parent: 0,
            pose_pj: Pose::identity(),
            axis: Vec3::z(),
            position_limits: Some(limits),
            effort_limit: 10.0,
            velocity_limit: 2.0,
            damping,
            friction,
            mimic,
        };
        let follows = Some(Mimic { joint: 0, multiplier: ratio, offset });
        let joints = vec![joint("lead", [-1.0, 1.0], 0.3, 0.5, None), joint("follow", range, 0.2, 0.4, follows)];
        let links = ["base", "a", "b"].map(link).into();
        Tree::from_description(&RobotDescription { name: "t".to_owned(), file: "t.urdf".into(), links, joints })
    }

    #[test]
    fn leader_bears_damping_with_the_square_of_the_ratio_and_friction_with_its_size() {
        let leader = &pair(-2.5, 0.0, [-9.0, 9.0]).joints[0];
        assert_eq!(leader.damping, 0.3 + 6.25 * 0.2);
        assert_eq!(leader.friction, 0.5 + 2.5 * 0.4);
        assert_eq!(leader.velocity_limit, 0.8);
        assert_eq!(leader.position_limits, Some([-1.0, 1.0]), "a wider range narrows nothing");
    }

    #[test]
    fn the_narrower_end_holds_on_either_side_whatever_the_sign_of_the_ratio() {
        assert_eq!(pair(2.0, 0.0, [-1.0, 4.0]).joints[0].position_limits, Some([-0.5, 1.0]));
        assert_eq!(pair(-2.0, 0.0, [-1.0, 4.0]).joints[0].position_limits, Some([-1.0, 0.5]));
        assert_eq!(pair(-2.0, 0.5, [-0.5, 0.5]).joints[0].position_limits, Some([0.0, 0.5]));
    }

    #[test]
    fn a_range_that_serves_nobody_is_told() {
        let clash = pair(1.0, 0.0, [2.0, 3.0]).find_empty_range().expect("2 … 3 is outside ±1");
        assert_eq!((clash.leader.as_str(), clash.follower.as_str(), clash.allowed), ("lead", "follow", [2.0, 3.0]));
        assert!(pair(0.0, 5.0, [2.0, 3.0]).find_empty_range().is_some(), "it stands still outside its range");
        assert!(pair(0.0, 2.5, [2.0, 3.0]).find_empty_range().is_none());
        assert!(pair(-2.0, 0.5, [-0.5, 0.5]).find_empty_range().is_none());
    }
}
