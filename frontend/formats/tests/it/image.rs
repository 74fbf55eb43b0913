//! Program memory of PLCs: what images hold, what comes back from written ones, and what is rejected.

use proptest::prelude::*;
use rungc_frontend::{Read, ReadOptions, image, print, read_bytes, read_bytes_with, read_text};
use rungc_syntax::{DeviceClass, Program, SourceKind};
use std::path::{Path, PathBuf};

/// Image of a list.
fn written(list: &str) -> Vec<u8> {
    let read = read_text("a.il", list);
    assert!(read.diagnostics.is_empty(), "{:?}", read.diagnostics);
    image::write(&read.program).unwrap()
}

fn texts(program: &Program) -> Vec<String> {
    program.instrs.iter().map(ToString::to_string).collect()
}

/// Parameters of a PLC as its editor leaves them, before these words of a program.
fn with_words(words: &[u16]) -> Vec<u8> {
    let mut bytes = written("END\n");
    bytes.truncate(image::PARAMETERS);
    bytes.extend(words.iter().copied().flat_map(u16::to_le_bytes));
    bytes
}

fn read(bytes: &[u8]) -> Read {
    read_bytes("plc.bin", bytes).unwrap()
}

fn findings(read: &Read) -> String {
    let lines = read.diagnostics.iter().map(|d| {
        let help = d.help.as_deref().unwrap_or_default();
        format!("{} {} / {} / {help}\n", d.code, d.message, d.label)
    });
    format!(
        "{}---\n{}",
        lines.collect::<String>(),
        read.program.source.text
    )
}

/// Instructions of each kind in the published images and quotations, with their words.
const SHOWN: [(&str, &[u16]); 24] = [
    ("LD X000", &[0x2400]),
    ("OUT Y000", &[0xC500]),
    ("LD M8000", &[0x2F00]),
    ("OUT M8047", &[0x0002, 0x8F2F]),
    ("SET M8034", &[0x0003, 0x8F22]),
    ("ANI M3071", &[0x01C5, 0xADFF]),
    ("LDP X001", &[0x01CA, 0x8401]),
    ("SET S10", &[0x0006, 0x800A]),
    ("RST S0", &[0x0007, 0x8000]),
    ("PLS M21", &[0x0008, 0x8815]),
    ("RST C0", &[0x000C, 0x8E00]),
    ("RST D7999", &[0x000D, 0x86AE, 0x8836]),
    ("OUT T1 K15", &[0x0601, 0x800F, 0x8000]),
    ("OUT C5 D100", &[0x0E05, 0x86C8, 0x8600]),
    ("MC N0 M100", &[0x000A, 0x8000, 0x8864]),
    ("MCR N0", &[0x000B, 0x8000]),
    ("STL S10", &[0xF00A]),
    ("RET", &[0xF7FF]),
    ("P33", &[0xB021]),
    ("CALL P33", &[0x0012, 0x8842, 0x8000]),
    ("MOV K1000 D1", &[0x0028, 0x80E8, 0x8003, 0x8602, 0x8600]),
    (
        "DMOV K999 D2000",
        &[
            0x0029, 0x80E7, 0x8003, 0x8000, 0x8000, 0x86D0, 0x8807, 0x8000, 0x8000,
        ],
    ),
    ("ZRST C0 C255", &[0x0060, 0x8600, 0x8400, 0x86DC, 0x8402]),
    ("INC Z0", &[0x0040, 0x8638, 0x8000]),
];

#[test]
fn instructions_of_images_are_read_and_written() {
    for (text, words) in SHOWN {
        let bytes = with_words(&[words, &[0x000F]].concat());
        let read = read(&bytes);
        assert!(
            read.diagnostics.is_empty(),
            "{text}: {:?}",
            read.diagnostics
        );
        assert_eq!(texts(&read.program), [text, "END"]);
        assert_eq!(
            read.program.instrs[1].step,
            Some(words.len() as u32),
            "{text}"
        );
        assert_eq!(written(&format!("{text}\nEND\n")), bytes, "{text}");
    }
}

