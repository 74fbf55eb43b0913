//! Values of a PLC over time, as `rungc watch --to csv` records them.

use crate::monitor::items_of;
use rungc_models::Model;
use rungc_monitor::{Item, Sample};
use rungc_sim::Target;
use rungc_sim::record::TEXT_LENGTH;
use rungc_syntax::{Device, DeviceClass};

/// Columns of a trace.
const COLUMNS: [&str; 3] = ["ms", "device", "value"];

/// Follows the name of a timer or counter whose contact is meant, not its value.
pub const CONTACT: &str = " contact";

/// Changes of values, in the order of their times.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Trace {
    changes: Vec<Change>,
}

/// Values that a device took at a time.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Change {
    ms: u64,
    values: Vec<(Item, i32)>,
}

impl Trace {
    /// Reads a table with the columns `ms,device,value`, in UTF-8 or, as PowerShell writes it, UTF-16. Names that the
    /// model does not have are errors.
    ///
    /// # Errors
    /// Line and reason.
    pub fn read(bytes: &[u8], model: &Model) -> Result<Trace, String> {
        let (text, ..) = encoding_rs::UTF_8.decode(bytes);
        let mut table = csv::Reader::from_reader(text.as_bytes());
        let heads = table.headers().map_err(|error| error.to_string())?;
        if heads.iter().ne(COLUMNS) {
            let columns = COLUMNS.join(",");
            return Err(format!("line 1: a trace has the columns `{columns}`"));
        }
        let mut changes: Vec<Change> = Vec::new();
        for row in table.records() {
            let row = row.map_err(|error| error.to_string())?;
            let line = row.position().map_or(0, csv::Position::line);
            let change = change(&row, model).map_err(|why| format!("line {line}: {why}"))?;
            if changes.last().is_some_and(|last| last.ms > change.ms) {
                return Err(format!("line {line}: it is earlier than the line before"));
            }
            changes.push(change);
        }
        match changes.is_empty() {
            true => Err("the trace has no values".to_string()),
            false => Ok(Trace { changes }),
        }
    }

    /// Times of the first and of the last values, in milliseconds.
    pub fn times(&self) -> (u64, u64) {
        let ms = |change: Option<&Change>| change.map_or(0, |change| change.ms);
        (ms(self.changes.first()), ms(self.changes.last()))
    }

    /// The values at a time.
    pub fn at(&self, ms: u64) -> Sample {
        let until = self.changes.iter().take_while(|change| change.ms <= ms);
        let mut sample = Sample::default();
        sample
            .values
            .extend(until.flat_map(|change| change.values.iter().copied()));
        sample
    }
}

fn change(row: &csv::StringRecord, model: &Model) -> Result<Change, String> {
    let [ms, name, value] = [0, 1, 2].map(|column| row.get(column).unwrap_or_default());
    let ms = ms.parse();
    let ms = ms.map_err(|_| "a row begins with a time in milliseconds".to_string())?;
    let target = match name.strip_suffix(CONTACT) {
        Some(name) => Target::parse(name)?,
        None => match Target::parse(name)? {
            Target::Bit(class @ (DeviceClass::T | DeviceClass::C), number) => {
                Target::Current(class, number)
            }
            target => target,
        },
    };
    let wrong = || format!("`{value}` is not a value of `{name}`");
    let values = values(target, value, model).ok_or_else(wrong)?;
    match values.is_empty() {
        true => Err(format!("{} has no `{name}`", model.title)),
        false => Ok(Change { ms, values }),
    }
}

