//! Effects of the passes on lowered programs, and the rejections of the validator.

use rungc_ir::Module;
use rungc_ir::dump::dump;
use rungc_ir::node::{
    Access, Action, Branch, Expr, ExprId, FunctionKind, LabelId, Place, Stmt, TempId,
};
use rungc_ir::validate::validate;
use rungc_ir::walk::statements;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_syntax::DeviceClass;
#[cfg(unix)]
use std::fmt::Write;
#[cfg(unix)]
use std::time::Duration;

fn module(text: &str, optimise: bool) -> Module {
    let read = rungc_frontend::read_text("test.il", text);
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        optimise,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled
        .module
        .unwrap_or_else(|| panic!("{text}: {:#?}", compiled.diagnostics))
}

/// The optimised main program, without the marks of networks.
fn main_of(text: &str) -> String {
    let module = module(text, true);
    assert_eq!(validate(&module), Ok(()));
    let text = dump(&module);
    let begin = text.find("main {").map_or(text.len(), |at| at + 7);
    let end = text[begin..].find("\n}").map_or(0, |at| begin + at);
    text[begin.min(end)..end]
        .lines()
        .map(str::trim)
        .filter(|line| !line.starts_with('#'))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn contacts_that_decide_nothing_vanish() {
    assert_eq!(main_of("LD X0\nAND M8000\nOUT Y0\nEND\n"), "Y000 := X000");
    assert_eq!(main_of("LD X0\nANI M8000\nOUT Y0\nEND\n"), "Y000 := off");
    assert_eq!(main_of("LD X0\nOR X0\nOUT Y0\nEND\n"), "Y000 := X000");
    assert_eq!(main_of("LD X0\nANI X0\nOUT Y0\nEND\n"), "Y000 := off");
    assert_eq!(main_of("LD X0\nINV\nINV\nOUT Y0\nEND\n"), "Y000 := X000");
    assert_eq!(
        main_of("LD= D0 D1\nINV\nOUT Y0\nEND\n"),
        "Y000 := (D0 != D1)"
    );
}

#[test]
fn what_is_never_driven_is_removed() {
    assert_eq!(
        main_of("LD M8001\nSET Y0\nLD X1\nOUT Y1\nEND\n"),
        "Y001 := X001"
    );
    assert_eq!(
        main_of("FOR K10\nLD M8001\nMOV D0 D20\nNEXT\nLD X1\nOUT Y1\nEND\n"),
        "Y001 := X001"
    );
    assert_eq!(
        main_of("LD M8000\nCJ P1\nLD X0\nOUT Y0\nP1\nLD X1\nOUT Y1\nEND\n"),
        "Y001 := X001"
    );
}

#[test]
fn a_value_is_not_moved_behind_a_write_that_changes_it() {
    assert_eq!(
        main_of("LD M0\nOUT M1\nOUT M0\nOUT M2\nLDI M1\nOUT M3\nEND\n"),
        "M1 := M0\nt0 = M0\nM0 := t0\nM2 := t0\nM3 := !M1"
    );
    assert_eq!(
        main_of("LD M0\nINV\nOUT M0\nOUT M1\nEND\n"),
        "t0 = !M0\nM0 := t0\nM1 := t0"
    );
    assert_eq!(
        main_of("LD M8000\nDIV D0 K2 D0\nEND\n"),
        "t0 = D0\nD0 := (t0 / 2)\nD1 := (t0 % 2)"
    );
}

#[test]
fn branches_with_one_condition_are_joined() {
    assert_eq!(
        main_of("LD X0\nSET Y0\nRST Y1\nEND\n"),
        "if X000 {\nY000 := on\nY001 := off\n}"
    );
}

#[test]
fn rungs_of_one_condition_are_one_branch() {
    let first = "LD X0\nAND M0\nSET Y0\n";
    for (next, expected) in [
        (
            "LD X0\nAND M0\nRST Y1\n",
            "if (X000 & M0) {\nY000 := on\nY001 := off\n}",
        ),
        (
            "LD X0\nAND M0\nINV\nSET Y2\nLD X0\nAND M0\nSET Y3\n",
            "if (X000 & M0) {\nY000 := on\n}\nelse {\nY002 := on\n}\nif (X000 & M0) {\nY003 := on\n}",
        ),
    ] {
        assert_eq!(main_of(&format!("{first}{next}END\n")), expected);
    }
    // What changes the condition, or may, ends the branch; so does a statement between two of them.
    for between in ["RST M0\n", "MOV D0 K2M0Z0\n", "SET Y1\nLD X1\nOUT Y2\n"] {
        let text = format!("{first}{between}LD X0\nAND M0\nRST Y1\nEND\n");
        let twice = main_of(&text);
        assert_eq!(twice.matches("if (X000 & M0)").count(), 2, "{twice}");
    }
    // Nothing changes what holds for a whole scan.
    let once = main_of("LD M8002\nCALL P1\nLD M8002\nRST Y1\nFEND\nP1\nLD X0\nOUT M1\nSRET\nEND\n");
    assert_eq!(once.matches("if first_scan").count(), 1, "{once}");
}

/// Calls of the function that takes interrupts, by the networks of `Main` that they are in.
fn taken_at(text: &str) -> Vec<u32> {
    let module = module(text, true);
    let mut functions = module.functions.iter();
    let take = functions.position(|f| f.kind == FunctionKind::TakeInterrupts);
    let take = take.map_or(u32::MAX, |take| take as u32);
    let (mut step, mut found) = (0, Vec::new());
    statements(&module.functions[1].body, &mut |stmt| match stmt {
        Stmt::Network(network) => step = module.networks[*network as usize].step,
        Stmt::CallSub(function) if *function == take => found.push(step),
        _ => {}
    });
    found
}

#[test]
fn pulses_are_caught_where_they_are_noticed() {
    let quiet: String = (0..100)
        .map(|n| format!("LD X{:o}\nOUT M{n}\n", n % 8 + 8))
        .collect();
    let text = format!("EI\n{quiet}LD M8170\nOUT Y0\nLD X1\nRST M8170\n{quiet}END\n");
    // In front of the contact, and of RST.
    assert_eq!(taken_at(&text), [201, 203]);
}

#[test]
fn interrupts_are_taken_where_they_are_noticed_and_once_in_a_while() {
    let quiet: String = (0..100)
        .map(|n| format!("LD X{:o}\nOUT M{n}\n", n % 8 + 8))
        .collect();
    let text =
        |rung: &str| format!("EI\n{quiet}{rung}FEND\nI001\nLD M8000\nINC D0\nOUT Y0\nIRET\nEND\n");
    let without = taken_at(&text(""));
    // A network has two steps.
    assert!(without.windows(2).all(|pair| pair[1] - pair[0] <= 102));
    assert!(without.len() < 6, "{without:?}");
    let notices = taken_at(&text("LD> D0 K10\nOUT Y1\n"));
    assert!(notices.contains(&201), "{notices:?}");
    // A call of the runtime may need the special devices that the routine changes.
    let calls = taken_at(&text("LD X0\nSORT D100 K4 K2 D200 K1\n"));
    assert!(calls.contains(&201), "{calls:?}");
}

#[test]
fn a_value_that_is_known_is_not_computed_again() {
    assert_eq!(
        main_of("LD X0\nAND X1\nOUT Y0\nOUT Y1\nLD X0\nAND X1\nOUT Y2\nOUT Y3\nEND\n"),
        "t0 = (X000 & X001)\nY000 := t0\nY001 := t0\nY002 := t0\nY003 := t0"
    );
    let written_between =
        main_of("LD M0\nAND X1\nOUT Y0\nOUT M0\nLD M0\nAND X1\nOUT Y2\nOUT Y3\nEND\n");
    assert_eq!(written_between.matches("(M0 & X001)").count(), 2);
}

#[test]
fn constants_are_folded() {
    assert_eq!(
        main_of("LD M8000\nADD K2 K3 D0\nDMUL K100000 K100000 D10\nEND\n"),
        "D0 := 5\nD10:32 := 1410065408L\nD12:32 := 2L"
    );
    assert_eq!(
        main_of("LD M8000\nDIV D0 K0 D2\nEND\n"),
        "fault 6706 at step 1"
    );
}

#[test]
fn deep_rungs_are_cut() {
    let mut text = String::from("LD X0\n");
    for i in 0..20_000 {
        text.push_str(&format!("AND M{}\n", i % 7000));
    }
    text.push_str("OUT Y0\nEND\n");
    assert_eq!(validate(&module(&text, true)), Ok(()));
}

/// A valid module with a statement put in front of its main program.
fn with(stmt: impl FnOnce(&mut Module) -> Stmt) -> Result<(), String> {
    let mut module = module("LD X0\nOUT Y0\nEND\n", false);
    assert_eq!(validate(&module), Ok(()));
    let stmt = stmt(&mut module);
    module.functions[1].body.insert(0, stmt);
    validate(&module)
}

fn relay(number: u32) -> Place {
    Place {
        class: DeviceClass::M,
        number,
        index: None,
    }
}

#[test]
fn temporaries_need_a_value() {
    let error = with(|module| {
        module.temps.push(rungc_ir::node::Ty::Bit);
        let temp = module.add(Expr::Temp(TempId(0)));
        Stmt::If(Branch {
            cond: temp,
            then: Vec::new(),
            otherwise: Vec::new(),
        })
    });
    assert!(error.is_err_and(|e| e.contains("not assigned")));
}

#[test]
fn a_value_from_one_branch_is_not_enough() {
    let both = |otherwise: bool| {
        with(|module| {
            module.temps.push(rungc_ir::node::Ty::Bit);
            let on = module.add(Expr::Bit(true));
            let assign = vec![Stmt::Do(Action::Let(TempId(0), on))];
            let branch = Stmt::If(Branch {
                cond: on,
                then: assign.clone(),
                otherwise: if otherwise { assign } else { Vec::new() },
            });
            module.functions[1].body.insert(0, branch);
            let temp = module.add(Expr::Temp(TempId(0)));
            module.functions[1].body.push(Stmt::If(Branch {
                cond: temp,
                then: Vec::new(),
                otherwise: Vec::new(),
            }));
            Stmt::Network(0)
        })
    };
    assert_eq!(both(true), Ok(()));
    assert!(both(false).is_err());
}

#[test]
fn devices_must_be_stored() {
    let error = with(|module| {
        let on = module.add(Expr::Bit(true));
        Stmt::Do(Action::Write(Access::bit(relay(5)), on))
    });
    assert!(error.is_err_and(|e| e.contains("M5 is not stored")));
}

#[test]
fn types_must_agree() {
    let error = with(|module| {
        let word = module.add(Expr::I16(1));
        let pair = module.add(Expr::I32(1));
        let sum = module.add(Expr::Bin(rungc_ir::node::BinOp::Add, word, pair));
        Stmt::Do(Action::Let(TempId(0), sum))
    });
    assert!(error.is_err_and(|e| e.contains("ill typed")));
}

#[test]
fn expressions_use_earlier_ones() {
    let error = with(|module| {
        let next = ExprId(module.exprs.len() as u32);
        module.add(Expr::Not(next));
        Stmt::Network(0)
    });
    assert!(error.is_err_and(|e| e.contains("later")));
}

#[test]
fn jumps_need_their_part_around_them() {
    assert!(with(|_| Stmt::Goto(LabelId(1))).is_err_and(|e| e.contains("not around")));
}

#[test]
fn functions_do_not_recurse() {
    assert!(with(|_| Stmt::CallSub(1)).is_err_and(|e| e.contains("circle")));
    assert!(with(|_| Stmt::CallSub(9)).is_err_and(|e| e.contains("does not exist")));
}

/// A row of stations, five rungs each, and what follows it.
fn stations(count: u32, rungs: impl Fn(u32) -> String, after: &str) -> String {
    let row: String = (0..count).map(rungs).collect();
    main_of(&format!("{row}{after}END\n"))
}

/// Rungs of one station.
fn station(n: u32) -> String {
    let (own, x) = (100 + 10 * n, 2 * n);
    (0..5)
        .map(|j| {
            format!(
                "LD X{x:03o}\nANI M{}\nOR M{own}\nAND M1\nOUT M{}\n",
                own + j,
                own + j
            )
        })
        .collect()
}

#[test]
fn repeated_rungs_become_a_loop() {
    let main = stations(12, station, "");
    assert!(main.starts_with("repeat 12 times: t0 {\n"), "{main}");
    let first =
        "M[100 + 10 * t0] := (((X[0o0 + 2 * t0] & !M[100 + 10 * t0]) | M[100 + 10 * t0]) & M1)";
    assert!(main.contains(first), "{main}");
    assert_eq!(main.lines().count(), 7, "{main}");
}

/// Rungs of one station with a timer, a counter and a register.
fn timed_station(n: u32) -> String {
    let preset = if n < 12 { 50 } else { 70 };
    let (x, d) = (2 * n, 100 + 2 * n);
    format!(
        "{}LD X{x:03o}\nOUT T{n} K{preset}\nLD T{n}\nOUT C{n} D{d}\nLD C{n}\nMOV K3 D{}\nRST C{n}\n",
        station(n),
        d + 1
    )
}

#[test]
fn timers_counters_and_registers_take_part_in_loops() {
    let main = stations(12, timed_station, "");
    assert!(main.starts_with("repeat 12 times: t12 {\n"), "{main}");
    for line in [
        "timer T[0 + 1 * t12] drive X[0o0 + 2 * t12] preset 50\n",
        "counter C[0 + 1 * t12] drive T[0 + 1 * t12] preset D[100 + 2 * t12]\n",
        "D[101 + 2 * t12] := 3\n",
        "hold at 0 C[0 + 1 * t12]\n",
    ] {
        assert!(main.contains(line), "{line}{main}");
    }
}

#[test]
fn edges_take_part_in_loops() {
    let pulsed = |n: u32| format!("{}LDP X{:03o}\nINCP D{n}\n", station(n), 2 * n);
    let main = stations(12, pulsed, "");
    assert!(main.starts_with("repeat 12 times"), "{main}");
    assert!(main.contains(" = rising e[0 + 2 * t"), "{main}");
    assert!(main.contains(" = rising e[1 + 2 * t"), "{main}");
}

#[test]
fn rounds_have_the_same_presets_and_kinds_of_timers() {
    // From the thirteenth station on the preset is another one.
    let main = stations(20, timed_station, "");
    assert!(main.starts_with("repeat 12 times"), "{main}");
    assert!(main.contains("repeat 8 times"), "{main}");
    // After T245, timers keep their values.
    let late = |n: u32| timed_station(n).replace(&format!(" T{n}"), &format!(" T{}", 236 + n));
    let main = stations(12, late, "");
    assert!(main.starts_with("repeat 10 times"), "{main}");
}

#[test]
fn few_rounds_stay_as_written() {
    let main = stations(3, station, "");
    assert!(!main.contains("repeat"), "{main}");
}

#[test]
fn a_round_that_differs_ends_the_loop() {
    let odd = |n: u32| match n {
        12 => station(n).replace("AND M1", "ANI M1"),
        _ => station(n),
    };
    let main = stations(20, odd, "");
    assert!(main.starts_with("repeat 12 times"), "{main}");
    assert!(main.contains("M220 := "), "{main}");
}

#[test]
fn devices_needed_in_a_row_are_no_loop() {
    for after in [
        "LD X0\nMOV D9 Z0\nMOV K1M0Z0 D0\n",
        "LD X0\nBMOV K1M100 K1M200 K2\n",
    ] {
        let main = stations(12, station, after);
        assert!(!main.contains("repeat"), "{main}");
    }
    // Only the first stations are needed so.
    let main = stations(12, station, "LD X0\nMOV K2M104 D0\n");
    assert!(main.contains("repeat 10 times"), "{main}");
    // A single relay of the row may be named in any way.
    let main = stations(12, station, "LD X0\nBON D0 M104 K3\nRST M113\n");
    assert!(main.contains("repeat"), "{main}");
}

#[test]
fn rows_go_on_over_the_border_of_latched_relays() {
    let far = |n: u32| station(n + 30);
    let text: String = (0..16).map(far).collect();
    let module = module(&format!("{text}END\n"), true);
    let text = dump(&module);
    assert!(text.contains("repeat 16 times"), "{text}");
    assert!(text.contains("store M490[5]\n"), "{text}");
    assert!(text.contains("store M500[5] latched\n"), "{text}");
    assert!(
        text.contains("M400[155] in 10 columns, 5 stored\n"),
        "{text}"
    );
}

/// Processor time of this thread, to which other programs do not add.
#[cfg(unix)]
fn worked() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// A second in a release build, where it took minutes when each rung looked for its own iterations.
#[cfg(unix)]
#[test]
fn rungs_that_cannot_be_loops_are_compared_a_few_times_only() {
    let mut text = String::new();
    for i in 0..2000 {
        writeln!(text, "LD M{i}\nAND X0\nOUT M{}", 3 * i).expect("a string");
    }
    for i in 0..20_000 {
        writeln!(text, "LD X{:o}\nOUT M{}\n", i % 7, 7 * i % 7000).expect("a string");
    }
    text.push_str("END\n");
    let begin = worked();
    let module = module(&text, true);
    assert_eq!(module.networks.len(), 22_000);
    let took = worked() - begin;
    assert!(took < Duration::from_secs(60), "{took:?}");
}
