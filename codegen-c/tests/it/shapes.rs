//! C code for each shape of program: small lists, and their C, strictly compiled and started.

use crate::build::{program_text, run_c};
use rungc_codegen_c::{Options, emit};
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;

fn module(list: &str, model: ModelId) -> Module {
    let program = rungc_frontend::read_text("shape.il", list).program;
    let options = CompileOptions {
        model: Some(model),
        name: Some("shape".to_string()),
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    let diagnostics = compiled.diagnostics;
    compiled
        .module
        .unwrap_or_else(|| panic!("{list}: {diagnostics:?}"))
}

/// The emitted program of a list, which compiles without a warning and survives three scans.
fn shape(list: &str, model: ModelId) -> String {
    let module = module(list, model);
    let scans = "shape_plc plc;\nshape_init(&plc);\nfor (uint32_t i = 0; i < 3; i++) {\nshape_scan(&plc, 10 * i, 0);\n}\nputs(\"done\");";
    assert_eq!(run_c(&module, scans), "done\n");
    program_text(&module)
}

macro_rules! shapes {
    ($($name:ident: $model:ident, $list:literal;)*) => {
        $(#[test]
        fn $name() {
            insta::assert_snapshot!(shape($list, ModelId::$model));
        })*
    };
}

shapes! {
    contacts: Fx3u, "LD X0\nOR M0\nANI X1\nOUT M0\nLDI X1\nLD X2\nOR X3\nANB\nOUT Y0\nLD X4\nMPS\nAND X5\nOUT Y1\nMPP\nANI X6\nOUT Y2\nEND";
    edges: Fx3u, "LDP X0\nSET Y0\nLDF X0\nRST Y0\nLD X1\nPLS M0\nLD X2\nPLF M1\nLDP X3\nOUT C0 K5\nLD X4\nANDP X5\nOUT Y1\nLD X6\nINCP D0\nEND";
    timers: H2u, "LD X0\nOUT T0 K10\nOUT T1 D0\nOUT T200 K5\nOUT T250 K100\nOUT T192 K3\nLD X1\nRST T250\nLD T0\nOUT Y0\nEND";
    timers_that_overrun: Hm, "LD X0\nOUT T0 K10\nLD T0\nOUT Y0\nEND";
    counters: Fx3u, "LD X0\nOUT C0 K10\nOUT C200 K70000\nOUT M8200\nLD X1\nRST C0\nRST C200\nLDD>= C200 K5\nOUT Y0\nEND";
    arithmetic: Fx3u, "LD X0\nADD D0 D2 D4\nSUB D0 K1 D0\nMUL D0 D2 D6\nDIV D0 D2 D8\nDADD D10 D12 D14\nINC D20\nWAND D0 H0FF D1\nNEG D3\nLD M8022\nOUT Y0\nEND";
    groups: Fx3u, "LD X0\nMOV K4X0 D0\nMOV D0 K2Y0\nMOV K1M0 D1\nDMOV K8M0 D2\nSET D0.5\nLD D0.A\nOUT Y20\nEND";
    indexed: Fx3u, "LD X0\nMOV D200 Z0\nMOV D201 Z1\nMOV D202 V1\nMOV D0Z0 D10V1\nMOV K4M0Z1 D100\nADD D0Z0 K1 D0Z0\nOUT M8067\nEND";
    indexed_blocks: Fx3u, "LD X0\nWAND D10 H0F Z0\nBMOV D100Z0 D300 K20\nBMOV D300 D100Z0 D11\nFMOV D12 D100Z0 K20\nDFMOV K5 D100Z0 K4\nZRST D100Z0 D119Z0\nSFTL X0 M100Z0 K32 K4\nWSFL R0 D100Z0 K16 K2\nSFWR D12 D100Z0 K10\nSFRD D100Z0 D12 K10\nXCH D100Z0 D101Z0\nDMOV D100Z0 D20\nDMOV D20 D100Z0\nEND";
    blocks_anywhere: Fx3u, "LD X0\nMOV D10 Z0\nMOV D11 V0\nBMOV D100Z0 R300V0 K20\nBMOV D100Z0 D300V0 D12\nFMOV K5 D100Z0 K20\nZRST M100Z0 M200V0\nLD X1\nOUT M8024\nEND";
    repeated: Fx3u, "FOR K5\nLD X0\nINC D0\nFOR D1\nLD X1\nINC D2\nNEXT\nNEXT\nEND";
    jumps: Fx3u, "LD X0\nCJ P0\nLD X1\nOUT Y0\nP0\nLD X2\nOUT Y1\nP1\nLD X3\nINC D0\nLD X4\nCJ P1\nLD X5\nOUT Y2\nEND";
    tangled_jumps: Fx3u, "LD X0\nMC N0 M0\nLD X1\nCJ P1\nP2\nLD X2\nOUT Y0\nP1\nLD X3\nOUT Y1\nLD X4\nCJ P2\nMCR N0\nLD X5\nOUT Y2\nEND";
    subroutines: Fx3u, "LD X0\nCALL P1\nLD X1\nCALL P2\nFEND\nP1\nLD M0\nCALL P2\nSRET\nP2\nLD X2\nOUT Y0\nSRET\nEND";
    master_control: Fx3u, "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nLD X2\nOUT T0 K10\nMCR N0\nEND";
    steps: Fx3u, "LD M8002\nSET S0\nSTL S0\nOUT Y0\nLD X0\nSET S20\nSTL S20\nOUT Y1\nLD X1\nOUT S0\nRET\nEND";
    special_devices: Fx3u, "LD M8013\nOUT Y0\nLD M8002\nMOV D8010 D0\nLD X0\nOUT M8034\nEND";
    latched: Hm, "LD X0\nOUT M0\nMOV K1 D1000\nMOV K2 D0\nEND";
}

/// Many output terminals are found by a table of places, gaps in it included.
#[test]
fn many_outputs() {
    let list = "LD X0\nOUT Y0\nOUT Y1\nOUT Y2\nOUT Y3\nOUT Y4\nOUT Y5\nOUT Y6\nOUT Y10\nLD X1\nOUT Y7\nOUT Y12\nEND";
    let module = module(list, ModelId::Fx3u);
    let on = "shape_plc plc;\nshape_init(&plc);\nplc.X0 = true;\nshape_scan(&plc, 0, 0);\nfor (unsigned i = 0; i < 20; i++) {\nputchar(shape_output(&plc, i) ? '1' : '0');\n}\nputs(\"\");";
    assert_eq!(run_c(&module, on), "11111110100000000000\n");
}

#[test]
fn instructions_of_the_runtime() {
    let list =
        "LD X0\nBMOV D0 D50 K10\nDWSUM D0 D20 K2\nDSIN D0 D10\nMOV K1 D0\nBMOV K4M0 D20 K2\nEND";
    let module = module(list, ModelId::Fx3u);
    insta::assert_snapshot!(program_text(&module));
    let files = emit(&module, &Options::default());
    let paths: Vec<&str> = files
        .iter()
        .map(|f| f.path.as_str())
        .filter(|p| !p.starts_with("rungc-rt/src/") && !p.starts_with("rungc-rt/libm/"))
        .collect();
    assert_eq!(
        paths,
        [
            "shape.h",
            "shape.c",
            "rungc.h",
            "rungc_rt.h",
            "rungc-rt/Cargo.toml",
            "rungc-rt/Cargo.lock",
            "CMakeLists.txt",
            "Makefile"
        ]
    );
    let makefile = &files.last().expect("a Makefile").contents;
    insta::assert_snapshot!(makefile);
}

/// Pulses take a C compiler and nothing else.
#[test]
fn pulses_need_no_library() {
    let list = "LD X0\nPLSY K1000 K25 Y0\nLD M8029\nOUT Y1\nEND";
    let module = module(list, ModelId::Fx3u);
    let files = emit(&module, &Options::default());
    for file in &files {
        assert!(!file.contents.contains("cargo"), "{}", file.path);
    }
    let main = "shape_plc plc;\nshape_init(&plc);\nplc.X0 = true;\n\
                for (uint32_t ms = 0; ms < 40u; ms++) {\nshape_tick(&plc, ms);\nshape_scan(&plc, ms, 1000);\n}\n\
                printf(\"%ld %d\\n\", (long)plc.axis[0].sent, shape_output(&plc, 1));";
    assert_eq!(run_c(&module, main), "25 1\n");
}

#[test]
fn the_same_bytes_every_time() {
    let list =
        "FOR D1\nLD X0\nINC D0Z0\nNEXT\nLD X1\nCALL P1\nFEND\nP1\nLD X2\nOUT T0 K10\nSRET\nEND";
    let emitted = || {
        emit(
            &module(list, ModelId::H2u),
            &Options {
                main: true,
                ..Options::default()
            },
        )
    };
    assert!(emitted() == emitted());
}

/// Long programs are divided: no function holds more than a screen or two, and the files compile one by one.
#[test]
fn long_programs_are_divided() {
    let mut list = String::from("LD X0\nMC N0 M0\n");
    for i in 0..6000 {
        list.push_str(&format!(
            "LD M{}\nANI X1\nOUT M{}\n",
            i % 2000,
            100 + i % 1999
        ));
    }
    list.push_str("MCR N0\nEND\n");
    let files = emit(&module(&list, ModelId::Fx3u), &Options::default());
    let longest = files
        .iter()
        .filter(|f| f.path.ends_with(".c"))
        .flat_map(|f| f.contents.split("\n}\n"))
        .map(|f| f.lines().count())
        .max();
    assert!(longest < Some(700), "{longest:?}");
}
