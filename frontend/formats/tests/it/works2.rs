//! Projects of GX Works2: which of its parts a program is read from, and the diagnostics of the others.

use crate::fixture;
use crate::fixture::{
    Part, chart, gh, ladder, prj, project, qcd, replace, res, simple, sources, structured_text,
    tsk, wpa,
};
use rungc_frontend::{Read, ReadOptions, read_bytes, read_bytes_with};
use rungc_syntax::{Device, DeviceClass, DeviceRun, SourceKind};

/// `LD X001 / OUT Y001 / END` with a statement in the project's code page.
const NEW: &[&[u8]] = &[
    b"\x80\x00N\xEDvel",
    &[0x00],
    &[0x9C, 1],
    &[0x20],
    &[0x9D, 1],
    &[0x34],
];
/// `LDI X002 / OUT Y002 / END`.
const OLD: &[&[u8]] = &[&[0x01], &[0x9C, 2], &[0x20], &[0x9D, 2], &[0x34]];
/// `LD X003 / AND X004 / OUT Y003 / END`: the longest.
const OLDEST: &[&[u8]] = &[
    &[0x00],
    &[0x9C, 3],
    &[0x0C],
    &[0x9C, 4],
    &[0x20],
    &[0x9D, 3],
    &[0x34],
];

fn texts(read: &Read) -> Vec<String> {
    read.program
        .instrs
        .iter()
        .map(ToString::to_string)
        .collect()
}

fn codes(read: &Read) -> Vec<&'static str> {
    read.diagnostics.iter().map(|found| found.code).collect()
}

/// Diagnostics, and the program that was read.
fn reported(parts: &[Part], options: &ReadOptions) -> String {
    let read = read_bytes_with("press.gxw", &project(parts), options).unwrap();
    let line = |found: &rungc_syntax::Diagnostic| {
        let help = found.help.as_deref().unwrap_or("");
        let place = read.program.source.slice(found.span);
        format!(
            "{} `{place}` {}\n  / {}\n  / {help}\n",
            found.code, found.message, found.label
        )
    };
    let findings: String = read.diagnostics.iter().map(line).collect();
    format!("{findings}---\n{}", texts(&read).join("\n"))
}

fn read(parts: &[Part]) -> Read {
    read_bytes("press.gxw", &project(parts)).unwrap()
}

fn compiled() -> ReadOptions {
    ReadOptions {
        compiled: true,
        ..ReadOptions::default()
    }
}

#[test]
fn a_converted_ladder_is_read_with_all_that_belongs_to_it() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    replace(&mut parts, "MAIN.res", res(2, NEW, OLDEST));
    replace(
        &mut parts,
        "COMMENT.qcd",
        qcd(&[(0x9C, 1, "cảm biến 1"), (0xA8, 10, "速度")]),
    );
    let latched = [2, 0, 0x90, 0, 12, 2, 0xF4, 1, 0xA8, 0, 0x38, 1, 0xC8, 0];
    let blocks: &[(u16, &[u8])] = &[(0x2001, &latched), (0xFFE0, &[16, 0]), (0xFFE2, &[2, 0])];
    replace(&mut parts, "Param.wpa", wpa(0x0208, blocks));
    let read = read(&parts);
    assert_eq!(codes(&read), [""; 0]);
    assert_eq!(texts(&read), ["LD X001", "OUT Y001", "END"]);
    let program = read.program;
    assert_eq!(program.kind, SourceKind::GxWorks2);
    assert_eq!(program.title.as_deref(), Some("press"));
    assert_eq!(program.cpu.as_deref(), Some("FX3U/FX3UC"));
    assert_eq!(program.instrs[0].statement(), Some("Nível"));
    let comments: Vec<_> = program
        .comments
        .iter()
        .map(|(d, c)| format!("{d} {c}"))
        .collect();
    assert_eq!(comments, ["X001 cảm biến 1", "D10 速度"]);
    let parameters = program.parameters.unwrap();
    let run = |class, first, count| DeviceRun {
        class,
        first,
        count,
    };
    let latched = [run(DeviceClass::M, 500, 524), run(DeviceClass::D, 200, 312)];
    assert_eq!(parameters.latched.as_deref(), Some(&latched[..]));
    assert_eq!(
        (parameters.capacity, parameters.program_steps()),
        (Some(16000), Some(15000))
    );
}

#[test]
fn a_ladder_that_was_changed_is_taken_and_reported() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    replace(&mut parts, "MAIN.res", res(2, OLD, OLDEST));
    insta::assert_snapshot!(
        "ladder_that_was_changed",
        reported(&parts, &ReadOptions::default())
    );
    insta::assert_snapshot!("compiled_on_purpose", reported(&parts, &compiled()));
}

