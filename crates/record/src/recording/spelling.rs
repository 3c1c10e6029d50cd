//! The nearest valid name, for messages.

/// Likeness (Jaro–Winkler) from which a spelling is worth suggesting.
const LIKE: f64 = 0.8;

/// The candidate nearest to `text`, if one is near enough.
pub(super) fn nearest<'a>(text: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let folded = text.to_lowercase();
    let scored = candidates.into_iter().map(|c| (likeness(&folded, &c.to_lowercase()), c));
    scored.filter(|(score, _)| *score >= LIKE).reduce(|a, b| if b.0 > a.0 { b } else { a }).map(|(_, c)| c)
}

/// Likeness of two spellings, 0 … 1; one slip of the finger in three letters is still alike.
fn likeness(a: &str, b: &str) -> f64 {
    let one_slip = a.chars().count().min(b.chars().count()) >= 3 && strsim::damerau_levenshtein(a, b) <= 1;
    strsim::jaro_winkler(a, b).max(if one_slip { LIKE } else { 0.0 })
}

/// Ends a sentence about an unknown name: the nearest valid one, or all of them.
pub(super) fn hint<'a>(text: &str, valid: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(text, valid.clone()) {
        Some(near) => format!("; did you mean \"{near}\"?"),
        None => format!("; known here: {}", listed(valid)),
    }
}

/// Names in a row; of many, the first ones.
pub(super) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    const SHOWN: usize = 40;
    let names: Vec<&str> = names.into_iter().collect();
    match names.len() {
        0 => "nothing".to_owned(),
        n if n <= SHOWN => names.join(", "),
        n => format!("{} and {} more", names[..SHOWN].join(", "), n - SHOWN),
    }
}
