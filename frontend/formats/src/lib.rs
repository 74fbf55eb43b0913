//! Readers and writers of instruction lists, list exports and vendor projects.
//!
//! Every reader returns a [`Program`] and the diagnostics about its source; it never gives up at the first mistake. No
//! reader knows what an instruction computes or which models have it. Start reading at [`read`], which detects the
//! format by content.

mod csv;
mod encoding;
mod foreign;
mod gx;
mod il;
pub mod image;
mod ladder_text;
mod learn;
mod learned;
mod listing;
mod plcopen;
pub mod print;
mod recognise;
mod search;
mod settings;
mod structured;
mod table;
mod text;
mod unsaved;

use rungc_syntax::{Diagnostic, Diagnostics, Program, Source, SourceKind, Span, codes, inputs};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

pub use csv::ExportHead;
pub use encoding_rs::Encoding;
pub use gx::sources::{self, Sources};
pub use gx::table::has_code;
pub use il::read_text;
pub use learn::{Lesson, Mismatch, learn};
pub use learned::{LearnError, LearnedCodes, Reading, Unproven};
pub use plcopen::{MOST_CONTACTS, Names, PLCOPEN_CPU, iec_timer_unit, read as read_plcopen};
pub use recognise::{Recognised, is_meant_as_toml, is_program, recognise};
pub use search::{is_project, programs, walk_error};
pub use settings::{not_settings, settings_file, settings_text};
pub use table::{MAX_TABLE, TableError, TableRow, read_table};
pub use unsaved::Unsaved;

/// A program and what its reader found.
#[derive(Clone, Debug, Default)]
pub struct Read {
    /// The readable part.
    pub program: Program,
    /// Findings in the source. After an error the program is incomplete and must not be compiled.
    pub diagnostics: Diagnostics,
    /// Instructions of a project whose codes nothing proves, in order.
    pub unproven: Vec<Unproven>,
    /// Head of a list export, if this is one; [`print::to_csv_with`] writes it again.
    pub export_head: Option<ExportHead>,
    /// Sources of a GX Works2 project whose directory can be read.
    pub sources: Option<Box<Sources>>,
}

/// Options of a reader.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// Codes of instructions that are known here, in addition to the built-in ones.
    pub learned: LearnedCodes,
    /// The encoding of all texts that are not UTF-16 by their format; `None`: the one that the project states or that
    /// the texts seem to have.
    pub encoding: Option<&'static Encoding>,
    /// Of a GX Works2 project, read the compiled program rather than its source.
    pub compiled: bool,
    /// State of a GX Works2 project of which the user says that its compiled program is as new as its source.
    pub compiled_state: Option<String>,
    /// Take a file of unknown format for an image of program memory.
    pub image: bool,
    /// The devices of variables of PLCopen XML.
    pub names: Names,
    /// Texts that an editor has not saved.
    pub unsaved: Unsaved,
    /// Files in structured text that are one program: each of them stands for all.
    pub parts: Vec<PathBuf>,
}

impl ReadOptions {
    /// The encoding of a project's texts, which it may state.
    fn encoding_of(&self, texts: &[&[u8]], stated: Option<&'static Encoding>) -> &'static Encoding {
        self.encoding
            .unwrap_or_else(|| encoding::of_texts(texts, stated))
    }

    /// The bytes of a file, or of what an editor has not saved of it.
    fn load(&self, path: &Path) -> Result<Vec<u8>, ReadError> {
        match self.unsaved.get(path) {
            Some(text) => Ok(text.as_bytes().to_vec()),
            None => load(path),
        }
    }
}

/// Files over this size are rejected, in bytes: a list of a million steps takes a tenth of it.
pub const MAX_SIZE: u64 = 128 << 20;

/// Reason why nothing could be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file or folder cannot be opened or read.
    #[error("cannot read `{path}`: {source}")]
    Io {
        /// Its path.
        path: String,
        /// The underlying I/O error.
        source: std::io::Error,
    },
    /// The file is larger than any program.
    #[error("`{name}` is larger than {} MiB", MAX_SIZE >> 20)]
    TooLarge {
        /// The file's name.
        name: String,
    },
    /// A folder that holds no program.
    #[error(
        "no program found in `{path}` (looked for `.il`, `.st`, list exports, GX Developer and GX Works2 projects, \
         PLCopen XML, `.pmw` and images)"
    )]
    NoProject {
        /// Its path.
        path: String,
    },
    /// A file that is not a program.
    #[error("`{name}` is {what}: {help}")]
    NoProgram {
        /// The file's name.
        name: String,
        /// Description of the file.
        what: &'static str,
        /// What to do.
        help: &'static str,
    },
    /// The content is in no known encoding or format.
    #[error(
        "`{name}` is neither text nor a known project file: name a project, or the instruction list as CSV or text"
    )]
    Undecodable {
        /// The file's name.
        name: String,
    },
}

