//! The book's page on the errors of serial ports: each code that a cause is stated for occurs in a conformance case,
//! and no code occurs that is said to occur never.

use std::collections::BTreeSet;

const PAGE: &str = include_str!(concat!(env!("RUNGC_ROOT"), "/docs/src/port-errors.md"));
const CASES: &str = include_str!(concat!(
    env!("RUNGC_ROOT"),
    "/golden/conformance/h1u-h2u/own-port-errors.plctest.toml"
));

/// Placeholder for a digit in the codes of four ports, and the digits of the ports.
const ANY_PORT: &str = "63x";
const PORTS: [&str; 4] = ["633", "634", "635", "636"];

/// Codes that COM0 does not have, which is never a master.
const OF_MASTERS: [&str; 2] = ["6335", "6339"];

/// The codes of a row, with each port's.
fn codes(code: &str) -> Vec<String> {
    match code.strip_prefix(ANY_PORT) {
        Some(digit) => {
            let all = PORTS.iter().map(|port| format!("{port}{digit}"));
            all.filter(|code| !OF_MASTERS.contains(&code.as_str()))
                .collect()
        }
        None => vec![code.to_string()],
    }
}

#[test]
fn each_code_is_caused_by_a_case_or_declared_to_occur_never() {
    let expected: BTreeSet<&str> = CASES
        .lines()
        .filter(|line| line.starts_with("expect = "))
        .flat_map(|line| line.split(|c: char| !c.is_ascii_digit()))
        .collect();
    let mut rows = 0;
    for row in PAGE.lines().filter(|line| line.starts_with("| 6")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let never = cells[3].starts_with("never");
        for code in codes(cells[1]) {
            assert_eq!(expected.contains(code.as_str()), !never, "{row}: {code}");
        }
        rows += 1;
    }
    assert!(rows > 30, "the page has a row for each code");
}
