//! `rungc boards`: the boards that rungc has descriptions of.

use super::{Context, Failure, Outcome, Result, print_text, subject};
use crate::args::{BoardsArgs, Reporting};
use crate::output::{file, write_file};
use crate::report::Reporter;
use rungc_firmware::board::Board;
use rungc_firmware::boards;
use rungc_firmware::build::Tools;
use rungc_firmware::image::pins_project;
use std::fmt::Write;

/// Lists the boards, or shows one.
pub fn run(args: &BoardsArgs, cx: Context) -> Result {
    let because = |error: &dyn std::fmt::Display| Failure::Because(error.to_string());
    let Some(name) = &args.board else {
        let mut text = String::new();
        for known in &boards::ALL {
            let board = known.board().map_err(|error| because(&error))?;
            // Writing to a String does not fail.
            let _ = writeln!(text, "{:<18} {}", known.name, board.name);
        }
        print_text(&text)?;
        return Ok(Outcome::Success);
    };
    let board = boards::named_or_described(name).map_err(|error| {
        let reporting = Reporting::default();
        let mut reporter = Reporter::new(&reporting, cx, false);
        subject::refuse_board(error, &reporting, &mut reporter)
    })?;
    if args.toml {
        let text = match name.to_str().and_then(boards::find) {
            Some(known) => known.text.to_owned(),
            None => std::fs::read_to_string(name)?,
        };
        match file(&args.output) {
            Some(path) => write_file(path, text.as_bytes(), args.force)?,
            None => print_text(&text)?,
        }
        return Ok(Outcome::Success);
    }
    if let Some(output) = &args.output {
        let files = pins_project(&board).map_err(|error| because(&error))?;
        let built = Tools::new(board.target, &[]).c_program(&files, "pins.elf");
        let image = built.map_err(|error| because(&error))?;
        write_file(output, &image, args.force)?;
        cx.note(&format!(
            "     Emitted {} (pins of {})",
            output.display(),
            board.name
        ));
        return Ok(Outcome::Success);
    }
    print_text(&table(&board))?;
    Ok(Outcome::Success)
}

/// The pins of a board, uncertain ones marked.
fn table(board: &Board) -> String {
    let mut text = format!("{}\n", board.name);
    // Writing to a String does not fail.
    if !board.notes.is_empty() {
        let _ = writeln!(text, "\n{}", board.notes.trim());
    }
    let _ = writeln!(
        text,
        "\n{} bytes of flash, {} of RAM, {} MHz\n",
        board.flash.length,
        board.ram.length,
        f64::from(board.clock_hz) / 1e6
    );
    for pin in &board.pins {
        let mark = pin
            .uncertain
            .as_ref()
            .map(|why| format!("  uncertain: {why}"));
        let line = format!(
            "  {:<9} {:<5}{}",
            pin.terminal,
            pin.pin,
            mark.unwrap_or_default()
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}
