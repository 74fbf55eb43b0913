//! The host program: scans in real time on a system with POSIX, or on Windows.

mod clients;
mod environment;

use crate::fields::PrintStorage;
use crate::{Options, template, text};
use rungc_emit::storage::{Field, Storage};
use rungc_emit::usage::{self, Host, Takes};
use rungc_ir::Module;
use rungc_rt::comm::service::{
    IDLE_S, MAX_CLIENTS, REQUEST_S, ServerProtocol, TABLE_HEADING, USUAL_CLIENTS,
};
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// Wait of a program whose time advances between scans.
const WAIT_WITH_TIME: &str = "\
for (uint64_t now = microseconds(); now < next && !stopped; now = microseconds()) {
            sleep_until(now + 1000u < next ? now + 1000u : next);
            ADVANCE(plc, (uint32_t)((microseconds() - start) / 1000u));
/* INTERRUPTS */        }";

/// Start of the next scan.
const PERIOD: &str = "next += SCAN_MS * 1000u;";

/// Start of the next scan if a constant scan time may be requested.
const CONSTANT_PERIOD: &str = "\
const uint32_t constant_us = PROGRAM_constant_scan_us(plc);
        if (constant_us == 0u) {
            next += SCAN_MS * 1000u;
        } else if (scan_us <= constant_us) {
            next += constant_us;
            scan_us = constant_us;
        } else {
            next = microseconds();
            print_overrun(scan_us, constant_us);
        }";

/// The real-time clock of a host.
const CLOCK: &str = "\
/* Seconds by which the program's clock is ahead of this computer's, since the program has set it. */
static time_t ahead;

/* Days by which its weekday is ahead of the date's, likewise. */
static int weekday_ahead;

/* The real-time clock: the local time. */
static bool read_clock(void *context, rungc_clock *clock)
{
    const time_t now = time(NULL) + ahead;
    struct tm local;

    (void)context;
    if (localtime_r(&now, &local) == NULL) {
        return false;
    }
    clock->year = (uint16_t)(local.tm_year + 1900);
    clock->month = (uint8_t)(local.tm_mon + 1);
    clock->day = (uint8_t)local.tm_mday;
    clock->hour = (uint8_t)local.tm_hour;
    clock->minute = (uint8_t)local.tm_min;
    clock->second = (uint8_t)(local.tm_sec < 60 ? local.tm_sec : 59);
    clock->weekday = (uint8_t)((local.tm_wday + weekday_ahead) % 7);
    return true;
}

/* Sets the program's clock; this computer's stays as it is. The weekday need not agree with the date. */
static bool set_clock(void *context, const rungc_clock *clock)
{
    struct tm local = {.tm_year = clock->year - 1900,
                       .tm_mon = clock->month - 1,
                       .tm_mday = clock->day,
                       .tm_hour = clock->hour,
                       .tm_min = clock->minute,
                       .tm_sec = clock->second,
                       .tm_isdst = -1};
    const time_t then = mktime(&local);

    (void)context;
    if (then == (time_t)-1) {
        return false;
    }
    ahead = then - time(NULL);
    weekday_ahead = (clock->weekday - local.tm_wday + 7) % 7;
    return true;
}

";

/// Headers that every host needs on all systems, and those of hosts that retain latched devices, with serial ports, and
/// with servers.
const HEADERS: [&str; 6] = ["signal", "stdarg", "stdio", "stdlib", "string", "time"];
const RETAIN_HEADERS: [&str; 3] = ["errno", "pthread", "semaphore"];
const LINES_HEADERS: [&str; 1] = ["errno"];
const SERVERS_HEADERS: [&str; 1] = ["errno"];

/// Those beside them of systems with POSIX.
const POSIX_HEADERS: [&str; 2] = ["poll", "unistd"];
const POSIX_RETAIN_HEADERS: [&str; 3] = ["fcntl", "sys/file", "sys/stat"];
const POSIX_LINES_HEADERS: [&str; 3] = ["fcntl", "glob", "termios"];
const POSIX_SERVERS_HEADERS: [&str; 5] =
    ["fcntl", "netdb", "netinet/in", "netinet/tcp", "sys/socket"];

