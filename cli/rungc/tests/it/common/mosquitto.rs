//! The broker mosquitto and its clients, which `.ci/run` installs; where they are not, the tests say so and do not run,
//! unless `RUNGC_REQUIRE_PEERS` is set.

use super::{soon, text};
use std::env;
use std::fs;
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// A process that ends with the test.
pub struct Ends(pub Child);

impl Ends {
    /// Asks it to end, as Ctrl-C does, which a caller in the background may ignore; its exit code.
    pub fn interrupt(&mut self) -> Option<i32> {
        let pid = self.0.id().to_string();
        let killed = Command::new("kill").args(["-TERM", &pid]).status().unwrap();
        assert!(killed.success());
        self.0.wait().unwrap().code()
    }
}

impl Drop for Ends {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns true if a broker is installed.
pub fn is_there() -> bool {
    are_there(&["mosquitto", "mosquitto_pub"])
}

/// Returns true if the programs that a test needs are installed.
pub fn are_there(programs: &[&str]) -> bool {
    let is_missing = |name: &&&str| {
        let mut command = Command::new(name);
        let command = command.arg("-h").stdin(Stdio::null());
        let silent = command.stdout(Stdio::null()).stderr(Stdio::null());
        silent.status().is_err()
    };
    let Some(missing) = programs.iter().find(is_missing) else {
        return true;
    };
    assert!(
        env::var_os("RUNGC_REQUIRE_PEERS").is_none(),
        "RUNGC_REQUIRE_PEERS is set, but there is no {missing}"
    );
    eprintln!("skipped: there is no {missing} (see .ci/run)");
    false
}

/// The configuration of a broker without users.
pub fn open_to_all(port: u16) -> String {
    format!("listener {port} 127.0.0.1\nallow_anonymous true\nuser root\n")
}

/// A broker in a folder that has its configuration, with all its listeners open.
pub fn broker(folder: &Path) -> Ends {
    let mut command = Command::new("mosquitto");
    command.args(["-c", "mosquitto.conf"]).current_dir(folder);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let broker = Ends(command.spawn().unwrap());
    let configuration = fs::read_to_string(folder.join("mosquitto.conf")).unwrap();
    let listeners = configuration.lines().filter_map(|line| {
        let mut words = line.strip_prefix("listener ")?.split(' ');
        words.next()?.parse::<u16>().ok()
    });
    for port in listeners {
        soon("the broker listens", || {
            TcpStream::connect(("127.0.0.1", port)).is_ok()
        });
    }
    broker
}

/// A client of the broker, with a user and his password.
fn client(name: &str, port: u16, user: Option<(&str, &str)>) -> Command {
    let mut command = Command::new(name);
    command.args(["-p", &port.to_string()]);
    if let Some((user, password)) = user {
        command.args(["-u", user, "-P", password]);
    }
    command
}

/// Publishes a value that the broker keeps.
pub fn publish(port: u16, user: Option<(&str, &str)>, topic: &str, payload: &str) {
    let mut command = client("mosquitto_pub", port, user);
    command.args(["-r", "-t", topic, "-m", payload]);
    assert!(command.status().unwrap().success());
}

/// Output of a client about topics, with these options.
pub fn subscribe(port: u16, user: Option<(&str, &str)>, options: &[&str]) -> String {
    let mut command = client("mosquitto_sub", port, user);
    text(&command.args(options).output().unwrap().stdout)
}
