//! Globs over names: `*` stands for any run of characters (also none, also with `/`), `?` for exactly one.

pub use contact::glob_matches;

/// Whether a text is a pattern rather than a name.
pub fn is_glob(text: &str) -> bool {
    text.contains(['*', '?'])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn globs_match_as_in_a_shell() {
        let yes =
            [("*", ""), ("*", "a/b"), ("a/*", "a/b"), ("*/finger_*", "s/finger_left"), ("a?c", "abc"), ("*a*b", "aab")];
        let no = [("", "a"), ("a/*", "b/a"), ("a?c", "ac"), ("*b", "ba"), ("a", "ab")];
        for (pattern, text) in yes {
            assert!(glob_matches(pattern, text), "{pattern} should match {text}");
        }
        for (pattern, text) in no {
            assert!(!glob_matches(pattern, text), "{pattern} should not match {text}");
        }
    }
}
