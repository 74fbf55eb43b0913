//! The notation that rows are written in: a row reads like the box of the manual.
//!
//! ```text
//! row("ADD", "Addition", "h1u-h2u-programming §4.3.4").fnc(20).forms(ALL_FORMS).steps(7, 13)
//!     .takes(&[src("S1", VALUES), src("S2", VALUES), dst("D", RESULTS)])
//!     .flags(&["M8020", "M8021", "M8022"])
//!     .lower(Lower::Arith(ArithOp::Add))
//! ```

use super::{
    Classes, Drive, Extent, Forms, Inst, Limits, Lower, Param, Role, Rule, Shape, Spelling,
    Variant, When,
};
use rungc_models::ModelSet;
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass;

/// 16- and 32-bit form, each also as pulse.
pub(super) const ALL_FORMS: Forms = Forms::W16.or(Forms::W32).or(Forms::PULSE);
/// 16-bit form, also as pulse.
pub(super) const W16_P: Forms = Forms::W16.or(Forms::PULSE);
/// 16- and 32-bit form.
pub(super) const W16_W32: Forms = Forms::W16.or(Forms::W32);
/// 32-bit form, also as pulse.
pub(super) const W32_P: Forms = Forms::W32.or(Forms::PULSE);
/// Only the 32-bit form.
pub(super) const W32: Forms = Forms::W32;
/// Only the 16-bit form.
pub(super) const W16: Forms = Forms::W16;

/// Groups of bits that can be read.
pub(super) const GROUPS: Classes = Classes::KNX.or(RESULT_GROUPS);
/// Groups of bits that can be written.
pub(super) const RESULT_GROUPS: Classes = Classes::KNY.or(Classes::KNM).or(Classes::KNS);
/// Registers without V and Z; R counts on the models that have it.
pub(super) const REGISTERS: Classes = Classes::T.or(Classes::C).or(Classes::D).or(Classes::R);
/// D and R.
pub(super) const DATA: Classes = Classes::D.or(Classes::R);
/// Registers and buffer memory, which counts on the models that have it (FX3 programming manual, operands U\\G).
pub(super) const PLACES: Classes = REGISTERS.or(Classes::BUFFER);
/// D, R and buffer memory.
pub(super) const DATA_PLACES: Classes = DATA.or(Classes::BUFFER);
/// Integer constants.
pub(super) const CONSTANTS: Classes = Classes::K.or(Classes::H);
/// V and Z.
pub(super) const INDEX: Classes = Classes::V.or(Classes::Z);
/// Everything that has an integer value: `K, H, KnX … Z`.
pub(super) const VALUES: Classes = CONSTANTS.or(WORDS);
/// All its classes that are not constants: `KnX … Z`; buffer memory counts on the models that have it.
pub(super) const WORDS: Classes = GROUPS.or(REGISTERS).or(INDEX).or(Classes::BUFFER);
/// Everything that a result can go to: `KnY … Z`.
pub(super) const RESULTS: Classes = RESULT_GROUPS.or(REGISTERS).or(INDEX).or(Classes::BUFFER);
/// Bits that can be written.
pub(super) const COILS: Classes = Classes::Y.or(Classes::M).or(Classes::S);
/// Bits that can be read, but for contacts of timers and counters.
pub(super) const BITS: Classes = Classes::X.or(COILS);
/// Bits that a result can go to: also those of words, on the models that write them.
pub(super) const RESULT_BITS: Classes = COILS.or(Classes::WORD_BIT);
/// Bits that can be taken: also those of words.
pub(super) const SOURCE_BITS: Classes = BITS.or(Classes::WORD_BIT);
/// A negative constant is an error at run time.
pub(super) const NOT_NEGATIVE: &[Rule] = &[Rule::WorksWith(0, i64::MAX)];
/// A constant below 1 is an error at run time.
pub(super) const COUNTED: &[Rule] = &[Rule::WorksWith(1, i64::MAX)];
/// Everything that has a contact.
pub(super) const CONTACTS: Classes = BITS.or(Classes::T).or(Classes::C);

