//! Programs drawn as ladder.

mod common;

use common::{MOTOR, folder, rungc, shown, text};

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
fn what_cannot_be_chosen_is_said() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let said = |args: &[&str]| {
        let out = rungc(folder.path(), &[&["view", "motor.il"], args].concat());
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        assert!(out.stdout.is_empty());
        text(&out.stderr)
    };
    assert!(said(&["--device", "M99"]).contains("none of the 6 networks matches"));
    assert!(said(&["--device", "Q1"]).contains("a device is written"));
    assert!(said(&["--network", "3..1"]).contains("counted from 1"));
    assert!(said(&["--sfc"]).contains("the program has no step ladder"));
    assert!(said(&["--sfc", "--network", "1"]).contains("cannot be used with"));
    assert!(said(&["--around", "E9999"]).contains("not a diagnostic code"));
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
        let (code, said) = write(&[]);
        assert_eq!(code, Some(2));
        assert!(said.contains("already exists"), "{said}");
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
