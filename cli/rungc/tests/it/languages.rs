//! Reports in Chinese: by the option, by rungc.toml and by the environment.

use crate::common::{folder, shown, text};
use std::path::Path;
use std::process::{Command, Output};

/// A list with five mistakes, and a comment in Chinese beside one.
const BAD: &str = "LD X0 ; 启动按钮
OUTT Y0
LD X008
OUT Y1 ; 电机
OUT Y1
LD M9999
MOV K1 K5
";

/// A test file with a case.
const CASE: &str = r#"topic = "a"
model = "fx3u"
program = "a.il"
[[case]]
name = "a"
[[case.step]]
scans = 1
"#;

/// Runs rungc in an environment with these variables alone of those that name a language.
fn rungc_in(folder: &Path, variables: &[(&str, &str)], args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rungc"));
    for name in ["RUNGC_LANG", "LC_ALL", "LC_MESSAGES", "LANG"] {
        command.env_remove(name);
    }
    let variables = variables.iter().copied();
    command.envs(variables).args(args).current_dir(folder);
    command.output().unwrap()
}

/// First words of a report in each language.
const WORDS: [(&str, &str); 2] = [("error[", "Failed bad.il: "), ("错误[", "未通过 bad.il：")];

/// Checks that the report on the list is in a language: 0 is English, 1 Chinese.
#[track_caller]
fn check_in(language: usize, variables: &[(&str, &str)], args: &[&str]) {
    let folder = folder(&[("bad.il", BAD.as_bytes())]);
    let args = [&["check", "bad.il"], args].concat();
    let report = text(&rungc_in(folder.path(), variables, &args).stderr);
    let (begin, end) = WORDS[language];
    assert!(
        report.starts_with(begin) && report.contains(end),
        "{report}"
    );
}

#[test]
fn mistakes_are_reported_in_chinese() {
    let folder = folder(&[("bad.il", BAD.as_bytes())]);
    insta::assert_snapshot!(shown(folder.path(), &["check", "bad.il", "--lang", "zh"]));
}

#[test]
fn a_program_without_errors_is_reported_in_chinese() {
    let program = "LD X0\nOUT Y0\nLD X1\nOUT Y0\nEND\n";
    let folder = folder(&[
        ("a.il", program.as_bytes()),
        ("b.il", b"LD X0\nOUT Y0\nEND\n"),
    ]);
    let report = shown(folder.path(), &["check", "a.il", "b.il", "--lang", "zh"]);
    assert!(
        report.contains("合计 2 个程序：0 个错误，1 个警告"),
        "{report}"
    );
    assert!(
        report.contains("已检查 a.il（FX3U，5 步，3 个软元件），用时 "),
        "{report}"
    );
    let built = ["build", "a.il", "--emit", "c", "-o", "out", "--lang", "zh"];
    let report = shown(folder.path(), &built);
    assert!(report.contains("W0203"), "{report}");
    let end = "已生成 out（FX3U，5 步）：0 个错误，1 个警告";
    assert!(report.contains(end), "{report}");
    let measured = ["build", "a.il", "--report", "--lang", "zh"];
    let report = shown(folder.path(), &measured);
    assert!(report.contains("已测量 a.il（FX3U，5 步）：0 "), "{report}");
    let report = shown(folder.path(), &["check", "c.il", "--lang", "zh"]);
    assert!(
        report.contains("rungc: 错误[E0016]：文件无法读取\n"),
        "{report}"
    );
}

