//! The programs that rungc calls, a row each. The table in `docs/src/install.md` has the same rows: a test compares.

use rungc_firmware::build::Tools;
use rungc_firmware::target::{self, CORTEX_M4F};
use serde::Serialize;
use std::env;
use std::ffi::OsString;

/// A program that commands of rungc call.
#[derive(Serialize)]
pub struct Tool {
    /// Name in the report.
    pub name: &'static str,
    /// The commands that need it.
    pub needed_for: &'static str,
    /// Installation, by system.
    pub install: Install,
    /// The command that starts it.
    #[serde(skip)]
    pub command: fn() -> OsString,
}

/// Ways to install a program: a command, or an address.
#[derive(Serialize)]
pub struct Install {
    /// Debian, Ubuntu and Raspberry Pi OS.
    pub debian: &'static str,
    /// macOS.
    pub macos: &'static str,
    /// Windows.
    pub windows: &'static str,
}

impl Install {
    /// For the system that rungc runs on.
    pub fn here(&self) -> &'static str {
        if cfg!(windows) {
            self.windows
        } else if cfg!(target_os = "macos") {
            self.macos
        } else {
            self.debian
        }
    }
}

/// `make` and the compilers that it calls run in WSL.
const WSL: &str = "in WSL, as on Debian";

/// All of them.
pub const ALL: [Tool; 8] = [
    Tool {
        name: "C compiler",
        needed_for: "`build --emit bin`, `build --emit lib`, `test --engine c`",
        install: Install {
            debian: "sudo apt install gcc libc6-dev",
            macos: "xcode-select --install",
            windows: WSL,
        },
        command: || Tools::new(target::host(), &[]).c_compiler().to_owned(),
    },
    Tool {
        name: "make",
        needed_for: "`build --emit bin`, `lib`, `elf` and `uf2`, `build --report`, `test --engine c`",
        install: Install {
            debian: "sudo apt install make",
            macos: "xcode-select --install",
            windows: WSL,
        },
        command: || "make".into(),
    },
    Tool {
        name: "clang",
        needed_for: "emitted code by another C compiler: `CC=clang`",
        install: Install {
            debian: "sudo apt install clang",
            macos: "xcode-select --install",
            windows: "winget install LLVM.LLVM",
        },
        command: || "clang".into(),
    },
    Tool {
        name: "Arm C compiler",
        needed_for: "images for boards: `build --emit elf`, `build --emit uf2`, `build --report`",
        install: Install {
            debian: "sudo apt install gcc-arm-none-eabi libnewlib-arm-none-eabi",
            macos: "brew install --cask gcc-arm-embedded",
            windows: WSL,
        },
        command: || Tools::new(&CORTEX_M4F, &[]).c_compiler().to_owned(),
    },
    Tool {
        name: "cargo",
        needed_for: "programs that call the runtime library (serial ports, PID, strings …), built from C; \
                     `test --engine rust`, `build --backend rust`",
        install: Install {
            debian: "https://rustup.rs",
            macos: "https://rustup.rs",
            windows: "winget install Rustlang.Rustup",
        },
        command: || env::var_os("CARGO").unwrap_or_else(|| "cargo".into()),
    },
    Tool {
        name: "QEMU",
        needed_for: "running images without a board",
        install: Install {
            debian: "sudo apt install qemu-system-arm",
            macos: "brew install qemu",
            windows: "winget install SoftwareFreedomConservancy.QEMU",
        },
        command: || "qemu-system-arm".into(),
    },
    Tool {
        name: "probe-rs",
        needed_for: "`flash` with a debug probe",
        install: Install {
            debian: "https://probe.rs",
            macos: "https://probe.rs",
            windows: "https://probe.rs",
        },
        command: || crate::commands::flash::probe::PROGRAM.into(),
    },
    Tool {
        name: "CaDiCaL",
        needed_for: "`verify --drat`",
        install: Install {
            debian: "sudo apt install cadical",
            macos: "https://github.com/arminbiere/cadical",
            windows: WSL,
        },
        command: || crate::commands::verify::SOLVER.into(),
    },
];
