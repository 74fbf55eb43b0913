/*
 * rungc_ramps.h: speeds and times of positioning, and the signal at the origin.
 *
 * Private to the rungc_*.c files.
 */
#ifndef RUNGC_RAMPS_H
#define RUNGC_RAMPS_H

#include "rungc_outputs.h"

/* Speeds, in Hz, and times of ramps, in milliseconds. */
typedef struct rungc_profile {
    uint32_t base; /* speed that ramps begin and end with */
    uint32_t highest;
    uint32_t up_ms;
    uint32_t down_ms;
    bool raises_speeds; /* a speed that ramps cannot begin with is raised */
} rungc_profile;

/* The value, or the limit that it exceeds. */
uint32_t rungc_within(int64_t value, uint32_t least, uint32_t most);

/* Ramps of positioning: those of this output alone while the relay for that is on; or those of all outputs, whatever it says. */
rungc_profile rungc_profile_of(const rungc_job *job);
rungc_profile rungc_profile_for_all(const rungc_job *job);

/* The profile that registers describe. Without registers it is as if they held 0. */
rungc_profile rungc_profile_from(const rungc_job *job, const rungc_ramps *registers);

/* A train of `total` pulses at `hz`, at most the highest speed; and one without end. */
rungc_train rungc_profile_train(const rungc_profile *profile, uint32_t hz, uint32_t total, bool reverse);
rungc_train rungc_endless_train(const rungc_profile *profile, uint32_t hz, bool reverse);

/* The output is at its origin: it stops at once, its position is 0, and the instruction is done. */
void rungc_arrive_home(rungc_job *job);

/* Gives a clear signal, if the relay for that is on; ends it when its time is over. */
void rungc_begin_clear_signal(rungc_job *job, const rungc_clear *clear);
void rungc_end_clear_signal(rungc_job *job, const rungc_clear *clear);

#endif
