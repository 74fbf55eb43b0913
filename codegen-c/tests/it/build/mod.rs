//! Builds small modules by hand, and emitted C with the compilers that are there.

use rungc_codegen_c::{Options, batch, emit};
use rungc_ir::Module;
use rungc_ir::layout::Area;
use rungc_ir::node::*;
use rungc_models::{Model, ModelId};
use rungc_rt::{CmpOp, EdgeKind, TimerKind};
use rungc_syntax::{DeviceClass, Span};
use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

/// A module in the making.
pub struct Builder {
    module: Module,
    body: Body,
    used: BTreeSet<(DeviceClass, u32)>,
}

impl Builder {
    pub fn new(name: &str) -> Self {
        let model = Model::get(ModelId::Fx2n);
        Builder {
            module: Module {
                steps: 26,
                ..Module::empty(name.to_string(), format!("{name}.csv"), model)
            },
            body: Vec::new(),
            used: BTreeSet::new(),
        }
    }

    pub fn finish(mut self) -> Module {
        self.module.functions[1].body = self.body;
        let area = |&(class, first): &(DeviceClass, u32)| Area {
            class,
            first,
            count: 1,
            array: false,
            latched: false,
        };
        self.module.layout.areas = self.used.iter().map(area).collect();
        self.module
    }

    pub fn comment(&mut self, class: DeviceClass, number: u32, text: &str) {
        self.module.comments.push((class, number, text.to_string()));
    }

    pub fn network(&mut self, step: u32, statement: Option<&str>) {
        let statement = statement.map(str::to_string);
        self.module.networks.push(Network {
            step,
            span: Span::default(),
            statement,
            note: None,
        });
        self.body
            .push(Stmt::Network(self.module.networks.len() as u32 - 1));
    }

    fn place(&mut self, class: DeviceClass, number: u32) -> Place {
        self.used.insert((class, number));
        Place {
            class,
            number,
            index: None,
        }
    }

    pub fn bit(&mut self, class: DeviceClass, number: u32) -> ExprId {
        let place = self.place(class, number);
        self.module.add(Expr::Read(Access::bit(place)))
    }

    pub fn word(&mut self, class: DeviceClass, number: u32) -> ExprId {
        let place = self.place(class, number);
        self.module.add(Expr::Read(Access::word(place)))
    }

    pub fn i16(&mut self, value: i16) -> ExprId {
        self.module.add(Expr::I16(value))
    }

    pub fn on(&mut self) -> ExprId {
        self.module.add(Expr::Bit(true))
    }

    pub fn or(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.module.add(Expr::Or(a, b))
    }

    pub fn and(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.module.add(Expr::And(a, b))
    }

    pub fn not(&mut self, a: ExprId) -> ExprId {
        self.module.add(Expr::Not(a))
    }

    pub fn ge(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.module.add(Expr::Cmp(CmpOp::Ge, a, b))
    }

    pub fn add16(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.module.add(Expr::Bin(BinOp::Add, a, b))
    }

    pub fn write_bit(&mut self, class: DeviceClass, number: u32, value: ExprId) {
        let place = self.place(class, number);
        self.body
            .push(Stmt::Do(Action::Write(Access::bit(place), value)));
    }

    pub fn write_word(&mut self, class: DeviceClass, number: u32, value: ExprId) {
        let place = self.place(class, number);
        self.body
            .push(Stmt::Do(Action::Write(Access::word(place), value)));
    }

    pub fn timer(&mut self, number: u32, drive: ExprId, preset: ExprId) {
        self.place(DeviceClass::T, number);
        let kind = TimerKind {
            unit_ms: 100,
            accumulating: false,
            free_running: false,
            latches_preset: false,
            overruns: false,
            stepwise: false,
            shared: false,
        };
        self.body.push(Stmt::Do(Action::Timer(TimerCoil {
            number,
            kind,
            drive,
            preset,
        })));
    }

    pub fn when(&mut self, cond: ExprId, then: impl FnOnce(&mut Self)) {
        let outer = std::mem::take(&mut self.body);
        then(self);
        let then = std::mem::replace(&mut self.body, outer);
        self.body.push(Stmt::If(Branch {
            cond,
            then,
            otherwise: Vec::new(),
        }));
    }

    pub fn rising(&mut self, input: ExprId, then: impl FnOnce(&mut Self)) {
        let (edge, out) = (
            EdgeId(self.module.edges),
            TempId(self.module.temps.len() as u32),
        );
        self.module.edges += 1;
        self.module.temps.push(Ty::Bit);
        self.body.push(Stmt::Do(Action::Edge(Edge {
            memory: edge,
            index: None,
            kind: EdgeKind::Rising,
            input,
            out,
        })));
        let cond = self.module.add(Expr::Temp(out));
        self.when(cond, then);
    }
}

pub const STRICT: [&str; 6] = [
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Werror",
    "-pedantic",
];

/// The C compilers that are installed; at least one must be.
pub fn compilers() -> Vec<&'static str> {
    let there = |cc: &&str| {
        Command::new(cc)
            .arg("--version")
            .output()
            .is_ok_and(|o| o.status.success())
    };
    let found: Vec<_> = ["gcc", "clang"].into_iter().filter(there).collect();
    assert!(
        !found.is_empty(),
        "emitted C cannot be tested without gcc or clang"
    );
    found
}

