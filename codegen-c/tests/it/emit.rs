//! Emitted C: what it looks like, that it compiles without a warning, and that it does what the program says.

use crate::build;
use crate::build::{Builder, run_c};
use rungc_codegen_c::{Options, emit};
use rungc_syntax::DeviceClass::{D, M, T, X, Y};

fn motor() -> rungc_ir::Module {
    let mut b = Builder::new("motor");
    b.comment(X, 0, "start button");
    b.comment(X, 1, "stop button");
    b.comment(M, 0, "motor latch");
    b.comment(T, 0, "run-up time");
    b.comment(Y, 0, "main contactor");
    b.comment(Y, 1, "box full");
    b.network(0, Some("Motor"));
    let (start, latch, stop) = (b.bit(X, 0), b.bit(M, 0), b.bit(X, 1));
    let either = b.or(start, latch);
    let not_stop = b.not(stop);
    let on = b.and(either, not_stop);
    b.write_bit(M, 0, on);
    b.network(4, None);
    let latch = b.bit(M, 0);
    let preset = b.i16(30);
    b.timer(0, latch, preset);
    let done = b.bit(T, 0);
    let on = b.and(latch, done);
    b.write_bit(Y, 0, on);
    b.network(10, None);
    let part = b.bit(X, 2);
    let (count, one) = (b.word(D, 0), b.i16(1));
    let sum = b.add16(count, one);
    b.rising(part, |b| b.write_word(D, 0, sum));
    b.network(19, None);
    let (count, ten) = (b.word(D, 0), b.i16(10));
    let full = b.ge(count, ten);
    b.when(full, |b| {
        let on = b.on();
        b.write_bit(Y, 1, on);
    });
    b.finish()
}

#[test]
fn motor_reads_well() {
    let files = emit(&motor(), &Options::default());
    for file in files.iter().filter(|f| {
        f.path.starts_with("motor") || ["CMakeLists.txt", "Makefile"].contains(&&*f.path)
    }) {
        insta::assert_snapshot!(file.path.replace('.', "_"), file.contents);
    }
}

#[test]
fn motor_runs() {
    let main = r#"
        motor_plc plc;
        uint32_t now = 0;
        motor_init(&plc);
        plc.X0 = true;
        motor_scan(&plc, now, 0);
        plc.X0 = false;
        for (int i = 0; i < 30; i++) {
            plc.X2 = (i & 1) != 0;
            motor_scan(&plc, now += 99, 0);
        }
        printf("%d %d %d ", plc.M0, motor_output(&plc, 0), plc.T0.value);
        motor_scan(&plc, now += 99, 0);
        printf("%d %d %d %d ", motor_output(&plc, 0), plc.T0.value, plc.D0, plc.Y1);
        motor_set_running(&plc, false);
        printf("%d %d\n", plc.T0.value, motor_output(&plc, 0));
    "#;
    assert_eq!(run_c(&motor(), main), "1 0 29 1 30 15 1 0 0\n");
}

#[test]
fn instances_are_independent_and_show_whether_they_run() {
    let main = r#"
        static motor_plc plc[2];
        for (int i = 0; i < 2; i++) {
            motor_init(&plc[i]);
        }
        plc[0].X0 = true;
        motor_set_running(&plc[1], false);
        for (int i = 0; i < 2; i++) {
            motor_scan(&plc[i], 0, 0);
        }
        for (int i = 0; i < 2; i++) {
            const plc_error error = motor_error(&plc[i]);
            printf("%d %d %d %d\n", motor_running(&plc[i]), plc[i].M0, error.code, error.stop);
        }
    "#;
    assert_eq!(run_c(&motor(), main), "1 1 0 0\n0 0 0 0\n");
}

