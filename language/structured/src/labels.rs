//! The labels of a program: their types, and their devices.

use crate::ast::{Expr, ExprKind, Name, Section, Unit, UnitKind, Variable};
use crate::device;
use crate::layout::{Structures, Type};
use crate::literal::{Const, Literal, range};
use crate::ranges::{Free, Ranges};
use crate::stated::{stated, stated_members, suits};
use crate::types::{Fit, Ty};
use crate::{Known, blocks, calls, convert, fold, texts};
use rungc_syntax::{Device, DeviceClass, Diagnostic, OperandKind, Span, codes, phrase};
use smol_str::SmolStr;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Levels of blocks within blocks.
const DEEPEST: usize = 8;

/// Storage of a label.
#[derive(Clone, Debug)]
pub(crate) enum Stored {
    Device(OperandKind),
    /// Devices of an array or structure.
    Area(Area),
    Constant(Const),
    /// Constant text.
    Text(SmolStr),
    /// Instance of a function block.
    Instance(Rc<Instance>),
    /// Array of instances, each of which is a label with its index in its name: `Valves[2]`.
    Instances,
    /// Its declaration is wrong, which is reported.
    Unknown,
}

/// First devices of an array or structure.
#[derive(Clone, Debug, Default)]
pub(crate) struct Area {
    /// First of the bits.
    pub bits: Option<Device>,
    /// First of all else.
    pub words: Option<Device>,
    /// Members of a structure that have devices elsewhere, by their names in upper case.
    pub members: BTreeMap<String, Device>,
}

/// Purpose of a label in its unit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Role {
    Own,
    Input,
    Output,
    InOut,
}

/// A declared label.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub name: String,
    pub span: Span,
    pub of: Type,
    pub role: Role,
    pub stored: Stored,
    /// True for a constant that is written in hexadecimal digits.
    pub is_hex: bool,
    /// False where the declaration states the device.
    pub is_chosen: bool,
    pub is_used: Cell<bool>,
    /// Place of the first call that gives this output away: the label of the instance has no value then.
    pub given: Cell<Option<Span>>,
}

/// Labels by their names in upper case.
#[derive(Clone, Debug, Default)]
pub(crate) struct Labels {
    by_name: BTreeMap<String, Label>,
    /// Names in upper case that cannot be those of labels.
    rejected: Vec<String>,
    /// Labels that are global to these.
    pub global: Option<Rc<Labels>>,
}

/// An instance of a function block, or a function, with its labels.
#[derive(Clone, Debug)]
pub(crate) struct Instance {
    /// Position of the block or function among the units.
    pub unit: usize,
    pub own: Labels,
}

/// Environment of declarations.
pub(crate) struct Declaring<'d> {
    pub supply: &'d mut Supply,
    pub known: &'d Known,
    pub units: &'d [Unit],
    pub structures: &'d Structures,
    pub found: &'d mut Vec<Diagnostic>,
    /// Name of the program with a dot; empty for global labels and functions.
    pub program: String,
    /// Names of the instances around, each with a dot.
    pub path: String,
    /// True for the labels of a subroutine.
    pub is_routine: bool,
    /// Number of instances that may still be declared.
    pub left: usize,
}

impl<'d> Declaring<'d> {
    pub(crate) fn new(
        supply: &'d mut Supply,
        known: &'d Known,
        units: &'d [Unit],
        structures: &'d Structures,
        found: &'d mut Vec<Diagnostic>,
    ) -> Self {
        Declaring {
            supply,
            known,
            units,
            structures,
            found,
            program: String::new(),
            path: String::new(),
            is_routine: false,
            left: blocks::MOST,
        }
    }

    /// The known device of a label, by its name with or without that of the program.
    fn known(&self, name: &str) -> Option<Device> {
        let whole = format!("{}{name}", self.program).to_uppercase();
        let known = self.known.get(&whole);
        known.or_else(|| self.known.get(name)).copied()
    }
}

/// Numbers that are left for labels and temporaries.
#[derive(Clone, Debug)]
pub(crate) struct Supply {
    d: Free,
    m: Free,
    t: Free,
    c: Free,
    p: Free,
    ticks: Option<Free>,
}

impl Supply {
    pub(crate) fn new(ranges: &Ranges) -> Supply {
        Supply {
            d: Free::new(DeviceClass::D, ranges.d),
            m: Free::new(DeviceClass::M, ranges.m),
            t: Free::new(DeviceClass::T, ranges.t),
            c: Free::new(DeviceClass::C, ranges.c),
            p: Free::new(DeviceClass::P, ranges.p),
            ticks: ranges.ticks.map(|ticks| Free::new(DeviceClass::T, ticks)),
        }
    }

