//! `rungc init`.

use super::{Context, Failure, Outcome, Result, check_name, parent_dir};
use crate::args::InitArgs;
use crate::output::write_new;
use rungc_models::ModelId;
use rungc_project::{FILE, template};
use std::fs;
use std::path::{Path, PathBuf};

/// Name of the file that assistants read first.
const AGENTS: &str = "AGENTS.md";

/// Writes a rungc.toml beside a program, or into a folder, and an AGENTS.md if there is none.
pub fn run(args: &InitArgs, cx: Context) -> Result {
    let (folder, program) = match &args.file {
        Some(file) if file.is_dir() && !rungc_frontend::is_project(file) => {
            (file.clone(), only_program(file)?)
        }
        Some(file) => (parent_dir(file).to_path_buf(), Some(file.clone())),
        None => (PathBuf::from("."), only_program(Path::new("."))?),
    };
    let mut model = None;
    if let Some(program) = &program {
        let read = rungc_frontend::read(program);
        let read = read.map_err(|error| Failure::Because(error.to_string()))?;
        model = read.program.cpu.as_deref().and_then(ModelId::from_cpu);
    }
    // From the folder on, in which a project of several files may lie as a whole.
    let name = program
        .as_deref()
        .map(|program| match program.strip_prefix(&folder) {
            Ok(inside) if inside.as_os_str().is_empty() => Path::new("."),
            Ok(inside) => inside,
            Err(_) => program.file_name().map_or(Path::new("."), Path::new),
        });
    name.map_or(Ok(()), |name| check_name(name, FILE))?;
    let path = |file: &str| match folder == Path::new(".") {
        true => PathBuf::from(file),
        false => folder.join(file),
    };
    let settings = template(name, model);
    let mut files = vec![(path(FILE), settings.as_bytes())];
    let agents = path(AGENTS);
    let is_new = fs::symlink_metadata(&agents).is_err();
    if is_new {
        files.push((agents.clone(), include_bytes!("init/AGENTS.md")));
    }
    write_new(&files)?;
    for (path, _) in &files {
        cx.note(&format!("       Wrote {}", path.display()));
    }
    if !is_new {
        cx.note(&format!("        Kept {}", agents.display()));
    }
    Ok(Outcome::Success)
}

/// The program in a folder, if there is one alone.
fn only_program(folder: &Path) -> std::result::Result<Option<PathBuf>, Failure> {
    let found = rungc_frontend::programs(folder, 1);
    let found = found.map_err(|error| Failure::Because(error.to_string()))?;
    Ok(match &found[..] {
        [only] => Some(only.clone()),
        _ => None,
    })
}
