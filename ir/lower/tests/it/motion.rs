//! Programs that each warning of motion and high-speed counters is about, and similar ones without it.

use crate::warnings::{judge, judge_on};
use rungc_models::ModelId;

#[test]
fn motions_driven_for_one_scan() {
    judge(
        "short-drive",
        &[
            "LDP X0 / PLSY K1000 K5000 Y0",
            "LDF X0 / DPLSR K1000 K5000 K100 Y0",
            "LD X1 / ANDP X0 / DRVI K500 K1000 Y0 Y4",
            "LDP X0 / AND X1 / DRVA K500 K1000 Y0 Y4",
            "LD X1 / LDP X0 / ORP X2 / ANB / ZRN K1000 K100 X4 Y0",
            "LD X0 / OR X1 / MEP / PLSV K1000 Y0 Y4",
            "LD X0 / MPS / ANDP X1 / PWM K10 K20 Y0 / MPP / OUT Y5",
            "LDP X0 / AND= D0 K1 / DSZR X1 X4 Y0 Y4",
            "LD M8002 / PLSY K1000 K5000 Y0",
            "LDI M8003 / PLSY K1000 K5000 Y0",
            "LD X0 / PLS M0 / LD M0 / PLSY K1000 K5000 Y0",
            "LD X1 / AND M0 / PLSY K1000 K5000 Y0 / LD X0 / PLF M0 / LD X2 / RST M0",
            "LD M8002 / SET S0 / STL S0 / LDP X0 / PLSY K1000 K5000 Y0 / LD X1 / OUT S0 / RET",
            "LD X0 / MC N0 M0 / LDP X1 / PLSY K1000 K5000 Y0 / MCR N0",
        ],
        &[
            "LDP X0 / SET M0 / LD M0 / PLSY K1000 K5000 Y0 / LD M8029 / RST M0",
            "LDP X0 / OR M0 / AND X1 / PLSY K1000 K5000 Y0 / OUT M0",
            "LDP X0 / OR= D0 K1 / PLSY K1000 K5000 Y0",
            "LDP X0 / INV / PLSY K1000 K5000 Y0",
            "LDP X0 / INV / AND X1 / PLSY K1000 K5000 Y0",
            "LDI M8002 / PLSY K1000 K5000 Y0",
            "LD X0 / PLS M0 / LDI M0 / PLSY K1000 K5000 Y0",
            // Something else switches the relay on, or holds it.
            "LD X0 / PLS M0 / LD X1 / SET M0 / LD M0 / PLSY K1000 K5000 Y0",
            "LD X0 / PLS M0 / LD X1 / MOV D0 K2M0 / LD M0 / PLSY K1000 K5000 Y0",
            "LD X0 / PLS M0 / LD X1 / PLS M0 / LD M0 / PLSY K1000 K5000 Y0",
            "LD X0 / PLS M0 / LD X1 / MOV D0 K2M1Z0 / LD M0 / PLSY K1000 K5000 Y0",
            "LD X1 / CJ P0 / LD X0 / PLS M0 / P0 / LD M0 / PLSY K1000 K5000 Y0",
            "LD X1 / CALL P0 / LD M0 / PLSY K1000 K5000 Y0 / FEND / P0 / LD X0 / PLS M0 / SRET",
            // The motion need not meet its open contacts.
            "LD X1 / CJ P0 / LDP X0 / PLSY K1000 K5000 Y0 / P0",
            "LDP X1 / CALL P0 / FEND / P0 / LDP X0 / PLSY K1000 K5000 Y0 / SRET",
            // These do their work in one scan.
            "LDP X0 / MOV K1 D0",
            "LDP X0 / RST C235",
        ],
    );
    judge_on(
        ModelId::Hm,
        "short-drive",
        &[
            "LDP X004 / HOME K0",
            "LDP X004 / JOG K0 K100 K100 K1 K2",
            "LDP X004 / PSOUT K0 K100",
            "LDP X004 / PTOUT K0 D5000 D8008 K100 K0",
            "LDP X004 / GEAR K0 D2000 K0 K1 K1",
            "LDP X004 / CAM K0 D5000 D2000 K100 D1200",
            "LDP X004 / DPLSY K100 K100 K0",
            "LDP X004 / DPLSR K100 K100 K100 K0",
            "LDP X004 / DDRVI K100 K100 K0",
            "LDP X004 / DDRVA K100 K100 K0",
            "LDP X004 / DDVIT K100 K100 K0",
            "LDP X004 / DPLSV K100 K0",
            "LDP X004 / PTAB D1000 D5000 K1",
            "LDP X004 / PCTAB D1000 D5000",
            "LDP X004 / PBTAB D1000 D5000",
        ],
        &[
            "LDP X004 / IPL K0 K20",
            "LD M8002 / AXPO K0 K0 K1",
            "LDP X004 / AXSP K0 K500 K0",
            "LDP X004 / DHMOV C235 D1000 / LD M8000 / OUT C235 K5",
        ],
    );
}

