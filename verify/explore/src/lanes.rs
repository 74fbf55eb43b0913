//! Sweeps on the lanes of emitted C, in a child process.

use crate::cover::View;
use crate::run::POWER;
use crate::task::{Input, Step, Task};
use crate::wide::{Bit, Change, Items, LANES, Stride};
use rungc_codegen_c::{Members, Options};
use rungc_models::runs::{is_counter32, name_class};
use rungc_rt::Class;
use rungc_sim::Target;
use rungc_sim::engines::{BuildError, Piped, build_with_main};
use rungc_syntax::DeviceClass;
use std::fmt::Write as _;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// Main program of the lanes: `lanes.c`, a `main` with the name of the program as `NAME`.
const MAIN: &str = include_str!("lanes.c");

/// The lanes of a program.
pub struct Lanes {
    child: Piped,
    bits: u32,
    /// Of each input, whether it is a terminal X, which stays as it is when the power goes off.
    terminals: Vec<bool>,
}

/// Builds what runs the sweeps of a search, in a folder. The search must have sweeps ([`crate::wide::refusal`]).
///
/// # Errors
/// A file that cannot be written, a C compiler (`cc`) that is not there or rejects what was emitted.
pub fn build(task: &Task, folder: &Path) -> Result<PathBuf, BuildError> {
    let options = Options {
        lanes: true,
        ..Options::default()
    };
    build_with_main(&task.noting, &options, &main_file(task), folder)
}

fn main_file(task: &Task) -> String {
    let module = &task.noting;
    let members = Members::new(module);
    let view = View::new(task);
    let items = Items::new(task, &view);
    let member = |class: Class, n| members.of(name_class(class), n);
    let name = &module.name;
    // Writing to a String does not fail, here and below.
    let mut bits = String::new();
    for &bit in &items.bits {
        let member = match bit {
            Bit::Device(class, n) => member(class, n),
            Bit::Flag(flag) => Some(module.flags[flag].name.clone()),
        };
        let _ = match member {
            Some(member) => writeln!(bits, "    &all.{member},"),
            None => writeln!(bits, "    &nothing,"),
        };
    }
    let mut words = String::new();
    for &(class, n) in &items.words {
        let value = match class {
            Class::T | Class::C => ".value",
            _ => "",
        };
        let wide = class == Class::C && is_counter32(DeviceClass::C, n);
        let _ = match member(class, n) {
            Some(member) => writeln!(
                words,
                "    {{offsetof({name}_plc, {member}{value}), {wide}}},"
            ),
            None => writeln!(words, "    {{offsetof({name}_plc, sys.scan_us), false}},"),
        };
    }
    let inputs = task
        .inputs
        .iter()
        .map(|input| input_line(input, name, &members));
    MAIN.replace("BITS", &bits)
        .replace("WORDS", &words)
        .replace("INPUTS", &inputs.collect::<String>())
        .replace("NAME", name)
}

/// Location of an input.
fn input_line(input: &Input, name: &str, members: &Members) -> String {
    let (class, number, _) = input.target.devices(0);
    // Inputs are devices that the program stores.
    let member = members.of(class, number).unwrap_or_default();
    let lanes = match input.target {
        Target::Bit(..) => format!("&all.{member}"),
        _ => "NULL".to_string(),
    };
    format!("    {{{lanes}, offsetof({name}_plc, {member})}},\n")
}

impl Lanes {
    /// Starts what [`build`] has made.
    ///
    /// # Errors
    /// It cannot be started.
    pub fn start(executable: &Path, task: &Task, items: &Items) -> io::Result<Self> {
        let is_terminal = |input: &Input| matches!(input.target, Target::Bit(DeviceClass::X, _));
        Ok(Lanes {
            terminals: task.inputs.iter().map(is_terminal).collect(),
            child: Piped::start(executable, &[])?,
            bits: items.bits.len() as u32,
        })
    }

