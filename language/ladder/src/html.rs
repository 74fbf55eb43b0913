//! A page with the ladder of a program: pictures of all networks, a list of them, and where each device is used. One
//! file that needs nothing else.

use crate::face::device_of;
use crate::network::{Ladder, Network};
use crate::sfc::Chart;
use crate::svg::Painter;
use quick_xml::escape::escape;
use rungc_analysis::resolve::Resolved;
use rungc_syntax::Device;
use rungc_syntax::text::one_line;
use std::collections::BTreeMap;
use std::fmt::{self, Write as _};

mod comparison;

pub use comparison::comparison;

/// The style of pages with ladders.
pub static STYLE: &str = include_str!("page/page.css");
const SCRIPT: &str = include_str!("page/page.js");
/// Characters of a line; a page of A4 has room for them.
const WIDTH: usize = 104;

/// The page of a program, with lines of about `width` characters; a page of A4 has room for 104.
pub fn page(title: &str, resolved: &Resolved, ladder: &Ladder, width: usize) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut out, title, resolved, ladder, width);
    out
}

fn write_page(
    out: &mut String,
    title: &str,
    resolved: &Resolved,
    ladder: &Ladder,
    width: usize,
) -> fmt::Result {
    let title = Escaped(title);
    let model = resolved.model.name.to_uppercase();
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#ladder\">Skip to the ladder</a>\n<header>\n\
         <h1>{title}</h1>\n<p>{model}, {} steps, {} networks</p>\n\
         <label>Search <input id=\"search\" type=\"search\" placeholder=\"device, comment, instruction\"></label>\n\
         <button id=\"theme\" type=\"button\">Light or dark</button>\n</header>",
        resolved.steps,
        ladder.networks.len()
    )?;
    let uses = uses(resolved, ladder);
    let chart = Chart::of(resolved, ladder);
    write_devices(out, resolved, &uses)?;
    write_list(out, resolved, ladder, chart.as_ref())?;
    let networks: Vec<_> = (1..).zip(&ladder.networks).collect();
    let painter = Painter::new(resolved, &networks, width);
    writeln!(out, "<main id=\"ladder\" tabindex=\"-1\">")?;
    if let Some(chart) = &chart {
        let picture = chart.svg().to_string();
        let group = "role=\"group\" aria-label=\"Sequential function chart\"";
        let picture = picture.replacen("role=\"img\"", group, 1);
        writeln!(out, "<figure id=\"sfc\" tabindex=\"0\">{picture}</figure>")?;
    }
    for (number, network) in &networks {
        let picture = painter.network(*number, network).to_string();
        write_section(out, resolved, (*number, network), &picture)?;
    }
    writeln!(
        out,
        "</main>\n<script type=\"module\">\n{SCRIPT}</script>\n</body>\n</html>"
    )
}

/// A network: its statements, and its picture.
///
/// # Errors
/// Those of the writer.
pub fn write_section(
    out: &mut String,
    resolved: &Resolved,
    (number, network): (usize, &Network),
    picture: &str,
) -> fmt::Result {
    let instrs = &resolved.program.instrs[network.instrs.clone()];
    write!(
        out,
        "<section id=\"n{number}\" aria-label=\"Network {number}\">"
    )?;
    for statement in instrs.iter().filter_map(|instr| instr.statement()) {
        write!(out, "<p class=\"statement\">{}</p>", Escaped(statement))?;
    }
    let list: Vec<String> = instrs.iter().map(ToString::to_string).collect();
    write_picture(out, picture, &list)?;
    writeln!(out, "</section>")
}

/// The picture of a network, which its list describes to those who do not see it.
fn write_picture(out: &mut String, picture: &str, list: &[String]) -> fmt::Result {
    let label = Escaped(&list.join("; ")).to_string();
    let labelled = format!("role=\"img\" aria-label=\"{label}\"");
    out.write_str(&picture.replacen("role=\"img\"", &labelled, 1))
}

