//! Servers talked to over real sockets, and dialogues over none.

use super::{Dialogue, Limits, Reaction, Server, ServerEvent};
use rungc_rt::comm::Map;
use rungc_rt::comm::service::{ServerProtocol, Service};
use rungc_rt::{Class, Ports};
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::thread;
use std::time::Duration;

/// A PLC that has 512 registers D and nothing else.
struct Registers {
    words: Vec<i16>,
    running: bool,
    requested: Option<bool>,
}

impl Registers {
    fn new() -> Self {
        Registers {
            words: vec![0; 512],
            running: true,
            requested: None,
        }
    }
}

impl Map for Registers {
    fn bit(&self, _: Class, _: u32) -> Option<bool> {
        None
    }

    fn set_bit(&mut self, _: Class, _: u32, _: bool) -> Option<()> {
        None
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        let words = (class == Class::D).then_some(&self.words)?;
        words.get(number as usize).copied()
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        let words = (class == Class::D).then_some(&mut self.words)?;
        words.get_mut(number as usize).map(|word| *word = value)
    }

    fn counter32(&self, _: u32) -> Option<i32> {
        None
    }

    fn set_counter32(&mut self, _: u32, _: i32) -> Option<()> {
        None
    }

    fn reset(&mut self, _: Class, _: u32) -> Option<()> {
        None
    }

    fn running(&self) -> bool {
        self.running
    }

    fn request_running(&mut self, running: bool) {
        self.running = running;
        self.requested = Some(running);
    }

    fn requested_running(&self) -> Option<bool> {
        self.requested
    }

    fn type_code(&self) -> u16 {
        24120
    }
}

/// A protocol as H2U speaks it.
fn service(protocol: ServerProtocol) -> Service {
    Service::new(protocol, Ports::Inovance, 24120)
}

const WRITE_D100: [u8; 12] = [0, 1, 0, 0, 0, 6, 1, 6, 0, 100, 0, 7];
const READ_D100: [u8; 12] = [0, 2, 0, 0, 0, 6, 1, 3, 0, 100, 0, 1];
const D100_IS_7: [u8; 11] = [0, 2, 0, 0, 0, 5, 1, 3, 2, 0, 7];

#[test]
fn requests_come_in_pieces_and_together() {
    let mut plc = Registers::new();
    let mut dialogue = Dialogue::new(service(ServerProtocol::ModbusTcp));
    let (begin, end) = WRITE_D100.split_at(5);
    assert_eq!(dialogue.receive(begin, &mut plc), Reaction::default());
    let rest = [end, &READ_D100, &READ_D100].concat();
    let reaction = dialogue.receive(&rest, &mut plc);
    let replies = [&WRITE_D100[..], &D100_IS_7, &D100_IS_7].concat();
    assert_eq!((reaction.reply, reaction.closes), (replies, false));
}

#[test]
fn what_is_no_request_ends_the_dialogue_after_what_was_asked_before() {
    let mut plc = Registers::new();
    let mut dialogue = Dialogue::new(service(ServerProtocol::ModbusTcp));
    let http = [&READ_D100[..], b"GET / HTTP/1.1\r\n"].concat();
    let reaction = dialogue.receive(&http, &mut plc);
    assert!(reaction.closes);
    assert_eq!(reaction.reply[..9], [0, 2, 0, 0, 0, 5, 1, 3, 2]);
    let mut mc = Dialogue::new(service(ServerProtocol::Mc));
    let reaction = mc.receive(b"GET / HTTP/1.1\r\n", &mut plc);
    assert_eq!(
        (&reaction.reply[..], reaction.closes),
        (&b"\xc7\x50"[..], true)
    );
    let mut mc = Dialogue::new(service(ServerProtocol::Mc));
    let reaction = mc.receive(b"06FF000A", &mut plc);
    assert_eq!((&reaction.reply[..], reaction.closes), (&b"8650"[..], true));
}

#[test]
fn a_programming_port_waits_for_the_next_request() {
    let mut plc = Registers::new();
    let mut dialogue = Dialogue::new(service(ServerProtocol::ProgrammingPort));
    let reaction = dialogue.receive(b"noise\x05", &mut plc);
    assert_eq!(
        (&reaction.reply[..], reaction.closes),
        (&b"\x06"[..], false)
    );
}

