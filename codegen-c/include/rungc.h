/*
 * rungc.h: what programs compiled by rungc have in common: timers, counters, edges and wrapping arithmetic.
 *
 * Plain C99, nothing to link. Integers are two's complement and wrap; every operation is written so that no input makes it
 * undefined. The structs have the same layout as those of the runtime library (rungc_rt.h).
 */
#ifndef RUNGC_H
#define RUNGC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Elapsed time by a clock that may begin anywhere and wraps. Time never goes back: a reading that is up to a second back lets no time
   pass until the clock has caught up; one further before is that of a clock that was set, and time continues from there. */
typedef struct plc_stopwatch {
    uint32_t reading; /* the latest reading that let time pass */
    uint32_t elapsed; /* time since the first reading, wrapping */
} plc_stopwatch;

/* Time and mode, set by the scan function. */
typedef struct plc_sys {
    uint32_t now_ms;     /* time from the first scan to this one, wrapping; constant within a scan */
    uint32_t dt_ms;      /* from the start of the previous scan to the start of this one */
    uint32_t scan_us;    /* duration of the last scan, at most that of 32767 in D8010 */
    plc_stopwatch clock; /* the host's clock, read at scans and ticks */
    bool first_scan;     /* first scan since RUN began */
    bool running;        /* RUN, not STOP */
    uint16_t scan;       /* another odd number in each scan, wrapping; 0 before the first */
    uint16_t minute_ms;  /* time since the first scan, from 0 again after a minute */
} plc_sys;

/* Reason for STOP, other than the RUN/STOP switch. */
enum {
    PLC_STOP_NONE = 0,
    PLC_STOP_M8037 = 1,      /* the program, by M8037 */
    PLC_STOP_WATCHDOG = 6105 /* the watchdog: a scan did not end */
};

/* Last error since RUN began, recorded even if the program does not use the special devices. */
typedef struct plc_error {
    uint16_t code;      /* the PLC's code of the last operation error, e.g. 6706; 0 if there was none */
    uint16_t step;      /* step of the instruction that it happened to */
    uint16_t stop;      /* reason for STOP */
    uint16_t stop_step; /* step of the loop or the jump that the watchdog found too long */
} plc_error;

/* Callback of a host for operation errors: it gets the program's struct, the PLC's code and the step of the instruction. */
typedef void plc_on_error(const void *plc, uint16_t code, uint16_t step);

/* A timer: .done is its contact, .value its current value in units. */
typedef struct plc_timer {
    int16_t value;   /* current value */
    int16_t preset;  /* preset it runs to, if stored */
    uint16_t coil;   /* 0 if its coil was off when last executed, else the scan of that where it matters, else 1 */
    uint8_t part_ms; /* time since the last whole unit */
    bool done;       /* contact */
} plc_timer;

/* A 16-bit up counter: .done is its contact. */
typedef struct plc_counter16 {
    int16_t value; /* current value */
    bool coil;     /* state of its coil at the last execution */
    bool done;     /* contact */
} plc_counter16;

/* A 32-bit up/down counter: .done is its contact. */
typedef struct plc_counter32 {
    int32_t value; /* current value */
    bool coil;     /* state of its coil at the last execution */
    bool done;     /* contact */
} plc_counter32;

/* Result of a part of a program where jumps do not nest: the number of the next part, or one of these. */
enum {
    PLC_LEAVE = -1, /* return from the program or subroutine */
    PLC_GO_ON = 0   /* go on behind the parts */
};

/* ---- Scan cycle ----------------------------------------------------------------------------------------------------- */

/* A second of the host's clock, and the longest duration of a scan that D8010 shows. */
#define PLC_SECOND_MS 1000u
#define PLC_MOST_SCAN_US 3276700u

/* A stopwatch begins at a reading. */
static inline void plc_stopwatch_begin(volatile plc_stopwatch *watch, uint32_t reading)
{
    watch->reading = reading;
    watch->elapsed = 0;
}

/* Takes a reading of a clock whose second has `second` units; returns the time that has passed since the last one. */
static inline uint32_t plc_stopwatch_advance(volatile plc_stopwatch *watch, uint32_t reading, uint32_t second)
{
    const uint32_t last = watch->reading;
    const uint32_t passed = reading - last;

    if (passed <= UINT32_MAX / 2u) {
        watch->reading = reading;
        watch->elapsed += passed;
        return passed;
    }
    if (last - reading > second) {
        watch->reading = reading;
    }
    return 0;
}

/* Lets a period in milliseconds end; returns true if one has. Periods that no one looked at are skipped. */
static inline bool plc_stopwatch_ends(volatile plc_stopwatch *watch, uint32_t now_ms, uint32_t length_ms)
{
    (void)plc_stopwatch_advance(watch, now_ms, PLC_SECOND_MS);
    const uint32_t elapsed = watch->elapsed;
    if (elapsed < length_ms) {
        return false;
    }
    watch->elapsed = elapsed % length_ms;
    return true;
}

