//! The systems that packages are for.

use crate::Problem;
use std::env::consts::{ARCH, OS};

/// A system.
#[derive(PartialEq, Eq, Debug)]
pub struct System {
    /// Rust's name.
    pub triple: &'static str,
    /// Its name in names of packages.
    pub name: &'static str,
    /// Debian's name of its processor, if there are packages for Debian.
    pub debian: Option<&'static str>,
}

const fn system(triple: &'static str, name: &'static str, debian: Option<&'static str>) -> System {
    System {
        triple,
        name,
        debian,
    }
}

/// All of them. Those for Linux are static: they run on each distribution.
const ALL: [System; 5] = [
    system(
        "x86_64-unknown-linux-musl",
        "x86_64-linux-musl",
        Some("amd64"),
    ),
    system(
        "aarch64-unknown-linux-musl",
        "aarch64-linux-musl",
        Some("arm64"),
    ),
    system("aarch64-apple-darwin", "aarch64-macos", None),
    // Cross-compiled, and tested in Wine.
    system("x86_64-pc-windows-gnu", "x86_64-windows", None),
    // For wheels, which Python on Windows builds.
    system("x86_64-pc-windows-msvc", "x86_64-windows", None),
];

/// Windows, as built on Linux.
pub const WINDOWS: &System = &ALL[3];

/// The system of this triple.
pub fn find(triple: &str) -> Result<&'static System, String> {
    let mut all = ALL.iter();
    let triples = ALL.map(|system| system.triple).join(", ");
    all.find(|system| system.triple == triple)
        .ok_or_else(|| format!("packages are made for {triples}"))
}

/// This system.
pub fn here() -> Result<&'static System, Problem> {
    let triple = match OS {
        "linux" => format!("{ARCH}-unknown-linux-musl"),
        "macos" => format!("{ARCH}-apple-darwin"),
        "windows" => format!("{ARCH}-pc-windows-msvc"),
        _ => format!("{ARCH}-{OS}"),
    };
    Ok(find(&triple)?)
}

impl System {
    /// File name of the executable.
    pub fn executable(&self) -> &'static str {
        match self.is_windows() {
            true => "rungc.exe",
            false => "rungc",
        }
    }

    /// Returns true for Windows.
    pub fn is_windows(&self) -> bool {
        self.triple.contains("windows")
    }

    /// Returns true for Linux.
    pub fn is_linux(&self) -> bool {
        self.triple.contains("linux")
    }
}
