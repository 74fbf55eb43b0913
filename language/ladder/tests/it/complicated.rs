//! The most complicated networks of real programs: they are drawn whole, and their drawings read back.
//!
//! `RUNGC_PICTURES` names a folder for their pictures.

use crate::common;
use crate::common::programs_in;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_ladder::list::{Entry, Listed, instructions};
use rungc_ladder::svg::Painter;
use rungc_ladder::text::{Style, draw, draw_alike};
use rungc_ladder::{Item, Ladder, Network, NetworkBody, Node, Part, Series, build};
use rungc_syntax::Instr;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Numbers of contacts, coils and boxes of a network, and of branches.
#[derive(Clone, Copy, Default)]
struct Size {
    cells: usize,
    branches: usize,
}

impl Size {
    fn of(network: &Network) -> Size {
        let mut size = Size::default();
        if let NetworkBody::Rung(node) = &network.body {
            size.node(node);
        }
        size
    }

    fn node(&mut self, node: &Node) {
        self.series(&node.series);
        self.branches += node.items.len() - 1;
        for item in &node.items {
            match item {
                Item::Output(_) => self.cells += 1,
                Item::Continue(next) => self.node(next),
                Item::Stack(nodes) => {
                    self.branches += nodes.len() - 1;
                    nodes.iter().for_each(|node| self.node(node));
                }
            }
        }
    }

    fn series(&mut self, series: &Series) {
        for part in series {
            match part {
                Part::Contact(_) | Part::Result(_) => self.cells += 1,
                Part::Group(parts) => self.series(parts),
                Part::Parallel(branches) => {
                    self.branches += branches.len() - 1;
                    branches
                        .iter()
                        .for_each(|branch| self.series(&branch.series));
                }
            }
        }
    }

    fn complexity(self) -> usize {
        self.cells * (self.branches + 1)
    }
}

fn with<R>(program: &rungc_syntax::Program, then: impl FnOnce(&Resolved, &Ladder) -> R) -> R {
    let (resolved, _) = resolve(program, common::model(program));
    then(&resolved, &build::ladder(&resolved))
}

fn texts(instrs: &[Instr]) -> Vec<String> {
    instrs.iter().map(ToString::to_string).collect()
}

/// The list that a structure stands for has the mnemonics of the list that it was made from.
fn assert_inverse(resolved: &Resolved, ladder: &Ladder, network: &Network) {
    let one = Ladder {
        networks: vec![network.clone()],
    };
    assert!(ladder.networks.contains(network));
    let written = texts(&resolved.program.instrs[network.instrs.clone()]);
    let listed: Vec<String> = instructions(&one)
        .into_iter()
        .map(|listed| match listed {
            Listed::Contact(entry, instr) => {
                let text = resolved.program.instrs[instr].to_string();
                let start = match entry {
                    Entry::Ld => "LD",
                    Entry::And => "AN",
                    Entry::Or => "OR",
                };
                assert!(text.starts_with(start), "{text}: {entry:?}");
                text
            }
            Listed::Other(instr) => resolved.program.instrs[instr].to_string(),
            Listed::Anb => "ANB".to_string(),
            Listed::Orb => "ORB".to_string(),
            Listed::Mps => "MPS".to_string(),
            Listed::Mrd => "MRD".to_string(),
            Listed::Mpp => "MPP".to_string(),
        })
        .collect();
    assert_eq!(listed, written);
}

/// A network of a file.
struct Found {
    file: PathBuf,
    number: usize,
    size: Size,
    list: Vec<String>,
}

/// The most complicated networks of some files, each once.
fn most_complicated(files: &[PathBuf], count: usize) -> Vec<Found> {
    let mut found: Vec<Found> = Vec::new();
    for file in files {
        let Ok(read) = rungc_frontend::read(file) else {
            continue;
        };
        with(&read.program, |resolved, ladder| {
            for (number, network) in (1..).zip(&ladder.networks) {
                assert_inverse(resolved, ladder, network);
                found.push(Found {
                    file: file.clone(),
                    number,
                    size: Size::of(network),
                    list: texts(&read.program.instrs[network.instrs.clone()]),
                });
            }
        });
    }
    found.sort_by_key(|network| std::cmp::Reverse(network.size.complexity()));
    let mut seen = std::collections::HashSet::new();
    found.retain(|network| seen.insert(network.list.clone()));
    found.truncate(count);
    found
}

/// Draws a network at several widths and reads it back.
fn check(found: &Found, place: usize) {
    let read = rungc_frontend::read(&found.file).unwrap();
    with(&read.program, |resolved, ladder| {
        let network = &ladder.networks[found.number - 1];
        for width in [80, 120, 250] {
            let style = Style {
                width,
                comments: true,
            };
            let drawn = draw(resolved, &[(found.number, network)], style);
            let plain = draw_alike(&[(resolved, network)], style).concat();
            let again = rungc_frontend::read_bytes("drawn", plain.as_bytes()).unwrap();
            let messages: Vec<_> = again.diagnostics.iter().map(|d| &d.message).collect();
            assert!(messages.is_empty(), "{drawn}\n{messages:?}");
            assert_eq!(texts(&again.program.instrs), found.list, "{drawn}");
        }
        let painter = Painter::new(resolved, &[(found.number, network)], 104);
        let picture = painter.sheet(&[(found.number, network)]).to_string();
        if let Some(folder) = env::var_os("RUNGC_PICTURES") {
            let name = format!("complicated-{place}.svg");
            fs::write(Path::new(&folder).join(name), picture).unwrap();
        }
    });
}

#[test]
fn the_most_complicated_networks_are_drawn_and_read_back() {
    let root = Path::new(env!("RUNGC_ROOT"));
    let mut files = Vec::new();
    for folder in [
        "examples",
        "../shared/corpus",
        "../shared/projects",
        "../shared/fx-images",
    ] {
        programs_in(&root.join(folder), &mut files);
    }
    let found = most_complicated(&files, 60);
    assert!(found.len() > 10, "{} networks", found.len());
    for (place, network) in (1..).zip(&found) {
        let Size { cells, branches } = network.size;
        let (file, number) = (network.file.display(), network.number);
        println!("{place}: {file}, network {number}: {cells} cells, {branches} branches");
        check(network, place);
    }
}