/// Those of Windows.
const WINDOWS_HEADERS: &str = "#include <windows.h>\n";
const WINDOWS_RETAIN_HEADERS: &str = "#include <fcntl.h>\n#include <io.h>\n#include <sys/stat.h>\n";

/// Report of a scan that exceeds the constant scan time.
const OVERRUN: &str = "\
/* Reports once that a scan takes longer than the program wants. */
static void print_overrun(uint32_t scan_us, uint32_t constant_us)
{
    static bool reported;

    if (!reported) {
        print(stderr, \"PROGRAM: a scan took %lu us, longer than the constant scan time of %lu us\\n\", (unsigned long)scan_us,
              (unsigned long)constant_us);
    }
    reported = true;
}

";

/// State of a host with partners on lines or connections, and what it means for the report of a STOP.
const PARTNER: [&str; 2] = [
    "/* True if a partner has switched the PLC to STOP, which is reported. */\nstatic bool partner_stops;\n\n",
    "\
    reported = reported || (partner_stops && error.stop == PLC_STOP_M8037);
    partner_stops = partner_stops && !plc->sys.running;
",
];

/// Report of operation errors by the host of a program that may fail.
const PRINT_ERROR: &str = "\
/* Reports an operation error as it happens, once for each instruction. */
static void print_error(const void *program, uint16_t code, uint16_t step)
{
    static bool reported[sizeof instructions / sizeof instructions[0]];
    const PROGRAM_plc *const plc = program;
    const size_t i = instruction_at(step);
    char device[40];
    const bool is_missing_device = missing_device(plc, step, device, sizeof device);

    if (reported[i]) {
        return;
    }
    reported[i] = true;
    print(stderr, \"PROGRAM: at %lu ms, step %u: %s: error %u, %s%s\\n\", (unsigned long)plc->sys.now_ms, step,
          instructions[i].text, code, is_missing_device ? device : meaning(code), is_missing_device ? \" does not exist\" : \"\");
}

";

/// `main.c` for a program.
pub fn main_file(module: &Module, options: &Options) -> String {
    let Options { servers, io, .. } = *options;
    let fields = Storage::new(module);
    let name = &module.name;
    let wait = match module.takes_time() {
        true => WAIT_WITH_TIME,
        false => "sleep_until(next);",
    };
    let interrupts = match rungc_emit::events::interrupts(module) {
        Some(_) => "            PROGRAM_take_interrupts(plc);\n",
        None => "",
    };
    let (missing, print_error, report) = error_report(module, &fields);
    let (period, overrun) = period(module, &fields);
    let uses_clock = rungc_emit::cycle::uses_clock(module);
    let hardware = hardware(uses_clock, module.has_ports());
    let hal = match hardware.is_empty() {
        true => "",
        false => "    plc->hal = &hardware;\n",
    };
    let clock = if uses_clock { CLOCK } else { "" };
    let host = Host {
        lines: &["/dev/ttyUSB0", "pty"],
        servers,
        io,
    };
    let environment = environment::parts(module, io);
    let (serve, connections) = match servers {
        true => (
            "        poll_servers(plc, now_ms);\n",
            "    print_connections();\n",
        ),
        false => ("", ""),
    };
    let [begin_clients, ask, asked] = clients::calls(module, servers);
    let keeps = rungc_emit::cycle::keeps_any(module);
    let retain = retaining(keeps, &fields, options.unsaved);
    let valued = valued(module, &host);
    let (lines, serving) = (lines(module), server_code(module, servers, &valued));
    let parts = [clock, &lines, &retain.functions, &hardware, &serving];
    let [partner, stopped] = match servers || module.has_ports() {
        true => PARTNER,
        false => [""; 2],
    };
    let (advance, receive) = advance(module);
    environment
        .in_main(template!("main.c"))
        .replace("/* FEATURES */", features(module.has_ports(), keeps))
        .replace("/* SYSTEM */\n", &system())
        .replace("/* HEADERS */\n", &headers(module, servers, keeps))
        .replace("/* INCLUDE */\n", retain.header)
        .replace("    /* LOAD */\n", retain.load)
        .replace("        /* SAVE */\n", retain.save)
        .replace("    /* END */\n", retain.end)
        .replace("    /* ASK */\n", begin_clients)
        .replace("        /* SERVE */\n", &[serve, ask, receive].concat())
        .replace("/* PARTNER */\n", partner)
        .replace("    /* STOPPED */\n", stopped)
        .replace("    /* CONNECTIONS */\n", &[connections, asked].concat())
        .replace("/* MISSING */\n", &missing)
        .replace("/* ON_ERROR */\n", print_error)
        .replace("    /* REPORT */\n", report)
        .replace("/* CODE */", retain.code)
        .replace("/* CLOCK */\n", &parts.concat())
        .replace("    /* HAL */\n", hal)
        .replace("/* PERIOD */", period)
        .replace("/* OVERRUN */\n", overrun)
        .replace("/* WAIT */", wait)
        .replace("ADVANCE", advance)
        .replace("/* INTERRUPTS */", interrupts)
        .replace("RECORD_LENGTH", &record_length(name))
        .replace("PROGRAM", name)
        // Texts of the program come last: they may contain any word.
        .replace("        /* OPTIONS */\n", &valued)
        .replace("    /* ERRORS */\n", &errors(module))
        .replace("    /* INPUTS */\n", &inputs(module, &fields))
        .replace("    /* USAGE */\n", &usage(module, &host))
        .replace("    /* INSTRUCTIONS */\n", &instructions(module))
        .replace("    /* OUTPUTS */\n", &outputs(module, &fields))
}

/// The time to the next scan, and the report of a scan that took longer.
fn period(module: &Module, fields: &Storage) -> (&'static str, &'static str) {
    match rungc_emit::cycle::constant_scan(module, fields) {
        Some(_) => (CONSTANT_PERIOD, OVERRUN),
        None => (PERIOD, ""),
    }
}

/// The function that lets time pass, and the statement that receives from lines.
fn advance(module: &Module) -> (&'static str, &'static str) {
    match module.has_ports() {
        true => ("advance_lines", "        advance_lines(plc, now_ms);\n"),
        false => ("PROGRAM_tick", ""),
    }
}

/// Message of a missing device, function that prints an error, and the statement that has it called, if one can occur.
fn error_report(module: &Module, fields: &Storage) -> (String, &'static str, &'static str) {
    match module.may_fail() {
        true => (
            missing_device(module, fields),
            PRINT_ERROR,
            "    plc->on_error = print_error;\n",
        ),
        false => (String::new(), "", ""),
    }
}

/// The cases of what is typed that set an input.
fn inputs(module: &Module, fields: &Storage) -> String {
    let inputs = inputs_of(module, fields).into_iter();
    inputs
        .map(|(number, statements)| {
            format!("    case {number}:\n{statements}        return true;\n")
        })
        .collect()
}

/// The cases of the errors that the program can raise, with their titles.
fn errors(module: &Module) -> String {
    let errors = rungc_models::plc_errors::of_programs(module.model.id);
    let errors = errors.filter(|_| module.may_fail()).map(|error| {
        let title = text::string_literal(error.title);
        format!("    case {}u:\n        return {title};\n", error.code)
    });
    errors.collect()
}

/// The rows of the outputs that a run shows.
fn outputs(module: &Module, fields: &Storage) -> String {
    let mut rows = String::new();
    // Outputs that send pulses would be printed all the time.
    let quiet = |number: &u32| module.pulse_outputs.contains(number);
    let terminals_y = terminals(fields, DeviceClass::Y);
    for &(number, _) in terminals_y.iter().filter(|(number, _)| !quiet(number)) {
        let label = DeviceClass::Y.number(number).to_string();
        let text = fields
            .comment(DeviceClass::Y, number)
            .map(text::comment)
            .unwrap_or_default();
        let _ = writeln!(
            rows,
            "    {{{number}, \"{label}\", {}}},",
            text::string_literal(&text)
        );
    }
    rows
}

/// Parts of a host that retains latched devices.
struct Retaining {
    header: &'static str,
    functions: String,
    /// Before the first scan, after each, and after the last.
    load: &'static str,
    save: &'static str,
    end: &'static str,
    /// The exit code.
    code: &'static str,
}

/// Parts of a host that retains latched devices; a device may show that they cannot be saved.
fn retaining(keeps: bool, fields: &Storage, unsaved: Option<(DeviceClass, u32)>) -> Retaining {
    if !keeps {
        return Retaining {
            header: "",
            functions: String::new(),
            load: "",
            save: "",
            end: "",
            code: "0",
        };
    }
    let mut device = String::new();
    let is_stored =
        unsaved.is_some_and(|(class, number)| fields.access(&mut device, class, number));
    let show = match is_stored {
        true => format!("    {device} = retained.fails;\n"),
        false => String::new(),
    };
    Retaining {
        header: "#include \"PROGRAM_retain.h\"\n",
        functions: template!("main_retain.c").replace("    /* UNSAVED */\n", &show),
        load: "    if (!begin_retained() || !load_retained(plc)) {\n        return 2;\n    }\n",
        save: "        save_retained(plc, now_ms);\n",
        end: "    const bool is_saved = end_retained(plc);\n",
        code: "is_saved ? 0 : 1",
    }
}

/// Feature test macros for the system's headers.
fn features(ports: bool, retain: bool) -> &'static str {
    match (ports, retain) {
        (true, true) => {
            "#define _DARWIN_C_SOURCE\n#define _DEFAULT_SOURCE\n#define _POSIX_C_SOURCE 200809L\n\
             #define _XOPEN_SOURCE 700"
        }
        (true, false) => {
            "#define _DEFAULT_SOURCE\n#define _POSIX_C_SOURCE 200809L\n#define _XOPEN_SOURCE 700"
        }
        (false, true) => {
            "#define _DARWIN_C_SOURCE\n#define _POSIX_C_SOURCE 200809L\n#define _XOPEN_SOURCE 700"
        }
        (false, false) => "#define _POSIX_C_SOURCE 200809L",
    }
}

