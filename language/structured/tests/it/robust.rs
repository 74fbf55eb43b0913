//! Texts by chance, and texts that nest deep: they are reported, and take neither long nor much of the stack.

use rungc_models::{Model, ModelId};
use rungc_structured::{Known, trial};
use rungc_syntax::codes;
use std::time::{Duration, Instant};

/// Pieces that texts are made of.
const PIECES: [&str; 64] = [
    "PROGRAM P\n",
    "END_PROGRAM\n",
    "VAR\n",
    "END_VAR\n",
    "a : INT;\n",
    "b AT D20 : DINT;\n",
    "IF ",
    " THEN\n",
    "ELSIF ",
    "ELSE\n",
    "END_IF;\n",
    "CASE ",
    " OF\n",
    "1: ",
    "2..5: ",
    "END_CASE;\n",
    "FOR ",
    " TO ",
    " BY ",
    " DO\n",
    "END_FOR;\n",
    "WHILE ",
    "END_WHILE;\n",
    "REPEAT\n",
    "UNTIL ",
    "END_REPEAT;\n",
    "EXIT;\n",
    "RETURN;\n",
    "a",
    "b",
    "X0",
    "Y0",
    "D0",
    "D0.3",
    "K4M0",
    " := ",
    ";\n",
    "(",
    ")",
    " AND ",
    " OR NOT ",
    " + ",
    " / 0",
    "16#FF",
    "T#5s",
    "MOV(X0, ",
    ", ",
    "(* ",
    "TYPE S :\nSTRUCT\n",
    "END_STRUCT\nEND_TYPE\n",
    "s : S;\n",
    "x : ARRAY [0..3] OF S;\n",
    "y AT M0 : ARRAY [0..4_000_000_000] OF BOOL;\n",
    "t : TON;\n",
    "t(IN := ",
    "FUNCTION F : INT\n",
    "END_FUNCTION\n",
    "VAR_INPUT\n",
    "F(",
    "MAX(",
    "y[",
    "]",
    ".a",
    "s := s",
];

/// Compiles a text; each finding has a place in it.
fn tried(text: &str) {
    let tried = trial(text, Model::get(ModelId::Fx1s), &Known::new());
    for found in tried.diagnostics.iter() {
        let range = found.span.range();
        assert!(text.get(range).is_some(), "{found:?} in {text:?}");
    }
}

#[test]
fn texts_by_chance_are_reported() {
    let mut random = fastrand::Rng::with_seed(7);
    let whole = include_str!("../../../../examples/programs/mixer.st");
    for _ in 0..300 {
        let pieces = (0..random.usize(1..40)).map(|_| PIECES[random.usize(0..PIECES.len())]);
        tried(&pieces.collect::<String>());
        let mut damaged = whole.to_owned();
        for _ in 0..random.usize(1..6) {
            let at = random.usize(0..damaged.len());
            let end = (at + random.usize(0..12)).min(damaged.len());
            if damaged.is_char_boundary(at) && damaged.is_char_boundary(end) {
                damaged.replace_range(at..end, PIECES[random.usize(0..PIECES.len())]);
            }
        }
        tried(&damaged);
        let bytes: Vec<u8> = (0..random.usize(0..60)).map(|_| random.u8(..)).collect();
        tried(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn depth_and_length_have_limits() {
    let begin = Instant::now();
    let deep = |open: &str, close: &str, count: usize| {
        let middle = format!("{}X0{}", open.repeat(count), close.repeat(count));
        format!("PROGRAM P\nY0 := {middle};\nEND_PROGRAM\n")
    };
    let nested = |count: usize| {
        let open = "IF X0 THEN\n".repeat(count);
        format!(
            "PROGRAM P\n{open}Y0 := X1;\n{}END_PROGRAM\n",
            "END_IF;\n".repeat(count)
        )
    };
    let code = |text: &str| {
        let tried = trial(text, Model::get(ModelId::Fx3u), &Known::new());
        tried.diagnostics.iter().next().map(|found| found.code)
    };
    let unsupported = Some(codes::ST_UNSUPPORTED.id);
    assert_eq!(code(&deep("(", ")", 40)), None);
    assert_eq!(code(&nested(40)), None);
    assert_eq!(code(&deep("(", ")", 100_000)), unsupported);
    assert_eq!(code(&nested(20_000)), unsupported);
    assert_eq!(code(&deep("NOT ", "", 700)), None);
    assert_eq!(code(&deep("NOT ", "", 100_000)), unsupported);
    assert_eq!(code(&deep("X1 AND ", "", 350)), None);
    assert_eq!(code(&deep("X1 AND ", "", 100_000)), unsupported);
    let elsif = format!(
        "PROGRAM P\nIF X0 THEN\n{}END_IF;\nEND_PROGRAM\n",
        "ELSIF X1 THEN\n".repeat(10_000)
    );
    assert_eq!(code(&elsif), unsupported);
    // Conditions on both sides of `=` are not doubled.
    let equal = deep("X1 = (X2 AND X3) = ", "", 60);
    assert_eq!(code(&equal), None);
    assert!(begin.elapsed() < Duration::from_secs(60));
}
