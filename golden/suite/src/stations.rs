//! Random programs of equal stations: the same rungs again and again, with other devices.

use crate::rng::Rng;

/// Common properties of all stations in a row.
struct Row {
    rungs: Vec<Rung>,
    /// Relay of the first station from which the others count, and how far the stations are apart.
    base: u32,
    apart: u32,
    /// The same of timers, counters and registers.
    others_apart: u32,
    stations: u32,
}

/// Contacts and coils, each a verb and what it names.
struct Rung(Vec<(&'static str, Named)>);

/// Device that a station names.
#[derive(Clone, Copy)]
enum Named {
    /// An input or output, and how far that of the next station is.
    Terminal(char, u32, u32),
    /// A relay of this station, of the one before or of the next one.
    Own(u32),
    /// A relay of all.
    Shared(u32),
    /// A timer, counter or register, and what follows it in the list.
    Numbered(char, u32, &'static str),
}

/// A program of a few rows of stations, with some rungs between them.
pub fn program(seed: u64) -> String {
    let mut rng = Rng::new(seed);
    let mut lines = Vec::new();
    for _ in 0..1 + rng.below(3) {
        let row = Row::new(&mut rng);
        row.write(&mut lines);
        lines.push(format!("LD X{:03o}", rng.below(16)));
        lines.push(format!(
            "OUT M{}",
            row.base + rng.below(row.apart * row.stations)
        ));
    }
    lines.push("END".into());
    lines.join("\n") + "\n"
}

impl Row {
    fn new(rng: &mut Rng) -> Row {
        let apart = 2 + rng.below(10);
        let base = rng.pick(&[20, 100, 450, 490, 700]).unwrap_or(20) + rng.below(10);
        let inputs_apart = 1 + rng.below(4);
        let rungs = (0..1 + rng.below(5))
            .map(|_| Rung::new(rng, apart, inputs_apart))
            .collect();
        Row {
            rungs,
            base,
            apart,
            others_apart: 1 + rng.below(3),
            stations: 2 + rng.below(40),
        }
    }

    fn write(&self, lines: &mut Vec<String>) {
        for station in 0..self.stations {
            let own = self.base + self.apart * station;
            for (verb, named) in self.rungs.iter().flat_map(|rung| &rung.0) {
                lines.push(match *named {
                    // Rows are longer than terminals last, and begin anew.
                    Named::Terminal(class, number, apart) => {
                        format!("{verb} {class}{:03o}", (number + apart * station) % 40)
                    }
                    Named::Own(number) => format!("{verb} M{}", own + number - self.apart),
                    Named::Shared(number) => format!("{verb} M{number}"),
                    Named::Numbered(class, number, after) => {
                        let number = number + self.others_apart * station;
                        format!("{verb} {class}{number}{after}")
                    }
                });
            }
        }
    }
}

impl Rung {
    fn new(rng: &mut Rng, apart: u32, inputs_apart: u32) -> Rung {
        let named = |rng: &mut Rng| match rng.below(10) {
            // Seldom otherwise than in the other rungs, of which no loop can be made then.
            0..=2 if rng.percent(4) => Named::Terminal('X', rng.below(8), 1 + rng.below(4)),
            0..=2 => Named::Terminal('X', rng.below(8), inputs_apart),
            3 => Named::Terminal('Y', rng.below(8), 2),
            4 => Named::Shared(rng.below(10)),
            5 => Named::Own(rng.below(3 * apart)),
            _ => Named::Own(apart + rng.below(apart)),
        };
        let verbs: &[&str] = match rng.below(4) {
            0 => &["ANDP", "ANDF", "ORP", "AND", "OR"],
            _ => &["AND", "ANI", "OR", "ORI"],
        };
        let mut parts = vec![(rng.pick(&["LD", "LDI"]).unwrap_or("LD"), named(rng))];
        for _ in 0..1 + rng.below(5) {
            parts.push(match rng.below(6) {
                0 => contact(rng),
                _ => (rng.pick(verbs).unwrap_or("AND"), named(rng)),
            });
        }
        for _ in 0..1 + rng.below(2) {
            let verb = rng
                .pick(&["OUT", "OUT", "OUT", "SET", "RST"])
                .unwrap_or("OUT");
            let target = match rng.below(8) {
                5..=7 if rng.percent(60) => {
                    parts.push(action(rng));
                    continue;
                }
                0 => Named::Terminal('Y', rng.below(8), 2),
                1 => Named::Shared(10 + rng.below(5)),
                _ => Named::Own(apart + rng.below(apart)),
            };
            parts.push((verb, target));
        }
        Rung(parts)
    }
}

/// A contact of a timer or counter, or a comparison of a register or a current value.
fn contact(rng: &mut Rng) -> (&'static str, Named) {
    let class = rng.pick(&['T', 'C', 'D']).unwrap_or('T');
    let (verbs, after): (&[&str], _) = match rng.below(2) {
        0 if class != 'D' => (&["AND", "ANI", "OR", "ORI"], ""),
        _ => (&["AND>", "AND=", "OR<", "OR<>"], " K3"),
    };
    let verb = rng.pick(verbs).unwrap_or("AND");
    (verb, numbered(rng, class, after))
}

/// Instruction of a rung on a timer, counter or register.
fn action(rng: &mut Rng) -> (&'static str, Named) {
    let (verb, class, after) = rng
        .pick(&[
            ("OUT", 'T', " K2"),
            ("OUT", 'T', " K5"),
            ("OUT", 'T', " D5"),
            ("OUT", 'C', " K3"),
            ("OUT", 'C', " K1"),
            ("OUT", 'C', " D4"),
            ("RST", 'T', ""),
            ("RST", 'C', ""),
            ("MOV K4", 'D', ""),
            ("MOV T3", 'D', ""),
            ("MOV D3", 'C', ""),
            ("MOVP T2", 'D', ""),
            ("INCP", 'D', ""),
            ("ADDP D2 K7", 'D', ""),
            ("PLS", 'M', ""),
            ("PLF", 'M', ""),
        ])
        .unwrap_or(("OUT", 'T', " K1"));
    let named = match class {
        'M' => Named::Own(rng.below(30)),
        _ => numbered(rng, class, after),
    };
    (verb, named)
}

/// One of the first timers, counters or registers of a row.
fn numbered(rng: &mut Rng, class: char, after: &'static str) -> Named {
    Named::Numbered(class, rng.below(12), after)
}
