//! Contact laws of the file, as the world has them.
#![allow(clippy::unwrap_used)]

use friction::{Friction, LuGre};
use std::path::Path;

/// A block on the floor whose contact rule ends as given; the laws of its one pair.
fn laws(rule: &str) -> Result<sim::PairLaw, String> {
    let urdf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/bench/peer-block.urdf");
    let text = format!(
        "name = \"t\"\nseed = 1\nduration_s = 1.0\n[[vehicle]]\nname = \"b\"\nurdf = {:?}\npose = {{ position_m = [0, 0, 0.05] }}\n[[shape]]\nname = \"floor\"\n\
         kind = \"half-space\"\n[[contact]]\nbetween = [\"b/*\", \"world/floor\"]\n{rule}",
        urdf.display().to_string()
    );
    let scenario = scenario::parse(&text, "s.toml", &[]).map_err(|e| e.to_string())?;
    let mission = scenario::build(&scenario).map_err(|e| e.to_string())?;
    Ok(mission.world.model().laws[0])
}

#[test]
fn a_drop_a_dwell_and_a_grain_arrive() {
    let law = laws(
        "friction = { law = \"bristle\", mu = 0.3, mu_static = 0.5, stribeck_velocity_m_per_s = 0, dwell_time_s = 2.0, \
         across_ratio = 0.5, stiffness_n_per_m = 1e5 }\ngrain = { on = \"world/floor\", axis = [0, 2, 0] }\n\
         pivot = { spin_lever_m = 1e-3, stiffness_n_m_per_rad = 5.0 }\n",
    )
    .unwrap();
    let Some(Friction::Bristle(bristle)) = law.friction else { panic!("a bristle") };
    assert_eq!((bristle.mu_static, bristle.mu_kinetic, bristle.stribeck_speed), (0.5, 0.3, 0.0));
    assert_eq!((bristle.dwell_time, bristle.across), (2.0, 0.5));
    assert_eq!(law.grain.unwrap().axis, spatial::Vec3::new(0.0, 2.0, 0.0));
    assert_eq!(law.pivot.unwrap().spin_lever, 1e-3);
}

#[test]
fn relatives_and_adhesion_arrive() {
    let law = laws(
        "normal = { law = \"linear\", stiffness_n_per_m = 1e5, adhesion_n = 0.2 }\n\
         friction = { law = \"elasto-plastic\", mu = 0.3, break_away_ratio = 0.7, stiffness_n_per_m = 1e5 }\n",
    )
    .unwrap();
    assert_eq!(law.normal.adhesion, 0.2);
    assert_eq!(law.friction, Some(LuGre { break_away: 0.7, ..LuGre::dahl(0.3, 1e5) }.into()));
    let law = laws("friction = { law = \"dahl\", mu = 0.3, stiffness_n_per_m = 1e5 }\n").unwrap();
    assert_eq!(law.friction, Some(LuGre::dahl(0.3, 1e5).into()));
}

#[test]
fn a_grain_on_neither_side_is_refused() {
    let said = laws("grain = { on = \"b2/x\", axis = [1, 0, 0] }\n").unwrap_err();
    assert!(said.contains("b2"), "{said}");
}
