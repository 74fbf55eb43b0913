//! The examples for a microcontroller build with what the README says and run under QEMU. Without the tools a test
//! reports what is missing and that it did not run; with `RUNGC_REQUIRE_EMBEDDED` set, as in CI, that is a failure.

use crate::tools::{cargo, leave_out, no_rust, tools};
use rungc_sim::engines::cortex_m::make_with;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const TARGET: &str = "thumbv7em-none-eabihf";

fn examples() -> PathBuf {
    firmware().join("stm32f405")
}

fn firmware() -> PathBuf {
    Path::new(env!("RUNGC_ROOT")).join("examples/firmware")
}

/// `make`, in the folder of the C example, with another folder for what it makes.
fn make(target: &str, build: &Path) -> Command {
    let mut make = Command::new("make");
    make.arg(target)
        .arg(format!("BUILD={}", build.display()))
        .arg(format!("RUNGC={}", env!("CARGO_BIN_EXE_rungc")))
        .current_dir(examples().join("c"));
    make
}

/// States of the lamps. QEMU prints some kinds of semihosting to standard output, others to standard error.
fn lamps(output: &Output) -> String {
    let printed = [&*output.stdout, &*output.stderr].concat();
    let printed = String::from_utf8_lossy(&printed);
    assert!(output.status.success(), "{printed}");
    let lines: Vec<_> = printed.lines().filter(|l| l.contains(" s  Y")).collect();
    lines.join("\n")
}

#[test]
fn traffic_light_in_c() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let build = tempfile::tempdir().unwrap();
    let output = make("run", build.path()).output().unwrap();
    insta::assert_snapshot!("traffic_light", lamps(&output));
}

/// Number of rising edges of a pin of port D, by QEMU's log of writes to the register that sets (low half) and resets
/// (high half) pins.
fn pulses(log: &str, pin: u32) -> usize {
    let writes = log.lines().filter_map(|line| {
        let value =
            line.strip_prefix("GPIOD: unimplemented device write (size 4, offset 0x018, value 0x")?;
        u32::from_str_radix(value.trim_end_matches(')'), 16).ok()
    });
    let mut on = false;
    let mut count = 0;
    for write in writes {
        let goes_on = write >> pin & 1 == 1;
        count += usize::from(goes_on && !on);
        on = goes_on || on && write >> (pin + 16) & 1 == 0;
    }
    assert!(!on, "the last pulse has ended");
    count
}

#[test]
fn stepper_in_c() {
    if !tools(&["make", "arm-none-eabi-gcc", "qemu-system-arm"]) {
        return;
    }
    let Some(cargo) = cargo(TARGET) else {
        return leave_out(&no_rust(TARGET));
    };
    let build = tempfile::tempdir().unwrap();
    let log = build.path().join("log");
    let mut make = make("run-stepper", build.path());
    make_with(&mut make, &cargo);
    let output = make
        .arg(format!("QEMU_OPTIONS=-d unimp -D {}", log.display()))
        .output()
        .unwrap();
    check_stepper(&output, &log);
}

/// The stepper takes as long as in the simulator, and makes all of its steps.
fn check_stepper(output: &Output, log: &Path) {
    let printed =
        String::from_utf8_lossy(&[&*output.stdout, &*output.stderr].concat()).into_owned();
    assert!(output.status.success(), "{printed}");
    assert!(printed.contains("done after 0344 ms"), "{printed}");
    let log = std::fs::read_to_string(log).unwrap();
    assert_eq!(pulses(&log, 11), 1000);
}

/// Builds an example in Rust, in a folder of its own; the image. `None`: there is no Rust for it, and the test is to be
/// left out.
fn rust_image(example: &str, program: &Path, build: &Path) -> Option<PathBuf> {
    let Some(mut cargo) = cargo(TARGET) else {
        leave_out(&no_rust(TARGET));
        return None;
    };
    let own = [
        "Cargo.toml",
        "Cargo.lock",
        "memory.x",
        ".cargo/config.toml",
        "src/main.rs",
    ];
    let own = own.map(|file| format!("{example}/{file}"));
    for file in own.iter().map(String::as_str).chain(["rust/src/board.rs"]) {
        let to = build.join(file);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(examples().join(file), to).unwrap();
    }
    let folder = build.join(example);
    let emitted = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["build", "--emit", "rust", "-o"])
        .arg(folder.join("plc"))
        .arg(program)
        .output();
    assert!(emitted.unwrap().status.success());
    // The examples share what they depend on.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("examples");
    let built = cargo
        .args(["build", "--release", "--locked", "--features", "demo"])
        .env("CARGO_TARGET_DIR", &target)
        .current_dir(&folder)
        .output()
        .unwrap();
    assert!(
        built.status.success(),
        "{}",
        String::from_utf8_lossy(&built.stderr)
    );
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    let name = manifest.split('"').nth(1).expect("it has a name");
    Some(target.join(TARGET).join("release").join(name))
}

