//! Operands that fit: computed from an instruction's row, the model's devices and the operands beside them.

use crate::operands::{BUFFER_WORDS, CROWD, FLAGS, special_register};
use crate::rng::Rng;
use rungc_catalogue::{Extent, Form, Limits, Param, Role, Rule, Shape};
use rungc_models::Model;
use rungc_models::runs::{FIRST_COUNTER32, is_special, words_of_bits};
use rungc_syntax::{Classes, DeviceClass};

/// Index registers that programs use.
const INDEXES: [(DeviceClass, u32); 4] = [
    (DeviceClass::Z, 0),
    (DeviceClass::Z, 1),
    (DeviceClass::V, 0),
    (DeviceClass::V, 1),
];

/// Maximum distance from a random constant to the next one that suits a rule: two high bytes.
const SUITS_WITHIN: i64 = 0x200;

/// Position for which operands are drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'p> {
    pub(crate) model: &'static Model,
    pub(crate) form: Form,
    pub(crate) params: &'p [Param],
    /// The class of each operand; there may be fewer than parameters.
    pub(crate) classes: &'p [Classes],
    /// Numbers that the first operand has, if it is a device.
    pub(crate) first: Option<(u32, u32)>,
    /// True if constants are to be as small as the others allow, so that many devices are left.
    pub(crate) is_small: bool,
}

/// A device, or the first one of a group, that an operand names.
#[derive(Clone, Copy, Debug)]
struct Named {
    class: DeviceClass,
    number: u32,
    digits: Option<u32>,
}

/// Draws operands.
struct Fitting<'p, 'r> {
    place: Place<'p>,
    rng: &'r mut Rng,
    /// The constants among the operands.
    constants: Vec<Option<i64>>,
    /// The devices of the operands so far.
    named: Vec<Option<Named>>,
}

/// Operands of these classes that obey the row's limits, rules and extents; `None` if none of the devices fits the
/// constants that were drawn. What a rule's function finds is not looked at.
pub(crate) fn draw(rng: &mut Rng, place: Place) -> Option<Vec<String>> {
    let mut fitting = Fitting {
        constants: vec![None; place.classes.len()],
        named: Vec::new(),
        place,
        rng,
    };
    fitting.constants();
    (0..place.classes.len())
        .map(|at| fitting.operand(at))
        .collect()
}

/// The letters of a class of groups.
fn letters_of_group(class: Classes) -> Option<DeviceClass> {
    match class {
        Classes::KNX => Some(DeviceClass::X),
        Classes::KNY => Some(DeviceClass::Y),
        Classes::KNM => Some(DeviceClass::M),
        Classes::KNS => Some(DeviceClass::S),
        _ => None,
    }
}

/// Returns true if operands of a class are groups of bits.
pub(crate) fn is_group(class: Classes) -> bool {
    letters_of_group(class).is_some()
}

/// Returns true if operands of a class are integer constants.
fn is_constant(class: Classes) -> bool {
    class == Classes::K || class == Classes::H
}

/// The devices of a class.
fn device_class(class: Classes) -> Option<DeviceClass> {
    let mut all = DeviceClass::ALL.into_iter();
    all.find(|&letters| Classes::of_device(letters) == class)
}

/// The first multiple of a number that is not below a value.
fn multiple_from(value: u32, of: u32) -> Option<u32> {
    value.checked_next_multiple_of(of.max(1))
}

/// Number of words in one value of an operand.
pub(crate) fn words(param: &Param, form: Form) -> u32 {
    let is_wide = match param.shape {
        Shape::Value => form.wide,
        Shape::Pair | Shape::Float => true,
        Shape::Bit | Shape::Word | Shape::Text | Shape::Pointer | Shape::Mixed => false,
    };
    1 + u32::from(is_wide)
}

impl Fitting<'_, '_> {
    fn words(&self, param: &Param) -> u32 {
        words(param, self.place.form)
    }

