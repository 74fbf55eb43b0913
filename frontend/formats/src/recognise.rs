//! Files that are not programs: what each is, by its content, and what to do with it.

mod texts;

use crate::{csv, encoding, gx, il, image, ladder_text, plcopen, structured};

/// A file that is not a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Recognised {
    /// Description of the file: `a ZIP archive`.
    pub what: &'static str,
    /// What to do.
    pub help: &'static str,
}

/// Export of the list, for files that editors write in their own formats.
const EXPORT: &str = "open it in its editor, and export the program as a list (CSV) or save its instruction list as text";
const PICTURE: &str = "a program is read from the editor's project or list export; `rungc convert --to il` takes ladders drawn in characters";
const DOCUMENT: &str = "save the instruction list in it as plain text";
const UNPACK: &str = "unpack it, and name the project or list in it";
const PROJECT: &str =
    "name the folder of the project: the program in it is read with its comments and parameters";
const SOURCE: &str = "rungc compiles programs of PLCs; for the code that it emits, name the program that it was made of";
const UNICODE: &str = "save it as UTF-8";
const RESULT: &str = "name the program that it was made of";

/// Beginnings of binary files.
const MAGIC: [(&[u8], Recognised); 24] = {
    const fn is(what: &'static str, help: &'static str) -> Recognised {
        Recognised { what, help }
    }
    [
        (
            b"AutoShop",
            is(
                "a project of AutoShop, whose format is not published",
                "copy the program's instruction list from the editor into a text file",
            ),
        ),
        (b"\x89PNG", is("a picture (PNG)", PICTURE)),
        (b"\xFF\xD8\xFF", is("a picture (JPEG)", PICTURE)),
        (b"GIF8", is("a picture (GIF)", PICTURE)),
        (b"RIFF", is("a picture or a recording (RIFF)", PICTURE)),
        (b"II*\0", is("a picture (TIFF)", PICTURE)),
        (b"MM\0*", is("a picture (TIFF)", PICTURE)),
        (b"%PDF-", is("a document (PDF)", DOCUMENT)),
        (b"{\\rtf", is("a document (RTF)", DOCUMENT)),
        (b"PK\x05\x06", is("an empty ZIP archive", UNPACK)),
        (b"\x1F\x8B", is("an archive (gzip)", UNPACK)),
        (b"7z\xBC\xAF\x27\x1C", is("an archive (7z)", UNPACK)),
        (b"Rar!", is("an archive (RAR)", UNPACK)),
        (b"BZh", is("an archive (bzip2)", UNPACK)),
        (b"\xFD7zXZ", is("an archive (xz)", UNPACK)),
        (b"\x7FELF", is("an executable or an image (ELF)", RESULT)),
        (b"MZ", is("a program of Windows", SOURCE)),
        (b"UF2\n", is("an image (UF2)", RESULT)),
        (b"SQLite format 3", is("a database (SQLite)", EXPORT)),
        (
            b"RGR1",
            is(
                "a record of latched devices",
                "`rungc run --retain` reads it",
            ),
        ),
        (b"\xFF\xFE\0\0", is("a text in UTF-32", UNICODE)),
        (b"\0\0\xFE\xFF", is("a text in UTF-32", UNICODE)),
        (b"aig ", is("a model for a model checker (AIGER)", RESULT)),
        (
            b"\x0A\x0D\x0D\x0A",
            is("a capture of frames (pcapng)", "open it in Wireshark"),
        ),
    ]
};

/// Mark of an archive (tar) and its place.
const TAR: (usize, &[u8]) = (257, b"ustar");

/// Endings of files with their own content. Only binary content goes by its name.
const ENDINGS: [(&str, &str, &str); 13] = [
    (
        "gx3",
        "a project of GX Works3, which is for CPUs of iQ-R and iQ-F (FX5)",
        "rungc compiles programs of FX1S to FX3U and of compatible PLCs",
    ),
    (
        "hcp",
        "a project of AutoShop, whose format is not published",
        "copy the program's instruction list from the editor into a text file",
    ),
    (
        "cow",
        "the comments of a program of FXGP/WIN, whose format is not published",
        "export the comments as a table with the columns device and comment, as `COMMENT.csv` beside the program",
    ),
    (
        "dmw",
        "the device memory of a program of FXGP/WIN",
        "the program is in the file of the same name that ends in `.PMW`",
    ),
    ("gps", "a project of GX Simulator", EXPORT),
    ("gpj", "the head of a project of GX Developer", PROJECT),
    ("wcd", "the comments of a project of GX Developer", PROJECT),
    (
        "wpa",
        "the parameters of a project of GX Developer",
        PROJECT,
    ),
    (
        "wdm",
        "the device memory of a project of GX Developer",
        PROJECT,
    ),
    ("bmp", "a picture (BMP)", PICTURE),
    ("ico", "a picture (ICO)", PICTURE),
    ("tar", "an archive (tar)", UNPACK),
    (
        "lnk",
        "a shortcut of Windows",
        "name the file that it leads to",
    ),
];

