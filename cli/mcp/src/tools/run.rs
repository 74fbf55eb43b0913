//! `run`: what a program does over time.

use super::{Answer, Call, OFFSET, PROGRAM, Tool, anything, integer, list, object, paged, string};
use crate::arguments::{Input, Kind, Parameter};
use crate::page;
use rungc::{Plc, Value as Reading};
use serde_json::{Map, Value, json};
use std::time::{Duration, Instant};

/// Most rows of an answer.
const ROWS: usize = 200;

/// Devices that are watched if none are named.
const USUAL: usize = 12;

/// Most devices that are watched.
const MOST_WATCHED: usize = 64;

/// Time on the clock after which a run ends.
const LIMIT: Duration = Duration::from_secs(60);

/// What is set when.
pub(super) const INPUTS: Parameter = Parameter::optional(
    "inputs",
    Kind::Inputs,
    "what is set when, in virtual time: [{\"at_ms\": 0, \"set\": {\"X000\": true}}, {\"at_ms\": 500, \"set\": \
    {\"X000\": false}}]; inputs keep their state; names are devices or comments",
);

const PARAMETERS: &[Parameter] = &[
    INPUTS,
    Parameter::optional(
        "watch",
        Kind::Texts,
        "devices whose values are shown, such as [\"Y000\", \"T0\", \"D0.i32\", \"D2.f32\", \"start \
        button\"]; default: outputs and what the program writes",
    ),
    Parameter::optional(
        "for_ms",
        Kind::Whole(1, 3_600_000),
        "length of the run in milliseconds; default: 1000",
    ),
    OFFSET,
];