    /// The next timer of 10 ms.
    pub(crate) fn tick(&mut self) -> Option<Device> {
        let free = self.ticks.as_mut()?;
        let number = free.take_top(1)?;
        Some(Device {
            class: free.class,
            number,
        })
    }

    /// The first of `count` devices of a class, from the top of its range down.
    pub(crate) fn take(&mut self, class: DeviceClass, count: u32) -> Option<Device> {
        let free = match class {
            DeviceClass::M => &mut self.m,
            DeviceClass::T => &mut self.t,
            DeviceClass::C => &mut self.c,
            _ => &mut self.d,
        };
        let number = free.take_top(count)?;
        Some(Device {
            class: free.class,
            number,
        })
    }

    /// Leaves numbers free at the end of the bits: access to an element by a variable index takes 16 bits.
    fn leave_bits(&mut self) {
        self.m.leave(15);
    }

    /// Returns true while half of the words are left.
    pub(crate) fn is_ample(&self) -> bool {
        self.d.left() >= self.d.total() / 2
    }

    /// Keeps all temporaries that were ever taken.
    pub(crate) fn settle(&mut self) {
        self.d.settle();
        self.m.settle();
    }

    /// Frees the temporaries that were taken since `earlier`. Bits are used again only when few are left: a coil that
    /// stands once is easier to read.
    pub(crate) fn release(&mut self, earlier: &Supply) {
        /// More than a statement takes.
        const FEW: u32 = 100;
        self.d.release(&earlier.d);
        if self.m.left() < FEW {
            self.m.release(&earlier.m);
        }
    }

    /// Leaves out devices that are known for labels.
    pub(crate) fn avoid(&mut self, known: &Known) {
        for device in known.values() {
            for free in [&mut self.d, &mut self.m, &mut self.t, &mut self.c] {
                if free.class == device.class {
                    free.avoid(device.number);
                }
            }
        }
    }

    /// The next pointer, from the bottom of the range up.
    pub(crate) fn pointer(&mut self) -> Option<Device> {
        let number = self.p.take_bottom()?;
        Some(Device {
            class: self.p.class,
            number,
        })
    }
}

impl Labels {
    /// None yet, below global ones.
    pub(crate) fn below(global: Rc<Labels>) -> Self {
        Labels {
            global: Some(global),
            ..Labels::default()
        }
    }

    /// The label of this name.
    pub(crate) fn get(&self, name: &str) -> Option<&Label> {
        match self.own(name) {
            Some(label) => Some(label),
            None => self.global.as_ref()?.get(name),
        }
    }

    /// The label of this name, which is not global.
    pub(crate) fn own(&self, name: &str) -> Option<&Label> {
        let label = self.by_name.get(&name.to_uppercase())?;
        label.is_used.set(true);
        Some(label)
    }

    /// Adds a label, in place of another of its name.
    pub(crate) fn insert(&mut self, label: Label) {
        self.by_name.insert(label.name.to_uppercase(), label);
    }

    /// Notes a name that cannot be that of a label, and has been reported.
    fn reject(&mut self, name: &Name) {
        if !self.by_name.contains_key(&name.text.to_uppercase()) {
            self.rejected.push(name.text.to_uppercase());
        }
    }

    /// Returns true for the name of a label that has been reported: its uses are not.
    pub(crate) fn is_rejected(&self, name: &str) -> bool {
        let upper = name.to_uppercase();
        let global = self.global.as_ref();
        self.rejected.contains(&upper) || global.is_some_and(|global| global.is_rejected(name))
    }

