//! Programs of several files, and the tasks that run them.

use rungc_models::{Model, ModelId};
use rungc_structured::compile;
use rungc_syntax::{Diagnostics, Program, Source, SourceKind};

/// The program of some files.
fn program(files: &[(&str, &str)], model: ModelId) -> (Program, Diagnostics) {
    let files = files
        .iter()
        .map(|(path, text)| ((*path).to_owned(), (*text).to_owned()));
    let mut program = Program {
        source: Source::joined("line", files),
        kind: SourceKind::StructuredText,
        unread: vec![0],
        ..Program::default()
    };
    let found = compile(&mut program, Model::get(model));
    (program, found)
}

/// The list of some files, or what is wrong, with its places.
fn compiled(files: &[(&str, &str)], model: ModelId) -> String {
    let (program, found) = program(files, model);
    let source = &program.source;
    let place = |at: u32| {
        let (line, column) = source.line_col(at);
        let path = source.part(at).map_or("", |part| &part.path);
        format!("{path}:{line}:{column}")
    };
    let mut lines: Vec<String> = found
        .iter()
        .map(|one| {
            let others = one.others.iter();
            let others =
                others.map(|other| format!("; {} at {}", other.text, place(other.span.start)));
            let others: String = others.collect();
            format!(
                "{} {}: {}{others}",
                one.code,
                place(one.span.start),
                one.message
            )
        })
        .collect();
    lines.extend(program.instrs.iter().map(ToString::to_string));
    lines.join("\n")
}

const GLOBAL: (&str, &str) = (
    "labels/Global.st",
    "VAR_GLOBAL\n    Start AT X0 : BOOL;\n    Level AT D0 : INT;\nEND_VAR\n",
);
const TWICE: (&str, &str) = (
    "Twice.st",
    "FUNCTION Twice : INT\nVAR_INPUT N : INT; END_VAR\nTwice := N + N;\nEND_FUNCTION\n",
);
const LAMP: (&str, &str) = (
    "Lamp.st",
    "FUNCTION_BLOCK Lamp\nVAR_INPUT On : BOOL; END_VAR\nVAR_OUTPUT Light : BOOL; END_VAR\n\
     Light := On;\nEND_FUNCTION_BLOCK",
);
const FIRST: (&str, &str) = (
    "First.st",
    "PROGRAM First\nVAR Local : Lamp; Own : BOOL; END_VAR\n\
     Local(On := Start, Light => Own);\nLevel := Twice(Level);\nEND_PROGRAM\n",
);
const SECOND: (&str, &str) = (
    "Second.st",
    "PROGRAM Second\nVAR Own : BOOL; END_VAR\nOwn := Start;\nY1 := Own;\nEND_PROGRAM\n",
);

#[test]
fn units_of_all_files_are_one_program() {
    let (program, found) = program(&[FIRST, GLOBAL, LAMP, SECOND, TWICE], ModelId::Fx3u);
    assert_eq!(found.iter().count(), 0, "{found:?}");
    let list: Vec<_> = program.instrs.iter().map(ToString::to_string).collect();
    insta::assert_snapshot!(list.join("\n"));
    // Labels of one name stand after their programs.
    let comments: Vec<_> = program.comments.values().collect();
    insta::assert_snapshot!(format!("{comments:?}"));
}

#[test]
fn tasks_state_the_order() {
    let tasks = "CONFIGURATION Line\n    TASK Slow(PRIORITY := 9);\n    TASK Fast(PRIORITY := 1, INTERVAL := T#50ms);\n    \
                 PROGRAM First WITH Slow;\n    PROGRAM Second WITH Fast : Second;\nEND_CONFIGURATION\n";
    let files = [FIRST, GLOBAL, LAMP, SECOND, TWICE, ("tasks.st", tasks)];
    insta::assert_snapshot!(compiled(&files, ModelId::Fx3u));
    // Without timers of 10 ms.
    let found = compiled(&files, ModelId::Fx1s);
    assert!(
        found.starts_with("E0209 tasks.st:3:42: no timer of 10 ms is left"),
        "{found}"
    );
}

#[test]
fn mistakes_are_reported_in_their_files() {
    let tasks = "CONFIGURATION Line\nTASK T1(PRIORITY := Level, SINGLE := X3, OFTEN := 1);\nTASK t1;\n\
                 PROGRAM First WITH Gone;\nPROGRAM Ladder WITH T1;\nPROGRAM First;\nEND_CONFIGURATION\n";
    let again = "(* open\n*)\nFUNCTION Twice : INT\nTwice := 1;\nEND_FUNCTION\nVAR_GLOBAL Level : INT; END_VAR\n";
    let open = "FUNCTION Open : INT\nOpen := Missing;\n(* never closed";
    let files = [
        FIRST,
        GLOBAL,
        LAMP,
        TWICE,
        ("Again.st", again),
        ("Open.st", open),
    ];
    insta::assert_snapshot!(compiled(&files, ModelId::Fx3u));
    let files = [FIRST, GLOBAL, LAMP, TWICE, SECOND, ("tasks.st", tasks)];
    insta::assert_snapshot!(compiled(&files, ModelId::Fx3u));
}
