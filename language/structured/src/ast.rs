//! A text as it was written: units, declarations, statements and expressions with their places.

use rungc_syntax::Span;
use smol_str::SmolStr;

/// A name and its place.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Name {
    pub text: SmolStr,
    pub span: Span,
}

/// A whole text.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Text {
    pub units: Vec<Unit>,
    /// Sections of global variables.
    pub globals: Vec<Section>,
    pub structures: Vec<Structure>,
    pub configurations: Vec<Configuration>,
}

impl Text {
    /// Adds the parts of another text.
    pub(crate) fn extend(&mut self, other: Text) {
        self.units.extend(other.units);
        self.globals.extend(other.globals);
        self.structures.extend(other.structures);
        self.configurations.extend(other.configurations);
    }
}

/// Which programs run when.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Configuration {
    /// First keyword.
    pub head: Span,
    pub tasks: Vec<Task>,
    pub programs: Vec<Runs>,
}

/// A task.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Task {
    pub name: Name,
    /// `INTERVAL := T#10ms`, `PRIORITY := 31`.
    pub settings: Vec<(Name, Expr)>,
}

/// A program and the task that runs it.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Runs {
    pub program: Name,
    pub task: Option<Name>,
}

/// Kind of a program organisation unit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum UnitKind {
    Program,
    Function,
    Block,
}

/// A program, function or function block.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Unit {
    pub kind: UnitKind,
    pub name: Name,
    /// Type of the result of a function.
    pub returns: Option<TypeName>,
    pub sections: Vec<Section>,
    pub body: Body,
    /// First keyword.
    pub head: Span,
    /// False if the keyword at its end is missing.
    pub is_closed: bool,
    /// True for a block of the library.
    pub is_library: bool,
}

/// A structure as a data type.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Structure {
    pub name: Name,
    pub members: Vec<Variable>,
    /// False if `END_STRUCT` is missing.
    pub is_closed: bool,
}

/// A section of declarations.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Section {
    /// Its first keyword: `VAR`, `VAR_INPUT`.
    pub keyword: Name,
    pub is_constant: bool,
    pub variables: Vec<Variable>,
    pub is_closed: bool,
}

/// Declared variables of one type.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Variable {
    pub names: Vec<Name>,
    pub place: Option<Expr>,
    /// Devices of members of a structure: `AT (Home := X0, Position := D10)`.
    pub members: Vec<(Name, Expr)>,
    pub of: TypeName,
    pub initial: Option<Expr>,
    /// False if the semicolon is missing.
    pub is_ended: bool,
    pub span: Span,
}

/// A type as written.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct TypeName {
    pub name: Name,
    /// First and last index of each dimension of an array.
    pub bounds: Vec<(Expr, Expr)>,
    /// Length of a STRING, where it is stated.
    pub length: Option<Name>,
    pub span: Span,
}

/// Statements in order.
pub(crate) type Body = Vec<Stmt>;

/// A statement.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Stmt {
    pub kind: StmtKind,
    pub span: Span,
    /// False if the semicolon is missing.
    pub is_ended: bool,
}

/// Alternatives of IF or CASE.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Arm<T> {
    pub when: T,
    pub body: Body,
    /// The part that decides.
    pub span: Span,
}

/// One label of a CASE: a value, or the first and last of a range.
pub(crate) type Label = (Expr, Option<Expr>);

/// Kind of a statement.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum StmtKind {
    Assign(Expr, Expr),
    Call(Expr),
    If(Vec<Arm<Expr>>, Option<Body>, Closed),
    Case(Expr, Vec<Arm<Vec<Label>>>, Option<Body>, Closed),
    For(Box<For>),
    While(Expr, Body, Closed),
    Repeat(Body, Expr, Closed),
    Exit,
    Return,
    /// A semicolon alone.
    Empty,
    /// It could not be read, which is reported.
    Unread,
}

/// The first keyword of a statement over several lines, and whether its last one is there.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Closed {
    pub head: Span,
    pub is_closed: bool,
}

/// A counted loop.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct For {
    pub variable: Expr,
    pub from: Expr,
    pub to: Expr,
    pub by: Option<Expr>,
    pub body: Body,
    pub closed: Closed,
    /// The line that begins it.
    pub span: Span,
}

/// An expression.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Expr {
    pub kind: ExprKind,
    pub span: Span,
}

/// An argument of a call.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Arg {
    /// Name of the input or output, where it is given.
    pub name: Option<Name>,
    pub value: Expr,
}

/// An operator with two operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Op {
    Or,
    Xor,
    And,
    Eq,
    Ne,
    Lt,
    Gt,
    Le,
    Ge,
    Add,
    Sub,
    Mul,
    Div,
    Mod,
    Power,
}

impl Op {
    /// As it is written.
    pub(crate) const fn sign(self) -> &'static str {
        match self {
            Op::Or => "OR",
            Op::Xor => "XOR",
            Op::And => "AND",
            Op::Eq => "=",
            Op::Ne => "<>",
            Op::Lt => "<",
            Op::Gt => ">",
            Op::Le => "<=",
            Op::Ge => ">=",
            Op::Add => "+",
            Op::Sub => "-",
            Op::Mul => "*",
            Op::Div => "/",
            Op::Mod => "MOD",
            Op::Power => "**",
        }
    }

    /// Returns true for a comparison.
    pub(crate) const fn compares(self) -> bool {
        matches!(self, Op::Eq | Op::Ne | Op::Lt | Op::Gt | Op::Le | Op::Ge)
    }
}

/// Kind of an expression.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum ExprKind {
    /// A name, device or constant such as `K10`.
    Name(SmolStr),
    /// A number without a type.
    Number(SmolStr),
    /// A value with its type.
    Typed(SmolStr),
    Address(SmolStr),
    Text(SmolStr),
    Member(Box<Expr>, SmolStr),
    Index(Box<Expr>, Vec<Expr>),
    Call(Box<Expr>, Vec<Arg>),
    Not(Box<Expr>),
    Neg(Box<Expr>),
    Binary(Op, Box<Expr>, Box<Expr>),
    /// Initial values of an array; true if all are 0.
    Initial(bool),
    /// It could not be read, which is reported.
    Unread,
}
