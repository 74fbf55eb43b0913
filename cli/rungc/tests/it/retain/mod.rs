//! Latched devices that survive: in `rungc run`, from run to run, and in images, from reset to reset.

#[cfg(unix)]
mod in_real_time;

use crate::common::{folder, rungc, text};
use crate::tools;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Counts its starts in D200 and its scans in C100, which are latched, and its scans in D0, which is not.
const COUNTER: &str = "\
LD M8002
INC D200
LD M8000
INC D0
LD M8012
OUT C100 K1000
LD C100
OUT Y0
LD X7
RST C100
END
";

fn run(folder: &Path, args: &[&str]) -> Output {
    let usual = ["run", "counter.il", "--for", "1s", "--watch", "D200,D0"];
    rungc(folder, &[&usual, args].concat())
}

/// The values in the last line of a run's table.
fn last(output: &Output) -> String {
    let out = text(&output.stdout);
    let last = out.lines().rfind(|line| line.contains(" s  "));
    let last = last.unwrap_or(&out);
    let words: Vec<_> = last.split_whitespace().skip(2).collect();
    words.join(" ")
}

#[test]
fn latched_devices_survive_from_run_to_run() {
    let folder = folder(&[("counter.il", COUNTER.as_bytes())]);
    let at = folder.path();
    let first = run(at, &["--watch", "C100", "--retain", "counter.retain"]);
    let messages = text(&first.stderr);
    assert!(
        messages.contains("counter.retain does not exist yet"),
        "{messages}"
    );
    let second = run(at, &["--watch", "C100", "--retain", "counter.retain"]);
    assert_eq!(text(&second.stderr), "");
    assert_eq!(
        (last(&first), last(&second)),
        ("1 101 10".into(), "2 101 20".into())
    );
    fs::write(
        at.join("rungc.toml"),
        "[retain]\nfile = \"counter.retain\"\n",
    )
    .unwrap();
    assert_eq!(
        last(&run(at, &["--watch", "C100"])),
        "3 101 30",
        "the project names the file"
    );
}

#[test]
fn devices_of_another_program_are_not_loaded() {
    let folder = folder(&[
        ("counter.il", COUNTER.as_bytes()),
        ("pump.il", b"LD X0\nSET M500\nLD M500\nOUT Y0\nEND\n"),
        ("light.il", b"LD X0\nOUT Y0\nEND\n"),
    ]);
    let at = folder.path();
    assert!(run(at, &["--retain", "plc.retain"]).status.success());
    let before = fs::read(at.join("plc.retain")).unwrap();
    let other = rungc(at, &["run", "pump.il", "--retain", "plc.retain"]);
    insta::assert_snapshot!(
        text(&other.stderr),
        @"rungc: --retain plc.retain: holds the latched devices of `counter (fx3u)`, and this program is `pump (fx3u)`; name another file"
    );
    assert_eq!(other.status.code(), Some(2));
    assert_eq!(fs::read(at.join("plc.retain")).unwrap(), before);
    let without = rungc(at, &["run", "light.il", "--retain", "light.retain"]);
    insta::assert_snapshot!(
        text(&without.stderr),
        @"rungc: --retain light.retain: the program has no latched devices"
    );
    fs::write(at.join("plc.retain"), &before[..before.len() - 1]).unwrap();
    let damaged = run(at, &["--retain", "plc.retain"]);
    insta::assert_snapshot!(
        text(&damaged.stderr),
        @"rungc: --retain plc.retain: does not hold latched devices, or is damaged"
    );
    assert_eq!(damaged.status.code(), Some(2));
}

#[test]
fn programs_with_similar_names_stay_apart() {
    let long = "a".repeat(60);
    let stems = [
        "自动灌装生产线控制程序机组编号一".to_string(),
        "自动灌装生产线控制程序机组编号二".to_string(),
        format!("{long}_first"),
        format!("{long}_second"),
        long,
        "motor_1".to_string(),
        "motor-1".to_string(),
        "motor 1".to_string(),
    ];
    let names = stems.map(|stem| format!("{stem}.il"));
    let files = names
        .each_ref()
        .map(|name| (name.as_str(), COUNTER.as_bytes()));
    let folder = folder(&files);
    let at = folder.path();
    let run = |name: &str, model: &str| {
        let usual = ["--retain", "plc.retain", "--for", "50ms"];
        rungc(at, &[&["run", name, "--model", model], &usual[..]].concat())
    };
    for owner in &names {
        let first = run(owner, "fx3u");
        assert!(first.status.success(), "{}", text(&first.stderr));
        for (name, model) in names.iter().flat_map(|n| [(n, "fx3u"), (n, "fx2n")]) {
            let own = (name, model) == (owner, "fx3u");
            let code = run(name, model).status.code();
            assert_eq!(
                code,
                Some(if own { 0 } else { 2 }),
                "{name} reads what {owner} has saved"
            );
        }
        fs::remove_file(at.join("plc.retain")).unwrap();
    }
}

#[test]
fn a_changed_program_keeps_what_both_versions_have() {
    let folder = folder(&[("counter.il", COUNTER.as_bytes())]);
    let at = folder.path();
    assert!(run(at, &["--retain", "counter.retain"]).status.success());
    let changed = COUNTER
        .replace("OUT C100 K1000\nLD C100", "INC D300")
        .replace("RST C100", "RST D300");
    fs::write(at.join("counter.il"), changed).unwrap();
    let again = run(at, &["--watch", "D300", "--retain", "counter.retain"]);
    insta::assert_snapshot!(
        text(&again.stderr),
        @"rungc: counter.retain: 1 of its devices are dropped: the program does not use them as latched devices any more"
    );
    assert!(last(&again).starts_with("2 101"), "{}", last(&again));
}