    /// All labels, in the order of their names.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Label> {
        self.by_name.values()
    }

    /// Declares the labels of a section of a program, or of global ones.
    pub(crate) fn declare(&mut self, section: &Section, cx: &mut Declaring) {
        // Global labels are known without it.
        if section.keyword.text == "VAR_EXTERNAL" {
            return;
        }
        if !matches!(
            section.keyword.text.as_str(),
            "VAR" | "VAR_GLOBAL" | "VAR_CONSTANT" | "VAR_TEMP"
        ) {
            let what = phrase!(
                "`{keyword}` has no meaning in a program",
                keyword = section.keyword.text
            );
            let error = codes::ST_UNSUPPORTED.at(section.keyword.span, what);
            cx.found
                .push(error.help("a program declares its labels in `VAR` … `END_VAR`"));
        }
        self.section(section, Role::Own, cx);
    }

    fn section(&mut self, section: &Section, role: Role, cx: &mut Declaring) {
        for variable in &section.variables {
            if !variable.is_ended {
                let end = Span::new(variable.span.end, variable.span.end);
                let error = codes::ST_SYNTAX.at(end, "a declaration ends in `;`");
                cx.found.push(error.label("`;` is missing here"));
            }
            self.variable(variable, section.is_constant, role, cx);
        }
    }

    fn variable(&mut self, variable: &Variable, is_constant: bool, role: Role, cx: &mut Declaring) {
        if let Some(unit) = block_of(variable, cx.units) {
            let stated = variable.members.iter().map(|(_, device)| device);
            if let Some(place) = variable.place.iter().chain(stated).next() {
                let what = phrase!("a function block gets its devices by itself");
                let error = codes::ST_UNSUPPORTED.at(place.span, what);
                cx.found.push(error.help("leave out `AT`"));
            }
            let Some(bounds) = self.bounds(&variable.of, cx.found) else {
                return;
            };
            for name in &variable.names {
                match bounds.is_empty() {
                    true => self.instance(name, unit, cx),
                    false => self.instances(name, unit, &bounds, cx),
                }
            }
            return;
        }
        let of = self.type_of(&variable.of, cx.structures, cx.found);
        let stated = variable.place.as_ref().map(|place| stated(place, cx.found));
        for name in &variable.names {
            if let Some(error) = self.clash(name, role) {
                cx.found.push(error);
                self.reject(name);
                continue;
            }
            let mut label = Label::new(name, of.clone().unwrap_or(Type::Plain(Ty::Raw16)), role);
            label.is_chosen = variable.place.is_none();
            label.is_used = Cell::new(of.is_none());
            if let Some(of) = &of {
                let stored = match (is_constant, &stated) {
                    (true, _) => self.constant(variable, name, of),
                    (false, Some(Some(place))) => suits(place.clone(), of, variable),
                    (false, Some(None)) => Ok(Stored::Unknown),
                    // A reference has no device; a subroutine works on a copy.
                    (false, None) if role == Role::InOut && !cx.is_routine => Ok(Stored::Unknown),
                    (false, None) => chosen(&label, cx, variable),
                };
                match stored {
                    Ok(stored) => label.stored = stored,
                    Err(error) => cx.found.push(*error),
                }
                if let (false, Some(initial)) = (is_constant, &variable.initial) {
                    cx.found.extend(initial_value(self, initial));
                }
            }
            label.is_hex = is_constant
                && variable
                    .initial
                    .as_ref()
                    .is_some_and(|initial| fold::is_hexadecimal(self, initial));
            self.insert(label);
        }
    }

    /// Declares an array of instances of a function block.
    fn instances(&mut self, name: &Name, unit: usize, bounds: &[(i64, i64)], cx: &mut Declaring) {
        if let Some(error) = self.clash(name, Role::Own) {
            cx.found.push(error);
            return;
        }
        let mut label = Label::new(name, Type::Plain(Ty::Raw16), Role::Own);
        label.stored = Stored::Instances;
        self.insert(label);
        let mut index: Vec<i64> = bounds.iter().map(|(first, _)| *first).collect();
        loop {
            let element = Name {
                text: element(&name.text, &index).into(),
                span: name.span,
            };
            self.instance(&element, unit, cx);
            // Some of them may be without a use.
            self.own(&element.text);
            // The last dimension counts first.
            let next = (0..index.len()).rev().find(|at| index[*at] < bounds[*at].1);
            let Some(at) = next.filter(|_| cx.left > 0) else {
                return;
            };
            index[at] += 1;
            for later in at + 1..index.len() {
                index[later] = bounds[later].0;
            }
        }
    }

    /// Declares an instance of a function block, with its labels.
    fn instance(&mut self, name: &Name, unit: usize, cx: &mut Declaring) {
        if let Some(error) = self.clash(name, Role::Own) {
            cx.found.push(error);
            return;
        }
        let outer = cx.path.clone();
        if outer.matches('.').count() >= DEEPEST || cx.left == 0 {
            let what = phrase!(
                "there are too many instances of blocks, or of blocks in blocks, at `{name}`",
                name = name.text
            );
            cx.found.push(codes::ST_UNSUPPORTED.at(name.span, what));
            return;
        }
        cx.left -= 1;
        cx.path = format!("{outer}{}.", name.text);
        let instance = Instance::declared(unit, cx);
        cx.path = outer;
        let mut label = Label::new(name, Type::Plain(Ty::Raw16), Role::Own);
        label.stored = Stored::Instance(Rc::new(instance));
        self.insert(label);
    }

    fn clash(&self, name: &Name, role: Role) -> Option<Diagnostic> {
        let text = name.text.as_str();
        if let Some(first) = self.by_name.get(&text.to_uppercase()) {
            let error = codes::ST_DECLARED_TWICE.at(
                name.span,
                phrase!("`{name}` is declared twice", name = text),
            );
            return Some(error.label("again here").other(first.span, "first here"));
        }
        // Calls name inputs and outputs.
        if role != Role::Own {
            return None;
        }
        let is_device = device::find(text).is_some() || device::constant(text).is_some();
        let what = if is_device {
            phrase!("a device or constant")
        } else if convert::find(text).is_some() || calls::is_instruction(text) {
            phrase!("an instruction or function")
        } else {
            return None;
        };
        let error = codes::ST_DECLARED_TWICE.at(
            name.span,
            phrase!("`{name}` is the name of {what}", name = text, what),
        );
        Some(error.help("choose another name for the label"))
    }

    fn constant(
        &self,
        variable: &Variable,
        name: &Name,
        of: &Type,
    ) -> Result<Stored, Box<Diagnostic>> {
        let Some(ty) = of.plain() else {
            let what = phrase!("arrays and structures that are constant are not compiled yet");
            return Err(codes::ST_UNSUPPORTED.at(variable.span, what).into());
        };
        let Some(initial) = &variable.initial else {
            let what = phrase!("the constant `{name}` has no value", name = name.text);
            return Err(codes::ST_LITERAL
                .at(name.span, what)
                .help("write `:= VALUE`")
                .into());
        };
        if let (Ty::Text(most), ExprKind::Text(text)) = (ty, &initial.kind) {
            return texts::constant(text, most, initial.span).map(Stored::Text);
        }
        let Some((value, of)) = fold::constant(self, initial) else {
            let what = phrase!("this is not a constant");
            return Err(codes::ST_LITERAL.at(initial.span, what).into());
        };
        value_in((value, of), ty, initial.span).map(Stored::Constant)
    }
}

