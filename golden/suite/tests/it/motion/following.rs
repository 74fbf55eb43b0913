//! Axes of HM that follow a master or a table: how many pulses they differ from the formula of the manual. The master
//! is a register that moves on in each scan of a millisecond, so the pulses of a scan are sent in the next millisecond.

use rungc_golden::module;
use rungc_interp::Machine;
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};
use std::fmt::Write;

/// An axis that follows, and its formula.
struct Following {
    name: &'static str,
    source: &'static str,
    /// Program that makes it follow, and its table if it has one; M0 is on once the table is made.
    program: &'static str,
    /// Distance of the master in a millisecond, and in all.
    master: (i32, i32),
    /// The formula, for the manual's column.
    formula: &'static str,
    /// Pulses where the master has moved so far.
    expected: fn(f64) -> f64,
    /// By how many pulses whole numbers may differ from the formula.
    most: f64,
}

/// Before the program: the axis, at most 90 pulses per millisecond.
const AXIS: &str = "LD M8002\nAXPO K0 K0 K1\nAXPU K0 K10 K0 K0\nAXSP K0 K900 K0\nAXAS K0 K9000\n";

/// A segment of 8000 pulses over 200 points, from rest to 80 pulses a point: D1000 chooses the curve.
macro_rules! segment {
    ($curve:literal) => {
        concat!(
            "DMOV K1 D5000\nDMOV K0 D5002\n",
            $curve,
            "MOV K0 D1001\nDMOV K8000 D1002\nMOV K200 D1004\nMOV K0 D1005\nMOV K1 D1008\nMOV K1 D1009\n\
             LD M1\nPTAB D1000 D5000 K1\nLD M0\nPTOUT K0 D5000 D1200 K200 K0\n"
        )
    };
}

const FOLLOWING: [Following; 5] = [
    Following {
        name: "GEAR",
        source: "hm-motion-controller §8.4.1",
        program: "LD M0\nGEAR K0 D1200 K0 K3 K2\n",
        master: (30, 30_000),
        formula: "3/2 · x",
        expected: |x| 1.5 * x,
        most: 1.0,
    },
    Following {
        name: "PTAB and PTOUT, even acceleration",
        source: "hm-motion-controller §8.3.4, §8.3.5",
        program: segment!("MOV K0 D1000\n"),
        master: (1, 200),
        formula: "8000 · u², u = x/200",
        expected: |x| 8000.0 * (x / 200.0).powi(2),
        most: 0.5,
    },
    Following {
        name: "PTAB and PTOUT, fourth degree",
        source: "hm-motion-controller §8.3.4, §8.3.5",
        program: segment!("MOV K2 D1000\n"),
        master: (1, 200),
        formula: "8000 · (2 − u) · u³",
        expected: |x| {
            let u = x / 200.0;
            8000.0 * (2.0 - u) * u.powi(3)
        },
        most: 0.5,
    },
    Following {
        name: "CAM, a parabola of 10 segments",
        source: "hm-motion-controller §8.4.2",
        program: "DMOV K11 D5000\nDMOV K0 D5002\nDMOV K100 D5004\nDMOV K400 D5006\nDMOV K900 D5008\nDMOV K1600 D5010\n\
                  DMOV K2500 D5012\nDMOV K3600 D5014\nDMOV K4900 D5016\nDMOV K6400 D5018\nDMOV K8100 D5020\nDMOV K10000 D5022\n\
                  MOV K1400 D1300\nMOV K1402 D1328\nMOV K1 D1329\nMOV K1 D1330\nLD M0\nCAM K0 D5000 D1200 K1000 D1300\n",
        master: (4, 996),
        formula: "linear between n² · 100 at x = 100 n",
        expected: |x| {
            let (n, part) = ((x / 100.0).floor(), (x / 100.0).fract());
            100.0 * (n * n + part * (2.0 * n + 1.0))
        },
        most: 1.0,
    },
    Following {
        name: "IPL",
        source: "hm-motion-controller §8.3.6",
        program: "LD M0\nIPL K0 K25\n",
        master: (1, 400),
        formula: "25 · x, x in ms",
        expected: |x| 25.0 * x,
        most: 0.0,
    },
];

impl Following {
    /// Follows the master to its end; the greatest difference in pulses, and the pulses that were sent.
    fn run(&self) -> (f64, f64) {
        let module = module(&format!("{AXIS}{}END\n", self.program), ModelId::Hm);
        let mut machine = Machine::new(&module);
        let mut now_ms = 0;
        let mut scan = |machine: &mut Machine| {
            machine.scan(&mut NoHal, now_ms, 1000);
            now_ms += 1;
            machine.tick(&mut NoHal, now_ms);
        };
        scan(&mut machine);
        machine.set_bit(Class::M, 1, true);
        for _ in 0..300 {
            scan(&mut machine);
        }
        machine.set_bit(Class::M, 0, true).expect("it exists");
        // IPL sends in its first scan; the others begin to follow in theirs.
        let (step, whole) = self.master;
        let inserts = self.name == "IPL";
        if !inserts {
            scan(&mut machine);
        }
        let mut greatest = 0f64;
        for moved in (step..=whole).step_by(step as usize) {
            machine.set_word(Class::D, 1200, moved as i16);
            scan(&mut machine);
            let sent = f64::from(machine.pulses_sent(0));
            greatest = greatest.max((sent - (self.expected)(f64::from(moved))).abs());
        }
        (greatest, f64::from(machine.pulses_sent(0)))
    }
}

/// The rows of the table of axes that follow.
pub fn table() -> String {
    let mut table = String::from(
        "| move | source | formula | pulses, by the formula | pulses | greatest difference in pulses |\n|---|---|---|--:|--:|--:|\n",
    );
    for following in &FOLLOWING {
        let (greatest, sent) = following.run();
        let expected = (following.expected)(f64::from(following.master.1));
        let Following {
            name,
            source,
            formula,
            most,
            ..
        } = following;
        let _ = writeln!(
            table,
            "| {name} | {source} | {formula} | {expected} | {sent} | {greatest:.1} |"
        );
        assert!(greatest <= *most, "{name}: {greatest} of {most} pulses");
    }
    table
}
