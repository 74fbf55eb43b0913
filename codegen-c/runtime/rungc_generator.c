/*
 * rungc_generator.c: pulses over time.
 */
#include "rungc_generator.h"

/* A whole pulse in the unit of its progress, millihertz times microseconds. */
#define FULL UINT64_C(1000000000)

/* Times further apart than this are taken for a clock that went back. */
#define LONGEST_US (UINT32_MAX / 2u)

static uint64_t least(uint64_t a, uint64_t b)
{
    return (a < b) ? a : b;
}

static uint64_t square(uint32_t speed)
{
    return (uint64_t)speed * speed;
}

/* A difference, 0 at least. */
static uint64_t above(uint64_t value, uint64_t base)
{
    return (value > base) ? value - base : 0u;
}

/* A quotient, rounded up. A division of 64 bits takes a microcontroller hundreds of instructions, and mostly 32 are enough. */
static uint64_t quotient_up(uint64_t dividend, uint64_t divisor)
{
    if ((dividend <= UINT32_MAX) && (divisor <= UINT32_MAX)) {
        const uint32_t small = (uint32_t)dividend;
        const uint32_t by = (uint32_t)divisor;

        return (small / by) + (((small % by) != 0u) ? 1u : 0u);
    }
    return (dividend / divisor) + (((dividend % divisor) != 0u) ? 1u : 0u);
}

/* A product, held at the largest number. */
static uint64_t product(uint64_t a, uint32_t b)
{
    const uint64_t low = (a & UINT32_MAX) * b;
    const uint64_t high = ((a >> 32) * b) + (low >> 32);

    return (high > UINT32_MAX) ? UINT64_MAX : ((high << 32) | (low & UINT32_MAX));
}

static uint64_t sum(uint64_t a, uint64_t b)
{
    return (a > (UINT64_MAX - b)) ? UINT64_MAX : a + b;
}

static uint32_t least32(uint64_t value)
{
    return (value > UINT32_MAX) ? UINT32_MAX : (uint32_t)value;
}