/// Code for Windows, and for all other systems.
fn by_system(windows: &str, posix: &str) -> String {
    format!("#ifdef _WIN32\n{windows}#else\n{posix}#endif\n")
}

/// What a run needs of the system: time, signals, standard input.
fn system() -> String {
    by_system(template!("main_windows.c"), template!("main_posix.c")) + "\n"
}

/// The lines that include the system's headers.
fn headers(module: &Module, servers: bool, retain: bool) -> String {
    let lines = |sets: [(bool, &[&str]); 4]| {
        let sets = sets.iter().filter(|(is_needed, _)| *is_needed);
        let names: BTreeSet<_> = sets.flat_map(|(_, names)| *names).collect();
        let lines = names
            .into_iter()
            .map(|name| format!("#include <{name}.h>\n"));
        lines.collect::<String>()
    };
    let ports = module.has_ports();
    let all = lines([
        (true, &HEADERS),
        (retain, &RETAIN_HEADERS),
        (ports, &LINES_HEADERS),
        (servers, &SERVERS_HEADERS),
    ]);
    let posix = lines([
        (true, &POSIX_HEADERS),
        (retain, &POSIX_RETAIN_HEADERS),
        (ports, &POSIX_LINES_HEADERS),
        (servers, &POSIX_SERVERS_HEADERS),
    ]);
    let of_retain = if retain { WINDOWS_RETAIN_HEADERS } else { "" };
    all + &by_system(&format!("{of_retain}{WINDOWS_HEADERS}"), &posix)
}

