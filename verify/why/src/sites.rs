//! Places of statements in a module: the branches around each, and the instruction that it belongs to.

use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_ir::Module;
use rungc_ir::node::{Body, FunctionKind, Stmt};
use rungc_lower::marks::{Mark, Marks};
use rungc_syntax::{Device, OperandKind};
use rustc_hash::FxHashMap;

/// Identity of a statement of a module that is not moved.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Address(usize);

impl Address {
    pub(crate) fn of(stmt: &Stmt) -> Self {
        Address(std::ptr::from_ref(stmt) as usize)
    }
}

/// Place of a statement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    /// Number of the function.
    pub(crate) function: usize,
    /// The innermost branch that it is in, and which side of it.
    pub(crate) branch: Option<(Address, bool)>,
    /// Instruction that it belongs to; `None` for the scan itself.
    pub(crate) instr: Option<usize>,
}

/// The places of all statements of a module.
#[derive(Default)]
pub(crate) struct Sites {
    sites: FxHashMap<Address, Site>,
    /// The relay of each MC that has one, by instruction.
    masters: FxHashMap<usize, Device>,
}

impl Sites {
    pub(crate) fn of(module: &Module, marks: &Marks, resolved: &Resolved) -> Self {
        let mut sites = Sites::default();
        for (number, function) in module.functions.iter().enumerate() {
            let is_program = matches!(
                function.kind,
                FunctionKind::Main | FunctionKind::Subroutine(_) | FunctionKind::Interrupt(_)
            );
            let mut walk = Walk {
                sites: &mut sites.sites,
                marks: is_program.then_some(marks),
                site: Site {
                    function: number,
                    branch: None,
                    instr: None,
                },
            };
            walk.body(&function.body);
        }
        for (i, resolution) in resolved.instrs.iter().enumerate() {
            let relay = resolved.program.instrs[i].operands.get(1);
            if resolution.basic() == Some(Basic::Mc)
                && let Some(OperandKind::Device(device, None)) = relay.map(|relay| &relay.kind)
            {
                sites.masters.insert(i, *device);
            }
        }
        sites
    }

    pub(crate) fn get(&self, address: Address) -> Option<Site> {
        self.sites.get(&address).copied()
    }

    /// The relays of all MCs.
    pub(crate) fn masters(&self) -> impl Iterator<Item = Device> {
        self.masters.values().copied()
    }

    /// The relay of an MC.
    pub(crate) fn master(&self, instr: Option<usize>) -> Option<Device> {
        self.masters.get(&instr?).copied()
    }
}

struct Walk<'a> {
    sites: &'a mut FxHashMap<Address, Site>,
    /// None where statements belong to no instruction.
    marks: Option<&'a Marks>,
    site: Site,
}

impl Walk<'_> {
    fn body(&mut self, body: &Body) {
        body.iter().for_each(|stmt| self.stmt(stmt));
    }

    fn stmt(&mut self, stmt: &Stmt) {
        if let (Stmt::Network(number), Some(marks)) = (stmt, self.marks) {
            match marks.places.get(*number as usize) {
                Some(&(Mark::Network(instr) | Mark::Output { instr, .. })) => {
                    self.site.instr = Some(instr as usize);
                }
                None => {}
            }
        }
        let address = Address::of(stmt);
        self.sites.insert(address, self.site);
        match stmt {
            Stmt::If(branch) => {
                let outer = self.site.branch;
                self.site.branch = Some((address, true));
                self.body(&branch.then);
                self.site.branch = Some((address, false));
                self.body(&branch.otherwise);
                self.site.branch = outer;
            }
            other => {
                for body in rungc_ir::walk::bodies(other) {
                    self.body(body);
                }
            }
        }
    }
}
