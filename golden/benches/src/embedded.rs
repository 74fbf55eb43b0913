//! Bytes and instructions on a Cortex-M4: the same for everyone with the same compilers.

use crate::ladder::{Kind, Ladder};
use crate::problem::{Problem, Result};
use crate::subject::{self, CSubject, Code, RustSubject, Source, calls_runtime};
use crate::table::{Cell, Table};
use crate::tools;
use rungc_firmware::target::CORTEX_M4F;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program that counts.
const BARE_C: &str = include_str!("../templates/bare.c");

/// A board, by the example for one: what happens between reset and `main`, memory, semihosting.
const BOARD: [(&str, &str); 4] = [
    (
        "startup.c",
        include_str!(concat!(
            env!("RUNGC_ROOT"),
            "/examples/firmware/stm32f405/c/startup.c"
        )),
    ),
    (
        "board.c",
        include_str!(concat!(
            env!("RUNGC_ROOT"),
            "/examples/firmware/stm32f405/c/board.c"
        )),
    ),
    (
        "board.h",
        include_str!(concat!(
            env!("RUNGC_ROOT"),
            "/examples/firmware/stm32f405/c/board.h"
        )),
    ),
    (
        LINKER_SCRIPT,
        include_str!(concat!(
            env!("RUNGC_ROOT"),
            "/examples/firmware/stm32f405/c/stm32f405.ld"
        )),
    ),
];

const LINKER_SCRIPT: &str = "stm32f405.ld";

/// Scans after each of which all devices are compared, and scans whose instructions are counted.
const CHECKED_SCANS: u32 = 300;
const COUNTED_SCANS: u32 = 200;

/// Instructions that QEMU executes in one tick of the core's clock: a nanosecond each, at 168 MHz.
pub(crate) const INSTRUCTIONS_PER_TICK: f64 = 1000.0 / 168.0;

/// Optimisation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Level {
    /// For size.
    Size,
    /// For speed.
    Speed,
}

impl Level {
    /// The option of C compilers.
    pub fn option(self) -> &'static str {
        match self {
            Level::Size => "-Os",
            Level::Speed => "-O2",
        }
    }

    /// `opt-level` of Rust.
    fn rust(self) -> &'static str {
        match self {
            Level::Size => "s",
            Level::Speed => "3",
        }
    }
}

/// Resources of one implementation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Figures {
    /// Bytes of flash that a scan needs: code and constants, whatever is reached from there.
    pub flash: u64,
    /// Bytes of RAM that a program needs.
    pub ram: u64,
    /// Instructions of a scan, on average; `None` if they were not counted.
    pub instructions: Option<f64>,
}

/// One implementation, and what it takes, or why that is not known.
#[derive(Debug)]
pub struct Measured {
    /// Implementation.
    pub code: Code,
    /// Its figures.
    pub figures: Result<Figures>,
}

/// Build of one implementation.
struct Build {
    code: Code,
    prefix: &'static str,
    /// Linked objects, and the function that scans: of C the program's own, of Rust the adaptor's, which includes it.
    parts: Result<(Vec<PathBuf>, String)>,
}

/// Bytes of implementations of a program, and if `count` says so the instructions of a scan. They are checked to do the
/// same then.
pub fn measure(
    ladder: &Ladder,
    codes: &[Code],
    level: Level,
    count: bool,
) -> Result<Vec<Measured>> {
    measure_all(ladder, Some(ladder), codes, level, count)
}

/// The same of a program that no one wrote by hand.
pub fn measure_emitted(
    program: &dyn Source,
    codes: &[Code],
    level: Level,
) -> Result<Vec<Measured>> {
    measure_all(program, None, codes, level, true)
}

