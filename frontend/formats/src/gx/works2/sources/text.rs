//! Sources as text, readable and fit for version control: a file for each POU, structure and table of global labels.

use super::declaration::{self, Chosen};
use super::networks::{self, comment};
use super::{Body, LadderLine, Pou, Sources};
use std::collections::BTreeSet;

/// A file made from sources.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SourceFile {
    /// Path in the folder that is written, with `/`.
    pub path: String,
    /// Contents.
    pub contents: Vec<u8>,
}

/// Files, none of which has the path of another in a file system that ignores case.
#[derive(Default)]
pub(super) struct Files {
    files: Vec<SourceFile>,
    used: BTreeSet<String>,
}

impl Files {
    /// Adds a file: `libraries/LIBRARY/FOLDER/NAME.ENDING`.
    pub fn add(
        &mut self,
        (library, folder, name): (&Option<String>, &str, &str),
        ending: &str,
        contents: Vec<u8>,
    ) {
        let library = library.as_deref().map(plain);
        let library = library.map(|library| format!("libraries/{library}/"));
        let place = format!("{}{folder}{}", library.unwrap_or_default(), plain(name));
        let numbers = (1..).map(|number| match number {
            1 => String::new(),
            number => format!("~{number}"),
        });
        let mut paths = numbers.map(|number| format!("{place}{number}.{ending}"));
        let free = paths.find(|path| self.used.insert(path.to_lowercase()));
        self.files
            .extend(free.map(|path| SourceFile { path, contents }));
    }

    /// All files, by their paths.
    pub fn sorted(mut self) -> Vec<SourceFile> {
        self.files.sort_by(|a, b| a.path.cmp(&b.path));
        self.files
    }
}

/// A name that every file system takes.
fn plain(name: &str) -> String {
    const RESERVED: &[char] = &['/', '\\', ':', '*', '?', '"', '<', '>', '|', '.'];
    let plain = |c: char| match c.is_control() || RESERVED.contains(&c) {
        true => '_',
        false => c,
    };
    match name.trim() {
        "" => "_".to_owned(),
        name if is_device(name) => format!("{name}_"),
        name => name.chars().map(plain).collect(),
    }
}

/// True for names that Windows keeps for its devices, whatever their ending.
fn is_device(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    let is_port = |name: &str| {
        let number = name.strip_prefix("COM").or(name.strip_prefix("LPT"));
        matches!(number.map(str::as_bytes), Some([b'0'..=b'9']))
    };
    matches!(name.as_str(), "CON" | "PRN" | "AUX" | "NUL") || is_port(&name)
}

impl Sources {
    /// Sources as text. Equal sources give equal files: they hold no times and none of what the compiler chose.
    pub fn to_st(&self) -> Vec<SourceFile> {
        let mut files = Files::default();
        for pou in &self.pous {
            let ending = match pou.body {
                Body::Text(_) => "st",
                _ => "txt",
            };
            let text = self.pou_text(pou);
            files.add((&pou.library, "", &pou.name), ending, text.into_bytes());
        }
        for table in self.globals.iter().filter(|table| !table.labels.is_empty()) {
            let text = declaration::sections(&table.labels, self, "", &Chosen::new());
            let place = (&table.library, "labels/", table.name.as_str());
            files.add(place, "st", text.into_bytes());
        }
        for one in &self.structures {
            let text = declaration::structure(one);
            let place = (&one.library, "structures/", one.name.as_str());
            files.add(place, "st", text.into_bytes());
        }
        if !self.tasks.is_empty() {
            let text = declaration::tasks(&self.tasks);
            files.add((&None, "", "tasks"), "st", text.into_bytes());
        }
        files.sorted()
    }

    /// All declarations as one text, with the devices that the compiler chose.
    pub fn to_labels(&self) -> String {
        let chosen = declaration::chosen(&self.devices());
        let structures = self.structures.iter().map(declaration::structure);
        let globals = self.globals.iter();
        let globals = globals.filter(|table| !table.labels.is_empty());
        let globals = globals.map(|table| {
            let sections = declaration::sections(&table.labels, self, "", &chosen);
            format!("{}\n{sections}", comment(&table.name))
        });
        let pous = self.pous.iter().map(|pou| {
            let head = declaration::head(pou, self, &chosen);
            format!("{head}END_{}\n", pou.kind.keyword())
        });
        let parts: Vec<_> = structures.chain(globals).chain(pous).collect();
        parts.join("\n")
    }

    fn pou_text(&self, pou: &Pou) -> String {
        let mut text = declaration::head(pou, self, &Chosen::new());
        text.push('\n');
        match &pou.body {
            Body::Text(body) => text.push_str(body),
            Body::Ladder(lines) => {
                text.push_str("(* ladder, as a list *)\n");
                text.push_str(&list(lines));
            }
            Body::Networks(networks) => {
                text.push_str("(* structured ladder or FBD, as statements *)\n");
                for (at, network) in networks.iter().enumerate() {
                    text.push('\n');
                    let heads = [&network.label, &network.title];
                    let heads: Vec<_> = heads.into_iter().filter(|head| !head.is_empty()).collect();
                    let number = at + 1;
                    let mut head = format!("network {number}");
                    for one in heads {
                        head.push_str(": ");
                        head.push_str(one);
                    }
                    text.push_str(&comment(&head));
                    text.push('\n');
                    for line in networks::statements(network, self) {
                        text.push_str(&line);
                        text.push('\n');
                    }
                }
            }
            Body::Chart | Body::Other(_) | Body::Unread => {
                let what = format!("{}, which is not decoded", pou.body.language());
                text.push_str(&comment(&what));
            }
        }
        if !text.ends_with('\n') {
            text.push('\n');
        }
        text + &format!("END_{}\n", pou.kind.keyword())
    }
}

/// A ladder as lines of a list. Statements begin a paragraph.
fn list(lines: &[LadderLine]) -> String {
    let mut out = String::new();
    let mut was_statement = true;
    for line in lines {
        let is_statement = matches!(line, LadderLine::Statement(_));
        if is_statement && !was_statement {
            out.push('\n');
        }
        was_statement = is_statement;
        out.push_str(&line.to_string());
        out.push('\n');
    }
    out
}
