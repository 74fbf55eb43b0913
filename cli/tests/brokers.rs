//! `[io.NAME]` with brokers: mosquitto is killed and comes back while `rungc serve` runs. `.ci/run` installs it; where
//! it is not, the tests say so, unless `RUNGC_REQUIRE_PEERS` is set.
#![cfg(all(unix, feature = "mqtt"))]

mod common;

use common::mosquitto::{self, Ends, broker, is_there, open_to_all, soon};
use common::{folder, free_port, rungc, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

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

/// What the program is connected to: PORT is that of the broker. Files show what happens while it is away.
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

/// What a row of files has written.
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
    // What is not a value changes nothing.
    for wrong in ["", "2", "[", "{\"X000\": 0}", "999999999999999999999"] {
        publish(port, "plant/start", wrong);
    }
    publish(port, "plant/recipe", "70000");
    thread::sleep(Duration::from_millis(100));
    shows(port, "plant/motor", "1");
    publish(port, "plant/start", "false");
    shows(port, "plant/motor", "0");
    publish(port, "plant/start", "1");
    shows(port, "plant/motor", "1");
}

#[test]
fn a_broker_is_lost_and_comes_back() {
    let serve = |_: &Path| {
        let mut serve = Command::new(env!("CARGO_BIN_EXE_rungc"));
        serve.arg("serve");
        serve
    };
    lost_and_back(serve, 130);
}

/// The same of an executable, with the client of the runtime.
#[test]
fn a_broker_of_an_executable_is_lost_and_comes_back() {
    let start = |folder: &Path| {
        let args = ["build", "p.il", "--emit", "bin", "--io", "-o", "p"];
        let built = rungc(folder, &args);
        assert!(built.status.success(), "{}", text(&built.stderr));
        let mut command = Command::new(folder.join("p"));
        command.args(["--io", "rungc.toml"]).stdin(Stdio::null());
        command
    };
    lost_and_back(start, 0);
}

/// `start` makes the command that runs the program of a folder; interrupted, it ends with a code.
fn lost_and_back(start: impl Fn(&Path) -> Command, code: i32) {
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
    let mut serve = start(folder);
    serve.current_dir(folder).stdout(Stdio::null());
    let mut run = Ends(serve.stderr(Stdio::null()).spawn().unwrap());
    soon("the broker is not there yet", || {
        file(folder, "lost") == "1"
    });
    scans(folder);
    for recipe in [7, 8] {
        let broker = broker(folder, port);
        works(folder, port, recipe);
        drop(broker);
        soon("the broker is lost", || file(folder, "lost") == "1");
        soon("what was read is lost with it", || {
            file(folder, "recipe") == "0"
        });
        scans(folder);
    }
    let _broker = broker(folder, port);
    works(folder, port, 9);
    assert_eq!(run.interrupt(), Some(code));
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
    let _broker = broker(folder.path(), port);
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