/// The text of pages is English in any language of reports, and so is the language that they state.
#[test]
fn pages_state_the_language_of_their_text() {
    let folder = folder(&[
        ("a.il", b"LD X0\nOUT Y0\nEND\n"),
        ("b.il", b"LD X1\nOUT Y0\nEND\n"),
        ("a.plctest.toml", CASE.as_bytes()),
    ]);
    let commands: [&[&str]; 5] = [
        &["view", "a.il", "-o", "page.html"],
        &["xref", "a.il", "--to", "html", "-o", "page.html"],
        &[
            "diff",
            "a.il",
            "b.il",
            "--format",
            "html",
            "-o",
            "page.html",
        ],
        &[
            "test",
            "a.plctest.toml",
            "--coverage",
            "html",
            "-o",
            "page.html",
        ],
        &[
            "verify",
            "a.il",
            "--never",
            "Y0 && !X0",
            "--report",
            "page.html",
        ],
    ];
    for args in commands {
        let path = folder.path().join("page.html");
        rungc_in(folder.path(), &[], &[args, &["--lang", "zh"]].concat());
        let page =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{args:?}: {error}"));
        let is_chinese = page.contains(|c| ('\u{4E00}'..='\u{9FFF}').contains(&c));
        let stated = match is_chinese {
            true => "<html lang=\"zh-CN\">",
            false => "<html lang=\"en\">",
        };
        assert!(page.contains(stated), "{args:?}");
        std::fs::remove_file(path).unwrap();
    }
}

#[test]
fn codes_are_explained_in_chinese() {
    let folder = folder(&[]);
    insta::assert_snapshot!(shown(folder.path(), &["explain", "E0401", "--lang", "zh"]));
    let page = shown(
        folder.path(),
        &["explain", "e0106", "--lang", "zh_CN.UTF-8"],
    );
    for part in [
        "错误写法（h2u）：",
        "正确写法（h2u）：",
        "H1U 和 H2U 的错误代码为 6503",
    ] {
        assert!(page.contains(part), "{page}");
    }
}

#[test]
fn the_environment_chooses_the_language() {
    check_in(0, &[], &[]);
    check_in(1, &[("LANG", "zh_CN.UTF-8")], &[]);
    check_in(1, &[("LANG", "C"), ("LC_MESSAGES", "zh_CN.UTF-8")], &[]);
    check_in(0, &[("LANG", "zh_CN.UTF-8"), ("LC_ALL", "C")], &[]);
    check_in(0, &[("LANG", "de_DE.UTF-8")], &[]);
    check_in(0, &[("LANG", "zh_TW.UTF-8")], &[]);
    check_in(1, &[("RUNGC_LANG", "zh"), ("LC_ALL", "C")], &[]);
    check_in(0, &[("LANG", "zh_CN.UTF-8")], &["--lang", "en"]);
    let folder = folder(&[("bad.il", BAD.as_bytes())]);
    let rejected = rungc_in(folder.path(), &[("RUNGC_LANG", "fr")], &["check", "bad.il"]);
    assert_eq!(rejected.status.code(), Some(2));
    let message = text(&rejected.stderr);
    let expected = "rungc: RUNGC_LANG=fr: unknown language; these are known: `en`, `zh`\n";
    assert_eq!(message, expected);
}

#[test]
fn settings_choose_the_language() {
    let settings: &[u8] = b"[report]\nlang = \"zh\"\n";
    let folder = folder(&[("bad.il", BAD.as_bytes()), ("rungc.toml", settings)]);
    let report = |args: &[&str]| {
        let args = [&["check", "bad.il"], args].concat();
        text(&rungc_in(folder.path(), &[("LANG", "C")], &args).stderr)
    };
    assert!(report(&[]).starts_with("错误["), "{}", report(&[]));
    let english = report(&["--lang", "en"]);
    assert!(english.starts_with("error["), "{english}");
    std::fs::write(
        folder.path().join("rungc.toml"),
        "[report]\nlang = \"fr\"\n",
    )
    .unwrap();
    let rejected = report(&[]);
    assert!(rejected.contains("unknown language `fr`"), "{rejected}");
    assert!(
        rejected.contains("these are known: `en`, `zh`"),
        "{rejected}"
    );
}

/// Tools read the same in every language.
#[test]
fn formats_for_tools_stay_english() {
    let folder = folder(&[("bad.il", BAD.as_bytes())]);
    for format in ["json", "sarif", "junit", "github"] {
        let args = ["check", "bad.il", "--format", format];
        let [english, chinese] =
            ["C", "zh_CN.UTF-8"].map(|locale| rungc_in(folder.path(), &[("LANG", locale)], &args));
        assert_eq!(text(&chinese.stdout), text(&english.stdout), "{format}");
        assert_eq!(text(&chinese.stderr), text(&english.stderr), "{format}");
        assert!(!english.stdout.is_empty(), "{format}");
    }
}
