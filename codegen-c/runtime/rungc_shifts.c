/*
 * rungc_shifts.c: rotation, shifts and queues (FNC 30 to 39, 212 to 214).
 */
#include "rungc_operands.h"

enum { M_ZERO = 8020, M_CARRY = 8022 };

static uint32_t width_of(const rungc_call *call)
{
    return call->site.wide ? 32u : 16u;
}

/* ---- ROR, ROL D n rotate D, RCR, RCL D n with the carry flag ---------------------------------------------------------------------- */

/* Rotates the low `width` bits right. */
static uint64_t rotate_right(uint64_t ring, uint32_t width, uint32_t places)
{
    const uint64_t mask = (UINT64_C(1) << width) - 1u;
    const uint32_t by = places % width;

    return ((ring >> by) | (ring << (width - by))) & mask;
}

static rungc_fault rotate_through_carry(const rungc_call *call, const rungc_operand operands[], bool right)
{
    const uint32_t width = width_of(call);
    int32_t places = 0;
    uint32_t bits = 0;
    rungc_fault fault = rungc_read_in(call, operands[1], 0, (int32_t)width, &places);

    if (fault == RUNGC_OK) {
        fault = rungc_read_bits(call, operands[0], &bits);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const uint64_t carry = rungc_relay(call->map, M_CARRY) ? 1u : 0u;
    const uint64_t ring = rotate_right((carry << width) | bits, width + 1u, right ? (uint32_t)places : width + 1u - (uint32_t)places);

    fault = rungc_write(call, operands[0], plc_int32((uint32_t)(ring & UINT32_MAX)));
    if (fault == RUNGC_OK) {
        rungc_set_relay(call->map, M_CARRY, ((ring >> width) & 1u) != 0u);
    }
    return fault;
}

static rungc_fault rcr(const rungc_call *call, const rungc_operand operands[])
{
    return rotate_through_carry(call, operands, true);
}

static rungc_fault rcl(const rungc_call *call, const rungc_operand operands[])
{
    return rotate_through_carry(call, operands, false);
}

void rungc_rcr(rungc_map *map, rungc_site site, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {d, n};

    rungc_run(map, site, operands, rcr);
}

void rungc_rcl(rungc_map *map, rungc_site site, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {d, n};

    rungc_run(map, site, operands, rcl);
}

/* ---- SFR, SFL D n shift D, zeros entering; n counts modulo 16 ---------------------------------------------------------------------- */

/* The last bit out goes to the carry flag. */
static rungc_fault shift_word(const rungc_call *call, const rungc_operand operands[], bool right)
{
    int32_t places = 0;
    int16_t word = 0;
    rungc_fault fault = rungc_read_in(call, operands[1], 0, INT16_MAX, &places);

    if (fault == RUNGC_OK) {
        fault = rungc_read_word(call, operands[0], 0, &word);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const uint32_t by = (uint32_t)places % 16u;
    /* The carry flag is the bit below, or above. */
    const uint32_t bits = right ? ((uint32_t)(uint16_t)word << 1) >> by : (uint32_t)(uint16_t)word << by;
    const bool carry = right ? ((by > 0u) && ((bits & 1u) != 0u)) : (((bits >> 16) & 1u) != 0u);

    fault = rungc_write_word(call, operands[0], 0, plc_int16(right ? bits >> 1 : bits));
    if (fault == RUNGC_OK) {
        rungc_set_relay(call->map, M_CARRY, carry);
    }
    return fault;
}

static rungc_fault sfr(const rungc_call *call, const rungc_operand operands[])
{
    return shift_word(call, operands, true);
}

static rungc_fault sfl(const rungc_call *call, const rungc_operand operands[])
{
    return shift_word(call, operands, false);
}

void rungc_sfr(rungc_map *map, rungc_site site, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {d, n};

    rungc_run(map, site, operands, sfr);
}

void rungc_sfl(rungc_map *map, rungc_site site, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {d, n};

    rungc_run(map, site, operands, sfl);
}

/* ---- SFTR, SFTL S D n1 n2 shift the n1 bits from D on by n2 places, the n2 from S on entering; WSFR, WSFL words -------------------- */

/* Copies a bit or a word. */
static rungc_fault copy_item(const rungc_call *call, bool words, rungc_operand from, int32_t source, rungc_operand to, int32_t target)
{
    bool on = false;
    int16_t word = 0;
    rungc_fault fault = words ? rungc_read_word(call, from, source, &word) : rungc_read_bit(call, from, source, &on);

    if (fault == RUNGC_OK) {
        fault = words ? rungc_write_word(call, to, target, word) : rungc_write_bit(call, to, target, on);
    }
    return fault;
}

static rungc_fault check_items(const rungc_call *call, bool words, rungc_operand operand, int32_t count)
{
    return words ? rungc_check_words(call, operand, count) : rungc_check_bits(call, operand, count);
}

/* Nothing happens if n2 is 0. */
static rungc_fault shift(const rungc_call *call, const rungc_operand operands[], bool words, bool right)
{
    const rungc_operand d = operands[1];
    int32_t length = 0;
    int32_t by = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 1, words ? 2048 : 1024, &length);

    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[3], 0, length, &by);
    }
    if (fault == RUNGC_OK) {
        fault = check_items(call, words, operands[0], by);
    }
    if (fault == RUNGC_OK) {
        fault = check_items(call, words, d, length);
    }
    if ((fault != RUNGC_OK) || (by == 0)) {
        return fault;
    }
    for (int32_t i = 0; (i < (length - by)) && (fault == RUNGC_OK); i++) {
        const int32_t last = length - 1 - i;

        fault = right ? copy_item(call, words, d, i + by, d, i) : copy_item(call, words, d, last - by, d, last);
    }
    for (int32_t i = 0; (i < by) && (fault == RUNGC_OK); i++) {
        fault = copy_item(call, words, operands[0], i, d, right ? (length - by) + i : i);
    }
    return fault;
}

