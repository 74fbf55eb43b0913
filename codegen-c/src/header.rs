//! The header of a program: its struct, field by field, and its functions.

use crate::fields::{self, PrintField};
use crate::unit::uses_runtime;
use crate::writer::c_type;
use crate::{events, text};
use rungc_emit::cycle;
use rungc_emit::plan::Plan;
use rungc_emit::private::{self, Private};
use rungc_emit::storage::{Field, Keep, Kind, Section, Storage};
use rungc_ir::Module;
use rungc_ir::node::Ty;
use rungc_rt::Axis;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Column of the comments beside fields.
const COMMENT_COLUMN: usize = 36;

/// For this many input edges, the header explains one by one how they get in.
const MOST_EDGES: usize = 4;

/// The prototype for programs that may ask for scans of constant length.
const CONSTANT_SCAN: &str = "\
/* Minimum scan time, from the start of a scan to that of the next one, in microseconds; 0: chosen by the host. A scan that takes
   longer is followed at once by the next. The next scan's `scan_us` includes the time in which it waited. */
uint32_t NAME_constant_scan_us(const NAME_plc *plc);
";

/// Error callback for hosts that enable it; it costs nothing otherwise.
const ON_ERROR: &str = "\
#ifdef PLC_ON_ERROR
    plc_on_error *on_error; /* called at each operation error; NULL: nothing is */
#endif
";

/// Heading of a section of the struct.
fn heading(section: Section) -> &'static str {
    match section {
        Section::Inputs => "Inputs: set them before each scan.",
        Section::General => "Devices that are cleared in STOP and at power-off.",
        Section::Mixed => "Devices of which some are kept over power-off.",
        Section::Latched => "Latched devices: kept over power-off.",
        Section::Special => "Special relays and registers.",
        Section::Records => "Special registers that are kept over power-off.",
    }
}

/// Writes struct and prototypes.
pub(crate) fn api(module: &Module, fields: &Storage, plan: &Plan, runtime: bool) -> String {
    let name = &module.name;
    let mut out = String::new();
    let mut size = Size::default();
    let _ = write!(
        out,
        "/* All devices that the program uses, by their names in the PLC (X and Y are numbered in octal). */\n\
         typedef struct {name}_plc {{\n"
    );
    devices(&mut out, &mut size, fields);
    private(&mut out, &mut size, module, plan);
    if module.may_fail() {
        out.push_str(ON_ERROR);
    }
    if runtime {
        out.push_str("    const rungc_hal *hal; /* hardware that instructions ask; NULL: nothing fitted */\n");
        size.add(4, 4);
    }
    let _ = writeln!(
        out,
        "}} {name}_plc; /* {} bytes on a 32-bit machine */\n",
        size.total()
    );
    prototypes(&mut out, name);
    if cycle::constant_scan(module, fields).is_some() {
        let _ = write!(out, "\n{}", CONSTANT_SCAN.replace("NAME", name));
    }
    if module.takes_events() {
        out.push_str(&events::prototypes(module));
    }
    if runtime {
        let _ = write!(
            out,
            "\n/* The struct as the runtime library sees it; with rungc_get_bit() and similar functions a host finds devices by number. */\n\
             rungc_map {name}_map({name}_plc *plc);\n"
        );
    }
    out
}

/// The fields of devices, by sections.
fn devices(out: &mut String, size: &mut Size, fields: &Storage) {
    let mut section = None;
    for field in fields.in_sections() {
        if section != Some(field.section) {
            if section.is_some() {
                out.push('\n');
            }
            let _ = writeln!(out, "    /* {} */", heading(field.section));
            section = Some(field.section);
        }
        let (bytes, align) = field.kind.size();
        size.add(bytes * field.room(), align);
        field_line(out, fields, field);
    }
    if section.is_some() {
        out.push('\n');
    }
}

/// Writes the private part of the struct.
fn private(out: &mut String, size: &mut Size, module: &Module, plan: &Plan) {
    out.push_str("    /* Private: time, and what the program remembers from scan to scan. */\n");
    for field in private::fields(module, plan) {
        private_field(out, size, field);
    }
}

