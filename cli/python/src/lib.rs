//! The module `rungc` of Python, on the library of that name. Start reading at [`Project`] and [`Plc`].
#![deny(missing_docs)]

mod errors;
mod plc;
mod prove;

use errors::{DeviceError, Rejected, RungcError, raised};
use plc::{Plc, Snapshot};
use prove::{Answer, Output};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A finding of a check.
#[pyclass(module = "rungc", frozen, name = "Diagnostic")]
pub(crate) struct Diagnostic(rungc::Diagnostic);

#[pymethods]
impl Diagnostic {
    #[getter]
    fn code(&self) -> &str {
        self.0.code
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name
    }

    #[getter]
    fn severity(&self) -> &str {
        self.0.severity.name()
    }

    #[getter]
    fn message(&self) -> &str {
        &self.0.message
    }

    #[getter]
    fn help(&self) -> Option<&str> {
        self.0.help.as_deref()
    }

    #[getter]
    fn file(&self) -> &str {
        &self.0.file
    }

    #[getter]
    fn line(&self) -> Option<u32> {
        self.0.location.as_ref()?.line
    }

    #[getter]
    fn column(&self) -> Option<u32> {
        self.0.location.as_ref()?.column
    }

    #[getter]
    fn step(&self) -> Option<u32> {
        self.0.location.as_ref()?.step
    }

    #[getter]
    fn devices(&self) -> Vec<String> {
        self.0.devices.clone()
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Diagnostic {}>", self.0.to_string().replace('\n', " "))
    }
}

/// A program as its author wrote it, with its settings.
#[pyclass(module = "rungc", frozen)]
struct Project(rungc::Project);

#[pymethods]
impl Project {
    #[getter]
    fn file(&self) -> String {
        rungc::location::named(self.0.file())
    }

    #[getter]
    fn model(&self) -> &str {
        self.0.model().name
    }

    #[getter]
    fn comments(&self) -> BTreeMap<String, String> {
        let comments = self.0.source().comments.iter();
        comments
            .map(|(device, comment)| (device.to_string(), comment.clone()))
            .collect()
    }

    fn check(&self, py: Python<'_>) -> Vec<Diagnostic> {
        let checked = py.detach(|| self.0.check());
        checked.diagnostics.into_iter().map(Diagnostic).collect()
    }

    fn compile(&self, py: Python<'_>) -> PyResult<Program> {
        let compiled = py.detach(|| self.0.check().compile());
        compiled.map(Program).map_err(raised)
    }

    fn start(&self, py: Python<'_>) -> PyResult<Plc> {
        let compiled = py.detach(|| self.0.check().compile());
        Ok(Plc::new(compiled.map_err(raised)?))
    }

    #[pyo3(
        signature = (*properties, assume = vec![], free = vec![], scan_ms = None, cleared = false, effort = None),
        text_signature = "($self, *properties, assume=(), free=(), scan_ms=None, cleared=False, effort=None)"
    )]
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of Python, each with a default"
    )]
    fn prove(
        &self,
        py: Python<'_>,
        properties: Vec<String>,
        assume: Vec<String>,
        free: Vec<String>,
        scan_ms: Option<u32>,
        cleared: bool,
        effort: Option<u64>,
    ) -> PyResult<Vec<Answer>> {
        let question = prove::question(properties, (assume, free), (scan_ms, cleared, effort));
        let answers = py.detach(|| self.0.prove(&question));
        answers.map(Answer::all).map_err(raised)
    }

    #[pyo3(
        signature = (older, *, assume = vec![], free = vec![], scan_ms = None, cleared = false, effort = None),
        text_signature = "($self, older, *, assume=(), free=(), scan_ms=None, cleared=False, effort=None)"
    )]
    #[expect(
        clippy::too_many_arguments,
        reason = "keywords of Python, each with a default"
    )]
    fn same_as(
        &self,
        py: Python<'_>,
        older: &Project,
        assume: Vec<String>,
        free: Vec<String>,
        scan_ms: Option<u32>,
        cleared: bool,
        effort: Option<u64>,
    ) -> PyResult<BTreeMap<String, Output>> {
        let question = prove::question(Vec::new(), (assume, free), (scan_ms, cleared, effort));
        let outputs = py.detach(|| self.0.same_as(&older.0, &question));
        outputs.map(Output::by_name).map_err(raised)
    }

    fn why(&self, py: Python<'_>, device: &str) -> PyResult<String> {
        let compiled = py.detach(|| self.0.check().compile()).map_err(raised)?;
        compiled
            .why(device)
            .map(|why| why.to_string())
            .map_err(raised)
    }

    #[pyo3(signature = (width = 100))]
    fn ladder(&self, width: usize) -> String {
        self.0.ladder(width)
    }

    fn svg(&self) -> String {
        self.0.svg()
    }

    fn _repr_svg_(&self) -> String {
        self.0.svg()
    }

    fn __repr__(&self) -> String {
        format!("<Project {} ({})>", self.file(), self.model())
    }
}

