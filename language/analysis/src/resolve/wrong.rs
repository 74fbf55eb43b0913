//! Messages for operands that do not fit.

use super::operands::{Matched, is_unreadable};
use rungc_catalogue::{Basic, Form, Found, Inst, Param, Role, Shape};
use rungc_models::{Model, ModelId};
use rungc_syntax::{
    Classes, Device, DeviceClass, Diagnostic, Fix, Instr, Operand, OperandKind, Phrase, Source,
    Span, codes, phrase,
};

/// The error for a line that continues with another instruction: `LD X000 OUT Y000`.
pub(super) fn second_instruction(
    instr: &Instr,
    params: &[Param],
    source: &Source,
) -> Option<Diagnostic> {
    let text = |operand: &Operand| source.slice(operand.span).to_ascii_uppercase();
    let names = |(at, operand): (usize, &Operand)| {
        // `TO` is a mistyped `T0` where an operand is awaited.
        let operand_meant = matches!(operand.kind, OperandKind::Unreadable(Some(_)));
        // A name where a jump or call awaits its label: `CALL SUB`.
        let label = at + 1 == instr.operands.len()
            && params
                .get(at)
                .is_some_and(|param| param.shape == Shape::Pointer);
        is_unreadable(operand)
            && !(operand_meant && at < params.len())
            && !label
            && rungc_catalogue::find(&text(operand)).is_some()
    };
    let further = instr.operands.iter().enumerate();
    let further: Vec<_> = further.filter(|operand| names(*operand)).collect();
    let (&(_, second), others) = further.split_first()?;
    // An instruction may have a step number in front.
    let is_number = |operand: &&Operand| text(operand).bytes().all(|b| b.is_ascii_digit());
    let begins = |at: usize| {
        let before = at.checked_sub(1).and_then(|at| instr.operands.get(at));
        let step = before.filter(|operand| is_unreadable(operand));
        at - usize::from(step.filter(is_number).is_some())
    };
    // The blanks before an instruction, which a line end replaces.
    let gap = |at: usize| {
        let first = begins(at);
        let before = first.checked_sub(1).and_then(|n| instr.operands.get(n));
        let end = before.map_or(instr.mnemonic_span, |before| before.span).end;
        Span::new(end, instr.operands[first].span.start)
    };
    let message = phrase!(
        "a second instruction, `{second}`, on one line",
        second = text(second)
    );
    let end = Span::new(instr.span.end, instr.span.end);
    let begin = instr.operands[begins(further[0].0)].span;
    let diagnostic = codes::ONE_PER_LINE
        .at(begin.to(end), message)
        .label("starts here");
    let (title, help) = match others {
        [] => (
            "put it on its own line",
            phrase!("write `{second}` on its own line", second = text(second)),
        ),
        _ => (
            "put each on its own line",
            phrase!("write each instruction on its own line"),
        ),
    };
    let fix = further.iter().fold(Fix::certain(title), |fix, (at, _)| {
        fix.replace(gap(*at), "\n")
    });
    Some(diagnostic.help(help).fix(fix))
}

/// The error for a number with a fraction, `1.5`, where an instruction takes whole numbers only; where it takes floats,
/// the reader of the program has said how they are written.
pub(super) fn fraction(
    instr: &Instr,
    found: Found,
    params: &[Param],
    source: &Source,
    model: &Model,
) -> Option<Diagnostic> {
    let takes_floats = |param: &Param| param.classes_on(model).meets(Classes::E);
    let mut all = instr.operands.iter().enumerate().zip(params);
    let ((at, operand), _) = all.find(|((_, operand), param)| {
        let text = source.slice(operand.span);
        let fraction = text.contains('.') && text.parse::<f32>().is_ok_and(f32::is_finite);
        is_unreadable(operand) && fraction && !takes_floats(param)
    })?;
    let text = source.slice(operand.span);
    let error = codes::BAD_OPERAND
        .at(
            operand.span,
            phrase!("`{text}` is not a valid operand", text),
        )
        .label(phrase!(
            "`{mnemonic}` takes whole numbers",
            mnemonic = instr.mnemonic
        ));
    let form = Form {
        wide: true,
        ..found.form
    };
    let floats = rungc_catalogue::find(&format!("E{inst}", inst = found.inst.name))
        .filter(|floats| floats.inst.models.has(model.id))
        .filter(|floats| {
            let params = floats.inst.params_of(&instr.operands, model);
            params.get(at).is_some_and(takes_floats)
        })
        .and_then(|floats| floats.inst.spelling_of(form));
    Some(match floats {
        Some(name) => {
            let constant = format!("E{text}");
            let fix = Fix::suggested(phrase!("write `{name}` and `{constant}`", name, constant))
                .replace(instr.mnemonic_span, name.as_str())
                .replace(operand.span, constant.as_str());
            let help = phrase!(
                "`{name}` takes floats, here `{constant}`; a float takes two registers",
                name,
                constant
            );
            error.help(help).fix(fix)
        }
        None => error.help("scale the value, and write a whole number such as `K15`"),
    })
}

