//! A board that comes at random times, on the interpreter and on emitted C: each edge and each pulse counts once, whoever counts it, comparisons
//! act at the count, and a move has as many pulses as it was given.

use rungc_codegen_c::{Options, emit};
use rungc_ir::compile::{CompileOptions, compile};
use rungc_ir::{ModelId, Module};
use rungc_rt::board::{
    Counted, CounterInput, Driver, EdgeInterrupt, InputEdge, PulseOutput, Setup, Timebase,
};
use rungc_rt::{Class, Hal, Plc};
use rungc_sim::Machine;
use std::collections::VecDeque;
use std::process::Command;

/// X0 has a hardware counter, X3 and X4 an encoder with one; the edges of X1 and X2 are noted, X6 is read.
const PROGRAM: &str = "\
EI
LD M8000
OUT C235 K1000000
DHSCS K10001 C235 Y1
DHSCR K100001 C235 Y1
OUT C237 K1000000
OUT C253 K1000000
LD X6
DRVI K2000 K20000 Y0 Y4
OUT Y5
FEND
I101
LD M8000
INC D0
IRET
END
";

const STEPS: u32 = 60_000;
const SCAN_US: u32 = 5_000;

/// The time of the board wraps while it runs.
const BEGIN_US: u32 = 0u32.wrapping_sub(300_000);

fn module() -> Module {
    let read = rungc_frontend::read_text("bench.il", PROGRAM);
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled
        .module
        .unwrap_or_else(|| panic!("{:?}", compiled.diagnostics))
}

/// Numbers that look random; the firmware has the same.
struct Numbers(u32);

impl Numbers {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) % end
    }
}

/// Pins, counters and a queue of edges.
#[derive(Default)]
struct Bench {
    now_us: u32,
    armed: Option<u32>,
    pulses: u32,
    quarter: i32,
    quarter_asked: i32,
    levels: [bool; 3],
    edges: VecDeque<InputEdge>,
    outputs: [bool; 6],
    changes: String,
}

impl Bench {
    fn pass(&mut self, us: u32) {
        self.now_us = self.now_us.wrapping_add(us);
    }

    fn is_due(&self) -> bool {
        let late = |due| self.now_us.wrapping_sub(due) as i32;
        self.armed.is_some_and(|due| late(due) >= 0)
    }
}

impl Hal for Bench {
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
}

impl Timebase for Bench {
    fn now_us(&mut self) -> u32 {
        self.now_us
    }
}

impl EdgeInterrupt for Bench {
    fn next_edge(&mut self) -> Option<InputEdge> {
        self.edges.pop_front()
    }

    fn notes_edges(&self, input: u32) -> bool {
        matches!(input, 1 | 2)
    }
}

