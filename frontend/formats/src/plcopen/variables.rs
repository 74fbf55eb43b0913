//! The devices of variables: by a table, by their addresses, by their names, or taken from those that are free.

use super::{children, text};
use crate::il;
use crate::table::{TableRow, read_table};
use roxmltree::Node;
use rungc_syntax::{Device, DeviceClass, DeviceRun, Diagnostics, OperandKind};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::mem;

/// The devices of variables of PLCopen XML.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// By the names of variables in upper case. They take precedence over addresses.
    pub devices: BTreeMap<String, Device>,
    /// Devices for variables that have neither a row here nor an address: class, first and last number.
    pub free: Vec<(DeviceClass, u32, u32)>,
}

impl Names {
    /// Reads a table as [`Names::parse`] does, in any encoding and with any separator of [`read_table`].
    ///
    /// # Errors
    /// Why it is not a table, or the first row that is not of this form.
    pub fn read(bytes: &[u8]) -> Result<Names, String> {
        let mut names = Names::default();
        for TableRow { cells, .. } in read_table(bytes, None).map_err(|error| error.to_string())? {
            let read = match &*cells {
                [name, device, ..] => names.row(name, device),
                _ => None,
            };
            read.ok_or_else(|| {
                let row = cells.join(",");
                format!("`{row}` is not a row of a name and a device, such as `Start,X000`")
            })?;
        }
        Ok(names)
    }

    /// Reads a table: rows of a name and a device, separated by a comma or a tab. The name `*` gives free devices:
    /// `*,M100-M199`.
    ///
    /// # Errors
    /// The first row that is not of this form.
    pub fn parse(table: &str) -> Result<Names, String> {
        let mut names = Names::default();
        let lines = table.trim_start_matches('\u{FEFF}').lines();
        for row in lines.filter(|row| !row.trim().is_empty()) {
            let fields = row.split_once([',', '\t']);
            let read = fields.and_then(|(name, device)| names.row(name, device));
            read.ok_or_else(|| row.to_owned())?;
        }
        Ok(names)
    }

    fn row(&mut self, name: &str, written: &str) -> Option<()> {
        let plain = |field: &str| field.trim().trim_matches('"').trim().to_uppercase();
        let (name, written) = (plain(name), plain(written));
        if name == "*" {
            let (first, last) = written.split_once('-').unwrap_or((&written, &written));
            let (first, last) = (device(first.trim())?, device(last.trim())?);
            let fits = first.class == last.class && first.number <= last.number;
            self.free
                .push(fits.then_some((first.class, first.number, last.number))?);
        } else {
            self.devices.insert(name, device(&written)?);
        }
        Some(())
    }
}

/// Type of a variable.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// A bit.
    Bool,
    /// Signed, 16 bits.
    Int,
    /// Signed, 32 bits.
    Dint,
    /// 16 bits without a sign.
    Word,
    /// 32 bits without a sign.
    Dword,
    /// A duration.
    Time,
    /// An instance of a block, by the name of its type.
    Block(String),
    /// Something that a PLC of the family does not hold.
    Other(String),
}

impl Kind {
    /// The kind of a declared type.
    fn of(declared: Node) -> Option<Kind> {
        let element = children(declared, "type").next()?.first_element_child()?;
        Some(match element.tag_name().name() {
            "BOOL" => Kind::Bool,
            "INT" => Kind::Int,
            "DINT" => Kind::Dint,
            "UINT" | "WORD" => Kind::Word,
            "UDINT" | "DWORD" => Kind::Dword,
            "TIME" => Kind::Time,
            "derived" => Kind::Block(element.attribute("name").unwrap_or("?").to_uppercase()),
            other => Kind::Other(other.to_owned()),
        })
    }

    /// Returns true if it occupies two registers.
    pub fn is_wide(&self) -> bool {
        matches!(self, Kind::Dint | Kind::Dword)
    }
}

/// A declared variable.
#[derive(Clone, Debug)]
struct Variable {
    kind: Kind,
    device: Option<Device>,
    /// Its address, if that is not of a device.
    foreign: Option<String>,
    comment: Option<SmolStr>,
    initial: Option<String>,
    /// True if it keeps its value over power-off.
    is_retained: bool,
    /// Its name in the table of devices.
    key: String,
}

