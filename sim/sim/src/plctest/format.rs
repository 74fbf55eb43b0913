//! Reading a test file: TOML to [`TestFile`], every mistake with its place.

use super::keys;
use super::naming::Named;
use super::program::{self, CaseProgram, RawProgram, Tested};
use super::raw::{Map, Near, RawCase, RawFile, RawNames, RawPlc, RawRow, RawScenario, Scalar};
use super::rules::RawOverTime;
use super::serial::{self, PortId, Protocol};
use super::{Case, Check, OtherPlc, Rejects, Setting, Step, TestFile, Value};
use crate::plant::{self, Description};
use crate::problem::{self, Problem};
use crate::setting::check_lasts;
use crate::target::Target;
use rungc_models::{ModelId, Plc};
use rungc_project::Project;
use rungc_syntax::{Source, text};
use serde::de::IgnoredAny;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;

/// Values of names in one of several cases.
type Row = BTreeMap<String, Scalar>;

/// A row by its names, and what it calls itself.
fn named(row: &RawRow) -> (Option<String>, Row) {
    let values = row.get_ref().iter();
    let values = values.map(|(name, value)| (name.get_ref().clone(), value.get_ref().clone()));
    let mut row: Row = values.collect();
    let own = match row.remove("name") {
        Some(Scalar::Text(name)) => Some(name),
        Some(Scalar::Integer(number)) => Some(number.to_string()),
        Some(Scalar::Float(_) | Scalar::Near(_)) | None => None,
    };
    (own, row)
}

/// Collects the problems of one file.
pub(super) struct Reader<'t> {
    source: &'t Source,
    problems: Vec<Problem>,
    /// The programs in files that were read, by their paths.
    programs: BTreeMap<PathBuf, Tested>,
    /// The files that were read.
    pub(super) inputs: BTreeSet<PathBuf>,
    /// Names of the other PLCs of the case being read.
    pub(super) others: Vec<String>,
    /// The PLC of the case being read, and the others in their order.
    pub(super) named: Vec<Named>,
    /// The scenarios of the file, and how many of them the step being read may name.
    pub(super) scenarios: Vec<RawScenario>,
    pub(super) scenarios_known: usize,
    /// Values of names in the case being read, if it is one of several.
    row: Option<Row>,
    /// Those names that a case of its rows has asked for.
    named_in_rows: BTreeSet<String>,
}

/// Reads the text of a test file.
pub(super) fn parse(source: &Source) -> Result<TestFile, Vec<Problem>> {
    let raw: RawFile = problem::from_toml(source).map_err(keys::with_homes)?;
    let mut reader = Reader {
        source,
        problems: Vec::new(),
        programs: BTreeMap::new(),
        inputs: BTreeSet::from([PathBuf::from(&source.name)]),
        others: Vec::new(),
        named: Vec::new(),
        scenarios: Vec::new(),
        scenarios_known: 0,
        row: None,
        named_in_rows: BTreeSet::new(),
    };
    let file = reader.file(raw);
    if reader.problems.is_empty() {
        Ok(file)
    } else {
        reader.problems.sort_by_key(|p| (p.line, p.column));
        // Rows and scenarios are read for each case.
        let mut known = BTreeSet::new();
        let mut all = std::mem::take(&mut reader.problems);
        all.retain(|p| known.insert((p.line, p.column, p.message.clone())));
        reader.problems = all;
        Err(reader.problems)
    }
}