/// A board whose RAM from 0x21000000 on survives: QEMU keeps it in a file.
const BOARD: &str = "
[retain]
memory = \"ram\"
slots = [{ origin = 0x2100_0000, length = \"1K\" }, { origin = 0x2100_0400, length = \"1K\" }]
every_ms = EVERY
power_fail = { at = 0x2100_1000, bit = 2 }
";

/// Shows in Y000 to Y003 how often it was started, in D200, which is latched.
const STARTS: &str = "\
LD M8002
INC D200
LD= D200 K1
OUT Y000
LD= D200 K2
OUT Y001
LD= D200 K3
OUT Y002
LD= D200 K4
OUT Y003
END
";

/// Bytes of the RAM in the file, the second of QEMU's machine.
const RAM: usize = 16 << 20;

/// Output of an image on a Cortex-M3 whose RAM is in a file.
fn simulated(folder: &Path, image: &str) -> String {
    let output = Command::new("qemu-system-arm")
        .current_dir(folder)
        .args(["-M", "mps2-an385,memory-backend=kept", "-nographic"])
        .args([
            "-object",
            "memory-backend-file,id=kept,size=16M,mem-path=ram,share=on",
        ])
        .args(["-icount", "shift=0,sleep=off"])
        .args([
            "-semihosting-config",
            "enable=on,target=native",
            "-kernel",
            image,
        ])
        .output()
        .unwrap();
    let printed = text(&[&*output.stdout, &*output.stderr].concat());
    assert!(output.status.success(), "{printed}");
    let lines = printed.lines().filter(|line| line.contains(" s  Y"));
    lines.collect::<Vec<_>>().join("\n")
}

/// A folder with a program and boards that save often and rarely, and the cargo for them; `None` where tools are
/// missing.
fn boards((name, program): (&str, &str)) -> Option<(TempDir, Command)> {
    let needed = [
        "make",
        "arm-none-eabi-gcc",
        "arm-none-eabi-ld",
        "qemu-system-arm",
    ];
    if !tools::tools(&needed) {
        return None;
    }
    let board = Path::new(env!("RUNGC_ROOT")).join("examples/boards/mps2-an385.toml");
    let board = fs::read_to_string(board).unwrap() + BOARD;
    let folder = folder(&[
        (name, program.as_bytes()),
        ("often.toml", board.replace("EVERY", "1000").as_bytes()),
        ("rarely.toml", board.replace("EVERY", "3600000").as_bytes()),
    ]);
    let target = "thumbv7m-none-eabi";
    let Some(cargo) = tools::cargo(target) else {
        tools::leave_out(&tools::no_rust(target));
        return None;
    };
    Some((folder, cargo))
}

/// Builds an image that ends after a time; gives its name.
fn image(
    folder: &Path,
    cargo: &Command,
    (program, end): (&str, &str),
    (backend, board): (&str, &str),
) -> String {
    let name = format!("{backend}-{board}.elf");
    let built = tools::with_cargo(cargo)
        .args(["build", program, "--emit", "elf", "--for", end])
        .args(["--board", &format!("{board}.toml"), "--backend", backend])
        .args(["-o", &name, "--force"])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(built.status.success(), "{}", text(&built.stderr));
    name
}

/// Sets the pin by which the supply reports a failure, for the start of the image.
fn set_supply(folder: &Path, fails: bool) {
    let mut ram = fs::read(folder.join("ram")).unwrap();
    ram[0x1000] = u8::from(fails) << 2;
    fs::write(folder.join("ram"), &ram).unwrap();
}

/// The pin drives M8007, M8008 and D8007, and ends in STOP after the time in D8008.
#[test]
fn a_failing_supply_stops_an_image() {
    let program = "LD M8008\nOUT Y000\nLD= D8007 K1\nOUT Y001\nLD M8000\nOUT Y002\nEND\n";
    let Some((folder, cargo)) = boards(("supply.il", program)) else {
        return;
    };
    let at = folder.path();
    let image = image(at, &cargo, ("supply.il", "100ms"), ("c", "rarely"));
    fs::write(at.join("ram"), vec![0; RAM]).unwrap();
    assert_eq!(simulated(at, &image), "      0.000 s  Y002 on");
    set_supply(at, true);
    insta::assert_snapshot!(simulated(at, &image), @r"
    0.000 s  Y002 on
    0.010 s  Y000 on
    0.010 s  Y001 on
    0.020 s  Y000 off
    0.020 s  Y001 off
    0.020 s  Y002 off
    ");
}

/// Images in C and in Rust load what the other has saved, in the background or because the supply fails.
#[test]
fn latched_devices_of_images_survive() {
    let Some((folder, cargo)) = boards(("starts.il", STARTS)) else {
        return;
    };
    let at = folder.path();
    let image =
        |backend: &str, board: &str| image(at, &cargo, ("starts.il", "3s"), (backend, board));
    let [often, rarely] = [image("c", "often"), image("c", "rarely")];
    let in_rust = image("rust", "rarely");
    fs::write(at.join("ram"), vec![0; RAM]).unwrap();
    let supply = |fails: bool| set_supply(at, fails);
    assert_eq!(simulated(at, &often), "      0.000 s  Y000 on");
    // Loaded devices are saved only when the supply fails.
    for fails in [false, true] {
        supply(fails);
        assert_eq!(simulated(at, &in_rust), "      0.000 s  Y001 on");
    }
    assert_eq!(simulated(at, &rarely), "      0.000 s  Y002 on");
    supply(false);
    for _ in 0..2 {
        assert_eq!(simulated(at, &in_rust), "      0.000 s  Y003 on");
    }
}
