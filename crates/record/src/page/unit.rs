//! Units from names: the suffix of a metric or a key says in what it is measured.

/// Suffixes and their units, longer ones first where one ends in another.
const UNITS: [(&str, &str); 46] = [
    ("_n_m_s_per_rad", "N·m·s/rad"),
    ("_n_s_per_m", "N·s/m"),
    ("_s_per_m", "s/m"),
    ("_n_m_per_rad", "N·m/rad"),
    ("_deg_per_s2", "°/s²"),
    ("_rad_per_s2", "rad/s²"),
    ("_deg_per_s", "°/s"),
    ("_rad_per_s", "rad/s"),
    ("_kg_m2_per_s", "kg·m²/s"),
    ("_kg_m_per_s", "kg·m/s"),
    ("_mm_per_s", "mm/s"),
    ("_m_per_s2", "m/s²"),
    ("_m_per_s", "m/s"),
    ("_n_m_s", "N·m·s"),
    ("_n_per_m", "N/m"),
    ("_n_per_s", "N/s"),
    ("_per_s", "1/s"),
    ("_per_m", "1/m"),
    ("_kg_m2", "kg·m²"),
    ("_n_m", "N·m"),
    ("_n_s", "N·s"),
    ("_percent", "%"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_kg", "kg"),
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_km", "km"),
    ("_m2", "m²"),
    ("_m3", "m³"),
    ("_ms", "ms"),
    ("_min", "min"),
    ("_hz", "Hz"),
    ("_mj", "mJ"),
    ("_kn", "kN"),
    ("_pa", "Pa"),
    ("_mpa", "MPa"),
    ("_m", "m"),
    ("_s", "s"),
    ("_n", "N"),
    ("_j", "J"),
    ("_w", "W"),
    ("_v", "V"),
    ("_a", "A"),
    ("_k", "K"),
    ("_degc", "°C"),
];

/// Parameters of laws whose index looks like a unit.
const INDICES: [&str; 6] = ["mu_s", "mu_k", "mu_d", "v_s", "f_s", "f_c"];
/// Names of components, whose unit is that of what they are components of.
const COMPONENTS: [&str; 7] = ["x", "y", "z", "roll", "pitch", "yaw", "w"];

/// The unit that a name ends in: of `peak_force_n` `N`, of `twist.angular_deg_per_s[2]` `°/s`, of `momentum_drift`
/// none.
pub fn unit(name: &str) -> Option<&'static str> {
    let mut parts = name.rsplit(['.', '/']).map(without_index);
    let last = parts.next()?;
    unit_of_part(last).or_else(|| if COMPONENTS.contains(&last) { unit_of_part(parts.next()?) } else { None })
}

fn without_index(part: &str) -> &str {
    part.strip_suffix(']').and_then(|p| p.rsplit_once('[')).map_or(part, |(name, _)| name)
}

fn unit_of_part(part: &str) -> Option<&'static str> {
    if INDICES.contains(&part) {
        return None;
    }
    let part = part.to_ascii_lowercase();
    UNITS.iter().find(|(suffix, _)| part.len() > suffix.len() && part.ends_with(suffix)).map(|(_, unit)| *unit)
}

/// A name without its unit, for people: `peak contact force`.
pub fn words(name: &str) -> String {
    let suffix = UNITS.iter().find(|(suffix, _)| unit(name).is_some() && name.ends_with(suffix)).map(|(s, _)| *s);
    suffix.and_then(|suffix| name.strip_suffix(suffix)).unwrap_or(name).replace('_', " ")
}

/// A name with its unit as an axis says it: `peak contact force, N`.
pub fn label(name: &str) -> String {
    with_unit(&words(name), unit(name))
}

/// Words with a unit where there is one.
pub fn with_unit(words: &str, unit: Option<&str>) -> String {
    unit.map_or_else(|| words.to_owned(), |unit| format!("{words}, {unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suffixes_are_units() {
        let cases = [
            ("peak_contact_force_n", Some("N")),
            ("contact_impulse_n_s", Some("N·s")),
            ("peak_hold_moment_n_m", Some("N·m")),
            ("capture_time_s", Some("s")),
            ("residual_rate_deg_per_s", Some("°/s")),
            ("residual_speed_m_per_s", Some("m/s")),
            ("damping_n_s_per_m", Some("N·s/m")),
            ("kinetic_energy_j", Some("J")),
            ("momentum_drift_linear", None),
            ("vehicle.target.twist.angular_deg_per_s[2]", Some("°/s")),
            ("position_m.x", Some("m")),
            ("joint.mu_s", None),
            ("x", None),
            ("_n", None),
            ("", None),
        ];
        for (name, expected) in cases {
            assert_eq!(unit(name), expected, "{name}");
        }
    }

    #[test]
    fn longer_suffixes_stand_before_what_they_end_in() {
        for (i, (suffix, _)) in UNITS.iter().enumerate() {
            assert!(UNITS[..i].iter().all(|(earlier, _)| !suffix.ends_with(earlier)), "{suffix} is never reached");
        }
    }

    #[test]
    fn labels_are_words_and_a_unit() {
        assert_eq!(label("peak_contact_force_n"), "peak contact force, N");
        assert_eq!(label("momentum_drift_linear"), "momentum drift linear");
        assert_eq!(label("angular_deg_per_s[2]"), "angular deg per s[2], °/s");
    }
}
