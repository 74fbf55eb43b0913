//! Properties of programs: proofs, and counterexamples that the interpreter has replayed.
//!
//! A [`rungc_sim::property::Property`] is decided for a module: [`model`] makes logic of a scan, [`system`] cuts out
//! what the property depends on, [`search`] and [`pdr`] look for a run and for a proof by way of a SAT solver, and
//! [`replay`] runs what was found on the interpreter. This crate must not know commands. Start reading at
//! [`prove::decide`].

#![deny(missing_docs)]

pub mod aig;
pub mod aiger;
pub mod bits;
pub mod btor2;
pub mod certificate;
pub mod deep;
pub mod effort;
pub mod engines;
pub mod lag;
pub mod model;
pub mod pdr;
pub mod proof;
pub mod property;
pub mod prove;
mod random;
pub mod reduce;
pub mod replay;
pub mod request;
pub mod same;
pub mod sat;
pub mod search;
pub mod steered;
pub mod system;
pub mod unroll;
pub mod vacuous;
pub mod words;
pub mod written;

#[cfg(test)]
mod tests {
    use rungc_ir::Module;
    use rungc_ir::passes::simplify;
    use rungc_lower::compile::{CompileOptions, compile};
    use rungc_models::ModelId;
    use rungc_sim::property::{Condition, Property};
    use rungc_syntax::DeviceClass;

    /// A program as proofs take it.
    pub(crate) fn module(list: &str) -> Module {
        compiled(list, Vec::new())
    }

    /// The same with the devices that a property looks at.
    pub(crate) fn observing(list: &str, property: &Property) -> Module {
        let conditions = property.conditions().into_iter();
        compiled(list, conditions.flat_map(Condition::devices).collect())
    }

    fn compiled(list: &str, observe: Vec<(DeviceClass, u32)>) -> Module {
        compiled_for(None, list, observe).unwrap_or_else(|why| panic!("{list}: {why}"))
    }

    /// A program for a model, or the usual one; else why it does not compile.
    pub(crate) fn compiled_for(
        model: Option<ModelId>,
        list: &str,
        observe: Vec<(DeviceClass, u32)>,
    ) -> Result<Module, String> {
        let program = rungc_frontend::read_text("program.il", list).program;
        let options = CompileOptions {
            model,
            optimise: false,
            observe,
            ..CompileOptions::default()
        };
        let compiled = compile(&program, &options);
        let why = format!("{:?}", compiled.diagnostics);
        let mut module = compiled.module.ok_or(why)?;
        simplify(&mut module);
        Ok(module)
    }
}
