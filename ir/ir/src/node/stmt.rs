//! Statements: what a program does, in order.

use super::{Access, CellId, EdgeId, ExprId, FlagId, LabelId, Place, TableId, TempId};
use rungc_rt::{EdgeKind, RtFn, TimerKind};

/// Operand of a call of the runtime.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Arg {
    /// Constant, with an index to add (wrapping at 16 bits unless `wide`).
    Const {
        /// The constant.
        value: i32,
        /// Index to add.
        index: Option<ExprId>,
        /// Wraps at 32 bits.
        wide: bool,
    },
    /// Float constant.
    Float(f32),
    /// Device; the runtime checks its range. `extent` devices from it on may be accessed (for the layout): `None` = to
    /// the end of its class.
    Device {
        /// Device.
        place: Place,
        /// Number of devices of its class.
        extent: Option<u32>,
    },
    /// Group of bits.
    Nibbles {
        /// First bit.
        place: Place,
        /// Digits.
        digits: u8,
        /// Number of bits that may be accessed.
        extent: Option<u32>,
    },
    /// Bit of a word.
    WordBit {
        /// Word.
        place: Place,
        /// Bit 0 to 15.
        bit: u8,
        /// Number of bits that may be accessed; they continue in the next words.
        extent: Option<u32>,
    },
    /// Text number in [`Module::texts`](super::Module::texts).
    Text(u32),
    /// A word of the buffer memory of a module, or the first of several.
    Buffer {
        /// Number of the module.
        module: u8,
        /// Address.
        address: u32,
        /// Index to add to the address (`I32`).
        index: Option<ExprId>,
    },
}

/// A call of the runtime.
#[derive(Clone, PartialEq, Debug)]
pub struct Call {
    /// Function.
    pub function: RtFn,
    /// 32-bit form.
    pub wide: bool,
    /// Operands.
    pub args: Vec<Arg>,
    /// Drive contact, for functions that are called always; others are inside an `If`.
    pub drive: Option<ExprId>,
    /// It is not a scan that calls it but an input at which it looks ([`rungc_rt::Site::signal`]), in
    /// [`FunctionKind::Signals`](super::FunctionKind::Signals).
    pub signal: bool,
    /// Period of the timer interrupt in whose routine it is ([`rungc_rt::Site::period_ms`]); 0 elsewhere, and for
    /// functions that do not look at it.
    pub period_ms: u16,
    /// Private memory, for functions that need one; from 1.
    pub slot: u16,
    /// Step number.
    pub step: u32,
}

/// Sets `out` to whether `input` changed as `kind` says since this statement was last executed, and stores `input` in
/// the memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Edge {
    /// Memory.
    pub memory: EdgeId,
    /// The distance in memories to this one's: an [`Expr::Stride`](super::Expr::Stride), in the body of a
    /// [`Stmt::Repeat`].
    pub index: Option<ExprId>,
    /// Kind of edge.
    pub kind: EdgeKind,
    /// Watched bit.
    pub input: ExprId,
    /// Receives the result.
    pub out: TempId,
}

/// The coil of a timer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TimerCoil {
    /// Number.
    pub number: u32,
    /// Behaviour.
    pub kind: TimerKind,
    /// `Bit`.
    pub drive: ExprId,
    /// `I16`.
    pub preset: ExprId,
}

/// The coil of a counter C0–C199.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Counter16Coil {
    /// Number.
    pub number: u32,
    /// `Bit`.
    pub drive: ExprId,
    /// `I16`.
    pub preset: ExprId,
}

/// The coil of a timer or counter that an index leads to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct IndexedCoil {
    /// The timer or counter, which has an index.
    pub place: Place,
    /// `Bit`.
    pub drive: ExprId,
    /// `I16`.
    pub preset: ExprId,
}

/// The coil of a counter C200–C234.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Counter32Coil {
    /// Number.
    pub number: u32,
    /// `Bit`.
    pub drive: ExprId,
    /// `Bit`: counts down.
    pub down: ExprId,
    /// `I32`.
    pub preset: ExprId,
}

/// A count of a high-speed counter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Count {
    /// Number.
    pub number: u32,
    /// `Bit`: counts down.
    pub down: ExprId,
    /// `I32`.
    pub preset: ExprId,
}

