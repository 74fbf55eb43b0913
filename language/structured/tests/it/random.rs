//! Programs by chance, run by the interpreter and by the evaluator of `model`: all variables agree after each scan.

use crate::model::{
    Expr, MEMBERS, Machine, Part, Place, Stmt, Ty, Unit, binary, body, name, place, read,
};
use fastrand::Rng;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, NoHal, Plc, Program as _};
use rungc_syntax::{Program, Source, SourceKind};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Variables with their devices.
const VARIABLES: [(&str, &str, Ty); 21] = [
    ("i_0", "D10", Ty::Int),
    ("i_1", "D11", Ty::Int),
    ("i_2", "D12", Ty::Int),
    ("k_0", "D13", Ty::Int),
    ("c_0", "D14", Ty::Int),
    ("c_1", "D15", Ty::Int),
    ("c_2", "D16", Ty::Int),
    ("d_0", "D20", Ty::Dint),
    ("d_1", "D22", Ty::Dint),
    ("d_k", "D24", Ty::Dint),
    ("w_0", "D30", Ty::Word),
    ("w_1", "D31", Ty::Word),
    ("r_0", "D40", Ty::Real),
    ("r_1", "D42", Ty::Real),
    ("b_0", "M0", Ty::Bool),
    ("b_1", "M1", Ty::Bool),
    ("b_2", "M2", Ty::Bool),
    ("q_0", "M3", Ty::Bool),
    ("q_1", "M4", Ty::Bool),
    ("q_2", "M5", Ty::Bool),
    ("q_3", "D17", Ty::Int),
];
/// Arrays of four elements with their first devices.
const ARRAYS: [(&str, &str, Ty); 4] = [
    ("x", "D100", Ty::Int),
    ("y", "D110", Ty::Dint),
    ("f", "M20", Ty::Bool),
    ("u", "D120", Ty::Word),
];
/// Structures; those of `zz` are elements 1 to 3.
const STRUCTURES: [&str; 5] = ["s", "t", "zz[1]", "zz[2]", "zz[3]"];

const TYPES: &str = "TYPE Pair :\nSTRUCT\nm : INT;\nn : DINT;\ng : BOOL;\nh : BOOL;\nv : ARRAY [0..2] OF INT;\n\
                     END_STRUCT\nEND_TYPE\n";

/// A generator of programs.
struct Gen {
    random: Rng,
    /// Counters of loops around the statement, which it must not change.
    loops: usize,
    /// Calls of functions are left out within functions.
    calls: bool,
}

impl Gen {
    fn below(&mut self, count: usize) -> usize {
        self.random.usize(0..count)
    }

    fn number(&mut self, ty: Ty) -> i64 {
        let small = self.random.i64(-9..10);
        let value = match self.below(4) {
            0 => self.random.i64(i64::MIN..i64::MAX),
            1 => [0, 1, -1, 32767, -32768, 65535][self.below(6)],
            _ => small,
        };
        match ty {
            Ty::Real => small,
            ty => ty.wrapped(value),
        }
    }

    /// An index from 0 to 3.
    fn index(&mut self, depth: usize) -> Expr {
        let four = |ty| Box::new(Expr::Const(4, ty));
        match self.below(6) {
            0 => Expr::Const(self.random.i64(0..4), Ty::Int),
            1 => read("k_0", Ty::Int),
            2 => read("d_k", Ty::Dint),
            3 if self.loops > 0 => read("c_0", Ty::Int),
            _ => {
                let value = self.value(Ty::Int, depth, false);
                let rest = Expr::Binary("MOD", Box::new(value), four(Ty::Int));
                Expr::Call("ABS", vec![rest], Ty::Int)
            }
        }
    }

    /// A variable of this type, with indexes.
    fn place(&mut self, ty: Ty, depth: usize) -> Place {
        let array = ARRAYS.iter().find(|(.., of)| *of == ty);
        match (self.below(6), array) {
            (0 | 1, Some((array, ..))) => {
                let mut parts = name(array);
                parts.push(Part::Index(self.index(depth)));
                Place { parts, ty }
            }
            (2 | 3, _) if matches!(ty, Ty::Int | Ty::Dint | Ty::Bool) => self.member(ty, depth),
            _ => self.scalar(ty),
        }
    }

