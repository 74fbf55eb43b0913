//! The `CMakeLists.txt` beside emitted C, of one program or of several: `add_subdirectory()` gives the target
//! `rungc::NAME`, and so does `find_package()` after an installation.

use crate::makefile::{Recipe, Source};
use crate::parts::Runtime;
use std::fmt::Write;

/// Beginning of the file; `@PROJECT@` is its name.
const PROJECT: &str = "\
cmake_minimum_required(VERSION 3.16)
project(@PROJECT@ LANGUAGES C)
include(GNUInstallDirs)
";

/// Rules that build the runtime library, or use an existing one.
const RUNTIME: &str = "
# The runtime library is built from the sources in rungc-rt, without a network. For another machine name the target as
# rustc does (-DRUNGC_TARGET=thumbv7em-none-eabihf; rustup target add ...), or name a library that is built already.
@TARGET@
set(RUNGC_RT \"\" CACHE FILEPATH \"A runtime library that is built already\")
set(RUNGC_OPT \"\" CACHE STRING \"Optimisation level of the runtime library; empty: 3 for this machine, s for another\")
set(RUNGC_CARGO_FLAGS --offline CACHE STRING \"Arguments for cargo, which builds the runtime library\")
set(rungc_rt ${RUNGC_RT})
if(NOT RUNGC_RT)
    set(rungc_rt ${CMAKE_CURRENT_BINARY_DIR}/rungc-rt/${RUNGC_TARGET}/release/@LIBRARY@)
    if(RUNGC_TARGET)
        set(rungc_target_flags --target ${RUNGC_TARGET})
    endif()
    if(NOT RUNGC_OPT)
        set(RUNGC_OPT $<IF:$<BOOL:${RUNGC_TARGET}>,s,3>)
    endif()
    file(GLOB_RECURSE rungc_sources CONFIGURE_DEPENDS@FOLDERS@)
    add_custom_command(
        OUTPUT ${rungc_rt}
        COMMAND ${CMAKE_COMMAND} -E env CARGO_PROFILE_RELEASE_OPT_LEVEL=${RUNGC_OPT}
            cargo rustc --release --locked ${RUNGC_CARGO_FLAGS} ${rungc_target_flags}
            --target-dir ${CMAKE_CURRENT_BINARY_DIR}/rungc-rt --crate-type staticlib@PACKAGE@ --features @FEATURES@
        DEPENDS ${rungc_sources} ${CMAKE_CURRENT_SOURCE_DIR}/@ROOT@rungc-rt/Cargo.toml
        WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/@ROOT@rungc-rt
        VERBATIM)
endif()
add_custom_target(@PROJECT@_runtime DEPENDS ${rungc_rt})
";

/// The target, where no build system knows it.
const TARGET: &str = "\
set(RUNGC_TARGET \"\" CACHE STRING \"Target of the runtime library; empty: this machine\")";

/// The target of a program. -ffp-contract=off: no rounding of the PLC is left out.
const LIBRARY: &str = "
add_library(plc_@NAME@ STATIC @SOURCES@)
add_library(rungc::@NAME@ ALIAS plc_@NAME@)
set_target_properties(plc_@NAME@ PROPERTIES EXPORT_NAME @NAME@ C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
target_compile_options(plc_@NAME@ PRIVATE
    $<$<C_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off;-ffunction-sections;-fdata-sections>)
target_include_directories(plc_@NAME@ PUBLIC
@FOLDERS@    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/plc_@NAME@>)
";

/// Link rules of a program that calls the runtime.
const LINK_RUNTIME: &str = "\
add_dependencies(plc_@NAME@ @PROJECT@_runtime)
target_link_libraries(plc_@NAME@ INTERFACE
    $<BUILD_INTERFACE:${rungc_rt}>
    $<INSTALL_INTERFACE:$<INSTALL_PREFIX>/${CMAKE_INSTALL_LIBDIR}/librungc_rt.a>)
install(FILES ${rungc_rt} DESTINATION ${CMAKE_INSTALL_LIBDIR} RENAME librungc_rt.a)
";

/// Link rule for a runtime library that has Rust's standard library in it.
const LINK_SYSTEM: &str = "\
target_link_libraries(plc_@NAME@ INTERFACE
    \"$<IF:$<PLATFORM_ID:Windows>,ws2_32;userenv;ntdll,pthread;dl;m>\")
";

/// Install rules.
const INSTALL: &str = "\
install(TARGETS plc_@NAME@ EXPORT plc_@NAME@)
install(FILES @HEADERS@
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/plc_@NAME@)
install(EXPORT plc_@NAME@ NAMESPACE rungc:: FILE plc_@NAME@-config.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/plc_@NAME@)
";

/// Its main program.
const MAIN: &str = "
add_executable(plc_@NAME@_main @FOLDER@main.c)
set_target_properties(plc_@NAME@_main PROPERTIES OUTPUT_NAME @NAME@ C_STANDARD 99 C_EXTENSIONS OFF)
target_link_libraries(plc_@NAME@_main PRIVATE plc_@NAME@)
";

/// A `CMakeLists.txt` with a target for each program, of which none has the name of another; those that call the
/// runtime link this one.
pub(crate) fn cmake_lists(recipes: &[Recipe], runtime: &Runtime) -> String {
    let targets: Vec<String> = recipes
        .iter()
        .map(|recipe| format!("rungc::{}", recipe.name))
        .collect();
    let project = match recipes {
        [only] => format!("plc_{}", only.name),
        _ => "plc_programs".to_string(),
    };
    let mut text = format!(
        "# Libraries for add_subdirectory(), or for find_package() after `cmake --install`: {}.\n{}",
        targets.join(", "),
        PROJECT.replace("@PROJECT@", &project)
    );
    if runtime.is_library() {
        let std = recipes.iter().any(|recipe| recipe.shared.std);
        text.push_str(&runtime_of(Source::new(std), &project, "", TARGET));
    }
    for recipe in recipes {
        program(&mut text, recipe, &project, runtime);
    }
    text
}

/// CMake rules that build the runtime library from the sources in the folder `rungc-rt` of `root` (empty, or ending
/// with `/`): the file is `${rungc_rt}`, the target `PROJECT_runtime`. `target` sets `RUNGC_TARGET`.
pub fn runtime(project: &str, root: &str, target: &str) -> String {
    runtime_of(Source::new(false), project, root, target)
}

/// The same for a library of this crate.
fn runtime_of(source: &Source, project: &str, root: &str, target: &str) -> String {
    let folders = source.folders.iter();
    let folders: String = folders
        .map(|name| format!(" @ROOT@rungc-rt/{name}/*.rs"))
        .collect();
    source
        .in_text(RUNTIME)
        .replace("@FOLDERS@", &folders)
        .replace("@PROJECT@", project)
        .replace("@ROOT@", root)
        .replace("@TARGET@", target)
}

/// The targets of one program.
fn program(text: &mut String, recipe: &Recipe, project: &str, runtime: &Runtime) {
    let Recipe { name, folder, .. } = recipe;
    let sources = recipe.sources.iter().filter(|source| *source != "main.c");
    let parts = runtime.parts().filter(|_| recipe.shared.calls_runtime());
    let parts = parts.into_iter().flat_map(|parts| parts.paths(".c"));
    let sources = sources.map(|source| format!("{folder}{source}"));
    let sources: Vec<String> = sources.chain(parts.map(String::from)).collect();
    let own = recipe.headers.iter();
    let own = own
        .filter(|header| !header.ends_with("_internal.h"))
        .map(|header| format!("{folder}{header}"));
    let shared = recipe.shared.headers().map(String::from);
    let headers: Vec<String> = own.chain(shared).collect();
    let folders = match folder.trim_end_matches('/') {
        "" => vec!["${CMAKE_CURRENT_SOURCE_DIR}".to_string()],
        inside => vec![
            "${CMAKE_CURRENT_SOURCE_DIR}".to_string(),
            format!("${{CMAKE_CURRENT_SOURCE_DIR}}/{inside}"),
        ],
    };
    let mut includes = String::new();
    for folder in folders {
        let _ = writeln!(includes, "    $<BUILD_INTERFACE:{folder}>");
    }
    let library = LIBRARY
        .replace("@SOURCES@", &sources.join(" "))
        .replace("@FOLDERS@", &includes);
    text.push_str(&library.replace("@NAME@", name));
    if recipe.links_library(runtime) {
        let link = LINK_RUNTIME.replace("@PROJECT@", project);
        text.push_str(&link.replace("@NAME@", name));
    }
    if recipe.shared.std {
        text.push_str(&LINK_SYSTEM.replace("@NAME@", name));
    }
    let install = INSTALL.replace("@HEADERS@", &headers.join(" "));
    text.push_str(&install.replace("@NAME@", name));
    if recipe.main {
        let system = match recipe.has_thread() {
            true => "plc_@NAME@ pthread)",
            false => "plc_@NAME@)",
        };
        let main = MAIN
            .replace("@FOLDER@", folder)
            .replace("PRIVATE plc_@NAME@)", &format!("PRIVATE {system}"));
        text.push_str(&main.replace("@NAME@", name));
    }
}
