//! Printing diagnostics: human-readable, and for tools.

pub mod github;
mod human;
mod json;
pub mod junit;
pub mod sarif;
mod visible;
mod window;

pub use visible::{breaks_lines, to_json, visible, visible_line};

use crate::args::{Format, Reporting};
use crate::commands::{Context, Verbosity, listed_counts, print_bytes};
use crate::language::Chosen;
use rungc::language::message;
use rungc::location::{Location, named};
use rungc::{Language, Levels};
use rungc_analysis::check::ports::Setup;
use rungc_evidence::Evidence;
use rungc_firmware::report::Report as Takes;
use rungc_lower::compile::Compiled;
use rungc_syntax::{Diagnostic, Diagnostics, Fix, Program, Severity, Span};
use std::io::{self, Write};
use std::path::Path;

/// Findings in one file.
pub struct Findings<'a> {
    /// The file as named on the command line.
    pub path: &'a Path,
    /// The program, for its source text and steps; `None` if nothing could be read.
    pub program: Option<&'a Program>,
    /// Size of the compiled or checked program, if there is one.
    pub size: Option<Size>,
    /// The findings that count, ordered by location.
    pub diagnostics: Vec<Diagnostic>,
    /// The step number of each instruction, if it came to counting them.
    pub step_numbers: Vec<u32>,
    /// The serial ports that the program uses or sets up.
    pub ports: Vec<Setup>,
    /// Resources on a machine, if requested.
    pub takes: Option<Takes>,
    /// The network that each diagnostic is about, drawn, if requested; empty if it is about none.
    pub drawn: Vec<String>,
    /// Evidence that verdicts rest on, if properties were decided.
    pub verification: Option<Evidence>,
    /// Language of the settings that hold for the program.
    pub settings_language: Option<Language>,
}

/// Model and length of a program.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Name of the model.
    pub model: &'static str,
    /// Length in steps.
    pub steps: u32,
}

impl From<&Compiled> for Size {
    fn from(compiled: &Compiled) -> Self {
        Size {
            model: compiled.model.name,
            steps: compiled.steps,
        }
    }
}

impl Reporting {
    /// Which findings count, and how much.
    pub fn levels(&self) -> Levels {
        Levels {
            allow: self.allow.clone(),
            deny: self.deny.clone(),
            deny_warnings: self.deny_warnings,
            rules: self.rules.clone(),
        }
    }
}

impl<'a> Findings<'a> {
    /// Takes the diagnostics that `reporting` lets through, each as severe as it makes them.
    pub fn new(
        path: &'a Path,
        program: &'a Program,
        diagnostics: Diagnostics,
        reporting: &Reporting,
    ) -> Self {
        let diagnostics = reporting.levels().apply(diagnostics);
        Findings {
            path,
            program: Some(program),
            size: None,
            diagnostics,
            step_numbers: Vec::new(),
            ports: Vec::new(),
            takes: None,
            drawn: Vec::new(),
            verification: None,
            settings_language: reporting.lang,
        }
    }

    /// Adds diagnostics that `reporting` lets through, in the order of their places.
    pub fn add(&mut self, more: Diagnostics, reporting: &Reporting) {
        let Some(program) = self.program else {
            return;
        };
        let more = Findings::new(self.path, program, more, reporting);
        self.diagnostics.extend(more.diagnostics);
        self.diagnostics
            .sort_by_key(|diagnostic| diagnostic.span.start);
    }

    /// Of a file that could not be read at all, and why.
    pub fn unread(path: &'a Path, why: Diagnostic) -> Self {
        Findings {
            path,
            program: None,
            size: None,
            diagnostics: vec![why],
            step_numbers: Vec::new(),
            ports: Vec::new(),
            takes: None,
            drawn: Vec::new(),
            verification: None,
            settings_language: None,
        }
    }

    /// Name of the program for users: the name of its source, or among `many` its path.
    pub fn name(&self, many: bool) -> String {
        match self.program {
            Some(program) if !many || self.path == Path::new("-") => program.source.name.clone(),
            _ => self.path.display().to_string(),
        }
    }

    /// Language of a human-readable report of them.
    pub fn language(&self, cx: Context) -> Language {
        cx.language.or(self.settings_language)
    }

    /// Location of a span; `None` if nothing could be read.
    pub fn location(&self, span: Span) -> Option<Location> {
        let program = self.program?;
        Some(Location::of(program, &self.step_numbers, span))
    }

    /// The fix of a diagnostic, if the program is a text that it can change.
    fn fix<'d>(&self, diagnostic: &'d Diagnostic) -> Option<&'d Fix> {
        let list = self.program?.kind.is_list();
        diagnostic.fix.as_ref().filter(|_| list)
    }

    /// Number of findings with this severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.diagnostics
            .iter()
            .filter(|d| d.severity == severity)
            .count()
    }

    /// Number of findings by severity.
    pub fn totals(&self) -> Totals {
        Totals {
            errors: self.program.map_or(0, |_| self.count(Severity::Error)),
            warnings: self.count(Severity::Warning),
            notes: self.count(Severity::Note),
        }
    }

    /// Returns true if the program cannot be compiled.
    pub fn failed(&self) -> bool {
        self.count(Severity::Error) > 0
    }
}

impl Totals {
    fn add(&mut self, other: Totals) {
        self.errors += other.errors;
        self.warnings += other.warnings;
        self.notes += other.notes;
    }
}

/// Reports on the programs of a command: to people program by program, to tools as one document at the end.
pub struct Reporter<'a> {
    reporting: &'a Reporting,
    color: bool,
    language: Chosen,
    stdout_in_use: bool,
    /// True if the command line may name several programs, so that the document is a list.
    many: bool,
    totals: Totals,
    json: Vec<json::File>,
    sarif: sarif::Log,
    junit: Vec<junit::Suite>,
    github: String,
}

