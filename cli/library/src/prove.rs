//! Proofs of properties, and of programs that do the same.

use crate::{Error, Project};
use rungc_host::duration;
use rungc_ir::Module;
use rungc_lower::compile::CompileOptions;
use rungc_project::Project as Settings;
use rungc_sim::property::{Condition, ParseError, Property};
use rungc_verify::model::World;
use rungc_verify::prove::{self, Decision, EFFORT, Why, decide};
use rungc_verify::replay::story;
use rungc_verify::request::{self, ExternalWrites, Reader, stated};
use rungc_verify::same::{self, compare};
use rungc_verify::words;
use std::time::Duration;

pub use rungc_sim::property::Reading;
pub use rungc_verify::replay::{Change, Setting};

/// What is asked of a program, and what is supposed (`docs/src/prove.md`).
#[derive(Clone, Debug, Default)]
pub struct Question {
    /// Properties: `never Y000 & Y001`, `always A`, `reachable A`, `whenever A then B within 2s`,
    /// `stays A after B until C`. Default: those of the settings.
    pub properties: Vec<String>,
    /// Conditions that hold after every scan, beside those of the settings.
    pub assume: Vec<String>,
    /// Devices that something outside writes although the program does: `M500`, `D100..D109`.
    pub free: Vec<String>,
    /// The longest time from one scan to the next, 1 ms to 32,767 ms. Default: that of the settings, else 200 ms.
    pub scan: Option<Duration>,
    /// Latched devices begin with 0, as on a new PLC, not with any value.
    pub cleared: bool,
    /// Limit of the effort for each property: the same on every machine. Default: that of the settings, else 10,000.
    pub effort: Option<u64>,
    /// Limit of the time for each property.
    pub time: Option<Duration>,
}

/// Verdict on a property, or on an output of two programs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// No run of the model violates the property, or makes the output differ.
    Proved,
    /// A run violates it, or makes the output differ. The interpreter has replayed it.
    Violated,
    /// A run reaches what should be reachable.
    Reached,
    /// No run reaches it.
    NotReachable,
    /// Neither is known.
    Undecided,
    /// The program contradicts an assumption, so a proof would say nothing.
    Vacuous,
}

impl Verdict {
    fn of(verdict: &prove::Verdict, is_wanted: bool) -> Self {
        match (verdict, is_wanted) {
            (prove::Verdict::Undecided(Why::Vacuous { .. }), _) => Verdict::Vacuous,
            (prove::Verdict::Undecided(_), _) => Verdict::Undecided,
            (prove::Verdict::Proved, false) => Verdict::Proved,
            (prove::Verdict::Proved, true) => Verdict::NotReachable,
            (prove::Verdict::Found(_), false) => Verdict::Violated,
            (prove::Verdict::Found(_), true) => Verdict::Reached,
        }
    }

    /// True if the program does what is asked for: proved, or reached.
    pub fn is_good(self) -> bool {
        matches!(self, Verdict::Proved | Verdict::Reached)
    }
}

/// Answer about a property.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The property: `never Y000 & Y001`.
    pub property: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in a word: `proved`.
    pub word: &'static str,
    /// Grounds, a line each: the run, why nothing is known, what is not modelled, what counts as an input.
    pub grounds: String,
    /// The run that was found, equal scans together.
    pub run: Vec<Change>,
}

/// Answers about a program.
#[derive(Clone, Debug)]
pub struct Answers {
    /// An answer for each property.
    pub answers: Vec<Answer>,
    /// What all of them rest on.
    pub assumptions: Vec<String>,
    /// Properties of devices that nothing drives.
    pub warnings: Vec<String>,
}

/// Difference of an output from that of an older program.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its name: `Y000`.
    pub name: String,
    /// [`Verdict::Proved`] if it is the same in every run with the same inputs.
    pub verdict: Verdict,
    /// Why nothing is known, or after how many scans it differs.
    pub grounds: String,
}

/// A question, read for a program.
struct Posed<'a> {
    project: &'a Project,
    settings: Option<&'a Settings>,
    compiling: CompileOptions,
    question: &'a Question,
}

impl Project {
    /// Decides properties of the program, as `rungc verify` does.
    ///
    /// ```
    /// use rungc::prove::{Question, Verdict};
    /// use rungc::{Options, Project};
    ///
    /// # fn main() -> Result<(), rungc::Error> {
    /// let list = "LD X000\nOUT Y000\nLD X001\nANI Y000\nOUT Y001\nEND\n";
    /// let project = Project::from_list("reverser.il", list, &Options::default())?;
    /// let answers = project.prove(&Question {
    ///     properties: vec!["never Y000 & Y001".to_string()],
    ///     ..Question::default()
    /// })?;
    /// assert_eq!(answers.answers[0].verdict, Verdict::Proved);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// No property, one that cannot be read or says nothing, and a program with errors.
    pub fn prove(&self, question: &Question) -> Result<Answers, Error> {
        self.prove_while(question, &mut || true)
    }

