//! Variables: devices of a program as importers see them.

use rungc_emit::storage::{Kind, Member, Storage};
use rungc_ir::Module;
use rungc_models::runs::is_counter32;
use rungc_syntax::{Device, DeviceClass};

/// Name of the time.
pub const TIME_NAME: &str = "time";

/// Name of the parameter that says how long a scan takes.
pub const SCAN_NAME: &str = "scan_time_ms";

/// Value of a device.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Value {
    /// A bit; of a timer or counter its contact.
    Bit,
    /// A word; of a timer or counter its current value, which has 32 bits from C200 on.
    Word,
    /// A 32-bit integer in two words, the low one first.
    Double,
    /// A float in two words, the low one first.
    Float,
}

/// Use of a variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Causality {
    /// Set by the importer.
    Input,
    /// Set by the program, for the importer.
    Output,
    /// Set by the program.
    Local,
}

impl Causality {
    /// Its name in FMI.
    pub(super) fn name(self) -> &'static str {
        match self {
            Causality::Input => "input",
            Causality::Output => "output",
            Causality::Local => "local",
        }
    }
}

/// A device of the program as a variable.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Variable {
    /// Name of letters, digits and `_` that no other variable has.
    pub name: String,
    /// Description, in one line; may be empty.
    pub description: String,
    /// The device; of a number in two words the first.
    pub device: Device,
    /// Value of the device.
    pub value: Value,
    /// Use of the variable.
    pub causality: Causality,
}

/// Type of a variable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Type {
    Boolean,
    Int16,
    Int32,
    Float32,
}

impl Type {
    /// Its name in FMI.
    pub fn name(self) -> &'static str {
        match self {
            Type::Boolean => "Boolean",
            Type::Int16 => "Int16",
            Type::Int32 => "Int32",
            Type::Float32 => "Float32",
        }
    }

    /// The value 0.
    pub fn zero(self) -> &'static str {
        match self {
            Type::Boolean => "false",
            Type::Int16 | Type::Int32 | Type::Float32 => "0",
        }
    }
}

impl Variable {
    /// Its type in FMI.
    pub(super) fn ty(&self) -> Type {
        let Device { class, number } = self.device;
        match self.value {
            Value::Bit => Type::Boolean,
            Value::Word if is_counter32(class, number) => Type::Int32,
            Value::Word => Type::Int16,
            Value::Double => Type::Int32,
            Value::Float => Type::Float32,
        }
    }

    /// Its value reference, which depends on nothing but the device and its value. From the lowest bit: 16 bits of
    /// number, 2 that say if it has two words, and the place of the class in `plc_class` of `rungc_access.h`, from 1.
    pub fn reference(&self) -> u32 {
        let Device { class, number } = self.device;
        let of_class = match (class, self.value) {
            (DeviceClass::T, Value::Bit) => 12,
            (DeviceClass::C, Value::Bit) => 13,
            _ => class_code(class),
        };
        let words = match self.value {
            Value::Bit | Value::Word => 0,
            Value::Double => 1,
            Value::Float => 2,
        };
        of_class << 18 | words << 16 | (number & 0xFFFF)
    }
}

/// Place of a class in `plc_class`, from 1.
fn class_code(class: DeviceClass) -> u32 {
    match class {
        DeviceClass::X => 1,
        DeviceClass::Y => 2,
        DeviceClass::M => 3,
        DeviceClass::S => 4,
        DeviceClass::T => 5,
        DeviceClass::C => 6,
        DeviceClass::D => 7,
        DeviceClass::R => 8,
        DeviceClass::V => 9,
        DeviceClass::Z => 10,
        DeviceClass::ER => 11,
        // They are not stored.
        DeviceClass::P | DeviceClass::I | DeviceClass::N => 0,
    }
}

/// The variables whose devices the program stores. A pair of which only the first word is stored is a word.
pub(super) fn stored(module: &Module, variables: Vec<Variable>) -> Vec<Variable> {
    let storage = Storage::new(module);
    let kind = |class, number| storage.find(class, number).map(|field| field.kind);
    let fitting = |mut variable: Variable| {
        let Device { class, number } = variable.device;
        let kind_here = kind(class, number)?;
        if matches!(variable.value, Value::Double | Value::Float)
            && (kind_here != Kind::Word || kind(class, number + 1) != Some(Kind::Word))
        {
            variable.value = Value::Word;
        }
        let there = match variable.value {
            Value::Bit => kind_here.bit().is_some(),
            Value::Word => kind_here.word().is_some() || kind_here == Kind::Counter32,
            Value::Double | Value::Float => kind_here.word() == Some(Member::Whole),
        };
        there.then_some(variable)
    };
    let mut variables: Vec<_> = variables.into_iter().filter_map(fitting).collect();
    variables.sort_by_key(Variable::reference);
    variables.dedup_by_key(|variable| variable.reference());
    variables
}