/// FX3S, FX3G and FX3U.
pub(super) const FX3: ModelSet = ModelSet::FX3;
/// FX3G and FX3U.
pub(super) const FX3GU: ModelSet = ModelSet::FX3G.or(ModelSet::FX3U);
/// The Mitsubishi models.
pub(super) const FX: ModelSet = ModelSet::FX;
/// The Mitsubishi models, and L01S, which follows FX3G.
pub(super) const LIKE_FX: ModelSet = FX.or(L01S);
/// Only FX3U.
pub(super) const FX3U: ModelSet = ModelSet::FX3U;
/// FX3S, FX3G, FX3U and what descends from them.
pub(super) const LIKE_FX3: ModelSet = FX3.or(L01S);
/// Only HM.
pub(super) const HM: ModelSet = ModelSet::HM;
/// H1U and H2U.
pub(super) const INOVANCE: ModelSet = ModelSet::INOVANCE;
/// Only L01S.
pub(super) const L01S: ModelSet = ModelSet::L01S;
/// FX3U and L01S.
pub(super) const FX3U_L01S: ModelSet = FX3U.or(L01S);
/// All but HM.
pub(super) const NOT_HM: ModelSet = ModelSet::ALL.without(HM);
/// All but FX1S and FX1N, which lack what JY992D88101 §5 gives to FX2N alone.
pub(super) const NOT_FX1: ModelSet = ModelSet::ALL.without(ModelSet::FX1);
/// All but HM, FX1S and FX1N.
pub(super) const NOT_HM_FX1: ModelSet = NOT_HM.without(ModelSet::FX1);
/// All but FX1S, FX1N, FX3S and FX3G, which lack what JY992D88101 §5 and JY997D16601 §3 give to FX2N and FX3U alone.
pub(super) const NOT_SMALL_FX: ModelSet = NOT_FX1.without(ModelSet::FX3S).without(ModelSet::FX3G);
/// The same without HM.
pub(super) const BIG: ModelSet = NOT_SMALL_FX.without(HM);
/// Models to which special modules can be attached: not HM, FX1S and FX3S.
pub(super) const WITH_MODULES: ModelSet = NOT_HM.without(ModelSet::FX1S).without(ModelSet::FX3S);

/// Reason of a row without an implementation; a test finds none.
pub(super) const NO_LOWERING: &str = "the row does not say what implements it";

/// The FX3 programming manual; its sections are in the order of the numbers FNC.
pub(super) const FX3_MANUAL: &str = "JY997D16601";

/// A row: 16-bit form of one step, no operands, driven by a contact, on all models.
pub(super) const fn row(name: &'static str, title: &'static str, source: &'static str) -> Inst {
    Inst {
        name,
        aliases: &[],
        spelling: Spelling::Prefix,
        fnc: None,
        title,
        text: "",
        example: None,
        source,
        forms: W16,
        steps: (1, 1),
        params: &[],
        variants: &[],
        drive: Drive::Contact,
        stops_undriven: false,
        flags: &[],
        max_uses: None,
        errors: &[],
        models: ModelSet::ALL,
        twin: None,
        repeat: super::repeat::USUAL.0,
        neutral: super::repeat::USUAL.1,
        lower: Lower::Todo(NO_LOWERING),
        lower_on: &[],
    }
}

impl Inst {
    pub(super) const fn aliases(self, aliases: &'static [&'static str]) -> Self {
        Inst { aliases, ..self }
    }

    pub(super) const fn spelling(self, spelling: Spelling) -> Self {
        Inst { spelling, ..self }
    }

    /// Another source than the manual of its family.
    pub(super) const fn source(self, source: &'static str) -> Self {
        Inst { source, ..self }
    }

    /// It takes many scans, and stops when its contacts open.
    pub(super) const fn stops_undriven(self) -> Self {
        Inst {
            stops_undriven: true,
            ..self
        }
    }

    pub(super) const fn fnc(self, number: u16) -> Self {
        let fnc = Some(number);
        Inst { fnc, ..self }
    }

    pub(super) const fn text(self, text: &'static str) -> Self {
        Inst { text, ..self }
    }

    pub(super) const fn example(self, program: &'static str) -> Self {
        let example = Some(program);
        Inst { example, ..self }
    }

    pub(super) const fn forms(self, forms: Forms) -> Self {
        Inst { forms, ..self }
    }

    pub(super) const fn steps(self, narrow: u8, wide: u8) -> Self {
        let steps = (narrow, wide);
        Inst { steps, ..self }
    }

    pub(super) const fn takes(self, params: &'static [Param]) -> Self {
        Inst { params, ..self }
    }

    pub(super) const fn variants(self, variants: &'static [Variant]) -> Self {
        Inst { variants, ..self }
    }

    pub(super) const fn drive(self, drive: Drive) -> Self {
        Inst { drive, ..self }
    }

    pub(super) const fn flags(self, flags: &'static [&'static str]) -> Self {
        Inst { flags, ..self }
    }

    pub(super) const fn twin(self, class: DeviceClass) -> Self {
        let twin = Some(class);
        Inst { twin, ..self }
    }

    pub(super) const fn errors(self, errors: &'static [u16]) -> Self {
        Inst { errors, ..self }
    }

    /// At most this often in a program.
    pub(super) const fn uses(self, count: u32) -> Self {
        let max_uses = Some(count);
        Inst { max_uses, ..self }
    }

    /// Implemented by this runtime function.
    pub(super) const fn call(self, function: RtFn) -> Self {
        self.lower(Lower::Call(function))
    }

    /// Not implemented yet, for this reason.
    pub(super) const fn todo(self, reason: &'static str) -> Self {
        self.lower(Lower::Todo(reason))
    }

    pub(super) const fn on(self, models: ModelSet) -> Self {
        Inst { models, ..self }
    }

    pub(super) const fn lower(self, lower: Lower) -> Self {
        Inst { lower, ..self }
    }

    pub(super) const fn lower_on(self, lower_on: &'static [(ModelSet, Lower)]) -> Self {
        Inst { lower_on, ..self }
    }
}

