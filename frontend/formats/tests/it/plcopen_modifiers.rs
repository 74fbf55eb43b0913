//! PLCopen XML: no attribute that changes a value, and no element, is dropped silently.

use rungc_frontend::{Names, ReadOptions, read_bytes_with};

/// The list that a body becomes, or what is wrong with it.
fn list(body: &str) -> Result<Vec<String>, String> {
    let text = format!(
        r#"<project xmlns="http://www.plcopen.org/xml/tc6_0201" xmlns:xhtml="http://www.w3.org/1999/xhtml">
  <types><dataTypes/><pous><pou name="main" pouType="program"><interface/>
  <body>{body}</body></pou></pous></types><instances><configurations/></instances>
</project>"#
    );
    let options = ReadOptions {
        names: Names::parse("B,M20\nR,M21\n").unwrap(),
        ..ReadOptions::default()
    };
    let read = read_bytes_with("plc.xml", text.as_bytes(), &options).unwrap();
    let findings: Vec<_> = read.diagnostics.iter().collect();
    match findings.as_slice() {
        [] => Ok(read.program.instrs.iter().map(|i| i.to_string()).collect()),
        _ => {
            assert!(findings.iter().all(|d| d.code == "E0063"), "{findings:?}");
            Err(findings
                .iter()
                .map(|d| format!("{}\n", d.message))
                .collect())
        }
    }
}

