//! Serial ports: how a program sets them up.

super::codes! {
    PORT_SET_TWICE = "W0601" "port-set-twice" Warning None,
    "a serial port that is set up in two ways",
    "The program sets a register of the port to two different values in the same scan, so the last one decides; it wants two protocols or two formats on one port. Setting a register to 0 first is not reported.",
    model: "h2u",
    wrong: "LD M8002\nMOV H2 D8126\nLD M8000\nMOV H20 D8126\nEND\n",
    right: "LD M8002\nMOV H20 D8126\nEND\n";

    PORT_NOT_MASTER = "W0602" "port-not-master" Warning None,
    "a Modbus master's instruction on a port that is not a master",
    "The instruction asks slaves by Modbus, but the registers of its port choose another protocol, so nothing is sent. ADPRW of L01S asks by Modbus RTU alone, RD3A and WR3A in ASCII, too. `D8126` = H20 makes COM1 of H1U and H2U an RTU master.",
    model: "h2u",
    wrong: "LD M8002\nMOV H2 D8126\nLD X0\nMODBUS H0203 H100 K1 D20\nEND\n",
    right: "LD M8002\nMOV H20 D8126\nLD X0\nMODBUS H0203 H100 K1 D20\nEND\n";

    PORT_NOT_FREE = "W0603" "port-not-free" Warning None,
    "RS on a port that serves another protocol",
    "RS and similar instructions send and receive characters of the program's own, but the registers of the port choose another protocol, so they do nothing.",
    model: "h2u",
    wrong: "LD M8002\nMOV H2 D8126\nLD X0\nRS D0 K8 D100 K8\nEND\n",
    right: "LD M8002\nMOV H0 D8126\nLD X0\nRS D0 K8 D100 K8\nEND\n";

    LINK_BOTH_ENDS = "W0604" "link-both-ends" Warning None,
    "master and slave of a parallel link in one PLC",
    "M8070 makes the PLC the master of a parallel link, M8071 the slave. With both on, the link does not run, and M8073 comes on.",
    model: "h2u",
    wrong: "LD M8000\nOUT M8070\nOUT M8071\nEND\n",
    right: "LD M8000\nOUT M8070\nEND\n";

    PORT_STATION = "W0605" "port-station" Warning None,
    "a station number that no frame can name",
    "A Modbus slave has a station of 1 to 247, a slave of a computer link one of 0 to 15 (HM: 1 to 63). With another number the port answers no request.",
    model: "h2u",
    wrong: "LD M8002\nMOV H2 D8126\nMOV K250 D8121\nEND\n",
    right: "LD M8002\nMOV H2 D8126\nMOV K25 D8121\nEND\n";

    PORT_SET_LATE = "W0606" "port-set-late" Warning None,
    "a protocol that is chosen after it is fixed",
    "H1U and H2U fix the protocol of each port at the end of the first scan in RUN. A register that is set only under some condition may be set too late, and then takes effect only after the PLC has been stopped and started again.",
    model: "h2u",
    wrong: "LD X0\nMOV H2 D8126\nEND\n",
    right: "LD M8002\nMOV H2 D8126\nEND\n";

    PORT_RATE = "W0607" "port-rate" Warning None,
    "a format word that names no bit rate",
    "Bits 4 to 7 of a format word stand for the bit rate: 3 is 300 bit/s, 8 is 9600 bit/s, 12 is 115,200 bit/s. This word has a value there that stands for none, so the port runs at 9600 bit/s.",
    model: "h2u",
    wrong: "LD M8002\nMOV H2 D8126\nMOV H1 D8120\nEND\n",
    right: "LD M8002\nMOV H2 D8126\nMOV H81 D8120\nEND\n";

    PORT_NO_TABLE = "W0608" "port-no-table" Warning None,
    "a Modbus table without rows",
    "`D8126` = H60 makes COM1 of H1U and H2U a Modbus master that works through a table. The editor downloads the table beside the program; rungc takes its rows from `[[modbus]]` in rungc.toml. Without a row and without an instruction that asks, the port sends nothing.",
    model: "h2u",
    wrong: "LD M8002\nMOV H60 D8126\nEND\n",
    right: "LD M8002\nMOV H20 D8126\nLD X0\nMODBUS H0203 H100 K1 D20\nEND\n";

    LINK_RANGE = "W0609" "link-range" Warning None,
    "a number that an N:N link does not have",
    "`D8176` is the station of an N:N link, 0 to 7 (enhanced: 0 to 15), 0 the master alone; `D8177` in the master is the number of slaves, 1 to 7 (15), `D8178` the mode, 0 to 2. A slave with another station is never asked; a master takes a larger number of slaves as the largest, and another mode as 0.",
    model: "h2u",
    wrong: "LD M8002\nMOV H40 D8126\nMOV K9 D8177\nEND\n",
    right: "LD M8002\nMOV H40 D8126\nMOV K7 D8177\nEND\n";

    PORT_SET_BY_INDEX = "W0690" "port-set-by-index" Warning None,
    "a write that may set up a serial port through an index register",
    "The index decides which register the instruction writes, and some of those that it may reach choose a port's protocol, station or format. A compiled program contains only the protocols that instructions without an index choose. If this instruction alone chooses the protocol, the port of a compiled program stays silent, although it works in `rungc run` and `rungc test`. Name the register instead: `D8126`, not `D8120Z0`.",
    model: "h2u",
    wrong: "LD M8002\nMOV K6 Z0\nMOV H2 D8120Z0\nEND\n",
    right: "LD M8002\nMOV H2 D8126\nEND\n";

    ETHERNET_CARD = "W0700" "ethernet-card" Warning None,
    "a port that is set up for an Ethernet card",
    "`D8270` = HC1, `D8271` = 1 and `D8276` = 2 set up COM3 of H2U for the card H2U-ENET-BD, which serves registers D by Modbus TCP. There is no card beside a compiled program, and its IP address, shared registers and table of requests are in the editor's project, not in the program. COM3 is a Modbus RTU slave. `rungc run --modbus-tcp`, `[serve] modbus-tcp` and executables of `rungc build --servers` serve all devices by Modbus TCP at the addresses that the card has (D500 is 1F4h); rows of `[[modbus]]` with `host` ask other servers, as the card's table does. With `modbus-tcp` or such a row in rungc.toml, and with `run --modbus-tcp`, this is not reported.",
    model: "h2u",
    wrong: "LD M8002\nMOV HC1 D8270\nMOV K1 D8271\nMOV H2 D8276\nEND\n",
    right: "LD M8002\nMOV H81 D8270\nMOV K1 D8271\nMOV H2 D8276\nEND\n";

    CANLINK_REGISTERS = "W0701" "canlink-registers" Warning None,
    "a program of CANlink that writes registers of the network",
    "On a station of CANlink, D7800 to D7863 are the states of the stations. The system writes them in each scan, and the manual forbids a master's program to write D7000 to D7999.",
    model: "h2u",
    wrong: "LD M8000\nCANNET K1 K1 K500\nLD X0\nMOV K2 D7802\nEND\n",
    right: "LD M8000\nCANNET K1 K1 K500\nLD X0\nMOV D7802 D0\nEND\n";

    CANLINK_AND_MODULES = "W0702" "canlink-and-modules" Warning None,
    "remote modules beside CANlink",
    "The manual does not allow FROM and TO of a master beside the configuration of CANlink 3.0. Both use the one CAN card, for remote modules (100 and their station) with another version of CANlink. A compiled program reaches both, if its hardware does.",
    model: "h2u",
    wrong: "LD M8000\nCANNET K1 K1 K500\nFROM K101 K0 D0 K1\nEND\n",
    right: "LD M8000\nCANNET K1 K1 K500\nFROM K0 K0 D0 K1\nEND\n";

    OWN_FRAMES = "N0601" "own-frames" Note None,
    "a link whose frames the manuals do not print",
    "The manuals describe the registers and the effect of this link, but not its frames. rungc uses its own frames, so all partners have to run programs of rungc: a compiled program cannot replace one PLC among others. `rungc book links` describes the frames.",
    model: "h2u",
    wrong: "LD M8002\nMOV H4 D8126\nMOV K1 D8176\nEND\n",
    right: "LD M8002\nMOV H2 D8126\nMOV K1 D8121\nEND\n";
}
