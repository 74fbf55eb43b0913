//! A board that comes at random times, on the interpreter, on emitted C and on emitted Rust: each edge and each pulse
//! counts once, whoever counts it, comparisons act at the count, and a move has as many pulses as it was given. With an
//! interrupt that sends them they are on time while scans run.

use rungc_codegen_c::{Options, emit};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use std::path::Path;
use std::process::Command;

mod rig;

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

/// The same in C.
const FIRMWARE: &str = r#"
#include "bench_board.h"
#include <stdio.h>

static bench_plc plc;
static uint32_t seed = 5, now = 0u - 300000u, due, pulses;
static int32_t quarter, quarter_asked;
static bool armed, levels[3], outputs[6];
static int held;
static rungc_edges edges;

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
    return rungc_take_edge(&edges, edge);
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
            held += rungc_note_edge(&edges, (uint16_t)number, levels[number]) ? 0 : 1;
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

fn write(module: &Module, path: &Path) {
    for file in emit(module, &Options::default()) {
        let path = path.join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
        std::fs::write(path, file.contents).expect("writing");
    }
}

fn shell(line: &str, path: &Path) -> String {
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

/// Checks a run, whoever runs it.
fn check(run: &rig::Run) {
    let rises = |pin: &str| run.trace.lines().filter(|l| l.ends_with(pin)).count();
    assert_eq!(rises(" Y0 1"), 2000);
    assert_eq!(rises(" Y0 0"), 2000);
    assert_eq!(rises(" Y5 1"), 1);
    // Pulses come by the dozen, and yet each comparison found its count.
    assert_eq!((rises(" Y1 1"), rises(" Y1 0")), (1, 1));
    // Counted once, an encoder's cycle counts where B changes while A is on.
    let cycles = (run.quarter + 2).div_euclid(4);
    let [_, interrupts, edges] = run.rises;
    let pulses = run.pulses;
    let end = format!("C235 {pulses} C237 {edges} C253 {cycles} D0 {interrupts}");
    assert_eq!(run.trace.lines().last(), Some(&*end));
    assert!(pulses > 300_000 && edges > 1000 && interrupts > 1000 && cycles > 5000);
}

fn same(trace: &str, expected: &str) {
    let differs = trace.lines().zip(expected.lines()).find(|(a, b)| a != b);
    assert_eq!(differs, None);
    assert_eq!(trace.lines().count(), expected.lines().count());
}

#[test]
fn nothing_is_lost_between_board_and_program() {
    let module = module();
    let interpreted = rig::run(Machine::new(&module), false);
    check(&interpreted);
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&module, folder.path());
    std::fs::write(folder.path().join("firmware.c"), FIRMWARE).expect("writing");
    let build = format!(
        "make -s CFLAGS='{CFLAGS}' && \
         cc {CFLAGS} -o firmware firmware.c libbench.a && ./firmware"
    );
    same(&shell(&build, folder.path()), &interpreted.trace);
}

/// Scans and what they wait for take most of the time here, and no edge of a pulse waits for them.
#[test]
fn pulses_are_sent_while_scans_run() {
    let module = module();
    let run = rig::run(Machine::new(&module), true);
    check(&run);
    assert!(run.late_us <= rig::INTERRUPT_US, "{} us late", run.late_us);
}

const MAIN: &str = "\
mod rig;

fn main() {
    let interrupts = std::env::args().count() > 1;
    print!(\"{}\", rig::run(bench::Bench::new(), interrupts).trace);
}
";

const MANIFEST: &str = "\
[package]
name = \"firmware\"
version = \"0.1.0\"
edition = \"2024\"

[workspace]
exclude = [\"plc\"]

[dependencies]
bench = { path = \"plc\" }
rungc-rt = { path = \"plc/rungc-rt\" }
";

#[test]
fn emitted_rust_runs_on_the_same_board() {
    let module = module();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board");
    // Unchanged files are not built again.
    let put = |path: &str, text: &str| {
        let path = folder.join(path);
        if std::fs::read_to_string(&path).is_ok_and(|old| old == text) {
            return;
        }
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
        std::fs::write(path, text).expect("writing");
    };
    let options = rungc_codegen_rust::Options::default();
    for file in rungc_codegen_rust::emit(&module, &options) {
        put(&format!("plc/{}", file.path), &file.contents);
    }
    put("Cargo.toml", MANIFEST);
    put("src/main.rs", MAIN);
    put("src/rig.rs", include_str!("board/rig.rs"));
    for (interrupts, argument) in [(false, ""), (true, "-- interrupts")] {
        let line = format!("cargo run -q --target-dir target {argument}");
        let interpreted = rig::run(Machine::new(&module), interrupts);
        same(&shell(&line, &folder), &interpreted.trace);
    }
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
