//! The main program for a host: scans in real time.

use crate::Options;
use crate::generate::Generator;
use crate::template;
use rungc_emit::cycle;
use rungc_emit::usage::{self, Host, Takes};
use rungc_ir::Module;
use rungc_ir::node::Origin;
use rungc_models::plc_errors::{self, PlcError};
use rungc_models::runs::rt_class;
use rungc_rt::comm::service::ServerProtocol;
use rungc_syntax::text::one_line;
use rungc_syntax::{DeviceClass, NetworkRequest};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Imports of a host with serial ports from the standard library and the runtime.
const LINES_USES: [&str; 6] = [
    "rungc_host::io::{SerialPort, cannot_open}",
    "rungc_host::servers::switched_by_line",
    "rungc_rt::comm::{LineFormat, Received, Served}",
    "std::io::{self, BufRead, Read, Write}",
    "std::sync::mpsc::{self, Receiver, SendError, Sender}",
    "std::time::{Duration, Instant}",
];

/// Imports of a host without ports.
const USES: [&str; 3] = [
    "std::io::{self, BufRead, Read, Write}",
    "std::sync::mpsc::{self, Receiver}",
    "std::time::{Duration, Instant}",
];

/// Statement that makes a program report its operation errors.
const REPORT: &str = "    plc.on_error = Some(report_error);\n";

/// Imports of error reports.
const ERROR_USES: [&str; 2] = ["std::collections::BTreeSet", MUTEX];

/// Import shared by error reports and connections.
const MUTEX: &str = "std::sync::Mutex";

/// Imports of connections.
const OUTSIDE_USES: [&str; 2] = [
    "rungc_host::io::{Environment, Of}",
    "std::sync::{LazyLock, MutexGuard, PoisonError}",
];

/// Imports of servers.
const SERVERS_USES: [&str; 2] = [
    "rungc_host::servers::{Servers, Switch, cannot_serve}",
    "rungc_rt::comm::service::{MAX_CLIENTS, Service, ServerProtocol, address}",
];

/// Imports of clients of other servers.
const CLIENTS_USES: [&str; 2] = [
    "rungc_host::servers::Clients",
    "rungc_rt::comm::modbus::client::ClientRow",
];

/// `src/main.rs` of a crate.
pub fn main_file(generator: &Generator, crate_name: &str, options: &Options) -> String {
    let Options { servers, io, .. } = *options;
    let module = generator.module;
    let wait = match (module.takes_events(), module.has_ports()) {
        (false, _) => WAIT,
        (true, false) => WAIT_WITH_EVENTS,
        (true, true) => WAIT_WITH_LINES,
    };
    let (period, overrun) = match cycle::constant_scan(module, &generator.storage) {
        Some(_) => (CONSTANT_PERIOD, "    let mut overrun = false;\n"),
        None => (PERIOD, ""),
    };
    let [set, follow] = match cycle::uses_clock(module) {
        true => CLOCK,
        false => [""; 2],
    };
    let exchange = if module.has_ports() { EXCHANGE } else { "" };
    let keeps = cycle::keeps_any(module);
    let [end, leave] = if keeps { END } else { [""; 2] };
    let [poll, connections] = if servers {
        [POLL, CONNECTIONS]
    } else {
        [""; 2]
    };
    let has_partners = servers || module.has_ports();
    let [partner, stopped_by] = if has_partners { PARTNER } else { [""; 2] };
    let asks = servers && !module.requests.is_empty();
    let [ask, asked] = if asks { [ASK, ASKED] } else { [""; 2] };
    let serve = format!("{follow}{poll}{ask}{exchange}");
    let host = Host {
        lines: &["/dev/ttyUSB0"],
        servers,
        io,
    };
    let text = usage::lines(module, &host).join("\n") + "\n";
    let names = usage::options(module, &host).into_iter();
    let names: Vec<_> = names.map(|option| format!("{:?}", option.name)).collect();
    let (report, on_error) = match module.may_fail() {
        true => (REPORT, template!("host_errors.rs")),
        false => ("", ""),
    };
    let mut code = environment(io)
        .replace("USES;\n", &uses(generator, crate_name, options))
        .replace("    REPORT;\n", report)
        .replace("ON_ERROR;\n", on_error);
    // There is something to do at the end.
    let in_order = servers || keeps || io;
    let [catch, stopped] = if in_order { INTERRUPTED } else { [""; 2] };
    let parts = [
        (module.has_ports(), template!("lines.rs")),
        (servers, template!("servers.rs")),
        (io, template!("environment.rs")),
        (in_order, template!("signals.rs")),
    ];
    code.extend(parts.iter().filter(|part| part.0).map(|part| part.1));
    code.extend(asks.then(|| requests(module)));
    code.replace("        PERIOD;\n", period)
        .replace("    OVERRUN;\n", overrun)
        .replace("    CATCH;\n", catch)
        .replace("        STOPPED;\n", stopped)
        .replace("    CLOCK;\n", set)
        .replace("    OPEN;\n", &open(module, &host))
        .replace("        SERVE;\n", &serve)
        .replace("    CONNECTIONS;\n", &[connections, asked].concat())
        .replace("    PARTNER;\n", partner)
        .replace("        STOPPED_BY;\n", stopped_by)
        .replace("        SAVE;\n", &save(keeps, options.unsaved))
        .replace("    END;\n", end)
        .replace("    LEAVE;\n", leave)
        .replace("OPTION_NAMES", &names.join(", "))
        .replace("        WAIT;\n", wait)
        .replace("FAMILY", &format!("{:?}", module.model.ports))
        .replace("TYPE_CODE", &module.model.type_code().to_string())
        .replace("TYPE", &generator.type_name.to_string())
        // Texts of the program come last: they may contain any word.
        .replace("ERROR_TABLE", &errors(module))
        .replace("USAGE_TEXT", &format!("{text:?}"))
        .replace("INSTRUCTION_TABLE", &instructions(module))
        .replace("OUTPUT_TABLE", &outputs(generator))
}