/* Power on: in RUN, before the first scan. */
static inline void plc_power_on(plc_sys *sys)
{
    (void)memset(sys, 0, sizeof *sys);
    sys->first_scan = true;
    sys->running = true;
}

/* Time has passed between two scans, to this reading of the host's clock. */
static inline void plc_pass(plc_sys *sys, uint32_t now_ms)
{
    if (sys->scan == 0u) {
        plc_stopwatch_begin(&sys->clock, now_ms);
    }
    (void)plc_stopwatch_advance(&sys->clock, now_ms, PLC_SECOND_MS);
}

/* The time by the host's clock, in microseconds, wrapping. */
static inline uint32_t plc_now_us(const plc_sys *sys)
{
    return sys->clock.reading * 1000u;
}

/* A scan begins, in RUN or in STOP. */
static inline void plc_begin_scan(plc_sys *sys, uint32_t now_ms, uint32_t scan_us)
{
    plc_pass(sys, now_ms);
    const uint32_t passed = sys->clock.elapsed - sys->now_ms;
    const uint32_t minute_ms = sys->minute_ms + passed;
    sys->dt_ms = sys->first_scan ? 0u : passed;
    sys->now_ms = sys->clock.elapsed;
    sys->scan_us = (scan_us < PLC_MOST_SCAN_US) ? scan_us : PLC_MOST_SCAN_US;
    sys->scan = (uint16_t)((sys->scan + 2u) | 1u);
    sys->minute_ms = (uint16_t)((minute_ms < 60000u) ? minute_ms : (minute_ms % 60000u));
}

/* Clears the bytes of a struct from offset `from` up to offset `to`. */
static inline void plc_clear(void *plc, size_t from, size_t to)
{
    (void)memset((unsigned char *)plc + from, 0, to - from);
}

/* ---- Runs of devices ------------------------------------------------------------------------------------------------ */

/* Copies bits, as if all were read before one is written. */
static inline void plc_copy_bits(bool *to, const bool *from, size_t count)
{
    (void)memmove(to, from, count * sizeof *to);
}

/* Copies words likewise. */
static inline void plc_copy_words(int16_t *to, const int16_t *from, size_t count)
{
    (void)memmove(to, from, count * sizeof *to);
}

/* Switches bits on or off. */
static inline void plc_fill_bits(bool *to, size_t count, bool on)
{
    for (size_t i = 0; i < count; i++) {
        to[i] = on;
    }
}

/* Writes a value to words. */
static inline void plc_fill_words(int16_t *to, size_t count, int16_t value)
{
    for (size_t i = 0; i < count; i++) {
        to[i] = value;
    }
}

/* ---- Edges ---------------------------------------------------------------------------------------------------------- */

/* Returns true if `input` went from off to on since the last call with this memory. */
static inline bool plc_rising(bool *memory, bool input)
{
    const bool before = *memory;
    *memory = input;
    return input & !before;
}

/* Returns true if `input` went from on to off since the last call with this memory. */
static inline bool plc_falling(bool *memory, bool input)
{
    const bool before = *memory;
    *memory = input;
    return before & !input;
}

/* Returns the state of the memory, and switches it off. */
static inline bool plc_take(bool *memory)
{
    return plc_falling(memory, false);
}

/* Bits are read as words below. */
typedef char plc_bool_is_one_byte[(sizeof(bool) == 1u) ? 1 : -1];

/* Not 0 if any of `count` bits is on, 4 to 16 of them: two reads, which may overlap. */
static inline uint64_t plc_any(const bool *bits, size_t count)
{
    if (count < 8u) {
        uint32_t first;
        uint32_t last;
        (void)memcpy(&first, bits, sizeof first);
        (void)memcpy(&last, bits + (count - sizeof last), sizeof last);
        return first | last;
    } else {
        uint64_t first;
        uint64_t last;
        (void)memcpy(&first, bits, sizeof first);
        (void)memcpy(&last, bits + (count - sizeof last), sizeof last);
        return first | last;
    }
}

/* Returns true if any of some neighbouring states is on, or has to be left: then their blocks run. */
static inline bool plc_active(const bool *states, size_t count, const bool *memories, size_t number)
{
    return (plc_any(states, count) | plc_any(memories, number)) != 0u;
}

/* ---- Step ladders --------------------------------------------------------------------------------------------------- */

/* Functions that few scans call are not inline. */
#if defined(__GNUC__)
#define PLC_RARE static __attribute__((noinline, unused))
#define PLC_OFTEN static inline __attribute__((always_inline))
#else
#define PLC_RARE static inline
#define PLC_OFTEN static inline
#endif

