//! No input makes a reader panic or hang: random bytes, and valid inputs of every format with random damage.

use crate::fixture::{
    Part, gh, gxw, project, qcd, replace, res, simple, structured_text, with_list, wpa, wpg,
};
#[cfg(unix)]
use crate::fixture::{Stream, compound};
use encoding_rs::UTF_16LE;
use proptest::prelude::*;
use rungc_frontend::{Read, ReadOptions, print, read_bytes, read_text};
#[cfg(unix)]
use std::time::Duration;

/// A small generator of random numbers (SplitMix64), so that every run sees the same inputs.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit.max(1) as u64) as usize
    }

    fn bytes(&mut self, count: usize) -> Vec<u8> {
        (0..count).map(|_| self.next() as u8).collect()
    }
}

/// Reads bytes. Every place must lie in the source, and every finding have a help.
fn survive(bytes: &[u8]) -> Option<Read> {
    let read = read_bytes("input", bytes).ok()?;
    let source = &read.program.source;
    for finding in read.diagnostics.iter() {
        assert!(
            source.text.get(finding.span.range()).is_some(),
            "{finding:?}"
        );
        assert!(
            !finding.message.is_empty() && finding.help.is_some(),
            "{finding:?}"
        );
    }
    for instr in &read.program.instrs {
        assert!(source.text.get(instr.span.range()).is_some(), "{instr:?}");
        assert!(
            instr
                .operands
                .iter()
                .all(|operand| source.text.get(operand.span.range()).is_some()),
            "{instr:?}"
        );
    }
    Some(read)
}

/// Prints a program that was read without an error and reads it back, except for texts with line breaks, which a list
/// cannot hold.
fn print_and_read(read: &Read) {
    if print::broken_text(&read.program).is_some() {
        return;
    }
    let again = read_text("again", &print::to_il(&read.program));
    assert!(!again.diagnostics.has_errors(), "{:?}", again.diagnostics);
    assert_eq!(again.program.instrs.len(), read.program.instrs.len());
}

/// Changes, removes, repeats or inserts a few bytes.
fn mutate(random: &mut Random, bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        let end = (at + random.below(12)).min(bytes.len());
        match random.below(6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..end)),
            2 => {
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            3 => bytes.insert(at, random.next() as u8),
            _ if at < bytes.len() => bytes[at] = random.next() as u8,
            _ => {}
        }
    }
    bytes
}

/// Damages each of the valid inputs in turn.
fn survive_mutations(seed: u64, count: usize, valid: &[Vec<u8>]) {
    for valid in valid {
        let read = read_bytes("valid", valid).unwrap();
        assert_eq!(read.diagnostics.iter().count(), 0);
    }
    let mut random = Random(seed);
    for (round, valid) in valid.iter().cycle().take(count).enumerate() {
        let read = survive(&mutate(&mut random, valid));
        if let Some(read) = read.filter(|read| round % 8 == 0 && !read.diagnostics.has_errors()) {
            print_and_read(&read);
        }
    }
}

/// Any three lines of [`LIST`] that follow each other: short programs keep ten thousand readings fast.
fn lists() -> Vec<String> {
    let lines: Vec<&str> = LIST.lines().collect();
    lines.windows(3).map(|lines| lines.join("\n")).collect()
}

const LIST: &str = ";! cpu = FX3U/FX3UC\n;! X000 = start\n; motor\n0 LD X0 ; go\nＬＤ≧　Ｄ０　Ｋ１０\nLDD >= D0Z0, K-5\nOUT T0 K30\nP1: MOV K4M0Z1 D0.F\n\
    DEMOV E1.5E+3 D0V\n$MOV \"a;b\" D0\nASC ABCD D300\nTO U0\\G5 H1FZ2 // note\nI001\nEND\n";

const TOKENS: &[&[u8]] = &[
    b"\x80\x00motor",
    &[0x00],
    &[0x9C, 0x08],
    b"\x82\x00\xC6\xF4\xB6\xAF",
    &[0x21, 0x03],
    &[0xC2, 0x05],
    &[0xE8, 200],
    &[0x4C, 5, 0, 2],
    &[0xF1, 4],
    &[0xF0, 1],
    &[0x90, 0x64],
    &[0xF2, 3],
    &[0xA8, 0x00],
    &[0x49, 0x0D, 0x30],
    &[0xEC, 0, 0, 0xC0, 0x3F],
    &[0xA8, 2],
    &[0xA8, 4],
    &[0x3C],
    &[0xD0, 3],
    &[0x34],
];

