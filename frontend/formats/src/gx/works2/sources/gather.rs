//! From the parts of a project to its sources.

use super::super::objects::{self, Language};
use super::super::{Part, Works, ends_with};
use super::{
    Body, Globals, Pou, PouKind, Sources, Structure, Table, Task, Unread, assignment, graph, label,
    ladder, pou, structure,
};
use crate::gx::fields::Fields;
use crate::{ReadOptions, encoding};
use encoding_rs::Encoding;

/// Bytes of an unreadable place that a message shows.
const SHOWN: usize = 16;
/// Description of a POU's source, before its name.
const SOURCE: &str = "the source of";

/// Reads sources from parts of a project: their names in the project (`MAIN.Program.pou`), and their contents.
pub fn read_parts(parts: &[(&str, &[u8])], options: &ReadOptions) -> Sources {
    let works = Works::of(options, |ending| {
        let parts = parts.iter().filter(|(name, _)| ends_with(name, ending));
        let part = |(name, bytes): &(&str, &[u8])| Part {
            name: (*name).to_owned(),
            folder: String::new(),
            bytes: bytes.to_vec(),
        };
        Ok(parts.map(part).collect())
    });
    works.map(|works| works.gather()).unwrap_or_default()
}

impl Works<'_> {
    /// The sources, as far as they can be read.
    pub(in crate::gx::works2) fn gather(&self) -> Sources {
        let mut gathering = Gathering {
            works: self,
            encoding: self.encoding(),
            sources: Sources::default(),
        };
        gathering.all();
        let mut sources = gathering.sources;
        if let Some(project) = &self.project {
            sources.reserved.clone_from(&project.reserved);
        }
        let by_name = |library: &Option<String>, name: &str| (library.clone(), name.to_lowercase());
        sources
            .globals
            .sort_by_cached_key(|table| by_name(&table.library, &table.name));
        sources
            .structures
            .sort_by_cached_key(|one| by_name(&one.library, &one.name));
        sources
            .pous
            .sort_by_cached_key(|pou| by_name(&pou.library, &pou.name));
        sources
            .tasks
            .sort_by_cached_key(|task| task.name.to_lowercase());
        sources
    }

    /// The encoding of texts in tokens and in the compiler's store.
    fn encoding(&self) -> &'static Encoding {
        let page = self.project.as_ref().map(|project| project.code_page);
        let stated = page.and_then(encoding::of_number);
        self.options
            .encoding
            .or(stated)
            .unwrap_or(encoding_rs::WINDOWS_1252)
    }
}

struct Gathering<'w> {
    works: &'w Works<'w>,
    encoding: &'static Encoding,
    sources: Sources,
}

