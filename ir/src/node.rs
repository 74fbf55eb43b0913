//! The typed IR. The docs of this module are the specification that the interpreter and both backends are held to.
//!
//! A [`Module`] holds an arena of [`Expr`]s and [`Body`]s of [`Stmt`]s. Expressions are pure but read devices and temporaries; a
//! statement evaluates all of its expressions when it is executed, before it writes anything. Statements are executed in order, so
//! a write between two reads is never reordered. An expression that several statements use is a temporary ([`Stmt::Let`]).
//!
//! A scan that does not end is cut short by the watchdog: [`Stmt::Watch`] is in all loops except those that are known to be short, and at
//! all jumps back, and counts the steps of the program that they repeat. After the last one the function is left, and so is each that
//! called it, up to `Main`; `End` does nothing. If an interrupt routine is cut short, the scan continues to its end.
//!
//! Integers are two's complement and wrap. `I16` values are signed 16-bit, `I32` signed 32-bit, `F32` IEEE single, `Bit` true or false.

use crate::layout::Layout;
use crate::walk::{calls_runtime, statements};
use rungc_models::{Model, Range};
use rungc_rt::special::D_WATCHDOG_MS;
use rungc_rt::{CmpOp, EdgeKind, Register, Relay, RtFn, TimerKind};
use rungc_syntax::{DeviceClass, Span};
use std::borrow::Cow;

/// Type of an expression or temporary.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Ty {
    /// Contact state.
    Bit,
    /// Signed 16-bit.
    I16,
    /// Signed 32-bit.
    I32,
    /// Single-precision float.
    F32,
}

/// Handle of an expression in [`Module::exprs`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct ExprId(pub u32);

/// Handle of a temporary; its type is in [`Module::temps`]. Assigned by [`Stmt::Let`], [`Stmt::Edge`] or [`Stmt::Fetch`] before any use on
/// every path, in the same [`Function`], which may be in a body around or before the use; some are assigned in several places.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct TempId(pub u32);

/// Handle of an edge memory: one bit, off at power-on and when RUN begins. Several statements may share one: each stores its input.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct EdgeId(pub u32);

/// Handle of a [`Flag`] in [`Module::flags`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct FlagId(pub u32);

/// A private bit with a name; off at power-on and when RUN begins.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Flag {
    /// An identifier in lower case, unique in the module: `x000_rose`.
    pub name: String,
    /// What it means, for a comment.
    pub meaning: &'static str,
    /// Set each time that this many milliseconds of RUN have passed since the last time, or since RUN began
    /// ([`rungc_rt::Program::tick`]); `None`: by the program only.
    pub period_ms: Option<u32>,
    /// Set when a train of pulses of this output Y has been sent to its end ([`rungc_rt::Axis::take_end`], asked whenever pulses are counted).
    pub pulses_end: Option<u32>,
}

/// Handle of a [`Cell`] in [`Module::cells`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct CellId(pub u32);

/// A private `I32` with a name; 0 at power-on.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cell {
    /// An identifier in lower case, unique in the module: `c235_preset`.
    pub name: String,
    /// What it means, for a comment.
    pub meaning: &'static str,
    /// Set to the time, as for [`SysValue::NowMs`], each time that a host reports it ([`rungc_rt::Program::tick`]).
    pub follows_time: bool,
}

/// Handle of a [`Table`] in [`Module::tables`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct TableId(pub u32);

/// Private `I32`s with a name; all 0 at power-on.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Table {
    /// An identifier in lower case, unique in the module: `table1`.
    pub name: String,
    /// What it means, for a comment.
    pub meaning: &'static str,
    /// How many, at least 1.
    pub length: u32,
}

/// A bit or word device, perhaps indexed: number = `number` + `index` (an `I32` expression). A special register that is another name of
/// an index register is that register, however a place or a run leads to it ([`Model::canonical`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub struct Place {
    /// Class.
    pub class: DeviceClass,
    /// Number without the index.
    pub number: u32,
    /// What to add. A place with an index may only be accessed where [`Expr::InRange`] of it is known to hold; that of an
    /// [`Expr::Stride`] does. Which devices it may lead to says [`crate::reach`]; all of them are stored. An indexed
    /// access of a word of C200 and up reads the low word, and writes the sign-extended word.
    pub index: Option<ExprId>,
}

impl From<Relay> for Place {
    fn from(relay: Relay) -> Self {
        Place {
            class: DeviceClass::M,
            number: relay.number(),
            index: None,
        }
    }
}

