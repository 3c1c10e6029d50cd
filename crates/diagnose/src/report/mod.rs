//! x
mod panel;
/// x
pub fn report_html() {}
