//! A copy of a program that notes in private cells which branches a scan takes and what the coils of an output say.

use rungc_ir::Module;
use rungc_ir::node::{
    AccessKind, Body, Branch, Cell, CellId, Expr, ExprId, FunctionKind, Place, Stmt,
};
use rungc_ir::walk::bodies_mut;
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// What the cell of a coil holds in a scan that has not executed it; else 0 or 1.
pub const NOT_EXECUTED: i32 = 2;

/// What the copy of a program notes.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    /// A cell for each branch, 1 once it has been taken.
    pub branches: Vec<CellId>,
    /// The outputs Y with several coils, and a cell for what each coil says in a scan, in the program's order.
    pub coils: Vec<(u32, Vec<CellId>)>,
}

/// Makes the copy.
struct Noting {
    module: Module,
    one: ExprId,
    notes: Notes,
    /// By output: its coils so far.
    coils: BTreeMap<u32, Vec<CellId>>,
}

impl Notes {
    /// The copy, and what it notes. It does the same as the program.
    pub fn of(module: &Module) -> (Module, Notes) {
        let mut module = module.clone();
        let one = module.add(Expr::I32(1));
        let unexecuted = module.add(Expr::I32(NOT_EXECUTED));
        let mut functions = std::mem::take(&mut module.functions);
        let mut noting = Noting {
            module,
            one,
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
            let cells = notes.coils.iter().flat_map(|(_, cells)| cells);
            let begin = cells.map(|&cell| Stmt::SetCell(cell, unexecuted));
            main.body.splice(0..0, begin.collect::<Vec<_>>());
        }
        module.functions = functions;
        (module, notes)
    }
}

impl Noting {
    fn cell(&mut self) -> CellId {
        let name = format!("noted{}", self.module.cells.len());
        self.module.cells.push_and_get_key(Cell {
            name,
            meaning: "what a search notes",
            follows_time: false,
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
                    let cell = self.cell();
                    self.notes.branches.push(cell);
                    branch.insert(0, Stmt::SetCell(cell, self.one));
                }
            }
            if let Some((output, value)) = self.coil(&body[at]).filter(|_| of_program) {
                let cell = self.cell();
                self.coils.entry(output).or_default().push(cell);
                body.insert(at, Stmt::SetCell(cell, value));
                at += 1;
            }
            at += 1;
        }
    }

    /// The output and the value of a coil: OUT, but not SET and RST, which write constants.
    fn coil(&self, stmt: &Stmt) -> Option<(u32, ExprId)> {
        let &Stmt::Write(access, value) = stmt else {
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
