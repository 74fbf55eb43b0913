//! Answers as data. Field names are stable.

use rungc_syntax::Phrase;
use serde::Serialize;

/// Answer to "why is this device on, or off?".
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Why {
    /// The device: `Y000`.
    pub device: String,
    /// Its comment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comment: Option<String>,
    /// The moment that is explained; none for the program alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<Moment>,
    /// Instructions that write the device, in the order of the program.
    pub writers: Vec<Writer>,
    /// Facts about the device, as sentences: `Y000 has 2 coils: the last one that is executed decides`.
    pub notes: Vec<Phrase>,
    /// Causes at the moment: that of the device first, then those of the devices that it depends on.
    pub causes: Vec<Cause>,
    /// Devices at which the causes end: what keeps the device as it is, in the first of the smallest sets, or in all of
    /// them where each has one member.
    pub because: Vec<Link>,
    /// What a person can do so that the device changes, if that was asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub how: Option<How>,
}

/// Result of a search for what a person can do so that a device changes.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct How {
    /// The state that is wanted.
    pub on: bool,
    /// True for an output that sends pulses: `on` means that it sends them, or is on.
    pub pulses: bool,
    /// True if a way was found: `actions`.
    pub found: bool,
    /// Reason why no way was searched for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_searched: Option<Phrase>,
    /// Longest time that was waited in a row, in milliseconds.
    pub longest_wait_ms: u64,
    /// What to do, in this order; the device changes with the last of them. None of them can be left out.
    pub actions: Vec<Action>,
    /// Inputs, and devices that nothing in the program writes, of which changes were tried, with their comments.
    pub levers: Vec<String>,
    /// Number of others, farther away in the program, which were not tried.
    pub left_out: usize,
    /// Number of different moments that were come to.
    pub moments: usize,
    /// True if all moments were come to that changes of the levers, one after another, lead to, within the longest time
    /// that is waited.
    pub is_whole: bool,
}

/// Something that a person does.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Action {
    /// Device that is changed; none: a wait.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// Its comment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comment: Option<String>,
    /// Its new value: `on`, `off`, `12`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<Phrase>,
    /// Number of times that it is switched on and off.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub times: Option<u32>,
    /// Milliseconds until the next action, or until the device changes.
    pub takes_ms: u64,
    /// Devices that change meanwhile: `M0 "automatic" comes on`.
    pub then: Vec<Phrase>,
}

/// A moment of a run.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Moment {
    /// Milliseconds since power-on; `None` of a moment that a PLC was read at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ms: Option<u64>,
    /// Value of the device: `on`, `off`, `12`.
    pub value: Phrase,
    /// Value after the next scan, if that changes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next: Option<Phrase>,
    /// False in STOP, where no instruction is executed.
    pub running: bool,
}

/// Place of an instruction.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Place {
    /// Step number.
    pub step: u32,
    /// Number of the network, from 1.
    pub network: usize,
    /// Instruction as the program writes it: `OUT Y000`.
    pub instruction: String,
}

/// Instruction that writes a device.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Writer {
    /// Its place.
    #[serde(flatten)]
    pub place: Place,
    /// Effect: `coil`, `set`, `reset`, `write`, `change`.
    pub effect: &'static str,
    /// Condition of its drive: `X000 "start" and not X001`; `always` if it hangs on the rail.
    pub condition: Phrase,
    /// Condition of its being executed, if it is not in every scan.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub executed_if: Option<Phrase>,
    /// Facts that may be unexpected, as sentences.
    pub notes: Vec<Phrase>,
    /// At a moment: whether the next scan executes it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub executed: Option<bool>,
    /// At a moment: whether its condition holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub driven: Option<bool>,
}

/// Reason for a device to be as it is.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// It is an input terminal.
    Input,
    /// The PLC drives it.
    Special,
    /// No instruction writes it: it is as something outside the program has left it.
    Unwritten,
    /// It is forced.
    Forced,
    /// An instruction wrote it in this scan.
    Written,
    /// The only instruction that writes it is executed, but not driven: it is as an earlier scan has left it.
    NotDriven,
    /// The only instruction that writes it is not executed: it is as an earlier scan has left it.
    NotExecuted,
    /// Several instructions may write it, and none did in this scan: it is as an earlier one has left it.
    Kept,
    /// It is an instruction with a drive, not a device.
    Drive,
}

/// Cause of a device's state, or of an instruction's drive.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct Cause {
    /// The device; that which the instruction writes, for a drive.
    pub device: String,
    /// Its comment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comment: Option<String>,
    /// State after the scan: `true` is on, or driven.
    pub on: bool,
    /// Reason for it.
    pub reason: Reason,
    /// The instruction that decided, or the only one that could have written it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<Place>,
    /// It is on because its own contact holds it.
    pub holds_itself: bool,
    /// Progress of a timer or counter.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub progress: Option<Progress>,
    /// Smallest sets: if all of one set were as needed, the state would be the other.
    pub sets: Vec<Vec<Link>>,
    /// True if there are more sets than those listed.
    pub more: bool,
    /// Last change of the device in the run, if that was observed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub since: Option<Since>,
    /// Other facts, as sentences.
    pub notes: Vec<Phrase>,
}

/// Progress of a timer or counter.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize)]
pub struct Progress {
    /// Current value, in units.
    pub value: i64,
    /// Preset, in units; none if an index selects it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<i64>,
    /// Length of a unit of a timer in milliseconds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit_ms: Option<u16>,
}

/// Member of a set.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Link {
    /// The device; none if it is not about one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
    /// Its comment.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub comment: Option<String>,
    /// State now, as a sentence: `X001 is off`.
    pub now: Phrase,
    /// State that is needed: `X001 on`.
    pub needed: Phrase,
    /// The contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<Place>,
    /// True if it cannot be followed further.
    pub opaque: bool,
}

/// Last change of a device.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Since {
    /// Milliseconds since power-on.
    pub ms: u64,
    /// Number of the scan, from 1.
    pub scan: u64,
    /// Changes in the same scan of devices that it depends on: `X001 went off`.
    pub with: Vec<Phrase>,
}
