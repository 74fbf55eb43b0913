//! Programs that each warning is about, and similar ones without it.

use rungc_frontend::read_text;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::ModelId;
use rungc_syntax::codes;

/// Number of warnings of a kind, given by its name, for a program, which must have no error.
fn count(model: ModelId, warning: &str, lines: &str) -> usize {
    let code = codes::find(warning).expect("a warning").id;
    let text = format!("{}\nEND\n", lines.replace(" / ", "\n"));
    let read = read_text("program", &text);
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let checked = compile::check(&read.program, &options);
    let found: Vec<_> = checked
        .diagnostics
        .iter()
        .chain(read.diagnostics.iter())
        .collect();
    assert!(
        !checked.diagnostics.has_errors() && !read.diagnostics.has_errors(),
        "{text}{found:#?}"
    );
    found
        .iter()
        .filter(|diagnostic| diagnostic.code == code)
        .count()
}

/// Programs on FX3U with a warning each, and programs without it.
pub fn judge(warning: &str, wrong: &[&str], right: &[&str]) {
    judge_on(ModelId::Fx3u, warning, wrong, right);
}

/// The same on another model.
pub fn judge_on(model: ModelId, warning: &str, wrong: &[&str], right: &[&str]) {
    for (lines, expected) in wrong
        .iter()
        .map(|w| (w, 1))
        .chain(right.iter().map(|r| (r, 0)))
    {
        let found = count(model, warning, lines);
        assert_eq!(found, expected, "{warning}: {lines}");
    }
}

#[test]
fn parts_of_results() {
    judge(
        "parts-overlap",
        &[
            "LD X0 / DMOV K100000 D0 / MOV K5 D1",
            "LD X0 / MUL D0 D1 D10 / MOV K3 D11",
            "LD X0 / DIV D0 D1 D10 / LD X1 / INCP D11",
            "LD X0 / DMUL D0 D2 D10 / LD X1 / DMOV K3 D12",
            "LD X0 / DEADD D0 D2 D10 / LD X1 / MOV D50 D11",
            "LD X0 / DMOV D0 D109 / LD X1 / BMOV D200 D100 K10",
            "LD X0 / DMOV D0 D99 / LD X1 / BMOV D200 D100 K10",
        ],
        &[
            // Put together from words, or cleared.
            "LD X0 / MOV D5 D0 / MOV D6 D1 / DADD D0 K1 D0",
            "LD X0 / DMOV D5 D0 / MOV K0 D1",
            "LD X0 / DMOV D5 D0 / RST D1 / FMOV K0 D0 K2 / ZRST D0 D1",
            // Read, copied whole, or side by side.
            "LD X0 / MUL D0 D1 D10 / MOV D11 D20",
            // The digits of a number: each remainder is divided on.
            "LD X0 / DIV D0 K100 D10 / DIV D11 K10 D11",
            "LD X0 / DIV D0 D1 D10 / SUB D11 K1 D11",
            "LD X0 / DMOV D0 D108 / BMOV D200 D100 K10",
            "LD X0 / DMOV D0 D2 / MOV D5 D4 / MOV D6 D1",
            // A pair that another pair overlaps has a separate warning.
            "LD X0 / DMOV K1 D0 / DMOV K2 D1",
            "LD X0 / DMOV K1 D0 / MOV K5 D1Z0",
        ],
    );
}

#[test]
fn coils_of_out_and_set() {
    judge(
        "out-and-set",
        &[
            "LD X0 / SET Y0 / LD X1 / RST Y0 / LD X2 / OUT Y0",
            "LD X2 / OUT M5 / LD X0 / SET M5",
            "LD X1 / RST Y0 / LD X2 / OUT Y0",
            "LD X2 / OUT Y0 / LD X3 / CALL P0 / FEND / P0 / LD X0 / SET Y0 / SRET",
        ],
        &[
            "LD X0 / SET Y0 / LD X1 / RST Y0",
            // A RST after the OUT forces the coil off.
            "LD X2 / OUT Y0 / LD X1 / RST Y0",
            // A coil that holds itself takes SET and RST over.
            "LD X0 / SET Y0 / LD X2 / OR Y0 / ANI X3 / OUT Y0",
            "LD X1 / RST M0 / LD M0 / OUT Y1 / LD X2 / OUT M0",
            // Intermediate results: contacts read what SET wrote before the next OUT, or after the last one.
            "LD X0 / SET M5 / LD M5 / OUT Y0 / LD M8001 / OUT M5",
            "LD X2 / OUT M5 / LD X0 / SET M5 / LDI M5 / OUT Y1",
            "LDI M5 / OUT Y1 / LD X2 / OUT M5 / LD X0 / SET M5 / LD M5 / OUT Y2",
            // States, and jumps that skip one of the two.
            "LD M8002 / SET S0 / STL S0 / OUT Y0 / LD X0 / SET S20 / STL S20 / SET Y0 / LD X1 / OUT S0 / RET / LD X2 / RST Y0",
            "LD X5 / CJ P0 / LD X0 / OUT Y0 / P0 / LDI X5 / CJ P1 / LD X1 / SET Y0 / P1 / LD X6 / RST Y0",
        ],
    );
}