/// Reads a program of any known format, found by its content: a list as text, a list export or program memory with the
/// device comments that lie beside it, a GX Developer project (its folder or its `MAIN.wpg`, with comments and
/// parameters), a GX Works2 project.
pub fn read(path: &Path) -> Result<Read, ReadError> {
    read_with(path, &ReadOptions::default())
}

/// As [`read`], with options.
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Read, ReadError> {
    // The head of a project of GX Developer stands for its folder.
    let folder = path.parent().filter(|_| is_head(path));
    let path = folder.unwrap_or(path);
    let path = match path.as_os_str().is_empty() {
        true => Path::new("."),
        false => path,
    };
    if let Some((name, files)) = of_several(path, options) {
        return structured::read_files(&name, &files, options);
    }
    let is_structured = path.is_file() && structured::is_named(&path.to_string_lossy());
    if let Some(joined) = is_structured
        .then(|| structured::program::of(path, options))
        .flatten()
    {
        let root = joined.files[0].file_name().unwrap_or_default();
        return structured::read_joined(&root.to_string_lossy(), &joined, options);
    }
    let inside = if path.is_dir() {
        Some(main_file(path)?)
    } else {
        None
    };
    let file = inside.as_deref().unwrap_or(path);
    let bytes = options.load(file)?;
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    check_kind(&name, &bytes, options)?;
    if gx::is_wpg(&bytes) || gx::is_cut_wpg(&name, &bytes) {
        let beside = beside(file)?;
        return Ok(gx::read_wpg(
            &project_name(file, path),
            &bytes,
            &beside,
            options,
        ));
    }
    let is_list = file
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("il") || e.eq_ignore_ascii_case("st"));
    let folder = file.parent().filter(|_| !is_list && !gx::is_ole(&bytes));
    let comments = folder.and_then(|folder| find(folder, &["COMMENT.csv"]));
    let of_comments = comments
        .as_deref()
        .and_then(|path| options.unsaved.encoding(path));
    let comments = comments.map(|path| options.load(&path)).transpose()?;
    let mut options = options.clone();
    if let (None, Some(comments)) = (options.encoding, &comments) {
        options.encoding = encoding::of_files(&[&bytes, comments]);
    }
    let of_comments = of_comments.or(options.encoding);
    options.encoding = options.unsaved.encoding(file).or(options.encoding);
    let mut read = read_bytes_with(&name, &bytes, &options)?;
    let takes_comments = matches!(read.program.kind, SourceKind::Csv | SourceKind::Image);
    if let (true, Some(comments)) = (takes_comments, &comments) {
        let text = encoding::decode(comments, of_comments);
        let (comments, unread) = match &text {
            Some((text, _)) => csv::comments(text),
            None => (BTreeMap::new(), vec![csv::not_comments()]),
        };
        read.program.comments = comments;
        read.diagnostics.extend(unread);
    }
    Ok(read)
}

/// The files of a program in structured text of several files, and its name: those of a folder, or those that the
/// options list with this one.
fn of_several(path: &Path, options: &ReadOptions) -> Option<(String, Vec<PathBuf>)> {
    let name = |path: &Path| {
        let name = path.file_name();
        name.map(|name| name.to_string_lossy().into_owned())
    };
    if path.is_dir() {
        let files = structured::files(path);
        let is_one = main_file(path).is_err() && !files.is_empty();
        let full = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        return is_one.then(|| (name(&full).unwrap_or_default(), files));
    }
    let full = path.canonicalize().ok()?;
    let mut parts = options.parts.iter();
    let is_listed = parts.any(|part| part.canonicalize().is_ok_and(|part| part == full));
    let first = options.parts.first().filter(|_| is_listed)?;
    Some((name(first)?, options.parts.clone()))
}

