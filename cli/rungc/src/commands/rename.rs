//! `rungc rename`.

use super::entries::{entry, with_entries};
use super::in_place::InPlace;
use super::subject::{self, Subject};
use super::{
    Context, Failure, Outcome, Result, completed, conclude, counted, found_reading, parent_dir,
    print_text, read_as_written,
};
use crate::args::RenameArgs;
use crate::output::{at, rewrite};
use crate::report::Reporter;
use rungc::Names;
use rungc::index::Index;
use rungc_frontend::Read;
use rungc_lower::compile;
use rungc_models::runs::is_special;
use rungc_project::{FILE, Project, device};
use rungc_syntax::diag::{self, Fix};
use rungc_syntax::{Device, DeviceClass, Program};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

type Done<T> = std::result::Result<T, Failure>;

/// Puts another device in the place of one, or gives devices labels.
pub fn run(args: &RenameArgs, cx: Context) -> Result {
    let subject = subject::one(&args.input(), cx)?;
    if subject.is_stdin() {
        let why = "rename changes files; name the program";
        return Err(Failure::Because(why.to_string()));
    }
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let outcome = rename(args, &subject, &mut reporter, cx);
    reporter.finish()?;
    outcome
}

fn rename(args: &RenameArgs, subject: &Subject, reporter: &mut Reporter, cx: Context) -> Result {
    let read = read_as_written(subject, reporter)?;
    let findings = found_reading(subject, &read);
    if findings.failed() {
        return conclude(&findings, reporter, cx, String::new);
    }
    let change = match (&args.device, &args.name) {
        (Some(old), Some(new)) => {
            let old = Names::of(&read.program).device(old);
            let old = old.map_err(Failure::Because)?;
            match named_device(new)? {
                Some(_) => in_list(old, new, &read, (subject, reporter))?,
                None => {
                    check_device(old, &read.program, subject)?;
                    in_settings(&[(old, new.trim().to_string())], subject, cx)?
                }
            }
        }
        _ => in_settings(&by_comments(&read.program, subject, cx), subject, cx)?,
    };
    if args.dry_run {
        print_text(&change.listing())?;
        return Ok(Outcome::Success);
    }
    let file = change.file.display().to_string();
    let lines = counted(change.lines().count(), "line");
    match &change.list {
        Some(list) => list.write(&change.after)?,
        None => rewrite(&change.file, change.after.as_bytes())?,
    }
    cx.note(&format!("     Renamed {file}: {lines}"));
    for note in &change.notes {
        cx.note(&format!("        Note {note}"));
    }
    Ok(Outcome::Success)
}

/// New text of a file.
struct Change {
    file: PathBuf,
    /// The list, if the file is one.
    list: Option<InPlace>,
    before: String,
    after: String,
    notes: Vec<String>,
}

impl Change {
    /// Numbers of lines that are new or different, with what is there before and afterwards.
    fn lines(&self) -> impl Iterator<Item = (usize, Option<&str>, &str)> {
        let before: Vec<&str> = self.before.lines().collect();
        let after: Vec<&str> = self.after.lines().collect();
        // Lines are changed, or added in one place.
        let added = after.len().saturating_sub(before.len());
        let same = before.iter().zip(&after).take_while(|(a, b)| a == b);
        let first = same.count();
        let lines = after.into_iter().enumerate();
        lines.filter_map(move |(at, line)| {
            let old = match at {
                _ if added == 0 => before.get(at).copied(),
                _ if at < first => Some(line),
                _ if at < first + added => None,
                _ => before.get(at - added).copied(),
            };
            (old != Some(line)).then_some((at + 1, old, line))
        })
    }

    fn listing(&self) -> String {
        let mut text = String::new();
        for (number, before, after) in self.lines() {
            let _ = writeln!(text, "{}:{number}", self.file.display());
            if let Some(before) = before {
                let _ = writeln!(text, "-{before}");
            }
            let _ = writeln!(text, "+{after}");
        }
        text
    }
}

/// The device that a name is. What looks like one is not a label.
fn named_device(name: &str) -> Done<Option<Device>> {
    let upper = name.trim().to_uppercase();
    let found = device::device(&upper);
    let prefix = upper.trim_end_matches(|c: char| c.is_ascii_digit());
    let is_meant = prefix.len() < upper.len() && DeviceClass::from_prefix(prefix).is_some();
    match device::mistake(&upper) {
        Some(why) if is_meant => Err(Failure::Because(format!("`{name}`: {why}"))),
        _ => Ok(found),
    }
}