#[test]
fn coils_of_set_and_words() {
    judge(
        "out-and-set",
        &[
            "LD X0 / SET Y0 / LD M8000 / MOV D0 K2Y0",
            "LD X0 / RST Y3 / LD M8000 / MOV D0 K2Y0 / LD X1 / SET Y3",
            "LD X0 / SET Y0 / LD X1 / RST Y0 / LD M8000 / MOV D0 K2Y0",
            "LD X0 / SET Y3 / LD X1 / RST Y3 / LD M8000 / MOV K0 K2Y0",
            "LD X0 / SET M3 / LD M8000 / ZRST M0 M7 / LD X1 / SET M12",
            "LD X0 / SET M1 / LD M8000 / CMP D0 K5 M0",
            "LD X3 / CALL P0 / LD M8000 / MOV D0 K2Y0 / FEND / P0 / LD X0 / SET Y0 / SRET",
        ],
        &[
            "LD X0 / SET Y0 / LD X1 / MOV D0 K2Y0",
            "LD X0 / SET Y0 / LD M8000 / MOVP D0 K2Y0",
            "LD X0 / SET Y10 / LD M8000 / MOV D0 K2Y0",
            // The SET or RST comes last.
            "LD M8000 / MOV D0 K2Y0 / LD X0 / SET Y0",
            "LD M8000 / MOV K0 K2Y0 / LD X0 / SET Y0 / LD X1 / RST Y0",
            // It is off anyway.
            "LD X0 / RST Y0 / LD M8000 / MOV K0 K2Y0",
            // Contacts see it before, or the word takes it over.
            "LD X0 / SET M3 / LD M3 / OUT Y0 / LD M8000 / MOV D0 K4M0",
            "LD X0 / SET Y0 / LD M8000 / WAND K2Y0 H0F K2Y0",
            "LD X0 / SET Y0 / LD M8000 / REF Y0 K8 / MOV D0 K2Y0",
            // Jumps skip one of the two.
            "LD X5 / CJ P0 / LD M8000 / MOV D0 K2Y0 / P0 / LDI X5 / CJ P1 / LD X1 / SET Y0 / P1 / LD X6 / RST Y0",
        ],
    );
    judge(
        "double-coil",
        &[],
        &["LD X0 / OUT Y3 / LD M8000 / WAND K2Y0 H0F K2Y0"],
    );
}

#[test]
fn states_that_stand_twice() {
    let ladder = |second: &str| {
        format!(
            "LD M8002 / SET S0 / STL S0 / LD X0 / SET S20 / LD X1 / SET S21 / STL S20 / OUT Y0 / STL S21 / OUT Y1 / {second} / RET"
        )
    };
    let copied = ladder("STL S20 / OUT Y2 / LD X2 / OUT S0");
    let parallel = ladder("STL S20 / STL S21 / LD X2 / OUT S0");
    let selective =
        ladder("STL S20 / LD X2 / SET S30 / STL S21 / LD X3 / SET S30 / STL S30 / LD X4 / OUT S0");
    judge("state-twice", &[&copied], &[&parallel, &selective]);
}

