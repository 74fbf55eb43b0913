//! The table of a run on standard output.

use crate::commands::{Failure, eprint_line, stream_text};
use std::io;

/// Standard output.
pub struct Table {
    /// The reader has closed it.
    pub muted: bool,
    /// A run with other results continues then.
    optional: bool,
    /// A run that serves others continues whatever happens to it.
    serves: bool,
    /// It cannot be written, which was reported.
    fails: bool,
}

impl Table {
    /// That of a run with other results (`optional`), or that serves others.
    pub const fn new(muted: bool, optional: bool, serves: bool) -> Self {
        Table {
            muted,
            optional,
            serves,
            fails: false,
        }
    }

    /// Prints a line.
    ///
    /// # Errors
    /// It cannot be written, and the run is to end.
    pub fn line(&mut self, line: &str) -> Result<(), Failure> {
        if self.muted {
            return Ok(());
        }
        let written = stream_text(&format!("{line}\n"));
        if self.serves {
            self.report(written.err());
            return Ok(());
        }
        match written {
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
                self.muted = true;
                self.optional.then_some(()).ok_or(Failure::BrokenPipe)
            }
            result => Ok(result?),
        }
    }

    /// Reports once that standard output is full or closed, and that it is written again.
    fn report(&mut self, error: Option<io::Error>) {
        let fails = error.is_some();
        match error {
            Some(error) if !self.fails => {
                eprint_line(&format!("rungc: {error}; the run continues"));
            }
            None if self.fails => eprint_line("rungc: standard output is written again"),
            _ => {}
        }
        self.fails = fails;
    }
}
