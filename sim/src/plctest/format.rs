//! Reading a test file: TOML to [`TestFile`], every mistake with its place.

use super::modules;
use super::program::{self, RawProgram, Tested};
use super::serial::{self, Port, PortId, Protocol, RawMode, RawSent, Switch, Way};
use super::{Basis, Case, Check, OtherPlc, Rejects, Run, Setting, Step, TestFile, Value};
use crate::plant::{self, Description};
use crate::problem::{self, Problem};
use crate::target::Target;
use crate::wire::Signal;
use rungc_models::{ModelId, Plc};
use rungc_rt::{Clock, FIRST_COUNTER32};
use rungc_syntax::order;
use rungc_syntax::{DeviceClass, Source};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;

type Map<T> = BTreeMap<Spanned<String>, T>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    model: Option<Spanned<String>>,
    topic: String,
    note: Option<String>,
    program: Option<Spanned<RawProgram>>,
    machine: Option<Spanned<String>>,
    #[serde(default)]
    modules: modules::Raw,
    index: Option<Spanned<IgnoredAny>>,
    case: Vec<Spanned<RawCase>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCase {
    name: Spanned<String>,
    model: Option<Spanned<String>>,
    #[serde(default)]
    source: String,
    basis: Option<Basis>,
    #[serde(default)]
    note: String,
    program: Option<Spanned<RawProgram>>,
    machine: Option<Spanned<String>>,
    #[serde(default)]
    modules: modules::Raw,
    index: Option<Spanned<IgnoredAny>>,
    #[serde(default)]
    init: Map<Spanned<Scalar>>,
    #[serde(default)]
    step: Vec<Spanned<RawStep>>,
    #[serde(default)]
    plc: Vec<RawPlc>,
    #[serde(default)]
    wire: Vec<Vec<Spanned<String>>>,
    #[serde(default)]
    serve: Map<Protocol>,
    rejects: Option<RawRejects>,
}

/// A PLC beside that of the case.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPlc {
    name: Spanned<String>,
    model: Option<Spanned<String>>,
    program: String,
    #[serde(default)]
    init: Map<Spanned<Scalar>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRejects {
    code: u16,
    line: Option<u32>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawStep {
    #[serde(default)]
    set: Map<Spanned<Scalar>>,
    scans: Option<u32>,
    run_ms: Option<Spanned<u32>>,
    scan_ms: Option<Spanned<u32>>,
    #[serde(default)]
    expect: Map<Spanned<Scalar>>,
    pulses: Option<Map<RawPulses>>,
    encoder: Option<RawEncoder>,
    rx: Option<Map<String>>,
    expect_tx: Option<Map<RawSent>>,
    cut: Option<Vec<Spanned<String>>>,
    clock: Option<Spanned<String>>,
    mode: Option<Spanned<RawMode>>,
    power_fails: Option<bool>,
    #[serde(default)]
    power_cycle: bool,
    #[serde(default)]
    bfm: Map<Spanned<Scalar>>,
    #[serde(default)]
    expect_bfm: Map<Spanned<Scalar>>,
    #[serde(default)]
    answers_after: modules::RawDelays,
    #[serde(default)]
    expect_position: BTreeMap<String, f64>,
    #[serde(default)]
    analog: Map<Spanned<Scalar>>,
}

/// Pulses at an input.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawPulses {
    count: u32,
    hz: f64,
}

/// An encoder's cycles.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawEncoder {
    a: Spanned<String>,
    b: Spanned<String>,
    count: i32,
    hz: f64,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Scalar {
    Integer(i64),
    Float(f64),
    Text(String),
}

/// Collects the problems of one file.
pub(super) struct Reader<'t> {
    source: &'t Source,
    problems: Vec<Problem>,
    /// The programs in files that were read, by their paths.
    programs: BTreeMap<PathBuf, Tested>,
    /// Names of the other PLCs of the case being read.
    others: Vec<String>,
}

/// Reads the text of a test file.
pub(super) fn parse(source: &Source) -> Result<TestFile, Vec<Problem>> {
    let raw: RawFile = problem::from_toml(source)?;
    let mut reader = Reader {
        source,
        problems: Vec::new(),
        programs: BTreeMap::new(),
        others: Vec::new(),
    };
    let file = reader.file(raw);
    if reader.problems.is_empty() {
        Ok(file)
    } else {
        order::by_key(&mut reader.problems, |p| (p.line, p.column));
        Err(reader.problems)
    }
}

