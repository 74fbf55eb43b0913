/*
 * rungc_access.h: devices by class and number, or by name, for operator panels, protocols and tests. NAME_access.h of each program has
 * the functions to call; this is what they share.
 */
#ifndef RUNGC_ACCESS_H
#define RUNGC_ACCESS_H

#include "rungc.h"

/* Classes of devices. TS and CS are the contacts of timers and counters, T and C their current values. */
typedef enum plc_class {
    PLC_CLASS_X,
    PLC_CLASS_Y,
    PLC_CLASS_M,
    PLC_CLASS_S,
    PLC_CLASS_T,
    PLC_CLASS_C,
    PLC_CLASS_D,
    PLC_CLASS_R,
    PLC_CLASS_V,
    PLC_CLASS_Z,
    PLC_CLASS_ER,
    PLC_CLASS_TS,
    PLC_CLASS_CS
} plc_class;

/* Type of an area's devices. */
enum {
    PLC_AREA_BITS,
    PLC_AREA_WORDS,
    PLC_AREA_TIMERS,
    PLC_AREA_COUNTERS16,
    PLC_AREA_COUNTERS32
};

/* Devices that are side by side in a program's struct. */
typedef struct plc_area {
    uint8_t device;   /* their plc_class */
    uint8_t kind;     /* type of each: PLC_AREA_... */
    uint16_t first;   /* first number */
    uint16_t count;   /* number of devices */
    uint16_t columns; /* numbers from a device to the next one in memory */
    uint16_t stored;  /* number of stored columns: the first ones */
    uint32_t offset;  /* offset in the struct, in bytes */
} plc_area;

/* The area that holds a device; NULL if none does. */
static inline const plc_area *plc_find_area(const plc_area *areas, size_t count, plc_class device, uint32_t number)
{
    const plc_area *found = NULL;

    for (size_t i = 0; (i < count) && (found == NULL); i++) {
        if ((areas[i].device == (uint8_t)device) && (number >= areas[i].first)) {
            const uint32_t n = number - areas[i].first;

            if ((n < areas[i].count) && ((n % areas[i].columns) < areas[i].stored)) {
                found = &areas[i];
            }
        }
    }
    return found;
}

/* Offset of a device of an area in the struct, in bytes. */
static inline size_t plc_device_offset(const plc_area *area, uint32_t number)
{
    static const size_t sizes[] = {sizeof(bool), sizeof(int16_t), sizeof(plc_timer), sizeof(plc_counter16), sizeof(plc_counter32)};
    const uint32_t n = number - area->first;
    const uint32_t rows = ((uint32_t)area->count + area->columns - 1u) / area->columns;
    const uint32_t place = ((n % area->columns) * rows) + (n / area->columns);

    return area->offset + ((size_t)place * sizes[area->kind]);
}

/* T and C of TS and CS, whose contacts they are. */
static inline plc_class plc_holder(plc_class device)
{
    plc_class holder = device;

    if (device == PLC_CLASS_TS) {
        holder = PLC_CLASS_T;
    } else if (device == PLC_CLASS_CS) {
        holder = PLC_CLASS_C;
    } else {
        /* It is its own. */
    }
    return holder;
}

/* Reads a device of the program whose struct these bytes are: 0 or 1 of a bit, else a signed value. False if the program does not
   store it, and then `value` stays. */
static inline bool plc_read_device(const plc_area *areas, size_t count, const unsigned char *bytes, plc_class device, uint32_t number,
                                   int32_t *value)
{
    const plc_class holder = plc_holder(device);
    const plc_area *const area = plc_find_area(areas, count, holder, number);
    const bool contact = holder != device;

    if (area != NULL) {
        const unsigned char *const at = &bytes[plc_device_offset(area, number)];
        plc_timer timer;
        plc_counter16 counter16;
        plc_counter32 counter32;
        int16_t word;

        switch (area->kind) {
        case PLC_AREA_WORDS:
            (void)memcpy(&word, at, sizeof word);
            *value = word;
            break;
        case PLC_AREA_TIMERS:
            (void)memcpy(&timer, at, sizeof timer);
            *value = contact ? (int32_t)timer.done : (int32_t)timer.value;
            break;
        case PLC_AREA_COUNTERS16:
            (void)memcpy(&counter16, at, sizeof counter16);
            *value = contact ? (int32_t)counter16.done : (int32_t)counter16.value;
            break;
        case PLC_AREA_COUNTERS32:
            (void)memcpy(&counter32, at, sizeof counter32);
            *value = contact ? (int32_t)counter32.done : counter32.value;
            break;
        default:
            *value = (at[0] != 0u) ? 1 : 0;
            break;
        }
    }
    return area != NULL;
}

