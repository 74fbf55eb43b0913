//! `rungc serve` and executables in C and in Rust that save latched devices, on slow and full disks, and with a clock
//! that is set.

use super::last;
use crate::common::hosts::{self, Host};
use crate::common::{folder, rungc, soon, text};
use crate::tools;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Runs an executable until it reads `quit`, after it has shown an output; what it prints.
fn until_quit(folder: &Path, program: &Path, args: &[&str]) -> (String, Option<i32>) {
    let mut child = Command::new(program)
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut shown = BufReader::new(child.stdout.take().unwrap());
    let mut printed = String::new();
    shown.read_line(&mut printed).unwrap();
    // A program that has ended already reads nothing.
    let _ = child.stdin.take().unwrap().write_all(b"quit\n");
    shown.read_to_string(&mut printed).unwrap();
    let output = child.wait_with_output().unwrap();
    (printed + &text(&output.stderr), output.status.code())
}

/// Executables in C and in Rust, and `rungc run`, load what the others have saved.
#[test]
fn executables_keep_latched_devices() {
    let folder = folder(&[
        ("starts.il", hosts::PROGRAM.as_bytes()),
        ("pump.il", b"LD X0\nSET M500\nLD M500\nOUT Y0\nEND\n"),
    ]);
    let at = folder.path();
    let built = rungc(at, &["build", "pump.il", "--emit", "bin", "-o", "pump"]);
    assert!(built.status.success(), "{}", text(&built.stderr));
    let [in_c, in_rust] = hosts::executables();
    let retain = ["--retain", "starts.retain"];
    let (messages, _) = until_quit(at, in_c, &retain);
    assert!(messages.contains("does not exist yet"), "{messages}");
    assert!(messages.contains("Y000 on"), "{messages}");
    let (messages, _) = until_quit(at, in_rust, &retain);
    assert!(
        messages.contains("Y001 on") && messages.lines().count() == 1,
        "{messages}"
    );
    let third = rungc(
        at,
        &[
            "run",
            "starts.il",
            "--retain",
            "starts.retain",
            "--watch",
            "D200,C101",
        ],
    );
    // The RST that the first start executed holds C101, which counts starts.
    assert_eq!(last(&third), "3 0");
    let (messages, _) = until_quit(at, in_c, &retain);
    assert!(
        messages.contains("Y003 on") && messages.lines().count() == 1,
        "{messages}"
    );
    let before = fs::read(at.join("starts.retain")).unwrap();
    let refused = until_quit(at, &at.join("pump"), &retain);
    let why = "pump: starts.retain holds the latched devices of `starts (fx3u)`, and this program is `pump (fx3u)`; \
               name another file\n";
    assert_eq!(refused, (why.to_string(), Some(2)));
    fs::write(at.join("starts.retain"), &before[..before.len() - 1]).unwrap();
    let why = "starts.retain does not hold latched devices, or is damaged\n";
    let refused = until_quit(at, in_c, &retain);
    assert_eq!(refused, (format!("starts: {why}"), Some(2)));
    let (messages, code) = until_quit(at, in_rust, &retain);
    assert_eq!(code, Some(2));
    assert!(
        messages.contains("does not hold latched devices, or is damaged"),
        "{messages}"
    );
}

/// Runs a test for each host at the same time, in a separate folder.
fn each(test: impl Fn(Host, &Path) + Sync) {
    thread::scope(|scope| {
        for host in Host::all() {
            let test = &test;
            scope.spawn(move || {
                let folder = folder(&[
                    ("starts.il", hosts::PROGRAM.as_bytes()),
                    ("rungc.toml", hosts::SETTINGS.as_bytes()),
                ]);
                fs::create_dir(folder.path().join("disk")).unwrap();
                test(host, folder.path());
            });
        }
    });
}

/// A library that is loaded before the C library.
fn preloaded(folder: &Path, name: &str, source: &str) -> String {
    let (library, text) = (folder.join(name), folder.join(format!("{name}.c")));
    fs::write(&text, source).unwrap();
    let cc = Command::new("cc")
        .args(["-shared", "-fPIC", "-o"])
        .args([&library, &text])
        .output()
        .unwrap();
    assert!(
        cc.status.success(),
        "{}",
        String::from_utf8_lossy(&cc.stderr)
    );
    library.display().to_string()
}

/// The first flush of a file takes SECONDS.
const SLOW: &str = "\
#define _GNU_SOURCE
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>
int fsync(int file)
{
    static int flushed;
    struct stat what;
    if (fstat(file, &what) == 0 && S_ISREG(what.st_mode) && flushed++ == FLUSH) {
        sleep(SECONDS);
    }
    return (int)syscall(SYS_fsync, file);
}
";

