//! Coverage drawn on the ladder: a page that needs nothing else.

use crate::Covered;
use crate::text::share;
use rungc_analysis::resolve::Resolved;
use rungc_ladder::html::{Escaped, STYLE, write_section};
use rungc_ladder::layout::Cell;
use rungc_ladder::svg::Painter;
use rungc_ladder::{Ladder, Network};
use std::fmt::{self, Write};

/// Characters of a line.
const WIDTH: usize = 104;

/// Style of an instruction that was reached in part, beside its colour.
const COVERED: &str = include_str!("coverage.css");

/// The page of all programs.
pub fn page(programs: &[Covered]) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut out, programs);
    out
}

fn write_page(out: &mut String, programs: &[Covered]) -> fmt::Result {
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Coverage</title>\n<style>\n{STYLE}{COVERED}</style>\n</head>\n<body>\n<header><h1>Coverage</h1>\n\
         <p><span class=\"key all\">all reached</span> <span class=\"key some\">some reached</span> <span class=\"key none\">nothing reached</span></p></header>\n<main>"
    )?;
    for (number, program) in (1..).zip(programs) {
        let share = share(program.reached(), program.goals.len());
        writeln!(out, "<h2>{}: {share}</h2>", Escaped(&program.name))?;
        program
            .drawn(|resolved, ladder| write_program(out, (number, program), resolved, ladder))?;
    }
    writeln!(out, "</main>\n</body>\n</html>")
}

fn write_program(
    out: &mut String,
    (place, program): (usize, &Covered),
    resolved: &Resolved,
    ladder: &Ladder,
) -> fmt::Result {
    let networks: Vec<_> = (1..).zip(&ladder.networks).collect();
    let painter = Painter::new(resolved, &networks, WIDTH);
    for &(number, network) in &networks {
        let (picture, circuit) = painter.live(number, network);
        let mut picture = picture.to_string();
        let links = circuit.map_or(Vec::new(), |circuit| circuit.links);
        for (i, link) in links.iter().enumerate() {
            let instr = match link.cell {
                Cell::Contact(contact) => contact.instr,
                Cell::Output(output) => output.instr,
                Cell::Result(_) | Cell::FoldOut(_) | Cell::FoldIn(_) => continue,
            };
            if let Some(class) = class(program, instr) {
                let plain = format!("data-link=\"{i}\"");
                picture = picture.replace(&plain, &format!("{plain} class=\"{class}\""));
            }
        }
        let mut section = String::new();
        write_section(&mut section, resolved, (number, network), &picture)?;
        // Several programs stand on the page.
        let section = section.replacen("id=\"n", &format!("id=\"p{place}n"), 1);
        let section = section.replacen(
            "aria-label=\"",
            &format!("aria-label=\"Program {place}, "),
            1,
        );
        out.push_str(section.trim_end().trim_end_matches("</section>"));
        write_missed(out, program, network)?;
        writeln!(out, "</section>")?;
    }
    Ok(())
}

/// The class of an instruction of which something can be reached.
fn class(program: &Covered, instr: usize) -> Option<&'static str> {
    let goals = program.goals.iter().filter(|goal| goal.instr == instr);
    let goals = goals.filter(|goal| goal.what != crate::What::Executed);
    let reached: Vec<bool> = goals.map(|goal| program.is_reached(goal)).collect();
    match reached.iter().filter(|reached| **reached).count() {
        _ if reached.is_empty() => None,
        0 => Some("none"),
        count if count == reached.len() => Some("all"),
        _ => Some("some"),
    }
}

/// In words what the colours show.
fn write_missed(out: &mut String, program: &Covered, network: &Network) -> fmt::Result {
    let missed = program.missed(network.instrs.clone());
    if missed.is_empty() {
        return Ok(());
    }
    writeln!(out, "<ul class=\"missed\">")?;
    for goal in missed {
        let instr = program.program.instrs[goal.instr].to_string();
        writeln!(out, "<li>{} {}</li>", Escaped(&instr), goal.what.missing())?;
    }
    writeln!(out, "</ul>")
}
