//! Emitted sources that build for a target as they are.

use crate::target::Target;
pub use rungc_codegen_c::{Options, Part, Recipe};
pub use rungc_codegen_rust::Options as RustOptions;
use rungc_emit::OutFile;
use rungc_ir::Module;
use rungc_runtime_sources::library::Optimise;

/// A folder of C whose `make` builds for the target.
pub fn c(module: &Module, target: &Target, options: &Options) -> Vec<OutFile> {
    for_target(rungc_codegen_c::emit(module, options), target)
}

/// Files shared by programs in separate folders: headers, the runtime's sources, and the Makefile that builds them all
/// for the target.
pub fn c_together(recipes: &[Recipe], target: &Target) -> Vec<OutFile> {
    for_target(rungc_codegen_c::together(recipes), target)
}

/// The same files with recipes for the target.
fn for_target(files: Vec<OutFile>, target: &Target) -> Vec<OutFile> {
    let files = files.into_iter();
    files
        .map(|f| match (f.path.as_str(), target.rustc_name()) {
            ("Makefile", Some(triple)) => {
                OutFile::new(f.path, makefile(&f.contents, target, triple))
            }
            // The compiler and its options are the toolchain file's.
            ("CMakeLists.txt", Some(triple)) => {
                let set = format!("set(RUNGC_TARGET \"{triple}\"");
                OutFile::new(f.path, f.contents.replace("set(RUNGC_TARGET \"\"", &set))
            }
            _ => f,
        })
        .collect()
}

/// A Makefile that builds for a target by default. Its first line says what it builds.
fn makefile(text: &str, target: &Target, triple: &str) -> String {
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    let Target {
        cc,
        ar,
        flags,
        title,
        ..
    } = target;
    let optimise = if target.is_bare() { "-Os" } else { "-O2" };
    // By its own rule `make` takes another machine for a small one.
    let runtime = match target.optimise() {
        Optimise::Speed if text.contains("RUNTIME_OPT") => "RUNTIME_OPT = 3\n",
        _ => "",
    };
    let cflags = format!(
        "-std=c99 {optimise} -Wall -Wextra -Wconversion -pedantic -ffunction-sections -fdata-sections {flags}"
    );
    format!(
        "{first}\n# For {triple}: {title}.\nCC = {cc}\nAR = {ar}\nCFLAGS = {}\nTARGET = {triple}\n{runtime}{rest}",
        cflags.trim_end()
    )
}

/// A Rust crate that cargo builds for the target.
pub fn rust(module: &Module, target: &Target, options: &RustOptions) -> Vec<OutFile> {
    let files = rungc_codegen_rust::emit(module, options).into_iter();
    let config = target.rustc_name().map(|triple| {
        let text = format!("[build]\ntarget = \"{triple}\"\n");
        OutFile::new(".cargo/config.toml", text)
    });
    files.chain(config).collect()
}
