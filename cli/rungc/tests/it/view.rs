//! Programs drawn as ladder.

use crate::common::{MOTOR, folder, rungc, shown, text};
use std::path::Path;
use std::process::Command;

#[test]
fn a_program_is_drawn_with_numbers_steps_and_comments() {
    let list = format!(";! X000 = start\n;! Y000 = main contactor\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    insta::assert_snapshot!(shown(folder.path(), &["view", "motor.il", "--width", "80"]));
}

#[test]
fn networks_are_chosen_by_number_device_and_finding() {
    let list = "LD X0\nOUT Y0\nLD X1\nMOV K2M10 D0\nLD X2\nOUT Y0\nLD X3\nOUT Y3\nEND\n";
    let folder = folder(&[("list.il", list.as_bytes())]);
    let drawn = |args: &[&str]| {
        let out = rungc(folder.path(), &[&["view", "list.il"], args].concat());
        assert!(out.status.success(), "{args:?}");
        let page = text(&out.stdout);
        let numbers = page.lines();
        let numbers = numbers.filter_map(|line| line.split(' ').next()?.parse().ok());
        numbers.collect::<Vec<u32>>()
    };
    assert_eq!(drawn(&[]), [1, 2, 3, 4, 5]);
    assert_eq!(drawn(&["--network", "2..3", "--network", "5"]), [2, 3, 5]);
    assert_eq!(drawn(&["--device", "M17"]), [2]);
    assert_eq!(drawn(&["--device", "y0", "--network", "2..9"]), [3]);
    assert_eq!(drawn(&["--around", "W0203"]), [1, 3]);
}

#[test]
fn diagnostics_show_their_network_with_the_place_marked() {
    let list = "LD X0\nOR M0\nANI X1\nOUT Y0\nLD X2\nMPS\nAND M7999\nOUT Y1\nMPP\nMOV K70000 D0\nLD X4\nOUT Y0\nEND\nLD\n";
    let folder = folder(&[("list.il", list.as_bytes())]);
    insta::assert_snapshot!(shown(folder.path(), &["check", "list.il", "--draw"]));
    // Reports for tools stay as they are.
    let json = |more: &[&str]| {
        let args = [&["check", "list.il", "--format", "json"], more].concat();
        rungc(folder.path(), &args).stdout
    };
    assert_eq!(json(&[]), json(&["--draw"]));
}

#[test]
fn what_cannot_be_chosen_is_reported() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let messages = |args: &[&str]| {
        let out = rungc(folder.path(), &[&["view", "motor.il"], args].concat());
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        assert!(out.stdout.is_empty());
        text(&out.stderr)
    };
    assert!(messages(&["--device", "M99"]).contains("none of the 6 networks matches"));
    assert!(messages(&["--device", "Q1"]).contains("devices are written"));
    assert!(messages(&["--network", "3..1"]).contains("counted from 1"));
    assert!(messages(&["--sfc"]).contains("the program has no step ladder"));
    assert!(messages(&["--sfc", "--network", "1"]).contains("cannot be used with"));
    assert!(messages(&["--around", "E9999"]).contains("not a diagnostic code"));
}

#[test]
fn a_page_and_a_picture_are_files() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    for (name, start) in [("motor.html", "<!DOCTYPE html>"), ("motor.svg", "<svg")] {
        let write = |more: &[&str]| {
            let out = rungc(
                folder.path(),
                &[&["view", "motor.il", "-o", name], more].concat(),
            );
            (out.status.code(), text(&out.stderr))
        };
        assert_eq!(write(&[]).0, Some(0));
        let written = std::fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(written.starts_with(start), "{written}");
        assert!(written.contains("T0 K3"));
        assert_eq!(write(&[]).0, Some(0), "an earlier one is replaced");
        std::fs::write(folder.path().join(name), "mine\n").unwrap();
        let (code, messages) = write(&[]);
        assert_eq!(code, Some(2));
        assert!(messages.contains("already exists"), "{messages}");
        assert_eq!(write(&["--force"]).0, Some(0));
    }
    let out = rungc(folder.path(), &["view", "motor.il", "-o", "motor.bmp"]);
    assert_eq!(out.status.code(), Some(2));
    assert!(text(&out.stderr).contains("ends in .html, .pdf or .svg"));
    assert!(!folder.path().join("motor.bmp").exists());
}

