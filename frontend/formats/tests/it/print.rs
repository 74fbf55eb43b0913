//! Written programs read back unchanged.

use proptest::collection::{btree_map, vec};
use proptest::option;
use proptest::prelude::*;
use rungc_frontend::{Read, print, read_bytes, read_text};
use rungc_syntax::{
    Device, DeviceClass, Index, Instr, Operand, OperandKind, Program, Remarks, Span,
};

fn device() -> impl Strategy<Value = Device> {
    let class = proptest::sample::select(DeviceClass::ALL.to_vec());
    (class, any::<u32>()).prop_map(|(class, number)| Device { class, number })
}

fn bit_device() -> impl Strategy<Value = Device> {
    use DeviceClass::{M, S, X, Y};
    (proptest::sample::select(vec![X, Y, M, S]), 0..9000_u32)
        .prop_map(|(class, number)| Device { class, number })
}

fn index() -> impl Strategy<Value = Option<Index>> {
    let class = proptest::sample::select(vec![DeviceClass::V, DeviceClass::Z]);
    option::of((class, 0..8_u32).prop_map(|(class, number)| Index { class, number }))
}

fn text() -> impl Strategy<Value = String> {
    "[ -~À-ÿ一-丏ぁ-ゖ！-～]{0,12}"
}

fn kind() -> impl Strategy<Value = OperandKind> {
    prop_oneof![
        (device(), index()).prop_map(|(d, i)| OperandKind::Device(d, i)),
        (device(), 0..16_u8, index()).prop_map(|(d, b, i)| OperandKind::WordBit(d, b, i)),
        (1..=8_u8, bit_device(), index()).prop_map(|(n, d, i)| OperandKind::Nibbles(n, d, i)),
        (any::<i32>(), index()).prop_map(|(v, i)| OperandKind::Decimal(v.into(), i)),
        (any::<u32>(), index()).prop_map(|(v, i)| OperandKind::Hex(v.into(), i)),
        any::<f32>().prop_filter_map("a constant", OperandKind::float),
        "[ -~Ａ-Ｚ　\\t\\x01\\x1b\\x7f\u{85}]{0,12}".prop_map(|t| OperandKind::Text(t.into())),
        (any::<u32>(), any::<u32>(), index()).prop_map(|(module, address, index)| {
            OperandKind::Buffer {
                module,
                address,
                index,
            }
        }),
    ]
}

/// Comment text in the form that programs hold.
fn comment() -> impl Strategy<Value = Option<String>> {
    text()
        .prop_map(|t| t.trim().to_owned())
        .prop_map(|t| (!t.is_empty()).then_some(t))
}

fn instr() -> impl Strategy<Value = Instr> {
    let mnemonics = [
        "LD", "DADDP", "LD>=", "ANDD<>", "BKCMP=P", "$MOV", "BK-", "RD3A", "P12", "I001", "LOG10",
    ];
    let statement = vec(comment(), 0..3).prop_map(|lines| {
        let lines: Vec<_> = lines.into_iter().flatten().collect();
        (!lines.is_empty()).then(|| lines.join("\n").into())
    });
    let operands = vec(kind(), 0..5);
    (
        proptest::sample::select(mnemonics.to_vec()),
        operands,
        option::of(any::<u32>()),
        statement,
        comment(),
    )
        .prop_map(|(mnemonic, kinds, step, statement, note)| {
            let label = mnemonic == "P12" || mnemonic == "I001";
            let operands = kinds.into_iter().map(|kind| Operand {
                span: Span::default(),
                kind,
            });
            Instr {
                mnemonic: mnemonic.into(),
                mnemonic_span: Span::default(),
                operands: operands.filter(|_| !label).collect(),
                span: Span::default(),
                step,
                remarks: Remarks::new(statement, note.map(Into::into)),
            }
        })
}