#[test]
fn an_image_is_known_by_its_parameters_and_a_pmw_by_its_header() {
    let image = written(";! title = PRESS 4\nLD X000\nOUT Y000\nEND\n");
    let pmw = [&[0; 0x100][..], &image].concat();
    for bytes in [&image, &pmw] {
        let read = read(bytes);
        assert_eq!(read.program.kind, SourceKind::Image);
        assert_eq!(read.program.title.as_deref(), Some("PRESS 4"));
        assert_eq!(texts(&read.program), ["LD X000", "OUT Y000", "END"]);
    }
    let read = read(&image);
    let parameters = read.program.parameters.unwrap();
    assert_eq!(parameters.capacity, Some(8000));
    let latched = parameters.latched.unwrap();
    let ranges: Vec<_> = latched
        .iter()
        .map(|run| (run.class, run.first, run.count))
        .collect();
    use DeviceClass::{C, D, M, S};
    assert_eq!(
        ranges,
        [
            (M, 500, 524),
            (S, 500, 500),
            (C, 100, 100),
            (C, 220, 36),
            (D, 200, 312)
        ]
    );
}

#[test]
fn a_program_behind_reserved_blocks_is_found() {
    let image = written("LD X000\nOUT Y000\nEND\n");
    let (head, code) = image.split_at(image::PARAMETERS);
    let mut bytes = head.to_vec();
    bytes[4] = 2;
    bytes.extend([0xFF; 2000]);
    bytes.extend(code);
    let read = read(&bytes);
    assert_eq!(texts(&read.program), ["LD X000", "OUT Y000", "END"]);
    assert_eq!(read.program.parameters.unwrap().comment_blocks, 2);
}

#[test]
fn words_without_a_meaning_are_errors_with_step_and_bytes() {
    let words = [
        0x2400, 0x0FFF, 0x8000, 0xC500, 0x0028, 0xE605, 0x8600, 0xB100, 0x000F,
    ];
    insta::assert_snapshot!(findings(&read(&with_words(&words))));
}

#[test]
fn a_program_without_end_is_cut() {
    insta::assert_snapshot!(findings(&read(&with_words(&[
        0x2400, 0xC500, 0xFFFF, 0xFFFF
    ]))));
    insta::assert_snapshot!(findings(&read(&with_words(&[0x2400, 0x0028, 0x8000]))));
}

#[test]
fn a_keyword_is_respected() {
    let mut bytes = with_words(&[0x2400, 0xC500, 0x000F]);
    bytes[8..16].copy_from_slice(b"A1234567");
    let protected = read(&bytes);
    assert!(protected.program.instrs.is_empty());
    insta::assert_snapshot!(findings(&protected));
    let mut bytes = with_words(&[0x000F]);
    bytes[0x44] = 1;
    assert!(image::is_protected(&bytes) && read(&bytes).program.instrs.is_empty());
}

#[test]
fn a_file_that_is_said_to_be_an_image_is_read_as_one() {
    let options = ReadOptions {
        image: true,
        ..ReadOptions::default()
    };
    let mut bytes = with_words(&[0x2400, 0xC500, 0x000F]);
    bytes[0x30..0x34].fill(0xFF);
    assert!(read_bytes("plc.bin", &bytes).is_err());
    let read = read_bytes_with("plc.bin", &bytes, &options).unwrap();
    assert_eq!(texts(&read.program), ["LD X000", "OUT Y000", "END"]);
    assert_eq!(read.program.parameters, None);
    let read = read_bytes_with("plc.bin", b"\x00\x01", &options).unwrap();
    insta::assert_snapshot!(findings(&read));
}

#[test]
fn what_no_image_has_shown_is_not_written() {
    let list = "LD X000\nMOV R0 D0\nSET D0.1\nMOV D0V0 D1\nOUT M7000\nLD S2000\nDEMOV E1.5 D0\nP300\nI001\nMEP\n";
    let read = read_text("a.il", list);
    let errors = image::write(&read.program).unwrap_err();
    let lines: Vec<_> = errors
        .iter()
        .map(|d| format!("{} {}", d.code, d.message))
        .collect();
    insta::assert_snapshot!(lines.join("\n"));
}

/// A folder beside the repository; `None`, with a message, where there is none.
fn shared(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("../shared").join(name);
    if !folder.is_dir() {
        println!("skipped: there is no folder {name} beside this repository");
        return None;
    }
    Some(folder)
}

#[test]
fn published_images_give_the_lists_beside_them() {
    let Some(folder) = shared("fx-images") else {
        return;
    };
    for name in ["ISU-FX2N-ReadFromPLC", "bomingfeng-Fx2N-PROG_CODE"] {
        let path = folder.join(name).with_extension("bin");
        let read = rungc_frontend::read(&path).unwrap();
        let list = std::fs::read_to_string(path.with_extension("il")).unwrap();
        assert_eq!(
            texts(&read.program),
            list.lines().collect::<Vec<_>>(),
            "{name}"
        );
        let errors: Vec<_> = read
            .diagnostics
            .iter()
            .filter(|d| d.code.starts_with('E'))
            .collect();
        assert!(errors.is_empty(), "{errors:?}");
        let bytes = std::fs::read(&path).unwrap();
        let code = &image::write(&read.program).unwrap()[image::PARAMETERS..];
        assert!(bytes[image::PARAMETERS..].starts_with(code), "{name}");
    }
}

