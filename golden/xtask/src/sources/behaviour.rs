//! The source of a project in structured text beside its compiled copy: as both run, and as a folder of files.

use crate::Problem;
use rungc::recompiled::{compiled_anew, declared, has_same_list, recompiled};
use rungc_frontend::Read;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile, model};
use rungc_rt::{Class, NoHal, Plc, Program as _};
use rungc_syntax::{Device, DeviceClass, Program, Severity};
use rungc_verify::prove::{Options, Verdict};
use rungc_verify::same::compare;
use std::collections::BTreeSet;

/// Amount of work.
pub struct Effort {
    /// Number of scans.
    pub scans: u32,
    /// Random seed.
    pub seed: u64,
    /// Limit of the effort of the proofs; 0: none are tried.
    pub proofs: u64,
}

/// Number of inputs that are switched, and of outputs that are compared.
const TERMINALS: u32 = 64;

/// Compares the source of a project with its compiled copy, and says in how much they are the same.
///
/// # Errors
///
/// The project holds no sources.
pub fn compared(read: &Read, effort: &Effort) -> Result<String, Problem> {
    let model = model(&read.program, &CompileOptions::default());
    let sources = read.sources.as_deref().ok_or("a project without sources")?;
    let (mut again, found) = recompiled(sources, model);
    if let Some(error) = found.iter().find(|one| one.severity == Severity::Error) {
        return Ok(format!("its files do not compile: {}", error.message));
    }
    again.cpu.clone_from(&read.program.cpu);
    let (anew, _) = compiled_anew(sources, model);
    let round = match has_same_list(sources, &anew, &read.program) {
        true => "the written files compile to the same list",
        false => "the written files compile to another list",
    };
    let modules = [&read.program, &again].map(module);
    let [Some(old), Some(new)] = modules else {
        return Ok(format!("{round}; one of both does not compile"));
    };
    let devices = declared(sources);
    let ran = run([&old, &new], &devices, effort);
    if effort.proofs == 0 {
        return Ok(format!("{round}; {ran}"));
    }
    let options = Options {
        effort: effort.proofs,
        ..Options::default()
    };
    let outputs = compare(&old, &new, &options).outputs;
    let is_proved = |verdict: &Verdict| matches!(verdict, Verdict::Proved);
    let proved = outputs.iter().filter(|one| is_proved(&one.verdict)).count();
    let all = outputs.len();
    Ok(format!(
        "{round}; {ran}; {proved} of {all} outputs proved the same"
    ))
}

fn module(program: &Program) -> Option<Module> {
    compile(program, &CompileOptions::default()).module
}

/// Runs both programs with the same random inputs and values of declared devices.
fn run(modules: [&Module; 2], devices: &BTreeSet<Device>, effort: &Effort) -> String {
    let mut machines = modules.map(Machine::new);
    let mut random = Random(effort.seed | 1);
    let outputs = (0..TERMINALS).map(|number| Device {
        class: DeviceClass::Y,
        number,
    });
    let compared: Vec<Device> = outputs.chain(devices.iter().copied()).collect();
    let writable: Vec<Device> = devices
        .iter()
        .copied()
        .filter(|one| matches!(one.class, DeviceClass::M | DeviceClass::D) && one.number < 8000)
        .collect();
    let (mut now, mut values) = (0u32, 0u64);
    let mut seen: BTreeSet<(Device, i16)> = BTreeSet::new();
    for scan in 1..=effort.scans {
        for number in 0..TERMINALS {
            if random.below(8) == 0 {
                let is_on = random.below(2) == 0;
                for machine in &mut machines {
                    machine.set_bit(Class::X, number, is_on);
                }
            }
        }
        // As an operator panel does.
        if random.below(16) == 0 && !writable.is_empty() {
            let device = writable[random.below(writable.len() as u64) as usize];
            let value = random.below(40) as i16 - 4;
            for machine in &mut machines {
                write(machine, device, value);
            }
        }
        now = now.wrapping_add(1 + random.below(200) as u32);
        for machine in &mut machines {
            machine.scan(&mut NoHal, now, 10_000);
        }
        for device in &compared {
            let [one, other] = [0, 1].map(|at: usize| value(&machines[at], *device));
            let (Some(one), Some(other)) = (one, other) else {
                continue;
            };
            values += 1;
            if one != other {
                return format!("{device} is {one} and {other} after scan {scan}");
            }
            seen.insert((*device, one));
        }
    }
    let changing: BTreeSet<_> = seen.iter().map(|(device, _)| *device).collect();
    let changing = changing.iter().filter(|device| {
        let values = (**device, i16::MIN)..=(**device, i16::MAX);
        seen.range(values).nth(1).is_some()
    });
    let devices = values / u64::from(effort.scans.max(1));
    let changing = changing.count();
    format!(
        "equal over {} scans in {devices} devices, of which {changing} change",
        effort.scans
    )
}

