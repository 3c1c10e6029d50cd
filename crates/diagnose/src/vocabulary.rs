//! Effects in plain words, and the units of their parameters, by name: as findings, evidence and answer keys have them.

use scenario::effects;

/// An effect's name in words that go on with "in", "at" or "of" a place; the name itself where there is no such effect.
pub fn plain_name(effect: &str) -> &str {
    effects::find(effect).map_or(effect, |def| def.words)
}

/// The unit of an effect's parameter, "" for a pure number. `along`: a joint that slides rather than turns, or a place where a
/// force acts rather than a torque.
pub fn unit(effect: &str, parameter: &str, along: bool) -> &'static str {
    let found = effects::find(effect).and_then(|def| def.parameter(parameter));
    found.map_or("", |parameter| parameter.unit.pick(along))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_words_of_its_own() {
        let mut words: Vec<_> = effects::catalogue().map(|def| def.words).collect();
        assert!(words.iter().all(|words| !words.is_empty()));
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), effects::ALL.len());
        assert_eq!(plain_name("slosh"), "sloshing of a liquid");
        assert_eq!(plain_name("a-new-effect"), "a-new-effect");
        assert_eq!((unit("joint-viscous-friction", "b", false), unit("slosh", "damping", false)), ("N m s/rad", ""));
    }
}
