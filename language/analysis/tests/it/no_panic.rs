//! Checking never panics, whatever the program.

use proptest::prelude::*;
use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_frontend::read_text;
use rungc_models::{Model, ModelId};

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
        "ZRST S0 S4294967295",
        "ZRST M4294967295 M0",
        "MOV K1 D4294967295",
        "DMOV K1 D4294967295",
        "FMOV K1 D4294967295 K512",
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
    fn no_program_makes_it_panic(
        lines in prop::collection::vec(line(), 0..80),
        model in prop::sample::select(ModelId::ALL.to_vec()),
    ) {
        let read = read_text("test", &lines.join("\n"));
        let (resolved, _) = resolve(&read.program, Model::get(model));
        check(&resolved);
    }
}
