//! Functions for blocks of devices and for pairs of words, of which most lie in one array.

use super::{Device, Helper, Helpers, Printer, is_bit, within};
use crate::fields::PrintField;
use rungc_emit::storage::{Field, Kind};
use rungc_models::runs::is_special;
use rungc_syntax::DeviceClass;
use std::fmt::{Result, Write};

impl Helpers {
    /// `motor_copy_D`, `motor_copy_D_to_R`, `motor_fill_D`.
    pub fn block(&mut self, to: DeviceClass, from: Option<DeviceClass>) {
        let what = match from {
            Some(from) => {
                self.needed.insert((Helper::Run, from));
                Helper::Copy(from)
            }
            None => Helper::Fill,
        };
        self.needed.extend([(Helper::Run, to), (what, to)]);
    }

    /// The functions for blocks also find `count` devices from this one on, to which no index leads.
    pub fn reach(&mut self, class: DeviceClass, first: u32, count: u32) {
        self.named.insert((class, first, first + count - 1));
    }

    /// Returns true if a function finds devices of a class.
    pub(super) fn is_needed(&self, class: DeviceClass) -> bool {
        let finds =
            |&(helper, of): &(Helper, DeviceClass)| of == class || helper == Helper::Copy(class);
        self.needed.iter().any(finds)
    }

    /// Adds the functions that others call.
    #[expect(clippy::wildcard_enum_match_arm, reason = "the others call none")]
    pub(super) fn add_called(&mut self, printer: &Printer) {
        for (helper, class) in self.needed.clone() {
            let what = if is_bit(class) { "bit" } else { "word" };
            match helper {
                Helper::Copy(from) if printer.are_scattered(&[from, class]) => {
                    let called = [(Helper::Get(what), from), (Helper::Put(what), class)];
                    self.needed.extend(called);
                }
                Helper::Fill if printer.are_scattered(&[class]) => {
                    self.needed.insert((Helper::Put(what), class));
                }
                Helper::Get("long") if printer.are_scattered(&[class]) => {
                    self.needed.insert((Helper::Get("word"), class));
                }
                Helper::Put("long") if printer.are_scattered(&[class]) => {
                    self.needed.insert((Helper::Put("word"), class));
                }
                _ => {}
            }
        }
        let of_words = |(helper, class): &(Helper, DeviceClass)| {
            let word = matches!(helper, Helper::Get("word") | Helper::Put("word"));
            word && !printer.aliases(*class).is_empty()
        };
        let aside = self.needed.iter().copied().filter(of_words);
        let aside: Vec<_> = aside.map(|(_, class)| (Helper::Special, class)).collect();
        self.needed.extend(aside);
    }
}

