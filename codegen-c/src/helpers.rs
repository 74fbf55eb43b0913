//! Functions of a program for devices whose number is only known at run time, emitted where the program indexes.

mod blocks;

use crate::code::Code;
use crate::devices::run_timer;
use crate::fields::{PrintField, PrintStorage};
use rungc_emit::storage::{Field, Kind, Storage};
use rungc_ir::{Module, reach};
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;
use std::fmt::Write;

/// A function.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Helper {
    /// Existence of devices.
    Has,
    /// Address of a special register.
    Special,
    /// Reads a contact, a value or a 32-bit value.
    Get(&'static str),
    /// Writes one.
    Put(&'static str),
    /// Reads a group of bits.
    Bits,
    /// Writes a group of bits.
    PutBits,
    /// RST.
    Reset,
    /// OUT of a timer or a 16-bit counter.
    Out,
    /// Address of a run of devices.
    Run,
    /// Copies a run of devices of this class to another one.
    Copy(DeviceClass),
    /// Fills a run of devices.
    Fill,
}

/// The functions that a program needs.
#[derive(Default)]
pub(crate) struct Helpers {
    needed: BTreeSet<(Helper, DeviceClass)>,
    /// Runs of devices without an index that are in a block with devices that an index leads to.
    named: BTreeSet<(DeviceClass, u32, u32)>,
}

impl Helpers {
    /// `motor_has_D`.
    pub fn has(&mut self, class: DeviceClass) {
        self.needed.insert((Helper::Has, class));
    }

    /// `motor_word_D`: `bit`, `word` or `long` (the 32 bits of a counter, or a pair).
    pub fn get(&mut self, what: &'static str, class: DeviceClass) {
        self.needed.insert((Helper::Get(what), class));
    }

    /// `motor_put_word_D`.
    pub fn put(&mut self, what: &'static str, class: DeviceClass) {
        self.needed.insert((Helper::Put(what), class));
    }

    /// `motor_bits_M`.
    pub fn bits(&mut self, class: DeviceClass) {
        self.needed.insert((Helper::Bits, class));
        self.get("bit", class);
    }

    /// `motor_put_bits_M`.
    pub(crate) fn put_bits(&mut self, class: DeviceClass) {
        self.needed.insert((Helper::PutBits, class));
        self.put("bit", class);
    }

    /// `motor_reset_T`.
    pub fn reset(&mut self, class: DeviceClass) {
        self.needed.insert((Helper::Reset, class));
    }

    /// `motor_out_T`.
    pub fn out(&mut self, class: DeviceClass) {
        self.needed.insert((Helper::Out, class));
    }

    /// Writes them, each after those that it calls.
    pub fn write(mut self, out: &mut String, module: &Module, fields: &Storage) {
        let printer = Printer {
            name: &module.name,
            module,
            fields,
            by_index: DeviceClass::ALL.map(|class| match self.is_needed(class) {
                true => reach::by_index(module, class),
                false => Vec::new(),
            }),
            named: std::mem::take(&mut self.named),
        };
        self.add_called(&printer);
        // Those of 32-bit values call those of words.
        let is_long = |helper| matches!(helper, Helper::Get("long") | Helper::Put("long"));
        for long in [false, true] {
            for &(helper, class) in self.needed.iter().filter(|(h, _)| is_long(*h) == long) {
                printer.helper(out, helper, class);
            }
        }
    }
}

/// Returns true if the devices of a class are bits.
fn is_bit(class: DeviceClass) -> bool {
    matches!(
        class,
        DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S
    )
}

struct Printer<'a> {
    name: &'a str,
    module: &'a Module,
    fields: &'a Storage<'a>,
    /// Runs of devices that indexes lead to, by class.
    by_index: [Vec<(u32, u32)>; DeviceClass::ALL.len()],
    /// [`Helpers::named`].
    named: BTreeSet<(DeviceClass, u32, u32)>,
}

