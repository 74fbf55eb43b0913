//! Links of the documentation lead somewhere: files exist, headings too, and the book's table of contents lists every
//! page.

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use walkdir::WalkDir;

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

/// All files below the root with this extension, without build folders.
fn files(extension: &str) -> Vec<PathBuf> {
    let is_source = |entry: &walkdir::DirEntry| {
        let name = entry.file_name().to_string_lossy();
        let hidden = name.starts_with('.') && entry.depth() > 0;
        let is_book = entry.path().ends_with("docs/book");
        !hidden && !is_book && name != "target" && name != "node_modules"
    };
    let entries = WalkDir::new(root()).into_iter().filter_entry(is_source);
    let paths = entries.map(|entry| entry.unwrap().into_path());
    let wanted: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .collect();
    assert!(!wanted.is_empty());
    wanted
}

/// The text of a page with `{{#include FILE}}` or `{{#include FILE:ANCHOR}}` resolved as far as links need it: includes
/// are checked to exist and their content is checked where it is at home.
fn included(path: &Path, text: &str, broken: &mut Vec<String>) {
    for part in text.split("{{#include ").skip(1) {
        let target = part.split("}}").next().unwrap();
        let (file, anchor) = target
            .split_once(".md:")
            .map_or((target.to_owned(), None), |(file, anchor)| {
                (format!("{file}.md"), Some(anchor))
            });
        let found = fs::read_to_string(path.parent().unwrap().join(&file));
        let marked =
            |text: &String| anchor.is_none_or(|name| text.contains(&format!("ANCHOR: {name} ")));
        if !found.is_ok_and(|text| marked(&text)) {
            broken.push(format!("{}: include {target}", path.display()));
        }
    }
}

/// Links and anchors of a page.
#[derive(Default)]
struct Page {
    links: Vec<String>,
    anchors: BTreeSet<String>,
}

fn page(text: &str) -> Page {
    let mut page = Page::default();
    let mut heading: Option<String> = None;
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                page.links.push(dest_url.into_string());
            }
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                let slug = slug(&heading.take().unwrap());
                page.anchors.insert(slug);
            }
            Event::Text(text) | Event::Code(text) => {
                if let Some(heading) = &mut heading {
                    *heading += &text;
                }
            }
            Event::Html(html) | Event::InlineHtml(html) => {
                let ids = html.split("<a id=\"").skip(1);
                let ids = ids.filter_map(|part| part.split('"').next());
                page.anchors.extend(ids.map(str::to_owned));
            }
            _ => {}
        }
    }
    page
}

/// The identifier of a heading, as mdBook and GitHub make it.
fn slug(heading: &str) -> String {
    let kept = heading.chars().filter_map(|c| match c {
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c.to_lowercase().to_string()),
        c if c.is_whitespace() => Some("-".to_owned()),
        _ => None,
    });
    kept.collect()
}

#[test]
fn links_lead_somewhere() {
    let mut broken = Vec::new();
    let mut checked = 0;
    for path in files("md") {
        let text = fs::read_to_string(&path).unwrap();
        included(&path, &text, &mut broken);
        for link in page(&text).links {
            if link.contains("://") {
                continue;
            }
            checked += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = match file {
                "" => path.clone(),
                file => path.parent().unwrap().join(file),
            };
            let has_anchor = || {
                page(&fs::read_to_string(&target).unwrap())
                    .anchors
                    .contains(anchor)
            };
            if !target.exists() || !(anchor.is_empty() || has_anchor()) {
                broken.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(broken.is_empty(), "broken links:\n{}", broken.join("\n"));
    assert!(checked > 300, "only {checked} links were found");
}

#[test]
fn the_table_of_contents_lists_every_page() {
    let source = root().join("docs/src");
    let summary = fs::read_to_string(source.join("SUMMARY.md")).unwrap();
    let listed: BTreeSet<_> = page(&summary)
        .links
        .into_iter()
        .map(|link| source.join(link))
        .collect();
    let pages = files("md")
        .into_iter()
        .filter(|path| path.starts_with(&source) && !path.ends_with("SUMMARY.md"));
    let pages: BTreeSet<_> = pages.collect();
    let differ: Vec<_> = listed.symmetric_difference(&pages).collect();
    assert!(
        differ.is_empty(),
        "listed without a page, or not listed: {differ:?}"
    );
}

/// Help texts, messages and comments name pages of the book by their paths.
#[test]
fn pages_that_sources_name_exist() {
    let mut missing = Vec::new();
    for path in ["rs", "toml", "il"].into_iter().flat_map(files) {
        let text = fs::read_to_string(&path).unwrap();
        for part in text.split("docs/src/").skip(1) {
            let name: String = part
                .chars()
                .take_while(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | '/'))
                .collect();
            let name = name.trim_end_matches('.');
            if name.ends_with(".md") && !root().join("docs/src").join(name).exists() {
                missing.push(format!("{}: docs/src/{name}", path.display()));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}
