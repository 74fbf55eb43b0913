//! The documentation as a page.

use super::{Document, Output};
use crate::language::{Argument, Language, message, phrase};
use crate::lists::Terminal;
use crate::xref::Entry;
use rungc_analysis::resolve::Resolved;
use rungc_ladder::Ladder;
use rungc_ladder::html::{Escaped, STYLE, write_section};
use rungc_ladder::sfc::Chart;
use rungc_ladder::svg::Painter;
use rungc_syntax::Phrase;
use rungc_why::Why;
use std::borrow::Cow;
use std::fmt::{self, Write};

/// Style in addition to that of pages with ladders.
const OWN: &str = include_str!("page.css");
/// Characters of a line; a page of A4 has room for them.
const WIDTH: usize = 104;

/// The page.
pub(super) fn page(
    document: &Document,
    resolved: &Resolved,
    ladder: &Ladder,
    language: Language,
) -> String {
    let networks: Vec<_> = (1..).zip(&ladder.networks).collect();
    let page = Page {
        document,
        resolved,
        ladder,
        painter: Painter::new(resolved, &networks, WIDTH),
        language,
    };
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = page.write(&mut out);
    out
}

struct Page<'a> {
    document: &'a Document,
    resolved: &'a Resolved<'a>,
    ladder: &'a Ladder,
    painter: Painter<'a>,
    language: Language,
}

