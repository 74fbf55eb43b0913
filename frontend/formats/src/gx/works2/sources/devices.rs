//! Devices of labels: those that tables state, and those that the compiler chose.

use super::super::mentions;
use super::{Assigned, Label, Pou, Scope, ScopeKind, Sources, Structure};
use rungc_syntax::Device;
use std::collections::BTreeMap;

/// A label, or an element or member of one, and its device.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct LabelDevice {
    /// Name: `Start`, `Axis1.Ready`, `Table[2]`; of a label of a POU `Main.Step`, of an instance `Main.Timer1.Q`.
    pub name: String,
    /// Its device, or the first of two.
    pub device: Device,
    /// True if the compiler chose it.
    pub is_chosen: bool,
}

/// Elements of an array beyond this number get no name.
const MAX_ELEMENTS: u32 = 1024;

impl Sources {
    /// Labels with their devices: those of global labels first, stated ones before chosen ones. A name that has two
    /// chosen devices, one of them for a deleted label, is left out.
    pub fn devices(&self) -> Vec<LabelDevice> {
        let mut devices = Devices {
            sources: self,
            found: Vec::new(),
            is_chosen: false,
        };
        for (pou, label) in self.labels() {
            devices.stated(&qualified(pou, &label.name), label);
        }
        let stated = devices.found.len();
        devices.is_chosen = true;
        for scope in &self.scopes {
            devices.scope(scope);
        }
        let mut places: BTreeMap<String, Option<Device>> = BTreeMap::new();
        for chosen in &devices.found[stated..] {
            let place = places.entry(chosen.name.to_lowercase());
            let place = place.or_insert(Some(chosen.device));
            *place = place.filter(|device| *device == chosen.device);
        }
        let (mut all, chosen) = {
            let mut all = devices.found;
            let chosen = all.split_off(stated);
            (all, chosen)
        };
        // The first mention of each name that has one device.
        all.extend(chosen.into_iter().filter(|one| {
            let place = places.get_mut(&one.name.to_lowercase());
            place.is_some_and(|place| place.take().is_some())
        }));
        all
    }
}

/// Name of a label with the POU that declares it.
fn qualified(pou: Option<&Pou>, name: &str) -> String {
    match pou {
        Some(pou) => format!("{}.{name}", pou.name),
        None => name.to_owned(),
    }
}

struct Devices<'s> {
    sources: &'s Sources,
    found: Vec<LabelDevice>,
    is_chosen: bool,
}

impl<'s> Devices<'s> {
    fn add(&mut self, name: String, device: Device) {
        self.found.push(LabelDevice {
            name,
            device,
            is_chosen: self.is_chosen,
        });
    }

    /// Adds a label whose table states its devices.
    fn stated(&mut self, name: &str, label: &Label) {
        if let Some(device) = plain(&label.device) {
            self.elements(name, &label.data_type, device);
        }
        let Some(structure) = self.sources.structure(&label.type_name) else {
            return;
        };
        let members = structure.numbered();
        if label.is_array || members.len() != label.members.len() {
            return;
        }
        for (member, place) in members.iter().zip(&label.members) {
            if let Some(device) = plain(&place.device) {
                self.elements(
                    &format!("{name}.{}", member.name),
                    &member.data_type,
                    device,
                );
            }
        }
    }

    /// Adds a label of this type that begins at a device: an array's elements, or the label itself.
    fn elements(&mut self, name: &str, data_type: &str, first: Device) {
        let Some((from, to, element)) = array(data_type) else {
            return self.add(name.to_owned(), first);
        };
        let Some((_, width)) = size(element) else {
            return self.add(name.to_owned(), first);
        };
        for at in 0..to.abs_diff(from).saturating_add(1).min(MAX_ELEMENTS) {
            let number = first.number.saturating_add(at * width);
            let index = i64::from(from) + i64::from(at);
            self.add(format!("{name}[{index}]"), Device { number, ..first });
        }
    }

    /// Adds the labels of a scope that the sources declare.
    fn scope(&mut self, scope: &Scope) {
        match scope.kind {
            ScopeKind::Globals => {
                let labels = self.sources.globals.iter().flat_map(|table| &table.labels);
                let labels: Vec<_> = labels.collect();
                self.variables("", &labels, &scope.variables);
            }
            ScopeKind::Program => self.of_pou(&scope.name.clone(), &scope.name, scope),
            ScopeKind::Function => {
                let name = scope.name.rsplit('.').next().unwrap_or_default();
                self.of_pou(name, name, scope);
            }
            // An expansion between two steps repeats its instance.
            ScopeKind::Instance if !scope.name.contains(':') => {
                if let Some(path) = self.instance(scope) {
                    self.of_pou(&path, &scope.block, scope);
                }
            }
            ScopeKind::Instance | ScopeKind::Structure | ScopeKind::Other(_) => {}
        }
    }

    /// Adds the labels of a POU, whose names begin with `path`.
    fn of_pou(&mut self, path: &str, pou: &str, scope: &Scope) {
        if let Some(pou) = self.sources.pou(pou) {
            let labels: Vec<_> = pou.labels.iter().collect();
            self.variables(&format!("{path}."), &labels, &scope.variables);
        }
    }

