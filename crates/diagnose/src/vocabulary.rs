//! Effects in plain words, and the units of their parameters.

/// An effect's name in words that go on with "in", "at" or "of" a place; the name itself where the table has none.
pub fn plain_name(effect: &str) -> &str {
    WORDS.iter().find(|(name, _)| *name == effect).map_or(effect, |(_, words)| words)
}

const WORDS: [(&str, &str); 49] = [
    ("joint-viscous-friction", "viscous friction"),
    ("joint-coulomb-friction", "dry (Coulomb) friction"),
    ("joint-stribeck-friction", "dry friction that is higher at breakaway than in sliding (Stribeck)"),
    ("joint-friction-asymmetry", "dry friction that differs between the two directions"),
    ("joint-viscous-asymmetry", "viscous friction that differs between the two directions"),
    ("joint-quadratic-friction", "friction that grows with the square of the rate"),
    ("joint-offset", "a constant effort"),
    ("joint-backlash", "backlash"),
    ("joint-elasticity", "elasticity between motor and link"),
    ("joint-torque-ripple", "a torque ripple that follows the joint's angle"),
    ("joint-cable-stiffness", "the pull of a cable harness"),
    ("joint-armature", "the reflected inertia of the rotor"),
    ("actuator-gain", "a wrong actuator gain"),
    ("actuator-delay", "a delay of the command"),
    ("actuator-lag", "a lag of the actuator"),
    ("actuator-saturation", "saturation of the actuator"),
    ("actuator-misalignment", "a tilted thrust axis"),
    ("payload", "an additional mass"),
    ("body-mass", "a wrong mass"),
    ("body-com", "a wrong centre of mass"),
    ("body-inertia", "a wrong inertia"),
    ("constant-force", "a constant force"),
    ("constant-torque", "a constant torque"),
    ("tilt", "a constant acceleration (a tilted table)"),
    ("linear-drag", "drag in proportion to speed"),
    ("quadratic-drag", "drag with the square of speed"),
    ("angular-damping", "damping of the rotation"),
    ("internal-dissipation", "dissipation inside the body"),
    ("gravity-gradient", "the gravity gradient's torque"),
    ("tether-stiffness", "the pull of a hose or tether"),
    ("slosh", "sloshing of a liquid"),
    ("flexible-appendage", "vibration of a flexible appendage"),
    ("periodic-disturbance", "a periodic disturbance"),
    ("contact-stiffness", "a wrong contact stiffness"),
    ("contact-damping", "a wrong contact damping"),
    ("friction-coefficient", "a wrong friction coefficient"),
    ("friction-stribeck", "friction that is higher at breakaway than in sliding (Stribeck)"),
    ("friction-bristle-stiffness", "a wrong pre-sliding stiffness"),
    ("friction-viscous", "friction that grows with sliding speed"),
    ("friction-anisotropy", "friction that depends on the direction of sliding"),
    ("friction-dwell-time", "breakaway friction that grows with time at rest"),
    ("adhesion", "adhesion"),
    ("contact-geometry-offset", "a misplaced part"),
    ("mount-compliance", "an elastic mount behind the contact"),
    ("sensor-bias", "a sensor bias"),
    ("sensor-scale", "a wrong sensor scale factor"),
    ("sensor-delay", "a sensor delay"),
    ("sensor-misalignment", "a misaligned sensor"),
    ("unknown", "something that the library does not have"),
];

/// The unit of an effect's parameter, "" for a pure number. `along`: a joint that slides rather than turns, or a place where a
/// force acts rather than a torque.
pub fn unit(effect: &str, parameter: &str, along: bool) -> &'static str {
    let pick = |turning: &'static str, sliding: &'static str| if along { sliding } else { turning };
    match (effect, parameter) {
        ("joint-viscous-friction" | "joint-viscous-asymmetry", _) => pick("N m s/rad", "N s/m"),
        ("joint-quadratic-friction", _) => pick("N m s²/rad²", "N s²/m²"),
        ("joint-offset", _) => pick("N m", "N"),
        ("joint-stribeck-friction", "v_s") => pick("rad/s", "m/s"),
        ("joint-coulomb-friction" | "joint-stribeck-friction" | "joint-friction-asymmetry", _) => pick("N m", "N"),
        ("joint-backlash", "gap") | ("joint-cable-stiffness", "q_rest") => pick("rad", "m"),
        ("joint-backlash" | "joint-elasticity" | "joint-cable-stiffness", "k") => pick("N m/rad", "N/m"),
        ("joint-backlash" | "joint-elasticity", "d") => pick("N m s/rad", "N s/m"),
        ("joint-armature", _) => pick("kg m²", "kg"),
        ("actuator-saturation", _) => pick("N m", "N"),
        ("joint-torque-ripple" | "periodic-disturbance", "amplitude") => pick("N m", "N"),
        ("joint-torque-ripple" | "periodic-disturbance", "phase") => "rad",
        (_, "delay" | "time_constant") => "s",
        (_, "mass" | "m") => "kg",
        (_, "com" | "position" | "anchor" | "offset") => "m",
        (_, "inertia" | "i_damper") => "kg m²",
        ("constant-force", "vector") | ("adhesion", "force") => "N",
        ("constant-torque", "vector") => "N m",
        ("tilt", "vector") => "m/s²",
        ("linear-drag", "c") => "N s/m",
        ("quadratic-drag", "c") => "N s²/m²",
        ("angular-damping" | "internal-dissipation", "c") => "N m s/rad",
        ("gravity-gradient", "mean_motion") => "rad/s",
        ("contact-damping", "c") => "s/m",
        (_, "frequency") => "Hz",
        ("flexible-appendage", "coupling") => "√kg m",
        ("contact-stiffness", "k") => "N/mⁿ",
        ("tether-stiffness" | "mount-compliance", "k") | (_, "k_b") => "N/m",
        ("tether-stiffness" | "mount-compliance", "d") | (_, "c_b") | ("friction-viscous", "b") => "N s/m",
        ("friction-stribeck", "v_s") => "m/s",
        (_, "angle" | "angle_y" | "angle_z") => "rad",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_words_of_its_own() {
        let mut names: Vec<_> = WORDS.iter().map(|w| w.0).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), WORDS.len());
        assert_eq!(plain_name("slosh"), "sloshing of a liquid");
        assert_eq!(plain_name("a-new-effect"), "a-new-effect");
        assert_eq!((unit("joint-viscous-friction", "b", false), unit("slosh", "damping", false)), ("N m s/rad", ""));
    }
}
