//! A module made by hand, and what builds emitted crates.

use rungc_codegen_rust::{Options, OutFile, Runtime};
use rungc_ir::layout::Area;
use rungc_ir::node::*;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{CmpOp, EdgeKind, TimerKind};
use rungc_runtime_sources::cache::{self, Slot};
use rungc_runtime_sources::library;
use rungc_syntax::{DeviceClass, Span};
use std::path::Path;
use std::process::Command;

/// A module in the making.
pub struct Build {
    /// The compiled module.
    pub module: Module,
}

impl Build {
    /// An empty program for FX2N.
    pub fn new(name: &str) -> Self {
        let model = Model::get(ModelId::Fx2n);
        let module = Module {
            steps: 26,
            ..Module::empty(name.to_string(), "MAIN.csv".to_string(), model)
        };
        Build { module }
    }

    /// Stores devices.
    pub fn area(&mut self, class: DeviceClass, first: u32, count: u32, array: bool) -> &mut Self {
        let range = self.module.model.range(class, first);
        self.module.layout.areas.push(Area {
            class,
            first,
            count,
            array,
            latched: range.is_some_and(|range| range.latched),
        });
        self
    }

    /// Gives a device a comment.
    pub fn comment(&mut self, class: DeviceClass, number: u32, text: &str) -> &mut Self {
        self.module.comments.push((class, number, text.to_string()));
        self
    }

    /// A statement that begins a network.
    pub fn network(&mut self, step: u32, statement: Option<&str>) -> Stmt {
        self.module.networks.push(Network {
            step,
            span: Span::default(),
            statement: statement.map(str::to_string),
            note: None,
        });
        Stmt::Network(self.module.networks.len() as u32 - 1)
    }

    /// An expression.
    pub fn expr(&mut self, expr: Expr) -> ExprId {
        self.module.add(expr)
    }

    /// State of a bit.
    pub fn bit(&mut self, class: DeviceClass, number: u32) -> ExprId {
        self.expr(Expr::Read(Access::bit(place(class, number))))
    }

    /// Value of a word.
    pub fn word(&mut self, class: DeviceClass, number: u32) -> ExprId {
        self.expr(Expr::Read(Access::word(place(class, number))))
    }

    /// A new temporary.
    pub fn temp(&mut self, ty: Ty) -> TempId {
        self.module.temps.push(ty);
        TempId(self.module.temps.len() as u32 - 1)
    }

    /// A new edge memory.
    pub fn edge(&mut self) -> EdgeId {
        self.module.edges += 1;
        EdgeId(self.module.edges - 1)
    }

    /// The main program, and the module.
    pub fn main(mut self, body: Body) -> Module {
        self.module.functions[1].body = body;
        self.module
            .layout
            .areas
            .sort_by_key(|area| (area.class, area.first));
        self.module
    }
}

/// A device without index.
pub fn place(class: DeviceClass, number: u32) -> Place {
    Place {
        class,
        number,
        index: None,
    }
}

/// The ordinary timer of 100 ms.
pub const TIMER: TimerKind = TimerKind {
    unit_ms: 100,
    accumulating: false,
    free_running: false,
    latches_preset: false,
    overruns: false,
    stepwise: false,
    shared: false,
};

/// The program of the design's target picture.
pub fn motor() -> Module {
    use DeviceClass::*;
    let mut b = Build::new("motor");
    b.area(X, 0, 3, false)
        .area(Y, 0, 2, false)
        .area(M, 0, 1, false)
        .area(T, 0, 1, false)
        .area(D, 0, 1, false)
        .comment(X, 0, "start button")
        .comment(X, 1, "stop button")
        .comment(M, 0, "motor latch")
        .comment(T, 0, "run-up time")
        .comment(Y, 0, "main contactor")
        .comment(Y, 1, "box full")
        .comment(D, 0, "parts counted");
    let [x0, x1, x2, m0, t0] = [(X, 0), (X, 1), (X, 2), (M, 0), (T, 0)].map(|(c, n)| b.bit(c, n));
    let either = b.expr(Expr::Or(x0, m0));
    let stop = b.expr(Expr::Not(x1));
    let latch = b.expr(Expr::And(either, stop));
    let preset = b.expr(Expr::I16(30));
    let both = b.expr(Expr::And(m0, t0));
    let edge = b.edge();
    let rising = b.temp(Ty::Bit);
    let is_rising = b.expr(Expr::Temp(rising));
    let d0 = b.word(D, 0);
    let one = b.expr(Expr::I16(1));
    let sum = b.expr(Expr::Bin(BinOp::Add, d0, one));
    let ten = b.expr(Expr::I16(10));
    let full = b.expr(Expr::Cmp(CmpOp::Ge, d0, ten));
    let on = b.expr(Expr::Bit(true));
    let body = vec![
        b.network(0, Some("start and stop")),
        Stmt::Do(Action::Write(Access::bit(place(M, 0)), latch)),
        b.network(4, None),
        Stmt::Do(Action::Timer(TimerCoil {
            number: 0,
            kind: TIMER,
            drive: m0,
            preset,
        })),
        Stmt::Do(Action::Write(Access::bit(place(Y, 0)), both)),
        b.network(10, None),
        Stmt::Do(Action::Edge(Edge {
            memory: edge,
            index: None,
            kind: EdgeKind::Rising,
            input: x2,
            out: rising,
        })),
        Stmt::If(Branch {
            cond: is_rising,
            then: vec![Stmt::Do(Action::Write(Access::word(place(D, 0)), sum))],
            otherwise: Vec::new(),
        }),
        b.network(19, None),
        Stmt::If(Branch {
            cond: full,
            then: vec![Stmt::Do(Action::Write(Access::bit(place(Y, 1)), on))],
            otherwise: Vec::new(),
        }),
    ];
    b.main(body)
}

/// Options of a crate with a main program.
pub fn options() -> Options {
    Options {
        main: true,
        runtime: runtime(),
        ..Options::default()
    }
}

/// A list compiled for H2U.
pub fn compiled(name: &str, text: &str) -> Module {
    let read = rungc_frontend::read_text("test.il", text);
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        name: Some(name.to_string()),
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let diagnostics = compiled.diagnostics;
    compiled
        .module
        .unwrap_or_else(|| panic!("{name}: {diagnostics:#?}"))
}

/// The runtime that all emitted crates share.
pub fn runtime() -> Runtime {
    let folder = library::unpacked(&cache::folder().unwrap()).unwrap();
    Runtime::At(folder.to_string_lossy().into_owned())
}

/// Writes emitted files.
pub fn write(folder: &Path, files: &[OutFile]) {
    for file in files {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.contents).unwrap();
    }
}

/// Runs cargo in an emitted crate with warnings forbidden, in a folder where the runtime is compiled once; that folder,
/// which is the crate's until it is dropped.
pub fn cargo(folder: &Path, arguments: &[&str]) -> Slot {
    let objects = Slot::wait(cache::folder().unwrap().join("linted")).unwrap();
    // Cargo takes crates with the same name for one, and compiles those again that are newer.
    let files = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    for package in files.chain([folder.to_owned()]) {
        let roots = ["src/lib.rs", "src/main.rs"].map(|root| package.join(root));
        let mut roots = roots.iter().filter(|root| root.exists());
        roots.try_for_each(|root| cache::touch(root)).unwrap();
    }
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .arg("--offline")
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", objects.path())
        .env("CARGO_INCREMENTAL", "0")
        .env("RUSTFLAGS", "-D warnings")
        .env("RUSTDOCFLAGS", "-D warnings")
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo {arguments:?}: {errors}");
    objects
}