fn measure_all(
    program: &dyn Source,
    ladder: Option<&Ladder>,
    codes: &[Code],
    level: Level,
    count: bool,
) -> Result<Vec<Measured>> {
    let folder = board_folder()?;
    let folder = folder.path();
    let builds: Vec<Build> = codes
        .iter()
        .map(|&code| build(program, ladder, code, level, folder))
        .collect();
    let mut sums = Vec::new();
    let mut all = Vec::new();
    for build in builds {
        let figures = build.parts.and_then(|(objects, scan)| {
            let mut instructions = None;
            if count {
                let counted = count_instructions(&objects, build.prefix, folder)?;
                sums.push(counted.sum);
                instructions = Some(counted.instructions);
            }
            Ok(Figures {
                flash: link_size(&objects, &scan, folder)?.0,
                ram: link_size(&objects, &format!("{}_one_scan", build.prefix), folder)?.1,
                instructions,
            })
        });
        let figures = match figures {
            Err(problem) if !problem.is_missing() => return Err(problem),
            figures => figures,
        };
        all.push(Measured {
            code: build.code,
            figures,
        });
    }
    match sums.windows(2).all(|pair| pair[0] == pair[1]) {
        true => Ok(all),
        false => Err(Problem::Wrong(format!(
            "implementations differ: {sums:08x?}"
        ))),
    }
}

fn build(
    program: &dyn Source,
    ladder: Option<&Ladder>,
    code: Code,
    level: Level,
    folder: &Path,
) -> Build {
    let prefix = match code {
        Code::Hand => "hand",
        Code::C => "c",
        Code::Lanes => "lanes",
        Code::Rust => "rust",
    };
    let parts = match (code, ladder) {
        (Code::Rust, _) => build_rust(program, prefix, level, folder),
        (Code::C, _) => CSubject::emitted(program, prefix, folder)
            .and_then(|subject| build_c(&subject, prefix, level, calls_runtime(program)?)),
        (_, Some(ladder)) => CSubject::new(code, ladder, prefix, folder)
            .and_then(|subject| build_c(&subject, prefix, level, false)),
        (_, None) => Err(Problem::Wrong("no program was written by hand".to_string())),
    };
    Build {
        code,
        prefix,
        parts,
    }
}

fn build_c(
    subject: &CSubject,
    prefix: &str,
    level: Level,
    runtime: bool,
) -> Result<(Vec<PathBuf>, String)> {
    tools::need(&[CORTEX_M4F.cc])?;
    let options: Vec<&str> = machine().chain([level.option()]).collect();
    let mut objects = subject.compile(CORTEX_M4F.cc, &options)?;
    objects.program.push(objects.adaptor);
    if runtime {
        objects.program.push(tools::runtime(Some(&CORTEX_M4F))?);
    }
    Ok((objects.program, format!("{prefix}_scan")))
}

fn build_rust(
    program: &dyn Source,
    prefix: &str,
    level: Level,
    folder: &Path,
) -> Result<(Vec<PathBuf>, String)> {
    let cargo = tools::embedded_cargo(CORTEX_M4F.triple)?;
    let subject = RustSubject::new(program, prefix, folder)?;
    let library = subject.build(cargo, CORTEX_M4F.rustc_name(), level.rust())?;
    Ok((vec![library], format!("{prefix}_one_scan")))
}

/// Options that select the processor for the C compiler.
fn machine() -> impl Iterator<Item = &'static str> {
    CORTEX_M4F.flags.split_whitespace()
}

/// A command that links an image.
pub(crate) fn linker(folder: &Path, image: &Path) -> Command {
    let mut linker = Command::new(CORTEX_M4F.cc);
    linker
        .args(machine())
        .args([
            "-std=c11",
            "-Os",
            "-ffunction-sections",
            "--specs=nano.specs",
            "-nostartfiles",
        ])
        .arg("-T")
        .arg(folder.join(LINKER_SCRIPT))
        .arg("-o")
        .arg(image);
    linker
}

/// Flash and RAM of everything that a function reaches.
fn link_size(objects: &[PathBuf], function: &str, folder: &Path) -> Result<(u64, u64)> {
    let image = folder.join(format!("{function}.elf"));
    let entry = format!("-Wl,--gc-sections,-e,{function},-u,{function}");
    tools::run(linker(folder, &image).args(objects).args([&entry, "-lm"]))?;
    sizes(&image)
}

