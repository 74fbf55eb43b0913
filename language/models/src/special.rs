//! Special relays M8000… and special registers D8000…: what each means on each model, and whether it works.
//!
//! A number that a table does not hold has no meaning on the model (the manual calls it reserved, or says nothing).

mod maintained;
mod meaning;

#[cfg(test)]
pub(crate) use meaning::devices_in;

use crate::Model;
use rungc_rt::comm::{Protocol, Protocols};
use rungc_rt::modules::Place;
use rungc_rt::special::{
    D_BATTERY, D_CONSTANT_SCAN, D_REMOTE, D_SCOPE_STATE, D_SHORTEST_SCAN, D_TYPE, M_CONSTANT_SCAN,
    M_FORCE_ENABLE, M_FORCED_RUN, M_LOCAL_CONTROL, M_REMOTE_RUN,
};
use rungc_rt::{Register, Relay};
use rungc_syntax::DeviceClass;
use std::ops::RangeInclusive;

/// A relay M or register D that its type says.
pub trait SpecialDevice: Copy {
    /// M or D.
    const CLASS: DeviceClass;

    /// Its number.
    fn number(self) -> u32;
}

impl SpecialDevice for Relay {
    const CLASS: DeviceClass = DeviceClass::M;

    fn number(self) -> u32 {
        self.number()
    }
}

impl SpecialDevice for Register {
    const CLASS: DeviceClass = DeviceClass::D;

    fn number(self) -> u32 {
        self.number()
    }
}

/// Access allowed to a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Access {
    /// The PLC writes it; a program should only read it.
    Read,
    /// A program may write it.
    ReadWrite,
    /// The PLC writes it, unless a serial port is in this role: then a program may write it.
    ReadUnless(&'static PortRole),
}

/// Role of a serial port in which special devices have another meaning than otherwise.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PortRole {
    /// Number of the port in the model's manual.
    pub port: u8,
    /// Its protocols in that role.
    pub protocols: Protocols,
    /// The role, as the end of "while the port is …".
    pub title: &'static str,
    /// True if the PLC's parameters can put the port in the role, as well as its program.
    pub by_parameters: bool,
    /// Reason why a device that a program writes in that role is inert; `None` if it works.
    pub inert: Option<Reason>,
}

/// Status of a special device's function.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Status {
    /// The scan driver keeps it.
    Scan,
    /// These instructions read or write it.
    Instructions(&'static str),
    /// The special modules at this place read or write it, if the settings list any; else it is a plain register.
    Modules(Place),
    /// The analog adapter or board with this number ([`rungc_rt::modules::NAMES`]) reads or writes it, if the settings
    /// list it.
    Module(u16),
    /// It is a plain relay or register here, for this reason.
    Inert(Reason),
}

impl Status {
    /// Reason why the device is inert on a PLC with special modules of these numbers and places; `None` if it works.
    pub fn inert(self, fitted: &[(u16, Place)]) -> Option<Reason> {
        match self {
            Status::Inert(reason) => Some(reason),
            Status::Modules(place) => {
                let is_missing = fitted.iter().all(|&(_, own)| own != place);
                is_missing.then_some(NOT_FITTED)
            }
            Status::Module(unit) => {
                let is_missing = fitted.iter().all(|&(own, _)| own != unit);
                is_missing.then_some(NOT_FITTED)
            }
            Status::Scan | Status::Instructions(_) => None,
        }
    }
}

/// Reason why a special device is inert, and the effect on a program that relies on it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Reason {
    /// The reason, as the end of a sentence.
    pub text: &'static str,
    /// Programs that it affects.
    pub missed: Missed,
}

/// Programs that behave differently because a special device is inert.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Missed {
    /// None: it serves people and their tools, or reports faults that cannot happen here.
    Never,
    /// Programs that write it.
    ByWriters,
    /// Programs that write it, and programs that read it and wait for it to change.
    ByAll,
}

/// Devices that request scans of constant length.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ConstantScan {
    /// While it is on; `None`: always.
    pub relay: Option<Relay>,
    /// The shortest time of a scan in milliseconds; 0 or less: none.
    pub register: Register,
}

/// Devices that put the PLC in RUN and STOP, other than its switch. They take effect when a scan begins, in RUN or in
/// STOP.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RunCommand {
    /// M8036 puts it in RUN while M8035 is on, and goes off (h1u-h2u-programming §8.9).
    Forced,
    /// While D8004 holds [`REMOTE_KEY`](rungc_rt::special::REMOTE_KEY) and M8005 is off, M8004 decides on RUN and STOP
    /// (hm-motion-controller §5.7).
    Remote,
}