/// The statements that print the text for `--help`.
fn usage(module: &Module, host: &Host) -> String {
    let lines = usage::lines(module, host).into_iter();
    let lines = lines.map(|line| {
        let line = text::string_literal(&format!("{line}\n"));
        format!("    fputs({line}, to);\n")
    });
    lines.collect()
}

/// The statements that take the options with a value.
fn valued(module: &Module, host: &Host) -> String {
    let options = usage::options(module, host).into_iter();
    let options = options.map(|option| {
        let call = match option.takes {
            Takes::Line => "open_line(argv[++i])".to_string(),
            Takes::Retained => "keep_in(argv[++i])".to_string(),
            Takes::Io => environment::option(module, "describe"),
            Takes::Log => environment::option(module, "open_log"),
            Takes::Clients => "limit_connections(argv[++i])".to_string(),
            Takes::Address(protocol) => open_server(protocol),
            Takes::AddressOrLine(protocol, port) => {
                let open = open_server(protocol);
                format!("(is_line(argv[i + 1]) ? connect_line({port}, argv[++i]) : {open})")
            }
        };
        format!(
            "        if (strcmp(argv[i], \"{}\") == 0 && i + 1 < argc) {{\n            if (!{call}) {{\n                \
             return 2;\n            }}\n            continue;\n        }}\n",
            option.name
        )
    });
    options.collect()
}