/// The codes of the operation errors that the program can have, with their titles.
fn errors(module: &Module) -> String {
    let row = |error: &PlcError| format!("\n    ({}, {:?}),", error.code, error.title);
    let errors = plc_errors::of_programs(module.model.id);
    errors.filter(|_| module.may_fail()).map(row).collect()
}

/// The program around a PLC, with what it does for connections.
fn environment(io: bool) -> String {
    let [commands, take, give, leave, report_line, show_line] = match io {
        true => CONNECTED,
        false => ALONE,
    };
    template!("host.rs")
        .replace("        SERVE;\n", &format!("        SERVE;\n{take}"))
        .replace("        GIVE;\n", give)
        .replace("COMMANDS;", commands)
        .replace("    REPORT_LINE;\n", report_line)
        .replace("    SHOW_LINE;\n", show_line)
        .replace("    CONNECTIONS;\n", &format!("    CONNECTIONS;\n{leave}"))
}

/// The rows of the outputs that a run shows.
fn outputs(generator: &Generator) -> String {
    let mut table = String::new();
    for field in generator.storage.of_class(DeviceClass::Y) {
        for number in field.first..field.end() {
            // Outputs that send pulses would be printed all the time.
            if generator.module.pulse_outputs.contains(&number) {
                continue;
            }
            let comment = generator
                .device_comment(DeviceClass::Y, number)
                .unwrap_or_default();
            let name = DeviceClass::Y.number(number).to_string();
            let _ = write!(
                table,
                "\n    ({number}, {name:?}, {:?}),",
                one_line(comment)
            );
        }
    }
    if !table.is_empty() {
        table.push('\n');
    }
    table
}

/// Imports from the standard library and the runtime.
fn uses(generator: &Generator, crate_name: &str, options: &Options) -> String {
    let Options { servers, io, .. } = *options;
    let module = generator.module;
    let wall = "rungc_host::wall::WallClock";
    let of_clock = cycle::uses_clock(module).then_some(&wall);
    let ports = module.has_ports();
    let usual = USES.iter().filter(|_| !ports);
    let of_lines = LINES_USES.iter().filter(|_| ports);
    let of_servers = SERVERS_USES.iter().filter(|_| servers);
    let asks = servers && !module.requests.is_empty();
    let of_clients = CLIENTS_USES.iter().filter(|_| asks);
    let retain = "rungc_host::retain::RetainFile";
    let of_retain = cycle::keeps_any(module).then_some(&retain);
    let all = usual
        .chain(of_lines)
        .chain(of_servers)
        .chain(of_clients)
        .chain(of_retain)
        .chain(of_clock)
        .chain(OUTSIDE_USES.iter().chain([&MUTEX]).filter(|_| io));
    let mut all: BTreeSet<_> = all.map(|name| (*name).to_string()).collect();
    all.insert(format!("{crate_name}::{}", generator.type_name));
    if ports || servers {
        all.insert("rungc_rt::Ports".to_string());
    }
    if module.may_fail() {
        all.extend(ERROR_USES.map(String::from));
    }
    all.insert("rungc_rt::{Class, LastError, Plc, Program, Stop, VirtualHal}".to_string());
    let lines = all.into_iter().map(|name| format!("use {name};\n"));
    lines.collect()
}

