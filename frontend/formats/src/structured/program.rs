//! The files of a folder that are one program with a file: those that define what it uses.

use super::contents::Contents;
use crate::{ReadOptions, encoding};
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Diagnostic, Phrase, Source, Span, phrase};
use std::path::{Path, PathBuf};
use walkdir::{DirEntry, WalkDir};

/// The settings of a project.
const SETTINGS: &str = "rungc.toml";

/// What to do if other files are meant.
fn list_them() -> Phrase {
    phrase!(
        "if other files are meant, list them in rungc.toml: `[project] program = [\"Main.st\", \"Valves.st\"]`"
    )
}

/// Files that are one program, the root first, then by their paths.
pub(crate) struct Joined {
    pub files: Vec<PathBuf>,
    notes: Vec<Note>,
}

/// What is said about the files.
struct Note {
    code: &'static Code,
    /// Position of the file that it is about.
    file: usize,
    /// Place in this file.
    span: Span,
    message: Phrase,
    label: Phrase,
    help: Phrase,
}

impl Joined {
    /// The notes, with their places in the text of all files.
    pub(super) fn notes(&self, source: &Source) -> Vec<Diagnostic> {
        let files = source.spans();
        let notes = self.notes.iter().map(|note| {
            // The file may have changed since.
            let file = files[note.file];
            let place = |at: u32| file.end.min(file.start + at);
            let span = Span::new(place(note.span.start), place(note.span.end));
            let found = note.code.at(span, note.message.clone());
            found.label(note.label.clone()).help(note.help.clone())
        });
        notes.collect()
    }
}

/// A file of a folder.
struct File {
    path: PathBuf,
    /// The same without links, for comparisons.
    full: PathBuf,
    text: String,
    contents: Contents,
}

/// A program that is found from its root on.
#[derive(Default)]
struct Program {
    /// Positions of its files, in the order in which they were found.
    files: Vec<usize>,
    /// First use of a name that another file defines.
    first: Option<Use>,
    /// Names that only files with other programs define.
    left_out: Vec<Use>,
}

/// Use of a name in one file that another one defines.
#[derive(Clone, Copy)]
struct Use {
    from: usize,
    span: Span,
    to: usize,
}

/// The program of a file of structured text, if other files of its folder belong to it.
pub(crate) fn of(path: &Path, options: &ReadOptions) -> Option<Joined> {
    let own = File::of(path, options)?;
    let folder = own.full.parent()?.to_owned();
    let paths = near(path.parent()?);
    let others = paths.filter_map(|path| File::of(&path, options));
    let others = others.filter(|other| other.full != own.full);
    let mut files: Vec<File> = others.collect();
    let is_root = !own.contents.programs.is_empty() || own.contents.has_tasks;
    files.push(own);
    files.sort_by(|a, b| a.full.cmp(&b.full));
    let given = files.iter().position(|file| file.path == path)?;
    let folder = Folder {
        path: folder,
        files,
    };
    if is_root {
        let program = folder.program(given);
        let is_alone = program.files.len() == 1 && program.left_out.is_empty();
        return (!is_alone).then(|| folder.joined(&program, given));
    }
    let roots = (0..folder.files.len()).filter(|&at| folder.is_beside(at));
    let roots = roots.filter(|&at| !folder.files[at].contents.programs.is_empty());
    let mut programs = roots.map(|root| folder.program(root));
    let program = programs.find(|program| program.files.contains(&given))?;
    Some(folder.joined(&program, given))
}

/// The files of structured text in a folder and a few levels below. Folders of other projects are left out.
fn near(folder: &Path) -> impl Iterator<Item = PathBuf> {
    /// Levels of folders.
    const DEEPEST: usize = 3;
    /// Number of files and folders: a home folder may hold any number.
    const MOST: usize = 10_000;
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let is_meant = |entry: &DirEntry| {
        let is_other =
            || crate::search::is_left_out(entry) || entry.path().join(SETTINGS).is_file();
        entry.depth() == 0 || !entry.file_type().is_dir() || !is_other()
    };
    let entries = WalkDir::new(folder).max_depth(DEEPEST).sort_by_file_name();
    let entries = entries
        .into_iter()
        .filter_entry(is_meant)
        .take(MOST)
        .flatten();
    let files = entries.filter(|entry| entry.file_type().is_file());
    let files = files.map(DirEntry::into_path);
    files.filter(|path| super::is_named(&path.to_string_lossy()))
}

impl File {
    /// A file, if it is a text.
    fn of(path: &Path, options: &ReadOptions) -> Option<File> {
        let bytes = options.load(path).ok()?;
        let encoding = options.unsaved.encoding(path).or(options.encoding);
        let (text, _) = encoding::decode(&bytes, encoding)?;
        Some(File {
            path: path.to_owned(),
            full: path.canonicalize().ok()?,
            contents: Contents::of(&text),
            text,
        })
    }
}