    fn scalar(&mut self, ty: Ty) -> Place {
        let names: &[&str] = match ty {
            Ty::Bool => &["b_0", "b_1", "b_2"],
            Ty::Int => &["i_0", "i_1", "i_2"],
            Ty::Dint => &["d_0", "d_1"],
            Ty::Word => &["w_0", "w_1"],
            Ty::Real => &["r_0", "r_1"],
        };
        place(names[self.below(names.len())], ty)
    }

    /// A structure: a label, or an element by an index.
    fn structure(&mut self, depth: usize) -> Vec<Part> {
        if self.random.bool() {
            return name(STRUCTURES[self.below(STRUCTURES.len())]);
        }
        let rest = self.index(depth);
        let rest = Expr::Call("MAX", vec![rest, Expr::Const(1, Ty::Int)], Ty::Int);
        let index = match &rest {
            Expr::Call(_, args, _) if args[0].ty() == Ty::Dint => read("c_2", Ty::Int),
            Expr::Call(_, args, _) if matches!(args[0], Expr::Const(..)) => read("c_2", Ty::Int),
            _ => rest,
        };
        let mut parts = name("zz");
        parts.push(Part::Index(index));
        parts
    }

    fn member(&mut self, ty: Ty, depth: usize) -> Place {
        let mut parts = self.structure(depth);
        match ty {
            Ty::Bool => parts.extend(name([".g", ".h"][self.below(2)])),
            Ty::Dint => parts.extend(name(".n")),
            _ if self.random.bool() => parts.extend(name(".m")),
            _ => {
                parts.extend(name(".v"));
                let index = match self.below(3) {
                    0 => binary("MOD", read("k_0", Ty::Int), Expr::Const(3, Ty::Int)),
                    _ => Expr::Const(self.random.i64(0..3), Ty::Int),
                };
                parts.push(Part::Index(index));
            }
        }
        Place { parts, ty }
    }

    /// An expression of this type; a constant only where it may be one.
    fn value(&mut self, ty: Ty, depth: usize, may_be_constant: bool) -> Expr {
        if depth == 0 || self.below(5) == 0 {
            if may_be_constant && self.random.bool() {
                return Expr::Const(self.number(ty), ty);
            }
            return match self.calls {
                true => Expr::Read(Box::new(self.place(ty, 0))),
                false => read(if ty == Ty::Bool { "p" } else { "n" }, ty),
            };
        }
        let depth = depth - 1;
        match ty {
            Ty::Bool => self.condition(depth),
            Ty::Real => {
                let whole = self.value(Ty::Int, depth, false);
                Expr::Call("INT_TO_REAL", vec![whole], Ty::Real)
            }
            Ty::Word => self.word(depth),
            Ty::Dint if self.below(4) == 0 => {
                let from = if self.calls && self.random.bool() {
                    Ty::Word
                } else {
                    Ty::Int
                };
                let name = if from == Ty::Word {
                    "WORD_TO_DINT"
                } else {
                    "INT_TO_DINT"
                };
                Expr::Call(name, vec![self.value(from, depth, false)], Ty::Dint)
            }
            ty => self.integer(ty, depth),
        }
    }

    fn integer(&mut self, ty: Ty, depth: usize) -> Expr {
        let first = self.value(ty, depth, false);
        match self.below(12) {
            0..=4 => {
                let op = ["+", "-", "*", "AND", "OR"][self.below(5)];
                binary(op, first, self.value(ty, depth, true))
            }
            5 | 6 => {
                let divisor = [3, 7, 100, -5][self.below(4)];
                let op = if self.random.bool() { "/" } else { "MOD" };
                binary(op, first, Expr::Const(divisor, ty))
            }
            7 => Expr::Neg(Box::new(first)),
            8 => {
                let name = if self.random.bool() { "MIN" } else { "MAX" };
                let rest = (0..1 + self.below(2)).map(|_| self.value(ty, depth, true));
                let args: Vec<_> = [first].into_iter().chain(rest).collect();
                Expr::Call(name, args, ty)
            }
            9 => {
                let (least, most) = (self.random.i64(-50..0), self.random.i64(0..50));
                let [least, most] = [least, most].map(|value| Expr::Const(value, ty));
                Expr::Call("LIMIT", vec![least, first, most], ty)
            }
            10 => {
                let when = self.value(Ty::Bool, depth, false);
                let other = self.value(ty, depth, true);
                Expr::Call("SEL", vec![when, first, other], ty)
            }
            _ if ty == Ty::Int => self.converted(depth),
            _ => Expr::Call("ABS", vec![first], ty),
        }
    }

