//! Blocks that an index leads to, or whose length is in a register: inline code does what the runtime's functions do,
//! near the ends of the devices, with overlaps, and where the instruction faults.

use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::runs::rt_class;
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, Cx, NoHal, Operand, OperandKind, Plc, Program, RtFn, Site, conclude};
use rungc_syntax::{Device, DeviceClass, Index};

/// Instructions of each model.
const INSTRUCTIONS: u32 = 120;
/// Executions of each.
const ROUNDS: u32 = 25;
/// Devices that are compared at each end of a class.
const WINDOW: u32 = 90;
/// An index that the program keeps in bounds, and the register that it is made from.
const BOUNDED: u32 = 390;

/// An operand: what is written, and what the runtime is handed for values of the index registers.
#[derive(Clone, Copy)]
enum Part {
    Device(Device, Option<Index>),
    Constant(i32, Option<Index>),
}

impl Part {
    fn text(self) -> String {
        match self {
            Part::Device(device, index) => with_index(device.to_string(), index),
            Part::Constant(value, index) => with_index(format!("K{value}"), index),
        }
    }

    /// The operand of the runtime's function.
    fn operand(self, machine: &Machine, wide: bool) -> Operand {
        let add = |base: i32, index: Option<Index>| match index {
            None => base,
            Some(Index { class, number }) => {
                let word = |class| {
                    let class = rt_class(class).expect("a class");
                    machine.word(class, number).unwrap_or(0)
                };
                let low = word(class);
                match wide && class == DeviceClass::Z && machine.z_pairs_with_v() {
                    true => base + rungc_rt::word::pair(low, word(DeviceClass::V)),
                    false => base + i32::from(low),
                }
            }
        };
        match self {
            Part::Device(device, index) => {
                let class = rt_class(device.class).expect("a class");
                Operand::device(class, add(device.number as i32, index))
            }
            Part::Constant(value, index) => Operand::constant(add(value, index)),
        }
    }
}

fn with_index(text: String, index: Option<Index>) -> String {
    match index {
        Some(Index { class, number }) => format!("{text}{}{number}", class.prefix()),
        None => text,
    }
}

/// Makes instructions for one model.
struct Maker {
    rng: Rng,
    model: &'static Model,
    /// All indexes are bounded by the program.
    bounded: bool,
}

impl Maker {
    fn class(&mut self, classes: &[DeviceClass]) -> DeviceClass {
        let known = |class: &DeviceClass| !self.model.runs(*class).is_empty();
        let classes: Vec<DeviceClass> = classes.iter().copied().filter(known).collect();
        self.rng.pick(&classes).expect("a class of the model")
    }

    fn index(&mut self) -> Option<Index> {
        let class = match self.rng.percent(70) {
            true => DeviceClass::Z,
            false => DeviceClass::V,
        };
        let number = if self.bounded { 0 } else { self.rng.below(3) };
        self.rng.percent(65).then_some(Index { class, number })
    }

    /// A device near an end of the ordinary ones of its class.
    fn device(&mut self, classes: &[DeviceClass]) -> Part {
        let class = self.class(classes);
        let (first, last) = self.model.runs(class)[0];
        let offset = self.rng.below(40);
        let number = match self.rng.percent(60) {
            true => first + offset.min(last - first),
            false => last.saturating_sub(offset).max(first),
        };
        Part::Device(Device { class, number }, self.index())
    }

    fn words(&mut self) -> Part {
        self.device(&[DeviceClass::D, DeviceClass::D, DeviceClass::R])
    }

    fn bits(&mut self) -> Part {
        self.device(&[
            DeviceClass::M,
            DeviceClass::M,
            DeviceClass::S,
            DeviceClass::Y,
        ])
    }

    fn constant(&mut self, most: u32) -> Part {
        Part::Constant(1 + self.rng.below(most) as i32, None)
    }

    /// The length of BMOV or FMOV.
    fn length(&mut self) -> Part {
        match self.rng.below(4) {
            0 => Part::Device(
                Device {
                    class: DeviceClass::D,
                    number: 5,
                },
                None,
            ),
            1 => Part::Constant(3, self.index()),
            _ => self.constant(30),
        }
    }

