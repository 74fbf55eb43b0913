//! The generated pages of the book in `docs/src`: one for each diagnostic code, one for each family of instructions,
//! one for each safety function, one for the special devices of each model, one each for the addresses of Modbus
//! slaves, the buffer memory of modules and the variants of models, and the lines of `SUMMARY.md` that list them.

use rungc_catalogue::{Family, Inst, explain, families, special_table};
use rungc_functions::library;
use rungc_models::{Model, ModelId, plc_errors};
use rungc_syntax::Severity;
use rungc_syntax::codes::{self, Code};
use std::fmt::Write;

mod modbus;
mod modules;
mod variants;

/// A generated page.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Page {
    /// Path below `docs/src`.
    pub path: String,
    /// Title in the table of contents.
    pub title: String,
    /// Markdown.
    pub text: String,
}

/// All generated pages, chapter by chapter; the first page of a chapter is its index.
pub fn chapters() -> [Vec<Page>; 7] {
    [
        checks(),
        functions(),
        instructions(),
        special_devices(),
        modbus_addresses(),
        module_tables(),
        variant_table(),
    ]
}

fn variant_table() -> Vec<Page> {
    vec![Page {
        path: "variants/index.md".to_owned(),
        title: "Variants and base units".to_owned(),
        text: variants::variants(),
    }]
}

fn module_tables() -> Vec<Page> {
    vec![Page {
        path: "module-tables/index.md".to_owned(),
        title: "Buffer memory of modules".to_owned(),
        text: modules::modules(),
    }]
}

fn modbus_addresses() -> Vec<Page> {
    vec![Page {
        path: "modbus-addresses/index.md".to_owned(),
        title: "Modbus addresses".to_owned(),
        text: modbus::addresses(),
    }]
}

/// `SUMMARY.md` with the pages of each chapter listed below the line of its index; all other lines stay as they are.
pub fn summary(written: &str) -> String {
    let chapters = chapters();
    let mut text = String::new();
    for line in written.lines() {
        let links_to = |page: &Page| line.ends_with(&format!("]({})", page.path));
        if chapters.iter().any(|pages| pages[1..].iter().any(links_to)) || is_stale(line) {
            continue;
        }
        text += &format!("{line}\n");
        for pages in &chapters {
            if !links_to(&pages[0]) {
                continue;
            }
            for page in &pages[1..] {
                // Writing to a String cannot fail.
                let _ = writeln!(text, "  - [{}]({})", escaped(&page.title), page.path);
            }
        }
    }
    text
}

/// Returns true if a line of `SUMMARY.md` lists a page below a generated chapter.
fn is_stale(line: &str) -> bool {
    line.starts_with("  - [")
        && [
            "(checks/",
            "(functions/",
            "(instructions/",
            "(special-devices/",
        ]
        .iter()
        .any(|folder| line.contains(folder))
}

/// Text without characters that Markdown would read as markup.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        if matches!(c, '<' | '>' | '[' | ']' | '*' | '_') {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

fn checks() -> Vec<Page> {
    let mut index = "# Checks\n\nEvery error, warning and note that rungc reports. `rungc explain E0106` shows the same page in the terminal.\n".to_owned();
    let groups = [
        (Severity::Error, "Errors"),
        (Severity::Warning, "Warnings"),
        (Severity::Note, "Notes"),
    ];
    for (severity, title) in groups {
        let _ = write!(index, "\n## {title}\n\n| code | name | |\n|---|---|---|\n");
        for code in codes::all()
            .into_iter()
            .filter(|code| code.severity == severity)
        {
            let (id, name) = (code.id, code.name);
            let _ = writeln!(index, "| [{id}]({id}.md) | `{name}` | {} |", code.title);
        }
    }
    let first = Page {
        path: "checks/index.md".to_owned(),
        title: "Checks".to_owned(),
        text: index,
    };
    let pages = codes::all().into_iter().map(|code| Page {
        path: format!("checks/{}.md", code.id),
        title: format!("{} {}", code.id, code.name),
        text: code_page(code),
    });
    std::iter::once(first).chain(pages).collect()
}

fn functions() -> Vec<Page> {
    let mut index = "# List of safety functions\n\nEach becomes a row of `rungc.toml`, as [Safety functions](../safety.md) explains. `rungc explain two-hand` shows a page in the \
                     terminal.\n\n| name | |\n|---|---|\n".to_owned();
    for function in library::all() {
        let (name, title) = (function.name, function.title);
        let _ = writeln!(index, "| [`{name}`]({name}.md) | {title} |");
    }
    let first = Page {
        path: "functions/index.md".to_owned(),
        title: "List of safety functions".to_owned(),
        text: index,
    };
    let pages = library::all().map(|function| Page {
        path: format!("functions/{}.md", function.name),
        title: function.title.to_owned(),
        text: rungc_functions::page::markdown(function),
    });
    std::iter::once(first).chain(pages).collect()
}