/* Up to 32 blocks of a step ladder whose states are neighbours, a bit for each. A block runs while its state is on, and once more
   when it has gone off. */
typedef struct plc_steps {
    uint32_t seen;   /* the states, as plc_seen has read them */
    uint32_t on;     /* the same, a bit for each */
    uint32_t was_on; /* blocks whose states were on when they ran last */
    uint32_t left;   /* states that a transition left: they go off in the next scan */
} plc_steps;

/* Four of `count` bits as they are in memory: those from number `from` on, or the last ones. */
PLC_OFTEN uint32_t plc_four(const bool *bits, size_t from, size_t count)
{
    uint32_t four;
    (void)memcpy(&four, &bits[((from + 4u) <= count) ? from : (count - 4u)], sizeof four);
    return four;
}

/* A number that changes with each of 4 to 32 bits: each byte of a bit has seven free ones beside it. Few instructions, in contrast
   to plc_gather. */
PLC_OFTEN uint32_t plc_seen(const bool *bits, size_t count)
{
    return plc_four(bits, 0u, count) | (plc_four(bits, 4u, count) << 1) | (plc_four(bits, 8u, count) << 2)
        | (plc_four(bits, 12u, count) << 3) | (plc_four(bits, 16u, count) << 4) | (plc_four(bits, 20u, count) << 5)
        | (plc_four(bits, 24u, count) << 6) | (plc_four(bits, 28u, count) << 7);
}

/* Up to 32 bits as a number, the first one as bit 0. */
static inline uint32_t plc_gather(const bool *bits, size_t count)
{
    /* Moves the first bit of each of four bytes to bits 24 to 27, and those 4 bits further up to bits 28 to 31: the lowest byte
       is the first or the last one. */
    const uint32_t one = 1;
    uint8_t first;
    (void)memcpy(&first, &one, 1);
    const uint32_t places = (first == 1u) ? 0x01020408u : 0x08040201u;

    uint32_t word = 0;
    const size_t rest = count % 8u;
    for (size_t i = count; i != rest; i -= 8u) {
        uint32_t low;
        uint32_t high;
        (void)memcpy(&low, &bits[i - 8u], sizeof low);
        (void)memcpy(&high, &bits[i - 4u], sizeof high);
        word = (word << 8) | (((low | (high << 4)) * places) >> 24);
    }
    for (size_t i = rest; i != 0u; i--) {
        word = (word << 1) | (bits[i - 1u] ? 1u : 0u);
    }
    return word;
}

/* Notes states that have changed. */
PLC_RARE void plc_note_steps(plc_steps *steps, const bool *states, size_t count, uint32_t seen)
{
    steps->seen = seen;
    steps->on = plc_gather(states, count);
}

/* Number of the first block of some. */
PLC_OFTEN unsigned plc_first_step(uint32_t run)
{
#if defined(__GNUC__)
    return (unsigned)__builtin_ctz(run);
#else
    unsigned number = 0;
    for (uint32_t rest = run; (rest & 1u) == 0u; rest >>= 1) {
        number++;
    }
    return number;
#endif
}

/* Which of `count` states are on. */
PLC_OFTEN uint32_t plc_states(plc_steps *steps, const bool *states, size_t count)
{
    const uint32_t seen = plc_seen(states, count);
    if (seen != steps->seen) {
        plc_note_steps(steps, states, count, seen);
    }
    return steps->on;
}

/* Switches states off that were left. */
PLC_RARE void plc_drop_steps(plc_steps *steps, bool *states)
{
    for (uint32_t left = steps->left; left != 0u; left &= left - 1u) {
        states[plc_first_step(left)] = false;
    }
    steps->left = 0;
}

/* Begins a scan of `count` blocks: states that were left go off. Returns the blocks that run. */
PLC_OFTEN uint32_t plc_begin_steps(plc_steps *steps, bool *states, size_t count)
{
    if (steps->left != 0u) {
        plc_drop_steps(steps, states);
    }
    const uint32_t on = plc_states(steps, states, count);
    const uint32_t run = on | steps->was_on;
    steps->was_on = on;
    return run;
}

/* The same where a block reads states of later ones: plc_drop_step switches states off. */
PLC_OFTEN uint32_t plc_begin_in_turn(plc_steps *steps, const bool *states, size_t count)
{
    const uint32_t on = plc_states(steps, states, count);
    const uint32_t run = on | steps->was_on;
    steps->was_on = on & ~steps->left;
    return run;
}

/* Switches the state of the first block of `run` off if it was left. */
PLC_OFTEN void plc_drop_step(plc_steps *steps, bool *states, uint32_t run)
{
    const uint32_t now = run & (0u - run);
    if ((steps->left & now) != 0u) {
        steps->left ^= now;
        states[plc_first_step(run)] = false;
    }
}

