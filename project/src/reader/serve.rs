//! `[serve]`.

use super::{Reader, SERVED, Value, span};
use crate::serve::{self, FxEnd, Line, LineEnd, SerialLine};
use crate::{Named, Project};
use rungc_rt::comm::service::MAX_CLIENTS;
use toml::de::DeTable;

/// Keys of addresses.
pub(super) const ADDRESSES: [&str; 3] = ["modbus-tcp", "mc", "fx"];

/// Key of the table of serial lines.
pub(super) const SERIAL: &str = "serial";

/// Key of the limit of connections.
const CLIENTS: &str = "clients";

/// Key of what the CAN card is connected to.
const CAN: &str = "can";

impl Reader {
    pub(super) fn serve(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let classes = SERVED.iter().map(|class| class.prefix());
        let keys: Vec<_> = ADDRESSES
            .into_iter()
            .chain([CLIENTS, SERIAL, CAN])
            .chain(classes)
            .collect();
        self.known("serve", table, &keys);
        let [modbus_tcp, mc, fx] = ADDRESSES;
        project.serve.modbus_tcp = self.ends(table, modbus_tcp, serve::address);
        project.serve.mc = self.ends(table, mc, serve::address);
        project.serve.fx = self.ends(table, fx, str::parse::<FxEnd>);
        if let Some(value) = table.get(CLIENTS) {
            let range = 1..=MAX_CLIENTS as u32;
            let clients = self.number(table, span(value.span()), CLIENTS, range, None);
            project.serve.clients = clients.and_then(|clients| clients.try_into().ok());
        }
        if let Some(value) = table.get(SERIAL) {
            self.lines(value, project);
        }
        if let Some(named) = self.get(table, CAN) {
            match Line::can(&named.text) {
                Ok(line) => project.serve.serial.push(SerialLine {
                    line,
                    span: named.span,
                }),
                Err(why) => {
                    let message = format!("`{}` is not a CAN bus", named.text);
                    self.wrong(named.span, message, &why);
                }
            }
        }
        for class in SERVED {
            project.serve.devices.extend(self.ranges(table, class));
        }
    }

    /// Addresses at which a protocol is served: one, or those of a list.
    fn ends<T>(
        &mut self,
        table: &DeTable<'_>,
        key: &str,
        read: impl Fn(&str) -> Result<T, String>,
    ) -> Vec<T> {
        let Some(value) = table.get(key) else {
            return Vec::new();
        };
        let values = match value.get_ref().as_array() {
            Some(values) => values.iter().collect(),
            None => vec![value],
        };
        let mut named = Vec::new();
        for value in values {
            let number = value.get_ref().as_integer();
            let port = number.filter(|number| number.radix() == 10);
            let port = port.map(|number| Named {
                text: number.as_str().to_string(),
                span: span(value.span()),
            });
            named.extend(port.or_else(|| self.text(key, value)));
        }
        let mut addresses = Vec::new();
        for named in named {
            match read(&named.text) {
                Ok(address) => addresses.push(address),
                Err(why) => {
                    let message = format!("`{}` is not an address", named.text);
                    self.wrong(named.span, message, &why);
                }
            }
        }
        addresses
    }

    fn lines(&mut self, value: &Value<'_>, project: &mut Project) {
        const HELP: &str = "write `serial = { COM1 = \"/dev/ttyUSB0\" }`";
        let Some(lines) = value.get_ref().as_table() else {
            return self.wrong(span(value.span()), "`serial` is a table", HELP);
        };
        for (key, end) in lines {
            let name = key.get_ref().as_ref();
            let Some(port) = serve::port(name) else {
                let message = format!("`{name}` is not a serial port");
                self.wrong(span(key.span()), message, HELP);
                continue;
            };
            let Some(named) = self.text(name, end) else {
                continue;
            };
            match LineEnd::parse(&named.text) {
                Ok(end) => project.serve.serial.push(SerialLine {
                    line: Line { port, end },
                    span: span(key.span()),
                }),
                Err(why) => {
                    let message = format!("`{}` is not the end of a line", named.text);
                    self.wrong(named.span, message, &why);
                }
            }
        }
    }
}
