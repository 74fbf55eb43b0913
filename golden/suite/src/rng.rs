//! A small generator of pseudo-random numbers: the same seed gives the same numbers on every machine.

/// SplitMix64.
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// A separate sequence for each seed.
    pub fn new(seed: u64) -> Self {
        Rng(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    /// 0 to `n - 1`; 0 if `n` is 0.
    pub fn below(&mut self, n: u32) -> u32 {
        (self.bits() >> 32).checked_rem(n.into()).unwrap_or(0) as u32
    }

    /// True this many times in a hundred.
    pub fn percent(&mut self, percent: u32) -> bool {
        self.below(100) < percent
    }

    /// One of these; `None` if there is none.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> Option<T> {
        from.get(self.below(from.len() as u32) as usize).copied()
    }

    /// A value of this many bits, signed, that instructions find interesting: small, at a border, or any.
    pub fn value(&mut self, bits: u32) -> i64 {
        let max = (1i64 << (bits - 1)) - 1;
        match self.below(10) {
            0..=4 => i64::from(self.below(20)) - 4,
            5 => max - i64::from(self.below(3)),
            6 => -max - 1 + i64::from(self.below(3)),
            7 => i64::from(self.below(2000)) - 1000,
            _ => (self.bits() as i64) >> (64 - bits),
        }
    }
}