const fn param(name: &'static str, classes: Classes, shape: Shape, role: Role) -> Param {
    Param {
        name,
        classes,
        only_on: None,
        shape,
        role,
        extent: Extent::One,
        limits: Limits::None,
        checked: false,
        numbers: &[],
        sends_pulses: false,
        keeps_position: false,
        directs_pulses: false,
        names_inputs: false,
        rules: &[],
        indexable: true,
        unindexed: &[],
        optional: false,
    }
}

/// A value that is read: 16 or 32 bits as the form says.
pub(super) const fn src(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Value, Role::Read)
}

/// A value that is written.
pub(super) const fn dst(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Value, Role::Write)
}

/// A value that is changed.
pub(super) const fn both(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Value, Role::ReadWrite)
}

/// A bit that is read.
pub(super) const fn bit(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Bit, Role::Read)
}

/// A bit that is written.
pub(super) const fn coil(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Bit, Role::Write)
}

/// A 16-bit constant from `min` to `max`.
pub(super) const fn count(name: &'static str, min: i64, max: i64) -> Param {
    param(name, CONSTANTS, Shape::Word, Role::Read).limits(min, max)
}

/// A float that is read.
pub(super) const fn real(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Float, Role::Read)
}

/// A float that is written.
pub(super) const fn real_out(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Float, Role::Write)
}

/// Characters that are read.
pub(super) const fn text(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Text, Role::Read)
}

/// Characters that are written.
pub(super) const fn text_out(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Text, Role::Write)
}

/// Constant `i` of the operands, at least 0.
pub(super) fn constant(constants: &[Option<i64>], i: usize) -> Option<u32> {
    u32::try_from((*constants.get(i)?)?).ok()
}

/// A pointer or nesting level.
pub(super) const fn pointer(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Pointer, Role::Read).plain()
}

impl Param {
    /// It occupies this many devices from the named one on.
    pub(super) const fn len(self, count: u32) -> Self {
        let extent = Extent::Count(count);
        Param { extent, ..self }
    }

    /// It occupies from `least` to `most` devices from the named one on, as they say in a run.
    pub(super) const fn between(self, least: u32, most: u32) -> Self {
        let extent = Extent::Between { least, most };
        Param { extent, ..self }
    }

    /// It occupies as many devices as operand `i` says.
    pub(super) const fn per(self, i: usize) -> Self {
        let extent = Extent::Operand { i, extra: 0 };
        Param { extent, ..self }
    }

    /// It occupies as many devices as operand `i` says, and `extra`.
    pub(super) const fn per_and(self, i: usize, extra: i32) -> Self {
        let extent = Extent::Operand { i, extra };
        Param { extent, ..self }
    }

    /// It occupies as many devices as this function of the operands' constants says.
    pub(super) const fn len_of(self, count: fn(&[Option<i64>]) -> Option<u32>) -> Self {
        let extent = Extent::Of(count);
        Param { extent, ..self }
    }

    /// It occupies as many bits as this function of the operands' constants says, or a word that holds them.
    pub(super) const fn bits_of(self, count: fn(&[Option<i64>]) -> Option<u32>) -> Self {
        let extent = Extent::Bits(count);
        Param { extent, ..self }
    }

    /// Parameter whose extent is known only at run time.
    pub(super) const fn open_ended(self) -> Self {
        self.len_of(|_| None)
    }

    /// It reaches up to operand `i`.
    pub(super) const fn through(self, i: usize) -> Self {
        let extent = Extent::Through(i);
        Param { extent, ..self }
    }

