//! A library for Arduino: `library.properties`, sources in `src`, a sketch among its examples.

use super::example::{self, Style};
use super::{Library, Package};
use crate::template;
use rungc_emit::OutFile;

/// The example in C++, for Arduino and for PlatformIO with Arduino's framework. Pins 0 and 1 are the serial port.
pub(crate) const CPP: Style = Style {
    template: template!("package/arduino.cpp"),
    edges: template!("package/arduino_edges.cpp"),
    pins: &[
        2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19,
    ],
    none: "NOT_CONNECTED",
    one_handler: false,
};

/// The folders of `src` where Arduino looks for a library that is built for a processor.
fn precompiled(triple: &str) -> &'static str {
    match triple {
        "thumbv6m-none-eabi" => "cortex-m0plus",
        "thumbv7m-none-eabi" => "cortex-m3",
        "thumbv7em-none-eabihf" => "cortex-m4/fpv4-sp-d16-hard",
        _ => "cortex-m4",
    }
}

/// The library's folder.
pub fn folder(package: Package) -> Vec<OutFile<Vec<u8>>> {
    let name = package.name().to_string();
    let sketch = format!("examples/{name}/{name}.ino");
    let title = format!("// {name}.ino: runs the PLC program {name} on an Arduino.\n");
    let mut files = vec![
        OutFile::new("library.properties", properties(&package)),
        OutFile::new(sketch, title + &example::source(&package, &CPP)),
    ];
    files.extend(package.files.into_iter().map(|file| file.inside("src")));
    let mut files: Vec<_> = files.into_iter().map(OutFile::from).collect();
    if let Some(Library { triple, contents }) = package.library {
        files.push(OutFile {
            path: format!("src/{}/librungc_rt.a", precompiled(triple)),
            contents,
        });
    }
    files
}

/// Description of a library for Arduino.
fn properties(package: &Package) -> String {
    let name = package.name();
    let link = match package.library {
        Some(_) => "precompiled=true\nldflags=-lrungc_rt\n",
        None => "",
    };
    format!(
        "name={name}\nversion={}\nauthor=rungc\nmaintainer=rungc\nsentence={}\nparagraph=See examples/{name}.\ncategory=Device Control\n\
         url={}\narchitectures=*\nincludes={name}_board.h\n{link}",
        env!("CARGO_PKG_VERSION"),
        package.sentence(),
        env!("CARGO_PKG_REPOSITORY"),
    )
}
