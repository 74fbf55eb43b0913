//! `rungc build`.

mod fitting;
mod fmu;
mod library;
mod runtime;

use super::setting;
use super::subject::{self, OutputPaths, Subject};
use super::together::{Place, Together};
use super::{
    Context, Failure, Outcome, Result, Verbosity, conclude, defaults, eprint_line, file_name,
    findings, interruption, parent_dir, ports, print_text, read, stem,
};
use crate::args::{Backend, BuildArgs, Emit, Plan};
use crate::output::{at, file, free, spare, write_executable, write_file, write_folder};
use crate::progress;
use crate::report::Reporter;
use fitting::fitting;
use rungc::Names;
use rungc::language::{Language, message};
use rungc_codegen_c::lanes;
use rungc_codegen_rust::Runtime;
use rungc_emit::OutFile;
use rungc_firmware::board::{Board, Chip, Retain, RetainMemory};
use rungc_firmware::boards;
use rungc_firmware::build::Tools;
use rungc_firmware::flash::{Payload, uf2};
use rungc_firmware::image::{self, Image, Script};
use rungc_firmware::package::Package;
use rungc_firmware::report::{self as firmware, Report};
use rungc_firmware::sources;
use rungc_firmware::target::Target;
use rungc_ir::{Module, dump};
use rungc_lower::compile::{self, CompileOptions};
use rungc_project::Project;
use rungc_sim::Target as Device;
use rungc_syntax::codes;
use rungc_syntax::{DeviceClass, FittedModule, Program, text};
use std::fs;
use std::path::{Path, PathBuf};

/// Compiles programs. Nothing is written of one that has errors.
pub fn run(args: &BuildArgs, cx: Context) -> Result {
    interruption::note_for_a_while();
    let mut outputs = OutputPaths::default();
    let mut together = Together::default();
    let outcome = subject::each(&args.inputs, cx, |subject, reporter| {
        if reporter.many() && args.plan.name.is_some() {
            let why = "--name: several programs cannot have the same name";
            return Err(Failure::Because(why.to_string()));
        }
        let plan = defaults::plan(&args.plan, subject)?;
        build(&plan, subject, reporter, &mut outputs, &mut together, cx)
    })?;
    together.write(cx)?;
    Ok(outcome)
}

fn build(
    plan: &Plan,
    subject: &Subject,
    reporter: &mut Reporter,
    outputs: &mut OutputPaths,
    together: &mut Together,
    cx: Context,
) -> Result {
    let target = fitting(plan, &subject.reporting)?;
    let read = read(subject, reporter)?;
    let image = ForImage::of(plan, subject, &read.program, reporter)?;
    let name = plan.name.clone().unwrap_or_else(|| stem(subject, &read));
    let options = CompileOptions {
        name: Some(name.clone()),
        optimise: !plan.no_opt,
        observe_all: plan.servers || plan.io,
        programmer: plan.servers,
        ports: image.iter().flat_map(ForImage::ports).collect(),
        without_qlink: image.as_ref().is_some_and(|image| !image.answers_qlink()),
        ..subject.options()
    };
    let compiled = progress::spin("compiling", || compile::compile(&read.program, &options));
    let mut findings = findings(subject, &read, &compiled);
    let module = match compiled.module {
        Some(module) if !findings.failed() => module,
        _ => return conclude(&findings, reporter, cx, String::new),
    };
    if plan.name.as_ref().is_some_and(|name| *name != module.name) {
        let (name, in_code) = (text::one_line(&name), &module.name);
        cx.note(&format!("       Named {name}: `{in_code}` in the code"));
    }
    let shares = reporter.many() && plan.shares();
    let name = match shares {
        true => module.name.clone(), // a Makefile needs a plain name
        false => file_name(&name, &module.name),
    };
    let job = Job {
        cx,
        name: &name,
        plan: &plan.at(&name, subject, reporter.many(), outputs)?,
        module: &module,
        target,
        image: image.as_ref(),
        program: &read.program,
        project: subject.own_project(),
        unsaved: subject.unsaved(),
    };
    let written = match plan.emit {
        Some(_) if shares => Some(job.share(together)?),
        Some(what) => job.emit(what)?,
        None => None,
    };
    if plan.report {
        findings.takes = Some(job.measure(written.as_deref())?);
    }
    if plan.emit == Some(Emit::Ir) && written.is_none() {
        reporter.leave_output();
        reporter.add(&findings)?;
        return Ok(Outcome::Success);
    }
    if reporter.is_for_people() {
        let lines = compiled.ports.iter().map(ports::line);
        let served = ports::served(&compiled.ports, plan, subject);
        let library = library::note(&module).filter(|_| plan.emit == Some(Emit::C));
        let all = lines.chain(served).chain(library);
        all.for_each(|line| cx.note(&line));
    }
    if let (Some(takes), true) = (&findings.takes, reporter.is_for_people()) {
        print_text(&takes.to_string())?;
    }
    let language = findings.language(cx);
    conclude(&findings, reporter, cx, || {
        let (id, path) = match &written {
            Some(path) => ("emitted", path),
            None => ("measured", &subject.file),
        };
        closing(language, id, path, &module)
    })
}

