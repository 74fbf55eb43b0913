//! Structured text as a separate tree, its text, and its meaning: what IEC 61131-3 says, with integers that wrap as on
//! the PLC. Nothing of the compiler is used.

use std::collections::BTreeMap;

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ty {
    Bool,
    Int,
    Dint,
    Word,
    Real,
}

impl Ty {
    /// A number as the type holds it.
    pub fn wrapped(self, value: i64) -> i64 {
        match self {
            Ty::Bool => value & 1,
            Ty::Int => i64::from(value as i16),
            Ty::Dint => i64::from(value as i32),
            Ty::Word => i64::from(value as u16),
            Ty::Real => value,
        }
    }
}

/// A part of a variable's name.
#[derive(Clone, Debug)]
pub enum Part {
    Name(String),
    Index(Expr),
}

#[derive(Clone, Debug)]
pub struct Place {
    pub parts: Vec<Part>,
    pub ty: Ty,
}

#[derive(Clone, Debug)]
pub enum Expr {
    Const(i64, Ty),
    Read(Box<Place>),
    Not(Box<Expr>),
    Neg(Box<Expr>),
    Binary(&'static str, Box<Expr>, Box<Expr>),
    /// Function, arguments, and the type of the result.
    Call(&'static str, Vec<Expr>, Ty),
}

#[derive(Clone, Debug)]
pub enum Stmt {
    Assign(Place, Expr),
    /// A whole structure.
    Copy(Vec<Part>, Vec<Part>),
    If(Vec<(Expr, Vec<Stmt>)>, Vec<Stmt>),
    Case(Expr, Vec<(i64, i64, Vec<Stmt>)>, Vec<Stmt>),
    /// Counter, first, last, step.
    For(&'static str, i64, Expr, i64, Vec<Stmt>),
    While(&'static str, i64, Expr, Vec<Stmt>),
    Repeat(&'static str, i64, Expr, Vec<Stmt>),
    ExitIf(Expr),
    ReturnIf(Expr),
    /// `MOV` with its condition.
    Move(Expr, Place, Place),
    /// Instance, its block, inputs, and the variable for the first output.
    Block(&'static str, &'static str, Vec<(&'static str, Expr)>, Place),
}

/// Members of the structure of the programs.
pub const MEMBERS: [(&str, Ty); 7] = [
    (".m", Ty::Int),
    (".n", Ty::Dint),
    (".g", Ty::Bool),
    (".h", Ty::Bool),
    (".v[0]", Ty::Int),
    (".v[1]", Ty::Int),
    (".v[2]", Ty::Int),
];

pub fn name(name: &str) -> Vec<Part> {
    vec![Part::Name(name.to_owned())]
}

pub fn place(name_of: &str, ty: Ty) -> Place {
    Place {
        parts: name(name_of),
        ty,
    }
}

pub fn read(name: &str, ty: Ty) -> Expr {
    Expr::Read(Box::new(place(name, ty)))
}

pub fn binary(op: &'static str, a: Expr, b: Expr) -> Expr {
    Expr::Binary(op, Box::new(a), Box::new(b))
}

impl Expr {
    pub fn ty(&self) -> Ty {
        match self {
            Expr::Const(_, ty) | Expr::Call(_, _, ty) => *ty,
            Expr::Read(place) => place.ty,
            Expr::Not(of) | Expr::Neg(of) => of.ty(),
            Expr::Binary("=" | "<>" | "<" | ">" | "<=" | ">=", ..) => Ty::Bool,
            Expr::Binary(_, left, _) => left.ty(),
        }
    }

    pub fn text(&self) -> String {
        match self {
            Expr::Const(value, Ty::Bool) => if *value == 1 { "TRUE" } else { "FALSE" }.to_owned(),
            Expr::Const(value, _) if *value < 0 => format!("({value})"),
            Expr::Const(value, _) => value.to_string(),
            Expr::Read(place) => parts(&place.parts),
            Expr::Not(of) => format!("NOT {}", of.text()),
            Expr::Neg(of) => format!("(-{})", of.text()),
            Expr::Binary(op, a, b) => format!("({} {op} {})", a.text(), b.text()),
            Expr::Call(name, args, _) => {
                let args: Vec<_> = args.iter().map(Expr::text).collect();
                format!("{name}({})", args.join(", "))
            }
        }
    }
}

pub fn parts(all: &[Part]) -> String {
    let part = |part: &Part| match part {
        Part::Name(name) => name.clone(),
        Part::Index(index) => format!("[{}]", index.text()),
    };
    all.iter().map(part).collect()
}

pub fn body(all: &[Stmt]) -> String {
    all.iter().map(statement).collect()
}

fn statement(stmt: &Stmt) -> String {
    match stmt {
        Stmt::Assign(to, value) => format!("{} := {};\n", parts(&to.parts), value.text()),
        Stmt::Copy(to, from) => format!("{} := {};\n", parts(to), parts(from)),
        Stmt::If(arms, otherwise) => {
            let mut text = String::new();
            for (at, (when, then)) in arms.iter().enumerate() {
                let keyword = if at == 0 { "IF" } else { "ELSIF" };
                text += &format!("{keyword} {} THEN\n{}", when.text(), body(then));
            }
            if !otherwise.is_empty() {
                text += &format!("ELSE\n{}", body(otherwise));
            }
            text + "END_IF;\n"
        }
        Stmt::Case(of, arms, otherwise) => {
            let mut text = format!("CASE {} OF\n", of.text());
            for (first, last, then) in arms {
                text += &match first == last {
                    true => format!("{first}: {}", body(then)),
                    false => format!("{first}..{last}: {}", body(then)),
                };
            }
            text + &format!("ELSE\n{}END_CASE;\n", body(otherwise))
        }
        Stmt::For(counter, first, last, step, inner) => format!(
            "FOR {counter} := {first} TO {} BY {step} DO\n{}END_FOR;\n",
            last.text(),
            body(inner)
        ),
        Stmt::While(counter, most, when, inner) => format!(
            "{counter} := 0;\nWHILE {counter} < {most} AND {} DO\n{counter} := {counter} + 1;\n{}END_WHILE;\n",
            when.text(),
            body(inner)
        ),
        Stmt::Repeat(counter, most, until, inner) => format!(
            "{counter} := 0;\nREPEAT\n{counter} := {counter} + 1;\n{}UNTIL {counter} >= {most} OR {} END_REPEAT;\n",
            body(inner),
            until.text()
        ),
        Stmt::ExitIf(when) => format!("IF {} THEN EXIT; END_IF;\n", when.text()),
        Stmt::ReturnIf(when) => format!("IF {} THEN RETURN; END_IF;\n", when.text()),
        Stmt::Move(when, from, to) => {
            let (from, to) = (parts(&from.parts), parts(&to.parts));
            format!("MOV({}, {from}, {to});\n", when.text())
        }
        Stmt::Block(instance, _, inputs, output) => {
            let inputs: String = inputs
                .iter()
                .map(|(name, value)| format!("{name} := {}, ", value.text()))
                .collect();
            format!("{instance}({inputs}Q => {});\n", parts(&output.parts))
        }
    }
}

/// Continuation after a statement.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    Next,
    Exit,
    Return,
}

/// A function or block of the program.
pub struct Unit {
    pub name: &'static str,
    pub inputs: Vec<(&'static str, Ty)>,
    pub body: Vec<Stmt>,
}

/// Variables, by their names with numbers for indexes.
pub struct Machine<'u> {
    pub values: BTreeMap<String, i64>,
    pub units: &'u [Unit],
    /// Name of the instance whose body runs, with a dot.
    scope: String,
}

impl<'u> Machine<'u> {
    pub fn new(units: &'u [Unit]) -> Self {
        Machine {
            values: BTreeMap::new(),
            units,
            scope: String::new(),
        }
    }

    pub fn get(&self, name: &str) -> i64 {
        self.values.get(name).copied().unwrap_or(0)
    }

    pub fn set(&mut self, name: &str, ty: Ty, value: i64) {
        self.values.insert(name.to_owned(), ty.wrapped(value));
    }

    fn path(&mut self, all: &[Part]) -> String {
        let mut path = String::new();
        for part in all {
            match part {
                // Labels of a block are those of its instance.
                Part::Name(name) if name.starts_with("own") => {
                    path = format!("{}{name}", self.scope)
                }
                Part::Name(name) => path += name,
                Part::Index(index) => path += &format!("[{}]", self.value(index)),
            }
        }
        path
    }

    pub fn value(&mut self, expr: &Expr) -> i64 {
        let value = match expr {
            Expr::Const(value, _) => *value,
            Expr::Read(place) => {
                let path = self.path(&place.parts);
                self.get(&path)
            }
            Expr::Not(of) => 1 - self.value(of),
            Expr::Neg(of) => -self.value(of),
            Expr::Binary(op, a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                operated(op, a, b)
            }
            Expr::Call(name, args, _) => {
                let ty = args[0].ty();
                let values: Vec<_> = args.iter().map(|arg| self.value(arg)).collect();
                match self.units.iter().find(|unit| unit.name == *name) {
                    Some(unit) => self.function(unit, &values),
                    None => called(name, &values, ty),
                }
            }
        };
        expr.ty().wrapped(value)
    }

    fn function(&mut self, unit: &'u Unit, values: &[i64]) -> i64 {
        for ((name, ty), value) in unit.inputs.iter().zip(values) {
            self.set(name, *ty, *value);
        }
        self.run(&unit.body);
        self.get(unit.name)
    }

    /// Runs a program.
    pub fn run(&mut self, all: &[Stmt]) {
        let _ = self.body(all);
    }

    fn body(&mut self, all: &[Stmt]) -> Flow {
        for stmt in all {
            let flow = self.statement(stmt);
            if flow != Flow::Next {
                return flow;
            }
        }
        Flow::Next
    }

    fn statement(&mut self, stmt: &Stmt) -> Flow {
        match stmt {
            Stmt::Assign(to, value) => {
                let value = self.value(value);
                let path = self.path(&to.parts);
                self.set(&path, to.ty, value);
            }
            Stmt::Copy(to, from) => {
                let (to, from) = (self.path(to), self.path(from));
                for (member, ty) in MEMBERS {
                    let value = self.get(&format!("{from}{member}"));
                    self.set(&format!("{to}{member}"), ty, value);
                }
            }
            Stmt::If(arms, otherwise) => {
                for (when, then) in arms {
                    if self.value(when) == 1 {
                        return self.body(then);
                    }
                }
                return self.body(otherwise);
            }
            Stmt::Case(of, arms, otherwise) => {
                let value = self.value(of);
                let mut all = arms.iter();
                let arm = all.find(|(first, last, _)| (*first..=*last).contains(&value));
                return self.body(arm.map_or(otherwise, |(.., then)| then));
            }
            Stmt::ExitIf(when) if self.value(when) == 1 => return Flow::Exit,
            Stmt::ReturnIf(when) if self.value(when) == 1 => return Flow::Return,
            Stmt::ExitIf(_) | Stmt::ReturnIf(_) => {}
            Stmt::Move(when, from, to) => {
                if self.value(when) == 1 {
                    let (from, path) = (self.path(&from.parts), self.path(&to.parts));
                    self.set(&path, to.ty, self.get(&from));
                }
            }
            Stmt::Block(instance, block, inputs, output) => {
                let values: Vec<_> = inputs.iter().map(|(_, value)| self.value(value)).collect();
                let result = self.block(instance, block, &values);
                let path = self.path(&output.parts);
                self.set(&path, output.ty, result);
            }
            looped => return self.looped(looped),
        }
        Flow::Next
    }

    fn looped(&mut self, stmt: &Stmt) -> Flow {
        let (counter, inner) = match stmt {
            Stmt::For(counter, first, _, _, inner) => {
                self.set(counter, Ty::Int, *first);
                (counter, inner)
            }
            Stmt::While(counter, _, _, inner) | Stmt::Repeat(counter, _, _, inner) => {
                self.set(counter, Ty::Int, 0);
                (counter, inner)
            }
            _ => return Flow::Next,
        };
        loop {
            let count = self.get(counter);
            match stmt {
                Stmt::For(_, _, last, step, _) => {
                    let last = self.value(last);
                    if *step > 0 && count > last || *step < 0 && count < last {
                        return Flow::Next;
                    }
                }
                Stmt::While(_, most, when, _) if count >= *most || self.value(when) == 0 => {
                    return Flow::Next;
                }
                Stmt::While(..) | Stmt::Repeat(..) => self.set(counter, Ty::Int, count + 1),
                _ => {}
            }
            match self.body(inner) {
                Flow::Next => {}
                Flow::Exit => return Flow::Next,
                Flow::Return => return Flow::Return,
            }
            let count = self.get(counter);
            match stmt {
                Stmt::For(_, _, _, step, _) => self.set(counter, Ty::Int, count + step),
                Stmt::Repeat(_, most, until, _) if count >= *most || self.value(until) == 1 => {
                    return Flow::Next;
                }
                _ => {}
            }
        }
    }

    /// Calls an instance of a block; gives its output `Q`.
    fn block(&mut self, instance: &str, block: &str, inputs: &[i64]) -> i64 {
        let before = format!("{instance}.before");
        let count = format!("{instance}.count");
        let was = self.get(&before);
        let rising = |value: i64| i64::from(value == 1 && was == 0);
        match block {
            "R_TRIG" | "F_TRIG" => {
                self.set(&before, Ty::Bool, inputs[0]);
                match block {
                    "R_TRIG" => rising(inputs[0]),
                    _ => i64::from(inputs[0] == 0 && was == 1),
                }
            }
            "CTU" => {
                self.set(&before, Ty::Bool, inputs[0]);
                let counted = (self.get(&count) + rising(inputs[0])).min(32767);
                self.set(&count, Ty::Int, if inputs[1] == 1 { 0 } else { counted });
                i64::from(self.get(&count) >= inputs[2])
            }
            "CTD" => {
                self.set(&before, Ty::Bool, inputs[0]);
                let counted = (self.get(&count) - rising(inputs[0])).max(-32768);
                self.set(
                    &count,
                    Ty::Int,
                    if inputs[1] == 1 { inputs[2] } else { counted },
                );
                i64::from(self.get(&count) <= 0)
            }
            _ => {
                let unit = self.units.iter().find(|unit| unit.name == block);
                let unit = unit.expect("a block");
                let outer = std::mem::replace(&mut self.scope, format!("{instance}."));
                for ((name, ty), value) in unit.inputs.iter().zip(inputs) {
                    self.set(&format!("{instance}.{name}"), *ty, *value);
                }
                self.run(&unit.body);
                self.scope = outer;
                self.get("Q")
            }
        }
    }
}

fn operated(op: &str, a: i64, b: i64) -> i64 {
    match op {
        "+" => a + b,
        "-" => a - b,
        "*" => a.wrapping_mul(b),
        "/" => a / b,
        "MOD" => a % b,
        "AND" => a & b,
        "OR" => a | b,
        "XOR" => a ^ b,
        "=" => i64::from(a == b),
        "<>" => i64::from(a != b),
        "<" => i64::from(a < b),
        ">" => i64::from(a > b),
        "<=" => i64::from(a <= b),
        _ => i64::from(a >= b),
    }
}

/// A function of the library; `ty` is that of its first argument.
fn called(name: &str, values: &[i64], ty: Ty) -> i64 {
    let bits = |value: i64| match ty {
        Ty::Dint => value as u32,
        _ => u32::from(value as u16),
    };
    let [first, rest @ ..] = values else { return 0 };
    match (name, rest) {
        ("ABS", _) => first.wrapping_abs(),
        ("MIN", _) => *values.iter().min().expect("a value"),
        ("MAX", _) => *values.iter().max().expect("a value"),
        ("LIMIT", [value, most]) => *value.max(first).min(most),
        ("SEL", [off, on]) => *if *first == 1 { on } else { off },
        ("MUX", values) => values[*first as usize],
        ("SHL", [places]) => first << places,
        ("SHR", [places]) => (bits(*first) >> places).into(),
        ("ROL", [places]) => (first << places) | (first >> (16 - places)),
        ("ROR", [places]) => (first >> places) | (first << (16 - places)),
        ("INT_TO_BOOL", _) => i64::from(*first != 0),
        _ => *first,
    }
}
