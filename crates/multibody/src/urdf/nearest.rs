//! The nearest valid spelling of a word.

use strsim::osa_distance;

/// Longer words are not compared: nobody misspells them by hand, and the comparison costs length squared.
const LONGEST_COMPARED: usize = 64;

/// The candidate that `word` is probably a misspelling of: a third of its letters may differ, at least one.
///
/// Two neighbouring letters swapped count as one difference, capitals as none.
pub(crate) fn find_nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > LONGEST_COMPARED {
        return None;
    }
    let lower = word.to_lowercase();
    candidates
        .into_iter()
        .filter(|c| c.len() <= LONGEST_COMPARED)
        .map(|c| (osa_distance(&lower, &c.to_lowercase()), c))
        .filter(|(distance, c)| *distance <= (c.len() / 3).max(1))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, c)| c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspellings_find_their_word_and_other_words_do_not() {
        let tags = ["inertial", "visual", "collision"];
        assert_eq!(find_nearest("inertail", tags), Some("inertial"));
        assert_eq!(find_nearest("Colision", tags), Some("collision"));
        assert_eq!(find_nearest("contact", tags), None);
        assert_eq!(find_nearest("xzy", ["xyz", "rpy"]), Some("xyz"));
    }
}
