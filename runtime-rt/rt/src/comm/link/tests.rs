//! PLCs on a line, whose frames arrive whole and at once.

use super::*;
use crate::comm::watched::{Watched, reply_of};
use proptest::prelude::*;
use std::vec::Vec;

/// One PLC on the line.
struct Station {
    role: Role,
    link: Link,
    map: Watched,
    faults: Vec<LineFault>,
    cut_off: bool,
}

fn station(role: Role, registers: &[(u32, i32)]) -> Station {
    let mut map = Watched::new();
    for &(register, value) in registers {
        map.plc.set_d(register, &[value]);
    }
    Station {
        role,
        link: Link::new(),
        map,
        faults: Vec::new(),
        cut_off: false,
    }
}

/// Lets the stations talk for so long, in steps of 10 ms; returns how many frames were sent.
fn talk(line: &mut [Station], now_us: &mut u32, ms: u32) -> usize {
    let mut frames = 0;
    for _ in 0..ms / 10 {
        *now_us = now_us.wrapping_add(10_000);
        for sender in 0..line.len() {
            let Station {
                role,
                link,
                map,
                faults,
                cut_off,
            } = &mut line[sender];
            let (frame, outcome) = reply_of(|frame| link.poll(*role, *now_us, map, frame));
            faults.extend(outcome.err());
            if frame.is_empty() {
                continue;
            }
            frames += 1;
            if *cut_off {
                continue;
            }
            for (at, hearer) in line.iter_mut().enumerate() {
                if at == sender || hearer.cut_off {
                    continue;
                }
                if hearer.link.cut(hearer.role, &frame) == Cut::Whole {
                    let received =
                        hearer
                            .link
                            .receive(hearer.role, &frame, *now_us, &mut hearer.map);
                    hearer.faults.extend(received.err());
                }
            }
        }
    }
    frames
}

#[test]
fn parallel_link_shows_areas() {
    let mut line = [
        station(Role::ParallelMaster, &[(490, 11), (499, -5), (489, 1)]),
        station(Role::ParallelSlave, &[(500, 22), (509, 1234), (510, 2)]),
    ];
    line[0].map.plc.set_m(800, "1");
    line[0].map.plc.set_m(899, "1");
    line[1].map.plc.set_m(900, "1");
    line[1].map.plc.set_m(999, "11");
    let mut now_us = u32::MAX - 50_000;
    talk(&mut line, &mut now_us, 100);
    let [a, b] = &line;
    assert_eq!(b.map.plc.d(489, 2), [0, 11]);
    assert_eq!(b.map.plc.d(499, 1), [-5]);
    assert_eq!(a.map.plc.d(509, 2), [1234, 0]);
    assert_eq!(
        (b.map.plc.m(800, 2), b.map.plc.m(899, 1)),
        ("10".into(), "1".into())
    );
    assert_eq!(
        (a.map.plc.m(900, 1), a.map.plc.m(999, 2)),
        ("1".into(), "10".into())
    );
    assert_eq!(
        (a.map.plc.m(8072, 1), b.map.plc.m(8072, 1)),
        ("1".into(), "1".into())
    );
    assert!(a.faults.is_empty() && b.faults.is_empty());
    line[1].cut_off = true;
    talk(&mut line, &mut now_us, 600);
    assert_eq!(line[0].faults, [LineFault::TimeOut]);
    assert_eq!(line[0].map.plc.m(8072, 1), "0");
}

#[test]
fn high_speed_parallel_link_moves_two_words() {
    let mut line = [
        station(Role::ParallelMaster, &[(490, 1), (491, 2), (492, 3)]),
        station(Role::ParallelSlave, &[(500, 4)]),
    ];
    for plc in &mut line {
        plc.map.plc.set_m(8162, "1");
    }
    talk(&mut line, &mut 0, 100);
    assert_eq!(line[1].map.plc.d(490, 3), [1, 2, 0]);
    assert_eq!(line[0].map.plc.d(500, 1), [4]);
    // Both have to be in the same mode.
    line[1].map.plc.set_m(8162, "0");
    talk(&mut line, &mut 1_000_000, 100);
    assert!(line[1].faults.contains(&LineFault::Form));
}

const MASTER: Role = Role::NnMaster { enhanced: false };
const SLAVE: Role = Role::NnSlave { enhanced: false };

#[test]
fn nn_link_shows_blocks_to_all() {
    let mut line = [
        station(
            MASTER,
            &[(0, 100), (8, 9), (8177, 2), (8178, 2), (8179, 3), (8180, 5)],
        ),
        station(SLAVE, &[(10, 101), (8176, 1)]),
        station(SLAVE, &[(20, 102), (8176, 2)]),
    ];
    line[2].map.plc.set_m(1128, "1");
    talk(&mut line, &mut 0, 500);
    for plc in &line {
        assert_eq!(plc.map.plc.d(0, 1), [100]);
        assert_eq!(plc.map.plc.d(10, 1), [101]);
        assert_eq!(plc.map.plc.d(20, 1), [102]);
        assert_eq!(plc.map.plc.m(1128, 1), "1");
        assert_eq!(plc.map.plc.m(8183, 3), "000");
        assert_eq!(plc.map.plc.m(8191, 1), "1");
    }
    assert_eq!(line[1].map.plc.d(8, 1), [0]);
    assert_eq!(line[2].map.plc.d(8173, 3), [2, 2, 2]);
    assert!(line.iter().all(|plc| plc.faults.is_empty()));
}

