//! Each shape of program as emitted, and all of them built.

use crate::common;
use rungc_codegen_rust::{Options, Runtime, emit};
use rungc_ir::Module;

/// A shape: its name, and the program.
type Shape<'a> = (&'a str, &'a str);

const LADDER: Shape<'static> = (
    "ladder",
    "LD X0 ; start\nOR M0\nANI X1\nOUT M0 ; motor latch\nLD M0\nOUT T0 K30\nAND T0\nOUT Y0\nLDP X2\nADD D0 K1 D0\n\
     LD>= D0 K10\nSET Y1\nEND\n",
);
const COILS: Shape<'static> = (
    "coils",
    "LD X0\nOUT C0 K5\nLD X1\nRST C0\nLD X2\nOUT M8200\nLD X3\nOUT C200 D10\nLD X4\nOUT T246 K20\nLD X5\nRST T246\nLD C200\nPLS M1\n\
     LDF X6\nPLF M2\nEND\n",
);
const WORDS: Shape<'static> = (
    "words",
    "LD X0\nMOV D30 Z0\nDMOV D0 D2\nDADD D0 D2 D4\nDIV D0 D1 D8\nMOV K2M0 D10\nMOV D10 K1Y0\nLDD> D0 K100000\nOUT Y10\nLD X1\nMOV D0Z0 D20\n\
     WAND D0 HFF D1\nINCP D3\nEND\n",
);
const CALLS: Shape<'static> = (
    "runtime_calls",
    "LD X0\nMOV D30 Z1\nBMOV D0 D10 K10\nDECO M0 D1 K3\nDMEAN D2 D4 K2\nDSIN E1.5 D20\nDEADD D20 E1.5 D22\nFMOV K0 D100Z1 K4\nEND\n",
);
const BLOCKS: Shape<'static> = (
    "indexed_blocks",
    "LD X0\nWAND D10 H0F Z0\nMOV D13 Z1\nBMOV D100Z0 D300 K20\nBMOV D300 D100Z0 K30\nFMOV D12 D100Z0 K20\nDFMOV K5 D100Z0 K4\n\
     ZRST M100Z0 M131Z0\nSFTL X0 M100Z0 K32 K4\nWSFL D300Z0 D100Z0 K16 K2\nSFWR D12 D100Z0 K10\nSFRD D100Z0 D12 K10\n\
     BMOV D0Z1 D300 K20\nFMOV K0 D0Z1 K9\nEND\n",
);
const FLOW: Shape<'static> = (
    "flow",
    "LD X0\nCALL P1\nFOR K3\nLD X1\nINC D0\nNEXT\nLD X2\nMC N0 M100\nLD X3\nOUT Y0\nMCR N0\nFEND\nP1\nLD X4\nOUT Y1\nSRET\nEND\n",
);
const JUMPS: Shape<'static> = (
    "jumps_that_cross",
    "LD X0\nCJ P0\nLD X1\nCJ P1\nLD X2\nOUT Y0\nP0\nLD X3\nOUT Y1\nLD X4\nCJ P2\nP1\nLD X5\nOUT Y2\nP2\nLD X6\nOUT Y3\nEND\n",
);
const STEPS: Shape<'static> = (
    "steps",
    "LD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\nOUT Y0\nLD X1\nOUT S0\nRET\nEND\n",
);