    /// An INT from other types, or from a function of the program.
    fn converted(&mut self, depth: usize) -> Expr {
        match self.below(5) {
            0 if self.calls => Expr::Call(
                "DINT_TO_INT",
                vec![self.value(Ty::Dint, depth, false)],
                Ty::Int,
            ),
            1 => Expr::Call(
                "BOOL_TO_INT",
                vec![self.value(Ty::Bool, depth, false)],
                Ty::Int,
            ),
            2 if self.calls => {
                let args = (0..4).map(|at| match at {
                    0 => self.index(0),
                    _ => self.value(Ty::Int, depth, true),
                });
                let mut args: Vec<_> = args.collect();
                if args[0].ty() != Ty::Int {
                    args[0] = read("k_0", Ty::Int);
                }
                args.push(read("i_0", Ty::Int));
                Expr::Call("MUX", args, Ty::Int)
            }
            _ if self.calls => {
                let (n, p) = (
                    self.value(Ty::Int, depth, true),
                    self.value(Ty::Bool, depth, true),
                );
                Expr::Call("Twice", vec![n, p], Ty::Int)
            }
            _ => Expr::Call("ABS", vec![self.value(Ty::Int, depth, false)], Ty::Int),
        }
    }

    fn word(&mut self, depth: usize) -> Expr {
        let first = self.value(Ty::Word, depth, false);
        match self.below(3) {
            0 => {
                let op = ["AND", "OR", "XOR"][self.below(3)];
                binary(op, first, self.value(Ty::Word, depth, true))
            }
            1 => {
                let op = if self.random.bool() { "/" } else { "MOD" };
                binary(
                    op,
                    first,
                    Expr::Const([3, 10, 40_000][self.below(3)], Ty::Word),
                )
            }
            _ => {
                let name = ["SHL", "SHR", "ROL", "ROR"][self.below(4)];
                let places = Expr::Const(self.random.i64(0..16), Ty::Int);
                Expr::Call(name, vec![first, places], Ty::Word)
            }
        }
    }

    fn condition(&mut self, depth: usize) -> Expr {
        let types: &[Ty] = match self.calls {
            true => &[Ty::Int, Ty::Dint, Ty::Word, Ty::Real],
            false => &[Ty::Int],
        };
        match self.below(8) {
            0..=2 => {
                let ty = types[self.below(types.len())];
                let op = ["=", "<>", "<", ">", "<=", ">="][self.below(6)];
                let right = self.value(ty, depth, ty != Ty::Real);
                binary(op, self.value(ty, depth, false), right)
            }
            3 => Expr::Not(Box::new(self.value(Ty::Bool, depth, false))),
            4 => Expr::Call(
                "INT_TO_BOOL",
                vec![self.value(Ty::Int, depth, false)],
                Ty::Bool,
            ),
            5 if self.calls => {
                Expr::Call("IsOdd", vec![self.value(Ty::Int, depth, true)], Ty::Bool)
            }
            _ => {
                let op = ["AND", "OR", "XOR", "=", "<>"][self.below(5)];
                let right = self.value(Ty::Bool, depth, false);
                binary(op, self.value(Ty::Bool, depth, false), right)
            }
        }
    }

    fn statements(&mut self, depth: usize) -> Vec<Stmt> {
        (0..1 + self.below(3))
            .map(|_| self.statement(depth))
            .collect()
    }

