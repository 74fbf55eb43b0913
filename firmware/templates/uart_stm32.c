/* Registers of a USART: /* KIND */. */
enum { /* REGISTERS */ };

static bool has_room(const uart *u)
{
    return (REGISTER(u->at + STATE) & 1u << 7) != 0u; /* TXE */
}

static bool has_sent(const uart *u)
{
    return (REGISTER(u->at + STATE) & 1u << 6) != 0u; /* TC */
}

/* The interrupt comes when there is room, or when the last bit is out. */
static void expect(const uart *u, bool room, bool end)
{
    const uint32_t control = REGISTER(u->at + CONTROL_1) & ~(3u << 6);

    REGISTER(u->at + CONTROL_1) = control | (room ? 1u << 7 : 0u) | (end ? 1u << 6 : 0u); /* TXEIE, TCIE */
}

static bool next_character(const uart *u, uint8_t *byte, rungc_char_fault *fault)
{
    const uint32_t state = REGISTER(u->at + STATE);

    if ((state & (1u << 5 | 1u << 3)) == 0u) { /* RXNE, ORE */
        return false;
    }
    *byte = (uint8_t)REGISTER(u->at + IN);
/* CLEAR */    if ((state & 1u << 3) != 0u) {
        *fault = RUNGC_CHAR_FAULT_OVERRUN;
    } else if ((state & 1u << 1) != 0u) {
        *fault = *byte == 0u ? RUNGC_CHAR_FAULT_BREAK : RUNGC_CHAR_FAULT_FRAMING;
    } else {
        *fault = (state & 1u) != 0u ? RUNGC_CHAR_FAULT_PARITY : RUNGC_CHAR_FAULT_NONE;
    }
    return true;
}

static void set_format(const uart *u, const rungc_line_format *format)
{
    uint32_t control = 1u << ENABLE | 1u << 5 | 1u << 3 | 1u << 2; /* RXNEIE, TE, RE */

    if (format->parity != RUNGC_PARITY_NONE) {
        control |= 1u << 10 | (format->parity == RUNGC_PARITY_ODD ? 1u << 9 : 0u); /* PCE, PS */
        control |= format->data_bits == 8u ? 1u << 12 : 0u;                        /* M: the ninth bit is parity */
    }
    REGISTER(u->at + CONTROL_1) = 0;
    REGISTER(u->at + CONTROL_2) = format->stop_bits == 2u ? 2u << 12 : 0u;
    REGISTER(u->at + RATE) = (u->clock_hz + format->bits_per_second / 2u) / format->bits_per_second;
    REGISTER(u->at + CONTROL_1) = control;
}

