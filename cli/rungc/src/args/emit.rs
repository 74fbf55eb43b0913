//! Outputs of `build`.

use clap::ValueEnum;
use rungc_firmware::package::Kind;

/// Output forms of `build`.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Emit {
    /// The intermediate representation, as text.
    Ir,
    /// A folder of C99.
    C,
    /// A Rust crate.
    Rust,
    /// An executable for this machine (built from C).
    Bin,
    /// A folder with a static library and its headers (built from C).
    Lib,
    /// An image for a board.
    Elf,
    /// A UF2 image for a board with an RP2040.
    Uf2,
    /// An Arduino library: C, `library.properties`, a sketch.
    Arduino,
    /// A PlatformIO library: C, `library.json`, an example.
    Platformio,
    /// A Zephyr module: C, `zephyr/module.yml`, a sample.
    Zephyr,
    /// An ESP-IDF component: C, `idf_component.yml`, an example.
    EspIdf,
    /// A functional mock-up unit for co-simulation (FMI 3.0), built from C.
    Fmu,
}

/// Language of the image's sources.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub enum Backend {
    /// C: the default.
    C,
    /// Rust: the board's pins only, no C functions.
    Rust,
}

impl Emit {
    /// The build system that a folder of C is for.
    pub fn package(self) -> Option<Kind> {
        match self {
            Emit::Arduino => Some(Kind::Arduino),
            Emit::Platformio => Some(Kind::PlatformIo),
            Emit::Zephyr => Some(Kind::Zephyr),
            Emit::EspIdf => Some(Kind::EspIdf),
            Emit::Ir
            | Emit::C
            | Emit::Rust
            | Emit::Bin
            | Emit::Lib
            | Emit::Elf
            | Emit::Uf2
            | Emit::Fmu => None,
        }
    }

    /// Default output path.
    pub fn default_output(self, name: &str) -> String {
        match self {
            Emit::C => format!("{name}-c"),
            Emit::Rust => format!("{name}-rust"),
            Emit::Lib => format!("{name}-lib"),
            Emit::Elf => format!("{name}.elf"),
            Emit::Uf2 => format!("{name}.uf2"),
            Emit::Bin | Emit::Ir => name.to_string(),
            Emit::Arduino => format!("{name}-arduino"),
            Emit::Platformio => format!("{name}-platformio"),
            Emit::Zephyr => format!("{name}-zephyr"),
            Emit::EspIdf => format!("{name}-esp-idf"),
            Emit::Fmu => format!("{name}.fmu"),
        }
    }

    /// Returns true for an image for a board.
    pub fn is_image(self) -> bool {
        matches!(self, Emit::Elf | Emit::Uf2)
    }

    /// Returns true if C headers are emitted, with optional parts on request.
    pub fn has_headers(self) -> bool {
        matches!(self, Emit::C | Emit::Lib) || self.package().is_some()
    }
}
