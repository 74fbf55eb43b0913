//! Runs the programs of a batch on virtual hardware, as standard input says: one request a line, one answer a line.

mod cases;
mod models;

use rungc_rt::{Class, Clock, FIRST_COUNTER32, Program, VirtualHal, word};
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::str::{FromStr, SplitAsciiWhitespace};

/// A program and its hardware.
struct Bench {
    program: Box<dyn Program>,
    hal: VirtualHal,
}

fn main() -> io::Result<()> {
    let mut input = BufReader::new(io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    let mut bench = None;
    let mut line = String::new();
    loop {
        line.clear();
        if input.read_line(&mut line)? == 0 || line.trim() == "exit" {
            return output.flush();
        }
        let mut words = line.split_ascii_whitespace();
        match words.next().and_then(|word| answer(&mut bench, word, words)) {
            Some(answer) => writeln!(output, "{answer}")?,
            None => writeln!(output, "none")?,
        }
        // Whoever waits for an answer has sent nothing more.
        if input.buffer().is_empty() {
            output.flush()?;
        }
    }
}

/// Does one request; `None` if there is no such program, device, module or channel.
fn answer(bench: &mut Option<Bench>, request: &str, mut words: SplitAsciiWhitespace) -> Option<String> {
    let words = &mut words;
    if request == "case" {
        *bench = Some(Bench {
            program: cases::program(next(words)?)?,
            hal: VirtualHal::new(),
        });
        return done();
    }
    let Bench { program, hal } = bench.as_mut()?;
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
            set_double(program.as_mut(), class, number, next(words)?)?;
        }
        "getbit" => {
            let (class, number) = device(words)?;
            return Some(u8::from(program.bit(class, number)?).to_string());
        }
        "getword" => {
            let (class, number) = device(words)?;
            return Some(program.word(class, number)?.to_string());
        }
        "getdword" => {
            let (class, number) = device(words)?;
            return Some(double(program.as_ref(), class, number)?.to_string());
        }
        "scan" => {
            let now_ms = next(words)?;
            hal.advance_to(now_ms);
            program.scan(hal, now_ms, next(words)?);
        }
        "edge" => program.input_edge(next(words)?, next::<i64>(words)? != 0),
        "tick" => program.tick(next(words)?),
        "interrupts" => program.take_interrupts(hal),
        "out" => return Some(u8::from(program.output(next(words)?)).to_string()),
        "pulses" => return Some(program.pulses_sent(next(words)?).to_string()),
        "frequency" => return Some(program.pulse_millihertz(next(words)?).to_string()),
        "run" => program.set_running(next::<i64>(words)? != 0),
        "power" => {
            program.power_cycle();
            hal.restart();
        }
        "bfm" => hal.set_bfm(next(words)?, next(words)?, next(words)?)?,
        "getbfm" => return Some(hal.bfm(next(words)?, next(words)?)?.to_string()),
        "clock" => set_clock(hal, words)?,
        "analog" => hal.set_analog(next(words)?, next(words)?)?,
        _ => return None,
    }
    done()
}

fn done() -> Option<String> {
    Some("ok".to_string())
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
