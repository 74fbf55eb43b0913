//! Clocks of boards and hosts that begin anywhere, wrap, are misread and stand still: programs behave as with a perfect
//! one.

use rungc_codegen_c::{Options, emit};
use rungc_golden::module;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_models::ModelId;
use rungc_rt::board::{
    CharQueue, CounterInput, Driver, EdgeInterrupt, PulseOutput, Setup, Timebase,
};
use rungc_rt::comm::{CharFault, LineFormat, Received};
use rungc_rt::{Class, Hal, NoHal, Plc, Program, SerialPort};
use rungc_sim::engines::host_runtime;
use std::collections::VecDeque;
use std::fmt::Write;
use std::process::Command;

/// A timer of 5 s, a clock relay, a timer interrupt each 10 ms, and the longest scan.
const TIMED: &str = "\
EI
LD X000
OUT T0 K50
LD T0
OUT Y000
LD M8013
OUT Y001
LD M8000
MOV D8012 D0
MOV D8010 D2
FEND
I610
LD M8000
INC D1
IRET
END
";

/// A slave of Modbus at COM1.
const SLAVE: &str = "\
LD M8002
MOV H81 D8120
MOV K1 D8121
MOV H2 D8126
LD M8000
INC D10
END
";

/// First readings in microseconds.
const BEGINS: [u32; 6] = [
    0,
    1_100_000,
    0x7FFF_F000,
    0x8000_0400,
    4_294_000_000,
    u32::MAX,
];

/// A clock: its first reading, and by how much it is read back now and then, in its units.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Misread {
    begin: u32,
    behind: u32,
}

impl Misread {
    /// Each of the first readings, read well and badly. A second has this many units.
    fn all(second: u32) -> impl Iterator<Item = Misread> {
        let behind = [0, second / 1000, second / 15, second];
        BEGINS
            .into_iter()
            .flat_map(move |begin| behind.map(|behind| Misread { begin, behind }))
    }
}

/// Results of a run: when the timer was done and the clock relay changed, in 50 ms since it began; the longest scan,
/// and
/// interrupts in tens.
fn shown(done: u32, changes: &[u32], most: i16, interrupts: i16) -> String {
    let mut text = format!("{done}:");
    for change in changes {
        let _ = write!(text, " {change}");
    }
    let _ = writeln!(text, "; {most} {}", (interrupts + 3) / 10);
    text
}

/// A board whose clock is misread at each hundredth poll.
struct Bench {
    now_us: u32,
    behind_us: u32,
}

impl Hal for Bench {
    fn input(&mut self, number: u16) -> Option<bool> {
        Some(number == 0)
    }
}

impl Timebase for Bench {
    fn now_us(&mut self) -> u32 {
        self.now_us.wrapping_sub(self.behind_us)
    }
}

impl EdgeInterrupt for Bench {}
impl CounterInput for Bench {}
impl PulseOutput for Bench {}

fn on_a_board(module: &Module, clock: Misread) -> String {
    let setup = Setup {
        inputs: 1,
        outputs: 2,
        scan_us: 5000,
    };
    let bench = Bench {
        now_us: clock.begin,
        behind_us: 0,
    };
    let mut driver = Driver::new(Machine::new(module), bench, setup);
    let (mut done, mut changes, mut on) = (0, Vec::new(), false);
    for poll in 0..24_000_u32 {
        driver.board.now_us = clock.begin.wrapping_add(500 * poll);
        driver.board.behind_us = if poll % 100 == 51 { clock.behind } else { 0 };
        driver.poll();
        let units = (poll + 5) / 100;
        if done == 0 && driver.program.output(0) {
            done = units;
        }
        if driver.program.output(1) != on {
            on = !on;
            changes.push(units);
        }
    }
    let word = |number| driver.program.word(Class::D, number).expect("it exists");
    shown(done, &changes, word(0), word(1))
}

const BOARD: &str = include_str!("clocks/board.c");
const HOST: &str = include_str!("clocks/host.c");
const LINE: &str = include_str!("clocks/line.c");

const CFLAGS: &str = "-std=c99 -O1 -Wall -Wextra -Wconversion -pedantic -Werror";

