//! Runs of devices: where an index or a block may go without leaving the devices it began in.

use crate::Model;
use rungc_rt::{Class, Register};
pub use rungc_rt::{FIRST_COUNTER32, FIRST_SPECIAL};
use rungc_syntax::DeviceClass;

/// A special register that is another name of an index register: D8028 is Z0.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct IndexAlias {
    /// The special register.
    pub register: Register,
    /// V or Z.
    pub class: DeviceClass,
    /// Number of the index register.
    pub index: u32,
}

impl IndexAlias {
    /// The special register `number` is another name of this index register.
    pub(crate) const fn new(number: u16, class: DeviceClass, index: u32) -> Self {
        IndexAlias {
            register: Register(number),
            class,
            index,
        }
    }

    /// Returns true if its special register is one of D`first` to D`last`.
    pub fn is_within(&self, first: u32, last: u32) -> bool {
        (first..=last).contains(&self.register.number())
    }
}

/// The class as the runtime numbers it; `None` for pointers and nesting levels, which are not storage.
pub fn rt_class(class: DeviceClass) -> Option<Class> {
    Some(match class {
        DeviceClass::X => Class::X,
        DeviceClass::Y => Class::Y,
        DeviceClass::M => Class::M,
        DeviceClass::S => Class::S,
        DeviceClass::T => Class::T,
        DeviceClass::C => Class::C,
        DeviceClass::D => Class::D,
        DeviceClass::R => Class::R,
        DeviceClass::ER => Class::ER,
        DeviceClass::V => Class::V,
        DeviceClass::Z => Class::Z,
        DeviceClass::P | DeviceClass::I | DeviceClass::N => return None,
    })
}

/// The class as programs name it.
pub fn name_class(class: Class) -> DeviceClass {
    match class {
        Class::X => DeviceClass::X,
        Class::Y => DeviceClass::Y,
        Class::M => DeviceClass::M,
        Class::S => DeviceClass::S,
        Class::T => DeviceClass::T,
        Class::C => DeviceClass::C,
        Class::D => DeviceClass::D,
        Class::R => DeviceClass::R,
        Class::ER => DeviceClass::ER,
        Class::V => DeviceClass::V,
        Class::Z => DeviceClass::Z,
    }
}

/// Returns true if a run ends before device `number` of `class` although the model has more: the special devices and
/// the 32-bit counters are separate from the devices before them.
pub fn is_border(class: DeviceClass, number: u32) -> bool {
    match class {
        DeviceClass::M | DeviceClass::D => number == FIRST_SPECIAL,
        DeviceClass::C => number == FIRST_COUNTER32,
        _ => false,
    }
}

/// Returns true if a device is a special relay or register.
pub fn is_special(class: DeviceClass, number: u32) -> bool {
    matches!(class, DeviceClass::M | DeviceClass::D) && number >= FIRST_SPECIAL
}

/// Returns true if a device is a 32-bit counter.
pub fn is_counter32(class: DeviceClass, number: u32) -> bool {
    class == DeviceClass::C && number >= FIRST_COUNTER32
}

/// Number of words that hold `count` bits from bit number `bit` of a word on.
pub fn words_of_bits(bit: u8, count: u32) -> u32 {
    u32::from(bit).saturating_add(count.max(1)).div_ceil(16)
}

impl Model {
    /// The device that a name stands for: some special registers are other names of index registers (D8028 is Z0),
    /// however they are reached.
    pub fn canonical(&self, class: DeviceClass, number: u32) -> (DeviceClass, u32) {
        if class != DeviceClass::D || number < FIRST_SPECIAL {
            return (class, number);
        }
        let mut aliases = self.index_aliases.iter();
        let alias = aliases.find(|alias| alias.register.number() == number);
        alias.map_or((class, number), |alias| (alias.class, alias.index))
    }

    /// Returns true if one of the registers `first` to `last` of a class is another name of an index register.
    pub fn has_alias(&self, class: DeviceClass, first: u32, last: u32) -> bool {
        self.aliases_within(class, first, last).next().is_some()
    }

    /// Those of the registers `first` to `last` of a class that are other names of index registers.
    pub fn aliases_within(
        &self,
        class: DeviceClass,
        first: u32,
        last: u32,
    ) -> impl Iterator<Item = &'static IndexAlias> + use<> {
        let aliases = self.index_aliases.iter();
        aliases.filter(move |alias| class == DeviceClass::D && alias.is_within(first, last))
    }

    /// The runs of a class as (first, last), in order: its ranges, general and latched neighbours joined.
    pub fn runs(&self, class: DeviceClass) -> Vec<(u32, u32)> {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        for range in self.ranges_of(class) {
            match runs.last_mut() {
                Some((_, last)) if *last + 1 == range.first && !is_border(class, range.first) => {
                    *last = range.last;
                }
                _ => runs.push((range.first, range.last)),
            }
        }
        runs
    }

    /// Returns true if `count` devices from `first` on all exist, in one run: [`rungc_ir::node::Expr::InRange`].
    pub fn in_range(&self, class: DeviceClass, first: i64, count: u32) -> bool {
        let last = first + i64::from(count.max(1)) - 1;
        self.runs(class)
            .iter()
            .any(|&(from, to)| i64::from(from) <= first && last <= i64::from(to))
    }
}
