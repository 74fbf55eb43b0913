//! Input that fits no device, for reports.

use std::collections::BTreeSet;

/// Maximum number of reports.
const MAX_REPORTS: usize = 32;

/// Characters of an input in a report.
const SHOWN: usize = 40;

/// Reports of input that is left out, each made once.
#[derive(Default)]
pub struct LeftOut {
    known: BTreeSet<String>,
    reports: Vec<String>,
}

impl LeftOut {
    pub(super) fn add(&mut self, report: String) {
        if self.known.len() == MAX_REPORTS || !self.known.insert(report.clone()) {
            return;
        }
        self.reports.push(report);
        if self.known.len() == MAX_REPORTS {
            let last = "other input that is left out is not reported";
            self.reports.push(last.to_string());
        }
    }

    /// New reports since the last call.
    pub fn reports(&mut self) -> Vec<String> {
        std::mem::take(&mut self.reports)
    }
}

/// Input in a report: its beginning, without characters that a terminal may act on.
pub(super) fn shown(text: &str) -> String {
    let mut shown = text.chars();
    let mut begin = String::new();
    for c in shown.by_ref().take(SHOWN) {
        match c {
            '"' | '\'' | '\\' => begin.push(c),
            _ => begin.extend(c.escape_debug()),
        }
    }
    let end = if shown.next().is_some() { "…" } else { "" };
    format!("{begin}{end}")
}
