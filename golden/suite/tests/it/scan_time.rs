//! Scans of constant length on a board (M8039, D8039): when they begin, on the interpreter and on emitted C.

use rungc_codegen_c::{Options, emit};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::board::{CounterInput, Driver, EdgeInterrupt, PulseOutput, Setup, Timebase};
use rungc_rt::{Class, Hal, Plc};
use rungc_sim::engines::host_runtime;
use std::fmt::Write;
use std::process::Command;

/// REF is what takes time. An input interrupt makes the compiler write the wiring of the board.
const PROGRAM: &str = "\
EI
LDI X010
OUT M8039
LD M8000
MOV K30 D8039
INC D0
MOV D8010 D1
OUT Y0
REF Y0 K8
FEND
I001
LD M8000
INC D9
IRET
END
";

/// Duration of a poll, and the time until the next one, in microseconds.
const POLL_US: u32 = 50;
/// The board's own period.
const PERIOD_US: u32 = 10_000;
/// From when until when a scan takes 70 ms.
const SLOW_US: (u32, u32) = (200_000, 250_000);
/// From when on the program asks for nothing.
const FREE_US: u32 = 500_000;
/// End of the run.
const END_US: u32 = 600_000;

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

/// A board with nothing but time.
struct Bench {
    now_us: u32,
}

impl Hal for Bench {
    fn input(&mut self, number: u16) -> Option<bool> {
        Some(number == 8 && self.now_us >= FREE_US)
    }

    fn set_output(&mut self, number: u16, _: bool) {
        // Once in a REF, and once more when the scan is over.
        if number == 0 && (SLOW_US.0..SLOW_US.1).contains(&self.now_us) {
            self.now_us += 35_000;
        }
    }
}

impl Timebase for Bench {
    fn now_us(&mut self) -> u32 {
        self.now_us
    }
}

impl EdgeInterrupt for Bench {}
impl CounterInput for Bench {}
impl PulseOutput for Bench {}

/// Times at which each scan was seen to have run, and its D8010.
fn interpreted(module: &Module) -> String {
    let setup = Setup {
        inputs: 9,
        outputs: 1,
        scan_us: PERIOD_US,
    };
    let mut driver = Driver::new(Machine::new(module), Bench { now_us: 0 }, setup);
    let (mut trace, mut scans) = (String::new(), 0);
    while driver.board.now_us < END_US {
        let began = driver.board.now_us;
        driver.poll();
        let count = driver.program.word(Class::D, 0).expect("it exists");
        if count != scans {
            scans = count;
            let shown = driver.program.word(Class::D, 1).expect("it exists");
            let _ = writeln!(trace, "{began} {count} {shown}");
        }
        driver.board.now_us += POLL_US;
    }
    trace
}

const FIRMWARE: &str = r#"
#include "bench_board.h"
#include <stdio.h>

static bench_plc plc;
static uint32_t now;

static uint32_t now_us(void *context)
{
    (void)context;
    return now;
}

static bool input(void *context, uint16_t number, bool *on)
{
    (void)context;
    *on = number == 8u && now >= FREE;
    return true;
}

static void set_output(void *context, uint16_t number, bool on)
{
    (void)context;
    (void)on;
    if (number == 0u && now >= SLOW_FROM && now < SLOW_TO) {
        now += 35000u;
    }
}

int main(void)
{
    static rungc_board board = {.hal = {.input = input, .set_output = set_output}, .now_us = now_us, .period_us = PERIOD};
    int scans = 0;
    bench_init(&plc);
    for (; now < END; now += POLL) {
        const uint32_t began = now;
        bench_poll(&plc, &board);
        if (plc.D0 != scans) {
            scans = plc.D0;
            printf("%lu %d %d\n", (unsigned long)began, scans, plc.D1);
        }
    }
    return 0;
}
"#;

#[test]
fn scans_of_constant_length_begin_on_time() {
    let trace = interpreted(&module());
    let begins: Vec<u32> = trace
        .lines()
        .filter_map(|line| line.split(' ').next()?.parse().ok())
        .collect();
    let shown: Vec<u32> = trace
        .lines()
        .filter_map(|line| line.split(' ').nth(2)?.parse().ok())
        .collect();
    let gaps: Vec<u32> = begins.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // 30 ms each until one that takes 70 ms (35 ms of them after the scan itself); then at once, then 30 ms again; then
    // as the board likes.
    assert_eq!(
        begins[..8],
        [
            0, 30_000, 60_000, 90_000, 120_000, 150_000, 180_000, 210_000
        ]
    );
    let slow = 7;
    assert_eq!(gaps[slow], 70_000 + POLL_US);
    assert!(
        gaps[slow + 1..16].iter().all(|&gap| gap == 30_000),
        "{gaps:?}"
    );
    assert_eq!(gaps.last(), Some(&PERIOD_US));
    // D8010 shows the wait, too, and the slow scan in the one after it.
    assert_eq!((shown[0], shown[1], shown[slow + 1]), (0, 300, 350));
}

#[test]
fn emitted_c_begins_them_at_the_same_times() {
    let module = module();
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in emit(&module, &Options::default()) {
        let path = folder.path().join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
        std::fs::write(path, file.contents).expect("writing");
    }
    std::fs::write(folder.path().join("firmware.c"), FIRMWARE).expect("writing");
    let flags = "-std=c99 -O1 -Wall -Wextra -Wconversion -pedantic -Werror";
    let (from, to) = SLOW_US;
    let defines = format!(
        "-DPOLL={POLL_US}u -DPERIOD={PERIOD_US}u -DSLOW_FROM={from}u -DSLOW_TO={to}u -DFREE={FREE_US}u -DEND={END_US}u"
    );
    let runtime = host_runtime().expect("the runtime is built");
    let build = format!(
        "make -s RUNGC_RT=$RUNTIME CFLAGS='{flags}' && \
         cc {flags} {defines} -o firmware firmware.c libbench.a $RUNTIME && ./firmware"
    );
    let done = Command::new("sh")
        .args(["-c", &build])
        .env("RUNTIME", runtime)
        .current_dir(folder.path())
        .output()
        .expect("a shell");
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    assert_eq!(String::from_utf8_lossy(&done.stdout), interpreted(&module));
}
