//! Charts of step ladders: tidy where the program is, complete whatever it does.

use proptest::prelude::*;
use rungc_analysis::resolve::resolve;
use rungc_ladder::build;
use rungc_ladder::sfc::Chart;
use rungc_models::{Model, ModelId};
use std::collections::BTreeMap;

fn chart(list: &str) -> Option<Chart> {
    let program = rungc_frontend::read_text("list.il", list).program;
    let (resolved, _) = resolve(&program, Model::get(ModelId::Fx3u));
    Chart::of(&resolved, &build::ladder(&resolved))
}

fn drawn(list: &str) -> String {
    chart(list).expect("it has states").text(usize::MAX)
}

/// Balls sorted by size: a branch that is selected (h1u-h2u-programming §4.2.3).
const BALLS: &str = "\
LD M8002\nSET S0\nLD X01\nAND Y03\nANI Y01\nOUT Y07\nSTL S0\nLD X26\nAND Y07\nSET S21\n\
STL S21\nOUT Y00\nOUT T0 K20\nLD T0\nAND X02\nSET S22\nLD T0\nANI X02\nSET S25\nSTL S22\n\
SET Y01\nOUT T1 K10\nLD T1\nSET S23\nSTL S25\nSET Y01\nOUT T1 K10\nLD T1\nSET S26\n\
STL S23\nOUT Y02\nLD X03\nSET S24\nSTL S26\nOUT Y02\nLD X03\nSET S27\nSTL S24\nLDI X04\n\
OUT Y03\nSTL S27\nLDI X05\nOUT Y03\nSTL S24\nLD X04\nSET S30\nSTL S27\nLD X05\nSET S30\n\
STL S30\nOUT Y00\nLD X02\nSET S31\nSTL S31\nRST Y01\nOUT T2 K10\nLD T2\nSET S32\nSTL S32\n\
OUT Y02\nLD X03\nSET S33\nSTL S33\nLDI X01\nOUT Y04\nLD X01\nOUT S0\nRET\nEND\n";

/// A pedestrians' crossing: parallel branches, and a jump in one of them (h1u-h2u-programming §4.2.3).
const CROSSING: &str = "\
LD M8002\nSET S0\nSTL S0\nOUT Y03\nOUT Y05\nLD X00\nOR X01\nSET S21\nSET S30\nSTL S21\n\
OUT Y03\nOUT T0 K300\nLD T0\nSET S22\nSTL S30\nLD T2\nSET S31\nSTL S22\nOUT Y02\n\
OUT T1 K100\nLD T1\nSET S23\nSTL S31\nOUT Y06\nOUT T3 K150\nLD T3\nSET S32\nSTL S23\n\
OUT Y01\nOUT T2 K50\nSTL S32\nOUT T4 K5\nLD T4\nSET S33\nSTL S33\nOUT Y06\nOUT C0 K5\n\
OUT T5 K5\nLD C0\nAND T5\nSET S34\nLDI C0\nAND T5\nOUT S32\nSTL S34\nOUT Y05\nRST C0\n\
OUT T6 K50\nSTL S23\nSTL S34\nLD T6\nOUT S0\nRET\nEND\n";

#[test]
fn selected_branches_meet_at_a_state() {
    insta::assert_snapshot!(drawn(BALLS));
}

#[test]
fn parallel_branches_meet_at_a_transition() {
    insta::assert_snapshot!(drawn(CROSSING));
}

/// A narrow page takes shorter lines first, then branches continue below.
#[test]
fn a_chart_folds_to_the_width_of_its_page() {
    let chart = chart(BALLS).expect("it has states");
    let widest = |text: &str| text.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(widest(&chart.text(usize::MAX)) > 40);
    for width in [40, 34, 30] {
        let text = chart.text(width);
        assert!(widest(&text) <= width, "{width}:\n{text}");
        for state in &chart.states {
            let name = state.device.to_string();
            let boxed = text
                .split(['│', '║', '\n'])
                .filter(|part| part.trim() == name);
            assert_eq!(boxed.count(), 1, "{name}:\n{text}");
        }
    }
    insta::assert_snapshot!(chart.text(30));
    let parallel = self::chart(CROSSING).expect("it has states");
    insta::assert_snapshot!(parallel.text(40));
}