/// Flash and RAM of an image.
fn sizes(image: &Path) -> Result<(u64, u64)> {
    let output = tools::run(Command::new("arm-none-eabi-size").arg(image))?;
    let line = output.lines().nth(1).unwrap_or_default();
    let numbers: Vec<u64> = line
        .split_whitespace()
        .map_while(|n| n.parse().ok())
        .collect();
    match numbers[..] {
        [text, data, bss, ..] => Ok((text + data, data + bss)),
        _ => Err(Problem::Wrong(format!("arm-none-eabi-size: {output}"))),
    }
}

/// Counts of a run.
struct Counted {
    /// Checksum of the states of all devices.
    sum: u32,
    /// Instructions of a scan.
    instructions: f64,
}

/// Counts in a separate image, so that none uses what another one brings: Rust's `memset` is not newlib's.
fn count_instructions(objects: &[PathBuf], prefix: &str, folder: &Path) -> Result<Counted> {
    tools::need(&[CORTEX_M4F.cc, tools::QEMU])?;
    subject::write_list(folder, &[prefix])?;
    tools::write(&folder.join("bare.c"), BARE_C)?;
    let image = folder.join(format!("{prefix}-counted.elf"));
    tools::run(
        linker(folder, &image)
            .arg(format!("-DCHECK_SCANS={CHECKED_SCANS}"))
            .arg(format!("-DSCANS={COUNTED_SCANS}"))
            .args(["startup.c", "board.c", "bare.c"].map(|source| folder.join(source)))
            .args(objects)
            .args(["-lm", "-Wl,--gc-sections,-z,noexecstack"]),
    )?;
    read_counts(&tools::qemu(&image)?)
}

/// Parses the output of `bare.c`: checksum and ticks of the loop alone, then of the subject.
fn read_counts(printed: &str) -> Result<Counted> {
    let hex = |word: &str| u32::from_str_radix(word, 16).ok();
    let row = |line: &str| match line.split(' ').collect::<Vec<_>>()[..] {
        [_, sum, ticks] => Some((hex(sum)?, hex(ticks)?)),
        _ => None,
    };
    match printed.lines().filter_map(row).collect::<Vec<_>>()[..] {
        [(_, alone), (sum, ticks)] if ticks >= alone => {
            let ticks = f64::from(ticks - alone) / f64::from(COUNTED_SCANS);
            Ok(Counted {
                sum,
                instructions: ticks * INSTRUCTIONS_PER_TICK,
            })
        }
        _ => Err(Problem::Wrong(format!(
            "not all that was counted under QEMU was printed:\n{printed}"
        ))),
    }
}

/// A lamp that turns on and off each half second.
const BLINK: &str = "LDI T1\nOUT T0 K5\nLD T0\nOUT T1 K5\nOUT Y000\nEND\n";

/// Its `main`.
const BLINK_C: &str = include_str!("../templates/blink.c");

/// The table of a whole image: a blinking lamp, all that is in flash.
pub fn image_table() -> Result<Table> {
    let mut table = Table::new(
        "A whole image for a Cortex-M4 board: a lamp that blinks, `-Os`",
        &["what", "flash", "RAM"],
    );
    let mut row = vec!["startup, board, emitted C".into()];
    match blink() {
        Ok((flash, ram)) => row.extend([Cell::count(flash), Cell::count(ram)]),
        Err(problem) if problem.is_missing() => row.push(problem.to_string().into()),
        Err(problem) => return Err(problem),
    }
    table.row(row);
    Ok(table)
}

/// Flash and RAM of the blinking lamp, with everything that an image needs.
pub fn blink() -> Result<(u64, u64)> {
    tools::need(&[CORTEX_M4F.cc])?;
    let folder = board_folder()?;
    let folder = folder.path();
    let module = subject::module_of(BLINK, "blink")?;
    let emitted = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
    for file in &emitted {
        tools::write(&folder.join(&file.path), &file.contents)?;
    }
    tools::write(&folder.join("main.c"), BLINK_C)?;
    let sources = emitted
        .iter()
        .map(|f| f.path.as_str())
        .filter(|p| p.ends_with(".c"));
    let image = folder.join("blink.elf");
    tools::run(
        linker(folder, &image)
            .args(["main.c", "startup.c", "board.c"].map(|source| folder.join(source)))
            .args(sources.map(|source| folder.join(source)))
            .arg("-Wl,--gc-sections,-z,noexecstack"),
    )?;
    sizes(&image)
}