    fn instruction(&mut self) -> (&'static str, RtFn, Vec<Part>) {
        let by = 1 + self.rng.below(4);
        let length = by + self.rng.below(30);
        let [length, by] = [length, by].map(|n| Part::Constant(n as i32, None));
        match self.rng.below(9) {
            0 | 1 => {
                let function = if self.model.id == ModelId::Hm {
                    RtFn::BmovForward
                } else {
                    RtFn::Bmov
                };
                let parts = vec![self.words(), self.words(), self.length()];
                ("BMOV", function, parts)
            }
            2 => (
                "FMOV",
                RtFn::Fmov,
                vec![self.words(), self.words(), self.length()],
            ),
            3 => {
                let parts = vec![self.words(), self.words(), self.constant(20)];
                ("DFMOV", RtFn::Fmov, parts)
            }
            4 => {
                let first = if self.rng.percent(50) {
                    self.words()
                } else {
                    self.bits()
                };
                let Part::Device(device, index) = first else {
                    return ("", RtFn::Zrst, Vec::new());
                };
                let (_, end) = self.model.runs(device.class)[0];
                let number = (device.number + self.rng.below(30)).min(end);
                let index = if self.rng.percent(50) {
                    self.index()
                } else {
                    index
                };
                let last = Part::Device(Device { number, ..device }, index);
                ("ZRST", RtFn::Zrst, vec![first, last])
            }
            5 => {
                let (name, function) =
                    [("SFTL", RtFn::Sftl), ("SFTR", RtFn::Sftr)][self.rng.below(2) as usize];
                (name, function, vec![self.bits(), self.bits(), length, by])
            }
            6 => {
                let (name, function) =
                    [("WSFL", RtFn::Wsfl), ("WSFR", RtFn::Wsfr)][self.rng.below(2) as usize];
                (name, function, vec![self.words(), self.words(), length, by])
            }
            7 => {
                let parts = vec![self.words(), self.words(), Part::Constant(9, None)];
                ("SFWR", RtFn::Sfwr, parts)
            }
            _ => {
                let parts = vec![self.words(), self.words(), Part::Constant(9, None)];
                ("SFRD", RtFn::Sfrd, parts)
            }
        }
    }
}

/// The devices that are set and compared: both ends of the ordinary ones, and the first special ones that no scan
/// writes.
fn windows(model: &Model) -> Vec<(DeviceClass, u32)> {
    use DeviceClass::{D, M, R, S, Y};
    let mut devices = Vec::new();
    for class in [D, R, M, S, Y] {
        let Some(&(first, last)) = model.runs(class).first() else {
            continue;
        };
        let low = first..=last.min(first + WINDOW);
        let high = last.saturating_sub(WINDOW).max(first)..=last;
        devices.extend(low.chain(high).map(|number| (class, number)));
    }
    devices.sort();
    devices.dedup();
    devices
}

/// The text of a program that executes an instruction while X0 is on.
fn text(instruction: &str, bounded: bool, reversible: bool) -> String {
    let mut text = String::new();
    if bounded {
        let other = BOUNDED + 1;
        text += &format!("LD X000\nWAND D{BOUNDED} H1F Z0\nWAND D{other} H0F V0\n");
    }
    if reversible {
        text += "LD X001\nOUT M8024\n";
    }
    format!("{text}LD X000\n{instruction}\nEND\n")
}

fn compiled(text: &str, model: &Model, bounded: bool) -> Option<Module> {
    let read = rungc_frontend::read_text("test.il", text);
    let mut observe = windows(model);
    let registers = if bounded { &[][..] } else { &[0, 1, 2] };
    for class in [DeviceClass::V, DeviceClass::Z] {
        observe.extend(registers.iter().map(|&number| (class, number)));
    }
    let error = model.error_relay.number();
    observe.extend([(DeviceClass::M, error), (DeviceClass::D, 8067)]);
    let options = CompileOptions {
        model: Some(model.id),
        observe,
        optimise: true,
        ..CompileOptions::default()
    };
    compile(&read.program, &options).module
}

fn calls(module: &Module, function: RtFn) -> bool {
    let mut calls = false;
    for part in &module.functions {
        statements(&part.body, &mut |stmt| {
            calls |= matches!(stmt, Stmt::Do(Action::Call(call)) if call.function == function);
        });
    }
    calls
}

fn set(machine: &mut Machine, (class, number): (DeviceClass, u32), value: i16) {
    let class = rt_class(class).expect("a class");
    if machine.set_word(class, number, value).is_none() {
        machine.set_bit(class, number, value & 1 == 1);
    }
}

fn get(machine: &Machine, (class, number): (DeviceClass, u32)) -> Option<i16> {
    let class = rt_class(class).expect("a class");
    let bit = || machine.bit(class, number).map(i16::from);
    machine.word(class, number).or_else(bit)
}

/// Values that bring an index to the ends of the devices often.
fn index_value(rng: &mut Rng) -> i16 {
    let ends = [
        0, 0, 0, 0, -32768, 32767, 7999, -7999, 8000, 7679, -7679, 4095, 32767,
    ];
    let end = rng.pick(&ends).unwrap_or(0);
    (end + rng.below(60) as i32 - 25).clamp(-32768, 32767) as i16
}

