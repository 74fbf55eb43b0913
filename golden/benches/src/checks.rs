//! Growth of checking with a program's length, on programs that could make a careless check examine everything again
//! and again.

use crate::clock::Clock;
use crate::table::{Cell, Table};
use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_frontend::read_text;
use rungc_models::{Model, ModelId};
use std::fmt::Write;

/// Programs of `n` rungs.
fn hard_programs(n: usize) -> [(&'static str, String); 8] {
    let repeat = |rung: &str| rung.repeat(n);
    let mut labels = String::new();
    let mut relays = String::new();
    for i in 0..n {
        let (label, relay, other) = (i % 4096, i % 7000, i * 7 % 7000);
        // Writing to a String does not fail.
        let _ = writeln!(labels, "LD X0\nCJ P{label}\nP{label}");
        let _ = writeln!(relays, "LD M{relay}\nOUT M{other}\nDMOV D{relay} D{other}");
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

/// Milliseconds to resolve and check a program.
fn milliseconds(text: &str) -> f64 {
    let read = read_text("check", text);
    let clock = Clock::start();
    let (resolved, _) = resolve(&read.program, Model::get(ModelId::Fx3u));
    check(&resolved);
    clock.taken().as_secs_f64() * 1000.0
}

/// The table, of programs of `rungs` rungs and of ten times as many.
pub fn table(rungs: usize) -> Table {
    let mut table = Table::new(
        "Checking of programs that are hard to check",
        &["program", "rungs", "took, ms", "ten times as many", "times"],
    );
    for ((name, short), (_, long)) in hard_programs(rungs).iter().zip(&hard_programs(10 * rungs)) {
        let (one, ten) = (milliseconds(short), milliseconds(long));
        table.row(vec![
            (*name).into(),
            Cell::count(rungs as u64),
            Cell::number(one, 2),
            Cell::number(ten, 2),
            Cell::number(ten / one, 1),
        ]);
    }
    table
}
