//! Every target on its corpus, and for a short random campaign. `RUNGC_FUZZ_SECONDS` makes the campaign of each target
//! that long, `RUNGC_FUZZ` names one target alone.

use rungc_fuzz::random::Random;
use rungc_fuzz::targets::{Target, all};
use std::collections::BTreeSet;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};
use walkdir::{DirEntry, WalkDir};

/// The campaign of each target without the variable.
const SHORT: Duration = Duration::from_millis(200);

/// Runs a target; if it panics, the input is shown.
fn run(target: &Target, input: &[u8]) {
    let outcome = catch_unwind(AssertUnwindSafe(|| (target.run)(input)));
    assert!(
        outcome.is_ok(),
        "{} fails on b\"{}\"",
        target.name,
        input.escape_ascii()
    );
}

/// Its corpus and its seeds.
fn inputs(target: &Target) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("corpus")
        .join(target.name);
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let corpus = paths.into_iter().map(|path| fs::read(path).unwrap());
    corpus.chain(target.seeds.iter().cloned()).collect()
}

#[test]
fn every_target_survives_its_corpus_and_random_damage() {
    let seconds = std::env::var("RUNGC_FUZZ_SECONDS")
        .ok()
        .and_then(|text| text.parse().ok());
    let time = seconds.map_or(SHORT, Duration::from_secs);
    let mut random = Random::new(seconds.unwrap_or_default());
    let only = std::env::var("RUNGC_FUZZ").ok();
    let is_wanted = |target: &&Target| only.as_ref().is_none_or(|only| only == target.name);
    for target in all().iter().filter(is_wanted) {
        let inputs = inputs(target);
        assert!(
            !inputs.is_empty(),
            "{} has neither corpus nor seeds",
            target.name
        );
        inputs.iter().for_each(|input| run(target, input));
        let begin = Instant::now();
        let mut runs = 0;
        // At least some, however slow the machine is.
        while begin.elapsed() < time || runs < 20 {
            let chosen = random.below(inputs.len());
            let mut input = random.damage(&inputs[chosen]);
            if random.below(4) == 0 {
                input.extend_from_slice(&inputs[random.below(inputs.len())]);
            }
            run(target, &input);
            runs += 1;
        }
        println!("{}: {runs} random inputs", target.name);
    }
}

#[test]
fn every_corpus_belongs_to_a_target() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let targets = all();
    for entry in fs::read_dir(folder).unwrap() {
        let name = entry.unwrap().file_name();
        assert!(
            targets.iter().any(|target| *target.name == *name),
            "{name:?}"
        );
    }
}

/// Folders without functions that the command line and its users call; what reads in the command line itself is private
/// to it.
const OUTSIDE: [&str; 4] = ["cli/rungc", "examples", "golden", "target"];

/// Prefixes of the names of functions that read foreign data.
const VERBS: [&str; 8] = [
    "accept", "answer", "decode", "open", "parse", "read", "receive", "take",
];

/// Functions of these names that interpret nothing; those of a serial port pass on what the system brings.
const NO_READERS: [&str; 7] = [
    "codegen-c/src/code.rs open",
    "codegen-c/src/page.rs open",
    "runtime-rt/host/src/io/no_serial.rs open",
    "runtime-rt/host/src/io/no_serial.rs receive",
    "runtime-rt/host/src/io/sys.rs open",
    "runtime-rt/host/src/io/sys.rs receive",
    "runtime-rt/sources/src/cache.rs take",
];