fn code_page(code: &Code) -> String {
    let severity = match code.severity {
        Severity::Error => "Error",
        Severity::Warning => "Warning",
        Severity::Note => "Note",
    };
    let mut page = format!(
        "# {}: {}\n\n{severity} `{}`.\n\n{}\n",
        code.id, code.title, code.name, code.text
    );
    if let Some(number) = code.plc_error {
        let error = plc_errors::check_in_words(code.id, number);
        let _ = write!(page, "\nThe PLC reports this as error {error}.\n");
    }
    if code.can_be_eased().is_ok() {
        let id = code.id;
        let _ = write!(page, "\n`--warn {id}` turns this error into a warning.\n");
    }
    for (title, list) in [("Wrong", code.wrong), ("Right", code.right)] {
        if !list.is_empty() {
            let model = code.model.map(|name| format!(" ({name})"));
            let model = model.unwrap_or_default();
            let _ = write!(
                page,
                "\n## {title}{model}\n\n```text\n{}\n```\n",
                list.trim()
            );
        }
    }
    page
}

fn instructions() -> Vec<Page> {
    let mut index = "# Instructions\n\nEvery instruction, by family. `rungc explain ADD` shows an entry in the terminal, with `--model fx3u` as it is on that model.\n\n".to_owned();
    for family in families() {
        let link = |inst: &Inst| {
            let (name, file, id) = (inst.name, family.name, anchor(inst.name));
            format!("[`{name}`]({file}.md#{id})")
        };
        let links: Vec<_> = family.rows.iter().map(link).collect();
        let (title, name) = (family.title, family.name);
        let _ = writeln!(index, "- [{title}]({name}.md): {}", links.join(", "));
    }
    index += "\n[Support by model](support.md) shows which model has which.\n";
    let first = Page {
        path: "instructions/index.md".to_owned(),
        title: "Instructions".to_owned(),
        text: index,
    };
    let pages = families().iter().map(family_page);
    [first, support()].into_iter().chain(pages).collect()
}

/// Support of instructions by model.
fn support() -> Page {
    let text = format!(
        "# Support by model\n\nEvery instruction of the supported PLCs is read, checked and counted in steps. Those that cannot be compiled are \
         reported by name.\n✓ = works on all three engines; a number refers to a note below; – = not on this model.\n\n{}\n",
        rungc_catalogue::support_table()
    );
    Page {
        path: "instructions/support.md".to_owned(),
        title: "Support by model".to_owned(),
        text,
    }
}

fn family_page(family: &Family) -> Page {
    let mut text = format!("# {}\n", family.title);
    for inst in family.rows {
        // A row is found by its own name.
        let entry = explain(inst.name).unwrap_or_default();
        let _ = write!(text, "\n<a id=\"{}\"></a>\n\n", anchor(inst.name));
        for line in entry.lines() {
            text += &match line.starts_with('#') {
                true => format!("#{}\n", escaped(line)),
                false => format!("{line}\n"),
            };
        }
    }
    Page {
        path: format!("instructions/{}.md", family.name),
        title: family.title.to_owned(),
        text,
    }
}

/// The identifier of an instruction's entry: its name, with symbols spelled out.
fn anchor(name: &str) -> String {
    let mut id = String::new();
    for c in name.chars() {
        match c {
            '<' => id += "-lt",
            '>' => id += "-gt",
            '=' => id += "-eq",
            '+' => id += "-plus",
            '-' => id += "-minus",
            '$' => id += "text-",
            c => id.push(c.to_ascii_lowercase()),
        }
    }
    id
}

fn special_devices() -> Vec<Page> {
    let mut index = "# Special devices\n\nThe special relays (from M8000) and registers (from D8000) of each model. `rungc explain M8013` shows one of them on all models.\n\n".to_owned();
    let mut pages = Vec::new();
    for id in ModelId::ALL {
        let model = Model::get(id);
        let (title, name) = (model.title, model.name);
        let _ = writeln!(index, "- [{title}]({name}.md)");
        pages.push(Page {
            path: format!("special-devices/{name}.md"),
            title: title.to_owned(),
            text: format!(
                "# Special devices of {title}\n\nGenerated from the catalogue. `rungc explain M8013 --model {name}` shows one of them.\n\n{}",
                special_table(id)
            ),
        });
    }
    let first = Page {
        path: "special-devices/index.md".to_owned(),
        title: "Special devices".to_owned(),
        text: index,
    };
    std::iter::once(first).chain(pages).collect()
}
