//! The files of a package.

use crate::{Problem, root, rungc, tools};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A file of a package.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct File {
    /// Its contents.
    pub contents: Vec<u8>,
    /// True for a program.
    pub is_executable: bool,
}

impl File {
    /// Its permissions on Unix.
    pub fn mode(&self) -> u32 {
        match self.is_executable {
            true => 0o755,
            false => 0o644,
        }
    }
}

/// The files of a package by their paths in it.
#[derive(Default)]
pub struct Files(pub BTreeMap<String, File>);

/// Files of the repository that go with the executable.
const DOCUMENTS: [&str; 4] = ["CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT", "README.md"];

/// The shells with completions, and the files that these load by themselves.
const SHELLS: [(&str, &str); 5] = [
    ("bash", "rungc.bash"),
    ("elvish", "rungc.elv"),
    ("fish", "rungc.fish"),
    ("powershell", "rungc.ps1"),
    ("zsh", "_rungc"),
];

/// Files of Debian's packages where shells look for completions.
const DEBIAN: [(&str, &str); 3] = [
    ("bash", "usr/share/bash-completion/completions/rungc"),
    ("fish", "usr/share/fish/vendor_completions.d/rungc.fish"),
    ("zsh", "usr/share/zsh/vendor-completions/_rungc"),
];

impl Files {
    /// The licences and what one reads first.
    pub fn documents() -> Result<Files, Problem> {
        let mut files = Files::default();
        for name in DOCUMENTS {
            files.add(name, fs::read(root().join(name))?);
        }
        Ok(files)
    }

    /// Adds a file that is not a program.
    pub fn add(&mut self, path: &str, contents: Vec<u8>) {
        let file = File {
            contents,
            is_executable: false,
        };
        self.0.insert(path.to_owned(), file);
    }

    /// Adds a program.
    pub fn add_executable(&mut self, path: &str, from: &Path) -> Result<(), Problem> {
        let file = File {
            contents: fs::read(from)?,
            is_executable: true,
        };
        self.0.insert(path.to_owned(), file);
        Ok(())
    }

    /// Adds completions for all shells, in `completions/`.
    pub fn add_completions(&mut self, executable: &Path) -> Result<(), Problem> {
        let rungc = runnable(executable)?;
        for (shell, name) in SHELLS {
            let script = print(&rungc, &["completions", shell])?;
            self.add(&format!("completions/{name}"), script);
        }
        Ok(())
    }

    /// Adds completions where Debian's shells look for them.
    pub fn add_debian_completions(&mut self, executable: &Path) -> Result<(), Problem> {
        let rungc = runnable(executable)?;
        for (shell, path) in DEBIAN {
            self.add(path, print(&rungc, &["completions", shell])?);
        }
        Ok(())
    }

    /// Adds the manual pages of rungc and of its commands, in `man/man1/`.
    pub fn add_manual(&mut self, executable: &Path) -> Result<(), Problem> {
        let rungc = runnable(executable)?;
        self.add("man/man1/rungc.1", print(&rungc, &["man"])?);
        for name in rungc::command_names(&rungc)? {
            let page = print(&rungc, &["man", &name])?;
            self.add(&format!("man/man1/rungc-{name}.1"), page);
        }
        Ok(())
    }

    /// The same files in a folder.
    pub fn inside(self, folder: &str) -> Files {
        let files = self.0.into_iter();
        Files(
            files
                .map(|(path, file)| (format!("{folder}/{path}"), file))
                .collect(),
        )
    }
}

/// The executable, or where it is for another system one for this.
fn runnable(executable: &Path) -> Result<std::path::PathBuf, Problem> {
    let runs = Command::new(executable).arg("--version").output();
    match runs.is_ok_and(|output| output.status.success()) {
        true => Ok(executable.to_owned()),
        false => rungc::build(),
    }
}

/// Output of the command.
fn print(rungc: &Path, args: &[&str]) -> Result<Vec<u8>, Problem> {
    Ok(tools::output(Command::new(rungc).args(args))?.into_bytes())
}
