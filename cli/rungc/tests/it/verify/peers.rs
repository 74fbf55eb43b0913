//! Solvers, checkers and model checkers that others wrote agree with verdicts and confirm proofs.

use super::LINE;
use crate::common::{folder, reverser, rungc, text};
use std::path::Path;
use std::process::Command;

/// The first of these programs that is installed.
fn installed<'a>(names: &[&'a str]) -> Option<&'a str> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut names = names.iter().copied();
    names.find(|name| std::env::split_paths(&path).any(|folder| folder.join(name).is_file()))
}

/// Programs that keep Y000 and Y001 apart: by induction, by an invariant, and one that holds only while the counter
/// keeps below its limit.
fn kept_apart() -> [String; 3] {
    let timer = "LD X000\nANI Y001\nOUT T0 K3\nLD T0\nOUT Y000\nLDI X000\nANI T0\nOUT Y001\nEND\n";
    let chain = "LD X000\nOUT M0\nLD M0\nANI M20\nOUT M1\nLDP X001\nADD D0 K1 D0\nLD> D0 K5\nMOV K0 D0\n\
                 LD> D0 K9\nOUT M20\nLD M20\nOUT Y000\nLD M1\nOUT Y001\nEND\n";
    [reverser("ANI Y000"), timer.to_string(), chain.to_string()]
}

/// Arguments of every test of a proof.
const PROVED: [&str; 7] = [
    "verify",
    "program.il",
    "--never",
    "Y000 & Y001",
    "--certificate",
    "proof",
    "--cleared",
];

/// Returns true if a peer is installed; one that `.ci/run` has installed must be.
fn there(peer: &str, variable: &str, is_there: bool) -> bool {
    let required = std::env::var_os(variable).is_some();
    assert!(
        is_there || !required,
        "{variable} is set, but there is no {peer}"
    );
    if !is_there {
        eprintln!("skipped: there is no {peer} ({variable}; see .ci/run)");
    }
    is_there
}

/// Number of formulas in a folder: SAT solvers find that none of them can be satisfied.
fn confirmed(folder: &Path, solvers: &[&str]) -> usize {
    let mut formulas = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        formulas += 1;
        let path = entry.unwrap().path();
        for solver in solvers {
            let requested = Command::new(solver).arg(&path).output().unwrap();
            // Solvers agree on the exit code of what cannot be satisfied.
            assert_eq!(
                requested.status.code(),
                Some(20),
                "{solver} {}: {}",
                path.display(),
                text(&requested.stdout)
            );
        }
    }
    formulas
}

/// The solvers that are installed; none: the test says so and does not run.
fn solvers() -> Vec<&'static str> {
    let all = ["cadical", "minisat"].map(|name| installed(&[name]));
    let found: Vec<&str> = all.into_iter().flatten().collect();
    match there(
        "cadical or minisat",
        "RUNGC_REQUIRE_PEERS",
        !found.is_empty(),
    ) {
        true => found,
        false => Vec::new(),
    }
}

#[test]
fn sat_solvers_confirm_proofs() {
    let solvers = solvers();
    for program in kept_apart().iter().filter(|_| !solvers.is_empty()) {
        let folder = folder(&[("program.il", program.as_bytes())]);
        let output = rungc(folder.path(), &PROVED);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let formulas = confirmed(&folder.path().join("proof"), &solvers);
        assert!(formulas >= 2, "{formulas} formulas");
    }
}

/// Two programs that count the same edges in different registers: equal bit by bit, as an induction shows.
const COUNTED: [&str; 2] = [
    "LDP X000\nADD D0 K1 D0\nLD> D0 K5\nMOV K0 D0\nLD= D0 K4\nOUT Y000\nLD X001\nOUT T0 K30\nLD T0\nOUT Y001\nEND\n",
    "LD X000\nANI M9\nOUT M8\nLD X000\nOUT M9\nLD M8\nADD D7 K1 D7\nLD> D7 K5\nMOV K0 D7\nLD= D7 K4\nOUT Y000\n\
     LD X001\nOUT T0 K30\nLD T0\nOUT M1\nLD M1\nOUT Y001\nEND\n",
];

