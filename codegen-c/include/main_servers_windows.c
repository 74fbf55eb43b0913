/* Executables in C have no servers on Windows. */
static bool open_server(rungc_server_protocol protocol, const char *option, const char *name, const char *text)
{
    (void)protocol;
    print(stderr, "PROGRAM: %s %s: cannot serve %s: executables in C have no servers on Windows; those in Rust do (`--emit rust`)\n", option, text, name);
    return false;
}

static bool limit_connections(const char *text)
{
    (void)text;
    return true;
}

static void poll_servers(PROGRAM_plc *plc, uint32_t now_ms)
{
    (void)plc;
    (void)now_ms;
}

static void print_connections(void)
{
}
