/* Executables in C have no serial lines on Windows: nothing is received, and what is sent is lost. */
static void set_line(void *context, uint8_t port, const rungc_line_format *format)
{
    (void)context;
    (void)port;
    (void)format;
}

static bool receive(void *context, uint8_t port, uint32_t now_us, rungc_received *received)
{
    (void)context;
    (void)port;
    (void)now_us;
    (void)received;
    return false;
}

static bool send_character(void *context, uint8_t port, uint8_t byte, uint32_t now_us)
{
    (void)context;
    (void)port;
    (void)byte;
    (void)now_us;
    return true;
}

static uint16_t unsent(void *context, uint8_t port, uint32_t now_us)
{
    (void)context;
    (void)port;
    (void)now_us;
    return 0;
}

static bool connect_line(uint8_t port, const char *path)
{
    (void)port;
    print(stderr, "PROGRAM: %s: executables in C have no serial lines on Windows; `rungc run` has\n", path);
    return false;
}

static bool open_line(const char *what)
{
    return connect_line(0, what);
}

static void advance_lines(PROGRAM_plc *plc, uint32_t now_ms)
{
    PROGRAM_tick(plc, now_ms);
}
