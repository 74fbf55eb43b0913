//! Latched devices that survive in a file, as a record of [`rungc_rt::retain`].

mod lock;
#[cfg(test)]
mod tests;

use lock::Lock;
use rungc_rt::Program;
use rungc_rt::retain::Loaded;
use rungc_rt::retain::record::{self, Source};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender, TryRecvError};
use std::thread;

/// Interval at which a host checks latched devices for changes, in milliseconds.
const EVERY_MS: u32 = 1000;

/// Time after which devices count as not saved while the disk is busy, in milliseconds.
const SLOW_MS: u32 = 10_000;

/// A file that holds the latched devices of a program. It is replaced as a whole: written under another name, flushed
/// to the disk, renamed. Whenever the process or the machine ends, the file is the old one or the new one.
#[derive(Debug)]
pub struct RetainFile {
    path: PathBuf,
    sequence: u32,
    saved: Option<u32>,
    looked_ms: u32,
    /// Thread that writes between scans, started when first needed.
    writer: Option<Writer>,
    /// The state that it writes now.
    writing: Option<u32>,
    /// Saving fails, which was reported.
    fails: bool,
    /// Keeps other hosts from the file.
    _lock: Option<Lock>,
}

/// A thread that replaces the file, so that no scan waits for the disk. It ends with the file.
#[derive(Debug)]
struct Writer {
    records: Sender<Vec<u8>>,
    results: Receiver<io::Result<()>>,
}

impl Writer {
    fn start(path: PathBuf) -> io::Result<Self> {
        let (records, to_write) = mpsc::channel::<Vec<u8>>();
        let (written, results) = mpsc::channel();
        let work = move || {
            for record in to_write {
                if written.send(replace(&path, &record)).is_err() {
                    break;
                }
            }
        };
        thread::Builder::new()
            .name("retain".to_string())
            .spawn(work)?;
        Ok(Writer { records, results })
    }
}

