//! Files that are there already, of every option that names an output.

use crate::common::{folder, free_port, rungc, text};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// The options: see the file.
const OPTIONS: &str = include_str!("../outputs.txt");

/// Takes samples with the oscilloscope of HM.
const SCOPE: &str = include_str!("../../../../examples/programs/cam.il");

/// Files of kinds that people write, and files of theirs that look like results.
const OWN: [(&str, &[u8]); 30] = [
    ("a.il", b"LD X0\nOUT Y0\nEND\n"),
    ("b.il", b"LD X1\nOUT Y0\nEND\n"),
    ("other.il", b"LD X7\nOUT Y7\nEND\n"),
    ("scope.il", SCOPE.as_bytes()),
    ("t.plctest.toml", TEST.as_bytes()),
    ("rungc.toml", b"[project]\nprogram = \"a.il\"\n"),
    ("board.toml", b"name = \"mine\"\n"),
    ("export.csv", b"\"0\"\t\"LD\"\t\"X000\"\n"),
    ("ladder.txt", b"--| X0 |--( Y0 )--\n"),
    ("notes.md", b"# Notes\n\n1 of 2 done\n"),
    ("mine.c", b"int main(void) { return 0; }\n"),
    (
        "mine.html",
        b"<!DOCTYPE html>\n<html><body>mine</body></html>\n",
    ),
    (
        "mine.svg",
        b"<?xml version=\"1.0\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"/>\n",
    ),
    ("mine.pdf", b"%PDF-1.7\nmine\n"),
    ("package.json", b"{\n  \"name\": \"mine\"\n}\n"),
    ("tsconfig.json", b"{\n  \"files\": [\"core.ts\"]\n}\n"),
    ("mine.json", b"{\n  \"model\": \"my settings\"\n}\n"),
    ("mine.csv", b"time_ms,temperature\n0,21.5\n"),
    (
        "mine.patch",
        b"--- a/main.c\n+++ b/main.c\n@@ -1 +1 @@\n-a\n+b\n",
    ),
    (
        "mine.txt",
        b"3 of 10 machines are done (30 %)\n\n5 passed, 1 failed, in all (3 s)\n",
    ),
    ("mine.log", b"12.123456 x -> y\n"),
    (
        "page.html",
        b"<!DOCTYPE html>\n<style>\n:root { color-scheme: light dark; }\n</style>\n",
    ),
    (
        "mine.zip",
        b"PK\x05\x06\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
    ),
    (
        "other.fmu",
        b"PK\x03\x04\x0A\0\0\0\0\0\0\0\x21\0\0\0\0\0\0\0\0\0\0\0\0\0\x14\0\0\0modelDescription.xml<fmi generationTool=\"other\"/>",
    ),
    ("mine.cnf", b"p cnf 2 1\n1 2 0\n"),
    ("mine.btor2", b"1 sort bitvec 1\n2 input 1\n"),
    ("mine.aig", b"aig 0 0 0 0 0\n"),
    ("mine.info", b"TN:\nSF:main.c\nend_of_record\n"),
    ("drawing.svg", b"<svg height=\"10\" width=\"10\"/>\n"),
    (
        "project.xml",
        b"<?xml version=\"1.0\"?>\n<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\"/>\n",
    ),
];

const TEST: &str = "\
topic = \"a test\"
model = \"fx3u\"
program = { file = \"a.il\" }
[[case]]
name = \"on\"
[[case.step]]
set = { X000 = 1 }
scans = 1
expect = { Y000 = 1 }
";

/// A line of the table.
struct Line {
    command: &'static str,
    option: String,
    arguments: &'static str,
    fresh: &'static str,
    twice: &'static str,
}

fn lines() -> impl Iterator<Item = Line> {
    let lines = OPTIONS.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| {
        let fields: Vec<&str> = line.split(" | ").map(str::trim).collect();
        let [command, option, arguments, fresh, twice] = fields[..] else {
            panic!("five fields: {line}")
        };
        let option = option.replace('_', "-");
        Line {
            command,
            option,
            arguments,
            fresh,
            twice,
        }
    })
}

