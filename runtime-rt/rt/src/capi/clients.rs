//! Clients of Modbus TCP, for hosts in C: what a table asks is made and understood here, the sockets are the host's.

use super::Map;
use super::map::elements;
use super::servers::Reply;
use crate::comm::modbus::client::{Client, ClientAction, ClientRow, Link};
use crate::comm::{Frame, Ports, Served};

/// The client of a server whose IP address ends in `part` begins.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_client_begin(client: &mut Client, family: Ports, part: u8) {
    *client = Client::new(family, part);
}

/// Next action of a client, `now_us` microseconds after an arbitrary origin; a request to be sent is in `request`.
/// `rows` are the `count` rows of the server, the same in each call. Call it between two scans.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_client_next(
    client: &mut Client,
    rows: *const ClientRow,
    count: u16,
    link: Link,
    now_us: u32,
    map: &mut Map,
    request: &mut Reply,
) -> ClientAction {
    let mut frame = Frame::new(&mut request.bytes);
    let rows = elements(rows, count.into());
    let action = client.next(rows, link, now_us, &mut Served::new(map, 0), &mut frame);
    request.length = frame.len() as u16;
    action
}

/// Takes a character that has come; `RUNGC_CLIENT_ACTION_CLOSE` if nothing that follows can be an answer.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_client_feed(
    client: &mut Client,
    rows: *const ClientRow,
    count: u16,
    byte: u8,
    now_us: u32,
    map: &mut Map,
) -> ClientAction {
    let rows = elements(rows, count.into());
    client.feed(rows, byte, now_us, &mut Served::new(map, 0))
}

/// The connection could not be opened, or has been closed by the server.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_client_lost(client: &mut Client, now_us: u32, map: &mut Map) {
    client.lost(now_us, &mut Served::new(map, 0));
}