#[test]
fn ranges_and_divisors() {
    judge(
        "reversed-range",
        &["LD X0 / ZRST D10 D0", "LD X0 / ZRSTP Y10 Y7"],
        &["LD X0 / ZRST D0 D0", "LD X0 / ZRST M0 M10"],
    );
    judge(
        "division-by-zero",
        &[
            "LD X0 / DIV D0 K0 D2",
            "LD X0 / DDIVP D0 H0 D4",
            "LD X0 / DEDIV D0 E0 D4",
        ],
        &[
            "LD X0 / DIV D0 K1 D2",
            "LD X0 / DIV K0 D0 D2",
            "LD X0 / DIV D0 K0Z0 D2",
        ],
    );
    assert_eq!(
        count(ModelId::Hm, "division-by-zero", "LD X0 / DIV D0 K0 D2"),
        1
    );
}

#[test]
fn changes_in_every_scan() {
    judge(
        "every-scan",
        &[
            "LD X0 / INC D0",
            "LD X0 / ANI X1 / OR X2 / DDEC D0",
            "LD X0 / AND M8013 / ALT Y0",
            "LD X0 / ADD D0 K1 D0 / INC D0",
            "LD X0 / MPS / ANI X1 / SFTL X5 M0 K8 K1 / MPP / OUT Y0",
            "LD X0 / LD X1 / ORB / AND M8000 / ROL D0 K4",
            "LD X1 / MOV K0 D0 / LD X0 / INC D0",
            "LD X0 / CML D0 D0",
            "LD X0 / DEADD D0 E1.5 D0",
            "LD X0 / DESUB D10 D0 D0 / DENEGP D20",
            "LD X0 / DENEG D20",
            "LD X0 / BK+ D0 D10 D0 K5",
            "LD X0 / TADD D0 D10 D0",
            "LD X0 / SMOV D0 K3 K3 D0 K4",
            "LD X0 / $+ D0 D10 D0",
            "LD X0 / FDEL D0 D10 K1",
            "LD X0 / FINS D0 D10 K1",
            "LD X0 / BMOV D0 D1 K9",
            "LD X0 / DADD D0 D2 D2",
            "LD X0 / SUB K0 D0 D0",
            "LD X0 / DIV K1 D0 D0",
            "LD X0 / MUL D0 K0 D0",
        ],
        &[
            "LD X0 / INCP D0",
            "LDP X0 / INC D0",
            "LD X0 / PLS M0 / LD M0 / INC D0",
            "LD M8000 / INC D0",
            "LD X0 / AND< D0 K10 / INC D0",
            "LD X0 / MEP / INC D0",
            "LD M8013 / ANDP X0 / INC D0",
            // The same each time, or another result.
            "LD X0 / ADD D0 K0 D0 / MUL K1 D2 D2 / DEDIV D4 E1 D4 / WOR D6 K5 D6 / LIMIT K0 K9 D8 D8",
            "LD X0 / SMOV D0 K1 K1 D0 K4 / BMOV D10 D15 K5 / MOV D20 D20 / DEADD D22 D24 D26 / $+ D30 D40 D50",
            "LD X0 / DEADDP D0 E1.5 D0 / $+P D30 D40 D30",
            // A value that is written anew before each change is a computation.
            "LD X0 / MOV D5 D0 / NEG D0",
            "LD X0 / WXOR D1 D2 D3 / CML D3 D3",
            // Nothing changes but flags.
            "LD X0 / ADD D0 K0 D0 / ADD K0 D1 D1 / SUB D2 K0 D2",
            "LD X0 / MUL D0 K1 D0 / DMUL K1 D4 D4 / DIV D8 K1 D8 / WXOR D12 K0 D12",
            // Loops, routines, states and jumps run their instructions as often as is meant.
            "LD X0 / MOV K0 Z0 / FOR K5 / LD X0 / INC Z0 / NEXT",
            "LDP X1 / CALL P0 / FEND / P0 / LD X0 / INC D0 / SRET",
            "LDI X1 / CJ P0 / LD X0 / INC D0 / P0",
        ],
    );
}

