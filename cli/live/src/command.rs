//! Commands of the page.

use serde::Deserialize;

// Variants without fields are structs, so that unknown fields are rejected there, too.
/// Command of the page. Devices have the names of test files: `M0`, `D0.i32`, `T0.value`.
#[derive(Clone, PartialEq, Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Command {
    /// Puts the PLC in RUN.
    Run {},
    /// Puts the PLC in STOP.
    Stop {},
    /// Lets time stand still after the scan that is executed.
    Pause {},
    /// Lets time pass again.
    Continue {},
    /// Executes this number of scans, and lets time stand still after them.
    Scan {
        /// From 1.
        count: u32,
    },
    /// Goes back by this number of scans, and lets time stand still there.
    Back {
        /// From 1.
        count: u32,
    },
    /// Lets time pass slower, or at its own speed.
    Pace {
        /// Slowdown: seconds per second of the program, from 1 to 1000.
        slower: u32,
    },
    /// Sets a device once.
    Set {
        /// Its name.
        device: String,
        /// 0 or 1, or a number.
        value: f64,
    },
    /// Holds a device at a value: it is written before and after each scan.
    Force {
        /// Its name.
        device: String,
        /// 0 or 1, or a number.
        value: f64,
    },
    /// Releases a forced device.
    Release {
        /// Its name.
        device: String,
    },
    /// Releases all forced devices.
    ReleaseAll {},
    /// Adds a device to the watch list.
    Watch {
        /// Its name.
        device: String,
    },
    /// Removes a device from the watch list.
    Unwatch {
        /// Its name.
        device: String,
    },
    /// Lets time stand still after the scan in which a device changes, or comes to a value.
    BreakOnDevice {
        /// Its name.
        device: String,
        /// The value; without one, any change counts.
        value: Option<f64>,
    },
    /// Lets time stand still after the scan in which power reaches an output of a network.
    BreakOnNetwork {
        /// Its number, from 1.
        network: usize,
    },
    /// Removes a breakpoint.
    Unbreak {
        /// Its place in the list, from 0.
        index: usize,
    },
}

impl Command {
    /// Returns true if it changes the PLC.
    pub fn changes_plc(&self) -> bool {
        match self {
            Command::Run {}
            | Command::Stop {}
            | Command::Set { .. }
            | Command::Force { .. }
            | Command::Release { .. }
            | Command::ReleaseAll {} => true,
            Command::Pause {}
            | Command::Continue {}
            | Command::Scan { .. }
            | Command::Back { .. }
            | Command::Pace { .. }
            | Command::Watch { .. }
            | Command::Unwatch { .. }
            | Command::BreakOnDevice { .. }
            | Command::BreakOnNetwork { .. }
            | Command::Unbreak { .. } => false,
        }
    }

    /// Reads a command; the error describes the problem.
    pub(crate) fn read(json: &[u8]) -> Result<Command, String> {
        // Serde would take a list for an object.
        if json.trim_ascii_start().first() != Some(&b'{') {
            return Err(r#"a command is an object, such as {"do": "run"}"#.to_string());
        }
        serde_json::from_slice(json).map_err(|error: serde_json::Error| match error.is_eof() {
            true => "the end of the command is missing".to_string(),
            false => in_words_of_json(&error.to_string()),
        })
    }
}

/// Names of Serde, and what a client calls them.
const WORDS: [(&str, &str); 8] = [
    (", there are no fields", "; this command has no other"),
    (
        "expected variant identifier",
        "expected the name of a command",
    ),
    ("expected f64", "expected a number"),
    ("expected u32", "expected a whole number from 0"),
    ("expected usize", "expected a whole number from 0"),
    ("invalid type: sequence", "invalid type: array"),
    ("invalid type: map", "invalid type: object"),
    ("unknown variant", "unknown command"),
];

/// An error without names of Rust and Serde.
fn in_words_of_json(error: &str) -> String {
    WORDS.iter().fold(error.to_string(), |text, (ours, words)| {
        text.replace(ours, words)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_objects() {
        let read = |json: &str| Command::read(json.as_bytes());
        assert_eq!(read(r#" {"do": "run"}"#), Ok(Command::Run {}));
        let object = r#"a command is an object, such as {"do": "run"}"#;
        for (json, error) in [
            (r#"["run"]"#, object),
            (r#"["set", "M0", 1]"#, object),
            (r#""run""#, object),
            ("1", object),
            ("", object),
            ("{}", "missing field `do`"),
            (r#"{"do": "run""#, "the end of the command is missing"),
            (
                r#"{"do": "run", "x": 1}"#,
                "unknown field `x`; this command has no other",
            ),
            (r#"{"do": ["run"]}"#, "expected the name of a command"),
            (r#"{"do": "fly"}"#, "unknown command `fly`"),
            (r#"{"do": "set", "device": "M0"}"#, "missing field `value`"),
            (
                r#"{"do": "set", "device": "M0", "value": "1"}"#,
                "expected a number",
            ),
            (
                r#"{"do": "scan", "count": -1}"#,
                "expected a whole number from 0",
            ),
            (
                r#"{"do": "unbreak", "index": [0]}"#,
                "invalid type: array, expected a whole number from 0",
            ),
        ] {
            let message = read(json).unwrap_err();
            assert!(message.contains(error), "{json}: {message}");
            let internals = [
                "enum", "variant", "f64", "u32", "usize", "tagged", "sequence",
            ];
            let shown = internals.iter().find(|word| message.contains(**word));
            assert_eq!(shown, None, "{json}: {message}");
        }
    }
}
