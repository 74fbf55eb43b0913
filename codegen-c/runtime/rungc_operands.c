/*
 * rungc_operands.c: operands of instructions: devices, groups of bits, bits of words, constants, buffer memory.
 */
#include "rungc_operands.h"

void rungc_run(rungc_map *map, rungc_site site, const rungc_operand operands[], rungc_work *work)
{
    const rungc_call call = rungc_call_at(map, site);

    rungc_conclude(&call, work(&call, operands));
}

rungc_fault rungc_number_of(rungc_operand operand, int32_t offset, uint32_t *number)
{
    const int64_t sum = (int64_t)operand.value + offset;
    const bool is_general = operand.value < RUNGC_FIRST_SPECIAL;

    if ((sum < 0) || (sum > INT32_MAX)) {
        return RUNGC_NO_DEVICE;
    }
    if (((operand.class_ == RUNGC_CLASS_D) || (operand.class_ == RUNGC_CLASS_M))
        && (is_general != (sum < RUNGC_FIRST_SPECIAL))) {
        return RUNGC_NO_DEVICE;
    }
    *number = (uint32_t)sum;
    return RUNGC_OK;
}

/* The word of a device: a 32-bit counter has none. */
static rungc_fault load(const rungc_call *call, rungc_operand operand, rungc_class device_class, uint32_t number, int16_t *value)
{
    int16_t *word = NULL;

    if (!rungc_find_word(call->map, operand.area, device_class, number, &word)) {
        return RUNGC_NO_DEVICE;
    }
    *value = (word != NULL) ? *word : 0;
    return RUNGC_OK;
}

static rungc_fault store(const rungc_call *call, rungc_operand operand, rungc_class device_class, uint32_t number, int16_t value)
{
    int16_t *word = NULL;

    if (!rungc_find_word(call->map, operand.area, device_class, number, &word)) {
        return RUNGC_NO_DEVICE;
    }
    if (word != NULL) {
        *word = value;
    }
    return RUNGC_OK;
}

/* The bit of a device. */
static rungc_fault load_bit(const rungc_call *call, rungc_operand operand, uint32_t number, bool *on)
{
    bool *bit = NULL;

    if (!rungc_find_bit(call->map, operand.area, operand.class_, number, &bit)) {
        return RUNGC_NO_DEVICE;
    }
    *on = (bit != NULL) && *bit;
    return RUNGC_OK;
}

static rungc_fault store_bit(const rungc_call *call, rungc_operand operand, uint32_t number, bool on)
{
    bool *bit = NULL;

    if (!rungc_find_bit(call->map, operand.area, operand.class_, number, &bit)) {
        return RUNGC_NO_DEVICE;
    }
    if (bit != NULL) {
        *bit = on;
    }
    return RUNGC_OK;
}

/* The first device of element `offset` of a group. */
static rungc_fault element_of_group(rungc_operand operand, int32_t offset, uint32_t *first)
{
    const int64_t bits = (int64_t)offset * 4 * operand.digits;

    if ((bits > INT32_MAX) || (bits < INT32_MIN)) {
        return RUNGC_NO_DEVICE;
    }
    return rungc_number_of(operand, (int32_t)bits, first);
}

/* The bits of an element of a group, of which `most` digits count. */
static uint32_t bits_of_group(rungc_operand operand, uint8_t most)
{
    return 4u * (uint32_t)((operand.digits < most) ? operand.digits : most);
}

static rungc_fault read_group(const rungc_call *call, rungc_operand operand, int32_t offset, uint8_t most, int32_t *value)
{
    const uint32_t count = bits_of_group(operand, most);
    uint32_t first = 0;
    uint32_t bits = 0;
    rungc_fault fault = element_of_group(operand, offset, &first);

    for (uint32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        bool on = false;

        fault = load_bit(call, operand, first + i, &on);
        bits |= (on ? 1u : 0u) << i;
    }
    if (fault == RUNGC_OK) {
        *value = plc_int32(bits);
    }
    return fault;
}

/* Nothing is written unless all bits exist. */
static rungc_fault write_group(const rungc_call *call, rungc_operand operand, int32_t offset, uint8_t most, int32_t value)
{
    const uint32_t count = bits_of_group(operand, most);
    uint32_t first = 0;
    bool on = false;
    rungc_fault fault = element_of_group(operand, offset, &first);

    if (fault == RUNGC_OK) {
        fault = load_bit(call, operand, first + ((count > 0u) ? count - 1u : 0u), &on);
    }
    for (uint32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = store_bit(call, operand, first + i, (((uint32_t)value >> i) & 1u) != 0u);
    }
    return fault;
}

