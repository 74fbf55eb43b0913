//! Holds the operands of an instruction to its catalogue row and to the model's devices.

use super::rules;
use super::wrong::{not_this_number, too_few, too_many, wide_constant, wrong_class};
use rungc_catalogue::{Extent, Found, Param, Shape};
use rungc_models::Model;
use rungc_models::runs::{is_counter32, words_of_bits};
use rungc_syntax::{
    Classes, Device, DeviceClass, Diagnostic, Diagnostics, Fix, Index, Instr, Operand, OperandKind,
    Phrase, Span, codes, phrase,
};

/// Checks operands for one model.
pub(super) struct Checker {
    model: &'static Model,
    /// The model's devices by class, ranges that an access may span joined.
    runs: Vec<Vec<(u32, u32)>>,
    /// Classes that no operand can have on the model.
    missing: Classes,
}

/// An instruction whose operands are checked, and the row that it matches.
pub(super) struct Matched<'a> {
    pub(super) instr: &'a Instr,
    pub(super) found: Found,
}

impl Checker {
    pub(super) fn new(model: &'static Model) -> Self {
        let runs = DeviceClass::ALL
            .into_iter()
            .map(|class| model.runs(class))
            .collect();
        Checker {
            model,
            runs,
            missing: model.missing(),
        }
    }

    /// Checks the number of a label.
    pub(super) fn label(&self, instr: &Instr, label: Device, out: &mut Diagnostics) {
        if !self.has(label.class, label.number) {
            let plc_error = match label.class {
                DeviceClass::I => 6508,
                _ => 6507,
            };
            out.push(self.no_device(instr.span, label).plc_error(plc_error));
        }
        if let Some(operand) = instr.operands.first() {
            out.push(too_many(instr, operand.span, &instr.mnemonic, &[]));
        }
    }

    /// Checks all operands of an instruction; `params` is what its row says of them.
    pub(super) fn instr(
        &self,
        instr: &Instr,
        found: Found,
        params: &[Param],
        out: &mut Diagnostics,
    ) {
        let matched = Matched { instr, found };
        let given = || params.iter().enumerate().take(instr.operands.len());
        let wrong = given().map(|(at, param)| {
            let wrong = self.operand(&matched, at, param);
            wrong.map(|diagnostic| self.compatible_boards(diagnostic, &matched, at))
        });
        let mut wrong: Vec<Option<Diagnostic>> = wrong.collect();
        // What an instruction takes may depend on the class of its first operand.
        let first = wrong.first().and_then(Option::as_ref);
        let is_lost = first.is_some_and(|wrong| wrong.code == codes::OPERAND_CLASS.id);
        if !(is_lost && found.inst.depends_on_first()) {
            self.count(instr, params, out);
        }
        // A wrong number of devices leads anywhere.
        let is_reach = |wrong: &Diagnostic| wrong.code == codes::PAST_THE_END.id;
        if !wrong.iter().flatten().all(is_reach) {
            for wrong in &mut wrong {
                wrong.take_if(|wrong| is_reach(wrong));
            }
        }
        // Operands are compared with those that are right by themselves.
        let mut right = instr.operands.clone();
        for (operand, _) in right.iter_mut().zip(&wrong).filter(|(_, w)| w.is_some()) {
            operand.kind = OperandKind::Unreadable(None);
        }
        let wide = found.form.wide;
        let broken = given().map(|(at, param)| rules::broken(&right, at, param, wide));
        out.extend(wrong.into_iter().chain(broken).flatten());
    }

    /// Says that boards which take programs for the model take operand `at`, if only its value is what the model does
    /// not take.
    fn compatible_boards(
        &self,
        diagnostic: Diagnostic,
        matched: &Matched,
        at: usize,
    ) -> Diagnostic {
        let of_value = [codes::LIMITS.id, codes::NOT_THIS_NUMBER.id].contains(&diagnostic.code);
        let boards = self.model.boards.map(Model::get).filter(|_| of_value);
        let taken = boards.filter(|boards| {
            let params = matched
                .found
                .inst
                .params_of(&matched.instr.operands, boards);
            let wrong = |param| Checker::new(boards).operand(matched, at, param);
            params.get(at).is_some_and(|param| wrong(param).is_none())
        });
        let Some(boards) = taken else {
            return diagnostic;
        };
        let before = diagnostic
            .help
            .as_ref()
            .map_or("".into(), |help| phrase!("{help}; ", help));
        let help = phrase!("{before}`{boards}` takes it", before, boards = boards.name);
        diagnostic.help(help)
    }