pub(super) fn too_few(instr: &Instr, params: &[Param]) -> Diagnostic {
    let found = instr.operands.len();
    let message = phrase!(
        "`{mnemonic}` needs {count}, found {found}",
        mnemonic = instr.mnemonic,
        count = counted(params.iter().filter(|param| !param.optional).count()),
        found
    );
    let missing: Vec<_> = params.iter().skip(found).map(|param| param.name).collect();
    let names = missing.join(", ");
    let label = match missing.len() {
        1 => phrase!("operand {names} is missing", names),
        _ => phrase!("operands {names} are missing", names),
    };
    let end = Span::new(instr.span.end, instr.span.end);
    codes::TOO_FEW_OPERANDS
        .at(if found == 0 { instr.span } else { end }, message)
        .label(label)
        .help(signature(&instr.mnemonic, params))
}

pub(super) fn too_many(instr: &Instr, first: Span, name: &str, params: &[Param]) -> Diagnostic {
    let message = match params.len() {
        0 => phrase!("`{name}` takes no operand", name),
        n => phrase!(
            "`{name}` takes {counted}, found {operands}",
            name,
            counted = counted(n),
            operands = instr.operands.len()
        ),
    };
    codes::TOO_MANY_OPERANDS
        .at(first, message)
        .label("too many operands from here on")
        .help(signature(name, params))
}

fn counted(operands: usize) -> Phrase {
    match operands {
        1 => phrase!("1 operand"),
        n => phrase!("{n} operands", n),
    }
}

fn signature(name: &str, params: &[Param]) -> Phrase {
    let mut form = name.to_owned();
    for param in params {
        let (open, close) = if param.optional { ("[", "]") } else { ("", "") };
        form.push_str(&format!(" {open}{param}{close}", param = param.name));
    }
    phrase!("write `{form}`", form)
}

/// An operand of a class that the parameter does not take; `at` is its place.
pub(super) fn wrong_class(
    matched: &Matched,
    at: usize,
    param: &Param,
    classes: Classes,
    model: &Model,
) -> Diagnostic {
    let (instr, inst) = (matched.instr, matched.found.inst);
    let operand = &instr.operands[at];
    if let Some(device) = missing_class(&operand.kind, model) {
        return no_such_class(operand.span, device, model);
    }
    let message = phrase!(
        "`{kind}` cannot be operand {param} of `{mnemonic}`",
        kind = operand.kind,
        param = param.name,
        mnemonic = instr.mnemonic
    );
    let kind = Classes::of(&operand.kind);
    let written = param.role != Role::Read;
    let label = match kind {
        Classes::X | Classes::KNX if written => "inputs cannot be written",
        Classes::K | Classes::H | Classes::E if written => "a constant cannot be written",
        _ => "not accepted here",
    };
    let error = codes::OPERAND_CLASS.at(operand.span, message).label(label);
    let error = match whole_group(operand, matched, classes) {
        Some(group) => error.fix(
            Fix::suggested(phrase!("write `{group}`", group))
                .replace(operand.span, group.to_string()),
        ),
        None => error,
    };
    error.help(instead(operand, matched, classes).unwrap_or_else(|| {
        let all = of_all_variants(inst, at, model).or(classes);
        phrase!(
            "accepted: {kinds}",
            kinds = all.names().collect::<Vec<_>>().join(", ")
        )
    }))
}

/// The group of bits that begins with a bit where a value is wanted.
fn whole_group(operand: &Operand, matched: &Matched, classes: Classes) -> Option<OperandKind> {
    use DeviceClass::{M, S, X, Y};
    let OperandKind::Device(device, _) = operand.kind else {
        return None;
    };
    let digits = if matched.found.form.wide { 8 } else { 4 };
    let group = OperandKind::Nibbles(digits, device, None);
    let bits = matches!(device.class, X | Y | M | S);
    (bits && classes.meets(Classes::of(&group))).then_some(group)
}

/// Replacement of an operand of the wrong class, where known.
fn instead(operand: &Operand, matched: &Matched, classes: Classes) -> Option<Phrase> {
    let OperandKind::Device(device, _) = operand.kind else {
        return None;
    };
    use DeviceClass::{D, R, V, Z};
    let group = Classes::KNX
        .or(Classes::KNY)
        .or(Classes::KNM)
        .or(Classes::KNS);
    if let Some(grouped) = whole_group(operand, matched, classes) {
        let bits = if matched.found.form.wide { 32 } else { 16 };
        return Some(phrase!(
            "`{device}` is one bit; write a group of {bits} bits as `{grouped}`",
            device,
            bits,
            grouped
        ));
    }
    let coil = matched.found.inst.basic() == Some(Basic::Out);
    if coil && matches!(device.class, D | R | V | Z) {
        return Some(phrase!(
            "a coil is Y, M, S, T, C or a bit of a word (`D0.F`); use `MOV` to write a value to `{device}`",
            device
        ));
    }
    let bits = !classes.meets(group) && classes.meets(Classes::M);
    (bits && matches!(device.class, D) && classes.meets(Classes::WORD_BIT)).then(|| {
        phrase!(
            "`{device}` is a word; write one bit of it as `{device}.F`",
            device
        )
    })
}