/* A word of the buffer memory that an operand names. */
static rungc_fault read_buffer(const rungc_call *call, rungc_operand operand, int32_t offset, int16_t *value)
{
    return rungc_read_module(call, operand.digits, plc_sat_add32(operand.value, offset), value);
}

static rungc_fault write_buffer(const rungc_call *call, rungc_operand operand, int32_t offset, int16_t value)
{
    return rungc_write_module(call, operand.digits, plc_sat_add32(operand.value, offset), value);
}

rungc_fault rungc_read_word(const rungc_call *call, rungc_operand operand, int32_t offset, int16_t *value)
{
    rungc_fault fault;
    uint32_t number = 0;
    int32_t bits = 0;

    switch (operand.kind) {
    case RUNGC_OPERAND_KIND_DEVICE:
        fault = rungc_number_of(operand, offset, &number);
        return (fault != RUNGC_OK) ? fault : load(call, operand, operand.class_, number, value);
    case RUNGC_OPERAND_KIND_CONST:
    case RUNGC_OPERAND_KIND_FLOAT:
        *value = plc_low(operand.value);
        return RUNGC_OK;
    case RUNGC_OPERAND_KIND_NIBBLES:
        fault = read_group(call, operand, offset, 4u, &bits);
        if (fault == RUNGC_OK) {
            *value = plc_low(bits);
        }
        return fault;
    case RUNGC_OPERAND_KIND_BUFFER:
        return read_buffer(call, operand, offset, value);
    default:
        return RUNGC_NO_DEVICE;
    }
}

rungc_fault rungc_write_word(const rungc_call *call, rungc_operand operand, int32_t offset, int16_t value)
{
    rungc_fault fault;
    uint32_t number = 0;

    switch (operand.kind) {
    case RUNGC_OPERAND_KIND_DEVICE:
        fault = rungc_number_of(operand, offset, &number);
        return (fault != RUNGC_OK) ? fault : store(call, operand, operand.class_, number, value);
    case RUNGC_OPERAND_KIND_NIBBLES:
        return write_group(call, operand, offset, 4u, value);
    case RUNGC_OPERAND_KIND_BUFFER:
        return write_buffer(call, operand, offset, value);
    default:
        return RUNGC_NO_DEVICE;
    }
}

/* Word and place in it of a bit counted from the one that an operand names; it may be in one of the words after. */
static rungc_fault bit_of_word(rungc_operand operand, int32_t offset, uint32_t *number, unsigned *bit)
{
    const int64_t sum = (int64_t)offset + operand.digits;
    const int64_t word = (sum >= 0) ? (sum / 16) : ((sum - 15) / 16);

    if (sum > INT32_MAX) {
        return RUNGC_NO_DEVICE;
    }
    *bit = (unsigned)(sum - (word * 16));
    return rungc_number_of(operand, (int32_t)word, number);
}

rungc_fault rungc_read_bit(const rungc_call *call, rungc_operand operand, int32_t offset, bool *on)
{
    rungc_fault fault;
    uint32_t number = 0;
    unsigned bit = 0;
    int16_t word = 0;

    if (operand.kind != RUNGC_OPERAND_KIND_WORD_BIT) {
        fault = rungc_number_of(operand, offset, &number);
        return (fault != RUNGC_OK) ? fault : load_bit(call, operand, number, on);
    }
    fault = bit_of_word(operand, offset, &number, &bit);
    if (fault == RUNGC_OK) {
        fault = load(call, operand, operand.class_, number, &word);
    }
    if (fault == RUNGC_OK) {
        *on = plc_bit(word, bit);
    }
    return fault;
}

rungc_fault rungc_write_bit(const rungc_call *call, rungc_operand operand, int32_t offset, bool on)
{
    rungc_fault fault;
    uint32_t number = 0;
    unsigned bit = 0;
    int16_t word = 0;

    if (operand.kind != RUNGC_OPERAND_KIND_WORD_BIT) {
        fault = rungc_number_of(operand, offset, &number);
        return (fault != RUNGC_OK) ? fault : store_bit(call, operand, number, on);
    }
    fault = bit_of_word(operand, offset, &number, &bit);
    if (fault == RUNGC_OK) {
        fault = load(call, operand, operand.class_, number, &word);
    }
    if (fault == RUNGC_OK) {
        fault = store(call, operand, operand.class_, number, plc_with_bit(word, bit, on));
    }
    return fault;
}

