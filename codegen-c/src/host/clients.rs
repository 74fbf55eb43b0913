//! Requests of a host to servers over TCP.

use crate::template;
use rungc_ir::Module;
use rungc_models::runs::rt_class;
use rungc_rt::comm::service::ServerProtocol;
use rungc_syntax::NetworkRequest;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::net::{IpAddr, SocketAddr};

/// Calls in the main program: before the first scan, before each, after the last one.
const CALLS: [&str; 3] = [
    "    begin_clients();\n",
    "        poll_clients(plc, (uint32_t)(begin - start));\n",
    "    print_clients();\n",
];

/// Returns true if a host with servers is also a client of others.
pub fn are_there(module: &Module, servers: bool) -> bool {
    servers && !module.requests.is_empty()
}

/// Calls in the main program, if there are any clients: before the first scan, before each, after the last one.
pub fn calls(module: &Module, servers: bool) -> [&'static str; 3] {
    match are_there(module, servers) {
        true => CALLS,
        false => [""; 3],
    }
}

/// The tables of what a host asks, and what asks it.
pub fn code(module: &Module) -> String {
    let mut by_server: BTreeMap<SocketAddr, Vec<&NetworkRequest>> = BTreeMap::new();
    for request in &module.requests {
        by_server.entry(request.server).or_default().push(request);
    }
    let (mut rows, mut servers) = (String::new(), String::new());
    let mut first = 0;
    for (server, requests) in by_server {
        let (host, port) = (server.ip(), server.port());
        let part = match host {
            IpAddr::V4(host) => host.octets()[3],
            IpAddr::V6(host) => host.octets()[15],
        };
        let count = requests.len();
        // Writing to a String does not fail.
        let _ = writeln!(
            servers,
            "    {{.host = \"{host}\", .port = \"{port}\", .part = {part}, .first = {first}, .count = {count}, .file = -1}},"
        );
        first += count;
        requests
            .into_iter()
            .for_each(|request| row(&mut rows, request));
    }
    template!("main_clients.c")
        .replace("    /* ROWS */\n", &rows)
        .replace("    /* SERVERS */\n", &servers)
        .replace("MODBUS_TCP", ServerProtocol::ModbusTcp.name())
}

fn row(rows: &mut String, request: &NetworkRequest) {
    let NetworkRequest {
        unit,
        function,
        address,
        count,
        buffer,
        trigger,
        ..
    } = request;
    let class = rt_class(trigger.class).map_or_else(String::new, |class| format!("{class:?}"));
    let number = trigger.number;
    // Writing to a String does not fail.
    let _ = writeln!(
        rows,
        "    {{.trigger = RUNGC_CLASS_{}, .number = {number}, .unit = {unit}, .function = {function}, .address = {address}, \
         .count = {count}, .buffer = {buffer}}},",
        class.to_ascii_uppercase()
    );
}
