//! `[io.NAME]` with brokers: mosquitto is killed and comes back while `rungc serve` runs. `.ci/run` installs it; where
//! it is not, the tests say so, unless `RUNGC_REQUIRE_PEERS` is set.

use crate::common::mosquitto::{self, Ends, broker, is_there, open_to_all};
use crate::common::{folder, free_port, soon};
use crate::connected::Form;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

const PROGRAM: &str = "\
LD X000
OUT Y000
LD M100
OUT Y010
LD M8000
INC D0
MOV D10 D20
END
";

/// Connections of the program: PORT is that of the broker. Files show what happens while it is away.
const SETTINGS: &str = "\
[project]
program = 'p.il'
model = 'fx3u'

[io.broker]
mqtt = '127.0.0.1:PORT'
fault = 'M100'
every = '10ms'
status = 'plant/status'
user = 'plc'
password-file = 'password'
X000 = 'read plant/start'
X001-X002 = 'read plant/switch/{}'
D10-D11 = 'read plant/recipe'
Y000 = 'write plant/motor'
Y001-Y002 = 'write plant/lamp/{}'
D20-D21 = 'write plant/state'

[io.files]
files = '.'
Y010 = 'write lost'
D0 = 'write scans'
D20 = 'write recipe'
";

const USER: Option<(&str, &str)> = Some(("plc", "secret"));

fn publish(port: u16, topic: &str, payload: &str) {
    mosquitto::publish(port, USER, topic, payload);
}

/// The value of a topic that is kept by the broker.
fn topic(port: u16, topic: &str) -> String {
    let options = ["-C", "1", "-W", "5", "-t", topic];
    let shown = mosquitto::subscribe(port, USER, &options);
    shown.trim().to_string()
}

fn shows(port: u16, name: &str, payload: &str) {
    soon(&format!("{name} is {payload}"), || {
        topic(port, name) == payload
    });
}

/// Contents written by a row of files.
fn file(folder: &Path, name: &str) -> String {
    let text = fs::read_to_string(folder.join(name)).unwrap_or_default();
    text.trim().to_string()
}

/// The program continues.
fn scans(folder: &Path) {
    let before = file(folder, "scans");
    soon("scans continue", || file(folder, "scans") != before);
}

/// Values go both ways.
fn works(folder: &Path, port: u16, recipe: i16) {
    soon("the broker is there", || file(folder, "lost") == "0");
    shows(port, "plant/status", "online");
    publish(port, "plant/start", "on");
    shows(port, "plant/motor", "1");
    publish(
        port,
        "plant/recipe",
        &format!("{{\"D10\": {recipe}, \"D99\": 1}}"),
    );
    shows(
        port,
        "plant/state",
        &format!("{{\"D20\":{recipe},\"D21\":0}}"),
    );
    shows(port, "plant/lamp/Y001", "0");
    // Invalid values change nothing.
    for wrong in ["", "2", "[", "{\"X000\": 0}", "999999999999999999999"] {
        publish(port, "plant/start", wrong);
    }
    publish(port, "plant/recipe", "70000");
    // What comes after them has arrived, so they have, too.
    for recipe in [recipe + 100, recipe] {
        publish(port, "plant/recipe", &format!("{{\"D10\": {recipe}}}"));
        let state = format!("{{\"D20\":{recipe},\"D21\":0}}");
        shows(port, "plant/state", &state);
    }
    shows(port, "plant/motor", "1");
    publish(port, "plant/start", "false");
    shows(port, "plant/motor", "0");
    publish(port, "plant/start", "1");
    shows(port, "plant/motor", "1");
}

#[test]
fn a_broker_is_lost_and_comes_back() {
    lost_and_back(Form::Serve);
}

/// The same of executables, with the client of the runtime.
#[test]
fn a_broker_of_an_executable_is_lost_and_comes_back() {
    lost_and_back(Form::C);
}

#[test]
fn a_broker_of_an_executable_in_rust_is_lost_and_comes_back() {
    lost_and_back(Form::Rust);
}

#[test]
fn a_broker_of_an_executable_for_arm_is_lost_and_comes_back() {
    lost_and_back(Form::Arm);
}

