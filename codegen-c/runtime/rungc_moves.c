/*
 * rungc_moves.c: moves, and conversions between binary and BCD (FNC 13 to 19, 147).
 */
#include "rungc_operands.h"

enum { M_BMOV_REVERSE = 8024, M_XCH_BYTES = 8160, M_SMOV_HEX = 8168 };

/* The largest number of words that BMOV and FMOV take. */
enum { MOST_WORDS = 512 };

/* ---- BMOV S D n copies n words, FMOV S D n fills n words or pairs ----------------------------------------------------------------- */

/* Returns true if `to` starts after `from` in the same class, so that a block is copied from its end. */
static bool begins_behind(rungc_operand from, rungc_operand to)
{
    return (from.kind == to.kind) && (from.class_ == to.class_) && (to.value > from.value)
        && ((from.kind != RUNGC_OPERAND_KIND_BUFFER) || (from.digits == to.digits));
}

/* Copies words, also if they overlap. */
static rungc_fault copy(const rungc_call *call, rungc_operand from, rungc_operand to, int32_t count)
{
    const bool backwards = begins_behind(from, to);
    rungc_fault fault = rungc_check_words(call, from, count);

    if (fault == RUNGC_OK) {
        fault = rungc_check_words(call, to, count);
    }
    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        const int32_t place = backwards ? count - 1 - i : i;
        int16_t value = 0;

        fault = rungc_read_word(call, from, place, &value);
        if (fault == RUNGC_OK) {
            fault = rungc_write_word(call, to, place, value);
        }
    }
    return fault;
}

static rungc_fault bmov_forward(const rungc_call *call, const rungc_operand operands[])
{
    int32_t count = 0;
    const rungc_fault fault = rungc_read_in(call, operands[2], 1, MOST_WORDS, &count);

    return (fault != RUNGC_OK) ? fault : copy(call, operands[0], operands[1], count);
}

/* With M8024 from D to S. */
static rungc_fault bmov(const rungc_call *call, const rungc_operand operands[])
{
    const rungc_operand reversed[] = {operands[1], operands[0], operands[2]};

    return bmov_forward(call, rungc_relay(call->map, M_BMOV_REVERSE) ? reversed : operands);
}

static rungc_fault fmov(const rungc_call *call, const rungc_operand operands[])
{
    int32_t count = 0;
    int32_t value = 0;
    rungc_fault fault = rungc_read_in(call, operands[2], 1, MOST_WORDS, &count);

    if (fault == RUNGC_OK) {
        fault = rungc_read(call, operands[0], &value);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_check_elements(call, operands[1], count);
    }
    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = rungc_write_element(call, operands[1], i, value);
    }
    return fault;
}

void rungc_bmov(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, bmov);
}

void rungc_bmov_forward(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, bmov_forward);
}

void rungc_fmov(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, fmov);
}

/* ---- XCH D1 D2 exchanges two values, SWAP S the bytes of each word ---------------------------------------------------------------- */

/* ---- BCD S D packs decimal digits, BIN S D reads them ----------------------------------------------------------------------------- */

/* ---- SMOV S m1 m2 D n: m2 digits of S downwards from digit m1 replace those of D downwards from digit n ---------------------------- */

/* Four digits: decimal ones of the value, or with M8168 its groups of four bits. */
static rungc_fault read_digits(const rungc_call *call, rungc_operand operand, bool hex, uint32_t *digits)
{
    int32_t value = 0;
    const rungc_fault fault = rungc_read(call, operand, &value);

    if (fault != RUNGC_OK) {
        return fault;
    }
    if (!hex && ((value < 0) || (value > 9999))) {
        return RUNGC_BAD_VALUE;
    }
    *digits = hex ? (uint16_t)value : (uint32_t)plc_to_bcd32(value);
    return RUNGC_OK;
}

static rungc_fault smov(const rungc_call *call, const rungc_operand operands[])
{
    const bool hex = rungc_relay(call->map, M_SMOV_HEX);
    int32_t from = 0;
    int32_t count = 0;
    int32_t to = 0;
    uint32_t moved = 0;
    uint32_t digits = 0;
    rungc_fault fault = rungc_read_in(call, operands[1], 1, 4, &from);

    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[2], 1, 4, &count);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read_in(call, operands[4], 1, 4, &to);
    }
    if ((fault == RUNGC_OK) && ((count > from) || (count > to))) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        fault = read_digits(call, operands[0], hex, &moved);
    }
    if (fault == RUNGC_OK) {
        fault = read_digits(call, operands[3], hex, &digits);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const uint32_t mask = (UINT32_C(1) << (4u * (uint32_t)count)) - 1u;
    const uint32_t place = 4u * (uint32_t)(to - count);

    moved = (moved >> (4u * (uint32_t)(from - count))) & mask;
    digits = (digits & ~(mask << place)) | (moved << place);
    return rungc_write(call, operands[3], hex ? plc_int32(digits) : plc_from_bcd32(plc_int32(digits)));
}

void rungc_smov(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand m1, rungc_operand m2, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, m1, m2, d, n};

    rungc_run(map, site, operands, smov);
}