/// Runs an image under QEMU.
fn simulate(image: &Path, options: &[&str]) -> Output {
    let machine = "-M netduinoplus2 -nographic -icount shift=0,sleep=off -semihosting-config enable=on,target=native";
    Command::new("qemu-system-arm")
        .args(machine.split(' '))
        .args(options)
        .arg("-kernel")
        .arg(image)
        .output()
        .unwrap()
}

#[test]
fn traffic_light_in_rust() {
    if !tools(&["arm-none-eabi-ld", "qemu-system-arm"]) {
        return;
    }
    let build = tempfile::tempdir().unwrap();
    let program = Path::new(env!("RUNGC_ROOT")).join("examples/programs/traffic_light.il");
    if let Some(image) = rust_image("rust", &program, build.path()) {
        insta::assert_snapshot!("traffic_light", lamps(&simulate(&image, &[])));
    }
}

#[test]
fn stepper_in_rust() {
    if !tools(&["arm-none-eabi-ld", "qemu-system-arm"]) {
        return;
    }
    let build = tempfile::tempdir().unwrap();
    let program = examples().join("stepper.il");
    if let Some(image) = rust_image("rust-stepper", &program, build.path()) {
        let log = build.path().join("log");
        let output = simulate(&image, &["-d", "unimp", "-D", &log.display().to_string()]);
        check_stepper(&output, &log);
    }
}

const TASK_TARGET: &str = "thumbv7m-none-eabi";

/// Builds an example for an LM3S6965, with all folders beside each other in `build`, and prints its log by defmt.
fn task_image(example: &str, mut cargo: Command, build: &Path) -> PathBuf {
    let folder = build.join(example);
    let own = ["Cargo.toml", "Cargo.lock", ".cargo/config.toml", "src"];
    let shared = ["board.rs", "crossing.rs"].map(str::to_string);
    for file in own
        .map(|file| format!("{example}/{file}"))
        .iter()
        .chain(&shared)
    {
        let (from, to) = (firmware().join("lm3s6965").join(file), build.join(file));
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        if from.is_file() {
            std::fs::copy(from, to).unwrap();
            continue;
        }
        std::fs::create_dir_all(&to).unwrap();
        for source in std::fs::read_dir(from).unwrap() {
            let source = source.unwrap();
            std::fs::copy(source.path(), to.join(source.file_name())).unwrap();
        }
    }
    let emitted = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["build", "--emit", "rust", "--defmt", "-o"])
        .arg(folder.join("plc"))
        .arg(firmware().join("../programs/traffic_light.il"))
        .output();
    assert!(emitted.unwrap().status.success());
    // What the examples depend on takes a minute.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tasks");
    let built = cargo
        .args(["build", "--release", "--locked", "--features", "demo"])
        .env("CARGO_TARGET_DIR", &target)
        .env("DEFMT_LOG", "info")
        // As small as it can be does not matter here, and takes longer.
        .env("CARGO_PROFILE_RELEASE_LTO", "off")
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1")
        .current_dir(&folder)
        .output()
        .unwrap();
    let messages = String::from_utf8_lossy(&built.stderr);
    assert!(
        built.status.success() && !messages.contains("warning: unused"),
        "{messages}"
    );
    let release = target.join(TASK_TARGET).join("release");
    release.join(format!("traffic-light-{example}"))
}

/// The program is a task of RTIC and of Embassy, whose state defmt can print.
#[test]
fn traffic_light_as_a_task() {
    if !tools(&["arm-none-eabi-ld", "qemu-system-arm"]) {
        return;
    }
    let build = tempfile::tempdir().unwrap();
    for example in ["rtic", "embassy"] {
        let Some(cargo) = cargo(TASK_TARGET) else {
            return leave_out(&no_rust(TASK_TARGET));
        };
        let image = task_image(example, cargo, build.path());
        let format = b"traffic_light: {=istr}";
        let bytes = std::fs::read(&image).unwrap();
        assert!(bytes.windows(format.len()).any(|part| part == format));
        let machine = "-M lm3s6965evb -nographic -icount shift=7,sleep=off -semihosting-config enable=on,target=native";
        let output = Command::new("qemu-system-arm")
            .args(machine.split(' '))
            .arg("-kernel")
            .arg(&image)
            .output();
        insta::assert_snapshot!("traffic_light", lamps(&output.unwrap()));
    }
}
