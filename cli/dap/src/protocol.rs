//! Requests of the protocol, and the arguments that this adapter reads.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// A request.
#[derive(Clone, Debug)]
pub struct Request {
    /// Its number.
    pub seq: u64,
    /// Its command.
    pub command: String,
    /// Its arguments.
    pub arguments: Map<String, Value>,
}

impl Request {
    /// Reads a request.
    ///
    /// # Errors
    /// The reason why a message is not a request.
    pub fn read(body: &[u8]) -> Result<Request, String> {
        let message: Value = serde_json::from_slice(body)
            .map_err(|error| format!("a message is not JSON: {error}"))?;
        let kind = message.get("type").and_then(Value::as_str);
        if kind != Some("request") {
            return Err("a message is not a request: its `type` is not \"request\"".to_owned());
        }
        let seq = message.get("seq").and_then(Value::as_u64);
        let command = message.get("command").and_then(Value::as_str);
        let (Some(seq), Some(command)) = (seq, command) else {
            return Err("a request has no valid `seq` or `command`".to_owned());
        };
        let arguments = match message.get("arguments") {
            None | Some(Value::Null) => Map::new(),
            Some(Value::Object(arguments)) => arguments.clone(),
            Some(_) => return Err(format!("`arguments` of `{command}` is not an object")),
        };
        Ok(Request {
            seq,
            command: command.to_owned(),
            arguments,
        })
    }

    /// Its arguments.
    ///
    /// # Errors
    /// One that is missing, or of another type.
    pub fn arguments<T: DeserializeOwned>(&self) -> Result<T, String> {
        serde_json::from_value(Value::Object(self.arguments.clone()))
            .map_err(|error| format!("`{}`: {error}", self.command))
    }
}

/// Arguments of `initialize`.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct Initialize {
    /// Lines are counted from 1, not from 0.
    #[serde(default = "yes")]
    pub lines_start_at1: bool,
    /// The client knows the event `invalidated`.
    #[serde(default)]
    pub supports_invalidated_event: bool,
    /// `path` or `uri`.
    #[serde(default)]
    pub path_format: Option<String>,
}

fn yes() -> bool {
    true
}

/// A file, or a listing of this adapter.
#[derive(Deserialize, Clone, Debug, Default)]
#[serde(rename_all = "camelCase")]
pub struct SourceArguments {
    /// Path of the file.
    #[serde(default)]
    pub path: Option<String>,
    /// Number of the listing.
    #[serde(default)]
    pub source_reference: Option<i64>,
}

/// Arguments of `setBreakpoints`.
#[derive(Deserialize, Debug)]
pub struct SetBreakpoints {
    /// Their place.
    pub source: SourceArguments,
    /// All of the source.
    #[serde(default)]
    pub breakpoints: Vec<SourceBreakpoint>,
}

/// A breakpoint at a line.
#[derive(Deserialize, Clone, Debug)]
#[serde(rename_all = "camelCase")]
pub struct SourceBreakpoint {
    /// The line.
    pub line: i64,
    /// Condition.
    #[serde(default)]
    pub condition: Option<String>,
    /// Condition on the number of hits.
    #[serde(default)]
    pub hit_condition: Option<String>,
    /// Message that is logged instead of stopping.
    #[serde(default)]
    pub log_message: Option<String>,
}

/// Arguments of `breakpointLocations`.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct BreakpointLocations {
    /// The file.
    pub source: SourceArguments,
    /// First line.
    pub line: i64,
    /// Last line.
    #[serde(default)]
    pub end_line: Option<i64>,
}

/// Arguments of `setDataBreakpoints`.
#[derive(Deserialize, Debug)]
pub struct SetDataBreakpoints {
    /// All of them.
    pub breakpoints: Vec<DataBreakpointArguments>,
}

/// A breakpoint on a device.
#[derive(Deserialize, Clone, Debug)]
#[serde(rename_all = "camelCase")]
pub struct DataBreakpointArguments {
    /// The device.
    pub data_id: String,
    /// `write`, or what this adapter does not offer.
    #[serde(default)]
    pub access_type: Option<String>,
    /// Condition.
    #[serde(default)]
    pub condition: Option<String>,
    /// Condition on the number of hits.
    #[serde(default)]
    pub hit_condition: Option<String>,
}

/// Arguments of `dataBreakpointInfo`.
#[derive(Deserialize, Debug)]
pub struct DataBreakpointInfo {
    /// Name of a variable, or an expression.
    pub name: String,
}

/// Arguments of `setExceptionBreakpoints`.
#[derive(Deserialize, Debug)]
pub struct SetExceptionBreakpoints {
    /// The filters that are on.
    #[serde(default)]
    pub filters: Vec<String>,
}

/// Arguments of `stackTrace`.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct StackTrace {
    /// The thread.
    pub thread_id: i64,
    /// Index of the first frame wanted.
    #[serde(default)]
    pub start_frame: Option<i64>,
}

/// Arguments of `variables`.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct Variables {
    /// The scope.
    pub variables_reference: i64,
    /// Index of the first one wanted.
    #[serde(default)]
    pub start: Option<i64>,
    /// Number wanted; all if it is 0 or missing.
    #[serde(default)]
    pub count: Option<i64>,
}

/// Arguments of `setVariable`.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct SetVariable {
    /// The scope.
    pub variables_reference: i64,
    /// Name of the variable.
    pub name: String,
    /// Its new value.
    pub value: String,
}

/// Arguments of `setExpression`.
#[derive(Deserialize, Debug)]
pub struct SetExpression {
    /// The device.
    pub expression: String,
    /// Its new value.
    pub value: String,
}

/// Arguments of `evaluate`.
#[derive(Deserialize, Debug)]
pub struct Evaluate {
    /// A device, a condition or a command.
    pub expression: String,
    /// `repl`, `watch`, `hover` and others.
    #[serde(default)]
    pub context: Option<String>,
}

/// Arguments of requests of a thread.
#[derive(Deserialize, Debug)]
#[serde(rename_all = "camelCase")]
pub struct OfThread {
    /// The thread.
    pub thread_id: i64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_request_is_an_error() {
        for (body, why) in [
            ("", "not JSON"),
            ("[]", "not a request"),
            (r#"{"type":"event"}"#, "not a request"),
            (
                r#"{"type":"request","seq":1}"#,
                "no valid `seq` or `command`",
            ),
            (
                r#"{"type":"request","seq":-1,"command":"a"}"#,
                "no valid `seq` or `command`",
            ),
            (
                r#"{"type":"request","seq":1,"command":"a","arguments":[1]}"#,
                "not an object",
            ),
        ] {
            let error = Request::read(body.as_bytes()).unwrap_err();
            assert!(error.contains(why), "{body}: {error}");
        }
    }
}
