//! A program as a list with networks drawn in characters, which reads back to the same program.

use rungc_analysis::resolve::resolve;
use rungc_frontend::{print, read_bytes};
use rungc_ladder::build;
use rungc_ladder::text::{Style, draw_alike};
use rungc_models::Model;
use rungc_syntax::{Instr, Program};

/// Characters on a line.
const WIDTH: usize = 100;

/// The program as drawn ladder. A network whose drawing does not say all that its list says, such as blocks that ANB
/// joins without need, stays a list.
pub fn to_ladder(program: &Program, model: &'static Model) -> String {
    let (resolved, _) = resolve(program, model);
    let ladder = build::ladder(&resolved);
    let style = Style {
        width: WIDTH,
        comments: false,
    };
    let mut out = print::properties(program);
    for network in &ladder.networks {
        let instrs = &program.instrs[network.instrs.clone()];
        let drawn = draw_alike(&[(&resolved, network)], style).concat();
        if !out.is_empty() {
            out.push('\n');
        }
        match reads_back(&drawn, instrs) {
            true => out.push_str(&drawn),
            false => out.push_str(&list(instrs)),
        }
    }
    out + &print::closing(program)
}

fn reads_back(drawn: &str, instrs: &[Instr]) -> bool {
    let Ok(read) = read_bytes("ladder", drawn.as_bytes()) else {
        return false;
    };
    let same = |a: &Instr, b: &Instr| {
        let operands = |instr: &Instr| -> Vec<_> {
            let operands = instr.operands.iter();
            operands.map(|operand| operand.kind.clone()).collect()
        };
        a.mnemonic == b.mnemonic
            && operands(a) == operands(b)
            && a.statement() == b.statement()
            && a.note() == b.note()
    };
    let read = &read.program.instrs;
    read.len() == instrs.len() && read.iter().zip(instrs).all(|(a, b)| same(a, b))
}

/// Instructions as lines of a list, without steps.
fn list(instrs: &[Instr]) -> String {
    let plain = instrs.iter().map(|instr| Instr {
        step: None,
        ..instr.clone()
    });
    print::to_il(&Program {
        instrs: plain.collect(),
        ..Program::default()
    })
}
