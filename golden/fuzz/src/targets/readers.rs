//! Files: whatever a file contains, it is read or rejected, with places that lie in it.

use super::Target;
use rungc_frontend::{Names, ReadOptions, sources};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_project::Project;
use rungc_syntax::Source;
use std::path::Path;

/// A program in any of its formats, which is also compiled.
fn program(input: &[u8]) {
    read(input, &ReadOptions::default());
}

/// A project of PLCopen XML, with devices for its variables.
fn plcopen(input: &[u8]) {
    let free = "*,M100-M199\n*,T0-T9\n*,T200-T209\n*,C0-C9\n*,D100-D199\n*,S20-S99\n";
    let names = Names::parse(free).unwrap_or_default();
    read(
        input,
        &ReadOptions {
            names,
            ..ReadOptions::default()
        },
    );
}

fn read(input: &[u8], options: &ReadOptions) {
    let Ok(read) = rungc_frontend::read_bytes_with("program", input, options) else {
        return;
    };
    let source = &read.program.source;
    for finding in read.diagnostics.iter() {
        assert!(
            source.text.get(finding.span.range()).is_some(),
            "{finding:?}"
        );
    }
    let options = CompileOptions {
        optimise: true,
        ..CompileOptions::default()
    };
    for finding in compile(&read.program, &options).diagnostics.iter() {
        assert!(
            source.text.get(finding.span.range()).is_some(),
            "{finding:?}"
        );
    }
}

/// Parts of a GX Works2 project that its container holds. The first byte selects the damaged one.
const PARTS: [&str; 8] = [
    "MAIN.Program.pou",
    "MAIN.Labels.lh",
    "Global1.gh",
    "Axis.str",
    "MAIN.tsk",
    "Half.Program\\Maths.lnb",
    "ESCompiler.stg",
    "press.prj",
];

/// Sources of a GX Works2 project, and all that is written of them.
fn sources(input: &[u8]) {
    let Some((first, content)) = input.split_first() else {
        return;
    };
    let name = PARTS[usize::from(*first) % PARTS.len()];
    let sources = sources::read_parts(&[(name, content)], &ReadOptions::default());
    for unread in &sources.unread {
        assert!(!unread.what.is_empty(), "{unread:?}");
    }
    let files = [sources.to_st(), sources.to_label_tables("press")].concat();
    assert!(files.iter().all(|file| !file.path.contains("..")));
    let _ = (sources.to_labels(), sources.devices());
}

fn settings(input: &[u8]) {
    if let Ok(text) = std::str::from_utf8(input) {
        let _ = Project::parse(Path::new("rungc.toml"), text);
    }
}

fn test_file(input: &[u8]) {
    if let Ok(text) = std::str::from_utf8(input) {
        let _ = rungc_sim::plctest::parse("test.plctest.toml", text);
    }
}

fn machine(input: &[u8]) {
    if let Ok(text) = std::str::from_utf8(input) {
        let _ = rungc_sim::plant::parse("machine.toml", text);
    }
}

fn board(input: &[u8]) {
    if let Ok(text) = std::str::from_utf8(input) {
        let _ = rungc_firmware::board::parse(&Source::new("board.toml", text), Path::new(""));
    }
}

pub(super) fn targets() -> Vec<Target> {
    let target = |name, run: fn(&[u8]), seeds: &[&str]| Target {
        name,
        run: Box::new(run),
        seeds: seeds.iter().map(|seed| seed.as_bytes().to_vec()).collect(),
    };
    vec![
        target(
            "instruction-list",
            program,
            &[
                "LD X000\nOR M0\nANI X001\nOUT M0\nMOV K4X000 D0Z1\nLD= D0 K10\nOUT T0 K3\nEND\n",
                "LDP X0\nCALL P1\nFEND\nP1\nFOR K3\nDMOV H12345678 D10\nNEXT\nSRET\nSTL S20\nSET S21\nRET\nEND\n",
            ],
        ),
        target(
            "list-export",
            program,
            &[
                "\"Step No.\",\"Line Statement\",\"Instruction\",\"I/O (Device)\",\"Blank\",\"P/I Statement\",\"Note\"\n\"0\",\"\",\"LD\",\"X000\",\"\",\"\",\"\"\n\"1\",\"\",\"MOV\",\"K1\",\"\",\"\",\"\"\n\"\",\"\",\"\",\"D0\",\"\",\"\",\"\"\n\"6\",\"\",\"END\",\"\",\"\",\"\",\"\"\n",
            ],
        ),
        target(
            "ladder-text",
            program,
            &[
                "; Motor\n12 |--[ X000 ]--+--[/ X001]--( M0 )--|  ; latch\n   |--[ M0 ]----+                    |\nP0 |--[>= D0 K10]--/--[MOV K1 D0]--|\n",
                " │  X000     X001             →0│\n ├──┤ ├───┬──┤↑├────┬────────→0│\n │0→      │         │           │\n ├0→──────┴─────────┴──(T0 K30)┤\nEND\n",
                "   │  X000                │\n   ├──┤ ├─────[MC N0 M100]┤\nN0═╪═ M100                │\n|--(Y1)--|\n|--[MCR N0]--|\n",
            ],
        ),
        target("gx-developer", program, &[]),
        target("gx-works2", program, &[]),
        target("gx-works2-sources", sources, &[]),
        target("memory-image", program, &[]),
        target("plcopen", plcopen, &[]),
        target(
            "settings",
            settings,
            &[
                "[project]\nprogram = \"a.il\"\nmodel = \"h2u\"\n[latch]\nM = \"M500-M1023\"\n[[modbus]]\nstation = 2\nread = \"registers\"\naddress = 0x1001\nbuffer = \"D20\"\n[serve]\nD = \"D0-D511\"\nmodbus-tcp = \"127.0.0.1:5020\"\n",
            ],
        ),
        target(
            "test-file",
            test_file,
            &[
                "model = \"h2u\"\ntopic = \"a\"\n[[case]]\nname = \"b\"\nwire = [[\"COM1\", \"B:COM1\"]]\nprogram = \"LD X000\\nEND\\n\"\ninit = { D0 = 1 }\n[[case.plc]]\nname = \"B\"\nprogram = \"END\"\n[[case.step]]\nset = { X000 = 1, \"D0.f32\" = 1.5 }\nrx = { COM1 = \"01 /20 41!p\", CAN = \"200#12\" }\nrun_ms = 100\nexpect = { D0 = \"0x12\" }\nexpect_tx = { COM1 = [\"15\", \"\"] }\n",
            ],
        ),
        target(
            "machine",
            machine,
            &["[[axis]]\noutput = \"Y000\"\nencoder = { a = \"X000\", b = \"X001\" }\n"],
        ),
        target("board", board, &[]),
    ]
}