/// Executes the body `count` times, for rungs that the program repeats with other devices. `iteration` (`I32`) is 0, 1,
/// 2 …, and leads to the devices of each iteration ([`Expr::Stride`](super::Expr::Stride)), all of which lie in a
/// [`crate::layout::Grid`] of as many columns as they are apart. The timers of a [`Stmt::TimerAt`] are of one kind. The
/// body has neither loops nor jumps.
#[derive(Clone, PartialEq, Debug)]
pub struct Repeat {
    /// Number of iterations, at least 2.
    pub count: u32,
    /// Number of the iteration.
    pub iteration: TempId,
    /// Repeated statements.
    pub body: Body,
    /// Steps of the first and the last of its networks in the program, for a comment.
    pub steps: (u32, u32),
}

/// A read of buffer memory.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Fetch {
    /// Operand to read.
    pub from: Arg,
    /// 32 bits of it.
    pub wide: bool,
    /// Receives the value, sign-extended; stays as it is after a fault.
    pub value: CellId,
    /// Receives whether there was no fault.
    pub there: TempId,
    /// Step number.
    pub step: u32,
}

/// A write of buffer memory.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Send {
    /// Operand to write.
    pub to: Arg,
    /// 32 bits of it.
    pub wide: bool,
    /// `I32` if `wide`, else `I16`.
    pub value: ExprId,
    /// Step number.
    pub step: u32,
}

/// A copy or a fill of a run of devices: bits X, Y, M and S, or words D and R. All devices of a run exist, in one run
/// of the model ([`Expr::InRange`](super::Expr::InRange)). Those of a place without an index are not special. Indexes,
/// the length and the value are evaluated before anything is written.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Block {
    /// Copies devices to others of the same kind, as if all were read before one is written.
    Copy {
        /// First of those that are read.
        from: Place,
        /// First of those that are written.
        to: Place,
        /// Number of devices, at least 1; the most that there are, if there is a `length`.
        count: u32,
        /// Number of devices (`I32`), from 1 to `count`, if only known at run time.
        length: Option<ExprId>,
    },
    /// Writes one value to all.
    Fill {
        /// First of them.
        to: Place,
        /// As for a copy.
        count: u32,
        /// As for a copy.
        length: Option<ExprId>,
        /// `Bit` or `I16`.
        value: ExprId,
    },
}

impl Block {
    /// The first device that is written, and how many are at most.
    pub fn written(&self) -> (Place, u32) {
        let (Block::Copy { to, count, .. } | Block::Fill { to, count, .. }) = *self;
        (to, count)
    }

    /// The number of devices, if only known at run time.
    pub fn length(&self) -> Option<ExprId> {
        let (Block::Copy { length, .. } | Block::Fill { length, .. }) = *self;
        length
    }

    /// The first device that is read, if devices are copied.
    pub fn source(&self) -> Option<Place> {
        match *self {
            Block::Copy { from, .. } => Some(from),
            Block::Fill { .. } => None,
        }
    }
}

/// A value for the entry of a table.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct SetEntry {
    /// Table.
    pub table: TableId,
    /// Index of the entry (`I32`, as for [`Expr::Entry`](super::Expr::Entry)).
    pub index: ExprId,
    /// New value (`I32`).
    pub value: ExprId,
}

/// Two bodies, one of which is executed.
#[derive(Clone, PartialEq, Debug)]
pub struct Branch {
    /// Condition (`Bit`).
    pub cond: ExprId,
    /// If on.
    pub then: Body,
    /// If off.
    pub otherwise: Body,
}

