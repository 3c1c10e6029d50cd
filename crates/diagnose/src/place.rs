//! When two places are the same: the kind is, and so are the names, as far as both are qualified.

/// Kind and names of a place.
fn split(place: &str) -> (&str, &str) {
    let (kind, name) = place.split_once(':').unwrap_or((place, ""));
    // A body is any link of a URDF.
    (if kind == "link" { "body" } else { kind.trim() }, name.trim())
}

/// A name without its vehicle: `joint_3` of `arm/joint_3` or `arm.joint_3`.
pub fn unqualified(name: &str) -> &str {
    name.rsplit(['/', '.']).next().unwrap_or(name)
}

/// Whether two names are the same as far as both are qualified.
fn same_name(a: &str, b: &str) -> bool {
    let ends_with = |long: &str, short: &str| {
        long.strip_suffix(short).is_some_and(|vehicle| vehicle.is_empty() || vehicle.ends_with(['/', '.']))
    };
    ends_with(a, b) || ends_with(b, a)
}

/// The ways in which `a/b`, `vehicle/a/b`, `a/vehicle/b`, … name two parts.
fn pairs(names: &str) -> impl Iterator<Item = (&str, &str)> {
    names.match_indices('/').map(|(at, _)| (&names[..at], &names[at + 1..]))
}

fn same_pair(a: &str, b: &str) -> bool {
    pairs(a).any(|x| {
        pairs(b).any(|y| same_name(x.0, y.0) && same_name(x.1, y.1) || same_name(x.0, y.1) && same_name(x.1, y.0))
    })
}

/// Whether two places are the same: vehicles count only where both are named, the order of a contact's parts does not, a
/// link is a body, and the drive of a joint may be called by the joint or by the actuator of the same name.
///
/// A sensor's place is a prefix of channels and must be the same to the letter.
pub fn same_place(a: &str, b: &str) -> bool {
    let ((kind_a, a), (kind_b, b)) = (split(a), split(b));
    match (kind_a, kind_b) {
        ("contact", "contact") => same_pair(a, b),
        ("world", "world") => true,
        ("sensor", "sensor") => a == b,
        ("joint", "actuator") | ("actuator", "joint") => same_name(a, b),
        _ => kind_a == kind_b && !a.is_empty() && same_name(a, b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vehicle_counts_only_where_both_name_one() {
        assert!(same_place("joint:arm/joint_3", "joint:joint_3"));
        assert!(same_place("joint:arm.joint_3", "joint:joint_3"));
        assert!(!same_place("joint:left/joint_3", "joint:right/joint_3"));
        assert!(!same_place("joint:joint_13", "joint:joint_3") && !same_place("joint:joint_3", "joint:joint_30"));
    }

    #[test]
    fn contacts_are_pairs_of_parts_in_any_order() {
        for same in [
            "contact:probe/drogue",
            "contact:drogue/probe",
            "contact:chaser.probe/target.drogue",
            "contact:chaser/probe/drogue",
            "contact:probe/target/drogue",
            "contact:chaser/probe/target/drogue",
        ] {
            assert!(same_place(same, "contact:probe/drogue"), "{same}");
        }
        assert!(!same_place("contact:probe/rim", "contact:probe/drogue"));
        assert!(!same_place("contact:probe", "contact:probe/drogue"));
    }

    #[test]
    fn kinds_are_kept_apart_but_a_link_is_a_body() {
        assert!(same_place("link:link_7", "body:link_7") && same_place("world", "world"));
        assert!(!same_place("joint:link_7", "body:link_7") && !same_place("world", "body:world"));
        assert!(same_place("actuator:joint_5", "joint:arm/joint_5"));
        assert!(!same_place("sensor:body.target", "sensor:body.target.angular_velocity"));
        assert_eq!(unqualified("arm/joint_3"), "joint_3");
    }
}
