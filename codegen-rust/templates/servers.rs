
/// Returns true if a value is a serial device rather than an address.
fn is_line(value: &str) -> bool {
    value.contains('/')
}

/// Opens the server that an option names: `--modbus-tcp 5020`.
fn open_server(servers: &mut Servers, protocol: ServerProtocol, value: &str) -> Result<(), String> {
    let at = address(value).ok_or("an address is written 127.0.0.1:5020, [::1]:5020 or 5020")?;
    let service = Service::new(protocol, Ports::FAMILY, TYPE_CODE);
    let name = protocol.name();
    let opened = servers.open(service, at);
    let at = opened.map_err(|error| cannot_serve(protocol, at, &error))?;
    report!("{name} at {at}");
    Ok(())
}

/// Sets how many connections a server has at once: `--clients 64`.
fn limit_clients(servers: &mut Servers, value: &str) -> Result<(), String> {
    let clients = value.parse().ok().filter(|count| (1..=MAX_CLIENTS).contains(count));
    servers.set_clients(clients.ok_or_else(|| format!("a number of connections from 1 to {MAX_CLIENTS}"))?);
    Ok(())
}