/// Gives index registers values, or the registers that they are made from.
fn set_registers(rng: &mut Rng, bounded: bool, wide: bool, mut machines: [&mut Machine; 2]) {
    let numbers = if bounded { 0..1 } else { 0..3 };
    let registers = numbers.flat_map(|n| [(DeviceClass::Z, n), (DeviceClass::V, n)]);
    for (class, number) in registers {
        let high_word = wide && class == DeviceClass::V;
        let mut value = if high_word { 0 } else { index_value(rng) };
        if bounded {
            let (register, mask) = if class == DeviceClass::Z {
                (BOUNDED, 0x1f)
            } else {
                (BOUNDED + 1, 0x0f)
            };
            for machine in &mut machines {
                set(machine, (DeviceClass::D, register), value);
            }
            value &= mask;
        }
        for machine in &mut machines {
            set(machine, (class, number), value);
        }
    }
}

/// Executes an instruction inline and by the runtime's function, with the same random data.
fn compare(maker: &mut Maker, (name, function, parts): &(&str, RtFn, Vec<Part>)) -> Option<()> {
    let operands: Vec<String> = parts.iter().map(|part| part.text()).collect();
    let instruction = format!("{name} {}", operands.join(" "));
    let (model, bounded) = (maker.model, maker.bounded);
    let reversible = *function == RtFn::Bmov && maker.rng.percent(30);
    let module = compiled(&text(&instruction, bounded, reversible), model, bounded)?;
    // The queues of HM are others.
    if model.id == ModelId::Hm && matches!(function, RtFn::Sfwr | RtFn::Sfrd) {
        return None;
    }
    if calls(&module, *function) {
        // The devices that enter a shift may overlap so that one enters twice.
        let shifts = matches!(function, RtFn::Sftl | RtFn::Sftr | RtFn::Wsfl | RtFn::Wsfr);
        assert!(shifts, "{instruction} is a call");
        return None;
    }
    let all = windows(model);
    let empty = Module::clone(&module);
    let (mut inline, mut called) = (Machine::new(&module), Machine::new(&empty));
    for round in 0..ROUNDS {
        for &device in &all {
            let value = maker.rng.value(16) as i16;
            for machine in [&mut inline, &mut called] {
                set(machine, device, value);
            }
        }
        set_registers(
            &mut maker.rng,
            bounded,
            name.starts_with('D'),
            [&mut inline, &mut called],
        );
        let reversed = reversible && maker.rng.percent(50);
        inline.set_bit(Class::X, 1, reversed);
        inline.set_bit(Class::X, 0, true);
        let wide = name.starts_with('D');
        let operands: Vec<Operand> = parts.iter().map(|p| p.operand(&called, wide)).collect();
        // The scan itself changes special devices.
        let special = |operand: &Operand| {
            let class = matches!(operand.class, Class::D | Class::M);
            class && operand.kind == OperandKind::Device && operand.value >= 8000
        };
        if operands.iter().any(special) {
            continue;
        }
        // What the scan clears before and after its program.
        called.scan(&mut NoHal, 10 * round, 0);
        called.set_bit(Class::M, 8024, reversed);
        let site = Site {
            wide,
            ..Site::at(0)
        };
        let mut hal = NoHal;
        let done = function.call(&mut Cx::new(&mut called, &mut hal, &operands, site));
        conclude(done, site, &mut called);
        inline.scan(&mut NoHal, 10 * round, 0);
        for &device in &all {
            let [a, b] = [&inline, &called].map(|machine| get(machine, device));
            assert_eq!(
                a, b,
                "{}: {instruction} {operands:?}: {device:?}",
                model.title
            );
        }
        let [a, b] = [&inline, &called].map(|m| m.last_error().code);
        assert_eq!(a, b, "{}: {instruction} {operands:?}", model.title);
    }
    Some(())
}

#[test]
fn inline_blocks_do_what_the_runtime_does() {
    for id in [ModelId::Fx3u, ModelId::L01s, ModelId::H2u, ModelId::Hm] {
        let mut compared = 0;
        for n in 0..INSTRUCTIONS {
            let mut maker = Maker {
                rng: Rng::new(u64::from(n)),
                model: Model::get(id),
                bounded: n % 3 == 0,
            };
            let instruction = maker.instruction();
            compared += u32::from(compare(&mut maker, &instruction).is_some());
        }
        assert!(compared > INSTRUCTIONS / 3, "{id:?}: {compared} compared");
    }
}
