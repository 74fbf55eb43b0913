//! Findings against runs by chance: what is said never to happen must not happen in any of them.

use super::{Finding, Kind, look, world};
use crate::random::Random;
use crate::tests::module;
use rungc_interp::Machine;
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet};

/// Number of programs, and of runs of each.
const PROGRAMS: u64 = 30;
const RUNS: u64 = 12;
/// Scans of a run.
const SCANS: u64 = 40;

fn pick<'t>(of: &[&'t str], random: &mut Random) -> &'t str {
    of[random.below(of.len() as u64) as usize]
}

/// Two contacts in series, which often exclude each other.
fn contacts(random: &mut Random) -> String {
    const CONTACTS: [&str; 8] = ["X0", "X1", "M0", "M1", "M2", "T0", "S20", "M8002"];
    let (first, second) = (pick(&CONTACTS, random), pick(&CONTACTS, random));
    let (load, and) = (pick(&["LD", "LDI"], random), pick(&["AND", "ANI"], random));
    format!("{load} {first}\n{and} {second}\n")
}

/// The instruction that NeverActs is judged by.
const MOVE: &str = "MOV K1 D20\n";

/// Rungs of each kind of finding, each with its own device, in any order.
fn program(random: &mut Random) -> Vec<String> {
    let mut rungs: Vec<String> = Vec::new();
    for number in 0..3 {
        rungs.push(format!("{}OUT M{number}\n", contacts(random)));
    }
    rungs.push(format!("{}OUT T0 K{}\n", contacts(random), random.below(3)));
    rungs.push(format!("{}OUT T1 K2\n", contacts(random)));
    rungs.push(format!(
        "{}MOV K{} D0\n",
        contacts(random),
        1 + random.below(6)
    ));
    rungs.push(format!(
        "{}MOV K{} D0\n",
        contacts(random),
        1 + random.below(6)
    ));
    rungs.push(format!("{}{MOVE}", contacts(random)));
    let compare = pick(&["LD>", "LD=", "LD<"], random);
    rungs.push(format!("{compare} D0 K{}\nOUT M10\n", random.below(9)));
    rungs.push(format!("{}SET S20\n", contacts(random)));
    rungs.push(format!("{}RST S20\n", contacts(random)));
    for at in (1..rungs.len()).rev() {
        rungs.swap(at, random.below(at as u64 + 1) as usize);
    }
    rungs
}

/// What runs have shown.
#[derive(Default)]
struct Shown {
    on: BTreeSet<(DeviceClass, u32)>,
    left: bool,
    /// States of the relay that shows the result of the comparison.
    compared: BTreeSet<bool>,
    moved: bool,
}

impl Shown {
    fn note(&mut self, machine: &Machine, was_on: bool) {
        let bits = [
            (Class::M, DeviceClass::M, 0),
            (Class::M, DeviceClass::M, 1),
            (Class::M, DeviceClass::M, 2),
            (Class::M, DeviceClass::M, 10),
            (Class::T, DeviceClass::T, 0),
            (Class::T, DeviceClass::T, 1),
            (Class::S, DeviceClass::S, 20),
        ];
        for (class, of, number) in bits {
            if machine.bit(class, number) == Some(true) {
                self.on.insert((of, number));
            }
        }
        self.left |= was_on && machine.bit(Class::S, 20) == Some(false);
        self.compared.extend(machine.bit(Class::M, 10));
        self.moved |= machine.word(Class::D, 20) == Some(1);
    }

    /// Returns true if a finding cannot be true.
    fn contradicts(&self, finding: &Finding, moves: bool) -> bool {
        let is_on = finding
            .device
            .is_some_and(|device| self.on.contains(&device));
        match finding.kind {
            Kind::NeverOn | Kind::NeverReached | Kind::NeverExpires => is_on,
            Kind::NeverLeft => self.left,
            Kind::Constant { result, .. } => self.compared.contains(&!result),
            Kind::NeverActs => moves && self.moved,
            Kind::Oscillates => false,
        }
    }
}

#[test]
fn nothing_happens_that_is_said_never_to() {
    let mut random = Random::new();
    let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
    for _ in 0..PROGRAMS {
        let rungs = program(&mut random);
        let moving = rungs.iter().position(|rung| rung.ends_with(MOVE));
        let text = format!("{}END\n", rungs.concat());
        let module = module(&text);
        let report = look(&module, world(BTreeSet::new(), BTreeSet::new()), 500);
        let mut shown = Shown::default();
        for _ in 0..RUNS {
            let mut machine = Machine::new(&module);
            let mut now = 0;
            for _ in 0..SCANS {
                if random.below(20) == 0 {
                    machine.set_running(false);
                    machine.set_running(true);
                }
                for number in 0..2 {
                    let _ = machine.set_bit(Class::X, number, random.below(2) == 0);
                }
                let was_on = machine.bit(Class::S, 20) == Some(true);
                machine.scan(&mut VirtualHal::new(), now, 0);
                shown.note(&machine, was_on);
                now += [1, 30, 150][random.below(3) as usize];
            }
        }
        for finding in &report.findings {
            let moves = moving == Some(finding.network as usize);
            assert!(!shown.contradicts(finding, moves), "{finding:?}\n{text}");
            let kind = format!("{:?}", finding.kind);
            let name = kind
                .split([' ', '{'])
                .next()
                .unwrap_or_default()
                .to_string();
            *kinds.entry(name).or_default() += 1;
        }
    }
    for kind in [
        "NeverOn",
        "NeverReached",
        "NeverLeft",
        "NeverActs",
        "Constant",
        "NeverExpires",
    ] {
        assert!(kinds.contains_key(kind), "{kinds:?}");
    }
}