static rungc_fault sftr(const rungc_call *call, const rungc_operand operands[])
{
    return shift(call, operands, false, true);
}

static rungc_fault sftl(const rungc_call *call, const rungc_operand operands[])
{
    return shift(call, operands, false, false);
}

static rungc_fault wsfr(const rungc_call *call, const rungc_operand operands[])
{
    return shift(call, operands, true, true);
}

static rungc_fault wsfl(const rungc_call *call, const rungc_operand operands[])
{
    return shift(call, operands, true, false);
}

void rungc_sftr(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n1, rungc_operand n2)
{
    const rungc_operand operands[] = {s, d, n1, n2};

    rungc_run(map, site, operands, sftr);
}

void rungc_sftl(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n1, rungc_operand n2)
{
    const rungc_operand operands[] = {s, d, n1, n2};

    rungc_run(map, site, operands, sftl);
}

void rungc_wsfr(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n1, rungc_operand n2)
{
    const rungc_operand operands[] = {s, d, n1, n2};

    rungc_run(map, site, operands, wsfr);
}

void rungc_wsfl(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n1, rungc_operand n2)
{
    const rungc_operand operands[] = {s, d, n1, n2};

    rungc_run(map, site, operands, wsfl);
}

/* ---- SFWR S D n appends to a queue, SFRD S D n takes its oldest entry, POP S D n the newest ---------------------------------------- */

/* The number of entries that a queue holds, its words checked. */
static rungc_fault read_entries(const rungc_call *call, rungc_operand queue, int32_t words, int32_t *held)
{
    int16_t count = 0;
    rungc_fault fault = rungc_check_words(call, queue, words);

    if (fault == RUNGC_OK) {
        fault = rungc_read_word(call, queue, 0, &count);
    }
    if ((fault == RUNGC_OK) && (count < 0)) {
        fault = RUNGC_BAD_VALUE;
    }
    *held = count;
    return fault;
}

static rungc_fault copy_word(const rungc_call *call, rungc_operand operand, int32_t from, int32_t to)
{
    return copy_item(call, true, operand, from, operand, to);
}

