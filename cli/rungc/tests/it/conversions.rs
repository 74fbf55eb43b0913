//! Every format that is read becomes every format that is written: the table in `docs/src/inputs.md`.

use crate::common::{FX3U, folder, rungc, text, wpg};
use std::fs;
use std::path::Path;

const LIST: &str = ";! X000 = start\nLD X000\nOR M0\nANI X001\nOUT M0\nLD M0\nOUT T0 K30\nLD T0\nMOV K5 D0\nOUT Y000\nEND\n";
/// Inputs, and their file names.
const INPUTS: [(&str, &str); 7] = [
    ("instruction list", "list.il"),
    ("drawn ladder", "ladder.txt"),
    ("list export", "export.csv"),
    ("GX Developer project", "MAIN.wpg"),
    ("GX Works2 project", "project.gxw"),
    ("PLCopen XML", "plcopen.xml"),
    ("program memory", "memory.bin"),
];
/// Outputs, and their file name extensions.
const OUTPUTS: [(&str, &str); 7] = [
    ("il", "il"),
    ("ladder", "txt"),
    ("csv", "csv"),
    ("comments", "csv"),
    ("plcopen", "xml"),
    ("image", "bin"),
    ("autoshop", "txt"),
];

fn convert(folder: &Path, from: &str, to: &str, path: &str) {
    let output = rungc(
        folder,
        &["convert", from, "--to", to, "-o", path, "--force"],
    );
    assert!(
        output.status.success(),
        "{from} to {to}: {}",
        text(&output.stderr)
    );
}

/// The instructions of a file, without comments and steps.
fn instructions(folder: &Path, file: &str) -> Vec<String> {
    let list = text(&rungc(folder, &["convert", file, "--to", "il"]).stdout);
    let lines = list.lines().map(|line| {
        let line = line.split(';').next().unwrap_or_default();
        let line = line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ');
        line.split_whitespace().collect::<Vec<_>>().join(" ")
    });
    lines.filter(|line| !line.is_empty()).collect()
}

#[test]
fn every_input_becomes_every_output() {
    let tokens: &[&[u8]] = &[&[0x00], &[0x9C, 0x00], &[0x20], &[0x9D, 0x00], &[0x34]];
    let gxw = Path::new(env!("RUNGC_ROOT")).join("golden/fuzz/corpus/gx-works2");
    let gxw = fs::read_dir(gxw)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let gxw = fs::read(gxw.min().unwrap()).unwrap();
    let folder = folder(&[
        ("list.il", LIST.as_bytes()),
        ("MAIN.wpg", &wpg(FX3U, tokens)),
        ("project.gxw", &gxw),
    ]);
    let path = folder.path();
    for (name, to) in [
        ("ladder.txt", "ladder"),
        ("export.csv", "csv"),
        ("plcopen.xml", "plcopen"),
        ("memory.bin", "image"),
    ] {
        convert(path, "list.il", to, name);
    }
    for (what, input) in INPUTS {
        let expected = instructions(path, input);
        assert!(expected.len() > 2, "{what}: {expected:?}");
        for (to, ending) in OUTPUTS {
            let name = format!("out.{ending}");
            if (input, to) == ("project.gxw", "image") {
                // The project has an operand whose machine code nothing shows.
                let output = rungc(path, &["convert", input, "--to", to, "-o", &name]);
                assert!(text(&output.stderr).contains("E0061"));
                assert!(!path.join(name).exists());
                continue;
            }
            convert(path, input, to, &name);
            let written = path.join(&name);
            if to == "comments" {
                assert!(
                    fs::read(&written).unwrap().starts_with(&[0xff, 0xfe]),
                    "{what}"
                );
            } else {
                assert_eq!(instructions(path, &name), expected, "{what} to {to}");
            }
            fs::remove_file(written).unwrap();
        }
    }
}

