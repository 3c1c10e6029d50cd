//! Any text as a scenario, with overrides: an answer in words, or a scenario that is written and read again unchanged.
//!
//! Lines after `====` are overrides, `path=value`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use scenario::{ScenarioErrors, parse, to_toml};

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    let (file, tail) = text.split_once("\n====\n").unwrap_or((&text, ""));
    let overrides: Vec<String> = tail.lines().map(str::to_owned).collect();
    match parse(file, "fuzz.toml", &overrides) {
        Ok(scenario) => {
            let written = to_toml(&scenario);
            let again = parse(&written, "again.toml", &[]).unwrap_or_else(|errors| panic!("{errors}\n{written}"));
            assert_eq!(scenario, again);
            for vehicle in &scenario.vehicles {
                let pose = vehicle.pose.pose();
                assert!(pose.to_homogeneous().iter().chain(&vehicle.twist.twist_wb_w(&pose).lin).all(|x| x.is_finite()));
            }
        }
        Err(errors) => check(&errors),
    }
});

/// Every fault has a place and a sentence, and there is one at least.
fn check(errors: &ScenarioErrors) {
    assert!(!errors.errors.is_empty());
    for error in &errors.errors {
        assert!(!error.place.to_string().is_empty() && !error.problem.to_string().is_empty());
    }
}
