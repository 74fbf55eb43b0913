//! `[[modbus]]`.

use super::{Reader, Value, hint, span};
use crate::Project;
use crate::modbus::{self, Line, Row};
use rungc_syntax::{DeviceClass, Span};
use toml::de::DeTable;

/// The table of which each entry is a row.
pub(super) const MODBUS: &str = "modbus";

/// Keys of a row.
const ROW: &[&str] = &[
    "port", "host", "station", "read", "write", "address", "count", "buffer", "trigger",
];

/// The unit of a server that is addressed by default.
const USUAL_UNIT: u32 = 1;

impl Reader {
    pub(super) fn modbus(&mut self, at: Span, value: &Value<'_>, project: &mut Project) {
        for (at, table) in self.rows(MODBUS, at, value) {
            project.modbus.extend(self.row(at, table));
        }
    }

    /// A row of the Modbus table.
    fn row(&mut self, at: Span, table: &DeTable<'_>) -> Option<Row> {
        self.known(MODBUS, table, ROW);
        let line = self.line(table)?;
        let transfer = self.transfer(at, table)?;
        let least = match transfer.key {
            // A write may be for all stations.
            "write" => 0,
            _ => 1,
        };
        let (stations, usual) = match line {
            Line::Port(_) => (least..=247, None),
            Line::Host(_) => (0..=255, Some(USUAL_UNIT)),
        };
        let address = self.number(table, at, "address", 0..=0xffff, None)?;
        let count = self.number(table, at, "count", 1..=transfer.most.into(), Some(1))?;
        if address + count > 0x1_0000 {
            let place = table.get("address").map_or(at, |value| span(value.span()));
            self.wrong(place, "the last address is 65535", "");
            return None;
        }
        let row = Row {
            line,
            station: self.number(table, at, "station", stations, usual)? as u8,
            transfer,
            address: address as u16,
            count: count as u16,
            buffer: match self.row_device(table, "buffer", &[DeviceClass::D])? {
                Some(device) => device.number,
                None => {
                    self.wrong(
                        at,
                        "a row has `buffer`",
                        "add for example `buffer = \"D100\"`",
                    );
                    return None;
                }
            },
            trigger: {
                use DeviceClass::{C, M, S, T};
                self.row_device(table, "trigger", &[M, C, T, S])?
            },
            span: at,
        };
        Some(row)
    }

    /// Connection of a row: COM1 if none is given.
    fn line(&mut self, table: &DeTable<'_>) -> Option<Line> {
        if let Some(named) = self.get(table, "host") {
            if let Some(port) = table.get("port") {
                let message = "a row has `host` or `port`, not both";
                self.wrong(span(port.span()), message, "");
                return None;
            }
            return match modbus::server(&named.text) {
                Ok(server) => Some(Line::Host(server)),
                Err(why) => {
                    let message = format!("`{}` is not the address of a server", named.text);
                    self.wrong(named.span, message, &why);
                    None
                }
            };
        }
        let Some(named) = self.get(table, "port") else {
            return Some(Line::Port(1));
        };
        let number = named.text.strip_prefix("COM").and_then(|n| n.parse().ok());
        let port = number.filter(|number| (1..=3).contains(number));
        if port.is_none() {
            let message = "a master's port is `COM1`, `COM2` or `COM3`";
            self.wrong(named.span, message, "");
        }
        port.map(Line::Port)
    }

    /// Transfer of a row.
    fn transfer(&mut self, at: Span, table: &DeTable<'_>) -> Option<modbus::Transfer> {
        let (key, named) = match (self.get(table, "read"), self.get(table, "write")) {
            (Some(named), None) => ("read", named),
            (None, Some(named)) => ("write", named),
            _ => {
                let help = "add for example `read = \"registers\"`";
                self.wrong(at, "a row has `read` or `write`", help);
                return None;
            }
        };
        let found = modbus::transfer(key, &named);
        if found.is_none() {
            let of_key = modbus::TRANSFERS.iter().filter(|other| other.key == key);
            let names: Vec<_> = of_key.map(|other| other.what).collect();
            let message = format!("a row cannot {key} `{}`", named.text);
            self.wrong(named.span, message, &hint(&named.text, &names));
        }
        found
    }
}