    /// Decides properties of the program as long as `goes` returns true, which is asked before each.
    ///
    /// # Errors
    /// Those of [`prove`](Self::prove).
    pub fn prove_while(
        &self,
        question: &Question,
        goes: &mut dyn FnMut() -> bool,
    ) -> Result<Answers, Error> {
        let posed = Posed::new(self, question);
        let requested = posed.properties()?;
        let assumed = posed.assumed()?;
        let external = posed.external()?;
        let options = posed.options(&assumed, &external)?;
        let looked = requested.iter().flat_map(|(_, one)| one.conditions());
        let module = posed.module(looked.chain(&options.assumed), &external)?;
        let asked = requested.iter().take_while(|_| goes());
        let mut decided: Vec<Decision> = asked
            .map(|(_, property)| decide(&module, property, &options))
            .collect();
        let assumed: Vec<String> = assumed.into_iter().map(|(text, _)| text).collect();
        let is_proved = |one: &&mut Decision| one.verdict == prove::Verdict::Proved;
        let mut proved = decided.iter_mut().filter(is_proved).peekable();
        if proved.peek().is_some()
            && let Some(why) = words::vacuous([&module], &options, &assumed)
        {
            for decision in proved {
                decision.proof = None;
                decision.verdict = prove::Verdict::Undecided(why.clone());
            }
        }
        let both = requested.iter().zip(&decided);
        let answers = both.map(|(asked, decision)| answer(asked, decision, &module, &external));
        Ok(Answers {
            answers: answers.collect(),
            assumptions: words::assumptions(&options.world, &assumed, &external),
            warnings: posed.undriven(&requested, &external),
        })
    }

    /// Compares the outputs of an older program with those of this one: whether each is the same in every run with the
    /// same inputs, as `rungc verify --same-as` does. The properties of the question do not matter.
    ///
    /// # Errors
    /// Programs for different models, a program with errors, an assumption about more than one scan.
    pub fn same_as(&self, older: &Project, question: &Question) -> Result<Vec<Output>, Error> {
        let posed = Posed::new(self, question);
        let assumed = posed.assumed()?;
        if let Some((text, _)) = assumed.iter().find(|(_, one)| one.has_memory()) {
            return Err(Error::Question(format!(
                "two programs are compared scan by scan, and `{text}` depends on earlier scans"
            )));
        }
        let external = posed.external()?;
        let options = posed.options(&assumed, &external)?;
        let [old, new] = [older, self]
            .map(|project| Posed::new(project, question).module(&options.assumed, &external));
        let (old, new) = (old?, new?);
        if old.model.id != new.model.id {
            return Err(Error::Question(format!(
                "the programs are for different models: {} and {}",
                old.model.title, new.model.title
            )));
        }
        let compared = compare(&old, &new, &options);
        let assumed: Vec<String> = assumed.into_iter().map(|(text, _)| text).collect();
        let vacuous = words::vacuous([&old, &new], &options, &assumed);
        let outputs = compared.outputs.into_iter();
        Ok(outputs
            .map(|mut output| {
                if output.verdict == prove::Verdict::Proved
                    && let Some(why) = &vacuous
                {
                    output.verdict = prove::Verdict::Undecided(why.clone());
                }
                difference(&output)
            })
            .collect())
    }
}

impl<'a> Posed<'a> {
    fn new(project: &'a Project, question: &'a Question) -> Self {
        let settings = project.settings();
        Posed {
            project,
            settings: settings.filter(|settings| settings.is_about(project.file())),
            compiling: project.options(),
            question,
        }
    }