impl From<Register> for Place {
    fn from(register: Register) -> Self {
        Place {
            class: DeviceClass::D,
            number: register.number(),
            index: None,
        }
    }
}

/// Two-operand integer operators. Both operands and the result have the same type, `I16` or `I32`, and wrap.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum BinOp {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// `I32` only: the high 32 bits of the signed 64-bit product.
    MulHigh,
    /// Quotient, truncated towards zero; MIN / -1 wraps. The divisor must be known not to be 0.
    Div,
    /// Remainder with the sign of the dividend. The divisor must be known not to be 0.
    Rem,
    /// Bitwise and.
    And,
    /// Bitwise or.
    Or,
    /// Bitwise exclusive or.
    Xor,
    /// Sum, held at the ends of the type's range.
    SatAdd,
    /// Difference, held at the ends of the type's range.
    SatSub,
    /// The bits of the first operand, those that leave at the high end entering at the low end, by as many places as the second one
    /// says, modulo the type's width.
    RotateLeft,
}

impl BinOp {
    /// The result of two `I16`; `None` where the divisor is 0, and of the operator that there is for `I32` only.
    pub fn of_i16(self, a: i16, b: i16) -> Option<i16> {
        match self {
            BinOp::MulHigh => None,
            BinOp::RotateLeft => Some(a.rotate_left(b as u32 % 16)),
            BinOp::SatAdd => Some(a.saturating_add(b)),
            BinOp::SatSub => Some(a.saturating_sub(b)),
            _ => self.of_i32(a.into(), b.into()).map(|wide| wide as i16),
        }
    }

    /// The result of two `I32`; `None` where the divisor is 0.
    pub fn of_i32(self, a: i32, b: i32) -> Option<i32> {
        Some(match self {
            BinOp::Add => a.wrapping_add(b),
            BinOp::Sub => a.wrapping_sub(b),
            BinOp::Mul => a.wrapping_mul(b),
            BinOp::MulHigh => ((i64::from(a) * i64::from(b)) >> 32) as i32,
            BinOp::Div | BinOp::Rem if b == 0 => return None,
            BinOp::Div => a.wrapping_div(b),
            BinOp::Rem => a.wrapping_rem(b),
            BinOp::And => a & b,
            BinOp::Or => a | b,
            BinOp::Xor => a ^ b,
            BinOp::SatAdd => a.saturating_add(b),
            BinOp::SatSub => a.saturating_sub(b),
            BinOp::RotateLeft => a.rotate_left(b as u32 % 32),
        })
    }
}

/// One-operand functions on words and floats; [`rungc_rt::word`] has them under their names.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum UnOp {
    /// The two bytes of each 16 bits of an integer exchanged.
    SwapBytes,
    /// How many bits of an integer are on, in its type.
    CountOnes,
    /// The decimal digits of an integer, four bits each; it must be known to be from 0 to 9999 (`I16`) or 99 999 999 (`I32`).
    ToBcd,
    /// The number whose decimal digits an integer holds, four bits each; a digit above 9 counts as what it is.
    FromBcd,
    /// `Bit`: whether no four bits of an integer are above 9.
    IsBcd,
    /// `I32`: the integer square root of an `I32`, which must be known to be at least 0.
    Root,
    /// `I32` to the nearest `F32`.
    ToFloat,
    /// `F32` to the low 32 bits of its integer part (`I32`), which is held at the ends of 64 bits.
    Truncate,
    /// `Bit`: whether an `F32` is a number and not infinite.
    IsFinite,
    /// An `F32` with the other sign.
    Negate,
}

impl UnOp {
    /// The name of the function of a value of type `ty`.
    pub const fn name(self, ty: Ty) -> &'static str {
        let narrow = matches!(ty, Ty::I16);
        match self {
            UnOp::SwapBytes if narrow => "swap16",
            UnOp::SwapBytes => "swap32",
            UnOp::CountOnes if narrow => "ones16",
            UnOp::CountOnes => "ones32",
            UnOp::ToBcd if narrow => "to_bcd16",
            UnOp::ToBcd => "to_bcd32",
            UnOp::FromBcd if narrow => "from_bcd16",
            UnOp::FromBcd => "from_bcd32",
            UnOp::IsBcd if narrow => "is_bcd16",
            UnOp::IsBcd => "is_bcd32",
            UnOp::Root => "root",
            UnOp::ToFloat => "to_float",
            UnOp::Truncate => "truncate",
            UnOp::IsFinite => "is_finite",
            UnOp::Negate => "negate",
        }
    }

    /// Whether it takes a value of type `ty`.
    pub const fn takes(self, ty: Ty) -> bool {
        match self {
            UnOp::SwapBytes | UnOp::CountOnes | UnOp::ToBcd | UnOp::FromBcd | UnOp::IsBcd => {
                matches!(ty, Ty::I16 | Ty::I32)
            }
            UnOp::Root | UnOp::ToFloat => matches!(ty, Ty::I32),
            UnOp::Truncate | UnOp::IsFinite | UnOp::Negate => matches!(ty, Ty::F32),
        }
    }
}