/// Special devices `first` to `last` of one class.
#[derive(Clone, Copy, Debug)]
pub struct Special {
    /// M or D.
    pub class: DeviceClass,
    /// First number.
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// Access allowed to a program.
    pub access: Access,
    /// Value at power-on.
    pub default: i16,
    /// Status of its function.
    pub status: Status,
    /// Meaning, in the notation of [`Special::meaning`].
    pub text: &'static str,
}

impl Special {
    /// Returns true if it works as described.
    pub fn works(&self) -> bool {
        !matches!(self.status, Status::Inert(_))
    }

    /// Returns true if the scan driver updates it.
    pub(crate) fn is_kept_by_scan(&self) -> bool {
        matches!(self.status, Status::Scan)
    }
}

impl Model {
    /// Row of a device on the model.
    pub fn special(&self, class: DeviceClass, number: u32) -> Option<&'static Special> {
        self.special.iter().find_map(|table| {
            let after = table.partition_point(|row| (row.class, row.first) <= (class, number));
            let row = table.get(after.checked_sub(1)?)?;
            (row.class == class && number <= row.last).then_some(row)
        })
    }

    /// All special devices of the model, table by table.
    pub fn specials(&self) -> impl Iterator<Item = &'static Special> + use<> {
        self.special.iter().copied().flatten()
    }

    /// Returns true if a special device works on this model.
    pub fn special_works<D: SpecialDevice>(&self, device: D) -> bool {
        let row = self.special(D::CLASS, device.number());
        row.is_some_and(Special::works)
    }

    /// Returns true if a special device is one that the scan updates on this model: M8034, for one, switches outputs
    /// off on most models and is an interrupt request on HM.
    pub fn scan_keeps<D: SpecialDevice>(&self, device: D) -> bool {
        let row = self.special(D::CLASS, device.number());
        row.is_some_and(Special::is_kept_by_scan)
    }

    /// Returns true if its registers from D8030 on are an oscilloscope's (HM). On L01S, they are the values of analog
    /// inputs, in one row.
    pub fn has_oscilloscope(&self) -> bool {
        let row = self.special(DeviceClass::D, D_SCOPE_STATE.number());
        row.is_some_and(|row| row.is_kept_by_scan() && row.first == row.last)
    }

    /// Returns true if M8005 to M8008 and D8005 to D8008 show the power supply and the battery. On HM, they have other
    /// meanings.
    pub fn shows_power_supply(&self) -> bool {
        self.scan_keeps(D_BATTERY)
    }

    /// Devices that request scans of constant length on this model.
    pub fn constant_scan(&self) -> Option<ConstantScan> {
        let (relay, register) = (M_CONSTANT_SCAN, D_CONSTANT_SCAN);
        if self.scan_keeps(relay) && self.scan_keeps(register) {
            return Some(ConstantScan {
                relay: Some(relay),
                register,
            });
        }
        self.scan_keeps(D_SHORTEST_SCAN).then_some(ConstantScan {
            relay: None,
            register: D_SHORTEST_SCAN,
        })
    }

    /// Devices that put the PLC in RUN and STOP on this model, other than its switch.
    pub fn run_command(&self) -> Option<RunCommand> {
        let forced = self.scan_keeps(M_FORCE_ENABLE) && self.scan_keeps(M_FORCED_RUN);
        let remote = self.scan_keeps(D_REMOTE) && self.scan_keeps(M_REMOTE_RUN);
        match (forced, remote) {
            (true, _) => Some(RunCommand::Forced),
            (false, true) if self.scan_keeps(M_LOCAL_CONTROL) => Some(RunCommand::Remote),
            _ => None,
        }
    }

    /// Special registers that start with a value other than 0, e.g. D8000 = 200.
    pub fn special_words(&self) -> impl Iterator<Item = (Register, i16)> + use<> {
        self.presets(DeviceClass::D)
            .map(|(number, value)| (Register(number), value))
    }

    /// Special devices of a class that start with a value other than 0: their numbers, which fit, and the values.
    fn presets(&self, class: DeviceClass) -> impl Iterator<Item = (u16, i16)> + use<> {
        self.specials()
            .filter(move |row| row.class == class && row.default != 0)
            .flat_map(|row| (row.first..=row.last).map(|number| (number as u16, row.default)))
    }

    /// First relay and register of the analog adapter or board with this number, if the model takes it.
    pub fn module_devices(&self, unit: u16) -> Option<u32> {
        let rows = self.specials();
        let own = rows.filter(|row| row.status == Status::Module(unit));
        own.map(|row| row.first).min()
    }

    /// Value of a special register at power-on; 0 of one that has no meaning on the model.
    pub fn word_at_power_on(&self, register: Register) -> i16 {
        let row = self.special(DeviceClass::D, register.number());
        row.map_or(0, |row| row.default)
    }

    /// Returns true if a special relay is on at power-on.
    pub fn is_on_at_power_on(&self, relay: Relay) -> bool {
        let row = self.special(DeviceClass::M, relay.number());
        row.is_some_and(|row| row.default != 0)
    }

    /// Code of model and version, which D8001 shows; 0 on a model that does not show any.
    pub fn type_code(&self) -> u16 {
        self.word_at_power_on(D_TYPE) as u16
    }

    /// Special relays that are on at power-on.
    pub fn special_bits(&self) -> impl Iterator<Item = Relay> + use<> {
        self.presets(DeviceClass::M)
            .map(|(number, _)| Relay(number))
    }

    /// Relays that go off when the model goes from RUN to STOP.
    pub fn cleared_in_stop(&self) -> impl Iterator<Item = Relay> + use<> {
        let relays = self.cleared_in_stop.iter().copied().flatten();
        relays.cloned().flatten().map(Relay)
    }
}

