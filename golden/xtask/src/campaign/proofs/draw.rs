//! Random questions: a program, a world around it, and properties.

use rungc_catalogue::Lower;
use rungc_golden::operands::{Candidate, accepted, candidates};
use rungc_golden::rng::Rng;
use rungc_golden::{random, stations};
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile, open_indexes};
use rungc_models::{Model, ModelId};
use rungc_sim::property::{Condition, Property, parse};
use rungc_syntax::{DeviceClass, DeviceRun};
use rungc_verify::model::World;
use rungc_verify::prove::Options;

/// Instructions of each model.
pub struct Pools(Vec<(ModelId, Vec<Candidate>, Vec<Candidate>)>);

impl Pools {
    /// All instructions, and those that the prover models bit by bit.
    pub fn new() -> Self {
        let pool = |model| {
            let all = candidates(model);
            let expanded =
                |c: &&Candidate| !matches!(c.inst().lower_on_model(model), Lower::Call(_));
            let exact = all.iter().filter(expanded).cloned().collect();
            (model, all, exact)
        };
        Pools(ModelId::ALL.map(pool).into())
    }
}

/// A program with its latched devices, as its author wrote it.
#[derive(Clone, PartialEq, Debug)]
pub struct Written {
    /// The model.
    pub model: ModelId,
    /// The instructions.
    pub text: String,
    /// `[latched]` of `rungc.toml`; empty: as the model has it.
    pub latched: Vec<DeviceRun>,
}

impl Written {
    /// The module as `rungc verify` makes it; `None` if the program does not compile.
    pub fn module(&self, options: &Options, property: &[&Property]) -> Option<Module> {
        let mut read = rungc_frontend::read_text("campaign.il", &self.text);
        if !self.latched.is_empty() {
            let parameters = read.program.parameters.get_or_insert_default();
            parameters.latched = Some(self.latched.clone());
        }
        let conditions = property.iter().flat_map(|property| property.conditions());
        let observe = conditions
            .chain(&options.assumed)
            .flat_map(Condition::devices);
        let mut compiling = CompileOptions {
            model: Some(self.model),
            observe: observe.collect(),
            optimise: false,
            ..CompileOptions::default()
        };
        let free = &options.world.free;
        let indexes = open_indexes(&read.program, &compiling, |device| free.contains(&device));
        compiling.observe.extend(indexes);
        let has_errors = read.diagnostics.has_errors();
        let mut module = compile(&read.program, &compiling)
            .module
            .filter(|_| !has_errors)?;
        simplify(&mut module);
        Some(module)
    }
}

/// Form of a question, as the table of results names it.
pub const FORMS: [&str; 7] = [
    "never",
    "always",
    "reachable",
    "whenever",
    "whenever within",
    "stays until",
    "same",
];

/// A property with its form and its text.
#[derive(Clone, Debug)]
pub struct Asked {
    /// Index in [`FORMS`].
    pub form: usize,
    /// As it is written.
    pub text: String,
    /// Meaning.
    pub property: Property,
}

/// A program, its world, and what is asked.
pub struct Question {
    /// The program.
    pub written: Written,
    /// Assumptions, with their texts.
    pub options: Options,
    /// Texts of the assumed conditions.
    pub assumed: Vec<String>,
    /// Generator of what follows.
    pub rng: Rng,
    /// Devices that the program names.
    pub devices: Vec<(DeviceClass, u32)>,
    /// Constants of the program, and values at limits.
    pub values: Vec<i64>,
}

/// Rungs that change what a PLC does as a whole, where a model has them.
const SPECIALS: [&str; 12] = [
    "LD X003\nOUT M8034",
    "LD X003\nOUT M8033",
    "LD M8000\nMOV K50 D8039\nLD X003\nOUT M8039",
    "LD M8002\nMOV K20 D8039\nLD M8000\nOUT M8039",
    "LD M8000\nOUT M8039",
    "LDP X003\nSET M8034\nLDP X004\nRST M8034",
    "LD X003\nOUT M8031",
    "LD X003\nOUT M8032",
    "LDP X003\nSET M8037",
    "LD M8000\nOUT M8035\nLD M8000\nOUT M8036",
    "LD X003\nOUT M8040",
    "LD X003\nMOV K300 D8000",
];

/// Longest times from one scan to the next, in milliseconds.
const SCANS_MS: [u32; 8] = [1, 10, 50, 200, 200, 200, 1000, 32_767];

