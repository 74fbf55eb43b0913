//! Errors in the set-up of serial ports.

use super::super::Code;
use super::facts::{Facts, NETWORK, RegisterValue, Uinit, Write, d, m};
use super::{Use, has_station, port_of, use_of};
use crate::accesses;
use rungc_catalogue::Lower;
use rungc_models::ModelId;
use rungc_rt::comm::{Choice, LineFormat, PortWiring, Protocol};
use rungc_rt::{Ports, RtFn};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes, phrase};
use std::ops::RangeInclusive;

/// Checks the ports that a program uses or sets up.
pub(in super::super) fn check(code: &Code, out: &mut Diagnostics) {
    let facts = code.facts();
    for wiring in code.model().ports.all() {
        if wiring.choice == Choice::Can {
            continue;
        }
        let port = Port {
            code,
            facts,
            wiring,
            protocol: facts.protocol(wiring),
        };
        if facts.touch(wiring) || facts.is_set_up(wiring.number) {
            port.contradictions(out);
            port.overridden(out);
            port.late(out);
            port.station(out);
            port.network(out);
            port.rate(out);
            port.own_frames(out);
            port.ethernet_card(out);
            port.instructions(out);
            port.table(out);
        }
    }
    parallel(code, facts, out);
    canlink(code, out);
    indexed(facts, out);
}

/// Set-up registers that only an index reaches.
fn indexed(facts: &Facts, out: &mut Diagnostics) {
    for &(first, near, span) in &facts.indexed {
        let message = phrase!(
            "`{first}` with an index may be `{near}`, which sets up a serial port",
            first,
            near
        );
        let diagnostic = codes::PORT_SET_BY_INDEX
            .at(span, message)
            .label("a protocol that is chosen only here is missing from a compiled program")
            .help(phrase!(
                "if this sets up the port, name the register: `{near}`",
                near
            ));
        out.push(diagnostic);
    }
}

/// A port that a program uses or sets up.
struct Port<'a> {
    code: &'a Code<'a>,
    facts: &'a Facts,
    wiring: &'static PortWiring,
    protocol: Option<Protocol>,
}

