//! Devices named by their comments, settings without effect, and how much runs say of warnings.

use crate::common::{code, folder, rungc, text};
use std::process::Output;

const PRESS: &str = "\
;! X000 = Start button
;! Y000 = Main contactor
;! D0 = Speed
;! M5 = Lamp
;! M6 = lamp
LD X000
OUT Y000
LD M5
OR M6
OUT M7
LD= D0 K5
OUT Y001
END
";

#[test]
fn every_option_takes_comments() {
    let folder = folder(&[("press.il", PRESS.as_bytes())]);
    for (by_comment, by_device) in [
        (
            &["run", "press.il", "--set", "start BUTTON=1@20ms"][..],
            &["run", "press.il", "--set", "X000=1@20ms"][..],
        ),
        (
            &[
                "run",
                "press.il",
                "--watch",
                "Main contactor,Speed,Speed.f32",
            ],
            &["run", "press.il", "--watch", "Y000,D0,D0.f32"],
        ),
        (
            &[
                "run", "press.il", "--watch", "D0", "--plot", "a.svg", "--over", "Speed",
            ],
            &[
                "run", "press.il", "--watch", "D0", "--plot", "a.svg", "--over", "D0",
            ],
        ),
        (
            &["xref", "press.il", "--device", "Main contactor"],
            &["xref", "press.il", "--device", "Y000"],
        ),
        (
            &["xref", "press.il", "--device", "Main contactor..Y001"],
            &["xref", "press.il", "--device", "Y000-Y001"],
        ),
        (
            &["view", "press.il", "--device", "Speed"],
            &["view", "press.il", "--device", "D0"],
        ),
        (
            &[
                "explore", "press.il", "--scans", "200", "--free", "speed", "--never", "Y001",
            ],
            &[
                "explore", "press.il", "--scans", "200", "--free", "D0", "--never", "Y001",
            ],
        ),
        (
            &[
                "verify", "press.il", "--replay", "interp", "--free", "speed", "--never", "Y001",
            ],
            &[
                "verify", "press.il", "--replay", "interp", "--free", "D0..D0", "--never", "Y001",
            ],
        ),
    ] {
        let [named, plain] = [by_comment, by_device].map(|args| rungc(folder.path(), args));
        let timeless = |output: &Output| {
            let text = text(&output.stdout);
            let lines = text.lines().map(|line| match line.rsplit_once(" (") {
                Some((before, time)) if time.ends_with(" s)") => before.to_string(),
                _ => line.to_string(),
            });
            lines.collect::<Vec<_>>()
        };
        assert_eq!(timeless(&named), timeless(&plain), "{by_comment:?}");
        assert_eq!(named.status, plain.status, "{by_comment:?}");
    }
}

