//! Watchdog of a scan that does not end, and queries for a host after an error.

use crate::generate::Generator;
use crate::storage::PrintStorage;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};
use rungc_emit::cycle::{self, Budget, Shown, Shows};
use rungc_ir::Module;
use rungc_ir::node::STEPS_PER_MS;
use rungc_rt::ErrorRules;
use rungc_rt::special::WATCHDOG_CODE;
use rungc_syntax::DeviceClass;

impl Generator<'_> {
    /// The steps that a scan may repeat, unless the program changes D8000.
    pub(crate) fn initial_steps(&self) -> Literal {
        Literal::u32_unsuffixed(Module::scan_steps(self.module.watchdog_ms()))
    }

    /// The watchdog gives a scan its time, if there is one.
    pub fn watchdog_begins(&self, plc: &TokenStream) -> Option<TokenStream> {
        Some(match cycle::budget(self.module, &self.storage)? {
            Budget::Register(register) => {
                let ms = self.storage.word(plc, DeviceClass::D, register)?;
                let steps = Literal::u32_unsuffixed(STEPS_PER_MS);
                quote!(#plc.steps_left = u32::from(#ms.max(1).unsigned_abs()) * #steps;)
            }
            Budget::Steps(steps) => {
                let steps = Literal::u32_unsuffixed(steps);
                quote!(#plc.steps_left = #steps;)
            }
        })
    }

    /// Method of the watchdog, which stops a scan that does not end.
    pub fn watchdog(&mut self) -> TokenStream {
        let stop = self.rt("Stop");
        let shows = self.show(&cycle::watchdog_shows(self.module.model, &self.storage));
        let code = Literal::u16_unsuffixed(WATCHDOG_CODE);
        let logged = self.log_error(&quote!(#code));
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
                    #(#shows)*
                    #logged
                }
                true
            }
        }
    }

    /// The method that reports an operation error which the program finds itself (see the runtime's `report`), as far
    /// as the program looks at it.
    pub(crate) fn fault_method(&mut self) -> TokenStream {
        let [first, each] = cycle::fault_shows(self.module.model, &self.storage);
        let shown = self.show(&first);
        let first = match first.first() {
            Some(&(class, number, Shown::On)) => {
                let relay = self.storage.bit(&quote!(self), class, number);
                quote!(if !#relay { #(#shown)* })
            }
            _ => quote!(#(#shown)*),
        };
        let each = self.show(&each);
        let logged = self.log_error(&quote!(code));
        let plc = self.rt("Plc");
        let doc = self.doc(
            "An operation error: the instruction is skipped, the error shown in the special devices that the program looks at.",
        );
        quote! {
            #doc
            pub(crate) fn fault(&mut self, code: u16, step: u16) {
                #first
                #(#each)*
                #logged
                #plc::note_error(self, code, step.into());
            }
        }
    }

    /// The statement by which an error enters the log, if the program keeps one.
    fn log_error(&mut self, code: &TokenStream) -> Option<TokenStream> {
        cycle::error_rules(self.module, &self.storage)
            .logs
            .then(|| {
                let log = self.rt("log_error");
                quote!(#log(self, #code);)
            })
    }

    /// The statements by which special devices show an error.
    fn show(&self, shows: &[Shows]) -> Vec<TokenStream> {
        let plc = quote!(self);
        let statement = |&(class, number, shown): &Shows| {
            let value = match shown {
                Shown::On => {
                    let relay = self.storage.bit(&plc, class, number)?;
                    return Some(quote!(#relay = true;));
                }
                Shown::Word(value) => Literal::i16_unsuffixed(value).into_token_stream(),
                Shown::Code => quote!(code as i16),
                Shown::Step => quote!(step as i16),
            };
            let register = self.storage.word(&plc, class, number)?;
            Some(quote!(#register = #value;))
        };
        shows.iter().filter_map(statement).collect()
    }

    /// The method of `Plc` for the consequences of errors.
    pub(crate) fn error_rules(&mut self) -> Option<TokenStream> {
        let ErrorRules {
            sums_up_ports,
            logs,
        } = cycle::error_rules(self.module, &self.storage);
        (sums_up_ports || logs).then(|| {
            let rules = self.rt("ErrorRules");
            quote! {
                fn error_rules(&self) -> #rules {
                    #rules { sums_up_ports: #sums_up_ports, logs: #logs }
                }
            }
        })
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
