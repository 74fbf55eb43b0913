//! A cross reference as a page that needs nothing else.

use rungc::xref::{Entry, Table};
use rungc_ladder::html::Escaped;
use std::fmt::{self, Write};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The page of a program.
pub fn page(title: &str, table: &Table) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut out, title, table);
    out
}

fn write_page(out: &mut String, title: &str, table: &Table) -> fmt::Result {
    let title = Escaped(title);
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}: cross reference</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<h1>{title}: cross reference</h1>\n<p>{}</p>\n\
         <label>Search <input id=\"search\" type=\"search\" placeholder=\"device, comment, instruction\"></label>\n</header>\n<main>\n\
         <table>\n<thead><tr><th scope=\"col\">Device</th><th scope=\"col\">Comment</th><th scope=\"col\">Uses</th></tr></thead>\n\
         <tbody id=\"devices\">",
        table.model.to_uppercase()
    )?;
    for entry in &table.devices {
        write_entry(out, entry)?;
    }
    writeln!(out, "</tbody>\n</table>")?;
    if !table.overlaps.is_empty() {
        writeln!(out, "<h2>Areas that overlap</h2>\n<ul>")?;
        for overlap in &table.overlaps {
            let lines = [&overlap.first, &overlap.second].map(ToString::to_string);
            let [first, second] = lines.each_ref().map(|line| Escaped(line));
            writeln!(
                out,
                "<li>{}<pre>{first}\n{second}</pre></li>",
                overlap.shared
            )?;
        }
        writeln!(out, "</ul>")?;
    }
    if !table.unused.is_empty() {
        let areas: Vec<_> = table.unused.iter().map(ToString::to_string).collect();
        writeln!(out, "<h2>Unused</h2>\n<p>{}</p>", areas.join(", "))?;
    }
    writeln!(
        out,
        "</main>\n<script type=\"module\">\n{SCRIPT}</script>\n</body>\n</html>"
    )
}

fn write_entry(out: &mut String, entry: &Entry) -> fmt::Result {
    let Entry {
        area,
        comment,
        uses,
    } = entry;
    write!(
        out,
        "<tr><th scope=\"row\">{area}</th><td>{}</td><td><pre>",
        Escaped(comment)
    )?;
    for line in uses {
        writeln!(out, "{}", Escaped(&line.to_string()))?;
    }
    writeln!(out, "</pre></td></tr>")
}
