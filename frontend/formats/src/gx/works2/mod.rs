//! GX Works2: an OLE compound file whose stream `_hdb` is an OLE compound file in turn. Its streams are known by
//! numbers; the list `projectdatalist.xml` gives them names.
//!
//! A project holds each program twice: as it was drawn or written (`*.pou`), and as it was last compiled (`*.res`). A
//! ladder without labels is read from its source, everything else as compiled. Times do not show which of the two is
//! newer: that of a `.res` is when the program file was made (in all published projects it is older than a source which
//! equals it byte for byte). So a compiled program is held to its source by the devices that both name.

mod container;
mod mentions;
mod objects;
mod recovery;
pub mod sources;

use super::program::{self, Code};
use super::tokens::{self, Bare, Token};
use super::{MAX_DATA, comments, cpu, damaged_part, no_program, parameters};
use crate::text::clean;
use crate::{Read, ReadOptions, encoding};
use container::{Container, Row};
use encoding_rs::UTF_16LE;
use memchr::memmem;
use objects::{Compiled, Language, Pou, Project, Task};
use rungc_syntax::{Device, Diagnostic, Diagnostics, Parameters, SourceKind, Span, codes};
use sources::Sources;
use std::collections::{BTreeMap, BTreeSet};

/// The stream of the outer file that holds the project's data.
const DATA: &str = "_hdb";
/// The stream of the outer file that names those of the inner one.
const LIST: &str = "projectdatalist.xml";
/// Advice for the editor.
const REBUILD: &str = "open the project in GX Works2, choose Compile > Rebuild All and save it";

/// Reads a `.gxw` file.
pub(crate) fn read(name: &str, bytes: &[u8], options: &ReadOptions) -> Read {
    let outer = Container::open(bytes);
    let data = outer.as_ref().and_then(|outer| outer.stream(DATA));
    let data = data.unwrap_or_default();
    let inner = Container::open(&data);
    let list = outer.as_ref().and_then(|outer| outer.stream(LIST));
    let rows = list.as_deref().and_then(container::rows);
    let mut read = match (&inner, &rows) {
        (Some(inner), Some(rows)) => Works::open(inner, rows, options)
            .and_then(|works| works.read(name))
            .unwrap_or_else(|why| recovered(name, bytes, &data, options, &why)),
        _ => recovered(
            name,
            bytes,
            &data,
            options,
            "the project's directory cannot be read",
        ),
    };
    read.program.kind = SourceKind::GxWorks2;
    read
}

/// Reads the program that can be found by its bytes.
fn recovered(name: &str, bytes: &[u8], data: &[u8], options: &ReadOptions, why: &str) -> Read {
    // A separate container, which may read all streams.
    let streams = Container::open(data).map_or_else(Vec::new, |inner| inner.all());
    let cpu = streams
        .iter()
        .find_map(|s| super::cpu_code(s))
        .map(cpu::name);
    let refused = |cpu: &String| cpu::refused(name, SourceKind::GxWorks2, cpu);
    if let Some(refused) = cpu.as_ref().and_then(refused) {
        return refused;
    }
    let Some(mut read) = recovery::read(name, &streams, options) else {
        return match Container::open(bytes) {
            Some(_) => no_program(name, bytes),
            None => cut_off(name, bytes),
        };
    };
    read.program.cpu = cpu;
    if let Some(table) = streams.iter().find(|stream| comments::is_developer(stream)) {
        let comments = comments::of_developer(table);
        let texts: Vec<_> = comments.texts().collect();
        super::add_comments(
            &mut read,
            table,
            &comments,
            options.encoding_of(&texts, None),
        );
    }
    read.diagnostics.push(
        codes::RECOVERED
            .at(
                Span::default(),
                format!("{why}; the program was found by its bytes"),
            )
            .label("the longest program of the file")
            .help("open the project in GX Works2, compare, and save it again"),
    );
    read
}