/// However many branches a state has, none is lost and no line is wider than the page.
#[test]
fn many_branches_continue_below() {
    let mut list = String::from("LD M8002\nSET S0\nSTL S0\n");
    for branch in 1..40 {
        list += &format!("LD X{branch:o}\nAND M{branch}\nSET S{branch}\n");
    }
    for branch in 1..40 {
        list += &format!(
            "STL S{branch}\nOUT Y{branch:o}\nLD X0\nOUT S{}\n",
            [0, 40][branch % 2]
        );
    }
    let text = chart(&(list + "STL S40\nLD X1\nOUT S0\nRET\nEND\n"))
        .expect("it has states")
        .text(80);
    for branch in 1..40 {
        assert_eq!(
            text.matches(&format!(" X{branch:03o} · M{branch}\n").trim_end())
                .count()
                .min(1),
            1,
            "{branch}:\n{text}"
        );
    }
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(80), "{text}");
}

#[test]
fn a_picture_of_parallel_branches() {
    let list = "LD M8002\nSET S0\nSTL S0\nLD X0\nSET S20\nSET S21\nSTL S20\nSTL S21\nLDI X1\nOUT S0\nRET\nEND\n";
    let chart = chart(list).expect("it has states");
    insta::assert_snapshot!(chart.sheet().to_string());
}

/// Several entries, parallel branches that do not meet, a state that leads to itself, states without a section, and
/// instructions that switch states from outside.
#[test]
fn what_is_not_tidy_is_complete() {
    let list = "LD M8002\nOR X17\nSET S0\nLD M5\nSET S0\nLD M1\nSET S21\nSTL S0\nLD X0\nSET S20\nSET S21\nSTL S20\nLDP X1\n\
        INV\nOUT S20\nLD X2\nSET S500\nSTL S21\nSTL S20\nLD> D0 K5\nMEP\nOUT S0\nRET\nLD X7\nZRST S0 S50\nRST S500\nEND\n";
    insta::assert_snapshot!(drawn(list));
}

#[test]
fn a_program_without_states_has_no_chart() {
    assert_eq!(chart("LD X0\nSET S0\nEND\n"), None);
}

#[test]
fn long_flows_with_many_branches_are_drawn_in_parts() {
    let mut list = String::from("LD M8002\nSET S0\n");
    for state in 0..800 {
        let (next, over) = ((state + 1) % 800, (state + 2) % 800);
        list += &format!("STL S{state}\nLD X0\nSET S{next}\nLD X1\nSET S{over}\n");
    }
    let text = drawn(&(list + "RET\nEND\n"));
    for state in [0, 1, 150, 400, 799] {
        let boxes = text.matches(&format!(" S{state} ")).count();
        assert!(boxes > 0, "S{state}");
    }
    let bars = text.matches("─┼─").count();
    assert_eq!(bars, 1600);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Random flows: transitions from one or two states to one or two. Each has its own contact.
    #[test]
    fn every_state_and_transition_is_drawn(
        transitions in prop::collection::vec((0..12_u32, 0..24_u32, 0..12_u32, 0..24_u32), 0..25),
    ) {
        let mut list = String::from("LD M8002\nSET S0\n");
        let mut expected = BTreeMap::new();
        for state in 0..12 {
            list += &format!("STL S{state}\nOUT Y{state:o}\n");
            for (i, (from, join, to, more)) in transitions.iter().enumerate() {
                if *from != state || *join < 12 && join != from {
                    continue;
                }
                list += &format!("LD M{i}\nSET S{to}\n");
                if *more < 12 {
                    list += &format!("SET S{more}\n");
                }
                expected.insert(i, 1);
            }
        }
        for (i, (from, join, to, _)) in transitions.iter().enumerate() {
            if *join < 12 && join != from {
                list += &format!("STL S{from}\nSTL S{join}\nLD M{i}\nSET S{to}\n");
                expected.insert(i, 2);
            }
        }
        list += "RET\nEND\n";
        let text = drawn(&list) + " ";
        for state in 0..12 {
            let name = format!("S{state}");
            let boxes = ["│", "║"].map(|side| {
                let left = (9 - name.len()) / 2;
                let right = 7 - left - name.len() + 1;
                let pattern = format!("{side}{}{name}{}{side}", " ".repeat(left - 1), " ".repeat(right));
                text.matches(&pattern).count()
            });
            prop_assert_eq!(boxes.iter().sum::<usize>(), 1, "{}\n{}\n{}", name, list, text);
        }
        for (i, most) in expected {
            let count = [' ', '\n'].map(|end| text.matches(&format!(" M{i}{end}")).count());
            let count: usize = count.iter().sum();
            prop_assert!((1..=most).contains(&count), "M{i}: {count}\n{list}\n{text}");
        }
    }
}
