//! A log in a file, which a thread writes: a slow or full disk does not hold up a scan.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender, TrySendError};
use std::thread;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Lines that wait for the disk; more are counted.
const WAITING: usize = 256;

/// A log of this size, in bytes, is moved to `FILE.1`, and a new one begins.
const LARGEST: u64 = 1 << 20;

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
    /// The file cannot be written.
    pub(super) fn begin(path: &str) -> io::Result<Self> {
        // An error in the path is reported at once.
        append(Path::new(path), "")?;
        let path = PathBuf::from(path);
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
        let mut text = format!("{} {line}\n", time(SystemTime::now()));
        if self.left_out > 0 {
            text = format!("({} lines are missing here)\n{text}", self.left_out);
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
            text =
                format!("({lost} lines are missing here: the file could not be written)\n{text}");
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
        let mut old = path.as_os_str().to_owned();
        old.push(".1");
        fs::rename(path, old)?;
        file = File::options().append(true).create(true).open(path)?;
        return file.write_all(text.as_bytes());
    }
    file.write_all(text.as_bytes()).inspect_err(|_| {
        // As good as it can be had.
        let _ = file.set_len(size);
    })
}

/// A time as `2026-11-23T22:57:01Z`.
fn time(now: SystemTime) -> String {
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
    fn times_are_those_of_the_calendar() {
        let at = |seconds| time(UNIX_EPOCH + Duration::from_secs(seconds));
        // By `date -u -d @SECONDS +%FT%TZ`.
        assert_eq!(at(0), "1970-01-01T00:00:00Z");
        assert_eq!(at(951_827_696), "2000-02-29T12:34:56Z");
        assert_eq!(at(1_795_474_621), "2026-11-23T22:57:01Z");
        assert_eq!(at(4_107_542_399), "2100-02-28T23:59:59Z");
        assert_eq!(at(4_107_542_400), "2100-03-01T00:00:00Z");
        assert_eq!(time(UNIX_EPOCH - Duration::from_secs(1)), at(0));
    }
}
