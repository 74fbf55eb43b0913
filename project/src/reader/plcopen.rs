//! `[plcopen]`.

use super::{Reader, span};
use crate::{Project, device};
use toml::de::DeTable;

impl Reader {
    pub(super) fn plcopen(&mut self, table: &DeTable<'_>, project: &mut Project) {
        for range in self.list(table, "free") {
            match device::range(&range.text.to_uppercase()) {
                Some(range) => project.plcopen.free.push(range),
                None => {
                    let message = format!("`{}` is not a range of devices", range.text);
                    self.wrong(range.span, message, "write for example `M100-M199`");
                }
            }
        }
        let Some(value) = table.get("names") else {
            return;
        };
        let Some(names) = value.get_ref().as_table() else {
            let help = "write `[plcopen.names]` on its own line, and a line `Start = \"X000\"` for each variable below";
            self.wrong(span(value.span()), "`names` is a table", help);
            return;
        };
        for (key, value) in names {
            let name = key.get_ref();
            let Some(written) = self.text(name, value) else {
                continue;
            };
            match device::device(&written.text.to_uppercase()) {
                Some(device) => _ = project.plcopen.devices.insert(name.to_uppercase(), device),
                None => {
                    let message = format!("`{}` is not a device", written.text);
                    self.wrong(written.span, message, "write for example `X000` or `T5`");
                }
            }
        }
    }
}
