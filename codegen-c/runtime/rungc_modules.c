/*
 * rungc_modules.c: special modules: FROM, TO, RD3A, WR3A (FNC 78, 79, 176, 177), potentiometers (FNC 85, 86).
 */
#include "rungc_operands.h"

enum { M_LATE = 8299, D_TIME_OUT = 8299, M_TRANSFER_COUNT = 8164, D_TRANSFER_COUNT = 8164 };
enum { D_ANALOG_INPUTS = 8030, D_ANALOG_OUTPUTS = 8050 };

/* The largest number of words, of a module, and of an address. */
enum { MOST = 32767 };

/* A transfer of words or pairs. */
typedef struct transfer {
    int32_t unit;
    int32_t address;
    int32_t count;
} transfer;

/* Number of a module, and address in its buffer memory. */
static rungc_fault read_place(const rungc_call *call, rungc_operand m1, rungc_operand m2, transfer *words)
{
    const rungc_fault fault = rungc_read_in(call, m1, 0, MOST, &words->unit);

    return (fault != RUNGC_OK) ? fault : rungc_read_in(call, m2, 0, MOST, &words->address);
}

/* The count in an operand, or with M8164 in D8164. */
static rungc_fault read_count(const rungc_call *call, rungc_operand n, transfer *words)
{
    if (rungc_relay(call->map, M_TRANSFER_COUNT)) {
        words->count = rungc_register(call->map, D_TRANSFER_COUNT);
        return ((words->count < 1) || (words->count > MOST)) ? RUNGC_BAD_VALUE : RUNGC_OK;
    }
    return rungc_read_in(call, n, 1, MOST, &words->count);
}

static rungc_fault read_elements(const rungc_call *call, const transfer *words, rungc_operand d)
{
    const uint16_t unit = (uint16_t)words->unit;
    rungc_fault fault = rungc_check_elements(call, d, words->count);

    for (int32_t i = 0; (i < words->count) && (fault == RUNGC_OK); i++) {
        const int32_t address = words->address + (call->site.wide ? 2 * i : i);
        int16_t low = 0;
        int16_t high = 0;

        fault = rungc_read_module(call, unit, address, &low);
        if ((fault == RUNGC_OK) && call->site.wide) {
            fault = rungc_read_module(call, unit, address + 1, &high);
        }
        if (fault == RUNGC_OK) {
            fault = rungc_write_element(call, d, i, call->site.wide ? plc_join(high, low) : low);
        }
    }
    return fault;
}

static rungc_fault write_elements(const rungc_call *call, const transfer *words, rungc_operand s)
{
    const uint16_t unit = (uint16_t)words->unit;
    rungc_fault fault = rungc_check_elements(call, s, words->count);

    for (int32_t i = 0; (i < words->count) && (fault == RUNGC_OK); i++) {
        const int32_t address = words->address + (call->site.wide ? 2 * i : i);
        int32_t value = 0;

        fault = rungc_read_element(call, s, i, &value);
        if (fault == RUNGC_OK) {
            fault = rungc_write_module(call, unit, address, plc_low(value));
        }
        if ((fault == RUNGC_OK) && call->site.wide) {
            fault = rungc_write_module(call, unit, address + 1, plc_high(value));
        }
    }
    return fault;
}

/* ---- FROM m1 m2 D n, TO m1 m2 S n: n words, or pairs, of module m1 from address m2 on --------------------------------------------- */

/* The count is in D8164 with M8164. */
static rungc_fault from_either(const rungc_call *call, const rungc_operand operands[])
{
    transfer words = {0, 0, 0};
    rungc_fault fault = read_count(call, operands[3], &words);

    if (fault == RUNGC_OK) {
        fault = read_place(call, operands[0], operands[1], &words);
    }
    return (fault != RUNGC_OK) ? fault : read_elements(call, &words, operands[2]);
}

static rungc_fault to_either(const rungc_call *call, const rungc_operand operands[])
{
    transfer words = {0, 0, 0};
    rungc_fault fault = read_count(call, operands[3], &words);

    if (fault == RUNGC_OK) {
        fault = read_place(call, operands[0], operands[1], &words);
    }
    return (fault != RUNGC_OK) ? fault : write_elements(call, &words, operands[2]);
}

