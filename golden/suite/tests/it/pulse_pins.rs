//! Pins of pulse outputs, as firmware drives them from a timer: the interpreter and emitted C change them at the same
//! microseconds, and there are as many pulses as the program asked for.

use rungc_codegen_c::{Options, emit};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, Hal, Plc, Program};
use rungc_sim::engines::host_runtime;
use std::process::Command;

/// A move with ramps on Y000, and a signal of a fixed width on Y001.
const PROGRAM: &str = "\
LD X0
DRVI K2000 K20000 Y0 Y4
LD X0
PWM K3 K8 Y1
END
";
const SCAN_US: u32 = 10_000;
const SCANS: u32 = 30;

fn module() -> Module {
    let read = rungc_frontend::read_text("pins.il", PROGRAM);
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled.module.expect("the program compiles")
}

/// Pins that write down when they change.
#[derive(Default)]
struct Pins {
    now_us: u32,
    on: [bool; 2],
    changes: String,
}

impl Hal for Pins {
    fn set_output(&mut self, number: u16, value: bool) {
        let Some(on) = self.on.get_mut(usize::from(number)) else {
            return;
        };
        if *on != value {
            *on = value;
            let line = format!("{} Y{number} {}\n", self.now_us, u8::from(value));
            self.changes.push_str(&line);
        }
    }
}

fn interpreted(module: &Module) -> String {
    let mut machine = Machine::new(module);
    let mut pins = Pins::default();
    machine.set_bit(Class::X, 0, true).expect("X000 exists");
    for scan in 0..SCANS {
        let begin = scan * SCAN_US;
        machine.scan(&mut pins, begin / 1000, 0);
        pins.now_us = begin;
        while pins.now_us < begin + SCAN_US {
            let now_us = pins.now_us;
            let wait = machine.pulse_timer(&mut pins, now_us);
            pins.now_us = wait.map_or(u32::MAX, |wait| now_us + wait);
        }
    }
    pins.changes
}

/// The same in C.
const FIRMWARE: &str = r#"
#include "pins.h"
#include <stdio.h>

static uint32_t now_us;
static int held;

static void set_output(void *context, uint16_t number, bool on)
{
    static bool pins[2];
    (void)context;
    if (number < 2 && pins[number] != on) {
        pins[number] = on;
        printf("%lu Y%u %d\n", (unsigned long)now_us, (unsigned)number, on);
    }
}

static void hold_pulses(void *context, bool hold)
{
    (void)context;
    held += hold ? 1 : -1;
}

int main(void)
{
    static pins_plc plc;
    const rungc_hal board = {.set_output = set_output, .hold_pulses = hold_pulses};
    pins_init(&plc);
    plc.hal = &board;
    plc.X0 = true;
    for (uint32_t scan = 0; scan < 30u; scan++) {
        const uint32_t begin = scan * 10000u;
        pins_scan(&plc, begin / 1000u, 0u);
        now_us = begin;
        while (now_us < begin + 10000u) {
            const uint32_t wait = pins_pulse_timer(&plc, now_us);
            now_us = (wait == UINT32_MAX) ? UINT32_MAX : now_us + wait;
        }
    }
    return held;
}
"#;

fn compiled(module: &Module) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path();
    for file in emit(module, &Options::default()) {
        let path = path.join(&file.path);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
        std::fs::write(path, file.contents).expect("writing");
    }
    std::fs::write(path.join("firmware.c"), FIRMWARE).expect("writing");
    let runtime = host_runtime().expect("the runtime is built");
    let build = "make -s RUNGC_RT=$RUNTIME CFLAGS='-std=c99 -O1 -Wall -Wextra -Wconversion -Werror' && \
                 cc -std=c99 -Wall -Wextra -Werror -o firmware firmware.c libpins.a $RUNTIME";
    let built = Command::new("sh")
        .args(["-c", build])
        .env("RUNTIME", runtime)
        .current_dir(path)
        .output()
        .expect("a shell");
    let message = String::from_utf8_lossy(&built.stderr).into_owned();
    assert!(built.status.success(), "{message}");
    let run = Command::new(path.join("firmware"))
        .output()
        .expect("it runs");
    assert!(
        run.status.success(),
        "whoever holds pulses lets them go again"
    );
    String::from_utf8_lossy(&run.stdout).into_owned()
}

#[test]
fn pins_change_at_the_same_microseconds() {
    let module = module();
    let interpreted = interpreted(&module);
    let rises = |pin: &str| interpreted.lines().filter(|l| l.ends_with(pin)).count();
    assert_eq!(rises("Y0 1"), 2000);
    assert_eq!(rises("Y0 0"), 2000);
    // One every 8 ms, from the first scan on.
    assert_eq!(rises("Y1 1"), 38);
    assert_eq!(compiled(&module), interpreted);
}
