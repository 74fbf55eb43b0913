// A board that comes at random times: what the interpreter and emitted Rust run on.

use rungc_rt::board::{
    Counted, CounterInput, Driver, EdgeInterrupt, EdgeQueue, InputEdge, PulseOutput, Setup,
    SharedAxes, Timebase, send_pulses,
};
use rungc_rt::{Axis, Class, Hal, Program};

const STEPS: u32 = 60_000;
const SCAN_US: u32 = 5_000;

/// The time of the board wraps while it runs.
const BEGIN_US: u32 = 0u32.wrapping_sub(300_000);

/// In a run with an interrupt: how long the code between two instructions that send or count pulses takes.
const INSTRUCTIONS_US: u32 = 700;
/// Minimum interval of such interrupts.
pub const INTERRUPT_US: u32 = 5;

/// Numbers that look random; the firmware in C has the same.
struct Numbers(u32);

impl Numbers {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) % end
    }
}

/// Pins, counters and a queue of edges.
struct Rig {
    now_us: u32,
    /// Time at which the timer is to call.
    due: Option<u32>,
    /// Axes taken by the timer's interrupt, if it comes while a scan runs.
    shared: Option<SharedAxes<1>>,
    /// The longest that it was late.
    late_us: u32,
    pulses: u32,
    quarter: i32,
    quarter_asked: i32,
    levels: [bool; 3],
    edges: EdgeQueue<64>,
    outputs: [bool; 6],
    changes: String,
}

impl Rig {
    fn new(interrupts: bool) -> Self {
        Rig {
            now_us: BEGIN_US,
            due: None,
            shared: interrupts.then_some([None]),
            late_us: 0,
            pulses: 0,
            quarter: 0,
            quarter_asked: 0,
            levels: [false; 3],
            edges: EdgeQueue::new(),
            outputs: [false; 6],
            changes: String::new(),
        }
    }

    /// Time passes; the interrupt comes when it is to.
    fn pass(&mut self, us: u32) {
        if self.shared.is_none() {
            self.now_us = self.now_us.wrapping_add(us);
            return;
        }
        let mut left = us;
        while left > 0 {
            let step = left.min(INTERRUPT_US);
            left -= step;
            self.now_us = self.now_us.wrapping_add(step);
            if let Some(late_us) = self.late() {
                self.late_us = self.late_us.max(late_us);
                self.interrupt();
            }
        }
    }

    /// Delay of the timer, if it is to call.
    fn late(&self) -> Option<u32> {
        let late = self.now_us.wrapping_sub(self.due?);
        (late <= u32::MAX / 2).then_some(late)
    }

    /// The timer's interrupt.
    fn interrupt(&mut self) {
        if let Some(mut shared) = self.shared.take() {
            let wait = send_pulses(&mut shared, self.now_us, |n, on| self.set_output(n, on));
            self.wake_in(wait);
            self.shared = Some(shared);
        }
    }
}

impl Hal for Rig {
    fn input(&mut self, number: u16) -> Option<bool> {
        Some(number == 6)
    }

    fn set_output(&mut self, number: u16, value: bool) {
        let on = &mut self.outputs[usize::from(number)];
        if *on != value {
            *on = value;
            let line = format!("{} Y{number} {}\n", self.now_us, u8::from(value));
            self.changes.push_str(&line);
        }
    }

    fn with_pulses(&mut self, work: &mut dyn FnMut(&mut [Option<Axis>])) {
        self.pass(if self.shared.is_some() {
            INSTRUCTIONS_US
        } else {
            0
        });
        match self.shared.take() {
            Some(mut shared) => {
                work(&mut shared);
                self.shared = Some(shared);
            }
            None => work(&mut []),
        }
    }
}

impl Timebase for Rig {
    fn now_us(&mut self) -> u32 {
        self.now_us
    }
}

impl EdgeInterrupt for Rig {
    fn next_edge(&mut self) -> Option<InputEdge> {
        self.edges.take()
    }

    fn notes_edges(&self, input: u32) -> bool {
        matches!(input, 1 | 2)
    }
}

impl CounterInput for Rig {
    fn counted(&mut self, counter: u32) -> Option<Counted> {
        match counter {
            0 => Some(Counted::Pulses {
                input: 0,
                count: std::mem::take(&mut self.pulses),
            }),
            1 => {
                let from = std::mem::replace(&mut self.quarter_asked, self.quarter);
                Some(Counted::Quarters {
                    a: 3,
                    b: 4,
                    from: from as u32,
                    count: self.quarter - from,
                })
            }
            _ => None,
        }
    }

    fn counts(&self, input: u32) -> bool {
        matches!(input, 0 | 3 | 4)
    }
}

impl PulseOutput for Rig {
    fn wake_in(&mut self, us: Option<u32>) {
        self.due = us.map(|us| self.now_us.wrapping_add(us));
    }
}

/// Inputs and results of a run.
#[derive(Default)]
pub struct Run {
    pub pulses: u32,
    pub rises: [u32; 3],
    pub quarter: i32,
    /// Largest delay of the interrupt, in microseconds.
    pub late_us: u32,
    /// Changes of pins with their times, and the counters at the end.
    pub trace: String,
}

/// Runs a program; `interrupts`: the timer's comes while scans run.
pub fn run(program: impl Program, interrupts: bool) -> Run {
    let setup = Setup {
        inputs: 8,
        outputs: 6,
        scan_us: SCAN_US,
    };
    let mut driver = Driver::new(program, Rig::new(interrupts), setup);
    let mut numbers = Numbers(5);
    let mut run = Run::default();
    driver.poll();
    for _ in 0..STEPS {
        let board = &mut driver.board;
        board.pass(1 + numbers.below(20));
        if numbers.below(1000) == 0 {
            board.pass(numbers.below(8000));
        }
        let pulses = numbers.below(12);
        board.pulses += pulses;
        run.pulses += pulses;
        board.quarter += numbers.below(4) as i32 - 1;
        let number = 1 + numbers.below(20) as usize;
        if number <= 2 {
            let level = &mut board.levels[number];
            *level = !*level;
            run.rises[number] += u32::from(*level);
            assert!(board.edges.note(InputEdge {
                input: number as u32,
                level: *level,
            }));
        }
        if !interrupts && board.late().is_some() {
            driver.on_timer();
        }
        if numbers.below(3) == 0 {
            driver.poll();
            // A comparison shows at the pin before the next scan.
            let switched = (10_001..100_001).contains(&run.pulses);
            assert_eq!(driver.board.outputs[1], switched);
        }
    }
    driver.poll();
    let plc = &driver.program;
    let count = |number| plc.counter32(number).expect("it is stored");
    let end = format!(
        "C235 {} C237 {} C253 {} D0 {}\n",
        count(235),
        count(237),
        count(253),
        plc.word(Class::D, 0).expect("it is stored")
    );
    run.quarter = driver.board.quarter;
    run.late_us = driver.board.late_us;
    run.trace = driver.board.changes + &end;
    run
}
