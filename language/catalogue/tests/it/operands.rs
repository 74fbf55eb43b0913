//! Operands of the Mitsubishi models, instruction by instruction, as the tables of their manuals have them.

use rungc_catalogue::{Inst, Param, Rule, find};
use rungc_models::{Model, ModelId};
use rungc_syntax::Classes;

/// An operand by the instruction's name.
fn operand(name: &str, operand: &str, id: ModelId) -> (&'static Inst, &'static Param) {
    let inst = find(name).unwrap_or_else(|| panic!("{name}")).inst;
    let mut params = inst.params_of(&[], Model::get(id)).iter();
    let param = params.find(|param| param.name == operand);
    (inst, param.unwrap_or_else(|| panic!("{name} {operand}")))
}

/// Returns true if the operand may be of these classes on the model.
fn takes(name: &str, of: &str, id: ModelId, classes: Classes) -> bool {
    let (inst, param) = operand(name, of, id);
    let known = param.classes_on(Model::get(id));
    assert!(inst.models.has(id), "{name} {id:?}");
    classes.without(known).is_empty()
}

const REGISTERS: Classes = Classes::D.or(Classes::R);

/// Counts that FX3U takes from D and R (FX3 programming manual, tables of operands; CCD of all models, JY992D88101
/// §5.9.5).
#[test]
fn counts_may_be_in_registers() {
    let fx3u = [
        ("FMOV", "n"),
        ("ROR", "n"),
        ("ROL", "n"),
        ("RCR", "n"),
        ("RCL", "n"),
        ("SFTR", "n2"),
        ("SFTL", "n2"),
        ("WSFR", "n2"),
        ("WSFL", "n2"),
        ("DECO", "n"),
        ("ENCO", "n"),
        ("BON", "n"),
        ("MEAN", "n"),
        ("ANS", "m"),
        ("REFF", "n"),
        ("SER", "n"),
        ("TTMR", "n"),
        ("STMR", "m"),
        ("RAMP", "n"),
        ("SORT", "n"),
        ("ASCI", "n"),
        ("HEX", "n"),
        ("CCD", "n"),
        ("RS", "m"),
        ("RS", "n"),
        ("RS2", "m"),
        ("RS2", "n"),
        ("FROM", "m1"),
        ("FROM", "m2"),
        ("FROM", "n"),
        ("TO", "m1"),
        ("TO", "m2"),
        ("TO", "n"),
        ("WSUM", "n"),
        ("WTOB", "n"),
        ("BTOW", "n"),
        ("UNI", "n"),
        ("DIS", "n"),
        ("SORT2", "m1"),
        ("SORT2", "n"),
        ("CRC", "n"),
        ("BK+", "n"),
        ("BK-", "n"),
        ("BKCMP=", "n"),
        ("RIGHT", "n"),
        ("LEFT", "n"),
        ("INSTR", "n"),
        ("FDEL", "n"),
        ("FINS", "n"),
        ("SFR", "n"),
        ("SFL", "n"),
        ("DUTY", "n1"),
        ("VRRD", "S"),
        ("VRSC", "S"),
    ];
    for (name, of) in fx3u {
        assert!(takes(name, of, ModelId::Fx3u, REGISTERS), "{name} {of}");
    }
    for id in [ModelId::Fx1s, ModelId::Fx1n, ModelId::Fx2n] {
        assert!(takes("CCD", "n", id, Classes::D), "{id:?}");
        assert!(!takes("ENCO", "n", id, Classes::D), "{id:?}");
    }
}

