//! Cache of build results: a folder of the user's cache, which may be deleted at any time.

use etcetera::BaseStrategy;
use std::collections::HashSet;
use std::env;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::SystemTime;

/// Names the folder to use instead of `rungc` in the user's cache folder.
pub const VARIABLE: &str = "RUNGC_CACHE_DIR";

/// File by which a folder is locked.
const LOCK: &str = ".lock";

/// Maximum number of folders of one kind that are used at the same time.
const SLOTS: usize = 64;

/// The cache: what [`VARIABLE`] names, else `rungc` in the user's cache folder (`~/.cache` on Linux, `~/Library/Caches`
/// on macOS, `%LOCALAPPDATA%` on Windows). What is in it belongs to these sources: others have separate folders.
///
/// # Errors
/// There is no such folder, or it cannot be written.
pub fn folder() -> io::Result<PathBuf> {
    let folder = match env::var_os(VARIABLE).filter(|named| !named.is_empty()) {
        Some(named) => PathBuf::from(named),
        None => etcetera::choose_base_strategy()
            .map_err(|error| io::Error::new(io::ErrorKind::NotFound, error))?
            .cache_dir()
            .join("rungc"),
    };
    inside(&folder)
}

/// The cache of these sources in a folder.
fn inside(folder: &Path) -> io::Result<PathBuf> {
    let folder = std::path::absolute(folder)?.join(of_sources());
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// The version and a hash of the sources.
fn of_sources() -> &'static str {
    static NAME: OnceLock<String> = OnceLock::new();
    NAME.get_or_init(|| {
        let hash = hash(&crate::files(true));
        format!("{}-{hash:016x}", env!("CARGO_PKG_VERSION"))
    })
}