#[test]
fn counters_and_outputs_that_stay_on() {
    judge(
        "never-reset",
        &[
            "LD X0 / OUT C0 K10 / LD C0 / OUT Y0 / LD X1 / OUT C1 K10 / LD C1 / OUT Y1",
            "LD X0 / OUT T246 K10 / LD T246 / OUT Y0 / LD X1 / OUT T255 D0 / LDI T255 / OUT Y1",
            "LD X0 / OUT T250 K10 / LD T250 / OUT Y0 / LD X1 / RST T249 / MOV K5 D0",
        ],
        &[
            "LD X0 / OUT C0 K10 / LD C0 / OUT Y0 / RST C0",
            "LD X0 / OUT C0 K10 / LD C0 / OUT Y0 / LD X1 / ZRST C0 C5",
            "LD X0 / OUT C0 K10 / LD X1 / MOV K0 C0 / LD C0 / OUT Y0",
            // Only the count is looked at, or it comes back by itself.
            "LD X0 / OUT C0 K32767 / LD> C0 K5 / OUT Y0",
            "LD X0 / OUT C200 K10 / LD C200 / OUT Y0",
            "LD X0 / OUT C0 K10 / LD C0 / OUT Y0 / LD X1 / OUT M8031",
            "LD X0 / OUT T250 K10 / LD T250 / OUT Y0 / RST T250",
            "LD X0 / OUT T250 K10 / LD T250 / OUT Y0 / LD X1 / ZRST T246 T255",
            "LD X0 / OUT T250 K10 / LD T250 / OUT Y0 / LD X1 / MOV K0 T250",
            "LD X0 / OUT T250 K10 / LD T250 / OUT Y0 / LD X1 / FMOV K0 T0Z0 K5",
            "LD X0 / OUT T250 K10 / LD T250 / OUT Y0 / LD X1 / OUT M8032",
            // Only the time is looked at, or the timer is an ordinary one.
            "LD X0 / OUT T250 K32767 / LD> T250 K5 / OUT Y0",
            "LD X0 / OUT T245 K10 / LD T245 / OUT Y0 / LD X1 / OUT T256 K10 / LD T256 / OUT Y1",
        ],
    );
    let [plain, accumulating] =
        ["T127", "T128"].map(|timer| format!("LD X0 / OUT {timer} K10 / LD {timer} / OUT Y0"));
    let on_fx3s = [plain, accumulating].map(|text| count(ModelId::Fx3s, "never-reset", &text));
    assert_eq!(on_fx3s, [0, 1]);
    judge(
        "never-switched-off",
        &["LD X0 / SET Y0 / SET Y1"],
        &[
            "LD X0 / SET Y0 / LD X1 / RST Y0",
            "LD X0 / SET Y0 / LD X1 / ZRST Y0 Y7",
            "LD X0 / SET Y0 / LD X1 / MOV K0 K2Y0",
            "LD X0 / SET M0 / LD M0 / OUT Y0",
            "LD X0 / SET Y0 / LD X1 / RST Y0Z0",
        ],
    );
}

#[test]
fn jumps_that_are_always_taken() {
    judge(
        "jumped-over",
        &[
            "LD M8000 / CJ P1 / LD X0 / OUT Y0 / P1 / LD X1 / OUT Y1",
            "LD X0 / ORI M8001 / CJ P1 / LD X0 / OUT Y0 / LD M8000 / CJ P1 / LD X2 / OUT Y2 / P1",
            "LD X1 / OUT Y1 / LDI M8001 / CJ P63 / LD X0 / OUT Y0",
        ],
        &[
            "LD M8000 / CJP P1 / LD X0 / OUT Y0 / P1",
            "LD M8000 / AND X0 / CJ P1 / LD X0 / OUT Y0 / P1",
            "LD M8000 / CJ P1 / P1 / LD X0 / OUT Y0",
            "LD X5 / CJ P2 / LD M8000 / CJ P1 / P2 / LD X0 / OUT Y0 / P1",
        ],
    );
    judge(
        "endless-jump",
        &["P0 / LD X0 / OUT Y0 / LD M8000 / CJ P0"],
        &[
            "P0 / LD X0 / OUT Y0 / LDI X1 / CJ P0",
            "P0 / LD X0 / CJ P1 / LD M8000 / CJ P0 / P1",
        ],
    );
}

