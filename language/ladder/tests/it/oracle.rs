//! Interpretation of a drawing, independent of the crate: power floods over the characters of the picture, from the
//! left rail through closed contacts to the outputs, and must drive the same outputs as the list, for random contacts.

use crate::common;
use crate::common::programs_in;
use proptest::prelude::*;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_catalogue::{Basic, Join, Lower};
use rungc_ladder::text::{Style, draw_alike};
use rungc_ladder::{Network, NetworkBody, build};
use rungc_models::{Model, ModelId};
use rungc_syntax::Program;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Number of random assignments tried for each network.
const TRIALS: u64 = 24;

/// Widths of the drawings: so wide that few are continued below, and so narrow that most are.
const WIDTHS: [usize; 2] = [500, 60];

/// A random bit for what a contact is called, always the same within a trial.
fn chance(trial: u64, name: &str) -> bool {
    let mut hash = trial.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0xcbf2_9ce4_8422_2325;
    for byte in name.bytes() {
        hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
    hash ^= hash >> 29;
    hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 60 & 1 == 1
}

/// Result of a symbol that changes it: `/` inverts, arrows need a separate bit.
fn changed(symbol: char, power: bool, trial: u64) -> bool {
    match symbol {
        '/' => !power,
        '↑' => power && chance(trial, "MEP"),
        _ => !power && chance(trial, "MEF"),
    }
}

/// Operation of a contact, the prefix of its device in its name, and true if it is closed while the device is off.
fn contact(basic: Basic) -> Option<(Join, &'static str, bool)> {
    Some(match basic {
        Basic::Ld => (Join::Ld, "", false),
        Basic::Ldi => (Join::Ld, "", true),
        Basic::Ldp => (Join::Ld, "↑", false),
        Basic::Ldf => (Join::Ld, "↓", false),
        Basic::And => (Join::And, "", false),
        Basic::Ani => (Join::And, "", true),
        Basic::Andp => (Join::And, "↑", false),
        Basic::Andf => (Join::And, "↓", false),
        Basic::Or => (Join::Or, "", false),
        Basic::Ori => (Join::Or, "", true),
        Basic::Orp => (Join::Or, "↑", false),
        Basic::Orf => (Join::Or, "↓", false),
        _ => return None,
    })
}

/// Outputs driven by the instructions of a network, computed as the PLC does: with a stack of blocks and one of
/// branches.
fn by_list(resolved: &Resolved, network: &Network, trial: u64) -> Vec<bool> {
    let (mut blocks, mut branches, mut driven) = (vec![true], Vec::new(), Vec::new());
    for at in network.instrs.clone().skip(network.labels) {
        let instr = &resolved.program.instrs[at];
        let operands: Vec<_> = instr.operands.iter().map(|o| o.kind.to_string()).collect();
        let top = blocks.len() - 1;
        let basic = match resolved.instrs[at].lower {
            Some(Lower::Basic(basic)) => Some(basic),
            _ => None,
        };
        let bit = match (resolved.instrs[at].lower, basic.and_then(contact)) {
            (Some(Lower::Compare(join, _)), _) => {
                let prefix = match join {
                    Join::Ld => "LD",
                    Join::And => "AND",
                    Join::Or => "OR",
                };
                let sign = instr.mnemonic.strip_prefix(prefix).expect("a comparison");
                Some((
                    join,
                    chance(trial, &format!("[{sign} {}]", operands.join(" "))),
                ))
            }
            (_, Some((join, edge, closed))) => {
                let on = chance(trial, &format!("{edge}{}", operands[0]));
                Some((join, on != closed))
            }
            _ => None,
        };
        match (bit, basic) {
            (Some((Join::Ld, bit)), _) => blocks.push(bit),
            (Some((Join::And, bit)), _) => blocks[top] &= bit,
            (Some((Join::Or, bit)), _) => blocks[top] |= bit,
            (_, Some(Basic::Anb)) => {
                let last = blocks.pop().expect("a block");
                blocks[top - 1] &= last;
            }
            (_, Some(Basic::Orb)) => {
                let last = blocks.pop().expect("a block");
                blocks[top - 1] |= last;
            }
            (_, Some(Basic::Mps)) => branches.push(blocks[top]),
            (_, Some(Basic::Mrd)) => blocks[top] = *branches.last().expect("a branch"),
            (_, Some(Basic::Mpp)) => blocks[top] = branches.pop().expect("a branch"),
            (_, Some(Basic::Inv)) => blocks[top] = changed('/', blocks[top], trial),
            (_, Some(Basic::Mep)) => blocks[top] = changed('↑', blocks[top], trial),
            (_, Some(Basic::Mef)) => blocks[top] = changed('↓', blocks[top], trial),
            _ => driven.push(blocks[top]),
        }
    }
    driven
}

/// A drawing as its characters.
struct Picture {
    rows: Vec<Vec<char>>,
    left: usize,
    right: usize,
}

/// Connections of a drawing.
struct Circuit {
    elements: Vec<Element>,
    /// The places before outputs, from the top down.
    outputs: Vec<(usize, usize)>,
    /// The number of the wire that each place is on; that of the left rail is 0.
    nets: HashMap<(usize, usize), usize>,
}

/// Something between two wires.
struct Element {
    /// Its name and symbol: `X000` and `/`, `[= D0 K1]` and ` `, or a change of the result.
    name: String,
    symbol: char,
    from: (usize, usize),
    to: (usize, usize),
}

impl Picture {
    fn of(drawn: &str) -> Picture {
        let rows: Vec<Vec<char>> = drawn.lines().map(|line| line.chars().collect()).collect();
        let is_rail = |c: &char| matches!(c, '│' | '├');
        let left = rows
            .iter()
            .filter_map(|row| row.iter().position(is_rail))
            .min();
        // Notes stand to the right of the right rail; above the first contacts there is none.
        let right = rows[0].iter().rposition(|c| *c == '│').expect("rails");
        Picture {
            rows,
            left: left.unwrap_or_default(),
            right,
        }
    }

    fn at(&self, (row, column): (usize, usize)) -> char {
        let row = self.rows.get(row);
        row.and_then(|row| row.get(column)).copied().unwrap_or(' ')
    }

    /// The name above a contact.
    fn above(&self, row: usize, middle: usize) -> String {
        let above = &self.rows[row - 1];
        let is_name = |column: &usize| !matches!(self.at((row - 1, *column)), ' ' | '│');
        let near = [middle, middle - 1, middle + 1].into_iter().find(is_name);
        let near = near.unwrap_or_else(|| panic!("a contact without a name in row {row}"));
        let start = (0..=near).rev().take_while(is_name).last().unwrap_or(near);
        let end = (near..above.len())
            .take_while(is_name)
            .last()
            .unwrap_or(near);
        above[start..=end].iter().collect()
    }

    /// The elements, and the places before outputs, from the top down.
    fn elements(&self) -> (Vec<Element>, Vec<(usize, usize)>) {
        let (mut elements, mut outputs) = (Vec::new(), Vec::new());
        for (row, line) in self.rows.iter().enumerate() {
            let mut column = self.left + 1;
            while column < self.right {
                let wired =
                    wires(self.at((row, column - 1))).contains('R') || column == self.left + 1;
                let end = match (line.get(column).copied(), self.at((row, column + 2))) {
                    (Some('┤'), '├') if wired && column + 2 < self.right => column + 2,
                    (Some('['), _) if wired => self.close(row, column, ']'),
                    (Some('('), _) if wired => self.close(row, column, ')'),
                    (Some('/' | '↑' | '↓'), _) if wired => column,
                    (Some('→'), _) if wired => self.digits(row, column + 1),
                    (Some(digit), _) if digit.is_ascii_digit() && column == self.left + 1 => {
                        self.digits(row, column) + 1
                    }
                    _ => {
                        column += 1;
                        continue;
                    }
                };
                let from = (row, column - 1);
                if matches!(line[column], '→') {
                    let after = self.at((row, end + 1));
                    assert!(
                        matches!(after, ' ' | '│'),
                        "row {row} continues after its mark: {after}"
                    );
                } else if line[column].is_ascii_digit() {
                    assert_eq!(
                        (self.at((row, end)), self.at(from)),
                        ('→', '│'),
                        "row {row}"
                    );
                }
                if end + 1 == self.right && column != end && line[column] != '→' {
                    outputs.push(from);
                } else {
                    let first = self.at((row, column));
                    let fold = |from, to| self.rows[row][from..=to].iter().collect::<String>();
                    let (name, symbol) = match first {
                        '→' => (fold(column + 1, end), '→'),
                        digit if digit.is_ascii_digit() => (fold(column, end - 1), '←'),
                        '┤' => (self.above(row, column + 1), self.at((row, column + 1))),
                        '[' => (line[column..=end].iter().collect(), ' '),
                        symbol => (String::new(), symbol),
                    };
                    let to = (row, end + 1);
                    elements.push(Element {
                        name,
                        symbol,
                        from,
                        to,
                    });
                }
                column = end + 1;
            }
        }
        (elements, outputs)
    }

    /// The last of the digits that begin at a place.
    fn digits(&self, row: usize, column: usize) -> usize {
        let digits = (column..).take_while(|column| self.at((row, *column)).is_ascii_digit());
        digits.last().expect("the number of a continuation")
    }

    fn close(&self, row: usize, column: usize, with: char) -> usize {
        let mut depth = 0;
        for at in column..=self.right {
            let c = self.at((row, at));
            depth += i32::from(c == self.at((row, column))) - i32::from(c == with);
            if depth == 0 {
                return at;
            }
        }
        panic!("row {row} has a box that does not end");
    }

    fn circuit(mut self) -> Circuit {
        let (elements, outputs) = self.elements();
        for element in &elements {
            let row = &mut self.rows[element.from.0];
            row[element.from.1 + 1..element.to.1].fill(' ');
        }
        let mut nets = HashMap::new();
        for row in 0..self.rows.len() {
            // The neighbour of a rail's `├` is the rail, too; the next place may be an element.
            nets.insert((row, self.left), 0);
            if self.at((row, self.left)) == '├' {
                self.flood((row, self.left + 1), 0, &mut nets);
            }
        }
        let mut next = 1;
        for row in 0..self.rows.len() {
            for column in self.left + 1..self.right {
                if !nets.contains_key(&(row, column)) && !wires(self.at((row, column))).is_empty() {
                    self.flood((row, column), next, &mut nets);
                    next += 1;
                }
            }
        }
        Circuit {
            elements,
            outputs,
            nets,
        }
    }

    fn flood(&self, from: (usize, usize), net: usize, nets: &mut HashMap<(usize, usize), usize>) {
        let mut open = vec![from];
        while let Some((row, column)) = open.pop() {
            if wires(self.at((row, column))).is_empty() || nets.insert((row, column), net).is_some()
            {
                continue;
            }
            for way in wires(self.at((row, column))).chars() {
                let (to, back) = match way {
                    'L' => ((row, column - 1), 'R'),
                    'R' => ((row, column + 1), 'L'),
                    'U' => ((row.wrapping_sub(1), column), 'D'),
                    _ => ((row + 1, column), 'U'),
                };
                let inside = to.1 > self.left && to.1 < self.right;
                if inside && wires(self.at(to)).contains(back) && !nets.contains_key(&to) {
                    open.push(to);
                }
            }
        }
    }
}

impl Circuit {
    /// The wire between a mark at the end of a row and where the row continues.
    fn continued(&self, out: &Element) -> Element {
        let with = |symbol| {
            let same = move |of: &&Element| of.symbol == symbol && of.name == out.name;
            self.elements.iter().filter(same)
        };
        assert_eq!(with('→').count(), 1, "{} continues twice", out.name);
        assert_eq!(with('←').count(), 1, "{} continues in one place", out.name);
        let back = with('←').next().expect("one");
        assert_ne!(self.nets[&back.to], 0, "{} continues at the rail", out.name);
        Element {
            name: String::new(),
            symbol: '→',
            from: out.from,
            to: back.to,
        }
    }

    /// Outputs driven by the drawing, from the top down.
    fn drives(&self, trial: u64) -> Vec<bool> {
        let mut fed: BTreeMap<usize, Vec<&Element>> = BTreeMap::new();
        // A row that ends with a mark continues where the mark appears again, once.
        let left = |at: &&Element| at.symbol == '→';
        let joined: Vec<Element> = self
            .elements
            .iter()
            .filter(left)
            .map(|out| self.continued(out))
            .collect();
        for element in self
            .elements
            .iter()
            .filter(|of| !matches!(of.symbol, '→' | '←'))
            .chain(&joined)
        {
            fed.entry(self.nets[&element.to]).or_default().push(element);
        }
        let mut known = BTreeMap::from([(0, true)]);
        let outputs = self.outputs.iter();
        outputs
            .map(|at| power(self.nets[at], &self.nets, &fed, &mut known, trial))
            .collect()
    }
}

fn power(
    net: usize,
    nets: &HashMap<(usize, usize), usize>,
    fed: &BTreeMap<usize, Vec<&Element>>,
    known: &mut BTreeMap<usize, bool>,
    trial: u64,
) -> bool {
    if let Some(power) = known.get(&net) {
        return *power;
    }
    let mut on = false;
    for element in fed.get(&net).into_iter().flatten() {
        let before = power(nets[&element.from], nets, fed, known, trial);
        on |= match (element.name.as_str(), element.symbol) {
            ("", '→') => before,
            ("", symbol) => changed(symbol, before, trial),
            (name, '/') => before && !chance(trial, name),
            (name, ' ') => before && chance(trial, name),
            (name, edge) => before && chance(trial, &format!("{edge}{name}")),
        };
    }
    known.insert(net, on);
    on
}

/// Directions of a wire's character.
fn wires(c: char) -> &'static str {
    match c {
        '─' => "LR",
        '│' => "UD",
        '┬' => "LRD",
        '┴' => "LRU",
        '├' => "URD",
        '┤' => "ULD",
        '┼' => "LRUD",
        '└' => "UR",
        '┘' => "UL",
        '┌' => "RD",
        '┐' => "LD",
        _ => "",
    }
}

