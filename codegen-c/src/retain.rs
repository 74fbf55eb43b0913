//! Latched devices that survive power-off: `NAME_retain.h` and `NAME_retain.c`.

use rungc_emit::cycle::{self, Latches};
use rungc_emit::storage::Storage;
use rungc_ir::Module;
use std::fmt::Write;

/// Frame of the header around a program's name.
const HEADER: &str = "\
#ifndef /* GUARD */
#define /* GUARD */

#include \"NAME_access.h\"
#include \"rungc_retain.h\"

#ifdef __cplusplus
extern \"C\" {
#endif

/* Data that the program retains over power-off, and the length of a record of it, in bytes. */
extern const rungc_retained NAME_retained;
#define /* LENGTH */

/* After NAME_init: gives latched devices the values of the newest record in two slots of flash. */
rungc_loaded NAME_load_latched(NAME_plc *plc, rungc_slots *slots);

/* Between scans: once in `every_ms` saves latched devices if one has changed. `now_ms` is the time of the last scan. False if flash fails. */
bool NAME_save_changes(const NAME_plc *plc, rungc_slots *slots, uint32_t now_ms, uint32_t every_ms);

/* Saves them now, as when a supply says that power is about to fail. Not while a scan runs. False if flash fails. */
bool NAME_save_latched(const NAME_plc *plc, rungc_slots *slots);

#ifdef __cplusplus
}
#endif

#endif
";

/// Its source.
const SOURCE: &str = "\
#include \"NAME_retain.h\"

static const rungc_retained_run runs[] = {
/* RUNS */
};

/* TABLE */static bool read_device(const void *plc, plc_class device, uint32_t number, int32_t *value)
{
    return NAME_read((const NAME_plc *)plc, device, number, value);
}

static bool write_device(void *plc, plc_class device, uint32_t number, int32_t value)
{
    return NAME_write((NAME_plc *)plc, device, number, value);
}

const rungc_retained NAME_retained = {
    .program = \"/* OWNER */\",
    .runs = runs,
    .run_count = sizeof runs / sizeof runs[0],
/* RESETS */    .contacts = /* CONTACTS */,
    .key_number = /* REGISTER */,
    .key = /* KEY */,
    .read = read_device,
    .write = write_device,
};

rungc_loaded NAME_load_latched(NAME_plc *plc, rungc_slots *slots)
{
    return rungc_load(slots, &NAME_retained, plc);
}

bool NAME_save_changes(const NAME_plc *plc, rungc_slots *slots, uint32_t now_ms, uint32_t every_ms)
{
    return rungc_save_changes(slots, &NAME_retained, plc, now_ms, every_ms);
}

bool NAME_save_latched(const NAME_plc *plc, rungc_slots *slots)
{
    return rungc_save(slots, &NAME_retained, plc);
}
";

/// Members of a program with reset states that are retained.
const RESETS: &str =
    "    .resets = resets,\n    .reset_count = sizeof resets / sizeof resets[0],\n";

/// The text of `NAME_retain.h`, without its first line.
pub fn header(module: &Module) -> String {
    let upper = module.name.to_ascii_uppercase();
    let length = format!("{upper}_RECORD_LENGTH {}u", record_len(module));
    HEADER
        .replace("NAME", &module.name)
        .replace("/* GUARD */", &format!("{upper}_RETAIN_H"))
        .replace("/* LENGTH */", &length)
}

/// Length of a record of the program's latched devices, in bytes.
pub fn record_len(module: &Module) -> u32 {
    let (program, runs) = (module.retained_as(), module.retained());
    let retained = rungc_rt::retain::Retained {
        program: &program,
        runs: &runs,
        ..rungc_rt::retain::Retained::NOTHING
    };
    retained.record_len()
}

/// The text of `NAME_retain.c`, without its first line.
pub fn source(module: &Module) -> String {
    let mut rows = String::new();
    for run in module.retained() {
        // Writing to a String does not fail.
        let _ = writeln!(
            rows,
            "    {{PLC_CLASS_{:?}, {}, {}}},",
            run.class, run.first, run.count
        );
    }
    let mut resets = String::new();
    for (class, number, flag) in module.retained_resets() {
        let (name, flag) = (&module.name, &module.flags[flag].name);
        let _ = writeln!(
            resets,
            "    {{PLC_CLASS_{class:?}, {number}, offsetof({name}_plc, {flag})}},"
        );
    }
    let table = format!("static const rungc_retained_reset resets[] = {{\n{resets}}};\n\n");
    let (table, members) = match resets.is_empty() {
        true => (String::new(), ""),
        false => (table, RESETS),
    };
    let (register, key) = match cycle::latches(module, &Storage::new(module)) {
        Latches::RetainedIf(register, key) => (register, key),
        Latches::Retained | Latches::Lost(..) => (0, 0),
    };
    SOURCE
        .replace("NAME", &module.name)
        .replace("/* RUNS */\n", &rows)
        .replace("/* TABLE */", &table)
        .replace("/* RESETS */", members)
        .replace("/* OWNER */", &module.retained_as())
        .replace("/* CONTACTS */", &module.model.keeps_contacts.to_string())
        .replace("/* REGISTER */", &register.to_string())
        .replace("/* KEY */", &key.to_string())
}