impl Label {
    fn new(name: &Name, of: Type, role: Role) -> Label {
        Label {
            name: name.text.to_string(),
            span: name.span,
            of,
            role,
            stored: Stored::Unknown,
            is_hex: false,
            is_chosen: true,
            is_used: Cell::new(false),
            given: Cell::new(None),
        }
    }
}

impl Instance {
    /// An instance of a block, or a function with its result, with devices for its labels.
    pub(crate) fn declared(unit: usize, cx: &mut Declaring) -> Instance {
        let block = &cx.units[unit];
        let mut own = Labels::default();
        let is_routine = block.kind == UnitKind::Function || block.is_library;
        let outer = std::mem::replace(&mut cx.is_routine, is_routine);
        let before = cx.found.len();
        for section in &block.sections {
            let role = match section.keyword.text.as_str() {
                "VAR_INPUT" => Role::Input,
                "VAR_OUTPUT" => Role::Output,
                "VAR_IN_OUT" => Role::InOut,
                "VAR_EXTERNAL" => continue,
                _ => Role::Own,
            };
            own.section(section, role, cx);
        }
        if let Some(of) = &block.returns {
            let result = Variable {
                names: vec![block.name.clone()],
                place: None,
                members: Vec::new(),
                of: of.clone(),
                initial: None,
                is_ended: true,
                span: of.span,
            };
            own.variable(&result, false, Role::Own, cx);
        }
        cx.is_routine = outer;
        // Each instance would report the same.
        let mut kept = cx.found.split_off(before);
        kept.retain(|one| !cx.found.contains(one));
        cx.found.append(&mut kept);
        Instance { unit, own }
    }
}