/* Switches a state on, which is not left then. */
PLC_RARE void plc_enter_step(plc_steps *steps, bool *states, unsigned number)
{
    states[number] = true;
    steps->left &= ~(UINT32_C(1) << number);
}

/* The same from a block before its own, which runs in this scan, too: returns the blocks that run. */
PLC_RARE uint32_t plc_enter_later(plc_steps *steps, bool *states, uint32_t run, unsigned number)
{
    const uint32_t bit = UINT32_C(1) << number;
    plc_enter_step(steps, states, number);
    steps->was_on |= bit;
    return run | bit;
}

/* Leaves the state of the first block of `run`. */
PLC_RARE void plc_leave_step(plc_steps *steps, uint32_t run)
{
    steps->left |= run & (0u - run);
}

/* A transition: enters another state, and leaves the one of the first block of `run`. */
PLC_RARE void plc_transfer(plc_steps *steps, bool *states, uint32_t run, unsigned number)
{
    plc_enter_step(steps, states, number);
    plc_leave_step(steps, run);
}

/* The same to a state further down, whose block runs in this scan, too: returns the blocks that run. */
PLC_RARE uint32_t plc_transfer_later(plc_steps *steps, bool *states, uint32_t run, unsigned number)
{
    plc_leave_step(steps, run);
    return plc_enter_later(steps, states, run, number);
}

/* ---- Words ---------------------------------------------------------------------------------------------------------- */

/* The low 16 bits as a signed number. */
static inline int16_t plc_int16(uint32_t bits)
{
    const uint16_t low = (uint16_t)(bits & 0xFFFFu);
    return (int16_t)((low <= 0x7FFFu) ? (int32_t)low : ((int32_t)low - INT32_C(0x10000)));
}

/* The bits as a signed number. */
static inline int32_t plc_int32(uint32_t bits)
{
    return (bits <= 0x7FFFFFFFu) ? (int32_t)bits : ((int32_t)(bits - 0x80000000u) + INT32_MIN);
}

/* Low word of 32 bits. */
static inline int16_t plc_low(int32_t value)
{
    return plc_int16((uint32_t)value);
}

/* High word of 32 bits. */
static inline int16_t plc_high(int32_t value)
{
    return plc_int16((uint32_t)value >> 16);
}

/* Two words as 32 bits. */
static inline int32_t plc_join(int16_t high, int16_t low)
{
    return plc_int32(((uint32_t)(uint16_t)high << 16) | (uint16_t)low);
}

/* 32 bits into two words. */
static inline void plc_split(int16_t *high, int16_t *low, int32_t value)
{
    *high = plc_high(value);
    *low = plc_low(value);
}

/* 32 bits as an IEEE single. */
static inline float plc_float(int32_t bits)
{
    float value;
    (void)memcpy(&value, &bits, sizeof value);
    return value;
}