/// Comments below the program stay in all forms that hold statements, and what is left out is named.
#[test]
fn comments_below_the_program_are_kept() {
    let list =
        "LD X000\nCALL P0\nFEND\nNOP\nP0\nLD X001\nOUT Y001\nSRET\nEND\nNOP\n; the end\n; of all\n";
    let folder = folder(&[("list.il", list.as_bytes())]);
    let path = folder.path();
    for (to, _) in OUTPUTS
        .iter()
        .filter(|(to, _)| !["comments", "image"].contains(to))
    {
        let output = rungc(path, &["convert", "list.il", "--to", to]);
        let omitted = text(&output.stderr).contains("2 NOP omitted");
        assert_eq!(omitted, *to == "autoshop", "{}", text(&output.stderr));
        fs::write(path.join("out"), &output.stdout).unwrap();
        let back = text(&rungc(path, &["convert", "out", "--to", "il"]).stdout);
        assert!(back.contains("; the end\n; of all\n"), "{to}: {back}");
    }
}

/// What does not come back from an output is named, and nothing else.
#[test]
fn what_a_form_cannot_store_is_named() {
    let list = ";! title = 冲压机\n;! cpu = FX3U\n;! X000 = start\n;! P1 = sub\n; above\n; and\nLD X000 ; note\n\
                CALL P1\nOUT Y000\nFEND\nP1\nSRET\nEND\nNOP\n; below\n";
    let folder = folder(&[("list.il", list.as_bytes())]);
    let path = folder.path();
    let omitted = |file: &str, to: &str| {
        let output = rungc(path, &["convert", file, "--to", to, "-o", "out", "--force"]);
        let messages = text(&output.stderr);
        let lines = messages
            .lines()
            .filter_map(|line| line.split_once(" omitted, "));
        let lines = lines.map(|(what, _)| what.trim_start_matches("rungc: ").to_owned());
        lines.collect::<Vec<_>>()
    };
    for (to, expected) in [
        ("il", &[][..]),
        ("ladder", &[]),
        ("comments", &[]),
        ("csv", &["2 device comments"]),
        ("autoshop", &["1 NOP"]),
        ("plcopen", &["1 device comment", "1 note"]),
        (
            "image",
            &[
                "2 device comments",
                "1 NOP",
                "3 statement lines, 1 note, the title and the CPU type",
            ],
        ),
    ] {
        assert_eq!(omitted("list.il", to), expected, "{to}");
    }
    // Latched devices by choice, and a block of file registers.
    convert(path, "list.il", "image", "memory.bin");
    let mut memory = fs::read(path.join("memory.bin")).unwrap();
    memory[0x30..0x34].copy_from_slice(&[0x00, 0x08, 0x63, 0x08]);
    memory[6] = 1;
    memory.splice(0x5C..0x5C, [0; 1000]);
    fs::write(path.join("chosen.bin"), memory).unwrap();
    let latched =
        "the latched devices (M0 to M99, S500 to S999, C100 to C199, C220 to C255, D200 to D511)";
    let all = format!("{latched} and 1 file register block");
    assert_eq!(omitted("chosen.bin", "il"), [all]);
    assert_eq!(omitted("chosen.bin", "image"), ["1 file register block"]);
    let variables = r#"<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><pous>
<pou name="a" pouType="program"><interface><localVars retain="true"><variable name="D300"><type><INT/></type></variable></localVars></interface>
<body><IL>LD X0
ST Y0</IL></body></pou></pous></types></project>"#;
    fs::write(path.join("variables.xml"), variables).unwrap();
    assert_eq!(omitted("variables.xml", "il"), ["RETAIN of D300"]);
}

/// A folder with a `MAIN.csv` and other programs is all of them; PLCopen XML counts.
#[test]
fn a_folder_is_all_programs_in_it() {
    let folder = folder(&[
        ("MAIN.csv", b"0,LD,X000\r\n1,OUT,Y000\r\n2,END,\r\n"),
        ("other.il", LIST.as_bytes()),
    ]);
    let path = folder.path();
    convert(path, "other.il", "plcopen", "drawn.xml");
    fs::write(path.join("settings.xml"), "<settings/>").unwrap();
    let checked = text(&rungc(path, &["check", "."]).stderr);
    for name in ["MAIN.csv", "other.il", "drawn.xml"] {
        assert!(checked.contains(&format!("Checked {name}")), "{checked}");
    }
    assert!(!checked.contains("settings.xml"), "{checked}");
}