    fn statement(&mut self, depth: usize) -> Stmt {
        let when = |random: &mut Gen| random.value(Ty::Bool, 2, false);
        match self.below(if depth == 0 { 8 } else { 15 }) {
            0 => {
                let value = self.index(2);
                let (to, ty) = if value.ty() == Ty::Int {
                    ("k_0", Ty::Int)
                } else {
                    ("d_k", Ty::Dint)
                };
                Stmt::Assign(place(to, ty), value)
            }
            1 => Stmt::Copy(self.structure(1), self.structure(1)),
            2 if self.random.bool() => {
                let (from, to) = (self.place(Ty::Int, 1), self.scalar(Ty::Int));
                Stmt::Move(when(self), from, to)
            }
            2 => self.block(),
            3 if self.loops > 0 => Stmt::ExitIf(when(self)),
            3..=7 => {
                let ty = [Ty::Bool, Ty::Int, Ty::Int, Ty::Dint, Ty::Word, Ty::Real][self.below(6)];
                Stmt::Assign(self.place(ty, 1), self.value(ty, 3, true))
            }
            8 | 9 => {
                let arms = (0..1 + self.below(2)).map(|_| (when(self), self.statements(depth - 1)));
                let arms = arms.collect();
                let otherwise = match self.random.bool() {
                    true => self.statements(depth - 1),
                    false => Vec::new(),
                };
                Stmt::If(arms, otherwise)
            }
            10 => {
                let of = self.value(Ty::Int, 1, false);
                let arms = [(-3, 0), (1, 1), (4, 90)];
                let arms = arms.map(|(a, b)| (a, b, self.statements(depth - 1)));
                Stmt::Case(of, arms.into(), self.statements(depth - 1))
            }
            _ if self.loops > 0 => {
                Stmt::Assign(self.place(Ty::Int, 1), self.value(Ty::Int, 2, true))
            }
            kind => {
                self.loops += 1;
                let inner = self.statements(depth - 1);
                self.loops -= 1;
                match kind {
                    11 => Stmt::For(
                        "c_0",
                        0,
                        Expr::Const(3, Ty::Int),
                        1 + self.random.i64(0..2),
                        inner,
                    ),
                    12 => Stmt::While("c_0", 3, when(self), inner),
                    13 => Stmt::Repeat("c_0", 3, when(self), inner),
                    _ => Stmt::For("c_0", 3, Expr::Const(0, Ty::Int), -1, inner),
                }
            }
        }
    }

    fn block(&mut self) -> Stmt {
        let on = self.value(Ty::Bool, 1, false);
        match self.below(5) {
            0 => Stmt::Block("rise", "R_TRIG", vec![("CLK", on)], place("q_0", Ty::Bool)),
            1 => Stmt::Block("fall", "F_TRIG", vec![("_CLK", on)], place("q_1", Ty::Bool)),
            2 => {
                let inputs = vec![
                    ("CU", on),
                    ("R", self.value(Ty::Bool, 1, false)),
                    ("PV", self.value(Ty::Int, 1, true)),
                ];
                Stmt::Block("up", "CTU", inputs, place("q_2", Ty::Bool))
            }
            3 => {
                let inputs = vec![
                    ("CD", on),
                    ("LD", self.value(Ty::Bool, 1, false)),
                    ("PV", self.value(Ty::Int, 1, true)),
                ];
                Stmt::Block("down", "CTD", inputs, place("q_2", Ty::Bool))
            }
            _ => {
                let instance = ["first", "second"][self.below(2)];
                let inputs = vec![("own_in", self.value(Ty::Int, 2, true)), ("own_on", on)];
                Stmt::Block(instance, "Sums", inputs, place("q_3", Ty::Int))
            }
        }
    }
}

