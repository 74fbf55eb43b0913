//! Selection of the runs that have come further than others: those whose memory holds values that few others have.

use super::Lanes;
use crate::system::System;

/// Frequency at which each bit of memory was on.
pub(super) struct Rarity {
    on: Vec<f64>,
    seen: f64,
}

/// Number of lanes in which the rarest continue, in addition to their own.
const REPLACED: usize = 24;
/// Number of the rarest lanes.
const COPIED: usize = 8;
/// Decay of earlier observations in each step: values that were rare long ago are not rare when many lanes have reached
/// them.
const KEPT: f64 = 0.98;

impl Rarity {
    /// Before anything was seen.
    pub fn new(system: &System) -> Self {
        Rarity {
            on: vec![0.0; system.latches.len()],
            seen: 0.0,
        }
    }

    /// Takes note of what memory holds in each lane.
    pub fn count(&mut self, lanes: &Lanes) {
        self.seen = self.seen * KEPT + f64::from(lanes.alive.count_ones());
        for (on, &bits) in self.on.iter_mut().zip(lanes.latches()) {
            *on = *on * KEPT + f64::from((bits & lanes.alive).count_ones());
        }
    }

    /// For each lane the one from which it continues: itself, or one of those whose memory holds what is rare.
    pub fn chosen(&self, lanes: &Lanes) -> [u8; 64] {
        let mut scores = [0.0; 64];
        for (&on, &bits) in self.on.iter().zip(lanes.latches()) {
            // As if each value had been seen once more, so that none is infinitely rare.
            let share = (on + 1.0) / (self.seen + 2.0);
            let (of_on, of_off) = (-share.log2(), -(1.0 - share).log2());
            for (lane, score) in scores.iter_mut().enumerate() {
                *score += if bits >> lane & 1 == 1 { of_on } else { of_off };
            }
        }
        // A lane that violated a constraint is over.
        for (lane, score) in scores.iter_mut().enumerate() {
            if lanes.alive >> lane & 1 == 0 {
                *score = -1.0;
            }
        }
        let mut ranked: [u8; 64] = std::array::from_fn(|lane| lane as u8);
        let score = |lane: u8| scores[usize::from(lane)];
        ranked.sort_by(|&a, &b| score(b).total_cmp(&score(a)));
        let mut from: [u8; 64] = std::array::from_fn(|lane| lane as u8);
        for (n, &lane) in ranked.iter().rev().take(REPLACED).enumerate() {
            from[usize::from(lane)] = ranked[n % COPIED];
        }
        from
    }
}