/// The classes that an operand takes with any of the devices that may be first.
fn of_all_variants(inst: &Inst, at: usize, model: &Model) -> Classes {
    let variants = inst.variants.iter();
    let of_model = variants.filter(|variant| variant.models.has(model.id));
    let params = of_model.filter_map(|variant| variant.params?.get(at));
    params.fold(Classes::NONE, |all, param| all.or(param.classes_on(model)))
}

/// The device of an operand whose class the model does not have at all.
fn missing_class(kind: &OperandKind, model: &Model) -> Option<Device> {
    let device = super::operands::device_of(kind)?;
    let missing = model.missing().meets(Classes::of_device(device.class));
    (missing && matches!(device.class, DeviceClass::R | DeviceClass::ER)).then_some(device)
}

fn no_such_class(span: Span, device: Device, model: &Model) -> Diagnostic {
    let class = device.class;
    let having = ModelId::ALL.into_iter().map(Model::get);
    let having = having.filter(|other| other.ranges_of(class).next().is_some());
    let names: Vec<_> = having.map(|other| other.name).collect();
    let message = phrase!(
        "`{device}` does not exist: {model} has no {prefix}",
        device,
        model = model.name,
        prefix = class.prefix()
    );
    codes::NO_DEVICE
        .at(span, message)
        .label(phrase!("not on {model}", model = model.title))
        .help(phrase!("available on: {names}", names = names.join(", ")))
}

/// A device whose number does not serve in this place.
pub(super) fn not_this_number(
    span: Span,
    device: Device,
    allowed: &[&(DeviceClass, u32, u32)],
    param: &Param,
    model: &Model,
) -> Diagnostic {
    let ranges: Vec<_> = allowed
        .iter()
        .map(|&&(class, first, last)| match first == last {
            true => class.number(first).to_string(),
            false => format!(
                "{first}–{last}",
                first = class.number(first),
                last = class.number(last)
            ),
        })
        .collect();
    let ranges = ranges.join(", ");
    let diagnostic = codes::NOT_THIS_NUMBER
        .at(span, phrase!("`{device}` cannot be used here", device))
        .label(phrase!("here only {ranges}", ranges));
    let model = model.name;
    let help = match (param.keeps_position, param.sends_pulses) {
        (true, _) => phrase!(
            "only these outputs of {model} keep a position: {ranges}",
            model,
            ranges
        ),
        (_, true) => phrase!(
            "only these outputs of {model} send pulses: {ranges}",
            model,
            ranges
        ),
        _ => return diagnostic,
    };
    diagnostic.help(help)
}

/// A constant that is wider than its operand.
pub(super) fn wide_constant(
    matched: &Matched,
    operand: &Operand,
    bits: u32,
    model: &Model,
) -> Diagnostic {
    let message = phrase!(
        "`{kind}` does not fit in {bits} bits",
        kind = operand.kind,
        bits
    );
    let preset = preset_of(matched);
    let range = match (bits, matches!(operand.kind, OperandKind::Hex(..))) {
        (16, false) if preset.is_some() => "K0 to K32767 here",
        (16, true) => "H0 to HFFFF here",
        (16, false) => "K-32768 to K32767 here",
        (_, true) => "H0 to HFFFFFFFF here",
        (_, false) => "K-2147483648 to K2147483647 here",
    };
    let diagnostic = codes::CONSTANT_WIDTH.at(operand.span, message).label(range);
    if let Some(device) = preset.filter(|_| bits == 16) {
        return diagnostic.help(longer_preset(device, model));
    }
    let wide = Form {
        wide: true,
        ..matched.found.form
    };
    match matched.found.inst.spelling_of(wide) {
        Some(name) if bits == 16 => {
            let fix = Fix::suggested(phrase!("write `{name}`", name))
                .replace(matched.instr.mnemonic_span, name.as_str());
            diagnostic
                .help(phrase!("`{name}` takes 32 bits", name))
                .fix(fix)
        }
        _ => diagnostic,
    }
}

/// The timer or counter whose preset an instruction states.
fn preset_of(matched: &Matched) -> Option<Device> {
    match (
        matched.found.inst.basic(),
        &matched.instr.operands.first()?.kind,
    ) {
        (Some(Basic::Out), &OperandKind::Device(device, _)) => Some(device),
        _ => None,
    }
}

/// Advice for times or counts beyond the greatest preset of a timer or counter.
fn longer_preset(device: Device, model: &Model) -> Phrase {
    match model
        .timer(device.number)
        .filter(|_| device.class == DeviceClass::T)
    {
        Some(kind) => phrase!(
            "`{device}` counts up to {seconds} s; for longer times, let the contact of one timer drive the next",
            device,
            seconds = (f64::from(kind.unit_ms) * 32_767.0 / 1_000.0).to_string()
        ),
        None => phrase!("C200 to C234 count with 32 bits"),
    }
}
