//! Statements with texts by chance, run by the interpreter and by an evaluator that knows nothing of the compiler.

use fastrand::Rng;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, NoHal, Plc, Program as _};
use rungc_syntax::{Program, Source, SourceKind};
use std::fmt::Write as _;

/// Texts with their first registers and lengths.
const TEXTS: [(&str, u32, usize); 4] = [
    ("s_0", 10, 5),
    ("s_1", 20, 12),
    ("s_2", 30, 12),
    ("s_3", 40, 30),
];
/// First register of the numbers `n_0` to `n_3`.
const NUMBERS: u32 = 60;

/// A text or number as an expression.
#[derive(Clone, Debug)]
enum Expr {
    Text(usize),
    Literal(&'static str),
    Number(usize),
    Constant(i16),
    Call(&'static str, Vec<Expr>),
}

#[derive(Debug)]
enum Stmt {
    /// A text is cut to the length of its label.
    Text(usize, Expr),
    Number(usize, Expr),
    /// A number is 1 where two texts are equal, or unlike, else 0.
    Compare(usize, &'static str, Expr, Expr),
}

/// Values of all variables.
#[derive(Clone, Debug, Default)]
struct State {
    texts: [Vec<u8>; 4],
    numbers: [i16; 4],
}

enum Value {
    Text(Vec<u8>),
    Number(i16),
}

impl Value {
    fn text(self) -> Vec<u8> {
        match self {
            Value::Text(text) => text,
            Value::Number(number) => panic!("{number} is a number"),
        }
    }

    fn number(self) -> i16 {
        match self {
            Value::Number(number) => number,
            Value::Text(text) => panic!("{text:?} is a text"),
        }
    }
}

fn below(random: &mut Rng, count: usize) -> usize {
    random.usize(0..count)
}

fn number(random: &mut Rng, depth: usize) -> Expr {
    match below(random, if depth == 0 { 2 } else { 4 }) {
        0 => Expr::Constant(random.i16(-3..12)),
        1 => Expr::Number(below(random, 4)),
        2 => Expr::Call("LEN", vec![text(random, depth - 1)]),
        _ => Expr::Call(
            "FIND",
            vec![text(random, depth - 1), text(random, depth - 1)],
        ),
    }
}

fn text(random: &mut Rng, depth: usize) -> Expr {
    const LITERALS: [&str; 6] = ["", "a", "b", "ab", "bba", "abab "];
    if depth == 0 || below(random, 4) == 0 {
        return match below(random, 3) {
            0 => Expr::Literal(LITERALS[below(random, LITERALS.len())]),
            _ => Expr::Text(below(random, 4)),
        };
    }
    let first = text(random, depth - 1);
    let mut args = vec![first];
    let (name, texts, numbers) = [
        ("LEFT", 0, 1),
        ("RIGHT", 0, 1),
        ("MID", 0, 2),
        ("CONCAT", 1, 0),
        ("CONCAT", 2, 0),
        ("INSERT", 1, 1),
        ("DELETE", 0, 2),
        ("REPLACE", 1, 2),
    ][below(random, 8)];
    args.extend((0..texts).map(|_| text(random, depth - 1)));
    args.extend((0..numbers).map(|_| number(random, depth - 1)));
    Expr::Call(name, args)
}

fn statement(random: &mut Rng) -> Stmt {
    let to = below(random, 4);
    match below(random, 6) {
        0 => Stmt::Number(to, number(random, 2)),
        1 => {
            let shown = Expr::Call("INT_TO_STRING", vec![number(random, 1)]);
            match random.bool() {
                true => Stmt::Number(to, Expr::Call("STRING_TO_INT", vec![shown])),
                false => Stmt::Text(to, shown),
            }
        }
        2 => {
            let op = if random.bool() { "=" } else { "<>" };
            Stmt::Compare(to, op, text(random, 1), text(random, 1))
        }
        _ => Stmt::Text(to, text(random, 2)),
    }
}

impl Expr {
    fn written(&self) -> String {
        match self {
            Expr::Text(at) => TEXTS[*at].0.to_owned(),
            Expr::Literal(text) => format!("'{text}'"),
            Expr::Number(at) => format!("n_{at}"),
            Expr::Constant(value) => value.to_string(),
            Expr::Call(name, args) => {
                let args: Vec<_> = args.iter().map(Expr::written).collect();
                format!("{name}({})", args.join(", "))
            }
        }
    }

    fn value(&self, state: &State) -> Value {
        match self {
            Expr::Text(at) => Value::Text(state.texts[*at].clone()),
            Expr::Literal(text) => Value::Text(text.as_bytes().to_vec()),
            Expr::Number(at) => Value::Number(state.numbers[*at]),
            Expr::Constant(value) => Value::Number(*value),
            Expr::Call(name, args) => {
                let values: Vec<_> = args.iter().map(|arg| arg.value(state)).collect();
                called(name, values)
            }
        }
    }
}

/// Result of a function. Positions count from 1; what lies outside of a text is left out.
fn called(name: &str, values: Vec<Value>) -> Value {
    let mut values = values.into_iter();
    let mut next = || values.next().expect("an argument");
    match name {
        "CONCAT" => {
            let all: Vec<_> = values.map(Value::text).collect();
            return Value::Text(all.concat());
        }
        "INT_TO_STRING" => {
            let number = next().number();
            let sign = if number < 0 { '-' } else { ' ' };
            return Value::Text(format!("{sign}{:5}", number.unsigned_abs()).into_bytes());
        }
        "STRING_TO_INT" => {
            let text = String::from_utf8(next().text()).expect("ASCII");
            let digits: String = text.chars().filter(|c| *c != ' ').collect();
            return Value::Number(digits.parse().expect("a number"));
        }
        _ => {}
    }
    let text = next().text();
    // A part of the text, from its beginning.
    let upto = |count: i32, length: usize| (count.max(0) as usize).min(length);
    let length = text.len();
    match name {
        "LEN" => Value::Number(length as i16),
        "FIND" => {
            let searched = next().text();
            let found = text
                .windows(searched.len().max(1))
                .position(|part| part == searched);
            Value::Number(found.map_or(0, |at| at as i16 + 1))
        }
        "LEFT" => Value::Text(text[..upto(next().number().into(), length)].to_vec()),
        "RIGHT" => Value::Text(text[length - upto(next().number().into(), length)..].to_vec()),
        "MID" => {
            let (count, position) = (next().number(), next().number());
            let rest = &text[upto(i32::from(position) - 1, length)..];
            Value::Text(rest[..upto(count.into(), rest.len())].to_vec())
        }
        "INSERT" => {
            let (new, position) = (next().text(), next().number());
            let (head, end) = text.split_at(upto(position.into(), length));
            Value::Text([head, &new, end].concat())
        }
        _ => {
            let new = match name {
                "REPLACE" => next().text(),
                _ => Vec::new(),
            };
            let (count, position) = (next().number(), next().number());
            let (head, rest) = text.split_at(upto(i32::from(position) - 1, length));
            let end = &rest[upto(count.into(), rest.len())..];
            Value::Text([head, &new, end].concat())
        }
    }
}

impl Stmt {
    fn written(&self) -> String {
        match self {
            Stmt::Text(to, value) => {
                let (name, _, length) = TEXTS[*to];
                format!("{name} := LEFT({}, {length});", value.written())
            }
            Stmt::Number(to, value) => format!("n_{to} := {};", value.written()),
            Stmt::Compare(to, op, a, b) => format!(
                "n_{to} := BOOL_TO_INT({} {op} {});",
                a.written(),
                b.written()
            ),
        }
    }

    fn run(&self, state: &mut State) {
        match self {
            Stmt::Text(to, value) => {
                let mut text = value.value(state).text();
                text.truncate(TEXTS[*to].2);
                state.texts[*to] = text;
            }
            Stmt::Number(to, value) => state.numbers[*to] = value.value(state).number(),
            Stmt::Compare(to, op, a, b) => {
                let is_same = a.value(state).text() == b.value(state).text();
                state.numbers[*to] = (is_same == (*op == "=")).into();
            }
        }
    }
}

/// The text in the registers from `first` on.
fn text_of(plc: &impl Plc, first: u32) -> Vec<u8> {
    let words = (first..first + 20).map(|number| plc.word(Class::D, number).expect("a word"));
    let bytes = words.flat_map(i16::to_le_bytes);
    bytes.take_while(|byte| *byte != 0).collect()
}

fn run(seed: u64) {
    let mut random = Rng::with_seed(seed);
    let statements: Vec<Stmt> = (0..6).map(|_| statement(&mut random)).collect();
    let mut text = "PROGRAM Main\nVAR\n".to_owned();
    for (name, first, length) in TEXTS {
        let _ = writeln!(text, "{name} AT D{first} : STRING({length});");
    }
    for at in 0..4 {
        let _ = writeln!(text, "n_{at} AT D{} : INT;", NUMBERS + at);
    }
    text += "END_VAR\n";
    for one in &statements {
        let _ = writeln!(text, "{}", one.written());
    }
    text += "END_PROGRAM\n";
    let mut program = Program {
        source: Source::new("a.st", text.as_str()),
        kind: SourceKind::StructuredText,
        unread: vec![0],
        ..Program::default()
    };
    let found = rungc_structured::compile(&mut program, Model::get(ModelId::Fx3u));
    assert!(
        found.iter().next().is_none(),
        "{found:?}\nseed {seed}\n{text}"
    );
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    let module = compiled
        .module
        .unwrap_or_else(|| panic!("{:?}\n{text}", compiled.diagnostics));
    let mut plc = rungc_interp::Machine::new(&module);
    let mut state = State::default();
    for scan in 0..4 {
        for at in 0..4 {
            let value = random.i16(-2..14);
            plc.set_word(Class::D, NUMBERS + at as u32, value);
            state.numbers[at] = value;
        }
        plc.scan(&mut NoHal, 10 * scan, 10_000);
        statements.iter().for_each(|one| one.run(&mut state));
        for (at, (name, first, _)) in TEXTS.into_iter().enumerate() {
            let (is, should) = (text_of(&plc, first), &state.texts[at]);
            assert_eq!(&is, should, "{name} after scan {scan}, seed {seed}\n{text}");
        }
        for at in 0..4 {
            let is = plc.word(Class::D, NUMBERS + at as u32).expect("a word");
            assert_eq!(
                is, state.numbers[at],
                "n_{at} after scan {scan}, seed {seed}\n{text}"
            );
        }
        assert!(
            !plc.bit(Class::M, 8067).unwrap_or(false),
            "seed {seed}\n{text}"
        );
    }
}

#[test]
fn texts_by_chance_are_what_their_statements_say() {
    let rounds = std::env::var("RUNGC_ST_ROUNDS")
        .ok()
        .and_then(|text| text.parse().ok());
    for seed in 0..rounds.unwrap_or(40) {
        run(seed);
    }
}
