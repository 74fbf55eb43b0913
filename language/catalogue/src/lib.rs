//! The catalogue of instructions: one row each. Parser, checks, step counting, documentation, lowering, the interpreter
//! and both backends read the row; nothing about an instruction's operands or forms is written anywhere else.
//!
//! To add an instruction: a row in the file of its family, its runtime function (or IR operator), conformance cases.
//!
//! The catalogue must not know programs, file formats or the IR. Start reading at [`Inst`], then the rows of a family
//! (`move_.rs`); the private module `row` is the notation that they are written in.

mod arith;
mod basic;
mod block;
mod clock;
mod compare;
mod data;
mod explain;
mod external_io;
mod flags;
mod float;
mod flow;
mod form;
mod handy;
mod high_speed;
mod limits;
mod lookup;
mod motion_hm;
mod move_;
mod position;
mod repeat;
mod rotate;
mod row;
mod serial;
mod string;
#[cfg(test)]
mod tests;

pub use explain::{explain, explain_on, meaning, special_table, support_table};
pub use form::Form;
pub use limits::Limits;
pub use lookup::{Family, Found, all, families, find};
pub use repeat::{Neutral, Repeat};

use rungc_models::{Model, ModelId, ModelSet};
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{Classes, DeviceClass, Operand, OperandKind};

/// Kind of object that an operand denotes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shape {
    /// A bit.
    Bit,
    /// A 16-bit word in the 16-bit form, 32 bits in the 32-bit form.
    Value,
    /// A 16-bit word in either form (counts, first words of tables).
    Word,
    /// 32 bits in either form.
    Pair,
    /// A single-precision float (a pair).
    Float,
    /// Characters, or the first word that holds them.
    Text,
    /// A pointer, interrupt pointer or nesting level.
    Pointer,
    /// A bit where the operand is X, Y, M, S or a bit of a word, a 16-bit word elsewhere (DECO, ENCO); RST and ZRST
    /// mean with T and C both contact and value. An extent other than [`Extent::Through`] counts bits; a word is one.
    Mixed,
}

/// Use of an operand by an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// Only reads it.
    Read,
    /// Only writes it.
    Write,
    /// Both.
    ReadWrite,
}

/// Number of devices that an operand occupies from the named one on, in units of its [`Shape`] (a `Value` of the 32-bit
/// form counts 2 words).
#[derive(Clone, Copy, Debug)]
pub enum Extent {
    /// One.
    One,
    /// This many.
    Count(u32),
    /// From `least` to `most`, as the devices themselves say in a run.
    Between {
        /// Number that any settings need.
        least: u32,
        /// Number that some settings need.
        most: u32,
    },
    /// As many as operand `i` says, plus `extra`. If that operand is not a constant, up to the end of the class.
    Operand {
        /// Position of the operand that holds the count.
        i: usize,
        /// Number to add.
        extra: i32,
    },
    /// Up to the device that operand `i` names, inclusive.
    Through(usize),
    /// As many as this function of the operands' constants says (`None` for an operand that is none); `None`: to the
    /// class's end.
    Of(fn(&[Option<i64>]) -> Option<u32>),
    /// As many bits as such a function says, all of them in one word if the operand is a word.
    Bits(fn(&[Option<i64>]) -> Option<u32>),
}

/// Steps that a text of any length takes beyond those of two bytes: two for each two more, as GX Works2 counts them. A
/// character that is not ASCII has two bytes in the code pages of the editors.
fn longer_text(text: &str) -> u32 {
    let bytes: u32 = text.chars().map(|c| if c.is_ascii() { 1 } else { 2 }).sum();
    2 * bytes.div_ceil(2).saturating_sub(1)
}

