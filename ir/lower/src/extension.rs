//! Special modules that registers stand for: the analog board of H1U and H2U, the extension modules of HM, the analog
//! adapters and boards of FX, and where L01S and HM show which modules they have.

use super::Lowerer;
use super::operand::fixed;
use rungc_ir::node::{Access, Action, Arg, Expr, SysValue};
use rungc_rt::RtFn;
use rungc_rt::modules::{self, Bfm, Kind, Place, REGISTERS, Role};
use rungc_rt::special::*;
use rungc_syntax::DeviceClass::{D, M};

/// The first X and Y of the extension modules of HM.
const FIRST_TERMINAL: u32 = 0o20;

/// Maximum number of X, Y and registers of the extension modules of HM.
const MOST_TERMINALS: u32 = 128;
const MOST_WORDS: u32 = 384;

/// Registers of an extension module in the area that says where its words are.
const ADDRESSES: u32 = 7;

/// Registers of the exchange with a board.
const BOARD_WORDS: usize = 20;

/// The number in D8199 for analog boards.
const ANALOG_BOARD: i16 = 5;

/// An analog extension module of HM and its registers.
struct Extension {
    unit: u16,
    first: u32,
    /// Input values, then types and output values.
    reads: u32,
    writes: u32,
}

/// Terminals and registers of HM's extension modules.
struct Extensions {
    modules: Vec<Extension>,
    /// Values of the registers from D7100 on.
    shown: Vec<(Register, i16)>,
}

