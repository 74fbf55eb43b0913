//! Ladders of real and random programs: drawing and reading are inverse, and pictures look right.

use crate::common;
use crate::common::programs_in;
use proptest::prelude::*;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_catalogue::{Basic, Join, Lower};
use rungc_ladder::list::{Entry, Listed, instructions};
use rungc_ladder::sfc::Chart;
use rungc_ladder::svg::Painter;
use rungc_ladder::text::{Style, draw, draw_alike};
use rungc_ladder::{Ladder, Network, NetworkBody, build, html, pdf};
use rungc_models::{Model, ModelId};
use rungc_syntax::{Instr, Program};
use std::path::Path;

fn read(list: &str) -> Program {
    rungc_frontend::read_text("list.il", list).program
}

fn with<R>(program: &Program, then: impl FnOnce(&Resolved, &Ladder) -> R) -> R {
    with_model(program, Model::get(ModelId::Fx3u), then)
}

fn with_model<R>(
    program: &Program,
    model: &'static Model,
    then: impl FnOnce(&Resolved, &Ladder) -> R,
) -> R {
    let (resolved, _) = resolve(program, model);
    then(&resolved, &build::ladder(&resolved))
}

fn numbered(ladder: &Ladder) -> Vec<(usize, &Network)> {
    (1..).zip(&ladder.networks).collect()
}

fn picture(list: &str) -> String {
    with(&read(list), |resolved, ladder| {
        let style = Style {
            width: 100,
            comments: true,
        };
        draw(resolved, &numbered(ladder), style)
    })
}

/// Asserts that the list of a ladder is the program.
fn assert_inverse(program: &Program, name: &str) {
    with(program, |resolved, ladder| {
        let list = instructions(ladder);
        assert_eq!(list.len(), program.instrs.len(), "{name}");
        for (i, listed) in list.iter().enumerate() {
            let same = match (*listed, resolved.instrs[i].lower) {
                (Listed::Other(instr), _) => instr == i,
                (Listed::Contact(entry, instr), Some(lower)) => {
                    instr == i && Some(entry) == entry_of(lower)
                }
                (Listed::Anb, Some(Lower::Basic(Basic::Anb)))
                | (Listed::Orb, Some(Lower::Basic(Basic::Orb)))
                | (Listed::Mps, Some(Lower::Basic(Basic::Mps)))
                | (Listed::Mrd, Some(Lower::Basic(Basic::Mrd)))
                | (Listed::Mpp, Some(Lower::Basic(Basic::Mpp))) => true,
                _ => false,
            };
            assert!(
                same,
                "{name}: instruction {i}, {}: {listed:?}",
                program.instrs[i]
            );
        }
    });
}

fn entry_of(lower: Lower) -> Option<Entry> {
    use Basic::{And, Andf, Andp, Ani, Ld, Ldf, Ldi, Ldp, Or, Orf, Ori, Orp};
    match lower {
        Lower::Basic(Ld | Ldi | Ldp | Ldf) | Lower::Compare(Join::Ld, _) => Some(Entry::Ld),
        Lower::Basic(And | Ani | Andp | Andf) | Lower::Compare(Join::And, _) => Some(Entry::And),
        Lower::Basic(Or | Ori | Orp | Orf) | Lower::Compare(Join::Or, _) => Some(Entry::Or),
        _ => None,
    }
}

#[test]
fn what_inverts_a_block_alone_is_a_list() {
    let drawn = |list: &str| {
        let program = read(list);
        with(&program, |_, ladder| {
            Ok::<_, ()>(matches!(ladder.networks[0].body, NetworkBody::Rung(_)))
        })
    };
    for list in [
        "LD X0\nLD X1\nINV\nANB\nOUT Y0\n",
        "LD X0\nLD X1\nINV\nLD X2\nORB\nANB\nOUT Y0\n",
        "LD X0\nMPS\nLD X1\nMEP\nANB\nOUT Y0\nMPP\nOUT Y1\n",
    ] {
        assert_eq!(drawn(list), Ok(false), "{list}");
    }
    for list in [
        "LD X0\nAND X1\nINV\nOUT Y0\n",
        "LD X0\nINV\nLD X1\nORB\nOUT Y0\n",
        "LD X0\nMPS\nAND X1\nINV\nOUT Y0\nMPP\nOUT Y1\n",
    ] {
        assert_eq!(drawn(list), Ok(true), "{list}");
    }
}