fn lost_and_back(form: Form) {
    if !is_there() {
        return;
    }
    let port = free_port();
    let configuration = format!(
        "listener {port} 127.0.0.1\nallow_anonymous false\npassword_file users\nuser root\n"
    );
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        (
            "rungc.toml",
            SETTINGS.replace("PORT", &port.to_string()).as_bytes(),
        ),
        ("mosquitto.conf", configuration.as_bytes()),
        ("password", b"secret\n"),
    ]);
    let folder = folder.path();
    let mut users = Command::new("mosquitto_passwd");
    let users = users
        .args(["-b", "-c", "users", "plc", "secret"])
        .current_dir(folder);
    assert!(users.status().unwrap().success());
    let Some(mut serve) = form.command(folder, "fx3u", &[]) else {
        return;
    };
    serve.current_dir(folder).stdin(Stdio::null());
    serve.stdout(Stdio::null());
    let mut run = Ends(serve.stderr(Stdio::null()).spawn().unwrap());
    soon("the broker is not there yet", || {
        file(folder, "lost") == "1"
    });
    scans(folder);
    for recipe in [7, 8] {
        let broker = broker(folder);
        works(folder, port, recipe);
        drop(broker);
        soon("the broker is lost", || file(folder, "lost") == "1");
        soon("what was read is lost with it", || {
            file(folder, "recipe") == "0"
        });
        scans(folder);
    }
    let _broker = broker(folder);
    works(folder, port, 9);
    assert_eq!(run.interrupt(), Some(form.code()));
    shows(port, "plant/status", "offline");
    shows(port, "plant/motor", "0");
}

#[test]
fn the_last_will_says_that_the_plc_is_gone() {
    if !is_there() {
        return;
    }
    let port = free_port();
    let settings = SETTINGS.replace("PORT", &port.to_string());
    let settings = settings.replace("user = 'plc'\npassword-file = 'password'\n", "");
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
        ("mosquitto.conf", open_to_all(port).as_bytes()),
    ]);
    let _broker = broker(folder.path());
    let mut serve = Command::new(env!("CARGO_BIN_EXE_rungc"));
    serve
        .arg("serve")
        .current_dir(&folder)
        .stdout(Stdio::null());
    let run = Ends(serve.stderr(Stdio::null()).spawn().unwrap());
    shows(port, "plant/status", "online");
    // Killed.
    drop(run);
    shows(port, "plant/status", "offline");
}

/// A message without a value is reported, and the connection remains, however often the broker delivers it.
#[test]
fn long_messages_do_not_end_a_connection() {
    if !is_there() {
        return;
    }
    let port = free_port();
    let settings = SETTINGS.replace("PORT", &port.to_string());
    let settings = settings.replace("user = 'plc'\npassword-file = 'password'\n", "");
    let folder = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
        ("mosquitto.conf", open_to_all(port).as_bytes()),
    ]);
    let _broker = broker(folder.path());
    publish(port, "plant/switch/X001", &"x".repeat(100_000));
    let said = folder.path().join("said");
    let mut serve = Command::new(env!("CARGO_BIN_EXE_rungc"));
    serve
        .arg("serve")
        .current_dir(&folder)
        .stdout(Stdio::null())
        .stderr(fs::File::create(&said).unwrap());
    let _run = Ends(serve.spawn().unwrap());
    let text = || fs::read_to_string(&said).unwrap_or_default();
    soon("the message is left out", || {
        text().contains("plant/switch/X001: `xxxx")
    });
    works(folder.path(), port, 7);
    assert_eq!(
        text().matches("io broker: connected").count(),
        1,
        "{}",
        text()
    );
}

/// Brokers by TLS; certificates are openssl's.
#[cfg(feature = "tls")]
mod encrypted {
    use super::*;
    use crate::common::mosquitto::are_there;
    use crate::common::{normal, text};
    use std::io::{BufRead, BufReader};
    use std::sync::{Arc, Mutex};
    use std::thread;

    /// Y000 follows X000; Y010 shows that the broker is lost, D0 counts scans.
    const PROGRAM: &str = "LD X000\nOUT Y000\nLD M100\nOUT Y010\nLD M8000\nINC D0\nEND\n";

    /// The connection that works, and files that show what happens.
    const SETTINGS: &str = "\
[project]
program = 'p.il'
model = 'fx3u'

[io.files]
files = '.'
Y010 = 'write lost'
D0 = 'write scans'

[io.mutual]
mqtt = 'localhost:MUTUAL'
ca = 'ca.pem'
certificate = 'plc.pem'
key = 'plc.key'
fault = 'M100'
timeout = '20s'
status = 'plant/status'
X000 = 'read plant/start'
Y000 = 'write plant/motor'
";

