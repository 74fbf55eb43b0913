//! Executables that are controlled over pipes, in bytes.

use std::ffi::OsStr;
use std::io::{self, BufReader, BufWriter};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// An executable that runs. It is killed when this is dropped.
pub struct Piped {
    child: Child,
    /// Its standard input.
    pub requests: BufWriter<ChildStdin>,
    /// Its standard output.
    pub answers: BufReader<ChildStdout>,
}

impl Piped {
    /// Starts an executable. An interruption from the keyboard does not reach it.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn start(executable: &Path, arguments: &[&OsStr]) -> io::Result<Self> {
        let mut command = Command::new(executable);
        command
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
            return Err(io::Error::other("no pipes"));
        };
        Ok(Piped {
            child,
            requests: BufWriter::new(stdin),
            answers: BufReader::new(stdout),
        })
    }

    /// The number of its process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Ends it after an error in a conversation; how it ended.
    pub fn ended(&mut self, error: &io::Error) -> String {
        // It has ended, or it does not answer as it should.
        let _ = self.child.kill();
        match self.child.wait() {
            Ok(status) => format!("{status} ({error})"),
            Err(error) => error.to_string(),
        }
    }
}

impl Drop for Piped {
    fn drop(&mut self) {
        // A child that has failed is gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
