//! The time from one scan to the next.

use super::{Simulation, missing};
use crate::commands::{Failure, eprint_line};
use rungc_sim::Session;
use rungc_sim::plant::Plant;

impl Simulation<'_> {
    /// Returns true if nothing happens between two scans but settings.
    fn is_idle_between_scans(&self) -> bool {
        self.session.plant().is_none()
            && self.recording.is_none()
            && self.plotting.is_none()
            && self.scope.is_none()
            && !self.session.machine().module().takes_time()
    }

    /// The time from one scan to the next.
    pub(super) fn pass(&mut self, scan_ms: u64) -> std::result::Result<(), Failure> {
        if self.is_idle_between_scans() {
            self.compare_to_come();
            return self.pass_idly(scan_ms);
        }
        for left in (0..scan_ms).rev() {
            self.part_of_millisecond()?;
            if left == 0 {
                self.compare_to_come();
            }
            // A test file compares at the end of a scan's time, and sets after that.
            if left == 0 || self.recorder.is_none() {
                self.apply_settings()?;
            }
            self.session.take_interrupts();
            // The initial state of a scan is recorded as it leaves it.
            if left > 0 {
                self.record()?;
            }
        }
        Ok(())
    }

    /// The time from one scan to the next, in which nothing happens but what is set.
    fn pass_idly(&mut self, scan_ms: u64) -> std::result::Result<(), Failure> {
        let next_ms = self.session.now_ms() + scan_ms;
        while let Some(setting) = self.pending.peek().filter(|s| s.at_ms <= next_ms) {
            self.session.skip(setting.at_ms - self.session.now_ms());
            self.apply_settings()?;
            self.session.take_interrupts();
        }
        self.session.skip(next_ms - self.session.now_ms());
        Ok(())
    }

    /// The time after the last scan, as far as a recorded test is compared after it.
    pub(super) fn pass_last(&mut self, scan_ms: u64) -> std::result::Result<(), Failure> {
        if self.recorder.is_some() && !self.is_idle_between_scans() {
            for _ in 0..scan_ms {
                self.part_of_millisecond()?;
                self.session.take_interrupts();
            }
        }
        self.compare_to_come();
        Ok(())
    }

    /// Records what a test compares after this scan.
    fn compare_to_come(&mut self) {
        if let Some(mut recorder) = self.recorder.take() {
            recorder.scanned(self.session.seen());
            self.recorder = Some(recorder);
        }
    }

    /// A millisecond between two scans, but for what is set and interrupts.
    fn part_of_millisecond(&mut self) -> std::result::Result<(), Failure> {
        self.advance()?;
        let before = self.lines.mode(self.session.machine_mut());
        self.session.tick();
        self.lines.report_switch(before, self.session.machine_mut());
        Ok(())
    }

    /// The machine moves for a millisecond.
    fn advance(&mut self) -> std::result::Result<(), Failure> {
        let collision = |session: &Session| session.plant().and_then(Plant::collision).cloned();
        let before = collision(&self.session);
        let recording = &mut self.recording;
        self.session.advance(&[], &mut |change| match recording {
            Some(recording) => recording.edge(change),
            None => Ok(()),
        })?;
        if let Some(collision) = collision(&self.session).filter(|now| before.as_ref() != Some(now))
        {
            eprint_line(&format!("rungc: {collision}"));
        }
        Ok(())
    }

    /// Sets what is to be set now.
    pub(super) fn apply_settings(&mut self) -> std::result::Result<(), Failure> {
        let now_ms = self.session.now_ms();
        while let Some(setting) = self.pending.next_if(|s| s.at_ms <= now_ms) {
            let set = self.session.set(setting.target, setting.value);
            set.ok_or_else(|| missing(setting.target, self.session.machine().module()))?;
            if let Some(recorder) = &mut self.recorder {
                recorder.set(setting.target, setting.value);
            }
        }
        Ok(())
    }
}
