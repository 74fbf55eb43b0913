//! Files that an assistant may read and write.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};

/// Endings of the files that may be written.
pub(crate) const WRITABLE: [&str; 4] = [".il", ".plctest.toml", ".machine.toml", "rungc.toml"];

/// Longest file that is written, in bytes.
const MAX_WRITTEN: usize = 1 << 20;

/// The folders of a server.
#[derive(Debug)]
pub(crate) struct Files {
    /// As named, and with links followed.
    roots: Vec<(PathBuf, PathBuf)>,
    write: Option<(PathBuf, PathBuf)>,
    /// What was written since the start, links followed.
    written: BTreeSet<PathBuf>,
}

impl Files {
    /// The folders that options name.
    ///
    /// # Errors
    /// One that does not exist.
    pub(crate) fn new(roots: &[PathBuf], write: Option<&Path>) -> io::Result<Self> {
        let named = |folder: &Path| {
            let real = folder.canonicalize();
            let real = real.and_then(|real| match real.is_dir() {
                true => Ok(real),
                false => Err(io::ErrorKind::NotADirectory.into()),
            });
            let why = |error: io::Error| {
                io::Error::new(error.kind(), format!("{}: {error}", folder.display()))
            };
            Ok::<_, io::Error>((folder.to_owned(), real.map_err(why)?))
        };
        let roots = roots
            .iter()
            .map(|root| named(root))
            .collect::<io::Result<Vec<_>>>()?;
        Ok(Files {
            roots,
            write: write.map(named).transpose()?,
            written: BTreeSet::new(),
        })
    }

    /// Returns true if files may be written.
    pub(crate) fn can_write(&self) -> bool {
        self.write.is_some()
    }

    /// The folder from which relative paths begin.
    fn base(&self) -> &Path {
        self.roots
            .first()
            .map_or(Path::new("."), |(named, _)| named)
    }

    /// The path of a file or folder in this process.
    ///
    /// # Errors
    /// One that is outside of the folders, links followed, or not there.
    pub(crate) fn find(&self, text: &str) -> Result<PathBuf, String> {
        let path = self.named(text)?;
        let real = path.canonicalize();
        // Whether there is a file outside is not said.
        let within = match &real {
            Ok(real) => self.holds(real),
            Err(_) => self.holds(&plain(&path)),
        };
        match real {
            _ if !within => Err(self.outside(text)),
            Ok(_) => Ok(path),
            Err(error) => Err(format!("cannot read `{text}`: {error}{}", self.near())),
        }
    }

    /// A path that may not be there yet, for the name of a text.
    ///
    /// # Errors
    /// One that is outside of the folders.
    pub(crate) fn future(&self, text: &str) -> Result<PathBuf, String> {
        let path = self.named(text)?;
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let real = folder.unwrap_or(Path::new(".")).canonicalize();
        match real {
            Ok(real) if self.holds(&real) => Ok(path),
            _ => Err(self.outside(text)),
        }
    }

    fn named(&self, text: &str) -> Result<PathBuf, String> {
        if text.is_empty() || text.contains('\0') {
            return Err("a path is the name of a file or folder, such as `press.il`".to_owned());
        }
        let base = self.base();
        Ok(match base == Path::new(".") {
            true => PathBuf::from(text),
            false => base.join(text),
        })
    }

    fn holds(&self, real: &Path) -> bool {
        let all = self.roots.iter().chain(&self.write);
        all.into_iter().any(|(_, root)| real.starts_with(root))
    }

    fn outside(&self, text: &str) -> String {
        let roots: Vec<_> = self
            .roots
            .iter()
            .map(|(named, _)| format!("`{}`", named.display()))
            .collect();
        format!(
            "`{}` is outside of what may be read here: {}; the user can start `rungc mcp` with another `--root`",
            crate::protocol::clipped(text),
            roots.join(", ")
        )
    }

    /// Programs and test files in the first folder, as the end of a message.
    fn near(&self) -> String {
        const MOST: usize = 8;
        const ENDINGS: [&str; 4] = [".il", ".gxw", ".plctest.toml", ".csv"];
        let entries = fs::read_dir(self.base()).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let is_known = |name: &String| ENDINGS.iter().any(|ending| name.ends_with(ending));
        let mut names: Vec<_> = names.filter(is_known).collect();
        names.sort();
        let count = names.len();
        names.truncate(MOST);
        let shown: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
        match (count, count.saturating_sub(MOST)) {
            (0, _) => String::new(),
            (_, 0) => format!("; files here: {}", shown.join(", ")),
            (_, more) => format!("; files here: {} and {more} more", shown.join(", ")),
        }
    }

    /// A path as an assistant names it.
    pub(crate) fn shown(&self, path: &Path) -> String {
        let short = path.strip_prefix(self.base()).unwrap_or(path);
        rungc::location::named(short)
    }

