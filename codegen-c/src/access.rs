//! Devices by number and by name, for hosts that ask for them: `NAME_access.h` and `NAME_access.c`.

use crate::fields::{PrintField, PrintStorage};
use rungc_emit::areas::{self, Area};
use rungc_emit::storage::{Kind, Storage};
use rungc_ir::Module;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Frame of the header around a program's name.
const HEADER: &str = "\
#ifndef GUARD
#define GUARD

#include \"NAME.h\"
#include \"rungc_access.h\"

#ifdef __cplusplus
extern \"C\" {
#endif

/* Reads a device by class and number: NAME_read(plc, PLC_CLASS_D, 100, &value). A bit is 0 or 1, a word is signed.
   False if the program does not store the device; then `value` stays. */
bool NAME_read(const NAME_plc *plc, plc_class device, uint32_t number, int32_t *value);

/* Writes a device; a bit is on unless the value is 0. False, and nothing is written, if the program does not store the device
   or its 16 bits do not hold the value. Not while a scan runs. */
bool NAME_write(NAME_plc *plc, plc_class device, uint32_t number, int32_t value);

/* The same by the device's name in the PLC: \"D100\", \"X012\" (in octal), \"T0\" for a current value, \"TS0\" for a contact. */
bool NAME_read_named(const NAME_plc *plc, const char *name, int32_t *value);
bool NAME_write_named(NAME_plc *plc, const char *name, int32_t value);

#ifdef __cplusplus
}
#endif

#endif
";

/// Part of the source after the table.
const SOURCE: &str = "\
#define AREAS (sizeof(areas) / sizeof(areas[0]))

bool NAME_read(const NAME_plc *plc, plc_class device, uint32_t number, int32_t *value)
{
    return plc_read_device(areas, AREAS, (const unsigned char *)plc, device, number, value);
}

bool NAME_write(NAME_plc *plc, plc_class device, uint32_t number, int32_t value)
{
    return plc_write_device(areas, AREAS, (unsigned char *)plc, device, number, value);
}

bool NAME_read_named(const NAME_plc *plc, const char *name, int32_t *value)
{
    plc_class device = PLC_CLASS_X;
    uint32_t number = 0;

    return plc_parse_device(name, &device, &number) && NAME_read(plc, device, number, value);
}

bool NAME_write_named(NAME_plc *plc, const char *name, int32_t value)
{
    plc_class device = PLC_CLASS_X;
    uint32_t number = 0;

    return plc_parse_device(name, &device, &number) && NAME_write(plc, device, number, value);
}
";

/// The text of `NAME_access.h`, without its first line.
pub fn header(module: &Module) -> String {
    let guard = format!("{}_ACCESS_H", module.name.to_ascii_uppercase());
    HEADER
        .replace("GUARD", &guard)
        .replace("NAME", &module.name)
}

/// The text of `NAME_access.c`, without its first line.
pub fn source(module: &Module) -> String {
    let name = &module.name;
    let storage = Storage::new(module);
    let mut out = format!(
        "#include \"{name}_access.h\"\n\n/* Offsets of the program's devices in its struct. */\nstatic const plc_area areas[] = {{\n"
    );
    for Area { field, count } in areas::areas(&storage) {
        let mut member = String::new();
        field.name(&mut member);
        let grid = field.grid.map(|grid| (grid.columns, grid.stored_columns));
        let (columns, stored) = grid.unwrap_or((1, 1));
        let sizes = format!("{}, {count}, {columns}, {stored}", field.first);
        row(
            &mut out,
            name,
            (field.class, kind(field.kind)),
            &sizes,
            &member,
        );
    }
    for alias in module.model.index_aliases {
        let mut place = String::new();
        if alias.class != DeviceClass::D && storage.access(&mut place, alias.class, alias.index) {
            let member = place.trim_start_matches("plc->");
            let area = (DeviceClass::D, kind(Kind::Word));
            let number = alias.register.number();
            row(&mut out, name, area, &format!("{number}, 1, 1, 1"), member);
        }
    }
    if out.ends_with("= {\n") {
        // A table has at least one row; this one holds no device.
        out.push_str("    {PLC_CLASS_X, PLC_AREA_BITS, 0, 0, 1, 1, 0},\n");
    }
    out.push_str("};\n\n");
    out + &SOURCE.replace("NAME", name)
}

fn row(
    out: &mut String,
    name: &str,
    (class, kind): (DeviceClass, &str),
    sizes: &str,
    member: &str,
) {
    // Writing to a String does not fail.
    let _ = writeln!(
        out,
        "    {{PLC_CLASS_{}, {kind}, {sizes}, offsetof({name}_plc, {member})}},",
        class.prefix()
    );
}

/// The C name of what an area is made of.
fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Bit | Kind::NumericBit => "PLC_AREA_BITS",
        Kind::Word => "PLC_AREA_WORDS",
        Kind::Timer => "PLC_AREA_TIMERS",
        Kind::Counter16 => "PLC_AREA_COUNTERS16",
        Kind::Counter32 => "PLC_AREA_COUNTERS32",
    }
}
