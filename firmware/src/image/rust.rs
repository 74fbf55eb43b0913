//! An image in Rust. Pins are those of the board's description; functions in C are for images in C.

mod control;
mod modules;
mod retain;
mod serial;

use super::{Image, boot2, comment, linker_script, terminals};
use crate::board::{OutputPin, Setup, Uart};
use crate::template;
use rungc_codegen_rust::{Options, Runtime};
use rungc_emit::OutFile;
use rungc_runtime_sources::EMITTED_VERSION;
use rungc_syntax::DeviceClass;
use std::fmt::Write;
use std::path::Path;

/// Code that switches the floating point unit on: CPACR.
const FPU: &str = "    ldr r0, =0xE000ED88
    ldr r1, [r0]
    ldr r2, =0x00F00000
    orrs r1, r2
    str r1, [r0]
    dsb
    isb
";

/// Function that switches bits of a register.
const BITS: &str = "/// Switches bits of a register.
fn set_bits(address: usize, bits: u32, on: bool) {
    let value = read(address);
    write(address, if on { value | bits } else { value & !bits });
}

";

/// Function that returns the scripted state of an input.
const SCRIPTED: &str = "/// The scripted state of an input at a time, if it has one.
fn scripted(number: u16, now_ms: u32) -> Option<bool> {
    let own = SCRIPT.iter().filter(|(_, input, _)| *input == number);
    let state = |on, &(ms, _, then): &(u32, u16, bool)| if ms <= now_ms { then } else { on };
    (own.clone().count() > 0).then(|| own.fold(false, state))
}

";

/// Method that returns edges of the inputs that the program watches.
const NEXT_EDGE: &str = "
    fn next_edge(&mut self) -> Option<InputEdge> {
        for (i, &input) in WATCHED.iter().enumerate() {
            if let Some(level) = self.input(input)
                && level != self.were[i]
            {
                self.were[i] = level;
                let input = u32::from(input);
                return Some(InputEdge { input, level });
            }
        }
        None
    }

    fn notes_edges(&self, input: u32) -> bool {
        WATCHED.iter().any(|&watched| u32::from(watched) == input)
    }
";

/// All sources of an image, a package that `cargo build --release` builds. The program is in `plc/`. A path of the
/// runtime is relative to the package.
pub fn project(image: &Image, runtime: &Runtime) -> Vec<OutFile> {
    let options = Options {
        runtime: match runtime {
            Runtime::At(path) if Path::new(path).is_relative() => Runtime::At(format!("../{path}")),
            other => other.clone(),
        },
        ..Options::default()
    };
    let emitted = rungc_codegen_rust::emit(image.module, &options);
    let mut files: Vec<OutFile> = emitted.into_iter().map(|file| file.inside("plc")).collect();
    let (package, _) = rungc_codegen_rust::names(image.module);
    let lock = lock_file(&package);
    let triple = image.board.target.triple;
    let fpu = if image.board.target.has_fpu() {
        FPU
    } else {
        ""
    };
    let own = [
        ("Cargo.toml", manifest(&package, runtime)),
        ("Cargo.lock", lock),
        (".cargo/config.toml", config(triple)),
        ("image.ld", linker_script(image.board)),
        (
            "src/startup.s",
            template!("startup.s")
                .replace("/* FPU */", fpu)
                .replace("/* VECTORS */", &serial::vectors(image))
                + &boot2::in_assembler(image.board),
        ),
        ("src/main.rs", main(image)),
    ];
    files.extend(own.map(|(path, text)| OutFile::new(path, text)));
    files
}

fn lock_file(package: &str) -> String {
    let mut needs = [package, "rungc-rt"];
    needs.sort();
    rungc_runtime_sources::lock_file(false, &[("image", &needs), (package, &["rungc-rt"])])
}

fn manifest(package: &str, runtime: &Runtime) -> String {
    let runtime = runtime.dependency("plc/");
    format!(
        "[package]\nname = \"image\"\nversion = \"{EMITTED_VERSION}\"\nedition = \"2024\"\npublish = false\n\n[workspace]\nexclude = [\"plc\"]\n\n\
         [dependencies]\n{runtime}{package} = {{ path = \"plc\" }}\n\n\
         [profile.release]\nopt-level = \"s\"\nlto = true\ncodegen-units = 1\npanic = \"abort\"\n"
    )
}

fn config(triple: &str) -> String {
    format!(
        "[build]\ntarget = \"{triple}\"\n\n[target.{triple}]\nrustflags = [\"-C\", \"link-arg=-Timage.ld\"]\n"
    )
}

