//! Servers over TCP, for hosts in C: what a connection says is carried out here, the sockets are the host's.

use super::{Map, Request};
use crate::comm::mode::is_answering;
use crate::comm::service::{Connection, FeedResult, LONGEST_REPLY, Service};
use crate::comm::{Frame, Ports, Served};

/// The answer to a request.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Reply {
    /// RUN or STOP, if the request asks for it.
    pub request: Request,
    /// RUN or STOP, if the request switches the PLC to it, by a command or by special relays.
    pub switched: Request,
    /// Length in characters; 0: the request is not answered.
    pub length: u16,
    /// Its characters.
    pub bytes: [u8; LONGEST_REPLY],
}

/// A connection begins.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_connect(connection: &mut Connection, service: Service) {
    *connection = Connection::new(service);
}

/// Takes a character that has come over a connection. If it is the last of a request, that is carried out and answered
/// in `reply`. Call it between two scans.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_feed(
    connection: &mut Connection,
    map: &mut Map,
    byte: u8,
    reply: &mut Reply,
) -> FeedResult {
    let mut frame = Frame::new(&mut reply.bytes);
    let mut served = Served::new(map, connection.service().type_code);
    let result = connection.feed(byte, &mut served, &mut frame);
    let switched = connection.switched().filter(|_| result != FeedResult::More);
    reply.length = frame.len() as u16;
    reply.request = Request::of(served.take_request());
    reply.switched = Request::of(switched);
    result
}

/// Returns true if a request has begun over a connection, and is not whole.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_is_receiving(connection: &Connection) -> bool {
    connection.is_receiving()
}

/// Returns true if a PLC of this family is in RUN, or goes there when the next scan begins, and stays there.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_will_run(map: &mut Map, family: Ports) -> bool {
    family.will_run(&Served::new(map, 0))
}

/// Returns true if a frame is being sent over a port, or waits to be.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_is_answering(map: &mut Map, port: u8) -> bool {
    is_answering(map, port)
}
