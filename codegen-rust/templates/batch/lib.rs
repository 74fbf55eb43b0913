//! Runs the programs of a batch on virtual hardware, as requests say: one request a line, one answer a line.
//!
//! Without the standard library, so that the same batch runs on a microcontroller.
#![no_std]

#[cfg(feature = "bare")]
mod bare;
mod cases;
mod models;
mod port;

use core::fmt;
use core::str::{FromStr, SplitAsciiWhitespace};
use port::Port;
use rungc_rt::comm::{CharFault, Received};
use rungc_rt::modules::{KINDS, Quantity, Signal};
use rungc_rt::{Class, Clock, FIRST_COUNTER32, Program, VirtualHal, pass_pulses, word};

/// Answers requests until they end. `read` waits for bytes and returns their number, 0 at the end; `write` takes all bytes.
pub fn serve(read: &mut dyn FnMut(&mut [u8]) -> usize, write: &mut dyn FnMut(&[u8])) {
    let mut port = Port::new(read, write);
    let mut next = session(&mut port, &mut []);
    while let Some(Next::Case(number)) = next {
        next = run(&mut port, &mut [], number);
    }
    port.flush();
}

/// A PLC of a case: its program and its hardware.
type Plc<'a> = (&'a mut dyn Program, VirtualHal);

/// PLCs that a case may have.
const PLCS: usize = 4;

/// Next step after a session.
enum Next {
    /// A case of this program.
    Case(usize),
    /// Another PLC with this program.
    Join(usize),
}

/// Runs a program in a PLC beside those of the case; returns the case that is requested next, `None` at the end.
fn run(port: &mut Port, plcs: &mut [Option<Plc>], number: usize) -> Option<Next> {
    let mut next = None;
    let found = cases::run(number, &mut |program| {
        port.answer(&Answer::Done);
        let mut all: [Option<Plc>; PLCS] = [None, None, None, None];
        let mut count = 0;
        for plc in plcs.iter_mut() {
            if let Some((program, hal)) = plc.take() {
                all[count] = Some((program, hal));
                count += 1;
            }
        }
        if let Some(place) = all.get_mut(count) {
            *place = Some((program, VirtualHal::new()));
        }
        next = session(port, &mut all);
        while let Some(Next::Join(number)) = next {
            next = run(port, &mut all, number);
        }
    });
    if found.is_none() {
        port.answer(&"none");
        next = session(port, plcs);
    }
    next
}

/// Answers requests to the programs of a case, or without any; returns the next request, `None` at the end.
fn session(port: &mut Port, plcs: &mut [Option<Plc>]) -> Option<Next> {
    let mut current = 0;
    loop {
        let reply = {
            let line = port.line()?;
            let mut words = line.split_ascii_whitespace();
            match words.next() {
                Some("exit") => return None,
                Some("case") => return Some(Next::Case(next(&mut words).unwrap_or(usize::MAX))),
                Some("join") => return Some(Next::Join(next(&mut words).unwrap_or(usize::MAX))),
                Some("plc") => next(&mut words)
                    .filter(|&plc| matches!(plcs.get(plc), Some(Some(_))))
                    .map(|plc| {
                        current = plc;
                        Answer::Done
                    }),
                Some(request) => plcs
                    .get_mut(current)
                    .and_then(Option::as_mut)
                    .and_then(|(program, hal)| answer(&mut **program, hal, request, words)),
                None => None,
            }
        };
        match reply {
            Some(reply) => port.answer(&reply),
            None => port.answer(&"none"),
        }
    }
}

/// Answer to a request.
enum Answer {
    Done,
    Value(i64),
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Answer::Done => f.write_str("ok"),
            Answer::Value(value) => value.fmt(f),
        }
    }
}

