#![no_std]
#![no_main]

use core::arch::{asm, global_asm};
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering};
use rungc_rt::Hal;
use rungc_rt::board::{CounterInput, Driver, EdgeInterrupt/* EDGE TYPE */, PulseOutput, Setup, Timebase};
/* USE MODULES *//* USE RETAIN *//* USE SERIAL *//* USE PROGRAM */use CRATE::TYPE;

/// The clock that SysTick counts, in Hz.
const CLOCK_HZ: u32 = /* HZ */;

/// The resolution of time, in microseconds.
const TICK_US: u32 = /* TICK */;

/// Inputs and outputs of the program, and from scan to scan.
const SETUP: Setup = Setup {
    inputs: /* INPUTS */,
    outputs: /* OUTPUTS */,
    scan_us: /* SCAN */,
};

// Vectors and what happens between reset and main.
global_asm!(include_str!("startup.s"), options(raw));

/// A register.
fn register(address: usize) -> *mut u32 {
    address as *mut u32
}

fn read(address: usize) -> u32 {
    // SAFETY: the addresses in this file are those of registers.
    unsafe { register(address).read_volatile() }
}

fn write(address: usize, value: u32) {
    // SAFETY: the same.
    unsafe { register(address).write_volatile(value) }
}

/* BITS *//// Microseconds since the start, wrapping. The interrupt alone writes them.
static MICROSECONDS: AtomicU32 = AtomicU32::new(0);

#[unsafe(no_mangle)]
extern "C" fn systick_handler() {
    let now = MICROSECONDS.load(Ordering::Relaxed);
    MICROSECONDS.store(now.wrapping_add(TICK_US), Ordering::Relaxed);
/* LINES */}

/// A semihosting call (bkpt 0xAB) is a hard fault where no debugger listens: it is left out.
///
/// # Safety
/// `frame` is what the core put on the stack when the fault came.
#[unsafe(no_mangle)]
unsafe extern "C" fn hard_fault(frame: *mut u32) {
    // SAFETY: the sixth word of the frame is the address of an instruction.
    unsafe {
        let at = frame.add(6);
        if (*at as *const u16).read() != 0xBEAB {
            hang();
        }
        *at += 2;
    }
    write(0xE000_ED2C, 0x8000_0000); // HFSR: the debug event was seen to
}

fn hang() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    hang()
}

/* SERIAL *//* SCRIPT *//// The board's pins.
struct Pins/* FIELDS */

impl Timebase for Pins {
    fn now_us(&mut self) -> u32 {
        MICROSECONDS.load(Ordering::Relaxed)
    }
}

impl Hal for Pins {
/* HAL */}

/* MODULES */impl EdgeInterrupt for Pins {/* EDGES */}

impl CounterInput for Pins {}

impl PulseOutput for Pins {}

/* CONSOLE *//* RETAIN */static mut DRIVER: MaybeUninit<Driver<TYPE, Pins>> = MaybeUninit::uninit();

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
/* SETUP */    write(0xE000_E014, (CLOCK_HZ as u64 * TICK_US as u64 / 1_000_000) as u32 - 1);
    write(0xE000_E018, 0);
    // SAFETY: main runs once, and nothing else uses it.
    let driver = unsafe { (*(&raw mut DRIVER)).write(Driver::new(TYPE::new(), /* PINS */, SETUP)) };
    write(0xE000_E010, 7); // SysTick: the core's clock, interrupt, on
/* BEFORE */    loop {
/* NOW */        driver.poll();
/* SHOW */        // SAFETY: it waits for the next interrupt.
        unsafe { asm!("wfi") };
    }
}