    /// Connections that do not: a name, a listener, and further keys.
    const WRONG: [(&str, &str, &str); 13] = [
        ("authority", "SERVER", "ca = 'foreign.pem'"),
        ("expired", "EXPIRED", "ca = 'ca.pem'"),
        ("early", "EARLY", "ca = 'ca.pem'"),
        ("host", "ELSEWHERE", "ca = 'ca.pem'"),
        ("nameless", "NAMELESS", "ca = 'ca.pem'"),
        ("itself", "ITSELF", "ca = 'itself.pem'"),
        ("plain", "PLAIN", "ca = 'ca.pem'"),
        ("anonymous", "MUTUAL", "ca = 'ca.pem'"),
        (
            "unknown",
            "MUTUAL",
            "ca = 'ca.pem'\ncertificate = 'stranger.pem'\nkey = 'stranger.key'",
        ),
        (
            "mixed",
            "MUTUAL",
            "ca = 'ca.pem'\ncertificate = 'plc.pem'\nkey = 'stranger.key'",
        ),
        (
            "keyless",
            "MUTUAL",
            "ca = 'ca.pem'\ncertificate = 'plc.pem'\nkey = 'plc.pem'",
        ),
        ("missing", "SERVER", "ca = 'none.pem'"),
        ("binary", "SERVER", "ca = 'p.il'"),
    ];

    /// Listeners: a name, whose certificate, and whether it asks for one.
    const LISTENERS: [(&str, &str, bool); 8] = [
        ("MUTUAL", "broker", true),
        ("SERVER", "broker", false),
        ("EXPIRED", "expired", false),
        ("EARLY", "early", false),
        ("ELSEWHERE", "elsewhere", false),
        ("NAMELESS", "nameless", false),
        ("ITSELF", "itself", false),
        ("PLAIN", "", false),
    ];

    fn openssl(folder: &Path, args: &str) {
        let mut command = Command::new("openssl");
        command.args(args.split(' ')).current_dir(folder);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", text(&output.stderr));
    }

    const NEW_KEY: &str = "-newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes";

    /// An authority, or a certificate that is its own.
    fn authority(folder: &Path, name: &str) {
        let files = format!("-keyout {name}.key -out {name}.pem");
        openssl(
            folder,
            &format!("req -x509 {NEW_KEY} -subj /CN={name} -days 30 {files}"),
        );
    }

    /// A certificate with an extension, valid between two times.
    fn issue(folder: &Path, name: &str, by: &str, extension: &str, [from, to]: [&str; 2]) {
        let files = format!("-keyout {name}.key -out {name}.csr");
        openssl(
            folder,
            &format!("req -new {NEW_KEY} -subj /CN={name} {files}"),
        );
        fs::write(folder.join("extensions"), extension).unwrap();
        fs::write(folder.join("index"), "").unwrap();
        fs::write(
            folder.join("ca.conf"),
            "[ca]\ndefault_ca = own\n[own]\ndatabase = index\nnew_certs_dir = .\ndefault_md = sha256\npolicy = any\n\
             rand_serial = yes\n[any]\ncommonName = supplied\n",
        )
        .unwrap();
        openssl(
            folder,
            &format!(
                "ca -batch -config ca.conf -notext -cert {by}.pem -keyfile {by}.key -startdate {from} -enddate {to} \
                 -extfile extensions -in {name}.csr -out {name}.pem"
            ),
        );
    }

    fn certificates(folder: &Path) {
        for name in ["ca", "foreign", "itself"] {
            authority(folder, name);
        }
        let (here, now) = (
            "subjectAltName = DNS:localhost",
            ["20200101000000Z", "20990101000000Z"],
        );
        let there = "subjectAltName = DNS:broker.example";
        let (past, future) = (
            ["20200101000000Z", "20210101000000Z"],
            ["20980101000000Z", "20990101000000Z"],
        );
        issue(folder, "broker", "ca", here, now);
        issue(folder, "expired", "ca", here, past);
        issue(folder, "early", "ca", here, future);
        issue(folder, "elsewhere", "ca", there, now);
        // As many instructions do it.
        issue(folder, "nameless", "ca", "", now);
        let client = "extendedKeyUsage = clientAuth";
        issue(folder, "plc", "ca", client, now);
        issue(folder, "stranger", "foreign", client, now);
    }