fn private_field(out: &mut String, size: &mut Size, field: Private) {
    let (line, comment, bytes, align) = match field {
        Private::Sys => {
            out.push_str("    plc_sys sys;\n");
            return size.add(28, 4);
        }
        Private::Edges(count) => {
            let comment = "last states of edge contacts, pulses and steps";
            (format!("bool edge[{count}];"), comment, count, 1)
        }
        Private::Steps(count) => {
            let comment = "which blocks of step ladders run";
            (format!("plc_steps steps[{count}];"), comment, 16 * count, 4)
        }
        Private::Flag { flag, outside } => {
            let volatile = if outside { "volatile " } else { "" };
            (format!("{volatile}bool {};", flag.name), flag.meaning, 1, 1)
        }
        Private::PeriodStart(flag) => {
            let line = format!("volatile plc_stopwatch {}_since;", flag.name);
            (line, "time since this period began", 8, 4)
        }
        Private::Cell(cell) => {
            let volatile = if cell.follows_time { "volatile " } else { "" };
            (
                format!("{volatile}int32_t {};", cell.name),
                cell.meaning,
                4,
                4,
            )
        }
        Private::Table(table) => {
            let line = format!("int32_t {}[{}];", table.name, table.length);
            (line, table.meaning, 4 * table.length, 4)
        }
        Private::Error => ("plc_error error;".into(), "what has gone wrong", 8, 2),
        Private::StepsLeft => {
            let comment = "steps that this scan may still repeat";
            ("uint32_t steps_left;".into(), comment, 4, 4)
        }
        Private::Temp(temp, ty) => {
            let bytes = match ty {
                Ty::Bit => 1,
                Ty::I16 => 2,
                Ty::I32 | Ty::F32 => 4,
            };
            let line = format!("{} {temp};", c_type(ty));
            (line, "found in one function, used in another", bytes, bytes)
        }
        Private::Axes(outputs) => {
            let line = format!("rungc_axis axis[{}];", outputs.len());
            let bytes = size_of::<Axis>() * outputs.len();
            (line, "what the pulse outputs send", bytes as u32, 8)
        }
        Private::Port(number, protocols) => {
            let bytes = protocols.port_size();
            let line = format!("uint32_t com{number}[{}];", bytes / 4);
            (
                line,
                "a serial port, for the runtime alone",
                bytes as u32,
                4,
            )
        }
        Private::States(0) => return,
        Private::States(count) => {
            let _ = writeln!(
                out,
                "    rungc_state state[{count}]; /* of instructions that work over several scans */"
            );
            return size.add(32 * u32::from(count), 4);
        }
    };
    push_with_comment(out, &format!("    {line}"), comment);
    size.add(bytes, align);
}

/// Size of the struct as it grows.
#[derive(Default)]
struct Size {
    bytes: u32,
    align: u32,
}

impl Size {
    fn add(&mut self, bytes: u32, align: u32) {
        self.bytes = self
            .bytes
            .next_multiple_of(align.max(1))
            .saturating_add(bytes);
        self.align = self.align.max(align);
    }

    fn total(&self) -> u32 {
        self.bytes.next_multiple_of(self.align.max(1))
    }
}

fn field_line(out: &mut String, storage: &Storage, field: &Field) {
    let (class, first) = (field.class, field.first);
    let ty = fields::c_type(field.kind);
    let mut line = format!("    {ty} ");
    field.name(&mut line);
    if field.array {
        line.push_str(&field.extents());
    }
    line.push(';');
    let mut comment = String::new();
    if field.array {
        let _ = write!(
            comment,
            "{} to {}",
            class.number(first),
            class.number(field.end() - 1)
        );
        if field.kind == Kind::NumericBit {
            comment.push_str(", 0 or 1");
        }
        if let Some(grid) = field.columns() {
            let n = class.number(first + 1);
            let (columns, stored) = (grid.columns, grid.stored_columns);
            let _ = match stored {
                1 => write!(comment, ", {columns} apart"),
                _ if stored < columns => {
                    write!(
                        comment,
                        ", in {columns} columns, {stored} stored: [1][0] is {n}"
                    )
                }
                _ => write!(comment, ", in {columns} columns: [1][0] is {n}"),
            };
        }
        for run in storage
            .runs(field)
            .filter(|run| field.section == Section::Mixed && run.keep == Keep::Latched)
        {
            let (from, to) = (
                class.number(run.first),
                class.number(run.first + run.count - 1),
            );
            let _ = write!(comment, ", latched: {from} to {to}");
        }
    } else {
        if let Some(text) = storage.comment(class, first) {
            comment = text::comment(text);
        }
        // X10 stands for X010.
        if class.is_octal() && comment.is_empty() {
            comment = class.number(first).to_string();
        }
    }
    push_with_comment(out, &line, &comment);
    if field.array {
        for number in field.numbers() {
            if let Some(text) = storage.comment(class, number) {
                let comment = format!(
                    "  {} {}: {}",
                    field.subscript(number),
                    class.number(number),
                    text::comment(text)
                );
                push_with_comment(out, "", &comment);
            }
        }
    }
}

