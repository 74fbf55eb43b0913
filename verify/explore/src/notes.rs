//! A copy of a program that notes in private flags which branches a scan takes, what the coils of an output say, and
//! which operation errors the program itself reports.

use rungc_ir::Module;
use rungc_ir::node::{
    AccessKind, Action, Body, Branch, Expr, ExprId, Flag, FlagId, FunctionKind, Place, Stmt,
};
use rungc_ir::walk::bodies_mut;
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// Flags of a coil.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Coil {
    /// On if the last scan has executed it.
    pub executed: FlagId,
    /// State of the coil at its last execution.
    pub on: FlagId,
}

/// Flags set by the copy of a program.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    /// A flag for each branch, on once it has been taken.
    pub branches: Vec<FlagId>,
    /// The outputs Y with several coils, in the program's order.
    pub coils: Vec<(u32, Vec<Coil>)>,
    /// A flag for each operation error that the program reports without the runtime, on once it has: code and step.
    pub faults: Vec<(FlagId, (u16, u32))>,
}

/// Makes the copy.
struct Noting {
    module: Module,
    on: ExprId,
    notes: Notes,
    /// By output: its coils so far.
    coils: BTreeMap<u32, Vec<Coil>>,
}

impl Notes {
    /// The copy, and what it notes. It does the same as the program.
    pub fn of(module: &Module) -> (Module, Notes) {
        let mut module = module.clone();
        let on = module.add(Expr::Bit(true));
        let off = module.add(Expr::Bit(false));
        let mut functions = std::mem::take(&mut module.functions);
        let mut noting = Noting {
            module,
            on,
            notes: Notes::default(),
            coils: BTreeMap::new(),
        };
        for function in &mut functions {
            let of_program = matches!(
                function.kind,
                FunctionKind::Main | FunctionKind::Subroutine(_)
            );
            noting.body(&mut function.body, of_program);
        }
        let Noting {
            mut module,
            mut notes,
            coils,
            ..
        } = noting;
        notes.coils = coils.into_iter().filter(|(_, c)| c.len() > 1).collect();
        let main = functions
            .iter_mut()
            .find(|function| function.kind == FunctionKind::Main);
        if let Some(main) = main {
            let coils = notes.coils.iter().flat_map(|(_, coils)| coils);
            let begin = coils.map(|coil| Stmt::Do(Action::SetFlag(coil.executed, off)));
            main.body.splice(0..0, begin.collect::<Vec<_>>());
        }
        module.functions = functions;
        (module, notes)
    }
}

impl Noting {
    fn flag(&mut self) -> FlagId {
        let name = format!("noted{}", self.module.flags.len());
        self.module.flags.push_and_get_key(Flag {
            name,
            meaning: "what a search notes",
            period_ms: None,
            pulses_end: None,
            retained: false,
        })
    }

    fn body(&mut self, body: &mut Body, of_program: bool) {
        let mut at = 0;
        while at < body.len() {
            for inner in bodies_mut(&mut body[at]) {
                self.body(inner, of_program);
            }
            if let Stmt::If(Branch {
                then, otherwise, ..
            }) = &mut body[at]
            {
                for branch in [then, otherwise] {
                    let flag = self.flag();
                    self.notes.branches.push(flag);
                    branch.insert(0, Stmt::Do(Action::SetFlag(flag, self.on)));
                }
            }
            if let Some((output, value)) = self.coil(&body[at]).filter(|_| of_program) {
                let (executed, on) = (self.flag(), self.flag());
                let coil = Coil { executed, on };
                self.coils.entry(output).or_default().push(coil);
                let notes = [
                    Stmt::Do(Action::SetFlag(executed, self.on)),
                    Stmt::Do(Action::SetFlag(on, value)),
                ];
                body.splice(at..at, notes);
                at += 2;
            }
            if let Stmt::Do(Action::Fault { code, step }) = body[at] {
                let flag = self.flag();
                self.notes.faults.push((flag, (code, step)));
                body.insert(at, Stmt::Do(Action::SetFlag(flag, self.on)));
                at += 1;
            }
            at += 1;
        }
    }

    /// The output and the value of a coil: OUT, but not SET and RST, which write constants.
    fn coil(&self, stmt: &Stmt) -> Option<(u32, ExprId)> {
        let &Stmt::Do(Action::Write(access, value)) = stmt else {
            return None;
        };
        let Place {
            class,
            number,
            index,
        } = access.place;
        let is_output = class == DeviceClass::Y && index.is_none();
        let is_coil = access.kind == AccessKind::Bit
            && !matches!(self.module.expr(value), Expr::Bit(_))
            && !self.module.pulse_outputs.contains(&number);
        (is_output && is_coil).then_some((number, value))
    }
}
