/* Queues between the interrupt of a UART and the main loop/* HOW */. */
typedef struct {
    /* SHARE */ {
        rungc_characters received;
        struct {
            uint8_t bytes[SEND];
            volatile uint16_t first; /* the next one to be sent; changes where no interrupt comes, as the next two do */
            volatile uint16_t end;   /* index for the next one */
        } out;
    };
    volatile bool sends;
    uint8_t mask; /* the bits of a character */
} queues;

/* A serial port: the interrupt of its UART notes what comes in, with its time, and sends. */
typedef struct {
    uint8_t port;           /* its number in the PLC's manual */
    uint32_t at;            /* the first register of its UART */
    uint32_t clock_hz;      /* clock that is divided for its bit rate */
    void (*drive)(bool on); /* switches the driver of an RS-485 line, or NULL */
    queues *waiting;
} uart;

static uint32_t mask_interrupts(void)
{
    uint32_t masked;

    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(masked)::"memory");
    return masked;
}

static void unmask_interrupts(uint32_t masked)
{
    __asm__ volatile("msr primask, %0" ::"r"(masked) : "memory");
}

/* Returns true if received characters are stored. */
static bool listens(const queues *q)
{
    /* LISTENS */
}

/* TIME *//* UART *//* Number of characters to be sent. */
static uint32_t to_send(const queues *q)
{
    return q->sends ? (q->out.end + SEND - q->out.first) % SEND : 0u;
}

/* Hands over as many characters as the UART takes, and switches the driver of the line. */
static void pump(const uart *u)
{
    queues *const q = u->waiting;

    if (to_send(q) > 0u && u->drive != NULL) {
        u->drive(true);
    }
    while (to_send(q) > 0u && has_room(u)) {
        REGISTER(u->at + OUT) = q->out.bytes[q->out.first];
        q->out.first = (uint16_t)((q->out.first + 1u) % SEND);
    }
    const bool sending = to_send(q) > 0u;
    const bool last = !sending && !has_sent(u);
    expect(u, sending, last);
    if (sending || last) {
        return;
    }
    if (u->drive != NULL) {
        u->drive(false);
    }
    if (q->sends) {
/* LISTEN */        q->sends = false;
    }
}

/* The interrupt of a UART. */
static void serve(const uart *u)
{
    rungc_char_fault fault;
    uint8_t byte;

    while (next_character(u, &byte, &fault)) {
        if (listens(u->waiting)) {
            rungc_note_character(&u->waiting->received, fine_us(), byte & u->waiting->mask, fault);
        }
    }
    pump(u);
}

/* TABLE */static const uart *uart_of(uint8_t port)
{
    for (size_t i = 0; i < sizeof uarts / sizeof uarts[0]; i++) {
        if (uarts[i].port == port) {
            return &uarts[i];
        }
    }
    return NULL;
}

static void set_line(void *context, uint8_t port, const rungc_line_format *format)
{
    const uart *const u = uart_of(port);

    (void)context;
    if (u != NULL && format->bits_per_second != 0u) {
        u->waiting->mask = format->data_bits == 7u ? 0x7Fu : 0xFFu;
        set_format(u, format);
    }
}

static bool receive(void *context, uint8_t port, uint32_t now_us, rungc_received *received)
{
    const uart *const u = uart_of(port);

    (void)context;
    return u != NULL && listens(u->waiting) && rungc_take_character(&u->waiting->received, now_us, received);
}

static bool send(void *context, uint8_t port, uint8_t byte, uint32_t now_us)
{
    const uart *const u = uart_of(port);

    (void)context;
    (void)now_us;
    if (u == NULL) {
        return false;
    }
    queues *const q = u->waiting;
    const uint32_t masked = mask_interrupts();
    const bool is_taken = to_send(q) < SEND - 1u;
    if (!q->sends) {
        q->out.first = 0;
        q->out.end = 0;
        q->sends = true;
    }
    if (is_taken) {
        q->out.bytes[q->out.end] = byte;
        q->out.end = (uint16_t)((q->out.end + 1u) % SEND);
    }
    pump(u);
    unmask_interrupts(masked);
    return is_taken;
}

static uint16_t unsent(void *context, uint8_t port, uint32_t now_us)
{
    const uart *const u = uart_of(port);

    (void)context;
    (void)now_us;
    if (u == NULL) {
        return 0;
    }
    const uint32_t masked = mask_interrupts();
    pump(u);
    const uint32_t waiting = to_send(u->waiting) + (has_sent(u) ? 0u : 1u);
    unmask_interrupts(masked);
    return (uint16_t)waiting;
}

