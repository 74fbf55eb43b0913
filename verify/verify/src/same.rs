//! Equivalence of two programs: of their outputs, in every run with the same inputs.
//!
//! Both become one system ([`product`]). What is equal in it by construction, or by an induction over all memory that
//! both have, needs no further proof; of each other output it is asked whether it can differ, and a run in which it
//! does is replayed on both programs.

mod matching;
mod product;
#[cfg(test)]
mod tests;

use crate::aig::Lit;
use crate::model::{Gap, Key, Names, World, gaps_of};
use crate::proof::{Formula, Method, Posed, Proof};
use crate::prove::{Answer, Options, Question, Verdict, search};
use crate::replay::{self, Run};
use crate::search::Trace;
use product::Product;
use rungc_ir::Module;
use rungc_rt::Program;
use rungc_sim::property::Monitor;
use rungc_syntax::DeviceClass;
use std::time::Duration;
use web_time::Instant;

/// Result for an output of two programs.
#[derive(Clone, Debug)]
pub struct Output {
    /// Its number, Y.
    pub number: u32,
    /// Verdict: [`Verdict::Proved`] if it cannot differ.
    pub verdict: Verdict,
    /// The proof that it is the same, if it is not part of what both programs have in common.
    pub proof: Option<Proof>,
    /// Operations that the answer depends on and that are not modelled.
    pub gaps: Vec<Gap>,
    /// Duration.
    pub time: Duration,
}

/// Result for two programs.
#[derive(Clone, Debug)]
pub struct Compared {
    /// All outputs that one of them has.
    pub outputs: Vec<Output>,
    /// True if modules, serial ports and pulse outputs are proved to be used in the same way.
    pub same_environment: bool,
    /// Operations not modelled in either, assumed to be the same function in both.
    pub functions: Vec<Gap>,
    /// Devices of both programs that only one of them latches: after power-off, they are another value.
    pub latched_apart: Vec<(DeviceClass, u32)>,
    /// Formula that is never satisfied: a scan begins with equal values in all memory that both have in common, and
    /// ends with a difference in it.
    pub apart: Formula,
}

/// Compares the outputs of an old and a new program for the same model. [`Options::effort`] is that for what both
/// have in common, and that for each output that needs a separate proof.
pub fn compare(old: &Module, new: &Module, options: &Options) -> Compared {
    let modules = [old, new];
    let limit = options.limit();
    let names = matching::names(old, new);
    let product = Product::new(modules, &names, &options.world, &options.assumed, &limit);
    let runs_alike = product.is_equal(Key::Running);
    let numbers = product.outputs();
    let key_of = |number: &u32| Key::Bit(DeviceClass::Y, *number);
    let is_open = |key: &Key| !(runs_alike && product.is_equal_output(*key));
    let open: Vec<Key> = numbers.iter().map(key_of).filter(is_open).collect();
    let (whole, questions) = product.whole(&open, &names);
    let outputs = numbers.into_iter().map(|number| {
        let begin = Instant::now();
        let asked = open.iter().position(|key| *key == key_of(&number));
        let Some(at) = asked else {
            return Output::proved(number, None, begin);
        };
        let limit = options.limit();
        let posed = Posed::from(whole.about(questions[at])).simplified(&limit.share(4));
        if posed.system.bad == Lit::FALSE {
            let proof = posed.proof(Method::Invariant(Vec::new()));
            return Output::proved(number, Some(proof), begin);
        }
        let question = Differs {
            modules,
            number,
            names: &names,
            options,
        };
        let gaps = gaps_of(&posed.system, product.encoder());
        let Answer { verdict, proof } = search(&question, &options.world, &posed, &limit);
        Output {
            number,
            gaps: gaps.into_iter().collect(),
            verdict,
            proof,
            time: begin.elapsed(),
        }
    });
    Compared {
        outputs: outputs.collect(),
        same_environment: product.same_environment(),
        latched_apart: product.latched_apart(),
        apart: product.apart(&names),
        functions: product.functions.iter().cloned().collect(),
    }
}

impl Compared {
    /// Returns true if all outputs are proved to be the same, and what is around the PLC is used in the same way.
    pub fn is_proved(&self) -> bool {
        let mut outputs = self.outputs.iter();
        self.same_environment && outputs.all(|output| output.verdict == Verdict::Proved)
    }
}

impl Output {
    /// An output that is the same.
    fn proved(number: u32, proof: Option<Proof>, begin: Instant) -> Self {
        Output {
            number,
            verdict: Verdict::Proved,
            proof,
            gaps: Vec::new(),
            time: begin.elapsed(),
        }
    }
}

/// Question whether an output of two programs can differ.
struct Differs<'a> {
    modules: [&'a Module; 2],
    number: u32,
    names: &'a Names,
    options: &'a Options,
}

impl Question for Differs<'_> {
    fn posed(&self, world: &World) -> Posed {
        let product = Product::new(
            self.modules,
            self.names,
            world,
            &self.options.assumed,
            &self.options.limit(),
        );
        let output = Key::Bit(DeviceClass::Y, self.number);
        let posed = Posed::from(product.system(output, self.names));
        posed.resting_on(product.apart(self.names))
    }

    fn happens(&self, trace: &Trace) -> Option<usize> {
        let mut runs = self.modules.map(|module| Run::new(module, trace));
        let mut kept = runs.each_ref().map(|_| Monitor::new(&self.options.assumed));
        for (n, scan) in trace.scans.iter().enumerate() {
            if runs.iter().any(|run| run.is_early(scan)) {
                return None;
            }
            if scan.restart {
                kept.fill(Monitor::new(&self.options.assumed));
            }
            let [old, new] = &mut runs;
            let elapsed = [old.scan(scan), new.scan(scan)];
            if elapsed[0].is_some() != elapsed[1].is_some() {
                return Some(n + 1);
            }
            let mut both = [&*old, &*new].into_iter().zip(&mut kept);
            // Of programs that both stop, nothing follows.
            if !both.all(|(run, kept)| kept.all_hold(run.machine(), elapsed[0].unwrap_or(0))) {
                return None;
            }
            let output = |run: &Run| run.machine().output(self.number);
            if output(old) != output(new) {
                return Some(n + 1);
            }
        }
        None
    }

    fn steps(&self, trace: &Trace) -> usize {
        let steps = self.modules.map(|module| replay::steps(module, trace));
        steps.iter().sum()
    }

    /// Returns false: timers must expire at the same time in both.
    fn abstracts_timers(&self) -> bool {
        false
    }
}