/// A project whose container cannot be opened: often one that was not copied whole.
fn cut_off(name: &str, bytes: &[u8]) -> Read {
    super::without_program(name, "?? damaged", |span| {
        let length = bytes.len();
        let message = format!(
            "the project is damaged or cut off after {length} bytes, and nothing in it can be read"
        );
        codes::DAMAGED
            .at(span, message)
            .label("this program")
            .help("copy the file again, and compare its size with that of the original")
    })
}

/// A part of the project.
struct Part {
    name: String,
    folder: String,
    bytes: Vec<u8>,
}

impl Part {
    /// The name before the first dot, and before the file of a library.
    fn stem(&self) -> &str {
        self.name.split(['.', '\\']).next().unwrap_or(&self.name)
    }
}

/// The parts of a project.
struct Works<'o> {
    options: &'o ReadOptions,
    project: Option<Project>,
    sources: Vec<Part>,
    compiled: Vec<Part>,
    tasks: Vec<Part>,
    globals: Vec<Part>,
    labels: Vec<Part>,
    structures: Vec<Part>,
    library_sources: Vec<Part>,
    library_globals: Vec<Part>,
    library_labels: Vec<Part>,
    library_structures: Vec<Part>,
    /// The compiler's store.
    store: Option<Part>,
    comments: Option<Part>,
    parameters: Option<Part>,
}

/// A source that a task runs.
type Source<'w> = (&'w Part, Pou);

impl<'o> Works<'o> {
    /// Takes the parts that define the program; reports why not, if these are more than a project has.
    fn open(inner: &Container, rows: &[Row], options: &'o ReadOptions) -> Result<Self, String> {
        let part = |row: &Row| {
            Some(Part {
                name: row.name.clone(),
                folder: row.folder.clone(),
                bytes: inner.stream(&row.id)?,
            })
        };
        Works::of(options, |ending| {
            let wanted = || rows.iter().filter(|row| ends_with(&row.name, ending));
            if wanted().nth(MAX_PARTS).is_some() {
                return Err(format!(
                    "the project lists more than {MAX_PARTS} parts `*{ending}`"
                ));
            }
            Ok(wanted().filter_map(part).collect())
        })
    }

    /// The project whose parts with an ending `parts` gives.
    fn of(
        options: &'o ReadOptions,
        parts: impl Fn(&str) -> Result<Vec<Part>, String>,
    ) -> Result<Self, String> {
        let project = parts(".prj")?;
        Ok(Works {
            options,
            project: project.iter().find_map(|part| Project::read(&part.bytes)),
            sources: parts(".pou")?,
            compiled: parts(".res")?,
            tasks: parts(".tsk")?,
            globals: parts(".gh")?,
            labels: parts(".lh")?,
            structures: parts(".str")?,
            library_sources: parts(".lnb")?,
            library_globals: parts(".lng")?,
            library_labels: parts(".lnl")?,
            library_structures: parts(".lns")?,
            store: parts("ESCompiler.stg")?.pop(),
            comments: parts("COMMENT.qcd")?.pop(),
            parameters: parts("Param.wpa")?.pop(),
        })
    }

    /// Reads the program; says why not, if no part of the project that can be read holds one.
    fn read(&self, name: &str) -> Result<Read, String> {
        let header = || super::cpu_code(&self.parameters.as_ref()?.bytes).map(cpu::name);
        let named = self.project.as_ref().map(|project| project.cpu.clone());
        let cpu = named.filter(|cpu| !cpu.trim().is_empty()).or_else(header);
        let refused = |cpu: &String| cpu::refused(name, SourceKind::GxWorks2, cpu);
        if let Some(refused) = cpu.as_ref().and_then(refused) {
            return Ok(refused);
        }
        let mut found = Diagnostics::new();
        let parameters = self.take_parameters(&mut found);
        if parameters.as_ref().is_some_and(|set| set.protected) {
            return Ok(super::protected(name, SourceKind::GxWorks2, cpu));
        }
        let order = parameters.as_ref().map_or(&[][..], |p| &p.programs);
        let file = self.program_file(order, &mut found)?;
        let pous = self.task_pous(file, &mut found);
        let sources = self.gather();
        let mut read = self.program(name, file, &pous, &sources, &mut found)?;
        self.name_unused(&mut found);
        self.take_comments(&mut read, &mut found);
        let title = self.project.as_ref().and_then(|p| clean(&p.title));
        read.program.title = title.map(Into::into);
        read.program.cpu = cpu;
        read.program.parameters = parameters;
        sources.name_devices(&mut read.program.comments);
        sources
            .notes()
            .into_iter()
            .for_each(|note| found.push(note));
        read.sources = Some(Box::new(sources));
        read.diagnostics.extend(found.iter().cloned());
        Ok(read)
    }