#[test]
fn a_ladder_that_was_never_compiled_is_read() {
    let end: &[&[u8]] = &[&[0x34]];
    for code in [&[], end] {
        let mut parts = simple("FX3U/FX3UC", NEW);
        replace(&mut parts, "MAIN.res", res(2, code, OLDEST));
        let read = read(&parts);
        assert_eq!(texts(&read), ["LD X001", "OUT Y001", "END"]);
        assert_eq!(codes(&read), [""; 0]);
    }
}

#[test]
fn of_two_copies_the_whole_one_is_taken() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    let mut damaged = ladder(8, NEW);
    let at = damaged.len() - 20 - 7;
    damaged[at] ^= 0x40;
    replace(&mut parts, "MAIN.Program.pou", damaged);
    let read = read(&parts);
    assert_eq!(texts(&read), ["LD X001", "OUT Y001", "END"]);
    assert_eq!(codes(&read), ["W0522"]);
}

#[test]
fn structured_text_is_read_as_compiled() {
    let text = "(* Y77 *) Motor := X1 AND NOT (K4M0 > D0);";
    let mut parts = simple("FX3G", OLD);
    parts.push(Part {
        name: "Global1.gh",
        content: gh(&[("auto", ""), ("motor", "Y001")]),
    });
    replace(&mut parts, "MAIN.Program.pou", structured_text(8, text));
    insta::assert_snapshot!(
        "stale_structured_text",
        reported(&parts, &ReadOptions::default())
    );
    insta::assert_snapshot!(
        "stale_structured_text_on_purpose",
        reported(&parts, &compiled())
    );
    replace(
        &mut parts,
        "MAIN.Program.pou",
        structured_text(8, "Y2 := NOT x2;"),
    );
    insta::assert_snapshot!(
        "structured_text_of_unknown_age",
        reported(&parts, &ReadOptions::default())
    );
    replace(&mut parts, "MAIN.res", res(9, OLD, &[]));
    insta::assert_snapshot!(
        "structured_text_of_known_age",
        reported(&parts, &ReadOptions::default())
    );
    replace(&mut parts, "MAIN.res", res(9, &[&[0x34]], OLD));
    insta::assert_snapshot!(
        "structured_text_not_compiled",
        reported(&parts, &ReadOptions::default())
    );
    insta::assert_snapshot!("nothing_compiled_on_purpose", reported(&parts, &compiled()));
}

/// A note about the age of the compiled program is answered for one state of the project, by its own words.
#[test]
fn the_age_of_a_compiled_program_can_be_confirmed() {
    let parts = |code: &[&[u8]], text: &str| {
        let mut parts = simple("FX3G", code);
        replace(&mut parts, "MAIN.Program.pou", structured_text(8, text));
        project(&parts)
    };
    let found = |project: &[u8], state: Option<&str>| {
        let options = ReadOptions {
            compiled_state: state.map(str::to_string),
            ..ReadOptions::default()
        };
        let read = read_bytes_with("press.gxw", project, &options).unwrap();
        let found = read.diagnostics.iter().next().expect("a note");
        (
            found.code,
            found.help.as_deref().unwrap_or_default().to_string(),
        )
    };
    let this = parts(OLD, "Y2 := NOT x2;");
    let (code, help) = found(&this, None);
    assert_eq!(code, "N0012");
    let state = help.split('"').nth(1).expect("a state");
    assert_eq!(found(&this, Some(state)).0, "N0010");
    assert_eq!(found(&this, Some("0123456789abcdef")).0, "N0012");
    // The next change of the source or of the compiled program is another state.
    let changed = parts(OLD, "Y2 := NOT X2 ;");
    assert_eq!(found(&changed, Some(state)).0, "N0012");
    let compiled: &[&[u8]] = &[
        &[0x01],
        &[0x9C, 2],
        &[0x20],
        &[0x9D, 2],
        &[0x20],
        &[0x9D, 3],
        &[0x34],
    ];
    assert_eq!(
        found(&parts(compiled, "Y2 := NOT x2;"), Some(state)).0,
        "N0012"
    );
}

#[test]
fn drawings_and_labels_are_read_as_compiled() {
    for (source, what) in [
        (sources::diagram(1, &[]), "structured ladder or FBD"),
        (chart(1), "SFC"),
        (
            ladder(1, &[&[0x00], b"\xDFstart", &[0x34]]),
            "a ladder with labels",
        ),
    ] {
        let mut parts = simple("FX3U/FX3UC", OLD);
        replace(&mut parts, "MAIN.Program.pou", source);
        let read = read(&parts);
        assert_eq!(texts(&read), ["LDI X002", "OUT Y002", "END"]);
        let found = read.diagnostics.iter().next().unwrap();
        assert_eq!(found.code, "N0010");
        // What else the project holds is a note; a ladder without a table of labels holds nothing else.
        let others = codes(&read).split_off(1);
        assert!(others.iter().all(|code| *code == "N0013"), "{others:?}");
        assert_eq!(
            found.message,
            format!("`MAIN` is {what}: it is shown as compiled")
        );
    }
}