impl Port<'_> {
    fn name(&self) -> String {
        format!("COM{number}", number = self.wiring.number)
    }

    /// The devices that choose what the port speaks, and its format.
    fn chooses(&self) -> impl Iterator<Item = Device> {
        let registers = self.wiring.setup_registers().map(d);
        registers.chain(self.wiring.setup_relays().map(m))
    }

    /// Two constants for one register, both written in the first scan. 0 clears a register before it is set up.
    fn contradictions(&self, out: &mut Diagnostics) {
        for device in self.wiring.setup_registers().map(d) {
            let sets = |write: &&Write| write.first_scan && write.value.is_some_and(|v| v != 0);
            let writes: Vec<_> = self.facts.writes(device).iter().filter(sets).collect();
            let Some((first, rest)) = writes.split_first() else {
                continue;
            };
            let Some(other) = rest.iter().find(|other| other.value != first.value) else {
                continue;
            };
            let message = phrase!(
                "`{device}` of {self} is set to two values",
                device,
                self = self.name()
            );
            let diagnostic = codes::PORT_SET_TWICE
                .at(self.code.span(other.at), message)
                .label("this value counts …")
                .other(self.code.span(first.at), "… this one is overwritten");
            out.push(diagnostic);
        }
        let twice = |uinits: &Vec<Uinit>| {
            let known = uinits.iter().filter(|uinit| uinit.words().is_some());
            let mut known = known.copied();
            let first = known.next()?;
            let other = known.find(|other| other.words() != first.words())?;
            Some((first, other))
        };
        let uinits = self.facts.uinit.get(&self.wiring.number);
        if let Some((first, other)) = uinits.and_then(twice) {
            let message = phrase!("{self} is set up in two ways", self = self.name());
            let diagnostic = codes::PORT_SET_TWICE
                .at(self.code.span(other.at), message)
                .label("set up like this here …")
                .other(self.code.span(first.at), "… and otherwise here");
            out.push(diagnostic);
        }
    }

    /// A protocol number that a relay of a parallel link, or the bit of the format word that stands for computer link,
    /// overrides.
    fn overridden(&self, out: &mut Diagnostics) {
        let Some(number) = self.wiring.protocol.map(d) else {
            return;
        };
        let (RegisterValue::Constant(chosen @ 1..), Some(protocol)) =
            (self.facts.held(number), self.protocol)
        else {
            return;
        };
        let wanted = Protocol::from_number(chosen);
        let choosing = self.chooses().filter(|&device| device != number);
        let set =
            |device: &Device| matches!(self.facts.held(*device), RegisterValue::Constant(1..));
        // On L01S, the relays do not override the number but let it count.
        let overrides = matches!(self.wiring.choice, Choice::Com1 | Choice::Number);
        let Some(other) = choosing.filter(set).last().filter(|_| overrides) else {
            return;
        };
        let places = [number, other].map(|device| self.place(Some(device)));
        let ([Some(at), Some(over)], false) = (places, wanted == protocol) else {
            return;
        };
        let message = format!(
            "{} is set up in two ways: `{number}` = H{chosen:X} does not count beside `{other}`",
            self.name()
        );
        let diagnostic = codes::PORT_SET_TWICE
            .at(self.code.span(at), message)
            .label(phrase!("{wanted} is wanted here …", wanted = wanted.name()))
            .other(
                self.code.span(over),
                phrase!("… but {protocol} here", protocol = protocol.name()),
            );
        out.push(diagnostic);
    }

    /// A choice that is made after the first scan, where that is too late.
    fn late(&self, out: &mut Diagnostics) {
        if !self.wiring.binds() {
            return;
        }
        let protocol = self.wiring.protocol.map(d);
        let relays = self.wiring.setup_relays().map(m);
        for device in protocol.into_iter().chain(relays) {
            let writes = self.facts.writes(device);
            // A switch and its inverse may choose one of two protocols.
            let either = writes.iter().any(|write| {
                let inverse = write.contact.map(|(device, open)| (device, !open));
                inverse.is_some() && writes.iter().any(|other| other.contact == inverse)
            });
            let in_time = either || writes.iter().any(|write| write.first_scan);
            let Some(first) = writes.iter().find(|write| write.value != Some(0)) else {
                continue;
            };
            if in_time {
                continue;
            }
            let model = self.code.model().name.to_uppercase();
            let message = phrase!(
                "`{device}` is not always set in the first scan, at whose end {model} fixes the protocol of {self}",
                device,
                model,
                self = self.name()
            );
            let diagnostic = codes::PORT_SET_LATE
                .at(self.code.span(first.at), message)
                .label("may take effect only after the next change from STOP to RUN")
                .help("set it under `LD M8002` or `LD M8000`");
            out.push(diagnostic);
        }
    }

    /// Position at which a register, or the station in UINIT, is set last.
    fn place(&self, device: Option<Device>) -> Option<usize> {
        let writes = device.map_or(&[][..], |device| self.facts.writes(device));
        let uinits = self.facts.uinit.get(&self.wiring.number);
        let uinit = uinits.and_then(|uinits| uinits.iter().find(|u| u.words().is_some()));
        writes
            .last()
            .map(|write| write.at)
            .or(uinit.map(|uinit| uinit.at))
    }

    /// A station that no frame can name.
    fn station(&self, out: &mut Diagnostics) {
        let Some(protocol) = self.protocol.filter(|&protocol| has_station(protocol)) else {
            return;
        };
        let stations: RangeInclusive<u16> = match (protocol, self.code.model().ports) {
            (Protocol::ComputerLink, Ports::Hm) => 1..=63,
            (Protocol::ComputerLink, _) => 0..=15,
            _ => 1..=247,
        };
        let register = self.wiring.station.map(d);
        let station = self.facts.station(self.wiring);
        let Some(station) = station.filter(|station| !stations.contains(station)) else {
            return;
        };
        let place = self.place(register).or_else(|| {
            let mut choosing = self.chooses().filter_map(|device| self.place(Some(device)));
            choosing.next()
        });
        let Some(place) = place else { return };
        let (least, most) = (stations.start(), stations.end());
        let message = phrase!(
            "{self} is a {protocol} with station {station}; stations are {least} to {most}",
            self = self.name(),
            protocol = noun(protocol),
            station,
            least,
            most
        );
        let diagnostic = codes::PORT_STATION
            .at(self.code.span(place), message)
            .label("no frame can be for this station");
        out.push(match register {
            Some(register) => diagnostic.help(phrase!("set `{register}` to its station", register)),
            None => diagnostic,
        });
    }

    /// Numbers that an N:N link does not have.
    fn network(&self, out: &mut Diagnostics) {
        use Protocol::{EnhancedMaster, EnhancedSlave, NnMaster, NnSlave};
        let (enhanced, master) = match self.protocol {
            Some(NnMaster) => (false, true),
            Some(NnSlave) => (false, false),
            Some(EnhancedMaster) => (true, true),
            Some(EnhancedSlave) => (true, false),
            _ => return,
        };
        let most = if enhanced { 15 } else { 7 };
        let [station, slaves, mode] = NETWORK;
        let rows = [
            (station, !master, 1..=most, "stations of slaves"),
            (slaves, master, 1..=most, "numbers of slaves"),
            (mode, master && !enhanced, 0..=2, "modes"),
        ];
        for (register, counts, range, what) in rows {
            let RegisterValue::Constant(value) = self.facts.held(register) else {
                continue;
            };
            let place = self.place(Some(register));
            let Some(place) = place.filter(|_| counts && !range.contains(&value)) else {
                continue;
            };
            let (least, most) = (range.start(), range.end());
            let link = if enhanced {
                "an enhanced N:N link"
            } else {
                "an N:N link"
            };
            let message = phrase!(
                "`{register}` is {value}: {what} of {link} are {least} to {most}",
                register,
                value,
                what,
                link,
                least,
                most
            );
            let diagnostic = codes::LINK_RANGE
                .at(self.code.span(place), message)
                .label("out of range");
            out.push(diagnostic);
        }
    }

    /// A format word that names no bit rate.
    fn rate(&self, out: &mut Diagnostics) {
        use Protocol::{EnhancedMaster, EnhancedSlave, NnMaster, NnSlave};
        use Protocol::{Off, ParallelMaster, ParallelSlave, ProgrammingPort};
        let usual = matches!(
            self.protocol,
            None | Some(
                Off | ProgrammingPort
                    | NnMaster
                    | NnSlave
                    | EnhancedMaster
                    | EnhancedSlave
                    | ParallelMaster
                    | ParallelSlave
            )
        );
        if usual {
            return;
        }
        let register = self.wiring.format.map(d);
        let word = match register.map(|register| self.facts.held(register)) {
            // 0 takes a format away.
            Some(RegisterValue::Constant(word)) => {
                (word != 0 && !LineFormat::has_rate(word)).then_some(word)
            }
            Some(RegisterValue::Default(_) | RegisterValue::Unknown) => None,
            None => {
                let uinits = self.facts.uinit.get(&self.wiring.number);
                let words = uinits.into_iter().flatten().filter_map(Uinit::words);
                words
                    .map(|[_, format]| format)
                    .find(|&format| !LineFormat::has_uinit_rate(format))
            }
        };
        let (Some(word), Some(place)) = (word, self.place(register)) else {
            return;
        };
        let message = phrase!(
            "the format word H{word} of {port} names no bit rate",
            word = format!("{word:X}"),
            port = self.name()
        );
        let diagnostic = codes::PORT_RATE
            .at(self.code.span(place), message)
            .label("the port runs at 9600 bit/s");
        out.push(diagnostic);
    }

    /// A link whose frames the manuals do not print.
    fn own_frames(&self, out: &mut Diagnostics) {
        let always = self.protocol.filter(has_own_frames);
        let (place, is, partners) = match always {
            Some(protocol) => {
                let mut places = self.chooses().filter_map(|device| self.place(Some(device)));
                let place = places.next();
                (place.map(|place| (place, protocol)), "is", "its partners")
            }
            None => (self.chosen_link(), "may be", "its partners then"),
        };
        let Some((place, protocol)) = place else {
            return;
        };
        let message = phrase!(
            "{self} {is} the {protocol}: {partners} have to run programs of rungc, too",
            self = self.name(),
            is,
            protocol = protocol.name(),
            partners
        );
        let note = codes::OWN_FRAMES
            .at(self.code.span(place), message)
            .label("the manuals do not print the frames of this link")
            .help("`rungc book links` describes the frames");
        out.push(note);
    }

    /// A link with such frames that the port is at some time: where it is chosen first.
    fn chosen_link(&self) -> Option<(usize, Protocol)> {
        let chosen = self.chooses().flat_map(|device| {
            let writes = self.facts.writes(device).iter();
            let may_count = |write: &&Write| self.protocol.is_none() || !write.first_scan;
            writes.filter(may_count).filter_map(move |write| {
                let value = write.value.filter(|&value| value != 0)?;
                let protocol = self.facts.protocol_with(self.wiring, device, value)?;
                has_own_frames(&protocol).then_some((write.at, protocol))
            })
        });
        chosen.min_by_key(|&(at, _)| at)
    }

    /// The set-up that the manual prescribes for the card H2U-ENET-BD (h1u-h2u-programming §6.7.2).
    fn ethernet_card(&self, out: &mut Diagnostics) {
        const FORMAT: u16 = 0xc1;
        let format = self.wiring.format.map(d);
        let is_card = (self.code.model().id, self.wiring.number) == (ModelId::H2u, 3)
            && self.protocol == Some(Protocol::ModbusRtu)
            && format.map(|register| self.facts.held(register))
                == Some(RegisterValue::Constant(FORMAT))
            && self.facts.station(self.wiring) == Some(1);
        let Some(place) = self.place(format).filter(|_| is_card) else {
            return;
        };
        let message = "COM3 is set up for the Ethernet card H2U-ENET-BD, which there is not";
        let warning = codes::ETHERNET_CARD
            .at(self.code.span(place), message)
            .label("COM3 is a Modbus RTU slave")
            .help("serve by Modbus TCP with `--modbus-tcp 502` or `modbus-tcp = 502` in `[serve]` of rungc.toml");
        out.push(warning);
    }

    /// Instructions that the protocol of the port does not serve; the first of each kind is reported.
    fn instructions(&self, out: &mut Diagnostics) {
        let Some(protocol) = self.protocol else {
            return;
        };
        let mut reported = [false; 2];
        for i in 0..self.code.len {
            if port_of(self.code, i, self.facts) != Some(self.wiring.number) {
                continue;
            }
            let Some((function, of)) = use_of(self.code, i) else {
                continue;
            };
            // RS also asks by Modbus where the port is a master (h1u-h2u-programming §5.7).
            let asks = protocol.is_master() && function == RtFn::Rs;
            let (served, kind, code) = match of {
                Use::Free => (protocol == Protocol::Free || asks, 0, &codes::PORT_NOT_FREE),
                Use::Master => (serves(protocol, function), 1, &codes::PORT_NOT_MASTER),
                Use::SetUp => continue,
            };
            if served || std::mem::replace(&mut reported[kind], true) {
                continue;
            }
            let mnemonic = &self.code.instr(i).mnemonic;
            let name = self.name();
            let message = match protocol {
                Protocol::Off => phrase!(
                    "`{mnemonic}` works on {name}, which has no protocol",
                    mnemonic,
                    name
                ),
                _ => phrase!(
                    "`{mnemonic}` works on {name}, which is a {protocol}",
                    mnemonic,
                    name,
                    protocol = noun(protocol)
                ),
            };
            let diagnostic = code
                .at(self.code.span(i), message)
                .label("nothing is sent or received");
            out.push(self.with_choice(diagnostic));
        }
    }

    /// A Modbus table that has no rows: rows of the settings are instructions of the program here.
    fn table(&self, out: &mut Diagnostics) {
        if self.protocol != Some(Protocol::MasterTable) {
            return;
        }
        let here = Some(self.wiring.number);
        if (0..self.code.len).any(|i| port_of(self.code, i, self.facts) == here) {
            return;
        }
        let mut places = self.chooses().filter_map(|device| self.place(Some(device)));
        let Some(place) = places.next() else { return };
        let message = phrase!(
            "{self} works through a Modbus table, which has no rows",
            self = self.name()
        );
        let warning = codes::PORT_NO_TABLE
            .at(self.code.span(place), message)
            .label("nothing is sent")
            .help("write the rows of the editor's table to rungc.toml, as `[[modbus]]`");
        out.push(warning);
    }

    /// With the place where the protocol is chosen.
    fn with_choice(&self, diagnostic: Diagnostic) -> Diagnostic {
        let mut places = self.chooses().filter_map(|device| self.place(Some(device)));
        match places.next() {
            Some(place) => diagnostic.other(self.code.span(place), "the port is set up here"),
            None => diagnostic,
        }
    }
}

