//! The standard's function blocks as instructions, and instructions that are drawn as blocks.

use super::drawing::{Drawing, Failure, Value, Word};
use super::logic::{Contact, Logic, Output, Part, Sense};
use super::modifiers::{Accepted, Edge, Modifiers, ONE_WAY};
use super::variables::{Kind, constant, milliseconds};
use super::{FREE, Fault, Reader, called, children, functions};
use roxmltree::Node;
use rungc_syntax::{Device, DeviceClass};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::collections::BTreeMap;

/// Prefix of block types that are instructions: `FX_ZRST`. Their operands are named `p1`, `p2`, ….
pub(super) const INSTRUCTION: &str = "FX_";

/// The inputs and outputs of a block.
pub(super) struct Pins<'a, 'i> {
    pub node: Node<'a, 'i>,
    /// The block's type, in upper case.
    pub name: SmolStr,
    /// By name in upper case, in order.
    pub inputs: Vec<(SmolStr, Node<'a, 'i>)>,
    outputs: Vec<SmolStr>,
}

impl<'a, 'i> Pins<'a, 'i> {
    fn of(node: Node<'a, 'i>) -> Self {
        let pins = |list: &'static str| {
            let lists = children(node, list);
            let pins = lists.flat_map(|list| children(list, "variable"));
            pins.filter_map(|pin| Some((upper(pin.attribute("formalParameter")?), pin)))
        };
        Pins {
            node,
            name: upper(node.attribute("typeName").unwrap_or_default()),
            inputs: pins("inputVariables").collect(),
            outputs: pins("outputVariables").map(|(name, _)| name).collect(),
        }
    }

    fn input(&self, name: &str) -> Option<Node<'a, 'i>> {
        let found = self.inputs.iter().find(|(input, _)| input == name)?;
        children(found.1, "connectionPointIn").next()
    }

    /// Value at an input, if it is connected.
    pub fn value(
        &self,
        drawing: &mut Drawing<'a, 'i, '_>,
        name: &str,
    ) -> Result<Option<Value>, Failure> {
        let Some(point) = self.input(name).filter(|point| point.has_children()) else {
            return Ok(None);
        };
        let is_used = point
            .children()
            .any(|child| matches!(child.tag_name().name(), "connection" | "expression"));
        if !is_used {
            return Ok(None);
        }
        let pin = point.parent_element().unwrap_or(point);
        // Counters catch the rise of what they count in any case.
        let modifiers = Modifiers::of(pin, ONE_WAY, Accepted::Read)?;
        let counts = matches!(name, "CU" | "CD") && modifiers.edge == Some(Edge::Rising);
        if modifiers.edge.is_some() && !counts {
            let what = format!(
                "the input `{name}` of {} catches an edge",
                called(self.node)
            );
            let help = "put R_TRIG or F_TRIG before it";
            return Err(Some(Fault::at(pin, what, help)));
        }
        let value = drawing.value_into(point, self.node)?;
        Ok(Some(value.modified(pin, modifiers)?))
    }

    /// The power at an input, if anything leads to it.
    pub fn flow(
        &self,
        drawing: &mut Drawing<'a, 'i, '_>,
        name: &str,
    ) -> Result<Option<Logic>, Failure> {
        match self.value(drawing, name)? {
            None => Ok(None),
            Some(Value::Flow(logic)) => Ok(Some(logic)),
            Some(Value::Word(word)) => {
                let what = format!("`{}` at `{name}` is not a bit", word.operand);
                Err(Some(Fault::at(self.node, what, "connect a bit")))
            }
        }
    }

    fn word(&self, drawing: &mut Drawing<'a, 'i, '_>, name: &str) -> Result<Word, Failure> {
        match self.value(drawing, name)? {
            Some(Value::Word(word)) => match functions::wide(self.node, &[&word])? {
                false => Ok(word),
                true => {
                    let what = format!("`{name}` of {} has 32 bits", called(self.node));
                    Err(Some(Fault::at(self.node, what, "use a value of 16 bits")))
                }
            },
            _ => {
                let what = format!("`{name}` of {} needs a number", called(self.node));
                Err(Some(Fault::at(
                    self.node,
                    what,
                    "connect a constant or a variable",
                )))
            }
        }
    }
}

fn upper(name: &str) -> SmolStr {
    name.to_uppercase().into()
}

