//! Machine code against the catalogue: each applied instruction's word follows from its FNC number, and its length is
//! its number of steps.

use rungc_catalogue::{Form, find};
use rungc_frontend::{image, read_bytes, read_text};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;

/// Parameters of a PLC before these words of a program.
fn with_words(words: &[u16]) -> Vec<u8> {
    let empty = read_text("empty.il", "END\n").program;
    let mut bytes = image::write(&empty).unwrap();
    bytes.truncate(image::PARAMETERS);
    bytes.extend(words.iter().copied().flat_map(u16::to_le_bytes));
    bytes
}

#[test]
fn applied_instructions_follow_from_their_numbers() {
    // K0 as often as any instruction has operands.
    let operands = [0x8000; 24];
    let mut known = 0;
    for word in (0x0010..0x0300).chain(0x1010..0x1300) {
        // Contacts have separate words in between.
        if matches!(word, 0x01C2..=0x01CF) {
            continue;
        }
        let words = [&[word][..], &operands, &[0x000F]].concat();
        let read = read_bytes("plc.bin", &with_words(&words)).unwrap();
        let Some(instr) = read.program.instrs.first().filter(|i| i.mnemonic != "END") else {
            continue;
        };
        let found = find(&instr.mnemonic).unwrap_or_else(|| panic!("{word:04X} {instr}"));
        let form = Form {
            wide: word & 1 != 0,
            pulse: word & 0x1000 != 0,
        };
        let (narrow, wide) = found.inst.steps;
        let steps = usize::from(if form.wide { wide } else { narrow });
        let per_operand = if form.wide { 4 } else { 2 };
        assert_eq!(found.inst.fnc, Some(((word & 0xFFF) - 0x10) / 2), "{instr}");
        assert_eq!(found.form, form, "{instr}");
        assert_eq!(steps, 1 + per_operand * instr.operands.len(), "{instr}");
        known += 1;
    }
    assert!(known > 400, "{known} words");
}

#[test]
fn steps_of_machine_code_are_those_of_the_catalogue() {
    let list = "LD X000\nAND M2000\nOR M8300\nLDP X001\nANB\nOUT M0\nOUT M2000\nSET M8034\nSET S20\nRST T0\nRST D5\n\
        OUT T5 K10\nOUT C3 D10\nOUT C220 K70000\nPLS M1\nMC N0 M100\nLD X002\nMOVP K4X000 D0\nDADD D0 K1 D2\n\
        LD= D0 K5\nOUT Y000\nMCR N0\nSTL S20\nRET\nEND\n";
    let program = read_text("steps.il", list).program;
    let read = read_bytes("plc.bin", &image::write(&program).unwrap()).unwrap();
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let about_steps = |code: &str| matches!(code, "E0019" | "W0501");
    let findings: Vec<_> = compiled
        .diagnostics
        .iter()
        .filter(|d| about_steps(d.code))
        .collect();
    assert!(findings.is_empty(), "{findings:#?}");
    assert_eq!(read.program.instrs.len(), 25);
}
