/*
 * rungc_ramps.c: speeds and times of positioning, and the signal at the origin.
 */
#include "rungc_ramps.h"

uint32_t rungc_within(int64_t value, uint32_t least, uint32_t most)
{
    if (value < (int64_t)least) {
        return least;
    }
    return (value > (int64_t)most) ? most : (uint32_t)value;
}

rungc_profile rungc_profile_from(const rungc_job *job, const rungc_ramps *registers)
{
    const rungc_map *const map = job->call.map;
    const bool there = registers->base != 0u;
    rungc_profile profile;

    profile.highest = rungc_within(there ? rungc_long_register(map, registers->highest) : 0, RUNGC_LOWEST_HZ, job->family->highest_hz);
    profile.base = rungc_within(there ? rungc_register(map, registers->base) : 0, 0, profile.highest / 10u);
    profile.up_ms = there ? rungc_ramp_ms(map, registers->up) : (uint32_t)RUNGC_SHORTEST_RAMP_MS;
    profile.down_ms = there ? rungc_ramp_ms(map, registers->down) : (uint32_t)RUNGC_SHORTEST_RAMP_MS;
    profile.raises_speeds = job->family->raises_speeds;
    return profile;
}

rungc_profile rungc_profile_of(const rungc_job *job)
{
    const rungc_ramps *const own = rungc_own_ramps(job);

    return rungc_profile_from(job, (own != NULL) ? own : &job->wiring->ramps);
}

rungc_profile rungc_profile_for_all(const rungc_job *job)
{
    return rungc_profile_from(job, &job->wiring->ramps);
}

rungc_train rungc_endless_train(const rungc_profile *profile, uint32_t hz, bool reverse)
{
    const uint64_t base = UINT64_C(1000) * profile->base;
    rungc_train train = rungc_steady_train(1000u * ((hz < profile->highest) ? hz : profile->highest), 0);

    train.up = rungc_slope(profile->highest, profile->up_ms);
    train.down = rungc_slope(profile->highest, profile->down_ms);
    /* The speed after one pulse at a steady acceleration is the root of (highest speed / 2 * time). */
    train.lowest = ((base * base) > (train.up / 4u)) ? base * base : train.up / 4u;
    train.reverse = reverse;
    return train;
}

rungc_train rungc_profile_train(const rungc_profile *profile, uint32_t hz, uint32_t total, bool reverse)
{
    rungc_train train = rungc_endless_train(profile, (hz > (uint32_t)RUNGC_LOWEST_HZ) ? hz : (uint32_t)RUNGC_LOWEST_HZ, reverse);
    const uint64_t lowest = train.up / 4u;

    if (profile->raises_speeds && (((uint64_t)train.speed * train.speed) < lowest)) {
        train.speed = rungc_root64(lowest - 1u) + 1u;
    }
    train.total = total;
    return train;
}

void rungc_arrive_home(rungc_job *job)
{
    rungc_generator_halt(&job->axis->generator);
    rungc_count_pulses(job->call.map, job->output, job->wiring);
    if (job->wiring->position != 0u) {
        rungc_set_long_register(job->call.map, job->wiring->position, 0);
    }
    rungc_finish(job);
}

/* ---- The clear signal ------------------------------------------------------------------------------------------------------------- */

/* 16 for H20, which stands for Y020; false if a digit is none of the octal ones. */
static bool from_octal_digits(uint32_t digits, uint32_t *number)
{
    *number = 0;
    for (unsigned shift = 16; shift > 0u; shift -= 4u) {
        const uint32_t digit = (digits >> (shift - 4u)) & 15u;

        if (digit > 7u) {
            return false;
        }
        *number = (8u * *number) + digit;
    }
    return true;
}

/* Sets an output; false if the model has no such output. */
static bool set_output(const rungc_map *map, uint32_t number, bool on)
{
    bool *bit = NULL;
    const bool exists = rungc_find_bit(map, 0u, RUNGC_CLASS_Y, number, &bit);

    if (bit != NULL) {
        *bit = on;
    }
    return exists;
}

/* A signal that a scan has not seen on is kept as a negative number. */
static void keep_clear_signal(rungc_job *job, int32_t output, bool seen)
{
    job->kept[RUNGC_KEPT_CLEAR] = seen ? output : -output;
    job->kept[RUNGC_KEPT_CLEAR_MS] = plc_int32(rungc_sys(job->call.map)->now_ms);
}

void rungc_begin_clear_signal(rungc_job *job, const rungc_clear *clear)
{
    uint32_t output = clear->output;

    if (!rungc_has_on(job, clear->enable)) {
        return;
    }
    if ((clear->number != 0u) && ((clear->chooses == 0u) || rungc_has_on(job, clear->chooses))) {
        output = (uint16_t)rungc_register(job->call.map, clear->number);
        if (clear->octal && !from_octal_digits(output, &output)) {
            return;
        }
    }
    if (set_output(job->call.map, output, true)) {
        keep_clear_signal(job, (int32_t)output + 1, !job->call.site.signal);
    }
}

void rungc_end_clear_signal(rungc_job *job, const rungc_clear *clear)
{
    const int32_t output = job->kept[RUNGC_KEPT_CLEAR];
    const uint32_t passed = rungc_sys(job->call.map)->now_ms - (uint32_t)job->kept[RUNGC_KEPT_CLEAR_MS];

    if ((output < 0) && !job->call.site.signal) {
        keep_clear_signal(job, -output, true);
    } else if ((output > 0) && (passed > clear->ms)) {
        job->kept[RUNGC_KEPT_CLEAR] = 0;
        (void)set_output(job->call.map, (uint32_t)output - 1u, false);
    } else {
        /* it continues */
    }
}