/// Relays that forbid interrupts (l01s-programming §6.4).
pub(crate) const MASKS: &[RangeInclusive<u16>] = &[8050..=8059];
/// Relays that choose modes of instructions (FX3 programming manual §16.3, §16.5, §24.4 for M8161; FX3U hardware
/// manual, special auxiliary relays, pp. 789–802).
pub(crate) const MODES: &[RangeInclusive<u16>] =
    &[8025..=8027, 8160..=8161, 8164..=8165, 8167..=8168];

const fn because(missed: Missed, text: &'static str) -> Reason {
    Reason { text, missed }
}

// Reasons why devices are inert.
pub(crate) const POWER: Reason = because(
    Missed::Never,
    "of supply and battery, only a failure and the voltage are watched",
);
pub(crate) const POWER_ON: Reason =
    because(Missed::Never, "a failure of power shows as power-on alone");
pub(crate) const HARDWARE: Reason = because(
    Missed::Never,
    "there is no hardware here that could fail so",
);
pub(crate) const CHECKED: Reason = because(
    Missed::Never,
    "errors of this kind are found before the program runs",
);
pub(crate) const COUNTER_INPUTS: Reason = because(
    Missed::ByWriters,
    "high-speed counters always have their usual inputs and modes",
);
pub(crate) const INPUT_DELAY: Reason = because(
    Missed::ByWriters,
    "input interrupts are requested at once, without a delay",
);
pub(crate) const INPUT_FILTER: Reason =
    because(Missed::Never, "inputs arrive as the host filters them");
pub(crate) const UNCLEAR: Reason = because(
    Missed::ByWriters,
    "the manual describes it as a position in Hz, and that of Y0 as reserved; positions are counted in D8140 and similar registers",
);
pub(crate) const LATER: Reason = because(
    Missed::ByWriters,
    "according to its manual, the model does not support this yet",
);
pub(crate) const CONTROL_LINES: Reason =
    because(Missed::ByAll, "serial ports here have no control lines");
