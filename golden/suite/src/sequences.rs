//! Random step ladders: sequences of many states that branch, join and jump. Other rungs write states, too.

use crate::rng::Rng;
use rungc_ir::Module;
use rungc_ir::node::{Body, Steps, Stmt};
use rungc_ir::walk::bodies_mut;
use std::ops::Range;

/// A program of a few sequences, with rungs between them that write states as bits, as words and by an index.
pub fn program(seed: u64) -> String {
    let mut writer = Writer {
        rng: Rng::new(seed),
        lines: Vec::new(),
        timers: 0,
        labels: 0,
        states: 20..20 + 10 * (1 + (seed % 7) as u32),
    };
    let interrupts = seed.is_multiple_of(5);
    if interrupts {
        writer.line("EI");
    }
    writer.line("LD M8002");
    writer.line("SET S0");
    let mut first = writer.states.start;
    while first < writer.states.end {
        let count = 3 + writer.rng.below(14);
        writer.sequence(first..(first + count).min(writer.states.end));
        first += count + writer.rng.below(3);
        writer.rungs();
    }
    if interrupts {
        let state = writer.state();
        writer.lines.extend(
            ["FEND", "I001", "LD X003", &format!("SET S{state}"), "IRET"].map(str::to_string),
        );
    }
    writer.line("END");
    writer.lines.join("\n") + "\n"
}

/// Executes all blocks of a module's step ladders, active or not: the program that it stands for.
pub fn execute_all_blocks(module: &mut Module) {
    for function in &mut module.functions {
        inline(&mut function.body);
    }
}

fn inline(body: &mut Body) {
    for mut stmt in std::mem::take(body) {
        bodies_mut(&mut stmt).for_each(inline);
        match stmt {
            Stmt::Steps(Steps { body: blocks, .. }) => body.extend(blocks),
            other => body.push(other),
        }
    }
}

struct Writer {
    rng: Rng,
    lines: Vec<String>,
    /// Number of timers so far.
    timers: u32,
    /// Number of labels so far.
    labels: u32,
    /// The states of all sequences, apart from S0.
    states: Range<u32>,
}

impl Writer {
    fn line(&mut self, line: impl Into<String>) {
        self.lines.push(line.into());
    }

    /// Any state.
    fn state(&mut self) -> u32 {
        let count = self.states.end - self.states.start;
        self.states.start + self.rng.below(count)
    }

    fn contact(&mut self) {
        let input = self.rng.below(8);
        let line = match self.rng.below(8) {
            0 => format!("LDI X00{input}"),
            1 => format!("LDP X00{input}"),
            2 => format!("LD S{}", self.state()),
            3 => format!("LD T{}", self.rng.below(self.timers.max(1))),
            _ => format!("LD X00{input}"),
        };
        self.line(line);
    }

    /// The states of a sequence, in the order of their numbers or in another one.
    fn sequence(&mut self, states: Range<u32>) {
        let first = states.start;
        self.line("STL S0");
        self.contact();
        self.line(format!("SET S{first}"));
        if self.rng.percent(50) {
            self.line("RET");
        }
        let mut order: Vec<u32> = states.clone().collect();
        if self.rng.percent(20) {
            order.reverse();
        }
        for state in order {
            self.line(format!("STL S{state}"));
            self.actions();
            let next = if state + 1 < states.end {
                state + 1
            } else {
                first
            };
            self.transition(state, next, &states);
        }
        if states.len() > 4 && self.rng.percent(40) {
            self.line(format!("STL S{}", first + 1));
            self.line(format!("STL S{}", first + 3));
            self.contact();
            self.line(format!("SET S{first}"));
        }
        self.line("RET");
    }

    /// Coils of a state, some of which other states drive, too.
    fn actions(&mut self) {
        if self.rng.percent(70) {
            let output = self.rng.below(8);
            self.line(format!("OUT Y00{output}"));
        }
        match self.rng.below(8) {
            0 => {
                let relay = self.rng.below(10);
                self.line(format!("SET M{relay}"));
            }
            1 => {
                let relay = self.rng.below(10);
                self.contact();
                self.line(format!("PLS M{}", 20 + relay));
            }
            2..=4 if self.timers < 60 => {
                let preset = self.rng.below(6);
                self.line(format!("OUT T{} K{preset}", self.timers));
                self.timers += 1;
            }
            5 => {
                self.contact();
                self.line("INCP D0");
            }
            6 => {
                self.contact();
                self.line("OUT C0 K5");
            }
            7 if self.rng.percent(20) => {
                let state = self.state();
                self.contact();
                self.line(format!("RST S{state}"));
            }
            _ => {}
        }
        // A jump keeps a block from being left out.
        if self.labels < 60 && self.rng.percent(4) {
            let label = self.labels;
            self.labels += 1;
            self.contact();
            self.line(format!("CJ P{label}"));
            self.line("OUT M30");
            self.line(format!("P{label}"));
        }
    }

    fn transition(&mut self, state: u32, next: u32, states: &Range<u32>) {
        self.contact();
        let count = states.end - states.start;
        match self.rng.below(10) {
            // One of two.
            0 => {
                self.line(format!("SET S{next}"));
                self.contact();
                let other = states.start + self.rng.below(count);
                self.line(format!("OUT S{other}"));
            }
            // Both.
            1 => {
                let other = states.start + self.rng.below(count);
                self.line(format!("SET S{next}"));
                self.line(format!("SET S{other}"));
            }
            2 => self.line(format!("OUT S{next}")),
            3 => self.line(format!("RST S{state}")),
            4 => self.line("OUT S0"),
            _ => self.line(format!("SET S{next}")),
        }
    }

    /// Rungs outside the states that write them.
    fn rungs(&mut self) {
        for _ in 0..self.rng.below(4) {
            self.contact();
            let (state, other) = (self.state(), self.state());
            let line = match self.rng.below(12) {
                0 => format!("ZRST S{} S{}", state.min(other), state.max(other)),
                1 => format!("MOVP K{} K2S{state}", self.rng.below(256)),
                2 => format!("MOVP D0 K1S{state}Z0"),
                3 => format!("SET S{state}"),
                4 => format!("RST S{state}"),
                5 => "OUT M8040".to_string(),
                6 => "OUT M8034".to_string(),
                7 => "OUT M8047".to_string(),
                8 => "MOV D8040 D10".to_string(),
                9 => format!("MOV K{} Z0", self.rng.below(12)),
                10 => format!("FMOVP K{} K1S{state} K2", self.rng.below(16)),
                _ => format!("MOVP K4S{state} D11"),
            };
            self.line(line);
        }
    }
}