/// The devices of a block's instance.
#[derive(Clone, Debug, Default)]
pub(super) struct Instance {
    /// The timer, counter, register or relay that it is.
    main: Option<Device>,
    /// Of its outputs.
    bits: BTreeMap<&'static str, Device>,
    /// Relays that catch the edges of its inputs.
    edges: BTreeMap<&'static str, Device>,
    /// Of a timer: its preset.
    preset: u64,
}

impl Instance {
    /// The bit that an output is.
    pub fn bit(&self, output: &str) -> Option<Device> {
        self.bits.get(output).copied()
    }
}

/// The blocks that keep something: their outputs that are bits, and the inputs whose edges they catch.
const BLOCKS: [(&str, &[&str], &[&str]); 10] = [
    ("TON", &["Q"], &[]),
    ("TOF", &["Q"], &[]),
    ("TP", &["Q"], &["IN", "START"]),
    ("CTU", &["Q"], &["CU"]),
    ("CTD", &["Q"], &["CD"]),
    ("CTUD", &["QU", "QD"], &["CU", "CD"]),
    ("R_TRIG", &["Q"], &[]),
    ("F_TRIG", &["Q"], &[]),
    ("SR", &["Q1"], &[]),
    ("RS", &["Q1"], &[]),
];

/// Finds the devices of all blocks of a drawing, so that their outputs can be read before them.
pub(super) fn prepare<'a, 'i>(drawing: &mut Drawing<'a, 'i, '_>, elements: &[Node<'a, 'i>]) {
    for &node in elements {
        let pins = Pins::of(node);
        let known = BLOCKS.iter().find(|(name, ..)| *name == pins.name);
        let Some((kind, outputs, edges)) = known else {
            continue;
        };
        if drawing.reader.gives_up() {
            return;
        }
        match instance(drawing, &pins, kind, outputs, edges) {
            Ok(instance) => {
                let name = upper(node.attribute("instanceName").unwrap_or_default());
                let instances = &mut drawing.reader.instances;
                instances.insert(name.to_string(), instance);
            }
            Err(fault) => {
                drawing.fail(node);
                drawing.reader.report(fault);
            }
        }
    }
}