/// Programs of the repository, and of a folder of real ones beside it where there is one.
#[test]
fn real_programs_are_drawn_and_read_back() {
    let root = Path::new(env!("RUNGC_ROOT"));
    let mut files = Vec::new();
    programs_in(&root.join("examples"), &mut files);
    let own = files.len();
    programs_in(&root.join("../shared/corpus"), &mut files);
    programs_in(&root.join("../shared/projects"), &mut files);
    if files.len() == own {
        println!("there is no folder of real programs here: only examples were read");
    }
    assert!(own >= 8, "{own} examples");
    let (mut networks, mut lists) = (0, 0);
    for file in files {
        let Ok(read) = rungc_frontend::read(&file) else {
            continue;
        };
        assert_inverse(&read.program, &file.display().to_string());
        with_model(
            &read.program,
            common::model(&read.program),
            |resolved, ladder| {
                for network in &ladder.networks {
                    networks += 1;
                    if let NetworkBody::List { why } = network.body {
                        lists += 1;
                        let first = &resolved.program.instrs[network.instrs.start];
                        println!("{}: {first}: {why}", file.display());
                    }
                }
                let style = Style {
                    width: 100,
                    comments: true,
                };
                let picture = draw(resolved, &numbered(ladder), style);
                assert_eq!(picture.is_empty(), read.program.instrs.is_empty());
            },
        );
    }
    println!("{networks} networks, {lists} of them lists");
    assert!(
        lists * 100 <= networks,
        "{lists} of {networks} networks are not drawn"
    );
}

/// Lines from which random programs are made.
fn line() -> impl Strategy<Value = String> {
    let fixed = prop::sample::select(vec![
        "ANB",
        "ORB",
        "MPS",
        "MRD",
        "MPP",
        "INV",
        "MEP",
        "NOP",
        "END",
        "STL S0",
        "STL S20",
        "SET S20",
        "OUT S0",
        "MC N0 M1",
        "RET",
        "P1",
        "FEND",
        "SRET",
        "FOR K2",
        "NEXT",
        "QQQ",
        "LD= D0 K1",
        "ANDD> D0 K1",
        "OR<= D0 D1",
        "CALL P1",
        "SET M1",
        "MOV K1 D0",
        "DMOVP K1 D0",
    ]);
    let contact = prop::sample::select(vec![
        "LD", "LDI", "LDP", "AND", "ANI", "ANDF", "OR", "ORI", "ORP", "OUT", "OUT",
    ]);
    prop_oneof![
        1 => fixed.prop_map(str::to_string),
        2 => (contact, 0..100_u8).prop_map(|(mnemonic, number)| format!("{mnemonic} M{number}")),
    ]
}

/// The list of a random node with contacts, branches and outputs.
fn node(depth: u32, at_rail: bool) -> BoxedStrategy<Vec<String>> {
    let outputs = prop::collection::vec(
        prop::sample::select(vec!["OUT Y0", "SET M1", "MOV K1 D0", "OUT T0 K10"]),
        1..3,
    );
    let outputs =
        outputs.prop_map(|lines| lines.into_iter().map(str::to_string).collect::<Vec<_>>());
    let tail = if depth == 0 {
        outputs.boxed()
    } else {
        let branches = prop::collection::vec(node(depth - 1, false), 2..4);
        let stack = branches.prop_map(|branches| {
            let last = branches.len() - 1;
            let starts = |i| match i {
                0 => "MPS",
                _ if i == last => "MPP",
                _ => "MRD",
            };
            let parts = branches.into_iter().enumerate();
            parts
                .flat_map(|(i, branch)| std::iter::once(starts(i).to_string()).chain(branch))
                .collect()
        });
        let continued =
            (outputs.clone(), node(depth - 1, false)).prop_map(|(mut outputs, node)| {
                outputs.extend(node);
                outputs
            });
        prop_oneof![outputs, stack, continued].boxed()
    };
    let first = if at_rail {
        block(2).boxed()
    } else {
        prop::collection::vec(Just("AND M3".to_string()), 0..3).boxed()
    };
    let more = prop::option::of(block(2));
    (first, more, tail)
        .prop_map(|(mut list, more, tail)| {
            if let Some(block) = more {
                list.extend(block);
                list.push("ANB".into());
            }
            list.extend(tail);
            list
        })
        .boxed()
}

