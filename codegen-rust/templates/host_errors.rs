/// Reports an operation error as it happens, once for each instruction.
fn report_error(plc: &TYPE, code: u16, step: u16) {
    static REPORTED: Mutex<BTreeSet<u16>> = Mutex::new(BTreeSet::new());
    let is_new = REPORTED.lock().is_ok_and(|mut steps| steps.insert(step));
    if is_new {
        let what = missing_device(plc, step).unwrap_or(meaning(code).to_string());
        let now_ms = plc.sys().now_ms;
        report!("at {now_ms} ms, step {step}: {}: error {code}, {what}", instruction(step).0);
    }
}

/// A device that the instruction at a step has not found, as its index registers are now.
fn missing_device(plc: &TYPE, step: u16) -> Option<String> {
    instruction(step).1.iter().find_map(|&(class, name, first, index, register)| {
        let offset = plc.word(index, register)?;
        let number = first.checked_add_signed(offset.into());
        let exists = |&n: &u32| plc.bit(class, n).is_some() || plc.word(class, n).is_some();
        match (number, class) {
            (Some(number), _) if exists(&number) => None,
            (Some(number), Class::X | Class::Y) => Some(format!("{name}{number:03o} does not exist")),
            (Some(number), _) => Some(format!("{name}{number} does not exist")),
            (None, _) => Some(format!("{name}{first} with an index of {offset} does not exist")),
        }
    })
}

