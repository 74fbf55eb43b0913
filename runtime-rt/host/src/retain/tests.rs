//! Saves and their interruptions, with a program that does nothing but keep devices.

use super::*;
use rungc_rt::retain::{Retained, RetainedRun};
use rungc_rt::{Class, Hal, Plc, State, Sys};
use std::collections::HashMap;
use std::io::ErrorKind;

const RUNS: [RetainedRun; 5] = [
    RetainedRun::new(Class::M, 500, 21),
    RetainedRun::new(Class::T, 250, 2),
    RetainedRun::new(Class::C, 100, 1),
    RetainedRun::new(Class::C, 220, 1),
    RetainedRun::new(Class::D, 200, 3),
];

/// A program that keeps some devices.
#[derive(Default)]
struct Retaining {
    bits: HashMap<(Class, u32), bool>,
    words: HashMap<(Class, u32), i16>,
    counters: HashMap<u32, i32>,
    state: State,
    sys: Sys,
}

impl Retaining {
    fn new() -> Self {
        Self::default()
    }

    /// All latched devices differ from one state to the next.
    fn with_state(state: i16) -> Self {
        let mut kept = Retaining::new();
        for n in 0..21 {
            let on = (i32::from(state) + n) % 2 == 1;
            kept.set_bit(Class::M, 500 + n as u32, on).unwrap();
        }
        for (class, first, count) in [(Class::T, 250, 2), (Class::C, 100, 1), (Class::D, 200, 3)] {
            for number in first..first + count {
                kept.set_word(class, number, state).unwrap();
            }
        }
        kept.set_bit(Class::T, 251, state % 2 == 0).unwrap();
        kept.set_counter32(220, i32::from(state) * 100_000).unwrap();
        kept
    }

    fn state(&self) -> u32 {
        record::state(self)
    }
}

impl Plc for Retaining {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        Some(self.bits.get(&(class, number)).copied().unwrap_or_default())
    }
    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.bits.insert((class, number), value);
        Some(())
    }
    fn word(&self, class: Class, number: u32) -> Option<i16> {
        Some(
            self.words
                .get(&(class, number))
                .copied()
                .unwrap_or_default(),
        )
    }
    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        self.words.insert((class, number), value);
        Some(())
    }
    fn counter32(&self, number: u32) -> Option<i32> {
        Some(self.counters.get(&number).copied().unwrap_or_default())
    }
    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.counters.insert(number, value);
        Some(())
    }
    fn state(&mut self, _: u16) -> &mut State {
        &mut self.state
    }
    fn sys(&self) -> &Sys {
        &self.sys
    }
    fn reset(&mut self, _: Class, _: u32) -> Option<()> {
        None
    }
}

impl Program for Retaining {
    fn scan(&mut self, _: &mut dyn Hal, _: u32, _: u32) {}
    fn set_running(&mut self, _: bool) {}
    fn power_cycle(&mut self) {}
    fn output(&self, _: u32) -> bool {
        false
    }
    fn retained(&self) -> Retained<'_> {
        Retained {
            program: "motor (h2u)",
            runs: &RUNS,
            ..Retained::NOTHING
        }
    }
}