/// A statement that is executed as a whole: control continues with the next one. What has three fields or more is a
/// separate struct.
#[derive(Clone, PartialEq, Debug)]
pub enum Action {
    /// Gives a temporary its value.
    Let(TempId, ExprId),
    /// Finds a change of a bit.
    Edge(Edge),
    /// Writes a flag (`Bit`).
    SetFlag(FlagId, ExprId),
    /// Writes a cell (`I32`).
    SetCell(CellId, ExprId),
    /// Writes the entry of a table.
    SetEntry(SetEntry),
    /// Writes a value of the access's type.
    Write(Access, ExprId),
    /// Copies or fills a run of devices.
    Block(Block),
    /// OUT T: [`rungc_rt::Timer::run`].
    Timer(TimerCoil),
    /// OUT T with an index: as [`Action::Timer`] of the timer that the place names, of the kind that the model has it
    /// ([`rungc_models::Model::timer`]), and shared, since it may be any; not shared in the iterations of a
    /// [`Stmt::Repeat`].
    TimerAt(IndexedCoil),
    /// END processing of a timer that continues in scans that jump over its coil: [`rungc_rt::Timer::go_on`].
    TimerGoesOn {
        /// Number.
        number: u32,
        /// Behaviour.
        kind: TimerKind,
    },
    /// OUT C0–C199: [`rungc_rt::Counter16::run`].
    Counter16(Counter16Coil),
    /// OUT C0–C199 with an index: as [`Action::Counter16`] of the counter that the place names.
    Counter16At(IndexedCoil),
    /// OUT C200–C234: [`rungc_rt::Counter32::run`].
    Counter32(Counter32Coil),
    /// A count of a high-speed counter: [`rungc_rt::Counter32::count`].
    Count(Count),
    /// RST of a timer or counter: value 0, contact off.
    Reset {
        /// The timer or counter.
        place: Place,
        /// Of a counter: its coil counts as on, so the next execution of the coil does not count. Else the memory of
        /// the coil stays as it is.
        holds: bool,
    },
    /// Calls the runtime. A fault is reported with its step ([`rungc_rt::report`]).
    Call(Call),
    /// Reads an operand that only the runtime can: buffer memory ([`rungc_rt::fetch`]). A fault is reported with its
    /// step.
    Fetch(Fetch),
    /// Writes an operand that only the runtime can ([`rungc_rt::send`]). A fault is reported with its step.
    Send(Send),
    /// Reports an operation error found inline.
    Fault {
        /// PLC's code.
        code: u16,
        /// Step number.
        step: u32,
    },
    /// WDT: gives the scan all its steps anew ([`Module::scan_steps`](super::Module::scan_steps)), by the watchdog time
    /// as it is now. Stands only in modules with a [`Stmt::Watch`].
    RestartWatchdog,
    /// Puts the PLC in STOP when this scan has ended, as the RUN/STOP switch would (M8037). Stands in the function
    /// `End` only.
    Stop,
    /// Clears devices, the general ones (false) or the latched ones (true), but no inputs and no special devices:
    /// M8031, M8032.
    Clear {
        /// True for the latched devices, false for the others.
        latched: bool,
    },
}

/// Blocks of a step ladder. Executing the body has no effect while all these states and memories are off, so an engine
/// leaves it out then: a scan costs what is active, not what the program has.
#[derive(Clone, PartialEq, Debug)]
pub struct Steps {
    /// Number of the first state S.
    pub first: u32,
    /// Number of states from it on, at least 1; they follow each other in the model.
    pub states: u32,
    /// First of the memories of their blocks: whether a state is being left, and whether its block was on.
    pub memory: EdgeId,
    /// Number of these memories, at least 1.
    pub memories: u32,
    /// The blocks.
    pub body: Body,
}

/// A statement: an action, or what decides which statements are executed.
#[derive(Clone, PartialEq, Debug)]
pub enum Stmt {
    /// Here begins the code of a network (rung); no effect.
    Network(u32),
    /// Executes an action.
    Do(Action),
    /// Executes one branch.
    If(Branch),
    /// Executes the body `count` times (`I16`; at most 0 means once), the count being evaluated once.
    For {
        /// Number of iterations.
        count: ExprId,
        /// Repeated statements.
        body: Body,
    },
    /// Executes a body for each of several equal sets of devices.
    Repeat(Repeat),
    /// Executes blocks of a step ladder.
    Steps(Steps),
    /// Calls [`Module::functions`](super::Module::functions)`[n]`.
    CallSub(u32),
    /// Leaves the function (SRET reached by a jump, CJ to P63 in a subroutine, …).
    Return,
    /// Runs `parts` from part 0 on: at the end of a part the next one follows; [`Stmt::Goto`] inside a part (however
    /// deep in `If` and `For`, not across calls) continues with the part that has that label. Made only where jumps do
    /// not nest.
    Parts(Vec<Part>),
    /// Ends the current part and continues with the part of this label, in the innermost enclosing [`Stmt::Parts`] that
    /// has it.
    Goto(LabelId),
    /// Takes this many steps of those that the scan may still execute
    /// ([`Module::scan_steps`](super::Module::scan_steps)). If fewer are left, the PLC stops as by its watchdog
    /// ([`rungc_rt::trip_watchdog`]), none are left, and the function ends as by [`Stmt::Return`].
    Watch {
        /// Number of PLC steps that follow: an iteration of a loop, or the code that a jump back repeats, with the
        /// subroutines that are called and the short loops in it.
        steps: u32,
        /// Step of the loop or the jump.
        at: u32,
    },
}

impl From<Action> for Stmt {
    fn from(action: Action) -> Self {
        Stmt::Do(action)
    }
}

/// A part of a body that jumps do not nest in.
#[derive(Clone, PartialEq, Debug)]
pub struct Part {
    /// Its label; `None` if only fallen into.
    pub label: Option<LabelId>,
    /// The PLC's label, for a comment: `P12`.
    pub name: Option<String>,
    /// Statements of the part.
    pub body: Body,
}

/// A sequence of statements.
pub type Body = Vec<Stmt>;