/// The question with this number; `None` if its program does not compile, or a scan may execute many instructions.
pub fn question(pools: &Pools, seed: u64, effort: u64) -> Option<Question> {
    let mut rng = Rng::new(seed ^ 0x9AFE);
    let (model, all, exact) = &pools.0[(seed % pools.0.len() as u64) as usize];
    let pool = if rng.percent(50) { exact } else { all };
    let mut text = match rng.below(9) {
        0 => stations::program(seed),
        _ => random::program(seed, *model, pool, 2 + rng.below(7)),
    };
    if rng.percent(25)
        && let Some(special) = rng.pick(&SPECIALS)
        && accepted(special, *model)
    {
        text = format!("{special}\n{text}");
    }
    let devices = devices(&text);
    let latched = latched(&mut rng, *model);
    let mut question = Question {
        written: Written {
            model: *model,
            text,
            latched,
        },
        options: Options {
            world: World {
                scan_ms: rng.pick(&SCANS_MS).unwrap_or(200),
                fresh: rng.percent(25),
                ..World::default()
            },
            assumed: Vec::new(),
            effort,
            time: None,
        },
        assumed: Vec::new(),
        values: Vec::new(),
        devices,
        rng,
    };
    question.values = values(&question.written.text);
    if question.rng.percent(30) {
        question.free();
    }
    if question.rng.percent(25) {
        question.assume();
    }
    is_short(&question.written.text).then_some(())?;
    question.written.module(&question.options, &[])?;
    Some(question)
}

/// Returns true if a scan executes few instructions for certain, and its logic is small: each call of a routine and
/// each iteration is part of it.
fn is_short(text: &str) -> bool {
    /// The register that counts how often a program jumps back.
    const PASSES: &str = "D120";
    let count = |line: &str| line.strip_prefix("FOR K")?.parse::<u32>().ok();
    let mut loops = text.lines().filter(|line| line.starts_with("FOR "));
    text.matches("CALL").count() <= 1
        && !text.contains(PASSES)
        && loops.all(|line| count(line).is_some_and(|count| count <= 12))
}

/// Devices that a list names, each once.
fn devices(text: &str) -> Vec<(DeviceClass, u32)> {
    let program = rungc_frontend::read_text("campaign.il", text).program;
    let mut found = Vec::new();
    for operand in program.instrs.iter().flat_map(|instr| &instr.operands) {
        let Some(device) = operand.kind.device() else {
            continue;
        };
        let device = (device.class, device.number);
        use DeviceClass::{I, N, P};
        if !matches!(device.0, P | I | N) && !found.contains(&device) {
            found.push(device);
        }
    }
    found
}

/// Constants of a list with values at limits.
fn values(text: &str) -> Vec<i64> {
    let mut found = vec![0, 1, -1, 32_767, -32_768, 255, 100];
    for word in text.split_whitespace() {
        let value = match (word.strip_prefix('K'), word.strip_prefix('H')) {
            (Some(digits), _) => digits.parse().ok(),
            (_, Some(digits)) => i64::from_str_radix(digits, 16).ok(),
            _ => None,
        };
        found.extend(value);
    }
    found
}

/// Latched devices other than those of the model, sometimes.
fn latched(rng: &mut Rng, model: ModelId) -> Vec<DeviceRun> {
    if !rng.percent(25) {
        return Vec::new();
    }
    let model = Model::get(model);
    let choices = [
        (DeviceClass::M, 0, 8),
        (DeviceClass::D, 0, 4),
        (DeviceClass::C, 0, 2),
        (DeviceClass::S, 0, 4),
        (DeviceClass::M, 10, 5),
    ];
    let can = |&(class, first, count): &(DeviceClass, u32, u32)| {
        (first..first + count)
            .all(|number| model.has(class, number) && model.can_choose_latch(class, number))
    };
    let mut chosen = choices.to_vec();
    chosen.retain(|choice| can(choice) && rng.percent(50));
    let run = |(class, first, count)| DeviceRun {
        class,
        first,
        count,
    };
    chosen.into_iter().map(run).collect()
}

impl Question {
    /// Lets something else write some devices of the program, as `--free` and `[hmi] writes` do.
    fn free(&mut self) {
        use DeviceClass::{C, D, M, R, S, T, V, Z};
        let model = Model::get(self.written.model);
        let wanted = |&(class, number): &(DeviceClass, u32)| {
            let is_class = matches!(class, M | S | D | R | T | C | V | Z);
            is_class && !model.is_set_by_scan(class, number)
        };
        let named: Vec<_> = self.devices.iter().copied().filter(wanted).collect();
        for _ in 0..1 + self.rng.below(3) {
            self.options.world.free.extend(self.rng.pick(&named));
        }
    }

    /// Assumes conditions, most often about inputs.
    fn assume(&mut self) {
        for _ in 0..1 + self.rng.below(2) {
            let text = match self.rng.below(6) {
                0 => self.condition(1),
                1 => format!("K1X000 < {}", 1 + self.rng.below(15)),
                2 => format!("!X{:03o} | X{:03o}", self.rng.below(8), self.rng.below(8)),
                _ => format!("!(X{:03o} & X{:03o})", self.rng.below(8), self.rng.below(8)),
            };
            if let Ok(condition) = parse(&text, &|_| Vec::new()) {
                self.options.assumed.push(condition);
                self.assumed.push(text);
            }
        }
    }