/// A server, and where it listens.
fn server(limits: Limits) -> (Server, SocketAddr) {
    let any = SocketAddr::from(([127, 0, 0, 1], 0));
    let server = Server::bind(any, service(ServerProtocol::ModbusTcp), limits).unwrap();
    let address = server.address().unwrap();
    (server, address)
}

/// Runs a client while the server is polled continuously. Returns the server's events.
fn while_served(
    server: &mut Server,
    plc: &mut Registers,
    client: impl FnOnce() + Send,
) -> Vec<ServerEvent> {
    thread::scope(|scope| {
        let client = scope.spawn(client);
        let mut events = Vec::new();
        while !client.is_finished() {
            events.extend(server.poll(plc).into_iter().map(|(_, event)| event));
            thread::sleep(Duration::from_millis(1));
        }
        client.join().unwrap();
        events
    })
}

fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(300)))
        .unwrap();
    stream
}

fn read(stream: &mut TcpStream, length: usize) -> Vec<u8> {
    let mut reply = vec![0; length];
    stream.read_exact(&mut reply).unwrap();
    reply
}

#[test]
fn clients_are_answered_over_sockets() {
    let (mut server, address) = server(Limits::default());
    let mut plc = Registers::new();
    while_served(&mut server, &mut plc, || {
        let [mut one, mut other] = [connect(address), connect(address)];
        one.write_all(&WRITE_D100).unwrap();
        assert_eq!(read(&mut one, 12), WRITE_D100);
        other.write_all(&READ_D100).unwrap();
        assert_eq!(read(&mut other, 11), D100_IS_7);
        other.write_all(b"GET / HTTP/1.1\r\n\r\n").unwrap();
        let mut rest = Vec::new();
        // Closed with unread bytes, a connection may also be reset.
        let _ = other.read_to_end(&mut rest);
        assert_eq!(rest, []);
    });
    assert_eq!(plc.words[100], 7);
}

/// Connects, sends half a request, and waits.
fn half_requests(address: SocketAddr, count: usize) -> Vec<TcpStream> {
    let half_request = |_| {
        let mut stream = connect(address);
        stream.write_all(&READ_D100[..6]).unwrap();
        stream
    };
    (0..count).map(half_request).collect()
}

#[test]
fn idle_connections_give_way() {
    let (mut server, address) = server(Limits {
        clients: 16,
        idle: Duration::ZERO,
        ..Limits::default()
    });
    let mut plc = Registers::new();
    plc.words[100] = 7;
    while_served(&mut server, &mut plc, || {
        let idle = half_requests(address, 40);
        let mut client = connect(address);
        client.write_all(&READ_D100).unwrap();
        assert_eq!(read(&mut client, 11), D100_IS_7);
        drop(idle);
    });
}

#[test]
fn newcomers_are_refused_rather_than_regular_clients_thrown_out() {
    let (mut server, address) = server(Limits {
        clients: 2,
        ..Limits::default()
    });
    let mut plc = Registers::new();
    plc.words[100] = 7;
    let events = while_served(&mut server, &mut plc, || {
        let mut regular = [connect(address), connect(address)];
        for stream in &mut regular {
            stream.write_all(&READ_D100).unwrap();
            assert_eq!(read(stream, 11), D100_IS_7);
        }
        for mut newcomer in half_requests(address, 3) {
            // Closed with unread bytes, a connection may also be reset.
            let mut rest = Vec::new();
            let _ = newcomer.read_to_end(&mut rest);
            assert_eq!(rest, []);
        }
        let [first, mut second] = regular;
        second.write_all(&READ_D100).unwrap();
        assert_eq!(read(&mut second, 11), D100_IS_7);
        drop(first);
        // There is room again as soon as the server has noticed.
        let answered = (0..10_000).any(|_| {
            let mut newcomer = connect(address);
            let mut reply = [0; 11];
            newcomer.write_all(&READ_D100).is_ok() && newcomer.read_exact(&mut reply).is_ok()
        });
        assert!(answered);
    });
    let refusals = events.iter().filter(|event| **event == ServerEvent::Full);
    assert_eq!(refusals.count(), 1);
}

