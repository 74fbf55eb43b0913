//! Standard blocks, REAL values and whole programs as the interpreter runs them.

use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, NoHal, Plc, Program as _};
use rungc_syntax::{Program, Source, SourceKind};

/// The module of a text, without errors on the way.
fn module(text: &str, model: ModelId) -> Module {
    let mut program = Program {
        source: Source::new("a.st", text),
        kind: SourceKind::StructuredText,
        unread: vec![0],
        ..Program::default()
    };
    let found = rungc_structured::compile(&mut program, Model::get(model));
    assert_eq!(found.iter().count(), 0, "{found:?}");
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    compiled
        .module
        .unwrap_or_else(|| panic!("{model:?}: {:?}", compiled.diagnostics))
}

/// Scans every 50 ms from one time to another, with X0 on or off.
fn hold(machine: &mut Machine, x0: bool, (from, to): (u32, u32)) {
    machine.set_bit(Class::X, 0, x0);
    for now in (from..=to).step_by(50) {
        machine.scan(&mut NoHal, now, 10_000);
    }
}

#[test]
fn timers_switch_at_their_times() {
    let text = "PROGRAM P\nVAR\n    On : TON;\n    Off : TOF;\n    Pulse : TP;\nEND_VAR\n\
         On(IN := X0, PT := T#500ms, Q => Y0);\nOff(IN := X0, PT := T#500ms, Q => Y1);\n\
         Pulse(IN := X0, PT := T#500ms, Q => Y2);\n\
         DMOV(TRUE, On.ET, D0);\nDMOV(TRUE, Off.ET, D2);\nDMOV(TRUE, Pulse.ET, D4);\nEND_PROGRAM\n";
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    let mut after = |x0, times| {
        hold(&mut machine, x0, times);
        let outputs = [0, 1, 2].map(|number| machine.output(number));
        (
            outputs,
            [0, 2, 4].map(|number| machine.word(Class::D, number).unwrap()),
        )
    };
    assert_eq!(after(false, (0, 200)), ([false; 3], [0; 3]));
    let (outputs, _) = after(true, (250, 600));
    assert_eq!(outputs, [false, true, true]);
    assert_eq!(
        after(true, (650, 900)),
        ([true, true, false], [500, 0, 500])
    );
    let (outputs, times) = after(false, (950, 1200));
    assert_eq!(outputs, [false, true, false]);
    assert_eq!([times[0], times[2]], [0, 0]);
    assert_eq!(after(false, (1250, 1600)), ([false; 3], [0, 500, 0]));
    // The pulse lasts when its input is short, and does not begin again while it runs.
    assert_eq!(after(true, (1650, 1650)).0, [false, true, true]);
    assert!(after(false, (1700, 1900)).0[2]);
    assert!(after(true, (1950, 2000)).0[2]);
    assert!(!after(true, (2050, 2400)).0[2]);
    // An edge right after the last pulse begins another.
    after(false, (2450, 2450));
    assert!(after(true, (2500, 2500)).0[2]);
}

#[test]
fn counters_and_flip_flops() {
    let text = "PROGRAM P\nVAR\n    Both : CTUD;\n    First : SR;\n    Second : RS;\nEND_VAR\n\
         Both(CU := X0, CD := X1, R := X2, LD := X3, PV := 3, QU => Y0, QD => Y1, CV => D0);\n\
         First(S1 := X0, R := X1, Q1 => Y2);\nSecond(S := X0, R1 := X1, Q1 => Y3);\nEND_PROGRAM\n";
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    let mut inputs = |on: &[u32]| {
        for number in 0..4 {
            machine.set_bit(Class::X, number, on.contains(&number));
        }
        machine.scan(&mut NoHal, 0, 10_000);
        let outputs = [0, 1, 2, 3].map(|number| machine.output(number));
        (machine.word(Class::D, 0).unwrap(), outputs)
    };
    assert_eq!(inputs(&[]), (0, [false, true, false, false]));
    assert_eq!(inputs(&[0]), (1, [false, false, true, true]));
    assert_eq!(inputs(&[0]).0, 1);
    assert_eq!(inputs(&[1]), (0, [false, true, false, false]));
    assert_eq!(inputs(&[3]), (3, [true, false, false, false]));
    // Both edges at once count nothing; SR and RS differ.
    assert_eq!(inputs(&[0, 1]), (3, [true, false, true, false]));
    assert_eq!(inputs(&[2]).0, 0);
}