uint32_t rungc_root64(uint64_t value)
{
    uint64_t rest = value;
    uint64_t root = 0;

    for (uint64_t bit = UINT64_C(1) << 62; bit != 0u; bit >>= 2) {
        if (rest >= (root + bit)) {
            rest -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    return (uint32_t)root;
}

rungc_train rungc_steady_train(uint32_t speed, uint32_t total)
{
    rungc_train train;

    train.lowest = 0;
    train.up = 0;
    train.down = 0;
    train.speed = speed;
    train.total = total;
    train.reverse = false;
    return train;
}

uint64_t rungc_slope(uint32_t hz, uint32_t ms)
{
    return ((uint64_t)hz * UINT64_C(2000000000)) / ((ms == 0u) ? 1u : ms);
}

/* An output that is idle, at this time. */
static void clear(rungc_generator *generator)
{
    const uint32_t now_us = generator->now_us;

    (void)memset(generator, 0, sizeof *generator);
    generator->full = FULL;
    generator->now_us = now_us;
}

/* No pulse is faster than the way down from it allows. */
static void hold_back(rungc_generator *generator)
{
    if ((generator->total != 0u) && (generator->down != 0u)) {
        const uint32_t remaining = generator->total - generator->sent;
        const uint32_t after = (remaining > 0u) ? remaining - 1u : 0u;
        const uint64_t most = sum(generator->lowest, product(generator->down, after));

        generator->square = least(generator->square, most);
    }
}

/* Square of the speed with which the train leaves a standstill. */
static uint64_t first_square(const rungc_generator *generator)
{
    const uint64_t wanted = square(generator->speed);

    return (generator->up == 0u) ? wanted : least(wanted, generator->lowest);
}

static void take_first_speed(rungc_generator *generator)
{
    generator->square = first_square(generator);
    hold_back(generator);
    generator->rate = rungc_root64(generator->square);
}

static void rest(rungc_generator *generator)
{
    generator->busy = false;
    generator->modulates = false;
    generator->rate = 0;
    generator->square = 0;
    generator->phase = 0;
}

void rungc_generator_start(rungc_generator *generator, const rungc_train *train)
{
    clear(generator);
    generator->lowest = least(train->lowest, square(train->speed));
    generator->up = train->up;
    generator->down = train->down;
    generator->speed = train->speed;
    generator->total = train->total;
    generator->reverse = train->reverse;
    generator->on = (uint32_t)(FULL / 2u);
    generator->busy = true;
    generator->fresh = true;
    take_first_speed(generator);
}

void rungc_generator_modulate(rungc_generator *generator, uint32_t width, uint32_t period, uint32_t unit_us)
{
    const uint64_t full = (uint64_t)period * unit_us;

    if (!generator->modulates) {
        clear(generator);
        generator->busy = true;
        generator->modulates = true;
        generator->rate = 1;
        generator->fresh = true;
    }
    generator->full = (full > 1u) ? full : 1u;
    generator->phase = least(generator->phase, generator->full - 1u);
    generator->on = least32((uint64_t)width * unit_us);
}

void rungc_generator_halt(rungc_generator *generator)
{
    generator->stopped = generator->stopped || generator->busy;
    rest(generator);
}

void rungc_generator_stop(rungc_generator *generator)
{
    if ((generator->down == 0u) || (generator->rate == 0u)) {
        rungc_generator_halt(generator);
        return;
    }
    const uint64_t needed = sum(quotient_up(above(generator->square, generator->lowest), generator->down), 1u);
    const uint64_t end = sum(generator->sent, needed);

    if ((generator->total == 0u) || (end < generator->total)) {
        generator->total = least32(end);
    }
    generator->stopped = true;
}

void rungc_generator_set_speed(rungc_generator *generator, uint32_t speed)
{
    generator->speed = speed;
    if (speed > 0u) {
        generator->lowest = least(generator->lowest, square(speed));
    }
    if (generator->busy && ((generator->up == 0u) || (generator->square == 0u))) {
        take_first_speed(generator);
    }
}

void rungc_generator_set_total(rungc_generator *generator, uint32_t total)
{
    if (generator->busy && !generator->stopped && (generator->total != 0u)) {
        const uint32_t fewest = (generator->sent == UINT32_MAX) ? UINT32_MAX : generator->sent + 1u;

        generator->total = (total > fewest) ? total : fewest;
    }
}

void rungc_generator_end_in(rungc_generator *generator, uint32_t pulses)
{
    if (generator->busy && (generator->total == 0u)) {
        generator->total = least32((uint64_t)generator->sent + ((pulses > 0u) ? pulses : 1u));
        hold_back(generator);
        generator->rate = rungc_root64(generator->square);
    }
}

/* Number of pulses, the present one included, that are certain to have its speed. */
static uint32_t alike(const rungc_generator *generator)
{
    if (generator->modulates) {
        return UINT32_MAX;
    }
    if (generator->square != square(generator->speed)) {
        return 1;
    }
    if (generator->total == 0u) {
        return UINT32_MAX;
    }
    const uint32_t remaining = generator->total - generator->sent;

    if (generator->down == 0u) {
        return remaining;
    }
    const uint64_t way_down = quotient_up(above(generator->square, generator->lowest), generator->down);
    const uint64_t before = above(remaining, way_down);

    return (before > 1u) ? (uint32_t)before : 1u;
}

/* Square of the speed of the next pulse, before the way down is thought of. */
static uint64_t next_square(const rungc_generator *generator)
{
    const uint64_t wanted = square(generator->speed);
    const uint64_t now = generator->square;

    if ((now < wanted) && (generator->up > 0u)) {
        return least(wanted, sum(now, generator->up));
    }
    if ((now >= wanted) && (generator->down > 0u)) {
        const uint64_t slower = above(now, generator->down);

        /* Below the lowest speed it stands still. */
        if ((wanted == 0u) && (now <= generator->lowest)) {
            return 0;
        }
        return (slower > wanted) ? slower : wanted;
    }
    return wanted;
}

/* This many pulses have ended; gives the next one its speed. */
static void end_pulses(rungc_generator *generator, uint32_t pulses)
{
    const uint64_t before = generator->square;

    if (generator->modulates) {
        return;
    }
    /* A train without end wraps. */
    generator->sent += pulses;
    if ((generator->total != 0u) && (generator->sent >= generator->total)) {
        rest(generator);
        return;
    }
    generator->square = next_square(generator);
    hold_back(generator);
    if (generator->square != before) {
        generator->rate = rungc_root64(generator->square);
    }
}

/* Number of pulses that have ended with this progress, the present one included. */
static uint64_t pulses_in(const rungc_generator *generator, uint64_t progress)
{
    const uint64_t past = progress - generator->full;

    return (past < generator->full) ? 1u : least(1u + (past / generator->full), alike(generator));
}

uint32_t rungc_generator_advance(rungc_generator *generator, uint32_t now_us)
{
    const uint32_t passed = now_us - generator->now_us;
    uint64_t left = passed;
    uint32_t count = 0;

    if (passed > LONGEST_US) {
        return 0;
    }
    generator->now_us = now_us;
    while (generator->busy && (generator->rate > 0u)) {
        const uint64_t progress = (left * generator->rate) + generator->phase;

        if (progress < generator->full) {
            generator->phase = progress;
            break;
        }
        const uint64_t pulses = pulses_in(generator, progress);
        const uint64_t end = pulses * generator->full;
        const uint64_t used = quotient_up(above(end, generator->phase), generator->rate);

        generator->phase = ((used * generator->rate) + generator->phase) - end;
        left -= used;
        count += (uint32_t)pulses;
        end_pulses(generator, (uint32_t)pulses);
    }
    return count;
}

/* Time from the last call to when the output changes next; UINT32_MAX if it does not. */
static uint32_t next_edge(const rungc_generator *generator)
{
    if (!generator->busy || (generator->rate == 0u)) {
        return UINT32_MAX;
    }
    const uint64_t on = least(generator->on, generator->full);
    const uint64_t next = (generator->phase < on) ? on : generator->full;

    return least32(quotient_up(above(next, generator->phase), generator->rate));
}

static bool has_edges(const rungc_generator *generator)
{
    return generator->busy && (generator->rate > 0u);
}

uint32_t rungc_generator_step(rungc_generator *generator, uint32_t now_us)
{
    if (generator->fresh) {
        generator->fresh = false;
        generator->now_us = now_us;
    }
    const uint32_t passed = now_us - generator->now_us;
    const uint32_t wait = next_edge(generator);

    if (passed > LONGEST_US) {
        return 0;
    }
    if (!has_edges(generator) || (wait > passed)) {
        return rungc_generator_advance(generator, now_us);
    }
    /* The next edges come sooner, but none before its time is half over; what this call is later than that, the train is longer. */
    const uint32_t count = rungc_generator_advance(generator, generator->now_us + wait);
    const uint32_t late = passed - wait;
    const uint32_t most = has_edges(generator) ? next_edge(generator) / 2u : 0u;

    generator->now_us = now_us - ((late < most) ? late : most);
    return count;
}

uint32_t rungc_generator_wait(const rungc_generator *generator, uint32_t now_us)
{
    uint32_t passed = now_us - generator->now_us;
    const uint32_t wait = next_edge(generator);

    if (!has_edges(generator)) {
        return UINT32_MAX;
    }
    if (passed > LONGEST_US) {
        passed = 0;
    }
    return (wait > passed) ? wait - passed : 0u;
}

bool rungc_generator_is_ending(const rungc_generator *generator)
{
    if (!generator->busy || (generator->total == 0u) || (generator->down == 0u)) {
        return false;
    }
    const uint64_t needed = quotient_up(above(generator->square, generator->lowest), generator->down);

    return (generator->total - generator->sent) <= sum(needed, 1u);
}

bool rungc_generator_is_complete(const rungc_generator *generator)
{
    return !generator->busy && !generator->stopped && (generator->total != 0u) && (generator->sent >= generator->total);
}

uint32_t rungc_generator_millihertz(const rungc_generator *generator)
{
    if (!generator->modulates) {
        return generator->rate;
    }
    return ((generator->on > 0u) && (generator->on < generator->full)) ? (uint32_t)(FULL / generator->full) : 0u;
}

bool rungc_generator_level(const rungc_generator *generator)
{
    return generator->busy && (generator->rate > 0u) && (generator->phase < generator->on);
}