/// The list of a random block that starts with LD.
fn block(depth: u32) -> BoxedStrategy<Vec<String>> {
    let simple = (
        0..50_u8,
        prop::collection::vec(
            prop::sample::select(vec!["AND M1", "OR M2", "ANI X3", "ORI X4", "INV"]),
            0..4,
        ),
    );
    let simple = simple.prop_map(|(number, rest)| {
        let start = std::iter::once(format!("LD X{}", number % 8));
        start
            .chain(rest.into_iter().map(str::to_string))
            .collect::<Vec<_>>()
    });
    if depth == 0 {
        return simple.boxed();
    }
    let joined =
        (block(depth - 1), block(depth - 1), prop::bool::ANY).prop_map(|(mut list, other, orb)| {
            list.extend(other);
            list.push(if orb { "ORB" } else { "ANB" }.into());
            list
        });
    prop_oneof![simple, joined].boxed()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_list_reads_back(lines in prop::collection::vec(line(), 0..60)) {
        let program = read(&lines.join("\n"));
        assert_inverse(&program, "random");
        with(&program, |resolved, ladder| {
            let states = program.instrs.iter().any(|instr| instr.mnemonic == "STL");
            let chart = Chart::of(resolved, ladder);
            prop_assert_eq!(chart.is_some(), states);
            chart.map(|chart| (chart.text(80), chart.sheet().to_string()));
            prop_assert!(pdf::document("random", resolved, ladder).starts_with(b"%PDF"));
            Ok(())
        })?;
    }

    #[test]
    fn networks_are_drawn_and_read_back(networks in prop::collection::vec(node(3, true), 1..4)) {
        let list = networks.concat().join("\n") + "\nEND\n";
        let program = read(&list);
        assert_inverse(&program, &list);
        with(&program, |resolved, ladder| {
            let mut lists = false;
            for network in &ladder.networks {
                if let NetworkBody::List { why } = network.body {
                    // A drawing would say that INV changes what is to the left of the block, too.
                    let instrs = &program.instrs[network.instrs.clone()];
                    let changes = instrs.iter().any(|instr| instr.mnemonic == "INV");
                    prop_assert!(why.starts_with("INV, MEP or MEF") && changes, "{list}: {network:?}");
                    lists = true;
                }
            }
            read_back(&program, &list, 60);
            let style = Style { width: 80, comments: false };
            prop_assert!(draw(resolved, &numbered(ladder), style).contains("(Y000)") || lists || !list.contains("OUT Y0"));
            Ok(())
        })?;
    }
}

/// Networks as drawings, read back: how many give their own list. All others give one of the same meaning, which reads
/// back as itself.
fn read_back(program: &Program, name: &str, width: usize) -> usize {
    let style = Style {
        width,
        comments: false,
    };
    let mut exact = 0;
    with(program, |resolved, ladder| {
        for network in &ladder.networks {
            let NetworkBody::Rung(_) = network.body else {
                continue;
            };
            let drawn = draw_alike(&[(resolved, network)], style).concat();
            let again = rungc_frontend::read_bytes("drawn", drawn.as_bytes()).unwrap();
            let found: Vec<_> = again.diagnostics.iter().map(|d| &d.message).collect();
            assert!(found.is_empty(), "{name}:\n{drawn}\n{found:?}");
            let texts =
                |instrs: &[Instr]| instrs.iter().map(ToString::to_string).collect::<Vec<_>>();
            if texts(&again.program.instrs) == texts(&program.instrs[network.instrs.clone()]) {
                exact += 1;
                continue;
            }
            // Drawn once more, it reads the same.
            with(&again.program, |resolved, ladder| {
                let networks: Vec<_> = ladder
                    .networks
                    .iter()
                    .map(|network| (resolved, network))
                    .collect();
                let drawn = draw_alike(&networks, style).join("\n");
                let third = rungc_frontend::read_bytes("drawn", drawn.as_bytes()).unwrap();
                assert_eq!(
                    texts(&third.program.instrs),
                    texts(&again.program.instrs),
                    "{name}\n{drawn}"
                );
            });
        }
    });
    exact
}

#[test]
fn drawings_of_examples_are_programs() {
    let root = Path::new(env!("RUNGC_ROOT"));
    let mut files = Vec::new();
    programs_in(&root.join("examples"), &mut files);
    programs_in(&root.join("../shared/corpus"), &mut files);
    let (mut exact, mut all) = (0, 0);
    for file in files {
        let Ok(read) = rungc_frontend::read(&file) else {
            continue;
        };
        exact += read_back(&read.program, &file.display().to_string(), 100);
        all += with(&read.program, |_, ladder| ladder.networks.len());
    }
    println!("{exact} of {all} networks are read back exactly");
    assert!(exact * 10 > all * 9, "{exact} of {all}");
}

const MOTOR: &str = ";! X000 = start button\n;! X001 = stop button\n;! M0 = motor latch\n;! Y000 = main contactor of the conveyor\nLD X0\nOR M0\nANI X1\nOUT M0\nLD M0\nOUT T0 K30\nAND T0\nOUT Y0\nEND\n";