/// Totals of the findings about programs.
#[derive(Clone, Default, Debug)]
pub struct Totals {
    /// Errors, but for that a program could not be read.
    pub errors: usize,
    /// Warnings.
    pub warnings: usize,
    /// Notes.
    pub notes: usize,
}

impl<'a> Reporter<'a> {
    /// Nothing reported yet. JSON and SARIF go to standard output, or to standard error if standard output carries what
    /// the command makes.
    pub fn new(reporting: &'a Reporting, cx: Context, many: bool) -> Self {
        Reporter {
            reporting,
            color: cx.color,
            language: cx.language,
            stdout_in_use: cx.stdout_in_use,
            many,
            totals: Totals::default(),
            json: Vec::new(),
            sarif: sarif::Log::default(),
            junit: Vec::new(),
            github: String::new(),
        }
    }

    /// Returns true if the command line may name several programs.
    pub fn many(&self) -> bool {
        self.many
    }

    /// Leaves standard output to what the command makes.
    pub fn leave_output(&mut self) {
        self.stdout_in_use = true;
    }

    /// Language of a human-readable report about a program with these settings.
    pub fn language(&self, reporting: &Reporting) -> Language {
        self.language.or(reporting.lang)
    }

    /// Returns true if the report is human-readable.
    pub fn is_for_people(&self) -> bool {
        self.reporting.format == Format::Human
    }

    /// Returns true if human-readable text follows the report in the same place.
    pub fn has_text(&self) -> bool {
        matches!(self.reporting.format, Format::Human | Format::Github)
    }

    /// Totals so far.
    pub fn totals(&self) -> Totals {
        self.totals.clone()
    }

    /// Takes the findings about one program; people read them at once.
    pub fn add(&mut self, findings: &Findings) -> io::Result<()> {
        self.totals.add(findings.totals());
        match self.reporting.format {
            Format::Human => {
                let name = findings.name(self.many);
                let style = human::Style {
                    limit: self.reporting.limit,
                    color: self.color,
                    language: self.language.or(findings.settings_language),
                };
                let mut out = io::stderr().lock();
                // A closed output does not stop the command.
                return human::print(findings, &name, style, &mut out).or_else(|error| match error
                    .kind()
                {
                    io::ErrorKind::BrokenPipe => Ok(()),
                    _ => Err(error),
                });
            }
            Format::Json => json::add(&mut self.json, json::file(findings), self.many),
            Format::Sarif => self.sarif.add(findings, self.many),
            Format::Junit => self.junit.push(junit::of_errors(findings)),
            Format::Github => self.github.push_str(&github::findings(findings)),
        }
        Ok(())
    }

    /// Takes the findings about a program that has no errors and runs. People read how many there are, unless they ask
    /// for details; `check` is the command that lists them.
    pub fn add_count(
        &mut self,
        findings: &Findings,
        check: Option<&str>,
        cx: Context,
    ) -> io::Result<()> {
        if !self.is_for_people() || cx.verbosity == Verbosity::Verbose {
            return self.add(findings);
        }
        let totals = findings.totals();
        if totals.warnings + totals.notes > 0 {
            let mut counts = vec![("warnings", totals.warnings), ("notes", totals.notes)];
            counts.retain(|(_, count)| *count > 0);
            let language = findings.language(cx);
            let counts = listed_counts(&counts, language);
            let name = findings.name(self.many);
            let id = if check.is_some() {
                "found-more"
            } else {
                "found"
            };
            let arguments = [
                ("name", (&name).into()),
                ("counts", (&counts).into()),
                ("command", check.unwrap_or_default().into()),
            ];
            cx.note(&message(language, id, &arguments));
        }
        self.totals.add(totals);
        Ok(())
    }

    /// Takes verdicts about a program: the findings that they led to, and in JUnit all of them as `cases`.
    pub fn add_verdicts(&mut self, findings: &Findings, cases: Vec<junit::Case>) -> io::Result<()> {
        if self.reporting.format != Format::Junit {
            return self.add(findings);
        }
        self.totals.add(findings.totals());
        if !self.many {
            // That the program has no errors, reported with its warnings, is not a case beside verdicts.
            self.junit.clear();
        }
        let evidence = findings.verification.as_ref();
        self.junit.push(junit::Suite {
            name: named(findings.path),
            properties: evidence.map_or_else(Vec::new, junit::grounds),
            cases,
        });
        Ok(())
    }

    /// Prints the document for tools, if there is anything to report.
    pub fn finish(self) -> io::Result<()> {
        let stdout_in_use = self.stdout_in_use;
        let Some(document) = self.document()? else {
            return Ok(());
        };
        if stdout_in_use {
            // A closed output does not stop the command.
            let _ = io::stderr().write_all(document.as_bytes());
            Ok(())
        } else {
            print_bytes(document.as_bytes())
        }
    }

    /// The document for tools, if there is anything to report; it ends with a line break.
    pub fn document(self) -> io::Result<Option<String>> {
        let document = match self.reporting.format {
            Format::Human => return Ok(None),
            Format::Json if self.json.is_empty() => return Ok(None),
            Format::Json => json::render(self.json, self.many)?,
            Format::Sarif if self.sarif.is_empty() => return Ok(None),
            Format::Sarif => self.sarif.render()?,
            Format::Junit if self.junit.is_empty() => return Ok(None),
            Format::Junit => junit::render("rungc", &self.junit)?,
            Format::Github => self.github,
        };
        Ok(Some(document))
    }
}
