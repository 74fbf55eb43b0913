//! Findings of `check --deep`: each cause once, nothing that is intended, and proposals that help.

use crate::common::{folder, rungc, text};

/// A finding in a report: code, line, and the other places.
type Reported = (&'static str, u64, Vec<(String, u64)>);

/// A finding that is expected: code, line, and the lines of what follows from it.
type Expected = (&'static str, u64, &'static [u64]);

/// The findings of `--deep` in a report.
fn deep_findings(json: &str) -> Vec<Reported> {
    let report: serde_json::Value = serde_json::from_str(json).expect("a report");
    let found = report["diagnostics"].as_array().expect("diagnostics");
    let codes = [
        "W0901", "W0902", "W0903", "W0904", "W0905", "W0906", "W0907",
    ];
    let line = |of: &serde_json::Value| of["line"].as_u64().expect("a line");
    found
        .iter()
        .filter_map(|found| {
            let code = codes.into_iter().find(|code| found["code"] == *code)?;
            let others = found["related"].as_array().into_iter().flatten();
            let others = others.map(|other| {
                let message = other["message"].as_str().expect("a message");
                (message.to_string(), line(other))
            });
            Some((code, line(found), others.collect()))
        })
        .collect()
}

/// Programs in which something is dead or clear on purpose, or one cause has several effects, with their findings.
const CAUSES: [(&str, &[Expected]); 10] = [
    // Outputs are cleared, and never set here.
    (
        "LD M8002\nZRST Y000 Y007\nLD X000\nRST Y003\nRST M5\nLD X000\nOUT Y010\nEND\n",
        &[],
    ),
    // But this one should be set.
    (
        "LD X000\nRST Y003\nLD X001\nANI X001\nSET Y003\nEND\n",
        &[("W0901", 5, &[])],
    ),
    // Spare, by a relay that is off, and by another that follows it.
    (
        "LD M8001\nOUT M10\nLD M10\nAND X001\nOUT M11\nLD M11\nAND X002\nOUT Y005\nEND\n",
        &[],
    ),
    // The same by one that is on.
    ("LD M8000\nOUT M10\nLDI M10\nAND X001\nOUT Y005\nEND\n", &[]),
    // This one is off by accident.
    (
        "LD X000\nANI X000\nOUT M10\nLD M10\nAND X001\nOUT Y005\nLDI M10\nOUT Y006\nEND\n",
        &[("W0901", 3, &[6])],
    ),
    (
        "LDP X000\nOUT T0 K10\nLD T0\nOUT Y000\nEND\n",
        &[("W0906", 2, &[4])],
    ),
    // The rung that matters, with its comparison, and what follows.
    (
        "LD M8002\nMOV K1 D0\nLD X000\nMOV K2 D0\nLD>= D0 K3\nOUT M10\nLD M10\nOUT Y001\nEND\n",
        &[("W0901", 6, &[5, 8])],
    ),
    // Nothing sets S21.
    (
        "LD M8002\nSET S0\nSTL S0\nLD X000\nSET S20\nSTL S21\nOUT Y000\nLD X001\nOUT S0\nRET\nEND\n",
        &[("W0901", 7, &[])],
    ),
    // IST chooses S1, and RST takes it back: no run holds it.
    (
        "LD M8000\nIST X020 S20 S27\nSTL S1\nLD X007\nSET S10\nSTL S10\nOUT Y001\nLD X003\nSET M8043\nRST S10\nRET\nEND\n",
        &[],
    ),
    // IST ends steps and outputs when the mode changes.
    (
        "LD M8000\nIST X020 S20 S27\nLD M8002\nSET Y005\nSET S23\nLDI Y005\nOUT Y006\nLDI S23\nOUT Y007\nEND\n",
        &[],
    ),
];

#[test]
fn a_finding_is_given_once_and_not_for_what_is_intended() {
    for (program, expected) in CAUSES {
        let folder = folder(&[("cause.il", program.as_bytes())]);
        let args = [
            "check", "--deep", "--model", "fx2n", "cause.il", "--format", "json",
        ];
        let found = deep_findings(&text(&rungc(folder.path(), &args).stdout));
        let found: Vec<_> = found
            .iter()
            .map(|(code, line, others)| {
                let others: Vec<u64> = others.iter().map(|(_, line)| *line).collect();
                (*code, *line, others)
            })
            .collect();
        let expected: Vec<_> = expected
            .iter()
            .map(|&(code, line, others)| (code, line, others.to_vec()))
            .collect();
        assert_eq!(found, expected, "{program}");
    }
}

/// Two registers each keep the output off: only both together let it come on. The first program's relays are written in
/// every scan, so no panel changes what follows from them.
#[test]
fn what_a_finding_proposes_makes_it_possible() {
    let relays =
        "LD X000\nANI X000\nOUT M1\nLD M1\nOR M2\nANI X001\nOUT M2\nLD M2\nOUT Y000\nEND\n";
    let registers = "\
LD M8002\nMOV K0 D0\nMOV K0 D1\nMOV K0 D2\nLD X000\nMOV D2 D0\nLD= D0 K5\nAND= D1 K5\nOUT Y000\nEND\n";
    let shown = |files: &[(&str, &[u8])]| {
        text(&rungc(folder(files).path(), &["check", "--deep", "p.il"]).stderr)
    };
    let found = shown(&[("p.il", relays.as_bytes())]);
    assert!(
        found.contains("W0901") && !found.contains("[hmi] writes"),
        "{found}"
    );
    let mut named: Vec<String> = Vec::new();
    for _ in 0..3 {
        let settings = format!("[project]\nprogram = \"p.il\"\n[hmi]\nwrites = {named:?}\n");
        let found = shown(&[
            ("p.il", registers.as_bytes()),
            ("rungc.toml", settings.as_bytes()),
        ]);
        let Some((_, proposed)) = found.split_once("`[hmi] writes = ") else {
            assert!(!found.contains("W09"), "{found}");
            return;
        };
        let proposed = proposed.split('`').next().unwrap_or_default();
        let devices = proposed.split('"').skip(1).step_by(2).map(str::to_string);
        let before = named.len();
        named.extend(devices);
        assert!(named.len() > before && !found.contains("Y000,"), "{found}");
    }
    panic!("{named:?} are not enough");
}