/// The variables of a project.
#[derive(Debug, Default)]
pub(super) struct Variables {
    names: Names,
    /// Of all programs, by name.
    global: HashMap<String, Variable>,
    /// Of the program that is being read.
    local: HashMap<String, Variable>,
    program: String,
    /// Devices that are not free.
    taken: BTreeSet<Device>,
    /// Devices of variables without an address, by key.
    given: HashMap<String, Device>,
    /// Devices of variables that have been used.
    used: BTreeSet<Device>,
    /// Number of pointers used by labels.
    pointers: u32,
    /// Names of the devices in use.
    pub comments: BTreeMap<Device, String>,
    /// Instructions of the first scan.
    pub first_scan: Vec<SmolStr>,
    /// Devices of variables that keep their values over power-off.
    pub retained: Vec<DeviceRun>,
    /// Variables whose devices are stated, in the order of their declarations.
    stated: Vec<Variable>,
}

/// A device that a variable is, and what it holds.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub device: Device,
    pub kind: Kind,
}

/// Reason why a variable has no device.
#[derive(Debug)]
pub(super) enum Missing {
    /// No device is named, and none is free.
    Device,
    /// Its address is not that of a device.
    Address(String),
    /// Its type is none that a PLC of the family holds.
    Type(String),
}

impl Variables {
    /// Takes the table and the declarations of a project; also returns declarations whose name another one has.
    pub fn new<'a, 'i>(names: &Names, root: Node<'a, 'i>) -> (Self, Vec<Node<'a, 'i>>) {
        let mut variables = Variables {
            names: names.clone(),
            taken: names.devices.values().copied().collect(),
            ..Variables::default()
        };
        for node in root.descendants().filter(Node::is_element) {
            let written = match node.tag_name().name() {
                "variable" if node.has_attribute("name") => {
                    let name = node.attribute("name").and_then(device);
                    variables.taken.extend(name);
                    node.attribute("address").map(str::to_owned)
                }
                "variable" | "expression" => node.text().map(str::to_owned),
                "label" => node.attribute("label").map(str::to_owned),
                _ => None,
            };
            let Some(written) = written else { continue };
            let named = addressed(&written).or_else(|| device(written.trim()));
            variables.taken.extend(named);
        }
        let outside = root
            .descendants()
            .filter(|node| node.tag_name().name() == "globalVars");
        let twice = outside.flat_map(|list| variables.declare(list, true));
        let twice = twice.collect();
        (variables, twice)
    }

    /// Takes the declarations of a program, whose body is read next; returns those whose name another one has.
    pub fn enter<'a, 'i>(&mut self, pou: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
        let mut twice = Vec::new();
        self.local.clear();
        self.program = pou.attribute("name").unwrap_or_default().to_uppercase();
        for interface in children(pou, "interface") {
            for list in interface.children().filter(Node::is_element) {
                if list.tag_name().name() != "externalVars" {
                    twice.extend(self.declare(list, false));
                }
            }
        }
        twice
    }

    /// Takes a list of declarations; returns those whose name another one has.
    fn declare<'a, 'i>(&mut self, list: Node<'a, 'i>, global: bool) -> Vec<Node<'a, 'i>> {
        let mut twice = Vec::new();
        let is_set = |key: &str| matches!(list.attribute(key).map(str::trim), Some("true" | "1"));
        for node in children(list, "variable") {
            let Some(name) = node
                .attribute("name")
                .filter(|name| !name.trim().is_empty())
            else {
                continue;
            };
            let name = name.to_uppercase();
            let full = format!("{}.{name}", self.program);
            let devices = &self.names.devices;
            let named = devices.get(&full).or_else(|| devices.get(&name)).copied();
            let address = node.attribute("address").filter(|a| !a.trim().is_empty());
            let found = named.or_else(|| match address {
                Some(address) => addressed(address),
                None => device(&name),
            });
            let documentation = children(node, "documentation").next().map(text);
            let documentation = documentation.and_then(|text| crate::text::clean(&text));
            let written = node.attribute("name").unwrap_or_default();
            let initial = children(node, "initialValue").flat_map(|v| children(v, "simpleValue"));
            let variable = Variable {
                kind: Kind::of(node).unwrap_or(Kind::Bool),
                device: found,
                foreign: address.filter(|_| found.is_none()).map(str::to_owned),
                // That X0 is X000 needs no comment.
                comment: documentation.or_else(|| {
                    Some(written.to_smolstr())
                        .filter(|_| device(written).is_none_or(|own| Some(own) != found))
                }),
                initial: initial
                    .filter_map(|value| value.attribute("value"))
                    .map(|value| value.trim().to_uppercase())
                    .next(),
                is_retained: is_set("retain") || is_set("persistent"),
                key: if global { name.clone() } else { full },
            };
            let scope = if global {
                &mut self.global
            } else {
                &mut self.local
            };
            if variable.device.is_some() && variable.foreign.is_none() {
                self.stated.push(variable.clone());
            }
            if scope.insert(name, variable).is_some() {
                twice.push(node);
            }
        }
        twice
    }

