//! Modules compile in crates of others, and do what the interpreter does.

use rungc_build::{Options, Project, code};
use rungc_runtime_sources::cache::{self, Slot};
use rungc_runtime_sources::library;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Runs `main.rs` in a package with these modules; what it prints.
fn run(modules: &[(String, String)], main: &str) -> String {
    let kept = cache::folder().unwrap();
    let runtime = library::unpacked(&kept).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("src");
    fs::create_dir(&source).unwrap();
    let mut root = "#![deny(warnings)]\n".to_string();
    for (name, code) in modules {
        fs::write(source.join(format!("{name}.rs")), code).unwrap();
        writeln!(root, "mod {name} {{ include!(\"{name}.rs\"); }}").unwrap();
    }
    fs::write(source.join("main.rs"), root + main).unwrap();
    let runtime = runtime.display();
    let manifest = format!(
        "[package]\nname = \"firmware\"\nversion = \"0.1.0\"\nedition = \"2021\"\n\n[dependencies]\nrungc-rt = {{ path = '{runtime}' }}\n\n[workspace]\n"
    );
    fs::write(folder.path().join("Cargo.toml"), manifest).unwrap();
    let objects = Slot::wait(kept.join("packages")).unwrap();
    let done = Command::new("cargo")
        .args(["run", "--quiet", "--offline"])
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env("CARGO_INCREMENTAL", "0")
        .env("CARGO_TARGET_DIR", objects.path())
        .current_dir(&folder)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{errors}");
    String::from_utf8(done.stdout).unwrap()
}

fn module(project: &Project) -> String {
    code(&project.check().compile().unwrap())
}

#[test]
fn modules_of_programs_compile_beside_each_other_and_run() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/programs");
    let mut modules = Vec::new();
    for name in ["cutter", "motor", "packer", "traffic_light"] {
        let project = Project::open(examples.join(format!("{name}.il"))).unwrap();
        modules.push((name.to_string(), module(&project)));
    }
    // Long enough for several files.
    let rung = |n: u32| format!("LD M{n}\nAND X001\nMOV K{n} D{n}\nINC D{}\n", n + 1000);
    let list: String = (0..900).map(rung).collect::<String>() + "LD X000\nOUT Y000\nEND\n";
    let long = Project::from_list("long.il", &list, &Options::default()).unwrap();
    modules.push(("long".to_string(), module(&long)));
    let printed = run(
        &modules,
        "use rungc_rt::{Class, NoHal, Plc as _, Program as _};
fn main() {
    let mut plc = long::Long::new();
    plc.set_bit(Class::X, 0, true);
    plc.scan(&mut NoHal, 0, 150);
    println!(\"{}\", plc.output(0));
    let _ = (motor::Motor::new(), cutter::Cutter::new(), packer::Packer::new());
    let _ = traffic_light::TrafficLight::new();
}
",
    );
    assert_eq!(printed, "true\n");
}