#[test]
fn nn_link_reports_missing_stations_to_all() {
    let mut now_us = 0;
    let mut line = [
        station(MASTER, &[(8177, 2), (8178, 0), (8179, 3), (8180, 5)]),
        station(SLAVE, &[(10, 101), (8176, 1)]),
    ];
    talk(&mut line, &mut now_us, 1000);
    for plc in &line {
        assert_eq!(plc.map.plc.m(8183, 3), "001");
    }
    assert_eq!(
        line[0].map.plc.d(8205, 1),
        [1],
        "one failure after four tries"
    );
    assert_eq!(line[0].map.plc.d(8213, 1), [1]);
    line[1].cut_off = true;
    talk(&mut line, &mut now_us, 4000);
    assert_eq!(line[0].map.plc.m(8183, 3), "011");
    assert_eq!(
        line[1].map.plc.m(8183, 1),
        "1",
        "the slave misses the master"
    );
    line[1].cut_off = false;
    talk(&mut line, &mut now_us, 1000);
    assert_eq!(line[0].map.plc.m(8183, 3), "001");
    assert_eq!(line[1].map.plc.m(8183, 3), "001");
}

#[test]
fn enhanced_nn_link_has_sixteen_stations() {
    let mut line = [
        station(
            Role::NnMaster { enhanced: true },
            &[(200, 1), (231, 32), (8177, 15), (8180, 5)],
        ),
        station(
            Role::NnSlave { enhanced: true },
            &[(800, 41), (831, 72), (8176, 15)],
        ),
    ];
    line[1].map.plc.set_m(1613, "1");
    talk(&mut line, &mut 0, 3000);
    assert_eq!(line[1].map.plc.d(231, 1), [32]);
    assert_eq!(line[0].map.plc.d(831, 1), [72]);
    assert_eq!(line[0].map.plc.m(1613, 1), "1");
    assert_eq!(line[0].map.plc.m(8310, 8), "11111110");
    assert!(line[0].map.plc.d(8201, 1)[0] > 0);
}

#[test]
fn stop_is_silence() {
    let mut line = [
        station(MASTER, &[(8177, 1)]),
        station(SLAVE, &[(10, 101), (8176, 1)]),
    ];
    line[0].map.plc.sys.running = false;
    assert_eq!(talk(&mut line, &mut 0, 1000), 0);
}

#[test]
fn computer_link_master_asks_and_gives_up() {
    let area = [(1000, 7100), (1001, 1), (1002, 2), (7100, 1), (1012, -1)];
    let mut line = [station(Role::ComputerLinkMaster { area: 1000 }, &area)];
    let mut now_us = 0;
    assert_eq!(talk(&mut line, &mut now_us, 300), 1);
    let [master] = &mut line;
    let answer = b"\x0201FF007B\x03C9";
    assert_eq!(master.link.cut(master.role, answer), Cut::Whole);
    master
        .link
        .receive(master.role, answer, now_us, &mut master.map)
        .unwrap();
    assert_eq!(master.map.plc.d(7101, 1), [123]);
    assert_eq!(master.map.plc.d(1012, 1), [-3]);
    talk(&mut line, &mut now_us, 400);
    assert_eq!(line[0].map.plc.d(1012, 1), [-1]);
    assert_eq!(line[0].map.plc.d(1016, 2), [1, 1]);
}

proptest! {
    /// Any text with a right sum, in any role: no panic, and no device outside of the areas is written.
    #[test]
    fn any_text(kind in "[ABDP]", text in "[0-9A-F]{0,8}", more in "[0-9A-G]{0,160}", enhanced: bool) {
        let text = std::format!("{kind}{text}{more}\x03");
        let sum = text.bytes().fold(0u8, |sum, c| sum.wrapping_add(c));
        let frame = std::format!("\x02{text}{sum:02X}");
        for role in [
            Role::ParallelMaster,
            Role::ParallelSlave,
            Role::NnMaster { enhanced },
            Role::NnSlave { enhanced },
            Role::ComputerLinkMaster { area: 1000 },
        ] {
            let mut line = [station(role, &[(8176, 1), (8177, 3), (832, 7), (489, 7)])];
            talk(&mut line, &mut 0, 20);
            let [plc] = &mut line;
            plc.link.cut(role, frame.as_bytes());
            let _ = plc.link.receive(role, frame.as_bytes(), 30_000, &mut plc.map);
            prop_assert_eq!(plc.map.strays, 0);
            prop_assert_eq!(plc.map.plc.d(832, 1), [7]);
            prop_assert_eq!(plc.map.plc.d(489, 1), [7]);
            talk(&mut line, &mut 30_000, 20);
        }
    }

    /// Any bytes.
    #[test]
    fn any_bytes(frame in proptest::collection::vec(any::<u8>(), 0..200)) {
        for role in [Role::ParallelMaster, Role::NnSlave { enhanced: true }, MASTER] {
            let mut plc = station(role, &[]);
            plc.link.cut(role, &frame);
            prop_assert!(plc.link.receive(role, &frame, 0, &mut plc.map).is_err());
            prop_assert_eq!(plc.map.writes, 0);
        }
    }
}
