//! The boards that rungc has descriptions of: their images, executed with a model of the microcontroller's registers,
//! read and drive the pins that the published tables say.

mod pico;

use crate::common::{folder, rungc, text};
use crate::tools::{cargo, leave_out, no_rust, tools, with_cargo};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A board's terminals by the published tables, which are not those that the descriptions are read from. Those of the
/// Pico, which has none, are written a second time.
struct Published {
    name: &'static str,
    chip: &'static str,
    target: &'static str,
    model: &'static str,
    inputs: &'static str,
    outputs: &'static str,
    /// Pins of lamps that are on in RUN.
    run: &'static str,
    /// Pins of lamps that are on after errors.
    error: &'static str,
    /// The pin of the switch, and whether it is low in RUN.
    switch: &'static str,
    is_low_in_run: bool,
    /// Pins of converters, in the order of their channels.
    analog: &'static str,
    /// Pins that converters drive, with the registers that hold what they convert.
    puts_out: &'static [(&'static str, u32)],
    /// Set-up of these pins.
    drives: &'static str,
    /// Pins on which UARTs send, and those on which they receive.
    lines: [&'static str; 2],
    /// Set-up of the pins that send and receive.
    line_modes: [&'static str; 2],
    /// Set-up of inputs, and of the switch.
    input_modes: [&'static str; 2],
    /// The pin that switches the driver of an RS-485 line.
    driver: &'static str,
    /// The UART of the programming port.
    port: u32,
    /// Two short slots for latched devices, and what is erased at once.
    slots: [u32; 2],
    page: u32,
}

/// The address of USART1 of every STM32 here.
const USART1: u32 = 0x4001_3800;

/// Common properties of the boards with an STM32F103.
const F103: Published = Published {
    name: "",
    chip: "stm32f1",
    target: "thumbv7m-none-eabi",
    model: "fx2n-compatible",
    inputs: "",
    outputs: "",
    run: "",
    error: "",
    switch: "",
    is_low_in_run: true,
    analog: "",
    puts_out: &[],
    drives: "analog",
    lines: ["PA9", "PA10"],
    line_modes: ["function", "input"],
    input_modes: ["input", "input"],
    driver: "",
    port: USART1,
    slots: [0x0803_C000, 0x0803_E000],
    page: 2048,
};

const PUBLISHED: [Published; 5] = [
    Published {
        name: "fx3u-f103vc",
        model: "fx3u-compatible",
        inputs: "PB13 PB14 PB11 PB12 PE15 PB10 PE13 PE14 PE11 PE12 PE9 PE10 PE7 PE8",
        outputs: "PC9 PC8 PA8 PA0 PB3 PD12 PB15 PA7 PA6 PA2",
        run: "PD10",
        switch: "PB2",
        analog: "PA1 PA3 PC4 PC5 PC0 PC1 PC2 PC3",
        puts_out: &[("PA4", 0x4000_7408), ("PA5", 0x4000_7414)],
        lines: ["PA9 PC10", "PA10 PC11"],
        driver: "PA14",
        ..F103
    },
    Published {
        name: "fx1n-10mt-f103rc",
        inputs: "PA0 PA1 PC5 PC6 PC7 PC4",
        outputs: "PA2 PC8 PB10 PB11",
        run: "PB6",
        analog: "PA4",
        puts_out: &[("PA5", 0x4000_7414)],
        ..F103
    },
    Published {
        name: "fx1n-14-f103rb",
        inputs: "PA0 PA1 PB9 PA6 PA7 PB5 PB4 PD2",
        outputs: "PB8 PB1 PB10 PB0 PC5 PC4",
        run: "PB12",
        error: "PB13",
        switch: "PC9",
        analog: "PC1 PC2 PC0",
        slots: [0x0801_C000, 0x0801_E000],
        page: 1024,
        ..F103
    },
    Published {
        name: "fx2n-10mr-f030c8",
        chip: "stm32f0",
        target: "thumbv6m-none-eabi",
        inputs: "PA0 PB3 PB4 PA1 PF1 PC14",
        outputs: "PA4 PA7 PB14 PB15",
        run: "PB10",
        error: "PB11",
        analog: "PA5 PB0",
        puts_out: &[("PA6", 0x4000_0434)],
        drives: "function 1",
        line_modes: ["function 1", "function 1"],
        slots: [0x0800_E000, 0x0800_F000],
        page: 1024,
        ..F103
    },
    Published {
        name: "pico",
        chip: "rp2040",
        target: "thumbv6m-none-eabi",
        model: "fx3u-compatible",
        inputs: "GP6 GP7 GP8 GP9 GP10 GP11 GP12 GP13",
        outputs: "GP14 GP15 GP17 GP19 GP20 GP21",
        run: "GP25",
        error: "GP2",
        switch: "GP22",
        is_low_in_run: false,
        analog: "GP26 GP27 GP28",
        puts_out: &[("GP16", 0x4005_000C), ("GP18", 0x4005_0020)],
        drives: "function 4",
        lines: ["GP0 GP4", "GP1 GP5"],
        line_modes: ["function 2", "function 2"],
        input_modes: ["pulled up", "pulled down"],
        driver: "GP3",
        port: 0x4003_4000,
        slots: [0x101F_0000, 0x101F_1000],
        page: 4096,
    },
];

fn pins(list: &'static str) -> Vec<&'static str> {
    list.split_whitespace().collect()
}

/// A Python with what executes images and reads them, if it is there.
fn python() -> Option<Command> {
    let python = env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let mut import = Command::new(&python);
    import.args(["-c", "import unicorn, elftools, uf2utils"]);
    if !import.output().is_ok_and(|output| output.status.success()) {
        leave_out("unicorn, pyelftools and uf2utils (RUNGC_PYTHON)");
        return None;
    }
    Some(Command::new(python))
}

/// A script of `tests/clients`.
fn client(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/clients")
        .join(name)
}

/// Output of a script.
fn answer(mut script: Command) -> Value {
    let output = script.output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A program that uses all of a board: each output follows one or two inputs; the last input counts in D200 and D201,
/// which are latched; analog inputs are copied to D100 and following and from there to outputs. At the second count
/// `ABC` is sent over RS-485, from the third on there is an error.
struct Trial {
    list: String,
    /// Inputs and the outputs that follow them.
    pairs: Vec<(&'static str, &'static str)>,
}

impl Published {
    fn trial(&self) -> Trial {
        let (inputs, outputs) = (pins(self.inputs), pins(self.outputs));
        let (mut list, mut pairs) = (String::new(), Vec::new());
        for (n, output) in outputs.iter().enumerate() {
            let followed = (n..inputs.len()).step_by(outputs.len());
            for (i, input) in followed.enumerate() {
                let contact = if i == 0 { "LD" } else { "OR" };
                list += &format!("{contact} X{input:03o}\n");
                pairs.push((inputs[input], *output));
            }
            list += &format!("OUT Y{n:03o}\n");
        }
        list += "LD M8000\n";
        for channel in 0..pins(self.analog).len() {
            list += &format!("RD3A K0 K{channel} D{}\n", 100 + channel);
        }
        for channel in 0..self.puts_out.len() {
            list += &format!("WR3A K0 K{channel} D{}\n", 100 + channel);
        }
        let last = inputs.len() - 1;
        list += &format!("LDP X{last:03o}\nINC D200\nINC D201\nLD>= D200 K3\nDIV K1 D199 D20\n");
        if !self.driver.is_empty() {
            list += "LD M8002\nMOV H0C81 D8120\nLD M8000\nRS D300 K3 D310 K0\nLD= D200 K2\nPLS M20\n\
                     LD M20\nMOV H4241 D300\nMOV H0043 D301\nSET M8122\n";
        }
        list += "END\n";
        Trial { list, pairs }
    }

    /// The description, with short slots that are saved to at once.
    fn description(&self, folder: &Path) -> String {
        let written = rungc(folder, &["boards", self.name, "--toml"]);
        let own = |line: &str| match line.starts_with("slots") {
            true => {
                let slot = |at: u32| format!("{{ origin = 0x{at:X}, length = {} }}", self.page);
                let [a, b] = self.slots.map(slot);
                format!("every_ms = 10\nslots = [{a}, {b}]\n")
            }
            false => format!("{line}\n"),
        };
        text(&written.stdout).lines().map(own).collect()
    }

    /// Builds an image, unless what it needs is missing.
    fn build(&self, folder: &Path, backend: &str, emit: &str) -> Option<PathBuf> {
        if !tools(&["make", "arm-none-eabi-gcc"]) {
            return None;
        }
        let Some(cargo) = cargo(self.target) else {
            leave_out(&no_rust(self.target));
            return None;
        };
        std::fs::write(folder.join("p.il"), self.trial().list).unwrap();
        std::fs::write(folder.join("own.toml"), self.description(folder)).unwrap();
        let image = format!("p.{emit}");
        let output = with_cargo(&cargo)
            .args(["build", "p.il", "--model", self.model])
            .args(["--emit", emit, "--backend", backend])
            .args(["--board", "own.toml", "-o", &image, "--force"])
            .current_dir(folder)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
        Some(folder.join(image))
    }

    fn executed(&self, image: &Path, request: &Value) -> Option<Value> {
        let mut run = python()?;
        match self.chip {
            "rp2040" => run.arg(client("rp2040.py")).arg(image),
            chip => run.arg(client("stm32.py")).arg(image).arg(chip),
        };
        if self.page == 2048 {
            run.arg("--large");
        }
        run.arg(request.to_string());
        Some(answer(run))
    }

    /// The pins that are low while the switch is on RUN.
    fn low_in_run(&self) -> Vec<&'static str> {
        match self.is_low_in_run {
            true => pins(self.switch),
            false => Vec::new(),
        }
    }

    /// Executes an image made from this language in all respects.
    fn check(&self, backend: &str) -> Option<()> {
        let folder = folder(&[]);
        let image = self.build(folder.path(), backend, "elf")?;
        self.check_pins(&image, backend)?;
        self.check_switch(&image, backend);
        self.check_saves(&image, backend);
        if self.chip == "rp2040" {
            pico::check_emulated(self, &image);
        }
        Some(())
    }

    /// Each output follows its inputs, and nothing else is driven but the lamps; converters, the programming port and
    /// the line of RS-485 do what the program wants.
    fn check_pins(&self, image: &Path, backend: &str) -> Option<()> {
        let about = format!("{} ({backend})", self.name);
        let inputs = pins(self.inputs);
        // All inputs off, each alone, and all of them; the last one three times in all.
        let last = vec![*inputs.last().unwrap()];
        let mut groups = vec![Vec::new()];
        groups.extend(inputs.iter().map(|input| vec![*input]));
        groups.extend([Vec::new(), inputs.clone(), Vec::new(), last]);
        for group in &mut groups {
            group.extend(self.low_in_run());
        }
        let channels = pins(self.analog);
        let count = |group: usize, channel: usize| 400 * (channel + 1) + group;
        let analog = (0..groups.len()).map(|group| {
            let counts = channels.iter().enumerate();
            let counts = counts.map(|(n, pin)| (pin.to_string(), json!(count(group, n))));
            Value::Object(counts.collect())
        });
        let registers: Vec<u32> = self.puts_out.iter().map(|(_, at)| *at).collect();
        let request = json!({
            "low": self.low_in_run(), "inputs": groups, "port": { "at": self.port, "bytes": "05" },
            "analog": analog.collect::<Vec<_>>(), "registers": registers, "read": [100, channels.len()],
            "watch": pins(self.driver),
        });
        let found = self.executed(image, &request)?;
        let pairs = self.trial().pairs;
        for (n, group) in groups.iter().enumerate() {
            let follows = pairs.iter().filter(|(input, _)| group.contains(input));
            let error = if n + 1 == groups.len() {
                self.error
            } else {
                ""
            };
            let wanted: BTreeSet<_> = follows
                .map(|(_, output)| *output)
                .chain(pins(self.run))
                .chain(pins(error))
                .collect();
            let driven = found["outputs"][n].as_array().unwrap().iter();
            let driven: BTreeSet<_> = driven.map(|pin| pin.as_str().unwrap()).collect();
            assert_eq!(driven, wanted, "{about}: {group:?}");
            let counts: Vec<_> = (0..channels.len())
                .map(|channel| count(n, channel))
                .collect();
            assert_eq!(
                found["said"][n],
                json!(counts),
                "{about}: {:?}",
                self.analog
            );
            assert_eq!(
                found["words"][n],
                json!(counts[..registers.len()]),
                "{about}"
            );
        }
        // The programming port answers a tool that asks whether a PLC is there.
        assert_eq!(found["sent"], "06", "{about}");
        assert_eq!(found["fed"], true, "{about}");
        self.check_modes(&found["modes"]);
        if !self.driver.is_empty() {
            let events = found["events"][groups.len() - 3].as_array().unwrap();
            let (high, low) = (
                format!("{} high", self.driver),
                format!("{} low", self.driver),
            );
            let line = [&high, "41", "42", "43", &low].map(|event| json!(event));
            let there = events.windows(line.len()).any(|events| events == line);
            assert!(there, "{about}: {events:?}");
        }
        Some(())
    }

    /// Pins are set up as what they are: inputs that nothing drives, outputs, pins of UARTs and converters.
    fn check_modes(&self, modes: &Value) {
        let puts_out = self.puts_out.iter().map(|(pin, _)| (*pin, self.drives));
        let lists = [
            (self.inputs, self.input_modes[0]),
            (self.switch, self.input_modes[1]),
            (self.outputs, "output"),
            (self.run, "output"),
            (self.error, "output"),
            (self.driver, "output"),
            (self.analog, "analog"),
            (self.lines[0], self.line_modes[0]),
            (self.lines[1], self.line_modes[1]),
        ];
        let lists = lists.into_iter();
        let known =
            lists.flat_map(|(list, mode)| pins(list).into_iter().map(move |pin| (pin, mode)));
        for (pin, mode) in known.chain(puts_out) {
            assert_eq!(modes[pin], mode, "{}: {pin}", self.name);
        }
    }

    /// The switch stops the program and starts it.
    fn check_switch(&self, image: &Path, about: &str) {
        if self.switch.is_empty() {
            return;
        }
        let (first, output) = (pins(self.inputs)[0], pins(self.outputs)[0]);
        let state = |run: bool| match run == self.is_low_in_run {
            true => vec![first, self.switch],
            false => vec![first],
        };
        // RUN at power-on, then STOP, then RUN; the lamp follows.
        let request =
            json!({ "low": state(true), "inputs": [state(true), state(false), state(true)] });
        let found = self.executed(image, &request).unwrap();
        let mut on = vec![output, self.run];
        on.sort_unstable();
        assert_eq!(found["outputs"], json!([on, [], on]), "{about}");
        // STOP at power-on: no output is ever on.
        let request = json!({ "low": state(false), "inputs": [state(false), state(true)] });
        let found = self.executed(image, &request).unwrap();
        assert_eq!(found["begin"], json!([]), "{about}");
        assert_eq!(found["outputs"], json!([[], on]), "{about}");
    }

    /// The supply is cut after each operation of flash around the change to another slot: latched devices have their
    /// old values or the new ones, and each value was there.
    fn check_saves(&self, image: &Path, backend: &str) {
        let about = format!("{} ({backend})", self.name);
        let request = json!({
            "low": self.low_in_run(), "key": pins(self.inputs).last(), "slot": self.page,
            "port": { "at": self.port }, "before": 12,
        });
        let found = self.executed(image, &request).unwrap();
        let pairs: Vec<[i64; 2]> = serde_json::from_value(found["found"].clone()).unwrap();
        let erasures = found["kinds"].as_array().unwrap().iter();
        assert!(
            erasures.filter(|kind| *kind == "erase").count() > 1,
            "{about}"
        );
        for pair in &pairs {
            assert_eq!(pair[0], pair[1], "{about}: torn");
        }
        let values: Vec<i64> = pairs.iter().map(|pair| pair[0]).collect();
        let steps = values
            .windows(2)
            .all(|two| (0..=1).contains(&(two[1] - two[0])));
        assert!(steps && values[0] > 0, "{about}: {values:?}");
        assert_eq!(json!(pairs.last()), found["last"], "{about}");
        assert!(
            values[0] + 3 <= *values.last().unwrap(),
            "{about}: {values:?}"
        );
    }
}

#[test]
fn images_from_c_do_what_the_tables_say() {
    for board in &PUBLISHED {
        if board.check("c").is_none() {
            return;
        }
    }
}

#[test]
fn images_from_rust_do_what_the_tables_say() {
    // One for each chip.
    for board in [&PUBLISHED[0], &PUBLISHED[3], &PUBLISHED[4]] {
        if board.check("rust").is_none() {
            return;
        }
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
        let port = json!({ "at": board.port });
        let request = json!({ "inputs": groups, "keys": keys, "port": port, "ms": 5 });
        let image = folder.path().join("pins.elf");
        let Some(found) = board.executed(&image, &request) else {
            return;
        };
        assert_eq!(found["begin"], json!([]), "{}", board.name);
        let messages = |n: usize| found["said"][n].as_str().unwrap().to_string();
        for (n, output) in outputs.iter().enumerate() {
            assert_eq!(found["outputs"][n], json!([output]), "{}", board.name);
            assert!(
                messages(n).ends_with(&format!("Y{n:03o} on\r\n")),
                "{}",
                messages(n)
            );
        }
        for n in 0..inputs.len() {
            let step = outputs.len() + n;
            assert_eq!(found["outputs"][step], json!([]), "{}", board.name);
            assert!(
                messages(step).contains(&format!("X{n:03o} on\r\n")),
                "{}",
                messages(step)
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
