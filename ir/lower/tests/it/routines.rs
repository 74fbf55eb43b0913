//! Programs with interrupt routines that can never run, and similar ones whose routines do.

use crate::warnings::judge_on;
use rungc_models::ModelId;

/// A program with an interrupt routine.
fn with(main: &str, pointer: &str) -> String {
    format!("EI / {main} / FEND / {pointer} / LD M8000 / INC D1000 / IRET")
}

fn judge(model: ModelId, wrong: &[(&str, &str)], right: &[(&str, &str)]) {
    let programs = |of: &[(&str, &str)]| -> Vec<String> {
        of.iter()
            .map(|(main, pointer)| with(main, pointer))
            .collect()
    };
    let (wrong, right) = (programs(wrong), programs(right));
    let wrong: Vec<&str> = wrong.iter().map(String::as_str).collect();
    let right: Vec<&str> = right.iter().map(String::as_str).collect();
    judge_on(model, "never-requested", &wrong, &right);
}

/// D211 and D261 select the edges that interrupt (hm-motion-controller §5.5.6).
#[test]
fn registers_of_hm_exclude_edges() {
    judge(
        ModelId::Hm,
        &[
            ("NOP", "I100"),
            ("NOP", "I101"),
            ("NOP", "I301"),
            ("LD X0 / MOV H10 D211", "I101"),
            ("LD M8002 / MOV H20 D211", "I100"),
            ("LD M8002 / MOV H11 D211", "I000"),
            ("LD M8002 / MOV H31 D261", "I200"),
            ("LD M8002 / DMOV H200000 D210", "I100"),
            ("LD M8002 / MOV H20 D211 / LD X0 / RST M8035", "I301"),
            ("LD X0 / MOV H10 D211 / LD X1 / RST D211", "I101"),
        ],
        &[
            ("NOP", "I000"),
            ("NOP", "I200"),
            ("LD X0 / MOV H10 D211", "I000"),
            ("LD X0 / MOV H31 D211", "I000"),
            ("LD M8002 / MOV H10 D211", "I100"),
            ("LD M8002 / MOV H20 D211", "I101"),
            ("LD M8002 / MOV H21 D261", "I301"),
            ("LD X0 / MOV H20 D211", "I101"),
            ("LD M8002 / MOV H10 D211 / LD X0 / MOV H20 D211", "I101"),
            ("LD M8002 / DMOV H200000 D210", "I101"),
            // Values that the check does not know.
            ("LD X0 / MOV D1000 D211", "I101"),
            ("LD X0 / MOV K5 D200V0", "I101"),
            // The program requests the routine itself.
            ("LDP X0 / SET M8035", "I101"),
            ("LD M8000 / MOV K4 K2M8032", "I101"),
        ],
    );
}

#[test]
fn routines_of_hm_that_only_relays_request() {
    judge(
        ModelId::Hm,
        &[
            ("NOP", "I001"),
            ("LD X0 / RST M8037", "I201"),
            ("LD X0 / SET M8045", "I020"),
            // On at power-on (hm-motion-controller §5.5.5).
            ("NOP", "I650"),
            ("LD X0 / SET M8057", "I710"),
            ("LD X0 / SET M8041", "I710"),
        ],
        &[
            ("LDP X0 / SET M8033", "I001"),
            ("LDP X0 / OUT M8044", "I020"),
            ("NOP", "I010"),
            ("LD M8000 / OUT C235 K100 / DHSCS K50 C235 M8047 K0", "I050"),
            ("LD M8002 / RST M8056", "I650"),
            ("LD M8002 / MOV K0 K2M8056", "I899"),
            ("LD X0 / OUT M8057", "I710"),
        ],
    );
    let advanced = |main: &str| {
        format!("EI / {main} / FEND / I904 / PROC / LD M8000 / INC D1000 / LD M2 / PEND / PRET")
    };
    judge_on(
        ModelId::Hm,
        "never-requested",
        &[&advanced("LD X0 / SET M8083")],
        &[&advanced("LDP X0 / SET M8084")],
    );
}

#[test]
fn routines_of_comparisons_and_pulses() {
    judge(
        ModelId::H2u,
        &[
            ("LD M8000 / OUT C235 K100", "I010"),
            ("LD M8000 / PLSY K1000 K500 Y0", "I502"),
            ("LD M8000 / MOV K2 D8085", "I507"),
        ],
        &[
            ("LD M8000 / OUT C235 K100 / DHSCS K50 C235 I010", "I010"),
            ("LD M8000 / SET M8090 / PLSY K1000 K500 Y0", "I502"),
            ("LD M8000 / OUT M8084", "I507"),
            ("NOP", "I101"),
            ("NOP", "I650"),
        ],
    );
    // A program without EI has another warning.
    let without = "LD X0 / OUT Y0 / FEND / I010 / LD M8000 / INC D0 / IRET";
    judge_on(ModelId::Fx3u, "never-requested", &[], &[without]);
    judge_on(ModelId::Fx3u, "never-enabled", &[without], &[]);
}
