//! Mistakes in test files, for tools. People read them on standard error.

use super::super::{Context, put};
use super::report::to_document;
use crate::args::{TestArgs, TestFormat};
use crate::commands::Failure;
use crate::output;
use crate::report::junit::{self, Case, Problem, Properties, Suite, render};
use crate::report::{github, sarif};
use rungc::location::{Location, as_named, named};
use rungc_sim::LoadError;
use rungc_syntax::diag::counted;
use serde::Serialize;
use serde_json::json;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

/// The kind of problem, as failed cases have kinds.
const KIND: &str = "test-file";

/// A mistake, or a file that cannot be read.
#[derive(Serialize)]
pub struct Mistake {
    #[serde(serialize_with = "as_named")]
    file: PathBuf,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<u32>,
    message: String,
}

/// Prints or writes mistakes in the format of the results that there are none of.
pub fn publish(args: &TestArgs, errors: &[LoadError], cx: Context) -> Result<(), Failure> {
    let mistakes: Vec<_> = errors.iter().flat_map(mistakes).collect();
    let text = match args.format {
        _ if args.coverage.is_some() || args.mutants => return Ok(()),
        TestFormat::Human => return Ok(()),
        TestFormat::Junit => to_junit(&mistakes)?,
        TestFormat::Json => to_document(mistakes.as_slice())?,
        TestFormat::Sarif => sarif(&mistakes)?,
        TestFormat::Github => mistakes.iter().map(annotation).collect(),
    };
    let summary = counted(mistakes.len(), "mistake");
    put(
        (output::file(&args.output), args.force),
        &text,
        &summary,
        cx,
    )
}

fn mistakes(error: &LoadError) -> Vec<Mistake> {
    match error {
        LoadError::Io { path, error } => vec![Mistake {
            file: path.clone(),
            line: None,
            column: None,
            message: error.to_string(),
        }],
        LoadError::Format { file, problems, .. } => problems
            .iter()
            .map(|problem| Mistake {
                file: PathBuf::from(&file.name),
                line: Some(problem.line),
                column: Some(problem.column),
                message: problem.to_string(),
            })
            .collect(),
    }
}

/// A suite for each file, a case for each mistake.
fn to_junit(mistakes: &[Mistake]) -> io::Result<String> {
    let of_one_file = mistakes.chunk_by(|a, b| a.file == b.file);
    let suites: Vec<_> = of_one_file
        .map(|mistakes| Suite {
            name: named(&mistakes[0].file),
            properties: Properties::new(),
            cases: mistakes.iter().map(case).collect(),
        })
        .collect();
    render("rungc test", &suites)
}

fn case(mistake: &Mistake) -> Case {
    let class = named(&mistake.file);
    let place = mistake
        .line
        .map_or(class.clone(), |line| format!("{class}:{line}"));
    Case {
        name: place.clone(),
        class,
        time: Duration::ZERO,
        properties: Properties::new(),
        problem: Some(Problem {
            result: junit::Result::Error,
            kind: KIND,
            message: mistake.message.clone(),
            text: format!("{place}: {}", mistake.message),
        }),
    }
}

fn sarif(mistakes: &[Mistake]) -> io::Result<String> {
    let rule = json!({
        "id": KIND,
        "shortDescription": { "text": "A test file cannot be read, or contains a mistake." },
    });
    let items = mistakes.iter().map(|mistake| {
        let mut place = json!({ "artifactLocation": { "uri": sarif::uri(&mistake.file) } });
        if let Some(line) = mistake.line {
            place["region"] = json!({ "startLine": line, "startColumn": mistake.column });
        }
        json!({
            "ruleId": KIND,
            "level": "error",
            "message": { "text": mistake.message },
            "locations": [{ "physicalLocation": place }],
        })
    });
    sarif::log(vec![rule], items.collect(), Vec::new(), None)
}

fn annotation(mistake: &Mistake) -> String {
    let place = Location {
        line: mistake.line,
        column: mistake.column,
        ..Location::default()
    };
    let title = "mistake in a test file";
    github::annotation("error", &mistake.file, &place, title, &mistake.message)
}