/// Emits a module with a `main` around these statements, compiles it strictly with each compiler, runs it, and returns
/// what it prints.
pub fn run_c(module: &Module, statements: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder for the C files");
    let mut sources = Vec::new();
    for file in emit(module, &Options::default()) {
        std::fs::write(folder.path().join(&file.path), &file.contents).expect("writing C");
        if file.path.ends_with(".c") {
            sources.push(file.path);
        }
    }
    let main = format!(
        "#include \"{}.h\"\n#include <stdio.h>\nint main(void)\n{{\n{statements}\n    return 0;\n}}\n",
        module.name
    );
    std::fs::write(folder.path().join("test_main.c"), main).expect("writing C");
    sources.push("test_main.c".to_string());
    let outputs = compilers()
        .into_iter()
        .map(|cc| compile_and_run(cc, folder.path(), &sources));
    let outputs: Vec<String> = outputs.collect();
    assert!(
        outputs.windows(2).all(|pair| pair[0] == pair[1]),
        "compilers disagree: {outputs:?}"
    );
    outputs[0].clone()
}

/// Compiles strictly and optimised, and again with checks for undefined behaviour; both must print the same.
fn compile_and_run(cc: &str, folder: &Path, sources: &[String]) -> String {
    let strict: Vec<&str> = STRICT.into_iter().chain(["-O2"]).collect();
    let checked = [
        "-std=c99",
        "-O1",
        "-fsanitize=undefined",
        "-fno-sanitize-recover",
    ];
    let outputs = [strict.as_slice(), checked.as_slice()].map(|flags| {
        let compiled = Command::new(cc)
            .current_dir(folder)
            .args(flags)
            .args(["-o", "program"])
            .args(sources)
            .output()
            .expect("running the compiler");
        let errors = String::from_utf8_lossy(&compiled.stderr).into_owned();
        assert!(
            compiled.status.success() && errors.is_empty(),
            "{cc} {flags:?}: {errors}"
        );
        let ran = Command::new(folder.join("program"))
            .output()
            .expect("running the program");
        assert!(
            ran.status.success(),
            "{}",
            String::from_utf8_lossy(&ran.stderr)
        );
        String::from_utf8_lossy(&ran.stdout).into_owned()
    });
    assert_eq!(
        outputs[0], outputs[1],
        "{cc}: checks for undefined behaviour change the result"
    );
    outputs[0].clone()
}

/// Builds a batch with `make`, sends it these requests, and returns the answers.
pub fn run_batch(modules: &[Module], requests: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder for the C files");
    for file in batch(modules) {
        let path = folder.path().join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a file stands in a folder"))
            .expect("making a folder");
        std::fs::write(path, &file.contents).expect("writing C");
    }
    let strict = format!("CFLAGS={} -O1", STRICT.join(" "));
    let made = Command::new("make")
        .current_dir(folder.path())
        .arg(strict)
        .output()
        .expect("running make");
    assert!(
        made.status.success(),
        "{}",
        String::from_utf8_lossy(&made.stderr)
    );
    let mut child = Command::new(folder.path().join("batch"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("starting the batch");
    let mut stdin = child.stdin.take().expect("its standard input");
    stdin
        .write_all(requests.as_bytes())
        .expect("sending requests");
    drop(stdin);
    let output = child.wait_with_output().expect("its answers");
    assert!(output.status.success());
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The C source of a program up to the functions that every program has.
pub fn program_text(module: &Module) -> String {
    let files = emit(module, &Options::default());
    let path = format!("{}.c", module.name);
    let source = &files
        .iter()
        .find(|f| f.path == path)
        .expect("a source file")
        .contents;
    let end = source
        .find("/* Clears all devices")
        .or_else(|| source.find(&format!("void {}_init(", module.name)));
    source[..end.expect("the functions of every program")].to_string()
}

/// Builds a program with its host's `main.c`, types these commands, and waits until it has printed these texts.
pub fn run_host(module: &Module, commands: &str, expected: &[&str]) {
    let folder = tempfile::tempdir().expect("a folder for the C files");
    for file in emit(
        module,
        &Options {
            main: true,
            ..Options::default()
        },
    ) {
        std::fs::write(folder.path().join(&file.path), &file.contents).expect("writing C");
    }
    for cc in compilers() {
        let flags = format!("CFLAGS={} -O2", STRICT.join(" "));
        let made = Command::new("make")
            .current_dir(folder.path())
            .args(["-B", &flags, &format!("CC={cc}")])
            .output();
        let made = made.expect("running make");
        assert!(
            made.status.success(),
            "{cc}: {}",
            String::from_utf8_lossy(&made.stderr)
        );
    }
    let mut child = Command::new(folder.path().join(&module.name))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starting the program");
    let mut stdin = child.stdin.take().expect("its standard input");
    stdin
        .write_all(commands.as_bytes())
        .expect("typing commands");
    let (sender, printed) = std::sync::mpsc::channel();
    let [out, err]: [Box<dyn std::io::Read + std::marker::Send>; 2] = [
        Box::new(child.stdout.take().expect("its output")),
        Box::new(child.stderr.take().expect("its errors")),
    ];
    for pipe in [out, err] {
        let sender = sender.clone();
        std::thread::spawn(move || {
            let lines = BufReader::new(pipe).lines().map_while(Result::ok);
            lines.for_each(|line| drop(sender.send(line)));
        });
    }
    let mut transcript = String::new();
    while !expected.iter().all(|text| transcript.contains(text)) {
        // Bounds a hang.
        let line = printed.recv_timeout(std::time::Duration::from_secs(300));
        transcript += &line.unwrap_or_else(|_| panic!("nothing more is printed: {transcript}"));
        transcript.push('\n');
    }
    child.kill().expect("stopping the program");
    child.wait().expect("its end");
}
