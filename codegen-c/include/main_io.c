/* Callbacks for connections. */
static void tell_edge(void *context, uint32_t number, bool on)
{
    /* EDGE */
}

static bool tell_output(void *context, uint32_t number)
{
    return PROGRAM_output(context, number);
}

static const rungc_terminal terminal = {&plc_memory, tell_edge, tell_output};

static void take_outside(PROGRAM_plc *plc)
{
    rungc_map map = PROGRAM_map(plc);
    rungc_outside_take(&map, &terminal);
}

static void give_outside(PROGRAM_plc *plc)
{
    rungc_map map = PROGRAM_map(plc);
    rungc_outside_give(&map, &terminal);
}

/* Starts the connections; false if that cannot be done. */
static bool begin_outside(PROGRAM_plc *plc)
{
    const rungc_map map = PROGRAM_map(plc);
    return rungc_outside_begin("PROGRAM", &map);
}

