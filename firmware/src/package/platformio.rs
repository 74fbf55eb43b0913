//! A library for PlatformIO: `library.json`, sources in `src`, a project among its examples.

use super::arduino::CPP;
use super::example;
use super::{Library, Package};
use rungc_emit::OutFile;

/// The example's project; NAME is the program's. The library is linked, not copied, as long as it is in this place.
const PROJECT: &str = "\
[env]
framework = arduino
lib_deps = NAME=symlink://../..

[env:uno]
platform = atmelavr
board = uno

[env:nucleo_f446re]
platform = ststm32
board = nucleo_f446re
";

/// The library's folder.
pub fn folder(package: Package) -> Vec<OutFile<Vec<u8>>> {
    let name = package.name().to_string();
    let main = format!(
        "// Runs the PLC program {name} with Arduino's framework.\n#include <Arduino.h>\n{}",
        example::source(&package, &CPP)
    );
    let example = format!("examples/{name}");
    let mut files = vec![
        OutFile::new("library.json", manifest(&package)),
        OutFile::new("platformio.ini", PROJECT.replace("NAME", &name)).inside(&example),
        OutFile::new("src/main.cpp", main).inside(&example),
    ];
    files.extend(package.files.into_iter().map(|file| file.inside("src")));
    let mut files: Vec<_> = files.into_iter().map(OutFile::from).collect();
    if let Some(Library { contents, .. }) = package.library {
        files.push(OutFile {
            path: "lib/librungc_rt.a".to_string(),
            contents,
        });
    }
    files
}

/// Description of a library for PlatformIO.
fn manifest(package: &Package) -> String {
    let name = package.name();
    let link = match package.library {
        Some(_) => ", \"-Llib\", \"-lrungc_rt\"",
        None => "",
    };
    format!(
        "{{\n  \"name\": \"{name}\",\n  \"version\": \"{}\",\n  \"description\": \"{}\",\n  \"keywords\": \"plc\",\n  \
         \"frameworks\": \"*\",\n  \"platforms\": \"*\",\n  \"headers\": \"{name}_board.h\",\n  \
         \"build\": {{\"flags\": [\"-ffp-contract=off\"{link}]}},\n  \
         \"examples\": [{{\"name\": \"{name}\", \"base\": \"examples/{name}\", \"files\": [\"src/main.cpp\", \"platformio.ini\"]}}]\n}}\n",
        env!("CARGO_PKG_VERSION"),
        package.sentence(),
    )
}
