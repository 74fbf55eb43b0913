//! Coils that are driven at several places: only a result that a later place of the same scan replaces is lost.

use crate::warnings::{judge, judge_on};
use rungc_models::ModelId;

fn lines(programs: &[String]) -> Vec<&str> {
    programs.iter().map(String::as_str).collect()
}

#[test]
fn coils_in_routines() {
    let modes =
        "FEND / P0 / LD X1 / OUT Y0 / OUT T0 K10 / SRET / P1 / LD X2 / OUT Y0 / OUT T0 K20 / SRET";
    let [exclusive, unknown] = [
        "LD X0 / CALL P0 / LDI X0 / CALL P1",
        "LDP X0 / CALL P0 / LDP X3 / CALL P1",
    ]
    .map(|calls| format!("{calls} / {modes}"));
    let both = format!("LD M8000 / CALL P0 / CALL P1 / {modes}");
    let chosen = format!("LD X0 / CALL P0 / LD M8000 / CALL P1 / {modes}");
    let one = "FEND / P0 / LD X2 / OUT Y0 / SRET";
    let [before, after] = [
        "LD X0 / CALL P0 / LD X1 / OUT Y0",
        "LD X1 / OUT Y0 / LD X0 / CALL P0",
    ]
    .map(|main| format!("{main} / {one}"));
    let nested = "LD X0 / CALL P0 / LD X1 / OUT Y0 / FEND / P0 / LD X2 / CALL P1 / SRET / P1 / LD X3 / OUT Y0 / SRET";
    let interrupts =
        "EI / FEND / I001 / LD M8000 / OUT Y0 / IRET / I101 / LD M8001 / OUT Y0 / IRET";
    let read =
        "LD X0 / CALL P0 / LD M0 / OUT Y0 / LD X1 / OUT M0 / FEND / P0 / LD X2 / OUT M0 / SRET";
    let twice = "LD X0 / CALL P0 / LD M0 / OUT Y0 / LD X1 / CALL P0 / FEND / P0 / LD X2 / OUT M0 / LD M0 / OUT Y1 / LD X3 / OUT M0 / SRET";
    let quiet = [
        exclusive.as_str(),
        &unknown,
        &after,
        interrupts,
        read,
        twice,
    ];
    judge("double-coil", &[&both, &chosen, &before, nested], &quiet);
    judge("timer-twice", &[&both, &chosen], &quiet);
}

#[test]
fn coils_that_a_later_one_replaces() {
    let state = |rest: &str| {
        format!(
            "LD M8002 / SET S0 / STL S0 / OUT Y0 / OUT T0 K10 / LD X0 / SET S20 / STL S20 / OUT S0 / RET / {rest}"
        )
    };
    let wrong = [
        state("LD X2 / OUT Y0"),
        "LD X0 / CJ P0 / LD X1 / OUT Y0 / P0 / LD X2 / OUT Y0".to_owned(),
        "LD X0 / CJ P1 / LD X1 / OUT Y0 / LD X2 / OUT Y0 / P1".to_owned(),
        "LD X0 / OUT D0.0 / LD X1 / OUT D0.0".to_owned(),
        // Words and results that hold the coil.
        "LD X0 / OUT Y3 / LD M8000 / MOV D0 K2Y0".to_owned(),
        "LD X0 / MOV D0 K2Y0 / LD X1 / OUT Y3".to_owned(),
        "LD X0 / OUT Y3 / LD M8000 / ZRST Y0 Y7".to_owned(),
        "LD M8000 / CMP D0 K5 M0 / LD X0 / OUT M1".to_owned(),
        "LD M8000 / DECO D0 M0 K3 / LD X0 / OUT M3".to_owned(),
        // Pulses.
        "LD X0 / PLSY K100 K10 Y0 / LD X1 / OUT Y0".to_owned(),
        "LD X1 / OUT Y0 / LD X0 / PWM K10 K100 Y0".to_owned(),
    ];
    let right = [
        format!("LD X2 / OUT Y0 / {}", state("LD X3 / OUT Y1")),
        state("LD Y0 / OR X2 / OUT Y0"),
        state("LD X2 / CJ P0 / LD X3 / OUT Y0 / P0"),
        "LD X2 / OUT Y0 / LD X0 / CJ P0 / LD X1 / OUT Y0 / P0".to_owned(),
        "LD X2 / OUT Y0 / LD X0 / CJ P63 / LD X1 / OUT Y0".to_owned(),
        "LD X0 / OUT D0.0 / LD X1 / OUT D0.1".to_owned(),
        "LD X0 / OUT D0.0 / LD D0.0 / OUT Y0 / LD X1 / OUT D0.0".to_owned(),
        "LD X0 / OUT Y3 / LD X1 / MOV D0 K2Y0".to_owned(),
        "LD X0 / OUT Y3 / LD M8000 / MOVP D0 K2Y0".to_owned(),
        "LD X0 / OUT Y3 / LD X1 / MC N0 M0 / LD M8000 / MOV D0 K2Y0 / MCR N0".to_owned(),
        "LD M8000 / MOV K0 K2Y0 / LD X1 / OUT Y3".to_owned(),
        "LD M8000 / MOV D0 K4M0 / LD M3 / OUT Y0 / LD X1 / OUT M3".to_owned(),
        "LD X0 / PLSY K100 K10 Y0 / LD X1 / OUT Y1".to_owned(),
        "LDI X0 / CJ P0 / LD X0 / PLSY K100 K10 Y0 / P0 / LD X0 / CJ P1 / LD X1 / OUT Y0 / P1"
            .to_owned(),
    ];
    judge("double-coil", &lines(&wrong), &lines(&right));
    judge("timer-twice", &[&state("LD X2 / OUT T0 K20")], &[]);
}

