/* Registers of a CMSDK UART. */
enum { OUT = 0x00, IN = 0x00, STATE = 0x04, CONTROL = 0x08, INTERRUPTS = 0x0C, RATE = 0x10 };

static bool has_room(const uart *u)
{
    return (REGISTER(u->at + STATE) & 1u) == 0u;
}

static bool has_sent(const uart *u)
{
    return has_room(u);
}

/* The interrupt comes whenever there is room again. */
static void expect(const uart *u, bool room, bool end)
{
    (void)u;
    (void)room;
    (void)end;
}

static bool next_character(const uart *u, uint8_t *byte, rungc_char_fault *fault)
{
    REGISTER(u->at + INTERRUPTS) = 3; /* those of both directions are seen to */
    const uint32_t state = REGISTER(u->at + STATE);
    if ((state & 1u << 1) == 0u) {
        return false;
    }
    *byte = (uint8_t)REGISTER(u->at + IN);
    *fault = (state & 1u << 3) != 0u ? RUNGC_CHAR_FAULT_OVERRUN : RUNGC_CHAR_FAULT_NONE;
    REGISTER(u->at + STATE) = 1u << 3;
    return true;
}

static void set_format(const uart *u, const rungc_line_format *format)
{
    REGISTER(u->at + CONTROL) = 0;
    REGISTER(u->at + RATE) = u->clock_hz / format->bits_per_second;
    REGISTER(u->at + CONTROL) = 0xF; /* both directions, with their interrupts */
}

