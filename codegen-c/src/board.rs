//! The wiring between a program and a board: `NAME_board.h` and `NAME_board.c`, beside programs that take events and on
//! request.

use crate::host::terminals;
use crate::template;
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Handling of the board's events in a poll.
const TAKE_EVENTS: &str = "    const bool edges = take_edges(plc, board);
    const bool counts = take_counts(plc, board);
";

/// The additional functions of a program with pulses.
const ON_TIMER: &str = "
void PROGRAM_on_timer(PROGRAM_plc *plc, rungc_board *board)
{
    const uint32_t wait = PROGRAM_pulse_timer(plc, board->now_us(board->hal.context));

    if (board->wake_in != NULL) {
        board->wake_in(board->hal.context, wait);
    }
}
";

/// Update of the pulse outputs at the end of a poll.
const DRIVE_PULSES: &str = "        rungc_board_hold(board, true);
        PROGRAM_on_timer(plc, board);
        rungc_board_hold(board, false);
";

/// `NAME_board.h`.
pub fn header(module: &Module) -> String {
    let guard = format!("{}_BOARD_H", module.name.to_ascii_uppercase());
    let mut text = format!(
        "#ifndef {guard}\n#define {guard}\n\n#include \"PROGRAM.h\"\n#include \"rungc_board.h\"\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n\
         /* Does what is to be done by now: edges and counts, milliseconds, interrupts, a scan if its time has come, pins. Call it in the main\n   \
         loop alone, behind PROGRAM_init, as often as can be and at least once in half an hour: an edge is as late as this is. */\n\
         void PROGRAM_poll(PROGRAM_plc *plc, rungc_board *board);\n"
    );
    if module.sends_pulses() {
        text.push_str(
            "\n/* Drives the pins of pulse outputs whose time has come, and arms the timer for the next ones: in the timer's interrupt, which\n   \
             `hold_pulses` keeps from coming. It calls `now_us`, `set_output` and `wake_in` of the board. */\n\
             void PROGRAM_on_timer(PROGRAM_plc *plc, rungc_board *board);\n",
        );
    }
    text.push_str("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n");
    text.replace("PROGRAM", &module.name)
}

/// `NAME_board.c`.
pub fn source(module: &Module, runtime: bool) -> String {
    let fields = Storage::new(module);
    let mut cases = String::new();
    let mut inputs = String::new();
    for (number, access) in terminals(&fields, DeviceClass::X) {
        let _ = write!(inputs, "{number}, ");
        let _ = write!(
            cases,
            "    case {number}:\n        {access} = on;\n        break;\n"
        );
    }
    let mut outputs = String::new();
    for (number, _) in terminals(&fields, DeviceClass::Y) {
        if !module.pulse_outputs.contains(&number) {
            let _ = write!(outputs, "{number}, ");
        }
    }
    let hal = if runtime {
        "        plc->hal = &board->hal;\n"
    } else {
        ""
    };
    let passes = if module.takes_time() {
        "if (rungc_board_passes(board, now_us)) {\n        PROGRAM_tick(plc, board->now_ms);\n    }"
    } else {
        "(void)rungc_board_passes(board, now_us);"
    };
    let interrupts = rungc_emit::events::interrupts(module).is_some();
    let interrupt = |indent: &str| match interrupts {
        true => format!("{indent}PROGRAM_take_interrupts(plc);\n"),
        false => String::new(),
    };
    let (events, take, changes) = match module.takes_events() {
        true => (
            template!("board_events.c"),
            TAKE_EVENTS,
            "scans || edges || counts",
        ),
        false => ("", "", "scans"),
    };
    let constant = match rungc_emit::cycle::constant_scan(module, &fields) {
        Some(_) => "    rungc_board_waits(board, PROGRAM_constant_scan_us(plc));\n",
        None => "",
    };
    let mut text = template!("board.c")
        .replace("/* CONSTANT */", constant)
        .replace("/* EVENTS */\n", events)
        .replace("/* TAKE */\n", take)
        .replace("/* CHANGES */", changes)
        .replace("/* INPUTS */", &inputs)
        .replace("/* OUTPUTS */", &outputs)
        .replace("/* CASES */", &cases)
        .replace("/* HAL */", hal)
        .replace("/* PASSES */", passes)
        .replace("/* EDGE */", &interrupt("        "))
        .replace("/* INTERRUPTS */", &interrupt("    "))
        .replace("/* PULSES */", &pulses(module, interrupts));
    if module.sends_pulses() {
        text.push_str(ON_TIMER);
    }
    text.replace("PROGRAM", &module.name)
}

/// Update of the pulse outputs at the end of a poll. A train begins in a scan or in an interrupt routine; with no timer
/// each poll looks after it.
fn pulses(module: &Module, interrupts: bool) -> String {
    match (module.sends_pulses(), interrupts) {
        (false, _) => String::new(),
        (true, false) => {
            format!("    if (scans || board->wake_in == NULL) {{\n{DRIVE_PULSES}    }}\n")
        }
        (true, true) => DRIVE_PULSES.replace("        ", "    "),
    }
}
