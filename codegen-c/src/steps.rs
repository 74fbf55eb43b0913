//! Blocks of a step ladder that a scan leaves out while their states are off.

use crate::fields::PrintStorage;
use crate::page::Page;
use crate::writer::Writer;
use rungc_emit::plan::Node;
use rungc_ir::node::Steps;
use rungc_syntax::DeviceClass::S;

impl<'m> Writer<'_, 'm> {
    /// Writes blocks and their test.
    pub(crate) fn steps(&mut self, page: &mut Page, of: &Steps, body: &[Node<'m>]) {
        let mut state = String::new();
        self.fields.access(&mut state, S, of.first);
        let memories = of.memory.0..of.memory.0 + of.memories;
        let test = if of.states == 1 {
            let memories = memories.map(|memory| format!("plc->edge[{memory}]"));
            let tests: Vec<String> = [state].into_iter().chain(memories).collect();
            match self.boolean_conditions {
                true => format!("({}) != 0", tests.join(" | ")),
                false => tests.join(" | "),
            }
        } else {
            let (states, first, count) = (of.states, of.memory.0, of.memories);
            format!("plc_active(&{state}, {states}, &plc->edge[{first}], {count})")
        };
        page.open(&format!("if ({test}) {{"));
        self.nodes(page, body);
        page.close();
    }
}
