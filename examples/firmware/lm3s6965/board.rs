//! Pins of an LM3S6965, or of QEMU's lm3s6965evb: the button is PF1 (the board's select button), the lamps are PD0 to
//! PD4.

/// The core's clock after reset: the internal oscillator.
pub const CPU_HZ: u32 = 12_000_000;

/// Number of lamps.
pub const LAMPS: usize = 5;

/// A register of the LM3S6965.
struct Register(usize);

const RCGC2: Register = Register(0x400F_E108);
const GPIOD: usize = 0x4000_7000;
const GPIOF: usize = 0x4002_5000;
const DIRECTION: usize = 0x400;
const PULL_UP: usize = 0x510;
const DIGITAL: usize = 0x51C;
const BUTTON: u32 = 1 << 1;

/// Data of some of a port's pins: bits 2 to 9 of the address say of which.
const fn data(port: usize, pins: u32) -> Register {
    Register(port + ((pins as usize) << 2))
}

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

/// Sets up the pins.
pub fn set_up() {
    RCGC2.write(1 << 3 | 1 << 5);
    // A port may be used three clocks after its own has begun.
    RCGC2.read();
    Register(GPIOD + DIRECTION).write((1 << LAMPS) - 1);
    Register(GPIOD + DIGITAL).write((1 << LAMPS) - 1);
    Register(GPIOF + PULL_UP).write(BUTTON);
    Register(GPIOF + DIGITAL).write(BUTTON);
}

/// Returns true if the button is pressed.
pub fn button() -> bool {
    data(GPIOF, BUTTON).read() == 0
}

/// Turns a lamp on or off.
pub fn set_lamp(lamp: usize, on: bool) {
    let pin = 1 << lamp;
    data(GPIOD, pin).write(if on { pin } else { 0 });
}