const SHAPES: [Shape<'static>; 8] = [LADDER, COILS, WORDS, CALLS, BLOCKS, FLOW, JUMPS, STEPS];

fn module((name, text): Shape) -> Module {
    common::compiled(name, text)
}

fn options() -> Options {
    Options {
        main: false,
        servers: false,
        io: false,
        unsaved: None,
        defmt: false,
        runtime: common::runtime(),
    }
}

fn program(shape: Shape) -> String {
    let files = emit(&module(shape), &options());
    let file = files
        .into_iter()
        .find(|file| file.path == "src/program.rs")
        .unwrap();
    // The part before the imports is the same in all.
    let code = file.contents.find("use crate").unwrap_or_default();
    file.contents[code..].to_string()
}

#[test]
fn ladder() {
    insta::assert_snapshot!(program(LADDER));
}

#[test]
fn coils() {
    insta::assert_snapshot!(program(COILS));
}

#[test]
fn words() {
    insta::assert_snapshot!(program(WORDS));
}

#[test]
fn runtime_calls() {
    insta::assert_snapshot!(program(CALLS));
}

#[test]
fn indexed_blocks() {
    insta::assert_snapshot!(program(BLOCKS));
}

#[test]
fn flow() {
    insta::assert_snapshot!(program(FLOW));
}

#[test]
fn jumps_that_cross() {
    insta::assert_snapshot!(program(JUMPS));
}

#[test]
fn steps() {
    insta::assert_snapshot!(program(STEPS));
}

#[test]
fn shapes_build_without_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let names: Vec<String> = SHAPES.iter().map(|(name, _)| format!("{name:?}")).collect();
    let workspace = format!(
        "[workspace]\nresolver = \"3\"\nmembers = [{}]\n",
        names.join(", ")
    );
    std::fs::write(folder.path().join("Cargo.toml"), workspace).unwrap();
    for shape in SHAPES {
        let mut files = emit(&module(shape), &options());
        for file in &mut files {
            // Here they are members of one workspace, to build the runtime once.
            file.contents = file.contents.replace("[workspace]\n", "");
        }
        common::write(&folder.path().join(shape.0), &files);
    }
    common::cargo(folder.path(), &["clippy", "--workspace"]);
}

#[test]
fn long_programs_are_split() {
    let mut text = String::new();
    for i in 0..600 {
        text.push_str(&format!(
            "LD X0\nMC N0 M100\nLD M{i}\nOUT M{}\nMCR N0\n",
            i + 1
        ));
        text.push_str(&format!("LD M{i}\nADD D0 K{i} D0\n"));
    }
    text.push_str("END\n");
    let files = emit(&module(("long", &text)), &options());
    let parts: Vec<_> = files
        .iter()
        .filter(|file| file.path.starts_with("src/program/part"))
        .collect();
    assert!(parts.len() > 3, "{} files", parts.len());
    for file in files {
        let lines = file.contents.lines().count();
        let limit = if file.path.starts_with("src/program/") {
            900
        } else {
            5000
        };
        assert!(lines < limit, "{}: {lines} lines", file.path);
    }
}

#[test]
fn very_many_timer_coils_share_the_code_of_timers() {
    let shared = |coils: usize| {
        // Other presets, or they would be a loop.
        let coil = |n| format!("LD X0\nOUT T{} K{}\n", n % 150, n * n % 997);
        let text = (0..coils).map(coil).collect::<String>() + "END\n";
        let files = emit(&module(("many", &text)), &options());
        let mut texts = files.iter().filter(|f| f.path.starts_with("src/program"));
        texts.any(|f| f.contents.contains("#[inline(never)]"))
    };
    assert!(!shared(1000));
    assert!(shared(1001));
}

/// With defmt a crate has a feature, which adds a file; nothing else of it changes, and nothing is locked.
#[test]
fn defmt() {
    let module = module(LADDER);
    let emitted = |defmt| {
        let options = Options {
            defmt,
            runtime: Runtime::Included,
            ..options()
        };
        emit(&module, &options)
    };
    let (plain, with) = (emitted(false), emitted(true));
    let text = |path: &str| {
        let file = with.iter().find(|file| file.path == path);
        file.unwrap().contents.as_str()
    };
    let (manifest, format) = (text("Cargo.toml"), text("src/format.rs"));
    insta::assert_snapshot!(format!("{manifest}---\n{format}"));
    for file in plain.iter().filter(|file| file.path != "Cargo.toml") {
        let other = with.iter().find(|other| other.path == file.path);
        let module = "#[cfg(feature = \"defmt\")]\nmod format;\n";
        let other = other.map(|other| other.contents.replace(module, ""));
        assert_eq!(
            other.as_deref(),
            (file.path != "Cargo.lock").then_some(file.contents.as_str()),
            "{}",
            file.path
        );
    }
    assert_eq!(with.len(), plain.len());
    assert!(text("src/lib.rs").contains("mod format;\n"));
}