/// Finds the devices of a block.
fn instance(
    drawing: &mut Drawing<'_, '_, '_>,
    pins: &Pins,
    kind: &str,
    outputs: &[&'static str],
    edges: &[&'static str],
) -> Result<Instance, Fault> {
    let node = pins.node;
    let name = node.attribute("instanceName").unwrap_or_default();
    if name.trim().is_empty() {
        return Err(Fault::outside(node, "give the block an instance"));
    }
    if drawing.reader.instances.contains_key(upper(name).as_str()) {
        let what = format!("{} `{name}` is drawn twice", called(node));
        return Err(Fault::at(node, what, "give each block its own instance"));
    }
    let mut found = Instance::default();
    let counts_alone = counts_alone(drawing, pins);
    let variables = &mut drawing.reader.variables;
    let mut relay = |part: &str| {
        let full = format!("{name}{part}");
        let device = variables.part(&full, DeviceClass::M, 1, |_| true);
        device.ok_or_else(|| lacking(node, name, &format!("a relay for `{full}`")))
    };
    match kind {
        "TON" | "TOF" | "TP" => {
            for part in outputs.iter().filter(|_| kind != "TON") {
                found.bits.insert(part, relay(&format!(".{part}"))?);
            }
        }
        "R_TRIG" | "F_TRIG" | "SR" | "RS" => {
            let device = relay("")?;
            found.main = Some(device);
            found
                .bits
                .extend(outputs.iter().map(|part| (*part, device)));
            return Ok(found);
        }
        _ if counts_alone => {
            let variables = &mut drawing.reader.variables;
            let counter = variables.part(name, DeviceClass::C, 1, |n| n < 200);
            let counter = counter.ok_or_else(|| lacking(node, name, "a counter of 16 bits"))?;
            found.main = Some(counter);
            found.bits.insert("Q", counter);
            return Ok(found);
        }
        _ => {
            for part in outputs {
                found.bits.insert(part, relay(&format!(".{part}"))?);
            }
        }
    }
    for part in edges {
        found.edges.insert(part, relay(&format!(".{part}"))?);
    }
    if kind.starts_with('C') {
        let variables = &mut drawing.reader.variables;
        let register = variables.part(name, DeviceClass::D, 1, |_| true);
        found.main = Some(register.ok_or_else(|| lacking(node, name, "a register for its count"))?);
        return Ok(found);
    }
    let preset = pins.input("PT").and_then(|point| drawing.written(point));
    let (timer, preset) = timer(drawing.reader, node, name, &preset.unwrap_or_default())?;
    found.main = Some(timer);
    found.preset = preset;
    if kind == "TON" {
        found.bits.insert("Q", timer);
    }
    Ok(found)
}

/// A timer as TON, by the name of its instance; how many units it counts.
pub(super) fn on_delay(
    reader: &mut Reader,
    node: Node,
    name: &str,
    preset: &str,
) -> Result<(Instance, u64), Fault> {
    let (timer, count) = timer(reader, node, name, preset)?;
    let instance = Instance {
        main: Some(timer),
        bits: BTreeMap::from([("Q", timer)]),
        preset: count,
        ..Instance::default()
    };
    Ok((instance, count))
}

/// Finds a timer that counts to the preset of a block; how many units it counts.
fn timer(
    reader: &mut Reader,
    node: Node,
    name: &str,
    preset: &str,
) -> Result<(Device, u64), Fault> {
    let variables = &mut reader.variables;
    let constant = match variables.kind(preset) {
        Some(Kind::Time) => variables.initial(preset).and_then(milliseconds),
        _ => milliseconds(preset),
    };
    let Some(preset_ms) = constant else {
        let what = format!(
            "`{}` at PT of {} is not a constant",
            preset.trim(),
            called(node)
        );
        return Err(Fault::at(
            node,
            what,
            "write a duration such as `T#1s500ms`",
        ));
    };
    let fits = |number| {
        iec_timer_unit(number).is_some_and(|unit| {
            preset_ms.is_multiple_of(unit) && (1..=32_767).contains(&(preset_ms / unit))
        })
    };
    let timer = variables.part(name, DeviceClass::T, 1, fits);
    let timer = timer.ok_or_else(|| {
        lacking(node, name, &format!(
            "a timer that counts to {preset_ms} ms: T0 to T62 and T138 to T199 count 100 ms, T200 to T245 10 ms, T256 \
             to T511 1 ms, up to 32767 of them"
        ))
    })?;
    Ok((timer, preset_ms / iec_timer_unit(timer.number).unwrap_or(1)))
}

/// A device that a block needs and that is neither named nor free.
fn lacking(node: Node, name: &str, what: &str) -> Fault {
    let what = format!("{} `{name}` needs {what}", called(node));
    Fault::at(node, what, FREE)
}

/// The unit of a timer in milliseconds, where all models that have it agree and it does not keep its value: it does
/// what TON of IEC 61131-3 does.
pub fn iec_timer_unit(number: u32) -> Option<u64> {
    match number {
        0..=62 | 138..=199 => Some(100),
        200..=245 => Some(10),
        256..=511 => Some(1),
        _ => None,
    }
}

/// Returns true if a counter of the PLC behaves like the block: it counts up to a constant, and nothing reads the
/// count.
fn counts_alone(drawing: &Drawing, pins: &Pins) -> bool {
    let preset = pins.input("PV").and_then(|point| drawing.written(point));
    let preset = preset.and_then(|written| constant(&written));
    let number = preset.and_then(|preset| preset.strip_prefix('K')?.parse::<i16>().ok());
    pins.name == "CTU"
        && number.is_some_and(|number| number > 0)
        && drawing.uses_of(pins.node, "CV").is_empty()
}

/// Reads a block: its instructions, and what its outputs are.
pub(super) fn read<'a, 'i>(
    drawing: &mut Drawing<'a, 'i, '_>,
    node: Node<'a, 'i>,
) -> Result<BTreeMap<SmolStr, Value>, Failure> {
    let pins = Pins::of(node);
    if let Some(mnemonic) = pins.name.strip_prefix(INSTRUCTION) {
        return instruction(drawing, &pins, mnemonic);
    }
    if let Some(function) = functions::read(drawing, &pins) {
        return function;
    }
    if !BLOCKS.iter().any(|(name, ..)| *name == pins.name) {
        let help = "`rungc book plcopen` lists the functions and blocks that rungc reads";
        return Err(Some(Fault::outside(node, help)));
    }
    let name = upper(node.attribute("instanceName").unwrap_or_default());
    let instance = drawing.reader.instances.get(name.as_str()).cloned();
    let instance = instance.ok_or(None)?;
    if let Some(enable) = pins.flow(drawing, "EN")?
        && !enable.is_wire()
    {
        let what = format!("{} stands still while EN is off", called(node));
        let help = "connect EN to the left power rail";
        return Err(Some(Fault::at(node, what, help)));
    }
    let mut block = Block {
        drawing,
        pins: &pins,
        instance,
    };
    let mut outputs = BTreeMap::from([("ENO".into(), Value::Flow(Logic::wire()))]);
    match pins.name.as_str() {
        "TON" => block.on_delay()?,
        "TOF" => block.off_delay()?,
        "TP" => block.pulse()?,
        "R_TRIG" | "F_TRIG" => block.edge()?,
        "SR" | "RS" => block.bistable()?,
        _ => block.counter(&mut outputs)?,
    }
    for (part, device) in block.instance.bits.iter() {
        let logic = Logic::contact(node.id().get(), true, device.to_smolstr());
        outputs.insert((*part).into(), Value::Flow(logic));
    }
    Ok(outputs)
}

/// The outputs of a block as its pins pass them on.
pub(super) fn passed_on(
    node: Node,
    mut outputs: BTreeMap<SmolStr, Value>,
) -> Result<BTreeMap<SmolStr, Value>, Failure> {
    let lists = children(node, "outputVariables");
    for pin in lists.flat_map(|list| children(list, "variable")) {
        let modifiers = Modifiers::of(pin, ONE_WAY, Accepted::Negated)?;
        let name = upper(pin.attribute("formalParameter").unwrap_or_default());
        match outputs.remove(&name) {
            Some(value) => _ = outputs.insert(name, value.modified(pin, modifiers)?),
            // The operand of an instruction.
            None => _ = Modifiers::of(pin, ONE_WAY, Accepted::None)?,
        }
    }
    Ok(outputs)
}

/// A block while it is read.
struct Block<'d, 'a, 'i, 'r> {
    drawing: &'d mut Drawing<'a, 'i, 'r>,
    pins: &'d Pins<'a, 'i>,
    instance: Instance,
}

impl Block<'_, '_, '_, '_> {
    /// The power at an input; none where nothing leads to it.
    fn flow(&mut self, name: &str) -> Result<Logic, Failure> {
        let flow = self.pins.flow(self.drawing, name)?;
        Ok(flow.unwrap_or_else(|| self.contact(false, "M8000")))
    }

    fn contact(&self, on: bool, device: impl Into<SmolStr>) -> Logic {
        Logic::contact(self.pins.node.id().get(), on, device)
    }

    fn compare(&self, sign: &str, a: &str, b: &str) -> Logic {
        Logic::Contact(Contact {
            element: self.pins.node.id().get(),
            sense: Sense::Compare(sign.into()),
            operands: format_smolstr!("{a} {b}"),
        })
    }

    fn main(&self) -> SmolStr {
        self.instance
            .main
            .map(|device| device.to_smolstr())
            .unwrap_or_default()
    }

    fn bit(&self, name: &str) -> SmolStr {
        self.instance
            .bit(name)
            .map(|device| device.to_smolstr())
            .unwrap_or_default()
    }

    fn network(&mut self, logic: Logic, lines: &[SmolStr]) {
        self.drawing.network(logic, lines.to_vec());
    }

    fn edge_of(&self, input: &str) -> SmolStr {
        let device = self.instance.edges.get(input);
        device.map(|device| device.to_smolstr()).unwrap_or_default()
    }

    fn count_time(&self) -> SmolStr {
        format_smolstr!("OUT {} K{}", self.main(), self.instance.preset)
    }

    fn on_delay(&mut self) -> Result<(), Failure> {
        let input = self.flow("IN")?;
        let line = self.count_time();
        self.drawing.reader.output(input, line);
        Ok(())
    }

    /// The timer runs while the output outlives the input.
    fn off_delay(&mut self) -> Result<(), Failure> {
        let input = self.flow("IN")?;
        let (timer, output) = (self.main(), self.bit("Q"));
        let outlives = input
            .clone()
            .changed("INV")
            .then(self.contact(true, output.clone()));
        self.network(outlives, &[self.count_time()]);
        let holds = self
            .contact(true, output.clone())
            .then(self.contact(false, timer));
        let on = Logic::joined(vec![input, holds]);
        self.network(on, &[format_smolstr!("OUT {output}")]);
        Ok(())
    }

    /// The input's edge starts the pulse unless there is one; the timer, which the start resets, ends it. ZRST resets
    /// it at once, where RST would hold it for a scan.
    fn pulse(&mut self) -> Result<(), Failure> {
        let input = self.flow("IN")?;
        let (timer, output) = (self.main(), self.bit("Q"));
        let (edge, start) = (self.edge_of("IN"), self.edge_of("START"));
        self.network(input, &[format_smolstr!("PLS {edge}")]);
        let idle = self.contact(false, output.clone());
        let starts = self.contact(true, edge).then(idle);
        self.network(starts, &[format_smolstr!("OUT {start}")]);
        let ways = vec![
            self.contact(true, output.clone()),
            self.contact(true, start.clone()),
        ];
        self.network(Logic::joined(ways), &[self.count_time()]);
        let end = [format_smolstr!("RST {output}")];
        self.network(self.contact(true, timer.clone()), &end);
        let begin = [
            format_smolstr!("SET {output}"),
            format_smolstr!("ZRST {timer} {timer}"),
        ];
        self.network(self.contact(true, start), &begin);
        Ok(())
    }

    fn edge(&mut self) -> Result<(), Failure> {
        let input = self.flow("CLK")?;
        // The standard's F_TRIG catches the rise of what is not: in the first scan, too.
        let input = match self.pins.name.as_str() {
            "F_TRIG" => input.changed("INV"),
            _ => input,
        };
        let line = format_smolstr!("PLS {}", self.main());
        self.drawing.reader.output(input, line);
        Ok(())
    }

    /// The input that prevails is executed last.
    fn bistable(&mut self) -> Result<(), Failure> {
        let [set, reset] = match self.pins.name.as_str() {
            "SR" => [("S1", "SET"), ("R", "RST")],
            _ => [("S", "SET"), ("R1", "RST")],
        };
        let (first, last) = match self.pins.name.as_str() {
            "SR" => (reset, set),
            _ => (set, reset),
        };
        let output = self.main();
        let (first_flow, last_flow) = (self.flow(first.0)?, self.flow(last.0)?);
        if last_flow.names(&output) {
            let what = format!("{} depends on its own output", called(self.pins.node));
            let help = "lead it over a variable";
            return Err(Some(Fault::at(self.pins.node, what, help)));
        }
        self.network(first_flow, &[format_smolstr!("{} {output}", first.1)]);
        self.network(last_flow, &[format_smolstr!("{} {output}", last.1)]);
        Ok(())
    }

    /// A counter of the PLC, or one in a register: it counts, then it is loaded, then it is reset.
    fn counter(&mut self, outputs: &mut BTreeMap<SmolStr, Value>) -> Result<(), Failure> {
        let main = self.main();
        if self
            .instance
            .main
            .is_some_and(|device| device.class == DeviceClass::C)
        {
            let (up, reset) = (self.flow("CU")?, self.flow("R")?);
            let preset = self.pins.word(self.drawing, "PV")?;
            let line = format_smolstr!("OUT {main} {}", preset.operand);
            self.network(up, &[line]);
            self.network(reset, &[format_smolstr!("RST {main}")]);
            return Ok(());
        }
        let preset = self.pins.word(self.drawing, "PV")?.operand;
        let has = |name: &str| self.pins.inputs.iter().any(|(input, _)| input == name);
        let [up, down, load, reset] = ["CU", "CD", "LD", "R"].map(has);
        let mut flows = BTreeMap::new();
        for name in ["CU", "CD", "LD", "R"] {
            flows.insert(name, self.flow(name)?);
        }
        for (name, flow) in [("CU", up), ("CD", down)] {
            let Some(logic) = flows.get(name).filter(|_| flow).cloned() else {
                continue;
            };
            self.network(logic, &[format_smolstr!("PLS {}", self.edge_of(name))]);
        }
        let both = up && down;
        for (name, other, is, sign, limit, mnemonic) in [
            ("CU", "CD", up, "<", "K32767", "INC"),
            ("CD", "CU", down, ">", "K-32768", "DEC"),
        ] {
            if is {
                let mut logic = self.contact(true, self.edge_of(name));
                if both {
                    logic = logic.then(self.contact(false, self.edge_of(other)));
                }
                let logic = logic.then(self.compare(sign, &main, limit));
                self.network(logic, &[format_smolstr!("{mnemonic} {main}")]);
            }
        }
        for (name, is, value) in [("LD", load, preset.as_str()), ("R", reset, "K0")] {
            let Some(logic) = flows.remove(name).filter(|_| is) else {
                continue;
            };
            self.network(logic, &[format_smolstr!("MOV {value} {main}")]);
        }
        for (name, device) in self.instance.bits.clone() {
            let logic = match name {
                "Q" if self.pins.name == "CTU" => self.compare(">=", &main, &preset),
                "QU" => self.compare(">=", &main, &preset),
                _ => self.compare("<=", &main, "K0"),
            };
            self.network(logic, &[format_smolstr!("OUT {device}")]);
        }
        let count = Word {
            operand: main,
            kind: Some(Kind::Int),
        };
        outputs.insert("CV".into(), Value::Word(count));
        Ok(())
    }
}

/// The contact that a block is which stands for a contact or a comparison: `FX_LDI`, `FX_D>=`.
pub(super) fn contact(mnemonic: &str) -> Option<Sense> {
    match mnemonic {
        "LD" => Some(Sense::On),
        "LDI" => Some(Sense::Off),
        "LDP" => Some(Sense::Rising),
        "LDF" => Some(Sense::Falling),
        _ => {
            let sign = mnemonic.strip_prefix('D').unwrap_or(mnemonic);
            let compares = matches!(sign, "=" | "<>" | ">" | ">=" | "<" | "<=");
            compares.then(|| Sense::Compare(mnemonic.into()))
        }
    }
}

/// Reads an instruction that is drawn as a block: `FX_ZRST` with EN, `p1` and `p2`.
fn instruction<'a, 'i>(
    drawing: &mut Drawing<'a, 'i, '_>,
    pins: &Pins<'a, 'i>,
    mnemonic: &str,
) -> Result<BTreeMap<SmolStr, Value>, Failure> {
    let node = pins.node;
    let enable = pins.flow(drawing, "EN")?.unwrap_or_else(Logic::wire);
    let power = |logic| BTreeMap::from([("ENO".into(), Value::Flow(logic))]);
    if let "INV" | "MEP" | "MEF" = mnemonic {
        return Ok(power(enable.changed(mnemonic)));
    }
    let mut operands = BTreeMap::new();
    let number = |name: &str| name.strip_prefix('P')?.parse::<u32>().ok();
    for (name, pin) in &pins.inputs {
        let point = children(*pin, "connectionPointIn").next();
        if number(name).is_some() {
            Modifiers::of(*pin, ONE_WAY, Accepted::None)?;
        }
        let written = point.and_then(|point| drawing.written(point));
        if let (Some(number), Some(written)) = (number(name), written) {
            operands.insert(number, written);
        }
    }
    for name in &pins.outputs {
        let uses = drawing.uses_of(node, name);
        for output in uses.iter().filter(|_| number(name).is_some()) {
            Modifiers::of(*output, ONE_WAY, Accepted::None)?;
        }
        let expression = uses.iter().find_map(|n| children(*n, "expression").next());
        if let (Some(number), Some(written)) = (number(name), expression) {
            operands.insert(number, super::text(written));
        }
    }
    for written in operands.values_mut() {
        let is_device = super::variables::device(written).is_some();
        if !is_device && drawing.reader.variables.kind(written).is_some() {
            *written = drawing.reader.find(node, written)?.device.to_string();
        }
    }
    let in_order = operands.keys().copied().eq(1..=operands.len() as u32);
    // A text may hold a tab.
    let breaks = |c: char| c.is_control() && c != '\t';
    let plain = |word: &String| !word.trim().is_empty() && !word.trim().contains(breaks);
    if !in_order || !operands.values().all(plain) {
        let what = format!("an operand of {} is missing", called(node));
        return Err(Some(Fault::at(node, what, "connect p1, p2 and so on")));
    }
    let words = operands.values().map(|word| word.trim());
    if let Some(sense) = contact(mnemonic) {
        let contact = Contact {
            element: node.id().get(),
            sense,
            operands: words.collect::<Vec<_>>().join(" ").into(),
        };
        let logic = Value::Flow(Logic::Contact(contact));
        return Ok(BTreeMap::from([("OUT".into(), logic)]));
    }
    let words: Vec<_> = words.collect();
    drive(drawing.reader, enable.clone(), mnemonic, &words);
    Ok(power(enable))
}

/// Adds an instruction that only rungc knows, driven by what enables it.
pub(super) fn drive(reader: &mut Reader, enable: Logic, mnemonic: &str, operands: &[&str]) {
    let line = [&[mnemonic], operands].concat().join(" ");
    match mnemonic {
        "STL" => reader.in_state = true,
        "RET" => reader.in_state = false,
        _ => {}
    }
    reader.parts.push(Part::Output(Output {
        bare: true,
        logic: enable,
        lines: vec![line.into()],
        alone: false,
    }));
}