/* A full queue stays, and the carry flag is on. */
static rungc_fault sfwr(const rungc_call *call, const rungc_operand operands[])
{
    int32_t n = 0;
    int32_t held = 0;
    int16_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 2, 2048, &n);

    if (fault == RUNGC_OK) {
        fault = read_entries(call, operands[1], n, &held);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_word(call, operands[0], 0, &value);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    rungc_set_relay(call->map, M_CARRY, held >= (n - 1));
    if (held >= (n - 1)) {
        return RUNGC_OK;
    }
    fault = rungc_write_word(call, operands[1], 0, (int16_t)(held + 1));
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[1], held + 1, value);
}

/* Moves S+1 to D, and the others of the places down by one. */
static rungc_fault take_first(const rungc_call *call, const rungc_operand operands[], int32_t held, int32_t places)
{
    int16_t value = 0;
    rungc_fault fault = rungc_read_word(call, operands[0], 1, &value);

    for (int32_t place = 1; (place < places) && (fault == RUNGC_OK); place++) {
        fault = copy_word(call, operands[0], place + 1, place);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_word(call, operands[0], 0, (int16_t)(held - 1));
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[1], 0, value);
}

/* An empty queue gives nothing, and the zero flag is on. */
static rungc_fault sfrd(const rungc_call *call, const rungc_operand operands[])
{
    int32_t n = 0;
    int32_t held = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 2, 2048, &n);

    if (fault == RUNGC_OK) {
        fault = read_entries(call, operands[0], n, &held);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_check_word(call, operands[1], 0);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    rungc_set_relay(call->map, M_ZERO, held == 0);
    return (held == 0) ? RUNGC_OK : take_first(call, operands, held, n - 1);
}

/* On HM, S enters at D+1, the older entries move up; the queue holds n. */
static rungc_fault sfwr_hm(const rungc_call *call, const rungc_operand operands[])
{
    int32_t n = 0;
    int32_t held = 0;
    int16_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 2, 512, &n);

    if (fault == RUNGC_OK) {
        fault = read_entries(call, operands[1], n + 1, &held);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_word(call, operands[0], 0, &value);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    rungc_set_relay(call->map, M_CARRY, held >= n);
    if (held >= n) {
        return RUNGC_OK;
    }
    for (int32_t place = held; (place >= 1) && (fault == RUNGC_OK); place--) {
        fault = copy_word(call, operands[1], place, place + 1);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_word(call, operands[1], 0, (int16_t)(held + 1));
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[1], 1, value);
}

/* On HM only the entries below the pointer move down; a pointer beyond n turns the carry flag on. */
static rungc_fault sfrd_hm(const rungc_call *call, const rungc_operand operands[])
{
    int32_t n = 0;
    int32_t held = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 2, 512, &n);

    if (fault == RUNGC_OK) {
        fault = read_entries(call, operands[0], n + 1, &held);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_check_word(call, operands[1], 0);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    rungc_set_relay(call->map, M_CARRY, held > n);
    return ((held == 0) || (held > n)) ? RUNGC_OK : take_first(call, operands, held, held);
}

/* An empty stack gives nothing; the zero flag is on when it is empty afterwards. */
static rungc_fault pop(const rungc_call *call, const rungc_operand operands[])
{
    int32_t n = 0;
    int32_t held = 0;
    int16_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 2, 512, &n);

    if (fault == RUNGC_OK) {
        fault = read_entries(call, operands[0], n, &held);
    }
    if ((fault == RUNGC_OK) && (held >= n)) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        fault = rungc_check_word(call, operands[1], 0);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    rungc_set_relay(call->map, M_ZERO, held <= 1);
    if (held == 0) {
        return RUNGC_OK;
    }
    fault = rungc_read_word(call, operands[0], held, &value);
    if (fault == RUNGC_OK) {
        fault = rungc_write_word(call, operands[0], 0, (int16_t)(held - 1));
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operands[1], 0, value);
}

void rungc_sfwr(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, sfwr);
}

void rungc_sfrd(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, sfrd);
}

void rungc_sfwr_hm(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, sfwr_hm);
}

void rungc_sfrd_hm(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, sfrd_hm);
}

void rungc_pop(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, pop);
}