pub(crate) const NO_PORT: Reason = because(
    Missed::ByAll,
    "the manual lists it, but the model has no such port",
);
pub(crate) const NO_CAN: Reason = because(
    Missed::ByAll,
    "the manual lists it, but the model has no CAN",
);
pub(crate) const NO_LINK: Reason = because(
    Missed::ByWriters,
    "COM0 speaks the programming port's protocol and Modbus, not a computer link",
);
pub(crate) const FORBIDDEN: Reason = because(Missed::ByWriters, "the manual forbids to use it");
pub(crate) const BOARDS: Reason = because(
    Missed::Never,
    "a port works here with any board or without one",
);
pub(crate) const SHOWN: Reason = because(
    Missed::ByAll,
    "it repeats for the editor what other registers say",
);
pub(crate) const DELIMITER: Reason = because(
    Missed::ByWriters,
    "messages of Modbus ASCII end with CR and LF, as its specification says",
);
pub(crate) const INVERTERS: Reason = because(
    Missed::ByAll,
    "the instructions for Mitsubishi inverters cannot be compiled; RS2 and ADPRW reach inverters, too",
);
pub(crate) const SUMMED: Reason = because(
    Missed::ByWriters,
    "frames of links between PLCs always have a sum",
);
pub(crate) const CANLINK: Reason = because(
    Missed::ByAll,
    "no manual prints the frames of CANlink; `[canlink]` of rungc.toml makes a station of it among programs of rungc, without this",
);
pub(crate) const N_SERIES: Reason = because(
    Missed::ByAll,
    "it belongs to units of the N series, whose CAN is not that of this model",
);
pub(crate) const CAN_RATE: Reason = because(
    Missed::ByWriters,
    "bit rate and address are set where the host opens the bus",
);
pub(crate) const CONTROLLER: Reason = because(Missed::Never, "the host watches the CAN controller");
pub(crate) const CAN_FREE: Reason = because(Missed::Never, "CANTX and CANRX work whatever it says");
pub(crate) const AXES: Reason = because(
    Missed::ByAll,
    "the manual does not state which period it means; D212 and D262 show the pulses of a millisecond",
);
pub(crate) const TRACE: Reason =
    because(Missed::Never, "sampling traces are a matter of the editor");
pub(crate) const INTERRUPTS: Reason = because(
    Missed::Never,
    "an interrupt routine never runs in the middle of an instruction",
);
pub(crate) const NETWORK: Reason = because(
    Missed::ByAll,
    "there is no network card; the host serves Modbus TCP itself",
);
pub(crate) const RAW: Reason = because(
    Missed::ByWriters,
    "analog channels show the raw values of the host, each scan",
);
pub(crate) const LATCHES: Reason = because(
    Missed::ByWriters,
    "the latched ranges are chosen when the program is compiled, by the project's PLC parameters or `[latched]` in rungc.toml",
);
pub(crate) const FIXED_AREA: Reason = because(
    Missed::ByWriters,
    "the registers of extension modules always begin at D7100",
);
const UNCOUNTED: Reason = because(
    Missed::ByWriters,
    "Modbus slaves store no counters and no log of events here",
);

/// Modbus on channel 1 and channel 2 (FX3U MODBUS manual §6.1: errors may be written).
pub(crate) static MODBUS_1: PortRole = role(1, Protocols::MODBUS, "a port of Modbus");
pub(crate) static MODBUS_2: PortRole = PortRole {
    port: 2,
    ..MODBUS_1
};
/// The same of slaves, which may store what they count: whether, and where.
pub(crate) static SLAVE_1: PortRole = role(1, SLAVES, "a Modbus slave");
pub(crate) static SLAVE_2: PortRole = PortRole { port: 2, ..SLAVE_1 };
pub(crate) static COUNTING_1: PortRole = PortRole {
    inert: Some(UNCOUNTED),
    ..SLAVE_1
};
pub(crate) static COUNTING_2: PortRole = PortRole {
    port: 2,
    ..COUNTING_1
};
/// Computer links, which send what a program asks for (h1u-h2u-programming §5.6; FX data communication manual, part E).
pub(crate) static LINK_1: PortRole = PortRole {
    by_parameters: true,
    ..role(
        1,
        Protocols::of(&[Protocol::ComputerLink]),
        "on a computer link",
    )
};
pub(crate) static LINK_2: PortRole = PortRole { port: 2, ..LINK_1 };

const SLAVES: Protocols = Protocols::of(&[Protocol::ModbusRtu, Protocol::ModbusAscii]);

const fn role(port: u8, protocols: Protocols, title: &'static str) -> PortRole {
    PortRole {
        port,
        protocols,
        title,
        by_parameters: false,
        inert: None,
    }
}

const NOT_FITTED: Reason = because(
    Missed::ByAll,
    "no `[[module]]` in rungc.toml lists the module that it belongs to",
);
pub(crate) const ADAPTERS_MISSING: Reason = because(
    Missed::ByAll,
    "this model takes no special adapters for analog values; the host may write their registers",
);
pub(crate) const EXTENSION_BOARDS: Reason = because(
    Missed::ByAll,
    "boards with inputs and outputs for FX1S and FX1N are not simulated; the host may write their relays",
);
pub(crate) const DISPLAY: Reason = because(
    Missed::ByWriters,
    "there is no display module; the live page and panels show devices",
);
pub(crate) const MODULE_COUNT: Reason = because(
    Missed::ByAll,
    "modules are listed in rungc.toml, not counted by the program",
);
pub(crate) const TIMING: Reason = because(
    Missed::ByAll,
    "it measures the controller's own processor; `rungc build --report` states what a compiled program needs",
);
pub(crate) const MAKER: Reason = because(Missed::Never, "it serves the maker's tools only");

