//! Another device in place of one: all edits, or the reason why the program would not be the same.

use super::{Index, Occurrence, named};
use rungc_analysis::latches;
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::Reach;
use rungc_models::runs::{is_counter32, is_special};
use rungc_project::device;
use rungc_syntax::diag::{self, Fix};
use rungc_syntax::{Device, DeviceClass, Diagnostic, OperandKind, Severity, Span};

/// The edits that rename a device.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Renaming {
    /// Places and their new texts, none of which overlap.
    pub edits: Vec<(Span, String)>,
    /// Differences between the two devices that a user has to know of.
    pub notes: Vec<String>,
}

/// Devices from the first on, as far as instructions use them together.
#[derive(Clone, Copy)]
struct Block {
    first: Device,
    count: u32,
}

impl Block {
    fn end(self) -> u32 {
        self.first.number.saturating_add(self.count)
    }

    fn has(self, device: Device) -> bool {
        device.class == self.first.class && (self.first.number..self.end()).contains(&device.number)
    }

    fn devices(self) -> impl Iterator<Item = Device> {
        let class = self.first.class;
        (self.first.number..self.end()).map(move |number| Device { class, number })
    }
}

impl Index {
    /// The device at a byte of the text, and its place.
    ///
    /// # Errors
    /// Reason why there is none that can be renamed.
    pub fn renamable(&self, offset: u32) -> Result<(Span, Device), String> {
        self.is_list()?;
        let place = self.at(offset);
        let found = place.and_then(|place| Some((place, self.device(place.what)?)));
        let (place, device) = found.ok_or_else(|| "there is no device here".to_owned())?;
        self.may_have_another(device)?;
        Ok((place.span, device))
    }

    fn is_list(&self) -> Result<(), String> {
        match self.program().kind.is_list() {
            true => Ok(()),
            false => Err("only in instruction lists can devices be renamed".to_owned()),
        }
    }

    /// Returns an error for a device in whose place another one cannot be put.
    fn may_have_another(&self, device: Device) -> Result<(), String> {
        self.is_list()?;
        if is_special(device.class, device.number) {
            return Err(format!("`{device}` is a special device"));
        }
        match device.class {
            DeviceClass::I => Err(format!("the number of `{device}` selects its interrupt")),
            DeviceClass::N => Err(format!("`{device}` is a nesting level")),
            DeviceClass::V | DeviceClass::Z => Err(format!(
                "`{device}` is an index register, part of other operands"
            )),
            _ => self.is_written(device),
        }
    }

    /// Returns an error for a pointer that the text calls by a name.
    fn is_written(&self, device: Device) -> Result<(), String> {
        let source = &self.program().source;
        let by_name = |one: &&Occurrence| !source.slice(one.span).contains(char::is_numeric);
        match self.occurrences(device).iter().find(by_name) {
            None => Ok(()),
            Some(one) => {
                let name = source.slice(one.span);
                Err(format!(
                    "`{device}` is called `{name}` in a list of windows: rename it there"
                ))
            }
        }
    }

    /// Edits that put another device in the place of one, in all instructions and in its comment.
    ///
    /// # Errors
    /// Reason why the program would not be the same afterwards.
    pub fn rename(&self, device: Device, new: &str) -> Result<Renaming, String> {
        let upper = new.trim().to_uppercase();
        let target = device::device(&upper).ok_or_else(|| match device::mistake(&upper) {
            Some(why) => format!("`{new}`: {why}"),
            None => format!("`{new}` is not a device"),
        })?;
        self.may_have_another(device)?;
        let old = self.block(device)?;
        let block = Block {
            first: target,
            count: old.count,
        };
        self.fits(old, block)?;
        self.is_free(block)?;
        self.is_out_of_reach(old)?;
        self.is_out_of_reach(block)?;
        let edits = self.edits(old, target);
        self.is_accepted(&edits, target)?;
        Ok(Renaming {
            notes: self.notes(device, target),
            edits,
        })
    }