impl Gathering<'_> {
    fn all(&mut self) {
        let works = self.works;
        for part in works.globals.iter().chain(&works.library_globals) {
            self.globals(part);
        }
        for part in works.structures.iter().chain(&works.library_structures) {
            self.structure(part);
        }
        for part in &works.sources {
            self.pou(part, &works.labels);
        }
        for part in &works.library_sources {
            self.pou(part, &works.library_labels);
        }
        for part in &works.tasks {
            self.task(part);
        }
        if let Some(store) = &works.store {
            self.scopes(store);
        }
    }

    fn unread(&mut self, what: String, bytes: &[u8], at: usize) {
        let rest = bytes.get(at..).unwrap_or_default();
        let bytes = rest.iter().take(SHOWN).copied().collect();
        self.sources.unread.push(Unread {
            is_source: what.starts_with(SOURCE),
            what,
            at,
            bytes,
        });
    }

    /// The rows of a table, whose damage is noted.
    fn rows<T>(&mut self, table: Table<T>, bytes: &[u8], what: impl FnOnce() -> String) -> Vec<T> {
        if let Some(at) = table.damaged {
            self.unread(what(), bytes, at);
        }
        table.rows
    }

    fn globals(&mut self, part: &Part) {
        let table = part.after_head(label::globals);
        let name = part.stem().to_owned();
        let what = || format!("the global labels `{name}`");
        let labels = self.rows(table, &part.bytes, what);
        self.sources.globals.push(Globals {
            name,
            library: part.library(),
            labels,
        });
    }

    fn structure(&mut self, part: &Part) {
        let table = part.after_head(structure::members);
        let name = part.stem().to_owned();
        let what = || format!("the structure `{name}`");
        let members = self.rows(table, &part.bytes, what);
        self.sources.structures.push(Structure {
            name,
            library: part.library(),
            members,
        });
    }

    fn pou(&mut self, part: &Part, tables: &[Part]) {
        let (name, library) = (part.stem().to_owned(), part.library());
        let mut read = Pou {
            name,
            library,
            kind: PouKind::Program,
            return_type: String::new(),
            labels: Vec::new(),
            body: Body::Unread,
        };
        let is_own = |table: &&Part| {
            table.stem().eq_ignore_ascii_case(part.stem()) && table.library() == read.library
        };
        if let Some(table) = tables.iter().find(is_own) {
            self.declarations(table, &mut read);
        }
        read.body = self.body(part);
        self.sources.pous.push(read);
    }

    /// Kind and labels of a POU.
    fn declarations(&mut self, table: &Part, pou: &mut Pou) {
        let mut fields = Fields::new(&table.bytes);
        let head = objects::head(&mut fields).and_then(|_| pou::Head::read(&mut fields));
        let what = || format!("the labels of `{}`", pou.name);
        let Some(head) = head else {
            return self.unread(what(), &table.bytes, fields.at());
        };
        let labels = label::locals(&mut fields);
        pou.labels = self.rows(labels, &table.bytes, what);
        pou.kind = head.kind;
        pou.return_type = head.return_type;
    }

    fn body(&mut self, part: &Part) -> Body {
        let name = part.stem();
        let Some(pou) = objects::Pou::read(&part.bytes) else {
            self.unread(format!("{SOURCE} `{name}`"), &part.bytes, 0);
            return Body::Unread;
        };
        let content = &part.bytes[pou.start..pou.end];
        let (body, damaged) = match pou.language {
            Language::Ladder => {
                let (lines, damaged) = ladder::lines(content, self.encoding);
                (Body::Ladder(lines), damaged.map(|at| pou.start + at))
            }
            Language::StructuredText => {
                let counted = pou.start - pou::COUNT;
                let (text, damaged) = pou::text(&part.bytes[counted..pou.end]);
                (Body::Text(text), damaged.map(|at| counted + at))
            }
            Language::Picture => {
                let mut fields = Fields::new(&part.bytes[..pou.end]);
                let _ = fields.take(pou.start);
                let (networks, damaged) = graph::networks(&mut fields);
                (Body::Networks(networks), damaged)
            }
            Language::Chart => (Body::Chart, None),
            Language::Other(code) => (Body::Other(code), None),
        };
        if let Some(at) = damaged {
            self.unread(format!("{SOURCE} `{name}`"), &part.bytes, at);
        }
        body
    }

    fn task(&mut self, part: &Part) {
        // That it is damaged has been reported with the program.
        let task = objects::Task::read(&part.bytes).map(|task| Task {
            name: part.stem().to_owned(),
            event: task.event,
            interval: task.interval,
            priority: task.priority,
            pous: task.pous,
        });
        self.sources.tasks.extend(task);
    }

    fn scopes(&mut self, store: &Part) {
        // Projects that were never compiled have no map.
        let Some(map) = assignment::map(&store.bytes) else {
            return;
        };
        let (scopes, damaged) = assignment::scopes(&map, self.encoding);
        self.sources.scopes = scopes;
        if let Some(at) = damaged {
            let what = "the devices that the compiler chose for labels";
            self.unread(what.to_owned(), &map, at);
        }
    }
}

impl Part {
    /// The library of a part that comes from one: `NAME.Labels\LIBRARY.lnl`.
    fn library(&self) -> Option<String> {
        let (_, file) = self.name.rsplit_once('\\')?;
        Some(
            file.rsplit_once('.')
                .map_or(file, |(stem, _)| stem)
                .to_owned(),
        )
    }

    /// A table after the head of the part.
    fn after_head<T>(&self, table: fn(&mut Fields) -> Table<T>) -> Table<T> {
        let mut fields = Fields::new(&self.bytes);
        match objects::head(&mut fields) {
            Some(_) => table(&mut fields),
            None => Table {
                rows: Vec::new(),
                damaged: Some(fields.at()),
            },
        }
    }
}