/* The low word of a pair, the class of the high one, and its number. */
typedef struct pair {
    uint32_t low;
    rungc_class high_class;
    uint32_t high;
} pair;

static rungc_fault pair_of(const rungc_call *call, rungc_operand operand, int32_t offset, pair *words)
{
    const bool with_v = (operand.class_ == RUNGC_CLASS_Z) && call->map->layout->z_pairs_with_v;
    rungc_fault fault = rungc_number_of(operand, offset, &words->low);

    words->high_class = with_v ? RUNGC_CLASS_V : operand.class_;
    if (fault == RUNGC_OK) {
        fault = rungc_number_of(operand, with_v ? offset : plc_sat_add32(offset, 1), &words->high);
    }
    return fault;
}

/* The value of a 32-bit counter; NULL in `value` for other operands. */
static rungc_fault counter_of(const rungc_call *call, rungc_operand operand, int32_t offset, bool *is_counter, int32_t **value)
{
    uint32_t number = 0;
    const rungc_fault fault = rungc_number_of(operand, offset, &number);

    *is_counter = (fault == RUNGC_OK) && (operand.class_ == RUNGC_CLASS_C)
        && (number >= (uint32_t)RUNGC_FIRST_COUNTER32);
    if (*is_counter && !rungc_find_counter32(call->map, number, value)) {
        return RUNGC_NO_DEVICE;
    }
    return fault;
}

static rungc_fault read_pair(const rungc_call *call, rungc_operand operand, int32_t offset, int32_t *value)
{
    bool is_counter = false;
    int32_t *counter = NULL;
    pair words = {0, 0, 0};
    int16_t low = 0;
    int16_t high = 0;
    rungc_fault fault = counter_of(call, operand, offset, &is_counter, &counter);

    if ((fault == RUNGC_OK) && is_counter) {
        *value = (counter != NULL) ? *counter : 0;
        return RUNGC_OK;
    }
    if (fault == RUNGC_OK) {
        fault = pair_of(call, operand, offset, &words);
    }
    if (fault == RUNGC_OK) {
        fault = load(call, operand, operand.class_, words.low, &low);
    }
    if (fault == RUNGC_OK) {
        fault = load(call, operand, words.high_class, words.high, &high);
    }
    if (fault == RUNGC_OK) {
        *value = plc_join(high, low);
    }
    return fault;
}

/* Nothing is written unless both words exist. */
static rungc_fault write_pair(const rungc_call *call, rungc_operand operand, int32_t offset, int32_t value)
{
    bool is_counter = false;
    int32_t *counter = NULL;
    pair words = {0, 0, 0};
    int16_t before = 0;
    rungc_fault fault = counter_of(call, operand, offset, &is_counter, &counter);

    if ((fault == RUNGC_OK) && is_counter) {
        if (counter != NULL) {
            *counter = value;
        }
        return RUNGC_OK;
    }
    if (fault == RUNGC_OK) {
        fault = pair_of(call, operand, offset, &words);
    }
    if (fault == RUNGC_OK) {
        fault = load(call, operand, words.high_class, words.high, &before);
    }
    if (fault == RUNGC_OK) {
        fault = store(call, operand, operand.class_, words.low, plc_low(value));
    }
    if (fault == RUNGC_OK) {
        fault = store(call, operand, words.high_class, words.high, plc_high(value));
    }
    return fault;
}

rungc_fault rungc_read_long(const rungc_call *call, rungc_operand operand, int32_t offset, int32_t *value)
{
    rungc_fault fault;
    int16_t low = 0;
    int16_t high = 0;

    switch (operand.kind) {
    case RUNGC_OPERAND_KIND_CONST:
    case RUNGC_OPERAND_KIND_FLOAT:
        *value = operand.value;
        return RUNGC_OK;
    case RUNGC_OPERAND_KIND_NIBBLES:
        return read_group(call, operand, offset, 8u, value);
    case RUNGC_OPERAND_KIND_BUFFER:
        fault = read_buffer(call, operand, offset, &low);
        if (fault == RUNGC_OK) {
            fault = read_buffer(call, operand, plc_sat_add32(offset, 1), &high);
        }
        if (fault == RUNGC_OK) {
            *value = plc_join(high, low);
        }
        return fault;
    case RUNGC_OPERAND_KIND_DEVICE:
        return read_pair(call, operand, offset, value);
    default:
        return RUNGC_NO_DEVICE;
    }
}

