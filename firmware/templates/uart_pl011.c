/* Registers of a PL011, without its queues. */
enum { OUT = 0x00, IN = 0x00, FAULTS = 0x04, STATE = 0x18, RATE = 0x24, FRACTION = 0x28, FORMAT = 0x2C, CONTROL = 0x30, MASK = 0x38 };

static bool has_room(const uart *u)
{
    return (REGISTER(u->at + STATE) & 1u << 5) == 0u; /* TXFF */
}

static bool has_sent(const uart *u)
{
    return (REGISTER(u->at + STATE) & 1u << 3) == 0u; /* BUSY */
}

/* The interrupt comes when there is room; none signals the end of the last bit: the tick checks it. */
static void expect(const uart *u, bool room, bool end)
{
    (void)end;
    REGISTER(u->at + MASK) = 1u << 4 | (room ? 1u << 5 : 0u); /* RXIM, TXIM */
}

static bool next_character(const uart *u, uint8_t *byte, rungc_char_fault *fault)
{
    if ((REGISTER(u->at + STATE) & 1u << 4) != 0u) { /* RXFE */
        return false;
    }
    const uint32_t data = REGISTER(u->at + IN);
    *byte = (uint8_t)data;
    REGISTER(u->at + FAULTS) = 0;
    if ((data & 1u << 11) != 0u) {
        *fault = RUNGC_CHAR_FAULT_OVERRUN;
    } else if ((data & 1u << 10) != 0u) {
        *fault = RUNGC_CHAR_FAULT_BREAK;
    } else if ((data & 1u << 8) != 0u) {
        *fault = RUNGC_CHAR_FAULT_FRAMING;
    } else {
        *fault = (data & 1u << 9) != 0u ? RUNGC_CHAR_FAULT_PARITY : RUNGC_CHAR_FAULT_NONE;
    }
    return true;
}

static void set_format(const uart *u, const rungc_line_format *format)
{
    const uint32_t rate = format->bits_per_second;
    const uint32_t divisor = (uint32_t)(((uint64_t)u->clock_hz * 4u + rate / 2u) / rate); /* in 64ths */
    uint32_t line = format->data_bits == 7u ? 2u << 5 : 3u << 5;                          /* WLEN */

    if (format->parity != RUNGC_PARITY_NONE) {
        line |= 1u << 1 | (format->parity == RUNGC_PARITY_EVEN ? 1u << 2 : 0u); /* PEN, EPS */
    }
    line |= format->stop_bits == 2u ? 1u << 3 : 0u; /* STP2 */
    REGISTER(u->at + CONTROL) = 0;
    REGISTER(u->at + RATE) = divisor >> 6;
    REGISTER(u->at + FRACTION) = divisor & 0x3Fu;
    REGISTER(u->at + FORMAT) = line;
    REGISTER(u->at + MASK) = 1u << 4;                    /* RXIM */
    REGISTER(u->at + CONTROL) = 1u << 9 | 1u << 8 | 1u; /* RXE, TXE, UARTEN */
}

