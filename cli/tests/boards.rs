//! The boards that rungc has descriptions of: their images, executed with a model of the microcontroller's registers,
//! read and drive the pins that the published tables say.

mod common;
mod tools;

use common::{folder, rungc, text};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use tools::{cargo, leave_out, no_rust, tools, with_cargo};

/// A board's terminals by the published tables, which are not those that the descriptions are read from.
struct Published {
    name: &'static str,
    chip: &'static str,
    target: &'static str,
    model: &'static str,
    inputs: &'static str,
    outputs: &'static str,
    /// Pins of lamps that are on in RUN.
    run: &'static str,
    /// The pin of the switch.
    switch: &'static str,
    analog: &'static str,
    /// What UARTs send on, and what they receive on.
    lines: [&'static str; 2],
    /// How the pin that sends is set up.
    sends: &'static str,
    /// The interrupt of USART1.
    interrupt: u32,
}

const PUBLISHED: [Published; 4] = [
    Published {
        name: "fx3u-f103vc",
        chip: "stm32f1",
        target: "thumbv7m-none-eabi",
        model: "fx3u",
        inputs: "PB13 PB14 PB11 PB12 PE15 PB10 PE13 PE14 PE11 PE12 PE9 PE10 PE7 PE8",
        outputs: "PC9 PC8 PA8 PA0 PB3 PD12 PB15 PA7 PA6 PA2",
        run: "PD10",
        switch: "PB2",
        analog: "PA1 PA3 PC4 PC5 PC0 PC1 PC2 PC3 PA4 PA5",
        lines: ["PA9 PC10", "PA10 PC11"],
        sends: "function",
        interrupt: 37,
    },
    Published {
        name: "fx1n-10mt-f103rc",
        chip: "stm32f1",
        target: "thumbv7m-none-eabi",
        model: "fx1n",
        inputs: "PA0 PA1 PC5 PC6 PC7 PC4",
        outputs: "PA2 PC8 PB10 PB11",
        run: "PB6",
        switch: "",
        analog: "PA4 PA5",
        lines: ["PA9", "PA10"],
        sends: "function",
        interrupt: 37,
    },
    Published {
        name: "fx1n-14-f103rb",
        chip: "stm32f1",
        target: "thumbv7m-none-eabi",
        model: "fx1n",
        inputs: "PA0 PA1 PB9 PA6 PA7 PB5 PB4 PD2",
        outputs: "PB8 PB1 PB10 PB0 PC5 PC4",
        run: "PB12",
        switch: "PC9",
        analog: "PC1 PC2 PC0",
        lines: ["PA9", "PA10"],
        sends: "function",
        interrupt: 37,
    },
    Published {
        name: "fx2n-10mr-f030c8",
        chip: "stm32f0",
        target: "thumbv6m-none-eabi",
        model: "fx2n",
        inputs: "PA0 PB3 PB4 PA1 PF1 PC14",
        outputs: "PA4 PA7 PB14 PB15",
        run: "PB10",
        switch: "",
        analog: "PA5 PB0",
        lines: ["PA9", "PA10"],
        sends: "function 1",
        interrupt: 27,
    },
];

/// The address of USART1 of every STM32 here.
const USART1: u32 = 0x4001_3800;

fn pins(list: &'static str) -> Vec<&'static str> {
    list.split_whitespace().collect()
}

/// What executes an image, if it is there.
fn unicorn() -> Option<Command> {
    let python = env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let mut import = Command::new(&python);
    import.args(["-c", "import unicorn, elftools"]);
    if !import.output().is_ok_and(|output| output.status.success()) {
        leave_out("unicorn and pyelftools (RUNGC_PYTHON)");
        return None;
    }
    let mut run = Command::new(python);
    run.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients/pins.py"));
    Some(run)
}

impl Published {
    fn terminals(&self, class: char, count: usize) -> Vec<String> {
        let name = |n| format!("{class}{n:03o}");
        (0..count).map(name).collect()
    }

    /// Programs in which each output follows one input, for all inputs; with each, the pins in pairs.
    fn programs(&self) -> Vec<(String, Vec<(&'static str, &'static str)>)> {
        let (inputs, outputs) = (pins(self.inputs), pins(self.outputs));
        let [x, y] = [('X', &inputs), ('Y', &outputs)]
            .map(|(class, pins)| self.terminals(class, pins.len()));
        let rounds = inputs.len().max(outputs.len()).div_ceil(outputs.len());
        let round = |round: usize| {
            let mut list = String::new();
            let mut pairs = Vec::new();
            for (n, output) in y.iter().enumerate() {
                let input = (round * y.len() + n) % x.len();
                list += &format!("LD {}\nOUT {output}\n", x[input]);
                pairs.push((inputs[input], outputs[n]));
            }
            (list + "END\n", pairs)
        };
        (0..rounds).map(round).collect()
    }

    /// Builds an image, unless what it needs is missing.
    fn build(&self, folder: &Path, list: &str, backend: &str) -> Option<PathBuf> {
        if !tools(&["make", "arm-none-eabi-gcc"]) {
            return None;
        }
        let Some(cargo) = cargo(self.target) else {
            leave_out(&no_rust(self.target));
            return None;
        };
        std::fs::write(folder.join("p.il"), list).unwrap();
        let output = with_cargo(&cargo)
            .args([
                "build",
                "p.il",
                "--model",
                self.model,
                "--emit",
                "elf",
                "--backend",
                backend,
            ])
            .args(["--board", self.name, "-o", "p.elf", "--force"])
            .env("XDG_CACHE_HOME", common::cache())
            .current_dir(folder)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        Some(folder.join("p.elf"))
    }

    fn executed(&self, image: &Path, request: &Value) -> Option<Value> {
        let output = unicorn()?
            .arg(image)
            .args([self.chip, &request.to_string()])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        Some(serde_json::from_slice(&output.stdout).unwrap())
    }

    /// Each output follows its input, and nothing else is driven but the lamp of RUN.
    fn check(&self, backend: &str) -> Option<()> {
        let folder = folder(&[]);
        for (list, pairs) in self.programs() {
            let image = self.build(folder.path(), &list, backend)?;
            // All inputs off, each alone, and all of them; the switch is on RUN while its pin is low.
            let mut groups = vec![Vec::new()];
            groups.extend(pairs.iter().map(|(input, _)| vec![*input]));
            groups.push(pins(self.inputs));
            for group in &mut groups {
                group.extend(pins(self.switch));
            }
            let port = json!({ "at": USART1, "interrupt": self.interrupt, "bytes": "05" });
            let request = json!({ "low": pins(self.switch), "inputs": groups, "port": port });
            let found = self.executed(&image, &request)?;
            for (group, driven) in groups.iter().zip(found["outputs"].as_array().unwrap()) {
                let follows = pairs.iter().filter(|(input, _)| group.contains(input));
                let wanted: BTreeSet<_> = follows
                    .map(|(_, output)| *output)
                    .chain(pins(self.run))
                    .collect();
                let driven: BTreeSet<_> = driven
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|pin| pin.as_str().unwrap())
                    .collect();
                assert_eq!(driven, wanted, "{} ({backend}): {group:?}", self.name);
            }
            // The programming port answers a tool that asks whether a PLC is there.
            assert_eq!(found["sent"], "06", "{} ({backend})", self.name);
            assert_eq!(found["fed"], true, "{} ({backend})", self.name);
            self.check_modes(&found["modes"]);
        }
        Some(())
    }

    /// Pins are set up as what they are: inputs that nothing drives, outputs, pins of UARTs and converters.
    fn check_modes(&self, modes: &Value) {
        let receives = if self.sends == "function" {
            "input"
        } else {
            self.sends
        };
        for (list, mode) in [
            (self.inputs, "input"),
            (self.switch, "input"),
            (self.outputs, "output"),
            (self.run, "output"),
            (self.analog, "analog"),
            (self.lines[0], self.sends),
            (self.lines[1], receives),
        ] {
            for pin in pins(list) {
                assert_eq!(modes[pin], mode, "{}: {pin}", self.name);
            }
        }
    }
}

#[test]
fn pins_of_images_from_c_are_those_of_the_table() {
    for board in &PUBLISHED {
        if board.check("c").is_none() {
            return;
        }
    }
}

#[test]
fn pins_of_images_from_rust_are_those_of_the_table() {
    // One for each processor.
    for board in [&PUBLISHED[0], &PUBLISHED[3]] {
        if board.check("rust").is_none() {
            return;
        }
    }
}

#[test]
fn the_switch_stops_the_program() {
    let board = &PUBLISHED[0];
    let folder = folder(&[]);
    let list = "LD M8000\nOUT Y000\nEND\n";
    for backend in ["c", "rust"] {
        let Some(image) = board.build(folder.path(), list, backend) else {
            return;
        };
        // RUN at power-on, then STOP, then RUN; the lamp follows.
        let request = json!({ "low": ["PB2"], "inputs": [["PB2"], [], ["PB2"]] });
        let Some(found) = board.executed(&image, &request) else {
            return;
        };
        assert_eq!(
            found["outputs"],
            json!([["PC9", "PD10"], [], ["PC9", "PD10"]]),
            "{backend}"
        );
        // STOP at power-on: no output is ever on.
        let request = json!({ "low": [], "inputs": [[], ["PB2"]] });
        let found = board.executed(&image, &request).unwrap();
        assert_eq!(found["begin"], json!([]), "{backend}");
        assert_eq!(found["outputs"], json!([[], ["PC9", "PD10"]]), "{backend}");
    }
}

/// An image that only tries pins: all outputs are off, a key switches one of them on, another key or time off, and
/// what changes at inputs is reported.
#[test]
fn an_image_tries_pins_one_at_a_time() {
    for board in &PUBLISHED {
        if !tools(&["arm-none-eabi-gcc", "make"]) {
            return;
        }
        let folder = folder(&[]);
        let built = rungc(
            folder.path(),
            &["boards", board.name, "--pins-only", "-o", "pins.elf"],
        );
        assert!(built.status.success(), "{}", text(&built.stderr));
        let (inputs, outputs) = (pins(board.inputs), pins(board.outputs));
        // Each output after a key, each input alone, then time without keys.
        let mut groups: Vec<Vec<&str>> = outputs.iter().map(|_| Vec::new()).collect();
        let mut keys: Vec<&str> = groups.iter().map(|_| "n").collect();
        groups.extend(inputs.iter().map(|input| vec![*input]));
        keys.extend(inputs.iter().map(|_| "x"));
        let port = json!({ "at": USART1 });
        let request = json!({ "inputs": groups, "keys": keys, "port": port, "ms": 5 });
        let image = folder.path().join("pins.elf");
        let Some(found) = board.executed(&image, &request) else {
            return;
        };
        assert_eq!(found["begin"], json!([]), "{}", board.name);
        let said = |n: usize| found["said"][n].as_str().unwrap().to_string();
        for (n, output) in outputs.iter().enumerate() {
            assert_eq!(found["outputs"][n], json!([output]), "{}", board.name);
            assert!(
                said(n).ends_with(&format!("Y{n:03o} on\r\n")),
                "{}",
                said(n)
            );
        }
        for n in 0..inputs.len() {
            let step = outputs.len() + n;
            assert_eq!(found["outputs"][step], json!([]), "{}", board.name);
            assert!(
                said(step).contains(&format!("X{n:03o} on\r\n")),
                "{}",
                said(step)
            );
        }
        board.check_modes(&found["modes"]);
        // An output is on for two seconds.
        let request = json!({ "inputs": [[], []], "keys": ["n", ""], "port": port, "ms": 1500 });
        let found = board.executed(&image, &request).unwrap();
        assert_eq!(
            found["outputs"],
            json!([[outputs[0]], []]),
            "{}",
            board.name
        );
    }
}

#[test]
fn boards_are_listed_and_shown() {
    let folder = folder(&[]);
    let listed = rungc(folder.path(), &["boards"]);
    insta::assert_snapshot!("listed", text(&listed.stdout));
    for board in &PUBLISHED {
        let shown = rungc(folder.path(), &["boards", board.name]);
        insta::assert_snapshot!(board.name, text(&shown.stdout));
        // A description that is written out is read as it was.
        let written = rungc(folder.path(), &["boards", board.name, "--toml"]);
        std::fs::write(folder.path().join("own.toml"), &written.stdout).unwrap();
        let again = rungc(folder.path(), &["boards", "own.toml"]);
        assert_eq!(text(&again.stdout), text(&shown.stdout));
    }
    let unknown = rungc(folder.path(), &["boards", "fx9"]);
    assert_eq!(unknown.status.code(), Some(2));
    insta::assert_snapshot!("unknown", text(&unknown.stderr));
}

#[test]
fn uncertain_pins_of_a_program_are_reported() {
    let folder = folder(&[("p.il", b"LD X000\nOUT Y001\nEND\n")]);
    let args = [
        "build",
        "p.il",
        "--model",
        "fx1n",
        "--emit",
        "c",
        "--board",
        "fx1n-14-f103rb",
        "-o",
        "out",
    ];
    let output = rungc(folder.path(), &args);
    insta::assert_snapshot!(text(&output.stderr));
}
