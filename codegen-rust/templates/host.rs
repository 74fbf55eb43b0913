//! Runs the program on this computer in real time, one scan every 10 ms.
//!
//! Type `X0=1` or `X0=0` and Enter to switch an input (in octal, as on the PLC); outputs are printed when they change.

use CRATE::TYPE;
use rungc_rt::{Class, LastError, Plc, Program, Stop, VirtualHal};
use std::io::{self, BufRead};
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

/// Time from the start of one scan to the start of the next.
const SCAN: Duration = Duration::from_millis(10);

/// The number of lines of standard input that a scan reads.
const COMMANDS_PER_SCAN: usize = 16;

/// Output terminals: number, name, comment.
const OUTPUTS: &[(u32, &str, &str)] = &[OUTPUT_TABLE];

/// Error codes of the PLC that the program may meet, and what they mean.
const ERRORS: &[(u16, &str)] = &[ERROR_TABLE];

fn main() {
    let mut plc = TYPE::new();
    let mut hal = VirtualHal::new();
    let mut shown = [false; OUTPUTS.len()];
    let commands = commands();
    let start = Instant::now();
    let mut next = start;
    let mut scan_us = 0;
    let mut error = LastError::NONE;
    loop {
        let begin = Instant::now();
        let now_ms = (begin - start).as_millis() as u32;
        for line in commands.try_iter().take(COMMANDS_PER_SCAN) {
            if set_input(&mut plc, &mut hal, &line).is_none() {
                eprintln!("{line}: not an input; type for example X0=1");
            }
        }
        hal.advance_to(now_ms);
        plc.scan(&mut hal, now_ms, scan_us);
        for (&(number, name, comment), shown) in OUTPUTS.iter().zip(&mut shown) {
            let on = plc.output(number);
            if on != *shown {
                *shown = on;
                let state = if on { "on" } else { "off" };
                let seconds = f64::from(now_ms) / 1000.0;
                println!("{seconds:>11.3} s  {name} {state:<3} {comment}");
            }
        }
        print_error(error, plc.last_error());
        error = plc.last_error();
        scan_us = begin.elapsed().as_micros() as u32;
        next += SCAN;
        WAIT;
    }
}

/// What an error code of the PLC means.
fn meaning(code: u16) -> &'static str {
    let known = ERRORS.iter().find(|error| error.0 == code);
    known.map_or("operation error", |error| error.1)
}

/// Reports an operation error at another place than the last one, and what stops the program.
fn print_error(before: LastError, now: LastError) {
    if now.code != 0 && (now.code, now.step) != (before.code, before.step) {
        let LastError { code, step, .. } = now;
        eprintln!("step {step}: error {code}, {}", meaning(code));
    }
    if now.stop != before.stop {
        match now.stop {
            Stop::No => {}
            Stop::Program => eprintln!("the program has stopped itself (M8037)"),
            Stop::Watchdog => {
                let (code, step) = (Stop::Watchdog as u16, now.stop_step);
                eprintln!("step {step}: error {code}, {}; the PLC is in STOP", meaning(code));
            }
        }
    }
}

/// The lines of standard input, as they come.
fn commands() -> Receiver<String> {
    // A flood of lines waits until the scans have looked at them.
    let (sender, receiver) = mpsc::sync_channel(COMMANDS_PER_SCAN);
    std::thread::spawn(move || {
        for line in io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    receiver
}

/// Does what `X12=1` says; `None` if it says nothing of the kind, or the PLC has no such input.
fn set_input(plc: &mut TYPE, hal: &mut VirtualHal, line: &str) -> Option<()> {
    let (name, value) = line.trim().split_once('=')?;
    let number = name.trim().strip_prefix(['X', 'x'])?;
    let number = u32::from_str_radix(number, 8).ok()?;
    let on = match value.trim() {
        "0" => false,
        "1" => true,
        _ => return None,
    };
    plc.set_bit(Class::X, number, on)?;
    plc.input_edge(hal, number, on);
    Some(())
}
