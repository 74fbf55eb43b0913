//! Instructions that are inline code do what the runtime's functions do.
//!
//! Each is compiled twice: as it is written here, which is inline code, and with an index of 0 somewhere, which makes
//! it a call of the runtime. Both run in the interpreter with the same random data, and all of their devices are
//! compared.

use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};
use rungc_syntax::DeviceClass;

/// Instructions, and the same as calls: Z7 stays 0.
const PAIRS: &[(&str, &str)] = &[
    ("SMOV D0 K4 K2 D1 K3", "SMOV D0 K4 K2 D1 K3Z7"),
    ("SMOV D0 K1 K1 D1 K4", "SMOV D0 K1 K1 D1 K4Z7"),
    ("SMOV D0 K4 K4 D0 K4", "SMOV D0 K4 K4 D0 K4Z7"),
    ("SMOV K4M0 K3 K2 K3M8 K2", "SMOV K4M0 K3 K2 K3M8 K2Z7"),
    ("RCR D0 K1", "RCR D0 K1Z7"),
    ("RCR D0 K7", "RCR D0 K7Z7"),
    ("RCR D0 K16", "RCR D0 K16Z7"),
    ("RCL D0 K1", "RCL D0 K1Z7"),
    ("RCL D0 K15", "RCL D0 K15Z7"),
    ("RCL D0 K16", "RCL D0 K16Z7"),
    ("DRCR D0 K5", "DRCR D0 K5Z7"),
    ("DRCL D0 K16", "DRCL D0 K16Z7"),
    ("RCL K4M0 K3", "RCL K4M0 K3Z7"),
    ("DECO D0 D1 K4", "DECO D0 D1 K4Z7"),
    ("DECO D0 D0 K1", "DECO D0 D0 K1Z7"),
    ("DECO M0 D0 K3", "DECO M0 D0 K3Z7"),
    ("DECO M0 M2 K3", "DECO M0 M2 K3Z7"),
    ("DECO D0 M0 K4", "DECO D0 M0 K4Z7"),
    ("TCMP D0 K59 D1 D2 M0", "TCMP D0 K59 D1 D2Z7 M0"),
    ("TCMP K3 K4 K5 D2 D0.E", "TCMP K3 K4 K5 D2Z7 D0.E"),
    ("TZCP D0 D3 D6 M10", "TZCP D0 D3 D6Z7 M10"),
    ("TADD D0 D3 D6", "TADD D0 D3 D6Z7"),
    ("TADD D0 D1 D2", "TADD D0Z7 D1 D2"),
    ("TSUB D0 D3 D0", "TSUB D0Z7 D3 D0"),
    ("TSUB D6 D3 D4", "TSUB D6 D3 D4Z7"),
    ("HTOS D0 D3", "HTOS D0Z7 D3"),
    ("DHTOS D0 D1", "DHTOS D0Z7 D1"),
    ("HTOS D0 K4M8", "HTOS D0Z7 K4M8"),
    ("STOH D0 D0", "STOH D0 D0Z7"),
    ("DSTOH D0 D1", "DSTOH D0 D1Z7"),
    ("STOH K3M0 D7", "STOH K3M0 D7Z7"),
    ("SFTL M20 M0 K16 K3", "SFTL M20 M0 K16Z7 K3"),
    ("SFTR M20 M0 K16 K16", "SFTR M20 M0 K16Z7 K16"),
    ("DECO D0 M3 K5", "DECO D0 M3 K5Z7"),
    ("DECO M0 M3 K5", "DECO M0 M3 K5Z7"),
    ("SFTL M38 M0 K38 K2", "SFTL M38 M0 K38Z7 K2"),
    ("SFTR M38 M0 K38 K2", "SFTR M38 M0 K38Z7 K2"),
    ("SFTL M0 M5 K30 K7", "SFTL M0 M5 K30Z7 K7"),
    ("SFTR M20 M0 K38 K18", "SFTR M20 M0 K38Z7 K18"),
    ("SFTL M2 M2 K30 K30", "SFTL M2 M2 K30Z7 K30"),
    ("WSFL D0 D10 K4 K2", "WSFL D0 D10 K4Z7 K2"),
    ("WSFR D0 D1 K30 K3", "WSFR D0 D1 K30Z7 K3"),
    ("WSFL D0 D1 K30 K3", "WSFL D0 D1 K30Z7 K3"),
    ("WSFL D10 D10 K30 K20", "WSFL D10 D10 K30Z7 K20"),
    ("WSFL D0 D2 K8 K5", "WSFL D0 D2 K8Z7 K5"),
    ("SFWR D0 D1 K9", "SFWR D0 D1 K9Z7"),
    ("SFWR K4M0 D1 K3", "SFWR K4M0 D1 K3Z7"),
    ("SFWR D3 D1 K30", "SFWR D3 D1 K30Z7"),
    ("SFRD D1 D0 K9", "SFRD D1 D0 K9Z7"),
    ("SFRD D1 D3 K5", "SFRD D1 D3 K5Z7"),
    ("SFRD D1 K4M3 K2", "SFRD D1 K4M3 K2Z7"),
    ("SFRD D1 D0 K30", "SFRD D1 D0 K30Z7"),
    ("ENCO D0 D1 K4", "ENCO D0 D1 K4Z7"),
    ("ENCO D0 D0 K2", "ENCO D0 D0 K2Z7"),
    ("ENCO M0 D0 K1", "ENCO M0 D0 K1Z7"),
    ("ENCO M0 D0 K2", "ENCO M0 D0 K2Z7"),
    ("ENCO M3 D0 K5", "ENCO M3 D0 K5Z7"),
    ("ABSD D0 C0 M0 K8", "ABSD D0Z7 C0 M0 K8"),
    ("DABSD D0 C200 M3 K4", "DABSD D0Z7 C200 M3 K4"),
    ("MEAN D0 D9 K8", "MEAN D0Z7 D9 K8"),
];

