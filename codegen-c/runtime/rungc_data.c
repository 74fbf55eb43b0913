/*
 * rungc_data.c: data processing (FNC 40 to 48).
 */
#include "rungc_operands.h"

enum { M_ZERO = 8020, M_BORROW = 8021, M_MEAN_SUM = 8490 };

/* ---- ZRST D1 D2 clears the devices D1 to D2; if D2 lies below D1 only D1 ---------------------------------------------------------- */

static bool is_counter32(rungc_operand operand, int32_t offset)
{
    return (operand.class_ == RUNGC_CLASS_C) && (plc_sat_add32(operand.value, offset) >= RUNGC_FIRST_COUNTER32);
}

/* Fails unless a word, timer or counter exists. */
static rungc_fault check_reset(const rungc_call *call, rungc_operand operand, int32_t offset)
{
    int32_t value = 0;

    return is_counter32(operand, offset) ? rungc_read_long(call, operand, offset, &value)
                                         : rungc_check_word(call, operand, offset);
}

static rungc_fault reset(const rungc_call *call, rungc_operand operand, int32_t offset)
{
    uint32_t number = 0;
    rungc_fault fault;

    if ((operand.class_ != RUNGC_CLASS_T) && (operand.class_ != RUNGC_CLASS_C)) {
        return rungc_write_word(call, operand, offset, 0);
    }
    fault = rungc_number_of(operand, offset, &number);
    if ((fault == RUNGC_OK) && !rungc_reset_device(call->map, operand.class_, number)) {
        fault = RUNGC_NO_DEVICE;
    }
    return fault;
}

static rungc_fault zrst(const rungc_call *call, const rungc_operand operands[])
{
    const rungc_operand first = operands[0];
    const bool bits = rungc_is_bit(first);
    rungc_fault fault = RUNGC_OK;

    if ((first.class_ != operands[1].class_) || (first.kind != RUNGC_OPERAND_KIND_DEVICE)) {
        return RUNGC_BAD_VALUE;
    }
    const int32_t last = (operands[1].value > first.value) ? operands[1].value : first.value;
    const int32_t count = plc_sat_add32(plc_sat_sub32(last, first.value), 1);

    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = bits ? rungc_check_bit(call, first, i) : check_reset(call, first, i);
    }
    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = bits ? rungc_write_bit(call, first, i, false) : reset(call, first, i);
    }
    return fault;
}

void rungc_zrst(rungc_map *map, rungc_site site, rungc_operand d1, rungc_operand d2)
{
    const rungc_operand operands[] = {d1, d2};

    rungc_run(map, site, operands, zrst);
}

/* ---- DECO S D n switches bit v of 2^n alone on, ENCO S D n finds the highest that is on ------------------------------------------- */

/* The number n of bits that say a place: up to 8 of bits, up to 4 of a word. */
static rungc_fault read_width(const rungc_call *call, rungc_operand places, rungc_operand n, int32_t *width)
{
    return rungc_read_in(call, n, 0, rungc_is_bit(places) ? 8 : 4, width);
}

/* The low bits of S as a number. */
static rungc_fault read_low_bits(const rungc_call *call, rungc_operand s, int32_t count, uint32_t *value)
{
    rungc_fault fault = RUNGC_OK;
    uint32_t bits = 0;

    if (!rungc_is_bit(s)) {
        fault = rungc_read_bits(call, s, &bits);
    } else {
        for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
            bool on = false;

            fault = rungc_read_bit(call, s, i, &on);
            bits |= (on ? UINT32_C(1) : 0u) << (uint32_t)i;
        }
    }
    *value = bits & ((UINT32_C(1) << (uint32_t)count) - 1u);
    return fault;
}

static rungc_fault deco(const rungc_call *call, const rungc_operand operands[])
{
    int32_t width = 0;
    uint32_t place = 0;
    rungc_fault fault = read_width(call, operands[1], operands[2], &width);

    if ((fault != RUNGC_OK) || (width == 0)) {
        return fault;
    }
    fault = read_low_bits(call, operands[0], width, &place);
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (!rungc_is_bit(operands[1])) {
        return rungc_write_word(call, operands[1], 0, plc_int16(UINT32_C(1) << place));
    }
    const int32_t count = (int32_t)(UINT32_C(1) << (uint32_t)width);

    fault = rungc_check_bits(call, operands[1], count);
    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = rungc_write_bit(call, operands[1], i, i == (int32_t)place);
    }
    return fault;
}

/* Place of the highest bit of S that is on; negative if none is. */
static rungc_fault find_highest(const rungc_call *call, rungc_operand s, int32_t width, int32_t *highest)
{
    const int32_t count = (int32_t)(UINT32_C(1) << (uint32_t)width);
    const bool bits = rungc_is_bit(s);
    uint32_t word = 0;
    rungc_fault fault = bits ? RUNGC_OK : rungc_read_bits(call, s, &word);

    *highest = -1;
    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        bool on = (i < 32) && (((word >> ((uint32_t)i & 31u)) & 1u) != 0u);

        if (bits) {
            fault = rungc_read_bit(call, s, i, &on);
        }
        if (on) {
            *highest = i;
        }
    }
    return fault;
}

/* That none is on is an error; `clears` then writes 0. */
static rungc_fault encode(const rungc_call *call, const rungc_operand operands[], bool clears)
{
    int32_t width = 0;
    int32_t highest = 0;
    rungc_fault fault = read_width(call, operands[0], operands[2], &width);

    if ((fault != RUNGC_OK) || (width == 0)) {
        return fault;
    }
    fault = find_highest(call, operands[0], width, &highest);
    if ((fault == RUNGC_OK) && ((highest >= 0) || clears)) {
        fault = rungc_write_word(call, operands[1], 0, (int16_t)((highest >= 0) ? highest : 0));
    }
    if ((fault == RUNGC_OK) && (highest < 0)) {
        fault = RUNGC_BAD_VALUE;
    }
    return fault;
}