/// Does one request; `None` if there is no such device, module or channel.
fn answer(
    program: &mut dyn Program,
    hal: &mut VirtualHal,
    request: &str,
    mut words: SplitAsciiWhitespace,
) -> Option<Answer> {
    let words = &mut words;
    match request {
        "bit" => {
            let (class, number) = device(words)?;
            program.set_bit(class, number, next::<i64>(words)? != 0)?;
        }
        "word" => {
            let (class, number) = device(words)?;
            program.set_word(class, number, next(words)?)?;
        }
        "dword" => {
            let (class, number) = device(words)?;
            set_double(program, class, number, next(words)?)?;
        }
        "getbit" => {
            let (class, number) = device(words)?;
            return value(program.bit(class, number)?);
        }
        "getword" => {
            let (class, number) = device(words)?;
            return value(program.word(class, number)?);
        }
        "getdword" => {
            let (class, number) = device(words)?;
            return value(double(program, class, number)?);
        }
        "digest" => {
            let (class, first) = device(words)?;
            return value(digest(program, class, first, next(words)?));
        }
        "scan" => {
            let now_ms = next(words)?;
            hal.scan(program, now_ms, next(words)?);
        }
        "constant" => return value(program.constant_scan_ms().unwrap_or(0)),
        "edge" => program.input_edge(hal, next(words)?, next::<i64>(words)? != 0),
        "tick" => program.tick(hal, next(words)?),
        "interrupts" => program.take_interrupts(hal),
        "out" => return value(program.output(next(words)?)),
        "pulses" => return value(program.pulses_sent(next(words)?)),
        "pass" => {
            let (from_us, until_us) = (next::<i32>(words)?, next::<i32>(words)?);
            let reached = pass_pulses(program, from_us as u32, until_us as u32, next(words)?);
            return value(reached as i32);
        }
        "frequency" => return value(program.pulse_millihertz(next(words)?)),
        "receive" => {
            let line = hal.line(next(words)?)?;
            line.feed(Received {
                at_us: next(words)?,
                byte: next(words)?,
                fault: CharFault::of(next(words)?),
            })?;
        }
        "sent" => return value(hal.line(next(words)?)?.take_packed(next(words)?)?),
        "line" => return value(hal.line(next(words)?)?.format().packed()),
        "run" => {
            let running = next::<i64>(words)? != 0;
            program.set_running(running);
            hal.set_running(running);
        }
        "power" => {
            program.power_cycle();
            hal.restart();
        }
        "bfm" => hal.set_bfm(next(words)?, next(words)?, next(words)?)?,
        "getbfm" => return value(hal.bfm(next(words)?, next(words)?)?),
        "fit" => hal.fit(next(words)?, KINDS.get(next::<usize>(words)?)?)?,
        "signal" => {
            hal.advance_to(next(words)?);
            let (unit, channel) = (next(words)?, next(words)?);
            let quantity = Quantity::of(next(words)?)?;
            let millionths = next(words)?;
            hal.set_signal(
                unit,
                channel,
                Signal {
                    quantity,
                    millionths,
                },
            )?;
        }
        "getsignal" => {
            hal.advance_to(next(words)?);
            let (unit, channel) = (next(words)?, next(words)?);
            return value(hal.signal(unit, channel, Quantity::of(next(words)?)?)?);
        }
        "delay" => hal.delay_module(next(words)?, next(words)?)?,
        "supply" => hal.set_power_fails(next::<i64>(words)? != 0),
        "clock" => set_clock(hal, words)?,
        "analog" => hal.set_analog(next(words)?, next(words)?)?,
        _ => return None,
    }
    Some(Answer::Done)
}

fn value(value: impl Into<i64>) -> Option<Answer> {
    Some(Answer::Value(value.into()))
}

fn next<T: FromStr>(words: &mut SplitAsciiWhitespace) -> Option<T> {
    words.next()?.parse().ok()
}

fn device(words: &mut SplitAsciiWhitespace) -> Option<(Class, u32)> {
    let class = match words.next()? {
        "X" => Class::X,
        "Y" => Class::Y,
        "M" => Class::M,
        "S" => Class::S,
        "T" => Class::T,
        "C" => Class::C,
        "D" => Class::D,
        "R" => Class::R,
        "V" => Class::V,
        "Z" => Class::Z,
        "ER" => Class::ER,
        _ => return None,
    };
    Some((class, next(words)?))
}

/// One number that stands for all that devices hold: bits, words and 32-bit counters, and terminals of outputs.
fn digest(program: &dyn Program, class: Class, first: u32, count: u32) -> u32 {
    let with = |digest: u32, value: Option<u32>| {
        (digest ^ value.unwrap_or(0x8000_0001)).wrapping_mul(0x0100_0193)
    };
    let mut all = 0x811C_9DC5;
    for number in first..first.saturating_add(count) {
        all = with(all, program.bit(class, number).map(u32::from));
        all = with(all, program.word(class, number).map(|word| word as u32));
        match class {
            Class::Y => all = with(all, Some(program.output(number).into())),
            Class::C if number >= FIRST_COUNTER32 => {
                all = with(all, program.counter32(number).map(|both| both as u32));
            }
            _ => {}
        }
    }
    all
}

fn double(program: &dyn Program, class: Class, number: u32) -> Option<i32> {
    if class == Class::C && number >= FIRST_COUNTER32 {
        return program.counter32(number);
    }
    let (high_class, high) = high_word(program, class, number);
    Some(word::pair(
        program.word(class, number)?,
        program.word(high_class, high)?,
    ))
}

fn set_double(program: &mut dyn Program, class: Class, number: u32, value: i32) -> Option<()> {
    if class == Class::C && number >= FIRST_COUNTER32 {
        return program.set_counter32(number, value);
    }
    let (high_class, high) = high_word(program, class, number);
    program.word(high_class, high)?;
    let [low_word, high_word] = word::words(value);
    program.set_word(class, number, low_word)?;
    program.set_word(high_class, high, high_word)
}

fn high_word(program: &dyn Program, class: Class, number: u32) -> (Class, u32) {
    if class == Class::Z && program.z_pairs_with_v() {
        (Class::V, number)
    } else {
        (class, number.saturating_add(1))
    }
}

fn set_clock(hal: &mut VirtualHal, words: &mut SplitAsciiWhitespace) -> Option<()> {
    let clock = Clock::new(
        next(words)?,
        next(words)?,
        next(words)?,
        next(words)?,
        next(words)?,
        next(words)?,
    )?;
    rungc_rt::Hal::set_clock(hal, clock)
}
