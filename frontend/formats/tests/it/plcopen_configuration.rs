//! PLCopen XML: the programs that run, and what their declarations say beside devices.

use rungc_frontend::{Names, Read, ReadOptions, read_bytes_with};

/// A program of one rung.
fn program(name: &str, input: &str, output: &str) -> String {
    format!(
        r#"<pou name="{name}" pouType="program"><interface/><body><IL><xhtml:p>LD {input}
ST {output}</xhtml:p></IL></body></pou>"#
    )
}

fn project(pous: &str, instances: &str) -> Read {
    let text = format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<project xmlns="http://www.plcopen.org/xml/tc6_0201" xmlns:xhtml="http://www.w3.org/1999/xhtml">
  <contentHeader name="Press"/>
  <types><dataTypes/><pous>{pous}</pous></types>
  <instances><configurations><configuration name="c">{instances}</configuration></configurations></instances>
</project>"#
    );
    let options = ReadOptions {
        names: Names::parse("*,M100-M199\n*,D100-D199\n").unwrap(),
        ..ReadOptions::default()
    };
    read_bytes_with("plc.xml", text.as_bytes(), &options).unwrap()
}

fn instructions(read: &Read) -> String {
    let instrs = read.program.instrs.iter().map(ToString::to_string);
    instrs.collect::<Vec<_>>().join(", ")
}

fn findings(read: &Read) -> String {
    let line = |d: &rungc_syntax::Diagnostic| format!("{} {}\n", d.code, d.message);
    read.diagnostics.iter().map(line).collect()
}

fn two() -> String {
    program("First", "X0", "Y0") + &program("Second", "X1", "Y1")
}

fn resource(tasks: &str) -> String {
    format!(r#"<resource name="plc">{tasks}</resource>"#)
}

fn task(name: &str, attributes: &str, programs: &[&str]) -> String {
    let instances = programs.iter();
    let instances = instances
        .map(|program| format!(r#"<pouInstance name="i{program}" typeName="{program}"/>"#));
    let instances: String = instances.collect();
    format!(r#"<task name="{name}" {attributes}>{instances}</task>"#)
}

#[test]
fn programs_run_that_have_an_instance() {
    let both = "LD X000, OUT Y000, LD X001, OUT Y001, END";
    let swapped = "LD X001, OUT Y001, LD X000, OUT Y000, END";
    let every = r#"interval="T#20ms" priority="1""#;
    let urgent = r#"interval="T#0.02s" priority="0""#;
    let codesys = r#"<pouInstance name="First" typeName=""/>"#;
    let not_second = "N0011 no task runs `Second`\n";
    for (tasks, expected, found) in [
        (String::new(), both, ""),
        (task("t", every, &["First", "Second"]), both, ""),
        (task("t", every, &["second", "First"]), swapped, ""),
        (
            task("a", every, &["First"]) + &task("b", urgent, &["Second"]),
            swapped,
            "",
        ),
        (
            task("t", every, &["First"]),
            "LD X000, OUT Y000, END",
            not_second,
        ),
        (codesys.to_owned(), "LD X000, OUT Y000, END", not_second),
    ] {
        let read = project(&two(), &resource(&tasks));
        assert_eq!(
            (instructions(&read).as_str(), findings(&read).as_str()),
            (expected, found)
        );
    }
}

#[test]
fn tasks_that_one_scan_cannot_replace_are_errors() {
    let every = r#"interval="T#20ms" priority="1""#;
    let slow = r#"interval="T#1s" priority="2""#;
    let event = r#"single="Start" priority="1""#;
    let first = || task("t", every, &["First"]);
    for (tasks, found) in [
        (
            resource(&task("t", every, &["First", "First"])),
            "E0063 line 7: the program `First` runs twice\n",
        ),
        (
            resource(&task("t", every, &["Third"])),
            "E0063 line 7: the project has no program `Third`, which is to run\n",
        ),
        (
            resource(&task("t", event, &["First"])),
            "E0063 line 7: element `task` `t` waits for the event `Start`\n",
        ),
        (
            resource(&(first() + &task("u", slow, &["Second"]))),
            "E0063 line 7: element `task` `u` has another interval than element `task` `t`\n",
        ),
        (
            resource(&first()) + &resource(&task("u", every, &["Second"])),
            "E0063 line 7: element `resource` `plc` is another PLC\n",
        ),
    ] {
        assert_eq!(findings(&project(&two(), &tasks)), found);
    }
}

/// A program with these declarations.
fn declared(lists: &str, body: &str) -> Read {
    let pou = format!(
        r#"<pou name="main" pouType="program"><interface>{lists}</interface>
<body><IL><xhtml:p>{body}</xhtml:p></IL></body></pou>"#
    );
    project(&pou, "")
}

#[test]
fn names_do_not_distinguish_case() {
    let twice = r#"<localVars><variable name="start" address="%IX0.0"><type><BOOL/></type></variable>
<variable name="Start" address="%IX0.1"><type><BOOL/></type></variable></localVars>"#;
    assert_eq!(
        findings(&declared(twice, "LD start\nST Y0")),
        "E0063 line 5: element `variable` `Start` has the name of another variable\n"
    );
    let jump = declared("", "LD X0\nJMPC Done\nLD X1\nST Y0\nDONE:\nLD X2\nST Y1");
    assert_eq!(
        instructions(&jump),
        "LD X000, CJ P0, LD X001, OUT Y000, P0, LD X002, OUT Y001, END"
    );
}

#[test]
fn variables_that_nothing_uses_keep_what_they_say() {
    let lists = r#"<localVars retain="true"><variable name="Count" address="%MW300"><type><DINT/></type>
<initialValue><simpleValue value="7"/></initialValue>
<documentation><xhtml:p>pieces</xhtml:p></documentation></variable></localVars>
<localVars><variable name="Mode" address="%MX0.5"><type><BOOL/></type>
<initialValue><simpleValue value="TRUE"/></initialValue></variable>
<variable name="T5"><type><derived name="TON"/></type>
<documentation><xhtml:p>pause</xhtml:p></documentation></variable></localVars>"#;
    let read = declared(lists, "LD X0\nST Y0");
    assert_eq!(
        instructions(&read),
        "LD M8002, DMOV K7 D300, SET M5, LD X000, OUT Y000, END"
    );
    let comments = read.program.comments.iter();
    let comments: Vec<_> = comments
        .map(|(device, text)| format!("{device} {text}"))
        .collect();
    assert_eq!(comments, ["M5 Mode", "T5 pause", "D300 pieces"]);
    let retained: Vec<_> = read
        .program
        .retained
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(retained, ["D300 to D301"]);
}

#[test]
fn what_is_no_name_is_not_called_a_variable() {
    for written in ["1.5", "X0 AND X1", "T#1s"] {
        let found = findings(&declared("", &format!("LD {written}\nST D0")));
        let what =
            format!("`{written}` is neither a variable nor a constant of a PLC of the family");
        assert!(found.contains(&what), "{written}: {found}");
    }
}
