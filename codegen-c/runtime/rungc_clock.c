/*
 * rungc_clock.c: the real-time clock and times of day (FNC 160 to 169). A time of day is three words: hour, minute, second.
 */
#include "rungc_operands.h"

enum {
    M_CLOCK_STOP = 8015,
    M_CLOCK_HOLD = 8016,
    M_CLOCK_ADJUST = 8017,
    M_CLOCK_FITTED = 8018,
    M_CLOCK_ERROR = 8019,
    M_ZERO = 8020,
    M_BORROW = 8021,
    M_CARRY = 8022,
    D_SECOND = 8013,
    D_YEAR = D_SECOND + 5,
    D_WEEKDAY = 8019
};

/* Value of D8018 with which a program chooses four digits where the year has two. */
enum { FOUR_DIGITS = 2000 };

/* Words of a moment: year, month, day, hour, minute, second, weekday from Sunday = 0. */
enum { YEAR = 0, MONTH = 1, DAY = 2, HOUR = 3, MINUTE = 4, SECOND = 5, WEEKDAY = 6, WORDS = 7 };

/* Their registers. */
static const uint16_t registers[WORDS] = {8018, 8017, 8016, 8015, 8014, 8013, 8019};

/* ---- Dates ------------------------------------------------------------------------------------------------------------------------ */

static bool is_leap(uint32_t year)
{
    return ((year % 4u) == 0u) && (((year % 100u) != 0u) || ((year % 400u) == 0u));
}

