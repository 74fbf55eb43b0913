//! Knowledge of a program's serial ports before it runs.

use rungc_frontend::read_text;
use rungc_lower::compile::{CompileOptions, check, compile};
use rungc_models::ModelId;
use rungc_rt::comm::Protocol;

/// The ports of a program, a line each.
fn ports(model: ModelId, text: &str) -> String {
    let program = read_text("program", text).program;
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let checked = check(&program, &options);
    assert!(!checked.diagnostics.has_errors(), "{text}");
    let lines = checked.ports.iter().map(ToString::to_string);
    lines.collect::<Vec<_>>().join("\n")
}

/// Messages of the warnings with this code.
fn messages(model: ModelId, text: &str, code: &str) -> String {
    let program = read_text("program", text).program;
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let diagnostics = check(&program, &options).diagnostics.sorted();
    let own = diagnostics.into_iter().filter(|d| d.code == code);
    own.map(|d| d.message.to_string())
        .collect::<Vec<_>>()
        .join("; ")
}

/// Two ways to choose a protocol, used at once.
#[test]
fn a_choice_that_another_overrides() {
    let codes = |text: &str| messages(ModelId::H2u, text, "W0601");
    let parallel = "LD M8000\nOUT M8070\nLD M8002\nMOV H2 D8126\nEND\n";
    let link = "LD M8002\nMOV H6086 D8260\nMOV H20 D8266\nEND\n";
    insta::assert_snapshot!([codes(parallel), codes(link)].join("\n"));
    for alike in [
        "LD M8000\nOUT M8070\nLD M8002\nMOV H50 D8126\nEND\n",
        "LD M8002\nMOV H6086 D8120\nMOV H6 D8126\nEND\n",
        "LD M8002\nMOV H6086 D8120\nMOV H40 D8126\nEND\n",
        "LD M8002\nMOV H81 D8120\nMOV H2 D8126\nEND\n",
    ] {
        assert_eq!(codes(alike), "", "{alike}");
    }
}

/// On every family that chooses the ends of a parallel link by relays.
#[test]
fn a_plc_that_is_both_ends_of_a_parallel_link() {
    use ModelId::{Fx1n, Fx2n, Fx3g, Fx3u, H2u};
    for model in [Fx1n, Fx2n, Fx3g, Fx3u, H2u] {
        let both = "LD M8000\nOUT M8070\nOUT M8071\nEND\n";
        assert_eq!(
            messages(model, both, "W0604"),
            "the PLC is both master and slave of a parallel link"
        );
        let one = "LD M8000\nOUT M8070\nEND\n";
        assert_eq!(messages(model, one, "W0604"), "");
    }
}

/// Links with frames that no manual prints.
#[test]
fn a_link_that_an_input_chooses_has_frames_of_its_own() {
    let notes = |model, text: &str| messages(model, &format!("{text}\nEND\n"), "N0601");
    let may_be = |end: &str| {
        format!(
            "COM1 may be the {end} of a parallel link: its partners then have to run programs of rungc, too"
        )
    };
    let is_master =
        "COM1 is the master of a parallel link: its partners have to run programs of rungc, too";
    for model in [ModelId::H2u, ModelId::Fx3u] {
        assert_eq!(notes(model, "LD X0\nOUT M8070"), is_master);
        let held = "LD X0\nSET M8070\nLDI X0\nRST M8070";
        assert_eq!(notes(model, held), may_be("master"));
        let either = "LD X0\nOUT M8070\nLDI X0\nOUT M8071";
        assert_eq!(notes(model, either), may_be("master"));
        let slave = "LD X1\nRST M8071\nLD X0\nSET M8071";
        assert_eq!(notes(model, slave), may_be("slave"));
        assert_eq!(notes(model, "LD X0\nRST M8070"), "");
    }
    let numbers = "LD X0\nMOV H2 D8126\nLDI X0\nMOV H3 D8126";
    assert_eq!(notes(ModelId::H2u, numbers), "");
}

#[test]
fn constants_say_what_a_port_will_be() {
    use ModelId::{Fx3u, H2u, Hm, L01s};
    let shown = |model, text: &str| format!("{text}=> {}\n", ports(model, text));
    insta::assert_snapshot!(
        [
            "Modbus slave",
            &shown(
                H2u,
                "LD M8002\nMOV H2 D8126\nMOV H89 D8120\nMOV K3 D8121\nEND\n"
            ),
            "a station that the program computes",
            &shown(H2u, "LD M8002\nMOV H3 D8126\nMOV K2X0 D8121\nEND\n"),
            "a format that the program computes",
            &shown(H2u, "LD M8002\nMOV H2 D8126\nMOV D0 D8120\nEND\n"),
            "a protocol that the program computes",
            &shown(H2u, "LD M8002\nMOV D0 D8126\nMOV H81 D8120\nEND\n"),
            "a protocol that an input chooses",
            &shown(H2u, "LD X0\nMOV H2 D8126\nLDI X0\nMOV H6 D8126\nEND\n"),
            "two ports; COM0 stays what it is",
            &shown(H2u, "LD M8002\nMOV H40 D8126\nMOV H60 D8266\nEND\n"),
            "registers cleared before they are set",
            &shown(
                H2u,
                "LD M8002\nFMOV K0 D8120 K10\nMOV H20 D8126\nMOV HC1 D8120\nEND\n"
            ),
            "32 bits at once: format and station",
            &shown(H2u, "LD M8002\nDMOV H50081 D8120\nMOV H2 D8126\nEND\n"),
            "an instruction alone",
            &shown(H2u, "LD X0\nRS D0 K8 D100 K8\nEND\n"),
            "a parallel link by its relay",
            &shown(H2u, "LD M8000\nOUT M8070\nEND\n"),
            "no port",
            &shown(H2u, "LD X0\nOUT Y0\nEND\n"),
            "port 2 of L01S as a master",
            &shown(
                L01s,
                "LD M8000\nOUT M8196\nOUT M8125\nLD M8002\nMOV K255 D8121\nMOV HA1 D8120\nEND\n"
            ),
            "port 3 of L01S as a slave",
            &shown(
                L01s,
                "LD M8000\nOUT M8192\nLD M8002\nMOV H111 D8401\nMOV K7 D8414\nMOV H97 D8400\nEND\n"
            ),
            "HM",
            &shown(Hm, "LD M8002\nUINIT H0305 H0108 K100 K1\nEND\n"),
            "HM, by registers",
            &shown(Hm, "LD M8002\nUINIT D0 H0108 K100 K1\nEND\n"),
            "computer link of FX3U",
            &shown(Fx3u, "LD M8002\nMOV H6086 D8120\nEND\n"),
        ]
        .join("\n")
    );
}

