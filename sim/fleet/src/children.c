/*
 * Runs PLCs of one program as requests on standard input say. The argument is how many there are.
 *
 * A request is 16 bytes in the order of this machine: what is asked, a class of devices, how many devices, which PLC, number of the
 * first device, value. A scan is answered with one byte; a reading with eight bytes for each device: whether the program stores it,
 * and its value; what a PLC takes in bytes with eight bytes; what has gone wrong with how many records there are, in four bytes, and
 * these. Nothing else is answered. Answers are sent when a scan ends or F says so.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif
#include "NAME_access.h"

typedef struct request {
    uint8_t asks;
    uint8_t device;
    uint16_t count;
    uint32_t plc;
    uint32_t number;
    int32_t value;
} request;

/* What has gone wrong in a PLC at an instruction. */
typedef struct record {
    uint64_t times;
    uint32_t plc;
    uint32_t first_ms;
    uint16_t code;
    uint16_t step;
    uint32_t stopped; /* 1: it stopped the PLC, at a time that nobody noted */
} record;

/* An error at an instruction, and how often each PLC has had it. */
typedef struct site {
    uint16_t code;
    uint16_t step;
    uint64_t *times;
    uint32_t *first_ms;
} site;

/* Stands for whether a PLC is in RUN, as device 0 of a class. */
#define RUNNING ((unsigned)PLC_CLASS_CS + 1u)

static uint32_t plc_count;

/* When the scan began. */
static uint32_t now_ms;

#ifdef PLC_ON_ERROR
static void note_error(const void *plc, uint16_t code, uint16_t step);
#endif

ENGINE
static void give_up(void)
{
    (void)fprintf(stderr, "no memory for %lu PLCs\n", (unsigned long)plc_count);
    exit(1);
}

#ifdef PLC_ON_ERROR
static site *sites;
static uint32_t site_count;

/* The place of an error in the table, which grows by it. */
static site *find_site(uint16_t code, uint16_t step)
{
    for (uint32_t i = 0; i < site_count; i++) {
        if ((sites[i].code == code) && (sites[i].step == step)) {
            return &sites[i];
        }
    }
    site *const more = realloc(sites, (site_count + 1u) * sizeof *sites);
    if (more == NULL) {
        give_up();
    }
    sites = more;
    site *const added = &sites[site_count];
    site_count++;
    added->code = code;
    added->step = step;
    added->times = calloc(plc_count, sizeof *added->times);
    added->first_ms = calloc(plc_count, sizeof *added->first_ms);
    if ((added->times == NULL) || (added->first_ms == NULL)) {
        give_up();
    }
    return added;
}

static void note_error(const void *plc, uint16_t code, uint16_t step)
{
    const uint32_t number = number_of(plc);

    /* The last of those that run at once may be more than there are PLCs. */
    if (number < plc_count) {
        site *const met = find_site(code, step);
        if (met->times[number] == 0u) {
            met->first_ms[number] = now_ms;
        }
        met->times[number]++;
    }
}

/* Calls with each record that is there; without a function counts them only. */
static uint32_t each_record(void (*use)(const record *))
{
    uint32_t count = 0;

    for (uint32_t i = 0; i < site_count; i++) {
        for (uint32_t plc = 0; plc < plc_count; plc++) {
            if (sites[i].times[plc] > 0u) {
                const record found = {sites[i].times[plc], plc, sites[i].first_ms[plc], sites[i].code, sites[i].step, 0u};
                count++;
                if (use != NULL) {
                    use(&found);
                }
            }
        }
    }
    for (uint32_t plc = 0; plc < plc_count; plc++) {
        const plc_error error = error_of(plc);
        if (error.stop == (uint16_t)PLC_STOP_WATCHDOG) {
            const record found = {1u, plc, 0u, error.stop, error.stop_step, 1u};
            count++;
            if (use != NULL) {
                use(&found);
            }
        }
    }
    return count;
}

static void write_record(const record *found)
{
    (void)fwrite(found, sizeof *found, 1, stdout);
}
#endif

static void say_errors(void)
{
    uint32_t count = 0;

#ifdef PLC_ON_ERROR
    count = each_record(NULL);
#endif
    (void)fwrite(&count, sizeof count, 1, stdout);
#ifdef PLC_ON_ERROR
    (void)each_record(write_record);
#endif
    (void)fflush(stdout);
}

static void scan(const request *asked)
{
    now_ms = asked->number;
    scan_all(asked->number, (uint32_t)asked->value);
    (void)putchar('.');
    (void)fflush(stdout);
}

static void read_devices(const request *asked)
{
    prepare(asked->plc, asked->device);
    for (uint32_t n = 0; n < asked->count; n++) {
        const uint32_t number = asked->number + n;
        int32_t answer[2] = {0, 0};

        if (asked->device == RUNNING) {
            answer[0] = (number == 0u) ? 1 : 0;
            answer[1] = is_running(asked->plc) ? 1 : 0;
        } else {
            answer[0] = read_one(asked->plc, asked->device, number, &answer[1]) ? 1 : 0;
        }
        (void)fwrite(answer, sizeof answer, 1, stdout);
    }
}

static void say_size(void)
{
    const uint64_t size = plc_size();
    (void)fwrite(&size, sizeof size, 1, stdout);
    (void)fflush(stdout);
}

int main(int count, char **arguments)
{
    request asked;

    plc_count = (count > 1) ? (uint32_t)strtoul(arguments[1], NULL, 10) : 1u;
#ifdef _WIN32
    (void)_setmode(_fileno(stdin), _O_BINARY);
    (void)_setmode(_fileno(stdout), _O_BINARY);
#endif
    if (!switch_on()) {
        give_up();
    }
    while (fread(&asked, sizeof asked, 1, stdin) == 1) {
        const bool there = asked.plc < plc_count;

        if (asked.asks == (uint8_t)'S') {
            scan(&asked);
        } else if ((asked.asks == (uint8_t)'R') && there) {
            read_devices(&asked);
        } else if ((asked.asks == (uint8_t)'W') && there) {
            write_one(asked.plc, asked.device, asked.number, asked.value);
        } else if ((asked.asks == (uint8_t)'T') && there) {
            set_running(asked.plc, asked.value != 0);
        } else if (asked.asks == (uint8_t)'F') {
            (void)fflush(stdout);
        } else if (asked.asks == (uint8_t)'M') {
            say_size();
        } else if (asked.asks == (uint8_t)'E') {
            say_errors();
        } else {
            return 2;
        }
    }
    return 0;
}