/// Writes a table of special devices, a row a line: `class first[-last] access default status "text";` with the
/// access `r`, `rw` or `r(ROLE)` and the status `scan`, `by("…")`, `modules(…)`, `module(…)` or `inert(…)`.
macro_rules! specials {
    ($(
        $class:ident $first:literal $(- $last:literal)?
        $access:ident $(($role:expr))? $default:literal $status:ident $(($why:expr))? $text:literal;
    )*) => {
        &[$($crate::special::Special {
            class: ::rungc_syntax::DeviceClass::$class,
            first: $first,
            last: $crate::special::specials!(@last $first $($last)?),
            access: $crate::special::specials!(@access $access $($role)?),
            default: $default,
            status: $crate::special::specials!(@status $status $($why)?),
            text: $text,
        }),*]
    };
    (@last $first:literal) => { $first };
    (@last $first:literal $last:literal) => { $last };
    (@access r) => { $crate::special::Access::Read };
    (@access r $role:expr) => { $crate::special::Access::ReadUnless(&$role) };
    (@access rw) => { $crate::special::Access::ReadWrite };
    (@status scan) => { $crate::special::Status::Scan };
    (@status by $instructions:expr) => { $crate::special::Status::Instructions($instructions) };
    (@status modules $place:expr) => { $crate::special::Status::Modules($place) };
    (@status module $unit:expr) => { $crate::special::Status::Module($unit) };
    (@status inert $why:expr) => { $crate::special::Status::Inert($why) };
}
pub(crate) use specials;

#[cfg(test)]
mod tests {
    use super::{Access, CANLINK, POWER_ON, RunCommand, Special, Status};
    use crate::{Model, ModelId};
    use rungc_rt::Register;
    use rungc_rt::modules::{BOARD, Place, named};
    use rungc_syntax::DeviceClass::{self, D, M};
    use std::collections::BTreeSet;

