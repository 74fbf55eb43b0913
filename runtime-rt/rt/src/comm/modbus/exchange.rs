//! One exchange of a master after the other, and whose turn it is.
//!
//! An instruction of the program that is driven while the port is free hands over its job ([`Exchange::begin`]). The
//! port sends the request between scans and takes the answer. When the scan reaches that instruction again, driven or
//! not, it learns how the exchange ended, and the next driven one has its turn: the search continues right after it and
//! around (h1u-h2u-programming §5.7.1). So each has its turn, without a queue.

use super::adu::Framing;
use super::master::{Buffer, Job, accept};
use crate::comm::{LineFault, Map};
use crate::plc::Class;

/// Progress of an exchange.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
enum Phase {
    /// The port is free.
    #[default]
    Free = 0,
    /// The request is to be sent.
    Ready = 1,
    /// The request is on the line.
    Sent = 2,
    /// The answer is awaited.
    Waiting = 3,
    /// It is over; the instruction does not know yet.
    Over = 4,
}

/// Outcome of an exchange.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum End {
    /// As it should.
    #[default]
    Well = 0,
    /// With a refusal, or with an answer or a request that is wrong.
    Badly = 1,
    /// Without an answer.
    Late = 2,
}

/// The exchange of a port that is a master. All zero is a port that is free.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Exchange {
    job: Job,
    /// Instruction it is for.
    owner: u32,
    time_out_us: u32,
    /// Time at which the request was out.
    since_us: u32,
    phase: Phase,
    end: End,
    /// Number of remaining retries.
    retries: u8,
    /// Number of retries so far.
    tries: u8,
    /// The scan in which the instruction has learnt of the last end ([`crate::Sys::scan`]); 0 before.
    pub reported_in: u16,
}

/// State of the port for an instruction that the scan reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visit {
    /// Nothing to do: the port works for another one or still for this one, or it is not driven.
    Pass,
    /// The port is free and this instruction driven: its turn.
    Turn,
    /// Its exchange is over; the port is free again.
    Over(End),
}

impl Default for Exchange {
    fn default() -> Self {
        Self::new()
    }
}

impl Exchange {
    /// A port that is free.
    pub const fn new() -> Self {
        Exchange {
            job: Job {
                station: 0,
                function: 0,
                address: 0,
                count: 0,
                buffer: Buffer::words(Class::X, 0),
            },
            owner: 0,
            time_out_us: 0,
            since_us: 0,
            phase: Phase::Free,
            end: End::Well,
            retries: 0,
            tries: 0,
            reported_in: 0,
        }
    }

    /// The scan has reached instruction `owner` (any number that no other has).
    pub fn visit(&mut self, owner: u32, driven: bool) -> Visit {
        match self.phase {
            Phase::Free if driven => Visit::Turn,
            Phase::Over if self.owner == owner => {
                self.phase = Phase::Free;
                Visit::Over(self.end)
            }
            _ => Visit::Pass,
        }
    }

    /// The instruction whose turn it is hands over its job. The answer may take `time_out_us` from when the request is
    /// out; without one the request is sent `retries` times again. After a broadcast, which has no answer, the port
    /// waits so long.
    pub fn begin(&mut self, owner: u32, job: Job, time_out_us: u32, retries: u8) {
        *self = Exchange {
            job,
            owner,
            time_out_us,
            since_us: 0,
            phase: Phase::Ready,
            end: End::Well,
            retries,
            tries: 0,
            reported_in: self.reported_in,
        };
    }

    /// The instruction that the port works for: its step, plus 1.
    pub fn owner(&self) -> u32 {
        self.owner
    }

    /// Job of the exchange.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Returns true if the answer is pending.
    pub fn is_waiting(&self) -> bool {
        self.phase == Phase::Waiting
    }

    /// Time-out for the beginning of the answer, in microseconds.
    pub fn time_out_us(&self) -> u32 {
        self.time_out_us
    }

    /// Time since the request was out, in microseconds.
    pub fn waited_us(&self, now_us: u32) -> u32 {
        now_us.wrapping_sub(self.since_us)
    }

    /// Returns true if the port has no exchange.
    pub fn is_free(&self) -> bool {
        self.phase == Phase::Free
    }

    /// Number of retries so far.
    pub fn tries(&self) -> u8 {
        self.tries
    }

    /// Returns true if the port works for another instruction than this one.
    pub fn works_for_another(&self, owner: u32) -> bool {
        self.phase != Phase::Free && self.owner != owner
    }

    /// The job whose request is to be sent now.
    pub fn to_send(&self) -> Option<Job> {
        (self.phase == Phase::Ready).then_some(self.job)
    }

    /// The request has been handed to the line.
    pub fn sending(&mut self) {
        self.phase = Phase::Sent;
    }

    /// Returns true if the request is on the line.
    pub fn is_sending(&self) -> bool {
        self.phase == Phase::Sent
    }

    /// The last character of the request is out.
    pub fn sent(&mut self, now_us: u32) {
        self.since_us = now_us;
        self.phase = Phase::Waiting;
    }

