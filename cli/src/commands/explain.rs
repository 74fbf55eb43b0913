//! `rungc explain`.

use super::{Failure, Outcome, Result};
use crate::args::ExplainArgs;
use rungc_ir::catalogue;
use rungc_ir::catalogue::explain;
use rungc_syntax::{codes, diag};

/// Prints the page of a diagnostic code, an instruction or a special device.
pub fn run(args: &ExplainArgs) -> Result {
    let topic = args.topic.trim().to_uppercase();
    let page = codes::find(&topic)
        .map(codes::Code::page)
        .or_else(|| explain::instruction(&topic))
        .or_else(|| explain::special_device(&topic, args.model));
    let Some(page) = page else {
        let names = codes::all().map(|code| code.code).chain(catalogue::all().map(|inst| inst.name));
        let hint = diag::did_you_mean(&topic, names).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        return Err(Failure(format!("`{}` is no diagnostic code, instruction or special device{hint}", args.topic)));
    };
    println!("{}", page.trim_end());
    Ok(Outcome::Success)
}