    fn find(id: ModelId, class: DeviceClass, number: u32) -> Option<&'static Special> {
        Model::get(id).special(class, number)
    }

    #[test]
    fn tables_are_sorted_and_say_each_number_once() {
        for id in ModelId::ALL {
            let mut seen = BTreeSet::new();
            for table in Model::get(id).special {
                for pair in table.windows(2) {
                    let (a, b) = (&pair[0], &pair[1]);
                    assert!((a.class, a.last) < (b.class, b.first), "{id:?} {a:?} {b:?}");
                }
            }
            for row in Model::get(id).specials() {
                for number in row.first..=row.last {
                    assert!(seen.insert((row.class, number)), "{id:?} {row:?}");
                }
            }
        }
    }

    #[test]
    fn every_special_device_exists_on_its_model() {
        for id in ModelId::ALL {
            for row in Model::get(id).specials() {
                let model = Model::get(id);
                // HM's axes and modules have registers among the general ones.
                let placed = row.first >= 8000 || id == ModelId::Hm && row.class == D;
                assert!(placed && !row.text.is_empty(), "{row:?}");
                assert!(model.has(row.class, row.first), "{id:?} {row:?}");
                assert!(model.has(row.class, row.last), "{id:?} {row:?}");
            }
        }
    }

    #[test]
    fn rows_are_found_by_model() {
        let of = |id, class, number| {
            find(id, class, number).map(|row| (row.access, row.is_kept_by_scan()))
        };
        assert_eq!(of(ModelId::H2u, M, 8000), Some((Access::Read, true)));
        assert_eq!(of(ModelId::H2u, M, 8210), Some((Access::ReadWrite, false)));
        assert_eq!(of(ModelId::H2u, M, 8010), None);
        assert_eq!(of(ModelId::Hm, M, 8034), Some((Access::ReadWrite, false)));
        assert_eq!(of(ModelId::Fx3u, M, 8034), Some((Access::ReadWrite, true)));
        let flag = find(ModelId::H1u, M, 8024).map(|row| row.status);
        assert_eq!(flag, Some(Status::Instructions("BMOV")));
        assert_eq!(
            find(ModelId::L01s, D, 8020).map(|row| row.default),
            Some(10)
        );
    }

    #[test]
    fn tables_hold_what_manuals_tell_elsewhere() {
        let of = |id, class, number| find(id, class, number).map(|row| row.status);
        // DSZR (h1u-h2u-programming §4.3.11), computer link (§5.6), CANlink 3.0 (§5.9.5), analog cards (§6.7).
        assert_eq!(
            of(ModelId::H2u, M, 8486),
            Some(Status::Instructions("DSZR"))
        );
        let ports = Some(Status::Instructions("serial ports"));
        assert_eq!(of(ModelId::H1u, M, 8128), ports);
        let canlink = Some(Status::Instructions("CANlink"));
        assert_eq!(of(ModelId::H2u, D, 8282), canlink);
        for number in [8307, 8308] {
            assert_eq!(of(ModelId::H2u, D, number), Some(Status::Inert(CANLINK)));
        }
        for number in [8220, 8239] {
            assert_eq!(
                of(ModelId::H1u, D, number),
                Some(Status::Modules(Place::Slot))
            );
        }
        assert_eq!(of(ModelId::Hm, M, 8008), Some(Status::Inert(POWER_ON)));
        // Axes and modules of HM (hm-motion-controller §7, §8.2).
        let axis = Some(Status::Instructions("axis motion"));
        assert_eq!([300, 599, 97].map(|n| of(ModelId::Hm, D, n)), [axis; 3]);
        assert_eq!(of(ModelId::Hm, D, 7142), Some(Status::Modules(Place::Hm)));
        assert_eq!(of(ModelId::Hm, D, 1000), None);
        // FX3G has boards before its adapters (FX3 programming manual §37.2.18).
        for (id, units) in [
            (
                ModelId::Fx3u,
                ["adapter1", "adapter2", "adapter3", "adapter4"],
            ),
            (ModelId::Fx3g, ["board", "board2", "adapter1", "adapter2"]),
        ] {
            for (first, name) in (8260..).step_by(10).zip(units) {
                let unit = named(name).unwrap();
                assert_eq!(Model::get(id).module_devices(unit), Some(first));
                for (class, number) in [(M, first), (M, first + 9), (D, first), (D, first + 9)] {
                    assert_eq!(of(id, class, number), Some(Status::Module(unit)));
                }
            }
        }
        assert_eq!(Model::get(ModelId::Fx1n).module_devices(BOARD), Some(8112));
        assert_eq!(Model::get(ModelId::Fx2n).module_devices(BOARD), None);
        let modules: Vec<_> = Model::get(ModelId::Hm).special_words().collect();
        assert!(modules.contains(&(Register(7143), 60)));
        assert!(modules.contains(&(Register(7144), 60)));
    }

    #[test]
    fn scans_of_constant_length_are_asked_for() {
        let of = |id| {
            let asks = Model::get(id).constant_scan()?;
            Some((
                asks.relay.map(|relay| relay.number()),
                asks.register.number(),
            ))
        };
        assert_eq!(of(ModelId::H2u), Some((Some(8039), 8039)));
        assert_eq!(of(ModelId::Fx1n), Some((Some(8039), 8039)));
        assert_eq!(of(ModelId::L01s), Some((None, 8059)));
        assert_eq!(of(ModelId::Hm), None);
    }

    #[test]
    fn one_model_has_an_oscilloscope() {
        for id in ModelId::ALL {
            let has = Model::get(id).has_oscilloscope();
            assert_eq!(has, id == ModelId::Hm, "{id:?}");
        }
    }

    #[test]
    fn every_model_can_be_put_in_run() {
        for id in ModelId::ALL {
            let expected = match id {
                ModelId::Hm => RunCommand::Remote,
                _ => RunCommand::Forced,
            };
            assert_eq!(Model::get(id).run_command(), Some(expected), "{id:?}");
        }
    }

    #[test]
    fn registers_start_with_their_defaults() {
        let words: Vec<_> = Model::get(ModelId::H2u).special_words().collect();
        // 100000 in the pair D8147, D8146.
        for (number, value) in [(8000, 200), (8002, 24), (8146, -31072), (8147, 1)] {
            let register = Register(number);
            assert!(words.contains(&(register, value)), "{register:?}");
            assert_eq!(Model::get(ModelId::H2u).word_at_power_on(register), value);
        }
    }
}
