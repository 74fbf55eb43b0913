//! Pages that rungc carries: the book, and manual pages.

use crate::common::{code, folder, rungc, text};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Names of the commands that `rungc --help` lists.
fn commands(folder: &Path) -> Vec<String> {
    let help = text(&rungc(folder, &["--help"]).stdout);
    let (_, listed) = help.split_once("Commands:\n").unwrap();
    let lines = listed.lines().take_while(|line| !line.is_empty());
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next());
    names.map(str::to_string).collect()
}

/// Names after `rungc book` in a text.
fn pointers(text: &str) -> Vec<String> {
    // Help is wrapped to the terminal's width.
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let after = text.split("`rungc book ").skip(1);
    after
        .filter_map(|rest| Some(rest.split_once('`')?.0.to_string()))
        .collect()
}

#[test]
fn help_and_explanations_point_to_pages_that_rungc_has() {
    let folder = folder(&[("p.il", b"LD X000\nOUT Y000\nEND\n")]);
    let path = folder.path();
    let print = |args: &[&str]| {
        let output = rungc(path, args);
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        text(&output.stdout)
    };
    let mut texts = vec![print(&["--help"])];
    for name in commands(path) {
        if name != "help" {
            texts.push(print(&[&name, "--help"]));
        }
    }
    let checks = Path::new(env!("RUNGC_ROOT")).join("docs/src/checks");
    for entry in fs::read_dir(checks).unwrap() {
        let file = entry.unwrap().file_name().into_string().unwrap();
        if let Some(code) = file.strip_suffix(".md").filter(|name| *name != "index") {
            texts.push(print(&["explain", code]));
        }
    }
    for topic in ["h2u", "fx3u", "h2u-mtq", "ADD", "M8000", "6706"] {
        texts.push(print(&["explain", topic]));
    }
    for board in ["pico", "fx3u-f103vc"] {
        texts.push(print(&["boards", board, "--toml"]));
    }
    print(&["init"]);
    texts.push(fs::read_to_string(path.join("rungc.toml")).unwrap());
    let mut named = BTreeSet::new();
    for text in texts {
        assert!(!text.contains("docs/src"), "{text}");
        named.extend(pointers(&text));
    }
    assert!(named.len() > 15, "{named:?}");
    named.remove("PAGE");
    assert!(named.contains("instructions/support"), "{named:?}");
    for name in named {
        assert!(print(&["book", &name]).starts_with("# "), "{name}");
    }
}

#[test]
fn the_book_lists_and_prints_its_pages() {
    let folder = folder(&[]);
    let path = folder.path();
    let print = |args: &[&str]| text(&rungc(path, args).stdout);
    let list = print(&["book"]);
    let listed: Vec<_> = list.lines().filter(|line| line.starts_with("  ")).collect();
    let names = listed
        .iter()
        .filter_map(|line| line.split_whitespace().next());
    let mut count = 0;
    for name in names {
        assert!(print(&["book", name]).starts_with("# "), "{name}");
        count += 1;
    }
    assert!(count > 50, "{list}");
    let page = print(&["book", "serve"]);
    for other in ["docs/src/serve.md", "serve.md", "serve.md#can", "Serve"] {
        assert_eq!(print(&["book", other]), page, "{other}");
    }
    assert_eq!(print(&["explain", "serve"]), page);
    assert_eq!(
        print(&["book", "checks/E0106"]),
        print(&["explain", "E0106"])
    );
    let wrong = rungc(path, &["book", "serv"]);
    assert_eq!(wrong.status.code(), Some(2));
    let said = text(&wrong.stderr);
    assert!(said.contains("did you mean `serve`?"), "{said}");
    assert_eq!(code(path, &["book", "nothing-like-it"]), 2);
}

#[test]
fn every_command_has_a_manual_page() {
    let folder = folder(&[]);
    let path = folder.path();
    let page = |args: &[&str]| text(&rungc(path, args).stdout);
    assert!(page(&["man"]).contains(".TH rungc 1"));
    for name in commands(path).iter().filter(|name| *name != "help") {
        let page = page(&["man", name]);
        assert!(page.contains(&format!(".TH rungc-{name} 1")), "{page}");
        let source = concat!("\"rungc ", env!("CARGO_PKG_VERSION"), "\"");
        assert!(page.contains(source), "{page}");
        assert!(page.contains(".SH OPTIONS"), "{page}");
    }
    assert_eq!(code(path, &["man", "nothing"]), 2);
}