/// The functions and blocks of a program, of which one body is drawn.
fn units(random: &mut Gen) -> Vec<Unit> {
    random.calls = false;
    let result = random.value(Ty::Int, 2, false);
    random.calls = true;
    let otherwise = binary("*", read("n", Ty::Int), Expr::Const(2, Ty::Int));
    let twice = vec![
        Stmt::Assign(place("Twice", Ty::Int), otherwise),
        Stmt::ReturnIf(read("p", Ty::Bool)),
        Stmt::Assign(place("Twice", Ty::Int), result),
    ];
    let rest = binary("MOD", read("m", Ty::Int), Expr::Const(2, Ty::Int));
    let one = Expr::Call(
        "Twice",
        vec![Expr::Const(0, Ty::Int), Expr::Const(1, Ty::Bool)],
        Ty::Int,
    );
    let odd = vec![Stmt::Assign(
        place("IsOdd", Ty::Bool),
        binary("<>", rest, one),
    )];
    let sum = binary("+", read("own_sum", Ty::Int), read("own_in", Ty::Int));
    let sums = vec![
        Stmt::ReturnIf(Expr::Not(Box::new(read("own_on", Ty::Bool)))),
        Stmt::Assign(place("own_sum", Ty::Int), sum),
        Stmt::Assign(place("Q", Ty::Int), read("own_sum", Ty::Int)),
    ];
    let inputs = [
        vec![("n", Ty::Int), ("p", Ty::Bool)],
        vec![("m", Ty::Int)],
        vec![("own_in", Ty::Int), ("own_on", Ty::Bool)],
    ];
    let bodies = [("Twice", twice), ("IsOdd", odd), ("Sums", sums)];
    let units = bodies.into_iter().zip(inputs);
    units
        .map(|((name, body), inputs)| Unit { name, inputs, body })
        .collect()
}

/// The text of a program; at its end, members of structures are copied to where they are compared.
fn text(units: &[Unit], statements: &[Stmt]) -> String {
    let mut text = TYPES.to_owned();
    let _ = write!(
        text,
        "FUNCTION Twice : INT\nVAR_INPUT\nn : INT;\np : BOOL;\nEND_VAR\n{}END_FUNCTION\n\
         FUNCTION IsOdd : BOOL\nVAR_INPUT\nm : INT;\nEND_VAR\n{}END_FUNCTION\n\
         FUNCTION_BLOCK Sums\nVAR_INPUT\nown_in : INT;\nown_on : BOOL;\nEND_VAR\nVAR_OUTPUT\nQ : INT;\nEND_VAR\n\
         VAR\nown_sum : INT;\nEND_VAR\n{}END_FUNCTION_BLOCK\nPROGRAM Main\nVAR\n",
        body(&units[0].body),
        body(&units[1].body),
        body(&units[2].body),
    );
    let kind = |ty| match ty {
        Ty::Bool => "BOOL",
        Ty::Int => "INT",
        Ty::Dint => "DINT",
        Ty::Word => "WORD",
        Ty::Real => "REAL",
    };
    for (name, device, ty) in VARIABLES {
        let _ = writeln!(text, "{name} AT {device} : {};", kind(ty));
    }
    for (name, device, ty) in ARRAYS {
        let _ = writeln!(text, "{name} AT {device} : ARRAY [0..3] OF {};", kind(ty));
    }
    text += "s, t : Pair;\nzz : ARRAY [1..3] OF Pair;\nrise : R_TRIG;\nfall : F_TRIG;\nup : CTU;\ndown : CTD;\n\
             first, second : Sums;\nEND_VAR\n";
    text += &body(statements);
    for (at, (name, ty)) in members().into_iter().enumerate() {
        let at = 2 * at;
        let _ = match ty {
            Ty::Bool => writeln!(text, "M{} := {name};", 200 + at),
            Ty::Dint => writeln!(text, "DMOV(TRUE, {name}, D{});", 200 + at),
            _ => writeln!(text, "D{} := {name};", 200 + at),
        };
    }
    text + "END_PROGRAM\n"
}

/// All members of the structures.
fn members() -> Vec<(String, Ty)> {
    let of = |name: &str| MEMBERS.map(|(member, ty)| (format!("{name}{member}"), ty));
    STRUCTURES.into_iter().flat_map(of).collect()
}

