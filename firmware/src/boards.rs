//! Descriptions of boards that come with rungc.

use crate::board::{self, Board, BoardError};
use rungc_syntax::{Source, inputs};
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
        None => load(name),
    }
}

/// What to do with a program in the place of a description.
const PROGRAM: &str = "name the board that it is to run on (`rungc boards` lists them)";

/// Reads a description. Sources that it names are looked for beside it.
fn load(path: &Path) -> Result<Board, BoardError> {
    let io = |error| BoardError::Io {
        path: path.to_path_buf(),
        error,
    };
    inputs::open(path).map_err(io)?;
    let text = rungc_frontend::settings_file(path, PROGRAM).map_err(io)?;
    let source = Source::new(path.display().to_string(), text);
    let folder = path.parent().unwrap_or(Path::new(""));
    let other = |why| io(std::io::Error::other(why));
    board::parse(&source, folder).map_err(|error| {
        rungc_frontend::not_settings(path, &source.text, PROGRAM).map_or(error, other)
    })
}