/// A project is equal to the list that was made of it, unless its parameters choose what a list leaves to the model.
#[test]
fn an_image_is_equal_to_its_list() {
    let folder = folder(&[("list.il", b"LD X000\nOUT Y000\nEND\n")]);
    let path = folder.path();
    convert(path, "list.il", "image", "memory.bin");
    assert!(
        rungc(path, &["diff", "memory.bin", "list.il"])
            .status
            .success()
    );
    let mut memory = fs::read(path.join("memory.bin")).unwrap();
    memory[0x30..0x34].copy_from_slice(&[0x00, 0x08, 0x63, 0x08]);
    fs::write(path.join("chosen.bin"), memory).unwrap();
    let output = rungc(path, &["diff", "chosen.bin", "list.il"]);
    assert_eq!(output.status.code(), Some(1));
    let shown = text(&output.stdout);
    assert!(shown.contains("- latched devices = M0 to M99"), "{shown}");
    assert!(!shown.contains("memory capacity"), "{shown}");
}

/// The page has a row for each input and a column for each output.
#[test]
fn the_page_lists_them_all() {
    let page = include_str!(concat!(env!("RUNGC_ROOT"), "/docs/src/inputs.md"));
    let at = page
        .find("## Conversions")
        .expect("a chapter about conversions");
    let table: Vec<_> = page[at..]
        .lines()
        .filter(|line| line.starts_with('|'))
        .collect();
    for (to, _) in OUTPUTS {
        assert!(table[0].contains(&format!("`{to}`")), "{to}");
    }
    for (what, _) in INPUTS {
        assert!(
            table
                .iter()
                .any(|row| row.starts_with(&format!("| {what} |"))),
            "{what}"
        );
    }
}

/// A list without step numbers gets those of the model.
#[test]
fn an_export_has_step_numbers() {
    let folder = folder(&[("a.il", LIST.as_bytes())]);
    convert(folder.path(), "a.il", "csv", "a.csv");
    let bytes = fs::read(folder.path().join("a.csv")).unwrap();
    let units = bytes
        .chunks(2)
        .map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    let text = char::decode_utf16(units)
        .map(Result::unwrap)
        .collect::<String>();
    let steps = text
        .lines()
        .skip(3)
        .map(|row| row.split('\t').next().unwrap().trim_matches('"'));
    let steps: Vec<_> = steps.filter(|step| !step.is_empty()).collect();
    assert_eq!(steps, ["0", "1", "2", "3", "4", "5", "8", "9", "14", "15"]);
}

/// A chosen PLC goes with the program, into every form that can name one, also a variant.
#[test]
fn a_chosen_model_is_named() {
    let folder = folder(&[("list.il", LIST.as_bytes())]);
    let path = folder.path();
    let head = |file: &str| {
        let list = text(&rungc(path, &["convert", file, "--to", "il"]).stdout);
        list.lines()
            .find(|line| line.starts_with(";! cpu"))
            .map(str::to_owned)
    };
    convert(path, "list.il", "csv", "unnamed.csv");
    assert_eq!(head("unnamed.csv"), None);
    for model in ["h2u", "h2u-mtq", "fx1s"] {
        for (to, ending) in OUTPUTS
            .iter()
            .filter(|(to, _)| !matches!(*to, "comments" | "image"))
        {
            for from in ["list.il", "unnamed.csv"] {
                let name = format!("named.{ending}");
                let command = [
                    "convert", from, "--to", to, "-o", &name, "--force", "--model", model,
                ];
                let output = rungc(path, &command);
                assert!(
                    output.status.success(),
                    "{command:?}: {}",
                    text(&output.stderr)
                );
                let expected = format!(";! cpu = {}", model.to_uppercase());
                assert_eq!(head(&name), Some(expected), "{command:?}");
            }
        }
    }
    // The named variant is the one that is checked for.
    fs::write(
        path.join("sin.il"),
        ";! cpu = H2U-MTQ\nLD X0\nDSIN D0 D2\nEND\n",
    )
    .unwrap();
    let found = text(&rungc(path, &["check", "sin.il"]).stderr);
    let chosen = text(&rungc(path, &["check", "sin.il", "--model", "h2u-mtq"]).stderr);
    assert!(
        found.contains("H2U-MTQ") && found.contains("error[E"),
        "{found}\n{chosen}"
    );
}