/// Devices that are compared, by the names of their variables.
fn devices() -> BTreeMap<String, (Class, u32, Ty)> {
    let device = |text: &str| {
        let class = if text.starts_with('M') {
            Class::M
        } else {
            Class::D
        };
        (class, text[1..].parse::<u32>().expect("a number"))
    };
    let mut all = BTreeMap::new();
    for (name, text, ty) in VARIABLES {
        let (class, number) = device(text);
        all.insert(name.to_owned(), (class, number, ty));
    }
    for (name, text, ty) in ARRAYS {
        let (class, number) = device(text);
        for at in 0..4 {
            let each = if ty == Ty::Dint { 2 } else { 1 };
            all.insert(format!("{name}[{at}]"), (class, number + at * each, ty));
        }
    }
    for (at, (name, ty)) in (0..).zip(members()) {
        let class = if ty == Ty::Bool { Class::M } else { Class::D };
        all.insert(name, (class, 200 + 2 * at, ty));
    }
    all
}

fn value_of(plc: &impl Plc, (class, number, ty): (Class, u32, Ty)) -> i64 {
    let word = |number| i64::from(plc.word(class, number).expect("a word") as u16);
    let wide = |number| word(number + 1) << 16 | word(number);
    match ty {
        Ty::Bool => plc.bit(class, number).expect("a bit").into(),
        Ty::Dint => ty.wrapped(wide(number)),
        Ty::Real => f32::from_bits(wide(number) as u32) as i64,
        ty => ty.wrapped(word(number)),
    }
}

/// Inputs of a scan: variables that the program reads and writes.
fn draw(random: &mut Gen, plc: &mut impl Plc, machine: &mut Machine) {
    for (name, device, ty) in VARIABLES {
        let number = device[1..].parse::<u32>().expect("a number");
        if matches!(ty, Ty::Real) || name.starts_with(['c', 'q']) {
            continue;
        }
        let value = match name {
            "k_0" | "d_k" => random.random.i64(0..4),
            _ => random.number(ty),
        };
        machine.set(name, ty, value);
        match ty {
            Ty::Bool => plc.set_bit(Class::M, number, value == 1),
            _ => plc.set_word(Class::D, number, value as i16),
        };
        if ty == Ty::Dint {
            plc.set_word(Class::D, number + 1, (value >> 16) as i16);
        }
    }
}

fn run(seed: u64) {
    let mut random = Gen {
        random: Rng::with_seed(seed),
        loops: 0,
        calls: true,
    };
    let units = units(&mut random);
    let mut statements = vec![Stmt::Assign(place("c_2", Ty::Int), {
        Expr::Call(
            "LIMIT",
            vec![
                Expr::Const(1, Ty::Int),
                read("i_0", Ty::Int),
                Expr::Const(3, Ty::Int),
            ],
            Ty::Int,
        )
    })];
    statements.extend((0..6).map(|_| random.statement(2)));
    let text = text(&units, &statements);
    let mut program = Program {
        source: Source::new("a.st", text.as_str()),
        kind: SourceKind::StructuredText,
        unread: vec![0],
        ..Program::default()
    };
    let found = rungc_structured::compile(&mut program, Model::get(ModelId::Fx3u));
    let errors: Vec<_> = found
        .iter()
        .filter(|one| !one.code.starts_with('W'))
        .collect();
    assert!(errors.is_empty(), "{errors:?}\nseed {seed}\n{text}");
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    let module = compiled
        .module
        .unwrap_or_else(|| panic!("{:?}\n{text}", compiled.diagnostics));
    let mut plc = rungc_interp::Machine::new(&module);
    let mut machine = Machine::new(&units);
    for scan in 0..4 {
        draw(&mut random, &mut plc, &mut machine);
        plc.scan(&mut NoHal, 10 * scan, 10_000);
        machine.run(&statements);
        for (name, device) in devices() {
            let (is, should) = (value_of(&plc, device), machine.get(&name));
            assert_eq!(is, should, "{name} after scan {scan}, seed {seed}\n{text}");
        }
    }
}

#[test]
fn programs_by_chance_do_what_their_text_says() {
    let rounds = std::env::var("RUNGC_ST_ROUNDS")
        .ok()
        .and_then(|text| text.parse().ok());
    for seed in 0..rounds.unwrap_or(10) {
        run(seed);
    }
}