    /// Writes a program or a test file.
    ///
    /// # Errors
    /// A path outside of the folder for that, another kind of file, a file that is there already.
    pub(crate) fn write(
        &mut self,
        text: &str,
        content: &str,
        overwrite: bool,
    ) -> Result<PathBuf, String> {
        let Some((named, folder)) = self.write.clone() else {
            return Err(
                "this server writes no files; the user can start it with `--allow-write DIR`"
                    .to_owned(),
            );
        };
        if !WRITABLE.iter().any(|ending| text.ends_with(ending)) {
            return Err(format!(
                "`{text}`: only files with these endings are written: {}",
                WRITABLE.join(", ")
            ));
        }
        if content.len() > MAX_WRITTEN {
            return Err(format!(
                "at most {} KiB are written to a file",
                MAX_WRITTEN >> 10
            ));
        }
        let path = match Path::new(text).is_absolute() {
            true => PathBuf::from(text),
            false => named.join(text),
        };
        let parent = path.parent().map(Path::canonicalize);
        let name = path.file_name().filter(|_| !text.contains('\0'));
        let real = match (parent, name) {
            (Some(Ok(parent)), Some(name)) if parent.starts_with(&folder) => parent.join(name),
            _ => {
                let folder = named.display();
                return Err(format!(
                    "`{text}` is not in a folder in which files may be written: `{folder}`"
                ));
            }
        };
        let put = self.put(&real, content, overwrite);
        put.map_err(|error| format!("cannot write `{text}`: {error}"))?;
        Ok(path)
    }

    fn put(&mut self, real: &Path, content: &str, overwrite: bool) -> Result<(), String> {
        let failed = |error: io::Error| error.to_string();
        if fs::symlink_metadata(real).is_err() {
            let file = OpenOptions::new().write(true).create_new(true).open(real);
            self.written.insert(real.to_owned());
            return file
                .and_then(|mut file| file.write_all(content.as_bytes()))
                .map_err(failed);
        }
        let is_link = fs::symlink_metadata(real).is_ok_and(|data| data.is_symlink());
        match (self.written.contains(real), overwrite) {
            _ if is_link => Err("it is a link".to_owned()),
            (false, _) => Err("it was there before; choose another name".to_owned()),
            (true, false) => {
                Err("you have written it before; add `overwrite: true` to replace it".to_owned())
            }
            (true, true) => {
                let file = File::create(real);
                file.and_then(|mut file| file.write_all(content.as_bytes()))
                    .map_err(failed)
            }
        }
    }
}

/// An absolute path without `.` and `..`, links not followed.
fn plain(path: &Path) -> PathBuf {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = absolute.parent().map(Path::canonicalize);
    if let (Some(Ok(folder)), Some(name)) = (folder, absolute.file_name()) {
        return folder.join(name);
    }
    let mut plain = PathBuf::new();
    for part in absolute.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::Files;
    use std::fs;
    use std::path::Path;

    #[test]
    fn nothing_outside_is_read_or_named() {
        let outside = tempfile::tempdir().unwrap();
        fs::write(outside.path().join("secret.il"), "LD X0\nEND\n").unwrap();
        let root = tempfile::tempdir().unwrap();
        fs::create_dir(root.path().join("deep")).unwrap();
        fs::write(root.path().join("a.il"), "LD X0\nEND\n").unwrap();
        let files = Files::new(&[root.path().to_owned()], None).unwrap();
        assert!(files.find("a.il").is_ok());
        assert!(files.find("deep/../a.il").is_ok());
        let secret = outside.path().join("secret.il").display().to_string();
        let missing = outside.path().join("nothing.il").display().to_string();
        for path in [
            &secret,
            &missing,
            "../x.il",
            "deep/../../x.il",
            "/etc/passwd",
            "no/../../../etc/passwd",
        ] {
            let why = files.find(path).unwrap_err();
            assert!(why.contains("outside of what may be read"), "{path}: {why}");
        }
        assert!(
            files
                .find("b.il")
                .unwrap_err()
                .contains("files here: `a.il`")
        );
        assert!(files.find("").is_err() && files.find("a\0").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_that_lead_outside_are_not_followed() {
        let outside = tempfile::tempdir().unwrap();
        fs::write(outside.path().join("secret.il"), "LD X0\nEND\n").unwrap();
        let root = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(outside.path(), root.path().join("link")).unwrap();
        std::os::unix::fs::symlink(outside.path().join("secret.il"), root.path().join("b.il"))
            .unwrap();
        let mut files = Files::new(&[root.path().to_owned()], Some(root.path())).unwrap();
        for path in ["link/secret.il", "link", "b.il"] {
            assert!(files.find(path).is_err(), "{path}");
        }
        for path in ["link/new.il", "b.il"] {
            assert!(files.write(path, "", true).is_err(), "{path}");
        }
        assert_eq!(
            fs::read_to_string(outside.path().join("secret.il")).unwrap(),
            "LD X0\nEND\n"
        );
    }

    #[test]
    fn only_files_of_this_session_are_replaced() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("old.il"), "END\n").unwrap();
        let mut files = Files::new(&[root.path().to_owned()], Some(root.path())).unwrap();
        let mut write = |path: &str, overwrite| files.write(path, "LD X0\nEND\n", overwrite);
        assert!(
            write("old.il", true)
                .unwrap_err()
                .contains("was there before")
        );
        assert!(write("new.il", false).is_ok());
        assert!(write("new.il", false).unwrap_err().contains("overwrite"));
        assert!(write("new.il", true).is_ok());
        for wrong in ["../new.il", "a.sh", "no/a.il", "/tmp/a.il", "", "a\0.il"] {
            assert!(write(wrong, false).is_err(), "{wrong}");
        }
        assert!(!Path::new("/tmp/a.il").exists());
        let mut closed = Files::new(&[root.path().to_owned()], None).unwrap();
        assert!(
            closed
                .write("b.il", "", false)
                .unwrap_err()
                .contains("--allow-write")
        );
    }
}
