use crate::{Explainer, History, HowOptions};
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_lower::marks::Marks;
use rungc_rt::VirtualHal;
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, Program};

struct Built {
    program: Program,
    module: Module,
    marks: Marks,
}

fn build(list: &str) -> Built {
    let program = rungc_frontend::read_text("test.il", list).program;
    let options = CompileOptions {
        observe_all: true,
        marks: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    Built {
        module: compiled.module.expect("compiles"),
        marks: compiled.marks.expect("marks"),
        program,
    }
}

fn device(name: &str) -> Device {
    let (class, first) = match Target::parse(name).unwrap() {
        Target::Bit(class, number) | Target::Word(class, number) => (class, number),
        other => panic!("{other}"),
    };
    Device {
        class,
        number: first,
    }
}

/// The text about a device after these settings, each followed by a scan.
fn after(list: &str, settings: &[&str], name: &str) -> String {
    let built = build(list);
    let explainer = Explainer::new(&built.program, &built.module, &built.marks);
    let mut session = Session::new(&built.module, VirtualHal::new());
    let mut history = History::new(session.machine(), device(name));
    for setting in settings {
        for one in setting.split_whitespace() {
            let (target, value) = one.split_once('=').unwrap();
            let target = Target::parse(target).unwrap();
            session.set(target, value.parse().unwrap()).unwrap();
        }
        let ms = session.now_ms();
        session.scan(10);
        history.scanned(session.machine(), ms);
        session.pass(10);
    }
    explainer
        .at_moment(&mut session, None, device(name), Some(&history))
        .text()
}

/// Programs, settings with a scan after each, and the device that is explained.
const CASES: [(&str, &str, &[&str], &str); 16] = [
    (
        "a contact that is open",
        ";! X000 = start\n;! X001 = stop\nLD X000\nOR M0\nANI X001\nOUT M0\nLD M0\nAND X002\nOUT Y000\nEND\n",
        &["X000=1", "X000=0"],
        "Y000",
    ),
    (
        "a coil that holds itself",
        "LD X000\nOR M0\nANI X001\nOUT M0\nEND\n",
        &["X000=1", "X000=0"],
        "M0",
    ),
    (
        "a timer",
        "LD X000\nOUT T0 K30\nLD T0\nOUT Y000\nEND\n",
        &["X000=1", "", "", ""],
        "Y000",
    ),
    (
        "a latch",
        "LD X000\nSET Y000\nLD X001\nRST Y000\nEND\n",
        &["X000=1", "X000=0"],
        "Y000",
    ),
    (
        "a latch that nothing resets",
        "LD X000\nSET M500\nEND\n",
        &["X000=1"],
        "M500",
    ),
    (
        "a master control",
        "LD X000\nMC N0 M100\nLD X001\nOUT Y000\nMCR N0\nEND\n",
        &["X001=1"],
        "Y000",
    ),
    (
        "a state",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nSET S20\nSTL S20\nOUT Y000\nLD X001\nSET S0\nRET\nEND\n",
        &["", ""],
        "Y000",
    ),
    (
        "a jump",
        "LD X000\nCJ P0\nLD X001\nOUT Y000\nP0\nEND\n",
        &["X000=1 X001=1"],
        "Y000",
    ),
    (
        "a routine",
        "LD X000\nCALL P0\nFEND\nP0\nLD X001\nOUT Y000\nSRET\nP1\nLD X002\nOUT Y000\nSRET\nEND\n",
        &["X001=1"],
        "Y000",
    ),
    (
        "a counter",
        "LD X000\nOUT C0 K3\nLD C0\nOUT Y000\nEND\n",
        &["X000=1", "X000=0"],
        "Y000",
    ),
    (
        "a comparison",
        "LD> D0 K100\nAND X000\nOUT Y000\nEND\n",
        &["X000=1"],
        "Y000",
    ),
    (
        "a value through an index",
        "LD X000\nMOV D0Z0 K1Y000\nLDP X001\nOUT Y010\nEND\n",
        &["X000=1"],
        "Y000",
    ),
    (
        "an edge",
        "LDP X001\nOUT Y010\nEND\n",
        &["X001=1", ""],
        "Y010",
    ),
    (
        "a register",
        "LD X000\nMOV K5 D0\nLD> D0 K3\nOUT Y000\nEND\n",
        &[""],
        "D0",
    ),
    (
        "a register that is computed and reset",
        "LD X000\nADD D1 D2 D0\nLD X001\nRST D0\nEND\n",
        &[""],
        "D0",
    ),
    (
        "an output of pulses",
        "LD X000\nPLSY K100 K0 Y000\nEND\n",
        &["X000=1"],
        "Y000",
    ),
];

#[test]
fn each_kind_of_cause_has_its_words() {
    let mut all = String::new();
    for (title, list, settings, name) in CASES {
        let built = build(list);
        let explainer = Explainer::new(&built.program, &built.module, &built.marks);
        let alone = explainer.of_program(device(name)).text();
        all += &format!(
            "# {title}\n{alone}\n-- {settings:?}\n{}\n",
            after(list, settings, name)
        );
    }
    insta::assert_snapshot!(all);
}

#[test]
fn an_answer_leaves_the_run_as_it_was() {
    let built = build("LD X000\nOUT T0 K2\nLD T0\nOUT Y000\nEND\n");
    let explainer = Explainer::new(&built.program, &built.module, &built.marks);
    let mut session = Session::new(&built.module, VirtualHal::new());
    session.set(Target::parse("X000").unwrap(), 1.0).unwrap();
    let mut came_on = None;
    for scan in 0..40 {
        let why = explainer.at_moment(&mut session, None, device("Y000"), None);
        let moment = why.moment.unwrap();
        let next = moment.next.unwrap_or(moment.value);
        session.scan(10);
        session.pass(10);
        let on = session.reading(Target::parse("Y000").unwrap()).unwrap();
        assert_eq!(
            next == "on",
            on == rungc_sim::record::Reading::Bit(true),
            "{scan}"
        );
        came_on = came_on.or((next == "on").then_some(scan));
    }
    assert_eq!(came_on, Some(20));
}

/// Contacts of relays that are always on or off are in conditions as they are in the program.
#[test]
fn contacts_that_never_change_are_shown_as_they_are() {
    let built = build(
        "LDI M8000\nOUT Y000\nLD X001\nANI M8000\nOUT Y001\nLD M8000\nOUT Y002\nLD X001\nORI M8001\nOUT Y003\n\
         LD M8000\nINV\nOUT Y004\nLDI M8000\nINV\nOUT Y005\nLDP X001\nINV\nOUT Y006\nEND\n",
    );
    let explainer = Explainer::new(&built.program, &built.module, &built.marks);
    for (name, condition) in [
        ("Y000", "not M8000"),
        ("Y001", "X001 and not M8000"),
        ("Y002", "M8000"),
        ("Y003", "X001 or not M8001"),
        ("Y004", "not M8000"),
        ("Y005", "M8000"),
        ("Y006", "not (X001 coming on)"),
    ] {
        let why = explainer.of_program(device(name));
        assert_eq!(why.writers[0].condition, condition, "{name}");
    }
}

/// What a person can do about a device, from the moment after these settings.
fn how(list: &str, settings: &[&str], name: &str) -> (String, crate::How) {
    let built = build(list);
    let explainer = Explainer::new(&built.program, &built.module, &built.marks);
    let mut session = Session::new(&built.module, VirtualHal::new());
    for setting in settings {
        for one in setting.split_whitespace() {
            let (target, value) = one.split_once('=').unwrap();
            let target = Target::parse(target).unwrap();
            session.set(target, value.parse().unwrap()).unwrap();
        }
        session.scan(10);
        session.pass(10);
    }
    let mut why = explainer.at_moment(&mut session, None, device(name), None);
    let how = explainer.how(&mut session, device(name), &HowOptions::default());
    why.how = Some(how.clone());
    let text = why.text();
    (
        text[text.find("\nFor it").or(text.find("\nNo way")).unwrap()..].to_string(),
        how,
    )
}

#[test]
fn what_a_person_can_do_is_found() {
    let cases: [(&str, &str, &[&str], &str); 10] = [
        (
            "a conveyor",
            ";! X000 = start\n;! X001 = stop\n;! X002 = guard\nLD X000\nOR M0\nANI X001\nAND X002\nOUT M0\nLD X003\nOUT T0 K20\nLD T0\nOUT M1\nLD M0\nANI M1\nOUT Y000\nEND\n",
            &["X003=1"; 30],
            "Y000",
        ),
        (
            "a timer",
            "LD X000\nOUT T0 K300\nLD T0\nOUT Y000\nEND\n",
            &[""],
            "Y000",
        ),
        (
            "a counter",
            "LD X000\nOUT C0 K30\nLD X001\nRST C0\nLD C0\nAND X002\nOUT Y000\nEND\n",
            &["X001=1"],
            "Y000",
        ),
        (
            "a latch",
            "LD X000\nSET Y000\nLDP X001\nRST Y000\nEND\n",
            &["X000=1 X001=1"],
            "Y000",
        ),
        (
            "a sequence",
            "LD M8002\nSET S0\nSTL S0\nLD X000\nSET S20\nSTL S20\nOUT T0 K15\nLD T0\nAND X001\nSET S21\nSTL S21\nOUT Y000\nLD X002\nSET S0\nRET\nEND\n",
            &[""],
            "Y000",
        ),
        (
            "a panel",
            "LD M10\nAND M11\nOUT Y000\nRST M11\nLD> D0 K100\nSET M11\nEND\n",
            &[""],
            "Y000",
        ),
        (
            "a clock",
            "LD X000\nANDP M8013\nINC D0\nLD= D0 K4\nOUT Y000\nEND\n",
            &[""],
            "Y000",
        ),
        (
            "a code",
            "LDP X001\nAND X000\nANI X002\nSET M1\nLDP X002\nAND M1\nSET M2\nLDF X001\nAND M2\nOUT Y000\nEND\n",
            &[""],
            "Y000",
        ),
        (
            "nothing",
            "LD X000\nANI X000\nOUT Y000\nEND\n",
            &[""],
            "Y000",
        ),
        ("an input", "LD X000\nOUT Y000\nEND\n", &["X000=1"], "X000"),
    ];
    let mut all = String::new();
    for (title, list, settings, name) in cases {
        let (text, _) = how(list, settings, name);
        all += &format!("# {title}{text}\n");
    }
    insta::assert_snapshot!(all);
}

#[test]
fn long_sequences_are_found() {
    // A code of inputs in order.
    let mut list = String::from("LD M8002\nSET S0\n");
    for (n, input) in [3, 1, 4, 1, 5, 2, 6, 5, 3, 7].into_iter().enumerate() {
        let state = if n == 0 { 0 } else { 20 + n };
        list += &format!(
            "STL S{state}\nLD X{input:03o}\nANDP X000\nSET S{}\n",
            21 + n
        );
    }
    list += "STL S30\nOUT Y000\nRET\nEND\n";
    let (_, how) = how(&list, &[""], "Y000");
    assert!(how.found, "{how:?}");
}
