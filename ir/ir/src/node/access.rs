//! Devices as values: which one, and what of it is read or written.

use super::{ExprId, Ty};
use rungc_models::Model;
use rungc_rt::{Register, Relay};
use rungc_syntax::DeviceClass;

/// A bit or word device, perhaps indexed: number = `number` + `index` (an `I32` expression). A special register that is
/// another name of an index register is that register, however a place or a run leads to it ([`Model::canonical`]).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub struct Place {
    /// Class.
    pub class: DeviceClass,
    /// Number without the index.
    pub number: u32,
    /// Index to add. A place with an index may only be accessed where [`Expr::InRange`](super::Expr::InRange) of it is
    /// known to hold; that of an [`Expr::Stride`](super::Expr::Stride) does. Which devices it may lead to says
    /// [`crate::reach`]; all of them are stored. An indexed access of a word of C200 and up reads the low word, and
    /// writes the sign-extended word.
    pub index: Option<ExprId>,
}

impl Place {
    /// A device without an index.
    pub fn fixed(class: DeviceClass, number: u32) -> Self {
        Place {
            class,
            number,
            index: None,
        }
    }

    /// Location of the high word of the pair at this place: in V for Z on models where `z_pairs_with_v`, else in the
    /// next device. A 32-bit counter has none.
    #[must_use]
    pub fn high_word(self, model: &Model) -> Self {
        if self.class == DeviceClass::Z && model.z_pairs_with_v {
            let class = DeviceClass::V;
            Place { class, ..self }
        } else {
            let number = self.number.saturating_add(1);
            Place { number, ..self }
        }
    }
}

impl From<Relay> for Place {
    fn from(relay: Relay) -> Self {
        Place::fixed(DeviceClass::M, relay.number())
    }
}

impl From<Register> for Place {
    fn from(register: Register) -> Self {
        Place::fixed(DeviceClass::D, register.number())
    }
}

/// Source of [`Expr::Read`](super::Expr::Read) and target of [`Action::Write`](super::Action::Write): a value of one
/// type, in a device or in several.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub struct Access {
    /// The device, or the first of them.
    pub place: Place,
    /// Part that is accessed.
    pub kind: AccessKind,
}

/// Part of a device, or of several from it on, that is read or written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum AccessKind {
    /// `Bit`: state of a bit device. Of T and C it is the contact, which is only read; X is written by force and at its
    /// own edge.
    Bit,
    /// `Bit`: bit 0–15 of a word device.
    WordBit(u8),
    /// `I16`: word device; for T and C0–C199 the current value.
    Word,
    /// `I32`: the pair (n+1, n); for C200 and up the current value; for Z on models where `z_pairs_with_v` the pair
    /// (Vn, Zn).
    Pair,
    /// `F32`: the pair's bits as a float.
    Float,
    /// `I32` if `wide`, else `I16`: as many bit devices as `4 * digits`, the lowest bit first. A read extends them with
    /// zeros, a write leaves the value's other bits out.
    Nibbles {
        /// 1 to 8 if `wide`, else 1 to 4.
        digits: u8,
        /// As `I32`.
        wide: bool,
    },
}

impl Access {
    /// The state of a bit device.
    pub fn bit(place: impl Into<Place>) -> Self {
        AccessKind::Bit.at(place)
    }

    /// A bit (0–15) of a word device.
    pub fn word_bit(place: impl Into<Place>, bit: u8) -> Self {
        AccessKind::WordBit(bit).at(place)
    }

    /// A word device.
    pub fn word(place: impl Into<Place>) -> Self {
        AccessKind::Word.at(place)
    }

    /// A pair of words, or a 32-bit counter.
    pub fn pair(place: impl Into<Place>) -> Self {
        AccessKind::Pair.at(place)
    }

    /// A pair of words as a float.
    pub fn float(place: impl Into<Place>) -> Self {
        AccessKind::Float.at(place)
    }

    /// The type of the value.
    pub fn ty(&self) -> Ty {
        match self.kind {
            AccessKind::Bit | AccessKind::WordBit(_) => Ty::Bit,
            AccessKind::Word | AccessKind::Nibbles { wide: false, .. } => Ty::I16,
            AccessKind::Pair | AccessKind::Nibbles { wide: true, .. } => Ty::I32,
            AccessKind::Float => Ty::F32,
        }
    }

    /// The class and number of the first device, if no index is added.
    pub fn device(&self) -> Option<(DeviceClass, u32)> {
        let Place {
            class,
            number,
            index,
        } = self.place;
        index.is_none().then_some((class, number))
    }

    /// Largest number of devices that it covers from the place on. The high word of a pair may be elsewhere
    /// ([`Place::high_word`]), or, of a 32-bit counter, nowhere.
    pub fn extent(&self) -> u32 {
        match self.kind {
            AccessKind::Bit | AccessKind::WordBit(_) | AccessKind::Word => 1,
            AccessKind::Pair | AccessKind::Float => 2,
            AccessKind::Nibbles { digits, .. } => 4 * u32::from(digits),
        }
    }

    /// Returns true if the kind is used within its bounds.
    pub(crate) fn is_well_formed(&self) -> bool {
        match self.kind {
            AccessKind::WordBit(bit) => bit < 16,
            AccessKind::Nibbles { digits, wide } => {
                (1..=if wide { 8 } else { 4 }).contains(&digits)
            }
            AccessKind::Bit | AccessKind::Word | AccessKind::Pair | AccessKind::Float => true,
        }
    }
}

impl AccessKind {
    /// This of the device at a place.
    pub fn at(self, place: impl Into<Place>) -> Access {
        Access {
            place: place.into(),
            kind: self,
        }
    }
}
