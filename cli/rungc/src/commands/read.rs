//! `rungc read`: the program of a PLC, over its programming port.

use super::convert::written;
use super::line::{self, Line};
use super::{Context, Failure, Result, conclude, interruption, print_bytes, print_text};
use crate::args::{ConvertTo, PlcopenBody, ReadArgs};
use crate::output::{file, spare, write_file};
use crate::progress;
use crate::report::{Findings, Reporter};
use rungc::language::message;
use rungc::monitor::first_difference;
use rungc_frontend::{ReadOptions, image};
use rungc_lower::compile::CompileOptions;
use rungc_monitor::{Reply, fx, number};
use rungc_rt::comm::fx_port::PROGRAM_MEMORY;
use rungc_syntax::{Phrase, Program, phrase};
use std::io::{self, IsTerminal};
use std::path::Path;
use std::time::Instant;

/// Bytes that are read at once: what every PLC of the family sends.
const CHUNK: usize = 0x40;
/// Bytes that a word has.
const WORD: usize = 2;
/// Reads a PLC. Nothing is written before all of the program has been read.
pub fn run(args: &ReadArgs, cx: Context) -> Result {
    if args.to.is_of_sources() {
        let why = "`--to`: a PLC holds a compiled program alone, without labels and sources";
        return Err(Failure::Because(why.to_owned()));
    }
    if let Some(path) = file(&args.output) {
        spare(path, args.force)?;
    }
    interruption::note();
    let begin = Instant::now();
    let mut plc = line::at_port(&args.port, &args.line)?;
    cx.detail(|| format!("    Reading {} at {}", plc.title(), args.port));
    let memory = Plc(&mut plc).memory()?;
    let name = args.port.to_string();
    let options = ReadOptions {
        image: true,
        ..ReadOptions::default()
    };
    let read = rungc_frontend::read_bytes_with(&name, &memory, &options);
    let mut read = read.map_err(|error| Failure::Because(error.to_string()))?;
    read.program.cpu = plc.cpu().map(str::to_string);
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
    let language = findings.language(cx);
    let outcome = conclude(&findings, &mut reporter, cx, || {
        let steps = steps.map_or(0, |end| end as usize + 1);
        let title = plc.title();
        let seconds = format!("{:.1}", begin.elapsed().as_secs_f32());
        let arguments = [
            ("title", (&title).into()),
            ("name", (&name).into()),
            ("steps", steps.into()),
            ("seconds", (&seconds).into()),
        ];
        message(language, "read", &arguments)
    });
    reporter.finish()?;
    outcome
}

/// Says where the program in a PLC differs from a program; of a PLC that does not show its program, nothing.
pub fn compare(
    plc: &mut rungc_monitor::Plc<Line>,
    program: &Program,
) -> std::result::Result<Phrase, Failure> {
    let rungc_monitor::Plc::Port(plc) = plc else {
        return Err(Failure::Because(
            "this connection does not show the program".to_string(),
        ));
    };
    let memory = Plc(plc).memory()?;
    Ok(match first_difference(program, &memory) {
        Ok(None) => phrase!("the program in the PLC is this program"),
        Ok(Some(step)) => phrase!(
            "the program in the PLC is another one, from step {step} on",
            step
        ),
        Err(_) => phrase!(
            "this program cannot be compared with that in the PLC: machine code of its instructions is not known"
        ),
    })
}

/// A PLC whose program is read.
struct Plc<'p>(&'p mut fx::Plc<Line>);

impl Plc<'_> {
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
            return Err(self.failure(why));
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
        Err(self.failure("the program memory holds no program that ends with END"))
    }

    /// Length of the memory up to `END`, where the PLC finds it.
    fn end(&mut self) -> std::result::Result<Option<usize>, Failure> {
        let reply = self.0.client().request(b"E41805C0F00")?;
        let address = match &reply {
            Reply::Data(text) => text.strip_prefix(b"1").and_then(number),
            _ => None,
        };
        let offset = address.and_then(|address| address.checked_sub(PROGRAM_MEMORY));
        Ok(offset.map(|offset| offset as usize + WORD))
    }

    /// Reads bytes of program memory; only FX1S has another command for it.
    fn read(&mut self, offset: usize, count: usize) -> std::result::Result<Vec<u8>, Failure> {
        let address = PROGRAM_MEMORY as usize + offset;
        let command = if self.0.is_basic() { "0" } else { "E01" };
        let request = format!("{command}{address:04X}{count:02X}");
        let data = self.0.client().data(request.as_bytes(), count)?;
        data.ok_or_else(|| {
            let why = "the PLC rejects reading its program: a keyword may protect it, which the \
                       editor deletes if it is yours; a PLC that rungc simulates shows only \
                       programs whose machine code is known";
            self.failure(why)
        })
    }

    fn failure(&mut self, why: &str) -> Failure {
        self.0.client().failure(why).into()
    }
}