#[test]
fn real_values_and_large_unsigned_ones() {
    let text = "PROGRAM P\nVAR\n    r AT D10 : REAL;\n    s AT D12 : REAL;\n    u AT D20 : DWORD;\n    \
         uu AT D22 : DWORD;\n    w AT D24 : WORD;\nEND_VAR\n\
         r := INT_TO_REAL(D0) / 4.0;\ns := MAX(r, 0.5) * 2.0;\nY0 := r > 1.0 AND r <= 2.5;\nY1 := r = s OR r < 0.0;\n\
         D1 := REAL_TO_INT(LIMIT(0.0, s, 9.0));\nD2 := REAL_TO_INT(SQRT(16.0 + r - r));\n\
         u := 16#80000000;\nuu := SHR(u, 31);\nY2 := u > uu;\nw := 50000;\nY3 := w > 3;\nD3 := WORD_TO_INT(w / 1000);\n\
         END_PROGRAM\n";
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    let mut with = |value| {
        machine.set_word(Class::D, 0, value);
        machine.scan(&mut NoHal, 0, 10_000);
        let outputs = [0, 1, 2, 3].map(|number| machine.output(number));
        (
            outputs,
            [1, 2, 3, 22].map(|number| machine.word(Class::D, number).unwrap()),
        )
    };
    assert_eq!(with(6), ([true, false, true, true], [3, 4, 50, 1]));
    assert_eq!(with(-8), ([false, true, true, true], [1, 4, 50, 1]));
    assert_eq!(with(100), ([false, false, true, true], [9, 4, 50, 1]));
}

/// All models have the instructions that these lists need; only REAL values and rotations need more.
#[test]
fn all_models_run_blocks_arrays_and_structures() {
    let text = "TYPE Pair :\nSTRUCT\n    a : INT;\n    b : BOOL;\n    c : DINT;\nEND_STRUCT\nEND_TYPE\n\
         FUNCTION Half : INT\nVAR_INPUT\n    n : INT;\nEND_VAR\nHalf := n / 2;\nEND_FUNCTION\n\
         PROGRAM P\nVAR\n    All : ARRAY [0..3] OF Pair;\n    Bits : ARRAY [0..3] OF BOOL;\n    One : Pair;\n    \
         Delay : TON;\n    Rise : R_TRIG;\n    Count : CTU;\n    n : INT;\nEND_VAR\n\
         FOR n := 0 TO 3 DO\n    All[n].a := Half(n * 4);\n    All[n].b := n = 2;\n    Bits[n] := All[n].b;\n    \
         All[n].c := MAX(INT_TO_DINT(All[n].a), 3) + 100000;\nEND_FOR;\n\
         One := All[2];\nDelay(IN := X0, PT := T#1s, Q => Y0);\nRise(CLK := X0);\n\
         Count(CU := Rise.Q, R := FALSE, PV := 1, Q => Y1);\nD0 := One.a;\nY2 := One.b AND Bits[2];\n\
         DMOV(TRUE, One.c, D2);\nD1 := SEL(Y2, LIMIT(0, D0, 3), ABS(-7 * D0));\nEND_PROGRAM\n";
    for model in [
        ModelId::Fx1s,
        ModelId::Fx1n,
        ModelId::Fx2n,
        ModelId::Fx3s,
        ModelId::Fx3g,
        ModelId::Fx3u,
    ] {
        let module = module(text, model);
        let mut machine = Machine::new(&module);
        hold(&mut machine, true, (0, 1500));
        let outputs = [0, 1, 2].map(|number| machine.output(number));
        assert_eq!(outputs, [true; 3], "{model:?}");
        let words = [0, 1, 2, 3].map(|number| machine.word(Class::D, number).unwrap());
        assert_eq!(words, [4, 28, (100_004 % 65_536) as i16, 1], "{model:?}");
        assert_eq!(machine.last_error().code, 0, "{model:?}");
    }
}