#[test]
fn outputs_that_are_taken() {
    judge(
        "one-output",
        &[
            "LD X0 / PLSY K1000 K500 Y0 / PLSY K200 K100 Y0",
            "LD X0 / PLSY K1000 K500 Y0 / LD X0 / DRVI K200 K100 Y0 Y4",
            "LD M8000 / PLSY K1000 D0 Y0 / LD X1 / PLSY K200 K100 Y0",
        ],
        &[
            "LD X0 / PLSY K1000 K500 Y0 / PLSY K200 K100 Y1",
            "LD X0 / PLSY K1000 K500 Y0 / LD X1 / PLSY K200 K100 Y0",
            "LD X0 / PLSY K1000 K500 Y0 / LDI X0 / PLSY K200 K100 Y0",
            "LD M8002 / SET S0 / STL S0 / PLSY K1000 K500 Y0 / LD X0 / SET S20 / STL S20 / PLSY K10 K50 Y0 / LD X1 / OUT S0 / RET",
        ],
    );
}

#[test]
fn branches_of_states() {
    let set = |first: u32, count: u32| -> String {
        let states = (first..first + count).map(|state| format!(" / SET S{state}"));
        states.collect()
    };
    let wide = |count| format!("LD M8002 / SET S0 / STL S0 / LD X0{} / RET", set(20, count));
    let deep = |count| {
        let begin = format!("LD M8002 / SET S0 / STL S0 / LD X0{}", set(20, 8));
        format!(
            "{begin} / STL S20 / LD X1{} / STL S30 / LD X2{} / RET",
            set(30, 8),
            set(40, count)
        )
    };
    judge(
        "state-branches",
        &[&wide(9), &deep(2)],
        &[&wide(8), &deep(1)],
    );
}

#[test]
fn timers_in_routines() {
    let text = "LD X0 / CALL P1 / LD T0 / OR T200 / OR T246 / OUT Y0 / FEND / P1 / LD X1 / OUT T0 K10 / OUT T200 K1 / OUT T246 K1 / SRET";
    assert_eq!(count(ModelId::Fx3u, "timer-in-routine", text), 2);
}

#[test]
fn a_reset_may_be_what_could_not_be_read() {
    let text = "LD X0\nOUT C0 K10\nSET Y1\nLD C0\nOUT Y0\nLD X1\nRST CO\nEND\n";
    let read = read_text("program", text);
    let checked = compile::check(&read.program, &CompileOptions::default());
    assert!(read.diagnostics.has_errors() || checked.diagnostics.has_errors());
    let resets = [codes::NEVER_RESET.id, codes::NEVER_SWITCHED_OFF.id];
    assert!(!checked.diagnostics.iter().any(|d| resets.contains(&d.code)));
}

#[test]
fn states_with_one_half() {
    let ladder = |rest: &str| format!("LD M8002 / SET S0 / STL S0 / LD X0 / {rest} / RET");
    let [lost, entered, plain] = [
        ladder("SET S20 / STL S20 / LD X2 / SET S30 / LD X1 / OUT S0"),
        ladder("SET S20 / STL S20 / LD X1 / OUT S0 / STL S25 / OUT Y0"),
        format!("{} / LD S101 / OUT Y1", ladder("OUT S0")),
    ];
    let whole = [
        ladder("SET S20 / STL S20 / LD X1 / OUT S0"),
        "LD M8000 / IST X20 S20 S27 / STL S0 / OUT Y0 / STL S1 / OUT Y1 / STL S2 / LD X0 / SET S20 / STL S20 / OUT Y2 / RET"
            .to_owned(),
        "LD X0 / SET S900".to_owned(),
        "LD X0 / MOV D0 K4S20 / LD S30 / OUT Y0".to_owned(),
        "LD M8002 / SET S5 / LD S5 / OUT Y0".to_owned(),
    ];
    let whole: Vec<_> = whole.iter().map(String::as_str).collect();
    judge("never-read", &[&lost], &whole);
    judge("never-written", &[&entered, &plain], &whole);
}