/// Two-operand operators of `F32`. A result too large for an `F32` is the largest of its sign, one that is not 0 but too small for a
/// normal one is the smallest normal one of its sign: [`rungc_rt::word`] has them as `float_add` and so on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum FloatOp {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient. The divisor must be known not to be 0.
    Div,
}

impl FloatOp {
    /// The name of the function.
    pub const fn name(self) -> &'static str {
        match self {
            FloatOp::Add => "float_add",
            FloatOp::Sub => "float_sub",
            FloatOp::Mul => "float_mul",
            FloatOp::Div => "float_div",
        }
    }
}

/// What the scan driver knows.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum SysValue {
    /// `Bit`: in RUN (M8000).
    Running,
    /// `Bit`: first scan since RUN began (M8002).
    FirstScan,
    /// `I32`: milliseconds since power-on, wrapping, constant in a scan.
    NowMs,
    /// `I32`: duration of the last scan in units of 0.1 ms (D8010).
    Scan100us,
}

/// An expression.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Expr {
    /// `Bit` constant.
    Bit(bool),
    /// `I16` constant.
    I16(i16),
    /// `I32` constant.
    I32(i32),
    /// `F32` constant.
    F32(f32),
    /// A temporary's value.
    Temp(TempId),
    /// State of a bit device; for T and C the contact.
    ReadBit(Place),
    /// Bit 0–15 of a word device.
    ReadWordBit(Place, u8),
    /// `I16`: word device; for T and C0–C199 the current value.
    ReadWord(Place),
    /// `I32`: the pair (n+1, n); for C200 and up the current value; for Z on models where `z_pairs_with_v` the pair (Vn, Zn).
    ReadPair(Place),
    /// `F32`: the pair's bits as a float.
    ReadFloat(Place),
    /// `4 * digits` bits from a bit device as an integer, zero-extended: `I16` if `digits` ≤ 4 and not `wide`, else `I32`.
    ReadNibbles {
        /// First bit.
        place: Place,
        /// 1 to 8.
        digits: u8,
        /// As `I32`.
        wide: bool,
    },
    /// A value of the scan driver.
    Sys(SysValue),
    /// State of a flag.
    Flag(FlagId),
    /// `I32`: value of a cell.
    Cell(CellId),
    /// `I32`: entry of a table. The index, an `I32`, must be known to be at least 0 and less than the table's length.
    Entry(TableId, ExprId),
    /// `I32`: the number of an iteration of the enclosing [`Stmt::Repeat`], times this factor (at least 1). Occurs only as an index.
    Stride(TempId, u32),
    /// Not, of a `Bit`.
    Not(ExprId),
    /// And, of two `Bit`s; both are evaluated (they have no effects).
    And(ExprId, ExprId),
    /// Or, of two `Bit`s.
    Or(ExprId, ExprId),
    /// Comparison of two `I16`, two `I32` or two `F32`; `Bit`.
    Cmp(CmpOp, ExprId, ExprId),
    /// Integer operator.
    Bin(BinOp, ExprId, ExprId),
    /// Function of one value.
    Un(UnOp, ExprId),
    /// Float operator, of two finite `F32`s.
    Float(FloatOp, ExprId, ExprId),
    /// Bitwise complement of an integer.
    Complement(ExprId),
    /// Two's complement negation of an integer; MIN stays MIN.
    Neg(ExprId),
    /// `I16` to `I32`, sign-extended.
    Widen(ExprId),
    /// `I32` to `I16`, low word.
    Narrow(ExprId),
    /// `I32` to `I16`, high word.
    HighWord(ExprId),
    /// `Bit` to `I16`: 0 or 1.
    BitToInt(ExprId),
    /// `I32`: a value that is known to lie between these ends where it is evaluated: how far an index leads ([`crate::ranges`]).
    Within {
        /// The value, an `I32`.
        value: ExprId,
        /// The least it is.
        low: i32,
        /// The most it is.
        high: i32,
    },
    /// `Bit`: whether `count` devices from `place` on all exist on the model, in one run of it ([`Model::in_range`]).
    InRange {
        /// First device.
        place: Place,
        /// How many.
        count: u32,
    },
}

