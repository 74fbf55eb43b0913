/*
 * rungc_generator.h: one pulse output as a state machine over time, in integers.
 *
 * Private to the rungc_*.c files. A speed is kept as its square, which a steady acceleration changes by the same amount at each pulse
 * (v^2 = v0^2 + 2as). So ramps need no clock, the way down begins where as many pulses are left as it takes, and a train ends with
 * exactly the pulses that it was given. Speeds are in millihertz, times in microseconds since power-on, wrapping.
 */
#ifndef RUNGC_GENERATOR_H
#define RUNGC_GENERATOR_H

#include "rungc_rt.h"

/* A train of pulses. */
typedef struct rungc_train {
    uint64_t lowest; /* square of the speed that ramps begin and end with */
    uint64_t up;     /* increase of the square of the speed per pulse on the way up; 0: any speed at once */
    uint64_t down;   /* decrease per pulse on the way down */
    uint32_t speed;  /* speed that it is to reach; 0: it waits */
    uint32_t total;  /* pulses; 0: without end */
    bool reverse;    /* positions count down */
} rungc_train;

/* A train at one speed. */
rungc_train rungc_steady_train(uint32_t speed, uint32_t total);

/* The change of the square of a speed at each pulse by an acceleration from 0 to `hz` in `ms`: 2a. */
uint64_t rungc_slope(uint32_t hz, uint32_t ms);

/* The integer square root. */
uint32_t rungc_root64(uint64_t value);

/* Begins a train, instead of whatever the output does. */
void rungc_generator_start(rungc_generator *generator, const rungc_train *train);

/* Sends pulses of a width and a period, in units of `unit_us`, without end; a signal that is sent already continues with them. */
void rungc_generator_modulate(rungc_generator *generator, uint32_t width, uint32_t period, uint32_t unit_us);

/* Stops at once; comes down and stops. */
void rungc_generator_halt(rungc_generator *generator);
void rungc_generator_stop(rungc_generator *generator);

/* Changes the speed of a train that is sent, by its ramps if it has any; at 0 it waits. */
void rungc_generator_set_speed(rungc_generator *generator, uint32_t speed);

/* Changes how many pulses a train has that is sent; the pulse that has begun is sent in any case. */
void rungc_generator_set_total(rungc_generator *generator, uint32_t total);

/* Ends an endless train after this many more pulses. */
void rungc_generator_end_in(rungc_generator *generator, uint32_t pulses);

/* Lets time pass; returns the number of pulses that have ended since the last call. Call it at least every half an hour. */
uint32_t rungc_generator_advance(rungc_generator *generator, uint32_t now_us);

/* The same for a pin: at most one edge of the signal passes, so that the pin has every pulse, however late the call is. */
uint32_t rungc_generator_step(rungc_generator *generator, uint32_t now_us);

/* Time from `now_us` to when the output changes next; UINT32_MAX if it does not. */
uint32_t rungc_generator_wait(const rungc_generator *generator, uint32_t now_us);

/* True while it slows down towards its end; true if the last train was sent to its end. */
bool rungc_generator_is_ending(const rungc_generator *generator);
bool rungc_generator_is_complete(const rungc_generator *generator);

/* The present speed; 0 if idle. State of the output: on in the first half of each pulse. */
uint32_t rungc_generator_millihertz(const rungc_generator *generator);
bool rungc_generator_level(const rungc_generator *generator);

#endif