    /// It obeys these rules.
    pub(super) const fn rules(self, rules: &'static [Rule]) -> Self {
        Param { rules, ..self }
    }

    /// It may also be one of these.
    pub(super) const fn also(self, classes: Classes) -> Self {
        let classes = self.classes.or(classes);
        Param { classes, ..self }
    }

    /// On these models it may also be one of these.
    pub(super) const fn also_on(self, models: ModelSet, classes: Classes) -> Self {
        let only_on = Some((classes.without(self.classes), models));
        Param { only_on, ..self }.also(classes)
    }

    /// It is both read and written.
    pub(super) const fn changed(self) -> Self {
        let role = Role::ReadWrite;
        Param { role, ..self }
    }

    /// It is a 16-bit word in either form.
    pub(super) const fn word(self) -> Self {
        self.shape(Shape::Word)
    }

    /// It is this instead.
    pub(super) const fn shape(self, shape: Shape) -> Self {
        Param { shape, ..self }
    }

    /// Constants lie between these.
    pub(super) const fn limits(self, min: i64, max: i64) -> Self {
        let limits = Limits::Between((min, max));
        Param { limits, ..self }
    }

    /// Constants lie in one of these ranges.
    pub(super) const fn among(self, ranges: &'static [(i64, i64)]) -> Self {
        let limits = Limits::Among(ranges);
        Param { limits, ..self }
    }

    /// Compiled code holds registers, and constants with an index register, to the limits.
    pub(super) const fn checked(self) -> Self {
        let checked = true;
        Param { checked, ..self }
    }

    /// Devices of these classes have these numbers.
    pub(super) const fn numbers(self, numbers: &'static [(DeviceClass, u32, u32)]) -> Self {
        Param { numbers, ..self }
    }

    /// It is an output that sends pulses.
    pub(super) const fn pulses(self) -> Self {
        let sends_pulses = true;
        Param {
            sends_pulses,
            ..self
        }
    }

    /// It is an output that sends pulses and keeps a position.
    pub(super) const fn positions(self) -> Self {
        let keeps_position = true;
        Param {
            keeps_position,
            ..self.pulses()
        }
    }

    /// It gives the direction of pulses.
    pub(super) const fn directs(self) -> Self {
        let directs_pulses = true;
        Param {
            directs_pulses,
            ..self
        }
    }

    /// No index register with these devices.
    pub(super) const fn unindexed(self, unindexed: &'static [(DeviceClass, u32, u32)]) -> Self {
        Param { unindexed, ..self }
    }

    /// Its bits name inputs.
    pub(super) const fn inputs(self) -> Self {
        let names_inputs = true;
        Param {
            names_inputs,
            ..self
        }
    }

    /// It may be left out.
    pub(super) const fn optional(self) -> Self {
        let optional = true;
        Param { optional, ..self }
    }

    /// No index register.
    pub(super) const fn plain(self) -> Self {
        let indexable = false;
        Param { indexable, ..self }
    }
}

/// A variant that says nothing yet.
pub(super) const fn variant(models: ModelSet, when: When) -> Variant {
    Variant {
        models,
        when,
        forms: None,
        steps: None,
        params: None,
    }
}

/// A variant for whatever operands.
pub(super) const fn on(models: ModelSet) -> Variant {
    variant(models, When::Always)
}

/// A variant for devices of these classes as the first operand.
pub(super) const fn first(models: ModelSet, classes: Classes) -> Variant {
    variant(models, When::First(classes, 0, u32::MAX))
}

/// A variant for devices of these classes and numbers as the first operand.
pub(super) const fn first_in(models: ModelSet, classes: Classes, from: u32, to: u32) -> Variant {
    variant(models, When::First(classes, from, to))
}

/// A variant for operands with an index register.
pub(super) const fn indexed(models: ModelSet) -> Variant {
    variant(models, When::Indexed)
}

impl Variant {
    pub(super) const fn steps(self, narrow: u8, wide: u8) -> Self {
        let steps = Some((narrow, wide));
        Variant { steps, ..self }
    }

    pub(super) const fn takes(self, params: &'static [Param]) -> Self {
        let params = Some(params);
        Variant { params, ..self }
    }

    pub(super) const fn forms(self, forms: Forms) -> Self {
        let forms = Some(forms);
        Variant { forms, ..self }
    }
}

/// A bit or a word that is read, as the operand is.
pub(super) const fn mixed(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Mixed, Role::Read)
}

/// A bit or a word that is written, as the operand is.
pub(super) const fn mixed_out(name: &'static str, classes: Classes) -> Param {
    param(name, classes, Shape::Mixed, Role::Write)
}