/// The files of a folder.
struct Folder {
    path: PathBuf,
    files: Vec<File>,
}

impl Folder {
    /// Returns true for a file that is not in a folder below.
    fn is_beside(&self, at: usize) -> bool {
        self.files[at].full.parent() == Some(&self.path)
    }

    /// All files that are needed, from one on.
    fn program(&self, root: usize) -> Program {
        let mut program = Program {
            files: vec![root],
            ..Program::default()
        };
        // The tasks that run the root.
        let programs = &self.files[root].contents.programs;
        let tasks = (0..self.files.len()).filter(|&at| {
            at != root && self.is_beside(at) && !self.files[at].contents.runs.is_disjoint(programs)
        });
        program.files.extend(tasks);
        let mut done = 0;
        while let Some(&from) = program.files.get(done) {
            let of = &self.files[from].contents;
            for (to, other) in self.files.iter().enumerate() {
                if !of.runs.is_disjoint(&other.contents.programs) {
                    program.add(to);
                }
            }
            let mut used: Vec<(&str, Span)> = of
                .used
                .iter()
                .map(|(name, span)| (&**name, *span))
                .collect();
            used.sort_by_key(|(_, span)| *span);
            for (name, span) in used {
                self.add_definitions(&mut program, name, (from, span));
            }
            done += 1;
        }
        program
    }

    /// Adds the files that define a name.
    fn add_definitions(&self, program: &mut Program, name: &str, (from, span): (usize, Span)) {
        let all =
            (0..self.files.len()).filter(|&at| self.files[at].contents.defined.contains(name));
        let is_part =
            |at: &usize| self.files[*at].contents.programs.is_empty() || program.files.contains(at);
        let (meant, others): (Vec<usize>, Vec<usize>) = all.partition(is_part);
        match (meant.first(), others.first()) {
            (Some(&to), _) => {
                program.first.get_or_insert(Use { from, span, to });
            }
            (None, Some(&to)) => {
                program.left_out.push(Use { from, span, to });
            }
            (None, None) => {}
        }
        for at in meant {
            program.add(at);
        }
    }

    /// The files of a program in order, with what is said about them.
    fn joined(&self, program: &Program, given: usize) -> Joined {
        let root = program.files[0];
        let mut order = program.files.clone();
        order[1..].sort_unstable();
        let place = |at: usize| {
            order
                .iter()
                .position(|&file| file == at)
                .unwrap_or_default()
        };
        let mut notes = Vec::new();
        if root != given {
            let file = self.name(root);
            notes.push(Note {
                code: &codes::ST_FILES,
                file: place(given),
                span: Span::default(),
                message: phrase!(
                    "this file is compiled as a part of `{file}`, the first program that needs it",
                    file
                ),
                label: Phrase::default(),
                help: list_them(),
            });
        } else if order.len() > 1 {
            let names: Vec<String> = order[1..]
                .iter()
                .map(|&at| format!("`{}`", self.name(at)))
                .collect();
            let files = names.join(", ");
            let used = program.first;
            notes.push(Note {
                code: &codes::ST_FILES,
                file: used.map_or(0, |used| place(used.from)),
                span: used.map_or(Span::default(), |used| used.span),
                message: phrase!("this file is compiled with {files}", files),
                label: used.map_or_else(Phrase::default, |used| {
                    let file = self.name(used.to);
                    phrase!("`{file}` defines this", file)
                }),
                help: list_them(),
            });
        }
        for &used in &program.left_out {
            let (name, file) = (self.written(used), self.name(used.to));
            notes.push(Note {
                code: &codes::ST_LEFT_OUT,
                file: place(used.from),
                span: used.span,
                message: phrase!(
                    "`{name}` is defined in `{file}`, which has its own PROGRAM and is left out",
                    name,
                    file
                ),
                label: Phrase::default(),
                help: phrase!(
                    "move it to a file without PROGRAM, or list both files in rungc.toml"
                ),
            });
        }
        let files = order.iter().map(|&at| self.files[at].path.clone());
        Joined {
            files: files.collect(),
            notes,
        }
    }

    /// Path of a file as seen from the folder.
    fn name(&self, at: usize) -> String {
        let full = &self.files[at].full;
        let path = full.strip_prefix(&self.path).unwrap_or(full);
        path.to_string_lossy().replace('\\', "/")
    }

    /// The name of a use as it is written.
    fn written(&self, used: Use) -> &str {
        self.files[used.from]
            .text
            .get(used.span.range())
            .unwrap_or_default()
    }
}

impl Program {
    fn add(&mut self, at: usize) {
        if !self.files.contains(&at) {
            self.files.push(at);
        }
    }
}
