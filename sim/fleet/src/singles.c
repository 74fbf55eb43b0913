/* PLCs run one after the other. */
static NAME_plc *plcs;

static bool switch_on(void)
{
    plcs = calloc(plc_count, sizeof *plcs);
    if (plcs == NULL) {
        return false;
    }
    for (uint32_t plc = 0; plc < plc_count; plc++) {
        NAME_init(&plcs[plc]);
#ifdef PLC_ON_ERROR
        plcs[plc].on_error = note_error;
#endif
    }
    return true;
}

static void scan_all(uint32_t moment_ms, uint32_t scan_us)
{
    for (uint32_t plc = 0; plc < plc_count; plc++) {
        NAME_scan(&plcs[plc], moment_ms, scan_us);
    }
}

/* Before devices of a PLC are read: they are there. */
static void prepare(uint32_t plc, unsigned device)
{
    (void)plc;
    (void)device;
}

static bool read_one(uint32_t plc, unsigned device, uint32_t number, int32_t *value)
{
    return NAME_read(&plcs[plc], (plc_class)device, number, value);
}

static void write_one(uint32_t plc, unsigned device, uint32_t number, int32_t value)
{
    (void)NAME_write(&plcs[plc], (plc_class)device, number, value);
}

static bool is_running(uint32_t plc)
{
    return NAME_running(&plcs[plc]);
}

static void set_running(uint32_t plc, bool running)
{
    NAME_set_running(&plcs[plc], running);
}

static uint64_t plc_size(void)
{
    return sizeof *plcs;
}

#ifdef PLC_ON_ERROR
/* Which PLC a struct is. */
static uint32_t number_of(const void *plc)
{
    return (uint32_t)((const NAME_plc *)plc - plcs);
}

static plc_error error_of(uint32_t plc)
{
    return NAME_error(&plcs[plc]);
}
#endif
