//! The editors' list export: a table of instructions with steps, statements and notes.

mod comments;
mod layout;
mod rows;

use crate::Read;
use crate::gx::cpu;
use crate::il;
use crate::listing::Listing;
use crate::text::{Joined, Lines, clean};
use csv::{StringRecord, WriterBuilder};
use layout::Layout;
use rows::Rows;
pub(crate) use rows::unspaced;
use rungc_syntax::{
    Diagnostics, Instr, Operand, OperandKind, Operands, Program, Remarks, SourceKind, Span, codes,
};

pub(crate) use comments::{comments, is_comments, is_cross_reference, not_comments};
pub(crate) use layout::{HEADERS, detect, table};

/// Label of the row above the list that names the CPU.
pub(crate) const INFORMATION: &str = "PLC Information:";

/// Reads a list export.
pub(crate) fn read(name: &str, text: &str, layout: Layout) -> Read {
    let mut reader = Reader::new(layout);
    let mut head = ExportHead::default();
    let text = &*unspaced(text);
    let rows = Rows::new(text, layout.delimiter, |line| layout.is_row(line));
    for (number, row) in rows.enumerate() {
        let record = &row.record;
        reader.listing.go_to_line(row.line);
        if number >= layout.above {
            reader.row(record);
        } else {
            head.push(record);
            let is_headings = layout.has_headings && number + 1 == layout.above;
            reader.head(record, number == 0, is_headings);
        }
        if row.is_unclosed {
            reader.unclosed();
        }
    }
    reader.end_note();
    reader.reject_other_family();
    reader.program.kind = SourceKind::Csv;
    reader.program.source = reader.listing.finish(name);
    head.statements = reader.statements;
    head.notes = reader.notes;
    reader.program.closing = reader.statement.take();
    Read {
        program: reader.program,
        diagnostics: reader.diagnostics,
        export_head: head.in_usual_order(layout).then_some(head),
        ..Read::default()
    }
}

/// The rows of a list export above its instructions, in the language of the editor that wrote it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportHead {
    pub(crate) rows: Vec<Vec<String>>,
    /// The rows of statements, in order.
    pub(crate) statements: Vec<StatementRow>,
    /// The cells of notes, in order.
    pub(crate) notes: Vec<NoteRow>,
}

/// The note in a row of an instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct NoteRow {
    /// Number of the instruction.
    pub instr: usize,
    /// Its row, from 0 at the mnemonic.
    pub row: usize,
    pub text: String,
}

/// A row of a statement, as the editor wrote it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct StatementRow {
    /// Number of the instruction below it.
    pub instr: usize,
    /// Its step number, often empty.
    pub step: String,
    /// Its column.
    pub column: usize,
    pub text: String,
}

impl ExportHead {
    fn push(&mut self, record: &StringRecord) {
        self.rows.push(record.iter().map(str::to_owned).collect());
    }

    /// Writes a CPU into the row that names it; without such a row, below the title.
    pub fn set_cpu(&mut self, cpu: &str) {
        let cpu = format!("FXCPU {cpu}");
        // The label alone shows the row, whatever it names.
        let names_cpu = |row: &Vec<String>| {
            let label = row.iter().map(String::as_str).take(1).chain(["?"]);
            let fields = row.iter().map(String::as_str);
            cpu::of_head(label).or(cpu::of_head(fields)).is_some()
        };
        let above = self.rows.len().saturating_sub(1);
        match self.rows.iter().take(above).position(names_cpu) {
            Some(at) => {
                self.rows[at].truncate(1);
                self.rows[at].push(cpu);
            }
            None => self
                .rows
                .insert(above.min(1), vec![INFORMATION.to_owned(), cpu]),
        }
    }

    /// Returns true if the columns below are those of [`HEADERS`], in the order in which the writer writes them.
    fn in_usual_order(&self, layout: Layout) -> bool {
        layout.has_headings && layout.columns.iter().copied().eq(0..HEADERS.len())
    }
}

struct Reader {
    layout: Layout,
    program: Program,
    diagnostics: Diagnostics,
    listing: Listing,
    /// Statements that wait for the instruction below them.
    statement: Lines,
    /// Note of the last instruction, from its rows so far.
    note: Joined<' '>,
    statements: Vec<StatementRow>,
    notes: Vec<NoteRow>,
    /// Row of the instruction at hand, from 0 at its mnemonic.
    row: usize,
    /// Instruction that further operands belong to.
    current: Current,
}