impl Printer<'_> {
    fn helper(&self, out: &mut String, helper: Helper, class: DeviceClass) {
        let (name, c) = (self.name, class.prefix());
        // Writing to a String does not fail, here and below.
        let _ = match helper {
            Helper::Has => self.has(out, class),
            Helper::Get("long") => self.get_long(out, class),
            Helper::Put("long") => self.put_long(out, class),
            Helper::Get(what) => {
                self.get(out, class, what == "bit");
                Ok(())
            }
            Helper::Put(what) => {
                self.put(out, class, what == "bit");
                Ok(())
            }
            Helper::Bits => writeln!(
                out,
                "/* `count` {c} from n on, which exist, as a number. */\n\
                 static inline int32_t {name}_bits_{c}({name}_plc *plc, int32_t n, unsigned count)\n{{\n    \
                 uint32_t value = 0;\n    for (unsigned i = 0; i < count; i++) {{\n        \
                 value |= (uint32_t){name}_bit_{c}(plc, n + (int32_t)i) << i;\n    }}\n    return plc_int32(value);\n}}\n"
            ),
            Helper::PutBits => writeln!(
                out,
                "/* Spreads the low bits of a number over `count` {c} from n on, which exist. */\n\
                 static inline void {name}_put_bits_{c}({name}_plc *plc, int32_t n, unsigned count, int32_t value)\n{{\n    \
                 for (unsigned i = 0; i < count; i++) {{\n        \
                 {name}_put_bit_{c}(plc, n + (int32_t)i, (((uint32_t)value >> i) & 1u) != 0u);\n    }}\n}}\n"
            ),
            Helper::Reset => {
                let _ = write!(
                    out,
                    "/* RST of {c} n, which exists. */\nstatic inline void {name}_reset_{c}({name}_plc *plc, int32_t n)\n{{\n"
                );
                for kind in [Kind::Timer, Kind::Counter16, Kind::Counter32] {
                    self.each(out, class, Some(kind), |out, device| {
                        let _ = write!(out, "{}(&{device}); return;", reset_function(kind));
                    });
                }
                writeln!(out, "}}\n")
            }
            Helper::Out => self.out(out, class),
            Helper::Special => self.special(out, class),
            Helper::Run => self.run(out, class),
            Helper::Copy(from) => self.copy(out, from, class),
            Helper::Fill => self.fill(out, class),
        };
    }

    /// OUT of a timer, as its number has it, or of a 16-bit counter.
    fn out(&self, out: &mut String, class: DeviceClass) -> std::fmt::Result {
        let (name, c) = (self.name, class.prefix());
        let _ = write!(
            out,
            "/* OUT of {c} n, which exists. */\n\
             static inline void {name}_out_{c}({name}_plc *plc, int32_t n, bool drive, int16_t preset)\n{{\n"
        );
        if class == DeviceClass::C {
            self.each(out, class, Some(Kind::Counter16), |out, device| {
                let _ = write!(out, "plc_count16(&{device}, drive, preset); return;");
            });
            return writeln!(out, "}}\n");
        }
        let mut next = 0;
        for field in self.reached(class) {
            for timers in self.module.model.timers {
                let first = timers.first.max(field.first);
                let last = timers.last.min(field.end() - 1);
                if first > last {
                    continue;
                }
                let mut device = String::from("plc->");
                field.name(&mut device);
                field.element(&mut device, "n", "");
                let from = if first == next { 0 } else { first };
                let condition = within(from, format_args!("n <= {last}"));
                let _ = write!(out, "    if ({condition}) {{\n        ");
                let kind = TimerKind {
                    shared: true,
                    ..timers.kind
                };
                let [drive, preset] = ["drive", "preset"].map(Code::from);
                let mut code = Code::default();
                run_timer(&mut code, kind, &device, &drive, &preset);
                out.push_str(code.as_str());
                out.push_str("\n        return;\n    }\n");
                next = last + 1;
            }
        }
        writeln!(out, "}}\n")
    }

    /// Writes the function that checks the existence of devices.
    fn has(&self, out: &mut String, class: DeviceClass) -> std::fmt::Result {
        let (name, c) = (self.name, class.prefix());
        let _ = write!(
            out,
            "/* Returns true if `count` {c} from number n on exist. */\n\
             static inline bool {name}_has_{c}(int32_t n, int32_t count)\n{{\n    return "
        );
        // Here the number is one that an index leads to, and may be anything.
        for (i, (first, last)) in self.module.model.runs(class).into_iter().enumerate() {
            let or = if i > 0 { "\n        || " } else { "" };
            let _ = write!(
                out,
                "{or}(n >= {first} && n <= {} - count)",
                u64::from(last) + 1
            );
        }
        writeln!(out, ";\n}}\n")
    }

    fn get(&self, out: &mut String, class: DeviceClass, bit: bool) {
        let (name, c) = (self.name, class.prefix());
        let aliased = !bit && !self.aliases(class).is_empty();
        let (ty, what, zero, part) = if bit {
            ("bool", "State", "false", ".done")
        } else {
            ("int16_t", "Value", "0", ".value")
        };
        let _ = write!(
            out,
            "/* {what} of {c} n, which exists. */\n\
             static inline {ty} {name}_{}_{c}({}{name}_plc *plc, int32_t n)\n{{\n",
            if bit { "bit" } else { "word" },
            if aliased { "" } else { "const " },
        );
        let part = if matches!(class, DeviceClass::T | DeviceClass::C) {
            part
        } else {
            ""
        };
        self.unused(out, class, false);
        self.each(out, class, None, |out, device| {
            let _ = match (bit, device.kind) {
                (false, Kind::Counter32) => write!(out, "return plc_low({device}{part});"),
                _ => write!(out, "return {device}{part};"),
            };
        });
        let _ = match aliased {
            true => writeln!(
                out,
                "    const int16_t *const special = {name}_special_{c}(plc, n);\n    \
                 return special != NULL ? *special : {zero};\n}}\n"
            ),
            false => writeln!(out, "    return {zero};\n}}\n"),
        };
    }

    fn put(&self, out: &mut String, class: DeviceClass, bit: bool) {
        let (name, c) = (self.name, class.prefix());
        let _ = write!(
            out,
            "/* Sets {c} n, which exists. */\n\
             static inline void {name}_put_{}_{c}({name}_plc *plc, int32_t n, {} value)\n{{\n",
            if bit { "bit" } else { "word" },
            if bit { "bool" } else { "int16_t" },
        );
        self.unused(out, class, true);
        let part = match (class, bit) {
            (DeviceClass::T | DeviceClass::C, true) => ".done",
            (DeviceClass::T | DeviceClass::C, false) => ".value",
            _ => "",
        };
        self.each(out, class, None, |out, device| {
            let _ = write!(out, "{device}{part} = value; return;");
        });
        if !bit && !self.aliases(class).is_empty() {
            let _ = write!(
                out,
                "    int16_t *const special = {name}_special_{c}(plc, n);\n    \
                 if (special != NULL) {{\n        *special = value;\n    }}\n"
            );
        }
        let _ = writeln!(out, "}}\n");
    }

    /// Keeps the compiler quiet where nothing of a class is stored.
    fn unused(&self, out: &mut String, class: DeviceClass, value: bool) {
        if self.reached(class).next().is_none() && self.aliases(class).is_empty() {
            out.push_str("    (void)plc;\n    (void)n;\n");
            out.push_str(if value { "    (void)value;\n" } else { "" });
        }
    }

    /// The arrays that an index leads to, or a block with devices that an index leads to.
    fn reached(&self, class: DeviceClass) -> impl Iterator<Item = &Field> {
        let runs = self.runs(class);
        self.arrays(class).filter(move |field| {
            let overlaps = |&(first, last): &(u32, u32)| field.first <= last && first < field.end();
            runs.iter().any(overlaps)
        })
    }

    /// Index registers that an index leads to by their numbers among the special registers.
    fn aliases(&self, class: DeviceClass) -> Vec<(u32, Device)> {
        if class != DeviceClass::D {
            return Vec::new();
        }
        let runs = self.runs(class);
        let aliases = self.module.model.index_aliases.iter();
        aliases
            .filter(|alias| {
                runs.iter()
                    .any(|&(first, last)| alias.is_within(first, last))
            })
            .filter_map(|alias| {
                let mut name = String::new();
                let stored = self.fields.access(&mut name, alias.class, alias.index);
                stored.then_some((
                    alias.register.number(),
                    Device {
                        name,
                        kind: Kind::Word,
                    },
                ))
            })
            .collect()
    }

    /// Writes what is to be done with the device for each field that may hold it.
    fn each(
        &self,
        out: &mut String,
        class: DeviceClass,
        kind: Option<Kind>,
        write: impl Fn(&mut String, &Device),
    ) {
        let arrays = self.reached(class).filter(|field| !self.is_aside(field));
        let arrays = arrays.filter(|f| kind.is_none_or(|kind| f.kind == kind));
        let line = |out: &mut String, device: Device| {
            let mut text = String::new();
            write(&mut text, &device);
            // One statement to a line.
            for (i, statement) in text.split_inclusive(';').enumerate() {
                let _ = writeln!(
                    out,
                    "{}{}",
                    if i > 0 { "        " } else { "" },
                    statement.trim_start()
                );
            }
        };
        for field in arrays {
            let mut name = String::from("plc->");
            field.name(&mut name);
            let condition = within(field.first, format_args!("n < {}", field.end()));
            let _ = write!(out, "    if ({condition}) {{\n        ");
            field.element(&mut name, "n", "");
            line(
                out,
                Device {
                    name,
                    kind: field.kind,
                },
            );
            out.push_str("    }\n");
        }
    }
}

/// The test that a device's number n, which is at least 0, lies in an array from `first` to an `upper` bound.
fn within(first: u32, upper: std::fmt::Arguments) -> String {
    match first {
        0 => upper.to_string(),
        first => format!("n >= {first} && {upper}"),
    }
}

/// An access to a device.
struct Device {
    name: String,
    kind: Kind,
}

impl std::fmt::Display for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.name)
    }
}

/// The function of rungc.h that resets a counter and holds it for the next execution of its coil.
pub(crate) fn hold_function(kind: Kind) -> &'static str {
    match kind {
        Kind::Counter32 => "plc_count32_hold",
        Kind::Counter16 | Kind::Timer | Kind::Bit | Kind::NumericBit | Kind::Word => {
            "plc_count16_hold"
        }
    }
}

/// The function of rungc.h that resets a timer or counter.
pub(crate) fn reset_function(kind: Kind) -> &'static str {
    match kind {
        Kind::Timer => "plc_timer_reset",
        Kind::Counter32 => "plc_count32_reset",
        Kind::Counter16 | Kind::Bit | Kind::NumericBit | Kind::Word => "plc_count16_reset",
    }
}
