//! Every conformance case on microcontrollers that QEMU simulates, with the same results as on the host, to the last
//! bit. Where the environment names the run ([`rungc_golden::part`]), an eighth of them.
//!
//! Without the tools a test reports what is missing and that it did not run; with `RUNGC_REQUIRE_EMBEDDED` set, as in
//! CI, that is a failure.

use crate::suite::Conformance;
use rungc_golden::part::Part;
use rungc_ir::Module;
use rungc_sim::engines::cortex_m::{Board, CORTEX_M3, CORTEX_M4, build_for, missing};
use rungc_sim::engines::{Engine, EngineError, EngineKind, Interpreter};
use rungc_sim::protocol::{Answer, Request};
use std::path::Path;

/// An engine that is held to the interpreter.
struct Compared<'m> {
    engine: Box<dyn Engine + 'm>,
    interpreter: Interpreter<'m>,
    modules: &'m [Module],
    /// The program that runs.
    running: &'m str,
    /// Answers in which the engine differs.
    different: Vec<String>,
}

impl<'m> Compared<'m> {
    fn new(engine: Box<dyn Engine + 'm>, modules: &'m [Module]) -> Self {
        Compared {
            engine,
            interpreter: Interpreter::new(modules),
            modules,
            running: "",
            different: Vec::new(),
        }
    }

    fn compare(&mut self, request: Request, answer: Answer, expected: Answer) {
        if answer != expected {
            self.different.push(format!(
                "{}: {}: `{request}`: {answer:?}, not {expected:?}",
                self.engine.name(),
                self.running
            ));
        }
    }
}

impl Engine for Compared<'_> {
    fn name(&self) -> &str {
        self.engine.name()
    }

    fn execute(&mut self, request: Request) -> Result<Answer, EngineError> {
        if let Request::Case(number) = request {
            self.running = &self.modules[number].name;
        }
        let expected = self.interpreter.execute(request)?;
        let answer = self.engine.execute(request)?;
        if matches!(expected, Answer::Value(_)) {
            self.compare(request, answer, expected);
        }
        Ok(answer)
    }

    // Each answer by itself would have QEMU wait for the next request.
    fn execute_all(&mut self, requests: &[Request]) -> Result<Vec<Answer>, EngineError> {
        let expected = self.interpreter.execute_all(requests)?;
        let answers = self.engine.execute_all(requests)?;
        assert_eq!(answers.len(), requests.len());
        for ((&request, &answer), expected) in requests.iter().zip(&answers).zip(expected) {
            self.compare(request, answer, expected);
        }
        Ok(answers)
    }
}

/// Cases whose programs an image has room for in Rust, which is not optimised: about 4 KB each of the 16 MB that a
/// board has for code. In C all fit.
const IN_RUST: usize = 2_000;

/// Runs all cases on a board, one image after another.
fn run(board: &Board, kind: EngineKind) {
    let missing = missing(board);
    if !missing.is_empty() {
        let required = std::env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
        assert!(!required, "missing: {}", missing.join(", "));
        eprintln!("not run: there is no {}", missing.join(", "));
        return;
    }
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("conformance");
    let most = match kind {
        EngineKind::Rust => IN_RUST,
        EngineKind::Interp | EngineKind::C => usize::MAX,
    };
    let mut wrong = Vec::new();
    for batch in Conformance::load(&Part::one_in(8), most) {
        let engine = build_for(board, kind, batch.modules(), &target);
        let engine = engine.unwrap_or_else(|error| panic!("{error}"));
        let mut engine = Compared::new(engine, batch.modules());
        wrong.append(&mut batch.run(&mut engine));
        wrong.append(&mut engine.different);
    }
    assert!(
        wrong.is_empty(),
        "{} differences:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

// Tests start in the order of their names: the one that takes longest, and for the most part one core, is the first.

#[test]
fn built_by_cargo_on_cortex_m4() {
    run(&CORTEX_M4, EngineKind::Rust);
}

#[test]
fn built_by_make_on_cortex_m3() {
    run(&CORTEX_M3, EngineKind::C);
}

#[test]
fn built_by_make_on_cortex_m4() {
    run(&CORTEX_M4, EngineKind::C);
}