#[test]
fn random_bytes() {
    let mut random = Random(1);
    for _ in 0..64 {
        let bytes = random.bytes(8 << 10);
        survive(&bytes);
        survive(String::from_utf8_lossy(&bytes).as_bytes());
    }
    for _ in 0..32 {
        // The same after the marks that distinguish the formats.
        let noise = random.bytes(8 << 10);
        survive(&[&wpg(0x0208, &[])[..0x44], &noise].concat());
        survive(&[&gxw(&[])[..512], &noise].concat());
    }
}

#[test]
fn random_text_of_the_right_letters() {
    const LETTERS: &[u8] = b"LDANORXYMSTCDKHEPIVZ0189.\\\"$;/:<>=-+ ,\t\n\nUG";
    let mut random = Random(2);
    for _ in 0..64 {
        let text: Vec<u8> = (0..8 << 10)
            .map(|_| LETTERS[random.below(LETTERS.len())])
            .collect();
        survive(&text);
    }
}

#[test]
fn mutations_of_lists() {
    let lists: Vec<_> = lists().into_iter().map(String::into_bytes).collect();
    survive_mutations(3, 10_000, &lists);
}

#[test]
fn mutations_of_exports() {
    let programs: Vec<_> = lists()
        .iter()
        .map(|list| read_text("a", list).program)
        .collect();
    let exports: Vec<_> = programs.iter().map(print::to_csv).collect();
    survive_mutations(4, 5_000, &exports);
    let narrow = |wide: &Vec<u8>| UTF_16LE.decode(wide).0.into_owned().into_bytes();
    let exports: Vec<_> = exports.iter().map(narrow).collect();
    survive_mutations(5, 5_000, &exports);
}

#[test]
fn mutations_of_developer_projects() {
    survive_mutations(6, 10_000, &[wpg(0x0208, TOKENS)]);
}

#[test]
fn mutations_of_works2_projects() {
    let labels = || {
        let mut parts = simple("FX3U/FX3UC", TOKENS);
        replace(&mut parts, "MAIN.res", res(9, TOKENS, &[]));
        replace(
            &mut parts,
            "MAIN.Program.pou",
            structured_text(8, "OUT(X10, Y5);"),
        );
        replace(
            &mut parts,
            "COMMENT.qcd",
            qcd(&[(0x9C, 8, "start"), (0xA8, 10, "速度")]),
        );
        let latched = [1, 0, 0x90, 0, 12, 2, 0xF4, 1];
        replace(
            &mut parts,
            "Param.wpa",
            wpa(0x0208, &[(0x2001, &latched), (0xFFE0, &[16, 0])]),
        );
        parts.push(Part {
            name: "Global1.gh",
            content: gh(&[("Start", "X10"), ("Motor", "Y5")]),
        });
        parts
    };
    let plain = project(&simple("FX3U/FX3UC", TOKENS));
    let whole = project(&labels());
    survive_mutations(7, 10_000, &[plain]);
    // Damage of the container rarely hits the parts: they are damaged each by itself, too.
    let mut random = Random(8);
    let count = labels().len();
    for round in 0..2_000 {
        let mut parts = labels();
        let part = &mut parts[round % count];
        part.content = mutate(&mut random, &part.content);
        survive(&project(&parts));
        if round % 4 == 0 {
            survive(&mutate(&mut random, &whole));
        }
    }
}