/* Those of models without M8164. */
static rungc_fault from_counted(const rungc_call *call, const rungc_operand operands[])
{
    transfer words = {0, 0, 0};
    rungc_fault fault = rungc_read_in(call, operands[3], 1, MOST, &words.count);

    if (fault == RUNGC_OK) {
        fault = read_place(call, operands[0], operands[1], &words);
    }
    return (fault != RUNGC_OK) ? fault : read_elements(call, &words, operands[2]);
}

static rungc_fault to_counted(const rungc_call *call, const rungc_operand operands[])
{
    transfer words = {0, 0, 0};
    rungc_fault fault = rungc_read_in(call, operands[3], 1, MOST, &words.count);

    if (fault == RUNGC_OK) {
        fault = read_place(call, operands[0], operands[1], &words);
    }
    return (fault != RUNGC_OK) ? fault : write_elements(call, &words, operands[2]);
}

void rungc_from(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, d, n};

    rungc_run(map, site, operands, from_either);
}

void rungc_to(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand s, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, s, n};

    rungc_run(map, site, operands, to_either);
}

void rungc_from_stated(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, d, n};

    rungc_run(map, site, operands, from_counted);
}

void rungc_to_stated(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand s, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, s, n};

    rungc_run(map, site, operands, to_counted);
}

/* ---- FROM and TO of H1U and H2U, whose modules may be remote ---------------------------------------------------------------------- */

/* Numbers of remote modules, 100 and the station on CAN, and the limits of their time-out in milliseconds. */
enum { FIRST_REMOTE = 101, LAST_REMOTE = 163, SHORTEST_MS = 5, LONGEST_MS = 1000 };

/* Waits until a remote module answers; only its buffer memory shows that if the host cannot say. */
static bool answers(const rungc_call *call, uint16_t unit)
{
    const rungc_hal *const hal = call->map->hal;
    int32_t ms = rungc_register(call->map, D_TIME_OUT);

    ms = (ms < SHORTEST_MS) ? SHORTEST_MS : ms;
    ms = (ms > LONGEST_MS) ? LONGEST_MS : ms;
    return (hal == NULL) || (hal->module_answers == NULL) || hal->module_answers(hal->context, unit, (uint16_t)ms);
}

/* A remote module that has not answered in time switches M8299 on, which the program switches off. */
static rungc_fault exchange_remotely(const rungc_call *call, const rungc_operand operands[], rungc_work *work)
{
    int32_t unit = 0;
    int16_t first = 0;
    rungc_fault fault = rungc_read_in(call, operands[0], 0, MOST, &unit);

    if (fault != RUNGC_OK) {
        return fault;
    }
    if ((unit < FIRST_REMOTE) || (unit > LAST_REMOTE)) {
        return work(call, operands);
    }
    if (answers(call, (uint16_t)unit)) {
        fault = work(call, operands);
        /* A module that has a first word, but not this one, has answered. */
        if ((fault != RUNGC_NO_MODULE)
            || (rungc_read_module(call, (uint16_t)unit, 0, &first) == RUNGC_OK)) {
            return fault;
        }
    }
    rungc_set_relay(call->map, M_LATE, true);
    return RUNGC_NO_ANSWER;
}

static rungc_fault from_any(const rungc_call *call, const rungc_operand operands[])
{
    return exchange_remotely(call, operands, from_either);
}

static rungc_fault to_any(const rungc_call *call, const rungc_operand operands[])
{
    return exchange_remotely(call, operands, to_either);
}

void rungc_from_remote(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, d, n};

    rungc_run(map, site, operands, from_any);
}

void rungc_to_remote(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand s, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, s, n};

    rungc_run(map, site, operands, to_any);
}

/* ---- FROM and TO of L01S: where there is no module 0, that number means the host -------------------------------------------------- */

/* Number of its analog inputs, and of its outputs. */
enum { ANALOG_CHANNELS = 8 };

/* Returns true if the operands name a word of the host. */
static bool of_host(const rungc_call *call, const transfer *words)
{
    int16_t word = 0;

    return (words->unit == 0) && (rungc_read_module(call, 0, words->address, &word) != RUNGC_OK);
}

