/*
 * rungc_system.c: what the scan itself keeps up to date in special registers: running time, analog inputs, ring counter, clock.
 */
#include "rungc_operands.h"

enum {
    D_RUN_TIME = RUNGC_D_RUN_TIME,
    D_ANALOG_INPUTS = 8030,
    D_ANALOG_ENABLE = 8114,
    D_SLOW_RING_COUNTER = 8398
};

/* ---- The running time in seconds, once a scan after the program ------------------------------------------------------------------- */

/* ---- Analog inputs and potentiometers, once a scan before the program ------------------------------------------------------------- */

/* Those that D8114 switches on. */
static rungc_fault analog_inputs(const rungc_call *call, const rungc_operand operands[])
{
    const int16_t enabled = rungc_register(call->map, D_ANALOG_ENABLE);

    (void)operands;
    for (int32_t channel = 0; channel < 8; channel++) {
        int16_t value = 0;

        if (plc_bit(enabled, (unsigned)channel) && (rungc_read_analog(call, channel, &value) == RUNGC_OK)) {
            rungc_set_register(call->map, (uint32_t)(D_ANALOG_INPUTS + channel), value);
        }
    }
    return RUNGC_OK;
}

static rungc_fault potentiometers(const rungc_call *call, const rungc_operand operands[])
{
    (void)operands;
    for (int32_t channel = 0; channel < 2; channel++) {
        int16_t value = 0;

        if (rungc_read_analog(call, channel, &value) == RUNGC_OK) {
            value = (value < 0) ? 0 : value;
            value = (value > 255) ? 255 : value;
            rungc_set_register(call->map, (uint32_t)(D_ANALOG_INPUTS + channel), value);
        }
    }
    return RUNGC_OK;
}

void rungc_analog_inputs(rungc_map *map, rungc_site site)
{
    rungc_run(map, site, NULL, analog_inputs);
}

void rungc_potentiometers(rungc_map *map, rungc_site site)
{
    rungc_run(map, site, NULL, potentiometers);
}

/* ---- D8398 and D8399 count milliseconds up to 2147483647 and from 0 again, once a scan before the program ------------------------- */
