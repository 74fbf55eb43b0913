//! Reasons for a device to be on or off.

use crate::common::{folder, rungc, shown, text};

const STATION: &str = "\
;! X000 = start\n;! X001 = stop\n;! X002 = guard closed\n;! Y000 = motor\n;! M0 = automatic\n;! M1 = automatic\n\
LD X000\nOR M0\nANI X001\nAND X002\nOUT M0\nLD M0\nOUT T0 K20\nLD T0\nOUT Y000\nLD X003\nSET M500\nEND\n";

#[test]
fn an_answer_is_text_or_an_object() {
    let folder = folder(&[("station.il", STATION.as_bytes())]);
    let why = |args: &[&str]| shown(folder.path(), &[&["why", "station.il"], args].concat());
    insta::assert_snapshot!("why_program", why(&["Y000"]));
    let started = ["motor", "--set", "X000=1,X002=1", "--for", "1s"];
    insta::assert_snapshot!("why_moment", why(&started));
    insta::assert_snapshot!("why_latched", why(&["M500"]));
    let json = why(&[&started[..], &["--format", "json"]].concat());
    insta::assert_snapshot!("why_json", json);
    insta::assert_snapshot!(
        "why_chinese",
        why(&[&started[..], &["--lang", "zh"]].concat())
    );
    let how = ["motor", "--how", "--lang", "zh"];
    insta::assert_snapshot!("why_how_chinese", why(&how));
}

#[test]
fn a_program_may_come_from_the_settings() {
    let settings = "[project]\nprogram = \"station.il\"\n";
    let files: [(&str, &[u8]); 2] = [
        ("station.il", STATION.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
    ];
    let folder = folder(&files);
    let printed = |args: &[&str]| text(&rungc(folder.path(), args).stdout);
    let by_settings = printed(&["why", "motor"]);
    assert!(by_settings.contains("OUT Y000"), "{by_settings}");
    assert_eq!(by_settings, printed(&["why", "station.il", "Y0"]));
}

#[test]
fn a_person_may_press_what_a_panel_shows() {
    let list = "LD M10\nAND X000\nSET Y000\nRST M10\nEND\n";
    let settings = "[project]\nprogram = \"panel.il\"\n[hmi]\nwrites = \"M10\"\n";
    let found = |settings: &str| {
        let files: [(&str, &[u8]); 2] = [
            ("panel.il", list.as_bytes()),
            ("rungc.toml", settings.as_bytes()),
        ];
        let folder = folder(&files);
        let answer = shown(folder.path(), &["why", "panel.il", "Y000", "--how"]);
        answer[answer.find("\n\n").unwrap()..].to_string()
    };
    insta::assert_snapshot!("why_how_panel", found(settings));
    insta::assert_snapshot!("why_how_none", found("[project]\nprogram = \"panel.il\"\n"));
}

#[test]
fn devices_without_an_answer_are_errors() {
    let folder = folder(&[("station.il", STATION.as_bytes())]);
    for (args, expected) in [
        (&["Y001"][..], "no instruction names `Y001`"),
        (&["motr"], "did you mean `motor`?"),
        (
            &["automatic"],
            "is the comment of several devices, such as M0 and M1",
        ),
        (&["Y777"], "`Y777` does not exist on"),
        (&["M99999"], "does not exist on Mitsubishi FX3U"),
        (&["Y000", "--set", "X008=1"], "octal"),
    ] {
        let out = rungc(folder.path(), &[&["why", "station.il"], args].concat());
        let message = text(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{args:?}: {message}");
        assert!(out.stdout.is_empty(), "{args:?}");
    }
}

#[test]
fn what_is_set_after_the_moment_is_named() {
    let folder = folder(&[("station.il", STATION.as_bytes())]);
    let args = [
        "why",
        "station.il",
        "Y0",
        "--set",
        "X000=1@2s",
        "--for",
        "1s",
    ];
    let said = text(&rungc(folder.path(), &args).stderr);
    assert!(
        said.contains("`X000` was not set: its time, 2000 ms"),
        "{said}"
    );
}