/// Something more that an operand must obey. A rule about constants says nothing of an operand that is none (or is
/// indexed).
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// In the 32-bit form a constant lies between these instead of those of the parameter.
    WideLimits(i64, i64),
    /// A constant does not lie between these, inclusive.
    Not(i64, i64),
    /// With a constant that does not lie between these, inclusive, the instruction fails each time it runs.
    WorksWith(i64, i64),
    /// With a constant that is not greater than this, it does.
    WorksAbove(i64),
    /// With a constant that is greater than `.1`, it does if operand `.0` is a word.
    WordWorksTo(usize, i64),
    /// With a constant that is smaller than the one of operand `i`, it does.
    WorksFrom(usize),
    /// A constant is a multiple of this.
    MultipleOf(i64),
    /// A constant is not larger than the one of operand `i`.
    AtMost(usize),
    /// A constant is not smaller than the one of operand `i`.
    AtLeast(usize),
    /// A constant is smaller than the one of operand `i`.
    Below(usize),
    /// The device's number ends in 0 as it is written: a multiple of 8 for X and Y, of 10 for others.
    EndsInZero,
    /// The device's number is a multiple of this.
    Aligned(u32),
    /// A group has as many bits as the form: K4, in the 32-bit form K8.
    WholeGroup,
    /// A group begins at a multiple of this.
    GroupAligned(u32),
    /// In the 32-bit form a group begins at a multiple of this.
    WideAligned(u32),
    /// If it is a group and operand `i` too, both have as many digits.
    SameDigits(usize),
    /// It is a group exactly if operand `i` is one.
    GroupLike(usize),
    /// A group of fewer digits means one of four if operand `i` is not a group. Nothing is rejected.
    WordsWith(usize),
    /// If operand `.0` is a group, a constant is at most `.1`.
    GroupAtMost(usize, i64),
    /// In the 32-bit form a counter is a 32-bit one.
    WideCounter,
    /// In the 32-bit form it is none of these.
    WideNot(Classes),
    /// A device of the same class as operand `i`.
    ClassLike(usize),
    /// A device not before operand `i`; either both or neither are special.
    NotBefore(usize),
    /// With operands that do not pass this check, the instruction fails; the text says when it works.
    WorksIf(fn(&[Operand]) -> bool, &'static str),
    /// A check of all operands; the text describes the demand.
    Holds(fn(&[Operand]) -> bool, &'static str),
    /// A constant suits this predicate, which the text states.
    Suits(fn(i64) -> bool, &'static str),
}

/// One operand of an instruction.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Name in the manual: `S1`, `D`, `n`.
    pub name: &'static str,
    /// Allowed classes.
    pub classes: Classes,
    /// Classes among them that only some models accept here.
    pub only_on: Option<(Classes, ModelSet)>,
    /// Kind of object.
    pub shape: Shape,
    /// Use by the instruction.
    pub role: Role,
    /// Number of devices.
    pub extent: Extent,
    /// Allowed constants.
    pub limits: Limits,
    /// True if compiled code holds a constant with an index register, or a register, to the limits: the runtime's
    /// function, which other models share, accepts more.
    pub checked: bool,
    /// Numbers that devices of these classes must have, first to last; classes that are not listed are free.
    pub numbers: &'static [(DeviceClass, u32, u32)],
    /// True for an output that sends pulses: one of the model's, unless `numbers` says more.
    pub sends_pulses: bool,
    /// True for an output that keeps a position.
    pub keeps_position: bool,
    /// True for an output that gives the direction of pulses.
    pub directs_pulses: bool,
    /// Its bits name inputs X.
    pub names_inputs: bool,
    /// Additional rules.
    pub rules: &'static [Rule],
    /// True if it may carry an index register.
    pub indexable: bool,
    /// Devices of these classes and numbers, first to last, that may not, although others may.
    pub unindexed: &'static [(DeviceClass, u32, u32)],
    /// True if it may be omitted (only last ones).
    pub optional: bool,
}

impl Param {
    /// Extent of an operand: a word holds all bits of [`Extent::Bits`].
    pub fn extent_of(&self, operand: &OperandKind) -> Extent {
        match self.extent {
            Extent::Bits(_) if !row::BITS.meets(Classes::of(operand)) => Extent::One,
            extent => extent,
        }
    }

    /// Numbers that devices of these classes must have on a model, first to last.
    pub fn numbers_on(&self, model: &Model) -> &'static [(DeviceClass, u32, u32)] {
        match (self.numbers, self.keeps_position) {
            ([], true) => model.position_outputs,
            ([], false) if self.sends_pulses => model.pulse_outputs,
            (numbers, _) => numbers,
        }
    }

    /// Classes allowed on a model: without those that only others accept, and without notations and devices that the
    /// model does not have at all.
    pub fn classes_on(&self, model: &Model) -> Classes {
        self.classes_without(model.missing(), model.id)
    }

    /// As [`Param::classes_on`] for callers that ask often; `missing` is [`Model::missing`].
    pub fn classes_without(&self, missing: Classes, model: ModelId) -> Classes {
        let classes = self.classes.without(missing);
        match self.only_on {
            Some((others, models)) if !models.has(model) => classes.without(others),
            _ => classes,
        }
    }
}

