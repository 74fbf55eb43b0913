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
    assert!(text(&out.stderr).contains("ends in .html or .svg"));
    assert!(!folder.path().join("motor.bmp").exists());
    let out = rungc(folder.path(), &["view", "motor.il", "-o", "motor.pdf"]);
    assert_eq!(out.status.code(), Some(2));
    assert!(text(&out.stderr).contains("print it from a browser"));
}
