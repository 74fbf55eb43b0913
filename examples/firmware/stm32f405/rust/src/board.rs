//! An STM32F4 Discovery, or QEMU's netduinoplus2. The button is PA0, the lamps are PD11 to PD15.

use core::cell::Cell;
use cortex_m::interrupt::{Mutex, free};
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

/// The core's clock: 16 MHz after reset; QEMU's machine has 168 MHz.
const CPU_HZ: u32 = if cfg!(feature = "demo") {
    168_000_000
} else {
    16_000_000
};

/// Number of lamps.
pub const LAMPS: usize = 5;
const FIRST_LAMP: usize = 11;

/// A register of the STM32F405.
struct Register(usize);

const RCC_AHB1ENR: Register = Register(0x4002_3830);
const GPIOA_IDR: Register = Register(0x4002_0010);
const GPIOD_MODER: Register = Register(0x4002_0C00);
const GPIOD_BSRR: Register = Register(0x4002_0C18);

impl Register {
    fn read(&self) -> u32 {
        // SAFETY: the constants above are addresses of registers that may be read at any time.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    fn write(&self, value: u32) {
        // SAFETY: the same; writing them only switches clocks and pins.
        unsafe { (self.0 as *mut u32).write_volatile(value) }
    }
}

/// Period of the clock's interrupt, in microseconds.
const TICK_US: u32 = 50;

/// Time since the clock was set up: milliseconds, and microseconds, which wrap sooner.
static TIME: Mutex<Cell<(u32, u32)>> = Mutex::new(Cell::new((0, 0)));

/// Additional handler of the interrupt.
static ON_TICK: Mutex<Cell<Option<fn(u32)>>> = Mutex::new(Cell::new(None));

#[exception]
fn SysTick() {
    static mut PART_US: u32 = 0;

    *PART_US = (*PART_US + TICK_US) % 1000;
    let (now_us, on_tick) = free(|cs| {
        let (mut milliseconds, mut microseconds) = TIME.borrow(cs).get();
        microseconds = microseconds.wrapping_add(TICK_US);
        if *PART_US == 0 {
            milliseconds = milliseconds.wrapping_add(1);
        }
        TIME.borrow(cs).set((milliseconds, microseconds));
        (microseconds, ON_TICK.borrow(cs).get())
    });
    if let Some(on_tick) = on_tick {
        on_tick(now_us);
    }
}

/// Sets up pins and the clock.
pub fn set_up(clock: &mut SYST) {
    RCC_AHB1ENR.write(RCC_AHB1ENR.read() | 0b1001);
    GPIOD_MODER.write((GPIOD_MODER.read() & 0x003F_FFFF) | 0x5540_0000);
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(CPU_HZ / 1_000_000 * TICK_US - 1);
    clock.clear_current();
    clock.enable_counter();
    clock.enable_interrupt();
}

/// Milliseconds since the clock was set up.
pub fn millis() -> u32 {
    free(|cs| TIME.borrow(cs).get().0)
}

/// Microseconds since the clock was set up, wrapping; their resolution is 50.
pub fn micros() -> u32 {
    free(|cs| TIME.borrow(cs).get().1)
}

/// Sets the handler that is called at each of these steps, in an interrupt, with the time.
pub fn on_tick(handler: fn(u32)) {
    free(|cs| ON_TICK.borrow(cs).set(Some(handler)));
}

/// The button.
pub fn button() -> bool {
    GPIOA_IDR.read() & 1 != 0
}

/// Switches a lamp.
pub fn set_lamp(lamp: usize, on: bool) {
    let pin = 1 << (FIRST_LAMP + lamp);
    GPIOD_BSRR.write(if on { pin } else { pin << 16 });
}