    /// Reports operands that are missing or too many. Where one could not be read, only that one is judged.
    fn count(&self, instr: &Instr, params: &[Param], out: &mut Diagnostics) {
        let broken = instr.operands.iter().position(is_unreadable);
        let needed = params.iter().filter(|param| !param.optional).count();
        if instr.operands.len() < needed && broken.is_none() {
            out.push(too_few(instr, params));
        }
        if let Some(extra) = instr.operands.get(params.len())
            && broken.is_none_or(|broken| broken == params.len())
        {
            out.push(too_many(instr, extra.span, &instr.mnemonic, params));
        }
    }

    /// Error in one operand, if any.
    fn operand(&self, matched: &Matched, at: usize, param: &Param) -> Option<Diagnostic> {
        let operand = &matched.instr.operands[at];
        let span = operand.span;
        let kind = &operand.kind;
        if is_unreadable(operand) {
            return None;
        }
        let classes = param.classes_without(self.missing, self.model.id);
        if !classes.meets(Classes::of(kind)) {
            return Some(wrong_class(matched, at, param, classes, self.model));
        }
        if let Some(index) = index_of(kind)
            && let Some(diagnostic) =
                indexes_itself(span, kind).or_else(|| self.index(matched, operand, index, param))
        {
            return Some(diagnostic);
        }
        match kind {
            OperandKind::Device(device, index) => self
                .existing(span, *device)
                .or_else(|| self.counter(matched, span, *device, param))
                .or_else(|| self.upper_half(matched, span, *device, param))
                .or_else(|| numbers(span, *device, param, self.model))
                .or_else(|| self.reach(matched, span, *device, 1, index.is_some(), param)),
            OperandKind::WordBit(device, bit, index) => bit_of_register(span, *device, *index)
                .or_else(|| self.existing(span, *device))
                .or_else(|| self.bits_of_words(matched, span, (*device, *bit), *index, param)),
            OperandKind::Nibbles(digits, device, index) => {
                digits_fit(matched, span, *digits, param)
                    .or_else(|| self.existing(span, *device))
                    .or_else(|| numbers(span, *device, param, self.model))
                    .or_else(|| {
                        let bits = 4 * u32::from(*digits);
                        self.reach(matched, span, *device, bits, index.is_some(), param)
                    })
            }
            OperandKind::Decimal(value, index) => constant(
                matched,
                operand,
                *value,
                index.is_some(),
                (param, self.model),
            ),
            OperandKind::Hex(value, index) => hex_constant(
                matched,
                operand,
                *value,
                index.is_some(),
                (param, self.model),
            ),
            OperandKind::Buffer {
                module, address, ..
            } => no_buffer(span, *module, *address),
            OperandKind::Float(_) | OperandKind::Text(_) | OperandKind::Unreadable(_) => None,
        }
    }

