//! PLCopen XML: what becomes of ladders and lists, and what is named as foreign.

use rungc_frontend::{Names, Read, ReadOptions, read_bytes, read_bytes_with};
use rungc_syntax::SourceKind;

/// A project with these variables and this body.
fn project(variables: &str, body: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<project xmlns="http://www.plcopen.org/xml/tc6_0201" xmlns:xhtml="http://www.w3.org/1999/xhtml">
  <fileHeader companyName="" productName="" productVersion="1" creationDateTime="2024-01-01T00:00:00"/>
  <contentHeader name="Press"/>
  <types><dataTypes/><pous><pou name="main" pouType="program">
    <interface><localVars>{variables}</localVars></interface>
    <body>{body}</body>
  </pou></pous></types>
  <instances><configurations/></instances>
</project>"#
    )
}

const VARIABLES: &str = r#"
      <variable name="Start" address="%IX0.0"><type><BOOL/></type>
        <documentation><xhtml:p>start button</xhtml:p></documentation></variable>
      <variable name="Stop" address="%IX1.2"><type><BOOL/></type></variable>
      <variable name="Motor" address="%QX1.0"><type><BOOL/></type></variable>
      <variable name="M7"><type><BOOL/></type></variable>
      <variable name="Hidden"><type><BOOL/></type></variable>"#;

