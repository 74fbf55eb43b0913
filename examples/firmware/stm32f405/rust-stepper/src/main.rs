//! A stepper motor on an STM32F405. Pulses are on PD11, which an interrupt switches every 50 µs at the soonest, however
//! long a scan takes; it also notes when the button is pressed and let go.

#![no_std]
#![no_main]

#[path = "../../rust/src/board.rs"]
#[allow(dead_code, reason = "the traffic light needs other parts of it")]
mod board;

use core::cell::{Cell, RefCell};
use cortex_m::interrupt::{Mutex, free};
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use panic_halt as _;
use rungc_rt::board::{
    CounterInput, Driver, EdgeInterrupt, EdgeQueue, InputEdge, PulseOutput, Setup, SharedAxes,
    Timebase, send_pulses,
};
use rungc_rt::{Axis, Hal, Program};
use stepper::Stepper;

/// Under QEMU, the button is pressed automatically: it is on from 10 to 20 ms.
const DEMO: bool = cfg!(feature = "demo");

/// Edges of the button.
static EDGES: EdgeQueue<16> = EdgeQueue::new();

/// Pulse outputs, whose pulses are sent on their pins.
static PULSES: Mutex<RefCell<SharedAxes<{ Stepper::PULSE_OUTPUTS }>>> =
    Mutex::new(RefCell::new([None; Stepper::PULSE_OUTPUTS]));

/// Time of the next change of a pulse output, in microseconds.
static DUE: Mutex<Cell<Option<u32>>> = Mutex::new(Cell::new(None));

/// True if the button was on at the last tick.
static WAS_ON: Mutex<Cell<bool>> = Mutex::new(Cell::new(false));

fn button(now_us: u32) -> bool {
    if DEMO {
        (10_000..20_000).contains(&now_us)
    } else {
        board::button()
    }
}

fn set_pin(output: u16, on: bool) {
    if usize::from(output) < board::LAMPS {
        board::set_lamp(output.into(), on);
    }
}

/// In an interrupt: notes edges of the button, and switches the pins whose time has come.
fn tick(now_us: u32) {
    let level = button(now_us);
    free(|cs| {
        if WAS_ON.borrow(cs).replace(level) != level {
            EDGES.note(InputEdge { input: 0, level });
        }
        let due = DUE.borrow(cs);
        if due
            .get()
            .is_some_and(|due| now_us.wrapping_sub(due) as i32 >= 0)
        {
            let mut pulses = PULSES.borrow(cs).borrow_mut();
            let wait = send_pulses(&mut *pulses, now_us, set_pin);
            due.set(wait.map(|wait| now_us.wrapping_add(wait)));
        }
    });
}

struct Board;

impl Hal for Board {
    /// X0 is the button.
    fn input(&mut self, number: u16) -> Option<bool> {
        (number == 0).then(|| button(board::micros()))
    }

    fn set_output(&mut self, number: u16, on: bool) {
        set_pin(number, on);
    }

    fn with_pulses(&mut self, work: &mut dyn FnMut(&mut [Option<Axis>])) {
        free(|cs| work(&mut *PULSES.borrow(cs).borrow_mut()));
    }
}

impl Timebase for Board {
    fn now_us(&mut self) -> u32 {
        board::micros()
    }
}

impl EdgeInterrupt for Board {
    fn next_edge(&mut self) -> Option<InputEdge> {
        EDGES.take()
    }

    fn notes_edges(&self, input: u32) -> bool {
        input == 0
    }
}

impl CounterInput for Board {}

impl PulseOutput for Board {
    fn wake_in(&mut self, us: Option<u32>) {
        let due = us.map(|us| board::micros().wrapping_add(us));
        free(|cs| DUE.borrow(cs).set(due));
    }
}

#[entry]
fn main() -> ! {
    let setup = Setup {
        inputs: 1,
        outputs: board::LAMPS as u16,
        scan_us: 1000,
    };
    let mut driver = Driver::new(Stepper::new(), Board, setup);

    board::on_tick(tick);
    if let Some(mut core) = cortex_m::Peripherals::take() {
        board::set_up(&mut core.SYST);
    }
    loop {
        driver.poll();
        // Y1: the steps are done.
        if DEMO && driver.program.output(1) {
            hprintln!("done after {:04} ms", driver.now_ms());
            debug::exit(debug::EXIT_SUCCESS);
        }
        cortex_m::asm::wfi();
    }
}
