//! Blocks of a step ladder that a scan leaves out while their states are off.

use crate::code::Code;
use crate::fields::PrintStorage;
use crate::page::Page;
use crate::writer::Writer;
use rungc_emit::comments;
use rungc_emit::plan::Node;
use rungc_emit::steps::{self, Case, Ladder, Move};
use rungc_emit::temps::ON;
use rungc_ir::node::{EdgeId, Steps};
use rungc_syntax::DeviceClass::S;

impl<'m> Writer<'_, 'm> {
    /// Writes blocks: as cases, or with their test.
    pub(crate) fn steps(&mut self, page: &mut Page, of: &Steps, body: &[Node<'m>]) {
        let plan = self.plan;
        let ladder = plan.ladders.find(of);
        let cases = ladder.and_then(|_| steps::cases(self.module, plan, of, body));
        match ladder.zip(cases) {
            Some(((number, ladder), cases)) => self.cases(page, number, ladder, &cases),
            None if steps::are_tested_within(of) => self.nodes(page, body),
            None => self.tested(page, of, body),
        }
    }

    /// Writes blocks as the cases of a choice, in a loop over those that run.
    fn cases(&mut self, page: &mut Page, number: usize, ladder: &Ladder, cases: &[Case<'_, 'm>]) {
        let (steps, first) = (format!("&plc->steps[{number}]"), ladder.first);
        let states = self.state(first);
        let begin = match ladder.in_turn {
            true => "plc_begin_in_turn",
            false => "plc_begin_steps",
        };
        page.open(&format!(
            "for (uint32_t run = {begin}({steps}, &{states}, {}u); run != 0u; run &= run - 1u) {{",
            ladder.states
        ));
        if ladder.in_turn {
            page.line(&format!("plc_drop_step({steps}, &{states}, run);"));
        }
        page.line("const unsigned step = plc_first_step(run);");
        if cases.iter().any(|case| case.on.is_some()) {
            let state = match states.strip_suffix("[0]") {
                Some(array) => format!("{array}[step]"),
                None => states.replace(']', "u + step]"),
            };
            page.line(&format!("const bool {ON} = {state};"));
        }
        page.open("switch (step) {");
        page.back();
        self.loops += 1;
        for case in cases {
            let beside = comments::device(self.fields, S, case.state);
            page.open_beside(&format!("case {}: {{", case.state - first), &beside);
            if let Some(network) = case.network {
                self.network(page, network);
            }
            self.block = Some((number, case.state));
            self.nodes(page, case.rest);
            page.line("break;");
            page.close();
        }
        self.block = None;
        self.loops -= 1;
        page.line("default:");
        page.inner("break;");
        page.line("}");
        page.close();
    }

    fn state(&self, number: u32) -> String {
        let mut state = String::new();
        self.fields.access(&mut state, S, number);
        state
    }

    /// Writes a change of the bits of a ladder.
    pub(crate) fn step_move(&mut self, page: &mut Page, change: Move) {
        let mut code = Code::new();
        let later = change.is_later(self.block);
        let (function, number, entered) = match change {
            Move::Enter(number, state) if later => ("run = plc_enter_later", number, Some(state)),
            Move::Enter(number, state) => ("plc_enter_step", number, Some(state)),
            Move::Transfer(number, state) if later => {
                ("run = plc_transfer_later", number, Some(state))
            }
            Move::Transfer(number, state) => ("plc_transfer", number, Some(state)),
            Move::Leave(number) => ("plc_leave_step", number, None),
        };
        code.open(&format!("{function}(&plc->steps[{number}]"));
        let ladder = self.plan.ladders.get(number);
        let entered_at = ladder.zip(entered);
        if let Some((ladder, _)) = entered_at {
            code.argument(format_args!("&{}", self.state(ladder.first)));
        }
        if later || !matches!(change, Move::Enter(..)) {
            code.argument("run");
        }
        if let Some((ladder, state)) = entered_at {
            code.argument(format_args!("{}u", state - ladder.first));
        }
        code.close(");");
        let beside = entered.map(|state| comments::device(self.fields, S, state));
        page.commented(&code, beside.as_deref());
    }

    /// Writes blocks and their test.
    fn tested(&mut self, page: &mut Page, of: &Steps, body: &[Node<'m>]) {
        let state = self.state(of.first);
        let ladders = &self.plan.ladders;
        let memories = of.memory.0..of.memory.0 + of.memories;
        let memories = memories.map(|memory| ladders.edge(EdgeId(memory)));
        let test = if of.states == 1 {
            let memories = memories.map(|memory| format!("plc->edge[{memory}]"));
            let tests: Vec<String> = [state].into_iter().chain(memories).collect();
            match self.boolean_conditions {
                true => format!("({}) != 0", tests.join(" | ")),
                false => tests.join(" | "),
            }
        } else {
            let (states, first, count) = (of.states, ladders.edge(of.memory), of.memories);
            format!("plc_active(&{state}, {states}, &plc->edge[{first}], {count})")
        };
        page.open(&format!("if ({test}) {{"));
        self.nodes(page, body);
        page.close();
    }
}