impl Line {
    fn run(&self, at: &Path, out: &str, force: bool) -> Output {
        let line = self.arguments.replace("OUT", out);
        let line = line.replace("PORT", &format!("127.0.0.1:{}", free_port()));
        let force = if force { " --force" } else { "" };
        let line = line + force;
        rungc(at, &line.split_whitespace().collect::<Vec<_>>())
    }
}

fn own() -> TempDir {
    folder(&OWN)
}

/// The files that have changed or are gone.
fn changed(at: &Path) -> Vec<&'static str> {
    let is_changed = |(name, contents): &&(&'static str, &'static [u8])| {
        fs::read(at.join(name)).ok().as_deref() != Some(*contents)
    };
    OWN.iter()
        .filter(is_changed)
        .map(|(name, _)| *name)
        .collect()
}

/// A line for each option.
fn options() -> impl Iterator<Item = Line> {
    let mut known = std::collections::BTreeSet::new();
    lines().filter(move |line| known.insert((line.command, line.option.clone())))
}

#[test]
fn no_option_replaces_what_people_write() {
    let folder = own();
    let at = folder.path();
    for line in lines() {
        for (name, _) in OWN {
            let output = line.run(at, name, false);
            let said = text(&output.stderr);
            assert_eq!(
                output.status.code(),
                Some(2),
                "{} {} {name}: {said}",
                line.command,
                line.option
            );
            assert_eq!(
                changed(at),
                [""; 0],
                "{} {}: {said}",
                line.command,
                line.option
            );
        }
    }
}