fn write(machine: &mut Machine, Device { class, number }: Device, value: i16) {
    match class {
        DeviceClass::M => machine.set_bit(Class::M, number, value > 0),
        _ => machine.set_word(Class::D, number, value),
    };
}

fn value(machine: &Machine, Device { class, number }: Device) -> Option<i16> {
    let bit = |class| machine.bit(class, number).map(i16::from);
    match class {
        DeviceClass::Y => bit(Class::Y),
        DeviceClass::M => bit(Class::M),
        DeviceClass::S => bit(Class::S),
        DeviceClass::D => machine.word(Class::D, number),
        DeviceClass::T => machine.word(Class::T, number),
        DeviceClass::C => machine.word(Class::C, number),
        _ => None,
    }
}

/// A generator of numbers by chance (xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 20) % limit
    }
}

#[cfg(test)]
mod tests {
    use super::{Effort, compared};
    use rungc_frontend::Read;
    use rungc_frontend::sources::{Body, Pou, PouKind, Sources, Task};
    use rungc_verify::prove::EFFORT;

    const TEXT: &str = "Y0 := X0 AND X1;\nIF X2 THEN\n  D0 := D0 + 1;\nEND_IF;\n";

    /// What the editor makes of it.
    const LIST: &str = "LD X000\nAND X001\nOUT Y000\nLDI X002\nCJ P0\nLD M8000\nADD D0 K1 D0\nP0\n\
                        FEND\nNOP\nEND\n";

    fn project(text: &str) -> Read {
        let mut read = rungc_frontend::read_text("press.il", LIST);
        read.sources = Some(Box::new(Sources {
            pous: vec![Pou {
                name: "Main".to_owned(),
                library: None,
                kind: PouKind::Program,
                return_type: String::new(),
                labels: Vec::new(),
                body: Body::Text(text.to_owned()),
            }],
            tasks: vec![Task {
                name: "MAIN".to_owned(),
                event: "TRUE".to_owned(),
                interval: "0".to_owned(),
                priority: 31,
                pous: vec!["Main".to_owned()],
            }],
            ..Sources::default()
        }));
        read
    }

    #[test]
    fn a_source_does_what_its_compiled_copy_does() {
        let effort = Effort {
            scans: 2_000,
            seed: 1,
            proofs: EFFORT,
        };
        let same = compared(&project(TEXT), &effort).unwrap();
        let expected = "the written files compile to the same list; equal over 2000 scans in 65 devices, of which 2 \
                        change; 1 of 1 outputs proved the same";
        assert_eq!(same, expected);
        let other = compared(&project(&TEXT.replace("AND", "OR")), &effort).unwrap();
        assert!(
            other.contains("another list; Y000 is")
                && other.ends_with("0 of 1 outputs proved the same"),
            "{other}"
        );
        let missing = compared(&project("Y0 := Start;\n"), &effort).unwrap();
        assert_eq!(
            missing,
            "its files do not compile: nothing declares `Start`"
        );
    }
}
