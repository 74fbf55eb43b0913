//! The hardware that a program runs on: special modules.

use rungc_rt::{VirtualHal, modules};
use rungc_syntax::FittedModule;

/// Hardware with these special modules.
pub fn of(fitted: &[FittedModule]) -> VirtualHal {
    let mut hal = VirtualHal::new();
    for module in fitted {
        // The settings name each number once, kinds that are known, and no more modules than there is room for.
        let _ = modules::Kind::find(module.kind).and_then(|kind| hal.fit(module.unit, kind));
        let _ = hal.delay_module(module.unit, module.delay_ms);
    }
    hal
}
