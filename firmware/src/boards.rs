//! Descriptions of boards that come with rungc.

use crate::board::{self, Board, BoardError};
use rungc_syntax::Source;
use std::path::Path;

/// The description of a board, by a name that stands for its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    /// The name.
    pub name: &'static str,
    /// The description, in TOML.
    pub text: &'static str,
}

/// The board with a file in `boards/`.
macro_rules! known {
    ($name:literal) => {
        Known {
            name: $name,
            text: include_str!(concat!("../boards/", $name, ".toml")),
        }
    };
}

/// All of them.
pub static ALL: [Known; 5] = [
    known!("fx3u-f103vc"),
    known!("fx1n-10mt-f103rc"),
    known!("fx1n-14-f103rb"),
    known!("fx2n-10mr-f030c8"),
    known!("pico"),
];

impl Known {
    /// Reads the description.
    ///
    /// # Errors
    /// None, as the tests of this crate show.
    pub fn board(&self) -> Result<Board, BoardError> {
        let source = Source::new(format!("{}.toml", self.name), self.text.to_string());
        board::parse(&source, Path::new(""))
    }
}

/// The board of this name.
pub fn find(name: &str) -> Option<&'static Known> {
    ALL.iter().find(|known| known.name == name)
}

/// The board of this name, or the one that a file describes.
///
/// # Errors
/// There is no such board or file, the file cannot be read, or its description is wrong.
pub fn named_or_described(name: &Path) -> Result<Board, BoardError> {
    match name.to_str().and_then(find) {
        Some(known) => known.board(),
        None if name.extension().is_none() && !name.exists() => Err(BoardError::Unknown {
            name: name.display().to_string(),
        }),
        None => board::load(name),
    }
}