#[test]
fn two_motions_of_one_axis() {
    judge_on(
        ModelId::Hm,
        "one-output",
        &[
            "LD X004 / PSOUT K0 K100 / DDRVI K100 K100 K0",
            "LD X004 / HOME K0 / LD X004 / PSOUT K0 K100",
            "LD M8000 / GEAR K3 D2000 K0 K1 K1 / LD X005 / DDRVA K100 K100 K3",
            "LD X004 / PTAB D1000 D5000 K1 / PCTAB D1100 D6000",
        ],
        &[
            "LD X004 / PSOUT K0 K100 / PSOUT K1 K100",
            "LD X004 / PSOUT K0 K100 / LD X005 / DDRVI K100 K100 K0",
            "LD X004 / PSOUT K0 K100 / IPL K0 K1",
            "LD X004 / AXPO K0 K0 K1 / AXSP K0 K500 K0 / AXAS K0 K50",
        ],
    );
}

#[test]
fn constants_with_which_motions_of_hm_fail() {
    judge_on(
        ModelId::Hm,
        "constant-fails",
        &[
            "LD M8002 / AXSP K0 K100 K200",
            "LD M8002 / AXSP K0 K0 K0",
            "LD M8002 / AXSP K0 K100 K-1",
            "LD M8002 / AXSP K0 H9C40 D0",
            "LD M8002 / AXOSP K0 K100 K0",
            "LD X0 / DPLSR K0 K100 K100 K0",
            "LD X0 / DPLSY K-1 K100 K0",
            "LD X0 / DDRVI K100 K-5 K0",
            "LD X0 / DDRVA K100 K-5 K0",
            "LD X0 / DDVIT K100 K-5 K0",
            "LD X0 / JOG K0 K10 K100 K0 K0",
            "LD X0 / JOG K0 K0 K0 K1 K2",
            "LD X0 / IPL K0 K-601",
            "LD X0 / PTAB D1000 D2000 K0",
            "LD X0 / PTOUT K0 D2000 D1000 K0 K0",
            "LD X0 / CAM K0 D2000 D1000 K-1 D1100",
        ],
        &[
            "LD M8002 / AXSP K0 K200 K200",
            "LD M8002 / AXSP K0 D0 K200",
            "LD M8002 / AXOSP K0 K0 K1",
            "LD X0 / DPLSR K1 K-100 K100 K0",
            "LD X0 / DPLSY K0 K100 K0",
            "LD X0 / DDVIT K-100 K5 K0",
            "LD X0 / DPLSV K-100 K0",
            "LD X0 / JOG K0 K-10 K0 K0 K2",
            "LD X0 / JOG K0 K0 K100 K1 D0",
            "LD X0 / IPL K0 HFFF6",
            "LD X0 / PTAB D1000 D2000 K1",
            "LD X0 / PTOUT K0 D2000 D1000 D50 K0",
        ],
    );
}