/// Instruction that the operands of a row belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Current {
    /// None yet.
    None,
    /// The last one of the program.
    Last,
    /// The last one, which is a label and takes none.
    Label,
    /// An unreadable instruction: its operands are skipped.
    Unread,
}

impl Reader {
    fn new(layout: Layout) -> Self {
        Reader {
            layout,
            program: Program::default(),
            diagnostics: Diagnostics::new(),
            listing: Listing::default(),
            statement: Lines::default(),
            note: Joined::default(),
            statements: Vec::new(),
            notes: Vec::new(),
            row: 0,
            current: Current::None,
        }
    }

    /// A row above the list: the title in the first one, the CPU type, or headings.
    fn head(&mut self, record: &StringRecord, first: bool, is_headings: bool) {
        let row = record.iter().collect::<Vec<_>>().join("  ");
        let span = self.listing.line(&row);
        if is_headings {
            return;
        }
        if let Some(cpu) = cpu::of_head(record) {
            let at = span.start + row.rfind(cpu).unwrap_or_default() as u32;
            self.program.cpu_span = Span::new(at, at + cpu.len() as u32);
            self.program.cpu = clean(cpu).map(Into::into);
        } else if first {
            self.program.title = record.get(0).and_then(clean).map(Into::into);
        }
    }

    /// Replaces all findings by one that names the CPU, if that is of another family.
    fn reject_other_family(&mut self) {
        let cpu = self.program.cpu.take_if(|cpu| cpu::is_other_family(cpu));
        if let Some(cpu) = cpu {
            self.diagnostics = Diagnostics::new();
            let rejection = cpu::rejection(self.program.cpu_span, "list", &cpu);
            self.diagnostics.push(rejection);
            self.program = Program {
                unread: vec![0],
                ..Program::default()
            };
        }
    }

    /// Reports a quote in the row of the current line that takes in the rows below.
    fn unclosed(&mut self) {
        self.diagnostics.push(
            codes::BAD_ROW
                .at(
                    self.listing.current_line(),
                    "a text of this row begins with a quote and takes in the next rows",
                )
                .label("the quote is not closed in this row")
                .help(rows::HELP),
        );
    }

    fn row(&mut self, record: &StringRecord) {
        let [
            step,
            line_statement,
            mnemonic,
            operand,
            _,
            pointer_statement,
            note,
        ] = self
            .layout
            .columns
            .map(|column| record.get(column).unwrap_or(""));
        let (step, name) = (step.trim(), mnemonic.trim());
        // Spaces belong to a text, unless they pad all cells of a table.
        let is_padded = name.len() < mnemonic.len();
        let (mnemonic, operand) = (name, if is_padded { operand.trim() } else { operand });
        let statements = [line_statement, pointer_statement]
            .into_iter()
            .filter_map(clean);
        for statement in statements.clone() {
            self.statement.push(&statement);
        }
        for (column, text) in [(1, line_statement), (5, pointer_statement)] {
            if clean(text).is_some() {
                self.statements.push(StatementRow {
                    instr: self.program.instrs.len(),
                    step: step.to_owned(),
                    column,
                    text: text.to_owned(),
                });
            }
        }
        if !mnemonic.is_empty() || !operand.trim().is_empty() {
            self.instruction_row(step, mnemonic, operand);
        } else if !step.is_empty()
            && il::number(step).is_none()
            && statements.clone().next().is_none()
            && clean(note).is_none()
        {
            self.stray(step);
        }
        if !mnemonic.is_empty() {
            self.row = 0;
        } else if !operand.trim().is_empty() || !note.trim().is_empty() {
            self.row += 1;
        }
        for statement in statements {
            self.listing.comment(&statement);
        }
        if let (Some(read), Current::Last | Current::Label) = (clean(note), self.current) {
            self.listing.comment(&read);
            self.note.push(&read);
            self.notes.push(NoteRow {
                instr: self.program.instrs.len() - 1,
                row: self.row,
                text: note.to_owned(),
            });
        }
    }

    fn instruction_row(&mut self, step: &str, mnemonic: &str, operand: &str) {
        let step = self.step(step);
        if !mnemonic.is_empty() {
            self.instruction(mnemonic, step);
        }
        match self.current {
            _ if operand.trim().is_empty() => {}
            Current::Last => self.operand(operand),
            Current::Unread => _ = self.listing.word(operand.trim()),
            Current::None => {
                self.misplaced(
                    operand.trim(),
                    "there is no instruction in or above this row",
                );
                self.unread();
            }
            Current::Label => self.misplaced(operand.trim(), "a label has no operands"),
        }
    }