fn push_with_comment(out: &mut String, line: &str, comment: &str) {
    out.push_str(line);
    if !comment.is_empty() {
        let pad = COMMENT_COLUMN.saturating_sub(line.len()).max(1);
        out.extend(std::iter::repeat_n(' ', pad));
        let _ = write!(out, "/* {comment} */");
    }
    out.push('\n');
}

fn prototypes(out: &mut String, name: &str) {
    let _ = write!(
        out,
        "/* Before the first use: everything as at the very first power-on, in RUN. */\n\
         void {name}_init({name}_plc *plc);\n\n\
         /* One scan. `now_ms`: milliseconds by a clock that may begin anywhere and wraps; a reading that is up to a second before an earlier\n   \
         one has no effect. `scan_us`: how long the last scan took, for D8010 to D8012. */\n\
         void {name}_scan({name}_plc *plc, uint32_t now_ms, uint32_t scan_us);\n\n\
         /* State of output terminal Y `terminal` (a plain number: 8 is Y010) after a scan; off in STOP. */\n\
         bool {name}_output(const {name}_plc *plc, unsigned terminal);\n\n\
         /* The last operation error and what stopped the PLC, since RUN began. */\n\
         plc_error {name}_error(const {name}_plc *plc);\n\n\
         /* Returns true if the PLC is in RUN; the reason for STOP, other than the switch, is in `{name}_error`. */\n\
         bool {name}_running(const {name}_plc *plc);\n\n\
         /* The RUN/STOP switch. STOP clears what is not latched. */\n\
         void {name}_set_running({name}_plc *plc, bool running);\n\n\
         /* Power off and on: only latched devices keep their values; then RUN. */\n\
         void {name}_power_cycle({name}_plc *plc);\n"
    );
}

/// The comment at the top of the header: how to use it.
pub fn embedding(module: &Module, fields: &Storage) -> String {
    let name = &module.name;
    let input = first_name(fields, DeviceClass::X).unwrap_or_else(|| "X0".to_string());
    let output = fields
        .of_class(DeviceClass::Y)
        .first()
        .map_or(0, |f| f.first);
    let mut lines = vec![
        (format!("static {name}_plc plc;"), ""),
        (format!("{name}_init(&plc);"), ""),
        ("for (;;) {".to_string(), "every 1 to 10 ms, as you like"),
        (
            format!("    plc.{input} = read_pin(0);"),
            "copy the input terminals",
        ),
        (
            format!("    {name}_scan(&plc, millis(), scan_us);"),
            "one scan",
        ),
        (
            format!("    write_pin(0, {name}_output(&plc, {output}));"),
            "copy the output terminals",
        ),
        ("}".to_string(), ""),
    ];
    if uses_runtime(module) {
        lines.insert(
            2,
            (
                "plc.hal = &board;".to_string(),
                "hardware that instructions ask; may stay NULL",
            ),
        );
    }
    let edges = rungc_emit::events::inputs(module);
    let edge = match rungc_emit::events::edges_only_note(module) {
        true => "at each edge of this pin; an interrupt handler may",
        false => "at each edge of this pin, between scans",
    };
    match edges.len() {
        0..=MOST_EDGES => lines.extend(edges.iter().map(|number| {
            let code = format!("{name}_input_edge(&plc, {number}, on);");
            (code, edge)
        })),
        _ => lines.push((format!("{name}_input_edge(&plc, n, on);"), edge)),
    }
    if rungc_emit::events::follows_time(module) {
        lines.push((
            format!("{name}_tick(&plc, millis());"),
            match module.ticks_only_note() {
                true => "each millisecond; an interrupt handler may",
                false => "each millisecond, between scans",
            },
        ));
    }
    let column = lines.iter().map(|(code, _)| code.len()).max().unwrap_or(0) + 2;
    let mut out = String::from(" * How to embed it:\n *\n");
    for (code, text) in lines {
        let line = format!(" *     {code:column$}{text}");
        let _ = writeln!(out, "{}", line.trim_end());
    }
    if module.takes_events() {
        let _ = write!(
            out,
            " *\n * Or describe the board once (rungc_board.h): {name}_poll of {name}_board.h then does all this.\n"
        );
    }
    let _ = write!(
        out,
        " *\n * All functions belong to the main loop, unless their comment lets an interrupt handler call them.\n *\n * It needs sizeof({name}_plc) bytes of RAM and little stack; no heap, no recursion. To keep latched devices, save the\n \
         * struct at power-off; at power-on load it and call {name}_power_cycle instead of {name}_init.\n"
    );
    out
}

fn first_name(fields: &Storage, class: DeviceClass) -> Option<String> {
    let field = fields.of_class(class).first()?;
    let mut name = String::new();
    field.name(&mut name);
    if field.array {
        name.push_str("[0]");
    }
    Some(name)
}