/* The bits of an IEEE single. */
static inline int32_t plc_float_bits(float value)
{
    int32_t bits;
    (void)memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Bit 0 to 15 of a word. */
static inline bool plc_bit(int16_t word, unsigned bit)
{
    const uint32_t bits = (uint16_t)word;

    return ((bits >> bit) & 1u) != 0u;
}

/* The word with bit 0 to 15 set to `on`. */
static inline int16_t plc_with_bit(int16_t word, unsigned bit, bool on)
{
    const uint32_t mask = UINT32_C(1) << bit;
    const uint32_t old = (uint16_t)word;
    return plc_int16(on ? (old | mask) : (old & ~mask));
}

/* Sets bit 0 to 15 of a word. */
static inline void plc_put_bit(int16_t *word, unsigned bit, bool on)
{
    *word = plc_with_bit(*word, bit, on);
}

/* `count` relays from `first` on as a number, the first one lowest. */
static inline int32_t plc_bits(const bool *first, unsigned count)
{
    uint32_t value = 0;
    for (unsigned i = 0; i < count; i++) {
        value |= (uint32_t)first[i] << i;
    }
    return plc_int32(value);
}

/* Spreads the low `count` bits of a number over relays. */
static inline void plc_put_bits(bool *first, unsigned count, int32_t value)
{
    for (unsigned i = 0; i < count; i++) {
        first[i] = (((uint32_t)value >> i) & 1u) != 0u;
    }
}

/* The same for relays that are not side by side; NULL for one that is not stored. */
static inline void plc_scatter(bool *const relays[], unsigned count, int32_t value)
{
    for (unsigned i = 0; i < count; i++) {
        if (relays[i] != NULL) {
            *relays[i] = (((uint32_t)value >> i) & 1u) != 0u;
        }
    }
}

/* ---- Arithmetic ----------------------------------------------------------------------------------------------------- */

static inline int16_t plc_add16(int16_t a, int16_t b)
{
    return plc_int16((uint32_t)a + (uint32_t)b);
}

static inline int16_t plc_sub16(int16_t a, int16_t b)
{
    return plc_int16((uint32_t)a - (uint32_t)b);
}

static inline int16_t plc_mul16(int16_t a, int16_t b)
{
    return plc_int16((uint32_t)a * (uint32_t)b);
}

/* Truncates towards zero; b is not 0. */
static inline int16_t plc_div16(int16_t a, int16_t b)
{
    if (b == -1) {
        return plc_sub16(0, a);
    }
    return (int16_t)(a / b);
}

/* Has the sign of a; b is not 0. */
static inline int16_t plc_rem16(int16_t a, int16_t b)
{
    if (b == -1) {
        return 0;
    }
    return (int16_t)(a % b);
}

static inline int32_t plc_add32(int32_t a, int32_t b)
{
    return plc_int32((uint32_t)a + (uint32_t)b);
}

static inline int32_t plc_sub32(int32_t a, int32_t b)
{
    return plc_int32((uint32_t)a - (uint32_t)b);
}

static inline int32_t plc_mul32(int32_t a, int32_t b)
{
    return plc_int32((uint32_t)a * (uint32_t)b);
}

/* High half of the 64-bit product. */
static inline int32_t plc_mul_high32(int32_t a, int32_t b)
{
    const int64_t product = (int64_t)a * b;
    return plc_int32((uint32_t)((uint64_t)product >> 32));
}

/* Truncates towards zero; b is not 0. */
static inline int32_t plc_div32(int32_t a, int32_t b)
{
    return (b == -1) ? plc_sub32(0, a) : (a / b);
}

/* Has the sign of a; b is not 0. */
static inline int32_t plc_rem32(int32_t a, int32_t b)
{
    return (b == -1) ? 0 : (a % b);
}

/* Sum and difference held at the ends of the range. */
static inline int16_t plc_sat_add16(int16_t a, int16_t b)
{
    const int32_t sum = (int32_t)a + b;
    return (int16_t)((sum > INT16_MAX) ? INT16_MAX : (sum < INT16_MIN) ? INT16_MIN : sum);
}

static inline int16_t plc_sat_sub16(int16_t a, int16_t b)
{
    const int32_t difference = (int32_t)a - b;
    return (int16_t)((difference > INT16_MAX) ? INT16_MAX : (difference < INT16_MIN) ? INT16_MIN : difference);
}

static inline int32_t plc_sat_add32(int32_t a, int32_t b)
{
    if (b >= 0) {
        return (a > (INT32_MAX - b)) ? INT32_MAX : (a + b);
    }
    return (a < (INT32_MIN - b)) ? INT32_MIN : (a + b);
}

static inline int32_t plc_sat_sub32(int32_t a, int32_t b)
{
    if (b >= 0) {
        return (a < (INT32_MIN + b)) ? INT32_MIN : (a - b);
    }
    return (a > (INT32_MAX + b)) ? INT32_MAX : (a - b);
}

/* The lesser and the greater one. */
static inline int16_t plc_min16(int16_t a, int16_t b)
{
    return (a < b) ? a : b;
}

static inline int16_t plc_max16(int16_t a, int16_t b)
{
    return (a > b) ? a : b;
}

static inline int32_t plc_min32(int32_t a, int32_t b)
{
    return (a < b) ? a : b;
}

static inline int32_t plc_max32(int32_t a, int32_t b)
{
    return (a > b) ? a : b;
}

/* The bits of a word or a pair, those that leave at the high end entering at the low end. */
static inline int16_t plc_rotate16(int16_t value, int16_t places)
{
    const uint32_t bits = (uint16_t)value;
    const unsigned n = (unsigned)places & 15u;
    return plc_int16((bits << n) | (bits >> (16u - n)));
}

static inline int32_t plc_rotate32(int32_t value, int32_t places)
{
    const uint32_t bits = (uint32_t)value;
    const unsigned n = (uint32_t)places & 31u;
    return plc_int32((n == 0u) ? bits : (bits << n) | (bits >> (32u - n)));
}

/* The bytes of each word exchanged. */
static inline int32_t plc_swap32(int32_t value)
{
    const uint32_t bits = (uint32_t)value;
    return plc_int32(((bits & 0x00FF00FFu) << 8) | ((bits >> 8) & 0x00FF00FFu));
}

static inline int16_t plc_swap16(int16_t value)
{
    return plc_low(plc_swap32(value));
}

/* Number of bits that are on. */
static inline int32_t plc_ones32(int32_t value)
{
    uint32_t bits = (uint32_t)value;
    bits -= (bits >> 1) & 0x55555555u;
    bits = (bits & 0x33333333u) + ((bits >> 2) & 0x33333333u);
    bits = (bits + (bits >> 4)) & 0x0F0F0F0Fu;
    return (int32_t)((bits * 0x01010101u) >> 24);
}

static inline int16_t plc_ones16(int16_t value)
{
    return (int16_t)plc_ones32((uint16_t)value);
}

/* The decimal digits of 0 to 99 999 999 (0 to 9999), four bits each. */
static inline int32_t plc_to_bcd32(int32_t value)
{
    uint32_t digits = 0;
    uint32_t rest = (uint32_t)value;
    for (unsigned shift = 0; shift < 32u; shift += 4u) {
        digits |= (rest % 10u) << shift;
        rest /= 10u;
    }
    return plc_int32(digits);
}

static inline int16_t plc_to_bcd16(int16_t value)
{
    const uint32_t n = (uint16_t)value;
    return plc_int16(((n / 1000u) << 12) | ((n / 100u % 10u) << 8) | ((n / 10u % 10u) << 4) | (n % 10u));
}

/* The number of decimal digits of four bits each; one above 9 counts as what it is. */
static inline int32_t plc_from_bcd32(int32_t digits)
{
    uint32_t value = 0;
    for (unsigned shift = 32; shift > 0u; shift -= 4u) {
        value = (value * 10u) + (((uint32_t)digits >> (shift - 4u)) & 15u);
    }
    return plc_int32(value);
}

static inline int16_t plc_from_bcd16(int16_t digits)
{
    const uint32_t bits = (uint16_t)digits;
    return plc_int16(((bits >> 12) * 1000u) + (((bits >> 8) & 15u) * 100u) + (((bits >> 4) & 15u) * 10u) + (bits & 15u));
}

/* Returns true if no digit of four bits is above 9. */
static inline bool plc_is_bcd32(int32_t digits)
{
    const uint32_t bits = (uint32_t)digits;
    return ((bits & 0x88888888u) & (((bits & 0x44444444u) << 1) | ((bits & 0x22222222u) << 2))) == 0u;
}

static inline bool plc_is_bcd16(int16_t digits)
{
    return plc_is_bcd32((uint16_t)digits);
}

/* The integer square root; 0 of a number below 0. */
static inline int32_t plc_root(int32_t value)
{
    uint32_t rest = (value > 0) ? (uint32_t)value : 0u;
    uint32_t root = 0;
    for (uint32_t bit = UINT32_C(1) << 30; bit != 0u; bit >>= 2) {
        if (rest >= (root + bit)) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    return (int32_t)root;
}

/* Number of the highest bit that is on, counted from 0; 0 if none is. */
static inline int32_t plc_highest_bit(int32_t value)
{
    uint32_t rest = (uint32_t)value;
    unsigned place = 0;
    for (unsigned step = 16u; step != 0u; step /= 2u) {
        if ((rest >> step) != 0u) {
            rest >>= step;
            place += step;
        }
    }
    return (int32_t)place;
}

/* The segments of a display that show the low four bits as a digit: a in bit 0 to g in bit 6. */
static inline int16_t plc_segments(int16_t digit)
{
    static const uint8_t segments[16] = {
        0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x27, 0x7F, 0x6F, 0x77, 0x7C, 0x39, 0x5E, 0x79, 0x71,
    };
    return segments[(uint16_t)digit & 15u];
}

/* ---- Floats --------------------------------------------------------------------------------------------------------- */

/* Returns true if the value is finite and not NaN. */
static inline bool plc_is_finite(float value)
{
    return ((uint32_t)plc_float_bits(value) & 0x7F800000u) != 0x7F800000u;
}

/* The other sign. */
static inline float plc_negate(float value)
{
    return plc_float(plc_int32((uint32_t)plc_float_bits(value) ^ 0x80000000u));
}

/* The square root of a finite value from 0 on, rounded to the nearest float, in integers: no mathematical library is needed. */
static inline float plc_square_root(float value)
{
    const uint32_t bits = (uint32_t)plc_float_bits(value);
    uint32_t mantissa = bits & 0x007FFFFFu;
    int32_t exponent = (int32_t)(bits >> 23);

    if ((bits << 1) == 0u) {
        return value;
    }
    if (exponent == 0) {
        exponent = 1;
        while (mantissa < 0x00800000u) {
            mantissa <<= 1;
            exponent--;
        }
    } else {
        mantissa |= 0x00800000u;
    }
    /* The value is mantissa * 2^(exponent - 150); made a square of 25 bits times an even power of 2. */
    const bool even = ((uint32_t)exponent & 1u) == 0u;
    uint64_t rest = (uint64_t)mantissa << (even ? 26u : 25u);
    uint64_t root = 0;
    for (uint64_t bit = UINT64_C(1) << 48; bit != 0u; bit >>= 2) {
        if (rest >= (root + bit)) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    /* The lowest bit rounds. A root of 2^24 counts as the next power of 2. */
    const uint32_t rounded = (uint32_t)((root + 1u) >> 1);
    const uint32_t power = ((uint32_t)exponent + (even ? 126u : 127u)) / 2u;
    return plc_float(plc_int32((power << 23) + (rounded - 0x00800000u)));
}

/* The nearest float. */
static inline float plc_to_float(int32_t value)
{
    return (float)value;
}

/* The low 32 bits of the integer part, which is held at the ends of 64 bits; 0 for no number. In 32 bits: what converts
   to 64 takes two kilobytes of flash on a microcontroller. */
static inline int32_t plc_truncate(float value)
{
    if ((value >= -2147483648.0f) && (value < 2147483648.0f)) {
        return (int32_t)value;
    }
    const uint32_t bits = (uint32_t)plc_float_bits(value);
    const uint32_t exponent = (bits >> 23) & 0xFFu;
    const uint32_t digits = (bits & 0x7FFFFFu) | 0x800000u;
    if (exponent >= 190u) {
        return (value > 0.0f) ? -1 : 0;
    }
    const uint32_t low = (exponent < 182u) ? digits << (exponent - 150u) : 0u;
    return plc_int32((value < 0.0f) ? (0u - low) : low);
}

/* A result as it is stored: the largest float of its sign where it is too large, the smallest normal one where it is too small but not
   exactly 0. */
static inline float plc_stored(float rounded, bool is_zero)
{
    const uint32_t bits = (uint32_t)plc_float_bits(rounded);
    const uint32_t size = bits & 0x7FFFFFFFu;
    if (size >= 0x7F800000u) {
        return plc_float(plc_int32((bits & 0x80000000u) | 0x7F7FFFFFu));
    }
    if ((size < 0x00800000u) && !is_zero) {
        return plc_float(plc_int32((bits & 0x80000000u) | 0x00800000u));
    }
    return rounded;
}

/* Arithmetic of two finite floats. */
static inline float plc_float_add(float a, float b)
{
    const float sum = a + b;
    return plc_stored(sum, sum == 0.0f);
}

static inline float plc_float_sub(float a, float b)
{
    const float difference = a - b;
    return plc_stored(difference, difference == 0.0f);
}

static inline float plc_float_mul(float a, float b)
{
    return plc_stored(a * b, (a == 0.0f) || (b == 0.0f));
}

/* b is not 0. */
static inline float plc_float_div(float a, float b)
{
    return plc_stored(a / b, a == 0.0f);
}

/* ---- Repetition ----------------------------------------------------------------------------------------------------- */

/* Number of repetitions of FOR: at least one. */
static inline int16_t plc_times(int16_t count)
{
    return (count > 1) ? count : 1;
}

/* ---- Timers --------------------------------------------------------------------------------------------------------- */

/* Types of timers; 0 for the usual one, which is reset to 0 while it is not driven. */
enum {
    PLC_RETENTIVE = 1u,      /* keeps its value while it is not driven; only RST clears it */
    PLC_FREE_RUNNING = 2u,   /* goes on timing in scans that jump over its coil */
    PLC_LATCHES_PRESET = 4u, /* takes the preset over when timing begins */
    PLC_OVERRUNS = 8u,       /* goes on counting after the preset is reached */
    PLC_STEPWISE = 16u,      /* advances by at most one unit a scan */
    PLC_SHARED = 32u         /* its coil may be executed more than once in a scan, which counts the scan's time only once */
};

/* RST T: value 0, contact off. */
static inline void plc_timer_reset(plc_timer *timer)
{
    timer->part_ms = 0;
    timer->value = 0;
    timer->done = false;
}

/* OUT T. In the scan in which the coil comes on the value stays as it is; each later scan adds the time since the scan before. */
static inline void plc_timer_run(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys, uint32_t unit_ms,
                                 unsigned options)
{
    if (!drive) {
        if ((options & PLC_RETENTIVE) != 0u) {
            timer->coil = 0;
        } else {
            (void)memset(timer, 0, sizeof *timer);
        }
        return;
    }

    const bool once_a_scan = (options & (PLC_FREE_RUNNING | PLC_SHARED)) != 0u;
    const bool was_on = timer->coil != 0u;
    uint32_t elapsed = 0;
    if (was_on && !(once_a_scan && (timer->coil == sys->scan))) {
        elapsed = sys->dt_ms;
    }
    if (((options & PLC_STEPWISE) != 0u) && (elapsed > unit_ms)) {
        elapsed = unit_ms;
    }
    if (((options & PLC_LATCHES_PRESET) != 0u) && was_on) {
        preset = timer->preset;
    }
    if ((options & (PLC_LATCHES_PRESET | PLC_FREE_RUNNING)) != 0u) {
        timer->preset = preset;
    }
    timer->coil = once_a_scan ? sys->scan : 1u;

    const bool overruns = (options & PLC_OVERRUNS) != 0u;
    if (!timer->done || overruns) {
        uint32_t part = timer->part_ms + elapsed;
        if (part >= unit_ms) {
            const uint32_t units = part / unit_ms;
            const int32_t room = (overruns ? INT16_MAX : preset) - timer->value;
            part %= unit_ms;
            if (room > 0) {
                timer->value = plc_int16((uint32_t)timer->value + ((units < (uint32_t)room) ? units : (uint32_t)room));
            }
        }
        timer->part_ms = (uint8_t)part;
        timer->done = timer->done || (timer->value >= preset);
    }
}

/* Updates a free-running timer at END: with its coil on, it continues timing in a scan that did not execute it. The contact of
 * a retentive one closes when its coil is executed next. */
static inline void plc_timer_go_on(plc_timer *timer, const plc_sys *sys, uint32_t unit_ms, unsigned options)
{
    if (timer->coil != 0u) {
        const bool closes = timer->done || ((options & PLC_RETENTIVE) == 0u);
        plc_timer_run(timer, true, timer->preset, sys, unit_ms, options);
        timer->done = timer->done && closes;
    }
}

/* Programs with very many timer coils have one function for each kind of timer, not the code of a timer at each coil. */
#if defined(PLC_MANY_TIMERS) && defined(__GNUC__)
#define PLC_TIMER static __attribute__((noinline, unused))
#else
#define PLC_TIMER static inline
#endif

/* OUT T with units of 1, 10 and 100 ms. */
PLC_TIMER void plc_timer_1ms(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys)
{
    plc_timer_run(timer, drive, preset, sys, 1u, 0u);
}

PLC_TIMER void plc_timer_10ms(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys)
{
    plc_timer_run(timer, drive, preset, sys, 10u, 0u);
}

PLC_TIMER void plc_timer_100ms(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys)
{
    plc_timer_run(timer, drive, preset, sys, 100u, 0u);
}

/* OUT T of retentive timers. */
PLC_TIMER void plc_retentive_1ms(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys)
{
    plc_timer_run(timer, drive, preset, sys, 1u, PLC_RETENTIVE);
}

PLC_TIMER void plc_retentive_10ms(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys)
{
    plc_timer_run(timer, drive, preset, sys, 10u, PLC_RETENTIVE);
}

PLC_TIMER void plc_retentive_100ms(plc_timer *timer, bool drive, int16_t preset, const plc_sys *sys)
{
    plc_timer_run(timer, drive, preset, sys, 100u, PLC_RETENTIVE);
}

/* ---- Counters ------------------------------------------------------------------------------------------------------- */

/* OUT C0 to C199: counts an off-to-on change of its coil. A preset of 0 acts as 1. */
static inline void plc_count16(plc_counter16 *counter, bool drive, int16_t preset)
{
    if (drive && !counter->coil && !counter->done) {
        const int16_t target = (preset > 1) ? preset : 1;
        counter->value = (counter->value < target) ? (int16_t)(counter->value + 1) : target;
        counter->done = counter->value >= target;
    }
    counter->coil = drive;
}

/* Counts once, up or down, wrapping. The contact closes when the value reaches the preset upwards and opens when it leaves it
 * downwards. */
static inline void plc_count32_once(plc_counter32 *counter, bool down, int32_t preset)
{
    const int32_t before = counter->value;
    counter->value = plc_add32(before, down ? -1 : 1);
    if (!down && (counter->value == preset)) {
        counter->done = true;
    } else if (down && (before == preset)) {
        counter->done = false;
    } else {
        /* the contact stays as it is */
    }
}

/* OUT C200 and up: counts an off-to-on change of its coil. */
static inline void plc_count32(plc_counter32 *counter, bool drive, bool down, int32_t preset)
{
    if (drive && !counter->coil) {
        plc_count32_once(counter, down, preset);
    }
    counter->coil = drive;
}

/* RST C: value 0, contact off. */
static inline void plc_count16_reset(plc_counter16 *counter)
{
    counter->value = 0;
    counter->done = false;
}

static inline void plc_count32_reset(plc_counter32 *counter)
{
    counter->value = 0;
    counter->done = false;
}

/* RST C that holds the counter at 0 until the next execution of its coil is over: that one does not count. */
static inline void plc_count16_hold(plc_counter16 *counter)
{
    plc_count16_reset(counter);
    counter->coil = true;
}

static inline void plc_count32_hold(plc_counter32 *counter)
{
    plc_count32_reset(counter);
    counter->coil = true;
}

#endif
