//! `rungc read`: the program of a PLC, over its programming port.

mod client;

use super::convert::written;
use super::{Context, Failure, Result, conclude, grouped, interruption, print_bytes, print_text};
use crate::args::{ConvertTo, PlcopenBody, ReadArgs};
use crate::output::{file, spare, write_file};
use crate::progress;
use crate::report::{Findings, Reporter};
use client::{Client, Reply};
use rungc_frontend::{ReadOptions, image};
use rungc_lower::compile::CompileOptions;
use rungc_rt::comm::fx_port::PROGRAM_MEMORY;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::time::Instant;

/// Bytes that are read at once: what every PLC of the family sends.
const CHUNK: usize = 0x40;
/// Bytes that a word has.
const WORD: usize = 2;
/// Request for the PLC's type and version.
const TYPE: &[u8] = b"00E0202";
/// M8000, by a command that only FX3 knows.
const FX3_ONLY: &[u8] = b"F50100060";

/// Types by D8001 in thousands, and whether the PLC knows FX3's commands: the CPU type as the editors spell it.
const TYPES: [(u16, bool, &str); 6] = [
    (22, false, "FX1S"),
    (26, false, "FX1N/FX1NC"),
    (24, false, "FX2N/FX2NC"),
    (28, true, "FX3S"),
    (26, true, "FX3G"),
    (24, true, "FX3U/FX3UC"),
];

/// Reads a PLC. Nothing is written before all of the program has been read.
pub fn run(args: &ReadArgs, cx: Context) -> Result {
    if let Some(path) = file(&args.output) {
        spare(path, args.force)?;
    }
    interruption::note();
    let begin = Instant::now();
    let mut plc = Plc::connect(args)?;
    cx.detail(|| format!("    Reading {} at {}", plc.title(), args.port));
    let memory = plc.memory()?;
    let name = args.port.to_string();
    let options = ReadOptions {
        image: true,
        ..ReadOptions::default()
    };
    let read = rungc_frontend::read_bytes_with(&name, &memory, &options);
    let mut read = read.map_err(|error| Failure::Because(error.to_string()))?;
    read.program.cpu = plc.cpu.map(str::to_string);
    let mut reporter = Reporter::new(&args.reporting, cx, false);
    let mut diagnostics = read.diagnostics.clone();
    let bytes = match args.to {
        ConvertTo::Image => memory,
        to => {
            let options = CompileOptions::default();
            written(to, PlcopenBody::Ld, &read, &options, &mut diagnostics)
        }
    };
    let path = Path::new(&name);
    let findings = Findings::new(path, &read.program, diagnostics, &args.reporting);
    // An image is what the PLC holds, whether or not all of it is understood.
    let complete = args.to == ConvertTo::Image || !findings.failed();
    if complete {
        match file(&args.output) {
            Some(path) => write_file(path, &bytes, args.force)?,
            None if args.to.is_text() && io::stdout().is_terminal() => {
                print_text(&String::from_utf8_lossy(&bytes))?;
            }
            None => print_bytes(&bytes)?,
        }
    }
    let steps = read.program.instrs.last().and_then(|end| end.step);
    let outcome = conclude(&findings, &mut reporter, cx, || {
        let steps = grouped(steps.map_or(0, |end| end as usize + 1));
        let seconds = begin.elapsed().as_secs_f32();
        format!(
            "        Read {} at {name}: {steps} steps in {seconds:.1} s",
            plc.title()
        )
    });
    reporter.finish()?;
    outcome
}

/// A PLC that has answered.
struct Plc {
    client: Client,
    /// Content of D8001.
    type_code: u16,
    cpu: Option<&'static str>,
}

impl Plc {
    fn connect(args: &ReadArgs) -> std::result::Result<Plc, Failure> {
        let mut client = Client::open(args)?;
        client.greet()?;
        let code = client.data(TYPE, WORD)?;
        let [low, high] = code.as_deref().unwrap_or_default() else {
            let why = "the PLC does not show its type in D8001";
            return Err(client.failure(why));
        };
        let type_code = u16::from_le_bytes([*low, *high]);
        let is_fx3 = matches!(client.request(FX3_ONLY)?, Reply::Data(_));
        let known = TYPES.iter();
        let mut known = known.filter(|(code, ..)| *code == type_code / 1000);
        let exact = known.clone().find(|(_, fx3, _)| *fx3 == is_fx3);
        let cpu = exact.or_else(|| known.next()).map(|(.., cpu)| *cpu);
        Ok(Plc {
            client,
            type_code,
            cpu,
        })
    }

    /// Name for users.
    fn title(&self) -> String {
        match self.cpu {
            Some(cpu) => format!("{cpu} (D8001 = {})", self.type_code),
            None => format!("a PLC of unknown type (D8001 = {})", self.type_code),
        }
    }

    /// The program memory from its first byte to the program's `END`.
    fn memory(&mut self) -> std::result::Result<Vec<u8>, Failure> {
        let mut memory = Vec::new();
        while memory.len() < image::PARAMETERS {
            let rest = image::PARAMETERS - memory.len();
            let more = self.read(memory.len(), rest.min(CHUNK))?;
            memory.extend(more);
        }
        if image::is_protected(&memory) {
            let why = "a keyword protects the program, and it is not read; \
                       if it is yours, delete the keyword with the editor";
            return Err(self.client.failure(why));
        }
        let start = image::program_start(&memory);
        let end = self.end()?;
        let bar = progress::bar(end.map_or(u64::MAX, |end| end as u64));
        let capacity = start + image::capacity(&memory) * WORD;
        let last = capacity.min(usize::from(u16::MAX) + 1 - PROGRAM_MEMORY as usize);
        while memory.len() < last {
            let at = memory.len();
            memory.extend(self.read(at, (last - at).min(CHUNK))?);
            bar.set_position(memory.len() as u64);
            // Each word is looked at once; the program begins at an even offset.
            let from = start.max(at - at % WORD);
            let words = memory.get(from..).unwrap_or_default().chunks_exact(WORD);
            let found = words.clone().position(|word| word == image::END);
            if let Some(found) = found {
                memory.truncate(from + WORD * (found + 1));
                bar.finish_and_clear();
                return Ok(memory);
            }
        }
        Err(self
            .client
            .failure("the program memory holds no program that ends with END"))
    }

    /// Length of the memory up to `END`, where the PLC finds it.
    fn end(&mut self) -> std::result::Result<Option<usize>, Failure> {
        let reply = self.client.request(b"E41805C0F00")?;
        let address = match &reply {
            Reply::Data(text) => text.strip_prefix(b"1").and_then(client::number),
            _ => None,
        };
        let offset = address.and_then(|address| address.checked_sub(PROGRAM_MEMORY));
        Ok(offset.map(|offset| offset as usize + WORD))
    }

    /// Reads bytes of program memory; only FX1S has another command for it.
    fn read(&mut self, offset: usize, count: usize) -> std::result::Result<Vec<u8>, Failure> {
        let address = PROGRAM_MEMORY as usize + offset;
        let command = if self.cpu == Some("FX1S") { "0" } else { "E01" };
        let request = format!("{command}{address:04X}{count:02X}");
        let data = self.client.data(request.as_bytes(), count)?;
        data.ok_or_else(|| {
            let why = "the PLC rejects reading its program: a keyword may protect it; \
                       if it is yours, delete the keyword with the editor";
            self.client.failure(why)
        })
    }
}