#[test]
fn no_option_replaces_an_input_by_any_name() {
    let folder = own();
    let at = folder.path();
    fs::create_dir(at.join("sub")).unwrap();
    fs::hard_link(at.join("a.il"), at.join("hard.svg")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("a.il", at.join("soft.html")).unwrap();
    for line in options() {
        let mut programs = ["scope.il", "a.il"].into_iter();
        let Some(program) = programs.find(|program| line.arguments.contains(program)) else {
            continue;
        };
        let roundabout = format!("./sub/../{program}");
        let forced = [program, &roundabout, "rungc.toml"].map(|path| (path, true));
        let links = ["hard.svg", "soft.html"].map(|path| (path, false));
        for (path, force) in forced.into_iter().chain(links) {
            let output = line.run(at, path, force);
            let said = text(&output.stderr);
            assert_eq!(
                output.status.code(),
                Some(2),
                "{} {} {path}: {said}",
                line.command,
                line.option
            );
        }
        assert_eq!(changed(at), [""; 0], "{} {}", line.command, line.option);
    }
}

#[test]
fn results_replace_earlier_ones() {
    for line in lines().filter(|line| line.twice != "never") {
        let folder = own();
        let at = folder.path();
        let of = format!("{} {} {}", line.command, line.option, line.fresh);
        let first = line.run(at, line.fresh, false);
        assert!(
            at.join(line.fresh).exists(),
            "{of}: {}",
            text(&first.stderr)
        );
        let again = line.run(at, line.fresh, false);
        let said = text(&again.stderr);
        let refused = said.contains("--force");
        assert_eq!(refused, line.twice == "force", "{of}: {said}");
        if refused {
            assert_eq!(again.status.code(), Some(2), "{of}: {said}");
            let forced = line.run(at, line.fresh, true);
            assert_eq!(
                forced.status.code(),
                first.status.code(),
                "{of}: {}",
                text(&forced.stderr)
            );
        } else {
            assert_eq!(again.status.code(), first.status.code(), "{of}: {said}");
        }
        assert_eq!(changed(at), [""; 0], "{of}");
    }
}

#[test]
fn outputs_do_not_replace_each_other() {
    let folder = own();
    let at = folder.path();
    let run = ["run", "a.il", "--for", "20ms", "--watch", "Y000"];
    for (vcd, plot) in [
        ("x.vcd", "x.vcd"),
        ("x.vcd", "./x.vcd"),
        ("./x.vcd", "sub/../x.vcd"),
    ] {
        let _ = fs::create_dir(at.join("sub"));
        let output = rungc(
            at,
            &[&run[..], &["--vcd", vcd, "--plot", plot, "--force"]].concat(),
        );
        let said = text(&output.stderr);
        assert!(said.contains("is written by --"), "{said}");
        assert!(!at.join("x.vcd").exists());
    }
}

#[test]
fn files_beside_an_output_are_outputs_too() {
    let folder = own();
    let at = folder.path();
    let cert = at.join("cert");
    fs::create_dir(&cert).unwrap();
    fs::write(cert.join("step.cnf"), "mine\n").unwrap();
    let proof = ["verify", "a.il", "--never", "Y001", "--certificate", "cert"];
    let output = rungc(at, &proof);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert_eq!(fs::read_to_string(cert.join("step.cnf")).unwrap(), "mine\n");
    let proof = [
        "verify",
        "a.il",
        "--never",
        "Y001",
        "--certificate",
        "package.json",
    ];
    let said = text(&rungc(at, &proof).stderr);
    assert!(said.contains("package.json is not a folder"), "{said}");
    // The table of the oscilloscope has the name of its drawing.
    let scope = [
        "run",
        "scope.il",
        "--model",
        "hm",
        "--for",
        "200ms",
        "--scope",
        "export.svg",
    ];
    let output = rungc(at, &scope);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    // A program in the folder of its sources.
    fs::create_dir(at.join("c")).unwrap();
    fs::write(at.join("c/a.c"), OWN[0].1).unwrap();
    let build = ["build", "c/a.c", "--emit", "c", "-o", "c", "--force"];
    let output = rungc(at, &build);
    let said = text(&output.stderr);
    assert!(said.contains("c/a.c is an input of this run"), "{said}");
    assert_eq!(fs::read(at.join("c/a.c")).unwrap(), OWN[0].1);
    assert_eq!(changed(at), [""; 0]);
}

/// A program with a latched device.
const MOTOR: &str = "LD X0\nSET M500\nOUT Y0\nEND\n";

/// A project in a folder, beside a file of somebody else.
fn strange(settings: &str) -> TempDir {
    let folder = folder(&[("mine.txt", b"mine\n")]);
    let project = folder.path().join("project");
    fs::create_dir_all(project.join("panel")).unwrap();
    fs::write(project.join("motor.il"), MOTOR).unwrap();
    fs::write(project.join("rungc.toml"), settings).unwrap();
    fs::write(project.join("panel/notes.txt"), "notes\n").unwrap();
    #[cfg(unix)]
    for (end, link) in [
        ("..", "project/link"),
        ("../../new.txt", "project/panel/away"),
    ] {
        std::os::unix::fs::symlink(end, folder.path().join(link)).unwrap();
    }
    folder
}

#[test]
fn settings_do_not_lead_out_of_their_project() {
    let build = ["build"];
    let serve = ["serve", "--for", "50ms"];
    let io = |files: &str, row: &str| {
        format!(
            "[project]\nprogram = \"motor.il\"\n[io.a]\nfiles = \"{files}\"\nY000 = \"write {row}\"\n"
        )
    };
    let output = |path: &str| {
        format!("[project]\nprogram = \"motor.il\"\n[build]\nemit = \"c\"\noutput = \"{path}\"\n")
    };
    let retain =
        |path: &str| format!("[project]\nprogram = \"motor.il\"\n[retain]\nfile = \"{path}\"\n");
    let mut cases = vec![
        (io("..", "new.txt"), &serve[..]),
        (io(".", "../new.txt"), &serve),
        (io("panel/../..", "new.txt"), &serve),
        (io(".", "motor.il"), &serve),
        (io(".", "rungc.toml"), &serve),
        (io("panel", "notes.txt"), &serve),
        (output("../new"), &build),
        (output("panel/../../new"), &build),
        (retain("../new.retain"), &["run"][..]),
    ];
    if cfg!(unix) {
        cases.extend([
            (io("link", "new.txt"), &serve[..]),
            (io(".", "link/new.txt"), &serve),
            // The file that the link leads to is missing.
            (io("panel", "away"), &serve),
            (retain("panel/away"), &["run"]),
            (output("link/new"), &build),
            (retain("link/new.retain"), &["run"]),
        ]);
    }
    for (settings, command) in cases {
        let folder = strange(&settings);
        let at = folder.path();
        let run = rungc(&at.join("project"), command);
        let said = text(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{settings}: {said}");
        let mut names: Vec<_> = fs::read_dir(at)
            .unwrap()
            .map(|e| e.unwrap().file_name())
            .collect();
        names.sort();
        assert_eq!(names, ["mine.txt", "project"], "{settings}");
        assert_eq!(
            fs::read_to_string(at.join("project/motor.il")).unwrap(),
            MOTOR
        );
        // The option that the message names.
        let Some(option) = said.split("`--allow-folder ").nth(1) else {
            continue;
        };
        let allowed = option.split('`').next().unwrap();
        let run = rungc(
            &at.join("project"),
            &[command, &["--allow-folder", allowed]].concat(),
        );
        assert_eq!(
            run.status.code(),
            Some(0),
            "{settings}: {}",
            text(&run.stderr)
        );
    }
}

#[test]
fn a_refused_folder_is_named_with_the_option() {
    let folder =
        strange("[project]\nprogram = \"motor.il\"\n[io.a]\nfiles = \"..\"\nY000 = \"write x\"\n");
    let run = rungc(&folder.path().join("project"), &["serve", "--for", "50ms"]);
    let place = dunce::canonicalize(folder.path()).unwrap();
    let said = text(&run.stderr).replace(&place.display().to_string(), "FOLDER");
    let last = said.lines().last().unwrap();
    insta::assert_snapshot!(
        last,
        @"rungc: FOLDER/project/rungc.toml: `[io.a] files` leads out of the project's folder, to FOLDER; `--allow-folder FOLDER` allows it"
    );
}

/// An empty path names nothing, and says so before the work.
#[test]
fn no_option_takes_an_empty_path() {
    let folder = own();
    for line in options() {
        let arguments = line.arguments.split_whitespace();
        let arguments: Vec<_> = arguments
            .map(|word| word.replace("OUT", "").replace("PORT", "127.0.0.1:0"))
            .collect();
        let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = rungc(folder.path(), &words);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(
            said.contains("a value is required"),
            "{arguments:?}: {said}"
        );
        assert_eq!(text(&output.stdout), "", "{arguments:?}");
    }
}

/// Errors of the system name the file that was asked for, not the one in the making, of which nothing stays.
#[cfg(unix)]
#[test]
fn files_that_cannot_be_written_are_named() {
    let long = "LD X0\nOUT Y0\n".repeat(1000) + "END\n";
    let folder = folder(&[("a.il", long.as_bytes())]);
    let at = folder.path();
    for (args, named) in [
        ("build a.il --emit c -o out", "out/a.c: "),
        ("build a.il --emit rust -o out", "out/"),
        ("build a.il --emit ir -o a.ir", "a.ir: "),
        ("convert a.il --to csv -o a.csv", "a.csv: "),
        ("view a.il -o a.html", "a.html: "),
        ("xref a.il -o a.txt", "a.txt: "),
    ] {
        let rungc = env!("CARGO_BIN_EXE_rungc");
        let limited = format!("trap '' XFSZ; ulimit -f 16; exec '{rungc}' {args}");
        let mut command = std::process::Command::new("bash");
        let output = command.args(["-c", &limited]).current_dir(at);
        let output = output.output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args}: {said}");
        assert!(
            said.starts_with(&format!("rungc: {named}")),
            "{args}: {said}"
        );
        assert!(
            !said.contains(".rungc-") && !said.contains(".tmp"),
            "{args}: {said}"
        );
        assert_eq!(fs::read_dir(at).unwrap().count(), 1, "{args}");
    }
    assert_eq!(fs::read(at.join("a.il")).unwrap(), long.as_bytes());
}

/// What cannot be written in the end is said before the work; a folder that is not there is made.
#[cfg(target_os = "linux")]
#[test]
fn folders_are_tried_before_the_work() {
    let folder = folder(&[("a.il", b"LD X0\nOUT Y0\nEND\n")]);
    for option in [
        "verify a.il --never Y0 --write-test",
        "explore a.il --write-test",
        "run a.il --for 1s --record",
    ] {
        let mut args: Vec<&str> = option.split(' ').collect();
        args.push("/sys/t.plctest.toml");
        let output = rungc(folder.path(), &args);
        let said = text(&output.stderr);
        assert!(
            said.starts_with("rungc: /sys/t.plctest.toml: "),
            "{option}: {said}"
        );
        assert!(
            output.stdout.is_empty(),
            "{option}: {}",
            text(&output.stdout)
        );
        assert_eq!(output.status.code(), Some(2), "{option}");
    }
    let kept = [
        "verify",
        "a.il",
        "--never",
        "Y0 & !X0",
        "--write-test",
        "none/t.plctest.toml",
    ];
    let output = rungc(folder.path(), &kept);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(!folder.path().join("none").exists(), "nothing was found");
    let path = "new/tests/t.plctest.toml";
    let output = rungc(
        folder.path(),
        &["verify", "a.il", "--never", "Y0", "--write-test", path],
    );
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let output = rungc(folder.path(), &["test", path, "--engine", "interp"]);
    assert_eq!(
        output.status.code(),
        Some(1),
        "the property is violated: {}",
        text(&output.stderr)
    );
    assert!(
        text(&output.stdout).contains("1 failed"),
        "{}",
        text(&output.stdout)
    );
}

/// A folder is not written where something else has its name.
#[cfg(unix)]
#[test]
fn folders_do_not_replace_links_and_files() {
    let folder = folder(&[("a.il", b"LD X0\nOUT Y0\nEND\n"), ("file", b"")]);
    let at = folder.path();
    std::os::unix::fs::symlink("nowhere/far", at.join("link")).unwrap();
    for path in ["file", "link", "/dev/null"] {
        let output = rungc(at, &["build", "a.il", "--emit", "c", "-o", path]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{path}: {said}");
        let why = format!("rungc: {path} is not a folder; name another one");
        assert_eq!(said.trim_end(), why);
    }
    assert!(!at.join("nowhere").exists());
}

/// A result that replaces an earlier one by a link leaves the link.
#[cfg(unix)]
#[test]
fn links_stay_links() {
    let folder = folder(&[("a.il", b"LD X0\nOUT Y0\nEND\n")]);
    let at = folder.path();
    std::fs::create_dir(at.join("results")).unwrap();
    std::os::unix::fs::symlink("results/a.html", at.join("a.html")).unwrap();
    for _ in 0..2 {
        let output = rungc(at, &["view", "a.il", "-o", "a.html"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(at.join("a.html").is_symlink());
        assert!(at.join("results/a.html").is_file());
    }
}

/// Streams of the process are not files.
#[cfg(unix)]
#[test]
fn streams_are_not_replaced() {
    let folder = folder(&[("a.il", b"LD X0\nOUT Y0\nEND\n")]);
    for path in ["/proc/self/fd/1", "/dev/fd/1"] {
        let output = rungc(folder.path(), &["xref", "a.il", "-o", path, "--force"]);
        assert_eq!(output.status.code(), Some(2), "{path}");
        assert!(text(&output.stderr).contains("is a stream"), "{path}");
    }
}
