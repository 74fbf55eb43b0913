//! Functions that run between two scans: of two programs, what they do must be compared, too.

use super::{Encoder, Key};
use crate::aig::Lit;
use crate::bits::Bits;
use rungc_ir::node::FunctionKind;
use std::collections::BTreeMap;

/// Effect on memory of a function that a host calls between two scans.
#[derive(Clone)]
pub(crate) struct HostCall {
    /// Trigger of the function.
    pub kind: FunctionKind,
    /// Memory that it writes, as it is afterwards if it was as before a scan; `None`: not modelled.
    pub made: Option<BTreeMap<Key, Bits>>,
}

impl Encoder<'_> {
    /// Executes each of these functions with memory as it is before a scan.
    pub(super) fn run_between(&mut self) {
        let module = self.module;
        let functions = self.functions_of(FunctionKind::runs_between_scans);
        if functions.is_empty() {
            return;
        }
        let mut apart = self.clone();
        for function in functions {
            apart.state.clone_from(&self.before);
            apart.lost = Lit::FALSE;
            apart.function(function, Lit::TRUE);
            let made = apart
                .state
                .iter()
                .filter(|(key, bits)| self.before.get(key) != Some(bits));
            let made = made.map(|(&key, bits)| (key, bits.clone())).collect();
            self.between.push(HostCall {
                kind: module.functions[function].kind.clone(),
                made: (apart.lost == Lit::FALSE).then_some(made),
            });
        }
        // What they are made of is part of the graph; nothing else of them is part of a scan.
        self.aig = apart.aig;
        self.inputs = apart.inputs;
        self.gaps = apart.gaps;
        self.gap_numbers = apart.gap_numbers;
        self.shared = apart.shared;
    }

    /// Effects of these functions.
    pub(crate) fn between(&self) -> &[HostCall] {
        &self.between
    }

    /// Memory that functions write between two scans, or flags that they set.
    pub(crate) fn written_between_scans(&self) -> impl Iterator<Item = Key> {
        let flags = self.events.iter().map(|&flag| Key::Flag(flag));
        self.external.iter().copied().chain(flags)
    }
}
