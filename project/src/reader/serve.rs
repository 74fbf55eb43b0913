//! `[serve]`.

use super::{Reader, SERVED, Value, span};
use crate::Project;
use crate::serve::{self, FxEnd, Line, LineEnd, SerialLine};
use rungc_rt::comm::service::MAX_CLIENTS;
use rungc_syntax::Span;
use std::net::SocketAddr;
use toml::de::DeTable;

/// Keys of addresses.
pub(super) const ADDRESSES: [&str; 3] = ["modbus-tcp", "mc", "fx"];

/// Key of the table of serial lines.
pub(super) const SERIAL: &str = "serial";

/// Key of the page's address.
const PAGE: &str = "page";

/// Key of the limit of connections.
const CLIENTS: &str = "clients";

/// Key of what the CAN card is connected to.
const CAN: &str = "can";

impl Reader {
    pub(super) fn serve(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let classes = SERVED.iter().map(|class| class.prefix());
        let keys: Vec<_> = ADDRESSES
            .into_iter()
            .chain([PAGE, CLIENTS, SERIAL, CAN])
            .chain(classes)
            .collect();
        self.known("serve", table, &keys);
        let [modbus_tcp, mc, fx] = ADDRESSES;
        let mut occupied = Occupied::default();
        for (key, addresses) in [
            (modbus_tcp, &mut project.serve.modbus_tcp),
            (mc, &mut project.serve.mc),
        ] {
            for (address, at) in self.ends(table, key, serve::address) {
                occupied.add(key, Some(address), at);
                addresses.push(address);
            }
        }
        for (end, at) in self.ends(table, fx, str::parse::<FxEnd>) {
            occupied.add(fx, end.address(), at);
            project.serve.fx.push(end);
            project.serve.fx_span = at;
        }
        if let Some(value) = table.get(PAGE)
            && let Some((address, at)) = self.end(PAGE, value, &serve::address)
        {
            occupied.add(PAGE, Some(address), at);
            project.serve.page = Some(address);
        }
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
        for SerialLine { line, span } in &project.serve.serial {
            occupied.add(SERIAL, line.end.address(), *span);
        }
        self.check_addresses(occupied);
        for class in SERVED {
            project.serve.devices.extend(self.ranges(table, class));
        }
    }

    /// Addresses at which a protocol is served, with their places: one, or those of a list.
    fn ends<T>(
        &mut self,
        table: &DeTable<'_>,
        key: &str,
        read: impl Fn(&str) -> Result<T, String>,
    ) -> Vec<(T, Span)> {
        let Some(value) = table.get(key) else {
            return Vec::new();
        };
        let values = match value.get_ref().as_array() {
            Some(values) => values.iter().collect(),
            None => vec![value],
        };
        let ends = values.into_iter();
        ends.filter_map(|value| self.end(key, value, &read))
            .collect()
    }

    /// An address, with its place: a port, or a text.
    fn end<T>(
        &mut self,
        key: &str,
        value: &Value<'_>,
        read: &impl Fn(&str) -> Result<T, String>,
    ) -> Option<(T, Span)> {
        let at = span(value.span());
        let port = value.get_ref().as_integer();
        let port = port.filter(|number| number.radix() == 10);
        let text = match (port, value.get_ref().as_str()) {
            (Some(port), _) => port.as_str(),
            (None, Some(text)) => text,
            (None, None) => {
                let message = format!("`{key}` is a port or an address");
                self.wrong(
                    at,
                    message,
                    "write for example `5020` or `\"127.0.0.1:5020\"`",
                );
                return None;
            }
        };
        match read(text) {
            Ok(end) => Some((end, at)),
            Err(why) => {
                self.wrong(at, format!("`{text}` is not an address"), &why);
                None
            }
        }
    }

    /// Reports addresses that are given twice.
    fn check_addresses(&mut self, Occupied(mut occupied): Occupied) {
        occupied.sort_by_key(|(_, _, at)| at.start);
        for (n, &(_, address, at)) in occupied.iter().enumerate() {
            let mut earlier = occupied[..n].iter();
            if let Some((key, ..)) = earlier.find(|earlier| serve::collide(earlier.1, address)) {
                let message = format!("`{key}` has port {} already", address.port());
                self.wrong(at, message, "choose another, or 0 for a free one");
            }
        }
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

/// Addresses of this machine that the settings occupy, each with its key and place.
#[derive(Default)]
struct Occupied(Vec<(&'static str, SocketAddr, Span)>);

impl Occupied {
    fn add(&mut self, key: &'static str, address: Option<SocketAddr>, at: Span) {
        self.0.extend(address.map(|address| (key, address, at)));
    }
}
