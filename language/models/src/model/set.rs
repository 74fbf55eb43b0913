//! Sets of models, and those that catalogue and tables name often.

use super::{Model, ModelId};

/// A set of models.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ModelSet(u32);

const _: () = assert!(ModelId::ALL.len() <= u32::BITS as usize);

/// The models for which a condition holds.
macro_rules! models_where {
    (|$model:ident| $holds:expr) => {{
        let mut set = ModelSet::NONE;
        let mut i = 0;
        while i < ModelId::ALL.len() {
            let $model = Model::get(ModelId::ALL[i]);
            if $holds {
                set = set.or(ModelSet::of(&[ModelId::ALL[i]]));
            }
            i += 1;
        }
        set
    }};
}

impl ModelSet {
    /// No model.
    pub const NONE: ModelSet = ModelSet(0);
    /// Every model.
    pub const ALL: ModelSet = Self::of(&ModelId::ALL);
    /// H1U.
    pub const H1U: ModelSet = Self::like(ModelId::H1u);
    /// H2U.
    pub const H2U: ModelSet = Self::like(ModelId::H2u);
    /// H1U and H2U.
    pub const INOVANCE: ModelSet = Self::H1U.or(Self::H2U);
    /// L01S.
    pub const L01S: ModelSet = Self::like(ModelId::L01s);
    /// HM.
    pub const HM: ModelSet = Self::like(ModelId::Hm);
    /// FX1S.
    pub const FX1S: ModelSet = Self::like(ModelId::Fx1s);
    /// FX1S and FX1N, which share a set of instructions but for FROM, TO, RD3A and WR3A.
    pub const FX1: ModelSet = Self::FX1S.or(Self::like(ModelId::Fx1n));
    /// FX2N and boards that are compatible with it.
    pub const FX2N: ModelSet = Self::like(ModelId::Fx2n);
    /// FX3S.
    pub const FX3S: ModelSet = Self::like(ModelId::Fx3s);
    /// FX3G.
    pub const FX3G: ModelSet = Self::like(ModelId::Fx3g);
    /// FX3U and boards that are compatible with it.
    pub const FX3U: ModelSet = Self::like(ModelId::Fx3u);
    /// FX3S, FX3G and FX3U.
    pub const FX3: ModelSet = Self::FX3S.or(Self::FX3G).or(Self::FX3U);
    /// The Mitsubishi models and compatible boards.
    pub const FX: ModelSet = Self::FX1.or(Self::FX2N).or(Self::FX3);
    /// Boards of other makers that take programs for a Mitsubishi model.
    pub const COMPATIBLE: ModelSet = {
        let mut set = Self::NONE;
        let mut i = 0;
        while i < ModelId::ALL.len() {
            if let Some(boards) = Model::get(ModelId::ALL[i]).boards {
                set = set.or(Self::of(&[boards]));
            }
            i += 1;
        }
        set
    };

    /// Models whose clock shows years of two digits, and takes such.
    pub const TWO_DIGIT_YEARS: ModelSet = models_where!(|model| model.two_digit_years);

    /// The models whose instructions are those of `origin`.
    const fn like(origin: ModelId) -> Self {
        models_where!(|model| model.instructions as u8 == origin as u8)
    }

    /// These models.
    pub const fn of(models: &[ModelId]) -> Self {
        let mut bits = 0;
        let mut i = 0;
        while i < models.len() {
            bits |= 1 << models[i] as u32;
            i += 1;
        }
        ModelSet(bits)
    }

    /// All of these but `others`.
    #[must_use]
    pub const fn without(self, others: ModelSet) -> Self {
        ModelSet(self.0 & !others.0)
    }

    /// These and `others`.
    #[must_use]
    pub const fn or(self, others: ModelSet) -> Self {
        ModelSet(self.0 | others.0)
    }

    /// Returns true if `model` is one of them.
    pub const fn has(self, model: ModelId) -> bool {
        self.0 >> model as u32 & 1 == 1
    }
}
