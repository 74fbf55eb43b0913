/*
 * rungc_devices.c: the devices of a program by number, and the errors of its instructions.
 */
#include "rungc_devices.h"

/* Location of a device. `at` is NULL if the model has it but the program does not look at it. */
typedef struct found {
    bool exists;
    rungc_area_kind kind;
    void *at;
} found;

/* Devices of a size in bytes, by rungc_area_kind. */
static const uint8_t device_size[] = {sizeof(bool), sizeof(int16_t), sizeof(plc_timer), sizeof(plc_counter16),
                                      sizeof(plc_counter32)};

/* The device in this area, if that stores it; otherwise `at` is NULL. */
static found in_area(const rungc_map *map, const rungc_area *area, rungc_class device_class, uint32_t number)
{
    found device = {false, area->kind, NULL};
    uint32_t place = number - area->first;

    if ((area->class_ != device_class) || (place >= area->count)) {
        return device;
    }
    if (area->columns > 1u) {
        const uint32_t column = place % area->columns;
        const uint32_t rows = (area->count + area->columns - 1u) / area->columns;

        if (column >= area->stored_columns) {
            return device;
        }
        place = (column * rows) + (place / area->columns);
    }
    device.exists = true;
    device.at = rungc_part_at(map, area->offset + ((size_t)place * device_size[area->kind]));
    return device;
}

/* The device in any area, by a binary search. */
static found in_areas(const rungc_map *map, rungc_class device_class, uint32_t number)
{
    const rungc_area *const areas = map->layout->areas;
    const found none = {false, RUNGC_AREA_KIND_BITS, NULL};
    size_t first = 0;
    size_t end = map->layout->area_count;

    while (first < end) {
        const size_t middle = first + ((end - first) / 2u);
        const rungc_area *const area = &areas[middle];

        if ((area->class_ < device_class) || ((area->class_ == device_class) && (area->first <= number))) {
            first = middle + 1u;
        } else {
            end = middle;
        }
    }
    return (first > 0u) ? in_area(map, &areas[first - 1u], device_class, number) : none;
}

/* The index register whose other name is a special register. */
static const rungc_alias *alias_of(const rungc_layout *layout, rungc_class device_class, uint32_t number)
{
    if (device_class == RUNGC_CLASS_D) {
        for (size_t i = 0; i < layout->alias_count; i++) {
            if ((layout->aliases[i].number == number) && (layout->aliases[i].class_ != RUNGC_CLASS_D)) {
                return &layout->aliases[i];
            }
        }
    }
    return NULL;
}

/* Returns true if the model has a device. */
static bool of_model(const rungc_layout *layout, rungc_class device_class, uint32_t number)
{
    for (size_t i = 0; i < layout->range_count; i++) {
        const rungc_range *const range = &layout->ranges[i];

        if ((range->class_ == device_class) && (number >= range->first) && (number <= range->last)) {
            return true;
        }
    }
    return false;
}

static found find(const rungc_map *map, uint8_t area, rungc_class device_class, uint32_t number)
{
    const rungc_layout *const layout = map->layout;
    found device = {false, RUNGC_AREA_KIND_BITS, NULL};

    /* Operands count areas from the last one. */
    if ((area > 0u) && (area <= layout->area_count)) {
        device = in_area(map, &layout->areas[layout->area_count - area], device_class, number);
    }
    if (!device.exists) {
        device = in_areas(map, device_class, number);
    }
    if (!device.exists) {
        const rungc_alias *const alias = alias_of(layout, device_class, number);

        if (alias != NULL) {
            device = in_areas(map, alias->class_, alias->index);
            device.exists = device.exists || of_model(layout, alias->class_, alias->index);
        } else {
            device.exists = of_model(layout, device_class, number);
        }
    }
    return device;
}

/* Returns true if devices of a class have a state. */
static bool has_bits(rungc_class device_class)
{
    return device_class <= RUNGC_CLASS_C;
}

/* Returns true if a device has a value of 16 bits. */
static bool has_word(rungc_class device_class, uint32_t number)
{
    if (device_class == RUNGC_CLASS_C) {
        return number < (uint32_t)RUNGC_FIRST_COUNTER32;
    }
    return device_class > RUNGC_CLASS_S;
}

bool rungc_find_word(const rungc_map *map, uint8_t area, rungc_class device_class, uint32_t number, int16_t **word)
{
    found device = find(map, area, device_class, number);

    *word = NULL;
    if (device.at == NULL) {
        return device.exists && has_word(device_class, number);
    }
    switch (device.kind) {
    case RUNGC_AREA_KIND_WORDS:
        *word = device.at;
        return true;
    case RUNGC_AREA_KIND_TIMERS:
        *word = &((plc_timer *)device.at)->value;
        return true;
    case RUNGC_AREA_KIND_COUNTERS16:
        *word = &((plc_counter16 *)device.at)->value;
        return true;
    default:
        return false;
    }
}

