//! Runs the program on this computer in real time, one scan every 10 ms.
//!
//! Type `X0=1` or `X0=0` and Enter to switch an input (in octal, as on the PLC); outputs are printed when they change. `quit` ends
//! the run.

USES;

/// Reports a line on standard error. One that is full or closed does no harm.
macro_rules! report {
    ($($text:tt)*) => {
        report(&format!($($text)*))
    };
}

fn report(line: &str) {
    REPORT_LINE;
}

/// Prints a line to standard output. One that is full or closed does no harm.
fn show(line: &str) {
    SHOW_LINE;
}

/// Time from the start of one scan to the start of the next.
const SCAN: Duration = Duration::from_millis(10);

/// The number of lines of standard input that a scan reads.
const COMMANDS_PER_SCAN: usize = 16;

/// The longest of them, in bytes.
const LONGEST_COMMAND: u64 = 1024;

/// Output terminals: number, name, comment.
const OUTPUTS: &[(u32, &str, &str)] = &[OUTPUT_TABLE];

/// Error codes of the PLC that the program may meet, and what they mean.
const ERRORS: &[(u16, &str)] = &[ERROR_TABLE];

/// A device with an index: its class, letter and number, and the index register.
type Indexed = (Class, &'static str, u32, Class, u32);

/// Instructions at which an error can occur: step, text, devices with an index.
const INSTRUCTIONS: &[(u16, &str, &[Indexed])] = &[INSTRUCTION_TABLE];

/// The text for `--help`.
const USAGE: &str = USAGE_TEXT;

fn main() {
    let mut plc = TYPE::new();
    let mut hal = VirtualHal::new();
    OPEN;
    CLOCK;
    let mut shown = [false; OUTPUTS.len()];
    let commands = COMMANDS;
    let start = Instant::now();
    let mut next = start;
    let mut scan_us = 0;
    let mut stop = Stop::default();
    PARTNER;
    REPORT;
    OVERRUN;
    CATCH;
    'run: loop {
        STOPPED;
        let begin = Instant::now();
        let now_ms = (begin - start).as_millis() as u32;
        for line in commands.try_iter().take(COMMANDS_PER_SCAN) {
            if line.trim() == "quit" {
                break 'run;
            }
            if set_input(&mut plc, &mut hal, &line).is_none() {
                report!("{line}: not an input; type for example X0=1");
            }
        }
        hal.advance_to(now_ms);
        SERVE;
        plc.scan(&mut hal, now_ms, scan_us);
        GIVE;
        for (&(number, name, comment), shown) in OUTPUTS.iter().zip(&mut shown) {
            let on = plc.output(number);
            if on != *shown {
                *shown = on;
                let state = if on { "on" } else { "off" };
                let seconds = f64::from(now_ms) / 1000.0;
                show(&format!("{seconds:>11.3} s  {name} {state:<3} {comment}"));
            }
        }
        STOPPED_BY;
        report_stop(&plc, now_ms, &mut stop);
        SAVE;
        scan_us = begin.elapsed().as_micros() as u32;
        PERIOD;
        next = not_late(next);
        WAIT;
    }
    END;
    CONNECTIONS;
    LEAVE;
}

/// Start of the next scan. After a suspension of more than a second (a suspended machine, a debugger) it does not catch
/// up.
fn not_late(next: Instant) -> Instant {
    let late = next.elapsed();
    if late < Duration::from_secs(1) {
        return next;
    }
    report!("the run stood still for {:.1} s", late.as_secs_f64());
    next + late
}

/// Options with a value.
const VALUED: &[&str] = &[OPTION_NAMES];

/// Options of the command line and their values; any other argument ends the program.
fn options() -> Vec<(String, String)> {
    let mut options = Vec::new();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        if ["-h", "--help"].contains(&word.as_str()) {
            show(USAGE.trim_end());
            std::process::exit(0);
        }
        match words.next().filter(|_| VALUED.contains(&word.as_str())) {
            Some(value) => options.push((word, value)),
            None => {
                report!("{word}: not an option, or its value is missing\n{}", USAGE.trim_end());
                std::process::exit(2);
            }
        }
    }
    options
}

/// Meaning of an error code of the PLC.
fn meaning(code: u16) -> &'static str {
    let known = ERRORS.iter().find(|error| error.0 == code);
    known.map_or("operation error", |error| error.1)
}

/// Reports what stops the program, once; `before` is what has been reported.
fn report_stop(plc: &TYPE, now_ms: u32, before: &mut Stop) {
    let LastError { stop, stop_step, .. } = plc.last_error();
    match stop {
        Stop::Program if stop != *before => report!("the program has stopped itself (M8037)"),
        Stop::Watchdog if stop != *before => {
            let (code, text) = (Stop::Watchdog as u16, instruction(stop_step).0);
            let what = meaning(code);
            report!("at {now_ms} ms, step {stop_step}: {text}: error {code}, {what}; the PLC is in STOP");
        }
        Stop::No | Stop::Program | Stop::Watchdog => {}
    }
    *before = stop;
}

/// The instruction at a step, and its devices with an index.
fn instruction(step: u16) -> (&'static str, &'static [Indexed]) {
    let known = INSTRUCTIONS.iter().find(|known| known.0 == step);
    known.map_or(("", &[]), |known| (known.1, known.2))
}

ON_ERROR;
/// The lines of standard input, as they come.
fn commands() -> Receiver<String> {
    // Excess lines wait until the scans have processed them.
    let (sender, receiver) = mpsc::sync_channel(COMMANDS_PER_SCAN);
    std::thread::spawn(move || {
        let mut input = io::stdin().lock();
        let mut line = Vec::new();
        // A longer line is cut, so that it cannot fill the memory.
        while let Ok(1..) = input.by_ref().take(LONGEST_COMMAND).read_until(b'\n', &mut line) {
            let text = String::from_utf8_lossy(&line).trim().to_string();
            if sender.send(text).is_err() {
                break;
            }
            line.clear();
        }
    });
    receiver
}

/// Sets an input by `X12=1`; `None` if it is not of this form, or the PLC has no such input.
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