    /// Number of values of an operand, as far as it is known.
    fn extent(&self, param: &Param) -> u32 {
        match param.extent {
            Extent::One | Extent::Through(_) => 1,
            Extent::Count(count) => count,
            Extent::Between { most, .. } => most,
            Extent::Operand { i, extra } => {
                let count = self.constants.get(i).copied().flatten();
                let count = count.and_then(|count| u32::try_from(count + i64::from(extra)).ok());
                count.unwrap_or(1)
            }
            Extent::Of(count) | Extent::Bits(count) => count(&self.constants).unwrap_or(1),
        }
    }

    /// Draws all constants, then brings them into the order that rules demand.
    fn constants(&mut self) {
        let place = self.place;
        for (at, (param, class)) in place.params.iter().zip(place.classes).enumerate() {
            if is_constant(*class) {
                self.constants[at] = Some(self.constant(param));
            }
        }
        for (at, param) in place.params.iter().enumerate().take(place.classes.len()) {
            let Some(mut value) = self.constants[at] else {
                continue;
            };
            for rule in param.rules {
                let other = |i: usize| self.constants.get(i).copied().flatten().unwrap_or(value);
                value = match *rule {
                    Rule::AtMost(i) => value.min(other(i)),
                    Rule::AtLeast(i) => value.max(other(i)),
                    Rule::Below(i) if self.constants.get(i).is_some_and(Option::is_some) => {
                        value.min(other(i) - 1)
                    }
                    Rule::GroupAtMost(i, most)
                        if place.classes.get(i).is_some_and(|&c| is_group(c)) =>
                    {
                        value.min(most)
                    }
                    _ => value,
                };
            }
            self.constants[at] = Some(value);
        }
    }

    /// A constant within the limits that suits the predicates of the rules, if one does.
    fn constant(&mut self, param: &Param) -> i64 {
        let value = self.limited(param);
        let suits = |value: &i64| {
            let mut rules = param.rules.iter();
            rules.all(|rule| !matches!(rule, Rule::Suits(suits, _) if !suits(*value)))
        };
        let next = (value..=value + SUITS_WITHIN).find(suits);
        next.unwrap_or(value)
    }

    /// A constant within the limits.
    fn limited(&mut self, param: &Param) -> i64 {
        let wide = self.place.form.wide;
        let of_wide_form = param.rules.iter().find_map(|rule| match *rule {
            Rule::WideLimits(min, max) if wide => Some(Limits::Between((min, max))),
            _ => None,
        });
        let limits = of_wide_form.unwrap_or(param.limits);
        let Some((low, high)) = self.rng.pick(limits.ranges()) else {
            return self.rng.value(16 * self.words(param));
        };
        let span = u32::try_from(high - low).unwrap_or(u32::MAX - 1);
        let mut value = match self.rng.below(20) {
            _ if self.place.is_small => low + i64::from(self.rng.below(span.min(2) + 1)),
            0 => high - i64::from(self.rng.below(span.min(2) + 1)),
            1..=3 => low + i64::from(self.rng.below(span + 1)),
            _ => low + i64::from(self.rng.below(span.min(39) + 1)),
        };
        for rule in param.rules {
            match *rule {
                Rule::MultipleOf(of) if of > 0 => {
                    value = value.div_euclid(of) * of;
                    if value < low {
                        value += of;
                    }
                }
                Rule::Not(min, max) if (min..=max).contains(&value) => {
                    value = if max < high { max + 1 } else { min - 1 };
                }
                _ => {}
            }
        }
        value
    }

    fn operand(&mut self, at: usize) -> Option<String> {
        let (param, class) = (&self.place.params[at], self.place.classes[at]);
        self.named.push(None);
        if let Some(value) = self.constants[at] {
            let text = match class {
                Classes::H => {
                    let bits = 16 * self.words(param);
                    format!("H{:X}", value & ((1 << bits) - 1))
                }
                _ => format!("K{value}"),
            };
            return Some(self.indexed(text, param, None, 2));
        }
        if class == Classes::E {
            return Some(format!("E{:?}", self.rng.value(16) as f32 / 8.0));
        }
        if class == Classes::TEXT {
            return Some(self.text());
        }
        if class == Classes::BUFFER {
            // There is no module 1.
            let module = u32::from(self.rng.percent(5));
            let text = format!("U{module}\\G{}", self.rng.below(BUFFER_WORDS));
            return Some(self.indexed(text, param, None, 12));
        }
        if class == Classes::WORD_BIT {
            let bit = self.rng.below(16);
            let words = words_of_bits(bit as u8, self.extent(param));
            let number = self.number(at, DeviceClass::D, words, 1)?;
            return Some(format!("D{number}.{bit:X}"));
        }
        let named = match letters_of_group(class) {
            Some(letters) => self.group(at, letters)?,
            None => self.device(at, device_class(class)?)?,
        };
        self.named[at] = Some(named);
        let device = named.class.number(named.number);
        let text = match named.digits {
            Some(digits) => format!("K{digits}{device}"),
            None => device.to_string(),
        };
        Some(self.indexed(text, param, Some(named), 12))
    }

