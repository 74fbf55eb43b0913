//! Descriptions, and drivers of files.

use super::*;
use rungc_rt::Class;
use std::fs;

/// Errors of a connection, one per line: key, message, help.
fn errors(pairs: &[(&str, &str)]) -> String {
    let errors = Connection::read("plant", pairs).expect_err("a mistake is found");
    let lines = errors.iter().map(|mistake| {
        let key = mistake.pair.map_or("-", |pair| pairs[pair].0);
        format!("{key}: {}", mistake.message)
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn a_connection_of_all_keys() {
    let pairs = [
        ("modbus-tcp", "10.0.0.5"),
        ("unit", "3"),
        ("every", "1s"),
        ("timeout", "250"),
        ("fault", "M100"),
        ("loss", "hold"),
        ("X010-X017", "read inputs 4"),
        ("Y000-Y037", "write registers 0"),
        ("D0-D3", "read registers 10 loss -5"),
    ];
    let connection = Connection::read("plant", &pairs).unwrap();
    assert_eq!((connection.every_ms, connection.timeout_ms), (1000, 250));
    assert_eq!(connection.unit(), Ok(3));
    assert_eq!(connection.fault, Some((Class::M, 100)));
    assert_eq!(
        (connection.values(true), connection.values(false)),
        (12, 32)
    );
    let rows = connection.rows.iter();
    let rows: Vec<_> = rows
        .map(|row| (row.devices(), row.place.clone(), row.loss))
        .collect();
    let expected = [
        ("X010-X017", 0..8, None),
        ("Y000-Y037", 0..32, None),
        ("D0-D3", 8..12, Some(-5)),
    ];
    assert_eq!(
        rows,
        expected.map(|(devices, place, loss)| (devices.to_string(), place, loss))
    );
}

#[test]
fn mistakes_of_a_connection() {
    assert!(errors(&[("every", "5")]).starts_with("-: a connection has one of `modbus-tcp`"));
    assert_eq!(
        errors(&[("modbus-tcp", "a")]),
        "-: a connection without devices"
    );
    for (end, why) in [
        (" ", "`mqtt` is empty"),
        ("h:0", "`0` is not a port"),
        ("h:99999", "`99999` is not a port"),
        ("h:", "`` is not a port"),
        (":5", "`:5` names no host"),
    ] {
        let expected = format!("mqtt: {why}");
        assert_eq!(errors(&[("mqtt", end), ("X0", "read a")]), expected);
    }
    for end in ["h", "h:1883", "::1", "[::1]:1883", "10.0.0.5:65535"] {
        let pairs = [("modbus-tcp", end), ("X0", "read coils 0")];
        assert!(Connection::read("plant", &pairs).is_ok(), "{end}");
    }
    let console = [("console", "false"), ("X0", "read")];
    assert_eq!(errors(&console), "console: `console` is `true`");
    let empty = [("files", ""), ("X0", "read a")];
    assert_eq!(errors(&empty), "files: `files` is empty");
    let broker = |key, value| errors(&[("mqtt", "h"), ("X0", "read a"), (key, value)]);
    assert_eq!(broker("client", ""), "client: `client` is empty");
    assert_eq!(
        broker("status", "a/#"),
        "status: `a/#` is not the topic of one value"
    );
    assert_eq!(
        broker("password-file", "p"),
        "-: `password-file` needs `user`"
    );
    let rows = [
        ("modbus-tcp", "a"),
        ("unit", "248"),
        ("every", "5h"),
        ("fault", "D0"),
        ("loss", "7"),
        ("baud", "9600"),
        ("Q0", "read inputs 0"),
        ("X7-X0", "read inputs 0"),
        ("X10", "inputs 0"),
        ("Y0", "read coils 0"),
        ("Y1", "write inputs 0"),
        ("Y2", "write coils 0 loss 1"),
        ("X20", "read inputs 0 loss 2"),
        ("D0", "read coils 0"),
        ("D1-D200", "read registers 0"),
        ("D300-D301", "read registers 65535"),
    ];
    let expected = "\
unit: `unit` is 0 to 247
every: `5h` is not from 1ms to 1h
fault: `D0` is not a bit device Y, M or S
loss: `loss` is \"zero\" or \"hold\"
baud: a connection by modbus-tcp has no key `baud`
Q0: `Q0` is not a range of devices
X7-X0: `X7-X0` is not a range of devices
X10: `inputs 0` is neither `read` nor `write`
Y0: `Y0` cannot be read
Y1: `inputs 0` is not an end of a row by modbus-tcp
Y2: `loss` is for devices that are read
X20: the value after `loss` is 0 to 1
D0: coils and inputs are bits, but the devices are words
D1-D200: a row has at most 125 of them; divide it
D300-D301: the last address is 65535";
    assert_eq!(errors(&rows), expected);
}

#[test]
fn connections_of_a_text() {
    let text = "\
[project]
model = 'h2u'
[io.valves] # a station
modbus-tcp = \"10.0.0.5:502\"   # its address
unit = 2
X000-X007 = 'read inputs 0'
[io.lamps]
files = \".\"
\"Y000\" = \"write lamp\"
[check]
allow = [
  \"W0203\"
]
";
    let connections = parse(text).unwrap();
    let names: Vec<_> = connections
        .iter()
        .map(|c| (&*c.name, c.kind, &*c.end))
        .collect();
    let expected = [
        ("valves", Kind::ModbusTcp, "10.0.0.5:502"),
        ("lamps", Kind::Files, "."),
    ];
    assert_eq!(names, expected);
    for (text, why) in [
        ("", "there is no table `[io.NAME]`"),
        ("[io.a]\nfiles\n", "line 2: write `key = \"value\"`"),
        ("[io.a]\nfiles = \"x\n", "line 2: write `key = \"value\"`"),
        (
            "[io.a]\nfiles = { a = 1 }\n",
            "line 2: write `key = \"value\"`",
        ),
        (
            "[io.a]\n\nfiles = '.'\nX0 = 'write'\n",
            "line 4: `` is not an end of a row by files",
        ),
        (
            "[io.a]\nfiles = '.'\nX0 = 'read a'\nfault = 'M0'\n[io.b]\nfiles = '.'\nM0-M7 = 'read b'\n",
            "line 7: `M0` takes its value from two places",
        ),
        (
            "[io.a]\nfiles = '.'\nX0 = 'read a'\nD0 = 'write b'\nfault = 'X0'\n",
            "line 5: `X0` is not a bit device Y, M or S",
        ),
        (
            "[io.a]\nfiles = '.'\nM0 = 'read a'\nfault = 'M0'\n",
            "line 4: `M0` takes its value from two places",
        ),
        (
            "[io.a]\nmqtt = 'h'\nY0 = 'write a'\nY1-Y2 = 'write b/{}'\nstatus = 'b/Y001'\n",
            "line 4: `b/Y001` takes its value from two rows",
        ),
        (
            "[io.a]\nmqtt = 'h'\nX0 = 'read a'\nstatus = 's'\n[io.b]\nmqtt = 'h'\nX1 = 'read a'\nstatus = 's'\n",
            "line 8: `s` takes its value from two rows",
        ),
        (
            "[io.a]\nfiles = '.'\nY0 = 'write a'\n[io.b]\nfiles = '.'\nX0 = 'read b'\nY1 = 'write a'\n",
            "line 7: `a` takes its value from two rows",
        ),
    ] {
        let messages = parse(text).unwrap_err();
        // Before what helps.
        assert_eq!(messages.split("; ").next(), Some(why), "{text}");
    }
}

#[test]
fn a_place_is_written_by_one_row() {
    let rows = |kind: &str, rows: &[(&str, &str)]| {
        let end = if kind == "console" { "true" } else { "x" };
        let pairs: Vec<_> = [(kind, end)].iter().chain(rows).copied().collect();
        let connection = Connection::read("a", &pairs).unwrap();
        overlap(&[connection], None).map(|overlap| (overlap.message, overlap.part))
    };
    let twice = |place: &str| {
        Some((
            format!("`{place}` takes its value from two rows"),
            Part::Row(1),
        ))
    };
    let pair = |a, b| [("Y000-Y007", a), ("Y010-Y017", b)];
    let modbus = |a, b| rows("modbus-tcp", &pair(a, b));
    assert_eq!(modbus("write coils 0", "write coils 8"), None);
    assert_eq!(modbus("write coils 0", "write registers 0"), None);
    assert_eq!(modbus("write coils 0", "write coils 7"), twice("coils 7"));
    assert_eq!(
        modbus("write registers 3", "write registers 3"),
        twice("registers 3")
    );
    let mqtt = |a, b| rows("mqtt", &pair(a, b));
    assert_eq!(mqtt("write lamp/{}", "write lamp/{}"), None);
    assert_eq!(mqtt("write lamp", "write lamp"), twice("lamp"));
    assert_eq!(mqtt("write {}", "write Y003"), twice("Y003"));
    let same = [("Y000-Y007", "write {}"), ("Y003", "write {}")];
    assert_eq!(rows("mqtt", &same), None);
    let lines = [("Y000", "write 4"), ("Y001", "write 4 active-low")];
    assert_eq!(rows("gpio", &lines), twice("line 4"));
    let console = [("Y000", "write"), ("Y001", "write")];
    assert_eq!(rows("console", &console), None);
}

/// A driver of files in a new folder.
fn files(folder: &str, pairs: &[(&str, &str)]) -> (Connection, Box<dyn Driver>) {
    let pairs: Vec<_> = [("files", folder)].iter().chain(pairs).copied().collect();
    let connection = Connection::read("plant", &pairs).unwrap();
    let driver = files::open_folder(&connection).unwrap();
    (connection, driver)
}

#[test]
fn files_are_read_and_written() {
    let folder = std::env::temp_dir().join(format!("rungc-io-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let rows = [
        ("X000-X002", "read switches"),
        ("D0", "read speed"),
        ("D10-D11", "write state"),
    ];
    let (connection, mut driver) = files(folder.to_str().unwrap(), &rows);
    let mut inputs = [0; 4];
    let mut exchange =
        |inputs: &mut [i16], outputs: [i16; 2]| driver.exchange(&connection, inputs, &outputs);
    let put = |name: &str, text: &[u8]| fs::write(folder.join(name), text).unwrap();
    let missing = exchange(&mut inputs, [0; 2]);
    assert!(matches!(missing, Err(ExchangeError::Refused(why)) if why.starts_with("switches: ")));
    put("switches", b"1 0\n1 rest\n");
    put("speed", b"65535");
    assert_eq!(exchange(&mut inputs, [-1, 7]), Ok(()));
    assert_eq!(inputs, [1, 0, 1, -1]);
    let state = || fs::read_to_string(folder.join("state")).unwrap();
    assert_eq!(state(), "-1 7\n");
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| (0..5_000).all(|_| !state().is_empty()));
        let mut count = 0;
        while !reader.is_finished() {
            count += 1;
            assert_eq!(exchange(&mut inputs, [-count % 300, 7]), Ok(()));
        }
        assert!(reader.join().unwrap(), "a reader found no value");
    });
    assert_eq!(exchange(&mut inputs, [0, 7]), Ok(()));
    assert_eq!(state(), "0 7\n");
    // What follows the numbers is reported once.
    assert_eq!(
        driver.reports(),
        ["switches: `rest` after 3 numbers is left out"]
    );
    assert_eq!(driver.reports(), [""; 0]);
    let mut exchange =
        |inputs: &mut [i16], outputs: [i16; 2]| driver.exchange(&connection, inputs, &outputs);
    for text in [&b"70000"[..], b"", b"x", b"\xff\xfe"] {
        put("speed", text);
        assert!(exchange(&mut inputs, [0; 2]).is_err(), "{text:?}");
    }
    assert_eq!(inputs[3], -1);
    fs::remove_dir_all(&folder).unwrap();
}

/// Outputs change while an input is rejected, and are off at the end.
#[test]
fn a_row_that_is_rejected_keeps_no_other_from_its_turn() {
    let folder = std::env::temp_dir().join(format!("rungc-io-refused-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let pairs = [
        ("files", folder.to_str().unwrap()),
        ("X000", "read missing"),
        ("Y000-Y001", "write lamps"),
        ("every", "1ms"),
    ];
    let connection = Connection::read("plant", &pairs).unwrap();
    let mut io = Io::start(vec![connection], |_| Ok(files::open_folder)).unwrap();
    let lamps = || fs::read_to_string(folder.join("lamps")).unwrap_or_default();
    let until = std::time::Instant::now() + std::time::Duration::from_secs(20);
    while lamps() != "1 1\n" && std::time::Instant::now() < until {
        io.give_rows(&mut |_, _, _, values| values.fill(1));
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    assert_eq!(lamps(), "1 1\n");
    let messages = io.end();
    assert!(
        messages.iter().all(|line| line.contains(": missing: ")),
        "{messages:?}"
    );
    assert_eq!(lamps(), "0 0\n");
    fs::remove_dir_all(&folder).unwrap();
}

/// A slave that rejects reads of registers, and answers those of coils with one byte too many.
struct Picky;

impl modbus::Wire for Picky {
    fn request(&mut self, request: &[u8]) -> std::io::Result<Vec<u8>> {
        let mut reply = match request[1] {
            0x03 => vec![1, 0x83, 2],
            0x01 => vec![1, 1, 2, 0xff, 0xff],
            0x02 => vec![1, 2, 1, 0x01],
            _ => request[..6].to_vec(),
        };
        reply.extend(rungc_rt::comm::modbus::crc16(&reply).to_le_bytes());
        Ok(reply)
    }
}

#[test]
fn a_slave_that_rejects_a_request_gets_the_others() {
    let all = [
        ("D0", "read registers 7"),
        ("X000", "read coils 0"),
        ("X001", "read inputs 0"),
        ("Y000", "write coils 0"),
    ];
    let exchanged = |rows: &[(&str, &str)]| {
        let pairs: Vec<_> = [("modbus-tcp", "h")].iter().chain(rows).copied().collect();
        let connection = Connection::read("plant", &pairs).unwrap();
        let mut inputs = vec![0; connection.values(true)];
        let mut remote = modbus::Remote::new(Picky, &connection).unwrap();
        let result = remote.exchange(&connection, &mut inputs, &[1]);
        (
            inputs.last().copied(),
            result.map_err(|why| format!("{why:?}")),
        )
    };
    let refused = |why: &str| Err(format!("Refused({why:?})"));
    let rejected = "D0: the station rejects the request with exception 2";
    assert_eq!(exchanged(&all), (Some(1), refused(rejected)));
    let wrong = "X000: the answer does not fit: its length";
    assert_eq!(exchanged(&all[1..]), (Some(1), refused(wrong)));
    assert_eq!(exchanged(&all[2..]), (Some(1), Ok(())));
}

#[test]
fn payloads_are_taken_or_left_out_with_a_reason() {
    let pairs = [
        ("mqtt", "127.0.0.1"),
        ("X000-X001", "read hall/{}"),
        ("D10", "read speed"),
        ("D20-D21", "read recipe"),
    ];
    let connection = Connection::read("broker", &pairs).unwrap();
    let mut inputs = [0; 5];
    let mut left_out = LeftOut::default();
    let mut take = |topic: &str, payload: &str| {
        topics::take(
            &connection,
            topic,
            payload.as_bytes(),
            &mut inputs,
            &mut left_out,
        );
        (left_out.reports(), inputs)
    };
    for (topic, payload) in [
        ("hall/X000", "ON"),
        ("hall/X001", " true "),
        ("speed", "65535"),
        ("recipe", "[1]"),
        ("recipe", "{\"D21\": 7, \"batch\": \"a\"}"),
        ("speed", ""),
        ("other", "x"),
    ] {
        assert!(take(topic, payload).0.is_empty(), "{topic} {payload}");
    }
    let word = "takes a whole number from -32768 to 65535";
    for (topic, payload, why) in [
        ("speed", "abc", format!("D10 {word}")),
        ("speed", "65536", format!("D10 {word}")),
        ("speed", "1.5", format!("D10 {word}")),
        (
            "hall/X001",
            "2",
            "X001 takes 0, 1, true, false, on or off".to_string(),
        ),
        ("recipe", "[8, null]", format!("D21 {word}")),
        ("recipe", "[8, 9, 3]", "the row has 2 values".to_string()),
        (
            "recipe",
            "{\"D20\": 9, \"D21\": 70000}",
            format!("D21 {word}"),
        ),
        (
            "recipe",
            "{\"d20\": 9}",
            "it names no device of the row, such as D20".to_string(),
        ),
        (
            "recipe",
            "5",
            "several values are written `{\"D20\": 1}` or `[1, 0]`".to_string(),
        ),
    ] {
        let report = format!("{topic}: `{payload}` is left out: {why}");
        assert_eq!(take(topic, payload), (vec![report], [1, 1, -1, 1, 7]));
        assert!(take(topic, payload).0.is_empty(), "each is reported once");
    }
}

#[test]
fn lines_of_standard_input_are_taken_or_left_out_with_a_reason() {
    let pairs = [
        ("console", "true"),
        ("X000-X007", "read"),
        ("D10", "read"),
        ("Y000", "write"),
    ];
    let connection = Connection::read("panel", &pairs).unwrap();
    assert_eq!(connection.place(), "standard input and output");
    let mut inputs = [0; 9];
    for line in ["X007=1", " x001 = 1 ", "D10=65535", "", "d10=-32768"] {
        assert_eq!(
            files::take(&connection, line, &mut inputs),
            Ok(()),
            "{line}"
        );
    }
    assert_eq!(inputs, [0, 1, 0, 0, 0, 0, 0, 1, -32768]);
    for (line, why) in [
        ("help", "a line is written `X000=1`"),
        ("X008=1", "`X008` is not a device"),
        ("X0-X3=1", "`X0-X3` is not a device"),
        ("Y000=1", "this connection does not read Y000"),
        ("D0=1", "this connection does not read D0"),
        ("X000=2", "the value is 0 or 1"),
        ("D10=65536", "the value is -32768 to 65535"),
        ("D10=1.5", "the value is -32768 to 65535"),
    ] {
        let left_out = files::take(&connection, line, &mut inputs);
        assert_eq!(left_out, Err(format!("`{line}` is left out: {why}")));
    }
    let long = files::take(&connection, &"\u{1b}".repeat(99), &mut inputs).unwrap_err();
    assert!(
        long.contains("\\u{1b}…`") && !long.contains('\u{1b}'),
        "{long}"
    );
    assert_eq!(inputs, [0, 1, 0, 0, 0, 0, 0, 1, -32768]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_until_there_is_room() {
    let (connection, mut driver) = files("/dev", &[("Y000", "write full")]);
    for _ in 0..2 {
        let Err(ExchangeError::Refused(why)) = driver.exchange(&connection, &mut [], &[1]) else {
            panic!("/dev/full takes something");
        };
        assert!(why.starts_with("full: "), "{why}");
    }
}
