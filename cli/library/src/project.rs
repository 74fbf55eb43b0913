//! A program with its settings, and what a check finds in it.

use crate::{
    Diagnostic, Error, Levels, Names, Program, other_model, settings, structured, unproven,
};
use rungc_analysis::resolve::resolve;
use rungc_frontend::{Read, ReadOptions, Unsaved};
use rungc_ladder::{build, svg::Painter, text};
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::{Model, Plc};
use rungc_project::{FILE, Project as Settings};
use rungc_syntax::Severity;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options for opening a project.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The PLC: `fx3u`, `h2u-mtq`. Default: that of the settings, else the one that the program names, else FX3U.
    pub model: Option<String>,
    /// The settings. Default: the nearest `rungc.toml`, in the program's folder or above it.
    pub settings: Option<PathBuf>,
    /// Codes of warnings and notes that are left out.
    pub allow: Vec<&'static str>,
    /// Codes of warnings that are errors.
    pub deny: Vec<&'static str>,
    /// Treat all warnings as errors.
    pub deny_warnings: bool,
    /// Texts that an editor has not saved: programs, their comments, settings.
    pub unsaved: Unsaved,
    /// Leave out the settings, such as those with mistakes.
    pub without_settings: bool,
}

/// A program as its author wrote it, with the settings of its `rungc.toml`. A clone is the same project.
#[derive(Clone, Debug)]
pub struct Project(Arc<Opened>);

#[derive(Debug)]
struct Opened {
    file: PathBuf,
    settings: Option<Settings>,
    read: Read,
    plc: Option<Plc>,
    levels: Levels,
}

/// What a check has found.
#[derive(Debug)]
pub struct Checked {
    project: Project,
    /// All findings that count, in the order of their places.
    pub diagnostics: Vec<Diagnostic>,
    /// The model that the program is for.
    pub model: &'static Model,
    /// Length of the program in steps.
    pub steps: u32,
}