/// The call that opens a server.
fn open_server(protocol: ServerProtocol) -> String {
    let (option, name) = (protocol.option(), protocol.name());
    let protocol = constant(protocol);
    format!("open_server(RUNGC_SERVER_PROTOCOL_{protocol}, \"{option}\", \"{name}\", argv[++i])")
}

/// Name of a protocol in the runtime's header.
fn constant(protocol: ServerProtocol) -> &'static str {
    match protocol {
        ServerProtocol::ModbusTcp => "MODBUS_TCP",
        ServerProtocol::Mc => "MC",
        ServerProtocol::ProgrammingPort => "PROGRAMMING_PORT",
    }
}

/// Function of programs with an option that takes either; a pseudo-terminal is one of POSIX.
const IS_LINE: &str = "\
/* Returns true if a text is a serial device rather than an address. */
static bool is_line(const char *text)
{
    return PTYstrchr(text, '/') != NULL;
}
";

/// [`IS_LINE`], if the options call it.
fn is_line(options: &str) -> String {
    match options.contains("is_line(") {
        true => {
            let posix = IS_LINE.replace("PTY", "strcmp(text, \"pty\") == 0 || ");
            by_system(&IS_LINE.replace("PTY", ""), &posix) + "\n"
        }
        false => String::new(),
    }
}

/// The name of the length of a record of latched devices.
fn record_length(program: &str) -> String {
    format!("{}_RECORD_LENGTH", program.to_ascii_uppercase())
}

/// The servers over TCP of a host that has some; `options`: the statements that take options.
fn server_code(module: &Module, servers: bool, options: &str) -> String {
    if !servers {
        return String::new();
    }
    let family = format!("{:?}", module.model.ports).to_ascii_uppercase();
    let mut windows = template!("main_servers_windows.c").to_string();
    let mut posix = template!("main_servers.c").to_string();
    if clients::are_there(module, servers) {
        windows = [windows.as_str(), template!("main_clients_windows.c")].join("\n");
        posix = [posix, clients::code(module)].join("\n");
    }
    let code = by_system(&windows, &posix) + "\n";
    code.replace("FAMILY", &format!("RUNGC_PORTS_{family}"))
        .replace("TYPE_CODE", &module.model.type_code().to_string())
        .replace("MAX_CONNECTIONS", &MAX_CLIENTS.to_string())
        .replace("USUAL_CONNECTIONS", &USUAL_CLIENTS.to_string())
        .replace("IDLE_LIMIT", &IDLE_S.to_string())
        .replace("REQUEST_LIMIT", &REQUEST_S.to_string())
        .replace("HEADING", TABLE_HEADING)
        .replace("ROW,", &format!("\"{TABLE_ROW}\\n\","))
        + &is_line(options)
}

/// Format of a row in the table of connections.
const TABLE_ROW: &str = "%-21s  %-15s  %-16s  %8lu  %8lu  %8lu  %8lu";

/// The serial ports, and what drives them.
fn lines(module: &Module) -> String {
    if !module.has_ports() {
        return String::new();
    }
    let ports = module.ports.iter();
    let rows = ports.map(|port| format!("    {{.port = {port}, .file = -1, .client_end = -1}},\n"));
    let posix = template!("main_lines.c").replace("    /* LINES */\n", &rows.collect::<String>());
    let family = format!("{:?}", module.model.ports).to_ascii_uppercase();
    let code = by_system(template!("main_lines_windows.c"), &posix) + "\n";
    code.replace("FAMILY", &format!("RUNGC_PORTS_{family}"))
}

/// The hardware that the program asks, if it asks any.
fn hardware(clock: bool, ports: bool) -> String {
    let clock = if clock {
        ".clock = read_clock, .set_clock = set_clock"
    } else {
        ""
    };
    let ports = match ports {
        true => {
            ".set_line = set_line, .receive = receive, .send = send_character, .unsent = unsent"
        }
        false => "",
    };
    let (what, fields) = match (clock, ports) {
        ("", "") => return String::new(),
        (clock, "") => ("a clock", format!("{{{clock}}}")),
        ("", ports) => ("serial ports", format!("{{{ports}}}")),
        (clock, ports) => (
            "a clock and serial ports",
            format!("{{{clock},\n                                   {ports}}}"),
        ),
    };
    format!(
        "/* The hardware that the program asks: {what}. */\nstatic const rungc_hal hardware = {fields};\n\n"
    )
}

