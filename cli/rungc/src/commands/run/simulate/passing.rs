//! The time from one scan to the next.

use super::{Simulation, missing};
use crate::commands::{Failure, eprint_line};
use rungc_rt::Program;
use rungc_sim::Target;
use rungc_sim::plant::Wired;
use rungc_syntax::DeviceClass;

impl Simulation<'_> {
    /// Returns true if nothing happens between two scans but settings.
    fn is_idle_between_scans(&self) -> bool {
        self.plant.is_none()
            && self.recording.is_none()
            && self.plotting.is_none()
            && self.scope.is_none()
            && !self.machine.module().takes_time()
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
            self.machine.take_interrupts(&mut self.hal);
            // The initial state of a scan is recorded as it leaves it.
            if left > 0 {
                self.record()?;
            }
        }
        Ok(())
    }

    /// The time from one scan to the next, in which nothing happens but what is set.
    fn pass_idly(&mut self, scan_ms: u64) -> std::result::Result<(), Failure> {
        let next_ms = self.now_ms + scan_ms;
        while let Some(setting) = self.pending.peek().filter(|s| s.at_ms <= next_ms) {
            self.now_ms = setting.at_ms;
            self.apply_settings()?;
            self.machine.take_interrupts(&mut self.hal);
        }
        self.now_ms = next_ms;
        Ok(())
    }

    /// The time after the last scan, as far as a recorded test is compared after it.
    pub(super) fn pass_last(&mut self, scan_ms: u64) -> std::result::Result<(), Failure> {
        if self.recorder.is_some() && !self.is_idle_between_scans() {
            for _ in 0..scan_ms {
                self.part_of_millisecond()?;
                self.machine.take_interrupts(&mut self.hal);
            }
        }
        self.compare_to_come();
        Ok(())
    }

    /// Records what a test compares after this scan.
    fn compare_to_come(&mut self) {
        if let Some(mut recorder) = self.recorder.take() {
            recorder.scanned(self.seen());
            self.recorder = Some(recorder);
        }
    }

    /// A millisecond between two scans, but for what is set and interrupts.
    fn part_of_millisecond(&mut self) -> std::result::Result<(), Failure> {
        self.now_ms += 1;
        self.hal.advance_to(self.now_ms as u32);
        self.move_plant()?;
        let before = self.lines.mode(&mut self.machine);
        self.machine.tick(&mut self.hal, self.now_ms as u32);
        self.lines.report_switch(before, &mut self.machine);
        Ok(())
    }

    /// The machine moves for the millisecond that ends now.
    fn move_plant(&mut self) -> std::result::Result<(), Failure> {
        let Some(plant) = &mut self.plant else {
            return Ok(());
        };
        let before = plant.collision().cloned();
        let recording = &mut self.recording;
        let mut wired = Wired {
            machine: &mut self.machine,
            hal: &mut self.hal,
            changed: &mut |change| match recording {
                Some(recording) => recording.edge(change),
                None => Ok(()),
            },
        };
        plant.step(self.now_ms, &[], &mut wired)?;
        if let Some(collision) = plant.collision()
            && before.as_ref() != Some(collision)
        {
            eprint_line(&format!("rungc: {collision}"));
        }
        Ok(())
    }

    /// Sets what is to be set now.
    pub(super) fn apply_settings(&mut self) -> std::result::Result<(), Failure> {
        while let Some(setting) = self.pending.next_if(|s| s.at_ms <= self.now_ms) {
            self.hal.advance_to(self.now_ms as u32);
            rungc_sim::set(
                &mut self.machine,
                &mut self.hal,
                setting.target,
                setting.value,
            )
            .ok_or_else(|| missing(setting.target, self.machine.module()))?;
            if let Some(recorder) = &mut self.recorder {
                recorder.set(setting.target, setting.value);
            }
            if let Target::Bit(DeviceClass::X, number) = setting.target
                && self.now_ms > 0
            {
                self.machine
                    .input_edge(&mut self.hal, number, setting.value != 0.0);
            }
        }
        Ok(())
    }
}