/// Devices of each class that are set and compared.
const DEVICES: u32 = 40;

/// Flags of arithmetic.
const FLAGS: std::ops::RangeInclusive<u32> = 8020..=8022;

/// An instruction that is executed while X0 is on.
fn compiled(instruction: &str, flags: bool) -> Module {
    let text = format!("LD X000\n{instruction}\nEND\n");
    let read = rungc_frontend::read_text("test.il", &text);
    let mut observe = vec![(DeviceClass::M, 8067), (DeviceClass::D, 8067)];
    for number in 0..DEVICES {
        observe.extend([DeviceClass::D, DeviceClass::M].map(|class| (class, number)));
    }
    if flags {
        observe.extend(FLAGS.map(|number| (DeviceClass::M, number)));
    }
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        observe,
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let diagnostics = compiled.diagnostics;
    compiled
        .module
        .unwrap_or_else(|| panic!("{instruction}: {diagnostics:?}"))
}

fn calls(module: &Module) -> bool {
    let mut calls = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            calls |= matches!(stmt, Stmt::Do(Action::Call(_)));
        });
    }
    calls
}

/// Everything that is compared.
fn picture(machine: &Machine, flags: bool) -> (Vec<Option<i16>>, Vec<Option<bool>>) {
    let words = (0..DEVICES).chain([8067]);
    let bits = (0..DEVICES).chain([8067]).chain(FLAGS.filter(|_| flags));
    (
        words.map(|n| machine.word(Class::D, n)).collect(),
        bits.map(|n| machine.bit(Class::M, n)).collect(),
    )
}

/// Sets all devices to what is often near a border.
fn fill(rng: &mut Rng, machines: &mut [Machine; 2]) {
    for n in 0..DEVICES {
        let (word, bit) = (rng.value(16) as i16, rng.percent(50));
        for machine in &mut *machines {
            machine.set_word(Class::D, n, word);
            machine.set_bit(Class::M, n, bit);
        }
    }
    let count = rng.value(16);
    for machine in &mut *machines {
        machine.set_word(Class::C, 0, count as i16);
        machine.set_counter32(200, count as i32);
    }
    for n in FLAGS {
        let bit = rng.percent(50);
        for machine in &mut *machines {
            machine.set_bit(Class::M, n, bit);
        }
    }
}

