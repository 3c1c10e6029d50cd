//! The regression's result as JUnit XML, which every CI reads: a suite a scenario, a case a group of checks.

use super::changes::{Change, Group};
use crate::error::CampaignError;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::path::Path;

/// The XML of all scenarios: name, and what was found, or why it could not be looked at.
pub fn junit_xml(results: &[(String, Result<Vec<Change>, String>)]) -> Result<String, CampaignError> {
    let mut report = Report::new("softdock regress");
    for (name, result) in results {
        report.add_test_suite(suite(name, result));
    }
    report.to_string().map_err(|e| CampaignError::table(Path::new("junit.xml"), e))
}

fn suite(name: &str, result: &Result<Vec<Change>, String>) -> TestSuite {
    let mut suite = TestSuite::new(name);
    match result {
        Err(reason) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
            status.set_message("the scenario could not be held against its baseline").set_description(reason);
            suite.add_test_case(case("baseline", name, status));
        }
        Ok(changes) => {
            for group in Group::ALL {
                let texts: Vec<&str> = changes.iter().filter(|c| c.group == group).map(|c| c.text.as_str()).collect();
                let status = match texts.first() {
                    None => TestCaseStatus::success(),
                    Some(first) => {
                        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                        status.set_message(*first).set_description(texts.join("\n"));
                        status
                    }
                };
                suite.add_test_case(case(group.word(), name, status));
            }
        }
    }
    suite
}

fn case(name: &str, scenario: &str, status: TestCaseStatus) -> TestCase {
    let mut case = TestCase::new(name, status);
    case.set_classname(scenario);
    case
}
