//! Memory of the reset state of timers and counters: only where it can matter.

use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;

/// The program on FX3U.
fn module(text: &str) -> Module {
    let read = rungc_frontend::read_text("test.il", text);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        ..CompileOptions::default()
    };
    compile(&read.program, &options).module.expect(text)
}

/// Names of the flags and tables, and whether an RST holds a counter by its coil.
fn memory(text: &str) -> (Vec<String>, bool) {
    let module = module(text);
    let mut holds = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            holds |= matches!(stmt, Stmt::Do(Action::Reset { holds: true, .. }));
        });
    }
    let flags = module.flags.iter().map(|flag| {
        let retained = if flag.retained { " retained" } else { "" };
        format!("{}{retained}", flag.name)
    });
    let tables = module
        .tables
        .iter()
        .map(|table| format!("{}[{}]", table.name, table.length));
    (flags.chain(tables).collect(), holds)
}

#[test]
fn programs_without_a_reset_state_have_no_memory_of_one() {
    for text in [
        // No RST, no coil, only ZRST.
        "LD X0\nOUT C0 K5\nOUT T250 K5\nEND\n",
        "LD X0\nRST C0\nRST T250\nEND\n",
        "LD X0\nZRST C0 C5\nLD X1\nOUT C0 K5\nEND\n",
        // The coil of another.
        "LD X0\nRST C0\nLD X1\nOUT C1 K5\nEND\n",
    ] {
        assert_eq!(memory(text), (Vec::new(), false), "{text}");
    }
}

#[test]
fn a_counter_whose_coil_and_rst_take_turns_remembers_by_its_coil() {
    for text in [
        "LD X0\nRST C0\nLD X1\nOUT C0 K5\nEND\n",
        "LD X1\nOUT C0 K5\nLD X0\nRST C0\nEND\n",
        "LD X0\nMC N0 M10\nLD X1\nRST C200\nMCR N0\nLD X2\nOUT C200 K5\nEND\n",
        "LD X10\nCALL P1\nFEND\nP1\nLD X0\nRST C0\nLD X1\nOUT C0 K5\nSRET\nEND\n",
    ] {
        assert_eq!(memory(text), (Vec::new(), true), "{text}");
    }
}

#[test]
fn a_timer_whose_rst_comes_first_remembers_its_drive() {
    let text = "LD X0\nRST T250\nLD X1\nOUT T250 K5\nEND\n";
    assert_eq!(memory(text), (Vec::new(), false));
}

#[test]
fn others_take_a_bit() {
    for (text, expected) in [
        // Another routine, a jump, a state, a loop, a second coil, a second RST, a timer before its RST.
        (
            "LD X10\nCALL P1\nLD X1\nOUT C0 K5\nFEND\nP1\nLD X0\nRST C0\nSRET\nEND\n",
            "c0_reset",
        ),
        (
            "LD X10\nCJ P1\nLD X0\nRST C0\nP1\nLD X1\nOUT C0 K5\nEND\n",
            "c0_reset",
        ),
        (
            "STL S20\nLD X0\nRST C0\nSTL S21\nLD X1\nOUT C0 K5\nRET\nEND\n",
            "c0_reset",
        ),
        (
            "LD X0\nRST C0\nFOR K3\nLD X1\nOUT C0 K5\nNEXT\nEND\n",
            "c0_reset",
        ),
        (
            "LD X0\nRST C0\nLD X1\nOUT C0 K5\nLD X2\nOUT C0 K5\nEND\n",
            "c0_reset",
        ),
        (
            "LD X0\nRST C0\nLD X1\nOUT C0 K5\nLD X2\nRST C0\nEND\n",
            "c0_reset",
        ),
        (
            "LD X1\nOUT T250 K5\nLD X0\nRST T250\nEND\n",
            "t250_reset retained",
        ),
        (
            "LD X10\nCALL P1\nLD X1\nOUT C100 K5\nFEND\nP1\nLD X0\nRST C100\nSRET\nEND\n",
            "c100_reset retained",
        ),
    ] {
        assert_eq!(memory(text), (vec![expected.to_string()], false), "{text}");
    }
}

#[test]
fn an_index_takes_a_table_as_long_as_it_reaches() {
    let text = "LD M8000\nMOV K0 Z0\nFOR K4\nLD X0Z0\nOUT C10Z0 K5\nRST C10Z0\nLD M8000\nINC Z0\nNEXT\nEND\n";
    assert_eq!(memory(text).0, ["c_reset[14]"]);
}
