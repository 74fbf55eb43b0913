/*
 * Sweeps of a search: PLC_LANES runs of one program, which continue from one moment with different inputs.
 *
 * A request is the number of 32-bit words that follow, then two lists of steps: the run to that moment, from power-on, and the sweep. A
 * list is its length and the steps: scans, milliseconds of each scan, how many inputs change before the first, and of each its lane
 * (none in the run to the moment), its number and its value. The number UINT32_MAX: power goes off and comes back.
 *
 * Each scan of the sweep is answered: how many bits and how many words have changed, the bits (item, lanes that have changed: those
 * below 32 and the others, lanes now), the words (item, lane, value).
 */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif
#include "NAME_lanes.h"

static NAME_plc one;
static NAME_lanes all;

/* A bit that the program does not store. */
static plc_lanes nothing;

/* Where a word is in the struct of a PLC, and whether it has 32 bits. */
typedef struct word {
    size_t at;
    bool wide;
} word;

/* An input: its lanes, if it is a bit, and where it is in the struct of a PLC. */
typedef struct input {
    plc_lanes *lanes;
    size_t at;
} input;

static plc_lanes *const bits[] = {
BITS    NULL};
static const word words[] = {
WORDS    {0, false}};
static const input inputs[] = {
INPUTS    {NULL, 0}};

#define BIT_COUNT ((sizeof bits / sizeof bits[0]) - 1u)
#define WORD_COUNT ((sizeof words / sizeof words[0]) - 1u)
#define INPUT_COUNT ((sizeof inputs / sizeof inputs[0]) - 1u)

/* What they were after the last scan. */
static plc_lanes last_bits[BIT_COUNT + 1u];
static int32_t last_words[WORD_COUNT + 1u][PLC_LANES];

/* An answer. */
static uint32_t answer[2u + (5u * BIT_COUNT) + (3u * WORD_COUNT * PLC_LANES)];

static int32_t read_word(const word *asked, unsigned lane)
{
    const unsigned char *const from = (const unsigned char *)&all.lane[lane] + asked->at;

    if (asked->wide) {
        int32_t value;
        (void)memcpy(&value, from, sizeof value);
        return value;
    }
    int16_t value;
    (void)memcpy(&value, from, sizeof value);
    return value;
}

static void write_word(NAME_plc *plc, size_t at, int32_t value)
{
    const int16_t word = (int16_t)value;
    (void)memcpy((unsigned char *)plc + at, &word, sizeof word);
}

static void set_one(uint32_t number, int32_t value)
{
    const input *const set = &inputs[number];

    if (set->lanes != NULL) {
        ((unsigned char *)&one)[set->at] = (value != 0) ? 1u : 0u;
    } else {
        write_word(&one, set->at, value);
    }
}

static void set_lane(uint32_t lane, uint32_t number, int32_t value)
{
    const input *const set = &inputs[number];

    if (set->lanes != NULL) {
        plc_put_lane(set->lanes, lane, value != 0);
    } else {
        write_word(&all.lane[lane], set->at, value);
    }
}

/* All instances as the one. */
static void spread(void)
{
    NAME_lanes_init(&all);
    all.sys = one.sys;
    for (unsigned lane = 0; lane < PLC_LANES; lane++) {
        NAME_lanes_load(&all, lane, &one);
    }
}

/* Answers what has changed since the last time. */
static void look(bool answered)
{
    uint32_t *out = &answer[2];

    NAME_lanes_settle(&all);
    answer[0] = 0;
    answer[1] = 0;
    for (uint32_t i = 0; i < BIT_COUNT; i++) {
        const plc_lanes changed = *bits[i] ^ last_bits[i];
        if (changed != 0u) {
            last_bits[i] = *bits[i];
            *out++ = i;
            *out++ = (uint32_t)changed;
            *out++ = (uint32_t)(changed >> 32);
            *out++ = (uint32_t)*bits[i];
            *out++ = (uint32_t)(*bits[i] >> 32);
            answer[0]++;
        }
    }
    for (uint32_t i = 0; i < WORD_COUNT; i++) {
        for (unsigned lane = 0; lane < PLC_LANES; lane++) {
            const int32_t value = read_word(&words[i], lane);
            if (value != last_words[i][lane]) {
                last_words[i][lane] = value;
                *out++ = i;
                *out++ = lane;
                *out++ = (uint32_t)value;
                answer[1]++;
            }
        }
    }
    if (answered) {
        (void)fwrite(answer, sizeof answer[0], (size_t)(out - answer), stdout);
    }
}

static void sweep(const uint32_t *asked)
{
    uint32_t now = 0;

    NAME_init(&one);
    for (uint32_t steps = *asked++; steps > 0u; steps--) {
        const uint32_t scans = *asked++;
        const uint32_t ms = *asked++;
        for (uint32_t changes = *asked++; changes > 0u; changes--) {
            if (asked[0] == UINT32_MAX) {
                NAME_power_cycle(&one);
                now = 0;
            } else {
                set_one(asked[0], (int32_t)asked[1]);
            }
            asked += 2;
        }
        for (uint32_t scan = 0; scan < scans; scan++) {
            NAME_scan(&one, now, ms * 1000u);
            now += ms;
        }
    }
    spread();
    look(false);
    for (uint32_t steps = *asked++; steps > 0u; steps--) {
        const uint32_t scans = *asked++;
        const uint32_t ms = *asked++;
        for (uint32_t changes = *asked++; changes > 0u; changes--) {
            set_lane(asked[0], asked[1], (int32_t)asked[2]);
            asked += 3;
        }
        for (uint32_t scan = 0; scan < scans; scan++) {
            NAME_lanes_scan(&all, now, ms * 1000u);
            now += ms;
            look(true);
        }
    }
    (void)fflush(stdout);
}

int main(void)
{
    uint32_t length;

    (void)nothing;
#ifdef _WIN32
    (void)_setmode(_fileno(stdin), _O_BINARY);
    (void)_setmode(_fileno(stdout), _O_BINARY);
#endif
    while (fread(&length, sizeof length, 1, stdin) == 1) {
        uint32_t *const asked = malloc((size_t)length * sizeof *asked);
        if (asked == NULL) {
            (void)fputs("no memory for a sweep\n", stderr);
            return 1;
        }
        if (fread(asked, sizeof *asked, length, stdin) != length) {
            return 2;
        }
        sweep(asked);
        free(asked);
    }
    return 0;
}