/// Operand of a call of the runtime.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Arg {
    /// Constant, with an index to add (wrapping at 16 bits unless `wide`).
    Const {
        /// The constant.
        value: i32,
        /// What to add.
        index: Option<ExprId>,
        /// Wraps at 32 bits.
        wide: bool,
    },
    /// Float constant.
    Float(f32),
    /// Device; the runtime checks its range. `extent` devices from it on may be accessed (for the layout): `None` = to the
    /// end of its class.
    Device {
        /// Device.
        place: Place,
        /// How many (in devices of its class).
        extent: Option<u32>,
    },
    /// Group of bits.
    Nibbles {
        /// First bit.
        place: Place,
        /// Digits.
        digits: u8,
        /// How many bits may be accessed.
        extent: Option<u32>,
    },
    /// Bit of a word.
    WordBit {
        /// Word.
        place: Place,
        /// Bit 0 to 15.
        bit: u8,
        /// How many bits may be accessed; they continue in the next words.
        extent: Option<u32>,
    },
    /// Text number in [`Module::texts`].
    Text(u32),
    /// A word of the buffer memory of a module, or the first of several.
    Buffer {
        /// Number of the module.
        module: u8,
        /// Address.
        address: u32,
        /// What to add to the address (`I32`).
        index: Option<ExprId>,
    },
}