bool rungc_find_bit(const rungc_map *map, uint8_t area, rungc_class device_class, uint32_t number, bool **bit)
{
    found device = find(map, area, device_class, number);

    *bit = NULL;
    if (device.at == NULL) {
        return device.exists && has_bits(device_class);
    }
    switch (device.kind) {
    case RUNGC_AREA_KIND_BITS:
        *bit = device.at;
        return true;
    case RUNGC_AREA_KIND_TIMERS:
        *bit = &((plc_timer *)device.at)->done;
        return true;
    case RUNGC_AREA_KIND_COUNTERS16:
        *bit = &((plc_counter16 *)device.at)->done;
        return true;
    case RUNGC_AREA_KIND_COUNTERS32:
        *bit = &((plc_counter32 *)device.at)->done;
        return true;
    default:
        return false;
    }
}

bool rungc_find_counter32(const rungc_map *map, uint32_t number, int32_t **value)
{
    found device = find(map, 0u, RUNGC_CLASS_C, number);

    *value = NULL;
    if (device.at == NULL) {
        return device.exists && (number >= (uint32_t)RUNGC_FIRST_COUNTER32);
    }
    if (device.kind == RUNGC_AREA_KIND_COUNTERS32) {
        *value = &((plc_counter32 *)device.at)->value;
        return true;
    }
    return false;
}

bool rungc_reset_device(const rungc_map *map, rungc_class device_class, uint32_t number)
{
    found device = find(map, 0u, device_class, number);

    if (device.at == NULL) {
        return device.exists && ((device_class == RUNGC_CLASS_T) || (device_class == RUNGC_CLASS_C));
    }
    switch (device.kind) {
    case RUNGC_AREA_KIND_TIMERS:
        plc_timer_reset(device.at);
        return true;
    case RUNGC_AREA_KIND_COUNTERS16:
        plc_count16_reset((plc_counter16 *)device.at);
        return true;
    case RUNGC_AREA_KIND_COUNTERS32:
        plc_count32_reset((plc_counter32 *)device.at);
        return true;
    default:
        return false;
    }
}

const plc_sys *rungc_sys(const rungc_map *map)
{
    return rungc_part_at(map, map->layout->sys);
}

int32_t *rungc_kept(const rungc_call *call)
{
    const rungc_layout *const layout = call->map->layout;
    const uint16_t slot = call->site.slot;

    if ((slot == 0u) || (slot > layout->state_count)) {
        return call->map->none._0;
    }
    rungc_state *const states = rungc_part_at(call->map, layout->states);
    return states[slot - 1u]._0;
}

bool rungc_relay(const rungc_map *map, uint16_t number)
{
    bool *bit = NULL;

    return (number > 0u) && rungc_find_bit(map, 0u, RUNGC_CLASS_M, number, &bit) && (bit != NULL) && *bit;
}

void rungc_set_relay(const rungc_map *map, uint16_t number, bool on)
{
    bool *bit = NULL;

    if ((number > 0u) && rungc_find_bit(map, 0u, RUNGC_CLASS_M, number, &bit) && (bit != NULL)) {
        *bit = on;
    }
}

int16_t rungc_register(const rungc_map *map, uint32_t number)
{
    int16_t *word = NULL;

    return (rungc_find_word(map, 0u, RUNGC_CLASS_D, number, &word) && (word != NULL)) ? *word : 0;
}

void rungc_set_register(const rungc_map *map, uint32_t number, int16_t value)
{
    int16_t *word = NULL;

    if (rungc_find_word(map, 0u, RUNGC_CLASS_D, number, &word) && (word != NULL)) {
        *word = value;
    }
}

int32_t rungc_long_register(const rungc_map *map, uint32_t low)
{
    return plc_join(rungc_register(map, low + 1u), rungc_register(map, low));
}

void rungc_set_long_register(const rungc_map *map, uint32_t low, int32_t value)
{
    rungc_set_register(map, low, plc_low(value));
    rungc_set_register(map, low + 1u, plc_high(value));
}

/* ---- Devices by number, for hosts ------------------------------------------------------------------------------------------------- */

bool rungc_get_bit(const rungc_map *map, rungc_class class_, uint32_t number, bool *on)
{
    bool *bit = NULL;
    const bool exists = rungc_find_bit(map, 0u, class_, number, &bit);

    if (exists) {
        *on = (bit != NULL) && *bit;
    }
    return exists;
}

