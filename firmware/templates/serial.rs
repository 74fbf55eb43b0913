/// Queues between the interrupt of a UART and the main loop/* HOW */.
type Waiting = /* QUEUE */;

/// A serial port: the interrupt of its UART notes what comes in, with its time, and sends.
struct Uart {
    /// Its number in the PLC's manual.
    port: u8,
    /// The first register.
    at: usize,
    /// Clock that is divided for its bit rate.
    clock_hz: u32,
    /// Switches the driver of an RS-485 line.
    drive: fn(bool),
    line: &'static Line,
}

/// Variable state of a port. All of it begins as 0, so that none of it is in flash.
struct Line {
    /// The bits that a character does not have.
    unused: AtomicU8,
    waiting: Waiting,
}

impl Line {
    const EMPTY: Self = Line { unused: AtomicU8::new(0), waiting: Waiting::new() };
}

/* UART */impl Uart {
    /// Hands over as many characters as the UART takes, and switches the driver of the line.
    fn pump(&self) {
        let waiting = &self.line.waiting;
        if waiting.waiting() > 0 {
            (self.drive)(true);
        }
        while self.has_room()
            && let Some(byte) = waiting.pop()
        {
            write(self.at + OUT, byte.into());
        }
        let sending = waiting.waiting() > 0;
        let last = !sending && !self.has_sent();
        self.expect(sending, last);
        if !sending && !last {
            (self.drive)(false);
            waiting.listen();
        }
    }

    /// The interrupt.
    fn serve(&self) {
        while let Some((byte, fault)) = self.next_character() {
            self.line.waiting.note(Received {
                at_us: fine_us(),
                byte: byte & !self.line.unused.load(Ordering::Relaxed),
                fault,
            });
        }
        self.pump();
    }
}

impl SerialPort for &'static Uart {
    fn set_format(&mut self, format: LineFormat) {
        if format.bits_per_second != 0 {
            self.line.unused.store(!format.mask(), Ordering::Relaxed);
            self.set_up(format);
        }
    }

    fn receive(&mut self, now_us: u32) -> Option<Received> {
        self.line.waiting.take(now_us)
    }

    fn send(&mut self, byte: u8, _now_us: u32) -> bool {
        without_interrupts(|| {
            let is_taken = self.line.waiting.push(byte);
            self.pump();
            is_taken
        })
    }

    fn unsent(&mut self, _now_us: u32) -> u16 {
        without_interrupts(|| {
            self.pump();
            self.line.waiting.waiting() + u16::from(!self.has_sent())
        })
    }
}

/// Does something while no interrupt comes.
fn without_interrupts<T>(work: impl FnOnce() -> T) -> T {
    let masked: u32;
    // SAFETY: the mask is as it was before when the work is done.
    unsafe { asm!("mrs {}, primask", "cpsid i", out(reg) masked) };
    let done = work();
    // SAFETY: the same.
    unsafe { asm!("msr primask, {}", in(reg) masked) };
    done
}

/// Microseconds since the start, wrapping, with what SysTick has counted since the tick.
fn fine_us() -> u32 {
    let (us, left) = without_interrupts(|| {
        let us = MICROSECONDS.load(Ordering::Relaxed);
        let left = read(0xE000_E018);
        // ICSR: the tick waits.
        match read(0xE000_ED04) & 1 << 26 {
            0 => (us, left),
            _ => (us.wrapping_add(TICK_US), read(0xE000_E018)),
        }
    });
    let counted = read(0xE000_E014).wrapping_sub(left);
    let since = match CLOCK_HZ / 1_000_000 {
        0 => counted * (1_000_000 / CLOCK_HZ),
        megahertz => counted / megahertz,
    };
    us.wrapping_add(since.min(TICK_US - 1))
}

/* TABLE */
