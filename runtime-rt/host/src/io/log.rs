//! A log in a file, which a thread writes: a slow or full disk does not hold up a scan.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender, TrySendError};
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Lines that wait for the disk; more are counted.
const WAITING: usize = 256;

/// A log of this size, in bytes, is moved to `FILE.1`, and a new one begins.
const LARGEST: u64 = 1 << 20;

/// Shape of the time that a line begins with; `0` stands for a digit.
const PATTERN: &[u8] = b"0000-00-00T00:00:00Z ";

/// Time that the end of a run allows for writing to disk.
const GRACE: Duration = Duration::from_secs(2);

/// A log at work.
pub(super) struct Log {
    lines: SyncSender<String>,
    ended: Receiver<()>,
    left_out: u64,
}

impl Log {
    /// Begins or continues a log.
    ///
    /// # Errors
    /// The file cannot be written, or it is not a log: it stays as it is.
    pub(super) fn begin(path: &str) -> io::Result<Self> {
        let path = PathBuf::from(path);
        for file in [path.clone(), earlier(&path)] {
            if !may_be_log(&file)? {
                let what = format!("{} is not a log; choose another name", file.display());
                return Err(io::Error::new(io::ErrorKind::AlreadyExists, what));
            }
        }
        // An error in the path is reported at once.
        append(&path, "")?;
        let (lines, waiting) = mpsc::sync_channel(WAITING);
        let (end, ended) = mpsc::channel();
        thread::Builder::new()
            .name("log".to_owned())
            .spawn(move || {
                write(&path, &waiting);
                // The run may be over.
                let _ = end.send(());
            })?;
        Ok(Log {
            lines,
            ended,
            left_out: 0,
        })
    }

    /// Adds a line, with the time.
    pub(super) fn add(&mut self, line: &str) {
        let now = timestamp(SystemTime::now());
        let mut text = format!("{now} {line}\n");
        if self.left_out > 0 {
            let left_out = self.left_out;
            text = format!("{now} ({left_out} lines are missing here)\n{text}");
        }
        match self.lines.try_send(text) {
            Ok(()) => self.left_out = 0,
            Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => self.left_out += 1,
        }
    }

    /// Writes what waits; not longer than a disk that works needs.
    pub(super) fn end(self) {
        drop(self.lines);
        match self.ended.recv_timeout(GRACE) {
            Ok(()) | Err(RecvTimeoutError::Disconnected | RecvTimeoutError::Timeout) => {}
        }
    }
}

/// Writes lines until there are none any more.
fn write(path: &Path, lines: &Receiver<String>) {
    let mut lost = 0u64;
    while let Ok(mut text) = lines.recv() {
        text.extend(lines.try_iter());
        let count = text.matches('\n').count() as u64;
        if lost > 0 {
            let now = timestamp(SystemTime::now());
            text = format!(
                "{now} ({lost} lines are missing here: the file could not be written)\n{text}"
            );
        }
        match append(path, &text) {
            Ok(()) => lost = 0,
            Err(error) => {
                if lost == 0 {
                    // Standard error may be full, too.
                    let _ = writeln!(io::stderr(), "{}: {error}", path.display());
                }
                lost += count;
            }
        }
    }
}

/// Adds a text to a file, which may have been moved away since the last time. What a full disk has taken of it
/// is cut off.
fn append(path: &Path, text: &str) -> io::Result<()> {
    let mut file = File::options().append(true).create(true).open(path)?;
    let size = file.metadata()?.len();
    if size > LARGEST && file.metadata()?.is_file() {
        fs::rename(path, earlier(path))?;
        file = File::options().append(true).create(true).open(path)?;
        return file.write_all(text.as_bytes());
    }
    file.write_all(text.as_bytes()).inspect_err(|_| {
        // As good as it can be had.
        let _ = file.set_len(size);
    })
}

/// The file that a full log becomes, `FILE.1`.
fn earlier(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".1");
    PathBuf::from(name)
}

/// Returns true if a file is a log, by the time in its first line, or empty, or not there, or not a regular file, such
/// as `/dev/stderr`.
fn may_be_log(path: &Path) -> io::Result<bool> {
    let mut start = Vec::new();
    match fs::metadata(path) {
        Ok(found) if found.is_file() => {
            let length = PATTERN.len() as u64;
            File::open(path)?.take(length).read_to_end(&mut start)?;
        }
        Ok(_) => return Ok(true),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(true),
        Err(error) => return Err(error),
    }
    let fits = |(pattern, byte): (&u8, u8)| match pattern {
        b'0' => byte.is_ascii_digit(),
        _ => *pattern == byte,
    };
    let is_time =
        start.len() == PATTERN.len() && PATTERN.iter().zip(start.iter().copied()).all(fits);
    Ok(start.is_empty() || is_time)
}

/// A time as `2026-11-23T22:57:01Z`.
pub fn timestamp(now: SystemTime) -> String {
    let seconds = now.duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = date(days);
    let (hour, minute, second) = (rest / 3600, rest / 60 % 60, rest % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z").to_string()
}

/// Year, month and day of a number of days after 1 January 1970: counted in years from March on, in eras of 400.
fn date(days: u64) -> (u64, u64, u64) {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    (era * 400 + year + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_log_is_continued() {
        let folder = std::env::temp_dir().join(format!("rungc-log-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let at = |name: &str| folder.join(name).display().to_string();
        let contents = |name: &str| fs::read_to_string(at(name)).unwrap();
        let line = "2026-11-23T22:57:01Z RUN\n";
        for (name, text, is_log) in [
            ("new", None, true),
            ("empty", Some(""), true),
            ("log", Some(line), true),
            ("program.il", Some("LD X0\nOUT Y0\nEND\n"), false),
            ("date.txt", Some("2026-11-23 a note\n"), false),
        ] {
            if let Some(text) = text {
                fs::write(at(name), text).unwrap();
            }
            assert_eq!(
                Log::begin(&at(name)).map(Log::end).is_ok(),
                is_log,
                "{name}"
            );
            assert_eq!(contents(name), text.unwrap_or_default(), "{name}");
        }
        // The name that a full log takes.
        fs::write(at("log.1"), "mine").unwrap();
        assert!(Log::begin(&at("log")).is_err());
        fs::write(at("log.1"), line).unwrap();
        assert!(Log::begin(&at("log")).is_ok());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn times_are_those_of_the_calendar() {
        let at = |seconds| timestamp(UNIX_EPOCH + Duration::from_secs(seconds));
        // By `date -u -d @SECONDS +%FT%TZ`.
        assert_eq!(at(0), "1970-01-01T00:00:00Z");
        assert_eq!(at(951_827_696), "2000-02-29T12:34:56Z");
        assert_eq!(at(1_795_474_621), "2026-11-23T22:57:01Z");
        assert_eq!(at(4_107_542_399), "2100-02-28T23:59:59Z");
        assert_eq!(at(4_107_542_400), "2100-03-01T00:00:00Z");
        assert_eq!(timestamp(UNIX_EPOCH - Duration::from_secs(1)), at(0));
    }
}