#[test]
fn coils_that_jumps_choose_between() {
    let halves = |first: &str, second: &str| {
        [
            // After FEND.
            format!("LD X0 / CJ P1 / {first} / FEND / P1 / {second} / FEND"),
            // In a routine.
            format!(
                "LD M8000 / CALL P0 / FEND / P0 / LD X0 / CJ P1 / {first} / SRET / P1 / {second} / SRET"
            ),
            // With a jump back to the main program, and to its end.
            format!(
                "LD X0 / CJ P1 / {first} / P2 / LD X6 / OUT Y6 / FEND / P1 / {second} / LD X7 / CJ P2 / FEND"
            ),
            format!("LD X0 / CJ P1 / {first} / LD X7 / CJ P63 / FEND / P1 / {second}"),
        ]
    };
    for (warning, first, second) in [
        ("double-coil", "LD X1 / OUT Y0", "LD X2 / OUT Y0"),
        ("timer-twice", "LD X1 / OUT T0 K10", "LD X2 / OUT T0 K20"),
        ("double-coil", "LD M8000 / MOV D0 K2Y0", "LD X2 / OUT Y0"),
        ("double-coil", "LD X1 / PLSY K100 K10 Y0", "LD X2 / OUT Y0"),
        (
            "out-and-set",
            "LD X1 / SET Y0 / LD X3 / RST Y0",
            "LD X2 / OUT Y0",
        ),
    ] {
        judge(warning, &[], &lines(&halves(first, second)));
        // In one half, and in one half and after both.
        let both = format!("{first} / {second}");
        judge(warning, &lines(&halves(&both, "LD X4 / OUT Y4")), &[]);
        let [.., after] = halves("LD X4 / OUT Y4", &both);
        let joined = format!(
            "LD X0 / CJ P1 / {first} / P2 / {second} / FEND / P1 / LD X4 / OUT Y4 / LD X7 / CJ P2 / FEND"
        );
        judge(warning, &[&after], &[&joined]);
    }
    // HM has jumps with an index register.
    let table = "LD M8000 / CJ P0V0 / P0 / LD X0 / OUT Y0 / FEND / P1 / LD X1 / OUT Y0";
    judge_on(
        ModelId::Hm,
        "double-coil",
        &[&format!("{table} / LD X2 / OUT Y0")],
        &[table],
    );
    let timer = "P0 / LD X1 / OUT T0 K10 / LD T0 / OUT Y0 / SRET";
    let call = "LD M8000 / CALL P0";
    judge(
        "timer-in-routine",
        &[&format!(
            "LD X0 / CJ P1 / {call} / FEND / P1 / LD X5 / OUT Y5 / FEND / {timer}"
        )],
        &[&format!(
            "LD X0 / CJ P1 / {call} / FEND / P1 / {call} / FEND / {timer}"
        )],
    );
}

