/// How many characters of each direction wait, plus one.
const RECEIVE: usize = /* RECEIVE */;
const SEND: usize = /* SEND */;

/// A serial port: the interrupt of its UART notes what comes in, with its time, and sends.
struct Uart {
    /// Its number in the PLC's manual.
    port: u8,
    /// The first register.
    at: usize,
    /// What its bit rate is divided from.
    clock_hz: u32,
    /// Switches the driver of an RS-485 line.
    drive: fn(bool),
    queues: &'static Queues,
}

/// What waits between the interrupt of a UART and the main loop. All of it begins as 0, so that none of it is in flash.
struct Queues {
    /// The bits that a character does not have.
    unused: AtomicU8,
    received: CharQueue<RECEIVE>,
    to_send: [AtomicU8; SEND],
    /// The next character to be sent; changes where no interrupt comes.
    first: AtomicUsize,
    /// Where the next one goes; the main loop's.
    end: AtomicUsize,
}

impl Queues {
    const EMPTY: Self = Queues {
        unused: AtomicU8::new(0),
        received: CharQueue::new(),
        to_send: [const { AtomicU8::new(0) }; SEND],
        first: AtomicUsize::new(0),
        end: AtomicUsize::new(0),
    };
}

/* UART */impl Uart {
    /// How many characters wait to be sent.
    fn waiting(&self) -> usize {
        let queues = self.queues;
        (queues.end.load(Ordering::Relaxed) + SEND - queues.first.load(Ordering::Relaxed)) % SEND
    }

    /// Hands over as many characters as the UART takes, and switches the driver of the line.
    fn pump(&self) {
        if self.waiting() > 0 {
            (self.drive)(true);
        }
        while self.waiting() > 0 && self.has_room() {
            let first = self.queues.first.load(Ordering::Relaxed);
            write(self.at + OUT, self.queues.to_send[first % SEND].load(Ordering::Relaxed).into());
            self.queues.first.store((first + 1) % SEND, Ordering::Relaxed);
        }
        let sending = self.waiting() > 0;
        let last = !sending && !self.has_sent();
        self.expect(sending, last);
        if !sending && !last {
            (self.drive)(false);
        }
    }

    /// The interrupt.
    fn serve(&self) {
        while let Some((byte, fault)) = self.next_character() {
            self.queues.received.note(Received {
                at_us: fine_us(),
                byte: byte & !self.queues.unused.load(Ordering::Relaxed),
                fault,
            });
        }
        self.pump();
    }
}

impl SerialPort for &'static Uart {
    fn set_format(&mut self, format: LineFormat) {
        if format.bits_per_second != 0 {
            self.queues.unused.store(!format.mask(), Ordering::Relaxed);
            self.set_up(format);
        }
    }

    fn receive(&mut self, now_us: u32) -> Option<Received> {
        self.queues.received.take(now_us)
    }

    fn send(&mut self, byte: u8, _now_us: u32) -> bool {
        let end = self.queues.end.load(Ordering::Relaxed);
        let next = (end + 1) % SEND;
        if next == self.queues.first.load(Ordering::Relaxed) {
            return false;
        }
        self.queues.to_send[end % SEND].store(byte, Ordering::Relaxed);
        self.queues.end.store(next, Ordering::Relaxed);
        without_interrupts(|| self.pump());
        true
    }

    fn unsent(&mut self, _now_us: u32) -> u16 {
        without_interrupts(|| {
            self.pump();
            (self.waiting() + usize::from(!self.has_sent())) as u16
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