    /// A random property that can be read.
    pub fn property(&mut self) -> Option<Asked> {
        let model = Model::get(self.written.model);
        let read = |this: &mut Self, depth| {
            let text = this.condition(depth);
            let condition = parse(&text, &|_| Vec::new()).ok()?;
            // The command rejects what the model does not have.
            let has = |(class, number)| model.has(class, number);
            condition
                .devices()
                .into_iter()
                .all(has)
                .then_some((condition, text))
        };
        let depth = self.rng.below(3);
        let (first, first_text) = read(self, depth)?;
        let form = self.rng.below(9);
        if form < 5 {
            let (form, property) = match form {
                0..=2 => (0, Property::Never(first)),
                3 => (1, Property::Always(first)),
                _ => (2, Property::Reachable(first)),
            };
            let text = format!("{} {first_text}", FORMS[form]);
            return Some(Asked {
                form,
                text,
                property,
            });
        }
        let (second, second_text) = read(self, 1)?;
        let within_ms = self.rng.pick(&[1, 9, 10, 50, 100, 250, 1000]).unwrap_or(10);
        Some(match form {
            5 | 6 => Asked {
                form: 3,
                text: format!("whenever {first_text} then {second_text}"),
                property: Property::Whenever {
                    when: first,
                    then: second,
                    within_ms: 0,
                },
            },
            7 => Asked {
                form: 4,
                text: format!("whenever {first_text} then {second_text} within {within_ms}ms"),
                property: Property::Whenever {
                    when: first,
                    then: second,
                    within_ms,
                },
            },
            _ => {
                let (after, after_text) = match self.rng.percent(50) {
                    true => read(self, 0)
                        .map(|(after, text)| (Some(after), format!(" after {text}")))?,
                    false => (None, String::new()),
                };
                Asked {
                    form: 5,
                    text: format!("stays {first_text}{after_text} until {second_text}"),
                    property: Property::Stays {
                        after,
                        holds: first,
                        until: second,
                    },
                }
            }
        })
    }

    /// A random condition.
    fn condition(&mut self, depth: u32) -> String {
        if depth == 0 {
            return match self.rng.below(16) {
                0..6 => self.bit(),
                6 => format!("{} = {}", self.bit(), self.bit()),
                7 => format!("rises({})", self.bit()),
                8 => format!("falls({})", self.bit()),
                9 => format!("was({})", self.bit()),
                10 => format!("({} for {}ms)", self.bit(), 1 + self.rng.below(300)),
                11 => format!("({} before {})", self.bit(), self.bit()),
                12 => format!(
                    "at most one of ({}, {}, {})",
                    self.bit(),
                    self.bit(),
                    self.bit()
                ),
                _ => self.comparison(),
            };
        }
        let (left, right) = (self.condition(depth - 1), self.condition(depth - 1));
        match self.rng.below(5) {
            0 => format!("!({left})"),
            1 => format!("({left}) | ({right})"),
            _ => format!("({left}) & ({right})"),
        }
    }

    /// A device of the program of one of these classes, or another one.
    fn device(&mut self, classes: &[DeviceClass]) -> (DeviceClass, u32) {
        let known = self
            .devices
            .iter()
            .filter(|(class, _)| classes.contains(class));
        let known: Vec<_> = known.copied().collect();
        let class = self.rng.pick(classes).unwrap_or(DeviceClass::M);
        let any = (class, self.rng.below(8));
        match self.rng.percent(90) {
            true => self.rng.pick(&known).unwrap_or(any),
            false => any,
        }
    }

    fn bit(&mut self) -> String {
        use DeviceClass::{C, M, S, T, X, Y};
        let classes: &[DeviceClass] = match self.rng.below(4) {
            0 => &[X],
            1 => &[Y],
            _ => &[Y, M, S, T, C, M],
        };
        let (class, number) = self.device(classes);
        let not = if self.rng.percent(25) { "!" } else { "" };
        format!("{not}{}", class.number(number))
    }

    /// A number, and the number of its bits.
    fn number(&mut self) -> (String, u32) {
        use DeviceClass::{C, D, M, R, S, T, V, X, Y, Z};
        match self.rng.below(8) {
            0 => {
                let (class, number) = self.device(&[X, Y, M, S]);
                let digits = 1 + self.rng.below(8);
                (format!("K{digits}{}", class.number(number)), 4 * digits)
            }
            1 => {
                let (class, number) = self.device(&[T, C]);
                let wide = class == C && number >= 200;
                let bits = if wide { 32 } else { 16 };
                (format!("{}.value", class.number(number)), bits)
            }
            2 => {
                let (class, number) = self.device(&[D, R]);
                (format!("{}.i32", class.number(number)), 32)
            }
            _ => {
                let (class, number) = self.device(&[D, D, R, Z, V]);
                (class.number(number).to_string(), 16)
            }
        }
    }

    fn comparison(&mut self) -> String {
        let (number, bits) = self.number();
        let signs = ["=", "!=", "<", "<=", ">", ">="];
        let sign = self.rng.pick(&signs).unwrap_or("=");
        if self.rng.percent(20) {
            return format!("{number} {sign} {}", self.number().0);
        }
        let near = i64::from(self.rng.below(3)) - 1;
        let value = self.rng.pick(&self.values).unwrap_or(0) + near;
        let value = match bits {
            16 | 32 => value << (64 - bits) >> (64 - bits),
            _ => value.rem_euclid(1 << bits),
        };
        match self.rng.percent(15) {
            true => format!("{number} {sign} H{:X}", value & ((1 << bits) - 1)),
            false => format!("{number} {sign} {value}"),
        }
    }
}