/// Agreement of the check with the compiled program about a port: a protocol that the check names is there, and where
/// it says that the protocol is chosen at run time, all that may be chosen are.
#[test]
fn a_compiled_program_has_the_protocols_that_the_check_names() {
    use ModelId::{H2u, Hm};
    use Protocol::{ComputerLink, ModbusAscii, ModbusRtu, ParallelMaster};
    let others = [ComputerLink, ModbusAscii, ParallelMaster];
    let cases: [(_, _, _, &[_], &[_]); 7] = [
        // Registers that are cleared before, and by RST, have known values.
        (
            H2u,
            "LD M8002\nFMOV K0 D8120 K10\nMOV H2 D8126\nMOV H81 D8120\nEND\n",
            Some(ModbusRtu),
            &[ModbusRtu],
            &others,
        ),
        (
            H2u,
            "LD M8000\nRST D8126\nLD M8002\nMOV H2 D8126\nEND\n",
            Some(ModbusRtu),
            &[ModbusRtu],
            &others,
        ),
        // Reading a register or a relay chooses nothing.
        (
            H2u,
            "LD M8002\nMOV H2 D8126\nLD M8000\nADD D8126 K1 D0\nEND\n",
            Some(ModbusRtu),
            &[ModbusRtu],
            &others,
        ),
        (
            H2u,
            "LD M8002\nMOV H2 D8126\nLD M8070\nOUT Y0\nEND\n",
            Some(ModbusRtu),
            &[ModbusRtu],
            &others,
        ),
        // A run of registers whose length is not a constant may reach the number of the protocol.
        (
            H2u,
            "LD M8002\nMOV H2 D8126\nLD X0\nRS D0 K8 D8100 D5\nEND\n",
            None,
            &[ModbusRtu, ModbusAscii, ComputerLink],
            &[],
        ),
        // UINIT may be about any port if its number is not a constant.
        (
            Hm,
            "LD M8002\nUINIT H0305 H0108 K100 K1\nUINIT H0405 H0108 K100 D0\nEND\n",
            None,
            &[ComputerLink, ModbusRtu],
            &[],
        ),
        (
            Hm,
            "LD M8002\nUINIT H0305 H0108 K100 K1\nEND\n",
            Some(ComputerLink),
            &[ComputerLink],
            &[ModbusRtu],
        ),
    ];
    for (model, text, named, there, left_out) in cases {
        let program = read_text("program", text).program;
        let options = CompileOptions {
            model: Some(model),
            ..CompileOptions::default()
        };
        let compiled = compile(&program, &options);
        let module = compiled.module.expect("the program compiles");
        let setup = compiled.ports.iter().find(|setup| setup.port == 1);
        let setup = setup.expect("the program sets up COM1");
        assert_eq!(setup.protocol, named, "{text}");
        let at = module.ports.iter().position(|&port| port == 1);
        let protocols = module.port_protocols[at.expect("COM1 is compiled")];
        for &protocol in there {
            assert!(protocols.contains(protocol), "{protocol:?}: {text}");
        }
        for &protocol in left_out {
            assert!(!protocols.contains(protocol), "{protocol:?}: {text}");
        }
    }
}

/// A port whose registers are set to very many values takes no longer than one that may speak anything.
#[test]
fn very_many_values_are_as_good_as_any() {
    let values = (0..2000).map(|value| format!("MOV K{value} D8126\nMOV K{value} D8120\n"));
    let text = format!("LD X0\n{}END\n", values.collect::<String>());
    let program = read_text("program", &text).program;
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        ..CompileOptions::default()
    };
    let module = compile(&program, &options).module.expect("it compiles");
    let protocols = module.port_protocols.iter();
    assert!(protocols.clone().any(|of| of.contains(Protocol::NnSlave)));
}

/// Requests of L01S need a port whose station is 255. RD3A and WR3A name the port in the register before their data
/// (l01s-programming, RD3A, WR3A); ADPRW uses the one in D8397.
#[test]
fn requests_of_l01s_need_a_port_that_asks() {
    let port = |station| {
        let set_up =
            "LD M8000\nOUT M8196\nOUT M8125\nLD M8002\nMOV HA1 D8120\nMOV K0 D8397\nMOV K0 D99\n";
        format!("{set_up}MOV {station} D8121\nLD X0\n")
    };
    let requests = [
        "RD3A H1 K0 D100",
        "WR3A H1 K0 D100",
        "ADPRW H1 H3 K0 K2 D100",
    ];
    let warned = requests.map(|request| {
        let program = |station| format!("{}{request}\nEND\n", port(station));
        let warnings = |station| messages(ModelId::L01s, &program(station), "W0602");
        assert_eq!(warnings("K255"), "", "{request}");
        warnings("K7")
    });
    insta::assert_snapshot!(warned.join("\n"));
}
