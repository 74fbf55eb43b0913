//! `rungc stats`.

use super::subject::{self, Subject};
use super::{Context, Failure, Outcome, Result, conclude, findings, grouped, print_text, read};
use crate::args::{StatsArgs, StatsTo};
use crate::report::{Reporter, to_json};
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_analysis::xref::CrossReference;
use rungc_catalogue::{Inst, families};
use rungc_ir::worst::worst;
use rungc_ladder::build;
use rungc_lower::compile;
use rungc_models::times::InstructionTimes;
use rungc_syntax::{DeviceClass, OperandKind};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// Output of `--json`.
#[derive(Serialize)]
struct Output {
    programs: Vec<Stats>,
}

/// Statistics of a program.
#[derive(Serialize)]
struct Stats {
    file: String,
    model: &'static str,
    /// Length in steps, and how many the model holds.
    steps: u32,
    max_steps: u32,
    networks: usize,
    instructions: Vec<Count>,
    devices: Vec<Count>,
    /// Number of devices with a comment.
    comments: usize,
    /// The longest way through a scan, where the program can be compiled.
    #[serde(skip_serializing_if = "Option::is_none")]
    longest_scan: Option<Longest>,
    /// Execution time of all instructions on the real PLC, once each.
    #[serde(skip_serializing_if = "Option::is_none")]
    scan_time: Option<ScanTime>,
}

/// Number of occurrences.
#[derive(Serialize)]
struct Count {
    of: &'static str,
    count: usize,
}

#[derive(Serialize)]
struct Longest {
    /// Steps of the program that it passes.
    steps: u64,
    /// Operations of the compiled code: statements, operators, reads of devices.
    operations: u64,
}

#[derive(Serialize)]
struct ScanTime {
    nanoseconds: u64,
    /// Instructions of known time, and those at their family's shortest.
    exact: usize,
    at_least: usize,
    /// Instructions of which no time is printed.
    unknown: usize,
    source: &'static str,
}

/// Counts what programs consist of.
pub fn run(args: &StatsArgs, cx: Context) -> Result {
    let mut programs = Vec::new();
    let outcome = subject::each(&args.inputs, cx, |subject, reporter| {
        let (stats, outcome) = stats(subject, reporter, cx)?;
        match args.to() {
            StatsTo::Json => programs.push(stats),
            StatsTo::Text => print_text(&stats.to_string())?,
        }
        Ok(outcome)
    })?;
    if args.to() == StatsTo::Json {
        print_text(&to_json(&Output { programs })?)?;
    }
    Ok(outcome)
}

fn stats(
    subject: &Subject,
    reporter: &mut Reporter,
    cx: Context,
) -> std::result::Result<(Stats, Outcome), Failure> {
    let read = read(subject, reporter)?;
    let compiled = compile::compile(&read.program, &subject.options());
    let findings = findings(subject, &read, &compiled);
    let outcome = match findings.failed() {
        true => conclude(&findings, reporter, cx, String::new)?,
        false => Outcome::Success,
    };
    let (resolved, _) = resolve(&read.program, compiled.model);
    let longest = compiled.module.as_ref().map(|module| {
        let scan = worst(module).scan;
        Longest {
            steps: scan.steps,
            operations: scan.operations,
        }
    });
    let stats = Stats {
        file: findings.name(true),
        model: compiled.model.name,
        steps: resolved.steps,
        max_steps: compiled.model.max_steps,
        networks: build::ladder(&resolved).networks.len(),
        instructions: instructions(&resolved),
        devices: devices(&resolved),
        comments: read.program.comments.len(),
        longest_scan: longest,
        scan_time: compiled
            .model
            .instruction_times
            .map(|times| ScanTime::new(&resolved, &times)),
    };
    Ok((stats, outcome))
}

/// Numbers of instructions of each family.
fn instructions(resolved: &Resolved) -> Vec<Count> {
    let mut of_row: BTreeMap<&str, usize> = BTreeMap::new();
    for inst in resolved.instrs.iter().filter_map(|instr| instr.inst) {
        *of_row.entry(inst.name).or_default() += 1;
    }
    let counts = families().iter().map(|family| {
        let rows = family.rows.iter();
        let counts = rows.map(|row| of_row.get(row.name).copied().unwrap_or(0));
        Count {
            of: family.title,
            count: counts.sum(),
        }
    });
    counts.filter(|count| count.count > 0).collect()
}