#[test]
fn relays_of_links() {
    let driven = |number: u32| format!("LD X0 / OUT M{number}");
    let read = |number: u32| format!("LD M{number} / OUT Y0");
    let (master, slave) = ("LD M8002 / SET M8070", "LD M8002 / SET M8071");
    let either = "LD X7 / SET M8070 / LDI X7 / SET M8071";
    let station = |n: u8| format!("LD M8038 / MOV K{n} D8176 / MOV K2 D8177 / MOV K2 D8178");
    let [first, second] = [0, 1].map(station);
    // The relay that each sends, and the one that it receives.
    let links = [
        (master, 800, 900),
        (slave, 999, 899),
        (&*first, 1000, 1064),
        (&*second, 1064, 1063),
        (either, 800, 800),
        (either, 900, 900),
    ];
    for model in [ModelId::Fx1n, ModelId::Fx3u, ModelId::H2u] {
        for (set_up, sent, received) in links {
            let number = set_up.contains("M8038") && model == ModelId::H2u;
            let protocol = if set_up == first { "H40" } else { "H4" };
            let set_up = match number {
                true => format!("{set_up} / LD M8002 / MOV {protocol} D8126"),
                false => set_up.to_owned(),
            };
            let with = |rest: String| format!("{set_up} / {rest}");
            let quiet = [with(driven(sent)), with(read(received))];
            let quiet = quiet.each_ref().map(String::as_str);
            judge_on(model, "never-read", &[], &quiet);
            judge_on(model, "never-written", &[], &quiet);
        }
        // Against the direction of the link, and without one.
        let wrong = [format!("{master} / {}", driven(900)), driven(800)];
        judge_on(model, "never-read", &wrong.each_ref().map(|w| &**w), &[]);
        let wrong = [format!("{master} / {}", read(800)), read(900)];
        judge_on(model, "never-written", &wrong.each_ref().map(|w| &**w), &[]);
    }
}

#[test]
fn contacts_of_what_is_only_cleared() {
    let cleared = |read: &str, clear: &str| format!("LD {read} / OUT Y0 / LD M8002 / {clear}");
    let wrong = [
        cleared("M10", "RST M10"),
        cleared("M10", "ZRST M0 M100"),
        cleared("M10", "MOVP K0 K4M0"),
        cleared("M40", "DMOV K0 K8M20"),
        cleared("M40", "FMOV K0 K4M0 K3"),
        cleared("C5", "FMOV K0 C0 K20"),
        cleared("T5", "ZRST T0 T9"),
        cleared("S25", "ZRST S20 S40"),
    ];
    let right = [
        cleared("M10", "MOV K1 K4M0"),
        cleared("M10", "FMOV D0 K4M0 K1"),
        cleared("M10", "ZRST M0 M9 / SET M10"),
        cleared("M10", "BMOV K4M100 K4M0 K1"),
    ];
    judge(
        "never-written",
        &wrong.each_ref().map(|w| &**w),
        &right.each_ref().map(|r| &**r),
    );
}

#[test]
fn registers_that_nothing_writes() {
    judge(
        "never-written",
        &[
            "LD= D101 K3 / OUT Y0",
            "LD X0 / OUT T0 D100 / LD T0 / OUT Y0",
            "LD X0 / OUT C0 D100 / RST C0 / LD C0 / OUT Y0 / LD X1 / RST D100",
            "LDD> D10 K3 / OUT Y0 / LD X1 / MOV K1 D12",
            "LD D0.3 / OUT Y0",
            "LD X0 / CMP D101 K3 M0 / LD M1 / OUT Y0",
            "LD X0 / ZCP K1 D101 D102 M0 / LD M1 / OUT Y0 / LD X1 / MOV K5 D102",
            "LD M8000 / OUT C235 K100000 / DHSCS D10 C235 Y0",
            "LD M8000 / OUT C235 K100000 / DHSCR D10 C235 Y0 / LD X1 / MOV K1 D12",
            "LD M8000 / OUT C235 K100000 / DHSZ K1 D10 C235 Y0",
        ],
        &[
            "LD= D101 K3 / OUT Y0 / LD X0 / MOV K1 D101",
            "LDD> D10 K3 / OUT Y0 / LD X1 / MOV K1 D11",
            "LD= D101 K3 / OUT Y0 / LD X0 / DMOV K1 D100",
            "LD= D101 K3 / OUT Y0 / LD X0 / MOV K1 D0Z0",
            "LD= D101 K3 / OUT Y0 / LD X0 / FMOV K1 D100 D0",
            "LD X0 / OUT T0 D101 / LD T0 / OUT Y0 / LD X1 / INCP D101",
            // Latched, special, or only moved.
            "LD= D512 K3 / OUT Y0 / LD> R5 K0 / OUT Y1 / LD> D8013 K3 / OUT Y2",
            "LD X0 / MOV D101 D102",
            "LD> D0Z0 K3 / OUT Y0",
            "LD M8000 / OUT C235 K100000 / DHSCS D10 C235 Y0 / LD X1 / DMOV K500 D10",
            "LD M8000 / OUT C235 K100000 / DHSZ K1 D10 C235 Y0 / LD X1 / MOV K500 D10",
            // Others write at the ports.
            "LD M8002 / MOV H6080 D8120 / LD= D101 K3 / OUT Y0",
            "LD M8038 / MOV K0 D8176 / MOV K2 D8177 / MOV K2 D8178 / LD= D10 K3 / OUT Y0",
            "LD X0 / RS D200 K1 D100 K5 / LD= D101 K3 / OUT Y0",
        ],
    );
}

