//! Sources of GX Works2 projects: labels, structures, POUs, and the devices that the compiler chose.

use crate::fixture::sources::{COMPILED, Label, globals, label, labelled, locals};
use crate::fixture::{Part, project, qcd, replace, simple};
use rungc_frontend::sources::{Body, Class, Pou, PouKind, SourceFile, Sources};
use rungc_frontend::{Read, read_bytes};
use rungc_syntax::{Device, OperandKind};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn read(parts: &[Part]) -> Read {
    read_bytes("press.gxw", &project(parts)).unwrap()
}

fn sources(parts: &[Part]) -> Sources {
    *read(parts).sources.expect("sources")
}

fn texts(read: &Read) -> Vec<String> {
    let instrs = read.program.instrs.iter();
    instrs.map(ToString::to_string).collect()
}

fn shown(files: &[SourceFile]) -> String {
    let text = |contents: &[u8]| match contents.starts_with(&[0xFF, 0xFE]) {
        true => encoding_rs::UTF_16LE.decode(contents).0.into_owned(),
        false => String::from_utf8(contents.to_vec()).unwrap(),
    };
    let files = files.iter();
    files
        .map(|file| format!("==== {}\n{}", file.path, text(&file.contents)))
        .collect()
}

/// The project is among the seeds of the fuzz targets, where other tests take it from. `RUNGC_WRITE_SEEDS` writes it.
#[test]
fn the_project_is_a_seed_of_the_fuzz_targets() {
    let path = Path::new(env!("RUNGC_ROOT")).join("golden/fuzz/corpus/gx-works2/sources.gxw");
    if std::env::var_os("RUNGC_WRITE_SEEDS").is_some() {
        std::fs::write(&path, project(&labelled())).unwrap();
    }
    // The file itself holds times.
    let seed = read_bytes("press.gxw", &std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(
        *seed.sources.unwrap(),
        sources(&labelled()),
        "set RUNGC_WRITE_SEEDS to write it"
    );
}

#[test]
fn all_parts_of_a_labelled_project_are_read() {
    let sources = sources(&labelled());
    assert_eq!(sources.unread, []);
    let kinds: Vec<_> = sources
        .pous
        .iter()
        .map(|pou| (pou.name.as_str(), pou.kind))
        .collect();
    let counter = PouKind::Block {
        is_expanded: true,
        has_enable: false,
    };
    assert_eq!(
        kinds,
        [
            ("Counter", counter),
            ("Main", PouKind::Program),
            ("Twice", PouKind::Function),
            ("Half", PouKind::Function)
        ]
    );
    assert_eq!(sources.pous[3].library.as_deref(), Some("Maths"));
    assert!(matches!(&sources.pous[2].body, Body::Networks(networks) if networks.len() == 1));
    let labels: Vec<_> = sources
        .labels()
        .map(|(_, label)| (label.name.as_str(), label.class))
        .collect();
    assert_eq!(
        labels[..4],
        [
            ("Start", Class::Global),
            ("Axis1", Class::Global),
            ("Most", Class::GlobalConstant),
            ("Table", Class::Global)
        ]
    );
    let reserved: Vec<_> = sources.reserved.iter().map(ToString::to_string).collect();
    assert_eq!(reserved, ["D512 to D999"]);
    assert_eq!(sources.tasks[0].pous, ["Main"]);
    assert_eq!(sources.tasks[0].priority, 31);
}

#[test]
fn labels_have_the_devices_that_are_stated_or_chosen() {
    let devices: Vec<_> = sources(&labelled())
        .devices()
        .iter()
        .map(|one| {
            format!(
                "{} {}{}",
                one.name,
                one.device,
                if one.is_chosen { " chosen" } else { "" }
            )
        })
        .collect();
    assert_eq!(
        devices,
        [
            "Start M100",
            "Axis1.Ready M200",
            "Axis1.Position D300",
            "Table[0] D400",
            "Table[1] D402",
            "Table[2] D404",
            "Main.Count1.In M7679 chosen",
            "Main.Step D999 chosen",
        ]
    );
}

#[test]
fn sources_become_text() {
    let sources = sources(&labelled());
    insta::assert_snapshot!("sources_as_text", shown(&sources.to_st()));
    insta::assert_snapshot!("labels_as_text", sources.to_labels());
    insta::assert_snapshot!("labels_as_tables", shown(&sources.to_label_tables("press")));
}

#[test]
fn plain_ladders_have_no_labels() {
    let sources = sources(&simple("FX3U/FX3UC", COMPILED));
    assert!(!sources.is_structured());
    assert_eq!(sources.unread, []);
}

/// Names that no file system takes, and that differ in case alone, give files of different names.
#[test]
fn each_source_has_a_file_of_another_name() {
    let mut parts = labelled();
    let names = ["main.Program.pou", "A*B.Program.pou", "A:B.Program.pou"];
    let pous = names.map(|name| Part {
        name,
        content: crate::fixture::structured_text(8, "Y0 := X0;"),
    });
    parts.extend(pous);
    let files = sources(&parts).to_st();
    let paths: BTreeSet<_> = files.iter().map(|file| file.path.to_lowercase()).collect();
    assert_eq!(paths.len(), files.len());
    for path in ["main.st", "main~2.st", "a_b.st", "a_b~2.st"] {
        assert!(paths.contains(path), "{paths:?}");
    }
}

/// Damage of a source never reaches the compiled program, and is reported with its place.
#[test]
fn damaged_sources_are_reported_and_leave_the_program_alone() {
    let whole = read(&labelled());
    let (program, of_whole) = (texts(&whole), whole.sources.unwrap());
    for (index, part) in labelled().iter().enumerate() {
        let is_source = ["gh", "lh", "str", "lnb", "lnl", "stg"];
        let is_body = part.name.starts_with("Twice.P") || part.name.starts_with("Counter.P");
        let ending = part.name.rsplit('.').next().unwrap();
        if !is_source.contains(&ending) && !is_body {
            continue;
        }
        let length = part.content.len();
        let step = (length / 12).max(1);
        for cut in (0..length).step_by(step) {
            let mut parts = labelled();
            parts[index].content.truncate(cut);
            let read = read(&parts);
            assert_eq!(texts(&read), program, "{} cut at {cut}", part.name);
            let sources = read.sources.unwrap();
            let is_reported = !sources.unread.is_empty();
            // Of a store that cannot be opened, nothing is known; the end of a part holds nothing.
            let lost = sources.labels().count() < of_whole.labels().count()
                || sources.pous.iter().any(|pou| pou.body == Body::Unread);
            assert!(is_reported || !lost, "{} cut at {cut}", part.name);
            for unread in &sources.unread {
                assert!(unread.at <= length, "{unread:?}");
            }
        }
        for at in (0..length).step_by(step) {
            for flip in [0x01, 0x80] {
                let mut parts = labelled();
                parts[index].content[at] ^= flip;
                let read = read(&parts);
                assert_eq!(texts(&read), program, "{} changed at {at}", part.name);
                let sources = read.sources.unwrap();
                let _ = (
                    sources.to_st(),
                    sources.to_labels(),
                    sources.to_label_tables("press"),
                );
            }
        }
    }
}

/// A table whose count, class or form is wrong ends there, and the rows before it are used.
#[test]
fn a_wrong_class_ends_a_table() {
    let mut parts = labelled();
    let table = locals(
        "Main",
        0,
        0,
        "",
        &[label("Good", "INT", 1), label("Bad", "INT", 7)],
    );
    replace(&mut parts, "Main.Labels.lh", table);
    let sources = sources(&parts);
    let main = sources.pou("Main").unwrap();
    assert_eq!(main.labels.len(), 1);
    assert_eq!(sources.unread[0].what, "the labels of `Main`");
}

/// What is not text in the structured text of a POU is named with its place.
#[test]
fn damaged_text_is_reported() {
    let utf_16 = |text: &str| {
        text.encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>()
    };
    for damage in [[0, 0], [1, 0], [0, 0xD8]] {
        let mut parts = labelled();
        let part = parts
            .iter_mut()
            .find(|part| part.name == "Main.Program.pou");
        let content = &mut part.unwrap().content;
        let line = utf_16("IF Start THEN");
        let at = content
            .windows(line.len())
            .position(|own| own == line)
            .unwrap()
            + 6;
        content[at..at + 2].copy_from_slice(&damage);
        let sources = sources(&parts);
        assert_eq!(sources.unread.len(), 1, "{damage:?}");
        assert_eq!(
            (sources.unread[0].what.as_str(), sources.unread[0].at),
            ("the source of `Main`", at)
        );
    }
    // Fewer characters than their number says.
    let mut parts = labelled();
    let mut own = parts.iter_mut();
    let part = own.find(|part| part.name == "Main.Program.pou").unwrap();
    let end = utf_16("END_IF");
    let mut places = part.content.windows(end.len());
    let at = places.position(|own| own == end).unwrap();
    part.content[at..].fill(0);
    assert_eq!(sources(&parts).unread[0].at, at);
}

/// Damage in a text of a label table, of a structure or of a diagram is named with its place (W0525).
#[test]
fn damaged_labels_are_reported() {
    let words = [
        "Start",
        "BOOL",
        "M100",
        "Start (* button *)",
        "Axis1",
        "M200",
        "Most",
        "ARRAY [0..2] OF DINT",
        "Position",
        "INT",
        "of it",
        "Count1",
        "Counter",
        "Step",
        "Value",
        "Twice",
        "Sum",
        "Half",
        "Height",
    ];
    let is_table = |name: &str| {
        ["gh", "lh", "str", "lns", "lnl"]
            .iter()
            .any(|e| name.ends_with(e))
    };
    let mut seen = BTreeSet::new();
    for (index, part) in labelled().iter().enumerate() {
        let is_diagram = part.name == "Twice.Program.pou";
        for word in words.iter().filter(|_| is_table(part.name) || is_diagram) {
            let units: Vec<u8> = word.encode_utf16().flat_map(u16::to_le_bytes).collect();
            // A whole text, with the zero at its end.
            let whole = [&units[..], &[0, 0]].concat();
            let places = part.content.windows(whole.len()).enumerate();
            let places = places.filter(|(_, own)| *own == whole).map(|(at, _)| at);
            for at in places.flat_map(|at| (0..units.len() / 2).map(move |unit| at + 2 * unit)) {
                for damage in [[0, 0], [1, 0], [0, 0xD8], [0x7F, 0]] {
                    let mut parts = labelled();
                    parts[index].content[at..at + 2].copy_from_slice(&damage);
                    let read = read(&parts);
                    let found = read
                        .diagnostics
                        .iter()
                        .filter(|found| found.code == "W0525");
                    assert_eq!(found.count(), 1, "{} {word} {at} {damage:?}", part.name);
                    let unread = &read.sources.unwrap().unread;
                    // Of a diagram, the part of the network is named.
                    let is_there = unread[0].at == at || is_diagram && unread[0].at > at;
                    assert!(is_there, "{} {word} {damage:?} {unread:?}", part.name);
                }
                seen.insert(*word);
            }
        }
    }
    assert_eq!(seen.len(), words.len(), "{seen:?}");
}

/// Fields of a row that state the same must agree.
#[test]
fn label_tables_that_contradict_themselves_are_reported() {
    let table = |label: Label, code: Option<u32>| {
        let mut parts = labelled();
        let mut content = globals(&[label]);
        if let Some(code) = code {
            // The code is before the name of the type, which is empty.
            let at = content.len() - 10;
            content[at..at + 4].copy_from_slice(&code.to_le_bytes());
        }
        replace(&mut parts, "Global1.gh", content);
        sources(&parts).unread.len()
    };
    let plain = label("Start", "BOOL", 8);
    assert_eq!(table(plain, None), 0);
    assert_eq!(table(plain, Some(1)), 0);
    assert_eq!(table(plain, Some(2)), 1);
    assert_eq!(table(label("Start", "BOOM", 8), Some(1)), 1);
    assert_eq!(table(label("Sta rt", "BOOL", 8), None), 1);
    assert_eq!(table(label("启动_1", "BOOL", 8), None), 0);
    // A class of local labels.
    assert_eq!(table(label("Start", "BOOL", 1), None), 1);
    let of = |of| Label {
        of,
        ..label("Start", "Axis", 8)
    };
    assert_eq!(table(of("Axis"), None), 0);
    assert_eq!(table(of("Axes"), None), 1);
    let at = |device, address| Label {
        device,
        address,
        ..plain
    };
    assert_eq!(table(at("M100", "%MX0.100"), None), 0);
    assert_eq!(table(at("X010", "%IX8"), None), 0);
    assert_eq!(table(at("TC4", "%MX5.4"), None), 0);
    assert_eq!(table(at("M101", "%MX0.100"), None), 1);
    assert_eq!(table(at("M1\u{AC}0", "%MX0.100"), None), 1);
}

/// Names that Windows keeps for its devices are not names of files.
#[test]
fn files_have_names_that_windows_takes() {
    let mut sources = sources(&labelled());
    for (pou, name) in sources
        .pous
        .iter_mut()
        .zip(["con", "LPT1", "NUL.x", "console"])
    {
        name.clone_into(&mut pou.name);
    }
    let files = sources.to_st();
    let paths: Vec<_> = files.iter().map(|file| file.path.as_str()).collect();
    for path in [
        "con_.txt",
        "LPT1_.st",
        "NUL_x.txt",
        "libraries/Maths/console.st",
    ] {
        assert!(paths.contains(&path), "{paths:?}");
    }
}

/// All projects beside this repository.
fn published() -> Vec<PathBuf> {
    let root = Path::new(env!("RUNGC_ROOT")).join("../shared");
    let mut found = Vec::new();
    for folder in ["corpus", "projects", "label-projects"] {
        let entries = walkdir::WalkDir::new(root.join(folder)).follow_links(true);
        let files = entries
            .into_iter()
            .flatten()
            .map(walkdir::DirEntry::into_path);
        found.extend(files.filter(|path| path.extension().is_some_and(|e| e == "gxw")));
    }
    if found.is_empty() {
        println!("skipped: no projects at {}", root.display());
    }
    found.sort();
    found
}

/// The devices that a compiled program names, as one word or bit each.
fn used(read: &Read) -> BTreeSet<Device> {
    let operands = read.program.instrs.iter().flat_map(|instr| &instr.operands);
    let devices = operands.flat_map(|operand| match &operand.kind {
        OperandKind::Device(device, _) | OperandKind::WordBit(device, _, _) => vec![*device],
        OperandKind::Nibbles(digits, device, _) => {
            let number = |at| Device {
                number: device.number + at,
                ..*device
            };
            (0..u32::from(*digits) * 4).map(number).collect()
        }
        _ => Vec::new(),
    });
    devices.collect()
}

/// The words of a POU's source and the types of its labels, in lower case.
fn words(pou: &Pou) -> BTreeSet<String> {
    let text = match &pou.body {
        Body::Text(text) => without_comments(text),
        Body::Ladder(lines) => lines.iter().map(|line| format!("{line}\n")).collect(),
        Body::Networks(networks) => {
            let nodes = networks.iter().flat_map(|network| &network.nodes);
            nodes
                .map(|node| format!("{} {} ", node.symbol, node.block))
                .collect()
        }
        Body::Chart | Body::Other(_) | Body::Unread => String::new(),
    };
    let is_end = |c: char| !c.is_alphanumeric() && c != '_';
    let types = pou.labels.iter().map(|label| label.type_name.as_str());
    text.split(is_end)
        .chain(types)
        .map(str::to_lowercase)
        .collect()
}

fn without_comments(text: &str) -> String {
    let mut parts = text.split("(*");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |code, part| {
        code + part.split_once("*)").map_or("", |(_, rest)| rest)
    })
}