prop_compose! {
    fn program()(
        // A row with a colon may name the CPU.
        title in comment().prop_filter("title", |title| !title.iter().any(|title| title.contains([':', '：']))),
        cpu in option::of("FX[0-46-9A-Z/][0-9A-Z/]{0,9}"),
        instrs in vec(instr(), 0..20),
        comments in btree_map(device(), text().prop_filter("clean", |t| !t.is_empty() && t.trim() == t), 0..5),
    ) -> Program {
        let comments = comments.into_iter().collect();
        Program { title, cpu, instrs, comments, ..Program::default() }
    }
}

/// The instructions without their places.
fn unplaced(program: &Program) -> Vec<Instr> {
    let mut instrs = program.instrs.clone();
    for instr in &mut instrs {
        (instr.span, instr.mnemonic_span) = Default::default();
        instr
            .operands
            .iter_mut()
            .for_each(|operand| operand.span = Span::default());
    }
    instrs
}

fn check(read: &Read, written: &Program) -> Result<(), TestCaseError> {
    let findings: Vec<_> = read.diagnostics.iter().collect();
    prop_assert!(findings.is_empty(), "{findings:?}");
    prop_assert_eq!(unplaced(&read.program), unplaced(written));
    prop_assert_eq!(&read.program.title, &written.title);
    prop_assert_eq!(&read.program.cpu, &written.cpu);
    Ok(())
}

/// The same list, written carelessly: a line in each of these ways, over and over.
fn rag(list: &str, ways: &[u8]) -> String {
    let end = if ways[0] == 0 { "\r\n" } else { "\n" };
    let lines = list.lines().zip(ways.iter().cycle());
    let lines = lines.map(|(line, way)| match way {
        0 => format!("\t{line}  "),
        1 => format!("{line}{end}{end}  "),
        2 if !line.contains([';', '"']) => line.to_lowercase(),
        3 if !line.contains([';', '"']) => line.replace(' ', "  "),
        4 if !line.contains([';', '"']) => format!("{line},"),
        _ => line.to_owned(),
    });
    lines.map(|line| line + end).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_printed_list_reads_back(program in program()) {
        let read = read_text("a.il", &print::to_il(&program));
        check(&read, &program)?;
        prop_assert_eq!(&read.program.comments, &program.comments);
    }

    #[test]
    fn a_list_that_is_laid_out_means_the_same(program in program(), ragged in vec(0..6_u8, 1..20)) {
        let source = read_text("a.il", &rag(&print::to_il(&program), &ragged));
        check(&source, &program)?;
        let laid_out = print::lay_out(&source.program);
        let again = read_text("a.il", &laid_out.text);
        check(&again, &program)?;
        prop_assert_eq!(&again.program.comments, &program.comments);
        let second = print::lay_out(&again.program);
        prop_assert_eq!(&second.text, &laid_out.text);
        prop_assert!(second.changes.is_empty(), "{:?}", second.changes);
        prop_assert_eq!(laid_out.changes.is_empty(), laid_out.text == source.program.source.text);
    }

    #[test]
    fn a_printed_export_reads_back(program in program()) {
        let read = read_bytes("MAIN.csv", &print::to_csv(&program)).expect("an export is text");
        check(&read, &program)?;
    }
}

#[test]
fn comments_are_read_from_beside_an_export() {
    let folder = tempfile::tempdir().unwrap();
    let source = read_text(
        "a.il",
        ";! X000 = start button\n;! D10 = 速度\nLD X0\nOUT Y0\nEND\n",
    )
    .program;
    let list = folder.path().join("MAIN.csv");
    std::fs::write(&list, print::to_csv(&source)).unwrap();
    std::fs::write(
        folder.path().join("comment.CSV"),
        print::comments_to_csv(&source),
    )
    .unwrap();
    let read = rungc_frontend::read(&list).unwrap();
    assert_eq!(read.program.comments, source.comments);
    assert_eq!(read.program.comments.len(), 2);
}

