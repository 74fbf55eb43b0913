//! Locks among processes, so that two do not save into the same file.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Attempts to lock a file that others remove at the same time.
const ATTEMPTS: u32 = 100;

/// A lock on a file, held until it is dropped or the process ends. The file is replaced while it is held, so the lock
/// is on one beside it, `FILE.lock`, which exists only meanwhile.
#[derive(Debug)]
pub(super) struct Lock {
    file: File,
    path: PathBuf,
}

impl Lock {
    /// Locks a file, which a link may lead to and which need not exist; `None` if the system or the disk has no locks.
    ///
    /// # Errors
    /// Another process has locked it.
    pub(super) fn take(path: &Path) -> io::Result<Option<Self>> {
        let mut name = OsString::from(fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()));
        name.push(".lock");
        let path = PathBuf::from(name);
        for _ in 0..ATTEMPTS {
            match open(&path) {
                Ok(file) if is_at(&file, &path) => return Ok(Some(Lock { file, path })),
                // The process that held it has removed it meanwhile.
                Ok(_) => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    let what = "is in use by another process";
                    return Err(io::Error::new(ErrorKind::ResourceBusy, what));
                }
                Err(_) => return Ok(None),
            }
        }
        Ok(None)
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Windows removes it as it closes it.
        if cfg!(unix) && is_at(&self.file, &self.path) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Opens and locks a file; [`ErrorKind::WouldBlock`] if another process has locked it.
#[cfg(any(target_os = "linux", target_os = "macos"))]
#[allow(
    unsafe_code,
    reason = "the lock of the standard library came with Rust 1.89"
)]
fn open(path: &Path) -> io::Result<File> {
    use std::ffi::c_int;
    use std::os::fd::AsRawFd;

    const LOCK_EX: c_int = 2;
    const LOCK_NB: c_int = 4;

    unsafe extern "C" {
        fn flock(file: c_int, operation: c_int) -> c_int;
    }

    let mut options = File::options();
    options.read(true).write(true).create(true).truncate(false);
    let file = options.open(path)?;
    // SAFETY: the file is open, and flock takes no pointers.
    match unsafe { flock(file.as_raw_fd(), LOCK_EX | LOCK_NB) } {
        0 => Ok(file),
        _ => Err(io::Error::last_os_error()),
    }
}

/// Opens a file that no one else can open meanwhile; [`ErrorKind::WouldBlock`] if another process has it open.
#[cfg(windows)]
fn open(path: &Path) -> io::Result<File> {
    use std::os::windows::fs::OpenOptionsExt;

    const FILE_FLAG_DELETE_ON_CLOSE: u32 = 0x0400_0000;
    const ERROR_SHARING_VIOLATION: i32 = 32;

    let mut options = File::options();
    options.write(true).create(true).truncate(false);
    options
        .share_mode(0)
        .custom_flags(FILE_FLAG_DELETE_ON_CLOSE);
    options
        .open(path)
        .map_err(|error| match error.raw_os_error() {
            Some(ERROR_SHARING_VIOLATION) => ErrorKind::WouldBlock.into(),
            _ => error,
        })
}

/// No other system locks files.
#[cfg(not(any(target_os = "linux", target_os = "macos", windows)))]
fn open(_: &Path) -> io::Result<File> {
    Err(ErrorKind::Unsupported.into())
}

/// Returns true if an open file has this path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;

    let identity = |found: fs::Metadata| (found.dev(), found.ino());
    let (own, there) = (file.metadata(), fs::metadata(path));
    own.map(identity).ok() == there.map(identity).ok()
}

/// Returns true if an open file has this path: so no one has removed it.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}