    /// Error in an index register, if any.
    fn index(
        &self,
        matched: &Matched,
        operand: &Operand,
        index: Index,
        param: &Param,
    ) -> Option<Diagnostic> {
        let span = operand.span;
        let register = Device {
            class: index.class,
            number: index.number,
        };
        let barred = |device: Device| {
            let mut barred = param.unindexed.iter();
            barred.any(|&(class, first, last)| {
                device.class == class && (first..=last).contains(&device.number)
            })
        };
        let direct = device_of(&operand.kind).filter(|device| barred(*device));
        if !param.indexable || direct.is_some() {
            let with =
                direct.map_or_else(|| "".into(), |device| phrase!(" with `{device}`", device));
            let message = phrase!(
                "operand {param} of `{mnemonic}` cannot take an index register{with} on {model}",
                param = param.name,
                mnemonic = matched.instr.mnemonic,
                with,
                model = self.model.name
            );
            return Some(
                codes::NOT_INDEXABLE
                    .at(span, message)
                    .label(phrase!("`{index}` is not allowed here", index))
                    .help(without_index(&operand.kind, &matched.instr.mnemonic)),
            );
        }
        let pair = matched.found.form.wide && self.model.z_pairs_with_v;
        if pair && index.class == DeviceClass::V {
            let message = phrase!(
                "`{index}` cannot be the index in the 32-bit instruction `{mnemonic}`",
                index,
                mnemonic = matched.instr.mnemonic
            );
            return Some(
                codes::INDEX_WIDTH
                    .at(span, message)
                    .label("the index is a pair here, named by its Z")
                    .help(phrase!(
                        "use `Z{number}` and clear `{index}`",
                        number = index.number,
                        index
                    )),
            );
        }
        self.existing(span, register)
    }

    fn has(&self, class: DeviceClass, number: u32) -> bool {
        self.end_of_run(class, number).is_some()
    }

    /// The last device of the run that holds this one.
    fn end_of_run(&self, class: DeviceClass, number: u32) -> Option<u32> {
        self.runs[class as usize]
            .iter()
            .find(|&&(first, last)| (first..=last).contains(&number))
            .map(|&(_, last)| last)
    }

    fn existing(&self, span: Span, device: Device) -> Option<Diagnostic> {
        (!self.has(device.class, device.number)).then(|| self.no_device(span, device))
    }

    fn no_device(&self, span: Span, device: Device) -> Diagnostic {
        /// More ranges than this (interrupt pointers) say nothing to a reader.
        const MAX_RANGES: usize = 6;
        let class = device.class;
        let runs = &self.runs[class as usize];
        let ranges: Vec<_> = runs
            .iter()
            .map(|&(first, last)| match first == last {
                true => class.number(first).to_string(),
                false => format!(
                    "{first}–{last}",
                    first = class.number(first),
                    last = class.number(last)
                ),
            })
            .collect();
        let ranges = match ranges.len() {
            0 => phrase!("it has no {prefix}", prefix = class.prefix()),
            1..=MAX_RANGES => ranges.join(", ").into(),
            n => {
                let first = ranges[..MAX_RANGES - 1].join(", ");
                format!("{first}, … {}", ranges[n - 1]).into()
            }
        };
        let message = phrase!(
            "`{device}` does not exist on {model} ({ranges})",
            device,
            model = self.model.name,
            ranges
        );
        codes::NO_DEVICE
            .at(span, message)
            .label(phrase!("not on {model}", model = self.model.title))
    }

    /// A 32-bit counter as a 16-bit value.
    fn counter(
        &self,
        matched: &Matched,
        span: Span,
        device: Device,
        param: &Param,
    ) -> Option<Diagnostic> {
        if !is_counter32(device.class, device.number) {
            return None;
        }
        let narrow = match param.shape {
            Shape::Value => !matched.found.form.wide,
            Shape::Word => true,
            Shape::Bit
            | Shape::Pair
            | Shape::Float
            | Shape::Text
            | Shape::Pointer
            | Shape::Mixed => false,
        };
        narrow.then(|| {
            let mnemonic = &matched.instr.mnemonic;
            let message = phrase!(
                "`{device}` is a 32-bit counter, `{mnemonic}` takes 16 bits",
                device,
                mnemonic
            );
            let diagnostic = codes::COUNTER_WIDTH
                .at(span, message)
                .label("C200 to C255 hold 32 bits");
            let wide = rungc_catalogue::Form {
                wide: true,
                ..matched.found.form
            };
            match matched.found.inst.spelling_of(wide) {
                Some(name) => {
                    let fix = Fix::suggested(phrase!("write `{name}`", name))
                        .replace(matched.instr.mnemonic_span, name.as_str());
                    let help = phrase!("use the 32-bit form `{name}`", name);
                    diagnostic.help(help).fix(fix)
                }
                None => diagnostic,
            }
        })
    }

