//! Special devices that show errors, as far as the scan keeps them: what is forgotten, the summary, and the log.
//!
//! The runtime shows an error when it occurs ([`rungc_rt::report`] and others).

use super::Lowerer;
use rungc_ir::node::{Access, Action, BinOp, Expr, ExprId, SysValue};
use rungc_rt::special::{
    D_ANY_ERROR, D_LOGGED_HOURS, D_OPERATION_ERROR, D_RUN_TIME, M_ANY_ERROR, M_OPERATION_ERROR,
    M_PORT_ERROR, M_PROGRAMMING_PORT_ERROR, M_WATCHDOG, Register, Relay,
};
use rungc_syntax::DeviceClass::{D, M};

/// The error log of H1U/H2U: hours, codes, and the running time in seconds.
const LOG: [Register; 22] = D_LOGGED_HOURS.run();
/// Relays of errors, M8060 to M8067.
const ERRORS: [Relay; 8] = Relay(8060).run();

impl Lowerer<'_> {
    /// The operation errors of the last run are forgotten when RUN begins, on FX and L01S in each scan, with their code
    /// (h1u-h2u-programming §8.3: 0 without an error); their latches are not.
    pub(super) fn forget_errors(&mut self) {
        let relay = self.model.error_relay;
        let shown = self.keeps(relay) || self.sums_up_errors();
        let code = self.keeps(D_OPERATION_ERROR);
        if !shown && !code {
            return;
        }
        let when = match self.model.errors_last_a_scan {
            true => SysValue::Running,
            false => SysValue::FirstScan,
        };
        let when = self.add(Expr::Sys(when));
        self.when(when, |this| {
            if shown {
                let off = this.bit_const(false);
                this.write_relay(relay, off);
            }
            if code {
                let none = this.int(0, false);
                this.emit(Action::Write(Access::word(D_OPERATION_ERROR), none));
            }
        });
    }

    /// Returns true if M8004 or D8004 is in use. On HM, they are something else.
    fn sums_up_errors(&self) -> bool {
        self.model.error_relay == M_OPERATION_ERROR
            && (self.keeps(M_ANY_ERROR) || self.keeps(D_ANY_ERROR))
    }

    /// M8004 is on while an error relay is, but for that of the programming port and, on FX, of other ports; D8004 is 0
    /// while none is.
    pub(super) fn sum_up_errors(&mut self) {
        if !self.sums_up_errors() {
            return;
        }
        let ports = self.model.error_rules.sums_up_ports;
        let connected = self.module.has_ports() || !self.module.requests.is_empty();
        let mut any: Option<ExprId> = None;
        for relay in ERRORS {
            let by_runtime = match relay {
                M_WATCHDOG | M_OPERATION_ERROR => true,
                M_PORT_ERROR => connected,
                _ => false,
            };
            let counts = match relay {
                M_PROGRAMMING_PORT_ERROR => false,
                M_PORT_ERROR => ports,
                _ => true,
            };
            if !counts || !by_runtime && !self.specials.has(relay) {
                continue;
            }
            self.specials.flags.push((M, relay.number()));
            let on = self.add(Expr::Read(Access::bit(relay)));
            any = Some(match any {
                Some(any) => self.or(any, on),
                None => on,
            });
        }
        let Some(any) = any else {
            return;
        };
        if self.keeps(M_ANY_ERROR) {
            self.write_relay(M_ANY_ERROR, any);
        }
        if self.keeps(D_ANY_ERROR) {
            let none = self.not(any);
            self.when(none, |this| {
                let zero = this.int(0, false);
                this.emit(Action::Write(Access::word(D_ANY_ERROR), zero));
            });
        }
    }

    /// Returns true if an error of a port shows in more than its relay and register.
    pub(super) fn errors_have_consequences(&self) -> bool {
        let rules = self.model.error_rules;
        rules.sums_up_ports && self.sums_up_errors()
            || rules.logs && LOG.iter().any(|&register| self.keeps(register))
    }

    /// The log's last pair counts the seconds of RUN; a cell counts the milliseconds of the second.
    fn count_run_time(&mut self) {
        self.specials
            .flags
            .extend(LOG.map(|register| (D, register.number())));
        let part = self.cell(
            "run_time_ms".to_string(),
            "milliseconds of the running time's second",
        );
        let (part_value, passed) = (
            self.add(Expr::Cell(part)),
            self.add(Expr::Sys(SysValue::SinceScanMs)),
        );
        let ms = self.add(Expr::Bin(BinOp::SatAdd, part_value, passed));
        let ms = self.settled(ms);
        let second = self.int(1000, true);
        let rest = self.add(Expr::Bin(BinOp::Rem, ms, second));
        self.emit(Action::SetCell(part, rest));
        let over = self.add(Expr::Bin(BinOp::Div, ms, second));
        let pair = Access::pair(D_RUN_TIME);
        let seconds = self.add(Expr::Read(pair));
        let seconds = self.add(Expr::Bin(BinOp::Add, seconds, over));
        self.emit(Action::Write(pair, seconds));
    }

    /// D8510 and D8511 (H1U/H2U), whose hours are in the log.
    pub(super) fn run_time(&mut self) {
        if LOG.iter().any(|&register| self.keeps(register)) {
            self.count_run_time();
        }
    }
}