/// The forms an instruction has.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Forms(pub u8);

impl Forms {
    /// 16-bit, continuous.
    pub const W16: Forms = Forms(1);
    /// 32-bit (prefix D).
    pub const W32: Forms = Forms(2);
    /// Pulse (suffix P) of each width it has.
    pub const PULSE: Forms = Forms(4);

    /// Both sets.
    #[must_use]
    pub const fn or(self, other: Forms) -> Forms {
        Forms(self.0 | other.0)
    }

    /// Returns true if `form` is one of them.
    pub const fn has(self, form: Forms) -> bool {
        self.0 & form.0 == form.0
    }
}

/// Spelling of an instruction's forms.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Spelling {
    /// `D` in front of the 32-bit form, `P` after the pulse form: `DADDP`.
    Prefix,
    /// A contact comparison: `LD` + `D` + operator: `LDD>=`.
    Compare,
    /// Its only form is 32 bits wide but is written without D (PSOUT).
    Plain,
    /// The 32-bit form has a separate name, for example `WAND` / `DAND`.
    Wide(&'static str),
}

/// Position relative to contacts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Drive {
    /// It begins or continues the contact logic (LD, AND, ANB, MPS, INV, …).
    Logic,
    /// It needs a contact before it (or an STL sub-bus).
    Contact,
    /// It has no contact before it.
    Alone,
}

/// Integer arithmetic of FNC 20–29.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs, reason = "the names are the instructions")]
pub enum ArithOp {
    Add,
    Sub,
    Mul,
    Div,
    Inc,
    Dec,
    And,
    Or,
    Xor,
    Neg,
}

/// Basic instructions and program flow, which lowering handles one by one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs, reason = "the names are the instructions")]
pub enum Basic {
    Ld,
    Ldi,
    Ldp,
    Ldf,
    And,
    Ani,
    Andp,
    Andf,
    Or,
    Ori,
    Orp,
    Orf,
    Anb,
    Orb,
    Mps,
    Mrd,
    Mpp,
    Inv,
    Mep,
    Mef,
    Out,
    Set,
    Rst,
    Pls,
    Plf,
    Mc,
    Mcr,
    Nop,
    End,
    Label,
    Stl,
    Ret,
    Cj,
    Call,
    Sret,
    Iret,
    Proc,
    Pend,
    Pret,
    Ei,
    Di,
    Fend,
    Wdt,
    For,
    Next,
}

/// Operation by which a contact comparison joins the logic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs, reason = "the names are the instructions")]
pub enum Join {
    Ld,
    And,
    Or,
}

/// Implementation of a row.
#[derive(Clone, Copy, Debug)]
pub enum Lower {
    /// Lowering knows it by name.
    Basic(Basic),
    /// Contact comparison.
    Compare(Join, CmpOp),
    /// MOV: copies S to D.
    Move,
    /// HCMOV: copies the count S to D and may set it to 0.
    MoveCount,
    /// CML: complements S to D.
    MoveNot,
    /// COMRD: a device's comment, which the compiler knows.
    Comment,
    /// CMP: three bits.
    Cmp,
    /// ZCP: three bits.
    Zcp,
    /// Arithmetic with the FX family's flags: wraps.
    Arith(ArithOp),
    /// Arithmetic that saturates (HM).
    ArithSaturating(ArithOp),
    /// Sets these parameters of an axis (HM).
    Axis(&'static [u32]),
    /// A comparison that acts at the count of a high-speed counter.
    HighSpeed(Comparison),
    /// SPD: counts pulses of an input in windows of time.
    Density,
    /// An operation on values, which is inline code whatever the operands are.
    Values(ValueOp),
    /// A runtime function.
    Call(RtFn),
    /// A runtime function of which one instruction of a program runs at a time: while it is driven, others are not.
    Exclusive(RtFn),
    /// It cannot be compiled: an error names the instruction and this reason.
    Todo(&'static str),
}

/// An operation on values.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ValueOp {
    /// SEGD: the segments of a digit.
    Segments,
    /// LIMIT: a value held between two others.
    Limit,
    /// BAND: how far a value lies outside a band.
    Band,
    /// ZONE: a value moved away from 0, by one distance below it and another above it.
    Zone,
    /// SWAP: the bytes of each word exchanged.
    SwapBytes,
    /// XCH: two values exchanged.
    Exchange {
        /// A value exchanged with itself has its bytes exchanged while M8160 is on.
        bytes: bool,
    },
    /// ALT: a bit inverted.
    Alternate,
    /// BCD: the decimal digits of a value.
    ToBcd {
        /// A value that has more digits than fit is held at the largest that does, a negative one at 0; else they are
        /// an error.
        clamps: bool,
    },
    /// BIN: the number of decimal digits.
    FromBcd {
        /// A digit above 9 is an error; else it counts as what it is.
        checks: bool,
    },
    /// SUM: the number of bits that are on.
    CountOnes,
    /// BON: one bit of a value.
    TestBit,
    /// ROR: the bits moved to the right, around the end.
    RotateRight,
    /// ROL: the bits moved to the left, around the end.
    RotateLeft,
    /// SQR: the integer square root.
    Root {
        /// A negative value counts as 0; else it is an error.
        clamps: bool,
    },
    /// GRY: the Gray code of a number.
    ToGray,
    /// GBIN: the number of a Gray code.
    FromGray,
}

/// A comparison at the count.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Comparison {
    /// HSCS: switches on, or requests an interrupt.
    Set,
    /// HSCR: switches off.
    Reset,
    /// HSZ: shows in three bits whether the count is below, in or above a zone.
    Zone,
    /// HSCT: works through a table.
    Table,
}

