//! `rungc explain`.

use super::{Context, Failure, Outcome, Result, book, print_text};
use crate::args::ExplainArgs;
use rungc::Language;
use rungc_functions::library;

/// Prints the page of a diagnostic code, an error code of the PLC, an instruction, a special device, a model or a
/// variant of one.
pub fn run(args: &ExplainArgs, cx: Context) -> Result {
    let language = cx.language.language();
    let of_book = || book::page(&args.topic).map(|page| page.text.to_string());
    let Some(page) = page(args, language).or_else(of_book) else {
        let pages = book::PAGES.iter().map(|page| page.name);
        let functions = library::all().map(|function| function.name);
        let others: Vec<&str> = pages.chain(functions).collect();
        let topic = args.topic.trim();
        let why = rungc::explain::unknown(topic, args.model, &others);
        return Err(Failure::Because(why));
    };
    print_text(&format!("{}\n", page.trim_end()))?;
    Ok(Outcome::Success)
}

/// What is known of a topic, but for the pages of the book.
pub fn page(args: &ExplainArgs, language: Language) -> Option<String> {
    let of_function = || rungc_functions::page::of(&args.topic.trim().to_lowercase());
    rungc::explain::page(&args.topic, args.model, language).or_else(of_function)
}
