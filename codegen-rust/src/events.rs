//! Events outside the scan: flags that a host's interrupts set, and the methods that it calls for them.

use crate::generate::Generator;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::events;
use rungc_ir::node::{CellId, Flag, FlagId, TableId};
use rungc_rt::EdgeKind;
use std::rc::Rc;

/// The field of a flag.
pub(crate) fn flag_field(flag: &Flag) -> Ident {
    format_ident!("{}", flag.name)
}

/// The field of a serial port.
pub(crate) fn port_field(number: u8) -> Ident {
    format_ident!("port_{}", number)
}

/// The field of a pulse output.
pub(crate) fn axis_field(output: u32) -> Ident {
    format_ident!("y{:03o}_pulses", output)
}

/// The field that holds when a flag's period began.
pub(crate) fn since_field(flag: &Flag) -> Ident {
    format_ident!("{}_since", flag.name)
}

/// The name of a method's hardware, which it may not use.
pub(crate) fn hal_parameter(used: bool) -> Ident {
    format_ident!("{}", if used { "hal" } else { "_hal" })
}

impl Generator<'_> {
    /// The field of a flag.
    pub fn flag(&self, flag: FlagId) -> Ident {
        flag_field(&self.module.flags[flag])
    }

    /// The field of a cell.
    pub fn cell(&self, cell: CellId) -> Ident {
        format_ident!("{}", self.module.cells[cell].name)
    }

    /// The field of a table.
    pub fn table(&self, table: TableId) -> Ident {
        format_ident!("{}", self.module.tables[table].name)
    }

    /// Forgets what happened, when RUN begins.
    pub(crate) fn forget_flags(&mut self) -> TokenStream {
        let watch = self.periods_type();
        let flags = self.module.flags.iter().filter(|flag| !flag.retained);
        let flags = flags.map(|flag| {
            let field = flag_field(flag);
            quote!(self.#field = false;)
        });
        let since = self.module.periods().map(|(flag, _)| {
            let field = since_field(flag);
            quote!(self.#field = #watch::at(self.sys.clock.reading);)
        });
        flags.chain(since).collect()
    }

    /// The type of the stopwatches of periods, in programs with periods.
    fn periods_type(&mut self) -> Option<Ident> {
        let any = self.module.periods().next().is_some();
        any.then(|| self.rt("Milliseconds"))
    }

    /// Statement by which periods begin with the first scan.
    pub(crate) fn begin_periods(&mut self) -> Option<TokenStream> {
        let watch = self.periods_type()?;
        let begin = self.module.periods().map(|(flag, _)| {
            let (field, since) = (flag_field(flag), since_field(flag));
            quote!(self.#since = #watch::at(now_ms); self.#field = false;)
        });
        Some(quote!(if self.sys.scan == 0 { #(#begin)* }))
    }

    /// The methods that a host calls; nothing if the program takes no notice of anything outside its scan.
    pub(crate) fn event_methods(&mut self) -> TokenStream {
        let edge = self.input_edge();
        let tick = self.tick();
        let module = self.module;
        let plan = Rc::clone(&self.plan);
        let taker = events::interrupts(module).and_then(|root| plan.whole(root));
        let Some(function) = taker else {
            return quote!(#edge #tick);
        };
        let (needs_hal, function) = (function.needs_hardware, self.planned_name(function));
        let parameter = hal_parameter(needs_hal);
        let argument = needs_hal.then(|| quote!(, hal));
        let hal = self.rt("Hal");
        quote! {
            #edge
            #tick
            fn take_interrupts(&mut self, #parameter: &mut dyn #hal) {
                if self.sys.running { program::#function(self #argument); }
            }
        }
    }

    /// Advances time; `None` if that has no effect.
    fn tick(&mut self) -> Option<TokenStream> {
        if !self.module.takes_time() {
            return None;
        }
        let periods: Vec<TokenStream> = self
            .module
            .periods()
            .map(|(flag, ms)| {
                let (field, since) = (flag_field(flag), since_field(flag));
                let ms = Literal::u32_unsuffixed(ms);
                quote! {
                    if self.#since.ends_period(now_ms, #ms) {
                        self.#field = true;
                    }
                }
            })
            .collect();
        let clocks: Vec<TokenStream> = (0..)
            .zip(&self.module.cells)
            .filter(|(_, cell)| cell.follows_time)
            .map(|(i, _)| {
                let field = self.cell(CellId(i));
                quote!(self.#field = self.sys.clock.elapsed as i32;)
            })
            .collect();
        let pulses = self
            .module
            .sends_pulses()
            .then(|| quote!(self.count_pulses(hal, self.sys.now_us());));
        let ports = self.ports_advance();
        let passes = !self.module.ticks_only_note();
        let pass = passes.then(|| quote!(self.sys.tick(now_ms);));
        let asks = pulses.is_some() || ports.is_some();
        let says_nothing = periods.is_empty() && clocks.is_empty() && !asks;
        let (parameter, hal) = (hal_parameter(asks), self.rt("Hal"));
        (!says_nothing).then(|| {
            quote! {
                fn tick(&mut self, #parameter: &mut dyn #hal, now_ms: u32) {
                    #(#periods)* #pass #(#clocks)* #pulses #ports
                }
            }
        })
    }

    /// Statement that brings serial ports up to date.
    pub(crate) fn ports_advance(&self) -> Option<TokenStream> {
        let has_ports = self.module.has_ports();
        has_ports.then(|| quote!(self.advance_ports(hal, self.sys.now_us());))
    }

    /// The method that brings serial ports up to date.
    pub fn advance_ports(&mut self) -> Option<TokenStream> {
        if !self.module.has_ports() {
            return None;
        }
        if let Some(number) = self.module.slave_alone {
            let (advance, hal) = (self.rt("advance_slave"), self.rt("Hal"));
            let doc = self.doc("Brings the serial port up to date.");
            let ports = self.rt("Ports");
            let family = format_ident!("{}", format!("{:?}", self.module.model.ports));
            let number = Literal::u8_unsuffixed(number);
            return Some(quote! {
                #doc
                fn advance_ports(&mut self, hal: &mut dyn #hal, now_us: u32) {
                    #advance::<{ #ports::#family as u8 }, #number>(self, hal, now_us);
                }
            });
        }
        let (advance, hal, program) =
            (self.rt("advance_ports"), self.rt("Hal"), self.rt("Program"));
        let doc = self.doc("Brings the serial ports up to date, and changes over to RUN or STOP if a partner has asked for it.");
        Some(quote! {
            #doc
            fn advance_ports(&mut self, hal: &mut dyn #hal, now_us: u32) {
                if let Some(running) = #advance(self, hal, now_us) {
                    #program::set_running(self, running);
                }
            }
        })
    }

    /// The methods by which instructions and partners find serial ports.
    pub(crate) fn port_methods(&mut self) -> Option<TokenStream> {
        if !self.module.has_ports() {
            return None;
        }
        let (comm, ports) = (self.rt("comm"), self.rt("Ports"));
        let codecs = self.module.codecs().map(|codec| {
            let codec = format_ident!("{}", codec.name().to_ascii_uppercase());
            quote!(&#comm::codec::#codec)
        });
        let arms = self.module.ports.iter().map(|&number| {
            let field = port_field(number);
            let number = Literal::u8_unsuffixed(number);
            quote!(#number => Some(self.#field.parts()),)
        });
        let family = format_ident!("{}", format!("{:?}", self.module.model.ports));
        let type_code = Literal::u16_unsuffixed(self.module.model.type_code());
        let count = Literal::usize_unsuffixed(self.module.ports.len());
        let all = self.module.model.ports.all();
        let wirings = self.module.ports.iter().filter_map(|number| {
            let index = all.iter().position(|wiring| wiring.number == *number)?;
            let index = Literal::usize_unsuffixed(index);
            Some(quote!(#ports::#family.all()[#index]))
        });
        let modbus = self.module.modbus().map(|profile| {
            let profile = format_ident!("{}", profile.name.to_ascii_uppercase());
            quote! {
                fn modbus(&self) -> &'static #comm::modbus::Profile { &#comm::modbus::#profile }
            }
        });
        let (class, runs, run) = (self.rt("Class"), self.rt("Runs"), self.rt("StoredRun"));
        let areas = self.module.layout.areas.iter();
        let areas = areas.map(|area| (area.class, area.first, area.first + area.count - 1));
        let rows: Vec<_> = areas.collect();
        let rows = rows.into_iter().map(|(class, first, last)| {
            let [first, last] = [first, last].map(Literal::u32_unsuffixed);
            let class = self.class(class);
            quote!((#class, #first, #last))
        });
        let rows: Vec<_> = rows.collect();
        let what = self.module.slave_alone.is_none().then(|| {
            quote! {
                fn port_wiring(&self, index: usize) -> Option<&'static #comm::PortWiring> {
                    static WIRING: [#comm::PortWiring; #count] = [#(#wirings),*];
                    WIRING.get(index)
                }
            }
        });
        let codecs = self.module.slave_alone.is_none().then(|| {
            quote! {
                fn codecs(&self) -> &'static [&'static #comm::codec::Codec] {
                    &[#(#codecs),*]
                }
            }
        });
        Some(quote! {
            fn port(&mut self, number: u8) -> Option<#comm::PortMut<'_>> {
                match number { #(#arms)* _ => None }
            }
            #what
            #modbus
            #codecs
            fn ports(&self) -> #ports { #ports::#family }
            fn stored_run(&self, class: #class, number: u32) -> Option<#run> {
                #runs(&[#(#rows),*]).stored_run(class, number)
            }
            fn type_code(&self) -> u16 { #type_code }
        })
    }

    /// The method that counts pulses.
    pub fn count_pulses(&mut self) -> Option<TokenStream> {
        if !self.module.sends_pulses() {
            return None;
        }
        let (count, hal) = (self.rt("count_pulses"), self.rt("Hal"));
        let ends = self.module.flags.iter().filter_map(|flag| {
            let output = flag.pulses_end?;
            self.module.pulse_outputs.binary_search(&output).ok()?;
            let (field, axis) = (flag_field(flag), axis_field(output));
            Some(quote!(self.#field |= self.#axis.take_end();))
        });
        let doc = self.doc("Counts the pulses that have been sent by now, and takes notice of trains that have ended.");
        Some(quote! {
            #doc
            fn count_pulses(&mut self, hal: &mut dyn #hal, now_us: u32) {
                #count(self, hal, now_us);
                #(#ends)*
            }
        })
    }

    /// Number of pulse outputs that an interrupt shares with the program.
    pub fn pulse_outputs(&self) -> Option<TokenStream> {
        let last = self.module.pulse_outputs.last()?;
        let count = Literal::usize_unsuffixed(*last as usize + 1);
        let doc = self.doc("Pulse outputs from Y000 to the last one that is used: for `rungc_rt::board::SharedAxes`.");
        Some(quote!(#doc pub const PULSE_OUTPUTS: usize = #count;))
    }

    /// The method that drives the pins of pulse outputs.
    pub fn pulse_timer(&mut self) -> Option<TokenStream> {
        if !self.module.sends_pulses() {
            return None;
        }
        let (hal, timer) = (self.rt("Hal"), self.rt("pulse_timer"));
        Some(quote! {
            fn pulse_timer(&mut self, hal: &mut dyn #hal, now_us: u32) -> Option<u32> {
                #timer(self, hal, now_us)
            }
        })
    }

    /// Method that returns the state of a pulse output's pin.
    pub fn pins(&self) -> Option<TokenStream> {
        if !self.module.sends_pulses() {
            return None;
        }
        let arms = self.module.pulse_outputs.iter().map(|&output| {
            let field = axis_field(output);
            let number = Literal::u32_unsuffixed(output);
            quote!(#number => self.#field.on,)
        });
        Some(quote! {
            let pulse = match number { #(#arms)* _ => false };
        })
    }

    /// The methods by which instructions find pulse outputs.
    pub(crate) fn axis_methods(&mut self) -> Option<TokenStream> {
        if !self.module.sends_pulses() {
            return None;
        }
        let (axis, pulses) = (self.rt("Axis"), self.rt("Pulses"));
        let arms = self.module.pulse_outputs.iter().map(|&output| {
            let field = axis_field(output);
            let number = Literal::u32_unsuffixed(output);
            quote!(#number => Some(&mut self.#field),)
        });
        let family = format_ident!("{}", format!("{:?}", self.module.model.pulses));
        Some(quote! {
            fn axis(&mut self, output: u32) -> Option<&mut #axis> {
                match output { #(#arms)* _ => None }
            }
            fn pulses(&self) -> #pulses { #pulses::#family }
        })
    }

    fn input_edge(&mut self) -> TokenStream {
        let mut asks = false;
        let edges: Vec<TokenStream> = events::edges(self.module)
            .filter_map(|(root, input, kind)| {
                let function = self.plan.whole(root)?;
                asks |= function.needs_hardware;
                let hal = function.needs_hardware.then(|| quote!(, hal));
                let input = Literal::u32_unsuffixed(input);
                let level = match kind {
                    EdgeKind::Rising => quote!(level),
                    EdgeKind::Falling => quote!(!level),
                };
                let name = self.planned_name(function);
                Some(quote!(if number == #input && #level { program::#name(self #hal); }))
            })
            .collect();
        if edges.is_empty() {
            return TokenStream::new();
        }
        let (parameter, hal) = (hal_parameter(asks), self.rt("Hal"));
        quote! {
            fn input_edge(&mut self, #parameter: &mut dyn #hal, number: u32, level: bool) { #(#edges)* }
        }
    }
}