fn main(image: &Image) -> String {
    let board = image.board;
    let (package, program) = rungc_codegen_rust::names(image.module);
    let watched = image.watched();
    let mut before = retain::load(image);
    before.push_str(&control::before(image));
    if board.console {
        before.push_str("    let mut shown = [false; OUTPUTS.len()];\n");
    }
    let setup = setup(image);
    let ports = image.serial();
    let drivers = ports.iter().filter_map(|serial| serial.driver.as_ref());
    let by_bits = |pin: &OutputPin| matches!(pin, OutputPin::Bit { .. });
    let mut pins = board
        .outputs
        .values()
        .chain(drivers)
        .chain(board.control.lamps());
    let change = |step: &Setup| matches!(step, Setup::Change { .. });
    let bits = match pins.any(by_bits) || board.setup.iter().any(change) {
        true => BITS,
        false => "",
    };
    let end = |class| {
        terminals(image.module, class)
            .map(|n| n + 1)
            .max()
            .unwrap_or(0)
    };
    let (fields, pins) = fields(image);
    let text = template!("main.rs")
        .replace(
            "/* EDGE TYPE */",
            if watched.is_empty() {
                ""
            } else {
                ", InputEdge"
            },
        )
        .replace("/* USE PROGRAM */", &traits(image))
        .replace("/* LINES */", serial::in_tick(image))
        .replace("/* HZ */", &board.clock_hz.to_string())
        .replace("/* TICK */", &board.tick_us.to_string())
        .replace("/* SCAN */", &board.scan_us.to_string())
        .replace("/* INPUTS */", &end(DeviceClass::X).to_string())
        .replace("/* OUTPUTS */", &end(DeviceClass::Y).to_string())
        .replace("/* BITS */", bits)
        .replace("/* SCRIPT */", &script(image))
        .replace("/* FIELDS */", &fields)
        .replace("/* PINS */", &pins)
        .replace("/* HAL */", &hal(image))
        .replace(
            "/* EDGES */",
            if watched.is_empty() { "" } else { NEXT_EDGE },
        )
        .replace("/* CONSOLE */", &console(image))
        .replace("/* USE MODULES */", modules::uses(image))
        .replace("/* MODULES */", &modules::drivers(image))
        .replace("/* USE SERIAL */", &serial_uses(image))
        .replace("/* USE RETAIN */", &retain::uses(image))
        .replace("/* RETAIN */", &retain::drivers(image))
        .replace("/* SERIAL */", &serial::drivers(image))
        .replace("/* SETUP */", &(setup + &serial::enable(image)))
        .replace("/* BEFORE */", &before)
        .replace("/* NOW */", &before_scan(image))
        .replace("/* SHOW */", &after_scan(image))
        .replace("CRATE", &package)
        .replace("TYPE", &program);
    format!(
        "//! The program on {}. Generated by rungc {} for {}: change the board's description instead.\n{text}",
        comment(&board.name),
        env!("CARGO_PKG_VERSION"),
        comment(&image.module.source_name),
    )
}

/// The traits of the program that the main loop needs.
fn traits(image: &Image) -> String {
    let board = image.board;
    let mut text = String::new();
    let supply = image.supply().is_some();
    if board.control.run.is_some() || supply {
        text.push_str("use rungc_rt::Plc;\n");
    }
    if board.console || board.control.is_there() || supply {
        text.push_str("use rungc_rt::Program;\n");
    }
    text
}

/// Imports from the runtime for the serial ports.
fn serial_uses(image: &Image) -> String {
    let uses = serial::uses(image);
    match image.serial().first().map(|serial| serial.uart) {
        Some(Uart::Stm32 | Uart::Stm32f7 | Uart::Pl011) => {
            format!("{uses}use rungc_rt::comm::Parity;\n")
        }
        Some(Uart::Cmsdk) => uses,
        None => String::new(),
    }
}

/// Code in the main loop before a scan.
fn before_scan(image: &Image) -> String {
    let mut text = String::new();
    if !image.script.inputs.is_empty() {
        text.push_str("        driver.board.now_ms = driver.now_ms();\n");
    }
    if !image.modules().is_empty() {
        text.push_str("        driver.board.exchange();\n");
    }
    text
}

/// Code in the main loop after a scan: it saves latched devices, shows the outputs, and ends with the script.
fn after_scan(image: &Image) -> String {
    let mut text = control::after_scan(image) + &retain::save(image);
    if image.board.console {
        text.push_str("        show_outputs(driver, &mut shown);\n");
    }
    if let Some(ms) = image.script.until_ms {
        // Writing to a String does not fail.
        let _ = writeln!(
            text,
            "        if driver.now_ms() >= {ms} {{\n            semihosting(0x18, 0x20026); // SYS_EXIT, application exit\n        }}"
        );
    }
    text
}

/// Fields for the state of pins, and their initial values.
fn fields(image: &Image) -> (String, String) {
    let mut fields = String::new();
    let mut begin = String::new();
    if !image.script.inputs.is_empty() {
        fields.push_str(
            "    /// The program's time, for inputs that switch themselves.\n    now_ms: u32,\n",
        );
        begin.push_str(" now_ms: 0,");
    }
    if !image.watched().is_empty() {
        fields.push_str("    /// How watched inputs stood.\n    were: [bool; WATCHED.len()],\n");
        begin.push_str(" were: [false; WATCHED.len()],");
    }
    if !image.serial().is_empty() {
        fields.push_str(
            "    /// The serial port that was asked for last.\n    line: Option<&'static Uart>,\n",
        );
        begin.push_str(" line: None,");
    }
    if let Some((own, start)) = modules::fields(image) {
        fields.push_str(&own);
        begin.push_str(&start);
    }
    if fields.is_empty() {
        return (";".to_string(), "Pins".to_string());
    }
    let begin = begin.trim_end_matches(',');
    (format!(" {{\n{fields}}}"), format!("Pins {{{begin} }}"))
}

