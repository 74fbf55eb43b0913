//! Lists and findings that texts give.

use rungc_models::{Model, ModelId};
use rungc_structured::compile;
use rungc_syntax::{Program, Severity, Source, SourceKind, codes};
use std::fmt::Write as _;

/// The program of a text, and its findings with their lines and columns.
fn compiled(text: &str, model: ModelId) -> (Program, String) {
    let mut program = Program {
        source: Source::new("a.st", text),
        kind: SourceKind::StructuredText,
        unread: vec![0],
        ..Program::default()
    };
    let found = compile(&mut program, Model::get(model));
    let mut shown = String::new();
    for one in found.sorted() {
        let (line, column) = program.source.line_col(one.span.start);
        let _ = writeln!(shown, "{line}:{column} {} {}", one.code, one.message);
        for text in [Some(one.label), one.help]
            .into_iter()
            .flatten()
            .filter(|text| !text.is_empty())
        {
            let _ = writeln!(shown, "    {text}");
        }
        for other in one.others {
            let (line, column) = program.source.line_col(other.span.start);
            let _ = writeln!(shown, "    {line}:{column} {}", other.text);
        }
    }
    (program, shown)
}

/// A text as a list, each statement above what it became.
fn list(text: &str) -> String {
    let (program, found) = compiled(text, ModelId::Fx3u);
    assert!(!program.instrs.is_empty(), "{found}");
    let mut shown = found;
    for instr in &program.instrs {
        if let Some(statement) = instr.statement() {
            let _ = writeln!(shown, "; {statement}");
        }
        let _ = write!(shown, "{}", instr.mnemonic);
        for operand in &instr.operands {
            let _ = write!(shown, " {}", operand.kind);
        }
        shown.push('\n');
    }
    shown
}

fn body(statements: &str) -> String {
    let labels = "a AT M1 : BOOL;\nb AT M2 : BOOL;\nc AT M3 : BOOL;\ni AT D10 : INT;\nj AT D11 : INT;\n\
         d AT D20 : DINT;\n\
        e AT D22 : DINT;\nr AT D30 : REAL;\ns AT D32 : REAL;\nu AT D40 : DWORD;\nvv AT D42 : DWORD;\nw AT D50 : WORD;\n\
        t AT D60 : TIME;\nx AT D100 : ARRAY [0..9] OF INT;\n";
    format!("PROGRAM P\nVAR\n{labels}END_VAR\n{statements}END_PROGRAM\n")
}

#[test]
fn conditions_have_the_contacts_of_gx_works2() {
    insta::assert_snapshot!(list(&body(
        "c := a AND NOT b;\nc := a AND i = 0;\nc := NOT a AND i = 0;\nc := a AND (b OR i > 5);\n\
         c := a AND b AND (X0 OR X1);\nc := d > e;\nc := u >= vv;\nc := a = b;\nc := (a OR b) <> X1;\n\
         c := NOT (a AND b);\n\
         c := D100.3;\nc := TRUE;\nc := i + j > 5;\nc := a XOR b;\n"
    )));
}

#[test]
fn assignments_have_the_instructions_of_gx_works2() {
    insta::assert_snapshot!(list(&body(
        "i := j;\nd := e;\nr := s;\ni := i + 1;\ni := i * 3;\ni := j MOD 3;\nd := d / 7;\nr := r * s + 1.5;\n\
         w := w AND 16#00FF;\nd := d OR 16#1;\nd := INT_TO_DINT(i);\nr := INT_TO_REAL(i);\ni := REAL_TO_INT(r);\n\
         i := DINT_TO_INT(d);\nt := T#1m30s;\nx[3] := x[4] + 1;\nD0Z5 := i;\ni := -j;\ni := -1;\ni := 16 / 4;\n"
    )));
}

