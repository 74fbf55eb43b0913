//! Random programs of pulse outputs: moves that inputs begin, change and end, with the registers and relays that set
//! speeds, ramps, limits and stops; among them clocks, modules and angles, which the runtime in C has, too.

use crate::operands::accepted;
use crate::rng::Rng;
use rungc_models::ModelId;

/// A program of some moves for a model.
pub fn program(seed: u64, model: ModelId) -> String {
    let mut writer = Writer {
        rng: Rng::new(seed),
        model,
        lines: Vec::new(),
    };
    for _ in 0..2 + writer.rng.below(4) {
        writer.rung("LD M8002", Writer::setting);
    }
    for _ in 0..3 + writer.rng.below(6) {
        let contact = writer.contact();
        writer.rung(&contact, Writer::motion);
        let contact = writer.contact();
        match writer.rng.below(4) {
            0 => writer.rung(&contact, Writer::setting),
            1 => writer.rung(&contact, Writer::service),
            2 => writer.rung(&contact, |writer| format!("OUT {}", writer.special_relay())),
            _ => {}
        }
    }
    writer.lines.push("END".to_string());
    writer.lines.join("\n") + "\n"
}

/// Number of attempts to write an instruction that the model has.
const ATTEMPTS: u32 = 12;

struct Writer {
    rng: Rng,
    model: ModelId,
    lines: Vec<String>,
}

impl Writer {
    /// A contact and an instruction that the model accepts.
    fn rung(&mut self, contact: &str, instruction: impl Fn(&mut Writer) -> String) {
        let found = (0..ATTEMPTS).find_map(|_| {
            let line = instruction(self);
            accepted(&line, self.model).then_some(line)
        });
        if let Some(line) = found {
            self.lines.extend([contact.to_string(), line]);
        }
    }

    fn contact(&mut self) -> String {
        let input = self.rng.below(8);
        match self.rng.below(8) {
            0 => format!("LDI X00{input}"),
            1 => format!("LD M{}", self.rng.below(8)),
            2 => "LD M8000".to_string(),
            _ => format!("LD X00{input}"),
        }
    }

    /// A word: a constant near one of these, or a register.
    fn word(&mut self, near: &[u32]) -> String {
        if self.rng.percent(15) {
            return format!("D{}", self.rng.below(20));
        }
        let value = self.rng.pick(near).unwrap_or(0);
        let value = value + self.rng.below(value / 4 + 2);
        let is_negative = self.rng.percent(20);
        format!("K{}{value}", if is_negative { "-" } else { "" })
    }

    fn hz(&mut self) -> String {
        self.word(&[1, 10, 50, 300, 2000, 9000, 24_000, 80_000])
    }

    fn count(&mut self) -> String {
        self.word(&[0, 1, 3, 40, 900, 7000, 25_000])
    }

    /// An output that sends pulses, and a device for its direction.
    fn outputs(&mut self) -> (String, String) {
        let output = self.rng.below(3);
        let direction = self.rng.pick(&["Y004", "Y005", "M30", "S5", "Y001"]);
        (
            format!("Y00{output}"),
            direction.unwrap_or("Y004").to_string(),
        )
    }

    fn motion(&mut self) -> String {
        let wide = if self.rng.percent(50) { "D" } else { "" };
        let (hz, count) = (self.hz(), self.count());
        let (output, direction) = self.outputs();
        let (dog, zero) = (self.rng.below(8), self.rng.below(8));
        match self.rng.below(12) {
            0 => format!("{wide}PLSY {hz} {count} {output}"),
            1 => {
                let ramp = self.word(&[20, 50, 100, 500, 4000]);
                format!("{wide}PLSR {hz} {count} {ramp} {output}")
            }
            2 | 3 => format!("{wide}PLSV {hz} {output} {direction}"),
            4 => {
                let (width, period) = (self.word(&[1, 5, 30]), self.word(&[10, 40, 300]));
                format!("PWM {width} {period} {output}")
            }
            5 | 6 => format!("{wide}DRVI {count} {hz} {output} {direction}"),
            7 | 8 => format!("{wide}DRVA {count} {hz} {output} {direction}"),
            9 => {
                let creep = self.hz();
                format!("{wide}ZRN {hz} {creep} X00{dog} {output}")
            }
            10 => format!("DSZR X00{dog} X00{zero} {output} {direction}"),
            _ => format!("{wide}DVIT {count} {hz} {output} {direction}"),
        }
    }

    fn special_relay(&mut self) -> String {
        let number = match self.rng.percent(40) {
            true => 8140 + self.rng.below(10),
            false => 8340 + self.rng.below(45),
        };
        format!("M{number}")
    }

    /// Something that decides how moves are made.
    fn setting(&mut self) -> String {
        match self.rng.below(4) {
            0 => format!("SET {}", self.special_relay()),
            1 => format!("DMOV {} D{}", self.hz(), 8340 + self.rng.below(40)),
            2 => format!("MOV {} D{}", self.hz(), 8140 + self.rng.below(10)),
            _ => format!("MOV {} D{}", self.hz(), 8340 + self.rng.below(40)),
        }
    }

    /// Something else that the runtime in C has.
    fn service(&mut self) -> String {
        let (first, second) = (self.rng.below(20), 20 + self.rng.below(20));
        let count = 1 + self.rng.below(6);
        match self.rng.below(12) {
            0 => format!("DSIN D{first} D{second}"),
            1 => format!("DCOS D{first} D{second}"),
            2 => format!("DTAN D{first} D{second}"),
            3 => format!("TRD D{first}"),
            4 => format!("TADD D{first} D{} D{second}", first + 3),
            5 => format!("TSUB D{first} D{} D{second}", first + 3),
            6 => format!("TCMP D{first} D{} D{} D{second} M10", first + 1, first + 2),
            7 => format!("TZCP D{first} D{} D{second} M14", first + 3),
            8 => format!("FROM K0 K{count} D{second} K{count}"),
            9 => format!("TO K0 K{count} D{first} K{count}"),
            10 => format!("HOUR K1 D{second} M20"),
            _ => format!("DFLT D{first} D{second}"),
        }
    }
}