fn script(image: &Image) -> String {
    let mut text = String::new();
    let watched = image.watched();
    if !watched.is_empty() {
        let list: Vec<String> = watched.iter().map(u32::to_string).collect();
        let _ = writeln!(
            text,
            "/// Inputs whose edges the program takes.\nconst WATCHED: [u16; {}] = [{}];\n",
            watched.len(),
            list.join(", ")
        );
    }
    let inputs = &image.script.inputs;
    if !inputs.is_empty() {
        let _ = writeln!(
            text,
            "/// Inputs that switch themselves, in the order of time: milliseconds, X, whether on.\nconst SCRIPT: [(u32, u16, bool); {}] = {inputs:?};\n",
            inputs.len(),
        );
        text.push_str(SCRIPTED);
    }
    text
}

fn inputs(image: &Image) -> String {
    let mut text = String::new();
    for number in terminals(image.module, DeviceClass::X) {
        if let Some(pin) = image.board.inputs.get(&number) {
            let compare = if pin.inverted { "==" } else { "!=" };
            let _ = writeln!(
                text,
                "            {number} => Some(read(0x{:08X}) & 0x{:X} {compare} 0), // {}",
                pin.at,
                1u32 << pin.bit,
                DeviceClass::X.number(number),
            );
        }
    }
    let own = match image.script.inputs.is_empty() {
        true => "",
        false => {
            "        if let Some(on) = scripted(number, self.now_ms) {\n            return Some(on);\n        }\n"
        }
    };
    format!(
        "    fn input(&mut self, number: u16) -> Option<bool> {{\n{own}        match number {{\n{text}            _ => None,\n        }}\n    }}\n\n"
    )
}

fn outputs(image: &Image) -> String {
    let mut text = String::new();
    for number in terminals(image.module, DeviceClass::Y) {
        let Some(pin) = image.board.outputs.get(&number) else {
            continue;
        };
        let _ = writeln!(
            text,
            "            {number} => {}, // {}",
            switch(pin),
            DeviceClass::Y.number(number)
        );
    }
    let on = if text.is_empty() { "_on" } else { "on" };
    format!(
        "    fn set_output(&mut self, number: u16, {on}: bool) {{\n        match number {{\n{text}            _ => {{}}\n        }}\n    }}\n"
    )
}

/// The expression that switches a pin, with the state in `on`.
fn switch(pin: &OutputPin) -> String {
    match *pin {
        OutputPin::Bit { at, bit, inverted } => {
            let on = if inverted { "!on" } else { "on" };
            format!("set_bits(0x{at:08X}, 0x{:X}, {on})", 1u32 << bit)
        }
        OutputPin::Words { on, off } => format!(
            "if on {{ write(0x{:08X}, 0x{:X}) }} else {{ write(0x{:08X}, 0x{:X}) }}",
            on.0, on.1, off.0, off.1
        ),
    }
}

/// Method that returns the state of the supply.
const POWER_FAILS: &str = "    fn power_fails(&mut self) -> Option<bool> {
        Some(power_fails())
    }
";

/// Hardware interface of the board for instructions and scans.
fn hal(image: &Image) -> String {
    let serial = match image.serial().is_empty() {
        true => "",
        false => serial::SERIAL_PORT,
    };
    let modules = modules::hal(image);
    let supply = match image.supply() {
        Some(_) => POWER_FAILS,
        None => "",
    };
    format!(
        "{}{}{modules}{supply}{serial}",
        inputs(image),
        outputs(image)
    )
}

fn setup(image: &Image) -> String {
    let mut text = String::new();
    // Writing to a String does not fail.
    for step in &image.board.setup {
        match *step {
            Setup::Change { at, clear, set } => {
                for (bits, on) in [(clear, false), (set, true)] {
                    if bits != 0 {
                        let _ = writeln!(text, "    set_bits(0x{at:08X}, 0x{bits:X}, {on});");
                    }
                }
            }
            Setup::Write { at, word } => {
                let _ = writeln!(text, "    write(0x{at:08X}, 0x{word:X});");
            }
            Setup::Wait { at, bits, on } => {
                let until = if on { bits } else { 0 };
                let _ = writeln!(
                    text,
                    "    while read(0x{at:08X}) & 0x{bits:X} != 0x{until:X} {{}}"
                );
            }
        }
    }
    text
}

fn console(image: &Image) -> String {
    if !image.board.console {
        return match image.script.until_ms {
            Some(_) => template!("console.rs").to_string(),
            None => String::new(),
        };
    }
    let rows = image.printed();
    let mut table = String::new();
    for (number, name, text) in &rows {
        let _ = writeln!(table, "    ({number}, c{name:?}, c{text:?}),");
    }
    let outputs = template!("outputs.rs")
        .replace("/* COUNT */", &rows.len().to_string())
        .replace("/* TABLE */", &table);
    template!("console.rs").to_string() + &outputs
}
