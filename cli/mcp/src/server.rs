//! Methods of the protocol.

use crate::arguments::{Arguments, schema};
use crate::files::Files;
use crate::protocol::{self, Fault, HANDSHAKE, Request, STATELESS, WITH_BATCHES, clipped};
use crate::tools::{self, Call, Tool};
use crate::{Options, prompts, resources};
use rungc_syntax::diag::did_you_mean;
use serde_json::{Map, Value, json};
use std::io;
use std::sync::atomic::AtomicBool;

/// What a client's assistant reads about this server.
const INSTRUCTIONS: &str = "\
Reads, checks, runs, tests and proves programs of Mitsubishi FX-family PLCs (also Inovance H1U, H2U, L01S, \
HM). Read the resource rungc://guide before you write a program. Programs are files below the folders of this \
server (argument `path`), or texts that you pass (argument `list`). After every change: `check`; then `run` \
or `test` shows what the program does, and `verify` proves what it never does. No PLC is reached, and no file \
is changed unless there is a tool `write`. A verdict of `verify` holds under the assumptions that it lists: \
repeat them. None of this replaces a safety assessment of the machine.";

/// Entries of a list that one answer has.
const LISTED: usize = 200;

/// A server with its client.
#[derive(Debug)]
pub(crate) struct Server<'o> {
    options: &'o Options,
    files: Files,
    /// The version that the handshake has agreed on.
    version: Option<&'static str>,
}

impl<'o> Server<'o> {
    /// A server.
    ///
    /// # Errors
    /// A folder that does not exist.
    pub(crate) fn new(options: &'o Options) -> io::Result<Self> {
        Ok(Server {
            options,
            files: Files::new(&options.roots, options.write.as_deref())?,
            version: None,
        })
    }

    /// Returns true if several messages may be one array.
    pub(crate) fn takes_batches(&self) -> bool {
        self.version == Some(WITH_BATCHES)
    }

    /// Answers a request. `stop` becomes true when it is cancelled.
    pub(crate) fn answer(&mut self, request: &Request, stop: &AtomicBool) -> Result<Value, Fault> {
        let method = request.method.as_str();
        let version = match request.version() {
            Some(STATELESS) if method == "initialize" => {
                return Err(Fault::unknown_version(STATELESS));
            }
            Some(STATELESS) => STATELESS,
            Some(other) => return Err(Fault::unknown_version(other)),
            None if method == "initialize" => return self.initialize(&request.params),
            None if method == "server/discover" => {
                let why = "name the version in `_meta`, or begin with `initialize`";
                return Err(Fault::wrong_params(why));
            }
            None => match self.version {
                Some(version) => version,
                None if method == "ping" => HANDSHAKE[0],
                None => return Err(Fault::not_a_message("begin with `initialize`")),
            },
        };
        let mut result = self.result(method, &request.params, version, stop)?;
        if version == STATELESS {
            protocol::complete(&mut result, method);
        }
        Ok(result)
    }

    fn initialize(&mut self, params: &Map<String, Value>) -> Result<Value, Fault> {
        let Some(wanted) = params.get("protocolVersion").and_then(Value::as_str) else {
            return Err(Fault::wrong_params(
                "`protocolVersion` is missing, such as \"2025-11-25\"",
            ));
        };
        let version = HANDSHAKE.into_iter().find(|version| *version == wanted);
        let version = version.unwrap_or(HANDSHAKE[0]);
        self.version = Some(version);
        Ok(json!({
            "protocolVersion": version,
            "capabilities": capabilities(),
            "serverInfo": protocol::server_info(),
            "instructions": INSTRUCTIONS,
        }))
    }

