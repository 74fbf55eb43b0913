//! Checking takes time in proportion to a program's length, whatever the program, and never panics.

use proptest::prelude::*;
use rungc_frontend::read_text;
use rungc_ir::check::check;
use rungc_ir::model::{Model, ModelId};
use rungc_ir::resolve::resolve;
use std::fmt::Write;
use std::time::{Duration, Instant};

/// How long it takes to resolve and check a program.
fn time(text: &str) -> Duration {
    let read = read_text("test", text);
    let begin = Instant::now();
    let (resolved, _) = resolve(&read.program, Model::get(ModelId::Fx3u));
    check(&resolved);
    begin.elapsed()
}

/// Programs of `n` rungs that could make a careless check look at everything again and again.
fn hard_programs(n: usize) -> [(&'static str, String); 8] {
    let repeat = |rung: &str| rung.repeat(n);
    let mut labels = String::new();
    let mut relays = String::new();
    for i in 0..n {
        let label = i % 4096;
        writeln!(labels, "LD X0\nCJ P{label}\nP{label}").expect("a string");
        writeln!(
            relays,
            "LD M{}\nOUT M{}\nDMOV D{} D{}",
            i % 7000,
            i * 7 % 7000,
            i % 7000,
            i * 3 % 7000
        )
        .expect("a string");
    }
    [
        (
            "rungs",
            repeat("LD X0\nOR M0\nANI X1\nOUT M0\nADD D0 K1 D0\n"),
        ),
        ("blocks that wait", repeat("LD X0\n")),
        ("branches", repeat("LD X0\nMPS\nOUT Y0\n")),
        ("loops", repeat("FOR K2\n")),
        ("states", repeat("STL S20\nOUT T0 K1\nSET S20\n")),
        ("zones", repeat("LD X0\nMC N0 M0\n")),
        ("labels", labels),
        ("relays", relays),
    ]
}

#[test]
fn time_grows_with_length() {
    let (short, long) = (hard_programs(500), hard_programs(5_000));
    for ((name, short), (_, long)) in short.iter().zip(&long) {
        let (one, ten) = (time(short), time(long));
        let allowed = one * 40 + Duration::from_millis(500);
        assert!(
            ten < allowed,
            "{name}: {one:?} for one, {ten:?} for ten times as much"
        );
    }
}

#[test]
#[ignore = "a measurement: cargo test --release -p rungc-ir --test linear -- --ignored --nocapture"]
fn a_million_steps() {
    for (name, text) in hard_programs(200_000) {
        println!("{name}: {:?}", time(&text));
    }
}

/// Lines of programs, good and bad in every way.
fn line() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "LD X0",
        "LDI M1",
        "LDP X400",
        "AND T0",
        "OR C300",
        "ANB",
        "ORB",
        "INV",
        "MPS",
        "MRD",
        "MPP",
        "OUT Y0",
        "OUT T0 K5",
        "OUT C235 K1",
        "OUT",
        "SET S20",
        "RST D0",
        "PLS M0",
        "MC N0 M10",
        "MC N1 M11",
        "MCR N0",
        "MCR",
        "STL S0",
        "STL S20",
        "RET",
        "FOR K2",
        "FOR",
        "NEXT",
        "CJ P0",
        "CJ P1",
        "CJ P63",
        "CALL P0",
        "CALL P1",
        "CALL P2",
        "P0",
        "P1",
        "P2",
        "P63",
        "P9999",
        "SRET",
        "IRET",
        "I001",
        "I000",
        "I900",
        "EI",
        "DI",
        "FEND",
        "END",
        "NOP",
        "MOV K1 D0",
        "DMOV D7999 D0Z0",
        "BMOV D0 D7999 K512",
        "ZRST M0 M100",
        "ZRST D9 D1",
        "DHSZ D0 K1 C235 M8130",
        "ROTC D0 K10 K2 M0",
        "XYZZY D0",
        "DFOR K1",
        "LD= D0 K5",
        "WAND D0 K1M0 D1",
        "MOV K-32769 D0",
        "SFTL X0 M0 K5 K9",
        "FMOV K0 D0 K0",
        "DECO D0 M0 K99",
    ]);
    word.prop_map(str::to_owned)
}

proptest! {
    #[test]
    fn no_program_makes_it_panic(lines in prop::collection::vec(line(), 0..80), model in prop::sample::select(ModelId::ALL.to_vec())) {
        let read = read_text("test", &lines.join("\n"));
        let (resolved, _) = resolve(&read.program, Model::get(model));
        check(&resolved);
    }
}