/// A compiled program.
#[pyclass(module = "rungc", frozen)]
struct Program(rungc::Program);

#[pymethods]
impl Program {
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    fn emit_c(&self) -> BTreeMap<String, String> {
        by_path(self.0.emit_c())
    }

    fn emit_rust(&self) -> BTreeMap<String, String> {
        by_path(self.0.emit_rust())
    }

    fn start(&self) -> Plc {
        Plc::new(self.0.clone())
    }
}

fn by_path(files: Vec<rungc::OutFile>) -> BTreeMap<String, String> {
    let files = files.into_iter();
    files.map(|file| (file.path, file.contents)).collect()
}

/// Codes as the library has them; an error names one that does not exist.
fn codes(given: Vec<String>) -> PyResult<Vec<&'static str>> {
    let known = |code: &String| {
        rungc::code(code).ok_or_else(|| RungcError::new_err(format!("there is no code `{code}`")))
    };
    given.iter().map(known).collect()
}

#[pyfunction]
#[pyo3(
    signature = (path, *, model = None, settings = None, allow = vec![], deny = vec![], deny_warnings = false),
    text_signature = "(path, *, model=None, settings=None, allow=(), deny=(), deny_warnings=False)"
)]
fn open(
    py: Python<'_>,
    path: PathBuf,
    model: Option<String>,
    settings: Option<PathBuf>,
    allow: Vec<String>,
    deny: Vec<String>,
    deny_warnings: bool,
) -> PyResult<Project> {
    let options = rungc::Options {
        model,
        settings,
        allow: codes(allow)?,
        deny: codes(deny)?,
        deny_warnings,
        ..rungc::Options::default()
    };
    let opened = py.detach(|| rungc::Project::open_with(path, &options));
    opened.map(Project).map_err(raised)
}

#[pyfunction]
#[pyo3(signature = (list, *, name = "program.il", model = None))]
fn from_list(list: &str, name: &str, model: Option<String>) -> PyResult<Project> {
    let options = rungc::Options {
        model,
        ..rungc::Options::default()
    };
    let read = rungc::Project::from_list(name, list, &options);
    read.map(Project).map_err(raised)
}

#[pymodule]
fn _rungc(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("Error", py.get_type::<RungcError>())?;
    module.add("Rejected", py.get_type::<Rejected>())?;
    module.add("DeviceError", py.get_type::<DeviceError>())?;
    module.add_class::<Diagnostic>()?;
    module.add_class::<Project>()?;
    module.add_class::<Program>()?;
    module.add_class::<Plc>()?;
    module.add_class::<Answer>()?;
    module.add_class::<Output>()?;
    module.add_class::<Snapshot>()?;
    module.add_function(wrap_pyfunction!(open, module)?)?;
    module.add_function(wrap_pyfunction!(from_list, module)?)
}