/// Instructions whose emitted C needs a C compiler alone, as programs write them most.
const WITHOUT_RUNTIME: &str = "
MOV D0 D1
SMOV D0 K4 K2 D1 K3
CML D0 D1
BMOV D0 D100 K50
BMOV D0Z0 D100Z1 K50
BMOV D0 D100 D10
BMOV D0Z0 R0 D10
FMOV K0 D100 K200
FMOV K0 D100Z0 D10
DFMOV D0 D100Z0 K20
XCH D0 D1
BCD D0 D1
BIN D0 D1
ADD D0 D1 D2
SUB D0 D1 D2
MUL D0 D1 D2
DIV D0 D1 D2
INC D0
DEC D0
WAND D0 D1 D2
WOR D0 D1 D2
WXOR D0 D1 D2
NEG D0
ROR D0 K3
ROL D0 K3
RCR D0 K3
RCL D0 K3
SFTR X0 M0 K100 K4
SFTL X0 M0 K100 K4
SFTL X0 M0Z0 K100 K4
WSFR D0 D10 K50 K2
WSFL D0 D10 K50 K2
WSFL D0Z0 D10Z0 K50 K2
ZRST M0 M499
ZRST D200 D399
ZRST D200Z0 D399Z0
ZRST M200Z0 M399Z1
ZRST C0 C20
DECO D0 M100 K6
DECO D0 D1 K4
SUM D0 D1
BON D0 M0 K3
MEAN D0 D10 K4
SQR D0 D1
FLT D0 D2
SWAP D0
CMP D0 D1 M0
ZCP K1 K9 D0 M0
TCMP D0 K30 K0 D10 M0
TZCP D0 D3 D6 M0
TADD D0 D3 D6
TSUB D0 D3 D6
HTOS D0 D3
STOH D0 D3
SEGD D0 D1
LIMIT D0 D1 D2 D3
DBAND D0 D2 D4 D6
ZONE K-1 K1 D2 D3
ANS T0 K10 S900
ROR D0 D1
BON D0 M0 D1
GRY D0 D1
GBIN D0 D1
DECMP D0 D2 M0
DEZCP D0 D2 D4 M0
DEMOV D0 D2
DEADD D0 D2 D4
DESUB D0 D2 D4
DEMUL D0 D2 D4
DEDIV D0 D2 D4
DESQR D0 D2
DENEG D0
DINT D0 D2
ALT M0
ENCO D0 D1 K4
ENCO M0 D1 K5
ABSD D0 C0 M0 K16
MTR X020 Y020 M30 K3
SFWR D0 D1 K10
SFRD D1 D0 K10
SFWR D0 D1Z0 K10
SFRD D1Z0 D0Z1 K10
XCH D0Z0 D1Z1
DMOV D0Z0 D10
";

#[test]
fn common_instructions_need_no_runtime() {
    for instruction in WITHOUT_RUNTIME.lines().filter(|line| !line.is_empty()) {
        let module = compiled(instruction, false);
        let files = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
        let calls = ["rungc-rt/", "rungc_devices.c"];
        let runtime = files
            .iter()
            .any(|file| calls.iter().any(|path| file.path.starts_with(path)));
        assert!(!runtime, "{instruction} needs the runtime");
    }
}

#[test]
fn inline_code_does_what_the_runtime_does() {
    let mut rng = Rng::new(1);
    for &(inline, call) in PAIRS {
        for flags in [false, true] {
            let modules = [compiled(inline, flags), compiled(call, flags)];
            assert!(!calls(&modules[0]), "{inline} is a call");
            assert!(calls(&modules[1]), "{call} is inline");
            let mut machines = modules.each_ref().map(Machine::new);
            for round in 0..300 {
                fill(&mut rng, &mut machines);
                let before = picture(&machines[0], flags);
                for machine in &mut machines {
                    machine.set_bit(Class::X, 0, true);
                    machine.scan(&mut NoHal, 10 * round, 0);
                }
                let [a, b] = machines.each_ref().map(|m| picture(m, flags));
                assert_eq!(a, b, "{inline}, from {before:?}");
                assert_eq!(
                    machines[0].last_error(),
                    machines[1].last_error(),
                    "{inline}, from {before:?}"
                );
            }
        }
    }
}