#[test]
fn mutations_of_the_list_of_parts() {
    let list = "<a xmlns:d=\"urn:d\"><D_Projectdata d:id=\"1\"><iID>40</iID><szName>MAIN.res</szName></D_Projectdata></a>";
    let mut random = Random(9);
    for _ in 0..2_000 {
        let list = mutate(&mut random, list.as_bytes());
        survive(&with_list(&list, &simple("FX3U/FX3UC", TOKENS)));
    }
    for depth in [100, 100_000] {
        survive(&with_list("<a>".repeat(depth).as_bytes(), &[]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever a part of a project holds after a readable head, it is read or reported.
    #[test]
    fn any_parts(which in 0..7_usize, keep in 0..120_usize, noise in proptest::collection::vec(any::<u8>(), 0..400)) {
        let mut parts = simple("FX3U/FX3UC", TOKENS);
        parts.push(Part {
            name: "Global1.gh",
            content: gh(&[("Start", "X10")]),
        });
        let part = &mut parts[which];
        part.content.truncate(keep);
        part.content.extend(&noise);
        let read = survive(&project(&parts)).unwrap();
        prop_assert!(!read.program.instrs.is_empty() || read.diagnostics.has_errors());
    }
}

/// Processor time of this thread, to which other programs do not add.
#[cfg(unix)]
fn worked() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Lists with more parts than a project has are not searched one part for each other.
#[cfg(unix)]
#[test]
fn projects_of_very_many_parts() {
    let row = |i: usize| {
        format!("<D_Projectdata><iID>{i}</iID><szName>P{i}.Program.pou</szName></D_Projectdata>")
    };
    let list: String = (0..20_000).map(row).collect();
    let bytes = with_list(
        format!("<a>{list}</a>").as_bytes(),
        &simple("FX3U/FX3UC", TOKENS),
    );
    let start = worked();
    let read = survive(&bytes).unwrap();
    assert!(read.diagnostics.iter().any(|found| found.code == "W0522"));
    let took = worked() - start;
    assert!(took.as_secs() < 20, "{took:?}");
}

/// Many streams that share all their sectors: a file of a few hundred kilobytes that stands for gigabytes.
#[cfg(unix)]
#[test]
fn streams_that_share_sectors_are_not_read_twice() {
    let content = vec![0x5A; 200 << 10];
    let names: Vec<String> = (0..400).map(|i| format!("{i}")).collect();
    let mut streams: Vec<_> = names
        .iter()
        .map(|name| Stream {
            name,
            content: b"small",
        })
        .collect();
    streams.push(Stream {
        name: "long",
        content: &content,
    });
    let mut data = compound(&streams);
    share_sectors(&mut data, "long");
    let bytes = compound(&[Stream {
        name: "_hdb",
        content: &data,
    }]);
    let start = worked();
    let read = survive(&bytes).unwrap();
    assert!(read.diagnostics.has_errors());
    let took = worked() - start;
    assert!(took.as_secs() < 20, "{took:?}");
}

/// Gives each stream the sectors and the length of one of them, in the directory of a compound file.
#[cfg(unix)]
fn share_sectors(file: &mut [u8], name: &str) {
    let wide: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let entries: Vec<usize> = (512..file.len() - 127)
        .step_by(128)
        .filter(|&at| file[at + 66] == 2 && file[at + 64] > 2 && file[at + 65] == 0)
        .collect();
    let long = entries
        .iter()
        .copied()
        .find(|&at| file[at..].starts_with(&wide) && file[at + wide.len()] == 0)
        .expect("its entry");
    let place = file[long + 116..long + 128].to_vec();
    assert!(entries.len() > 400);
    for at in entries {
        file[at + 116..at + 128].copy_from_slice(&place);
    }
}

/// Reading stops at the limit, since an endless source has no size that could be queried.
#[test]
fn an_endless_source_is_refused() {
    let endless = std::io::repeat(b'\n');
    let read = rungc_frontend::read_from("endless", endless, &ReadOptions::default());
    assert!(matches!(
        read,
        Err(rungc_frontend::ReadError::TooLarge { .. })
    ));
    let short = rungc_frontend::read_from(
        "short",
        &b"LD X0\nOUT Y0\nEND\n"[..],
        &ReadOptions::default(),
    )
    .unwrap();
    assert_eq!(short.program.instrs.len(), 3);
}

/// The body of a token: arbitrary bytes, as a rule with a first byte that means something.
fn body() -> impl Strategy<Value = Vec<u8>> {
    let first = prop_oneof![
        4 => proptest::sample::select(vec![
            0x00, 0x20, 0x21, 0x24, 0x2C, 0x30, 0x3C, 0x40, 0x48, 0x4C, 0x53, 0x59, 0x63, 0x6C, 0x80, 0x81,
            0x82, 0x90, 0x9C, 0xA8, 0xAB, 0xC2, 0xD0, 0xD1, 0xDF, 0xE8, 0xE9, 0xEA, 0xEB, 0xEC, 0xED, 0xEE,
            0xF0, 0xF1, 0xF2, 0xF4, 0xF8_u8,
        ]),
        1 => any::<u8>(),
    ];
    let rest = proptest::collection::vec(prop_oneof![0..=16_u8, any::<u8>()], 0..6);
    (first, rest).prop_map(|(first, rest)| [vec![first], rest].concat())
}

proptest! {
    /// Whatever tokens follow each other, each instruction is read or reported, and steps rise.
    #[test]
    fn any_tokens(bodies in proptest::collection::vec(body(), 0..40)) {
        let mut bodies: Vec<&[u8]> = bodies.iter().map(Vec::as_slice).collect();
        bodies.push(&[0x34]);
        let read = survive(&wpg(0x0208, &bodies)).unwrap();
        if !read.program.is_complete() {
            prop_assert!(read.diagnostics.has_errors());
        }
        let steps: Vec<_> = read.program.instrs.iter().filter_map(|instr| instr.step).collect();
        prop_assert!(steps.is_sorted(), "{steps:?}");
        for unproven in &read.unproven {
            prop_assert!(bodies.contains(&unproven.code.as_slice()));
            prop_assert!(unproven.at <= read.program.instrs.len());
        }
    }
}