#[test]
fn a_list_is_written_with_steps_and_notes_in_columns() {
    let text = ";! cpu = FX3U/FX3UC\n;! X000 = start\n; motor\n0 LD X0 ; go\n1 OUT T0 K30\n4 ASC ABCD D0\nP1:\nEND\n";
    insta::assert_snapshot!(print::to_il(&read_text("a.il", text).program));
}

#[test]
fn a_list_is_laid_out_in_place() {
    let text = ";! cpu = FX3U\n\n\n; motor\nld x0;go\n  0 out t0, k30\r\nP1: LD　Ｍ８０００　；速度\n\tasc abcd d0\nP2:\nend";
    let laid_out = print::lay_out(&read_text("a.il", text).program);
    insta::assert_debug_snapshot!(laid_out);
}

/// A TAB is the editors' delimiter, and a line break ends a row: in a text neither does.
#[test]
fn texts_keep_their_control_characters() {
    let text = "a\tb\u{1}c\u{85}d";
    let list = format!("LD X000\n$MOV \"{text}\" D0\nEND\n");
    let read = read_text("a.il", &list);
    assert_eq!(
        read.program.instrs[1].operands[0].kind,
        OperandKind::Text(text.into())
    );
    let mut program = read.program;
    program.instrs[1].operands[0].kind = OperandKind::Text(format!("{text}\r\ne").into());
    assert!(print::broken_text(&program).is_some());
    let back = read_bytes("a.csv", &print::to_csv(&program)).unwrap();
    assert!(back.diagnostics.iter().next().is_none());
    assert_eq!(
        back.program.instrs[1].operands[0].kind,
        program.instrs[1].operands[0].kind
    );
    assert_eq!(back.program.instrs[2].mnemonic, "END");
}

/// Exponents are written as in the editors, and read in both forms.
#[test]
fn floats_are_written_as_the_editors_do() {
    for (read, written) in [
        ("E3.4E38", "E3.4+38"),
        ("E1+38", "E1.0+38"),
        ("E-1.5E-10", "E-1.5-10"),
        ("E2e-38", "E2.0-38"),
        ("E0.0001", "E0.0001"),
        ("E1.5+3", "E1500.0"),
    ] {
        let program = read_text("a.il", &format!("LD X000\nDEMOV {read} D0\n")).program;
        assert_eq!(program.instrs[1].to_string(), format!("DEMOV {written} D0"));
        let again = read_text("a.il", &print::to_il(&program)).program;
        assert_eq!(unplaced(&again), unplaced(&program));
    }
}

#[test]
fn an_export_keeps_the_language_of_its_head() {
    let rows = "\"测试\"\r\n\"PLC信息:\"\t\"FXCPU FX3U/FX3UC\"\r\n\
        \"步号\"\t\"行间声明\"\t\"指令\"\t\"I/O(软元件)\"\t\"空白栏\"\t\"PI声明\"\t\"注解\"\r\n\
        \"0\"\t\"\"\t\"LD\"\t\"X000\"\t\"\"\t\"\"\t\"\"\r\n\
        \"1\"\t\"\"\t\"END\"\t\"\"\t\"\"\t\"\"\t\"\"\r\n";
    let units = std::iter::once(0xFEFF).chain(rows.encode_utf16());
    let bytes: Vec<u8> = units.flat_map(u16::to_le_bytes).collect();
    let read = read_bytes("MAIN.csv", &bytes).unwrap();
    let head = read.export_head.as_ref().unwrap();
    assert_eq!(print::to_csv_with(&read.program, head), bytes);
    assert_ne!(print::to_csv(&read.program), bytes, "English without it");
    let moved = rows.replace("\"步号\"", "\"Q\"");
    let read = read_bytes("MAIN.csv", moved.as_bytes()).unwrap();
    assert_eq!(read.export_head, None, "its columns are not the editors'");
}
