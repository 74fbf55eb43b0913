//! A page that compares two programs: the old and the new picture of each network that differs.

use super::{Escaped, STYLE, WIDTH, write_picture};
use crate::compare::{Comparison, Differing, Drawn};
use crate::svg::Painter;
use std::fmt::{self, Display, Write as _};

const OWN_STYLE: &str = include_str!("../page/comparison.css");

/// The page of a comparison. `names` are those of the old and the new program; `summary` stands above the networks.
pub fn comparison(
    names: [&str; 2],
    sides: [Drawn; 2],
    comparison: &Comparison,
    summary: &str,
) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut out, names, sides, comparison, summary);
    out
}

fn write_page(
    out: &mut String,
    names: [&str; 2],
    sides: [Drawn; 2],
    comparison: &Comparison,
    summary: &str,
) -> fmt::Result {
    let [old, new] = names.map(Escaped);
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{old} → {new}</title>\n<style>\n{STYLE}{OWN_STYLE}</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#ladder\">Skip to the networks</a>\n<header>\n\
         <h1>{old} → {new}</h1>\n<p>{}</p>\n</header>",
        Escaped(&summary.replace('\n', " · "))
    )?;
    writeln!(out, "<nav aria-label=\"Networks\">\n<ul>")?;
    for (i, change) in comparison.networks.iter().enumerate() {
        writeln!(out, "<li><a href=\"#c{i}\">{}</a></li>", change.title())?;
    }
    writeln!(out, "</ul>\n</nav>\n<main id=\"ladder\" tabindex=\"-1\">")?;
    let networks = sides.map(|side| (1..).zip(&side.ladder.networks).collect::<Vec<_>>());
    let painters = [0, 1].map(|side| Painter::new(sides[side].resolved, &networks[side], WIDTH));
    for (i, change) in comparison.networks.iter().enumerate() {
        let title = change.title();
        writeln!(
            out,
            "<section id=\"c{i}\" aria-label=\"{title}\">\n<h2>{title}</h2>"
        )?;
        for (side, (class, place)) in ["old", "new"].into_iter().zip(change.shown()).enumerate() {
            let Some(at) = place else { continue };
            writeln!(out, "<div class=\"{class}\">")?;
            for instr in
                &sides[side].resolved.program.instrs[sides[side].network(at).instrs.clone()]
            {
                for text in [instr.statement(), instr.note()].into_iter().flatten() {
                    writeln!(out, "<p class=\"statement\">{}</p>", Escaped(text))?;
                }
            }
            let picture = painters[side].network(at + 1, sides[side].network(at));
            write_picture(out, &picture.to_string(), &sides[side].instructions(at))?;
            writeln!(out, "</div>")?;
        }
        writeln!(out, "</section>")?;
    }
    write_table(out, "Device comments", &comparison.comments)?;
    write_table(out, "Settings", &comparison.parameters)?;
    writeln!(out, "</main>\n</body>\n</html>")
}

fn write_table<K: Display>(out: &mut String, title: &str, rows: &[Differing<K>]) -> fmt::Result {
    if rows.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "<section aria-label=\"{title}\">\n<h2>{title}</h2>\n<table>\n<thead><tr><th scope=\"col\">Of</th><th scope=\"col\">Before</th><th scope=\"col\">Now</th></tr></thead>\n<tbody>"
    )?;
    for Differing { key, old, new } in rows {
        let [old, new] = [old, new].map(|value| value.as_deref().unwrap_or(""));
        writeln!(
            out,
            "<tr><th scope=\"row\">{key}</th><td class=\"old\">{}</td><td class=\"new\">{}</td></tr>",
            Escaped(old),
            Escaped(new)
        )?;
    }
    writeln!(out, "</tbody>\n</table>\n</section>")
}
