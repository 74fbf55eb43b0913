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
use rungc_rt::{Class, Clock, FIRST_COUNTER32, Program, VirtualHal, word};

/// Answers requests until they end. `read` waits for bytes and says how many came, 0 at the end; `write` takes all bytes.
pub fn serve(read: &mut dyn FnMut(&mut [u8]) -> usize, write: &mut dyn FnMut(&[u8])) {
    let mut port = Port::new(read, write);
    let mut next = session(&mut port, None);
    while let Some(number) = next {
        let found = cases::run(number, &mut |program| {
            port.answer(&Answer::Done);
            next = session(&mut port, Some(program));
        });
        if found.is_none() {
            port.answer(&"none");
            next = session(&mut port, None);
        }
    }
    port.flush();
}

/// Answers requests to a program, or without one; returns the number of the program that is asked for next, `None` at the end.
fn session(port: &mut Port, mut program: Option<&mut dyn Program>) -> Option<usize> {
    let mut hal = VirtualHal::new();
    loop {
        let reply = {
            let line = port.line()?;
            let mut words = line.split_ascii_whitespace();
            match words.next() {
                Some("exit") => return None,
                Some("case") => return Some(next(&mut words).unwrap_or(usize::MAX)),
                Some(request) => program
                    .as_deref_mut()
                    .and_then(|program| answer(program, &mut hal, request, words)),
                None => None,
            }
        };
        match reply {
            Some(reply) => port.answer(&reply),
            None => port.answer(&"none"),
        }
    }
}

/// What there is to say.
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
        "scan" => {
            let now_ms = next(words)?;
            hal.advance_to(now_ms);
            program.scan(hal, now_ms, next(words)?);
        }
        "edge" => program.input_edge(hal, next(words)?, next::<i64>(words)? != 0),
        "tick" => program.tick(hal, next(words)?),
        "interrupts" => program.take_interrupts(hal),
        "out" => return value(program.output(next(words)?)),
        "pulses" => return value(program.pulses_sent(next(words)?)),
        "frequency" => return value(program.pulse_millihertz(next(words)?)),
        "run" => program.set_running(next::<i64>(words)? != 0),
        "power" => {
            program.power_cycle();
            hal.restart();
        }
        "bfm" => hal.set_bfm(next(words)?, next(words)?, next(words)?)?,
        "getbfm" => return value(hal.bfm(next(words)?, next(words)?)?),
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
