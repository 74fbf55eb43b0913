//! Planted violations, to see what the attack finds: each is reached by a rare sequence that is known.

use super::draw::Written;
use super::run::{Goal, replay};
use rungc_golden::rng::Rng;
use rungc_ir::Module;
use rungc_sim::property::{Property, parse};
use rungc_syntax::DeviceClass::X;
use rungc_verify::model::Key;
use rungc_verify::steered::{Run, Step};

/// Kinds of planted violations.
pub const KINDS: [&str; 6] = [
    "a count of edges, then an input",
    "a count that another input clears",
    "a code of inputs in order",
    "an input held for seconds",
    "one input between two times after another",
    "a value that is passed once in a while",
];

/// A program with a violation, and a run that shows it.
pub struct Planted {
    /// Index in [`KINDS`].
    pub kind: usize,
    /// The program.
    pub written: Written,
    /// Violated property.
    pub property: Property,
    witness: Run,
}

/// Inputs of a planted part. The program around it may use them, too.
const INPUTS: u32 = 6;

/// The relay that must never be on.
const HIDDEN: &str = "M330";

/// Plants a violation into a program.
pub fn plant(written: &Written, rng: &mut Rng) -> Option<Planted> {
    let kind = rng.below(KINDS.len() as u32) as usize;
    let mut inputs: Vec<u32> = (0..INPUTS).collect();
    for last in (1..inputs.len()).rev() {
        inputs.swap(last, rng.below(last as u32 + 1) as usize);
    }
    let (rungs, presses) = match kind {
        0 => count(rng, &inputs, false),
        1 => count(rng, &inputs, true),
        2 => code(rng, &inputs),
        3 => held(rng, &inputs),
        4 => between(rng, &inputs),
        _ => passed(rng, &inputs),
    };
    Some(Planted {
        kind,
        written: Written {
            text: format!("{rungs}{}", written.text),
            ..written.clone()
        },
        property: Property::Never(parse(HIDDEN, &|_| Vec::new()).ok()?),
        witness: witness(&presses),
    })
}

impl Planted {
    /// Returns true if the known run violates the property: the program around may prevent it.
    pub fn is_reachable(&self, module: &Module) -> bool {
        let goal = Goal::Event(&self.property);
        replay(&[module], goal, &[], &self.witness).is_some()
    }
}

/// Inputs that are on, for a number of scans.
type Press = (Vec<u32>, u32);

/// Time from one scan to the next in a known run.
const SCAN_MS: u32 = 10;

/// The run in which these inputs are on.
fn witness(presses: &[Press]) -> Run {
    let mut steps: Vec<Step> = Vec::new();
    for (on, scans) in presses {
        for _ in 0..*scans {
            let set = (0..INPUTS).map(|n| (Key::Bit(X, n), i64::from(on.contains(&n))));
            steps.push(Step {
                set: set.collect(),
                ms: if steps.is_empty() { 0 } else { SCAN_MS },
                ..Step::default()
            });
        }
    }
    Run {
        start: Vec::new(),
        steps,
    }
}

fn pulses(input: u32, count: u32) -> Vec<Press> {
    (0..count)
        .flat_map(|_| [(Vec::new(), 1), (vec![input], 1)])
        .collect()
}

fn count(rng: &mut Rng, inputs: &[u32], cleared: bool) -> (String, Vec<Press>) {
    let [counted, then, clears] = [inputs[0], inputs[1], inputs[2]];
    let most = if cleared { 12 } else { 40 };
    let preset = 4 + rng.below(most);
    let reset = match cleared {
        true => format!("LD X{clears:03o}\nRST C20\n"),
        false => String::new(),
    };
    let rungs = format!(
        "LD X{counted:03o}\nOUT C20 K{preset}\n{reset}LD C20\nAND X{then:03o}\nANI X{counted:03o}\nOUT {HIDDEN}\n"
    );
    let mut presses = pulses(counted, preset);
    presses.push((vec![then], 2));
    (rungs, presses)
}

fn code(rng: &mut Rng, inputs: &[u32]) -> (String, Vec<Press>) {
    let length = 3 + rng.below(3);
    let buttons = &inputs[..4];
    let code: Vec<u32> = (0..length).filter_map(|_| rng.pick(buttons)).collect();
    let mut rungs = String::new();
    for &button in buttons {
        rungs.push_str(&format!("LD X{button:03o}\nPLS M{}\n", 300 + button));
    }
    // The last stage comes first, so that one press is one stage; a wrong press begins again.
    for (stage, &button) in code.iter().enumerate().rev() {
        let (from, to) = (320 + stage, 321 + stage);
        let pressed = 300 + button;
        let from = if stage == 0 {
            "M8000".to_string()
        } else {
            format!("M{from}")
        };
        rungs.push_str(&format!("LD M{pressed}\nAND {from}\nSET M{to}\n"));
        if stage > 0 {
            rungs.push_str(&format!("LD M{to}\nRST {from}\n"));
        }
        for &other in buttons.iter().filter(|&&other| other != button) {
            rungs.push_str(&format!("LD M{}\nAND {from}\n", 300 + other));
            rungs.push_str(&match stage {
                0 => "OUT M310\n".to_string(),
                _ => format!("RST {from}\n"),
            });
        }
    }
    rungs.push_str(&format!("LD M{}\nOUT {HIDDEN}\n", 320 + length));
    let presses = code
        .iter()
        .flat_map(|&button| [(Vec::new(), 1), (vec![button], 1)]);
    (rungs, presses.collect())
}

fn held(rng: &mut Rng, inputs: &[u32]) -> (String, Vec<Press>) {
    let [held, then] = [inputs[0], inputs[1]];
    let tenths = 10 + rng.below(90);
    let rungs =
        format!("LD X{held:03o}\nOUT T30 K{tenths}\nLD T30\nANDP X{then:03o}\nOUT {HIDDEN}\n");
    let scans = tenths * 100 / SCAN_MS + 3;
    (rungs, vec![(vec![held], scans), (vec![held, then], 1)])
}

fn between(rng: &mut Rng, inputs: &[u32]) -> (String, Vec<Press>) {
    let [first, second] = [inputs[0], inputs[1]];
    let begin = 5 + rng.below(20);
    let end = begin + 2 + rng.below(4);
    let rungs = format!(
        "LD X{first:03o}\nOUT T30 K{begin}\nLD X{first:03o}\nOUT T31 K{end}\n\
         LD T30\nANI T31\nANDP X{second:03o}\nOUT {HIDDEN}\n"
    );
    let scans = begin * 100 / SCAN_MS + 3;
    (rungs, vec![(vec![first], scans), (vec![first, second], 1)])
}

fn passed(rng: &mut Rng, inputs: &[u32]) -> (String, Vec<Press>) {
    let [counted, then] = [inputs[0], inputs[1]];
    let wanted = 5 + rng.below(20);
    let end = wanted + 1 + rng.below(5);
    let rungs = format!(
        "LDP X{counted:03o}\nINC D100\nLD> D100 K{end}\nMOV K0 D100\n\
         LD= D100 K{wanted}\nAND X{then:03o}\nANI X{counted:03o}\nOUT {HIDDEN}\n"
    );
    let mut presses = pulses(counted, wanted);
    presses.push((vec![then], 2));
    (rungs, presses)
}