#[test]
fn several_programs_are_read_in_the_order_of_their_tasks() {
    let first: &[&[u8]] = &[&[0x00], &[0x9C, 1], &[0x20], &[0x9D, 1], &[0x34]];
    let both = [&first[..4], OLD].concat();
    let parts = |compiled: &[&[u8]]| {
        let part = |name, content| Part { name, content };
        vec![
            part("press.prj", prj("", "FX3U/FX3UC", 936)),
            part("MAIN.res", res(2, compiled, &[])),
            part("T1.tsk", tsk(&["First", "Second"])),
            part("First.Program.pou", ladder(8, first)),
            part("Second.程序.pou", ladder(8, OLD)),
            part("Third.Program.pou", ladder(8, OLDEST)),
        ]
    };
    let read = read(&parts(&both));
    assert_eq!(
        texts(&read),
        ["LD X001", "OUT Y001", "LDI X002", "OUT Y002", "END"]
    );
    assert_eq!(codes(&read), ["N0010", "N0011"]);
    insta::assert_snapshot!(
        "one_of_several_was_changed",
        reported(&parts(OLD), &ReadOptions::default())
    );
}

#[test]
fn program_files_that_do_not_run_are_named() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    let part = |name, content| Part { name, content };
    parts.insert(0, part("OTHER.res", res(2, OLD, &[])));
    parts.insert(0, part("OTHER.tsk", tsk(&["OTHER"])));
    parts.push(part("OTHER.Program.pou", ladder(2, OLD)));
    parts.push(part("Block.Program.pou", ladder(2, OLD)));
    insta::assert_snapshot!(
        "program_files_left_out",
        reported(&parts, &ReadOptions::default())
    );
}

#[test]
fn other_families_are_refused_by_name() {
    for cpu in ["Q03UDV", "L02", "A2SH"] {
        let read = read(&simple(cpu, NEW));
        assert_eq!(codes(&read), ["E0018"]);
        let found = read.diagnostics.iter().next().unwrap();
        assert!(found.message.contains(cpu), "{}", found.message);
        assert!(read.program.instrs.is_empty());
    }
}

#[test]
fn damaged_parts_beside_the_program_are_reported() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    let comments = qcd(&[(0x9C, 1, "start"), (0xA8, 10, "speed")]);
    replace(
        &mut parts,
        "COMMENT.qcd",
        comments[..comments.len() - 4].to_vec(),
    );
    let mut parameters = wpa(0x0208, &[(0xFFE0, &[16, 0]), (0x2001, &[9, 0])]);
    parameters.extend([0; 4]);
    replace(&mut parts, "Param.wpa", parameters);
    insta::assert_snapshot!("damaged_parts", reported(&parts, &ReadOptions::default()));
    let read = read(&parts);
    let start = Device {
        class: DeviceClass::X,
        number: 1,
    };
    assert_eq!(read.program.comments[&start], "start");
    assert_eq!(read.program.parameters.unwrap().capacity, Some(16000));
}

#[test]
fn without_a_list_the_program_is_found_by_its_bytes() {
    let parts = simple("FX3U/FX3UC", NEW);
    let bytes = fixture::with_list(b"<D_Projectdata", &parts);
    let read = read_bytes("press.gxw", &bytes).unwrap();
    assert_eq!(codes(&read), ["W0522"]);
    assert_eq!(texts(&read), ["LD X001", "OUT Y001", "END"]);
    let mut parts = parts;
    replace(&mut parts, "MAIN.res", vec![1, 2, 3]);
    replace(&mut parts, "MAIN.Program.pou", vec![1, 2, 3]);
    insta::assert_snapshot!("nothing_to_read", reported(&parts, &ReadOptions::default()));
}

#[test]
fn a_chosen_encoding_replaces_the_stated_one() {
    let options = ReadOptions {
        encoding: Some(encoding_rs::WINDOWS_1251),
        ..ReadOptions::default()
    };
    let bytes = project(&simple("FX3U/FX3UC", NEW));
    let read = read_bytes_with("press.gxw", &bytes, &options).unwrap();
    assert_eq!(read.program.instrs[0].statement(), Some("Nнvel"));
}

#[test]
fn a_protected_project_is_not_read() {
    let mut parts = simple("FX3U/FX3UC", NEW);
    for (keyword, is_protected) in [(b"        ", false), (b"12345678", true)] {
        let parameters = wpa(0x0208, &[(0xFFE0, &[16, 0]), (0xFFE4, keyword)]);
        replace(&mut parts, "Param.wpa", parameters);
        let found = reported(&parts, &ReadOptions::default());
        assert_eq!(found.contains("E0650"), is_protected, "{found}");
        if is_protected {
            insta::assert_snapshot!("protected", found);
        }
    }
}