/// Compared drawings.
#[derive(Clone, Copy, Default, PartialEq, Eq, Debug)]
struct Drawn {
    networks: usize,
    /// Drawings with rows that continue below.
    folded: usize,
    /// Contacts in the left rail.
    bars: usize,
    /// The most characters of a line.
    widest: usize,
}

/// Compares all networks of a program that have a drawing, at all widths.
fn compare(program: &Program, name: &str) -> Drawn {
    let (resolved, _) = resolve(program, common::model(program));
    let ladder = build::ladder(&resolved);
    let mut drawn = Drawn::default();
    for network in &ladder.networks {
        let NetworkBody::Rung(node) = &network.body else {
            continue;
        };
        if node.items.is_empty() {
            continue;
        }
        for width in WIDTHS {
            compare_network(&resolved, network, width, name, &mut drawn);
        }
        drawn.networks += 1;
    }
    drawn
}

fn compare_network(
    resolved: &Resolved,
    network: &Network,
    width: usize,
    name: &str,
    drawn: &mut Drawn,
) {
    let style = Style {
        width,
        comments: false,
    };
    let text = draw_alike(&[(resolved, network)], style).concat();
    // Statements stand above the rails.
    let rows = text.lines().filter(|line| line.contains(['│', '├', '╪']));
    let (bars, rows): (Vec<_>, Vec<_>) = rows.partition(|line| line.contains('╪'));
    let instrs = network
        .instrs
        .clone()
        .filter(|at| matches!(resolved.instrs[*at].lower, Some(Lower::Basic(Basic::Mc))));
    let masters = instrs.map(|at| {
        let operands = resolved.program.instrs[at].operands.iter();
        operands
            .map(|operand| operand.kind.to_string())
            .collect::<Vec<_>>()
    });
    let words = |line: &&str| {
        let words = line
            .split(['═', '╪', '│', ' '])
            .filter(|word| !word.is_empty());
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    let messages: Vec<_> = bars.iter().map(words).collect();
    assert_eq!(messages, masters.collect::<Vec<_>>(), "{name}:\n{text}");
    let circuit = Picture::of(&rows.join("\n")).circuit();
    for trial in 0..TRIALS {
        let expected = by_list(resolved, network, trial);
        assert_eq!(
            circuit.drives(trial),
            expected,
            "{name}, trial {trial}:\n{text}"
        );
    }
    drawn.folded += usize::from(text.contains('→'));
    drawn.bars += bars.len();
    let widths = rows.iter().map(|row| row.chars().count());
    drawn.widest = widths.fold(drawn.widest, usize::max);
}

fn program(list: &str) -> Program {
    rungc_frontend::read_text("list.il", list).program
}

#[test]
fn the_oracle_sees_what_is_drawn_wrong() {
    let network = |list: &str| {
        let program = program(list);
        let (resolved, _) = resolve(&program, Model::get(ModelId::Fx3u));
        let ladder = build::ladder(&resolved);
        let trials = 0..TRIALS;
        trials
            .map(|trial| by_list(&resolved, &ladder.networks[0], trial))
            .collect::<Vec<_>>()
    };
    let picture = Picture::of("│ X000     X001               │\n├──┤ ├──────┤ ├────/────(Y000)┤\n");
    let picture = picture.circuit();
    let seen: Vec<_> = (0..TRIALS).map(|trial| picture.drives(trial)).collect();
    assert_eq!(seen, network("LD X0\nAND X1\nINV\nOUT Y0\n"));
    assert_ne!(seen, network("LD X0\nLD X1\nINV\nANB\nOUT Y0\n"));
    assert_ne!(seen, network("LD X0\nOR X1\nINV\nOUT Y0\n"));
}

#[test]
fn drawings_of_real_programs_say_what_their_lists_say() {
    let root = Path::new(env!("RUNGC_ROOT"));
    let (mut drawn, mut folded, mut bars) = (0, 0, 0);
    for folder in ["examples", "../shared/corpus", "../shared/projects"] {
        let folder = root.join(folder);
        if !folder.exists() {
            eprintln!("skipped: {} is not here", folder.display());
            continue;
        }
        let mut files = Vec::new();
        programs_in(&folder, &mut files);
        for path in files {
            let Ok(read) = rungc_frontend::read(&path) else {
                continue;
            };
            let all = compare(&read.program, &path.display().to_string());
            (drawn, folded, bars) = (drawn + all.networks, folded + all.folded, bars + all.bars);
        }
    }
    assert!(drawn > 100, "{drawn}");
    eprintln!("{drawn} networks, {folded} drawings with continued rows, {bars} contacts in rails");
}

#[test]
fn bars_continued_rows_and_very_wide_networks_say_what_their_lists_say() {
    let mc = "LD X0\nAND X1\nMC N0 M50\nLD X2\nOR X3\nOUT Y0\nLD X4\nMC N1 M51\nLD M5\nOUT Y1\nMCR N0\nEND\n";
    let seen = compare(&program(mc), "master control");
    assert_eq!(
        (seen.networks, seen.bars),
        (6, 2 * WIDTHS.len()),
        "{seen:?}"
    );
    // Contacts in series are continued below, also where a branch is open.
    let series = |count: usize| -> String { (0..count).map(|n| format!("AND M{n}\n")).collect() };
    let long = format!(
        "LD X0\nOR X1\n{}LD X2\nOR X3\nANB\nOUT Y0\nMPS\nAND X5\nOUT Y1\nMPP\nINV\nOUT Y2\nEND\n",
        series(120)
    );
    let seen = compare(&program(&long), "a long row");
    assert_eq!(seen.folded, WIDTHS.len(), "{seen:?}");
    // A branch cannot be continued: its network is as wide as it needs.
    let wide = format!(
        "LD X0\n{}LD X1\n{}OUT Y0\nEND\n",
        series(90),
        series(70) + "ORB\n"
    );
    let seen = compare(&program(&wide), "a wide branch");
    assert!(seen.widest > WIDTHS[0], "{seen:?}");
    // Branches below each other, each with its own outputs.
    let mut high = "LD X0\n".to_owned();
    for n in 0..100 {
        high += ["MPS\n", "MRD\n"][usize::from(n > 0)];
        high += &format!("AND M{n}\nOUT Y{:o}\n", n % 64);
    }
    let seen = compare(
        &program(&(high + "MPP\nANI X7\nOUT M200\nEND\n")),
        "many branches",
    );
    assert_eq!(seen.networks, 2);
}

/// A random block of contacts.
fn block(rng: &mut impl FnMut(usize) -> usize, depth: usize, out: &mut Vec<&'static str>) {
    const LD: [&str; 6] = [
        "LD X0",
        "LDI X1",
        "LDP X2",
        "LDF M3",
        "LD= D0 K5",
        "LDD> D2 K9",
    ];
    const AND: [&str; 6] = [
        "AND M4",
        "ANI M5",
        "ANDP X6",
        "ANDF X7",
        "AND<> D4 D5",
        "ANDD<= D6 D8",
    ];
    const OR: [&str; 6] = [
        "OR M7",
        "ORI X10",
        "ORP M8",
        "ORF X11",
        "OR< D1 K2",
        "ORD>= D10 K3",
    ];
    out.push(LD[rng(6)]);
    for _ in 0..rng(5) {
        match rng(if depth == 0 { 7 } else { 10 }) {
            0..=2 => out.push(AND[rng(6)]),
            3..=5 => out.push(OR[rng(6)]),
            6 => out.push(["INV", "MEP", "MEF", "INV"][rng(4)]),
            join => {
                block(rng, depth - 1, out);
                out.push(if join < 9 { "ANB" } else { "ORB" });
            }
        }
    }
}

/// Writes the outputs of a random block, with branches.
fn branches(rng: &mut impl FnMut(usize) -> usize, depth: usize, out: &mut Vec<&'static str>) {
    const OUT: [&str; 4] = ["OUT Y0", "SET Y1", "MOV K1 D9", "OUT T0 K5"];
    for _ in 0..rng(3) {
        out.push(OUT[rng(4)]);
    }
    if depth > 0 && rng(2) == 0 {
        let last = 1 + rng(3);
        for nth in 0..=last {
            out.push(match nth {
                0 => "MPS",
                _ if nth == last => "MPP",
                _ => "MRD",
            });
            if rng(3) == 0 {
                block(rng, 1, out);
                out.push("ANB");
            } else {
                out.push(["AND M9", "ANI M10", "INV", "AND= D0 D1"][rng(4)]);
            }
            branches(rng, depth - 1, out);
        }
    } else {
        out.push(OUT[rng(4)]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn drawings_of_random_lists_say_what_these_say(seed in any::<u64>()) {
        let mut state = seed;
        let mut rng = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        let mut lines = Vec::new();
        block(&mut rng, 2, &mut lines);
        branches(&mut rng, 2, &mut lines);
        lines.push("END");
        // A block that is inverted is a list; END is drawn in any case.
        let lists = lines.iter().any(|line| ["INV", "MEP", "MEF"].contains(line));
        let drawn = compare(&program(&lines.join("\n")), "random").networks;
        prop_assert!(drawn == 2 || lists && drawn == 1);
    }
}