/// Readers and decoders, each with a target that calls it.
#[rustfmt::skip]
const READERS: [(&str, &str); 50] = [
    ("cli/dap/src/protocol.rs read", "debugging"),
    ("cli/library/src/trace.rs read", "recording"),
    ("firmware/src/board.rs parse", "board"),
    ("firmware/src/flash.rs read", "flash-file"),
    ("firmware/src/flash/uf2.rs read", "flash-file"),
    ("sim/fleet/src/format.rs parse", "fleet-file"),
    ("frontend/formats/src/gx/program.rs read", "gx-developer"),
    ("frontend/formats/src/gx/works2/container.rs open", "gx-works2"),
    ("frontend/formats/src/gx/works2/objects.rs read", "gx-works2"),
    ("frontend/formats/src/gx/works2/sources/gather.rs read_parts", "gx-works2-sources"),
    ("frontend/formats/src/il/mod.rs read_text", "instruction-list"),
    ("frontend/formats/src/lib.rs read_bytes", "memory-image"),
    ("frontend/formats/src/lib.rs read_bytes_with", "plcopen"),
    ("frontend/formats/src/lib.rs read_from", "instruction-list"),
    ("frontend/formats/src/plcopen/mod.rs read", "plcopen"),
    ("frontend/formats/src/plcopen/variables.rs parse", "variable-names"),
    ("frontend/formats/src/plcopen/variables.rs read", "variable-names"),
    ("project/src/lib.rs parse", "settings"),
    ("project/src/reader.rs read", "settings"),
    ("project/src/serve.rs parse", "words"),
    ("project/src/serve.rs parse_can", "words"),
    ("runtime-rt/host/src/duration.rs parse", "words"),
    ("runtime-rt/host/src/duration.rs parse_within", "words"),
    ("runtime-rt/host/src/io/settings.rs read", "connections"),
    ("runtime-rt/host/src/io/text.rs parse", "connections"),
    ("runtime-rt/host/src/io/topics.rs take", "connections"),
    ("runtime-rt/host/src/servers/dialogue.rs receive", "mc"),
    ("runtime-rt/rt/src/comm/can.rs parse", "decode-can"),
    ("runtime-rt/rt/src/comm/computer_link.rs answer", "decode-computer-link"),
    ("runtime-rt/rt/src/comm/computer_link.rs answer_late", "decode-computer-link"),
    ("runtime-rt/rt/src/comm/computer_link/master.rs accept", "computer-link-master"),
    ("runtime-rt/rt/src/comm/fx_port.rs answer", "decode-programming-port"),
    ("runtime-rt/rt/src/comm/link.rs receive", "nn-slave"),
    ("runtime-rt/rt/src/comm/mc.rs answer", "decode-tcp"),
    ("runtime-rt/rt/src/comm/modbus/adu.rs open", "decode-modbus-slave"),
    ("runtime-rt/rt/src/comm/modbus/adu.rs open_ascii", "decode-modbus-slave"),
    ("runtime-rt/rt/src/comm/modbus/adu.rs open_rtu", "decode-modbus-slave"),
    ("runtime-rt/rt/src/comm/modbus/exchange.rs receive", "modbus-rtu-master"),
    ("runtime-rt/rt/src/comm/modbus/master.rs accept", "decode-modbus-master"),
    ("runtime-rt/rt/src/comm/modbus/slave.rs answer", "decode-modbus-slave"),
    ("runtime-rt/rt/src/comm/modbus/tcp.rs answer", "decode-tcp"),
    ("frontend/formats/src/table.rs read_table", "safety-functions"),
    ("sim/sim/src/plant/format/mod.rs parse", "machine"),
    ("sim/sim/src/plctest/mod.rs parse", "test-file"),
    ("sim/sim/src/property/parse.rs parse", "condition"),
    ("sim/sim/src/property/token.rs parse", "condition"),
    ("sim/sim/src/protocol.rs parse", "words"),
    ("sim/sim/src/serve/decode.rs decode", "overheard"),
    ("sim/sim/src/target.rs parse", "words"),
    ("verify/functions/src/matrix/cell.rs parse", "safety-functions"),
];

/// The public functions in the sources that take texts or bytes and whose names say that they read them.
fn readers() -> BTreeSet<String> {
    let root = Path::new(env!("RUNGC_ROOT"));
    let is_ours = |entry: &DirEntry| {
        let path = entry.path();
        let hidden = entry.depth() > 0 && entry.file_name().to_string_lossy().starts_with('.');
        !hidden && OUTSIDE.iter().all(|outside| path != root.join(outside))
    };
    let folders = WalkDir::new(root).max_depth(2);
    let folders = folders.into_iter().filter_entry(is_ours);
    let sources = folders.map(|entry| entry.unwrap().path().join("src"));
    let sources = sources.filter(|src| src.is_dir() && src.with_file_name("Cargo.toml").exists());
    let files = sources.flat_map(WalkDir::new);
    let mut found = BTreeSet::new();
    for file in files.map(|file| file.unwrap()) {
        let path = file.path();
        let is_source = path.extension().is_some_and(|extension| extension == "rs");
        if !is_source || path.ends_with("tests.rs") {
            continue;
        }
        let text = fs::read_to_string(path).unwrap();
        for function in text.split("pub fn ").skip(1) {
            let signature = function.split('{').next().unwrap_or_default();
            let takes = signature.split("->").next().unwrap_or_default();
            let ends = |c: char| !c.is_alphanumeric() && c != '_';
            let name = function.split(ends).next().unwrap_or_default();
            let verb = name.split('_').next().unwrap_or_default();
            let reads = ["&str", "[u8]", "&Source"]
                .iter()
                .any(|kind| takes.contains(kind));
            if reads && VERBS.contains(&verb) {
                let path = path.strip_prefix(root).unwrap().display();
                found.insert(format!("{path} {name}"));
            }
        }
    }
    found
}

#[test]
fn every_reader_has_a_target() {
    let targets = all();
    let known: BTreeSet<String> = READERS
        .iter()
        .map(|(reader, _)| *reader)
        .chain(NO_READERS)
        .map(str::to_string)
        .collect();
    assert_eq!(
        readers(),
        known,
        "the table of readers is to have all of them"
    );
    for (reader, name) in READERS {
        assert!(
            targets.iter().any(|target| target.name == name),
            "{reader}: {name}"
        );
    }
}
