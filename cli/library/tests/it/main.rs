//! The library as others use it.

use rungc::{Error, Options, Project, Value};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

/// Y000 follows X000 after 3 s.
const DELAY: &str = ";! X000 = Start\nLD X000\nOUT T0 K30\nLD T0\nOUT Y000\nEND\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

fn list(text: &str, model: &str) -> Project {
    let options = Options {
        model: Some(model.to_string()),
        ..Options::default()
    };
    Project::from_list("a.il", text, &options).unwrap()
}

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

#[test]
fn a_folder_is_its_only_program_or_the_one_that_its_settings_name() {
    let one = folder(&[("motor.il", DELAY)]);
    let project = Project::open(one.path()).unwrap();
    assert!(project.file().ends_with("motor.il"));
    let two = folder(&[("a.il", DELAY), ("b.il", DELAY)]);
    let error = Project::open(two.path()).unwrap_err();
    assert!(matches!(error, Error::SeveralPrograms { .. }), "{error}");
    let settings = "[project]\nprogram = \"b.il\"\nmodel = \"h2u\"\n";
    fs::write(two.path().join("rungc.toml"), settings).unwrap();
    let project = Project::open(two.path()).unwrap();
    assert!(project.file().ends_with("b.il"));
    assert_eq!(project.model().name, "h2u");
}

#[test]
fn mistakes_name_their_places() {
    let folder = folder(&[
        ("a.il", "LD X000\nOTU Y000\nEND\n"),
        ("rungc.toml", "[projekt]\n"),
    ]);
    let wrong = |path: &str| {
        Project::open(folder.path().join(path))
            .unwrap_err()
            .to_string()
    };
    assert!(
        wrong("a.il").contains("rungc.toml:1:2: error["),
        "{}",
        wrong("a.il")
    );
    fs::remove_file(folder.path().join("rungc.toml")).unwrap();
    assert!(wrong("b.il").contains("b.il"));
    let project = Project::open(folder.path().join("a.il")).unwrap();
    let checked = project.check();
    assert!(checked.has_errors());
    let shown = checked.diagnostics[0].to_string();
    assert!(shown.contains("a.il:2:1: error[E0033]"), "{shown}");
    let Err(Error::Rejected(errors)) = checked.compile() else {
        panic!("a program with errors is compiled")
    };
    assert_eq!(errors[0].code, "E0033");
    let unknown = Options {
        model: Some("fx9".to_string()),
        ..Options::default()
    };
    let unknown = Project::from_list("a.il", DELAY, &unknown).unwrap_err();
    assert!(unknown.to_string().contains("fx9"), "{unknown}");
}

#[test]
fn levels_are_those_of_the_settings_and_the_options() {
    let twice = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n";
    let folder = folder(&[("a.il", twice)]);
    let path = folder.path().join("a.il");
    let severities = |options: &Options| {
        let project = Project::open_with(&path, options).unwrap();
        let found = project.check().diagnostics;
        let found = found.iter().filter(|d| d.code == "W0203");
        found.map(|d| d.severity.name()).collect::<Vec<_>>()
    };
    let usual = severities(&Options::default());
    assert_eq!(usual, ["warning"]);
    let denied = Options {
        deny: vec!["W0203"],
        ..Options::default()
    };
    assert_eq!(severities(&denied), ["error"]);
    fs::write(
        folder.path().join("rungc.toml"),
        "[check]\nallow = [\"W0203\"]\n",
    )
    .unwrap();
    assert_eq!(severities(&Options::default()), [""; 0]);
    assert_eq!(severities(&denied), ["error"]);
}

#[test]
fn scans_keep_their_period_however_time_is_cut() {
    let counts = "LD M8000\nINC D0\nEND\n";
    let project = list(counts, "fx3u");
    let program = project.check().compile().unwrap();
    let mut plc = program.start();
    for _ in 0..30 {
        plc.run_for(ms(7));
    }
    assert_eq!(plc.now(), ms(210));
    assert_eq!(plc.int("D0").unwrap(), 21);
    plc.scan();
    assert_eq!(plc.int("D0").unwrap(), 22);
    let constant = list(
        "LD M8002\nSET M8039\nMOV K25 D8039\nLD M8000\nINC D0\nEND\n",
        "fx3u",
    );
    let program = constant.check().compile().unwrap();
    let mut plc = program.start();
    plc.run_for(ms(100));
    assert_eq!(plc.int("D0").unwrap(), 4);
}

#[test]
fn devices_are_read_and_set_by_name_and_comment() {
    let project = list(DELAY, "h2u");
    let program = project.check().compile().unwrap();
    let mut plc = program.start();
    plc.set("Start", true).unwrap();
    plc.run_for(ms(2600));
    assert_eq!(plc.int("T0").unwrap(), 25);
    let before = plc.save();
    plc.run_for(ms(1000));
    assert!(plc.bit("Y000").unwrap());
    plc.restore(&before).unwrap();
    assert!(!plc.bit("y0").unwrap());
    let other = project.check().compile().unwrap();
    assert!(matches!(
        other.start().restore(&before),
        Err(Error::OtherProgram)
    ));
    program.start().restore(&before).unwrap();
    plc.set("D10.f32", 1.5).unwrap();
    assert_eq!(plc.get("D10.f32").unwrap(), Value::Float(1.5));
    for (name, value, why) in [
        ("Stop", Value::Bit(true), "not a device"),
        ("X008", Value::Bit(true), "octal"),
        ("D0", Value::Int(70_000), "does not fit"),
        ("M8000", Value::Bit(false), "each scan sets it"),
        ("Y999", Value::Bit(true), "octal"),
        ("D0", Value::Text("a".to_string()), "characters"),
    ] {
        let error = plc.set(name, value).unwrap_err().to_string();
        assert!(error.contains(why), "{name}: {error}");
    }
    assert!(plc.bit("D0").is_err() && plc.int("M0").is_err() && plc.float("D0").is_err());
}

