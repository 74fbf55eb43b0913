//! Flow of power in the ladder of a running program.

use rungc_analysis::resolve::resolve;
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_ladder::build;
use rungc_live::Scene;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_rt::{Class, Plc, Program as _, VirtualHal};
use rungc_sim::record::Seen;
use rungc_syntax::Program;
use std::fmt::Write as _;

fn compiled(list: &str) -> (Program, Module) {
    let program = rungc_frontend::read_text("list.il", list).program;
    let options = CompileOptions {
        observe_all: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    let diagnostics = compiled.diagnostics;
    let module = compiled
        .module
        .unwrap_or_else(|| panic!("{diagnostics:?}\n{list}"));
    (program, module)
}

/// Results of `look` after each of `count` scans; `set` gives devices their values before.
fn scans<T>(
    list: &str,
    count: u32,
    mut set: impl FnMut(u32, &mut Machine),
    mut look: impl FnMut(&mut Scene, Seen) -> T,
) -> Vec<T> {
    let (program, module) = compiled(list);
    let (resolved, _) = resolve(&program, module.model);
    let (mut scene, pictures) = Scene::new(&resolved, &build::ladder(&resolved));
    assert_eq!(scene.networks(), pictures.len());
    let mut machine = Machine::new(&module);
    let mut hal = VirtualHal::new();
    let mut scan = |n: u32| {
        set(n, &mut machine);
        machine.scan(&mut hal, 10 * n, 10_000);
        let seen = Seen {
            machine: &machine,
            hal: &hal,
            plant: None,
        };
        scene.scanned(seen);
        look(&mut scene, seen)
    };
    (0..count).map(&mut scan).collect()
}

/// The states of all networks after each scan.
fn states(list: &str, count: u32, set: impl FnMut(u32, &mut Machine)) -> Vec<Vec<String>> {
    let look = |scene: &mut Scene, seen: Seen| {
        let states = scene.look(seen);
        states.iter().map(ToString::to_string).collect()
    };
    scans(list, count, set, look)
}

#[test]
fn contacts_conduct_and_coils_take_power() {
    let list = "LD X0\nOR M0\nANI X1\nOUT M0\nLD>= D0 K5\nMOV D0 D2\nOUT T0 K3\nEND\n";
    let seen = states(list, 2, |n, machine| {
        machine.set_bit(Class::X, 0, n == 0).unwrap();
        machine.set_word(Class::D, 0, 4 + n as i16).unwrap();
    });
    assert_eq!(
        seen[0][..2],
        [
            r#"["111","1111",{}]"#,
            r#"["10","000",{"0":"D0=4","1":"D0=4 D2=0","2":"T0=0"}]"#
        ]
    );
    assert_eq!(
        seen[1][..2],
        [
            r#"["111","0111",{}]"#,
            r#"["11","111",{"0":"D0=5","1":"D0=5 D2=5","2":"T0=0"}]"#
        ]
    );
}

#[test]
fn edges_conduct_for_one_scan() {
    let list = "LDP X0\nOUT Y0\nLDF X0\nOUT Y1\nLD X0\nMEP\nOUT Y2\nEND\n";
    let seen = states(list, 4, |n, machine| {
        machine.set_bit(Class::X, 0, n == 1 || n == 2).unwrap();
    });
    let rows = |network: usize| seen.iter().map(move |states| &states[network][..6]);
    let expected = [r#"["10","#, r#"["11","#, r#"["10","#, r#"["10","#];
    assert_eq!(rows(0).collect::<Vec<_>>(), expected);
    assert_eq!(seen[3][1], r#"["11","11",{}]"#);
    assert_eq!(seen[1][2], r#"["111","111",{}]"#);
    assert_eq!(seen[2][2], r#"["110","100",{}]"#);
}

#[test]
fn rails_after_master_controls_and_in_states_have_their_power() {
    let list = "LD X0\nMC N0 M50\nLD M8000\nOUT Y0\nMCR N0\nLD X1\nSET S0\nSTL S0\nOUT Y1\nRET\nLD M8000\nOUT Y2\nEND\n";
    let seen = states(list, 2, |n, machine| {
        machine.set_bit(Class::X, 0, n == 1).unwrap();
        machine.set_bit(Class::X, 1, n == 1).unwrap();
    });
    let powered = |scan: usize| -> Vec<bool> {
        let states = seen[scan].iter();
        states.map(|state| state.starts_with(r#"["1"#)).collect()
    };
    assert_eq!(seen[0].len(), 9);
    assert_eq!(
        powered(0),
        [true, false, false, true, true, false, false, true, true]
    );
    assert_eq!(powered(1), [true; 9]);
}

#[test]
fn what_rst_holds_elsewhere_shows_its_reset_state() {
    // The subroutine is called in scan 1 with the drive of RST on, in scan 3 with it off.
    for rst in ["RST C3", "RST C1Z0"] {
        let list = format!("LD X0\nCALL P0\nLD X1\nOUT C3 K5\nFEND\nP0\nLD X2\n{rst}\nSRET\nEND\n");
        let seen = states(&list, 5, |n, machine| {
            machine.set_word(Class::Z, 0, 2).unwrap();
            machine.set_bit(Class::X, 0, n == 1 || n == 3).unwrap();
            machine.set_bit(Class::X, 1, n % 2 == 0).unwrap();
            machine.set_bit(Class::X, 2, n == 1).unwrap();
        });
        let value = |states: &Vec<String>| states[1].split(['=', '"']).nth(8).map(str::to_string);
        let values: Vec<_> = seen.iter().filter_map(value).collect();
        assert_eq!(values, ["1", "0 (reset)", "0 (reset)", "0", "1"], "{rst}");
    }
}

#[test]
fn indexed_operands_are_those_that_the_index_leads_to() {
    let list = "LD M8000\nMOV D0Z0 D10\nDADD D20 K1 D22\nDEMOV E1.5 D30\nEND\n";
    let seen = states(list, 1, |_, machine| {
        machine.set_word(Class::Z, 0, 3).unwrap();
        machine.set_word(Class::D, 3, 77).unwrap();
    });
    let values = r#"{"1":"D20=0 D22=1","2":"D30=1.5","3":"D0Z0=77 D10=77"}]"#;
    assert!(seen[0][0].ends_with(values), "{}", seen[0][0]);
}

/// Numbers that look random.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }

    /// A block of contacts of inputs.
    fn block(&mut self, depth: u32, list: &mut String) {
        let contact = |numbers: &mut Self, name: &str, list: &mut String| {
            let closed = if numbers.below(3) == 0 { "I" } else { "" };
            let name = match (name, closed) {
                ("AND", "I") => "ANI".to_string(),
                (name, closed) => format!("{name}{closed}"),
            };
            let _ = writeln!(list, "{name} X{:o}", numbers.below(16));
        };
        contact(self, "LD", list);
        for _ in 0..self.below(6) {
            match self.below(5) {
                0 => contact(self, "OR", list),
                1 if depth > 0 => {
                    self.block(depth - 1, list);
                    list.push_str("ORB\n");
                }
                2 if depth > 0 => {
                    self.block(depth - 1, list);
                    list.push_str("ANB\n");
                }
                _ => contact(self, "AND", list),
            }
        }
    }
}

#[test]
fn power_reaches_a_coil_just_when_the_program_switches_it_on() {
    let mut numbers = Numbers(1);
    for _ in 0..40 {
        let mut list = String::new();
        for y in 0..16 {
            numbers.block(3, &mut list);
            if numbers.below(4) == 0 {
                list.push_str("INV\n");
            }
            let _ = writeln!(list, "OUT Y{y:o}");
        }
        list.push_str("END\n");
        let mut inputs = Numbers(numbers.below(1 << 30));
        let set = |_, machine: &mut Machine| {
            for x in 0..16 {
                let on = inputs.below(2) == 1;
                machine.set_bit(Class::X, x, on).unwrap();
            }
        };
        let compare = |scene: &mut Scene, seen: Seen| {
            for y in 0..16 {
                let is_on = seen.machine.bit(Class::Y, y).unwrap();
                assert_eq!(scene.reaches(y as usize, seen), is_on, "Y{y:o}\n{list}");
            }
        };
        assert_eq!(scans(&list, 20, set, compare).len(), 20);
    }
}