    /// V as a 32-bit value: the pair of V and Z is named by its Z.
    fn upper_half(
        &self,
        matched: &Matched,
        span: Span,
        device: Device,
        param: &Param,
    ) -> Option<Diagnostic> {
        let half = device.class == DeviceClass::V && self.model.z_pairs_with_v;
        let is_pair = words(matched.found, param) == 2 || matches!(param.extent, Extent::Count(2));
        (half && is_pair).then(|| {
            let mnemonic = &matched.instr.mnemonic;
            let message = phrase!(
                "`{device}` is only the upper half of the operand of `{mnemonic}`",
                device,
                mnemonic
            );
            codes::INDEX_WIDTH
                .at(span, message)
                .label("V and Z are a pair here, named by its Z")
                .help(phrase!("use `Z{number}`", number = device.number))
                .fix(
                    Fix::suggested(phrase!("write `Z{number}`", number = device.number))
                        .replace(span, format!("Z{number}", number = device.number)),
                )
        })
    }

    /// An operand that reaches past the end of its range; `each` is how many devices one value of it takes.
    fn reach(
        &self,
        matched: &Matched,
        span: Span,
        device: Device,
        each: u32,
        indexed: bool,
        param: &Param,
    ) -> Option<Diagnostic> {
        if indexed || matches!(param.shape, Shape::Pointer) {
            return None;
        }
        let class = device.class;
        let kind = OperandKind::Device(device, None);
        let values = match param.extent_of(&kind) {
            // Both words of a result at Z: Zn and Vn.
            Extent::Count(2) if class == DeviceClass::Z && self.model.z_pairs_with_v => 1,
            count => extent(&matched.instr.operands, count),
        };
        let each = match class {
            _ if each > 1 => each,
            DeviceClass::V | DeviceClass::Z if self.model.z_pairs_with_v => 1,
            class if is_counter32(class, device.number) => 1,
            _ => words(matched.found, param),
        };
        let count = values.saturating_mul(each);
        let end = self.end_of_run(class, device.number)?;
        let last = device.number.saturating_add(count.max(1) - 1);
        (last > end).then(|| {
            let message = phrase!(
                "operand {param} of `{mnemonic}` uses {count} devices starting at `{device}`, but `{end}` is the last \
                 one",
                param = param.name,
                mnemonic = matched.instr.mnemonic,
                count,
                device,
                end = class.number(end)
            );
            let highest = (end + 1)
                .checked_sub(count)
                .and_then(|first| (self.end_of_run(class, first) == Some(end)).then_some(first));
            let diagnostic = codes::PAST_THE_END
                .at(span, message)
                .label(phrase!("up to `{last}`", last = class.number(last)));
            match highest {
                Some(first) => {
                    diagnostic.help(phrase!("start at `{first}` or below", first = class.number(first)))
                }
                None => diagnostic,
            }
        })
    }

    /// As [`Self::reach`], for a bit of a word: the bits after it continue in the next words.
    fn bits_of_words(
        &self,
        matched: &Matched,
        span: Span,
        (device, bit): (Device, u8),
        index: Option<Index>,
        param: &Param,
    ) -> Option<Diagnostic> {
        let kind = OperandKind::WordBit(device, bit, None);
        let bits = extent(&matched.instr.operands, param.extent_of(&kind));
        let words = words_of_bits(bit & 15, bits);
        let end = self.end_of_run(device.class, device.number)?;
        let last = device.number.saturating_add(words - 1);
        (index.is_none() && last > end).then(|| {
            let message = format!(
                "operand {} of `{}` uses {bits} bits starting at `{device}.{bit:X}`, but `{}` is the last word",
                param.name,
                matched.instr.mnemonic,
                device.class.number(end)
            );
            codes::PAST_THE_END
                .at(span, message)
                .label(phrase!("up to `{last}`", last = device.class.number(last)))
        })
    }
}

pub(super) fn is_unreadable(operand: &Operand) -> bool {
    matches!(operand.kind, OperandKind::Unreadable(_))
}