/* Writes a device: a bit is on unless the value is 0. False, and nothing is written, if the program does not store it or its 16 bits
   do not hold the value. */
static inline bool plc_write_device(const plc_area *areas, size_t count, unsigned char *bytes, plc_class device, uint32_t number,
                                    int32_t value)
{
    const plc_class holder = plc_holder(device);
    const plc_area *const area = plc_find_area(areas, count, holder, number);
    const bool contact = holder != device;
    bool written = area != NULL;

    if (written) {
        const bool is_word = (area->kind != (uint8_t)PLC_AREA_BITS) && (area->kind != (uint8_t)PLC_AREA_COUNTERS32) && !contact;

        written = !is_word || ((value >= INT16_MIN) && (value <= INT16_MAX));
    }
    if (written) {
        unsigned char *const at = &bytes[plc_device_offset(area, number)];
        plc_timer timer;
        plc_counter16 counter16;
        plc_counter32 counter32;
        const int16_t word = (int16_t)value;
        const bool on = value != 0;

        switch (area->kind) {
        case PLC_AREA_WORDS:
            (void)memcpy(at, &word, sizeof word);
            break;
        case PLC_AREA_TIMERS:
            (void)memcpy(&timer, at, sizeof timer);
            timer.done = contact ? on : timer.done;
            timer.value = contact ? timer.value : word;
            (void)memcpy(at, &timer, sizeof timer);
            break;
        case PLC_AREA_COUNTERS16:
            (void)memcpy(&counter16, at, sizeof counter16);
            counter16.done = contact ? on : counter16.done;
            counter16.value = contact ? counter16.value : word;
            (void)memcpy(at, &counter16, sizeof counter16);
            break;
        case PLC_AREA_COUNTERS32:
            (void)memcpy(&counter32, at, sizeof counter32);
            counter32.done = contact ? on : counter32.done;
            counter32.value = contact ? counter32.value : value;
            (void)memcpy(at, &counter32, sizeof counter32);
            break;
        default:
            at[0] = on ? 1u : 0u;
            break;
        }
    }
    return written;
}

/* Reads a name as it is in the PLC: D100, X012 (in octal), TS0. False if it is not a device's, and then nothing is assigned. */
static inline bool plc_parse_device(const char *name, plc_class *device, uint32_t *number)
{
    static const char letters[][3] = {"X", "Y", "M", "S", "T", "C", "D", "R", "V", "Z", "ER", "TS", "CS"};
    static const size_t classes = sizeof letters / sizeof letters[0];
    size_t found = classes;
    size_t at = 0;
    uint32_t sum = 0;

    for (size_t i = 0; (i < classes) && (found == classes); i++) {
        at = strlen(letters[i]);
        if ((strncmp(name, letters[i], at) == 0) && (name[at] >= '0') && (name[at] <= '9')) {
            found = i;
        }
    }
    if (found < classes) {
        const char last = (found <= (size_t)PLC_CLASS_Y) ? '7' : '9';
        const uint32_t base = (found <= (size_t)PLC_CLASS_Y) ? 8u : 10u;

        while ((name[at] >= '0') && (name[at] <= last) && (sum <= UINT16_MAX)) {
            sum = (sum * base) + ((uint32_t)name[at] - (uint32_t)'0');
            at++;
        }
        if ((name[at] != '\0') || (sum > UINT16_MAX)) {
            found = classes;
        }
    }
    if (found < classes) {
        *device = (plc_class)found;
        *number = sum;
    }
    return found < classes;
}

#endif