/// The statements that do what the options ask for.
fn open(module: &Module, host: &Host) -> String {
    let options = usage::options(module, host);
    if options.is_empty() {
        return String::from("    options();\n");
    }
    let mut text = String::new();
    if cycle::keeps_any(module) {
        text.push_str("    let mut retained: Option<RetainFile> = None;\n");
    }
    if module.has_ports() {
        text.push_str("    let mut lines = Vec::new();\n");
    }
    if host.servers {
        text.push_str("    let mut servers = Servers::new();\n");
        if !module.requests.is_empty() {
            text.push_str(CLIENTS);
        }
    }
    let arms = options.iter().map(|option| {
        let does = match option.takes {
            Takes::Line => {
                "Line::connect(&mut plc, &value).map(|line| lines.push(line))".to_string()
            }
            Takes::Retained => {
                "RetainFile::begin(&value, &mut plc, |text| report(&text)).map(|file| retained = Some(file))".to_string()
            }
            Takes::Io => "environment().describe(&value)".to_string(),
            Takes::Log => "environment().log(&value)".to_string(),
            Takes::Clients => "limit_clients(&mut servers, &value)".to_string(),
            Takes::Address(protocol) => open_server(protocol),
            Takes::AddressOrLine(protocol, port) => {
                let open = open_server(protocol);
                format!(
                    "match is_line(&value) {{
                true => Line::of_port(&mut plc, {port}, &value).map(|line| lines.push(line)),
                false => {open},
            }}"
                )
            }
        };
        format!("            {:?} => {does},\n", option.name)
    });
    let arms: String = arms.collect();
    text + "    for (option, value) in options() {\n        let done = match option.as_str() {\n"
        + &arms
        + OPENED
        + if host.io { BEGUN } else { "" }
}

/// Creation of the clients of other servers.
const CLIENTS: &str = "    let requests = REQUESTS.iter().filter_map(|(server, row)| Some((server.parse().ok()?, *row)));
    let mut clients = Clients::new(Ports::FAMILY, requests);
";

/// The call that opens a server.
fn open_server(protocol: ServerProtocol) -> String {
    format!("open_server(&mut servers, ServerProtocol::{protocol:?}, &value)")
}

/// End of the loop over options.
const OPENED: &str = "            _ => Ok(()),
        };
        if let Err(error) = done {
            report!(\"{option} {value}: {error}\");
            std::process::exit(2);
        }
    }
";

/// Start of a host with connections.
const BEGUN: &str = "    let begun = environment().begin(&plc);
    if let Err(why) = begun {
        report!(\"{why}\");
        std::process::exit(2);
    }
";

/// Parts of a host without connections: the source of commands, before a scan, after one, at the end, and the macros
/// for reports and output.
const ALONE: [&str; 6] = [
    "commands();",
    "",
    "",
    "",
    "    let _ = writeln!(io::stderr(), \"{line}\");\n",
    "    let _ = writeln!(io::stdout(), \"{line}\");\n",
];

/// The same with connections.
const CONNECTED: [&str; 6] = [
    "match environment().takes_input() {
        true => mpsc::sync_channel(0).1,
        false => commands(),
    };",
    "        environment().read_inputs(&mut Of(&mut plc, &mut hal));\n",
    "        environment().write_outputs(&mut Of(&mut plc, &mut hal));\n",
    "    environment().end();\n",
    "    environment().report(line);\n",
    "    let _ = writeln!(io::stdout(), \"{line}\");\n    environment().log_line(line);\n",
];

/// Latched devices are saved after a scan; a device shows that they cannot be.
fn save(keeps: bool, unsaved: Option<(DeviceClass, u32)>) -> String {
    if !keeps {
        return String::new();
    }
    let device = unsaved.and_then(|(class, number)| Some((rt_class(class)?, number)));
    device.map_or(SAVE.to_string(), |(class, number)| {
        let show = format!("let _ = plc.set_bit(Class::{class:?}, {number}, file.fails());");
        SAVE_AND_SHOW.replace("SHOW;", &show)
    })
}

const SAVE: &str = "        if let Some(file) = &mut retained
            && let Some(message) = file.keep(&plc, now_ms)
        {
            report(&message);
        }
";

const SAVE_AND_SHOW: &str = "        if let Some(file) = &mut retained {
            if let Some(message) = file.keep(&plc, now_ms) {
                report(&message);
            }
            SHOW;
        }
";

/// After the last scan, and at the very end.
const END: [&str; 2] = [
    "    let retained = retained.map_or(Ok(()), |file| file.end(&plc));
    if let Err(why) = &retained {
        report(why);
    }
",
    "    if retained.is_err() {
        std::process::exit(1);
    }
",
];