/// Reads a program of any known format that is one file, from a pipe for example. `name` is what diagnostics call it.
pub fn read_from(
    name: &str,
    source: impl io::Read,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    let bytes = limited(source).map_err(|source| ReadError::Io {
        path: name.to_owned(),
        source,
    })?;
    let bytes = bytes.ok_or_else(|| ReadError::TooLarge {
        name: name.to_owned(),
    })?;
    read_bytes_with(name, &bytes, options)
}

/// Returns true for `Gppw.gpj`, the file of a project of GX Developer that people open.
fn is_head(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    ending.eq_ignore_ascii_case("gpj") && path.is_file()
}

/// Files that accompany a `MAIN.wpg` in its project, or in one folder with it.
fn beside(main: &Path) -> Result<gx::Beside, ReadError> {
    let resource = main.ancestors().nth(3);
    let beside = |place: &[&str], name: &str| {
        let inside = resource.and_then(|folder| find(folder, place));
        let found = inside.or_else(|| find(main.parent()?, &[name]));
        found.map(|path| load(&path)).transpose()
    };
    Ok(gx::Beside {
        comments: beside(&["Others", "COMMENT.wcd"], "COMMENT.wcd")?,
        parameters: beside(&["param.wpa"], "param.wpa")?,
    })
}

/// The name of a GX Developer project: its folder's, of a `MAIN.wpg` that lies in none that of the file.
fn project_name(main: &Path, given: &Path) -> String {
    const INSIDE: [&str; 3] = ["Body", "POU", "Resource"];
    let name = |path: &Path| {
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
    };
    let full = main.canonicalize().unwrap_or_else(|_| main.to_owned());
    let is_inside = |folder: &&Path| {
        let name = name(folder).unwrap_or_default();
        INSIDE
            .iter()
            .any(|inside| name.eq_ignore_ascii_case(inside))
    };
    let mut folders = full.ancestors().skip(1).peekable();
    let lies_inside = folders.peek().is_some_and(&is_inside) || given.is_dir();
    let project = folders.find(|folder| !is_inside(folder)).and_then(name);
    let file = || name(main).unwrap_or_default();
    project.filter(|_| lies_inside).unwrap_or_else(file)
}

/// Reads the content of a file of any known format. `name` is what diagnostics call it.
pub fn read_bytes(name: &str, bytes: &[u8]) -> Result<Read, ReadError> {
    read_bytes_with(name, bytes, &ReadOptions::default())
}