impl CounterInput for Bench {
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

impl PulseOutput for Bench {
    fn wake_in(&mut self, us: Option<u32>) {
        self.armed = us.map(|us| self.now_us.wrapping_add(us));
    }
}

/// What a run has to end with.
#[derive(Default)]
struct Given {
    pulses: u32,
    rises: [u32; 3],
    quarter: i32,
}

fn interpreted(module: &Module) -> (String, Given) {
    let setup = Setup {
        inputs: 8,
        outputs: 6,
        scan_us: SCAN_US,
    };
    let board = Bench {
        now_us: BEGIN_US,
        ..Bench::default()
    };
    let mut driver = Driver::new(Machine::new(module), board, setup);
    let mut numbers = Numbers(5);
    let mut given = Given::default();
    driver.poll();
    for _ in 0..STEPS {
        let board = &mut driver.board;
        board.pass(1 + numbers.below(20));
        if numbers.below(1000) == 0 {
            board.pass(numbers.below(8000));
        }
        let pulses = numbers.below(12);
        board.pulses += pulses;
        given.pulses += pulses;
        board.quarter += numbers.below(4) as i32 - 1;
        let number = 1 + numbers.below(20) as usize;
        if number <= 2 {
            let level = &mut board.levels[number];
            *level = !*level;
            given.rises[number] += u32::from(*level);
            board.edges.push_back(InputEdge {
                input: number as u32,
                level: *level,
            });
        }
        if board.is_due() {
            driver.on_timer();
        }
        if numbers.below(3) == 0 {
            driver.poll();
            // A comparison shows at the pin before the next scan.
            let switched = (10_001..100_001).contains(&given.pulses);
            assert_eq!(driver.board.outputs[1], switched);
        }
    }
    driver.poll();
    given.quarter = driver.board.quarter;
    let plc = &driver.program;
    let count = |number| plc.counter32(number).expect("it is stored");
    let end = format!(
        "C235 {} C237 {} C253 {} D0 {}\n",
        count(235),
        count(237),
        count(253),
        plc.word(Class::D, 0).expect("it is stored")
    );
    (driver.board.changes + &end, given)
}

/// The same in C.
const FIRMWARE: &str = r#"
#include "bench_board.h"
#include <stdio.h>

static bench_plc plc;
static uint32_t seed = 5, now = 0u - 300000u, due, pulses;
static int32_t quarter, quarter_asked;
static bool armed, levels[3], outputs[6];
static int held;
static rungc_edge edges[10000];
static unsigned first_edge, edge_count;

static uint32_t below(uint32_t end)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 16) % end;
}

static bool input(void *context, uint16_t number, bool *on)
{
    (void)context;
    *on = number == 6u;
    return true;
}

static void set_output(void *context, uint16_t number, bool on)
{
    (void)context;
    if (outputs[number] != on) {
        outputs[number] = on;
        printf("%lu Y%u %d\n", (unsigned long)now, (unsigned)number, on);
    }
}

static void hold_pulses(void *context, bool hold)
{
    (void)context;
    held += hold ? 1 : -1;
}

static uint32_t now_us(void *context)
{
    (void)context;
    return now;
}

static bool next_edge(void *context, rungc_edge *edge)
{
    (void)context;
    if (first_edge == edge_count) {
        return false;
    }
    *edge = edges[first_edge++];
    return true;
}

static bool counted(void *context, unsigned counter, rungc_count *count)
{
    (void)context;
    if (counter == 0u) {
        *count = (rungc_count){.input = 0, .phase_b = 0, .from = 0, .count = (int32_t)pulses};
        pulses = 0;
    } else {
        *count = (rungc_count){.input = 3, .phase_b = 4, .from = (uint32_t)quarter_asked, .count = quarter - quarter_asked};
        quarter_asked = quarter;
    }
    return counter < 2u;
}

static void wake_in(void *context, uint32_t us)
{
    (void)context;
    armed = us != UINT32_MAX;
    due = now + us;
}

int main(void)
{
    static rungc_board board = {
        .hal = {.input = input, .set_output = set_output, .hold_pulses = hold_pulses},
        .now_us = now_us,
        .next_edge = next_edge,
        .counted = counted,
        .wake_in = wake_in,
        .followed = 0x1Fu,
        .period_us = 5000u,
    };
    bench_init(&plc);
    bench_poll(&plc, &board);
    for (unsigned i = 0; i < 60000u; i++) {
        now += 1u + below(20u);
        if (below(1000u) == 0u) {
            now += below(8000u);
        }
        pulses += below(12u);
        quarter += (int32_t)below(4u) - 1;
        const uint32_t number = 1u + below(20u);
        if (number <= 2u) {
            levels[number] = !levels[number];
            edges[edge_count++] = (rungc_edge){.input = (uint16_t)number, .on = levels[number]};
        }
        if (armed && (int32_t)(now - due) >= 0) {
            bench_on_timer(&plc, &board);
        }
        if (below(3u) == 0u) {
            bench_poll(&plc, &board);
        }
    }
    bench_poll(&plc, &board);
    printf("C235 %ld C237 %ld C253 %ld D0 %d\n", (long)plc.C235.value, (long)plc.C237.value, (long)plc.C253.value, plc.D0);
    return held;
}
"#;