    /// The path of an instance whose scope has the name of a program or program file before it: a global instance
    /// stands alone. `None` if the sources do not declare it.
    fn instance(&self, scope: &Scope) -> Option<String> {
        let mut names = scope.name.split('.');
        let first = names.next()?;
        let names: Vec<_> = names.collect();
        let globals = || self.sources.globals.iter().flat_map(|table| &table.labels);
        let is_block = |block: Option<&str>| {
            block.is_some_and(|block| block.eq_ignore_ascii_case(&scope.block))
        };
        if let Some(pou) = self.sources.pou(first)
            && is_block(self.type_of(pou.labels.iter(), &names))
        {
            return Some(format!("{}.{}", pou.name, names.join(".")));
        }
        is_block(self.type_of(globals(), &names)).then(|| names.join("."))
    }

    /// The block that an instance is of: a path of names from some labels on.
    fn type_of(&self, labels: impl Iterator<Item = &'s Label>, path: &[&str]) -> Option<&'s str> {
        let (first, rest) = path.split_first()?;
        let mut labels = labels.filter(|label| label.name.eq_ignore_ascii_case(first));
        let mut block = labels.next()?.type_name.as_str();
        for name in rest {
            let mut labels = self.sources.pou(block)?.labels.iter();
            let label = labels.find(|label| label.name.eq_ignore_ascii_case(name))?;
            block = label.type_name.as_str();
        }
        Some(block)
    }

    /// Adds those of some variables that are declared as labels without a device.
    fn variables(&mut self, path: &str, labels: &[&'s Label], variables: &[Assigned]) {
        for variable in variables {
            let is_this = |label: &&&Label| label.name.eq_ignore_ascii_case(&variable.name);
            let Some(label) = labels.iter().find(is_this) else {
                continue;
            };
            if !label.device.is_empty() {
                continue;
            }
            let name = format!("{path}{}", label.name);
            if let Some(scope) = &variable.members {
                self.members(&name, label, scope);
            } else if let Some(structure) = self.sources.structure(&label.type_name) {
                self.array_of(&name, label, structure, variable);
            } else if let Some(device) = variable.device {
                self.elements(&name, &label.data_type, device);
            }
        }
    }

    /// Adds the members of a structure or instance.
    fn members(&mut self, name: &str, label: &Label, scope: &Scope) {
        if let Some(structure) = self.sources.structure(&label.type_name) {
            for member in &structure.members {
                let mut variables = scope.variables.iter();
                let is_this = |one: &&Assigned| one.name.eq_ignore_ascii_case(&member.name);
                if let Some(device) = variables.find(is_this).and_then(|one| one.device) {
                    let name = format!("{name}.{}", member.name);
                    self.elements(&name, &member.data_type, device);
                }
            }
        } else {
            self.of_pou(name, &label.type_name, scope);
        }
    }

    /// Adds the members of an array of structures: those of one bit and all others lie in a part each, an element after
    /// the other, members in the order of their list.
    fn array_of(&mut self, name: &str, label: &Label, structure: &Structure, place: &Assigned) {
        let sizes = structure
            .members
            .iter()
            .map(|member| size(&member.data_type));
        let (Some((from, to, _)), Some(sizes)) =
            (array(&label.data_type), sizes.collect::<Option<Vec<_>>>())
        else {
            return;
        };
        let mut number = [place.bits, place.device].map(|device| device.map_or(0, |d| d.number));
        for at in 0..to.abs_diff(from).saturating_add(1).min(MAX_ELEMENTS) {
            let index = i64::from(from) + i64::from(at);
            for (member, (is_bit, width)) in structure.members.iter().zip(&sizes) {
                let (first, part) = match is_bit {
                    true => (place.bits, &mut number[0]),
                    false => (place.device, &mut number[1]),
                };
                if let Some(first) = first {
                    let number = *part;
                    *part = part.saturating_add(*width);
                    let device = Device { number, ..first };
                    self.add(format!("{name}[{index}].{}", member.name), device);
                }
            }
        }
    }
}

/// The device of a label that is a whole device, not digits or a bit of one.
fn plain(device: &str) -> Option<Device> {
    let is_group = device.starts_with(['K', 'k']);
    mentions::device(device).filter(|_| !is_group)
}

/// Bounds and element type of an array of one dimension whose bounds are numbers: `ARRAY [0..7] OF DINT`.
fn array(data_type: &str) -> Option<(i32, i32, &str)> {
    let (bounds, element) = data_type.split_once(']')?;
    let (_, bounds) = bounds.split_once('[')?;
    let (from, to) = bounds.split_once("..")?;
    let (from, to) = (from.trim().parse().ok()?, to.trim().parse().ok()?);
    let element = element.trim().strip_prefix("OF")?.trim();
    (from <= to).then_some((from, to, element))
}

/// Size of an elementary type: true for bits, and the number of bits or words.
fn size(data_type: &str) -> Option<(bool, u32)> {
    match data_type {
        "BOOL" => Some((true, 1)),
        "INT" | "WORD" => Some((false, 1)),
        "DINT" | "DWORD" | "REAL" | "TIME" => Some((false, 2)),
        _ => None,
    }
}
