//! Random numbers that are the same everywhere: those of Python's `random`, so that a program is known by its kind,
//! size and seed, whoever makes it.

const SIZE: usize = 624;
const MIDDLE: usize = 397;

/// A Mersenne Twister (MT19937), drawn from as Python's `random.Random` does.
#[derive(Clone, Debug)]
pub struct Random {
    state: [u32; SIZE],
    next: usize,
}

impl Random {
    /// As `random.Random(seed)`.
    pub fn new(seed: u32) -> Self {
        let mut state = [0u32; SIZE];
        state[0] = 19_650_218;
        for i in 1..SIZE {
            state[i] = scramble(state[i - 1])
                .wrapping_mul(1_812_433_253)
                .wrapping_add(i as u32);
        }
        let mut random = Random { state, next: SIZE };
        random.mix_in(seed);
        random
    }

    /// MT19937's initialisation by an array, for an array of one number.
    fn mix_in(&mut self, seed: u32) {
        let state = &mut self.state;
        let mut i = 1;
        for _ in 0..SIZE {
            state[i] =
                (state[i] ^ scramble(state[i - 1]).wrapping_mul(1_664_525)).wrapping_add(seed);
            i = following(state, i);
        }
        for _ in 1..SIZE {
            state[i] = (state[i] ^ scramble(state[i - 1]).wrapping_mul(1_566_083_941))
                .wrapping_sub(i as u32);
            i = following(state, i);
        }
        state[0] = 1 << 31;
    }

    fn refill(&mut self) {
        for i in 0..SIZE {
            let (this, next) = (self.state[i], self.state[(i + 1) % SIZE]);
            let joined = (this & 1 << 31) | (next & !(1 << 31));
            let twist = if joined & 1 == 1 { 0x9908_B0DF } else { 0 };
            self.state[i] = self.state[(i + MIDDLE) % SIZE] ^ joined >> 1 ^ twist;
        }
        self.next = 0;
    }

    fn word(&mut self) -> u32 {
        if self.next == SIZE {
            self.refill();
        }
        let mut y = self.state[self.next];
        self.next += 1;
        y ^= y >> 11;
        y ^= y << 7 & 0x9D2C_5680;
        y ^= y << 15 & 0xEFC6_0000;
        y ^ y >> 18
    }

    /// As `random()`: at least 0, less than 1.
    pub fn fraction(&mut self) -> f64 {
        let (high, low) = (self.word() >> 5, self.word() >> 6);
        (f64::from(high) * 67_108_864.0 + f64::from(low)) / 9_007_199_254_740_992.0
    }

    /// As `random() < probability`.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.fraction() < probability
    }

    /// As `randrange(end)`: at least 0, less than `end`, which is not 0.
    pub fn below(&mut self, end: u32) -> u32 {
        let bits = end.ilog2() + 1;
        loop {
            let drawn = self.word() >> (32 - bits);
            if drawn < end {
                return drawn;
            }
        }
    }

    /// As `randrange(first, end)`.
    pub fn between(&mut self, first: u32, end: u32) -> u32 {
        first + self.below(end - first)
    }

    /// As `choice(items)`, of one or more.
    pub fn choice<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len() as u32) as usize]
    }
}

fn scramble(word: u32) -> u32 {
    word ^ word >> 30
}

/// The place after `i`; after the last one, where the last word becomes the first, it is 1.
fn following(state: &mut [u32; SIZE], i: usize) -> usize {
    if i + 1 < SIZE {
        return i + 1;
    }
    state[0] = state[SIZE - 1];
    1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_python_s() {
        // random.Random(1): randrange(128) three times, random() twice, randrange(1, 500)
        let mut random = Random::new(1);
        let drawn = [0; 3].map(|_: i32| random.below(128));
        assert_eq!(drawn, [34, 16, 65]);
        let drawn = [0; 2].map(|_: i32| random.fraction());
        assert_eq!(drawn, [0.117_918_703_671_061_05, 0.760_962_444_912_575_6]);
        assert_eq!(random.between(1, 500), 242);
    }
}