/// Programs of the corpus, without the instructions that machine code does not hold.
fn corpus() -> Vec<(PathBuf, Program, usize)> {
    let mut programs = Vec::new();
    for folder in ["corpus", "projects"] {
        let Some(folder) = shared(folder) else {
            continue;
        };
        for path in rungc_frontend::programs(&folder, usize::MAX).unwrap() {
            let Ok(read) = rungc_frontend::read(&path) else {
                continue;
            };
            let mut program = read.program;
            let all = program.instrs.len();
            let end = program.instrs.last().cloned();
            program.instrs.retain(|instr| {
                let alone = Program {
                    instrs: vec![instr.clone(), end.clone().unwrap()],
                    ..Program::default()
                };
                instr.mnemonic != "END" && image::write(&alone).is_ok()
            });
            program.instrs.extend(end);
            programs.push((path, program, all));
        }
    }
    programs
}

#[test]
fn programs_of_the_corpus_survive_the_way_through_an_image() {
    let programs = corpus();
    let (mut held, mut all) = (0, 0);
    for (path, program, instructions) in &programs {
        let Ok(bytes) = image::write(program) else {
            continue;
        };
        let back = read(&bytes);
        assert!(back.program.is_complete(), "{}", path.display());
        let same = texts(program)
            .into_iter()
            .map(|text| spelled_as_read(&text));
        assert_eq!(
            texts(&back.program),
            same.collect::<Vec<_>>(),
            "{}",
            path.display()
        );
        assert_eq!(image::write(&back.program).unwrap()[0x5C..], bytes[0x5C..]);
        held += program.instrs.len();
        all += instructions;
    }
    println!(
        "{held} of {all} instructions of {} programs",
        programs.len()
    );
    assert!(
        programs.is_empty() || held * 10 > all * 9,
        "{held} of {all}"
    );
}

/// V and Z are special registers, and machine code does not say which of the names was written.
fn spelled_as_read(text: &str) -> String {
    let special = |text: &str| match text {
        "D8028" => "Z0".to_owned(),
        "D8029" => "V0".to_owned(),
        _ => text.to_owned(),
    };
    text.split(' ').map(special).collect::<Vec<_>>().join(" ")
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_words_are_read_within_bounds_and_what_is_read_is_stable(
        words in proptest::collection::vec(prop_oneof![any::<u16>(), 0_u16..0x400, 0x8000_u16..0x9200], 0..60)
    ) {
        let bytes = with_words(&words);
        let first = read(&bytes).program;
        prop_assert!(first.instrs.len() <= words.len());
        let mut whole = first;
        whole.instrs.retain(|instr| instr.mnemonic != "END");
        let end = read(&with_words(&[0x000F])).program.instrs;
        whole.instrs.extend(end);
        let again = read(&image::write(&whole).unwrap()).program;
        prop_assert_eq!(texts(&again), texts(&whole));
    }
}

/// A PLC stops reading at END: NOP after it is unused memory, anything else would be lost.
#[test]
fn what_follows_the_end_is_unused_memory_or_an_error() {
    let program = |list: &str| read_text("a.il", list).program;
    let plain = program("LD X0\nOUT Y0\nEND\n");
    let filled = program("LD X0\nOUT Y0\nEND\nNOP\nNOP\n");
    assert_eq!(
        image::write(&filled).unwrap(),
        image::write(&plain).unwrap()
    );
    assert_eq!(
        print::to_autoshop(&filled).unwrap(),
        print::to_autoshop(&plain).unwrap()
    );
    let tail = program("LD X0\nOUT Y0\nEND\nNOP\nLD X1\nOUT Y1\nEND\n");
    let found = image::write(&tail).unwrap_err();
    let found: Vec<_> = found.iter().map(|d| d.message.as_str()).collect();
    assert_eq!(
        found,
        ["`LD X001` stands after `END`, where a PLC stops reading"]
    );
    assert!(
        print::to_autoshop(&tail)
            .unwrap_err()
            .message
            .contains("`LD X001`")
    );
}
