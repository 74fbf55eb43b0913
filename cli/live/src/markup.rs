//! The page itself: the networks of a program, and the places for what changes. What changes comes as events.

use crate::asset;
use crate::scene::Scene;
use rungc_analysis::resolve::Resolved;
use rungc_ladder::Ladder;
use rungc_ladder::html::{self, Escaped};
use std::fmt::{self, Write as _};

/// The page of a program, and what says where power flows in it.
pub fn page(title: &str, resolved: &Resolved, ladder: &Ladder, read_only: bool) -> (String, Scene) {
    let (scene, pictures) = Scene::new(resolved, ladder);
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut out, title, resolved, ladder, &pictures, read_only);
    (out, scene)
}

fn write_page(
    out: &mut String,
    title: &str,
    resolved: &Resolved,
    ladder: &Ladder,
    pictures: &[String],
    read_only: bool,
) -> fmt::Result {
    let title = Escaped(title);
    let model = resolved.model.name.to_uppercase();
    let (steps, count) = (resolved.steps, ladder.networks.len());
    let (controls, panels) = (asset!("controls.html"), asset!("panels.html"));
    let class = if read_only {
        " class=\"read-only\""
    } else {
        ""
    };
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"ladder.css\">\n\
         <link rel=\"stylesheet\" href=\"live.css\">\n<script type=\"module\" src=\"live.js\"></script>\n</head>\n\
         <body{class}>\n<a class=\"skip\" href=\"#ladder\">Skip to the ladder</a>\n<header>\n<h1>{title}</h1>\n\
         <p>{model}, {steps} steps, {count} networks</p>\n{controls}</header>"
    )?;
    writeln!(out, "<nav aria-label=\"Networks\">")?;
    html::write_networks(out, resolved, ladder)?;
    writeln!(out, "</nav>\n{panels}<main id=\"ladder\" tabindex=\"-1\">")?;
    for ((number, network), picture) in (1..).zip(&ladder.networks).zip(pictures) {
        html::write_section(out, resolved, (number, network), picture)?;
    }
    writeln!(out, "</main>\n</body>\n</html>")
}
