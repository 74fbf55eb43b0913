/*
 * rungc_outputs.h: pulse outputs: what instructions for them have in common.
 *
 * Private to the rungc_*.c files.
 */
#ifndef RUNGC_OUTPUTS_H
#define RUNGC_OUTPUTS_H

#include "rungc_generator.h"
#include "rungc_operands.h"
#include "rungc_wiring.h"

/* Lowest speed of a train with ramps, in Hz, and the limits of the times of ramps, in milliseconds. */
enum { RUNGC_LOWEST_HZ = 10, RUNGC_SHORTEST_RAMP_MS = 50, RUNGC_LONGEST_RAMP_MS = 5000 };

/* Words that an instruction keeps. The others are its own. */
enum {
    RUNGC_KEPT_DRIVE = 0,   /* it was driven */
    RUNGC_KEPT_PHASE = 1,   /* how far it is */
    RUNGC_KEPT_RESTART = 2, /* the relay with which it begins anew was on */
    RUNGC_KEPT_SHOWN = 3,   /* it has shown that it is driven */
    RUNGC_KEPT_CLEAR = 6,   /* the output of its clear signal plus one, negative until a scan has seen it on */
    RUNGC_KEPT_CLEAR_MS = 7 /* since when that is on */
};

/* An instruction at work on an output. */
typedef struct rungc_job {
    rungc_call call;
    const rungc_pulse_family *family;
    const rungc_wiring *wiring; /* the special devices of the output */
    rungc_axis *axis;           /* the output in the program's memory */
    int32_t *kept;              /* the words that the instruction keeps */
    uint32_t output;            /* number Y */
} rungc_job;

/* An instruction that names its output. */
typedef rungc_fault rungc_pulse_work(rungc_job *job, const rungc_operand operands[]);

/* Runs an instruction whose output is the operand of this number, while no interrupt sends pulses, and shows its error. */
void rungc_run_pulses(rungc_map *map, rungc_site site, const rungc_operand operands[], unsigned output, rungc_pulse_work *work);

/* What an instruction does from its start to its end. */
typedef struct rungc_course {
    rungc_pulse_work *begin;   /* it begins */
    rungc_pulse_work *follow;  /* a scan in which it sends */
    rungc_pulse_work *release; /* it sent, and its drive has gone off */
    bool ends_itself;          /* it says itself when it is done; otherwise it is when its train is, and a limit switch ends it */
} rungc_course;

/* What an instruction does in this scan; then the special relays show how far it is, unless it has failed. */
rungc_fault rungc_take_course(rungc_job *job, const rungc_operand operands[], const rungc_course *course);

/* Releases: the pulses come down with their ramp, or stop at once. */
rungc_fault rungc_come_down(rungc_job *job, const rungc_operand operands[]);
rungc_fault rungc_halt(rungc_job *job, const rungc_operand operands[]);

/* The first two operands, which are not negative. An operand that does not exist is reported before one that is negative. */
rungc_fault rungc_read_two(const rungc_call *call, const rungc_operand operands[], uint32_t *first, uint32_t *second);

/* Sends a train, whose pulses are counted in the pair of registers `counter`, unless a limit switch forbids it; or whatever they say. */
void rungc_send_train(rungc_job *job, const rungc_train *train, uint16_t counter);
void rungc_send_train_anyway(rungc_job *job, const rungc_train *train, uint16_t counter);

/* The instruction is done; it has come to an end before its time. */
void rungc_finish(rungc_job *job);
void rungc_fail(rungc_job *job);

/* Returns true if the model has a special relay, and it is on. */
bool rungc_has_on(const rungc_job *job, uint16_t relay);

/* A speed in the model's range, in millihertz. */
uint32_t rungc_speed_of(const rungc_job *job, uint32_t hz);

/* Changes how many pulses the train has, if the relay for that is on and it does not come down yet. */
void rungc_change_total(rungc_job *job, uint32_t total);

/* Ramps that hold instead of those for all outputs, while the relay for that is on; NULL: none. */
const rungc_ramps *rungc_own_ramps(const rungc_job *job);

/* The time of a ramp in a register, in milliseconds. */
uint32_t rungc_ramp_ms(const rungc_map *map, uint16_t number);

/* Counts the pulses of an output that have ended and are not counted yet. */
void rungc_count_pulses(const rungc_map *map, uint32_t output, const rungc_wiring *wiring);

/* The pin is as the signal says. */
void rungc_show_pin(rungc_axis *axis);

/* A pulse output of a program; NULL if it sends nothing there. */
rungc_axis *rungc_axis_of(const rungc_map *map, uint32_t output);

#endif
