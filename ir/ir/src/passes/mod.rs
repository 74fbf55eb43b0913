//! Passes over a module. None changes what a scan does to any device.
//!
//! [`optimise`] rewrites the module twice: the first pass leaves conditions with fewer uses, which the second puts
//! where they are used, so that emitted code reads as one would write it by hand. Where there are no temporaries the
//! first leaves nothing. Then rungs that are repeated with other devices become loops, and in the end neighbouring
//! branches of one condition become one.

mod effects;
mod fold;
mod grids;
mod inline;
mod interrupts;
mod join;
mod repeat;
mod rewrite;

use crate::node::Module;
use typed_index_collections::TiVec;

/// Folds constants, simplifies contact logic, puts temporaries that are used once where they are used, joins
/// neighbouring branches with one condition, and removes code that cannot be reached or whose results nothing uses.
pub fn optimise(module: &mut Module) {
    interrupts::run(module);
    simplify(module);
    repeat::run(module);
    join::run(module);
    debug_assert_eq!(crate::validate::validate(module), Ok(()));
}

/// As [`optimise`], but repeated rungs stay as they are.
pub fn simplify(module: &mut Module) {
    let room = rewrite::run(module, TiVec::new());
    if rewrite::may_gain(module) {
        rewrite::run(module, room);
    }
    debug_assert_eq!(crate::validate::validate(module), Ok(()));
}