rungc_fault rungc_write_long(const rungc_call *call, rungc_operand operand, int32_t offset, int32_t value)
{
    rungc_fault fault;
    int16_t before = 0;
    const int32_t next = plc_sat_add32(offset, 1);

    switch (operand.kind) {
    case RUNGC_OPERAND_KIND_NIBBLES:
        return write_group(call, operand, offset, 8u, value);
    case RUNGC_OPERAND_KIND_BUFFER:
        fault = read_buffer(call, operand, next, &before);
        if (fault == RUNGC_OK) {
            fault = write_buffer(call, operand, offset, plc_low(value));
        }
        return (fault != RUNGC_OK) ? fault : write_buffer(call, operand, next, plc_high(value));
    case RUNGC_OPERAND_KIND_DEVICE:
        return write_pair(call, operand, offset, value);
    default:
        return RUNGC_NO_DEVICE;
    }
}

rungc_fault rungc_read(const rungc_call *call, rungc_operand operand, int32_t *value)
{
    int16_t word = 0;
    rungc_fault fault;

    if (call->site.wide) {
        return rungc_read_long(call, operand, 0, value);
    }
    fault = rungc_read_word(call, operand, 0, &word);
    if (fault == RUNGC_OK) {
        *value = word;
    }
    return fault;
}

rungc_fault rungc_write(const rungc_call *call, rungc_operand operand, int32_t value)
{
    return call->site.wide ? rungc_write_long(call, operand, 0, value) : rungc_write_word(call, operand, 0, plc_low(value));
}

rungc_fault rungc_read_unsigned(const rungc_call *call, rungc_operand operand, uint32_t *value)
{
    int32_t number = 0;
    const rungc_fault fault = rungc_read_in(call, operand, 0, INT32_MAX, &number);

    if (fault == RUNGC_OK) {
        *value = (uint32_t)number;
    }
    return fault;
}

rungc_fault rungc_read_in(const rungc_call *call, rungc_operand operand, int32_t least, int32_t most, int32_t *value)
{
    int32_t number = 0;
    const rungc_fault fault = rungc_read(call, operand, &number);

    if (fault != RUNGC_OK) {
        return fault;
    }
    if ((number < least) || (number > most)) {
        return RUNGC_BAD_VALUE;
    }
    *value = number;
    return RUNGC_OK;
}

rungc_fault rungc_read_bits(const rungc_call *call, rungc_operand operand, uint32_t *bits)
{
    int32_t value = 0;
    const rungc_fault fault = rungc_read(call, operand, &value);

    if (fault == RUNGC_OK) {
        *bits = call->site.wide ? (uint32_t)value : (uint16_t)value;
    }
    return fault;
}

bool rungc_is_bit(rungc_operand operand)
{
    return (operand.kind == RUNGC_OPERAND_KIND_WORD_BIT)
        || ((operand.kind == RUNGC_OPERAND_KIND_DEVICE) && (operand.class_ <= RUNGC_CLASS_S));
}

rungc_fault rungc_read_analog(const rungc_call *call, int32_t channel, int16_t *value)
{
    const rungc_hal *const hal = call->map->hal;

    if ((channel < 0) || (channel > UINT8_MAX) || (hal == NULL) || (hal->analog == NULL)) {
        return RUNGC_NO_MODULE;
    }
    return hal->analog(hal->context, (uint8_t)channel, value) ? RUNGC_OK : RUNGC_NO_MODULE;
}

/* Offset of element `n`: two words an element in the 32-bit form, but for 32-bit counters and groups. */
static int32_t element_offset(const rungc_call *call, rungc_operand operand, int32_t n)
{
    const bool is_counter32 = (operand.class_ == RUNGC_CLASS_C) && (operand.value >= RUNGC_FIRST_COUNTER32);
    const bool in_pairs = ((operand.kind == RUNGC_OPERAND_KIND_DEVICE) && !is_counter32)
        || (operand.kind == RUNGC_OPERAND_KIND_BUFFER);

    return (call->site.wide && in_pairs) ? plc_sat_add32(n, n) : n;
}

