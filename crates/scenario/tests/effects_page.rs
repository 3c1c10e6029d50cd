//! The guide's page of effects is what the definitions say.
#![allow(clippy::unwrap_used)]

use scenario::effects::{catalogue, reference};
use std::path::Path;

/// `SOFTDOCK_BLESS=1` writes it anew.
#[test]
fn the_guide_has_every_effect_as_it_is_defined() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cli/guide/effects.md");
    let page = reference::page();
    if std::env::var_os("SOFTDOCK_BLESS").is_some() {
        std::fs::write(&file, &page).unwrap();
    }
    let committed = std::fs::read_to_string(&file).unwrap();
    assert!(
        committed == page,
        "crates/cli/guide/effects.md is not what the definitions in crates/scenario/src/effects say; if these are right, \
         run SOFTDOCK_BLESS=1 cargo test -p softdock-scenario --test effects_page"
    );
}

#[test]
fn every_definition_is_written_out() {
    for effect in catalogue() {
        let sentences = [effect.meaning, effect.equation, effect.source];
        assert!(sentences.iter().all(|s| s.ends_with('.') && s.len() > 4), "{effect}: sentences end by a stop");
        assert!(effect.words.chars().next().is_some_and(char::is_lowercase), "{effect}: words go on in a sentence");
        assert!(!effect.places.is_empty(), "{effect} has no place");
        for parameter in effect.parameters {
            let told = parameter.meaning.chars().all(|c| c != '|') && !parameter.meaning.ends_with('.');
            assert!(
                told && !parameter.meaning.is_empty(),
                "{effect}.{}: the meaning is a cell of a table",
                parameter.name
            );
        }
    }
}
