//! The scan, and the RUN/STOP switch.

use crate::events::hal_parameter;
use crate::generate::{Generator, Item};
use crate::storage::PrintStorage;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::cycle::{self, Latches};
use rungc_ir::node::FunctionKind;
use rungc_models::special::RunCommand;
use rungc_rt::special::{
    D_REMOTE, M_FORCE_ENABLE, M_FORCED_RUN, M_KEEP_IN_STOP, M_LOCAL_CONTROL, M_OUTPUTS_OFF,
    M_REMOTE_RUN, REMOTE_KEY, Register, Relay,
};
use rungc_syntax::DeviceClass;

impl Generator<'_> {
    /// The scan.
    pub(crate) fn program_impl(&mut self) -> Item {
        self.uses = Default::default();
        let name = self.type_name.clone();
        let (program, hal) = (self.rt("Program"), self.rt("Hal"));
        let call = |this: &Self, kind: FunctionKind| {
            let mut functions = this.module.functions.iter();
            let function = this.plan.whole(functions.position(|f| f.kind == kind)?)?;
            let name = this.planned_name(function);
            let hal = function.needs_hardware.then(|| quote!(, hal));
            Some(quote!(program::#name(self #hal);))
        };
        let begin = call(self, FunctionKind::Begin);
        let main = call(self, FunctionKind::Main);
        let end = call(self, FunctionKind::End);
        let asks = |root: usize| self.plan.whole(root).is_some_and(|f| f.needs_hardware);
        let hal_name = hal_parameter(self.module.has_ports() || (0..3).any(asks));
        let in_run =
            (main.is_some() || end.is_some()).then(|| quote!(if self.sys.running { #main #end }));
        let (obey, forget_command) = self.run_command();
        let stop = match self.special_relay(M_KEEP_IN_STOP) {
            Some(keep) => quote!({ #forget_command if !#keep { self.clear_general(); } }),
            None => quote!({
                #forget_command
                self.clear_general();
            }),
        };
        let power_cycle = self.power_cycle();
        let events = self.event_methods();
        let periods = self.begin_periods();
        let count_pulses = self
            .module
            .sends_pulses()
            .then(|| quote!(self.count_pulses(hal, self.sys.now_us());));
        let constant_scan = self.constant_scan();
        let ports = self.ports_advance();
        let watchdog = self.watchdog_begins(&quote!(self));
        let retained = self.retained();
        let last_error = self.last_error();
        let pulse_timer = self.pulse_timer();
        let output = self.output();
        self.uses.plc = false;
        self.item_of(quote! {
            impl #program for #name {
                fn scan(&mut self, #hal_name: &mut dyn #hal, now_ms: u32, scan_us: u32) {
                    #obey
                    #periods
                    self.sys.begin_scan(now_ms, scan_us);
                    #count_pulses
                    #ports
                    #watchdog
                    #begin
                    #in_run
                    self.sys.end_scan();
                    #ports
                }
                #constant_scan
                #events
                fn set_running(&mut self, running: bool) {
                    if !self.sys.set_running(running) { return; }
                    if running { self.forget(); } else #stop
                }
                #power_cycle
                #pulse_timer
                #retained
                #last_error
                #output
            }
        })
    }

    /// Statements that execute M8035 and M8036 or their equivalents when a scan begins, and those that reset them in
    /// STOP.
    fn run_command(&mut self) -> (Option<TokenStream>, Option<TokenStream>) {
        let program = self.rt("Program");
        let obeyed = match cycle::run_command(self.module, &self.storage) {
            Some(RunCommand::Forced) => self
                .special_relay(M_FORCE_ENABLE)
                .zip(self.special_relay(M_FORCED_RUN))
                .map(|(enable, run)| {
                    let obey = quote! {
                        if !self.sys.running & #enable & #run {
                            #run = false;
                            #program::set_running(self, true);
                        }
                    };
                    (obey, Some(quote!(#run = false;)))
                }),
            Some(RunCommand::Remote) => self.remote_control().map(|(remote, run)| {
                let obey = quote!(if #remote { #program::set_running(self, #run); });
                (obey, None)
            }),
            None => None,
        };
        match obeyed {
            Some((obey, forget)) => (Some(obey), forget),
            None => (None, None),
        }
    }

    /// Conditions for remote control of HM, and for its RUN command.
    fn remote_control(&self) -> Option<(TokenStream, TokenStream)> {
        let key = self.special_register(D_REMOTE)?;
        let local = self.special_relay(M_LOCAL_CONTROL)?;
        let run = self.special_relay(M_REMOTE_RUN)?;
        let value = Literal::i16_unsuffixed(REMOTE_KEY);
        Some((quote!((#key == #value) & !#local), quote!(#run)))
    }

    /// The method that asks for scans of constant length.
    fn constant_scan(&self) -> Option<TokenStream> {
        let asks = cycle::constant_scan(self.module, &self.storage)?;
        let ms = self.special_register(asks.register)?;
        let on = match asks.relay {
            Some(relay) => Some(self.special_relay(relay)?),
            None => None,
        };
        let on = on.map(|on| quote!(#on &&));
        Some(quote! {
            fn constant_scan_ms(&self) -> Option<u16> {
                (#on #ms > 0).then_some(#ms as u16)
            }
        })
    }

    /// The method that names what the program keeps over power-off.
    fn retained(&mut self) -> Option<TokenStream> {
        let key = match cycle::latches(self.module, &self.storage) {
            Latches::Retained => quote!(None),
            Latches::RetainedIf(register, key) => {
                let register = Literal::u32_unsuffixed(register);
                let key = Literal::i16_unsuffixed(key);
                quote!(Some((#register, #key)))
            }
            Latches::Lost(..) => return None,
        };
        let runs = self.module.retained();
        if runs.is_empty() {
            return None;
        }
        let retain = self.rt("retain");
        let class = self.rt("Class");
        let rows = runs.iter().map(|row| {
            let name = format_ident!("{}", format!("{:?}", row.class));
            let [first, count] = [row.first, row.count].map(Literal::u16_unsuffixed);
            quote!(#retain::RetainedRun::new(#class::#name, #first, #count))
        });
        let program = self.module.retained_as();
        let contacts = self.module.model.keeps_contacts;
        let resets = self.retained_resets(&class);
        Some(quote! {
            fn retained(&self) -> #retain::Retained<'_> {
                #retain::Retained { program: #program, runs: const { &[#(#rows),*] }, contacts: #contacts, key: #key }
            }
            #resets
        })
    }

    /// The methods for the reset states that are retained; nothing if there are none.
    fn retained_resets(&self, class: &Ident) -> Option<TokenStream> {
        let resets: Vec<_> = self.module.retained_resets().collect();
        let (mut states, mut changes) = (TokenStream::new(), TokenStream::new());
        for &(of, number, flag) in &resets {
            let of = format_ident!("{of:?}");
            let number = Literal::u32_unsuffixed(number);
            let field = self.flag(flag);
            states.extend(quote!((#class::#of, #number) => self.#field,));
            changes.extend(quote! {
                if (class, number) == (#class::#of, #number) {
                    self.#field = reset;
                }
            });
        }
        (!resets.is_empty()).then(|| {
            quote! {
                fn is_reset(&self, class: #class, number: u32) -> bool {
                    match (class, number) { #states _ => false }
                }
                fn set_reset(&mut self, class: #class, number: u32, reset: bool) {
                    #changes
                }
            }
        })
    }

    /// A special register, if it is stored.
    fn special_register(&self, register: Register) -> Option<TokenStream> {
        self.storage
            .word(&quote!(self), DeviceClass::D, register.number())
    }

    /// A special relay, if it is stored and means on the model what it means on most.
    fn special_relay(&self, relay: Relay) -> Option<TokenStream> {
        let keeps = cycle::keeps(self.module, &self.storage, relay);
        let cell = || {
            self.storage
                .bit(&quote!(self), DeviceClass::M, relay.number())
        };
        keeps.then(cell).flatten()
    }

    /// The state of an output terminal.
    fn output(&mut self) -> TokenStream {
        let class = self.class(DeviceClass::Y);
        let plc_trait = self.rt("Plc");
        // The watchdog switches off what STOP would keep.
        let keep = match self.special_relay(M_KEEP_IN_STOP) {
            Some(keep) if self.module.has_watchdog() => {
                let stop = self.rt("Stop");
                quote!((self.sys.running | (#keep & (self.error.stop != #stop::Watchdog))))
            }
            Some(keep) => quote!((self.sys.running | #keep)),
            None => quote!(self.sys.running),
        };
        let off = self.special_relay(M_OUTPUTS_OFF).map(|off| quote!(& !#off));
        let pins = self.pins();
        let image = quote!(#plc_trait::bit(self, #class, number).unwrap_or(false));
        let level = match pins {
            Some(_) => quote!((pulse | #image)),
            None => image,
        };
        quote! {
            fn output(&self, number: u32) -> bool {
                #pins
                #keep #off & #level
            }
        }
    }
}