/// Puts a device in the place of another one, in all instructions of a list and in its comment.
fn in_list(
    old: Device,
    new: &str,
    read: &Read,
    (subject, reporter): (&Subject, &mut Reporter),
) -> Done<Change> {
    let path = subject.file.display();
    if !read.program.kind.is_list() {
        let why = format!(
            "rename: {path} is not an instruction list; rename `{old}` in its editor, or give it a label"
        );
        return Err(Failure::Because(why));
    }
    let list = InPlace::open(subject, read, "rename")?;
    let project = project(subject, read, reporter)?;
    let renaming = Index::new(&project).rename(old, new);
    let renaming = renaming.map_err(|why| Failure::Because(format!("rename: {why}")))?;
    let source = &project.source().source;
    if renaming.edits.is_empty() {
        return Err(Failure::Because(format!("{path} does not name `{old}`")));
    }
    let edits = renaming.edits.iter();
    let fix = edits.fold(Fix::certain(""), |fix, (span, text)| {
        fix.replace(*span, text)
    });
    let (after, _) = diag::apply(&source.text, &[&fix]);
    Ok(Change {
        file: subject.file.clone(),
        list: Some(list),
        before: source.text.clone(),
        after,
        notes: renaming.notes,
    })
}

/// The program with what its settings say of it.
fn project(subject: &Subject, read: &Read, reporter: &mut Reporter) -> Done<rungc::Project> {
    let read = completed(read.clone(), subject, reporter)?;
    let settings = subject.project.as_deref().cloned();
    Ok(rungc::Project::from_read(
        subject.file.clone(),
        read,
        (settings, subject.plc()),
        subject.reporting.levels(),
    ))
}

/// Returns an error for a device that the model does not have.
fn check_device(device: Device, program: &Program, subject: &Subject) -> Done<()> {
    let model = compile::model(program, &subject.options());
    match model.has(device.class, device.number) {
        true => Ok(()),
        false => Err(Failure::Because(format!(
            "`{device}` does not exist on {}",
            model.title
        ))),
    }
}

/// Devices without a label that have a comment, which becomes their label. Those whose comment cannot be one are
/// reported.
fn by_comments(program: &Program, subject: &Subject, cx: Context) -> Vec<(Device, String)> {
    let own = subject.own_project().map(|project| &project.labels[..]);
    let own = own.unwrap_or_default();
    let mut names: BTreeMap<String, Device> = BTreeMap::new();
    names.extend(
        own.iter()
            .map(|label| (label.name.to_lowercase(), label.device)),
    );
    let labelled: BTreeSet<Device> = own.iter().map(|label| label.device).collect();
    let mut labels = Vec::new();
    for (&device, comment) in &program.comments {
        let name = comment.split_whitespace().collect::<Vec<_>>().join(" ");
        if name.is_empty() || labelled.contains(&device) || is_special(device.class, device.number)
        {
            continue;
        }
        let skipped = |why: String| cx.note(&format!("     Skipped {device}: {why}"));
        if device::device(&name.to_uppercase()).is_some() {
            skipped(format!("its comment `{name}` is the name of a device"));
        } else if let Some(other) = names.get(&name.to_lowercase()) {
            skipped(format!("{other} has the name `{name}`"));
        } else {
            names.insert(name.to_lowercase(), device);
            labels.push((device, name));
        }
    }
    labels
}

/// Labels in the settings of the program, which are made if there are none.
fn in_settings(labels: &[(Device, String)], subject: &Subject, cx: Context) -> Done<Change> {
    let (path, before) = match &subject.project {
        Some(project) if project.is_about(&subject.file) => {
            let text = fs::read_to_string(&project.path);
            (
                project.path.clone(),
                text.map_err(|error| at(&project.path, error))?,
            )
        }
        Some(project) => {
            let why = format!(
                "{} is not about this program, so its labels are not either: name it there, `[project] program = {}`",
                project.path.display(),
                file_name(subject)
            );
            return Err(Failure::Because(why));
        }
        None => {
            let path = match parent_dir(&subject.file) {
                here if here == Path::new(".") => PathBuf::from(FILE),
                folder => folder.join(FILE),
            };
            (path, String::new())
        }
    };
    let labelled = subject
        .own_project()
        .into_iter()
        .flat_map(|project| &project.labels);
    for label in labelled {
        let (known, taken) = (label.device, &label.name);
        for (device, name) in labels {
            let why = match (
                *device == known,
                name.to_lowercase() == taken.to_lowercase(),
            ) {
                (true, _) => format!("`{known}` has the label `{taken}`: change it in rungc.toml"),
                (_, true) => format!("`{taken}` is the label of {known}"),
                _ => continue,
            };
            return Err(Failure::Because(why));
        }
    }
    let head = match before.is_empty() {
        true => format!("[project]\nprogram = {}\n", file_name(subject)),
        false => before.clone(),
    };
    let entries = labels
        .iter()
        .map(|(device, name)| entry(name, &device.to_string()));
    let entries: String = entries.collect();
    let after = match labels {
        [] => before.clone(),
        _ => with_entries(&head, "labels", &entries)
            .map_err(|why| Failure::Because(format!("{}: {why}", path.display())))?,
    };
    // What a label may be, the settings say.
    let read = Project::parse(&path, &after);
    read.map_err(|error| subject::refuse(error, &subject.reporting, cx))?;
    Ok(Change {
        file: path,
        list: None,
        before,
        after,
        notes: Vec::new(),
    })
}

/// Name of the program's file, as the settings beside it write it.
fn file_name(subject: &Subject) -> String {
    let name = subject.file.file_name().unwrap_or_default();
    toml::Value::from(&*name.to_string_lossy()).to_string()
}
