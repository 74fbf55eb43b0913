//! Resources of a program on a machine: flash, RAM, steps of a scan, stack.

mod elf;
mod stack;
mod thumb;

use crate::board::Board;
use crate::target::Target;
use elf::{Elf, Size};
use rungc_ir::Module;
use rungc_ir::worst::{Cost, Event, Worst, worst};
use serde::Serialize;
use stack::{Functions, Unbounded};
use std::fmt;

/// Resources of a program.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Report {
    /// Target it was built for.
    pub target: &'static str,
    /// Description of the measured code.
    pub measured: &'static str,
    /// Bytes of flash: code, constants and the image of data.
    pub flash: u64,
    /// Bytes of RAM without the stack.
    pub ram: u64,
    /// The program's struct, which is in RAM.
    pub devices: Devices,
    /// Upper bound of a scan.
    pub scan: Scan,
    /// Stack.
    pub stack: Stack,
}

/// RAM of the program's struct.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Devices {
    /// All of it; `None` where it was not measured.
    pub bytes: Option<u64>,
    /// By classes of devices.
    pub areas: Vec<Area>,
    /// The rest: what the program remembers from scan to scan, and gaps.
    pub private: Option<u64>,
}

/// RAM of the devices of a class.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Area {
    /// The class: `D`.
    pub class: &'static str,
    /// Number of stored devices.
    pub devices: u32,
    /// Their bytes.
    pub bytes: u32,
}

/// Upper bound of a scan.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Scan {
    /// Steps of the PLC program.
    pub steps: u64,
    /// Operations of the IR.
    pub operations: u64,
    /// Additional cost of each event.
    pub events: Vec<EventCost>,
    /// Loops that run as often as a device says; one iteration of each is counted.
    pub loops: Vec<LoopCost>,
    /// Steps where jumps back begin; they are not counted.
    pub jumps_back: Vec<u32>,
}

/// Cost of an event.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct EventCost {
    /// The event: `I001`, `X000 changes`.
    pub event: String,
    /// Steps of the PLC program.
    pub steps: u64,
    /// Operations of the IR.
    pub operations: u64,
}

/// Cost of each further iteration of a loop.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct LoopCost {
    /// Step of its network.
    pub step: u32,
    /// Steps of one iteration.
    pub steps: u64,
    /// Operations of one iteration.
    pub operations: u64,
}

/// Use of the stack.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Stack {
    /// Bytes that a scan takes at most; `None` where there is no bound.
    pub scan: Option<u32>,
    /// Bytes that the whole image takes, with its interrupts; `None` where there is no bound or no image.
    pub image: Option<u32>,
    /// Method of the analysis, or the reason why it failed.
    pub how: String,
}

/// Stack used by an exception, with its alignment: eight registers, with a floating point unit 26.
fn exception_frame(target: &Target) -> u32 {
    if target.has_fpu() {
        26 * 4 + 4
    } else {
        8 * 4 + 4
    }
}

/// The report of an image or, without a board, of an executable that holds nothing but the program and what it calls
/// (`probe`).
pub fn of_image(
    module: &Module,
    target: &'static Target,
    board: Option<&Board>,
    data: &[u8],
) -> object::Result<Report> {
    let file = Elf::parse(data)?;
    let plc = elf::data_size(&file, "plc");
    let size = elf::size(&file);
    let functions = Functions::new(&file);
    let scan = functions.depth(&format!("{}_scan", module.name));
    let image = board.map(|board| image_stack(&functions, board));
    let how = match (&scan, &image) {
        (Err(why), _) | (_, Some(Err(why))) => format!("no bound: {why}"),
        _ => how(&functions),
    };
    Ok(Report {
        target: target.triple,
        measured: match board {
            Some(_) => "the image",
            None => "the program and what it calls, linked",
        },
        stack: Stack {
            scan: scan.ok(),
            image: image.and_then(Result::ok),
            how,
        },
        ..report(module, target, size, plc)
    })
}

/// The report of a library for a machine that runs an operating system.
pub fn of_library(module: &Module, target: &'static Target, data: &[u8]) -> object::Result<Report> {
    let size = elf::library_size(data)?;
    Ok(report(module, target, size, None))
}