rungc_fault rungc_read_element(const rungc_call *call, rungc_operand operand, int32_t n, int32_t *value)
{
    const int32_t offset = element_offset(call, operand, n);
    int16_t word = 0;
    rungc_fault fault;

    if (call->site.wide) {
        return rungc_read_long(call, operand, offset, value);
    }
    fault = rungc_read_word(call, operand, offset, &word);
    if (fault == RUNGC_OK) {
        *value = word;
    }
    return fault;
}

rungc_fault rungc_write_element(const rungc_call *call, rungc_operand operand, int32_t n, int32_t value)
{
    const int32_t offset = element_offset(call, operand, n);

    return call->site.wide ? rungc_write_long(call, operand, offset, value)
                           : rungc_write_word(call, operand, offset, plc_low(value));
}

rungc_fault rungc_check_word(const rungc_call *call, rungc_operand operand, int32_t offset)
{
    int16_t word = 0;

    return rungc_read_word(call, operand, offset, &word);
}

rungc_fault rungc_check_bit(const rungc_call *call, rungc_operand operand, int32_t offset)
{
    bool on = false;

    return rungc_read_bit(call, operand, offset, &on);
}

rungc_fault rungc_check_words(const rungc_call *call, rungc_operand operand, int32_t count)
{
    rungc_fault fault = RUNGC_OK;

    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = rungc_check_word(call, operand, i);
    }
    return fault;
}

rungc_fault rungc_check_bits(const rungc_call *call, rungc_operand operand, int32_t count)
{
    rungc_fault fault = RUNGC_OK;

    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        fault = rungc_check_bit(call, operand, i);
    }
    return fault;
}

rungc_fault rungc_check_elements(const rungc_call *call, rungc_operand operand, int32_t count)
{
    rungc_fault fault = RUNGC_OK;

    for (int32_t i = 0; (i < count) && (fault == RUNGC_OK); i++) {
        int32_t value = 0;

        fault = rungc_read_element(call, operand, i, &value);
    }
    return fault;
}

rungc_fault rungc_read_module(const rungc_call *call, uint16_t unit, int32_t address, int16_t *value)
{
    const rungc_hal *const hal = call->map->hal;

    if ((address < 0) || (address > UINT16_MAX) || (hal == NULL) || (hal->read_bfm == NULL)) {
        return RUNGC_NO_MODULE;
    }
    return hal->read_bfm(hal->context, unit, (uint16_t)address, value) ? RUNGC_OK : RUNGC_NO_MODULE;
}

rungc_fault rungc_write_module(const rungc_call *call, uint16_t unit, int32_t address, int16_t value)
{
    const rungc_hal *const hal = call->map->hal;

    if ((address < 0) || (address > UINT16_MAX) || (hal == NULL) || (hal->write_bfm == NULL)) {
        return RUNGC_NO_MODULE;
    }
    return hal->write_bfm(hal->context, unit, (uint16_t)address, value) ? RUNGC_OK : RUNGC_NO_MODULE;
}

/* ---- Operands that emitted code reads and writes by itself ------------------------------------------------------------------------ */

bool rungc_fetch(rungc_map *map, rungc_site site, rungc_operand from, int32_t *value)
{
    rungc_call call = rungc_call_at(map, site);
    const rungc_fault fault = rungc_read(&call, from, value);

    call.site.drive = true;
    rungc_conclude(&call, fault);
    return fault == RUNGC_OK;
}

void rungc_send(rungc_map *map, rungc_site site, rungc_operand to, int32_t value)
{
    rungc_call call = rungc_call_at(map, site);
    const rungc_fault fault = rungc_write(&call, to, value);

    call.site.drive = true;
    rungc_conclude(&call, fault);
}

bool rungc_get_long(rungc_map *map, rungc_class class_, uint32_t number, int32_t *value)
{
    const rungc_call call = rungc_call_at(map, rungc_wide_at(0));

    return rungc_read_long(&call, rungc_device(class_, (int32_t)number), 0, value) == RUNGC_OK;
}

bool rungc_set_long(rungc_map *map, rungc_class class_, uint32_t number, int32_t value)
{
    const rungc_call call = rungc_call_at(map, rungc_wide_at(0));

    return rungc_write_long(&call, rungc_device(class_, (int32_t)number), 0, value) == RUNGC_OK;
}
