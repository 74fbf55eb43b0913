//! Answers about properties, and about programs that do the same.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rungc::prove::{Answers, Change, Question, Reading, Setting, Verdict};
use std::collections::BTreeMap;
use std::time::Duration;

/// A question of the keywords of Python.
pub(crate) fn question(
    properties: Vec<String>,
    (assume, free): (Vec<String>, Vec<String>),
    (scan_ms, cleared, effort): (Option<u32>, bool, Option<u64>),
) -> Question {
    Question {
        properties,
        assume,
        free,
        scan: scan_ms.map(|ms| Duration::from_millis(ms.into())),
        cleared,
        effort,
        time: None,
    }
}

/// Answer about a property.
#[pyclass(module = "rungc", frozen)]
pub(crate) struct Answer {
    answer: rungc::prove::Answer,
    assumptions: Vec<String>,
}

impl Answer {
    /// The answers, each with the assumptions of all.
    pub(crate) fn all(answers: Answers) -> Vec<Self> {
        let assumptions = answers.assumptions;
        let answers = answers.answers.into_iter();
        let with = |answer| Answer {
            answer,
            assumptions: assumptions.clone(),
        };
        answers.map(with).collect()
    }
}

#[pymethods]
impl Answer {
    #[getter]
    fn text(&self) -> &str {
        &self.answer.property
    }

    #[getter]
    fn verdict(&self) -> &str {
        self.answer.word
    }

    #[getter]
    fn assumptions(&self) -> Vec<String> {
        self.assumptions.clone()
    }

    #[getter]
    fn run<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.answer
            .run
            .iter()
            .map(|change| part(py, change))
            .collect()
    }

    fn __bool__(&self) -> bool {
        self.answer.verdict.is_good()
    }

    fn __str__(&self) -> String {
        let rungc::prove::Answer {
            property,
            word,
            grounds,
            ..
        } = &self.answer;
        format!("{word}: {property}\n{grounds}")
            .trim_end()
            .to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Answer {}: {}>", self.answer.word, self.answer.property)
    }
}

/// Equal scans of a run.
fn part<'py>(py: Python<'py>, change: &Change) -> PyResult<Bound<'py, PyDict>> {
    let values = |settings: &[Setting]| -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        for (name, _, reading) in settings {
            match reading {
                Reading::Integer(value) => values.set_item(name, value)?,
                Reading::Float(value) => values.set_item(name, value)?,
            }
        }
        Ok(values)
    };
    let part = PyDict::new(py);
    part.set_item("ms", change.at_ms)?;
    part.set_item("scans", change.scans)?;
    part.set_item("scan_ms", change.scan_ms)?;
    part.set_item("power_on", values(&change.start)?)?;
    part.set_item("stop", change.restart)?;
    part.set_item("set", values(&change.set)?)?;
    part.set_item("after", values(&change.after)?)?;
    Ok(part)
}

/// An output, beside that of an older program.
#[pyclass(module = "rungc", frozen)]
pub(crate) struct Output(rungc::prove::Output);

impl Output {
    /// Outputs by name.
    pub(crate) fn by_name(outputs: Vec<rungc::prove::Output>) -> BTreeMap<String, Self> {
        let outputs = outputs.into_iter();
        outputs
            .map(|output| (output.name.clone(), Output(output)))
            .collect()
    }
}

#[pymethods]
impl Output {
    #[getter]
    fn verdict(&self) -> &str {
        match self.0.verdict {
            Verdict::Proved => "same",
            Verdict::Violated => "differs",
            Verdict::Vacuous => "vacuous",
            Verdict::Undecided | Verdict::Reached | Verdict::NotReachable => "not decided",
        }
    }

    #[getter]
    fn reason(&self) -> &str {
        &self.0.grounds
    }

    fn __bool__(&self) -> bool {
        self.0.verdict.is_good()
    }

    fn __repr__(&self) -> String {
        format!("<Output {}: {}>", self.0.name, self.verdict())
    }
}