/// The rows of the instructions at which an error can occur.
fn instructions(module: &Module) -> String {
    let rows = module.origins.iter().map(|origin| {
        let text = text::string_literal(&origin.text);
        format!("    {{{}, {text}}},\n", origin.step)
    });
    rows.collect()
}

/// Devices that the PLC has, and whether it has the one to which an index leads.
const IS_MISSING: &str = "\
/* Devices that the PLC has, of the classes that the program names with an index. The last entry ends the table. */
static const struct {
    char letter;
    long first;
    long last;
} ranges[] = {
    /* RANGES */
    {'\\0', 0, 0},
};

/* Names the device to which an index leads, if the PLC does not have it; else false. */
static bool is_missing(char *name, size_t size, const char *letter, long first, long index)
{
    const long number = first + index;

    for (size_t i = 0; ranges[i].letter != '\\0'; i++) {
        if (ranges[i].letter == letter[0] && ranges[i].first <= number && number <= ranges[i].last) {
            return false;
        }
    }
    if (number < 0) {
        (void)snprintf(name, size, \"%s%ld with an index of %ld\", letter, first, index);
    } else if (letter[0] == 'X' || letter[0] == 'Y') {
        (void)snprintf(name, size, \"%s%03lo\", letter, (unsigned long)number);
    } else {
        (void)snprintf(name, size, \"%s%ld\", letter, number);
    }
    return true;
}

";

/// The function that names the device which an instruction with an index has not found.
fn missing_device(module: &Module, fields: &Storage) -> String {
    let mut cases = String::new();
    let mut classes = BTreeSet::new();
    for origin in &module.origins {
        let mut checks = Vec::new();
        for (device, index) in &origin.indexed {
            let mut register = String::new();
            if fields.access(&mut register, index.class, index.number) {
                let (letter, number) = (device.class.prefix(), device.number);
                checks.push(format!(
                    "is_missing(name, size, \"{letter}\", {number}, {register})"
                ));
                classes.insert(device.class);
            }
        }
        if !checks.is_empty() {
            let (step, checks) = (origin.step, checks.join(" || "));
            let _ = writeln!(cases, "    case {step}u:\n        return {checks};");
        }
    }
    let head = "\
/* Names a device that the instruction at a step has not found, as its index registers are now; false if it has all of them. */
static bool missing_device(const PROGRAM_plc *plc, unsigned step, char *name, size_t size)
{
";
    if cases.is_empty() {
        return format!(
            "{head}    (void)plc;\n    (void)step;\n    (void)name;\n    (void)size;\n    return false;\n}}\n\n"
        );
    }
    let mut ranges = String::new();
    for class in classes {
        let letter = &class.prefix()[..1];
        for (first, last) in module.model.runs(class) {
            let _ = writeln!(ranges, "    {{'{letter}', {first}, {last}}},");
        }
    }
    let is_missing = IS_MISSING.replace("    /* RANGES */\n", &ranges);
    format!(
        "{is_missing}{head}    switch (step) {{\n{cases}    default:\n        return false;\n    }}\n}}\n\n"
    )
}

/// The input terminals, and the effect of each turning on or off.
fn inputs_of(module: &Module, fields: &Storage) -> BTreeMap<u32, String> {
    let mut inputs: BTreeMap<u32, String> = BTreeMap::new();
    for (number, access) in terminals(fields, DeviceClass::X) {
        inputs.insert(number, format!("        {access} = on;\n"));
    }
    for number in rungc_emit::events::inputs(module) {
        let edge = format!("        {}_input_edge(plc, {number}, on);\n", module.name);
        inputs.entry(number).or_default().push_str(&edge);
    }
    inputs
}

/// The terminals that the program looks at, and the fields that they have.
pub fn terminals(fields: &Storage, class: DeviceClass) -> Vec<(u32, String)> {
    let numbers = fields.of_class(class).iter().flat_map(Field::numbers);
    numbers
        .map(|number| {
            let mut access = String::new();
            fields.access(&mut access, class, number);
            (number, access)
        })
        .collect()
}
