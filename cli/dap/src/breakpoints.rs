//! Breakpoints: as the editor sets them, and as they stop the program that runs.

use crate::observe::Stops;
use crate::places::{Places, Source};
use crate::protocol::{DataBreakpointArguments, SourceBreakpoint};
use rungc::{Plc, Program};
use rungc_interp::Machine;
use rungc_sim::Target;
use rungc_sim::property::{Condition, Monitor};
use rungc_sim::record::{Reading, Seen};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Most breakpoints.
const MOST: usize = 4096;

/// A breakpoint at an instruction.
pub struct Point {
    /// The instruction.
    pub instr: usize,
    /// Its conditions.
    pub stop: When,
    /// Message that is logged instead of stopping.
    pub log: Option<Log>,
}

/// A breakpoint on a device.
pub struct DataPoint {
    /// The device.
    pub target: Target,
    /// Conditions for a stop.
    pub stop: When,
}

/// Conditions of a breakpoint that is reached.
pub struct When {
    /// Number of the breakpoint.
    pub id: i64,
    condition: Option<Condition>,
    hits: Option<Hits>,
    /// Number of times that it was reached.
    count: u64,
}

impl When {
    fn new(
        id: i64,
        condition: Option<&str>,
        hits: Option<&str>,
        program: &Program,
    ) -> Result<Self, String> {
        let condition = condition.filter(|text| !text.trim().is_empty());
        let hits = hits.filter(|text| !text.trim().is_empty());
        Ok(When {
            id,
            condition: condition.map(|text| momentary(text, program)).transpose()?,
            hits: hits.map(Hits::parse).transpose()?,
            count: 0,
        })
    }

    /// Returns true if it stops where it is reached; `counts` is whether that counts as a hit.
    pub fn is_met(&mut self, machine: &Machine, counts: bool) -> bool {
        let holds = |condition| holds(condition, machine);
        if !self.condition.as_ref().is_none_or(holds) {
            return false;
        }
        if !counts {
            return true;
        }
        self.count += 1;
        self.hits.is_none_or(|hits| hits.are_met(self.count))
    }
}

/// Returns true if a condition without memory holds now.
pub fn holds(condition: &Condition, machine: &Machine) -> bool {
    Monitor::new(std::slice::from_ref(condition)).all_hold(machine, 0)
}

/// Reads a condition without memory.
///
/// # Errors
/// A mistake in it.
pub fn momentary(text: &str, program: &Program) -> Result<Condition, String> {
    let condition = program.condition(text).map_err(|error| error.to_string())?;
    if condition.has_memory() {
        return Err(
            "a condition here is about one moment: it cannot look at earlier scans".to_owned(),
        );
    }
    Ok(condition)
}

/// A condition on the number of hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Hits {
    Exactly(u64),
    From(u64),
    Each(u64),
}

impl Hits {
    /// Reads `5` or `>= 5` (from the fifth on), `> 5`, `= 5`, `% 5` (every fifth).
    fn parse(text: &str) -> Result<Hits, String> {
        let text = text.trim();
        let digits = text.trim_start_matches(|c: char| !c.is_ascii_digit());
        let operator = text[..text.len() - digits.len()].trim();
        let number = digits.parse::<u64>().ok().filter(|&number| number > 0);
        match (operator, number) {
            ("" | ">=", Some(number)) => Ok(Hits::From(number)),
            (">", Some(number)) => Ok(Hits::From(number.saturating_add(1))),
            ("=" | "==", Some(number)) => Ok(Hits::Exactly(number)),
            ("%", Some(number)) => Ok(Hits::Each(number)),
            _ => Err(format!(
                "`{text}` is not a number of hits: write `5`, `>= 5`, `> 5`, `= 5` or `% 5`"
            )),
        }
    }

    fn are_met(self, count: u64) -> bool {
        match self {
            Hits::Exactly(number) => count == number,
            Hits::From(number) => count >= number,
            Hits::Each(number) => count.is_multiple_of(number),
        }
    }
}

/// A message with the values of devices.
pub struct Log(Vec<Piece>);

enum Piece {
    Text(String),
    Device(Target),
}

impl Log {
    /// Reads a message with devices in braces: `speed is {D0}`.
    fn parse(text: &str, plc: &Plc) -> Result<Log, String> {
        let mut pieces = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            let (name, after) = after
                .split_once('}')
                .ok_or_else(|| format!("`{text}`: a `}}` is missing"))?;
            pieces.push(Piece::Text(before.to_owned()));
            let target = plc.target(name).map_err(|error| error.to_string())?;
            pieces.push(Piece::Device(target));
            rest = after;
        }
        pieces.push(Piece::Text(rest.to_owned()));
        Ok(Log(pieces))
    }

    /// The message now.
    pub fn text(&self, seen: Seen) -> String {
        let pieces = self.0.iter().map(|piece| match piece {
            Piece::Text(text) => text.clone(),
            Piece::Device(target) => {
                let value = Reading::of(seen, *target);
                value.map_or_else(|| "?".to_owned(), |value| value.to_string())
            }
        });
        pieces.collect()
    }
}