/// Numbers of devices of each class that instructions name.
fn devices(resolved: &Resolved) -> Vec<Count> {
    let xref = CrossReference::new(resolved);
    let counts = DeviceClass::ALL.into_iter().map(|class| {
        let rows = xref.rows.iter().filter(|row| row.first.class == class);
        let count = rows.map(|row| (row.last.number - row.first.number + 1) as usize);
        Count {
            of: class.prefix(),
            count: count.sum(),
        }
    });
    counts.filter(|count| count.count > 0).collect()
}

impl ScanTime {
    /// The time of all instructions, once each.
    fn new(resolved: &Resolved, times: &InstructionTimes) -> ScanTime {
        let mut time = ScanTime {
            nanoseconds: 0,
            exact: 0,
            at_least: 0,
            unknown: 0,
            source: times.source,
        };
        for (instr, resolution) in resolved.program.instrs.iter().zip(&resolved.instrs) {
            let Some(inst) = resolution.inst else {
                time.unknown += 1;
                continue;
            };
            let nanoseconds = match (inst.fnc, times.applied) {
                (None, _) => {
                    time.exact += 1;
                    let name = named(inst, instr.operands.first().map(|operand| &operand.kind));
                    let longer = times.longer.iter().find(|(longer, _)| *longer == name);
                    longer.map_or(times.basic, |&(_, nanoseconds)| nanoseconds)
                }
                (Some(_), Some(shortest)) => {
                    time.at_least += 1;
                    shortest
                }
                (Some(_), None) => {
                    time.unknown += 1;
                    0
                }
            };
            time.nanoseconds += u64::from(nanoseconds);
        }
        time
    }
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let number = |n: usize| grouped(n);
        let model = self.model.to_uppercase();
        writeln!(f, "{} ({model})", self.file)?;
        let percent = f64::from(self.steps) * 100.0 / f64::from(self.max_steps.max(1));
        let (steps, most) = (self.steps as usize, self.max_steps as usize);
        writeln!(
            f,
            "  {:>9} steps, {percent:.1} % of the {} that the PLC holds",
            number(steps),
            number(most)
        )?;
        writeln!(f, "  {:>9} networks", number(self.networks))?;
        writeln!(f, "  {:>9} device comments", number(self.comments))?;
        writeln!(f, "Instructions")?;
        for Count { of, count } in &self.instructions {
            writeln!(f, "  {:>9} {of}", number(*count))?;
        }
        writeln!(f, "Devices")?;
        for Count { of, count } in &self.devices {
            writeln!(f, "  {:>9} {of}", number(*count))?;
        }
        writeln!(f, "Scan")?;
        if let Some(longest) = &self.longest_scan {
            let Longest { steps, operations } = *longest;
            let [steps, operations] = [steps, operations].map(|n| number(n as usize));
            writeln!(
                f,
                "  {steps:>9} steps at most, {operations} operations of compiled code"
            )?;
        }
        match &self.scan_time {
            Some(time) => writeln!(f, "{time}"),
            None => writeln!(
                f,
                "  The manuals of the {model} print no instruction times."
            ),
        }
    }
}

impl fmt::Display for ScanTime {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut text = String::new();
        let milliseconds = self.nanoseconds as f64 / 1e6;
        let bound = if self.at_least + self.unknown > 0 {
            "at least "
        } else {
            ""
        };
        write!(
            text,
            "  {milliseconds:>9.3} ms on the PLC, {bound}if it executes every instruction once:"
        )?;
        write!(text, " {} of printed time", grouped(self.exact))?;
        if self.at_least > 0 {
            write!(
                text,
                ", {} taken as the shortest applied instruction",
                grouped(self.at_least)
            )?;
        }
        if self.unknown > 0 {
            write!(text, ", {} of unknown time left out", grouped(self.unknown))?;
        }
        write!(f, "{text} ({})", self.source)
    }
}

/// Name of an instruction in a table of times: an OUT by the class of its device.
fn named(inst: &Inst, operand: Option<&OperandKind>) -> String {
    match operand {
        Some(OperandKind::Device(device, _)) if inst.name == "OUT" => {
            format!("OUT {}", device.class.prefix())
        }
        _ => inst.name.to_string(),
    }
}