    /// The PLC parameters.
    fn take_parameters(&self, found: &mut Diagnostics) -> Option<Parameters> {
        let part = self.parameters.as_ref()?;
        let (parameters, damaged) = parameters::read(&part.bytes);
        found.extend(damaged.map(|at| damaged_part("the PLC parameters", &part.bytes, at)));
        Some(parameters)
    }

    /// The program file that the PLC runs; others are named.
    fn program_file(&self, order: &[String], found: &mut Diagnostics) -> Result<&Part, String> {
        let file = |name: &str| {
            let mut files = self.compiled.iter();
            files.find(|part| part.stem().eq_ignore_ascii_case(name))
        };
        let first = file("MAIN").or_else(|| order.iter().find_map(|name| file(name)));
        let first = first
            .or(self.compiled.first())
            .ok_or("the project names no program file")?;
        let others = self.compiled.iter().filter(|part| part.name != first.name);
        let others: Vec<_> = others.map(Part::stem).collect();
        if !others.is_empty() {
            let message = format!("program files that are ignored: {}", listed(&others, NAMED));
            found.push(
                codes::PROGRAM_NOT_RUN
                    .at(Span::default(), message)
                    .label(format!("this is `{}`", first.stem()))
                    .help("an FX-family PLC runs one program file: move what you need from the others into it"),
            );
        }
        Ok(first)
    }

    /// The POUs that the tasks of a program file run, in order.
    fn task_pous(&self, file: &Part, found: &mut Diagnostics) -> Vec<String> {
        // A task has its program file's name, or lies in its folder.
        let owner = |task: &Part| {
            let named = |part: &&Part| part.stem().eq_ignore_ascii_case(task.stem());
            let beside = |part: &&Part| part.folder == task.folder;
            let files = || self.compiled.iter();
            files().find(named).or_else(|| files().find(beside))
        };
        let of_file = |task: &&Part| owner(task).is_none_or(|owner| owner.name == file.name);
        let mut pous = Vec::new();
        for part in self.tasks.iter().filter(of_file) {
            match Task::read(&part.bytes) {
                Some(task) => pous.extend(task.pous),
                None => {
                    let what = format!("the task `{}`", part.stem());
                    found.push(damaged_part(&what, &part.bytes, 0));
                }
            }
        }
        pous
    }