/// All breakpoints of an editor, with their numbers.
#[derive(Default)]
pub struct Breakpoints {
    at_lines: BTreeMap<Source, Vec<(i64, SourceBreakpoint)>>,
    on_devices: Vec<(i64, DataBreakpointArguments)>,
    /// Errors of the PLC stop the run.
    pub errors: bool,
    /// Number of the last one.
    last: i64,
}

impl Breakpoints {
    fn check_count(&self, others: usize, count: usize) -> Result<(), String> {
        match others.saturating_add(count) > MOST {
            true => Err(format!("there can be at most {MOST} breakpoints")),
            false => Ok(()),
        }
    }

    /// Replaces those of a source.
    ///
    /// # Errors
    /// Too many.
    pub fn set_at_lines(
        &mut self,
        source: Source,
        all: Vec<SourceBreakpoint>,
    ) -> Result<(), String> {
        let others = self.at_lines.iter().filter(|(other, _)| **other != source);
        let others = others.map(|(_, points)| points.len()).sum();
        self.check_count(others, all.len())?;
        let first = self.last;
        self.last += all.len() as i64;
        self.at_lines
            .insert(source, (first + 1..).zip(all).collect());
        Ok(())
    }

    /// Replaces those on devices.
    ///
    /// # Errors
    /// Too many.
    pub fn set_on_devices(&mut self, all: Vec<DataBreakpointArguments>) -> Result<(), String> {
        self.check_count(0, all.len())?;
        let first = self.last;
        self.last += all.len() as i64;
        self.on_devices = (first + 1..).zip(all).collect();
        Ok(())
    }

    /// The breakpoints of a program: what stops it, and the states of those at lines and on devices.
    pub fn resolve(&self, plc: &Plc, program: &Program, places: &Places) -> Resolved {
        let mut stops = Stops {
            errors: self.errors,
            ..Stops::default()
        };
        let mut at_lines = BTreeMap::new();
        for (source, points) in &self.at_lines {
            let mut states = Vec::with_capacity(points.len());
            for (id, wanted) in points {
                let point = point(*id, wanted, source, plc, program, places);
                states.push(match &point {
                    Ok(point) => json!({
                        "id": id,
                        "verified": true,
                        "line": places.line(point.instr),
                        "source": places.source(point.instr),
                    }),
                    Err(why) => rejected(*id, why),
                });
                stops.points.extend(point.ok());
            }
            at_lines.insert(source.clone(), states);
        }
        let mut on_devices = Vec::with_capacity(self.on_devices.len());
        for (id, wanted) in &self.on_devices {
            let point = data_point(*id, wanted, plc, program);
            on_devices.push(match &point {
                Ok(_) => json!({ "id": id, "verified": true }),
                Err(why) => rejected(*id, why),
            });
            stops.data.extend(point.ok());
        }
        Resolved {
            stops,
            at_lines,
            on_devices,
        }
    }
}

/// Breakpoints of a program.
pub struct Resolved {
    /// What stops it.
    pub stops: Stops,
    /// States of those at lines, as the protocol describes them.
    pub at_lines: BTreeMap<Source, Vec<Value>>,
    /// States of those on devices.
    pub on_devices: Vec<Value>,
}

fn rejected(id: i64, why: &str) -> Value {
    json!({ "id": id, "verified": false, "message": why, "reason": "failed" })
}

fn point(
    id: i64,
    wanted: &SourceBreakpoint,
    source: &Source,
    plc: &Plc,
    program: &Program,
    places: &Places,
) -> Result<Point, String> {
    let (condition, hits) = (wanted.condition.as_deref(), wanted.hit_condition.as_deref());
    let log = wanted
        .log_message
        .as_deref()
        .filter(|text| !text.is_empty());
    Ok(Point {
        instr: places.stop(source, wanted.line)?,
        stop: When::new(id, condition, hits, program)?,
        log: log.map(|text| Log::parse(text, plc)).transpose()?,
    })
}

fn data_point(
    id: i64,
    wanted: &DataBreakpointArguments,
    plc: &Plc,
    program: &Program,
) -> Result<DataPoint, String> {
    if wanted
        .access_type
        .as_deref()
        .is_some_and(|kind| kind != "write")
    {
        return Err(
            "a breakpoint on a device stops when its value changes, not when it is read".to_owned(),
        );
    }
    let (condition, hits) = (wanted.condition.as_deref(), wanted.hit_condition.as_deref());
    let target = plc
        .target(&wanted.data_id)
        .map_err(|error| error.to_string())?;
    plc.get(&wanted.data_id)
        .map_err(|error| error.to_string())?;
    Ok(DataPoint {
        target,
        stop: When::new(id, condition, hits, program)?,
    })
}

#[cfg(test)]
mod tests {
    use super::Hits;

    #[test]
    fn numbers_of_hits_are_read() {
        assert_eq!(Hits::parse(" 5 "), Ok(Hits::From(5)));
        assert_eq!(Hits::parse(">5"), Ok(Hits::From(6)));
        assert_eq!(Hits::parse("== 5"), Ok(Hits::Exactly(5)));
        assert_eq!(Hits::parse("% 5"), Ok(Hits::Each(5)));
        for wrong in [
            "0",
            "% 0",
            "five",
            "-1",
            "5 times",
            "99999999999999999999",
            "<5",
        ] {
            assert!(Hits::parse(wrong).is_err(), "{wrong}");
        }
    }
}