#[test]
fn results_that_a_later_coil_replaces() {
    let then = |first: &str, coil: &str| format!("{first} / LD X1 / OUT {coil}");
    let wrong = [
        then("LD M8000 / SEGD D0 K2Y0", "Y0"),
        then("LD M8000 / BMOV D0 K4M0 K1", "M0 / LD M0 / OUT Y0"),
        then("LD M8000 / FROM K0 K0 K4M0 K1", "M3"),
        then("LD X0 / ALTP Y0", "Y0"),
        then("LD X0 / ALTP M0 / LD M0 / OUT Y0", "M0"),
        then("LD X0 / SFTLP X1 Y0 K8 K1", "Y3"),
        then("LD M8000 / DHSCS K5 C235 Y0", "Y0"),
        then("LD X0 / DRVI K100 K100 Y0 Y4", "Y4"),
        "LD X0 / OUT Y3 / LD M8000 / SUM D0 K2Y0".to_owned(),
    ];
    let right = [
        // The source, unless BMOV may go backwards.
        then("LD M8000 / BMOV K4M0 D0 K1", "M0 / LD M0 / OUT Y0"),
        // A coil that feeds a shift register, and the values of a timer.
        then("LD X0 / SFTLP M15 M0 K16 K1", "M0"),
        then("LD X0 / MOVP D0 T0", "T0 K10"),
        then("LD X0 / INCP D0", "D0.1"),
        // What is written at times only.
        "LD X0 / OUT Y3 / LD M8000 / FROM K0 K0 K2Y0 K1".to_owned(),
        "LD X0 / OUT Y4 / LD X1 / DRVI K100 K100 Y0 Y4".to_owned(),
        "LD X0 / OUT Y3 / LD M8000 / SEGD D0 K2Y0".to_owned(),
    ];
    judge("double-coil", &lines(&wrong), &lines(&right));
    let backwards = "LD X7 / OUT M8024 / LD M8000 / BMOV K4M0 D0 K1 / LD X1 / OUT M0";
    judge("double-coil", &[backwards], &[]);
    judge(
        "timer-twice",
        &[],
        &["LD X0 / MOVP D0 C0 / LD X1 / OUT C0 K10"],
    );
}

#[test]
fn outputs_that_are_refreshed_between_their_coils() {
    let first = "LD X0 / OUT Y0";
    let second = "LD X1 / OUT Y0";
    let routine = "FEND / P0 / LD M8000 / REF Y0 K8 / SRET";
    let wrong = [
        format!("{first} / REF Y10 K8 / {second}"),
        format!("{first} / REF X0 K8 / {second}"),
        format!("{first} / {second} / REF Y0 K8"),
        format!("LD M8000 / CALL P0 / {first} / {second} / {routine}"),
        format!("{first} / LD Y0 / OUT Y1 / {second}"),
    ];
    let right = [
        format!("{first} / REF Y0 K8 / {second}"),
        format!("{first} / LDI X2 / REFP Y0 K16 / {second}"),
        format!("{first} / LD M8000 / CALL P0 / {second} / {routine}"),
        format!("{first} / REF Y0 K8 / LD M8000 / MOV D0 K2Y0"),
    ];
    judge("double-coil", &lines(&wrong), &lines(&right));
}

