//! Names by pattern: `*` is any run of characters (also none, also `/`), `?` is exactly one.

/// Whether `name` (as `servicer/finger_left`) fits `pattern` (as `servicer/finger_*`).
///
/// ```
/// assert!(contact::glob_matches("*/finger_?", "servicer/finger_1"));
/// assert!(!contact::glob_matches("servicer/finger", "servicer/finger_left"));
/// ```
pub fn glob_matches(pattern: &str, name: &str) -> bool {
    let (p, s): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    let (mut i, mut j) = (0, 0);
    // Where to resume when the present reading fails: after the last star, one character further.
    let mut resume: Option<(usize, usize)> = None;
    while j < s.len() {
        if i < p.len() && p[i] == '*' {
            resume = Some((i, j));
            i += 1;
        } else if i < p.len() && (p[i] == '?' || p[i] == s[j]) {
            (i, j) = (i + 1, j + 1);
        } else if let Some((star, at)) = resume {
            resume = Some((star, at + 1));
            (i, j) = (star + 1, at + 1);
        } else {
            return false;
        }
    }
    p[i..].iter().all(|&c| c == '*')
}

#[cfg(test)]
mod tests {
    use super::glob_matches;

    #[test]
    fn stars_and_question_marks() {
        for (pattern, name, fits) in [
            ("servicer/finger_left", "servicer/finger_left", true),
            ("servicer/*", "servicer/finger_left", true),
            ("*/finger_*", "servicer/finger_left", true),
            ("*_left", "servicer/finger_left/pad_left", true),
            ("*ab*ab", "abab", true),
            ("*", "", true),
            ("?", "", false),
            ("servicer/finger_?", "servicer/finger_12", false),
            ("", "a", false),
            ("a*b*c", "a-c-b", false),
        ] {
            assert_eq!(glob_matches(pattern, name), fits, "{pattern} on {name}");
        }
    }
}