/// Operands of FX3U that buffer memory, `U\G`, can be.
const TAKES_BUFFER: &[(&str, &str)] = &[
    ("MOV", "S"),
    ("ADD", "D"),
    ("ZRST", "D1"),
    ("DECO", "D"),
    ("ENCO", "S"),
    ("ENCO", "D"),
    ("SUM", "S"),
    ("MEAN", "S"),
    ("SQR", "D"),
    ("FLT", "S"),
    ("SER", "S1"),
    ("ABSD", "S1"),
    ("INCD", "S1"),
    ("TKY", "D1"),
    ("HKY", "D2"),
    ("DSW", "D2"),
    ("SEGD", "D"),
    ("ASC", "D"),
    ("ASCI", "D"),
    ("HEX", "D"),
    ("CCD", "S"),
    ("CCD", "D"),
    ("PID", "S1"),
    ("PID", "S2"),
    ("PID", "D"),
    ("ECMP", "S1"),
    ("EZCP", "S"),
    ("EMOV", "D"),
    ("ESTR", "S2"),
    ("EVAL", "S"),
    ("EVAL", "D"),
    ("EBCD", "S"),
    ("EBCD", "D"),
    ("EBIN", "S"),
    ("EBIN", "D"),
    ("EADD", "S1"),
    ("ESQR", "D"),
    ("ENEG", "D"),
    ("INT", "D"),
    ("SIN", "S"),
    ("WSUM", "S"),
    ("SWAP", "S"),
    ("TCMP", "S"),
    ("TZCP", "S1"),
    ("TADD", "D"),
    ("TRD", "D"),
    ("TWR", "S"),
    ("HTOS", "S"),
    ("CRC", "S"),
    ("CRC", "D"),
    ("LIMIT", "D"),
    ("BAND", "D"),
    ("ZONE", "D"),
    ("SCL", "D"),
    ("LEN", "S"),
    ("$MOV", "D"),
];

/// Operands of FX3U that may be buffer memory, and some that may not (FX3 programming manual, tables of operands).
#[test]
fn buffer_memory_is_taken() {
    for &(name, of) in TAKES_BUFFER {
        assert!(
            takes(name, of, ModelId::Fx3u, Classes::BUFFER),
            "{name} {of}"
        );
    }
    for (name, of) in [
        ("PID", "S3"),
        ("RS", "S"),
        ("FROM", "D"),
        ("SORT2", "S"),
        ("BK+", "S1"),
    ] {
        assert!(
            !takes(name, of, ModelId::Fx3u, Classes::BUFFER),
            "{name} {of}"
        );
    }
    for (name, of) in [("ENCO", "S"), ("CCD", "S"), ("PID", "S1")] {
        assert!(
            !takes(name, of, ModelId::Fx3g, Classes::BUFFER),
            "{name} {of}"
        );
    }
}

/// Operands that index registers cannot be.
#[test]
fn index_registers_are_refused() {
    let refused = [
        ("BAND", "S1"),
        ("LIMIT", "S3"),
        ("ZONE", "D"),
        ("PID", "S1"),
        ("SORT", "S"),
    ];
    for (name, of) in refused {
        assert!(!takes(name, of, ModelId::Fx3u, Classes::Z), "{name} {of}");
    }
    assert!(takes("MUL", "D", ModelId::Fx3u, Classes::Z));
}

/// Speeds in Hz of PLSY and PLSR (FX1S/FX1N/FX2N programming manual II §5.6.8 and §5.6.10, FX3 programming manual §13.8
/// and §13.10). Those of compatible boards are their makers' choice.
#[test]
fn speeds_of_pulse_outputs_are_those_of_the_model() {
    let speeds = |name, id| {
        let (_, param) = operand(name, "S1", id);
        let wide = param.rules.iter().find_map(|rule| match *rule {
            Rule::WideLimits(low, high) => Some((low, high)),
            _ => None,
        });
        wide.unwrap_or(param.limits.ranges()[0])
    };
    for (id, lowest, highest) in [
        (ModelId::Fx1s, 1, 100_000),
        (ModelId::Fx1n, 1, 100_000),
        (ModelId::Fx2n, 2, 20_000),
        (ModelId::Fx3s, 1, 100_000),
        (ModelId::Fx3g, 1, 100_000),
        (ModelId::Fx3u, 1, 200_000),
    ] {
        assert_eq!(speeds("PLSY", id), (lowest, highest), "{id:?}");
        assert_eq!(speeds("PLSR", id), (10, highest), "{id:?}");
    }
    for id in [ModelId::Fx2nCompatible, ModelId::Fx3uCompatible] {
        assert_eq!(speeds("PLSY", id), (0, i32::MAX.into()), "{id:?}");
    }
}