    /// Reads the program of a program file whose tasks run these POUs.
    fn program(
        &self,
        name: &str,
        file: &Part,
        pous: &[String],
        all: &Sources,
        found: &mut Diagnostics,
    ) -> Result<Read, String> {
        let compiled = Compiled::read(&file.bytes)
            .filter(|compiled| holds_program(&file.bytes[compiled.start..compiled.end]));
        let as_compiled = compiled
            .as_ref()
            .map(|compiled| || self.tokens(name, file, compiled.start, compiled.end));
        if self.options.compiled {
            let Some(as_compiled) = as_compiled else {
                let message = "the project has no compiled program".to_owned();
                return Ok(refused(name, file.stem(), &codes::NOT_COMPILED, message));
            };
            found.push(shown_as_compiled(format!(
                "`{}` is shown as compiled",
                file.stem()
            )));
            return Ok(as_compiled());
        }
        let sources = match self.sources(pous) {
            Ok(sources) => sources,
            Err(why) => {
                let read = as_compiled.ok_or_else(|| why.clone())?();
                found.push(damage_of_sources(&why));
                return Ok(read);
            }
        };
        if let [(part, pou)] = &sources[..]
            && pou.language == Language::Ladder
            && !has_labels(part, pou)
        {
            let source = self.tokens(name, part, pou.start, pou.end);
            let code = compiled.as_ref().map(|c| &file.bytes[c.start..c.end]);
            let same =
                |code| without_padding(code) == without_padding(&part.bytes[pou.start..pou.end]);
            let (Some(code), Some(as_compiled)) = (code, as_compiled) else {
                return Ok(source);
            };
            return Ok(match same(code) {
                true => source,
                false => better(source, as_compiled(), part.stem(), found),
            });
        }
        let what = described(&sources);
        let (Some(compiled), Some(as_compiled)) = (&compiled, as_compiled) else {
            let message =
                format!("{what}: such a program is read as compiled, but it was not compiled yet");
            return Ok(refused(name, &what, &codes::NOT_COMPILED, message));
        };
        let code = &file.bytes[compiled.start..compiled.end];
        Ok(match self.age(compiled, code, &sources, all) {
            Age::Newer => {
                found.push(shown_as_compiled(format!(
                    "{what}: it is shown as compiled"
                )));
                as_compiled()
            }
            Age::Unknown => {
                let state = state(code, &sources);
                let is_confirmed = self.options.compiled_state.as_deref() == Some(&state);
                found.push(match is_confirmed {
                    true => shown_as_compiled(format!("{what}: it is shown as compiled")),
                    false => age_unknown(&what, &state),
                });
                as_compiled()
            }
            Age::Older(why) => {
                let message = format!("{what}, and its compiled program is older: {why}");
                refused(name, &what, &codes::STALE_PROGRAM, message)
            }
        })
    }