/// A section: its identifier, which is also that of its title, and what writes it.
type Section<'a> = (&'static str, fn(&Page<'a>, &mut String) -> fmt::Result);

impl<'a> Page<'a> {
    fn text(&self, id: &str) -> String {
        message(self.language, &format!("doc-{id}"), &[])
    }

    fn write(&self, out: &mut String) -> fmt::Result {
        let Document {
            title,
            plc,
            steps,
            networks,
            ..
        } = self.document;
        let numbers = [*steps as usize, *networks];
        let about = [
            ("plc", Argument::from(*plc)),
            ("steps", numbers[0].into()),
            ("networks", numbers[1].into()),
        ];
        let about = message(self.language, "doc-about", &about);
        let sections = self.sections();
        writeln!(
            out,
            "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
             content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>\n{STYLE}{OWN}</style>\n\
             </head>\n<body>\n<header><h1>{title}</h1><p>{}</p></header>\n<main>\n<nav aria-label=\"{}\"><ul>",
            self.language.tag(),
            Escaped(&about),
            Escaped(&self.text("contents")),
            title = Escaped(title),
        )?;
        for (id, _) in &sections {
            writeln!(
                out,
                "<li><a href=\"#{id}\">{}</a></li>",
                Escaped(&self.text(id))
            )?;
        }
        writeln!(out, "</ul></nav>")?;
        for (id, write) in &sections {
            writeln!(out, "<h2 id=\"{id}\">{}</h2>", Escaped(&self.text(id)))?;
            write(self, out)?;
        }
        writeln!(out, "</main>\n</body>\n</html>")
    }

    /// The sections that have something to say.
    fn sections(&self) -> Vec<Section<'a>> {
        let Document {
            terminals,
            timers,
            specials,
            instructions,
            properties,
            ..
        } = self.document;
        let all: [(bool, Section<'a>); 10] = [
            (!terminals.is_empty(), ("terminals", Page::terminals)),
            (true, ("outputs", Page::outputs)),
            (self.chart().is_some(), ("chart", Page::write_chart)),
            (!timers.is_empty(), ("timers", Page::timers)),
            (!specials.is_empty(), ("specials", Page::specials)),
            (
                !instructions.is_empty(),
                ("instructions", Page::instructions),
            ),
            (!properties.is_empty(), ("properties", Page::properties)),
            (true, ("open", Page::open)),
            (true, ("devices", Page::devices)),
            (true, ("ladder", Page::write_ladder)),
        ];
        let said = all.into_iter().filter(|(is_there, _)| *is_there);
        said.map(|(_, section)| section).collect()
    }

    /// A table: heads by their identifiers, then rows of cells in HTML.
    fn table(
        &self,
        out: &mut String,
        heads: &[&str],
        rows: impl IntoIterator<Item = Vec<String>>,
    ) -> fmt::Result {
        write!(out, "<div class=\"wide\"><table><thead><tr>")?;
        for head in heads {
            write!(out, "<th scope=\"col\">{}</th>", Escaped(&self.text(head)))?;
        }
        writeln!(out, "</tr></thead><tbody>")?;
        for row in rows {
            write!(out, "<tr>")?;
            for (n, cell) in row.iter().enumerate() {
                match n {
                    0 => write!(out, "<th scope=\"row\">{cell}</th>")?,
                    _ => write!(out, "<td>{cell}</td>")?,
                }
            }
            writeln!(out, "</tr>")?;
        }
        writeln!(out, "</tbody></table></div>")
    }

    fn terminals(&self, out: &mut String) -> fmt::Result {
        let row = |one: &Terminal| {
            let networks: Vec<usize> = one.networks.split(", ").flat_map(str::parse).collect();
            vec![
                escaped(&one.terminal),
                escaped(&one.comment),
                escaped(&one.uses),
                links(&networks),
            ]
        };
        let heads = ["terminal", "comment", "use", "in-networks"];
        self.table(out, &heads, self.document.terminals.iter().map(row))
    }

    fn outputs(&self, out: &mut String) -> fmt::Result {
        let outputs = &self.document.outputs;
        if outputs.is_empty() {
            return writeln!(out, "<p>{}</p>", Escaped(&self.text("no-outputs")));
        }
        if outputs.iter().all(|output| output.why.is_empty()) {
            writeln!(out, "<p>{}</p>", Escaped(&self.text("rejected")))?;
        }
        outputs
            .iter()
            .try_for_each(|output| self.output(out, output))
    }

    fn output(&self, out: &mut String, output: &Output) -> fmt::Result {
        let (name, comment) = (Escaped(&output.name), Escaped(&output.comment));
        writeln!(
            out,
            "<div class=\"driven\"><h3 id=\"{name}\">{name} <small>{comment}</small></h3>"
        )?;
        for (n, why) in output.why.iter().enumerate() {
            if n > 0 {
                let comment = why.comment.as_deref().unwrap_or_default();
                let (name, comment) = (Escaped(&why.device), Escaped(comment));
                writeln!(out, "<h4>{name} <small>{comment}</small></h4>")?;
            }
            self.causes(out, why)?;
        }
        for &number in &output.networks {
            if let Some(network) = self.ladder.networks.get(number - 1) {
                writeln!(
                    out,
                    "<figure>{}</figure>",
                    self.painter.network(number, network)
                )?;
            }
        }
        writeln!(out, "</div>")
    }

    fn said<'s>(&self, text: &'s Phrase) -> Cow<'s, str> {
        phrase(self.language, text)
    }

    /// What can switch a device.
    fn causes(&self, out: &mut String, why: &Why) -> fmt::Result {
        for note in &why.notes {
            writeln!(out, "<p>{}</p>", Escaped(&self.said(note)))?;
        }
        for writer in &why.writers {
            let place = &writer.place;
            writeln!(
                out,
                "<p><code>{}</code> ({})</p>\n<dl><dt>{}</dt><dd>{}</dd>",
                Escaped(&place.instruction),
                links(&[place.network]),
                Escaped(&self.text("driven-if")),
                Escaped(&self.said(&writer.condition))
            )?;
            if let Some(executed) = &writer.executed_if {
                let executed_if = self.text("executed-if");
                write!(
                    out,
                    "<dt>{}</dt><dd>{}</dd>",
                    Escaped(&executed_if),
                    Escaped(&self.said(executed))
                )?;
            }
            writeln!(out, "</dl>")?;
            for note in &writer.notes {
                writeln!(out, "<p>{}</p>", Escaped(&self.said(note)))?;
            }
        }
        Ok(())
    }

    fn chart(&self) -> Option<Chart> {
        Chart::of(self.resolved, self.ladder)
    }

    fn write_chart(&self, out: &mut String) -> fmt::Result {
        match self.chart() {
            Some(chart) => writeln!(out, "<figure>{}</figure>", chart.svg()),
            None => Ok(()),
        }
    }

    fn timers(&self, out: &mut String) -> fmt::Result {
        let rows = self.document.timers.iter().map(|timer| {
            vec![
                escaped(&timer.name),
                escaped(&timer.comment),
                escaped(&timer.presets.join(", ")),
                timer.ms.map_or_else(String::new, time),
                links(&timer.networks),
            ]
        });
        self.table(
            out,
            &["device", "comment", "preset", "time", "in-networks"],
            rows,
        )
    }

    fn specials(&self, out: &mut String) -> fmt::Result {
        self.entries(out, "meaning", &self.document.specials)
    }

    /// Devices with where they are used; `text` is what stands beside their names.
    fn entries(&self, out: &mut String, text: &str, entries: &[Entry]) -> fmt::Result {
        let rows = entries.iter().map(|entry| {
            let networks: Vec<usize> = entry.uses.iter().map(|line| line.network).collect();
            vec![
                escaped(&entry.area.to_string()),
                escaped(&entry.comment),
                links(&networks),
            ]
        });
        self.table(out, &["device", text, "in-networks"], rows)
    }

    fn instructions(&self, out: &mut String) -> fmt::Result {
        let rows = self.document.instructions.iter().map(|one| {
            vec![
                escaped(one.mnemonic),
                escaped(one.title),
                links(&one.networks),
            ]
        });
        self.table(out, &["instruction", "meaning", "in-networks"], rows)
    }

    fn properties(&self, out: &mut String) -> fmt::Result {
        let properties = self.document.properties.iter();
        list(
            out,
            properties.map(|text| format!("<code>{}</code>", Escaped(text))),
        )
    }

    fn open(&self, out: &mut String) -> fmt::Result {
        let Document {
            findings, nameless, ..
        } = self.document;
        if findings.is_empty() && nameless.is_empty() {
            return writeln!(out, "<p>{}</p>", Escaped(&self.text("no-open")));
        }
        let nameless = (!nameless.is_empty()).then(|| {
            let names = nameless.join(", ");
            let counted = [("count", nameless.len().into()), ("names", (&names).into())];
            escaped(&message(self.language, "doc-nameless", &counted))
        });
        let found = findings.iter().map(|found| {
            let severity = found.severity.name();
            let line = found.to_string();
            let first = line.lines().next().unwrap_or_default();
            format!("<span class=\"{severity}\">{}</span>", Escaped(first))
        });
        list(out, nameless.into_iter().chain(found))
    }

    fn devices(&self, out: &mut String) -> fmt::Result {
        self.entries(out, "comment", &self.document.devices)
    }

    fn write_ladder(&self, out: &mut String) -> fmt::Result {
        for (number, network) in (1..).zip(&self.ladder.networks) {
            let picture = self.painter.network(number, network).to_string();
            write_section(out, self.resolved, (number, network), &picture)?;
        }
        Ok(())
    }
}

fn escaped(text: &str) -> String {
    Escaped(text).to_string()
}

fn list(out: &mut String, items: impl Iterator<Item = String>) -> fmt::Result {
    writeln!(out, "<ul>")?;
    for item in items {
        writeln!(out, "<li>{item}</li>")?;
    }
    writeln!(out, "</ul>")
}

/// Links to networks, each once.
fn links(networks: &[usize]) -> String {
    let mut networks = networks.to_vec();
    networks.sort_unstable();
    networks.dedup();
    let links: Vec<String> = networks
        .iter()
        .map(|number| format!("<a href=\"#n{number}\">{number}</a>"))
        .collect();
    links.join(", ")
}

/// `500 ms`, `3 s`.
fn time(ms: u64) -> String {
    match ms < 1000 {
        true => format!("{ms} ms"),
        false => format!("{} s", ms as f64 / 1000.0),
    }
}
