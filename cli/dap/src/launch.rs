//! Arguments of `launch`.

use rungc::{Options, Program, Project, Value};
use serde_json::{Map, Value as Json};
use std::path::PathBuf;

/// Longest scan, in milliseconds.
const MAX_SCAN_MS: u64 = 60_000;

/// Attributes that editors add to those of this adapter.
const OF_EDITORS: [&str; 12] = [
    "name",
    "type",
    "request",
    "preLaunchTask",
    "postDebugTask",
    "internalConsoleOptions",
    "debugServer",
    "presentation",
    "serverReadyAction",
    "suppressMultipleSessionWarning",
    "cwd",
    "args",
];

/// Settings of a launch.
#[derive(Clone, Debug)]
pub struct Launch {
    /// File of the program, or a folder with one.
    pub program: PathBuf,
    model: Option<String>,
    /// Duration of a scan.
    pub scan_ms: Option<u64>,
    /// Stop before the first scan.
    pub stop_on_entry: bool,
    /// Virtual time passes no faster than real time.
    pub real_time: bool,
    /// Devices that have a value at power-on.
    pub inputs: Vec<(String, Value)>,
    /// Run without breakpoints.
    pub no_debug: bool,
    /// Attributes that nothing reads.
    pub unknown: Vec<String>,
}

impl Launch {
    /// Reads the arguments.
    ///
    /// # Errors
    /// One that is missing or wrong.
    pub fn read(arguments: &Map<String, Json>) -> Result<Launch, String> {
        let mut launch = Launch {
            program: PathBuf::new(),
            model: None,
            scan_ms: None,
            stop_on_entry: false,
            real_time: true,
            inputs: Vec::new(),
            no_debug: false,
            unknown: Vec::new(),
        };
        for (name, value) in arguments.iter().filter(|(_, value)| !value.is_null()) {
            match name.as_str() {
                "program" => launch.program = PathBuf::from(text(name, value)?),
                "model" => launch.model = Some(text(name, value)?.to_owned()),
                "scan" => launch.scan_ms = Some(scan(value)?),
                "stopOnEntry" => launch.stop_on_entry = flag(name, value)?,
                "realTime" => launch.real_time = flag(name, value)?,
                "noDebug" => launch.no_debug = flag(name, value)?,
                "inputs" => launch.inputs = inputs(value)?,
                name if name.starts_with("__") || OF_EDITORS.contains(&name) => {}
                name => launch.unknown.push(name.to_owned()),
            }
        }
        if launch.program.as_os_str().is_empty() {
            return Err(
                "`program` is missing: the file of the program, or a folder with one".to_owned(),
            );
        }
        Ok(launch)
    }

    /// Compiles the program.
    ///
    /// # Errors
    /// What cannot be read, a PLC that does not exist, errors of the program.
    pub fn compile(&self) -> Result<Program, String> {
        let options = Options {
            model: self.model.clone(),
            ..Options::default()
        };
        let project = Project::open_with(&self.program, &options);
        let compiled = project.and_then(|project| project.check().compile());
        compiled.map_err(|error| error.to_string())
    }
}

fn text<'v>(name: &str, value: &'v Json) -> Result<&'v str, String> {
    value
        .as_str()
        .ok_or_else(|| format!("`{name}` is a text, not {value}"))
}

fn flag(name: &str, value: &Json) -> Result<bool, String> {
    value
        .as_bool()
        .ok_or_else(|| format!("`{name}` is true or false, not {value}"))
}

fn scan(value: &Json) -> Result<u64, String> {
    let ms = value.as_u64().filter(|ms| (1..=MAX_SCAN_MS).contains(ms));
    ms.ok_or_else(|| {
        format!("`scan` is the duration of a scan, 1 to {MAX_SCAN_MS} ms, not {value}")
    })
}

fn inputs(value: &Json) -> Result<Vec<(String, Value)>, String> {
    let wrong = || {
        format!(
            "`inputs` is an object with values by devices, such as (\"X000\": true), not {value}"
        )
    };
    let object = value.as_object().ok_or_else(wrong)?;
    let inputs = object.iter().map(|(name, value)| {
        let value = match value {
            Json::Bool(on) => Value::Bit(*on),
            Json::Number(number) => Value::Float(number.as_f64().ok_or_else(wrong)?),
            _ => {
                return Err(format!(
                    "`inputs`: the value of `{name}` is a number or a truth value, not {value}"
                ));
            }
        };
        Ok((name.clone(), value))
    });
    inputs.collect()
}