/// A statement.
#[derive(Clone, PartialEq, Debug)]
pub enum Stmt {
    /// Here begins the code of a network (rung); no effect.
    Network(u32),
    /// Gives a temporary its value.
    Let(TempId, ExprId),
    /// Sets `out` to whether `input` changed as `kind` says since this statement was last executed, and stores `input` in the memory.
    Edge {
        /// Memory.
        edge: EdgeId,
        /// The distance in memories to this one's: an [`Expr::Stride`], in the body of a [`Stmt::Repeat`].
        index: Option<ExprId>,
        /// Which change.
        kind: EdgeKind,
        /// What is watched.
        input: ExprId,
        /// Receives the result.
        out: TempId,
    },
    /// Writes a flag (`Bit`).
    SetFlag(FlagId, ExprId),
    /// Writes a cell (`I32`).
    SetCell(CellId, ExprId),
    /// Writes the entry of a table at the index (`I32`, as for [`Expr::Entry`]) (`I32`).
    SetEntry(TableId, ExprId, ExprId),
    /// Writes a bit device (Y, M, S, or X by force and at its own edge).
    WriteBit(Place, ExprId),
    /// Writes bit 0–15 of a word device.
    WriteWordBit(Place, u8, ExprId),
    /// Writes a word (`I16`).
    WriteWord(Place, ExprId),
    /// Writes a pair or a 32-bit counter (`I32`).
    WritePair(Place, ExprId),
    /// Writes a float pair.
    WriteFloat(Place, ExprId),
    /// Writes the low `4 * digits` bits of an integer to bit devices.
    WriteNibbles {
        /// First bit.
        place: Place,
        /// 1 to 8.
        digits: u8,
        /// `I16` or `I32`.
        value: ExprId,
    },
    /// OUT T: [`rungc_rt::Timer::run`].
    Timer {
        /// Number.
        number: u32,
        /// Behaviour.
        kind: TimerKind,
        /// `Bit`.
        drive: ExprId,
        /// `I16`.
        preset: ExprId,
    },
    /// OUT T with an index: as [`Stmt::Timer`] of the timer that the place names, of the kind that the model has it
    /// ([`rungc_models::Model::timer`]), and shared, since it may be any; not shared in the iterations of a [`Stmt::Repeat`].
    TimerAt {
        /// The timer, which has an index.
        place: Place,
        /// `Bit`.
        drive: ExprId,
        /// `I16`.
        preset: ExprId,
    },
    /// END processing of a timer that continues in scans that jump over its coil: [`rungc_rt::Timer::go_on`].
    TimerGoesOn {
        /// Number.
        number: u32,
        /// Behaviour.
        kind: TimerKind,
    },
    /// OUT C0–C199: [`rungc_rt::Counter16::run`].
    Counter16 {
        /// Number.
        number: u32,
        /// `Bit`.
        drive: ExprId,
        /// `I16`.
        preset: ExprId,
    },
    /// OUT C0–C199 with an index: as [`Stmt::Counter16`] of the counter that the place names.
    Counter16At {
        /// The counter, which has an index.
        place: Place,
        /// `Bit`.
        drive: ExprId,
        /// `I16`.
        preset: ExprId,
    },
    /// OUT C200–C234: [`rungc_rt::Counter32::run`].
    Counter32 {
        /// Number.
        number: u32,
        /// `Bit`.
        drive: ExprId,
        /// `Bit`: counts down.
        down: ExprId,
        /// `I32`.
        preset: ExprId,
    },
    /// A count of a high-speed counter: [`rungc_rt::Counter32::count`].
    Count {
        /// Number.
        number: u32,
        /// `Bit`: counts down.
        down: ExprId,
        /// `I32`.
        preset: ExprId,
    },
    /// RST of a timer or counter: value 0, contact off; a counter's and timer's coil memory stays as it is.
    Reset(Place),
    /// Executes one branch.
    If {
        /// `Bit`.
        cond: ExprId,
        /// If on.
        then: Body,
        /// If off.
        otherwise: Body,
    },
    /// Executes the body `count` times (`I16`; at most 0 means once), the count being evaluated once.
    For {
        /// How often.
        count: ExprId,
        /// What.
        body: Body,
    },
    /// Executes the body `count` times, for rungs that the program repeats with other devices. `iteration` (`I32`) is 0, 1, 2 …, and leads to the
    /// devices of each iteration ([`Expr::Stride`]), all of which lie in a [`crate::layout::Grid`] of as many columns as they are
    /// apart. The timers of a [`Stmt::TimerAt`] are of one kind. The body has neither loops nor jumps.
    Repeat {
        /// How often, at least 2.
        count: u32,
        /// Number of the iteration.
        iteration: TempId,
        /// What.
        body: Body,
        /// Steps of the first and the last of its networks in the program, for a comment.
        steps: (u32, u32),
    },
    /// Calls [`Module::functions`]`[n]`.
    CallSub(u32),
    /// Leaves the function (SRET reached by a jump, CJ to P63 in a subroutine, …).
    Return,
    /// Runs `parts` from part 0 on: at the end of a part the next one follows; [`Stmt::Goto`] inside a part (however deep in
    /// `If` and `For`, not across calls) continues with the part that has that label. Made only where jumps do not nest.
    Parts(Vec<Part>),
    /// Ends the current part and continues with the part of this label, in the innermost enclosing [`Stmt::Parts`] that has it.
    Goto(LabelId),
    /// Calls the runtime. A fault is reported with `step` ([`rungc_rt::report`]).
    Call {
        /// Function.
        function: RtFn,
        /// 32-bit form.
        wide: bool,
        /// Operands.
        args: Vec<Arg>,
        /// Drive contact, for functions that are called always; others stand inside an `If`.
        drive: Option<ExprId>,
        /// It is not a scan that calls it but an input at which it looks ([`rungc_rt::Site::signal`]), in [`FunctionKind::Signals`].
        signal: bool,
        /// Private memory, for functions that need one; from 1.
        slot: u16,
        /// Step number.
        step: u32,
    },
    /// Reads an operand that only the runtime can: buffer memory ([`rungc_rt::fetch`]). A fault is reported with `step`.
    Fetch {
        /// What is read.
        from: Arg,
        /// 32 bits of it.
        wide: bool,
        /// Receives the value, sign-extended; stays as it is after a fault.
        value: CellId,
        /// Receives whether there was no fault.
        there: TempId,
        /// Step number.
        step: u32,
    },
    /// Writes an operand that only the runtime can ([`rungc_rt::send`]). A fault is reported with `step`.
    Send {
        /// What is written.
        to: Arg,
        /// 32 bits of it.
        wide: bool,
        /// `I32` if `wide`, else `I16`.
        value: ExprId,
        /// Step number.
        step: u32,
    },
    /// Reports an operation error found inline.
    Fault {
        /// PLC's code.
        code: u16,
        /// Step number.
        step: u32,
    },
    /// Takes this many steps of those that the scan may still execute ([`Module::scan_steps`]). If fewer are left, the PLC stops as by
    /// its watchdog ([`rungc_rt::trip_watchdog`]), none are left, and the function ends as by [`Stmt::Return`].
    Watch {
        /// How many PLC steps of the program come now: an iteration of a loop, or what a jump back repeats, with the subroutines that are called
        /// and the short loops in it.
        steps: u32,
        /// Step of the loop or the jump.
        at: u32,
    },
    /// Puts the PLC in STOP when this scan has ended, as the RUN/STOP switch would (M8037). Stands in the function `End` only.
    Stop,
    /// Clears devices, the general ones (false) or the latched ones (true), but no inputs and no special devices: M8031, M8032.
    Clear {
        /// Which.
        latched: bool,
    },
}