impl Lowerer<'_> {
    /// The modules that the settings list, by their numbers.
    fn fitted(&self) -> Vec<(u16, &'static Kind)> {
        let parameters = self.resolved.program.parameters.as_ref();
        let modules = parameters.map_or(&[][..], |parameters| &parameters.modules);
        let kinds = modules.iter();
        let kinds = kinds.filter_map(|module| Some((module.unit, Kind::find(module.kind)?)));
        let mut fitted: Vec<_> = kinds.collect();
        fitted.sort_by_key(|(unit, _)| *unit);
        fitted
    }

    /// Before the program: what a board answers, and what the registers of modules show.
    pub(super) fn begin_modules(&mut self) {
        let fitted = self.fitted();
        if fitted.iter().any(|(_, kind)| kind.place == Place::Slot) {
            self.exchange_board();
        }
        for adapter in self.adapters(&fitted) {
            self.module.fitted_words.extend(adapter.defaults());
            self.exchange_adapter(&adapter, adapter.received);
        }
        let on_bus: Vec<_> = fitted
            .iter()
            .filter(|(_, kind)| self.model.module_places.contains(&kind.place))
            .collect();
        if self.model.module_places.contains(&Place::L01s) {
            let kinds: Vec<_> = on_bus.iter().map(|(_, kind)| *kind).collect();
            self.show_once(types(&kinds));
        }
        if self.model.module_places.contains(&Place::Hm) && !on_bus.is_empty() {
            let extensions = Extensions::of(&fitted);
            self.show_once(extensions.shown);
        }
    }

    /// After the program: outputs of adapters, and the exchange with the extension modules of HM.
    pub(super) fn end_modules(&mut self) {
        let fitted = self.fitted();
        for adapter in self.adapters(&fitted) {
            if adapter.kind.outputs > 0 {
                self.exchange_adapter(&adapter, 0);
            }
        }
        if !self.model.module_places.contains(&Place::Hm) {
            return;
        }
        for module in Extensions::of(&fitted).modules {
            let n = module.reads + module.writes;
            let registers = Register(module.first as u16);
            let registers: Vec<_> = (0..n).map(|word| registers.after(word)).collect();
            let times = D_EXTENSION_TIMES.run::<4>();
            let args = vec![
                constant(module.unit.into()),
                Arg::Device {
                    place: fixed(D, module.first),
                    extent: Some(n),
                },
                constant(module.reads as i32),
                constant(n as i32),
                Arg::Device {
                    place: fixed(D, D_EXTENSION_TIMES.number()),
                    extent: Some(4),
                },
            ];
            let registers = [&registers[..], &times].concat();
            self.call_system_with(RtFn::ExchangeModule, &registers, args);
        }
    }

    /// The analog adapters and boards whose relays or registers the program looks at.
    fn adapters(&self, fitted: &[(u16, &'static Kind)]) -> Vec<Adapter> {
        let adapters = fitted.iter().filter_map(|&(unit, kind)| {
            let is_its = self.model.module_places.contains(&kind.place);
            let first = self.model.module_devices(unit).filter(|_| is_its)?;
            Some(Adapter::new(unit, kind, first))
        });
        let is_used = |adapter: &Adapter| {
            let [relays, registers] = adapter.counts;
            let first = adapter.first as u16;
            let mut relays = (0..relays).map(|n| Relay(first).after(n));
            let mut registers = (0..registers).map(|n| Register(first).after(n));
            relays.any(|relay| self.specials.has(relay))
                || registers.any(|register| self.specials.has(register))
        };
        adapters.filter(is_used).collect()
    }

    /// The exchange with an analog adapter or board; `received` has a bit for each word that comes from it.
    fn exchange_adapter(&mut self, adapter: &Adapter, received: i32) {
        let [relays, registers] = adapter.counts;
        for relay in 0..relays {
            self.specials.flags.push((M, adapter.first + relay));
        }
        let own = (0..registers).map(|n| Register(adapter.first as u16).after(n));
        let own: Vec<_> = own.collect();
        let run = |class, count| Arg::Device {
            place: fixed(class, adapter.first),
            extent: Some(count),
        };
        let args = vec![
            constant(adapter.unit.into()),
            run(M, relays),
            run(D, registers),
            constant(adapter.sent),
            constant(received),
        ];
        self.call_system_with(RtFn::ExchangeAdapter, &own, args);
    }

    /// The exchange with an analog board, if the program looks at its registers.
    fn exchange_board(&mut self) {
        let registers = D_BOARD.run::<BOARD_WORDS>();
        if !registers
            .iter()
            .any(|&register| self.specials.has(register))
        {
            return;
        }
        // On H1U, the program sets which board there is.
        let kind = match self.model.finds_boards {
            true => constant(ANALOG_BOARD.into()),
            false => Arg::Device {
                place: fixed(D, D_BOARD_TYPE.number()),
                extent: Some(1),
            },
        };
        if self.model.finds_boards && self.specials.has(D_BOARD_TYPE) {
            self.show_once(vec![(D_BOARD_TYPE, ANALOG_BOARD)]);
        }
        let exchanged = Arg::Device {
            place: fixed(D, D_BOARD.number()),
            extent: Some(BOARD_WORDS as u32),
        };
        let registers = [&registers[..], &[D_BOARD_TYPE]].concat();
        self.call_system_with(RtFn::ExchangeBoard, &registers, vec![kind, exchanged]);
    }

    /// Registers that show these values from the first scan on, if something looks at them.
    fn show_once(&mut self, shown: Vec<(Register, i16)>) {
        let shown = shown.into_iter();
        let shown =
            shown.filter(|&(register, _)| self.specials.has(register) || self.looks_at(register));
        let shown: Vec<_> = shown.collect();
        if shown.is_empty() {
            return;
        }
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        self.when(first, |this| {
            for (register, value) in shown {
                let value = this.add(Expr::I16(value));
                this.emit(Action::Write(Access::word(register), value));
            }
        });
    }
}

fn constant(value: i32) -> Arg {
    Arg::Const {
        value,
        index: None,
        wide: false,
    }
}

/// An analog adapter or board and its special devices.
struct Adapter {
    unit: u16,
    kind: &'static Kind,
    /// Number of its first relay and register.
    first: u32,
    /// Numbers of relays and registers from the first to its last.
    counts: [u32; 2],
    /// A bit for each word that goes to it.
    sent: i32,
    /// A bit for each word that comes from it.
    received: i32,
}

impl Adapter {
    fn new(unit: u16, kind: &'static Kind, first: u32) -> Self {
        let mut adapter = Adapter {
            unit,
            kind,
            first,
            counts: [1; 2],
            sent: 0,
            received: 0,
        };
        for (word, bfm) in adapter.words() {
            let [relays, registers] = &mut adapter.counts;
            match word.checked_sub(REGISTERS) {
                None => *relays = (*relays).max(u32::from(word) + 1),
                Some(n) => *registers = (*registers).max(u32::from(n) + 1),
            }
            match bfm.access {
                modules::Access::Read => adapter.received |= 1 << word,
                modules::Access::ReadWrite | modules::Access::Retained => adapter.sent |= 1 << word,
            }
        }
        adapter
    }

    /// The words that devices stand for, and their rows.
    fn words(&self) -> impl Iterator<Item = (u16, &'static Bfm)> + use<> {
        let rows = self
            .kind
            .bfms
            .iter()
            .filter(|bfm| bfm.role != Role::Exchange);
        rows.flat_map(|bfm| bfm.numbers().map(move |word| (word, bfm)))
    }

    /// Registers that the program sets and that start with a value other than 0.
    fn defaults(&self) -> impl Iterator<Item = (Register, i16)> + use<> {
        let first = Register(self.first as u16);
        let set = self
            .words()
            .filter(|(_, bfm)| bfm.access != modules::Access::Read);
        set.filter(|(_, bfm)| bfm.default != 0)
            .filter_map(move |(word, bfm)| {
                let n = word.checked_sub(REGISTERS)?;
                Some((first.after(n.into()), bfm.default))
            })
    }
}

/// D8108 and D8260 … of L01S: how many modules there are, and the type of each, two in a register.
fn types(kinds: &[&Kind]) -> Vec<(Register, i16)> {
    let id = |kind: &&Kind| kind.with(Role::Identification).map_or(0, |bfm| bfm.default);
    let pairs = kinds.chunks(2).map(|pair| {
        let ids: Vec<_> = pair.iter().map(id).collect();
        ids.iter().rev().fold(0, |word, id| word << 8 | id & 0xff)
    });
    let types = (0..).zip(pairs);
    let types = types.map(|(n, word)| (D_MODULE_TYPES.after(n), word));
    std::iter::once((D_MODULE_COUNT, kinds.len() as i16))
        .chain(types)
        .collect()
}

impl Extensions {
    /// In the order of the modules: whole bytes of terminals, and registers for input values, input types, output
    /// types, output values and a buffer as long as what is written.
    fn of(fitted: &[(u16, &'static Kind)]) -> Self {
        let mut next = [FIRST_TERMINAL; 2];
        let mut register = D_EXTENSION_DATA.number();
        let mut all = Extensions {
            modules: Vec::new(),
            shown: Vec::new(),
        };
        let extensions = fitted.iter().filter(|(_, kind)| kind.place == Place::Hm);
        for (n, (unit, kind)) in (0..).zip(extensions) {
            let at = D_EXTENSIONS.after(n * ADDRESSES);
            for (place, count) in (0..).zip(kind.points) {
                let first = &mut next[place as usize];
                let value = if count == 0 { 0 } else { *first };
                all.shown.push((at.after(place), value as i16));
                *first += u32::from(count.next_multiple_of(8));
            }
            let words = |role| kind.with(role).map_or(0, |bfm| u32::from(bfm.count));
            let reads = words(Role::Present);
            let roles = [Role::InputTypes, Role::OutputTypes, Role::Output];
            let writes = roles.into_iter().map(words).sum::<u32>();
            if reads + writes > 0 {
                for (place, first) in
                    (4..).zip([register, register + reads, register + reads + writes])
                {
                    all.shown.push((at.after(place), first as i16));
                }
                all.modules.push(Extension {
                    unit: *unit,
                    first: register,
                    reads,
                    writes,
                });
            }
            register += reads + 2 * writes;
        }
        let count = fitted.iter().filter(|(_, kind)| kind.place == Place::Hm);
        all.shown.push((D_EXTENSION_COUNT, count.count() as i16));
        let too_many = next
            .iter()
            .any(|next| next - FIRST_TERMINAL > MOST_TERMINALS)
            || register - D_EXTENSION_DATA.number() > MOST_WORDS;
        all.shown.push((D_EXTENSION_ERROR, too_many.into()));
        all
    }
}
