//! Coils of timers and counters, and RST of them.

use crate::generate::{Generator, kind_name};
use crate::storage::{PrintField, PrintStorage};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use rungc_emit::storage::{Field, Kind};
use rungc_ir::node::{
    Action, Count, Counter16Coil, Counter32Coil, Expr, ExprId, IndexedCoil, Place, Stmt, TimerCoil,
};
use rungc_ir::reach;
use rungc_ir::walk::has_many_timers;
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;

/// Function that runs a timer selected by an index.
pub(crate) const OUT_TIMER: &str = "out_timer";
/// Function that runs a 16-bit counter selected by an index.
pub(crate) const OUT_COUNTER: &str = "out_counter";

/// Operations of a drive that fits on its coil's line.
const SHORT_DRIVE: u64 = 5;

impl Generator<'_> {
    /// OUT T.
    pub fn timer(&mut self, coil: &TimerCoil) -> TokenStream {
        let TimerCoil { number, kind, .. } = *coil;
        let Some(cell) = self.storage.cell(&quote!(plc), DeviceClass::T, number) else {
            return TokenStream::new();
        };
        let kind = self.coils.kind(number, kind);
        self.timer_coil(cell, kind, coil.drive, coil.preset)
    }

    /// END processing of a timer that continues.
    pub fn timer_goes_on(&mut self, number: u32, kind: TimerKind) -> TokenStream {
        let kind = self.timer_kind(self.coils.kind(number, kind));
        match self.storage.cell(&quote!(plc), DeviceClass::T, number) {
            Some(cell) => quote!(#cell.go_on(#kind, &plc.sys);),
            None => TokenStream::new(),
        }
    }

    /// OUT C of a 16-bit counter.
    pub fn counter16(&mut self, coil: &Counter16Coil) -> TokenStream {
        let (before, arguments) = self.drive_and_preset(coil.drive, coil.preset);
        let call = self.counter_call(coil.number, "run", &arguments);
        quote!(#before #call)
    }

    /// OUT C of a 32-bit counter.
    pub fn counter32(&mut self, coil: &Counter32Coil) -> TokenStream {
        let mut before = TokenStream::new();
        let drive = self.drive(coil.drive, &mut before);
        let (down, preset) = (self.expr(coil.down), self.expr(coil.preset));
        let call = self.counter_call(coil.number, "run", &quote!(#drive, #down, #preset));
        quote!(#before #call)
    }

    /// A count of a high-speed counter.
    pub fn count(&mut self, count: &Count) -> TokenStream {
        let (down, preset) = (self.expr(count.down), self.expr(count.preset));
        self.counter_call(count.number, "count", &quote!(#down, #preset))
    }

    fn counter_call(&self, number: u32, method: &str, arguments: &TokenStream) -> TokenStream {
        let method = format_ident!("{method}");
        let cell = self.storage.cell(&quote!(plc), DeviceClass::C, number);
        cell.map_or(
            TokenStream::new(),
            |cell| quote!(#cell.#method(#arguments);),
        )
    }

    /// Statements before a coil, and the first two arguments of the function that runs it.
    fn drive_and_preset(&mut self, drive: ExprId, preset: ExprId) -> (TokenStream, TokenStream) {
        let mut before = TokenStream::new();
        let drive = self.drive(drive, &mut before);
        let preset = self.expr(preset);
        (before, quote!(#drive, #preset))
    }

    /// A drive that would make a coil's line long gets a separate line.
    fn drive(&mut self, drive: ExprId, before: &mut TokenStream) -> TokenStream {
        let code = self.expr(drive).tokens;
        if self.plan.sizes.size(drive) <= SHORT_DRIVE {
            return code;
        }
        before.extend(quote!(let drive = #code;));
        quote!(drive)
    }

    /// A coil of a timer or counter that an index leads to.
    pub fn indexed_coil(&mut self, function: &str, coil: &IndexedCoil) -> TokenStream {
        if let Some(cell) = self.cell_of_iteration(coil.place) {
            return self.coil_of_iteration(cell, coil);
        }
        let function = format_ident!("{function}");
        let (_, number) = self.operand_place(coil.place);
        let (before, arguments) = self.drive_and_preset(coil.drive, coil.preset);
        quote!(#before #function(plc, #number, #arguments);)
    }

    /// A coil of the timer or counter of a loop's current iteration.
    fn coil_of_iteration(&mut self, cell: TokenStream, coil: &IndexedCoil) -> TokenStream {
        let IndexedCoil {
            place,
            drive,
            preset,
        } = *coil;
        if let (DeviceClass::T, Some(kind)) = (place.class, self.module.model.timer(place.number)) {
            let by = match place.index.map(|index| self.module.expr(index)) {
                Some(&Expr::Stride(_, by)) => by,
                _ => 0,
            };
            let kind = self
                .coils
                .kind_of_iterations(place.number, by, self.iterations, kind);
            return self.timer_coil(cell, kind, drive, preset);
        }
        let (before, arguments) = self.drive_and_preset(drive, preset);
        quote!(#before #cell.run(#arguments);)
    }

    fn timer_coil(
        &mut self,
        timer: TokenStream,
        kind: TimerKind,
        drive: ExprId,
        preset: ExprId,
    ) -> TokenStream {
        let (before, arguments) = self.drive_and_preset(drive, preset);
        let run = kind_name(kind).to_lowercase();
        self.timer_coils.insert(run.clone(), kind);
        let run = format_ident!("{run}");
        // The timer after what is read, which may be the timer itself.
        quote!(#before #run(#arguments, &mut #timer, &plc.sys);)
    }

    /// Writes a function for each kind of timer that coils run, so that the compiler knows what there is to do; in a
    /// program with very many timer coils it is called, not inlined.
    pub(crate) fn coils_of_kinds(&mut self) {
        let never = has_many_timers(self.module).then(|| quote!(#[inline(never)]));
        for (name, kind) in std::mem::take(&mut self.timer_coils) {
            let kind = self.timer_kind(kind);
            let [timer, sys] = ["Timer", "Sys"].map(|name| self.rt(name));
            let (doc, name) = (self.doc("OUT of a timer."), format_ident!("{name}"));
            let item = quote! {
                #doc
                #never
                fn #name(drive: bool, preset: i16, timer: &mut #timer, sys: &#sys) {
                    timer.run(#kind, drive, preset, sys);
                }
            };
            let item = self.item_of(item);
            self.items.push(item);
        }
    }

    /// Returns true if an index selects a device, rather than the iteration of a loop.
    fn is_indexed(&self, place: Place) -> bool {
        let index = place.index.map(|index| self.module.expr(index));
        index.is_some_and(|index| !matches!(index, Expr::Stride(..)))
    }

    /// RST of a timer or counter. A counter that it `holds` does not count at the next execution of its coil; no index
    /// leads to such a one.
    pub fn reset(&mut self, place: Place, holds: bool) -> TokenStream {
        let reset = |cell: TokenStream| match holds {
            true => quote!(#cell.hold();),
            false => quote!(#cell.reset();),
        };
        if let Some(cell) = self.cell_of_iteration(place) {
            return reset(cell);
        }
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            return quote!(plc.reset_at(#class, #number););
        }
        let cell = self.storage.cell(&quote!(plc), place.class, place.number);
        match cell {
            Some(cell) => reset(cell),
            None => TokenStream::new(),
        }
    }

    /// Writes the functions for coils that an index leads to, if there are any.
    pub(crate) fn indexed_coils(&mut self) {
        let (mut timers, mut counters) = (false, false);
        for function in &self.module.functions {
            rungc_ir::walk::statements(&function.body, &mut |stmt| {
                timers |=
                    matches!(stmt, Stmt::Do(Action::TimerAt(coil)) if self.is_indexed(coil.place));
                counters |= matches!(stmt, Stmt::Do(Action::Counter16At(coil)) if self.is_indexed(coil.place));
            });
        }
        if timers {
            let arms = self.timer_arms();
            let body = quote! {
                let (timer, kind) = match number { #arms _ => return };
                timer.run(kind, drive, preset, &plc.sys);
            };
            self.coil_function("OUT of a timer by its number.", OUT_TIMER, body);
        }
        if counters {
            let arms = self.counter_arms();
            let body = quote! {
                let counter = match number { #arms _ => return };
                counter.run(drive, preset);
            };
            self.coil_function("OUT of a 16-bit counter by its number.", OUT_COUNTER, body);
        }
    }

    fn coil_function(&mut self, doc: &str, name: &str, body: TokenStream) {
        self.uses.plc = true;
        let (doc, name, plc) = (self.doc(doc), format_ident!("{name}"), &self.type_name);
        let item = quote! {
            #doc
            fn #name(plc: &mut #plc, number: i32, drive: bool, preset: i16) { #body }
        };
        let item = self.item_of(item);
        self.items.push(item);
    }

    /// The arrays that an index leads to.
    fn reached(&self, class: DeviceClass) -> Vec<Field> {
        let runs = reach::by_index(self.module, class);
        let fields = self.storage.of_class(class).iter();
        let reached = fields.filter(|field| {
            let array = field.array && field.grid.is_none();
            array
                && runs
                    .iter()
                    .any(|run| field.first <= run.1 && run.0 <= field.last())
        });
        reached.copied().collect()
    }

    /// The timers and their kinds, by number.
    fn timer_arms(&mut self) -> TokenStream {
        let mut arms = TokenStream::new();
        for field in self.reached(DeviceClass::T) {
            for timers in self.module.model.timers {
                let first = timers.first.max(field.first);
                let last = timers.last.min(field.last());
                if first <= last {
                    let shared = TimerKind {
                        shared: true,
                        ..timers.kind
                    };
                    let (cell, kind) = (by_number(&field), self.timer_kind(shared));
                    let [first, last] = [first, last].map(Literal::u32_unsuffixed);
                    arms.extend(quote!(#first..=#last => (&mut #cell, #kind),));
                }
            }
        }
        arms
    }

    /// The 16-bit counters, by number.
    fn counter_arms(&self) -> TokenStream {
        self.reached(DeviceClass::C)
            .iter()
            .filter(|field| field.kind == Kind::Counter16)
            .map(|field| {
                let cell = by_number(field);
                let [first, last] = [field.first, field.last()].map(Literal::u32_unsuffixed);
                quote!(#first..=#last => &mut #cell,)
            })
            .collect()
    }
}

/// The device of an array whose number is in a variable. What an index leads to is stored in arrays.
fn by_number(field: &Field) -> TokenStream {
    let name = field.name();
    match field.first {
        _ if field.count == 1 => quote!(plc.#name[0]),
        0 => quote!(plc.#name[number as usize]),
        first => {
            let first = Literal::u32_unsuffixed(first);
            quote!(plc.#name[(number - #first) as usize])
        }
    }
}
