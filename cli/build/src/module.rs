//! An emitted crate as one module.

use proc_macro2::{Group, TokenStream, TokenTree};
use rungc::{OutFile, Program};
use std::collections::BTreeMap;
use syn::parse::Parser;
use syn::{AttrStyle, Attribute, File, Item};

/// The code of a program as the contents of a module, whose name and place its user chooses. It needs `rungc-rt`.
///
/// # Panics
/// Does not: emitted code is Rust.
pub fn code(program: &Program) -> String {
    let files = program.emit_rust();
    let modules: Modules = files
        .iter()
        .filter_map(|file| {
            let path = file.path.strip_prefix("src/")?.strip_suffix(".rs")?;
            Some((path.strip_suffix("/mod").unwrap_or(path), file))
        })
        .collect();
    let mut root = parsed(modules["lib"], 0);
    // What is said of the crate does not hold for a module of another one.
    root.attrs.clear();
    // No one uses all of it.
    root.items
        .iter_mut()
        .filter_map(attributes)
        .for_each(|attributes| attributes.extend(unused()));
    fill(&mut root.items, "", 1, &modules);
    prettyplease::unparse(&root)
}

/// Files by the paths of their modules: `program/part1`.
type Modules<'f> = BTreeMap<&'f str, &'f OutFile>;

fn parsed(file: &OutFile, depth: usize) -> File {
    let tokens: TokenStream = file.contents.parse().expect("emitted code is Rust");
    syn::parse2(within(tokens, depth)).expect("emitted code is Rust")
}

/// Puts modules in separate files into the module at this path; theirs are at this depth.
fn fill(items: &mut [Item], path: &str, depth: usize, modules: &Modules) {
    for item in items {
        if let Item::Mod(module) = item {
            let path = format!("{path}{}", module.ident);
            let Some(file) = modules.get(path.as_str()) else {
                continue;
            };
            let File {
                attrs, mut items, ..
            } = parsed(file, depth);
            fill(&mut items, &format!("{path}/"), depth + 1, modules);
            module.attrs.extend(attrs.into_iter().map(outer));
            module.content = Some((syn::token::Brace::default(), items));
            module.semi = None;
        }
    }
}

/// The attributes of what the compiler may call unused.
fn attributes(item: &mut Item) -> Option<&mut Vec<Attribute>> {
    Some(match item {
        Item::Const(item) => &mut item.attrs,
        Item::Enum(item) => &mut item.attrs,
        Item::Fn(item) => &mut item.attrs,
        Item::Impl(item) => &mut item.attrs,
        Item::Mod(item) => &mut item.attrs,
        Item::Static(item) => &mut item.attrs,
        Item::Struct(item) => &mut item.attrs,
        Item::Type(item) => &mut item.attrs,
        _ => return None,
    })
}

fn unused() -> Vec<Attribute> {
    let read = Attribute::parse_outer.parse_str("#[allow(dead_code)]");
    read.expect("an attribute")
}

/// An attribute of a file as that of its module.
fn outer(attribute: Attribute) -> Attribute {
    Attribute {
        style: AttrStyle::Outer,
        ..attribute
    }
}

/// Code of a module at this depth, in which paths from the crate's root begin with the module at depth 0 instead.
fn within(tokens: TokenStream, depth: usize) -> TokenStream {
    let mut rest = tokens.into_iter().peekable();
    let mut moved = TokenStream::new();
    while let Some(token) = rest.next() {
        let is_path = matches!(rest.peek(), Some(TokenTree::Punct(next)) if next.as_char() == ':');
        match token {
            TokenTree::Ident(name) if name == "crate" && is_path => moved.extend(root(depth)),
            TokenTree::Group(group) => {
                let inner = Group::new(group.delimiter(), within(group.stream(), depth));
                moved.extend([TokenTree::from(inner)]);
            }
            other => moved.extend([other]),
        }
    }
    moved
}

/// The path from a module at this depth to the one at depth 0: `super::super`.
fn root(depth: usize) -> TokenStream {
    let path = match depth {
        0 => "self".to_string(),
        depth => vec!["super"; depth].join("::"),
    };
    path.parse().expect("a path")
}