/// A folder with the files of a board.
pub(crate) fn board_folder() -> Result<tempfile::TempDir> {
    let folder = tools::folder()?;
    for (path, text) in BOARD {
        tools::write(&folder.path().join(path), text)?;
    }
    Ok(folder)
}

/// All implementations; emitted Rust, whose build takes longest, comes last.
pub const CODES: [Code; 3] = [Code::Hand, Code::C, Code::Rust];

/// The table of bytes.
pub fn size_table(kinds: &[Kind], sizes: &[u32], codes: &[Code]) -> Result<Table> {
    let mut table = Table::new(
        "Cortex-M4, `-Os` (Rust: `opt-level = \"s\"`)",
        &[
            "program",
            "steps",
            "code",
            "flash",
            "bytes/step",
            "× hand",
            "RAM",
            "devices in RAM",
        ],
    );
    for &kind in kinds {
        for &size in sizes {
            let ladder = Ladder::new(kind, size);
            let all = measure(&ladder, codes, Level::Size, false)?;
            let hand = hand_figure(&all, |f| Some(f.flash as f64));
            for Measured { code, figures } in all {
                let mut row = begin_row(&ladder, code);
                match figures {
                    Err(problem) => row.push(problem.to_string().into()),
                    Ok(figures) => {
                        let flash = figures.flash as f64;
                        row.push(Cell::count(figures.flash));
                        row.push(Cell::number(flash / f64::from(ladder.steps), 2));
                        row.push(hand.map_or("–".into(), |hand| Cell::number(flash / hand, 2)));
                        row.push(Cell::count(figures.ram));
                        row.push(Cell::count(ladder.device_bytes().into()));
                    }
                }
                table.row(row);
            }
        }
    }
    Ok(table)
}

/// The table of instructions.
pub fn count_table(kinds: &[Kind], sizes: &[u32], codes: &[Code]) -> Result<Table> {
    let mut table = Table::new(
        "Instructions of a scan on a Cortex-M4 (QEMU, `-icount shift=0`)",
        &[
            "program",
            "steps",
            "code",
            "options",
            "instructions",
            "per step",
            "× hand",
        ],
    );
    for &kind in kinds {
        for &size in sizes {
            let ladder = Ladder::new(kind, size);
            for level in [Level::Size, Level::Speed] {
                let all = measure(&ladder, codes, level, true)?;
                let hand = hand_figure(&all, |f| f.instructions);
                for Measured { code, figures } in all {
                    let mut row = begin_row(&ladder, code);
                    row.push(level.option().into());
                    match figures.map(|f| f.instructions) {
                        Err(problem) => row.push(problem.to_string().into()),
                        Ok(None) => row.push("not counted".into()),
                        Ok(Some(count)) => {
                            row.push(Cell::number(count, 0));
                            row.push(Cell::number(count / f64::from(ladder.steps), 3));
                            row.push(hand.map_or("–".into(), |hand| Cell::number(count / hand, 2)));
                        }
                    }
                    table.row(row);
                }
            }
        }
    }
    Ok(table)
}

/// A figure of the code written by hand.
fn hand_figure(all: &[Measured], figure: impl Fn(&Figures) -> Option<f64>) -> Option<f64> {
    let hand = all.iter().find(|m| m.code == Code::Hand)?;
    figure(hand.figures.as_ref().ok()?)
}

fn begin_row(ladder: &Ladder, code: Code) -> Vec<Cell> {
    vec![
        ladder.kind.name().into(),
        Cell::count(ladder.steps.into()),
        code.title().into(),
    ]
}
