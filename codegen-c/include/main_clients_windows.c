/* Nor are they clients of servers. */
static void begin_clients(void)
{
    print(stderr, "PROGRAM: the program sends requests to servers over TCP, and executables in C do not on Windows; those in Rust do (`--emit rust`)\n");
    exit(2);
}

static void poll_clients(PROGRAM_plc *plc, uint32_t now_us)
{
    (void)plc;
    (void)now_us;
}

static void print_clients(void)
{
}
