//! `rungc serve --page`: the live page in a browser, who may ask for it, and requests that mean harm.

use crate::common::{HANG, chromium, folder, rungc, soon, text};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

const PROGRAM: &str = "\
;! X000 = start button
;! Y000 = main contactor of the conveyor
; Latch of the motor
LD X000
OR M0
ANI X001
OUT M0
; Run-up
LD M0
OUT T0 K30
AND T0
OUT Y000
LD X002
MPS
AND X003
MOV K5 D0
MPP
ANDP X004
INC D1
LD>= D1 K3
AND M8013
OUT Y001
END
";

/// A run with a page, until it is dropped.
struct Page {
    child: Child,
    url: String,
    /// Open for as long as the run, which writes to it.
    errors: BufReader<ChildStderr>,
    _folder: TempDir,
}

impl Page {
    fn open(args: &[&str]) -> Page {
        Page::of(PROGRAM, args)
    }

    fn of(program: &str, args: &[&str]) -> Page {
        Page::with(program, &[], args)
    }

    /// A page of a program with more files.
    fn with(program: &str, files: &[(&str, &[u8])], args: &[&str]) -> Page {
        let program = ("motor.il", program.as_bytes());
        let files: Vec<_> = files.iter().copied().chain([program]).collect();
        let folder = folder(&files);
        let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["serve", "motor.il", "--page"])
            .args(args)
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut errors = BufReader::new(child.stderr.take().unwrap());
        let mut lines = errors.by_ref().lines().map_while(Result::ok);
        let url = lines.find_map(|line| Some(line.strip_prefix("rungc: page at ")?.to_string()));
        let url = url.expect("the run has a page");
        Page {
            child,
            url,
            errors,
            _folder: folder,
        }
    }

    /// `127.0.0.1:PORT`, and the path with the token.
    fn parts(&self) -> (&str, &str) {
        let address = self.url.strip_prefix("http://").unwrap();
        address.split_at(address.find('/').unwrap())
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.parts().0).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        stream
    }

    /// Answer to these bytes: the status, and the rest.
    fn ask(&self, request: &[u8]) -> (u16, String) {
        let mut stream = self.connect();
        // A server that rejects a request may close the connection before all of it is sent.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8(answer).unwrap();
        let status = answer.split(' ').nth(1);
        let status = status.and_then(|status| status.parse().ok());
        (status.unwrap_or_else(|| panic!("{answer:?}")), answer)
    }

    /// The status of a GET of this name with these headers.
    fn get(&self, name: &str, headers: &str) -> u16 {
        let path = self.parts().1;
        self.ask(format!("GET {path}{name} HTTP/1.1\r\n{headers}\r\n").as_bytes())
            .0
    }

    /// The status of a command, with these headers.
    fn command(&self, body: &str, headers: &str) -> u16 {
        let (host, path) = self.parts();
        let length = body.len();
        let request = format!(
            "POST {path}command HTTP/1.1\r\nHost: {host}\r\nContent-Length: {length}\r\n{headers}\r\n{body}"
        );
        self.ask(request.as_bytes()).0
    }

    /// Sends a command that is carried out.
    fn order(&self, body: &str) {
        assert_eq!(self.command(body, JSON), 200, "{body}");
    }

    /// Contents of a page that is opened now.
    fn look(&self) -> Value {
        let (host, path) = self.parts();
        let mut stream = self.connect();
        let request = format!("GET {path}events HTTP/1.1\r\nHost: {host}\r\n\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut lines = BufReader::new(stream).lines().map_while(Result::ok);
        let is_frame = |line: &String| line.starts_with("data: {");
        let data = lines
            .find(is_frame)
            .map(|line| line["data: ".len()..].to_string());
        serde_json::from_str(&data.expect("an event comes")).unwrap()
    }

    /// Contents of a page while the run is paused after scan `scan`.
    fn look_at(&self, scan: u64) -> Value {
        let mut seen = Value::Null;
        soon(&format!("scan {scan} comes"), || {
            seen = self.look();
            seen["state"]["scans"] == scan && !seen["state"]["paused"].is_null()
        });
        seen
    }

    /// The header that names this page.
    fn host(&self) -> String {
        format!("Host: {}\r\n", self.parts().0)
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const JSON: &str = "Content-Type: application/json\r\n";
const PAUSE: &str = r#"{"do":"pause"}"#;

#[test]
fn a_live_page_works_in_a_browser() {
    let page = Page::open(&[]);
    let Some(mut report) = chromium::report(&page.url, "live.js") else {
        return;
    };
    for measured in ["loaded_ms", "requests"] {
        report[measured].take();
    }
    let expected = json!({
        "loaded_ms": null,
        "before": 3,
        "forced": "X000\t1\tRelease",
        "marks": 1,
        "timer": "T0=",
        "set": "7",
        "problem": "`Q9` is not a device name; examples: `M0`, `X010`, `D0.i32`",
        "scanned": 1,
        "broken": "Y000 = 1 ×",
        "back": "0",
        "again": 0,
        "light": [],
        "dark": [],
        "slower": "RUN, 10 × slower",
        "paused_wider_than_screen": false,
        "network": ["n1"],
        "reason": "RUN, paused: power reaches an output of network 1",
        "stopped": 0,
        "moved": [],
        "unseen": [],
        "networks": 5,
        "found": 1,
        "narrow": [],
        "wider_than_screen": false,
        "elsewhere": [],
        "log": [
            "X000 forced to 1",
            "D1 set to 7",
            "X000 released",
            "breakpoint: Y000 = 1",
            "back at scan",
            "breakpoint: Y000 = 1",
            "X001 forced to 1",
            "X001 released",
            "X001 set to 0",
            "breakpoint: power reaches an output of network 1",
            "X000 forced to 1",
            "X000 released",
            "X000 set to 0",
            "STOP",
            "RUN",
            "D1 set to 9",
        ],
        "requests": null,
        "errors": [],
    });
    assert_eq!(report, expected);
}

/// The slide of the book, which drills three holes, in front of a page.
fn slide() -> Page {
    let machine = include_bytes!(concat!(
        env!("RUNGC_ROOT"),
        "/examples/programs/drill.machine.toml"
    ));
    let program = include_str!(concat!(env!("RUNGC_ROOT"), "/examples/programs/drill.il"));
    let args = ["--machine", "drill.machine.toml"];
    Page::with(program, &[("drill.machine.toml", machine)], &args)
}

#[test]
fn the_axes_of_a_machine_move_on_a_page() {
    let page = slide();
    let Some(mut report) = chromium::report(&page.url, "axes.js") else {
        return;
    };
    for measured in ["loaded_ms", "requests"] {
        report[measured].take();
    }
    insta::assert_snapshot!(serde_json::to_string_pretty(&report).unwrap());
}

/// Checks that a page shows the same in a browser named by a variable, if any, as in any other.
fn shows_in(browser: &str, variable: &str) {
    if std::env::var_os(variable).is_none() {
        eprintln!("skipped: {variable} names no browser (see .ci/run)");
        return;
    }
    let page = slide();
    let Some(report) = chromium::report(&page.url, &format!("{browser}.js")) else {
        return;
    };
    assert_eq!(report["browser"], browser);
    insta::assert_snapshot!(browser, serde_json::to_string_pretty(&report).unwrap());
}

#[test]
fn a_live_page_works_in_firefox() {
    shows_in("firefox", "RUNGC_FIREFOX");
}

#[test]
fn a_live_page_works_in_webkit() {
    shows_in("webkit", "RUNGC_WEBKIT");
}

/// Counts, times, remembers edges, and shifts what an input gives.
const STEPS: &str = "\
LD M8000
INC D0
LD M8013
OUT C0 K30000
LDI T0
OUT T0 K7
LDP T0
ADD D1 D0 D1
LDP X000
MOV D0 D2
LDF M8012
MEP
OUT M5
LD M8012
SFTL X000 M100 K16 K1
END
";

#[test]
fn a_run_goes_back_and_repeats_itself() {
    let page = Page::of(
        STEPS,
        &["--watch", "D0,D1,D2,T0,C0,K4M100", "--model", "fx3u"],
    );
    page.order(PAUSE);
    let scans = |seen: &Value| seen["state"]["scans"].as_u64().unwrap();
    let begin = scans(&page.look());
    let forward = |count: u64| page.order(&format!(r#"{{"do":"scan","count":{count}}}"#));
    let back = |count: u64| page.order(&format!(r#"{{"do":"back","count":{count}}}"#));
    forward(130);
    let middle = begin + 130;
    page.look_at(middle);
    page.order(r#"{"do":"force","device":"X0","value":1}"#);
    let mut seen = Vec::new();
    for scan in middle + 1..=middle + 20 {
        forward(1);
        seen.push(page.look_at(scan));
    }
    // One scan at a time, and in a leap, with all that the page shows, edges among it.
    let same = |scan: u64| {
        let (then, now) = (&seen[(scan - middle - 1) as usize], page.look_at(scan));
        for part in ["networks", "watch", "forces"] {
            assert_eq!(now[part], then[part], "{part} of scan {scan}");
        }
        assert_eq!(now["state"]["ms"], then["state"]["ms"]);
    };
    for scan in (middle + 1..middle + 20).rev() {
        back(1);
        same(scan);
    }
    forward(19);
    same(middle + 20);
    back(140);
    let early = page.look_at(middle + 20 - 140);
    assert_eq!(early["forces"], json!([]));
    for count in [0, 1_000_000] {
        let body = format!(r#"{{"do":"back","count":{count}}}"#);
        assert_eq!(page.command(&body, JSON), 422, "{count}");
    }
}

#[test]
fn errors_and_frames_are_in_the_log() {
    let program = "LD M8000\nDIV D0 D1 D2\nEND\n";
    let mut page = Page::of(program, &["--modbus-tcp", "0"]);
    let mut line = String::new();
    page.errors.read_line(&mut line).unwrap();
    let address = line.trim_end().strip_prefix("rungc: Modbus TCP at ");
    let mut client = TcpStream::connect(address.unwrap()).unwrap();
    let write = [0, 1, 0, 0, 0, 6, 1, 6, 0, 100, 0, 7];
    client.write_all(&write).unwrap();
    client.read_exact(&mut [0; 12]).unwrap();
    page.order(r#"{"do":"scan","count":3}"#);
    let seen = (0..100).map(|_| page.look());
    let mut seen = seen.skip_while(|seen| seen["state"]["paused"].is_null());
    let seen = seen.next().expect("time stands still");
    let log = seen["log"].as_array().unwrap();
    let of = |kind: &str| {
        let mut entries = log.iter().filter(|entry| entry["kind"] == kind);
        let text = entries.next().map(|entry| entry["text"].as_str());
        text.flatten().unwrap_or_default()
    };
    assert!(of("error").contains("error 6706"), "{seen}");
    assert!(
        of("frame").contains("00 01 00 00 00 06 01 06 00 64 00 07"),
        "{seen}"
    );
}

/// A program of 16,000 steps: most of it rests, a tenth of its networks changes ten times a second.
fn large() -> String {
    let mut list = String::new();
    for i in 0..1070 {
        let (a, b, x) = (i % 1000, (i * 7 + 3) % 1000, i % 128);
        let _ = write!(
            list,
            "LD M{a}\nOR M{b}\nLDP X{x:o}\nANB\nMPS\nANI M{b}\nMOV K{i} D{a}\nMPP\nOUT M{}\n",
            a + 1000
        );
        if i % 10 == 0 {
            let _ = write!(list, "LD M8012\nANDP M8011\nINC D{}\n", a + 1000);
        }
    }
    list + "END\n"
}

#[test]
fn a_page_of_16000_steps_is_sent_what_changes() {
    let page = Page::of(&large(), &[]);
    let html = page
        .ask(format!("GET {} HTTP/1.1\r\n{}\r\n", page.parts().1, page.host()).as_bytes())
        .1;
    let steps = html
        .split(" steps, ")
        .next()
        .unwrap()
        .rsplit(' ')
        .next()
        .unwrap();
    let steps: u32 = steps.parse().unwrap();
    assert!((15_000..17_000).contains(&steps), "{steps}");
    let (host, path) = page.parts();
    let mut stream = page.connect();
    let request = format!("GET {path}events HTTP/1.1\r\nHost: {host}\r\n\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    let lines = BufReader::new(stream).lines().map_while(Result::ok);
    let data = lines.filter(|line| line.starts_with("data: {"));
    let sizes: Vec<usize> = data.take(30).map(|line| line.len()).collect();
    // First all networks, then those that have changed: at most the tenth that counts.
    assert!(sizes[0] > 20_000, "{sizes:?}");
    assert!(
        sizes[1..].iter().all(|&size| size < sizes[0] / 3),
        "{sizes:?}"
    );
}

#[test]
fn only_the_page_itself_may_ask() {
    let page = Page::open(&[]);
    let (host, path) = page.parts();
    let port = host.rsplit_once(':').unwrap().1;
    let named = page.host();
    assert_eq!(page.get("", &named), 200);
    assert_eq!(page.get("", &format!("Host: LOCALHOST:{port}\r\n")), 200);
    assert_eq!(page.get("live.js", &named), 200);
    assert_eq!(page.get("other.js", &named), 404);
    assert_eq!(page.get("command", &named), 404);
    for elsewhere in [
        "Host: evil.example\r\n",
        &format!("Host: evil.example:{port}\r\n"),
        "Host: 127.0.0.1\r\n",
        &format!("Host: 127.0.0.1:+{port}\r\n"),
        &format!("Host: 127.0.0.1:0{port}\r\n"),
        &format!("Host: 127.0.0.1: {port}\r\n"),
        "",
    ] {
        assert_eq!(page.get("", elsewhere), 403, "{elsewhere}");
    }
    let origin = |origin: &str| page.command(PAUSE, &format!("{JSON}Origin: {origin}\r\n"));
    assert_eq!(origin(&format!("http://{host}")), 200);
    assert_eq!(origin(&format!("http://localhost:{port}")), 403);
    assert_eq!(origin("http://evil.example"), 403);
    assert_eq!(origin("null"), 403);
    assert_eq!(page.command(PAUSE, "Content-Type: text/plain\r\n"), 415);
    assert_eq!(page.command(PAUSE, ""), 415);
    assert_eq!(page.command("{\"do\":\"explode\"}", JSON), 422);
    assert_eq!(
        page.command("{\"do\":\"set\",\"device\":\"X9\",\"value\":1}", JSON),
        422
    );
    // The token with another last character.
    let (rest, last) = path.trim_end_matches('/').split_at(path.len() - 2);
    let wrong = format!("{rest}{}/", if last == "0" { "1" } else { "0" });
    for path in ["/", "//", "/live.js", &wrong, "/../..", "*"] {
        let request = format!("GET {path} HTTP/1.1\r\n{named}\r\n");
        assert_eq!(page.ask(request.as_bytes()).0, 403, "{path}");
    }
    let answer = page
        .ask(format!("GET {path} HTTP/1.1\r\n{named}\r\n").as_bytes())
        .1;
    assert!(answer.contains("Content-Security-Policy: default-src 'none';"));
}

#[test]
fn a_page_that_is_read_only_takes_no_commands() {
    let page = Page::open(&["--read-only"]);
    assert_eq!(page.command(PAUSE, JSON), 403);
    assert_eq!(page.get("", &page.host()), 200);
}

#[test]
fn a_page_that_is_read_only_offers_no_commands() {
    let page = Page::open(&["--read-only"]);
    let Some(report) = chromium::report(&page.url, "read_only.js") else {
        return;
    };
    assert_eq!(report["buttons"], json!(["Light or dark"]));
    assert_eq!(report["inputs"], 0);
    assert_eq!(report["light"], json!([]));
    assert_eq!(report["errors"], json!([]));
}

#[test]
fn a_page_is_for_this_machine_alone() {
    let folder = folder(&[("motor.il", PROGRAM.as_bytes())]);
    let out = rungc(folder.path(), &["serve", "motor.il", "--page", "0.0.0.0:0"]);
    assert_eq!(out.status.code(), Some(2));
    insta::assert_snapshot!(text(&out.stderr));
}

#[test]
fn requests_that_mean_harm_are_rejected() {
    let page = Page::open(&[]);
    let (host, path) = page.parts();
    let get = |headers: &str| page.get("", &format!("Host: {host}\r\n{headers}\r\n"));
    assert_eq!(get(&format!("A: {}", "b".repeat(100_000))), 431);
    let many: Vec<_> = (0..200).map(|n| format!("A{n}: b")).collect();
    assert_eq!(get(&many.join("\r\n")), 431);
    assert_eq!(get("Host: evil.example"), 400);
    assert_eq!(get("Transfer-Encoding: chunked"), 400);
    assert_eq!(get("Content-Length: 99999999999999999999"), 400);
    assert_eq!(get("Content-Length: 1000000"), 413);
    assert_eq!(page.ask(b"\xff\xfe\x00\x01\r\n\r\n").0, 400);
    assert_eq!(page.ask(b"GET / HTTP/1.1\r\nHost: \xc3\x28\r\n\r\n").0, 400);
    let put = format!("PUT {path} HTTP/1.1\r\nHost: {host}\r\n\r\n");
    assert_eq!(page.ask(put.as_bytes()).0, 405);
    for body in ["", "{", "[]", "null", "\"\u{0}\"", &"[".repeat(4000)] {
        assert_eq!(page.command(body, JSON), 422, "{body}");
    }
    assert_eq!(
        page.command("{\"do\":\"scan\",\"count\":4294967296}", JSON),
        422
    );
    assert_eq!(
        page.command("{\"do\":\"set\",\"device\":\"D0\",\"value\":1e400}", JSON),
        422
    );
}

/// Commands for a device that is not there, by what is forced and watched, and for one that each scan sets: 200 or 422.
#[test]
fn what_is_not_forced_or_watched_is_not_released() {
    let page = Page::open(&[]);
    let json = JSON.replace("application/json", "APPLICATION/JSON");
    for (command, status) in [
        (r#""release","device":"M0""#, 422),
        (r#""force","device":"K4M0","value":9"#, 200),
        (r#""force","device":"K4M0","value":8"#, 200),
        (r#""force","device":"M15","value":1"#, 422),
        (r#""force","device":"M16","value":1"#, 200),
        (r#""force","device":"D10.i32","value":9"#, 200),
        (r#""force","device":"D11","value":9"#, 422),
        (r#""set","device":"D0..D3","value":9"#, 422),
        (r#""release","device":"K4M0""#, 200),
        (r#""force","device":"M15","value":1"#, 200),
        (r#""watch","device":"D77""#, 200),
        (r#""unwatch","device":"D77""#, 200),
        (r#""unwatch","device":"D77""#, 422),
        (r#""force","device":"M8000","value":0"#, 422),
        (r#""force","device":"K1M8010","value":0"#, 422),
        (r#""set","device":"M8013","value":1"#, 422),
        (r#""force","device":"D8013","value":5"#, 422),
        (r#""force","device":"M8015","value":1"#, 200),
        (r#""force","device":"D8013","value":5"#, 200),
        (r#""force","device":"M8034","value":1"#, 200),
    ] {
        let body = format!(r#"{{"do":{command}}}"#);
        assert_eq!(page.command(&body, &json), status, "{command}");
    }
}

#[test]
fn slow_clients_hold_up_neither_the_run_nor_others() {
    let page = Page::open(&[]);
    let (host, path) = page.parts();
    // These dribble; one watches and reads nothing.
    let mut slow: Vec<_> = (0..20).map(|_| page.connect()).collect();
    for stream in &mut slow {
        stream.write_all(b"GET / HTTP/1.1\r\nX: ").unwrap();
    }
    let mut deaf = page.connect();
    let events = format!("GET {path}events HTTP/1.1\r\nHost: {host}\r\n\r\n");
    deaf.write_all(events.as_bytes()).unwrap();
    let interval = Duration::from_millis(500);
    slow[0].set_read_timeout(Some(interval)).unwrap();
    let mut answer = Vec::new();
    // Idle connections are closed after the time-out.
    soon("a slow client is closed", || {
        for stream in &mut slow {
            let _ = stream.write_all(b"a");
        }
        assert_eq!(page.get("", &page.host()), 200);
        match slow[0].read_to_end(&mut answer) {
            Err(error) => !matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut),
            Ok(_) => true,
        }
    });
    let answer = text(&answer);
    assert!(answer.is_empty() || answer.contains("408"), "{answer}");
    assert_eq!(page.command(PAUSE, JSON), 200);
    // A crowd that sends nothing gives way.
    let silent: Vec<_> = (0..40).map(|_| page.connect()).collect();
    for _ in 0..10 {
        assert_eq!(page.get("", &page.host()), 200);
    }
    drop(silent);
    // More pages than there may be are sent away, and those that are there stay.
    // One whose request has not been read yet gives way as if it were silent, so they keep coming.
    let mut crowd = Vec::new();
    soon("more are sent away", || {
        let mut stream = page.connect();
        let _ = stream.write_all(events.as_bytes());
        crowd.push(stream);
        page.get("", &page.host()) == 503
    });
    drop(crowd);
    soon("the crowd has gone", || page.get("", &page.host()) == 200);
}
