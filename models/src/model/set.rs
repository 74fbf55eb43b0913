//! Sets of models, and those that catalogue and tables name often.

use super::ModelId;

/// A set of models.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ModelSet(u32);

const _: () = assert!(ModelId::ALL.len() <= u32::BITS as usize);

impl ModelSet {
    /// No model.
    pub const NONE: ModelSet = ModelSet(0);
    /// Every model.
    pub const ALL: ModelSet = Self::of(&ModelId::ALL);
    /// Only H1U.
    pub const H1U: ModelSet = Self::of(&[ModelId::H1u]);
    /// Only H2U.
    pub const H2U: ModelSet = Self::of(&[ModelId::H2u]);
    /// H1U and H2U.
    pub const INOVANCE: ModelSet = Self::H1U.or(Self::H2U);
    /// Only L01S.
    pub const L01S: ModelSet = Self::of(&[ModelId::L01s]);
    /// Only HM.
    pub const HM: ModelSet = Self::of(&[ModelId::Hm]);
    /// FX1S and FX1N, which share a set of instructions but for FROM, TO, RD3A and WR3A.
    pub const FX1: ModelSet = Self::of(&[ModelId::Fx1s, ModelId::Fx1n]);
    /// FX2N and boards that are compatible with it.
    pub const FX2N: ModelSet = Self::of(&[ModelId::Fx2n, ModelId::Fx2nCompatible]);
    /// Only FX3S.
    pub const FX3S: ModelSet = Self::of(&[ModelId::Fx3s]);
    /// Only FX3G.
    pub const FX3G: ModelSet = Self::of(&[ModelId::Fx3g]);
    /// FX3U and boards that are compatible with it.
    pub const FX3U: ModelSet = Self::of(&[ModelId::Fx3u, ModelId::Fx3uCompatible]);
    /// FX3S, FX3G and FX3U.
    pub const FX3: ModelSet = Self::FX3S.or(Self::FX3G).or(Self::FX3U);
    /// The Mitsubishi models and compatible boards.
    pub const FX: ModelSet = Self::FX1.or(Self::FX2N).or(Self::FX3);
    /// Boards of other makers that take programs for a Mitsubishi model.
    pub const COMPATIBLE: ModelSet = Self::of(&[ModelId::Fx2nCompatible, ModelId::Fx3uCompatible]);

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

    /// Whether `model` is one of them.
    pub const fn has(self, model: ModelId) -> bool {
        self.0 >> model as u32 & 1 == 1
    }
}