    /// The sources of these POUs; which cannot be read.
    fn sources(&self, pous: &[String]) -> Result<Vec<Source<'_>>, String> {
        if pous.is_empty() {
            return Err("no task lists the parts of the program".to_owned());
        }
        if pous.len() > MAX_PARTS {
            return Err(format!("the tasks name more than {MAX_PARTS} POUs"));
        }
        let source = |pou: &String| {
            let mut parts = self.sources.iter();
            let part = parts.find(|part| part.stem().eq_ignore_ascii_case(pou));
            let source = part.and_then(|part| Some((part, Pou::read(&part.bytes)?)));
            source.ok_or_else(|| format!("the source of `{pou}` cannot be read"))
        };
        pous.iter().map(source).collect()
    }

    /// Reads tokens of a part.
    fn tokens(&self, name: &str, part: &Part, start: usize, end: usize) -> Read {
        let bytes = &part.bytes[..end.min(start + MAX_DATA)];
        let chains = program::chains(bytes);
        let code = Code::new(bytes, start, &chains);
        let project = self.project.as_ref();
        let page = project.and_then(|project| encoding::of_number(project.code_page));
        let encoding = self.options.encoding_of(&code.texts(), page);
        let mut read = code.read(name, encoding, self.options);
        read.program.pou = Some(part.stem().to_owned());
        read
    }

    /// Age of a compiled program relative to its sources.
    fn age(&self, compiled: &Compiled, code: &[u8], sources: &[Source], all: &Sources) -> Age {
        let newer = |(_, pou): &Source| compiled.created >= pou.saved;
        if sources.iter().all(newer) {
            return Age::Newer;
        }
        let plain =
            |(part, pou): &Source| pou.language == Language::Ladder && !has_labels(part, pou);
        if sources.iter().all(plain) {
            let missing = sources.iter().find(|(part, pou)| {
                let source = without_end(&part.bytes[pou.start..pou.end]);
                memmem::find(code, source).is_none()
            });
            return match missing {
                Some((part, _)) => Age::Older(format!("`{}` has changed since", part.stem())),
                None => Age::Newer,
            };
        }
        let globals = || all.globals.iter().flat_map(|table| &table.labels);
        // A label of the POU hides a global one.
        let labels = |part: &Part| -> BTreeMap<String, Device> {
            let own = all.pou(part.stem()).into_iter().flat_map(|pou| &pou.labels);
            let devices = globals().chain(own).map(|label| {
                let device = mentions::device(&label.device);
                (label.name.to_lowercase(), device)
            });
            let devices = devices.collect::<BTreeMap<_, _>>().into_iter();
            devices
                .filter_map(|(name, device)| Some((name, device?)))
                .collect()
        };
        let has = mentions::of_ladder(code, &BTreeMap::new());
        let missing: Vec<_> = sources
            .iter()
            .flat_map(|(part, pou)| {
                let content = &part.bytes[pou.start..pou.end];
                match pou.language {
                    Language::Ladder => mentions::of_ladder(content, &labels(part)),
                    Language::StructuredText => {
                        let text = UTF_16LE.decode_without_bom_handling(content).0;
                        mentions::of_text(&text, &labels(part))
                    }
                    _ => BTreeSet::new(),
                }
            })
            .filter(|device| !has.contains(device))
            .take(SHOWN)
            .map(|device| format!("`{device}`"))
            .collect();
        match missing.is_empty() {
            true => Age::Unknown,
            false => Age::Older(format!("it does not have {}", missing.join(", "))),
        }
    }

    /// Names the POUs that are neither run by a task nor named by another POU.
    fn name_unused(&self, found: &mut Diagnostics) {
        let tasks = self.tasks.iter().filter_map(|part| Task::read(&part.bytes));
        let run = tasks.flat_map(|task| task.pous);
        let run: BTreeSet<_> = run.map(|pou| pou.to_lowercase()).collect();
        let is_run = |part: &&Part| run.contains(&part.stem().to_lowercase());
        let others: Vec<&Part> = self.sources.iter().filter(|part| !is_run(part)).collect();
        let named = self.named(&others);
        let unused = others.iter().filter(|part| !named.contains(part.stem()));
        let unused: Vec<_> = unused.map(|part| part.stem()).collect();
        if !unused.is_empty() {
            found.push(
                codes::POU_NOT_RUN
                    .at(
                        Span::default(),
                        format!("no task runs {}", listed(&unused, NAMED)),
                    )
                    .label("the program that the tasks run starts here")
                    .help("add them to a task in GX Works2 if they are part of the program"),
            );
        }
    }

    /// Names of these POUs that occur in the text or the labels of another POU.
    fn named(&self, pous: &[&Part]) -> BTreeSet<String> {
        let names: BTreeSet<_> = pous.iter().map(|part| part.stem()).collect();
        let mut named = BTreeSet::new();
        let tables = self.globals.iter().chain(&self.labels);
        for part in self.sources.iter().chain(tables) {
            // Texts in UTF-16 begin at even and at odd offsets.
            for bytes in [&part.bytes[..], part.bytes.get(1..).unwrap_or_default()] {
                let (text, _) = UTF_16LE.decode_without_bom_handling(bytes);
                let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
                let others = words.filter(|word| *word != part.stem() && names.contains(word));
                named.extend(others.map(str::to_owned));
            }
        }
        named
    }

    /// Adds the device comments.
    fn take_comments(&self, read: &mut Read, found: &mut Diagnostics) {
        let Some(part) = &self.comments else { return };
        let table = comments::of_works2(&part.bytes);
        let comments = table.read.iter();
        let cleaned = comments.filter_map(|(device, text)| Some((*device, clean(text)?.into())));
        read.program.comments.extend(cleaned);
        found.extend(
            table
                .damaged
                .map(|at| damaged_part("the device comments", &part.bytes, at)),
        );
    }
}

/// Maximum number of devices that a message names.
const SHOWN: usize = 5;
/// Maximum number of POUs that a message names.
const NAMED: usize = 20;
/// More parts of one kind than any project for an FX-family PLC has.
const MAX_PARTS: usize = 1000;

