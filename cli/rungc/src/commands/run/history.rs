//! Moments of a run to which it can return.

use super::Setting;
use super::live::Control;
use rungc_sim::session;
use std::iter::Peekable;
use std::slice::Iter;

/// The moments of a run.
pub type History<'a> = session::History<Moment<'a>>;

/// A run before a scan.
#[derive(Clone)]
pub struct Moment<'a> {
    /// The PLC with what is around it.
    pub session: session::Moment,
    /// Pending settings.
    pub pending: Peekable<Iter<'a, Setting>>,
    /// State of the page's control.
    pub control: Control,
}
