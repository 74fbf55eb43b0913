//! Blocks of a step ladder that a scan leaves out while their states are off.

use crate::fields::PrintStorage;
use crate::page::Page;
use crate::writer::Writer;
use rungc_emit::comments;
use rungc_emit::plan::Node;
use rungc_emit::steps::{self, Case};
use rungc_ir::node::Steps;
use rungc_syntax::DeviceClass::S;

impl<'m> Writer<'_, 'm> {
    /// Writes blocks: as cases, or with their test.
    pub(crate) fn steps(&mut self, page: &mut Page, of: &Steps, body: &[Node<'m>]) {
        match steps::cases(self.module, self.plan, of, body) {
            Some(cases) => self.cases(page, of, &cases),
            None => self.tested(page, of, body),
        }
    }

    /// Writes blocks as the cases of a choice, in a loop over those that run.
    fn cases(&mut self, page: &mut Page, of: &Steps, cases: &[Case<'_, 'm>]) {
        let variable = self.loop_variable();
        let mut state = String::new();
        self.fields.access(&mut state, S, of.first);
        page.open(&format!(
            "for (unsigned {variable} = 0; plc_next_step(&{variable}, &{state}, &plc->edge[{}], {}u); {variable}++) {{",
            of.memory.0, of.states
        ));
        page.open(&format!("switch ({variable}) {{"));
        page.back();
        self.loops += 1;
        for ((n, case), state) in (0..).zip(cases).zip(of.first..) {
            let beside = comments::device(self.fields, S, state);
            page.open_beside(&format!("case {n}: {{"), &beside);
            if let Some(network) = case.network {
                self.network(page, network);
            }
            if let Some(on) = case.on {
                self.stmt(page, on);
            }
            self.nodes(page, case.rest);
            page.line("break;");
            page.close();
        }
        self.loops -= 1;
        page.line("default:");
        page.inner("break;");
        page.line("}");
        page.close();
    }

    /// Writes blocks and their test.
    fn tested(&mut self, page: &mut Page, of: &Steps, body: &[Node<'m>]) {
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