/// The next request of a client that comes back is not the rest of one that its converter lost.
#[test]
fn an_incomplete_request_ends_its_connection() {
    let (mut server, address) = server(Limits {
        request: Duration::from_millis(50),
        ..Limits::default()
    });
    let mut plc = Registers::new();
    let events = while_served(&mut server, &mut plc, || {
        let mut stream = connect(address);
        stream.write_all(&READ_D100[..5]).unwrap();
        assert_eq!(stream.read(&mut [0]).unwrap(), 0);
        // A silent connection without one stays open.
        let mut stream = connect(address);
        thread::sleep(Duration::from_millis(200));
        stream.write_all(&READ_D100).unwrap();
        assert_eq!(read(&mut stream, 11).len(), 11);
    });
    let ServerEvent::Exchange(rejected) = &events[0] else {
        panic!("{events:?}");
    };
    assert!(rejected.rejected && rejected.request == READ_D100[..5]);
}

#[test]
fn a_client_that_does_not_read_is_cut_off() {
    let (mut server, address) = server(Limits::default());
    let mut plc = Registers::new();
    let read_125 = [0, 2, 0, 0, 0, 6, 1, 3, 0, 0, 0, 125];
    while_served(&mut server, &mut plc, || {
        let mut stream = connect(address);
        stream
            .set_write_timeout(Some(Duration::from_secs(300)))
            .unwrap();
        // 260 bytes come back for each 12; buffers of the system take some megabytes.
        assert!((0..1_000_000).any(|_| stream.write_all(&read_125).is_err()));
    });
}

/// The last answer arrives, and the connection is not reset, however much follows the request.
#[test]
fn a_lost_connection_ends_in_order() {
    let (mut server, address) = server(Limits::default());
    let mut plc = Registers::new();
    plc.words[100] = 7;
    while_served(&mut server, &mut plc, || {
        let mut stream = connect(address);
        let requests = [&READ_D100[..], &[b'G'; 6000]].concat();
        stream.write_all(&requests).unwrap();
        let mut received = Vec::new();
        stream.read_to_end(&mut received).unwrap();
        assert_eq!(received, D100_IS_7);
    });
}

/// A request whose length is wrong must not hide commands (remote STOP, `14 FF 0A 00`) in what follows it.
#[test]
fn nothing_after_a_wrong_length_is_carried_out() {
    let stop = [0x14, 0xff, 0x0a, 0];
    let head = [0x50, 0, 0, 0xff, 0xff, 3, 0];
    for body in [
        &[0x01, 0, 0x0a][..],
        &[0x06, 0, 4, 0, 1, 4, 0, 0],
        &[0, 0],
        // Write of two words with one.
        &[0x0e, 0, 4, 0, 1, 0x14, 0, 0, 100, 0, 0, 0xa8, 2, 0, 1, 0],
    ] {
        let mut dialogue = Dialogue::new(service(ServerProtocol::Mc));
        let mut plc = Registers::new();
        let reaction = dialogue.receive(&[&head, body, &stop].concat(), &mut plc);
        assert!(reaction.closes && plc.running, "{body:x?}");
        assert_eq!(reaction.reply[..2], [0xd0, 0]);
    }
    let in_ascii = b"500000FF03FF000004000A14FF0A00";
    let mut plc = Registers::new();
    let reaction = Dialogue::new(service(ServerProtocol::Mc)).receive(in_ascii, &mut plc);
    assert!(reaction.closes && plc.running);
}

#[test]
fn who_stops_the_plc_is_known() {
    let mut dialogue = Dialogue::new(service(ServerProtocol::Mc));
    let mut plc = Registers::new();
    let requests = b"14FF000A01FF000A442000000064010014FF000A13FF000A13FF000A";
    let reaction = dialogue.receive(requests, &mut plc);
    let switched: Vec<_> = reaction.exchanges.iter().map(|it| it.running).collect();
    // STOP in STOP and RUN in RUN switch nothing.
    assert_eq!(switched, [Some(false), None, None, Some(true), None]);
    // Nor does what is not a request.
    let reaction = dialogue.receive(b"14FF000AG", &mut plc);
    let switched: Vec<_> = reaction.exchanges.iter().map(|it| it.running).collect();
    assert_eq!(switched, [Some(false), None]);
}
