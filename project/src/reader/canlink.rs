//! `[canlink]`.

use super::{Reader, Value, span};
use crate::Project;
use crate::canlink::{Entry, LAST_STATION, MOST_ENTRIES, MOST_HEARD, MOST_TOGETHER, Station, When};
use rungc_rt::comm::canlink::REGISTERS_END;
use rungc_syntax::{DeviceClass, Span};
use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use toml::de::DeTable;

/// The table.
pub(super) const CANLINK: &str = "canlink";

/// Its keys.
pub(super) const KEYS: &[&str] = &["station", "master", "heartbeat", "slaves", "listen", SEND];

/// The table of which each entry is something that the station sends.
const SEND: &str = "send";

/// Keys of an entry.
const ENTRY: &[&str] = &[
    "every", "event", "sync", "together", "from", "to", "register", "count",
];

/// Milliseconds between two heartbeats, and between two times of an entry (h1u-h2u-programming §5.9.3, §5.9.7).
const HEARTBEATS: RangeInclusive<u32> = 10..=20_000;
const TIMES: RangeInclusive<u32> = 1..=30_000;

/// Registers of an entry: as many as one CANPUT sends.
const MOST_REGISTERS: u32 = 64;

impl Reader {
    pub(super) fn canlink(&mut self, at: Span, table: &DeTable<'_>, project: &mut Project) {
        if !table.contains_key("station") {
            let help = "add the number on the switches of the CAN card: `station = 1`";
            return self.wrong(at, "`[canlink]` needs `station`", help);
        }
        let stations = 1..=LAST_STATION;
        let station = self.number(table, at, "station", stations.clone(), None);
        let master = self.number(table, at, "master", stations, Some(1));
        let heartbeat = match table.contains_key("heartbeat") {
            true => self.number(table, at, "heartbeat", HEARTBEATS, None),
            false => Some(0),
        };
        let [slaves, listen] = ["slaves", "listen"].map(|key| self.stations(table, key));
        let (Some(station), Some(master), Some(heartbeat)) = (station, master, heartbeat) else {
            return;
        };
        let is_master = station == master;
        let sends = table
            .get(SEND)
            .map(|value| self.entries(at, value, is_master));
        let place = |key| table.get(key).map_or(at, |value| span(value.span()));
        if !is_master && !slaves.is_empty() {
            let message = "only the master watches slaves";
            self.wrong(
                place("slaves"),
                message,
                "remove `slaves`, or make `master` this station",
            );
        }
        if listen.len() > MOST_HEARD {
            let message = format!("a station listens to at most {MOST_HEARD} others");
            self.wrong(place("listen"), message, "");
        }
        if slaves
            .iter()
            .chain(&listen)
            .any(|&other| u32::from(other) == station)
        {
            self.wrong(place("station"), "a station is not its own partner", "");
        }
        project.canlink = Some(Station {
            station: station as u8,
            master: master as u8,
            heartbeat: heartbeat as u16,
            slaves,
            listen,
            sends: sends.unwrap_or_default(),
            span: at,
        });
    }

    /// A list of stations.
    fn stations(&mut self, table: &DeTable<'_>, key: &str) -> Vec<u8> {
        let Some(value) = table.get(key) else {
            return Vec::new();
        };
        let numbers = value.get_ref().as_array().map(|values| {
            let numbers = values.iter().map(|value| {
                let digits = value.get_ref().as_integer()?;
                let number = u8::from_str_radix(digits.as_str(), digits.radix()).ok()?;
                (1..=LAST_STATION)
                    .contains(&number.into())
                    .then_some(number)
            });
            numbers.collect::<Option<Vec<_>>>()
        });
        numbers.flatten().unwrap_or_else(|| {
            let message = format!("`{key}` is a list of stations, 1 to {LAST_STATION}");
            let help = format!("write for example `{key} = [2, 3]`");
            self.wrong(span(value.span()), message, &help);
            Vec::new()
        })
    }

    fn entries(&mut self, at: Span, value: &Value<'_>, is_master: bool) -> Vec<Entry> {
        let mut entries = Vec::new();
        for (at, table) in self.rows("canlink.send", at, value) {
            entries.extend(self.entry(at, table));
        }
        let most = MOST_ENTRIES[usize::from(!is_master)];
        if let Some(entry) = entries.get(most) {
            let message = format!("a {} sends at most {most} entries", name(is_master));
            self.wrong(entry.span, message, "");
        }
        let together = |entry: &&Entry| matches!(entry.when, When::Together(_));
        let groups: Vec<_> = entries.iter().filter(together).collect();
        let triggers: BTreeSet<_> = groups.iter().map(|entry| entry.when).collect();
        let [most_triggers, most_entries] = MOST_TOGETHER;
        let of = |when: &When| groups.iter().filter(|entry| entry.when == *when).count();
        let message = match groups.first() {
            Some(_) if !is_master => "only the master sends `together`".to_string(),
            _ if triggers.len() > most_triggers => {
                format!("at most {most_triggers} relays send `together`")
            }
            _ if triggers.iter().any(|when| of(when) > most_entries) => {
                format!("a relay sends at most {most_entries} entries `together`")
            }
            _ => return entries,
        };
        if let Some(entry) = groups.first() {
            self.wrong(entry.span, message, "");
        }
        entries
    }

    fn entry(&mut self, at: Span, table: &DeTable<'_>) -> Option<Entry> {
        self.known("canlink.send", table, ENTRY);
        let when = self.when(at, table)?;
        let from = self.row_device(table, "from", &[DeviceClass::D])?;
        let Some(from) = from else {
            self.wrong(at, "a row has `from`", "add for example `from = \"D10\"`");
            return None;
        };
        let most = MOST_REGISTERS;
        let last = u32::from(REGISTERS_END) - 1;
        let count = self.number(table, at, "count", 1..=most, Some(1))?;
        let register = self.number(
            table,
            at,
            "register",
            0..=last + 1 - count,
            Some(from.number),
        )?;
        if register + count > last + 1 {
            let message = format!("`register` is needed: frames write D0 to D{last}");
            self.wrong(at, message, "");
            return None;
        }
        Some(Entry {
            when,
            from: from.number,
            to: self.number(table, at, "to", 1..=LAST_STATION, Some(0))? as u8,
            register: register as u16,
            count: count as u16,
            span: at,
        })
    }

    /// Condition for sending an entry, given by one of four keys.
    fn when(&mut self, at: Span, table: &DeTable<'_>) -> Option<When> {
        const HELP: &str =
            "add for example `every = 100` (ms), `event = \"M100\"` or `sync = true`";
        let keys = ["every", "event", "sync", "together"];
        let given: Vec<_> = keys
            .into_iter()
            .filter(|key| table.contains_key(*key))
            .collect();
        let &[key] = &given[..] else {
            self.wrong(
                at,
                "a row has one of `every`, `event`, `sync` and `together`",
                HELP,
            );
            return None;
        };
        let relay = |this: &mut Self| {
            let device = this.row_device(table, key, &[DeviceClass::M])??;
            Some(device.number)
        };
        match key {
            "every" => Some(When::Every(self.number(table, at, key, TIMES, None)? as u16)),
            "event" => relay(self).map(When::Event),
            "together" => relay(self).map(When::Together),
            _ if self.flag(table, key) => Some(When::Sync),
            _ => {
                self.wrong(at, "`sync` is true, or it is not there", HELP);
                None
            }
        }
    }
}

/// Name of a station's role.
fn name(is_master: bool) -> &'static str {
    match is_master {
        true => "master",
        false => "slave",
    }
}