#[test]
fn the_example_mixes() {
    let text = include_str!("../../../../examples/programs/mixer.st");
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    let mut now = 0;
    let mut after = |machine: &mut Machine, on: &[u32], ms: u32| {
        for number in 0..3 {
            machine.set_bit(Class::X, number, on.contains(&number));
        }
        for _ in 0..ms / 10 {
            machine.scan(&mut NoHal, now, 10_000);
            now += 10;
        }
        [0, 1, 2].map(|number| machine.output(number))
    };
    for (number, weight) in [(10, 100), (11, 200), (12, 300), (13, 400)] {
        machine.set_word(Class::D, number, weight);
    }
    assert_eq!(after(&mut machine, &[1], 100), [false; 3]);
    assert_eq!(machine.word(Class::D, 20), Some(250));
    assert_eq!(after(&mut machine, &[0, 1], 100), [true, false, false]);
    assert_eq!(after(&mut machine, &[1, 2], 2900), [false, true, false]);
    assert_eq!(after(&mut machine, &[1, 2], 200), [false, false, true]);
    assert_eq!(after(&mut machine, &[1, 2], 2000), [false; 3]);
    assert_eq!(machine.word(Class::D, 0), Some(1));
}

/// The programs of the book's page compile without findings, for a PLC too.
#[test]
fn programs_of_the_book_compile() {
    let page = include_str!("../../../../docs/src/structured-text.md");
    let programs = page.split("```text ").skip(1).filter_map(|block| {
        let (name, rest) = block.split_once('\n')?;
        let (program, _) = rest.split_once("```")?;
        name.ends_with(".st").then_some(program)
    });
    let programs: Vec<_> = programs.collect();
    assert_eq!(programs.len(), 4);
    for program in programs {
        module(program, ModelId::Fx3u);
    }
}

#[test]
fn structures_nest_and_instances_have_members() {
    let text = "TYPE Outer :\nSTRUCT\n    one : Inner;\n    all : ARRAY [1..2] OF Inner;\nEND_STRUCT\n\
         Inner :\nSTRUCT\n    n : INT;\n    f : ARRAY [0..3] OF BOOL;\nEND_STRUCT\nEND_TYPE\n\
         FUNCTION_BLOCK Counter\nVAR_INPUT\n    Step : INT;\nEND_VAR\nVAR_OUTPUT\n    Sum : INT;\nEND_VAR\n\
         VAR\n    Last : Inner;\nEND_VAR\nSum := Sum + Step;\nLast.n := Step;\nEND_FUNCTION_BLOCK\n\
         PROGRAM P\nVAR\n    o : Outer;\n    up : Counter;\nEND_VAR\n\
         o.all[D0].n := 5;\no.all[D0].f[D1] := TRUE;\nY0 := o.all[2].f[3];\nY1 := o.all[2].f[2];\n\
         o.one.n := D0;\no.one := o.all[o.one.n];\nD2 := o.one.n;\n\
         up(Step := D2 + 1);\nD3 := up.Sum;\nD4 := up.Last.n;\n\
         END_PROGRAM\n";
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    machine.set_word(Class::D, 0, 2);
    machine.set_word(Class::D, 1, 3);
    for _ in 0..2 {
        machine.scan(&mut NoHal, 0, 10_000);
    }
    assert_eq!([0, 1].map(|number| machine.output(number)), [true, false]);
    let words = [2, 3, 4].map(|number| machine.word(Class::D, number).unwrap());
    assert_eq!(words, [5, 12, 6]);
}