/// Condition of a [`Variant`].
#[derive(Clone, Copy, Debug)]
pub enum When {
    /// Always.
    Always,
    /// The first operand is one of these classes (and, if a device, has a number from the one to the other).
    First(Classes, u32, u32),
    /// An operand carries an index register.
    Indexed,
}

impl When {
    fn holds(self, written: &Written) -> bool {
        match self {
            When::Always => true,
            When::First(classes, first, last) => {
                let in_range = |number| (first..=last).contains(&number);
                classes.meets(written.class) && written.number.is_none_or(in_range)
            }
            When::Indexed => written.indexed,
        }
    }
}

/// Properties of the written operands that a [`When`] depends on.
struct Written {
    /// Class of the first one; `NONE` if there is none.
    class: Classes,
    /// Number of the first one, if it is a device.
    number: Option<u32>,
    /// True if one of them has an index register.
    indexed: bool,
}

impl Written {
    fn of(operands: &[Operand]) -> Self {
        let first = operands.first().map(|operand| &operand.kind);
        Written {
            class: match first {
                // The intended device decides which operands fit.
                Some(OperandKind::Unreadable(Some(device))) => Classes::of_device(device.class),
                first => first.map_or(Classes::NONE, Classes::of),
            },
            number: match first {
                Some(OperandKind::Device(device, _) | OperandKind::Unreadable(Some(device))) => {
                    Some(device.number)
                }
                _ => None,
            },
            indexed: operands.iter().any(|operand| {
                matches!(
                    operand.kind,
                    OperandKind::Device(_, Some(_))
                        | OperandKind::WordBit(_, _, Some(_))
                        | OperandKind::Nibbles(_, _, Some(_))
                        | OperandKind::Decimal(_, Some(_))
                        | OperandKind::Hex(_, Some(_))
                )
            }),
        }
    }
}

/// Deviation from the row, on some models or with some operands. Of the variants that hold, the first that has
/// something to say about a thing decides it.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// On these models …
    pub models: ModelSet,
    /// … and when this holds.
    pub when: When,
    /// Its forms; only where `when` is [`When::Always`].
    pub forms: Option<Forms>,
    /// Its steps.
    pub steps: Option<(u8, u8)>,
    /// Its operands.
    pub params: Option<&'static [Param]>,
}

