//! Nearest valid spellings, and units that are missing from a key.

/// Endings that name a unit, longest first where one ends in another.
const UNITS: &[&str] = &[
    "_n_m_s_per_rad",
    "_n_m_per_rad",
    "_n_per_m_exp",
    "_n_s_per_m",
    "_deg_per_s",
    "_rad_per_s",
    "_m_per_s2",
    "_n_per_m",
    "_m_per_s",
    "_s_per_m",
    "_kg_m2",
    "_per_s",
    "_n_m",
    "_deg",
    "_rad",
    "_min",
    "_khz",
    "_hz",
    "_ms",
    "_us",
    "_mm",
    "_cm",
    "_km",
    "_nm",
    "_kn",
    "_kg",
    "_g",
    "_m",
    "_n",
    "_s",
    "_h",
];

/// Likeness (Jaro–Winkler) from which a spelling is worth suggesting.
const LIKE: f64 = 0.8;

/// Splits a key into its stem and its unit, `step_s` → (`step`, `_s`); the unit is empty where there is none.
fn split_unit(key: &str) -> (&str, &str) {
    let unit = UNITS.iter().find(|unit| key.len() > unit.len() && key.ends_with(**unit));
    unit.map_or((key, ""), |unit| key.split_at(key.len() - unit.len()))
}

/// The candidate nearest to `text`, if one is near enough.
pub(crate) fn nearest<'a>(text: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = text.to_lowercase().replace([' ', '-'], "_");
    candidates
        .into_iter()
        .map(|candidate| (likeness(&folded, &candidate.to_lowercase().replace('-', "_")), candidate))
        .filter(|(score, _)| *score >= LIKE)
        .reduce(|best, next| if next.0 > best.0 { next } else { best })
        .map(|(_, candidate)| candidate)
}

/// Likeness of two spellings, 0 … 1; one slip of the finger in three letters is still alike.
fn likeness(a: &str, b: &str) -> f64 {
    let slips = strsim::damerau_levenshtein(a, b);
    let by_slips = match a.chars().count().min(b.chars().count()) {
        length if length >= 3 && slips <= 1 => LIKE,
        _ => 0.0,
    };
    strsim::jaro_winkler(a, b).max(strsim::normalized_damerau_levenshtein(a, b) + 0.1).min(1.0).max(by_slips)
}

/// What is said about an unknown key, and the key that was probably meant.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KeyHint {
    /// Continues the sentence "unknown key `…`".
    pub(crate) text: String,
    /// The valid key that was probably meant.
    pub(crate) meant: Option<String>,
}

/// Looks for what an unknown key was meant to be: the same with a unit, with another unit, or a near spelling.
pub(crate) fn hint_for_key<'a>(key: &str, valid: impl Iterator<Item = &'a str> + Clone) -> KeyHint {
    let (stem, unit) = split_unit(key);
    let same_stem: Vec<&str> =
        valid.clone().filter(|v| split_unit(v).0 == stem && !split_unit(v).1.is_empty()).collect();
    if let [first, ..] = same_stem.as_slice() {
        let names = one_of(&same_stem);
        let text = match unit {
            "" => format!(": the unit is missing from the name; did you mean {names}?"),
            _ => format!(": the unit is another here; did you mean {names}?"),
        };
        return KeyHint { text, meant: Some((*first).to_owned()) };
    }
    match nearest(key, valid.clone()) {
        Some(near) => KeyHint { text: format!("; did you mean `{near}`?"), meant: Some(near.to_owned()) },
        None => KeyHint { text: format!("; valid here: {}", listed(valid)), meant: None },
    }
}

/// `a`, `a` or `b`, …
pub(crate) fn one_of(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" or ")
}

/// Names in a row, for a message.
pub(crate) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

/// What is said about an unknown name: the nearest of `valid`, or all of them.
pub(crate) fn hint_for_name<'a>(text: &str, valid: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(text, valid.clone()) {
        Some(near) => format!("; did you mean \"{near}\"?"),
        None => format!("; valid here: {}", listed(valid)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_unit_is_named_as_such() {
        let hint = hint_for_key("duration", ["seed", "duration_s"].into_iter());
        assert_eq!(hint.text, ": the unit is missing from the name; did you mean `duration_s`?");
    }

    #[test]
    fn another_unit_is_named_as_such() {
        let hint = hint_for_key("step_ms", ["kind", "step_s"].into_iter());
        assert_eq!(hint.text, ": the unit is another here; did you mean `step_s`?");
    }

    #[test]
    fn slips_of_the_finger_are_near() {
        assert_eq!(nearest("implicit_eular", ["rk4", "implicit-euler", "implicit-midpoint"]), Some("implicit-euler"));
        assert_eq!(nearest("RK-4", ["rk4", "implicit-euler"]), Some("rk4"));
        assert_eq!(nearest("jaw", ["roll", "yaw"]), Some("yaw"));
        assert_eq!(nearest("zzz", ["rk4", "implicit-euler"]), None);
    }
}