impl RetainFile {
    /// Opens a file, which need not exist, and gives a program that was just switched on the values in it.
    ///
    /// # Errors
    /// The file cannot be read, or it does not hold latched devices.
    pub fn open(path: impl Into<PathBuf>, program: &mut dyn Program) -> io::Result<(Self, Loaded)> {
        let mut file = RetainFile {
            path: path.into(),
            sequence: 0,
            saved: None,
            looked_ms: 0,
            writer: None,
            writing: None,
            fails: false,
            _lock: None,
        };
        let bytes = match fs::read(&file.path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok((file, Loaded::Nothing));
            }
            Err(error) => return Err(error),
        };
        let damaged = || {
            let what = "does not hold latched devices, or is damaged";
            io::Error::new(io::ErrorKind::InvalidData, what)
        };
        let mut read = |at: u32, out: &mut [u8]| {
            let from = bytes.get(at as usize..).unwrap_or_default();
            let piece = from.get(..out.len()).ok_or_else(damaged)?;
            out.copy_from_slice(piece);
            Ok(())
        };
        let read: Source<'_, io::Error> = &mut read;
        let end = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let record = record::find(read, 0, end)?.ok_or_else(damaged)?;
        file.sequence = record.sequence.wrapping_add(1);
        let loaded = record::restore(read, &record, program)?;
        if let Loaded::Restored { dropped: 0 } = loaded {
            file.saved = Some(record::state(program));
        }
        Ok((file, loaded))
    }

    /// Opens a file as a host does, which passes the messages for the user to `report`. No other host can open it
    /// meanwhile, where the system has locks.
    ///
    /// # Errors
    /// Why the file cannot be used. One that another process uses, or that holds the latched devices of another
    /// program, is left as it is.
    pub fn begin(
        path: impl Into<PathBuf>,
        program: &mut dyn Program,
        report: impl FnOnce(String),
    ) -> Result<Self, String> {
        let path = path.into();
        let lock = Lock::take(&path).map_err(|error| error.to_string())?;
        let (mut file, loaded) = Self::open(path, program).map_err(|error| error.to_string())?;
        file._lock = lock;
        let path = file.path.display();
        match loaded {
            Loaded::Nothing => report(format!(
                "{path} does not exist yet: latched devices begin as the PLC leaves the factory"
            )),
            Loaded::Foreign(owner) => {
                let (owner, own) = (owner.as_str(), program.retained().program);
                return Err(format!(
                    "holds the latched devices of `{owner}`, and this program is `{own}`; name another file"
                ));
            }
            Loaded::Restored { dropped: 0 } => {}
            Loaded::Restored { dropped } => report(format!(
                "{path}: {dropped} of its devices are dropped: \
                 the program does not use them as latched devices any more"
            )),
        }
        Ok(file)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Saves a program's latched devices if one has changed since they were loaded or saved last. Returns whether they
    /// were saved. Waits for the disk: for the end of a run.
    ///
    /// # Errors
    /// The file cannot be replaced; it is the old one then.
    pub fn save(&mut self, program: &dyn Program) -> io::Result<bool> {
        if self.writing.is_some() {
            let result = match &self.writer {
                Some(writer) => writer.results.recv().unwrap_or_else(|_| Err(gone())),
                None => Err(gone()),
            };
            // A failed save is tried once more.
            let _ = self.written(result);
        }
        let state = record::state(program);
        if self.saved == Some(state) {
            return Ok(false);
        }
        let bytes = self.record(program)?;
        self.writing = Some(state);
        self.written(replace(&self.path, &bytes))?;
        Ok(true)
    }

    /// To be called between scans, `now_ms` is the program's time: begins to save once in `every_ms` if a latched
    /// device has changed, in another thread. Returns whether an earlier save is done by now.
    ///
    /// # Errors
    /// An earlier save has failed: the file is the old one. It is tried again.
    pub fn poll(&mut self, program: &dyn Program, now_ms: u32, every_ms: u32) -> io::Result<bool> {
        if self.writing.is_some() {
            let result = match &self.writer {
                Some(writer) => match writer.results.try_recv() {
                    Ok(result) => result,
                    Err(TryRecvError::Empty) => return Ok(false),
                    Err(TryRecvError::Disconnected) => Err(gone()),
                },
                None => Err(gone()),
            };
            return self.written(result).map(|()| true);
        }
        if now_ms.wrapping_sub(self.looked_ms) < every_ms {
            return Ok(false);
        }
        self.looked_ms = now_ms;
        let state = record::state(program);
        if self.saved != Some(state) {
            let record = self.record(program)?;
            let writer = match self.writer.take() {
                Some(writer) => writer,
                None => Writer::start(self.path.clone())?,
            };
            if writer.records.send(record).is_ok() {
                self.writing = Some(state);
                self.writer = Some(writer);
            }
        }
        Ok(false)
    }

    /// As [`RetainFile::poll`], once a second, for a host that continues without the disk. Returns what there is to
    /// report: that devices are not saved, or that they are saved again.
    pub fn keep(&mut self, program: &dyn Program, now_ms: u32) -> Option<String> {
        let result = self.poll(program, now_ms, EVERY_MS);
        let is_slow = self.writing.is_some() && now_ms.wrapping_sub(self.looked_ms) > SLOW_MS;
        let why = match result {
            Ok(true) if std::mem::take(&mut self.fails) => {
                return Some(self.about("latched devices are saved again"));
            }
            Ok(_) if is_slow => "the disk takes longer than 10 s".to_string(),
            Ok(_) => return None,
            Err(error) => error.to_string(),
        };
        if std::mem::replace(&mut self.fails, true) {
            return None;
        }
        Some(self.about(&format!("{why}; latched devices are not saved")))
    }

    /// Returns true if latched devices cannot be saved, as [`RetainFile::keep`] has reported.
    pub fn fails(&self) -> bool {
        self.fails
    }

    /// After the last scan: saves what has changed since, and waits for the disk.
    ///
    /// # Errors
    /// What there is to report: that devices are not saved.
    pub fn end(mut self, program: &dyn Program) -> Result<(), String> {
        let saved = self.save(program);
        saved.map(drop).map_err(|error| {
            let why = format!("{error}; latched devices are not saved");
            self.about(&why)
        })
    }

    fn about(&self, what: &str) -> String {
        format!("{}: {what}", self.path.display())
    }

    fn record(&self, program: &dyn Program) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        record::write(program, self.sequence, &mut |piece| bytes.write_all(piece))?;
        Ok(bytes)
    }

    /// A save has ended.
    fn written(&mut self, result: io::Result<()>) -> io::Result<()> {
        let state = self.writing.take();
        result?;
        self.sequence = self.sequence.wrapping_add(1);
        self.saved = state;
        Ok(())
    }
}

fn gone() -> io::Error {
    io::Error::other("the thread that writes it has ended")
}

/// Replaces a file, which a link may lead to: one beside it, `FILE.new`, is written and flushed, and takes its name;
/// then the folder is flushed, too. Nothing remains of what a full disk does not take.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut name = OsString::from(path);
    name.push(".new");
    let new = PathBuf::from(name);
    remove_rest(&new)?;
    write(&new, bytes)
        .and_then(|()| fs::rename(&new, path))
        .inspect_err(|_| {
            let _ = fs::remove_file(&new);
        })?;
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    // Only Unix opens folders.
    if cfg!(unix) {
        File::open(folder.unwrap_or(Path::new(".")))?.sync_all()?;
    }
    Ok(())
}

/// Removes what a save has left that power failure ended: the beginning of a record, or zeros in its place. Anything
/// else of that name is somebody's, such as a link to another file, and stays.
fn remove_rest(new: &Path) -> io::Result<()> {
    let is_file = match fs::symlink_metadata(new) {
        Ok(found) => found.is_file(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(error),
    };
    let mut start = Vec::new();
    if is_file {
        let magic = record::MAGIC.len() as u64;
        File::open(new)?.take(magic).read_to_end(&mut start)?;
    }
    if is_file && (record::MAGIC.starts_with(&start) || start.iter().all(|&byte| byte == 0)) {
        return fs::remove_file(new);
    }
    let what = format!("{} is in the way; move it", new.display());
    Err(io::Error::new(io::ErrorKind::AlreadyExists, what))
}

/// Writes a new file, and flushes it to the disk.
fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create_new(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}