    /// The devices that a program uses together with one: nothing may use a part of them.
    fn block(&self, first: Device) -> Result<Block, String> {
        let mut count = 1;
        for one in self.occurrences(first) {
            let used = one.count.ok_or_else(|| {
                format!(
                    "{} uses devices that are known only when it runs",
                    self.at_line(&one)
                )
            })?;
            if one.first != first {
                return Err(format!(
                    "{} uses `{first}` as a part of other devices",
                    self.at_line(&one)
                ));
            }
            count = count.max(used);
        }
        let block = Block { first, count };
        if let Some(device) = block
            .devices()
            .find(|device| self.is_named_by_settings(*device))
        {
            return Err(format!("rungc.toml names `{device}`"));
        }
        for device in block.devices().skip(1) {
            let others = self.occurrences(device);
            let part = others
                .iter()
                .find(|one| one.kind.is_some() && one.first != first);
            if let Some(part) = part {
                let last = block.devices().last().unwrap_or(first);
                let line = self.at_line(part);
                return Err(format!(
                    "`{first}` to `{last}` are used together, but {line} uses `{device}`"
                ));
            }
        }
        for i in self.occurrences(first).iter().filter_map(|one| one.instr) {
            if self.is_added(i) {
                return Err(format!("rungc.toml names `{first}`"));
            }
            let instr = &self.program().instrs[i];
            let mut operands = instr
                .operands
                .iter()
                .filter_map(|operand| named(&operand.kind));
            if operands.any(|device| device != first && block.has(device)) {
                return Err(format!("`{instr}` names a range of devices"));
            }
        }
        Ok(block)
    }

    /// `line 4 (`MOV D0Z1 D5`)`
    fn at_line(&self, one: &Occurrence) -> String {
        let program = self.program();
        let line = program.source.line(one.span.start);
        match one.instr.and_then(|i| program.instrs.get(i)) {
            Some(instr) => format!("line {line} (`{instr}`)"),
            None => format!("line {line}"),
        }
    }

    /// Returns an error for devices that do not work as the old ones do.
    fn fits(&self, old: Block, new: Block) -> Result<(), String> {
        use DeviceClass::{D, M, R, S, X, Y};
        let (from, to) = (old.first, new.first);
        let are_bits = |class| matches!(class, X | Y | M | S);
        let are_words = |class| matches!(class, D | R);
        let alike = from.class == to.class
            || are_bits(from.class) && are_bits(to.class)
            || are_words(from.class) && are_words(to.class);
        if !alike {
            return Err(format!("`{to}` is another kind of device than `{from}`"));
        }
        let (model, plc) = (self.model(), self.project().plc());
        if !model.in_range(to.class, i64::from(to.number), new.count) {
            let last = new.devices().last().unwrap_or(to);
            return Err(format!("{} does not have `{to}` to `{last}`", plc.title()));
        }
        if let Some(special) = new.devices().find(|one| is_special(one.class, one.number)) {
            return Err(format!("`{special}` is a special device"));
        }
        let timers = [from, to].map(|timer| model.timer(timer.number));
        if from.class == DeviceClass::T && timers[0] != timers[1] {
            return Err(format!("`{to}` is a timer of another kind than `{from}`"));
        }
        let wide = [from, to].map(|counter| is_counter32(counter.class, counter.number));
        match wide[0] == wide[1] {
            true => Ok(()),
            false => Err(format!(
                "`{to}` is a counter of another width than `{from}`"
            )),
        }
    }

    /// Returns an error for devices of which one is used or has a comment.
    fn is_free(&self, block: Block) -> Result<(), String> {
        for device in block.devices() {
            if let Some(one) = self.occurrences(device).first() {
                let line = self.at_line(one);
                return Err(match one.first == device && block.count == 1 {
                    true => format!("`{device}` is taken: {line}"),
                    false => format!("`{device}` is taken by `{}`: {line}", one.first),
                });
            }
            if self.is_named_by_settings(device) {
                return Err(format!("`{device}` is named by rungc.toml"));
            }
        }
        Ok(())
    }

    /// Returns true for a device that has a label, or that rungc.toml lets something outside read or write.
    fn is_named_by_settings(&self, device: Device) -> bool {
        let project = self.project();
        let own = project
            .settings()
            .filter(|settings| settings.is_about(project.file()));
        let mut labels = own.into_iter().flat_map(|settings| &settings.labels);
        let parameters = self.program().parameters.as_ref();
        let runs = parameters.map(|p| [&p.read_externally, &p.written_externally]);
        let mut runs = runs.into_iter().flatten().flatten();
        labels.any(|label| label.device == device)
            || runs.any(|run| {
                let numbers = run.first..run.first.saturating_add(run.count);
                run.class == device.class && numbers.contains(&device.number)
            })
    }

