//! Learning codes from an export: whichever codes of a program are not known, the list of the same program supplies
//! them.

use crate::fixture::wpg;
use proptest::prelude::*;
use rungc_frontend::{
    Lesson, Mismatch, Read, ReadOptions, learn, print, read_bytes, read_bytes_with,
};

/// Tokens of an instruction: its body, then its operands.
type Tokens = Vec<Vec<u8>>;

/// Instructions with the bodies of their tokens.
fn instruction() -> impl Strategy<Value = Tokens> {
    let number = 0..100_u8;
    let d = |number: u8| vec![0xA8, number];
    let k = |number: u8| vec![0xE8, number];
    prop_oneof![
        number.clone().prop_map(|n| vec![vec![0x00], vec![0x90, n]]),
        number.clone().prop_map(|n| vec![vec![0x20], vec![0x9D, n]]),
        Just(vec![vec![]]),
        number
            .clone()
            .prop_map(move |n| vec![vec![0x4C, 5, 0], k(n), d(n)]),
        number
            .clone()
            .prop_map(move |n| vec![vec![0x4A, 3, 0, 2], d(n)]),
        number.clone().prop_map(move |n| vec![
            vec![0x63, 9, 0x16],
            k(n),
            k(1),
            vec![0x9C, 0],
            vec![0x9D, 0]
        ]),
        number.clone().prop_map(move |n| vec![
            vec![0x49, 0x0D, 0x30],
            d(n),
            vec![0xEC, 0xCD, 0xCC, 0xCC, 0x3D],
            d(4)
        ]),
        number.prop_map(|n| vec![vec![0x3C], vec![0xD0, n]]),
    ]
}

/// A body that is not known, of the same length in steps, for one that is hidden.
fn hidden(body: &[u8]) -> Option<Vec<u8>> {
    match *body {
        [family, steps, index, ref rest @ ..] => {
            Some([&[family, steps, index | 0x80], rest].concat())
        }
        _ => None,
    }
}

fn project(program: &[Tokens]) -> Read {
    let end: &[u8] = &[0x34];
    let bodies = program.iter().flatten().map(Vec::as_slice);
    let bodies: Vec<&[u8]> = bodies.chain([end]).collect();
    read_bytes("MAIN.wpg", &wpg(0x0208, &bodies)).unwrap()
}

/// The list that an editor would export of a program.
fn export(program: &[Tokens]) -> Read {
    let read = project(program);
    assert!(!read.diagnostics.has_errors(), "{:?}", read.diagnostics);
    read_bytes("MAIN.csv", &print::to_csv(&read.program)).unwrap()
}

fn lessons(project: &Read, export: &Read) -> Result<Vec<Lesson>, Mismatch> {
    learn(project, export, |a, b| a == b)
}

proptest! {
    /// Whichever instructions are hidden, each code is learned, and read from then on.
    #[test]
    fn hidden_codes_are_learned(
        program in proptest::collection::vec((instruction(), any::<bool>()), 0..30),
    ) {
        let known: Vec<Tokens> = program.iter().map(|(tokens, _)| tokens.clone()).collect();
        let mut bodies = Vec::new();
        let strange = program.into_iter().map(|(mut tokens, hide)| {
            if let Some(code) = hidden(&tokens[0]).filter(|_| hide) {
                bodies.push(code.clone());
                tokens[0] = code;
            }
            tokens
        });
        let strange: Vec<Tokens> = strange.collect();
        bodies.sort();
        bodies.dedup();
        let export = export(&known);
        let learned = lessons(&project(&strange), &export).unwrap();
        let codes: Vec<_> = learned.iter().map(|lesson| lesson.code.clone()).collect();
        prop_assert_eq!(codes, bodies);
        let mut options = ReadOptions::default();
        for lesson in &learned {
            options.learned.insert(&lesson.code, &lesson.mnemonic).unwrap();
        }
        let end = vec![vec![0x34]];
        let bytes: Vec<&[u8]> = strange.iter().chain([&end]).flatten().map(Vec::as_slice).collect();
        let again = read_bytes_with("MAIN.wpg", &wpg(0x0208, &bytes), &options).unwrap();
        prop_assert!(!again.diagnostics.has_errors());
        let texts = |read: &Read| -> Vec<String> {
            read.program.instrs.iter().map(ToString::to_string).collect()
        };
        prop_assert_eq!(texts(&again), texts(&export));
    }

    /// A list that lacks an instruction, or has another one, teaches nothing.
    #[test]
    fn other_lists_teach_nothing(
        program in proptest::collection::vec(instruction(), 1..20),
        at in any::<prop::sample::Index>(),
        other in instruction(),
        remove in any::<bool>(),
    ) {
        let at = at.index(program.len());
        let mut changed = program.clone();
        match remove {
            true => drop(changed.remove(at)),
            false => changed[at] = other,
        }
        let texts = |read: &Read| -> Vec<String> {
            let instrs = read.program.instrs.iter().filter(|instr| instr.mnemonic != "NOP");
            instrs.map(ToString::to_string).collect()
        };
        let (right, wrong) = (export(&program), export(&changed));
        prop_assume!(texts(&right) != texts(&wrong));
        let strange: Vec<Tokens> = program
            .iter()
            .map(|tokens| {
                let mut tokens = tokens.clone();
                if let Some(code) = hidden(&tokens[0]) {
                    tokens[0] = code;
                }
                tokens
            })
            .collect();
        // Hidden operands may be anything of their length; all else must be unchanged.
        match lessons(&project(&strange), &wrong) {
            Err(_) => {}
            Ok(learned) => {
                let original = hidden(&program[at][0]);
                prop_assert!(original.is_some());
                prop_assert!(learned.iter().any(|lesson| Some(&lesson.code) == original.as_ref()));
            }
        }
    }
}
