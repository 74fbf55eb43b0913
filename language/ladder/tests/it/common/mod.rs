//! Common parts of the ladder tests.

use rungc_analysis::resolve::resolve;
use rungc_models::{Model, ModelId};
use rungc_syntax::Program;
use std::path::{Path, PathBuf};

/// The PLC that a program is for, as far as its instructions show: FX3U, unless another one knows more of them.
pub fn model(program: &Program) -> &'static Model {
    let unknown = |model| {
        let (resolved, _) = resolve(program, model);
        let instrs = resolved.instrs.iter();
        instrs.filter(|instr| instr.inst.is_none()).count()
    };
    let usual = Model::get(ModelId::Fx3u);
    if unknown(usual) == 0 {
        return usual;
    }
    let models = ModelId::ALL.into_iter().map(Model::get);
    let all = std::iter::once(usual).chain(models);
    all.min_by_key(|model| unknown(model)).unwrap_or(usual)
}

/// Adds the programs in a folder and below, in the order of their names.
pub fn programs_in(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut entries: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    entries.sort();
    for path in entries {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or("").to_lowercase();
        if path.is_dir() {
            programs_in(&path, found);
        } else if ["il", "csv", "gxw", "wpg", "bin"].contains(&ending.as_str()) {
            found.push(path);
        }
    }
}