/// Parts of compound files and archives that show whose they are.
const PARTS: [(&str, Recognised); 8] = [
    (
        "word/document.xml",
        Recognised {
            what: "a document (DOCX)",
            help: DOCUMENT,
        },
    ),
    (
        "xl/workbook.xml",
        Recognised {
            what: "a table (XLSX)",
            help: "save the sheet with the list as CSV",
        },
    ),
    (
        "ppt/presentation.xml",
        Recognised {
            what: "a presentation (PPTX)",
            help: DOCUMENT,
        },
    ),
    (
        "application/vnd.oasis.opendocument",
        Recognised {
            what: "a document (OpenDocument)",
            help: DOCUMENT,
        },
    ),
    (
        "WordDocument",
        Recognised {
            what: "a document (DOC)",
            help: DOCUMENT,
        },
    ),
    (
        "Workbook",
        Recognised {
            what: "a table (XLS)",
            help: "save the sheet with the list as CSV",
        },
    ),
    (
        "PowerPoint Document",
        Recognised {
            what: "a presentation (PPT)",
            help: DOCUMENT,
        },
    ),
    (
        "META-INF/MANIFEST.MF",
        Recognised {
            what: "a Java archive",
            help: UNPACK,
        },
    ),
];

/// Recognises a file that is not a program; `None` for one that may be a program.
pub fn recognise(name: &str, bytes: &[u8]) -> Option<Recognised> {
    let ending = name
        .rsplit_once('.')
        .map(|(_, ending)| ending.to_ascii_lowercase());
    let of_name = |ending: &str| {
        ENDINGS
            .iter()
            .find(|row| row.0 == ending)
            .map(|row| Recognised {
                what: row.1,
                help: row.2,
            })
    };
    let by_name = ending.as_deref().and_then(of_name);
    if let Some(nothing) = without_content(ending.as_deref(), bytes) {
        return Some(nothing);
    }
    if bytes.starts_with(b"PK\x03\x04") {
        let zip = Recognised {
            what: "a ZIP archive",
            help: UNPACK,
        };
        return by_name.or_else(|| part(bytes)).or(Some(zip));
    }
    if gx::is_ole(bytes) {
        let other = part(
            &bytes
                .iter()
                .copied()
                .filter(|&byte| byte != 0)
                .collect::<Vec<_>>(),
        );
        return by_name.or(other);
    }
    if gx::is_wpg(bytes) || image::is_image(bytes) {
        return by_name;
    }
    if let Some((_, known)) = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return Some(*known);
    }
    if bytes
        .get(TAR.0..)
        .is_some_and(|rest| rest.starts_with(TAR.1))
    {
        return Some(Recognised {
            what: "an archive (tar)",
            help: UNPACK,
        });
    }
    let is_marked = bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF");
    if bytes.contains(&0) && !is_marked && by_name.is_some() {
        return by_name;
    }
    match encoding::decode(head(bytes), None) {
        Some((text, _)) => of_text(name, &text),
        None => by_name,
    }
}

/// A file that was not written whole, or was erased.
fn without_content(ending: Option<&str>, bytes: &[u8]) -> Option<Recognised> {
    /// Endings of lists; one without lines is an empty program.
    const LISTS: [&str; 4] = ["il", "txt", "csv", "lst"];
    let is = |what, help| Some(Recognised { what, help });
    if bytes.is_empty() && ending.is_some_and(|ending| !LISTS.contains(&ending)) {
        return is(
            "an empty file",
            "copy it again; it has no content, whatever its name says",
        );
    }
    if bytes.len() >= 16 && bytes.iter().all(|&byte| byte == 0) {
        return is(
            "a file of zeros, which was not written whole",
            "copy it again, from where it is undamaged",
        );
    }
    if bytes.len() >= 16 && bytes.iter().all(|&byte| byte == 0xFF) {
        return is(
            "erased memory: every byte is FFh",
            "read the program from the PLC or its memory cassette again",
        );
    }
    None
}

/// The first lines of a text, as far as they decide. In UTF-16 a line feed has a zero beside it.
fn head(bytes: &[u8]) -> &[u8] {
    let Some(head) = bytes.get(..HEAD) else {
        return bytes;
    };
    let last = head.iter().rposition(|&byte| byte == b'\n');
    let end = last.map_or(HEAD, |last| {
        last + 1 + usize::from(head.get(last + 1) == Some(&0))
    });
    head.get(..end).unwrap_or(head)
}

/// The part of an archive or a compound file that shows whose it is.
fn part(bytes: &[u8]) -> Option<Recognised> {
    let has = |part: &str| memchr::memmem::find(bytes, part.as_bytes()).is_some();
    PARTS
        .iter()
        .find(|(part, _)| has(part))
        .map(|(_, known)| *known)
}

/// Size of the part of a text that decides, in bytes.
const HEAD: usize = 64 << 10;

/// Number of lines of a text that decide.
const LINES: usize = 60;