#[test]
fn branches_and_loops_have_the_jumps_of_gx_works2() {
    insta::assert_snapshot!(list(&body(
        "IF a THEN i := 1; END_IF;\nIF a AND b THEN i := 1; END_IF;\nIF i = 3 THEN j := 1; ELSE j := 2; END_IF;\n\
         IF a THEN i := 1; ELSIF b THEN i := 2; ELSE i := 3; END_IF;\n\
         CASE i OF 1: j := 1; 2: j := 2; END_CASE;\nCASE i OF 1, 3: j := 1; 5..7: j := 2; ELSE j := 3; END_CASE;\n\
         FOR i := 0 TO j DO d := d + e; END_FOR;\nFOR i := 9 TO 0 BY -3 DO EXIT; END_FOR;\n\
         WHILE i < 10 DO i := i + 1; END_WHILE;\nREPEAT i := i - 1; UNTIL i = 0 END_REPEAT;\nRETURN;\n"
    )));
}

#[test]
fn calls_have_the_operands_in_the_order_of_the_manual() {
    insta::assert_snapshot!(list(&body(
        "MOV(a, i, j);\nDMOV(TRUE, d, e);\nBMOV(a, x[0], 5, D200);\nROL(a, 3, w);\nSET(a AND b, c);\nRST(a, d);\n\
         OUT_T(a, TC0, 50);\nOUT_T(a AND b, TC0, i);\nINC(a, i);\nEI(TRUE);\nMOV(a, i + 1, j);\n\
         MOV(a AND b, i + 1, j);\n\
         MOV(TRUE, i + 1, j);\nSET(MEP(a), c);\nPLS(a, c);\nDECO(a, i, 6, M100);\nDMOV(a, -45_000, d);\n\
         MOV(a, H0C87, D8120);\n"
    )));
}

#[test]
fn blocks_are_expanded_with_the_operands_of_the_call() {
    insta::assert_snapshot!(list(
        "FUNCTION_BLOCK Limiter\nVAR_INPUT\n    In, Most : INT;\nEND_VAR\nVAR_OUTPUT\n    Out : INT;\nEND_VAR\n\
         VAR\n    \
         Calls : INT;\nEND_VAR\nCalls := Calls + 1;\nOut := In;\nIF In <= Most THEN RETURN; END_IF;\nOut := Most;\n\
         END_FUNCTION_BLOCK\nPROGRAM P\nVAR\n    First, Second : Limiter;\nEND_VAR\n\
         First(In := D0, Most := 100, Out => D10);\n\
         Second(In := D1, Most := H1F, Out => D11);\nEND_PROGRAM\n"
    ));
    let text = "FUNCTION_BLOCK B\nVAR_INPUT\n    In : INT;\nEND_VAR\nD0 := In + X0;\nEND_FUNCTION_BLOCK\n\
         PROGRAM P\nVAR\n    \
                b : B;\nEND_VAR\nb();\nb(In := X1);\nb(In := 1, Out := D1);\nb(In := 2);\nb(In := 3);\nEND_PROGRAM\n";
    insta::assert_snapshot!(compiled(text, ModelId::Fx3u).1);
}

/// A structure, arrays, and the statements of a program.
fn parts(statements: &str) -> String {
    format!(
        "TYPE Axis :\nSTRUCT\n    Home : BOOL;\n    Position : DINT;\n    Speed : INT;\nEND_STRUCT\nEND_TYPE\n\
         PROGRAM P\nVAR\n    c AT M3 : BOOL;\n    i AT D10 : INT;\n    j AT D11 : INT;\n    d AT D20 : DINT;\n    \
         x AT D100 : ARRAY [0..9] OF INT;\n    y AT D200 : ARRAY [0..9] OF DINT;\n    \
         f AT M50 : ARRAY [0..9] OF BOOL;\n    g AT D300 : ARRAY [1..2, 0..3] OF INT;\n    \
         One, Other : Axis;\n    Axes : ARRAY [0..3] OF Axis;\nEND_VAR\n{statements}END_PROGRAM\n"
    )
}

#[test]
fn variable_indexes_are_in_z0() {
    insta::assert_snapshot!(list(&parts(
        "i := x[j];\nd := y[j];\ni := x[d];\nx[j] := i + 1;\nx[j] := x[i];\nf[j] := c;\nf[j] := c AND i > 0;\n\
         c := f[j];\nc := x[i] > x[j];\ng[i, 2] := g[2, j];\ng[i, j] := 0;\ni := x[i] + x[j];\nMOV(c, x[i], j);\n"
    )));
}