/// An initial value other than 0 is not compiled for FX.
pub(crate) fn initial_value(labels: &Labels, initial: &Expr) -> Option<Diagnostic> {
    let is_zero = match fold::constant(labels, initial) {
        _ if initial.kind == ExprKind::Initial(true) => true,
        Some((Const::Int(0) | Const::Bool(false), _)) => true,
        Some((Const::Real(value), _)) => value == 0.0,
        _ if matches!(&initial.kind, ExprKind::Text(text) if text.is_empty()) => true,
        _ => false,
    };
    let what = phrase!("GX Works2 compiles no initial values for FX");
    let error = || codes::ST_UNSUPPORTED.at(initial.span, what);
    let help = phrase!("assign it in the first scan: `IF M8002 THEN … END_IF;`");
    (!is_zero).then(|| error().help(help))
}

/// A constant in a type.
pub(crate) fn value_in((value, of): Literal, ty: Ty, span: Span) -> Result<Const, Box<Diagnostic>> {
    let misfit = || {
        let what = phrase!(
            "this is {given}, where {expected} is expected",
            given = of,
            expected = ty
        );
        Err(codes::ST_TYPE.at(span, what).into())
    };
    if of.fit(ty) != Fit::Fits {
        return misfit();
    }
    match (value, range(ty)) {
        (Const::Int(value), _) if ty == Ty::Real => Ok(Const::Real(value as f64)),
        (Const::Int(value), Some((least, most))) if value < least || value > most => {
            let what = phrase!("{value} does not fit in {ty}", value, ty);
            let error = codes::ST_LITERAL.at(span, what);
            Err(error
                .help(phrase!("it holds {least} to {most}", least, most))
                .into())
        }
        (Const::Int(value), _) if ty == Ty::Bool => Ok(Const::Bool(value == 1)),
        (value, _) => Ok(value),
    }
}

/// Name of an element of an array of instances: `Valves[1,2]`.
pub(crate) fn element(name: &str, index: &[i64]) -> String {
    let index: Vec<_> = index.iter().map(ToString::to_string).collect();
    format!("{name}[{}]", index.join(","))
}

/// The function block that a declaration names as its type.
fn block_of(variable: &Variable, units: &[Unit]) -> Option<usize> {
    let name = &variable.of.name.text;
    let is_this =
        |unit: &Unit| unit.kind == UnitKind::Block && unit.name.text.eq_ignore_ascii_case(name);
    units.iter().position(is_this)
}

/// Devices for a label that states none.
fn chosen(
    label: &Label,
    cx: &mut Declaring,
    variable: &Variable,
) -> Result<Stored, Box<Diagnostic>> {
    let name = format!("{}{}", cx.path, label.name).to_uppercase();
    let size = label.of.size();
    let is_counter = variable.of.name.text.eq_ignore_ascii_case("COUNTER");
    let class = match label.of.element() {
        Some(Ty::Timer) if is_counter => DeviceClass::C,
        Some(Ty::Timer) => DeviceClass::T,
        _ => DeviceClass::D,
    };
    let mut area = Area::default();
    if let (Some((member, _)), None) = (variable.members.first(), label.of.structure()) {
        let what = phrase!("`{name}` has no members", name = label.name);
        return Err(codes::ST_TYPE.at(member.span, what).into());
    }
    if let Type::Structure(structure) = &label.of {
        area.members = stated_members(structure, variable)?;
        let members = structure.members.iter().filter_map(|member| {
            let member = member.name.to_uppercase();
            let device = cx.known(&format!("{name}.{member}"))?;
            Some((member, device))
        });
        let known: Vec<_> = members.collect();
        for (member, device) in known {
            area.members.entry(member).or_insert(device);
        }
        if area.members.len() == structure.members.len() {
            return Ok(Stored::Area(area));
        }
    }
    let known = cx.known(&name);
    if size.bits > 1 {
        cx.supply.leave_bits();
    }
    let mut part = |class: DeviceClass, count| match known {
        _ if count == 0 => Ok(None),
        Some(known) if label.of.element().is_some() => Ok(Some(known)),
        _ => cx.supply.take(class, count).map(Some).ok_or(class),
    };
    let none_left = |class: DeviceClass| {
        let what = phrase!(
            "no device {prefix} is left for `{name}`",
            prefix = class.prefix(),
            name = label.name
        );
        let error = codes::ST_NO_DEVICE.at(label.span, what);
        error.help("state a device with `AT`, or shorten the arrays")
    };
    area.words = part(class, size.words).map_err(none_left)?;
    area.bits = part(DeviceClass::M, size.bits).map_err(none_left)?;
    Ok(match (&label.of, area.words.or(area.bits)) {
        (Type::Plain(_), Some(device)) => Stored::Device(OperandKind::Device(device, None)),
        _ => Stored::Area(area),
    })
}