#[test]
fn blocks_in_arrays_are_instances() {
    let text = "FUNCTION_BLOCK Pair\nVAR_INPUT\n    Go : BOOL;\nEND_VAR\nVAR_OUTPUT\n    Sum : INT;\nEND_VAR\n\
         VAR\n    Up : ARRAY [1..2] OF CTU;\nEND_VAR\nUp[1](CU := Go, PV := 9);\n\
         Up[2](CU := Go AND X7, PV := 9);\nSum := Up[1].CV * 10 + Up[2].CV;\nEND_FUNCTION_BLOCK\n\
         PROGRAM P\nVAR CONSTANT\n    Last : INT := 1;\nEND_VAR\nVAR\n    All : ARRAY [0..Last, -1..0] OF Pair;\nEND_VAR\n\
         All[0, -1](Go := X0);\nAll[Last, 0](Go := X1);\nD0 := All[0, -1].Sum;\nD1 := All[1, 0].Sum;\n\
         D2 := All[0, -1].Up[1].CV;\nEND_PROGRAM\n";
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    for scan in 0..6 {
        let is_on = scan % 2 == 1;
        machine.set_bit(Class::X, 0, is_on);
        machine.set_bit(Class::X, 1, is_on && scan > 1);
        machine.set_bit(Class::X, 7, scan > 4);
        machine.scan(&mut NoHal, 0, 10_000);
    }
    let words = [0, 1, 2].map(|number| machine.word(Class::D, number).unwrap());
    assert_eq!(words, [31, 21, 3]);
}

#[test]
fn functions_change_what_they_are_given_to_change() {
    let text = "FUNCTION Change : BOOL\nVAR_IN_OUT\n    A, B : INT;\n    Done : BOOL;\nEND_VAR\nVAR\n    Old : INT;\nEND_VAR\n\
         Old := A;\nA := B;\nB := Old;\nChange := Done;\nDone := TRUE;\nEND_FUNCTION\n\
         PROGRAM P\nVAR\n    All : ARRAY [0..1] OF INT;\n    Was : BOOL;\nEND_VAR\n\
         All[0] := D0;\nAll[1] := D1;\nY0 := Change(All[0], All[1], Done := Was);\nD2 := All[0];\nD3 := All[1];\n\
         Y1 := Was;\nEND_PROGRAM\n";
    for model in [ModelId::Fx1s, ModelId::Fx3u] {
        let module = module(text, model);
        let mut machine = Machine::new(&module);
        machine.set_word(Class::D, 0, 5);
        machine.set_word(Class::D, 1, 7);
        machine.scan(&mut NoHal, 0, 10_000);
        let words = [2, 3].map(|number| machine.word(Class::D, number).unwrap());
        assert_eq!(words, [7, 5], "{model:?}");
        assert_eq!([0, 1].map(|number| machine.output(number)), [false, true]);
        machine.scan(&mut NoHal, 10, 10_000);
        assert_eq!([0, 1].map(|number| machine.output(number)), [true, true]);
    }
}

#[test]
fn members_have_stated_devices() {
    let text = "TYPE Axis :\nSTRUCT\n    On : BOOL;\n    Place : DINT;\n    Was : INT;\n    Now : BOOL;\nEND_STRUCT\nEND_TYPE\n\
         PROGRAM P\nVAR\n    Copy : Axis;\n    First AT (On := X0, Place := D10, Now := Y5) : Axis;\nEND_VAR\n\
         First.Now := First.On;\nFirst.Place := 100000;\nFirst.Was := 7;\nCopy := First;\nD0 := Copy.Was;\n\
         IF Copy.Place = 100000 THEN\n    Y1 := Copy.Now;\nEND_IF;\nEND_PROGRAM\n";

    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    machine.set_bit(Class::X, 0, true);
    machine.scan(&mut NoHal, 0, 10_000);
    assert_eq!([1, 5].map(|number| machine.output(number)), [true; 2]);
    let words = [0, 10, 11].map(|number| machine.word(Class::D, number).unwrap());
    assert_eq!(words, [7, (100_000 % 65_536) as u16 as i16, 1]);
}

