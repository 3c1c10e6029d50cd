//! Globs over names: `*` stands for any run of characters (also none, also with `/`), `?` for exactly one.

/// Whether `text` matches `pattern`.
///
/// Linear in practice and never worse than the product of the lengths: on a mismatch only the last `*` is retried.
pub fn glob_matches(pattern: &str, text: &str) -> bool {
    let (pattern, text) = (pattern.as_bytes(), text.as_bytes());
    let (mut p, mut t) = (0, 0);
    let mut retry = None;
    while t < text.len() {
        match pattern.get(p) {
            Some(b'*') => {
                retry = Some((p, t));
                p += 1;
            }
            Some(c) if *c == b'?' || *c == text[t] => {
                p += 1;
                t += 1;
            }
            _ => match retry {
                Some((star, from)) => {
                    retry = Some((star, from + 1));
                    p = star + 1;
                    t = from + 1;
                }
                None => return false,
            },
        }
    }
    pattern[p..].iter().all(|c| *c == b'*')
}

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