/// As [`read_bytes`], with options.
pub fn read_bytes_with(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Read, ReadError> {
    if bytes.len() as u64 > MAX_SIZE {
        return Err(ReadError::TooLarge {
            name: name.to_owned(),
        });
    }
    check_kind(name, bytes, options)?;
    if gx::is_ole(bytes) {
        return Ok(gx::read_gxw(name, bytes, options));
    }
    if gx::is_wpg(bytes) || gx::is_cut_wpg(name, bytes) {
        return Ok(gx::read_wpg(name, bytes, &gx::Beside::default(), options));
    }
    if image::is_image(bytes) || options.image {
        return Ok(image::read(name, bytes, options));
    }
    let Some((mut text, replaced)) = encoding::decode(bytes, options.encoding) else {
        return Err(ReadError::Undecodable {
            name: name.to_owned(),
        });
    };
    text.truncate(text.trim_end_matches(char::from(encoding::DOS_END)).len());
    let mut read = match csv::detect(&text) {
        _ if plcopen::is_project(&text) => plcopen::read(name, &text, &options.names),
        _ if structured::detect(name, &text) => structured::read(name, &text),
        Some(layout) => csv::read(name, &text, layout),
        None if ladder_text::detect(&text) => ladder_text::read(name, &text),
        None => read_text(name, &text),
    };
    if replaced {
        let is_utf8 = options.encoding.is_none() && encoding::is_damaged_utf8(bytes);
        let source = &read.program.source;
        let whole = Span::new(0, source.text.len() as u32);
        read.diagnostics.push(undecoded(source, whole, is_utf8));
    }
    if encoding::dos_end(bytes).is_some_and(|end| end.hides_instructions) {
        read.diagnostics.push(hidden(&read.program));
    }
    Ok(read)
}

/// Rejects a file that is recognised as something other than a program.
fn check_kind(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<(), ReadError> {
    let is_program = options.image || structured::is_named(name) && !bytes.is_empty();
    match recognise(name, bytes).filter(|_| !is_program) {
        Some(Recognised { what, help }) => Err(ReadError::NoProgram {
            name: name.to_owned(),
            what,
            help,
        }),
        None => Ok(()),
    }
}

/// Instructions follow the end of a text, among bytes that are not text.
fn hidden(program: &Program) -> Diagnostic {
    let end = program.source.text.trim_end().len() as u32;
    let error = codes::UNREADABLE_TEXT.at(
        Span::new(end, end),
        "this text continues after Ctrl-Z (1Ah)",
    );
    error
        .label("the text ends here, but instructions follow among other bytes")
        .help("delete the Ctrl-Z and the bytes below it, or copy the whole file again from where it comes")
}

/// Some characters of a text, or of a file in it, were bytes without a meaning in its encoding.
fn undecoded(source: &Source, file: Span, is_utf8: bool) -> Diagnostic {
    let text = source.slice(file);
    let at = text.find(char::REPLACEMENT_CHARACTER);
    let place = |at: usize| Span::new(file.start + at as u32, file.start + at as u32 + 3);
    let span = at.map_or(file, place);
    let is_cut_off = at.is_some_and(|at| at + 3 == text.trim_end().len());
    let (what, label, help) = if is_cut_off {
        (
            "this text is cut off in a character",
            "its end is missing from here on",
            "copy the whole file again from where it comes",
        )
    } else if is_utf8 {
        (
            "this text is UTF-8, but some of its bytes are not",
            "the first of them",
            "type the damaged text again, and save the file as UTF-8",
        )
    } else {
        (
            "this text has bytes that no known encoding can represent",
            "the first of them",
            "save the file as UTF-8, or name its encoding with `--encoding`",
        )
    };
    let error = codes::UNREADABLE_TEXT.at(span, what);
    error.label(label).help(help)
}

fn load(path: &Path) -> Result<Vec<u8>, ReadError> {
    let name = || path.display().to_string();
    let io = |source| ReadError::Io {
        path: name(),
        source,
    };
    inputs::open(path).map_err(io)?;
    let file = File::open(path).map_err(io)?;
    if file.metadata().map_err(io)?.len() > MAX_SIZE {
        return Err(ReadError::TooLarge { name: name() });
    }
    limited(file)
        .map_err(io)?
        .ok_or_else(|| ReadError::TooLarge { name: name() })
}

/// All that a source gives; `None` if that is more than a program can be. A pipe or a device has no size that could be
/// queried before, and may never end.
fn limited(source: impl io::Read) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    source.take(MAX_SIZE + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= MAX_SIZE).then_some(bytes))
}

/// Paths of the program in a GX Developer project, from its folder on.
const GX_DEVELOPER: [&[&str]; 4] = [
    &["Resource", "POU", "Body", "MAIN.wpg"],
    &["POU", "Body", "MAIN.wpg"],
    &["Body", "MAIN.wpg"],
    &["MAIN.wpg"],
];

/// The program in a project's folder.
fn main_file(folder: &Path) -> Result<PathBuf, ReadError> {
    let found = GX_DEVELOPER.iter().find_map(|place| find(folder, place));
    let found = found.or_else(|| find(folder, &["MAIN.csv"]));
    found.ok_or_else(|| ReadError::NoProject {
        path: folder.display().to_string(),
    })
}

/// The file that the names lead to from a folder on; projects spell their folders in both cases.
fn find(folder: &Path, names: &[&str]) -> Option<PathBuf> {
    let Some((name, rest)) = names.split_first() else {
        return Some(folder.to_owned());
    };
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let mut entries: Vec<_> = std::fs::read_dir(folder).ok()?.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    entries
        .into_iter()
        .filter(|e| e.file_name().eq_ignore_ascii_case(name))
        .find_map(|e| find(&e.path(), rest))
}