/// How many steps a scan may repeat for each millisecond of the watchdog time D8000: more than the fastest PLC executes.
pub const STEPS_PER_MS: u32 = 10_000;

/// The watchdog time of a model without D8000.
const WATCHDOG_MS: i16 = 200;

/// Label of a part, unique in its function.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
pub struct LabelId(pub u32);

/// A part of a body that jumps do not nest in.
#[derive(Clone, PartialEq, Debug)]
pub struct Part {
    /// Its label; `None` if only fallen into.
    pub label: Option<LabelId>,
    /// The PLC's label, for a comment: `P12`.
    pub name: Option<String>,
    /// What it does.
    pub body: Body,
}

/// A sequence of statements.
pub type Body = Vec<Stmt>;

/// A network: a run of rungs that a comment in the emitted code introduces.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Network {
    /// Step number of its first instruction.
    pub step: u32,
    /// Its place in the source.
    pub span: Span,
    /// Line statement above it.
    pub statement: Option<String>,
    /// Note beside its coil.
    pub note: Option<String>,
}

/// What a function is called by.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum FunctionKind {
    /// The main program.
    Main,
    /// Before each scan's main program: special relays and registers. Runs in STOP too, where nothing else does.
    Begin,
    /// After it, before the output refresh: END processing.
    End,
    /// A subroutine, by its pointer number.
    Subroutine(u32),
    /// An interrupt routine, by its pointer number.
    Interrupt(u32),
    /// Runs the interrupt routines that are requested. `Main` calls it at the start of each network, and after code that sets or resets
    /// a relay that requests or forbids one where relays keep requests (HM); `End` calls it first, and a host may between two scans
    /// ([`rungc_rt::Program::take_interrupts`]): nowhere else is the program interrupted, and no interrupt routine is itself. What is
    /// requested between two of these moments counts as requested together: then [`rungc_models::interrupts::Interrupts::precedence`] tells which comes
    /// first.
    TakeInterrupts,
    /// Runs when an input terminal changes ([`rungc_rt::Program::input_edge`]), between two scans.
    InputEdge {
        /// Terminal X, a plain number.
        input: u32,
        /// Which change.
        kind: EdgeKind,
    },
    /// Calls the instructions that send pulses and look at inputs ([`rungc_rt::Needs::signals`]) once more, with the drive that they had
    /// last. The edges of these inputs call it, when the device X shows them, and so do interrupts that may give the signal.
    Signals,
}

/// A function: no parameters, no result, no recursion.
#[derive(Clone, PartialEq, Debug)]
pub struct Function {
    /// What it is.
    pub kind: FunctionKind,
    /// What it does.
    pub body: Body,
}

/// A compiled program.
#[derive(Clone, Debug)]
pub struct Module {
    /// Name for files and types, an identifier in lower case: `motor`.
    pub name: String,
    /// Name of the source for the header comment: `MAIN.csv`.
    pub source_name: String,
    /// Steps of the program.
    pub steps: u32,
    /// The model.
    pub model: &'static Model,
    /// The devices of the model, with those latched that the project's parameters choose: [`Model::ranges`] if they say nothing.
    pub ranges: Cow<'static, [Range]>,
    /// Expressions; an expression's operands have lower handles.
    pub exprs: Vec<Expr>,
    /// Types of the temporaries.
    pub temps: Vec<Ty>,
    /// How many edge memories there are.
    pub edges: u32,
    /// How many private memories there are; slots 1..=states are used.
    pub states: u16,
    /// Slots 1..=run_states are those of the program's instructions, which RUN begins anew; the others last until power-off.
    pub run_states: u16,
    /// Texts.
    pub texts: Vec<String>,
    /// Private bits.
    pub flags: Vec<Flag>,
    /// Private numbers.
    pub cells: Vec<Cell>,
    /// Private rows of numbers.
    pub tables: Vec<Table>,
    /// Functions: `Begin`, `Main`, `End` first, in this order, then subroutines and interrupt routines, `TakeInterrupts` if there
    /// are any of these, `Signals` if there are any, and one for each edge that means something.
    pub functions: Vec<Function>,
    /// Outputs Y at which instructions send pulses, in order, each once. Their [`rungc_rt::Axis`] is idle at power-on. Pulses are counted
    /// ([`rungc_rt::advance_pulses`]) at the start of each scan before `Begin`, and each time that a host reports the time
    /// ([`rungc_rt::Program::tick`]).
    pub pulse_outputs: Vec<u32>,
    /// Serial ports, in order: those that instructions use, that the program sets up, and that a host opens. They are brought up to date
    /// ([`rungc_rt::advance_ports`]) when a scan begins, before `Begin`, when it ends, and each time that a host reports the time.
    pub ports: Vec<u8>,
    /// Networks that [`Stmt::Network`] names.
    pub networks: Vec<Network>,
    /// Comments on devices.
    pub comments: Vec<(DeviceClass, u32, String)>,
    /// Stored devices.
    pub layout: Layout,
    /// Special registers' values at power-on, of those stored.
    pub initial_words: Vec<(u32, i16)>,
    /// Special relays that are on at power-on, of those stored.
    pub initial_bits: Vec<u32>,
}