/// Returns true if the row accepts these operands, as far as their number and their classes go.
pub(super) fn takes(found: Found, operands: &[Operand], model: &Model) -> bool {
    let (params, _) = found.inst.params_and_steps(found.form, operands, model);
    let needed = params.iter().filter(|param| !param.optional).count();
    let fits = |(operand, param): (&Operand, &Param)| {
        is_unreadable(operand) || param.classes_on(model).meets(Classes::of(&operand.kind))
    };
    (needed..=params.len()).contains(&operands.len()) && operands.iter().zip(params).all(fits)
}

/// Buffer memory that cannot exist (FX3 programming manual §4.11).
fn no_buffer(span: Span, module: u32, address: u32) -> Option<Diagnostic> {
    const LAST_MODULE: u32 = 7;
    const LAST_ADDRESS: u32 = 32_767;
    (module > LAST_MODULE || address > LAST_ADDRESS).then(|| {
        let message = phrase!("`U{module}\\G{address}` does not exist (modules U0–U{LAST_MODULE}, addresses G0–G{LAST_ADDRESS})", module, address, LAST_MODULE, LAST_ADDRESS);
        codes::NO_DEVICE.at(span, message).label("no such buffer memory")
    })
}

fn index_of(kind: &OperandKind) -> Option<Index> {
    match *kind {
        OperandKind::Device(_, index)
        | OperandKind::WordBit(_, _, index)
        | OperandKind::Nibbles(_, _, index)
        | OperandKind::Decimal(_, index)
        | OperandKind::Hex(_, index)
        | OperandKind::Buffer { index, .. } => index,
        OperandKind::Float(_) | OperandKind::Text(_) | OperandKind::Unreadable(_) => None,
    }
}

/// The device that an operand names or begins with.
pub(super) fn device_of(kind: &OperandKind) -> Option<Device> {
    match *kind {
        OperandKind::Device(device, _)
        | OperandKind::WordBit(device, ..)
        | OperandKind::Nibbles(_, device, _) => Some(device),
        _ => None,
    }
}

/// Number of words in one value of an operand.
fn words(found: Found, param: &Param) -> u32 {
    match param.shape {
        Shape::Value if found.form.wide => 2,
        Shape::Pair | Shape::Float => 2,
        Shape::Value | Shape::Word | Shape::Bit | Shape::Text | Shape::Pointer | Shape::Mixed => 1,
    }
}

/// Number of values of an operand; an unknown number counts as one.
fn extent(operands: &[Operand], extent: Extent) -> u32 {
    match extent {
        Extent::One | Extent::Through(_) => 1,
        Extent::Count(count) => count,
        Extent::Between { least, .. } => least,
        Extent::Operand { i, extra } => operands
            .get(i)
            .and_then(|operand| operand.kind.constant())
            .and_then(|count| u32::try_from(count + i64::from(extra)).ok())
            .unwrap_or(1),
        Extent::Of(count) | Extent::Bits(count) => {
            let constants = operands.iter().map(|operand| operand.kind.constant());
            let constants: Vec<_> = constants.collect();
            count(&constants).unwrap_or(1)
        }
    }
}

/// A device whose number does not serve in this place.
fn numbers(span: Span, device: Device, param: &Param, model: &Model) -> Option<Diagnostic> {
    let mut of_class = param
        .numbers_on(model)
        .iter()
        .filter(|(class, ..)| *class == device.class)
        .peekable();
    of_class.peek()?;
    let allowed: Vec<_> = of_class.collect();
    let fits = allowed
        .iter()
        .any(|&&(_, first, last)| (first..=last).contains(&device.number));
    (!fits).then(|| not_this_number(span, device, &allowed, param, model))
}

/// Number of bits in a value of an operand.
fn bits(found: Found, param: &Param) -> u32 {
    16 * words(found, param)
}

/// What to do instead of giving an operand an index.
fn without_index(kind: &OperandKind, mnemonic: &str) -> Phrase {
    let class = device_of(kind).map(|device| device.class);
    match class {
        Some(DeviceClass::P | DeviceClass::I) => phrase!(
            "name the pointer directly: one `{mnemonic}` for each, under a comparison of the index register",
            mnemonic
        ),
        _ => "name the device directly, or copy the indexed one first: `MOV`, `BMOV`".into(),
    }
}

