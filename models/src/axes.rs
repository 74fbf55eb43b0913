//! The parameters of HM's output axes as data (hm-motion-controller §8.2.3): each axis has fifty registers.

use crate::ModelId;

/// The first register of the first axis.
const FIRST: u32 = 300;
/// Registers of an axis.
const REGISTERS: u32 = 50;
/// How many axes there are.
const AXES: u32 = 6;

/// Which output the axis is bound to, at first its own.
const OUTPUT: u32 = 0;
/// Parameters that begin with a value other than 0: time unit in ms, highest speed, highest acceleration.
const DEFAULTS: [(u32, i16); 3] = [(2, 10), (5, 1000), (7, 100)];

/// Register of a parameter, by its place among the fifty.
pub fn register(axis: u32, parameter: u32) -> u32 {
    FIRST + REGISTERS * axis + parameter
}

/// Parameters whose bits name inputs: DOG, zero signal, limits, emergency, interrupt.
pub const INPUTS: [u32; 6] = [8, 9, 10, 11, 23, 24];

/// Parameters that begin with a value other than 0: registers and values.
pub fn defaults(model: ModelId) -> Vec<(u32, i16)> {
    let axes = if model == ModelId::Hm { AXES } else { 0 };
    let of_axis = |axis: u32| {
        let output = (register(axis, OUTPUT), axis as i16);
        let others = DEFAULTS.map(|(parameter, value)| (register(axis, parameter), value));
        std::iter::once(output).chain(others)
    };
    let all = (0..axes).flat_map(of_axis);
    all.filter(|&(_, value)| value != 0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_begin_with_their_own_outputs() {
        let defaults = defaults(ModelId::Hm);
        assert!(defaults.contains(&(550, 5)) && defaults.contains(&(302, 10)));
        assert!(!defaults.iter().any(|&(register, _)| register == 300));
        assert_eq!(super::defaults(ModelId::H2u), []);
    }
}