/// The words of all POUs that the tasks run or that these call.
fn compiled_words(sources: &Sources) -> BTreeSet<String> {
    let tasks = sources.tasks.iter();
    let mut open: Vec<String> = tasks.flat_map(|task| task.pous.clone()).collect();
    // A block may be an instance of the global table.
    let instances = sources.globals.iter().flat_map(|table| &table.labels);
    open.extend(instances.map(|label| label.type_name.clone()));
    let (mut seen, mut found) = (BTreeSet::new(), BTreeSet::new());
    while let Some(name) = open.pop() {
        if let Some(pou) = sources
            .pou(&name)
            .filter(|pou| seen.insert(pou.name.clone()))
        {
            let words = words(pou);
            open.extend(words.iter().cloned());
            found.extend(words);
        }
    }
    found
}

/// Labels have the devices that the compiled list of their project uses: a misread class, device or member would not.
#[test]
fn devices_of_published_labels_are_in_the_compiled_list() {
    let mut sums: BTreeMap<&str, usize> = BTreeMap::new();
    for path in published() {
        let read = rungc_frontend::read(&path).unwrap();
        let Some(sources) = &read.sources else {
            continue;
        };
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        assert_eq!(sources.unread, [], "{name}");
        assert!(
            sources.pous.iter().all(|pou| pou.body != Body::Unread),
            "{name}"
        );
        let (used, words) = (used(&read), compiled_words(sources));
        let reserved = |device: &Device| {
            let mut runs = sources.reserved.iter();
            runs.any(|run| {
                run.class == device.class
                    && (run.first..run.first + run.count).contains(&device.number)
            })
        };
        let mut count = |what, number| *sums.entry(what).or_insert(0) += number;
        count("labels", sources.labels().count());
        count("POUs", sources.pous.len());
        count("scopes", sources.scopes.len());
        for one in sources.devices() {
            let last = one.name.rsplit('.').next().unwrap_or_default();
            let is_named = words.contains(&last.to_lowercase());
            let is_whole = !one.name.contains('[');
            // Blocks that are expanded need not touch their labels.
            let path: Vec<_> = one.name.split('.').collect();
            let owner = sources.pou(path[0]);
            let is_program = owner.is_some_and(|pou| pou.kind == PouKind::Program);
            let is_of_block = path.len() > 1 + usize::from(is_program);
            let is_used = used.contains(&one.device);
            match (one.is_chosen, is_named && is_whole) {
                (false, true) => {
                    count("stated", 1);
                    assert!(is_used, "{name}: {one:?}");
                }
                (true, true) if !is_of_block => {
                    count("chosen", 1);
                    count("chosen and used", usize::from(is_used));
                    assert!(reserved(&one.device), "{name}: {one:?}");
                }
                (true, _) => assert!(reserved(&one.device), "{name}: {one:?}"),
                (false, false) => {}
            }
        }
    }
    println!("{sums:#?}");
    let sum = |what| sums.get(what).copied().unwrap_or_default();
    // Two belong to a second program file, which an FX CPU does not run.
    assert!(sum("chosen and used") + 2 >= sum("chosen"));
}

/// Devices without a comment have the names of their labels; a comment of the project stays.
#[test]
fn labels_name_devices_without_a_comment() {
    let mut parts = labelled();
    replace(
        &mut parts,
        "COMMENT.qcd",
        qcd(&[(0x90, 100, "Green button")]),
    );
    let read = read(&parts);
    let comments = read.program.comments.iter();
    let comments: Vec<_> = comments
        .map(|(device, text)| format!("{device} {text}"))
        .collect();
    assert_eq!(
        comments,
        [
            "M100 Green button",
            "M200 Axis1.Ready",
            "M7679 Main.Count1.In",
            "D300 Axis1.Position",
            "D400 Table[0]",
            "D402 Table[1]",
            "D404 Table[2]",
            "D999 Main.Step",
        ]
    );
    let notes: Vec<_> = read
        .diagnostics
        .iter()
        .filter(|found| found.code == "N0013")
        .collect();
    assert_eq!(
        notes[0].message,
        "the project holds 1 program, 1 function block, 2 functions, 2 structures, 10 labels \
         (sources: 1 ladder, 1 structured ladder or FBD, 2 structured text)"
    );
}