    /// Reports a row that holds nothing but a text in the column of steps.
    fn stray(&mut self, text: &str) {
        let span = self.listing.word(text);
        self.diagnostics.push(
            codes::BAD_ROW
                .at(span, "this row has neither an instruction nor a statement")
                .label("the only text is in the column of steps")
                .help("separate its cells as in the other rows, or delete the row"),
        );
        self.unread();
    }

    fn misplaced(&mut self, operand: &str, why: &'static str) {
        let span = self.listing.word(operand);
        self.diagnostics.push(
            codes::BAD_ROW
                .at(
                    span,
                    format!("operand `{operand}` does not belong to an instruction"),
                )
                .label(why)
                .help("its instruction is missing: export the list again"),
        );
    }

    /// Writes the step number into the listing and reads it.
    fn step(&mut self, text: &str) -> Option<u32> {
        if text.is_empty() {
            self.listing.margin("");
            return None;
        }
        let step = il::number(text);
        let span = self.listing.margin(text);
        if step.is_none() {
            self.diagnostics.push(
                codes::BAD_ROW
                    .at(
                        span,
                        format!("`{}` is not a step number", self.listing.slice(span)),
                    )
                    .label("a step number is a decimal number")
                    .help("the step number column may be empty"),
            );
        }
        step
    }

    fn instruction(&mut self, text: &str, step: Option<u32>) {
        let span = self.listing.word(text);
        // People who edit a table write its operands into the same cell.
        let (mnemonic, mnemonic_span, operands) = match il::field::instruction(text, span.start) {
            Some(whole) => whole,
            None => {
                let written = self.listing.slice(span);
                let Some(mnemonic) =
                    il::field::mnemonic(written, span.start, &mut self.diagnostics)
                else {
                    self.unread();
                    return;
                };
                (mnemonic, span, Operands::new())
            }
        };
        self.current = if il::is_label(&mnemonic) {
            Current::Label
        } else {
            Current::Last
        };
        self.end_note();
        self.program.instrs.push(Instr {
            mnemonic,
            mnemonic_span,
            operands,
            span,
            step,
            remarks: Remarks::new(self.statement.take(), None),
        });
    }

    fn operand(&mut self, text: &str) {
        let Some(instr) = self.program.instrs.last_mut() else {
            return;
        };
        let characters = instr.mnemonic == "ASC" && instr.operands.is_empty();
        let text = if characters { text } else { text.trim() };
        // The field itself is read: a text in it may hold characters that the listing does not show.
        let span = self.listing.word(text);
        let several = il::field::operands(text, span.start).filter(|_| !characters);
        let operands = several.unwrap_or_else(|| {
            let read = il::field::operand(text, span.start, characters, &mut self.diagnostics);
            // A field that holds nothing but signs between operands.
            let unreadable = Operand {
                span,
                kind: OperandKind::Unreadable(None),
            };
            std::iter::once(read.unwrap_or(unreadable)).collect()
        });
        for operand in operands {
            instr.span = instr.span.to(operand.span);
            instr.operands.push(operand);
        }
    }

    /// Remembers that an instruction cannot be read; its further operands are passed over.
    fn unread(&mut self) {
        self.current = Current::Unread;
        self.program.unread.push(self.program.instrs.len() as u32);
    }

    /// Gives the last instruction its note.
    fn end_note(&mut self) {
        if let (Some(note), Some(instr)) = (self.note.take(), self.program.instrs.last_mut()) {
            instr.remarks_mut().note = Some(note);
        }
    }
}

/// Rows as the editors write them: UTF-16LE with BOM, tabs, every field quoted, CR LF.
pub(crate) fn encode(rows: &[Vec<String>]) -> Vec<u8> {
    let mut writer = WriterBuilder::new()
        .delimiter(b'\t')
        .quote_style(csv::QuoteStyle::Always)
        .terminator(csv::Terminator::CRLF)
        .flexible(true)
        .from_writer(Vec::new());
    for row in rows {
        writer
            .write_record(row)
            .expect("writing to memory does not fail");
    }
    let bytes = writer
        .into_inner()
        .expect("writing to memory does not fail");
    let text = String::from_utf8(bytes).expect("fields are UTF-8");
    std::iter::once(0xFEFF)
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect()
}