/// What was written or measured.
fn closing(language: Language, id: &str, path: &Path, module: &Module) -> String {
    let (path, model) = (path.display().to_string(), module.model.name.to_uppercase());
    let arguments = [
        ("path", (&path).into()),
        ("model", (&model).into()),
        ("steps", (module.steps as usize).into()),
    ];
    message(language, id, &arguments)
}

impl Plan {
    /// Returns true if several programs are written to one folder, where they share headers, the runtime's sources and
    /// a Makefile.
    fn shares(&self) -> bool {
        self.emit == Some(Emit::C) && self.output.is_some() && self.board.is_none()
    }

    /// The plan for one program: among several, each has a separate output path.
    fn at(
        &self,
        name: &str,
        subject: &Subject,
        many: bool,
        outputs: &mut OutputPaths,
    ) -> Built<Plan> {
        let mut plan = self.clone();
        let Some(emit) = plan.emit.filter(|_| many) else {
            return Ok(plan);
        };
        if let (Some(folder), Emit::Rust, None) = (file(&plan.output), emit, &plan.board) {
            // One firmware cannot have two crates of one name.
            plan.runtime.get_or_insert(folder.join("rungc-rt").into());
        }
        let path = match (file(&plan.output), emit) {
            (Some(folder), Emit::Elf | Emit::Uf2 | Emit::Fmu) => {
                folder.join(emit.default_output(name))
            }
            (Some(folder), Emit::Ir) => folder.join(format!("{name}.ir")),
            (Some(folder), _) => folder.join(name),
            (None, Emit::Ir) => return Ok(plan),
            (None, _) => PathBuf::from(emit.default_output(name)),
        };
        plan.output = Some(outputs.claim(path, subject)?.into());
        Ok(plan)
    }
}

/// Inputs of an image in addition to its program.
struct ForImage {
    board: Board,
    script: Script,
    /// The special modules of the PLC.
    modules: Vec<FittedModule>,
}

impl ForImage {
    /// That of the plan, if it is for a board.
    fn of(
        plan: &Plan,
        subject: &Subject,
        program: &Program,
        reporter: &mut Reporter,
    ) -> Built<Option<Self>> {
        let path = plan.board.as_ref();
        let image = path.map(|path| ForImage::new((plan, path), subject, program, reporter));
        image.transpose()
    }

    fn new(
        (args, path): (&Plan, &Path),
        subject: &Subject,
        program: &Program,
        reporter: &mut Reporter,
    ) -> Built<Self> {
        let board = boards::named_or_described(path)
            .map_err(|error| subject::refuse_board(error, &subject.reporting, reporter))?;
        if let Some(target) = args.target.filter(|target| *target != board.target) {
            return Err(Failure::Because(format!(
                "--target {}: {} is {}",
                target.triple,
                path.display(),
                board.target.triple
            )));
        }
        if args.emit == Some(Emit::Uf2) && board.chip != Some(Chip::Rp2040) {
            return Err(Failure::Because(format!(
                "--emit uf2 is for boards with an RP2040 (`chip = \"rp2040\"`), which {} is not; use --emit elf",
                board.name
            )));
        }
        let settings = setting::settings(&args.set, &Names::of(program))?;
        setting::report_unused(&settings, program, subject.options());
        let inputs = settings.iter().map(|setting| match setting.target {
            Device::Bit(DeviceClass::X, number) => {
                Ok((milliseconds(setting.at_ms)?, number, setting.value != 0.0))
            }
            other => Err(Failure::Because(format!(
                "--set {other}: only inputs can be scripted in an image"
            ))),
        });
        let script = Script {
            inputs: inputs.collect::<std::result::Result<_, _>>()?,
            until_ms: args.duration.map(milliseconds).transpose()?,
        };
        let parameters = program.parameters.iter();
        Ok(ForImage {
            board,
            script,
            modules: parameters.flat_map(|p| p.modules.clone()).collect(),
        })
    }