/// The networks that name each device, by their numbers.
pub(crate) fn uses(resolved: &Resolved, ladder: &Ladder) -> BTreeMap<Device, Vec<usize>> {
    let mut uses: BTreeMap<Device, Vec<usize>> = BTreeMap::new();
    for (number, network) in (1..).zip(&ladder.networks) {
        let instrs = &resolved.program.instrs[network.instrs.clone()];
        for operand in instrs.iter().flat_map(|instr| &instr.operands) {
            if let Some(device) = device_of(&operand.kind) {
                let numbers = uses.entry(device).or_default();
                if numbers.last() != Some(&number) {
                    numbers.push(number);
                }
            }
        }
    }
    uses
}

fn write_devices(
    out: &mut String,
    resolved: &Resolved,
    uses: &BTreeMap<Device, Vec<usize>>,
) -> fmt::Result {
    writeln!(
        out,
        "<aside aria-label=\"Devices\">\n<details id=\"devices\">\n<summary>Devices ({})</summary>\n<table>\n<thead><tr><th scope=\"col\">Device</th><th scope=\"col\">Comment</th>\
         <th scope=\"col\">Networks</th></tr></thead>\n<tbody>",
        uses.len()
    )?;
    for (device, numbers) in uses {
        let comment = resolved
            .program
            .comments
            .get(device)
            .map_or("", String::as_str);
        write!(
            out,
            "<tr data-device=\"{device}\" data-comment=\"{0}\"><th scope=\"row\"><button type=\"button\">{device}</button></th><td>{0}</td><td>",
            Escaped(comment)
        )?;
        for number in numbers {
            write!(out, "<a href=\"#n{number}\">{number}</a> ")?;
        }
        writeln!(out, "</td></tr>")?;
    }
    writeln!(out, "</tbody>\n</table>\n</details>\n</aside>")
}

/// The list of states, and that of networks.
fn write_list(
    out: &mut String,
    resolved: &Resolved,
    ladder: &Ladder,
    chart: Option<&Chart>,
) -> fmt::Result {
    writeln!(out, "<nav aria-label=\"Networks\">")?;
    if let Some(chart) = chart {
        write_states(out, chart)?;
    }
    write_networks(out, resolved, ladder)?;
    writeln!(out, "</nav>")
}

/// The list of networks: number, step, and what each is headed or begins with.
///
/// # Errors
/// Those of the writer.
pub fn write_networks(out: &mut String, resolved: &Resolved, ladder: &Ladder) -> fmt::Result {
    writeln!(out, "<ol>")?;
    for (number, network) in (1..).zip(&ladder.networks) {
        let instrs = &resolved.program.instrs[network.instrs.clone()];
        let heading = instrs.iter().find_map(|instr| instr.statement());
        let last = instrs.last().map(ToString::to_string).unwrap_or_default();
        let heading = heading.map_or(last, |heading| {
            heading.lines().next().unwrap_or("").to_string()
        });
        let step = resolved.instrs[network.instrs.start].step;
        writeln!(
            out,
            "<li><a href=\"#n{number}\"><b>{step}</b> {}</a></li>",
            Escaped(&heading)
        )?;
    }
    writeln!(out, "</ol>")
}

fn write_states(out: &mut String, chart: &Chart) -> fmt::Result {
    let count = chart.states.len();
    writeln!(
        out,
        "<details open>\n<summary>States ({count})</summary>\n<ul>\n<li><a href=\"#sfc\">Chart</a></li>"
    )?;
    for state in &chart.states {
        let name = Escaped(state.name.as_deref().unwrap_or(""));
        let (device, network) = (state.device, state.network);
        writeln!(
            out,
            "<li><a href=\"#n{network}\"><b>{device}</b> {name}</a></li>"
        )?;
    }
    writeln!(out, "</ul>\n</details>")
}

/// Text within HTML, without characters that would act on its reader.
pub struct Escaped<'a>(pub &'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&escape(one_line(self.0)))
    }
}
