//! Special devices that nothing but the scan can set.

use super::Access;
use crate::Model;
use rungc_rt::special::{
    D_ANY_ERROR, D_OPERATION_ERROR, D_SCAN_TIME, D_SHORT_TICK, D_TICK, M_ANY_ERROR, M_CLOCK_10_MS,
    M_CLOCK_FITTED, M_FIRST_SCAN, M_LATER_SCANS, M_LINK_SET_UP, M_MODBUS_SET_UP, M_POWER_FAILS,
    M_POWER_FAILURE, M_RUNNING, M_STOPPED,
};
use rungc_syntax::DeviceClass::{self, D, M};

impl Model {
    /// Returns true if each scan gives a special device its value before the program reads it, so that a value from
    /// elsewhere has no effect: M8000, M8013, D8010.
    pub fn is_set_by_scan(&self, class: DeviceClass, number: u32) -> bool {
        let Some(row) = self.special(class, number) else {
            return false;
        };
        let shows_supply = self.shows_power_supply();
        let relays = [
            M_RUNNING,
            M_STOPPED,
            M_FIRST_SCAN,
            M_LATER_SCANS,
            M_LINK_SET_UP,
            M_MODBUS_SET_UP,
            M_CLOCK_FITTED,
        ];
        let is = |relay: rungc_rt::Relay| relay.number() == number;
        let is_set = match class {
            M if relays.into_iter().chain(M_CLOCK_10_MS.run::<4>()).any(is) => true,
            M if is(self.error_relay) => self.errors_last_a_scan,
            M if is(M_POWER_FAILS) || is(M_POWER_FAILURE) => shows_supply,
            // On HM, they are something else, which may be written.
            M => is(M_ANY_ERROR) && row.access == Access::Read,
            D if number == D_OPERATION_ERROR.number() => self.errors_last_a_scan,
            D if number == D_ANY_ERROR.number() => row.access == Access::Read,
            D if number == D_SCAN_TIME.number() => true,
            D => {
                let ticks = D_TICK.run::<2>().into_iter().chain([D_SHORT_TICK]);
                !shows_supply && ticks.map(|tick| tick.number()).any(|tick| tick == number)
            }
            _ => false,
        };
        is_set && row.is_kept_by_scan()
    }
}