/// A number that distinguishes values, the same in each run.
pub fn hash(value: &impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

/// A folder of the cache that no other process uses as long as this is held. What is in it stays for the next one.
#[derive(Debug)]
pub struct Slot {
    path: PathBuf,
    _lock: File,
}

impl Slot {
    /// The first unused folder of a kind.
    ///
    /// # Errors
    /// The cache cannot be written, or all folders are in use.
    pub fn take(cache: &Path, kind: &str) -> io::Result<Slot> {
        for number in 0..SLOTS {
            let path = cache.join(kind).join(number.to_string());
            fs::create_dir_all(&path)?;
            let lock = lock_file(&path)?;
            match lock.try_lock() {
                Ok(()) => return Ok(Slot { path, _lock: lock }),
                Err(TryLockError::WouldBlock) => {}
                Err(TryLockError::Error(error)) => return Err(error),
            }
        }
        Err(io::Error::other("all of its folders are in use"))
    }

    /// This folder, once it is no longer in use.
    ///
    /// # Errors
    /// The cache cannot be written.
    pub fn wait(path: PathBuf) -> io::Result<Slot> {
        fs::create_dir_all(&path)?;
        let lock = lock_file(&path)?;
        lock.lock()?;
        Ok(Slot { path, _lock: lock })
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

fn lock_file(folder: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.create(true).truncate(false).write(true);
    options.open(folder.join(LOCK))
}

/// Writes a file unless it has this text already, so that build tools see only what changed.
///
/// # Errors
/// The file or its folder cannot be written.
pub fn write(path: &Path, text: &str) -> io::Result<()> {
    if fs::read_to_string(path).is_ok_and(|old| old == text) {
        return Ok(());
    }
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::write(path, text)
}

/// Gives a folder these files, by their paths in it, and no others in the folders that they lie in. Returns true if
/// one of them has changed.
///
/// # Errors
/// The files or their folders cannot be written.
pub fn write_all(folder: &Path, files: &[(String, String)]) -> io::Result<bool> {
    let paths: HashSet<PathBuf> = files.iter().map(|(path, _)| folder.join(path)).collect();
    let folders: HashSet<&Path> = paths.iter().filter_map(|path| path.parent()).collect();
    let mut changed = false;
    for inner in folders.into_iter().filter(|inner| inner.is_dir()) {
        for entry in fs::read_dir(inner)? {
            let path = entry?.path();
            if path.is_file() && !paths.contains(&path) && !path.ends_with(LOCK) {
                fs::remove_file(path)?;
                changed = true;
            }
        }
    }
    for (path, text) in files {
        let path = folder.join(path);
        changed |= !fs::read_to_string(&path).is_ok_and(|old| old == *text);
        write(&path, text)?;
    }
    Ok(changed)
}

/// Number of executables that a folder keeps.
const EXECUTABLES: usize = 8;

/// The executable that is made of what has this hash: one of the last eight that `build` made for this folder, or what
/// it makes now, which moves there.
///
/// # Errors
/// Those of `build`, and of a folder that cannot be written.
pub fn executable<E: From<io::Error>>(
    folder: &Path,
    hash: u64,
    build: impl FnOnce() -> Result<PathBuf, E>,
) -> Result<PathBuf, E> {
    let folder = folder.join("executables");
    let kept = folder.join(format!("{hash:016x}{}", env::consts::EXE_SUFFIX));
    if !kept.is_file() {
        let built = build()?;
        let built = match built.is_file() {
            true => built,
            false => built.with_extension(env::consts::EXE_EXTENSION),
        };
        fs::create_dir_all(&folder)?;
        fs::rename(built, &kept)?;
    }
    touch(&kept)?;
    let mut all = Vec::new();
    for entry in fs::read_dir(&folder)? {
        let entry = entry?;
        all.push((entry.metadata()?.modified()?, entry.path()));
    }
    all.sort();
    let more = all.len().saturating_sub(EXECUTABLES);
    all[..more]
        .iter()
        .try_for_each(|(_, path)| fs::remove_file(path))?;
    Ok(kept)
}

/// Gives a file the time of now, so that build tools compile it again.
///
/// # Errors
/// The file is not there, or cannot be written.
pub fn touch(path: &Path) -> io::Result<()> {
    let file = OpenOptions::new().append(true).open(path)?;
    file.set_modified(SystemTime::now())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_written_where_it_differs() {
        let folder = tempfile::tempdir().unwrap();
        let file = |path: &str, text: &str| (path.to_string(), text.to_string());
        let first = [
            file("a.rs", "a"),
            file("src/b.rs", "b"),
            file("src/c.rs", "c"),
        ];
        assert!(write_all(folder.path(), &first).unwrap());
        let kept = folder.path().join("target");
        fs::create_dir(&kept).unwrap();
        fs::write(kept.join("object"), "").unwrap();
        let long_ago = SystemTime::UNIX_EPOCH;
        let unchanged = folder.path().join("src/b.rs");
        let opened = OpenOptions::new().append(true).open(&unchanged).unwrap();
        opened.set_modified(long_ago).unwrap();
        assert!(!write_all(folder.path(), &first).unwrap());
        assert!(
            write_all(folder.path(), &first[..2]).unwrap(),
            "a file goes"
        );
        assert!(!folder.path().join("src/c.rs").exists());
        assert!(kept.join("object").exists());
        let modified = |path: &Path| path.metadata().unwrap().modified().unwrap();
        assert_eq!(modified(&unchanged), long_ago);
        touch(&unchanged).unwrap();
        assert!(modified(&unchanged) > long_ago);
    }

    #[test]
    fn executables_are_built_once() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("made");
        let mut builds = 0;
        let mut get = |hash: u64| {
            let kept = executable(folder.path(), hash, || {
                builds += 1;
                fs::write(&place, hash.to_string())?;
                Ok::<_, io::Error>(place.clone())
            });
            assert_eq!(fs::read_to_string(kept.unwrap()).unwrap(), hash.to_string());
            // The times of files need not be finer than this.
            std::thread::sleep(std::time::Duration::from_millis(20));
            builds
        };
        assert_eq!([get(0), get(1), get(0), get(1)], [1, 2, 2, 2]);
        for more in 2..9 {
            get(more);
        }
        // Used last of all before the others, and the first of them.
        assert_eq!(get(1), 9, "eight stay");
        assert_eq!(get(0), 10, "the one that was used least recently went");
        let failed = executable(folder.path(), 77, || Err(io::Error::other("no compiler")));
        assert!(failed.is_err());
    }

    #[test]
    fn two_users_never_share_a_folder() {
        let cache = tempfile::tempdir().unwrap();
        let first = Slot::take(cache.path(), "engines").unwrap();
        let second = Slot::take(cache.path(), "engines").unwrap();
        assert_ne!(first.path(), second.path());
        let path = first.path().to_owned();
        drop(first);
        let third = Slot::take(cache.path(), "engines").unwrap();
        assert_eq!(third.path(), path);
    }
}
