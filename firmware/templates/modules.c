/* Special modules, whose channels are pins. */
static rungc_module modules[/* NUMBER */];
static const uint16_t units[/* NUMBER */] = {/* UNITS */};

static rungc_module *module_of(uint16_t unit)
{
    for (size_t i = 0; i < /* NUMBER */u; i++) {
        if (units[i] == unit) {
            return &modules[i];
        }
    }
    return NULL;
}

static bool read_bfm(void *context, uint16_t unit, uint16_t address, int16_t *value)
{
    rungc_module *module = module_of(unit);
    (void)context;
    return module != NULL && rungc_module_read(module, address, value);
}

static bool write_bfm(void *context, uint16_t unit, uint16_t address, int16_t value)
{
    rungc_module *module = module_of(unit);
    (void)context;
/* BOARD */    return module != NULL && rungc_module_write(module, address, value);
}

static void fit_modules(void)
{
/* FIT */
}

/* A count of a converter and the signal, in millionths of its unit, that it stands for. */
static inline int32_t signal_of(uint32_t count, int32_t full, int32_t low, int32_t high)
{
    return low + (int32_t)((int64_t)(high - low) * (int64_t)count / full);
}

static inline uint32_t count_of(int32_t signal, int32_t full, int32_t low, int32_t high)
{
    if (signal <= low) {
        return 0u;
    }
    if (signal >= high) {
        return (uint32_t)full;
    }
    return (uint32_t)(((int64_t)(signal - low) * full + (high - low) / 2) / (high - low));
}

/* Between scans: what the pins measure goes to the modules, what the modules put out to the pins. */
static void exchange_pins(void)
{
    static uint32_t before;
    uint32_t now = microseconds;
/* TAKE */
    for (size_t i = 0; i < /* NUMBER */u; i++) {
        rungc_module_pass(&modules[i], now - before);
    }
    before = now;
/* GIVE */
}