#[test]
fn a_file_holds_the_values_of_the_last_save() {
    let folder = std::env::temp_dir().join(format!("rungc-retain-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("motor.retain");
    let (mut file, what) = RetainFile::open(&path, &mut Retaining::new()).unwrap();
    assert_eq!(what, Loaded::Nothing);
    for number in 1..4 {
        assert!(file.save(&Retaining::with_state(number)).unwrap());
    }
    assert!(!file.save(&Retaining::with_state(3)).unwrap(), "unchanged");
    let mut kept = Retaining::new();
    let (_, what) = RetainFile::open(&path, &mut kept).unwrap();
    assert_eq!(what, Loaded::Restored { dropped: 0 });
    assert_eq!(kept.state(), Retaining::with_state(3).state());
    // Between scans another thread writes.
    let kept = Retaining::with_state(4);
    let until = std::time::Instant::now() + std::time::Duration::from_secs(300);
    let mut now_ms = 1000;
    while !file.poll(&kept, now_ms, 1000).unwrap() {
        assert!(std::time::Instant::now() < until, "it is saved");
        now_ms += 1000;
    }
    assert!(!file.save(&kept).unwrap(), "saved already");
    assert!(
        !file
            .poll(&Retaining::with_state(5), now_ms + 1000, 1000)
            .unwrap()
    );
    assert!(
        file.save(&Retaining::with_state(6)).unwrap(),
        "the last one"
    );
    let mut read = Retaining::new();
    let _ = RetainFile::open(&path, &mut read).unwrap();
    assert_eq!(read.state(), Retaining::with_state(6).state());
    let whole = std::fs::read(&path).unwrap();
    for cut in 0..whole.len() {
        std::fs::write(&path, &whole[..cut]).unwrap();
        let error = RetainFile::open(&path, &mut Retaining::new()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidData, "{cut} bytes");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_save_replaces_only_what_a_save_has_left() {
    let folder = std::env::temp_dir().join(format!("rungc-retain-new-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (path, new) = (folder.join("a.retain"), folder.join("a.retain.new"));
    let mut program = Retaining::new();
    let (mut file, _) = RetainFile::open(&path, &mut program).unwrap();
    for (n, rest) in (1..).zip([&b""[..], b"RG", b"RGR1 and more", &[0; 9]]) {
        std::fs::write(&new, rest).unwrap();
        assert!(file.save(&Retaining::with_state(n)).unwrap(), "{rest:?}");
        assert!(!new.exists());
    }
    std::fs::write(&new, "somebody's").unwrap();
    let error = file.save(&Retaining::with_state(9)).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::AlreadyExists);
    assert_eq!(std::fs::read(&new).unwrap(), b"somebody's");
    std::fs::remove_file(&new).unwrap();
    #[cfg(unix)]
    {
        let other = folder.join("other");
        std::fs::write(&other, "").unwrap();
        std::os::unix::fs::symlink(&other, &new).unwrap();
        let error = file.save(&Retaining::with_state(9)).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::AlreadyExists);
        assert_eq!(std::fs::read(&other).unwrap(), b"");
        std::fs::remove_file(&new).unwrap();
    }
    assert!(file.save(&Retaining::with_state(9)).unwrap());
    #[cfg(unix)]
    {
        let link = folder.join("link");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        let (mut file, _) = RetainFile::open(&link, &mut program).unwrap();
        assert!(file.save(&Retaining::with_state(11)).unwrap());
        assert!(link.is_symlink());
        let (mut file, _) = RetainFile::open(&path, &mut program).unwrap();
        assert!(!file.save(&Retaining::with_state(11)).unwrap());
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[cfg(any(target_os = "linux", target_os = "macos", windows))]
#[test]
fn one_host_at_a_time_has_a_file() {
    let folder = std::env::temp_dir().join(format!("rungc-lock-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("motor.retain");
    let begin = |path: &Path| RetainFile::begin(path, &mut Retaining::new(), |_| {});
    let mut first = begin(&path).unwrap();
    assert_eq!(begin(&path).unwrap_err(), "is in use by another process");
    assert!(first.save(&Retaining::with_state(1)).unwrap());
    // The file is another one now.
    assert_eq!(begin(&path).unwrap_err(), "is in use by another process");
    #[cfg(unix)]
    {
        let link = folder.join("link");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        assert_eq!(begin(&link).unwrap_err(), "is in use by another process");
    }
    drop(first);
    assert!(!folder.join("motor.retain.lock").exists());
    drop(begin(&path).unwrap());
    let missing = folder.join("missing/motor.retain");
    assert!(begin(&missing).is_ok(), "what cannot be locked is used");
    std::fs::remove_dir_all(&folder).unwrap();
}
