//! Expressions: values, without effects.

use super::{
    Access, AccessKind, BinOp, CellId, ExprId, FlagId, FloatOp, Place, TableId, TempId, UnOp,
};
use rungc_rt::CmpOp;
use typed_index_collections::TiSlice;

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

/// Values provided by the scan driver.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum SysValue {
    /// `Bit`: in RUN (M8000).
    Running,
    /// `Bit`: first scan since RUN began (M8002).
    FirstScan,
    /// `I32`: milliseconds since the first scan, wrapping, constant in a scan.
    NowMs,
    /// `I32`: milliseconds since the first scan, from 0 again after a minute, constant in a scan.
    MinuteMs,
    /// `I32`: milliseconds from the start of the previous scan to the start of this one, wrapping; 0 in the first.
    SinceScanMs,
    /// `I32`: duration of the last scan in units of 0.1 ms, at most 32767 (D8010).
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
    /// Value of a device, or of several, of the access's type.
    Read(Access),
    /// A value of the scan driver.
    Sys(SysValue),
    /// State of a flag.
    Flag(FlagId),
    /// `I32`: value of a cell.
    Cell(CellId),
    /// `I32`: entry of a table. The index, an `I32`, must be known to be at least 0 and less than the table's length.
    Entry(TableId, ExprId),
    /// `I32`: the number of an iteration of the enclosing [`Stmt::Repeat`](super::Stmt::Repeat), times this factor (at
    /// least 1). Occurs only as an index.
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
    /// `I32`: a value that is known to lie between these ends where it is evaluated: how far an index leads
    /// ([`crate::ranges`]).
    Within {
        /// The value, an `I32`.
        value: ExprId,
        /// The least it is.
        low: i32,
        /// The most it is.
        high: i32,
    },
    /// `Bit`: whether `count` devices from `place` on all exist on the model, in one run of it
    /// ([`rungc_models::Model::in_range`]).
    InRange {
        /// First device.
        place: Place,
        /// Number of devices; the least that there are, if there is a `length`.
        count: u32,
        /// Number of devices (`I32`), at least `count`, if only known at run time.
        length: Option<ExprId>,
    },
}

impl Expr {
    /// The place of the bit device whose state it is, if it is that and no more.
    pub fn as_bit(&self) -> Option<Place> {
        if let Expr::Read(access) = self
            && access.kind == AccessKind::Bit
        {
            Some(access.place)
        } else {
            None
        }
    }

    /// The value of an integer constant.
    pub(crate) fn as_int(&self) -> Option<i32> {
        if let Expr::I16(value) = *self {
            Some(value.into())
        } else if let Expr::I32(value) = *self {
            Some(value)
        } else {
            None
        }
    }
}

/// Type of an expression of an arena.
pub fn type_of(exprs: &TiSlice<ExprId, Expr>, temps: &TiSlice<TempId, Ty>, id: ExprId) -> Ty {
    match exprs[id] {
        Expr::Bit(_)
        | Expr::Not(_)
        | Expr::And(..)
        | Expr::Or(..)
        | Expr::Cmp(..)
        | Expr::Flag(_)
        | Expr::InRange { .. } => Ty::Bit,
        Expr::I16(_)
        | Expr::Narrow(_)
        | Expr::HighWord(_)
        | Expr::BitToInt(_)
        | Expr::Un(UnOp::Segments, _) => Ty::I16,
        Expr::I32(_)
        | Expr::Widen(_)
        | Expr::Cell(_)
        | Expr::Stride(..)
        | Expr::Within { .. }
        | Expr::Entry(..) => Ty::I32,
        Expr::F32(_)
        | Expr::Float(..)
        | Expr::Un(UnOp::ToFloat | UnOp::Negate | UnOp::SquareRoot, _) => Ty::F32,
        Expr::Un(UnOp::IsBcd | UnOp::IsFinite, _) => Ty::Bit,
        Expr::Un(UnOp::Root | UnOp::HighestBit | UnOp::Truncate, _) => Ty::I32,
        Expr::Un(UnOp::SwapBytes | UnOp::CountOnes | UnOp::ToBcd | UnOp::FromBcd, a) => {
            type_of(exprs, temps, a)
        }
        Expr::Temp(temp) => temps[temp],
        Expr::Read(access) => access.ty(),
        Expr::Sys(SysValue::Running | SysValue::FirstScan) => Ty::Bit,
        Expr::Sys(
            SysValue::NowMs | SysValue::MinuteMs | SysValue::SinceScanMs | SysValue::Scan100us,
        ) => Ty::I32,
        Expr::Bin(_, a, _) | Expr::Complement(a) | Expr::Neg(a) => type_of(exprs, temps, a),
    }
}