    fn declared(&self, name: &str) -> Option<&Variable> {
        self.local.get(name).or_else(|| self.global.get(name))
    }

    /// The kind of a variable, if it is declared.
    pub fn kind(&self, name: &str) -> Option<&Kind> {
        Some(&self.declared(&name.trim().to_uppercase())?.kind)
    }

    /// Returns true if a name means a number.
    pub fn is_number(&self, name: &str) -> bool {
        let name = name.trim().to_uppercase();
        match self.declared(&name) {
            Some(variable) => variable.kind != Kind::Bool,
            None => {
                let named = self.names.devices.get(&name).copied();
                let found = named.or_else(|| addressed(&name)).or_else(|| device(&name));
                found.is_some_and(|found| {
                    use DeviceClass::{D, R, V, Z};
                    matches!(found.class, D | R | V | Z)
                })
            }
        }
    }

    /// Initial value of a variable, as written in upper case.
    pub fn initial(&self, name: &str) -> Option<&str> {
        let variable = self.declared(&name.trim().to_uppercase())?;
        variable.initial.as_deref()
    }

    /// The device of a variable, an address, or the name of a device.
    pub fn find(&mut self, written: &str) -> Result<Found, Missing> {
        let name = written.trim().to_uppercase();
        if let Some(variable) = self.declared(&name).cloned() {
            return self.of_variable(&variable);
        }
        if let Some(found) = self.names.devices.get(&name) {
            return Ok(undeclared(*found));
        }
        let written = addressed(&name).or_else(|| device(&name));
        written.map(undeclared).ok_or(Missing::Device)
    }

    fn of_variable(&mut self, variable: &Variable) -> Result<Found, Missing> {
        if let Some(address) = &variable.foreign {
            return Err(Missing::Address(address.clone()));
        }
        let class = match &variable.kind {
            Kind::Bool => DeviceClass::M,
            Kind::Int | Kind::Dint | Kind::Word | Kind::Dword => DeviceClass::D,
            Kind::Time => return Err(Missing::Type("TIME".to_owned())),
            Kind::Block(name) | Kind::Other(name) => return Err(Missing::Type(name.clone())),
        };
        let device = match variable.device {
            Some(device) => device,
            None => {
                let count = if variable.kind.is_wide() { 2 } else { 1 };
                self.give(&variable.key, class, count, |_| true)
                    .ok_or(Missing::Device)?
            }
        };
        if self.used.insert(device) {
            let comment = variable.comment.as_ref().map(ToString::to_string);
            self.comments
                .extend(comment.map(|comment| (device, comment)));
            self.begin(device, variable);
            self.retain(device, variable);
        }
        Ok(Found {
            device,
            kind: variable.kind.clone(),
        })
    }

    /// Notes the devices of a variable that keeps its value over power-off.
    fn retain(&mut self, device: Device, variable: &Variable) {
        // Inputs are read anew.
        if variable.is_retained && device.class != DeviceClass::X {
            self.retained.push(DeviceRun {
                class: device.class,
                first: device.number,
                count: if variable.kind.is_wide() { 2 } else { 1 },
            });
        }
    }

    /// Takes comments, initial values and retention of the variables that nothing in the programs uses, but that have
    /// devices: other equipment may use those.
    pub fn finish(&mut self) {
        for variable in mem::take(&mut self.stated) {
            let Some(device) = variable.device.filter(|device| self.used.insert(*device)) else {
                continue;
            };
            if let Some(comment) = &variable.comment {
                let comment = comment.to_string();
                self.comments.entry(device).or_insert(comment);
            }
            if !matches!(variable.kind, Kind::Time | Kind::Block(_) | Kind::Other(_)) {
                self.begin(device, &variable);
                self.retain(device, &variable);
            }
        }
    }

    /// Lets the first scan give a variable its initial value; devices begin with 0.
    fn begin(&mut self, device: Device, variable: &Variable) {
        let Some(initial) = variable.initial.as_deref() else {
            return;
        };
        let value = match (&variable.kind, initial) {
            (Kind::Bool, "TRUE" | "1") => Some(format_smolstr!("SET {device}")),
            (Kind::Bool, _) => None,
            (kind, written) => constant(written)
                .filter(|value| !matches!(value.as_str(), "K0" | "H0"))
                .map(|value| {
                    let mnemonic = if kind.is_wide() { "DMOV" } else { "MOV" };
                    format_smolstr!("{mnemonic} {value} {device}")
                }),
        };
        self.first_scan.extend(value);
    }

