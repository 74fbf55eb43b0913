//! `codegen-c/include/rungc_rt.h` is made with cbindgen from the runtime's C ABI. The prototypes of the instructions
//! are not in it: a macro makes those functions, which cbindgen does not see, so they are added from the registry when
//! code is emitted.

use crate::generate::Made;
use crate::{Problem, root};
use cbindgen::{
    Builder, Config, EnumConfig, ExportConfig, Language, ParseConfig, RenameRule, Style,
};

/// Types that rungc.h defines, under its names, and what the others are called in C.
const NAMES: [(&str, &str); 46] = [
    ("Sys", "plc_sys"),
    ("Timer", "plc_timer"),
    ("Counter16", "plc_counter16"),
    ("Counter32", "plc_counter32"),
    ("Class", "rungc_class"),
    ("State", "rungc_state"),
    ("Site", "rungc_site"),
    ("Operand", "rungc_operand"),
    ("OperandKind", "rungc_operand_kind"),
    ("Clock", "rungc_clock"),
    ("Kind", "rungc_area_kind"),
    ("Area", "rungc_area"),
    ("Range", "rungc_range"),
    ("Alias", "rungc_alias"),
    ("Text", "rungc_text"),
    ("Generator", "rungc_generator"),
    ("Axis", "rungc_axis"),
    ("Pulses", "rungc_pulses"),
    ("Ports", "rungc_ports"),
    ("Parity", "rungc_parity"),
    ("LineFormat", "rungc_line_format"),
    ("CharFault", "rungc_char_fault"),
    ("Received", "rungc_received"),
    ("CanFrame", "rungc_can_frame"),
    ("Request", "rungc_request"),
    ("PortPlace", "rungc_port_place"),
    ("Codec", "rungc_codec"),
    ("PortWiring", "rungc_port_wiring"),
    ("Profile", "rungc_modbus_profile"),
    ("ServerProtocol", "rungc_server_protocol"),
    ("Service", "rungc_service"),
    ("FeedResult", "rungc_feed_result"),
    ("Connection", "rungc_connection"),
    ("Memory", "rungc_memory"),
    ("Reply", "rungc_reply"),
    ("Terminal", "rungc_terminal"),
    ("ModuleRoom", "rungc_module"),
    ("ClientRow", "rungc_client_row"),
    ("Link", "rungc_link"),
    ("ClientAction", "rungc_client_action"),
    ("Tally", "rungc_tally"),
    ("Client", "rungc_client"),
    ("LONGEST_ANSWER", "RUNGC_LONGEST_ANSWER"),
    ("LONGEST_REQUEST", "RUNGC_LONGEST_REQUEST"),
    ("LONGEST_REPLY", "RUNGC_LONGEST_REPLY"),
    ("SIZE", "RUNGC_MEMORY_SIZE"),
];

/// What rungc.h defines, limits of hosts' servers, and numbers of modules: data for emitted code, not for the library's
/// users.
const LEFT_OUT: [&str; 13] = [
    "Sys",
    "Timer",
    "Counter16",
    "Counter32",
    "USUAL_CLIENTS",
    "MAX_CLIENTS",
    "IDLE_S",
    "REQUEST_S",
    "BOARD",
    "BOARDS",
    "ADAPTERS",
    "REGISTERS",
    "EXCHANGE",
];

const TOP: &str = "/*
 * rungc_rt.h: the runtime library of programs compiled by rungc. Made by cbindgen from runtime-rt; do not edit.
 *
 * A program describes its struct once (rungc_layout), binds it to one struct and the hardware (rungc_map), and calls one function
 * for each instruction that is not worth inlining. Only the functions that a program calls are linked.
 */";

/// Types before all others.
const OPAQUE: &str = "
/* Implementation of protocols for serial ports. */
typedef struct rungc_codec rungc_codec;

/* Devices that a model serves by Modbus. */
typedef struct rungc_modbus_profile rungc_modbus_profile;";

/// Operands and sites, as emitted code writes them.
const CONSTRUCTORS: &str = include_str!("constructors.h");

/// The header.
pub fn make() -> Result<Made, Problem> {
    let runtime = root().join("runtime-rt");
    let mut names: std::collections::HashMap<String, String> = NAMES
        .iter()
        .map(|(rust, c)| (rust.to_string(), c.to_string()))
        .collect();
    names.insert("Layout".into(), "rungc_layout".into());
    names.insert("HalTable".into(), "rungc_hal".into());
    names.insert("Map".into(), "rungc_map".into());
    let config = Config {
        language: Language::C,
        style: Style::Both,
        cpp_compat: true,
        header: Some(TOP.to_string()),
        include_guard: Some("RUNGC_RT_H".to_string()),
        no_includes: true,
        includes: vec!["rungc.h".to_string()],
        after_includes: Some(OPAQUE.to_string()),
        trailer: Some(format!("{CONSTRUCTORS}\n/* INSTRUCTIONS */")),
        line_length: 120,
        tab_width: 4,
        usize_is_size_t: true,
        export: ExportConfig {
            exclude: LEFT_OUT.map(str::to_string).into(),
            // Only the functions below take them, which cbindgen does not see: a macro makes them.
            include: ["Operand", "OperandKind", "Site", "Axis"]
                .map(str::to_string)
                .into(),
            rename: names,
            ..ExportConfig::default()
        },
        enumeration: EnumConfig {
            rename_variants: RenameRule::ScreamingSnakeCase,
            prefix_with_name: true,
            ..EnumConfig::default()
        },
        parse: ParseConfig {
            parse_deps: false,
            ..ParseConfig::default()
        },
        ..Config::default()
    };
    let files = [
        "rt/src/plc.rs",
        "rt/src/operand.rs",
        "rt/src/hal.rs",
        "rt/src/pulse.rs",
        "rt/src/axis.rs",
        "rt/src/wiring.rs",
        "rt/src/comm/line.rs",
        "rt/src/comm/memory.rs",
        "rt/src/comm/modbus/client.rs",
        "rt/src/comm/service.rs",
        "rt/src/comm/wiring.rs",
        "rt/src/capi.rs",
        "rt/src/capi/clients.rs",
        "rt/src/capi/exports.rs",
        "rt/src/capi/modules.rs",
        "host/src/capi.rs",
        "rt/src/capi/servers.rs",
        "rt/src/capi_virtual.rs",
    ];
    let builder = files
        .iter()
        .fold(Builder::new().with_config(config), |b, f| {
            b.with_src(runtime.join(f))
        });
    let mut text = Vec::new();
    builder.generate()?.write(&mut text);
    let text = String::from_utf8(text)?;
    Ok(Made::file("codegen-c/include/rungc_rt.h", text))
}