#[test]
fn a_document_is_the_same_each_time_and_has_all_pages() {
    let list = format!(
        ";! X000 = 启动按钮\n;! Y000 = Łódź\n; 电机\n{}",
        MOTOR.repeat(40)
    );
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let write = |name: &str| {
        let out = rungc(folder.path(), &["view", "motor.il", "-o", name]);
        assert!(out.status.success(), "{}", text(&out.stderr));
        std::fs::read(folder.path().join(name)).unwrap()
    };
    let pdf = write("one.pdf");
    assert_eq!(pdf, write("two.pdf"));
    let holds = |what: &str| pdf.windows(what.len()).any(|part| part == what.as_bytes());
    assert!(pdf.starts_with(b"%PDF-1.5") && pdf.ends_with(b"%%EOF"));
    let pages = pdf.windows(12).filter(|part| part == b"/Type /Page\n");
    assert_eq!(pages.count(), 11);
    for what in ["/Count 11", "/UniGB-UTF16-H", "(motor.il)", "/FlateDecode"] {
        assert!(holds(what), "{what}");
    }
}

/// The standard output of a tool that reads PDF, or nothing where it is not installed.
fn read_by(folder: &Path, tool: &str, args: &[&str]) -> Option<Vec<u8>> {
    let out = match Command::new(tool).args(args).current_dir(folder).output() {
        Ok(out) => out,
        Err(_) => {
            let required = std::env::var_os("RUNGC_REQUIRE_PEERS").is_some();
            assert!(
                !required,
                "RUNGC_REQUIRE_PEERS is set, but there is no {tool}"
            );
            eprintln!("skipped: there is no {tool}");
            return None;
        }
    };
    let messages = text(&out.stderr);
    assert!(
        out.status.success() && messages.is_empty(),
        "{tool}: {messages}"
    );
    Some(out.stdout)
}

/// Number of dots in each picture of a PGM stream that are not white.
fn dark_dots(mut pictures: &[u8]) -> Vec<usize> {
    let mut dark = Vec::new();
    while pictures.starts_with(b"P5") {
        let mut fields = pictures
            .splitn(4, |byte| byte.is_ascii_whitespace())
            .skip(1);
        let mut number = || -> usize {
            let field = std::str::from_utf8(fields.next().unwrap()).unwrap();
            field.parse().unwrap()
        };
        let (width, height) = (number(), number());
        let rest = fields.next().unwrap();
        // The brightest value, one space, the dots.
        let start = rest.iter().position(u8::is_ascii_whitespace).unwrap() + 1;
        let (dots, after) = rest[start..].split_at(width * height);
        dark.push(dots.iter().filter(|dot| **dot < 128).count());
        pictures = after;
    }
    dark
}

/// Programs that others have written check the document, find its texts, and draw its pages.
#[test]
fn readers_of_pdf_take_the_document() {
    let list = format!(
        ";! X000 = 启动按钮\n;! M0 = motor latch\n; 电机\n{}\
         LD M8002\nSET S0\nSTL S0\nLD X5\nSET S20\nSTL S20\nOUT Y7\nLD X6\nOUT S0\nRET\n\
         LD X7\n{}OUT Y10\nEND\n",
        MOTOR.replace("END\n", "").repeat(12),
        "AND M7\n".repeat(30)
    );
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let path = folder.path();
    let out = rungc(path, &["view", "motor.il", "-o", "motor.pdf"]);
    assert!(out.status.success(), "{}", text(&out.stderr));
    if let Some(messages) = read_by(path, "qpdf", &["--check", "motor.pdf"]) {
        assert!(text(&messages).contains("No syntax or stream encoding errors"));
    }
    if let Some(found) = read_by(path, "pdftotext", &["-layout", "motor.pdf", "-"]) {
        let found = text(&found);
        for what in [
            "X000",
            "T0 K3",
            "ADD D0 K1 D0",
            "motor latch",
            "启动按钮",
            "电机",
            "S20",
            "→0",
        ] {
            assert!(found.contains(what), "{what}:\n{found}");
        }
    }
    if let Some(pages) = read_by(path, "pdftoppm", &["-r", "40", "-gray", "motor.pdf"]) {
        let dark = dark_dots(&pages);
        assert!(dark.len() > 3, "{dark:?}");
        assert!(dark.iter().all(|dots| *dots > 150), "{dark:?}");
    }
}