    /// Returns true if the table names the device of a block's instance or of a part of it.
    pub fn is_named(&self, name: &str) -> bool {
        let name = name.trim().to_uppercase();
        let full = format!("{}.{name}", self.program);
        let devices = &self.names.devices;
        devices.contains_key(&full) || devices.contains_key(&name)
    }

    /// The device of a block's instance or of a part of it, such as `DELAY` or `DELAY.Q`: that of the table, else a
    /// free one of the class that fits.
    pub fn part(
        &mut self,
        name: &str,
        class: DeviceClass,
        count: u32,
        fits: impl Fn(u32) -> bool,
    ) -> Option<Device> {
        let written = name.trim();
        let name = written.to_uppercase();
        let full = format!("{}.{name}", self.program);
        let devices = &self.names.devices;
        let named = devices.get(&full).or_else(|| devices.get(&name)).copied();
        if let Some(device) = named.or_else(|| device(&name)) {
            return (device.class == class && fits(device.number)).then_some(device);
        }
        let device = self.give(&full, class, count, fits)?;
        let comment = written.split("..").next().unwrap_or(written);
        self.comments
            .entry(device)
            .or_insert_with(|| comment.to_owned());
        Some(device)
    }

    /// A pointer that no label names.
    pub fn pointer(&mut self) -> u32 {
        let taken = |number| {
            // P63 is the end of the program.
            let class = DeviceClass::P;
            number == 63 || self.taken.contains(&Device { class, number })
        };
        let number = (self.pointers..).find(|number| !taken(*number));
        let number = number.unwrap_or(u32::MAX);
        self.pointers = number.saturating_add(1);
        number
    }

    /// Free devices that follow each other: the same ones for the same key.
    fn give(
        &mut self,
        key: &str,
        class: DeviceClass,
        count: u32,
        fits: impl Fn(u32) -> bool,
    ) -> Option<Device> {
        if let Some(given) = self.given.get(key) {
            return Some(*given);
        }
        let taken = |number| self.taken.contains(&Device { class, number });
        let runs = self.names.free.iter().filter(|run| run.0 == class);
        let number = runs
            .flat_map(|&(_, first, last)| (first..=last).map(move |number| (number, last)))
            .find(|&(number, last)| {
                let all = number..number.saturating_add(count);
                all.end <= last.saturating_add(1) && all.clone().all(|n| fits(n) && !taken(n))
            })?
            .0;
        let devices = (number..number + count).map(|number| Device { class, number });
        self.taken.extend(devices);
        let device = Device { class, number };
        self.given.insert(key.to_owned(), device);
        Some(device)
    }
}

fn undeclared(device: Device) -> Found {
    use DeviceClass::{M, S, X, Y};
    let kind = match device.class {
        X | Y | M | S => Kind::Bool,
        _ => Kind::Int,
    };
    Found { device, kind }
}

/// The device that a name is, such as `X010`.
pub(super) fn device(name: &str) -> Option<Device> {
    let mut faults = Diagnostics::new();
    match il::field::operand(name, 0, false, &mut faults)?.kind {
        OperandKind::Device(device, None) if faults.is_empty() => Some(device),
        _ => None,
    }
}

/// The device at an IEC address: bits by byte and bit, words by their numbers.
pub(super) fn addressed(address: &str) -> Option<Device> {
    use DeviceClass::{D, M, X, Y};
    let address = address.trim().strip_prefix('%')?.to_ascii_uppercase();
    let (place, rest) = address.split_at_checked(2)?;
    let class = match place {
        "IX" => X,
        "QX" => Y,
        "MX" => M,
        "MW" => D,
        _ => return None,
    };
    let number = match rest.split_once('.') {
        Some((byte, bit)) if class != D => {
            let bit = bit.parse::<u32>().ok().filter(|bit| *bit < 8)?;
            byte.parse::<u32>().ok()?.checked_mul(8)?.checked_add(bit)?
        }
        Some(_) => return None,
        None => rest.parse().ok()?,
    };
    Some(Device { class, number })
}

