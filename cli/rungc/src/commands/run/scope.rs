//! `rungc run --scope`: what HM's oscilloscope has recorded (hm-motion-controller §5.6), as a diagram and as a table.

use super::super::{Failure, eprint_line, file_name};
use crate::output::{AtomicFile, Kind};
use rungc_interp::Machine;
use rungc_rt::special::{
    D_SCOPE_CHANNELS, D_SCOPE_FIRST, D_SCOPE_MODE, D_SCOPE_PERIOD, D_SCOPE_STATE, D_SCOPE_TAKEN,
    Register,
};
use rungc_rt::{Class, Plc};
use rungc_sim::record::plot::{Plot, Shape};
use std::fmt::Write as _;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Parameters and state of the oscilloscope.
pub const REGISTERS: [Register; 14] = D_SCOPE_MODE.run();

/// Values of D8038.
const SAMPLING: i16 = 1;
const DONE: i16 = 3;

/// Columns of a value over several words.
const WIDE: [usize; 3] = [1, 2, 4];

/// Samples of one register.
#[derive(Clone, PartialEq, Debug)]
struct Channel {
    name: String,
    /// Number of words.
    words: usize,
}

/// A record.
#[derive(Clone, PartialEq, Debug)]
struct Record {
    /// Time between two samples, in tenths of a millisecond.
    period: u64,
    channels: Vec<Channel>,
    /// A row for each sample: a value for each channel.
    rows: Vec<Vec<i64>>,
}

/// The files in the making, and the last complete record.
pub struct Scope {
    title: String,
    diagram: AtomicFile,
    table: AtomicFile,
    path: PathBuf,
    state: i16,
    record: Option<Record>,
}

impl Scope {
    /// Begins the files: the diagram, and beside it a table with the same name and the ending `.csv`.
    pub fn begin(path: &Path, force: bool, machine: &Machine) -> Result<Self, Failure> {
        let module = machine.module();
        if !module.model.has_oscilloscope() {
            let title = module.model.title;
            let message = format!("--scope: {title} has no oscilloscope");
            return Err(Failure::Because(message));
        }
        let name = file_name(rungc_lower::stem(&module.source_name), &module.name);
        Ok(Scope {
            title: format!("Oscilloscope of {name} on {}", module.model.title),
            diagram: AtomicFile::create(path, Kind::Svg, force)?,
            table: AtomicFile::create(&table(path), Kind::Table, force)?,
            path: path.to_path_buf(),
            state: 0,
            record: None,
        })
    }

    /// Takes notice of how things are now.
    pub fn sample(&mut self, machine: &Machine) {
        let state = word(machine, D_SCOPE_STATE.number());
        if state == DONE && self.state != DONE {
            self.record = Some(Record::of(machine));
        }
        self.state = state;
    }

    /// Draws the last record, complete or not, and writes its table; the files take their places.
    pub fn keep(mut self, machine: &Machine) -> Result<(), Failure> {
        if self.state == SAMPLING {
            self.record = Some(Record::of(machine));
        }
        let Some(record) = self.record.filter(|record| !record.rows.is_empty()) else {
            let path = self.path.display();
            eprint_line(&format!(
                "rungc: --scope: the oscilloscope has taken no sample (D8038 is {}); {path} is not written",
                self.state
            ));
            return Ok(());
        };
        for (file, text) in [
            (self.diagram, record.drawn(&self.title)),
            (self.table, record.table()),
        ] {
            let mut out = file.writer()?;
            let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
            written.map_err(|error| file.failed(error))?;
            file.persist()?;
        }
        Ok(())
    }
}

/// The table beside a diagram.
pub fn table(diagram: &Path) -> PathBuf {
    diagram.with_extension("csv")
}

fn word(machine: &Machine, number: u32) -> i16 {
    machine.word(Class::D, number).unwrap_or(0)
}

impl Record {
    /// Record in the registers.
    fn of(machine: &Machine) -> Record {
        let register = |register: Register| word(machine, register.number());
        let number = |value: i16| u32::try_from(value).unwrap_or(0);
        let mut channels = Vec::new();
        for channel in 0..2 {
            let words = number(register(D_SCOPE_CHANNELS.after(2 * channel)));
            let first = number(register(D_SCOPE_CHANNELS.after(2 * channel + 1)));
            let words = words as usize;
            if WIDE.contains(&words) {
                let name = match words {
                    1 => format!("D{first}"),
                    _ => format!("D{first}.i{}", 16 * words),
                };
                channels.push(Channel { name, words });
            } else {
                let single = (first..).take(words);
                channels.extend(single.map(|number| Channel {
                    name: format!("D{number}"),
                    words: 1,
                }));
            }
        }
        let mut at = number(register(D_SCOPE_FIRST));
        let mut next = |words: usize| {
            let value = (0..words).fold(0i64, |value, i| {
                let word = i64::from(word(machine, at + i as u32) as u16);
                value | word << (16 * i)
            });
            at += words as u32;
            let unused = 64 - 16 * words as u32;
            value << unused >> unused
        };
        let taken = number(register(D_SCOPE_TAKEN));
        let row = |_| channels.iter().map(|c| next(c.words)).collect();
        let rows = (0..taken).map(row).collect();
        let period = match register(D_SCOPE_PERIOD) {
            ..=0 => 1,
            1 => 5,
            2 => 10,
            n => 10 * (u64::from(n.unsigned_abs()) + 1),
        };
        Record {
            period,
            channels,
            rows,
        }
    }

    /// The diagram: a panel for each channel.
    fn drawn(&self, title: &str) -> String {
        let last = self.rows.len().saturating_sub(1) as u64;
        let mut plot = Plot::new(title, last * self.period / 10);
        let name = |c: &Channel| plot.curve(&c.name, &c.name, Shape::Step);
        let curves: Vec<_> = self.channels.iter().map(name).collect();
        for (sample, row) in (0..).zip(&self.rows) {
            for (&curve, &value) in curves.iter().zip(row) {
                plot.point(curve, sample * self.period / 10, value as f64);
            }
        }
        plot.draw()
    }

    /// The table: times in milliseconds since the first sample, and the values.
    fn table(&self) -> String {
        let names = self.channels.iter().map(|channel| channel.name.as_str());
        let mut text = ["time_ms"]
            .into_iter()
            .chain(names)
            .collect::<Vec<_>>()
            .join(",");
        text.push('\n');
        for (sample, row) in (0..).zip(&self.rows) {
            let tenths: u64 = sample * self.period;
            let _ = write!(text, "{}.{}", tenths / 10, tenths % 10);
            for value in row {
                let _ = write!(text, ",{value}");
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_have_a_line_for_each_sample() {
        let channel = |name: &str, words| Channel {
            name: name.to_string(),
            words,
        };
        let record = Record {
            period: 5,
            channels: vec![channel("D224", 1), channel("D220.i32", 2)],
            rows: vec![vec![1, -70_000], vec![2, 70_000], vec![-3, 0]],
        };
        insta::assert_snapshot!(record.table(), @r"
        time_ms,D224,D220.i32
        0.0,1,-70000
        0.5,2,70000
        1.0,-3,0
        ");
    }
}