impl Project {
    /// Opens a program of any format that `rungc` reads (`docs/src/inputs.md`), or the program of a folder.
    ///
    /// # Errors
    /// What cannot be read, settings with mistakes, a folder with several programs.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Project::open_with(path, &Options::default())
    }

    /// Opens a program with options.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), and a PLC that does not exist.
    pub fn open_with(path: impl AsRef<Path>, options: &Options) -> Result<Self, Error> {
        let path = path.as_ref();
        let given = options.settings.clone();
        let has_own = given.is_none() && path.join(FILE).is_file();
        let load = |path: &Path| Settings::load_with(path, &options.unsaved);
        let own = has_own.then(|| load(&path.join(FILE)));
        let file = settings::program_in(path, own.transpose()?.as_ref())?;
        let settings = given.or_else(|| Settings::find(&file));
        let settings = settings.filter(|_| !options.without_settings);
        let settings = settings.map(|path| load(&path)).transpose()?;
        let reading = ReadOptions {
            unsaved: options.unsaved.clone(),
            ..ReadOptions::default()
        };
        let reading = match &settings {
            Some(settings) => settings::reading(settings, reading),
            None => reading,
        };
        let read = rungc_frontend::read_with(&file, &reading)?;
        Project::new(file, settings, read, options)
    }

    /// An instruction list in memory, without settings. Its name appears in diagnostics.
    ///
    /// # Errors
    /// A PLC that does not exist.
    pub fn from_list(name: &str, list: &str, options: &Options) -> Result<Self, Error> {
        let read = rungc_frontend::read_text(name, list);
        Project::new(PathBuf::from(name), None, read, options)
    }

    /// A program in memory, of any format that its content shows, without settings. Its name appears in diagnostics.
    ///
    /// # Errors
    /// What is not a program, and a PLC that does not exist.
    pub fn from_bytes(name: &str, bytes: &[u8], options: &Options) -> Result<Self, Error> {
        let read = rungc_frontend::read_bytes(name, bytes)?;
        Project::new(PathBuf::from(name), None, read, options)
    }

    fn new(
        file: PathBuf,
        settings: Option<Settings>,
        mut read: Read,
        options: &Options,
    ) -> Result<Self, Error> {
        let chosen = options.model.as_deref().map(Plc::named).transpose();
        let chosen = chosen.map_err(|unknown| Error::Model {
            message: unknown.message,
            help: unknown.help,
        })?;
        let plc = chosen.or_else(|| settings.as_ref().and_then(settings::plc));
        unproven::suggest(&mut read, plc.map(|plc| plc.model));
        structured::compile(&mut read, plc.map(|plc| plc.model));
        if let Some(settings) = &settings {
            settings::complete(settings, &file, &mut read.program, plc)?;
        }
        let levels = Levels {
            allow: options.allow.clone(),
            deny: options.deny.clone(),
            deny_warnings: options.deny_warnings,
            rules: settings.as_ref().map(settings::rules).unwrap_or_default(),
        };
        Ok(Project(Arc::new(Opened {
            file,
            settings,
            read,
            plc,
            levels,
        })))
    }

    /// A program that was read before, and has what its settings say of it.
    pub fn from_read(
        file: PathBuf,
        read: Read,
        (settings, plc): (Option<Settings>, Option<Plc>),
        levels: Levels,
    ) -> Self {
        Project(Arc::new(Opened {
            file,
            settings,
            read,
            plc,
            levels,
        }))
    }

    /// The file of the program.
    pub fn file(&self) -> &Path {
        &self.0.file
    }

    /// The program as its author wrote it: instructions, comments, parameters.
    pub fn source(&self) -> &rungc_syntax::Program {
        &self.0.read.program
    }

    /// The settings that hold for it.
    pub fn settings(&self) -> Option<&Settings> {
        self.0.settings.as_ref()
    }

    /// The model that it is compiled for.
    pub fn model(&self) -> &'static Model {
        compile::model(&self.0.read.program, &self.options())
    }

    /// The PLC that it is compiled for.
    pub fn plc(&self) -> Plc {
        let model = self.model().id;
        let variant = self.0.plc.and_then(|plc| plc.variant);
        Plc { model, variant }
    }

    /// Devices by the comments of the program.
    pub fn names(&self) -> Names {
        Names::of(&self.0.read.program)
    }

    /// Options for compiling.
    pub(crate) fn options(&self) -> CompileOptions {
        let Opened {
            file,
            settings,
            plc,
            ..
        } = &*self.0;
        let stem = file.file_stem();
        CompileOptions {
            name: stem.map(|stem| stem.to_string_lossy().into_owned()),
            ..settings::compiling(settings.as_ref(), file, *plc, &[])
        }
    }

    /// Finds all that is wrong with the program, as `rungc check` does.
    pub fn check(&self) -> Checked {
        let Opened {
            file, read, levels, ..
        } = &*self.0;
        let options = self.options();
        let compiled = compile::check(&read.program, &options);
        let mut diagnostics = read.diagnostics.clone();
        diagnostics.refine(&other_model::joined(&options, read, &compiled));
        let found = levels.apply(diagnostics).into_iter();
        let (program, numbers) = (Some(&read.program), &compiled.step_numbers);
        Checked {
            project: self.clone(),
            diagnostics: found
                .map(|finding| Diagnostic::new(file, program, numbers, &finding))
                .collect(),
            model: compiled.model,
            steps: compiled.steps,
        }
    }

    /// Its ladder as text, with lines of at most `width` characters, as `rungc view` draws it.
    pub fn ladder(&self, width: usize) -> String {
        let (resolved, _) = resolve(&self.0.read.program, self.model());
        let style = text::Style {
            width,
            comments: true,
        };
        let ladder = build::ladder(&resolved);
        let networks: Vec<_> = (1..).zip(&ladder.networks).collect();
        text::draw(&resolved, &networks, style)
    }

    /// Its ladder as a picture in SVG.
    pub fn svg(&self) -> String {
        /// Characters on a line of the picture.
        const WIDTH: usize = 104;
        let (resolved, _) = resolve(&self.0.read.program, self.model());
        let ladder = build::ladder(&resolved);
        let networks: Vec<_> = (1..).zip(&ladder.networks).collect();
        let painter = Painter::new(&resolved, &networks, WIDTH);
        painter.sheet(&networks).to_string()
    }
}

impl Checked {
    /// Returns true if there is an error, so that the program cannot be compiled.
    pub fn has_errors(&self) -> bool {
        self.errors().next().is_some()
    }

    /// The errors among them.
    pub(crate) fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        let all = self.diagnostics.iter();
        all.filter(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Compiles the program.
    ///
    /// # Errors
    /// Its errors, if it has any.
    pub fn compile(&self) -> Result<Program, Error> {
        let errors: Vec<_> = self.errors().cloned().collect();
        match Program::new(&self.project) {
            Some(program) if errors.is_empty() => Ok(program),
            _ => Err(Error::Rejected(errors)),
        }
    }
}