static rungc_fault enco(const rungc_call *call, const rungc_operand operands[])
{
    return encode(call, operands, false);
}

/* On FX, D becomes 0 beside the error. */
static rungc_fault enco_zero(const rungc_call *call, const rungc_operand operands[])
{
    return encode(call, operands, true);
}

void rungc_deco(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, deco);
}

void rungc_enco(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, enco);
}

void rungc_enco_zero(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, enco_zero);
}

/* ---- SUM S D counts bits, BON S D n takes one, MEAN S D n is the mean of n elements ----------------------------------------------- */

/* Count and sum of the elements. */
static rungc_fault add_up(const rungc_call *call, const rungc_operand operands[], int32_t *count, int64_t *total)
{
    rungc_fault fault = rungc_read_in(call, operands[2], 1, 64, count);

    *total = 0;
    for (int32_t i = 0; (fault == RUNGC_OK) && (i < *count); i++) {
        int32_t value = 0;

        fault = rungc_read_element(call, operands[0], i, &value);
        *total += value;
    }
    return fault;
}

/* The fraction is dropped. */
static rungc_fault mean(const rungc_call *call, const rungc_operand operands[])
{
    int32_t count = 0;
    int64_t total = 0;
    const rungc_fault fault = add_up(call, operands, &count, &total);

    return (fault != RUNGC_OK) ? fault : rungc_write(call, operands[1], (int32_t)(total / count));
}

/* On H1U and H2U, with M8490 the 16-bit form also writes the sum to (D+2, D+1). */
static rungc_fault mean_sum(const rungc_call *call, const rungc_operand operands[])
{
    int32_t count = 0;
    int64_t total = 0;
    rungc_fault fault;

    if (call->site.wide || !rungc_relay(call->map, M_MEAN_SUM)) {
        return mean(call, operands);
    }
    fault = add_up(call, operands, &count, &total);
    if (fault == RUNGC_OK) {
        fault = rungc_check_words(call, operands[1], 3);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_word(call, operands[1], 0, (int16_t)(total / count));
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_long(call, operands[1], 1, (int32_t)total);
}

void rungc_mean(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, mean);
}

void rungc_mean_sum(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d, rungc_operand n)
{
    const rungc_operand operands[] = {s, d, n};

    rungc_run(map, site, operands, mean_sum);
}

/* ---- ANS S m D sets annunciator D once it has been driven for m times 100 ms, ANR resets the lowest that is on --------------------- */

/* Words that keep the time driven, in milliseconds, whether the last scan drove it, and the scan. */
enum { KEPT_MS = 0, KEPT_DRIVEN = 1, KEPT_SCAN = 7 };

/* Annunciators. */
enum { FIRST_ANNUNCIATOR = 900, LAST_ANNUNCIATOR = 999 };

/* Milliseconds since the previous scan began; 0 if it has run in this one already. */
static int32_t elapsed_ms(const rungc_map *map, int32_t kept[])
{
    const plc_sys *const sys = rungc_sys(map);
    const bool again = kept[KEPT_SCAN] == sys->scan;

    kept[KEPT_SCAN] = sys->scan;
    if (again) {
        return 0;
    }
    return (sys->dt_ms > (uint32_t)INT32_MAX) ? INT32_MAX : (int32_t)sys->dt_ms;
}

/* Timer S shows the time and starts over with each drive. */
static rungc_fault ans(const rungc_call *call, const rungc_operand operands[])
{
    int32_t *const kept = rungc_kept(call);
    const int32_t passed = elapsed_ms(call->map, kept);
    int32_t limit = 0;
    rungc_fault fault;

    if (!call->site.drive) {
        if (kept[KEPT_DRIVEN] == 0) {
            return RUNGC_OK;
        }
        (void)memset(kept, 0, sizeof(rungc_state));
        return reset(call, operands[0], 0);
    }
    fault = rungc_read_in(call, operands[1], 1, INT16_MAX, &limit);
    if (fault == RUNGC_OK) {
        fault = rungc_check_bit(call, operands[2], 0);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (kept[KEPT_DRIVEN] != 0) {
        kept[KEPT_MS] = plc_sat_add32(kept[KEPT_MS], passed);
    }
    kept[KEPT_DRIVEN] = 1;
    const bool over = (kept[KEPT_MS] / 100) >= limit;

    fault = rungc_write_word(call, operands[0], 0, (int16_t)(over ? limit : kept[KEPT_MS] / 100));
    if ((fault == RUNGC_OK) && over) {
        fault = rungc_write_bit(call, operands[0], 0, true);
    }
    return ((fault == RUNGC_OK) && over) ? rungc_write_bit(call, operands[2], 0, true) : fault;
}

static rungc_fault anr(const rungc_call *call, const rungc_operand operands[])
{
    (void)operands;
    for (uint32_t number = FIRST_ANNUNCIATOR; number <= (uint32_t)LAST_ANNUNCIATOR; number++) {
        bool *bit = NULL;

        if (rungc_find_bit(call->map, 0u, RUNGC_CLASS_S, number, &bit) && (bit != NULL) && *bit) {
            *bit = false;
            break;
        }
    }
    return RUNGC_OK;
}

void rungc_ans(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand m, rungc_operand d)
{
    const rungc_operand operands[] = {s, m, d};

    rungc_run(map, site, operands, ans);
}

void rungc_anr(rungc_map *map, rungc_site site)
{
    rungc_run(map, site, NULL, anr);
}

/* ---- SQR S D: the root, its fraction dropped -------------------------------------------------------------------------------------- */