fn report(module: &Module, target: &'static Target, size: Size, plc: Option<u64>) -> Report {
    let areas = rungc_codegen_c::memory(module).into_iter();
    let areas: Vec<Area> = areas
        .map(|memory| Area {
            class: memory.class.prefix(),
            devices: memory.devices,
            bytes: memory.bytes,
        })
        .collect();
    let stored: u64 = areas.iter().map(|area| u64::from(area.bytes)).sum();
    Report {
        target: target.triple,
        measured: "the program's objects, without the runtime that they may call and without the struct",
        flash: size.flash,
        ram: size.ram,
        devices: Devices {
            bytes: plc,
            private: plc.map(|plc| plc.saturating_sub(stored)),
            areas,
        },
        scan: scan(&worst(module)),
        stack: Stack {
            scan: None,
            image: None,
            how: "not computed for this target: only machine code of a Cortex-M is read"
                .to_string(),
        },
    }
}

/// Description of how a bound was found.
fn how(functions: &Functions) -> String {
    let mut text = String::from(
        "the longest call path in the machine code, each function with everything it pushes; nothing is recursive",
    );
    if functions.has_indirect_calls() {
        text.push_str(
            ", and a call through a pointer may reach each function whose address is stored, once",
        );
    }
    text
}

/// Stack of the main program, and of each interrupt on top of it.
fn image_stack(functions: &Functions, board: &Board) -> Result<u32, Unbounded> {
    let mut sum = functions.depth("reset_handler")?;
    let users = board.interrupts.values().map(String::as_str);
    for handler in users.chain(["systick_handler"]) {
        let own = functions.depth(handler)?;
        sum = sum
            .saturating_add(own)
            .saturating_add(exception_frame(board.target));
    }
    Ok(sum)
}

fn scan(worst: &Worst) -> Scan {
    let name = |event: Event| match event {
        Event::Interrupt(pointer) => format!("I{pointer:03}"),
        Event::Interrupts => "all interrupts at one point".to_string(),
        Event::Edge(input) => format!("X{input:03o} changes"),
    };
    let Cost { steps, operations } = worst.scan;
    let events = worst.events.iter().map(|(event, cost)| EventCost {
        event: name(*event),
        steps: cost.steps,
        operations: cost.operations,
    });
    let loops = worst.open_loops.iter().map(|open| LoopCost {
        step: open.step,
        steps: open.iteration.steps,
        operations: open.iteration.operations,
    });
    Scan {
        steps,
        operations,
        events: events.collect(),
        loops: loops.collect(),
        jumps_back: worst.jumps_back.clone(),
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.target, self.measured)?;
        writeln!(f, "  flash    {:>6} bytes", self.flash)?;
        writeln!(f, "  RAM      {:>6} bytes, without stack", self.ram)?;
        self.devices.fmt(f)?;
        self.scan.fmt(f)?;
        self.stack.fmt(f)
    }
}

impl fmt::Display for Devices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.bytes {
            Some(bytes) => writeln!(f, "Devices: {bytes} bytes of this RAM")?,
            None => writeln!(f, "Devices, in the program's struct")?,
        }
        for area in &self.areas {
            let (class, devices, bytes) = (area.class, area.devices, area.bytes);
            writeln!(f, "  {class:<8} {bytes:>6} bytes for {devices}")?;
        }
        match self.private {
            Some(private) => writeln!(f, "  private  {private:>6} bytes"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Scan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line =
            |steps: u64, operations: u64| format!("{steps:>8} steps {operations:>8} operations");
        writeln!(f, "A scan at most")?;
        writeln!(f, "  all of it {}", line(self.steps, self.operations))?;
        for event in &self.events {
            let cost = line(event.steps, event.operations);
            writeln!(f, "  and each  {cost}: {}", event.event)?;
        }
        for open in &self.loops {
            let cost = line(open.steps, open.operations);
            writeln!(
                f,
                "  and each  {cost}: further iteration of the loop at step {}, whose count is unknown",
                open.step
            )?;
        }
        for step in &self.jumps_back {
            writeln!(
                f,
                "  backward jumps at step {step} are not counted; the watchdog ends a scan that repeats more than {} steps per ms of D8000",
                rungc_ir::node::STEPS_PER_MS
            )?;
        }
        Ok(())
    }
}

impl fmt::Display for Stack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Stack at most")?;
        for (what, bytes) in [("a scan", self.scan), ("image", self.image)] {
            if let Some(bytes) = bytes {
                writeln!(f, "  {what:<8} {bytes:>6} bytes")?;
            }
        }
        writeln!(f, "  ({})", self.how)
    }
}