#[test]
fn counters_that_nothing_drives() {
    judge(
        "never-counts",
        &[
            "LDD>= C235 K100 / OUT Y0",
            "LD X0 / DMOV C251 D0",
            "LD M8000 / DHSCS K100 C235 Y0",
            "LD M8000 / DHSZ K100 K200 C235 Y0 / RST C235",
            "LD M8000 / DHSCR K100 C235 Y0 / LD X0 / DMOV K0 C235",
            "LD M8000 / OUT C236 K5 / DMOV C235 D0",
        ],
        &[
            "LD M8000 / OUT C235 K5 / DHSCS K100 C235 Y0",
            "LD X0 / DMOV K100 C235 / LDD>= C235 D0 / OUT Y0",
            "LD X0 / OUT C200 K5 / DMOV C201 D0",
            "LD M8000 / DMOV C200 D0",
            "LD X0 / RST C235",
        ],
    );
    judge_on(
        ModelId::Hm,
        "never-counts",
        &[
            "LD M8000 / DHSCS K100 C235 Y010 K0",
            "LD M8000 / DHSCT D1000 K4 C235 Y000 H700",
            "LD M8000 / DHMOV C250 D1000",
        ],
        &[
            "LD M8000 / OUT C250 K5 / DHMOV C250 D1000",
            "LD M8000 / DHMOV D80 D1000",
        ],
    );
}

#[test]
fn registers_of_the_system() {
    judge_on(
        ModelId::Hm,
        "reserved-register",
        &[
            "LD X004 / MOV K5 D0",
            "LD X004 / MOV K5 D0 / MOV K5 D150 / INCP D999",
            "LD X004 / DMOV K5 D97",
            "LD X004 / BMOV D1000 D590 K20",
            "LD X004 / MOV K5 D325",
            "LD X004 / RST D600",
        ],
        &[
            "LD X004 / MOV D0 D1000",
            "LD X004 / MOV K5 D300 / MOV K5 D316 / MOV K5 D324 / DMOV K0 D318",
            "LD X004 / MOV K5 D200 / DADD D220 K1 D220",
            "LD X004 / DMOV K0 D80 / DMOV K0 D96",
            "LD X004 / ZRST D0 D999",
            "LD X004 / MOV K5 D1000 / MOV K5 R0 / MOV K1 D0V0",
        ],
    );
    judge("reserved-register", &[], &["LD X4 / MOV K5 D0"]);
}

#[test]
fn comparisons_in_one_zone() {
    let counter = "LD M8000 / OUT C255 K1000";
    let wrong = [
        "DHSCS K100 C255 Y010 K0 / DHSCS K150 C255 Y011 K0",
        "DHSCS K100 C255 Y010 K5 / DHSCR K150 C255 Y011 H5",
        "DHSCS K100 C255 Y010 K1 / LD X004 / DHSZ K1 K5 C255 M0 K1",
        "LD X004 / DHSCS K100 C255 Y010 K1 / LD X004 / DHSCR K100 C255 Y010 K1",
    ]
    .map(|rest| format!("{counter} / {rest}"));
    let right = [
        "DHSCS K100 C255 Y010 K0 / DHSCS K150 C255 Y011 K1",
        "DHSCS K100 C255 Y010 D1000 / DHSCS K150 C255 Y011 D1000",
        "LD X004 / DHSCS K100 C255 Y010 K0 / LDI X004 / DHSCS K150 C255 Y011 K0",
        "DHSCT D1000 K4 C255 Y000 H0 / DHSCS K150 C255 Y011 K0",
    ]
    .map(|rest| format!("{counter} / {rest}"));
    let [wrong, right] =
        [&wrong, &right].map(|all| all.iter().map(String::as_str).collect::<Vec<_>>());
    judge_on(ModelId::Hm, "zone-shared", &wrong, &right);
}