pub(super) const TOOL: Tool = Tool {
    name: "run",
    title: "Run a program",
    text: "Runs a program in virtual time on the reference interpreter, from power-on, with inputs that you \
    set, and shows the values of devices after each scan in which one of them changed. A scan takes 10 ms \
    unless the program says otherwise. The same call gives the same run. Special modules and simulated \
    machines are for `test`.",
    parameters: &[PROGRAM, PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    let mut all = vec![
        ("file", string()),
        ("watched", list(string())),
        (
            "rows",
            list(object(&[("at_ms", integer()), ("values", anything())])),
        ),
        ("ended_ms", integer()),
        ("running", json!({ "type": "boolean" })),
        ("operation_errors", list(anything())),
    ];
    all.extend(paged());
    object(&all)
}

/// The rows of a trace that are shown.
struct Rows {
    offset: usize,
    shown: Vec<(u64, Vec<Reading>)>,
    total: usize,
    last: Option<Vec<Reading>>,
}

impl Rows {
    fn take(&mut self, at_ms: u64, values: Vec<Reading>) {
        if self.last.as_ref() == Some(&values) {
            return;
        }
        if (self.offset..self.offset.saturating_add(ROWS)).contains(&self.total) {
            self.shown.push((at_ms, values.clone()));
        }
        self.total += 1;
        self.last = Some(values);
    }
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.whole()?;
    let program = super::compiled(&project)?;
    let inputs = call.arguments.inputs("inputs");
    let for_ms = call.arguments.whole("for_ms").unwrap_or(1_000);
    let mut plc = program.start();
    let watched = watched(call, &mut plc, &inputs)?;
    let mut rows = Rows {
        offset: call.offset(),
        shown: Vec::new(),
        total: 0,
        last: None,
    };
    until(call, &mut plc, &inputs, for_ms, |plc, at_ms| {
        rows.take(at_ms, values(plc, &watched)?);
        Ok(())
    })?;
    let file = call.name(&project);
    Ok(answer(&file, &watched, &rows, &plc))
}

/// Runs a PLC for a time, and sets what is to be set; `scanned` gets each scan and the time at which it began.
///
/// # Errors
/// Devices that cannot be set, a cancelled call, a run that takes too long.
pub(super) fn until(
    call: &Call,
    plc: &mut Plc,
    inputs: &[Input],
    end_ms: u64,
    mut scanned: impl FnMut(&Plc, u64) -> Result<(), String>,
) -> Result<(), String> {
    let ms = |plc: &Plc| plc.now().as_millis() as u64;
    let begin = Instant::now();
    let mut pending = inputs;
    loop {
        let now_ms = ms(plc);
        while let Some((input, rest)) = pending.split_first()
            && input.at_ms <= now_ms
        {
            set(plc, input)?;
            pending = rest;
        }
        if now_ms >= end_ms {
            break;
        }
        if call.is_cancelled() {
            return Err("the call was cancelled".to_owned());
        }
        if begin.elapsed() > LIMIT {
            return Err(format!(
                "the run was ended at {now_ms} ms: it took a minute; ask for a shorter `for_ms`"
            ));
        }
        let next = pending
            .first()
            .map_or(end_ms, |input| input.at_ms.min(end_ms));
        let scan_ms = plc.until_next_scan().as_millis() as u64;
        plc.run_for(Duration::from_millis(
            scan_ms.clamp(1, (next - now_ms).max(1)),
        ));
        scanned(plc, now_ms)?;
    }
    match pending.first() {
        Some(late) => Err(format!(
            "`inputs`: {} ms is after the end of the run, {end_ms} ms",
            late.at_ms
        )),
        None => Ok(()),
    }
}

fn set(plc: &mut Plc, input: &Input) -> Result<(), String> {
    for (name, value) in &input.set {
        let set = match value {
            Value::Bool(on) => plc.set(name, *on),
            Value::Number(number) => match (number.as_i64(), number.as_f64()) {
                (Some(integer), _) => plc.set(name, integer),
                (None, number) => plc.set(name, number.unwrap_or_default()),
            },
            _ => continue,
        };
        set.map_err(|error| format!("`inputs`, at {} ms: {error}", input.at_ms))?;
    }
    Ok(())
}

/// Names of the devices that are shown.
fn watched(call: &Call, plc: &mut Plc, inputs: &[Input]) -> Result<Vec<String>, String> {
    let named = call.arguments.texts("watch");
    if named.is_empty() {
        let set: Vec<&str> = inputs
            .iter()
            .flat_map(|input| &input.set)
            .map(|(name, _)| name.as_str())
            .collect();
        return Ok(plc.usual_watch(USUAL, &set));
    }
    if named.len() > MOST_WATCHED {
        return Err(format!("`watch`: name at most {MOST_WATCHED} devices"));
    }
    values(plc, &named)?;
    Ok(named)
}

fn values(plc: &Plc, names: &[String]) -> Result<Vec<Reading>, String> {
    let values = names
        .iter()
        .map(|name| plc.get(name).map_err(|error| format!("`watch`: {error}")));
    values.collect()
}

fn json_of(reading: &Reading) -> Value {
    match reading {
        Reading::Bit(on) => json!(on),
        Reading::Int(value) => json!(value),
        Reading::Float(value) => json!(value),
        Reading::Text(text) => json!(text),
    }
}

fn text_of(reading: &Reading) -> String {
    match reading {
        Reading::Bit(on) => u8::from(*on).to_string(),
        Reading::Int(value) => value.to_string(),
        Reading::Float(value) => value.to_string(),
        Reading::Text(text) => format!("{text:?}"),
    }
}

fn answer(file: &str, watched: &[String], rows: &Rows, plc: &Plc) -> Answer {
    let end = rows.offset.saturating_add(rows.shown.len());
    let next = (end < rows.total).then_some(end);
    let shown = rows.shown.iter().map(|(at_ms, values)| {
        let values = watched.iter().zip(values);
        let values: Map<String, Value> = values
            .map(|(name, value)| (name.clone(), json_of(value)))
            .collect();
        json!({ "at_ms": at_ms, "values": values })
    });
    let errors = plc.errors().iter().map(|error| {
        json!({ "code": error.code, "step": error.step, "first_ms": error.first_ms, "times": error.times })
    });
    let mut data = json!({
        "file": file,
        "watched": watched,
        "rows": shown.collect::<Vec<_>>(),
        "ended_ms": plc.now().as_millis() as u64,
        "running": plc.is_running(),
        "operation_errors": errors.take(ROWS).collect::<Vec<_>>(),
        "total": rows.total,
        "offset": rows.offset,
    });
    if let Some(next) = next {
        data["next_offset"] = json!(next);
    }
    Answer {
        text: table(watched, rows, plc) + &page::remark(next, rows.total, "rows"),
        data,
    }
}

/// A line for each row, with a column for each device.
fn table(watched: &[String], rows: &Rows, plc: &Plc) -> String {
    let cells = rows.shown.iter().map(|(at_ms, values)| {
        let values = values.iter().map(text_of);
        std::iter::once(at_ms.to_string())
            .chain(values)
            .collect::<Vec<_>>()
    });
    let head = std::iter::once("ms".to_owned())
        .chain(watched.iter().cloned())
        .collect();
    let lines: Vec<Vec<String>> = std::iter::once(head).chain(cells).collect();
    let width = |column: usize| {
        lines
            .iter()
            .map(|line| line[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..=watched.len()).map(width).collect();
    let mut text = String::new();
    for line in &lines {
        let cells = line
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"));
        text.push_str(&cells.collect::<Vec<_>>().join("  "));
        text.push('\n');
    }
    text.push_str(&format!(
        "end of the run: {} ms; values are those after the scan that begins then\n",
        plc.now().as_millis()
    ));
    for error in plc.errors().iter().take(ROWS) {
        let (code, step, times, first) = (error.code, error.step, error.times, error.first_ms);
        text.push_str(&format!(
            "operation error {code} at step {step}, {times} times, first at {first} ms\n"
        ));
    }
    if !plc.is_running() {
        text.push_str("the PLC is in STOP\n");
    }
    text
}