    /// Returns an error for devices that an index register may select.
    fn is_out_of_reach(&self, block: Block) -> Result<(), String> {
        let bounds = self.project().settings();
        let bounds = bounds.map(|settings| settings.bounds(self.project().file()));
        let bounds = bounds.unwrap_or_default();
        let open = self
            .uses
            .iter()
            .filter(|one| !matches!(one.reach, Reach::Count(_)));
        for one in open.filter(|one| one.first.class == block.first.class) {
            let known = bounds.iter().find(|bound| bound.device == one.first);
            let reached = match known {
                Some(bound) => bound.first < block.end() && block.first.number <= bound.last,
                None => one.first.number < block.end(),
            };
            if reached {
                let device = block.first;
                let instr = &self.program().instrs[one.instr];
                let line = self.program().source.line(instr.span.start);
                return Err(format!(
                    "line {line} (`{instr}`) may reach `{device}` by its index; `[index]` in rungc.toml can limit that"
                ));
            }
        }
        Ok(())
    }

    fn edits(&self, old: Block, target: Device) -> Vec<(Span, String)> {
        let moved = |device: Device| Device {
            class: target.class,
            number: target.number + (device.number - old.first.number),
        };
        let comments = self.program().comment_spans.iter();
        let comments = comments.filter(|(device, _)| old.has(**device));
        let comments = comments.map(|(device, span)| (*span, moved(*device).to_string()));
        let uses = self.occurrences(old.first).into_iter();
        let uses = uses.filter_map(|one| {
            let instr = self.program().instrs.get(one.instr?)?;
            let text = match one.operand {
                Some(n) => with_device(&instr.operands.get(n)?.kind, target)?.to_string(),
                None => target.to_string(),
            };
            Some((one.span, text))
        });
        let mut edits: Vec<_> = comments.chain(uses).collect();
        edits.sort();
        edits.dedup();
        edits
    }

    /// Returns an error if an instruction does not accept the device.
    fn is_accepted(&self, edits: &[(Span, String)], target: Device) -> Result<(), String> {
        let source = &self.program().source;
        let fix = edits.iter().fold(Fix::certain(""), |fix, (span, text)| {
            fix.replace(*span, text)
        });
        let (text, _) = diag::apply(&source.text, &[&fix]);
        let errors = |text: &str| -> Vec<Diagnostic> {
            let read = rungc_frontend::read_text(&source.name, text);
            let (_, found) = resolve(&read.program, self.model());
            let found = found.sorted().into_iter();
            found
                .filter(|one| one.severity == Severity::Error)
                .collect()
        };
        let (before, after) = (errors(&source.text), errors(&text));
        if after.len() <= before.len() {
            return Ok(());
        }
        let is_new = |error: &&Diagnostic| before.iter().all(|old| old.message != error.message);
        let why = after.iter().find(is_new).map_or("", |error| &error.message);
        Err(format!("`{target}` does not fit: {why}"))
    }

    /// Differences that do not make an error.
    fn notes(&self, from: Device, to: Device) -> Vec<String> {
        let ranges = latches::ranges(self.program(), self.model());
        let is_latched = |device: Device| {
            let mut ranges = ranges.iter();
            ranges.any(|range| {
                let numbers = range.first..=range.last;
                range.class == device.class && numbers.contains(&device.number) && range.latched
            })
        };
        match (is_latched(from), is_latched(to)) {
            (true, false) => vec![format!("{to} is not latched, {from} was")],
            (false, true) => vec![format!("{to} is latched, {from} was not")],
            _ => Vec::new(),
        }
    }
}

/// An operand with another device.
fn with_device(kind: &OperandKind, device: Device) -> Option<OperandKind> {
    Some(match *kind {
        OperandKind::Device(_, index) => OperandKind::Device(device, index),
        OperandKind::WordBit(_, bit, index) => OperandKind::WordBit(device, bit, index),
        OperandKind::Nibbles(digits, _, index) => OperandKind::Nibbles(digits, device, index),
        _ => return None,
    })
}