impl Module {
    /// A program of no instructions, whose three functions do nothing. `name` is an identifier in lower case.
    pub fn empty(name: String, source_name: String, model: &'static Model) -> Self {
        let function = |kind| Function {
            kind,
            body: Body::new(),
        };
        Module {
            name,
            source_name,
            steps: 0,
            model,
            ranges: Cow::Borrowed(model.ranges),
            exprs: Vec::new(),
            temps: Vec::new(),
            edges: 0,
            states: 0,
            run_states: 0,
            texts: Vec::new(),
            flags: Vec::new(),
            cells: Vec::new(),
            tables: Vec::new(),
            pulse_outputs: Vec::new(),
            ports: Vec::new(),
            functions: [FunctionKind::Begin, FunctionKind::Main, FunctionKind::End]
                .map(function)
                .into(),
            networks: Vec::new(),
            comments: Vec::new(),
            layout: Layout::default(),
            initial_words: Vec::new(),
            initial_bits: Vec::new(),
        }
    }

    /// The ranges of a class, in order.
    pub fn ranges_of(&self, class: DeviceClass) -> impl Iterator<Item = &Range> {
        self.ranges.iter().filter(move |r| r.class == class)
    }

    /// The expression of a handle.
    pub fn expr(&self, id: ExprId) -> &Expr {
        &self.exprs[id.0 as usize]
    }

    /// Whether a host has to report input edges and time.
    pub fn takes_events(&self) -> bool {
        let by_host = |f: &Function| {
            matches!(
                f.kind,
                FunctionKind::InputEdge { .. } | FunctionKind::TakeInterrupts
            )
        };
        self.sends_pulses() || self.has_ports() || self.functions.iter().any(by_host)
    }

    /// Whether it has pulse outputs.
    pub fn sends_pulses(&self) -> bool {
        !self.pulse_outputs.is_empty()
    }

    /// Whether it has serial ports.
    pub fn has_ports(&self) -> bool {
        !self.ports.is_empty()
    }

    /// The flags with a period, and their periods in milliseconds.
    pub fn periods(&self) -> impl Iterator<Item = (&Flag, u32)> {
        let flags = self.flags.iter();
        flags.filter_map(|flag| flag.period_ms.map(|ms| (flag, ms)))
    }

    /// Whether a host has to report the time between scans.
    pub fn takes_time(&self) -> bool {
        let taken = |f: &Function| f.kind == FunctionKind::TakeInterrupts;
        self.sends_pulses()
            || self.has_ports()
            || self.cells.iter().any(|cell| cell.follows_time)
            || self.functions.iter().any(taken)
    }

    /// The steps that a scan may repeat in loops and by jumps back, with this watchdog time (D8000, at least 1): each [`Stmt::Watch`] takes
    /// its share. They are given anew when a scan begins, and last until the next one does.
    pub fn scan_steps(watchdog_ms: i16) -> u32 {
        watchdog_ms.max(1).unsigned_abs() as u32 * STEPS_PER_MS
    }

    /// The watchdog time D8000 at power-on, in milliseconds: that of a program that does not look at D8000.
    pub fn watchdog_ms(&self) -> i16 {
        let mut words = self.model.special_words();
        let found = words.find(|&(number, _)| number == D_WATCHDOG_MS.number());
        found.map_or(WATCHDOG_MS, |(_, ms)| ms)
    }