/// Commas separate items, but not within a comment, whether or not it is in quotes.
#[test]
fn comments_may_contain_commas() {
    let list = ";! D0 = Speed, set\n;! Y000 = Lamp, left\nLD= D0 K5\nOUT Y000\nOUT Y001\nEND\n";
    let folder = folder(&[("lamp.il", list.as_bytes())]);
    let table = |set: &str, watch: &str| {
        let args = ["run", "lamp.il", "--set", set, "--watch", watch];
        let output = rungc(folder.path(), &args);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let plain = table("D0=5@20ms", "Y0,Y1,D0");
    assert_eq!(
        table("Speed, set=5@20ms", "Lamp, left,Y1,speed,  set"),
        plain
    );
    assert_eq!(
        table("\"Speed, set\"=H5@20ms", "Y0..Y1,\"Speed, set\""),
        plain
    );
    for (set, why) in [
        ("D0=1,,D0=2", "nothing stands before or after a comma"),
        ("D0=70000", "which holds integers from -32768 to 65535"),
        ("Y0=2", "which is 0 or 1"),
        ("D0=x", "is not a number: write for example"),
        ("D0=5@-1s", "`-1s` is not a time"),
    ] {
        let output = rungc(folder.path(), &["run", "lamp.il", "--set", set]);
        assert_eq!(output.status.code(), Some(2), "{set}");
        let messages = text(&output.stderr);
        assert!(messages.contains(why), "{set}: {messages}");
    }
}

#[test]
fn names_that_are_not_there_are_explained_by_every_option() {
    let folder = folder(&[("press.il", PRESS.as_bytes())]);
    for args in [
        &["run", "press.il", "--set"][..],
        &["run", "press.il", "--watch"],
        &[
            "run", "press.il", "--watch", "D0", "--plot", "a.svg", "--over",
        ],
        &["xref", "press.il", "--device"],
        &["view", "press.il", "--device"],
        &["explore", "press.il", "--free"],
        &["verify", "press.il", "--never", "Y001", "--free"],
        &[
            "build",
            "press.il",
            "--board",
            "fx3u-f103vc",
            "--emit",
            "elf",
            "--set",
        ],
    ] {
        let named = |name: &str| {
            let value = match args.last() {
                Some(&"--set") => format!("{name}=1"),
                _ => name.to_string(),
            };
            let output = rungc(folder.path(), &[args, &[&value]].concat());
            assert_eq!(output.status.code(), Some(2), "{args:?} {name}");
            text(&output.stderr)
        };
        let near = named("Main contacter");
        assert!(
            near.contains("did you mean `Main contactor`?"),
            "{args:?}: {near}"
        );
        let several = named("Lamp");
        assert!(several.contains("such as M5 and M6"), "{args:?}: {several}");
    }
}

#[test]
fn settings_that_nothing_uses_are_reported() {
    let folder = folder(&[("press.il", PRESS.as_bytes())]);
    let said = |set: &str| {
        let args = ["run", "press.il", "--for", "50ms", "--set", set];
        let output = rungc(folder.path(), &args);
        assert_eq!(output.status.code(), Some(0), "{set}");
        text(&output.stderr)
    };
    let line = "the program does not use `X050`, `M100` and `D7.i32`, which are set";
    let several = said("X050=1,X000=1,M100=1,D7.i32=5,X050=0@20ms");
    assert!(several.contains(line), "{several}");
    let one = said("X050=1");
    assert!(one.contains("does not use `X050`, which is set"), "{one}");
    assert!(!said("X000=1,Speed=5,M8033=1").contains("does not use"));
}

#[test]
fn runs_count_warnings_that_check_lists() {
    // A double coil, and a relay that nothing reads.
    let list = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nLD X002\nOUT M5\nEND\n";
    let folder = folder(&[("twice.il", list.as_bytes())]);
    let said = |args: &[&str]| text(&rungc(folder.path(), args).stderr);
    let run = ["run", "twice.il", "--for", "0"];
    let counted = said(&run);
    assert!(
        counted.contains("`rungc check twice.il` lists them"),
        "{counted}"
    );
    assert!(!counted.contains("W0203"), "{counted}");
    assert!(said(&[&run[..], &["-v"]].concat()).contains("W0203"));
    assert!(said(&["check", "twice.il"]).contains("W0203"));
    assert!(counted.contains("2 warnings"), "{counted}");
    let allowed = said(&[&run[..], &["-A", "W0203"]].concat());
    assert!(
        allowed.contains("1 warning (`rungc check twice.il -A W0203`"),
        "{allowed}"
    );
    let denied = [&run[..], &["-D", "W0203"]].concat();
    assert_eq!(code(folder.path(), &denied), 1);
    assert!(said(&denied).contains("W0203"));
    // The command lists what was counted: it reads and judges the program as the run did.
    let options = [
        "--model",
        "fx3g",
        "-A",
        "W0204",
        "-W",
        "E0105",
        "--encoding",
        "gbk",
    ];
    let counted = said(&[&run[..], &options].concat());
    let (_, command) = counted.split_once("(`rungc ").unwrap();
    let (command, _) = command.split_once('`').unwrap();
    assert_eq!(
        command,
        "check twice.il --model fx3g --encoding gbk -A W0204 -W E0105"
    );
    let words: Vec<_> = command.split(' ').collect();
    assert_eq!(code(folder.path(), &words), 0);
    let json = rungc(folder.path(), &[&run[..], &["--format", "json"]].concat());
    let report = [text(&json.stdout), text(&json.stderr)].concat();
    assert!(report.contains("W0203"), "{report}");
}

#[test]
fn programs_for_another_model_get_one_error() {
    let examples = std::path::Path::new(env!("RUNGC_ROOT")).join("examples/programs");
    let folder = folder(&[
        ("one.il", b"LD X000\nCANTX H0 H201 D0 K2\nEND\n"),
        // Of no model at all.
        (
            "both.il",
            b"LD X000\nAXPO K0 K0 K1\nCANTX H0 H201 D0 K2\nEND\n",
        ),
    ]);
    let said = |args: &[&str]| text(&rungc(folder.path(), args).stderr);
    for name in ["cam.il", "shear.il"] {
        let path = examples.join(name).display().to_string();
        let report = said(&["check", &path]);
        assert_eq!(report.matches("error[").count(), 1, "{report}");
        assert_eq!(report.matches("warning[").count(), 0, "{report}");
        assert!(
            report.contains("this is a program for Kewei HM"),
            "{report}"
        );
        assert!(report.contains("`--model hm`"), "{report}");
        assert_eq!(code(folder.path(), &["check", &path, "--model", "hm"]), 0);
        let chosen = said(&["check", &path, "--model", "fx3u"]);
        assert!(chosen.matches("error[E0034]").count() > 1, "{chosen}");
    }
    let one = said(&["build", "one.il", "--emit", "c"]);
    assert!(one.contains("`--model h1u` or `--model h2u`"), "{one}");
    let both = said(&["check", "both.il"]);
    assert_eq!(both.matches("error[E0034]").count(), 2, "{both}");
}
