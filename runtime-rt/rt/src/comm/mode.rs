//! RUN and STOP as partners switch them: by commands of their protocols, and by special relays that they write.

use super::{Map, Ports};
use crate::plc::{Class, Plc};
use crate::special::{
    D_REMOTE, M_FORCE_ENABLE, M_FORCED_RUN, M_FORCED_STOP, M_LOCAL_CONTROL, M_REMOTE_RUN,
    REMOTE_KEY, Relay,
};

impl Ports {
    /// Returns true if a PLC of the family is in RUN, or goes there when the next scan begins, and stays there: false
    /// in STOP, and if a partner has requested it. A host that compares before and after a request knows who switches
    /// the PLC.
    pub fn will_run(self, map: &dyn Map) -> bool {
        let relay = |relay: Relay| map.bit(Class::M, relay.number());
        let is_on = |device| relay(device) == Some(true);
        let running = map.running();
        let switched = map.requested_running().unwrap_or(running);
        if self == Ports::Hm {
            let key = map.word(Class::D, D_REMOTE.number());
            return if key == Some(REMOTE_KEY) && relay(M_LOCAL_CONTROL) == Some(false) {
                is_on(M_REMOTE_RUN)
            } else {
                switched
            };
        }
        if is_on(M_FORCED_STOP) {
            return false;
        }
        // Going to STOP switches M8036 off.
        let is_stopped = running && !switched;
        switched || !is_stopped && is_on(M_FORCE_ENABLE) && is_on(M_FORCED_RUN)
    }
}

/// Returns true if a frame is being sent over a port, or waits to be.
pub fn is_answering(plc: &mut dyn Plc, port: u8) -> bool {
    plc.port(port).is_some_and(|port| port.status.sending)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comm::watched::Watched;

    #[test]
    fn partners_switch_by_request_and_by_relays() {
        for (running, on, expected) in [
            (true, &[][..], true),
            (true, &[8037], false),
            (true, &[8035, 8036, 8037], false),
            (false, &[], false),
            (false, &[8036], false),
            (false, &[8035, 8036], true),
            (false, &[8035, 8036, 8037], false),
        ] {
            let mut map = Watched::new();
            map.plc.sys.running = running;
            for &relay in on {
                let _ = map.set_bit(Class::M, relay, true);
            }
            let will_run = Ports::Fx3.will_run(&map);
            assert_eq!(will_run, expected, "{running} {on:?}");
            // HM has interrupts at these relays.
            assert_eq!(Ports::Hm.will_run(&map), running);
        }
        let mut map = Watched::new();
        let _ = map.set_word(Class::D, 8004, REMOTE_KEY);
        assert!(!Ports::Hm.will_run(&map));
        let _ = map.set_bit(Class::M, 8004, true);
        assert!(Ports::Hm.will_run(&map) && Ports::Fx3.will_run(&map));
    }
}