#[test]
fn power_switch_and_forces_act_on_the_run() {
    let project = list(
        "LD M8000\nINC D0\nINC D512\nLD X000\nOUT Y000\nEND\n",
        "h2u",
    );
    let program = project.check().compile().unwrap();
    let mut plc = program.start();
    plc.set("X0", true).unwrap();
    plc.force("D0", 5).unwrap();
    plc.run_for(ms(100));
    assert_eq!((plc.int("D0").unwrap(), plc.int("D512").unwrap()), (5, 10));
    plc.release("D0").unwrap();
    plc.power_cycle();
    assert_eq!((plc.int("D0").unwrap(), plc.int("D512").unwrap()), (0, 10));
    plc.run_for(ms(100));
    assert!(plc.bit("Y0").unwrap());
    plc.set_running(false);
    plc.run_for(ms(100));
    assert!(!plc.is_running() && !plc.bit("Y0").unwrap());
    assert_eq!(plc.int("D512").unwrap(), 20);
}

#[test]
fn output_and_drawings_are_the_same_each_time() {
    let project = list(DELAY, "h2u");
    let program = project.check().compile().unwrap();
    let again = project.check().compile().unwrap();
    assert_eq!(program.emit_c(), again.emit_c());
    assert_eq!(program.emit_rust(), again.emit_rust());
    assert!(program.emit_c().iter().any(|file| file.path == "Makefile"));
    assert!(project.ladder(100).contains("Y000"));
    assert!(project.svg().starts_with("<svg"));
    assert_eq!(program.name(), "a");
}

#[test]
fn operation_errors_are_reported() {
    let project = list("LD M8000\nMOV K1000 Z0\nMOV K1 D7900Z0\nEND\n", "h2u");
    let program = project.check().compile().unwrap();
    let mut plc = program.start();
    plc.run_for(ms(50));
    let errors: Vec<_> = plc
        .errors()
        .iter()
        .map(|e| (e.code, e.step, e.times))
        .collect();
    assert_eq!(errors.len(), 1, "{errors:?}");
}

/// The example of the front page, line by line.
fn front_page(file: PathBuf) -> Result<(), Error> {
    let project = Project::open(&file)?; // a list, an export, a GX Works2 project, a folder with rungc.toml
    let checked = project.check();
    for diagnostic in &checked.diagnostics {
        eprintln!("{diagnostic}");
    }
    let program = checked.compile()?;
    for file in program.emit_c() {
        println!("{}: {} bytes", file.path, file.contents.len());
    }
    let mut plc = program.start();
    plc.set("Start", true)?; // a comment of the program, or X000
    plc.run_for(Duration::from_secs(2));
    assert!(!plc.bit("Y000")?);
    plc.run_for(Duration::from_secs(2));
    assert!(plc.bit("Y000")?);
    Ok(())
}

#[test]
fn the_example_of_the_front_page_runs() {
    let folder = folder(&[("motor.il", DELAY)]);
    front_page(folder.path().join("motor.il")).unwrap();
}

/// The example of the book is that of the crate's documentation, and the one above.
#[test]
fn the_book_shows_the_example_that_is_tested() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let block = |text: &str, fence: &str| {
        let lines = text.lines().skip_while(|line| *line != fence).skip(1);
        let lines = lines.take_while(|line| !line.starts_with("```"));
        lines
            .filter(|line| !line.trim().is_empty() && !line.starts_with('#'))
            .map(|line| format!("{line}\n"))
            .collect::<String>()
    };
    let page = fs::read_to_string(folder.join("../../docs/src/library.md")).unwrap();
    let code = fs::read_to_string(folder.join("src/lib.rs")).unwrap();
    let docs: String = code
        .lines()
        .filter_map(|line| line.strip_prefix("//!"))
        .map(|line| format!("{}\n", line.strip_prefix(' ').unwrap_or(line)))
        .collect();
    let shown = block(&page, "```rust");
    assert_eq!(shown, block(&docs, "```"));
    assert!(shown.lines().count() > 10);
    let executed = block(
        include_str!("main.rs"),
        "fn front_page(file: PathBuf) -> Result<(), Error> {",
    );
    let executed = executed.split("    Ok(())").next().unwrap();
    for line in shown.lines().filter(|line| !line.starts_with("use ")) {
        assert!(executed.contains(&format!("    {line}\n")), "{line}");
    }
}

#[test]
fn advice_can_be_followed() {
    let program = list(DELAY, "fx3u").check().compile().unwrap();
    let mut plc = program.start();
    plc.scan();
    let how = plc.how("Y000").unwrap();
    let [press, wait] = &how.actions[..] else {
        panic!("{how:?}");
    };
    assert_eq!(press.comment.as_deref(), Some("Start"));
    plc.set(press.device.as_deref().unwrap(), true).unwrap();
    plc.run_for(ms(press.takes_ms + wait.takes_ms));
    assert!(plc.bit("Y000").unwrap());
    assert!(matches!(plc.how("Y001"), Err(Error::Device(_))));
}
