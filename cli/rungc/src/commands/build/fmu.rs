//! Functional mock-up units.

use super::{Built, Emit, Job, because, write_file};
use crate::commands::Failure;
use crate::output::{Kind, permit};
use crate::progress;
use rungc_firmware::fmu::{self, Binary, Fmu};
use rungc_syntax::DeviceRun;
use std::path::PathBuf;

impl Job<'_> {
    /// Writes the program as a functional mock-up unit; returns where.
    pub(super) fn fmu(&self) -> Built<PathBuf> {
        let path = self.output(Emit::Fmu);
        let name = &self.module.name;
        if let Some(why) = fmu::refusal(self.module) {
            return Err(Failure::Because(format!(
                "--emit fmu: {name} {why}, which a functional mock-up unit does not have (`rungc book fmu`)"
            )));
        }
        permit(&path, Kind::Fmu, self.plan.force)?;
        let panels = |runs: fn(&rungc_project::Project) -> &[rungc_project::Range]| {
            let runs = self.project.map_or(&[][..], runs).iter();
            runs.map(rungc_project::Range::run)
                .collect::<Vec<DeviceRun>>()
        };
        let written = panels(|project| &project.hmi);
        let read = panels(|project| &project.hmi_reads);
        let variables = rungc::fmu::variables(self.program, self.module, &written, &read);
        let unit = Fmu::new(self.module, variables);
        let archive = unit.archive(self.shared_library(&unit)?);
        write_file(&path, &archive.map_err(because)?, self.plan.force)?;
        Ok(path)
    }

    /// The shared library, unless only sources are wanted.
    fn shared_library(&self, unit: &Fmu) -> Built<Option<Binary>> {
        let name = &self.module.name;
        if self.plan.sources_only {
            if unit.needs_library() {
                let why = super::library::reasons(self.module).unwrap_or_default();
                return Err(Failure::Because(format!(
                    "--sources-only: {name} links the runtime library, whose sources importers cannot build, because of {why}"
                )));
            }
            return Ok(None);
        }
        let target = self.target();
        let place = fmu::binary_path(target, name).ok_or_else(|| {
            Failure::Because(format!(
                "--emit fmu: {}, {}, has no shared libraries that FMI knows; use --sources-only",
                target.triple, target.title
            ))
        })?;
        let built = progress::spin("building", || self.tools().c_shared(unit.sources()));
        let contents = built.map_err(|error| {
            Failure::Because(format!(
                "{error}\n(or --sources-only, for an FMU that importers build)"
            ))
        })?;
        Ok(Some(Binary {
            path: place,
            contents,
        }))
    }
}
