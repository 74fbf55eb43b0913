/*
 * rungc_devices.h: the devices of a program by number, and the errors of its instructions.
 *
 * Private to the rungc_*.c files; programs and hosts include rungc_rt.h. C99, no recursion, no heap. A function that may fail returns
 * the PLC's code of the error, RUNGC_OK if there is none, and in that case alone the value behind its pointer is set.
 */
#ifndef RUNGC_DEVICES_H
#define RUNGC_DEVICES_H

#include "rungc_rt.h"

/* The PLC's code of an operation error. */
typedef uint16_t rungc_fault;

enum {
    RUNGC_OK = 0,
    RUNGC_NO_ANSWER = 6381,  /* a remote module has not answered in time */
    RUNGC_NO_DEVICE = 6706,  /* a device lies outside the model's range */
    RUNGC_BAD_VALUE = 6707,  /* a value lies outside what the instruction takes; shown as the layout's `value_error` */
    RUNGC_NO_MODULE = 6709   /* a module is not there; shown as 6750 or 6708 */
};

/* Numbers from which registers and relays are special, and counters have 32 bits. */
enum { RUNGC_FIRST_SPECIAL = 8000, RUNGC_FIRST_COUNTER32 = 200 };

/* Special relays and registers. */
enum {
    RUNGC_M_ANY_ERROR = 8004,
    RUNGC_D_ANY_ERROR = 8004,
    RUNGC_M_COMPLETE = 8029,
    RUNGC_M_OPERATION_ERROR = 8067,
    RUNGC_M_FIRST_ERROR = 8068,
    RUNGC_D_FIRST_ERROR_STEP = 8068,
    RUNGC_D_ERROR_STEP = 8069,
    RUNGC_D_LOGGED_HOURS = 8490,
    RUNGC_D_LOGGED_CODES = 8500,
    RUNGC_D_RUN_TIME = 8510
};

/* An instruction at work: the program that it belongs to, and its place there. */
typedef struct rungc_call {
    rungc_map *map;
    rungc_site site;
} rungc_call;

static inline rungc_call rungc_call_at(rungc_map *map, rungc_site site)
{
    rungc_call call;
    call.map = map;
    call.site = site;
    return call;
}

/* Ends an instruction: shows its error. One that is not driven only ends what it did and has none, whatever its operands are. */
void rungc_conclude(const rungc_call *call, rungc_fault fault);

/* ---- Devices by number ------------------------------------------------------------------------------------------------------------ */

/* The word of a device; NULL in `word` if the program does not look at it. `area` is where it perhaps is (rungc_operand). False if the
   model has no such device. */
bool rungc_find_word(const rungc_map *map, uint8_t area, rungc_class device_class, uint32_t number, int16_t **word);

/* The state of a device, likewise. */
bool rungc_find_bit(const rungc_map *map, uint8_t area, rungc_class device_class, uint32_t number, bool **bit);

/* The value of a counter of 32 bits, likewise. */
bool rungc_find_counter32(const rungc_map *map, uint32_t number, int32_t **value);

/* RST of a timer or a counter; false if the model has no such device. */
bool rungc_reset_device(const rungc_map *map, rungc_class device_class, uint32_t number);

/* The part of the program's struct at an offset, of the type that the layout says. */
static inline void *rungc_part_at(const rungc_map *map, size_t offset)
{
    uint8_t *const plc = map->plc;

    return plc + offset;
}

/* Time and mode. */
const plc_sys *rungc_sys(const rungc_map *map);

/* The eight words that an instruction keeps from one scan to the next. */
int32_t *rungc_kept(const rungc_call *call);

/* A special relay; one that the program does not look at is off. Number 0 is a relay that the model does not have. */
bool rungc_relay(const rungc_map *map, uint16_t number);
void rungc_set_relay(const rungc_map *map, uint16_t number, bool on);

/* A register, and a pair of registers; one that the program does not look at is 0. */
int16_t rungc_register(const rungc_map *map, uint32_t number);
void rungc_set_register(const rungc_map *map, uint32_t number, int16_t value);
int32_t rungc_long_register(const rungc_map *map, uint32_t low);
void rungc_set_long_register(const rungc_map *map, uint32_t low, int32_t value);

#endif