/// A constant as a list writes it: `5`, `INT#-5`, `16#1F`, `2#101`.
pub(super) fn constant(written: &str) -> Option<SmolStr> {
    let written = written.trim().to_ascii_uppercase().replace('_', "");
    let types = ["INT#", "DINT#", "UINT#", "UDINT#", "WORD#", "DWORD#"];
    let number = types
        .into_iter()
        .find_map(|prefix| written.strip_prefix(prefix))
        .unwrap_or(&written);
    let based = |digits: &str, base| u32::from_str_radix(digits, base).ok();
    if let Some(digits) = number.strip_prefix("16#") {
        return based(digits, 16).map(|value| format_smolstr!("H{value:X}"));
    }
    for (prefix, base) in [("8#", 8), ("2#", 2)] {
        if let Some(digits) = number.strip_prefix(prefix) {
            return based(digits, base).map(|value| format_smolstr!("K{value}"));
        }
    }
    let value = number.parse::<i64>().ok()?;
    (i64::from(i32::MIN)..=i64::from(u32::MAX))
        .contains(&value)
        .then(|| format_smolstr!("K{value}"))
}

/// A duration in milliseconds: `T#1s500ms`, `TIME#2.5s`.
pub(super) fn milliseconds(written: &str) -> Option<u64> {
    let written = written.trim().to_ascii_lowercase().replace('_', "");
    let mut rest = written
        .strip_prefix("t#")
        .or_else(|| written.strip_prefix("time#"))?;
    if rest.is_empty() {
        return None;
    }
    let mut all = 0.0;
    while !rest.is_empty() {
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.')?;
        let (number, after) = rest.split_at(digits);
        let letters = after
            .find(|c: char| !c.is_ascii_alphabetic())
            .unwrap_or(after.len());
        let (unit, after) = after.split_at(letters);
        let unit = match unit {
            "d" => 86_400_000.0,
            "h" => 3_600_000.0,
            "m" => 60_000.0,
            "s" => 1000.0,
            "ms" => 1.0,
            _ => return None,
        };
        all += number.parse::<f64>().ok()? * unit;
        rest = after;
    }
    let whole = all.round();
    ((all - whole).abs() < 1e-6 && whole < 1e12).then_some(whole as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_and_durations() {
        let constants = [
            "5",
            "INT#-5",
            "16#1f",
            "2#1_01",
            "WORD#16#FF",
            "1.5",
            "5000000000",
        ];
        let expected = [
            Some("K5"),
            Some("K-5"),
            Some("H1F"),
            Some("K5"),
            Some("HFF"),
            None,
            None,
        ];
        assert_eq!(
            constants.map(constant),
            expected.map(|text| text.map(SmolStr::from))
        );
        let durations = [
            "T#1s500ms",
            "time#2.5s",
            "t#1h_1m",
            "T#0s",
            "T#",
            "5",
            "T#5",
            "T#1.5ms",
        ];
        let expected = [
            Some(1500),
            Some(2500),
            Some(3_660_000),
            Some(0),
            None,
            None,
            None,
            None,
        ];
        assert_eq!(durations.map(milliseconds), expected);
    }

    /// As Excel saves them.
    #[test]
    fn tables_are_in_any_encoding() {
        for text in [
            "启动按钮,X000\r\n*,M100-M199\r\n",
            "启动按钮;X000\n*;M100-M199\n",
        ] {
            let (gbk, ..) = encoding_rs::GBK.encode(text);
            let utf16: Vec<u8> = ["\u{FEFF}", text]
                .concat()
                .encode_utf16()
                .flat_map(u16::to_le_bytes)
                .collect();
            for bytes in [text.as_bytes(), &gbk, &utf16] {
                let names = Names::read(bytes).unwrap();
                assert_eq!(names.devices["启动按钮"].to_string(), "X000");
                assert_eq!(names.free, [(DeviceClass::M, 100, 199)]);
            }
        }
        let wrong = Names::read(b"A,X0\nStop\n").unwrap_err();
        assert!(
            wrong.starts_with("`Stop` is not a row of a name"),
            "{wrong}"
        );
    }

    #[test]
    fn tables_name_devices_and_give_free_ones() {
        let names = Names::parse("Hidden,M20\r\n\"start\"\tX005\n*,M100-M199\n*,T5\n").unwrap();
        assert_eq!(names.devices["START"].to_string(), "X005");
        let free = [(DeviceClass::M, 100, 199), (DeviceClass::T, 5, 5)];
        assert_eq!(names.free, free);
        for wrong in ["Stop", "Start,%IX0.0", "*,M5-D6", "*,M9-M5"] {
            assert_eq!(
                Names::parse(&format!("A,X0\n{wrong}\n")),
                Err(wrong.to_owned())
            );
        }
    }
}