    fn text(&mut self) -> String {
        let letters = b"ABCabc0129 -.";
        let count = 1 + self.rng.below(7);
        let letters = (0..count).filter_map(|_| self.rng.pick(letters));
        let text: String = letters.map(char::from).collect();
        format!("\"{text}\"")
    }

    /// A text with an index register, this many times in a hundred where the operand takes one.
    fn indexed(
        &mut self,
        text: String,
        param: &Param,
        named: Option<Named>,
        percent: u32,
    ) -> String {
        let model = self.place.model;
        let barred = |named: Named| {
            let is_index = matches!(named.class, DeviceClass::V | DeviceClass::Z);
            let mut barred = param.unindexed.iter();
            is_index
                || barred.any(|&(class, first, last)| {
                    class == named.class && (first..=last).contains(&named.number)
                })
        };
        if !param.indexable || named.is_some_and(barred) || !self.rng.percent(percent) {
            return text;
        }
        let is_pair = self.place.form.wide && model.z_pairs_with_v;
        let mut fitting = INDEXES.to_vec();
        fitting.retain(|&(class, n)| model.has(class, n) && !(is_pair && class == DeviceClass::V));
        match self.rng.pick(&fitting) {
            Some((class, n)) => format!("{text}{}", class.number(n)),
            None => text,
        }
    }

    /// Bits as a number, of as many digits as fit.
    fn group(&mut self, at: usize, letters: DeviceClass) -> Option<Named> {
        let param = &self.place.params[at];
        let wide = self.place.form.wide;
        let values = match param.extent {
            Extent::Count(count) => count,
            _ => 1,
        };
        let most = (4 * self.words(param)).saturating_mul(values).clamp(1, 8);
        let mut least = 1;
        let mut digits = 1 + self.rng.below(most);
        let mut aligned = if self.rng.percent(80) { 8 } else { 1 };
        for rule in param.rules {
            match *rule {
                Rule::WholeGroup => {
                    let whole = if wide { 8 } else { 4 };
                    (least, digits) = (whole, whole);
                }
                Rule::SameDigits(i) => {
                    let other = self.named.get(i).copied().flatten();
                    if let Some(other) = other.and_then(|other| other.digits) {
                        (least, digits) = (other, other);
                    }
                }
                Rule::GroupAligned(of) => aligned = of,
                Rule::WideAligned(of) if wide => aligned = of,
                _ => {}
            }
        }
        let mut fewer = (least..=digits.max(least)).rev();
        let found = fewer.find_map(|digits| {
            let bits = self.extent(param).saturating_mul(4 * digits);
            let number = self.number(at, letters, bits, aligned);
            let number = number.or_else(|| self.number(at, letters, bits, 1))?;
            Some((digits, number))
        });
        found.map(|(digits, number)| Named {
            class: letters,
            number,
            digits: Some(digits),
        })
    }