/// The first `limit` of some names, and how many more there are.
fn listed(names: &[&str], limit: usize) -> String {
    let shown = names.iter().take(limit).map(|name| format!("`{name}`"));
    let shown = shown.collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(limit) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Age of a compiled program.
enum Age {
    /// As new as its source.
    Newer,
    /// Perhaps older: nothing in the project shows it.
    Unknown,
    /// Older, for this reason.
    Older(String),
}

/// Selects one of a ladder and a compiled program that differ: the ladder, unless it alone is damaged.
fn better(source: Read, compiled: Read, pou: &str, found: &mut Diagnostics) -> Read {
    if source.diagnostics.has_errors() && !compiled.diagnostics.has_errors() {
        found.push(damage_of_sources(&format!("the ladder `{pou}` is damaged")));
        return compiled;
    }
    let message = format!("the ladder `{pou}` was changed after it was compiled");
    found.push(
        codes::SOURCE_DIFFERS
            .at(Span::default(), message)
            .label("the ladder is used")
            .help(format!("{REBUILD}; `--compiled` reads what was compiled")),
    );
    source
}

fn damage_of_sources(why: &str) -> Diagnostic {
    codes::RECOVERED
        .at(
            Span::default(),
            format!("{why}; the compiled program is used"),
        )
        .label("the compiled program")
        .help(REBUILD)
}

fn shown_as_compiled(message: String) -> Diagnostic {
    codes::READ_AS_COMPILED
        .at(Span::default(), message)
        .label("the compiled program starts here")
        .help("steps and automatically assigned devices are those of the last compilation")
}

/// Number of a state of a project: FNV-1a of the compiled program and its sources.
fn state(code: &[u8], sources: &[Source]) -> String {
    let sources = sources.iter();
    let parts = sources.map(|(part, pou)| &part.bytes[pou.start..pou.end]);
    let bytes = std::iter::once(code).chain(parts).flatten();
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3)
    });
    format!("{hash:016x}")
}

fn age_unknown(what: &str, state: &str) -> Diagnostic {
    let message = format!("{what}: it is shown as compiled, which may be older than its source");
    codes::AGE_UNKNOWN
        .at(Span::default(), message)
        .label("the compiled program starts here")
        .help(format!(
            "if the source was changed since, {REBUILD}; then add `compiled = \"{state}\"` to `[project]` of rungc.toml"
        ))
}

/// A project whose program cannot be taken as it is.
fn refused(name: &str, line: &str, code: &'static codes::Code, message: String) -> Read {
    let help = match code.id == codes::STALE_PROGRAM.id {
        true => format!("{REBUILD}; `--compiled` reads the older program anyway"),
        false => REBUILD.to_owned(),
    };
    super::without_program(name, line, |span| {
        code.at(span, message).label("this program").help(help)
    })
}

/// Description of a program's sources, by the first that is not a plain ladder.
fn described(sources: &[Source]) -> String {
    let unlike = |(part, pou): &&Source| pou.language != Language::Ladder || has_labels(part, pou);
    match sources.iter().find(unlike) {
        Some((part, pou)) if pou.language == Language::Ladder => {
            format!("`{}` is a ladder with labels", part.stem())
        }
        Some((part, pou)) => format!("`{}` is {}", part.stem(), pou.language.name()),
        None => "the program consists of several ladders".to_owned(),
    }
}

/// Returns true if a ladder names labels.
fn has_labels(part: &Part, pou: &Pou) -> bool {
    let mut bodies = program::bodies(&part.bytes[pou.start..pou.end]);
    bodies.any(|body| matches!(tokens::token(body), Some(Token::Operand(Bare::Name(_)))))
}

/// Returns true if compiled code is more than `END` and padding.
fn holds_program(code: &[u8]) -> bool {
    !without_end(code).is_empty()
}

/// Tokens without NOPs and zeros at their end.
fn without_padding(code: &[u8]) -> &[u8] {
    let mut code = code;
    while let [rest @ .., 0] | [rest @ .., 2, 2] = code {
        code = rest;
    }
    code
}

/// Tokens without `END`, too.
fn without_end(code: &[u8]) -> &[u8] {
    let code = without_padding(code);
    let [end] = tokens::END else { return code };
    code.strip_suffix(&[3, *end, 3])
        .map_or(code, without_padding)
}

/// Returns true if a name ends with `ending`, in upper or lower case.
fn ends_with(name: &str, ending: &str) -> bool {
    name.to_lowercase().ends_with(&ending.to_lowercase())
}