    fn reader(&self) -> Reader<'_> {
        Reader {
            program: self.project.source(),
            options: &self.compiling,
        }
    }

    /// The properties of the question, else those of the settings, with their texts.
    fn properties(&self) -> Result<Vec<(String, Property)>, Error> {
        let reader = self.reader();
        let texts = self.question.properties.iter();
        let read = texts.map(|text| match reader.statement(text) {
            Ok(property) => Ok((text.clone(), property)),
            Err(error) => Err(pointed(text, &error)),
        });
        let mut all = read.collect::<Result<Vec<_>, Error>>()?;
        if let (true, Some(settings)) = (all.is_empty(), self.settings) {
            let rows = rungc_functions::properties(settings);
            for expanded in rows.map_err(|wrong| settings.invalid(wrong))? {
                let row = &expanded.row;
                let property = reader.property(&row.kind);
                let property = property
                    .map_err(|(named, why)| Error::Question(format!("`{}`: {why}", named.text)))?;
                all.push((stated(row), property));
            }
        }
        match all.is_empty() {
            true => Err(Error::Question(
                "no property: such as `never Y000 & Y001`, or [[property]] in rungc.toml"
                    .to_string(),
            )),
            false => Ok(all),
        }
    }

    /// The assumptions of the settings and of the question, with their texts.
    fn assumed(&self) -> Result<Vec<(String, Condition)>, Error> {
        let own = self.settings.into_iter().flat_map(|one| &one.verify.assume);
        let texts = own.map(|named| &named.text).chain(&self.question.assume);
        let read = texts.map(|text| {
            let condition = self.reader().assumption(text);
            Ok((
                text.clone(),
                condition.map_err(|error| pointed(text, &error))?,
            ))
        });
        read.collect()
    }

    /// Devices that something outside writes.
    fn external(&self) -> Result<ExternalWrites, Error> {
        let names = self.project.names();
        let free = self.question.free.iter();
        let free: Result<Vec<_>, String> = free.map(|text| names.range(text.trim())).collect();
        let free = free.map_err(Error::Device)?;
        Ok(ExternalWrites::of(Some(&free), self.settings))
    }

    /// Assumptions about the environment of the program, and the limits.
    fn options(
        &self,
        assumed: &[(String, Condition)],
        external: &ExternalWrites,
    ) -> Result<prove::Options, Error> {
        let verify = self.settings.map(|settings| &settings.verify);
        let named = verify.and_then(|verify| verify.scan.as_ref());
        let named = named.map(|named| duration::parse(&named.text));
        let named = named.transpose().map_err(Error::Question)?;
        let given = self.question.scan.map(|scan| scan.as_millis());
        let scan_ms = match given.or(named.map(u128::from)) {
            Some(ms) => u32::try_from(ms)
                .ok()
                .filter(|ms| (1..=32_767).contains(ms)),
            None => Some(World::default().scan_ms),
        };
        let wrong = || {
            let why = "the longest time from one scan to the next is 1 ms to 32767 ms";
            Error::Question(why.to_string())
        };
        let own = verify.and_then(|verify| verify.effort).map(u64::from);
        Ok(prove::Options {
            world: World {
                scan_ms: scan_ms.ok_or_else(wrong)?,
                fresh: self.question.cleared,
                free: external.devices.keys().copied().collect(),
                ..World::default()
            },
            assumed: assumed.iter().map(|(_, one)| one.clone()).collect(),
            effort: self.question.effort.or(own).unwrap_or(EFFORT),
            time: self.question.time,
        })
    }

    /// The program as proofs take it.
    fn module<'c>(
        &self,
        looked: impl IntoIterator<Item = &'c Condition>,
        external: &ExternalWrites,
    ) -> Result<Module, Error> {
        let program = self.project.source();
        let module = request::module(program, self.compiling.clone(), looked, external);
        let checked = self.project.check();
        match module {
            Some(module) if !checked.has_errors() => Ok(module),
            _ => Err(Error::Rejected(checked.errors().cloned().collect())),
        }
    }

    /// Warnings about properties of devices that nothing drives.
    fn undriven(&self, requested: &[(String, Property)], external: &ExternalWrites) -> Vec<String> {
        let texts = requested.iter().map(|(text, one)| (text.as_str(), one));
        let found = request::undriven(texts, self.project.source(), &self.compiling, external);
        found.iter().map(|one| one.message.to_string()).collect()
    }
}

fn answer(
    (text, property): &(String, Property),
    decision: &Decision,
    module: &Module,
    external: &ExternalWrites,
) -> Answer {
    let mut grounds = String::new();
    if let prove::Verdict::Undecided(why) = &decision.verdict {
        grounds.push_str(&format!("            {}\n", words::reason(why)));
    }
    words::describe(&mut grounds, module, (property, decision), external);
    Answer {
        property: text.clone(),
        verdict: Verdict::of(&decision.verdict, property.is_wanted()),
        word: words::word(decision, property),
        grounds,
        run: match &decision.verdict {
            prove::Verdict::Found(trace) => story(module, property, trace),
            _ => Vec::new(),
        },
    }
}

fn difference(output: &same::Output) -> Output {
    Output {
        name: rungc_syntax::DeviceClass::Y
            .number(output.number)
            .to_string(),
        verdict: Verdict::of(&output.verdict, false),
        grounds: match &output.verdict {
            prove::Verdict::Proved => String::new(),
            prove::Verdict::Found(trace) => {
                let scans = rungc_syntax::diag::counted(trace.scans.len(), "scan");
                format!("it differs after {scans}")
            }
            prove::Verdict::Undecided(why) => words::reason(why),
        },
    }
}

/// A mistake with its place in the text.
fn pointed(text: &str, error: &ParseError) -> Error {
    let before = text[..error.at.min(text.len())].chars().count();
    let place = " ".repeat(before);
    Error::Question(format!("{}\n  {text}\n  {place}^", error.why))
}