    /// Executes a sweep after a run from power-on; `row` gets the changes of each scan.
    ///
    /// # Errors
    /// The child has ended, or does not answer as it should.
    pub fn sweep(
        &mut self,
        run: &[Step],
        strides: &[Stride],
        row: &mut dyn FnMut(&[Change]),
    ) -> Result<(), String> {
        let done = self.converse(run, strides, row);
        done.map_err(|error| {
            format!(
                "the process that runs the lanes ended: {}",
                self.child.ended(&error)
            )
        })
    }

    fn converse(
        &mut self,
        run: &[Step],
        strides: &[Stride],
        row: &mut dyn FnMut(&[Change]),
    ) -> io::Result<()> {
        let request = request(run, strides, &self.terminals);
        let length = (request.len() as u32).to_ne_bytes();
        self.child.requests.write_all(&length)?;
        let bytes: Vec<u8> = request.into_iter().flat_map(u32::to_ne_bytes).collect();
        self.child.requests.write_all(&bytes)?;
        self.child.requests.flush()?;
        let mut changes = Vec::new();
        let mut bytes = Vec::new();
        for _ in 0..strides.iter().map(|stride| stride.time.0).sum::<u32>() {
            let mut counts = [0; 8];
            self.child.answers.read_exact(&mut counts)?;
            let [bits, words] = numbers(&counts);
            let of_bits = BIT_RECORD * bits as usize;
            bytes.resize(of_bits + WORD_RECORD * words as usize, 0);
            self.child.answers.read_exact(&mut bytes)?;
            let (of_bits, of_words) = bytes.split_at(of_bits);
            changes.clear();
            for record in of_bits.as_chunks::<BIT_RECORD>().0 {
                let [item, low, high, low_now, high_now] = numbers(record);
                let now = lanes(low_now, high_now);
                let mut changed = lanes(low, high);
                while changed != 0 {
                    let lane = changed.trailing_zeros();
                    changed &= changed - 1;
                    changes.push(Change {
                        lane: lane as u8,
                        item,
                        value: (now >> lane & 1) as i32,
                    });
                }
            }
            for record in of_words.as_chunks::<WORD_RECORD>().0 {
                let [item, lane, value] = numbers(record);
                changes.push(Change {
                    lane: lane as u8,
                    item: self.bits + item,
                    value: value as i32,
                });
            }
            row(&changes);
        }
        Ok(())
    }
}

/// Bytes of a bit that has changed: item, lanes that have changed, lanes now.
const BIT_RECORD: usize = 20;
/// Bytes of a word that has changed: item, lane, value.
const WORD_RECORD: usize = 12;

/// Numbers in the order of this machine.
fn numbers<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let (parts, _) = bytes.as_chunks::<4>();
    std::array::from_fn(|i| u32::from_ne_bytes(parts[i]))
}

fn lanes(low: u32, high: u32) -> u64 {
    u64::from(high) << 32 | u64::from(low)
}

/// Request for a sweep, in the format of `lanes.c`.
fn request(run: &[Step], strides: &[Stride], terminals: &[bool]) -> Vec<u32> {
    let mut request = vec![run.len() as u32];
    let mut on = vec![0; terminals.len()];
    for step in run {
        request.extend([step.scans, step.scan_ms, 0]);
        let changes = request.len() - 1;
        let mut change = |input: u32, value: i32| {
            request.extend([input, value as u32]);
            request[changes] += 1;
        };
        if step.set.iter().any(|(input, _)| *input == POWER) {
            change(u32::MAX, 0);
            let terminals = terminals.iter().zip(&on).enumerate();
            let stay = terminals.filter(|(_, (is_terminal, _))| **is_terminal);
            stay.for_each(|(input, (_, &value))| change(input as u32, value));
        }
        for &(input, value) in step.set.iter().filter(|(input, _)| *input != POWER) {
            on[input] = value;
            change(input as u32, value);
        }
    }
    request.push(strides.len() as u32);
    for stride in strides {
        let changes: usize = stride.set.iter().map(Vec::len).sum();
        request.extend([stride.time.0, stride.time.1, changes as u32]);
        for (lane, set) in stride.set.iter().take(LANES).enumerate() {
            for &(input, value) in set {
                request.extend([lane as u32, input as u32, value as u32]);
            }
        }
    }
    request
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn main_is_packed() {
        assert!(MAIN.contains("int main("));
    }
}
