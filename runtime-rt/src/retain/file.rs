//! A record in a file.

use super::Loaded;
use super::record::{self, Source};
use crate::program::Program;
use std::ffi::OsString;
use std::format;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::string::{String, ToString};
use std::vec::Vec;

/// A file that holds the latched devices of a program. It is replaced as a whole: written under another name, flushed
/// to the disk, renamed. Whenever the process or the machine ends, the file is the old one or the new one.
#[derive(Clone, Debug)]
pub struct RetainFile {
    path: PathBuf,
    sequence: u32,
    saved: Option<u32>,
    looked_ms: u32,
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

    /// Opens a file as a host does, which has others say what came of it: `tell` takes what the user may want to know.
    ///
    /// # Errors
    /// Why the file cannot be used. One that holds the latched devices of another program is left as it is.
    pub fn begin(
        path: impl Into<PathBuf>,
        program: &mut dyn Program,
        tell: impl FnOnce(String),
    ) -> Result<Self, String> {
        let (file, loaded) = Self::open(path, program).map_err(|error| error.to_string())?;
        let path = file.path.display();
        match loaded {
            Loaded::Nothing => tell(format!(
                "{path} does not exist yet: latched devices begin as the PLC leaves the factory"
            )),
            Loaded::Foreign(owner) => {
                let (owner, own) = (owner.as_str(), program.retained().program);
                return Err(format!(
                    "holds the latched devices of `{owner}`, and this program is `{own}`; name another file"
                ));
            }
            Loaded::Restored { dropped: 0 } => {}
            Loaded::Restored { dropped } => tell(format!(
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
    /// were saved.
    ///
    /// # Errors
    /// The file cannot be replaced; it is the old one then.
    pub fn save(&mut self, program: &dyn Program) -> io::Result<bool> {
        let state = record::state(program);
        if self.saved == Some(state) {
            return Ok(false);
        }
        let mut bytes = Vec::new();
        record::write(program, self.sequence, &mut |piece| bytes.write_all(piece))?;
        replace(&self.path, &bytes)?;
        self.sequence = self.sequence.wrapping_add(1);
        self.saved = Some(state);
        Ok(true)
    }

    /// To be called between scans, `now_ms` is the program's time: saves once in `every_ms` if a latched device has
    /// changed. Returns whether they were saved.
    ///
    /// # Errors
    /// The file cannot be replaced; it is the old one then.
    pub fn poll(&mut self, program: &dyn Program, now_ms: u32, every_ms: u32) -> io::Result<bool> {
        if now_ms.wrapping_sub(self.looked_ms) < every_ms {
            return Ok(false);
        }
        self.looked_ms = now_ms;
        self.save(program)
    }
}

/// Replaces a file: one of another name beside it is written and flushed, and takes its name; then the folder is
/// flushed, too.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut name = OsString::from(path);
    name.push(".new");
    let new = PathBuf::from(name);
    let mut file = File::create(&new)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    drop(file);
    fs::rename(&new, path)?;
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    // Only Unix opens folders.
    if cfg!(unix) {
        File::open(folder.unwrap_or(Path::new(".")))?.sync_all()?;
    }
    Ok(())
}