    /// The serial ports that work whatever the program does.
    fn ports(&self) -> impl Iterator<Item = u8> {
        let always = self.board.serial.iter().filter(|serial| serial.always);
        always.map(|serial| serial.port)
    }

    /// Returns true if a serial port answers QLink.
    fn answers_qlink(&self) -> bool {
        self.board.serial.iter().any(|serial| serial.qlink)
    }

    fn image<'a>(&'a self, module: &'a Module) -> Image<'a> {
        Image {
            module,
            board: &self.board,
            script: &self.script,
            modules: &self.modules,
        }
    }

    /// The image, if it can be built by this backend. Reports terminals that the board has no pin for.
    fn checked<'a>(&'a self, module: &'a Module, backend: Backend) -> Built<Image<'a>> {
        let image = self.image(module);
        let board = &self.board;
        let own = !board.functions.is_empty() || !board.interrupts.is_empty();
        if backend == Backend::Rust && own {
            return Err(Failure::Because(format!(
                "{} has C functions, which an image built from Rust cannot call; use --backend c",
                board.name
            )));
        }
        if let Some((unit, channel, pin)) = image.missing_pins().first() {
            return Err(Failure::Because(format!(
                "{} has no analog pin `{pin}`, which rungc.toml gives to {unit}:CH{channel}",
                board.name
            )));
        }
        let unconnected = image.unconnected();
        if !unconnected.is_empty() {
            let (board, names) = (&self.board.name, unconnected.join(", "));
            eprint_line(&format!("rungc: no pins on {board}: {names}"));
        }
        let uncertain = image.uncertain();
        if !uncertain.is_empty() {
            let (id, names) = (codes::UNCERTAIN_PIN.id, uncertain.join(", "));
            eprint_line(&format!(
                "rungc: warning[{id}]: uncertain pins on {}: {names}\n       for more, run `rungc explain {id}`",
                board.name
            ));
        }
        self.check_slots(&image)?;
        Ok(image)
    }
}

/// Erasures that flash endures, as most parts state it.
const ERASURES: u64 = 10_000;

/// In days.
const TEN_YEARS: u64 = 3653;

impl ForImage {
    /// Reports how often the board's memory can save latched devices, unless a slot has no room for them.
    fn check_slots(&self, image: &Image) -> std::result::Result<(), Failure> {
        let Some((length, records)) = image.records() else {
            return Ok(());
        };
        let board = &self.board.name;
        if records == 0 {
            return Err(Failure::Because(format!(
                "a slot of `[retain]` of {board} is too short: a record of the program's latched devices takes {length} bytes"
            )));
        }
        let wears = |retain: &Retain| retain.memory != RetainMemory::Ram;
        if self.board.retain.as_ref().is_some_and(wears) {
            let a_day = 2 * u64::from(records) * ERASURES / TEN_YEARS;
            eprint_line(&format!(
                "rungc: {board}: latched devices take {length} bytes, {records} records a slot; flash of {ERASURES} erasures allows {a_day} \
                 saves a day for ten years"
            ));
        }
        Ok(())
    }
}

/// A time in an image.
fn milliseconds(ms: u64) -> std::result::Result<u32, Failure> {
    let wrong = |_| Failure::Because("the time of an image is limited to 49 days".to_string());
    u32::try_from(ms).map_err(wrong)
}

fn because(error: impl std::fmt::Display) -> Failure {
    Failure::Because(error.to_string())
}

/// A program to be emitted.
struct Job<'a> {
    /// Base name of files.
    name: &'a str,
    cx: Context,
    plan: &'a Plan,
    module: &'a Module,
    target: &'static Target,
    image: Option<&'a ForImage>,
    /// The program as it was read.
    program: &'a Program,
    /// The settings, if they are about this program.
    project: Option<&'a Project>,
    /// The bit that is on while latched devices cannot be saved.
    unsaved: Option<(DeviceClass, u32)>,
}

type Built<T> = std::result::Result<T, Failure>;