/// Before the first scan, and before each: a signal ends the run in order.
const INTERRUPTED: [&str; 2] = [
    "    signals::catch();\n",
    "        if signals::stopped() {\n            break;\n        }\n",
];

/// Transfer of received characters to the ports.
const EXCHANGE: &str =
    "        partner = advance(&mut plc, &mut hal, &mut lines, start, now_ms).or(partner);\n";

/// Last mode that a partner has switched the PLC to; a STOP by it that is reported is not one by the program.
const PARTNER: [&str; 2] = [
    "    let mut partner: Option<bool> = None;\n",
    "        if partner == Some(false) && plc.last_error().stop == Stop::Program {
            stop = Stop::Program;
        }
        partner = partner.filter(|_| !plc.sys().running);
",
];

/// Clients are answered between two scans.
const POLL: &str = "        let Switch { requested, reported } = servers.poll(&mut plc, report);
        if let Some(running) = requested {
            plc.set_running(running);
        }
        partner = reported.or(partner);
";

/// The table of connections, at the end.
const CONNECTIONS: &str = "    for row in servers.table() {
        report!(\"{row}\");
    }
";

/// Servers are polled between two scans.
const ASK: &str = "        clients.poll(&mut plc, |_| {});\n";

/// Report of the clients' traffic, at the end.
const ASKED: &str = "    for row in clients.table() {
        report!(\"{row}\");
    }
";

/// The table of what the program asks.
fn requests(module: &Module) -> String {
    let rows = module.requests.iter().filter_map(|request| {
        let NetworkRequest {
            server,
            unit,
            function,
            address,
            count,
            buffer,
            trigger,
        } = request;
        let (class, number) = (rt_class(trigger.class)?, trigger.number);
        Some(format!(
            "    (\"{server}\", ClientRow {{ trigger: Class::{class:?}, number: {number}, unit: {unit}, function: {function}, \
             address: {address}, count: {count}, buffer: {buffer} }}),\n"
        ))
    });
    let rows: String = rows.collect();
    format!(
        "\n/// What the program asks of servers over TCP.\nconst REQUESTS: &[(&str, ClientRow)] = &[\n{rows}];\n"
    )
}

/// The rows of the instructions at which an error can occur.
fn instructions(module: &Module) -> String {
    let mut rows = String::new();
    for Origin {
        step,
        text,
        indexed,
    } in &module.origins
    {
        let indexed = indexed.iter().map(|(device, index)| {
            let [class, index_class] = [device.class, index.class].map(|c| format!("Class::{c:?}"));
            format!(
                "({class}, {:?}, {}, {index_class}, {})",
                device.class.prefix(),
                device.number,
                index.number
            )
        });
        let indexed = indexed.collect::<Vec<_>>().join(", ");
        let text = one_line(text);
        let _ = write!(rows, "\n    ({step}, {text:?}, &[{indexed}]),");
    }
    if !rows.is_empty() {
        rows.push('\n');
    }
    rows
}

/// Start of the next scan.
const PERIOD: &str = "        next += SCAN;\n";

/// Start of the next scan if a constant scan time may be requested.
const CONSTANT_PERIOD: &str = "        let constant_us = plc.constant_scan_ms().map(|ms| u32::from(ms) * 1000);
        next = match constant_us {
            None => next + SCAN,
            Some(us) if scan_us <= us => {
                scan_us = us;
                next + Duration::from_micros(us.into())
            }
            Some(us) => {
                if !overrun {
                    report!(\"a scan took {scan_us} us, longer than the constant scan time of {us} us\");
                }
                overrun = true;
                Instant::now()
            }
        };
";

/// The program's clock starts with that of the computer, and follows it.
const CLOCK: [&str; 2] = [
    "    let mut wall = WallClock::begin(&mut hal);\n",
    "        wall.follow(&mut hal, (begin - start).as_millis() as u64);\n",
];

/// Wait for the next scan.
const WAIT: &str = "        std::thread::sleep(next.saturating_duration_since(Instant::now()));\n";

/// Interruptible wait for the next scan.
const WAIT_WITH_EVENTS: &str = "\
        while Instant::now() < next {
            std::thread::sleep(Duration::from_millis(1).min(next - Instant::now()));
            plc.tick(&mut hal, start.elapsed().as_millis() as u32);
            plc.take_interrupts(&mut hal);
        }
";

/// The same with serial ports.
const WAIT_WITH_LINES: &str = "\
        while Instant::now() < next {
            std::thread::sleep(Duration::from_millis(1).min(next - Instant::now()));
            let now_ms = start.elapsed().as_millis() as u32;
            hal.advance_to(now_ms);
            partner = advance(&mut plc, &mut hal, &mut lines, start, now_ms).or(partner);
            plc.take_interrupts(&mut hal);
        }
";