/// An index register goes with other devices, not with index registers (h1u-h2u-programming §3.8).
fn indexes_itself(span: Span, kind: &OperandKind) -> Option<Diagnostic> {
    let OperandKind::Device(device, Some(index)) = kind else {
        return None;
    };
    matches!(device.class, DeviceClass::V | DeviceClass::Z).then(|| {
        codes::NOT_INDEXABLE
            .at(
                span,
                phrase!(
                    "`{device}` is an index register and cannot be indexed itself",
                    device
                ),
            )
            .label(phrase!("`{index}` is not allowed here", index))
            .help("add the registers first, or use a data register")
    })
}

/// The notation `D0.F` is one of data registers, and takes no index register (FX3 manual, the note to every `D□.b`).
fn bit_of_register(span: Span, device: Device, index: Option<Index>) -> Option<Diagnostic> {
    if device.class != DeviceClass::D {
        let message = phrase!("`{device}` has no bits that can be named like this", device);
        let diagnostic = codes::OPERAND_CLASS.at(span, message);
        return Some(diagnostic.label("only a data register has bits: `D0.F`"));
    }
    let index = index?;
    let diagnostic = codes::NOT_INDEXABLE
        .at(span, "a bit of a register cannot take an index register")
        .label(phrase!("`{index}` is not allowed here", index))
        .help("move the register into a group of relays first: `MOV D0Z0 K4M0`");
    Some(diagnostic)
}

/// Checks that a group has a digit count allowed for the operand; a result of two words may go to eight digits.
fn digits_fit(matched: &Matched, span: Span, digits: u8, param: &Param) -> Option<Diagnostic> {
    let values = match param.extent {
        Extent::Count(count) => count,
        _ => 1,
    };
    let bits = bits(matched.found, param).saturating_mul(values).min(32);
    let most = bits / 4;
    (!(1..=most).contains(&u32::from(digits))).then(|| {
        let message = phrase!(
            "K{digits} is not a valid digit count for a {bits}-bit value",
            digits,
            bits
        );
        codes::DIGITS
            .at(span, message)
            .label(phrase!("K1 to K{most} here", most))
    })
}

fn constant(
    matched: &Matched,
    operand: &Operand,
    value: i64,
    indexed: bool,
    (param, model): (&Param, &Model),
) -> Option<Diagnostic> {
    let bits = bits(matched.found, param);
    let half = 1i64 << (bits - 1);
    if !(-half..half).contains(&value) {
        return Some(wide_constant(matched, operand, bits, model));
    }
    outside_limits(matched, operand, &[value], indexed, param)
}

fn hex_constant(
    matched: &Matched,
    operand: &Operand,
    value: u64,
    indexed: bool,
    (param, model): (&Param, &Model),
) -> Option<Diagnostic> {
    let bits = bits(matched.found, param);
    if value >> bits != 0 {
        return Some(wide_constant(matched, operand, bits, model));
    }
    // Fits in 32 bits, so both readings fit in i64.
    let unsigned = value as i64;
    let signed = unsigned - ((unsigned >> (bits - 1)) << bits);
    outside_limits(matched, operand, &[unsigned, signed], indexed, param)
}

/// A constant none of whose readings lies in the operand's limits.
fn outside_limits(
    matched: &Matched,
    operand: &Operand,
    readings: &[i64],
    indexed: bool,
    param: &Param,
) -> Option<Diagnostic> {
    let limits = rules::limits(param, matched.found.form.wide);
    let fits = readings.iter().any(|&value| limits.allow(value));
    (!fits && !indexed).then(|| {
        let message = phrase!(
            "`{kind}` is outside the limits of operand {param}",
            kind = operand.kind,
            param = param.name
        );
        codes::LIMITS
            .at(operand.span, message)
            .label(phrase!("{in_words} here", in_words = limits.in_words("K")))
    })
}