    /// A frame has come; `Err` describes the problem. An unrequested one is dropped.
    pub fn receive(
        &mut self,
        framing: Framing,
        frame: &[u8],
        map: &mut dyn Map,
    ) -> Result<(), LineFault> {
        if self.phase != Phase::Waiting || !self.job.is_answered() {
            return Ok(());
        }
        let done = accept(framing, &self.job, frame, map);
        self.end(done.map_or(End::Badly, |()| End::Well));
        done
    }

    /// The request cannot be made, or characters have come that are not an answer.
    pub fn fail(&mut self) {
        if self.phase != Phase::Free {
            self.end(End::Badly);
        }
    }

    /// Lets time pass; returns whether the answer is late for good. `receiving` says that it has begun: then it is not.
    pub fn is_late(&mut self, now_us: u32, receiving: bool) -> bool {
        let waited_us = self.waited_us(now_us);
        let late = self.phase == Phase::Waiting && !receiving && waited_us >= self.time_out_us;
        if late && !self.job.is_answered() {
            self.end(End::Well);
            return false;
        }
        if late && self.tries < self.retries {
            self.tries += 1;
            self.phase = Phase::Ready;
            return false;
        }
        if late {
            self.end(End::Late);
        }
        late
    }

    fn end(&mut self, end: End) {
        self.end = end;
        self.phase = Phase::Over;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comm::Served;
    use crate::double::Double;

    fn job(station: u8) -> Job {
        Job {
            station,
            function: 3,
            address: 100,
            count: 1,
            buffer: Buffer::words(Class::D, 10),
        }
    }

    /// The scan passes instructions 1 to 3, of which these are driven; returns what each finds. One whose turn it is
    /// begins.
    fn scan(exchange: &mut Exchange, driven: [bool; 3]) -> [Visit; 3] {
        [1, 2, 3].map(|owner| {
            let visit = exchange.visit(owner, driven[owner as usize - 1]);
            if visit == Visit::Turn {
                exchange.begin(owner, job(owner as u8), 100_000, 0);
            }
            visit
        })
    }

    #[test]
    fn driven_instructions_take_turns() {
        use Visit::{Over, Pass, Turn};
        let mut plc = Double::new();
        let mut exchange = Exchange::new();
        let all = [true; 3];
        assert_eq!(scan(&mut exchange, all), [Turn, Pass, Pass]);
        assert_eq!(scan(&mut exchange, all), [Pass, Pass, Pass]);
        assert_eq!(exchange.to_send(), Some(job(1)));
        exchange.sending();
        assert_eq!(exchange.to_send(), None);
        exchange.sent(50);
        let answer = [1, 3, 2, 0x51, 0, 0x85, 0xd4];
        let taken = exchange.receive(Framing::Rtu, &answer, &mut Served::new(&mut plc, 0));
        assert_eq!((taken, plc.d(10, 1)), (Ok(()), std::vec![0x5100]));
        // The instruction that was switched off learns of its end; the one after it is next.
        assert_eq!(
            scan(&mut exchange, [false, true, true]),
            [Over(End::Well), Turn, Pass]
        );
        exchange.fail();
        let failed = Over(End::Badly);
        assert_eq!(
            scan(&mut exchange, [true, true, false]),
            [Pass, failed, Pass]
        );
        assert_eq!(
            scan(&mut exchange, [false, false, true]),
            [Pass, Pass, Turn]
        );
    }

    #[test]
    fn an_answer_is_late_from_the_end_of_the_request() {
        let mut exchange = Exchange::new();
        assert_eq!(exchange.visit(7, true), Visit::Turn);
        exchange.begin(7, job(1), 100_000, 0);
        assert!(!exchange.is_late(1_000_000, false));
        exchange.sending();
        exchange.sent(u32::MAX);
        assert!(!exchange.is_late(99_998, false));
        assert!(!exchange.is_late(99_999, true));
        assert!(exchange.is_late(99_999, false));
        assert!(!exchange.is_late(99_999, false));
        assert_eq!(exchange.visit(7, false), Visit::Over(End::Late));
    }

    #[test]
    fn a_request_without_an_answer_is_sent_again() {
        let mut exchange = Exchange::new();
        exchange.begin(7, job(1), 100_000, 2);
        for tries in 1..=2 {
            exchange.sending();
            exchange.sent(0);
            assert!(!exchange.is_late(100_000, false));
            assert_eq!(
                (exchange.tries(), exchange.to_send()),
                (tries, Some(job(1)))
            );
        }
        exchange.sending();
        exchange.sent(0);
        assert!(exchange.is_late(100_000, false));
        assert_eq!(exchange.visit(7, true), Visit::Over(End::Late));
    }

    #[test]
    fn nobody_answers_a_broadcast() {
        let mut exchange = Exchange::new();
        exchange.begin(7, job(0), 100_000, 2);
        exchange.sending();
        exchange.sent(0);
        assert!(!exchange.is_late(99_999, false));
        assert_eq!(exchange.visit(7, true), Visit::Pass);
        assert!(!exchange.is_late(100_000, false));
        assert_eq!(exchange.visit(7, true), Visit::Over(End::Well));
    }
}
