//! Control of RUN and STOP by other means than the switch, and of the length of scans.

use crate::unit::Printer;
use rungc_emit::cycle;
use rungc_models::special::RunCommand;
use rungc_rt::special::{
    D_REMOTE, M_FORCE_ENABLE, M_FORCED_RUN, M_LOCAL_CONTROL, M_REMOTE_RUN, REMOTE_KEY, Relay,
};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

impl Printer<'_> {
    /// Obeys M8035 and M8036 or their likes when a scan begins.
    pub fn obey_run_command(&self) -> String {
        let name = self.name();
        let relay = |relay: Relay| {
            self.stored(DeviceClass::M, relay.number())
                .unwrap_or_default()
        };
        match cycle::run_command(self.module, self.fields) {
            Some(RunCommand::Forced) => {
                let (enable, run) = (relay(M_FORCE_ENABLE), relay(M_FORCED_RUN));
                format!(
                    "    if (!plc->sys.running && {enable} && {run}) {{\n        {run} = false;\n        {name}_set_running(plc, true);\n    }}\n"
                )
            }
            Some(RunCommand::Remote) => {
                let key = self.stored(DeviceClass::D, D_REMOTE.number());
                let (key, local) = (key.unwrap_or_default(), relay(M_LOCAL_CONTROL));
                let run = relay(M_REMOTE_RUN);
                format!(
                    "    if ({key} == {REMOTE_KEY} && !{local}) {{\n        {name}_set_running(plc, {run});\n    }}\n"
                )
            }
            None => String::new(),
        }
    }

    /// The function that asks for scans of constant length.
    pub fn constant_scan(&self, out: &mut String) {
        let Some(asks) = cycle::constant_scan(self.module, self.fields) else {
            return;
        };
        let name = self.name();
        let ms = self.stored(DeviceClass::D, asks.register.number());
        let ms = ms.unwrap_or_default();
        let relay = asks
            .relay
            .and_then(|relay| self.stored(DeviceClass::M, relay.number()));
        let on = relay
            .map(|relay| format!("{relay} && "))
            .unwrap_or_default();
        let _ = write!(
            out,
            "uint32_t {name}_constant_scan_us(const {name}_plc *plc)\n{{\n    return ({on}{ms} > 0) ? (uint32_t){ms} * 1000u : 0u;\n}}\n\n"
        );
    }

    /// Forgets M8036 when STOP begins.
    pub(crate) fn forget_run_command(&self) -> String {
        match cycle::run_command(self.module, self.fields) {
            Some(RunCommand::Forced) => {
                let run = self.stored(DeviceClass::M, M_FORCED_RUN.number());
                let run = run.unwrap_or_default();
                format!("    if (!running) {{\n        {run} = false;\n    }}\n")
            }
            Some(RunCommand::Remote) | None => String::new(),
        }
    }
}