    /// The broker's configuration, the PLC's, and the ports by their names.
    fn settings() -> (String, String, Vec<(&'static str, u16)>) {
        let mut broker = String::from("per_listener_settings true\nuser root\n");
        let mut ports = Vec::new();
        for (name, certificate, asks) in LISTENERS {
            let port = free_port();
            ports.push((name, port));
            broker += &format!("listener {port} localhost\nallow_anonymous true\n");
            if !certificate.is_empty() {
                broker += &format!(
                    "cafile ca.pem\ncertfile {certificate}.pem\nkeyfile {certificate}.key\nrequire_certificate {asks}\n"
                );
            }
        }
        let mut plc = String::from(SETTINGS);
        for (name, listener, keys) in WRONG {
            plc += &format!(
                "\n[io.{name}]\nmqtt = 'localhost:{listener}'\ntimeout = '20s'\n{keys}\nY007 = 'write {name}'\n"
            );
        }
        for (name, port) in &ports {
            plc = plc.replace(&format!(":{name}'"), &format!(":{port}'"));
        }
        (broker, plc, ports)
    }

    /// A value of a topic over TLS, or an empty text.
    fn topic(folder: &Path, port: u16, name: &str) -> String {
        text(&client(
            folder,
            port,
            "mosquitto_sub",
            &["-C", "1", "-W", "5", "-t", name],
        ))
        .trim()
        .to_string()
    }

    fn client(folder: &Path, port: u16, program: &str, args: &[&str]) -> Vec<u8> {
        let mut command = Command::new(program);
        command.args(["-h", "localhost", "-p", &port.to_string()]);
        command.args("--cafile ca.pem --cert plc.pem --key plc.key".split(' '));
        command
            .args(args)
            .current_dir(folder)
            .output()
            .unwrap()
            .stdout
    }

    /// Reports of the run on connections, with names for the folder and for ports.
    fn messages_of(messages: &str, folder: &Path, ports: &[(&'static str, u16)]) -> String {
        let mut lines: Vec<_> = messages
            .lines()
            .filter_map(|line| line.strip_prefix("rungc: io "))
            .filter(|line| !line.starts_with("files: ") && !line.starts_with("mutual: "))
            .map(|line| match line.find("name a certificate of the PLC") {
                // The reason may be lost with the connection.
                Some(place) if line.starts_with("anonymous: ") => {
                    format!(
                        "anonymous: … {}",
                        line[place..].trim_end_matches(", if the broker asks for one")
                    )
                }
                _ => line.to_string(),
            })
            .collect();
        lines.sort();
        let mut messages = normal(&lines.join("\n"), folder);
        for (name, port) in ports {
            messages = messages.replace(&port.to_string(), name);
        }
        messages
    }

    #[test]
    fn certificates_that_do_not_fit_are_explained() {
        if !are_there(&["mosquitto", "mosquitto_pub", "openssl"]) {
            return;
        }
        let (configuration, settings, ports) = settings();
        let folder = folder(&[
            ("p.il", PROGRAM.as_bytes()),
            ("rungc.toml", settings.as_bytes()),
            ("mosquitto.conf", configuration.as_bytes()),
        ]);
        let folder = folder.path();
        certificates(folder);
        let port = ports[0].1;
        let first = broker(folder);
        let mut serve = Command::new(env!("CARGO_BIN_EXE_rungc"));
        serve.arg("serve").current_dir(folder).stdin(Stdio::null());
        serve.stdout(Stdio::null()).stderr(Stdio::piped());
        let mut run = Ends(serve.spawn().unwrap());
        let errors = BufReader::new(run.0.stderr.take().unwrap());
        let messages = Arc::new(Mutex::new(String::new()));
        let written = Arc::clone(&messages);
        thread::spawn(move || {
            for line in errors.lines().map_while(Result::ok) {
                *written.lock().unwrap() += &format!("{line}\n");
            }
        });
        let works = || {
            soon("the broker is there", || file(folder, "lost") == "0");
            soon("it says so", || {
                topic(folder, port, "plant/status") == "online"
            });
            for (payload, motor) in [("1", "1"), ("0", "0"), ("1", "1")] {
                client(
                    folder,
                    port,
                    "mosquitto_pub",
                    &["-r", "-t", "plant/start", "-m", payload],
                );
                soon("the motor follows", || {
                    topic(folder, port, "plant/motor") == motor
                });
            }
        };
        works();
        let lines = || messages_of(&messages.lock().unwrap(), folder, &ports);
        soon("all others are reported", || {
            lines().lines().count() >= WRONG.len()
        });
        insta::assert_snapshot!("tls", lines());
        scans(folder);
        drop(first);
        soon("the broker is lost", || file(folder, "lost") == "1");
        scans(folder);
        // A corrected file takes effect at the next attempt.
        fs::copy(folder.join("ca.pem"), folder.join("foreign.pem")).unwrap();
        let _broker = broker(folder);
        works();
        soon("the authority is known", || {
            lines().contains("authority: connected to ")
        });
    }
}