/// Output of firmware around an emitted program.
fn in_c(module: &Module, firmware: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in emit(
        module,
        &Options {
            board: true,
            ..Options::default()
        },
    ) {
        let path = folder.path().join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
        std::fs::write(path, file.contents).expect("writing");
    }
    std::fs::write(folder.path().join("firmware.c"), firmware).expect("writing");
    let runtime = match folder.path().join("rungc-rt").exists() {
        true => host_runtime().expect("the runtime is built"),
        false => "".into(),
    };
    let line = format!(
        "make -s RUNGC_RT=$RUNTIME CFLAGS='{CFLAGS}' && cc {CFLAGS} -o firmware firmware.c libtest.a $RUNTIME && ./firmware"
    );
    let done = Command::new("sh")
        .args(["-c", &line])
        .env("RUNTIME", runtime)
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    String::from_utf8_lossy(&done.stdout).into_owned()
}

/// The list of first readings for C.
fn definitions() -> String {
    let begins = BEGINS.map(|begin| format!("{begin}u")).join(", ");
    format!("#define BEGINS {{{begins}}}\n")
}

#[test]
fn on_a_board_time_passes_evenly() {
    let module = module(TIMED, ModelId::Fx2n);
    let runs: Vec<String> = Misread::all(1_000_000)
        .map(|clock| on_a_board(&module, clock))
        .collect();
    let expected = on_a_board(
        &module,
        Misread {
            begin: 0,
            behind: 0,
        },
    );
    assert!(expected.starts_with("100: 10 20 30 "), "{expected}");
    assert!(expected.ends_with("; 0 120\n"), "{expected}");
    for (run, clock) in runs.iter().zip(Misread::all(1_000_000)) {
        assert_eq!(*run, expected, "{clock:?}");
    }
    assert_eq!(in_c(&module, &(definitions() + BOARD)), runs.concat());
}

/// A host's clock: readings in milliseconds.
fn on_a_host(module: &Module, clock: Misread) -> String {
    let mut plc = Machine::new(module);
    let (mut done, mut changes, mut on) = (0, Vec::new(), false);
    plc.set_bit(Class::X, 0, true);
    for ms in 0..12_000_u32 {
        let now_ms = clock.begin.wrapping_add(ms);
        let behind = if ms % 100 == 51 { clock.behind } else { 0 };
        plc.tick(&mut NoHal, now_ms.wrapping_sub(behind));
        if ms % 5 == 1 || ms == 0 {
            plc.scan(&mut NoHal, now_ms.wrapping_sub(behind), 0);
        }
        let units = (ms + 5) / 50;
        if done == 0 && plc.output(0) {
            done = units;
        }
        if plc.output(1) != on {
            on = !on;
            changes.push(units);
        }
    }
    let word = |number| plc.word(Class::D, number).expect("it exists");
    let text = shown(done, &changes, word(0), word(1));
    // A scan that is longer than D8010 shows.
    plc.scan(&mut NoHal, clock.begin.wrapping_add(12_000), u32::MAX);
    text + &format!("{}\n", plc.word(Class::D, 2).expect("it exists"))
}

#[test]
fn on_a_host_time_passes_evenly() {
    let module = module(TIMED, ModelId::Fx2n);
    let runs: Vec<String> = Misread::all(1000)
        .map(|clock| on_a_host(&module, clock))
        .collect();
    assert!(runs[0].starts_with("100: 10 20 30 "), "{}", runs[0]);
    assert!(runs[0].ends_with("; 0 120\n32767\n"), "{}", runs[0]);
    for (run, clock) in runs.iter().zip(Misread::all(1000)) {
        assert_eq!(*run, runs[0], "{clock:?}");
    }
    assert_eq!(in_c(&module, &(definitions() + HOST)), runs.concat());
}

