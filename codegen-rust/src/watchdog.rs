//! What stops a scan that does not end, and what a host asks when something has gone wrong.

use crate::generate::Generator;
use crate::storage::PrintStorage;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use rungc_emit::cycle::{self, Budget};
use rungc_ir::Module;
use rungc_ir::node::STEPS_PER_MS;
use rungc_syntax::DeviceClass;

impl Generator<'_> {
    /// The steps that a scan may repeat, unless the program changes D8000.
    pub fn initial_steps(&self) -> Literal {
        Literal::u32_unsuffixed(Module::scan_steps(self.module.watchdog_ms()))
    }

    /// A scan begins: the watchdog gives it its time, if it has one.
    pub fn watchdog_begins(&self) -> Option<TokenStream> {
        Some(match cycle::budget(self.module, &self.storage)? {
            Budget::Register(register) => {
                let plc = quote!(self);
                let ms = self.storage.word(&plc, DeviceClass::D, register)?;
                let steps = Literal::u32_unsuffixed(STEPS_PER_MS);
                quote!(self.steps_left = u32::from(#ms.max(1).unsigned_abs()) * #steps;)
            }
            Budget::Steps(steps) => {
                let steps = Literal::u32_unsuffixed(steps);
                quote!(self.steps_left = #steps;)
            }
        })
    }

    /// What stops a scan that does not end.
    pub fn watchdog(&mut self) -> TokenStream {
        let [trip, stop] = ["trip_watchdog", "Stop"].map(|name| self.rt(name));
        let doc = self.doc(
            "Counts the steps that a loop or a jump back repeats. After too many in one scan the PLC stops, as its watchdog would have it.",
        );
        quote! {
            #doc
            pub(crate) fn out_of_time(&mut self, steps: u32, step: u16) -> bool {
                if let Some(left) = self.steps_left.checked_sub(steps) {
                    self.steps_left = left;
                    return false;
                }
                self.steps_left = 0;
                if self.sys.running {
                    self.sys.running = false;
                    self.error.stop = #stop::Watchdog;
                    self.error.stop_step = step;
                    #trip(self);
                }
                true
            }
        }
    }

    /// The method of `Plc` that keeps an operation error for the host.
    pub fn note_error(&self) -> Option<TokenStream> {
        self.module.may_fail().then(|| {
            quote! {
                fn note_error(&mut self, code: u16, step: u32) {
                    self.error.code = code;
                    self.error.step = step as u16;
                    if let Some(on_error) = self.on_error {
                        on_error(self, code, step as u16);
                    }
                }
            }
        })
    }

    /// The method of `Program` that reports errors.
    pub fn last_error(&mut self) -> Option<TokenStream> {
        self.module.may_fail().then(|| {
            let error = self.rt("LastError");
            quote!(fn last_error(&self) -> #error { self.error })
        })
    }
}