#[test]
fn fast_inputs_with_two_purposes() {
    judge(
        "measured-input",
        &[
            "EI / LD M8170 / OUT Y1 / FEND / I001 / LD M8000 / INC D0 / IRET",
            "LD M8000 / OUT C235 K10 / LD X5 / DVIT K100 K100 Y0 Y4",
            "LD X7 / SPD X0 K100 D0 / LD X5 / DVIT K100 K100 Y0 Y4",
        ],
        &[
            "EI / LD M8171 / OUT Y1 / FEND / I001 / LD M8000 / INC D0 / IRET",
            "LD M8000 / OUT C235 K10 / LD X5 / DVIT K100 K100 Y1 Y4",
            // The program chooses the inputs.
            "LD M8000 / OUT M8336 / MOV HFFF3 D8336 / OUT C235 K10 / LD X5 / DVIT K100 K100 Y0 Y4",
        ],
    );
    let routine = "LD X0 / OUT Y1 / FEND / I001 / LD M8000 / INC D0 / IRET";
    judge(
        "never-enabled",
        &["LD M8170 / OUT Y1 / RST M8170", routine],
        &["EI / LD M8170 / OUT Y1 / RST M8170", "LD M8168 / OUT Y1"],
    );
}

#[test]
fn pulses_and_their_direction_at_one_output() {
    judge(
        "one-output",
        &[
            "LD X0 / DRVI K100 K1000 Y0 Y0",
            "LD X0 / PLSV K100 Y1 Y1",
            "LD X0 / DSZR X1 X0 Y0 Y0",
            "LD X0 / DVIT K100 K1000 Y0 Y0",
        ],
        &["LD X0 / DRVI K100 K1000 Y0 Y4"],
    );
}

#[test]
fn timers_in_routines_of_models_without_others() {
    let routine = |timer: &str| {
        format!("LD X0 / CALL P0 / FEND / P0 / LD X1 / OUT {timer} K5 / LD {timer} / OUT Y0 / SRET")
    };
    for model in [ModelId::Fx1s, ModelId::Fx3s, ModelId::Hm, ModelId::Fx2n] {
        assert_eq!(
            count(model, "timer-in-routine", &routine("T10")),
            1,
            "{model:?}"
        );
    }
    assert_eq!(
        count(ModelId::Fx2n, "timer-in-routine", &routine("T192")),
        0
    );
}

#[test]
fn a_mode_of_zone_comparison_is_one_relay() {
    let table = "LD M8000 / OUT C235 K1000 / DHSZ D0 K2 C235";
    for model in [ModelId::H2u, ModelId::H1u, ModelId::Fx2n, ModelId::Fx3u] {
        for relay in ["M8130", "M8132"] {
            let lines = format!("{table} {relay}");
            assert_eq!(count(model, "undefined-special", &lines), 0, "{lines}");
        }
    }
}

#[test]
fn writes_that_reach_what_the_system_maintains() {
    judge(
        "writes-read-only",
        &[
            "LD X0 / FMOV K0 D8039 K3",
            "LD X0 / DMOV K0 D8039",
            "LD X0 / INCP D8012",
            "LD X0 / SFTLP X0 M8011 K3 K1",
            "LD X0 / BMOV D0 D8010 K3",
            "LD X0 / ZRST M8040 M8048",
        ],
        &[
            "LD X0 / FMOV K0 D8120 K2",
            "LD X0 / BMOV D8010 D0 K3",
            "LD X0 / MOV D8012 D0",
            "LD X0 / OUT M8024 / BMOV D0 D8120 K1",
        ],
    );
}
