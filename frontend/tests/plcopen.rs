//! PLCopen XML: what becomes of ladders and lists, and what is named as foreign.

use rungc_frontend::{Read, ReadOptions, names, read_bytes, read_bytes_with};
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
        ["X000 start button", "X012 Stop", "Y010 Motor", "M7 M7"]
    );
}

#[test]
fn a_table_names_devices() {
    let table = "Hidden,M20\r\n\"start\"\tX005\n";
    let options = ReadOptions {
        names: names(table).unwrap(),
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
    assert_eq!(names("Start,X000\nStop\n"), Err("Stop".to_owned()));
    assert_eq!(names("Start,%IX0.0\n"), Err("Start,%IX0.0".to_owned()));
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