/// An element of a drawing with its attributes, the elements that lead to it and its variable.
fn element(kind: &str, id: u32, attributes: &str, from: &[u32], variable: &str) -> String {
    let connections = from
        .iter()
        .map(|id| format!(r#"<connection refLocalId="{id}"/>"#));
    let connections: String = connections.collect();
    format!(
        r#"<{kind} localId="{id}" {attributes}><position x="{id}" y="{id}"/>
        <connectionPointIn>{connections}</connectionPointIn><variable>{variable}</variable></{kind}>
        "#
    )
}

fn ladder(elements: &[String]) -> String {
    let rail = r#"<leftPowerRail localId="1"><position x="0" y="0"/><connectionPointOut/></leftPowerRail>"#;
    project(
        VARIABLES,
        &format!("<LD>{rail}\n{}</LD>", elements.concat()),
    )
}

fn read(text: &str) -> Read {
    read_bytes("plc.xml", text.as_bytes()).unwrap()
}

fn instructions(read: &Read) -> Vec<String> {
    read.program
        .instrs
        .iter()
        .map(ToString::to_string)
        .collect()
}

fn findings(read: &Read) -> String {
    let line = |d: &rungc_syntax::Diagnostic| {
        format!(
            "{} {} / {}\n",
            d.code,
            d.message,
            d.help.as_deref().unwrap_or_default()
        )
    };
    read.diagnostics.iter().map(line).collect()
}

#[test]
fn a_ladder_becomes_a_list() {
    let read = read(&ladder(&[
        element("contact", 2, "", &[1], "Start"),
        element("contact", 3, "", &[1], "Motor"),
        element("contact", 4, r#"negated="true""#, &[2, 3], "Stop"),
        element("coil", 5, "", &[4], "Motor"),
        element("coil", 6, r#"storage="set""#, &[4], "M7"),
        element("contact", 7, r#"edge="rising""#, &[1], "%IX0.7"),
        element("coil", 8, r#"negated="true""#, &[7], "%MX0.3"),
        element("coil", 9, "", &[1], "Y3"),
    ]));
    assert_eq!(findings(&read), "");
    assert_eq!(read.program.kind, SourceKind::Plcopen);
    assert_eq!(read.program.title.as_deref(), Some("Press"));
    assert_eq!(
        instructions(&read),
        [
            "LD X000", "OR Y010", "ANI X012", "OUT Y010", "SET M7", "LDP X007", "INV", "OUT M3",
            "LD M8000", "OUT Y003", "END"
        ]
    );
    let comments = read
        .program
        .comments
        .iter()
        .map(|(device, text)| format!("{device} {text}"));
    assert_eq!(
        comments.collect::<Vec<_>>(),
        ["X000 start button", "X012 Stop", "Y010 Motor"]
    );
}

#[test]
fn a_table_names_devices() {
    let table = "Hidden,M20\r\n\"start\"\tX005\n";
    let options = ReadOptions {
        names: Names::parse(table).unwrap(),
        ..ReadOptions::default()
    };
    let body = "<IL><xhtml:p>LD Start\nAND Hidden\nST Motor</xhtml:p></IL>";
    let text = project(VARIABLES, body);
    let read = read_bytes_with("plc.xml", text.as_bytes(), &options).unwrap();
    assert_eq!(findings(&read), "");
    assert_eq!(
        instructions(&read),
        ["LD X005", "AND M20", "OUT Y010", "END"]
    );
}

#[test]
fn a_list_becomes_a_list() {
    let body = "<IL><xhtml:p>LD Start (* begin *)\nOR Motor\nANDN Stop\nST Motor\nLDN %MX1.1\nS M7\n</xhtml:p></IL>";
    let read = read(&project(VARIABLES, body));
    assert_eq!(findings(&read), "");
    assert_eq!(
        instructions(&read),
        [
            "LD X000", "OR Y010", "ANI X012", "OUT Y010", "LDI M9", "SET M7", "END"
        ]
    );
}

#[test]
fn what_has_no_counterpart_is_named_with_its_line() {
    let mut text = ladder(&[
        element("contact", 2, "", &[1], "Hidden"),
        element("contact", 3, "", &[4], "Start"),
        element("contact", 4, "", &[3], "Start"),
        element("coil", 5, "", &[3], "Motor"),
        element("coil", 6, "", &[77], "Motor"),
        element("coil", 7, "", &[], "Motor"),
        element("coil", 8, "", &[2], ""),
        element("block", 9, r#"typeName="TON" instanceName="T1""#, &[1], ""),
        element("coil", 10, "", &[9], "Motor"),
        element("coil", 11, "", &[2], "Hidden"),
        element("coil", 12, "", &[1], "Level"),
    ]);
    text = text.replace(
        "</LD>",
        "</LD></body><body><ST><xhtml:p>a := b;</xhtml:p></ST>",
    );
    text = text.replace("name=\"M7\"", "name=\"Level\" address=\"%IW3\"");
    let list = "<IL><xhtml:p>LD Start\nAND( Stop\n)\nCAL Timer\n</xhtml:p></IL>";
    let lists = read(&project(VARIABLES, list));
    let empty = read(&project("", "").replace("\"program\"", "\"functionBlock\""));
    insta::assert_snapshot!(
        [findings(&read(&text)), findings(&lists), findings(&empty)].join("---\n")
    );
}

/// Contacts and blocks that drive nothing would be missing from the list.
#[test]
fn elements_that_drive_nothing_are_named() {
    let and = r#"<block localId="9" typeName="AND"><position x="0" y="0"/><inputVariables>
        <variable formalParameter="IN1"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></variable>
        <variable formalParameter="IN2"><connectionPointIn><connection refLocalId="2"/></connectionPointIn></variable>
        </inputVariables><outputVariables><variable formalParameter="OUT"/></outputVariables></block>"#;
    let found = read(&ladder(&[
        element("contact", 2, "", &[1], "Start"),
        element("coil", 3, "", &[2], "Motor"),
        element("contact", 4, "", &[1], "Stop"),
        element("contact", 5, "", &[4], "M7"),
        element("contact", 6, "", &[2], "Hidden"),
        element("rightPowerRail", 7, "", &[3, 6], ""),
        and.to_owned(),
    ]));
    let messages: Vec<_> = found
        .diagnostics
        .iter()
        .map(|d| d.message.as_str())
        .collect();
    let lines = messages
        .iter()
        .map(|message| message.split_once(": ").unwrap());
    let (lines, said): (Vec<_>, Vec<_>) = lines.unzip();
    assert_eq!(
        said,
        [
            "element `block` `AND` drives nothing",
            "contact `M7` drives nothing",
            "contact `Hidden` drives nothing"
        ]
    );
    assert!(
        lines.iter().all(|line| line.starts_with("line ")),
        "{lines:?}"
    );
}

/// What follows from a line that cannot be read is not reported again.
#[test]
fn a_line_of_a_list_is_wrong_once() {
    for (lines, wrong) in [
        (
            "LD Nowhere\nST Motor\n",
            vec!["the variable `Nowhere` is not a device"],
        ),
        (
            "LDP Start\nST Motor\nLD Start\nST Motor\n",
            vec!["`LDP Start` has no counterpart in an FX list"],
        ),
        (
            "LD Nowhere\nAND Start\nST D0\nST Motor\n",
            vec!["the variable `Nowhere` is not a device"],
        ),
        (
            "LD Nowhere\nAND( Start\nOR Stop\n)\nST MPS_1\nS Motor\nLD MPS_1\nST Motor\n",
            vec!["the variable `Nowhere` is not a device"],
        ),
        (
            "LD Nowhere\nGT 5\nST Motor\nLD Start\nST D0\n",
            vec![
                "the variable `Nowhere` is not a device",
                "`D0` is not a bit",
            ],
        ),
        (
            "ST Motor\n",
            vec!["`ST Motor` has no counterpart in an FX list"],
        ),
    ] {
        let found = read(&project(
            VARIABLES,
            &format!("<IL><xhtml:p>{lines}</xhtml:p></IL>"),
        ));
        let messages = found
            .diagnostics
            .iter()
            .map(|d| d.message.split_once(": ").unwrap().1);
        assert_eq!(messages.collect::<Vec<_>>(), wrong, "{lines}");
    }
}

#[test]
fn hostile_drawings_end() {
    let stage = |n: u32| {
        let from: &[u32] = if n == 1 {
            &[1]
        } else {
            &[2 * n - 2, 2 * n - 1]
        };
        [
            element("contact", 2 * n, "", from, "Start"),
            element("contact", 2 * n + 1, "", from, "Stop"),
        ]
        .concat()
    };
    let mut many: Vec<_> = (1..40).map(stage).collect();
    many.push(element("coil", 90, "", &[78, 79], "Motor"));
    let wide = read(&ladder(&many));
    let mut long: Vec<_> = (2..3000)
        .map(|n| element("contact", n, "", &[n - 1], "Start"))
        .collect();
    long.push(element("coil", 9000, "", &[2999], "Motor"));
    let deep = read(&ladder(&long));
    let cut = read(&ladder(&[])[..500]);
    insta::assert_snapshot!([findings(&wide), findings(&deep), findings(&cut)].join("---\n"));
}

#[test]
fn hostile_documents_end() {
    let entities = ladder(&[element("coil", 2, "", &[1], "&big;")]).replace(
        "<project",
        r#"<!DOCTYPE p [<!ENTITY a "xxxxxxxx"><!ENTITY big "&a;&a;&a;&a;">]><project"#,
    );
    let nested = |tag: &str, count: usize| {
        let (open, close) = (format!("<{tag}>"), format!("</{tag}>"));
        project(
            "",
            &format!("<LD>{}{}</LD>", open.repeat(count), close.repeat(count)),
        )
    };
    let many: Vec<_> = (2..2_000)
        .map(|n| element("coil", n, "", &[n + 1], "Away"))
        .collect();
    // Each coil is a contact further away.
    let comb = (1..2_100).flat_map(|n| {
        let (contact, coil) = (2 * n, 2 * n + 1);
        let before = if n == 1 { 1 } else { contact - 2 };
        [
            element("contact", contact, "", &[before], "Start"),
            element("coil", coil, "", &[contact], "Motor"),
        ]
    });
    let list = format!("<IL><p>LD M0\n{}</p></IL>", "AND(\n".repeat(10_000));
    let said = [
        entities,
        nested("variable", 900),
        nested("expression", 200_000),
        ladder(&many),
        ladder(&comb.collect::<Vec<_>>()),
        project("", &list),
    ]
    .map(|text| {
        let read = with_free(&text);
        let found = read.diagnostics.iter().count();
        let first = findings(&read).lines().next().map(str::to_owned);
        format!("{found}: {}", first.unwrap_or_default())
    });
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn a_long_list_of_problems_says_that_it_is_cut_short() {
    let unknown = |count| {
        let coils: Vec<_> = (0..count)
            .map(|n| element("coil", n + 2, "", &[1], &format!("Hidden{n}")))
            .collect();
        findings(&read(&ladder(&coils)))
    };
    let last = |found: &str| found.lines().last().map(str::to_owned);
    let end = last(&unknown(201)).expect("problems are found");
    assert!(end.contains("further problems are not shown"), "{end}");
    let end = last(&unknown(200)).expect("problems are found");
    assert!(end.contains("Hidden199"), "{end}");
}

/// Devices for variables that have none.
fn with_free(text: &str) -> Read {
    let free = "*,M100-M199\n*,T0-T9\n*,T200-T209\n*,C0-C9\n*,D100-D199\n*,S20-S29\nfixed,M55\n";
    let options = ReadOptions {
        names: Names::parse(free).unwrap(),
        ..ReadOptions::default()
    };
    read_bytes_with("plc.xml", text.as_bytes(), &options).unwrap()
}

/// Errors in a project, and the list of its readable part.
fn shown(read: &Read) -> String {
    findings(read) + &rungc_frontend::print::to_il(&read.program)
}

const BLOCKS: &str = r#"
      <variable name="Start" address="%IX0.0"><type><BOOL/></type></variable>
      <variable name="Delay"><type><derived name="TON"/></type></variable>
      <variable name="Pieces"><type><derived name="CTU"/></type></variable>
      <variable name="fixed"><type><BOOL/></type><initialValue><simpleValue value="TRUE"/></initialValue></variable>
      <variable name="level"><type><INT/></type><initialValue><simpleValue value="500"/></initialValue></variable>
      <variable name="total"><type><DINT/></type></variable>
      <variable name="pause"><type><TIME/></type><initialValue><simpleValue value="T#1.5s"/></initialValue></variable>
      <variable name="weight"><type><REAL/></type></variable>"#;

/// A block with constants or elements at its inputs.
fn block(id: u32, kind: &str, name: &str, inputs: &[(&str, &str)], outputs: &[&str]) -> String {
    let input = |(pin, from): &(&str, &str)| {
        let from = match from.strip_prefix('@') {
            Some(id) => format!(r#"<connection refLocalId="{id}"/>"#),
            None => format!("<expression>{from}</expression>"),
        };
        format!(
            r#"<variable formalParameter="{pin}"><connectionPointIn>{from}</connectionPointIn></variable>"#
        )
    };
    let inputs: String = inputs.iter().map(input).collect();
    let output = |pin: &&str| {
        format!(r#"<variable formalParameter="{pin}"><connectionPointOut/></variable>"#)
    };
    let outputs: String = outputs.iter().map(output).collect();
    format!(
        r#"<block localId="{id}" typeName="{kind}" instanceName="{name}"><position x="{id}" y="{id}"/>
        <inputVariables>{inputs}</inputVariables><inOutVariables/><outputVariables>{outputs}</outputVariables></block>
        "#
    )
}

/// A variable that an output of a block goes to.
fn out_variable(id: u32, from: u32, pin: &str, name: &str) -> String {
    format!(
        r#"<outVariable localId="{id}"><position x="{id}" y="{id}"/><connectionPointIn>
        <connection refLocalId="{from}" formalParameter="{pin}"/></connectionPointIn><expression>{name}</expression></outVariable>
        "#
    )
}

fn drawn(elements: &[String]) -> String {
    ladder(elements).replace(VARIABLES, BLOCKS)
}

#[test]
fn blocks_become_instructions() {
    let read = with_free(&drawn(&[
        element("contact", 2, "", &[1], "Start"),
        block(3, "TON", "Delay", &[("IN", "@2"), ("PT", "pause")], &["Q", "ET"]),
        element("coil", 4, "", &[3], "fixed"),
        element("contact", 5, r#"negated="true""#, &[1], "Delay.Q"),
        block(6, "CTU", "Pieces", &[("CU", "@5"), ("R", "fixed"), ("PV", "12")], &["Q"]),
        block(7, "GE", "", &[("EN", "@1"), ("IN1", "level"), ("IN2", "16#10")], &["OUT"]),
        block(8, "AND", "", &[("IN1", "@6"), ("IN2", "@7")], &["OUT"]),
        element("coil", 9, r#"storage="set""#, &[8], "%QX0.7"),
        block(10, "ADD", "", &[("EN", "@2"), ("IN1", "level"), ("IN2", "1")], &["ENO", "OUT"]),
        block(11, "MUL", "", &[("IN1", "@10"), ("IN2", "3")], &["OUT"]).replace(
            r#"<connection refLocalId="10"/>"#,
            r#"<connection refLocalId="10" formalParameter="OUT"/>"#,
        ),
        out_variable(12, 11, "OUT", "level"),
        block(13, "FX_ZRST", "", &[("EN", "@2"), ("p1", "M10"), ("p2", "M20")], &["ENO"]),
        block(14, "FX_FEND", "", &[("EN", "@1")], &["ENO"]),
        r#"<label localId="15" label="Skip"><position x="0" y="15"/></label>"#.to_owned(),
        element("jump", 16, r#"label="Skip""#, &[2], ""),
        element("return", 17, "", &[5], ""),
        r#"<comment localId="18" height="1" width="1"><position x="0" y="18"/><content><p>Lamps</p></content></comment>"#
            .to_owned(),
        element("coil", 19, "", &[2], "Y1"),
    ]));
    insta::assert_snapshot!(shown(&read));
}

#[test]
fn blocks_that_do_something_else_are_refused() {
    let timer = |id, preset| block(id, "TON", "Delay", &[("IN", "@2"), ("PT", preset)], &["Q"]);
    let add = |id, b| block(id, "ADD", "", &[("IN1", "level"), ("IN2", b)], &["OUT"]);
    let read = with_free(&drawn(&[
        element("contact", 2, "", &[1], "Start"),
        timer(3, "T#15ms"),
        timer(4, "level"),
        timer(5, "T#2h"),
        block(6, "TON", "", &[("IN", "@2"), ("PT", "T#1s")], &["Q"]),
        add(7, "total"),
        out_variable(8, 7, "OUT", "level"),
        add(9, "70000"),
        out_variable(10, 9, "OUT", "level"),
        add(11, "weight"),
        add(12, "1"),
        block(
            13,
            "GE",
            "",
            &[("EN", "@2"), ("IN1", "level"), ("IN2", "1")],
            &["OUT"],
        ),
        block(14, "MIN", "", &[("IN1", "@77"), ("IN2", "level")], &["OUT"]),
        block(
            15,
            "MAX",
            "",
            &[("IN1", "7000"), ("IN2", "level")],
            &["OUT"],
        ),
        out_variable(16, 15, "OUT", "level"),
        block(
            17,
            "SR",
            "latch",
            &[("S1", "latch.Q1"), ("R", "@2")],
            &["Q1"],
        ),
        block(18, "PID", "controller", &[("EN", "@2")], &["OUT"]),
        block(19, "FX_MOV", "", &[("EN", "@2"), ("p2", "D0")], &["ENO"]),
        element("coil", 20, "", &[12], "Y1"),
        element("contact", 21, "", &[1], "level"),
        element("coil", 22, "", &[21], "Y2"),
        block(23, "R_TRIG", "rise", &[("CLK", "level")], &["Q"]),
        block(
            24,
            "NOT",
            "",
            &[("IN", "level"), ("IN2", "level")],
            &["OUT"],
        ),
    ]));
    insta::assert_snapshot!(shown(&read));
}

#[test]
fn lists_jump_compare_and_nest() {
    let body = "<IL><xhtml:p>LD Start (* two\nlines *)\nAND( M1\nORN M2\n)\nJMPC over\nLD level\nADD 5\nST level\nGT 100\nANDN(M3 )\n\
                XOR M4\nSTN M5\nover: LD 7\nST total\nLD FALSE\nNOT\nRETC\nLD 1\nMUL 2\nST\nAND)\n)</xhtml:p></IL>";
    insta::assert_snapshot!(shown(&with_free(&project(BLOCKS, body))));
    let good = body.replace("LD 1\nMUL 2\nST\nAND)\n)", "");
    insta::assert_snapshot!(shown(&with_free(&project(BLOCKS, &good))));
}

#[test]
fn lists_call_timers_and_keep_results() {
    let timer = r#"<variable name="T7"><type><derived name="TON"/></type></variable>"#;
    let variables = format!("{BLOCKS}{timer}");
    let body = "<IL><xhtml:p>(* Wait *)\nLD Start\nST MPS_1\nAND Delay.Q\nST M5 (* beside *)\nLD MPS_1\nANDN M1\nST Delay.IN\n\
                CAL Delay(\nPT := T#1s\n)\nCAL T7(IN := M1, PT := T#300ms)\n(* Words\nand texts *)\nLD M2\nJMPCN SKIP_1\nLD 3\nST level\n\
                SKIP_1:\nFX_LDP(\np1 := T7.Q\n)\nFX_$MOV \"a,b\", D200\n</xhtml:p></IL>";
    insta::assert_snapshot!(shown(&with_free(&project(&variables, body))));
    let body = "<IL><xhtml:p>LD M1\nST MPS_1\nST M2\nLD M2\nST M3\nLD MPS_1\nST M4\nCAL Start(IN := M1)\nCAL T7(IN := M1)\n\
                CAL T7(PT := T#1s)\nCAL T7(PT := T#1s)\nFX_ZRST D0, D1\nLD M1\nFX_MEP 5\nFX_ZRST(\np1 := D0)\nFX_LD(p2 := D0)\nFX_LD()\n\
                JMPCN SKIP_9\nCAL Delay(\n</xhtml:p></IL>";
    insta::assert_snapshot!(shown(&with_free(&project(&variables, body))));
}

/// A chart: a choice between two branches, of which one is left by two steps at once.
fn chart() -> String {
    let connected = |from: &[u32]| {
        let points = from.iter().map(|id| {
            format!(r#"<connectionPointIn><connection refLocalId="{id}"/></connectionPointIn>"#)
        });
        points.collect::<String>()
    };
    let node = |kind: &str, id: u32, attributes: &str, from: &[u32], inside: &str| {
        let from = connected(from);
        format!(
            r#"<{kind} localId="{id}" {attributes}><position x="{id}" y="{id}"/>{from}{inside}</{kind}>"#
        )
    };
    let when = |text: &str| {
        format!(r#"<condition><inline name=""><ST><p>{text}</p></ST></inline></condition>"#)
    };
    let action = |qualifier: &str, name: &str| {
        format!(
            r#"<action localId="0" qualifier="{qualifier}"><relPosition x="0" y="0"/><reference name="{name}"/></action>"#
        )
    };
    let wire = r#"<condition><connectionPointIn><connection refLocalId="41"/></connectionPointIn></condition>"#;
    [
        node("step", 1, r#"name="Idle" initialStep="true""#, &[30], ""),
        node("selectionDivergence", 2, "", &[1], ""),
        node(
            "transition",
            3,
            r#"priority="2""#,
            &[2],
            &when("Start AND level &gt;= 10"),
        ),
        node(
            "transition",
            4,
            r#"priority="1""#,
            &[2],
            &when("NOT (M1 OR Idle.X &amp; M2)"),
        ),
        node("step", 5, r#"name="Fill""#, &[3], ""),
        node("simultaneousDivergence", 6, "", &[4], ""),
        node("step", 7, r#"name="Heat""#, &[6], ""),
        node("step", 8, r#"name="Stir""#, &[6], ""),
        node("simultaneousConvergence", 9, "", &[7, 8], ""),
        node("transition", 10, "", &[9], wire),
        node(
            "transition",
            11,
            "",
            &[5],
            r#"<condition negated="true"><reference name="M3"/></condition>"#,
        ),
        node("selectionConvergence", 12, "", &[10, 11], ""),
        node("jumpStep", 13, r#"targetName="Idle""#, &[12], ""),
        node(
            "actionBlock",
            14,
            "",
            &[5],
            &(action("N", "Y1") + &action("S", "Y2")),
        ),
        node(
            "actionBlock",
            15,
            "",
            &[7],
            &(action("N", "Y1") + &action("R", "Y2")),
        ),
        r#"<leftPowerRail localId="40"><position x="0" y="0"/></leftPowerRail>"#.to_owned(),
        element("contact", 41, "", &[40], "M4"),
    ]
    .concat()
    .replace(
        r#"<connectionPointIn><connection refLocalId="30"/></connectionPointIn>"#,
        "",
    )
}

#[test]
fn charts_become_relays() {
    let read = |chart: &str| with_free(&project(BLOCKS, &format!("<SFC>{chart}</SFC>")));
    insta::assert_snapshot!(shown(&read(&chart())));
    let wrong = [
        ("qualifier=\"S\"", "qualifier=\"D\""),
        (
            "<reference name=\"Y1\"/>",
            "<inline><ST><p>a := 1;</p></ST></inline>",
        ),
        ("targetName=\"Idle\"", "targetName=\"Away\""),
        ("qualifier=\"R\"", "qualifier=\"N\""),
        ("Start AND level", "Start AND F(level)"),
        ("<selectionConvergence", "<macroStep"),
    ];
    let refused = wrong.map(|(from, to)| findings(&read(&chart().replacen(from, to, 1))));
    insta::assert_snapshot!(refused.join("---\n"));
}

/// The edge of a negated value is the other edge of the value.
#[test]
fn negated_contacts_with_edges_catch_the_other_edge() {
    for (attributes, mnemonic) in [
        (r#"negated="false" edge="rising""#, "LDP"),
        (r#"negated="false" edge="falling""#, "LDF"),
        (r#"negated="true" edge="rising""#, "LDF"),
        (r#"negated="true" edge="falling""#, "LDP"),
        (r#"negated="true" edge="none""#, "LDI"),
        (r#"edge="none""#, "LD"),
    ] {
        let read = read(&ladder(&[
            element("contact", 2, attributes, &[1], "Start"),
            element("coil", 3, "", &[2], "Motor"),
        ]));
        assert_eq!(
            instructions(&read)[0],
            format!("{mnemonic} X000"),
            "{attributes}"
        );
    }
}