static rungc_fault from_or_host(const rungc_call *call, const rungc_operand operands[])
{
    transfer words = {0, 0, 0};
    rungc_fault fault = read_place(call, operands[0], operands[1], &words);

    if ((fault == RUNGC_OK) && !of_host(call, &words)) {
        return from_either(call, operands);
    }
    if (fault == RUNGC_OK) {
        fault = read_count(call, operands[3], &words);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_check_words(call, operands[2], words.count);
    }
    if ((fault == RUNGC_OK) && ((words.address + words.count) > ANALOG_CHANNELS)) {
        fault = RUNGC_NO_MODULE;
    }
    for (int32_t i = 0; (i < words.count) && (fault == RUNGC_OK); i++) {
        int16_t value = 0;

        /* One that is not wired is as its register shows it. */
        if (rungc_read_analog(call, words.address + i, &value) != RUNGC_OK) {
            value = rungc_register(call->map, (uint32_t)(D_ANALOG_INPUTS + words.address + i));
        }
        fault = rungc_write_word(call, operands[2], i, value);
    }
    return fault;
}

/* The outputs take D8050 and so on. */
static rungc_fault to_or_host(const rungc_call *call, const rungc_operand operands[])
{
    transfer words = {0, 0, 0};
    rungc_fault fault = read_place(call, operands[0], operands[1], &words);

    if ((fault == RUNGC_OK) && !of_host(call, &words)) {
        return to_either(call, operands);
    }
    if (fault == RUNGC_OK) {
        fault = read_count(call, operands[3], &words);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_check_words(call, operands[2], words.count);
    }
    if ((fault == RUNGC_OK) && ((words.address + words.count) > ANALOG_CHANNELS)) {
        fault = RUNGC_NO_MODULE;
    }
    for (int32_t i = 0; (i < words.count) && (fault == RUNGC_OK); i++) {
        int16_t value = 0;

        fault = rungc_read_word(call, operands[2], i, &value);
        if (fault == RUNGC_OK) {
            rungc_set_register(call->map, (uint32_t)(D_ANALOG_OUTPUTS + words.address + i), value);
        }
    }
    return fault;
}

void rungc_from_host(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, d, n};

    rungc_run(map, site, operands, from_or_host);
}

void rungc_to_host(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand s, rungc_operand n)
{
    const rungc_operand operands[] = {m1, m2, s, n};

    rungc_run(map, site, operands, to_or_host);
}

/* ---- RD3A m1 m2 D, WR3A m1 m2 S: an analog channel of an FX0N-3A, FX2N-2AD or FX2N-2DA -------------------------------------------- */

/* Buffer memory: converted value, the four high bits of the one of FX2N-2AD, value to convert, control. */
enum { INPUT_VALUE = 0, INPUT_HIGH = 1, OUTPUT_VALUE = 16, CONTROL = 17 };

/* Channel 1 of the modules of twelve bits. */
enum { TWELVE_BITS = 21 };

/* The rise of control bit 1 starts a conversion of the channel in bit 0. */
static rungc_fault rd3a(const rungc_call *call, const rungc_operand operands[])
{
    transfer place = {0, 0, 0};
    int16_t value = 0;
    int16_t high = 0;
    rungc_fault fault = rungc_read_in(call, operands[0], 0, MOST, &place.unit);

    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[1], 1, TWELVE_BITS + 1, &place.address);
    }
    const bool twelve_bits = place.address >= TWELVE_BITS;
    const int16_t channel = (int16_t)(place.address - (twelve_bits ? TWELVE_BITS : 1));
    const uint16_t unit = (uint16_t)place.unit;

    if ((fault == RUNGC_OK) && !twelve_bits && (channel > 1)) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_word(call, operands[2], 0, &value);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_module(call, unit, CONTROL, channel);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_module(call, unit, CONTROL, plc_with_bit(channel, 1, true));
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_module(call, unit, INPUT_VALUE, &value);
    }
    if ((fault == RUNGC_OK) && twelve_bits) {
        fault = rungc_read_module(call, unit, INPUT_HIGH, &high);
        value = plc_int16(((uint32_t)value & 0xFFu) | (((uint32_t)high & 0x0Fu) << 8));
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[2], 0, value);
}

/* A word for a module and its address. */
typedef struct step {
    uint16_t address;
    int16_t value;
} step;

static rungc_fault write_steps(const rungc_call *call, uint16_t unit, const step steps[], size_t count)
{
    rungc_fault fault = RUNGC_OK;

    for (size_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = rungc_write_module(call, unit, steps[i].address, steps[i].value);
    }
    return fault;
}

