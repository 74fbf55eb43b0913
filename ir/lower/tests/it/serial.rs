//! Constants of serial instructions.

use rungc_frontend::read_text;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::ModelId;
use rungc_syntax::{Severity, codes};

/// Codes of the errors in a driven instruction.
fn errors(model: ModelId, line: &str) -> Vec<&'static str> {
    let text = format!("LD X0\n{line}\nEND\n");
    let read = read_text("program", &text);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let checked = compile::check(&read.program, &options);
    let found = checked.diagnostics.iter();
    found
        .filter(|d| d.severity == Severity::Error)
        .map(|d| d.code)
        .collect()
}

#[test]
fn modbus_requests_name_a_station_a_function_and_a_number_that_fits() {
    use ModelId::{Fx3u, H1u, H2u, Hm, L01s};
    let wrong = [
        (L01s, "ADPRW K0 H6 H64 K0 D0"),
        (L01s, "ADPRW K248 H3 K0 K1 D0"),
        (L01s, "ADPRW K1 H7 K0 K1 D0"),
        (L01s, "ADPRW K1 H3 K0 K126 D0"),
        (L01s, "ADPRW K1 H1 K0 K2001 M0"),
        (L01s, "ADPRW K1 HF K0 K1969 M0"),
        (L01s, "ADPRW K1 H10 K0 K124 D0"),
        (L01s, "ADPRW K1 H3 K0 K0 D0"),
        (Fx3u, "ADPRW K0 H3 K0 K1 D0"),
        (Fx3u, "ADPRW K1 H9 K0 K1 D0"),
        (Fx3u, "ADPRW K1 H4 K0 K126 D0"),
        (H2u, "MODBUS HF803 K0 K1 D0"),
        (H2u, "MODBUS H0107 K0 K1 D0"),
        (H2u, "MODBUS H0003 K0 K1 D0"),
        (H2u, "MODBUS H0103 K0 K126 D0"),
        (H2u, "MODBUS H0103 K0 K0 D0"),
        (H2u, "MODBUS H0110 K0 K121 D0"),
        (H2u, "MODBUS2 HF803 K0 K1 D0 K2"),
        (H2u, "RS HF803 K0 K1 D0"),
        (H1u, "MODBUS H0103 K0 K51 D0"),
        (Hm, "MRDD K248 K0 K1 D1000 K1"),
        (Hm, "MRDD K0 K0 K1 D1000 K1"),
        (Hm, "MRDAI K1 K0 K126 D1000 K1"),
        (Hm, "MRDC K1 K0 K2001 M0 K1"),
        (Hm, "MWRD K248 K0 D1000 K1"),
        (Hm, "MWRCS K1 K0 K1969 M0 K1"),
        (Hm, "MWRDS K1 K0 K124 D1000 K1"),
    ];
    for (model, line) in wrong {
        let found = errors(model, line);
        let one = found == [codes::LIMITS.id] || found == [codes::OPERANDS_DISAGREE.id];
        assert!(one, "{model:?}: {line}: {found:?}");
    }
    let right = [
        (L01s, "ADPRW K247 H3 K0 K125 D0"),
        (L01s, "ADPRW K1 H5 K0 K0 M0"),
        (L01s, "ADPRW D0 H10 K0 K123 D100"),
        (Fx3u, "ADPRW K0 H6 K0 K0 D0"),
        (Fx3u, "ADPRW K1 H8 K0 K300 D0"),
        (H2u, "MODBUS HF703 K0 K125 D0"),
        (H2u, "MODBUS H0006 K0 K0 D0"),
        (H2u, "MODBUS D0 K0 K1 D10"),
        (Hm, "MWRDS K0 K0 K123 D1000 K1"),
    ];
    for (model, line) in right {
        assert_eq!(errors(model, line), [""; 0], "{model:?}: {line}");
    }
}

#[test]
fn calls_reject_words_of_counters() {
    let line = "DMEAN C200V0 D1000 K2";
    assert_eq!(errors(ModelId::Hm, line), [codes::NOT_IMPLEMENTED.id]);
}