/// Returns true if the manuals do not print the frames of a protocol.
fn has_own_frames(protocol: &Protocol) -> bool {
    use Protocol::{EnhancedMaster, EnhancedSlave, NnMaster, NnSlave};
    use Protocol::{ParallelMaster, ParallelSlave};
    matches!(
        protocol,
        EnhancedMaster | EnhancedSlave | NnMaster | NnSlave | ParallelMaster | ParallelSlave
    )
}

/// Returns true if a port with this protocol carries out a master's instruction. ADPRW of L01S asks in RTU alone
/// (l01s-programming §8.2.6).
fn serves(protocol: Protocol, function: RtFn) -> bool {
    protocol.is_master() && !(protocol == Protocol::MasterAscii && function == RtFn::Adprw)
}

/// A station of CANlink: its frames are our own, and some registers are the network's (h1u-h2u-programming §5.9.8).
fn canlink(code: &Code, out: &mut Diagnostics) {
    const RESERVED: RangeInclusive<u32> = 7000..=7999;
    let is_station = |&i: &usize| matches!(code.lower(i), Some(Lower::Call(RtFn::Cannet)));
    let Some(station) = (0..code.len).find(is_station) else {
        return;
    };
    let message = "the CAN card is on CANlink: its partners have to run programs of rungc, too";
    let note = codes::OWN_FRAMES
        .at(code.span(station), message)
        .label("the manuals do not print the frames of CANlink")
        .help("`rungc book links` describes the frames");
    out.push(note);
    for i in 0..code.len {
        remote_module(code, i, out);
        let mut writes = accesses::of(code.resolved, i).filter(accesses::Access::writes);
        let Some(access) = writes.find(|access| {
            let Device { class, number } = access.first;
            let last = number.saturating_add(access.count.unwrap_or(1).saturating_sub(1));
            class == DeviceClass::D && number <= *RESERVED.end() && last >= *RESERVED.start()
        }) else {
            continue;
        };
        let message = phrase!(
            "`{first}` is a register of the network on a station of CANlink",
            first = access.first
        );
        let warning = codes::CANLINK_REGISTERS
            .at(code.span(i), message)
            .label("written here")
            .help("use registers below D7000");
        out.push(warning);
    }
}

