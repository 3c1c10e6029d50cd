//! When a set of effects is enough: what makes others not worth a fit.

/// A set that leaves next to nothing.
pub(super) struct Enough {
    /// What it is, in alphabetical order.
    pub titles: Vec<String>,
    /// Its price, and what may yet be gained beside it.
    pub limit: f64,
}

impl Enough {
    /// Whether a larger set is not worth a fit: what adds to one that leaves nothing adds nothing, and what costs more than that and all that it leaves
    /// cannot be better by the criterion.
    pub fn outdoes(&self, titles: &[String], price: f64) -> bool {
        titles.len() > self.titles.len() && price > self.limit || self.titles.iter().all(|t| titles.contains(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_set_is_outdone_by_what_it_costs_or_contains_and_an_equal_one_is_a_rival() {
        let titles = |all: &[&str]| all.iter().map(|t| (*t).to_owned()).collect::<Vec<_>>();
        let enough = Enough { titles: titles(&["friction"]), limit: 20.0 };
        assert!(enough.outdoes(&titles(&["friction", "payload"]), 10.0), "it adds to what leaves nothing");
        assert!(enough.outdoes(&titles(&["gain", "payload"]), 21.0), "it costs more than it can gain");
        assert!(!enough.outdoes(&titles(&["gain", "payload"]), 19.0));
        assert!(!enough.outdoes(&titles(&["gain"]), 21.0), "one effect in the place of another is a rival");
    }
}