impl Reader<'_> {
    pub(super) fn report(&mut self, at: usize, message: String) {
        self.problems.push(Problem::at(self.source, at, message));
    }

    /// The test file's name.
    pub(super) fn file_name(&self) -> &str {
        &self.source.name
    }

    pub(super) fn line(&self, at: usize) -> u32 {
        self.source.line_col(at as u32).0
    }

    fn plc(&mut self, name: &Spanned<String>) -> Plc {
        Plc::named(name.get_ref()).unwrap_or_else(|unknown| {
            let message = format!("{}: {}", unknown.message, unknown.help);
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
        self.take_scenarios(raw.scenario);
        self.named = self.of_file(given, program.as_ref());
        let rules = self.rules(RawOverTime {
            never: raw.never,
            always: raw.always,
            reachable: raw.reachable,
            whenever: raw.whenever,
            stays: raw.stays,
        });
        let mut cases: Vec<Case> = Vec::new();
        for case in raw.case {
            let rows = case.get_ref().rows.clone();
            for (row, case) in self.rows(case) {
                self.row = row;
                let name = case.get_ref().name.clone();
                let mut case = self.case(case, given, program.as_ref());
                if cases.iter().any(|c| c.name == case.name) {
                    let message = format!("the case `{}` is defined twice in this file", case.name);
                    self.report(name.span().start, message);
                }
                let wrong = match case.name.trim() {
                    "" => Some("a case has a name"),
                    _ if case.name.contains(text::acts) => {
                        Some("the name of a case is one line, without control characters")
                    }
                    _ => None,
                };
                if let Some(message) = wrong {
                    self.report(name.span().start, message.to_string());
                }
                if case.machine.is_none() {
                    case.machine.clone_from(&machine);
                }
                if case.modules.is_empty() {
                    case.modules.clone_from(&modules);
                }
                case.rules.extend(&rules);
                cases.push(case);
            }
            self.row = None;
            self.unused(&rows);
        }
        TestFile {
            name: self.source.name.clone(),
            topic: raw.topic,
            note: raw.note.unwrap_or_default(),
            inputs: std::mem::take(&mut self.inputs),
            cases,
        }
    }

    /// The PLC that the rules of the file are about, as far as the file says.
    fn of_file(&self, given: Option<Plc>, program: Option<&Tested>) -> Vec<Named> {
        let named = program.and_then(|program| {
            let plc = given.or(program.plc)?;
            Some(Named::new(plc, program.program.clone()))
        });
        named.into_iter().collect()
    }

    /// Takes notice of the file's scenarios.
    fn take_scenarios(&mut self, scenarios: Vec<RawScenario>) {
        for scenario in scenarios {
            let (at, name) = (scenario.name.span().start, scenario.name.get_ref());
            if self.scenarios.iter().any(|s| s.name.get_ref() == name) {
                let message = format!("the scenario `{name}` is defined twice in this file");
                self.report(at, message);
            }
            if scenario.step.is_empty() {
                self.report(at, format!("the scenario `{name}` has no steps"));
            }
            self.scenarios.push(scenario);
        }
        self.scenarios_known = self.scenarios.len();
    }

    /// The cases that one in the file stands for: one for each of its rows, else itself.
    fn rows(&mut self, case: Spanned<RawCase>) -> Vec<(Option<Row>, Spanned<RawCase>)> {
        if case.get_ref().rows.is_empty() {
            return vec![(None, case)];
        }
        let (span, raw) = (case.span(), case.into_inner());
        let mut cases = Vec::new();
        for (number, row) in (1..).zip(&raw.rows) {
            let (own, row) = named(row);
            let (at, name) = (raw.name.span(), raw.name.get_ref());
            let own = own.unwrap_or_else(|| number.to_string());
            let mut case = raw.clone();
            case.name = Spanned::new(at, format!("{name}[{own}]"));
            cases.push((Some(row), Spanned::new(span.clone(), case)));
        }
        cases
    }

    /// Reports values in the rows of a case that it does not use.
    fn unused(&mut self, rows: &[RawRow]) {
        let used = std::mem::take(&mut self.named_in_rows);
        let mut found = BTreeSet::new();
        for name in rows.iter().flat_map(|row| row.get_ref().keys()) {
            let (at, name) = (name.span().start, name.get_ref());
            if name != "name" && !used.contains(name) && found.insert(name) {
                let message =
                    format!("no value of this case is `\"${name}\"`, which its rows give");
                self.report(at, message);
            }
        }
    }

    /// The program of the project that the test file belongs to.
    fn of_project(&mut self, at: usize) -> Option<Tested> {
        let settings = Project::find(Path::new(&self.source.name))?;
        let path = match Project::load(&settings) {
            Ok(project) => program::near(project.program()?),
            Err(error) => {
                self.report(at, program::error_lines(&error));
                return Some(Tested::unread());
            }
        };
        Some(self.program_file(path, at))
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
        self.program_file(path, at)
    }

    fn program_file(&mut self, path: PathBuf, at: usize) -> Tested {
        if let Some(read) = self.programs.get(&path) {
            return read.clone();
        }
        self.inputs.extend(Project::find(&path));
        self.inputs.insert(path.clone());
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
        self.inputs.insert(path.clone());
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
            None => match usual.cloned().or_else(|| self.of_project(at)) {
                Some(usual) => usual,
                None => {
                    let message = "neither the case nor the file has a `program`, nor does a rungc.toml above it name one";
                    self.report(at, message.to_string());
                    Tested::unread()
                }
            },
        };
        let plc = given.or(tested.plc).unwrap_or_else(|| {
            let message = "`model` is missing, the PLC that the program is for".to_string();
            self.report(at, message);
            Plc::any(ModelId::Fx3u)
        });
        self.no_index(raw.index.as_ref());
        self.named = vec![Named::new(plc, tested.program.clone())];
        let others = self.others(raw.plc, plc);
        let wires = raw.wire.iter().map(|line| self.wire(line)).collect();
        let serve = self.servers(raw.serve);
        let init = self.settings(raw.init);
        let steps: Vec<Step> = self.steps(raw.step);
        let rules = self.rules(RawOverTime {
            never: raw.never,
            always: raw.always,
            reachable: raw.reachable,
            whenever: raw.whenever,
            stays: raw.stays,
        });
        let trace = self.trace(raw.name.get_ref(), &raw.trace);
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
            requirements: self.requirements(raw.requirement),
            source: raw.source,
            basis: raw.basis,
            note: raw.note,
            program: tested.program,
            machine: self.machine(raw.machine.as_ref()),
            modules: self.modules(raw.modules),
            others,
            wires,
            serve,
            rules,
            trace,
            check,
        }
    }

    /// Servers by their ports, with the protocols that they speak.
    fn servers(&mut self, raw: Map<Protocol>) -> Vec<(u16, Protocol)> {
        let mut found = Vec::new();
        for (port, protocol) in raw {
            match self.port(&port).map(|port| port.id) {
                Some(PortId::Tcp(number, _)) => found.push((number, protocol)),
                Some(PortId::Serial(_) | PortId::Can) => {
                    let message = "a server is named `TCP:502`".to_string();
                    self.report(port.span().start, message);
                }
                None => {}
            }
        }
        found
    }

    /// The identifiers of a case's requirements.
    fn requirements(&mut self, raw: Option<Spanned<RawNames>>) -> Vec<String> {
        let Some(raw) = raw else { return Vec::new() };
        let at = raw.span().start;
        let names = match raw.into_inner() {
            RawNames::One(name) => vec![name],
            RawNames::Several(names) => names,
        };
        let mut ids: Vec<String> = Vec::new();
        for name in names {
            if name.trim().is_empty() || name.contains(text::acts) {
                let message = "the identifier of a requirement is one line of text";
                self.report(at, message.to_string());
            } else if !ids.contains(&name) {
                ids.push(name);
            }
        }
        ids
    }

    /// The other PLCs of a case.
    fn others(&mut self, plcs: Vec<RawPlc>, usual: Plc) -> Vec<OtherPlc> {
        self.others = plcs.iter().map(|plc| plc.name.get_ref().clone()).collect();
        let mut others: Vec<OtherPlc> = Vec::new();
        let mut all = std::mem::take(&mut self.named);
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
            let named = named.unwrap_or(usual);
            let Plc { model, variant } = named;
            // Its own devices are named without it.
            self.named = vec![Named::new(named, CaseProgram::List(plc.program.clone()))];
            others.push(OtherPlc {
                name,
                model,
                variant,
                program: plc.program,
                init: self.settings(plc.init),
            });
            all.append(&mut self.named);
        }
        self.named = all;
        for (i, other) in (1..).zip(&mut others) {
            other.init.iter_mut().for_each(|setting| setting.plc = i);
        }
        others
    }

    /// Devices that are given these values.
    pub(super) fn settings(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<Setting> {
        let near = raw
            .values()
            .find(|value| matches!(value.get_ref(), Scalar::Near(_)));
        if let Some(at) = near.map(|value| value.span().start) {
            self.report(at, "`tolerance` belongs to an expected value".to_string());
        }
        for name in raw.keys() {
            self.lasting(name);
        }
        self.expected(raw)
    }

    /// Reports a device that keeps no value that it is given.
    fn lasting(&mut self, name: &Spanned<String>) {
        let known = self.problems.len();
        let Some((plc, target)) = self.target(name) else {
            // Reported where its value is read.
            self.problems.truncate(known);
            return;
        };
        let Some(model) = self.named.get(plc).map(Named::model) else {
            return;
        };
        if let Err(why) = check_lasts(model, target, |_| true) {
            self.report(name.span().start, why);
        }
    }

    /// Devices of which these values are expected.
    pub(super) fn expected(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<Setting> {
        let mut settings: Vec<(String, Setting)> = Vec::new();
        for (name, value) in raw {
            let Some(setting) = self.setting(&name, &value) else {
                continue;
            };
            let place = (setting.plc, setting.target);
            let mut before = settings.iter();
            match before.find(|(_, other)| (other.plc, other.target) == place) {
                Some((other, _)) => {
                    let message = format!("`{}` and `{other}` are one device", name.get_ref());
                    self.report(name.span().start, message);
                }
                None => settings.push((name.into_inner(), setting)),
            }
        }
        settings.into_iter().map(|(_, setting)| setting).collect()
    }

    fn setting(&mut self, name: &Spanned<String>, value: &Spanned<Scalar>) -> Option<Setting> {
        let (plc, target) = self.target(name)?;
        let at = value.span().start;
        let given = self.of_row(value.get_ref(), at);
        let (value, tolerance) = match &given {
            Scalar::Near(near) => (middle(target, *near), Some(near.tolerance)),
            other => (Value::of(target, other), None),
        };
        match value {
            Ok(value) => Some(Setting {
                plc,
                target,
                value,
                tolerance,
            }),
            Err(expected) => {
                let message = format!("the value of `{}` must be {expected}", name.get_ref());
                self.report(at, message);
                None
            }
        }
    }

    /// A value, or what its name stands for in the row at hand.
    pub(super) fn of_row(&mut self, value: &Scalar, at: usize) -> Scalar {
        let Scalar::Text(text) = value else {
            return value.clone();
        };
        let (Some(row), Some(name)) = (&self.row, text.strip_prefix('$')) else {
            return value.clone();
        };
        if let Some(value) = row.get(name) {
            self.named_in_rows.insert(name.to_owned());
            return value.clone();
        }
        self.report(at, format!("the row has no `{name}`"));
        Scalar::Integer(0)
    }
}

/// The number in the middle of those that are near enough.
fn middle(target: Target, near: Near) -> Result<Value, &'static str> {
    let whole = near.value as i64;
    match target {
        Target::Bit(..) | Target::Text(..) => Err("exact: `tolerance` is for numbers"),
        Target::Float(..) | Target::Frequency(_) | Target::Channel(_) => {
            Ok(Value::Float(near.value))
        }
        _ if whole as f64 == near.value => Value::of(target, &Scalar::Integer(whole)),
        _ => Value::of(target, &Scalar::Float(near.value)),
    }
}