fn variable(kind: &str, id: u32, attributes: &str, from: Option<u32>, name: &str) -> String {
    let into = from.map_or_else(String::new, |id| {
        format!(r#"<connectionPointIn><connection refLocalId="{id}"/></connectionPointIn>"#)
    });
    format!(
        r#"<{kind} localId="{id}" {attributes}><position x="{id}" y="{id}"/>{into}<expression>{name}</expression>
        <variable>{name}</variable></{kind}>"#
    )
}

/// A block of two inputs, with attributes at its second input and at its output.
fn block(kind: &str, pins: [&str; 3], input: &str, output: &str) -> String {
    let [first, second, out] = pins;
    let pin = |name: &str, id: u32, attributes: &str| {
        format!(
            r#"<variable formalParameter="{name}" {attributes}><connectionPointIn><connection refLocalId="{id}"/>
            </connectionPointIn></variable>"#
        )
    };
    format!(
        r#"<block localId="20" typeName="{kind}" instanceName="{0}"><position x="20" y="20"/>
        <inputVariables>{1}{2}</inputVariables><outputVariables><variable formalParameter="{out}" {output}/>
        </outputVariables></block>"#,
        kind.get(..1)
            .filter(|_| !kind.starts_with(['A', 'O', 'X']))
            .map_or("", |name| if name == "S" { "B" } else { name }),
        pin(first, 10, ""),
        if second.is_empty() {
            String::new()
        } else {
            pin(second, 11, input)
        },
    )
}

/// Drawings with attributes at one place each.
fn places(attributes: &str) -> Vec<(&'static str, String)> {
    let rail = r#"<leftPowerRail localId="1"/>"#;
    let x0 = variable("inVariable", 10, "", None, "X0");
    let x1 = |attributes: &str| variable("inVariable", 11, attributes, None, "X1");
    let to = variable("outVariable", 30, "", Some(20), "Y0");
    let ladder = |contact: &str, coil: &str| {
        let contact = variable("contact", 2, contact, Some(1), "X0");
        let coil = variable("coil", 3, coil, Some(2), "Y0");
        format!("<LD>{rail}{contact}{coil}</LD>")
    };
    let diagram = |block: String| format!("<FBD>{x0}{}{block}{to}</FBD>", x1(""));
    let through = variable("inOutVariable", 12, attributes, Some(10), "M0");
    let of = variable("outVariable", 13, "", Some(12), "Y1");
    let jump = format!(
        r#"<LD>{rail}<jump localId="4" label="End" {attributes}><connectionPointIn><connection refLocalId="1"/>
        </connectionPointIn></jump><label localId="5" label="End"/></LD>"#
    );
    let number = variable("inVariable", 10, attributes, None, "D1");
    let moved = variable("outVariable", 30, "", Some(10), "D0");
    let moved_to = variable("outVariable", 30, attributes, Some(10), "D0");
    let plain = variable("inVariable", 10, "", None, "D1");
    let mut all = vec![
        ("contact", ladder(attributes, "")),
        ("coil", ladder("", attributes)),
        (
            "inVariable",
            format!(
                "<FBD>{}{}</FBD>",
                x1(attributes),
                variable("outVariable", 30, "", Some(11), "Y0")
            ),
        ),
        (
            "outVariable",
            format!(
                "<FBD>{}{}</FBD>",
                x1(""),
                variable("outVariable", 30, attributes, Some(11), "Y0")
            ),
        ),
        ("inOutVariable", format!("<FBD>{x0}{through}{of}</FBD>")),
        ("number", format!("<FBD>{number}{moved}</FBD>")),
        ("register", format!("<FBD>{plain}{moved_to}</FBD>")),
        ("jump", jump),
        (
            "rail",
            format!(r#"<LD><leftPowerRail localId="1" {attributes}/></LD>"#),
        ),
    ];
    for (kind, pins) in [
        ("AND", ["IN1", "IN2", "OUT"]),
        ("OR", ["IN1", "IN2", "OUT"]),
        ("XOR", ["IN1", "IN2", "OUT"]),
        ("SR", ["S1", "R", "Q1"]),
        ("R_TRIG", ["CLK", "", "Q"]),
    ] {
        all.push((kind, diagram(block(kind, pins, "", attributes))));
        if !pins[1].is_empty() {
            all.push((kind, diagram(block(kind, pins, attributes, ""))));
        }
    }
    all
}

/// Each place either does what an attribute says or names it.
#[test]
fn no_modifier_is_dropped() {
    let lists = |attributes: &str| {
        let places = places(attributes).into_iter();
        places
            .map(|(place, body)| (place, list(&body)))
            .collect::<Vec<_>>()
    };
    let plain = lists("");
    assert!(plain.iter().all(|(_, list)| list.is_ok()), "{plain:?}");
    let values = [
        "true", "TRUE", "rising", "falling", "both", "set", "reset", "S", "",
    ];
    for name in ["negated", "edge", "storage"] {
        for value in values {
            let changed = lists(&format!(r#"{name}="{value}""#));
            for ((place, before), (_, after)) in plain.iter().zip(changed) {
                assert_ne!(*before, after, "{name}={value} at {place}");
            }
        }
    }
    for default in [
        r#"negated="false""#,
        r#"negated="0""#,
        r#"edge="none" storage="none""#,
    ] {
        assert_eq!(lists(default), plain, "{default}");
    }
    let through = |(place, _): &(&str, _)| *place == "inOutVariable";
    let at = plain.iter().position(through).unwrap();
    for (name, value) in [
        ("negated", "true"),
        ("edge", "falling"),
        ("storage", "reset"),
    ] {
        for way in ["In", "Out"] {
            let changed = lists(&format!(r#"{name}{way}="{value}""#));
            assert_ne!(changed[at], plain[at], "{name}{way}");
        }
    }
}

/// Combinations, in the order negation, edge, storage.
#[test]
fn modifiers_are_combined() {
    let rail = r#"<leftPowerRail localId="1"/>"#;
    let coil = |attributes: &str, from: u32| variable("coil", 9, attributes, Some(from), "Y0");
    let one = variable("contact", 2, "", Some(1), "X0");
    let not = variable("contact", 2, r#"negated="true""#, Some(1), "X0");
    let two = variable("contact", 3, "", Some(2), "X1");
    let all = [
        (
            format!("{one}{}", coil(r#"storage="set" edge="rising""#, 2)),
            "LDP X000, SET Y000",
        ),
        (
            format!("{not}{}", coil(r#"storage="set" edge="rising""#, 2)),
            "LDF X000, SET Y000",
        ),
        (
            format!("{one}{two}{}", coil(r#"storage="reset" edge="falling""#, 3)),
            "LD X000, AND X001, MEF, RST Y000",
        ),
        (
            coil(r#"storage="set" edge="rising""#, 1),
            "LD M8002, SET Y000",
        ),
        (
            coil(r#"storage="set" edge="falling""#, 1),
            "LDI M8000, SET Y000",
        ),
        (
            format!("{one}{}", coil(r#"negated="true" storage="set""#, 2)),
            "LDI X000, SET Y000",
        ),
        (
            format!(
                "{}{}",
                variable("inVariable", 5, r#"negated="1" edge="rising""#, None, "X0"),
                coil("", 5)
            ),
            "LDF X000, OUT Y000",
        ),
        (
            block("AND", ["IN1", "IN2", "OUT"], "", r#"negated="true""#)
                + &variable("inVariable", 10, "", None, "X0")
                + &variable("inVariable", 11, "", None, "X1")
                + &variable("outVariable", 30, "", Some(20), "Y0"),
            "LD X000, AND X001, INV, OUT Y000",
        ),
    ];
    for (body, expected) in all {
        let list = list(&format!("<LD>{rail}{body}</LD>")).unwrap();
        assert_eq!(list.join(", "), format!("{expected}, END"));
    }
}

/// Wires name elements by their numbers: two elements of one number are an error, not one of them.
#[test]
fn elements_with_one_number_or_name_are_named() {
    let rail = r#"<leftPowerRail localId="1"/>"#;
    let contact = |name| variable("contact", 2, "", Some(1), name);
    let coil = variable("coil", 3, "", Some(2), "Y0");
    let same = format!("<LD>{rail}{}{}{coil}</LD>", contact("X0"), contact("X1"));
    let steps = r#"<SFC><step localId="1" name="S5" initialStep="yes"/><step localId="2" name="s5"/></SFC>"#;
    insta::assert_snapshot!([list(&same).unwrap_err(), list(steps).unwrap_err()].concat());
}

/// What stands before a parenthesis is not lost with its end.
#[test]
fn open_parentheses_are_named() {
    let list = |text: &str| list(&format!("<IL><xhtml:p>{text}</xhtml:p></IL>"));
    for (text, open) in [
        ("LD X0\nAND( X1\nST Y0", "AND( X1"),
        ("LD X0\nOR(\nLD X1\nANDN( X2\n)\nST Y0", "OR("),
        ("LD X0\nAND( X1\nL1: LD X2\nST Y0", "AND( X1"),
    ] {
        let found = list(text).unwrap_err();
        assert!(
            found.contains(&format!("`{open}` is not closed")),
            "{found}"
        );
    }
    assert!(list("LD X0\nAND( X1\nOR X2\n)\nST Y0").is_ok());
}