/// One instruction.
#[derive(Clone, Copy, Debug)]
pub struct Inst {
    /// Mnemonic of the 16-bit continuous form (or of the only form).
    pub name: &'static str,
    /// Other spellings of `name`.
    pub aliases: &'static [&'static str],
    /// Spelling of its forms.
    pub spelling: Spelling,
    /// FNC number, where it has one.
    pub fnc: Option<u16>,
    /// One line: what it does.
    pub title: &'static str,
    /// A paragraph for `rungc explain`, in our own words.
    pub text: &'static str,
    /// A small program that shows it, where one that is made from its operands would not do; see [`Inst::example_on`].
    pub example: Option<&'static str>,
    /// Source in the manuals: `h1u-h2u-programming §4.3.2`.
    pub source: &'static str,
    /// Its forms.
    pub forms: Forms,
    /// Steps of the 16-bit and of the 32-bit form, where no variant says otherwise; see [`Inst::steps_of`].
    pub steps: (u8, u8),
    /// Its operands, where no variant says otherwise; see [`Inst::params_of`].
    pub params: &'static [Param],
    /// Deviations on some models or with some operands.
    pub variants: &'static [Variant],
    /// Position relative to contacts.
    pub drive: Drive,
    /// True if it takes many scans, and stops when its contacts open before it has ended.
    pub stops_undriven: bool,
    /// Special relays and registers that it reads or writes on some model; see [`Inst::flags_on`].
    pub flags: &'static [&'static str],
    /// Maximum number of uses in a program; `None`: any number of times.
    pub max_uses: Option<u32>,
    /// The PLC's error codes that it can raise in a run, but for those of any operand: a device out of range, a module
    /// that is not there.
    pub errors: &'static [u16],
    /// Models that have it.
    pub models: ModelSet,
    /// A class whose devices with the numbers of the first operand it works on too: the runtime takes them as one more
    /// operand.
    pub twin: Option<DeviceClass>,
    /// Effect of running again.
    pub repeat: Repeat,
    /// Constants without effect.
    pub neutral: Neutral,
    /// Implementation; see [`Inst::lower_on_model`].
    lower: Lower,
    /// Models on which something else implements it.
    lower_on: &'static [(ModelSet, Lower)],
}

impl Inst {
    /// Basic instruction, if it is one on all models.
    pub const fn basic(&self) -> Option<Basic> {
        match self.lower {
            Lower::Basic(basic) => Some(basic),
            _ => None,
        }
    }

    /// Implementation on a model.
    pub fn lower_on_model(&self, model: ModelId) -> Lower {
        self.lower_on
            .iter()
            .find(|(models, _)| models.has(model))
            .map_or(self.lower, |&(_, lower)| lower)
    }

    /// The forms it has on a model.
    pub fn forms_on(&self, model: ModelId) -> Forms {
        let always =
            |variant: &Variant| variant.models.has(model) && matches!(variant.when, When::Always);
        self.variants
            .iter()
            .find_map(|variant| variant.forms.filter(|_| always(variant)))
            .unwrap_or(self.forms)
    }

    /// Parameters on a model, given the written operands (OUT T0 has one more than OUT Y000).
    pub fn params_of(&self, operands: &[Operand], model: &Model) -> &'static [Param] {
        let written = Written::of(operands);
        let stated = self.stated(&written, model, |variant| variant.params);
        stated.unwrap_or(self.params)
    }

    /// Returns true if its operands depend on what the first one is: `OUT T0 K30`, `OUT Y0`.
    pub fn depends_on_first(&self) -> bool {
        let mut variants = self.variants.iter();
        variants.any(|variant| matches!(variant.when, When::First(..)) && variant.params.is_some())
    }

    /// Number of steps in the program memory.
    pub fn steps_of(&self, form: Form, operands: &[Operand], model: &Model) -> u32 {
        self.params_and_steps(form, operands, model).1
    }

    /// [`Inst::params_of`] and [`Inst::steps_of`].
    pub fn params_and_steps(
        &self,
        form: Form,
        operands: &[Operand],
        model: &Model,
    ) -> (&'static [Param], u32) {
        let written = Written::of(operands);
        let params = self
            .stated(&written, model, |variant| variant.params)
            .unwrap_or(self.params);
        let stated = self.stated(&written, model, |variant| variant.steps);
        let (narrow, wide) = match (stated, model.steps_per_operand) {
            (Some(steps), _) => steps,
            (None, Some((narrow, wide))) if self.basic().is_none() => {
                let count = params.len() as u8;
                (1 + narrow * count, 1 + wide * count)
            }
            _ => self.steps,
        };
        let texts = params
            .iter()
            .zip(operands)
            .map(|(param, operand)| match &operand.kind {
                OperandKind::Text(text) if matches!(param.extent, Extent::Of(_)) => {
                    longer_text(text)
                }
                _ => 0,
            });
        let steps = u32::from(if form.wide { wide } else { narrow });
        (params, steps + texts.sum::<u32>())
    }

    /// Statement of the first applicable variant that has one.
    fn stated<T>(
        &self,
        written: &Written,
        model: &Model,
        what: impl Fn(&Variant) -> Option<T>,
    ) -> Option<T> {
        let holds = |variant: &Variant| variant.models.has(model.id) && variant.when.holds(written);
        self.variants
            .iter()
            .find_map(|variant| what(variant).filter(|_| holds(variant)))
    }
}