/* Days of a month; 0 for a number that is none. */
static uint32_t days_in_month(uint32_t year, uint32_t month)
{
    static const uint8_t days[13] = {0, 31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

    if (month > 12u) {
        return 0;
    }
    return days[month] + (((month == 2u) && is_leap(year)) ? 1u : 0u);
}

/* Returns true if there is such a moment. The weekday need not agree with the date. */
static bool is_valid(const rungc_clock *clock)
{
    return (clock->day >= 1u) && (clock->day <= days_in_month(clock->year, clock->month)) && (clock->hour < 24u)
        && (clock->minute < 60u) && (clock->second < 60u) && (clock->weekday < 7u);
}

/* The next day. */
static void advance_day(rungc_clock *clock)
{
    clock->weekday = (uint8_t)((clock->weekday + 1u) % 7u);
    if (clock->day < days_in_month(clock->year, clock->month)) {
        clock->day++;
        return;
    }
    clock->day = 1;
    if (clock->month < 12u) {
        clock->month++;
        return;
    }
    clock->month = 1;
    clock->year++;
}

/* The next minute. */
static void advance_minute(rungc_clock *clock)
{
    clock->minute++;
    if (clock->minute == 60u) {
        clock->minute = 0;
        clock->hour++;
    }
    if (clock->hour == 24u) {
        clock->hour = 0;
        advance_day(clock);
    }
}

static bool read_hardware(const rungc_call *call, rungc_clock *clock)
{
    const rungc_hal *const hal = call->map->hal;

    return (hal != NULL) && (hal->clock != NULL) && hal->clock(hal->context, clock);
}

static bool set_hardware(const rungc_call *call, const rungc_clock *clock)
{
    const rungc_hal *const hal = call->map->hal;

    return (hal != NULL) && (hal->set_clock != NULL) && hal->set_clock(hal->context, clock);
}

/* The words of a moment. */
static void split(const rungc_clock *clock, int16_t words[WORDS])
{
    words[YEAR] = plc_int16(clock->year);
    words[MONTH] = clock->month;
    words[DAY] = clock->day;
    words[HOUR] = clock->hour;
    words[MINUTE] = clock->minute;
    words[SECOND] = clock->second;
    words[WEEKDAY] = clock->weekday;
}

/* The year that a word means; negative if it means none. Two digits mean 1980 to 2079 where years are short. */
static int32_t year_of(int16_t word, bool is_short)
{
    if (!is_short) {
        return ((word >= 2000) && (word <= 2099)) ? word : -1;
    }
    if ((word >= 0) && (word <= 99)) {
        return word + ((word < 80) ? 2000 : 1900);
    }
    return word;
}

/* The moment that words mean; false if there is none. */
static bool join(const int16_t words[WORDS], bool is_short, rungc_clock *clock)
{
    const int32_t year = year_of(words[YEAR], is_short);

    for (int i = MONTH; i < WORDS; i++) {
        if ((words[i] < 0) || (words[i] > UINT8_MAX)) {
            return false;
        }
    }
    if (year < 0) {
        return false;
    }
    clock->year = (uint16_t)year;
    clock->month = (uint8_t)words[MONTH];
    clock->day = (uint8_t)words[DAY];
    clock->hour = (uint8_t)words[HOUR];
    clock->minute = (uint8_t)words[MINUTE];
    clock->second = (uint8_t)words[SECOND];
    clock->weekday = (uint8_t)words[WEEKDAY];
    return is_valid(clock);
}

/* The words of the clock's registers; false if all are 0, as in a program that never names them. */
static bool read_shown(const rungc_map *map, int16_t words[WORDS])
{
    bool any = false;

    for (int i = 0; i < WORDS; i++) {
        words[i] = rungc_register(map, registers[i]);
        any = any || (words[i] != 0);
    }
    return any;
}

/* ---- TRD D reads the clock, TWR S sets it ----------------------------------------------------------------------------------------- */

static rungc_fault write_words(const rungc_call *call, rungc_operand d, const int16_t words[WORDS])
{
    rungc_fault fault = rungc_check_words(call, d, WORDS);

    for (int32_t i = 0; (i < WORDS) && (fault == RUNGC_OK); i++) {
        fault = rungc_write_word(call, d, i, words[i]);
    }
    return fault;
}

/* While M8015 stops the clock, its registers are read. */
static rungc_fault read_clock(const rungc_call *call, rungc_operand d, bool is_short)
{
    rungc_clock clock = {0, 0, 0, 0, 0, 0, 0};
    int16_t words[WORDS];

    if (rungc_relay(call->map, M_CLOCK_STOP) && read_shown(call->map, words)) {
        return write_words(call, d, words);
    }
    if (!read_hardware(call, &clock)) {
        return RUNGC_NO_DEVICE;
    }
    split(&clock, words);
    if (is_short) {
        words[YEAR] = (int16_t)(clock.year % 100u);
    }
    return write_words(call, d, words);
}

static rungc_fault trd(const rungc_call *call, const rungc_operand operands[])
{
    return read_clock(call, operands[0], false);
}

/* The year has two digits, unless D8018 shows four. */
static rungc_fault trd_short(const rungc_call *call, const rungc_operand operands[])
{
    return read_clock(call, operands[0], rungc_register(call->map, D_YEAR) <= 99);
}

/* M8019 shows that the words are not a valid moment; then the clock is unchanged. */
static rungc_fault write_clock(const rungc_call *call, rungc_operand s, bool is_short)
{
    rungc_clock clock = {0, 0, 0, 0, 0, 0, 0};
    int16_t words[WORDS] = {0};
    rungc_fault fault = RUNGC_OK;

    for (int32_t i = 0; (i < WORDS) && (fault == RUNGC_OK); i++) {
        fault = rungc_read_word(call, s, i, &words[i]);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const bool valid = join(words, is_short, &clock);

    rungc_set_relay(call->map, M_CLOCK_ERROR, !valid);
    if (!valid) {
        return RUNGC_OK;
    }
    if (rungc_relay(call->map, M_CLOCK_STOP)) {
        /* They set the clock when it turns on. */
        for (int i = 0; i < WORDS; i++) {
            rungc_set_register(call->map, registers[i], words[i]);
        }
    }
    return set_hardware(call, &clock) ? RUNGC_OK : RUNGC_NO_DEVICE;
}

static rungc_fault twr(const rungc_call *call, const rungc_operand operands[])
{
    return write_clock(call, operands[0], false);
}

static rungc_fault twr_short(const rungc_call *call, const rungc_operand operands[])
{
    return write_clock(call, operands[0], true);
}

void rungc_trd(rungc_map *map, rungc_site site, rungc_operand d)
{
    const rungc_operand operands[] = {d};

    rungc_run(map, site, operands, trd);
}

void rungc_trd_short(rungc_map *map, rungc_site site, rungc_operand d)
{
    const rungc_operand operands[] = {d};

    rungc_run(map, site, operands, trd_short);
}

void rungc_twr(rungc_map *map, rungc_site site, rungc_operand s)
{
    const rungc_operand operands[] = {s};

    rungc_run(map, site, operands, twr);
}

void rungc_twr_short(rungc_map *map, rungc_site site, rungc_operand s)
{
    const rungc_operand operands[] = {s};

    rungc_run(map, site, operands, twr_short);
}

/* ---- The clock's registers and relays, once a scan before the program ------------------------------------------------------------- */

/* Words that keep M8015 and M8017 of the last scan, the moment at which the clock was stopped, and whether four digits were chosen. */
enum { KEPT_STOP = 0, KEPT_ADJUST = 1, KEPT_DATE = 2, KEPT_TIME = 3, KEPT_LONG_YEAR = 4 };

static void keep_moment(int32_t kept[], const rungc_clock *clock)
{
    kept[KEPT_DATE] = plc_int32(((uint32_t)clock->year << 16) | ((uint32_t)clock->month << 8) | clock->day);
    kept[KEPT_TIME] = plc_int32(((uint32_t)clock->weekday << 24) | ((uint32_t)clock->hour << 16) | ((uint32_t)clock->minute << 8)
                                | clock->second);
}

static void kept_moment(const int32_t kept[], int16_t words[WORDS])
{
    const uint32_t date = (uint32_t)kept[KEPT_DATE];
    const uint32_t time = (uint32_t)kept[KEPT_TIME];

    words[YEAR] = plc_int16(date >> 16);
    words[MONTH] = (int16_t)((date >> 8) & 255u);
    words[DAY] = (int16_t)(date & 255u);
    words[HOUR] = (int16_t)((time >> 16) & 255u);
    words[MINUTE] = (int16_t)((time >> 8) & 255u);
    words[SECOND] = (int16_t)(time & 255u);
    words[WEEKDAY] = (int16_t)(time >> 24);
}

/* The fall of M8015 sets the clock from the registers, whose year may have two digits; or from when it stopped. */
static void start_clock(const rungc_call *call, const int32_t kept[], bool is_short, rungc_clock *now)
{
    rungc_clock clock = {0, 0, 0, 0, 0, 0, 0};
    int16_t stopped[WORDS];
    int16_t words[WORDS];

    kept_moment(kept, stopped);
    if (!read_shown(call->map, words)) {
        (void)memcpy(words, stopped, sizeof words);
    }
    if (!is_short && (words[YEAR] >= 0) && (words[YEAR] <= 99)) {
        words[YEAR] = (int16_t)(words[YEAR] + 2000);
    }
    bool valid = join(words, is_short, &clock);

    rungc_set_relay(call->map, M_CLOCK_ERROR, !valid);
    valid = valid || join(stopped, true, &clock);
    if (valid) {
        (void)set_hardware(call, &clock);
        *now = clock;
    }
}

/* M8016 holds the registers. */
static void show_clock(const rungc_map *map, const rungc_clock *now, bool two_digits)
{
    int16_t words[WORDS];

    split(now, words);
    if (two_digits) {
        words[YEAR] = (int16_t)(now->year % 100u);
    }
    for (int i = 0; i < WORDS; i++) {
        rungc_set_register(map, registers[i], words[i]);
    }
}

static rungc_fault refresh(const rungc_call *call, bool is_short)
{
    const rungc_map *const map = call->map;
    int32_t *const kept = rungc_kept(call);
    rungc_clock now = {0, 0, 0, 0, 0, 0, 0};
    const bool fitted = read_hardware(call, &now);

    rungc_set_relay(map, M_CLOCK_FITTED, fitted);
    if (!fitted) {
        return RUNGC_OK;
    }
    const bool stop = rungc_relay(map, M_CLOCK_STOP);
    const bool adjust = rungc_relay(map, M_CLOCK_ADJUST);
    const bool was_stopped = kept[KEPT_STOP] != 0;

    if (is_short && !stop && !was_stopped && (rungc_register(map, D_YEAR) == FOUR_DIGITS)) {
        kept[KEPT_LONG_YEAR] = 1;
    }
    if (stop && !was_stopped) {
        keep_moment(kept, &now);
    }
    if (!stop && was_stopped) {
        start_clock(call, kept, is_short, &now);
    }
    if (adjust && (kept[KEPT_ADJUST] == 0)) {
        /* The rise of M8017 rounds to a minute. */
        const bool up = now.second >= 30u;

        now.second = 0;
        if (up) {
            advance_minute(&now);
        }
        (void)set_hardware(call, &now);
    }
    kept[KEPT_STOP] = stop ? 1 : 0;
    kept[KEPT_ADJUST] = adjust ? 1 : 0;
    if (!stop && !rungc_relay(map, M_CLOCK_HOLD)) {
        show_clock(map, &now, is_short && (kept[KEPT_LONG_YEAR] == 0));
    }
    return RUNGC_OK;
}

static rungc_fault clock_refresh(const rungc_call *call, const rungc_operand operands[])
{
    (void)operands;
    return refresh(call, false);
}

/* Where the year has two digits, unless a program chooses four. */
static rungc_fault clock_refresh_short(const rungc_call *call, const rungc_operand operands[])
{
    (void)operands;
    return refresh(call, true);
}

void rungc_clock_refresh(rungc_map *map, rungc_site site)
{
    rungc_run(map, site, NULL, clock_refresh);
}

void rungc_clock_refresh_short(rungc_map *map, rungc_site site)
{
    rungc_run(map, site, NULL, clock_refresh_short);
}

/* ---- TCMP S1 S2 S3 S D compares times, TZCP S1 S2 S D with a zone ------------------------------------------------------------------ */

/* A time of day that is only compared. */
typedef struct time_of_day {
    int16_t words[3];
} time_of_day;

static rungc_fault read_time(const rungc_call *call, rungc_operand operand, time_of_day *time)
{
    rungc_fault fault = RUNGC_OK;

    for (int32_t i = 0; (i < 3) && (fault == RUNGC_OK); i++) {
        fault = rungc_read_word(call, operand, i, &time->words[i]);
    }
    return fault;
}

static bool is_before(const time_of_day *a, const time_of_day *b)
{
    for (int i = 0; i < 3; i++) {
        if (a->words[i] != b->words[i]) {
            return a->words[i] < b->words[i];
        }
    }
    return false;
}

/* D, D+1 or D+2 is on as the time is before, inside or after the zone. */
static rungc_fault write_zone(const rungc_call *call, rungc_operand d, const time_of_day *time, const time_of_day *low,
                              const time_of_day *high)
{
    const bool below = is_before(time, low);
    const bool above = !below && is_before(high, time);
    rungc_fault fault = rungc_check_bits(call, d, 3);

    if (fault == RUNGC_OK) {
        fault = rungc_write_bit(call, d, 0, below);
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_bit(call, d, 1, !below && !above);
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_bit(call, d, 2, above);
}

static rungc_fault tcmp(const rungc_call *call, const rungc_operand operands[])
{
    time_of_day set = {{0, 0, 0}};
    time_of_day time = {{0, 0, 0}};
    rungc_fault fault = RUNGC_OK;

    for (int i = 0; (i < 3) && (fault == RUNGC_OK); i++) {
        fault = rungc_read_word(call, operands[i], 0, &set.words[i]);
    }
    if (fault == RUNGC_OK) {
        fault = read_time(call, operands[3], &time);
    }
    return (fault != RUNGC_OK) ? fault : write_zone(call, operands[4], &time, &set, &set);
}

static rungc_fault tzcp(const rungc_call *call, const rungc_operand operands[])
{
    time_of_day low = {{0, 0, 0}};
    time_of_day high = {{0, 0, 0}};
    time_of_day time = {{0, 0, 0}};
    rungc_fault fault = read_time(call, operands[0], &low);

    if (fault == RUNGC_OK) {
        fault = read_time(call, operands[1], &high);
    }
    if (fault == RUNGC_OK) {
        fault = read_time(call, operands[2], &time);
    }
    return (fault != RUNGC_OK) ? fault : write_zone(call, operands[3], &time, &low, &high);
}

void rungc_tcmp(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand s3, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, s3, s, d};

    rungc_run(map, site, operands, tcmp);
}

void rungc_tzcp(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, s, d};

    rungc_run(map, site, operands, tzcp);
}

/* ---- TADD, TSUB S1 S2 D: sum and difference of times; HTOS S D, STOH S D: seconds of a time, and back ------------------------------- */

enum { DAY_S = 86400 };

/* Seconds of hours up to `most`, minutes and seconds. */
static rungc_fault read_seconds(const rungc_call *call, rungc_operand operand, int16_t most, int32_t *seconds)
{
    time_of_day time = {{0, 0, 0}};
    const rungc_fault fault = read_time(call, operand, &time);
    const int16_t *const words = time.words;

    if (fault != RUNGC_OK) {
        return fault;
    }
    if ((words[0] < 0) || (words[0] > most) || (words[1] < 0) || (words[1] > 59) || (words[2] < 0) || (words[2] > 59)) {
        return RUNGC_BAD_VALUE;
    }
    *seconds = (((words[0] * 60) + words[1]) * 60) + words[2];
    return RUNGC_OK;
}

static rungc_fault write_time(const rungc_call *call, rungc_operand operand, int32_t seconds)
{
    rungc_fault fault = rungc_check_words(call, operand, 3);

    if (fault == RUNGC_OK) {
        fault = rungc_write_word(call, operand, 0, (int16_t)(seconds / 3600));
    }
    if (fault == RUNGC_OK) {
        fault = rungc_write_word(call, operand, 1, (int16_t)((seconds / 60) % 60));
    }
    return (fault != RUNGC_OK) ? fault : rungc_write_word(call, operand, 2, (int16_t)(seconds % 60));
}

/* A day is taken off, and added; M8022 and M8021 show that. */
static rungc_fault add_times(const rungc_call *call, const rungc_operand operands[], bool subtracts)
{
    int32_t first = 0;
    int32_t second = 0;
    rungc_fault fault = read_seconds(call, operands[0], 23, &first);

    if (fault == RUNGC_OK) {
        fault = read_seconds(call, operands[1], 23, &second);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const int32_t result = subtracts ? first - second : first + second;
    const int32_t of_day = (result + DAY_S) % DAY_S;

    fault = write_time(call, operands[2], of_day);
    if (fault == RUNGC_OK) {
        rungc_set_relay(call->map, M_ZERO, of_day == 0);
        rungc_set_relay(call->map, subtracts ? M_BORROW : M_CARRY, subtracts ? (result < 0) : (result >= DAY_S));
    }
    return fault;
}

static rungc_fault tadd(const rungc_call *call, const rungc_operand operands[])
{
    return add_times(call, operands, false);
}

static rungc_fault tsub(const rungc_call *call, const rungc_operand operands[])
{
    return add_times(call, operands, true);
}

/* An error if D cannot hold them. */
static rungc_fault htos(const rungc_call *call, const rungc_operand operands[])
{
    int32_t seconds = 0;
    const rungc_fault fault = read_seconds(call, operands[0], INT16_MAX, &seconds);

    if ((fault == RUNGC_OK) && !call->site.wide && (seconds > INT16_MAX)) {
        return RUNGC_BAD_VALUE;
    }
    return (fault != RUNGC_OK) ? fault : rungc_write(call, operands[1], seconds);
}

/* 32767 hours at most. */
static rungc_fault stoh(const rungc_call *call, const rungc_operand operands[])
{
    int32_t seconds = 0;
    const rungc_fault fault = rungc_read_in(call, operands[0], 0, (INT16_MAX * 3600) + 3599, &seconds);

    return (fault != RUNGC_OK) ? fault : write_time(call, operands[1], seconds);
}

void rungc_tadd(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, d};

    rungc_run(map, site, operands, tadd);
}

void rungc_tsub(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, d};

    rungc_run(map, site, operands, tsub);
}

void rungc_htos(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, htos);
}

void rungc_stoh(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, stoh);
}