#[test]
fn structures_have_their_bits_in_m_and_all_else_in_d() {
    insta::assert_snapshot!(list(&parts(
        "One.Home := Other.Position = 0;\nOne.Speed := 5;\nOne := Other;\nAxes[2].Position := d;\n\
         Axes[j].Position := d;\nAxes[j].Home := c;\nOne := Axes[j];\n"
    )));
}

#[test]
fn functions_are_subroutines() {
    let function = "FUNCTION Scaled : INT\nVAR_INPUT\n    Raw : INT;\n    Fine : BOOL;\nEND_VAR\n\
         Scaled := Raw / 10;\nIF Fine THEN Scaled := Raw; END_IF;\nEND_FUNCTION\n";
    let program = parts(
        "i := Scaled(x[0], c);\nj := Scaled(Raw := i, Fine := FALSE) + Scaled(Scaled(1, c), c);\n",
    );
    insta::assert_snapshot!(list(&format!("{function}{program}")));
}

#[test]
fn blocks_of_the_library_are_subroutines_of_each_instance() {
    insta::assert_snapshot!(list(
        "PROGRAM P\nVAR\n    Delay : TON;\n    Rise : R_TRIG;\n    Count : CTU;\nEND_VAR\n\
         Delay(IN := X0, PT := T#5s, Q => Y0);\nRise(CLK := X1);\n\
         Count(CU := Rise.Q, R := X2, PV := 10, CV => D0);\nY1 := Count.Q OR Delay.ET > T#2s;\nEND_PROGRAM\n"
    ));
}

#[test]
fn functions_of_the_library() {
    insta::assert_snapshot!(list(&body(
        "i := LIMITATION(0, j, 100);\ni := SEL(a, j, 7);\ni := MAX(i, j, 3);\ni := MUX(j, 1, 2, i);\nd := ABS(e);\n\
         w := SHL(w, 3);\nw := SHR(w, 3);\nu := SHR(u, 3);\nw := ROL(w, 2);\ni := BOOL_TO_INT(a OR b);\n\
         c := INT_TO_BOOL(i);\nr := SQRT(s);\n"
    )));
}

#[test]
fn comparisons_of_real_and_unsigned_values() {
    insta::assert_snapshot!(list(&body(
        "c := r <= s;\nc := a AND r > 1.5;\nIF r <> s THEN i := 1; END_IF;\nc := w >= 40000;\nw := w / 10;\n"
    )));
}

#[test]
fn what_is_not_compiled_has_a_reason() {
    let shown = |text: &str| compiled(text, ModelId::Fx3u).1;
    let mut all = shown(
        "TYPE A :\nSTRUCT\n    b : B;\n    t : TIMER;\nEND_STRUCT\nB :\nSTRUCT\n    a : A;\n    n : INT := 5;\n\
         END_STRUCT\nEND_TYPE\nPROGRAM P\nVAR\n    a : A;\nEND_VAR\nEND_PROGRAM\n",
    );
    all += &shown(
        "PROGRAM P\nVAR\n    t : ARRAY [0..3] OF TON;\n    u AT D0 : CTU;\nEND_VAR\n\
         t[4](IN := X0);\nt[D0](IN := X0);\nY0 := t[D0].Q;\nt(IN := X0);\nY1 := Y2[3];\nEND_PROGRAM\n",
    );
    all += &shown(
        "FUNCTION Bump : INT\nVAR_IN_OUT\n    n : INT;\nEND_VAR\nn := n + 1;\nBump := n;\nEND_FUNCTION\n\
         PROGRAM P\nVAR\n    x : ARRAY [0..3] OF INT;\nEND_VAR\n\
         D0 := Bump(5);\nD0 := Bump(D1 + 1);\nD0 := Bump(x[D1]);\nD0 := Bump();\nEND_PROGRAM\n",
    );
    all += &shown(&parts(
        "i := One;\nOne := 5;\nOne := x;\nx[c] := 1;\nx[10] := 1;\nOne.Sped := 1;\nx := x;\nSET(c, f[i]);\n\
         MOV(TRUE, x[i], x[j]);\nFOR x[i] := 0 TO 3 DO END_FOR;\ni := MAX(i);\ni := MAX(i, c);\ni := SHL(i, j);\n\
         i := LIMITS(1, 2, i);\ni.x := 1;\nOUT_T(c, TC0, T#5s);\n",
    ));
    all += &shown(
        "FUNCTION F : INT\nVAR_INPUT\n    n : INT;\nEND_VAR\nF := G(n);\nEND_FUNCTION\n\
         FUNCTION G : INT\nVAR_INPUT\n    n : INT;\nEND_VAR\nG := F(n);\nEND_FUNCTION\n\
         FUNCTION H\nH();\nEND_FUNCTION\n\
         PROGRAM P\nVAR\n    t : TON;\nEND_VAR\nD0 := F();\nD0 := F(1, 2);\nD0 := F(1);\nD0 := F(m := 1);\n\
         t(X0);\nt(In := X0, PT := 5.5);\nt(PP := 1);\nY0 := t.R;\nt();\nEND_PROGRAM\n",
    );
    all += &shown(
        "TYPE A :\nSTRUCT\n    b : BOOL;\n    n : INT;\nEND_STRUCT\nEND_TYPE\nPROGRAM P\nVAR\n    \
         a AT (b := D5) : A;\n    c AT (x := M5) : A;\n    d AT (n := D5, N := D6) : A;\n    \
         e AT (n := D5) : INT;\n    t AT (Q := M0) : TON;\nEND_VAR\nEND_PROGRAM\n",
    );
    insta::assert_snapshot!(all);
}