/// A pause of an hour: a timer may be done after it, but time passes on.
#[test]
fn a_board_that_pauses_continues() {
    let module = module(TIMED, ModelId::Fx2n);
    for pause_us in [1_800_000_000_u32, 2_400_000_000, 3_600_000_000] {
        let setup = Setup {
            inputs: 1,
            outputs: 2,
            scan_us: 5000,
        };
        let bench = Bench {
            now_us: 7,
            behind_us: 0,
        };
        let mut driver = Driver::new(Machine::new(&module), bench, setup);
        driver.poll();
        driver.board.now_us += pause_us;
        driver.poll();
        let before = driver.program.word(Class::D, 1);
        for _ in 0..12_000 {
            driver.board.now_us = driver.board.now_us.wrapping_add(500);
            driver.poll();
        }
        assert!(driver.program.output(0), "{pause_us}");
        let interrupts = driver
            .program
            .word(Class::D, 1)
            .zip(before)
            .map(|(after, before)| after - before);
        assert!(
            interrupts.is_some_and(|n| (598..=601).contains(&n)),
            "{pause_us}: {interrupts:?}"
        );
    }
}

/// A board with a serial line. Its interrupt notes characters, and what it sends takes its time.
#[derive(Default)]
struct Line {
    now_us: u32,
    behind_us: u32,
    received: VecDeque<Received>,
    queue: Option<Box<CharQueue<64>>>,
    sent: u32,
    out_us: u32,
}

/// Microseconds of a character at 9600 bit/s.
const CHARACTER_US: u32 = 1042;

impl SerialPort for Line {
    fn set_format(&mut self, _: LineFormat) {}
    fn receive(&mut self, now_us: u32) -> Option<Received> {
        self.queue.as_ref()?.take(now_us)
    }
    fn send(&mut self, _: u8, _: u32) -> bool {
        self.sent += 1;
        if self.out_us.wrapping_sub(self.now_us) as i32 <= 0 {
            self.out_us = self.now_us;
        }
        self.out_us = self.out_us.wrapping_add(CHARACTER_US);
        true
    }
    fn unsent(&mut self, _: u32) -> u16 {
        let left = self.out_us.wrapping_sub(self.now_us) as i32;
        left.max(0).cast_unsigned().div_ceil(CHARACTER_US) as u16
    }
}

impl Hal for Line {
    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        (number == 1).then_some(self as &mut dyn SerialPort)
    }
}

impl Timebase for Line {
    fn now_us(&mut self) -> u32 {
        self.now_us.wrapping_sub(self.behind_us)
    }
}

impl EdgeInterrupt for Line {}
impl CounterInput for Line {}
impl PulseOutput for Line {}

/// Reads D10 by Modbus RTU.
const REQUEST: [u8; 8] = [1, 3, 0, 10, 0, 1, 0xA4, 0x08];

/// Requests of ten that are answered within a second each.
fn answered(module: &Module, clock: Misread) -> u32 {
    let setup = Setup {
        inputs: 0,
        outputs: 0,
        scan_us: 5000,
    };
    let line = Line {
        now_us: clock.begin,
        out_us: clock.begin,
        queue: Some(Box::new(CharQueue::new())),
        ..Line::default()
    };
    let mut driver = Driver::new(Machine::new(module), line, setup);
    let mut answered = 0;
    for request in 0..11 {
        driver.board.sent = 0;
        if request > 0 {
            let at = |n: u32| driver.board.now_us.wrapping_add(n * CHARACTER_US);
            driver.board.received = (0..)
                .zip(REQUEST)
                .map(|(n, byte)| Received {
                    at_us: at(n),
                    byte,
                    fault: CharFault::None,
                })
                .collect();
        }
        for poll in 0..5000_u32 {
            let board = &mut driver.board;
            while let Some(next) = board.received.front()
                && board.now_us.wrapping_sub(next.at_us) as i32 >= 0
                && let Some(queue) = &board.queue
            {
                queue.note(*next);
                board.received.pop_front();
            }
            board.behind_us = if poll % 100 == 51 { clock.behind } else { 0 };
            driver.poll();
            driver.board.now_us = driver.board.now_us.wrapping_add(200);
        }
        answered += u32::from(driver.board.sent == 7);
    }
    answered
}

#[test]
fn ports_answer_whatever_the_clock_says() {
    let module = module(SLAVE, ModelId::H2u);
    for clock in Misread::all(1_000_000) {
        assert_eq!(answered(&module, clock), 10, "{clock:?}");
    }
    let count = BEGINS.len() * 4;
    assert_eq!(in_c(&module, &(definitions() + LINE)), "10\n".repeat(count));
}
