//! A session, from its first message to the end.

use crate::Ended;
use crate::breakpoints::Breakpoints;
use crate::debugger::{Debugger, Next};
use crate::launch::Launch;
use crate::protocol::{Initialize, Request};
use crate::run::Run;
use crate::wire::{Client, Incoming};
use serde_json::{Value, json};
use std::io::{self, Read, Write};

/// Identifier of the only filter of exceptions.
pub const PLC_ERRORS: &str = "plc-errors";

/// An editor with its breakpoints.
pub struct Editor {
    /// Lines are counted from 1, not from 0.
    pub lines_start_at1: bool,
    /// It shows variables again when it is asked to.
    pub takes_invalidated: bool,
    /// Its breakpoints.
    pub breakpoints: Breakpoints,
}

/// Serves one editor.
///
/// # Errors
/// Output that cannot be written.
pub fn serve(input: impl Read + Send + 'static, output: impl Write) -> io::Result<Ended> {
    let mut client = Client::new(input, output);
    let mut editor = Editor {
        lines_start_at1: true,
        takes_invalidated: false,
        breakpoints: Breakpoints::default(),
    };
    let mut is_initialized = false;
    while let Some(incoming) = client.receive() {
        let request = match incoming {
            Incoming::Request(request) => request,
            Incoming::Malformed(why) => {
                client.output("stderr", &why)?;
                continue;
            }
        };
        match request.command.as_str() {
            "initialize" => {
                let result = initialize(&request, &mut editor);
                is_initialized |= result.is_ok();
                client.respond(&request, result)?;
            }
            "disconnect" => {
                client.respond(&request, Ok(Value::Null))?;
                return Ok(Ended::Disconnected);
            }
            "launch" if is_initialized => {
                if let Some(ended) = launch(&mut client, &request, &mut editor)? {
                    return Ok(ended);
                }
            }
            _ => client.respond(&request, Err(too_early(&request, is_initialized)))?,
        }
    }
    Ok(Ended::Abandoned)
}

/// The error of a request before `launch`.
fn too_early(request: &Request, is_initialized: bool) -> String {
    match request.command.as_str() {
        "attach" => {
            "a debugger cannot attach to a PLC or to `rungc serve`: use `launch`".to_owned()
        }
        command if is_initialized => format!("`{command}`: no program is launched yet"),
        command => format!("`{command}`: begin with `initialize`"),
    }
}

fn initialize(request: &Request, editor: &mut Editor) -> Result<Value, String> {
    let arguments: Initialize = request.arguments()?;
    if arguments
        .path_format
        .as_deref()
        .is_some_and(|format| format != "path")
    {
        return Err("`pathFormat` must be \"path\"".to_owned());
    }
    editor.lines_start_at1 = arguments.lines_start_at1;
    editor.takes_invalidated = arguments.supports_invalidated_event;
    Ok(json!({
        "supportsConfigurationDoneRequest": true,
        "supportsConditionalBreakpoints": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsLogPoints": true,
        "supportsDataBreakpoints": true,
        "supportsBreakpointLocationsRequest": true,
        "supportsStepBack": true,
        "supportsSteppingGranularity": true,
        "supportsSetVariable": true,
        "supportsSetExpression": true,
        "supportsEvaluateForHovers": true,
        "supportsExceptionInfoRequest": true,
        "supportsRestartRequest": true,
        "supportsTerminateRequest": true,
        "supportTerminateDebuggee": true,
        "exceptionBreakpointFilters": [{
            "filter": PLC_ERRORS,
            "label": "PLC errors",
            "description": "Stop at an instruction with an operation error (M8067), and when the watchdog stops the PLC.",
            "default": true,
        }],
    }))
}

/// Launches programs until the session ends; `None` if the launch has failed.
fn launch<W: Write>(
    client: &mut Client<W>,
    request: &Request,
    editor: &mut Editor,
) -> io::Result<Option<Ended>> {
    let compiled = Launch::read(&request.arguments)
        .and_then(|launch| launch.compile().map(|program| (launch, program)));
    let (mut launch, mut program) = match compiled {
        Ok(compiled) => compiled,
        Err(why) => {
            client.respond(request, Err(why))?;
            return Ok(None);
        }
    };
    let mut is_again = false;
    loop {
        let run = match Run::new(&program, &launch) {
            Ok(run) => run,
            Err(why) if is_again => {
                client.output("important", &why)?;
                client.event("terminated", Value::Null)?;
                return Ok(None);
            }
            Err(why) => {
                client.respond(request, Err(why))?;
                return Ok(None);
            }
        };
        if !is_again {
            client.respond(request, Ok(Value::Null))?;
        }
        for name in &launch.unknown {
            client.output(
                "console",
                &format!("launch: the attribute `{name}` is unknown, and has no effect"),
            )?;
        }
        let debugger = Debugger::new(client, editor, run, &launch);
        match debugger.serve(is_again)? {
            Next::Ended(ended) => return Ok(Some(ended)),
            Next::Restart(again) => (launch, program) = *again,
        }
        is_again = true;
    }
}
