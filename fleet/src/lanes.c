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

/* The PLC whose struct is filled in, and whether it was changed. */
static NAME_plc open_plc;
static uint32_t opened = UINT32_MAX;
static bool changed;

static void close_plc(void)
{
    if (changed) {
        NAME_lanes_load(&blocks[opened / PLC_LANES], opened % PLC_LANES, &open_plc);
    }
    changed = false;
    opened = UINT32_MAX;
}

static void open_one(uint32_t plc)
{
    if (plc != opened) {
        close_plc();
        NAME_lanes_store(&blocks[plc / PLC_LANES], plc % PLC_LANES, &open_plc);
        opened = plc;
    }
}

static void scan(const request *asked)
{
    close_plc();
    for (uint32_t block = 0; block < block_count; block++) {
        NAME_lanes_scan(&blocks[block], asked->number, (uint32_t)asked->value);
    }
    (void)putchar('.');
    (void)fflush(stdout);
}

static void read_devices(const request *asked)
{
    open_one(asked->plc);
    for (uint32_t n = 0; n < asked->count; n++) {
        int32_t answer[2] = {0, 0};
        answer[0] = NAME_read(&open_plc, (plc_class)asked->device, asked->number + n, &answer[1]) ? 1 : 0;
        (void)fwrite(answer, sizeof answer, 1, stdout);
    }
}

static void write_device(const request *asked)
{
    open_one(asked->plc);
    changed = NAME_write(&open_plc, (plc_class)asked->device, asked->number, asked->value) || changed;
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
