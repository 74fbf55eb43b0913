/* Callbacks for connections. */
static void on_input_edge(void *context, uint32_t number, bool on)
{
    /* EDGE */
}

static bool read_output(void *context, uint32_t number)
{
    return PROGRAM_output(context, number);
}

static const rungc_terminal terminal = {&plc_memory, on_input_edge, read_output};

static void io_read_inputs(PROGRAM_plc *plc)
{
    rungc_map map = PROGRAM_map(plc);
    rungc_io_read_inputs(&map, &terminal);
}

static void io_write_outputs(PROGRAM_plc *plc)
{
    rungc_map map = PROGRAM_map(plc);
    rungc_io_write_outputs(&map, &terminal);
}

/* Starts the connections; false if that cannot be done. */
static bool io_begin(PROGRAM_plc *plc)
{
    const rungc_map map = PROGRAM_map(plc);
    return rungc_io_begin("PROGRAM", &map);
}

