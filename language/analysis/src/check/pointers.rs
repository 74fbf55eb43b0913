//! Definitions of pointers, and the instructions that name them.

use super::Code;
use rungc_catalogue::Basic;
use rungc_syntax::{Classes, Device, DeviceClass, OperandKind};
use rustc_hash::FxHashMap;

/// Uses of one pointer.
#[derive(Default)]
pub(super) struct Pointer {
    /// The labels that define it; more than one is an error.
    pub(super) labels: Vec<usize>,
    /// The jumps to it.
    pub(super) jumps: Vec<usize>,
    /// The calls of it.
    pub(super) calls: Vec<usize>,
    /// The other instructions that name it.
    pub(super) others: Vec<usize>,
}

impl Pointer {
    /// Returns true if it is both jumped to and called.
    pub(super) fn is_ambiguous(&self) -> bool {
        !self.jumps.is_empty() && !self.calls.is_empty()
    }

    /// Returns true if any instruction names it.
    pub(super) fn is_named(&self) -> bool {
        let uses = [&self.jumps, &self.calls, &self.others];
        uses.iter().any(|uses| !uses.is_empty())
    }
}

/// All pointers of a program.
pub(super) struct Pointers {
    map: FxHashMap<Device, Pointer>,
    /// In the order they first appear.
    order: Vec<Device>,
    /// True if a jump or call names its label with an index register, so that any label may be meant.
    indexed: bool,
    /// True if a jump does so.
    indexed_jump: bool,
    /// True if a call does so.
    indexed_call: bool,
}

impl Pointers {
    pub(super) fn new(code: &Code) -> Self {
        let mut pointers = Pointers {
            map: FxHashMap::default(),
            order: Vec::new(),
            indexed: false,
            indexed_jump: false,
            indexed_call: false,
        };
        for i in 0..code.len {
            if let Some(label) = code.label(i) {
                pointers.entry(label).labels.push(i);
                continue;
            }
            // A jump whose label could not be read may lead to any.
            let jumps = matches!(code.basic(i), Some(Basic::Cj | Basic::Call));
            let lost = code.is_meant(i) && code.instr(i).operands.is_empty();
            if jumps && (lost || code.lacks_a_device(i)) {
                pointers.note_index(code.basic(i));
            }
            for (at, operand) in code.instr(i).operands.iter().enumerate() {
                let (device, index) = match operand.kind {
                    OperandKind::Device(device, index) => (device, index),
                    OperandKind::Unreadable(Some(device)) => (device, None),
                    _ => continue,
                };
                let pointer = matches!(device.class, DeviceClass::P | DeviceClass::I);
                // An operand that does not belong there is wrong in itself.
                let known = code.inst(i).is_some() && !code.is_meant(i);
                let class = Classes::of_device(device.class);
                let fits = code
                    .params(i)
                    .get(at)
                    .is_some_and(|p| p.classes.meets(class));
                if !pointer || known && !fits {
                    continue;
                }
                if index.is_some() {
                    pointers.note_index(code.basic(i));
                    continue;
                }
                let pointer = pointers.entry(device);
                match code.basic(i) {
                    Some(Basic::Cj) => pointer.jumps.push(i),
                    Some(Basic::Call) => pointer.calls.push(i),
                    _ => pointer.others.push(i),
                }
            }
        }
        pointers
    }

    /// Takes an instruction that may name any label.
    fn note_index(&mut self, basic: Option<Basic>) {
        self.indexed = true;
        self.indexed_jump |= basic == Some(Basic::Cj);
        self.indexed_call |= basic == Some(Basic::Call);
    }

    fn entry(&mut self, device: Device) -> &mut Pointer {
        self.map.entry(device).or_insert_with(|| {
            self.order.push(device);
            Pointer::default()
        })
    }

    /// Uses of a pointer that the program defines or names.
    pub(super) fn get(&self, device: Device) -> Option<&Pointer> {
        self.map.get(&device)
    }

    /// All pointers, in the order they first appear.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Device, &Pointer)> {
        self.order
            .iter()
            .filter_map(|&device| Some((device, self.map.get(&device)?)))
    }

    /// Returns true if there is a call to this label.
    pub(super) fn is_called(&self, label: Device) -> bool {
        self.get(label)
            .is_some_and(|pointer| !pointer.calls.is_empty())
    }

    /// Returns true if a call with an index register may mean this label, if it follows FEND: any that no jump names.
    pub(super) fn may_be_called(&self, label: Device) -> bool {
        self.indexed_call && !self.is_jumped_to(label)
    }

    /// Returns true if a routine begins at this label.
    pub(super) fn begins_routine(&self, label: Device, after_fend: bool) -> bool {
        let called = self.is_called(label) && (after_fend || !self.is_jumped_to(label));
        label.class == DeviceClass::I || called || after_fend && self.may_be_called(label)
    }

    /// Returns true if a jump with an index register may lead to any label.
    pub(super) fn any_may_be_jumped_to(&self) -> bool {
        self.indexed_jump
    }

    /// Returns true if a call with an index register may call any label.
    pub(super) fn any_may_be_called(&self) -> bool {
        self.indexed_call
    }

    /// Returns true if there is a jump to this label.
    pub(super) fn is_jumped_to(&self, label: Device) -> bool {
        self.get(label)
            .is_some_and(|pointer| !pointer.jumps.is_empty())
    }

    /// Returns true if a label that nothing names may still be meant by a jump or call with an index register.
    pub(super) fn any_may_be_meant(&self) -> bool {
        self.indexed
    }
}
