//! Asks the linker for what makes the executable a tenth smaller: compact relocations (4 %), no unwind tables (6 %) and
//! one copy of functions with the same code (1 %).
//!
//! Loading compact relocations takes glibc 2.36, so only a build for this very machine has them, and only if its glibc
//! is that new. Unwind tables have no use where a panic aborts, as it does in the release profile; the GNU linker and
//! LLD leave them out, others cannot, so whoever chooses a linker keeps them. The GNU linker cannot merge functions:
//! the one that is there is asked.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

/// The first glibc that loads compact relocations.
const GLIBC: (u32, u32) = (2, 36);

/// Merges functions with the same code. No code here compares the addresses of functions.
const MERGED: &str = "-Wl,--icf=all";

/// Leaves out the tables that tell how to unwind each function.
const WITHOUT_TABLES: &str =
    "SECTIONS { /DISCARD/ : { *(.eh_frame) *(.gcc_except_table .gcc_except_table.*) } }
INSERT AFTER .text;
";

fn main() -> io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |variable: &str, value: &str| env::var(variable).is_ok_and(|is| is == value);
    if !is("CARGO_CFG_TARGET_OS", "linux") {
        return Ok(());
    }
    let native = env::var("HOST").ok() == env::var("TARGET").ok();
    if native && glibc().is_some_and(|version| version >= GLIBC) {
        println!("cargo:rustc-link-arg-bins=-Wl,-z,pack-relative-relocs");
    }
    let chosen = env::var_os("RUSTC_LINKER").is_some()
        || env::var("CARGO_ENCODED_RUSTFLAGS").is_ok_and(|flags| flags.contains("link"));
    if native && is("PROFILE", "release") && !chosen {
        let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
        let script = out.join("without_tables.ld");
        fs::write(&script, WITHOUT_TABLES)?;
        println!("cargo:rustc-link-arg-bins=-Wl,--no-eh-frame-hdr");
        println!("cargo:rustc-link-arg-bins=-Wl,-T,{}", script.display());
        if links(&out, MERGED)? {
            println!("cargo:rustc-link-arg-bins={MERGED}");
        }
    }
    Ok(())
}

/// Returns true if the linker accepts an argument: links the smallest program with it.
fn links(folder: &Path, argument: &str) -> io::Result<bool> {
    let source = folder.join("smallest.rs");
    fs::write(&source, "fn main() {}")?;
    let output = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .arg(source)
        .arg(format!("-Clink-arg={argument}"))
        .arg("-o")
        .arg(folder.join("smallest"))
        .output()?;
    Ok(output.status.success())
}

/// The version of this machine's C library; `None` if it is another one than glibc.
fn glibc() -> Option<(u32, u32)> {
    let output = Command::new("getconf").arg("GNU_LIBC_VERSION").output();
    let text = String::from_utf8(output.ok()?.stdout).ok()?;
    let mut numbers = text.trim().strip_prefix("glibc ")?.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}
