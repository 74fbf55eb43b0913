/*
 * Runs PLCs of one program, PLC_LANES at once, as requests on standard input say. The argument is how many there are.
 *
 * A request is 16 bytes in the order of this machine: what is asked, a class of devices, how many devices, which PLC, number of the
 * first device, value. A scan is answered with one byte; a reading with eight bytes for each device: whether the program stores it,
 * and its value; what a PLC takes in bytes with eight bytes. Nothing else is answered. Answers are sent when a scan ends or F says so.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif
#include "NAME_access.h"
#include "NAME_lanes.h"

typedef struct request {
    uint8_t asks;
    uint8_t device;
    uint16_t count;
    uint32_t plc;
    uint32_t number;
    int32_t value;
} request;

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

static bool is_bit(unsigned device)
{
    return device <= (unsigned)PLC_CLASS_S;
}

static void scan(const request *asked)
{
    for (uint32_t block = 0; block < block_count; block++) {
        NAME_lanes_scan(&blocks[block], asked->number, (uint32_t)asked->value);
    }
    (void)putchar('.');
    (void)fflush(stdout);
}

static void read_devices(const request *asked)
{
    NAME_lanes *const all = &blocks[asked->plc / PLC_LANES];
    const unsigned lane = asked->plc % PLC_LANES;

    if (asked->device == (uint8_t)PLC_CLASS_T) {
        NAME_lanes_settle(all);
    }
    for (uint32_t n = 0; n < asked->count; n++) {
        const uint32_t number = asked->number + n;
        int32_t answer[2] = {0, 0};

        if (is_bit(asked->device)) {
            const plc_lanes *const bit = find_bit(all, asked->device, number);
            answer[0] = (bit != NULL) ? 1 : 0;
            answer[1] = ((bit != NULL) && plc_in_lane(*bit, lane)) ? 1 : 0;
        } else {
            /* Words, timers and counters are in the struct of the PLC. */
            answer[0] = NAME_read(&all->lane[lane], (plc_class)asked->device, number, &answer[1]) ? 1 : 0;
        }
        (void)fwrite(answer, sizeof answer, 1, stdout);
    }
}

static void write_device(const request *asked)
{
    NAME_lanes *const all = &blocks[asked->plc / PLC_LANES];
    const unsigned lane = asked->plc % PLC_LANES;
    const plc_class device = (plc_class)asked->device;

    if (is_bit(asked->device)) {
        plc_lanes *const bit = find_bit(all, asked->device, asked->number);
        if (bit != NULL) {
            plc_put_lane(bit, lane, asked->value != 0);
        }
    } else if ((device == PLC_CLASS_TS) || (device == PLC_CLASS_CS)) {
        /* Contacts are in lanes, too. */
        static NAME_plc plc;
        NAME_lanes_store(all, lane, &plc);
        (void)NAME_write(&plc, device, asked->number, asked->value);
        NAME_lanes_load(all, lane, &plc);
    } else {
        if (device == PLC_CLASS_T) {
            NAME_lanes_settle(all);
        }
        (void)NAME_write(&all->lane[lane], device, asked->number, asked->value);
    }
}

static void say_size(void)
{
    const uint64_t size = sizeof(NAME_lanes) / PLC_LANES;
    (void)fwrite(&size, sizeof size, 1, stdout);
    (void)fflush(stdout);
}

int main(int count, char **arguments)
{
    request asked;
    const uint32_t plcs = (count > 1) ? (uint32_t)strtoul(arguments[1], NULL, 10) : 1u;

#ifdef _WIN32
    (void)_setmode(_fileno(stdin), _O_BINARY);
    (void)_setmode(_fileno(stdout), _O_BINARY);
#endif
    block_count = (plcs + PLC_LANES - 1u) / PLC_LANES;
    blocks = calloc(block_count, sizeof *blocks);
    if (blocks == NULL) {
        (void)fprintf(stderr, "no memory for %lu PLCs\n", (unsigned long)plcs);
        return 1;
    }
    for (uint32_t block = 0; block < block_count; block++) {
        NAME_lanes_init(&blocks[block]);
    }
    while (fread(&asked, sizeof asked, 1, stdin) == 1) {
        const bool there = asked.plc < (block_count * PLC_LANES);

        if (asked.asks == (uint8_t)'S') {
            scan(&asked);
        } else if ((asked.asks == (uint8_t)'R') && there) {
            read_devices(&asked);
        } else if ((asked.asks == (uint8_t)'W') && there) {
            write_device(&asked);
        } else if (asked.asks == (uint8_t)'F') {
            (void)fflush(stdout);
        } else if (asked.asks == (uint8_t)'M') {
            say_size();
        } else {
            return 2;
        }
    }
    return 0;
}
