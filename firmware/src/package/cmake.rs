//! Folders for build systems that are made of CMake: a module of Zephyr, a component of ESP-IDF. Both build the runtime
//! library of a program that calls it with cargo.

use super::Package;
use super::example::{self, Style, Terminal};
use crate::template;
use rungc_codegen_c::cmake_runtime;
use rungc_emit::OutFile;
use std::fmt::Write;

/// The example for Zephyr: its devicetree has the pins.
const ZEPHYR: Style = Style {
    template: template!("package/zephyr.c"),
    edges: template!("package/zephyr_edges.c"),
    pins: &[],
    none: "",
    one_handler: true,
};

/// The example for ESP-IDF: pins of an ESP32 that nothing on a module needs.
const ESP_IDF: Style = Style {
    template: template!("package/esp_idf.c"),
    edges: template!("package/esp_idf_edges.c"),
    pins: &[4, 13, 14, 16, 17, 18, 19, 21, 22, 23, 25, 26, 27, 32, 33],
    none: "GPIO_NUM_NC",
    one_handler: true,
};

/// Names of ESP-IDF's processors in rustc.
const ESP_TARGETS: &str = "\
# Xtensa cores need Espressif's Rust toolchain.
if(IDF_TARGET MATCHES \"^esp32(c2|c3)$\")
    set(RUNGC_TARGET riscv32imc-unknown-none-elf)
elseif(IDF_TARGET MATCHES \"^esp32(c5|c6|c61|h2)$\")
    set(RUNGC_TARGET riscv32imac-unknown-none-elf)
elseif(IDF_TARGET STREQUAL \"esp32p4\")
    set(RUNGC_TARGET riscv32imafc-unknown-none-elf)
else()
    set(RUNGC_TARGET xtensa-${IDF_TARGET}-none-elf)
endif()";

/// A module of Zephyr, with a sample.
pub fn zephyr(package: Package) -> Vec<OutFile<Vec<u8>>> {
    let name = package.name().to_string();
    let option = format!("PLC_{}", name.to_ascii_uppercase());
    let runtime = !package.runtime.is_empty();
    let sources: Vec<String> = package.sources().map(|path| format!("../{path}")).collect();
    let mut lists = format!(
        "if(CONFIG_{option})\n    zephyr_library_named(plc_{name})\n    zephyr_library_sources({})\n    \
         zephyr_library_compile_options(-ffp-contract=off)\n    zephyr_include_directories(..)\n",
        sources.join(" ")
    );
    let mut config = format!(
        "config {option}\n\tbool \"{}\"\n\tdefault y\n",
        package.sentence()
    );
    if runtime {
        let target = format!("{option}_RUST_TARGET");
        let set = format!("set(RUNGC_TARGET ${{CONFIG_{target}}})");
        lists += &cmake_runtime(&name, "../", &set);
        let _ = writeln!(
            lists,
            "    add_dependencies(plc_{name} {name}_runtime)\n    zephyr_link_libraries(${{rungc_rt}})"
        );
        let _ = write!(
            config,
            "\nconfig {target}\n\tstring \"Target of the runtime library, as rustc names it\"\n\tdepends on {option}\n\
             \tdefault \"thumbv6m-none-eabi\" if CPU_CORTEX_M0 || CPU_CORTEX_M0PLUS\n\tdefault \"thumbv7m-none-eabi\" if CPU_CORTEX_M3\n\
             \tdefault \"thumbv7em-none-eabihf\" if FPU\n\tdefault \"thumbv7em-none-eabi\"\n"
        );
    }
    lists.push_str("endif()\n");
    let sample = format!("samples/{name}");
    let module = format!(
        "name: plc_{name}\nbuild:\n  cmake: zephyr\n  kconfig: zephyr/Kconfig\nsamples:\n  - {sample}\n"
    );
    let project = format!(
        "cmake_minimum_required(VERSION 3.20)\nlist(APPEND ZEPHYR_EXTRA_MODULES ${{CMAKE_CURRENT_SOURCE_DIR}}/../..)\n\
         find_package(Zephyr REQUIRED HINTS $ENV{{ZEPHYR_BASE}})\nproject({name})\ntarget_sources(app PRIVATE src/main.c)\n"
    );
    let [inputs, outputs] = example::pins(&package, &[]);
    let numbers = |terminals: &[Terminal]| {
        let numbers = terminals.iter().map(|at| format!("{}, ", at.number));
        numbers.collect::<String>()
    };
    let main = example::fill(&package, &ZEPHYR, &numbers(&inputs), &numbers(&outputs));
    let files = vec![
        OutFile::new("zephyr/module.yml", module),
        OutFile::new("zephyr/CMakeLists.txt", lists),
        OutFile::new("zephyr/Kconfig", config),
        OutFile::new("CMakeLists.txt", project).inside(&sample),
        OutFile::new("prj.conf", "CONFIG_GPIO=y\n").inside(&sample),
        OutFile::new("app.overlay", overlay(&inputs, &outputs)).inside(&sample),
        OutFile::new("src/main.c", main).inside(&sample),
    ];
    with_sources(files, package)
}

/// The pins of the sample's terminals.
fn overlay(inputs: &[Terminal], outputs: &[Terminal]) -> String {
    let mut text = String::from(
        "/* The pins are an example: change them for your board. */\n/ {\n\tzephyr,user {\n",
    );
    let sides = [
        (inputs, "input", "GPIO_ACTIVE_LOW | GPIO_PULL_UP", 0),
        (outputs, "output", "GPIO_ACTIVE_HIGH", inputs.len()),
    ];
    for (terminals, side, flags, first) in sides {
        for (i, terminal) in terminals.iter().enumerate() {
            let before = match i {
                0 => format!("{side}-gpios = "),
                _ => "\t".to_string(),
            };
            let after = if i + 1 < terminals.len() { "," } else { ";" };
            let _ = writeln!(
                text,
                "\t\t{before}<&gpio0 {} ({flags})>{after} /* {} */",
                first + i,
                terminal.name
            );
        }
    }
    text.push_str("\t};\n};\n");
    text
}

/// A component of ESP-IDF, with an example.
pub fn esp_idf(package: Package) -> Vec<OutFile<Vec<u8>>> {
    let name = package.name().to_string();
    let sources: Vec<String> = package
        .sources()
        .map(|path| format!("\"{path}\""))
        .collect();
    let mut lists = format!(
        "idf_component_register(SRCS {} INCLUDE_DIRS \".\")\ntarget_compile_options(${{COMPONENT_LIB}} PRIVATE -ffp-contract=off)\n",
        sources.join(" ")
    );
    if !package.runtime.is_empty() {
        lists += &cmake_runtime(&name, "", ESP_TARGETS);
        let _ = write!(
            lists,
            "add_dependencies(${{COMPONENT_LIB}} {name}_runtime)\ntarget_link_libraries(${{COMPONENT_LIB}} INTERFACE ${{rungc_rt}})\n"
        );
    }
    let example = format!("examples/{name}");
    let manifest = format!(
        "version: \"{}\"\ndescription: {}\nurl: {}\nexamples:\n  - path: ./{example}\ndependencies:\n  idf: \">=5.0\"\n",
        env!("CARGO_PKG_VERSION"),
        package.sentence(),
        env!("CARGO_PKG_REPOSITORY"),
    );
    let project = format!(
        "cmake_minimum_required(VERSION 3.16)\nset(EXTRA_COMPONENT_DIRS ../..)\ninclude($ENV{{IDF_PATH}}/tools/cmake/project.cmake)\n\
         project({name}_example)\n"
    );
    let files = vec![
        OutFile::new("CMakeLists.txt", lists),
        OutFile::new("idf_component.yml", manifest),
        OutFile::new("CMakeLists.txt", project).inside(&example),
        OutFile::new(
            "main/CMakeLists.txt",
            "idf_component_register(SRCS \"main.c\")\n",
        )
        .inside(&example),
        OutFile::new("main/main.c", example::source(&package, &ESP_IDF)).inside(&example),
    ];
    with_sources(files, package)
}

/// The files with the program's sources and those of the runtime.
fn with_sources(files: Vec<OutFile>, package: Package) -> Vec<OutFile<Vec<u8>>> {
    let files = files
        .into_iter()
        .chain(package.files)
        .chain(package.runtime);
    files.map(OutFile::from).collect()
}
