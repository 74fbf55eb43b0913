//! PLCs on one line that run on different engines: emitted C talks to emitted Rust, and each of them to the
//! interpreter.

use rungc_sim::engines::{Engine, EngineError, EngineKind, build};
use rungc_sim::plctest::{self, Suite};
use rungc_sim::protocol::{Answer, Request};
use std::ops::ControlFlow;
use std::path::Path;

/// Several engines, each of which runs one PLC of a case.
struct Mixed<'m> {
    engines: Vec<Box<dyn Engine + 'm>>,
    /// Index of the engine for the first PLC, and for the others.
    order: [usize; 3],
    /// Number of PLCs in the case so far.
    joined: usize,
    /// Index of the selected one.
    current: usize,
}

impl<'m> Mixed<'m> {
    /// The engine of a PLC.
    fn engine(&mut self, plc: usize) -> &mut (dyn Engine + 'm) {
        &mut *self.engines[self.order[plc]]
    }
}

impl Engine for Mixed<'_> {
    fn name(&self) -> &str {
        "mixed"
    }

    fn execute(&mut self, request: Request) -> Result<Answer, EngineError> {
        match request {
            Request::Case(program) => {
                (self.joined, self.current) = (1, 0);
                self.engine(0).execute(Request::Case(program))
            }
            // It is the first PLC of its engine.
            Request::Join(program) => {
                let plc = self.joined;
                self.joined += 1;
                self.engine(plc).execute(Request::Case(program))
            }
            Request::Plc(number) => {
                self.current = number;
                Ok(Answer::Ok)
            }
            request => self.engine(self.current).execute(request),
        }
    }
}

#[test]
fn engines_understand_each_other() {
    let path =
        Path::new(env!("RUNGC_ROOT")).join("golden/conformance/h1u-h2u/own-wire.plctest.toml");
    let file = plctest::load(&path).unwrap_or_else(|error| panic!("{error}"));
    let suite = Suite::compile(vec![file], &[]);
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("wires");
    let [interp, c, rust] = [EngineKind::Interp, EngineKind::C, EngineKind::Rust];
    let kinds = [interp, c, rust];
    let engines = kinds.map(|kind| {
        build(kind, suite.modules(), &target).unwrap_or_else(|error| panic!("{error}"))
    });
    let mut mixed = Mixed {
        engines: engines.into(),
        order: [0; 3],
        joined: 0,
        current: 0,
    };
    for order in [[1, 2, 0], [2, 1, 0], [0, 1, 2], [2, 0, 1]] {
        mixed.order = order;
        let report = plctest::run(&suite, &mut mixed, &mut |_| ControlFlow::Continue(()));
        let failures: Vec<_> = report
            .failures()
            .map(|failure| failure.describe(&suite))
            .collect();
        let names = order.map(|engine| kinds[engine].name());
        assert!(failures.is_empty(), "{names:?}: {}", failures.join("\n"));
        assert_eq!(report.outcomes.len(), suite.len());
    }
}