#[test]
fn results_of_relays_between_their_coils() {
    let last = "LD M6 / OUT Y0 / LD X2 / OUT M6";
    let routine = format!("LD X0 / OUT M6 / {last} / SRET");
    let wrong = [
        // Read before the first coil: the relay is carried from scan to scan.
        format!("LD X0 / OR M6 / ANI X1 / OUT M6 / {last}"),
        format!("LD M6 / OUT Y1 / LD X0 / OUT M6 / {last}"),
        format!("LD M6 / SET Y1 / LD M8002 / ZRST M0 M9 / LD X0 / OUT M6 / {last}"),
        "LD M3 / OUT Y1 / LD M8000 / MOV D0 K4M0 / LD M3 / OUT Y0 / LD X1 / OUT M3".to_owned(),
        format!("LD M8000 / CALL P1 / FEND / P1 / LDI M6 / OUT Y1 / {routine}"),
    ];
    let right = [
        // Written before it is read: intermediate results.
        format!("LD X0 / OUT M6 / {last}"),
        format!("LD X0 / OUT M6 / {last} / LD M6 / OUT Y1"),
        format!("LD M8002 / SET M6 / LD M6 / OUT Y1 / LD X0 / OUT M6 / {last}"),
        format!("LD M8000 / MOV D1 K2M0 / LD M6 / OUT Y1 / LD X0 / OUT M6 / {last}"),
        "LD X0 / OUT M6 / LD M6 / OUT Y0 / LD X2 / OR M6 / OUT M6".to_owned(),
        format!("LD M8000 / CALL P1 / LD M6 / OUT Y1 / FEND / P1 / {routine}"),
        // Another bit of the register.
        "LD D0.3 / OUT Y1 / LD X0 / OUT D0.1 / LD D0.1 / OUT Y0 / LD X1 / OUT D0.1".to_owned(),
    ];
    judge("double-coil", &lines(&wrong), &lines(&right));
    let set = "LD X0 / SET M6 / LD M6 / OUT Y0 / LD X2 / OUT M6";
    judge(
        "out-and-set",
        &[&format!("LD M6 / OUT Y1 / {set}")],
        &[set, &format!("{set} / LD M6 / OUT Y1")],
    );
}

#[test]
fn timers_of_routines_that_every_scan_runs() {
    let timer = "FEND / P0 / LD X1 / OUT T0 K10 / LD T0 / OUT Y0 / SRET";
    let calls = |calls: &str| format!("{calls} / {timer}");
    let nested = |calls: &str| {
        format!(
            "{calls} / FEND / P1 / LD M8000 / CALL P0 / SRET / {}",
            &timer[7..]
        )
    };
    let right = [
        calls("LD M8000 / CALL P0"),
        calls("LD X0 / CALL P0 / LDI X0 / CALL P0"),
        calls("LD M0 / CALL P0 / LDI M0 / CALL P0 / LD X0 / OUT M0"),
        calls("LD M0 / CJ P5 / LD M8000 / CALL P0 / P5 / LDI M0 / CJ P6 / LD M8000 / CALL P0 / P6"),
        nested("LD M8000 / CALL P1"),
    ];
    let wrong = [
        calls("LD X0 / CALL P0"),
        calls("LD M8000 / CALLP P0"),
        calls("LD X0 / MC N0 M9 / LD M8000 / CALL P0 / MCR N0"),
        calls("LD X0 / CALL P0 / LDI X2 / CALL P0"),
        calls("LD M0 / CALL P0 / LD X0 / OUT M0 / LDI M0 / CALL P0"),
        calls("LD X0 / CJ P5 / LD M8000 / CALL P0 / P5"),
        nested("LD X0 / CALL P1"),
    ];
    judge("timer-in-routine", &lines(&wrong), &lines(&right));
}

#[test]
fn coils_in_branches_that_run_at_the_same_time() {
    let ladder = |first: &str, second: &str, set: &str| {
        format!(
            "LD M8002 / SET S0 / STL S0 / LD X0 / SET S20 / {set}SET S30 / STL S20 / {first} / LD X1 / SET S21 / STL S21 \
             / STL S30 / {second} / LD X2 / SET S31 / STL S31 / STL S21 / STL S31 / LD X3 / SET S40 / STL S40 / LD X5 \
             / OUT Y0 / OUT T1 K5 / LD X6 / OUT S0 / RET / LD M0 / OUT Y7"
        )
    };
    let wrong = [
        ladder("OUT Y0", "LD X4 / OUT Y0", ""),
        ladder("OUT M0", "LD X4 / OUT M0", ""),
    ];
    let right = [
        // On while either is.
        ladder("LD X4 / OUT Y0", "OUT Y0", ""),
        ladder("OUT Y1", "LD X4 / OUT Y2", ""),
        ladder("OUT M0", "LD M0 / OUT Y1 / LD X4 / OUT M0", ""),
        // One of the two, and after both.
        ladder("OUT Y0", "LD X4 / OUT Y0", "LD X7 / "),
        ladder("OUT Y0", "OUT T1 K10", ""),
    ];
    judge("double-coil", &lines(&wrong), &lines(&right));
    let timers = ladder("OUT T0 K10", "OUT T0 K20", "");
    judge(
        "timer-twice",
        &[&timers],
        &[&ladder("OUT T0 K10", "OUT T0 K20", "LD X7 / ")],
    );
}
