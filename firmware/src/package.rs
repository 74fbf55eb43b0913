//! A program as a library for a build system that firmware has: a folder with the sources, the build system's
//! description of them, and an example that runs the program on a board.

mod arduino;
mod cmake;
mod example;
mod platformio;

use rungc_codegen_c::Options;
use rungc_emit::OutFile;
use rungc_ir::Module;

/// The build system that a folder is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// A library of Arduino.
    Arduino,
    /// A library of PlatformIO.
    PlatformIo,
    /// A module of Zephyr.
    Zephyr,
    /// A component of ESP-IDF.
    EspIdf,
}

impl Kind {
    /// Its name.
    pub fn title(self) -> &'static str {
        match self {
            Kind::Arduino => "Arduino",
            Kind::PlatformIo => "PlatformIO",
            Kind::Zephyr => "Zephyr",
            Kind::EspIdf => "ESP-IDF",
        }
    }

    /// Returns true if its builds can call cargo, so that they take the runtime library as sources.
    fn calls_cargo(self) -> bool {
        matches!(self, Kind::Zephyr | Kind::EspIdf)
    }
}

/// The runtime library, built for a processor.
#[derive(Clone, Debug)]
pub struct Library {
    /// The target, as rustc calls it.
    pub triple: &'static str,
    /// The static library.
    pub contents: Vec<u8>,
}

/// Contents of a folder for a build system.
#[derive(Clone, Debug)]
pub struct Package<'m> {
    kind: Kind,
    module: &'m Module,
    /// Sources and headers of the program.
    files: Vec<OutFile>,
    /// The runtime's sources, if the program calls it.
    runtime: Vec<OutFile>,
    /// The runtime library.
    library: Option<Library>,
}

impl<'m> Package<'m> {
    /// Emits a program, with what describes a board to it (`rungc_board.h`), as the example does.
    pub fn new(kind: Kind, module: &'m Module, options: &Options) -> Self {
        let options = Options {
            board: true,
            ..*options
        };
        let emitted = rungc_codegen_c::emit(module, &options).into_iter();
        let emitted = emitted.filter(|f| !["Makefile", "CMakeLists.txt"].contains(&&*f.path));
        let (runtime, files) = emitted.partition(|f| f.path.starts_with("rungc-rt/"));
        Package {
            kind,
            module,
            files,
            runtime,
            library: None,
        }
    }

    /// Returns true if the runtime library must be supplied: the program calls it, and the build system cannot build
    /// it.
    pub fn needs_library(&self) -> bool {
        !self.runtime.is_empty() && !self.kind.calls_cargo()
    }

    /// The folder's files; `library` is the runtime library of a program that [needs](Self::needs_library) it.
    pub fn folder(mut self, library: Option<Library>) -> Vec<OutFile<Vec<u8>>> {
        self.library = library;
        match self.kind {
            Kind::Arduino => arduino::folder(self),
            Kind::PlatformIo => platformio::folder(self),
            Kind::Zephyr => cmake::zephyr(self),
            Kind::EspIdf => cmake::esp_idf(self),
        }
    }

    fn name(&self) -> &str {
        &self.module.name
    }

    /// Description of the program, in a sentence that needs no quoting in any of the package descriptions.
    fn sentence(&self) -> String {
        let plain = |c: char| c.is_ascii_alphanumeric() || " ._-".contains(c);
        let source = self.module.source_name.replace(|c| !plain(c), "_");
        format!(
            "The PLC program {source} as C, compiled by rungc {}.",
            env!("CARGO_PKG_VERSION")
        )
    }

    /// The paths of the C sources.
    fn sources(&self) -> impl Iterator<Item = &str> {
        let paths = self.files.iter().map(|file| file.path.as_str());
        paths.filter(|path| path.ends_with(".c"))
    }
}
