/* PLC_LANES PLCs run at once. */
#include "NAME_lanes.h"

static NAME_lanes *blocks;
static uint32_t block_count;

/* Where the lanes of a bit are; NULL if the program does not store it. */
static plc_lanes *find_bit(NAME_lanes *all, unsigned device, uint32_t number)
{
    plc_lanes *found = NULL;

    switch (device) {
BITS
    default:
        break;
    }
    (void)all;
    (void)number;
    return found;
}

static bool switch_on(void)
{
    block_count = (plc_count + PLC_LANES - 1u) / PLC_LANES;
    blocks = calloc(block_count, sizeof *blocks);
    if (blocks == NULL) {
        return false;
    }
    for (uint32_t block = 0; block < block_count; block++) {
        NAME_lanes_init(&blocks[block]);
#ifdef PLC_ON_ERROR
        for (unsigned lane = 0; lane < PLC_LANES; lane++) {
            blocks[block].lane[lane].on_error = note_error;
        }
#endif
    }
    return true;
}

static void scan_all(uint32_t moment_ms, uint32_t scan_us)
{
    for (uint32_t block = 0; block < block_count; block++) {
        NAME_lanes_scan(&blocks[block], moment_ms, scan_us);
    }
}

/* Before devices of a PLC are read. */
static void prepare(uint32_t plc, unsigned device)
{
    if (device == (unsigned)PLC_CLASS_T) {
        NAME_lanes_settle(&blocks[plc / PLC_LANES]);
    }
}

static bool read_one(uint32_t plc, unsigned device, uint32_t number, int32_t *value)
{
    NAME_lanes *const all = &blocks[plc / PLC_LANES];
    const unsigned lane = plc % PLC_LANES;

    if (device <= (unsigned)PLC_CLASS_S) {
        const plc_lanes *const bit = find_bit(all, device, number);
        *value = ((bit != NULL) && plc_in_lane(*bit, lane)) ? 1 : 0;
        return bit != NULL;
    }
    /* Words, timers and counters are in the struct of the PLC. */
    return NAME_read(&all->lane[lane], (plc_class)device, number, value);
}

static void write_one(uint32_t plc, unsigned device, uint32_t number, int32_t value)
{
    NAME_lanes *const all = &blocks[plc / PLC_LANES];
    const unsigned lane = plc % PLC_LANES;

    if (device <= (unsigned)PLC_CLASS_S) {
        plc_lanes *const bit = find_bit(all, device, number);
        if (bit != NULL) {
            plc_put_lane(bit, lane, value != 0);
        }
    } else if ((device == (unsigned)PLC_CLASS_TS) || (device == (unsigned)PLC_CLASS_CS)) {
        /* Contacts are in lanes, too. */
        static NAME_plc single;
        NAME_lanes_store(all, lane, &single);
        (void)NAME_write(&single, (plc_class)device, number, value);
        NAME_lanes_load(all, lane, &single);
    } else {
        prepare(plc, device);
        (void)NAME_write(&all->lane[lane], (plc_class)device, number, value);
    }
}

/* They are always in RUN. */
static bool is_running(uint32_t plc)
{
    (void)plc;
    return true;
}

static void set_running(uint32_t plc, bool running)
{
    (void)plc;
    (void)running;
}

static uint64_t plc_size(void)
{
    return sizeof(NAME_lanes) / PLC_LANES;
}

#ifdef PLC_ON_ERROR
/* Which PLC a struct belongs to. */
static uint32_t number_of(const void *plc)
{
    const size_t offset = (size_t)((const unsigned char *)plc - (const unsigned char *)blocks);
    const size_t lane = ((offset % sizeof *blocks) - offsetof(NAME_lanes, lane)) / sizeof(NAME_plc);

    return (uint32_t)(((offset / sizeof *blocks) * PLC_LANES) + lane);
}

static plc_error error_of(uint32_t plc)
{
    return NAME_error(&blocks[plc / PLC_LANES].lane[plc % PLC_LANES]);
}
#endif