    /// Whether the watchdog may cut a scan short.
    pub fn has_watchdog(&self) -> bool {
        self.any_statement(|stmt| matches!(stmt, Stmt::Watch { .. }))
    }

    /// Whether an instruction may fault, or something in the program stops the PLC: then a host can ask what it was
    /// ([`rungc_rt::LastError`]).
    pub fn may_fail(&self) -> bool {
        self.any_statement(|stmt| {
            calls_runtime(stmt)
                || matches!(stmt, Stmt::Watch { .. } | Stmt::Fault { .. } | Stmt::Stop)
        })
    }

    fn any_statement(&self, is_it: impl Fn(&Stmt) -> bool) -> bool {
        let mut found = false;
        for function in &self.functions {
            statements(&function.body, &mut |stmt| found |= is_it(stmt));
        }
        found
    }

    /// Adds an expression.
    pub fn add(&mut self, expr: Expr) -> ExprId {
        self.exprs.push(expr);
        ExprId(self.exprs.len() as u32 - 1)
    }

    /// Type of an expression.
    pub fn ty(&self, id: ExprId) -> Ty {
        type_of(&self.exprs, &self.temps, id)
    }
}

/// Type of an expression of an arena.
pub fn type_of(exprs: &[Expr], temps: &[Ty], id: ExprId) -> Ty {
    match exprs[id.0 as usize] {
        Expr::Bit(_)
        | Expr::ReadBit(_)
        | Expr::ReadWordBit(..)
        | Expr::Not(_)
        | Expr::And(..)
        | Expr::Or(..)
        | Expr::Cmp(..)
        | Expr::Flag(_)
        | Expr::InRange { .. } => Ty::Bit,
        Expr::I16(_)
        | Expr::ReadWord(_)
        | Expr::Narrow(_)
        | Expr::HighWord(_)
        | Expr::BitToInt(_) => Ty::I16,
        Expr::I32(_)
        | Expr::ReadPair(_)
        | Expr::Widen(_)
        | Expr::Cell(_)
        | Expr::Stride(..)
        | Expr::Within { .. }
        | Expr::Entry(..) => Ty::I32,
        Expr::F32(_)
        | Expr::ReadFloat(_)
        | Expr::Float(..)
        | Expr::Un(UnOp::ToFloat | UnOp::Negate, _) => Ty::F32,
        Expr::Un(UnOp::IsBcd | UnOp::IsFinite, _) => Ty::Bit,
        Expr::Un(UnOp::Root | UnOp::Truncate, _) => Ty::I32,
        Expr::Un(UnOp::SwapBytes | UnOp::CountOnes | UnOp::ToBcd | UnOp::FromBcd, a) => {
            type_of(exprs, temps, a)
        }
        Expr::Temp(temp) => temps[temp.0 as usize],
        Expr::ReadNibbles { wide, .. } => {
            if wide {
                Ty::I32
            } else {
                Ty::I16
            }
        }
        Expr::Sys(SysValue::Running | SysValue::FirstScan) => Ty::Bit,
        Expr::Sys(SysValue::NowMs | SysValue::Scan100us) => Ty::I32,
        Expr::Bin(_, a, _) | Expr::Complement(a) | Expr::Neg(a) => type_of(exprs, temps, a),
    }
}

#[cfg(test)]
mod tests {
    use super::BinOp;

    #[test]
    fn results_of_16_bits_wrap_at_16_bits() {
        let of = |op: BinOp, a, b| op.of_i16(a, b);
        assert_eq!(of(BinOp::Add, i16::MAX, 1), Some(i16::MIN));
        assert_eq!(of(BinOp::Mul, i16::MIN, i16::MIN), Some(0));
        assert_eq!(of(BinOp::Div, i16::MIN, -1), Some(i16::MIN));
        assert_eq!(of(BinOp::Rem, i16::MIN, -1), Some(0));
        assert_eq!(of(BinOp::Xor, -1, i16::MAX), Some(i16::MIN));
        assert_eq!(of(BinOp::SatAdd, i16::MAX, 1), Some(i16::MAX));
        assert_eq!(of(BinOp::SatSub, i16::MIN, 1), Some(i16::MIN));
    }

    #[test]
    fn nothing_is_divided_by_0() {
        for op in [BinOp::Div, BinOp::Rem] {
            assert_eq!(op.of_i16(5, 0), None);
            assert_eq!(op.of_i32(5, 0), None);
        }
        assert_eq!(BinOp::Div.of_i32(i32::MIN, -1), Some(i32::MIN));
    }
}