#[test]
fn a_picture_of_a_motor() {
    let program = read(MOTOR);
    let picture = with(&program, |resolved, ladder| {
        let networks = numbered(ladder);
        let painter = Painter::new(resolved, &networks, 60);
        painter.sheet(&networks).to_string()
    });
    insta::assert_snapshot!(picture);
}

#[test]
fn a_page_holds_hostile_texts_as_texts() {
    let program = read(
        ";! X000 = </script><img src=x onerror=alert(1)>\n;! Y000 = a\u{202e}b\n; </p><b>\nLD X0\nOUT Y0\nEND\n",
    );
    let page = with(&program, |resolved, ladder| {
        html::page("<i>title</i>", resolved, ladder, 104)
    });
    for hostile in ["<img", "<i>", "<b></b>", "</p><b>", "\u{202e}"] {
        assert!(!page.contains(hostile), "{hostile}");
    }
    assert!(page.contains("&lt;i&gt;title&lt;/i&gt;"));
    assert!(page.contains("&lt;/script&gt;&lt;img src=x"));
    assert_eq!(
        page.matches("<script").count(),
        page.matches("</script>").count()
    );
}

#[test]
fn every_label_of_a_network_is_drawn() {
    let drawn = picture("P0\nP1\nP2\nLD X0\nOUT Y0\nEND\n");
    for label in ["P0", "P1", "P2"] {
        assert!(drawn.contains(label), "{drawn}");
    }
}

#[test]
fn a_latching_motor() {
    insta::assert_snapshot!(picture(MOTOR));
}

const MASTER: &str =
    "LD X0\nMPS\nAND X5\nMC N0 M100\nMPP\nOUT Y5\nLD X1\nMC N1 M101\nLD X2\nOUT Y0\nMCR N0\nEND\n";

#[test]
fn a_master_control_has_a_contact_in_the_rail() {
    insta::assert_snapshot!(picture(MASTER));
    let program = read(MASTER);
    assert_eq!(read_back(&program, "master", 100), 5);
    let bars = with(&program, |resolved, ladder| {
        let networks = numbered(ladder);
        let sheet = Painter::new(resolved, &networks, 60).sheet(&networks);
        sheet.to_string().matches("class=\"gap\"").count()
    });
    assert_eq!(bars, 2);
}

#[test]
fn branches_and_boxes() {
    let list = "; Heads up: branches\nLD X0\nLD X1\nAND X2\nORB\nMPS\nAND X3\nOUT Y0\nMRD\nLD X4\nORI X5\nANB\nSET M10\nMPP\nMOV K100 D0\nDADD D0 D2 D4\nLD= D0 K5\nOR>= D2 K100\nINV\nOUT C5 K10\nP1\nLDP X7\nANDF X10\nCALLP P2\nEND\n";
    insta::assert_snapshot!(picture(list));
}

#[test]
fn a_wide_network_continues_below() {
    let contacts: Vec<String> = (1..16).map(|number| format!("AND M{number}")).collect();
    insta::assert_snapshot!(picture(&format!(
        "LD M0\nOR M20\n{}\nOUT Y0\nOUT Y1\nEND\n",
        contacts.join("\n")
    )));
}

#[test]
fn what_cannot_be_drawn_is_a_list() {
    insta::assert_snapshot!(picture(
        "LD X0\nOUT Y0\nOR X1\nOUT Y1\nNOP\nLD X2\nANB\nOUT Y2\nQQQ\nEND\n"
    ));
}

/// NOP within a rung has no picture, and stays in the list.
#[test]
fn nops_within_rungs_are_passed_over() {
    let plain = "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nLD X2\nOR X3\nANB\nOUT Y1\nOUT Y2";
    // Without step numbers, which count NOP.
    let body = |line: &str| line.chars().skip(5).collect::<String>();
    let drawn = |list: &str| {
        let list = format!("{list}\nLD X4\nOUT Y4\nNOP\nEND\n");
        let program = read(&list);
        assert_inverse(&program, &list);
        with(&program, |_, ladder| {
            let mut bodies = ladder.networks.iter().map(|network| &network.body);
            let all = bodies.all(|body| matches!(body, NetworkBody::Rung(_)));
            assert!(all, "{ladder:?}");
        });
        picture(&list).lines().map(body).collect::<Vec<_>>()
    };
    assert_eq!(drawn(&plain.replace('\n', "\nNOP\nNOP\n")), drawn(plain));
}