#[test]
fn names_are_not_keywords_or_types() {
    let mut all = String::new();
    for name in ["If", "Of", "INT", "String", "Counter"] {
        let text = format!(
            "TYPE {name} : STRUCT a : INT; END_STRUCT; END_TYPE\nPROGRAM P\nVAR x : {name}; END_VAR\nx.a := 1;\nEND_PROGRAM\n"
        );
        let _ = writeln!(all, "--- {name}\n{}", compiled(&text, ModelId::Fx3u).1);
    }
    for text in [
        "PROGRAM P\nVAR By, a : INT; To : BOOL; END_VAR\nBy := 1;\nEND_PROGRAM\n",
        "PROGRAM For\nY0 := X0;\nEND_PROGRAM\n",
        "FUNCTION Mod : INT\nMod := 1;\nEND_FUNCTION\nPROGRAM P\nD0 := Mod();\nEND_PROGRAM\n",
    ] {
        let _ = writeln!(all, "---\n{}", compiled(text, ModelId::Fx3u).1);
    }
    insta::assert_snapshot!(all);
}

#[test]
fn mistakes_with_texts_have_a_reason() {
    let text = "PROGRAM P\nVAR CONSTANT Long : STRING(3) := 'abcd'; END_VAR\n\
         VAR\n    s : STRING(5);\n    t : STRING(12);\n    none : STRING(0);\n    most : STRING(256);\n    \
         bits AT M0 : STRING(4);\n    group AT K4M0 : STRING(4);\n    begun : STRING(4) := 'abc';\n    wide : WSTRING(4);\nEND_VAR\n\
         s := t;\ns := CONCAT(s, 'x');\ns := 'abcdef';\ns := 'ros\u{e9}$20';\ns := '\u{4e2d}';\ns := '$';\n\
         IF s < t THEN D0 := 1; END_IF;\nD0 := MAX(s, t);\ns := s + 'a';\nD0 := s;\ns := D0;\nD0 := LEN();\n\
         D0 := LEN(5);\ns := LEFT(s, t);\ns := LEFT(s, n := 3);\nY0 := NOT s;\nCASE s OF 1: D0 := 1; END_CASE;\n\
         s := INT_TO_STRING(s);\nD0 := STRING_TO_INT(D1);\nD0 := 'abc';\n\
         t := '0123456789 0123456789 0123456789 0123456789';\nD0 := LENGTH(s);\ns := -s;\nEND_PROGRAM\n";
    let found = compiled(text, ModelId::Fx3u).1;
    let other = "PROGRAM P\nVAR s : STRING(5); END_VAR\ns := 'abc';\nIF s = '' THEN D0 := LEN(s); END_IF;\n\
         s := LEFT(INT_TO_STRING(D0), 5);\nEND_PROGRAM\n";
    let other = compiled(other, ModelId::Fx1n).1;
    insta::assert_snapshot!(format!("{found}\n--- FX1N\n{other}"));
}