bool rungc_set_bit(rungc_map *map, rungc_class class_, uint32_t number, bool on)
{
    bool *bit = NULL;
    const bool exists = rungc_find_bit(map, 0u, class_, number, &bit);

    if (bit != NULL) {
        *bit = on;
    }
    return exists;
}

bool rungc_get_word(const rungc_map *map, rungc_class class_, uint32_t number, int16_t *value)
{
    int16_t *word = NULL;
    const bool exists = rungc_find_word(map, 0u, class_, number, &word);

    if (exists) {
        *value = (word != NULL) ? *word : 0;
    }
    return exists;
}

bool rungc_set_word(rungc_map *map, rungc_class class_, uint32_t number, int16_t value)
{
    int16_t *word = NULL;
    const bool exists = rungc_find_word(map, 0u, class_, number, &word);

    if (word != NULL) {
        *word = value;
    }
    return exists;
}

/* ---- Errors ----------------------------------------------------------------------------------------------------------------------- */

/* Capacity of the error log. */
#define LOGGED 10u

/* Enters an error in the log: after the others, the oldest making place; a code that is there takes the new time and keeps its place. */
static void log_code(const rungc_map *map, uint16_t code)
{
    const int32_t hours = rungc_long_register(map, RUNGC_D_RUN_TIME) / 3600;
    const int16_t logged = plc_int16(code);
    uint32_t place = 0;

    while (place < LOGGED) {
        const int16_t there = rungc_register(map, RUNGC_D_LOGGED_CODES + place);

        if ((there == 0) || (there == logged)) {
            break;
        }
        place++;
    }
    if (place == LOGGED) {
        place = LOGGED - 1u;
        for (uint32_t i = 0; i < place; i++) {
            rungc_set_register(map, RUNGC_D_LOGGED_HOURS + i, rungc_register(map, RUNGC_D_LOGGED_HOURS + i + 1u));
            rungc_set_register(map, RUNGC_D_LOGGED_CODES + i, rungc_register(map, RUNGC_D_LOGGED_CODES + i + 1u));
        }
    }
    rungc_set_register(map, RUNGC_D_LOGGED_HOURS + place, plc_low(hours));
    rungc_set_register(map, RUNGC_D_LOGGED_CODES + place, logged);
}

/* Reports an error to the host. */
static void note(const rungc_map *map, uint16_t code, uint16_t step)
{
    const rungc_layout *const layout = map->layout;

    if (layout->error > 0u) {
        plc_error *const error = rungc_part_at(map, layout->error);

        error->code = code;
        error->step = step;
    }
    if (layout->on_error > 0u) {
        plc_on_error *const *const on_error = rungc_part_at(map, layout->on_error);

        if (*on_error != NULL) {
            (*on_error)(map->plc, code, step);
        }
    }
}

/* The code that the model has for an error. */
static uint16_t code_of(const rungc_layout *layout, rungc_fault fault)
{
    const bool has_codes_of_values = layout->value_error == (uint16_t)RUNGC_BAD_VALUE;

    switch (fault) {
    case RUNGC_BAD_VALUE:
        return layout->value_error;
    case RUNGC_NO_MODULE:
        return has_codes_of_values ? 6750u : 6708u;
    default:
        return fault;
    }
}

void rungc_conclude(const rungc_call *call, rungc_fault fault)
{
    const rungc_map *const map = call->map;
    const uint16_t code = code_of(map->layout, fault);
    const uint16_t step = (uint16_t)call->site.step;
    const uint16_t relay = map->layout->error_relay;

    if ((fault == RUNGC_OK) || !call->site.drive) {
        return;
    }
    note(map, code, step);
    if (relay != (uint16_t)RUNGC_M_OPERATION_ERROR) {
        /* HM shows the step in the register of the same number. */
        rungc_set_relay(map, relay, true);
        rungc_set_register(map, relay, plc_int16(step));
        return;
    }
    if (!rungc_relay(map, RUNGC_M_FIRST_ERROR)) {
        rungc_set_relay(map, RUNGC_M_FIRST_ERROR, true);
        rungc_set_register(map, RUNGC_D_FIRST_ERROR_STEP, plc_int16(step));
    }
    rungc_set_register(map, RUNGC_D_ERROR_STEP, plc_int16(step));
    rungc_set_relay(map, relay, true);
    rungc_set_register(map, relay, plc_int16(code));
    rungc_set_relay(map, RUNGC_M_ANY_ERROR, true);
    rungc_set_register(map, RUNGC_D_ANY_ERROR, plc_int16(0x8067u));
    if (map->layout->logs_errors) {
        log_code(map, code);
    }
}

/* The program itself has found an error. */
void rungc_log_error(rungc_map *map, rungc_site site, rungc_operand n)
{
    (void)site;
    log_code(map, (uint16_t)n.value);
}