    fn result(
        &mut self,
        method: &str,
        params: &Map<String, Value>,
        version: &str,
        stop: &AtomicBool,
    ) -> Result<Value, Fault> {
        match method {
            "server/discover" if version == STATELESS => Ok(json!({
                "supportedVersions": [STATELESS],
                "capabilities": capabilities(),
                "instructions": INSTRUCTIONS,
            })),
            "ping" if version != STATELESS => Ok(json!({})),
            "tools/list" => {
                let tools: Vec<Value> = self.tools().map(description).collect();
                listed("tools", tools, params)
            }
            "tools/call" => self.call(params, stop),
            "resources/list" => listed("resources", resources::list(self.options), params),
            "resources/templates/list" => {
                listed("resourceTemplates", resources::templates(), params)
            }
            "resources/read" => {
                let uri = text(params, "uri")?;
                resources::read(self.options, uri)
                    .map_err(|why| Fault::no_resource(uri, &why, version))
            }
            "prompts/list" => listed("prompts", prompts::list(), params),
            "prompts/get" => {
                let name = text(params, "name")?;
                let given = params.get("arguments").and_then(Value::as_object);
                prompts::get(name, given).map_err(Fault::wrong_params)
            }
            _ => Err(Fault::unknown_method(method)),
        }
    }

    /// The tools that this server offers.
    fn tools(&self) -> impl Iterator<Item = &'static Tool> + use<> {
        let can_write = self.files.can_write();
        tools::ALL
            .iter()
            .copied()
            .filter(move |tool| can_write || !tool.writes)
    }

    fn call(&mut self, params: &Map<String, Value>, stop: &AtomicBool) -> Result<Value, Fault> {
        let name = text(params, "name")?;
        let Some(tool) = self.tools().find(|tool| tool.name == name) else {
            let near = did_you_mean(name, self.tools().map(|tool| tool.name));
            let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            return Err(Fault::wrong_params(format!(
                "there is no tool `{}`{hint}",
                clipped(name)
            )));
        };
        let given = match params.get("arguments") {
            None | Some(Value::Null) => Map::new(),
            Some(Value::Object(given)) => given.clone(),
            Some(_) => return Err(Fault::wrong_params("`arguments` is an object")),
        };
        let answer = Arguments::new(given, tool.parameters).and_then(|arguments| {
            let mut call = Call {
                arguments: &arguments,
                files: &mut self.files,
                options: self.options,
                stop,
            };
            (tool.call)(&mut call)
        });
        Ok(match answer {
            Ok(answer) => json!({
                "content": [{ "type": "text", "text": answer.text }],
                "structuredContent": answer.data,
                "isError": false,
            }),
            Err(why) => json!({ "content": [{ "type": "text", "text": why }], "isError": true }),
        })
    }
}

fn capabilities() -> Value {
    json!({ "tools": {}, "resources": {}, "prompts": {} })
}

/// A parameter that is a text.
fn text<'p>(params: &'p Map<String, Value>, name: &str) -> Result<&'p str, Fault> {
    let text = params.get(name).and_then(Value::as_str);
    text.ok_or_else(|| Fault::wrong_params(format!("`{name}` is missing, or not a text")))
}

/// A part of a list, from its cursor on.
fn listed(name: &str, all: Vec<Value>, params: &Map<String, Value>) -> Result<Value, Fault> {
    let offset = match params.get("cursor") {
        None | Some(Value::Null) => 0,
        Some(cursor) => {
            let number = cursor.as_str().and_then(|cursor| cursor.parse().ok());
            let number = number.filter(|number| *number <= all.len());
            number.ok_or_else(|| {
                Fault::wrong_params("this cursor is not one that the list has given")
            })?
        }
    };
    let (part, _, next) = crate::page::entries(all, offset, LISTED);
    let mut result = json!({ name: part });
    if let Some(next) = next {
        result["nextCursor"] = json!(next.to_string());
    }
    Ok(result)
}

fn description(tool: &Tool) -> Value {
    json!({
        "name": tool.name,
        "title": tool.title,
        "description": tool.text,
        "inputSchema": schema(tool.parameters),
        "outputSchema": (tool.output)(),
        "annotations": {
            "title": tool.title,
            "readOnlyHint": !tool.writes,
            "destructiveHint": false,
            "idempotentHint": !tool.writes,
            "openWorldHint": false,
        },
    })
}