#[test]
fn texts_have_the_instructions_of_fx3u() {
    let text = "PROGRAM P\nVAR\n    s AT D10 : STRING(5);\n    t AT D20 : STRING(12);\nEND_VAR\n\
         t := s;\ns := 'abc';\nD0 := LEN(t);\ns := LEFT(t, 5);\nt := INSERT(s, '-', D1);\nY0 := s = t;\n\
         t := INT_TO_STRING(D0);\nD2 := STRING_TO_INT(t);\nEND_PROGRAM\n";
    insta::assert_snapshot!(list(text));
}

/// What is assigned to a label with the name of a constant or device is not reported, too.
#[test]
fn a_name_that_cannot_be_a_label_is_reported_once() {
    let text = "VAR_GLOBAL\n    H10 : INT;\nEND_VAR\nPROGRAM P\nVAR\n    K5 : INT;\n    X0 : BOOL;\nEND_VAR\n\
         K5 := 3;\nH10 := K5;\nX0 := TRUE;\nEND_PROGRAM\n";
    let found = compiled(text, ModelId::Fx3u).1;
    let errors = found.lines().filter(|line| line.contains(" E"));
    insta::assert_snapshot!(errors.collect::<Vec<_>>().join("\n"), @r"
    2:5 E0208 `H10` is the name of a device or constant
    6:5 E0208 `K5` is the name of a device or constant
    7:5 E0208 `X0` is the name of a device or constant
    ");
}

#[test]
fn constants_of_floats_need_a_model_that_has_them() {
    let text = body("r := 1.5;\nc := r > 2;\n");
    assert_eq!(compiled(&text, ModelId::Fx3u).1, "");
    let found = compiled(&text, ModelId::Fx2n).1;
    let why = "this takes the instruction `DEMOV`, which Mitsubishi FX2N does not have";
    assert_eq!(found.matches("E0207").count(), 2, "{found}");
    assert_eq!(found.matches(why).count(), 2, "{found}");
}

#[test]
fn mistakes_are_reported_where_they_are() {
    insta::assert_snapshot!(compiled(include_str!("mistakes.st"), ModelId::Fx3u).1);
}

/// The programs of the table of codes.
#[test]
fn examples_of_codes_show_their_code() {
    let all = codes::all();
    let of_text = |code: &&&codes::Code| code.name.starts_with("st-");
    let mut shown = String::new();
    for code in all.iter().filter(of_text) {
        let (_, found) = compiled(code.wrong, ModelId::Fx3u);
        assert!(found.contains(code.id), "{} is not shown: {found}", code.id);
        let _ = writeln!(shown, "--- {} {}\n{found}", code.id, code.name);
        let (_, found) = compiled(code.right, ModelId::Fx3u);
        assert!(found.is_empty(), "{}: {found}", code.id);
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn labels_get_devices_of_the_range_of_the_model_from_the_top() {
    let text = "PROGRAM P\nVAR\n    a, b : BOOL;\n    i : INT;\n    d : DINT;\nEND_VAR\n\
         a := b; d := 1; i := 2;\nEND_PROGRAM\n";
    let devices = |model| {
        let (program, found) = compiled(text, model);
        assert_eq!(found, "");
        program
            .comments
            .iter()
            .map(|(device, name)| format!("{name} {device}"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    assert_eq!(devices(ModelId::Fx3u), "b M7678, a M7679, d D997, i D999");
    assert_eq!(devices(ModelId::Fx1s), "b M510, a M511, d D253, i D255");
}

#[test]
fn a_program_with_errors_is_not_compiled() {
    let (program, found) = compiled("PROGRAM P\nY0 := Start;\nEND_PROGRAM\n", ModelId::Fx3u);
    assert!(found.contains(codes::ST_UNKNOWN_NAME.id));
    assert!(program.instrs.is_empty() && !program.is_complete());
    let other = Program::default();
    let mut same = other.clone();
    let found = compile(&mut same, Model::get(ModelId::Fx3u));
    assert!(!found.iter().any(|one| one.severity == Severity::Error) && same.instrs.is_empty());
}
