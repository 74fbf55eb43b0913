//! Shapes of control flow in random programs: counts of those that only few programs have.

use std::collections::BTreeMap;
use std::fmt;

const NESTED_JUMPS: &str = "jumps around others";
const CROSSING_JUMPS: &str = "jumps that cross others";
const JUMPS_BACK: &str = "jumps back";
const JUMPS_IN_STATES: &str = "jumps in states";
const CALLS_IN_STATES: &str = "calls in states";
const NESTED_CALLS: &str = "calls in routines";
const OWN_CALLS: &str = "calls of the routine itself";
const BOTH: &str = "step ladders with subroutines";
const JOINS: &str = "joined branches";
const LADDERS_IN_ZONES: &str = "step ladders in zones";
const INTERRUPTS: &str = "interrupt routines";
const AT_COUNTS: &str = "interrupts at counts";

/// All of them.
const ALL: [&str; 12] = [
    NESTED_JUMPS,
    CROSSING_JUMPS,
    JUMPS_BACK,
    JUMPS_IN_STATES,
    CALLS_IN_STATES,
    NESTED_CALLS,
    OWN_CALLS,
    BOTH,
    JOINS,
    LADDERS_IN_ZONES,
    INTERRUPTS,
    AT_COUNTS,
];

/// Number of each, by name.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Shapes(BTreeMap<&'static str, u32>);

impl Default for Shapes {
    fn default() -> Self {
        Shapes(ALL.map(|name| (name, 0)).into())
    }
}

impl Shapes {
    /// Adds what a list has of them.
    pub fn add(&mut self, text: &str) {
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(' ').collect()).collect();
        let (mut in_state, mut zones, mut routine) = (false, 0, "");
        let (mut has_ladder, mut has_calls, mut before) = (false, false, "");
        for words in &lines {
            let verb = words[0];
            match verb {
                "STL" => {
                    self.count(JOINS, before == "STL");
                    self.count(LADDERS_IN_ZONES, zones > 0 && !in_state);
                    (in_state, has_ladder) = (true, true);
                }
                "RET" => in_state = false,
                "MC" => zones += 1,
                "MCR" => zones -= 1,
                "FEND" => routine = verb,
                "DHSCS" => self.count(AT_COUNTS, words.last().is_some_and(|to| is_label(to, 'I'))),
                "CJ" | "CJP" => self.count(JUMPS_IN_STATES, in_state),
                "CALL" | "CALLP" => {
                    has_calls = true;
                    self.count(CALLS_IN_STATES, in_state);
                    self.count(NESTED_CALLS, !routine.is_empty());
                    self.count(OWN_CALLS, words.get(1) == Some(&routine));
                }
                _ if is_label(verb, 'I') => {
                    self.count(INTERRUPTS, true);
                    routine = verb;
                }
                // After FEND, a label begins a subroutine where a routine has ended.
                _ if is_label(verb, 'P') && ["FEND", "SRET", "IRET", "PRET"].contains(&before) => {
                    routine = verb;
                }
                _ => {}
            }
            before = verb;
        }
        self.count(BOTH, has_ladder && has_calls);
        self.add_jumps(&lines);
    }

    /// Counts the relative positions of jumps.
    fn add_jumps(&mut self, lines: &[Vec<&str>]) {
        let labels = lines.iter().enumerate();
        let labels: BTreeMap<&str, usize> = labels
            .filter(|(_, words)| is_label(words[0], 'P'))
            .map(|(at, words)| (words[0], at))
            .collect();
        let jumps = lines.iter().enumerate().filter_map(|(at, words)| {
            let label = words.get(1).filter(|_| words[0].starts_with("CJ"))?;
            Some((at, *labels.get(label)?))
        });
        let jumps: Vec<(usize, usize)> = jumps.collect();
        for &(from, to) in &jumps {
            let others = || {
                jumps
                    .iter()
                    .filter(|(other, _)| (from + 1..to).contains(other))
            };
            self.count(JUMPS_BACK, to < from);
            self.count(NESTED_JUMPS, others().any(|&(_, end)| end <= to));
            self.count(CROSSING_JUMPS, others().any(|&(_, end)| end > to));
        }
    }

    fn count(&mut self, name: &'static str, is_one: bool) {
        *self.0.entry(name).or_default() += u32::from(is_one);
    }

    /// Number of the rarest shape.
    pub fn least(&self) -> u32 {
        self.0.values().copied().min().unwrap_or(0)
    }
}

impl fmt::Display for Shapes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = ALL.map(|name| format!("{} {name}", self.0.get(name).unwrap_or(&0)));
        f.write_str(&counts.join(", "))
    }
}

/// Returns true if a line is a pointer of this class.
fn is_label(line: &str, class: char) -> bool {
    let number = line.strip_prefix(class).unwrap_or_default();
    !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
}