/// A text that is not a program.
fn of_text(name: &str, text: &str) -> Option<Recognised> {
    let is = |what, help| Some(Recognised { what, help });
    let text = text.trim_start_matches('\u{FEFF}');
    let lines = || {
        text.lines()
            .map(str::trim)
            .filter(|line| !line.is_empty())
            .take(LINES)
    };
    let first = lines().next()?;
    let starts =
        |words: &[&str]| lines().any(|line| words.iter().any(|word| line.starts_with(word)));
    let lower = first.to_ascii_lowercase();
    if lower.starts_with("<!doctype html") || lower.starts_with("<html") {
        return is("a page (HTML)", RESULT);
    }
    if lower.starts_with("<svg") || lower.starts_with("<?xml") && text.contains("<svg") {
        return is("a picture (SVG)", PICTURE);
    }
    if first == "[Pass]" && text.contains("[Version]") {
        return is("the head of a project of GX Developer", PROJECT);
    }
    if first.starts_with("$version")
        || first.starts_with("$date")
        || first.starts_with("$timescale")
    {
        return is(
            "a recording of signals (VCD)",
            "open it in a waveform viewer such as GTKWave",
        );
    }
    let all: Vec<&str> = lines().collect();
    if let Some(known) = of_toml(&all).or_else(|| texts::spoilt(&all)) {
        return Some(known);
    }
    if lines().any(is_instruction) {
        return None;
    }
    if (first.starts_with('{') || first == "[") && text.contains('"') {
        return is("JSON", RESULT);
    }
    if starts(&[
        "#include",
        "#define ",
        "#pragma ",
        "#ifndef ",
        "int main(",
        "void ",
    ]) {
        return is("source code in C", SOURCE);
    }
    let is_rust = [
        "fn main",
        "#![",
        "use std::",
        "use super::",
        "use crate::",
        "pub fn ",
        "impl ",
        "//! ",
    ];
    if starts(&is_rust) {
        return is("source code in Rust", SOURCE);
    }
    if first.starts_with("#!") || starts(&["import ", "def ", "from __future__"]) {
        return is("a script", SOURCE);
    }
    if let Some(known) = texts::other(name, text, &all) {
        return Some(known);
    }
    if csv::is_comments(text) {
        return is(
            "a table of device comments",
            "name the program: comments are read from `COMMENT.csv` beside it",
        );
    }
    None
}

/// Returns true if a text is meant as one of rungc's files in TOML, whatever mistakes it has.
pub fn is_meant_as_toml(text: &str) -> bool {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    of_toml(&lines.collect::<Vec<_>>()).is_some()
}

/// A file of rungc in TOML, by its tables and keys.
fn of_toml(lines: &[&str]) -> Option<Recognised> {
    let is = |what, help| Some(Recognised { what, help });
    let table = |name: &str| {
        lines.iter().any(|line| {
            line.strip_prefix(name)
                .is_some_and(|rest| rest.starts_with([']', '.']))
        })
    };
    let key = |name: &str| {
        let value = |line: &&str| {
            line.strip_prefix(name)?
                .trim_start()
                .strip_prefix('=')
                .map(|_| ())
        };
        lines.iter().find_map(value).is_some()
    };
    let code = lines.iter().find(|line| !line.starts_with('#'))?;
    let is_toml = code.starts_with('[') && code.ends_with(']')
        || code.contains('=') && !code.starts_with(';');
    if !is_toml {
        None
    } else if table("[[case") || key("topic") {
        is("a test file", "run it with `rungc test`")
    } else if table("[fleet") || table("[plc") {
        is("a description of a fleet", "run it with `rungc fleet`")
    } else if ["[pins", "[analog", "[[serial", "[functions"]
        .into_iter()
        .any(table)
        || key("chip")
    {
        is("a description of a board", "name it with `--board`")
    } else if ["[[axis", "[[cylinder", "[[process", "[[delay", "[[sensor"]
        .into_iter()
        .any(table)
    {
        is("a description of a machine", "name it with `--machine`")
    } else if [
        "[project",
        "[check",
        "[build",
        "[test",
        "[serve",
        "[io",
        "[retain",
        "[[module",
        "[[property",
    ]
    .into_iter()
    .any(table)
    {
        is(
            "the settings of a project",
            "name its program; the settings are found by themselves, or with `--project`",
        )
    } else {
        None
    }
}

/// Returns true for a program: a project, an image, or a text that has instructions of one.
pub fn is_program(bytes: &[u8]) -> bool {
    if gx::is_ole(bytes) || gx::is_wpg(bytes) || image::is_image(bytes) {
        return true;
    }
    let Some((text, _)) = encoding::decode(bytes, None) else {
        return false;
    };
    let is_list = of_text("", &text).is_none() && text.lines().any(is_instruction);
    is_list
        || structured::detect("", &text)
        || plcopen::is_project(&text)
        || csv::detect(&text).is_some()
        || ladder_text::detect(&text)
}

/// Returns true for a line that begins with an instruction that every program has some of, after its step number.
fn is_instruction(line: &str) -> bool {
    let mut words = line.split_whitespace();
    // As the grammar reads steps: `12`, `12:`, `12.`, `12)`.
    let is_step = |word: &str| {
        let digits = word.strip_suffix([':', '.', ')']).unwrap_or(word);
        digits.parse::<u32>().is_ok()
    };
    words.find(|word| !is_step(word)).is_some_and(il::is_basic)
}