impl Job<'_> {
    /// The target, which an image has from its board.
    fn target(&self) -> &'static Target {
        self.image.map_or(self.target, |image| image.board.target)
    }

    /// Options for C.
    fn options(&self, main: bool) -> sources::Options {
        sources::Options {
            main,
            servers: self.plan.servers,
            io: self.plan.io,
            unsaved: self.unsaved,
            access: self.plan.device_access,
            retain: self.plan.retain,
            lanes: self.plan.lanes.is_some(),
            misra: self.plan.misra,
            ..sources::Options::default()
        }
    }

    /// Options for Rust.
    fn rust_options(&self, runtime: Runtime) -> sources::RustOptions {
        sources::RustOptions {
            main: self.plan.main,
            servers: self.plan.servers,
            io: self.plan.io,
            unsaved: self.unsaved,
            defmt: self.plan.defmt,
            runtime,
        }
    }

    /// Location of the runtime for an emitted crate.
    fn runtime(&self) -> Built<Runtime> {
        match &self.plan.runtime {
            Some(folder) => runtime::shared(folder, &self.output(Emit::Rust), self.plan.force),
            None => Ok(Runtime::Included),
        }
    }

    fn tools(&self) -> Tools {
        let tools = Tools::new(self.target(), &self.plan.cargo_arg).with_std(self.plan.io);
        announced(tools, self.cx)
    }

    /// Output path.
    fn output(&self, emit: Emit) -> PathBuf {
        let given = self.plan.output.as_deref().map(Path::to_owned);
        given.unwrap_or_else(|| emit.default_output(self.name).into())
    }

    /// Says what keeps the program from running in lanes, if that is asked for.
    fn check_lanes(&self) -> Built<()> {
        let refusal = lanes::refusal(self.module).filter(|_| self.plan.lanes.is_some());
        match refusal {
            Some(why) => Err(Failure::Because(format!(
                "--lanes: {} {why}, which only one instance at a time can do (`rungc book lanes`)",
                self.module.name
            ))),
            None => Ok(()),
        }
    }

    /// Writes what was asked for; returns where, or `None` for standard output.
    fn emit(&self, what: Emit) -> Built<Option<PathBuf>> {
        self.check_lanes()?;
        let (module, name, main) = (self.module, &self.module.name, self.plan.main);
        let path = match what {
            Emit::Ir => return self.ir(),
            Emit::C => {
                let files = match self.image {
                    Some(image) => image::c_project(&image.checked(module, Backend::C)?)?,
                    None => sources::c(module, self.target, &self.options(main)),
                };
                self.folder(what, || Ok(bytes(files)))?
            }
            Emit::Rust => {
                let runtime = self.runtime()?;
                let files = match self.image {
                    Some(image) => {
                        image::rust_project(&image.checked(module, Backend::Rust)?, &runtime)
                    }
                    None => sources::rust(module, self.target, &self.rust_options(runtime)),
                };
                self.folder(what, || Ok(bytes(files)))?
            }
            Emit::Lib => self.folder(what, || self.library())?,
            Emit::Bin => self.program(what, || {
                let files = sources::c(module, self.target, &self.options(true));
                let built = progress::spin("building", || self.tools().c_program(&files, name));
                built.map_err(because)
            })?,
            Emit::Elf => self.program(what, || self.elf())?,
            Emit::Uf2 => self.program(what, || self.uf2())?,
            Emit::Fmu => self.fmu()?,
            Emit::Arduino | Emit::Platformio | Emit::Zephyr | Emit::EspIdf => {
                self.folder(what, || self.package(what))?
            }
        };
        Ok(Some(path))
    }

    /// The folder for a build system, with the runtime library if its builds do not make it of sources.
    fn package(&self, what: Emit) -> Built<Vec<OutFile<Vec<u8>>>> {
        let kind = what
            .package()
            .ok_or_else(|| because("not for a build system"))?;
        let package = Package::new(kind, self.module, &self.options(false));
        let library = match package.needs_library() {
            false => None,
            true if self.target().is_bare() => {
                let built = progress::spin("building", || self.tools().runtime_library());
                Some(built.map_err(because)?)
            }
            true => {
                return Err(Failure::Because(format!(
                    "{} calls the runtime library, which {} cannot build: name the processor with --target (`rungc book builds`)",
                    self.module.name,
                    kind.title()
                )));
            }
        };
        Ok(package.folder(library))
    }

    /// Writes the program beside those that it shares files with.
    fn share(&self, together: &mut Together) -> Built<PathBuf> {
        self.check_lanes()?;
        let path = self.output(Emit::C);
        let place = Place {
            folder: parent_dir(&path).to_owned(),
            target: self.target,
            force: self.plan.force,
        };
        let shared = together.at(place)?;
        let part = sources::Part::new(self.module, &self.options(self.plan.main));
        let (files, recipe) = part.inside(self.name);
        let path = self.folder(Emit::C, || Ok(bytes(files)))?;
        shared.push(recipe);
        Ok(path)
    }

    fn ir(&self) -> Built<Option<PathBuf>> {
        let text = dump::dump(self.module);
        let path = file(&self.plan.output);
        match path {
            None => print_text(&text)?,
            Some(path) => write_file(path, text.as_bytes(), self.plan.force)?,
        }
        Ok(path.map(Path::to_owned))
    }

    /// Writes a folder with what `make` makes; whether it may be written is known before.
    fn folder(
        &self,
        emit: Emit,
        make: impl FnOnce() -> Built<Vec<OutFile<Vec<u8>>>>,
    ) -> Built<PathBuf> {
        let path = self.output(emit);
        free(&path, self.plan.force)?;
        write_folder(&path, &make()?, self.plan.force)?;
        Ok(path)
    }

    /// The same of an executable file.
    fn program(&self, emit: Emit, make: impl FnOnce() -> Built<Vec<u8>>) -> Built<PathBuf> {
        let path = self.output(emit);
        spare(&path, self.plan.force)?;
        write_executable(&path, &make()?, self.plan.force)?;
        Ok(path)
    }

    fn library(&self) -> Built<Vec<OutFile<Vec<u8>>>> {
        let files = sources::c(self.module, self.target, &self.options(false));
        let name = &self.module.name;
        progress::spin("building", || self.tools().c_library(&files, name)).map_err(because)
    }

    fn elf(&self) -> Built<Vec<u8>> {
        let image = self.image.ok_or_else(|| because("an image needs a board"));
        let backend = self.plan.backend.unwrap_or(Backend::C);
        let image = image?.checked(self.module, backend)?;
        let tools = self.tools();
        let built = match backend {
            Backend::C => {
                let files = image::c_project(&image)?;
                let file = format!("{}.elf", self.module.name);
                progress::spin("building", || tools.c_program(&files, &file))
            }
            Backend::Rust => progress::spin("building", || tools.rust_image(&image)),
        };
        built.map_err(because)
    }

    /// The image as the volume of an RP2040 takes it.
    fn uf2(&self) -> Built<Vec<u8>> {
        let payload = Payload::read(&self.elf()?, 0);
        payload.map(|payload| uf2::write(&payload)).map_err(because)
    }

    /// Resources of the program. An image that was written is measured as it is.
    fn measure(&self, written: Option<&Path>) -> Built<Report> {
        let (module, target) = (self.module, self.target());
        if let Some(image) = self.image {
            let data = match written.filter(|_| self.plan.emit == Some(Emit::Elf)) {
                Some(path) => fs::read(path).map_err(|error| at(path, error))?,
                None => self.elf()?,
            };
            return firmware::of_image(module, target, Some(&image.board), &data).map_err(because);
        }
        if target.is_bare() {
            let files = sources::c(module, target, &self.options(false));
            let data = progress::spin("building", || self.tools().c_probe(&files, module));
            let data = data.map_err(because)?;
            return firmware::of_image(module, target, None, &data).map_err(because);
        }
        let own = format!("lib{}.a", module.name);
        let library = self.library()?;
        let built = library
            .iter()
            .find(|file| file.path == own)
            .ok_or_else(|| because("no library was built"))?;
        firmware::of_library(module, target, &built.contents).map_err(because)
    }
}

/// Compilers that say what takes long, unless nothing is to be said.
pub(super) fn announced(tools: Tools, cx: Context) -> Tools {
    if cx.verbosity == Verbosity::Quiet {
        return tools;
    }
    tools.announcing(|what| {
        eprint_line(&format!(
            "    Building {what}; it is cached for the next time"
        ))
    })
}

fn bytes(files: Vec<OutFile>) -> Vec<OutFile<Vec<u8>>> {
    files.into_iter().map(OutFile::from).collect()
}