/// The parts of a value; empty if the model does not have the devices, `None` if the text is not one.
fn values(target: Target, text: &str, model: &Model) -> Option<Vec<(Item, i32)>> {
    let (class, first, _) = target.devices(1);
    let item = |at: u32, is_bit: bool| {
        let number = first.checked_add(at)?;
        let items = items_of(Device { class, number }, model).into_iter();
        let mut items = items.filter(|_| model.has(class, number));
        items.find(|item| matches!(item, Item::Bit(..)) == is_bit)
    };
    let words = |words: &[i16]| -> Vec<(Item, i32)> {
        let words = (0..).zip(words);
        let words = words.map_while(|(at, &word)| Some((item(at, false)?, word.into())));
        words.collect()
    };
    let pair = |value: u32| words(&[value as i16, (value >> 16) as i16]);
    Some(match target {
        Target::Bit(..) => {
            let value: i32 = text.parse().ok().filter(|value| matches!(value, 0 | 1))?;
            item(0, true)
                .map(|item| (item, value))
                .into_iter()
                .collect()
        }
        Target::Word(..) | Target::Current(..) => {
            let value = text.parse().ok()?;
            item(0, false)
                .map(|item| (item, value))
                .into_iter()
                .collect()
        }
        Target::Pair(..) => pair(text.parse::<i32>().ok()? as u32),
        Target::Float(..) => pair(text.parse::<f32>().ok()?.to_bits()),
        Target::Nibbles(digits, ..) => {
            let value: i64 = text.parse().ok()?;
            let bits = (0..4 * u32::from(digits)).map_while(|at| {
                let bit = (value >> at & 1) as i32;
                Some((item(at, true)?, bit))
            });
            bits.collect()
        }
        Target::Text(..) => {
            let mut bytes = text.trim_matches('"').as_bytes().to_vec();
            bytes.truncate(TEXT_LENGTH);
            let words_of: Vec<i16> = bytes
                .chunks(2)
                .map(|pair| i16::from_le_bytes([pair[0], *pair.get(1).unwrap_or(&0)]))
                .collect();
            words(&words_of)
        }
        Target::Pulses(_) | Target::Frequency(_) | Target::Channel(_) => Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_models::ModelId;
    use rungc_rt::Class;

    fn read(text: &str) -> Result<Trace, String> {
        Trace::read(text.as_bytes(), Model::get(ModelId::Fx3u))
    }

    #[test]
    fn the_last_values_until_a_time_count() {
        let trace = read(
            "ms,device,value\n0,X000,0\n0,T0 contact,0\n0,T0,12\n500,X000,1\n500,D0.i32,-2\n900,K1M4,10\n900,D4.f32,1.5\n\
             900,C235,-70000\n1000,X000,0\n",
        )
        .unwrap();
        assert_eq!(trace.times(), (0, 1000));
        let sample = trace.at(999);
        let value = |item| sample.values.get(&item).copied();
        assert_eq!(value(Item::Bit(Class::X, 0)), Some(1));
        assert_eq!(value(Item::Bit(Class::T, 0)), Some(0));
        assert_eq!(value(Item::Word(Class::T, 0)), Some(12));
        assert_eq!(value(Item::Word(Class::D, 0)), Some(-2));
        assert_eq!(value(Item::Word(Class::D, 1)), Some(-1));
        assert_eq!(value(Item::Word(Class::D, 5)), Some(0x3fc0));
        assert_eq!(value(Item::Bit(Class::M, 5)), Some(1));
        assert_eq!(value(Item::Bit(Class::M, 6)), Some(0));
        assert_eq!(value(Item::Word(Class::C, 235)), Some(-70000));
        assert_eq!(trace.at(100).values.len(), 3);
    }

    #[test]
    fn wrong_rows_are_errors_with_their_line() {
        for (rows, why) in [
            ("time,device,value\n", "line 1: a trace has the columns"),
            ("ms,device,value\n", "the trace has no values"),
            (
                "ms,device,value\nx,X000,1\n",
                "line 2: a row begins with a time",
            ),
            (
                "ms,device,value\n0,X000,2\n",
                "line 2: `2` is not a value of `X000`",
            ),
            (
                "ms,device,value\n0,D0,a\n",
                "line 2: `a` is not a value of `D0`",
            ),
            (
                "ms,device,value\n0,Q0,1\n",
                "line 2: `Q0` is not a device name",
            ),
            ("ms,device,value\n0,D99999,1\n", "has no `D99999`"),
            ("ms,device,value\n5,D0,1\n3,D0,1\n", "line 3: it is earlier"),
            ("ms,device,value\n5,D0\n", "found record with 2 fields"),
        ] {
            let error = read(rows).unwrap_err();
            assert!(error.contains(why), "{rows}: {error}");
        }
    }

    #[test]
    fn tables_of_powershell_are_read() {
        let text = "ms,device,value\r\n0,X000,1\r\n";
        let mut bytes = vec![0xff, 0xfe];
        bytes.extend(text.encode_utf16().flat_map(u16::to_le_bytes));
        let trace = Trace::read(&bytes, Model::get(ModelId::Fx3u)).unwrap();
        assert_eq!(trace.at(0).values.len(), 1);
    }
}