impl Printer<'_> {
    /// Runs of devices that the functions of a class may be called with.
    pub(super) fn runs(&self, class: DeviceClass) -> Vec<(u32, u32)> {
        let mut runs = self.by_index[class as usize].clone();
        let named = self.named.iter().filter(|named| named.0 == class);
        runs.extend(named.map(|&(_, first, last)| (first, last)));
        runs
    }

    /// Returns true if some devices that follow each other are not in one array.
    fn are_scattered(&self, classes: &[DeviceClass]) -> bool {
        let in_array = |class: DeviceClass, (first, last): (u32, u32)| {
            let mut arrays = self.arrays(class);
            arrays.any(|field| field.first <= first && last < field.end())
        };
        let mut classes = classes.iter();
        classes.any(|&class| {
            self.runs(class)
                .into_iter()
                .any(|run| !in_array(class, run))
        })
    }

    /// The arrays of a class, without those of loops over rungs.
    pub(super) fn arrays(&self, class: DeviceClass) -> impl Iterator<Item = &Field> {
        let fields = self.fields.of_class(class).iter();
        fields.filter(|field| field.array && field.grid.is_none())
    }

    /// An element of an array, by the number of its device.
    fn element(field: &Field, number: &str) -> String {
        let mut element = String::from("plc->");
        field.name(&mut element);
        field.element(&mut element, number, "");
        element
    }

    /// Returns true if an array of special registers is found by a separate function: those that are other names of
    /// index registers lie between them.
    pub(super) fn is_aside(&self, field: &Field) -> bool {
        is_special(field.class, field.first) && !self.aliases(field.class).is_empty()
    }

    /// Writes the function that finds a special register. It is not inline, so that those that call it can be.
    pub(super) fn special(&self, out: &mut String, class: DeviceClass) -> Result {
        let (name, c) = (self.name, class.prefix());
        write!(
            out,
            "/* Address of special register {c} n, perhaps an index register; NULL if it is not stored. */\n\
             static int16_t *{name}_special_{c}({name}_plc *plc, int32_t n)\n{{\n"
        )?;
        for field in self.reached(class).filter(|field| self.is_aside(field)) {
            let condition = within(field.first, format_args!("n < {}", field.end()));
            let element = Self::element(field, "n");
            write!(
                out,
                "    if ({condition}) {{\n        return &{element};\n    }}\n"
            )?;
        }
        out.push_str("    switch (n) {\n");
        for (number, Device { name, .. }) in self.aliases(class) {
            write!(out, "    case {number}:\n        return &{name};\n")?;
        }
        writeln!(out, "    default:\n        return NULL;\n    }}\n}}\n")
    }

    /// Writes the function that finds an array.
    pub(super) fn run(&self, out: &mut String, class: DeviceClass) -> Result {
        let (name, c, ty) = (self.name, class.prefix(), element_type(class));
        write!(
            out,
            "/* `count` {c} from number n on, if they are in one array; else NULL. */\n\
             static inline {ty} *{name}_run_{c}({name}_plc *plc, int32_t n, int32_t count)\n{{\n"
        )?;
        for field in self.reached(class) {
            let upper = format_args!("n <= {} - count", field.end());
            let condition = within(field.first, upper);
            let element = Self::element(field, "n");
            write!(
                out,
                "    if ({condition}) {{\n        return &{element};\n    }}\n"
            )?;
        }
        writeln!(out, "    return NULL;\n}}\n")
    }

    /// Writes the function that copies devices.
    pub(super) fn copy(&self, out: &mut String, from: DeviceClass, to: DeviceClass) -> Result {
        let (name, t, f, ty) = (self.name, to.prefix(), from.prefix(), element_type(to));
        let function = match from == to {
            true => format!("{name}_copy_{t}"),
            false => format!("{name}_copy_{f}_to_{t}"),
        };
        let (whole, one) = kinds(to);
        write!(
            out,
            "/* Copies `count` {f} to {t}, all of which exist, as if all were read before one is written. */\n\
             static inline void {function}({name}_plc *plc, int32_t to, int32_t from, int32_t count)\n{{\n    \
             {ty} *const target = {name}_run_{t}(plc, to, count);\n    \
             const {ty} *const source = {name}_run_{f}(plc, from, count);\n    \
             if (target != NULL && source != NULL) {{\n        \
             plc_copy_{whole}(target, source, (size_t)count);\n"
        )?;
        if self.are_scattered(&[from, to]) {
            out.push_str("        return;\n    }\n    for (int32_t i = 0; i < count; i++) {\n");
            let offset = match from == to {
                true => "to > from ? count - 1 - i : i",
                false => "i",
            };
            write!(
                out,
                "        const int32_t k = {offset};\n        \
                 {name}_put_{one}_{t}(plc, to + k, {name}_{one}_{f}(plc, from + k));\n"
            )?;
        }
        writeln!(out, "    }}\n}}\n")
    }

    /// Writes the function that fills devices.
    pub(super) fn fill(&self, out: &mut String, class: DeviceClass) -> Result {
        let (name, c, ty) = (self.name, class.prefix(), element_type(class));
        let (whole, one) = kinds(class);
        write!(
            out,
            "/* Sets `count` {c} from number `to` on, which exist. */\n\
             static inline void {name}_fill_{c}({name}_plc *plc, int32_t to, int32_t count, {ty} value)\n{{\n    \
             {ty} *const target = {name}_run_{c}(plc, to, count);\n    \
             if (target != NULL) {{\n        plc_fill_{whole}(target, (size_t)count, value);\n"
        )?;
        if self.are_scattered(&[class]) {
            write!(
                out,
                "        return;\n    }}\n    for (int32_t i = 0; i < count; i++) {{\n        \
                 {name}_put_{one}_{c}(plc, to + i, value);\n"
            )?;
        }
        writeln!(out, "    }}\n}}\n")
    }

    /// Writes the function that reads the 32-bit value of a counter or a pair.
    pub(super) fn get_long(&self, out: &mut String, class: DeviceClass) -> Result {
        let (name, c) = (self.name, class.prefix());
        write!(
            out,
            "/* The 32-bit value of {c} n, which exists. */\n\
             static inline int32_t {name}_long_{c}({name}_plc *plc, int32_t n)\n{{\n"
        )?;
        self.each(out, class, Some(Kind::Counter32), |out, device| {
            let _ = write!(out, "return {device}.value;");
        });
        self.pairs(out, class, |low, high| {
            format!("return plc_join({high}, {low});")
        })?;
        if self.are_scattered(&[class]) {
            let pair = format!("plc_join({name}_word_{c}(plc, n + 1), {name}_word_{c}(plc, n))");
            return writeln!(out, "    return {pair};\n}}\n");
        }
        writeln!(out, "    return 0;\n}}\n")
    }

    /// Writes the function that sets it.
    pub(super) fn put_long(&self, out: &mut String, class: DeviceClass) -> Result {
        let (name, c) = (self.name, class.prefix());
        write!(
            out,
            "/* Sets the 32-bit value of {c} n, which exists. */\n\
             static inline void {name}_put_long_{c}({name}_plc *plc, int32_t n, int32_t value)\n{{\n"
        )?;
        self.each(out, class, Some(Kind::Counter32), |out, device| {
            let _ = write!(out, "{device}.value = value; return;");
        });
        let scattered = self.are_scattered(&[class]);
        let leave = if scattered { "\n        return;" } else { "" };
        self.pairs(out, class, |low, high| {
            format!("plc_split(&{high}, &{low}, value);{leave}")
        })?;
        if scattered {
            write!(
                out,
                "    {name}_put_word_{c}(plc, n, plc_low(value));\n    \
                 {name}_put_word_{c}(plc, n + 1, plc_high(value));\n"
            )?;
        }
        writeln!(out, "}}\n")
    }

    /// Writes what is to be done with the two words of a pair, for each array that may hold both.
    fn pairs(
        &self,
        out: &mut String,
        class: DeviceClass,
        make: impl Fn(String, String) -> String,
    ) -> Result {
        let arrays = self.reached(class).filter(|field| !self.is_aside(field));
        for field in arrays.filter(|field| field.kind.word().is_some() && field.count > 1) {
            let part = if field.kind == Kind::Word {
                ""
            } else {
                ".value"
            };
            let [low, high] = ["n", "n + 1"].map(|n| Self::element(field, n) + part);
            let condition = within(field.first, format_args!("n < {}", field.last()));
            let made = make(low, high);
            write!(out, "    if ({condition}) {{\n        {made}\n    }}\n")?;
        }
        Ok(())
    }
}

/// The C type of the devices of a class that blocks are made of.
fn element_type(class: DeviceClass) -> &'static str {
    if is_bit(class) { "bool" } else { "int16_t" }
}

/// What the functions for blocks and for single devices of a class are named after.
fn kinds(class: DeviceClass) -> (&'static str, &'static str) {
    if is_bit(class) {
        ("bits", "bit")
    } else {
        ("words", "word")
    }
}