    fn device(&mut self, at: usize, letters: DeviceClass) -> Option<Named> {
        if matches!(letters, DeviceClass::P | DeviceClass::I | DeviceClass::N) {
            return None;
        }
        let param = &self.place.params[at];
        let named = |number| Named {
            class: letters,
            number,
            digits: None,
        };
        // Operands that are the same device surprise an instruction most.
        let percent = if self.place.is_small { 40 } else { 8 };
        if self.rng.percent(percent) {
            let mut others = self.named.iter().flatten();
            if let Some(&same) = others.find(|o| o.class == letters && o.digits.is_none()) {
                return Some(same);
            }
        }
        let is_free = self.place.first.is_none() && param.numbers_on(self.place.model).is_empty();
        match letters {
            DeviceClass::D if is_free && self.rng.percent(6) => {
                return Some(named(special_register(self.rng, self.place.model)));
            }
            DeviceClass::M if is_free && param.role != Role::Read && self.rng.percent(4) => {
                return self.rng.pick(&FLAGS).map(named);
            }
            _ => {}
        }
        let each = match letters {
            DeviceClass::V | DeviceClass::Z if self.place.model.z_pairs_with_v => 1,
            DeviceClass::C if self.wants_counter32(param) => 1,
            _ => self.words(param),
        };
        let count = self.extent(param).saturating_mul(each);
        self.number(at, letters, count, 1).map(named)
    }

    /// Returns true if a counter must be one of 32 bits.
    fn wants_counter32(&self, param: &Param) -> bool {
        param.shape == Shape::Pair || param.shape == Shape::Value && self.place.form.wide
    }

    /// The number of the first of `count` devices: one of the first that fit, which other
    /// instructions use too, or now and then the last.
    fn number(&mut self, at: usize, class: DeviceClass, count: u32, aligned: u32) -> Option<u32> {
        let starts = self.starts(at, class, count, aligned);
        let &(first, last, step) = match self.rng.percent(90) {
            true => starts.first()?,
            false => starts.get(self.rng.below(starts.len() as u32) as usize)?,
        };
        let places = (last - first) / step;
        let near = match class {
            DeviceClass::V | DeviceClass::Z => 2,
            DeviceClass::T | DeviceClass::C => 5,
            _ => CROWD - 1,
        };
        let place = match self.rng.below(60) {
            0 => places,
            // Aligned devices are farther apart, and there are fewer of them.
            _ => self.rng.below(places.min((near / step).max(2)) + 1),
        };
        let even = place * step / 2 * 2;
        let pairs = self.rng.percent(50) && step == 1 && first % 2 == 0;
        Some(first + if pairs { even } else { place * step })
    }

    /// Range of first numbers for an operand of `count` devices, and their distance.
    fn starts(
        &self,
        at: usize,
        class: DeviceClass,
        count: u32,
        aligned: u32,
    ) -> Vec<(u32, u32, u32)> {
        let (param, model) = (&self.place.params[at], self.place.model);
        let numbers = param.numbers_on(model).iter();
        let mut allowed: Vec<(u32, u32)> = numbers
            .filter(|(of, ..)| *of == class)
            .map(|&(_, first, last)| (first, last))
            .collect();
        allowed.extend(self.place.first.filter(|_| at == 0));
        let is_free = allowed.is_empty();
        if is_free {
            allowed.push((0, u32::MAX));
        }
        let (mut step, mut least) = (aligned.max(1), 0);
        for rule in param.rules {
            match *rule {
                Rule::EndsInZero => step = if class.is_octal() { 8 } else { 10 },
                Rule::Aligned(of) => step = of.max(1),
                Rule::NotBefore(i) => {
                    let other = self.named.get(i).copied().flatten();
                    least = other
                        .filter(|o| o.class == class)
                        .map_or(least, |o| o.number);
                }
                _ => {}
            }
        }
        let counters32 = self.wants_counter32(param);
        let is_wanted = |first: u32| match class {
            DeviceClass::C if is_free && param.shape != Shape::Bit => {
                (first >= FIRST_COUNTER32) == counters32
            }
            _ => !is_free || is_special(class, first) == is_special(class, least),
        };
        let mut starts = Vec::new();
        for (begin, end) in model.runs(class) {
            let Some(highest) = (end + 1).checked_sub(count.max(1)) else {
                continue;
            };
            for &(first, last) in &allowed {
                let first = multiple_from(first.max(begin).max(least), step);
                let last = last.min(highest);
                if let Some(first) = first.filter(|&first| first <= last && is_wanted(first)) {
                    starts.push((first, last, step));
                }
            }
        }
        starts
    }
}
