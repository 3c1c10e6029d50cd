//! A sound robot with its text spoiled at random, always the same way: an answer in words or a robot whose numbers are
//! finite, never a panic.

use multibody::{LoadedUrdf, SearchPaths, Tree, parse_urdf};
use std::path::Path;

const SOUND: &str = r#"<?xml version="1.0"?>
<robot name="arm" version="1.1">
<material name="red"><color rgba="1 0 0 1"/></material>
<link name="base"><inertial><origin xyz="0 0 0.1" rpy="0 0.1 0"/><mass value="4"/>
<inertia ixx="0.1" ixy="0.01" ixz="0" iyy="0.2" iyz="0" izz="0.15"/></inertial>
<visual><geometry><box size="1 2 3"/></geometry><material name="red"/></visual></link>
<link name="mid"/>
<link name="tip"><inertial><mass value="1"/><inertia ixx="0" iyy="0" izz="0"/></inertial>
<collision><origin xyz="0 0 1"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
<link name="frame"/>
<joint name="yaw" type="revolute"><parent link="base"/><child link="mid"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="5" velocity="1e16"/></joint>
<joint name="pitch" type="continuous"><origin xyz="0.1 0 0.5"/><parent link="mid"/><child link="tip"/><axis xyz="0 1 0"/>
<dynamics damping="0.1"/><mimic joint="yaw" multiplier="-2"/></joint>
<joint name="mount" type="fixed"><parent link="tip"/><child link="frame"/><origin quat_xyzw="0 0 1 1"/></joint>
</robot>"#;

/// What is written over a piece of the text.
const SCRAPS: [&str; 16] = [
    "",
    " ",
    "\"",
    "<",
    ">",
    "/>",
    "0",
    "-1",
    "1e999",
    "nan",
    "1e16",
    "<link name=\"tip\"/>",
    "yaw",
    "fixed",
    "${x}",
    "\u{fffd}",
];

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Draw(u64);

impl Draw {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % n as u64) as usize
    }

    /// One or two pieces written over: values between quotes, or up to eight bytes anywhere.
    fn spoil(&mut self) -> String {
        let mut text = SOUND.to_owned();
        for _ in 0..=self.below(2) {
            let scrap = SCRAPS[self.below(SCRAPS.len())];
            if self.below(4) > 0 {
                let quotes: Vec<usize> = text.match_indices('"').map(|(at, _)| at).collect();
                let value = 2 * self.below(quotes.len() / 2);
                text.replace_range(quotes[value] + 1..quotes[value + 1], scrap);
                continue;
            }
            let start = self.below(text.len());
            let end = (start + self.below(9)).min(text.len());
            if text.is_char_boundary(start) && text.is_char_boundary(end) {
                text.replace_range(start..end, scrap);
            }
        }
        text
    }
}

#[test]
fn a_spoiled_robot_is_refused_in_words_or_has_finite_numbers() {
    const TRIES: usize = 20_000;
    let (mut draw, mut loaded, mut refused) = (Draw(16), 0, 0);
    for _ in 0..TRIES {
        let text = draw.spoil();
        match parse_urdf(&text, Path::new("odd.urdf"), Path::new("/nonexistent"), &SearchPaths::default()) {
            Ok(robot) => {
                assert_finite(&robot, &text);
                loaded += 1;
            }
            Err(errors) => {
                assert!(errors.iter().count() > 0 && !errors.to_string().is_empty(), "{text}");
                refused += 1;
            }
        }
    }
    assert!(loaded > TRIES / 20 && refused > TRIES / 20, "{loaded} load, {refused} do not: the mutations are dull");
}

fn assert_finite(loaded: &LoadedUrdf, text: &str) {
    let tree = Tree::from_description(&loaded.robot);
    assert!(tree.bodies.iter().all(|b| b.inertia.mass >= 0.0 && b.inertia.rot.iter().all(|x| x.is_finite())), "{text}");
    for joint in &loaded.robot.joints {
        assert!(
            (joint.axis.norm() - 1.0).abs() < 1e-9 && joint.pose_pj.translation.vector.iter().all(|x| x.is_finite())
        );
        assert!(joint.position_limits.is_none_or(|[lower, upper]| lower < upper), "{text}");
    }
    assert!(loaded.warnings.iter().all(|w| w.place.is_some() && !w.to_string().is_empty()), "{text}");
}