fn write(module: &Module, path: &std::path::Path) {
    for file in emit(module, &Options::default()) {
        let path = path.join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
        std::fs::write(path, file.text).expect("writing");
    }
}

fn shell(line: &str, path: &std::path::Path) -> String {
    let done = Command::new("sh")
        .args(["-c", line])
        .env("CARGO_NET_OFFLINE", "true")
        .current_dir(path)
        .output()
        .expect("a shell");
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    String::from_utf8_lossy(&done.stdout).into_owned()
}

const CFLAGS: &str = "-std=c99 -O1 -Wall -Wextra -Wconversion -pedantic -Werror";

#[test]
fn nothing_is_lost_between_board_and_program() {
    let module = module();
    let (interpreted, given) = interpreted(&module);
    let rises = |pin: &str| interpreted.lines().filter(|l| l.ends_with(pin)).count();
    assert_eq!(rises(" Y0 1"), 2000);
    assert_eq!(rises(" Y0 0"), 2000);
    assert_eq!(rises(" Y5 1"), 1);
    // Pulses come by the dozen, and yet each comparison found its count.
    assert_eq!((rises(" Y1 1"), rises(" Y1 0")), (1, 1));
    // Counted once, an encoder's cycle counts where B changes while A is on.
    let cycles = (given.quarter + 2).div_euclid(4);
    let [_, interrupts, edges] = given.rises;
    let end = format!(
        "C235 {} C237 {edges} C253 {cycles} D0 {interrupts}",
        given.pulses
    );
    assert_eq!(interpreted.lines().last(), Some(&*end));
    assert!(given.pulses > 300_000 && edges > 1000 && interrupts > 1000 && cycles > 5000);

    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&module, folder.path());
    std::fs::write(folder.path().join("firmware.c"), FIRMWARE).expect("writing");
    let build = format!(
        "make -s CFLAGS='{CFLAGS}' && \
         cc {CFLAGS} -o firmware firmware.c libbench.a rungc-rt/target/release/librungc_rt.a && ./firmware"
    );
    let compiled = shell(&build, folder.path());
    let pairs = compiled.lines().zip(interpreted.lines());
    let differs = pairs.clone().find(|(c, sim)| c != sim);
    assert_eq!(differs, None);
    assert_eq!(compiled.lines().count(), interpreted.lines().count());
}

/// Without pulses nothing is linked, and a board may lack what it does not need.
#[test]
fn counters_alone_need_no_library() {
    let text = "LD M8000\nOUT C235 K10\nLD C235\nOUT Y1\nEND\n";
    let read = rungc_frontend::read_text("count.il", text);
    let compiled = compile(&read.program, &CompileOptions::default());
    let module = compiled.module.expect("it compiles");
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&module, folder.path());
    assert!(!folder.path().join("rungc-rt").exists());
    let firmware = r#"
#include "count_board.h"
static unsigned left;
static uint32_t now_us(void *context)
{
    (void)context;
    return 0;
}
static bool next_edge(void *context, rungc_edge *edge)
{
    (void)context;
    if (left == 0u) {
        return false;
    }
    left--;
    *edge = (rungc_edge){.input = 0, .on = left % 2u == 1u};
    return true;
}
int main(void)
{
    static count_plc plc;
    static rungc_board board = {.now_us = now_us, .next_edge = next_edge};
    count_init(&plc);
    count_poll(&plc, &board);
    left = 20;
    count_poll(&plc, &board);
    return !(plc.C235.value == 10 && plc.Y1);
}
"#;
    std::fs::write(folder.path().join("firmware.c"), firmware).expect("writing");
    let build = format!(
        "make -s CFLAGS='{CFLAGS}' && cc {CFLAGS} -o firmware firmware.c libcount.a && ./firmware"
    );
    shell(&build, folder.path());
}