impl Reader<'_> {
    pub(super) fn report(&mut self, at: usize, message: String) {
        self.problems.push(Problem::at(self.source, at, message));
    }

    fn line(&self, at: usize) -> u32 {
        self.source.line_col(at as u32).0
    }

    fn plc(&mut self, name: &Spanned<String>) -> Plc {
        Plc::find(name.get_ref()).unwrap_or_else(|| {
            let message = format!("unknown model `{}`", name.get_ref());
            self.report(name.span().start, message);
            Plc::any(ModelId::Fx3u)
        })
    }

    fn file(&mut self, raw: RawFile) -> TestFile {
        let given = raw.model.as_ref().map(|name| self.plc(name));
        let program = raw.program.map(|program| self.program(program));
        let machine = self.machine(raw.machine.as_ref());
        let modules = self.modules(raw.modules);
        self.no_index(raw.index.as_ref());
        let mut cases: Vec<Case> = Vec::new();
        for case in raw.case {
            let name = case.get_ref().name.clone();
            if cases.iter().any(|c| c.name == *name.get_ref()) {
                let message = format!(
                    "the case `{}` is defined twice in this file",
                    name.get_ref()
                );
                self.report(name.span().start, message);
            }
            let mut case = self.case(case, given, program.as_ref());
            if case.machine.is_none() {
                case.machine.clone_from(&machine);
            }
            if case.modules.is_empty() {
                case.modules.clone_from(&modules);
            }
            cases.push(case);
        }
        TestFile {
            name: self.source.name.clone(),
            topic: raw.topic,
            note: raw.note.unwrap_or_default(),
            cases,
        }
    }

    /// The program of a case. A file is read once for all cases.
    fn program(&mut self, raw: Spanned<RawProgram>) -> Tested {
        let at = raw.span().start;
        let file = match raw.into_inner() {
            RawProgram::List(list) => return Tested::list(list),
            RawProgram::File(file) => file,
        };
        let folder = Path::new(&self.source.name).parent();
        let path = folder.unwrap_or(Path::new("")).join(file);
        if let Some(read) = self.programs.get(&path) {
            return read.clone();
        }
        let read = program::read(&path).unwrap_or_else(|message| {
            self.report(at, message);
            Tested::unread()
        });
        self.programs.insert(path, read.clone());
        read
    }

    /// Rejects bounds of operands with an index, which belong to the settings of a program file.
    fn no_index(&mut self, index: Option<&Spanned<IgnoredAny>>) {
        if let Some(index) = index {
            let message = "`[index]` belongs in rungc.toml and applies to its program: test that with `program = { file = \"…\" }`";
            self.report(index.span().start, message.to_string());
        }
    }

    /// The machine that a file beside the test file describes.
    fn machine(&mut self, name: Option<&Spanned<String>>) -> Option<Arc<Description>> {
        let name = name?;
        let folder = Path::new(&self.source.name).parent();
        let path = folder.unwrap_or(Path::new("")).join(name.get_ref());
        match plant::load(&path) {
            Ok(machine) => Some(Arc::new(machine)),
            Err(error) => {
                self.report(name.span().start, error.to_string());
                None
            }
        }
    }

    /// A case; `given` and `usual` are the model and the program that the file names for all of them.
    fn case(&mut self, raw: Spanned<RawCase>, given: Option<Plc>, usual: Option<&Tested>) -> Case {
        let at = raw.span().start;
        let raw = raw.into_inner();
        let given = raw.model.as_ref().map(|name| self.plc(name)).or(given);
        let tested = match raw.program {
            Some(program) => self.program(program),
            None => usual.cloned().unwrap_or_else(|| {
                let message = "neither the case nor the file has a `program`";
                self.report(at, message.to_string());
                Tested::unread()
            }),
        };
        let plc = given.or(tested.plc).unwrap_or_else(|| {
            let message = "`model` is missing, the PLC that the program is for".to_string();
            self.report(at, message);
            Plc::any(ModelId::Fx3u)
        });
        self.no_index(raw.index.as_ref());
        let others = self.others(raw.plc, plc);
        let wires = raw.wire.iter();
        let wires = wires.map(|line| line.iter().filter_map(|port| self.port(port)).collect());
        let wires = wires.collect();
        let mut serve = Vec::new();
        for (port, protocol) in raw.serve {
            match self.port(&port).map(|port| port.id) {
                Some(PortId::Tcp(number, _)) => serve.push((number, protocol)),
                Some(PortId::Serial(_) | PortId::Can) => {
                    let message = "a server is named `TCP:502`".to_string();
                    self.report(port.span().start, message);
                }
                None => {}
            }
        }
        let init = self.settings(raw.init);
        let steps: Vec<Step> = raw.step.into_iter().map(|step| self.step(step)).collect();
        let check = match raw.rejects {
            Some(rejects) => {
                if !steps.is_empty() {
                    self.report(at, "use `rejects` or steps in a case, not both".to_string());
                }
                Check::Rejects(Rejects {
                    code: rejects.code,
                    line: rejects.line,
                })
            }
            None => {
                if steps.is_empty() {
                    self.report(at, "a case needs steps or `rejects`".to_string());
                }
                Check::Steps { init, steps }
            }
        };
        Case {
            line: self.line(raw.name.span().start),
            name: raw.name.into_inner(),
            model: plc.model,
            variant: plc.variant,
            source: raw.source,
            basis: raw.basis,
            note: raw.note,
            program: tested.program,
            machine: self.machine(raw.machine.as_ref()),
            modules: self.modules(raw.modules),
            others,
            wires,
            serve,
            check,
        }
    }

    fn step(&mut self, raw: Spanned<RawStep>) -> Step {
        let at = raw.span().start;
        let raw = raw.into_inner();
        let run = match (raw.scans, raw.run_ms) {
            (Some(_), Some(run_ms)) => {
                let message = "use `scans` or `run_ms` in a step, not both".to_string();
                self.report(run_ms.span().start, message);
                Run::Scans(1)
            }
            (None, Some(ms)) => Run::Ms(ms.into_inner()),
            (scans, None) => Run::Scans(scans.unwrap_or(1)),
        };
        let scan_ms = match raw.scan_ms {
            Some(ms) if !(1..=32_767).contains(ms.get_ref()) => {
                self.report(ms.span().start, "`scan_ms` is 1 to 32767".to_string());
                10
            }
            ms => ms.map_or(10, Spanned::into_inner),
        };
        let mut rx = Vec::new();
        for (port, text) in raw.rx.into_iter().flatten() {
            let port = self.line_text(&port, Way::ToPlc, std::slice::from_ref(&text));
            rx.extend(port.map(|port| {
                let items = port.id.items(&text);
                (port, items)
            }));
        }
        let mut expect_tx = Vec::new();
        for (port, sent) in raw.expect_tx.into_iter().flatten() {
            let port = self.line_text(&port, Way::FromPlc, sent.texts());
            let texts = sent.texts().iter();
            expect_tx.extend(port.map(|port| {
                let sent = texts.map(|text| port.id.sent(text)).collect();
                (port, sent)
            }));
        }
        let cut = raw
            .cut
            .map(|cut| cut.iter().filter_map(|port| self.port(port)).collect());
        Step {
            line: self.line(at),
            power_cycle: raw.power_cycle,
            running: raw.mode.map_or(Vec::new(), |mode| self.mode(&mode)),
            rx,
            expect_tx,
            cut,
            power_fails: raw.power_fails,
            clock: raw.clock.and_then(|text| self.clock(&text)),
            bfm: self.buffer(raw.bfm),
            answers_after: self.delays(raw.answers_after),
            analog: self.analog(raw.analog),
            set: self.settings(raw.set),
            signals: self.signals(raw.pulses.unwrap_or_default(), raw.encoder),
            run,
            scan_ms,
            expect: self.settings(raw.expect),
            expect_bfm: self.buffer(raw.expect_bfm),
            expect_position: raw.expect_position.into_iter().collect(),
        }
    }

    /// The other PLCs of a case.
    fn others(&mut self, plcs: Vec<RawPlc>, usual: Plc) -> Vec<OtherPlc> {
        self.others = plcs.iter().map(|plc| plc.name.get_ref().clone()).collect();
        let mut others: Vec<OtherPlc> = Vec::new();
        for plc in plcs {
            let (at, name) = (plc.name.span().start, plc.name.into_inner());
            if plc.program.trim().is_empty() {
                self.report(at, format!("the program of the PLC `{name}` is empty"));
            }
            if !serial::is_name(&name) {
                let message = "the name of a PLC consists of letters and digits".to_string();
                self.report(at, message);
            } else if others.iter().any(|other| other.name == name) {
                self.report(
                    at,
                    format!("the PLC `{name}` is defined twice in this case"),
                );
            }
            let named = plc.model.as_ref().map(|model| self.plc(model));
            let Plc { model, variant } = named.unwrap_or(usual);
            others.push(OtherPlc {
                name,
                model,
                variant,
                program: plc.program,
                init: self.settings(plc.init),
            });
        }
        for (i, other) in (1..).zip(&mut others) {
            other.init.iter_mut().for_each(|setting| setting.plc = i);
        }
        others
    }

    /// A name without that of another PLC before it, and the number of its PLC.
    fn own<'n>(&self, name: &'n str) -> (&'n str, usize) {
        let other = name.split_once(':').and_then(|(plc, own)| {
            let number = self.others.iter().position(|other| other == plc)?;
            Some((own, number + 1))
        });
        other.unwrap_or((name, 0))
    }

    /// The port of a name.
    fn port(&mut self, port: &Spanned<String>) -> Option<Port> {
        let (own, plc) = self.own(port.get_ref());
        match PortId::parse(own) {
            Ok(id) => Some(Port { plc, id }),
            Err(message) => {
                self.report(port.span().start, message.to_string());
                None
            }
        }
    }

    /// Holds what goes over a port to the format; returns the port.
    fn line_text(&mut self, port: &Spanned<String>, way: Way, texts: &[String]) -> Option<Port> {
        let (own, _) = self.own(port.get_ref());
        for text in texts {
            if let Err(message) = serial::check_text(own, way, text) {
                self.report(port.span().start, message.to_string());
            }
        }
        self.port(port)
    }

    /// Where the RUN/STOP switches of PLCs are put.
    fn mode(&mut self, mode: &Spanned<RawMode>) -> Vec<(usize, bool)> {
        match mode.get_ref() {
            RawMode::All(switch) => {
                let all = 0..=self.others.len();
                all.map(|plc| (plc, *switch == Switch::Run)).collect()
            }
            RawMode::Of(switches) => {
                let mut running = Vec::new();
                for (name, switch) in switches {
                    match self.others.iter().position(|other| other == name) {
                        Some(i) => running.push((i + 1, *switch == Switch::Run)),
                        None => {
                            let message = format!("the case has no PLC `{name}`");
                            self.report(mode.span().start, message);
                        }
                    }
                }
                running
            }
        }
    }

    /// What comes in at input terminals.
    fn signals(&mut self, pulses: Map<RawPulses>, encoder: Option<RawEncoder>) -> Vec<Signal> {
        let mut signals = Vec::new();
        for (name, RawPulses { count, hz }) in pulses {
            if let Some(input) = self.terminal(&name)
                && self.frequency(&name, hz)
            {
                signals.push(Signal::Pulses { input, count, hz });
            }
        }
        if let Some(RawEncoder { a, b, count, hz }) = encoder
            && let (Some(first), Some(second)) = (self.terminal(&a), self.terminal(&b))
            && self.frequency(&a, hz)
        {
            signals.push(Signal::Encoder {
                a: first,
                b: second,
                count,
                hz,
            });
        }
        signals
    }

    fn terminal(&mut self, name: &Spanned<String>) -> Option<u32> {
        match Target::parse(name.get_ref()) {
            Ok(Target::Bit(DeviceClass::X, number)) => Some(number),
            _ => {
                let message = format!("`{}` is not an input terminal", name.get_ref());
                self.report(name.span().start, message);
                None
            }
        }
    }

    fn frequency(&mut self, name: &Spanned<String>, hz: f64) -> bool {
        let fits = (0.001..=1_000_000.0).contains(&hz);
        if !fits {
            let message = "`hz` is 0.001 to 1000000".to_string();
            self.report(name.span().start, message);
        }
        fits
    }

    fn settings(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<Setting> {
        raw.into_iter()
            .filter_map(|(name, value)| {
                let (own, plc) = self.own(name.get_ref());
                let target = match Target::parse(own) {
                    Ok(target) => target,
                    Err(message) => {
                        self.report(name.span().start, message);
                        return None;
                    }
                };
                match Value::of(target, value.get_ref()) {
                    Ok(value) => Some(Setting { plc, target, value }),
                    Err(expected) => {
                        let message =
                            format!("the value of `{}` must be {expected}", name.get_ref());
                        self.report(value.span().start, message);
                        None
                    }
                }
            })
            .collect()
    }

    /// A 16-bit value.
    fn word(&mut self, value: &Spanned<Scalar>) -> Option<i16> {
        let word = integer(value.get_ref(), 16).map(|v| v as i16);
        if word.is_none() {
            let message = "this value must be a 16-bit integer".to_string();
            self.report(value.span().start, message);
        }
        word
    }

    fn buffer(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<(u16, u16, i16)> {
        raw.into_iter()
            .filter_map(|(name, value)| {
                let place = name.get_ref().split_once(':');
                let place = place.and_then(|(u, a)| Some((u.parse().ok()?, a.parse().ok()?)));
                let Some((unit, address)) = place else {
                    let message = "write a word of buffer memory as `MODULE:ADDRESS`".to_string();
                    self.report(name.span().start, message);
                    return None;
                };
                Some((unit, address, self.word(&value)?))
            })
            .collect()
    }

    fn analog(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<(u8, i16)> {
        raw.into_iter()
            .filter_map(|(name, value)| {
                let channel = name.get_ref().strip_prefix("AD");
                let Some(channel) = channel.and_then(|n| n.parse().ok()) else {
                    let message = "write an analog input as `AD0`, `AD1`, …".to_string();
                    self.report(name.span().start, message);
                    return None;
                };
                Some((channel, self.word(&value)?))
            })
            .collect()
    }

    fn clock(&mut self, text: &Spanned<String>) -> Option<Clock> {
        let clock = clock(text.get_ref());
        if clock.is_none() {
            let message = "write a time as `2026-01-02T03:04:05`".to_string();
            self.report(text.span().start, message);
        }
        clock
    }
}

/// Reads `2026-01-02T03:04:05`.
fn clock(text: &str) -> Option<Clock> {
    let (date, time) = text.split_once('T')?;
    let mut date = date.splitn(3, '-');
    let (year, month, day) = (date.next()?, date.next()?, date.next()?);
    let mut time = time.splitn(3, ':');
    let (hour, minute, second) = (time.next()?, time.next()?, time.next()?);
    Clock::new(
        year.parse().ok()?,
        month.parse().ok()?,
        day.parse().ok()?,
        hour.parse().ok()?,
        minute.parse().ok()?,
        second.parse().ok()?,
    )
}

/// An integer of this many bits, signed or unsigned; `"0xFFFF"` too.
fn integer(value: &Scalar, bits: u32) -> Option<i64> {
    let value = match value {
        Scalar::Integer(value) => *value,
        Scalar::Text(text) => i64::from_str_radix(text.strip_prefix("0x")?, 16).ok()?,
        Scalar::Float(_) => return None,
    };
    (-1 << (bits - 1)..1 << bits)
        .contains(&value)
        .then_some(value)
}

impl Value {
    /// The value that a target is given or compared with; the error says what is expected.
    fn of(target: Target, value: &Scalar) -> Result<Value, &'static str> {
        let word = || integer(value, 16).map(|v| Value::Int((v as i16).into()));
        let double = || integer(value, 32).map(|v| Value::Int(v as i32));
        match target {
            Target::Bit(..) => match value {
                Scalar::Integer(v @ 0..=1) => Ok(Value::Int(*v as i32)),
                _ => Err("0 or 1"),
            },
            Target::Current(rungc_syntax::DeviceClass::C, FIRST_COUNTER32..) => {
                double().ok_or("a 32-bit integer")
            }
            Target::Word(..) | Target::Current(..) | Target::Nibbles(1..=4, ..) => {
                word().ok_or("a 16-bit integer, or hexadecimal in quotes: \"0xFFFF\"")
            }
            Target::Pair(..) | Target::Nibbles(..) | Target::Pulses(_) => {
                double().ok_or("a 32-bit integer")
            }
            Target::Float(..) | Target::Frequency(_) | Target::Channel(_) => match value {
                Scalar::Integer(v) => Ok(Value::Float(*v as f64)),
                Scalar::Float(v) => Ok(Value::Float(*v)),
                Scalar::Text(_) => Err("a number"),
            },
            Target::Text(..) => match value {
                Scalar::Text(text) => Ok(Value::Text(text.clone())),
                _ => Err("a text in quotes"),
            },
        }
    }
}