/// The text in the registers from `first` on.
fn text_of(machine: &Machine, first: u32) -> String {
    let words = (first..first + 20).map(|number| machine.word(Class::D, number).expect("a word"));
    let bytes = words.flat_map(i16::to_le_bytes);
    let bytes = bytes.take_while(|byte| *byte != 0);
    bytes.map(char::from).collect()
}

#[test]
fn texts_are_in_labels_of_all_kinds() {
    let text = "TYPE Recipe : STRUCT Name : STRING(9); Count : INT; END_STRUCT; END_TYPE\n\
         FUNCTION Shown : STRING(20)\nVAR_INPUT What : STRING(9); Number : INT; END_VAR\n\
         Shown := CONCAT(What, ':', INT_TO_STRING(Number));\nEND_FUNCTION\n\
         FUNCTION_BLOCK Last\nVAR_INPUT In : STRING(20); END_VAR\nVAR_OUTPUT Out : STRING(20); END_VAR\n\
         VAR Old : STRING(20); END_VAR\nIF In <> Old THEN Out := Old; Old := In; END_IF;\nEND_FUNCTION_BLOCK\n\
         PROGRAM P\nVAR CONSTANT Title : STRING(5) := 'Mix'; END_VAR\n\
         VAR\nAll : ARRAY [0..2] OF Recipe;\nOne : Recipe;\nNames : ARRAY [1..3] OF STRING(4);\n\
         Line AT D100 : STRING(20);\nOther AT D120 : STRING(20);\nRaw AT D140 : STRING(8);\nBefore : Last;\n\
         Chosen AT D160 : STRING(9);\nValue AT D180 : REAL;\nEND_VAR\n\
         One.Name := Title;\nOne.Count := D0;\nAll[D1] := One;\nNames[D2] := 'abc';\n\
         Line := Shown(All[D1].Name, All[D1].Count + 1);\nBefore(In := Line, Out => Other);\n\
         Raw := '$R$L\"$$';\nChosen := SEL(Names[3] = 'abc', 'no', Names[3]);\n\
         Y0 := Title = One.Name AND Names[D2] <> '';\nD3 := FIND(Line, ':');\n\
         Value := STRING_TO_REAL('1.5') * 2.0;\nD4 := LEN(REAL_TO_STRING(Value));\n\
         D5 := STRING_TO_INT('12') + STRING_TO_INT('-3') + DINT_TO_INT(STRING_TO_DINT(' 40000') / 1000);\nEND_PROGRAM\n";
    let module = module(text, ModelId::Fx3u);
    let mut machine = Machine::new(&module);
    for (number, value) in [(0, 41), (1, 2), (2, 3)] {
        machine.set_word(Class::D, number, value);
    }
    machine.scan(&mut NoHal, 0, 10_000);
    assert_eq!(text_of(&machine, 100), "Mix:    42");
    assert_eq!(text_of(&machine, 120), "");
    assert_eq!(text_of(&machine, 140), "\r\n\"$");
    assert_eq!(text_of(&machine, 160), "abc");
    assert!(machine.output(0));
    let words = [3, 4, 5].map(|number| machine.word(Class::D, number).unwrap());
    assert_eq!(words, [4, 12, 49]);
    machine.set_word(Class::D, 0, -100);
    machine.scan(&mut NoHal, 10, 10_000);
    assert_eq!(text_of(&machine, 100), "Mix:-   99");
    assert_eq!(text_of(&machine, 120), "Mix:    42");
}
