//! `rungc flash`, against a boot loader at the other end of a pseudo-terminal, which stm32flash finds to be one, too.

mod bench;
#[path = "../../../../firmware/tests/it/flash/part.rs"]
mod part;
mod volume;

use crate::common::{folder, rungc, soon, text, write_executable};
use crate::tools::tools;
use bench::Bench;
use part::{Fault, Part};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const FLASH: usize = 0x0800_0000;

/// An image that takes more than two pages and ends within a block.
fn image(length: usize) -> Vec<u8> {
    (0..length).map(|at| (at * 7 % 253) as u8).collect()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

/// A folder with an image, and a part.
struct Rig {
    folder: TempDir,
    bench: Bench,
    before: Vec<u8>,
}

impl Rig {
    fn new(part: Part) -> Self {
        let before = part.flash.clone();
        Rig {
            folder: folder(&[("image.bin", &image(5002))]),
            bench: Bench::new(part),
            before,
        }
    }

    fn flash(&self, options: &[&str]) -> Output {
        let mut args = vec![
            "flash",
            "image.bin",
            "--port",
            &self.bench.port,
            "--wait",
            "5",
        ];
        args.extend(options);
        rungc(self.folder.path(), &args)
    }

    /// Messages, without the path of the line.
    fn says(&self, output: &Output) -> String {
        text(&output.stderr).replace(&self.bench.port, "PORT")
    }

    fn is_untouched(&self) -> bool {
        self.bench.part().flash == self.before
    }

    /// The image is there, and pages after its last one are as they were.
    #[track_caller]
    fn holds(&self, wanted: &[u8]) {
        let part = self.bench.part();
        assert_eq!(part.flash[..wanted.len()], *wanted);
        let end = wanted.len().next_multiple_of(part.page);
        assert!(
            part.flash[wanted.len()..end]
                .iter()
                .all(|byte| *byte == 0xFF)
        );
        assert_eq!(part.flash[end..], self.before[end..]);
    }
}

#[test]
fn an_image_is_written_and_read_back() {
    for part in [Part::f103vc(), Part::f030c8()] {
        let rig = Rig::new(part);
        let output = rig.flash(&["--yes"]);
        let messages = rig.says(&output);
        assert!(output.status.success(), "{messages}");
        assert!(messages.contains("lost permanently"), "{messages}");
        assert!(messages.contains("read back and compared"), "{messages}");
        rig.holds(&image(5002));
        // A part whose programming is interrupted has no program: the vectors go first and come last.
        let log = rig.bench.part().log.clone();
        assert_eq!(log.first(), Some(&("erase", FLASH)));
        assert_eq!(log.last(), Some(&("write", FLASH)));
    }
}

#[test]
fn what_is_there_is_kept() {
    let rig = Rig::new(Part::f103vc());
    assert!(rig.flash(&["--yes"]).status.success());
    rig.bench.part().log.clear();
    let output = rig.flash(&[]);
    assert!(output.status.success(), "{}", rig.says(&output));
    assert!(rig.says(&output).contains("already holds the image"));
    assert!(rig.bench.part().log.is_empty());
    // A change in the third page leaves the second as it is.
    let mut changed = image(5002);
    changed[4500] ^= 1;
    fs::write(rig.folder.path().join("image.bin"), &changed).unwrap();
    let output = rig.flash(&["--yes", "--start"]);
    assert!(output.status.success(), "{}", rig.says(&output));
    rig.holds(&changed);
    // The part notes that it starts after its answer.
    let starts = || rig.bench.part().log.last() == Some(&("start", FLASH));
    soon("the program starts", starts);
    let log = rig.bench.part().log.clone();
    let erased = log.iter().filter(|(what, _)| *what == "erase");
    let erased: Vec<_> = erased.map(|(_, at)| *at).collect();
    assert_eq!(erased, [FLASH, FLASH + 4096]);
}

#[test]
fn nothing_is_erased_without_consent() {
    let rig = Rig::new(Part::f103vc());
    let output = rig.flash(&[]);
    assert_eq!(code(&output), 2);
    insta::assert_snapshot!(rig.says(&output));
    assert!(rig.is_untouched());
}

#[test]
fn flash_is_saved_before() {
    let rig = Rig::new(Part::f103vc());
    let output = rig.flash(&["--yes", "--backup", "before.bin"]);
    assert!(output.status.success(), "{}", rig.says(&output));
    let saved = fs::read(rig.folder.path().join("before.bin")).unwrap();
    assert_eq!(saved, rig.before);
    rig.holds(&image(5002));
    let again = rig.flash(&["--yes", "--backup", "before.bin"]);
    assert_eq!(code(&again), 2);
}

#[test]
fn protection_is_lifted_only_on_request() {
    let protected = || Part {
        is_read_protected: true,
        ..Part::f103vc()
    };
    let rig = Rig::new(protected());
    let output = rig.flash(&["--yes"]);
    assert_eq!(code(&output), 1);
    insta::assert_snapshot!(rig.says(&output));
    assert!(rig.is_untouched());
    // With consent missing, --unprotect alone erases nothing either.
    let output = rig.flash(&["--unprotect"]);
    assert_eq!(code(&output), 2);
    insta::assert_snapshot!("what_unprotecting_loses", rig.says(&output));
    assert!(rig.is_untouched());
    let output = rig.flash(&["--unprotect", "--yes"]);
    assert!(output.status.success(), "{}", rig.says(&output));
    let flash = rig.bench.part().flash.clone();
    assert_eq!(flash[..5002], image(5002));
    assert!(flash[5002..].iter().all(|byte| *byte == 0xFF));
}

#[test]
fn write_protection_is_lifted_on_request() {
    let rig = Rig::new(Part {
        is_write_protected: true,
        ..Part::f103vc()
    });
    let output = rig.flash(&["--yes"]);
    assert_eq!(code(&output), 1);
    assert!(rig.says(&output).contains("--unprotect lifts that"));
    assert!(rig.is_untouched());
    let output = rig.flash(&["--yes", "--unprotect"]);
    assert!(output.status.success(), "{}", rig.says(&output));
    rig.holds(&image(5002));
}

#[test]
fn parts_and_images_that_do_not_fit_are_rejected() {
    let unknown = Rig::new(Part {
        id: 0x999,
        ..Part::f103vc()
    });
    let output = unknown.flash(&["--yes"]);
    assert_eq!(code(&output), 1);
    insta::assert_snapshot!("an_unknown_part", unknown.says(&output));
    assert!(unknown.is_untouched());

    let small = Rig::new(Part::f030c8());
    fs::write(small.folder.path().join("image.bin"), image(64 * 1024 + 1)).unwrap();
    let output = small.flash(&["--yes"]);
    assert_eq!(code(&output), 1);
    insta::assert_snapshot!("an_image_that_is_too_large", small.says(&output));
    assert!(small.is_untouched());

    let elsewhere = small.flash(&["--yes", "--at", "0x20000000"]);
    assert_eq!(code(&elsewhere), 1);
    assert!(small.says(&elsewhere).contains("E0853"));
}

#[test]
fn a_line_on_which_nothing_answers_is_reported() {
    let (_ours, mut clients) = serial2::SerialPort::pair().unwrap();
    let mut settings = clients.get_configuration().unwrap();
    settings.set_raw();
    clients.set_configuration(&settings).unwrap();
    let port = rustix::termios::ttyname(&clients, Vec::new()).unwrap();
    let port = port.to_string_lossy();
    let folder = folder(&[("image.bin", &image(100))]);
    let args = [
        "flash",
        "image.bin",
        "--port",
        &port,
        "--wait",
        "1",
        "--yes",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(code(&output), 1);
    insta::assert_snapshot!(text(&output.stderr).replace(&*port, "PORT"));
}

/// Faults that the writer overcomes; missing answers take time and are tested in firmware/tests/it/flash.rs.
#[test]
fn rejections_are_overcome() {
    for fault in [Fault::RejectWrite(3), Fault::RejectErase(1)] {
        let mut part = Part::f103vc();
        part.faults.push(fault);
        let rig = Rig::new(part);
        let output = rig.flash(&["--yes"]);
        assert!(output.status.success(), "{fault:?}: {}", rig.says(&output));
        rig.holds(&image(5002));
    }
}

#[test]
fn what_fails_for_good_leaves_no_program() {
    for (fault, name) in [
        (Fault::RejectWrites(5), "rejected"),
        (Fault::BadBit(2), "differs"),
        (Fault::Cut(6), "cut"),
    ] {
        let mut part = Part::f103vc();
        part.faults.push(fault);
        let rig = Rig::new(part);
        let output = rig.flash(&["--yes"]);
        assert_eq!(code(&output), 1, "{fault:?}: {}", rig.says(&output));
        insta::assert_snapshot!(name, rig.says(&output));
        let flash = rig.bench.part().flash[..256].to_vec();
        assert!(flash.iter().all(|byte| *byte == 0xFF), "{fault:?}");
    }
}

#[test]
fn an_interrupted_image_is_completed() {
    let rig = Rig::new(Part {
        faults: vec![Fault::RejectWrites(9)],
        ..Part::f103vc()
    });
    assert_eq!(code(&rig.flash(&["--yes"])), 1);
    rig.bench.part().faults.clear();
    let output = rig.flash(&["--yes"]);
    assert!(output.status.success(), "{}", rig.says(&output));
    rig.holds(&image(5002));
}

/// stm32flash, which other people wrote, and the parts here understand each other.
#[test]
fn stm32flash_finds_the_same() {
    if !tools(&["stm32flash"]) {
        return;
    }
    let call = |rig: &Rig, args: &[&str]| {
        let output = Command::new("stm32flash")
            .args(["-m", "8n1"])
            .args(args)
            .arg(&rig.bench.port)
            .current_dir(rig.folder.path())
            .output()
            .unwrap();
        let messages = text(&[&*output.stdout, &*output.stderr].concat());
        assert!(output.status.success(), "{messages}");
        messages
    };
    for part in [Part::f103vc(), Part::f030c8()] {
        let rig = Rig::new(part);
        assert!(rig.flash(&["--yes"]).status.success());
        let messages = call(&rig, &["-r", "read.bin", "-S", "0x08000000:5002"]);
        let id = format!("0x{:04x}", rig.bench.part().id);
        assert!(messages.contains(&id), "{messages}");
        let read = fs::read(rig.folder.path().join("read.bin")).unwrap();
        assert_eq!(read[..5002], image(5002));
        let other: Vec<_> = image(5002).into_iter().rev().collect();
        fs::write(rig.folder.path().join("other.bin"), &other).unwrap();
        call(&rig, &["-w", "other.bin", "-v"]);
        rig.holds(&other);
        // rungc finds the image that it has written.
        fs::write(rig.folder.path().join("image.bin"), &other).unwrap();
        let output = rig.flash(&[]);
        assert!(rig.says(&output).contains("already holds the image"));
    }
}

/// A folder in which programs are looked for, with a probe-rs that records its arguments.
fn with_probe_rs(folder: &Path, exit: i32) {
    let script = format!(
        "#!/bin/sh\necho \"$@\" >>'{}/asked'\nexit {exit}\n",
        folder.display()
    );
    write_executable(&folder.join("probe-rs"), script.as_bytes());
}

#[test]
fn a_debug_probe_is_used_through_probe_rs() {
    let folder = folder(&[("image.bin", &image(100))]);
    let flash = |options: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["flash", "image.bin", "--probe", "STM32F103VC"])
            .args(options)
            .current_dir(folder.path())
            .env("PATH", folder.path())
            .output()
            .unwrap()
    };
    let absent = flash(&["--yes"]);
    assert_eq!(code(&absent), 2);
    insta::assert_snapshot!("without_probe_rs", text(&absent.stderr));
    with_probe_rs(folder.path(), 0);
    let unasked = flash(&[]);
    assert_eq!(code(&unasked), 2);
    let output = flash(&["--yes", "--unprotect", "--start"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let asked = fs::read_to_string(folder.path().join("asked")).unwrap();
    insta::assert_snapshot!("what_probe_rs_is_asked", asked);
    with_probe_rs(folder.path(), 1);
    let failed = flash(&["--yes"]);
    assert_eq!(code(&failed), 1);
    assert!(text(&failed.stderr).contains("E0854"));
}

#[test]
fn files_that_are_not_images_are_rejected() {
    let arm = |machine: u8| {
        let mut file = b"\x7FELF\x01\x01\x01".to_vec();
        file.resize(52, 0);
        file[16] = 2;
        file[18] = machine;
        file[20] = 1;
        file[40] = 52;
        file
    };
    for (name, file) in [
        ("empty.bin", Vec::new()),
        ("cut.elf", b"\x7FELF".to_vec()),
        ("x86.elf", arm(3)),
        ("nothing.elf", arm(40)),
    ] {
        let folder = folder(&[(name, &file)]);
        let output = rungc(
            folder.path(),
            &["flash", name, "--port", "/dev/null", "--yes"],
        );
        assert_eq!(code(&output), 2, "{name}");
        insta::assert_snapshot!(name, text(&output.stderr));
    }
}
