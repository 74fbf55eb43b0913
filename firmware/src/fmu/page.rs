//! The page of a functional mock-up unit: what it is, and its variables.

use super::{Fmu, SCAN_MS, SCAN_NAME};
use quick_xml::escape::escape;
use std::fmt::Write;

/// `documentation/index.html`.
pub(super) fn page(fmu: &Fmu) -> String {
    let module = fmu.module;
    let title = escape(&module.full_name);
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{title}</title></head>\n<body>\n<h1>{title}</h1>\n\
         <p>The PLC program {} for {}, compiled by rungc {}.</p>\n\
         <p>A scan begins every {SCAN_MS} ms of simulated time; the parameter <code>{SCAN_NAME}</code> changes that. A communication step runs \
         the scans that begin in it, with the inputs that it begins with; the time of the PLC is that of the simulation.</p>\n\
         <table>\n<tr><th>Variable</th><th>Device</th><th>Type</th><th>Causality</th><th>Description</th></tr>\n",
        escape(&module.source_name),
        escape(module.model.title),
        env!("CARGO_PKG_VERSION"),
    );
    for variable in fmu.variables() {
        let _ = writeln!(
            text,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
            escape(&variable.name),
            variable.device,
            variable.ty().name(),
            variable.causality.name(),
            escape(&variable.description)
        );
    }
    text.push_str("</table>\n</body>\n</html>\n");
    text
}
