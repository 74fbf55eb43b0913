//! Many PLCs at once: `rungc fleet`.

super::codes! {
    FLEET_FILE = "E0870" "fleet-file" Error None,
    "fleet.toml describes no fleet that can run",
    "fleet.toml says which programs run how often, and what their PLCs are connected to: `[fleet]` with the cycle, `[broker]` with the address of a broker, and a table `[plc.NAME]` for each program. An unknown table or key is rejected, because a misspelt one would otherwise be ignored. `rungc book fleet` explains the keys.",
    wrong: "",
    right: "";

    FLEET_ENGINE = "E0871" "fleet-engine" Error None,
    "the PLCs of a fleet cannot run on this engine",
    "`engine = \"lanes\"` runs 64 PLCs at once in emitted C, which the C compiler `cc` of this machine builds. A program that takes interrupts, sends pulses, uses serial ports, calls the runtime library, stops itself or has a loop that only the watchdog may end does not run so; the message says which of these it is. `engine = \"c\"` runs the PLCs of a program in emitted C one after the other; there it may call the runtime library, which needs Rust, if it asks no hardware, and may stop. Write `engine = \"interp\"`, or leave the key out: then the PLCs run on the fastest engine that runs the program.",
    wrong: "",
    right: "";

    FLEET_DEVICE = "E0872" "fleet-device" Error None,
    "a fleet sets a device that cannot be set",
    "A setting of `set` is a device, its value and perhaps a time: `X000=1@200ms`. It names a device of the model that takes this value. Channels of special modules and characters cannot be set in a fleet.",
    wrong: "",
    right: "";

    FLEET_PORT = "E0873" "fleet-port" Error None,
    "a port of a fleet cannot be opened",
    "With `modbus-tcp`, each PLC has the port after that of the PLC before it, or with `units` as many PLCs share a port. One of these ports is taken by another program, is above 65535, or the system allows no more open files (`ulimit -n`). Begin at another port, or let PLCs share ports.",
    wrong: "",
    right: "";
}