/* The fall of a control bit starts the conversion. */
static rungc_fault wr3a(const rungc_call *call, const rungc_operand operands[])
{
    transfer place = {0, 0, 0};
    int32_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[0], 0, MOST, &place.unit);

    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[1], 1, TWELVE_BITS + 1, &place.address);
    }
    const bool twelve_bits = place.address >= TWELVE_BITS;

    if ((fault == RUNGC_OK) && !twelve_bits && (place.address != 1)) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[2], 0, twelve_bits ? 4095 : 255, &value);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (!twelve_bits) {
        const step steps[] = {{OUTPUT_VALUE, (int16_t)value}, {CONTROL, 4}, {CONTROL, 0}};

        return write_steps(call, (uint16_t)place.unit, steps, 3);
    }
    /* The fall of bit 2 takes the eight low bits over, before the four high ones come. */
    const step steps[] = {{OUTPUT_VALUE, (int16_t)(value % 256)},
                          {CONTROL, 4},
                          {CONTROL, 0},
                          {OUTPUT_VALUE, (int16_t)(value / 256)},
                          {CONTROL, (place.address == TWELVE_BITS) ? 2 : 1},
                          {CONTROL, 0}};

    return write_steps(call, (uint16_t)place.unit, steps, 6);
}

void rungc_rd3a(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand d)
{
    const rungc_operand operands[] = {m1, m2, d};

    rungc_run(map, site, operands, rd3a);
}

void rungc_wr3a(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand s)
{
    const rungc_operand operands[] = {m1, m2, s};

    rungc_run(map, site, operands, wr3a);
}

/* Module 0 of compatible boards is the board itself, whose channels are counted from 0. */
static rungc_fault rd3a_of_board(const rungc_call *call, const rungc_operand operands[])
{
    int32_t unit = 0;
    int32_t channel = 0;
    int16_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[0], 0, MOST, &unit);

    if ((fault == RUNGC_OK) && (unit != 0)) {
        return rd3a(call, operands);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[1], 0, 7, &channel);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_analog(call, channel, &value);
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[2], 0, value);
}

static rungc_fault wr3a_of_board(const rungc_call *call, const rungc_operand operands[])
{
    int32_t unit = 0;
    int32_t channel = 0;
    int16_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[0], 0, MOST, &unit);

    if ((fault == RUNGC_OK) && (unit != 0)) {
        return wr3a(call, operands);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[1], 0, 7, &channel);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_word(call, operands[2], 0, &value);
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_module(call, 0, channel, value);
}

void rungc_rd3a_board(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand d)
{
    const rungc_operand operands[] = {m1, m2, d};

    rungc_run(map, site, operands, rd3a_of_board);
}

void rungc_wr3a_board(rungc_map *map, rungc_site site, rungc_operand m1, rungc_operand m2, rungc_operand s)
{
    const rungc_operand operands[] = {m1, m2, s};

    rungc_run(map, site, operands, wr3a_of_board);
}

/* ---- VRRD S D: the position of potentiometer S, 0 to 255; VRSC S D: as one of 0 to 10, the nearest -------------------------------- */

static rungc_fault read_potentiometer(const rungc_call *call, rungc_operand s, int16_t *position)
{
    int32_t number = 0;
    rungc_fault fault = rungc_read_in(call, s, 0, 7, &number);

    if (fault == RUNGC_OK) {
        fault = rungc_read_analog(call, number, position);
    }
    if (fault == RUNGC_OK) {
        *position = (*position < 0) ? 0 : *position;
        *position = (*position > 255) ? 255 : *position;
    }
    return fault;
}

static rungc_fault vrrd(const rungc_call *call, const rungc_operand operands[])
{
    int16_t position = 0;
    const rungc_fault fault = read_potentiometer(call, operands[0], &position);

    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[1], 0, position);
}

static rungc_fault vrsc(const rungc_call *call, const rungc_operand operands[])
{
    int16_t position = 0;
    const rungc_fault fault = read_potentiometer(call, operands[0], &position);

    position = (int16_t)(((position * 10) + 127) / 255);
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[1], 0, position);
}

void rungc_vrrd(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, vrrd);
}

void rungc_vrsc(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, vrsc);
}
