//! Tables that a test generates: committed, compared, and written anew with `SOFTDOCK_BLESS=1`.

use std::path::PathBuf;

/// Largest relative change of a number before the table counts as moved.
const TOLERANCE: f64 = 0.05;
/// Largest absolute change of a number written without an exponent (three decimals).
const DECIMALS: f64 = 2e-3;

/// Compares `text` with `tests/tables/<name>`, number by number; with `SOFTDOCK_BLESS=1` writes it instead.
pub(crate) fn check(name: &str, text: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/tables").join(name);
    println!("{text}");
    if std::env::var_os("SOFTDOCK_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
        return;
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    let (old, new) = (tokens(&committed), tokens(text));
    let moved: Vec<_> = old.iter().zip(&new).filter(|(a, b)| !agree(a, b)).collect();
    assert!(
        old.len() == new.len() && moved.is_empty(),
        "tests/tables/{name} has moved: {moved:?}; if that is meant, run SOFTDOCK_BLESS=1 cargo test -p softdock-sim -- table"
    );
}

fn tokens(text: &str) -> Vec<&str> {
    text.split(|c: char| c.is_whitespace() || "()".contains(c)).filter(|t| !t.is_empty()).collect()
}

fn agree(a: &str, b: &str) -> bool {
    match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(x), Ok(y)) => {
            let floor = if a.contains('e') { 0.0 } else { DECIMALS };
            (x - y).abs() <= TOLERANCE * x.abs().max(y.abs()) + floor
        }
        _ => a == b,
    }
}