#[test]
fn very_many_timer_coils_share_the_code_of_timers() {
    let mut b = Builder::new("many");
    for coil in 0..1001 {
        b.network(3 * coil, None);
        let (drive, preset) = (b.bit(X, 0), b.i16(30));
        b.timer(coil % 150, drive, preset);
    }
    let main = r#"
        many_plc plc;
        many_init(&plc);
        plc.X0 = true;
        many_scan(&plc, 0, 0);
        many_scan(&plc, 1000, 0);
#ifdef PLC_MANY_TIMERS
        printf("many: ");
#endif
        printf("%d %d\n", plc.T0.value, plc.T149.done);
    "#;
    // Each timer has at least six coils, each of which adds the time of the scan.
    assert_eq!(run_c(&b.finish(), main), "many: 30 1\n");
}

#[test]
fn batch_answers_requests() {
    let requests = "case 0\nbit X 0 1\nscan 0 0\ngetbit M 0\nout 0\nscan 3000 0\nout 0\ngetword T 0\nword D 0 9\nbit X 2 1\nscan 3010 0\n\
        getword D 0\nout 1\ngetbit M 8000\ngetbit M 99999\ngetdword D 0\nrun 0\nout 0\ncase 1\nscan 0 0\nout 0\nbfm 0 5 7\ngetbfm 0 5\n\
        getbfm 3 5\ncase 2\nexit\n";
    let answers = build::run_batch(&[motor(), motor()], requests);
    let expected = "ok ok ok 1 0 ok 1 30 ok ok ok 10 1 0 none 10 ok 0 ok ok 0 ok 7 none none";
    assert_eq!(
        answers.split_whitespace().collect::<Vec<_>>().join(" "),
        expected
    );
}

/// The host's `main.c` compiles strictly, switches inputs that are typed, and prints outputs that change.
#[test]
fn host_main_runs_in_real_time() {
    let expected = ["s  Y000 on  main contactor", "X9=1: not an input"];
    build::run_host(&motor(), " x0 = 1 \nX9=1\n", &expected);
}

/// Firmware that includes `rungc.h` may be compiled with warnings that emitted programs do not ask for.
#[test]
fn the_shared_header_has_no_equal_branches() {
    let folder = tempfile::tempdir().unwrap();
    let files = rungc_codegen_c::emit(&motor(), &Default::default());
    let header = files.iter().find(|file| file.path == "rungc.h").unwrap();
    std::fs::write(folder.path().join("rungc.h"), &header.contents).unwrap();
    if !build::compilers().contains(&"gcc") {
        eprintln!("not run: there is no gcc");
        return;
    }
    let compiled = std::process::Command::new("gcc")
        .args(build::STRICT)
        .args(["-Wduplicated-branches", "-Wduplicated-cond", "-Wlogical-op"])
        .args(["-fsyntax-only", "-x", "c", "rungc.h"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let messages = String::from_utf8_lossy(&compiled.stderr);
    assert!(compiled.status.success(), "{messages}");
}

/// Programs of one firmware share `rungc.h`: the first one on the include path serves all, and one of another version
/// is rejected.
#[test]
fn a_header_of_another_version_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let compile = |header: &str| {
        for file in rungc_codegen_c::emit(&motor(), &Default::default()) {
            let text = match file.path.as_str() {
                "rungc.h" => header.to_string(),
                _ => file.contents,
            };
            std::fs::write(folder.path().join(&file.path), text).unwrap();
        }
        let compiled = std::process::Command::new(build::compilers()[0])
            .args(["-std=c99", "-c", "motor.c", "-o", "motor.o"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        (
            compiled.status.success(),
            String::from_utf8_lossy(&compiled.stderr).into_owned(),
        )
    };
    let files = rungc_codegen_c::emit(&motor(), &Default::default());
    let header = files.iter().find(|file| file.path == "rungc.h").unwrap();
    assert!(compile(&header.contents).0);
    let stamp = header.contents.find("RUNGC_H_STAMP 0x").unwrap() + "RUNGC_H_STAMP 0x".len();
    let mut other = header.contents.clone();
    other.replace_range(stamp..stamp + 8, "00000001");
    let (compiled, messages) = compile(&other);
    assert!(
        !compiled && messages.contains("different versions of rungc"),
        "{messages}"
    );
}