/// A disk that takes 12 s to save holds up no scan; after 10 s, the program is notified.
#[test]
fn a_slow_disk_does_not_hold_up_scans() {
    each(|host, folder| {
        let source = SLOW.replace("SECONDS", "12").replace("FLUSH", "0");
        let slow = preloaded(folder, "slow.so", &source);
        let mut running = host.start(
            folder,
            &["--retain", "disk/latched"],
            &[("LD_PRELOAD", &slow)],
        );
        running.counts();
        let began = Instant::now();
        let mut changes = 0;
        while let Some((_, terminal, on)) = running.next() {
            if terminal == "Y010" {
                changes += 1;
            }
            if terminal == "Y012" {
                assert!(on, "{host:?}");
                break;
            }
        }
        assert!(began.elapsed() > Duration::from_secs(8), "{host:?}");
        assert!(changes > 10, "{host:?}: {changes} times ten scans");
        running.shows("Y012", false);
        let (code, messages) = running.end();
        assert_eq!(code, host.code(), "{messages}");
        let complaints = [
            "the disk takes longer than 10 s; latched devices are not saved",
            "latched devices are saved again",
        ];
        for complaint in complaints {
            assert_eq!(
                messages.matches(complaint).count(),
                1,
                "{host:?}: {messages}"
            );
        }
    });
}

/// A disk that is full, and one that vanishes: scans continue, the program is notified, and what was saved remains.
#[test]
fn a_disk_that_takes_nothing_does_not_stop_scans() {
    each(|host, folder| {
        let mut running = host.start(folder, &["--retain", "disk/latched"], &[]);
        running.counts();
        let latched = folder.join("disk/latched");
        soon("it is saved", || latched.exists());
        running.limit_files("0");
        running.shows("Y012", true);
        running.counts();
        assert!(!folder.join("disk/latched.new").exists(), "{host:?}");
        let whole = fs::read(&latched).unwrap();
        running.limit_files("unlimited");
        running.shows("Y012", false);
        fs::rename(folder.join("disk"), folder.join("away")).unwrap();
        running.shows("Y012", true);
        running.counts();
        fs::rename(folder.join("away"), folder.join("disk")).unwrap();
        running.shows("Y012", false);
        assert_ne!(fs::read(&latched).unwrap(), whole, "{host:?}");
        fs::rename(folder.join("disk"), folder.join("away")).unwrap();
        let (code, messages) = running.end();
        // A failed save at the end is a failure.
        assert_eq!(code, Some(1), "{host:?}: {messages}");
        let count = |what: &str| messages.matches(what).count();
        assert!(
            count("latched devices are not saved") >= 3,
            "{host:?}: {messages}"
        );
        assert_eq!(
            count("latched devices are saved again"),
            2,
            "{host:?}: {messages}"
        );
    });
}

/// A host killed while it saves leaves the old file or the new one.
#[test]
fn killing_it_while_it_saves_tears_no_file() {
    each(|host, folder| {
        let new = folder.join("disk/latched.new");
        // During the first save, and during the second.
        for (flush, known) in [("0", false), ("1", true)] {
            let source = SLOW.replace("SECONDS", "60").replace("FLUSH", flush);
            let slow = preloaded(folder, &format!("slow-{flush}.so"), &source);
            let mut running = host.start(
                folder,
                &["--retain", "disk/latched"],
                &[("LD_PRELOAD", &slow)],
            );
            running.counts();
            soon("it saves", || {
                new.exists() && folder.join("disk/latched").exists() == known
            });
            drop(running);
            assert!(new.exists(), "{host:?}");
            let mut again = host.start(folder, &["--retain", "disk/latched"], &[]);
            again.counts();
            let (code, messages) = again.end();
            assert_eq!(code, host.code(), "{host:?}: {messages}");
            assert_eq!(
                messages.contains("does not exist yet"),
                !known,
                "{host:?}: {messages}"
            );
            assert!(
                !messages.contains("damaged") && !new.exists(),
                "{host:?}: {messages}"
            );
            if !known {
                fs::remove_file(folder.join("disk/latched")).unwrap();
            }
        }
    });
}

