//! What differs between the two scenario files, line by line, each line with the table that it stands in.

/// Longest files compared, lines: the comparison takes time and memory as their product.
const MOST: usize = 3000;

/// A line of one file only.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Change {
    /// The table it stands in, `[contact]`; empty at the top.
    pub(super) section: String,
    /// Whether it is of the second file.
    pub(super) is_new: bool,
    /// The line.
    pub(super) line: String,
}

/// Lines of only one of the files, in their order; none where a file is empty or too long.
pub(super) fn changes(a: &str, b: &str) -> Vec<Change> {
    let (a, b): (Vec<&str>, Vec<&str>) = (a.lines().collect(), b.lines().collect());
    if a.is_empty() || b.is_empty() || a.len() > MOST || b.len() > MOST {
        return Vec::new();
    }
    let longest = longest_common(&a, &b);
    let at = |i: usize, j: usize| longest[i * (b.len() + 1) + j];
    let (mut i, mut j, mut changes) = (0, 0, Vec::new());
    while i < a.len() || j < b.len() {
        if i < a.len() && j < b.len() && a[i] == b[j] {
            (i, j) = (i + 1, j + 1);
        } else if j >= b.len() || (i < a.len() && at(i + 1, j) >= at(i, j + 1)) {
            changes.push(Change { section: section(&a, i), is_new: false, line: a[i].trim().to_owned() });
            i += 1;
        } else {
            changes.push(Change { section: section(&b, j), is_new: true, line: b[j].trim().to_owned() });
            j += 1;
        }
    }
    changes.retain(|change| !change.line.is_empty());
    changes
}

/// Length of the longest common subsequence of what follows each pair of lines.
fn longest_common(a: &[&str], b: &[&str]) -> Vec<u16> {
    let width = b.len() + 1;
    let mut longest = vec![0_u16; (a.len() + 1) * width];
    for i in (0..a.len()).rev() {
        for j in (0..b.len()).rev() {
            longest[i * width + j] = if a[i] == b[j] {
                longest[(i + 1) * width + j + 1] + 1
            } else {
                longest[(i + 1) * width + j].max(longest[i * width + j + 1])
            };
        }
    }
    longest
}

/// The nearest head of a table above a line.
fn section(lines: &[&str], at: usize) -> String {
    let above = lines[..at].iter().rev().map(|line| line.trim());
    above.into_iter().find(|line| line.starts_with('[') && line.ends_with(']')).unwrap_or("").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_number_is_two_lines_in_one_table() {
        let a = "name = \"x\"\n[contact]\nmu = 0.3\nk = 1\n";
        let b = "name = \"x\"\n[contact]\nmu = 0.4\nk = 1\n\n[extra]\n";
        let found: Vec<String> = changes(a, b)
            .into_iter()
            .map(|c| format!("{} {} {}", c.section, if c.is_new { '+' } else { '-' }, c.line))
            .collect();
        assert_eq!(found, ["[contact] - mu = 0.3", "[contact] + mu = 0.4", "[contact] + [extra]"]);
        assert!(changes(a, a).is_empty() && changes("", b).is_empty());
    }
}
