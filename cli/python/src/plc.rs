//! A PLC that runs.

use crate::errors::raised;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rungc::Value;
use self_cell::self_cell;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

type Borrowed<'p> = rungc::Plc<'p>;

self_cell!(
    struct Running {
        owner: rungc::Program,
        #[not_covariant]
        dependent: Borrowed,
    }
);

/// A PLC that runs in virtual time.
#[pyclass(module = "rungc", frozen)]
pub(crate) struct Plc(Mutex<Running>);

/// A moment of a PLC.
#[pyclass(module = "rungc", frozen)]
pub(crate) struct Snapshot(Mutex<rungc::Snapshot>);

fn python(py: Python<'_>, value: Value) -> PyResult<Py<PyAny>> {
    Ok(match value {
        Value::Bit(on) => on.into_pyobject(py)?.to_owned().into_any().unbind(),
        Value::Int(value) => value.into_pyobject(py)?.into_any().unbind(),
        Value::Float(value) => value.into_pyobject(py)?.into_any().unbind(),
        Value::Text(text) => text.into_pyobject(py)?.into_any().unbind(),
    })
}

/// A value that a device can be set to.
#[derive(FromPyObject)]
enum Given {
    #[pyo3(transparent)]
    Bit(bool),
    #[pyo3(transparent)]
    Int(i64),
    #[pyo3(transparent)]
    Float(f64),
}

impl From<Given> for Value {
    fn from(given: Given) -> Self {
        match given {
            Given::Bit(on) => Value::Bit(on),
            Given::Int(value) => Value::Int(value),
            Given::Float(value) => Value::Float(value),
        }
    }
}

impl Plc {
    /// Powers on a PLC with this program.
    pub(crate) fn new(program: rungc::Program) -> Self {
        Plc(Mutex::new(Running::new(program, rungc::Program::start)))
    }

    fn running(&self) -> MutexGuard<'_, Running> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Does something with the PLC while other threads of Python run.
    fn with<T: Send>(&self, py: Python<'_>, act: impl FnOnce(&mut Borrowed<'_>) -> T + Send) -> T {
        py.detach(|| self.running().with_dependent_mut(|_, plc| act(plc)))
    }
}

#[pymethods]
impl Plc {
    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<Py<PyAny>> {
        let value = self.with(py, |plc| plc.get(name)).map_err(raised)?;
        python(py, value)
    }

    fn __setitem__(&self, py: Python<'_>, name: &str, value: Given) -> PyResult<()> {
        let value = Value::from(value);
        self.with(py, |plc| plc.set(name, value)).map_err(raised)
    }

    #[pyo3(signature = (*, ms))]
    fn run(&self, py: Python<'_>, ms: u64) {
        self.with(py, |plc| plc.run_for(Duration::from_millis(ms)));
    }

    #[pyo3(signature = (count = 1))]
    fn scan(&self, py: Python<'_>, count: u64) {
        self.with(py, |plc| (0..count).for_each(|_| plc.scan()));
    }

    #[pyo3(signature = (names, *, ms, every = 0))]
    fn trace<'py>(
        &self,
        py: Python<'py>,
        names: Vec<String>,
        ms: u64,
        every: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        if names.iter().any(|name| name == "ms") {
            return Err(PyValueError::new_err("`ms` is the name of the times"));
        }
        let traced = self.with(py, |plc| traced(plc, &names, ms, every));
        let (times, columns) = traced.map_err(raised)?;
        let trace = PyDict::new(py);
        trace.set_item("ms", times)?;
        for (name, values) in names.iter().zip(columns) {
            let values = values.into_iter().map(|value| python(py, value));
            trace.set_item(name, values.collect::<PyResult<Vec<_>>>()?)?;
        }
        Ok(trace)
    }

    #[getter]
    fn now_ms(&self, py: Python<'_>) -> u64 {
        self.with(py, |plc| plc.now().as_millis() as u64)
    }

    #[getter(running)]
    fn is_running(&self, py: Python<'_>) -> bool {
        self.with(py, |plc| plc.is_running())
    }

    #[setter(running)]
    fn set_running(&self, py: Python<'_>, running: bool) {
        self.with(py, |plc| plc.set_running(running));
    }

    fn power_cycle(&self, py: Python<'_>) {
        self.with(py, |plc| plc.power_cycle());
    }

    fn force(&self, py: Python<'_>, name: &str, value: Given) -> PyResult<()> {
        let value = Value::from(value);
        self.with(py, |plc| plc.force(name, value)).map_err(raised)
    }

    fn release(&self, py: Python<'_>, name: &str) -> PyResult<()> {
        self.with(py, |plc| plc.release(name)).map_err(raised)
    }

    fn why(&self, py: Python<'_>, device: &str) -> PyResult<String> {
        let why = self.with(py, |plc| plc.why(device));
        why.map(|why| why.to_string()).map_err(raised)
    }

    fn errors(&self, py: Python<'_>) -> Vec<BTreeMap<&'static str, u64>> {
        self.with(py, |plc| {
            let errors = plc.errors().iter();
            errors
                .map(|error| {
                    BTreeMap::from([
                        ("code", error.code.into()),
                        ("step", error.step.into()),
                        ("first_ms", error.first_ms.into()),
                        ("times", error.times),
                    ])
                })
                .collect()
        })
    }

    fn save(&self, py: Python<'_>) -> Snapshot {
        Snapshot(Mutex::new(self.with(py, |plc| plc.save())))
    }

    fn restore(&self, py: Python<'_>, snapshot: &Snapshot) -> PyResult<()> {
        let moment = snapshot
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        self.with(py, |plc| plc.restore(&moment)).map_err(raised)
    }
}

/// Runs, and records values at each scan, or at this interval in milliseconds.
fn traced(
    plc: &mut Borrowed<'_>,
    names: &[String],
    ms: u64,
    every: u64,
) -> Result<(Vec<u64>, Vec<Vec<Value>>), rungc::Error> {
    let now = |plc: &Borrowed<'_>| plc.now().as_millis() as u64;
    let end_ms = now(plc) + ms;
    let mut times = Vec::new();
    let mut columns = vec![Vec::new(); names.len()];
    loop {
        times.push(now(plc));
        for (name, values) in names.iter().zip(&mut columns) {
            values.push(plc.get(name)?);
        }
        let left_ms = end_ms - now(plc);
        if left_ms == 0 {
            return Ok((times, columns));
        }
        let step_ms = match every {
            0 => plc.until_next_scan().as_millis() as u64,
            every => every,
        };
        plc.run_for(Duration::from_millis(step_ms.clamp(1, left_ms)));
    }
}