/// One process at a time uses a file, whatever host it is, and nothing but the file remains.
#[test]
fn a_file_is_for_one_process() {
    each(|host, folder| {
        let retain = ["--retain", "disk/latched"];
        let mut running = host.start(folder, &retain, &[]);
        running.counts();
        let [in_c, in_rust] = hosts::executables();
        let rungc = Path::new(env!("CARGO_BIN_EXE_rungc"));
        let others: [(&Path, &[&str]); 3] = [(in_c, &[]), (in_rust, &[]), (rungc, &["serve"])];
        for (program, command) in others {
            // One that is not rejected would run on.
            let refused = Command::new("timeout")
                .arg("60")
                .arg(program)
                .args(command)
                .args(retain)
                .current_dir(folder)
                .stdin(Stdio::null())
                .output()
                .unwrap();
            let messages = text(&refused.stderr);
            assert_eq!(refused.status.code(), Some(2), "{host:?}: {messages}");
            assert!(
                messages.contains("is in use by another process"),
                "{host:?}: {messages}"
            );
        }
        let (code, messages) = running.end();
        assert_eq!(code, host.code(), "{messages}");
        let files = fs::read_dir(folder.join("disk")).unwrap();
        let names: Vec<_> = files.map(|file| file.unwrap().file_name()).collect();
        assert_eq!(names, ["latched"], "{host:?}");
        let mut again = host.start(folder, &retain, &[]);
        again.counts();
        let (code, messages) = again.end();
        assert_eq!(code, host.code(), "{messages}");
    });
}

/// libfaketime 0.9.10 takes absolute times of the monotonic clock for times of day, even where it is to leave that
/// clock alone; later versions do not.
const MONOTONIC: &str = "\
#define _GNU_SOURCE
#include <errno.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>
int clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *left)
{
    return syscall(SYS_clock_nanosleep, clock, flags, until, left) == 0 ? 0 : errno;
}
";

/// The library that `faketime` (apt-get install faketime) loads before a program.
fn faketime() -> Option<String> {
    let found = fs::read_dir("/usr/lib").ok()?.filter_map(Result::ok);
    let library = |folder: fs::DirEntry| folder.path().join("faketime/libfaketime.so.1");
    let library = found.map(library).find(|library| library.exists());
    if library.is_none() {
        tools::leave_out("libfaketime (apt-get install faketime)");
    }
    library.map(|library| library.display().to_string())
}

/// The time of day is set, forward and back by hours: scans and timers do not notice, the real-time clock follows.
#[test]
fn setting_the_clock_changes_only_the_real_time_clock() {
    let Some(faketime) = faketime() else {
        return;
    };
    each(|host, folder| {
        let monotonic = preloaded(folder, "monotonic.so", MONOTONIC);
        let offset = folder.join("offset");
        // Half past some hour, so that it does not change by itself.
        let now = std::time::SystemTime::UNIX_EPOCH
            .elapsed()
            .unwrap()
            .as_secs() as i64;
        let set = |hours: i64| {
            let seconds = 1800 - now % 3600 + 3600 * hours;
            fs::write(folder.join("new"), format!("{seconds:+}\n")).unwrap();
            fs::rename(folder.join("new"), &offset).unwrap();
        };
        set(0);
        let environment = [
            ("LD_PRELOAD", &*format!("{monotonic} {faketime}")),
            ("FAKETIME_TIMESTAMP_FILE", &offset.display().to_string()),
            ("FAKETIME_NO_CACHE", "1"),
            ("FAKETIME_DONT_FAKE_MONOTONIC", "1"),
            ("TZ", "UTC0"),
        ];
        let mut running = host.start(folder, &[], &environment);
        running.counts();
        let began = Instant::now();
        let mut times = [0u32; 2];
        let mut last = began;
        for (hours, changes) in [(5, true), (0, false), (-7, true), (0, false)] {
            set(hours);
            let mut followed = false;
            let before = times;
            // Ten times a hundred scans, and two timers, with the new time.
            while !followed || times[0] < before[0] + 10 || times[1] < before[1] + 2 {
                let (at, terminal, on) = running.next().unwrap();
                match &*terminal {
                    "Y010" => times[0] += 1,
                    "Y011" => times[1] += 1,
                    "Y013" => {
                        assert!(on == changes && !followed, "{host:?}");
                        followed = true;
                    }
                    other => panic!("{host:?}: {other}"),
                }
                last = at;
            }
        }
        let passed = last - began;
        for (what, count, every_ms) in [("scans", times[0], 100), ("timers", times[1], 500)] {
            let most = passed.as_millis() / every_ms;
            assert!(
                u128::from(count) <= most * 5 / 4 + 2,
                "{host:?}: {count} times {every_ms} ms of {what} in {passed:?}"
            );
        }
        let (code, messages) = running.end();
        assert_eq!(code, host.code(), "{messages}");
        // On a busy machine it may stand still for seconds, but not for hours.
        let hours = |line: &str| {
            let (_, rest) = line.split_once("stood still for ")?;
            let seconds: f64 = rest.split(' ').next()?.parse().ok()?;
            (seconds >= 3600.0).then_some(())
        };
        assert!(
            messages.lines().all(|line| hours(line).is_none()),
            "{host:?}: {messages}"
        );
    });
}