/// One counts up, the other down: no bit equals another, which takes an invariant.
const UP_AND_DOWN: [&str; 2] = [
    "LDP X000\nINC D0\nLD> D0 K5\nMOV K0 D0\nLD= D0 K4\nOUT Y000\nEND\n",
    "LD M8002\nMOV K5 D7\nLDP X000\nDEC D7\nLD< D7 K0\nMOV K5 D7\nLD= D7 K1\nOUT Y000\nEND\n",
];

/// The two contacts of a latch, and a relay that nothing else reads, for the latch of [`LINE`].
fn rewritten() -> String {
    LINE.replace(
        "LD X000\nOR M0\nANI X001\nOUT M0\n",
        "LDI X001\nOUT M9\nLD M9\nAND X000\nLD M0\nAND M9\nORB\nOUT M0\n",
    )
}

#[test]
fn sat_solvers_confirm_that_outputs_are_the_same() {
    let solvers = solvers();
    if solvers.is_empty() {
        return;
    }
    let rewritten = rewritten();
    let programs = [
        ([LINE, rewritten.as_str()], "memory.cnf"),
        (COUNTED, "Y000-bits-step.cnf"),
        (UP_AND_DOWN, "Y000-end.cnf"),
    ];
    for ([old, new], needed) in programs {
        let folder = folder(&[("old.il", old.as_bytes()), ("new.il", new.as_bytes())]);
        let args = [
            "verify",
            "new.il",
            "--same-as",
            "old.il",
            "--cleared",
            "--certificate",
            "proof",
        ];
        let output = rungc(folder.path(), &args);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let proof = folder.path().join("proof");
        assert!(proof.join(needed).exists(), "{needed}");
        confirmed(&proof, &solvers);
    }
    // Different outputs have no formulas.
    let old = COUNTED[0];
    let folder = folder(&[
        ("old.il", old.as_bytes()),
        ("new.il", old.replace("K30", "K31").as_bytes()),
    ]);
    let args = [
        "verify",
        "new.il",
        "--same-as",
        "old.il",
        "--certificate",
        "proof",
        "--replay",
        "interp",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let proof = folder.path().join("proof");
    assert!(proof.join("memory.cnf").exists());
    assert!(!proof.join("Y001-begin.cnf").exists());
    confirmed(&proof, &solvers);
}

/// Checks a proof with a checker that others wrote; the exit code says whether each step follows.
const CHECK: &str = "\
import dratify, sys
formula, proof = sys.argv[1:]
result = dratify.check_proof(dratify.parse_dimacs_file(formula), open(proof).read())
print(result.report())
sys.exit(0 if result.ok and result.reached_empty else 1)
";

#[test]
fn a_checker_follows_every_step_of_a_proof() {
    let with_drat = [&PROVED[..], &["--drat"]].concat();
    let program = kept_apart()[2].clone();
    let folder = folder(&[("program.il", program.as_bytes())]);
    // Without a solver on the path, no proof is written, and this is reported.
    let alone = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(&with_drat)
        .current_dir(folder.path())
        .env("PATH", folder.path())
        .output()
        .unwrap();
    assert_eq!(alone.status.code(), Some(2));
    insta::assert_snapshot!("no_solver", text(&alone.stderr));
    assert!(!folder.path().join("proof").exists());
    let cadical = installed(&["cadical"]).is_some();
    if !there("cadical", "RUNGC_REQUIRE_PEERS", cadical) {
        return;
    }
    let python = std::env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let has_checker = Command::new(&python)
        .args(["-c", "import dratify"])
        .stderr(std::process::Stdio::null())
        .status();
    let has_checker = has_checker.is_ok_and(|status| status.success());
    if !there("dratify", "RUNGC_PYTHON", has_checker) {
        return;
    }
    for program in kept_apart() {
        std::fs::write(folder.path().join("program.il"), program).unwrap();
        let output = rungc(folder.path(), &[&with_drat[..], &["--force"]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let check = |formula: &str, proof: &str| {
            let checked = Command::new(&python)
                .args(["-c", CHECK, formula, proof])
                .current_dir(folder.path().join("proof"))
                .output()
                .unwrap();
            (checked.status.success(), text(&checked.stdout))
        };
        let (holds, report) = check("step.cnf", "step.drat");
        assert!(holds, "{report}");
        let (holds, report) = check("begin.cnf", "begin.drat");
        assert!(holds, "{report}");
    }
    // The checker is not one that says yes to everything.
    let proof = std::fs::read_to_string(folder.path().join("proof/step.drat")).unwrap();
    let later: Vec<&str> = proof.lines().skip(proof.lines().count() / 2).collect();
    std::fs::write(folder.path().join("proof/cut.drat"), later.join("\n")).unwrap();
    let cut = Command::new(&python)
        .args(["-c", CHECK, "step.cnf", "cut.drat"])
        .current_dir(folder.path().join("proof"))
        .output()
        .unwrap();
    assert_eq!(cut.status.code(), Some(1), "{}", text(&cut.stderr));
}

#[test]
fn another_model_checker_agrees() {
    let abc = installed(&["berkeley-abc", "abc"]);
    if !there("berkeley-abc", "RUNGC_REQUIRE_PEERS", abc.is_some()) {
        return;
    }
    let abc = abc.unwrap_or_default();
    let timer = "LD X000\nANI Y001\nOUT T0 K3\nLD T0\nOUT Y000\nLDI X000\nANI T0\nOUT Y001\nEND\n";
    // Memory that may begin on: M501.
    let latched = "LD M501\nAND M1\nOUT M501\nLD M502\nOUT M500\nLD M500\nAND M501\nOUT Y000\nOUT Y001\nEND\n";
    let programs = [
        (latched.to_string(), "violated", "was asserted in frame"),
        (reverser("ANI Y000"), "proved", "Property proved"),
        (reverser("ANI X003"), "violated", "was asserted in frame"),
        (timer.to_string(), "proved", "Property proved"),
    ];
    for (program, ours, theirs) in programs {
        let folder = folder(&[("program.il", program.as_bytes())]);
        let args = [
            "verify",
            "program.il",
            "--never",
            "Y000 & Y001",
            "--aiger",
            "program.aig",
            "--replay",
            "interp",
        ];
        let output = rungc(folder.path(), &args);
        assert!(
            text(&output.stdout).starts_with(ours),
            "{}",
            text(&output.stdout)
        );
        let requested = Command::new(abc)
            .args(["-c", "read_aiger program.aig; pdr"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let answer = text(&requested.stdout);
        assert!(answer.contains(theirs), "{answer}");
    }
}

/// Has btormc, the model checker of those who defined BTOR2, search runs of up to this many scans: the number of the
/// first scan that violates the property, from 0, or -1. Their reader reads the file; this passes its lines on.
const BTORMC: &str = r#"
import ctypes, glob, os, sys
import pyboolector

class Sort(ctypes.Structure):
    _fields_ = [("id", ctypes.c_int64), ("tag", ctypes.c_int), ("name", ctypes.c_char_p),
                ("width", ctypes.c_uint32), ("element", ctypes.c_int64)]

class Line(ctypes.Structure):
    _fields_ = [("id", ctypes.c_int64), ("number", ctypes.c_int64), ("name", ctypes.c_char_p), ("tag", ctypes.c_int),
                ("sort", Sort), ("init", ctypes.c_int64), ("next", ctypes.c_int64), ("constant", ctypes.c_char_p),
                ("symbol", ctypes.c_char_p), ("count", ctypes.c_uint32), ("args", ctypes.POINTER(ctypes.c_int64))]

class Lines(ctypes.Structure):
    _fields_ = [("reader", ctypes.c_void_p), ("next", ctypes.c_int64)]

library = os.path.join(os.path.dirname(pyboolector.__file__), "pyboolector.libs", "libboolector*")
library, libc = ctypes.CDLL(glob.glob(library)[0]), ctypes.CDLL(None)

def function(name, result=ctypes.c_void_p, of=library):
    found = getattr(of, name)
    found.restype = result
    return lambda *args: found(*[ctypes.c_void_p(a) if isinstance(a, int) and a > 1 << 31 else a for a in args])

file = function("fopen", of=libc)(sys.argv[1].encode(), b"r")
reader = function("btor2parser_new")()
if not function("btor2parser_read_lines", ctypes.c_int)(reader, file):
    sys.exit(function("btor2parser_error", ctypes.c_char_p)(reader).decode())
checker = function("boolector_mc_new")()
btor = function("boolector_mc_get_btor")(checker)
bit = function("boolector_bitvec_sort")(btor, 1)
lines = function("btor2parser_iter_init", Lines)(reader)
nodes = {}
while line := function("btor2parser_iter_next", ctypes.POINTER(Line))(ctypes.byref(lines)):
    line = line.contents
    name, args = line.name.decode(), [nodes.get(line.args[n]) for n in range(line.count)]
    if name == "sort":
        assert line.sort.width == 1
    elif name in ("zero", "one"):
        nodes[line.id] = function("boolector_" + name)(btor, bit)
    elif name in ("and", "not"):
        nodes[line.id] = function("boolector_" + name)(btor, *args)
    elif name in ("input", "state"):
        nodes[line.id] = function("boolector_mc_" + name)(checker, bit, line.symbol)
    else:
        assert name in ("init", "next", "constraint", "bad"), name
        function("boolector_mc_" + name, ctypes.c_uint32)(checker, *args)
print("bound", function("boolector_mc_bmc", ctypes.c_int)(checker, 0, int(sys.argv[2])))
"#;

/// Scans that btormc searches: more than any counterexample has.
const BOUND: &str = "12";

#[test]
fn a_model_checker_of_btor2_agrees() {
    let python = std::env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let has_checker = Command::new(&python)
        .args(["-c", "import pyboolector"])
        .stderr(std::process::Stdio::null())
        .status();
    let has_checker = has_checker.is_ok_and(|status| status.success());
    if !there("pyboolector", "RUNGC_PYTHON", has_checker) {
        return;
    }
    let [by_induction, by_logic, chain] = kept_apart();
    let counter = "LD X000\nOUT C0 K3\nLD X002\nRST C0\nLD C0\nOUT Y000\nLD X001\nOUT Y001\nEND\n";
    let timer = "LD X000\nOUT T0 K3\nLD T0\nOUT Y000\nLDI X001\nOUT Y001\nEND\n";
    let module =
        "LD X000\nAND> U0\\G10 K500\nOUT M0\nLD M0\nOUT Y000\nLD M0\nAND X001\nOUT Y001\nEND\n";
    let programs = [
        (by_induction, None),
        (by_logic, None),
        (chain, None),
        (reverser("ANI X003"), Some(1)),
        (counter.to_string(), Some(5)),
        (timer.to_string(), Some(3)),
        (module.to_string(), Some(1)),
    ];
    for (program, scans) in programs {
        let folder = folder(&[("program.il", program.as_bytes())]);
        let args = [
            "verify",
            "program.il",
            "--never",
            "Y000 & Y001",
            "--cleared",
            "--btor2",
            "program.btor2",
            "--replay",
            "interp",
        ];
        let ours = text(&rungc(folder.path(), &args).stdout);
        let requested = Command::new(&python)
            .args(["-c", BTORMC, "program.btor2", BOUND])
            .current_dir(folder.path())
            .output()
            .unwrap();
        let answer = text(&requested.stdout);
        let theirs = answer.lines().last().unwrap_or_default();
        match scans {
            None => {
                assert!(ours.starts_with("proved"), "{program}: {ours}");
                assert_eq!(theirs, "bound -1", "{program}: {}", text(&requested.stderr));
            }
            Some(scans) => {
                assert!(ours.starts_with("violated"), "{program}: {ours}");
                assert!(
                    ours.contains(&format!("scan {scans} ")),
                    "{program}: {ours}"
                );
                let bound = format!("bound {}", scans - 1);
                assert_eq!(
                    theirs,
                    bound,
                    "{program}: {answer}{}",
                    text(&requested.stderr)
                );
                // The run that it shows has the names of devices.
                assert!(answer.contains(" X000@0"), "{answer}");
            }
        }
    }
}
