//! Instructions as they are made, with the place of their statement.

use crate::ast::Unit;
use crate::labels::{Instance, Labels, Supply};
use crate::routines::Routine;
use crate::types::Ty;
use rungc_models::Model;
use rungc_syntax::{
    Device, DeviceClass, Diagnostic, Instr, Operand, OperandKind, Remarks, Span, codes, phrase,
};
use smol_str::{SmolStr, ToSmolStr};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

/// Findings about one statement.
pub(crate) type Errors = Vec<Diagnostic>;

/// Result of a step of compilation, or its mistakes.
pub(crate) type Made<T> = Result<T, Errors>;

/// An error alone.
pub(crate) fn fail<T>(error: Diagnostic) -> Made<T> {
    Err(vec![error])
}

/// Both results, or the errors of both.
pub(crate) fn both<A, B>(a: Made<A>, b: Made<B>) -> Made<(A, B)> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok((a, b)),
        (Err(mut a), Err(b)) => {
            a.extend(b);
            Err(a)
        }
        (Err(errors), _) | (_, Err(errors)) => Err(errors),
    }
}

/// Limit of the length of a program, in instructions. No PLC of the family has room for more.
const MOST: usize = 200_000;

/// Words of the largest temporary.
const SLOT: u32 = 4;

/// The state of a compilation.
pub(crate) struct Compiler<'a> {
    pub labels: Rc<Labels>,
    /// All programs, functions and blocks of the text, and those of the library that it uses.
    pub units: &'a [Unit],
    pub model: &'static Model,
    /// Functions of the text, by their names in upper case.
    pub functions: BTreeMap<String, Rc<Instance>>,
    pub supply: Supply,
    pub instrs: Vec<Instr>,
    pub found: Vec<Diagnostic>,
    /// Text of the program.
    pub text: &'a str,
    /// The statement.
    pub span: Span,
    /// Heading for the next rung.
    pub heading: Option<SmolStr>,
    /// True while `LD M8000` holds for what follows.
    pub is_powered: bool,
    /// Targets of EXIT, from the outermost loop on.
    pub loops: Vec<Device>,
    /// Target of RETURN, once it is used.
    pub end: Option<Device>,
    /// Results of the statements.
    pub statements: Vec<crate::Outcome>,
    /// Number of blocks that were expanded.
    pub expansions: usize,
    /// Subroutines that are called, in the order of their first calls.
    pub routines: Vec<Routine>,
    /// The subroutine that is compiled.
    pub routine: Option<usize>,
    /// First use of an index register that variable indexes change.
    pub registers: Cell<Option<Span>>,
    /// First statement with a variable index.
    pub indexes: Option<Span>,
    /// Inputs and outputs whose values in the instance are needed.
    pub own_used: RefCell<Vec<(Rc<Instance>, String, Span)>>,
}

pub(crate) const fn relay(number: u32) -> OperandKind {
    let class = DeviceClass::M;
    OperandKind::Device(Device { class, number }, None)
}

/// On while the PLC runs.
pub(crate) const ON: OperandKind = relay(8000);
/// Off while the PLC runs.
pub(crate) const OFF: OperandKind = relay(8001);

impl Compiler<'_> {
    /// Appends an instruction.
    pub(crate) fn push(
        &mut self,
        mnemonic: impl Into<SmolStr>,
        operands: impl IntoIterator<Item = Operand>,
    ) {
        let mnemonic = mnemonic.into();
        let begins = mnemonic.starts_with("LD");
        let heading = if begins { self.heading.take() } else { None };
        if self.instrs.len() >= MOST {
            return;
        }
        self.instrs.push(Instr {
            mnemonic,
            mnemonic_span: self.span,
            operands: operands.into_iter().collect(),
            span: self.span,
            step: None,
            remarks: Remarks::new(heading, None),
        });
    }

    /// An operand that the statement as a whole stands for.
    pub(crate) fn here(&self, kind: OperandKind) -> Operand {
        Operand {
            span: self.span,
            kind,
        }
    }

    /// Begins a rung that is always on, unless one holds already.
    pub(crate) fn power(&mut self) {
        if !self.is_powered {
            let on = self.here(ON);
            self.push("LD", [on]);
            self.is_powered = true;
        }
    }

    /// Appends an instruction to a rung that is always on.
    pub(crate) fn always(&mut self, mnemonic: &str, operands: impl IntoIterator<Item = Operand>) {
        self.power();
        self.push(mnemonic, operands);
    }

    /// Appends a label.
    pub(crate) fn label(&mut self, pointer: Device) {
        self.push(pointer.to_smolstr(), []);
        self.is_powered = false;
    }

    /// Appends a jump to the rung that was begun.
    pub(crate) fn jump(&mut self, pointer: Device) {
        let pointer = self.here(OperandKind::Device(pointer, None));
        self.push("CJ", [pointer]);
    }

    /// Jumps in any case.
    pub(crate) fn goto(&mut self, pointer: Device) {
        self.power();
        self.jump(pointer);
    }

    pub(crate) fn pointer(&mut self) -> Made<Device> {
        self.supply.pointer().ok_or_else(|| {
            let what = phrase!("no pointer P is left for IF, CASE, loops and subroutines");
            let first = codes::ST_NO_DEVICE.at(self.span, what);
            vec![first.help("the range is that of GX Works2 for this model; join conditions, or split the program")]
        })
    }

    /// A temporary of this many words; 0 is a bit.
    pub(crate) fn temporary(&mut self, words: u32) -> Made<Device> {
        match words {
            0 => self.taken(DeviceClass::M, 1),
            // All begin at the same places, so that none lies within the result of another.
            words if words <= SLOT && self.supply.is_ample() => self.taken(DeviceClass::D, SLOT),
            words => self.taken(DeviceClass::D, words),
        }
    }

    /// The first of this many temporary bits.
    pub(crate) fn temporary_bits(&mut self, count: u32) -> Made<Device> {
        self.taken(DeviceClass::M, count)
    }

    fn taken(&mut self, class: DeviceClass, count: u32) -> Made<Device> {
        self.supply.take(class, count).ok_or_else(|| {
            let what = phrase!(
                "no device {prefix} is left for a value in between",
                prefix = class.prefix()
            );
            let error = codes::ST_NO_DEVICE.at(self.span, what);
            vec![
                error.help("assign the value to a label of your own that several statements share"),
            ]
        })
    }

    /// The mnemonic of an operation, by the type of its values.
    pub(crate) fn sized(name: &str, ty: Ty) -> String {
        match (name, ty) {
            ("MOV", Ty::Text(_)) => "$MOV".to_owned(),
            ("WAND" | "WOR" | "WXOR", ty) if ty.is_wide() => name.replacen('W', "D", 1),
            (name, Ty::Real) => format!("DE{name}"),
            (name, ty) if ty.is_wide() => format!("D{name}"),
            (name, _) => name.to_owned(),
        }
    }
}