/// A remote module that is read or written beside CANlink (h1u-h2u-programming §5.9.8).
fn remote_module(code: &Code, i: usize, out: &mut Diagnostics) {
    const STATIONS: i64 = 100;
    let function = code.lower(i);
    let (Some(Lower::Call(RtFn::FromRemote | RtFn::ToRemote)), Some(unit)) =
        (function, code.instr(i).operands.first())
    else {
        return;
    };
    if unit.kind.constant().is_some_and(|unit| unit > STATIONS) {
        let mnemonic = &code.instr(i).mnemonic;
        let message = phrase!(
            "{mnemonic} reaches a remote module beside CANlink",
            mnemonic
        );
        let warning = codes::CANLINK_AND_MODULES
            .at(unit.span, message)
            .label("on the same CAN bus")
            .help("use one of them, or modules beside the main unit");
        out.push(warning);
    }
}

/// Noun for a port under a protocol, after "a".
fn noun(protocol: Protocol) -> &'static str {
    match protocol {
        Protocol::Free => "port with a free protocol",
        Protocol::ModbusRtu => "Modbus RTU slave",
        Protocol::ModbusAscii => "Modbus ASCII slave",
        Protocol::MasterRtu | Protocol::MasterTable => "Modbus RTU master",
        Protocol::MasterAscii => "Modbus ASCII master",
        Protocol::ComputerLink => "slave of a computer link",
        other => other.name(),
    }
}

/// A parallel link whose master and slave this PLC is both.
fn parallel(code: &Code, facts: &Facts, out: &mut Diagnostics) {
    let mut ports = code.model().ports.all().iter();
    // Its relays are those of the master and of the slave.
    let has_relays = |choice| matches!(choice, Choice::Com1 | Choice::Format);
    let Some(port) = ports.find(|wiring| has_relays(wiring.choice)) else {
        return;
    };
    let on = |write: &&Write| write.first_scan && write.value == Some(1);
    let ends = port.setup_relays().map(m);
    let ends: Vec<_> = ends
        .filter_map(|relay| facts.writes(relay).iter().find(on))
        .collect();
    if let [master, slave] = ends[..] {
        let message = "the PLC is both master and slave of a parallel link";
        let diagnostic = codes::LINK_BOTH_ENDS
            .at(code.span(slave.at), message)
            .label("slave")
            .other(code.span(master.at), "master");
        out.push(diagnostic);
    }
}
